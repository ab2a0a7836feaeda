// SPDX-License-Identifier: BSD-3-Clause
// Trim curves in 3D and their polylines: every bound against dense sampling, counts against closed
// forms, lifted curves against direct evaluation.
#include "TrimCurves.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>

namespace
{

using nurbs::BezierCurve;
using nurbs::CurveMeasure;
using nurbs::CurveOptions;
using nurbs::CurveSubdivision;
using nurbs::Vec2;
using nurbs::Vec3;
using nurbs::Vec4;

using Pieces = std::vector<BezierCurve<3>>;

double SegmentDistance(const Vec3& p, const Vec3& a, const Vec3& b)
{
  const Vec3 d = b - a;
  const double length2 = d.squaredNorm();
  const double s = length2 > 0.0 ? std::min(1.0, std::max(0.0, (p - a).dot(d) / length2)) : 0.0;
  return (p - a - s * d).norm();
}

Vec3 At(const Pieces& pieces, double t)
{
  std::size_t k = 0;
  while (k + 1 < pieces.size() && t > pieces[k].T1)
  {
    ++k;
  }
  return pieces[k].Evaluate((t - pieces[k].T0) / (pieces[k].T1 - pieces[k].T0));
}

/// The largest distance of curve points from their chord.
double MeasuredError(const Pieces& pieces, const std::vector<double>& parameters, int samples = 64)
{
  double worst = 0.0;
  for (std::size_t i = 1; i < parameters.size(); ++i)
  {
    const Vec3 a = At(pieces, parameters[i - 1]);
    const Vec3 b = At(pieces, parameters[i]);
    for (int k = 1; k < samples; ++k)
    {
      const double t = parameters[i - 1] + (parameters[i] - parameters[i - 1]) * k / samples;
      worst = std::max(worst, SegmentDistance(At(pieces, t), a, b));
    }
  }
  return worst;
}

BezierCurve<3> RandomPiece(std::mt19937& random, int degree, bool rational)
{
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  BezierCurve<3> piece;
  for (int i = 0; i <= degree; ++i)
  {
    const double w = rational ? 0.2 + 4.0 * unit(random) : 1.0;
    piece.Points.push_back(Vec4(w * unit(random), w * unit(random), w * unit(random), w));
  }
  return piece;
}

/// A circle of radius r about c in the plane of x and y (unit, perpendicular), as four rational arcs.
Pieces Circle(const Vec3& c, const Vec3& x, const Vec3& y, double r)
{
  const double h = std::sqrt(0.5);
  Pieces pieces;
  const Vec3 axes[5] = { x, y, -x, -y, x };
  for (int k = 0; k < 4; ++k)
  {
    BezierCurve<3> arc;
    arc.T0 = k;
    arc.T1 = k + 1;
    const Vec3 ends[3] = { c + r * axes[k], c + r * (axes[k] + axes[k + 1]), c + r * axes[k + 1] };
    const double weights[3] = { 1.0, h, 1.0 };
    for (int i = 0; i < 3; ++i)
    {
      Vec4 p;
      p << weights[i] * ends[i], weights[i];
      arc.Points.push_back(p);
    }
    pieces.push_back(arc);
  }
  return pieces;
}

/// A smooth cubic spline with uneven knots through random points.
Pieces RandomSpline(unsigned seed, int count)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  nurbs::Curve<3> curve;
  curve.Degree = 3;
  curve.Knots.assign(4, 0.0);
  for (int i = 1; i < count - 3; ++i)
  {
    curve.Knots.push_back(curve.Knots.back() + 0.2 + unit(random));
  }
  curve.Knots.insert(curve.Knots.end(), 4, curve.Knots.back() + 0.5);
  for (int i = 0; i < count; ++i)
  {
    curve.Points.push_back(Vec3(i + unit(random), 2.0 * unit(random), unit(random)));
    curve.Weights.push_back(0.5 + unit(random));
  }
  curve.Pack();
  return ToBezier(curve.View());
}

Pieces Reverse(const Pieces& pieces)
{
  Pieces out(pieces.rbegin(), pieces.rend());
  for (BezierCurve<3>& piece : out)
  {
    std::reverse(piece.Points.begin(), piece.Points.end());
    const double t0 = piece.T0;
    piece.T0 = -piece.T1;
    piece.T1 = -t0;
  }
  return out;
}

