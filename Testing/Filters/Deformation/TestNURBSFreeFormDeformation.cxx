// SPDX-License-Identifier: BSD-3-Clause
// vtkNURBSFreeFormDeformation in pipelines: surfaces under affine lattices, what is shared and what
// is modified from update to update, lattices from upstream, composites, bounds, threads, bad
// input.
#include "../../testMessageKeeper.h"
#include "vtkNURBSControlNet.h"
#include "vtkNURBSFreeFormDeformation.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"
#include "vtkNURBSShapeSource.h"

#include "vtkCallbackCommand.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataAssembly.h"
#include "vtkErrorCode.h"
#include "vtkExecutive.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSMPTools.h"
#include "vtkStructuredGrid.h"
#include "vtkUnstructuredGrid.h"
#include "vtkWarpVector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace
{

using Filter = vtkNURBSFreeFormDeformation;
using Grid = vtkSmartPointer<vtkUnstructuredGrid>;
using nurbs::Vec3;

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();
constexpr double Infinity = std::numeric_limits<double>::infinity();

Grid Shape(int type)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShape(type);
  source->SetSheetPoints(150, 100);
  source->Update();
  auto copy = Grid::New();
  copy->DeepCopy(source->GetOutput());
  return copy;
}

vtkUnstructuredGrid* Model(Filter* filter)
{
  return vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
}

vtkStructuredGrid* Lattice(Filter* filter)
{
  return vtkStructuredGrid::SafeDownCast(filter->GetOutputDataObject(1));
}

Vec3 PointOf(vtkDataSet* data, vtkIdType n)
{
  Vec3 x;
  data->GetPoint(n, x.data());
  return x;
}

vtkIdType Differences(vtkDataSet* a, vtkDataSet* b)
{
  EXPECT_EQ(a->GetNumberOfPoints(), b->GetNumberOfPoints());
  vtkIdType count = 0;
  for (vtkIdType n = 0; n < a->GetNumberOfPoints(); ++n)
  {
    count += PointOf(a, n) != PointOf(b, n);
  }
  return count;
}

// All that a model holds but its points.
std::vector<vtkObject*> Parts(vtkUnstructuredGrid* grid)
{
  std::vector<vtkObject*> parts = { grid->GetCells(), grid->GetCellTypesArray() };
  for (vtkFieldData* data : { static_cast<vtkFieldData*>(grid->GetPointData()),
         static_cast<vtkFieldData*>(grid->GetCellData()), grid->GetFieldData() })
  {
    for (int i = 0; i < data->GetNumberOfArrays(); ++i)
    {
      parts.push_back(data->GetAbstractArray(i));
    }
  }
  return parts;
}

std::vector<vtkMTimeType> Ages(vtkUnstructuredGrid* grid)
{
  std::vector<vtkMTimeType> ages;
  for (vtkObject* part : Parts(grid))
  {
    ages.push_back(part->GetMTime());
  }
  return ages;
}

Vec3 Affine(const Vec3& x)
{
  return Vec3(0.5 + 1.2 * x[0] - 0.3 * x[1], x[1] + 0.25 * x[2] - 1.0, 0.8 * x[2] + 0.1 * x[0]);
}

// Displaces every lattice point from rest to map(rest); the filter's lattice must be at rest.
template <class F>
void MoveLattice(Filter* filter, F map)
{
  filter->Update();
  vtkNew<vtkStructuredGrid> rest;
  rest->DeepCopy(Lattice(filter));
  for (vtkIdType n = 0; n < filter->GetNumberOfLatticePoints(); ++n)
  {
    const Vec3 x = PointOf(rest, n), d = map(x) - x;
    filter->SetLatticeDisplacement(n, d[0], d[1], d[2]);
  }
}

void MoveOnePoint(Filter* filter, double amount)
{
  filter->SetLatticeDisplacement(1, 2, 1, amount, 0.5 * amount, -amount);
}

