// SPDX-License-Identifier: BSD-3-Clause
#include "Surface.h"

#include "Basis.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

bool SurfaceView::IsRational() const
{
  for (std::int64_t k = 1; k < this->Size(); ++k)
  {
    if (this->Weight(k) != this->Weight(0))
    {
      return true;
    }
  }
  return false;
}

SurfaceView Surface::View() const
{
  SurfaceView view;
  for (int dir = 0; dir < 2; ++dir)
  {
    view.Degree[dir] = this->Degree[dir];
    view.Count[dir] = this->Count[dir];
    view.Knots[dir] = this->Knots[dir];
  }
  view.Points = this->Points.empty() ? nullptr : this->Points[0].data();
  view.Weights = this->Weights.empty() ? nullptr : this->Weights.data();
  return view;
}

Surface Copy(const SurfaceView& surface)
{
  Surface copy;
  for (int dir = 0; dir < 2; ++dir)
  {
    copy.Degree[dir] = surface.Degree[dir];
    copy.Count[dir] = surface.Count[dir];
    copy.Knots[dir].assign(surface.Knots[dir].begin(), surface.Knots[dir].end());
  }
  copy.Points.resize(surface.Size());
  copy.Weights.resize(surface.Weights ? surface.Size() : 0);
  for (std::int64_t k = 0; k < surface.Size(); ++k)
  {
    copy.Points[k] = surface.Point(k);
    if (surface.Weights)
    {
      copy.Weights[k] = surface.Weight(k);
    }
  }
  return copy;
}

namespace
{

constexpr int Width = MaxDegree + 1;

/// The homogeneous derivatives h[a][b] = d^(a+b) H / du^a dv^b, a + b <= order <= 2: the double sum
/// over the (p + 1)(q + 1) control points that count (The NURBS Book, equation 4.15).
void HomogeneousDerivatives(
  const SurfaceView& surface, double u, double v, int order, Vec4 (&h)[3][3])
{
  const double at[2] = { u, v };
  double basis[2][3 * Width];
  int first[2];
  for (int dir = 0; dir < 2; ++dir)
  {
    const int span = FindSpan(surface.Knots[dir], surface.Degree[dir], at[dir]);
    EvaluateBasisDerivatives(
      surface.Knots[dir], surface.Degree[dir], span, at[dir], order, basis[dir]);
    first[dir] = span - surface.Degree[dir];
  }
  for (int a = 0; a <= order; ++a)
  {
    for (int b = 0; a + b <= order; ++b)
    {
      h[a][b].setZero();
    }
  }
  const int p = surface.Degree[0];
  const int q = surface.Degree[1];
  for (int j = 0; j <= q; ++j)
  {
    const std::int64_t row = std::int64_t(first[1] + j) * surface.Count[0] + first[0];
    Vec4 inner[3] = { Vec4::Zero(), Vec4::Zero(), Vec4::Zero() };
    for (int i = 0; i <= p; ++i)
    {
      const Vec4 point = surface.Homogeneous(row + i);
      for (int a = 0; a <= order; ++a)
      {
        inner[a] += basis[0][a * (p + 1) + i] * point;
      }
    }
    for (int a = 0; a <= order; ++a)
    {
      for (int b = 0; a + b <= order; ++b)
      {
        h[a][b] += basis[1][b * (q + 1) + j] * inner[a];
      }
    }
  }
}

} // namespace

SurfaceDerivatives ProjectDerivatives(const Vec4 (&h)[3][3], int order)
{
  // The quotient rule, term by term (The NURBS Book, equation 4.20).
  SurfaceDerivatives d;
  d.Suu = d.Suv = d.Svv = Vec3::Zero();
  const double w = h[0][0][3];
  d.S = h[0][0].head<3>() / w;
  d.Su = (h[1][0].head<3>() - h[1][0][3] * d.S) / w;
  d.Sv = (h[0][1].head<3>() - h[0][1][3] * d.S) / w;
  if (order >= 2)
  {
    d.Suu = (h[2][0].head<3>() - 2.0 * h[1][0][3] * d.Su - h[2][0][3] * d.S) / w;
    d.Svv = (h[0][2].head<3>() - 2.0 * h[0][1][3] * d.Sv - h[0][2][3] * d.S) / w;
    d.Suv = (h[1][1].head<3>() - h[1][0][3] * d.Sv - h[0][1][3] * d.Su - h[1][1][3] * d.S) / w;
  }
  return d;
}

