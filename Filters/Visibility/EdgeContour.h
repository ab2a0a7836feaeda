// SPDX-License-Identifier: BSD-3-Clause
/// @file EdgeContour.h
/// @brief Where one of an edge's two faces faces the viewer and the other one does not.
///
/// Neighbours that meet nearly smoothly end their contours in slightly different points of their
/// edge. Between these the edge itself is the contour, and joins them.
#pragma once

#include "FeatureEdges.h"

namespace nurbs
{

/// A part of an edge that is a contour, on the face that faces the viewer; that lies on its left, seen
/// from outside.
struct EdgeContour
{
  EdgeUse Use;
  std::vector<ContourPoint> Points;
  double Ends[2] = { 0.0, 0.0 }; ///< Parameters of the trim curve at the first and last point.
};

/// Outer normal . view, of unit vectors, of a use's face where the parameter of the edge, which has the
/// domain given, is t.
double CosineOfUse(
  const Model& model, const EdgeUse& use, const Interval& domain, const Viewer& viewer, double t);

/// The parts of an edge with two uses. normal . view is looked at in 17 places of both faces and
/// its changes of sign are bisected; what is within 1e-9 of 0 faces neither way.
std::vector<EdgeContour> ContoursOfEdge(const Model& model, std::int64_t edge,
  const std::vector<EdgeUse>& uses, const Viewer& viewer, double precision);

/// True if an edge has two uses, whose faces lie on either side of it in the image and face the same
/// way along it, towards the viewer or away, in five places of both. Unless a silhouette meets the
/// edge, it hides nothing then.
bool FaceTheSameWay(
  const Model& model, std::int64_t edge, const std::vector<EdgeUse>& uses, const Viewer& viewer);

} // namespace nurbs
