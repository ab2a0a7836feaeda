// SPDX-License-Identifier: BSD-3-Clause
// Hidden lines without what others draw already, against unions of intervals.
#include "CoincidentLines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace
{

using nurbs::PlaneLine;
using nurbs::Vec2;

constexpr double Tolerance = 1e-3;

struct Drawn
{
  std::vector<PlaneLine> Lines;
  std::vector<char> IsVisible;

  void Add(const std::vector<Vec2>& points, bool isVisible)
  {
    this->Lines.push_back({ points, 0, std::int64_t(this->Lines.size()) });
    this->IsVisible.push_back(isVisible);
  }
};

double Length(const std::vector<PlaneLine>& lines)
{
  double sum = 0.0;
  for (const PlaneLine& line : lines)
  {
    for (std::size_t k = 1; k < line.Points.size(); ++k)
    {
      sum += (line.Points[k] - line.Points[k - 1]).norm();
    }
  }
  return sum;
}

TEST(CoincidentLines, HiddenOnesUnderOthers)
{
  Drawn drawn;
  drawn.Add({ Vec2(0, 0), Vec2(1, 0.5) }, false);
  drawn.Add({ Vec2(1, 0.5), Vec2(0, 0) }, false);                       // A copy, turned.
  drawn.Add({ Vec2(0.2, 0.1), Vec2(0.6, 0.3), Vec2(1.4, 0.7) }, false); // A part of it is new.
  drawn.Add({ Vec2(0, 1), Vec2(2, 1) }, false);                         // Half of it is
  drawn.Add({ Vec2(1, 1), Vec2(3, 1) }, true);                          // under this one.
  drawn.Add({ Vec2(0.5, -1), Vec2(0.5, 2) }, false);                    // Crosses all.
  const std::vector<std::size_t> from =
    nurbs::DropHiddenCopies(drawn.Lines, drawn.IsVisible, Tolerance);
  EXPECT_EQ(from, (std::vector<std::size_t>{ 0, 2, 3, 4, 5 }));
  ASSERT_EQ(drawn.Lines.size(), 5u);
  EXPECT_LT((drawn.Lines[1].Points.front() - Vec2(1, 0.5)).norm(), 2 * Tolerance);
  EXPECT_EQ(drawn.Lines[1].Points.back(), Vec2(1.4, 0.7));
  EXPECT_EQ(drawn.Lines[1].Source, 2);
  EXPECT_LT((drawn.Lines[2].Points.back() - Vec2(1, 1)).norm(), 2 * Tolerance);
  EXPECT_EQ(drawn.Lines[4].Points, (std::vector<Vec2>{ Vec2(0.5, -1), Vec2(0.5, 2) }));
}

TEST(CoincidentLines, LinesThatTouchStay)
{
  Drawn drawn;
  std::vector<Vec2> circle;
  for (int k = 0; k <= 400; ++k)
  {
    circle.emplace_back(
      std::cos(k * 3.141592653589793 / 200), std::sin(k * 3.141592653589793 / 200));
  }
  drawn.Add({ Vec2(-2, 0.5), Vec2(2, 0.5) }, true);
  drawn.Add(circle, false);
  const double before = Length(drawn.Lines);
  nurbs::DropHiddenCopies(drawn.Lines, drawn.IsVisible, Tolerance);
  EXPECT_EQ(drawn.Lines.size(), 2u);
  EXPECT_EQ(Length(drawn.Lines), before);
}

// Intervals of one line, cut anyhow: what is left is as long as their union.
TEST(CoincidentLines, LengthIsThatOfTheUnion)
{
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> random(0.0, 10.0);
  for (int round = 0; round < 50; ++round)
  {
    Drawn drawn;
    std::vector<char> covered(10000, 0);
    const Vec2 way = Vec2(random(engine) - 5.0, random(engine) - 5.0).normalized();
    double visible = 0.0;
    for (int k = 0; k < 12; ++k)
    {
      const double a = random(engine), b = random(engine);
      std::vector<Vec2> points;
      for (int i = 0; i <= 1 + k % 4; ++i)
      {
        points.emplace_back((a + double(i) / (1 + k % 4) * (b - a)) * way);
      }
      drawn.Add(points, k == 7);
      visible += k == 7 ? std::abs(b - a) : 0.0;
      for (std::size_t i = 0; i < covered.size(); ++i)
      {
        const double t = (double(i) + 0.5) / 1000.0;
        covered[i] |= t > std::min(a, b) && t < std::max(a, b);
      }
    }
    ASSERT_GT(Length(drawn.Lines) - visible, 10.0);
    nurbs::DropHiddenCopies(drawn.Lines, drawn.IsVisible, Tolerance);
    const auto expected = double(std::count(covered.begin(), covered.end(), 1)) / 1000.0;
    // Parts up to four tolerances may go or stay.
    EXPECT_NEAR(Length(drawn.Lines), expected, 24 * 4 * Tolerance);
  }
}

TEST(CoincidentLines, NothingToDo)
{
  std::vector<PlaneLine> none;
  EXPECT_TRUE(nurbs::DropHiddenCopies(none, {}, Tolerance).empty());
  Drawn drawn;
  drawn.Add({ Vec2(1, 1) }, false);
  drawn.Add({ Vec2(1, 1), Vec2(1, 1) }, false);
  EXPECT_LE(nurbs::DropHiddenCopies(drawn.Lines, drawn.IsVisible, Tolerance).size(), 1u);
}

} // namespace
