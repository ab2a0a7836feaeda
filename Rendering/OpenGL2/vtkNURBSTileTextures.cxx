// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSTileTextures.h"

#include "vtkNURBSPassState.h"
#include "vtkOpenGLFramebufferObject.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLShaderCache.h"
#include "vtkOpenGLState.h"
#include "vtkOpenGLVertexArrayObject.h"
#include "vtkShaderProgram.h"
#include "vtkTextureObject.h"
#include "vtk_glew.h"

#include "nurbsEvaluateFS.h"
#include "nurbsEvaluateVS.h"
#include "nurbsTile.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace
{

constexpr int RowsSize[2] = { 1024, 1024 };
// Texels of the atlas at most: 32 bytes each in its two textures, 1 GiB in all.
constexpr std::int64_t MaxAtlasTexels = std::int64_t(1) << 25;

std::array<int, 4> Encode(const nurbs::Tile& tile, const nurbs::TileAtlas::Slot& slot)
{
  const auto pack = [](unsigned low, unsigned high) { return static_cast<int>(low | high << 16); };
  return { pack(slot.X, slot.Y),
    static_cast<int>(
      unsigned(tile.Surface) | unsigned(tile.Log[0]) << 24 | unsigned(tile.Log[1]) << 28),
    pack(tile.Span[0], tile.Span[1]), pack(tile.First[0], tile.First[1]) };
}

void AppendOrigin(std::vector<float>& origins, const nurbs::TableSurface& surface, double tolerance)
{
  const nurbs::Vec3& origin = surface.Origin;
  const Eigen::Vector3f high = origin.cast<float>();
  const Eigen::Vector3f low = (origin - high.cast<double>()).cast<float>();
  origins.insert(origins.end(),
    { high[0], high[1], high[2], float(tolerance), low[0], low[1], low[2], float(surface.Radius) });
}

} // namespace

vtkNURBSTileTextures::vtkNURBSTileTextures() = default;
vtkNURBSTileTextures::~vtkNURBSTileTextures() = default;

std::string vtkNURBSTileTextures::GetMissingFeature(vtkOpenGLRenderWindow* window)
{
  int major = 0, minor = 0;
  window->GetOpenGLVersion(major, minor);
  if (major * 10 + minor < 32)
  {
    return "OpenGL 3.2 is needed, and this device has " + std::to_string(major) + "." +
      std::to_string(minor);
  }
  GLint units = 0;
  glGetIntegerv(GL_MAX_VERTEX_TEXTURE_IMAGE_UNITS, &units);
  if (units < 8)
  {
    return "eight textures are needed in the vertex stage, and this device has " +
      std::to_string(units);
  }
  return "";
}

bool vtkNURBSTileTextures::Send(
  vtkNURBSBufferTexture& buffer, const void* data, std::size_t bytes, const char* what)
{
  if (!buffer.Upload(data, bytes))
  {
    this->Error = std::string("the device can't hold this model's ") + what;
    return false;
  }
  return true;
}

bool vtkNURBSTileTextures::SetTable(
  const nurbs::SurfaceTable& table, const std::vector<SurfaceInfo>& infos)
{
  const std::vector<float>& points = table.GetPoints();
  const std::vector<float>& knots = table.GetKnots();
  this->Atlas.Clear();
  this->Error.clear();
  return this->Send(this->Points, points.data(), sizeof(float) * points.size(), "control points") &&
    this->Send(this->Knots, knots.data(), sizeof(float) * knots.size(), "knots") &&
    this->SetInfos(table, infos);
}

bool vtkNURBSTileTextures::SetInfos(
  const nurbs::SurfaceTable& table, const std::vector<SurfaceInfo>& infos)
{
  std::vector<int> surfaces;
  std::vector<float> origins;
  for (int i = 0; i < table.Size(); ++i)
  {
    const nurbs::TableSurface& s = table[i];
    surfaces.insert(surfaces.end(),
      { s.FirstPoint, s.View.Count[0],
        s.View.Degree[0] | s.View.Degree[1] << 8 | (infos[i].Reversed ? 1 << 16 : 0), 0,
        s.FirstBlock[0], s.FirstBlock[1], infos[i].Trim, 0 });
    AppendOrigin(origins, s, infos[i].Tolerance);
  }
  this->Infos = infos;
  return this->Send(this->Surfaces, surfaces.data(), sizeof(int) * surfaces.size(), "surfaces") &&
    this->Send(this->Origins, origins.data(), sizeof(float) * origins.size(), "surfaces");
}