TEST(FreeFormDeformation, AtRestAllIsSharedAndNothingMoves)
{
  const Grid teapot = Shape(vtkNURBSShapeSource::TEAPOT);
  vtkNew<Filter> filter;
  filter->SetInputData(teapot);
  filter->Update();
  EXPECT_EQ(Differences(Model(filter), teapot), 0);
  EXPECT_EQ(filter->GetNumberOfMovedPoints(), 0);
  EXPECT_EQ(Parts(Model(filter)), Parts(teapot));
  EXPECT_GT(Parts(teapot).size(), 15u);
  EXPECT_NE(Model(filter)->GetPoints()->GetData(), teapot->GetPoints()->GetData());
  EXPECT_EQ(vtkNURBSModel::Validate(Model(filter)), vtkNURBSModel::Validate(teapot));
  EXPECT_EQ(filter->GetNumberOfLatticePoints(), 64);
  EXPECT_EQ(Lattice(filter)->GetNumberOfPoints(), 64);
}

// An affine lattice maps the surfaces themselves, rational ones too, not only their control points.
TEST(FreeFormDeformation, AffineLatticesMapSurfacesExactly)
{
  for (const int type : { vtkNURBSShapeSource::TEAPOT, vtkNURBSShapeSource::TORUS,
         vtkNURBSShapeSource::PLATE, vtkNURBSShapeSource::CONE })
  {
    const Grid model = Shape(type);
    vtkNew<Filter> filter;
    filter->SetInputData(model);
    filter->SetDimensions(3, 5, 4);
    filter->SetMargin(type == vtkNURBSShapeSource::CONE ? 0.3 : 0.0);
    MoveLattice(filter, Affine);
    filter->Update();
    EXPECT_EQ(filter->GetNumberOfMovedPoints(), model->GetNumberOfPoints());
    const auto before = vtkNURBSModel::View(model), after = vtkNURBSModel::View(Model(filter));
    ASSERT_GT(after->GetModel().Faces.size(), 0u);
    for (std::size_t f = 0; f < after->GetModel().Faces.size(); ++f)
    {
      const nurbs::SurfaceView& from = before->GetModel().Faces[f].Geometry;
      const nurbs::SurfaceView& to = after->GetModel().Faces[f].Geometry;
      ASSERT_GT(to.Size(), 0);
      for (int n = 0; n < 25; ++n)
      {
        const nurbs::Interval u = from.Domain(0), v = from.Domain(1);
        const double s = u.Min + u.Length() * (n % 5) / 4, t = v.Min + v.Length() * (n / 5) / 4;
        EXPECT_LE((nurbs::Evaluate(to, s, t) - Affine(nurbs::Evaluate(from, s, t))).norm(), 2e-14);
      }
    }
  }
}

TEST(FreeFormDeformation, MovedEdgesAreForgottenAndFacesStayUsable)
{
  const Grid teapot = Shape(vtkNURBSShapeSource::TEAPOT);
  vtkNew<Filter> filter;
  filter->SetInputData(teapot);
  for (int k = 0; k < 4; ++k)
  {
    filter->SetLatticeDisplacement(3, 3, k, 1.0, 0.5, 0.2 * k);
  }
  filter->Update();
  const std::string problems = vtkNURBSModel::Validate(Model(filter));
  EXPECT_EQ(problems.find("error"), std::string::npos) << problems;
  EXPECT_NE(problems.find("edges do not fit their faces"), std::string::npos) << problems;
}

