// SPDX-License-Identifier: BSD-3-Clause
// A face's loops, and which of its cells they leave whole.
#include "DeformingFace.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

constexpr double Margin = 0.2; // Of a cell: loops that come nearer cut it.

// True if the segment from a to b meets the box.
bool Meets(const Vec2& a, const Vec2& b, const ParameterBox& box)
{
  const double low[2] = { box.U0, box.V0 };
  const double high[2] = { box.U1, box.V1 };
  double t0 = 0.0;
  double t1 = 1.0;
  for (int d = 0; d < 2; ++d)
  {
    const double step = b[d] - a[d];
    if (step == 0.0)
    {
      if (a[d] < low[d] || a[d] > high[d])
      {
        return false;
      }
      continue;
    }
    double s0 = (low[d] - a[d]) / step;
    double s1 = (high[d] - a[d]) / step;
    if (s0 > s1)
    {
      std::swap(s0, s1);
    }
    t0 = std::max(t0, s0);
    t1 = std::min(t1, s1);
  }
  return t0 <= t1;
}

ParameterBox Widened(const ParameterBox& box, double share)
{
  const double a = share * box.A();
  const double b = share * box.B();
  return { box.U0 - a, box.U1 + a, box.V0 - b, box.V1 + b };
}

} // namespace

void DeformingFace::SetLoops(std::vector<std::vector<LoopSegment>> loops, bool inside)
{
  this->Loops = std::move(loops);
  this->SidesChanged = true;
  this->HasInnerPieces = false;
  for (std::vector<SideSegment>& side : this->Sides)
  {
    side.clear();
  }
  this->SegmentFrom.assign(this->LoopVertices.size(), nullptr);
  for (const std::vector<LoopSegment>& loop : this->Loops)
  {
    for (const LoopSegment& s : loop)
    {
      this->SegmentFrom[s.A] = &s;
      if (s.Side < 0)
      {
        this->HasInnerPieces = true;
        continue;
      }
      const LoopVertex& a = this->LoopVertices[s.A];
      const LoopVertex& b = this->LoopVertices[s.B];
      const int d = s.Side % 2;
      const bool ascending = a.UV[d] < b.UV[d];
      SideSegment segment;
      segment.Start = std::min(a.UV[d], b.UV[d]);
      segment.Line[0] = ascending ? a.Line[d] : b.Line[d];
      segment.Line[1] = ascending ? b.Line[d] : a.Line[d];
      segment.Vertex[0] = ascending ? s.A : s.B;
      segment.Vertex[1] = ascending ? s.B : s.A;
      segment.A = a.Point;
      segment.B = b.Point;
      this->Sides[s.Side].push_back(segment);
    }
  }
  for (std::vector<SideSegment>& side : this->Sides)
  {
    std::stable_sort(side.begin(), side.end(),
      [](const SideSegment& a, const SideSegment& b) { return a.Start < b.Start; });
  }
  this->LoopsChanged = this->LoopsChanged || inside;
}

void DeformingFace::SetLine(std::int32_t index, int side, std::int64_t line)
{
  LoopVertex& vertex = this->LoopVertices[index];
  const int d = side % 2;
  const std::int64_t across = side == 0 || side == 3 ? 0 : this->Lines.Axis[1 - d].Last();
  if (vertex.Line[d] == line && vertex.Line[1 - d] == across)
  {
    return;
  }
  this->Unregister(vertex);
  vertex.Line[d] = line;
  vertex.Line[1 - d] = across;
  if (line >= 0)
  {
    const std::uint64_t key = this->Key(vertex.Line[0], vertex.Line[1]);
    FlatIndex& table = this->TableOf(vertex.Line[0], vertex.Line[1]);
    if (table.Find(key) < 0)
    {
      table.Set(key, vertex.Point);
    }
  }
}

void DeformingFace::Unregister(const LoopVertex& vertex)
{
  if (vertex.Line[0] >= 0 && vertex.Line[1] >= 0)
  {
    const std::uint64_t key = this->Key(vertex.Line[0], vertex.Line[1]);
    FlatIndex& table = this->TableOf(vertex.Line[0], vertex.Line[1]);
    if (table.Find(key) == vertex.Point)
    {
      table.Remove(key);
    }
  }
}

