// SPDX-License-Identifier: BSD-3-Clause
// vtkNURBSVisibleRegions in pipelines: its outputs and options, where it is seen from, composite
// inputs, threads, progress and abort. References: areas of simple shapes in closed form.
#include "vtkRegionScene.h"

#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkDataAssembly.h"
#include "vtkIdList.h"
#include "vtkInformation.h"
#include "vtkIntArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNURBSParallel.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkSMPTools.h"
#include "vtkWeakPointer.h"

#include <set>

namespace
{

using namespace regions;

constexpr double PI = 3.14159265358979323846;

// The length of a line, a cell.
double Length(vtkPolyData* lines, vtkIdType cell)
{
  vtkNew<vtkIdList> ids;
  lines->GetCellPoints(cell, ids);
  double sum = 0.0;
  for (vtkIdType k = 1; k < ids->GetNumberOfIds(); ++k)
  {
    double a[3], b[3];
    lines->GetPoint(ids->GetId(k - 1), a);
    lines->GetPoint(ids->GetId(k), b);
    sum += std::sqrt(vtkMath::Distance2BetweenPoints(a, b));
  }
  return sum;
}

// The length of all lines of a kind (-1: any) and visibility (-1: any).
double Length(vtkPolyData* lines, int kind, int visibility)
{
  double sum = 0.0;
  for (vtkIdType c = 0; c < lines->GetNumberOfCells(); ++c)
  {
    sum += (kind < 0 || CellValue(lines, "Kind", c) == kind) &&
        (visibility < 0 || CellValue(lines, "Visibility", c) == visibility)
      ? Length(lines, c)
      : 0.0;
  }
  return sum;
}

TEST(NURBSVisibleRegions, OutputsHaveTheArraysThatTheyTellOf)
{
  auto grid = Shape(vtkNURBSShapeSource::CYLINDER);
  vtkNew<vtkIntArray> own;
  own->SetName("Batch");
  for (const int value : { 70, 71, 72 })
  {
    own->InsertNextValue(value);
  }
  grid->GetCellData()->AddArray(own);
  vtkNew<vtkNURBSVisibleRegions> filter;
  filter->SetInputData(grid);
  filter->SetDirection(3, 1, 1);
  filter->Update();
  // The side is face 0, half visible; the bottom 1, the top 2.
  vtkUnstructuredGrid* model = Models(filter);
  ASSERT_EQ(model->GetNumberOfCells(), 2);
  EXPECT_EQ(CellValue(model, "FaceId", 0), 0);
  EXPECT_EQ(CellValue(model, "FaceId", 1), 2);
  EXPECT_EQ(CellValue(model, "Batch", 1), 72);
  EXPECT_NE(model->GetCellData()->GetArray(vtkNURBSModel::ColorName()), nullptr);
  EXPECT_NEAR(CellValue(model, "VisibleArea", 0), 2.0 * PI, 1e-3);
  EXPECT_NEAR(CellValue(model, "VisibleFraction", 0), 0.5, 1e-4);
  EXPECT_NEAR(CellValue(model, "VisibleArea", 1), PI, 1e-6);
  EXPECT_EQ(CellValue(model, "VisibleFraction", 1), 1.0);
  EXPECT_EQ(vtkNURBSModel::GetLengthUnit(model), "mm");
  EXPECT_EQ(filter->GetNumberOfFaces(), 3);
  EXPECT_EQ(filter->GetNumberOfVisibleFaces(), 1);
  EXPECT_EQ(filter->GetNumberOfPartialFaces(), 1);
  EXPECT_EQ(filter->GetNumberOfHiddenFaces(), 1);
  EXPECT_EQ(filter->GetNumberOfFailedFaces(), 0);
  EXPECT_EQ(filter->GetNumberOfPiercingPairs(), 0);
  EXPECT_NEAR(filter->GetVisibleArea(), 3.0 * PI, 1e-3);
  EXPECT_GT(filter->GetNumberOfCells(), 1);
  EXPECT_GT(filter->GetSeconds(), 0.0);

  vtkPolyData* lines = filter->GetLines();
  ASSERT_NE(lines, nullptr);
  EXPECT_EQ(lines->GetNumberOfLines(), filter->GetNumberOfLines());
  EXPECT_NE(lines->GetCellData()->GetArray("Batch"), nullptr);
  EXPECT_EQ(lines->GetPointData()->GetArray("UV")->GetNumberOfTuples(), lines->GetNumberOfPoints());
  EXPECT_NEAR(Length(lines, 0, 1), 4.0, 1e-3); // Two outlines of the side.
  EXPECT_NEAR(Length(lines, 0, 0), 0.0, 1e-3);
  EXPECT_NEAR(Length(lines, 2, 1), 3.0 * PI, 2e-3); // The upper rim and half of the lower one.
  EXPECT_NEAR(Length(lines, 2, 0), PI, 2e-3);
  vtkIdType visible = 0;
  for (vtkIdType c = 0; c < lines->GetNumberOfCells(); ++c)
  {
    visible += CellValue(lines, "Visibility", c) == 1;
    EXPECT_EQ(CellValue(lines, "EdgeId", c) < 0, CellValue(lines, "Kind", c) == 0);
    EXPECT_LT(CellValue(lines, "EdgeId", c), 3);
  }
  EXPECT_EQ(visible, filter->GetNumberOfVisibleLines());
}

TEST(NURBSVisibleRegions, PointsOfLinesAreWhereUVSays)
{
  auto grid = Shape(vtkNURBSShapeSource::VASE);
  vtkNew<vtkNURBSVisibleRegions> filter;
  filter->SetInputData(grid);
  filter->SetDirection(1, 1, 1);
  filter->SmoothEdgesOn();
  filter->Update();
  const auto view = vtkNURBSModel::View(grid);
  vtkPolyData* lines = filter->GetLines();
  vtkNew<vtkIdList> ids;
  double worst = 0.0;
  for (vtkIdType c = 0; c < lines->GetNumberOfCells(); ++c)
  {
    const nurbs::SurfaceView& surface =
      view->GetModel().Faces[std::size_t(CellValue(lines, "FaceId", c))].Geometry;
    lines->GetCellPoints(c, ids);
    for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k)
    {
      double x[3], uv[2];
      lines->GetPoint(ids->GetId(k), x);
      lines->GetPointData()->GetArray("UV")->GetTuple(ids->GetId(k), uv);
      worst = std::max(
        worst, (nurbs::Evaluate(surface, uv[0], uv[1]) - nurbs::Vec3(x[0], x[1], x[2])).norm());
    }
  }
  EXPECT_GT(lines->GetNumberOfPoints(), 500);
  EXPECT_LT(worst, 1e-9 * 226.0);
}

