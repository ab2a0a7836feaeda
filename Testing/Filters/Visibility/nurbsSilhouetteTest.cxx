// SPDX-License-Identifier: BSD-3-Clause
// Silhouettes of analytic shapes against their closed forms, and of others against dense grids of
// signs.
#include "ModelExtent.h"
#include "Shapes.h"
#include "nurbsSilhouetteReference.h"

#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <thread>

using namespace reference;

namespace
{

const double Pi = std::acos(-1.0);

// A model of Shapes.h that owns its arrays.
struct Shape
{
  nurbs::ModelBuilder Builder;
  nurbs::AssembledModel Assembled;

  template <typename Add>
  explicit Shape(const Add& add)
  {
    add(this->Builder);
    this->Assembled = nurbs::AssembleModel(this->Builder.Arrays());
  }
  const Model& Get() const { return this->Assembled.Model; }
};

Shape Sphere()
{
  return Shape([](nurbs::ModelBuilder& builder) { nurbs::AddSphere(builder, 1.0); });
}

Shape Torus()
{
  return Shape([](nurbs::ModelBuilder& builder) { nurbs::AddTorus(builder, 1.0, 0.3); });
}

int CountOf(const Silhouettes& result, LineKind kind)
{
  int count = 0;
  for (const SilhouetteLine& line : result.Lines)
  {
    count += line.Kind == kind;
  }
  return count;
}

// What every silhouette keeps to.
Measure ExpectExact(
  const Model& model, const Silhouettes& result, const Viewer& viewer, double precision)
{
  const Measure measure = MeasureLines(model, result, viewer);
  EXPECT_LE(measure.Cosine, 1e-9);
  EXPECT_LE(measure.Offset, 1e-13);
  EXPECT_LE(measure.Chord, precision);
  EXPECT_EQ(measure.WrongSide, 0);
  EXPECT_EQ(result.InexactPoints, 0);
  return measure;
}

// Every line goes on in another one or is closed.
void ExpectClosed(const Silhouettes& result)
{
  for (const SilhouetteLine& line : result.Lines)
  {
    if (line.Kind == LineKind::Silhouette && !line.Closed)
    {
      EXPECT_GE(line.Next[0], 0);
      EXPECT_GE(line.Next[1], 0);
    }
  }
}

const std::vector<Vec3>& Directions()
{
  static const std::vector<Vec3> directions{ { 0, 0, 1 }, { 0, 0, -1 }, { 1, 0, 0 }, { 0, -1, 0 },
    { 1, 1, 0 }, { 0, 1, 1 }, { 1, 0, 1 }, { 1, 1, 1 }, { 1, 2, 3 }, { -3, 1, 0.5 }, { 1, 2, 0 },
    { 1e-3, 0, 1 }, { 1, 1e-6, 0 }, { 1e-7, 1e-7, 1 } };
  return directions;
}

// Great circles, also through the poles, along the seam and along knot lines.
TEST(Silhouette, SphereInParallelLight)
{
  const Shape sphere = Sphere();
  for (const Vec3& direction : Directions())
  {
    const Viewer viewer = Direction(direction[0], direction[1], direction[2]);
    const Silhouettes result = Make(sphere.Get(), viewer, 1e-5);
    const Measure measure = ExpectExact(sphere.Get(), result, viewer, 1e-5);
    ExpectClosed(result);
    EXPECT_EQ(result.Chains[0], 1) << direction.transpose();
    EXPECT_NEAR(measure.Length, 2.0 * Pi, 1e-4) << direction.transpose();
    EXPECT_EQ(result.Faces[0].Status, nurbs::SilhouetteStatus::Ok);
    for (const SilhouetteLine& line : result.Lines)
    {
      for (const nurbs::ContourPoint& point : line.Points)
      {
        EXPECT_LT(std::abs(point.Point.dot(viewer.Place)), 1e-9);
      }
    }
  }
}

// The eye e sees the circle p . e = 1; none from within.
TEST(Silhouette, SphereInPerspective)
{
  const Shape sphere = Sphere();
  for (const Vec3& direction : Directions())
  {
    for (const double distance : { 1.01, 1.5, 3.0, 1000.0 })
    {
      const Vec3 eye = distance * direction.normalized();
      const Viewer viewer = Eye(eye[0], eye[1], eye[2]);
      const Silhouettes result = Make(sphere.Get(), viewer, 1e-5);
      const Measure measure = ExpectExact(sphere.Get(), result, viewer, 1e-5);
      ExpectClosed(result);
      EXPECT_EQ(result.Chains[0], 1) << eye.transpose();
      EXPECT_NEAR(measure.Length, 2.0 * Pi * std::sqrt(1.0 - 1.0 / (distance * distance)), 1e-4);
      for (const SilhouetteLine& line : result.Lines)
      {
        for (const nurbs::ContourPoint& point : line.Points)
        {
          EXPECT_LT(std::abs(point.Point.dot(eye) - 1.0), 1e-8 * distance);
        }
      }
    }
  }
  const Silhouettes inside = Make(sphere.Get(), Eye(0.1, -0.5, 0.3), 1e-5);
  EXPECT_TRUE(inside.Lines.empty());
  EXPECT_EQ(inside.Faces[0].Patches[int(nurbs::PatchVisibility::Invisible)], 8);
}

TEST(Silhouette, EyeOnTheSurface)
{
  const Shape sphere = Sphere();
  for (const Vec3& eye : { Vec3(1, 0, 0), Vec3(0.6, 0.8, 0.0), Vec3(0.48, 0.6, 0.64) })
  {
    const Silhouettes result = Make(sphere.Get(), Eye(eye[0], eye[1], eye[2]), 1e-4);
    EXPECT_EQ(result.Faces[0].Status, nurbs::SilhouetteStatus::Singular);
    EXPECT_EQ(result.Faces[0].Message, "the eye lies on the surface");
    for (const SilhouetteLine& line : result.Lines)
    {
      EXPECT_LT((line.Points.front().Point - eye).norm(), 1e-4);
    }
  }
}

// Length of the curves sin(a) cos(t) cos(f) + cos(a) sin(t) = 0 of a torus that is seen at the angle a
// from its axis: tube angle t, ring angle f.
double TorusLength(double ring, double tube, double a)
{
  const int n = 200000;
  double length = 0.0;
  for (const double side : { 0.0, Pi })
  {
    Vec3 before = Vec3::Zero();
    for (int k = 0; k <= n; ++k)
    {
      const double phi = 2.0 * Pi * k / n;
      const double t = std::atan2(-std::sin(a) * std::cos(phi), std::cos(a)) + side;
      const double r = ring + tube * std::cos(t);
      const Vec3 point(r * std::cos(phi), r * std::sin(phi), tube * std::sin(t));
      length += k > 0 ? (point - before).norm() : 0.0;
      before = point;
    }
  }
  return length;
}

TEST(Silhouette, TorusInParallelLight)
{
  const Shape torus = Torus();
  for (const Vec3& direction : Directions())
  {
    const Viewer viewer = Direction(direction[0], direction[1], direction[2]);
    const Silhouettes result = Make(torus.Get(), viewer, 1e-5);
    const Measure measure = ExpectExact(torus.Get(), result, viewer, 1e-5);
    ExpectClosed(result);
    // Two curves, or four that meet in four points where the axis is in the image plane: 2 circles
    // of the ring's size and 2 of the tube's.
    const double a = std::acos(viewer.Place[2]);
    const bool flat = std::abs(viewer.Place[2]) < 1e-12;
    EXPECT_EQ(result.Chains[0], 2) << direction.transpose();
    EXPECT_NEAR(measure.Length, flat ? 4.0 * Pi * 1.3 : TorusLength(1.0, 0.3, a), 2e-4)
      << direction.transpose();
    const GridCheck grid = CheckGrid(torus.Get(), 0, result, viewer, 1e-5, 240);
    EXPECT_GT(grid.Changes, 0);
    EXPECT_EQ(grid.Missed, 0);
  }
}

// The points solve the torus's equation for the eye: (cos t cos f, cos t sin f, sin t) . (e - p) = 0.
TEST(Silhouette, TorusInPerspective)
{
  const Shape torus = Torus();
  for (const Vec3& eye : { Vec3(0, 0, 3), Vec3(3, 0, 0), Vec3(1, 2, 3), Vec3(0.1, 0.2, 0.5),
         Vec3(1.0, 0.1, 0.4), Vec3(0, 0, 0.1) })
  {
    const Viewer viewer = Eye(eye[0], eye[1], eye[2]);
    const Silhouettes result = Make(torus.Get(), viewer, 1e-5);
    ExpectExact(torus.Get(), result, viewer, 1e-5);
    ExpectClosed(result);
    for (const SilhouetteLine& line : result.Lines)
    {
      for (const nurbs::ContourPoint& point : line.Points)
      {
        const Vec3& p = point.Point;
        const Vec3 middle = Vec3(p[0], p[1], 0.0).normalized();
        EXPECT_LT(std::abs((p - middle).normalized().dot((eye - p).normalized())), 1e-9);
      }
    }
    const GridCheck grid = CheckGrid(torus.Get(), 0, result, viewer, 1e-5, 240);
    EXPECT_GT(grid.Changes, 0);
    EXPECT_EQ(grid.Missed, 0) << eye.transpose();
  }
}

TEST(Silhouette, CylindersAndConesHaveLines)
{
  const Shape cylinder(
    [](nurbs::ModelBuilder& builder) { nurbs::AddCylinder(builder, 1.0, 2.0, true); });
  const Shape cone([](nurbs::ModelBuilder& builder) { nurbs::AddCone(builder, 1.0, 2.0, true); });
  for (const Vec3& direction : Directions())
  {
    const Viewer viewer = Direction(direction[0], direction[1], direction[2]);
    const double across = std::hypot(viewer.Place[0], viewer.Place[1]);
    const Silhouettes ofCylinder = Make(cylinder.Get(), viewer, 1e-5);
    const Measure tall = ExpectExact(cylinder.Get(), ofCylinder, viewer, 1e-5);
    // Along the axis the side is edge-on. The rims are sharp, the seam is smooth.
    EXPECT_EQ(CountOf(ofCylinder, LineKind::Silhouette), across < 1e-9 ? 0 : 2);
    EXPECT_EQ(tall.Points, across < 1e-9 ? 0u : 4u);
    EXPECT_NEAR(tall.Length, across < 1e-9 ? 0.0 : 4.0, 1e-12);
    EXPECT_EQ(CountOf(ofCylinder, LineKind::Sharp), 2);
    EXPECT_EQ(CountOf(ofCylinder, LineKind::Boundary), 0);
    // The cone's normal is (2, 0, 1) / sqrt(5): two lines where the view is steep enough.
    const bool lines = 2.0 * across > std::abs(viewer.Place[2]);
    const Silhouettes ofCone = Make(cone.Get(), viewer, 1e-5);
    const Measure side = ExpectExact(cone.Get(), ofCone, viewer, 1e-5);
    EXPECT_NEAR(side.Length, lines ? 2.0 * std::sqrt(5.0) : 0.0, 1e-9);
    EXPECT_EQ(ofCone.Chains[0], lines ? 1 : 0); // They meet at the apex.
  }
}

// A face that a plane sees edge-on, and one whose patches are.
TEST(Silhouette, PlanesEdgeOn)
{
  const Shape plate([](nurbs::ModelBuilder& builder) { nurbs::AddPlate(builder, 4.0, 3.0, 4, 3); });
  for (const Viewer& viewer : { Direction(1, 0, 0), Direction(1, 2, 0), Eye(10, 2, 0) })
  {
    const Silhouettes result = Make(plate.Get(), viewer, 1e-4);
    EXPECT_EQ(CountOf(result, LineKind::Silhouette), 0);
    EXPECT_EQ(result.Faces[0].Patches[int(nurbs::PatchVisibility::EdgeOn)], 1);
    EXPECT_EQ(result.Faces[0].Status, nurbs::SilhouetteStatus::Ok);
    EXPECT_GT(CountOf(result, LineKind::Boundary), 12);
  }
  const Silhouettes tilted = Make(plate.Get(), Direction(1, 0, 1e-6), 1e-4);
  EXPECT_EQ(tilted.Faces[0].Patches[int(nurbs::PatchVisibility::Visible)], 1);
}

// A bump within one patch, seen at a slant: a closed loop that meets no side.
TEST(Silhouette, LoopWithinAPatch)
{
  for (const int degree : { 4, 6, 9 })
  {
    const nurbs::Surface bump = BezierSurface(degree, degree, [](double u, double v) {
      const double r = std::hypot(u - 0.5, v - 0.5);
      return Vec3(u, v, r < 0.3 ? 2.0 : 0.0);
    });
    const Model model = OneFace(bump);
    for (const Viewer& viewer : { Direction(0.6, 0.1, 1), Direction(1, 0, 1.4), Eye(1.5, 0.7, 1) })
    {
      const Silhouettes result = Make(model, viewer, 1e-5);
      ExpectExact(model, result, viewer, 1e-5);
      const GridCheck grid = CheckGrid(model, 0, result, viewer, 1e-5);
      EXPECT_EQ(grid.Missed, 0);
      EXPECT_EQ(
        result.Faces[0].Patches[int(nurbs::PatchVisibility::Partial)], grid.Changes > 0 ? 1 : 0);
      EXPECT_EQ(result.Chains[0], grid.Regions - 1);
    }
  }
}

// Many closed loops: each region of one sign but the outer one is surrounded by one.
TEST(Silhouette, SheetOfBumps)
{
  nurbs::Surface sheet;
  for (int d = 0; d < 2; ++d)
  {
    sheet.Degree[d] = 3;
    sheet.Count[d] = 24;
    sheet.Knots[d] = nurbs::UniformKnots(3, 24);
  }
  for (int k = 0; k < 24 * 24; ++k)
  {
    const int i = k % 24, j = k / 24;
    const bool bump = i % 5 == 2 && j % 5 == 2;
    sheet.Points.emplace_back(i, j, bump ? 6.0 : 0.0);
  }
  const Model model = OneFace(sheet);
  const Viewer viewer = Direction(0.7, 0.2, 1.0);
  const Silhouettes result = Make(model, viewer, 1e-4);
  ExpectExact(model, result, viewer, 1e-4);
  const GridCheck grid = CheckGrid(model, 0, result, viewer, 1e-4, 600);
  EXPECT_EQ(grid.Missed, 0);
  EXPECT_EQ(grid.Regions, 26); // 25 bumps have a far side.
  EXPECT_EQ(result.Chains[0], 25);
  for (const SilhouetteLine& line : result.Lines)
  {
    EXPECT_TRUE(line.Kind != LineKind::Silhouette || line.Closed);
  }
}

TEST(Silhouette, RandomPatchesMissNothing)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> real(-1.0, 1.0);
  int changes = 0;
  for (int k = 0; k < 50; ++k)
  {
    nurbs::Surface s = BezierSurface(1 + k % 5, 1 + k / 5 % 5, [&](double u, double v) {
      return Vec3(u + 0.3 * real(random), v + 0.3 * real(random), 0.7 * real(random));
    });
    for (std::size_t i = 0; k % 2 == 1 && i < s.Points.size(); ++i)
    {
      s.Weights.push_back(std::exp(real(random)));
    }
    const Model model = OneFace(s);
    const Viewer viewer = k % 3 == 2 ? Eye(0.5 + real(random), real(random), 2.0 + real(random))
                                     : Direction(real(random), real(random), 1.0);
    const Silhouettes result = Make(model, viewer, 1e-4);
    ExpectExact(model, result, viewer, 1e-4);
    const GridCheck grid = CheckGrid(model, 0, result, viewer, 1e-4);
    EXPECT_EQ(grid.Missed, 0) << k;
    changes += grid.Changes;
    EXPECT_EQ(result.Faces[0].Status, nurbs::SilhouetteStatus::Ok) << result.Faces[0].Message;
    const std::int64_t* types = result.Faces[0].Patches;
    EXPECT_EQ(types[int(nurbs::PatchVisibility::Partial)], result.Chains[0] > 0 ? 1 : 0);
    EXPECT_EQ(types[0] + types[1] + types[2], 1);
  }
  EXPECT_GT(changes, 5000);
}

