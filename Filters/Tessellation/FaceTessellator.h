// SPDX-License-Identifier: BSD-3-Clause
/// @file FaceTessellator.h
/// @brief One trimmed face to triangles, given its surface tree and its edges' polylines.
///
/// Cells that no trim line comes near are triangulated for themselves (Balazs section 7, convex
/// polygons in linear time); the zone between them and the trim polylines by a constrained Delaunay
/// triangulation. Every triangle is then certified by the bound of FacetBound.h; those that fail
/// get another vertex.
#pragma once

#include "CellZone.h"
#include "EdgeDiscretizer.h"

namespace nurbs
{

/// A parameter at which an edge must have a vertex before a face can be finished.
struct SplitRequest
{
  std::int64_t Edge = -1;
  double T = 0.0;
};

/// Everything a face's triangulation starts from.
struct FaceJob
{
  const Model* Data = nullptr;
  std::int64_t Face = -1;
  const SurfaceBound* Bound = nullptr;
  const SurfaceTree* Tree = nullptr; ///< Null: the surface is planar.
  const std::vector<EdgePolyline>* Edges = nullptr;
  const TessellatorOptions* Options = nullptr;
  double Tolerance = 0.0;
  Vec2 Snap = Vec2(0.0, 0.0); ///< Boundary vertices so near to a crease (in u, v) are put on it.
  std::vector<LeafState>* States = nullptr; ///< Kept from pass to pass; see CellZone.
  bool LastPass = false;                    ///< No more requests: repair or report instead.
  ParallelFor Parallel = SerialFor;
};

/// Triangulates a face.
/// @param requests receives what its edges need; if any, the mesh is not final.
/// @param weakLeaves receives the tree's leaves whose triangles could not be certified.
FaceMesh TessellateFace(
  const FaceJob& job, std::vector<SplitRequest>& requests, std::vector<int>& weakLeaves);

} // namespace nurbs
