// SPDX-License-Identifier: BSD-3-Clause
// Triangulated polygons: numbers of triangles, areas, orientation, and that the triangles' sides
// fit together to the polygon's.
#include "PolygonTriangulation.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>

namespace
{

using nurbs::Vec2;
using Polygon = std::vector<Vec2>;

double Area2(const Vec2& a, const Vec2& b, const Vec2& c)
{
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Triangles are turned left, as many as asked for and of the loops' area together. Sides of
/// triangles cancel out, but for the loops' own.
void ExpectTriangulation(
  const std::vector<Polygon>& loops, const std::vector<int>& triangles, int count, bool strict)
{
  Polygon points;
  std::map<std::pair<int, int>, int> sides;
  double area = 0.0;
  for (const Polygon& loop : loops)
  {
    const int first = int(points.size());
    const int n = int(loop.size());
    for (int i = 0; i < n; ++i)
    {
      points.push_back(loop[i]);
      --sides[{ first + i, first + (i + 1) % n }];
      ++sides[{ first + (i + 1) % n, first + i }];
      area += Area2(Vec2::Zero(), loop[i], loop[(i + 1) % n]);
    }
  }
  ASSERT_EQ(int(triangles.size()), 3 * count);
  double sum = 0.0;
  for (std::size_t t = 0; t < triangles.size(); t += 3)
  {
    const int* v = &triangles[t];
    const double one = Area2(points[v[0]], points[v[1]], points[v[2]]);
    ASSERT_TRUE(one > 0.0 || (!strict && one >= 0.0)) << one;
    sum += one;
    for (int k = 0; k < 3; ++k)
    {
      const int a = v[k];
      const int b = v[(k + 1) % 3];
      ++sides[{ a, b }];
      --sides[{ b, a }];
    }
  }
  EXPECT_NEAR(sum, area, 1e-9 * std::abs(area));
  for (const auto& side : sides)
  {
    ASSERT_EQ(side.second, 0) << side.first.first << ' ' << side.first.second;
  }
}

TEST(TriangulateConvex, LeavesNoTriangleWithoutArea)
{
  std::mt19937 random(5);
  for (int k = 0; k < 200; ++k)
  {
    // Corners of a convex polygon with small integer coordinates, and vertices on its sides.
    std::vector<Polygon> shapes = { { Vec2(0, 0), Vec2(8, 0), Vec2(8, 8), Vec2(0, 8) },
      { Vec2(0, 0), Vec2(16, 8), Vec2(8, 16) },
      { Vec2(8, 0), Vec2(16, 8), Vec2(8, 16), Vec2(0, 8) },
      { Vec2(0, 0), Vec2(8, 0), Vec2(16, 8), Vec2(16, 16), Vec2(0, 8) } };
    const Polygon corners = shapes[k % shapes.size()];
    Polygon polygon;
    for (std::size_t i = 0; i < corners.size(); ++i)
    {
      const Vec2 d = corners[(i + 1) % corners.size()] - corners[i];
      for (int j = 0; j < 8; ++j)
      {
        if (j == 0 || random() % 3 == 0)
        {
          polygon.push_back(corners[i] + d * (j / 8.0)); // exact
        }
      }
    }
    std::rotate(polygon.begin(), polygon.begin() + random() % polygon.size(), polygon.end());
    ASSERT_TRUE(nurbs::IsConvex(polygon));
    ExpectTriangulation(
      { polygon }, nurbs::TriangulateConvex(polygon), int(polygon.size()) - 2, true);
  }
}

TEST(TriangulateConvex, TakesExtremes)
{
  EXPECT_TRUE(nurbs::TriangulateConvex({}).empty());
  EXPECT_TRUE(nurbs::TriangulateConvex({ Vec2(0, 0), Vec2(1, 0) }).empty());
  EXPECT_EQ(
    nurbs::TriangulateConvex({ Vec2(0, 0), Vec2(1, 0), Vec2(2, 0), Vec2(3, 0) }).size(), 6u);
  EXPECT_EQ(nurbs::TriangulateConvex({ Vec2(0, 0), Vec2(1, 0), Vec2(0, 1) }).size(), 3u);
  Polygon circle;
  for (int i = 0; i < 10000; ++i)
  {
    circle.push_back(
      Vec2(std::cos(i * 2e-4 * std::acos(-1.0)), std::sin(i * 2e-4 * std::acos(-1.0))));
  }
  ExpectTriangulation({ circle }, nurbs::TriangulateConvex(circle), 9998, true);
}

TEST(IsConvex, TellsTurnsAndWindings)
{
  EXPECT_TRUE(nurbs::IsConvex({ Vec2(0, 0), Vec2(1, 0), Vec2(2, 0), Vec2(1, 1) }));
  EXPECT_FALSE(nurbs::IsConvex({ Vec2(0, 0), Vec2(2, 0), Vec2(1, 0.1), Vec2(1, 1) }));
  EXPECT_FALSE(nurbs::IsConvex({ Vec2(0, 0), Vec2(0, 1), Vec2(1, 0) }));
  Polygon twice;
  for (int i = 0; i < 10; ++i)
  {
    twice.push_back(
      Vec2(std::cos(i * 1.2566370614), std::sin(i * 1.2566370614)) * (1.0 + 0.01 * i));
  }
  EXPECT_FALSE(nurbs::IsConvex(twice));
}

Polygon Star(int n, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> radius(0.1, 1.0);
  Polygon star;
  for (int i = 0; i < n; ++i)
  {
    const double a = 2.0 * std::acos(-1.0) * i / n;
    const double r = radius(random);
    star.push_back(Vec2(r * std::cos(a), r * std::sin(a)));
  }
  return star;
}

Polygon Comb(int teeth)
{
  Polygon comb = { Vec2(2.0 * teeth, 0), Vec2(2.0 * teeth, 1) };
  for (int i = teeth; i-- > 0;)
  {
    comb.push_back(Vec2(2.0 * i + 1.5, 5.0 + 0.1 * i));
    comb.push_back(Vec2(2.0 * i + 0.5, 5.0 + 0.1 * i));
    comb.push_back(Vec2(2.0 * i, 1.0));
  }
  comb.push_back(Vec2(0, 0));
  return comb;
}

Polygon Spiral(int n)
{
  Polygon outer;
  Polygon inner;
  for (int i = 0; i < n; ++i)
  {
    const double a = 0.2 * i;
    outer.push_back(Vec2(std::cos(a), std::sin(a)) * (1.0 + 0.1 * a + 0.3));
    inner.push_back(Vec2(std::cos(a), std::sin(a)) * (1.0 + 0.1 * a));
  }
  Polygon spiral = outer;
  spiral.insert(spiral.end(), inner.rbegin(), inner.rend());
  return spiral;
}

TEST(TriangulatePolygon, TakesStarsCombsAndSpirals)
{
  for (unsigned seed = 0; seed < 100; ++seed)
  {
    const Polygon star = Star(3 + int(seed), seed);
    ExpectTriangulation({ star }, nurbs::TriangulatePolygon({ star }), int(star.size()) - 2, false);
  }
  for (int n : { 1, 2, 7, 40 })
  {
    const Polygon comb = Comb(n);
    ExpectTriangulation({ comb }, nurbs::TriangulatePolygon({ comb }), int(comb.size()) - 2, false);
  }
  const Polygon spiral = Spiral(200);
  ExpectTriangulation(
    { spiral }, nurbs::TriangulatePolygon({ spiral }), int(spiral.size()) - 2, false);
}

TEST(TriangulatePolygon, TakesHolesIslandsAndSeveralOuterLoops)
{
  std::vector<Polygon> loops = { { Vec2(0, 0), Vec2(20, 0), Vec2(20, 20), Vec2(0, 20) } };
  int count = 2;
  for (int i = 0; i < 9; ++i)
  {
    Polygon hole = Star(12, 70 + i);
    for (Vec2& p : hole)
    {
      p = Vec2(3.0 + 6.0 * (i % 3), 3.0 + 6.0 * (i / 3)) + 2.5 * p;
    }
    std::reverse(hole.begin(), hole.end());
    loops.push_back(hole);
    count += 12 + 2;
  }
  loops.push_back({ Vec2(30, 0), Vec2(31, 0), Vec2(30, 1) }); // another outer loop
  count += 1;
  ExpectTriangulation(loops, nurbs::TriangulatePolygon(loops), count, false);
  // A hole with an island.
  loops = { { Vec2(0, 0), Vec2(9, 0), Vec2(9, 9), Vec2(0, 9) },
    { Vec2(1, 1), Vec2(1, 8), Vec2(8, 8), Vec2(8, 1) }, { Vec2(3, 3), Vec2(6, 3), Vec2(4, 6) } };
  ExpectTriangulation(loops, nurbs::TriangulatePolygon(loops), 8 + 1, false);
}

TEST(TriangulatePolygon, TakesManyVerticesOnOneLine)
{
  Polygon polygon; // grid-like: vertices with equal u and v
  for (int i = 0; i < 10; ++i)
  {
    polygon.push_back(Vec2(i, 0));
  }
  for (int i = 9; i >= 0; --i)
  {
    polygon.push_back(Vec2(i, i % 2 == 0 ? 2 : 1));
  }
  ExpectTriangulation({ polygon }, nurbs::TriangulatePolygon({ polygon }), 18, false);
}

TEST(TriangulatePolygon, RefusesWhatItCannotCover)
{
  EXPECT_THROW(nurbs::TriangulatePolygon({ { Vec2(0, 0), Vec2(0, 1), Vec2(1, 0) } }), nurbs::Error);
  EXPECT_THROW(nurbs::TriangulatePolygon({ { Vec2(0, 0), Vec2(1, 1), Vec2(1, 0), Vec2(0, 1.5) } }),
    nurbs::Error);
  EXPECT_THROW(nurbs::TriangulatePolygon({ { Vec2(0, 0), Vec2(1, 1) } }), nurbs::Error);
}

TEST(TriangulatePolygon, NeedsTimeOfOrderNLogN)
{
  double last = 0.0;
  for (int n : { 10000, 100000 })
  {
    const Polygon star = Star(n, 3);
    const auto start = std::chrono::steady_clock::now();
    const std::vector<int> triangles = nurbs::TriangulatePolygon({ star });
    const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    ASSERT_EQ(int(triangles.size()), 3 * (n - 2));
    std::printf("%6d vertices: %.1f ms\n", n, 1e3 * seconds);
    EXPECT_LT(seconds, std::max(1.0, 60.0 * last));
    last = seconds;
  }
}

} // namespace
