// SPDX-License-Identifier: BSD-3-Clause
// vtkNURBSSilhouette in pipelines: arrays, kinds of lines, chains, where it is seen from, composite
// inputs, CAD files, threads, errors, progress and abort.
#include "../../testMessageKeeper.h"
#include "ModelExtent.h"
#include "nurbsSilhouetteReference.h"
#include "vtkNURBSCADReader.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"
#include "vtkNURBSShapeSource.h"
#include "vtkNURBSSilhouette.h"

#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkErrorCode.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSMPTools.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <set>

namespace
{

vtkPolyData* Lines(vtkNURBSSilhouette* filter)
{
  return vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
}

vtkSmartPointer<vtkUnstructuredGrid> Shape(int type)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShape(type);
  source->SetNumberOfPatches(500);
  source->Update();
  return source->GetOutput();
}

int CountOf(vtkPolyData* lines, int kind)
{
  int count = 0;
  for (vtkIdType c = 0; c < lines->GetNumberOfCells(); ++c)
  {
    count += lines->GetCellData()->GetArray("Kind")->GetComponent(c, 0) == kind;
  }
  return count;
}

TEST(NURBSSilhouette, OutputHasTheArraysThatItTellsOf)
{
  vtkNew<vtkNURBSSilhouette> filter;
  auto grid = Shape(vtkNURBSShapeSource::CYLINDER);
  filter->SetInputData(grid);
  filter->SetDirection(3, 1, 1);
  filter->SmoothEdgesOn();
  filter->Update();
  vtkPolyData* lines = Lines(filter);
  EXPECT_EQ(CountOf(lines, vtkNURBSSilhouette::SILHOUETTE), 2);
  EXPECT_EQ(CountOf(lines, vtkNURBSSilhouette::SHARP), 2);
  EXPECT_EQ(CountOf(lines, vtkNURBSSilhouette::SMOOTH), 1);
  EXPECT_EQ(lines->GetNumberOfLines(), 5);
  EXPECT_EQ(filter->GetNumberOfLines(), 5);
  EXPECT_EQ(filter->GetNumberOfPoints(), lines->GetNumberOfPoints());
  EXPECT_EQ(filter->GetNumberOfComponents(), 2);
  EXPECT_EQ(filter->GetNumberOfFaces(), 3);
  EXPECT_EQ(filter->GetNumberOfInexactPoints(), 0);
  EXPECT_GT(filter->GetSeconds(), 0.0);
  // The caps are a patch each, the side has four.
  EXPECT_EQ(filter->GetNumberOfVisiblePatches() + filter->GetNumberOfInvisiblePatches() +
      filter->GetNumberOfPartialPatches() + filter->GetNumberOfEdgeOnPatches(),
    6);
  EXPECT_EQ(filter->GetNumberOfPartialPatches(), 2);
  for (const char* name : { "UV", "NormalDotView" })
  {
    ASSERT_NE(lines->GetPointData()->GetArray(name), nullptr) << name;
    EXPECT_EQ(
      lines->GetPointData()->GetArray(name)->GetNumberOfTuples(), lines->GetNumberOfPoints());
  }
  for (const char* name : { vtkNURBSModel::FaceIdName(), vtkNURBSModel::EdgeIdName(),
         vtkNURBSModel::ColorName(), "Kind", "OnCrease", "Chain" })
  {
    ASSERT_NE(lines->GetCellData()->GetAbstractArray(name), nullptr) << name;
    EXPECT_EQ(
      lines->GetCellData()->GetAbstractArray(name)->GetNumberOfTuples(), lines->GetNumberOfCells());
  }
  vtkFieldData* field = lines->GetFieldData();
  for (const char* name : { "FaceIds", "FacePatches", "FaceStatus", "FaceStatusMessage" })
  {
    ASSERT_NE(field->GetAbstractArray(name), nullptr) << name;
    EXPECT_EQ(field->GetAbstractArray(name)->GetNumberOfTuples(), 3) << name;
  }
  EXPECT_EQ(field->GetArray("Knots"), nullptr);
  // Edges name the model's edges, silhouettes across a face name none.
  vtkDataArray* edges = lines->GetCellData()->GetArray(vtkNURBSModel::EdgeIdName());
  std::set<int> named;
  for (vtkIdType c = 0; c < lines->GetNumberOfCells(); ++c)
  {
    const bool silhouette = lines->GetCellData()->GetArray("Kind")->GetComponent(c, 0) == 0;
    EXPECT_EQ(edges->GetComponent(c, 0) < 0, silhouette);
    named.insert(int(edges->GetComponent(c, 0)));
  }
  EXPECT_EQ(named.size(), 4u); // -1 and three edges.
}

