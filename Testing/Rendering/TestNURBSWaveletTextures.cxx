// SPDX-License-Identifier: BSD-3-Clause
// Wavelet transforms in textures against those of the CPU: levels down and up again, many grids of
// different sizes at once, and what is not theirs left alone.
#include "vtkNURBSEGLRenderWindow.h"
#include "vtkNURBSWaveletTextures.h"
#include "vtkNew.h"
#include "vtkOpenGLState.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"
#include "vtkTextureObject.h"
#include "vtk_glew.h"

#include <gtest/gtest.h>

#include <random>

namespace
{

using nurbs::GridStep;
using nurbs::Wavelet;
using Rectangle = vtkNURBSWaveletTextures::Rectangle;
using Values = std::vector<float>;

constexpr Wavelet All[] = { Wavelet::Haar, Wavelet::Interpolating, Wavelet::Lifted };

class NURBSWaveletTextures : public testing::Test
{
protected:
  void SetUp() override
  {
    this->Window =
      vtkSmartPointer<vtkNURBSEGLRenderWindow>::Take(vtkNURBSEGLRenderWindow::Create(16, 16));
    ASSERT_NE(this->Window, nullptr);
    vtkNew<vtkRenderer> renderer;
    this->Window->AddRenderer(renderer);
    this->Window->Render();
    ASSERT_EQ(this->Window->GetErrorMessage(), "");
    this->Window->MakeCurrent();
  }
  void TearDown() override
  {
    if (this->Window)
    {
      this->Transform.Release(this->Window);
      this->Texture->ReleaseGraphicsResources(this->Window);
    }
  }

  void Send(int width, int height, Values& values)
  {
    this->Texture->SetContext(this->Window);
    this->Texture->SetMinificationFilter(vtkTextureObject::Nearest);
    this->Texture->SetMagnificationFilter(vtkTextureObject::Nearest);
    ASSERT_TRUE(this->Texture->Create2DFromRaw(width, height, 4, VTK_FLOAT, values.data()));
  }

  Values Get()
  {
    Values values(std::size_t(4) * this->Texture->GetWidth() * this->Texture->GetHeight());
    this->Texture->Activate();
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_FLOAT, values.data());
    this->Texture->Deactivate();
    EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
    return values;
  }

  vtkSmartPointer<vtkNURBSEGLRenderWindow> Window;
  vtkNURBSWaveletTextures Transform;
  vtkNew<vtkTextureObject> Texture;
};

Values RandomValues(std::size_t count)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<float> value(-1.0f, 1.0f);
  Values out(count);
  for (float& x : out)
  {
    x = value(random);
  }
  return out;
}

float Largest(const Values& a, const Values& b)
{
  float largest = 0.0f;
  for (std::size_t k = 0; k < a.size(); ++k)
  {
    largest = std::max(largest, std::abs(a[k] - b[k]));
  }
  return largest;
}

// Grids in a row of shelves, each with its own number of intervals.
std::vector<Rectangle> Shelves(Wavelet kind, int width, int& height)
{
  const int sizes[][2] = { { 8, 8 }, { 64, 32 }, { 4, 16 }, { 2, 2 }, { 24, 40 }, { 96, 8 },
    { 16, 1 }, { 1, 16 }, { 6, 10 }, { 32, 32 } };
  std::vector<Rectangle> out;
  int x = 3, y = 2, shelf = 0;
  for (int round = 0; round < 12; ++round)
  {
    for (const auto& size : sizes)
    {
      Rectangle r;
      r.Step.Kind = kind;
      r.Step.Intervals[0] = size[0];
      r.Step.Intervals[1] = size[1];
      if (x + r.Step.FineSamples(0) > width)
      {
        x = round % 4;
        y += shelf + 1;
        shelf = 0;
      }
      r.X = x;
      r.Y = y;
      x += r.Step.FineSamples(0) + 1;
      shelf = std::max(shelf, r.Step.FineSamples(1));
      out.push_back(r);
    }
  }
  height = y + shelf + 1;
  return out;
}

// The next coarser step of a grid; false if it can't be halved.
bool Halve(GridStep& step)
{
  for (int d = 0; d < 2; ++d)
  {
    step.Halved[d] = step.Intervals[d] % 2 == 0;
  }
  return step.Halved[0] || step.Halved[1];
}

