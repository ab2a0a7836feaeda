// SPDX-License-Identifier: BSD-3-Clause
#include "Curve.h"
#include "nurbsReference.h"

#include <gtest/gtest.h>

using namespace nurbs;

namespace
{

/// Curves of every degree from 1, clamped and not, some with breaks.
std::vector<Curve<3>> Curves()
{
  reference::Random random(31);
  std::vector<Curve<3>> curves;
  for (int degree = 1; degree <= MaxDegree; ++degree)
  {
    curves.push_back(random.Curve<3>(degree, true, degree % 3 == 0));
    curves.push_back(random.Curve<3>(degree, false, degree % 3 == 1));
  }
  return curves;
}

} // namespace

TEST(Curve, CircleIsRound)
{
  const Curve<2> circle = reference::Circle(2.5);
  const CurveView<2> view = circle.View();
  for (int i = 0; i <= 200; ++i)
  {
    Vec2 d[3];
    EvaluateDerivatives<2>(view, i / 200.0, 2, d);
    EXPECT_NEAR(d[0].norm(), 2.5, 1e-14);
    EXPECT_EQ(Evaluate<2>(view, i / 200.0), d[0]);
    EXPECT_NEAR(d[0].dot(d[1]) / d[1].norm(), 0.0, 1e-14);
    // The curvature |c' x c''| / |c'|^3 is 1 / radius everywhere.
    const double curvature = (d[1][0] * d[2][1] - d[1][1] * d[2][0]) / std::pow(d[1].norm(), 3);
    EXPECT_NEAR(curvature, 0.4, 1e-13);
  }
}

TEST(Curve, AgreesWithTheDefinition)
{
  reference::Random random(32);
  for (const Curve<3>& curve : Curves())
  {
    EXPECT_LT(reference::LargestDistance(curve.View(), curve.View(), random), 5e-14)
      << "degree " << curve.Degree;
  }
}

TEST(Curve, DerivativesAreLimitsOfDifferences)
{
  reference::Random random(33);
  const double h = 1e-6;
  for (const Curve<3>& curve : Curves())
  {
    const CurveView<3> view = curve.View();
    const std::vector<BezierCurve<3>> pieces = ToBezier<3>(view);
    for (const BezierCurve<3>& piece : pieces)
    {
      const double t = random.Uniform(piece.T0 + 2 * h, piece.T1 - 2 * h);
      Vec3 d[3], low[2], high[2];
      EvaluateDerivatives<3>(view, t, 2, d);
      EvaluateDerivatives<3>(view, t - h, 1, low);
      EvaluateDerivatives<3>(view, t + h, 1, high);
      EXPECT_LT(((high[0] - low[0]) / (2 * h) - d[1]).norm(), 1e-6 * (1.0 + d[1].norm()));
      EXPECT_LT(((high[1] - low[1]) / (2 * h) - d[2]).norm(), 1e-6 * (1.0 + d[2].norm()));
    }
  }
}

TEST(Curve, RewritingLeavesItUnchanged)
{
  reference::Random random(34);
  for (const Curve<3>& curve : Curves())
  {
    const CurveView<3> view = curve.View();
    const Interval domain = view.Domain();
    SCOPED_TRACE("degree " + std::to_string(curve.Degree));
    std::vector<double> add;
    for (int i = 0; i < 6; ++i)
    {
      add.push_back(random.Uniform(domain.Min, domain.Max));
    }
    std::sort(add.begin(), add.end());
    add.push_back(add.back());
    if (curve.Degree >= 2)
    {
      const Curve<3> refined = RefineKnots<3>(view, add);
      EXPECT_EQ(refined.Points.size(), curve.Points.size() + 7);
      EXPECT_EQ(refined.Knots.size(), curve.Knots.size() + 7);
      EXPECT_LT(reference::LargestDistance(view, refined.View(), random), 1e-13);
    }
    if (curve.Degree + 2 <= MaxDegree)
    {
      const Curve<3> raised = ElevateDegree<3>(view, 2);
      EXPECT_EQ(raised.Degree, curve.Degree + 2);
      EXPECT_EQ(CheckKnots(raised.Knots, raised.Degree, raised.Points.size()), "");
      EXPECT_LT(reference::LargestDistance(view, raised.View(), random), 1e-13);
    }
    const double cut = random.Uniform(domain.Min, domain.Max);
    const auto halves = Split<3>(view, cut);
    EXPECT_EQ(halves.first.View().Domain().Max, cut);
    EXPECT_EQ(halves.second.View().Domain().Min, cut);
    for (const Curve<3>* half : { &halves.first, &halves.second })
    {
      EXPECT_TRUE(IsClamped(half->Knots, half->Degree));
      EXPECT_LT(reference::LargestDistance(view, half->View(), random), 1e-13);
    }
    const double from = random.Uniform(domain.Min, cut);
    EXPECT_LT(reference::LargestDistance(view, Restrict<3>(view, from, cut).View(), random), 1e-13);
  }
}

