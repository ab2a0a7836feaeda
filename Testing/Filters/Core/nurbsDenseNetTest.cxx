// SPDX-License-Identifier: BSD-3-Clause
// Dense control nets: the surface stays (against B-splines by definition in long double), spacing
// and degree are reached, caps hold, cuts leave trims alone, and bends follow as the bound says.
#include "DenseNet.h"
#include "ModelBuilder.h"
#include "nurbsReference.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

using nurbs::DenseNet;
using nurbs::NetDensity;
using nurbs::Surface;
using nurbs::SurfaceView;
using nurbs::Vec2;
using nurbs::Vec3;

// A face without loops.
DenseNet Dense(const Surface& surface, const NetDensity& wanted)
{
  nurbs::Face face;
  face.Geometry = surface.View();
  return nurbs::MakeDense(nurbs::Model(), face, wanted);
}

NetDensity Wanted(double spacing, int degree = 3, std::int64_t most = 1000000)
{
  NetDensity wanted;
  wanted.Spacing = spacing;
  wanted.MinimumDegree = degree;
  wanted.MaximumPoints = most;
  return wanted;
}

// [0, width] x [0, height] of degree 1 x 1, over parameters that are its coordinates plus `shift`.
Surface Plane(double width, double height, double shift = 0.0)
{
  Surface s;
  const double size[2] = { width, height };
  for (int dir = 0; dir < 2; ++dir)
  {
    s.Count[dir] = 2;
    s.Knots[dir] = { shift, shift, shift + size[dir], shift + size[dir] };
  }
  s.Points = { Vec3(0, 0, 0), Vec3(width, 0, 0), Vec3(0, height, 0), Vec3(width, height, 0) };
  return s;
}

double Size(const Surface& s)
{
  nurbs::Box3 box;
  for (const Vec3& p : s.Points)
  {
    box.extend(p);
  }
  return box.diagonal().norm();
}

double LongestEdge(const Surface& s)
{
  double longest = 0.0;
  for (int dir = 0; dir < 2; ++dir)
  {
    const int step = dir == 0 ? 1 : s.Count[0];
    for (int k = 0; k + step < s.Count[0] * s.Count[1]; ++k)
    {
      const int at = dir == 0 ? k % s.Count[0] : k / s.Count[0];
      const auto& knots = s.Knots[dir];
      const bool isBreak = knots[at + 1] == knots[at + s.Degree[dir] + 1];
      if (at + 1 < s.Count[dir] && !isBreak)
      {
        longest = std::max(longest, (s.Points[k + step] - s.Points[k]).norm());
      }
    }
  }
  return longest;
}

void ExpectSameSurface(const Surface& a, const Surface& b, int samples)
{
  reference::Random random(7);
  const SurfaceView before = a.View(), after = b.View();
  for (int i = 0; i < samples; ++i)
  {
    const double u = random.Parameter(before.Knots[0], before.Degree[0]);
    const double v = random.Parameter(before.Knots[1], before.Degree[1]);
    ASSERT_LE(
      (reference::Point(before, u, v) - reference::Point(after, u, v)).norm(), 1e-12 * Size(a))
      << u << " " << v;
  }
}

void ExpectDense(const Surface& surface, double spacing, int degree)
{
  const DenseNet net = Dense(surface, Wanted(spacing, degree));
  ASSERT_TRUE(net.Changed);
  EXPECT_FALSE(net.Capped);
  EXPECT_LE(LongestEdge(net.Geometry), spacing * (1.0 + 1e-8));
  for (int dir = 0; dir < 2; ++dir)
  {
    EXPECT_EQ(net.Geometry.Degree[dir], std::max(degree, surface.Degree[dir]));
    EXPECT_EQ(
      nurbs::CheckKnots(net.Geometry.Knots[dir], net.Geometry.Degree[dir], net.Geometry.Count[dir]),
      "");
    EXPECT_EQ(net.Geometry.View().Domain(dir).Min, surface.View().Domain(dir).Min);
    EXPECT_EQ(net.Geometry.View().Domain(dir).Max, surface.View().Domain(dir).Max);
  }
  EXPECT_EQ(net.Geometry.Weights.empty(), surface.Weights.empty());
  ExpectSameSurface(surface, net.Geometry, 60);
}

TEST(DenseNet, RandomSurfacesStayAndGetDense)
{
  reference::Random random(1);
  for (int n = 0; n < 60; ++n)
  {
    const int p = random.Integer(1, 5), q = random.Integer(1, 5);
    const bool clamped = n % 3 != 0, rational = n % 2 != 0, breaks = n % 5 == 0;
    SCOPED_TRACE(n);
    ExpectDense(random.Surface(p, q, clamped, rational, breaks), 0.35, random.Integer(1, 4));
  }
}

