// SPDX-License-Identifier: BSD-3-Clause
// vtkNURBSWaveletLOD in pipelines: closed shapes and CAD solids at every level, arrays, what is
// kept from one update to the next, composite inputs, threads, errors and abort.
#include "../../testMessageKeeper.h"
#include "vtkNURBSCADReader.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"
#include "vtkNURBSParallel.h"
#include "vtkNURBSShapeSource.h"
#include "vtkNURBSWaveletLOD.h"

#include "vtkCallbackCommand.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkErrorCode.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkMassProperties.h"
#include "vtkNew.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSMPTools.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <map>

namespace
{

using Place = std::array<double, 3>;

vtkPolyData* Mesh(vtkNURBSWaveletLOD* filter)
{
  return vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
}

vtkSmartPointer<vtkUnstructuredGrid> Shape(int type)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShape(type);
  source->SetNumberOfPatches(150);
  source->Update();
  return source->GetOutput();
}

// Edges of the triangles by their places, and how many triangles have them.
std::map<std::pair<Place, Place>, int> EdgesOf(vtkPolyData* mesh)
{
  std::map<std::pair<Place, Place>, int> edges;
  vtkNew<vtkIdList> ids;
  for (vtkIdType t = 0; t < mesh->GetNumberOfPolys(); ++t)
  {
    mesh->GetPolys()->GetCellAtId(t, ids);
    for (int k = 0; k < 3; ++k)
    {
      Place a, b;
      mesh->GetPoint(ids->GetId(k), a.data());
      mesh->GetPoint(ids->GetId((k + 1) % 3), b.data());
      ++edges[std::minmax(a, b)];
    }
  }
  return edges;
}

std::size_t OpenEdges(vtkPolyData* mesh)
{
  std::size_t open = 0;
  for (const auto& edge : EdgesOf(mesh))
  {
    open += edge.second == 1;
  }
  return open;
}

TEST(NURBSWaveletLOD, ClosedShapesAreClosedAtEveryLevel)
{
  for (const int type : { vtkNURBSShapeSource::SPHERE, vtkNURBSShapeSource::TORUS,
         vtkNURBSShapeSource::CYLINDER, vtkNURBSShapeSource::CONE })
  {
    vtkNew<vtkNURBSWaveletLOD> filter;
    filter->SetInputData(Shape(type));
    filter->SetFinestTolerance(5e-4);
    for (int wavelet = 0; wavelet < 3; ++wavelet)
    {
      filter->SetWavelet(wavelet);
      vtkIdType before = VTK_ID_MAX;
      double bound = 0.0;
      filter->SetLevel(0);
      filter->Update();
      const int levels = filter->GetNumberOfLevels();
      EXPECT_GE(levels, 4);
      for (int level = 0; level < levels; ++level)
      {
        filter->SetLevel(level);
        filter->Update();
        EXPECT_EQ(OpenEdges(Mesh(filter)), 0u) << type << " " << wavelet << " " << level;
        EXPECT_LT(filter->GetNumberOfTriangles(), before);
        EXPECT_GT(filter->GetErrorBound(), bound);
        before = filter->GetNumberOfTriangles();
        bound = filter->GetErrorBound();
      }
    }
  }
}

// What the levels of a sphere lack of its volume falls to a quarter from level to level; the update
// of the lifted wavelet keeps means, so that it lacks less.
TEST(NURBSWaveletLOD, VolumesConverge)
{
  vtkNew<vtkNURBSWaveletLOD> filter;
  filter->SetInputData(Shape(vtkNURBSShapeSource::SPHERE));
  const double exact = 4.0 / 3.0 * std::acos(-1.0);
  const auto missing = [&](int wavelet, int level) {
    filter->SetWavelet(wavelet);
    filter->SetLevel(level);
    filter->Update();
    vtkNew<vtkMassProperties> mass;
    mass->SetInputData(Mesh(filter));
    return exact - mass->GetVolume();
  };
  for (const int wavelet : { vtkNURBSWaveletLOD::INTERPOLATING, vtkNURBSWaveletLOD::HAAR })
  {
    double before = missing(wavelet, 1);
    EXPECT_GT(before, 0.0);
    for (int level = 2; level < 5; ++level)
    {
      const double now = missing(wavelet, level);
      EXPECT_NEAR(now / before, 4.0, 0.6) << wavelet << " " << level;
      EXPECT_LT(std::abs(missing(vtkNURBSWaveletLOD::LIFTED, level)), 0.7 * now);
      before = now;
    }
  }
}

