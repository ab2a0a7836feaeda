// SPDX-License-Identifier: BSD-3-Clause
// The free-form lattice against the formula of Sederberg and Parry 1986 written out with absolute
// control points, Bernstein polynomials by their binomials, B-splines by their recursion; against
// closed forms (affine maps, a twist, a parabola); and at the border of its box.
#include "FreeFormLattice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <thread>

namespace
{

using nurbs::Box3;
using nurbs::FreeFormLattice;
using nurbs::LatticeBox;
using nurbs::Vec3;
using Counts = std::array<int, 3>;
using Points = std::vector<Vec3>;

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();
constexpr double Infinity = std::numeric_limits<double>::infinity();

// Knot i of a clamped uniform vector over [0, 1].
double KnotAt(int i, int degree, int count)
{
  return std::clamp(double(i - degree) / (count - degree), 0.0, 1.0);
}

// The Cox-de Boor recursion as it is defined; the last span is closed.
double BasisAt(int i, int p, double t, int degree, int count)
{
  const auto knot = [&](int k) { return KnotAt(k, degree, count); };
  if (p == 0)
  {
    const bool last = t == 1.0 && knot(i) < 1.0 && knot(i + 1) == 1.0;
    return (knot(i) <= t && t < knot(i + 1)) || last ? 1.0 : 0.0;
  }
  double value = 0.0;
  if (knot(i) < knot(i + p))
  {
    value += (t - knot(i)) / (knot(i + p) - knot(i)) * BasisAt(i, p - 1, t, degree, count);
  }
  if (knot(i + 1) < knot(i + p + 1))
  {
    value += (knot(i + p + 1) - t) / (knot(i + p + 1) - knot(i + 1)) *
      BasisAt(i + 1, p - 1, t, degree, count);
  }
  return value;
}

double Bernstein(int i, int n, double t)
{
  double value = 1.0;
  for (int k = 1; k <= i; ++k)
  {
    value *= double(n - i + k) / k;
  }
  return value * std::pow(t, i) * std::pow(1.0 - t, n - i);
}

double Greville(int i, int degree, int count)
{
  double sum = 0.0;
  for (int k = 1; k <= degree; ++k)
  {
    sum += KnotAt(i + k, degree, count);
  }
  return sum / degree;
}

// All control points, in their places, times all functions.
Vec3 Reference(const FreeFormLattice& lattice, const Vec3& local)
{
  const auto value = [&](int axis, int i) {
    const int p = lattice.Degree(axis), n = lattice.Count(axis);
    return p == n - 1 ? Bernstein(i, p, local[axis]) : BasisAt(i, p, local[axis], p, n);
  };
  Vec3 sum = Vec3::Zero();
  for (std::int64_t index = 0; index < lattice.Size(); ++index)
  {
    const int l = lattice.Count(0), m = lattice.Count(1);
    const double weight =
      value(0, index % l) * value(1, index / l % m) * value(2, int(index / l / m));
    sum += weight * (lattice.RestPoint(index) + lattice.Displacement(index));
  }
  return sum;
}

LatticeBox OrientedBox()
{
  LatticeBox box;
  box.Origin = Vec3(3.0, -1.0, 7.0);
  box.Axes << 2.0, 0.3, -0.2, -0.5, 1.5, 0.4, 0.1, -0.3, 4.0;
  return box;
}

LatticeBox UnitBox()
{
  return LatticeBox::Of(Box3(Vec3::Zero(), Vec3::Ones()));
}

class Numbers
{
public:
  explicit Numbers(unsigned int seed)
    : Random(seed)
  {}
  double In(double low, double high)
  {
    return std::uniform_real_distribution<double>(low, high)(this->Random);
  }
  Vec3 Vector(double low, double high)
  {
    const double x = this->In(low, high), y = this->In(low, high);
    return Vec3(x, y, this->In(low, high));
  }

private:
  std::mt19937 Random;
};

// Displaces every control point by shift(rest place).
template <class F>
void Displace(FreeFormLattice& lattice, F shift, int frozen = 0)
{
  std::vector<double> xyz;
  for (std::int64_t n = 0; n < lattice.Size(); ++n)
  {
    const Vec3 d = shift(lattice.RestPoint(n));
    xyz.insert(xyz.end(), d.data(), d.data() + 3);
  }
  lattice.SetDisplacements(xyz, frozen);
}

void DisplaceOne(FreeFormLattice& lattice, std::int64_t index, const Vec3& by)
{
  std::vector<double> xyz(3 * lattice.Size(), 0.0);
  std::copy_n(by.data(), 3, xyz.begin() + 3 * index);
  lattice.SetDisplacements(xyz);
}

struct Case
{
  Counts Count, Degree;
};

const Case Cases[] = { { { { 4, 4, 4 } }, { { 0, 0, 0 } } }, { { { 2, 3, 5 } }, { { 0, 0, 0 } } },
  { { { 7, 4, 9 } }, { { 0, 2, 5 } } }, { { { 6, 5, 4 } }, { { 5, 4, 3 } } },
  { { { 32, 8, 2 } }, { { 1, 3, 1 } } }, { { { 26, 3, 3 } }, { { 25, 25, 25 } } },
  { { { 10, 10, 10 } }, { { 3, 3, 3 } } } };

TEST(FreeFormLattice, DegreesAreLoweredToTheCounts)
{
  const FreeFormLattice few(UnitBox(), { { 2, 3, 32 } });
  EXPECT_EQ(few.Degree(0), 1);
  EXPECT_EQ(few.Degree(1), 2);
  EXPECT_EQ(few.Degree(2), 3);
  const FreeFormLattice high(UnitBox(), { { 4, 26, 32 } }, { { 9, 40, 40 } });
  EXPECT_EQ(high.Degree(0), 3);
  EXPECT_EQ(high.Degree(1), 25);
  EXPECT_EQ(high.Degree(2), 25);
  EXPECT_EQ(high.Size(), 4 * 26 * 32);
}

TEST(FreeFormLattice, RestIsAtTheGrevilleAbscissae)
{
  const FreeFormLattice lattice(UnitBox(), { { 7, 4, 9 } }, { { 0, 3, 5 } });
  for (std::int64_t n = 0; n < lattice.Size(); ++n)
  {
    const Vec3 expected(
      Greville(n % 7, 3, 7), double(n / 7 % 4) / 3.0, Greville(int(n / 28), 5, 9));
    EXPECT_LE((lattice.RestPoint(n) - expected).norm(), 1e-15) << n;
  }
}

TEST(FreeFormLattice, AtRestNoBitChanges)
{
  Numbers random(1);
  for (const Case& c : Cases)
  {
    FreeFormLattice lattice(OrientedBox(), c.Count, c.Degree);
    Displace(lattice, [](const Vec3&) { return Vec3(0.0, 0.0, 0.0); });
    for (int n = 0; n < 200; ++n)
    {
      const Vec3 x = OrientedBox().Origin + OrientedBox().Axes * random.Vector(-0.2, 1.2);
      EXPECT_EQ(lattice.Map(x), x);
    }
  }
}

// The sum of the absolute control points at rest: the linear precision that the displacements' form
// builds on.
TEST(FreeFormLattice, RestReproducesPoints)
{
  Numbers random(2);
  for (const Case& c : Cases)
  {
    const FreeFormLattice lattice(OrientedBox(), c.Count, c.Degree);
    for (int n = 0; n < 20; ++n)
    {
      const Vec3 local = random.Vector(0.0, 1.0);
      const Vec3 x = OrientedBox().Origin + OrientedBox().Axes * local;
      EXPECT_LE((lattice.LocalCoordinates(x) - local).norm(), 1e-14);
      EXPECT_LE((Reference(lattice, local) - x).norm(), 1e-14 * x.norm());
    }
  }
}

TEST(FreeFormLattice, EqualsTheFormula)
{
  Numbers random(3);
  double worst = 0.0;
  for (const Case& c : Cases)
  {
    FreeFormLattice lattice(OrientedBox(), c.Count, c.Degree);
    Displace(lattice, [&](const Vec3&) { return random.Vector(-1.0, 1.0); });
    for (int n = 0; n < 60; ++n)
    {
      Vec3 local = random.Vector(0.0, 1.0);
      if (n < 8) // the corners
      {
        local = Vec3(n & 1, n >> 1 & 1, n >> 2);
      }
      const Vec3 x = OrientedBox().Origin + OrientedBox().Axes * local;
      worst = std::max(worst, (lattice.Map(x) - Reference(lattice, local)).norm());
    }
  }
  EXPECT_LE(worst, 3e-14); // of a size of 10
}

TEST(FreeFormLattice, AffineMapsAreReproduced)
{
  Numbers random(4);
  Eigen::Matrix3d linear;
  linear << 0.3, -1.2, 0.5, 1.1, 0.2, -0.4, 0.6, 0.9, -1.5;
  const Vec3 shift(2.0, -3.0, 0.5);
  for (const Case& c : Cases)
  {
    FreeFormLattice lattice(OrientedBox(), c.Count, c.Degree);
    Displace(lattice, [&](const Vec3& rest) { return Vec3(linear * rest + shift - rest); });
    for (int n = 0; n < 100; ++n)
    {
      const Vec3 x = OrientedBox().Origin + OrientedBox().Axes * random.Vector(0.0, 1.0);
      EXPECT_LE((lattice.Map(x) - (linear * x + shift)).norm(), 1e-13); // of 20
    }
  }
}

// Displacements that are linear in each variable are reproduced from the rest places' own, too.
TEST(FreeFormLattice, TwistIsReproduced)
{
  const LatticeBox box = LatticeBox::Of(Box3(Vec3(-1.0, -1.0, 0.0), Vec3(1.0, 1.0, 5.0)));
  FreeFormLattice lattice(box, { { 4, 5, 12 } });
  const auto twist = [](const Vec3& x) { return Vec3(-0.4 * x[2] * x[1], 0.4 * x[2] * x[0], 0.0); };
  Displace(lattice, twist);
  Numbers random(5);
  for (int n = 0; n < 500; ++n)
  {
    const Vec3 x(random.In(-1.0, 1.0), random.In(-1.0, 1.0), random.In(0.0, 5.0));
    EXPECT_LE((lattice.Map(x) - x - twist(x)).norm(), 1e-14);
  }
}

// z^2 has the coefficients sum_{a<b} k_a k_b / (p choose 2) over the p knots of a function (its
// blossom).
TEST(FreeFormLattice, ParabolaIsReproduced)
{
  const int count = 9, p = 3;
  FreeFormLattice lattice(UnitBox(), { { 2, 2, count } }, { { 0, 0, p } });
  std::vector<double> xyz;
  for (int n = 0; n < 4 * count; ++n)
  {
    const auto knot = [&](int a) { return KnotAt(n / 4 + a, p, count); };
    const double square = (knot(1) * knot(2) + knot(1) * knot(3) + knot(2) * knot(3)) / 3.0;
    xyz.insert(xyz.end(), { 0.7 * square, 0.0, 0.0 });
  }
  lattice.SetDisplacements(xyz);
  Numbers random(6);
  for (int n = 0; n < 500; ++n)
  {
    const Vec3 x = random.Vector(0.0, 1.0);
    EXPECT_LE((lattice.Map(x) - x - Vec3(0.7 * x[2] * x[2], 0.0, 0.0)).norm(), 1e-15);
  }
}

TEST(FreeFormLattice, FunctionsAreAPartitionOfUnity)
{
  Numbers random(7);
  FreeFormLattice lattice(UnitBox(), { { 5, 4, 3 } });
  for (int n = 0; n < 20; ++n)
  {
    const Vec3 x = random.Vector(0.0, 1.0);
    double sum = 0.0;
    for (std::int64_t i = 0; i < lattice.Size(); ++i)
    {
      DisplaceOne(lattice, i, Vec3(8.0, 0.0, 0.0)); // 8 >> 1, so that little of it is rounded off
      const double value = (lattice.Map(x)[0] - x[0]) / 8.0;
      EXPECT_GE(value, 0.0);
      sum += value;
    }
    EXPECT_NEAR(sum, 1.0, 2e-15);
  }
}

TEST(FreeFormLattice, ControlPointsMoveOnlyWhatIsNear)
{
  FreeFormLattice lattice(UnitBox(), { { 10, 10, 10 } });
  const int i = 2, j = 5, k = 9;
  DisplaceOne(lattice, i + 10 * (j + 10 * k), Vec3(1.0, 1.0, 1.0));
  Numbers random(8);
  Points points(3000);
  std::int64_t near = 0;
  for (Vec3& x : points)
  {
    x = random.Vector(0.0, 1.0);
    const auto reached = [&](int axis, int at) {
      return x[axis] > KnotAt(at, 3, 10) && x[axis] < KnotAt(at + 4, 3, 10);
    };
    const bool reach = reached(0, i) && reached(1, j) && reached(2, k);
    near += reach;
    EXPECT_EQ(lattice.Map(x) != x, reach) << x.transpose();
  }
  Points out = points;
  EXPECT_EQ(lattice.Map(points[0].data(), 3000, out[0].data()).Moved, near);
  EXPECT_GT(near, 30);
}

TEST(FreeFormLattice, TheBoxIsClosedAndPointsOutsideStay)
{
  const LatticeBox box = LatticeBox::Of(Box3(Vec3(0.1, 0.2, 0.3), Vec3(0.7, 1.9, 3.1)));
  FreeFormLattice lattice(box, { { 4, 4, 4 } });
  const Vec3 shift(10.0, 20.0, 30.0);
  Displace(lattice, [&](const Vec3&) { return shift; });
  for (int corner = 0; corner < 8; ++corner)
  {
    const Vec3 side(corner & 1, corner >> 1 & 1, corner >> 2);
    const Vec3 x(corner & 1 ? 0.7 : 0.1, corner & 2 ? 1.9 : 0.2, corner & 4 ? 3.1 : 0.3);
    EXPECT_TRUE(lattice.Contains(x));
    EXPECT_LE((lattice.Map(x) - x - shift).norm(), 1e-14);
    for (int axis = 0; axis < 3; ++axis)
    {
      Vec3 out = x;
      out[axis] += (side[axis] > 0.0 ? 1.0 : -1.0) * 1e-9;
      EXPECT_FALSE(lattice.Contains(out));
      EXPECT_EQ(lattice.Map(out), out);
    }
  }
  for (const double bad : { NaN, Infinity, -Infinity })
  {
    const Vec3 x(0.4, bad, 1.0);
    EXPECT_FALSE(lattice.Contains(x));
    const Vec3 same = lattice.Map(x);
    EXPECT_EQ(same[0], 0.4);
    EXPECT_TRUE(std::isnan(bad) ? std::isnan(same[1]) : same[1] == bad);
  }
}

// With n layers at rest the displacement starts as s^n: C^(n-1).
TEST(FreeFormLattice, FrozenLayersMakeTheBorderSmooth)
{
  for (int frozen = 0; frozen <= 3; ++frozen)
  {
    FreeFormLattice lattice(UnitBox(), { { 9, 9, 9 } });
    Displace(
      lattice, [](const Vec3&) { return Vec3(1.0, 0.0, 0.0); }, frozen);
    for (int side = 0; side < 6; ++side)
    {
      const auto shift = [&](double depth) {
        Vec3 x(0.5, 0.5, 0.5);
        x[side / 2] = side % 2 ? 1.0 - depth : depth;
        return lattice.Map(x)[0] - x[0];
      };
      EXPECT_GT(shift(0.02), 0.0);
      EXPECT_NEAR(std::log2(shift(0.002) / shift(0.001)), frozen, 0.02);
      EXPECT_NEAR(shift(0.0), frozen == 0 ? 1.0 : 0.0, 1e-15);
    }
    EXPECT_EQ(lattice.Displacement(4 + 9 * (4 + 9 * 4)), Vec3(1.0, 0.0, 0.0));
    EXPECT_EQ(lattice.Displacement(0), frozen == 0 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 0.0, 0.0));
  }
  FreeFormLattice all(UnitBox(), { { 4, 4, 9 } });
  Displace(
    all, [](const Vec3&) { return Vec3(1.0, 0.0, 0.0); }, 2);
  EXPECT_EQ(all.Map(Vec3(0.5, 0.5, 0.5)), Vec3(0.5, 0.5, 0.5));
}

