// SPDX-License-Identifier: BSD-3-Clause
/// @file PlanarMap.h
/// @brief The cells into which snapped segments divide the plane.
///
/// A cell is a connected component of the plane without the edges; it may have holes, and edges may
/// end in it. Cells come from a constrained Delaunay triangulation (CGAL, with predicates of our
/// own that are exact on the grid): triangles that share an edge which is not a segment's are in
/// one cell. All lengths are in pixels.
#pragma once

#include "SnapRounding.h"

namespace nurbs
{

/// A point well inside a cell: no edge comes nearer than the radius. Positions are rounded to
/// doubles, which matters for radii below 1e-6 at coordinates of 2^29.
struct PlanarSample
{
  Vec2 Point = Vec2::Zero();
  double Radius = 0.0;
};

/// A side of a triangle between two vertices that is no edge of the map.
struct PlanarDiagonal
{
  std::int32_t Start = 0, End = 0; ///< Start < End.
  std::int32_t Cell = 0;
};

/// The default of how far PlanarMap::SideSamples go; pixels.
inline constexpr double SideReach = 4.0;

/// The cells of an arrangement of edges.
struct PlanarMap
{
  /// Cell 0 is the unbounded one; others are numbered as the edges meet them, left before right.
  std::int32_t CellCount = 0;
  /// For each edge the cell to the left and to the right of its way from Start to End.
  std::vector<std::array<std::int32_t, 2>> Sides;
  /// A point in the cell beside the edge, on each side: on the perpendicular through the edge's middle,
  /// half way to the next edge, but so far away at most; the radius is the distance from the edge
  /// (another edge may pass nearer).
  std::vector<std::array<PlanarSample, 2>> SideSamples;
  /// Area of each cell without its holes; infinity for cell 0.
  std::vector<double> Areas;
  /// Samples[SampleStart[c]] to Samples[SampleStart[c + 1] - 1] are the largest incircles of the
  /// triangles of cell c, the largest first, at least one; CellCount + 1. Cell 0 has one sample, a
  /// pixel to the left of and below the box around all vertices.
  std::vector<std::int64_t> SampleStart;
  std::vector<PlanarSample> Samples;
  bool Aborted = false; ///< `progress` ended the work; the arrays are empty.
  /// On demand: what divides the bounded cells into triangles, each once.
  std::vector<PlanarDiagonal> Diagonals;
};

/// The cells of `segments`, the edges of which must not cross or touch other than in vertices, as
/// SnapRound makes them; paths are not used. `samplesPerCell` >= 1: the most samples of a cell.
/// `diagonals`: make PlanarMap::Diagonals, too. `sideReach`: of PlanarMap::SideSamples. `progress` is called with the share done; false: stop. Throws Error if samplesPerCell < 1, a
/// coordinate exceeds GridLimit, vertices are equal, an edge names a vertex that isn't there, edges
/// aren't pairs Start < End in increasing order, or edges cross or pass through vertices.
PlanarMap MakePlanarMap(const SnappedSegments& segments, int samplesPerCell = 1,
  const std::function<bool(double)>& progress = nullptr, bool diagonals = false,
  double sideReach = SideReach);

} // namespace nurbs