// Normal . view vanishes along a curve but keeps its sign: nothing turns away. With a cube's power it
// does not.
TEST(Silhouette, TouchingIsNoSilhouette)
{
  for (const int power : { 3, 4 })
  {
    // x^power over [-1, 1], exactly: the Bezier points of x = 2 t - 1 are the blossom's values.
    const nurbs::Surface s = BezierSurface(power, 1, [power](double u, double v) {
      const int minus = power - int(std::lround(u * power));
      return Vec3(2.0 * u - 1.0, v, minus % 2 ? -1.0 : 1.0);
    });
    const Model model = OneFace(s);
    for (const double side : { 1.0, -1.0 })
    {
      const Silhouettes result = Make(model, Direction(side, 0, 0), 1e-4);
      EXPECT_EQ(CountOf(result, LineKind::Silhouette), power == 3 ? 0 : 1);
    }
    // With a shear the curve is no line of constant parameter.
    nurbs::Surface sheared = nurbs::ElevateDegree(s.View(), 1, 2);
    for (Vec3& point : sheared.Points)
    {
      point[0] += 0.3 * point[1] * point[1];
    }
    const Silhouettes result = Make(OneFace(sheared), Direction(1, 0, 0), 1e-4);
    EXPECT_EQ(result.Chains[0], power == 3 ? 0 : 1);
  }
}

