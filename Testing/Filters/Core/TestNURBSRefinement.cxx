// SPDX-License-Identifier: BSD-3-Clause
// vtkNURBSRefinement in pipelines: surfaces and trims stay, what is passed on and what is new,
// caps, composites, bad faces, points that faces share, threads, aborting.
#include "../../testMessageKeeper.h"
#include "vtkNURBSCADReader.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"
#include "vtkNURBSRefinement.h"
#include "vtkNURBSShapeSource.h"

#include "vtkCallbackCommand.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkErrorCode.h"
#include "vtkFieldData.h"
#include "vtkIntArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSMPTools.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>

namespace
{

using Filter = vtkNURBSRefinement;
using Grid = vtkSmartPointer<vtkUnstructuredGrid>;
using nurbs::Vec3;

Grid Shape(int type)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShape(type);
  source->Update();
  auto copy = Grid::New();
  copy->DeepCopy(source->GetOutput());
  return copy;
}

vtkUnstructuredGrid* Output(Filter* filter)
{
  return vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
}

// Expects the same points of all surfaces at the same parameters, and net edges up to `spacing`.
void ExpectSameSurfaces(vtkUnstructuredGrid* before, vtkUnstructuredGrid* after, double spacing)
{
  const auto a = vtkNURBSModel::View(before), b = vtkNURBSModel::View(after);
  ASSERT_EQ(a->GetModel().Faces.size(), b->GetModel().Faces.size());
  for (std::size_t f = 0; f < a->GetModel().Faces.size(); ++f)
  {
    const nurbs::Face& face = a->GetModel().Faces[f];
    const nurbs::SurfaceView& from = face.Geometry;
    const nurbs::SurfaceView& to = b->GetModel().Faces[f].Geometry;
    ASSERT_GT(to.Size(), 0) << b->GetFaceError(vtkIdType(f));
    const nurbs::Box2 box = nurbs::LoopsBox(a->GetModel(), face);
    for (int n = 0; n < 400; ++n)
    {
      const nurbs::Vec2 uv =
        box.min() + nurbs::Vec2((n % 20) / 19.0, (n / 20) / 19.0).cwiseProduct(box.sizes());
      ASSERT_LE((nurbs::Evaluate(from, uv[0], uv[1]) - nurbs::Evaluate(to, uv[0], uv[1])).norm(),
        1e-12 * before->GetLength());
    }
    for (std::int64_t k = 0; k < to.Size(); ++k)
    {
      const std::int64_t nu = to.Count[0];
      const double du = (k + 1) % nu ? (to.Point(k + 1) - to.Point(k)).norm() : 0.0;
      const double dv = k + nu < to.Size() ? (to.Point(k + nu) - to.Point(k)).norm() : 0.0;
      ASSERT_LE(std::max(du, dv), spacing * (1.0 + 1e-8));
    }
    EXPECT_GE(std::min(to.Degree[0], to.Degree[1]), 3);
  }
}

// Everything in the field data but Knots, and in the cell data but what describes nets.
std::set<vtkAbstractArray*> PassedArrays(vtkUnstructuredGrid* grid)
{
  const std::set<std::string> own = { "Knots", "Degree", "NetSize", "KnotStart" };
  std::set<vtkAbstractArray*> arrays;
  for (vtkFieldData* data :
    { static_cast<vtkFieldData*>(grid->GetCellData()), grid->GetFieldData() })
  {
    for (int i = 0; i < data->GetNumberOfArrays(); ++i)
    {
      if (own.count(data->GetAbstractArray(i)->GetName()) == 0)
      {
        arrays.insert(data->GetAbstractArray(i));
      }
    }
  }
  return arrays;
}

TEST(Refinement, SurfacesStayAndNetsGetDense)
{
  for (const int type :
    { vtkNURBSShapeSource::SPHERE, vtkNURBSShapeSource::TORUS, vtkNURBSShapeSource::CONE,
      vtkNURBSShapeSource::DISC, vtkNURBSShapeSource::PLATE, vtkNURBSShapeSource::TEAPOT })
  {
    SCOPED_TRACE(type);
    const Grid model = Shape(type);
    const Grid original = Shape(type);
    vtkNew<vtkIntArray> foreign;
    foreign->SetName("Foreign");
    foreign->SetNumberOfValues(model->GetNumberOfCells());
    foreign->Fill(5);
    model->GetCellData()->AddArray(foreign);
    vtkNew<Filter> filter;
    filter->SetInputData(model);
    filter->SetSpacingModeToAbsolute();
    filter->SetMaximumSpacing(0.07);
    filter->Update();
    ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
    EXPECT_EQ(filter->GetNumberOfRefinedFaces(), model->GetNumberOfCells());
    EXPECT_EQ(filter->GetNumberOfCappedFaces(), 0);
    EXPECT_EQ(filter->GetNumberOfControlPoints(), Output(filter)->GetNumberOfPoints());
    ExpectSameSurfaces(model, Output(filter), 0.07);
    EXPECT_EQ(vtkNURBSModel::Validate(Output(filter)), "");
    EXPECT_EQ(PassedArrays(Output(filter)), PassedArrays(model));
    EXPECT_EQ(PassedArrays(model).count(foreign), 1u);
    ExpectSameSurfaces(original, Output(filter), 0.07); // The input was not touched:
    EXPECT_EQ(original->GetNumberOfPoints(), model->GetNumberOfPoints());
    EXPECT_EQ(original->GetFieldData()->GetArray("Knots")->GetNumberOfTuples(),
      model->GetFieldData()->GetArray("Knots")->GetNumberOfTuples());
    EXPECT_EQ(original->GetPointData()->HasArray("RationalWeights"),
      Output(filter)->GetPointData()->HasArray("RationalWeights"));
  }
}

