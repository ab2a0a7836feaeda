// SPDX-License-Identifier: BSD-3-Clause
#include "IntersectionSeeds.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

// Halvings after which parts are looked at for lying on each other again.
constexpr int CoincidenceDepth = 3;
// Where on a part that is looked at; and how many points beside the other surface it takes.
constexpr double SampleShares[3] = { 0.07, 0.46, 0.91 };
constexpr int LeastSamples = 4;
constexpr int ArcSamples = 5;
constexpr int MaxArcDepth = 60;
constexpr int MaxTouchingDepth = 14;
// Roots beyond the ends of parts by that share are their neighbours', too.
constexpr double EndShare = 1e-6;

double Between(const Interval& range, double share)
{
  return range.Min + share * range.Length();
}

bool IsWithin(const Interval& range, double t)
{
  const double margin = EndShare * range.Length();
  return t >= range.Min - margin && t <= range.Max + margin;
}

Vec2 MiddleOf(const IntersectionCell& cell)
{
  return Vec2(Between(cell.Patch.U, 0.5), Between(cell.Patch.V, 0.5));
}

} // namespace

SeedSearch::SeedSearch(
  SurfacePair& pair, const CoverTest& coverA, const CoverTest& coverB, const SeedLimits& limits)
  : Pair(pair)
  , Covers{ &coverA, &coverB }
  , Limits(limits)
{}

// False if a cell is trimmed away.
bool SeedSearch::IsLeft(int side, IntersectionCell& cell) const
{
  if (cell.Cover < 0)
  {
    const CoverTest& test = *this->Covers[side];
    const BezierPatch& patch = cell.Patch;
    const Box2 box(Vec2(test.Normalise(0, patch.U.Min), test.Normalise(1, patch.V.Min)),
      Vec2(test.Normalise(0, patch.U.Max), test.Normalise(1, patch.V.Max)));
    cell.Cover = test.Cover(box) != TrimCover::None;
  }
  return cell.Cover > 0;
}

// True if samples of `a`, which belongs to surface `side`, lie on the other surface.
bool SeedSearch::Coincide(const IntersectionCell& a, int side, const IntersectionCell& b)
{
  int on = 0;
  for (const double v : SampleShares)
  {
    for (const double u : SampleShares)
    {
      const Vec3 point =
        this->Pair.Evaluator(side).Point(Between(a.Patch.U, u), Between(a.Patch.V, v));
      const std::optional<bool> lies =
        this->Pair.LiesOnOther(side, point, MiddleOf(b), this->Limits.Tolerance);
      if (lies && !*lies)
      {
        return false;
      }
      on += lies.has_value();
    }
  }
  return on >= LeastSamples;
}

void SeedSearch::Search(IntersectionCell& a, IntersectionCell& b, int depth)
{
  if (!this->CountTest())
  {
    return;
  }
  const CellMeeting meeting = Meet(a, b, this->Limits.Tolerance);
  if (meeting == CellMeeting::Apart || !this->IsLeft(0, a) || !this->IsLeft(1, b))
  {
    return;
  }
  if (AreTransversal(a, b))
  {
    this->SearchSides(a, 0, b);
    this->SearchSides(b, 1, a);
    return;
  }
  const double sizes[2] = { a.LargestSize(), b.LargestSize() };
  // Parts that touch and are parallel after so many halvings are tangent to each other.
  const int deepest = meeting == CellMeeting::Touching
    ? std::min(MaxTouchingDepth, this->Limits.Depth)
    : this->Limits.Depth;
  if (std::max(sizes[0], sizes[1]) <= this->Limits.Smallest || depth >= deepest)
  {
    return;
  }
  if (depth % CoincidenceDepth == 0 && (this->Coincide(a, 0, b) || this->Coincide(b, 1, a)))
  {
    return;
  }
  if (sizes[0] >= sizes[1])
  {
    for (IntersectionCell& half : a.Split())
    {
      this->Search(half, b, depth + 1);
    }
  }
  else
  {
    for (IntersectionCell& half : b.Split())
    {
      this->Search(a, half, depth + 1);
    }
  }
}

// The sides of a cell of surface `side`.
void SeedSearch::SearchSides(const IntersectionCell& cell, int side, IntersectionCell& other)
{
  for (int dir = 0; dir < 2; ++dir)
  {
    const Interval& range = dir == 0 ? cell.Patch.U : cell.Patch.V;
    for (int end = 0; end < 2; ++end)
    {
      this->SearchArc(
        { side, dir, end == 0 ? range.Min : range.Max }, cell.Side(dir, end), other, 0);
    }
  }
}

// True if points of an arc lie on the other surface.
bool SeedSearch::LiesOn(
  const ArcSource& source, const IntersectionArc& arc, const IntersectionCell& cell)
{
  int on = 0;
  for (int k = 0; k < ArcSamples; ++k)
  {
    const std::optional<bool> lies = this->Pair.LiesOnOther(
      source.Side, arc.At((k + 0.53) / ArcSamples), MiddleOf(cell), this->Limits.Tolerance);
    if (lies && !*lies)
    {
      return false;
    }
    on += lies.has_value();
  }
  return on >= ArcSamples / 2;
}

// Finds where an arc that crosses a cell once at most does so. False: Newton's method fails.
bool SeedSearch::AddSeed(
  const ArcSource& source, const IntersectionArc& arc, const IntersectionCell& cell)
{
  const auto curve = [&](double t, Vec2& uv, Vec2& along) {
    uv[source.Dir] = source.Value;
    uv[1 - source.Dir] = t;
    along = Vec2(source.Dir, 1 - source.Dir);
  };
  IntersectionPoint point;
  double t = Between(arc.Range, 0.5);
  point.UV[1 - source.Side] = MiddleOf(cell);
  if (!this->Pair.MoveAlongCurve(source.Side, curve, t, point))
  {
    return false;
  }
  const Vec2& other = point.UV[1 - source.Side];
  if (IsWithin(arc.Range, t) && IsWithin(cell.Patch.U, other[0]) &&
    IsWithin(cell.Patch.V, other[1]))
  {
    this->Seeds.push_back(point);
  }
  return true;
}

void SeedSearch::SearchArc(
  const ArcSource& source, const IntersectionArc& arc, IntersectionCell& cell, int depth)
{
  if (!this->CountTest() || AreApart(arc, cell) || !this->IsLeft(1 - source.Side, cell))
  {
    return;
  }
  const double size = cell.LargestSize();
  const bool isSmall = std::max(arc.Size, size) <= this->Limits.Smallest || depth >= MaxArcDepth;
  if ((IsTransversal(arc, cell) && this->AddSeed(source, arc, cell)) || isSmall)
  {
    return;
  }
  if (depth % CoincidenceDepth == 0 && this->LiesOn(source, arc, cell))
  {
    return;
  }
  if (arc.Size >= size)
  {
    for (const IntersectionArc& half : arc.Halves())
    {
      this->SearchArc(source, half, cell, depth + 1);
    }
  }
  else
  {
    for (IntersectionCell& half : cell.Split())
    {
      this->SearchArc(source, arc, half, depth + 1);
    }
  }
}

} // namespace nurbs
