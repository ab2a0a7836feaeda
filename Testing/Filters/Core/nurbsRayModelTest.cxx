// SPDX-License-Identifier: BSD-3-Clause
// Rays through models: trimming, tolerances of edges, places; bad rays; the tree of boxes.
#include "BoxTree.h"
#include "ModelBuilder.h"
#include "PatchStitcher.h"
#include "nurbsRayReference.h"

#include <atomic>
#include <thread>

using namespace nurbs;
using namespace reference;

TEST(RayModel, FarAwayAndOffTheOrigin)
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

/// Adds the face z = 0 over [x0, x1] x [0, 1] as a part of the plane [-1, 3] x [-1, 2] to
/// `builder`; the sides x = x0 and x = x1 name the edges given.
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

TEST(RayModel, TrimsAway)
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

TEST(RayModel, TrimsCurvedFaces)
{
  // A torus with a disc of its domain, and without it: cells are inside, outside and cut.
  const Shape whole({ reference::Torus(1.0, 0.35) });
  const RayCaster all(whole.Content);
  const Curve<2> circle = TrimCircle(Vec2(0.45, 0.55), 0.2);
  for (const bool hole : { false, true })
  {
    ModelBuilder builder;
    builder.BeginFace(whole.Surfaces[0].View(), FaceAttributes());
    const Vec2 corners[5] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 }, { 0, 0 } };
    if (hole)
    {
      builder.BeginLoop();
      for (int k = 0; k < 4; ++k)
      {
        builder.AddTrimCurve(TrimLine(corners[k], corners[k + 1], Interval()).View(), -1, false);
      }
    }
    builder.BeginLoop();
    builder.AddTrimCurve(circle.View(), -1, hole);
    const AssembledModel model = AssembleModel(builder.Arrays());
    const RayCaster caster(model.Model);
    EXPECT_LT(caster.PartCount(), hole ? all.PartCount() : all.PartCount() / 4);
    reference::Random random(13);
    std::vector<RayHit> hits, expected;
    int kept = 0, removed = 0;
    for (int i = 0; i < 5000; ++i)
    {
      const Ray ray = LineThrough(RandomPoint(all.Bounds(), random), RandomDirection(random), 3.0);
      all.All(ray, expected);
      caster.All(ray, hits);
      std::size_t next = 0;
      for (const RayHit& hit : expected)
      {
        const double distance = (Vec2(hit.U, hit.V) - Vec2(0.45, 0.55)).norm() - 0.2;
        ASSERT_GT(std::abs(distance), 1e-9);
        if ((distance < 0.0) != hole)
        {
          ++kept;
          ASSERT_LT(next, hits.size());
          EXPECT_LT((hits[next].Point - hit.Point).norm(), 1e-12);
          EXPECT_EQ(hits[next].Crossing, hit.Crossing);
          ++next;
        }
        else
        {
          ++removed;
        }
      }
      ASSERT_EQ(next, hits.size());
    }
    EXPECT_GT(std::min(kept, removed), 500);
  }
}

TEST(RayModel, EdgesHoldWithinTheirTolerance)
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

namespace
{

/// Expects the same of a caster that cuts surfaces where rays come near.
void ExpectSameWhenMet(const Model& model, int count, reference::Random& random)
{
  const RayCaster all(model);
  const RayCaster some(model, RayCaster::Cutting::WhenMet);
  const double size = all.Bounds().diagonal().norm();
  // A box around no more than what is left of faces, where the other one may know it less well.
  const Vec3 slack = Vec3::Constant(1e-6 * size);
  EXPECT_TRUE(Box3(all.Bounds().min() - slack, all.Bounds().max() + slack).contains(some.Bounds()));
  int hit = 0;
  std::vector<RayHit> hits, expected;
  for (int i = 0; i < count; ++i)
  {
    const Ray ray = LineThrough(RandomPoint(all.Bounds(), random), RandomDirection(random), size);
    RayHit near, nearExpected;
    ASSERT_EQ(some.Nearest(ray, near), all.Nearest(ray, nearExpected));
    EXPECT_EQ(near.Face, nearExpected.Face);
    EXPECT_LT((near.Point - nearExpected.Point).norm(), 1e-12 * size);
    some.All(ray, hits);
    all.All(ray, expected);
    ASSERT_EQ(hits.size(), expected.size());
    for (std::size_t k = 0; k < hits.size(); ++k)
    {
      EXPECT_EQ(hits[k].Face, expected[k].Face);
      EXPECT_TRUE(some.Bounds().contains(hits[k].Point));
      EXPECT_LT((hits[k].Point - expected[k].Point).norm(), 1e-12 * size);
    }
    hit += hits.empty() ? 0 : 1;
  }
  EXPECT_GT(hit, count / 10);
}

} // namespace

