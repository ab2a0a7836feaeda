// SPDX-License-Identifier: BSD-3-Clause
#include "CurveLift.h"

#include "Basis.h"
#include "CurveFit.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace nurbs
{

namespace
{

constexpr double Straight = 1e-14; // of the domain: what a line along u or v may deviate

/// The corner and sides of a surface that is a parallelogram.
struct Parallelogram
{
  Vec3 Corner, Sides[2];
};

bool IsParallelogram(const SurfaceView& surface, Parallelogram& result)
{
  if (surface.Degree[0] != 1 || surface.Degree[1] != 1 || surface.Size() != 4 ||
    surface.Count[0] != 2 || surface.IsRational())
  {
    return false;
  }
  const Vec3 corner = surface.Point(0);
  const Vec3 along[2] = { surface.Point(1) - corner, surface.Point(2) - corner };
  const double size = along[0].norm() + along[1].norm() + corner.norm();
  if ((surface.Point(3) - corner - along[0] - along[1]).norm() > 1e-14 * size)
  {
    return false;
  }
  result.Corner = corner;
  for (int dir = 0; dir < 2; ++dir)
  {
    const Interval domain = surface.Domain(dir);
    result.Sides[dir] = along[dir] / domain.Length();
    result.Corner -= domain.Min * result.Sides[dir];
  }
  return true;
}

Curve<3> LiftToPlane(const CurveView<2>& trim, const Parallelogram& plane)
{
  Curve<3> curve;
  curve.Degree = trim.Degree;
  curve.Knots.assign(trim.Knots.begin(), trim.Knots.end());
  for (int i = 0; i < trim.Count; ++i)
  {
    const Vec2 p = trim.Point(i);
    curve.Points.emplace_back(plane.Corner + p[0] * plane.Sides[0] + p[1] * plane.Sides[1]);
    curve.Weights.push_back(trim.Weight(i));
  }
  curve.Pack();
  return curve;
}

/// The parameter direction that a straight trim curve keeps constant, or -1.
int ConstantDirection(const SurfaceView& surface, const CurveView<2>& trim)
{
  if (trim.Degree != 1 || trim.Count != 2 || trim.Weight(0) != trim.Weight(1) ||
    !IsClamped(trim.Knots, 1))
  {
    return -1;
  }
  const Vec2 a = trim.Point(0), b = trim.Point(1);
  for (int dir = 0; dir < 2; ++dir)
  {
    const Interval constant = surface.Domain(dir), other = surface.Domain(1 - dir);
    const double low = std::min(a[1 - dir], b[1 - dir]), high = std::max(a[1 - dir], b[1 - dir]);
    if (std::abs(a[dir] - b[dir]) <= Straight * constant.Length() && a[dir] >= constant.Min &&
      a[dir] <= constant.Max && low >= other.Min && high <= other.Max && low < high)
    {
      return dir;
    }
  }
  return -1;
}

/// The curve from parameter a to b (or backwards), reparametrised to the interval.
Curve<3> Segment(const Curve<3>& whole, double a, double b, const Interval& range)
{
  Curve<3> part = Restrict(whole.View(), std::min(a, b), std::max(a, b));
  const double first = part.Knots.front(), last = part.Knots.back();
  if (b < a)
  {
    std::reverse(part.Points.begin(), part.Points.end());
    std::reverse(part.Weights.begin(), part.Weights.end());
    std::reverse(part.Knots.begin(), part.Knots.end());
  }
  for (double& knot : part.Knots)
  {
    const double share = (b < a ? last - knot : knot - first) / (last - first);
    knot = share == 1.0 ? range.Max : range.Min + share * range.Length();
  }
  part.Pack();
  return part;
}

/// Parameters between neighbouring `breaks` where the trim curve crosses knots of the surface.
void AppendKnotCrossings(
  const SurfaceView& surface, const CurveView<2>& trim, std::vector<double>& breaks)
{
  constexpr int Steps = 8;
  const std::vector<double> old = breaks;
  for (int dir = 0; dir < 2; ++dir)
  {
    std::vector<double> knots;
    for (const Knot& knot : DistinctKnots(surface.Knots[dir], surface.Degree[dir]))
    {
      knots.push_back(knot.Value);
    }
    const auto inner = ArrayView<double>(knots.data() + 1, knots.size() - 2);
    double t0 = old.front(), f0 = Evaluate(trim, t0)[dir];
    for (std::size_t i = 0; i + 1 < old.size() && !inner.empty(); ++i)
    {
      for (int step = 1; step <= Steps; ++step)
      {
        const double t1 = old[i] + (old[i + 1] - old[i]) * step / Steps;
        const double f1 = Evaluate(trim, t1)[dir];
        for (auto knot = std::upper_bound(inner.begin(), inner.end(), std::min(f0, f1));
             knot != inner.end() && *knot < std::max(f0, f1); ++knot)
        {
          double a = t0, b = t1;
          for (int halving = 0; halving < 60 && a < b; ++halving)
          {
            const double m = 0.5 * (a + b);
            ((Evaluate(trim, m)[dir] < *knot) == (f0 < f1) ? a : b) = m;
          }
          breaks.push_back(0.5 * (a + b));
        }
        t0 = t1;
        f0 = f1;
      }
    }
  }
}

} // namespace

std::vector<double> LiftBreaks(const SurfaceView& surface, const CurveView<2>& trim)
{
  std::vector<double> breaks;
  for (const Knot& knot : DistinctKnots(trim.Knots, trim.Degree))
  {
    breaks.push_back(knot.Value);
  }
  AppendKnotCrossings(surface, trim, breaks);
  return DistinctBreaks(std::move(breaks), trim.Domain());
}

Curve<3> IsoCurve(const SurfaceView& surface, int dir, double value)
{
  const int degree = surface.Degree[dir];
  const int span = FindSpan(surface.Knots[dir], degree, value);
  std::array<double, MaxDegree + 1> basis;
  EvaluateBasis(surface.Knots[dir], degree, span, value, basis.data());
  Curve<3> curve;
  curve.Degree = surface.Degree[1 - dir];
  curve.Knots.assign(surface.Knots[1 - dir].begin(), surface.Knots[1 - dir].end());
  for (int k = 0; k < surface.Count[1 - dir]; ++k)
  {
    Vec4 sum = Vec4::Zero();
    for (int i = 0; i <= degree; ++i)
    {
      const std::int64_t along = span - degree + i;
      const std::int64_t id =
        dir == 0 ? along + std::int64_t(k) * surface.Count[0] : k + along * surface.Count[0];
      sum += basis[i] * surface.Homogeneous(id);
    }
    curve.Points.emplace_back(sum.head<3>() / sum[3]);
    curve.Weights.push_back(sum[3]);
  }
  curve.Pack();
  return curve;
}

Curve<3> LiftCurve(
  SurfaceEvaluator& evaluator, const CurveView<2>& trim, double tolerance, double& error)
{
  const SurfaceView& surface = evaluator.GetSurface();
  error = 0.0;
  Parallelogram plane;
  if (IsParallelogram(surface, plane))
  {
    return LiftToPlane(trim, plane);
  }
  const int constant = ConstantDirection(surface, trim);
  if (constant >= 0)
  {
    const Vec2 a = trim.Point(0), b = trim.Point(1);
    return Segment(
      IsoCurve(surface, constant, a[constant]), a[1 - constant], b[1 - constant], trim.Domain());
  }
  const auto lifted = [&](double t) {
    const Vec2 uv = Evaluate(trim, t);
    return evaluator.Point(uv[0], uv[1]);
  };
  Curve<3> curve = FitCurve<3>(lifted, LiftBreaks(surface, trim), Vec3::Ones(), tolerance, error);
  curve.Pack();
  return curve;
}

} // namespace nurbs