void vtkNURBSTileTextures::MoveSurfaces(
  const nurbs::SurfaceTable& table, const std::vector<int>& surfaces)
{
  // Surfaces that follow each other in the table are sent together.
  for (std::size_t i = 0, end = 0; i < surfaces.size(); i = end)
  {
    std::vector<float> origins;
    std::size_t points = 0;
    for (end = i; end < surfaces.size() && surfaces[end] == surfaces[i] + int(end - i); ++end)
    {
      AppendOrigin(origins, table[surfaces[end]], this->Infos[surfaces[end]].Tolerance);
      points += table[surfaces[end]].View.Size();
      if (table[surfaces[end]].SidesChanged)
      {
        const nurbs::TableSurface& surface = table[surfaces[end]];
        for (int dir = 0; dir < 2; ++dir)
        {
          this->Knots.Replace(sizeof(float) * std::size_t(surface.FirstBlock[dir]),
            table.GetKnots().data() + surface.FirstBlock[dir],
            sizeof(float) * surface.Spans[dir].size() * surface.BlockSize(dir));
        }
      }
    }
    const std::size_t first = table[surfaces[i]].FirstPoint;
    this->Points.Replace(16 * first, table.GetPoints().data() + 4 * first, 16 * points);
    this->Origins.Replace(32 * std::size_t(surfaces[i]), origins.data(), 4 * origins.size());
  }
  this->Atlas.Forget(surfaces);
}

bool vtkNURBSTileTextures::Prepare(vtkOpenGLRenderWindow* window, const nurbs::SurfaceTable& table,
  const std::vector<nurbs::Tile>& tiles)
{
  this->Error.clear();
  std::vector<nurbs::Tile> sorted(tiles.size());
  int count[nurbs::Tile::ShapeCount] = {};
  for (const nurbs::Tile& tile : tiles)
  {
    ++count[tile.Shape()];
  }
  for (int shape = 0; shape < nurbs::Tile::ShapeCount; ++shape)
  {
    this->First[shape + 1] = this->First[shape] + count[shape];
    count[shape] = this->First[shape];
  }
  for (const nurbs::Tile& tile : tiles)
  {
    sorted[count[tile.Shape()]++] = tile;
  }
  std::vector<Job> jobs;
  if (!this->PlaceTiles(window, sorted, table, jobs))
  {
    return false;
  }
  if (!this->Tiles.Upload(this->TileTexels.data(), 4 * this->TileTexels.size()))
  {
    this->Error = "the device can't hold a list of " + std::to_string(tiles.size()) + " tiles";
    return false;
  }
  if (!jobs.empty())
  {
    this->Evaluate(window, jobs);
  }
  return true;
}

// Finds a place for every tile, in a larger atlas if need be; those to evaluate become jobs.
bool vtkNURBSTileTextures::PlaceTiles(vtkOpenGLRenderWindow* window,
  const std::vector<nurbs::Tile>& sorted, const nurbs::SurfaceTable& table, std::vector<Job>& jobs)
{
  this->Atlas.BeginFrame();
  for (bool fits = false; !fits;)
  {
    fits = true;
    jobs.clear();
    jobs.reserve(sorted.size());
    this->TileTexels.clear();
    this->TileTexels.reserve(4 * sorted.size());
    for (std::size_t i = 0; i < sorted.size() && fits; ++i)
    {
      const nurbs::Tile& tile = sorted[i];
      nurbs::TileAtlas::Slot slot;
      bool isNew = false;
      fits = this->Atlas.Place(tile, slot, isNew);
      const std::array<int, 4> texel = Encode(tile, slot);
      this->TileTexels.insert(this->TileTexels.end(), texel.begin(), texel.end());
      if (fits && isNew)
      {
        const nurbs::SurfaceView& view = table[tile.Surface].View;
        jobs.push_back(
          { static_cast<int>(i), 0, 0, { (1 << tile.CellsLog(0)) + 1, (1 << tile.CellsLog(1)) + 1 },
            { view.Degree[0], view.Degree[1] } });
      }
    }
    if (!fits)
    {
      const std::int64_t needed = nurbs::TileAtlas::PagesFor(sorted) * 5 / 4 + 1;
      const int side = static_cast<int>(std::ceil(std::sqrt(double(needed))));
      const int most = vtkTextureObject::GetMaximumTextureSize(window) / nurbs::TileAtlas::PageSize;
      const std::int64_t texels =
        std::int64_t(side) * side * nurbs::TileAtlas::PageSize * nurbs::TileAtlas::PageSize;
      if (side > most || texels > MaxAtlasTexels)
      {
        this->Error = std::to_string(sorted.size()) + " tiles exceed the device's textures";
        this->Atlas.Clear(); // those placed just now are not evaluated
        return false;
      }
      this->MakeAtlas(window, side, side);
    }
  }
  return true;
}