TEST(RayModel, CutsWhereRaysComeNear)
{
  reference::Random random(21);
  const Shape torus({ reference::Torus(1.0, 0.35), reference::Sphere(0.5) });
  ExpectSameWhenMet(torus.Content, 1000, random);
  for (const double tolerance : { 1e-3, 0.0 })
  {
    // Parts of surfaces, with a gap, and a disc of a torus.
    ModelBuilder builder;
    const std::int64_t edge = builder.AddUnknownEdge(tolerance, -1, -1);
    AddTrimmedSquare(builder, 0.0, 0.999, -1, edge);
    AddTrimmedSquare(builder, 1.0, 2.0, edge, -1);
    builder.BeginFace(torus.Surfaces[0].View(), FaceAttributes());
    builder.BeginLoop();
    builder.AddTrimCurve(TrimCircle(Vec2(0.45, 0.55), 0.2).View(), -1, false);
    const AssembledModel model = AssembleModel(builder.Arrays());
    ASSERT_TRUE(model.Problems.empty());
    ExpectSameWhenMet(model.Model, 4000, random);
  }
}

// The precision of boxes is of the model's size, wherever it is.
TEST(RayModel, CutsFarFromTheOrigin)
{
  reference::Random random(23);
  for (const double scale : { 1.0, 1e-20, 1e20 })
  {
    for (const Vec3& shift : { Vec3(0, 0, 0), Vec3(5e6, 0, 0), Vec3(-1e5, 2e7, 3.0) })
    {
      Surface torus = reference::Torus(1.0, 0.35);
      for (Vec3& point : torus.Points)
      {
        point = scale * (point + shift);
      }
      const Shape shape({ torus });
      const RayCaster caster(shape.Content, RayCaster::Cutting::WhenMet);
      const Box3 box = caster.Bounds();
      EXPECT_NEAR(box.sizes()[0], 2.7 * scale, 3e-6 * scale);
      EXPECT_NEAR(box.sizes()[2], 0.7 * scale, 3e-6 * scale);
      EXPECT_LT((box.center() - scale * shift).norm(), 3e-6 * scale);
      // Lines along z within the ring, where the torus's circle is known.
      for (int i = 0; i < 100; ++i)
      {
        const double angle = random.Uniform(0.0, 6.0), radius = random.Uniform(0.7, 1.3);
        const Vec3 from(radius * std::cos(angle), radius * std::sin(angle), 2.0);
        Ray ray;
        ray.Origin = scale * (from + shift);
        ray.Direction = Vec3(0, 0, -1);
        RayHit hit;
        ASSERT_TRUE(caster.Nearest(ray, hit));
        const double height = std::sqrt(0.35 * 0.35 - (radius - 1.0) * (radius - 1.0));
        EXPECT_NEAR(hit.Point[2] / scale - shift[2], height, 1e-6);
      }
    }
  }
}

TEST(RayModel, CutsForManyThreads)
{
  const Shape shape({ reference::Torus(1.0, 0.35) });
  const RayCaster all(shape.Content);
  const RayCaster some(shape.Content, RayCaster::Cutting::WhenMet);
  std::vector<std::thread> threads;
  std::atomic<int> different{ 0 };
  for (int t = 0; t < 4; ++t)
  {
    threads.emplace_back([&]() {
      reference::Random random(22);
      for (int i = 0; i < 1000; ++i)
      {
        const Ray ray =
          LineThrough(RandomPoint(all.Bounds(), random), RandomDirection(random), 3.0);
        RayHit a, b;
        const bool isHit = all.Nearest(ray, a);
        different += some.Nearest(ray, b) != isHit || (isHit && std::abs(a.T - b.T) > 1e-12);
      }
    });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  EXPECT_EQ(different, 0);
}

TEST(RayModel, BadRaysThrow)
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
      tree.Search([&](const Box3& box) { return box.contains(o); },
        [&](std::int32_t box, const Box3&) { ++found[box]; });
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