CurveOptions AsThePaper(CurveSubdivision subdivision, CurveMeasure measure, bool simplify)
{
  CurveOptions options;
  options.Subdivision = subdivision;
  options.Measure = measure;
  options.Simplify = simplify;
  options.Balanced = false;
  return options;
}

TEST(ChordDeviation, BoundsDenseSamples)
{
  std::mt19937 random(4);
  for (int k = 0; k < 600; ++k)
  {
    const BezierCurve<3> piece = RandomPiece(random, 1 + k % 12, k % 2 == 1);
    const double measured = MeasuredError({ piece }, { 0.0, 1.0 }, 400);
    for (CurveMeasure measure : { CurveMeasure::Line, CurveMeasure::Point })
    {
      const double bound = ChordDeviation(piece, measure);
      ASSERT_GE(bound, measured - 1e-14) << "degree " << piece.Degree();
      if (piece.Degree() == 1)
      {
        ASSERT_LT(bound, 1e-14);
      }
    }
    ASSERT_LE(ChordDeviation(piece, CurveMeasure::Line),
      ChordDeviation(piece, CurveMeasure::Point) + 1e-14);
  }
}

TEST(ChordDeviation, IsAttainedByArcsAndParabolas)
{
  const double r = 3.0;
  const Pieces circle = Circle(Vec3(1, 2, 3), Vec3::UnitX(), Vec3::UnitZ(), r);
  EXPECT_NEAR(ChordDeviation(circle[1], CurveMeasure::Line), r * (1.0 - std::sqrt(0.5)), 1e-14);
  std::vector<Vec4> parabola = { Vec4(0, 0, 0, 1), Vec4(1, 2, 0, 1), Vec4(2, 0, 0, 1) };
  for (int degree = 2; degree < 10; ++degree)
  {
    BezierCurve<3> piece;
    piece.Points = parabola;
    EXPECT_NEAR(ChordDeviation(piece, CurveMeasure::Line), 1.0, 1e-13) << degree;
    parabola = nurbs::ElevateBezier<4>(parabola);
  }
}

TEST(ChordDeviation, CountsWhatPassesTheChordsEnds)
{
  BezierCurve<3> piece; // runs back and forth on a line, 1 beyond its end
  piece.Points = { Vec4(0, 0, 0, 1), Vec4(6, 0, 0, 1), Vec4(2, 0, 0, 1) };
  const double measured = MeasuredError({ piece }, { 0.0, 1.0 }, 2000);
  EXPECT_GT(measured, 1.5);
  EXPECT_GE(ChordDeviation(piece, CurveMeasure::Line), measured);
}

TEST(ApproximateCurve, StaysWithinTheToleranceWithEveryOption)
{
  for (unsigned seed = 0; seed < 12; ++seed)
  {
    const Pieces pieces = RandomSpline(seed, 8 + int(seed));
    for (double tolerance : { 0.3, 0.02, 1e-3, 1e-5 })
    {
      for (int k = 0; k < 16; ++k)
      {
        CurveOptions options;
        options.Subdivision = k & 1 ? CurveSubdivision::Midpoint : CurveSubdivision::Arbitrary;
        options.Measure = k & 2 ? CurveMeasure::Line : CurveMeasure::Point;
        options.Simplify = k & 4;
        options.Balanced = k & 8;
        double certified = -1.0;
        const std::vector<double> t = ApproximateCurve(pieces, tolerance, options, certified);
        ASSERT_EQ(t.front(), pieces.front().T0);
        ASSERT_EQ(t.back(), pieces.back().T1);
        for (std::size_t i = 1; i < t.size(); ++i)
        {
          ASSERT_LT(t[i - 1], t[i]);
        }
        ASSERT_LE(certified, tolerance * (1.0 + 1e-12));
        ASSERT_LE(MeasuredError(pieces, t), certified * (1.0 + 1e-9) + 1e-13)
          << seed << ' ' << tolerance << ' ' << k;
      }
    }
  }
}

