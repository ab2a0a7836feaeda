// SPDX-License-Identifier: BSD-3-Clause
#include "EvaluatorKernel.h"
#include "nurbsReference.h"

#include <gtest/gtest.h>

using namespace nurbs;

namespace
{

/// Every pair of the degrees with loops of their own, and some beyond.
std::vector<Surface> Surfaces()
{
  reference::Random random(61);
  std::vector<Surface> surfaces;
  for (int p : { 1, 2, 3, 4, 5, 6, 11, 25 })
  {
    for (int q : { 1, 2, 3, 4, 5, 7, 25 })
    {
      surfaces.push_back(random.Surface(p, q, (p + q) % 3 != 0, (p * q) % 2 == 0, p % 2 == 0, 9));
    }
  }
  return surfaces;
}

std::vector<Vec2> Parameters(const Surface& s, reference::Random& random, int count)
{
  std::vector<Vec2> uv;
  for (int i = 0; i < count; ++i)
  {
    // Now and then u, v or both stay: what coherence is about.
    const double u = random.Parameter(s.Knots[0], s.Degree[0]);
    const double v = random.Parameter(s.Knots[1], s.Degree[1]);
    const int keep = uv.empty() ? 0 : random.Integer(0, 3);
    uv.push_back(Vec2(keep & 1 ? uv.back()[0] : u, keep & 2 ? uv.back()[1] : v));
  }
  return uv;
}

std::string Name(const Surface& s)
{
  return "degree " + std::to_string(s.Degree[0]) + " x " + std::to_string(s.Degree[1]);
}

} // namespace

TEST(SurfaceEvaluator, AgreesWithPlainEvaluation)
{
  reference::Random random(62);
  for (const Surface& s : Surfaces())
  {
    SCOPED_TRACE(Name(s));
    const SurfaceView view = s.View();
    SurfaceEvaluator evaluator(view);
    for (const Vec2& uv : Parameters(s, random, 60))
    {
      Vec3 point, normal;
      evaluator.PointAndNormal(uv[0], uv[1], point, normal);
      EXPECT_LT((point - Evaluate(view, uv[0], uv[1])).norm(), 2e-13);
      // Random surfaces are steep here and there; an angle of 1e-9 is still far from visible.
      EXPECT_LT((normal - Normal(view, uv[0], uv[1])).norm(), 1e-9);
      for (int order : { 1, 2 })
      {
        const SurfaceDerivatives a = evaluator.Derivatives(uv[0], uv[1], order);
        const SurfaceDerivatives b = EvaluateDerivatives(view, uv[0], uv[1], order);
        const double scale = 1e-12 * (30.0 + b.Su.norm() + b.Sv.norm());
        EXPECT_LT((a.S - b.S).norm(), 2e-13);
        EXPECT_LT((a.Su - b.Su).norm(), scale * s.Degree[0]);
        EXPECT_LT((a.Sv - b.Sv).norm(), scale * s.Degree[1]);
        const double second = 100.0 * scale + 1e-12 * (b.Suu.norm() + b.Svv.norm());
        EXPECT_LT((a.Suu - b.Suu).norm(), second * s.Degree[0] * s.Degree[0]);
        EXPECT_LT((a.Suv - b.Suv).norm(), second * s.Degree[0] * s.Degree[1]);
        EXPECT_LT((a.Svv - b.Svv).norm(), second * s.Degree[1] * s.Degree[1]);
      }
    }
  }
  const Surface sphere = reference::Sphere(1.0);
  SurfaceEvaluator evaluator(sphere.View());
  EXPECT_THROW(evaluator.Derivatives(0.5, 0.5, 3), Error);
}

TEST(SurfaceEvaluator, AllWaysGiveTheSameBits)
{
  reference::Random random(63);
  for (const Surface& s : Surfaces())
  {
    SCOPED_TRACE(Name(s));
    const std::vector<Vec2> uv = Parameters(s, random, 51);
    const std::int64_t count = static_cast<std::int64_t>(uv.size());
    SurfaceEvaluator evaluator(s.View());
    std::vector<double> points(3 * count), normals(3 * count), alone(3 * count);
    evaluator.Batch(uv.data(), count, points.data(), normals.data());
    evaluator.Batch(uv.data(), count, alone.data(), nullptr);
    EXPECT_EQ(points, alone);
    for (std::int64_t i = count - 1; i >= 0; --i)
    {
      Vec3 point, normal;
      evaluator.PointAndNormal(uv[i][0], uv[i][1], point, normal);
      EXPECT_EQ(point, Vec3(points[3 * i], points[3 * i + 1], points[3 * i + 2]));
      EXPECT_EQ(normal, Vec3(normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]));
      SurfaceEvaluator fresh(evaluator);
      EXPECT_EQ(fresh.Point(uv[i][0], uv[i][1]), point);
      EXPECT_EQ(SurfaceEvaluator(s.View()).Point(uv[i][0], uv[i][1]), point);
    }
  }
}