// Points are where UV says, on the face of the first line that has them.
TEST(NURBSSilhouette, PointsLieOnTheSurfaces)
{
  vtkNew<vtkNURBSSilhouette> filter;
  auto grid = Shape(vtkNURBSShapeSource::TEAPOT);
  filter->SetInputData(grid);
  filter->SetProjectionToPerspective();
  filter->SetEyePoint(9, -6, 5);
  filter->Update();
  vtkPolyData* lines = Lines(filter);
  const auto view = vtkNURBSModel::View(grid);
  std::vector<char> seen(lines->GetNumberOfPoints(), 0);
  vtkNew<vtkIdList> ids;
  for (vtkIdType c = 0; c < lines->GetNumberOfCells(); ++c)
  {
    lines->GetCellPoints(c, ids);
    const auto f =
      std::size_t(lines->GetCellData()->GetArray(vtkNURBSModel::FaceIdName())->GetComponent(c, 0));
    const nurbs::SurfaceView& surface = view->GetModel().Faces[f].Geometry;
    const bool silhouette = lines->GetCellData()->GetArray("Kind")->GetComponent(c, 0) == 0;
    for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k)
    {
      const vtkIdType id = ids->GetId(k);
      if (seen[id])
      {
        continue;
      }
      seen[id] = 1;
      double x[3], uv[2];
      lines->GetPoint(id, x);
      lines->GetPointData()->GetArray("UV")->GetTuple(id, uv);
      const nurbs::Vec3 point = nurbs::Evaluate(surface, uv[0], uv[1]);
      EXPECT_LT((point - nurbs::Vec3(x[0], x[1], x[2])).norm(), 1e-13);
      if (silhouette)
      {
        EXPECT_LE(
          std::abs(reference::Cosine(surface, reference::Eye(9, -6, 5), nurbs::Vec2(uv[0], uv[1]))),
          1e-9);
      }
    }
  }
  EXPECT_GT(filter->GetNumberOfPoints(), 500);
}

// A closed chain of lines visits each of its points twice.
TEST(NURBSSilhouette, ChainsShareTheirPoints)
{
  vtkNew<vtkNURBSSilhouette> filter;
  filter->SetInputData(Shape(vtkNURBSShapeSource::TORUS));
  filter->SetDirection(1, 2, 3);
  filter->Update();
  vtkPolyData* lines = Lines(filter);
  std::vector<int> uses(lines->GetNumberOfPoints(), 0);
  std::set<double> chains;
  vtkNew<vtkIdList> ids;
  for (vtkIdType c = 0; c < lines->GetNumberOfCells(); ++c)
  {
    lines->GetCellPoints(c, ids);
    ++uses[ids->GetId(0)];
    ++uses[ids->GetId(ids->GetNumberOfIds() - 1)];
    chains.insert(lines->GetCellData()->GetArray("Chain")->GetComponent(c, 0));
  }
  for (const int count : uses)
  {
    EXPECT_TRUE(count == 0 || count == 2) << count;
  }
  EXPECT_EQ(chains.size(), 2u);
  EXPECT_EQ(filter->GetNumberOfComponents(), 2);
}

TEST(NURBSSilhouette, CamerasAreFollowed)
{
  vtkNew<vtkCamera> camera;
  camera->SetPosition(0, 0, 5);
  camera->SetFocalPoint(0, 0, 0);
  vtkNew<vtkNURBSSilhouette> filter;
  filter->SetInputData(Shape(vtkNURBSShapeSource::SPHERE));
  filter->SetCamera(camera);
  filter->Update();
  double bounds[6];
  Lines(filter)->GetBounds(bounds);
  EXPECT_NEAR(bounds[4], 0.2, 1e-9); // The circle z = 1 / 5.
  EXPECT_NEAR(bounds[5], 0.2, 1e-9);
  camera->SetPosition(0, 0, -2);
  filter->Update();
  Lines(filter)->GetBounds(bounds);
  EXPECT_NEAR(bounds[4], -0.5, 1e-9);
  camera->ParallelProjectionOn();
  filter->Update();
  Lines(filter)->GetBounds(bounds);
  EXPECT_NEAR(bounds[4], 0.0, 1e-9);
  EXPECT_NEAR(bounds[5], 0.0, 1e-9);
  filter->SetCamera(nullptr);
  filter->SetDirection(-7, 0, 0);
  filter->Update();
  Lines(filter)->GetBounds(bounds);
  EXPECT_NEAR(bounds[1] - bounds[0], 0.0, 1e-9);
  EXPECT_NEAR(bounds[5], 1.0, 1e-9);
}

