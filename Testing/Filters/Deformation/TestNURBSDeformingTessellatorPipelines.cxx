// SPDX-License-Identifier: BSD-3-Clause
// vtkNURBSDeformingTessellator in pipelines: which arrays are touched, composite inputs, bad frames,
// structures that change, attributes, copies, options and errors.
#include "../../testMessageKeeper.h"
#include "vtkDeformingScene.h"

#include "vtkDoubleArray.h"
#include "vtkErrorCode.h"
#include "vtkExecutive.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkInformation.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkStringArray.h"

#include <cstring>
#include <functional>
#include <limits>

namespace
{

using scene::Mesh;
using scene::Shape;
using Filter = vtkNURBSDeformingTessellator;

vtkSmartPointer<vtkUnstructuredGrid> Sphere()
{
  return Shape(vtkNURBSShapeSource::SPHERE);
}

double FieldValue(vtkPolyData* mesh, const char* name, int component = 0)
{
  vtkDataArray* array = mesh->GetFieldData()->GetArray(name);
  return array ? array->GetComponent(0, component) : std::nan("");
}

/// Addresses and times of the arrays of a mesh.
struct Arrays
{
  explicit Arrays(vtkPolyData* mesh)
    : Of{ mesh->GetPoints()->GetData(), mesh->GetPointData()->GetNormals(),
      mesh->GetPointData()->GetArray("UV"), mesh->GetPolys(),
      mesh->GetPolys()->GetConnectivityArray(), mesh->GetPolys()->GetOffsetsArray(),
      mesh->GetCellData()->GetArray("FaceId"), mesh->GetCellData()->GetAbstractArray("Name"),
      mesh->GetPointData()->GetArray("Changed") }
  {
    for (vtkObject* array : this->Of)
    {
      EXPECT_NE(array, nullptr);
      this->Times.push_back(array->GetMTime());
    }
  }
  std::vector<vtkObject*> Of;
  std::vector<vtkMTimeType> Times;
};

// Points and normals change, all else is left alone as long as the triangles are the same.
TEST(NURBSDeformingTessellator, ArraysKeepTheirIdentity)
{
  const auto grid = Sphere();
  const auto rest = scene::Rest(grid);
  vtkNew<Filter> filter;
  filter->SetInputData(grid);
  filter->SetTolerance(1e-3);
  filter->Update();
  bool same = false, other = false;
  vtkIdType triangleCount = Mesh(filter)->GetNumberOfPolys();
  for (int frame = 1; frame <= 40; ++frame)
  {
    SCOPED_TRACE(frame);
    const Arrays before(Mesh(filter));
    scene::Wave(grid, rest, 0.1 * std::sin(0.05 * frame));
    filter->Update();
    const Arrays after(Mesh(filter));
    EXPECT_EQ(before.Of, after.Of);
    EXPECT_GT(after.Times[0], before.Times[0]);
    EXPECT_GT(after.Times[1], before.Times[1]);
    const bool numbers = filter->GetInsertedVertices() + filter->GetDeletedVertices() > 0;
    const bool triangles = FieldValue(Mesh(filter), "ChangedTriangleRange") >= 0.0;
    const bool count = Mesh(filter)->GetNumberOfPolys() != triangleCount;
    triangleCount = Mesh(filter)->GetNumberOfPolys();
    (numbers ? other : same) = true;
    EXPECT_EQ(after.Times[2] > before.Times[2], numbers);
    EXPECT_EQ(after.Times[3] > before.Times[3], triangles || count);
    EXPECT_EQ(after.Times[4] > before.Times[4], triangles || count);
    EXPECT_EQ(after.Times[5] > before.Times[5], count);
    EXPECT_EQ(after.Times[6] > before.Times[6], count);
    EXPECT_EQ(after.Times[7] > before.Times[7], count);
    EXPECT_EQ(Mesh(filter)->GetCellData()->GetArray("FaceId")->GetNumberOfTuples(),
      Mesh(filter)->GetNumberOfPolys());
    EXPECT_EQ(Mesh(filter)->GetCellData()->GetAbstractArray("Name")->GetNumberOfTuples(),
      Mesh(filter)->GetNumberOfPolys());
  }
  EXPECT_TRUE(same);
  EXPECT_TRUE(other);
  // Nothing at all changed.
  const Arrays before(Mesh(filter));
  const vtkMTimeType run = Mesh(filter)->GetMTime();
  filter->Update();
  EXPECT_EQ(Mesh(filter)->GetMTime(), run);
  grid->Modified();
  filter->Update();
  filter->Update();
  const Arrays after(Mesh(filter));
  EXPECT_EQ(before.Of, after.Of);
  EXPECT_EQ(std::vector<vtkMTimeType>(before.Times.begin(), before.Times.end() - 1),
    std::vector<vtkMTimeType>(after.Times.begin(), after.Times.end() - 1));
  EXPECT_EQ(filter->GetMovedControlPoints(), 0);
  EXPECT_EQ(FieldValue(Mesh(filter), "ChangedPointRange", 0), -1.0);
}

void SetPoint(vtkUnstructuredGrid* grid, vtkIdType point, double x, double y, double z)
{
  grid->GetPoints()->SetPoint(point, x, y, z);
  grid->GetPoints()->Modified();
}

// A bad frame names the control point, leaves the last mesh, and does not hurt the next frame.
TEST(NURBSDeformingTessellator, RefusesBadFramesAndRecovers)
{
  const auto grid = Sphere();
  const auto rest = scene::Rest(grid);
  vtkNew<MessageKeeper> errors;
  vtkNew<Filter> filter;
  filter->AddObserver(vtkCommand::ErrorEvent, errors);
  filter->SetInputData(grid);
  filter->Update();
  auto* weights = vtkDoubleArray::SafeDownCast(vtkNURBSModel::GetWeights(grid));
  ASSERT_NE(weights, nullptr);
  const double weight = weights->GetValue(4);
  const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
  const struct
  {
    const char* Says;
    std::function<void()> Spoil;
  } cases[] = {
    { "point 7, is not finite", [&]() { SetPoint(grid, 7, 0.0, nan, 0.0); } },
    { "point 3, is not finite", [&]() { SetPoint(grid, 3, infinite, 0.0, 0.0); } },
    { "point 5, moved by", [&]() { SetPoint(grid, 5, 0.0, 0.0, 1e30); } },
    { "point 4, has the weight 0", [&]() { weights->SetValue(4, 0.0); } },
    { "point 4, has the weight -1", [&]() { weights->SetValue(4, -1.0); } },
    { "point 4, is not finite", [&]() { weights->SetValue(4, nan); } },
    { "in one place",
      [&]() {
        for (vtkIdType k = 0; k < grid->GetNumberOfPoints(); ++k)
        {
          SetPoint(grid, k, 1.0, 2.0, 3.0);
        }
      } },
  };
  double height = 0.01;
  for (const auto& bad : cases)
  {
    SCOPED_TRACE(bad.Says);
    vtkNew<vtkPolyData> before;
    before->DeepCopy(Mesh(filter));
    bad.Spoil();
    weights->Modified();
    for (int again = 0; again < 2; ++again)
    {
      errors->Text.clear();
      filter->Update();
      EXPECT_TRUE(errors->Says(bad.Says)) << errors->Text;
      EXPECT_TRUE(errors->Says("face ")) << errors->Text;
      EXPECT_EQ(filter->GetErrorCode(), (unsigned long)vtkErrorCode::UserError);
      EXPECT_EQ(filter->GetRefusedModels(), 1);
      ASSERT_EQ(Mesh(filter)->GetNumberOfPolys(), before->GetNumberOfPolys());
      ASSERT_EQ(Mesh(filter)->GetNumberOfPoints(), before->GetNumberOfPoints());
      for (vtkIdType k = 0; k < before->GetNumberOfPoints(); ++k)
      {
        ASSERT_EQ(Eigen::Vector3d(Mesh(filter)->GetPoint(k)), Eigen::Vector3d(before->GetPoint(k)));
      }
      filter->Modified();
    }
    weights->SetValue(4, weight);
    weights->Modified();
    scene::Wave(grid, rest, height += 0.01);
    errors->Text.clear();
    filter->Update();
    EXPECT_EQ(errors->Text, "");
    EXPECT_EQ(filter->GetErrorCode(), (unsigned long)vtkErrorCode::NoError);
    EXPECT_EQ(filter->GetRebuiltModels(), 0);
    EXPECT_LE(scene::Compare(Mesh(filter), grid).Point, filter->GetModelGap() + 1e-11);
    EXPECT_EQ(scene::OpenEdges(Mesh(filter)), 0u);
  }
}

TEST(NURBSDeformingTessellator, RefusesABadFirstFrame)
{
  for (int bad = 0; bad < 4; ++bad)
  {
    SCOPED_TRACE(bad);
    const auto grid = Sphere();
    const auto rest = scene::Rest(grid);
    auto* weights = vtkDoubleArray::SafeDownCast(vtkNURBSModel::GetWeights(grid));
    const double weight = weights->GetValue(4);
    for (vtkIdType k = 0; bad == 3 && k < grid->GetNumberOfPoints(); ++k)
    {
      SetPoint(grid, k, 1.0, 2.0, 3.0);
    }
    if (bad < 2)
    {
      SetPoint(grid, 7, 0.0, bad == 0 ? std::nan("") : 1e300, 0.0);
    }
    weights->SetValue(4, bad == 2 ? -1.0 : weight);
    vtkNew<MessageKeeper> errors;
    vtkNew<Filter> filter;
    filter->AddObserver(vtkCommand::ErrorEvent, errors);
    vtkNew<MessageKeeper> failures;
    filter->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, failures);
    filter->SetInputData(grid);
    filter->Update();
    EXPECT_EQ(filter->GetErrorCode(), (unsigned long)vtkErrorCode::UserError);
    EXPECT_EQ(Mesh(filter)->GetNumberOfPolys(), 0);
    EXPECT_EQ(Mesh(filter)->GetFieldData()->GetArray("Knots"), nullptr);
    weights->SetValue(4, weight);
    weights->Modified();
    scene::Wave(grid, rest, 0.0);
    filter->Update();
    EXPECT_EQ(filter->GetErrorCode(), (unsigned long)vtkErrorCode::NoError);
    EXPECT_GT(Mesh(filter)->GetNumberOfPolys(), 0);
    EXPECT_EQ(scene::OpenEdges(Mesh(filter)), 0u);
  }
}

