// SPDX-License-Identifier: BSD-3-Clause
// The judges of visible regions against regions and areas that are plain.
#include "AreaByLines.h"
#include "nurbsSolids.h"
#include "nurbsTorusVisibility.h"

#include <gtest/gtest.h>

namespace
{

using nurbs::Vec2;
using nurbs::Vec3;

constexpr double Pi = 3.14159265358979323846;

struct Scene
{
  explicit Scene(nurbs::ModelBuilder& builder)
    : Assembled(nurbs::AssembleModel(builder.Arrays()))
    , Caster(this->Assembled.Model)
  {}
  nurbs::AssembledModel Assembled;
  nurbs::RayCaster Caster;
};

/// The unit square at a height, trimmed to from <= x <= upTo; its edges have that tolerance.
void AddPlate(nurbs::ModelBuilder& builder, double z, double from = 0.0, double upTo = 1.0,
  double tolerance = 0.0)
{
  nurbs::Surface plane;
  plane.Count[0] = plane.Count[1] = 2;
  plane.Knots[0] = plane.Knots[1] = { 0, 0, 1, 1 };
  plane.Points = { Vec3(0, 0, z), Vec3(1, 0, z), Vec3(0, 1, z), Vec3(1, 1, z) };
  std::int64_t edges[4];
  for (std::int64_t& edge : edges)
  {
    edge = tolerance > 0.0 ? builder.AddUnknownEdge(tolerance, -1, -1) : -1;
  }
  builder.BeginFace(plane.View(), nurbs::FaceAttributes());
  builder.BeginLoop();
  const Vec2 corners[5] = { { from, 0 }, { upTo, 0 }, { upTo, 1 }, { from, 1 }, { from, 0 } };
  for (int k = 0; k < 4; ++k)
  {
    builder.AddTrimCurve(
      nurbs::TrimLine(corners[k], corners[k + 1], { 0, 1 }).View(), edges[k], false);
  }
}

/// Claims that the lower plate is visible up to `cut`, or hidden from there on.
truth::RegionCheck CheckPlates(double cut, double precision, bool areHidden, double tolerance = 0.0)
{
  // Seen from above at 45 degrees, the upper plate hides x > 0.5 of the lower one.
  nurbs::ModelBuilder source, regions;
  AddPlate(source, 0.0, 0.0, 1.0, tolerance);
  AddPlate(source, 0.5, 0.0, 1.0, tolerance);
  AddPlate(regions, 0.0, areHidden ? cut : 0.0, areHidden ? 1.0 : cut);
  std::vector<std::int64_t> sources{ 0 };
  if (!areHidden)
  {
    AddPlate(regions, 0.5);
    sources.push_back(1);
  }
  const Scene scene(source), output(regions);
  const truth::ImageView view =
    truth::ImageView::Parallel(scene.Caster.Bounds(), Vec3(-1.0, 0.0, 1.0));
  return truth::RegionTruth(
    scene.Caster, output.Assembled.Model, sources, view, precision, areHidden, nurbs::SerialFor)
    .Check(40000, 5);
}

} // namespace

TEST(RegionTruth, AgreesWithRightRegionsOnly)
{
  // The shadow of the upper plate's x = 0 falls on x = 0.5.
  const truth::RegionCheck right = CheckPlates(0.5, 1e-6, false);
  EXPECT_NEAR(static_cast<double>(right.Rays), 40000.0, 400.0);
  EXPECT_EQ(right.Agree + right.Within, right.Hits);
  EXPECT_LE(right.Within, 2);
  EXPECT_GT(right.Hits, right.Rays / 2);

  // Off by 0.01: 0.01 / sqrt(2) in the image.
  const truth::RegionCheck wrong = CheckPlates(0.51, 1e-4, false);
  const double strip = 0.01 * std::sqrt(0.5), whole = (2.0 + 0.5 - 0.5) * std::sqrt(0.5);
  EXPECT_NEAR(
    static_cast<double>(wrong.Wrong + wrong.Near + wrong.Narrow + wrong.Within) / wrong.Rays,
    strip / (1.5 * std::sqrt(0.5)), 0.1 * strip / whole + 2e-3);
  EXPECT_GT(wrong.Wrong, 200);
  EXPECT_NEAR(wrong.Worst, strip / 1e-4, 2.0);
  ASSERT_EQ(wrong.List.size(), 5u);
  for (const truth::Disagreement& one : wrong.List)
  {
    EXPECT_EQ(one.Face, 0);
    EXPECT_FALSE(one.IsFront);
    EXPECT_GT(one.UV[0], 0.5);
    EXPECT_LT(one.UV[0], 0.51);
  }
  const truth::RegionCheck excused = CheckPlates(0.51, 1e-2, false);
  EXPECT_EQ(excused.Wrong + excused.Near, 0);
  EXPECT_EQ(excused.Within, wrong.Wrong + wrong.Near + wrong.Narrow + wrong.Within);
  EXPECT_GT(wrong.Narrow, 0); // Beside the upper plate's border.
}

