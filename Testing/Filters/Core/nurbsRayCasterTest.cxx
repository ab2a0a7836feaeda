// SPDX-License-Identifier: BSD-3-Clause
#include "ModelBuilder.h"
#include "PatchStitcher.h"
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
  hits.erase(
    std::remove_if(hits.begin(), hits.end(), [](const RayHit& hit) { return hit.Crossing == 0; }),
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

/// Intersections by plain means: patches whose box the ray meets are halved until they are small, and
/// Newton's method for S(u, v) = o + t d starts from the middle of each.
class PlainSearch
{
public:
  PlainSearch(const Surface& surface, const Ray& ray)
    : View(surface.View())
    , Given(ray)
  {
    for (const BezierPatch& patch : ToBezier(this->View))
    {
      this->Halve(patch, 0);
    }
    std::sort(this->Found.begin(), this->Found.end(),
      [](const Vec3& a, const Vec3& b) { return a[2] < b[2]; });
  }

  std::vector<Vec3> Found; ///< (u, v, t), sorted by t.

private:
  void Halve(const BezierPatch& patch, int depth)
  {
    Box3 box;
    for (const Vec4& h : patch.Points)
    {
      box.extend(h.head<3>() / h[3]);
    }
    double low = -1e9, high = 1e9;
    for (int k = 0; k < 3; ++k)
    {
      const double a = (box.min()[k] - 1e-9 - this->Given.Origin[k]) / this->Given.Direction[k];
      const double b = (box.max()[k] + 1e-9 - this->Given.Origin[k]) / this->Given.Direction[k];
      low = std::max(low, std::min(a, b));
      high = std::min(high, std::max(a, b));
    }
    if (low > high)
    {
      return;
    }
    if (depth == 12)
    {
      this->Refine(Vec3(
        0.5 * (patch.U.Min + patch.U.Max), 0.5 * (patch.V.Min + patch.V.Max), 0.5 * (low + high)));
      return;
    }
    BezierPatch a, b;
    SplitBezierPatch(patch, depth % 2, 0.5, a, b);
    this->Halve(a, depth + 1);
    this->Halve(b, depth + 1);
  }

  void Refine(Vec3 x)
  {
    const Interval u = this->View.Domain(0), v = this->View.Domain(1);
    for (int step = 0; step < 12; ++step)
    {
      const SurfaceDerivatives d = EvaluateDerivatives(this->View, x[0], x[1], 1);
      Eigen::Matrix3d jacobian;
      jacobian << d.Su, d.Sv, -this->Given.Direction;
      x -= jacobian.inverse() * (d.S - this->Given.Origin - x[2] * this->Given.Direction);
      x[0] = u.Clamp(x[0]);
      x[1] = v.Clamp(x[1]);
    }
    const Vec3 off =
      Evaluate(this->View, x[0], x[1]) - this->Given.Origin - x[2] * this->Given.Direction;
    bool known = off.norm() > 1e-10;
    for (const Vec3& other : this->Found)
    {
      known = known || (other - x).norm() < 1e-7;
    }
    if (!known)
    {
      this->Found.push_back(x);
    }
  }

  SurfaceView View;
  Ray Given;
};

/// A closed surface like a torus, and like nothing else: its seams agree bit for bit.
Surface Blob(reference::Random& random)
{
  Surface s = reference::Torus(1.0, 0.5);
  for (int j = 0; j < 9; ++j)
  {
    for (int i = 0; i < 9; ++i)
    {
      const int first = i % 8 + 9 * (j % 8);
      if (first == i + 9 * j)
      {
        s.Points[first] += 0.25 * RandomDirection(random);
        s.Weights[first] *= random.Uniform(0.7, 1.4);
      }
      s.Points[i + 9 * j] = s.Points[first];
      s.Weights[i + 9 * j] = s.Weights[first];
    }
  }
  return s;
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
        worst = std::max(worst, (ray.Origin + hit.T * ray.Direction - hit.Point).norm() / size);
        EXPECT_LT((Evaluate(surface.View(), hit.U, hit.V) - hit.Point).norm(), 1e-12 * size);
        if (!IsNearKnot(surface, hit.U, hit.V))
        {
          EXPECT_LT((Normal(surface.View(), hit.U, hit.V) - hit.Normal).norm(), 1e-6);
        }
      }
      const double sine = std::abs(d.dot(normal));
      ASSERT_LT(nearest, 1e-12 * size / std::max(sine, 1e-6)) << degree << " at " << u << " " << v;
    }
    EXPECT_LT(worst, 1e-12) << "degree " << degree;
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