// Knots that change mesh the model anew, in new arrays; equal ones in other arrays do not. Bad ones
// leave the mesh.
TEST(NURBSDeformingTessellator, StructuresThatChange)
{
  const auto grid = Sphere();
  vtkNew<MessageKeeper> errors;
  vtkNew<Filter> filter;
  filter->AddObserver(vtkCommand::ErrorEvent, errors);
  filter->SetInputData(grid);
  filter->Update();
  const vtkSmartPointer<vtkPoints> first = Mesh(filter)->GetPoints();
  const vtkIdType count = first->GetNumberOfPoints();
  const auto copy = Sphere();
  filter->SetInputData(copy);
  filter->Update();
  EXPECT_EQ(filter->GetRebuiltModels(), 0);
  EXPECT_EQ(Mesh(filter)->GetPoints(), first);
  // Edited in place: the double knot in the middle of u moves.
  auto* knots = vtkDoubleArray::SafeDownCast(copy->GetFieldData()->GetArray("Knots"));
  ASSERT_NE(knots, nullptr);
  const std::vector<double> before(
    knots->GetPointer(0), knots->GetPointer(0) + knots->GetNumberOfValues());
  const double start = knots->GetValue(0);
  vtkIdType k = 0;
  while (knots->GetValue(k) == start)
  {
    ++k;
  }
  const double inner = knots->GetValue(k);
  for (vtkIdType j = k; knots->GetValue(j) == inner; ++j)
  {
    knots->SetValue(j, inner + 0.1 * (inner - start));
  }
  knots->Modified();
  filter->Update();
  EXPECT_EQ(filter->GetRebuiltModels(), 1);
  EXPECT_NE(Mesh(filter)->GetPoints(), first);
  EXPECT_EQ(first->GetNumberOfPoints(), count);
  EXPECT_LE(scene::Compare(Mesh(filter), copy).Point, 1e-12);
  const vtkSmartPointer<vtkPoints> second = Mesh(filter)->GetPoints();
  knots->SetValue(k, 1e9);
  knots->Modified();
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), (unsigned long)vtkErrorCode::UserError);
  EXPECT_TRUE(errors->Says("knot ")) << errors->Text;
  EXPECT_EQ(Mesh(filter)->GetPoints(), second);
  EXPECT_GT(Mesh(filter)->GetNumberOfPolys(), 0);
  std::copy(before.begin(), before.end(), knots->GetPointer(0));
  knots->Modified();
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), (unsigned long)vtkErrorCode::NoError);
  EXPECT_LE(scene::Compare(Mesh(filter), copy).Point, 1e-12);
}