// Walls along the view but for a millionth: normal . view is 1e-6 at most, and its zeros are found.
TEST(Silhouette, NearlyEdgeOn)
{
  std::mt19937 random(19);
  std::uniform_real_distribution<double> real(-1.0, 1.0);
  int changes = 0;
  for (int k = 0; k < 10; ++k)
  {
    const nurbs::Surface wall = BezierSurface(2 + k % 3, 3 + k % 4, [&](double u, double v) {
      return Vec3(u + 1e-6 * real(random), u * u + 1e-6 * real(random), v);
    });
    const Model model = OneFace(wall);
    const Viewer viewer = Direction(0, 0, 1);
    const Silhouettes result = Make(model, viewer, 1e-4);
    ExpectExact(model, result, viewer, 1e-4);
    const GridCheck grid = CheckGrid(model, 0, result, viewer, 1e-4, 200);
    EXPECT_EQ(grid.Missed, 0) << k;
    changes += grid.Changes;
  }
  EXPECT_GT(changes, 1000);
}

// Two patches that meet in a ridge: seen from the side, it is where the surface turns away.
TEST(Silhouette, CreasesOfDegreeOne)
{
  nurbs::Surface roof;
  roof.Degree[0] = roof.Degree[1] = 1;
  roof.Count[0] = 3;
  roof.Count[1] = 2;
  roof.Knots[0] = { 0, 0, 0.5, 1, 1 };
  roof.Knots[1] = { 0, 0, 1, 1 };
  for (int j = 0; j < 2; ++j)
  {
    for (int i = 0; i < 3; ++i)
    {
      roof.Points.emplace_back(i, j, i == 1 ? 1.0 : 0.0);
    }
  }
  const Model model = OneFace(roof);
  const Silhouettes above = Make(model, Direction(0, 0, 1), 1e-4);
  EXPECT_EQ(CountOf(above, LineKind::Silhouette), 0);
  const Silhouettes side = Make(model, Direction(2, 0, 1), 1e-4);
  ASSERT_EQ(CountOf(side, LineKind::Silhouette), 1);
  const SilhouetteLine& line = side.Lines.front();
  EXPECT_TRUE(line.Crease);
  ASSERT_EQ(line.Points.size(), 2u);
  EXPECT_EQ(line.Points[0].UV[0], 0.5);
  EXPECT_NEAR(Length(line), 1.0, 1e-15);
  // The front, u > 1/2, is on the left of the way down.
  EXPECT_GT(line.Points[0].UV[1], line.Points[1].UV[1]);
  // From behind along the ridge's own plane: one side is edge-on, the other one faces away.
  const Silhouettes flat = Make(model, Direction(1, 0, -1), 1e-4);
  EXPECT_EQ(flat.Faces[0].Patches[int(nurbs::PatchVisibility::EdgeOn)], 1);
}

