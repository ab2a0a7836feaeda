// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSEGLRenderWindow.h"

#include "vtkActor.h"
#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkFloatArray.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPlaneSource.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkSphereSource.h"
#include "vtkTestImage.h"
#include "vtkUnsignedCharArray.h"
#include "vtk_glew.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

namespace
{

using Window = vtkSmartPointer<vtkNURBSEGLRenderWindow>;
using vtkTestImage::Colour;

constexpr Colour Blue = { 26, 51, 102 }; // the background, 0.1 0.2 0.4

vtkSmartPointer<vtkRenderer> MakeRenderer(vtkAlgorithm* source)
{
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(source->GetOutputPort());
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  auto renderer = vtkSmartPointer<vtkRenderer>::New();
  renderer->AddActor(actor);
  renderer->SetBackground(Blue[0] / 255.0, Blue[1] / 255.0, Blue[2] / 255.0);
  vtkCamera* camera = renderer->GetActiveCamera();
  camera->ParallelProjectionOn();
  camera->SetParallelScale(1.0); // the picture's height is 2
  camera->SetPosition(0, 0, 6);
  camera->SetFocalPoint(0, 0, 0);
  camera->SetClippingRange(1, 11);
  return renderer;
}

// A sphere of radius 0.75 seen from z, its silhouette nearly a circle.
vtkSmartPointer<vtkRenderer> SphereScene()
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetRadius(0.75);
  sphere->SetThetaResolution(256);
  sphere->SetPhiResolution(256);
  return MakeRenderer(sphere);
}

// The square [-0.5, 0.5]^2 at height z in one flat colour.
vtkSmartPointer<vtkRenderer> SquareScene(double z, double red, double green, double blue)
{
  vtkNew<vtkPlaneSource> plane;
  plane->SetOrigin(-0.5, -0.5, z);
  plane->SetPoint1(0.5, -0.5, z);
  plane->SetPoint2(-0.5, 0.5, z);
  auto renderer = MakeRenderer(plane);
  vtkProperty* property = renderer->GetActors()->GetLastActor()->GetProperty();
  property->SetColor(red, green, blue);
  property->LightingOff();
  return renderer;
}

Window Create(int width, int height)
{
  return Window::Take(vtkNURBSEGLRenderWindow::Create(width, height));
}

Window MakeWindow(int width, int height, vtkRenderer* renderer)
{
  Window window = Create(width, height);
  if (window)
  {
    window->SetMultiSamples(0);
    window->AddRenderer(renderer);
  }
  return window;
}

long DiscPixels(double radius, int height)
{
  return std::lround(vtkMath::Pi() * radius * radius * height * height / 4.0);
}

long Entries(const char* folder)
{
  namespace fs = std::filesystem;
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

// Names in use in the current context, of the kinds that VTK makes.
struct Objects
{
  long Textures = 0, Buffers = 0, Framebuffers = 0, Programs = 0, VertexArrays = 0;
  static Objects Count()
  {
    Objects count;
    for (GLuint name = 1; name < 4096; ++name)
    {
      count.Textures += glIsTexture(name);
      count.Buffers += glIsBuffer(name);
      count.Framebuffers += glIsFramebuffer(name);
      count.Programs += glIsProgram(name);
      count.VertexArrays += glIsVertexArray(name);
    }
    return count;
  }
};

// Keeps the errors of a window instead of printing them.
class Errors
{
public:
  explicit Errors(vtkObject* object)
  {
    this->Command->SetClientData(this);
    this->Command->SetCallback([](vtkObject*, unsigned long, void* self, void* text) {
      static_cast<Errors*>(self)->Texts.emplace_back(static_cast<const char*>(text));
    });
    object->AddObserver(vtkCommand::ErrorEvent, this->Command);
  }
  std::vector<std::string> Texts;

private:
  vtkNew<vtkCallbackCommand> Command;
};

} // namespace