// CAD solids with trimmed faces, of a STEP file that OpenCASCADE brings along.
TEST(NURBSWaveletLOD, SolidsAreClosedInEveryMode)
{
  const char* const path = "/usr/share/opencascade/data/step/screw.step";
  if (!std::ifstream(path))
  {
    FAIL() << path << " is missing; ./run installs Debian's occt-misc";
  }
  vtkNew<vtkNURBSCADReader> reader;
  reader->SetFileName(path);
  vtkNew<vtkNURBSWaveletLOD> filter;
  filter->SetInputConnection(reader->GetOutputPort());
  filter->Update();
  auto* output = vtkPartitionedDataSetCollection::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_NE(output, nullptr);
  const vtkIdType all = filter->GetNumberOfTriangles();
  const auto open = [&]() {
    filter->Update();
    std::size_t sum = 0;
    for (unsigned int p = 0; p < output->GetNumberOfPartitionedDataSets(); ++p)
    {
      sum += OpenEdges(vtkPolyData::SafeDownCast(output->GetPartition(p, 0)));
    }
    return sum;
  };
  for (int wavelet = 0; wavelet < 3; ++wavelet)
  {
    filter->SetWavelet(wavelet);
    filter->SetModeToLevel();
    filter->Update();
    for (int level = 0; level < filter->GetNumberOfLevels(); ++level)
    {
      filter->SetLevel(level);
      EXPECT_EQ(open(), 0u) << wavelet << " " << level;
      EXPECT_EQ(filter->GetNumberOfFailedFaces() + filter->GetNumberOfRepairedFaces(), 0);
    }
    filter->SetModeToMaximumError();
    filter->SetMaximumError(5e-3);
    EXPECT_EQ(open(), 0u) << wavelet;
    EXPECT_EQ(filter->GetNumberOfCappedFaces(), 0);
    filter->SetModeToTriangleBudget();
    filter->SetTriangleBudget(all / 10);
    EXPECT_EQ(open(), 0u) << wavelet;
    EXPECT_LE(filter->GetNumberOfTriangles(), all / 10);
  }
}

// The bound of every face of a solid against dense samples of its triangles and its surface, at the
// same parameters.
TEST(NURBSWaveletLOD, BoundsOfSolidsHold)
{
  const char* const path = "/usr/share/opencascade/data/step/linkrods.step";
  if (!std::ifstream(path))
  {
    FAIL() << path << " is missing; ./run installs Debian's occt-misc";
  }
  vtkNew<vtkNURBSCADReader> reader;
  reader->SetFileName(path);
  reader->Update();
  auto* input = vtkPartitionedDataSetCollection::SafeDownCast(reader->GetOutputDataObject(0));
  auto* grid = vtkUnstructuredGrid::SafeDownCast(input->GetPartition(0, 0));
  const auto view = vtkNURBSModel::View(grid);
  vtkNew<vtkNURBSWaveletLOD> filter;
  filter->SetInputData(grid);
  filter->SetFinestTolerance(1e-3);
  for (int wavelet = 0; wavelet < 3; ++wavelet)
  {
    filter->SetWavelet(wavelet);
    for (int mode = 0; mode < 3; ++mode)
    {
      filter->SetMode(mode);
      filter->SetLevel(2);
      filter->SetMaximumError(1e-2);
      filter->SetTriangleBudget(6000);
      filter->Update();
      vtkPolyData* mesh = Mesh(filter);
      vtkDataArray* bounds = mesh->GetFieldData()->GetArray("FaceErrorBound");
      vtkDataArray* ids = mesh->GetFieldData()->GetArray("FaceIds");
      std::map<vtkIdType, vtkIdType> cells;
      for (vtkIdType f = 0; f < ids->GetNumberOfTuples(); ++f)
      {
        cells[vtkIdType(ids->GetComponent(f, 0))] = f;
      }
      std::vector<double> measured(cells.size(), 0.0);
      vtkDataArray* faces = mesh->GetCellData()->GetArray(vtkNURBSModel::FaceIdName());
      vtkDataArray* uv = mesh->GetPointData()->GetArray("UV");
      vtkNew<vtkIdList> corners;
      for (vtkIdType t = 0; t < mesh->GetNumberOfPolys(); ++t)
      {
        mesh->GetPolys()->GetCellAtId(t, corners);
        const vtkIdType face = cells[vtkIdType(faces->GetComponent(t, 0))];
        const nurbs::SurfaceView& surface = view->GetModel().Faces[face].Geometry;
        for (int i = 0; i <= 4; ++i)
        {
          for (int j = 0; i + j <= 4; ++j)
          {
            const double share[3] = { 0.25 * i, 0.25 * j, 0.25 * (4 - i - j) };
            nurbs::Vec3 x = nurbs::Vec3::Zero();
            nurbs::Vec2 p = nurbs::Vec2::Zero();
            for (int k = 0; k < 3; ++k)
            {
              const vtkIdType id = corners->GetId(k);
              nurbs::Vec3 corner;
              mesh->GetPoint(id, corner.data());
              x += share[k] * corner;
              p += share[k] * nurbs::Vec2(uv->GetComponent(id, 0), uv->GetComponent(id, 1));
            }
            const double distance = (x - nurbs::Evaluate(surface, p[0], p[1])).norm();
            measured[face] = std::max(measured[face], distance);
          }
        }
      }
      for (std::size_t f = 0; f < measured.size(); ++f)
      {
        EXPECT_LE(measured[f], bounds->GetComponent(vtkIdType(f), 0) * (1.0 + 1e-9) + 1e-9)
          << "face " << f << " wavelet " << wavelet << " mode " << mode;
      }
    }
  }
}

