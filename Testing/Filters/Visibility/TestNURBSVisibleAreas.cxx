// SPDX-License-Identifier: BSD-3-Clause
// Visible areas to six digits, against closed forms and against what polynomials alone tell of tori.
#include "nurbsSolids.h"
#include "nurbsTorusVisibility.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSVisibleRegions.h"

#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <numeric>

namespace
{

using nurbs::Vec3;

constexpr double Pi = 3.14159265358979323846;
constexpr double Digits = 1e-6;

double VisibleArea(nurbs::ModelBuilder& builder, const Vec3& place, bool isEye)
{
  vtkNew<vtkUnstructuredGrid> model;
  vtkNURBSModel::Store(builder, model);
  vtkNew<vtkNURBSVisibleRegions> filter;
  filter->SetInputDataObject(model);
  isEye ? filter->SetProjectionToPerspective() : filter->SetProjectionToParallel();
  filter->SetDirection(place[0], place[1], place[2]);
  filter->SetEyePoint(place[0], place[1], place[2]);
  filter->SetPrecision(1e-7);
  filter->Update();
  return filter->GetVisibleArea();
}

const std::vector<Vec3> Views = { Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0.3, -0.9, 0.2),
  Vec3(-1, 1, -2) };

TEST(VisibleAreas, HalfOfASphere)
{
  const double radius = 1.7;
  for (const Vec3& view : Views)
  {
    nurbs::ModelBuilder builder;
    solids::AddSphere(builder, radius, solids::At(Vec3(3, -1, 2)));
    EXPECT_NEAR(VisibleArea(builder, view, false) / (2.0 * Pi * radius * radius), 1.0, Digits)
      << view.transpose();
  }
}

TEST(VisibleAreas, CapOfASphereSeenFromNearby)
{
  const double radius = 1.7;
  const Vec3 center(3, -1, 2);
  for (const double distance : { 3.0, 10.0 })
  {
    const Vec3 eye = center + distance * Vec3(2, -1, 2) / 3.0;
    nurbs::ModelBuilder builder;
    solids::AddSphere(builder, radius, solids::At(center));
    const double cap = 2.0 * Pi * radius * radius * (1.0 - radius / distance);
    EXPECT_NEAR(VisibleArea(builder, eye, true) / cap, 1.0, Digits) << distance;
  }
}

TEST(VisibleAreas, TorusAtSeveralAngles)
{
  // From above half of it; then it hides more and more of itself.
  const std::vector<reference::PlacedTorus> torus{ { 2.0, 0.7, solids::At(Vec3::Zero()) } };
  for (const double degrees : { 0.0, 20.0, 55.0, 75.0, 89.0 })
  {
    const Vec3 view(std::sin(degrees * Pi / 180.0), 0.0, std::cos(degrees * Pi / 180.0));
    nurbs::ModelBuilder builder;
    solids::AddTorus(builder, 2.0, 0.7, solids::At(Vec3::Zero()));
    const double expected = reference::VisibleTorusArea(torus, 0, view, 2000);
    const double coarse = reference::VisibleTorusArea(torus, 0, view, 1000);
    ASSERT_NEAR(coarse / expected, 1.0, Digits) << degrees;
    EXPECT_NEAR(VisibleArea(builder, view, false) / expected, 1.0, Digits) << degrees;
  }
}

TEST(VisibleAreas, InterlockedTori)
{
  const std::vector<reference::PlacedTorus> tori{ { 2.0, 0.5, solids::At(Vec3::Zero()) },
    { 2.0, 0.4, solids::At(Vec3(2, 0, 0), Vec3::UnitY()) } };
  struct
  {
    Vec3 View;
    double Area; ///< Of reference::VisibleTorusArea with 64,000 lines of 1,800 points: 3e-7 off.
  } const cases[] = { { Vec3(0.3, 0.5, 1.0), 32.3444 }, { Vec3(1.0, 0.6, 0.5), 28.60646 } };
  for (const auto& one : cases)
  {
    nurbs::ModelBuilder builder;
    double coarse = 0.0;
    for (std::size_t k = 0; k < tori.size(); ++k)
    {
      solids::AddTorus(builder, tori[k].Radius, tori[k].Tube, tori[k].Place);
      coarse += reference::VisibleTorusArea(tori, k, one.View, 2000);
    }
    ASSERT_NEAR(coarse / one.Area, 1.0, 3e-5);
    EXPECT_NEAR(VisibleArea(builder, one.View, false) / one.Area, 1.0, Digits)
      << one.View.transpose();
  }
}