TEST(EGLRenderWindow, NamesWhatDraws)
{
  Window window = Create(64, 64);
  ASSERT_TRUE(window);
  EXPECT_FALSE(window->GetRendererName().empty());
  EXPECT_FALSE(window->GetVendorName().empty());
  int major = 0, minor = 0;
  window->GetOpenGLVersion(major, minor);
  EXPECT_GE(major * 10 + minor, 32);
  EXPECT_GE(window->GetMaximumSize(), 4096);
  EXPECT_EQ(window->GetErrorMessage(), "");
  EXPECT_EQ(window->SupportsOpenGL(), 1);
  EXPECT_EQ(window->GetNumberOfDevices(), vtkNURBSEGLRenderWindow::CountDevices());
  for (int i = 0; i < vtkNURBSEGLRenderWindow::CountDevices(); ++i)
  {
    EXPECT_FALSE(vtkNURBSEGLRenderWindow::GetDeviceName(i).empty());
  }
  EXPECT_EQ(vtkNURBSEGLRenderWindow::GetDeviceName(-1), "");
  EXPECT_NE(std::string(window->ReportCapabilities()).find("OpenGL version"), std::string::npos);
}

TEST(EGLRenderWindow, SphereCoversItsDisc)
{
  auto scene = SphereScene();
  Window window = MakeWindow(400, 300, scene);
  ASSERT_TRUE(window);
  auto image = vtkTestImage::Take(window);
  const double expected = static_cast<double>(DiscPixels(0.75, 300));
  EXPECT_NEAR(vtkTestImage::CountOthers(image, Blue), expected, 0.002 * expected);
  EXPECT_EQ(vtkTestImage::Pixel(image, 0, 0), Blue);
  EXPECT_EQ(vtkTestImage::Pixel(image, 399, 299), Blue);
  // Lit from the viewer, a white sphere is white in the middle and dark at its rim.
  EXPECT_GE(vtkTestImage::Pixel(image, 200, 150)[0], 254);
  EXPECT_LT(vtkTestImage::Pixel(image, 200 + 110, 150)[0], 80);
  EXPECT_TRUE(vtkTestImage::Matches(image, "EGLRenderWindowSphere", 10.0));
}

TEST(EGLRenderWindow, BaselineTellsAnotherPicture)
{
  auto scene = SphereScene();
  scene->GetActiveCamera()->SetParallelScale(1.1);
  Window window = MakeWindow(400, 300, scene);
  ASSERT_TRUE(window);
  auto image = vtkTestImage::Take(window);
  EXPECT_GT(vtkTestImage::Difference(image, "EGLRenderWindowSphere"), 500.0);
}

TEST(EGLRenderWindow, FlatColourIsExact)
{
  auto scene = SquareScene(0.0, 51 / 255.0, 102 / 255.0, 153 / 255.0);
  Window window = MakeWindow(200, 200, scene);
  ASSERT_TRUE(window);
  auto image = vtkTestImage::Take(window);
  const Colour colour = { 51, 102, 153 };
  EXPECT_EQ(vtkTestImage::CountOthers(image, Blue), 100 * 100);
  EXPECT_EQ(vtkTestImage::CountOthers(image, colour), 200 * 200 - 100 * 100);
  EXPECT_EQ(vtkTestImage::Pixel(image, 50, 50), colour);
  EXPECT_EQ(vtkTestImage::Pixel(image, 49, 50), Blue);
  EXPECT_EQ(vtkTestImage::Pixel(image, 149, 149), colour);
  EXPECT_EQ(vtkTestImage::Pixel(image, 150, 149), Blue);
}

TEST(EGLRenderWindow, DepthsAreLinearInParallelProjection)
{
  for (const double z : { -2.0, 0.0, 1.5 })
  {
    auto scene = SquareScene(z, 1, 1, 1);
    Window window = MakeWindow(120, 80, scene);
    ASSERT_TRUE(window);
    window->Render();
    vtkNew<vtkFloatArray> depths;
    ASSERT_EQ(window->GetZbufferData(0, 0, 119, 79, depths), VTK_OK);
    ASSERT_EQ(depths->GetNumberOfValues(), 120 * 80);
    // Camera at 6, clipping planes at distances 1 and 11.
    EXPECT_NEAR(depths->GetValue(40 * 120 + 60), (6.0 - z - 1.0) / 10.0, 1e-6);
    EXPECT_EQ(depths->GetValue(0), 1.0f);
  }
}

