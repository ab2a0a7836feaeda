// SPDX-License-Identifier: BSD-3-Clause
// vtkNURBSTessellator in pipelines: arrays, composite inputs, tolerances, merged points, threads,
// errors and abort, on shapes with closed forms.
#include "vtkNURBSModel.h"
#include "vtkNURBSParallel.h"
#include "vtkNURBSShapeSource.h"
#include "vtkNURBSTessellator.h"

#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataAssembly.h"
#include "vtkErrorCode.h"
#include "vtkExecutive.h"
#include "vtkFeatureEdges.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkMassProperties.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSMPTools.h"
#include "vtkStringArray.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <condition_variable>
#include <cstring>
#include <map>
#include <mutex>
#include <set>

namespace
{

vtkPolyData* Mesh(vtkNURBSTessellator* tessellator)
{
  return vtkPolyData::SafeDownCast(tessellator->GetOutputDataObject(0));
}

vtkPolyData* Lines(vtkNURBSTessellator* tessellator)
{
  return vtkPolyData::SafeDownCast(tessellator->GetOutputDataObject(1));
}

vtkSmartPointer<vtkUnstructuredGrid> Shape(int type)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShape(type);
  source->Update();
  return vtkUnstructuredGrid::SafeDownCast(source->GetOutputDataObject(0));
}

double FieldValue(vtkDataObject* data, const char* name)
{
  return data->GetFieldData()->GetArray(name)->GetTuple1(0);
}

TEST(NURBSTessellator, GivesASphereItsArraysAndItsError)
{
  vtkNew<vtkNURBSShapeSource> source;
  vtkNew<vtkNURBSTessellator> tessellator;
  tessellator->SetInputConnection(source->GetOutputPort());
  tessellator->Update();
  vtkPolyData* mesh = Mesh(tessellator);
  ASSERT_TRUE(mesh && mesh->GetNumberOfPolys() > 0);
  const double tolerance = 1e-3 * std::sqrt(12.0);
  EXPECT_NEAR(tessellator->GetToleranceUsed(), tolerance, 1e-12);
  EXPECT_LE(tessellator->GetCertifiedError(), tolerance);
  EXPECT_EQ(tessellator->GetNumberOfTriangles(), mesh->GetNumberOfPolys());
  EXPECT_EQ(tessellator->GetNumberOfFaces(), 1);
  EXPECT_EQ(tessellator->GetNumberOfFailedFaces(), 0);
  vtkDataArray* normals = mesh->GetPointData()->GetNormals();
  vtkDataArray* uv = mesh->GetPointData()->GetArray("UV");
  ASSERT_TRUE(normals && uv);
  EXPECT_EQ(uv->GetNumberOfComponents(), 2);
  EXPECT_EQ(mesh->GetPoints()->GetDataType(), VTK_DOUBLE);
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    const double* p = mesh->GetPoint(i);
    ASSERT_NEAR(std::hypot(p[0], p[1], p[2]), 1.0, 1e-12);
    double n[3];
    normals->GetTuple(i, n);
    ASSERT_NEAR(p[0] * n[0] + p[1] * n[1] + p[2] * n[2], 1.0, 1e-6);
  }
  EXPECT_EQ(mesh->GetCellData()->GetAbstractArray(vtkNURBSModel::FaceIdName())->GetNumberOfTuples(),
    mesh->GetNumberOfPolys());
  EXPECT_FALSE(mesh->GetCellData()->HasArray("KnotStart"));
  EXPECT_FALSE(mesh->GetFieldData()->HasArray("Knots"));
  EXPECT_EQ(FieldValue(mesh, "Tolerance"), tessellator->GetToleranceUsed());
  EXPECT_EQ(FieldValue(mesh, "CertifiedError"), tessellator->GetCertifiedError());
  EXPECT_EQ(FieldValue(mesh, "FaceCertifiedError"), tessellator->GetCertifiedError());
  EXPECT_EQ(FieldValue(mesh, "NumberOfTriangles"), double(mesh->GetNumberOfPolys()));
  EXPECT_EQ(FieldValue(mesh, "FaceStatus"), 0.0);
  EXPECT_EQ(mesh->GetFieldData()->GetAbstractArray("FaceStatusMessage")->GetNumberOfValues(), 1);
}

