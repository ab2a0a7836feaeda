// SPDX-License-Identifier: BSD-3-Clause
/// @file WaveletTexturesBenchmark.cxx
/// @brief Changing the level of detail by wavelets on the GPU, against evaluating again there.
///
/// Prints the figures of Documentation/Papers/tan-2012-wavelets.md (Tan, Zhao, Lu 2012, figure 15:
/// grids of 128 to 1024 squared of a bicubic surface of 21 x 23 control points). What is evaluated
/// again are tiles of about as many vertices, by the mapper's passes of de Boor's algorithm; their
/// time is given for the grid's number of vertices. Both give positions and normals: the wavelets
/// transform two textures. Each figure is the median of several runs, until the device is done:
/// elapsed time, of a software renderer the processor time of its threads; of a GPU also that of
/// its own work.
#include "../../Rendering/OpenGL2/vtkNURBSTileTextures.h"
#include "../Benchmarks/DeviceTimer.h"
#include "../Benchmarks/Measuring.h"
#include "vtkNURBSEGLRenderWindow.h"
#include "vtkNURBSWaveletTextures.h"
#include "vtkNew.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"
#include "vtkTextureObject.h"
#include "vtk_glew.h"

#include <cmath>
#include <cstdio>
#include <cstring>

namespace
{

constexpr int Repeat = 15;

nurbs::Surface Sheet()
{
  nurbs::Surface s;
  const int count[2] = { 21, 23 };
  for (int d = 0; d < 2; ++d)
  {
    s.Degree[d] = 3;
    s.Count[d] = count[d];
    s.Knots[d] = nurbs::UniformKnots(3, count[d]);
  }
  for (int j = 0; j < count[1]; ++j)
  {
    for (int i = 0; i < count[0]; ++i)
    {
      s.Points.emplace_back(i, j, std::sin(0.7 * i) * std::cos(0.5 * j));
      s.Weights.push_back(1.0 + 0.3 * std::sin(1.0 * i + 2.0 * j));
    }
  }
  return s;
}

bool IsSoftware()
{
  return std::strstr(reinterpret_cast<const char*>(glGetString(GL_RENDERER)), "llvmpipe") !=
    nullptr;
}

// Seconds by the clock, and of the device's own work; 0 if it does not tell.
struct Time
{
  double Clock, Device;
};

template <class Work>
Time Median(Work&& work)
{
  DeviceTimer timer;
  std::vector<double> device;
  const measuring::Duration taken = measuring::MedianTime(Repeat, [&]() {
    work();
    glFinish();
  });
  for (int i = 0; i < Repeat && timer.IsAvailable(); ++i)
  {
    timer.Start(taken.Elapsed);
    work();
    device.push_back(timer.Stop());
  }
  return { IsSoftware() ? taken.Processor : taken.Elapsed,
    device.empty() ? 0.0 : measuring::Median(device) };
}

// Of evaluating all spans of the surface in 2^log cells, a vertex.
Time Evaluation(vtkOpenGLRenderWindow* window, const nurbs::SurfaceTable& table, int log)
{
  vtkNURBSTileTextures textures;
  if (!textures.SetTable(table, { vtkNURBSTileTextures::SurfaceInfo() }))
  {
    std::printf("%s\n", textures.GetError().c_str());
    std::exit(1);
  }
  std::vector<nurbs::Tile> tiles;
  const int cells = 1 << log;
  const int step = std::min(cells, 1 << nurbs::Tile::MaxLog);
  for (int j = 0; j < int(table[0].Spans[1].size()); ++j)
  {
    for (int i = 0; i < int(table[0].Spans[0].size()); ++i)
    {
      for (int b = 0; b < cells; b += step)
      {
        for (int a = 0; a < cells; a += step)
        {
          tiles.push_back({ 0, { i, j }, { log, log }, { a, b } });
        }
      }
    }
  }
  long long before = 0;
  const Time time = Median([&]() {
    textures.MoveSurfaces(table, { 0 }); // Forgets the tiles.
    before = textures.GetEvaluatedVertices();
    if (!textures.Prepare(window, table, tiles))
    {
      std::printf("%s\n", textures.GetError().c_str());
      std::exit(1);
    }
  });
  const double vertices = double(textures.GetEvaluatedVertices() - before);
  textures.Release(window);
  return { time.Clock / vertices, time.Device / vertices };
}

Time Step(vtkOpenGLRenderWindow* window, nurbs::Wavelet kind, int intervals, bool synthesis)
{
  vtkNURBSWaveletTextures transform;
  vtkNURBSWaveletTextures::Rectangle r;
  r.Step.Kind = kind;
  r.Step.Intervals[0] = r.Step.Intervals[1] = intervals;
  r.Step.Halved[0] = r.Step.Halved[1] = true;
  const int width = r.Step.FineSamples(0);
  vtkNew<vtkTextureObject> grids[2]; // Positions and normals.
  std::vector<float> values(std::size_t(4) * width * width, 0.5f);
  for (vtkTextureObject* texture : { grids[0].Get(), grids[1].Get() })
  {
    texture->SetContext(window);
    texture->SetMinificationFilter(vtkTextureObject::Nearest);
    texture->SetMagnificationFilter(vtkTextureObject::Nearest);
    texture->Create2DFromRaw(width, width, 4, VTK_FLOAT, values.data());
  }
  const Time time = Median([&]() {
    for (vtkTextureObject* texture : { grids[0].Get(), grids[1].Get() })
    {
      synthesis ? transform.Synthesise(window, texture, kind, { r })
                : transform.Analyse(window, texture, kind, { r });
    }
  });
  transform.Release(window);
  for (vtkTextureObject* texture : { grids[0].Get(), grids[1].Get() })
  {
    texture->ReleaseGraphicsResources(window);
  }
  return time;
}

struct Row
{
  int Intervals;
  nurbs::Wavelet Kind;
  Time Vertex, Finer, Coarser;
};

void Print(const std::vector<Row>& rows, const char* which, double Time::*time)
{
  std::printf("rational bicubic, 21 x 23 control points; positions and normals, ms%s\n", which);
  std::printf("%9s %12s  %-13s %16s %16s\n", "grid", "evaluated", "wavelet", "finer", "coarser");
  const char* const names[] = { "Haar", "interpolating", "lifted" };
  for (const Row& row : rows)
  {
    const double samples = row.Intervals + 1.0, fewer = row.Intervals / 2 + 1.0;
    const double finer = row.Vertex.*time * samples * samples;
    const double coarser = row.Vertex.*time * fewer * fewer;
    const double up = row.Finer.*time, down = row.Coarser.*time;
    std::printf("%4d^2 %14.3f  %-13s %8.3f %6.1fx %8.3f %6.1fx\n", row.Intervals, 1e3 * finer,
      names[int(row.Kind)], 1e3 * up, finer / up, 1e3 * down, coarser / down);
  }
}

} // namespace