// Where a model is open its edges are used once. A crack would have two borders.
TEST(NURBSWaveletLOD, ACarBodyIsOpenAtItsHolesOnly)
{
  vtkNew<vtkNURBSWaveletLOD> filter;
  auto grid = Shape(vtkNURBSShapeSource::CAR_BODY);
  filter->SetInputData(grid);
  // The finest level's open edges tell how many borders there are: closed rings of them.
  std::size_t rings = 0;
  for (int wavelet = 0; wavelet < 3; ++wavelet)
  {
    filter->SetWavelet(wavelet);
    filter->SetLevel(0);
    filter->Update();
    for (int level = 0; level < filter->GetNumberOfLevels(); ++level)
    {
      filter->SetLevel(level);
      filter->Update();
      std::map<Place, std::vector<Place>> next;
      for (const auto& edge : EdgesOf(Mesh(filter)))
      {
        if (edge.second == 1)
        {
          next[edge.first.first].push_back(edge.first.second);
          next[edge.first.second].push_back(edge.first.first);
        }
      }
      std::size_t found = 0;
      std::map<Place, bool> seen;
      for (const auto& start : next)
      {
        EXPECT_EQ(start.second.size(), 2u); // A crack's ends would meet others.
        if (seen[start.first])
        {
          continue;
        }
        ++found;
        std::vector<Place> stack(1, start.first);
        while (!stack.empty())
        {
          const Place p = stack.back();
          stack.pop_back();
          if (!seen[p] || p == start.first)
          {
            seen[p] = true;
            for (const Place& q : next[p])
            {
              if (!seen[q])
              {
                stack.push_back(q);
              }
            }
          }
        }
      }
      rings = rings == 0 ? found : rings;
      EXPECT_EQ(found, rings) << wavelet << " " << level;
    }
  }
  EXPECT_GT(rings, 10u);
}