TEST(ApproximateCurve, GivesCirclesTheFewestAndEqualSegments)
{
  const Vec3 x = Vec3(1, 2, 3).normalized();
  const Vec3 y = x.unitOrthogonal();
  for (double tolerance : { 0.3, 0.03, 1e-2, 1e-3, 2e-4, 1e-5 })
  {
    const double r = 2.5;
    const int fewest =
      std::max(3, int(std::ceil(std::acos(-1.0) / std::acos(1.0 - tolerance / r))));
    for (const Pieces& circle : { Circle(Vec3(0, 0, 0), x, y, r), Circle(Vec3(7, -3, 2), y, x, r) })
    {
      double certified = 0.0;
      const std::vector<double> t = ApproximateCurve(circle, tolerance, CurveOptions(), certified);
      ASSERT_EQ(int(t.size()) - 1, fewest) << tolerance;
      double shortest = 1e9;
      double longest = 0.0;
      for (std::size_t i = 1; i < t.size(); ++i)
      {
        const double length = (At(circle, t[i]) - At(circle, t[i - 1])).norm();
        shortest = std::min(shortest, length);
        longest = std::max(longest, length);
      }
      ASSERT_LT(longest, 1.1 * shortest) << tolerance;
    }
  }
}

TEST(ApproximateCurve, IsMirroredWhenTheCurveIs)
{
  for (unsigned seed = 0; seed < 6; ++seed)
  {
    const Pieces pieces =
      seed == 0 ? Circle(Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), 1.0) : RandomSpline(seed, 12);
    const Pieces mirror = Reverse(pieces);
    for (double tolerance : { 0.05, 1e-3 })
    {
      double certified = 0.0;
      const std::vector<double> t = ApproximateCurve(pieces, tolerance, CurveOptions(), certified);
      const std::vector<double> m = ApproximateCurve(mirror, tolerance, CurveOptions(), certified);
      ASSERT_EQ(t.size(), m.size()) << seed << ' ' << tolerance;
      for (std::size_t i = 0; i < t.size(); ++i)
      {
        ASSERT_NEAR(t[i], -m[m.size() - 1 - i], 1e-9)
          << seed << ' ' << tolerance << ' ' << i << ' ' << t.size();
      }
    }
  }
}

TEST(ApproximateCurve, GivesStraightStretchesOneSegmentAndKeepsCorners)
{
  Pieces lines; // two collinear pieces, the second cubic, then a corner
  lines.push_back({ 0.0, 1.0, { Vec4(0, 0, 0, 1), Vec4(1, 0, 0, 1) } });
  lines.push_back(
    { 1.0, 3.0, { Vec4(1, 0, 0, 1), Vec4(1.2, 0, 0, 1), Vec4(4, 0, 0, 2), Vec4(3, 0, 0, 1) } });
  lines.push_back({ 3.0, 4.0, { Vec4(3, 0, 0, 1), Vec4(3, 0.001, 0, 1) } });
  CurveOptions options;
  for (bool balanced : { true, false })
  {
    options.Balanced = balanced;
    double certified = 1.0;
    const std::vector<double> t = ApproximateCurve(lines, 0.01, options, certified);
    EXPECT_EQ(t, (std::vector<double>{ 0.0, 3.0, 4.0 })) << balanced;
    EXPECT_LT(certified, 1e-15);
  }
}

TEST(ApproximateCurve, LeavesPointsAloneAndClosedCurvesOpen)
{
  double certified = 1.0;
  const Pieces point = { { 0.0, 1.0, { Vec4(2, 2, 2, 2), Vec4(1, 1, 1, 1) } } };
  EXPECT_EQ(
    ApproximateCurve(point, 0.01, CurveOptions(), certified), (std::vector<double>{ 0.0, 1.0 }));
  EXPECT_EQ(certified, 0.0);
  CurveOptions options;
  for (bool balanced : { true, false })
  {
    options.Balanced = balanced;
    const Pieces circle = Circle(Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), 1e-3);
    EXPECT_GE(ApproximateCurve(circle, 1.0, options, certified).size(), 4u);
  }
}

TEST(ApproximateCurve, EndsForTolerancesBeneathRoundOff)
{
  double certified = 0.0;
  const Pieces pieces = RandomSpline(3, 6);
  const std::vector<double> t = ApproximateCurve(pieces, 1e-300, CurveOptions(), certified);
  EXPECT_LE(t.size(), 400000u);
  EXPECT_GT(certified, 1e-300);
}

TEST(ApproximateCurve, RefusesWhatItCannotTake)
{
  double certified = 0.0;
  EXPECT_THROW(ApproximateCurve({}, 1.0, CurveOptions(), certified), nurbs::Error);
  BezierCurve<3> high;
  high.Points.assign(65, Vec4(0, 0, 0, 1));
  EXPECT_THROW(ApproximateCurve({ high }, 1.0, CurveOptions(), certified), nurbs::Error);
}

