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

constexpr double ForcedShare =
  0.25;                         // Of the error that a cell was halved at for the zone: to merge.
constexpr double Apart = 1e-12; // Of a cell: vertices on one side.

} // namespace

void DeformingFace::Adapt(
  const std::function<double(const Vec3&)>& scale, bool everything, double hysteresis)
{
  this->MergeShare = hysteresis;
  this->Frozen = this->Options.FixedDepth >= 0;
  const int count = everything ? this->Lines.Patches() : int(this->Touched.size());
  for (int k = 0; k < count; ++k)
  {
    const int index = everything ? k : this->Touched[k];
    this->Patches[index].Tolerance = this->Options.Tolerance * scale(this->NetOf(index).Middle());
    if (this->Options.FixedDepth >= 0)
    {
      this->HalveEvenly(index);
    }
    this->AdaptPatch(index);
  }
}

void DeformingFace::AdaptPatch(int index)
{
  Patch& patch = this->Patches[index];
  patch.Error = 0.0;
  patch.Capped = 0;
  thread_local NetPath path; // Kept for its memory.
  path.Start(this->NetOf(index));
  const ParameterBox box = this->Lines.Box(index);
  this->AdaptCell(index, box.A(), box.B(), path);
  patch.Recheck = false;
}

void DeformingFace::AdaptLate(bool last)
{
  this->Frozen = last;
  std::sort(this->Late.begin(), this->Late.end());
  this->Late.erase(std::unique(this->Late.begin(), this->Late.end()), this->Late.end());
  for (const std::int32_t patch : this->Late)
  {
    this->AdaptPatch(patch);
  }
  this->Late.clear();
}

void DeformingFace::HalveEvenly(std::int32_t index)
{
  const Cell& cell = this->Forest[index];
  const std::uint32_t size = ColumnUnits >> this->Options.FixedDepth;
  const int direction = cell.Width > size ? 0 : 1;
  if (cell.Child < 0 && (cell.Width > size || cell.Height > size) &&
    this->CanSplit(index, direction))
  {
    this->SplitCell(index, direction);
  }
  const std::int32_t child = this->Forest[index].Child;
  if (child >= 0)
  {
    this->HalveEvenly(child);
    this->HalveEvenly(child + 1);
  }
}

// The curvature test (Li, Lau, Green 1997, section 4.2), by a bound of the distance between triangles
// and surface instead of the control points' distances from a plane. a, b: the cell's extents; the path
// leads to it.
void DeformingFace::AdaptCell(std::int32_t index, double a, double b, NetPath& path)
{
  Patch& patch = this->Patches[this->Forest[index].Patch];
  const double tolerance = patch.Tolerance;
  const double moved = patch.Moved.Bow(a, b);
  SecondBound scaled;
  const auto measure = [&]() {
    scaled = path.Scaled();
    const double error = scaled.Bow(1.0, 1.0);
    this->Forest[index].Up = error - moved;
    this->Forest[index].Low = error + moved;
    return error;
  };
  if (patch.Recheck)
  {
    this->Forest[index].Up = std::numeric_limits<double>::infinity();
    this->Forest[index].Low = 0.0;
  }
  const std::int32_t child = this->Forest[index].Child;
  if (child < 0)
  {
    const Cell& cell = this->Forest[index];
    if (cell.State == CellState::Outside)
    {
      return;
    }
    if (cell.Up + moved > tolerance)
    {
      const double error = measure();
      const bool halve = error > tolerance && !this->Frozen;
      const int direction = halve ? this->DirectionOf(index, scaled) : -1;
      if (direction >= 0)
      {
        this->SplitCell(index, direction);
        this->AdaptHalves(index, a, b, path);
        return;
      }
      patch.Capped += error > tolerance && this->Options.FixedDepth < 0;
    }
    patch.Error = std::max(patch.Error, this->Forest[index].Up + moved);
    return;
  }
  this->AdaptHalves(index, a, b, path);
  const Cell& first = this->Forest[child];
  const Cell& second = this->Forest[child + 1];
  if (first.Child >= 0 || second.Child >= 0 || this->Frozen)
  {
    return;
  }
  const bool outside = first.State == CellState::Outside && second.State == CellState::Outside;
  const double forced = this->Forest[index].ForcedAt;
  const double limit = forced > 0.0 ? std::min(this->MergeShare * tolerance, ForcedShare * forced)
                                    : this->MergeShare * tolerance;
  if (outside || (this->Forest[index].Low - moved <= limit && measure() <= limit))
  {
    this->MergeCell(index);
    patch.Error = std::max(patch.Error, outside ? 0.0 : this->Forest[index].Up + moved);
  }
}

