// SPDX-License-Identifier: BSD-3-Clause
#include "FacetBound.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{
constexpr double SteepestCosine = 0.7; // Of the angle between facet and surface,
constexpr double TooSteep = 1e9;
constexpr double DihedralSlack = 2.4; // The neighbour's facet may be as steep on its side,
constexpr double SlopeSlack = 1.2;    // for the slope between samples and a little beyond the edge.

double SegmentDistance(const Vec3& p, const Vec3& x, const Vec3& edge, double square)
{
  const Vec3 d = p - x;
  const double t = square > 0.0 ? std::min(1.0, std::max(0.0, d.dot(edge) / square)) : 0.0;
  return (d - t * edge).squaredNorm();
}

// For a >= 0; b is zero more often than not.
double Hypotenuse(double a, double b)
{
  return b == 0.0 ? a : std::sqrt(a * a + b * b);
}

ParameterBox BoxOf(const Vec2 (&uv)[3])
{
  return { std::min({ uv[0][0], uv[1][0], uv[2][0] }), std::max({ uv[0][0], uv[1][0], uv[2][0] }),
    std::min({ uv[0][1], uv[1][1], uv[2][1] }), std::max({ uv[0][1], uv[1][1], uv[2][1] }) };
}
} // namespace

double Angle(const Vec3& a, const Vec3& b)
{
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

Facet::Facet(const Vec3& x0, const Vec3& x1, const Vec3& x2)
  : X{ x0, x1, x2 }
{
  double longest = 0.0;
  int base = 0;
  for (int i = 0; i < 3; ++i)
  {
    this->Edge[i] = this->X[(i + 1) % 3] - this->X[i];
    this->Square[i] = this->Edge[i].squaredNorm();
    base = this->Square[i] > this->Square[base] ? i : base;
  }
  longest = this->Square[base];
  const Vec3 n = this->Edge[0].cross(this->Edge[1]);
  const double area = n.norm();
  this->Plane = area > 1e-8 * longest;
  if (this->Plane)
  {
    this->N = n / area;
    this->T[0] = this->Edge[base] / std::sqrt(longest);
    this->T[1] = this->N.cross(this->T[0]);
    for (int i = 0; i < 3; ++i)
    {
      this->Outward[i] = this->Edge[i].cross(this->N);
    }
  }
}

void Facet::Measure(const Vec3& p, double& height, double& outside) const
{
  height = 0.0;
  outside = 0.0;
  Vec3 foot = p;
  bool outward[3] = { true, true, true };
  if (this->Plane)
  {
    height = this->N.dot(p - this->X[0]);
    foot -= height * this->N;
    height = std::abs(height);
    for (int i = 0; i < 3; ++i)
    {
      outward[i] = this->Outward[i].dot(foot - this->X[i]) > 0.0;
    }
    if (!outward[0] && !outward[1] && !outward[2])
    {
      return;
    }
  }
  double least = 1e300;
  for (int i = 0; i < 3; ++i)
  {
    if (outward[i])
    {
      least = std::min(least, SegmentDistance(foot, this->X[i], this->Edge[i], this->Square[i]));
    }
  }
  outside = std::sqrt(least);
}

double Facet::Inside(int i, const Vec3& p) const
{
  const double across = this->Plane ? this->Outward[i].dot(p - this->X[i]) : 0.0;
  return across < 0.0 ? -across / std::sqrt(this->Square[i]) : 0.0;
}

void SampleDistance::Add(const Facet& facet, const Vec3& p, int edge)
{
  double height;
  double outside;
  facet.Measure(p, height, outside);
  this->Height = std::max(this->Height, height);
  this->Outside = std::max(this->Outside, outside);
  this->Far = std::max(this->Far, Hypotenuse(height, outside));
  if (edge >= 0)
  {
    const double inside = facet.Inside(edge, p);
    this->Inside = std::max(this->Inside, inside);
    this->Edge = std::max(this->Edge, Hypotenuse(height, inside));
  }
}

void SampleDistance::AddSlope(const Facet& facet, const Vec3& normal)
{
  const double c = std::abs(normal.dot(facet.Normal()));
  this->Slope = std::max(
    this->Slope, c > SteepestCosine ? std::sqrt(std::max(0.0, 1.0 / (c * c) - 1.0)) : TooSteep);
}

void SampleDistance::SetCrease()
{
  this->Slope = TooSteep;
}

double SampleDistance::Largest() const
{
  return std::max(std::min(this->Far, this->Height + DihedralSlack * this->Slope * this->Outside),
    std::min(this->Edge, this->Height + SlopeSlack * this->Slope * this->Inside));
}

Remainder::Remainder(
  const SecondDerivatives& second, double a, double b, const Facet& facet, double twist)
{
  if (!facet.HasPlane())
  {
    this->Along = second.Bow(a, b);
    return;
  }
  this->Across = second.Bow(a, b, facet.Normal(), twist < 0.0) + std::max(0.0, twist);
  const double t0 = second.Bow(a, b, facet.Tangent(0));
  const double t1 = second.Bow(a, b, facet.Tangent(1));
  this->Along = std::sqrt(t0 * t0 + t1 * t1);
}

double CombineError(const SampleDistance& samples, const Remainder& rest, int density)
{
  const double share = 1.0 / (density * density);
  const double across = share * rest.Across;
  const double along = share * rest.Along;
  const double both = std::sqrt(across * across + along * along);
  const double height = std::min(rest.Height, samples.Height + across);
  const double outside = samples.Outside + along;
  const double inside = samples.Inside + along;
  // What slopes make of distances along the facet; where they are steep, distances count in full.
  const double beyond = std::min({ std::sqrt(height * height + outside * outside),
    samples.Far + both, height + DihedralSlack * samples.Slope * outside });
  const double within = height + SlopeSlack * samples.Slope * inside;
  return std::max(
    beyond, density == 1 ? std::min(beyond, within) : std::min(samples.Edge + both, within));
}

int NextDensity(const SampleDistance& samples, const Remainder& rest, int density, double limit)
{
  for (int k = 2 * density; k <= DensestSamples; k *= 2)
  {
    if (CombineError(samples, rest, k) <= limit)
    {
      return k;
    }
  }
  return 0;
}

FacetBound::FacetBound(const SurfaceBound& bound, ErrorMode mode)
  : Bound(bound)
  , Evaluator(bound.Evaluator())
  , Guaranteed(mode == ErrorMode::Guaranteed)
{}

double FacetBound::Error(const Triangle& t, double limit)
{
  const Facet facet(t.X[0], t.X[1], t.X[2]);
  if (t.Pole < 0 && !this->Bound.CrossesCrease(BoxOf(t.UV)))
  {
    return this->Part(t, facet, t.UV, true, limit);
  }
  Vec2 from[3] = { t.UV[0], t.UV[1], t.UV[2] }; // Parameters between which each edge's curve runs.
  Vec2 to[3] = { t.UV[1], t.UV[2], t.UV[0] };
  double error = 0.0;
  if (t.Pole < 0)
  {
    error = this->Piece(t, facet, t.UV, limit);
  }
  else
  {
    // The region between the base and the pole's side.
    const Vec2& a = t.UV[(t.Pole + 1) % 3];
    const Vec2& b = t.UV[(t.Pole + 2) % 3];
    const int d = t.PoleDirection;
    Vec2& pa = from[t.Pole];
    Vec2& pb = to[(t.Pole + 2) % 3];
    pa[d] = a[d];
    pb[d] = b[d];
    error = this->Piece(t, facet, { pa, a, b }, limit);
    if (error <= limit)
    {
      error = std::max(error, this->Piece(t, facet, { pa, b, pb }, limit));
    }
  }
  for (int i = 0; i < 3 && error <= limit; ++i)
  {
    error = t.Boundary[i] ? error : std::max(error, this->EdgeError(t, facet, i, from[i], to[i]));
  }
  return error;
}

// What the triangle's corners tell.
void FacetBound::AddCorners(const Triangle& t, const Facet& facet, SampleDistance& samples) const
{
  for (int i = 0; i < 3; ++i)
  {
    samples.AddSlope(facet, t.Normal[i]);
    const Vec2& a = t.UV[i];
    const Vec2& b = t.UV[(i + 1) % 3];
    if (!t.Boundary[i] &&
      ((a[0] == b[0] && this->Bound.IsCrease(0, a[0])) ||
        (a[1] == b[1] && this->Bound.IsCrease(1, a[1]))))
    {
      samples.SetCrease();
    }
  }
}

// The edges' part of CombineError, for the curve between two parameter points.
double FacetBound::EdgeError(
  const Triangle& t, const Facet& facet, int edge, const Vec2& a, const Vec2& b)
{
  constexpr int Samples = 8;
  std::vector<double> ts;
  for (int i = 0; i <= Samples; ++i)
  {
    ts.push_back(double(i) / Samples);
  }
  for (int d = 0; d < 2; ++d)
  {
    for (double crease : this->Bound.Creases(d))
    {
      const double s = (crease - a[d]) / (b[d] - a[d]);
      if (s > 0.0 && s < 1.0)
      {
        ts.push_back(s);
      }
    }
  }
  SampleDistance samples;
  this->AddCorners(t, facet, samples);
  for (double s : ts)
  {
    const Vec2 p = a + s * (b - a);
    samples.Add(facet, this->Evaluator.Point(p[0], p[1]), edge);
  }
  if (!this->Guaranteed)
  {
    return samples.Largest();
  }
  const ParameterBox box{ std::min(a[0], b[0]), std::max(a[0], b[0]), std::min(a[1], b[1]),
    std::max(a[1], b[1]) };
  const Remainder rest(this->Bound.Over(box), box.A(), box.B(), facet);
  return CombineError(samples, rest, Samples);
}

// A part of the triangle's parameters, cut where it crosses creases.
double FacetBound::Piece(const Triangle& t, const Facet& facet, const Vec2 (&uv)[3], double limit)
{
  const ParameterBox box = BoxOf(uv);
  for (int d = 0; d < 2; ++d)
  {
    const double low = d == 0 ? box.U0 : box.V0;
    const double high = d == 0 ? box.U1 : box.V1;
    const double eps = NegligibleSpan * (high - low);
    for (double crease : this->Bound.Creases(d))
    {
      if (crease > low + eps && crease < high - eps)
      {
        return this->Cut(t, facet, uv, limit, d, crease);
      }
    }
  }
  return this->Part(t, facet, uv, false, limit);
}

// A part of the triangle's parameters between creases; `whole`: all of it, so that its corners are
// the triangle's.
double FacetBound::Part(
  const Triangle& t, const Facet& facet, const Vec2 (&uv)[3], bool whole, double limit)
{
  const ParameterBox box = BoxOf(uv);
  SampleDistance samples;
  if (whole)
  {
    samples.Height = samples.Outside = samples.Far = t.Gap;
    this->AddCorners(t, facet, samples);
  }
  else
  {
    samples.Slope = TooSteep;
    for (const Vec2& p : uv)
    {
      samples.Add(facet, this->Evaluator.Point(p[0], p[1]));
    }
  }
  Remainder rest(this->Bound.Over(box), box.A(), box.B(), facet);
  double error = CombineError(samples, rest, 1);
  rest.Height = facet.HasPlane() ? samples.Height + rest.Across : 1e300;
  if (error <= limit && this->Guaranteed)
  {
    return error;
  }
  for (int last = 1, k = 2; k > 0 && samples.Largest() <= limit;)
  {
    this->Sample(t, facet, uv, last, k, whole, samples);
    if (this->Guaranteed)
    {
      error = std::min(error, CombineError(samples, rest, k));
      if (error <= limit)
      {
        return error;
      }
      last = k;
      k = NextDensity(samples, rest, k, limit);
    }
    else if (k == 4 || !this->Bound.HasGridLineInside(box))
    {
      break;
    }
    else
    {
      last = k;
      k = 4;
    }
  }
  return this->Guaranteed && samples.Largest() <= limit ? error : samples.Largest();
}

// Adds the samples of a grid of k steps along each side that the grid of `last` steps does not have.
void FacetBound::Sample(const Triangle& t, const Facet& facet, const Vec2 (&uv)[3], int last, int k,
  bool whole, SampleDistance& samples)
{
  constexpr int Most = (DensestSamples + 1) * (DensestSamples + 2) / 2;
  Vec2 at[Most];
  std::fill_n(at, Most, Vec2(0.0, 0.0));
  int edge[Most];
  double points[3 * Most];
  int n = 0;
  for (int j = 0; j <= k; ++j)
  {
    for (int i = 0; i + j <= k; ++i)
    {
      if (i % (k / last) == 0 && j % (k / last) == 0)
      {
        continue;
      }
      at[n] = uv[0] + (uv[1] - uv[0]) * (double(i) / k) + (uv[2] - uv[0]) * (double(j) / k);
      edge[n] = !whole ? -1 : j == 0 ? 0 : i + j == k ? 1 : i == 0 ? 2 : -1;
      ++n;
    }
  }
  this->Evaluator.Batch(at, n, points, nullptr);
  for (int i = 0; i < n; ++i)
  {
    const bool inner = edge[i] >= 0 && !t.Boundary[edge[i]];
    samples.Add(facet, Eigen::Map<const Vec3>(points + 3 * i), inner ? edge[i] : -1);
  }
}

// The two sides of a crease, each for itself.
double FacetBound::Cut(
  const Triangle& t, const Facet& facet, const Vec2 (&uv)[3], double limit, int dir, double crease)
{
  // The corner that is alone on its side, and where the crease cuts its two edges.
  int alone = 0;
  for (int i = 0; i < 3; ++i)
  {
    const bool side = uv[i][dir] < crease;
    if (side != (uv[(i + 1) % 3][dir] < crease) && side != (uv[(i + 2) % 3][dir] < crease))
    {
      alone = i;
    }
  }
  const Vec2& a = uv[alone];
  const Vec2& b = uv[(alone + 1) % 3];
  const Vec2& c = uv[(alone + 2) % 3];
  const auto at = [&](const Vec2& end) {
    Vec2 p = a + (end - a) * ((crease - a[dir]) / (end[dir] - a[dir]));
    p[dir] = crease;
    return p;
  };
  const Vec2 ab = at(b);
  const Vec2 ac = at(c);
  double error = this->Piece(t, facet, { a, ab, ac }, limit);
  if (error <= limit)
  {
    error = std::max(error, this->Piece(t, facet, { ab, b, c }, limit));
  }
  return error <= limit ? std::max(error, this->Piece(t, facet, { ab, c, ac }, limit)) : error;
}

} // namespace nurbs
