// SPDX-License-Identifier: BSD-3-Clause
#include "nurbsReference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace nurbs;

namespace
{

const std::vector<double> Cubic{ 0, 0, 0, 0, 1, 2, 2, 2, 3, 3, 3, 3 }; // 8 points, crease at 2

bool Mentions(const std::string& text, const std::string& word)
{
  return text.find(word) != std::string::npos;
}

} // namespace

TEST(KnotVector, SoundOnesPass)
{
  EXPECT_EQ(CheckKnots(Cubic, 3, 8), "");
  EXPECT_EQ(CheckKnots(std::vector<double>{ 0, 1, 2, 3, 4, 5, 6 }, 2, 4), "");
  EXPECT_EQ(CheckKnots(std::vector<double>{ 4, 5 }, 0, 1), "");
  reference::Random random(1);
  for (int degree = 1; degree <= MaxDegree; ++degree)
  {
    for (bool clamped : { false, true })
    {
      const int count = degree + 1 + random.Integer(0, 8);
      EXPECT_EQ(CheckKnots(random.Knots(degree, count, clamped, true), degree, count), "");
    }
  }
}

TEST(KnotVector, BadOnesAreNamed)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const double huge = std::numeric_limits<double>::max();
  const std::vector<double> line{ 0, 0, 1, 1 };
  EXPECT_TRUE(Mentions(CheckKnots(Cubic, 3, 9), "12 knots instead of 13"));
  EXPECT_TRUE(Mentions(CheckKnots(line, 26, 2), "degree 26"));
  EXPECT_TRUE(Mentions(CheckKnots(line, -1, 2), "degree -1"));
  EXPECT_TRUE(Mentions(CheckKnots(line, 2, 2), "too few"));
  EXPECT_TRUE(Mentions(CheckKnots(line, 1, -5), "too few"));
  EXPECT_TRUE(Mentions(CheckKnots(std::vector<double>{ 0, 0, nan, 1 }, 1, 2), "knot 2"));
  EXPECT_TRUE(Mentions(CheckKnots(std::vector<double>{ 0, 0, 1, inf }, 1, 2), "knot 3"));
  EXPECT_TRUE(Mentions(CheckKnots(std::vector<double>{ 0, 0, 1, 0.5 }, 1, 2), "smaller"));
  EXPECT_TRUE(Mentions(CheckKnots(std::vector<double>{ 0, 1, 1, 2 }, 1, 2), "empty"));
  EXPECT_TRUE(
    Mentions(CheckKnots(std::vector<double>{ 0, 0, 1, 1, 1, 2, 2 }, 1, 5), "degree + 1 times"));
  EXPECT_TRUE(
    Mentions(CheckKnots(std::vector<double>{ -huge, -huge, huge, huge }, 1, 2), "overflows"));
}

TEST(KnotVector, SpansContainTheirParameters)
{
  reference::Random random(2);
  for (int trial = 0; trial < 300; ++trial)
  {
    const int degree = random.Integer(0, 7);
    const int count = degree + 1 + random.Integer(0, 12);
    const std::vector<double> knots = random.Knots(degree, count, trial % 2 == 0, true);
    const double t = random.Parameter(knots, degree);
    const int span = FindSpan(knots, degree, t);
    ASSERT_GE(span, degree);
    ASSERT_LT(span, count);
    EXPECT_LT(knots[span], knots[span + 1]);
    EXPECT_LE(knots[span], t);
    if (t < Domain(knots, degree).Max)
    {
      EXPECT_LT(t, knots[span + 1]);
    }
    else
    {
      EXPECT_EQ(t, knots[span + 1]);
    }
    for (int hint = -1; hint <= count + degree; ++hint)
    {
      EXPECT_EQ(FindSpan(knots, degree, t, hint), span);
    }
  }
}

TEST(KnotVector, ParametersOutsideUseTheEndSpans)
{
  EXPECT_EQ(FindSpan(Cubic, 3, -5.0), 3);
  EXPECT_EQ(FindSpan(Cubic, 3, 99.0), 7);
  EXPECT_EQ(FindSpan(Cubic, 3, 3.0), 7);
  const int span = FindSpan(Cubic, 3, std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(span >= 3 && span <= 7);
}

TEST(KnotVector, DistinctAndCreaseKnots)
{
  const std::vector<Knot> distinct = DistinctKnots(Cubic, 3);
  ASSERT_EQ(distinct.size(), 4u);
  EXPECT_EQ(distinct[2].Value, 2.0);
  EXPECT_EQ(distinct[2].Multiplicity, 3);
  EXPECT_EQ(distinct[3].Multiplicity, 4);
  EXPECT_EQ(CreaseKnots(Cubic, 3), std::vector<double>{ 2.0 });
  EXPECT_TRUE(CreaseKnots(std::vector<double>{ 0, 1, 2, 3, 4, 5, 6 }, 2).empty());
  EXPECT_EQ(CreaseKnots(std::vector<double>{ 0, 0, 1, 2, 2 }, 1), std::vector<double>{ 1.0 });
}

TEST(KnotVector, ClampedOrNot)
{
  EXPECT_TRUE(IsClamped(Cubic, 3));
  EXPECT_FALSE(IsClamped(std::vector<double>{ 0, 1, 2, 3, 4, 5, 6 }, 2));
  EXPECT_FALSE(IsClamped(std::vector<double>{ 0, 0, 0, 1, 2, 3 }, 2));
}

TEST(KnotVector, GrevilleAbscissaeReproduceTheParameter)
{
  reference::Random random(3);
  for (int degree = 1; degree <= MaxDegree; ++degree)
  {
    const int count = degree + 4;
    const std::vector<double> knots = random.Knots(degree, count, degree % 2 == 0, false);
    const std::vector<double> greville = GrevilleAbscissae(knots, degree);
    ASSERT_EQ(greville.size(), std::size_t(count));
    EXPECT_TRUE(std::is_sorted(greville.begin(), greville.end()));
    for (int i = 0; i < 10; ++i)
    {
      const double t = random.Parameter(knots, degree);
      const std::vector<reference::Real> N = reference::Bases(knots, degree, t, 0);
      reference::Real sum = 0.0L;
      for (int k = 0; k < count; ++k)
      {
        sum += N[k] * greville[k];
      }
      EXPECT_NEAR(double(sum), t, 1e-13);
    }
  }
}

TEST(KnotVector, UniformKnotsAreSound)
{
  EXPECT_EQ(UniformKnots(2, 4), (std::vector<double>{ 0, 0, 0, 0.5, 1, 1, 1 }));
  EXPECT_EQ(CheckKnots(UniformKnots(25, 60), 25, 60), "");
  EXPECT_THROW(UniformKnots(3, 3), Error);
}
