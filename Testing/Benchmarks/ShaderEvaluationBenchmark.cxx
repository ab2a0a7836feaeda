// SPDX-License-Identifier: BSD-3-Clause
// Times evaluation of a rational surface on the GPU, by de Boor's algorithm as
// vtkNURBSTileTextures does it and by basis functions in many passes, and prints JSON; see --help.
#include "DeviceTimer.h"
#include "Measuring.h"
#include "SurfaceTable.h"
#include "TileSelection.h"
#include "vtkNURBSBufferTexture.h"
#include "vtkNURBSEGLRenderWindow.h"
#include "vtkNURBSTileTextures.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <vtkNew.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLShaderCache.h>
#include <vtkOpenGLState.h>
#include <vtkOpenGLVertexArrayObject.h>
#include <vtkRenderer.h>
#include <vtkShaderProgram.h>
#include <vtkTextureObject.h>
#include <vtk_glew.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>

namespace
{

/// The control net has `side` x `side` points.
nurbs::Surface Sheet(int degree, int side)
{
  nurbs::Surface s;
  for (int dir = 0; dir < 2; ++dir)
  {
    s.Degree[dir] = degree;
    s.Count[dir] = side;
    s.Knots[dir] = nurbs::UniformKnots(degree, side);
  }
  for (int j = 0; j < side; ++j)
  {
    for (int i = 0; i < side; ++i)
    {
      const double x = double(i) / side, y = double(j) / side;
      s.Points.push_back(nurbs::Vec3(x, y, 0.1 * std::sin(9.0 * x) * std::cos(7.0 * y)));
      s.Weights.push_back(1.0 + 0.3 * std::sin(i + 2.0 * j));
    }
  }
  return s;
}

/// What a run takes, in seconds.
struct Time
{
  double Elapsed = 0.0;
  double Device = 0.0; ///< The device's own work; 0 if it does not tell.
};

/// Medians of runs with the device's work done: at least one, at most nine, a second in all.
template <typename F>
Time TimeOf(F&& work)
{
  work(); // shaders are compiled, textures allocated
  glFinish();
  DeviceTimer timer;
  std::vector<double> elapsed, device;
  for (double total = 0.0; elapsed.empty() || (elapsed.size() < 9 && total < 1.0);
       total += elapsed.back())
  {
    const measuring::Stopwatch stopwatch;
    work();
    glFinish();
    elapsed.push_back(stopwatch.Read().Elapsed);
    if (timer.IsAvailable())
    {
      timer.Start(elapsed.back());
      work();
    }
    device.push_back(timer.Stop());
  }
  return { measuring::Median(elapsed), measuring::Median(device) };
}

void Allocate(
  vtkOpenGLRenderWindow* window, vtkTextureObject* texture, int width, int height, int components)
{
  texture->SetContext(window);
  texture->SetMinificationFilter(vtkTextureObject::Nearest);
  texture->SetMagnificationFilter(vtkTextureObject::Nearest);
  texture->Allocate2D(width, height, components, VTK_FLOAT);
}

/// A fragment shader that fills textures.
class Pass
{
public:
  Pass(vtkOpenGLRenderWindow* window, const std::string& source)
    : Window(window)
    , Source(source)
  {}
  ~Pass() { this->NoAttributes->ReleaseGraphicsResources(); }