TEST(Curve, SplitAtABreakKeepsBothSides)
{
  // Two separate lines in one curve of degree 1: the knot 1 has multiplicity 2.
  Curve<2> curve;
  curve.Knots = { 0, 0, 1, 1, 2, 2 };
  curve.Points = { Vec2(0, 0), Vec2(1, 0), Vec2(5, 5), Vec2(6, 5) };
  curve.Weights = { 1, 1, 1, 1 };
  curve.Pack();
  const auto halves = Split<2>(curve.View(), 1.0);
  ASSERT_EQ(halves.first.Points.size(), 2u);
  ASSERT_EQ(halves.second.Points.size(), 2u);
  EXPECT_EQ(halves.first.Points[1], Vec2(1, 0));
  EXPECT_EQ(halves.second.Points[0], Vec2(5, 5));
  const Curve<2> raised = ElevateDegree<2>(curve.View(), 1);
  EXPECT_EQ(raised.Knots, (std::vector<double>{ 0, 0, 0, 1, 1, 1, 2, 2, 2 }));
  EXPECT_EQ(Evaluate<2>(raised.View(), 1.0), Vec2(5, 5));
  EXPECT_EQ(ToBezier<2>(curve.View()).at(0).Points.back(), Vec3(1, 0, 1));
}

TEST(Curve, BezierPiecesCoverTheDomain)
{
  for (const Curve<3>& curve : Curves())
  {
    const CurveView<3> view = curve.View();
    const std::vector<BezierCurve<3>> pieces = ToBezier<3>(view);
    EXPECT_EQ(pieces.front().T0, view.Domain().Min);
    EXPECT_EQ(pieces.back().T1, view.Domain().Max);
    for (std::size_t k = 0; k < pieces.size(); ++k)
    {
      const BezierCurve<3>& piece = pieces[k];
      EXPECT_EQ(piece.Degree(), curve.Degree);
      if (k > 0)
      {
        EXPECT_EQ(piece.T0, pieces[k - 1].T1);
      }
      for (double s : { 0.0, 0.25, 0.8 })
      {
        const Vec3 expected = reference::Point<3>(view, piece.T0 + s * (piece.T1 - piece.T0));
        EXPECT_LT((piece.Evaluate(s) - expected).norm(), 1e-13);
      }
    }
  }
}

TEST(Curve, PeriodicCurveMeetsItself)
{
  // Unclamped uniform cubic whose last three points repeat the first three: C2 across the seam.
  reference::Random random(35);
  Curve<3> curve;
  curve.Degree = 3;
  for (int i = 0; i < 12; ++i)
  {
    curve.Knots.push_back(i);
  }
  for (int i = 0; i < 5; ++i)
  {
    curve.Points.push_back(
      Vec3(random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1)));
    curve.Weights.push_back(random.Uniform(0.5, 2.0));
  }
  for (int i = 0; i < 3; ++i)
  {
    curve.Points.push_back(curve.Points[i]);
    curve.Weights.push_back(curve.Weights[i]);
  }
  curve.Pack();
  const Interval domain = curve.View().Domain();
  EXPECT_EQ(domain.Min, 3.0);
  EXPECT_EQ(domain.Max, 8.0);
  const Curve<3> clamped = Restrict<3>(curve.View(), domain.Min, domain.Max);
  for (const CurveView<3>& view : { curve.View(), clamped.View() })
  {
    Vec3 first[3], last[3];
    EvaluateDerivatives<3>(view, domain.Min, 2, first);
    EvaluateDerivatives<3>(view, domain.Max, 2, last);
    for (int k = 0; k < 3; ++k)
    {
      EXPECT_LT((first[k] - last[k]).norm(), 1e-13) << "derivative " << k;
    }
  }
}

TEST(Curve, DegreeZeroIsAPoint)
{
  Curve<3> pole;
  pole.Degree = 0;
  pole.Knots = { 2, 5 };
  pole.Points = { Vec3(1, 2, 3) };
  pole.Weights = { 0.5 };
  pole.Pack();
  EXPECT_EQ(Evaluate<3>(pole.View(), 3.0), Vec3(1, 2, 3));
  Vec3 d[3];
  EvaluateDerivatives<3>(pole.View(), 4.0, 2, d);
  EXPECT_EQ(d[1], Vec3::Zero());
  EXPECT_EQ(d[2], Vec3::Zero());
  ASSERT_EQ(ToBezier<3>(pole.View()).size(), 1u);
  EXPECT_EQ(ToBezier<3>(pole.View())[0].Evaluate(0.3), Vec3(1, 2, 3));
  const Curve<3> raised = ElevateDegree<3>(pole.View(), 1);
  EXPECT_EQ(raised.Knots, (std::vector<double>{ 2, 2, 5, 5 }));
  EXPECT_EQ(Evaluate<3>(raised.View(), 3.0), Vec3(1, 2, 3));
  EXPECT_EQ(Restrict<3>(pole.View(), 3.0, 4.0).Knots, (std::vector<double>{ 3, 4 }));
}

TEST(Curve, MisuseIsRefused)
{
  Curve<2> curve = reference::Circle(1.0);
  const CurveView<2> view = curve.View();
  EXPECT_THROW(RefineKnots<2>(view, { -0.1 }), Error);
  EXPECT_THROW(RefineKnots<2>(view, { 0.6, 0.4 }), Error);
  EXPECT_THROW(RefineKnots<2>(view, { 0.25, 0.25 }), Error);
  EXPECT_THROW(RefineKnots<2>(view, { std::nan("") }), Error);
  EXPECT_THROW(Restrict<2>(view, 0.5, 0.5), Error);
  EXPECT_THROW(Restrict<2>(view, 0.5, 1.5), Error);
  EXPECT_THROW(Split<2>(view, 0.0), Error);
  EXPECT_THROW(ElevateDegree<2>(view, 24), Error);
  Vec2 d[4];
  EXPECT_THROW(EvaluateDerivatives<2>(view, 0.5, 3, d), Error);
  curve.Points.push_back(Vec2(0, 0));
  EXPECT_THROW(curve.View(), Error);
  EXPECT_THROW(curve.Pack(), Error);
}