void vtkNURBSTileTextures::MakeAtlas(vtkOpenGLRenderWindow* window, int pagesX, int pagesY)
{
  this->Atlas.Resize(pagesX, pagesY);
  const auto make = [&](vtkTextureObject* texture, int width, int height) {
    texture->ReleaseGraphicsResources(window);
    texture->SetContext(window);
    texture->SetMinificationFilter(vtkTextureObject::Nearest);
    texture->SetMagnificationFilter(vtkTextureObject::Nearest);
    texture->Allocate2D(width, height, 4, VTK_FLOAT);
  };
  this->AtlasBuffer->ReleaseGraphicsResources(window); // it would hold on to the old textures
  make(this->Positions, this->Atlas.Width(), this->Atlas.Height());
  make(this->Normals, this->Atlas.Width(), this->Atlas.Height());
  if (!this->Rows->GetHandle())
  {
    make(this->Rows, RowsSize[0], RowsSize[1]);
    make(this->RowDerivatives, RowsSize[0], RowsSize[1]);
  }
}

void vtkNURBSTileTextures::Evaluate(vtkOpenGLRenderWindow* window, std::vector<Job>& jobs)
{
  const vtkNURBSPassState pass(window->GetState());
  this->NoAttributes->Bind();
  // Rows of a batch lie side by side on shelves.
  std::size_t first = 0;
  int x = 0, y = 0, height = 0;
  for (std::size_t i = 0; i < jobs.size(); ++i)
  {
    Job& job = jobs[i];
    const int rows = job.Degree[1] + 1;
    if (x + job.Samples[0] > RowsSize[0])
    {
      x = 0;
      y += height;
      height = 0;
    }
    if (y + rows > RowsSize[1])
    {
      this->RunBatch(window, jobs, first, i);
      first = i;
      x = y = height = 0;
    }
    job.X = x;
    job.Y = y;
    x += job.Samples[0];
    height = std::max(height, rows);
    this->EvaluatedVertices += job.Samples[0] * job.Samples[1];
  }
  this->RunBatch(window, jobs, first, jobs.size());
  this->NoAttributes->Release();
}

void vtkNURBSTileTextures::RunBatch(
  vtkOpenGLRenderWindow* window, std::vector<Job>& jobs, std::size_t first, std::size_t last)
{
  for (int dir = 0; dir < 2; ++dir)
  {
    const auto byDegree = [dir](
                            const Job& a, const Job& b) { return a.Degree[dir] < b.Degree[dir]; };
    const auto begin = jobs.begin() + first, end = jobs.begin() + last;
    if (!std::is_sorted(begin, end, byDegree))
    {
      std::sort(begin, end, byDegree);
    }
    this->RunPass(window, &jobs[first], last - first, dir);
  }
}

void vtkNURBSTileTextures::RunPass(
  vtkOpenGLRenderWindow* window, const Job* jobs, std::size_t count, int dir)
{
  std::vector<int> texels;
  texels.reserve(4 * count);
  for (const Job* job = jobs; job != jobs + count; ++job)
  {
    texels.insert(texels.end(), { job->Tile, job->X, job->Y, 0 });
  }
  this->Jobs.Upload(texels.data(), 4 * texels.size());
  vtkOpenGLState* state = window->GetState();
  vtkOpenGLFramebufferObject* target = dir == 0 ? this->RowBuffer : this->AtlasBuffer;
  vtkTextureObject* textures[2] = { dir == 0 ? this->Rows : this->Positions,
    dir == 0 ? this->RowDerivatives : this->Normals };
  state->PushFramebufferBindings();
  target->SetContext(window);
  target->Bind();
  target->AddColorAttachment(0, textures[0]);
  target->AddColorAttachment(1, textures[1]);
  target->ActivateDrawBuffers(2);
  const int size[2] = { int(textures[0]->GetWidth()), int(textures[0]->GetHeight()) };
  state->vtkglViewport(0, 0, size[0], size[1]);
  for (std::size_t i = 0, end = 0; i < count; i = end)
  {
    while (end < count && jobs[end].Degree[dir] == jobs[i].Degree[dir])
    {
      ++end;
    }
    vtkShaderProgram* program = this->Program(window, dir, jobs[i].Degree[dir]);
    if (!program)
    {
      this->Error = "a shader of the evaluation does not compile";
      break;
    }
    program->SetUniformi("nurbsTiles", this->Tiles.Activate(window));
    program->SetUniformi("nurbsSurfaces", this->Surfaces.Activate(window));
    program->SetUniformi("nurbsKnots", this->Knots.Activate(window));
    program->SetUniformi("nurbsJobs", this->Jobs.Activate(window));
    program->SetUniformi("firstJob", static_cast<int>(i));
    const float targetSize[2] = { float(size[0]), float(size[1]) };
    program->SetUniform2f("targetSize", targetSize);
    if (dir == 0)
    {
      program->SetUniformi("nurbsPoints", this->Points.Activate(window));
    }
    else
    {
      this->Rows->Activate();
      this->RowDerivatives->Activate();
      program->SetUniformi("nurbsRows", this->Rows->GetTextureUnit());
      program->SetUniformi("nurbsRowDerivatives", this->RowDerivatives->GetTextureUnit());
    }
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(end - i));
  }
  for (vtkNURBSBufferTexture* buffer :
    { &this->Tiles, &this->Surfaces, &this->Knots, &this->Jobs, &this->Points })
  {
    buffer->Deactivate(window);
  }
  this->Rows->Deactivate();
  this->RowDerivatives->Deactivate();
  state->PopFramebufferBindings();
}