// Halves of a torus, each a face of its own, give the same curves as the whole one.
TEST(Silhouette, ChainsAcrossFaces)
{
  const Shape torus = Torus();
  const nurbs::SurfaceView whole = torus.Get().Faces[0].Geometry;
  const nurbs::Interval u = whole.Domain(0);
  const nurbs::Interval v = whole.Domain(1);
  const auto halves = nurbs::Split(whole, 0, u.Min + 0.37 * u.Length());
  const auto low = nurbs::Split(halves.first.View(), 1, v.Min + 0.21 * v.Length());
  const auto high = nurbs::Split(halves.second.View(), 1, v.Min + 0.21 * v.Length());
  Model model;
  for (const nurbs::Surface* s : { &low.first, &low.second, &high.first, &high.second })
  {
    nurbs::Face face;
    face.Geometry = s->View();
    model.Faces.push_back(face);
  }
  for (const Vec3& direction : { Vec3(1, 2, 3), Vec3(0, 1, 1), Vec3(3, 1, 0.2) })
  {
    const Viewer viewer = Direction(direction[0], direction[1], direction[2]);
    const Silhouettes one = Make(torus.Get(), viewer, 1e-6);
    const Silhouettes four = Make(model, viewer, 1e-6);
    ExpectClosed(four);
    EXPECT_EQ(four.Chains[0], one.Chains[0]);
    EXPECT_GT(CountOf(four, LineKind::Silhouette), 4);
    EXPECT_NEAR(MeasureLines(model, four, viewer).Length,
      MeasureLines(torus.Get(), one, viewer).Length, 1e-4);
    EXPECT_EQ(CountOf(four, LineKind::Boundary), 0);
    // Faces of different parts are not chained.
    nurbs::SilhouetteOptions options;
    options.View = viewer;
    options.Precision = 1e-6;
    options.Parts = { 0, 1, 2, 3 };
    const Silhouettes apart = nurbs::MakeSilhouettes(model, std::vector<std::string>(4), options);
    EXPECT_GT(apart.Chains[0], four.Chains[0]);
  }
}

