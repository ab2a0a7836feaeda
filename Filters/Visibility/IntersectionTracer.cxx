// SPDX-License-Identifier: BSD-3-Clause
#include "IntersectionTracer.h"

#include "PatchContour.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

constexpr int MaxSteps = 20000;
// Steps, as shares of the smaller surface.
constexpr double LongestShare = 1.0 / 12.0;
constexpr double FirstShare = 0.25; // Of the longest.
constexpr double ShortestShare = 1e-7;
// Cosine of the angle that tangents may turn by in a step; and the one up to which the next is
// longer.
constexpr double LargestTurn = 0.98;
constexpr double SmallTurn = 0.995;
// Farther from the predicted point than this, as a share of the step, it may be another curve.
constexpr double LargestAside = 0.25;
// How far beyond a box curves go, as a share of it.
constexpr double BeyondShare = 1e-6;
constexpr int MaxRefinement = 12;
// Points of the curve that are as near, as a share of the longest step, are the same.
constexpr double SamePoint = 1e-5;

double SizeOf(SurfacePair& pair, int side)
{
  Box3 box;
  const Box2& uv = pair.Box(side);
  for (int k = 0; k < 25; ++k)
  {
    const Vec2 at = uv.min() + Vec2(k % 5 / 4.0, k / 5 / 4.0).cwiseProduct(uv.sizes());
    box.extend(pair.Evaluator(side).Point(at[0], at[1]));
  }
  return box.diagonal().norm();
}

// Where q lies on the way from a to b, as a share; negative: not near to it. As near as a chord's
// bulge may be.
double ShareOnChord(
  const IntersectionPoint& a, const IntersectionPoint& b, const IntersectionPoint& q)
{
  const Vec3 way = b.Point - a.Point;
  const double length = way.squaredNorm();
  if (!(length > 0.0) ||
    DistanceToSegment(q.Point, a.Point, b.Point) > LargestAside * std::sqrt(length))
  {
    return -1.0;
  }
  const double t = std::clamp(way.dot(q.Point - a.Point) / length, 0.0, 1.0);
  for (int side = 0; side < 2; ++side)
  {
    const Vec2 chord = b.UV[side] - a.UV[side];
    if ((q.UV[side] - (a.UV[side] + t * chord)).norm() > 2.0 * LargestAside * chord.norm())
    {
      return -1.0;
    }
  }
  return t;
}

} // namespace

IntersectionTracer::IntersectionTracer(SurfacePair& pair)
  : Pair(pair)
  , LongestStep(LongestShare * std::min(SizeOf(pair, 0), SizeOf(pair, 1)))
  , ShortestStep(ShortestShare * this->LongestStep)
{}

bool IntersectionTracer::Step(const IntersectionPoint& from, const CrossingFrame& frame,
  double sign, double length, IntersectionPoint& to, CrossingFrame& toFrame)
{
  const Vec3 way = sign * frame.Tangent;
  const Vec3 place = from.Point + length * way;
  for (int side = 0; side < 2; ++side)
  {
    to.UV[side] = from.UV[side] + sign * length * frame.AlongUV[side];
  }
  if (!this->Pair.MoveToPlane(place, way, to) || (to.Point - place).norm() > LargestAside * length)
  {
    return false;
  }
  toFrame = this->Pair.Frame(to);
  return toFrame.Sine >= LeastSine && frame.Tangent.dot(toFrame.Tangent) >= LargestTurn;
}

// Adds the point where the curve leaves a box within a step, and one beyond. False: it does not.
bool IntersectionTracer::Leave(const IntersectionPoint& from, const CrossingFrame& frame,
  double sign, double length, std::vector<IntersectionPoint>& out)
{
  double nearest = 1.1 * length;
  IntersectionPoint exit;
  for (int side = 0; side < 2; ++side)
  {
    const Box2& box = this->Pair.Box(side);
    for (int k = 0; k < 4; ++k)
    {
      const int dir = k / 2;
      const double value = k % 2 == 0 ? box.min()[dir] : box.max()[dir];
      const double outward = (k % 2 == 0 ? -sign : sign) * frame.AlongUV[side][dir];
      const auto curve = [&](double t, Vec2& uv, Vec2& along) {
        uv[dir] = value;
        uv[1 - dir] = t;
        along = Vec2(dir, 1 - dir);
      };
      // What the tangent says of the place is a guess only; a border that is behind is none.
      const double ahead = (value - from.UV[side][dir]) / (sign * frame.AlongUV[side][dir]);
      if (!(outward > 0.0) || !(ahead < 2.0 * length))
      {
        continue;
      }
      IntersectionPoint point = from;
      for (int s = 0; s < 2; ++s)
      {
        point.UV[s] += sign * std::max(ahead, 0.0) * frame.AlongUV[s];
      }
      double t = point.UV[side][1 - dir];
      if (!this->Pair.MoveAlongCurve(side, curve, t, point))
      {
        continue;
      }
      const Vec3 move = point.Point - from.Point;
      const double along = sign * frame.Tangent.dot(move);
      const double rounding = 1e-9 * this->LongestStep;
      if (along >= -rounding && along < nearest &&
        move.norm() <= 1.5 * std::abs(along) + rounding &&
        this->Pair.IsInBox(0, point.UV[0], BeyondShare) &&
        this->Pair.IsInBox(1, point.UV[1], BeyondShare))
      {
        nearest = along;
        exit = point;
      }
    }
  }
  if (!(nearest < 1.1 * length))
  {
    return false;
  }
  if (nearest > this->ShortestStep)
  {
    out.push_back(exit);
  }
  IntersectionPoint beyond = out.empty() ? from : out.back();
  const CrossingFrame last = this->Pair.Frame(beyond);
  const double step = BeyondShare * this->LongestStep / LongestShare;
  beyond.Point += sign * step * last.Tangent;
  beyond.UV[0] += sign * step * last.AlongUV[0];
  beyond.UV[1] += sign * step * last.AlongUV[1];
  out.push_back(beyond);
  return true;
}

