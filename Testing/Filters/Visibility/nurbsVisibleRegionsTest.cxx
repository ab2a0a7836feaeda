// SPDX-License-Identifier: BSD-3-Clause
// Visible regions against lines of sight over the whole image, and areas against closed forms.
#include "RegionArea.h"
#include "Shapes.h"
#include "nurbsModelShapes.h"
#include "nurbsRegionReference.h"
#include "nurbsTorusVisibility.h"

#include <gtest/gtest.h>

namespace
{

using namespace reference;

constexpr double PI = 3.141592653589793238462643383280;

struct Case
{
  nurbs::ModelBuilder Builder;
  nurbs::AssembledModel Made;
  VisibleRegions Result;

  void Run(const Viewer& viewer, double precision, bool clustering = false)
  {
    this->Made = nurbs::AssembleModel(this->Builder.Arrays());
    VisibleRegionOptions options;
    options.View = viewer;
    options.Precision = precision;
    options.Clustering = clustering;
    this->Result = nurbs::MakeVisibleRegions(this->Made.Model, this->Made.FaceErrors, options);
  }
  double VisibleArea() const
  {
    double sum = 0.0;
    for (const nurbs::FaceRegion& face : this->Result.Faces)
    {
      sum += face.VisibleArea;
    }
    return sum;
  }
  void Check(double precision, int n) const
  {
#ifdef NURBS_SANITIZE
    n /= 2; // Sanitizers are slow, and look for other things.
#endif
    const RegionCheck check = CheckRegions(this->Made.Model, this->Result, precision, n);
    EXPECT_GT(check.Fronts, n * n / 20);
    EXPECT_EQ(check.Wrong, 0) << "first at " << check.FirstWrong.transpose() << " face "
                              << check.WrongFace << (check.WrongIsFront ? " front" : " behind");
    EXPECT_LT(check.Near, n * n / 50);
  }
};

const Viewer Views[] = { Direction(0, 0, 1), Direction(0, -1, 0), Direction(1, 0, 0),
  Direction(1, -1, 1), Direction(0.3, -0.5, 0.2), Direction(-0.2, 0.9, -0.6), Eye(9, -7, 5) };

} // namespace

TEST(VisibleRegions, Sphere)
{
  for (const Viewer& viewer : Views)
  {
    Case sphere;
    nurbs::AddSphere(sphere.Builder, 2.0);
    sphere.Run(viewer, 1e-3);
    sphere.Check(1e-3, 60);
    const double distance = viewer.Place.norm();
    const double exact = viewer.Perspective ? 2.0 * PI * 4.0 * (1.0 - 2.0 / distance) : 8.0 * PI;
    EXPECT_NEAR(sphere.VisibleArea(), exact, 2e-3 * exact);
  }
}

TEST(VisibleRegions, SphereToSixDigits)
{
  Case sphere;
  nurbs::AddSphere(sphere.Builder, 1.0);
  sphere.Run(Direction(0.3, -0.5, 0.2), 1e-7);
  EXPECT_NEAR(sphere.VisibleArea(), 2.0 * PI, 1e-6);
}

TEST(VisibleRegions, Cylinder)
{
  for (const Viewer& viewer : Views)
  {
    Case cylinder;
    nurbs::AddCylinder(cylinder.Builder, 1.0, 2.0, true);
    cylinder.Run(viewer, 1e-3);
    cylinder.Check(1e-3, 60);
    if (!viewer.Perspective)
    {
      const Vec3 d = viewer.Place;
      const double side = std::hypot(d[0], d[1]) > 1e-9 ? 2.0 * PI : 0.0;
      const double cap = std::abs(d[2]) > 1e-9 ? PI : 0.0;
      EXPECT_NEAR(cylinder.VisibleArea(), side + cap, 5e-3);
    }
  }
}

TEST(VisibleRegions, Torus)
{
  for (const Viewer& viewer : Views)
  {
    Case torus;
    nurbs::AddTorus(torus.Builder, 2.0, 0.7);
    torus.Run(viewer, 1e-3);
    torus.Check(1e-3, 80);
  }
}