TEST(NURBSTessellator, ClosesSolidsWhenPointsAreMerged)
{
  for (int shape : { vtkNURBSShapeSource::SPHERE, vtkNURBSShapeSource::TORUS,
         vtkNURBSShapeSource::CYLINDER, vtkNURBSShapeSource::CONE })
  {
    vtkNew<vtkNURBSTessellator> tessellator;
    tessellator->SetInputData(Shape(shape));
    tessellator->MergePointsOn();
    tessellator->Update();
    vtkNew<vtkFeatureEdges> edges;
    edges->SetInputData(Mesh(tessellator));
    edges->FeatureEdgesOff();
    edges->Update();
    EXPECT_EQ(edges->GetOutput()->GetNumberOfLines(), 0) << shape;
    EXPECT_EQ(Mesh(tessellator)->GetPointData()->GetNormals(), nullptr);
    vtkNew<vtkMassProperties> mass;
    mass->SetInputData(Mesh(tessellator));
    mass->Update();
    EXPECT_GT(mass->GetVolume(), 0.0) << shape;
  }
}

TEST(NURBSTessellator, MergesWithoutMovingAnything)
{
  vtkNew<vtkNURBSTessellator> tessellator;
  tessellator->SetInputData(Shape(vtkNURBSShapeSource::CYLINDER));
  tessellator->Update();
  vtkNew<vtkMassProperties> apart;
  apart->SetInputData(Mesh(tessellator));
  apart->Update();
  const vtkIdType points = Mesh(tessellator)->GetNumberOfPoints();
  const double area = apart->GetSurfaceArea();
  tessellator->MergePointsOn();
  tessellator->Update();
  vtkNew<vtkMassProperties> joined;
  joined->SetInputData(Mesh(tessellator));
  joined->Update();
  EXPECT_LT(Mesh(tessellator)->GetNumberOfPoints(), points);
  EXPECT_NEAR(joined->GetSurfaceArea(), area, 1e-9 * area);
}

TEST(NURBSTessellator, MeetsEveryToleranceWithEveryMethod)
{
  vtkNew<vtkNURBSTessellator> tessellator;
  tessellator->SetInputData(Shape(vtkNURBSShapeSource::TORUS));
  tessellator->SetToleranceModeToAbsolute();
  for (double tolerance : { 0.1, 0.01, 1e-3 })
  {
    tessellator->SetAbsoluteTolerance(tolerance);
    for (int method = 0; method < 3; ++method)
    {
      tessellator->SetMethod(method);
      tessellator->SetErrorModeToGuaranteed();
      tessellator->Update();
      EXPECT_LE(tessellator->GetCertifiedError(), tolerance) << method;
      const vtkIdType guaranteed = tessellator->GetNumberOfTriangles();
      tessellator->SetErrorModeToEstimated();
      tessellator->Update();
      EXPECT_LE(tessellator->GetNumberOfTriangles(), guaranteed) << method;
      EXPECT_GT(tessellator->GetNumberOfTriangles(), 0) << method;
    }
  }
}

TEST(NURBSTessellator, KeepsTheTreeOfCompositeInputs)
{
  vtkNew<vtkPartitionedDataSetCollection> models;
  models->SetNumberOfPartitionedDataSets(3);
  models->SetPartition(0, 0, Shape(vtkNURBSShapeSource::SPHERE));
  models->SetPartition(1, 0, vtkSmartPointer<vtkUnstructuredGrid>::New()); // empty
  models->SetPartition(2, 0, Shape(vtkNURBSShapeSource::CYLINDER));
  vtkNew<vtkDataAssembly> assembly;
  assembly->SetRootNodeName("machine");
  models->SetDataAssembly(assembly);
  vtkNew<vtkNURBSTessellator> tessellator;
  tessellator->SetInputDataObject(0, models);
  tessellator->Update();
  auto* meshes = vtkPartitionedDataSetCollection::SafeDownCast(tessellator->GetOutputDataObject(0));
  auto* lines = vtkPartitionedDataSetCollection::SafeDownCast(tessellator->GetOutputDataObject(1));
  ASSERT_TRUE(meshes && lines);
  ASSERT_EQ(meshes->GetNumberOfPartitionedDataSets(), 3u);
  EXPECT_STREQ(meshes->GetDataAssembly()->GetRootNodeName(), "machine");
  auto* sphere = vtkPolyData::SafeDownCast(meshes->GetPartition(0, 0));
  auto* cylinder = vtkPolyData::SafeDownCast(meshes->GetPartition(2, 0));
  ASSERT_TRUE(sphere && cylinder);
  EXPECT_EQ(tessellator->GetNumberOfFaces(), 4);
  EXPECT_EQ(
    tessellator->GetNumberOfTriangles(), sphere->GetNumberOfPolys() + cylinder->GetNumberOfPolys());
  EXPECT_EQ(cylinder->GetFieldData()->GetArray("FaceIds")->GetNumberOfTuples(), 3);
  double range[2];
  auto* border = vtkPolyData::SafeDownCast(lines->GetPartition(2, 0));
  border->GetCellData()->GetArray(vtkNURBSModel::EdgeIdName())->GetRange(range);
  EXPECT_GE(range[0], 0.0);
  EXPECT_LT(range[1], 10.0);
  border->GetCellData()->GetArray(vtkNURBSModel::FaceIdName())->GetRange(range);
  EXPECT_EQ(range[0], 0.0);
  EXPECT_EQ(range[1], 2.0);

  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, Shape(vtkNURBSShapeSource::SPHERE));
  tessellator->SetInputDataObject(0, blocks);
  tessellator->Update();
  auto* output = vtkMultiBlockDataSet::SafeDownCast(tessellator->GetOutputDataObject(0));
  ASSERT_TRUE(output);
  EXPECT_TRUE(vtkPolyData::SafeDownCast(output->GetBlock(0)));
}

