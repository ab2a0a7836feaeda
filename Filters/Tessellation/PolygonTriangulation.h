// SPDX-License-Identifier: BSD-3-Clause
/// @file PolygonTriangulation.h
/// @brief Polygons into triangles: convex ones in linear time, others with holes in O(n log n).
///
/// Source: Balazs, Guthe, Klein 2004, section 7, after Garey, Johnson, Preparata and Tarjan 1978:
/// the polygon is cut into pieces that are monotone in v, which are triangulated in linear time. The
/// pieces are found by travelling along directed half-edges as in section 6. All decisions are exact
/// (CGAL's orientation of three points).
///
/// Vertices are numbered through all loops in order. Triangles are counter-clockwise, three vertex
/// numbers each. Every vertex is a corner; no vertex is added.
#pragma once

#include "Types.h"

namespace nurbs
{

/// Triangulates a convex, counter-clockwise polygon whose sides may be subdivided by vertices on
/// them (a cell with its neighbours' vertices), in linear time: n - 2 triangles, each with positive
/// area. Corners are cut off in turn, never so that what remains is a line, which is what the paper's
/// zip from the upper left vertex can end in.
///
/// A polygon with fewer than three vertices gives none; one without area gives a fan of triangles
/// without area. If the polygon is not convex the result covers its hull wrongly: see IsConvex.
std::vector<int> TriangulateConvex(const std::vector<Vec2>& polygon);

/// True if no vertex of the counter-clockwise polygon turns right, in linear time (section 7), and
/// the polygon goes round once.
bool IsConvex(const std::vector<Vec2>& polygon);

/// Triangulates the region between loops that do not cross: outer loops counter-clockwise, holes
/// clockwise, any number of each, islands in holes too. n - 2 + 2 h triangles for each outer loop
/// with h holes and n vertices together. Vertices may lie on straight sides.
///
/// O(n log n). Throws Error if the loops cross, touch in a vertex, run the wrong way or repeat a
/// vertex, as far as that keeps the region from being covered once; RepairLoops helps with most of
/// it.
std::vector<int> TriangulatePolygon(const std::vector<std::vector<Vec2>>& loops);

} // namespace nurbs
