// SPDX-License-Identifier: BSD-3-Clause
/// @file CellForest.h
/// @brief The cells of a face: one binary tree a Bezier patch, halved in u or v.
///
/// Li, Lau, Green 1997, section 4, have quadtrees; halving in one direction leaves long cells on
/// surfaces that are curved one way, as most faces of machine parts are.
#pragma once

#include "FaceGrid.h"

#include <limits>

namespace nurbs
{

/// What a leaf is to the face's loops.
enum class CellState : std::uint8_t
{
  New,    ///< Not known yet.
  Inside, ///< Has triangles of its own.
  Cut,    ///< Part of the zone along the loops.
  Outside
};

/// A cell; its sides are lines of the grid.
struct Cell
{
  std::uint32_t I = 0, J = 0;          ///< The lower lines.
  std::uint32_t Width = 0, Height = 0; ///< In units of coordinates.
  std::int32_t Patch = -1;             ///< -1: its place is free.
  std::int32_t Child = -1;     ///< The first of two that lie one after the other; -1: a leaf.
  std::int32_t Parent = -1;    ///< -1: a whole patch.
  std::int32_t Triangles = -1; ///< The first; -1: none.
  std::int32_t Corners[4] = { -1, -1, -1, -1 }; ///< Points, counter-clockwise; if Built.
  CellState State = CellState::New;
  bool Built = false; ///< Has triangles and uses its corners.
  bool Dirty = false; ///< Its triangles have to be made again.
  /// The error with which it was halved for the zone's sake; 0: it was not.
  double ForcedAt = 0.0;
  /// Bounds of the error when it was last measured, less (plus) what its patch's moves until then could
  /// change of it (PatchErrors.h); infinite: never.
  double Up = std::numeric_limits<double>::infinity();
  double Low = 0.0;
};

/// All cells of a face.
class CellForest
{
public:
  static constexpr std::uint32_t SmallestSize = 16; ///< Units: cells are halved 12 times at most.

  /// One cell a patch of the grid.
  explicit CellForest(const FaceGrid& grid);

  /// A cell by its number.
  Cell& operator[](std::int32_t cell) { return this->Cells[cell]; }
  /// Likewise.
  const Cell& operator[](std::int32_t cell) const { return this->Cells[cell]; }
  /// Places of cells, free ones included.
  std::int32_t Size() const { return std::int32_t(this->Cells.size()); }
  /// True if the cell is not halved.
  bool IsLeaf(std::int32_t cell) const { return this->Cells[cell].Child < 0; }
  /// The leaf that a place (not on a line) or the half-open cell at a line belongs to; -1: outside.
  std::int32_t LeafAt(std::int64_t i, std::int64_t j) const;
  /// The same, found from a cell nearby, which may be one that was merged.
  std::int32_t LeafNear(std::int32_t cell, std::int64_t i, std::int64_t j) const;
  /// The cell's part of the domain.
  ParameterBox Box(std::int32_t cell) const;
  /// False if the halves would be smaller than SmallestSize.
  bool CanSplit(std::int32_t cell, int direction) const;
  /// Halves a leaf. The halves are new leaves.
  std::int32_t Split(std::int32_t cell, int direction);
  /// Makes a leaf of a cell whose halves are leaves. They keep all but their patch till GiveBack.
  void Merge(std::int32_t cell);
  /// Gives the places of two merged halves back.
  void GiveBack(std::int32_t child) { this->FreePairs.push_back(child); }

  /// Calls f(leaf) for every leaf of a cell.
  template <typename F>
  void ForLeaves(std::int32_t cell, const F& f) const
  {
    const std::int32_t child = this->Cells[cell].Child;
    if (child < 0)
    {
      f(cell);
      return;
    }
    this->ForLeaves(child, f);
    this->ForLeaves(child + 1, f);
  }
  /// Calls f(leaf) for every leaf along a side of the grid (0: first v, 1: last u, 2: last v, 3: first
  /// u), in ascending order.
  template <typename F>
  void ForSide(int side, const F& f) const
  {
    const std::uint32_t last[2] = { this->Grid.Axis[0].Last(), this->Grid.Axis[1].Last() };
    std::int64_t at = 0;
    while (at < last[side % 2])
    {
      const std::int64_t across = side == 0 || side == 3 ? 0 : std::int64_t(last[1 - side % 2]) - 1;
      const std::int32_t leaf = side % 2 == 0 ? this->LeafAt(at, across) : this->LeafAt(across, at);
      f(leaf);
      const Cell& cell = this->Cells[leaf];
      at = side % 2 == 0 ? std::int64_t(cell.I) + cell.Width : std::int64_t(cell.J) + cell.Height;
    }
  }

private:
  std::int32_t Descend(std::int32_t cell, std::int64_t i, std::int64_t j) const
  {
    while (this->Cells[cell].Child >= 0)
    {
      const std::int32_t child = this->Cells[cell].Child;
      const Cell& second = this->Cells[child + 1];
      cell = child + (i >= second.I && j >= second.J ? 1 : 0);
    }
    return cell;
  }

  const FaceGrid& Grid;
  std::vector<Cell> Cells;
  std::vector<std::int32_t> FreePairs;
};

} // namespace nurbs
