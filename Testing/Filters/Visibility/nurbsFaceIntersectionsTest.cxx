// SPDX-License-Identifier: BSD-3-Clause
// Intersection curves of faces: lengths and places against closed forms, completeness against
// isolines of one face cast at the other one; neighbours, duplicates and touching faces give none.
#include "FaceIntersections.h"
#include "RayCaster.h"
#include "Shapes.h"
#include "nurbsModelShapes.h"
#include "nurbsSilhouetteReference.h"

#include <gtest/gtest.h>

#include <chrono>
#include <random>

namespace
{

using Eigen::AngleAxisd;
using Eigen::Translation3d;
using nurbs::FaceIntersection;
using nurbs::FaceIntersections;
using nurbs::IntersectionPoint;
using nurbs::Model;
using nurbs::ModelBuilder;
using nurbs::Vec2;
using nurbs::Vec3;
using Place = Eigen::Isometry3d;

const double Pi = std::acos(-1.0);

Place At(double x, double y, double z)
{
  return Place(Translation3d(x, y, z));
}

Place Turned(double x, double y, double z, double angle)
{
  return Place(AngleAxisd(angle, Vec3(x, y, z).normalized()));
}

struct Scene
{
  ModelBuilder Builder;
  nurbs::AssembledModel Made;
  nurbs::CompletedModel Whole;
  FaceIntersections Result;
  double Precision = 1e-4;
  double Seconds = 0.0;

  // Adds a shape and moves it.
  template <typename Shape>
  void Add(const Shape& shape, const Place& place)
  {
    auto& data = this->Builder.Data;
    const std::size_t points = data.Points.size();
    const std::size_t edges = data.EdgePoints.size();
    const std::size_t vertices = data.VertexPoints.size();
    shape(this->Builder);
    const auto move = [&](std::vector<double>& values, std::size_t first, int stride) {
      for (std::size_t k = first; k < values.size(); k += stride)
      {
        Eigen::Map<Vec3> p(values.data() + k);
        p = place * Vec3(p);
      }
    };
    move(data.Points, points, 3);
    move(data.EdgePoints, edges, 4);
    move(data.VertexPoints, vertices, 3);
  }

  void Run(double precision)
  {
    this->Precision = precision;
    this->Made = nurbs::AssembleModel(this->Builder.Arrays());
    for (const std::string& error : this->Made.FaceErrors)
    {
      ASSERT_EQ(error, "");
    }
    this->Whole = nurbs::CompleteModel(this->Made.Model, this->Made.FaceErrors, 1e-7);
    const nurbs::TrimIndex trims(this->Made.Model);
    nurbs::FaceIntersectionOptions options;
    options.Precision = precision;
    const auto start = std::chrono::steady_clock::now();
    this->Result =
      nurbs::FindIntersections(this->Whole.Data, trims, this->Made.FaceErrors, options);
    this->Seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    this->Check();
  }

  // All that holds for any curve: points on both surfaces, short chords, ends on trim curves.
  void Check() const
  {
    const Model& model = this->Whole.Data;
    for (const FaceIntersection& curve : this->Result.Curves)
    {
      ASSERT_LT(curve.Face[0], curve.Face[1]);
      ASSERT_GE(curve.Points.size(), 2u);
      for (const IntersectionPoint& point : curve.Points)
      {
        for (int side = 0; side < 2; ++side)
        {
          const nurbs::SurfaceView& surface = model.Faces[curve.Face[side]].Geometry;
          const Vec3 p = nurbs::Evaluate(surface, point.UV[side][0], point.UV[side][1]);
          EXPECT_LT((p - point.Point).norm(), 1e-9);
        }
      }
      EXPECT_TRUE(!curve.Closed || curve.Points.front().UV[0] == curve.Points.back().UV[0]);
      for (int end = 0; end < 2 && !curve.Closed; ++end)
      {
        const IntersectionPoint& point = end == 0 ? curve.Points.front() : curve.Points.back();
        ASSERT_GE(curve.Ends[end].Curve, 0);
        const Vec2 uv = nurbs::Evaluate(
          model.TrimCurves[curve.Ends[end].Curve].Geometry, curve.Ends[end].Parameter);
        EXPECT_LT(std::min((uv - point.UV[0]).norm(), (uv - point.UV[1]).norm()), 1e-9);
      }
    }
  }

