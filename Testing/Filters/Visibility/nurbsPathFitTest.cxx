// SPDX-License-Identifier: BSD-3-Clause
// Polylines fitted by Bezier pieces: how many, how near by dense samples both ways, corners,
// straight runs, tangents, and degenerate input.
#include "PathFit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace
{

using nurbs::FittedPath;
using nurbs::PathPiece;
using nurbs::Vec2;
using Polyline = std::vector<Vec2>;
using Curve = std::function<Vec2(double)>;

constexpr double Pi = 3.14159265358979323846;

Vec2 PointOf(const PathPiece& piece, double u)
{
  const double v = 1.0 - u;
  return v * v * v * piece.Points[0] + 3.0 * v * v * u * piece.Points[1] +
    3.0 * v * u * u * piece.Points[2] + u * u * u * piece.Points[3];
}

double DistanceFrom(const Polyline& polyline, const Vec2& point)
{
  double nearest = 1e300;
  for (std::size_t k = 0; k + 1 < polyline.size(); ++k)
  {
    const Vec2 chord = polyline[k + 1] - polyline[k];
    if ((polyline[k] - point).norm() - chord.norm() > nearest)
    {
      continue;
    }
    const double square = chord.squaredNorm();
    const double t =
      square > 0.0 ? std::clamp((point - polyline[k]).dot(chord) / square, 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, (point - polyline[k] - t * chord).norm());
  }
  return nearest;
}

constexpr int PieceSamples = 200;

// Dense samples of a path.
Polyline Sampled(const FittedPath& path)
{
  Polyline samples;
  for (const PathPiece& piece : path.Pieces)
  {
    for (int k = 0; k <= PieceSamples; ++k)
    {
      samples.push_back(PointOf(piece, double(k) / PieceSamples));
    }
  }
  return samples;
}

// By how much chords between the samples of a path may bow: the second derivative is at most 6
// times a second difference of control points.
double BowOfSamples(const FittedPath& path)
{
  double largest = 0.0;
  for (const PathPiece& piece : path.Pieces)
  {
    const auto& p = piece.Points;
    largest =
      std::max({ largest, (p[2] - 2.0 * p[1] + p[0]).norm(), (p[3] - 2.0 * p[2] + p[1]).norm() });
  }
  return 6.0 * largest / (8.0 * PieceSamples * PieceSamples);
}

// The Hausdorff distance of two polylines by some 3,000 samples of either.
double Distance(const Polyline& a, const Polyline& b)
{
  double largest = 0.0;
  for (const auto& pair : { std::make_pair(&a, &b), std::make_pair(&b, &a) })
  {
    const Polyline& from = *pair.first;
    const std::size_t steps = 1 + 300 / from.size(), stride = 1 + steps * from.size() / 3000;
    for (std::size_t k = 0; k < steps * (from.size() - 1); k += stride)
    {
      const Vec2 &start = from[k / steps], &end = from[k / steps + 1];
      const Vec2 at = start + (end - start) * (double(k % steps) / double(steps));
      largest = std::max(largest, DistanceFrom(*pair.second, at));
    }
  }
  return largest;
}

// Points of a curve with chords that bow by `bow` at most, halved at random.
void Halve(
  const Curve& curve, double from, double to, double bow, std::mt19937& random, Polyline& polyline)
{
  const Vec2 a = curve(from), b = curve(to);
  double off = 0.0;
  for (int k = 1; k < 16; ++k)
  {
    off = std::max(off, DistanceFrom({ a, b }, curve(from + (to - from) * k / 16.0)));
  }
  if (off <= bow && (b - a).norm() > 0.0)
  {
    polyline.push_back(b);
    return;
  }
  const double middle = from + (to - from) * std::uniform_real_distribution<>(0.4, 0.6)(random);
  Halve(curve, from, middle, bow, random, polyline);
  Halve(curve, middle, to, bow, random, polyline);
}

Polyline Sample(const Curve& curve, double from, double to, double bow)
{
  std::mt19937 random(7);
  Polyline polyline = { curve(from) };
  Halve(curve, from, to, bow, random, polyline);
  return polyline;
}

void Close(Polyline& polyline)
{
  polyline.back() = polyline.front();
}

// The largest angle between pieces that meet.
double LargestKink(const FittedPath& path)
{
  double largest = 0.0;
  const std::size_t n = path.Pieces.size();
  for (std::size_t k = 0; k + (path.Closed ? 0 : 1) < n; ++k)
  {
    const auto &a = path.Pieces[k].Points, &b = path.Pieces[(k + 1) % n].Points;
    const Vec2 before = a[3] - a[2], after = b[1] - b[0];
    largest = std::max(largest,
      std::abs(std::atan2(before.x() * after.y() - before.y() * after.x(), before.dot(after))));
  }
  return largest;
}

void ExpectConnected(const FittedPath& path)
{
  for (std::size_t k = 0; k + 1 < path.Pieces.size(); ++k)
  {
    EXPECT_EQ(path.Pieces[k].Points[3], path.Pieces[k + 1].Points[0]);
  }
  if (path.Closed)
  {
    EXPECT_EQ(path.Pieces.back().Points[3], path.Pieces.front().Points[0]);
  }
}

// Fits, and checks what holds for every fit.
FittedPath Fitted(const Polyline& polyline, double tolerance)
{
  const FittedPath path = nurbs::FitPath(polyline, tolerance);
  EXPECT_FALSE(path.Pieces.empty());
  ExpectConnected(path);
  EXPECT_LE(Distance(polyline, Sampled(path)), tolerance * (1.0 + 1e-6) + BowOfSamples(path));
  if (!path.Closed)
  {
    EXPECT_EQ(path.Pieces.front().Points[0], polyline.front());
    EXPECT_EQ(path.Pieces.back().Points[3], polyline.back());
  }
  return path;
}

int Straights(const FittedPath& path)
{
  return int(std::count_if(
    path.Pieces.begin(), path.Pieces.end(), [](const PathPiece& piece) { return piece.Straight; }));
}

Vec2 OnCircle(double angle)
{
  return { std::cos(angle), std::sin(angle) };
}

// A straight line into a clothoid, by its series: curvature grows with the length.
Vec2 OnClothoid(double s)
{
  Vec2 at = Vec2::Zero();
  constexpr int Steps = 400;
  for (int k = 0; k < Steps; ++k)
  {
    const double t = s * (k + 0.5) / Steps;
    at += s / Steps * Vec2(std::cos(t * t), std::sin(t * t));
  }
  return at;
}

TEST(PathFit, CircleIsAFewSmoothPieces)
{
  for (const double bow : { 1e-4, 0.5e-4, 1e-5, 1e-7 })
  {
    Polyline circle = Sample(OnCircle, 0.3, 0.3 + 2.0 * Pi, bow);
    Close(circle);
    const FittedPath path = Fitted(circle, 1e-4);
    EXPECT_TRUE(path.Closed);
    EXPECT_GE(path.Pieces.size(), 4u);
    EXPECT_LE(path.Pieces.size(), 8u) << bow;
    EXPECT_EQ(Straights(path), 0);
    EXPECT_LT(LargestKink(path), 1e-6) << bow;
  }
}

// The number of pieces grows as the sixth root of the precision, as it must for cubics.
TEST(PathFit, FinerTolerancesNeedFewMorePieces)
{
  std::vector<std::pair<double, unsigned>> cases{ { 1e-2, 4u }, { 1e-6, 14u }, { 1e-8, 30u } };
#ifdef NURBS_SANITIZE
  cases.pop_back(); // Sanitizers are slow, and look for other things.
#endif
  for (const auto& [tolerance, most] : cases)
  {
    Polyline circle = Sample(OnCircle, 0.0, 2.0 * Pi, 0.5 * tolerance);
    Close(circle);
    const FittedPath path = Fitted(circle, tolerance);
    EXPECT_LE(path.Pieces.size(), most) << tolerance;
    EXPECT_LT(LargestKink(path), 1e-6);
  }
}

TEST(PathFit, SmoothCurvesStaySmooth)
{
  const struct
  {
    const char* Name;
    Curve At;
    double From, To;
    bool Closed;
    std::size_t Most;
  } curves[] = {
    { "ellipse", [](double t) { return Vec2(2.0 * std::cos(t), 0.3 * std::sin(t)); }, 1.0,
      1.0 + 2.0 * Pi, true, 12 },
    { "spiral", [](double t) { return Vec2(0.1 * t * OnCircle(t)); }, 1.0, 20.0, false, 26 },
    { "clothoid", OnClothoid, 0.0, 4.0, false, 20 },
    { "sine", [](double t) { return Vec2(t, std::sin(t)); }, 0.0, 4.0 * Pi, false, 16 },
    { "cubic", [](double t) { return Vec2(t, t * t * t - t); }, -1.0, 1.0, false, 4 },
    { "arc", OnCircle, 0.0, 1.5, false, 2 },
    { "flat arc", OnCircle, 0.0, 0.1, false, 1 },
  };
  for (const auto& curve : curves)
  {
    for (const double bow : { 1e-4, 1e-5, 1e-6 })
    {
      SCOPED_TRACE(curve.Name + std::to_string(bow));
      Polyline polyline = Sample(curve.At, curve.From, curve.To, bow);
      if (curve.Closed)
      {
        Close(polyline);
      }
      const FittedPath path = Fitted(polyline, 1e-4);
      EXPECT_EQ(path.Closed, curve.Closed);
      EXPECT_LE(path.Pieces.size(), curve.Most);
      EXPECT_EQ(Straights(path), 0);
      EXPECT_LT(LargestKink(path), 1e-6);
      EXPECT_TRUE(nurbs::FindCorners(polyline, 1e-4).empty());
    }
  }
}

TEST(PathFit, PolygonsStayThemselves)
{
  Polyline star;
  for (int k = 0; k <= 10; ++k)
  {
    star.push_back((k % 2 ? 0.4 : 1.0) * OnCircle(0.2 * Pi * k));
  }
  Close(star);
  // The seam is in the middle of an edge.
  star.front() = star.back() = 0.5 * (star[0] + star[1]);
  star.insert(star.end() - 1, OnCircle(0.0));
  const FittedPath path = Fitted(star, 1e-4);
  EXPECT_TRUE(path.Closed);
  EXPECT_EQ(path.Pieces.size(), 10u);
  EXPECT_EQ(Straights(path), 10);
  for (const PathPiece& piece : path.Pieces)
  {
    EXPECT_LT(DistanceFrom(star, piece.Points[0]), 1e-15);
  }
}

// A straight line's vertices are not the polyline's: one piece.
TEST(PathFit, CollinearPointsAreOneLine)
{
  Polyline line;
  for (int k = 0; k <= 1000; ++k)
  {
    line.emplace_back(k * 1e-3, k * 2e-3);
  }
  const FittedPath path = Fitted(line, 1e-6);
  ASSERT_EQ(path.Pieces.size(), 1u);
  EXPECT_TRUE(path.Pieces[0].Straight);
}

// Two half circles and two straight lines between, seams in a line and in an arc.
TEST(PathFit, SlotHasStraightSides)
{
  const Curve slot = [](double t) -> Vec2 {
    t = std::fmod(t, 4.0);
    if (t < 1.0)
    {
      return Vec2(4.0 * t - 2.0, -0.5);
    }
    if (t < 2.0)
    {
      return Vec2(2.0, 0.0) + 0.5 * OnCircle((t - 1.5) * Pi);
    }
    return t < 3.0 ? Vec2(2.0 - 4.0 * (t - 2.0), 0.5)
                   : Vec2(Vec2(-2.0, 0.0) + 0.5 * OnCircle((t - 2.5) * Pi));
  };
  for (const double bow : { 1e-4, 1e-6 })
  {
    for (const double seam : { 0.4, 1.3, 1.0 })
    {
      SCOPED_TRACE(seam);
      Polyline polyline = { slot(seam) };
      std::mt19937 random(3);
      double at = seam;
      for (double next = std::floor(seam) + 1.0; next < seam + 4.0; next += 1.0)
      {
        Halve(slot, at, next, bow, random, polyline);
        at = next;
      }
      Halve(slot, at, seam + 4.0, bow, random, polyline);
      Close(polyline);
      const FittedPath path = Fitted(polyline, 1e-4);
      EXPECT_EQ(Straights(path), 2);
      EXPECT_LE(path.Pieces.size(), 10u);
      EXPECT_LT(LargestKink(path), 0.01);
      EXPECT_TRUE(nurbs::FindCorners(polyline, 1e-4).empty());
    }
  }
}

TEST(PathFit, CornersOfCurvesAreKept)
{
  // A lens: two arcs that meet at two corners; the seam is in the middle of an arc.
  const Curve lens = [](double t) -> Vec2 {
    return t < 1.0 ? Vec2(Vec2(0.0, -0.8) + OnCircle(0.5 * Pi + (0.5 - t) * 1.2))
                   : Vec2(Vec2(0.0, 0.8502) + OnCircle(-0.5 * Pi + (1.5 - t) * 1.2));
  };
  for (const double bow : { 1e-4, 1e-7 })
  {
    std::mt19937 random(1);
    Polyline polyline = { lens(0.5) };
    Halve(lens, 0.5, 1.0 - 1e-12, bow, random, polyline);
    Halve(lens, 1.0, 2.0 - 1e-12, bow, random, polyline);
    Halve(lens, 0.0, 0.5, bow, random, polyline);
    Close(polyline);
    const FittedPath path = Fitted(polyline, 1e-4);
    EXPECT_TRUE(path.Closed);
    EXPECT_LE(path.Pieces.size(), 6u);
    EXPECT_EQ(nurbs::FindCorners(polyline, 1e-4).size(), 2u) << bow;
  }
}

// The outline of a surface that folds has cusps: the polyline turns back.
TEST(PathFit, CuspIsACorner)
{
  const Curve cusp = [](double t) { return Vec2(t * t, t * t * t); };
  Polyline polyline = Sample(cusp, -1.0, 0.0, 1e-5);
  std::mt19937 random(1);
  Halve(cusp, 0.0, 1.0, 1e-5, random, polyline);
  const FittedPath path = Fitted(polyline, 1e-4);
  EXPECT_LE(path.Pieces.size(), 6u);
  ASSERT_EQ(nurbs::FindCorners(polyline, 1e-4).size(), 1u);
  EXPECT_LT(polyline[nurbs::FindCorners(polyline, 1e-4)[0]].norm(), 1e-12);
}

TEST(PathFit, NoiseBelowTheToleranceDoesNoHarm)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<> noise(-1e-8, 1e-8);
  Polyline circle = Sample(OnCircle, 0.0, 2.0 * Pi, 1e-6);
  for (Vec2& p : circle)
  {
    p += Vec2(noise(random), noise(random));
  }
  // And pieces as short as the noise, as where lines are cut.
  for (std::size_t k = 10; k < circle.size(); k += 20)
  {
    circle.insert(circle.begin() + std::ptrdiff_t(k), circle[k] + Vec2(1e-8, -1e-8));
  }
  Close(circle);
  const FittedPath path = Fitted(circle, 1e-4);
  EXPECT_LE(path.Pieces.size(), 8u);
  EXPECT_LT(LargestKink(path), 1e-6);
}