TEST(NURBSTessellator, SharesEdgesBitForBitOnTheSecondPort)
{
  vtkNew<vtkNURBSTessellator> tessellator;
  tessellator->SetInputData(Shape(vtkNURBSShapeSource::CYLINDER));
  tessellator->Update();
  vtkPolyData* lines = Lines(tessellator);
  ASSERT_GT(lines->GetNumberOfLines(), 3);
  std::map<vtkIdType, std::vector<std::set<std::array<double, 3>>>> uses;
  vtkDataArray* edges = lines->GetCellData()->GetArray(vtkNURBSModel::EdgeIdName());
  for (vtkIdType c = 0; c < lines->GetNumberOfLines(); ++c)
  {
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    lines->GetLines()->GetCellAtId(c, size, ids);
    std::set<std::array<double, 3>> points;
    for (vtkIdType k = 0; k < size; ++k)
    {
      const double* p = lines->GetPoint(ids[k]);
      points.insert({ p[0], p[1], p[2] });
    }
    uses[vtkIdType(edges->GetTuple1(c))].push_back(points);
  }
  for (const auto& use : uses)
  {
    ASSERT_EQ(use.second.size(), 2u) << "edge " << use.first;
    EXPECT_EQ(use.second[0], use.second[1]) << "edge " << use.first;
  }
}

/// Two arrays, null ones included, hold the same bits.
bool SameBits(vtkDataArray* a, vtkDataArray* b)
{
  return (!a && !b) ||
    (a && b && a->GetDataType() == b->GetDataType() &&
      a->GetNumberOfValues() == b->GetNumberOfValues() &&
      (a->GetNumberOfValues() == 0 ||
        std::memcmp(a->GetVoidPointer(0), b->GetVoidPointer(0),
          static_cast<std::size_t>(a->GetNumberOfValues()) * a->GetDataTypeSize()) == 0));
}

void ExpectSameMesh(vtkPolyData* a, vtkPolyData* b)
{
  ASSERT_TRUE(a && b);
  EXPECT_GT(a->GetNumberOfCells(), 0);
  EXPECT_TRUE(SameBits(a->GetPoints()->GetData(), b->GetPoints()->GetData()));
  for (vtkCellArray* (vtkPolyData::*cells)() : { &vtkPolyData::GetPolys, &vtkPolyData::GetLines })
  {
    EXPECT_TRUE(
      SameBits((a->*cells)()->GetConnectivityArray(), (b->*cells)()->GetConnectivityArray()));
  }
  const auto same = [](vtkFieldData* x, vtkFieldData* y) {
    ASSERT_EQ(x->GetNumberOfArrays(), y->GetNumberOfArrays());
    for (int i = 0; i < x->GetNumberOfArrays(); ++i)
    {
      EXPECT_TRUE(SameBits(x->GetArray(i), y->GetArray(i))) << x->GetArrayName(i);
    }
  };
  same(a->GetPointData(), b->GetPointData());
  same(a->GetCellData(), b->GetCellData());
  same(a->GetFieldData(), b->GetFieldData());
}