TEST(NURBSSilhouette, KindsAreMadeAsAsked)
{
  vtkNew<vtkNURBSSilhouette> filter;
  filter->SetInputData(Shape(vtkNURBSShapeSource::CONE));
  filter->SetDirection(1, 0, 0);
  for (int k = 0; k < 16; ++k)
  {
    filter->SetSilhouettes(k & 1);
    filter->SetBoundaryEdges(k & 2);
    filter->SetSharpEdges(k & 4);
    filter->SetSmoothEdges(k & 8);
    filter->Update();
    EXPECT_EQ(CountOf(Lines(filter), 0), k & 1 ? 2 : 0);
    EXPECT_EQ(CountOf(Lines(filter), 1), 0);
    EXPECT_EQ(CountOf(Lines(filter), 2), k & 4 ? 1 : 0);
    EXPECT_EQ(CountOf(Lines(filter), 3), k & 8 ? 1 : 0);
  }
  // The base meets the side at 116.6 degrees between the normals.
  filter->SetFeatureAngle(116.0);
  filter->Update();
  EXPECT_EQ(CountOf(Lines(filter), vtkNURBSSilhouette::SHARP), 1);
  filter->SetFeatureAngle(117.0);
  filter->Update();
  EXPECT_EQ(CountOf(Lines(filter), vtkNURBSSilhouette::SHARP), 0);
}

TEST(NURBSSilhouette, PrecisionIsRelativeOrAbsolute)
{
  vtkNew<vtkNURBSSilhouette> filter;
  filter->SetInputData(Shape(vtkNURBSShapeSource::SPHERE)); // Diagonal: 2 sqrt(3).
  filter->SetDirection(1, 2, 3);
  filter->SetPrecision(1e-5);
  filter->Update();
  const vtkIdType relative = filter->GetNumberOfPoints();
  filter->SetPrecisionModeToAbsolute();
  filter->SetPrecision(1e-5 * 2.0 * std::sqrt(3.0));
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfPoints(), relative);
  filter->SetPrecision(1e-5);
  filter->Update();
  EXPECT_GT(filter->GetNumberOfPoints(), relative);
}

// Models of a collection do not chain with each other, and edges are numbered in each of them.
TEST(NURBSSilhouette, CompositesKeepTheirStructure)
{
  vtkNew<vtkPartitionedDataSetCollection> input;
  auto cylinder = Shape(vtkNURBSShapeSource::CYLINDER);
  input->SetPartition(0, 0, cylinder);
  vtkNew<vtkUnstructuredGrid> empty;
  input->SetPartition(1, 0, empty);
  vtkNew<vtkUnstructuredGrid> copy;
  copy->DeepCopy(cylinder);
  input->SetPartition(2, 0, copy);
  vtkNew<vtkNURBSSilhouette> filter;
  filter->SetInputData(input);
  filter->SetDirection(1, 1, 1);
  filter->Update();
  auto* output = vtkPartitionedDataSetCollection::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_NE(output, nullptr);
  ASSERT_EQ(output->GetNumberOfPartitionedDataSets(), 3u);
  auto* first = vtkPolyData::SafeDownCast(output->GetPartition(0, 0));
  auto* last = vtkPolyData::SafeDownCast(output->GetPartition(2, 0));
  ASSERT_NE(first, nullptr);
  ASSERT_NE(last, nullptr);
  EXPECT_EQ(first->GetNumberOfLines(), 4);
  EXPECT_EQ(last->GetNumberOfLines(), 4);
  EXPECT_EQ(filter->GetNumberOfComponents(), 4);
  EXPECT_EQ(filter->GetNumberOfLines(), 8);
  for (vtkIdType c = 0; c < 4; ++c)
  {
    for (const char* name : { "Kind", "EdgeId", "FaceId" })
    {
      EXPECT_EQ(first->GetCellData()->GetArray(name)->GetComponent(c, 0),
        last->GetCellData()->GetArray(name)->GetComponent(c, 0));
    }
  }
}