TEST(DenseNet, ClosedAndDegenerateSurfacesStay)
{
  const Surface sphere = reference::Sphere(2.0); // closed in u, two poles
  ExpectDense(sphere, 0.2, 3);
  ExpectDense(sphere, 0.2, 2);
  Surface apex = Plane(1, 1);
  apex.Points[2] = apex.Points[3];
  ExpectDense(apex, 0.04, 3);
  const DenseNet net = Dense(sphere, Wanted(0.2));
  for (int i = 0; i < net.Geometry.Count[0]; ++i)
  {
    EXPECT_LE((net.Geometry.Points[i] - Vec3(0, 0, -2)).norm(), 1e-14);
  }
}

TEST(DenseNet, WeightsFarApart)
{
  Surface s = Plane(1, 1);
  s.Weights = { 1.0, 1e4, 1e-3, 1.0 };
  ExpectDense(s, 0.05, 3);
}

// A straight side of length 1 takes ten spans for a spacing of 0.1, whatever its parameters are.
TEST(DenseNet, NoMoreKnotsThanNeeded)
{
  for (const double shift : { 0.0, -7.0, 1e5 })
  {
    const DenseNet net = Dense(Plane(1, 2, shift), Wanted(0.1));
    EXPECT_EQ(net.Geometry.Count[0], 13);
    EXPECT_EQ(net.Geometry.Count[1], 23);
  }
  EXPECT_EQ(Dense(Plane(1, 2), Wanted(0.1, 1)).Geometry.Count[1], 21);
  // A circle of radius 2: a net edge is at most a few percent longer than its arc.
  const DenseNet sphere = Dense(reference::Sphere(2.0), Wanted(0.1));
  EXPECT_GE(sphere.Geometry.Count[0], 126);
  EXPECT_LE(sphere.Geometry.Count[0], 170);
}

TEST(DenseNet, DenseNetsStayAsTheyAre)
{
  const DenseNet net = Dense(Plane(1, 2), Wanted(0.1));
  const DenseNet again = Dense(net.Geometry, Wanted(0.1));
  EXPECT_FALSE(again.Changed);
  EXPECT_FALSE(again.Capped);
  EXPECT_TRUE(again.Geometry.Points.empty());
}

TEST(DenseNet, CapsHold)
{
  const DenseNet net = Dense(Plane(1, 1), Wanted(1e-3, 3, 100));
  EXPECT_TRUE(net.Capped);
  ASSERT_TRUE(net.Changed);
  EXPECT_EQ(net.Geometry.Count[0] * net.Geometry.Count[1], 100); // As dense as it may be.
  ExpectSameSurface(Plane(1, 1), net.Geometry, 20);

  const DenseNet whole = Dense(net.Geometry, Wanted(1e-3, 3, 99));
  EXPECT_TRUE(whole.Capped);
  EXPECT_FALSE(whole.Changed);
  const DenseNet degree = Dense(Plane(1, 1), Wanted(1e-3, 3, 15));
  EXPECT_TRUE(degree.Capped);
  EXPECT_FALSE(degree.Changed);
  EXPECT_EQ(Dense(Plane(1, 1), Wanted(1e-3, 3, 16)).Geometry.Points.size(), 16u);

  Surface vast = Plane(1e300, 1e300);
  EXPECT_TRUE(Dense(vast, Wanted(1e-300, 3, 100)).Capped);
}

TEST(DenseNet, BadWishesThrow)
{
  EXPECT_THROW(Dense(Plane(1, 1), Wanted(0.1, 0)), nurbs::Error);
  EXPECT_THROW(Dense(Plane(1, 1), Wanted(0.1, nurbs::MaxDegree + 1)), nurbs::Error);
  EXPECT_THROW(Dense(Plane(1, 1), Wanted(0.0)), nurbs::Error);
  EXPECT_THROW(Dense(Plane(1, 1), Wanted(std::nan(""))), nurbs::Error);
}

// A face with one loop through the points, in a model of its own.
struct TrimmedFace
{
  nurbs::ModelBuilder Builder;
  nurbs::AssembledModel Assembled;

  TrimmedFace(const Surface& surface, const std::vector<Vec2>& from, const std::vector<Vec2>& to)
  {
    this->Builder.BeginFace(surface.View(), {});
    this->Builder.BeginLoop();
    for (std::size_t i = 0; i < from.size(); ++i)
    {
      nurbs::Curve<2> line;
      line.Knots = { 0, 0, 1, 1 };
      line.Points = { from[i], to[i] };
      line.Weights = { 1, 1 };
      line.Pack();
      this->Builder.AddTrimCurve(line.View(), -1, false);
    }
    this->Assembled = nurbs::AssembleModel(this->Builder.Arrays());
  }
  DenseNet Dense(const NetDensity& wanted) const
  {
    return nurbs::MakeDense(this->Assembled.Model, this->Assembled.Model.Faces.at(0), wanted);
  }
};