TEST(VisibleRegions, Prism)
{
  for (const Viewer& viewer : Views)
  {
    Case prism;
    shapes::AddPrism(prism.Builder);
    prism.Run(viewer, 1e-3);
    prism.Check(1e-3, 60);
  }
}

TEST(VisibleRegions, Ball)
{
  for (const Viewer& viewer : Views)
  {
    Case ball;
    shapes::AddBall(ball.Builder, true);
    ball.Run(viewer, 1e-3);
    ball.Check(1e-3, 60);
  }
}

TEST(VisibleRegions, Teapot)
{
  for (const Viewer& viewer : Views)
  {
    Case teapot;
    nurbs::AddTeapot(teapot.Builder);
    teapot.Run(viewer, 1e-3);
    teapot.Check(1e-3, 80);
    EXPECT_EQ(teapot.Result.Piercing.size(), 0u);
  }
}

// Two unit spheres; the second one's middle is given.
struct TwoSpheres : Case
{
  explicit TwoSpheres(const Vec3& middle)
  {
    nurbs::AddSphere(this->Builder, 1.0);
    const std::size_t first = this->Builder.Data.Points.size();
    nurbs::AddSphere(this->Builder, 1.0);
    for (std::size_t k = first; k < this->Builder.Data.Points.size(); k += 3)
    {
      Eigen::Map<Vec3>(this->Builder.Data.Points.data() + k) += middle;
    }
  }
};

TEST(VisibleRegions, PiercingSpheres)
{
  for (const Viewer& viewer : Views)
  {
    for (const double precision : { 1e-2, 1e-3, 1e-4 })
    {
      TwoSpheres spheres(Vec3(0.5, -0.3, 0.6));
      spheres.Run(viewer, precision);
      spheres.Check(precision, 80);
      EXPECT_EQ(spheres.Result.Piercing.size(), 0u);
    }
  }
}

TEST(VisibleRegions, AreaOfPiercingSpheres)
{
  const Vec3 middle(0.5, -0.3, 0.6);
  const Vec3 across = middle.cross(Vec3(1.0, 0.2, 0.0)).normalized();
  for (const double precision : { 1e-3, 1e-5 })
  {
    // From the side, half of what is outside of the other one is visible of both: 2 pi (1 + d / 2) each.
    TwoSpheres spheres(middle);
    spheres.Run(Direction(across[0], across[1], across[2]), precision);
    const double exact = 2.0 * PI * (1.0 + 0.5 * middle.norm());
    EXPECT_NEAR(spheres.VisibleArea(), exact, 5.0 * precision);
    // Along the axis, the rear one hides behind the front one's half.
    TwoSpheres behind(middle);
    behind.Run(Direction(middle[0], middle[1], middle[2]), precision);
    EXPECT_NEAR(behind.VisibleArea(), 2.0 * PI, 50.0 * precision);
  }
}

// The silhouette crosses the seam where it has a cusp, and all run together in the image for a few pixels:
// borders that are taken back from there cross.
TEST(VisibleRegions, TorusWithACuspAtTheSeam)
{
  const double exact = VisibleTorusArea({ { 1.0, 0.3 } }, 0, Vec3(0.3, -0.9, 0.2), 2000);
  for (const double precision : { 4e-2, 1e-3, 4e-4 })
  {
    for (const bool clustering : { false, true })
    {
      Case torus;
      nurbs::AddTorus(torus.Builder, 1.0, 0.3);
      torus.Run(Direction(0.3, -0.9, 0.2), precision, clustering);
      torus.Check(precision, 160);
      EXPECT_EQ(CountCrossings(torus.Result), 0);
      // The precision times the length of the border, which is longer on the surface than in the image.
      EXPECT_NEAR(torus.VisibleArea(), exact, 5.0 * precision);
    }
  }
}