// What is visible and what is hidden make up the faces.
TEST(NURBSVisibleRegions, VisibleAndHiddenRegionsAddUp)
{
  for (const int shape :
    { vtkNURBSShapeSource::SPHERE, vtkNURBSShapeSource::TORUS, vtkNURBSShapeSource::CYLINDER,
      vtkNURBSShapeSource::SPRING, vtkNURBSShapeSource::VASE, vtkNURBSShapeSource::PLATE })
  {
    auto grid = Shape(shape);
    const double whole = TessellatedArea(grid);
    for (const nurbs::Vec3& d :
      { nurbs::Vec3(1, 1, 1), nurbs::Vec3(0.3, -0.8, 0.4), nurbs::Vec3(-0.5, 0.1, -0.8) })
    {
      SCOPED_TRACE(std::to_string(shape) + " from " + std::to_string(d[0]));
      vtkNew<vtkNURBSVisibleRegions> filter;
      filter->SetInputData(grid);
      filter->SetDirection(d[0], d[1], d[2]);
      filter->Update();
      const double visible = CheckedArea(Models(filter));
      EXPECT_NEAR(visible, filter->GetVisibleArea(), 2e-3 * whole);
      EXPECT_NEAR(Sum(Models(filter), "VisibleArea"), filter->GetVisibleArea(), 1e-9 * whole);
      EXPECT_GT(visible, 0.2 * whole);
      const double told = filter->GetVisibleArea();
      filter->SetRegionToHidden();
      filter->Update();
      EXPECT_EQ(filter->GetVisibleArea(), told);
      EXPECT_NEAR(visible + CheckedArea(Models(filter)), whole, 4e-3 * whole);
    }
  }
}

TEST(NURBSVisibleRegions, FacesAreSeenFromBehindAsAsked)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShapeToCylinder();
  source->CappingOff();
  vtkNew<vtkNURBSVisibleRegions> filter;
  filter->SetInputConnection(source->GetOutputPort());
  filter->SetDirection(1, 0, 1);
  filter->Update();
  // Of the inner side, at the angle a, the upper -2 cos a are seen through the open top.
  EXPECT_NEAR(filter->GetVisibleArea(), 2.0 * PI + 4.0, 2e-3);
  filter->BothSidesOff();
  filter->Update();
  EXPECT_NEAR(filter->GetVisibleArea(), 2.0 * PI, 2e-3);
  // Nothing but its back: no region, but lines.
  filter->SetInputData(Shape(vtkNURBSShapeSource::DISC));
  filter->SetDirection(0, 1, -1);
  filter->Update();
  EXPECT_EQ(Models(filter)->GetNumberOfCells(), 0);
  EXPECT_EQ(filter->GetVisibleArea(), 0.0);
  EXPECT_EQ(filter->GetNumberOfHiddenFaces(), 1);
  EXPECT_NEAR(Length(filter->GetLines(), 1, -1), 2.0 * PI, 1e-3);
  filter->BothSidesOn();
  filter->Update();
  EXPECT_NEAR(filter->GetVisibleArea(), PI, 1e-6);
}