std::vector<vtkUnstructuredGrid*> Leaves(vtkDataObject* data)
{
  auto* composite = vtkCompositeDataSet::SafeDownCast(data);
  std::vector<vtkUnstructuredGrid*> leaves;
  vtkSmartPointer<vtkCompositeDataIterator> at;
  at.TakeReference(composite->NewIterator());
  for (at->InitTraversal(); !at->IsDoneWithTraversal(); at->GoToNextItem())
  {
    leaves.push_back(vtkUnstructuredGrid::SafeDownCast(at->GetCurrentDataObject()));
  }
  return leaves;
}

// Trimmed faces of CAD files: nothing that was valid becomes worse, edges still lie on their faces.
TEST(Refinement, TrimsOfCADFilesStayValid)
{
  for (const char* const path : { "/usr/share/opencascade/data/step/linkrods.step",
         "/usr/share/opencascade/data/step/screw.step" })
  {
    SCOPED_TRACE(path);
    vtkNew<vtkNURBSCADReader> reader;
    reader->SetFileName(path);
    vtkNew<Filter> filter;
    filter->SetInputConnection(reader->GetOutputPort());
    filter->SetMaximumSpacing(0.01);
    filter->Update();
    EXPECT_EQ(filter->GetNumberOfCappedFaces(), 0);
    vtkDataObject* model = reader->GetOutputDataObject(0);
    EXPECT_EQ(
      vtkNURBSModel::Validate(filter->GetOutputDataObject(0)), vtkNURBSModel::Validate(model));
    const auto before = Leaves(model), after = Leaves(filter->GetOutputDataObject(0));
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t k = 0; k < before.size(); ++k)
    {
      ExpectSameSurfaces(before[k], after[k], 0.01 * before[k]->GetLength());
      EXPECT_EQ(PassedArrays(after[k]), PassedArrays(before[k]));
    }
  }
}

// The box around a sphere of radius 3 has the diagonal 6 sqrt 3.
TEST(Refinement, RelativeSpacingIsOfTheDiagonal)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShapeToSphere();
  source->SetRadius(3.0);
  vtkNew<Filter> relative, absolute;
  relative->SetMaximumControlPoints(1000000);
  absolute->SetMaximumControlPoints(1000000);
  relative->SetInputConnection(source->GetOutputPort());
  relative->SetMaximumSpacing(0.01);
  relative->Update();
  absolute->SetInputConnection(source->GetOutputPort());
  absolute->SetSpacingModeToAbsolute();
  absolute->SetMaximumSpacing(0.06 * std::sqrt(3.0) * (1.0 + 1e-12));
  absolute->Update();
  EXPECT_EQ(Output(relative)->GetNumberOfPoints(), Output(absolute)->GetNumberOfPoints());
  ExpectSameSurfaces(source->GetOutput(), Output(relative), 0.06 * std::sqrt(3.0));
  absolute->SetMaximumSpacing(0.06);
  absolute->Update();
  EXPECT_GT(Output(absolute)->GetNumberOfPoints(), 2 * Output(relative)->GetNumberOfPoints());
}

TEST(Refinement, CapsAreNamed)
{
  const Grid plate = Shape(vtkNURBSShapeSource::PLATE);
  vtkNew<Filter> filter;
  vtkNew<MessageKeeper> warning;
  filter->AddObserver(vtkCommand::WarningEvent, warning);
  filter->SetInputData(plate);
  filter->SetMaximumSpacing(1e-4);
  filter->SetMaximumControlPoints(500);
  filter->Update();
  EXPECT_GT(filter->GetNumberOfCappedFaces(), 0);
  EXPECT_TRUE(warning->Says("MaximumControlPoints")) << warning->Text;
  EXPECT_TRUE(warning->Says("\n  face " + std::to_string(vtkNURBSModel::GetFaceId(plate, 0))))
    << warning->Text;
  for (vtkIdType cell = 0; cell < plate->GetNumberOfCells(); ++cell)
  {
    EXPECT_LE(Output(filter)->GetCells()->GetCellSize(cell), 500);
    EXPECT_GE(Output(filter)->GetCells()->GetCellSize(cell), 300);
  }
}

