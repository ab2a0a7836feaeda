// SPDX-License-Identifier: BSD-3-Clause
// Polynomials in Bernstein form against their definitions, and the contour function against the
// derivatives of the surface.
#include "nurbsSilhouetteReference.h"

#include <gtest/gtest.h>

using namespace reference;

namespace
{

// Coefficients of the product of two univariate polynomials.
std::vector<double> Product(const std::vector<double>& a, const std::vector<double>& b)
{
  const int m = int(a.size()) - 1;
  const int n = int(b.size()) - 1;
  const std::vector<double> bm = nurbs::Binomials(m);
  const std::vector<double> bn = nurbs::Binomials(n);
  const std::vector<double> all = nurbs::Binomials(m + n);
  std::vector<double> out(m + n + 1, 0.0);
  for (int i = 0; i <= m; ++i)
  {
    for (int j = 0; j <= n; ++j)
    {
      out[i + j] += a[i] * bm[i] * b[j] * bn[j] / all[i + j];
    }
  }
  return out;
}

// The sum that defines it.
double Definition(const nurbs::BernsteinForm& form, double u, double v)
{
  const std::vector<double> bu = nurbs::Binomials(form.Degree[0]);
  const std::vector<double> bv = nurbs::Binomials(form.Degree[1]);
  double sum = 0.0;
  for (int j = 0; j <= form.Degree[1]; ++j)
  {
    for (int i = 0; i <= form.Degree[0]; ++i)
    {
      sum += form.At(i, j) * bu[i] * std::pow(u, i) * std::pow(1.0 - u, form.Degree[0] - i) *
        bv[j] * std::pow(v, j) * std::pow(1.0 - v, form.Degree[1] - j);
    }
  }
  return sum;
}

nurbs::BernsteinForm RandomForm(std::mt19937& random, int m, int n)
{
  std::uniform_real_distribution<double> real(-1.0, 1.0);
  nurbs::BernsteinForm form;
  form.Degree[0] = m;
  form.Degree[1] = n;
  for (int k = 0; k < (m + 1) * (n + 1); ++k)
  {
    form.Coefficients.push_back(real(random));
  }
  return form;
}

TEST(BernsteinForm, FindsEverySignChange)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> real(0.0, 1.0);
  for (int k = 0; k < 300; ++k)
  {
    // Roots at least 0.02 apart, so that they are known to rounding; factors without a root and
    // double roots between them.
    std::vector<double> roots;
    std::vector<double> c{ real(random) < 0.5 ? -1.0 : 1.0 };
    for (double t = 0.05 + 0.2 * real(random); t < 0.99; t += 0.02 + 0.3 * real(random))
    {
      roots.push_back(t);
      c = Product(c, { -t, 1.0 - t });
    }
    if (k % 2)
    {
      c = Product(c, { 1.0, real(random) - 0.9, 1.0 });
    }
    if (k % 3 == 0)
    {
      const double twice = 1.5; // Beyond the domain.
      c = Product(Product(c, { -twice, 1.0 - twice }), { -twice, 1.0 - twice });
    }
    const std::vector<double> found = nurbs::SignChanges(c);
    ASSERT_EQ(found.size(), roots.size()) << k;
    for (std::size_t i = 0; i < roots.size(); ++i)
    {
      EXPECT_NEAR(found[i], roots[i], 1e-9) << k;
    }
  }
}

TEST(BernsteinForm, DoubleRootsAreNone)
{
  // (t - 1/2)^2, exactly, and (t - 1/4)^2 (t - 3/4).
  EXPECT_TRUE(nurbs::SignChanges({ 0.25, -0.25, 0.25 }).empty());
  const std::vector<double> twice = Product({ -0.25, 0.75 }, { -0.25, 0.75 });
  const std::vector<double> roots = nurbs::SignChanges(Product(twice, { -0.75, 0.25 }));
  ASSERT_EQ(roots.size() % 2, 1u);
  EXPECT_NEAR(roots.back(), 0.75, 1e-12);
}

TEST(BernsteinForm, SplitsEvaluatesAndDivides)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> real(0.0, 1.0);
  for (int k = 0; k < 100; ++k)
  {
    const nurbs::BernsteinForm form = RandomForm(random, 1 + k % 7, 1 + k / 7 % 9);
    const int dir = k % 2;
    const double t = 0.1 + 0.8 * real(random);
    nurbs::BernsteinForm low, high;
    nurbs::Split(form, dir, t, low, high);
    const double s[2] = { real(random), real(random) };
    double at[2] = { s[0], s[1] };
    EXPECT_NEAR(form.Evaluate(at[0], at[1]), Definition(form, at[0], at[1]), 1e-13);
    at[dir] = t * s[dir];
    EXPECT_NEAR(low.Evaluate(s[0], s[1]), Definition(form, at[0], at[1]), 1e-13);
    at[dir] = t + (1.0 - t) * s[dir];
    EXPECT_NEAR(high.Evaluate(s[0], s[1]), Definition(form, at[0], at[1]), 1e-13);
    EXPECT_EQ(low.OnLine(dir, 1.0), high.OnLine(dir, 0.0));
    // Times u, 1 - u, v or 1 - v, and divided by it again.
    const int end = k / 2 % 2;
    nurbs::BernsteinForm product;
    product.Degree[dir] = form.Degree[dir] + 1;
    product.Degree[1 - dir] = form.Degree[1 - dir];
    for (int j = 0; j <= product.Degree[1]; ++j)
    {
      for (int i = 0; i <= product.Degree[0]; ++i)
      {
        const int n = product.Degree[dir];
        const int index = dir == 0 ? i : j;
        const int from = end == 0 ? index - 1 : index;
        const double share = end == 0 ? double(index) / n : double(n - index) / n;
        product.Coefficients.push_back(
          from < 0 || from == n ? 0.0 : share * (dir == 0 ? form.At(from, j) : form.At(i, from)));
      }
    }
    product.DivideBySide(dir, end);
    ASSERT_EQ(product.Coefficients.size(), form.Coefficients.size());
    for (std::size_t i = 0; i < form.Coefficients.size(); ++i)
    {
      EXPECT_NEAR(product.Coefficients[i], form.Coefficients[i], 1e-14);
    }
  }
}