// Where one face of several has other knots it alone is made anew.
TEST(NURBSDeformingTessellator, FacesThatChange)
{
  const auto grid = Shape(vtkNURBSShapeSource::TEAPOT);
  const auto rest = scene::Rest(grid);
  vtkNew<Filter> filter;
  filter->SetInputData(grid);
  filter->SetTolerance(1e-3);
  filter->Update();
  const vtkSmartPointer<vtkPoints> points = Mesh(filter)->GetPoints();
  auto* knots = vtkDoubleArray::SafeDownCast(grid->GetFieldData()->GetArray("Knots"));
  vtkDataArray* starts = grid->GetCellData()->GetArray("KnotStart");
  vtkDataArray* sizes = grid->GetCellData()->GetArray("NetSize");
  ASSERT_TRUE(knots && starts && sizes);
  for (int frame = 1; frame <= 3; ++frame)
  {
    // The end of a face's knots of v, where the weights of its last row are all that counts.
    const vtkIdType cell = 3 * frame;
    const auto first = vtkIdType(starts->GetComponent(cell, 1));
    const auto last = first + vtkIdType(sizes->GetComponent(cell, 1)) + 3;
    knots->SetValue(first, knots->GetValue(first) - 0.25 * frame);
    EXPECT_GT(knots->GetValue(last), knots->GetValue(first));
    knots->Modified();
    scene::Wave(grid, rest, 0.01 * frame);
    filter->Update();
    EXPECT_EQ(filter->GetErrorCode(), (unsigned long)vtkErrorCode::NoError);
    EXPECT_EQ(filter->GetRebuiltModels(), 0);
    EXPECT_GE(filter->GetReplacedFaces(), 1);
    EXPECT_LT(filter->GetReplacedFaces(), grid->GetNumberOfCells() / 2);
    EXPECT_EQ(Mesh(filter)->GetPoints(), points);
    EXPECT_LE(
      scene::Compare(Mesh(filter), grid).Point, filter->GetModelGap() + 1e-12 * scene::Size(grid));
    double open = 0.0;
    scene::OpenEdges(Mesh(filter), &open);
    const double border = scene::BorderLength(grid);
    EXPECT_LE(open, border * (1.0 + 1e-9));
    EXPECT_GE(open, border * 0.98);
  }
}

