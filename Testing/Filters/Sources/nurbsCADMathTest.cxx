// SPDX-License-Identifier: BSD-3-Clause
// The mathematics of the CAD reader, without OpenCASCADE: parameters of arcs, fits, loops.
#include "CurveFit.h"
#include "ParameterMap.h"
#include "TrimLoops.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace nurbs;

namespace
{

constexpr double Pi = 3.14159265358979323846;

/// The arc as a curve of the library, whose evaluation is tested elsewhere.
Curve<2> ToCurve(const UnitArc& arc)
{
  Curve<2> curve;
  curve.Degree = 2;
  curve.Knots = arc.Knots;
  for (const Vec3& h : arc.Points)
  {
    curve.Points.emplace_back(h[0] / h[2], h[1] / h[2]);
    curve.Weights.push_back(h[2]);
  }
  curve.Pack();
  return curve;
}

} // namespace

TEST(ParameterMap, ArcsAreWhereTheMapSays)
{
  for (const double offset : { 0.0, 0.4, -1.1 })
  {
    for (const auto& [t0, t1] :
      { std::pair(0.0, 2.0 * Pi), std::pair(0.3, 0.7), std::pair(-5.0, 9.0), std::pair(1.5, 1.6) })
    {
      const ParameterMap map = ParameterMap::Circular(offset);
      const Curve<2> arc = ToCurve(MakeUnitArc(map, t0, t1));
      for (int k = 0; k <= 100; ++k)
      {
        const double t = t0 + (t1 - t0) * k / 100;
        const Vec2 p = Evaluate(arc.View(), arc.View().Domain().Clamp(map.Forward(t)));
        EXPECT_NEAR(p[0], std::cos(t), 5e-15);
        EXPECT_NEAR(p[1], std::sin(t), 5e-15);
        EXPECT_NEAR(map.Inverse(map.Forward(t)), t, 5e-15);
      }
    }
  }
}

TEST(ParameterMap, HyperbolasToo)
{
  const ParameterMap map = ParameterMap::Hyperbolic();
  const Curve<2> arc = ToCurve(MakeUnitArc(map, -2.3, 1.9));
  for (int k = 0; k <= 100; ++k)
  {
    const double t = -2.3 + 4.2 * k / 100;
    const Vec2 p = Evaluate(arc.View(), arc.View().Domain().Clamp(map.Forward(t)));
    EXPECT_NEAR(p[0], std::cosh(t), 1e-14 * std::cosh(t));
    EXPECT_NEAR(p[1], std::sinh(t), 1e-14 * std::cosh(t));
  }
}

TEST(ParameterMap, BreaksStayAndPeriodsCarryOver)
{
  const ParameterMap map = ParameterMap::Circular(0.2);
  for (int k = -5; k < 6; ++k)
  {
    const double t = 0.2 + k * Pi / 2;
    EXPECT_NEAR(map.Forward(t), t, 1e-14);
    EXPECT_NEAR(map.Forward(t + 0.7) - k * Pi / 2, map.Forward(0.9), 1e-14);
  }
  std::vector<double> breaks;
  map.AppendBreaks(0.2, 0.2 + 2.0 * Pi, breaks);
  EXPECT_EQ(breaks.size(), 3u);
  EXPECT_THROW(map.AppendBreaks(0.0, 1e9, breaks), Error);
  EXPECT_THROW(map.AppendBreaks(0.0, std::nan(""), breaks), Error);
}

TEST(ParameterMap, WidenLeavesNoSliver)
{
  const ParameterMap map = ParameterMap::Circular();
  const double quarter = Pi / 2;
  const Interval snapped = map.Widen({ 1e-13, 2.0 * Pi - 1e-13 });
  EXPECT_EQ(snapped.Min, 0.0);
  EXPECT_NEAR(snapped.Max, 2.0 * Pi, 1e-15);
  const Interval wide = map.Widen({ quarter - 1e-6, 1.0 + 2.0 * quarter });
  EXPECT_NEAR(wide.Min, quarter * (1.0 - 1e-3), 1e-12);
  EXPECT_EQ(wide.Max, 1.0 + 2.0 * quarter);
}

TEST(CurveFit, DeviationIsMeasuredAndKept)
{
  const std::function<Vec2(double)> wave = [](double t) {
    return Vec2(t + 0.1 * std::sin(5.0 * t), std::exp(0.3 * t));
  };
  for (const double tolerance : { 1e-3, 1e-6, 1e-9, 1e-12 })
  {
    double error = -1.0;
    const Curve<2> fit = FitCurve<2>(wave, { 0.0, 1.3, 4.0 }, Vec2(1.0, 1.0), tolerance, error);
    EXPECT_GE(error, 0.0);
    EXPECT_LE(error, tolerance);
    double worst = 0.0;
    for (int k = 0; k <= 5000; ++k)
    {
      const double t = 4.0 * k / 5000;
      worst = std::max(worst, (Evaluate(fit.View(), t) - wave(t)).norm());
    }
    EXPECT_LE(worst, 1.5 * tolerance);
  }
}

