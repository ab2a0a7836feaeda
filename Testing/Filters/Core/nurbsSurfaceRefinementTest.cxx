// SPDX-License-Identifier: BSD-3-Clause
#include "Surface.h"
#include "nurbsReference.h"

#include <gtest/gtest.h>

using namespace nurbs;

namespace
{

struct Case
{
  Surface S;
  int Dir;
  std::string Name;
};

/// Every degree in one direction and a small one in the other.
std::vector<Case> Cases()
{
  reference::Random random(51);
  std::vector<Case> cases;
  for (int degree = 1; degree <= MaxDegree; ++degree)
  {
    for (int dir : { 0, 1 })
    {
      const int other = random.Integer(1, 4);
      const bool clamped = (degree + dir) % 2 == 0;
      const bool breaks = degree % 4 == 1;
      const bool rational = degree % 3 != 0;
      cases.push_back({ random.Surface(dir == 0 ? degree : other, dir == 1 ? degree : other,
                          clamped, rational, breaks),
        dir, "degree " + std::to_string(degree) + " in direction " + std::to_string(dir) });
    }
  }
  return cases;
}

void ExpectSound(const Surface& s)
{
  for (int dir : { 0, 1 })
  {
    EXPECT_EQ(CheckKnots(s.Knots[dir], s.Degree[dir], s.Count[dir]), "");
  }
  EXPECT_EQ(s.Points.size(), std::size_t(s.Count[0]) * s.Count[1]);
}

} // namespace

TEST(SurfaceRefinement, KnotInsertionLeavesTheSurface)
{
  reference::Random random(52);
  for (const Case& c : Cases())
  {
    SCOPED_TRACE(c.Name);
    const SurfaceView view = c.S.View();
    const Interval domain = view.Domain(c.Dir);
    std::vector<double> add;
    for (int i = 0; i < 5; ++i)
    {
      add.push_back(random.Uniform(domain.Min, domain.Max));
    }
    std::sort(add.begin(), add.end());
    const Surface refined = RefineKnots(view, c.Dir, add);
    ExpectSound(refined);
    EXPECT_EQ(refined.Count[c.Dir], c.S.Count[c.Dir] + 5);
    EXPECT_EQ(refined.Weights.empty(), c.S.Weights.empty());
    EXPECT_LT(reference::LargestDistance(view, refined.View(), random, 20), 2e-13);
  }
}

TEST(SurfaceRefinement, ElevationLeavesTheSurfaceAndReductionUndoesIt)
{
  reference::Random random(53);
  for (const Case& c : Cases())
  {
    SCOPED_TRACE(c.Name);
    const SurfaceView view = c.S.View();
    const int times = std::min(2, MaxDegree - c.S.Degree[c.Dir]);
    if (times == 0)
    {
      EXPECT_THROW(ElevateDegree(view, c.Dir, 1), Error);
      continue;
    }
    const Surface raised = ElevateDegree(view, c.Dir, times);
    ExpectSound(raised);
    EXPECT_EQ(raised.Degree[c.Dir], c.S.Degree[c.Dir] + times);
    EXPECT_LT(reference::LargestDistance(view, raised.View(), random, 20), 2e-13);
    const Surface reduced = ReduceDegree(raised.View(), c.Dir, 1e-10);
    ExpectSound(reduced);
    EXPECT_LT(reference::LargestDistance(view, reduced.View(), random, 20), 1e-11);
    EXPECT_LE(reduced.Degree[c.Dir], c.S.Degree[c.Dir]);
    // (The short domain of an unclamped spline may well be of lower degree to this tolerance.)
    if (IsClamped(c.S.Knots[c.Dir], c.S.Degree[c.Dir]))
    {
      EXPECT_EQ(reduced.Knots[c.Dir], c.S.Knots[c.Dir]);
    }
  }
}

