// SPDX-License-Identifier: BSD-3-Clause
#include "TrimTree.h"

#include <algorithm>
#include <cassert>

namespace nurbs
{

namespace
{

constexpr double SmallestCell = 1e-6; // of the domain: floats have nothing left to tell apart
constexpr double Margin = 1e-9;       // of the domain: well over what evaluation may be wrong
constexpr int MaxDepth = 60;
constexpr std::size_t Few = 8; // pieces that are left together if boxes do not tell them apart

} // namespace

TrimTree::TrimTree(TrimPieces pieces)
  : Cut(std::move(pieces))
  , Slot(this->Cut.Pieces.size(), -1)
{
  Content all;
  for (std::size_t k = 0; k < this->Cut.Pieces.size(); ++k)
  {
    all.References.push_back(static_cast<std::int32_t>(k) << FlagBits);
  }
  const Box2 domain(Vec2(0.0, 0.0), Vec2(1.0, 1.0));
  const auto budget = 8 * static_cast<std::int64_t>(all.References.size()) + 16;
  this->Root = this->Build(domain, this->Restrict(all, domain), budget, 0);
  this->DropUnused();
}

/// Returns the child that stands for the cell. `budget`: how many references its leaves may have.
std::int32_t TrimTree::Build(
  const Box2& cell, const Content& content, std::int64_t budget, int depth)
{
  const SplitPlane plane = depth < MaxDepth ? this->BestSplit(cell, content) : SplitPlane();
  if (plane.Dir < 0)
  {
    return this->MakeLeaf(content);
  }
  Box2 halves[2] = { cell, cell };
  halves[0].max()[plane.Dir] = plane.At;
  halves[1].min()[plane.Dir] = plane.At;
  const Content low = this->Restrict(content, halves[0]);
  const Content high = this->Restrict(content, halves[1]);
  const auto count = static_cast<std::int64_t>(low.References.size());
  const auto total = count + static_cast<std::int64_t>(high.References.size());
  if (total > budget)
  {
    return this->MakeLeaf(content);
  }
  const auto node = this->Nodes.size();
  this->Nodes.push_back({ plane.At, plane.Dir, { AllOutside, AllOutside } });
  const std::int64_t share = total > 0 ? budget * count / total : 0;
  const std::int32_t first = this->Build(halves[0], low, share, depth + 1);
  const std::int32_t second = this->Build(halves[1], high, budget - share, depth + 1);
  this->Nodes[node].Child[0] = first;
  this->Nodes[node].Child[1] = second;
  return static_cast<std::int32_t>(node);
}

/// What is left to look at in a part of a cell.
TrimTree::Content TrimTree::Restrict(const Content& content, const Box2& cell)
{
  Content out;
  out.Parity = content.Parity;
  std::vector<std::int32_t> joints; // at which pieces that are left out change the parity
  for (const std::int32_t reference : content.References)
  {
    const TrimPiece& piece = this->Cut.Pieces[static_cast<std::size_t>(reference >> FlagBits)];
    const bool below = (reference & Below) != 0;
    const bool above = (reference & Above) != 0;
    if (piece.High[1] <= cell.min()[1])
    {
      out.Parity = out.Parity != above;
      continue;
    }
    if (piece.Low[1] >= cell.max()[1])
    {
      out.Parity = out.Parity != below;
      continue;
    }
    const int side = this->Side(piece, cell);
    if (side == 0)
    {
      out.References.push_back(reference);
      continue;
    }
    const bool beside = side > 0;
    const bool starts = piece.Low[1] > cell.min()[1];
    out.Parity = out.Parity != (starts ? below : beside);
    if (starts && below != beside)
    {
      joints.push_back(piece.Joint[0]);
    }
    if (piece.High[1] < cell.max()[1] && beside != above)
    {
      joints.push_back(piece.Joint[1]);
    }
  }
  this->Carry(joints, out);
  return out;
}

/// 1 if the piece lies right of all points of the cell at their height, -1: left of them, 0: neither,
/// or too near to say.
int TrimTree::Side(const TrimPiece& piece, const Box2& cell) const
{
  if (piece.Low[0] >= cell.max()[0])
  {
    return 1;
  }
  if (piece.High[0] <= cell.min()[0])
  {
    return -1;
  }
  if (piece.Low[1] == piece.High[1])
  {
    return 0;
  }
  const double from = std::max(piece.Low[1], cell.min()[1]) - Margin;
  const double to = std::min(piece.High[1], cell.max()[1]) + Margin;
  if (this->IsRightOf(piece, cell.max()[0] + Margin, piece.Falling ? to : from))
  {
    return 1;
  }
  return this->IsRightOf(piece, cell.min()[0] - Margin, piece.Falling ? from : to) ? 0 : -1;
}

/// The piece against a point, at the point's height or at the end that is next to it.
bool TrimTree::IsRightOf(const TrimPiece& piece, double u, double v) const
{
  if (u < piece.Low[0] || u >= piece.High[0])
  {
    return u < piece.Low[0];
  }
  Vec2 p = (Vec2(u, v) - piece.Low).cwiseQuotient(piece.High - piece.Low);
  p[0] = piece.Falling ? 1.0 - p[0] : p[0];
  p[1] = std::min(1.0, std::max(0.0, p[1]));
  return LiesRight(piece, this->Cut.Inner.data(), p);
}

/// Has pieces of `content` carry the changes of parity at `joints`. A joint of two pieces that are
/// left out comes twice and cancels. Else its other piece is there: the joint, at a height inside the
/// cell's, belongs to it too and lies right of the cell or left of it as its neighbour does, so that
/// it cannot have been left out for lying elsewhere.
void TrimTree::Carry(const std::vector<std::int32_t>& joints, Content& content)
{
  if (joints.empty())
  {
    return;
  }
  for (std::size_t k = 0; k < content.References.size(); ++k)
  {
    this->Slot[static_cast<std::size_t>(content.References[k] >> FlagBits)] =
      static_cast<std::int32_t>(k);
  }
  std::vector<std::int32_t> sorted(joints);
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t k = 0; k < sorted.size(); ++k)
  {
    if (k + 1 < sorted.size() && sorted[k] == sorted[k + 1])
    {
      ++k;
      continue;
    }
    const std::int32_t joint = sorted[k];
    const std::int32_t before = this->Cut.Before[static_cast<std::size_t>(joint)];
    const std::int32_t carrier = this->Slot[static_cast<std::size_t>(joint)] >= 0 ? joint : before;
    const std::int32_t slot = this->Slot[static_cast<std::size_t>(carrier)];
    assert(slot >= 0);
    std::int32_t& reference = content.References[static_cast<std::size_t>(slot)];
    if (this->Cut.Pieces[static_cast<std::size_t>(carrier)].Joint[1] == joint)
    {
      reference ^= Above;
    }
    else
    {
      reference ^= Below;
      content.Parity = !content.Parity;
    }
  }
  for (const std::int32_t reference : content.References)
  {
    this->Slot[static_cast<std::size_t>(reference >> FlagBits)] = -1;
  }
}