  double Length() const
  {
    double sum = 0.0;
    for (const FaceIntersection& curve : this->Result.Curves)
    {
      for (std::size_t k = 1; k < curve.Points.size(); ++k)
      {
        sum += (curve.Points[k].Point - curve.Points[k - 1].Point).norm();
      }
    }
    return sum;
  }

  // Largest distance(point) of points and of middles of chords.
  template <typename Distance>
  double Farthest(const Distance& distance, bool middles) const
  {
    double largest = 0.0;
    for (const FaceIntersection& curve : this->Result.Curves)
    {
      for (std::size_t k = 1; k < curve.Points.size(); ++k)
      {
        const Vec3& a = curve.Points[k - 1].Point;
        const Vec3& b = curve.Points[k].Point;
        largest = std::max(largest, distance(middles ? Vec3(0.5 * (a + b)) : b));
      }
    }
    return largest;
  }

  double DistanceToCurves(const Vec3& p) const
  {
    double least = 1e300;
    for (const FaceIntersection& curve : this->Result.Curves)
    {
      for (std::size_t k = 1; k < curve.Points.size(); ++k)
      {
        least = std::min(
          least, nurbs::DistanceToSegment(p, curve.Points[k - 1].Point, curve.Points[k].Point));
      }
    }
    return least;
  }

  // Casts chords of isolines of each face at all later ones: hits must lie on a curve. Returns how
  // many there are, but for those near the borders of the domains, where neighbours meet; `missed`
  // are farther than `reach` from all curves.
  int CastIsolines(int lines, double reach, int& missed) const
  {
    const Model& model = this->Made.Model;
    const nurbs::RayCaster caster(model);
    int count = 0;
    missed = 0;
    const int steps = 4 * lines;
    for (std::size_t f = 0; f < model.Faces.size(); ++f)
    {
      const nurbs::SurfaceView& surface = model.Faces[f].Geometry;
      const auto isInner = [&](std::int64_t face, const Vec2& uv) {
        bool inner = true;
        for (int d = 0; d < 2; ++d)
        {
          const nurbs::Interval domain = model.Faces[face].Geometry.Domain(d);
          const double share = (uv[d] - domain.Min) / domain.Length();
          inner = inner && share > 0.02 && share < 0.98;
        }
        return inner;
      };
      const auto at = [&](double u, double v) {
        const nurbs::Interval du = surface.Domain(0);
        const nurbs::Interval dv = surface.Domain(1);
        return Vec2(du.Min + u * du.Length(), dv.Min + v * dv.Length());
      };
      for (int k = 0; k < 2 * lines; ++k)
      {
        const double c = (k / 2 + 0.4713) / lines;
        Vec2 before;
        for (int s = 0; s <= steps; ++s)
        {
          const double t = double(s) / steps;
          const Vec2 uv = k % 2 == 0 ? at(t, c) : at(c, t);
          if (s > 0 && caster.GetTrims().Inside(std::int64_t(f), uv[0], uv[1]) &&
            caster.GetTrims().Inside(std::int64_t(f), before[0], before[1]))
          {
            nurbs::Ray ray;
            ray.Origin = nurbs::Evaluate(surface, before[0], before[1]);
            ray.Direction = nurbs::Evaluate(surface, uv[0], uv[1]) - ray.Origin;
            ray.Max = 1.0;
            std::vector<nurbs::RayHit> hits;
            if (ray.Direction.norm() > 0.0)
            {
              caster.All(ray, hits);
            }
            for (const nurbs::RayHit& hit : hits)
            {
              if (hit.Face > std::int64_t(f) && isInner(std::int64_t(f), uv) &&
                isInner(hit.Face, Vec2(hit.U, hit.V)))
              {
                ++count;
                missed += this->DistanceToCurves(hit.Point) > reach;
              }
            }
          }
          before = uv;
        }
      }
    }
    return count;
  }
};

const auto Sphere = [](double radius) {
  return [radius](ModelBuilder& builder) { nurbs::AddSphere(builder, radius); };
};
const auto Cylinder = [](double radius, double height) {
  return
    [radius, height](ModelBuilder& builder) { nurbs::AddCylinder(builder, radius, height, true); };
};
const auto Disc = [](double radius) {
  return [radius](ModelBuilder& builder) { nurbs::AddDisc(builder, radius); };
};
const auto FlatPlate = [](double width) {
  return [width](ModelBuilder& builder) { nurbs::AddPlate(builder, width, width, 0, 0); };
};

// Length of a closed curve by the chords of very many points.
template <typename Curve>
double LengthOf(const Curve& curve)
{
  constexpr int Count = 200000;
  double sum = 0.0;
  Vec3 before = curve(0.0);
  for (int k = 1; k <= Count; ++k)
  {
    const Vec3 next = curve(2.0 * Pi * k / Count);
    sum += (next - before).norm();
    before = next;
  }
  return sum;
}

} // namespace

