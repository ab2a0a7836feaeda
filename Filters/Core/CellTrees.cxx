// SPDX-License-Identifier: BSD-3-Clause
#include "CellTrees.h"

#include "Model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace nurbs
{

namespace
{

/// What bounds may be too large by, as a part of the size: the rounding of floats.
constexpr double BoundsPart = 1e-7;

/// The float beyond x in the direction of `limit`.
float RoundTo(double x, float limit)
{
  return std::nextafter(static_cast<float>(x), limit);
}

/// Around what may count of a face: what its loops reach, and some more.
constexpr double Beyond = 0.01;
/// That is more than `reach` if the face is so many times wider.
constexpr double WideEnough = 1000.0;

/// The shortest row of control points in one direction, from end to end.
double ShortestRow(const Surface& surface, int dir)
{
  const SurfaceView view = surface.View();
  double shortest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < view.Count[1 - dir]; ++k)
  {
    const int first = dir == 0 ? k * view.Count[0] : k;
    const int last =
      dir == 0 ? first + view.Count[0] - 1 : first + (view.Count[1] - 1) * view.Count[0];
    shortest = std::min(shortest, (view.Point(last) - view.Point(first)).norm());
  }
  return shortest;
}

/// A box around all of a face, and of its surface within `reach` of it.
Box3 BoxOfFace(const Model& model, const Face& face, double reach)
{
  Box3 box;
  const Box2 loops = LoopsBox(model, face);
  Interval part[2] = { face.Geometry.Domain(0), face.Geometry.Domain(1) };
  const auto cut = [&]() { return Restrict(face.Geometry, part[0], part[1]); };
  for (int dir = 0; dir < 2 && !loops.isEmpty(); ++dir)
  {
    const Interval whole = part[dir];
    const double more = Beyond * loops.sizes()[dir];
    part[dir] = { std::max(whole.Min, loops.min()[dir] - more),
      std::min(whole.Max, loops.max()[dir] + more) };
    if (part[dir].Length() >= 0.9 * whole.Length() || !(more > 0.0) ||
      ShortestRow(cut(), dir) < WideEnough * reach)
    {
      part[dir] = whole;
    }
  }
  const Surface left = cut();
  for (std::int64_t k = 0; k < left.View().Size(); ++k)
  {
    box.extend(left.View().Point(k));
  }
  box.min().array() -= reach;
  box.max().array() += reach;
  return box;
}

} // namespace

CellTrees::CellTrees(const Model& model, const TrimIndex& trims, const std::vector<double>& reach,
  double size, double rounding, const ParallelFor& parallel)
  : Source(model)
  , Trims(trims)
  , Reach(reach)
  , Size(size)
  , Margin(4.0 * rounding)
  , Owners(model.Faces.size())
{
  const auto count = static_cast<std::int64_t>(model.Faces.size());
  std::vector<std::vector<BezierPatch>> patches(count);
  std::vector<Box3> boxes(count);
  parallel(0, count, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t f = begin; f < end; ++f)
    {
      if (model.Faces[f].Geometry.Size() > 0)
      {
        patches[f] = ToBezier(model.Faces[f].Geometry);
        boxes[f] = BoxOfFace(model, model.Faces[f], reach[f]);
      }
    }
  });
  for (std::int64_t f = 0; f < count; ++f)
  {
    for (BezierPatch& patch : patches[f])
    {
      Box3 box;
      for (const Vec4& h : patch.Points)
      {
        box.extend(h.head<3>() / h[3]);
      }
      box = box.intersection(boxes[f]);
      if (box.isEmpty())
      {
        continue;
      }
      this->Given.push_back(std::move(patch));
      this->Faces.push_back(static_cast<std::int32_t>(f));
      this->PatchBoxes.push_back(box);
    }
  }
  if (this->Given.size() > std::size_t(std::numeric_limits<std::int32_t>::max()))
  {
    throw Error("PatchRays: more than 2^31 patches or cells");
  }
  Box3 all;
  for (const Box3& box : this->PatchBoxes)
  {
    all.extend(box);
  }
  if (!all.isEmpty())
  {
    this->Middle = all.center();
    this->Unit = all.sizes().maxCoeff() > 0.0 ? all.sizes().maxCoeff() : 1.0;
  }
  this->Roots = std::vector<Slot>(this->Given.size());
  for (std::size_t k = 0; k < this->Roots.size(); ++k)
  {
    this->Roots[k].Content = IsPiece;
    this->Roots[k].SetBounds(this->Relative(this->PatchBoxes[k]));
  }
  this->Bytes = this->Given.size() * (sizeof(BezierPatch) + sizeof(Box3) + sizeof(Slot));
}

CellTrees::~CellTrees()
{
  for (const Slot& root : this->Roots)
  {
    Delete(root.Content);
  }
}

/// The box, widened by the margin, as slots have it.
Box3 CellTrees::Relative(const Box3& box) const
{
  const Vec3 margin = Vec3::Constant(this->Margin);
  return { (box.min() - margin - this->Middle) / this->Unit,
    (box.max() + margin - this->Middle) / this->Unit };
}

void CellTrees::Slot::SetBounds(const Box3& relative)
{
  const float infinity = std::numeric_limits<float>::infinity();
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Bounds[0][axis].store(
      RoundTo(relative.min()[axis], -infinity), std::memory_order_relaxed);
    this->Bounds[1][axis].store(RoundTo(relative.max()[axis], infinity), std::memory_order_relaxed);
  }
}