void DeformingFace::AdaptHalves(std::int32_t index, double a, double b, NetPath& path)
{
  const std::int32_t child = this->Forest[index].Child;
  const int direction = this->Forest[child].Width < this->Forest[index].Width ? 0 : 1;
  for (int half = 0; half < 2; ++half)
  {
    path.Push(direction, half);
    this->AdaptCell(child + half, direction == 0 ? 0.5 * a : a, direction == 1 ? 0.5 * b : b, path);
    path.Pop();
  }
}

// The direction to halve a cell in: where it deviates more; the longer one if it is the twist that
// does. -1: it is as small as cells become.
int DeformingFace::DirectionOf(std::int32_t index, const SecondBound& scaled) const
{
  const Cell& cell = this->Forest[index];
  const bool twisted = 2.0 * scaled.Uv > scaled.Uu + scaled.Vv;
  const int direction =
    twisted ? (cell.Width >= cell.Height ? 0 : 1) : (scaled.Uu >= scaled.Vv ? 0 : 1);
  return this->CanSplit(index, direction)  ? direction
    : this->CanSplit(index, 1 - direction) ? 1 - direction
                                           : -1;
}

void DeformingFace::SplitCell(std::int32_t index, int direction)
{
  if (this->Forest[index].Built)
  {
    this->Retired.push_back(index);
  }
  this->ZoneChanged = this->ZoneChanged || this->Forest[index].State == CellState::Cut;
  this->MarkSides(this->Forest[index]);
  const std::int32_t child = this->Forest.Split(index, direction);
  ++this->LeafCount;
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
  this->MarkSides(this->Forest[index]);
  this->Forest.Merge(index);
  this->Forest[index].ForcedAt = 0.0;
  --this->LeafCount;
  this->RetiredPairs.push_back(child);
  this->Fresh.push_back(index);
}

// Edges along these sides may have other vertices.
void DeformingFace::MarkSides(const Cell& cell)
{
  for (int side = 0; side < 4; ++side)
  {
    this->NewOnSide[side] = this->NewOnSide[side] || this->IsOnSide(cell, side);
  }
}

// Halves the leaf at a place until its extent in a direction is as asked for.
void DeformingFace::Force(const CellRequest& request)
{
  std::int32_t index = this->Forest.LeafAt(request.I, request.J);
  for (;;)
  {
    const ParameterBox box = this->Forest.Box(index);
    const int d = request.Direction;
    if ((d == 0 ? box.A() : box.B()) <= request.Extent || !this->CanSplit(index, d))
    {
      return;
    }
    const std::int32_t patch = this->Forest[index].Patch;
    const SecondBound second = this->NetOf(patch).Second(box);
    this->Forest[index].ForcedAt =
      std::max(second.Bow(box.A(), box.B()), std::numeric_limits<double>::min());
    this->SplitCell(index, d);
    const double a = d == 0 ? 0.5 * box.A() : box.A();
    const double b = d == 1 ? 0.5 * box.B() : box.B();
    const std::int32_t child = this->Forest[index].Child;
    this->Forest[child].Up = this->Forest[child + 1].Up =
      second.Bow(a, b) - this->Patches[patch].Moved.Bow(a, b);
    index = this->Forest.LeafAt(request.I, request.J);
  }
}

