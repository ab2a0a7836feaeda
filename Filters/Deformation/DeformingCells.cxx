// SPDX-License-Identifier: BSD-3-Clause
// The cells of a face: which there are, their vertices and triangles.
#include "DeformingFace.h"
#include "RectangleTriangulation.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nurbs
{

namespace
{

constexpr double ForcedShare = 0.25; // Of the error to merge at: of cells halved for the zone.
constexpr double CornerSnap = 1e-6;  // Of a cell: loop vertices that are its corners.

} // namespace

// The curvature test (Li, Lau, Green 1997, section 4.2), by a bound of the distance between triangles
// and surface instead of the control points' distances from a plane.
double DeformingFace::Error(std::int32_t cell, SecondBound& second)
{
  const ParameterBox box = this->Forest.Box(cell);
  second = this->NetOf(this->Forest[cell].Patch).Second(box);
  return second.Bow(box.A(), box.B());
}

bool DeformingFace::Adapt(
  const std::function<double(const Vec3&)>& scale, bool everything, double hysteresis)
{
  this->MergeShare = hysteresis;
  const int count = everything ? this->Lines.Patches() : int(this->Touched.size());
  for (int k = 0; k < count; ++k)
  {
    const int index = everything ? k : this->Touched[k];
    Patch& patch = this->Patches[index];
    patch.Tolerance = this->Options.Tolerance * scale(this->NetOf(index).Middle());
    patch.Error = 0.0;
    patch.Capped = 0;
    if (this->Options.FixedDepth >= 0)
    {
      this->HalveEvenly(index);
    }
    else
    {
      this->AdaptCell(index);
    }
    patch.Recheck = false;
  }
  return this->HasNewCells();
}

void DeformingFace::HalveEvenly(std::int32_t index)
{
  const Cell& cell = this->Forest[index];
  const std::uint32_t size = ColumnUnits >> this->Options.FixedDepth;
  if (cell.Child < 0 && (cell.Width > size || cell.Height > size))
  {
    this->SplitCell(index, cell.Width > size ? 0 : 1);
  }
  const std::int32_t child = this->Forest[index].Child;
  if (child >= 0)
  {
    this->HalveEvenly(child);
    this->HalveEvenly(child + 1);
  }
}

// What the patch's moves can have changed of a cell's error.
double DeformingFace::Weighed(const Cell& cell) const
{
  const double a = this->Lines.Axis[0].Extent(this->Lines.Column(cell.Patch)).Length();
  const double b = this->Lines.Axis[1].Extent(this->Lines.Row(cell.Patch)).Length();
  return this->Patches[cell.Patch].Moved.Bow(
    a * (double(cell.Width) / ColumnUnits), b * (double(cell.Height) / ColumnUnits));
}

void DeformingFace::AdaptCell(std::int32_t index)
{
  Patch& patch = this->Patches[this->Forest[index].Patch];
  const double tolerance = patch.Tolerance;
  const double moved = this->Weighed(this->Forest[index]);
  SecondBound second;
  const auto measure = [&]() {
    const double error = this->Error(index, second);
    this->Forest[index].Up = error - moved;
    this->Forest[index].Low = error + moved;
    return error;
  };
  const std::int32_t child = this->Forest[index].Child;
  if (child < 0 && this->Forest[index].State == CellState::Outside)
  {
    return;
  }
  if (child < 0)
  {
    const bool unknown = patch.Recheck || std::isinf(this->Forest[index].Up);
    if (unknown || this->Forest[index].Up + moved > tolerance)
    {
      const double error = measure();
      const int direction = error > tolerance ? this->DirectionOf(index, second) : -1;
      if (direction >= 0)
      {
        this->SplitCell(index, direction);
        this->AdaptCell(this->Forest[index].Child);
        this->AdaptCell(this->Forest[index].Child + 1);
        return;
      }
      patch.Capped += error > tolerance;
    }
    patch.Error = std::max(patch.Error, this->Forest[index].Up + moved);
    return;
  }
  this->AdaptCell(child);
  this->AdaptCell(child + 1);
  if (!this->Forest.IsLeaf(child) || !this->Forest.IsLeaf(child + 1))
  {
    return;
  }
  if (this->Forest[child].State == CellState::Outside &&
    this->Forest[child + 1].State == CellState::Outside)
  {
    this->MergeCell(index);
    return;
  }
  const double limit =
    this->MergeShare * tolerance * (this->Forest[index].Forced ? ForcedShare : 1.0);
  if ((patch.Recheck || this->Forest[index].Low - moved <= limit) && measure() <= limit)
  {
    this->MergeCell(index);
  }
}

// The direction to halve a cell in: where it deviates more; the longer one if it is the twist that
// does. -1: it is as small as cells become.
int DeformingFace::DirectionOf(std::int32_t index, const SecondBound& second) const
{
  const ParameterBox box = this->Forest.Box(index);
  const Cell& cell = this->Forest[index];
  const double u = box.A() * box.A() * second.Uu;
  const double v = box.B() * box.B() * second.Vv;
  const bool twisted = 2.0 * box.A() * box.B() * second.Uv > u + v;
  const int direction = twisted ? (cell.Width >= cell.Height ? 0 : 1) : (u >= v ? 0 : 1);
  return this->Forest.CanSplit(index, direction)  ? direction
    : this->Forest.CanSplit(index, 1 - direction) ? 1 - direction
                                                  : -1;
}

void DeformingFace::SplitCell(std::int32_t index, int direction)
{
  if (this->Forest[index].Built)
  {
    this->Retired.push_back(index);
  }
  this->ZoneChanged = this->ZoneChanged || this->Forest[index].State == CellState::Cut;
  const std::int32_t child = this->Forest.Split(index, direction);
  this->Fresh.push_back(child);
  this->Fresh.push_back(child + 1);
}

void DeformingFace::MergeCell(std::int32_t index)
{
  const std::int32_t child = this->Forest[index].Child;
  for (std::int32_t k = child; k <= child + 1; ++k)
  {
    if (this->Forest[k].Built)
    {
      this->Retired.push_back(k);
    }
    this->ZoneChanged = this->ZoneChanged || this->Forest[k].State == CellState::Cut;
  }
  this->Forest.Merge(index);
  this->RetiredPairs.push_back(child);
  this->Fresh.push_back(index);
}

void DeformingFace::Force(std::int32_t index)
{
  if (!this->Forest.IsLeaf(index))
  {
    return; // Asked for by two triangles.
  }
  SecondBound second;
  this->Error(index, second);
  const int direction = this->DirectionOf(index, second);
  if (direction >= 0)
  {
    this->Forest[index].Forced = true;
    this->SplitCell(index, direction);
    const std::int32_t child = this->Forest[index].Child;
    this->AdaptCell(child);
    this->AdaptCell(child + 1);
  }
}

void DeformingFace::SideLines(int side, std::vector<std::uint32_t>& lines) const
{
  lines.assign(1, 0);
  this->Forest.ForSide(side, [&](std::int32_t leaf) {
    const Cell& cell = this->Forest[leaf];
    lines.push_back(side % 2 == 0 ? cell.I + cell.Width : cell.J + cell.Height);
  });
}

// Corners counter-clockwise from the lower left one; side k goes from corner k to the next.
void DeformingFace::Corner(const Cell& cell, int k, std::uint32_t& i, std::uint32_t& j) const
{
  i = cell.I + (k == 1 || k == 2 ? cell.Width : 0);
  j = cell.J + (k >= 2 ? cell.Height : 0);
}

// The vertex at the crossing of two lines, made if there is none, with one use more.
std::int32_t DeformingFace::Acquire(std::uint32_t i, std::uint32_t j)
{
  const std::uint64_t key = this->Key(i, j);
  std::int32_t point = this->PointAt.Find(key);
  if (point >= 0)
  {
    PointUse& use = this->Slots.Use(point);
    use.Uses += use.Patch >= 0;
    return point;
  }
  const int column = this->Lines.Axis[0].ColumnOf(i);
  const int row = this->Lines.Axis[1].ColumnOf(j);
  const std::int32_t index = this->Lines.Patch(column, row);
  PatchVertices& vertices = this->Patches[index].Vertices;
  if (vertices.Size() == this->Patches[index].Evaluated)
  {
    this->PatchesWithNew.push_back(index);
  }
  point = this->Slots.AddPoint(
    { this->Index, index, std::int32_t(vertices.Size()), 1 }, this->Lines.UV(i, j));
  vertices.I.push_back(this->Lines.Axis[0].Line(i));
  vertices.J.push_back(this->Lines.Axis[1].Line(j));
  vertices.Points.push_back(point);
  vertices.Keys.push_back(key);
  this->PointAt.Set(key, point);
  this->MarkAround(i, j);
  return point;
}

// One use less; a vertex without any is removed.
void DeformingFace::Release(std::uint32_t i, std::uint32_t j)
{
  const std::uint64_t key = this->Key(i, j);
  const std::int32_t point = this->PointAt.Find(key);
  if (point < 0 || this->Slots.Use(point).Patch < 0 || --this->Slots.Use(point).Uses > 0)
  {
    return;
  }
  const PointUse use = this->Slots.Use(point);
  Patch& patch = this->Patches[use.Patch];
  PatchVertices& vertices = patch.Vertices;
  const std::size_t last = vertices.Size() - 1;
  vertices.I[use.Index] = vertices.I[last];
  vertices.J[use.Index] = vertices.J[last];
  vertices.Points[use.Index] = vertices.Points[last];
  vertices.Keys[use.Index] = vertices.Keys[last];
  this->Slots.Use(vertices.Points[last]).Index = use.Index;
  vertices.I.pop_back();
  vertices.J.pop_back();
  vertices.Points.pop_back();
  vertices.Keys.pop_back();
  if (vertices.HasSums())
  {
    const std::size_t size = vertices.Sums.size() / (last + 1);
    std::copy_n(vertices.Sums.data() + last * size, size, vertices.Sums.data() + use.Index * size);
    vertices.Sums.resize(last * size);
    this->SumBytes -= BytesPerSum;
  }
  patch.Evaluated = last;
  this->PointAt.Remove(key);
  this->Slots.RemovePoint(point);
  this->MarkAround(i, j);
}

// Leaves around a vertex that came or went have other triangles.
void DeformingFace::MarkAround(std::uint32_t i, std::uint32_t j)
{
  for (int k = 0; k < 4; ++k)
  {
    const std::int32_t leaf =
      this->Forest.LeafAt(std::int64_t(i) - (k & 1), std::int64_t(j) - (k >> 1));
    if (leaf >= 0)
    {
      this->MarkDirty(leaf);
    }
  }
}

void DeformingFace::MarkDirty(std::int32_t leaf)
{
  Cell& cell = this->Forest[leaf];
  this->ZoneChanged = this->ZoneChanged || cell.State == CellState::Cut;
  if (cell.State == CellState::Inside && !cell.Dirty)
  {
    cell.Dirty = true;
    this->Dirty.push_back(leaf);
  }
}

void DeformingFace::AcquireCorners(std::int32_t leaf)
{
  Cell& cell = this->Forest[leaf];
  for (int k = 0; k < 4 && !cell.Built; ++k)
  {
    std::uint32_t i, j;
    this->Corner(cell, k, i, j);
    this->Acquire(i, j);
  }
  cell.Built = true;
  this->MarkDirty(leaf);
}

void DeformingFace::Retire(std::int32_t index)
{
  Cell& cell = this->Forest[index];
  this->Slots.RemoveTriangles({ this->Index, index });
  cell.Built = false;
  for (int k = 0; k < 4; ++k)
  {
    std::uint32_t i, j;
    this->Corner(cell, k, i, j);
    this->Release(i, j);
  }
}

bool DeformingFace::IsOnSide(const Cell& cell, int side) const
{
  return side == 0 ? cell.J == 0
    : side == 1    ? cell.I + cell.Width == this->Lines.Axis[0].Last()
    : side == 2    ? cell.J + cell.Height == this->Lines.Axis[1].Last()
                   : cell.I == 0;
}

// The loops' segments along a leaf's side, ascending; false: they do not go from corner to corner.
bool DeformingFace::FindChain(const Cell& cell, int side, std::vector<std::int32_t>& segments) const
{
  const std::int64_t low = side % 2 == 0 ? cell.I : cell.J;
  const std::int64_t high = low + (side % 2 == 0 ? cell.Width : cell.Height);
  const std::vector<SideSegment>& all = this->Sides[side];
  const double start = this->Lines.Axis[side % 2].Parameter(std::uint32_t(low));
  const double near = 1e-6 * (this->Lines.Axis[side % 2].Parameter(std::uint32_t(high)) - start);
  auto at = std::lower_bound(all.begin(), all.end(), start - near,
    [](const SideSegment& s, double t) { return s.Start < t; });
  while (at != all.end() && at->Line[0] != low && at->Start <= start + near)
  {
    ++at;
  }
  segments.clear();
  std::int64_t line = low;
  for (; at != all.end() && line != high; ++at)
  {
    const bool follows =
      segments.empty() ? at->Line[0] == low : at->Vertex[0] == all[segments.back()].Vertex[1];
    if (!follows)
    {
      return false;
    }
    segments.push_back(std::int32_t(at - all.begin()));
    line = at->Line[1];
  }
  return line == high;
}

// True if the edges along the sides of the grid have vertices at the leaf's corners there, which are
// those that its neighbours have.
bool DeformingFace::TakesSides(const Cell& cell) const
{
  std::vector<std::int32_t> segments;
  for (int side = 0; side < 4; ++side)
  {
    if (!this->IsOnSide(cell, side))
    {
      continue;
    }
    if (!this->FindChain(cell, side, segments))
    {
      return false;
    }
    for (int end = 0; end < 2; ++end)
    {
      const SideSegment& segment = this->Sides[side][end ? segments.back() : segments.front()];
      const std::uint32_t i = cell.I + (side == 1 || (side % 2 == 0 && end) ? cell.Width : 0);
      const std::uint32_t j = cell.J + (side == 2 || (side % 2 == 1 && end) ? cell.Height : 0);
      if (this->PointAt.Find(this->Key(i, j)) != this->LoopVertices[segment.Vertex[end]].Point)
      {
        return false;
      }
    }
  }
  return true;
}

// Vertices strictly between two crossings of lines. A dyadic line that has any has one in its middle.
void DeformingFace::AppendInner(std::uint32_t i0, std::uint32_t j0, std::uint32_t i1,
  std::uint32_t j1, std::vector<BoundaryVertex>& out) const
{
  const std::uint32_t length =
    std::max(std::max(i0, i1) - std::min(i0, i1), std::max(j0, j1) - std::min(j0, j1));
  if (length <= CellForest::SmallestSize)
  {
    return;
  }
  const std::uint32_t i = (i0 + i1) / 2;
  const std::uint32_t j = (j0 + j1) / 2;
  const std::int32_t point = this->PointAt.Find(this->Key(i, j));
  if (point >= 0)
  {
    this->AppendInner(i0, j0, i, j, out);
    out.push_back({ point, i, j });
    this->AppendInner(i, j, i1, j1, out);
  }
}

// All vertices on the sides of a leaf, counter-clockwise from its lower left corner.
void DeformingFace::Boundary(const Cell& cell, std::vector<BoundaryVertex>& out) const
{
  out.clear();
  std::vector<std::int32_t> segments;
  for (int side = 0; side < 4; ++side)
  {
    std::uint32_t i, j, i1, j1;
    this->Corner(cell, side, i, j);
    this->Corner(cell, (side + 1) % 4, i1, j1);
    if (!this->IsOnSide(cell, side) || !this->FindChain(cell, side, segments))
    {
      out.push_back({ this->PointAt.Find(this->Key(i, j)), i, j });
      this->AppendInner(i, j, i1, j1, out);
      continue;
    }
    if (side >= 2)
    {
      std::reverse(segments.begin(), segments.end());
    }
    for (const std::int32_t s : segments)
    {
      const SideSegment& segment = this->Sides[side][s];
      out.push_back({ this->LoopVertices[segment.Vertex[side >= 2]].Point, i, j });
    }
  }
}

// Corners that are one vertex of the model (a pole, the ends of a seam) make no triangle.
bool DeformingFace::IsFlat(std::int32_t a, std::int32_t b, std::int32_t c)
{
  const auto vertex = [&](std::int32_t point) {
    const PointUse& use = this->Slots.Use(point);
    return use.Patch >= 0 ? std::int64_t(-1) : this->LoopVertices[use.Index].Vertex;
  };
  const std::int64_t va = vertex(a);
  const std::int64_t vb = vertex(b);
  const std::int64_t vc = vertex(c);
  return (va >= 0 && (va == vb || va == vc)) || (vb >= 0 && vb == vc);
}

void DeformingFace::AddTriangle(std::int32_t cell, std::int32_t a, std::int32_t b, std::int32_t c)
{
  if (!this->IsFlat(a, b, c))
  {
    this->Reversed ? this->Slots.AddTriangle({ this->Index, cell }, a, c, b)
                   : this->Slots.AddTriangle({ this->Index, cell }, a, b, c);
  }
}

void DeformingFace::BuildCell(std::int32_t leaf)
{
  thread_local std::vector<BoundaryVertex> boundary; // Kept for their memory.
  thread_local std::vector<Vec2> corners;
  thread_local std::vector<Vec3> places;
  this->Slots.RemoveTriangles({ this->Index, leaf });
  this->Boundary(this->Forest[leaf], boundary);
  const auto point = [&](int k) { return this->Slots.Point(boundary[k].Point); };
  if (boundary.size() == 4)
  {
    const bool first = (point(0) - point(2)).squaredNorm() <= (point(1) - point(3)).squaredNorm();
    const int k = first ? 0 : 1;
    for (int half = 0; half < 4; half += 2)
    {
      this->AddTriangle(leaf, boundary[(k + half) % 4].Point, boundary[(k + half + 1) % 4].Point,
        boundary[(k + half + 2) % 4].Point);
    }
    return;
  }
  const ParameterBox box = this->Forest.Box(leaf);
  corners.clear();
  places.clear();
  for (std::size_t k = 0; k < boundary.size(); ++k)
  {
    const Vec2 uv = this->Slots.UV(boundary[k].Point);
    const auto snap = [](double t) {
      return std::abs(t) < CornerSnap ? 0.0 : std::abs(t - 1.0) < CornerSnap ? 1.0 : t;
    };
    corners.emplace_back(snap((uv[0] - box.U0) / box.A()), snap((uv[1] - box.V0) / box.B()));
    places.push_back(point(int(k)));
  }
  for (const std::array<int, 3>& t : TriangulateRectangle(corners, places))
  {
    this->AddTriangle(leaf, boundary[t[0]].Point, boundary[t[1]].Point, boundary[t[2]].Point);
  }
}

void DeformingFace::Rebuild(RefinementRequests& requests)
{
  this->ClassifyLeaves();
  for (const std::int32_t leaf : this->Fresh)
  {
    if (this->Forest[leaf].Patch >= 0 && this->Forest.IsLeaf(leaf) &&
      this->Forest[leaf].State == CellState::Inside)
    {
      this->AcquireCorners(leaf);
    }
  }
  this->Fresh.clear();
  const std::vector<std::pair<std::uint32_t, std::uint32_t>> before = this->AcquireZone();
  this->EvaluateNew();
  for (const std::int32_t cell : this->Retired)
  {
    const bool leaf = this->Forest[cell].Patch >= 0 && this->Forest.IsLeaf(cell);
    if (this->Forest[cell].Built && !(leaf && this->Forest[cell].State == CellState::Inside))
    {
      this->Retire(cell);
    }
  }
  this->Retired.clear();
  for (const std::int32_t pair : this->RetiredPairs)
  {
    this->Forest.GiveBack(pair);
  }
  this->RetiredPairs.clear();
  for (const auto& vertex : before)
  {
    this->Release(vertex.first, vertex.second);
  }
  for (const std::int32_t leaf : this->Dirty)
  {
    if (this->Forest[leaf].Dirty && this->Forest[leaf].Built && this->Forest.IsLeaf(leaf))
    {
      this->BuildCell(leaf);
    }
    this->Forest[leaf].Dirty = false;
  }
  this->Dirty.clear();
  if (this->ZoneChanged)
  {
    this->BuildZone(requests);
  }
  else
  {
    this->CheckZone(requests, false);
  }
  this->ZoneChanged = this->LoopsChanged = this->SidesChanged = false;
}

std::int64_t DeformingFace::EstimateTriangles() const
{
  std::int64_t count = 0;
  for (int patch = 0; patch < this->Lines.Patches(); ++patch)
  {
    this->Forest.ForLeaves(
      patch, [&](std::int32_t leaf) { count += this->Forest[leaf].State != CellState::Outside; });
  }
  return 2 * count;
}

double DeformingFace::ErrorBound() const
{
  double error = this->ZoneError;
  for (const Patch& patch : this->Patches)
  {
    error = std::max(error, patch.Error);
  }
  return error;
}

std::int64_t DeformingFace::CappedCells() const
{
  std::int64_t count = this->CappedTriangles;
  for (const Patch& patch : this->Patches)
  {
    count += patch.Capped;
  }
  return count;
}

} // namespace nurbs