// Seen along its seams or nearly so, faces have parts that are narrower than the precision in the image
// and large nonetheless.
TEST(VisibleRegions, AreasAtGrazingViews)
{
  for (const Vec3& view : { Vec3(1.0, 0.02, 0.01), Vec3(0.01, 0.02, 1.0), Vec3(0.02, 1.0, -0.01) })
  {
    for (const double precision : { 3e-2, 3e-3, 3e-4 })
    {
      Case sphere;
      nurbs::AddSphere(sphere.Builder, 1.0);
      sphere.Run(Direction(view[0], view[1], view[2]), precision);
      EXPECT_NEAR(sphere.VisibleArea(), 2.0 * PI, precision) << view.transpose();
      EXPECT_EQ(CountCrossings(sphere.Result), 0);
      Case torus;
      nurbs::AddTorus(torus.Builder, 1.0, 0.3);
      torus.Run(Direction(view[0], view[1], view[2]), precision);
      const double exact = VisibleTorusArea({ { 1.0, 0.3 } }, 0, view, 2000);
      EXPECT_NEAR(torus.VisibleArea(), exact, 10.0 * precision) << view.transpose();
      EXPECT_EQ(CountCrossings(torus.Result), 0);
    }
  }
}

// Hidden and visible regions share a face out.
// A generator that is seen end-on is one point with the apex, where the rim touches it: no line divides the
// image there, and the domain is not to lose what lies on either side of it.
TEST(VisibleRegions, ConeAlongAGenerator)
{
  Case cone;
  nurbs::AddCone(cone.Builder, 1.0, 2.0, false);
  cone.Run(Direction(0.5, 0.0, 1.0), 2e-3);
  cone.Check(2e-3, 60);
  EXPECT_NEAR(cone.VisibleArea(), PI * std::sqrt(5.0), 1e-3);
}

// Into an open tube, nearly along it: the far rim passes a few pixels beside the shadow of the near one.
TEST(VisibleRegions, IntoATube)
{
  const struct
  {
    double Height, Slope, Angle, Precision, Tolerance;
  } cases[] = { { 0.5, 0.35, 1.7, 1e-3, 2e-3 }, { 0.5, 0.23, 0.3, 1e-4, 1e-3 } };
  for (const auto& one : cases)
  {
    Case tube;
    nurbs::AddCylinder(tube.Builder, 1.0, one.Height, false);
    tube.Run(Direction(one.Slope * std::cos(one.Angle), one.Slope * std::sin(one.Angle), 1.0),
      one.Precision);
    // Half of the outside; and of the inside what is as near to the rim as the ray through it reaches:
    // the integral of min(height, 2 cos(x) / slope).
    const double x = std::asin(one.Slope * one.Height / 2.0);
    const double exact =
      2.0 * PI * one.Height - 2.0 * one.Height * x + 4.0 / one.Slope * (1.0 - std::cos(x));
    EXPECT_NEAR(tube.VisibleArea(), exact, one.Tolerance) << "slope " << one.Slope;
  }
}

TEST(VisibleRegions, HiddenIsTheRest)
{
  for (const Viewer& viewer : Views)
  {
    Case torus;
    nurbs::AddTorus(torus.Builder, 2.0, 0.7);
    torus.Run(viewer, 1e-2);
    VisibleRegionOptions options;
    options.View = viewer;
    options.Precision = 1e-2;
    options.HiddenRegions = true;
    Case hidden;
    hidden.Result = nurbs::MakeVisibleRegions(torus.Made.Model, torus.Made.FaceErrors, options);
    const Model& model = hidden.Result.Lines.Whole.Data;
    EXPECT_NEAR(torus.VisibleArea() + nurbs::FaceArea(model, 0).Of(hidden.Result.Faces[0].Loops),
      4.0 * PI * PI * 2.0 * 0.7, 1e-6);
    EXPECT_EQ(CountCrossings(hidden.Result), 0);
  }
}

struct Rectangle
{
  Vec2 Low, High;
};