// Inside is where an odd number of segments lies to one side. Those of loops along sides count, too.
bool DeformingFace::IsInside(const Vec2& uv) const
{
  bool inside = false;
  for (const std::vector<LoopSegment>& loop : this->Loops)
  {
    for (const LoopSegment& s : loop)
    {
      const Vec2& a = this->LoopVertices[s.A].UV;
      const Vec2& b = this->LoopVertices[s.B].UV;
      if ((a[1] > uv[1]) != (b[1] > uv[1]))
      {
        const double u = a[0] + (uv[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
        inside = inside != (uv[0] < u);
      }
    }
  }
  return inside;
}

void DeformingFace::MarkCut(
  std::int32_t cell, const Vec2& a, const Vec2& b, std::vector<char>& cut) const
{
  if (!Meets(a, b, Widened(this->Forest.Box(cell), Margin)))
  {
    return;
  }
  const std::int32_t child = this->Forest[cell].Child;
  if (child < 0)
  {
    cut[cell] = 1;
    return;
  }
  this->MarkCut(child, a, b, cut);
  this->MarkCut(child + 1, a, b, cut);
}

// One mark a cell: whether it is a leaf that loops cut, but for pieces along the sides of the grid.
std::vector<char> DeformingFace::CutCells() const
{
  std::vector<char> cut(this->Forest.Size(), 0);
  for (const std::vector<LoopSegment>& loop : this->Loops)
  {
    for (const LoopSegment& s : loop)
    {
      if (s.Side >= 0)
      {
        continue;
      }
      const Vec2& a = this->LoopVertices[s.A].UV;
      const Vec2& b = this->LoopVertices[s.B].UV;
      int first[2], last[2];
      for (int d = 0; d < 2; ++d)
      {
        const GridAxis& axis = this->Lines.Axis[d];
        first[d] = std::max(0, axis.ColumnAt(std::min(a[d], b[d])) - 1);
        last[d] = std::min(axis.Columns() - 1, axis.ColumnAt(std::max(a[d], b[d])) + 1);
      }
      for (int row = first[1]; row <= last[1]; ++row)
      {
        for (int column = first[0]; column <= last[0]; ++column)
        {
          this->MarkCut(this->Lines.Patch(column, row), a, b, cut);
        }
      }
    }
  }
  return cut;
}

// The same for many places: each segment looks only at those beside it.
std::vector<char> DeformingFace::AreInside(const std::vector<Vec2>& uv) const
{
  std::vector<std::int32_t> order(uv.size());
  for (std::size_t k = 0; k < uv.size(); ++k)
  {
    order[k] = std::int32_t(k);
  }
  std::sort(order.begin(), order.end(),
    [&](std::int32_t a, std::int32_t b) { return uv[a][1] < uv[b][1]; });
  std::vector<char> inside(uv.size(), 0);
  for (const std::vector<LoopSegment>& loop : this->Loops)
  {
    for (const LoopSegment& s : loop)
    {
      const Vec2* low = &this->LoopVertices[s.A].UV;
      const Vec2* high = &this->LoopVertices[s.B].UV;
      if ((*low)[1] > (*high)[1])
      {
        std::swap(low, high);
      }
      auto at = std::lower_bound(order.begin(), order.end(), (*low)[1],
        [&](std::int32_t k, double v) { return uv[k][1] < v; });
      for (; at != order.end() && uv[*at][1] < (*high)[1]; ++at)
      {
        const Vec2& p = uv[*at];
        const double t = (p[1] - (*low)[1]) / ((*high)[1] - (*low)[1]);
        inside[*at] ^= p[0] < (*low)[0] + t * ((*high)[0] - (*low)[0]);
      }
    }
  }
  return inside;
}

void DeformingFace::Classify(std::int32_t leaf, bool cut, bool inside)
{
  Cell& cell = this->Forest[leaf];
  const CellState before = cell.State;
  cell.State = cut ? CellState::Cut : inside ? CellState::Inside : CellState::Outside;
  if (cell.State == CellState::Inside && !this->TakesSides(cell))
  {
    cell.State = CellState::Cut;
  }
  const bool whole = cell.State == CellState::Inside;
  if (cell.Built && !whole)
  {
    this->Retired.push_back(leaf);
  }
  if (!cell.Built && whole)
  {
    this->Fresh.push_back(leaf);
    const Patch& patch = this->Patches[cell.Patch];
    const ParameterBox box = this->Forest.Box(leaf);
    if (cell.Up + patch.Moved.Bow(box.A(), box.B()) > patch.Tolerance)
    {
      this->Late.push_back(cell.Patch);
    }
  }
  if (cell.Built && whole && this->SidesChanged)
  {
    this->MarkDirty(leaf);
  }
  this->ZoneChanged = this->ZoneChanged || cell.State == CellState::Cut || before == CellState::Cut;
}

// The leaves whose state may not be what it was: new ones, all if loops inside the grid changed, and
// those along its sides if these did.
std::vector<std::int32_t> DeformingFace::LeavesToClassify() const
{
  std::vector<std::int32_t> leaves;
  const auto add = [&](std::int32_t leaf) { leaves.push_back(leaf); };
  for (int patch = 0; patch < this->Lines.Patches() && this->LoopsChanged; ++patch)
  {
    this->Forest.ForLeaves(patch, add);
  }
  for (const std::int32_t leaf : this->Fresh)
  {
    if (this->Forest[leaf].Patch >= 0 && this->Forest.IsLeaf(leaf))
    {
      add(leaf);
    }
  }
  for (int side = 0; side < 4 && this->SidesChanged; ++side)
  {
    this->Forest.ForSide(side, add);
  }
  if (this->LoopsChanged || this->SidesChanged)
  {
    std::sort(leaves.begin(), leaves.end());
    leaves.erase(std::unique(leaves.begin(), leaves.end()), leaves.end());
  }
  return leaves;
}

void DeformingFace::ClassifyLeaves()
{
  const std::vector<std::int32_t> leaves = this->LeavesToClassify();
  const bool unknown =
    this->HasInnerPieces && std::any_of(leaves.begin(), leaves.end(), [&](std::int32_t leaf) {
      return this->LoopsChanged || this->Forest[leaf].State == CellState::New;
    });
  std::vector<char> cut, inside;
  if (unknown)
  {
    cut = this->CutCells();
    std::vector<Vec2> centers;
    for (const std::int32_t leaf : leaves)
    {
      const ParameterBox box = this->Forest.Box(leaf);
      centers.emplace_back(0.5 * (box.U0 + box.U1), 0.5 * (box.V0 + box.V1));
    }
    inside = this->AreInside(centers);
  }
  this->Fresh.clear();
  for (std::size_t k = 0; k < leaves.size(); ++k)
  {
    const CellState state = this->Forest[leaves[k]].State;
    if (!this->HasInnerPieces)
    {
      this->Classify(leaves[k], false, true);
    }
    else if (this->LoopsChanged || state == CellState::New)
    {
      this->Classify(leaves[k], cut[leaves[k]] != 0, inside[k] != 0);
    }
    else
    {
      this->Classify(leaves[k], state == CellState::Cut, state == CellState::Inside);
    }
  }
}

void DeformingFace::ClassifyPatches()
{
  if (!this->HasInnerPieces)
  {
    return;
  }
  const std::vector<char> cut = this->CutCells();
  std::vector<Vec2> centers;
  for (int patch = 0; patch < this->Lines.Patches(); ++patch)
  {
    const ParameterBox box = this->Lines.Box(patch);
    centers.emplace_back(0.5 * (box.U0 + box.U1), 0.5 * (box.V0 + box.V1));
  }
  const std::vector<char> inside = this->AreInside(centers);
  for (int patch = 0; patch < this->Lines.Patches(); ++patch)
  {
    this->Forest[patch].State = cut[patch] ? CellState::New
      : inside[patch]                      ? CellState::Inside
                                           : CellState::Outside;
  }
}

} // namespace nurbs
