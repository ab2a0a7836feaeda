// SPDX-License-Identifier: BSD-3-Clause
// vtkNURBSDeformingTessellator frame after frame: shapes and CAD solids that move by any means, weights,
// cameras and budgets.
#include "vtkDeformingScene.h"
#include "vtkNURBSCADReader.h"

#include "vtkCamera.h"
#include "vtkDoubleArray.h"
#include "vtkErrorCode.h"
#include "vtkFieldData.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkTransform.h"
#include "vtkTransformFilter.h"
#include "vtkWarpVector.h"

#include <fstream>

namespace
{

using scene::Mesh;
using scene::Shape;
using Filter = vtkNURBSDeformingTessellator;

double FieldValue(vtkPolyData* mesh, const char* name, int component = 0)
{
  vtkDataArray* array = mesh->GetFieldData()->GetArray(name);
  return array ? array->GetComponent(0, component) : std::nan("");
}

// Every point of every frame is on the surfaces, and closed shapes stay closed.
TEST(NURBSDeformingTessellator, ClosedShapesFollowAWave)
{
  vtkIdType inserted = 0, deleted = 0;
  for (const int type : { vtkNURBSShapeSource::SPHERE, vtkNURBSShapeSource::TORUS,
         vtkNURBSShapeSource::CYLINDER, vtkNURBSShapeSource::CONE })
  {
    SCOPED_TRACE(type);
    const auto grid = Shape(type);
    const auto rest = scene::Rest(grid);
    vtkNew<Filter> filter;
    filter->SetInputData(grid);
    filter->SetTolerance(1e-3);
    filter->SetHysteresis(0.9);
    for (int frame = 0; frame <= 30; ++frame)
    {
      SCOPED_TRACE(frame);
      if (frame > 0)
      {
        scene::Wave(grid, rest, 0.15 * std::sin(0.25 * frame));
      }
      filter->Update();
      ASSERT_EQ(filter->GetErrorCode(), (unsigned long)vtkErrorCode::NoError);
      EXPECT_EQ(filter->GetRebuiltModels(), frame == 0 ? 1 : 0);
      EXPECT_EQ(scene::OpenEdges(Mesh(filter)), 0u);
      const scene::Differences off = scene::Compare(Mesh(filter), grid);
      EXPECT_GT(off.Checked, 50);
      EXPECT_LE(off.Point, filter->GetModelGap() + 1e-12 * scene::Size(grid));
      EXPECT_LE(off.Normal, 1e-6);
      EXPECT_LE(
        filter->GetErrorBound(), filter->GetToleranceUsed() + filter->GetModelGap() + 1e-12);
      inserted += frame > 0 ? filter->GetInsertedVertices() : 0;
      deleted += frame > 0 ? filter->GetDeletedVertices() : 0;
    }
  }
  EXPECT_GT(inserted, 500);
  EXPECT_GT(deleted, 500);
}

// Of many faces, some trimmed: open edges are as long as the border of the model, no longer.
TEST(NURBSDeformingTessellator, ShapesOfManyFacesFollow)
{
  for (const int type :
    { vtkNURBSShapeSource::TEAPOT, vtkNURBSShapeSource::CAR_BODY, vtkNURBSShapeSource::PLATE })
  {
    SCOPED_TRACE(type);
    const auto grid = Shape(type);
    const auto rest = scene::Rest(grid);
    vtkNew<Filter> filter;
    filter->SetInputData(grid);
    filter->SetTolerance(5e-4);
    for (int frame = 0; frame <= 8; ++frame)
    {
      SCOPED_TRACE(frame);
      scene::Wave(grid, rest, 0.02 * std::sin(0.5 * frame));
      filter->Update();
      ASSERT_EQ(filter->GetErrorCode(), (unsigned long)vtkErrorCode::NoError);
      EXPECT_EQ(filter->GetRebuiltModels(), frame == 0 ? 1 : 0);
      EXPECT_LE(scene::Compare(Mesh(filter), grid).Point,
        filter->GetModelGap() + 1e-12 * scene::Size(grid));
      double open = 0.0;
      scene::OpenEdges(Mesh(filter), &open);
      const double border = scene::BorderLength(grid);
      EXPECT_GT(border, scene::Size(grid));
      EXPECT_LE(open, border * (1.0 + 1e-9));
      EXPECT_GE(open, border * 0.99);
    }
  }
}

// The mask says which points moved: all those, and no others, whose places changed.
TEST(NURBSDeformingTessellator, TellsWhichPointsChanged)
{
  const auto grid = Shape(vtkNURBSShapeSource::SHEET);
  vtkNew<Filter> filter;
  filter->SetInputData(grid);
  filter->SetResolutionRefinement(0);
  filter->Update();
  vtkNew<vtkPoints> before;
  before->SetDataTypeToDouble();
  before->DeepCopy(Mesh(filter)->GetPoints());
  const vtkIdType middle = grid->GetNumberOfPoints() / 2 + 20;
  Eigen::Vector3d x(grid->GetPoint(middle));
  x[2] += 0.1 * scene::Size(grid);
  grid->GetPoints()->SetPoint(middle, x.data());
  grid->GetPoints()->Modified();
  filter->Update();
  vtkPolyData* mesh = Mesh(filter);
  ASSERT_EQ(mesh->GetNumberOfPoints(), before->GetNumberOfPoints());
  vtkDataArray* mask = mesh->GetPointData()->GetArray("Changed");
  vtkIdType first = -1, last = -1, moved = 0;
  for (vtkIdType k = 0; k < mesh->GetNumberOfPoints(); ++k)
  {
    const bool marked = mask->GetTuple1(k) != 0.0;
    if (Eigen::Vector3d(mesh->GetPoint(k)) != Eigen::Vector3d(before->GetPoint(k)))
    {
      EXPECT_TRUE(marked) << k;
      ++moved;
    }
    if (marked)
    {
      first = first < 0 ? k : first;
      last = k;
    }
  }
  EXPECT_EQ(filter->GetMovedControlPoints(), 1);
  EXPECT_GT(moved, 10);
  EXPECT_LT(moved, mesh->GetNumberOfPoints() / 10);
  EXPECT_GE(filter->GetUpdatedVertices(), moved);
  EXPECT_LE(filter->GetUpdatedVertices(), 3 * moved);
  EXPECT_EQ(FieldValue(mesh, "ChangedPointRange", 0), double(first));
  EXPECT_EQ(FieldValue(mesh, "ChangedPointRange", 1), double(last));
  EXPECT_EQ(FieldValue(mesh, "UpdatedVertices"), double(filter->GetUpdatedVertices()));
  filter->ChangedMaskOff();
  filter->Update();
  EXPECT_EQ(Mesh(filter)->GetPointData()->GetArray("Changed"), nullptr);
}

// VTK's own filters in front: points are new arrays each time, in floats too.
TEST(NURBSDeformingTessellator, FollowsWarpsAndTransforms)
{
  const auto grid = Shape(vtkNURBSShapeSource::TORUS);
  vtkNew<vtkDoubleArray> displacement;
  displacement->SetName("Displacement");
  displacement->SetNumberOfComponents(3);
  for (vtkIdType k = 0; k < grid->GetNumberOfPoints(); ++k)
  {
    const double* p = grid->GetPoint(k);
    displacement->InsertNextTuple3(0.0, 0.1 * p[2], std::sin(2.0 * p[0]) * std::cos(p[1]));
  }
  grid->GetPointData()->SetVectors(displacement);
  vtkNew<vtkWarpVector> warp;
  warp->SetInputData(grid);
  vtkNew<vtkTransform> transform;
  vtkNew<vtkTransformFilter> turn;
  turn->SetInputConnection(warp->GetOutputPort());
  turn->SetTransform(transform);
  for (const int precision : { vtkAlgorithm::DOUBLE_PRECISION, vtkAlgorithm::SINGLE_PRECISION })
  {
    warp->SetOutputPointsPrecision(precision);
    turn->SetOutputPointsPrecision(precision);
    vtkNew<Filter> filter;
    filter->SetInputConnection(turn->GetOutputPort());
    filter->SetTolerance(2e-3);
    for (int frame = 0; frame <= 10; ++frame)
    {
      SCOPED_TRACE(frame);
      warp->SetScaleFactor(0.03 * frame);
      transform->RotateZ(5.0);
      filter->Update();
      ASSERT_EQ(filter->GetErrorCode(), (unsigned long)vtkErrorCode::NoError);
      EXPECT_EQ(filter->GetRebuiltModels(), frame == 0 ? 1 : 0);
      EXPECT_EQ(scene::OpenEdges(Mesh(filter)), 0u);
      auto* now = vtkUnstructuredGrid::SafeDownCast(turn->GetOutput());
      // The warped sides of the torus are the same but for the rounding of floats.
      EXPECT_LE(scene::Compare(Mesh(filter), now).Point, filter->GetModelGap() + 1e-11);
    }
  }
}

// Weights that change, appear and go away again.
TEST(NURBSDeformingTessellator, FollowsWeights)
{
  const auto grid = Shape(vtkNURBSShapeSource::SHEET);
  ASSERT_EQ(vtkNURBSModel::GetWeights(grid), nullptr);
  vtkNew<Filter> filter;
  filter->SetInputData(grid);
  filter->Update();
  vtkNew<vtkDoubleArray> weights;
  weights->SetName("RationalWeights");
  for (vtkIdType k = 0; k < grid->GetNumberOfPoints(); ++k)
  {
    weights->InsertNextValue(1.0);
  }
  const auto expectFit = [&](const char* what) {
    SCOPED_TRACE(what);
    filter->Update();
    ASSERT_EQ(filter->GetErrorCode(), (unsigned long)vtkErrorCode::NoError);
    EXPECT_EQ(filter->GetRebuiltModels(), 0);
    const scene::Differences off = scene::Compare(Mesh(filter), grid);
    EXPECT_LE(off.Point, 1e-12 * scene::Size(grid));
    EXPECT_LE(off.Normal, 1e-6);
  };
  grid->GetPointData()->AddArray(weights);
  expectFit("ones");
  EXPECT_EQ(filter->GetMovedControlPoints(), 0);
  weights->SetValue(500, 5.0);
  weights->Modified();
  expectFit("one");
  EXPECT_EQ(filter->GetMovedControlPoints(), 1);
  for (vtkIdType k = 0; k < grid->GetNumberOfPoints(); ++k)
  {
    weights->SetValue(k, 1.0 + 0.5 * std::sin(double(k)));
  }
  weights->Modified();
  expectFit("all");
  grid->GetPointData()->RemoveArray("RationalWeights");
  expectFit("none");
}

// Section 5: what the camera is far from is coarser; a budget is kept.
TEST(NURBSDeformingTessellator, CamerasAndBudgets)
{
  const auto grid = Shape(vtkNURBSShapeSource::SHEET);
  const auto rest = scene::Rest(grid);
  vtkNew<Filter> filter;
  filter->SetInputData(grid);
  filter->SetTolerance(3e-5);
  filter->Update();
  const vtkIdType all = filter->GetNumberOfTriangles();
  double bounds[6];
  grid->GetBounds(bounds);
  vtkNew<vtkCamera> camera;
  const double size = scene::Size(grid);
  const auto lookAt = [&](double x, double y) {
    camera->SetFocalPoint(x, y, bounds[5]);
    camera->SetPosition(x, y, bounds[5] + 0.05 * size);
    camera->SetViewUp(0.0, 1.0, 0.0);
  };
  const auto near = [&](double x, double y) {
    vtkIdType count = 0;
    for (vtkIdType k = 0; k < Mesh(filter)->GetNumberOfPoints(); ++k)
    {
      const double* p = Mesh(filter)->GetPoint(k);
      count += std::hypot(p[0] - x, p[1] - y) < 0.15 * size;
    }
    return count;
  };
  lookAt(bounds[0], bounds[2]);
  filter->SetCamera(camera);
  filter->SetFullDetailDistance(0.2 * size);
  filter->SetSightAngle(80.0);
  filter->Update();
  EXPECT_LT(filter->GetNumberOfTriangles(), 4 * all / 5);
  EXPECT_GT(near(bounds[0], bounds[2]), 2 * near(bounds[1], bounds[3]));
  lookAt(bounds[1], bounds[3]);
  filter->Update();
  EXPECT_EQ(filter->GetRebuiltModels(), 0);
  EXPECT_GT(near(bounds[1], bounds[3]), 2 * near(bounds[0], bounds[2]));
  EXPECT_LE(scene::Compare(Mesh(filter), grid).Point, 1e-12 * size);
  filter->SetCamera(nullptr);
  filter->Update();
  EXPECT_EQ(filter->GetRebuiltModels(), 0);
  EXPECT_EQ(filter->GetNumberOfTriangles(), all);

  filter->SetTriangleBudget(all / 3);
  for (int frame = 0; frame < 5; ++frame)
  {
    scene::Wave(grid, rest, 0.02 * frame);
    filter->Update();
    EXPECT_LE(filter->GetNumberOfTriangles(), all / 3);
    EXPECT_GT(filter->GetNumberOfTriangles(), all / 12);
    EXPECT_GT(filter->GetToleranceUsed(), 3e-5 * size * 0.5);
    EXPECT_LE(filter->GetErrorBound(), filter->GetToleranceUsed() * (1.0 + 1e-9));
  }
}

// A CAD solid in a wave; opposite faces of its edges part a little, which ModelGap tells.
TEST(NURBSDeformingTessellator, SolidsStayClosed)
{
  const std::string folder = "/usr/share/opencascade/data/";
  for (const char* const file : { "step/screw.step", "step/linkrods.step", "occ/Top.brep" })
  {
    SCOPED_TRACE(file);
    const std::string path = folder + file;
    if (!std::ifstream(path))
    {
      FAIL() << path << " is missing; ./run installs Debian's occt-misc";
    }
    vtkNew<vtkNURBSCADReader> reader;
    reader->SetFileName(path.c_str());
    reader->Update();
    auto* read = vtkPartitionedDataSetCollection::SafeDownCast(reader->GetOutputDataObject(0));
    ASSERT_NE(read, nullptr);
    for (unsigned int p = 0; p < read->GetNumberOfPartitionedDataSets(); ++p)
    {
      vtkNew<vtkUnstructuredGrid> grid;
      grid->DeepCopy(read->GetPartition(p, 0));
      const auto rest = scene::Rest(grid);
      vtkNew<Filter> filter;
      filter->SetInputData(grid);
      filter->SetTolerance(2e-3);
      for (int frame = 0; frame <= 6; ++frame)
      {
        SCOPED_TRACE(frame);
        scene::Wave(grid, rest, 0.004 * frame);
        filter->Update();
        ASSERT_EQ(filter->GetErrorCode(), (unsigned long)vtkErrorCode::NoError);
        EXPECT_EQ(scene::OpenEdges(Mesh(filter)), 0u);
        EXPECT_LE(scene::Compare(Mesh(filter), grid).Point,
          filter->GetModelGap() + 1e-12 * scene::Size(grid));
      }
    }
  }
}

} // namespace
