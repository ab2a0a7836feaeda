// SPDX-License-Identifier: BSD-3-Clause
// What a frame of an animation costs, from the deformer over vtkNURBSDeformingTessellator to the
// picture (vtkNURBSMeshMapper, EGL, 640 x 480 pixels), by phase; prints one JSON line.
//   DeformingAnimation sheet [--points 253] [--depth 2] ...  a control point of a sheet is dragged
//   DeformingAnimation lattice FILE [--spacing 0.05] ...  a CAD file in a moving 5 x 5 x 5 lattice
// Seconds are processor time of the whole process. The tessellator tells its phases by the clock;
// they are scaled so that its update takes the processor time it took.
#include "Measuring.h"

#include "vtkMeshOpenEdges.h"
#include "vtkNURBSCADReader.h"
#include "vtkNURBSControlPointEdits.h"
#include "vtkNURBSDeformingTessellator.h"
#include "vtkNURBSEGLRenderWindow.h"
#include "vtkNURBSFreeFormDeformation.h"
#include "vtkNURBSRefinement.h"
#include "vtkNURBSShapeSource.h"
#include "vtkNURBSTessellator.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkDataArray.h"
#include "vtkNURBSMeshMapper.h"
#include "vtkNew.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkRenderer.h"
#include "vtkSMPTools.h"
#include "vtkUnstructuredGrid.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <stdexcept>

