// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceTable.h"

#include "SurfaceBound.h"

#include <algorithm>
#include <limits>

namespace nurbs
{

namespace
{

constexpr std::size_t MaxSpans = 65535;
constexpr std::size_t MaxTexels = std::numeric_limits<int>::max();

// The box of the control points that act on a patch, relative to the surface's origin.
Eigen::AlignedBox3f ControlBox(const SurfaceView& view, int i, int j, const Vec3& origin)
{
  Eigen::AlignedBox3f box;
  for (int b = 0; b <= view.Degree[1]; ++b)
  {
    for (int a = 0; a <= view.Degree[0]; ++a)
    {
      const std::int64_t k = i + a + std::int64_t(j + b) * view.Count[0];
      box.extend((view.Point(k) - origin).cast<float>());
    }
  }
  return box;
}

// True if the two borders across a direction are one curve, over which the surface is smooth.
bool IsSmoothSeam(const SurfaceView& view, int dir, double size)
{
  constexpr int Samples = 8;
  constexpr double Tolerance = 1e-9;
  const Interval across = view.Domain(dir), along = view.Domain(1 - dir);
  for (int k = 0; k <= Samples; ++k)
  {
    const double s = along.Min + along.Length() * k / Samples;
    SurfaceDerivatives side[2];
    for (int end = 0; end < 2; ++end)
    {
      const double t = end == 0 ? across.Min : across.Max;
      side[end] = EvaluateDerivatives(view, dir == 0 ? t : s, dir == 0 ? s : t, 1);
    }
    const Vec3& before = dir == 0 ? side[1].Su : side[1].Sv;
    const Vec3& after = dir == 0 ? side[0].Su : side[0].Sv;
    if ((side[0].S - side[1].S).norm() > Tolerance * size ||
      (before - after).norm() > 1e-6 * (before.norm() + after.norm()))
    {
      return false;
    }
  }
  return true;
}

// Parameters that cut the spans of a rational surface, whose bounds are tight over short pieces only.
std::vector<double> LinesWithin(
  const SurfaceView& view, const std::vector<Interval>& spans, int dir)
{
  constexpr int Pieces = 4;
  std::vector<double> lines;
  const Interval domain = view.Domain(dir);
  for (const Interval& span : spans)
  {
    for (int k = 1; k < Pieces && view.IsRational(); ++k)
    {
      lines.push_back(domain.Min + (span.Min + k * span.Length() / Pieces) * domain.Length());
    }
  }
  return lines;
}

} // namespace

int SurfaceTable::Add(const SurfaceView& view, const Box2& used)
{
  const std::size_t texels = static_cast<std::size_t>(view.Size());
  if (this->Points.size() / 4 + texels > MaxTexels)
  {
    throw Error("more than 2^31 - 1 control points");
  }
  TableSurface surface;
  surface.View = view;
  surface.FirstPoint = static_cast<int>(this->Points.size() / 4);
  for (int dir = 0; dir < 2; ++dir)
  {
    this->AddSpans(surface, dir);
  }
  FindUsed(surface, used);
  this->Points.resize(this->Points.size() + 4 * texels);
  this->Surfaces.push_back(std::move(surface));
  return this->Size() - 1;
}

int SurfaceTable::AddNothing()
{
  this->Surfaces.emplace_back();
  return this->Size() - 1;
}

void SurfaceTable::AddSpans(TableSurface& surface, int dir)
{
  const SurfaceView& view = surface.View;
  const KnotView& knots = view.Knots[dir];
  const int degree = view.Degree[dir];
  const Interval domain = view.Domain(dir);
  surface.FirstBlock[dir] = static_cast<int>(this->Knots.size());
  std::vector<Interval>& spans = surface.Spans[dir];
  for (int k = degree; k < view.Count[dir]; ++k)
  {
    const double length = knots[k + 1] - knots[k];
    if (!(length > 0.0))
    {
      continue;
    }
    const Interval share = { (knots[k] - domain.Min) / domain.Length(),
      (knots[k + 1] - domain.Min) / domain.Length() };
    spans.push_back(share);
    this->Knots.push_back(static_cast<float>(share.Min));
    this->Knots.push_back(static_cast<float>(share.Length()));
    this->Knots.push_back(static_cast<float>(k - degree));
    this->Knots.push_back(0.0f); // see FillSides
    for (int m = 0; m < 2 * degree; ++m)
    {
      this->Knots.push_back(static_cast<float>((knots[k - degree + 1 + m] - knots[k]) / length));
    }
  }
  if (spans.size() > MaxSpans || this->Knots.size() > MaxTexels)
  {
    throw Error("more than 65535 knot spans in a direction");
  }
}

// Returns whether it is other than before.
bool SurfaceTable::FindUsed(TableSurface& surface, const Box2& used)
{
  bool changed = used.min() != surface.Left.min() || used.max() != surface.Left.max();
  surface.Left = used;
  for (int dir = 0; dir < 2; ++dir)
  {
    const std::vector<Interval>& spans = surface.Spans[dir];
    int first = 0, end = static_cast<int>(spans.size());
    while (first < end && !(spans[first].Max > used.min()[dir]))
    {
      ++first;
    }
    while (end > first && !(spans[end - 1].Min < used.max()[dir]))
    {
      --end;
    }
    changed = changed || first != surface.Used[dir][0] || end != surface.Used[dir][1];
    surface.Used[dir][0] = first;
    surface.Used[dir][1] = end;
  }
  return changed;
}

void SurfaceTable::Use(int index, const Box2& used)
{
  TableSurface& surface = this->Surfaces[index];
  if (surface.IsDrawable() && FindUsed(surface, used))
  {
    this->FillBounds(surface);
  }
}

void SurfaceTable::Fill(int first, int last)
{
  for (int i = first; i < last; ++i)
  {
    TableSurface& surface = this->Surfaces[i];
    if (surface.IsDrawable())
    {
      this->FillPoints(surface);
      this->FillBounds(surface);
    }
  }
}

bool SurfaceTable::Move(int index, const SurfaceView& view)
{
  TableSurface& surface = this->Surfaces[index];
  surface.View = view;
  const bool moved = this->FillPoints(surface);
  if (moved)
  {
    this->FillBounds(surface);
  }
  return moved;
}

// Returns whether a point changed. The origin stays where it is as long as it is near enough, so that
// points which don't move keep their bits.
bool SurfaceTable::FillPoints(TableSurface& surface)
{
  const SurfaceView& view = surface.View;
  Box3 box;
  for (std::int64_t k = 0; k < view.Size(); ++k)
  {
    box.extend(view.Point(k));
  }
  if ((box.center() - surface.Origin).norm() > surface.Radius)
  {
    surface.Origin = box.center();
  }
  surface.Radius = 0.5 * box.diagonal().norm();
  bool changed = false;
  float* texel = this->Points.data() + 4 * std::size_t(surface.FirstPoint);
  for (std::int64_t k = 0; k < view.Size(); ++k, texel += 4)
  {
    const double w = view.Weight(k);
    Eigen::Vector4f h;
    h << (w * (view.Point(k) - surface.Origin)).cast<float>(), static_cast<float>(w);
    Eigen::Map<Eigen::Vector4f> stored(texel);
    changed = changed || h != stored;
    stored = h;
  }
  return changed;
}

void SurfaceTable::FillBounds(TableSurface& surface)
{
  const SurfaceView& view = surface.View;
  const int count[2] = { int(surface.Spans[0].size()), int(surface.Spans[1].size()) };
  surface.Patches.resize(std::size_t(count[0]) * count[1]);
  const Interval u = view.Domain(0), v = view.Domain(1);
  SurfaceBound bound(view, { u.Min, u.Max, v.Min, v.Max });
  std::vector<double> lines[2];
  for (int dir = 0; dir < 2; ++dir)
  {
    lines[dir] = LinesWithin(view, surface.Spans[dir], dir);
  }
  bound.MakeGrid(lines[0], lines[1], SerialFor);
  this->FillSides(surface, bound);
  surface.Bounds.setEmpty();
  for (int j = surface.Used[1][0]; j < surface.Used[1][1]; ++j)
  {
    const Interval sv = surface.Spans[1][j];
    const int rowV = int(this->Knots[surface.FirstBlock[1] + j * surface.BlockSize(1) + 2]);
    for (int i = surface.Used[0][0]; i < surface.Used[0][1]; ++i)
    {
      const Interval su = surface.Spans[0][i];
      const int rowU = int(this->Knots[surface.FirstBlock[0] + i * surface.BlockSize(0) + 2]);
      const ParameterBox box = { u.Min + su.Min * u.Length(), u.Min + su.Max * u.Length(),
        v.Min + sv.Min * v.Length(), v.Min + sv.Max * v.Length() };
      const SecondDerivatives second = bound.Over(box);
      PatchBound& patch = surface.Patches[i + std::size_t(j) * count[0]];
      patch.Box = ControlBox(view, rowU, rowV, surface.Origin);
      patch.Second = { float(second.Greatest(0) * box.A() * box.A()),
        float(second.Greatest(1) * box.A() * box.B()),
        float(second.Greatest(2) * box.B() * box.B()) };
      surface.Bounds.extend(patch.Box.min().cast<double>() + surface.Origin);
      surface.Bounds.extend(patch.Box.max().cast<double>() + surface.Origin);
    }
  }
  TightenBounds(surface);
}

// Control points of whole patches can lie far from the part of them that trims leave over; those of
// that part alone don't.
void SurfaceTable::TightenBounds(TableSurface& surface)
{
  const SurfaceView& view = surface.View;
  Interval part[2];
  bool isSmaller = false;
  for (int dir = 0; dir < 2; ++dir)
  {
    const Interval domain = view.Domain(dir);
    const int* used = surface.Used[dir];
    if (used[0] >= used[1])
    {
      return;
    }
    const Interval spans = { surface.Spans[dir][used[0]].Min, surface.Spans[dir][used[1] - 1].Max };
    const Interval left = { std::max(surface.Left.min()[dir], spans.Min),
      std::min(surface.Left.max()[dir], spans.Max) };
    isSmaller = isSmaller || left.Length() < 0.95 * spans.Length();
    if (!(left.Length() > 1e-9))
    {
      return;
    }
    part[dir] = { domain.Clamp(domain.Min + left.Min * domain.Length()),
      domain.Clamp(domain.Min + left.Max * domain.Length()) };
  }
  if (isSmaller)
  {
    Box3 box;
    for (const Vec3& point : Restrict(view, part[0], part[1]).Points)
    {
      box.extend(point);
    }
    surface.Bounds = surface.Bounds.intersection(box);
  }
}

// Which sides of the spans are open: the surface ends there, or has a crease.
void SurfaceTable::FillSides(TableSurface& surface, const SurfaceBound& bound)
{
  const SurfaceView& view = surface.View;
  surface.SidesChanged = false;
  for (int dir = 0; dir < 2; ++dir)
  {
    const bool closed = IsSmoothSeam(view, dir, 2.0 * surface.Radius);
    const Interval domain = view.Domain(dir);
    const std::vector<Interval>& spans = surface.Spans[dir];
    const auto isOpen = [&](double share) {
      return share <= 0.0 || share >= 1.0
        ? !closed
        : bound.IsCrease(dir, domain.Min + share * domain.Length());
    };
    for (std::size_t k = 0; k < spans.size(); ++k)
    {
      float& sides = this->Knots[surface.FirstBlock[dir] + k * surface.BlockSize(dir) + 3];
      const float now = (isOpen(spans[k].Min) ? 1.0f : 0.0f) + (isOpen(spans[k].Max) ? 2.0f : 0.0f);
      surface.SidesChanged = surface.SidesChanged || sides != now;
      sides = now;
    }
  }
}

} // namespace nurbs