TEST(NURBSVisibleRegions, BacksHideWhatIsBehindThem)
{
  nurbs::ModelBuilder builder;
  AddQuad(builder, { 0, 0, 1 }, { 0, 1, 1 }, { 1, 0, 1 }, { 1, 1, 1 }); // Shows its back.
  AddQuad(builder, { -1, -1, 0 }, { 2, -1, 0 }, { -1, 2, 0 }, { 2, 2, 0 });
  vtkNew<vtkNURBSVisibleRegions> filter;
  filter->SetInputData(Grid(builder));
  for (const bool both : { true, false })
  {
    filter->SetBothSides(both);
    filter->Update();
    EXPECT_NEAR(VisibleAreaOf(filter, 0), both ? 1.0 : 0.0, 1e-9);
    EXPECT_NEAR(VisibleAreaOf(filter, 1), 8.0, 5e-3);
  }
}

TEST(NURBSVisibleRegions, LinesAreMadeAsAsked)
{
  nurbs::ModelBuilder builder;
  AddBox(builder, { 0, 0, 0 }, { 1, 2, 3 });
  vtkNew<vtkNURBSVisibleRegions> filter;
  filter->SetInputData(Grid(builder));
  filter->SetDirection(1, 1, 1);
  filter->Update();
  EXPECT_NEAR(Length(filter->GetLines(), 2, 1), 18.0, 1e-3); // Nine edges are seen, three are not.
  EXPECT_NEAR(Length(filter->GetLines(), 2, 0), 6.0, 1e-3);
  EXPECT_NEAR(Length(filter->GetLines(), -1, -1), 24.0, 1e-3);
  filter->HiddenLinesOff();
  filter->Update();
  EXPECT_NEAR(Length(filter->GetLines(), -1, 1), 18.0, 1e-3);
  EXPECT_EQ(Length(filter->GetLines(), -1, 0), 0.0);
  EXPECT_EQ(filter->GetNumberOfLines(), filter->GetNumberOfVisibleLines());
  filter->SetFeatureAngle(95.0); // Then all edges are smooth; six are outlines, too.
  filter->Update();
  EXPECT_EQ(Length(filter->GetLines(), 2, -1), 0.0);
  EXPECT_NEAR(Length(filter->GetLines(), 0, -1), 12.0, 1e-3);
  EXPECT_EQ(Length(filter->GetLines(), 3, -1), 0.0);
  filter->SmoothEdgesOn();
  filter->Update();
  EXPECT_NEAR(Length(filter->GetLines(), 3, -1), 18.0, 1e-3);

  filter->SetInputData(Shape(vtkNURBSShapeSource::CONE));
  filter->SetFeatureAngle(30.0);
  filter->SetDirection(1, 0, 0);
  for (int k = 0; k < 16; ++k)
  {
    filter->SetSilhouettes(k & 1);
    filter->SetBoundaryEdges(k & 2);
    filter->SetSharpEdges(k & 4);
    filter->SetSmoothEdges(k & 8);
    filter->Update();
    EXPECT_EQ(Length(filter->GetLines(), 0, -1) > 0.0, bool(k & 1));
    EXPECT_EQ(Length(filter->GetLines(), 1, -1) > 0.0, false);
    EXPECT_EQ(Length(filter->GetLines(), 2, -1) > 0.0, bool(k & 4));
    EXPECT_EQ(Length(filter->GetLines(), 3, -1) > 0.0, bool(k & 8));
    EXPECT_NEAR(filter->GetVisibleArea(), 0.5 * PI * std::sqrt(5.0), 1e-3);
  }
}

