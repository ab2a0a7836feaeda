// SPDX-License-Identifier: BSD-3-Clause
// Times drawing of one model by vtkNURBSMapper, or by tessellation and vtkPolyDataMapper, and
// prints JSON; see --help.
#include "DeviceTimer.h"
#include "Measuring.h"
#include "vtkNURBSEGLRenderWindow.h"
#include "vtkNURBSMapper.h"
#include "vtkNURBSShapeSource.h"
#include "vtkNURBSTessellator.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkRenderer.h>
#include <vtkUnstructuredGrid.h>

#include <cmath>
#include <iostream>
#include <memory>

namespace
{

struct Arguments
{
  std::string Method = "exact";
  int Patches = 1000, Frames = 10, Device = -1;
  double PixelError = 0.5;
};

void Declare(CLI::App& app, Arguments& a)
{
  app
    .add_option("--method", a.Method,
      "exact or triangles (vtkNURBSMapper with and without ExactFragments), guaranteed or "
      "estimated "
      "(vtkNURBSTessellator's error modes)")
    ->check(CLI::IsMember({ "exact", "triangles", "guaranteed", "estimated" }));
  app.add_option("--patches", a.Patches, "Faces of the car body")->capture_default_str();
  app.add_option("--pixel-error", a.PixelError, "Of triangles on screen")->capture_default_str();
  app.add_option("--frames", a.Frames, "Frames of each kind")->capture_default_str();
  app.add_option("--device", a.Device, "EGL device; -1: the first that works")
    ->capture_default_str();
}

/// A way to draw a model.
class Method
{
public:
  virtual ~Method() = default;
  virtual vtkMapper* GetMapper() = 0;
  /// The camera or the points have changed.
  virtual void Changed() {}
  virtual double BytesSent() = 0;
  virtual std::int64_t Triangles() = 0;
};

class NURBSMethod : public Method
{
public:
  NURBSMethod(vtkUnstructuredGrid* model, const Arguments& a)
  {
    this->Mapper->SetInputData(model);
    this->Mapper->SetPixelError(a.PixelError);
    this->Mapper->SetExactFragments(a.Method == "exact");
    this->Mapper->SetInteractiveFrameRate(0.0);
  }
  vtkMapper* GetMapper() override { return this->Mapper; }
  double BytesSent() override { return double(this->Mapper->GetNumberOfBytesSent()); }
  std::int64_t Triangles() override { return this->Mapper->GetNumberOfTriangles(); }

private:
  vtkNew<vtkNURBSMapper> Mapper;
};

class PolyDataMethod : public Method
{
public:
  PolyDataMethod(vtkUnstructuredGrid* model, vtkCamera* camera, const int* size, const Arguments& a)
  {
    this->Tessellator->SetInputData(model);
    this->Tessellator->SetToleranceModeToPixels();
    this->Tessellator->SetPixelTolerance(a.PixelError);
    this->Tessellator->SetCamera(camera);
    this->Tessellator->SetViewportSize(size[0], size[1]);
    a.Method == "guaranteed" ? this->Tessellator->SetErrorModeToGuaranteed()
                             : this->Tessellator->SetErrorModeToEstimated();
    this->Mapper->SetInputConnection(this->Tessellator->GetOutputPort());
    this->Mapper->ScalarVisibilityOff();
  }
  vtkMapper* GetMapper() override { return this->Mapper; }
  void Changed() override { this->Tessellator->Modified(); }
  /// Of each mesh that was made since the start: points, normals, three indices a triangle.
  double BytesSent() override
  {
    vtkPolyData* mesh = this->Mapper->GetInput();
    if (mesh && mesh->GetMTime() != this->Counted)
    {
      this->Counted = mesh->GetMTime();
      this->Bytes += 4.0 * (6.0 * mesh->GetNumberOfPoints() + 3.0 * mesh->GetNumberOfPolys());
    }
    return this->Bytes;
  }
  std::int64_t Triangles() override { return this->Mapper->GetInput()->GetNumberOfPolys(); }

private:
  vtkNew<vtkNURBSTessellator> Tessellator;
  vtkNew<vtkPolyDataMapper> Mapper;
  vtkMTimeType Counted = 0;
  double Bytes = 0.0;
};

/// Moves all points of a model along a wave.
void Deform(vtkUnstructuredGrid* model, vtkPoints* rest, double phase, double size)
{
  auto* points = vtkDoubleArray::SafeDownCast(model->GetPoints()->GetData());
  for (vtkIdType i = 0; i < rest->GetNumberOfPoints(); ++i)
  {
    double p[3];
    rest->GetPoint(i, p);
    p[2] += 0.02 * size * std::sin(phase + 10.0 * p[0] / size);
    points->SetTypedTuple(i, p);
  }
  points->Modified();
  model->GetPoints()->Modified();
  model->Modified();
}

/// Renders frames and tells what one costs.
class Frames
{
public:
  Frames(vtkRenderWindow* window, Method& method)
    : Window(window)
    , How(method)
  {}

