// SPDX-License-Identifier: BSD-3-Clause
#include "Model.h"
#include "RayCaster.h"
#include "nurbsReference.h"

#include <gtest/gtest.h>

using namespace nurbs;

namespace
{

constexpr double Pi = 3.14159265358979323846;

/// A model of untrimmed faces that keeps its surfaces.
struct Shape
{
  std::vector<Surface> Surfaces;
  Model Content;

  explicit Shape(std::vector<Surface> surfaces)
    : Surfaces(std::move(surfaces))
  {
    for (const Surface& surface : this->Surfaces)
    {
      this->Content.Faces.emplace_back();
      this->Content.Faces.back().Geometry = surface.View();
    }
  }
};

Vec3 RandomDirection(reference::Random& random)
{
  Vec3 d;
  do
  {
    d = Vec3(random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1));
  } while (d.norm() > 1.0 || d.norm() < 0.1);
  return d.normalized();
}

Vec3 RandomPoint(const Box3& box, reference::Random& random)
{
  Vec3 p;
  for (int k = 0; k < 3; ++k)
  {
    p[k] = random.Uniform(box.min()[k], box.max()[k]);
  }
  return p;
}

/// The line through a point, starting outside of a model of size `size`.
Ray LineThrough(const Vec3& point, const Vec3& direction, double size)
{
  Ray ray;
  ray.Origin = point - 2.0 * size * direction;
  ray.Direction = direction;
  return ray;
}

/// Real roots of a polynomial, lowest coefficient first: between those of its derivative, by
/// bisection. Double roots may be found or not.
std::vector<reference::Real> Roots(const std::vector<reference::Real>& c, reference::Real limit)
{
  std::vector<reference::Real> turns{ -limit };
  if (c.size() > 2)
  {
    std::vector<reference::Real> derivative;
    for (std::size_t i = 1; i < c.size(); ++i)
    {
      derivative.push_back(reference::Real(i) * c[i]);
    }
    for (reference::Real t : Roots(derivative, limit))
    {
      turns.push_back(t);
    }
  }
  turns.push_back(limit);
  const auto value = [&](reference::Real t) {
    reference::Real sum = 0.0L;
    for (std::size_t i = c.size(); i-- > 0;)
    {
      sum = sum * t + c[i];
    }
    return sum;
  };
  std::vector<reference::Real> roots;
  for (std::size_t i = 1; i < turns.size(); ++i)
  {
    reference::Real a = turns[i - 1], b = turns[i];
    if ((value(a) < 0.0L) == (value(b) < 0.0L))
    {
      continue;
    }
    const bool rising = value(a) < 0.0L;
    for (int step = 0; step < 100; ++step)
    {
      const reference::Real middle = 0.5L * (a + b);
      ((value(middle) < 0.0L) == rising ? a : b) = middle;
    }
    roots.push_back(0.5L * (a + b));
  }
  return roots;
}

/// Polynomial (as above) products.
std::vector<reference::Real> Product(
  const std::vector<reference::Real>& a, const std::vector<reference::Real>& b)
{
  std::vector<reference::Real> c(a.size() + b.size() - 1, 0.0L);
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    for (std::size_t j = 0; j < b.size(); ++j)
    {
      c[i + j] += a[i] * b[j];
    }
  }
  return c;
}

/// Expects hits at the given t, and that each lies on its surface and on the ray.
void ExpectHits(const RayCaster& caster, const Model& model, const Ray& ray,
  const std::vector<reference::Real>& expected, double tolerance)
{
  std::vector<RayHit> hits;
  caster.All(ray, hits);
  ASSERT_EQ(hits.size(), expected.size());
  for (std::size_t i = 0; i < hits.size(); ++i)
  {
    const RayHit& hit = hits[i];
    EXPECT_NEAR(hit.T, double(expected[i]), tolerance);
    EXPECT_LT((ray.Origin + hit.T * ray.Direction - hit.Point).norm(), tolerance);
    EXPECT_LT(
      (reference::Point(model.Faces[hit.Face].Geometry, hit.U, hit.V) - hit.Point).norm(), 1e-13);
    EXPECT_NEAR(hit.Normal.norm(), 1.0, 1e-14);
  }
  RayHit nearest;
  ASSERT_EQ(caster.Nearest(ray, nearest), !hits.empty());
  EXPECT_EQ(caster.IsBlocked(ray), !hits.empty());
  if (!hits.empty())
  {
    EXPECT_NEAR(nearest.T, hits[0].T, 1e-12);
  }
}

/// Expects that hits enter and leave by turns, and that none is left over.
void ExpectClosed(const std::vector<RayHit>& hits)
{
  ASSERT_EQ(hits.size() % 2, 0u);
  for (std::size_t i = 0; i < hits.size(); ++i)
  {
    ASSERT_EQ(hits[i].Crossing, i % 2 == 0 ? 1 : -1) << i << " of " << hits.size();
  }
}

std::vector<RayHit> WithoutTouches(std::vector<RayHit> hits)
{
  hits.erase(std::remove_if(
               hits.begin(), hits.end(), [](const RayHit& hit) { return hit.Crossing == 0; }),
    hits.end());
  return hits;
}

Surface Plate(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  Surface s;
  s.Count[0] = s.Count[1] = 2;
  s.Knots[0] = s.Knots[1] = { 0, 0, 1, 1 };
  s.Points = { a, b, c, d };
  return s;
}

/// The unit cube, normals outwards.
std::vector<Surface> Cube()
{
  std::vector<Surface> sides;
  for (int axis = 0; axis < 3; ++axis)
  {
    const Vec3 u = Vec3::Unit((axis + 1) % 3), v = Vec3::Unit((axis + 2) % 3), n = Vec3::Unit(axis);
    sides.push_back(Plate(n, n + u, n + v, n + u + v));
    sides.push_back(Plate(Vec3::Zero(), v, u, u + v));
  }
  return sides;
}

/// A sphere of 6 x 4 faces whose borders agree bit for bit, normals outwards.
std::vector<Surface> CutSphere()
{
  const Surface sphere = reference::Sphere(1.0);
  std::vector<Surface> parts;
  for (int i = 0; i < 6; ++i)
  {
    for (int j = 0; j < 4; ++j)
    {
      parts.push_back(Restrict(
        sphere.View(), { i / 6.0, i == 5 ? 1.0 : (i + 1) / 6.0 }, { j / 4.0, (j + 1) / 4.0 }));
    }
  }
  return parts;
}

} // namespace

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
      at[dir] = s.View().Domain(dir).Min +
        s.View().Domain(dir).Length() * random.Integer(0, steps) / steps;
      at[1 - dir] = s.View().Domain(1 - dir).Min +
        s.View().Domain(1 - dir).Length() * random.Uniform(0, 1);
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
    for(auto&h:hits) printf("%d %g %g  %.17g %.3g %.3g\n",h.Crossing,h.U,h.V,h.T,h.Point[1],h.Normal[1]);
    ASSERT_EQ(hits.size(), 1u) << x;
    EXPECT_EQ(hits[0].Crossing, 0);
    EXPECT_LT((hits[0].Point - Vec3(x, 0, 0)).norm(), 1e-6);
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
