// SPDX-License-Identifier: BSD-3-Clause
// Where lines are placed, against integrals of the curvature and what shapes are known to need.
#include "LinePlacement.h"
#include "nurbsBoundReference.h"

#include <gtest/gtest.h>

namespace
{

using namespace reference;
using nurbs::LinePlacement;
using nurbs::ParameterLines;
using nurbs::SurfaceBound;

struct Lines
{
  ParameterLines U;
  ParameterLines V;
  bool Follows[2];
  int Segments(int dir) const { return int((dir == 0 ? this->U : this->V).At.size()) - 1; }
};

Lines Place(const nurbs::Surface& surface, double tolerance, double margin = 1.0)
{
  const nurbs::SurfaceView view = surface.View();
  const ParameterBox domain = DomainOf(view);
  const SurfaceBound bound(view, domain);
  const LinePlacement placement(bound, domain, tolerance, nurbs::SerialFor);
  Lines out;
  placement.Place(margin, out.U, out.V);
  out.Follows[0] = placement.FollowsDemand(0);
  out.Follows[1] = placement.FollowsDemand(1);
  return out;
}

void ExpectSound(const ParameterLines& lines, const nurbs::Interval& domain)
{
  ASSERT_GE(lines.At.size(), 2u);
  ASSERT_EQ(lines.At.size(), lines.Demand.size());
  EXPECT_EQ(lines.At.front(), domain.Min);
  EXPECT_EQ(lines.At.back(), domain.Max);
  for (std::size_t k = 0; k + 1 < lines.At.size(); ++k)
  {
    EXPECT_LT(lines.At[k], lines.At[k + 1]);
    EXPECT_LE(lines.Demand[k], lines.Demand[k + 1]);
  }
}

TEST(LinePlacement, LinesAscendFromEndToEnd)
{
  Random random(4);
  for (int k = 0; k < 60; ++k)
  {
    const nurbs::Surface s = k == 0 ? Torus(5.0, 2.0)
      : k == 1                      ? Sphere(2.0)
               : WildSurface(random, 1 + k % 6, 1 + k / 6 % 6, k % 2 == 0, Vec3(0.0, 0.0, 0.0));
    const nurbs::SurfaceView view = s.View();
    const Lines lines = Place(s, std::pow(10.0, random.Uniform(-4.0, 0.0)));
    ExpectSound(lines.U, view.Domain(0));
    ExpectSound(lines.V, view.Domain(1));
    const SurfaceBound bound(view, DomainOf(view));
    for (int d = 0; d < 2; ++d)
    {
      const std::vector<double>& at = d == 0 ? lines.U.At : lines.V.At;
      for (double crease : bound.Creases(d))
      {
        EXPECT_TRUE(std::binary_search(at.begin(), at.end(), crease));
      }
    }
  }
}

TEST(LinePlacement, CylinderHasLinesInOneDirection)
{
  const double radius = 2.0;
  const double tolerance = 0.001;
  const Lines lines = Place(Cylinder(radius, 50.0), tolerance);
  const double ideal = M_PI / std::acos(1.0 - tolerance / radius);
  std::printf("cylinder: %d x %d cells, a regular polygon needs %.2f\n", lines.Segments(0),
    lines.Segments(1), ideal);
  EXPECT_EQ(lines.Segments(1), 1);
  EXPECT_GE(lines.Segments(0), int(0.97 * ideal));
  EXPECT_LE(lines.Segments(0), int(1.03 * ideal) + 1);
}

/// The integral of sqrt(n . S_uu / (8 tolerance)) along u, by the midpoint rule.
double Demand(const nurbs::SurfaceView& s, double a, double b, double v, double tolerance)
{
  constexpr int N = 2000;
  double sum = 0.0;
  for (int i = 0; i < N; ++i)
  {
    const double u = a + (b - a) * (i + 0.5) / N;
    const nurbs::SurfaceDerivatives d = nurbs::EvaluateDerivatives(s, u, v, 2);
    const Vec3 n = d.Su.cross(d.Sv).normalized();
    sum += std::sqrt(std::abs(n.dot(d.Suu)) / (8.0 * tolerance)) * (b - a) / N;
  }
  return sum;
}

/// A cubic of several spans, always bent to the same side, swept along a straight line.
nurbs::Surface Ramp()
{
  nurbs::Surface s;
  s.Degree[0] = 3;
  s.Degree[1] = 1;
  s.Count[0] = 7;
  s.Count[1] = 2;
  s.Knots[0] = { 0, 0, 0, 0, 0.5, 1.1, 1.6, 3, 3, 3, 3 };
  s.Knots[1] = { 0, 0, 1, 1 };
  for (int k = 0; k < 14; ++k)
  {
    const double x = k % 7;
    s.Points.push_back(Vec3(x, k / 7, 0.02 * x * x * x + 0.2 * x * x));
  }
  return s;
}

TEST(LinePlacement, LinesAreQuantilesOfTheDemand)
{
  const nurbs::Surface ramp = Ramp();
  const nurbs::SurfaceView view = ramp.View();
  for (double tolerance : { 0.01, 0.001, 0.0001 })
  {
    const Lines lines = Place(ramp, tolerance);
    const double total = Demand(view, 0.0, 3.0, 0.5, tolerance);
    double least = 1e300;
    double most = 0.0;
    for (int k = 0; k < lines.Segments(0); ++k)
    {
      const double share = Demand(view, lines.U.At[k], lines.U.At[k + 1], 0.5, tolerance);
      least = std::min(least, share);
      most = std::max(most, share);
      EXPECT_NEAR(lines.U.Demand[k + 1] - lines.U.Demand[k],
        lines.U.Demand.back() / lines.Segments(0), 1e-9 * total);
    }
    const double equal = total / lines.Segments(0);
    std::printf("ramp at %g: %d segments for a demand of %.2f (taken for %.2f), each %.3f to %.3f "
                "of an equal part\n",
      tolerance, lines.Segments(0), total, lines.U.Demand.back(), least / equal, most / equal);
    EXPECT_EQ(lines.Segments(1), 1);
    EXPECT_NEAR(lines.U.Demand.back(), total, 0.03 * total);
    EXPECT_GT(least, 0.8 * equal);
    EXPECT_LT(most, 1.2 * equal);
  }
}

TEST(LinePlacement, MarginScalesTheNumberOfSegments)
{
  const Lines once = Place(Ramp(), 1e-4);
  const Lines more = Place(Ramp(), 1e-4, 1.5);
  EXPECT_NEAR(more.Segments(0), 1.5 * once.Segments(0), 2.0);
}

TEST(LinePlacement, SaddleUsesTheToleranceTwice)
{
  const double tolerance = 1e-5;
  const double c = 0.02; // So flat that parameters are lengths.
  const double d = 0.03;
  const double full[2] = { std::sqrt(2.0 * c / (8.0 * tolerance)),
    std::sqrt(2.0 * d / (8.0 * tolerance)) };
  const Lines saddle = Place(Quadric(c, -d), tolerance);
  const Lines bowl = Place(Quadric(c, d), tolerance);
  std::printf("saddle: %d x %d cells, with all of the tolerance %.2f x %.2f; bowl: %d x %d, with "
              "half of it %.2f x %.2f\n",
    saddle.Segments(0), saddle.Segments(1), full[0], full[1], bowl.Segments(0), bowl.Segments(1),
    full[0] * std::sqrt(2.0), full[1] * std::sqrt(2.0));
  for (int dir = 0; dir < 2; ++dir)
  {
    EXPECT_GE(saddle.Segments(dir), int(full[dir] * 0.99));
    EXPECT_LE(saddle.Segments(dir), int(std::ceil(full[dir] * 1.01)));
  }
  // Whatever the shares are, the bowl's cells use no more than the tolerance, and nearly all of it.
  const double used = c / (4.0 * bowl.Segments(0) * bowl.Segments(0)) +
    d / (4.0 * bowl.Segments(1) * bowl.Segments(1));
  EXPECT_LE(used, 1.02 * tolerance);
  EXPECT_LE(bowl.Segments(0) * bowl.Segments(1), 2.0 * full[0] * full[1] * 1.1);
}

TEST(LinePlacement, SphereHasFewerCellsThanHalvesOfTheTolerance)
{
  const double radius = 3.0;
  for (double tolerance : { 0.03, 0.003, 0.0003 })
  {
    const Lines lines = Place(Sphere(radius), tolerance);
    const double step = std::sqrt(4.0 * tolerance / radius); // Angle with half of the tolerance.
    const double columns = 2.0 * M_PI / step;
    const double rows = M_PI / step;
    std::printf("sphere at %g: %d x %d cells, with half of the tolerance each %.2f x %.2f, %.3f of "
                "the product\n",
      tolerance, lines.Segments(0), lines.Segments(1), columns, rows,
      lines.Segments(0) * lines.Segments(1) / (columns * rows));
    EXPECT_LT(lines.Segments(1), rows);
    EXPECT_LT(lines.Segments(0) * lines.Segments(1), 0.97 * std::ceil(columns) * std::ceil(rows));
  }
}

TEST(LinePlacement, TwiceTheCellsForHalfTheTolerance)
{
  for (const nurbs::Surface& s : { Sphere(3.0), Torus(5.0, 2.0), Quadric(0.3, 0.2) })
  {
    const Lines coarse = Place(s, 1e-4);
    const Lines fine = Place(s, 5e-5);
    EXPECT_NEAR(double(fine.Segments(0)) * fine.Segments(1) /
        (double(coarse.Segments(0)) * coarse.Segments(1)),
      2.0, 0.06);
  }
}

} // namespace
