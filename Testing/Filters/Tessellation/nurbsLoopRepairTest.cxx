// SPDX-License-Identifier: BSD-3-Clause
// Crossing sides against a brute-force search, repaired loops against winding numbers of points.
#include "LoopRepair.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>

namespace
{

using nurbs::CrossingFinder;
using nurbs::Loops2;
using nurbs::RepairedLoops;
using nurbs::RepairLoops;
using nurbs::Vec2;

std::vector<Vec2> Square(double x, double y, double size, bool clockwise = false)
{
  std::vector<Vec2> square = { Vec2(x, y), Vec2(x + size, y), Vec2(x + size, y + size),
    Vec2(x, y + size) };
  if (clockwise)
  {
    std::reverse(square.begin(), square.end());
  }
  return square;
}

std::vector<Vec2> Circle(int n, double r = 1.0)
{
  std::vector<Vec2> circle;
  for (int i = 0; i < n; ++i)
  {
    const double a = 2.0 * std::acos(-1.0) * i / n;
    circle.push_back(Vec2(r * std::cos(a), r * std::sin(a)));
  }
  return circle;
}

std::vector<std::pair<int, int>> Crossings(const Loops2& loops)
{
  CrossingFinder finder;
  return finder.Find(loops);
}

/// The winding number of loops around p by summed angles.
int Winding(const Loops2& loops, const Vec2& p)
{
  double sum = 0.0;
  for (const std::vector<Vec2>& loop : loops)
  {
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
      const Vec2 a = loop[i] - p;
      const Vec2 b = loop[(i + 1) % loop.size()] - p;
      sum += std::atan2(a[0] * b[1] - a[1] * b[0], a.dot(b));
    }
  }
  return int(std::lround(sum / (2.0 * std::acos(-1.0))));
}

Loops2 Positions(const RepairedLoops& repaired)
{
  Loops2 loops;
  for (const auto& loop : repaired.Loops)
  {
    loops.emplace_back();
    for (const auto& vertex : loop)
    {
      loops.back().push_back(vertex.P);
    }
  }
  return loops;
}

double Area(const Loops2& loops)
{
  double sum = 0.0;
  for (const std::vector<Vec2>& loop : loops)
  {
    sum += 0.5 * nurbs::SignedArea2(loop);
  }
  return sum;
}

/// Every vertex and side of the result lies on the input side that it names.
void ExpectOrigins(const Loops2& input, const RepairedLoops& repaired)
{
  std::vector<std::pair<Vec2, Vec2>> sides;
  for (const std::vector<Vec2>& loop : input)
  {
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
      sides.emplace_back(loop[i], loop[(i + 1) % loop.size()]);
    }
  }
  for (const auto& loop : repaired.Loops)
  {
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
      const auto& v = loop[i];
      ASSERT_GE(v.Side, 0);
      const auto& side = sides[v.Side];
      const Vec2 d = side.second - side.first;
      ASSERT_LT((side.first + v.S0 * d - v.P).norm(), 1e-12);
      ASSERT_LT((side.first + v.S1 * d - loop[(i + 1) % loop.size()].P).norm(), 1e-12);
      if (v.Source >= 0)
      {
        ASSERT_EQ(v.P, sides[v.Source].first);
      }
    }
  }
}

TEST(CrossingFinder, LetsSoundLoopsPass)
{
  EXPECT_TRUE(Crossings({ Square(0, 0, 4), Square(1, 1, 1, true) }).empty());
  // A hole that touches the outer loop with a vertex, and a slit.
  EXPECT_TRUE(Crossings({ { Vec2(0, 0), Vec2(2, 0), Vec2(4, 0), Vec2(4, 4), Vec2(0, 4) },
                          { Vec2(2, 0), Vec2(1, 1), Vec2(3, 1) } })
                .empty());
  EXPECT_TRUE(Crossings(
    { { Vec2(0, 0), Vec2(2, 0), Vec2(2, 1), Vec2(2, 0), Vec2(4, 0), Vec2(4, 4), Vec2(0, 4) } })
                .empty());
  EXPECT_TRUE(Crossings({ { Vec2(0, 0), Vec2(0, 0), Vec2(1, 0), Vec2(0, 1) } }).empty());
  EXPECT_TRUE(Crossings({ Circle(3000) }).empty());
  EXPECT_TRUE(Crossings({}).empty());
}