TEST(FreeFormDeformation, OnlyPointsAreModified)
{
  const Grid teapot = Shape(vtkNURBSShapeSource::TEAPOT);
  const Grid original = Shape(vtkNURBSShapeSource::TEAPOT);
  const vtkMTimeType inputAge = teapot->GetMTime();
  vtkNew<Filter> filter;
  filter->SetInputData(teapot);
  filter->Update();
  vtkPoints* points = Model(filter)->GetPoints();
  vtkDataArray* data = points->GetData();
  const double* memory = static_cast<double*>(data->GetVoidPointer(0));
  const auto parts = Parts(Model(filter));
  const auto ages = Ages(Model(filter));
  double bounds[6];
  for (int frame = 1; frame <= 5; ++frame)
  {
    const vtkMTimeType before = data->GetMTime();
    MoveOnePoint(filter, 0.3 * frame);
    filter->Update();
    EXPECT_EQ(Model(filter)->GetPoints(), points);
    EXPECT_EQ(points->GetData(), data);
    EXPECT_EQ(data->GetVoidPointer(0), memory);
    EXPECT_GT(data->GetMTime(), before);
    EXPECT_GT(filter->GetNumberOfMovedPoints(), 0);
    EXPECT_EQ(Parts(Model(filter)), parts);
    EXPECT_EQ(Ages(Model(filter)), ages);
    vtkNew<vtkPoints> copy; // The bounds follow what was written in place.
    copy->SetDataTypeToDouble();
    copy->DeepCopy(points);
    Model(filter)->GetBounds(bounds);
    for (int i = 0; i < 6; ++i)
    {
      EXPECT_EQ(bounds[i], copy->GetBounds()[i]);
    }
  }
  const vtkMTimeType before = points->GetMTime();
  filter->Modified(); // executes, and finds the same places
  filter->Update();
  EXPECT_EQ(points->GetMTime(), before);
  EXPECT_LE(data->GetMTime(), before);
  EXPECT_EQ(teapot->GetMTime(), inputAge);
  EXPECT_EQ(Differences(teapot, original), 0);
  filter->ResetLattice();
  filter->Update();
  EXPECT_EQ(Differences(Model(filter), original), 0);
}

TEST(FreeFormDeformation, NewInputsGetNewPoints)
{
  vtkNew<Filter> filter;
  filter->SetInputData(Shape(vtkNURBSShapeSource::SPHERE));
  MoveOnePoint(filter, 0.5);
  filter->Update();
  const vtkSmartPointer<vtkPoints> first = Model(filter)->GetPoints();
  filter->SetInputData(Shape(vtkNURBSShapeSource::TEAPOT));
  filter->Update();
  EXPECT_NE(Model(filter)->GetPoints(), first);

  // The filter's own output as its input is not overwritten either.
  vtkNew<vtkUnstructuredGrid> own;
  own->ShallowCopy(Model(filter));
  vtkNew<vtkUnstructuredGrid> kept;
  kept->DeepCopy(own);
  filter->SetInputData(own);
  filter->Update();
  EXPECT_EQ(Differences(own, kept), 0);
  EXPECT_GT(Differences(own, Model(filter)), 0);
}

TEST(FreeFormDeformation, BadDisplacementsAreNamedAndTheNextGoodUpdateRecovers)
{
  vtkNew<Filter> filter;
  filter->SetInputData(Shape(vtkNURBSShapeSource::TEAPOT));
  vtkNew<vtkNURBSControlNet> net;
  net->SetInputConnection(filter->GetOutputPort());
  MoveOnePoint(filter, 0.5);
  net->Update();
  vtkNew<vtkPolyData> last;
  last->DeepCopy(net->GetOutput());
  vtkPoints* points = Model(filter)->GetPoints();
  vtkNew<MessageKeeper> errors, pipeline;
  filter->AddObserver(vtkCommand::ErrorEvent, errors);
  filter->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, pipeline);
  for (const double bad : { NaN, Infinity, -Infinity })
  {
    filter->SetLatticeDisplacement(3, 0, 2, 0.0, bad, 0.0);
    net->Update();
    EXPECT_TRUE(errors->Says("lattice point 35 (3, 0, 2) is not finite")) << errors->Text;
    EXPECT_EQ(filter->GetErrorCode(), static_cast<unsigned long>(vtkErrorCode::UserError));
    EXPECT_EQ(Model(filter)->GetNumberOfCells(), 0);
    EXPECT_EQ(Model(filter)->GetNumberOfPoints(), 0);
    EXPECT_EQ(Lattice(filter)->GetNumberOfPoints(), 0);
    EXPECT_EQ(net->GetOutput()->GetNumberOfCells(), last->GetNumberOfCells());
    errors->Text.clear();
  }
  filter->SetLatticeDisplacement(3, 0, 2, 0.0, 0.0, 0.0);
  net->Update();
  EXPECT_EQ(errors->Text, "");
  EXPECT_EQ(filter->GetErrorCode(), static_cast<unsigned long>(vtkErrorCode::NoError));
  EXPECT_EQ(Model(filter)->GetPoints(), points);
  EXPECT_EQ(Differences(net->GetOutput(), last), 0);
}