// The same drawing, and a model of nothing. Without smooth edges, those that hide nothing are not looked
// at: the end of a silhouette that hides itself is elsewhere within the precision, which is far along it.
TEST(NURBSVisibleRegions, DrawingsNeedNoRegions)
{
  for (const bool smooth : { false, true })
  {
    vtkNew<vtkNURBSVisibleRegions> filters[2];
    for (int k = 0; k < 2; ++k)
    {
      filters[k]->SetInputData(Shape(vtkNURBSShapeSource::TEAPOT));
      filters[k]->SetDirection(1, -2, 1);
      filters[k]->SetSmoothEdges(smooth);
      filters[k]->SetComputeRegions(k == 0);
      filters[k]->Update();
      EXPECT_EQ(filters[k]->GetNumberOfFaces(), 32);
      EXPECT_EQ(Models(filters[k])->GetNumberOfCells() > 0, k == 0);
      EXPECT_EQ(filters[k]->GetVisibleArea() > 0.0, k == 0);
      EXPECT_EQ(filters[k]->GetNumberOfVisibleFaces() > 0, k == 0);
      EXPECT_EQ(filters[k]->GetNumberOfPartialFaces() > 0, k == 0);
      EXPECT_EQ(filters[k]->GetNumberOfHiddenFaces() > 0, k == 0);
    }
    EXPECT_EQ(filters[0]->GetNumberOfCells() > filters[1]->GetNumberOfCells(), !smooth);
    ASSERT_GT(filters[0]->GetNumberOfLines(), filters[0]->GetNumberOfVisibleLines());
    EXPECT_EQ(filters[0]->GetNumberOfVisibleLines(), filters[1]->GetNumberOfVisibleLines());
    for (int kind = 0; kind <= 4; ++kind)
    {
      for (int visible = 0; visible < 2; ++visible)
      {
        EXPECT_NEAR(Length(filters[0]->GetLines(), kind, visible),
          Length(filters[1]->GetLines(), kind, visible), smooth ? 0.0 : 0.1);
      }
    }
  }
}

// The bounds of projected lines.
std::array<double, 6> ProjectedBounds(vtkNURBSVisibleRegions* filter)
{
  filter->ProjectLinesOn();
  filter->Update();
  std::array<double, 6> out;
  filter->GetLines()->GetBounds(out.data());
  return out;
}

TEST(NURBSVisibleRegions, ProjectedLinesAreTrueToSize)
{
  // A flag at x in [1, 3], z in [2, 3], with a pole along z down from it, in the plane y = 5.
  nurbs::ModelBuilder builder;
  AddQuad(builder, { 1, 5, 2 }, { 3, 5, 2 }, { 1, 5, 3 }, { 3, 5, 3 });
  AddQuad(builder, { 1, 5, 0 }, { 1.25, 5, 0 }, { 1, 5, 2 }, { 1.25, 5, 2 });
  vtkNew<vtkNURBSVisibleRegions> filter;
  filter->SetInputData(Grid(builder));
  filter->SetDirection(0, -1, 0);
  const std::array<double, 6> front = ProjectedBounds(filter);
  EXPECT_NEAR(front[1] - front[0], 2.0, 1e-12);
  EXPECT_NEAR(front[3] - front[2], 3.0, 1e-12);
  EXPECT_EQ(front[4], 0.0);
  EXPECT_EQ(front[5], 0.0);
  EXPECT_NEAR(Length(filter->GetLines(), -1, -1), 6.0 + 4.5, 1e-3);
  // x is to the right and z upwards: the pole's foot is at the lower left.
  const auto hasPoint = [&](double x, double y) {
    for (vtkIdType k = 0; k < filter->GetLines()->GetNumberOfPoints(); ++k)
    {
      double p[3];
      filter->GetLines()->GetPoint(k, p);
      if (std::hypot(p[0] - x, p[1] - y) < 1e-9)
      {
        return true;
      }
    }
    return false;
  };
  EXPECT_TRUE(hasPoint(front[0], front[2]));
  EXPECT_TRUE(hasPoint(front[0], front[3]));
  EXPECT_TRUE(hasPoint(front[1], front[3]));
  EXPECT_FALSE(hasPoint(front[1], front[2]));
  filter->SetDirection(0, 1, 0); // From the other side: lower right.
  const std::array<double, 6> rear = ProjectedBounds(filter);
  EXPECT_TRUE(hasPoint(rear[1], rear[2]));
  EXPECT_FALSE(hasPoint(rear[0], rear[2]));
  filter->SetDirection(0, -1, 0);
  filter->SetViewUp(1, 0, 0); // z to the left: the foot is at the lower right.
  const std::array<double, 6> lying = ProjectedBounds(filter);
  EXPECT_NEAR(lying[1] - lying[0], 3.0, 1e-12);
  EXPECT_NEAR(lying[3] - lying[2], 2.0, 1e-12);
  EXPECT_TRUE(hasPoint(lying[1], lying[2]));
  EXPECT_FALSE(hasPoint(lying[1], lying[3]));
  // A view along ViewUp has y upwards.
  nurbs::ModelBuilder wide;
  AddQuad(wide, { 0, 0, 0 }, { 7, 0, 0 }, { 0, 4, 0 }, { 7, 4, 0 });
  filter->SetInputData(Grid(wide));
  filter->SetDirection(0, 0, 1);
  filter->SetViewUp(0, 0, 1);
  const std::array<double, 6> top = ProjectedBounds(filter);
  EXPECT_NEAR(top[1] - top[0], 7.0, 1e-12);
  EXPECT_NEAR(top[3] - top[2], 4.0, 1e-12);
}

