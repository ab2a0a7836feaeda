// SPDX-License-Identifier: BSD-3-Clause
#include "Surface.h"
#include "nurbsReference.h"

#include <gtest/gtest.h>

using namespace nurbs;

namespace
{

/// Surfaces of every degree in u, rational and not, clamped and not.
std::vector<Surface> Surfaces()
{
  reference::Random random(41);
  std::vector<Surface> surfaces;
  for (int degree = 1; degree <= MaxDegree; ++degree)
  {
    const int other = random.Integer(1, 6);
    surfaces.push_back(random.Surface(degree, other, true, degree % 2 == 0));
    surfaces.push_back(random.Surface(other, degree, false, degree % 3 == 0, degree % 4 == 1));
  }
  surfaces.push_back(random.Surface(25, 25, true, true));
  return surfaces;
}

} // namespace

TEST(Surface, AgreesWithTheDefinition)
{
  reference::Random random(42);
  for (const Surface& surface : Surfaces())
  {
    const SurfaceView view = surface.View();
    EXPECT_LT(reference::LargestDistance(view, view, random), 2e-13)
      << "degree " << surface.Degree[0] << " x " << surface.Degree[1];
  }
}

TEST(Surface, HomogeneousDerivativesAgreeWithTheDefinition)
{
  // Weights 1: the derivatives are those of the definition, without the quotient rule.
  reference::Random random(43);
  for (Surface surface : Surfaces())
  {
    surface.Weights.clear();
    const SurfaceView view = surface.View();
    for (int i = 0; i < 5; ++i)
    {
      const double u = random.Parameter(view.Knots[0], view.Degree[0]);
      const double v = random.Parameter(view.Knots[1], view.Degree[1]);
      const SurfaceDerivatives d = EvaluateDerivatives(view, u, v, 2);
      const struct
      {
        int A, B;
        Vec3 Value;
      } terms[] = { { 1, 0, d.Su }, { 0, 1, d.Sv }, { 2, 0, d.Suu }, { 1, 1, d.Suv },
        { 0, 2, d.Svv } };
      for (const auto& term : terms)
      {
        const reference::Point4 h = reference::Homogeneous(view, u, v, term.A, term.B);
        const Vec3 expected{ double(h[0]), double(h[1]), double(h[2]) };
        // Derivative k of degree p is a k-th difference with factor p^k of coordinates up to 30.
        const double factor =
          std::pow(10.0 * view.Degree[0], term.A) * std::pow(10.0 * view.Degree[1], term.B);
        EXPECT_LT((term.Value - expected).norm(), 1e-13 * 30.0 * factor);
      }
    }
  }
}

TEST(Surface, RationalDerivativesAreLimitsOfDifferences)
{
  reference::Random random(44);
  const double h = 1e-6;
  for (const Surface& surface : Surfaces())
  {
    const SurfaceView view = surface.View();
    const BezierPatch patch = ToBezier(view).back();
    for (int i = 0; i < 5; ++i)
    {
      const double u = random.Uniform(patch.U.Min + h, patch.U.Max - h);
      const double v = random.Uniform(patch.V.Min + h, patch.V.Max - h);
      const SurfaceDerivatives d = EvaluateDerivatives(view, u, v, 2);
      const SurfaceDerivatives u0 = EvaluateDerivatives(view, u - h, v, 1);
      const SurfaceDerivatives u1 = EvaluateDerivatives(view, u + h, v, 1);
      const SurfaceDerivatives v0 = EvaluateDerivatives(view, u, v - h, 1);
      const SurfaceDerivatives v1 = EvaluateDerivatives(view, u, v + h, 1);
      const auto check = [&](const Vec3& low, const Vec3& high, const Vec3& derivative) {
        const double scale = 10.0 + derivative.norm() + 1e-3 * d.Suu.norm() + 1e-3 * d.Svv.norm();
        EXPECT_LT(((high - low) / (2 * h) - derivative).norm(), 2e-6 * scale);
      };
      check(u0.S, u1.S, d.Su);
      check(v0.S, v1.S, d.Sv);
      check(u0.Su, u1.Su, d.Suu);
      check(u0.Sv, u1.Sv, d.Suv);
      check(v0.Sv, v1.Sv, d.Svv);
    }
  }
}

TEST(Surface, SphereTorusAndConeAreExact)
{
  const Surface sphere = reference::Sphere(3.0);
  const Surface torus = reference::Torus(5.0, 2.0);
  const Surface cone = reference::Cone(2.0, 4.0);
  for (int j = 0; j <= 40; ++j)
  {
    for (int i = 0; i <= 40; ++i)
    {
      const double u = i / 40.0;
      const double v = j / 40.0;
      EXPECT_NEAR(Evaluate(sphere.View(), u, v).norm(), 3.0, 2e-15 * 3.0 * 2);
      const Vec3 t = Evaluate(torus.View(), u, v);
      EXPECT_NEAR(std::hypot(t.head<2>().norm() - 5.0, t[2]), 2.0, 1e-14);
      const Vec3 c = Evaluate(cone.View(), u, v);
      EXPECT_NEAR(c.head<2>().norm() / 2.0 + c[2] / 4.0, 1.0, 1e-14);
    }
  }
}