namespace
{

constexpr double TwoPi = 6.283185307179586;
constexpr int Lattice = 5;
constexpr int DragFrames = 100;    // of one control point of the sheet, there and back
constexpr int LatticeFrames = 125; // of one period

struct Settings
{
  std::string File;
  int Points = 253, Depth = 2, Frames = 1000, Threads = 1;
  int DrawEvery = 1, CheckEvery = 50, FreshEvery = 100;
  double Tolerance = 1e-3, Amplitude = 0.05, Spacing = 0.05, Seconds = 1e9;
};

/// What is deformed: moves its control points, and tells what filter they come out of.
class Scene
{
public:
  virtual ~Scene() = default;
  virtual vtkAlgorithm* Deformer() = 0;
  virtual void Move(int frame) = 0;
  virtual bool HasBorder() const = 0;
  vtkUnstructuredGrid* Model()
  {
    return vtkUnstructuredGrid::SafeDownCast(this->Deformer()->GetOutputDataObject(0));
  }
};

/// A control point is dragged up, down and back in 100 frames; then comes the next one.
class SheetScene : public Scene
{
public:
  explicit SheetScene(const Settings& settings)
    : Points(settings.Points)
  {
    this->Source->SetShapeToSheet();
    this->Source->SetSheetPoints(settings.Points, settings.Points);
    this->Edits->SetInputConnection(this->Source->GetOutputPort());
    this->Edits->MoveCoincidentOff();
    this->Height = settings.Amplitude * this->Source->GetSheetSize();
  }
  vtkAlgorithm* Deformer() override { return this->Edits; }
  bool HasBorder() const override { return true; }
  void Move(int frame) override
  {
    const int drag = (frame - 1) / DragFrames, inner = this->Points - 8;
    const vtkIdType i = 4 + (inner / 2 + 7 * drag) % inner, j = 4 + (inner / 2 + 5 * drag) % inner;
    const vtkIdType point = j * this->Points + i;
    double x[3];
    vtkUnstructuredGrid::SafeDownCast(this->Source->GetOutput())->GetPoint(point, x);
    const double angle = TwoPi * double((frame - 1) % DragFrames + 1) / DragFrames;
    this->Edits->SetControlPointPosition(point, x[0], x[1], x[2] + this->Height * std::sin(angle));
  }

private:
  int Points;
  double Height = 0.0;
  vtkNew<vtkNURBSShapeSource> Source;
  vtkNew<vtkNURBSControlPointEdits> Edits;
};

/// Waves run through a lattice; from rest they grow over 20 frames.
class LatticeScene : public Scene
{
public:
  explicit LatticeScene(const Settings& settings)
  {
    vtkNew<vtkNURBSCADReader> reader;
    reader->SetFileName(settings.File.c_str());
    reader->SingleModelOn();
    reader->Update();
    auto* parts = vtkPartitionedDataSetCollection::SafeDownCast(reader->GetOutputDataObject(0));
    auto* model = parts && parts->GetNumberOfPartitionedDataSets() > 0
      ? vtkUnstructuredGrid::SafeDownCast(parts->GetPartition(0, 0))
      : nullptr;
    if (!model)
    {
      throw std::runtime_error(settings.File + " has no faces");
    }
    this->Amplitude = settings.Amplitude * model->GetLength();
    this->Refinement->SetInputData(model);
    this->Refinement->SetMaximumSpacing(settings.Spacing);
    this->Bend->SetInputConnection(this->Refinement->GetOutputPort());
    this->Bend->SetDimensions(Lattice, Lattice, Lattice);
    this->Bend->SetMargin(0.05);
  }
  vtkAlgorithm* Deformer() override { return this->Bend; }
  bool HasBorder() const override { return false; }
  void Move(int frame) override
  {
    const double height = this->Amplitude * std::min(1.0, frame / 20.0);
    const double phase = TwoPi * double(frame) / LatticeFrames;
    for (int k = 0; k < Lattice; ++k)
    {
      for (int j = 0; j < Lattice; ++j)
      {
        for (int i = 0; i < Lattice; ++i)
        {
          this->Bend->SetLatticeDisplacement(i, j, k, 0.0, 0.5 * height * std::sin(phase + 1.2 * k),
            height * std::sin(phase + 1.2 * i + 0.6 * j));
        }
      }
    }
  }

private:
  double Amplitude = 0.0;
  vtkNew<vtkNURBSRefinement> Refinement;
  vtkNew<vtkNURBSFreeFormDeformation> Bend;
};

/// The mapper, which tells how long it takes to fill its vertex and its index buffers.
class TimedMapper : public vtkNURBSMeshMapper
{
public:
  static TimedMapper* New() { return new TimedMapper; }
  vtkTypeMacro(TimedMapper, vtkNURBSMeshMapper);
  double BufferSeconds = 0.0; ///< Of both.
  double IndexSeconds = 0.0;

protected:
  void BuildBufferObjects(vtkRenderer* renderer, vtkActor* actor) override
  {
    const measuring::Stopwatch watch;
    this->Superclass::BuildBufferObjects(renderer, actor);
    this->BufferSeconds += watch.Read().Processor;
  }
  void BuildIBO(vtkRenderer* renderer, vtkActor* actor, vtkPolyData* mesh) override
  {
    const measuring::Stopwatch watch;
    this->Superclass::BuildIBO(renderer, actor, mesh);
    this->IndexSeconds += watch.Read().Processor;
  }
};

/// The mesh in a window of its own; llvmpipe where there is no GPU.
class Picture
{
public:
  explicit Picture(vtkAlgorithm* mesher)
  {
    this->Mapper->SetInputConnection(mesher->GetOutputPort());
    this->Mapper->ScalarVisibilityOff();
    vtkNew<vtkActor> actor;
    actor->SetMapper(this->Mapper);
    this->Renderer->AddActor(actor);
    this->Window =
      vtkSmartPointer<vtkNURBSEGLRenderWindow>::Take(vtkNURBSEGLRenderWindow::Create(640, 480));
    if (!this->Window)
    {
      throw std::runtime_error("no OpenGL; the message above tells why");
    }
    this->Window->SetMultiSamples(0);
    this->Window->AddRenderer(this->Renderer);
    this->Renderer->GetActiveCamera()->SetPosition(1.0, -2.0, 1.5);
    this->Renderer->GetActiveCamera()->SetViewUp(0.0, 0.0, 1.0);
    this->Renderer->ResetCamera();
  }
  std::string Device() { return this->Window->GetRendererName(); }
  void Draw(std::map<std::string, std::vector<double>>& phases)
  {
    this->Mapper->BufferSeconds = this->Mapper->IndexSeconds = 0.0;
    const measuring::Stopwatch watch;
    this->Window->Render();
    this->Window->WaitForCompletion();
    const double all = watch.Read().Processor;
    phases["upload points"].push_back(this->Mapper->BufferSeconds - this->Mapper->IndexSeconds);
    phases["upload triangles"].push_back(this->Mapper->IndexSeconds);
    phases["draw"].push_back(all - this->Mapper->BufferSeconds);
    phases["downstream"].push_back(all);
  }

private:
  vtkNew<TimedMapper> Mapper;
  vtkNew<vtkRenderer> Renderer;
  vtkSmartPointer<vtkNURBSEGLRenderWindow> Window;
};

double Processor(vtkAlgorithm* filter)
{
  const measuring::Stopwatch watch;
  filter->Update();
  return watch.Read().Processor;
}

nlohmann::json Summary(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  double sum = 0.0;
  for (double value : values)
  {
    sum += value;
  }
  const std::size_t n = values.size();
  return { { "mean", sum / double(n) }, { "median", values[n / 2] },
    { "p95", values[std::min(n - 1, std::size_t(0.95 * double(n)))] }, { "worst", values.back() } };
}

class Animation
{
public:
  Animation(Scene& scene, const Settings& settings)
    : What(scene)
    , With(settings)
  {
    this->Mesher->SetInputConnection(scene.Deformer()->GetOutputPort());
    this->Mesher->SetTolerance(settings.Tolerance);
    this->Mesher->SetPatchSubdivisions(settings.Depth);
    this->Mesher->SetResolutionRefinement(settings.Depth < 0);
    this->Fresh->SetToleranceModeToAbsolute();
  }