TEST(SurfaceRefinement, ReductionIsLosslessOrNone)
{
  reference::Random random(54);
  const Surface surface = random.Surface(4, 3);
  const Surface same = ReduceDegree(surface.View(), 0, 1e-9);
  EXPECT_EQ(same.Degree[0], 4);
  EXPECT_EQ(same.Points, surface.Points);
  EXPECT_EQ(ReduceDegree(surface.View(), 1, 0.0).Degree[1], 3);
  // With room for error it may reduce, and then stays within it.
  for (bool rational : { false, true })
  {
    Surface sheet = random.Surface(4, 3, true, rational);
    for (double& weight : sheet.Weights)
    {
      weight = 1.0 + 0.05 * weight; // the bound is coarse if weights differ much
    }
    const double tolerance = 2.0;
    const Surface lossy = ReduceDegree(sheet.View(), 0, tolerance);
    EXPECT_LT(lossy.Degree[0], 4);
    const double moved = reference::LargestDistance(sheet.View(), lossy.View(), random, 400);
    EXPECT_GT(moved, 1e-3);
    EXPECT_LE(moved, tolerance);
  }
}

TEST(SurfaceRefinement, ConeAsQuadraticReducesToItsRulings)
{
  const Surface cone = reference::Cone(2.0, 4.0);
  const Surface raised = ElevateDegree(cone.View(), 1, 5);
  EXPECT_EQ(raised.Degree[1], 6);
  const Surface reduced = ReduceDegree(raised.View(), 1, 1e-12);
  EXPECT_EQ(reduced.Degree[1], 1);
  EXPECT_EQ(reduced.Count[1], 2);
}

TEST(SurfaceRefinement, SplitAndRestrict)
{
  reference::Random random(55);
  for (const Case& c : Cases())
  {
    SCOPED_TRACE(c.Name);
    const SurfaceView view = c.S.View();
    const Interval domain = view.Domain(c.Dir);
    const double cut = random.Uniform(domain.Min, domain.Max);
    const auto halves = Split(view, c.Dir, cut);
    for (const Surface* half : { &halves.first, &halves.second })
    {
      ExpectSound(*half);
      EXPECT_TRUE(IsClamped(half->Knots[c.Dir], half->Degree[c.Dir]));
      EXPECT_LT(reference::LargestDistance(view, half->View(), random, 20), 2e-13);
    }
    EXPECT_EQ(halves.first.View().Domain(c.Dir).Max, cut);
    EXPECT_EQ(halves.second.View().Domain(c.Dir).Min, cut);
    const Interval u = view.Domain(0);
    const Interval v = view.Domain(1);
    const Interval partU{ u.Min, u.Min + 0.6 * u.Length() };
    const Interval partV{ v.Min + 0.3 * v.Length(), v.Max };
    const Surface part = Restrict(view, partU, partV);
    ExpectSound(part);
    EXPECT_EQ(part.View().Domain(0).Max, partU.Max);
    EXPECT_EQ(part.View().Domain(1).Min, partV.Min);
    EXPECT_LT(reference::LargestDistance(view, part.View(), random, 20), 2e-13);
  }
}

TEST(SurfaceRefinement, SplitNextToAKnotIsSplitAtIt)
{
  reference::Random random(56);
  Surface surface = random.Surface(3, 3, true, true, false, 0);
  surface = RefineKnots(surface.View(), 0, { surface.View().Domain(0).Min + 0.125 });
  const double knot = surface.Knots[0][4];
  for (double t : { std::nextafter(knot, -10.0), knot, std::nextafter(knot, 10.0) })
  {
    const auto halves = Split(surface.View(), 0, t);
    EXPECT_EQ(halves.first.Count[0], 4);
    EXPECT_EQ(halves.second.Count[0], 4);
    EXPECT_EQ(halves.first.View().Domain(0).Max, t);
    EXPECT_LT(reference::LargestDistance(surface.View(), halves.second.View(), random), 1e-12);
  }
}

