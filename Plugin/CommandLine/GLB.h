// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Triangles with names and colours as a binary glTF 2.0 file (.glb).
#ifndef nurbsGLB_h
#define nurbsGLB_h

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace nurbs
{

using GLBColour = std::array<unsigned char, 3>; ///< sRGB

/// A triangle mesh as the writer wants it; all triangles of one look may lie anywhere in it.
struct GLBMesh
{
  const double* Points = nullptr;  ///< x, y, z of each point
  const double* Normals = nullptr; ///< likewise, unit length; null: none are written
  std::size_t PointCount = 0;
  const std::int64_t* Triangles = nullptr; ///< 3 point indices each
  std::size_t TriangleCount = 0;
  std::vector<int> Look; ///< of each triangle, index into Looks

  struct Appearance
  {
    std::string Name;
    GLBColour Colour = { 204, 204, 204 };
  };
  std::vector<Appearance> Looks; ///< those of one name become one mesh, of one colour a material
  double Metres = 1.0;           ///< length of the unit of Points
};

/// Write the mesh: glTF nodes named after the looks, under a root that scales to metres and turns
/// z up into y up, as glTF wants it; coordinates stay in their unit, as 32-bit floats. A triangle's
/// points are shared within a look. Empty looks are left out. Throws Failure if the file cannot be
/// written, or would pass the 4 GiB that the format can hold.
void WriteGLB(const GLBMesh& mesh, const std::string& path);

} // namespace nurbs

#endif
