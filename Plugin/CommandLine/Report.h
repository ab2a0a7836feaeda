// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The figures of a run, and the JSON file they can be written to.
#ifndef nurbsReport_h
#define nurbsReport_h

#include <cstdint>
#include <string>
#include <vector>

namespace nurbs
{

struct Report
{
  std::string File;
  std::string Unit;       ///< of lengths, "mm"; empty if unknown
  std::int64_t Faces = 0; ///< converted faces of the model
  std::int64_t Edges = 0; ///< edges of the model
  std::int64_t Unconverted = 0;

  bool Tessellated = false; ///< whether the figures from here to FailedFaces say anything
  std::int64_t Triangles = 0;
  std::int64_t Points = 0;
  double Tolerance = 0.0;      ///< absolute, in Unit; of pixels: the smallest of all faces
  double CertifiedError = 0.0; ///< largest of all faces, in Unit; an estimate if not Guaranteed
  bool Guaranteed = true;
  std::int64_t OpenEdges = 0; ///< edges with one triangle, coordinates compared exactly
  std::int64_t FailedFaces = 0;
  std::int64_t RepairedFaces = 0;
  std::int64_t CappedFaces = 0; ///< tolerance not met

  double ReadSeconds = 0.0;
  double TessellateSeconds = 0.0;
  double WriteSeconds = 0.0; ///< the file; with `render` drawing too
  std::vector<std::string> Problems;
};

/// Write as JSON, keys as in `vtknurbs --help`. Throws Failure if the file cannot be written.
void WriteReport(const Report& report, const std::string& path);

} // namespace nurbs

#endif
