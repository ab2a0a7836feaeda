// SPDX-License-Identifier: BSD-3-Clause
// Rays through surfaces: closed forms, random surfaces, closed shapes.
#include "nurbsRayReference.h"

using namespace nurbs;
using namespace reference;

TEST(RayCaster, Sphere)
{
  const Shape shape({ reference::Sphere(1.5) });
  const RayCaster caster(shape.Content);
  reference::Random random(1);
  for (int i = 0; i < 3000; ++i)
  {
    const double speed = random.Uniform(0.1, 10.0);
    Ray ray = LineThrough(RandomPoint(caster.Bounds(), random), RandomDirection(random), 3.0);
    ray.Direction *= speed;
    const reference::Real a = ray.Direction.squaredNorm();
    const reference::Real b = 2.0L * ray.Origin.dot(ray.Direction);
    const reference::Real c = reference::Real(ray.Origin.squaredNorm()) - 2.25L;
    if (std::abs(double(b * b - 4.0L * a * c)) < 1e-6 * double(a))
    {
      continue; // touches, or nearly
    }
    ExpectHits(caster, shape.Content, ray, Roots({ c, b, a }, 100.0L), 1e-9 / speed);
    std::vector<RayHit> hits;
    caster.All(ray, hits);
    ExpectClosed(hits);
    for (const RayHit& hit : hits)
    {
      EXPECT_LT((hit.Normal - hit.Point / 1.5).norm(), 1e-12);
    }
    if (!hits.empty())
    {
      // From the inside there is one, and none between the first and itself.
      ray.Min = 0.5 * (hits[0].T + hits[1].T);
      RayHit second;
      ASSERT_TRUE(caster.Nearest(ray, second));
      EXPECT_EQ(second.T, hits[1].T);
      ray.Max = 0.5 * (ray.Min + hits[1].T);
      EXPECT_FALSE(caster.Nearest(ray, second));
      EXPECT_FALSE(caster.IsBlocked(ray));
    }
  }
}

TEST(RayCaster, TorusHasUpToFourHits)
{
  const Shape shape({ reference::Torus(1.0, 0.35) });
  const RayCaster caster(shape.Content);
  reference::Random random(2);
  int counts[5] = {};
  for (int i = 0; i < 4000; ++i)
  {
    const Ray ray = LineThrough(RandomPoint(caster.Bounds(), random), RandomDirection(random), 2.0);
    // (|p|^2 + R^2 - r^2)^2 = 4 R^2 (x^2 + y^2)
    const Vec3 &o = ray.Origin, &d = ray.Direction;
    const std::vector<reference::Real> square{ o.squaredNorm() + 1.0L - 0.35L * 0.35L,
      2.0L * o.dot(d), d.squaredNorm() };
    std::vector<reference::Real> f = Product(square, square);
    f[0] -= 4.0L * (o[0] * o[0] + o[1] * o[1]);
    f[1] -= 8.0L * (o[0] * d[0] + o[1] * d[1]);
    f[2] -= 4.0L * (d[0] * d[0] + d[1] * d[1]);
    const std::vector<reference::Real> roots = Roots(f, 50.0L);
    bool close = false;
    for (std::size_t k = 1; k < roots.size(); ++k)
    {
      close = close || roots[k] - roots[k - 1] < 1e-4L;
    }
    if (!close)
    {
      ++counts[roots.size()];
      ExpectHits(caster, shape.Content, ray, roots, 1e-10);
    }
  }
  EXPECT_GT(counts[0], 100);
  EXPECT_GT(counts[2], 1000);
  EXPECT_GT(counts[4], 300);
  EXPECT_EQ(counts[1] + counts[3], 0);
}