// g p q = w^3 (S_u x S_v) . V of the surface's own derivatives, its degrees, and the derivatives of
// normal . view against differences.
TEST(ContourForm, IsNormalTimesView)
{
  std::mt19937 random(11);
  std::uniform_real_distribution<double> real(-1.0, 1.0);
  for (int k = 0; k < 200; ++k)
  {
    const int p = 1 + k % 5;
    const int q = 1 + k / 5 % 4;
    const bool rational = k % 2 == 1;
    nurbs::Surface s = BezierSurface(p, q, [&](double u, double v) {
      return Vec3(20.0 + u + 0.3 * real(random), v + 0.3 * real(random), real(random));
    });
    for (std::size_t i = 0; rational && i < s.Points.size(); ++i)
    {
      s.Weights.push_back(std::exp(real(random)));
    }
    const Viewer viewer = k % 4 < 2 ? Direction(real(random), real(random), real(random))
                                    : Eye(20.0 + real(random), real(random), 3.0);
    const nurbs::BezierPatch patch = nurbs::ToBezier(s.View()).front();
    const nurbs::ContourForm form = nurbs::MakeContourForm(patch, viewer);
    const bool planar = !rational && !viewer.Perspective;
    EXPECT_EQ(form.G.Degree[0], planar ? 2 * p - 1 : 3 * p - 2);
    EXPECT_EQ(form.G.Degree[1], planar ? 2 * q - 1 : 3 * q - 2);
    for (int i = 0; i < 20; ++i)
    {
      const double u = 0.5 + 0.5 * real(random);
      const double v = 0.5 + 0.5 * real(random);
      const nurbs::SurfaceDerivatives d = nurbs::EvaluateDerivatives(s.View(), u, v, 1);
      double w = 1.0;
      if (rational)
      {
        nurbs::Surface weights = s;
        for (std::size_t n = 0; n < s.Points.size(); ++n)
        {
          weights.Points[n] = Vec3(s.Weights[n], 0.0, 0.0);
        }
        weights.Weights.clear();
        w = nurbs::Evaluate(weights.View(), u, v)[0];
      }
      const double expected = w * w * w * d.Su.cross(d.Sv).dot(viewer.Toward(d.S));
      EXPECT_NEAR(form.G.Evaluate(u, v) * p * q, expected, 1e-12 * form.Scale * p * q) << k;
      EXPECT_LE(std::abs(form.G.Evaluate(u, v)), 10.0 * form.Scale);
      const nurbs::ContourValue value = nurbs::EvaluateContour(patch, viewer, u, v);
      EXPECT_NEAR(value.Cosine, Cosine(s.View(), viewer, Vec2(u, v)), 1e-9);
      EXPECT_LT((value.Point - d.S).norm(), 1e-13);
    }
  }
}

// Of a sphere's patch, at the contour.
TEST(ContourForm, GradientIsThatOfTheCosine)
{
  nurbs::Surface s = BezierSurface(
    3, 3, [](double u, double v) { return Vec3(u, v, std::sin(2.0 * u) * std::cos(v)); });
  const nurbs::BezierPatch patch = nurbs::ToBezier(s.View()).front();
  for (const Viewer& viewer : { Direction(1.0, 0.2, 0.5), Eye(4.0, 1.0, 2.0) })
  {
    int tested = 0;
    for (int k = 0; k < 50; ++k)
    {
      // On the line v = t, by bisection.
      const double t = (k + 0.5) / 50;
      double low = 0.0, high = 1.0;
      const auto cosine = [&](double u) { return EvaluateContour(patch, viewer, u, t).Cosine; };
      if (cosine(low) * cosine(high) > 0.0)
      {
        continue;
      }
      const bool negative = cosine(low) < 0.0;
      for (int i = 0; i < 60; ++i)
      {
        const double middle = 0.5 * (low + high);
        ((cosine(middle) < 0.0) == negative ? low : high) = middle;
      }
      const Vec2 gradient = EvaluateContour(patch, viewer, low, t).Gradient;
      const double h = 1e-5;
      EXPECT_NEAR(gradient[0], (cosine(low + h) - cosine(low - h)) / (2.0 * h), 1e-6);
      EXPECT_NEAR(gradient[1],
        (EvaluateContour(patch, viewer, low, t + h).Cosine -
          EvaluateContour(patch, viewer, low, t - h).Cosine) /
          (2.0 * h),
        1e-6);
      ++tested;
    }
    EXPECT_GT(tested, 10);
  }
}

} // namespace