/// The split after which a point of the cell has the least to look at (surface area heuristic, with
/// a node's price that of a piece): at the ends of pieces' boxes; in the middle, if there are many
/// pieces whose boxes overlap too much for that, as beside each other along a diagonal.
TrimTree::SplitPlane TrimTree::BestSplit(const Box2& cell, const Content& content) const
{
  SplitPlane best;
  const std::size_t n = content.References.size();
  if (n < 2)
  {
    return best;
  }
  double least = static_cast<double>(n) - 1.0;
  std::vector<double> ends[2];
  for (int dir = 0; dir < 2; ++dir)
  {
    const double from = cell.min()[dir];
    const double size = cell.max()[dir] - from;
    for (int end = 0; end < 2; ++end)
    {
      ends[end].clear();
      for (const std::int32_t reference : content.References)
      {
        const TrimPiece& piece = this->Cut.Pieces[static_cast<std::size_t>(reference >> FlagBits)];
        ends[end].push_back((end == 0 ? piece.Low : piece.High)[dir]);
      }
      std::sort(ends[end].begin(), ends[end].end());
    }
    for (const std::vector<double>& candidates : ends)
    {
      std::size_t low = 0;  // pieces that reach below the split
      std::size_t done = 0; // pieces that do not reach over it
      for (const double at : candidates)
      {
        for (; low < n && ends[0][low] < at; ++low)
        {}
        for (; done < n && ends[1][done] <= at; ++done)
        {}
        const double part = (at - from) / size;
        const double cost =
          part * static_cast<double>(low) + (1.0 - part) * static_cast<double>(n - done);
        if (cost < least && at - from > SmallestCell && cell.max()[dir] - at > SmallestCell)
        {
          least = cost;
          best = { dir, at };
        }
      }
    }
  }
  if (best.Dir < 0 && n > Few && cell.sizes().maxCoeff() > 2.0 * SmallestCell)
  {
    const int dir = cell.sizes()[1] > cell.sizes()[0] ? 1 : 0;
    best = { dir, 0.5 * (cell.min()[dir] + cell.max()[dir]) };
  }
  return best;
}

