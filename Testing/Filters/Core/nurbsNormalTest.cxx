// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceEvaluator.h"
#include "nurbsReference.h"

#include <gtest/gtest.h>

using namespace nurbs;

namespace
{

/// Normal of both the reference function and the evaluator, which must agree.
Vec3 BothNormals(const SurfaceView& view, double u, double v)
{
  const Vec3 careful = Normal(view, u, v);
  Vec3 point, fast;
  SurfaceEvaluator(view).PointAndNormal(u, v, point, fast);
  EXPECT_LT((careful - fast).norm(), 1e-6) << "at " << u << ", " << v;
  return careful;
}

/// Copies `surface` scaled, moved and with its parameters stretched: normals must not care.
Surface Transformed(Surface surface, double scale, const Vec3& shift, double stretch)
{
  for (Vec3& p : surface.Points)
  {
    p = scale * p + shift;
  }
  for (int dir : { 0, 1 })
  {
    for (double& t : surface.Knots[dir])
    {
      t *= dir == 0 ? stretch : 1.0 / stretch;
    }
  }
  return surface;
}

} // namespace

TEST(Normal, OfASphereIsRadialEverywhere)
{
  const Surface sphere = reference::Sphere(3.0);
  for (int i = 0; i <= 32; ++i)
  {
    for (double v : { 0.0, 1e-15, 1e-12, 1e-9, 1e-7, 1e-5, 1e-3, 0.3, 0.5, 0.9, 1.0 - 1e-6,
           1.0 - 1e-10, 1.0 - 1e-14, 1.0 })
    {
      const double u = i / 32.0;
      const Vec3 radial = Evaluate(sphere.View(), u, v) / 3.0;
      EXPECT_LT((BothNormals(sphere.View(), u, v) - radial).norm(), 1e-7) << u << ", " << v;
    }
    // At the poles themselves it is exact to round-off.
    EXPECT_LT((Normal(sphere.View(), i / 32.0, 0.0) - Vec3(0, 0, -1)).norm(), 1e-14);
    EXPECT_LT((Normal(sphere.View(), i / 32.0, 1.0) - Vec3(0, 0, 1)).norm(), 1e-14);
  }
}

TEST(Normal, AtAnApexIsThatOfTheRuling)
{
  const Surface cone = reference::Cone(2.0, 4.0);
  for (int i = 0; i <= 16; ++i)
  {
    const double u = i / 16.0;
    const Vec3 base = Evaluate(cone.View(), u, 0.0);
    const Vec3 expected = Vec3(base[0] * 4.0, base[1] * 4.0, 4.0).normalized();
    for (double v : { 0.0, 0.5, 1.0 - 1e-9, 1.0 - 1e-13, 1.0 })
    {
      EXPECT_LT((BothNormals(cone.View(), u, v) - expected).norm(), 1e-7) << u << ", " << v;
    }
    EXPECT_LT((Normal(cone.View(), u, 1.0) - expected).norm(), 1e-14);
  }
}

TEST(Normal, DoesNotDependOnUnitsPlaceOrParameters)
{
  for (const double scale : { 1e-9, 1e9 })
  {
    for (const double stretch : { 1e-6, 1.0, 1e6 })
    {
      const Surface sphere =
        Transformed(reference::Sphere(3.0), scale, scale * Vec3(100, 200, 300), stretch);
      for (int i = 0; i <= 8; ++i)
      {
        const double u = stretch * i / 8.0;
        EXPECT_LT((BothNormals(sphere.View(), u, 0.0) - Vec3(0, 0, -1)).norm(), 1e-9);
        EXPECT_LT((BothNormals(sphere.View(), u, 1.0 / stretch) - Vec3(0, 0, 1)).norm(), 1e-9);
      }
    }
  }
}

TEST(Normal, OfATriangularPatchAtItsCollapsedCorner)
{
  // A flat bilinear patch with one side collapsed, in every one of the four places.
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  const std::vector<std::vector<Vec3>> nets = { { a, a, b, c }, { b, c, a, a }, { a, c, a, b },
    { c, a, b, a } };
  for (std::size_t k = 0; k < nets.size(); ++k)
  {
    Surface patch;
    patch.Count[0] = patch.Count[1] = 2;
    patch.Knots[0] = patch.Knots[1] = { 0, 0, 1, 1 };
    patch.Points = nets[k];
    const Vec3 inside = Normal(patch.View(), 0.5, 0.5);
    ASSERT_NEAR(std::abs(inside[2]), 1.0, 1e-15);
    for (double s : { 0.0, 0.25, 1.0 })
    {
      for (double t : { 0.0, 0.25, 1.0 })
      {
        EXPECT_LT((BothNormals(patch.View(), s, t) - inside).norm(), 1e-12) << "net " << k;
      }
    }
  }
}