TEST(EGLRenderWindow, DepthGivesThePointOnTheSphere)
{
  auto scene = SphereScene();
  Window window = MakeWindow(300, 300, scene);
  ASSERT_TRUE(window);
  window->Render();
  for (const int x : { 80, 150, 200 })
  {
    for (const int y : { 90, 150, 220 })
    {
      scene->SetDisplayPoint(x + 0.5, y + 0.5, scene->GetZ(x, y));
      scene->DisplayToWorld();
      const double* p = scene->GetWorldPoint();
      EXPECT_NEAR(std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]), 0.75, 3e-3) << x << " " << y;
    }
  }
}

// Before the first frame nothing but the EGL surface is bound, which has no depths to ask for.
TEST(EGLRenderWindow, CameraIsResetBeforeTheFirstFrameWithoutErrors)
{
  auto scene = SquareScene(0.0, 1, 1, 1);
  Window window = MakeWindow(100, 100, scene);
  ASSERT_TRUE(window);
  scene->ResetCamera();
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
  EXPECT_GE(window->GetDepthBufferSize(), 24);
  EXPECT_EQ(scene->GetNearClippingPlaneTolerance(), 0.001) << "VTK's for more than 16 bits";
  window->Render();
  EXPECT_GE(window->GetDepthBufferSize(), 24);
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

TEST(EGLRenderWindow, MultisamplingSmoothsEdgesOnly)
{
  auto scene = SphereScene();
  scene->GetActors()->GetLastActor()->GetProperty()->LightingOff();
  Window window = MakeWindow(300, 300, scene);
  ASSERT_TRUE(window);
  const auto mixed = [&](vtkImageData* image) {
    return vtkTestImage::CountOthers(image, Blue) +
      vtkTestImage::CountOthers(image, { 255, 255, 255 }) - 300 * 300;
  };
  EXPECT_EQ(mixed(vtkTestImage::Take(window)), 0);
  window->SetMultiSamples(4);
  const long smooth = mixed(vtkTestImage::Take(window));
  if (window->GetMultiSamples() == 0)
  {
    GTEST_SKIP() << "this device does not multisample";
  }
  const double rim = 2.0 * vtkMath::Pi() * 0.75 * 150.0; // pixels
  EXPECT_GT(smooth, 0.5 * rim);
  EXPECT_LT(smooth, 2.0 * rim);
}

TEST(EGLRenderWindow, TwoWindowsDrawInTurns)
{
  auto small = SphereScene();
  auto large = SquareScene(0.0, 1, 1, 1);
  Window a = MakeWindow(80, 60, small);
  Window b = MakeWindow(500, 400, large);
  ASSERT_TRUE(a && b);
  for (int turn = 0; turn < 3; ++turn)
  {
    auto imageA = vtkTestImage::Take(a);
    EXPECT_TRUE(a->IsCurrent());
    EXPECT_FALSE(b->IsCurrent());
    auto imageB = vtkTestImage::Take(b);
    EXPECT_FALSE(a->IsCurrent());
    EXPECT_TRUE(b->IsCurrent());
    EXPECT_NEAR(vtkTestImage::CountOthers(imageA, Blue), DiscPixels(0.75, 60), 16);
    EXPECT_EQ(vtkTestImage::CountOthers(imageB, Blue), 200 * 200);
  }
  b = nullptr; // must not touch the other
  EXPECT_NEAR(vtkTestImage::CountOthers(vtkTestImage::Take(a), Blue), DiscPixels(0.75, 60), 16);
}

TEST(EGLRenderWindow, DeletingOneLeavesTheOtherCurrent)
{
  Window a = Create(16, 16);
  Window b = Create(16, 16);
  ASSERT_TRUE(a && b);
  a->MakeCurrent();
  b = nullptr;
  EXPECT_TRUE(a->IsCurrent());
  a->ReleaseCurrent();
  EXPECT_FALSE(a->IsCurrent());
}

TEST(EGLRenderWindow, ResizesWithoutLeavingObjects)
{
  auto scene = SphereScene();
  Window window = MakeWindow(100, 100, scene);
  ASSERT_TRUE(window);
  const int heights[] = { 100, 300, 37, 211 };
  Objects before;
  for (int i = 0; i < 40; ++i)
  {
    const int height = heights[i % 4];
    window->SetSize(height + 13, height);
    auto image = vtkTestImage::Take(window);
    ASSERT_EQ(image->GetDimensions()[0], height + 13);
    ASSERT_EQ(image->GetDimensions()[1], height);
    const double expected = static_cast<double>(DiscPixels(0.75, height));
    EXPECT_NEAR(vtkTestImage::CountOthers(image, Blue), expected, 4 + 0.01 * expected);
    const Objects now = Objects::Count();
    if (i == 4)
    {
      before = now;
      EXPECT_GT(now.Textures * now.Buffers * now.Framebuffers * now.Programs, 0);
    }
    else if (i > 4)
    {
      ASSERT_EQ(now.Textures, before.Textures) << i;
      ASSERT_EQ(now.Buffers, before.Buffers) << i;
      ASSERT_EQ(now.Framebuffers, before.Framebuffers) << i;
      ASSERT_EQ(now.Programs, before.Programs) << i;
      ASSERT_EQ(now.VertexArrays, before.VertexArrays) << i;
    }
  }
}

TEST(EGLRenderWindow, HundredWindowsLeaveNothing)
{
  auto scene = SquareScene(0.0, 1, 1, 1);
  long files = 0, threads = 0;
  for (int i = 0; i < 100; ++i)
  {
    Window window = MakeWindow(64, 64, scene);
    ASSERT_TRUE(window);
    window->Render();
    scene->SetRenderWindow(nullptr);
    window->RemoveRenderer(scene);
    window = nullptr;
    if (i == 4)
    {
      files = Entries("/proc/self/fd");
      threads = Entries("/proc/self/task");
    }
  }
  EXPECT_LE(Entries("/proc/self/fd"), files);
  EXPECT_LE(Entries("/proc/self/task"), threads);
}

TEST(EGLRenderWindow, DrawsAgainAfterFinalize)
{
  auto scene = SphereScene();
  Window window = MakeWindow(200, 150, scene);
  ASSERT_TRUE(window);
  auto before = vtkTestImage::Take(window);
  window->Finalize();
  EXPECT_FALSE(window->IsCurrent());
  EXPECT_EQ(window->GetRendererName(), "");
  auto after = vtkTestImage::Take(window);
  EXPECT_EQ(vtkTestImage::MeanDifference(before, after), 0.0);
  window->Finalize();
  window->Finalize();
}

TEST(EGLRenderWindow, WorksThroughTheNewMacro)
{
  auto scene = SquareScene(0.0, 1, 1, 1);
  vtkNew<vtkNURBSEGLRenderWindow> window;
  window->SetSize(100, 100);
  window->SetMultiSamples(0);
  window->AddRenderer(scene);
  EXPECT_EQ(vtkTestImage::CountOthers(vtkTestImage::Take(window), Blue), 50 * 50);
}

TEST(EGLRenderWindow, GoesToAnotherThreadWhenReleased)
{
  auto scene = SphereScene();
  Window window = MakeWindow(200, 200, scene);
  ASSERT_TRUE(window);
  auto here = vtkTestImage::Take(window);
  window->ReleaseCurrent();
  vtkSmartPointer<vtkImageData> there;
  std::thread([&] {
    there = vtkTestImage::Take(window);
    window->ReleaseCurrent();
  }).join();
  EXPECT_EQ(vtkTestImage::MeanDifference(here, there), 0.0);
  EXPECT_EQ(vtkTestImage::MeanDifference(here, vtkTestImage::Take(window)), 0.0);
}

TEST(EGLRenderWindow, TwoThreadsDrawAtOnce)
{
  long counts[2] = { 0, 0 };
  const auto draw = [&counts](int i) {
    const int height = 100 + 50 * i;
    for (int turn = 0; turn < 5; ++turn)
    {
      auto scene = SphereScene();
      Window window = MakeWindow(height, height, scene);
      counts[i] = window ? vtkTestImage::CountOthers(vtkTestImage::Take(window), Blue) : -1;
    }
  };
  std::thread other(draw, 1);
  draw(0);
  other.join();
  EXPECT_NEAR(counts[0], DiscPixels(0.75, 100), 40);
  EXPECT_NEAR(counts[1], DiscPixels(0.75, 150), 60);
}

TEST(EGLRenderWindow, HeldByAnotherThreadIsAnError)
{
  auto scene = SquareScene(0.0, 1, 1, 1);
  Window window = MakeWindow(50, 50, scene);
  ASSERT_TRUE(window);
  window->Render();
  Errors errors(window);
  std::thread([&] { window->Render(); }).join();
  ASSERT_FALSE(errors.Texts.empty());
  EXPECT_NE(errors.Texts[0].find("in use by another thread"), std::string::npos) << errors.Texts[0];
}

TEST(EGLRenderWindow, WrongDeviceIsToldInWords)
{
  auto scene = SquareScene(0.0, 1, 1, 1);
  vtkNew<vtkNURBSEGLRenderWindow> window;
  Errors errors(window);
  window->SetSize(100, 100);
  window->AddRenderer(scene);
  window->SetDeviceIndex(99);
  window->Render();
  window->Render();
  ASSERT_EQ(errors.Texts.size(), 1u) << "once, not at every Render";
  EXPECT_NE(errors.Texts[0].find("there is no EGL device 99"), std::string::npos)
    << errors.Texts[0];
  EXPECT_NE(window->GetErrorMessage().find("device 99"), std::string::npos);
  EXPECT_EQ(window->SupportsOpenGL(), 0);
  vtkNew<vtkUnsignedCharArray> pixels;
  EXPECT_NE(window->GetPixelData(0, 0, 9, 9, 0, pixels, 0), VTK_OK);
  vtkNew<vtkFloatArray> depths;
  EXPECT_EQ(window->GetZbufferData(0, 0, 9, 9, depths), VTK_ERROR);
  EXPECT_EQ(window->ReportCapabilities(), window->GetErrorMessage());

  window->SetDeviceIndex(-1);
  EXPECT_EQ(window->GetErrorMessage(), "");
  window->SetMultiSamples(0);
  EXPECT_EQ(vtkTestImage::CountOthers(vtkTestImage::Take(window), Blue), 50 * 50);
}

TEST(EGLRenderWindow, TooLargeIsToldInWords)
{
  auto scene = SquareScene(0.0, 1, 1, 1);
  Window window = MakeWindow(100, 100, scene);
  ASSERT_TRUE(window);
  Errors errors(window);
  window->SetSize(window->GetMaximumSize() + 1, 10);
  window->Render();
  ASSERT_EQ(errors.Texts.size(), 1u);
  EXPECT_NE(errors.Texts[0].find("too large"), std::string::npos) << errors.Texts[0];
  window->SetSize(100, 100);
  EXPECT_EQ(vtkTestImage::CountOthers(vtkTestImage::Take(window), Blue), 50 * 50);
}

// In processes of their own, because the libraries look at the environment once.
TEST(EGLRenderWindowDeathTest, NoDriverIsToldInWords)
{
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(
    {
      setenv("__EGL_VENDOR_LIBRARY_DIRS", "/nonexistent", 1);
      setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent", 1); // goes before the other
      Window window = Create(10, 10);
      std::_Exit(window ? 1 : vtkNURBSEGLRenderWindow::CountDevices());
    },
    testing::ExitedWithCode(0), "Install an EGL driver");
}

TEST(EGLRenderWindowDeathTest, EnvironmentSetsTheDevice)
{
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(
    {
      setenv("VTK_EGL_DEVICE_INDEX", "77", 1);
      vtkNew<vtkNURBSEGLRenderWindow> window;
      std::_Exit(window->GetDeviceIndex() == 77 && window->SupportsOpenGL() == 0 ? 0 : 1);
    },
    testing::ExitedWithCode(0), "there is no EGL device 77");
}
