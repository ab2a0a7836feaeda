// SPDX-License-Identifier: BSD-3-Clause
// Points in trimmed faces, against the winding number of dense polylines.
#include "TrimIndex.h"

#include "nurbsReference.h"
#include "nurbsTrimReference.h"

#include <gtest/gtest.h>

namespace
{

using nurbs::Curve;
using nurbs::FaceTrim;
using nurbs::TrimIndex;
using nurbs::Vec2;
using reference::Line;
using reference::Loops;
using reference::Polygon;
using reference::Random;
using reference::TrimmedSheet;

/// A rational Bezier curve from a to b with random points between.
Curve<2> RandomCurve(Random& random, int degree, const Vec2& a, const Vec2& b, double spread)
{
  Curve<2> curve;
  curve.Degree = degree;
  curve.Knots.assign(degree + 1, 0.0);
  curve.Knots.insert(curve.Knots.end(), degree + 1, 1.0);
  for (int i = 0; i <= degree; ++i)
  {
    const Vec2 off(random.Uniform(-spread, spread), random.Uniform(-spread, spread));
    const bool end = i == 0 || i == degree;
    const double t = double(i) / degree;
    curve.Points.push_back((1.0 - t) * a + t * b + (end ? Vec2(0, 0) : off));
    curve.Weights.push_back(std::pow(10.0, random.Uniform(-1.0, 1.0)));
  }
  curve.Pack();
  return curve;
}

/// Compares with the winding number at random points, half of them near the boundary, of the whole
/// sheet; returns how many were compared.
int Compare(const TrimmedSheet& sheet, unsigned seed, int count)
{
  const TrimIndex index(sheet.Model());
  const reference::Polyline line(sheet, 400);
  Random random(seed);
  int compared = 0;
  int wrong = 0;
  for (int i = 0; i < count; ++i)
  {
    Vec2 p(random.Uniform(0, 1), random.Uniform(0, 1));
    if (i % 2 == 1)
    {
      const double near = std::pow(10.0, random.Uniform(-4, -1));
      p = line.Points[random.Integer(0, int(line.Points.size()) - 1)] +
        near * Vec2(random.Uniform(-1, 1), random.Uniform(-1, 1));
    }
    if (p.minCoeff() < 0.0 || p.maxCoeff() >= 1.0 || line.IsNear(p))
    {
      continue;
    }
    ++compared;
    const Vec2 uv = sheet.Parameters(p);
    wrong += index.Inside(0, uv[0], uv[1]) != (line.Winding(p) % 2 != 0);
  }
  EXPECT_EQ(wrong, 0) << "of " << compared;
  return compared;
}

struct Cost
{
  double Mean = 0.0;
  int Most = 0;
};

/// Pieces visited by queries all over the face.
Cost Visits(const FaceTrim& face, const TrimmedSheet& sheet)
{
  Random random(7);
  Cost cost;
  constexpr int Count = 20000;
  for (int i = 0; i < Count; ++i)
  {
    const Vec2 uv = sheet.Parameters(Vec2(random.Uniform(0, 1), random.Uniform(0, 1)));
    int visited = 0;
    face.Inside(uv[0], uv[1], visited);
    cost.Mean += double(visited) / Count;
    cost.Most = std::max(cost.Most, visited);
  }
  return cost;
}

std::vector<Vec2> Star(int corners, double inner, double outer)
{
  std::vector<Vec2> star;
  for (int i = 0; i < corners; ++i)
  {
    const double angle = 2.0 * EIGEN_PI * i / corners;
    const double r = i % 2 == 0 ? outer : inner;
    star.push_back(Vec2(0.5 + r * std::cos(angle), 0.5 + r * std::sin(angle)));
  }
  return star;
}

Curve<2> CircleAt(const Vec2& centre, double radius)
{
  Curve<2> circle = reference::Circle(radius);
  for (Vec2& p : circle.Points)
  {
    p += centre;
  }
  circle.Pack();
  return circle;
}

TEST(TrimIndex, UntrimmedFaceIsInside)
{
  const TrimmedSheet sheet(Loops{});
  const TrimIndex index(sheet.Model());
  EXPECT_TRUE(index.Face(0).IsWhole());
  for (const Vec2& p : { Vec2(0, 0), Vec2(1, 1), Vec2(0.3, 0.8), Vec2(1, 0) })
  {
    EXPECT_TRUE(index.Inside(0, sheet.Parameters(p)[0], sheet.Parameters(p)[1]));
  }
  EXPECT_EQ(nurbs::Flatten(index).FaceStart.at(0), -1);
}

TEST(TrimIndex, FaceInErrorIsOutside)
{
  nurbs::Model model;
  model.Faces.resize(1);
  EXPECT_FALSE(TrimIndex(model).Inside(0, 0.5, 0.5));
}

/// A loop along the domain's sides, also one that rounding moved off them, trims nothing.
TEST(TrimIndex, LoopAlongTheSidesIsWhole)
{
  for (const double off : { 0.0, 3e-8, -3e-8 })
  {
    const TrimmedSheet sheet(
      Loops{ Polygon({ Vec2(off, 0), Vec2(1 + off, off), Vec2(1, 1 - off), Vec2(0, 1 - off) }) });
    EXPECT_TRUE(TrimIndex(sheet.Model()).Face(0).IsWhole()) << off;
  }
}

TEST(TrimIndex, SidesOfTheDomainBelongToTheFace)
{
  // The lower left half, its diagonal an arc.
  Loops loops{ { Line(Vec2(0, 0), Vec2(1, 0)), {}, Line(Vec2(0, 1), Vec2(0, 0)) } };
  Curve<2>& arc = loops[0][1].Geometry;
  arc.Degree = 2;
  arc.Knots = { 0, 0, 0, 1, 1, 1 };
  arc.Points = { Vec2(1, 0), Vec2(1, 1), Vec2(0, 1) };
  arc.Weights = { 1, std::sqrt(0.5), 1 };
  arc.Pack();
  const TrimmedSheet sheet(loops);
  const TrimIndex index(sheet.Model());
  const auto inside = [&](double u, double v) {
    const Vec2 uv = sheet.Parameters(Vec2(u, v));
    return index.Inside(0, uv[0], uv[1]);
  };
  for (double t = 0.0; t < 0.999; t += 0.01)
  {
    EXPECT_TRUE(inside(0, t) && inside(t, 0) && inside(-1e-12, t) && inside(t, -1e-12)) << t;
    EXPECT_EQ(inside(1, t), t == 0.0) << t;
    EXPECT_EQ(inside(t, 1 + 1e-12), t == 0.0) << t;
  }
  EXPECT_FALSE(inside(1, 1));
  EXPECT_FALSE(inside(std::nan(""), 0.5));
  EXPECT_FALSE(inside(0.5, std::nan("")));
}

/// The unit circle is known in closed form: no polyline, distances down to 1e-12.
TEST(TrimIndex, CircleIsExact)
{
  const TrimmedSheet sheet(Loops{ { { CircleAt(Vec2(0.5, 0.5), 0.3), false } } });
  const TrimIndex index(sheet.Model());
  Random random(1);
  for (int i = 0; i < 20000; ++i)
  {
    const double angle = random.Uniform(0.0, 2.0 * EIGEN_PI);
    const double off = std::pow(10.0, random.Uniform(-12, -1)) * (i % 2 == 0 ? 1 : -1);
    const Vec2 p = Vec2(0.5, 0.5) + (0.3 + off) * Vec2(std::cos(angle), std::sin(angle));
    const Vec2 uv = sheet.Parameters(p);
    ASSERT_EQ(index.Inside(0, uv[0], uv[1]), off < 0.0) << "off " << off << " angle " << angle;
  }
}

/// Loops of random rational curves of all degrees, crossing themselves and each other.
TEST(TrimIndex, RandomCurvesOfAllDegrees)
{
  Random random(2);
  int compared = 0;
  for (int degree = 1; degree <= nurbs::MaxDegree; ++degree)
  {
    Loops loops(2);
    for (auto& loop : loops)
    {
      const int count = random.Integer(2, 4);
      std::vector<Vec2> corners;
      for (int i = 0; i < count; ++i)
      {
        corners.push_back(Vec2(random.Uniform(0.1, 0.9), random.Uniform(0.1, 0.9)));
      }
      for (int i = 0; i < count; ++i)
      {
        const bool reversed = random.Integer(0, 1) == 1;
        const Vec2& a = corners[reversed ? (i + 1) % count : i];
        const Vec2& b = corners[reversed ? i : (i + 1) % count];
        const double spread = 0.1 + 0.1 * degree;
        loop.push_back({ RandomCurve(random, degree, a, b, spread), reversed });
      }
    }
    compared += Compare(TrimmedSheet(loops), degree, 300);
  }
  EXPECT_GT(compared, 2500);
}

/// The tree gives the same answer as all pieces, also where coordinates are those of pieces' ends.
void CompareWithAllPieces(const TrimmedSheet& sheet, unsigned seed)
{
  const TrimIndex index(sheet.Model());
  const nurbs::TrimPieces cut = nurbs::CutTrimLoops(sheet.Model(), sheet.Model().Faces[0]);
  std::vector<Vec2> points = reference::CriticalPoints(cut, 2000);
  Random random(seed);
  for (int i = 0; i < 500; ++i)
  {
    points.push_back(Vec2(random.Uniform(0, 1), random.Uniform(0, 1)));
  }
  for (const Vec2& p : points)
  {
    if (!reference::IsOnPiece(cut, p))
    {
      ASSERT_EQ(index.Inside(0, p[0], p[1]), reference::IsInside(cut, p)) << p.transpose();
    }
  }
}

TEST(TrimIndex, TreeAgreesWithAllPieces)
{
  Random random(15);
  for (int round = 0; round < 60; ++round)
  {
    Loops loops(std::size_t(random.Integer(1, 4)));
    for (auto& loop : loops)
    {
      std::vector<Vec2> corners;
      const int count = random.Integer(2, 12);
      for (int i = 0; i < count; ++i)
      {
        const bool grid = random.Integer(0, 1) == 1; // sides level and upright, corners shared
        corners.push_back(grid ? Vec2(random.Integer(0, 8) / 8.0, random.Integer(0, 8) / 8.0)
                               : Vec2(random.Uniform(-0.1, 1.1), random.Uniform(-0.1, 1.1)));
      }
      for (int i = 0; i < count; ++i)
      {
        const int degree = random.Integer(0, 2) == 0 ? random.Integer(2, 6) : 1;
        loop.push_back(
          { RandomCurve(random, degree, corners[i], corners[(i + 1) % count], 0.2), false });
      }
    }
    CompareWithAllPieces(TrimmedSheet(loops, false), round);
  }
}

/// B-splines with knots of any multiplicity; the loops do not close, gaps become straight.
TEST(TrimIndex, RandomSplinesWithBreaksAndGaps)
{
  Random random(3);
  int compared = 0;
  for (int degree = 1; degree <= 9; ++degree)
  {
    Loops loops(1);
    for (int i = 0; i < 2; ++i)
    {
      Curve<2> curve = random.Curve<2>(degree, i == 0, true);
      for (Vec2& p : curve.Points)
      {
        p = Vec2(0.5, 0.5) + 0.4 * p;
      }
      curve.Pack();
      loops[0].push_back({ curve, i == 1 });
    }
    compared += Compare(TrimmedSheet(loops), degree, 400);
  }
  EXPECT_GT(compared, 1500);
}

TEST(TrimIndex, NestedLoopsWhicheverWayTheyRun)
{
  for (int turned = 0; turned < 8; ++turned)
  {
    Loops loops;
    for (int k = 0; k < 3; ++k)
    {
      loops.push_back({ { CircleAt(Vec2(0.5, 0.5), 0.45 - 0.1 * k), (turned >> k) % 2 == 1 } });
    }
    loops.push_back({ { CircleAt(Vec2(0.05, 0.05), 0.04), false } });
    const TrimmedSheet sheet(loops);
    Compare(sheet, 4, 600);
    const TrimIndex index(sheet.Model());
    const auto inside = [&](double u) {
      const Vec2 uv = sheet.Parameters(Vec2(u, 0.5));
      return index.Inside(0, uv[0], uv[1]);
    };
    EXPECT_TRUE(inside(0.1) && !inside(0.2) && inside(0.5) && !inside(0.01));
  }
}

/// A period of a closed surface: the seam is walked twice, up and down, here inside the domain.
TEST(TrimIndex, SeamsAndSlitsEncloseNothing)
{
  Loops loops{ Polygon({ Vec2(0.1, 0.1), Vec2(0.9, 0.1), Vec2(0.9, 0.9), Vec2(0.5, 0.9),
    Vec2(0.5, 0.4), Vec2(0.5, 0.9), Vec2(0.1, 0.9) }) };
  const TrimmedSheet sheet(loops);
  Compare(sheet, 5, 1000);
  const TrimIndex index(sheet.Model());
  for (double v = 0.41; v < 0.9; v += 0.03)
  {
    for (const double u : { 0.5 - 1e-9, 0.5, 0.5 + 1e-9 })
    {
      const Vec2 uv = sheet.Parameters(Vec2(u, v));
      EXPECT_TRUE(index.Inside(0, uv[0], uv[1])) << u << " " << v;
    }
  }
}

TEST(TrimIndex, LoopWithoutAreaEnclosesNothing)
{
  Random random(6);
  const Curve<2> there = RandomCurve(random, 5, Vec2(0.2, 0.3), Vec2(0.8, 0.6), 0.2);
  for (const Loops& loops : { Loops{ { { there, false }, { there, true } } },
         Loops{ Polygon({ Vec2(0.2, 0.2), Vec2(0.7, 0.9) }) },
         Loops{ { Line(Vec2(0.4, 0.4), Vec2(0.4, 0.4)) } } })
  {
    const TrimmedSheet sheet(loops);
    const TrimIndex index(sheet.Model());
    for (int i = 0; i < 3000; ++i)
    {
      Vec2 p(random.Uniform(0, 1), random.Uniform(0, 1));
      if (i % 2 == 1)
      {
        p = nurbs::Evaluate<2>(there.View(), random.Uniform(0, 1)) +
          Vec2(i % 4 == 1 ? 1e-9 : -1e-9, 0);
      }
      const Vec2 uv = sheet.Parameters(p);
      ASSERT_FALSE(index.Inside(0, uv[0], uv[1])) << p.transpose();
    }
  }
}

/// Corners of many kinds at one height, level sides, points of zero length, spikes: a point exactly
/// at their height is what the points just above it are.
TEST(TrimIndex, HeightsOfCornersAndLevelSides)
{
  const std::vector<double> heights{ 0.125, 0.25, 0.375, 0.5, 0.625, 0.75 };
  Random random(8);
  for (int round = 0; round < 200; ++round)
  {
    // Corners on a coarse grid: most heights occur many times, many sides are level or upright.
    std::vector<Vec2> corners;
    const int count = random.Integer(3, 14);
    for (int i = 0; i < count; ++i)
    {
      const double v = heights[random.Integer(0, int(heights.size()) - 1)];
      const bool upright = i > 0 && random.Integer(0, 2) == 0;
      corners.push_back(Vec2(upright ? corners.back()[0] : random.Integer(1, 7) / 8.0, v));
    }
    const TrimmedSheet sheet(Loops{ Polygon(corners) }, false);
    const TrimIndex index(sheet.Model());
    const reference::Polyline line(sheet, 1);
    for (const double v : heights)
    {
      for (int k = 0; k < 40; ++k)
      {
        const Vec2 p(random.Uniform(0, 1), v);
        const Vec2 over = p + Vec2(0, 1e-9);
        const Vec2 under = p - Vec2(0, 1e-9);
        ASSERT_EQ(index.Inside(0, p[0], p[1]), line.Winding(over) % 2 != 0) << p.transpose();
        ASSERT_EQ(index.Inside(0, under[0], under[1]), line.Winding(under) % 2 != 0);
      }
    }
  }
}

/// Ends of curves at shared heights where curves meet smoothly, in corners and at turning points.
TEST(TrimIndex, HeightsOfSharedEndsOfCurves)
{
  Random random(9);
  for (int round = 0; round < 40; ++round)
  {
    Loops loops(1);
    const int count = random.Integer(2, 6);
    std::vector<Vec2> corners;
    for (int i = 0; i < count; ++i)
    {
      corners.push_back(Vec2(random.Uniform(0.2, 0.8), random.Integer(2, 6) / 8.0));
    }
    for (int i = 0; i < count; ++i)
    {
      loops[0].push_back(
        { RandomCurve(random, random.Integer(1, 5), corners[i], corners[(i + 1) % count], 0.3),
          false });
    }
    const TrimmedSheet sheet(loops, false);
    const TrimIndex index(sheet.Model());
    const reference::Polyline line(sheet, 400);
    for (const Vec2& corner : corners)
    {
      for (int k = 0; k < 50; ++k)
      {
        const Vec2 p(random.Uniform(0, 1), corner[1]);
        if (!line.IsNear(p))
        {
          ASSERT_EQ(index.Inside(0, p[0], p[1]), line.Winding(p + Vec2(0, 1e-7)) % 2 != 0)
            << p.transpose();
        }
      }
    }
  }
}

/// Gaps: tiny ones are closed by moving an end, others by a straight piece; parity is sound far away.
TEST(TrimIndex, GapsAreClosed)
{
  for (const double gap : { 1e-12, 1e-8, 1e-5, 1e-2, 0.1 })
  {
    Loops loops{ Polygon({ Vec2(0.2, 0.2), Vec2(0.8, 0.2), Vec2(0.8, 0.8), Vec2(0.2, 0.8) }) };
    loops[0][1] = Line(Vec2(0.8, 0.2 + gap), Vec2(0.8 + gap, 0.8));
    loops[0][3] = Line(Vec2(0.2, 0.8), Vec2(0.2, 0.2 + gap));
    const TrimmedSheet sheet(loops);
    EXPECT_GT(Compare(sheet, 10, 2000), 900);
    const TrimIndex index(sheet.Model());
    for (double v = 0.0; v < 1.0; v += 1e-3)
    {
      const Vec2 left = sheet.Parameters(Vec2(0.05, v));
      const Vec2 right = sheet.Parameters(Vec2(0.95, v));
      EXPECT_FALSE(index.Inside(0, left[0], left[1]) || index.Inside(0, right[0], right[1])) << v;
    }
  }
}

/// Curves of high degree that are lines, curves that go back over themselves, cusps, repeated points.
TEST(TrimIndex, DegeneratePieces)
{
  Curve<2> line = Line(Vec2(0.1, 0.2), Vec2(0.9, 0.3)).Geometry;
  line = nurbs::ElevateDegree<2>(line.View(), 8);
  Curve<2> back; // overshoots both ends
  back.Degree = 3;
  back.Knots = { 0, 0, 0, 0, 1, 1, 1, 1 };
  back.Points = { Vec2(0.9, 0.3), Vec2(0.9, 1.2), Vec2(0.9, -0.3), Vec2(0.9, 0.7) };
  back.Weights = { 1, 2, 1, 3 };
  back.Pack();
  Curve<2> cusp = back;
  cusp.Points = { Vec2(0.9, 0.7), Vec2(0.1, 0.8), Vec2(0.9, 0.8), Vec2(0.1, 0.7) };
  cusp.Pack();
  Curve<2> repeated = back; // all but the ends in one point, derivatives vanish
  repeated.Degree = 5;
  repeated.Knots = { 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1 };
  repeated.Points = { Vec2(0.1, 0.7), Vec2(0.1, 0.7), Vec2(0.1, 0.7), Vec2(0.1, 0.2),
    Vec2(0.1, 0.2), Vec2(0.1, 0.2) };
  repeated.Weights.assign(6, 1.0);
  repeated.Pack();
  const TrimmedSheet sheet(
    Loops{ { { line, false }, { back, false }, { cusp, false }, { repeated, false } } });
  EXPECT_GT(Compare(sheet, 11, 4000), 2000);
  // 1 + 3 + 2 or 3 + 1 pieces if lines are seen as such, and none is level.
  EXPECT_LE(TrimIndex(sheet.Model()).Face(0).PieceCount(), 10);
}

struct Size
{
  double BytesPerSide = 0.0;
  Cost Visits;
};

/// Size and cost of a polygon's index, which is compared with the winding number.
Size Measure(const std::vector<Vec2>& corners)
{
  const TrimmedSheet sheet(Loops{ Polygon(corners) });
  const TrimIndex index(sheet.Model());
  const FaceTrim& face = index.Face(0);
  EXPECT_LE(face.PieceCount(), std::int64_t(corners.size()));
  Compare(sheet, 12, 400);
  Size size;
  size.Visits = Visits(face, sheet);
  size.BytesPerSide =
    16.0 * double(face.PointTexelCount() + face.RecordTexelCount()) / double(corners.size());
  testing::Test::RecordProperty("BytesPerSide", std::to_string(size.BytesPerSide));
  testing::Test::RecordProperty("MeanVisits", std::to_string(size.Visits.Mean));
  testing::Test::RecordProperty("MostVisits", size.Visits.Most);
  return size;
}

TEST(TrimIndex, OutlineOfTenThousandSides)
{
  Random random(12);
  std::vector<Vec2> outline = Star(10000, 0.4, 0.4);
  for (Vec2& p : outline)
  {
    p += 1e-4 * Vec2(random.Uniform(-1, 1), random.Uniform(-1, 1));
  }
  const Size size = Measure(outline);
  EXPECT_LT(size.BytesPerSide, 60.0);
  EXPECT_LT(size.Visits.Mean, 0.1);
  EXPECT_LT(size.Visits.Most, 8);
}

/// Spikes side by side all around, each a third of the star's radius long.
TEST(TrimIndex, StarOfTenThousandSides)
{
  const Size size = Measure(Star(10000, 0.30, 0.45));
  EXPECT_LT(size.BytesPerSide, 80.0);
  EXPECT_LT(size.Visits.Mean, 40.0);
  EXPECT_LT(size.Visits.Most, 400);
}

/// Teeth from side to side of the domain: whatever the height, all of them are there.
TEST(TrimIndex, CombsVisitFewPieces)
{
  for (const bool slanted : { false, true })
  {
    std::vector<Vec2> comb{ Vec2(0.99, 0.005), Vec2(0.01, 0.005) };
    constexpr int Teeth = 500;
    for (int k = 0; k < Teeth; ++k)
    {
      const double u = 0.02 + (slanted ? 0.3 : 0.95) * k / Teeth;
      const double step = (slanted ? 0.3 : 0.95) / Teeth;
      const double lean = slanted ? 0.6 : 0.0;
      comb.push_back(Vec2(u, 0.01));
      comb.push_back(Vec2(u + lean, 0.99));
      comb.push_back(Vec2(u + lean + 0.5 * step, 0.99));
      comb.push_back(Vec2(u + 0.5 * step, 0.01));
    }
    const Size size = Measure(comb);
    EXPECT_LT(size.BytesPerSide, 60.0);
    EXPECT_LT(size.Visits.Mean, slanted ? 11.0 : 1.0);
    EXPECT_LT(size.Visits.Most, 16);
  }
}

/// All sides meet in one corner.
TEST(TrimIndex, ManySidesThroughOnePoint)
{
  std::vector<Vec2> fan;
  for (int k = 0; k < 1000; ++k)
  {
    const double angle = 2.0 * EIGEN_PI * k / 1000;
    fan.push_back(Vec2(0.5 + 0.45 * std::cos(angle), 0.5 + 0.45 * std::sin(angle)));
    if (k % 2 == 1)
    {
      fan.push_back(Vec2(0.5, 0.5));
    }
  }
  const TrimmedSheet sheet(Loops{ Polygon(fan) });
  const TrimIndex index(sheet.Model());
  EXPECT_LT(Visits(index.Face(0), sheet).Mean, 30.0);
  Compare(sheet, 14, 1000);
}

TEST(TrimIndex, RebuildReplacesOneFace)
{
  const TrimmedSheet small(Loops{ { { CircleAt(Vec2(0.5, 0.5), 0.1), false } } });
  const TrimmedSheet large(Loops{ { { CircleAt(Vec2(0.5, 0.5), 0.4), false } } });
  TrimIndex index(small.Model());
  const Vec2 uv = small.Parameters(Vec2(0.7, 0.5));
  EXPECT_FALSE(index.Inside(0, uv[0], uv[1]));
  index.Rebuild(large.Model(), 0);
  EXPECT_TRUE(index.Inside(0, uv[0], uv[1]));
}

/// The texels hold what the header says, wherever they are put.
TEST(TrimIndex, TexelsDoNotDependOnTheirPlace)
{
  const TrimmedSheet sheet(Loops{ { { CircleAt(Vec2(0.5, 0.5), 0.3), false } } });
  const TrimIndex index(sheet.Model());
  const nurbs::TrimTexels texels = nurbs::Flatten(index);
  const FaceTrim& face = index.Face(0);
  ASSERT_EQ(texels.Points.size(), std::size_t(4 * face.PointTexelCount()));
  ASSERT_EQ(texels.Records.size(), std::size_t(4 * face.RecordTexelCount()));
  std::vector<float> points(texels.Points.size());
  std::vector<std::int32_t> records(texels.Records.size());
  face.WriteTexels(1000, points.data(), records.data());
  EXPECT_EQ(points, texels.Points);
  EXPECT_EQ(records[0], 1000);
  EXPECT_EQ(texels.Records[0], 0);
  records[0] = 0;
  EXPECT_EQ(records, texels.Records);
  // Four arcs, each a box and one inner point.
  EXPECT_EQ(face.PieceCount(), 4);
  EXPECT_LE(face.PointTexelCount(), 4 * 2 + 4);
}

TEST(TrimIndex, ThrowsForCoordinatesThatAreNotFinite)
{
  const TrimmedSheet sheet(
    Loops{ Polygon({ Vec2(0.1, 0.1), Vec2(std::nan(""), 0.5), Vec2(0.1, 0.9) }) });
  EXPECT_THROW(TrimIndex(sheet.Model()), nurbs::Error);
}

} // namespace