TEST(NURBSTessellator, DoesNotDependOnTheThreads)
{
  vtkNew<vtkNURBSTessellator> tessellator;
  tessellator->SetTolerance(3e-4);
  for (int shape :
    { vtkNURBSShapeSource::TEAPOT, vtkNURBSShapeSource::SHEET, vtkNURBSShapeSource::CAR_BODY })
  {
    SCOPED_TRACE(shape);
    tessellator->SetInputData(Shape(shape));
    vtkNew<vtkPolyData> mesh, lines;
    for (int threads : { 1, 2, 3 })
    {
      vtkSMPTools::Initialize(threads);
      tessellator->Modified();
      tessellator->Update();
      if (threads == 1)
      {
        mesh->DeepCopy(Mesh(tessellator));
        lines->DeepCopy(Lines(tessellator));
        continue;
      }
      ExpectSameMesh(Mesh(tessellator), mesh);
      ExpectSameMesh(Lines(tessellator), lines);
    }
  }
  vtkSMPTools::Initialize(0);
}

TEST(NURBSTessellator, RunsInParallelWhateverTheDefaultBackend)
{
  const std::string before = vtkSMPTools::GetBackend();
  vtkSMPTools::Initialize(2);
  {
    const vtkNURBSParallelScope parallel;
    ASSERT_EQ(vtkSMPTools::GetEstimatedNumberOfThreads(), 2);
    // Each of two items waits until the other has come, which takes two threads.
    std::mutex mutex;
    std::condition_variable arrival;
    int arrived = 0;
    bool met = true;
    vtkNURBSParallelFor(0, 2, [&](std::int64_t begin, std::int64_t end) {
      std::unique_lock<std::mutex> lock(mutex);
      arrived += static_cast<int>(end - begin);
      arrival.notify_all();
      met = arrival.wait_for(lock, std::chrono::seconds(20), [&] { return arrived == 2; }) && met;
    });
    EXPECT_TRUE(met);
    EXPECT_THROW(vtkNURBSParallelFor(0, 100,
                   [](std::int64_t begin, std::int64_t) {
                     if (begin > 40)
                     {
                       throw nurbs::Error("stop");
                     }
                   }),
      nurbs::Error);
    std::vector<int> visits(1000, 0);
    vtkNURBSParallelFor(0, 1000, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t i = begin; i < end; ++i)
      {
        ++visits[i];
      }
    });
    EXPECT_EQ(std::count(visits.begin(), visits.end(), 1), 1000);
  }
  vtkSMPTools::Initialize(0);
  EXPECT_EQ(vtkSMPTools::GetBackend(), before);
}

TEST(NURBSTessellator, GivesModelsOfACompositeInputWhatTheyGetAlone)
{
  const int shapes[] = { vtkNURBSShapeSource::PLATE, vtkNURBSShapeSource::CYLINDER,
    vtkNURBSShapeSource::TEAPOT };
  vtkNew<vtkPartitionedDataSetCollection> models;
  vtkNew<vtkNURBSTessellator> together;
  together->SetToleranceModeToAbsolute();
  together->SetAbsoluteTolerance(0.01);
  for (unsigned int i = 0; i < 3; ++i)
  {
    models->SetPartition(i, 0, Shape(shapes[i]));
    models->GetMetaData(i)->Set(vtkCompositeDataSet::NAME(), std::to_string(i));
  }
  together->SetInputDataObject(0, models);
  together->Update();
  vtkIdType triangles = 0;
  for (unsigned int i = 0; i < 3; ++i)
  {
    SCOPED_TRACE(i);
    vtkNew<vtkNURBSTessellator> alone;
    alone->SetToleranceModeToAbsolute();
    alone->SetAbsoluteTolerance(0.01);
    alone->SetInputData(models->GetPartition(i, 0));
    alone->Update();
    triangles += alone->GetNumberOfTriangles();
    vtkPolyData* const own[] = { Mesh(alone), Lines(alone) };
    for (int port = 0; port < 2; ++port)
    {
      auto* outputs =
        vtkPartitionedDataSetCollection::SafeDownCast(together->GetOutputDataObject(port));
      ASSERT_TRUE(outputs);
      EXPECT_STREQ(
        outputs->GetMetaData(i)->Get(vtkCompositeDataSet::NAME()), std::to_string(i).c_str());
      ExpectSameMesh(vtkPolyData::SafeDownCast(outputs->GetPartition(i, 0)), own[port]);
    }
  }
  EXPECT_EQ(together->GetNumberOfTriangles(), triangles);
}