TEST(FaceIntersections, TwoSpheres)
{
  for (const double angle : { 0.0, 0.7, 2.1 })
  {
    for (const double precision : { 1e-2, 1e-4, 1e-6 })
    {
      Scene scene;
      scene.Add(Sphere(1.0), Turned(1, 2, 3, angle));
      scene.Add(Sphere(1.0), At(0.6, 0.8, 0.0) * Turned(3, -1, 1, 2.0 * angle));
      scene.Run(precision);
      const double radius = std::sqrt(0.75);
      const auto distance = [&](const Vec3& p) {
        const Vec3 axis(0.6, 0.8, 0.0);
        const double along = axis.dot(p) - 0.5;
        const double out = (p - axis.dot(p) * axis).norm() - radius;
        return std::hypot(along, out);
      };
      EXPECT_LT(scene.Farthest(distance, false), 1e-9);
      EXPECT_LT(scene.Farthest(distance, true), precision);
      EXPECT_NEAR(scene.Length(), 2.0 * Pi * radius, 20.0 * precision);
    }
  }
}

TEST(FaceIntersections, CrossingCylinders)
{
  Scene scene;
  scene.Add(Cylinder(1.0, 4.0), At(0, 0, -2));
  scene.Add(Cylinder(0.5, 4.0), Turned(0, 1, 0, Pi / 2) * Turned(0, 0, 1, 0.3) * At(0, 0, -2));
  scene.Run(1e-5);
  const auto loop = [](double t) {
    const double y = 0.5 * std::cos(t);
    return Vec3(std::sqrt(1.0 - y * y), y, 0.5 * std::sin(t));
  };
  EXPECT_NEAR(scene.Length(), 2.0 * LengthOf(loop), 1e-3);
  const auto distance = [](const Vec3& p) {
    return std::max(std::abs(std::hypot(p[0], p[1]) - 1.0), std::abs(std::hypot(p[1], p[2]) - 0.5));
  };
  EXPECT_LT(scene.Farthest(distance, false), 1e-9);
}

TEST(FaceIntersections, SphereAndCylinderInOneLoop)
{
  // Nearly Viviani's curve.
  Scene scene;
  scene.Add(Sphere(2.0), Turned(1, 1, 0, 0.4));
  scene.Add(Cylinder(1.2, 6.0), At(1.0, 0, -3));
  scene.Run(1e-5);
  const double limit = std::acos((4.0 - 1.0 - 1.44) / 2.4);
  const auto upper = [&](double t) {
    // The part of the cylinder's circle that is inside the sphere; the root's ends made smooth.
    const double phi = limit + (2.0 * Pi - 2.0 * limit) * 0.5 * (1.0 - std::cos(0.5 * t));
    const double x = 1.0 + 1.2 * std::cos(phi);
    const double y = 1.2 * std::sin(phi);
    return Vec3(x, y, std::sqrt(std::max(0.0, 4.0 - x * x - y * y)));
  };
  EXPECT_NEAR(scene.Length(), 2.0 * LengthOf(upper), 1e-3);
}

TEST(FaceIntersections, TorusAndDisc)
{
  const auto torus = [](ModelBuilder& builder) { nurbs::AddTorus(builder, 2.0, 0.5); };
  const Place turned = Turned(1, 3, 2, 1.0);
  // Through two sides of patches; through one and the seam, which is an edge; through none.
  for (const auto& [angle, circles] :
    { std::pair(Pi / 2, 2), std::pair(0.0, 1), std::pair(0.4, 2) })
  {
    Scene scene;
    scene.Add(torus, turned);
    scene.Add(Disc(3.0), turned * Turned(0, 0, 1, angle) * Turned(1, 0, 0, Pi / 2));
    scene.Run(1e-5);
    EXPECT_NEAR(scene.Length(), circles * Pi, 1e-3) << angle;
  }
}

