// SPDX-License-Identifier: BSD-3-Clause
/// @file EvaluatorKernel.h
/// @brief The loops behind SurfaceEvaluator, for registers of any width. Internal.
///
/// Equation (1) of Balazs, Guthe, Klein 2004 with the coherence of their section 8: StepV and Seek are
/// what can be left out. Everything is inlined into one function for each instruction set, see
/// SurfaceEvaluator.cxx.
#pragma once

#include "Lanes.h"
#include "SurfaceEvaluator.h"

#include <algorithm>

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

/// Derivatives under this fraction of their largest, and sines of the angle between the two under
/// it, go the careful way of nurbs::Normal. Only a cost: both ways agree where they meet.
constexpr double SuspiciousFraction = 1e-4;

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

/// Second derivatives of the basis functions on one span: two differences of those of degree - 2.
inline void SpanSecondDerivatives(const DirectionTables& tables, int span, double t, double* values)
{
  const int p = tables.Degree;
  const double* knots = tables.Knots + span;
  const double* inverse = tables.Inverse.data() + std::int64_t(span) * (p * (p + 1) / 2);
  values[0] = p < 2 ? 0.0 : 1.0;
  for (int d = 1; d <= p; ++d)
  {
    double saved = 0.0;
    for (int r = 0; r < d; ++r)
    {
      const double scaled = values[r] * *inverse++;
      values[r] = d > p - 2 ? saved - d * scaled : saved + (knots[r + 1] - t) * scaled;
      saved = d > p - 2 ? d * scaled : (t - knots[r + 1 - d]) * scaled;
    }
    values[d] = saved;
  }
}

/// The inner sum of Balazs' equation (1) for one column of the net: the value, then the v
/// derivative.
template <typename Quad, int Q>
NURBS_INLINE void SumColumn(const double* column, std::int64_t stride, int degree, const double* N,
  const double* dN, double* sums)
{
  const int q = Q >= 0 ? Q : degree;
  Quad point = Quad::Load(column);
  Quad value = N[0] * point;
  Quad slope = dN[0] * point;
  for (int j = 1; j <= q; ++j)
  {
    point = Quad::Load(column + j * stride);
    value = value + N[j] * point;
    slope = slope + dN[j] * point;
  }
  value.Store(sums);
  slope.Store(sums + 4);
}

/// The outer sum over the inner ones: H and, for normals, Hu and Hv.
template <typename Quad, int P>
NURBS_INLINE void SumRow(const double* sums, int degree, const double* N, const double* dN,
  bool derive, Quad& h, Quad& hu, Quad& hv)
{
  const int p = P >= 0 ? P : degree;
  Quad value = Quad::Load(sums);
  Quad slope = Quad::Load(sums + 4);
  h = N[0] * value;
  if (derive)
  {
    hu = dN[0] * value;
    hv = N[0] * slope;
  }
  for (int i = 1; i <= p; ++i)
  {
    value = Quad::Load(sums + 8 * i);
    h = h + N[i] * value;
    if (derive)
    {
      slope = Quad::Load(sums + 8 * i + 4);
      hu = hu + dN[i] * value;
      hv = hv + N[i] * slope;
    }
  }
}

