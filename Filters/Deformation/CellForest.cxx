// SPDX-License-Identifier: BSD-3-Clause
#include "CellForest.h"

namespace nurbs
{

CellForest::CellForest(const FaceGrid& grid)
  : Grid(grid)
{
  for (int patch = 0; patch < grid.Patches(); ++patch)
  {
    Cell cell;
    cell.I = std::uint32_t(grid.Column(patch)) << ColumnBits;
    cell.J = std::uint32_t(grid.Row(patch)) << ColumnBits;
    cell.Width = cell.Height = ColumnUnits;
    cell.Patch = patch;
    this->Cells.push_back(cell);
  }
}

std::int32_t CellForest::LeafAt(std::int64_t i, std::int64_t j) const
{
  if (i < 0 || j < 0 || i >= this->Grid.Axis[0].Last() || j >= this->Grid.Axis[1].Last())
  {
    return -1;
  }
  return this->Descend(this->Grid.Patch(int(i >> ColumnBits), int(j >> ColumnBits)), i, j);
}

std::int32_t CellForest::LeafNear(std::int32_t cell, std::int64_t i, std::int64_t j) const
{
  for (std::int32_t at = cell; at >= 0; at = this->Cells[at].Parent)
  {
    const Cell& c = this->Cells[at];
    if (c.Patch >= 0 && i >= c.I && j >= c.J && i < std::int64_t(c.I) + c.Width &&
      j < std::int64_t(c.J) + c.Height)
    {
      return this->Descend(at, i, j);
    }
  }
  return this->LeafAt(i, j);
}

ParameterBox CellForest::Box(std::int32_t index) const
{
  const Cell& cell = this->Cells[index];
  return { this->Grid.Axis[0].Parameter(cell.I), this->Grid.Axis[0].Parameter(cell.I + cell.Width),
    this->Grid.Axis[1].Parameter(cell.J), this->Grid.Axis[1].Parameter(cell.J + cell.Height) };
}

bool CellForest::CanSplit(std::int32_t cell, int direction) const
{
  return (direction == 0 ? this->Cells[cell].Width : this->Cells[cell].Height) > SmallestSize;
}

std::int32_t CellForest::Split(std::int32_t index, int direction)
{
  std::int32_t child;
  if (!this->FreePairs.empty())
  {
    child = this->FreePairs.back();
    this->FreePairs.pop_back();
  }
  else
  {
    child = this->Size();
    this->Cells.resize(this->Cells.size() + 2);
  }
  Cell half;
  const Cell& whole = this->Cells[index];
  half.I = whole.I;
  half.J = whole.J;
  half.Width = direction == 0 ? whole.Width / 2 : whole.Width;
  half.Height = direction == 1 ? whole.Height / 2 : whole.Height;
  half.Patch = whole.Patch;
  half.Parent = index;
  // What surrounds a cell that no loop touches is the same for its halves.
  half.State = whole.State == CellState::Cut ? CellState::New : whole.State;
  this->Cells[index].Child = child;
  this->Cells[child] = half;
  half.I += direction == 0 ? half.Width : 0;
  half.J += direction == 1 ? half.Height : 0;
  this->Cells[child + 1] = half;
  return child;
}

void CellForest::Merge(std::int32_t index)
{
  Cell& cell = this->Cells[index];
  const CellState first = this->Cells[cell.Child].State;
  const CellState second = this->Cells[cell.Child + 1].State;
  cell.State = first == second && first != CellState::Cut ? first : CellState::New;
  this->Cells[cell.Child].Patch = this->Cells[cell.Child + 1].Patch = -1;
  cell.Child = -1;
}

} // namespace nurbs
