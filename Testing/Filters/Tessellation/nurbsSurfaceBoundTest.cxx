// SPDX-License-Identifier: BSD-3-Clause
// Intervals of second derivatives against the derivatives themselves, and what follows from them.
#include "nurbsBoundReference.h"

#include <gtest/gtest.h>

namespace
{

using namespace reference;
using nurbs::SecondDerivatives;
using nurbs::SurfaceBound;

// How far rounding may move a second derivative of coordinates of `size`: differences of
// coefficients over `cell`. Small, as few boxes are as narrow as the narrowest cell that is meant.
double Rounding(double size, int degree, double cell)
{
  return 1e-17 * size * degree * degree * degree / (cell * cell);
}

// Lines at random places, ascending.
std::vector<double> RandomLines(Random& random, double low, double high, int n)
{
  std::vector<double> lines;
  for (int i = 0; i < n; ++i)
  {
    lines.push_back(random.Uniform(low, high));
  }
  std::sort(lines.begin(), lines.end());
  return lines;
}

double Narrowest(const std::vector<double>& lines, nurbs::KnotView knots, double eps)
{
  std::vector<double> all(lines);
  all.insert(all.end(), knots.begin(), knots.end());
  std::sort(all.begin(), all.end());
  double least = all.back() - all.front();
  for (std::size_t i = 0; i + 1 < all.size(); ++i)
  {
    const double gap = all[i + 1] - all[i];
    least = gap > eps ? std::min(least, gap) : least;
  }
  return least;
}

// By how much of its own size the sampled second derivative leaves its interval; negative: inside.
struct Containment
{
  double Worst = -1e300;
  int Samples = 0;
  void Add(const SecondDerivatives& second, const nurbs::SurfaceDerivatives& d, double slack)
  {
    const Vec3 values[3] = { d.Suu, d.Suv, d.Svv };
    for (int k = 0; k < 3; ++k)
    {
      const Vec3 beyond = (values[k] - second.Center[k]).cwiseAbs() - second.Radius[k];
      this->Worst = std::max(this->Worst, beyond.maxCoeff() / slack);
    }
    ++this->Samples;
  }
};

TEST(SurfaceBound, ContainsSecondDerivatives)
{
  Random random(20);
  Containment contained;
  std::vector<double> ratios;
  int boxes = 0;
  for (int k = 0; k < 240; ++k)
  {
    const int p = 1 + k % 6;
    const int q = 1 + (k / 6) % 6;
    const double far = k % 4 == 3 ? 1000.0 : 0.0;
    const nurbs::Surface surface =
      WildSurface(random, p, q, k % 3 != 0, Vec3(far, -2.0 * far, far));
    const nurbs::SurfaceView view = surface.View();
    const ParameterBox domain = DomainOf(view);
    SurfaceBound bound(view, domain);
    const int lines = k % 5 == 0 ? 0 : k % 5 == 1 ? 40 : random.Integer(1, 12);
    const std::vector<double> us = RandomLines(random, domain.U0, domain.U1, lines);
    const std::vector<double> vs = RandomLines(random, domain.V0, domain.V1, lines);
    bound.MakeGrid(us, vs, nurbs::SerialFor);
    const double size = bound.Size() + 3.0 * far;
    const double cell = std::min(Narrowest(us, view.Knots[0], 1e-6 * domain.A()),
      Narrowest(vs, view.Knots[1], 1e-6 * domain.B()));
    // 25 is the largest ratio of weights: a quotient's coefficients are that much larger.
    const double slack = 25.0 * Rounding(size, std::max(p, q), cell);
    for (int b = 0; b < 6; ++b, ++boxes)
    {
      const double share = std::exp(random.Uniform(std::log(0.003), 0.0));
      const double a = share * domain.A();
      const double c = std::min(1.0, share * random.Uniform(0.3, 3.0)) * domain.B();
      const double u0 = random.Uniform(domain.U0, domain.U1 - a);
      const double v0 = random.Uniform(domain.V0, domain.V1 - c);
      ParameterBox box{ u0, u0 + a, v0, v0 + c };
      const bool cellOfGrid = lines > 1 && b % 2 == 1;
      if (cellOfGrid)
      {
        const int i = random.Integer(0, lines - 2);
        const int j = random.Integer(0, lines - 2);
        box = { us[i], us[i + 1], vs[j], vs[j + 1] };
      }
      const SecondDerivatives second = bound.Over(box);
      double most = 1e-300;
      constexpr int Grid = 6;
      for (int i = 0; i <= Grid; ++i)
      {
        for (int j = 0; j <= Grid; ++j)
        {
          // What a box touches by less than a millionth does not count.
          const double s = 2e-6 + (1.0 - 4e-6) * i / Grid;
          const double t = 2e-6 + (1.0 - 4e-6) * j / Grid;
          const nurbs::SurfaceDerivatives d =
            nurbs::EvaluateDerivatives(view, box.U0 + box.A() * s, box.V0 + box.B() * t, 2);
          contained.Add(second, d, slack);
          most = std::max({ most, d.Suu.norm(), d.Svv.norm(), d.Suv.norm() });
        }
      }
      if (lines == 40 && cellOfGrid)
      {
        ratios.push_back(
          std::max({ second.Greatest(0), second.Greatest(1), second.Greatest(2) }) / most);
      }
    }
  }
  std::sort(ratios.begin(), ratios.end());
  const double median = ratios[ratios.size() / 2];
  std::printf(
    "%d boxes, %d samples: outside by %.3g of what rounding may do; over cells of 40 lines "
    "bounds are %.2f of the sampled greatest (median), 90 %% at most %.2f\n",
    boxes, contained.Samples, contained.Worst, median, ratios[ratios.size() * 9 / 10]);
  EXPECT_LE(contained.Worst, 1.0);
  EXPECT_LT(median, 1.5);
}

// Intervals over boxes of 1/20 of a quarter between lines of the grid, against the sampled range.
struct Tightness
{
  double Excess = 0.0; ///< Over the magnitude of the derivatives: at worst,
  double Mean = 0.0;   ///< on average over the boxes, of each the worst coordinate,
  double Bow = 0.0;    ///< and of the bow off the plane that it means.
  double Twist = 0.0;  ///< Greatest S_uv of an interval over the greatest derivative.
};

Tightness MeasureTightness(
  const nurbs::Surface& surface, double quarterU, double quarterV, int pieces)
{
  const nurbs::SurfaceView view = surface.View();
  const ParameterBox domain = DomainOf(view);
  SurfaceBound bound(view, domain);
  const int nu = int(std::lround(domain.A() / quarterU)) * pieces;
  const int nv = int(std::lround(domain.B() / quarterV)) * pieces;
  const std::vector<double> us = Steps(domain.U0, domain.U1, nu);
  const std::vector<double> vs = Steps(domain.V0, domain.V1, nv);
  bound.MakeGrid(us, vs, nurbs::SerialFor);
  Random random(3);
  Tightness out;
  constexpr int Boxes = 150;
  for (int b = 0; b < Boxes; ++b)
  {
    const int i = random.Integer(0, nu - 1);
    const int j = random.Integer(0, nv - 1);
    const ParameterBox box{ us[i], us[i + 1], vs[j], vs[j + 1] };
    const SecondDerivatives second = bound.Over(box);
    double most[3] = { 0.0, 0.0, 0.0 };
    double across[3] = { 0.0, 0.0, 0.0 };
    const Vec3 normal = nurbs::Normal(view, 0.5 * (box.U0 + box.U1), 0.5 * (box.V0 + box.V1));
    Vec3 low[3];
    Vec3 high[3];
    for (int k = 0; k < 3; ++k)
    {
      low[k].setConstant(1e300);
      high[k].setConstant(-1e300);
    }
    constexpr int Grid = 12;
    for (int k = 0; k < (Grid + 1) * (Grid + 1); ++k)
    {
      const double u = box.U0 + box.A() * (1e-9 + (1.0 - 2e-9) * (k % (Grid + 1)) / Grid);
      const double v = box.V0 + box.B() * (1e-9 + (1.0 - 2e-9) * (k / (Grid + 1)) / Grid);
      const nurbs::SurfaceDerivatives d = nurbs::EvaluateDerivatives(view, u, v, 2);
      const Vec3 values[3] = { d.Suu, d.Suv, d.Svv };
      for (int x = 0; x < 3; ++x)
      {
        low[x] = low[x].cwiseMin(values[x]);
        high[x] = high[x].cwiseMax(values[x]);
        most[x] = std::max(most[x], values[x].norm());
        across[x] = std::max(across[x], std::abs(normal.dot(values[x])));
      }
    }
    const double bow = 0.125 *
      (box.A() * box.A() * across[0] + 2.0 * box.A() * box.B() * across[1] +
        box.B() * box.B() * across[2]);
    const double scale = std::max({ most[0], most[1], most[2] });
    double excess = 0.0;
    for (int k = 0; k < 3; ++k)
    {
      const Vec3 above = second.Center[k] + second.Radius[k] - high[k];
      const Vec3 below = low[k] - (second.Center[k] - second.Radius[k]);
      excess = std::max({ excess, above.maxCoeff() / scale, below.maxCoeff() / scale });
    }
    out.Excess = std::max(out.Excess, excess);
    out.Mean += excess / Boxes;
    out.Bow = std::max(out.Bow, second.Bow(box.A(), box.B(), normal) / bow - 1.0);
    out.Twist = std::max(out.Twist, second.Greatest(1) / scale);
  }
  return out;
}

TEST(SurfaceBound, IsTightOnCadShapes)
{
  const nurbs::Surface shapes[3] = { Cylinder(10.0, 31.4), Sphere(10.0), Torus(10.0, 3.0) };
  const double quarterV[3] = { 1.0, 0.5, 0.25 };
  for (int k = 0; k < 3; ++k)
  {
    const Tightness t = MeasureTightness(shapes[k], 0.25, quarterV[k], 20);
    const Tightness half = MeasureTightness(shapes[k], 0.25, quarterV[k], 40);
    std::printf("%s: excess at worst %.4f, on average %.4f, of the bow %.4f; S_uv %.2g; with twice "
                "as many lines %.4f, %.4f, %.4f\n",
      k == 0     ? "cylinder"
        : k == 1 ? "sphere"
                 : "torus",
      t.Excess, t.Mean, t.Bow, t.Twist, half.Excess, half.Mean, half.Bow);
    EXPECT_LT(t.Mean, 0.05);
    EXPECT_LT(t.Bow, 0.16); // Coordinates' intervals add up along a slanting normal.
    EXPECT_LT(half.Bow, 0.6 * t.Bow);
    EXPECT_LT(t.Excess, 0.08); // Two boxes' worth of the third derivative.
    EXPECT_LT(half.Excess, 0.6 * t.Excess);
    if (k == 0)
    {
      EXPECT_LT(t.Twist, 1e-12);
    }
  }
}

std::vector<double> CreasesOf(const nurbs::Surface& surface, int dir)
{
  const nurbs::SurfaceView view = surface.View();
  return SurfaceBound(view, DomainOf(view)).Creases(dir);
}

// Degree 2 in u with a double knot at 1 of [0, 2], degree 3 in v; the middle row of the second
// half is where C1 wants it but for `kink(j)` upwards. Weights are not C1, which does not matter.
nurbs::Surface JoinedPatches(
  const std::function<double(int)>& kink, double stretch, int spansV, bool rational)
{
  nurbs::Surface s;
  s.Degree[0] = 2;
  s.Degree[1] = 3;
  s.Count[0] = 5;
  s.Count[1] = 3 + spansV;
  s.Knots[0] = { 0, 0, 0, 1, 1, 2, 2, 2 };
  s.Knots[1] = { 0, 0, 0, 0 };
  for (int k = 1; k < spansV; ++k)
  {
    s.Knots[1].push_back(k);
  }
  s.Knots[1].insert(s.Knots[1].end(), 4, spansV);
  for (int j = 0; j < s.Count[1]; ++j)
  {
    const Vec3 before(1.0, j, 0.3 * std::sin(j));
    const Vec3 on(2.0, j, 0.4 * std::cos(j));
    Vec3 after = on + stretch * (on - before);
    after[2] += kink(j);
    s.Points.insert(
      s.Points.end(), { Vec3(0.0, j, 0.1), before, on, after, Vec3(4.0, j, 0.2 * j) });
    if (rational)
    {
      const double w = std::sqrt(0.5);
      s.Weights.insert(s.Weights.end(), { 1.0, w, 0.7, w, 1.0 });
    }
  }
  return s;
}

TEST(SurfaceBound, FindsCreases)
{
  for (int dir = 0; dir < 2; ++dir)
  {
    EXPECT_TRUE(CreasesOf(Cylinder(2.0, 1.0), dir).empty());
    EXPECT_TRUE(CreasesOf(Sphere(2.0), dir).empty());
    EXPECT_TRUE(CreasesOf(Torus(5.0, 2.0), dir).empty());
    EXPECT_TRUE(CreasesOf(Cone(5.0, 2.0), dir).empty());
    EXPECT_TRUE(CreasesOf(Moved(Torus(5.0, 2.0), Vec3(1e4, -3e4, 2e4)), dir).empty());
  }
  // A polyline swept in v.
  const nurbs::Surface zigzag = Revolve(
    1, { 0, 0, 0.2, 0.5, 1, 1 }, { { 1, 0 }, { 2, 0.3 }, { 1, 0.4 }, { 3, 1 } }, { 1, 1, 1, 1 });
  EXPECT_EQ(CreasesOf(zigzag, 1), (std::vector<double>{ 0.2, 0.5 }));
  EXPECT_TRUE(CreasesOf(zigzag, 0).empty());
  // One whose two parts continue each other is smooth.
  const nurbs::Surface straight =
    Revolve(1, { 0, 0, 0.25, 1, 1 }, { { 1, 0 }, { 2, 1 }, { 5, 4 } }, { 1, 1, 1 });
  EXPECT_TRUE(CreasesOf(straight, 1).empty());
  for (const bool rational : { false, true })
  {
    const auto creases = [&](const std::function<double(int)>& kink, double stretch) {
      return CreasesOf(JoinedPatches(kink, stretch, 4, rational), 0).size();
    };
    EXPECT_EQ(creases([](int) { return 0.0; }, 1.0), 0u);
    EXPECT_EQ(creases([](int) { return 0.1; }, 1.0), 1u);
    // Kinked along the first, a middle, the last span only, and hardly at all.
    EXPECT_EQ(creases([](int j) { return j == 0 ? 0.1 : 0.0; }, 1.0), 1u);
    EXPECT_EQ(creases([](int j) { return j == 3 ? -0.1 : 0.0; }, 1.0), 1u);
    EXPECT_EQ(creases([](int j) { return j == 6 ? 1e-6 : 0.0; }, 1.0), 1u);
    // Directions agree, speeds do not: parameters across the join have no second derivative.
    EXPECT_EQ(creases([](int) { return 0.0; }, 1.5), 1u);
  }
}

TEST(SurfaceBound, KnowsWhatCrossesCreases)
{
  const nurbs::Surface s = JoinedPatches([](int) { return 0.3; }, 1.0, 3, false);
  const nurbs::SurfaceView view = s.View();
  const SurfaceBound bound(view, DomainOf(view));
  EXPECT_TRUE(bound.CrossesCrease({ 0.9, 1.1, 0.0, 1.0 }));
  EXPECT_TRUE(bound.CrossesCrease({ 0.0, 1.01, 0.0, 1.0 }));
  EXPECT_FALSE(bound.CrossesCrease({ 0.9, 1.0, 0.0, 1.0 }));
  EXPECT_FALSE(bound.CrossesCrease({ 1.0, 1.2, 0.0, 3.0 }));
  EXPECT_FALSE(bound.CrossesCrease({ 0.9, 1.0 + 1e-8, 0.0, 1.0 }));
  EXPECT_FALSE(bound.CrossesCrease({ 1.2, 1.9, 0.0, 3.0 }));
}

// S less its linear interpolation, in any direction, and less the bilinear one of the box without
// the mixed term.
TEST(SurfaceBound, BowHoldsForTrianglesOfTheBox)
{
  Random random(33);
  double worst = 0.0;
  double worstAlong = 0.0;
  double worstBilinear = 0.0;
  double best = 1e300;
  int triangles = 0;
  for (int k = 0; k < 120; ++k)
  {
    nurbs::Surface surface =
      WildSurface(random, 1 + k % 6, 1 + (k / 6) % 6, k % 2 == 0, Vec3(0.0, 0.0, 0.0));
    surface = k % 8 == 7 ? Torus(4.0, 1.0) : k % 8 == 6 ? Sphere(2.0) : surface;
    const nurbs::SurfaceView view = surface.View();
    const ParameterBox domain = DomainOf(view);
    SurfaceBound bound(view, domain);
    bound.MakeGrid(
      Steps(domain.U0, domain.U1, 8), Steps(domain.V0, domain.V1, 8), nurbs::SerialFor);
    for (int b = 0; b < 20; ++b)
    {
      const double a = domain.A() * std::exp(random.Uniform(std::log(0.01), std::log(0.6)));
      const double c = domain.B() * std::exp(random.Uniform(std::log(0.01), std::log(0.6)));
      const double u0 = random.Uniform(domain.U0, domain.U1 - a);
      const double v0 = random.Uniform(domain.V0, domain.V1 - c);
      const ParameterBox box{ u0, u0 + a, v0, v0 + c };
      if (bound.CrossesCrease(box))
      {
        continue;
      }
      const SecondDerivatives second = bound.Over(box);
      const Vec3 d = Vec3(random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1));
      const auto at = [&](double s, double t) {
        return nurbs::Evaluate(view, u0 + a * s, v0 + c * t);
      };
      const Vec3 corner[4] = { at(0, 0), at(1, 0), at(0, 1), at(1, 1) };
      // Corners of the box, or anywhere in it.
      Vec2 p[3] = { Vec2(0, 0), Vec2(1, 0), Vec2(b % 4 == 1 ? 0 : 1, 1) };
      if (b % 4 > 1)
      {
        for (Vec2& x : p)
        {
          x = Vec2(random.Uniform(0, 1), random.Uniform(0, 1));
        }
      }
      const Vec3 x[3] = { at(p[0][0], p[0][1]), at(p[1][0], p[1][1]), at(p[2][0], p[2][1]) };
      double whole = 0.0;
      double along = 0.0;
      double bilinear = 0.0;
      Barycentric(12, [&](double b0, double b1, double b2) {
        const Vec2 st = b0 * p[0] + b1 * p[1] + b2 * p[2];
        const Vec3 s = at(st[0], st[1]);
        const Vec3 off = s - b0 * x[0] - b1 * x[1] - b2 * x[2];
        whole = std::max(whole, off.norm());
        along = std::max(along, std::abs(off.dot(d)));
        const Vec3 twisted = (1 - st[1]) * ((1 - st[0]) * corner[0] + st[0] * corner[1]) +
          st[1] * ((1 - st[0]) * corner[2] + st[0] * corner[3]);
        bilinear = std::max(bilinear, std::abs((s - twisted).dot(d)));
      });
      const double none = 1e-12;
      worst = std::max(worst, (whole - none) / (second.Bow(a, c) + 1e-300));
      worstAlong = std::max(worstAlong, (along - none) / (second.Bow(a, c, d) + 1e-300));
      worstBilinear =
        std::max(worstBilinear, (bilinear - none) / (second.Bow(a, c, d, false) + 1e-300));
      best = std::min(best, second.Bow(a, c) / (whole + 1e-300));
      ++triangles;
    }
  }
  std::printf("%d triangles: off the linear interpolation by %.4f of the bound, in a direction "
              "%.4f, off the bilinear one %.4f\n",
    triangles, worst, worstAlong, worstBilinear);
  EXPECT_GT(triangles, 1000);
  EXPECT_LE(worst, 1.0);
  EXPECT_LE(worstAlong, 1.0);
  EXPECT_LE(worstBilinear, 1.0);
  EXPECT_GT(worst, 0.9); // The bound is attained.
}

} // namespace