TEST(RayCaster, SphereSeamAndPoles)
{
  for (const auto& surfaces : { std::vector<Surface>{ reference::Sphere(1.0) }, CutSphere() })
  {
    const Shape shape(surfaces);
    const RayCaster caster(shape.Content);
    reference::Random random(3);
    std::vector<RayHit> hits;
    for (int i = 0; i < 2000; ++i)
    {
      // A point of the seam or a pole, or one on a border of patches, or of cells of the tree.
      const Surface& s = surfaces[random.Integer(0, static_cast<int>(surfaces.size()) - 1)];
      const int dir = random.Integer(0, 1);
      double at[2];
      const int steps = random.Integer(0, 1) == 0 ? 4 : 64;
      at[dir] =
        s.View().Domain(dir).Min + s.View().Domain(dir).Length() * random.Integer(0, steps) / steps;
      at[1 - dir] =
        s.View().Domain(1 - dir).Min + s.View().Domain(1 - dir).Length() * random.Uniform(0, 1);
      const Vec3 point = Evaluate(s.View(), at[0], at[1]);
      const Vec3 d = RandomDirection(random);
      caster.All(LineThrough(point, d, 2.0), hits);
      if (std::abs(d.dot(point)) > 1e-3)
      {
        ASSERT_EQ(hits.size(), 2u) << at[0] << " " << at[1];
        ExpectClosed(hits);
        EXPECT_LT(std::min((hits[0].Point - point).norm(), (hits[1].Point - point).norm()), 1e-10);
      }
    }
    for (const Vec3& d : { Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 1), Vec3(0.1, -0.2, -3) })
    {
      caster.All(LineThrough(Vec3(0, 0, 1), d, 2.0), hits);
      ASSERT_EQ(hits.size(), 2u);
      ExpectClosed(hits);
    }
  }
}

TEST(RayCaster, Touching)
{
  const Shape sphere({ reference::Sphere(1.0) });
  const RayCaster caster(sphere.Content);
  std::vector<RayHit> hits;
  Ray ray;
  ray.Direction = Vec3(0, 1, 0);
  for (double x : { 1.0, -1.0 })
  {
    ray.Origin = Vec3(x, -3, 0);
    caster.All(ray, hits);
    // One point, or in and out again, as rounding has it.
    ASSERT_FALSE(hits.empty()) << x;
    ExpectClosed(WithoutTouches(hits));
    for (const RayHit& hit : hits)
    {
      EXPECT_LT((hit.Point - Vec3(x, 0, 0)).norm(), 2e-7);
    }
  }
  // Off by more and more: never one hit that crosses.
  for (double off = 1e-15; off < 1e-2; off *= 1.3)
  {
    ray.Origin = Vec3(1.0 + off, -3, 0);
    caster.All(ray, hits);
    EXPECT_TRUE(WithoutTouches(hits).empty()) << off;
    EXPECT_TRUE(off < 1e-13 || hits.empty()) << off;
    ray.Origin = Vec3(1.0 - off, -3, 0);
    caster.All(ray, hits);
    ExpectClosed(WithoutTouches(hits));
    EXPECT_FALSE(hits.empty());
    EXPECT_TRUE(off < 1e-9 || hits.size() == 2u) << off;
  }
  // Along a cylinder's ruling, and in a plane: no hit, and soon.
  const Shape cylinder({ reference::Revolve(1, { 0, 0, 1, 1 }, { { 1, 0 }, { 1, 2 } }, { 1, 1 }),
    Plate(Vec3(3, 0, 0), Vec3(4, 0, 0.5), Vec3(3, 1, 0), Vec3(4, 2, 0.5)) });
  const RayCaster other(cylinder.Content);
  ray.Direction = Vec3(0, 0, 1);
  for (const Vec3& start : { Vec3(1, 0, -1), Vec3(0, 1, -1), Vec3(0.6, 0.8, -1) })
  {
    ray.Origin = start;
    other.All(ray, hits);
    EXPECT_TRUE(WithoutTouches(hits).empty());
  }
  ray.Origin = Vec3(2, 0.3, -0.5);
  ray.Direction = Vec3(2, 0.6, 1);
  other.All(ray, hits);
  EXPECT_TRUE(hits.empty());
}

TEST(RayCaster, ConeApex)
{
  const Shape shape({ reference::Cone(1.0, 2.0) });
  const RayCaster caster(shape.Content);
  reference::Random random(4);
  std::vector<RayHit> hits;
  for (int i = 0; i < 500; ++i)
  {
    // Down into the cone, or past it.
    const Vec3 d = RandomDirection(random);
    const double steep = std::abs(d[2]) / std::hypot(d[0], d[1]);
    if (std::abs(steep - 2.0) < 1e-2)
    {
      continue;
    }
    caster.All(LineThrough(Vec3(0, 0, 2), d, 3.0), hits);
    hits = WithoutTouches(hits);
    ASSERT_EQ(hits.size(), steep > 2.0 ? 1u : 2u);
    EXPECT_LT((hits[0].Point - Vec3(0, 0, 2)).norm(), 1e-12);
    EXPECT_EQ(hits[0].Crossing, steep > 2.0 && d[2] > 0.0 ? -1 : 1);
  }
}

