// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceEvaluator.h"

#include "EvaluatorKernel.h"
#include "Multiversion.h"

#include <limits>

namespace nurbs
{

namespace
{

/// The longest control vector of the derivative surface in direction `dir`.
double LongestControlVector(const SurfaceView& surface, int dir)
{
  const int p = surface.Degree[dir];
  const std::int64_t step = dir == 0 ? 1 : surface.Count[0];
  double longest = 0.0;
  for (int j = 0; j < surface.Count[1] - (dir == 1 ? 1 : 0); ++j)
  {
    for (int i = 0; i < surface.Count[0] - (dir == 0 ? 1 : 0); ++i)
    {
      const std::int64_t k = i + std::int64_t(j) * surface.Count[0];
      const int n = dir == 0 ? i : j;
      const double support = surface.Knots[dir][n + p + 1] - surface.Knots[dir][n + 1];
      if (support > 0.0)
      {
        const double length = (surface.Point(k + step) - surface.Point(k)).norm();
        longest = std::max(longest, p * length / support);
      }
    }
  }
  return longest;
}

DirectionTables MakeDirection(const SurfaceView& surface, int dir)
{
  DirectionTables tables;
  const KnotView knots = surface.Knots[dir];
  const int degree = surface.Degree[dir];
  const int count = surface.Count[dir];
  tables.Degree = degree;
  tables.Knots = knots.data();
  const Interval domain = Domain(knots, degree);
  tables.Last = FindSpan(knots, degree, domain.Max);
  const int each = degree * (degree + 1) / 2;
  tables.Inverse.assign(std::size_t(count) * each, 0.0);
  for (int k = degree; k < count; ++k)
  {
    double* to = tables.Inverse.data() + std::size_t(k) * each;
    for (int d = 1; d <= degree && knots[k] < knots[k + 1]; ++d)
    {
      for (int r = 0; r < d; ++r)
      {
        *to++ = 1.0 / (knots[k + r + 1] - knots[k + r + 1 - d]);
      }
    }
  }
  const int buckets = 2 * (count - degree);
  tables.Min = domain.Min;
  tables.BucketScale = buckets / domain.Length();
  tables.Buckets.resize(buckets);
  for (int b = 0; b < buckets; ++b)
  {
    tables.Buckets[b] = FindSpan(knots, degree, domain.Min + b / tables.BucketScale);
  }
  const double fraction = SuspiciousFraction * LongestControlVector(surface, dir);
  tables.Suspicious = fraction * fraction;
  return tables;
}

using Wide = EvaluatorKernel<WideLanes>;
using Narrow = EvaluatorKernel<NarrowLanes>;

NURBS_MULTIVERSION
void WideBatch(
  SurfaceEvaluator& e, const Vec2* uv, std::int64_t count, double* points, double* normals)
{
  Wide::Batch(e, uv, count, points, normals);
}

NURBS_MULTIVERSION
void WideGrid(
  SurfaceEvaluator& e, ArrayView<double> us, ArrayView<double> vs, double* points, double* normals)
{
  Wide::Grid(e, us, vs, points, normals);
}

NURBS_MULTIVERSION
void WideDerivatives(
  SurfaceEvaluator& e, ArrayView<double> us, ArrayView<double> vs, SurfaceDerivatives* out)
{
  Wide::DerivativesGrid(e, us, vs, out);
}

} // namespace

SurfaceEvaluator::SurfaceEvaluator(const SurfaceView& surface)
  : View(surface)
{
  auto tables = std::make_shared<Tables>();
  tables->Net.resize(4 * surface.Size());
  for (std::int64_t k = 0; k < surface.Size(); ++k)
  {
    const Vec4 h = surface.Homogeneous(k);
    std::copy(h.data(), h.data() + 4, tables->Net.data() + 4 * k);
  }
  tables->Rational = surface.Weights != nullptr;
  for (int dir = 0; dir < 2; ++dir)
  {
    tables->Dir[dir] = MakeDirection(surface, dir);
    this->Last[dir] = std::numeric_limits<double>::quiet_NaN();
    this->Span[dir] = surface.Degree[dir];
  }
  this->Shared = tables;
}

Vec3 SurfaceEvaluator::Point(double u, double v)
{
  const Vec2 uv(u, v);
  Vec3 point;
  this->Batch(&uv, 1, point.data(), nullptr);
  return point;
}

SurfaceDerivatives SurfaceEvaluator::Derivatives(double u, double v, int order)
{
  if (order < 1 || order > 2)
  {
    throw Error("derivatives of order " + std::to_string(order) + " are not available");
  }
  Vec4 h[3][3];
  const Vec2 uv(u, v);
  order == 2 ? Narrow::Second(*this, uv, h) : Narrow::First(*this, uv, h);
  return ProjectDerivatives(h, order);
}

void SurfaceEvaluator::PointAndNormal(double u, double v, Vec3& point, Vec3& normal)
{
  const Vec2 uv(u, v);
  this->Batch(&uv, 1, point.data(), normal.data());
}

void SurfaceEvaluator::Batch(const Vec2* uv, std::int64_t count, double* points, double* normals)
{
  HasWideClones() ? WideBatch(*this, uv, count, points, normals)
                  : Narrow::Batch(*this, uv, count, points, normals);
}

void SurfaceEvaluator::Grid(
  ArrayView<double> us, ArrayView<double> vs, double* points, double* normals)
{
  HasWideClones() ? WideGrid(*this, us, vs, points, normals)
                  : Narrow::Grid(*this, us, vs, points, normals);
}

void SurfaceEvaluator::DerivativesGrid(
  ArrayView<double> us, ArrayView<double> vs, SurfaceDerivatives* derivatives)
{
  HasWideClones() ? WideDerivatives(*this, us, vs, derivatives)
                  : Narrow::DerivativesGrid(*this, us, vs, derivatives);
}

} // namespace nurbs