/// From H to the Cartesian points of four parameters, and from Hu, Hv to their normals. Returns which
/// of the four need the careful way, one bit each.
template <typename Quad>
NURBS_INLINE int Project(const DirectionTables (&dir)[2], bool rational, bool derive, Quad (&h)[4],
  Quad (&hu)[4], Quad (&hv)[4], Quad (&normal)[4])
{
  Quad::Transpose(h);
  if (rational)
  {
    const Quad inverse = Quad::Reciprocal(h[3]);
    h[0] = h[0] * inverse;
    h[1] = h[1] * inverse;
    h[2] = h[2] * inverse;
  }
  if (!derive)
  {
    return 0;
  }
  Quad::Transpose(hu);
  Quad::Transpose(hv);
  if (rational) // w times the derivatives, which the direction does not depend on
  {
    for (int k = 0; k < 3; ++k)
    {
      hu[k] = hu[k] - hu[3] * h[k];
      hv[k] = hv[k] - hv[3] * h[k];
    }
  }
  normal[0] = hu[1] * hv[2] - hu[2] * hv[1];
  normal[1] = hu[2] * hv[0] - hu[0] * hv[2];
  normal[2] = hu[0] * hv[1] - hu[1] * hv[0];
  const Quad area = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
  const Quad su = hu[0] * hu[0] + hu[1] * hu[1] + hu[2] * hu[2];
  const Quad sv = hv[0] * hv[0] + hv[1] * hv[1] + hv[2] * hv[2];
  const Quad weight = h[3] * h[3]; // 1 if not rational
  const Quad scale = ReciprocalRoot(area);
  for (int k = 0; k < 3; ++k)
  {
    normal[k] = normal[k] * scale;
  }
  constexpr double sine = SuspiciousFraction * SuspiciousFraction;
  std::int64_t safe[4];
  Quad::Positive(su - dir[0].Suspicious * weight, sv - dir[1].Suspicious * weight,
    area - sine * (su * sv), safe);
  int careful = 0;
  if ((safe[0] & safe[1] & safe[2] & safe[3]) == 0)
  {
    for (int n = 0; n < 4; ++n)
    {
      careful |= (safe[n] != 0 ? 0 : 1) << n;
    }
  }
  return careful;
}

/// xyz triples of `count` <= 4 points from their coordinates.
template <typename Quad>
NURBS_INLINE void StoreTriples(const Quad (&xyz)[4], int count, double* to)
{
  double lanes[3][4];
  for (int k = 0; k < 3; ++k)
  {
    xyz[k].Store(lanes[k]);
  }
  for (int n = 0; n < count; ++n)
  {
    to[3 * n] = lanes[0][n];
    to[3 * n + 1] = lanes[1][n];
    to[3 * n + 2] = lanes[2][n];
  }
}