TEST(RayCaster, CubeEdgesAndCorners)
{
  const Shape shape(Cube());
  const RayCaster caster(shape.Content);
  reference::Random random(5);
  std::vector<RayHit> hits;
  for (int i = 0; i < 3000; ++i)
  {
    // Through a point of an edge (half of them: through two such points).
    Vec3 points[2];
    for (Vec3& p : points)
    {
      p = Vec3(random.Integer(0, 1), random.Integer(0, 1), random.Integer(0, 1));
      p[random.Integer(0, 2)] = random.Integer(0, 4) / 4.0 * (random.Integer(0, 1) ? 1.0 : 0.7);
    }
    Vec3 d = i % 2 == 0 ? RandomDirection(random) : Vec3(points[1] - points[0]);
    if (d.cwiseAbs().minCoeff() < 1e-3)
    {
      continue; // along a side
    }
    caster.All(LineThrough(points[0], d.normalized(), 2.0), hits);
    const bool vertex = [&] {
      const auto whole = [](const Vec3& p) {
        return (p.array() - p.array().round()).abs().maxCoeff() < 1e-9;
      };
      return whole(points[0]) || whole(points[1]);
    }();
    if (!vertex)
    {
      ExpectClosed(hits);
    }
    // By slabs: the ray goes through the cube, or past it at the edge.
    double low = -1e9, high = 1e9;
    for (int k = 0; k < 3; ++k)
    {
      const double a = -points[0][k] / d[k], b = (1.0 - points[0][k]) / d[k];
      low = std::max(low, std::min(a, b));
      high = std::min(high, std::max(a, b));
    }
    ASSERT_GE(hits.size(), 2u);
    EXPECT_NEAR(hits.back().T - hits.front().T, std::max(0.0, high - low) * d.norm(), 1e-9);
  }
  for (const Vec3& d : { Vec3(1, 1, 1), Vec3(-1, -1, -1), Vec3(1, -1, 1) })
  {
    caster.All(LineThrough(Vec3(0.5, 0.5, 0.5), d.normalized(), 2.0), hits);
    ASSERT_EQ(hits.size(), 2u);
    ExpectClosed(hits);
    EXPECT_NEAR(hits[1].T - hits[0].T, std::sqrt(3.0), 1e-14);
  }
  // In the plane of a side, the neighbours are hit.
  caster.All(LineThrough(Vec3(0.5, 0.3, 1.0), Vec3(1, 0, 0), 2.0), hits);
  ASSERT_EQ(hits.size(), 2u);
  ExpectClosed(hits);
}

TEST(RayCaster, FindsWhatPlainSearchFinds)
{
  reference::Random random(6);
  int compared = 0, hitsInAll = 0;
  for (int degree = 1; degree <= 9; ++degree)
  {
    const Surface surface =
      random.Surface(degree, degree % 2 == 0 ? degree : 10 - degree, true, true, false, 2);
    const Shape shape({ surface });
    const RayCaster caster(shape.Content);
    const double size = caster.Bounds().diagonal().norm();
    for (int i = 0; i < 60; ++i)
    {
      const Ray ray =
        LineThrough(RandomPoint(caster.Bounds(), random), RandomDirection(random), size);
      std::vector<RayHit> hits;
      caster.All(ray, hits);
      const PlainSearch plain(surface, ray);
      bool grazing = false;
      for (const RayHit& hit : hits)
      {
        grazing = grazing || std::abs(hit.Normal.dot(ray.Direction)) < 3e-2;
      }
      if (grazing)
      {
        continue; // the plain search loses some of these
      }
      ++compared;
      ASSERT_EQ(hits.size(), plain.Found.size()) << "degree " << degree << ", ray " << i;
      for (std::size_t k = 0; k < hits.size(); ++k)
      {
        ++hitsInAll;
        EXPECT_NEAR(hits[k].U, plain.Found[k][0], 1e-10);
        EXPECT_NEAR(hits[k].V, plain.Found[k][1], 1e-10);
        EXPECT_NEAR(hits[k].T, plain.Found[k][2], 1e-12 * size);
      }
    }
  }
  EXPECT_GT(compared, 250);
  EXPECT_GT(hitsInAll, 300);
}

