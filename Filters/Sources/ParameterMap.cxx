// SPDX-License-Identifier: BSD-3-Clause
#include "ParameterMap.h"

#include <cmath>

namespace nurbs
{

namespace
{
constexpr double QuarterTurn = 1.57079632679489661923;
constexpr double MaxSpans = 1e4;
} // namespace

ParameterMap ParameterMap::Circular(double offset)
{
  ParameterMap map;
  map.Type = Kind::Circular;
  map.Start = offset;
  return map;
}

ParameterMap ParameterMap::Hyperbolic()
{
  ParameterMap map;
  map.Type = Kind::Hyperbolic;
  return map;
}

double ParameterMap::Span() const
{
  switch (this->Type)
  {
    case Kind::Circular:
      return QuarterTurn;
    case Kind::Hyperbolic:
      return 1.0;
    default:
      return 0.0;
  }
}

double ParameterMap::Middle(double t) const
{
  const double h = this->Span();
  return this->Start + (std::floor((t - this->Start) / h) + 0.5) * h;
}

double ParameterMap::Forward(double t) const
{
  if (this->Type == Kind::Identity)
  {
    return t;
  }
  const double h = this->Span();
  const double m = this->Middle(t);
  return this->Type == Kind::Circular
    ? m + 0.5 * h * std::tan(0.5 * (t - m)) / std::tan(0.25 * h)
    : m + 0.5 * h * std::tanh(0.5 * (t - m)) / std::tanh(0.25 * h);
}

double ParameterMap::Inverse(double x) const
{
  if (this->Type == Kind::Identity)
  {
    return x;
  }
  const double h = this->Span();
  const double m = this->Middle(x);
  const double s = 2.0 * (x - m) / h;
  return this->Type == Kind::Circular ? m + 2.0 * std::atan(s * std::tan(0.25 * h))
                                      : m + 2.0 * std::atanh(s * std::tanh(0.25 * h));
}

void ParameterMap::AppendBreaks(double a, double b, std::vector<double>& breaks) const
{
  if (this->Type == Kind::Identity)
  {
    return;
  }
  const double h = this->Span();
  const double rounding = 1e-10 * h;
  if (!(b - a < MaxSpans * h))
  {
    throw Error("a circle or hyperbola runs through too many turns or is not a number");
  }
  for (double k = std::floor((a - this->Start) / h);; k += 1.0)
  {
    const double t = this->Start + k * h;
    if (t >= b - rounding)
    {
      return;
    }
    if (t > a + rounding)
    {
      breaks.push_back(t);
    }
  }
}

Interval ParameterMap::Widen(Interval range) const
{
  if (this->Type == Kind::Identity)
  {
    return range;
  }
  const double h = this->Span();
  const double least = 1e-3;
  const double snap = 1e-10;
  const double low = (range.Min - this->Start) / h;
  const double above = std::ceil(low) - low; // distance to the break that ends the first span
  if (above < least)
  {
    const bool onBreak = above < snap;
    range.Min = this->Start + (std::ceil(low) - (onBreak ? 0.0 : least)) * h;
  }
  else if (1.0 - above < snap)
  {
    range.Min = this->Start + std::floor(low) * h;
  }
  const double high = (range.Max - this->Start) / h;
  const double below = high - std::floor(high);
  if (below < least)
  {
    const bool onBreak = below < snap;
    range.Max = this->Start + (std::floor(high) + (onBreak ? 0.0 : least)) * h;
  }
  else if (1.0 - below < snap)
  {
    range.Max = this->Start + std::ceil(high) * h;
  }
  return range;
}

UnitArc MakeUnitArc(const ParameterMap& map, double t0, double t1)
{
  const bool circle = map.GetKind() == ParameterMap::Kind::Circular;
  const double h = map.Span();
  std::vector<double> ends{ t0 };
  map.AppendBreaks(t0, t1, ends);
  ends.push_back(t1);

  // The blossom of (1 -+ s^2, 2 s, 1 +- s^2), turned to the middle of the span; divided by the
  // weight at the span's ends, so that neighbouring spans meet in homogeneous coordinates.
  const double e = circle ? std::tan(0.25 * h) : std::tanh(0.25 * h);
  const double sign = circle ? -1.0 : 1.0;
  const double norm = 1.0 - sign * e * e;
  auto point = [&](double m, double a, double b) {
    const double x = 1.0 + sign * a * b;
    const double y = a + b;
    const double w = 1.0 - sign * a * b;
    const double c = circle ? std::cos(m) : std::cosh(m);
    const double s = circle ? std::sin(m) : std::sinh(m);
    return Vec3(Vec3(c * x + sign * s * y, s * x + c * y, w) / norm);
  };

  UnitArc arc;
  arc.Knots.assign(3, map.Forward(t0));
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
  {
    const double k = std::floor((0.5 * (ends[i] + ends[i + 1]) - map.Offset()) / h);
    const double m = map.Offset() + (k + 0.5) * h;
    auto half = [&](
                  double t) { return circle ? std::tan(0.5 * (t - m)) : std::tanh(0.5 * (t - m)); };
    const double a = half(ends[i]);
    const double b = half(ends[i + 1]);
    if (i == 0)
    {
      arc.Points.push_back(point(m, a, a));
    }
    arc.Points.push_back(point(m, a, b));
    arc.Points.push_back(point(m, b, b));
    arc.Knots.insert(arc.Knots.end(), 2, map.Forward(ends[i + 1]));
  }
  arc.Knots.push_back(arc.Knots.back());
  return arc;
}

} // namespace nurbs