// A plane [0, 4] x [0, 2] whose parameters are lengths, with rectangular loops: the first one is the
// border, others are holes. `range`: of the trim curves' parameters.
void AddPlate(nurbs::ModelBuilder& builder, const std::vector<Rectangle>& loops,
  const nurbs::Interval& range = { 0.0, 1.0 })
{
  nurbs::Surface plate;
  plate.Degree[0] = plate.Degree[1] = 1;
  plate.Count[0] = plate.Count[1] = 2;
  plate.Knots[0] = { 0.0, 0.0, 4.0, 4.0 };
  plate.Knots[1] = { 0.0, 0.0, 2.0, 2.0 };
  plate.Points = { Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 2, 0), Vec3(4, 2, 0) };
  builder.BeginFace(plate.View(), nurbs::FaceAttributes());
  for (const Rectangle& loop : loops)
  {
    const bool isHole = &loop != &loops.front();
    const Vec2 corners[4] = { loop.Low, { loop.High[0], loop.Low[1] }, loop.High,
      { loop.Low[0], loop.High[1] } };
    builder.BeginLoop();
    for (int k = 0; k < 4; ++k)
    {
      const int from = isHole ? 3 - k : k;
      const int to = isHole ? (6 - k) % 4 : (k + 1) % 4;
      builder.AddTrimCurve(nurbs::TrimLine(corners[from], corners[to], range).View(), -1, false);
    }
  }
}

// A plate of 4 x 2 with two holes, both narrower than the precision in the image, one of them long.
TEST(VisibleRegions, HolesNarrowerThanThePrecision)
{
  for (const Viewer& viewer :
    { Direction(0, 0, 1), Direction(0.3, -0.5, 0.2), Direction(3, 1, 0.1) })
  {
    Case holes;
    AddPlate(holes.Builder,
      { { Vec2(0, 0), Vec2(4, 2) }, { Vec2(1, 1), Vec2(1.005, 1.004) },
        { Vec2(2, 0.5), Vec2(2.004, 1.5) } });
    holes.Run(viewer, 1e-2);
    const double exact = 8.0 - 0.005 * 0.004 - 0.004 * 1.0;
    EXPECT_NEAR(holes.VisibleArea(), exact, 1e-9);
    EXPECT_TRUE(holes.Result.Faces[0].IsWhole);
  }
}

// Of a trim curve whose parameters are large, as those of files are, only so many places are told apart.
TEST(VisibleRegions, CutsThatParametersDoNotTellApart)
{
  const nurbs::Interval range{ -291599.719406, -291599.669406 };
  nurbs::ModelBuilder builder;
  AddPlate(builder, { { Vec2(0, 0), Vec2(4, 2) } }, range);
  const nurbs::AssembledModel made = nurbs::AssembleModel(builder.Arrays());
  nurbs::ViewLines lines;
  lines.Whole = nurbs::CompleteModel(made.Model, made.FaceErrors);
  nurbs::RegionLoop loop(4);
  const double shares[] = { 0.0, 0.26, 0.26 + 1e-11, 1.0 - 1e-12 };
  for (int k = 0; k < 3; ++k)
  {
    loop[k].Curve = 0;
    loop[k].From = shares[k];
    loop[k].To = shares[k + 1];
  }
  loop[3].Polyline = { nurbs::EndOfPiece(made.Model, loop[2], true), Vec2(2, 1), Vec2(0, 0) };
  std::vector<std::vector<nurbs::RegionLoop>> regions{ { loop } };
  nurbs::CutAtSharedEnds(lines, regions);
  const nurbs::RegionLoop& cut = regions[0][0];
  ASSERT_EQ(cut.size(), 3u);
  EXPECT_EQ(cut[0].To, cut[1].From);
  EXPECT_EQ(cut[1].To, 1.0);
  EXPECT_EQ(cut[2].Polyline.front(), nurbs::EndOfPiece(made.Model, cut[1], true));
  for (int k = 0; k < 2; ++k)
  {
    const double low = range.Min + cut[k].From * range.Length();
    const double high = cut[k].To == 1.0 ? range.Max : range.Min + cut[k].To * range.Length();
    EXPECT_NO_THROW(nurbs::Restrict(made.Model.TrimCurves[0].Geometry, low, high));
  }
}
