// SPDX-License-Identifier: BSD-3-Clause
// Milliseconds a frame of vtkNURBSDeformingTessellator takes, by phase, and what follows downstream.
//   DeformingFrames sheet [--points 250] [--depth 2] [--tolerance 0] ...   a control point is dragged
//   DeformingFrames wave FILE [--tolerance 1e-3] ...        all control points of a CAD file are moved
// A wave through CAD files moves control points, which their faces follow as closely as their nets
// are dense: faces part at edges, which the mesh closes and the column "gap" tells of.
#include "Measuring.h"
#include "ModelExtent.h"
#include "vtkNURBSCADReader.h"
#include "vtkNURBSDeformingTessellator.h"
#include "vtkNURBSEGLRenderWindow.h"
#include "vtkNURBSMeshMapper.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"
#include "vtkNURBSShapeSource.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkCompositePolyDataMapper2.h"
#include "vtkNew.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkRenderer.h"
#include "vtkSMPTools.h"
#include "vtkUnstructuredGrid.h"

#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>

namespace
{

struct Settings
{
  std::string File;
  int Points = 250, Depth = 2, Frames = 100, Threads = 1;
  double Tolerance = 1e-3, Height = 0.01;
  bool Draw = false, KeepIndices = false;
};

// Medians of the phases of all frames but the first.
class Table
{
public:
  void Add(const std::string& phase, double seconds) { this->Phases[phase].push_back(seconds); }
  void Print() const
  {
    for (const auto& phase : this->Phases)
    {
      std::printf("%-10s %9.3f ms (worst %9.3f)\n", phase.first.c_str(),
        1e3 * measuring::Median(phase.second),
        1e3 * *std::max_element(phase.second.begin(), phase.second.end()));
    }
  }

private:
  std::map<std::string, std::vector<double>> Phases;
};

double Seconds(const std::function<void()>& work)
{
  const measuring::Stopwatch watch;
  work();
  return watch.Read().Elapsed;
}

vtkSmartPointer<vtkMapper> MakeMapper(bool composite, bool keepIndices)
{
  if (composite)
  {
    return vtkSmartPointer<vtkCompositePolyDataMapper2>::New();
  }
  if (keepIndices)
  {
    return vtkSmartPointer<vtkNURBSMeshMapper>::New();
  }
  return vtkSmartPointer<vtkPolyDataMapper>::New();
}

// Draws a mesh with its own window; llvmpipe where there is no GPU.
class Picture
{
public:
  Picture(vtkNURBSDeformingTessellator* filter, bool keepIndices)
  {
    const bool composite = filter->GetOutputDataObject(0)->IsA("vtkCompositeDataSet") != 0;
    this->Mapper = MakeMapper(composite, keepIndices);
    this->Mapper->SetInputConnection(filter->GetOutputPort());
    this->Mapper->ScalarVisibilityOff();
    vtkNew<vtkActor> actor;
    actor->SetMapper(this->Mapper);
    this->Renderer->AddActor(actor);
    this->Window =
      vtkSmartPointer<vtkNURBSEGLRenderWindow>::Take(vtkNURBSEGLRenderWindow::Create(800, 600));
    this->Window->SetMultiSamples(0);
    this->Window->AddRenderer(this->Renderer);
    this->Renderer->ResetCamera();
  }
  void Draw()
  {
    this->Window->Render();
    this->Window->WaitForCompletion();
  }

private:
  vtkSmartPointer<vtkMapper> Mapper;
  vtkNew<vtkRenderer> Renderer;
  vtkSmartPointer<vtkNURBSEGLRenderWindow> Window;
};

void Run(vtkDataObject* input, vtkNURBSDeformingTessellator* filter, const Settings& settings,
  const std::function<void(int)>& move)
{
  filter->SetInputDataObject(input);
  const double first = Seconds([&]() { filter->Update(); });
  std::printf("first frame %.1f ms, %lld points, %lld triangles\n", 1e3 * first,
    (long long)filter->GetNumberOfPoints(), (long long)filter->GetNumberOfTriangles());
  std::unique_ptr<Picture> picture;
  if (settings.Draw)
  {
    picture = std::make_unique<Picture>(filter, settings.KeepIndices);
    std::printf("first picture %.1f ms\n", 1e3 * Seconds([&]() { picture->Draw(); }));
  }
  Table table;
  double gap = 0.0, updated = 0.0, inserted = 0.0, deleted = 0.0, moved = 0.0;
  for (int frame = 1; frame <= settings.Frames; ++frame)
  {
    move(frame);
    table.Add("update", Seconds([&]() { filter->Update(); }));
    table.Add(" compare", filter->GetCompareSeconds());
    table.Add(" move", filter->GetMoveSeconds());
    table.Add(" adapt", filter->GetAdaptSeconds());
    table.Add(" rebuild", filter->GetRebuildSeconds());
    table.Add(" output", filter->GetOutputSeconds());
    if (picture)
    {
      const double drawn = Seconds([&]() { picture->Draw(); });
      const double again = Seconds([&]() { picture->Draw(); });
      table.Add("draw", again);
      table.Add("upload", drawn - again);
    }
    gap = std::max(gap, filter->GetModelGap());
    moved += double(filter->GetMovedControlPoints()) / settings.Frames;
    updated += double(filter->GetUpdatedVertices()) / settings.Frames;
    inserted += double(filter->GetInsertedVertices()) / settings.Frames;
    deleted += double(filter->GetDeletedVertices()) / settings.Frames;
  }
  table.Print();
  std::printf(
    "a frame: %.0f control points moved, %.0f vertices updated, %.0f inserted, %.0f deleted;"
    " %lld triangles at last; bound %g, tolerance %g, gap %g\n",
    moved, updated, inserted, deleted, (long long)filter->GetNumberOfTriangles(),
    filter->GetErrorBound(), filter->GetToleranceUsed(), gap);
}

void RunSheet(const Settings& settings)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShapeToSheet();
  source->SetSheetPoints(settings.Points, settings.Points);
  source->Update();
  vtkNew<vtkUnstructuredGrid> grid;
  grid->DeepCopy(source->GetOutput());
  vtkNew<vtkNURBSDeformingTessellator> filter;
  filter->SetTolerance(settings.Tolerance);
  filter->SetPatchSubdivisions(settings.Depth);
  filter->SetResolutionRefinement(settings.Depth < 0);
  const vtkIdType middle = vtkIdType(settings.Points / 2) * settings.Points + settings.Points / 2;
  const nurbs::Vec3 at(grid->GetPoint(middle));
  Run(grid, filter, settings, [&](int frame) {
    const nurbs::Vec3 x = at + nurbs::Vec3(0.0, 0.0, 5.0 * std::sin(0.1 * frame));
    grid->GetPoints()->SetPoint(middle, x.data());
    grid->GetPoints()->Modified();
  });
}

