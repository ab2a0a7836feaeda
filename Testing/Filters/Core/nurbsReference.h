// SPDX-License-Identifier: BSD-3-Clause
/// @file nurbsReference.h
/// @brief What the math tests compare with: B-splines by their textbook definition in long double,
/// shapes with closed forms, and random curves and surfaces.
#pragma once

#include "Curve.h"
#include "Surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace reference
{

using Real = long double;

/// N_{i,p}(t) by the recursive definition (The NURBS Book, equation 2.5), 0 / 0 = 0; the half-open
/// spans are closed at the domain's end.
inline Real Basis(nurbs::KnotView U, int degree, int i, int p, double t)
{
  if (p == 0)
  {
    return i == nurbs::FindSpan(U, degree, t) ? 1.0L : 0.0L;
  }
  Real sum = 0.0L;
  if (U[i + p] > U[i])
  {
    sum += (Real(t) - U[i]) / (Real(U[i + p]) - U[i]) * Basis(U, degree, i, p - 1, t);
  }
  if (U[i + p + 1] > U[i + 1])
  {
    sum += (U[i + p + 1] - Real(t)) / (Real(U[i + p + 1]) - U[i + 1]) *
      Basis(U, degree, i + 1, p - 1, t);
  }
  return sum;
}

/// All functions of degree p at t by the same definition, level by level, and their k-th derivative
/// by differentiating the definition (equation 2.7).
inline std::vector<Real> Bases(nurbs::KnotView U, int degree, double t, int k)
{
  const int spans = static_cast<int>(U.size()) - 1;
  std::vector<Real> N(spans, 0.0L);
  N[nurbs::FindSpan(U, degree, t)] = 1.0L;
  for (int p = 1; p <= degree; ++p)
  {
    const bool differentiate = p > degree - k;
    for (int i = 0; i + p < spans; ++i)
    {
      const Real left = Real(U[i + p]) - U[i];
      const Real right = Real(U[i + p + 1]) - U[i + 1];
      const Real a = left > 0.0L ? N[i] / left : 0.0L;
      const Real b = right > 0.0L ? N[i + 1] / right : 0.0L;
      N[i] = differentiate ? p * (a - b) : (Real(t) - U[i]) * a + (U[i + p + 1] - Real(t)) * b;
    }
  }
  N.resize(spans - degree);
  return k > degree ? std::vector<Real>(spans - degree, 0.0L) : N;
}

using Point4 = std::array<Real, 4>;

/// The derivative d^(a+b) / du^a dv^b of the homogeneous surface: the full double sum.
inline Point4 Homogeneous(const nurbs::SurfaceView& s, double u, double v, int a, int b)
{
  const std::vector<Real> Nu = Bases(s.Knots[0], s.Degree[0], u, a);
  const std::vector<Real> Nv = Bases(s.Knots[1], s.Degree[1], v, b);
  Point4 sum{};
  for (int j = 0; j < s.Count[1]; ++j)
  {
    for (int i = 0; i < s.Count[0]; ++i)
    {
      const std::int64_t k = i + std::int64_t(j) * s.Count[0];
      const Real factor = Nu[i] * Nv[j] * s.Weight(k);
      for (int c = 0; c < 3; ++c)
      {
        sum[c] += factor * s.Point(k)[c];
      }
      sum[3] += factor;
    }
  }
  return sum;
}

inline nurbs::Vec3 Point(const nurbs::SurfaceView& s, double u, double v)
{
  const Point4 h = Homogeneous(s, u, v, 0, 0);
  return nurbs::Vec3(double(h[0] / h[3]), double(h[1] / h[3]), double(h[2] / h[3]));
}

template <int D>
nurbs::Vec<D> Point(const nurbs::CurveView<D>& c, double t)
{
  const std::vector<Real> N = Bases(c.Knots, c.Degree, t, 0);
  std::array<Real, D + 1> sum{};
  for (int i = 0; i < c.Count; ++i)
  {
    for (int k = 0; k < D; ++k)
    {
      sum[k] += N[i] * c.Weight(i) * c.Point(i)[k];
    }
    sum[D] += N[i] * c.Weight(i);
  }
  nurbs::Vec<D> point;
  for (int k = 0; k < D; ++k)
  {
    point[k] = double(sum[k] / sum[D]);
  }
  return point;
}

/// Random numbers that are the same on every machine.
class Random
{
public:
  explicit Random(unsigned seed)
    : Engine(seed)
  {}
  double Uniform(double a, double b) { return a + (b - a) * (this->Engine() / 4294967296.0); }
  int Integer(int a, int b) { return a + static_cast<int>(this->Engine() % unsigned(b - a + 1)); }

  /// A valid knot vector; interior knots are uneven and of any multiplicity up to degree + 1 (a
  /// break) or, if not `breaks`, degree.
  std::vector<double> Knots(int degree, int count, bool clamped, bool breaks)
  {
    std::vector<double> knots(count + degree + 1);
    double t = this->Uniform(-2.0, 2.0);
    int multiplicity = 0;
    for (int i = 0; i < static_cast<int>(knots.size()); ++i)
    {
      const bool end = clamped && ((i > 0 && i <= degree) || i > count);
      const bool start = i == degree + (clamped ? 1 : 0) || i == count || i == degree + 1;
      const int limit = breaks ? degree + 1 : std::max(1, degree);
      if (!end && (start || multiplicity >= limit || this->Uniform(0, 1) < 0.6))
      {
        t += this->Uniform(0.1, 1.0);
        multiplicity = 0;
      }
      ++multiplicity;
      knots[i] = t;
    }
    return knots;
  }

  nurbs::Surface Surface(int degreeU, int degreeV, bool clamped = true, bool rational = true,
    bool breaks = false, int extra = 5)
  {
    nurbs::Surface s;
    const int degrees[2] = { degreeU, degreeV };
    for (int dir = 0; dir < 2; ++dir)
    {
      s.Degree[dir] = degrees[dir];
      s.Count[dir] = degrees[dir] + 1 + this->Integer(0, extra);
      s.Knots[dir] = this->Knots(s.Degree[dir], s.Count[dir], clamped, breaks);
    }
    for (int k = 0; k < s.Count[0] * s.Count[1]; ++k)
    {
      const double x = k % s.Count[0] + this->Uniform(-0.4, 0.4);
      const double y = k / s.Count[0] + this->Uniform(-0.4, 0.4);
      s.Points.push_back(nurbs::Vec3(x, y, this->Uniform(-1, 1)));
      if (rational)
      {
        s.Weights.push_back(this->Uniform(0.5, 2.0));
      }
    }
    return s;
  }

  template <int D>
  nurbs::Curve<D> Curve(int degree, bool clamped = true, bool breaks = false, int extra = 6)
  {
    nurbs::Curve<D> c;
    c.Degree = degree;
    const int count = degree + 1 + this->Integer(0, extra);
    c.Knots = this->Knots(degree, count, clamped, breaks);
    for (int i = 0; i < count; ++i)
    {
      nurbs::Vec<D> point;
      for (int k = 0; k < D; ++k)
      {
        point[k] = this->Uniform(-1, 1);
      }
      c.Points.push_back(point);
      c.Weights.push_back(this->Uniform(0.5, 2.0));
    }
    c.Pack();
    return c;
  }

  /// A parameter of the domain; now and then one of its ends or a knot.
  double Parameter(nurbs::KnotView knots, int degree)
  {
    const nurbs::Interval domain = nurbs::Domain(knots, degree);
    const int dice = this->Integer(0, 9);
    if (dice == 0)
    {
      return domain.Min;
    }
    if (dice == 1)
    {
      return domain.Max;
    }
    if (dice == 2)
    {
      return domain.Clamp(knots[this->Integer(0, static_cast<int>(knots.size()) - 1)]);
    }
    return this->Uniform(domain.Min, domain.Max);
  }

private:
  std::mt19937 Engine;
};

/// The nine-point circle of The NURBS Book, section 7.5, over [0, 1].
inline nurbs::Curve<2> Circle(double radius)
{
  const double x[9] = { 1, 1, 0, -1, -1, -1, 0, 1, 1 };
  const double y[9] = { 0, 1, 1, 1, 0, -1, -1, -1, 0 };
  nurbs::Curve<2> c;
  c.Degree = 2;
  c.Knots = { 0, 0, 0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1, 1, 1 };
  for (int i = 0; i < 9; ++i)
  {
    c.Points.push_back(radius * nurbs::Vec2(x[i], y[i]));
    c.Weights.push_back(i % 2 == 0 ? 1.0 : std::sqrt(0.5));
  }
  c.Pack();
  return c;
}

/// The surface that a profile in the (x, z) half-plane sweeps about the z axis; u goes round.
inline nurbs::Surface Revolve(int degree, const std::vector<double>& knots,
  const std::vector<nurbs::Vec2>& profile, const std::vector<double>& weights)
{
  const nurbs::Curve<2> circle = Circle(1.0);
  nurbs::Surface s;
  s.Degree[0] = 2;
  s.Degree[1] = degree;
  s.Count[0] = 9;
  s.Count[1] = static_cast<int>(profile.size());
  s.Knots[0] = circle.Knots;
  s.Knots[1] = knots;
  for (std::size_t j = 0; j < profile.size(); ++j)
  {
    for (int i = 0; i < 9; ++i)
    {
      const nurbs::Vec2 xy = circle.Points[i] * profile[j][0];
      s.Points.push_back(nurbs::Vec3(xy[0], xy[1], profile[j][1]));
      s.Weights.push_back(circle.Weights[i] * weights[j]);
    }
  }
  return s;
}

/// From the south pole (v = 0) to the north pole (v = 1).
inline nurbs::Surface Sphere(double radius)
{
  const double r = radius;
  const double w = std::sqrt(0.5);
  return Revolve(2, { 0, 0, 0, 0.5, 0.5, 1, 1, 1 },
    { { 0, -r }, { r, -r }, { r, 0 }, { r, r }, { 0, r } }, { 1, w, 1, w, 1 });
}

/// The axis is z, `major` and `minor` the radii.
inline nurbs::Surface Torus(double major, double minor)
{
  const nurbs::Curve<2> circle = Circle(minor);
  std::vector<nurbs::Vec2> profile;
  for (const nurbs::Vec2& p : circle.Points)
  {
    profile.push_back(p + nurbs::Vec2(major, 0.0));
  }
  return Revolve(2, circle.Knots, profile, circle.Weights);
}

/// Apex at v = 1, height `height`; base circle at z = 0.
inline nurbs::Surface Cone(double radius, double height)
{
  return Revolve(1, { 0, 0, 1, 1 }, { { radius, 0 }, { 0, height } }, { 1, 1 });
}

/// The largest distance of two surfaces at corresponding parameters, at `samples` random ones of the
/// domain of `b`.
inline double LargestDistance(
  const nurbs::SurfaceView& a, const nurbs::SurfaceView& b, Random& random, int samples = 40)
{
  double largest = 0.0;
  for (int i = 0; i < samples; ++i)
  {
    const double u = random.Parameter(b.Knots[0], b.Degree[0]);
    const double v = random.Parameter(b.Knots[1], b.Degree[1]);
    largest = std::max(largest, (nurbs::Evaluate(b, u, v) - Point(a, u, v)).norm());
  }
  return largest;
}

template <int D>
double LargestDistance(
  const nurbs::CurveView<D>& a, const nurbs::CurveView<D>& b, Random& random, int samples = 40)
{
  double largest = 0.0;
  for (int i = 0; i < samples; ++i)
  {
    const double t = random.Parameter(b.Knots, b.Degree);
    largest = std::max(largest, (nurbs::Evaluate<D>(b, t) - Point<D>(a, t)).norm());
  }
  return largest;
}

} // namespace reference