TEST(DenseNet, CutsToTheTrims)
{
  const std::vector<Vec2> from = { { 300, 400 }, { 301, 400 }, { 301, 402 }, { 300, 402 } };
  const std::vector<Vec2> to = { from[1], from[2], from[3], from[0] };
  const TrimmedFace face(Plane(1000, 1000), from, to);
  NetDensity wanted = Wanted(0.1, 3, 10000);
  const DenseNet net = face.Dense(wanted);
  EXPECT_FALSE(net.Capped);
  const SurfaceView cut = net.Geometry.View();
  EXPECT_EQ(cut.Domain(0).Min, 300.0);
  EXPECT_EQ(cut.Domain(0).Max, 301.0);
  EXPECT_EQ(cut.Domain(1).Min, 400.0);
  EXPECT_EQ(cut.Domain(1).Max, 402.0);
  EXPECT_EQ(cut.Count[0], 13);
  EXPECT_EQ(cut.Count[1], 23);
  for (const Vec2& uv : from)
  {
    EXPECT_LE((nurbs::Evaluate(cut, uv[0], uv[1]) - Vec3(uv[0], uv[1], 0)).norm(), 1e-10);
  }
  wanted.ClampToTrims = false;
  const DenseNet whole = face.Dense(wanted);
  EXPECT_TRUE(whole.Capped);
  EXPECT_EQ(whole.Geometry.View().Domain(0).Max, 1000.0);
}

// A gap that is small in the whole domain, but not in the part that the loop reaches.
TEST(DenseNet, CutsLeaveLoopsValid)
{
  const std::vector<Vec2> from = { { 10, 10 }, { 20, 10 }, { 20, 20 }, { 10, 20 } };
  const TrimmedFace face(Plane(100, 100), from, { from[1], from[2], from[3], { 10, 10.5 } });
  ASSERT_EQ(face.Assembled.FaceErrors[0], "");
  const DenseNet net = face.Dense(Wanted(5.0));
  EXPECT_TRUE(net.Changed);
  EXPECT_EQ(net.Geometry.View().Domain(0).Max, 100.0);
}

// A knot just inside the trims would make a sliver of a span; the cut goes round it.
TEST(DenseNet, CutsMakeNoThinSpans)
{
  const std::vector<Vec2> from = { { 0.4 - 1e-9, 0 }, { 1, 0 }, { 1, 1 }, { 0.4 - 1e-9, 1 } };
  const Surface surface = nurbs::RefineKnots(Plane(1, 1).View(), 0, { 0.4 });
  const TrimmedFace face(surface, from, { from[1], from[2], from[3], from[0] });
  const DenseNet net = face.Dense(Wanted(0.1));
  const auto& knots = net.Geometry.Knots[0];
  EXPECT_LE(knots.front(), 0.4 - 1e-9);
  EXPECT_GE(knots.front(), 0.39);
  for (std::size_t k = 1; k < knots.size(); ++k)
  {
    EXPECT_TRUE(knots[k] == knots[k - 1] || knots[k] - knots[k - 1] > 1e-4) << k;
  }
}

// Bends x to x + a (x^2 + y^2) e_z, second derivatives up to M = 2 a. Bicubic nets with even knots
// are off by M h^2 / 3 inside, and by half of that at a border, where points lie along one line.
TEST(DenseNet, BendsFollowWithTheSquareOfTheSpacing)
{
  const double a = 0.7;
  for (const int spans : { 8, 16, 32, 64 })
  {
    const double h = 1.0 / spans;
    Surface bent = Dense(Plane(1, 1), Wanted(h)).Geometry;
    ASSERT_EQ(bent.Count[0], spans + 3);
    for (Vec3& p : bent.Points)
    {
      p[2] += a * (p[0] * p[0] + p[1] * p[1]);
    }
    const auto error = [&](double x, double y) {
      const Vec3 p = nurbs::Evaluate(bent.View(), x, y);
      return (p - Vec3(x, y, a * (x * x + y * y))).norm();
    };
    EXPECT_NEAR(error(0.5, 0.5), 2.0 * a * h * h / 3.0, 1e-13);
    EXPECT_NEAR(error(0.47, 0.0), a * h * h / 3.0, 1e-13);
    for (int i = 0; i <= 400; ++i)
    {
      EXPECT_LE(error((i % 20) / 20.0, (i / 20) / 20.0), 2.0 * a * h * h / 3.0 + 1e-13);
    }
  }
}

} // namespace