TEST(Silhouette, ThreadsChangeNothing)
{
  const Shape teapot([](nurbs::ModelBuilder& builder) { nurbs::AddTeapot(builder); });
  nurbs::SilhouetteOptions options;
  options.View = Direction(1, 2, 3);
  const std::vector<std::string> errors(32);
  const Silhouettes serial = nurbs::MakeSilhouettes(teapot.Get(), errors, options);
  options.Parallel = [](std::int64_t first, std::int64_t last,
                       const std::function<void(std::int64_t, std::int64_t)>& body) {
    std::vector<std::thread> threads;
    for (std::int64_t k = last; k-- > first;)
    {
      threads.emplace_back([&body, k]() { body(k, k + 1); });
    }
    for (std::thread& thread : threads)
    {
      thread.join();
    }
  };
  const Silhouettes parallel = nurbs::MakeSilhouettes(teapot.Get(), errors, options);
  ASSERT_EQ(serial.Lines.size(), parallel.Lines.size());
  EXPECT_GT(serial.Lines.size(), 50u);
  for (std::size_t k = 0; k < serial.Lines.size(); ++k)
  {
    const SilhouetteLine& a = serial.Lines[k];
    const SilhouetteLine& b = parallel.Lines[k];
    ASSERT_EQ(a.Points.size(), b.Points.size());
    EXPECT_EQ(a.Chain, b.Chain);
    for (std::size_t i = 0; i < a.Points.size(); ++i)
    {
      ASSERT_EQ(a.Points[i].Point, b.Points[i].Point);
    }
  }
}