TEST(FreeFormDeformation, TheLatticeComesFromDisplacementsPointsOrUpstream)
{
  const Grid teapot = Shape(vtkNURBSShapeSource::TEAPOT);
  const auto bend = [](const Vec3& x) { return Vec3(x[0] + 0.2 * x[2] * x[2], x[1], x[2]); };
  vtkNew<Filter> direct;
  direct->SetInputData(teapot);
  direct->SetDimensions(4, 3, 5);
  MoveLattice(direct, bend);
  direct->Update();
  EXPECT_EQ(direct->GetNumberOfMovedPoints(), Differences(Model(direct), teapot));
  EXPECT_GT(direct->GetNumberOfMovedPoints(), 200);
  double d[3];
  direct->GetLatticeDisplacement(7, d);
  double shown7[3];
  Lattice(direct)->GetPointData()->GetArray("Displacement")->GetTuple(7, shown7);
  EXPECT_EQ(Vec3(shown7[0], shown7[1], shown7[2]), Vec3(d[0], d[1], d[2]));

  vtkNew<Filter> points;
  points->SetInputData(teapot);
  points->SetDimensions(4, 3, 5);
  points->SetLattice(Lattice(direct)->GetPoints());
  points->Update();
  EXPECT_GT(points->GetNumberOfMovedPoints(), 200);

  vtkNew<Filter> rest;
  rest->SetInputData(teapot);
  rest->SetDimensions(4, 3, 5);
  vtkNew<Filter> upstream;
  upstream->SetInputData(teapot);
  upstream->SetDimensions(4, 3, 5);
  upstream->SetInputConnection(1, rest->GetOutputPort(1));
  upstream->Update();
  EXPECT_EQ(Differences(Model(upstream), teapot), 0); // at rest, bit by bit
  // The displacements that output 1 shows, added by Warp By Vector to what is at rest.
  vtkNew<vtkStructuredGrid> shown;
  shown->DeepCopy(Lattice(rest));
  shown->GetPointData()->SetVectors(Lattice(direct)->GetPointData()->GetVectors());
  vtkNew<vtkWarpVector> warp;
  warp->SetInputData(shown);
  upstream->SetInputConnection(1, warp->GetOutputPort());
  upstream->Update();
  for (vtkIdType n = 0; n < teapot->GetNumberOfPoints(); ++n)
  {
    const Vec3 x = PointOf(Model(direct), n);
    EXPECT_LE((PointOf(Model(points), n) - x).norm(), 1e-14);
    EXPECT_LE((PointOf(Model(upstream), n) - x).norm(), 1e-14);
  }
  // Displacements come on top; changed points are noticed.
  upstream->SetLatticeDisplacement(0, 1.0, 0.0, 0.0);
  upstream->Update();
  EXPECT_LE(
    (PointOf(Lattice(upstream), 0) - PointOf(Lattice(direct), 0) - Vec3(1, 0, 0)).norm(), 1e-14);
  vtkNew<vtkPoints> own;
  own->SetDataTypeToDouble();
  own->DeepCopy(Lattice(rest)->GetPoints());
  points->SetLattice(own);
  points->Update();
  EXPECT_EQ(points->GetNumberOfMovedPoints(), 0);
  own->SetPoint(59, 9.0, 9.0, 9.0);
  own->Modified();
  points->Update();
  EXPECT_GT(points->GetNumberOfMovedPoints(), 0);
  points->ResetLattice();
  points->Update();
  EXPECT_EQ(points->GetLattice(), nullptr);
  EXPECT_EQ(points->GetNumberOfMovedPoints(), 0);
}

