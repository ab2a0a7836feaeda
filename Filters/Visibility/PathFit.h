// SPDX-License-Identifier: BSD-3-Clause
/// @file PathFit.h
/// @brief Plane polylines as few cubic Bezier pieces and straight lines, within a tolerance.
///
/// A drawing's lines are polylines, dense enough for the precision they were made for. Written as
/// such, a circle is hundreds of segments that show when they are enlarged and cannot be edited.
/// Here corners and straight runs are found, and what lies between is fitted by least squares, the
/// longest pieces first; the pieces of a smooth run have a common tangent where they meet.
///
/// Source: P. J. Schneider, "An algorithm for automatically fitting digitized curves", Graphics
/// Gems (1990), from which the fit of a piece with given end tangents and the improved parameters
/// come. Different here: pieces are as long as they can be (bisection) rather than halved; corners
/// are told by lengths as well as by angles; end tangents at corners are free; and the distance is
/// a bound of the whole curves, both ways, where Schneider looks at the points.
#pragma once

#include "Types.h"

#include <array>
#include <vector>

namespace nurbs
{

/// A cubic Bezier piece of a path; a straight one has its control points evenly on its chord.
struct PathPiece
{
  std::array<Vec2, 4> Points;
  bool Straight = false;
};

/// Pieces that go on in each other, in the polyline's direction.
struct FittedPath
{
  std::vector<PathPiece> Pieces; ///< Empty if the polyline has fewer than two different points.
  bool Closed = false;           ///< The last piece ends where the first starts, exactly.
};

/// Whether two parts of a polyline that meet form a corner: no curve through the three points with
/// a continuous tangent bows by `tolerance` or less. `before` leads to the common point, `after`
/// from it on; each should be as long as a chord within the tolerance can be.
bool IsCorner(const Vec2& before, const Vec2& after, double tolerance);

/// Fits pieces to a polyline whose points are finite.
///
/// The distance between polyline (with all of its segments) and path is `tolerance` at most, in
/// both directions: no point of either is farther from the other. The ends are kept exactly; so are
/// corners. A polyline that ends in its first point is closed, and smooth there unless that point
/// is a corner. Points that repeat are harmless. `tolerance` (positive) must be no finer than what
/// the polyline was made for, else its own vertices are corners.
FittedPath FitPath(const std::vector<Vec2>& polyline, double tolerance);

/// The chord that leads from a polyline's first point into it (`end` 0) or to its last point (1),
/// as long as a straight line keeps within half the tolerance of the polyline: what IsCorner wants.
Vec2 ChordAtEnd(const std::vector<Vec2>& polyline, int end, double tolerance);

/// The vertices of a polyline that FitPath takes for corners (the ends of an open one not
/// included).
std::vector<std::size_t> FindCorners(const std::vector<Vec2>& polyline, double tolerance);

} // namespace nurbs