TEST(FreeFormLattice, ThreadsAndTargetsGiveTheSameBits)
{
  Numbers random(9);
  FreeFormLattice lattice(UnitBox(), { { 8, 5, 4 } });
  Displace(lattice, [&](const Vec3&) { return random.Vector(-1.0, 1.0); });
  Points points(50001);
  for (Vec3& x : points)
  {
    x = random.Vector(-0.1, 1.1);
  }
  const auto count = std::int64_t(points.size());
  Points serial(points.size(), Vec3::Zero());
  const nurbs::LatticeMoves moves = lattice.Map(points[0].data(), count, serial[0].data());
  EXPECT_TRUE(moves.Changed);
  std::int64_t moved = 0;
  for (std::size_t n = 0; n < points.size(); ++n)
  {
    moved += serial[n] != points[n];
    EXPECT_EQ(serial[n], lattice.Map(points[n]));
  }
  EXPECT_EQ(moves.Moved, moved);
  const auto threads = [](std::int64_t first, std::int64_t last,
                         const std::function<void(std::int64_t, std::int64_t)>& body) {
    std::vector<std::thread> running;
    for (int t = 0; t < 4; ++t)
    {
      running.emplace_back(
        [=] { body(first + (last - first) * (3 - t) / 4, first + (last - first) * (4 - t) / 4); });
    }
    for (std::thread& thread : running)
    {
      thread.join();
    }
  };
  Points parallel = serial;
  const nurbs::LatticeMoves again =
    lattice.Map(points[0].data(), count, parallel[0].data(), threads);
  EXPECT_FALSE(again.Changed);
  EXPECT_EQ(again.Moved, moved);
  EXPECT_EQ(parallel, serial);
  Points inPlace = points;
  EXPECT_TRUE(lattice.Map(inPlace[0].data(), count, inPlace[0].data(), threads).Changed);
  EXPECT_EQ(inPlace, serial);
}