TEST(NURBSTessellator, TakesPixelsOfPerspectiveAndParallelViews)
{
  vtkNew<vtkNURBSTessellator> tessellator;
  tessellator->SetInputData(Shape(vtkNURBSShapeSource::SPHERE));
  vtkNew<vtkCamera> camera;
  camera->SetPosition(0, 0, 11);
  camera->SetFocalPoint(0, 0, 0);
  camera->SetClippingRange(1.0, 100.0);
  tessellator->SetToleranceModeToPixels();
  tessellator->SetPixelTolerance(2.0);
  tessellator->SetCamera(camera);
  tessellator->SetViewportSize(500, 1000);
  camera->SetParallelProjection(true);
  camera->SetParallelScale(5.0);
  tessellator->Update();
  EXPECT_NEAR(tessellator->GetToleranceUsed(), 2.0 * 10.0 / 1000.0, 1e-12);
  camera->SetParallelProjection(false); // the camera's change alone makes the filter run again
  tessellator->Update();
  const double slope = std::tan(0.5 * 30.0 * std::acos(-1.0) / 180.0);
  const double corner = slope * std::hypot(0.5, 1.0);
  EXPECT_NEAR(tessellator->GetToleranceUsed(),
    2.0 * (10.0 * 2.0 * slope / 1000.0) / std::hypot(1.0, corner), 1e-9);
  const vtkIdType near = tessellator->GetNumberOfTriangles();
  camera->SetPosition(0, 0, 101);
  tessellator->Update();
  EXPECT_LT(tessellator->GetNumberOfTriangles(), near / 3);
}

TEST(NURBSTessellator, GivesEachFaceThePixelsOfItsDistance)
{
  vtkNew<vtkCamera> camera;
  camera->SetPosition(2500, 0, 800); // Before the car body's front, which is at x = 2200.
  camera->SetFocalPoint(0, 0, 800);
  camera->SetClippingRange(10.0, 10000.0);
  vtkNew<vtkNURBSTessellator> tessellator;
  tessellator->SetInputData(Shape(vtkNURBSShapeSource::CAR_BODY));
  tessellator->SetToleranceModeToPixels();
  tessellator->SetPixelTolerance(5.0);
  tessellator->SetCamera(camera);
  tessellator->Update();
  vtkFieldData* field = Mesh(tessellator)->GetFieldData();
  vtkDataArray* tolerances = field->GetArray("FaceTolerance");
  vtkDataArray* errors = field->GetArray("FaceCertifiedError");
  vtkDataArray* status = field->GetArray("FaceStatus");
  ASSERT_TRUE(tolerances && errors && status);
  double range[2];
  tolerances->GetRange(range);
  EXPECT_EQ(range[1], tessellator->GetToleranceUsed());
  EXPECT_GT(range[1], 10.0 * range[0]);
  for (vtkIdType f = 0; f < tolerances->GetNumberOfTuples(); ++f)
  {
    if (status->GetTuple1(f) < vtkNURBSTessellator::CAPPED)
    {
      EXPECT_LE(errors->GetTuple1(f), tolerances->GetTuple1(f)) << f;
    }
  }
  // Turned round, all faces are behind the camera: none is worth more than before.
  const vtkIdType seen = tessellator->GetNumberOfTriangles();
  camera->SetFocalPoint(5000, 0, 800);
  tessellator->Update();
  EXPECT_LE(tessellator->GetNumberOfTriangles(), 1.1 * seen);
}

TEST(NURBSTessellator, CapsAFaceThatWouldExplode)
{
  vtkNew<vtkNURBSTessellator> tessellator;
  tessellator->SetInputData(Shape(vtkNURBSShapeSource::TORUS));
  tessellator->SetTolerance(1e-4);
  tessellator->SetMaximumFaceTriangles(200);
  vtkNew<vtkCallbackCommand> silent;
  tessellator->AddObserver(vtkCommand::WarningEvent, silent);
  tessellator->Update();
  EXPECT_EQ(tessellator->GetNumberOfCappedFaces(), 1);
  EXPECT_GT(tessellator->GetCertifiedError(), tessellator->GetToleranceUsed());
  EXPECT_GT(tessellator->GetNumberOfTriangles(), 0);
  EXPECT_EQ(FieldValue(Mesh(tessellator), "FaceStatus"), vtkNURBSTessellator::CAPPED);
}

