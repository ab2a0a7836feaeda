// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A tessellated model as a file: .vtp .vtu .stl .ply .obj .glb.
#ifndef vtkWriteMesh_h
#define vtkWriteMesh_h

#include <string>
#include <vector>

class vtkPolyData;

namespace nurbs
{

/// The ending of a path in lower case, with its dot; empty if it has none.
std::string Ending(const std::string& path);

/// Throws Failure if a mesh cannot be written to `path`: an ending that names no format, a folder
/// that does not exist or refuses. Asked before the work is done.
void CheckMeshPath(const std::string& path);

/// Throws Failure if no file can be made at `path`. An existing file is left as it is.
void CheckWritable(const std::string& path);

/// Writes triangles with point normals, parameters, and cell data FaceId, Name, Color as far as the
/// format can hold them. `unit` is that of the points, for .glb, which is in metres. `tolerance` is
/// the mesh's: a warning is returned where 32-bit coordinates lose a tenth of it or more. Throws
/// Failure if writing fails.
std::vector<std::string> WriteMesh(
  vtkPolyData* mesh, const std::string& path, const std::string& unit, double tolerance);

/// How many metres a unit of length has ("mm": 0.001); 1 if it is not known.
double MetresOf(const std::string& unit);

} // namespace nurbs

#endif