  nlohmann::json Run()
  {
    this->First();
    const measuring::Stopwatch watch;
    int frame = 0;
    while (frame < this->With.Frames && watch.Read().Elapsed < this->With.Seconds)
    {
      this->Frame(++frame);
    }
    this->Done["frames"] = frame;
    for (const auto& phase : this->Phases)
    {
      this->Done["phases"][phase.first] = Summary(phase.second);
    }
    for (const auto& count : this->Counts)
    {
      this->Done["counts"][count.first] = Summary(count.second);
    }
    this->Done["memory"] = measuring::PeakMemory();
    return this->Done;
  }

private:
  void First()
  {
    this->Done["first"]["deform"] = Processor(this->What.Deformer());
    this->Done["first"]["mesh"] = Processor(this->Mesher);
    this->Done["faces"] = this->What.Model()->GetNumberOfCells();
    this->Done["control_points"] = this->What.Model()->GetNumberOfPoints();
    this->Done["first"]["triangles"] = this->Mesher->GetNumberOfTriangles();
    this->Done["first"]["points"] = this->Mesher->GetNumberOfPoints();
    this->Done["first"]["bound"] = this->Mesher->GetErrorBound();
    this->Done["first"]["gap"] = this->Mesher->GetModelGap();
    this->Done["first"]["open_edges"] = this->OpenEdges(this->Mesher);
    this->Done["tolerance"] = this->Mesher->GetToleranceUsed();
    this->Shown = std::make_unique<Picture>(this->Mesher);
    this->Done["device"] = this->Shown->Device();
    std::map<std::string, std::vector<double>> phases;
    this->Shown->Draw(phases);
    this->Done["first"]["picture"] = phases["downstream"].back();
    this->FreshTolerance = this->Mesher->GetToleranceUsed();
    if (this->With.Depth >= 0)
    {
      this->FindFreshTolerance();
    }
    this->Done["fresh_tolerance"] = this->FreshTolerance;
    this->Done["first"]["fresh"] = this->Remake();
    this->Done["first"]["fresh_triangles"] = this->Fresh->GetNumberOfTriangles();
    this->Done["first"]["fresh_open_edges"] = this->OpenEdges(this->Fresh);
  }

  // Of a mesh that nobody gave a tolerance: the one at which the rival makes as many triangles.
  void FindFreshTolerance()
  {
    for (int step = 0; step < 4; ++step)
    {
      this->Remake();
      this->FreshTolerance *=
        double(this->Fresh->GetNumberOfTriangles()) / double(this->Mesher->GetNumberOfTriangles());
    }
  }

  double Remake()
  {
    this->Fresh->SetAbsoluteTolerance(this->FreshTolerance);
    vtkNew<vtkUnstructuredGrid> model;
    model->ShallowCopy(this->What.Model());
    this->Fresh->SetInputData(model);
    vtkObject::GlobalWarningDisplayOff(); // Capped faces of bent models, each time.
    const double seconds = Processor(this->Fresh);
    vtkObject::GlobalWarningDisplayOn();
    return seconds;
  }

  vtkIdType OpenEdges(vtkAlgorithm* mesher)
  {
    return CountOpenEdges(
      vtkPolyData::SafeDownCast(mesher->GetOutputDataObject(0)), this->What.HasBorder());
  }