/// Counts events instead of printing them.
struct Messages
{
  vtkNew<vtkCallbackCommand> Command;
  std::string Text;
  explicit Messages(vtkObject* of, unsigned long event)
  {
    this->Command->SetClientData(this);
    this->Command->SetCallback([](vtkObject*, unsigned long, void* self, void* text) {
      static_cast<Messages*>(self)->Text += static_cast<const char*>(text);
    });
    of->AddObserver(event, this->Command);
  }
};

TEST(NURBSTessellator, SaysWhatIsWrong)
{
  vtkNew<vtkNURBSTessellator> tessellator;
  Messages errors(tessellator, vtkCommand::ErrorEvent);
  Messages executive(tessellator->GetExecutive(), vtkCommand::ErrorEvent);
  vtkNew<vtkUnstructuredGrid> grid;
  grid->Allocate(1);
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(0, 0, 0);
  grid->SetPoints(points);
  const vtkIdType id = 0;
  grid->InsertNextCell(VTK_VERTEX, 1, &id);
  tessellator->SetInputData(grid);
  tessellator->Update();
  EXPECT_NE(errors.Text.find("not a NURBS model"), std::string::npos) << errors.Text;
  EXPECT_EQ(tessellator->GetErrorCode(), vtkErrorCode::UserError);
  errors.Text.clear();
  tessellator->SetInputData(Shape(vtkNURBSShapeSource::SPHERE));
  tessellator->SetToleranceModeToAbsolute();
  tessellator->SetAbsoluteTolerance(-1.0);
  tessellator->Update();
  EXPECT_NE(errors.Text.find("must be positive"), std::string::npos) << errors.Text;
  errors.Text.clear();
  tessellator->SetToleranceModeToPixels();
  tessellator->Update();
  EXPECT_NE(errors.Text.find("needs a Camera"), std::string::npos) << errors.Text;
}

TEST(NURBSTessellator, NamesFacesThatFail)
{
  vtkSmartPointer<vtkUnstructuredGrid> grid = Shape(vtkNURBSShapeSource::CYLINDER);
  // The first control point of the first face becomes NaN.
  vtkIdType count = 0;
  const vtkIdType* ids = nullptr;
  grid->GetCells()->GetCellAtId(0, count, ids);
  grid->GetPoints()->SetPoint(ids[0], std::nan(""), 0.0, 0.0);
  vtkNew<vtkNURBSTessellator> tessellator;
  Messages warnings(tessellator, vtkCommand::WarningEvent);
  tessellator->SetInputData(grid);
  tessellator->Update();
  EXPECT_EQ(tessellator->GetNumberOfFailedFaces(), 1);
  EXPECT_NE(warnings.Text.find("face 0 failed"), std::string::npos) << warnings.Text;
  auto* messages = vtkStringArray::SafeDownCast(
    Mesh(tessellator)->GetFieldData()->GetAbstractArray("FaceStatusMessage"));
  ASSERT_TRUE(messages);
  EXPECT_FALSE(messages->GetValue(0).empty());
  EXPECT_EQ(FieldValue(Mesh(tessellator), "FaceStatus"), 3.0);
  // The two lids come out whole.
  vtkNew<vtkMassProperties> mass;
  mass->SetInputData(Mesh(tessellator));
  mass->Update();
  EXPECT_NEAR(mass->GetSurfaceArea(), 2.0 * std::acos(-1.0), 0.1);
}

TEST(NURBSTessellator, ObeysAbort)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShapeToCarBody();
  source->SetNumberOfPatches(500);
  vtkNew<vtkNURBSTessellator> tessellator;
  tessellator->SetInputConnection(source->GetOutputPort());
  vtkNew<vtkCallbackCommand> stop;
  stop->SetCallback([](vtkObject* caller, unsigned long, void*, void*) {
    vtkAlgorithm::SafeDownCast(caller)->SetAbortExecute(1);
  });
  tessellator->AddObserver(vtkCommand::ProgressEvent, stop);
  tessellator->Update();
  EXPECT_EQ(Mesh(tessellator)->GetNumberOfPolys(), 0);
}

} // namespace