// What edges' tolerances explain is no farther from a border than twice that; the rest stays wrong.
TEST(RegionTruth, TolerancesExplainNoMoreThanTheyReach)
{
  const truth::RegionCheck exact = CheckPlates(0.51, 1e-4, false);
  EXPECT_EQ(exact.Bridged, 0);
  const double tolerance = 1e-3;
  const truth::RegionCheck some = CheckPlates(0.51, 1e-4, false, tolerance);
  // The strip, 0.01 / sqrt(2) wide in the image, within 2 tolerances and the precision of either side.
  const double share = 2.0 * (2.0 * tolerance + 1e-4) / (0.01 * std::sqrt(0.5));
  EXPECT_NEAR(some.Bridged / double(some.Bridged + some.Wrong + some.Near), share, 0.15);
  EXPECT_GT(some.Wrong, 50);
  // A region that is off by much more is told all the same.
  const truth::RegionCheck far = CheckPlates(0.6, 1e-4, false, tolerance);
  EXPECT_GT(far.Wrong, 10 * far.Bridged);
}

TEST(RegionTruth, HiddenRegionsAreTheOthers)
{
  const truth::RegionCheck right = CheckPlates(0.5, 1e-6, true);
  EXPECT_EQ(right.Agree + right.Within, right.Hits);
  const truth::RegionCheck wrong = CheckPlates(0.4, 1e-6, true);
  EXPECT_GT(wrong.Wrong, 1000);
}

TEST(RegionTruth, NamesFacesWithoutRegion)
{
  nurbs::ModelBuilder source, none;
  AddPlate(source, 0.0);
  const Scene scene(source), output(none);
  const truth::ImageView view = truth::ImageView::Parallel(scene.Caster.Bounds(), Vec3::UnitZ());
  const truth::RegionCheck check = truth::RegionTruth(
    scene.Caster, output.Assembled.Model, {}, view, 1e-4, false, nurbs::SerialFor)
                                     .Check(1000, 0);
  EXPECT_EQ(check.MissedFaces, check.Hits);
  EXPECT_GT(check.Hits, 900);
}

TEST(ImageView, ProjectsAndCastsAlike)
{
  const nurbs::Box3 box(Vec3(-1, -2, -1), Vec3(3, 1, 2));
  for (const bool isEye : { false, true })
  {
    const truth::ImageView view = isEye ? truth::ImageView::FromEye(box, Vec3(5, 6, 7))
                                        : truth::ImageView::Parallel(box, Vec3(5, 6, 7));
    const Vec3 point(0.3, 0.4, 1.7);
    const nurbs::Ray ray = view.RayOf(view.Project(point), 10.0);
    EXPECT_LT((point - ray.Origin).normalized().cross(ray.Direction).norm(), 1e-14);
    EXPECT_GT((point - ray.Origin).dot(ray.Direction), 0.0);
    // A small step across the view is as long as in the image.
    const double step = 1e-6 / view.Scale(point);
    EXPECT_NEAR(
      (view.Project(point + step * view.Right) - view.Project(point)).norm(), 1e-6, 1e-12);
  }
}

TEST(AreaByLines, SphereAndCap)
{
  nurbs::ModelBuilder builder;
  solids::AddSphere(builder, 1.5, solids::At(Vec3(1, 2, 3), Vec3(1, 1, 2).normalized()));
  const Scene scene(builder);
  const auto half = truth::ImageView::Parallel(scene.Caster.Bounds(), Vec3(1, -2, 0.5));
  EXPECT_NEAR(
    truth::AreaByLines(scene.Caster, 0, half, 1e-5, 12, nurbs::SerialFor) / (2.0 * Pi * 1.5 * 1.5),
    1.0, 1e-4);
  const Vec3 away(1, 4, -1);
  const auto cap = truth::ImageView::FromEye(scene.Caster.Bounds(), Vec3(1, 2, 3) + away);
  EXPECT_NEAR(truth::AreaByLines(scene.Caster, 0, cap, 1e-5, 12, nurbs::SerialFor) /
      (2.0 * Pi * 1.5 * 1.5 * (1.0 - 1.5 / away.norm())),
    1.0, 1e-4);
}

TEST(AreaByLines, ToriThatHideEachOther)
{
  // Two ways that know nothing of each other: patches and rays, and polynomials.
  std::vector<reference::PlacedTorus> tori(2);
  tori[0] = { 2.0, 0.5, solids::At(Vec3::Zero()) };
  tori[1] = { 2.0, 0.4, solids::At(Vec3(2, 0, 0), Vec3::UnitY()) };
  nurbs::ModelBuilder builder;
  for (const reference::PlacedTorus& torus : tori)
  {
    solids::AddTorus(builder, torus.Radius, torus.Tube, torus.Place);
  }
  const Scene scene(builder);
  for (const Vec3& view : { Vec3(0.3, 0.5, 1.0) })
  {
    const auto image = truth::ImageView::Parallel(scene.Caster.Bounds(), view);
    for (std::size_t k = 0; k < 2; ++k)
    {
      const double expected = reference::VisibleTorusArea(tori, k, view, 4000);
      EXPECT_NEAR(truth::AreaByLines(
                    scene.Caster, static_cast<std::int64_t>(k), image, 1e-3, 64, nurbs::SerialFor) /
          expected,
        1.0, 1e-4);
      EXPECT_LT(expected, 0.49 * 4.0 * Pi * Pi * tori[k].Radius * tori[k].Tube);
    }
  }
}

TEST(VisibleTorusArea, FromAboveHalf)
{
  const std::vector<reference::PlacedTorus> one(1);
  EXPECT_NEAR(reference::VisibleTorusArea(one, 0, Vec3::UnitZ(), 10), 2.0 * Pi * Pi * 0.3, 1e-10);
}
