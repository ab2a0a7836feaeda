// SPDX-License-Identifier: BSD-3-Clause
/// @file RectangleTriangulation.h
/// @brief Triangles of a cell of a grid that may have vertices of its neighbours on its sides.
#pragma once

#include "Types.h"

#include <array>

namespace nurbs
{

/// Triangulates a rectangle with vertices at its corners and anywhere on its sides; no triangle has
/// its three corners on one side.
/// @param corners its vertices in [0, 1] x [0, 1], counter-clockwise, at least 4.
/// @param points their places in space, where the shorter diagonals are preferred.
/// Returns triangles of the vertices' indices, counter-clockwise.
std::vector<std::array<int, 3>> TriangulateRectangle(
  const std::vector<Vec2>& corners, const std::vector<Vec3>& points);

} // namespace nurbs