TEST(Refinement, DenseModelsArePassedOn)
{
  const Grid teapot = Shape(vtkNURBSShapeSource::TEAPOT);
  vtkNew<Filter> filter;
  filter->SetInputData(teapot);
  filter->SetMaximumSpacing(10.0);
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfRefinedFaces(), 0);
  EXPECT_EQ(Output(filter)->GetPoints(), teapot->GetPoints());
  EXPECT_EQ(Output(filter)->GetCells(), teapot->GetCells());
}

// Three squares of degree 1 in a row that share points: the wide one is refined, the others keep
// their nets, and the points that they have in common.
TEST(Refinement, FacesThatStayShareTheirPoints)
{
  auto grid = Grid::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  const double x[4] = { 0, 1, 2, 12 };
  points->InsertNextPoint(99, 99, 99); // used by none
  for (int i = 0; i < 8; ++i)
  {
    points->InsertNextPoint(x[i % 4], i / 4, 0);
  }
  grid->SetPoints(points);
  vtkNew<vtkIntArray> degree, size, start;
  const char* const names[3] = { "Degree", "NetSize", "KnotStart" };
  for (vtkIdType i = 0; i < 3; ++i)
  {
    const vtkIdType ids[4] = { 1 + i, 2 + i, 5 + i, 6 + i };
    grid->InsertNextCell(VTK_POLY_VERTEX, 4, ids);
    vtkIntArray* const arrays[3] = { degree, size, start };
    const int values[3] = { 1, 2, 0 };
    for (int a = 0; a < 3; ++a)
    {
      arrays[a]->SetName(names[a]);
      arrays[a]->SetNumberOfComponents(2);
      arrays[a]->InsertNextTuple2(values[a], values[a]);
    }
  }
  for (vtkIntArray* array : { degree.Get(), size.Get(), start.Get() })
  {
    grid->GetCellData()->AddArray(array);
  }
  vtkNew<vtkDoubleArray> knots;
  knots->SetName("Knots");
  for (const double t : { 0.0, 0.0, 1.0, 1.0 })
  {
    knots->InsertNextValue(t);
  }
  grid->GetFieldData()->AddArray(knots);
  ASSERT_EQ(vtkNURBSModel::Validate(grid), "");
  vtkNew<Filter> filter;
  filter->SetInputData(grid);
  filter->SetMinimumDegree(1);
  filter->SetSpacingModeToAbsolute();
  filter->SetMaximumSpacing(1.0);
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfRefinedFaces(), 1);
  EXPECT_EQ(Output(filter)->GetNumberOfPoints(), 6 + 22);
  EXPECT_EQ(vtkNURBSModel::Validate(Output(filter)), "");
  const auto a = vtkNURBSModel::View(grid), b = vtkNURBSModel::View(Output(filter));
  for (int f = 0; f < 3; ++f)
  {
    const nurbs::SurfaceView& from = a->GetModel().Faces[f].Geometry;
    const nurbs::SurfaceView& to = b->GetModel().Faces[f].Geometry;
    EXPECT_LE((nurbs::Evaluate(from, 0.3, 0.8) - nurbs::Evaluate(to, 0.3, 0.8)).norm(), 1e-14);
  }
  const nurbs::SurfaceView& left = b->GetModel().Faces[0].Geometry;
  const nurbs::SurfaceView& middle = b->GetModel().Faces[1].Geometry;
  EXPECT_EQ(left.Id(1), middle.Id(0));
  EXPECT_EQ(left.Id(3), middle.Id(2));
}

TEST(Refinement, BadFacesArePassedOnUnchanged)
{
  const Grid teapot = Shape(vtkNURBSShapeSource::TEAPOT);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  vtkIdType count;
  const vtkIdType* ids;
  teapot->GetCells()->GetCellAtId(3, count, ids);
  teapot->GetPoints()->SetPoint(ids[5], nan, 0, 0);
  const std::string errors = vtkNURBSModel::View(teapot)->DescribeFaceErrors();
  ASSERT_NE(errors, "");
  vtkNew<Filter> filter;
  vtkNew<MessageKeeper> warning;
  filter->AddObserver(vtkCommand::WarningEvent, warning);
  filter->SetInputData(teapot);
  filter->Update();
  EXPECT_TRUE(warning->Says("Faces with errors are passed on as they are")) << warning->Text;
  EXPECT_TRUE(warning->Says("cell 3 (FaceId")) << warning->Text;
  EXPECT_EQ(vtkNURBSModel::View(Output(filter))->DescribeFaceErrors(), errors);
  EXPECT_EQ(Output(filter)->GetCells()->GetCellSize(3), teapot->GetCells()->GetCellSize(3));
  EXPECT_GT(filter->GetNumberOfRefinedFaces(), 20);
}