  template <typename F>
  void Run(const std::vector<vtkTextureObject*>& targets, F&& setUniforms)
  {
    vtkOpenGLState* state = this->Window->GetState();
    state->PushFramebufferBindings();
    vtkNew<vtkOpenGLFramebufferObject> buffer;
    buffer->SetContext(this->Window);
    buffer->Bind();
    for (unsigned int k = 0; k < targets.size(); ++k)
    {
      buffer->AddColorAttachment(k, targets[k]);
    }
    buffer->ActivateDrawBuffers(static_cast<unsigned int>(targets.size()));
    state->vtkglViewport(0, 0, targets[0]->GetWidth(), targets[0]->GetHeight());
    state->vtkglDisable(GL_DEPTH_TEST);
    state->vtkglDisable(GL_BLEND);
    state->vtkglDisable(GL_SCISSOR_TEST);
    vtkShaderProgram* program = this->Window->GetShaderCache()->ReadyShaderProgram(
      "//VTK::System::Dec\n"
      "void main()\n"
      "{\n"
      "  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);\n"
      "  gl_Position = vec4(2.0 * corner - 1.0, 0.0, 1.0);\n"
      "}\n",
      this->Source.c_str(), "");
    if (!program)
    {
      throw std::runtime_error("a shader does not compile");
    }
    setUniforms(program);
    this->NoAttributes->Bind();
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    this->NoAttributes->Release();
    state->PopFramebufferBindings();
    buffer->ReleaseGraphicsResources(this->Window);
  }

private:
  vtkOpenGLRenderWindow* Window;
  std::string Source;
  vtkNew<vtkOpenGLVertexArrayObject> NoAttributes;
};

std::string ReadShader(int degree, const std::string& defines)
{
  std::ifstream file(NURBS_BENCHMARKS "/basisFunctions.glsl");
  std::stringstream text;
  text << file.rdbuf();
  std::string source = text.str();
  vtkShaderProgram::Substitute(source, "//VTK::System::Dec",
    "//VTK::System::Dec\n#define DEGREE " + std::to_string(degree) + "\n" + defines);
  return source;
}

void SetTexture(vtkShaderProgram* program, const char* name, vtkTextureObject* texture)
{
  texture->Activate();
  program->SetUniformi(name, texture->GetTextureUnit());
}

/// What a method took for one surface.
struct Result
{
  Time Taken;
  double Vertices = 0.0, Bytes = 0.0;
};

nlohmann::json ToJson(const Result& r)
{
  return { { "seconds", r.Taken.Elapsed }, { "device", r.Taken.Device }, { "vertices", r.Vertices },
    { "bytes", r.Bytes } };
}

/// vtkNURBSTileTextures, control points sent each time: about `side` x `side` vertices, a power of
/// two of cells a span.
Result DeBoor(vtkOpenGLRenderWindow* window, nurbs::SurfaceTable& table, int side)
{
  const nurbs::TableSurface& s = table[0];
  const int spans = int(s.Spans[0].size());
  nurbs::Tile tile;
  tile.Log[0] = tile.Log[1] = std::max(0, int(std::round(std::log2(double(side) / spans))));
  const int tiles = 1 << (tile.Log[0] - tile.CellsLog(0));
  std::vector<nurbs::Tile> all;
  for (int y = 0; y < spans * tiles; ++y)
  {
    for (int x = 0; x < spans * tiles; ++x)
    {
      tile.Span[0] = x / tiles;
      tile.Span[1] = y / tiles;
      tile.First[0] = x % tiles << tile.CellsLog(0);
      tile.First[1] = y % tiles << tile.CellsLog(1);
      all.push_back(tile);
    }
  }
  vtkNURBSTileTextures textures;
  textures.SetTable(table, std::vector<vtkNURBSTileTextures::SurfaceInfo>(1));
  Result result;
  result.Taken = TimeOf([&] {
    textures.MoveSurfaces(table, { 0 });
    if (!textures.Prepare(window, table, all))
    {
      throw std::runtime_error(textures.GetError());
    }
  });
  const double samples = (1 << tile.CellsLog(0)) + 1;
  result.Vertices = double(all.size()) * samples * samples;
  result.Bytes = 32.0 * (result.Vertices + double(all.size()) * samples * (s.View.Degree[1] + 1));
  textures.Release(window);
  return result;
}

/// Basis functions, of the whole net or those that do not vanish.
class BasisFunctions
{
public:
  BasisFunctions(
    vtkOpenGLRenderWindow* window, const nurbs::SurfaceTable& table, int side, bool local)
    : Window(window)
    , Table(table)
    , Surface(table[0].View)
    , Degree(Surface.Degree[0])
    , Side(side)
    , Functions(local ? Degree + 1 : Surface.Count[0] + Degree)
    , BasisPass(window,
        ReadShader(this->Degree, std::string("#define BASIS\n") + (local ? "#define LOCAL\n" : "")))
    , SumPass(window, ReadShader(this->Degree, local ? "#define LOCAL\n" : ""))
  {
    std::vector<int> spans;
    const nurbs::Interval domain = this->Surface.Domain(0);
    for (int k = 0; k < side; ++k)
    {
      const double u = domain.Min + domain.Length() * k / (side - 1);
      spans.insert(
        spans.end(), { nurbs::FindSpan(this->Surface.Knots[0], this->Degree, u), 0, 0, 0 });
    }
    const nurbs::KnotView& view = this->Surface.Knots[0];
    const std::vector<float> knots(view.begin(), view.end());
    this->Spans.Upload(spans.data(), 4 * spans.size());
    this->Knots.Upload(knots.data(), 4 * knots.size());
    for (auto& basis : this->Basis)
    {
      for (vtkTextureObject* texture : { basis[0].Get(), basis[1].Get() })
      {
        Allocate(window, texture, this->Functions, side, 2);
      }
    }
    Allocate(window, this->Positions, side, side, 4);
    Allocate(window, this->Normals, side, side, 4);
  }
  ~BasisFunctions()
  {
    for (vtkTextureObject* texture :
      { this->Basis[0][0].Get(), this->Basis[0][1].Get(), this->Basis[1][0].Get(),
        this->Basis[1][1].Get(), this->Positions.Get(), this->Normals.Get() })
    {
      texture->ReleaseGraphicsResources(this->Window);
    }
    for (vtkNURBSBufferTexture* buffer : { &this->Spans, &this->Knots, &this->Points })
    {
      buffer->Release();
    }
  }