// Knots that are overwritten without a word do not reach the kernel, which works on copies.
TEST(NURBSDeformingTessellator, KeepsCopiesOfTheStructure)
{
  const auto grid = Sphere();
  const auto same = Sphere();
  const auto rest = scene::Rest(grid);
  vtkNew<Filter> filter;
  filter->SetInputData(grid);
  filter->Update();
  for (const char* name : { "Knots", "TrimPoints", "TrimKnots" })
  {
    if (vtkDataArray* array = grid->GetFieldData()->GetArray(name))
    {
      std::memset(array->GetVoidPointer(0), 0, std::size_t(array->GetNumberOfValues()) * 8);
    }
  }
  scene::Wave(grid, rest, 0.03);
  scene::Wave(same, rest, 0.03);
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), (unsigned long)vtkErrorCode::NoError);
  EXPECT_LE(scene::Compare(Mesh(filter), same).Point, filter->GetModelGap() + 1e-12);
}

// Blocks: one is bad, one rests, one moves.
TEST(NURBSDeformingTessellator, Composites)
{
  const vtkSmartPointer<vtkUnstructuredGrid> grids[] = { Sphere(),
    Shape(vtkNURBSShapeSource::TORUS), Shape(vtkNURBSShapeSource::CYLINDER) };
  vtkNew<vtkPartitionedDataSetCollection> input;
  for (unsigned int k = 0; k < 3; ++k)
  {
    input->SetPartition(k, 0, grids[k]);
    input->GetMetaData(k)->Set(
      vtkCompositeDataSet::NAME(), k == 0 ? "ball" : (k == 1 ? "ring" : "post"));
  }
  vtkNew<MessageKeeper> errors;
  vtkNew<Filter> filter;
  filter->AddObserver(vtkCommand::ErrorEvent, errors);
  filter->SetInputDataObject(input);
  filter->Update();
  auto* output = vtkPartitionedDataSetCollection::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_NE(output, nullptr);
  ASSERT_EQ(output->GetNumberOfPartitionedDataSets(), 3u);
  EXPECT_STREQ(output->GetMetaData(1)->Get(vtkCompositeDataSet::NAME()), "ring");
  const auto mesh = [&](unsigned int k) {
    return vtkPolyData::SafeDownCast(output->GetPartition(k, 0));
  };
  vtkPolyData* const meshes[] = { mesh(0), mesh(1), mesh(2) };
  vtkIdType triangles = 0;
  for (unsigned int k = 0; k < 3; ++k)
  {
    ASSERT_NE(mesh(k), nullptr);
    EXPECT_EQ(scene::OpenEdges(mesh(k)), 0u);
    triangles += mesh(k)->GetNumberOfPolys();
  }
  EXPECT_EQ(filter->GetNumberOfTriangles(), triangles);
  const Arrays resting(mesh(1));
  const vtkMTimeType ball = mesh(0)->GetPoints()->GetMTime();
  const vtkMTimeType post = mesh(2)->GetPoints()->GetMTime();
  SetPoint(grids[0], 3, std::nan(""), 0.0, 0.0);
  scene::Wave(grids[2], scene::Rest(grids[2]), 0.05);
  input->Modified();
  filter->Update();
  EXPECT_TRUE(errors->Says("block 0 (ball): face ")) << errors->Text;
  EXPECT_EQ(filter->GetRefusedModels(), 1);
  for (unsigned int k = 0; k < 3; ++k)
  {
    EXPECT_EQ(mesh(k), meshes[k]);
    EXPECT_EQ(scene::OpenEdges(mesh(k)), 0u);
  }
  EXPECT_EQ(mesh(0)->GetPoints()->GetMTime(), ball);
  EXPECT_GT(mesh(2)->GetPoints()->GetMTime(), post);
  EXPECT_EQ(Arrays(mesh(1)).Of, resting.Of);
  EXPECT_EQ(mesh(1)->GetPoints()->GetData()->GetMTime(), resting.Times[0]);
  EXPECT_LE(scene::Compare(mesh(2), grids[2]).Point, filter->GetModelGap() + 1e-12);
}

