// SPDX-License-Identifier: BSD-3-Clause
/// @file ZoneTriangulation.h
/// @brief Constrained Delaunay triangulation between a grid's cells and trim polylines.
#pragma once

#include "Types.h"

#include <array>

namespace nurbs
{

/// What is to be triangulated, in a plane where the grid's cells are about square.
struct Zone
{
  std::vector<Vec2> Points;
  std::vector<std::array<int, 2>> Walls; ///< The zone is where an odd number of walls was crossed.
  std::vector<std::array<int, 2>> Lines; ///< No triangle crosses them.
};

/// Its triangles, counter-clockwise, of the points' indices and then of those of `Added`.
struct ZoneTriangles
{
  std::vector<std::array<int, 3>> Triangles;
  std::vector<Vec2> Added; ///< Where walls cross each other; empty for sound polylines.
};

/// Triangulates. Predicates are exact.
ZoneTriangles TriangulateZone(const Zone& zone);

} // namespace nurbs