TEST(CrossingFinder, FindsEveryKindOfConflict)
{
  using Pairs = std::vector<std::pair<int, int>>;
  // A bow-tie; a vertex on a side; sides that overlap; neighbours that fold back.
  EXPECT_EQ(Crossings({ { Vec2(0, 0), Vec2(1, 1), Vec2(1, 0), Vec2(0, 1) } }), (Pairs{ { 0, 2 } }));
  EXPECT_EQ(Crossings({ { Vec2(0, 0), Vec2(4, 0), Vec2(4, 4), Vec2(2, 0), Vec2(0, 4) } }),
    (Pairs{ { 0, 2 }, { 0, 3 } }));
  EXPECT_EQ(Crossings({ Square(0, 0, 2), { Vec2(0.5, 0), Vec2(1.5, 0), Vec2(1, 1) } }),
    (Pairs{ { 0, 4 }, { 0, 5 }, { 0, 6 } }));
  EXPECT_EQ(Crossings({ { Vec2(0, 0), Vec2(3, 0), Vec2(1, 0), Vec2(1, 1) } }),
    (Pairs{ { 0, 1 }, { 0, 2 } }));
  EXPECT_EQ(Crossings({ Square(0, 0, 2), Square(0, 0, 2) }).size(), 4u);
  // Exactly on the line, where rounding would say otherwise.
  const Vec2 a(0.1, 0.1);
  const Vec2 b(0.3, 0.3);
  EXPECT_EQ(
    Crossings({ { a, b, Vec2(1, 0) }, { Vec2(0.2, 0.2), Vec2(0, 1), Vec2(-1, 1) } }).size(), 2u);
}

TEST(CrossingFinder, AgreesWithBruteForce)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  CrossingFinder finder;
  for (int n : { 5, 40, 200, 900 })
  {
    std::vector<Vec2> loop;
    for (int i = 0; i < n; ++i)
    {
      loop.push_back(Vec2(unit(random), unit(random)));
    }
    std::vector<std::pair<int, int>> expected;
    for (int i = 0; i < n; ++i)
    {
      for (int j = i + 2; j < n - (i == 0); ++j)
      {
        // The intersection of the two lines by Cramer's rule.
        const Vec2 p = loop[i];
        const Vec2 d = loop[i + 1] - p;
        const Vec2 q = loop[j];
        const Vec2 e = loop[(j + 1) % n] - q;
        const double det = d[0] * e[1] - d[1] * e[0];
        const Vec2 pq = q - p;
        const double s = (pq[0] * e[1] - pq[1] * e[0]) / det;
        const double t = (pq[0] * d[1] - pq[1] * d[0]) / det;
        if (s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0)
        {
          expected.emplace_back(i, j);
        }
      }
    }
    EXPECT_EQ(finder.Find({ loop }), expected);
  }
}

TEST(CrossingFinder, IsFast)
{
  CrossingFinder finder;
  for (int n : { 8, 64, 500, 10000, 100000 })
  {
    const Loops2 loops = { Circle(n), Square(0, 0, 0.1, true) };
    const int repeat = std::max(1, 100000 / n);
    const auto start = std::chrono::steady_clock::now();
    for (int k = 0; k < repeat; ++k)
    {
      ASSERT_TRUE(finder.Find(loops).empty());
    }
    const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::printf("%6d sides: %.3f us a side\n", n, 1e6 * seconds / (repeat * double(n + 4)));
    EXPECT_LT(seconds, 5.0);
  }
}

TEST(RepairLoops, LeavesSoundLoopsAlone)
{
  const Loops2 loops = { Square(0, 0, 9), Square(1, 1, 5, true), Square(2, 2, 1) };
  const RepairedLoops repaired = RepairLoops(loops);
  EXPECT_FALSE(repaired.Changed);
  EXPECT_EQ(repaired.Message, "");
  EXPECT_EQ(Positions(repaired), loops);
  EXPECT_EQ(repaired.Loops[1][2].Source, 6);
  EXPECT_EQ(repaired.Loops[1][2].Side, 6);
}

TEST(RepairLoops, TurnsLoopsByTheirDepth)
{
  const Loops2 loops = { Square(0, 0, 9, true), Square(1, 1, 5), Square(2, 2, 1, true),
    Square(7, 7, 1, true) };
  const RepairedLoops repaired = RepairLoops(loops);
  EXPECT_TRUE(repaired.Changed);
  EXPECT_NE(repaired.Message.find("3 loops that ran the wrong way"), std::string::npos)
    << repaired.Message;
  EXPECT_NEAR(Area(Positions(repaired)), 81.0 - 25.0 + 1.0 - 1.0, 1e-12);
  ExpectOrigins(loops, repaired);
}

