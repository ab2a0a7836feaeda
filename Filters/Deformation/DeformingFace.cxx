// SPDX-License-Identifier: BSD-3-Clause
// A face's control points and vertices; DeformingCells.cxx has its cells, FaceZone.cxx its zone.
#include "DeformingFace.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace nurbs
{

namespace
{

// Sums that were added to so often are evaluated afresh: what rounding can have done to them by then
// is under 1e-12 of the largest coordinate (each update rounds by 2^-53 of it, and by a few times 2^-53
// of what is added).
constexpr int MostUpdates = 1000;
constexpr int LengthsEvery =
  8; // Updates, after which the lengths that normals are judged by are new.

} // namespace

DeformingFace::DeformingFace(const SurfaceView& surface, bool reversed, const ParameterBox& used,
  std::int32_t index, MeshSlots& slots, const FaceOptions& options)
  : Index(index)
  , Slots(slots)
  , Options(options)
  , Reversed(reversed)
  , Box(used)
  , Surface(surface)
  , Lines(surface, used)
  , Forest(this->Lines)
  , Rational(surface.Weights != nullptr)
  , Control(surface.Size())
  , Change(surface.Size(), Vec4::Zero())
  , Patches(this->Lines.Patches())
{
  this->Remember(surface);
  this->LeafCount = this->Forest.Size();
  for (std::int32_t cell = 0; cell < this->Forest.Size(); ++cell)
  {
    this->Fresh.push_back(cell);
  }
  for (int d = 0; d < 2; ++d)
  {
    for (const double knot : CreaseKnots(surface.Knots[d], surface.Degree[d]))
    {
      if (knot > this->Lines.Axis[d].Start() && knot < this->Lines.Axis[d].End())
      {
        this->CreaseLines[d].push_back(knot);
      }
    }
  }
}

void DeformingFace::Remember(const SurfaceView& surface)
{
  const std::int64_t count = surface.Size();
  this->Places.resize(3 * count);
  for (std::int64_t k = 0; k < count; ++k)
  {
    std::copy_n(surface.Points + 3 * surface.Id(k), 3, this->Places.data() + 3 * k);
    this->Control[k] = surface.Homogeneous(k);
  }
}

// Compares whole blocks of memory where control points lie one after the other, as they mostly do.
std::int64_t DeformingFace::Compare(const SurfaceView& surface)
{
  constexpr std::int64_t block = 64;
  const std::int64_t count = surface.Size();
  const std::int64_t first = surface.Id(0);
  this->MovedPoints.clear();
  bool even = surface.Id(count - 1) - first == count - 1;
  for (std::int64_t k = 0; even && surface.Ids && k < count; ++k)
  {
    even = surface.Ids[k] - first == k;
  }
  for (std::int64_t start = 0; start < count; start += block)
  {
    const std::int64_t end = std::min(count, start + block);
    const bool same = even && !surface.Weights && !this->Rational &&
      std::memcmp(surface.Points + 3 * (first + start), this->Places.data() + 3 * start,
        3 * (end - start) * sizeof(double)) == 0;
    for (std::int64_t k = start; k < end && !same; ++k)
    {
      const double* x = surface.Points + 3 * surface.Id(k);
      const double* last = this->Places.data() + 3 * k;
      if (x[0] != last[0] || x[1] != last[1] || x[2] != last[2] ||
        surface.Weight(k) != this->Control[k][3])
      {
        this->MovedPoints.push_back(std::int32_t(k));
      }
    }
  }
  return std::int64_t(this->MovedPoints.size());
}

std::string DeformingFace::Check(
  const SurfaceView& surface, double largestMove, double onePlace) const
{
  const auto name = [&](std::int64_t k) {
    const std::int64_t width = surface.Count[0];
    return "control point (" + std::to_string(k % width) + ", " + std::to_string(k / width) +
      "), point " + std::to_string(surface.Id(k)) + ", ";
  };
  for (const std::int32_t k : this->MovedPoints)
  {
    const Vec3 x = surface.Point(k);
    const double w = surface.Weight(k);
    if (!x.allFinite() || !std::isfinite(w))
    {
      return name(k) + "is not finite";
    }
    if (!(w > 0.0))
    {
      return name(k) + "has the weight " + std::to_string(w) + ", which must be positive";
    }
    const double distance =
      (x - Eigen::Map<const Vec3>(this->Places.data() + 3 * std::int64_t(k))).norm();
    if (distance > largestMove)
    {
      return name(k) + "moved by " + std::to_string(distance) + ", more than " +
        std::to_string(largestMove);
    }
  }
  Box3 box;
  for (std::int64_t k = 0; !this->MovedPoints.empty() && k < surface.Size(); ++k)
  {
    box.extend(surface.Point(k));
    if (box.diagonal().squaredNorm() > onePlace * onePlace)
    {
      return "";
    }
  }
  return this->MovedPoints.empty() ? "" : name(0) + "and all others are in one place";
}

// The control points that a patch depends on, u fastest.
void DeformingFace::Gather(int patch, const std::vector<Vec4>& from, std::vector<Vec4>& net) const
{
  const GridAxis& u = this->Lines.Axis[0];
  const GridAxis& v = this->Lines.Axis[1];
  const int i0 = u.First(this->Lines.Column(patch));
  const int j0 = v.First(this->Lines.Row(patch));
  const int n = u.Degree() + 1;
  net.resize(std::size_t(n) * (v.Degree() + 1));
  for (int j = 0; j <= v.Degree(); ++j)
  {
    std::copy_n(
      from.data() + i0 + std::int64_t(j0 + j) * this->Surface.Count[0], n, net.data() + j * n);
  }
}

BezierNet& DeformingFace::NetOf(int index)
{
  Patch& patch = this->Patches[index];
  if (!patch.HasNet)
  {
    std::vector<Vec4> net;
    this->Gather(index, this->Control, net);
    patch.Net.Make(this->Lines, index, this->Rational, net.data());
    patch.HasNet = true;
  }
  return patch.Net;
}

// The local support of every control point that moved.
void DeformingFace::MarkPatches()
{
  for (const int patch : this->Touched)
  {
    this->Patches[patch].Touched = false;
  }
  this->Touched.clear();
  for (const std::int32_t k : this->MovedPoints)
  {
    const int at[2] = { int(k % this->Surface.Count[0]), int(k / this->Surface.Count[0]) };
    int first[2], last[2];
    for (int d = 0; d < 2; ++d)
    {
      this->Lines.Axis[d].ColumnsOf(at[d], first[d], last[d]);
    }
    for (int row = first[1]; row <= last[1]; ++row)
    {
      for (int column = first[0]; column <= last[0]; ++column)
      {
        const int patch = this->Lines.Patch(column, row);
        if (!this->Patches[patch].Touched)
        {
          this->Patches[patch].Touched = true;
          this->Touched.push_back(patch);
        }
      }
    }
  }
}

// What the move can have changed of the patch's derivatives.
void DeformingFace::SumMove(int index, SecondBound& second, Vec2& first)
{
  Patch& patch = this->Patches[index];
  if (this->WeightsMoved || !this->Options.Refine)
  {
    patch.Recheck = true;
    return;
  }
  std::vector<Vec4> net, control;
  this->Gather(index, this->Change, net);
  this->Gather(index, this->Control, control);
  for (std::size_t k = 0; k < net.size(); ++k)
  {
    net[k][3] = control[k][3]; // w V and the weights that S has, too.
  }
  BezierNet moves;
  moves.Make(this->Lines, index, this->Rational, net.data());
  const SecondBound change = moves.Second(this->Lines.Box(index));
  patch.Moved += change;
  second.Extend(change);
  first = first.cwiseMax(moves.First());
}

std::int64_t DeformingFace::Move(const SurfaceView& surface)
{
  this->WeightsMoved = false;
  for (const std::int32_t k : this->MovedPoints)
  {
    this->Change[k] = surface.Homogeneous(k) - this->Control[k];
    this->WeightsMoved = this->WeightsMoved || this->Change[k][3] != 0.0;
  }
  this->MarkPatches();
  SecondBound second;
  Vec2 first = Vec2::Zero();
  for (const int patch : this->Touched)
  {
    this->SumMove(patch, second, first);
  }
  this->SumSecond += second;
  this->SumFirst += first;
  this->ResetCount += this->WeightsMoved || !(this->Options.Refine || this->Touched.empty());
  this->Surface = surface;
  this->Rational = surface.Weights != nullptr;
  for (const std::int32_t k : this->MovedPoints)
  {
    this->Control[k] = surface.Homogeneous(k);
    std::copy_n(surface.Points + 3 * surface.Id(k), 3, this->Places.data() + 3 * std::int64_t(k));
  }
  std::int64_t updated = 0;
  for (const int patch : this->Touched)
  {
    this->Patches[patch].HasNet = false;
    updated += this->MovePatch(patch);
  }
  for (const std::int32_t k : this->MovedPoints)
  {
    this->Change[k].setZero();
  }
  return updated + this->MoveLoopVertices();
}

// By the coefficients of the control points that moved, if they are few enough to make that cheaper
// than the sum over all; else, or when rounding could show, by the sum.
std::int64_t DeformingFace::MovePatch(int index)
{
  Patch& patch = this->Patches[index];
  const int count = this->Lines.Axis[1].Degree() + 1;
  const int n = this->Lines.Axis[0].Degree() + 1;
  thread_local std::vector<Vec4> change; // Kept for its memory, as below.
  this->Gather(index, this->Change, change);
  int first = count, last = -1;
  for (int row = 0; row < count; ++row)
  {
    for (int k = row * n; k < (row + 1) * n; ++k)
    {
      if (!change[k].isZero(0.0))
      {
        first = std::min(first, row);
        last = row;
      }
    }
  }
  PatchVertices& vertices = patch.Vertices;
  const bool few = 2 * (last - first + 1) <= count;
  PatchUpdate update;
  if (few && vertices.HasSums() && vertices.Updates < MostUpdates)
  {
    update.Accumulate = update.Keep = true;
    update.Net = change.data();
    update.FirstRow = first;
    update.LastRow = last;
    const bool now = vertices.Updates++ % LengthsEvery == 0;
    thread_local std::vector<Vec4> control;
    if (now)
    {
      this->Gather(index, this->Control, control);
    }
    this->UpdatePatch(index, update, 0, now ? control.data() : nullptr);
    return std::int64_t(vertices.Size());
  }
  const std::int64_t bytes = std::int64_t(vertices.Size()) * BytesPerSum;
  const std::int64_t before = vertices.HasSums() ? bytes : 0;
  update.Keep = few && this->SumBytes - before + bytes <= this->Options.MaximumSums;
  if (!update.Keep)
  {
    vertices.Sums.clear();
  }
  this->SumBytes += (update.Keep ? bytes : 0) - before;
  vertices.Updates = 0;
  this->Gather(index, this->Control, change);
  update.Net = change.data();
  update.LastRow = count - 1;
  this->UpdatePatch(index, update, 0, change.data());
  return std::int64_t(vertices.Size());
}

void DeformingFace::UpdatePatch(
  int index, PatchUpdate& update, std::size_t begin, const Vec4* control)
{
  PatchVertices& vertices = this->Patches[index].Vertices;
  if (vertices.Size() == begin)
  {
    return;
  }
  update.Grid = &this->Lines;
  update.Patch = index;
  update.Rational = this->Rational;
  update.Reversed = this->Reversed;
  double(&shortest)[2] = this->Patches[index].Shortest;
  if (control)
  {
    ShortestDerivatives(this->Lines, index, this->Rational, control, shortest);
  }
  std::copy_n(shortest, 2, update.Shortest);
  MeshArrays& mesh = this->Slots.Arrays();
  for (const std::int32_t k : UpdateVertices(update, vertices, begin, mesh.Points, mesh.Normals))
  {
    this->MendNormal(vertices.Points[k]);
  }
}

// The exact way, which finds the limit where the cross product vanishes.
void DeformingFace::MendNormal(std::int32_t point)
{
  const Vec2 uv = this->Slots.UV(point);
  const Vec3 normal = Normal(this->Surface, uv[0], uv[1]);
  float* to = this->Slots.Arrays().Normals + 3 * std::int64_t(point);
  for (int k = 0; k < 3; ++k)
  {
    to[k] = float(this->Reversed ? -normal[k] : normal[k]);
  }
}

// Vertices of the grid that were added.
void DeformingFace::EvaluateNew()
{
  std::vector<Vec4> net;
  for (const std::int32_t index : this->PatchesWithNew)
  {
    Patch& patch = this->Patches[index];
    PatchUpdate update;
    const std::int64_t added = std::int64_t(patch.Vertices.Size() - patch.Evaluated);
    update.Keep = patch.Vertices.HasSums();
    this->SumBytes += update.Keep ? added * BytesPerSum : 0;
    this->Gather(index, this->Control, net);
    update.Net = net.data();
    update.LastRow = this->Lines.Axis[1].Degree();
    this->UpdatePatch(index, update, patch.Evaluated, net.data());
    patch.Evaluated = patch.Vertices.Size();
  }
  this->PatchesWithNew.clear();
}

std::int32_t DeformingFace::AddLoopVertex(const Vec2& uv, std::int64_t modelVertex)
{
  std::int32_t index;
  if (!this->FreeLoopVertices.empty())
  {
    index = this->FreeLoopVertices.back();
    this->FreeLoopVertices.pop_back();
  }
  else
  {
    index = std::int32_t(this->LoopVertices.size());
    this->LoopVertices.emplace_back();
  }
  LoopVertex& vertex = this->LoopVertices[index];
  vertex = LoopVertex();
  vertex.UV = uv;
  vertex.Vertex = modelVertex;
  const int column = this->Lines.Axis[0].ColumnAt(uv[0]);
  const int row = this->Lines.Axis[1].ColumnAt(uv[1]);
  vertex.Patch = this->Lines.Patch(column, row);
  vertex.Point = this->Slots.AddPoint({ this->Index, -1, index, 0 }, uv);
  if (this->Options.KeepCoefficients)
  {
    const std::size_t size = this->CoefficientCount();
    this->Coefficients.resize(std::max(this->Coefficients.size(), std::size_t(index + 1) * size));
    this->EvaluateCoefficients(index, this->Coefficients.data() + index * size);
  }
  this->NewLoopVertices.push_back(index);
  return index;
}

void DeformingFace::EvaluateCoefficients(std::int32_t index, double* to) const
{
  const LoopVertex& vertex = this->LoopVertices[index];
  const GridAxis& u = this->Lines.Axis[0];
  u.EvaluateAt(this->Lines.Column(vertex.Patch), vertex.UV[0], to);
  this->Lines.Axis[1].EvaluateAt(
    this->Lines.Row(vertex.Patch), vertex.UV[1], to + 2 * (u.Degree() + 1));
}

void DeformingFace::RemoveLoopVertex(std::int32_t index)
{
  LoopVertex& vertex = this->LoopVertices[index];
  this->Unregister(vertex);
  this->Slots.RemovePoint(vertex.Point);
  vertex.Point = -1;
  this->FreeLoopVertices.push_back(index);
}

// H, H_u, H_v of a loop vertex.
void DeformingFace::SumLoopVertex(std::int32_t index, Vec4 (&h)[3], double (*shortest)[2]) const
{
  const LoopVertex& vertex = this->LoopVertices[index];
  const int p = this->Lines.Axis[0].Degree();
  const int q = this->Lines.Axis[1].Degree();
  double own[4 * (MaxDegree + 1)];
  const double* basis = own;
  if (this->Options.KeepCoefficients)
  {
    basis = this->Coefficients.data() + index * this->CoefficientCount();
  }
  else
  {
    this->EvaluateCoefficients(index, own);
  }
  thread_local std::vector<Vec4> net; // Kept for its memory.
  this->Gather(vertex.Patch, this->Control, net);
  SumVertex(basis, p, basis + 2 * (p + 1), q, net.data(), h);
  if (shortest)
  {
    ShortestDerivatives(this->Lines, vertex.Patch, this->Rational, net.data(), *shortest);
  }
}

Vec3 DeformingFace::PlaceOf(std::int32_t index) const
{
  Vec4 h[3];
  this->SumLoopVertex(index, h, nullptr);
  return h[0].head<3>() / (this->Rational ? h[0][3] : 1.0);
}

void DeformingFace::EvaluateLoopVertex(std::int32_t index)
{
  const LoopVertex& vertex = this->LoopVertices[index];
  Vec4 h[3];
  double shortest[2];
  this->SumLoopVertex(index, h, &shortest);
  MeshArrays& mesh = this->Slots.Arrays();
  const std::int64_t at = 3 * std::int64_t(vertex.Point);
  if (!FinishVertex(
        h, this->Rational, this->Reversed, shortest, mesh.Points + at, mesh.Normals + at))
  {
    this->MendNormal(vertex.Point);
  }
}

void DeformingFace::EvaluateLoopVertices()
{
  for (const std::int32_t index : this->NewLoopVertices)
  {
    if (this->LoopVertices[index].Point >= 0)
    {
      this->EvaluateLoopVertex(index);
    }
  }
  this->NewLoopVertices.clear();
}

std::int64_t DeformingFace::MoveLoopVertices()
{
  std::int64_t updated = 0;
  for (std::size_t k = 0; k < this->LoopVertices.size(); ++k)
  {
    const LoopVertex& vertex = this->LoopVertices[k];
    if (vertex.Point >= 0 && this->Patches[vertex.Patch].Touched)
    {
      this->EvaluateLoopVertex(std::int32_t(k));
      ++updated;
    }
  }
  return updated;
}

// Calls f(patch, part of the box in it) for the patches that a box overlaps.
template <typename F>
static void ForPatches(const FaceGrid& grid, const ParameterBox& box, const F& f)
{
  const int columns[2] = { grid.Axis[0].ColumnAt(box.U0), grid.Axis[0].ColumnAt(box.U1) };
  const int rows[2] = { grid.Axis[1].ColumnAt(box.V0), grid.Axis[1].ColumnAt(box.V1) };
  for (int row = rows[0]; row <= rows[1]; ++row)
  {
    for (int column = columns[0]; column <= columns[1]; ++column)
    {
      const int patch = grid.Patch(column, row);
      const ParameterBox all = grid.Box(patch);
      const ParameterBox part{ std::max(box.U0, all.U0), std::min(box.U1, all.U1),
        std::max(box.V0, all.V0), std::min(box.V1, all.V1) };
      // A side that only touches the next patch does not count.
      const double thin = NegligibleSpan;
      const bool touches = (columns[0] != columns[1] && part.A() <= thin * box.A()) ||
        (rows[0] != rows[1] && part.B() <= thin * box.B());
      if (!touches)
      {
        f(patch, part);
      }
    }
  }
}

SecondBound DeformingFace::Second(const ParameterBox& box)
{
  SecondBound out;
  ForPatches(this->Lines, box, [&](int patch, ParameterBox part) {
    // A piece of an iso-line has a box without width; bounds there are those of a strip.
    const ParameterBox all = this->Lines.Box(patch);
    const auto widen = [](double& low, double& high, double from, double to) {
      const double least = 1e-6 * (to - from);
      if (high - low < least)
      {
        low = std::max(from, std::min(low, to - least));
        high = std::min(to, low + least);
      }
    };
    widen(part.U0, part.U1, all.U0, all.U1);
    widen(part.V0, part.V1, all.V0, all.V1);
    out.Extend(this->NetOf(patch).Second(part));
  });
  return out;
}

Vec2 DeformingFace::First(const ParameterBox& box)
{
  Vec2 out = Vec2::Zero();
  ForPatches(this->Lines, box,
    [&](int patch, const ParameterBox&) { out = out.cwiseMax(this->NetOf(patch).First()); });
  return out;
}

void DeformingFace::Renumber(const std::vector<std::int32_t>& places)
{
  const auto move = [&](std::int32_t& point) { point = point >= 0 ? places[point] : -1; };
  for (Patch& patch : this->Patches)
  {
    std::for_each(patch.Vertices.Points.begin(), patch.Vertices.Points.end(), move);
    patch.PointAt.ForEach(move);
  }
  for (LoopVertex& vertex : this->LoopVertices)
  {
    move(vertex.Point);
  }
  for (std::vector<SideSegment>& side : this->Sides)
  {
    for (SideSegment& segment : side)
    {
      move(segment.A);
      move(segment.B);
    }
  }
  for (std::int32_t cell = 0; cell < this->Forest.Size(); ++cell)
  {
    if (this->Forest[cell].Built)
    {
      std::for_each(this->Forest[cell].Corners, this->Forest[cell].Corners + 4, move);
    }
  }
  for (ZoneTriangle& triangle : this->Zones)
  {
    std::for_each(triangle.Points.begin(), triangle.Points.end(), move);
  }
}

} // namespace nurbs
