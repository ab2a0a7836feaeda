// SPDX-License-Identifier: BSD-3-Clause
#include "Bezier.h"
#include "nurbsReference.h"

#include <gtest/gtest.h>

using namespace nurbs;

namespace
{

template <int D>
std::vector<Vec<D>> RandomPoints(reference::Random& random, int degree)
{
  std::vector<Vec<D>> points(degree + 1);
  for (Vec<D>& p : points)
  {
    for (int k = 0; k < D; ++k)
    {
      p[k] = random.Uniform(-1.0, 1.0);
    }
  }
  return points;
}

/// The sum of Bernstein polynomials in long double.
template <int D>
Vec<D> Bernstein(const std::vector<Vec<D>>& points, double t)
{
  const int n = static_cast<int>(points.size()) - 1;
  std::array<reference::Real, D> sum{};
  reference::Real binomial = 1.0L;
  for (int i = 0; i <= n; ++i)
  {
    const reference::Real b =
      binomial * std::pow(reference::Real(t), i) * std::pow(1.0L - t, n - i);
    for (int k = 0; k < D; ++k)
    {
      sum[k] += b * points[i][k];
    }
    binomial = binomial * (n - i) / (i + 1);
  }
  Vec<D> point;
  for (int k = 0; k < D; ++k)
  {
    point[k] = double(sum[k]);
  }
  return point;
}

template <int D>
void CheckEvaluationAndSplit()
{
  reference::Random random(21);
  for (int degree = 0; degree <= 2 * MaxDegree + 3; ++degree)
  {
    const std::vector<Vec<D>> points = RandomPoints<D>(random, degree);
    const double cut = random.Uniform(0.0, 1.0);
    std::vector<Vec<D>> left(degree + 1);
    std::vector<Vec<D>> right(degree + 1);
    SplitBezier<D>(points.data(), degree, cut, left.data(), right.data());
    for (double s : { 0.0, 0.3, 0.5, 0.9, 1.0 })
    {
      EXPECT_LT((DeCasteljau<D>(points.data(), degree, s) - Bernstein<D>(points, s)).norm(), 1e-14);
      EXPECT_LT((Bernstein<D>(left, s) - Bernstein<D>(points, cut * s)).norm(), 1e-14);
      EXPECT_LT(
        (Bernstein<D>(right, s) - Bernstein<D>(points, cut + (1.0 - cut) * s)).norm(), 1e-14);
    }
  }
}

} // namespace

TEST(Bezier, EvaluationAndSplit)
{
  CheckEvaluationAndSplit<1>();
  CheckEvaluationAndSplit<2>();
  CheckEvaluationAndSplit<3>();
  CheckEvaluationAndSplit<4>();
}

TEST(Bezier, ElevationIsExactAndReductionUndoesIt)
{
  reference::Random random(22);
  for (int degree = 0; degree < MaxDegree; ++degree)
  {
    const std::vector<Vec4> points = RandomPoints<4>(random, degree);
    const std::vector<Vec4> raised = ElevateBezier<4>(points);
    ASSERT_EQ(raised.size(), points.size() + 1);
    for (double s : { 0.0, 0.2, 0.7, 1.0 })
    {
      EXPECT_LT((Bernstein<4>(raised, s) - Bernstein<4>(points, s)).norm(), 1e-14);
    }
    double error = 1.0;
    const std::vector<Vec4> back = ReduceBezierOnce<4>(raised, error);
    ASSERT_EQ(back.size(), points.size());
    EXPECT_LT(error, 1e-14);
    for (double s : { 0.0, 0.2, 0.7, 1.0 })
    {
      EXPECT_LT((Bernstein<4>(back, s) - Bernstein<4>(points, s)).norm(), 1e-13);
    }
  }
}

TEST(Bezier, ManyElevationsReduceAgain)
{
  reference::Random random(23);
  for (int degree : { 1, 2, 3, 5 })
  {
    const std::vector<Vec3> points = RandomPoints<3>(random, degree);
    std::vector<Vec3> raised = points;
    while (raised.size() < 20)
    {
      raised = ElevateBezier<3>(raised);
    }
    const std::vector<Vec3> back = ReduceBezier<3>(raised, 1e-9);
    ASSERT_EQ(back.size(), points.size()) << "degree " << degree;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      EXPECT_LT((back[i] - points[i]).norm(), 1e-9);
    }
  }
}

TEST(Bezier, ReductionErrorBoundsTheDistance)
{
  reference::Random random(24);
  for (int degree = 1; degree <= 12; ++degree)
  {
    const std::vector<Vec2> points = RandomPoints<2>(random, degree);
    double error = 0.0;
    const std::vector<Vec2> reduced = ReduceBezierOnce<2>(points, error);
    double measured = 0.0;
    for (int i = 0; i <= 100; ++i)
    {
      const double s = i / 100.0;
      measured = std::max(measured, (Bernstein<2>(reduced, s) - Bernstein<2>(points, s)).norm());
    }
    EXPECT_GT(error, 0.0);
    EXPECT_LE(measured, error * (1.0 + 1e-12));
    EXPECT_EQ(ReduceBezier<2>(points, 1e-3 * error).size(), points.size()) << "lossy reduction";
  }
  double error = 0.0;
  EXPECT_THROW(ReduceBezierOnce<2>({ Vec2(0.0, 0.0) }, error), Error);
}

TEST(Bezier, PatchSplitsInBothDirections)
{
  reference::Random random(25);
  const Surface surface = random.Surface(3, 4, true, true, false, 0);
  const BezierPatch patch = ToBezier(surface.View()).at(0);
  for (int dir : { 0, 1 })
  {
    BezierPatch low;
    BezierPatch high;
    SplitBezierPatch(patch, dir, 0.3, low, high);
    const Interval whole = dir == 0 ? patch.U : patch.V;
    EXPECT_DOUBLE_EQ((dir == 0 ? low.U : low.V).Max, whole.Min + 0.3 * whole.Length());
    EXPECT_EQ((dir == 0 ? low.U : low.V).Max, (dir == 0 ? high.U : high.V).Min);
    for (const BezierPatch* half : { &low, &high })
    {
      for (double s : { 0.0, 0.4, 1.0 })
      {
        for (double t : { 0.0, 0.6, 1.0 })
        {
          std::vector<Vec4> row;
          for (int j = 0; j <= 4; ++j)
          {
            row.push_back(DeCasteljau<4>(half->Points.data() + 4 * j, 3, s));
          }
          const Vec4 h = DeCasteljau<4>(row.data(), 4, t);
          const Vec3 expected = reference::Point(
            surface.View(), half->U.Min + s * half->U.Length(), half->V.Min + t * half->V.Length());
          EXPECT_LT((h.head<3>() / h[3] - expected).norm(), 1e-13);
        }
      }
    }
  }
}
