// SPDX-License-Identifier: BSD-3-Clause
#include "AreaByLines.h"

#include <numeric>

namespace truth
{

using nurbs::Vec3;

namespace
{

/// The ends of the non-empty knot spans in a direction.
std::vector<double> SpanEnds(const nurbs::SurfaceView& surface, int dir)
{
  const nurbs::Interval domain = surface.Domain(dir);
  std::vector<double> ends{ domain.Min };
  for (const double knot : surface.Knots[dir])
  {
    if (knot > ends.back() && knot <= domain.Max)
    {
      ends.push_back(knot);
    }
  }
  return ends;
}

/// One line of constant v.
class Line
{
public:
  Line(const nurbs::RayCaster& caster, std::int64_t face, const ImageView& view, double v)
    : Caster(caster)
    , Face(caster.GetModel().Faces[face])
    , FaceIndex(face)
    , View(view)
    , V(v)
    , Size(caster.Bounds().diagonal().norm())
  {}

  bool IsVisible(double u) const
  {
    if (!this->Caster.GetTrims().Inside(this->FaceIndex, u, this->V))
    {
      return false;
    }
    const Vec3 point = nurbs::Evaluate(this->Face.Geometry, u, this->V);
    const Vec3 normal =
      (this->Face.Reversed ? -1.0 : 1.0) * nurbs::Normal(this->Face.Geometry, u, this->V);
    nurbs::Ray ray;
    ray.Origin = point;
    ray.Direction = this->View.Perspective ? Vec3(this->View.Eye - point) : this->View.Toward;
    ray.Max = this->View.Perspective ? 1.0 : ray.Max;
    ray.Min = 1e-9 * this->Size / ray.Direction.norm();
    return normal.dot(ray.Direction) > 0.0 && !this->Caster.IsBlocked(ray);
  }

  /// Where visibility changes between a (not visible) and b (visible), or the other way.
  double Change(double a, double b, bool atA) const
  {
    const double small = 1e-12 * this->Face.Geometry.Domain(0).Length();
    while (std::abs(b - a) > small)
    {
      const double middle = 0.5 * (a + b);
      (this->IsVisible(middle) == atA ? a : b) = middle;
    }
    return 0.5 * (a + b);
  }

  /// The area's element over [a, b] of a knot span, by Gauss' rule of 8 points.
  double Element(double a, double b) const
  {
    static constexpr double At[4] = { 0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
      0.9602898564975363 };
    static constexpr double Of[4] = { 0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
      0.1012285362903763 };
    double sum = 0.0;
    for (int k = 0; k < 8; ++k)
    {
      const double u = 0.5 * (a + b + (k % 2 ? 1.0 : -1.0) * At[k / 2] * (b - a));
      const auto d = nurbs::EvaluateDerivatives(this->Face.Geometry, u, this->V, 1);
      sum += 0.5 * (b - a) * Of[k / 2] * d.Su.cross(d.Sv).norm();
    }
    return sum;
  }

  double VisiblePart(double from, double to, int scan) const
  {
    double sum = 0.0, start = from, last = from;
    bool visible = this->IsVisible(from);
    for (int k = 1; k <= scan; ++k)
    {
      const double u = k == scan ? to : from + k * (to - from) / scan;
      const bool now = this->IsVisible(u);
      if (now != visible)
      {
        const double change = this->Change(last, u, visible);
        sum += visible ? this->Element(start, change) : 0.0;
        start = change;
        visible = now;
      }
      last = u;
    }
    return sum + (visible ? this->Element(start, to) : 0.0);
  }

private:
  const nurbs::RayCaster& Caster;
  const nurbs::Face& Face;
  std::int64_t FaceIndex;
  const ImageView& View;
  double V;
  double Size;
};

} // namespace

namespace
{

/// Integrates a function of v, halving intervals until two rules agree (Simpson's, once and twice).
template <typename F>
double Adapt(const F& f, double a, double b, const double (&values)[3], double tolerance, int depth)
{
  const double middle = 0.5 * (a + b);
  const double left = f(0.5 * (a + middle)), right = f(0.5 * (middle + b));
  const double once = (b - a) / 6.0 * (values[0] + 4.0 * values[1] + values[2]);
  const double twice =
    (b - a) / 12.0 * (values[0] + 4.0 * left + 2.0 * values[1] + 4.0 * right + values[2]);
  if (depth == 0 || std::abs(twice - once) <= 15.0 * tolerance)
  {
    return twice + (twice - once) / 15.0;
  }
  const double low[3] = { values[0], left, values[1] }, high[3] = { values[1], right, values[2] };
  return Adapt(f, a, middle, low, 0.5 * tolerance, depth - 1) +
    Adapt(f, middle, b, high, 0.5 * tolerance, depth - 1);
}

} // namespace

double AreaByLines(const nurbs::RayCaster& caster, std::int64_t face, const ImageView& view,
  double tolerance, int scan, const nurbs::ParallelFor& parallel)
{
  constexpr int Pieces = 8; // Of a knot span, to start with.
  constexpr int Depth = 24;
  const nurbs::SurfaceView& surface = caster.GetModel().Faces[face].Geometry;
  if (surface.Size() == 0)
  {
    return 0.0;
  }
  const std::vector<double> us = SpanEnds(surface, 0), vs = SpanEnds(surface, 1);
  std::vector<double> sums((vs.size() - 1) * Pieces);
  const auto visible = [&](double v) {
    const Line line(caster, face, view, v);
    double sum = 0.0;
    for (std::size_t span = 0; span + 1 < us.size(); ++span)
    {
      sum += line.VisiblePart(us[span], us[span + 1], scan);
    }
    return sum;
  };
  parallel(0, static_cast<std::int64_t>(sums.size()), [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i)
    {
      const double low = vs[i / Pieces], step = (vs[i / Pieces + 1] - low) / Pieces;
      const double a = low + (i % Pieces) * step, b = a + step;
      // Not on the ends themselves, where the face's trims end.
      const double inset = 1e-9 * step;
      const double values[3] = { visible(a + inset), visible(0.5 * (a + b)), visible(b - inset) };
      sums[i] = Adapt(visible, a, b, values, tolerance / static_cast<double>(sums.size()), Depth);
    }
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

} // namespace truth