TEST(CurveFit, StraightLinesStayStraight)
{
  double error = -1.0;
  const Curve<2> fit = FitCurve<2>([](double t) { return Vec2(2.0 * t, 1.0 - t); },
    { 0.0, 0.5, 0.8, 3.0 }, Vec2(1.0, 1.0), 1e-12, error);
  EXPECT_EQ(fit.Degree, 1);
  EXPECT_EQ(fit.Points.size(), 2u);
}

TEST(CurveFit, AKinkOutsideTheBreaksIsReported)
{
  double error = 0.0;
  FitCurve<2>([](double t) { return Vec2(t, std::sqrt(std::abs(t - 1.0 / 3.0))); }, { 0.0, 1.0 },
    Vec2(1.0, 1.0), 1e-12, error);
  EXPECT_GT(error, 1e-6);
}

TEST(SurfaceFit, DeviationIsMeasuredAndKept)
{
  const auto hill = [](double u, double v) {
    return Vec3(u, v, std::sin(3.0 * u) * std::cos(2.0 * v));
  };
  double error = -1.0;
  const Surface fit = FitSurface(hill, { 0.0, 2.0 }, { 0.0, 1.0, 3.0 }, 1e-9, error);
  EXPECT_LE(error, 1e-9);
  for (int k = 0; k < 2500; ++k)
  {
    const double u = 2.0 * (k % 50) / 49;
    const double v = 3.0 * (k / 50) / 49;
    EXPECT_LT((Evaluate(fit.View(), u, v) - hill(u, v)).norm(), 3e-9);
  }
}

// Four curves of a torus: all ends are one vertex, and the same point but for periods.
TEST(TrimLoops, TorusSeamsAreFollowedInThePlane)
{
  const double p = 2.0 * Pi;
  const std::vector<TrimEnds> ends{ { Vec2(0, 0), Vec2(p, 0), 0, 0 },
    { Vec2(p, p), Vec2(0, p), 0, 0 }, { Vec2(p, 0), Vec2(p, p), 0, 0 },
    { Vec2(0, p), Vec2(0, 0), 0, 0 } };
  const std::vector<OrderedLoop> loops = OrderLoops(ends, Vec2(p, p));
  ASSERT_EQ(loops.size(), 1u);
  const std::size_t order[] = { 0, 2, 1, 3 };
  for (std::size_t i = 0; i < 4; ++i)
  {
    EXPECT_EQ(loops[0].Items[i].Index, order[i]);
    EXPECT_EQ(loops[0].Items[i].Shift, Vec2(0, 0));
  }
}

TEST(TrimLoops, CurvesAPeriodAwayAreBroughtBack)
{
  const double p = 2.0 * Pi;
  const std::vector<TrimEnds> ends{ { Vec2(6, 0), Vec2(7, 0), 0, 1 },
    { Vec2(7 - p, 0), Vec2(7 - p, 1), 1, 2 }, { Vec2(7, 1), Vec2(6, 0), 2, 0 } };
  const std::vector<OrderedLoop> loops = OrderLoops(ends, Vec2(p, 0.0));
  ASSERT_EQ(loops.size(), 1u);
  ASSERT_EQ(loops[0].Items.size(), 3u);
  EXPECT_NEAR(loops[0].Items[1].Shift[0], p, 1e-15);
  EXPECT_EQ(loops[0].Items[2].Shift[0], 0.0);
}

TEST(TrimLoops, OneWireMayHoldTwoLoops)
{
  const std::vector<TrimEnds> ends{ { Vec2(0, 0), Vec2(0, 0), 0, 0 },
    { Vec2(5, 5), Vec2(6, 5), 1, 2 }, { Vec2(6, 5), Vec2(5, 5), 2, 1 } };
  const std::vector<OrderedLoop> loops = OrderLoops(ends, Vec2(0, 0));
  ASSERT_EQ(loops.size(), 2u);
  EXPECT_EQ(loops[1].Items.size(), 2u);
}

TEST(TrimLoops, CrossingsAreFound)
{
  std::vector<double> crossings;
  AppendCrossings([](double x) { return 3.0 * x; }, { 0.1, 2.0 }, 0.5, 2.0, crossings);
  ASSERT_EQ(crossings.size(), 3u);
  EXPECT_NEAR(crossings[0], 0.5 / 3.0, 1e-14);
  EXPECT_NEAR(crossings[2], 4.5 / 3.0, 1e-14);
  EXPECT_THROW(
    AppendCrossings([](double x) { return 1e9 * x; }, { 0.0, 1.0 }, 0.0, 1.0, crossings), Error);
}