TEST(RayCaster, FarAwayAndOffTheOrigin)
{
  Surface sphere = reference::Sphere(1.0);
  const Vec3 place(3e4, -2e4, 1e4);
  for (Vec3& p : sphere.Points)
  {
    p += place;
  }
  const Shape shape({ sphere });
  const RayCaster caster(shape.Content);
  reference::Random random(9);
  std::vector<RayHit> hits;
  for (int i = 0; i < 500; ++i)
  {
    const Vec3 d = RandomDirection(random);
    const Vec3 aim = d.unitOrthogonal() * random.Uniform(0.0, 0.99);
    Ray ray;
    ray.Origin = place + aim - 1e7 * d;
    ray.Direction = d;
    caster.All(ray, hits);
    ASSERT_EQ(hits.size(), 2u);
    ExpectClosed(hits);
    const double half = std::sqrt(1.0 - aim.squaredNorm());
    EXPECT_NEAR(hits[0].T, 1e7 - half, 1e-7);
    EXPECT_LT((hits[0].Point - (place + aim - half * d)).norm(), 1e-7);
    EXPECT_NEAR((hits[1].Point - place).norm(), 1.0, 1e-10);
  }
}

namespace
{

/// Adds the face z = 0 over [x0, x1] x [0, 1] as a part of the plane [-1, 3] x [-1, 2] to `builder`;
/// the sides x = x0 and x = x1 name the edges given.
void AddTrimmedSquare(
  ModelBuilder& builder, double x0, double x1, std::int64_t edge0, std::int64_t edge1)
{
  Surface plane = Plate(Vec3(-1, -1, 0), Vec3(3, -1, 0), Vec3(-1, 2, 0), Vec3(3, 2, 0));
  plane.Knots[0] = { -1, -1, 3, 3 };
  plane.Knots[1] = { -1, -1, 2, 2 };
  builder.BeginFace(plane.View(), FaceAttributes());
  builder.BeginLoop();
  const Vec2 corners[5] = { { x0, 0 }, { x1, 0 }, { x1, 1 }, { x0, 1 }, { x0, 0 } };
  for (int k = 0; k < 4; ++k)
  {
    const Curve<2> line = TrimLine(corners[k], corners[k + 1], Interval());
    builder.AddTrimCurve(line.View(), k == 1 ? edge1 : (k == 3 ? edge0 : -1), false);
  }
}

} // namespace

TEST(RayCaster, TrimsAway)
{
  ModelBuilder builder;
  AddTrimmedSquare(builder, 0.0, 1.0, -1, -1);
  builder.BeginLoop();
  const Curve<2> circle = TrimCircle(Vec2(0.4, 0.5), 0.25);
  builder.AddTrimCurve(circle.View(), -1, true);
  const AssembledModel model = AssembleModel(builder.Arrays());
  ASSERT_TRUE(model.Problems.empty());
  const RayCaster caster(model.Model);
  reference::Random random(10);
  int in = 0;
  for (int i = 0; i < 20000; ++i)
  {
    const double angle = random.Uniform(0, 2 * Pi);
    // Half of them within 1e-6 of the circle.
    const double radius = i % 2 == 0 ? random.Uniform(0, 1) : 0.25 + random.Uniform(-1e-6, 1e-6);
    const Vec2 p = Vec2(0.4, 0.5) + radius * Vec2(std::cos(angle), std::sin(angle));
    const double border = std::min({ std::abs(radius - 0.25), std::abs(p[0]), std::abs(p[1]),
      std::abs(1.0 - p[0]), std::abs(1.0 - p[1]) });
    if (border < 2e-10)
    {
      continue;
    }
    const bool inside = radius > 0.25 && p.minCoeff() > 0.0 && p.maxCoeff() < 1.0;
    in += inside ? 1 : 0;
    RayHit hit;
    const Ray ray = LineThrough(Vec3(p[0], p[1], 0), RandomDirection(random), 3.0);
    ASSERT_EQ(caster.Nearest(ray, hit), inside) << p.transpose() << " " << border;
    if (inside)
    {
      EXPECT_LT((Vec2(hit.U, hit.V) - p).norm(), 1e-11);
    }
  }
  EXPECT_GT(in, 5000);
}