TEST(FaceIntersections, AlongSidesOfPatches)
{
  // The equator of a sphere is a side of all of its patches, and so may be that of the other
  // surface.
  Scene scene;
  scene.Add(Sphere(1.0), Place::Identity());
  scene.Add([](ModelBuilder& builder) { nurbs::AddTorus(builder, 2.0, 1.5); }, At(0, 0, 0));
  scene.Add(Disc(3.0), At(0, 0, 0));
  scene.Run(1e-5);
  // Sphere and torus: two circles where rho^2 + z^2 = 1 and (rho - 2)^2 + z^2 = 2.25; the disc
  // meets the sphere's equator and the torus at rho = 0.5, at 3.5 not: it is smaller.
  const double rho = (1.0 + 4.0 - 2.25) / 4.0;
  EXPECT_NEAR(scene.Length(), 2.0 * Pi * (2.0 * rho + 1.0 + 0.5), 2e-3);
}

TEST(FaceIntersections, TrimsOfBothEndCurves)
{
  // Two discs across each other, the second shifted along the common line: a chord from the border
  // of one to the border of the other.
  Scene scene;
  scene.Add(Disc(1.0), Turned(1, 2, 1, 0.5));
  scene.Add(Disc(1.0), Turned(1, 2, 1, 0.5) * At(0.5, 0, 0.3) * Turned(1, 0, 0, 1.1));
  scene.Run(1e-5);
  ASSERT_EQ(scene.Result.Curves.size(), 1u);
  // On the first: y = -0.3 / tan(1.1), z = 0; on the second: 0.3 / sin(1.1) from its middle.
  const double y = 0.3 / std::tan(1.1);
  const double s = 0.3 / std::sin(1.1);
  const double last = std::sqrt(1.0 - y * y);
  const double first = 0.5 - std::sqrt(1.0 - s * s);
  EXPECT_NEAR(scene.Length(), last - first, 1e-9);
}

TEST(FaceIntersections, PlateWithHoles)
{
  // A plane crosses a plate with holes along a line; the parts within holes are missing.
  Scene scene;
  scene.Add([](ModelBuilder& builder) { nurbs::AddPlate(builder, 10.0, 10.0, 5, 5); }, At(0, 0, 0));
  scene.Add(FlatPlate(30.0), At(-10, 3.2, -10) * Turned(1, 0, 0, Pi / 2 - 0.2));
  scene.Run(1e-5);
  const nurbs::TrimIndex trims(scene.Made.Model);
  double inside = 0.0;
  const double y = scene.Result.Curves.empty() ? 0.0 : scene.Result.Curves[0].Points[0].Point[1];
  for (int k = 0; k < 200000; ++k)
  {
    const double x = 10.0 * (k + 0.5) / 200000;
    const nurbs::SurfaceView& surface = scene.Made.Model.Faces[0].Geometry;
    const double u = surface.Domain(0).Min + x / 10.0 * surface.Domain(0).Length();
    const double v = surface.Domain(1).Min + y / 10.0 * surface.Domain(1).Length();
    inside += trims.Inside(0, u, v) ? 10.0 / 200000 : 0.0;
  }
  EXPECT_GT(scene.Result.Curves.size(), 3u);
  EXPECT_NEAR(scene.Length(), inside, 1e-3);
}

TEST(FaceIntersections, NeighboursDoNot)
{
  const std::vector<std::function<void(ModelBuilder&)>> shapes = {
    [](ModelBuilder& b) { nurbs::AddCylinder(b, 1.0, 2.0, true); },
    [](ModelBuilder& b) { nurbs::AddCone(b, 1.0, 2.0, true); },
    [](ModelBuilder& b) { shapes::AddBall(b, true); },
    [](ModelBuilder& b) { shapes::AddBall(b, false); },
    [](ModelBuilder& b) { shapes::AddPrism(b); },
    [](ModelBuilder& b) { shapes::AddHoles(b); },
    [](ModelBuilder& b) { nurbs::AddCarBody(b, 300); },
    [](ModelBuilder& b) { nurbs::AddSpring(b); },
    [](ModelBuilder& b) { nurbs::AddMissile(b); },
  };
  for (std::size_t k = 0; k < shapes.size(); ++k)
  {
    for (const double angle : { 0.0, 0.6 })
    {
      Scene scene;
      scene.Add(shapes[k], Turned(1, 2, 3, angle));
      scene.Run(k < 6 ? 1e-4 : 1e-2);
      EXPECT_EQ(scene.Result.Curves.size(), 0u) << "shape " << k << " length " << scene.Length();
      EXPECT_EQ(scene.Result.Unresolved.size(), 0u) << "shape " << k;
    }
  }
}

