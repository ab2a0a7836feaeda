// SPDX-License-Identifier: BSD-3-Clause
/// @file EdgeExport.h
/// @brief Edges and vertices of a model as a boundary representation needs them: every edge with a
/// 3D curve, and tolerances that are measured.
///
/// A model's edge may have no curve, or one that its faces no longer follow since they were moved.
/// Then its curve is computed from a trim curve on its surface: exactly where that runs along u or v
/// or on a plane, else fitted. The tolerance of an edge is the largest distance between its curve
/// and the lifted trim curves of all of its faces, at equal parameters, measured densely. An edge
/// whose faces are farther apart than allowed is torn: each face gets an edge of its own.
#pragma once

#include "CompletedModel.h"

#include <atomic>

namespace nurbs
{

struct EdgeExportOptions
{
  double CurveTolerance = 0.0; ///< What a fitted curve may deviate, length.
  double Negligible = 0.0;     ///< Deviations up to this need no closer look, length.
  double Gap = 0.0; ///< Faces up to this far apart share an edge, length; or up to its tolerance.
};

/// An edge of one face or of several.
struct ExportEdge
{
  std::int64_t Source = -1; ///< Index into the edges of the model.
  std::vector<EdgeUse> Uses;
  bool Pole = false;      ///< A point; then there is no curve.
  Curve<3> Geometry;      ///< Packed.
  Interval Range;         ///< Of the parameter.
  double Tolerance = 0.0; ///< Measured, length.
  bool Computed = false;  ///< The curve is not the model's.
  bool Torn = false;      ///< The model has one edge where there are several now.
  std::int64_t Vertex[2] = { -1, -1 };
};

struct ExportVertex
{
  Vec3 Place = Vec3::Zero();
  double Tolerance = 0.0; ///< Largest distance of what ends here, length.
};

struct ExportEdges
{
  std::vector<ExportEdge> Edges;
  std::vector<ExportVertex> Vertices;
  std::vector<std::int64_t> EdgeOf; ///< One a trim curve of the model; -1: of a face that fails.
};

/// Edges of the faces without an error. Gives up when `abort` becomes true. The result does not
/// depend on `parallel`.
ExportEdges PrepareEdges(const CompletedModel& model, const std::vector<std::string>& faceErrors,
  const EdgeExportOptions& options, const ParallelFor& parallel, const std::atomic<bool>& abort);

} // namespace nurbs