TEST(RayCaster, EdgesHoldWithinTheirTolerance)
{
  reference::Random random(11);
  for (const double gap : { 1e-6, 0.0, -1e-6 })
  {
    for (const double tolerance : { 1e-6, 0.0 })
    {
      // Two squares next to each other, their sides `gap` apart.
      ModelBuilder builder;
      const std::int64_t edge = builder.AddUnknownEdge(tolerance, -1, -1);
      AddTrimmedSquare(builder, 0.0, 1.0 - 0.5 * gap, -1, edge);
      AddTrimmedSquare(builder, 1.0 + 0.5 * gap, 2.0, edge, -1);
      const AssembledModel model = AssembleModel(builder.Arrays());
      const RayCaster caster(model.Model);
      for (int i = 0; i < 1000; ++i)
      {
        const Vec3 d = RandomDirection(random);
        if (std::abs(d[2]) < 0.05)
        {
          continue;
        }
        const Vec3 point(1.0 + 0.49 * gap * random.Uniform(-1, 1), random.Uniform(0.1, 0.9), 0);
        std::vector<RayHit> hits;
        caster.All(LineThrough(point, d, 3.0), hits);
        const bool slips = gap > 0.0 && tolerance == 0.0;
        if (gap >= 0.0 || tolerance > 0.0)
        {
          ASSERT_EQ(hits.size(), slips ? 0u : 1u) << gap << " " << tolerance;
        }
      }
    }
  }
}

TEST(RayCaster, BadRaysThrow)
{
  const Shape shape({ reference::Sphere(1.0) });
  const RayCaster caster(shape.Content);
  RayHit hit;
  std::vector<RayHit> hits;
  Ray ray;
  ray.Direction = Vec3::Zero();
  EXPECT_THROW(caster.Nearest(ray, hit), Error);
  ray.Direction = Vec3(0, 0, std::nan(""));
  EXPECT_THROW(caster.All(ray, hits), Error);
  ray.Direction = Vec3(0, 0, 1);
  ray.Origin[0] = std::numeric_limits<double>::infinity();
  EXPECT_THROW(caster.IsBlocked(ray), Error);
  ray.Origin[0] = 0.0;
  ray.Max = std::nan("");
  EXPECT_THROW(caster.Nearest(ray, hit), Error);
  // An empty model has no hit.
  const Model nothing;
  EXPECT_FALSE(RayCaster(nothing).Nearest(Ray(), hit));
  RayCaster(nothing).All(Ray(), hits);
  EXPECT_TRUE(hits.empty());
}

TEST(BoxTree, VisitsAllThatTheRayMeets)
{
  reference::Random random(12);
  for (const int count : { 1, 2, 3, 50, 1000 })
  {
    std::vector<Box3> boxes;
    const Box3 room(Vec3(-1, -1, -1), Vec3(1, 1, 1));
    for (int i = 0; i < count; ++i)
    {
      const Vec3 a = i % 7 == 6 ? boxes.back().min() : RandomPoint(room, random);
      Box3 box(a);
      box.extend(Vec3(a + 0.2 * RandomDirection(random)));
      boxes.push_back(i % 5 == 4 ? Box3(a) : box);
    }
    BoxTree tree;
    tree.Build(boxes, 0.0);
    for (int i = 0; i < 200; ++i)
    {
      const Vec3 d = i % 10 == 0 ? Vec3(Vec3::Unit(i / 10 % 3)) : RandomDirection(random);
      const Vec3 o =
        i % 3 == 0 ? boxes[random.Integer(0, count - 1)].center() : RandomPoint(room, random);
      const double low = random.Uniform(-1, 0);
      double high = random.Uniform(0, 1);
      const double limit = high;
      std::vector<int> visits(count, 0);
      tree.Walk(BoxRay(o, d), low, high, [&](std::int32_t box) {
        ++visits[box];
        return limit;
      });
      std::vector<int> found(count, 0);
      tree.Search(
        [&](const Box3& box) { return box.contains(o); }, [&](std::int32_t box, const Box3&) { ++found[box]; });
      for (int k = 0; k < count; ++k)
      {
        double a = low, b = limit;
        for (int axis = 0; axis < 3; ++axis)
        {
          const double s = (boxes[k].min()[axis] - o[axis]) / d[axis];
          const double t = (boxes[k].max()[axis] - o[axis]) / d[axis];
          if (d[axis] != 0.0)
          {
            a = std::max(a, std::min(s, t));
            b = std::min(b, std::max(s, t));
          }
          else if (o[axis] < boxes[k].min()[axis] || o[axis] > boxes[k].max()[axis])
          {
            b = a - 1.0;
          }
        }
        ASSERT_LE(visits[k], 1);
        EXPECT_TRUE(visits[k] == 1 || a > b) << k;
        EXPECT_TRUE(visits[k] == 0 || a <= b + 1e-5) << k; // floats
        EXPECT_TRUE(found[k] == 1 || !boxes[k].contains(o)) << k;
      }
    }
  }
}
