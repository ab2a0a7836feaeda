// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceEvaluator.h"

#include "Basis.h"
#include "Multiversion.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#if defined(__GNUC__)
#define NURBS_INLINE inline __attribute__((always_inline))
#else
#define NURBS_INLINE inline
#endif

namespace nurbs
{

/// What all copies of an evaluator share.
struct SurfaceEvaluator::Tables
{
  std::vector<double> Net; ///< 4 homogeneous numbers a point, u fastest.
  bool Rational = false;
  /// Reciprocals of the knot differences of the Cox-de Boor recursion: for each span the
  /// degree (degree + 1) / 2 values in the order of their use.
  std::vector<double> Inverse[2];
  /// Squared length under which a derivative is looked at twice: a small fraction of the longest
  /// control vector of the derivative surface.
  double Suspicious[2] = { 0.0, 0.0 };
};

namespace
{

/// Derivatives under this fraction of their largest, and angles under this fraction of a right one,
/// go the careful way of nurbs::Normal. Only a cost: both ways agree where they meet.
constexpr double SuspiciousFraction = 1e-4;

std::vector<double> InverseDifferences(KnotView knots, int degree)
{
  const int spans = static_cast<int>(knots.size()) - degree - 1;
  const int each = degree * (degree + 1) / 2;
  std::vector<double> inverse(std::size_t(spans) * each, 0.0);
  for (int k = degree; k < spans; ++k)
  {
    if (!(knots[k] < knots[k + 1]))
    {
      continue;
    }
    double* to = inverse.data() + std::size_t(k) * each;
    for (int d = 1; d <= degree; ++d)
    {
      for (int r = 0; r < d; ++r)
      {
        *to++ = 1.0 / (knots[k + r + 1] - knots[k + r + 1 - d]);
      }
    }
  }
  return inverse;
}

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
        longest =
          std::max(longest, p * (surface.Point(k + step) - surface.Point(k)).norm() / support);
      }
    }
  }
  return longest;
}

/// Four lanes x, y, z, w: two SSE registers or one of AVX.
#if defined(__GNUC__)
using Quad = double __attribute__((vector_size(32)));
#else
using Quad = Eigen::Array4d;
#endif

NURBS_INLINE void Load(const double* from, Quad& to)
{
  std::memcpy(&to, from, sizeof(Quad));
}

NURBS_INLINE void Store(const Quad& from, double* to)
{
  std::memcpy(to, &from, sizeof(Quad));
}

/// Basis functions N and first derivatives dN on one span: EvaluateBasis with the divisions done in
/// advance. P >= 0 is the degree at compile time; P = -1 takes it from `degree`.
template <int P>
NURBS_INLINE void SpanBasis(
  const double* knots, const double* inverse, int degree, double t, double* N, double* dN)
{
  const int p = P >= 0 ? P : degree;
  N[0] = 1.0;
  for (int d = 1; d < p; ++d)
  {
    double saved = 0.0;
    for (int r = 0; r < d; ++r)
    {
      const double scaled = N[r] * *inverse++;
      N[r] = saved + (knots[r + 1] - t) * scaled;
      saved = (t - knots[r + 1 - d]) * scaled;
    }
    N[d] = saved;
  }
  double saved = 0.0;
  double slope = 0.0;
  for (int r = 0; r < p; ++r)
  {
    const double scaled = N[r] * *inverse++;
    const double derivative = p * scaled;
    N[r] = saved + (knots[r + 1] - t) * scaled;
    saved = (t - knots[r + 1 - p]) * scaled;
    dN[r] = slope - derivative;
    slope = derivative;
  }
  N[p] = saved;
  dN[p] = slope;
}

/// The inner sum of Balazs' equation (1) for one column of the net, values and v derivatives.
template <int Q, bool Derive>
NURBS_INLINE void SumColumn(const double* column, std::int64_t stride, int degree, const double* N,
  const double* dN, double* value, double* slope)
{
  const int q = Q >= 0 ? Q : degree;
  Quad point;
  Load(column, point);
  Quad sum = N[0] * point;
  Quad derivative = dN[0] * point;
  for (int j = 1; j <= q; ++j)
  {
    Load(column + j * stride, point);
    sum += N[j] * point;
    if (Derive)
    {
      derivative += dN[j] * point;
    }
  }
  Store(sum, value);
  if (Derive)
  {
    Store(derivative, slope);
  }
}