/// Aborts a filter when it is half done.
class Aborter : public vtkCommand
{
public:
  static Aborter* New() { return new Aborter; }
  void Execute(vtkObject* caller, unsigned long, void* progress) override
  {
    if (*static_cast<double*>(progress) > 0.4)
    {
      vtkAlgorithm::SafeDownCast(caller)->SetAbortExecute(1);
    }
  }
};

// Blocks that an abort leaves out keep their meshes until the next update.
TEST(NURBSDeformingTessellator, Aborts)
{
  const vtkSmartPointer<vtkUnstructuredGrid> grids[] = { Sphere(), Sphere() };
  const auto rest = scene::Rest(grids[0]);
  vtkNew<vtkPartitionedDataSetCollection> input;
  input->SetPartition(0, 0, grids[0]);
  input->SetPartition(1, 0, grids[1]);
  vtkNew<Filter> filter;
  filter->SetInputDataObject(input);
  filter->Update();
  vtkNew<Aborter> aborter;
  const unsigned long tag = filter->AddObserver(vtkCommand::ProgressEvent, aborter);
  for (const auto& grid : grids)
  {
    scene::Wave(grid, rest, 0.05);
  }
  input->Modified();
  filter->Update();
  auto* output = vtkPartitionedDataSetCollection::SafeDownCast(filter->GetOutputDataObject(0));
  const auto mesh = [&](unsigned int k) {
    return vtkPolyData::SafeDownCast(output->GetPartition(k, 0));
  };
  EXPECT_LE(scene::Compare(mesh(0), grids[0]).Point, filter->GetModelGap() + 1e-12);
  EXPECT_GT(scene::Compare(mesh(1), grids[1]).Point, 0.01);
  EXPECT_EQ(scene::OpenEdges(mesh(1)), 0u);
  EXPECT_EQ(filter->GetMovedControlPoints(), grids[0]->GetNumberOfPoints());
  filter->RemoveObserver(tag);
  filter->SetAbortExecute(0);
  filter->Modified();
  filter->Update();
  EXPECT_LE(scene::Compare(mesh(1), grids[1]).Point, filter->GetModelGap() + 1e-12);
}

