// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSWaveletTextures.h"

#include "vtkNURBSBufferTexture.h"
#include "vtkNURBSPassState.h"
#include "vtkNew.h"
#include "vtkOpenGLFramebufferObject.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLShaderCache.h"
#include "vtkOpenGLState.h"
#include "vtkOpenGLVertexArrayObject.h"
#include "vtkShaderProgram.h"
#include "vtkTextureObject.h"
#include "vtk_glew.h"

#include "nurbsWaveletAnalysis.h"
#include "nurbsWaveletLine.h"
#include "nurbsWaveletSynthesis.h"
#include "nurbsWaveletVertex.h"

struct vtkNURBSWaveletTextures::Internals
{
  vtkNew<vtkTextureObject> Between; // From one pass to the other.
  vtkNew<vtkOpenGLFramebufferObject> Buffer;
  vtkNew<vtkOpenGLVertexArrayObject> NoAttributes;
  vtkNURBSBufferTexture Rectangles{ vtkNURBSBufferTexture::INTEGER4 };
  std::string Error;

  bool Run(vtkOpenGLRenderWindow* window, vtkTextureObject* grids, nurbs::Wavelet kind,
    const std::vector<Rectangle>& rectangles, bool synthesis);
  bool Check(
    vtkTextureObject* grids, nurbs::Wavelet kind, const std::vector<Rectangle>& rectangles);
  bool Pass(vtkOpenGLRenderWindow* window, vtkTextureObject* from, vtkTextureObject* to,
    nurbs::Wavelet kind, int direction, bool synthesis, std::size_t count);
};

bool vtkNURBSWaveletTextures::Internals::Check(
  vtkTextureObject* grids, nurbs::Wavelet kind, const std::vector<Rectangle>& rectangles)
{
  for (const Rectangle& r : rectangles)
  {
    const int place[2] = { r.X, r.Y };
    const int size[2] = { int(grids->GetWidth()), int(grids->GetHeight()) };
    for (int d = 0; d < 2; ++d)
    {
      const int n = r.Step.Intervals[d];
      if (n < 1 || place[d] < 0 || place[d] + nurbs::LineSamples(kind, n) > size[d])
      {
        this->Error = "a grid leaves its texture";
        return false;
      }
      if (r.Step.Halved[d] && n % 2 == 1)
      {
        this->Error = "a grid of " + std::to_string(n) + " intervals can't be halved";
        return false;
      }
    }
  }
  return true;
}

bool vtkNURBSWaveletTextures::Internals::Run(vtkOpenGLRenderWindow* window, vtkTextureObject* grids,
  nurbs::Wavelet kind, const std::vector<Rectangle>& rectangles, bool synthesis)
{
  this->Error.clear();
  if (rectangles.empty() || !this->Check(grids, kind, rectangles))
  {
    return this->Error.empty();
  }
  std::vector<int> texels;
  texels.reserve(4 * rectangles.size());
  for (const Rectangle& r : rectangles)
  {
    const auto intervals = [&](int d) {
      return r.Step.Halved[d] ? r.Step.Intervals[d] : -r.Step.Intervals[d];
    };
    texels.insert(texels.end(), { r.X, r.Y, intervals(0), intervals(1) });
  }
  if (!this->Rectangles.Upload(texels.data(), texels.size() * sizeof(int)))
  {
    this->Error = "the device can't hold a list of " + std::to_string(rectangles.size()) + " grids";
    return false;
  }
  if (this->Between->GetWidth() != grids->GetWidth() ||
    this->Between->GetHeight() != grids->GetHeight() || !this->Between->GetHandle())
  {
    this->Between->ReleaseGraphicsResources(window);
    this->Between->SetContext(window);
    this->Between->SetMinificationFilter(vtkTextureObject::Nearest);
    this->Between->SetMagnificationFilter(vtkTextureObject::Nearest);
    this->Between->Allocate2D(grids->GetWidth(), grids->GetHeight(), 4, VTK_FLOAT);
  }
  vtkOpenGLState* state = window->GetState();
  const vtkNURBSPassState pass(state);
  state->PushFramebufferBindings();
  this->NoAttributes->Bind();
  // Analysis takes rows, then columns; synthesis goes back.
  const int first = synthesis ? 1 : 0;
  const std::size_t count = rectangles.size();
  const bool done = this->Pass(window, grids, this->Between, kind, first, synthesis, count) &&
    this->Pass(window, this->Between, grids, kind, 1 - first, synthesis, count);
  this->NoAttributes->Release();
  this->Rectangles.Deactivate(window);
  state->PopFramebufferBindings();
  return done;
}

bool vtkNURBSWaveletTextures::Internals::Pass(vtkOpenGLRenderWindow* window, vtkTextureObject* from,
  vtkTextureObject* to, nurbs::Wavelet kind, int direction, bool synthesis, std::size_t count)
{
  std::string vertex = nurbsWaveletVertex;
  std::string fragment = synthesis ? nurbsWaveletSynthesis : nurbsWaveletAnalysis;
  const std::string defines = "//VTK::System::Dec\n#define DIRECTION " + std::to_string(direction) +
    "\n#define WAVELET " + std::to_string(int(kind)) + "\n";
  vtkShaderProgram::Substitute(fragment, "//NURBS::WaveletLine::Dec", nurbsWaveletLine);
  vtkShaderProgram::Substitute(fragment, "//VTK::System::Dec", defines);
  vtkShaderProgram* program =
    window->GetShaderCache()->ReadyShaderProgram(vertex.c_str(), fragment.c_str(), "");
  if (!program)
  {
    this->Error = "a shader of the wavelet transform does not compile";
    return false;
  }
  this->Buffer->SetContext(window);
  this->Buffer->Bind();
  this->Buffer->AddColorAttachment(0, to);
  this->Buffer->ActivateDrawBuffers(1);
  const float size[2] = { float(to->GetWidth()), float(to->GetHeight()) };
  window->GetState()->vtkglViewport(0, 0, int(to->GetWidth()), int(to->GetHeight()));
  from->Activate();
  program->SetUniformi("nurbsGrids", from->GetTextureUnit());
  program->SetUniformi("nurbsRectangles", this->Rectangles.Activate(window));
  program->SetUniformi("endSamples", kind == nurbs::Wavelet::Haar ? 2 : 1);
  program->SetUniform2f("targetSize", size);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(count));
  from->Deactivate();
  return true;
}

vtkNURBSWaveletTextures::vtkNURBSWaveletTextures()
  : Data(std::make_unique<Internals>())
{}

vtkNURBSWaveletTextures::~vtkNURBSWaveletTextures() = default;

bool vtkNURBSWaveletTextures::Analyse(vtkOpenGLRenderWindow* window, vtkTextureObject* grids,
  nurbs::Wavelet kind, const std::vector<Rectangle>& rectangles)
{
  return this->Data->Run(window, grids, kind, rectangles, false);
}

bool vtkNURBSWaveletTextures::Synthesise(vtkOpenGLRenderWindow* window, vtkTextureObject* grids,
  nurbs::Wavelet kind, const std::vector<Rectangle>& rectangles)
{
  return this->Data->Run(window, grids, kind, rectangles, true);
}

void vtkNURBSWaveletTextures::Release(vtkOpenGLRenderWindow* window)
{
  this->Data->Between->ReleaseGraphicsResources(window);
  this->Data->Buffer->ReleaseGraphicsResources(window);
  this->Data->NoAttributes->ReleaseGraphicsResources();
  this->Data->Rectangles.Release();
}

const std::string& vtkNURBSWaveletTextures::GetError() const
{
  return this->Data->Error;
}