TEST(NURBSVisibleRegions, CamerasAreFollowed)
{
  vtkNew<vtkCamera> camera;
  camera->SetFocalPoint(0, 0, 0);
  camera->SetPosition(7, -4, 3);
  camera->SetViewUp(0, 0, 1);
  vtkNew<vtkNURBSVisibleRegions> byCamera;
  byCamera->SetInputData(Shape(vtkNURBSShapeSource::TORUS));
  byCamera->SetCamera(camera);
  byCamera->ProjectLinesOn();
  byCamera->SetViewUp(0, 1, 0); // The camera's goes before.
  vtkNew<vtkNURBSVisibleRegions> byPlace;
  byPlace->SetInputData(Shape(vtkNURBSShapeSource::TORUS));
  byPlace->ProjectLinesOn();
  byPlace->SetDirection(7, -4, 3);
  byPlace->SetEyePoint(7, -4, 3);
  double areas[2];
  for (const bool perspective : { true, false })
  {
    camera->SetParallelProjection(!perspective);
    byPlace->SetProjection(
      perspective ? vtkNURBSViewAlgorithm::PERSPECTIVE : vtkNURBSViewAlgorithm::PARALLEL);
    byCamera->Update();
    byPlace->Update();
    areas[perspective] = byCamera->GetVisibleArea();
    EXPECT_NEAR(byCamera->GetVisibleArea(), byPlace->GetVisibleArea(), 1e-3);
    double a[6], b[6];
    byCamera->GetLines()->GetBounds(a);
    byPlace->GetLines()->GetBounds(b);
    for (int k = 0; k < 6; ++k)
    {
      EXPECT_NEAR(a[k], b[k], 1e-6);
    }
    if (perspective)
    {
      ExpectSame(byCamera, byPlace);
    }
  }
  EXPECT_GT(areas[0], areas[1] + 0.1);
}

// A sphere of radius 1 from the distance d shows 2 pi (1 - 1 / d).
TEST(NURBSVisibleRegions, AnotherViewIsAnotherResult)
{
  vtkNew<vtkNURBSVisibleRegions> filter;
  filter->SetInputData(Shape(vtkNURBSShapeSource::SPHERE));
  filter->SetProjectionToPerspective();
  for (const double distance : { 2.0, 5.0, 100.0 })
  {
    filter->SetEyePoint(0.6 * distance, -0.64 * distance, 0.48 * distance);
    filter->Update();
    EXPECT_NEAR(filter->GetVisibleArea(), 2.0 * PI * (1.0 - 1.0 / distance), 5e-3) << distance;
    EXPECT_EQ(filter->GetNumberOfFaces(), 1);
  }
  filter->SetProjectionToParallel();
  filter->Update();
  EXPECT_NEAR(filter->GetVisibleArea(), 2.0 * PI, 5e-3);
  const vtkMTimeType made = filter->GetLines()->GetMTime();
  filter->Update();
  EXPECT_EQ(filter->GetLines()->GetMTime(), made);
  filter->SetInputData(Shape(vtkNURBSShapeSource::DISC));
  filter->Update();
  EXPECT_NEAR(filter->GetVisibleArea(), PI, 1e-6);
}