/// The outer sum: H and, for normals, Hu and Hv from the inner sums.
template <int P, bool Derive>
NURBS_INLINE void SumRow(const double* row, const double* slopes, int degree, const double* N,
  const double* dN, double* h, double* hu, double* hv)
{
  const int p = P >= 0 ? P : degree;
  Quad value;
  Quad slope;
  Load(row, value);
  Quad sum = N[0] * value;
  Quad sumU = dN[0] * value;
  Quad sumV = sum;
  if (Derive)
  {
    Load(slopes, slope);
    sumV = N[0] * slope;
  }
  for (int i = 1; i <= p; ++i)
  {
    Load(row + 4 * i, value);
    sum += N[i] * value;
    if (Derive)
    {
      Load(slopes + 4 * i, slope);
      sumU += dN[i] * value;
      sumV += N[i] * slope;
    }
  }
  Store(sum, h);
  if (Derive)
  {
    Store(sumU, hu);
    Store(sumV, hv);
  }
}

} // namespace

/// The loops behind the public functions.
struct EvaluatorKernel
{
  /// From H (and Hu, Hv) to the Cartesian point (and normal): the only place that divides.
  template <bool Derive>
  static NURBS_INLINE void Project(const SurfaceEvaluator& e, double u, double v, const double* h,
    double* hu, double* hv, double* point, double* normal)
  {
    const SurfaceEvaluator::Tables& tables = *e.Shared;
    const double inverse = tables.Rational ? 1.0 / h[3] : 1.0;
    for (int k = 0; k < 3; ++k)
    {
      point[k] = h[k] * inverse;
    }
    if (!Derive)
    {
      return;
    }
    if (tables.Rational)
    {
      for (int k = 0; k < 3; ++k)
      {
        hu[k] = (hu[k] - hu[3] * point[k]) * inverse;
        hv[k] = (hv[k] - hv[3] * point[k]) * inverse;
      }
    }
    const double cross[3] = { hu[1] * hv[2] - hu[2] * hv[1], hu[2] * hv[0] - hu[0] * hv[2],
      hu[0] * hv[1] - hu[1] * hv[0] };
    const double su = hu[0] * hu[0] + hu[1] * hu[1] + hu[2] * hu[2];
    const double sv = hv[0] * hv[0] + hv[1] * hv[1] + hv[2] * hv[2];
    const double area = cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2];
    constexpr double sine = SuspiciousFraction * SuspiciousFraction;
    if (su > tables.Suspicious[0] && sv > tables.Suspicious[1] && area > sine * su * sv)
    {
      const double scale = 1.0 / std::sqrt(area);
      for (int k = 0; k < 3; ++k)
      {
        normal[k] = cross[k] * scale;
      }
      return;
    }
    CarefulNormal(e.View, u, v, normal);
  }

  static void CarefulNormal(const SurfaceView& surface, double u, double v, double* normal)
  {
    Eigen::Map<Vec3> n(normal);
    n = Normal(surface, u, v);
  }

  /// Span and basis functions of direction `dir`, unless t is the last one again.
  template <int P>
  static NURBS_INLINE bool Seek(SurfaceEvaluator& e, int dir, double t)
  {
    if (t == e.Last[dir])
    {
      return false;
    }
    const SurfaceView& view = e.View;
    const int degree = P >= 0 ? P : view.Degree[dir];
    const double* knots = view.Knots[dir].data();
    int span = e.Span[dir];
    if (!(knots[span] <= t && t < knots[span + 1]))
    {
      span = FindSpan(view.Knots[dir], view.Degree[dir], t);
    }
    const double* inverse =
      e.Shared->Inverse[dir].data() + std::int64_t(span) * (degree * (degree + 1) / 2);
    SpanBasis<P>(knots + span, inverse, degree, t, e.Basis[dir][0], e.Basis[dir][1]);
    e.Last[dir] = t;
    e.Span[dir] = span;
    return true;
  }

  template <int P, int Q, bool Derive>
  static NURBS_INLINE void Points(
    SurfaceEvaluator& e, const Vec2* uv, std::int64_t count, double* points, double* normals)
  {
    const int p = P >= 0 ? P : e.View.Degree[0];
    const int q = Q >= 0 ? Q : e.View.Degree[1];
    const std::int64_t stride = 4 * std::int64_t(e.View.Count[0]);
    const double* net = e.Shared->Net.data();
    alignas(32) double h[3][4];
    for (std::int64_t n = 0; n < count; ++n)
    {
      const double u = uv[n][0];
      const double v = uv[n][1];
      const bool newV = Seek<Q>(e, 1, v);
      Seek<P>(e, 0, u);
      const int start = e.Span[0] - p;
      if (newV || start != e.RowStart)
      {
        const double* column = net + (e.Span[1] - q) * stride + 4 * std::int64_t(start);
        for (int i = 0; i <= p; ++i)
        {
          SumColumn<Q, true>(
            column + 4 * i, stride, q, e.Basis[1][0], e.Basis[1][1], e.Row[0][i], e.Row[1][i]);
        }
        e.RowStart = start;
      }
      SumRow<P, Derive>(
        e.Row[0][0], e.Row[1][0], p, e.Basis[0][0], e.Basis[0][1], h[0], h[1], h[2]);
      Project<Derive>(
        e, u, v, h[0], h[1], h[2], points + 3 * n, Derive ? normals + 3 * n : nullptr);
    }
  }

  template <int P, int Q>
  static NURBS_INLINE void Points(
    SurfaceEvaluator& e, const Vec2* uv, std::int64_t count, double* points, double* normals)
  {
    if (normals)
    {
      Points<P, Q, true>(e, uv, count, points, normals);
    }
    else
    {
      Points<P, Q, false>(e, uv, count, points, normals);
    }
  }

  static void Batch(
    SurfaceEvaluator& e, const Vec2* uv, std::int64_t count, double* points, double* normals);
};