TEST_F(NURBSWaveletTextures, AreTheTransformsOfTheCPU)
{
  for (const Wavelet kind : All)
  {
    constexpr int width = 300;
    int height = 0;
    std::vector<Rectangle> grids = Shelves(kind, width, height);
    const Values before = RandomValues(std::size_t(4) * width * height);
    Values sent = before;
    this->Send(width, height, sent);
    Values expected = before;
    std::vector<std::vector<Rectangle>> steps;
    for (int level = 0; level < 5; ++level)
    {
      std::vector<Rectangle> step;
      for (Rectangle& r : grids)
      {
        if (Halve(r.Step))
        {
          step.push_back(r);
          nurbs::AnalyseGrid<float, 4>(
            r.Step, expected.data() + 4 * (r.X + std::size_t(r.Y) * width), width);
          for (int d = 0; d < 2; ++d)
          {
            r.Step.Intervals[d] = r.Step.CoarseIntervals(d);
          }
        }
      }
      ASSERT_FALSE(step.empty());
      ASSERT_TRUE(this->Transform.Analyse(this->Window, this->Texture, kind, step))
        << this->Transform.GetError();
      // All texels: also those between the grids and the details of finer levels.
      EXPECT_LT(Largest(this->Get(), expected), 5e-7f) << int(kind) << " level " << level;
      steps.push_back(step);
    }
    for (; !steps.empty(); steps.pop_back())
    {
      ASSERT_TRUE(this->Transform.Synthesise(this->Window, this->Texture, kind, steps.back()))
        << this->Transform.GetError();
    }
    EXPECT_LT(Largest(this->Get(), before), 2e-6f) << int(kind);
  }
}

TEST_F(NURBSWaveletTextures, SynthesisIsTheCPUs)
{
  for (const Wavelet kind : All)
  {
    Rectangle r;
    r.Step.Kind = kind;
    r.Step.Intervals[0] = 200;
    r.Step.Intervals[1] = 120;
    r.Step.Halved[0] = r.Step.Halved[1] = true;
    const int width = r.Step.FineSamples(0);
    const int height = r.Step.FineSamples(1);
    Values values = RandomValues(std::size_t(4) * width * height);
    this->Send(width, height, values);
    Values coarse;
    for (int j = 0; j < r.Step.CoarseSamples(1); ++j)
    {
      const auto row = values.begin() + std::ptrdiff_t(4) * j * width;
      coarse.insert(coarse.end(), row, row + std::ptrdiff_t(4) * r.Step.CoarseSamples(0));
    }
    Values expected(values.size());
    nurbs::SynthesiseGrid<float, 4>(r.Step, coarse.data(), values.data(), width, expected.data());
    ASSERT_TRUE(this->Transform.Synthesise(this->Window, this->Texture, kind, { r }));
    EXPECT_LT(Largest(this->Get(), expected), 1e-6f) << int(kind);
  }
}

TEST_F(NURBSWaveletTextures, SaysWhatIsWrongAndLeavesTheTextureAlone)
{
  Values values = RandomValues(4 * 20 * 20);
  this->Send(20, 20, values);
  Rectangle r;
  r.Step.Intervals[0] = r.Step.Intervals[1] = 16;
  r.Step.Halved[0] = r.Step.Halved[1] = true;
  r.X = 4;
  EXPECT_FALSE(this->Transform.Analyse(this->Window, this->Texture, Wavelet::Interpolating, { r }));
  EXPECT_NE(this->Transform.GetError().find("leaves its texture"), std::string::npos);
  r.X = 3;
  r.Step.Intervals[1] = 15;
  EXPECT_FALSE(
    this->Transform.Synthesise(this->Window, this->Texture, Wavelet::Interpolating, { r }));
  EXPECT_NE(this->Transform.GetError().find("15 intervals"), std::string::npos);
  EXPECT_EQ(this->Get(), values);
  EXPECT_TRUE(this->Transform.Analyse(this->Window, this->Texture, Wavelet::Haar, {}));
  r.Step.Intervals[1] = 16;
  EXPECT_TRUE(this->Transform.Analyse(this->Window, this->Texture, Wavelet::Interpolating, { r }));
  EXPECT_EQ(this->Transform.GetError(), "");
}

// What was there before is there afterwards: a renderer's state is not disturbed.
TEST_F(NURBSWaveletTextures, StateIsRestored)
{
  Values values = RandomValues(4 * 17 * 17);
  this->Send(17, 17, values);
  GLint viewport[4], framebuffer = -1;
  this->Window->GetState()->vtkglEnable(GL_DEPTH_TEST);
  this->Window->GetState()->vtkglEnable(GL_BLEND);
  glGetIntegerv(GL_VIEWPORT, viewport);
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer);
  Rectangle r;
  r.Step.Intervals[0] = r.Step.Intervals[1] = 16;
  r.Step.Halved[0] = r.Step.Halved[1] = true;
  ASSERT_TRUE(this->Transform.Analyse(this->Window, this->Texture, Wavelet::Lifted, { r }));
  GLint after[4], bound = -1;
  glGetIntegerv(GL_VIEWPORT, after);
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
  EXPECT_TRUE(std::equal(viewport, viewport + 4, after));
  EXPECT_EQ(bound, framebuffer);
  EXPECT_TRUE(glIsEnabled(GL_DEPTH_TEST));
  EXPECT_TRUE(glIsEnabled(GL_BLEND));
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

} // namespace