bool DeformingFace::CanSplit(std::int32_t index, int direction) const
{
  return this->Forest.CanSplit(index, direction) && this->LeafCount < this->Options.MaximumLeaves;
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

// The vertex at the crossing of two lines, made if there is none, with one use more. `near`: a cell there.
std::int32_t DeformingFace::Acquire(std::int32_t near, std::uint32_t i, std::uint32_t j)
{
  const int column = this->Lines.Axis[0].ColumnOf(i);
  const int row = this->Lines.Axis[1].ColumnOf(j);
  const std::int32_t index = this->Lines.Patch(column, row);
  Patch& patch = this->Patches[index];
  const std::uint64_t key = this->Key(i, j);
  std::int32_t point = patch.PointAt.Find(key);
  if (point >= 0)
  {
    PointUse& use = this->Slots.Use(point);
    use.Uses += use.Patch >= 0;
    return point;
  }
  PatchVertices& vertices = patch.Vertices;
  if (vertices.Size() == patch.Evaluated)
  {
    this->PatchesWithNew.push_back(index);
  }
  point = this->Slots.AddPoint(
    { this->Index, index, std::int32_t(vertices.Size()), 1 }, this->Lines.UV(i, j));
  vertices.Add(this->Lines.Axis[0].Line(i), this->Lines.Axis[1].Line(j), point, key);
  patch.PointAt.Set(key, point);
  this->MarkAround(near, i, j);
  return point;
}

// One use less; a vertex without any is removed.
void DeformingFace::Release(std::int32_t near, std::int32_t point)
{
  if (this->Slots.Use(point).Patch < 0 || --this->Slots.Use(point).Uses > 0)
  {
    return;
  }
  const PointUse use = this->Slots.Use(point);
  Patch& patch = this->Patches[use.Patch];
  PatchVertices& vertices = patch.Vertices;
  const std::uint64_t key = vertices.Keys[use.Index];
  const std::size_t last = vertices.Size() - 1;
  this->Slots.Use(vertices.Points[last]).Index = use.Index;
  this->SumBytes -= vertices.HasSums() ? BytesPerSum : 0;
  vertices.Remove(use.Index);
  patch.Evaluated = last;
  patch.PointAt.Remove(key);
  this->Slots.RemovePoint(point);
  this->MarkAround(near, std::uint32_t(key >> 32), std::uint32_t(key));
}

// Leaves around a vertex that came or went have other triangles.
void DeformingFace::MarkAround(std::int32_t near, std::uint32_t i, std::uint32_t j)
{
  for (int k = 0; k < 4; ++k)
  {
    const std::int32_t leaf =
      this->Forest.LeafNear(near, std::int64_t(i) - (k & 1), std::int64_t(j) - (k >> 1));
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
  for (int k = 0; k < 4 && !this->Forest[leaf].Built; ++k)
  {
    std::uint32_t i, j;
    this->Corner(this->Forest[leaf], k, i, j);
    this->Forest[leaf].Corners[k] = this->Acquire(leaf, i, j);
  }
  this->Forest[leaf].Built = true;
  this->MarkDirty(leaf);
}

void DeformingFace::Retire(std::int32_t index)
{
  this->Slots.RemoveTriangles({ this->Index, index });
  this->Forest[index].Built = false;
  const std::uint32_t last[2] = { this->Lines.Axis[0].Last(), this->Lines.Axis[1].Last() };
  for (int k = 0; k < 4; ++k)
  {
    std::uint32_t i, j;
    this->Corner(this->Forest[index], k, i, j);
    if (i > 0 && j > 0 && i < last[0] && j < last[1]) // Others are the edges'.
    {
      this->Release(index, this->Forest[index].Corners[k]);
    }
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
      if (this->PointAt(i, j) != this->LoopVertices[segment.Vertex[end]].Point)
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
  const std::uint32_t i = i0 / 2 + i1 / 2; // The sum of large ones does not fit.
  const std::uint32_t j = j0 / 2 + j1 / 2;
  const std::int32_t point = this->PointAt(i, j);
  if (point >= 0)
  {
    this->AppendInner(i0, j0, i, j, out);
    out.push_back({ point, i, j, -1 });
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
      const std::size_t first = out.size();
      out.push_back({ cell.Corners[side], i, j, side });
      this->AppendInner(i, j, i1, j1, out);
      for (std::size_t k = first; k < out.size(); ++k)
      {
        out[k].Side = side;
      }
      continue;
    }
    if (side >= 2)
    {
      std::reverse(segments.begin(), segments.end());
    }
    for (const std::int32_t s : segments)
    {
      const SideSegment& segment = this->Sides[side][s];
      out.push_back({ this->LoopVertices[segment.Vertex[side >= 2]].Point, i, j, side });
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

// The vertices of a cell's boundary in the unit square: corners at its corners, the others on the open
// sides, one after the other, however near they are to each other.
void DeformingFace::PlaceInSquare(const ParameterBox& box,
  const std::vector<BoundaryVertex>& boundary, std::vector<Vec2>& places) const
{
  static const Vec2 start[4] = { Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1) };
  static const Vec2 way[4] = { Vec2(1, 0), Vec2(0, 1), Vec2(-1, 0), Vec2(0, -1) };
  places.clear();
  double last = 0.0;
  for (std::size_t k = 0; k < boundary.size(); ++k)
  {
    const int side = boundary[k].Side;
    const bool corner = k == 0 || boundary[k - 1].Side != side;
    const Vec2 uv = this->Slots.UV(boundary[k].Point);
    const Vec2 place((uv[0] - box.U0) / box.A(), (uv[1] - box.V0) / box.B());
    const double along = corner ? 0.0 : (place - start[side]).dot(way[side]);
    last = corner ? 0.0 : std::min(std::max(along, last + Apart), 1.0 - Apart);
    places.push_back(start[side] + last * way[side]);
  }
}

void DeformingFace::BuildCell(std::int32_t leaf)
{
  thread_local std::vector<BoundaryVertex> boundary; // Kept for their memory.
  thread_local std::vector<Vec2> corners;
  thread_local std::vector<Vec3> places;
  this->Slots.RemoveTriangles({ this->Index, leaf });
  Cell& cell = this->Forest[leaf];
  const bool onSide = this->IsOnSide(cell, 0) || this->IsOnSide(cell, 1) ||
    this->IsOnSide(cell, 2) || this->IsOnSide(cell, 3);
  for (int k = 0; k < 4 && onSide; ++k) // An edge may have another vertex there now.
  {
    std::uint32_t i, j;
    this->Corner(cell, k, i, j);
    cell.Corners[k] = this->PointAt(i, j);
  }
  this->Boundary(cell, boundary);
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
  if (boundary.size() == 5 && !onSide)
  {
    int h = 0; // The one that is no corner.
    while (std::find(cell.Corners, cell.Corners + 4, boundary[h].Point) != cell.Corners + 4)
    {
      ++h;
    }
    for (int k = 1; k < 4; ++k)
    {
      this->AddTriangle(
        leaf, boundary[h].Point, boundary[(h + k) % 5].Point, boundary[(h + k + 1) % 5].Point);
    }
    return;
  }
  this->PlaceInSquare(this->Forest.Box(leaf), boundary, corners);
  places.clear();
  for (std::size_t k = 0; k < boundary.size(); ++k)
  {
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
  const std::vector<GridVertex> before = this->AcquireZone();
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
  for (const GridVertex& vertex : before)
  {
    const std::int32_t near = this->Forest.LeafAt(vertex.first, vertex.second);
    this->Release(near, this->PointAt(vertex.first, vertex.second));
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
  std::fill_n(this->NewOnSide, 4, false);
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

void DeformingFace::Clear()
{
  for (std::int32_t cell = -1; cell < this->Forest.Size(); ++cell)
  {
    this->Slots.RemoveTriangles({ this->Index, cell });
  }
  for (const Patch& patch : this->Patches)
  {
    for (const std::int32_t point : patch.Vertices.Points)
    {
      this->Slots.RemovePoint(point);
    }
  }
  for (const LoopVertex& vertex : this->LoopVertices)
  {
    if (vertex.Point >= 0)
    {
      this->Slots.RemovePoint(vertex.Point);
    }
  }
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