NURBS_MULTIVERSION
void EvaluatorKernel::Batch(
  SurfaceEvaluator& e, const Vec2* uv, std::int64_t count, double* points, double* normals)
{
  Points<-1, -1>(e, uv, count, points, normals);
}

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
    tables->Inverse[dir] = InverseDifferences(surface.Knots[dir], surface.Degree[dir]);
    const double fraction = SuspiciousFraction * LongestControlVector(surface, dir);
    tables->Suspicious[dir] = fraction * fraction;
    this->Last[dir] = std::numeric_limits<double>::quiet_NaN();
    this->Span[dir] = surface.Degree[dir];
  }
  this->Shared = tables;
}

Vec3 SurfaceEvaluator::Point(double u, double v)
{
  const Vec2 uv(u, v);
  Vec3 point;
  EvaluatorKernel::Batch(*this, &uv, 1, point.data(), nullptr);
  return point;
}

SurfaceDerivatives SurfaceEvaluator::Derivatives(double u, double v, int order)
{
  return EvaluateDerivatives(this->View, u, v, order);
}

void SurfaceEvaluator::PointAndNormal(double u, double v, Vec3& point, Vec3& normal)
{
  const Vec2 uv(u, v);
  EvaluatorKernel::Batch(*this, &uv, 1, point.data(), normal.data());
}

void SurfaceEvaluator::Batch(const Vec2* uv, std::int64_t count, double* points, double* normals)
{
  EvaluatorKernel::Batch(*this, uv, count, points, normals);
}

void SurfaceEvaluator::Grid(
  ArrayView<double> us, ArrayView<double> vs, double* points, double* normals)
{
  std::vector<Vec2> row(us.size());
  for (std::size_t j = 0; j < vs.size(); ++j)
  {
    for (std::size_t i = 0; i < us.size(); ++i)
    {
      row[i] = Vec2(us[i], vs[j]);
    }
    const std::size_t at = 3 * j * us.size();
    this->Batch(row.data(), static_cast<std::int64_t>(us.size()), points + at,
      normals ? normals + at : nullptr);
  }
}

} // namespace nurbs