vtkShaderProgram* vtkNURBSTileTextures::Program(vtkOpenGLRenderWindow* window, int dir, int degree)
{
  std::string vertex = nurbsEvaluateVS, fragment = nurbsEvaluateFS;
  const std::string defines = "//VTK::System::Dec\n#define DEGREE " + std::to_string(degree) +
    "\n#define NURBS_MAX_LOG " + std::to_string(nurbs::Tile::MaxLog) +
    (dir == 0 ? "\n#define ALONG_U\n" : "\n");
  vtkShaderProgram::Substitute(vertex, "//VTK::System::Dec", defines);
  vtkShaderProgram::Substitute(vertex, "//NURBS::Tile::Dec", nurbsTile);
  vtkShaderProgram::Substitute(fragment, "//VTK::System::Dec", defines);
  return window->GetShaderCache()->ReadyShaderProgram(vertex.c_str(), fragment.c_str(), "");
}

void vtkNURBSTileTextures::Activate(vtkOpenGLRenderWindow* window, vtkShaderProgram* program)
{
  const auto set = [&](const char* name, vtkNURBSBufferTexture& buffer) {
    if (program->IsUniformUsed(name))
    {
      program->SetUniformi(name, buffer.Activate(window));
    }
  };
  set("nurbsTiles", this->Tiles);
  set("nurbsSurfaces", this->Surfaces);
  set("nurbsKnots", this->Knots);
  set("nurbsOrigins", this->Origins);
  set("nurbsPoints", this->Points);
  this->Positions->Activate();
  this->Normals->Activate();
  program->SetUniformi("nurbsPositions", this->Positions->GetTextureUnit());
  program->SetUniformi("nurbsNormals", this->Normals->GetTextureUnit());
}

void vtkNURBSTileTextures::Deactivate(vtkOpenGLRenderWindow* window)
{
  for (vtkNURBSBufferTexture* buffer :
    { &this->Tiles, &this->Surfaces, &this->Knots, &this->Origins, &this->Points })
  {
    buffer->Deactivate(window);
  }
  this->Positions->Deactivate();
  this->Normals->Deactivate();
}

void vtkNURBSTileTextures::Release(vtkOpenGLRenderWindow* window)
{
  for (vtkTextureObject* texture :
    { this->Positions.Get(), this->Normals.Get(), this->Rows.Get(), this->RowDerivatives.Get() })
  {
    texture->ReleaseGraphicsResources(window);
  }
  this->RowBuffer->ReleaseGraphicsResources(window);
  this->AtlasBuffer->ReleaseGraphicsResources(window);
  this->NoAttributes->ReleaseGraphicsResources();
  for (vtkNURBSBufferTexture* buffer :
    { &this->Points, &this->Knots, &this->Surfaces, &this->Origins, &this->Tiles, &this->Jobs })
  {
    buffer->Release();
  }
  this->Atlas.Resize(0, 0);
}

std::size_t vtkNURBSTileTextures::GetBytesSent() const
{
  return this->Points.GetBytesSent() + this->Knots.GetBytesSent() + this->Surfaces.GetBytesSent() +
    this->Origins.GetBytesSent() + this->Tiles.GetBytesSent() + this->Jobs.GetBytesSent();
}