bool IntersectionTracer::Follow(
  const IntersectionPoint& seed, double sign, std::vector<IntersectionPoint>& out, bool& beyond)
{
  IntersectionPoint from = seed;
  CrossingFrame frame = this->Pair.Frame(seed);
  double length = FirstShare * this->LongestStep;
  double travelled = 0.0;
  for (int k = 0; k < MaxSteps && length >= this->ShortestStep; ++k)
  {
    IntersectionPoint to;
    CrossingFrame toFrame;
    if (!this->Step(from, frame, sign, length, to, toFrame))
    {
      beyond = length < 1e-3 * this->LongestStep && this->Leave(from, frame, sign, length, out);
      if (beyond)
      {
        return false;
      }
      length *= 0.5;
      continue;
    }
    if (!this->Pair.IsInBox(0, to.UV[0], 0.0) || !this->Pair.IsInBox(1, to.UV[1], 0.0))
    {
      beyond = this->Leave(from, frame, sign, length, out);
      if (beyond)
      {
        return false;
      }
      length *= 0.5;
      continue;
    }
    if (travelled > 2.0 * length && this->IsOnWay(from, to, seed))
    {
      out.push_back(seed);
      return true;
    }
    out.push_back(to);
    travelled += length;
    length = std::min(
      this->LongestStep, frame.Tangent.dot(toFrame.Tangent) >= SmallTurn ? 1.5 * length : length);
    from = to;
    frame = toFrame;
  }
  return false;
}

TracedIntersection IntersectionTracer::Trace(const IntersectionPoint& seed)
{
  TracedIntersection out;
  if (this->Pair.Frame(seed).Sine < LeastSine)
  {
    return out;
  }
  out.Points.push_back(seed);
  std::vector<IntersectionPoint> forward;
  out.Closed = this->Follow(seed, 1.0, forward, out.Beyond[1]);
  if (!out.Closed)
  {
    std::vector<IntersectionPoint> backward;
    this->Follow(seed, -1.0, backward, out.Beyond[0]);
    out.Points.insert(out.Points.begin(), backward.rbegin(), backward.rend());
  }
  out.Points.insert(out.Points.end(), forward.begin(), forward.end());
  return out;
}

IntersectionPoint IntersectionTracer::Between(
  const IntersectionPoint& a, const IntersectionPoint& b, double share)
{
  IntersectionPoint out;
  out.Point = a.Point + share * (b.Point - a.Point);
  for (int side = 0; side < 2; ++side)
  {
    out.UV[side] = a.UV[side] + share * (b.UV[side] - a.UV[side]);
  }
  IntersectionPoint moved = out;
  const Vec3 chord = b.Point - a.Point;
  const bool isMoved = this->Pair.MoveToPlane(out.Point, chord.normalized(), moved) &&
    (moved.Point - out.Point).norm() <= chord.norm();
  return isMoved ? moved : out;
}

void IntersectionTracer::Refine(TracedIntersection& curve, double precision)
{
  std::vector<IntersectionPoint> out;
  const std::size_t last = curve.Points.size() - 1;
  for (std::size_t k = 0; k < last; ++k)
  {
    const IntersectionPoint& a = curve.Points[k];
    const IntersectionPoint& b = curve.Points[k + 1];
    out.push_back(a);
    if ((k > 0 || !curve.Beyond[0]) && (k + 1 < last || !curve.Beyond[1]))
    {
      const auto at = [&](double t) { return this->Between(a, b, t); };
      RefineChord(at, precision, 0.0, a, 1.0, b, MaxRefinement, out);
    }
  }
  out.push_back(curve.Points.back());
  curve.Points = std::move(out);
}

bool IntersectionTracer::IsOnWay(
  const IntersectionPoint& a, const IntersectionPoint& b, const IntersectionPoint& q)
{
  const double t = ShareOnChord(a, b, q);
  return t >= 0.0 &&
    (this->Between(a, b, t).Point - q.Point).norm() <= SamePoint * this->LongestStep;
}

bool IntersectionTracer::Passes(const TracedIntersection& curve, const IntersectionPoint& point)
{
  for (std::size_t k = 0; k + 1 < curve.Points.size(); ++k)
  {
    if (this->IsOnWay(curve.Points[k], curve.Points[k + 1], point))
    {
      return true;
    }
  }
  return false;
}

} // namespace nurbs
