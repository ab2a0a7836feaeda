// SPDX-License-Identifier: BSD-3-Clause
#include "TrimIndex.h"

#include "TrimTree.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nurbs
{

namespace
{

/// The largest double below 1: the domain is half open, its upper sides are moved in by this much.
const double BelowOne = std::nextafter(1.0, 0.0);

/// A piece's part in the parity at p.
bool Counts(const TrimPiece& piece, const Vec3* inner, std::int32_t reference, const Vec2& p)
{
  if (p[1] < piece.Low[1])
  {
    return (reference & TrimTree::Below) != 0;
  }
  if (p[1] >= piece.High[1])
  {
    return (reference & TrimTree::Above) != 0;
  }
  if (p[0] < piece.Low[0])
  {
    return true;
  }
  if (p[0] >= piece.High[0])
  {
    return false;
  }
  Vec2 local = (p - piece.Low).cwiseQuotient(piece.High - piece.Low);
  if (piece.Falling)
  {
    local[0] = (piece.High[0] - p[0]) / (piece.High[0] - piece.Low[0]);
  }
  return LiesRight(piece, inner, local);
}

} // namespace

FaceTrim::FaceTrim(const Model& model, std::int64_t index)
{
  const Face& face = model.Faces[static_cast<std::size_t>(index)];
  if (face.Geometry.Size() == 0)
  {
    this->Root = TrimTree::AllOutside;
    return;
  }
  if (face.LoopCount == 0)
  {
    return;
  }
  this->U = face.Geometry.Domain(0);
  this->V = face.Geometry.Domain(1);
  TrimTree tree(CutTrimLoops(model, face));
  this->Root = tree.Root;
  this->Nodes = std::move(tree.Nodes);
  this->Leaves = std::move(tree.Leaves);
  this->Pieces = std::move(tree.Cut.Pieces);
  this->Inner = std::move(tree.Cut.Inner);
  if (this->PointTexelCount() > MaxPointTexels || this->RecordTexelCount() > 2 * MaxPointTexels)
  {
    throw Error("face " + std::to_string(index) +
      " has too many trim curves: " + std::to_string(this->Pieces.size()) + " pieces");
  }
}

/// Moves (u, v) into the domain; false for NaN.
bool FaceTrim::Locate(double u, double v, Vec2& p, std::int32_t& child) const
{
  p[0] = (u - this->U.Min) / this->U.Length();
  p[1] = (v - this->V.Min) / this->V.Length();
  if (std::isnan(p[0]) || std::isnan(p[1]))
  {
    return false;
  }
  p = p.cwiseMax(0.0).cwiseMin(BelowOne);
  child = this->Root;
  while (child >= 0)
  {
    const TrimTree::Node& node = this->Nodes[static_cast<std::size_t>(child)];
    child = node.Child[p[node.Dir] >= node.Split];
  }
  return true;
}

bool FaceTrim::Inside(double u, double v, int& visited) const
{
  visited = 0;
  Vec2 p;
  std::int32_t child = TrimTree::AllOutside;
  if (!this->Locate(u, v, p, child) || child > TrimTree::FirstLeaf)
  {
    return child == TrimTree::AllInside;
  }
  const std::int32_t* leaf = this->Leaves.data() + 4 * std::int64_t(TrimTree::FirstLeaf - child);
  const std::int32_t* references = leaf + TrimTree::LeafHeader;
  const auto counts = [&](std::int32_t reference) {
    ++visited;
    const auto piece = static_cast<std::size_t>(reference >> TrimTree::FlagBits);
    return Counts(this->Pieces[piece], this->Inner.data(), reference, p);
  };
  std::int32_t right = 0;
  for (std::int32_t end = leaf[1]; right < end;)
  {
    const std::int32_t middle = (right + end) / 2;
    if (counts(references[middle]))
    {
      right = middle + 1;
    }
    else
    {
      end = middle;
    }
  }
  bool inside = (leaf[0] + right) % 2 != 0;
  for (std::int32_t k = leaf[1]; k < leaf[0] / 2; ++k)
  {
    inside = inside != counts(references[k]);
  }
  return inside;
}

std::int64_t FaceTrim::PointTexelCount() const
{
  return static_cast<std::int64_t>(this->Nodes.size() + this->Pieces.size() + this->Inner.size());
}

std::int64_t FaceTrim::RecordTexelCount() const
{
  return this->IsWhole() ? 0 : 1 + static_cast<std::int64_t>(this->Leaves.size()) / 4;
}

void FaceTrim::WriteTexels(std::int32_t pointStart, float* points, std::int32_t* records) const
{
  if (this->IsWhole())
  {
    return;
  }
  const auto write = [&points](double x, double y, double z, double w) {
    for (const double value : { x, y, z, w })
    {
      *points++ = static_cast<float>(value);
    }
  };
  for (const TrimTree::Node& node : this->Nodes)
  {
    write(node.Split, node.Dir, node.Child[0], node.Child[1]);
  }
  std::vector<std::int32_t> packed; // a piece's place, degree and sense
  std::int32_t place = static_cast<std::int32_t>(this->Nodes.size());
  for (const TrimPiece& piece : this->Pieces)
  {
    packed.push_back((place << 8) | (piece.Degree << 3) | (piece.Falling ? 4 : 0));
    place += piece.Degree;
    write(piece.Low[0], piece.Low[1], piece.High[0], piece.High[1]);
    for (int i = 0; i < piece.Degree - 1; ++i)
    {
      const Vec3& b = this->Inner[static_cast<std::size_t>(piece.FirstInner + i)];
      write(b[0], b[1], b[2], 0.0);
    }
  }
  *records++ = pointStart;
  *records++ = this->Root;
  *records++ = 0;
  *records++ = 0;
  for (std::size_t start = 0; start < this->Leaves.size();)
  {
    const std::int32_t* leaf = this->Leaves.data() + start;
    const std::int32_t count = leaf[0] / 2;
    std::int32_t* next = std::copy(leaf, leaf + TrimTree::LeafHeader, records);
    for (const std::int32_t* reference = leaf + TrimTree::LeafHeader;
         reference < leaf + TrimTree::LeafHeader + count; ++reference)
    {
      *next++ = packed[static_cast<std::size_t>(*reference >> TrimTree::FlagBits)] |
        (*reference & (TrimTree::Below | TrimTree::Above));
    }
    std::fill(next, records + TrimTree::LeafSize(count), 0);
    records += TrimTree::LeafSize(count);
    start += TrimTree::LeafSize(count);
  }
}

TrimIndex::TrimIndex(const Model& model, const ParallelFor& parallel)
  : Faces(model.Faces.size())
{
  std::vector<std::string> errors(model.Faces.size()); // kept: threads may not throw
  parallel(0, this->FaceCount(), [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t face = begin; face < end; ++face)
    {
      try
      {
        this->Rebuild(model, face);
      }
      catch (const Error& error)
      {
        errors[static_cast<std::size_t>(face)] = error.what();
      }
    }
  });
  for (const std::string& error : errors)
  {
    if (!error.empty())
    {
      throw Error(error);
    }
  }
}