  Result Measure()
  {
    Result result;
    result.Taken = TimeOf([this] { this->Run(); });
    result.Vertices = double(this->Side) * this->Side;
    result.Bytes =
      32.0 * result.Vertices + 2.0 * (this->Degree + 1) * 8.0 * this->Functions * this->Side;
    return result;
  }

  /// The largest distance from the surface, of some vertices, over its size.
  double Error()
  {
    std::vector<float> texels(std::size_t(4) * this->Side * this->Side);
    glBindTexture(GL_TEXTURE_2D, this->Positions->GetHandle());
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_FLOAT, texels.data());
    glBindTexture(GL_TEXTURE_2D, 0);
    double worst = 0.0;
    for (int k = 0; k < 1000; ++k)
    {
      const int x = k * 31 % this->Side, y = k * 17 % this->Side;
      const float* p = texels.data() + 4 * (x + std::size_t(y) * this->Side);
      const nurbs::Interval domain = this->Surface.Domain(0);
      const double u = domain.Min + domain.Length() * x / (this->Side - 1);
      const double v = domain.Min + domain.Length() * y / (this->Side - 1);
      const nurbs::Vec3 exact = nurbs::Evaluate(this->Surface, u, v);
      worst =
        std::max(worst, (nurbs::Vec3(p[0], p[1], p[2]) + this->Table[0].Origin - exact).norm());
    }
    return worst / (2.0 * this->Table[0].Radius);
  }

private:
  void Run()
  {
    this->Points.Upload(this->Table.GetPoints().data(), 4 * this->Table.GetPoints().size());
    const nurbs::Interval domain = this->Surface.Domain(0);
    const float interval[2] = { float(domain.Min), float(domain.Length()) };
    for (auto& basis : this->Basis) // u and v have the same knots and samples; both are computed
    {
      for (int degree = 0; degree <= this->Degree; ++degree)
      {
        this->BasisPass.Run({ basis[degree % 2] }, [&](vtkShaderProgram* program) {
          SetTexture(program, "lower", basis[1 - degree % 2]);
          program->SetUniformi("knots", this->Knots.Activate(this->Window));
          program->SetUniformi("spans", this->Spans.Activate(this->Window));
          program->SetUniformi("degree", degree);
          program->SetUniformi("functions", this->Functions);
          program->SetUniformi("samples", this->Side);
          program->SetUniform2f("domain", interval);
        });
        basis[1 - degree % 2]->Deactivate();
      }
    }
    this->SumPass.Run({ this->Positions, this->Normals }, [&](vtkShaderProgram* program) {
      SetTexture(program, "basisU", this->Basis[0][this->Degree % 2]);
      SetTexture(program, "basisV", this->Basis[1][this->Degree % 2]);
      const auto set = [&](const char* name, int value) {
        if (program->IsUniformUsed(name))
        {
          program->SetUniformi(name, value);
        }
      };
      set("points", this->Points.Activate(this->Window));
      set("spansU", this->Spans.Activate(this->Window));
      set("spansV", this->Spans.Activate(this->Window));
      set("countU", this->Surface.Count[0]);
      set("countV", this->Surface.Count[1]);
    });
    this->Basis[0][this->Degree % 2]->Deactivate();
    this->Basis[1][this->Degree % 2]->Deactivate();
    for (vtkNURBSBufferTexture* buffer : { &this->Spans, &this->Knots, &this->Points })
    {
      buffer->Deactivate(this->Window);
    }
  }

  vtkOpenGLRenderWindow* Window;
  const nurbs::SurfaceTable& Table;
  const nurbs::SurfaceView& Surface;
  int Degree;
  int Side;
  int Functions; ///< Columns of the textures of basis functions.
  Pass BasisPass, SumPass;
  vtkNURBSBufferTexture Spans{ vtkNURBSBufferTexture::INTEGER4 };
  vtkNURBSBufferTexture Knots{ vtkNURBSBufferTexture::FLOAT };
  vtkNURBSBufferTexture Points{ vtkNURBSBufferTexture::FLOAT4 };
  vtkNew<vtkTextureObject> Basis[2][2]; ///< Directions; degrees alternate.
  vtkNew<vtkTextureObject> Positions, Normals;
};