TEST(VisibleAreas, PiercingSpheres)
{
  // Seen from the side, half of what is outside of the other one: 2 pi (1 + d / 2) of both together.
  const Vec3 middle(0.5, -0.3, 0.6);
  for (const Vec3& view : { Vec3(0.6, 0.0, -0.5), Vec3(0.3, 0.5, 0.0) })
  {
    nurbs::ModelBuilder builder;
    solids::AddSphere(builder, 1.0, solids::At(Vec3::Zero()));
    solids::AddSphere(builder, 1.0, solids::At(middle));
    const double exact = 2.0 * Pi * (1.0 + 0.5 * middle.norm());
    EXPECT_NEAR(VisibleArea(builder, view, false) / exact, 1.0, Digits) << view.transpose();
  }
}

TEST(VisibleAreas, IntersectionsAreLines)
{
  nurbs::ModelBuilder builder;
  solids::AddSphere(builder, 1.0, solids::At(Vec3::Zero()));
  solids::AddSphere(builder, 1.0, solids::At(Vec3(0.0, 1.0, 0.0)));
  vtkNew<vtkUnstructuredGrid> model;
  vtkNURBSModel::Store(builder, model);
  vtkNew<vtkNURBSVisibleRegions> filter;
  filter->SetInputDataObject(model);
  filter->SetDirection(1.0, 0.2, 0.3);
  EXPECT_TRUE(filter->GetIntersections());
  for (const bool drawn : { true, false })
  {
    filter->SetIntersections(drawn);
    filter->Update();
    vtkDataArray* kinds = filter->GetLines()->GetCellData()->GetArray("Kind");
    vtkDataArray* visible = filter->GetLines()->GetCellData()->GetArray("Visibility");
    int count[2] = { 0, 0 };
    for (vtkIdType k = 0; k < kinds->GetNumberOfTuples(); ++k)
    {
      count[int(visible->GetTuple1(k))] += kinds->GetTuple1(k) == 4.0;
    }
    EXPECT_EQ(count[0] > 0, drawn);
    EXPECT_EQ(count[1] > 0, drawn);
    EXPECT_EQ(filter->GetNumberOfPiercingPairs(), 0);
  }
}

TEST(VisibleAreas, StackedBoxes)
{
  // A slab of 8 x 6 x 1 with a block of 2 x 1.5 x 2 over it, at a distance or standing on it. The
  // block's shadow on the slab's top is its base swept by the way from base to top.
  const Vec3 view(1.0, 0.6, 2.0);
  for (const double gap : { 0.0, 0.25 })
  {
    nurbs::ModelBuilder builder;
    solids::AddBox(builder, Vec3(4, 3, 0.5), solids::At(Vec3(0, 0, -0.5)));
    solids::AddBox(builder, Vec3(1, 0.75, 1), solids::At(Vec3(0.5, 0.2, 1.0 + gap)));
    const double shadow = 2.0 * 1.5 + 2.0 * 1.5 * (1.0 / 2.0) + 2.0 * 2.0 * (0.6 / 2.0);
    const double slab = 8.0 * 6.0 - shadow + 8.0 * 1.0 + 6.0 * 1.0;
    const double block = 2.0 * 1.5 + 2.0 * 2.0 + 1.5 * 2.0;
    EXPECT_NEAR(VisibleArea(builder, view, false) / (slab + block), 1.0, Digits) << gap;
  }
}

} // namespace