TEST(NURBSWaveletLOD, OutputHasTheArraysThatItTellsOf)
{
  vtkNew<vtkNURBSWaveletLOD> filter;
  filter->SetInputData(Shape(vtkNURBSShapeSource::CYLINDER));
  filter->SetLevel(2);
  filter->Update();
  vtkPolyData* mesh = Mesh(filter);
  EXPECT_EQ(mesh->GetPointData()->GetNormals()->GetNumberOfTuples(), mesh->GetNumberOfPoints());
  EXPECT_EQ(mesh->GetPointData()->GetArray("UV")->GetNumberOfComponents(), 2);
  for (const char* name : { vtkNURBSModel::FaceIdName(), vtkNURBSModel::ColorName() })
  {
    ASSERT_NE(mesh->GetCellData()->GetAbstractArray(name), nullptr) << name;
    EXPECT_EQ(
      mesh->GetCellData()->GetAbstractArray(name)->GetNumberOfTuples(), mesh->GetNumberOfPolys());
  }
  vtkFieldData* field = mesh->GetFieldData();
  for (const char* name : { "FaceIds", "FaceErrorBound", "FaceLevel", "FaceNumberOfLevels",
         "FaceLevelErrorBounds", "FaceStatus", "FaceStatusMessage" })
  {
    ASSERT_NE(field->GetAbstractArray(name), nullptr) << name;
    EXPECT_EQ(field->GetAbstractArray(name)->GetNumberOfTuples(), 3) << name;
  }
  vtkDataArray* bounds = field->GetArray("FaceLevelErrorBounds");
  EXPECT_EQ(bounds->GetNumberOfComponents(), filter->GetNumberOfLevels());
  for (int level = 1; level < filter->GetNumberOfLevels(); ++level)
  {
    EXPECT_GE(bounds->GetComponent(0, level), bounds->GetComponent(0, level - 1));
  }
  EXPECT_EQ(field->GetArray("FaceLevel")->GetComponent(0, 0), 2.0);
  EXPECT_EQ(field->GetArray("FaceLevel")->GetComponent(1, 0), 0.0); // A plane has no levels.
  EXPECT_EQ(field->GetArray("ErrorBound")->GetComponent(0, 0), filter->GetErrorBound());
  EXPECT_EQ(
    field->GetArray("NumberOfTriangles")->GetComponent(0, 0), filter->GetNumberOfTriangles());
  EXPECT_EQ(field->GetArray("Knots"), nullptr);
  // Normals point outwards, the triangles' and the array's.
  vtkNew<vtkIdList> ids;
  for (vtkIdType t = 0; t < mesh->GetNumberOfPolys(); ++t)
  {
    mesh->GetPolys()->GetCellAtId(t, ids);
    double x[3][3], normal[3], cross = 0.0;
    mesh->GetPointData()->GetNormals()->GetTuple(ids->GetId(0), normal);
    for (int k = 0; k < 3; ++k)
    {
      mesh->GetPoint(ids->GetId(k), x[k]);
    }
    for (int c = 0; c < 3; ++c)
    {
      const int d = (c + 1) % 3;
      const int e = (c + 2) % 3;
      cross += normal[c] *
        ((x[1][d] - x[0][d]) * (x[2][e] - x[0][e]) - (x[1][e] - x[0][e]) * (x[2][d] - x[0][d]));
    }
    EXPECT_GT(cross, 0.0);
  }
}

TEST(NURBSWaveletLOD, PyramidsAreKeptUntilTheyNoLongerFit)
{
  auto grid = Shape(vtkNURBSShapeSource::TORUS);
  vtkNew<vtkNURBSWaveletLOD> filter;
  filter->SetInputData(grid);
  filter->Update();
  EXPECT_GT(filter->GetAnalyseSeconds(), 0.0);
  filter->SetLevel(3);
  filter->Update();
  EXPECT_EQ(filter->GetAnalyseSeconds(), 0.0);
  filter->SetModeToTriangleBudget();
  filter->Update();
  EXPECT_EQ(filter->GetAnalyseSeconds(), 0.0);
  filter->SetFinestTolerance(1e-3);
  filter->Update();
  EXPECT_GT(filter->GetAnalyseSeconds(), 0.0);
  filter->SetWaveletToHaar();
  filter->Update();
  EXPECT_GT(filter->GetAnalyseSeconds(), 0.0);
  // Moved points are seen.
  double before[6], after[6];
  Mesh(filter)->GetBounds(before);
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
  {
    double x[3];
    grid->GetPoint(i, x);
    grid->GetPoints()->SetPoint(i, 2.0 * x[0], x[1], x[2]);
  }
  grid->GetPoints()->Modified();
  filter->Update();
  EXPECT_GT(filter->GetAnalyseSeconds(), 0.0);
  Mesh(filter)->GetBounds(after);
  EXPECT_NEAR(after[1], 2.0 * before[1], 1e-2);
  EXPECT_EQ(OpenEdges(Mesh(filter)), 0u);
}

TEST(NURBSWaveletLOD, TolerancesAreRelativeOrAbsolute)
{
  vtkNew<vtkNURBSWaveletLOD> filter;
  filter->SetInputData(Shape(vtkNURBSShapeSource::SPHERE)); // Diagonal: 2 sqrt(3).
  filter->SetModeToMaximumError();
  filter->SetMaximumError(0.01);
  filter->Update();
  EXPECT_LE(filter->GetErrorBound(), 0.01 * 2.0 * std::sqrt(3.0));
  EXPECT_GT(filter->GetErrorBound(), 0.001 * 2.0 * std::sqrt(3.0));
  const vtkIdType relative = filter->GetNumberOfTriangles();
  filter->SetToleranceModeToAbsolute();
  filter->SetFinestTolerance(1e-4 * 2.0 * std::sqrt(3.0));
  filter->SetMaximumError(0.01 * 2.0 * std::sqrt(3.0));
  filter->Update();
  EXPECT_NEAR(double(filter->GetNumberOfTriangles()), double(relative), 0.01 * double(relative));
}