TEST(RepairLoops, JoinsWhatOverlaps)
{
  const Loops2 overlapping = { Square(0, 0, 2), Square(1, 1, 2) };
  RepairedLoops repaired = RepairLoops(overlapping);
  EXPECT_EQ(repaired.Loops.size(), 1u);
  EXPECT_NEAR(Area(Positions(repaired)), 7.0, 1e-12);
  EXPECT_NE(repaired.Message.find("cross"), std::string::npos);
  ExpectOrigins(overlapping, repaired);
  // A hole that leaves the outer loop takes away what is inside.
  repaired = RepairLoops({ Square(0, 0, 2), Square(1, 1, 2, true) });
  EXPECT_NEAR(Area(Positions(repaired)), 3.0, 1e-12);
  // Inside out: nothing is wound around positively.
  repaired = RepairLoops({ Square(0, 0, 2, true), Square(1, 1, 2, true) });
  EXPECT_NEAR(Area(Positions(repaired)), 6.0, 1e-12);
}

TEST(RepairLoops, KeepsLobesThatRunTheOtherWay)
{
  const RepairedLoops repaired = RepairLoops({ { Vec2(0, 0), Vec2(3, 0), Vec2(3, 2), Vec2(4, 2),
    Vec2(4, 1), Vec2(2, 1), Vec2(2, 3), Vec2(0, 3) } });
  EXPECT_TRUE(Crossings(Positions(repaired)).empty());
  EXPECT_NEAR(Area(Positions(repaired)), 7.0 + 1.0, 1e-12);
}

TEST(RepairLoops, ResolvesAPentagram)
{
  const std::vector<Vec2> c = Circle(5);
  const Loops2 star = { { c[0], c[2], c[4], c[1], c[3] } };
  const RepairedLoops repaired = RepairLoops(star);
  ASSERT_EQ(repaired.Loops.size(), 1u);
  EXPECT_EQ(repaired.Loops[0].size(), 10u);
  int known = 0;
  for (const auto& vertex : repaired.Loops[0])
  {
    known += vertex.Source >= 0;
  }
  EXPECT_EQ(known, 5);
  ExpectOrigins(star, repaired);
}

TEST(RepairLoops, DropsWhatHasNoArea)
{
  const RepairedLoops repaired = RepairLoops(
    { Square(0, 0, 2), { Vec2(5, 5), Vec2(6, 6), Vec2(7, 7) }, { Vec2(9, 9), Vec2(9, 9) }, {} });
  EXPECT_EQ(repaired.Loops.size(), 1u);
  EXPECT_NE(repaired.Message.find("without area"), std::string::npos) << repaired.Message;
  EXPECT_TRUE(RepairLoops({}).Loops.empty());
  EXPECT_THROW(RepairLoops({ { Vec2(0, 0), Vec2(std::nan(""), 0), Vec2(1, 1) } }), nurbs::Error);
}

TEST(RepairLoops, KeepsTheRegionOfRandomLoops)
{
  std::mt19937 random(21);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int k = 0; k < 60; ++k)
  {
    Loops2 loops(1 + k % 3);
    for (std::vector<Vec2>& loop : loops)
    {
      for (int i = 0; i < 4 + k % 9; ++i)
      {
        Vec2 p(unit(random), unit(random));
        if (k % 2 == 0) // on a coarse grid: overlaps, touching vertices
        {
          p = (p * 6.0).array().round() / 6.0;
        }
        loop.push_back(p);
      }
    }
    const RepairedLoops repaired = RepairLoops(loops);
    const Loops2 result = Positions(repaired);
    ASSERT_TRUE(Crossings(result).empty()) << k;
    ExpectOrigins(loops, repaired);
    for (int i = 0; i < 200; ++i)
    {
      const Vec2 p(unit(random), unit(random));
      bool before = false;
      for (const std::vector<Vec2>& loop : loops)
      {
        before = before || Winding({ loop }, p) != 0;
      }
      const int after = Winding(result, p);
      ASSERT_TRUE(after == 0 || after == 1) << k;
      if (after == 1)
      {
        ASSERT_TRUE(before) << k;
      }
    }
  }
}

} // namespace