// Points and seconds from 1e-2 to 1e-8 of the size: chords within the precision, four times as many
// points for a sixteenth of it.
TEST(Silhouette, AnyPrecision)
{
  const Shape torus = Torus();
  const Viewer viewer = Direction(1, 2, 3);
  const double size = nurbs::Diagonal(nurbs::FaceBoxes(torus.Get(), { "" }));
  std::size_t before = 0;
  std::printf("precision (of the size)   points   seconds   chord / precision\n");
  for (int digits = 2; digits <= 8; ++digits)
  {
    const double precision = std::pow(10.0, -digits) * size;
    const auto start = std::chrono::steady_clock::now();
    const Silhouettes result = Make(torus.Get(), viewer, precision);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    const Measure measure = MeasureLines(torus.Get(), result, viewer);
    std::printf("1e-%d %28zu %9.4f %10.3f\n", digits, measure.Points, seconds.count(),
      measure.Chord / precision);
    EXPECT_LE(measure.Chord, precision);
    EXPECT_LE(measure.Cosine, 1e-9);
    if (digits > 4)
    {
      EXPECT_LT(double(measure.Points), 4.5 * double(before));
    }
    before = measure.Points;
  }
}

TEST(Silhouette, BadInput)
{
  const Shape sphere = Sphere();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto problem = [&](const Viewer& viewer, double precision) {
    try
    {
      Make(sphere.Get(), viewer, precision);
    }
    catch (const nurbs::Error& error)
    {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(problem({ false, Vec3::Zero() }, 1e-4), "The direction to the viewer has length zero");
  EXPECT_EQ(problem({ false, Vec3(0, nan, 1) }, 1e-4), "The direction to the viewer is not finite");
  EXPECT_EQ(problem({ true, Vec3(0, nan, 1) }, 1e-4), "The eye is not finite");
  EXPECT_NE(problem({ false, Vec3(0, 0, 1) }, 0.0), "");
  EXPECT_NE(problem({ false, Vec3(0, 0, 1) }, nan), "");
  EXPECT_EQ(problem({ false, Vec3(0, 0, 1e-300) }, 1e-4), "");
  const Silhouettes empty = nurbs::MakeSilhouettes(Model(), {}, nurbs::SilhouetteOptions());
  EXPECT_TRUE(empty.Lines.empty());
  const Silhouettes failed =
    nurbs::MakeSilhouettes(sphere.Get(), { "it is bad" }, nurbs::SilhouetteOptions());
  EXPECT_TRUE(failed.Lines.empty());
  EXPECT_EQ(failed.Faces[0].Status, nurbs::SilhouetteStatus::Failed);
  EXPECT_EQ(failed.Faces[0].Message, "it is bad");
}

} // namespace