namespace
{

/// Where the surface may have a crease, and two normals.
bool IsNearKnot(const Surface& surface, double u, double v)
{
  const double at[2] = { u, v };
  bool near = false;
  for (int dir = 0; dir < 2; ++dir)
  {
    for (const double knot : surface.Knots[dir])
    {
      near = near || std::abs(knot - at[dir]) < 1e-9;
    }
  }
  return near;
}

} // namespace

TEST(RayCaster, FindsThePointAimedAt)
{
  reference::Random random(7);
  for (const int degree : { 1, 2, 3, 4, 5, 7, 9, 12, 18, 25 })
  {
    const Shape shape({ random.Surface(degree, degree, degree % 2 == 0, degree % 3 != 0) });
    const Surface& surface = shape.Surfaces[0];
    const RayCaster caster(shape.Content);
    const double size = caster.Bounds().diagonal().norm();
    std::vector<RayHit> hits;
    double worst = 0.0;
    for (int i = 0; i < (degree < 10 ? 300 : 40); ++i)
    {
      // Knots, corners and sides of the domain among them.
      const double u = random.Parameter(surface.Knots[0], surface.Degree[0]);
      const double v = random.Parameter(surface.Knots[1], surface.Degree[1]);
      const Vec3 point = Evaluate(surface.View(), u, v);
      const Vec3 normal = Normal(surface.View(), u, v);
      Vec3 d = RandomDirection(random);
      d = i % 3 == 0 ? Vec3(d - 0.999 * d.dot(normal) * normal).normalized() : d; // grazing
      const Ray ray = LineThrough(point, d, size);
      caster.All(ray, hits);
      double nearest = 1e9;
      for (const RayHit& hit : hits)
      {
        nearest = std::min(nearest, (hit.Point - point).norm());
        const double off = (ray.Origin + hit.T * ray.Direction - hit.Point).norm() / size;
        worst = std::max(worst, off / (1e-13 + 4e-16 / std::abs(hit.Normal.dot(d))));
        EXPECT_LT((Evaluate(surface.View(), hit.U, hit.V) - hit.Point).norm(), 1e-12 * size);
        if (!IsNearKnot(surface, hit.U, hit.V))
        {
          EXPECT_LT((Normal(surface.View(), hit.U, hit.V) - hit.Normal).norm(), 1e-6);
        }
      }
      const double sine = std::abs(d.dot(normal));
      ASSERT_LT(nearest, 1e-12 * size / std::max(sine, 1e-6)) << degree << " at " << u << " " << v;
    }
    EXPECT_LT(worst, 1.0) << "degree " << degree;
  }
}

TEST(RayCaster, NoRaySlipsThroughAClosedSurface)
{
  reference::Random random(8);
  std::vector<RayHit> hits;
  const auto expect = [&](const std::vector<Surface>& surfaces, bool simple, int rays) {
    const Shape shape(surfaces);
    const RayCaster caster(shape.Content);
    const double size = caster.Bounds().diagonal().norm();
    for (int i = 0; i < rays; ++i)
    {
      Vec3 point = RandomPoint(caster.Bounds(), random);
      if (i % 4 == 0)
      {
        // Through a border, to the last bit.
        const Surface& s = surfaces[random.Integer(0, static_cast<int>(surfaces.size()) - 1)];
        const int side = random.Integer(0, 1);
        const auto along = [&](int dir) {
          const Interval domain = s.View().Domain(dir);
          return simple ? random.Parameter(s.Knots[dir], s.Degree[dir])
                        : random.Uniform(domain.Min, domain.Max); // no vertex: see All
        };
        const double u = side ? along(0) : s.View().Domain(0).Max;
        const double v = side ? s.View().Domain(1).Max : along(1);
        point = Evaluate(s.View(), u, v);
      }
      caster.All(LineThrough(point, RandomDirection(random), size), hits);
      hits = WithoutTouches(hits);
      int depth = 0;
      for (const RayHit& hit : hits)
      {
        depth += hit.Crossing;
      }
      ASSERT_EQ(depth, 0) << "ray " << i << " of " << hits.size() << " hits";
      if (simple)
      {
        ExpectClosed(hits);
      }
    }
  };
  expect({ reference::Torus(1.0, 0.3) }, true, 4000);
  expect(CutSphere(), true, 4000);
  expect(Cube(), true, 4000);
  for (int i = 0; i < 5; ++i)
  {
    expect({ Blob(random) }, false, 2000);
  }
}