/// Bytes a second that the device writes when it copies two textures of 2048^2 RGBA32F.
double CopyBandwidth(vtkOpenGLRenderWindow* window)
{
  constexpr int Side = 2048;
  vtkNew<vtkTextureObject> textures[4];
  for (auto& texture : textures)
  {
    Allocate(window, texture, Side, Side, 4);
  }
  Pass copy(window, R"(//VTK::System::Dec
    //VTK::Output::Dec
    uniform sampler2D a;
    uniform sampler2D b;
    void main()
    {
      gl_FragData[0] = texelFetch(a, ivec2(gl_FragCoord.xy), 0);
      gl_FragData[1] = texelFetch(b, ivec2(gl_FragCoord.xy), 0);
    })");
  const Time taken = TimeOf([&] {
    copy.Run({ textures[2], textures[3] }, [&](vtkShaderProgram* program) {
      SetTexture(program, "a", textures[0]);
      SetTexture(program, "b", textures[1]);
    });
  });
  for (auto& texture : textures)
  {
    texture->ReleaseGraphicsResources(window);
  }
  return 32.0 * Side * Side / (taken.Device > 0.0 ? taken.Device : taken.Elapsed);
}

/// Bytes a second that one thread writes when it copies memory.
double MemoryBandwidth()
{
  std::vector<char> from(std::size_t(256) << 20, 1), to(from.size());
  const auto copy = [&] { std::memcpy(to.data(), from.data(), from.size()); };
  return double(from.size()) / measuring::MedianTime(5, copy).Elapsed;
}

struct Arguments
{
  int Degree = 3;
  std::vector<int> Nets{ 16, 64, 256 }, Outputs{ 128, 256, 512, 1024, 2048, 4096 };
  double Limit = 5.0;
  int Device = -1;
};

nlohmann::json Run(const Arguments& a)
{
  auto window =
    vtkSmartPointer<vtkNURBSEGLRenderWindow>::Take(vtkNURBSEGLRenderWindow::Create(8, 8));
  if (!window)
  {
    throw std::runtime_error("there is no OpenGL");
  }
  if (a.Device >= 0)
  {
    window->SetDeviceIndex(a.Device);
  }
  window->AddRenderer(vtkNew<vtkRenderer>());
  window->Render();
  window->MakeCurrent();
  nlohmann::json result;
  result["renderer"] = window->GetRendererName();
  result["copy"] = CopyBandwidth(window);
  result["memory_copy"] = MemoryBandwidth();
  result["rows"] = nlohmann::json::array();
  for (const int net : a.Nets)
  {
    const nurbs::Surface sheet = Sheet(a.Degree, net);
    nurbs::SurfaceTable table;
    table.Add(sheet.View(), nurbs::Box2(nurbs::Vec2(0.0, 0.0), nurbs::Vec2(1.0, 1.0)));
    table.Fill(0, 1);
    double last[2] = { 0.0, 0.0 }; // of the rivals, to tell what would take too long
    for (const int side : a.Outputs)
    {
      nlohmann::json row = { { "degree", a.Degree }, { "net", net }, { "output", side } };
      row["de_boor"] = ToJson(DeBoor(window, table, side));
      for (const bool local : { false, true })
      {
        if (4.0 * last[local] < a.Limit)
        {
          BasisFunctions basis(window, table, side, local);
          const Result measured = basis.Measure();
          last[local] = measured.Taken.Elapsed;
          nlohmann::json& entry = row[local ? "basis_local" : "basis"];
          entry = ToJson(measured);
          entry["error"] = basis.Error();
        }
      }
      result["rows"].push_back(row);
    }
  }
  return result;
}

} // namespace

int main(int argc, char** argv)
{
  Arguments arguments;
  CLI::App app{
    "Times evaluation of rational surfaces by shaders, positions and normals, and prints\n"
    "JSON: de_boor is vtkNURBSTileTextures, basis multiplies basis functions with the whole net, \n"
    "basis_local with the control points that count. Control points are sent each time."
  };
  app.add_option("--degree", arguments.Degree, "In both directions")->capture_default_str();
  app.add_option("--nets", arguments.Nets, "Control points a side");
  app.add_option("--outputs", arguments.Outputs, "Vertices a side, ascending");
  app.add_option("--limit", arguments.Limit, "Seconds over which a run of a rival is left out");
  app.add_option("--device", arguments.Device, "EGL device; -1: the first that works");
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