TEST(Surface, SphereHasItsCurvature)
{
  const Surface sphere = reference::Sphere(3.0);
  for (double v : { 0.1, 0.3, 0.7, 0.95 })
  {
    const SurfaceDerivatives d = EvaluateDerivatives(sphere.View(), 0.4, v, 2);
    const Vec3 n = d.Su.cross(d.Sv).normalized();
    const double E = d.Su.dot(d.Su), F = d.Su.dot(d.Sv), G = d.Sv.dot(d.Sv);
    const double L = d.Suu.dot(n), M = d.Suv.dot(n), N = d.Svv.dot(n);
    EXPECT_NEAR((L * N - M * M) / (E * G - F * F), 1.0 / 9.0, 1e-12);
  }
}

TEST(Surface, IndirectPointsAreFollowed)
{
  reference::Random random(45);
  Surface surface = random.Surface(3, 2);
  const std::size_t count = surface.Points.size();
  std::vector<std::int64_t> ids(count);
  Surface shuffled = surface;
  for (std::size_t k = 0; k < count; ++k)
  {
    ids[k] = static_cast<std::int64_t>(count - 1 - k);
    shuffled.Points[ids[k]] = surface.Points[k];
    shuffled.Weights[ids[k]] = surface.Weights[k];
  }
  SurfaceView view = shuffled.View();
  view.Ids = ids.data();
  EXPECT_EQ(Evaluate(view, 0.4, 0.6), Evaluate(surface.View(), 0.4, 0.6));
  const Surface copy = Copy(view);
  EXPECT_EQ(copy.Points, surface.Points);
  EXPECT_EQ(copy.Weights, surface.Weights);
  EXPECT_TRUE(view.IsRational());
  std::fill(shuffled.Weights.begin(), shuffled.Weights.end(), 0.7);
  EXPECT_FALSE(view.IsRational());
  view.Weights = nullptr;
  EXPECT_FALSE(view.IsRational());
}

TEST(Surface, ClosedDirections)
{
  const Surface torus = reference::Torus(5.0, 2.0);
  const Surface sphere = reference::Sphere(3.0);
  EXPECT_TRUE(IsClosed(torus.View(), 0, 1e-12));
  EXPECT_TRUE(IsClosed(torus.View(), 1, 1e-12));
  EXPECT_TRUE(IsClosed(sphere.View(), 0, 1e-12));
  EXPECT_FALSE(IsClosed(sphere.View(), 1, 1.0));
  // Equal at both ends of the sides, but not between: closed needs the whole iso-curve.
  Surface bulge;
  bulge.Degree[1] = 2;
  bulge.Count[0] = 2;
  bulge.Count[1] = 3;
  bulge.Knots[0] = { 0, 0, 1, 1 };
  bulge.Knots[1] = { 0, 0, 0, 1, 1, 1 };
  bulge.Points = { Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 0.1, 0), Vec3(2, 0, 0),
    Vec3(2, 0, 0) };
  EXPECT_FALSE(IsClosed(bulge.View(), 0, 0.04));
  EXPECT_TRUE(IsClosed(bulge.View(), 0, 0.06));
}

TEST(Surface, PeriodicSurfaceIsClosed)
{
  // A tube: unclamped uniform cubic around, with three rows repeated.
  Surface tube;
  tube.Degree[0] = 3;
  tube.Count[0] = 11;
  tube.Count[1] = 2;
  for (int i = 0; i < 15; ++i)
  {
    tube.Knots[0].push_back(i);
  }
  tube.Knots[1] = { 0, 0, 1, 1 };
  const double pi = std::acos(-1.0);
  for (int j = 0; j < 2; ++j)
  {
    for (int i = 0; i < 11; ++i)
    {
      const double angle = 2.0 * pi * (i % 8) / 8;
      tube.Points.push_back(Vec3(std::cos(angle), std::sin(angle), j));
    }
  }
  const SurfaceView view = tube.View();
  EXPECT_EQ(view.Domain(0).Min, 3.0);
  EXPECT_EQ(view.Domain(0).Max, 11.0);
  EXPECT_TRUE(IsClosed(view, 0, 1e-13));
  EXPECT_FALSE(IsClosed(view, 1, 1e-3));
  const SurfaceDerivatives a = EvaluateDerivatives(view, 3.0, 0.5, 2);
  const SurfaceDerivatives b = EvaluateDerivatives(view, 11.0, 0.5, 2);
  EXPECT_LT((a.Su - b.Su).norm() + (a.Suu - b.Suu).norm(), 1e-13);
  EXPECT_LT((Normal(view, 3.0, 0.5) - Normal(view, 11.0, 0.5)).norm(), 1e-13);
}

TEST(Surface, DegenerateSides)
{
  const Surface sphere = reference::Sphere(3.0);
  const Surface cone = reference::Cone(2.0, 4.0);
  EXPECT_TRUE(IsDegenerateSide(sphere.View(), 1, 0, 1e-12));
  EXPECT_TRUE(IsDegenerateSide(sphere.View(), 1, 1, 1e-12));
  EXPECT_FALSE(IsDegenerateSide(sphere.View(), 0, 0, 1e-3));
  EXPECT_FALSE(IsDegenerateSide(cone.View(), 1, 0, 1e-3));
  EXPECT_TRUE(IsDegenerateSide(cone.View(), 1, 1, 1e-12));
}

TEST(Surface, UnavailableDerivativesAreRefused)
{
  const Surface sphere = reference::Sphere(1.0);
  EXPECT_THROW(EvaluateDerivatives(sphere.View(), 0.5, 0.5, 3), Error);
  EXPECT_THROW(EvaluateDerivatives(sphere.View(), 0.5, 0.5, 0), Error);
}