  void Frame(int frame)
  {
    this->What.Move(frame);
    double all = Processor(this->What.Deformer());
    this->Phases["deform"].push_back(all);
    const measuring::Stopwatch watch;
    this->Mesher->Update();
    const measuring::Duration update = watch.Read();
    all += update.Processor;
    this->NoteUpdate(update);
    if (frame % this->With.DrawEvery == 0)
    {
      this->Shown->Draw(this->Phases);
      all += this->Phases["downstream"].back();
      this->Phases["frame"].push_back(all);
    }
    if (frame % this->With.CheckEvery == 0)
    {
      this->Done["open_edges"].push_back(this->OpenEdges(this->Mesher));
    }
    if (frame % this->With.FreshEvery == 0)
    {
      this->Phases["fresh"].push_back(this->Remake());
      this->Counts["fresh triangles"].push_back(double(this->Fresh->GetNumberOfTriangles()));
    }
  }

  void NoteUpdate(const measuring::Duration& update)
  {
    vtkNURBSDeformingTessellator* mesher = this->Mesher;
    const double scale = update.Processor / update.Elapsed;
    this->Phases["update"].push_back(update.Processor);
    this->Phases["compare"].push_back(scale * mesher->GetCompareSeconds());
    this->Phases["move"].push_back(scale * mesher->GetMoveSeconds());
    this->Phases["adapt"].push_back(scale * mesher->GetAdaptSeconds());
    this->Phases["rebuild"].push_back(scale * mesher->GetRebuildSeconds());
    this->Phases["output"].push_back(scale * mesher->GetOutputSeconds());
    this->Counts["moved"].push_back(double(mesher->GetMovedControlPoints()));
    this->Counts["updated"].push_back(double(mesher->GetUpdatedVertices()));
    this->Counts["inserted"].push_back(double(mesher->GetInsertedVertices()));
    this->Counts["deleted"].push_back(double(mesher->GetDeletedVertices()));
    this->Counts["triangles"].push_back(double(mesher->GetNumberOfTriangles()));
    this->Counts["bound"].push_back(mesher->GetErrorBound());
    this->Counts["gap"].push_back(mesher->GetModelGap());
    this->Counts["refused"].push_back(double(mesher->GetRefusedModels()));
    this->Counts["remade"].push_back(double(mesher->GetRebuiltModels()));
  }

  Scene& What;
  const Settings& With;
  vtkNew<vtkNURBSDeformingTessellator> Mesher;
  vtkNew<vtkNURBSTessellator> Fresh;
  double FreshTolerance = 0.0;
  std::unique_ptr<Picture> Shown;
  std::map<std::string, std::vector<double>> Phases, Counts;
  nlohmann::json Done;
};

} // namespace

int main(int argc, char** argv)
{
  Settings settings;
  CLI::App app("What a frame of an animation costs, by phase");
  app.require_subcommand(1);
  app.fallthrough(); // Subcommands take over what stands here already.
  app.add_option("--frames", settings.Frames, "after the first")->check(CLI::PositiveNumber);
  app.add_option("--seconds", settings.Seconds, "by the clock, after which no frame is begun");
  app.add_option("--threads", settings.Threads, "of vtkSMPTools");
  app.add_option("--tolerance", settings.Tolerance, "of the diagonal");
  app.add_option("--amplitude", settings.Amplitude, "of the motion, of the size");
  app.add_option("--draw-every", settings.DrawEvery, "frames")->check(CLI::PositiveNumber);
  app.add_option("--check-every", settings.CheckEvery, "frames, open edges are counted")
    ->check(CLI::PositiveNumber);
  app.add_option("--fresh-every", settings.FreshEvery, "frames, vtkNURBSTessellator is measured")
    ->check(CLI::PositiveNumber);
  CLI::App* sheet = app.add_subcommand("sheet", "a control point of a sheet is dragged");
  sheet->add_option("--points", settings.Points, "control points in u and v")
    ->check(CLI::Range(16, 2000));
  sheet->add_option("--depth", settings.Depth, "subdivisions of a patch; -1: by the tolerance");
  CLI::App* lattice = app.add_subcommand("lattice", "a CAD file in a moving lattice");
  lattice->add_option("file", settings.File, "the file")->required();
  lattice->add_option("--spacing", settings.Spacing, "of control points, of the diagonal");
  CLI11_PARSE(app, argc, argv);
  vtkSMPTools::Initialize(settings.Threads);
  try
  {
    std::unique_ptr<Scene> scene;
    if (lattice->parsed())
    {
      settings.Depth = -1;
      scene = std::make_unique<LatticeScene>(settings);
    }
    else
    {
      scene = std::make_unique<SheetScene>(settings);
    }
    std::printf("%s\n", Animation(*scene, settings).Run().dump().c_str());
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