TEST(FreeFormDeformation, WrongLatticesAreErrors)
{
  const Grid teapot = Shape(vtkNURBSShapeSource::TEAPOT);
  vtkNew<Filter> other;
  other->SetInputData(teapot);
  other->SetDimensions(2, 3, 4);
  vtkNew<Filter> filter;
  filter->SetInputData(teapot);
  filter->SetDimensions(4, 3, 2);
  filter->SetInputConnection(1, other->GetOutputPort(1));
  vtkNew<MessageKeeper> errors, pipeline;
  filter->AddObserver(vtkCommand::ErrorEvent, errors);
  filter->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, pipeline);
  filter->Update();
  EXPECT_TRUE(errors->Says("input 1 has the dimensions 2 x 3 x 4; the lattice has 4 x 3 x 2"))
    << errors->Text;
  EXPECT_EQ(Model(filter)->GetNumberOfCells(), 0);

  vtkNew<vtkPoints> places;
  places->SetNumberOfPoints(7);
  filter->SetInputConnection(1, nullptr);
  filter->SetLattice(places);
  filter->Update();
  EXPECT_TRUE(errors->Says("SetLattice has 7 points; the lattice has 4 x 3 x 2")) << errors->Text;
  places->SetNumberOfPoints(24);
  for (int n = 0; n < 24; ++n)
  {
    places->SetPoint(n, n, 0.0, n == 13 ? NaN : 0.0);
  }
  places->Modified();
  filter->Update();
  EXPECT_TRUE(errors->Says("lattice point 13 (1, 0, 1) is not finite")) << errors->Text;

  filter->SetLattice(nullptr);
  filter->UseInputBoundsOff();
  filter->SetBounds(0.0, 1.0, 2.0, 1.0, 0.0, 1.0);
  filter->Update();
  EXPECT_TRUE(errors->Says("turned over")) << errors->Text;
  filter->SetBounds(0.0, 1.0, 0.0, NaN, 0.0, 1.0);
  errors->Text.clear();
  filter->Update();
  EXPECT_TRUE(errors->Says("not a number")) << errors->Text;
  errors->Text.clear();
  filter->SetLatticeDisplacement(24, 1.0, 0.0, 0.0);
  EXPECT_TRUE(errors->Says("no such lattice point")) << errors->Text;
  errors->Text.clear();
  filter->SetLatticeDisplacement(0, 3, 0, 1.0, 0.0, 0.0);
  EXPECT_TRUE(errors->Says("no such lattice point")) << errors->Text;

  errors->Text.clear();
  filter->UseInputBoundsOn();
  filter->Update();
  EXPECT_EQ(errors->Text, "");
  EXPECT_EQ(Differences(Model(filter), teapot), 0);
}

// Every model of a composite as a lattice around all of them moves it.
void ExpectOneLattice(Filter* filter, vtkUnstructuredGrid* before, vtkUnstructuredGrid* after)
{
  const vtkIdType last = filter->GetNumberOfLatticePoints() - 1;
  const Vec3 least = PointOf(Lattice(filter), 0);
  const Vec3 most = PointOf(Lattice(filter), last) - Vec3(0.0, 0.0, 2.0);
  ASSERT_EQ(before->GetNumberOfPoints(), after->GetNumberOfPoints());
  for (vtkIdType n = 0; n < before->GetNumberOfPoints(); ++n)
  {
    const Vec3 x = PointOf(before, n);
    const Vec3 local = (x - least).cwiseQuotient(most - least);
    // The corner's function alone: the product of three cubes.
    const double shift = 2.0 * std::pow(local.prod(), 3);
    EXPECT_LE((PointOf(after, n) - x - Vec3(0.0, 0.0, shift)).norm(), 1e-13);
  }
}

