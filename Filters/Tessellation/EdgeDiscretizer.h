// SPDX-License-Identifier: BSD-3-Clause
/// @file EdgeDiscretizer.h
/// @brief One polyline an edge, the same for every face that uses it.
///
/// Source: Balazs, Guthe, Klein 2004, sections 4 and 5.1, and for watertightness ours: the edge's 3D
/// curve alone decides where its points lie; each face that uses it may ask for more points, where
/// the straight line between two of them in the face's own parameter domain would leave the surface
/// by more than the tolerance.
#pragma once

#include "CompletedModel.h"
#include "SurfaceTree.h"

namespace nurbs
{

/// An edge as a polyline.
struct EdgePolyline
{
  std::vector<double> Parameters; ///< In the edge's (first trim curve's) parameter, ascending.
  std::vector<Vec3> Points;       ///< One a parameter; the ends are the model's vertices.
  double Error = 0.0;             ///< Bound of the curve's distance from the polyline.
  double Gap = 0.0;               ///< Largest distance of the edge's curve from its faces' own.
  double VertexGap = 0.0;         ///< Largest distance of the vertices from the curve's ends.
  bool Degenerate = false;        ///< One point: a pole; faces place their own points on it.
};

/// What the faces know that an edge must respect.
struct FaceContext
{
  const SurfaceBound* Bound = nullptr;
  const SurfaceTree* Tree = nullptr; ///< Null: planar face, any chord lies on it.
  double Tolerance = 0.0;
};

/// Discretises one edge.
/// @param extra parameters that must be vertices, too (from faces that could not certify without).
EdgePolyline DiscretizeEdge(const Model& model, std::int64_t edge, const std::vector<EdgeUse>& uses,
  const std::vector<FaceContext>& faces, double tolerance, const TessellatorOptions& options,
  const std::vector<double>& extra);

} // namespace nurbs
