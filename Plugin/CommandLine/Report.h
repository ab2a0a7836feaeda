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

  bool Viewed = false;     ///< whether the figures from here to VisibleLines say anything
  double Precision = 0.0;  ///< absolute, in Unit
  bool HasRegions = false; ///< whether the figures from here to VisibleArea say anything
  std::int64_t VisibleFaces = 0;
  std::int64_t PartialFaces = 0;
  std::int64_t HiddenFaces = 0;
  double VisibleArea = 0.0; ///< in squared Unit
  std::int64_t UnusedFaces = 0;
  std::int64_t PiercingPairs = 0;
  std::int64_t Lines = 0; ///< of polylines
  std::int64_t VisibleLines = 0;
  bool Drawn = false;     ///< whether the figures from here to Scale say anything
  std::int64_t Paths = 0; ///< of lines that go on in each other
  std::int64_t Curves = 0;
  std::int64_t StraightLines = 0;
  double Scale = 0.0; ///< millimetres of paper by Unit

  bool Converted = false; ///< whether the figures from here to EdgeTolerance say anything
  std::int64_t WrittenFaces = 0;
  std::int64_t LostFaces = 0;     ///< that could not be written
  std::int64_t InvalidFaces = 0;  ///< that OpenCASCADE's check finds fault with
  std::int64_t AnalyticFaces = 0; ///< on planes, cylinders, cones, spheres and tori
  std::int64_t Instances = 0;     ///< parts that are copies of others
  std::int64_t Solids = 0;
  std::int64_t Shells = 0; ///< that are no part of a solid
  std::int64_t SharedEdges = 0;
  std::int64_t ComputedEdges = 0; ///< whose curve is not the model's
  std::int64_t TornEdges = 0;     ///< whose faces are too far apart
  double EdgeTolerance = 0.0;     ///< the largest, in Unit

  double ReadSeconds = 0.0;
  double TessellateSeconds = 0.0;
  double VisibilitySeconds = 0.0;
  double WriteSeconds = 0.0; ///< the file; with `render` drawing too
  std::vector<std::string> Problems;
};

/// Write as JSON, keys as in `vtknurbs --help`. Throws Failure if the file cannot be written.
void WriteReport(const Report& report, const std::string& path);

} // namespace nurbs

#endif