TEST(PathFit, DegenerateInput)
{
  const Vec2 a(1.0, 2.0), b(3.0, 5.0);
  EXPECT_TRUE(nurbs::FitPath({}, 1e-3).Pieces.empty());
  EXPECT_TRUE(nurbs::FitPath({ a }, 1e-3).Pieces.empty());
  EXPECT_TRUE(nurbs::FitPath({ a, a, a }, 1e-3).Pieces.empty());
  for (const Polyline& line : { Polyline{ a, b }, Polyline{ a, a, b, b, b } })
  {
    const FittedPath path = Fitted(line, 1e-3);
    ASSERT_EQ(path.Pieces.size(), 1u);
    EXPECT_TRUE(path.Pieces[0].Straight);
    EXPECT_FALSE(path.Closed);
  }
  // There and back again.
  const FittedPath back = Fitted({ a, b, a }, 1e-3);
  EXPECT_TRUE(back.Closed);
  EXPECT_EQ(Straights(back), 2);
  // Closed, and smaller than the tolerance.
  Polyline tiny = Sample([](double t) { return Vec2(1e-6 * OnCircle(t)); }, 0.0, 2.0 * Pi, 1e-8);
  Close(tiny);
  EXPECT_LE(Fitted(tiny, 1e-4).Pieces.size(), 2u);
  // A polyline that was not made for the tolerance is kept, vertices and all.
  Polyline coarse;
  for (int k = 0; k <= 12; ++k)
  {
    coarse.push_back(OnCircle(Pi / 6.0 * k));
  }
  Close(coarse);
  EXPECT_EQ(Straights(Fitted(coarse, 1e-6)), 12);
}

// Whatever comes: within the tolerance.
TEST(PathFit, RandomPolylines)
{
  std::mt19937 random(11);
  std::uniform_real_distribution<> value(-1.0, 1.0);
  for (int trial = 0; trial < 60; ++trial)
  {
    Polyline polyline;
    Vec2 at(0.0, 0.0), velocity(0.02, 0.0);
    for (int k = 0; k < 60; ++k)
    {
      velocity += 0.01 * (trial % 3 + 1) * Vec2(value(random), value(random));
      at += velocity;
      polyline.push_back(at);
    }
    if (trial % 2)
    {
      polyline.push_back(polyline.front());
    }
    Fitted(polyline, std::pow(10.0, -1.0 - trial % 4));
  }
}

} // namespace