TEST(FaceIntersections, TouchingDoNot)
{
  const auto none = [](const char* name, const auto& a, const Place& placeA, const auto& b,
                      const Place& placeB) {
    Scene scene;
    scene.Add(a, placeA);
    scene.Add(b, placeB);
    scene.Run(1e-4);
    EXPECT_EQ(scene.Result.Curves.size(), 0u) << name << " length " << scene.Length();
    EXPECT_EQ(scene.Result.Unresolved.size(), 0u) << name;
    EXPECT_LT(scene.Seconds, 5.0) << name;
  };
  const Place turned = Turned(1, 2, 3, 0.8);
  none("tangent spheres", Sphere(1.0), turned, Sphere(1.0), turned * At(0, 1.2, 1.6));
  none("sphere in sphere", Sphere(2.0), turned, Sphere(1.0), turned * At(0, 0.6, 0.8));
  none("same sphere", Sphere(1.0), turned, Sphere(1.0), turned);
  none("same sphere turned", Sphere(1.0), turned, Sphere(1.0), Turned(1, 0, 0, 0.3));
  none("same cylinder turned", Cylinder(1.0, 2.0), turned, Cylinder(1.0, 2.0),
    turned * Turned(0, 0, 1, 0.3));
  none("shaft in hole", Cylinder(1.0, 2.0), turned, Cylinder(1.0, 3.0), turned * At(0, 0, 0.7));
  none("cylinder on plane", Cylinder(1.0, 2.0), turned * Turned(0, 1, 0, Pi / 2) * At(0, 0, -1),
    FlatPlate(6.0), turned * At(-3, -3, -1));
  none("cylinder beside cylinder", Cylinder(1.0, 2.0), turned, Cylinder(0.5, 2.0),
    turned * At(1.5, 0, 0.3));
  none("cylinder in cylinder", Cylinder(1.0, 2.0), turned, Cylinder(0.5, 2.0),
    turned * At(0.5, 0, 0.0));
  none(
    "cylinder stands on plane", Cylinder(1.0, 2.0), turned, FlatPlate(6.0), turned * At(-3, -3, 0));
  none(
    "torus on plane", [](ModelBuilder& b) { nurbs::AddTorus(b, 2.0, 0.5); }, turned, FlatPlate(8.0),
    turned * At(-4, -4, -0.5));
}

TEST(FaceIntersections, Teapot)
{
  Scene scene;
  scene.Add([](ModelBuilder& builder) { nurbs::AddTeapot(builder); }, At(0, 0, 0));
  scene.Run(1e-4);
  EXPECT_GT(scene.Length(), 1.0);
  EXPECT_EQ(scene.Result.Unresolved.size(), 0u);
  int missed = 0;
  // Between the open ends of patches and faces that they touch there are hits, too.
  const int hits = scene.CastIsolines(12, 5e-3, missed);
  EXPECT_GT(hits, 15);
  EXPECT_EQ(missed, 0) << "of " << hits;
}