  /// Medians of `count` frames, or as many as take 3 s, each after `prepare`, which is not timed. A
  /// GPU's own time is that of every other frame but the first.
  template <typename F>
  nlohmann::json Measure(int count, F&& prepare)
  {
    std::vector<double> seconds, device;
    const double before = this->How.BytesSent();
    double total = 0.0;
    for (int i = 0; i < count && total < 3.0; ++i)
    {
      prepare(i);
      const bool byDevice = this->Timer.IsAvailable() && i % 2 == 1;
      const measuring::Stopwatch stopwatch;
      if (byDevice)
      {
        this->Timer.Start(seconds.back());
      }
      this->Window->Render();
      if (byDevice)
      {
        device.push_back(this->Timer.Stop());
      }
      this->Window->WaitForCompletion();
      const double taken = stopwatch.Read().Elapsed;
      if (!byDevice)
      {
        seconds.push_back(taken);
      }
      total += taken;
      this->Bytes = this->How.BytesSent();
    }
    return { { "seconds", measuring::Median(seconds) },
      { "device", device.empty() ? 0.0 : measuring::Median(device) },
      { "bytes", (this->Bytes - before) / double(seconds.size() + device.size()) },
      { "triangles", this->How.Triangles() } };
  }

private:
  vtkRenderWindow* Window;
  Method& How;
  DeviceTimer Timer;
  double Bytes = 0.0;
};

nlohmann::json Run(const Arguments& a)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShapeToCarBody();
  source->SetNumberOfPatches(a.Patches);
  source->Update();
  vtkUnstructuredGrid* model = source->GetOutput();
  vtkNew<vtkPoints> rest;
  rest->DeepCopy(model->GetPoints());

  constexpr int Size[2] = { 800, 600 };
  auto window = vtkSmartPointer<vtkNURBSEGLRenderWindow>::Take(
    vtkNURBSEGLRenderWindow::Create(Size[0], Size[1]));
  if (!window)
  {
    throw std::runtime_error("there is no OpenGL");
  }
  if (a.Device >= 0)
  {
    window->SetDeviceIndex(a.Device);
  }
  window->SetMultiSamples(0);
  vtkNew<vtkRenderer> renderer;
  window->AddRenderer(renderer);
  window->Render(); // what any first picture costs
  window->WaitForCompletion();
  vtkCamera* camera = renderer->GetActiveCamera();
  camera->SetPosition(-2.0, -2.5, 1.5);
  camera->SetViewUp(0.0, 0.0, 1.0);
  renderer->ResetCamera(model->GetBounds());

  nlohmann::json result;
  result["renderer"] = window->GetRendererName();
  result["faces"] = model->GetNumberOfCells();
  result["memory_start"] = measuring::PeakMemory();
  const double size = model->GetLength();
  std::unique_ptr<Method> method;
  if (a.Method == "exact" || a.Method == "triangles")
  {
    method = std::make_unique<NURBSMethod>(model, a);
  }
  else
  {
    method = std::make_unique<PolyDataMethod>(model, camera, Size, a);
  }
  vtkNew<vtkActor> actor;
  actor->SetMapper(method->GetMapper());
  renderer->AddActor(actor);
  Frames frames(window, *method);
  result["first"] = frames.Measure(1, [](int) {});
  result["still"] = frames.Measure(a.Frames, [](int) {});
  result["zooming"] = frames.Measure(a.Frames, [&](int) {
    camera->Zoom(1.1);
    renderer->ResetCameraClippingRange();
    method->Changed();
  });
  camera->SetViewAngle(30.0);
  renderer->ResetCameraClippingRange();
  method->Changed();
  window->Render();
  result["moving"] = frames.Measure(a.Frames, [&](int i) {
    Deform(model, rest, 0.3 * (i + 1), size);
    method->Changed();
  });
  result["memory"] = measuring::PeakMemory();
  return result;
}

} // namespace

int main(int argc, char** argv)
{
  Arguments arguments;
  CLI::App app{ "Times drawing of a car body, 800 x 600 pixels, and prints JSON: the first "
                "picture, and medians\n"
                "of frames that are still, zooming by 1.1, and with all control points moving. "
                "Bytes are those\n"
                "sent to the device, a frame." };
  Declare(app, arguments);
  CLI11_PARSE(app, argc, argv);
  try
  {
    std::cout << Run(arguments).dump() << '\n';
    return 0;
  }
  catch (const std::exception& e)
  {
    std::cerr << e.what() << '\n';
  }
  return 2;
}