/// The loops behind the public functions.
template <typename Quad>
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
      SumColumn<Quad, Q>(column + 4 * i, stride, q, e.Basis[1][0], e.Basis[1][1], e.Row + 8 * i);
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

  /// The outer sum from the evaluator's inner ones.
  template <int P>
  static NURBS_INLINE void Outer(
    const SurfaceEvaluator& e, int p, bool derive, Quad& h, Quad& hu, Quad& hv)
  {
    SumRow<Quad, P>(e.Row, p, e.Basis[0][0], e.Basis[0][1], derive, h, hu, hv);
  }

  /// H and, to `derive`, Hu and Hv at one parameter, with Balazs' coherence.
  static NURBS_INLINE void Sum(
    SurfaceEvaluator& e, const Vec2& uv, bool derive, Quad& h, Quad& hu, Quad& hv)
  {
    const int p = e.View.Degree[0];
    NURBS_FOR_DEGREE(p, Seek, (e, 0, uv[0]))
    const int start = e.Span[0] - p;
    const bool newSpan = start != e.RowStart;
    e.RowStart = start;
    NURBS_FOR_DEGREE(e.View.Degree[1], StepV, (e, uv[1], newSpan))
    NURBS_FOR_DEGREE(p, Outer, (e, p, derive, h, hu, hv))
  }

  static void CarefulNormal(const SurfaceView& surface, const Vec2& uv, double* normal)
  {
    Eigen::Map<Vec3> n(normal);
    n = Normal(surface, uv[0], uv[1]);
  }

  /// Points and, unless `normals` is null, normals of up to four parameters from H, Hu and Hv.
  static NURBS_INLINE void Finish(const SurfaceEvaluator& e, const Vec2* uv, int count,
    Quad (&h)[4], Quad (&hu)[4], Quad (&hv)[4], double* points, double* normals)
  {
    Quad normal[4];
    const bool derive = normals != nullptr;
    const int careful = Project(e.Shared->Dir, e.Shared->Rational, derive, h, hu, hv, normal);
    StoreTriples(h, count, points);
    if (derive)
    {
      StoreTriples(normal, count, normals);
    }
    for (int n = 0; careful != 0 && n < count; ++n)
    {
      if (careful >> n & 1)
      {
        CarefulNormal(e.View, uv[n], normals + 3 * n);
      }
    }
  }

  /// Any parameters, one after the other. `derive` says again whether there are normals, as a
  /// constant for the compiler.
  static NURBS_INLINE void Points(SurfaceEvaluator& e, const Vec2* uv, std::int64_t count,
    bool derive, double* points, double* normals)
  {
    Quad h[4] = {};
    Quad hu[4] = {};
    Quad hv[4] = {};
    for (std::int64_t n = 0; n < count; n += 4)
    {
      const int some = static_cast<int>(std::min<std::int64_t>(4, count - n));
      for (int k = 0; k < some; ++k)
      {
        Sum(e, uv[n + k], derive, h[k], hu[k], hv[k]);
      }
      Finish(e, uv + n, some, h, hu, hv, points + 3 * n, derive ? normals + 3 * n : nullptr);
    }
  }

  using GridPlan = SurfaceEvaluator::GridPlan;

  static void PlanGrid(SurfaceEvaluator& e, ArrayView<double> us)
  {
    const int p = e.View.Degree[0];
    GridPlan& plan = e.Plan;
    plan.Width = 2 * (p + 1);
    plan.Starts.resize(us.size());
    plan.Bases.resize(us.size() * plan.Width);
    int first = e.View.Count[0];
    int last = 0;
    for (std::size_t i = 0; i < us.size(); ++i)
    {
      NURBS_FOR_DEGREE(p, Seek, (e, 0, us[i]))
      plan.Starts[i] = e.Span[0] - p;
      first = std::min(first, plan.Starts[i]);
      last = std::max(last, plan.Starts[i] + p + 1);
      double* basis = plan.Bases.data() + i * plan.Width;
      std::copy(e.Basis[0][0], e.Basis[0][0] + p + 1, basis);
      std::copy(e.Basis[0][1], e.Basis[0][1] + p + 1, basis + p + 1);
    }
    // Only the columns between the first and the last one are looked at, and counted from the first.
    plan.First = us.size() > 0 ? first : 0;
    const std::size_t columns = us.size() > 0 ? std::size_t(last - first) : 0;
    plan.Sums.resize(8 * columns);
    plan.Needed.assign(columns, 0);
    for (int& start : plan.Starts)
    {
      start -= plan.First;
      std::fill_n(plan.Needed.begin() + start, p + 1, 1);
    }
    plan.Columns.clear();
    for (std::size_t i = 0; i < columns; ++i)
    {
      if (plan.Needed[i])
      {
        plan.Columns.push_back(int(i));
      }
    }
  }

  /// The inner sums of one row of the grid.
  template <int Q>
  static NURBS_INLINE void GridColumns(SurfaceEvaluator& e, double v)
  {
    GridPlan& plan = e.Plan;
    Seek<Q>(e, 1, v);
    const int q = Q >= 0 ? Q : e.View.Degree[1];
    const std::int64_t stride = 4 * std::int64_t(e.View.Count[0]);
    const double* row = e.Shared->Net.data() + (e.Span[1] - q) * stride + 4 * plan.First;
    for (int i : plan.Columns)
    {
      SumColumn<Quad, Q>(
        row + 4 * i, stride, q, e.Basis[1][0], e.Basis[1][1], plan.Sums.data() + 8 * i);
    }
  }

  /// H, Hu and Hv of up to four neighbours in a row of the grid, from its inner sums.
  template <int P>
  static NURBS_INLINE void GridSums(const GridPlan& plan, std::size_t i, int count, int p,
    bool derive, Quad (&h)[4], Quad (&hu)[4], Quad (&hv)[4])
  {
    for (int k = 0; k < count; ++k)
    {
      const double* N = plan.Bases.data() + (i + k) * plan.Width;
      const double* sums = plan.Sums.data() + 8 * std::int64_t(plan.Starts[i + k]);
      SumRow<Quad, P>(sums, p, N, N + plan.Width / 2, derive, h[k], hu[k], hv[k]);
    }
  }

  /// One row of the grid.
  static NURBS_INLINE void GridRow(
    const SurfaceEvaluator& e, ArrayView<double> us, double v, double* points, double* normals)
  {
    const bool derive = normals != nullptr;
    const int p = e.View.Degree[0];
    Quad h[4] = {};
    Quad hu[4] = {};
    Quad hv[4] = {};
    Vec2 uv[4];
    for (std::size_t i = 0; i < us.size(); i += 4)
    {
      const int some = static_cast<int>(std::min<std::size_t>(4, us.size() - i));
      for (int k = 0; k < some; ++k)
      {
        uv[k] = Vec2(us[i + k], v);
      }
      NURBS_FOR_DEGREE(p, GridSums, (e.Plan, i, some, p, derive, h, hu, hv))
      Finish(e, uv, some, h, hu, hv, points + 3 * i, derive ? normals + 3 * i : nullptr);
    }
  }

  /// What the second derivatives on a grid need in addition to PlanGrid.
  static void PlanBends(SurfaceEvaluator& e, ArrayView<double> us)
  {
    const int p = e.View.Degree[0];
    e.Plan.Bends.resize(us.size() * (p + 1));
    e.Plan.BendSums.resize(e.Plan.Sums.size() / 2);
    for (std::size_t i = 0; i < us.size(); ++i)
    {
      const int span = e.Plan.Starts[i] + e.Plan.First + p;
      SpanSecondDerivatives(e.Shared->Dir[0], span, us[i], e.Plan.Bends.data() + i * (p + 1));
    }
  }

  /// The inner sums of second v derivatives of one row of the grid.
  static NURBS_INLINE void BendColumns(SurfaceEvaluator& e, double v)
  {
    const int q = e.View.Degree[1];
    double bends[MaxDegree + 1];
    SpanSecondDerivatives(e.Shared->Dir[1], e.Span[1], v, bends);
    const std::int64_t stride = 4 * std::int64_t(e.View.Count[0]);
    const double* row = e.Shared->Net.data() + (e.Span[1] - q) * stride + 4 * e.Plan.First;
    for (int i : e.Plan.Columns)
    {
      Quad sum = bends[0] * Quad::Load(row + 4 * i);
      for (int j = 1; j <= q; ++j)
      {
        sum = sum + bends[j] * Quad::Load(row + 4 * i + j * stride);
      }
      sum.Store(e.Plan.BendSums.data() + 4 * i);
    }
  }

  /// The homogeneous derivatives to order 2 at one place of a row of the grid, from its inner sums.
  template <int P>
  static NURBS_INLINE void BendRow(const GridPlan& plan, std::size_t i, int degree, Vec4 (&h)[3][3])
  {
    const int p = P >= 0 ? P : degree;
    const double* N = plan.Bases.data() + i * plan.Width;
    const double* dN = N + p + 1;
    const double* ddN = plan.Bends.data() + i * (p + 1);
    const double* sums = plan.Sums.data() + 8 * std::int64_t(plan.Starts[i]);
    const double* bends = plan.BendSums.data() + 4 * std::int64_t(plan.Starts[i]);
    Quad value;
    Quad u;
    Quad v;
    SumRow<Quad, P>(sums, p, N, dN, true, value, u, v);
    Quad uu = ddN[0] * Quad::Load(sums);
    Quad uv = dN[0] * Quad::Load(sums + 4);
    Quad vv = N[0] * Quad::Load(bends);
    for (int k = 1; k <= p; ++k)
    {
      uu = uu + ddN[k] * Quad::Load(sums + 8 * k);
      uv = uv + dN[k] * Quad::Load(sums + 8 * k + 4);
      vv = vv + N[k] * Quad::Load(bends + 4 * k);
    }
    value.Store(h[0][0].data());
    u.Store(h[1][0].data());
    v.Store(h[0][1].data());
    uu.Store(h[2][0].data());
    uv.Store(h[1][1].data());
    vv.Store(h[0][2].data());
  }

  /// The homogeneous point and first derivatives; see ProjectDerivatives.
  static NURBS_INLINE void First(SurfaceEvaluator& e, const Vec2& uv, Vec4 (&h)[3][3])
  {
    Quad sum;
    Quad sumU;
    Quad sumV;
    Sum(e, uv, true, sum, sumU, sumV);
    sum.Store(h[0][0].data());
    sumU.Store(h[1][0].data());
    sumV.Store(h[0][1].data());
  }

  /// The second derivatives in addition.
  static void Second(SurfaceEvaluator& e, const Vec2& uv, Vec4 (&h)[3][3])
  {
    First(e, uv, h);
    const int p = e.View.Degree[0];
    const int q = e.View.Degree[1];
    double d2[2][MaxDegree + 1];
    for (int dir = 0; dir < 2; ++dir)
    {
      SpanSecondDerivatives(e.Shared->Dir[dir], e.Span[dir], uv[dir], d2[dir]);
    }
    const std::int64_t stride = 4 * std::int64_t(e.View.Count[0]);
    const double* column =
      e.Shared->Net.data() + (e.Span[1] - q) * stride + 4 * std::int64_t(e.RowStart);
    Quad uu = {};
    Quad mixed = {};
    Quad vv = {};
    for (int i = 0; i <= p; ++i)
    {
      uu = uu + d2[0][i] * Quad::Load(e.Row + 8 * i);
      mixed = mixed + e.Basis[0][1][i] * Quad::Load(e.Row + 8 * i + 4);
      Quad inner = d2[1][0] * Quad::Load(column + 4 * i);
      for (int j = 1; j <= q; ++j)
      {
        inner = inner + d2[1][j] * Quad::Load(column + 4 * i + j * stride);
      }
      vv = vv + e.Basis[0][0][i] * inner;
    }
    uu.Store(h[2][0].data());
    mixed.Store(h[1][1].data());
    vv.Store(h[0][2].data());
  }

  static NURBS_INLINE void Batch(
    SurfaceEvaluator& e, const Vec2* uv, std::int64_t count, double* points, double* normals)
  {
    if (normals)
    {
      Points(e, uv, count, true, points, normals);
    }
    else
    {
      Points(e, uv, count, false, points, normals);
    }
  }

  static NURBS_INLINE void Grid(SurfaceEvaluator& e, ArrayView<double> us, ArrayView<double> vs,
    double* points, double* normals)
  {
    PlanGrid(e, us);
    for (std::size_t j = 0; j < vs.size(); ++j)
    {
      const std::size_t at = 3 * j * us.size();
      double* rowNormals = normals ? normals + at : nullptr;
      NURBS_FOR_DEGREE(e.View.Degree[1], GridColumns, (e, vs[j]))
      GridRow(e, us, vs[j], points + at, rowNormals);
    }
    e.RowStart = -1; // Row does not belong to the last v any more
  }

  static NURBS_INLINE void DerivativesGrid(
    SurfaceEvaluator& e, ArrayView<double> us, ArrayView<double> vs, SurfaceDerivatives* out)
  {
    PlanGrid(e, us);
    PlanBends(e, us);
    Vec4 h[3][3];
    for (double v : vs)
    {
      NURBS_FOR_DEGREE(e.View.Degree[1], GridColumns, (e, v))
      BendColumns(e, v);
      for (std::size_t i = 0; i < us.size(); ++i)
      {
        NURBS_FOR_DEGREE(e.View.Degree[0], BendRow, (e.Plan, i, e.View.Degree[0], h))
        *out++ = ProjectDerivatives(h, 2);
      }
    }
    e.RowStart = -1;
  }
};

} // namespace nurbs
