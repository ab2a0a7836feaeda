// SPDX-License-Identifier: BSD-3-Clause
/// @file SegmentCrossings.h
/// @brief The pixels in which segments cross.
///
/// Source: I. J. Balaban, "An optimal algorithm for finding segments intersections", Symposium on
/// Computational Geometry 1995, the intermediate algorithm: O(n log^2 n + k) for k crossings.
#pragma once

#include "SnapRounding.h"

namespace nurbs
{

/// A segment between two different grid points, Start < End.
struct GridLine
{
  GridPoint Start;
  GridPoint End;
};

/// Twice the area of a triangle a, b, c: over 0 if it turns left. Exact for grid points.
inline std::int64_t Turn(const GridPoint& a, const GridPoint& b, const GridPoint& c)
{
  return (b.X - a.X) * (c.Y - a.Y) - (b.Y - a.Y) * (c.X - a.X);
}

/// The grid points whose pixels contain a point in the interior of two lines that are not parallel;
/// sorted, each once. Points where a line ends on another one are not looked for. `goOn` is called
/// from any thread with the share done; after it said no, the result is of no use.
std::vector<GridPoint> CrossingPixels(const std::vector<GridLine>& lines,
  const ParallelFor& parallel, const std::function<bool(double)>& goOn);

} // namespace nurbs