TEST(NURBSSilhouette, ThreadsChangeNothing)
{
  auto grid = Shape(vtkNURBSShapeSource::CAR_BODY);
  vtkSmartPointer<vtkPolyData> results[2];
  for (int k = 0; k < 2; ++k)
  {
    vtkSMPTools::Initialize(k == 0 ? 1 : 4);
    vtkNew<vtkNURBSSilhouette> filter;
    filter->SetInputData(grid);
    filter->SetDirection(1, 2, 0.5);
    filter->Update();
    results[k] = Lines(filter);
  }
  vtkSMPTools::Initialize(0);
  ASSERT_EQ(results[0]->GetNumberOfPoints(), results[1]->GetNumberOfPoints());
  ASSERT_EQ(results[0]->GetNumberOfLines(), results[1]->GetNumberOfLines());
  EXPECT_GT(results[0]->GetNumberOfLines(), 100);
  for (vtkIdType i = 0; i < results[0]->GetNumberOfPoints(); ++i)
  {
    double a[3], b[3];
    results[0]->GetPoint(i, a);
    results[1]->GetPoint(i, b);
    ASSERT_TRUE(a[0] == b[0] && a[1] == b[1] && a[2] == b[2]);
  }
}

// CAD solids in three directions: nothing is missed, everything is exact, silhouettes do not end
// within faces.
TEST(NURBSSilhouette, CADFiles)
{
  const std::string folder = "/usr/share/opencascade/data/";
  int tested = 0;
  for (const char* name : { "occ/CrankArm.brep", "occ/Ball.brep", "occ/hammer.brep",
         "occ/Pump_TopCover.brep", "iges/bearing.iges", "step/linkrods.step" })
  {
    const std::string file = folder + name;
    if (!std::ifstream(file))
    {
      continue; // The package occt-misc is not installed.
    }
    vtkNew<vtkNURBSCADReader> reader;
    reader->SetFileName(file.c_str());
    reader->Update();
    vtkPartitionedDataSetCollection* collection = reader->GetOutput();
    for (unsigned int p = 0; p < collection->GetNumberOfPartitionedDataSets(); ++p)
    {
      auto* grid = vtkUnstructuredGrid::SafeDownCast(collection->GetPartitionAsDataObject(p, 0));
      if (!grid || grid->GetNumberOfCells() == 0)
      {
        continue;
      }
      const auto view = vtkNURBSModel::View(grid);
      const nurbs::Model& model = view->GetModel();
      const std::vector<std::string> errors(model.Faces.size());
      for (const nurbs::Vec3& direction :
        { nurbs::Vec3(1, 1, 1), nurbs::Vec3(0.3, -0.9, 0.2), nurbs::Vec3(0, 0, 1) })
      {
        nurbs::SilhouetteOptions options;
        options.View = reference::Direction(direction[0], direction[1], direction[2]);
        options.Precision = 1e-4 * nurbs::Diagonal(nurbs::FaceBoxes(model, errors));
        const nurbs::Silhouettes result = nurbs::MakeSilhouettes(model, errors, options);
        const reference::Measure measure = reference::MeasureLines(model, result, options.View);
        EXPECT_LE(measure.Chord, options.Precision) << file;
        EXPECT_EQ(result.InexactPoints, 0) << file;
        // Along the axes of parts, noise decides which of the faces that are edge-on turn away.
        if (direction[2] < 1.0 || direction[0] > 0.0)
        {
          EXPECT_EQ(reference::LooseEnds(result, 20.0 * options.Precision), 0) << file;
        }
        for (std::size_t f = 0; f < model.Faces.size(); ++f)
        {
          const nurbs::FaceTrim trim(model, std::int64_t(f));
          const reference::GridCheck grid =
            reference::CheckGrid(model, std::int64_t(f), result, options.View, options.Precision,
              60, [&](const nurbs::Vec2& uv) { return trim.Inside(uv[0], uv[1]); });
          EXPECT_EQ(grid.Missed, 0) << file << " face " << f;
        }
        ++tested;
      }
    }
  }
  EXPECT_GT(tested, 0) << "no file in " << folder << "; ./run installs Debian's occt-misc";
}

