// SPDX-License-Identifier: BSD-3-Clause
// The triangulations that meshes are made of: cells with neighbours' vertices, and zones between
// cells and loops, by their areas and edges.
#include "RectangleTriangulation.h"
#include "ZoneTriangulation.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace
{

using nurbs::Vec2;
using nurbs::Vec3;
using Triangles = std::vector<std::array<int, 3>>;

double Area(const std::vector<Vec2>& points, const std::array<int, 3>& t)
{
  const Vec2 a = points[t[1]] - points[t[0]];
  const Vec2 b = points[t[2]] - points[t[0]];
  return 0.5 * (a[0] * b[1] - a[1] * b[0]);
}

double Area(const std::vector<Vec2>& points, const Triangles& triangles)
{
  double sum = 0.0;
  for (const auto& t : triangles)
  {
    sum += Area(points, t);
  }
  return sum;
}

// Directed edges that no other triangle has backwards.
std::size_t OpenEdges(const Triangles& triangles)
{
  std::map<std::pair<int, int>, int> edges;
  for (const auto& t : triangles)
  {
    for (int k = 0; k < 3; ++k)
    {
      ++edges[{ t[k], t[(k + 1) % 3] }];
    }
  }
  std::size_t open = 0;
  for (const auto& edge : edges)
  {
    EXPECT_EQ(edge.second, 1);
    open += edges.count({ edge.first.second, edge.first.first }) == 0;
  }
  return open;
}

TEST(nurbsWaveletMesh, CellsTakeVerticesOnTheirSides)
{
  std::mt19937 random(21);
  std::uniform_real_distribution<double> value(0.0, 1.0);
  std::uniform_int_distribution<int> count(0, 6);
  for (int round = 0; round < 2000; ++round)
  {
    std::vector<Vec2> corners;
    std::vector<Vec3> points;
    for (int side = 0; side < 4; ++side)
    {
      std::vector<double> at(1, 0.0);
      for (int k = round % 4 == side ? 0 : count(random); k > 0; --k)
      {
        at.push_back(value(random));
      }
      std::sort(at.begin(), at.end());
      for (const double t : at)
      {
        const Vec2 place[4] = { { t, 0.0 }, { 1.0, t }, { 1.0 - t, 1.0 }, { 0.0, 1.0 - t } };
        corners.push_back(place[side]);
        points.emplace_back(place[side][0], place[side][1] * (1 + round % 7), 0.1 * value(random));
      }
    }
    const Triangles triangles = nurbs::TriangulateRectangle(corners, points);
    ASSERT_EQ(triangles.size() + 2, corners.size());
    for (const auto& t : triangles)
    {
      ASSERT_GT(Area(corners, t), 0.0);
    }
    EXPECT_NEAR(Area(corners, triangles), 1.0, 1e-12);
    EXPECT_EQ(OpenEdges(triangles), corners.size());
  }
}

TEST(nurbsWaveletMesh, PlainCellsHaveTheShorterDiagonal)
{
  const std::vector<Vec2> corners = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
  const std::vector<Vec3> sheared = { { 0, 0, 0 }, { 1, 0, 0 }, { 2, 1, 0 }, { 1, 1, 0 } };
  const Triangles triangles = nurbs::TriangulateRectangle(corners, sheared);
  ASSERT_EQ(triangles.size(), 2u);
  EXPECT_EQ(triangles[0], (std::array<int, 3>{ 0, 1, 3 }));
}

void AddPolygon(nurbs::Zone& zone, const std::vector<Vec2>& polygon)
{
  const int first = int(zone.Points.size());
  const int n = int(polygon.size());
  for (int k = 0; k < n; ++k)
  {
    zone.Points.push_back(polygon[k]);
    zone.Walls.push_back({ first + k, first + (k + 1) % n });
  }
}

std::vector<Vec2> Square(double a, double b)
{
  return { { a, a }, { b, a }, { b, b }, { a, b } };
}

TEST(nurbsWaveletMesh, ZoneIsBetweenItsWalls)
{
  nurbs::Zone zone;
  AddPolygon(zone, Square(0.0, 10.0));
  AddPolygon(zone, Square(2.0, 8.0));
  AddPolygon(zone, Square(4.0, 5.0)); // An island.
  zone.Points.emplace_back(1.0, 1.0);
  const nurbs::ZoneTriangles made = nurbs::TriangulateZone(zone);
  EXPECT_TRUE(made.Added.empty());
  EXPECT_NEAR(Area(zone.Points, made.Triangles), 100.0 - 36.0 + 1.0, 1e-12);
  EXPECT_EQ(OpenEdges(made.Triangles), 12u);
}

// No sound caller asks for these; what can't be meshed is left out.
TEST(nurbsWaveletMesh, WallsThatDoNotCloseAndFlatRectangles)
{
  nurbs::Zone zone;
  zone.Points = { Vec2(0.0, 0.0), Vec2(1.0, 0.0), Vec2(1.0, 1.0), Vec2(0.0, 1.0), Vec2(2.0, 3.0) };
  zone.Walls = { { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 4 } };
  for (const std::array<int, 3>& t : nurbs::TriangulateZone(zone).Triangles)
  {
    for (const int corner : t)
    {
      EXPECT_GE(corner, 0);
      EXPECT_LT(corner, 5);
    }
  }
  std::vector<Vec2> corners;
  std::vector<Vec3> points;
  for (int k = 0; k < 6; ++k)
  {
    corners.emplace_back(0.2 * k, 0.0);
    points.emplace_back(0.2 * k, 0.0, 0.0);
  }
  EXPECT_TRUE(nurbs::TriangulateRectangle(corners, points).empty());
}

TEST(nurbsWaveletMesh, LinesAreEdgesAndNoWalls)
{
  nurbs::Zone zone;
  AddPolygon(zone, Square(0.0, 2.0));
  zone.Points.emplace_back(0.0, 0.7);
  zone.Points.emplace_back(2.0, 1.4);
  zone.Walls[3] = { 3, 4 };
  zone.Walls.push_back({ 4, 0 });
  zone.Walls[1] = { 1, 5 };
  zone.Walls.push_back({ 5, 2 });
  zone.Lines.push_back({ 4, 5 });
  const nurbs::ZoneTriangles made = nurbs::TriangulateZone(zone);
  EXPECT_NEAR(Area(zone.Points, made.Triangles), 4.0, 1e-12);
  int beside = 0;
  for (const auto& t : made.Triangles)
  {
    for (int k = 0; k < 3; ++k)
    {
      beside += std::minmax(t[k], t[(k + 1) % 3]) == std::minmax(4, 5);
    }
  }
  EXPECT_EQ(beside, 2);
}

// A crease that a wall runs along, in pieces of its own, one of no length, and a wall that covers others.
TEST(nurbsWaveletMesh, LinesAlongWallsLeaveThemWalls)
{
  nurbs::Zone zone;
  AddPolygon(zone, Square(0.0, 4.0));
  AddPolygon(zone, Square(1.0, 3.0));
  zone.Points.emplace_back(2.0, 1.0);
  zone.Points.emplace_back(2.0, 1.0);
  zone.Lines = { { 4, 8 }, { 9, 5 }, { 8, 9 }, { 3, 0 } };
  const nurbs::ZoneTriangles made = nurbs::TriangulateZone(zone);
  EXPECT_NEAR(Area(zone.Points, made.Triangles), 16.0 - 4.0, 1e-12);
  zone.Walls.push_back({ 4, 8 });
  zone.Walls.push_back({ 8, 5 }); // Now there twice: no wall, and the zone has a slit there.
  zone.Walls.push_back({ 4, 7 });
  zone.Walls.push_back({ 7, 6 });
  zone.Walls.push_back({ 6, 5 });
  const nurbs::ZoneTriangles whole = nurbs::TriangulateZone(zone);
  EXPECT_NEAR(Area(zone.Points, whole.Triangles), 16.0, 1e-12);
}

TEST(nurbsWaveletMesh, WallsThatCrossMakeVerticesAndSlitsDoNot)
{
  nurbs::Zone zone;
  AddPolygon(zone, { { 0, 0 }, { 2, 2 }, { 2, 0 }, { 0, 2 } }); // A bow tie.
  const nurbs::ZoneTriangles made = nurbs::TriangulateZone(zone);
  ASSERT_EQ(made.Added.size(), 1u);
  EXPECT_LT((made.Added[0] - Vec2(1.0, 1.0)).norm(), 1e-12);
  EXPECT_EQ(made.Triangles.size(), 2u);

  nurbs::Zone slit;
  AddPolygon(slit, Square(0.0, 4.0));
  AddPolygon(slit, { { 1, 1 }, { 3, 3 } }); // There and back.
  const nurbs::ZoneTriangles whole = nurbs::TriangulateZone(slit);
  EXPECT_TRUE(whole.Added.empty());
  EXPECT_NEAR(Area(slit.Points, whole.Triangles), 16.0, 1e-12);
}

} // namespace