TEST(ApproximateCurve, BalancedNeedsFewerVerticesThanThePaper)
{
  // Every method on the same curves; the figures are printed.
  struct Method
  {
    const char* Name;
    CurveOptions Options;
    int Segments;
    double Seconds;
  } methods[] = {
    { "midpoint, point", AsThePaper(CurveSubdivision::Midpoint, CurveMeasure::Point, false), 0, 0 },
    { "midpoint, line", AsThePaper(CurveSubdivision::Midpoint, CurveMeasure::Line, false), 0, 0 },
    { "midpoint, line, simplified",
      AsThePaper(CurveSubdivision::Midpoint, CurveMeasure::Line, true), 0, 0 },
    { "arbitrary, point", AsThePaper(CurveSubdivision::Arbitrary, CurveMeasure::Point, false), 0,
      0 },
    { "arbitrary, line", AsThePaper(CurveSubdivision::Arbitrary, CurveMeasure::Line, false), 0, 0 },
    { "arbitrary, line, simplified",
      AsThePaper(CurveSubdivision::Arbitrary, CurveMeasure::Line, true), 0, 0 },
    { "balanced", CurveOptions(), 0, 0 },
  };
  std::vector<Pieces> curves;
  for (unsigned seed = 0; seed < 40; ++seed)
  {
    curves.push_back(RandomSpline(seed, 10));
    const double r = 0.5 + 0.1 * seed;
    curves.push_back(Circle(Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), r));
  }
  for (Method& method : methods)
  {
    const auto start = std::chrono::steady_clock::now();
    for (const Pieces& curve : curves)
    {
      for (double tolerance : { 1e-2, 1e-3, 1e-4 })
      {
        double certified = 0.0;
        method.Segments +=
          int(ApproximateCurve(curve, tolerance, method.Options, certified).size()) - 1;
      }
    }
    method.Seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::printf("%-30s %7d segments, %.2f us a segment\n", method.Name, method.Segments,
      1e6 * method.Seconds / method.Segments);
  }
  const int balanced = methods[6].Segments;
  for (int k = 0; k < 6; ++k)
  {
    EXPECT_LT(balanced, methods[k].Segments) << methods[k].Name;
  }
  EXPECT_LT(balanced, 0.9 * methods[2].Segments);
}

nurbs::Surface RandomSurface(std::mt19937& random, int p, int q, int m, int n, bool rational)
{
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  nurbs::Surface surface;
  surface.Degree[0] = p;
  surface.Degree[1] = q;
  surface.Count[0] = m;
  surface.Count[1] = n;
  surface.Knots[0] = nurbs::UniformKnots(p, m);
  surface.Knots[1] = nurbs::UniformKnots(q, n);
  for (int j = 0; j < n; ++j)
  {
    for (int i = 0; i < m; ++i)
    {
      surface.Points.push_back(Vec3(i + unit(random), j + unit(random), unit(random)));
      if (rational)
      {
        surface.Weights.push_back(0.3 + 2.0 * unit(random));
      }
    }
  }
  return surface;
}

nurbs::Curve<2> RandomTrim(std::mt19937& random, int degree, int count, bool rational)
{
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  nurbs::Curve<2> curve;
  curve.Degree = degree;
  curve.Knots = nurbs::UniformKnots(degree, count);
  for (int i = 0; i < count; ++i)
  {
    curve.Points.push_back(Vec2(unit(random), unit(random)));
    curve.Weights.push_back(rational ? 0.4 + unit(random) : 1.0);
  }
  curve.Pack();
  return curve;
}

/// The largest distance between the lifted curve and the surface at the trim curve's points.
double LiftError(const nurbs::Surface& surface, const nurbs::Curve<2>& trim, const Pieces& lifted)
{
  double worst = 0.0;
  for (std::size_t k = 0; k < lifted.size(); ++k)
  {
    EXPECT_LE(lifted[k].Degree(), nurbs::MaxPieceDegree);
    for (const Vec4& h : lifted[k].Points)
    {
      EXPECT_GT(h[3], 0.0);
    }
    if (k > 0)
    {
      EXPECT_EQ(lifted[k - 1].T1, lifted[k].T0);
    }
    for (int i = 0; i <= 20; ++i)
    {
      const double s = i / 20.0;
      const double t = lifted[k].T0 + s * (lifted[k].T1 - lifted[k].T0);
      const Vec2 uv = Evaluate(trim.View(), t);
      worst =
        std::max(worst, (lifted[k].Evaluate(s) - Evaluate(surface.View(), uv[0], uv[1])).norm());
    }
  }
  return worst;
}