void CellTrees::Slot::SetVoid()
{
  const float infinity = std::numeric_limits<float>::infinity();
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Bounds[0][axis].store(infinity, std::memory_order_relaxed);
    this->Bounds[1][axis].store(-infinity, std::memory_order_relaxed);
  }
}

void CellTrees::Delete(Child child)
{
  if ((child & 3) == IsCell)
  {
    delete As<PatchRays::Cell>(child);
  }
  else if ((child & 3) == IsPiece)
  {
    delete As<CutPiece>(child);
  }
  else if ((child & 3) == IsBranch)
  {
    const Branch* const branch = As<Branch>(child);
    Delete(branch->Halves[0].Content);
    Delete(branch->Halves[1].Content);
    delete branch;
  }
}

/// What becomes of a piece; its owner is locked.
CellTrees::Child CellTrees::Judge(std::int32_t patch, CutPiece&& piece) const
{
  const std::int32_t face = this->Faces[patch];
  const PatchCutter::Context context(
    *this->Owners[face].Test, this->Reach[face], this->Given[patch]);
  PatchCutter(this->Size).Judge(context, piece);
  if (piece.Is == CutPiece::Verdict::Empty)
  {
    return Nothing;
  }
  if (piece.Is == CutPiece::Verdict::Cell)
  {
    piece.Cell.Patch = patch;
    this->Bytes += sizeof(PatchRays::Cell);
    return reinterpret_cast<Child>(new PatchRays::Cell(piece.Cell)) | IsCell;
  }
  return reinterpret_cast<Child>(new CutPiece(std::move(piece))) | IsPiece;
}

/// Makes a branch of a piece, or judges a root and does so.
CellTrees::Child CellTrees::Make(std::int32_t patch, Slot& slot) const
{
  Owner& owner = this->Owners[this->Faces[patch]];
  const std::lock_guard<std::mutex> lock(owner.Lock);
  Child now = slot.Content.load(std::memory_order_relaxed);
  if (now == IsPiece)
  {
    const std::int32_t face = this->Faces[patch];
    if (!owner.Test)
    {
      owner.Test =
        std::make_unique<CoverTest>(this->Source, this->Source.Faces[face], this->Trims.Face(face));
    }
    now = this->Judge(patch, PatchCutter::Whole(this->Given[patch]));
    slot.Content.store(now, std::memory_order_release);
  }
  if ((now & 3) == IsPiece)
  {
    CutPiece halves[2];
    PatchCutter::Halve(*const_cast<CutPiece*>(As<CutPiece>(now)), halves[0], halves[1]);
    const auto discard = [](Branch* b) { Delete(reinterpret_cast<Child>(b) | IsBranch); };
    std::unique_ptr<Branch, decltype(discard)> branch(new Branch, discard);
    Box3 whole;
    for (int k = 0; k < 2; ++k)
    {
      Slot& half = branch->Halves[k];
      const Box3 box = this->Relative(halves[k].Box());
      half.Content = this->Judge(patch, std::move(halves[k]));
      if (half.Content == Nothing)
      {
        half.SetVoid();
      }
      else
      {
        half.SetBounds(box);
        whole.extend(box);
      }
    }
    if (!whole.isEmpty())
    {
      slot.SetBounds(whole);
    }
    this->Bytes += sizeof(Branch);
    const Child piece = now;
    now = reinterpret_cast<Child>(branch.release()) | IsBranch;
    slot.Content.store(now, std::memory_order_release);
    Delete(piece);
  }
  return now;
}

/// The lowest (side 0) or highest coordinate of a cell's box; the pieces that may have it are cut,
/// those that reach farthest first.
double CellTrees::Extreme(int axis, int side) const
{
  struct Entry
  {
    double Reached; ///< Larger is farther.
    int Depth;
    std::int32_t Patch;
    Slot* At;
    bool operator<(const Entry& other) const
    {
      return this->Reached != other.Reached ? this->Reached < other.Reached
                                            : this->Depth < other.Depth;
    }
  };
  const double sign = side == 0 ? -1.0 : 1.0;
  std::priority_queue<Entry> queue;
  for (std::size_t k = 0; k < this->Roots.size(); ++k)
  {
    Slot& root = this->Roots[k];
    queue.push({ sign * root.Bound(side, axis), 0, std::int32_t(k), &root });
  }
  double best = -std::numeric_limits<double>::infinity();
  while (!queue.empty() && queue.top().Reached > best + BoundsPart)
  {
    const Entry top = queue.top();
    queue.pop();
    const Child child = this->Made(top.Patch, *top.At);
    if ((child & 3) == IsCell)
    {
      best = std::max(best, top.Reached);
    }
    for (int k = 0; k < 2 && (child & 3) == IsBranch; ++k)
    {
      Slot& half = As<Branch>(child)->Halves[k];
      if (!half.IsVoid())
      {
        queue.push({ sign * half.Bound(side, axis), top.Depth + 1, top.Patch, &half });
      }
    }
  }
  return this->Middle[axis] + sign * (best + BoundsPart) * this->Unit;
}

Box3 CellTrees::Bounds() const
{
  Box3 box;
  for (int axis = 0; axis < 3; ++axis)
  {
    box.min()[axis] = this->Extreme(axis, 0);
    box.max()[axis] = this->Extreme(axis, 1);
  }
  return box.isEmpty() ? Box3() : box;
}

} // namespace nurbs
