// SPDX-License-Identifier: BSD-3-Clause
#include "TrimTree.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace nurbs
{

namespace
{

constexpr double SmallestCell = 1e-6; // of the domain: floats have nothing left to tell apart
constexpr double Margin = 1e-9;       // of the domain: well over what evaluation may be wrong
constexpr int MaxDepth = 60;

/// u of a straight piece at a height of its range; of any other piece that of its chord.
double LineAt(const TrimPiece& piece, double v)
{
  const double part = (v - piece.Low[1]) / (piece.High[1] - piece.Low[1]);
  const double size = piece.High[0] - piece.Low[0];
  return piece.Falling ? piece.High[0] - part * size : piece.Low[0] + part * size;
}

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
  const auto budget = 16 * static_cast<std::int64_t>(all.References.size()) + 16;
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
    return this->MakeLeaf(cell, content);
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
    return this->MakeLeaf(cell, content);
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
    const TrimPiece& piece = this->PieceOf(reference);
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

namespace
{

/// What a query in a cell looks at: `ordered` pieces by bisection and all others.
double Price(std::size_t all, std::size_t ordered)
{
  return static_cast<double>(all - ordered) + std::log2(1.0 + static_cast<double>(ordered));
}

/// Ends of pieces in one direction, sorted.
struct Ends
{
  std::vector<double> Lows, Highs;
  explicit Ends(std::size_t count)
  {
    this->Lows.reserve(count);
    this->Highs.reserve(count);
  }
  void Add(const TrimPiece& piece, int dir)
  {
    this->Lows.push_back(piece.Low[dir]);
    this->Highs.push_back(piece.High[dir]);
  }
  void Sort()
  {
    std::sort(this->Lows.begin(), this->Lows.end());
    std::sort(this->Highs.begin(), this->Highs.end());
  }
  std::size_t Size() const { return this->Lows.size(); }
  static std::size_t Less(const std::vector<double>& sorted, double x)
  {
    return static_cast<std::size_t>(
      std::lower_bound(sorted.begin(), sorted.end(), x) - sorted.begin());
  }
  static std::size_t UpTo(const std::vector<double>& sorted, double x)
  {
    return static_cast<std::size_t>(
      std::upper_bound(sorted.begin(), sorted.end(), x) - sorted.begin());
  }
};

/// The pieces of a cell, for finding out what a split would cost.
class Census
{
public:
  Census(const Box2& cell, std::size_t count)
    : Cell(cell)
    , All{ Ends(count), Ends(count) }
    , FromBottom(count)
    , ToTop(count)
    , Through(count)
  {}

  void Add(const TrimPiece& piece)
  {
    const bool line = piece.Degree == 1;
    const bool fromBottom = line && piece.Low[1] <= this->Cell.min()[1];
    const bool toTop = line && piece.High[1] >= this->Cell.max()[1];
    this->All[0].Add(piece, 0);
    this->All[1].Add(piece, 1);
    if (fromBottom)
    {
      this->FromBottom.Add(piece, 1);
    }
    if (toTop)
    {
      this->ToTop.Add(piece, 1);
    }
    if (fromBottom && toTop)
    {
      this->Through.Add(piece, 0);
    }
  }

  void Sort()
  {
    for (Ends* ends :
      { &this->All[0], &this->All[1], &this->FromBottom, &this->ToTop, &this->Through })
    {
      ends->Sort();
    }
  }

  double Unsplit() const { return Price(this->All[0].Size(), this->Through.Size()); }

  /// The mean over the cell if it is split at a coordinate, as far as the pieces' boxes tell.
  double Split(int dir, double at) const
  {
    const std::size_t low = Ends::Less(this->All[dir].Lows, at);
    const std::size_t high = this->All[dir].Size() - Ends::UpTo(this->All[dir].Highs, at);
    std::size_t ordered[2];
    if (dir == 0)
    {
      ordered[0] = Ends::Less(this->Through.Lows, at);
      ordered[1] = this->Through.Size() - Ends::UpTo(this->Through.Highs, at);
    }
    else
    {
      ordered[0] = this->FromBottom.Size() - Ends::Less(this->FromBottom.Highs, at);
      ordered[1] = Ends::UpTo(this->ToTop.Lows, at);
    }
    const double part = (at - this->Cell.min()[dir]) / this->Cell.sizes()[dir];
    return part * Price(low, ordered[0]) + (1.0 - part) * Price(high, ordered[1]);
  }

  const Ends& In(int dir) const { return this->All[dir]; }

private:
  const Box2& Cell;
  Ends All[2];
  Ends FromBottom, ToTop, Through; ///< Lines that reach the cell's sides.
};

/// True if a lies left of b, or they touch, all over the cell's height, which both span.
bool IsLeftOf(const TrimPiece& a, const TrimPiece& b, const Box2& cell)
{
  if (a.High[0] <= b.Low[0])
  {
    return true;
  }
  return a.Degree == 1 && b.Degree == 1 && LineAt(a, cell.min()[1]) <= LineAt(b, cell.min()[1]) &&
    LineAt(a, cell.max()[1]) <= LineAt(b, cell.max()[1]);
}

} // namespace

/// The split after which a point of the cell has the least to look at (surface area heuristic, with
/// a node's price that of a piece), among the ends of pieces' boxes.
TrimTree::SplitPlane TrimTree::BestSplit(const Box2& cell, const Content& content) const
{
  SplitPlane best;
  if (content.References.size() < 2)
  {
    return best;
  }
  Census census(cell, content.References.size());
  for (const std::int32_t reference : content.References)
  {
    census.Add(this->PieceOf(reference));
  }
  census.Sort();
  double least = census.Unsplit() - 1.0;
  for (int dir = 0; dir < 2; ++dir)
  {
    const double from = cell.min()[dir] + SmallestCell;
    const double to = cell.max()[dir] - SmallestCell;
    for (const std::vector<double>* ends : { &census.In(dir).Lows, &census.In(dir).Highs })
    {
      for (const double at : *ends)
      {
        const double price = at > from && at < to ? census.Split(dir, at) : least;
        if (price < least)
        {
          least = price;
          best = { dir, at };
        }
      }
    }
  }
  return best;
}

/// Moves pieces that span the cell's height and do not cross there to the front, right to left.
/// Returns how many.
std::int32_t TrimTree::Order(const Box2& cell, std::vector<std::int32_t>& references) const
{
  const auto rest =
    std::stable_partition(references.begin(), references.end(), [&](std::int32_t reference) {
      const TrimPiece& piece = this->PieceOf(reference);
      return piece.Low[1] <= cell.min()[1] && piece.High[1] >= cell.max()[1];
    });
  const double middle = 0.5 * (cell.min()[1] + cell.max()[1]);
  std::sort(references.begin(), rest, [&](std::int32_t a, std::int32_t b) {
    return LineAt(this->PieceOf(a), middle) > LineAt(this->PieceOf(b), middle);
  });
  std::vector<std::int32_t> ordered;
  std::vector<std::int32_t> others;
  for (auto it = references.begin(); it != references.end(); ++it)
  {
    const bool fits = it < rest &&
      (ordered.empty() || IsLeftOf(this->PieceOf(*it), this->PieceOf(ordered.back()), cell));
    (fits ? ordered : others).push_back(*it);
  }
  const auto count = static_cast<std::int32_t>(ordered.size());
  references.swap(ordered);
  references.insert(references.end(), others.begin(), others.end());
  return count;
}

std::int32_t TrimTree::MakeLeaf(const Box2& cell, const Content& content)
{
  bool parity = content.Parity;
  std::vector<std::int32_t> references;
  for (const std::int32_t reference : content.References)
  {
    const TrimPiece& piece = this->PieceOf(reference);
    const std::int32_t flags = reference & (Below | Above);
    if (piece.Low[1] < piece.High[1] || flags == Below || flags == Above)
    {
      references.push_back(reference);
    }
    else // a level piece that counts the same above and below itself
    {
      parity = parity != (flags != 0);
    }
  }
  if (references.empty())
  {
    return parity ? AllInside : AllOutside;
  }
  const std::int32_t ordered = this->Order(cell, references);
  const auto count = static_cast<std::int32_t>(references.size());
  const std::size_t start = this->Leaves.size();
  this->Leaves.push_back(2 * count + (parity ? 1 : 0));
  this->Leaves.push_back(ordered);
  this->Leaves.insert(this->Leaves.end(), references.begin(), references.end());
  this->Leaves.resize(start + LeafSize(count), 0);
  return FirstLeaf - static_cast<std::int32_t>(start / 4);
}

/// Drops pieces that no leaf refers to: level ones, those along the domain's sides and beyond it.
void TrimTree::DropUnused()
{
  std::vector<std::int32_t> number(this->Cut.Pieces.size(), -1);
  TrimPieces kept;
  for (std::size_t start = 0; start < this->Leaves.size();)
  {
    const std::int32_t count = this->Leaves[start] / 2;
    const std::size_t first = start + LeafHeader;
    for (std::size_t k = first; k < first + static_cast<std::size_t>(count); ++k)
    {
      std::int32_t& reference = this->Leaves[k];
      const auto old = static_cast<std::size_t>(reference >> FlagBits);
      if (number[old] < 0)
      {
        number[old] = static_cast<std::int32_t>(kept.Pieces.size());
        TrimPiece piece = this->Cut.Pieces[old];
        const auto inner = this->Cut.Inner.begin() + piece.FirstInner;
        piece.FirstInner = static_cast<std::int32_t>(kept.Inner.size());
        kept.Inner.insert(kept.Inner.end(), inner, inner + (piece.Degree - 1));
        kept.Pieces.push_back(piece);
      }
      reference = (number[old] << FlagBits) | (reference & (Below | Above));
    }
    start += LeafSize(count);
  }
  this->Cut = std::move(kept);
}

} // namespace nurbs