TEST(Refinement, CompositesKeepTheirStructure)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  vtkNew<vtkPolyData> mesh;
  vtkNew<vtkPoints> points;
  mesh->SetPoints(points);
  const Grid torus = Shape(vtkNURBSShapeSource::TORUS);
  blocks->SetBlock(0, torus);
  blocks->SetBlock(1, mesh);
  blocks->SetBlock(3, Shape(vtkNURBSShapeSource::PLATE));
  vtkNew<Filter> filter;
  filter->SetInputData(blocks);
  filter->Update();
  auto* output = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_NE(output, nullptr);
  ASSERT_EQ(output->GetNumberOfBlocks(), 4u);
  auto* passed = vtkPolyData::SafeDownCast(output->GetBlock(1));
  ASSERT_NE(passed, nullptr);
  EXPECT_EQ(passed->GetPoints(), mesh->GetPoints());
  EXPECT_EQ(output->GetBlock(2), nullptr);
  for (const unsigned int b : { 0u, 3u })
  {
    auto* model = vtkUnstructuredGrid::SafeDownCast(output->GetBlock(b));
    ASSERT_NE(model, nullptr);
    EXPECT_EQ(vtkNURBSModel::Validate(model), "");
    EXPECT_GT(model->GetNumberOfPoints(),
      vtkUnstructuredGrid::SafeDownCast(blocks->GetBlock(b))->GetNumberOfPoints());
  }
  EXPECT_EQ(blocks->GetBlock(0), torus.Get());
  EXPECT_EQ(torus->GetNumberOfPoints(), 81);
}

TEST(Refinement, ThreadsMakeNoDifference)
{
  const Grid teapot = Shape(vtkNURBSShapeSource::TEAPOT);
  Grid results[2];
  for (int k = 0; k < 2; ++k)
  {
    vtkSMPTools::Initialize(k == 0 ? 1 : 4);
    vtkNew<Filter> filter;
    filter->SetInputData(teapot);
    filter->SetMaximumSpacing(0.02);
    filter->Update();
    results[k] = Output(filter);
  }
  vtkSMPTools::Initialize(0);
  ASSERT_EQ(results[0]->GetNumberOfPoints(), results[1]->GetNumberOfPoints());
  for (vtkIdType n = 0; n < results[0]->GetNumberOfPoints(); ++n)
  {
    Vec3 a, b;
    results[0]->GetPoint(n, a.data());
    results[1]->GetPoint(n, b.data());
    ASSERT_EQ(a, b);
  }
}

TEST(Refinement, AbortLeavesTheOutputEmpty)
{
  vtkNew<vtkCallbackCommand> stop;
  stop->SetCallback([](vtkObject* caller, unsigned long, void*, void*) {
    vtkAlgorithm::SafeDownCast(caller)->AbortExecuteOn();
  });
  vtkNew<Filter> filter;
  filter->SetInputData(Shape(vtkNURBSShapeSource::TEAPOT));
  filter->AddObserver(vtkCommand::ProgressEvent, stop);
  filter->Update();
  EXPECT_EQ(Output(filter)->GetNumberOfCells(), 0);
  filter->RemoveAllObservers();
  filter->AbortExecuteOff();
  filter->Modified();
  filter->Update();
  EXPECT_EQ(Output(filter)->GetNumberOfCells(), 32);
}

TEST(Refinement, BadInputIsAnErrorWithoutOutput)
{
  vtkNew<Filter> filter;
  vtkNew<MessageKeeper> error;
  filter->AddObserver(vtkCommand::ErrorEvent, error);
  filter->SetInputData(Shape(vtkNURBSShapeSource::TORUS));
  filter->SetMaximumSpacing(-1.0);
  filter->Update();
  EXPECT_TRUE(error->Says("MaximumSpacing must be positive")) << error->Text;
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::UserError);
  filter->SetMaximumSpacing(0.1);
  vtkNew<vtkUnstructuredGrid> vertices;
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(0, 0, 0);
  vertices->SetPoints(points);
  const vtkIdType id = 0;
  vertices->InsertNextCell(VTK_POLY_VERTEX, 1, &id);
  filter->SetInputData(vertices);
  filter->Update();
  EXPECT_TRUE(error->Says("not a NURBS model")) << error->Text;
  vtkNew<vtkUnstructuredGrid> nothing;
  filter->SetInputData(nothing);
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  EXPECT_EQ(Output(filter)->GetNumberOfCells(), 0);
}

} // namespace