TEST(Normal, WhereSidesMeetInAStraightAngle)
{
  // A biquadratic disc: at its four corners Su and Sv are parallel, both not zero.
  const double w = std::sqrt(0.5);
  Surface disc;
  disc.Degree[0] = disc.Degree[1] = 2;
  disc.Count[0] = disc.Count[1] = 3;
  disc.Knots[0] = disc.Knots[1] = { 0, 0, 0, 1, 1, 1 };
  const double r = std::sqrt(2.0);
  disc.Points = { Vec3(-1, -1, 0) / r, Vec3(0, -r, 0), Vec3(1, -1, 0) / r, Vec3(-r, 0, 0),
    Vec3(0, 0, 0), Vec3(r, 0, 0), Vec3(-1, 1, 0) / r, Vec3(0, r, 0), Vec3(1, 1, 0) / r };
  disc.Weights = { 1, w, 1, w, 1, w, 1, w, 1 };
  for (double s : { 0.0, 0.5, 1.0 })
  {
    for (double t : { 0.0, 0.5, 1.0 })
    {
      EXPECT_LT((BothNormals(disc.View(), s, t) - Vec3(0, 0, 1)).norm(), 1e-12) << s << t;
    }
  }
}

TEST(Normal, WhereTheCrossProductVanishesToSecondOrder)
{
  // A paraboloid z = r^2 with r = v^2 in polar form: Su and Sv both vanish at v = 0.
  Surface bowl = reference::Revolve(4, { 0, 0, 0, 0, 0, 1, 1, 1, 1, 1 },
    { { 0, 0 }, { 0, 0 }, { 1.0 / 6.0, 0 }, { 0.5, 0 }, { 1, 1 } }, { 1, 1, 1, 1, 1 });
  const Vec3 inside = Normal(bowl.View(), 0.3, 0.05);
  ASSERT_GT(std::abs(inside[2]), 0.99);
  const Vec3 expected(0, 0, inside[2] > 0 ? 1 : -1);
  for (int i = 0; i <= 8; ++i)
  {
    EXPECT_LT((BothNormals(bowl.View(), i / 8.0, 0.0) - expected).norm(), 1e-5);
  }
}

TEST(Normal, WhereItTurnsLinearlyOnTheWayToAHigherOrderPole)
{
  // Profile x = v^2, z = v^2 + v^3: the cross product vanishes to third order, and the slope dz / dx
  // is 1 + 1.5 v.
  const Surface spike = reference::Revolve(3, { 0, 0, 0, 0, 1, 1, 1, 1 },
    { { 0, 0 }, { 0, 0 }, { 1.0 / 3.0, 1.0 / 3.0 }, { 1, 2 } }, { 1, 1, 1, 1 });
  for (int i = 0; i <= 8; ++i)
  {
    const Vec3 rim = Evaluate(spike.View(), i / 8.0, 1.0);
    const Vec3 expected = Vec3(rim[0], rim[1], -1.0).normalized();
    EXPECT_LT((BothNormals(spike.View(), i / 8.0, 0.0) - expected).norm(), 1e-6) << i;
  }
}

TEST(Normal, OfALineOrPointIsZero)
{
  Surface collapsed;
  collapsed.Count[0] = collapsed.Count[1] = 2;
  collapsed.Knots[0] = collapsed.Knots[1] = { 0, 0, 1, 1 };
  collapsed.Points = { Vec3(0, 0, 0), Vec3(1, 2, 3), Vec3(0, 0, 0), Vec3(1, 2, 3) };
  EXPECT_EQ(BothNormals(collapsed.View(), 0.5, 0.5), Vec3::Zero());
  collapsed.Points.assign(4, Vec3(7, 7, 7));
  EXPECT_EQ(BothNormals(collapsed.View(), 0.2, 0.5), Vec3::Zero());
}

TEST(Normal, OfAThinStripIsNotMistakenForAPole)
{
  // A million times longer than wide.
  Surface strip;
  strip.Count[0] = strip.Count[1] = 2;
  strip.Knots[0] = strip.Knots[1] = { 0, 0, 1, 1 };
  strip.Points = { Vec3(0, 0, 0), Vec3(1e3, 0, 0), Vec3(0, 1e-6, 1e-6), Vec3(1e3, 1e-6, -1e-6) };
  const Vec3 low = BothNormals(strip.View(), 0.0, 0.5);
  const Vec3 high = BothNormals(strip.View(), 1.0, 0.5);
  EXPECT_LT((low - Vec3(0, -1, 1).normalized()).norm(), 1e-7);
  EXPECT_LT((high - Vec3(0, 1, 1).normalized()).norm(), 1e-7);
}