TEST(SurfaceRefinement, ReductionStaysWithinItsToleranceWhateverTheWeights)
{
  reference::Random random(59);
  int reductions = 0;
  for (int trial = 0; trial < 400; ++trial)
  {
    Surface surface = random.Surface(2, 1, true, true, false, 0);
    for (std::size_t k = 0; k < surface.Points.size(); ++k)
    {
      // Nearly a straight strip; its weights alone bend the parameter.
      surface.Points[k] = Vec3(k % 3, k / 3, 0.0);
      // A common factor changes nothing.
      surface.Weights[k] = random.Uniform(0.9, 1.1) * (trial % 2 == 0 ? 1.0 : 0.05);
    }
    const double tolerance = random.Uniform(0.01, 0.1);
    const Surface reduced = ReduceDegree(surface.View(), 0, tolerance);
    reductions += reduced.Degree[0] < 2 ? 1 : 0;
    EXPECT_LE(reference::LargestDistance(surface.View(), reduced.View(), random, 30), tolerance);
  }
  EXPECT_GT(reductions, 50);
  EXPECT_LT(reductions, 350);
}

TEST(SurfaceRefinement, BezierPatchesCoverTheSurface)
{
  reference::Random random(57);
  for (const Case& c : Cases())
  {
    SCOPED_TRACE(c.Name);
    const SurfaceView view = c.S.View();
    const std::vector<BezierPatch> patches = ToBezier(view);
    const std::size_t spansU = DistinctKnots(c.S.Knots[0], c.S.Degree[0]).size() - 1;
    const std::size_t spansV = DistinctKnots(c.S.Knots[1], c.S.Degree[1]).size() - 1;
    ASSERT_EQ(patches.size(), spansU * spansV);
    double area = 0.0;
    for (const BezierPatch& patch : patches)
    {
      area += patch.U.Length() * patch.V.Length();
      const double s = random.Uniform(0, 1);
      const double t = random.Uniform(0, 1);
      std::vector<Vec4> row;
      for (int j = 0; j <= patch.Degree[1]; ++j)
      {
        row.push_back(
          DeCasteljau<4>(patch.Points.data() + j * (patch.Degree[0] + 1), patch.Degree[0], s));
      }
      const Vec4 h = DeCasteljau<4>(row.data(), patch.Degree[1], t);
      const Vec3 expected = reference::Point(
        view, patch.U.Min + s * patch.U.Length(), patch.V.Min + t * patch.V.Length());
      EXPECT_LT((h.head<3>() / h[3] - expected).norm(), 2e-13);
    }
    EXPECT_NEAR(area, view.Domain(0).Length() * view.Domain(1).Length(), 1e-12 * area);
  }
}

TEST(SurfaceRefinement, BezierPatchesShareTheirSidesBitForBit)
{
  reference::Random random(58);
  for (int degree = 1; degree <= 9; ++degree)
  {
    const Surface surface = random.Surface(degree, 10 - degree, degree % 2 == 0);
    const std::vector<BezierPatch> patches = ToBezier(surface.View());
    const std::size_t spansU = DistinctKnots(surface.Knots[0], degree).size() - 1;
    const int width = degree + 1;
    for (std::size_t k = 0; k < patches.size(); ++k)
    {
      for (int j = 0; j <= patches[k].Degree[1] && (k + 1) % spansU != 0; ++j)
      {
        EXPECT_EQ(patches[k].Points[j * width + degree], patches[k + 1].Points[j * width]);
      }
      for (int i = 0; i < width && k + spansU < patches.size(); ++i)
      {
        EXPECT_EQ(
          patches[k].Points[patches[k].Degree[1] * width + i], patches[k + spansU].Points[i]);
      }
    }
  }
}

TEST(SurfaceRefinement, MisuseIsRefused)
{
  const Surface sphere = reference::Sphere(1.0);
  const SurfaceView view = sphere.View();
  EXPECT_THROW(RefineKnots(view, 0, { 1.5 }), Error);
  EXPECT_THROW(RefineKnots(view, 1, { 0.5, 0.5 }), Error);
  EXPECT_THROW(Split(view, 0, 0.0), Error);
  EXPECT_THROW(Restrict(view, { 0.5, 0.2 }, { 0.0, 1.0 }), Error);
}