TEST(FreeFormDeformation, OneLatticeIsAroundAllModelsOfAnAssembly)
{
  const Grid sphere = Shape(vtkNURBSShapeSource::SPHERE),
             teapot = Shape(vtkNURBSShapeSource::TEAPOT);
  vtkNew<vtkPolyData> foreign;
  vtkNew<vtkPoints> somePoints;
  somePoints->InsertNextPoint(100.0, 100.0, 100.0);
  foreign->SetPoints(somePoints);
  vtkNew<vtkPartitionedDataSetCollection> models;
  models->SetPartition(0, 0, sphere);
  models->SetPartition(1, 0, foreign);
  models->SetPartition(2, 0, teapot);
  models->SetPartition(3, 0, sphere); // an instance
  models->GetMetaData(2u)->Set(vtkCompositeDataSet::NAME(), "pot");
  vtkNew<vtkDataAssembly> assembly;
  assembly->AddDataSetIndex(assembly->AddNode("Kitchen"), 2);
  models->SetDataAssembly(assembly);

  vtkNew<Filter> filter;
  filter->SetInputData(models);
  filter->Update();
  auto* output = vtkPartitionedDataSetCollection::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_NE(output, nullptr);
  const auto grid = [&](unsigned int i) {
    return vtkUnstructuredGrid::SafeDownCast(output->GetPartitionAsDataObject(i, 0));
  };
  vtkPoints* const kept[] = { grid(0)->GetPoints(), grid(2)->GetPoints(), grid(3)->GetPoints() };
  filter->SetLatticeDisplacement(63, 0.0, 0.0, 2.0);
  filter->Update();
  ASSERT_EQ(output, filter->GetOutputDataObject(0));
  ASSERT_EQ(output->GetNumberOfPartitionedDataSets(), 4u);
  EXPECT_STREQ(output->GetMetaData(2u)->Get(vtkCompositeDataSet::NAME()), "pot");
  ASSERT_NE(output->GetDataAssembly(), nullptr);
  EXPECT_GE(output->GetDataAssembly()->FindFirstNodeWithName("Kitchen"), 0);
  EXPECT_EQ(grid(0)->GetPoints(), kept[0]);
  EXPECT_EQ(grid(2)->GetPoints(), kept[1]);
  EXPECT_EQ(grid(3)->GetPoints(), kept[2]);
  EXPECT_EQ(Parts(grid(2)), Parts(teapot));
  ExpectOneLattice(filter, sphere, grid(0));
  ExpectOneLattice(filter, teapot, grid(2));
  ExpectOneLattice(filter, sphere, grid(3));
  EXPECT_GT(filter->GetNumberOfMovedPoints(), 100);
  auto* passed = vtkPolyData::SafeDownCast(output->GetPartitionAsDataObject(1, 0));
  ASSERT_NE(passed, nullptr);
  EXPECT_EQ(passed->GetPoints()->GetData(), somePoints->GetData());
  EXPECT_EQ(models->GetPartitionAsDataObject(0, 0), sphere.GetPointer());
  EXPECT_EQ(Differences(sphere, Shape(vtkNURBSShapeSource::SPHERE)), 0);
  EXPECT_EQ(Differences(teapot, Shape(vtkNURBSShapeSource::TEAPOT)), 0);
}

TEST(FreeFormDeformation, NestedBlocksAndThenASingleModel)
{
  const Grid sphere = Shape(vtkNURBSShapeSource::SPHERE), torus = Shape(vtkNURBSShapeSource::TORUS);
  vtkNew<vtkMultiBlockDataSet> inner, outer;
  inner->SetBlock(1, torus);
  outer->SetBlock(0, sphere);
  outer->SetBlock(2, inner);
  vtkNew<Filter> filter;
  filter->SetInputData(outer);
  filter->SetLatticeDisplacement(63, 0.0, 0.0, 2.0);
  filter->Update();
  auto* output = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_NE(output, nullptr);
  ASSERT_EQ(output->GetNumberOfBlocks(), 3u);
  EXPECT_EQ(output->GetBlock(1), nullptr);
  ExpectOneLattice(filter, sphere, vtkUnstructuredGrid::SafeDownCast(output->GetBlock(0)));
  auto* nested = vtkMultiBlockDataSet::SafeDownCast(output->GetBlock(2));
  ASSERT_NE(nested, nullptr);
  ExpectOneLattice(filter, torus, vtkUnstructuredGrid::SafeDownCast(nested->GetBlock(1)));
  EXPECT_EQ(inner->GetBlock(1), torus.GetPointer()); // the input's tree is as it was
  EXPECT_EQ(outer->GetBlock(2), inner.GetPointer());
  EXPECT_EQ(Differences(torus, Shape(vtkNURBSShapeSource::TORUS)), 0);
  filter->SetInputData(sphere);
  filter->Update();
  ASSERT_NE(Model(filter), nullptr);
  ExpectOneLattice(filter, sphere, Model(filter));
}