TEST(NURBSVisibleRegions, WhatIsKeptForTheNextViewChangesNothing)
{
  auto grid = Shape(vtkNURBSShapeSource::TORUS);
  const auto expectAsNew = [&](vtkNURBSVisibleRegions* kept) {
    kept->Update();
    vtkNew<vtkNURBSVisibleRegions> fresh;
    fresh->SetInputData(grid);
    fresh->SetDirection(kept->GetDirection());
    fresh->SetPrecision(kept->GetPrecision());
    fresh->Update();
    vtkPoints* const a = kept->GetLines()->GetPoints();
    vtkPoints* const b = fresh->GetLines()->GetPoints();
    ASSERT_GT(a->GetNumberOfPoints(), 10);
    ASSERT_EQ(a->GetNumberOfPoints(), b->GetNumberOfPoints());
    for (vtkIdType k = 0; k < a->GetNumberOfPoints(); ++k)
    {
      double p[3], q[3];
      a->GetPoint(k, p);
      b->GetPoint(k, q);
      ASSERT_EQ(vtkMath::Distance2BetweenPoints(p, q), 0.0);
    }
    EXPECT_EQ(kept->GetVisibleArea(), fresh->GetVisibleArea());
    EXPECT_EQ(kept->GetNumberOfCells(), fresh->GetNumberOfCells());
  };
  vtkNew<vtkNURBSVisibleRegions> kept;
  kept->SetInputData(grid);
  kept->SetDirection(3, 1, 1);
  expectAsNew(kept);
  kept->SetDirection(-1, 2, 0.5);
  expectAsNew(kept);
  const double area = kept->GetVisibleArea();
  kept->SetPrecision(1e-3);
  expectAsNew(kept);
  // A changed model is another one.
  for (vtkIdType k = 0; k < grid->GetNumberOfPoints(); ++k)
  {
    double p[3];
    grid->GetPoint(k, p);
    grid->GetPoints()->SetPoint(k, 2.0 * p[0], 2.0 * p[1], 2.0 * p[2]);
  }
  grid->GetPoints()->Modified();
  expectAsNew(kept);
  EXPECT_NEAR(kept->GetVisibleArea() / area, 4.0, 0.05);
}

TEST(NURBSVisibleRegions, PrecisionIsRelativeOrAbsolute)
{
  vtkNew<vtkNURBSVisibleRegions> relative;
  relative->SetInputData(Shape(vtkNURBSShapeSource::SPHERE)); // Diagonal: 2 sqrt(3).
  relative->SetDirection(1, 2, 3);
  relative->SetPrecision(1e-5);
  relative->Update();
  vtkNew<vtkNURBSVisibleRegions> absolute;
  absolute->SetInputData(relative->GetInput());
  absolute->SetDirection(1, 2, 3);
  absolute->SetPrecisionModeToAbsolute();
  absolute->SetPrecision(2e-5 * std::sqrt(3.0));
  absolute->Update();
  EXPECT_EQ(relative->GetLines()->GetNumberOfPoints(), absolute->GetLines()->GetNumberOfPoints());
  EXPECT_NEAR(relative->GetVisibleArea(), 2.0 * PI, 2e-4);
}

// A plate of 4 x 4 at z = 0 and one of 2 x 2 at z = 1 over its middle.
constexpr double Small = 4.0, Large = 16.0;

vtkSmartPointer<vtkUnstructuredGrid> Plate(double half, double z)
{
  nurbs::ModelBuilder builder;
  AddQuad(builder, { -half, -half, z }, { half, -half, z }, { -half, half, z }, { half, half, z });
  return Grid(builder);
}