int main()
{
  auto window =
    vtkSmartPointer<vtkNURBSEGLRenderWindow>::Take(vtkNURBSEGLRenderWindow::Create(16, 16));
  if (!window)
  {
    return 1;
  }
  vtkNew<vtkRenderer> renderer;
  window->AddRenderer(renderer);
  window->Render();
  if (!window->GetErrorMessage().empty())
  {
    return 1;
  }
  std::printf("%s\n", reinterpret_cast<const char*>(glGetString(GL_RENDERER)));
  const nurbs::Surface surface = Sheet();
  nurbs::SurfaceTable table;
  table.Add(surface.View(), nurbs::Box2(nurbs::Vec2(0.0, 0.0), nurbs::Vec2(1.0, 1.0)));
  table.Fill(0, 1);
  std::vector<Row> rows;
  for (int log = 3; log <= 6; ++log)
  {
    const Time vertex = Evaluation(window, table, log);
    for (const nurbs::Wavelet kind :
      { nurbs::Wavelet::Haar, nurbs::Wavelet::Interpolating, nurbs::Wavelet::Lifted })
    {
      const int n = 16 << log;
      rows.push_back(
        { n, kind, vertex, Step(window, kind, n, true), Step(window, kind, n, false) });
    }
  }
  Print(rows, "", &Time::Clock);
  if (rows[0].Vertex.Device > 0.0)
  {
    Print(rows, ", of the GPU alone", &Time::Device);
  }
  return 0;
}