TEST(FreeFormDeformation, PointsOutsideTheBoundsStay)
{
  const Grid sheet = Shape(vtkNURBSShapeSource::SHEET);
  double b[6];
  sheet->GetBounds(b);
  vtkNew<Filter> filter;
  filter->SetInputData(sheet);
  filter->UseInputBoundsOff();
  filter->SetBounds(b[0] + 10.0, b[0] + 60.0, b[2] - 1.0, b[2] + 30.0, -50.0, 50.0);
  filter->SetDimensions(7, 7, 7);
  filter->SetFrozenLayers(1);
  MoveLattice(filter, [](const Vec3& x) { return Vec3(x[0], x[1], x[2] + 8.0); });
  filter->Update();
  const double* box = filter->GetBounds();
  vtkIdType inside = 0;
  for (vtkIdType n = 0; n < sheet->GetNumberOfPoints(); ++n)
  {
    const Vec3 x = PointOf(sheet, n);
    const bool in = x[0] > box[0] && x[0] < box[1] && x[1] > box[2] && x[1] < box[3];
    inside += in;
    EXPECT_EQ(PointOf(Model(filter), n) != x, in) << x.transpose();
  }
  EXPECT_EQ(filter->GetNumberOfMovedPoints(), inside);
  EXPECT_GT(inside, 1000);
}

TEST(FreeFormDeformation, FlatModelsHaveALatticeWithDepth)
{
  vtkNew<Filter> filter;
  filter->SetInputData(Shape(vtkNURBSShapeSource::PLATE)); // 4 x 3, at z = 0
  filter->Update();
  double b[6];
  Lattice(filter)->GetBounds(b);
  EXPECT_NEAR(b[1] - b[0], 4.0, 1e-14);
  EXPECT_NEAR(b[3] - b[2], 3.0, 1e-14);
  EXPECT_NEAR(b[4], -0.5, 1e-14);
  EXPECT_NEAR(b[5], 0.5, 1e-14);
  filter->SetMargin(0.2);
  filter->Update();
  Lattice(filter)->GetBounds(b);
  EXPECT_NEAR(b[1] - b[0], 6.0, 1e-14);
  EXPECT_NEAR(b[5], 1.5, 1e-14);
}

TEST(FreeFormDeformation, ThreadsGiveTheSameBits)
{
  const Grid sheet = Shape(vtkNURBSShapeSource::SHEET);
  ASSERT_GT(sheet->GetNumberOfPoints(), 10000);
  vtkNew<vtkUnstructuredGrid> first;
  for (const int threads : { 1, 4 })
  {
    vtkSMPTools::Initialize(threads);
    vtkNew<Filter> filter;
    filter->SetInputData(sheet);
    filter->SetDimensions(9, 8, 3);
    MoveLattice(filter,
      [](const Vec3& x) { return Vec3(x[0] + std::sin(x[1]), x[1] - std::cos(x[0]), 2.0); });
    filter->Update();
    if (threads == 1)
    {
      first->DeepCopy(Model(filter));
    }
    EXPECT_EQ(Differences(Model(filter), first), 0);
    EXPECT_EQ(filter->GetNumberOfMovedPoints(), Differences(first, sheet));
  }
  vtkSMPTools::Initialize(0);
}