// Attributes of faces follow those of the input, and new values of an array replace it alone.
TEST(NURBSDeformingTessellator, AttributesOfFaces)
{
  const auto grid = Shape(vtkNURBSShapeSource::CYLINDER);
  const auto rest = scene::Rest(grid);
  vtkNew<vtkFloatArray> heat;
  heat->SetName("Heat");
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    heat->InsertNextValue(10.0f + float(c));
  }
  grid->GetCellData()->AddArray(heat);
  vtkNew<Filter> filter;
  filter->SetInputData(grid);
  filter->SetTolerance(1e-3);
  const auto expectFit = [&]() {
    vtkCellData* data = Mesh(filter)->GetCellData();
    vtkDataArray* ids = data->GetArray("FaceId");
    vtkDataArray* heats = data->GetArray("Heat");
    auto* names = vtkStringArray::SafeDownCast(data->GetAbstractArray("Name"));
    auto* given = vtkStringArray::SafeDownCast(grid->GetCellData()->GetAbstractArray("Name"));
    ASSERT_TRUE(ids && heats && names && given);
    ASSERT_EQ(heats->GetNumberOfTuples(), Mesh(filter)->GetNumberOfPolys());
    std::map<vtkIdType, vtkIdType> cellOf;
    for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
    {
      cellOf[vtkNURBSModel::GetFaceId(grid, c)] = c;
    }
    for (vtkIdType t = 0; t < Mesh(filter)->GetNumberOfPolys(); ++t)
    {
      const vtkIdType cell = cellOf.at(vtkIdType(ids->GetTuple1(t)));
      ASSERT_EQ(heats->GetTuple1(t), double(heat->GetValue(cell)));
      ASSERT_EQ(names->GetValue(t), given->GetValue(cell));
    }
    EXPECT_EQ(data->GetArray("Degree"), nullptr);
  };
  vtkIdType most = 0, least = VTK_ID_MAX;
  for (int frame = 0; frame < 25; ++frame)
  {
    scene::Wave(grid, rest, 0.1 * std::sin(0.25 * frame));
    filter->Update();
    expectFit();
    // Points are the right face's.
    EXPECT_LE(scene::Compare(Mesh(filter), grid).Point, filter->GetModelGap() + 1e-12);
    most = std::max(most, filter->GetNumberOfTriangles());
    least = std::min(least, filter->GetNumberOfTriangles());
  }
  EXPECT_GT(most, least);
  heat->SetValue(0, 99.0f);
  heat->Modified();
  filter->Update();
  expectFit();
  EXPECT_EQ(filter->GetMovedControlPoints(), 0);
}