TEST(NURBSWaveletLOD, ThreadsDoNotMatter)
{
  const auto make = [](int threads) {
    const vtkNURBSParallelScope parallel;
    vtkSMPTools::Initialize(threads);
    vtkNew<vtkNURBSWaveletLOD> filter;
    filter->SetInputData(Shape(vtkNURBSShapeSource::CAR_BODY));
    filter->SetModeToTriangleBudget();
    filter->SetTriangleBudget(8000);
    filter->Update();
    vtkSmartPointer<vtkPolyData> mesh = Mesh(filter);
    return mesh;
  };
  const auto one = make(1);
  const auto four = make(4);
  vtkSMPTools::Initialize(0);
  ASSERT_GT(one->GetNumberOfPolys(), 4000);
  ASSERT_EQ(one->GetNumberOfPoints(), four->GetNumberOfPoints());
  ASSERT_EQ(one->GetNumberOfPolys(), four->GetNumberOfPolys());
  for (vtkIdType i = 0; i < one->GetNumberOfPoints(); ++i)
  {
    Place a, b;
    one->GetPoint(i, a.data());
    four->GetPoint(i, b.data());
    ASSERT_EQ(a, b);
  }
}

TEST(NURBSWaveletLOD, BudgetsThatCantBeKeptAreToldOf)
{
  vtkNew<vtkNURBSWaveletLOD> filter;
  filter->SetInputData(Shape(vtkNURBSShapeSource::TORUS));
  filter->SetModeToTriangleBudget();
  filter->SetTriangleBudget(3);
  auto warning = vtkSmartPointer<MessageKeeper>::Take(MessageKeeper::New());
  filter->AddObserver(vtkCommand::WarningEvent, warning);
  filter->Update();
  EXPECT_TRUE(warning->Says("more than 3 triangles")) << warning->Text;
  EXPECT_EQ(filter->GetNumberOfTriangles(), 32);
}

TEST(NURBSWaveletLOD, SaysWhatIsWrong)
{
  vtkNew<vtkNURBSWaveletLOD> filter;
  auto error = vtkSmartPointer<MessageKeeper>::Take(MessageKeeper::New());
  filter->AddObserver(vtkCommand::ErrorEvent, error);
  vtkNew<vtkNURBSShapeSource> source;
  filter->SetInputConnection(source->GetOutputPort());
  filter->SetFinestTolerance(0.0);
  filter->Update();
  EXPECT_TRUE(error->Says("FinestTolerance must be positive")) << error->Text;
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::UserError);
  filter->SetFinestTolerance(1e-3);
  filter->SetModeToMaximumError();
  filter->SetMaximumError(-1.0);
  filter->Update();
  EXPECT_TRUE(error->Says("MaximumError must be positive")) << error->Text;
  EXPECT_EQ(Mesh(filter)->GetNumberOfPolys(), 0);
  filter->SetMaximumError(1e-2);
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  EXPECT_GT(Mesh(filter)->GetNumberOfPolys(), 0);

  vtkNew<vtkUnstructuredGrid> none;
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(0.0, 0.0, 0.0);
  none->SetPoints(points);
  const vtkIdType id = 0;
  none->InsertNextCell(VTK_VERTEX, 1, &id);
  filter->SetInputData(none);
  filter->Update();
  EXPECT_TRUE(error->Says("is not a NURBS model")) << error->Text;

  vtkNew<vtkUnstructuredGrid> empty;
  error->Text.clear();
  filter->SetInputData(empty);
  filter->Update();
  EXPECT_EQ(error->Text, "");
  EXPECT_EQ(filter->GetNumberOfTriangles(), 0);
}

TEST(NURBSWaveletLOD, ObeysAbort)
{
  vtkNew<vtkNURBSWaveletLOD> filter;
  filter->SetInputData(Shape(vtkNURBSShapeSource::CAR_BODY));
  vtkNew<vtkCallbackCommand> stop;
  stop->SetCallback([](vtkObject* caller, unsigned long, void*, void*) {
    vtkAlgorithm::SafeDownCast(caller)->SetAbortExecute(1);
  });
  const unsigned long tag = filter->AddObserver(vtkCommand::ProgressEvent, stop);
  filter->Update();
  EXPECT_EQ(Mesh(filter)->GetNumberOfPolys(), 0);
  filter->RemoveObserver(tag);
  filter->SetAbortExecute(0);
  filter->Modified();
  filter->Update();
  EXPECT_GT(Mesh(filter)->GetNumberOfPolys(), 0);
}

} // namespace