TEST(FreeFormDeformation, AbortLeavesTheOutputsEmptyAndTheNextUpdateWorks)
{
  vtkNew<vtkPartitionedDataSetCollection> models;
  models->SetPartition(0, 0, Shape(vtkNURBSShapeSource::SPHERE));
  models->SetPartition(1, 0, Shape(vtkNURBSShapeSource::TORUS));
  vtkNew<Filter> filter;
  filter->SetInputData(models);
  vtkNew<vtkCallbackCommand> abort;
  abort->SetCallback([](vtkObject* caller, unsigned long, void*, void*) {
    static_cast<vtkAlgorithm*>(caller)->SetAbortExecute(1);
  });
  const unsigned long observer = filter->AddObserver(vtkCommand::ProgressEvent, abort);
  filter->Update();
  auto* output = vtkPartitionedDataSetCollection::SafeDownCast(filter->GetOutputDataObject(0));
  EXPECT_EQ(output->GetNumberOfPartitionedDataSets(), 0u);
  EXPECT_EQ(Lattice(filter)->GetNumberOfPoints(), 0);
  filter->RemoveObserver(observer);
  filter->SetAbortExecute(0);
  filter->Modified();
  filter->Update();
  EXPECT_EQ(output->GetNumberOfPartitionedDataSets(), 2u);
  EXPECT_EQ(Lattice(filter)->GetNumberOfPoints(), 64);
}

TEST(FreeFormDeformation, OddInputsAreTaken)
{
  vtkNew<MessageKeeper> errors;
  vtkNew<Filter> filter;
  filter->AddObserver(vtkCommand::ErrorEvent, errors);
  const Grid torus = Shape(vtkNURBSShapeSource::TORUS);
  filter->SetInputData(torus);
  MoveLattice(filter, Affine);
  filter->Update();
  vtkNew<vtkUnstructuredGrid> expected;
  expected->DeepCopy(Model(filter));

  vtkNew<vtkPoints> floats; // of single precision
  floats->DeepCopy(torus->GetPoints());
  ASSERT_EQ(floats->GetDataType(), VTK_FLOAT);
  vtkNew<vtkUnstructuredGrid> single;
  single->ShallowCopy(torus);
  single->SetPoints(floats);
  filter->SetInputData(single);
  filter->Update();
  EXPECT_EQ(Model(filter)->GetPoints()->GetDataType(), VTK_DOUBLE);
  for (vtkIdType n = 0; n < torus->GetNumberOfPoints(); ++n)
  {
    EXPECT_LE((PointOf(Model(filter), n) - PointOf(expected, n)).norm(), 1e-6);
  }

  vtkNew<vtkUnstructuredGrid> broken; // one bad control point leaves the others as they were
  broken->DeepCopy(torus);
  const Vec3 lost = PointOf(torus, 3);
  broken->GetPoints()->SetPoint(3, lost[0], Infinity, lost[2]);
  filter->SetInputData(broken);
  filter->Update();
  EXPECT_EQ(Differences(Model(filter), expected), 1);
  EXPECT_EQ(PointOf(Model(filter), 3), PointOf(broken, 3));

  vtkNew<vtkUnstructuredGrid> empty;
  filter->SetInputData(empty);
  filter->Update();
  EXPECT_EQ(Model(filter)->GetNumberOfPoints(), 0);
  EXPECT_EQ(Lattice(filter)->GetNumberOfPoints(), 64);
  EXPECT_EQ(errors->Text, "");
}

TEST(FreeFormDeformation, DimensionsAreClampedAndResetTheLattice)
{
  vtkNew<Filter> filter;
  filter->SetLatticeDisplacement(5, 1.0, 2.0, 3.0);
  double d[3];
  filter->GetLatticeDisplacement(1, 1, 0, d);
  EXPECT_EQ(Vec3(d[0], d[1], d[2]), Vec3(1.0, 2.0, 3.0));
  filter->SetDimensions(4, 4, 4);
  filter->GetLatticeDisplacement(5, d);
  EXPECT_EQ(d[0], 1.0);
  filter->SetDimensions(1, 4, 50);
  EXPECT_EQ(filter->GetNumberOfLatticePoints(), 2 * 4 * 32);
  filter->GetLatticeDisplacement(5, d);
  EXPECT_EQ(d[0], 0.0);
  const vtkMTimeType age = filter->GetMTime();
  filter->SetLatticeDisplacement(5, 0.0, 0.0, 0.0);
  EXPECT_EQ(filter->GetMTime(), age);
  filter->SetLatticeDisplacement(5, 0.0, 0.0, 1.0);
  EXPECT_GT(filter->GetMTime(), age);
}

} // namespace
