// SPDX-License-Identifier: BSD-3-Clause
/// @file FeatureEdges.h
/// @brief Edges of a model by kind, as polylines on the surfaces.
#pragma once

#include "CompletedModel.h"
#include "PatchContour.h"

namespace nurbs
{

/// What a line of a drawing is.
enum class LineKind
{
  Silhouette = 0, ///< normal . view = 0, or changes its sign.
  Boundary,       ///< An edge that one face uses once.
  Sharp,          ///< An edge whose faces' normals differ by more than the feature angle somewhere,
                  ///< or of more than two faces.
  Smooth,         ///< Another edge, also a seam.
  Intersection    ///< Where two faces pierce each other; of visible regions only.
};
inline constexpr int LineKindCount = 4; ///< Of silhouettes and edges.

/// True if the control points lie in a plane, to 1e-10 of their size, and not on a line.
bool IsPlanar(const SurfaceView& surface);

/// The uses of every edge by faces without an error.
std::vector<std::vector<EdgeUse>> UsesOfEdges(
  const Model& model, const std::vector<std::string>& faceErrors);

/// The kind of an edge that is used and not degenerate. `featureAngle` in radians; the angle is looked
/// at in nine places. Where neighbours do not agree on the outside, they are taken to.
LineKind KindOfEdge(
  const Model& model, std::int64_t edge, const std::vector<EdgeUse>& uses, double featureAngle);

/// The part `range` (parameters of the trim curve, Min < Max) of a use lifted to its surface, in the
/// edge's direction, within `precision`. `parameters` receives those of the trim curve.
std::vector<ContourPoint> LiftEdge(const Model& model, const EdgeUse& use, const Interval& range,
  double precision, std::vector<double>* parameters = nullptr);

} // namespace nurbs