// HomogeneousDerivatives of order 0, which is asked for far more often than the others.
Vec3 Evaluate(const SurfaceView& surface, double u, double v)
{
  const int p = surface.Degree[0], q = surface.Degree[1];
  double Nu[MaxDegree + 1], Nv[MaxDegree + 1];
  const int spanU = FindSpan(surface.Knots[0], p, u);
  const int spanV = FindSpan(surface.Knots[1], q, v);
  EvaluateBasis(surface.Knots[0], p, spanU, u, Nu);
  EvaluateBasis(surface.Knots[1], q, spanV, v, Nv);
  Vec4 h = Vec4::Zero();
  for (int j = 0; j <= q; ++j)
  {
    const std::int64_t row = std::int64_t(spanV - q + j) * surface.Count[0] + spanU - p;
    Vec4 inner = Vec4::Zero();
    for (int i = 0; i <= p; ++i)
    {
      inner += Nu[i] * surface.Homogeneous(row + i);
    }
    h += Nv[j] * inner;
  }
  return h.head<3>() / h[3];
}

SurfaceDerivatives EvaluateDerivatives(const SurfaceView& surface, double u, double v, int order)
{
  if (order < 1 || order > 2)
  {
    throw Error("derivatives of order " + std::to_string(order) + " are not available");
  }
  Vec4 h[3][3];
  HomogeneousDerivatives(surface, u, v, order, h);
  return ProjectDerivatives(h, order);
}

namespace
{

/// A derivative or cross product under this fraction of its natural size counts as vanished. The
/// limit that replaces it then errs by the same fraction.
constexpr double Vanishing = 1e-7;

/// The largest control vector of the derivative in direction `dir` over the spans of (u, v): what
/// |S_dir| is compared with, independent of units and parameter scale.
double DerivativeScale(const SurfaceView& surface, int dir, double u, double v)
{
  const int spanU = FindSpan(surface.Knots[0], surface.Degree[0], u);
  const int spanV = FindSpan(surface.Knots[1], surface.Degree[1], v);
  const int first[2] = { spanU - surface.Degree[0], spanV - surface.Degree[1] };
  const int p = surface.Degree[dir];
  const KnotView knots = surface.Knots[dir];
  const std::int64_t step = dir == 0 ? 1 : surface.Count[0];
  double largest = 0.0;
  for (int j = first[1]; j <= spanV - (dir == 1 ? 1 : 0); ++j)
  {
    for (int i = first[0]; i <= spanU - (dir == 0 ? 1 : 0); ++i)
    {
      const std::int64_t k = i + std::int64_t(j) * surface.Count[0];
      const int n = dir == 0 ? i : j;
      const double length = (surface.Point(k + step) - surface.Point(k)).norm();
      largest = std::max(largest, p * length / (knots[n + p + 1] - knots[n + 1]));
    }
  }
  return largest;
}

/// The cross product if it is safely away from zero relative to its factors and their scales, else
/// zero.
Vec3 SafeCross(const Vec3& su, const Vec3& sv, double scaleU, double scaleV)
{
  const Vec3 cross = su.cross(sv);
  const double lu = su.norm();
  const double lv = sv.norm();
  const bool safe =
    lu > Vanishing * scaleU && lv > Vanishing * scaleV && cross.norm() > Vanishing * lu * lv;
  return safe ? cross : Vec3::Zero();
}

/// The derivative of Su x Sv in the direction (du, dv).
Vec3 CrossDerivative(const SurfaceDerivatives& d, double du, double dv)
{
  return (d.Suu * du + d.Suv * dv).cross(d.Sv) + d.Su.cross(d.Suv * du + d.Svv * dv);
}

/// The normal's limit by going back to the singular point in halved steps, with one linear
/// extrapolation. For cross products that vanish to second order or more.
Vec3 ApproachedNormal(const SurfaceView& surface, const Vec2& at, const Vec2& way)
{
  Vec3 last = Vec3::Zero();
  Vec3 limit = Vec3::Zero();
  for (double t = 0.125; t > 1e-5; t *= 0.5)
  {
    const Vec2 uv = at + t * way;
    const SurfaceDerivatives d = EvaluateDerivatives(surface, uv[0], uv[1], 1);
    const Vec3 cross = SafeCross(d.Su, d.Sv, DerivativeScale(surface, 0, uv[0], uv[1]),
      DerivativeScale(surface, 1, uv[0], uv[1]));
    if (cross.isZero(0.0))
    {
      break;
    }
    const Vec3 normal = cross.normalized();
    limit = last.isZero(0.0) ? normal : (2.0 * normal - last).normalized();
    last = normal;
  }
  return limit;
}

/// The way from a singular point at (u, v) into the domain. If the iso-curve of one direction has
/// shrunk to a point there, straight across it: each of its parameters has a normal of its own.
Vec2 WayIntoDomain(const Interval (&domain)[2], const Vec2& at, const SurfaceDerivatives& d,
  double scaleU, double scaleV)
{
  Vec2 way(0.5 * (domain[0].Min + domain[0].Max), 0.5 * (domain[1].Min + domain[1].Max));
  way -= at;
  if (way.isZero(0.0))
  {
    way = Vec2(domain[0].Length(), domain[1].Length()) * 0.25;
  }
  const auto vanishes = [](const Vec3& first, const Vec3& second, double scale, double length) {
    return first.norm() + second.norm() * length <= 10.0 * Vanishing * scale;
  };
  const bool pointU = vanishes(d.Su, d.Suu, scaleU, domain[0].Length());
  const bool pointV = vanishes(d.Sv, d.Svv, scaleV, domain[1].Length());
  if (pointU != pointV && way[pointU ? 1 : 0] != 0.0)
  {
    way[pointU ? 0 : 1] = 0.0;
  }
  return way;
}

} // namespace