TEST(NURBSVisibleRegions, ModelsOfACollectionHideEachOther)
{
  vtkNew<vtkPartitionedDataSetCollection> input;
  input->SetPartition(0, 0, Plate(2.0, 0.0));
  vtkNew<vtkUnstructuredGrid> empty;
  input->SetPartition(1, 0, empty);
  input->SetPartition(2, 0, Plate(1.0, 1.0));
  input->SetPartition(2, 1, Plate(0.5, -1.0)); // Hidden as a whole.
  vtkNew<vtkDataAssembly> assembly;
  assembly->SetRootNodeName("Plates");
  assembly->AddDataSetIndex(assembly->AddNode("upper"), 2);
  input->SetDataAssembly(assembly);
  vtkNew<vtkNURBSVisibleRegions> filter;
  filter->SetInputData(input);
  filter->Update();
  auto* models = vtkPartitionedDataSetCollection::SafeDownCast(filter->GetOutputDataObject(0));
  auto* lines = vtkPartitionedDataSetCollection::SafeDownCast(filter->GetOutputDataObject(1));
  ASSERT_NE(models, nullptr);
  ASSERT_NE(lines, nullptr);
  EXPECT_EQ(filter->GetLines(), nullptr);
  for (auto* output : { models, lines })
  {
    ASSERT_EQ(output->GetNumberOfPartitionedDataSets(), 3u);
    ASSERT_EQ(output->GetNumberOfPartitions(2), 2u);
    ASSERT_NE(output->GetDataAssembly(), nullptr);
    EXPECT_STREQ(output->GetDataAssembly()->GetRootNodeName(), "Plates");
    EXPECT_EQ(output->GetDataAssembly()->GetDataSetIndices(0).size(), 1u);
  }
  const auto model = [&](unsigned int k, unsigned int part) {
    return vtkUnstructuredGrid::SafeDownCast(models->GetPartitionAsDataObject(k, part));
  };
  EXPECT_EQ(vtkNURBSModel::Validate(models), "");
  ASSERT_EQ(model(0, 0)->GetNumberOfCells(), 1);
  EXPECT_NEAR(CellValue(model(0, 0), "VisibleArea", 0), Large - Small, 1e-2);
  EXPECT_NEAR(CheckedArea(model(0, 0)), Large - Small, 1e-2);
  EXPECT_NEAR(CellValue(model(2, 0), "VisibleFraction", 0), 1.0, 1e-12);
  ASSERT_NE(model(2, 1), nullptr);
  EXPECT_EQ(model(2, 1)->GetNumberOfCells(), 0);
  EXPECT_EQ(filter->GetNumberOfHiddenFaces(), 1);
  EXPECT_NEAR(filter->GetVisibleArea(), Large, 1e-2);
  // Edges and faces are numbered in each model.
  for (const auto& at : { std::array<unsigned int, 2>{ 0, 0 }, { 2, 0 }, { 2, 1 } })
  {
    auto* drawing = vtkPolyData::SafeDownCast(lines->GetPartitionAsDataObject(at[0], at[1]));
    ASSERT_NE(drawing, nullptr);
    std::set<double> edges;
    for (vtkIdType c = 0; c < drawing->GetNumberOfCells(); ++c)
    {
      EXPECT_EQ(CellValue(drawing, "FaceId", c), 0);
      EXPECT_EQ(CellValue(drawing, "Visibility", c), at[1] == 0);
      edges.insert(CellValue(drawing, "EdgeId", c));
    }
    EXPECT_EQ(edges, (std::set<double>{ 0, 1, 2, 3 }));
  }
}

TEST(NURBSVisibleRegions, ModelsOfBlocksHideEachOther)
{
  vtkNew<vtkMultiBlockDataSet> inner;
  inner->SetBlock(0, Plate(1.0, 1.0));
  vtkNew<vtkMultiBlockDataSet> input;
  input->SetBlock(0, Plate(2.0, 0.0));
  input->SetBlock(2, inner);
  input->GetMetaData(2u)->Set(vtkCompositeDataSet::NAME(), "upper");
  vtkNew<vtkNURBSVisibleRegions> filter;
  filter->SetInputData(input);
  filter->Update();
  auto* models = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  auto* lines = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(1));
  ASSERT_NE(models, nullptr);
  ASSERT_NE(lines, nullptr);
  ASSERT_EQ(models->GetNumberOfBlocks(), 3u);
  EXPECT_EQ(models->GetBlock(1), nullptr);
  EXPECT_STREQ(models->GetMetaData(2u)->Get(vtkCompositeDataSet::NAME()), "upper");
  auto* first = vtkUnstructuredGrid::SafeDownCast(models->GetBlock(0));
  ASSERT_NE(first, nullptr);
  EXPECT_NEAR(Sum(first, "VisibleArea"), Large - Small, 1e-2);
  auto* second = vtkMultiBlockDataSet::SafeDownCast(models->GetBlock(2));
  ASSERT_NE(second, nullptr);
  EXPECT_NEAR(
    Sum(vtkUnstructuredGrid::SafeDownCast(second->GetBlock(0)), "VisibleArea"), Small, 1e-9);
  EXPECT_NE(vtkPolyData::SafeDownCast(lines->GetBlock(0)), nullptr);
  // One model after a composite: the outputs' types follow.
  filter->SetInputData(Plate(2.0, 0.0));
  filter->Update();
  ASSERT_NE(Models(filter), nullptr);
  ASSERT_NE(filter->GetLines(), nullptr);
  EXPECT_NEAR(filter->GetVisibleArea(), Large, 1e-9);
}

TEST(NURBSVisibleRegions, ThreadsChangeNothing)
{
  for (const int shape : { vtkNURBSShapeSource::VASE, vtkNURBSShapeSource::CAR_BODY })
  {
    vtkNew<vtkNURBSVisibleRegions> filters[2];
    for (int k = 0; k < 2; ++k)
    {
      const vtkNURBSParallelScope parallel;
      vtkSMPTools::Initialize(k == 0 ? 1 : 4);
      filters[k]->SetInputData(Shape(shape));
      filters[k]->SetDirection(1, 2, 0.5);
      filters[k]->Update();
    }
    vtkSMPTools::Initialize(0);
    EXPECT_GT(filters[0]->GetNumberOfPartialFaces(), 10);
    ExpectSame(filters[0], filters[1]);
  }
}

