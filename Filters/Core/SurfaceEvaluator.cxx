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

/// Calls a function template with the degree as a constant from 1 to 5 (the compiler unrolls its
/// loops), or -1 for any other.
#define NURBS_FOR_DEGREE(degree, function, arguments) \
  switch (degree)                                     \
  {                                                   \
    case 1:                                           \
      function<1> arguments;                          \
      break;                                          \
    case 2:                                           \
      function<2> arguments;                          \
      break;                                          \
    case 3:                                           \
      function<3> arguments;                          \
      break;                                          \
    case 4:                                           \
      function<4> arguments;                          \
      break;                                          \
    case 5:                                           \
      function<5> arguments;                          \
      break;                                          \
    default:                                          \
      function<-1> arguments;                         \
  }

namespace nurbs
{

/// What is precomputed for one parameter direction.
struct DirectionTables
{
  int Degree = 0;
  int Last = 0; ///< The last span of the domain that is not empty.
  const double* Knots = nullptr;
  /// Reciprocals of the knot differences of the Cox-de Boor recursion: for each span the
  /// degree (degree + 1) / 2 values in the order of their use.
  std::vector<double> Inverse;
  /// The domain in equal buckets, twice as many as spans: the span where each begins.
  std::vector<int> Buckets;
  double Min = 0.0;
  double BucketScale = 0.0; ///< Buckets a unit of the parameter.
  /// Squared length under which the derivative is looked at twice: a small fraction of the longest
  /// control vector of the derivative surface.
  double Suspicious = 0.0;
};

/// What all copies of an evaluator share.
struct SurfaceEvaluator::Tables
{
  std::vector<double> Net; ///< 4 homogeneous numbers a point, u fastest.
  bool Rational = false;
  DirectionTables Dir[2];
};

namespace
{

/// Derivatives under this fraction of their largest, and sines of the angle between the two under
/// it, go the careful way of nurbs::Normal. Only a cost: both ways agree where they meet.
constexpr double SuspiciousFraction = 1e-4;

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

/// FindSpan by table: a few steps from the first span of the parameter's bucket.
NURBS_INLINE int LookUpSpan(const DirectionTables& tables, double t)
{
  const double* knots = tables.Knots;
  const double place = (t - tables.Min) * tables.BucketScale;
  const double last = static_cast<double>(tables.Buckets.size() - 1);
  int span = tables.Buckets[static_cast<int>(place > 0.0 ? (place < last ? place : last) : 0.0)];
  while (span > tables.Degree && t < knots[span])
  {
    --span;
  }
  while (span < tables.Last && t >= knots[span + 1])
  {
    ++span;
  }
  while (!(knots[span] < knots[span + 1])) // before a domain that starts with a multiple knot
  {
    ++span;
  }
  return span;
}

/// Four lanes x, y, z, w of one point, or one coordinate of four points: two SSE registers or one of
/// AVX.
using Quad = double __attribute__((vector_size(32)));
using QuadMask = std::int64_t __attribute__((vector_size(32)));

NURBS_INLINE void Load(const double* from, Quad& to)
{
  std::memcpy(&to, from, sizeof(Quad));
}

NURBS_INLINE void Store(const Quad& from, double* to)
{
  std::memcpy(to, &from, sizeof(Quad));
}

/// Rows to columns.
NURBS_INLINE void Transpose(Quad (&m)[4])
{
  const Quad a = __builtin_shufflevector(m[0], m[1], 0, 4, 2, 6);
  const Quad b = __builtin_shufflevector(m[0], m[1], 1, 5, 3, 7);
  const Quad c = __builtin_shufflevector(m[2], m[3], 0, 4, 2, 6);
  const Quad d = __builtin_shufflevector(m[2], m[3], 1, 5, 3, 7);
  m[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
  m[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
  m[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
  m[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}

/// Basis functions N and first derivatives dN on one span: EvaluateBasis with the divisions done in
/// advance. P >= 0 is the degree at compile time; P = -1 takes it from `degree`.
template <int P>
NURBS_INLINE void SpanBasis(const double* knots, const double* inverse, int degree, double t,
  double* values, double* derivatives)
{
  const int p = P >= 0 ? P : degree;
  double N[P >= 0 ? P + 1 : MaxDegree + 1]; // local, to stay in registers
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
    values[r] = saved + (knots[r + 1] - t) * scaled;
    saved = (t - knots[r + 1 - p]) * scaled;
    derivatives[r] = slope - derivative;
    slope = derivative;
  }
  values[p] = saved;
  derivatives[p] = slope;
}

/// The inner sum of Balazs' equation (1) for one column of the net: the value, then the v
/// derivative.
template <int Q>
NURBS_INLINE void SumColumn(const double* column, std::int64_t stride, int degree, const double* N,
  const double* dN, double* sums)
{
  const int q = Q >= 0 ? Q : degree;
  Quad point;
  Load(column, point);
  Quad value = N[0] * point;
  Quad slope = dN[0] * point;
  for (int j = 1; j <= q; ++j)
  {
    Load(column + j * stride, point);
    value += N[j] * point;
    slope += dN[j] * point;
  }
  Store(value, sums);
  Store(slope, sums + 4);
}

/// The outer sum over the inner ones: H and, for normals, Hu and Hv.
template <int P>
NURBS_INLINE void SumRow(const double* sums, int degree, const double* N, const double* dN,
  bool derive, Quad& h, Quad& hu, Quad& hv)
{
  const int p = P >= 0 ? P : degree;
  Quad value;
  Quad slope;
  Load(sums, value);
  h = N[0] * value;
  if (derive)
  {
    Load(sums + 4, slope);
    hu = dN[0] * value;
    hv = N[0] * slope;
  }
  for (int i = 1; i <= p; ++i)
  {
    Load(sums + 8 * i, value);
    h += N[i] * value;
    if (derive)
    {
      Load(sums + 8 * i + 4, slope);
      hu += dN[i] * value;
      hv += N[i] * slope;
    }
  }
}

/// From H to the Cartesian points of four parameters, and from Hu, Hv to their normals. `careful`
/// lanes have to be done again.
template <bool Derive>
NURBS_INLINE void Project(const DirectionTables (&dir)[2], bool rational, Quad (&h)[4],
  Quad (&hu)[4], Quad (&hv)[4], Quad (&normal)[4], QuadMask& careful)
{
  Transpose(h);
  if (rational)
  {
    const Quad inverse = 1.0 / h[3];
    h[0] *= inverse;
    h[1] *= inverse;
    h[2] *= inverse;
  }
  if (!Derive)
  {
    return;
  }
  Transpose(hu);
  Transpose(hv);
  if (rational) // w times the derivatives, which the direction does not depend on
  {
    for (int k = 0; k < 3; ++k)
    {
      hu[k] -= hu[3] * h[k];
      hv[k] -= hv[3] * h[k];
    }
  }
  normal[0] = hu[1] * hv[2] - hu[2] * hv[1];
  normal[1] = hu[2] * hv[0] - hu[0] * hv[2];
  normal[2] = hu[0] * hv[1] - hu[1] * hv[0];
  const Quad su = hu[0] * hu[0] + hu[1] * hu[1] + hu[2] * hu[2];
  const Quad sv = hv[0] * hv[0] + hv[1] * hv[1] + hv[2] * hv[2];
  const Quad area = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
  const Quad natural = h[3] * h[3]; // 1 if not rational
  constexpr double sine = SuspiciousFraction * SuspiciousFraction;
  careful = ~((su > natural * dir[0].Suspicious) & (sv > natural * dir[1].Suspicious) &
    (area > sine * su * sv));
  Quad length;
  for (int k = 0; k < 4; ++k)
  {
    length[k] = std::sqrt(area[k]);
  }
  const Quad scale = 1.0 / length;
  for (int k = 0; k < 3; ++k)
  {
    normal[k] *= scale;
  }
}

/// xyz triples of `count` <= 4 points from their coordinates.
NURBS_INLINE void StoreTriples(Quad (&xyz)[4], int count, double* to)
{
  alignas(32) double lanes[3][4];
  for (int k = 0; k < 3; ++k)
  {
    Store(xyz[k], lanes[k]);
  }
  for (int n = 0; n < count; ++n)
  {
    to[3 * n] = lanes[0][n];
    to[3 * n + 1] = lanes[1][n];
    to[3 * n + 2] = lanes[2][n];
  }
}

} // namespace

/// The loops behind the public functions.
struct EvaluatorKernel
{
  /// Span and basis functions of direction `dir`, unless t is the last one again.
  template <int P>
  static NURBS_INLINE bool Seek(SurfaceEvaluator& e, int dir, double t)
  {
    if (t == e.Last[dir])
    {
      return false;
    }
    const DirectionTables& tables = e.Shared->Dir[dir];
    const int p = P >= 0 ? P : tables.Degree;
    const int span = LookUpSpan(tables, t);
    const double* inverse = tables.Inverse.data() + std::int64_t(span) * (p * (p + 1) / 2);
    SpanBasis<P>(tables.Knots + span, inverse, p, t, e.Basis[dir][0], e.Basis[dir][1]);
    e.Last[dir] = t;
    e.Span[dir] = span;
    return true;
  }

  /// The inner sums of the p + 1 columns at `start`.
  template <int Q>
  static NURBS_INLINE void SumColumns(SurfaceEvaluator& e, int start)
  {
    const int q = Q >= 0 ? Q : e.View.Degree[1];
    const int p = e.View.Degree[0];
    const std::int64_t stride = 4 * std::int64_t(e.View.Count[0]);
    const double* column =
      e.Shared->Net.data() + (e.Span[1] - q) * stride + 4 * std::int64_t(start);
    for (int i = 0; i <= p; ++i)
    {
      SumColumn<Q>(column + 4 * i, stride, q, e.Basis[1][0], e.Basis[1][1], e.Row + 8 * i);
    }
  }

  /// Everything that depends on v: the inner sums, if v or the span of u have changed.
  template <int Q>
  static NURBS_INLINE void StepV(SurfaceEvaluator& e, double v, bool newSpan)
  {
    if (Seek<Q>(e, 1, v) || newSpan)
    {
      SumColumns<Q>(e, e.RowStart);
    }
  }

  /// H, Hu and Hv at one parameter, with Balazs' coherence.
  template <bool Derive>
  static NURBS_INLINE void Sum(SurfaceEvaluator& e, const Vec2& uv, Quad& h, Quad& hu, Quad& hv)
  {
    const int p = e.View.Degree[0];
    NURBS_FOR_DEGREE(p, Seek, (e, 0, uv[0]))
    const int start = e.Span[0] - p;
    const bool newSpan = start != e.RowStart;
    e.RowStart = start;
    NURBS_FOR_DEGREE(e.View.Degree[1], StepV, (e, uv[1], newSpan))
    NURBS_FOR_DEGREE(p, SumRow, (e.Row, p, e.Basis[0][0], e.Basis[0][1], Derive, h, hu, hv))
  }

  /// Points and normals of up to four parameters from H, Hu and Hv.
  template <bool Derive>
  static NURBS_INLINE void Finish(const SurfaceEvaluator& e, const Vec2* uv, int count,
    Quad (&h)[4], Quad (&hu)[4], Quad (&hv)[4], double* points, double* normals)
  {
    Quad normal[4];
    QuadMask careful{};
    Project<Derive>(e.Shared->Dir, e.Shared->Rational, h, hu, hv, normal, careful);
    StoreTriples(h, count, points);
    if (Derive)
    {
      StoreTriples(normal, count, normals);
      if (careful[0] | careful[1] | careful[2] | careful[3])
      {
        for (int n = 0; n < count; ++n)
        {
          if (careful[n])
          {
            CarefulNormal(e.View, uv[n], normals + 3 * n);
          }
        }
      }
    }
  }

  static void CarefulNormal(const SurfaceView& surface, const Vec2& uv, double* normal)
  {
    Eigen::Map<Vec3> n(normal);
    n = Normal(surface, uv[0], uv[1]);
  }

  template <bool Derive>
  static NURBS_INLINE void Points(
    SurfaceEvaluator& e, const Vec2* uv, std::int64_t count, double* points, double* normals)
  {
    Quad h[4] = {};
    Quad hu[4] = {};
    Quad hv[4] = {};
    for (std::int64_t n = 0; n < count; n += 4)
    {
      const int some = static_cast<int>(std::min<std::int64_t>(4, count - n));
      for (int k = 0; k < some; ++k)
      {
        Sum<Derive>(e, uv[n + k], h[k], hu[k], hv[k]);
      }
      Finish<Derive>(
        e, uv + n, some, h, hu, hv, points + 3 * n, Derive ? normals + 3 * n : nullptr);
    }
  }

  /// What a column of a grid needs of u, and the row of inner sums that all of them share.
  struct GridPlan
  {
    int Width = 0;             ///< Numbers a column in Bases: values, then derivatives.
    std::vector<int> Starts;   ///< First column of the net, one a u.
    std::vector<double> Bases; ///< One u after the other.
    std::vector<int> Columns;  ///< The columns of the net that some u needs.
    std::vector<double> Sums;  ///< 8 numbers a column of the net.
  };

  static GridPlan PlanGrid(SurfaceEvaluator& e, ArrayView<double> us)
  {
    const int p = e.View.Degree[0];
    GridPlan plan;
    plan.Width = 2 * (p + 1);
    plan.Starts.resize(us.size());
    plan.Bases.resize(us.size() * plan.Width);
    plan.Sums.resize(8 * std::size_t(e.View.Count[0]));
    std::vector<bool> needed(e.View.Count[0], false);
    for (std::size_t i = 0; i < us.size(); ++i)
    {
      NURBS_FOR_DEGREE(p, Seek, (e, 0, us[i]))
      plan.Starts[i] = e.Span[0] - p;
      double* basis = plan.Bases.data() + i * plan.Width;
      std::copy(e.Basis[0][0], e.Basis[0][0] + p + 1, basis);
      std::copy(e.Basis[0][1], e.Basis[0][1] + p + 1, basis + p + 1);
      std::fill_n(needed.begin() + plan.Starts[i], p + 1, true);
    }
    for (int i = 0; i < e.View.Count[0]; ++i)
    {
      plan.Columns.insert(plan.Columns.end(), needed[i] ? 1 : 0, i);
    }
    return plan;
  }

  /// The inner sums of one row of the grid.
  template <int Q>
  static NURBS_INLINE void GridColumns(SurfaceEvaluator& e, double v, GridPlan& plan)
  {
    Seek<Q>(e, 1, v);
    const int q = Q >= 0 ? Q : e.View.Degree[1];
    const std::int64_t stride = 4 * std::int64_t(e.View.Count[0]);
    const double* row = e.Shared->Net.data() + (e.Span[1] - q) * stride;
    for (int i : plan.Columns)
    {
      SumColumn<Q>(row + 4 * i, stride, q, e.Basis[1][0], e.Basis[1][1], plan.Sums.data() + 8 * i);
    }
  }

  /// One row of the grid from its inner sums.
  template <int P>
  static NURBS_INLINE void GridRow(const SurfaceEvaluator& e, ArrayView<double> us, double v,
    const GridPlan& plan, double* points, double* normals)
  {
    const int p = P >= 0 ? P : e.View.Degree[0];
    Quad h[4] = {};
    Quad hu[4] = {};
    Quad hv[4] = {};
    Vec2 uv[4];
    for (std::size_t i = 0; i < us.size(); i += 4)
    {
      const int some = static_cast<int>(std::min<std::size_t>(4, us.size() - i));
      for (int k = 0; k < some; ++k)
      {
        const double* N = plan.Bases.data() + (i + k) * plan.Width;
        const double* sums = plan.Sums.data() + 8 * std::int64_t(plan.Starts[i + k]);
        SumRow<P>(sums, p, N, N + p + 1, normals != nullptr, h[k], hu[k], hv[k]);
        uv[k] = Vec2(us[i + k], v);
      }
      if (normals)
      {
        Finish<true>(e, uv, some, h, hu, hv, points + 3 * i, normals + 3 * i);
      }
      else
      {
        Finish<false>(e, uv, some, h, hu, hv, points + 3 * i, nullptr);
      }
    }
  }

  static void First(SurfaceEvaluator& e, const Vec2& uv, Vec4 (&h)[3][3]);
  static void Batch(
    SurfaceEvaluator& e, const Vec2* uv, std::int64_t count, double* points, double* normals);
  static void Grid(SurfaceEvaluator& e, ArrayView<double> us, ArrayView<double> vs, double* points,
    double* normals);
};

NURBS_MULTIVERSION
void EvaluatorKernel::First(SurfaceEvaluator& e, const Vec2& uv, Vec4 (&h)[3][3])
{
  Quad sum;
  Quad sumU;
  Quad sumV;
  Sum<true>(e, uv, sum, sumU, sumV);
  Store(sum, h[0][0].data());
  Store(sumU, h[1][0].data());
  Store(sumV, h[0][1].data());
}

NURBS_MULTIVERSION
void EvaluatorKernel::Batch(
  SurfaceEvaluator& e, const Vec2* uv, std::int64_t count, double* points, double* normals)
{
  if (normals)
  {
    Points<true>(e, uv, count, points, normals);
  }
  else
  {
    Points<false>(e, uv, count, points, normals);
  }
}

NURBS_MULTIVERSION
void EvaluatorKernel::Grid(
  SurfaceEvaluator& e, ArrayView<double> us, ArrayView<double> vs, double* points, double* normals)
{
  GridPlan plan = PlanGrid(e, us);
  for (std::size_t j = 0; j < vs.size(); ++j)
  {
    const std::size_t at = 3 * j * us.size();
    double* rowNormals = normals ? normals + at : nullptr;
    NURBS_FOR_DEGREE(e.View.Degree[1], GridColumns, (e, vs[j], plan))
    NURBS_FOR_DEGREE(e.View.Degree[0], GridRow, (e, us, vs[j], plan, points + at, rowNormals))
  }
  e.RowStart = -1; // Row does not belong to the last v any more
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
  EvaluatorKernel::Batch(*this, &uv, 1, point.data(), nullptr);
  return point;
}

SurfaceDerivatives SurfaceEvaluator::Derivatives(double u, double v, int order)
{
  if (order != 1)
  {
    return EvaluateDerivatives(this->View, u, v, order);
  }
  Vec4 h[3][3];
  EvaluatorKernel::First(*this, Vec2(u, v), h);
  return ProjectDerivatives(h, 1);
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
  EvaluatorKernel::Grid(*this, us, vs, points, normals);
}

} // namespace nurbs