Vec3 Normal(const SurfaceView& surface, double u, double v)
{
  const SurfaceDerivatives first = EvaluateDerivatives(surface, u, v, 1);
  const double scaleU = DerivativeScale(surface, 0, u, v);
  const double scaleV = DerivativeScale(surface, 1, u, v);
  const Vec3 regular = SafeCross(first.Su, first.Sv, scaleU, scaleV);
  if (!regular.isZero(0.0))
  {
    return regular.normalized();
  }
  const SurfaceDerivatives d = EvaluateDerivatives(surface, u, v, 2);
  // Su x Sv grows from zero along the way into the domain; its derivative gives the direction.
  const Interval domain[2] = { surface.Domain(0), surface.Domain(1) };
  const Vec2 way = WayIntoDomain(domain, Vec2(u, v), d, scaleU, scaleV);
  const Vec3 growth = CrossDerivative(d, way[0], way[1]);
  const double natural = scaleU * scaleV *
    (std::abs(way[0]) / domain[0].Length() + std::abs(way[1]) / domain[1].Length());
  if (growth.norm() > 1e-6 * natural)
  {
    return growth.normalized();
  }
  return ApproachedNormal(surface, Vec2(u, v), way);
}

namespace
{

/// Parameters that tell two iso-curves of direction `dir` apart: more than the degree on every span.
std::vector<double> ProbeParameters(const SurfaceView& surface, int dir)
{
  const std::vector<Knot> knots = DistinctKnots(surface.Knots[dir], surface.Degree[dir]);
  const int steps = 2 * surface.Degree[dir] + 2;
  std::vector<double> probes{ knots.front().Value };
  for (std::size_t k = 1; k < knots.size(); ++k)
  {
    const double a = knots[k - 1].Value;
    const double b = knots[k].Value;
    for (int i = 1; i < steps; ++i)
    {
      probes.push_back(a + (b - a) * i / steps);
    }
    probes.push_back(b);
  }
  return probes;
}

/// The point at parameter t of the iso-curve `dir` = constant.
Vec3 IsoPoint(const SurfaceView& surface, int dir, double constant, double t)
{
  return dir == 0 ? Evaluate(surface, constant, t) : Evaluate(surface, t, constant);
}

} // namespace

bool IsClosed(const SurfaceView& surface, int dir, double tolerance)
{
  const Interval domain = surface.Domain(dir);
  for (double t : ProbeParameters(surface, 1 - dir))
  {
    const Vec3 gap = IsoPoint(surface, dir, domain.Max, t) - IsoPoint(surface, dir, domain.Min, t);
    if (!(gap.norm() <= tolerance))
    {
      return false;
    }
  }
  return true;
}

bool IsDegenerateSide(const SurfaceView& surface, int dir, int end, double tolerance)
{
  const Interval domain = surface.Domain(dir);
  const double side = end == 0 ? domain.Min : domain.Max;
  Box3 box;
  for (double t : ProbeParameters(surface, 1 - dir))
  {
    box.extend(IsoPoint(surface, dir, side, t));
    if (!(box.diagonal().norm() <= tolerance))
    {
      return false;
    }
  }
  return true;
}

} // namespace nurbs