void RunWave(const Settings& settings)
{
  vtkNew<vtkNURBSCADReader> reader;
  reader->SetFileName(settings.File.c_str());
  reader->SingleModelOn();
  reader->Update();
  vtkNew<vtkPartitionedDataSetCollection> input;
  input->DeepCopy(reader->GetOutputDataObject(0));
  std::vector<vtkUnstructuredGrid*> grids;
  std::vector<std::vector<nurbs::Vec3>> rest;
  std::vector<nurbs::Box3> boxes;
  std::int64_t faces = 0;
  for (unsigned int p = 0; p < input->GetNumberOfPartitionedDataSets(); ++p)
  {
    auto* grid = vtkUnstructuredGrid::SafeDownCast(input->GetPartition(p, 0));
    grids.push_back(grid);
    faces += grid->GetNumberOfCells();
    rest.emplace_back();
    for (vtkIdType k = 0; k < grid->GetNumberOfPoints(); ++k)
    {
      rest.back().emplace_back(grid->GetPoint(k));
    }
    const auto view = vtkNURBSModel::View(grid);
    std::vector<std::string> errors;
    for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
    {
      errors.push_back(view->GetFaceError(c));
    }
    const std::vector<nurbs::Box3> some = nurbs::FaceBoxes(view->GetModel(), errors);
    boxes.insert(boxes.end(), some.begin(), some.end());
  }
  const double size = nurbs::Diagonal(boxes);
  std::printf("%lld faces in %zu models\n", (long long)faces, grids.size());
  std::printf("a view of all models: %.2f ms\n", 1e3 * Seconds([&]() {
    for (vtkUnstructuredGrid* grid : grids)
    {
      vtkNURBSModel::View(grid);
    }
  }));
  vtkNew<vtkNURBSDeformingTessellator> filter;
  filter->SetTolerance(settings.Tolerance);
  Run(input, filter, settings, [&](int frame) {
    for (std::size_t m = 0; m < grids.size(); ++m)
    {
      vtkPoints* points = grids[m]->GetPoints();
      for (std::size_t k = 0; k < rest[m].size(); ++k)
      {
        nurbs::Vec3 x = rest[m][k];
        x[2] += settings.Height * size * std::sin(6.0 * (x[0] + 0.5 * x[1]) / size + 0.05 * frame) *
          std::min(1.0, 0.05 * frame);
        points->SetPoint(vtkIdType(k), x.data());
      }
      points->Modified();
    }
    input->Modified();
  });
}

} // namespace

int main(int argc, char** argv)
{
  Settings settings;
  CLI::App app("Milliseconds a frame of a deforming model takes");
  app.add_option("--frames", settings.Frames, "frames after the first");
  app.add_option("--threads", settings.Threads, "of vtkSMPTools");
  app.add_option("--tolerance", settings.Tolerance, "of the diagonal");
  app.add_flag("--draw", settings.Draw, "draw each frame twice, 800 x 600 pixels");
  app.add_flag("--keep-indices", settings.KeepIndices, "draw by a mapper that keeps index buffers");
  CLI::App* sheet = app.add_subcommand("sheet", "a control point of a sheet is dragged");
  sheet->add_option("--points", settings.Points, "control points in u and v");
  sheet->add_option("--depth", settings.Depth, "subdivisions of a patch; -1: adaptive");
  CLI::App* wave = app.add_subcommand("wave", "a wave through a CAD file");
  wave->add_option("file", settings.File, "the file")->required();
  wave->add_option("--height", settings.Height, "of the wave, share of the size");
  app.require_subcommand(1);
  app.fallthrough();
  CLI11_PARSE(app, argc, argv);
  vtkSMPTools::Initialize(settings.Threads);
  sheet->parsed() ? RunSheet(settings) : RunWave(settings);
  return 0;
}