TEST(LiftTrimCurve, IsExact)
{
  std::mt19937 random(11);
  for (int k = 0; k < 60; ++k)
  {
    const int p = 1 + k % 4;
    const int q = 1 + (k / 4) % 3;
    const nurbs::Surface surface = RandomSurface(random, p, q, p + 4, q + 6, k % 2 == 1);
    const nurbs::Curve<2> trim = RandomTrim(random, 1 + k % 3, 5, k % 3 == 1);
    const Pieces lifted = LiftTrimCurve(surface.View(), trim.View());
    ASSERT_EQ(lifted.front().T0, 0.0);
    ASSERT_EQ(lifted.back().T1, 1.0);
    ASSERT_LT(LiftError(surface, trim, lifted), 1e-12 * 10.0) << k;
  }
}

TEST(LiftTrimCurve, HasTheDegreeOfThePaper)
{
  std::mt19937 random(12);
  const nurbs::Surface surface = RandomSurface(random, 3, 3, 4, 4, false);
  const nurbs::Curve<2> cubic = RandomTrim(random, 3, 4, false);
  const Pieces lifted = LiftTrimCurve(surface.View(), cubic.View());
  ASSERT_EQ(lifted.size(), 1u);
  EXPECT_EQ(lifted[0].Degree(), 18);
  nurbs::Curve<2> iso = RandomTrim(random, 3, 4, false); // a straight line of constant v
  for (int i = 0; i < 4; ++i)
  {
    iso.Points[i] = Vec2(i / 3.0, 0.4);
  }
  iso.Pack();
  const Pieces straight = LiftTrimCurve(surface.View(), iso.View());
  ASSERT_EQ(straight.size(), 1u);
  EXPECT_EQ(straight[0].Degree(), 3);
}

TEST(LiftTrimCurve, CutsAtKnotLinesAndRunsAlongThem)
{
  std::mt19937 random(13);
  const nurbs::Surface surface = RandomSurface(random, 2, 2, 6, 5, true); // u knots at k/4
  nurbs::Curve<2> line = RandomTrim(random, 1, 2, false);
  line.Points = { Vec2(0.0, 0.5), Vec2(1.0, 0.5) };
  line.Pack();
  EXPECT_EQ(LiftTrimCurve(surface.View(), line.View()).size(), 4u);
  line.Points = { Vec2(0.5, 0.1), Vec2(0.5, 0.2) };
  line.Pack();
  const Pieces along = LiftTrimCurve(surface.View(), line.View());
  EXPECT_EQ(along.size(), 1u);
  EXPECT_LT(LiftError(surface, line, along), 1e-13 * 10);
  nurbs::Curve<2> touching = RandomTrim(random, 2, 3, false); // touches u = 0.5 and turns back
  touching.Points = { Vec2(0.3, 0.0), Vec2(0.7, 0.1), Vec2(0.3, 0.2) };
  touching.Pack();
  const Pieces touched = LiftTrimCurve(surface.View(), touching.View());
  EXPECT_LT(LiftError(surface, touching, touched), 1e-12);
}

TEST(LiftTrimCurve, SurvivesHighDegrees)
{
  std::mt19937 random(14);
  const nurbs::Surface surface = RandomSurface(random, 9, 8, 11, 9, true);
  const nurbs::Curve<2> trim = RandomTrim(random, 3, 4, true); // 3 * 17 = 51
  const Pieces lifted = LiftTrimCurve(surface.View(), trim.View());
  EXPECT_LT(LiftError(surface, trim, lifted), 1e-9);
  const nurbs::Surface lower = RandomSurface(random, 8, 8, 9, 9, false);
  const nurbs::Curve<2> cubic = RandomTrim(random, 3, 4, false); // exact, of degree 48
  EXPECT_LT(LiftError(lower, cubic, LiftTrimCurve(lower.View(), cubic.View())), 1e-12);
}

} // namespace