template <class F>
std::string Complaint(F work)
{
  try
  {
    work();
  }
  catch (const nurbs::Error& error)
  {
    return error.what();
  }
  return "";
}

TEST(FreeFormLattice, BadDisplacementsAreNamedAndChangeNothing)
{
  FreeFormLattice lattice(UnitBox(), { { 3, 4, 5 } });
  Displace(lattice, [](const Vec3& rest) { return Vec3(0.1 * rest); });
  const Vec3 before = lattice.Map(Vec3(0.3, 0.6, 0.2));
  for (const double bad : { NaN, Infinity, -Infinity })
  {
    std::vector<double> xyz(3 * lattice.Size(), 0.25);
    xyz[3 * (1 + 3 * (2 + 4 * 3)) + 2] = bad;
    EXPECT_EQ(Complaint([&] { lattice.SetDisplacements(xyz); }),
      "the displacement of lattice point 43 (1, 2, 3) is not finite");
  }
  const std::vector<double> few(30, 0.0);
  EXPECT_EQ(Complaint([&] { lattice.SetDisplacements(few); }),
    "the lattice has 60 points, but 10 displacements are given");
  EXPECT_EQ(lattice.Map(Vec3(0.3, 0.6, 0.2)), before);
}

TEST(FreeFormLattice, BadLatticesAreRefused)
{
  const auto make = [](const LatticeBox& box, Counts counts, Counts degrees) {
    return Complaint([&] { FreeFormLattice lattice(box, counts, degrees); });
  };
  const Counts four = { { 4, 4, 4 } }, zero = { { 0, 0, 0 } };
  EXPECT_NE(make(UnitBox(), { { 4, 1, 4 } }, zero).find("not 1"), std::string::npos);
  EXPECT_NE(make(UnitBox(), { { 4, 4, 33 } }, zero).find("not 33"), std::string::npos);
  EXPECT_NE(make(UnitBox(), four, { { 0, -1, 0 } }).find("can't be -1"), std::string::npos);
  LatticeBox box = UnitBox();
  box.Axes.col(1).setZero();
  EXPECT_NE(make(box, four, zero).find("flat"), std::string::npos);
  box.Axes.col(1) = box.Axes.col(0);
  EXPECT_NE(make(box, four, zero).find("flat"), std::string::npos);
  box = UnitBox();
  box.Origin[1] = NaN;
  EXPECT_NE(make(box, four, zero).find("not finite"), std::string::npos);
  box = UnitBox();
  box.Axes *= 1e200;
  EXPECT_NE(make(box, four, zero).find("too large"), std::string::npos);
  box.Axes = 1e-100 * Eigen::Matrix3d::Identity();
  EXPECT_EQ(make(box, four, zero), "");
}

TEST(FreeFormLattice, BoxOfPointsLeavesOutWhatIsNotFinite)
{
  const Points points = { Vec3(1, 2, 3), Vec3(NaN, 50, 50), Vec3(-1, 5, 0), Vec3(9, Infinity, 9) };
  const Box3 box = nurbs::BoxOfFinitePoints(points[0].data(), 4);
  EXPECT_EQ(box.min(), Vec3(-1, 2, 0));
  EXPECT_EQ(box.max(), Vec3(1, 5, 3));
  EXPECT_TRUE(nurbs::BoxOfFinitePoints(points[1].data(), 1).isEmpty());
}

} // namespace
