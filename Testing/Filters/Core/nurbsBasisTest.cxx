// SPDX-License-Identifier: BSD-3-Clause
#include "Basis.h"
#include "nurbsReference.h"

#include <gtest/gtest.h>

using namespace nurbs;

namespace
{

struct Case
{
  int Degree;
  std::vector<double> Knots;
};

/// Every degree, clamped and not, with multiple knots and breaks.
std::vector<Case> Cases()
{
  reference::Random random(11);
  std::vector<Case> cases;
  for (int degree = 0; degree <= MaxDegree; ++degree)
  {
    for (bool clamped : { false, true })
    {
      const int count = degree + 1 + random.Integer(0, 10);
      cases.push_back({ degree, random.Knots(degree, count, clamped, true) });
    }
  }
  return cases;
}

} // namespace

TEST(Basis, IsAPartitionOfUnity)
{
  reference::Random random(12);
  for (const Case& c : Cases())
  {
    for (int i = 0; i < 20; ++i)
    {
      const double t = random.Parameter(c.Knots, c.Degree);
      double ders[3 * (MaxDegree + 1)];
      EvaluateBasisDerivatives(c.Knots, c.Degree, FindSpan(c.Knots, c.Degree, t), t, 2, ders);
      double sum[3] = { 0.0, 0.0, 0.0 };
      double size[3] = { 0.0, 0.0, 0.0 };
      for (int k = 0; k < 3; ++k)
      {
        for (int j = 0; j <= c.Degree; ++j)
        {
          sum[k] += ders[k * (c.Degree + 1) + j];
          size[k] += std::abs(ders[k * (c.Degree + 1) + j]);
        }
      }
      EXPECT_NEAR(sum[0], 1.0, 1e-14);
      EXPECT_NEAR(size[0], 1.0, 1e-14) << "a basis function is negative";
      EXPECT_NEAR(sum[1], 0.0, 1e-14 * size[1]);
      EXPECT_NEAR(sum[2], 0.0, 1e-14 * size[2]);
    }
  }
}

TEST(Basis, AgreesWithTheDefinition)
{
  reference::Random random(13);
  for (const Case& c : Cases())
  {
    for (int i = 0; i < 10; ++i)
    {
      const double t = random.Parameter(c.Knots, c.Degree);
      const int span = FindSpan(c.Knots, c.Degree, t);
      double N[MaxDegree + 1];
      double ders[4 * (MaxDegree + 1)];
      EvaluateBasis(c.Knots, c.Degree, span, t, N);
      EvaluateBasisDerivatives(c.Knots, c.Degree, span, t, 3, ders);
      for (int k = 0; k <= 3; ++k)
      {
        const std::vector<reference::Real> expected = reference::Bases(c.Knots, c.Degree, t, k);
        reference::Real scale = k == 0 ? 1.0L : 0.0L;
        for (reference::Real x : expected)
        {
          scale = std::max(scale, std::abs(x));
        }
        for (int j = 0; j <= c.Degree; ++j)
        {
          const double exact = double(expected[span - c.Degree + j]);
          const double tolerance = 2e-14 * double(scale);
          EXPECT_NEAR(ders[k * (c.Degree + 1) + j], exact, tolerance)
            << "degree " << c.Degree << ", derivative " << k;
          if (k == 0)
          {
            EXPECT_NEAR(N[j], exact, tolerance);
          }
        }
      }
    }
  }
}

TEST(Basis, ReferenceIsTheRecursiveDefinition)
{
  reference::Random random(14);
  const std::vector<double> knots = random.Knots(4, 9, true, true);
  for (int i = 0; i < 20; ++i)
  {
    const double t = random.Parameter(knots, 4);
    const std::vector<reference::Real> N = reference::Bases(knots, 4, t, 0);
    for (int j = 0; j < 9; ++j)
    {
      EXPECT_NEAR(double(N[j]), double(reference::Basis(knots, 4, j, 4, t)), 1e-17);
    }
  }
}

TEST(Basis, DerivativesOverTheDegreeVanish)
{
  const std::vector<double> knots{ 0, 0, 1, 1 };
  double ders[4 * 2];
  std::fill(ders, ders + 8, 7.0);
  EvaluateBasisDerivatives(knots, 1, 1, 0.25, 3, ders);
  const double expected[8] = { 0.75, 0.25, -1.0, 1.0, 0.0, 0.0, 0.0, 0.0 };
  for (int i = 0; i < 8; ++i)
  {
    EXPECT_EQ(ders[i], expected[i]);
  }
}