TEST(NURBSSilhouette, BadInputIsTold)
{
  vtkNew<vtkNURBSSilhouette> filter;
  vtkNew<MessageKeeper> errors;
  filter->AddObserver(vtkCommand::ErrorEvent, errors);
  filter->SetInputData(Shape(vtkNURBSShapeSource::SPHERE));
  const auto says = [&](const char* part) {
    errors->Text.clear();
    filter->Modified();
    filter->Update();
    return filter->GetErrorCode() == vtkErrorCode::UserError && errors->Says(part) &&
      Lines(filter)->GetNumberOfPoints() == 0;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  filter->SetDirection(0, 0, 0);
  EXPECT_TRUE(says("direction to the viewer has length zero"));
  filter->SetDirection(0, nan, 0);
  EXPECT_TRUE(says("direction to the viewer is not finite"));
  filter->SetProjectionToPerspective();
  filter->SetEyePoint(0, nan, 0);
  EXPECT_TRUE(says("eye is not finite"));
  filter->SetEyePoint(0, 0, 3);
  filter->SetPrecision(0.0);
  EXPECT_TRUE(says("Precision must be positive"));
  filter->SetPrecision(1e-4);
  filter->SetFeatureAngle(0.0);
  EXPECT_TRUE(says("FeatureAngle must be in"));
  filter->SetFeatureAngle(30.0);
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  EXPECT_EQ(filter->GetNumberOfComponents(), 1);
  vtkNew<vtkUnstructuredGrid> other;
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(0, 0, 0);
  other->SetPoints(points);
  const vtkIdType id = 0;
  other->InsertNextCell(VTK_VERTEX, 1, &id);
  filter->SetInputData(other);
  EXPECT_TRUE(says("is not a NURBS model"));
  vtkNew<vtkUnstructuredGrid> empty;
  filter->SetInputData(empty);
  errors->Text.clear();
  filter->Update();
  EXPECT_EQ(errors->Text, "");
  EXPECT_EQ(filter->GetNumberOfLines(), 0);
}

// A face that is wrong is named, and the others come out.
TEST(NURBSSilhouette, FailedFacesAreNamed)
{
  auto grid = Shape(vtkNURBSShapeSource::TEAPOT);
  vtkNew<vtkNURBSSilhouette> filter;
  filter->SetInputData(grid);
  filter->SetDirection(1, 2, 3);
  filter->Update();
  const vtkIdType before = filter->GetNumberOfLines();
  EXPECT_EQ(filter->GetNumberOfFailedFaces(), 0);
  vtkNew<vtkIdList> ids;
  grid->GetCellPoints(5, ids);
  grid->GetPoints()->SetPoint(ids->GetId(5), std::nan(""), 0, 0);
  grid->GetPoints()->Modified();
  vtkNew<MessageKeeper> warnings;
  filter->AddObserver(vtkCommand::WarningEvent, warnings);
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfFailedFaces(), 1);
  EXPECT_TRUE(warnings->Says("face 5 failed"));
  EXPECT_GT(filter->GetNumberOfLines(), before / 2);
  vtkDataArray* faces = Lines(filter)->GetCellData()->GetArray(vtkNURBSModel::FaceIdName());
  for (vtkIdType c = 0; c < faces->GetNumberOfTuples(); ++c)
  {
    EXPECT_NE(faces->GetComponent(c, 0), 5.0);
  }
}

TEST(NURBSSilhouette, ProgressIsReportedAndAbortObeyed)
{
  vtkNew<vtkNURBSSilhouette> filter;
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
  EXPECT_EQ(reports.back(), 1.0);
  EXPECT_TRUE(std::is_sorted(reports.begin(), reports.end()));
  EXPECT_GT(filter->GetNumberOfLines(), 0);
  vtkNew<vtkCallbackCommand> aborter;
  aborter->SetCallback([](vtkObject* caller, unsigned long, void*, void*) {
    vtkAlgorithm::SafeDownCast(caller)->SetAbortExecute(1);
  });
  const unsigned long tag = filter->AddObserver(vtkCommand::ProgressEvent, aborter);
  filter->SetPrecision(1e-5);
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfLines(), 0);
  EXPECT_EQ(Lines(filter)->GetNumberOfPoints(), 0);
  filter->RemoveObserver(tag);
  filter->SetAbortExecute(0);
  filter->Modified();
  filter->Update();
  EXPECT_GT(filter->GetNumberOfLines(), 0);
}

} // namespace