void TrimIndex::Rebuild(const Model& model, std::int64_t face)
{
  this->Faces[static_cast<std::size_t>(face)] = FaceTrim(model, face);
}

TrimTexels Flatten(const TrimIndex& index)
{
  TrimTexels texels;
  std::int64_t points = 0;
  std::int64_t records = 0;
  for (std::int64_t f = 0; f < index.FaceCount(); ++f)
  {
    const FaceTrim& face = index.Face(f);
    texels.PointStart.push_back(face.IsWhole() ? -1 : static_cast<std::int32_t>(points));
    texels.FaceStart.push_back(face.IsWhole() ? -1 : static_cast<std::int32_t>(records));
    points += face.PointTexelCount();
    records += face.RecordTexelCount();
    if (std::max(points, records) > std::numeric_limits<std::int32_t>::max())
    {
      throw Error("the trim curves of all faces need more than 2^31 texels");
    }
  }
  texels.Points.resize(static_cast<std::size_t>(4 * points));
  texels.Records.resize(static_cast<std::size_t>(4 * records));
  for (std::int64_t f = 0; f < index.FaceCount(); ++f)
  {
    const std::int64_t first = texels.PointStart[static_cast<std::size_t>(f)];
    if (first >= 0)
    {
      index.Face(f).WriteTexels(static_cast<std::int32_t>(first), texels.Points.data() + 4 * first,
        texels.Records.data() + 4 * std::int64_t(texels.FaceStart[static_cast<std::size_t>(f)]));
    }
  }
  return texels;
}

} // namespace nurbs
