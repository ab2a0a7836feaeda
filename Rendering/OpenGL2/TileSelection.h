// SPDX-License-Identifier: BSD-3-Clause
/// @file TileSelection.h
/// @brief Which parts of the surfaces a view needs, and how finely.
///
/// A surface is drawn as a grid of vertices, 2^k cells in each of its knot spans. A triangle of a cell
/// of a x b (shares of the span) is off the surface by at most
///   1/8 (a^2 |S_uu| + 2 a b |S_uv| + b^2 |S_vv|)
/// (SurfaceBound.h), and on screen by that times the pixels of a unit of length at the patch's
/// nearest point. All visible spans of a column of patches have the same number of cells in u, and
/// all of a row in v, so that a surface has no T-vertex. The grid is cut into tiles of at most
/// 16 x 16 cells, and those that the view does not see are left out.
#pragma once

#include "SurfaceTable.h"

namespace nurbs
{

/// The camera as a kernel sees it.
struct TileView
{
  Eigen::Matrix4d ModelToClip =
    Eigen::Matrix4d::Identity(); ///< Clip coordinates, -w <= x, y, z <= w.
  int Size[2] = { 1, 1 };        ///< Of the viewport, in pixels.
  double Near = 1.0;       ///< Least w of what is seen: the near plane's distance; parallel: 1.
  double PixelError = 0.5; ///< Bound of the distance between triangles and surface on screen.
};

/// A rectangle of cells in one patch.
struct Tile
{
  static constexpr int MaxLog = 4;      ///< A tile has at most 2^MaxLog cells a direction.
  static constexpr int MaxSpanLog = 12; ///< A span has at most 2^MaxSpanLog.

  int Surface = 0;
  int Span[2] = { 0, 0 };  ///< Index of its knot spans.
  int Log[2] = { 0, 0 };   ///< Cells in the whole span, binary logarithm.
  int First[2] = { 0, 0 }; ///< First cell.

  /// Cells of the tile, binary logarithm.
  int CellsLog(int dir) const { return this->Log[dir] < MaxLog ? this->Log[dir] : MaxLog; }
  /// Which of the (MaxLog + 1)^2 shapes it has.
  int Shape() const { return this->CellsLog(0) + (MaxLog + 1) * this->CellsLog(1); }
  static constexpr int ShapeCount = (MaxLog + 1) * (MaxLog + 1);

  /// The same cells of the same spans.
  bool operator==(const Tile& other) const;
};

/// What a view needs.
struct TileSelection
{
  std::vector<Tile> Tiles; ///< Sorted by surface.
  double PixelError = 0.0; ///< Bound that the tiles keep, over the asked one if spans are capped.
  std::int64_t Cells = 0;  ///< Of all tiles.
};

/// The tiles of one surface, appended to `selection`.
void SelectTiles(
  const SurfaceTable& table, int surface, const TileView& view, TileSelection& selection);

/// Pixels of a unit of length at least depth w (clip coordinate) under a view, at most.
double PixelsPerUnit(const TileView& view, double w);

} // namespace nurbs