TEST(FaceIntersections, RandomPatches)
{
  std::mt19937 random(4711);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  int curves = 0;
  for (int trial = 0; trial < 24; ++trial)
  {
    Scene scene;
    for (int s = 0; s < 2; ++s)
    {
      nurbs::Surface surface;
      const int p = 2 + trial % 3;
      surface.Degree[0] = surface.Degree[1] = p;
      surface.Count[0] = surface.Count[1] = p + 1;
      for (int d = 0; d < 2; ++d)
      {
        surface.Knots[d].assign(p + 1, 0.0);
        surface.Knots[d].resize(2 * p + 2, 1.0);
      }
      for (int k = 0; k < (p + 1) * (p + 1); ++k)
      {
        surface.Points.emplace_back(
          k % (p + 1) / double(p), k / (p + 1) / double(p), 0.5 * number(random));
        surface.Weights.push_back(trial % 2 ? 1.0 : 1.0 + 0.5 * number(random));
      }
      scene.Add(
        [&](ModelBuilder& builder) { builder.BeginFace(surface.View(), nurbs::FaceAttributes()); },
        s == 0 ? Place::Identity() : Turned(number(random), number(random), 1.0, 0.4));
    }
    scene.Run(1e-5);
    curves += int(scene.Result.Curves.size());
    int missed = 0;
    scene.CastIsolines(11, 5e-3, missed);
    EXPECT_EQ(missed, 0) << "trial " << trial;
  }
  EXPECT_GT(curves, 20);
}

TEST(FaceIntersections, SameWhateverTheOrder)
{
  Scene scene;
  scene.Add([](ModelBuilder& builder) { nurbs::AddTeapot(builder); }, At(0, 0, 0));
  scene.Add(Sphere(1.5), At(1, 0.3, 1));
  scene.Run(1e-3);
  nurbs::FaceIntersectionOptions options;
  options.Precision = 1e-3;
  options.Parallel = [](std::int64_t first, std::int64_t last,
                       const std::function<void(std::int64_t, std::int64_t)>& body) {
    for (std::int64_t k = last - 1; k >= first; --k)
    {
      body(k, k + 1);
    }
  };
  const FaceIntersections other = nurbs::FindIntersections(
    scene.Whole.Data, nurbs::TrimIndex(scene.Made.Model), scene.Made.FaceErrors, options);
  ASSERT_EQ(other.Curves.size(), scene.Result.Curves.size());
  EXPECT_GT(other.Curves.size(), 10u);
  for (std::size_t k = 0; k < other.Curves.size(); ++k)
  {
    const FaceIntersection& a = other.Curves[k];
    const FaceIntersection& b = scene.Result.Curves[k];
    EXPECT_TRUE(std::equal(a.Face, a.Face + 2, b.Face));
    ASSERT_EQ(a.Points.size(), b.Points.size());
    for (std::size_t p = 0; p < a.Points.size(); ++p)
    {
      EXPECT_EQ(a.Points[p].Point, b.Points[p].Point);
    }
  }
}

TEST(FaceIntersections, SmallLoops)
{
  // A sphere that comes through a plane by a little, in the middle of patches of both; and one that does
  // not reach it.
  for (const double depth : { 3e-3, 3e-4, -1e-6 })
  {
    Scene scene;
    scene.Add(Sphere(1.0), Turned(1, 2, 3, 0.7));
    scene.Add(FlatPlate(4.0), At(-1.7, -2.2, 1.0 - depth));
    scene.Run(1e-5);
    const double radius = depth > 0.0 ? std::sqrt(2.0 * depth - depth * depth) : 0.0;
    EXPECT_NEAR(scene.Length(), 2.0 * Pi * radius, 1e-3) << depth;
  }
}

TEST(FaceIntersections, WrongPrecision)
{
  Scene scene;
  scene.Add(Sphere(1.0), At(0, 0, 0));
  scene.Run(1e-3);
  const nurbs::TrimIndex trims(scene.Made.Model);
  nurbs::FaceIntersectionOptions options;
  for (const double precision : { 0.0, -1.0, std::nan("") })
  {
    options.Precision = precision;
    EXPECT_THROW(nurbs::FindIntersections(scene.Whole.Data, trims, scene.Made.FaceErrors, options),
      nurbs::Error);
  }
}

TEST(FaceIntersections, Abort)
{
  Scene scene;
  scene.Add(Sphere(1.0), At(0, 0, 0));
  scene.Add(Sphere(1.0), At(1, 0, 0));
  scene.Run(1e-3);
  const nurbs::TrimIndex trims(scene.Made.Model);
  nurbs::FaceIntersectionOptions options;
  options.Precision = 1e-3;
  options.Progress = [](double) { return false; };
  const FaceIntersections result =
    nurbs::FindIntersections(scene.Whole.Data, trims, scene.Made.FaceErrors, options);
  EXPECT_TRUE(result.Aborted);
  EXPECT_TRUE(result.Curves.empty());
}