std::int32_t TrimTree::MakeLeaf(const Content& content)
{
  bool parity = content.Parity;
  std::vector<std::int32_t> leaf{ 0 };
  for (const std::int32_t reference : content.References)
  {
    const TrimPiece& piece = this->Cut.Pieces[static_cast<std::size_t>(reference >> FlagBits)];
    const std::int32_t flags = reference & (Below | Above);
    if (piece.Low[1] < piece.High[1] || flags == Below || flags == Above)
    {
      leaf.push_back(reference);
    }
    else // a level piece that counts the same above and below itself
    {
      parity = parity != (flags != 0);
    }
  }
  const auto count = static_cast<std::int32_t>(leaf.size()) - 1;
  if (count == 0)
  {
    return parity ? AllInside : AllOutside;
  }
  leaf[0] = 2 * count + (parity ? 1 : 0);
  leaf.resize(LeafSize(count), 0);
  const auto texel = static_cast<std::int32_t>(this->Leaves.size() / 4);
  this->Leaves.insert(this->Leaves.end(), leaf.begin(), leaf.end());
  return FirstLeaf - texel;
}

/// Drops pieces that no leaf refers to: level ones, those along the domain's sides and beyond it.
void TrimTree::DropUnused()
{
  std::vector<std::int32_t> number(this->Cut.Pieces.size(), -1);
  TrimPieces kept;
  for (std::size_t start = 0; start < this->Leaves.size();)
  {
    const std::int32_t count = this->Leaves[start] / 2;
    for (std::size_t k = start + 1; k <= start + static_cast<std::size_t>(count); ++k)
    {
      std::int32_t& reference = this->Leaves[k];
      const auto old = static_cast<std::size_t>(reference >> FlagBits);
      if (number[old] < 0)
      {
        number[old] = static_cast<std::int32_t>(kept.Pieces.size());
        TrimPiece piece = this->Cut.Pieces[old];
        const auto inner = this->Cut.Inner.begin() + piece.FirstInner;
        piece.FirstInner = static_cast<std::int32_t>(kept.Inner.size());
        kept.Inner.insert(kept.Inner.end(), inner, inner + piece.Degree - 1);
        kept.Pieces.push_back(piece);
      }
      reference = (number[old] << FlagBits) | (reference & (Below | Above));
    }
    start += LeafSize(count);
  }
  this->Cut = std::move(kept);
}

} // namespace nurbs