TEST(NURBSDeformingTessellator, CopiesAndLifetimes)
{
  const auto grid = Sphere();
  const auto rest = scene::Rest(grid);
  vtkNew<vtkPolyData> shallow, deep;
  {
    vtkNew<Filter> filter;
    filter->SetInputData(grid);
    filter->SetResolutionRefinement(0);
    filter->Update();
    shallow->ShallowCopy(Mesh(filter));
    deep->DeepCopy(Mesh(filter));
    double bounds[6];
    shallow->GetBounds(bounds);
    scene::Wave(grid, rest, 0.2);
    filter->Update();
    EXPECT_GT(shallow->GetLength(), 1.01 * deep->GetLength());
    EXPECT_EQ(shallow->GetLength(), Mesh(filter)->GetLength());
  }
  EXPECT_LE(scene::Compare(shallow, grid).Point, 1e-12);
  scene::Wave(grid, rest, 0.0);
  EXPECT_LE(scene::Compare(deep, grid).Point, 1e-12);
}

TEST(NURBSDeformingTessellator, OptionsAndErrors)
{
  const auto grid = Sphere();
  vtkNew<MessageKeeper> errors, warnings;
  vtkNew<Filter> filter;
  filter->AddObserver(vtkCommand::ErrorEvent, errors);
  filter->AddObserver(vtkCommand::WarningEvent, warnings);
  vtkNew<MessageKeeper> failures;
  filter->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, failures);
  filter->SetInputData(grid);
  filter->SetPatchSubdivisions(2);
  filter->Update();
  const vtkIdType coarse = filter->GetNumberOfTriangles();
  filter->SetPatchSubdivisions(3);
  filter->Update();
  EXPECT_EQ(filter->GetRebuiltModels(), 1);
  EXPECT_NEAR(double(filter->GetNumberOfTriangles()) / double(coarse), 4.0, 0.7);
  filter->Reset();
  filter->Update();
  EXPECT_EQ(filter->GetRebuiltModels(), 1);
  filter->SetPatchSubdivisions(-1);
  filter->SetToleranceModeToAbsolute();
  filter->SetAbsoluteTolerance(0.01);
  filter->Update();
  EXPECT_EQ(filter->GetToleranceUsed(), 0.01);
  EXPECT_LE(filter->GetErrorBound(), 0.01 + 1e-12);
  filter->SetAbsoluteTolerance(-1.0);
  filter->Update();
  EXPECT_TRUE(errors->Says("AbsoluteTolerance")) << errors->Text;
  EXPECT_EQ(Mesh(filter)->GetNumberOfPolys(), 0);
  filter->SetAbsoluteTolerance(0.01);
  vtkNew<vtkUnstructuredGrid> other;
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(0.0, 0.0, 0.0);
  other->SetPoints(points);
  const vtkIdType id = 0;
  other->InsertNextCell(VTK_VERTEX, 1, &id);
  filter->SetInputData(other);
  filter->Update();
  EXPECT_TRUE(errors->Says("not a NURBS model")) << errors->Text;
  // One face of three is bad for other reasons than its points.
  const auto three = Shape(vtkNURBSShapeSource::CYLINDER);
  ASSERT_GE(three->GetNumberOfCells(), 2);
  three->GetCellData()->GetArray("Degree")->SetComponent(1, 0, 77);
  filter->SetInputData(three);
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), (unsigned long)vtkErrorCode::NoError);
  EXPECT_TRUE(warnings->Says("1 faces have no triangles")) << warnings->Text;
  EXPECT_TRUE(warnings->Says("degree 77")) << warnings->Text;
  EXPECT_GT(Mesh(filter)->GetNumberOfPolys(), 0);
}

} // namespace