TEST(NURBSVisibleRegions, ClusteringChangesNoRegion)
{
  for (const int shape :
    { vtkNURBSShapeSource::VASE, vtkNURBSShapeSource::SPRING, vtkNURBSShapeSource::MISSILE })
  {
    vtkNew<vtkNURBSVisibleRegions> filters[2];
    for (int k = 0; k < 2; ++k)
    {
      filters[k]->SetInputData(Shape(shape));
      filters[k]->SetDirection(1, 1, 1);
      filters[k]->SetClustering(k);
      filters[k]->Update();
    }
    const double area = filters[0]->GetVisibleArea();
    EXPECT_NEAR(filters[1]->GetVisibleArea(), area, 1e-4 * area);
    ASSERT_EQ(Models(filters[0])->GetNumberOfCells(), Models(filters[1])->GetNumberOfCells());
    for (vtkIdType c = 0; c < Models(filters[0])->GetNumberOfCells(); ++c)
    {
      EXPECT_EQ(
        CellValue(Models(filters[0]), "FaceId", c), CellValue(Models(filters[1]), "FaceId", c));
      EXPECT_NEAR(CellValue(Models(filters[0]), "VisibleArea", c),
        CellValue(Models(filters[1]), "VisibleArea", c), 1e-4 * area);
    }
  }
}

TEST(NURBSVisibleRegions, ProgressIsReportedAndAbortObeyed)
{
  vtkNew<vtkNURBSVisibleRegions> filter;
  filter->SetInputData(Shape(vtkNURBSShapeSource::CAR_BODY));
  std::vector<double> reports;
  vtkNew<vtkCallbackCommand> observer;
  observer->SetClientData(&reports);
  observer->SetCallback([](vtkObject* caller, unsigned long, void* data, void*) {
    static_cast<std::vector<double>*>(data)->push_back(
      vtkAlgorithm::SafeDownCast(caller)->GetProgress());
  });
  filter->AddObserver(vtkCommand::ProgressEvent, observer);
  filter->Update();
  EXPECT_GT(reports.size(), 4u);
  EXPECT_EQ(reports.back(), 1.0);
  EXPECT_TRUE(std::is_sorted(reports.begin(), reports.end()));
  EXPECT_GT(filter->GetNumberOfLines(), 0);
  // Stopped when it starts, and in the midst of it, or else when it is done.
  for (const double share : { 0.0, 0.1, 0.3, 0.7 })
  {
    double from = share;
    vtkNew<vtkCallbackCommand> aborter;
    aborter->SetClientData(&from);
    aborter->SetCallback([](vtkObject* caller, unsigned long, void* data, void*) {
      auto* algorithm = vtkAlgorithm::SafeDownCast(caller);
      algorithm->SetAbortExecute(algorithm->GetProgress() >= *static_cast<double*>(data));
    });
    const unsigned long tag = filter->AddObserver(vtkCommand::ProgressEvent, aborter);
    filter->Modified();
    filter->Update();
    EXPECT_EQ(Models(filter)->GetNumberOfCells(), 0);
    EXPECT_EQ(filter->GetLines()->GetNumberOfPoints(), 0);
    EXPECT_EQ(filter->GetNumberOfLines(), 0);
    EXPECT_EQ(filter->GetVisibleArea(), 0.0);
    EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
    filter->RemoveObserver(tag);
  }
  filter->SetAbortExecute(0);
  filter->Modified();
  filter->Update();
  EXPECT_GT(filter->GetNumberOfLines(), 0);
}

TEST(NURBSVisibleRegions, ReleasesWhatItUsed)
{
  vtkNew<vtkNURBSVisibleRegions> filter;
  vtkWeakPointer<vtkUnstructuredGrid> input;
  {
    auto grid = Shape(vtkNURBSShapeSource::TORUS);
    input = grid;
    filter->SetInputData(grid);
    filter->Update();
  }
  vtkSmartPointer<vtkUnstructuredGrid> model = Models(filter);
  vtkWeakPointer<vtkPolyData> lines = filter->GetLines();
  const double area = CheckedArea(model);
  filter->SetInputData(nullptr);
  filter->SetOutput(nullptr);
  EXPECT_EQ(input, nullptr);
  EXPECT_NEAR(CheckedArea(model), area, 1e-12); // Stands alone.
  filter->GetOutputInformation(1)->Remove(vtkDataObject::DATA_OBJECT());
  EXPECT_EQ(lines, nullptr);
}

} // namespace
