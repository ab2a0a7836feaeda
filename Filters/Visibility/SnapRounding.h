// SPDX-License-Identifier: BSD-3-Clause
/// @file SnapRounding.h
/// @brief Segments between grid points, rounded so that they only meet in grid points.
///
/// Source: J. D. Hobby, "Practical segment intersection with finite precision output",
/// Computational Geometry 13, 1999; L. J. Guibas, D. H. Marimont, "Rounding arrangements
/// dynamically", Int. J. of Computational Geometry & Applications 8, 1998.
///
/// A pixel is the unit square [X - 1/2, X + 1/2) x [Y - 1/2, Y + 1/2) around the grid point (X, Y),
/// so that every point of the plane is in exactly one. A pixel is hot if it contains an end point
/// of a segment or the exact point where two segments cross. Each segment becomes the polyline
/// through the centres of the hot pixels that it passes, in its order. No two edges cross then or
/// pass through a vertex, and no point moves by more than sqrt(1/2).
///
/// We differ from the papers in how crossings are found: by Balaban's search (SegmentCrossings.h)
/// instead of Bentley and Ottmann's sweep, as it needs no order of the crossings themselves; and in
/// how hot pixels on a segment are found: by a tree of boxes (HotPixelTree.h). CGAL's
/// Snap_rounding_2 (5.5) takes some 50 times as long: 4.3 s for 30,000 random segments with about
/// as many crossings, where this takes 0.08 s on the same core.
///
/// All predicates are exact. Coordinates are at most 2^29 in magnitude, so differences are at most
/// 2^30 and cross products of them at most 2^61, also doubled in 64 bits. Two segments are compared
/// on a vertical line by numbers below 2^92 and crossings rounded by numbers below 2^94, in 128
/// bits.
#pragma once

#include "Types.h"

#include <array>

namespace nurbs
{

/// The largest magnitude of a coordinate.
inline constexpr std::int64_t GridLimit = std::int64_t(1) << 29;

/// A point of the grid of pixels.
struct GridPoint
{
  std::int64_t X = 0;
  std::int64_t Y = 0;

  /// The same point.
  bool operator==(const GridPoint& p) const { return this->X == p.X && this->Y == p.Y; }
  /// Another point.
  bool operator!=(const GridPoint& p) const { return !(*this == p); }
  /// By x, then by y.
  bool operator<(const GridPoint& p) const
  {
    return this->X != p.X ? this->X < p.X : this->Y < p.Y;
  }
};

/// Indices into the points.
struct GridSegment
{
  std::int32_t Start = 0;
  std::int32_t End = 0;
};

/// Edges that meet at their ends only, and the way of every segment along them.
struct SnappedSegments
{
  /// The hot pixels' centres, sorted by X, then Y. Points that no segment uses are not among them.
  std::vector<GridPoint> Vertices;
  /// Pairs of vertices Start < End, sorted, each once. Segments that coincide share edges.
  std::vector<std::array<std::int32_t, 2>> Edges;
  /// Path[PathStart[s]] to Path[PathStart[s + 1] - 1] is the polyline of segment s; segments + 1.
  std::vector<std::int64_t> PathStart;
  /// Edges by index, or ~edge where one is run from its End to its Start.
  std::vector<std::int32_t> Path;
  bool Aborted = false; ///< `progress` ended the work; the arrays are empty.
};

/// Rounds `segments`. Those of length zero make their pixel hot and have an empty path. The result
/// does not depend on `parallel`, nor, apart from the paths' order, on the order of the segments.
/// Costs O(n log^2 n + k) for k crossings, and the search of hot pixels for each segment.
/// `progress` is called from any thread with the share done; false: stop. Throws Error if a
/// coordinate exceeds GridLimit, an index is out of range, or there are more than 2^31 - 1 vertices
/// or edges, or more than 2^31 - 1 segments.
SnappedSegments SnapRound(const std::vector<GridPoint>& points,
  const std::vector<GridSegment>& segments, const ParallelFor& parallel = SerialFor,
  const std::function<bool(double)>& progress = nullptr);

} // namespace nurbs
