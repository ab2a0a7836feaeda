// SPDX-License-Identifier: BSD-3-Clause
#include "FaceContour.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace nurbs
{

namespace
{

constexpr int LineSamples = 5;
constexpr int MaxChordDepth = 30;
// Sine of the angle between the normals of both sides of a knot line that counts as smooth.
constexpr double SmoothSine = 1e-9;
// Size of a pole, of the patch.
constexpr double PoleSize = 1e-12;

// All patches of a surface that meet the region.
class SurfaceTracer
{
public:
  SurfaceTracer(const SurfaceView& surface, const Box2& region, const Viewer& viewer,
    const ContourLimits& limits)
    : View(viewer)
    , Limits(limits)
    , Patches(ToBezier(surface))
    , Contours(this->Patches.size())
  {
    const double low = this->Patches.front().V.Min;
    for (this->Columns = 0;
         this->Columns < int(this->Patches.size()) && this->Patches[this->Columns].V.Min == low;)
    {
      ++this->Columns;
    }
    for (std::size_t k = 0; k < this->Patches.size(); ++k)
    {
      const BezierPatch& patch = this->Patches[k];
      const Box2 box(Vec2(patch.U.Min, patch.V.Min), Vec2(patch.U.Max, patch.V.Max));
      if (region.intersects(box))
      {
        this->Contours[k].Patch = &patch;
      }
    }
  }

  SurfaceContours Run(bool reversed);

private:
  void MakeForm(PatchContour& patch);
  bool IsPole(const BezierPatch& patch, int dir, int end) const;
  bool IsZeroSide(const PatchContour& patch, int dir, int end) const;
  void Factor(PatchContour& patch);
  bool IsSmooth(const BezierPatch& low, const BezierPatch& high, int dir) const;
  PatchContour* Neighbour(std::size_t k, int dir, int end);
  void JoinSides();
  void TraceSides(int dir, PatchContour* low, PatchContour* high);
  void AddSideArc(int dir, PatchContour* low, PatchContour* high, double from, double to);
  int SideNode(int dir, PatchContour* low, PatchContour* high, double at);
  void Collect(SurfaceContours& out) const;
  SurfaceContour Follow(
    std::size_t first, const std::vector<int>& next, std::vector<char>& used) const;

  const Viewer& View;
  const ContourLimits& Limits;
  std::vector<BezierPatch> Patches;
  std::vector<PatchContour> Contours; ///< Without a patch: not in the region.
  int Columns = 0;
  std::vector<ContourPoint> Nodes;
  std::vector<ContourArc> Arcs;
  std::map<std::array<double, 2>, int> Corners; ///< Nodes at corners of patches.
};

bool SurfaceTracer::IsPole(const BezierPatch& patch, int dir, int end) const
{
  Box3 side, all;
  const int width = patch.Degree[0] + 1;
  for (std::size_t k = 0; k < patch.Points.size(); ++k)
  {
    const Vec3 p = patch.Points[k].head<3>() / patch.Points[k][3];
    all.extend(p);
    const int index = dir == 0 ? int(k) % width : int(k) / width;
    if (index == end * patch.Degree[dir])
    {
      side.extend(p);
    }
  }
  return side.diagonal().norm() <= PoleSize * all.diagonal().norm();
}

double LargestOf(const std::vector<double>& c)
{
  double largest = 0.0;
  for (const double x : c)
  {
    largest = std::max(largest, std::abs(x));
  }
  return largest;
}

// True if g has one sign along a side, beyond its rounding.
bool IsOneSided(const PatchContour& patch, int dir, int end)
{
  if (patch.EdgeOn || patch.IsPole[dir][end] || patch.IsZero[dir][end])
  {
    return false;
  }
  const std::vector<double> c = patch.G.OnLine(dir, end);
  const auto ends = std::minmax_element(c.begin(), c.end());
  return *ends.first > patch.Rounding || *ends.second < -patch.Rounding;
}

// True if g vanishes along a side that is no pole.
bool SurfaceTracer::IsZeroSide(const PatchContour& patch, int dir, int end) const
{
  if (LargestOf(patch.G.OnLine(dir, end)) > 10.0 * ContourZero * patch.Scale)
  {
    return false;
  }
  for (int k = 0; k < LineSamples; ++k)
  {
    const double t = (k + 0.5) / LineSamples;
    const ContourValue value =
      EvaluateContour(*patch.Patch, this->View, dir == 0 ? end : t, dir == 0 ? t : end);
    if (std::abs(value.Cosine) > ContourCosine)
    {
      return false;
    }
  }
  return true;
}

void SurfaceTracer::MakeForm(PatchContour& patch)
{
  ContourForm form = MakeContourForm(*patch.Patch, this->View);
  patch.G = std::move(form.G);
  patch.Scale = form.Scale;
  patch.Rounding = form.Rounding;
  patch.EdgeOn = !(patch.G.Magnitude() > ContourZero * patch.Scale);
  for (int side = 0; side < 4 && !patch.EdgeOn; ++side)
  {
    const int dir = side / 2;
    const int end = side % 2;
    patch.IsPole[dir][end] = this->IsPole(*patch.Patch, dir, end);
    patch.IsZero[dir][end] = !patch.IsPole[dir][end] && this->IsZeroSide(patch, dir, end);
  }
}

// Divides g by what vanishes along sides; the scale follows, so that it stays one of g's size.
void SurfaceTracer::Factor(PatchContour& patch)
{
  for (int side = 0; side < 4; ++side)
  {
    const int dir = side / 2;
    const int end = side % 2;
    bool first = true;
    while ((patch.IsPole[dir][end] || patch.IsZero[dir][end]) && patch.G.Degree[dir] > 0 &&
      (LargestOf(patch.G.OnLine(dir, end)) <= 10.0 * ContourZero * patch.Scale ||
        (first && patch.IsZero[dir][end])))
    {
      patch.G.DivideBySide(dir, end);
      first = false;
    }
  }
}

// True if the two sides' normals agree along a knot line, in direction `dir`.
bool SurfaceTracer::IsSmooth(const BezierPatch& low, const BezierPatch& high, int dir) const
{
  const auto normal = [&](const BezierPatch& patch, double at, double t) {
    return PatchNormal(patch, dir == 0 ? at : t, dir == 0 ? t : at);
  };
  for (int k = 0; k < LineSamples; ++k)
  {
    const double t = (k + 0.5) / LineSamples;
    const Vec3 a = normal(low, 1.0, t);
    const Vec3 b = normal(high, 0.0, t);
    if (a.dot(b) < 0.0 || a.cross(b).norm() > SmoothSine)
    {
      return false;
    }
  }
  return true;
}

PatchContour* SurfaceTracer::Neighbour(std::size_t k, int dir, int end)
{
  const int column = int(k) % this->Columns;
  const std::int64_t row = std::int64_t(k) / this->Columns;
  const std::int64_t rows = std::int64_t(this->Patches.size()) / this->Columns;
  const std::int64_t place = (dir == 0 ? column : row) + (end == 0 ? -1 : 1);
  if (place < 0 || place >= (dir == 0 ? std::int64_t(this->Columns) : rows))
  {
    return nullptr;
  }
  PatchContour& other =
    this->Contours[dir == 0 ? row * this->Columns + place : place * this->Columns + column];
  return other.Patch ? &other : nullptr;
}

// Lets patches share the crossings of smooth knot lines, and traces what runs along the others.
void SurfaceTracer::JoinSides()
{
  for (std::size_t k = 0; k < this->Contours.size(); ++k)
  {
    PatchContour& patch = this->Contours[k];
    if (!patch.Patch)
    {
      continue;
    }
    for (int dir = 0; dir < 2; ++dir)
    {
      PatchContour* const next = this->Neighbour(k, dir, 1);
      if (!this->Neighbour(k, dir, 0))
      {
        this->TraceSides(dir, nullptr, &patch);
      }
      if (next && IsOneSided(patch, dir, 1) && IsOneSided(*next, dir, 0) &&
        patch.G.At(patch.G.Degree[0], patch.G.Degree[1]) * next->G.At(0, 0) > 0.0)
      {
        continue; // Both face the same way along all of the line.
      }
      const bool clean =
        next && !patch.EdgeOn && !next->EdgeOn && !patch.IsZero[dir][1] && !next->IsZero[dir][0];
      if (clean && this->IsSmooth(*patch.Patch, *next->Patch, dir))
      {
        SideLine(patch, dir, 1);
        next->Sides[dir][0] = patch.Sides[dir][1];
      }
      else
      {
        this->TraceSides(dir, &patch, next);
      }
    }
  }
}

int SurfaceTracer::SideNode(int dir, PatchContour* low, PatchContour* high, double at)
{
  PatchContour* const owners[2] = { low, high };
  for (int side = 0; side < 2; ++side)
  {
    if (owners[side] && !owners[side]->EdgeOn)
    {
      ContourLine& line = SideLine(*owners[side], dir, 1 - side);
      const auto found = std::find(line.At.begin(), line.At.end(), at);
      if (found != line.At.end())
      {
        return LineNode(*owners[side], this->View, line, dir, 1.0 - side,
          std::size_t(found - line.At.begin()), this->Nodes);
      }
    }
  }
  const BezierPatch& patch = *(low ? low : high)->Patch;
  const double across = low ? 1.0 : 0.0;
  const Vec2 st(dir == 0 ? across : at, dir == 0 ? at : across);
  const Vec2 uv(st[0] == 1.0
      ? patch.U.Max
      : (st[0] == 0.0 ? patch.U.Min : patch.U.Min + st[0] * patch.U.Length()),
    st[1] == 1.0 ? patch.V.Max
                 : (st[1] == 0.0 ? patch.V.Min : patch.V.Min + st[1] * patch.V.Length()));
  const auto corner = this->Corners.find({ { uv[0], uv[1] } });
  if (corner != this->Corners.end())
  {
    return corner->second;
  }
  this->Corners[{ { uv[0], uv[1] } }] = int(this->Nodes.size());
  const ContourValue value = EvaluateContour(patch, this->View, st[0], st[1]);
  this->Nodes.push_back({ uv, value.Point, value.Cosine });
  return int(this->Nodes.size()) - 1;
}

// Adds the part [from, to] of the line between two patches if one faces the viewer and the other
// does not. The front is on the left.
void SurfaceTracer::AddSideArc(
  int dir, PatchContour* low, PatchContour* high, double from, double to)
{
  const double middle = 0.5 * (from + to);
  const auto sign = [&](const PatchContour* patch, int end) {
    if (!patch || patch->EdgeOn)
    {
      return 0;
    }
    const double g = EvaluateBernstein(patch->G.OnLine(dir, end), middle);
    return std::abs(g) <= ContourZero * patch->Scale ? 0 : (g > 0.0 ? 1 : -1);
  };
  const int below = sign(low, 1);
  const int above = sign(high, 0);
  if (below == above)
  {
    return;
  }
  const bool forward = dir == 0 ? below > above : above > below;
  const BezierPatch& patch = *(low ? low : high)->Patch;
  const double across = low ? 1.0 : 0.0;
  ContourArc arc;
  arc.Kind = low && high ? ContourArcKind::Crease : ContourArcKind::Border;
  arc.Start = this->SideNode(dir, low, high, from);
  arc.End = this->SideNode(dir, low, high, to);
  const auto at = [&](double t) {
    const Vec2 st(dir == 0 ? across : t, dir == 0 ? t : across);
    ContourPoint point;
    point.UV = Vec2(patch.U.Min + st[0] * patch.U.Length(), patch.V.Min + st[1] * patch.V.Length());
    point.UV[dir] =
      dir == 0 ? (low ? patch.U.Max : patch.U.Min) : (low ? patch.V.Max : patch.V.Min);
    const ContourValue value = EvaluateContour(patch, this->View, st[0], st[1]);
    point.Point = value.Point;
    point.Cosine = value.Cosine;
    return point;
  };
  RefineChord(at, this->Limits.Precision, from, this->Nodes[arc.Start], to, this->Nodes[arc.End],
    MaxChordDepth, arc.Inner);
  if (!forward)
  {
    std::swap(arc.Start, arc.End);
    std::reverse(arc.Inner.begin(), arc.Inner.end());
  }
  this->Arcs.push_back(std::move(arc));
}

// What of the contour runs along a line between two patches, or (one of them null) a border.
void SurfaceTracer::TraceSides(int dir, PatchContour* low, PatchContour* high)
{
  const auto isPole = [&](PatchContour* patch, int end) {
    return patch && this->IsPole(*patch->Patch, dir, end);
  };
  const bool border = !low || !high;
  const PatchContour& any = low ? *low : *high;
  if (isPole(low, 1) || isPole(high, 0) || (border && !any.IsZero[dir][low ? 1 : 0]))
  {
    return;
  }
  std::vector<double> breaks{ 0.0, 1.0 };
  for (int side = 0; side < 2; ++side)
  {
    PatchContour* const patch = side == 0 ? low : high;
    if (patch && !patch->EdgeOn)
    {
      ContourLine& line = SideLine(*patch, dir, 1 - side);
      for (std::size_t k = 0; k < line.At.size(); ++k)
      {
        LineNode(*patch, this->View, line, dir, 1.0 - side, k, this->Nodes);
        breaks.push_back(line.At[k]);
      }
    }
  }
  std::sort(breaks.begin(), breaks.end());
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k)
  {
    if (breaks[k] < breaks[k + 1])
    {
      this->AddSideArc(dir, low, high, breaks[k], breaks[k + 1]);
    }
  }
}

// The polyline that arc `first` is in; next[arc]: the arc after it, or -1.
SurfaceContour SurfaceTracer::Follow(
  std::size_t first, const std::vector<int>& next, std::vector<char>& used) const
{
  SurfaceContour out;
  out.Kind = this->Arcs[first].Kind;
  out.Points.push_back(this->Nodes[this->Arcs[first].Start]);
  for (int k = int(first); k >= 0; k = next[k])
  {
    if (used[k])
    {
      out.Closed = true;
      out.Points.pop_back();
      break;
    }
    used[k] = 1;
    const ContourArc& arc = this->Arcs[k];
    out.Points.insert(out.Points.end(), arc.Inner.begin(), arc.Inner.end());
    out.Points.push_back(this->Nodes[arc.End]);
  }
  return out;
}

// Arcs of the same kind that meet in nodes become polylines.
void SurfaceTracer::Collect(SurfaceContours& out) const
{
  std::vector<std::vector<int>> starts(this->Nodes.size());
  for (std::size_t k = 0; k < this->Arcs.size(); ++k)
  {
    starts[this->Arcs[k].Start].push_back(int(k));
  }
  std::vector<int> next(this->Arcs.size(), -1);
  std::vector<char> hasBefore(this->Arcs.size(), 0);
  for (std::size_t k = 0; k < this->Arcs.size(); ++k)
  {
    for (const int other : starts[this->Arcs[k].End])
    {
      if (!hasBefore[other] && this->Arcs[other].Kind == this->Arcs[k].Kind)
      {
        next[k] = other;
        hasBefore[other] = 1;
        break;
      }
    }
  }
  std::vector<char> used(this->Arcs.size(), 0);
  for (const bool closed : { false, true })
  {
    for (std::size_t k = 0; k < this->Arcs.size(); ++k)
    {
      if (!used[k] && (closed || !hasBefore[k]))
      {
        out.Contours.push_back(this->Follow(k, next, used));
      }
    }
  }
}

SurfaceContours SurfaceTracer::Run(bool reversed)
{
  SurfaceContours out;
  for (PatchContour& patch : this->Contours)
  {
    if (patch.Patch)
    {
      this->MakeForm(patch);
      this->Factor(patch);
    }
  }
  this->JoinSides();
  for (PatchContour& patch : this->Contours)
  {
    if (!patch.Patch)
    {
      continue;
    }
    if (!patch.EdgeOn)
    {
      TracePatch(patch, this->View, this->Limits, this->Nodes, this->Arcs);
    }
    const bool front = reversed ? patch.HasBack : patch.HasFront;
    const bool back = reversed ? patch.HasFront : patch.HasBack;
    const PatchVisibility type = front
      ? (back ? PatchVisibility::Partial : PatchVisibility::Visible)
      : (back ? PatchVisibility::Invisible : PatchVisibility::EdgeOn);
    ++out.Patches[static_cast<int>(type)];
    out.SingularCells += patch.SingularCells;
    out.UnresolvedCells += patch.UnresolvedCells;
    out.Singular.insert(out.Singular.end(), patch.Singular.begin(), patch.Singular.end());
  }
  this->Collect(out);
  return out;
}

} // namespace

SurfaceContours TraceSurface(const SurfaceView& surface, bool reversed, const Box2& region,
  const Viewer& viewer, const ContourLimits& limits)
{
  return SurfaceTracer(surface, region, viewer, limits).Run(reversed);
}

} // namespace nurbs