TEST(SurfaceEvaluator, GridIsItsPoints)
{
  reference::Random random(64);
  for (const Surface& s : Surfaces())
  {
    SCOPED_TRACE(Name(s));
    std::vector<double> us, vs;
    for (int i = 0; i < 7; ++i)
    {
      us.push_back(random.Parameter(s.Knots[0], s.Degree[0])); // not sorted, may repeat
    }
    for (int j = 0; j < 6; ++j)
    {
      vs.push_back(random.Parameter(s.Knots[1], s.Degree[1]));
    }
    SurfaceEvaluator evaluator(s.View());
    std::vector<double> points(3 * 42), normals(3 * 42), alone(3 * 42);
    evaluator.Point(us[6], vs[0]); // leaves inner sums behind that are none of the grid's
    evaluator.Grid(us, vs, points.data(), normals.data());
    evaluator.Grid(us, vs, alone.data(), nullptr);
    EXPECT_EQ(points, alone);
    for (int j = 5; j >= 0; --j)
    {
      for (int i = 6; i >= 0; --i)
      {
        const double* at = points.data() + 3 * (i + 7 * j);
        const double* n = normals.data() + 3 * (i + 7 * j);
        Vec3 point, normal;
        evaluator.PointAndNormal(us[i], vs[j], point, normal);
        EXPECT_EQ(point, Vec3(at[0], at[1], at[2]));
        EXPECT_EQ(normal, Vec3(n[0], n[1], n[2]));
      }
    }
  }
}

TEST(SurfaceEvaluator, DerivativesOnAGridAreThoseOfItsPoints)
{
  reference::Random random(67);
  for (const Surface& s : Surfaces())
  {
    SCOPED_TRACE(Name(s));
    std::vector<double> us, vs;
    for (int i = 0; i < 5; ++i)
    {
      us.push_back(random.Parameter(s.Knots[0], s.Degree[0]));
      vs.push_back(random.Parameter(s.Knots[1], s.Degree[1]));
    }
    SurfaceEvaluator evaluator(s.View());
    SurfaceEvaluator other(s.View());
    std::vector<SurfaceDerivatives> grid(25), narrow(25);
    evaluator.DerivativesGrid(us, vs, grid.data());
    EvaluatorKernel<NarrowLanes>::DerivativesGrid(other, us, vs, narrow.data());
    for (int k = 24; k >= 0; --k)
    {
      const SurfaceDerivatives d = evaluator.Derivatives(us[k % 5], vs[k / 5], 2);
      for (const SurfaceDerivatives& at : { grid[k], narrow[k] })
      {
        EXPECT_EQ(at.S, d.S);
        EXPECT_EQ(at.Su, d.Su);
        EXPECT_EQ(at.Sv, d.Sv);
        EXPECT_EQ(at.Suu, d.Suu);
        EXPECT_EQ(at.Suv, d.Suv);
        EXPECT_EQ(at.Svv, d.Svv);
      }
    }
  }
}

TEST(SurfaceEvaluator, NarrowAndWideRegistersGiveTheSameBits)
{
  // The library takes what the machine has; here is the loop for the narrow ones.
  reference::Random random(66);
  for (const Surface& s : Surfaces())
  {
    SCOPED_TRACE(Name(s));
    const std::vector<Vec2> uv = Parameters(s, random, 39);
    std::vector<double> points(3 * 39), normals(3 * 39), narrowPoints(3 * 39),
      narrowNormals(3 * 39);
    SurfaceEvaluator evaluator(s.View());
    evaluator.Batch(uv.data(), 39, points.data(), normals.data());
    SurfaceEvaluator other(s.View());
    EvaluatorKernel<NarrowLanes>::Batch(
      other, uv.data(), 39, narrowPoints.data(), narrowNormals.data());
    EXPECT_EQ(points, narrowPoints);
    EXPECT_EQ(normals, narrowNormals);
  }
}

TEST(SurfaceEvaluator, EmptyRequestsAndParametersOutside)
{
  const Surface sphere = reference::Sphere(1.0);
  SurfaceEvaluator evaluator(sphere.View());
  evaluator.Batch(nullptr, 0, nullptr, nullptr);
  evaluator.Grid({}, {}, nullptr, nullptr);
  for (const Vec2& uv : { Vec2(-0.01, 0.5), Vec2(1.01, 0.5), Vec2(0.5, -0.01), Vec2(0.5, 1.01) })
  {
    // The end spans go on as the conics that they are: still on the sphere.
    EXPECT_NEAR(evaluator.Point(uv[0], uv[1]).norm(), 1.0, 1e-13);
    EXPECT_LT(
      (evaluator.Point(uv[0], uv[1]) - Evaluate(sphere.View(), uv[0], uv[1])).norm(), 1e-13);
  }
  EXPECT_TRUE(std::isnan(evaluator.Point(std::nan(""), 0.5)[0]));
  EXPECT_TRUE(std::isnan(evaluator.Point(0.5, std::nan(""))[0]));
  EXPECT_NEAR(evaluator.Point(0.5, 0.5).norm(), 1.0, 1e-14) << "after NaN";
}

TEST(SurfaceEvaluator, FollowsIndirectPoints)
{
  reference::Random random(65);
  const Surface s = random.Surface(2, 2);
  Surface reversed = s;
  std::reverse(reversed.Points.begin(), reversed.Points.end());
  std::reverse(reversed.Weights.begin(), reversed.Weights.end());
  std::vector<std::int64_t> ids(s.Points.size());
  for (std::size_t k = 0; k < ids.size(); ++k)
  {
    ids[k] = static_cast<std::int64_t>(ids.size() - 1 - k);
  }
  SurfaceView view = reversed.View();
  view.Ids = ids.data();
  EXPECT_EQ(SurfaceEvaluator(view).Point(0.3, 0.4), SurfaceEvaluator(s.View()).Point(0.3, 0.4));
}
