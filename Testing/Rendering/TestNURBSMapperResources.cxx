// SPDX-License-Identifier: BSD-3-Clause
// What vtkNURBSMapper makes in OpenGL contexts, and that it deletes it, however windows, renderers,
// actors and mappers come and go.
#include "vtkCamera.h"
#include "vtkHardwareSelector.h"
#include "vtkMapperScene.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkSphereSource.h"
#include "vtkTestImage.h"
#include "vtk_glew.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <iterator>

namespace
{

using vtkMapperTest::Compare;
using vtkMapperTest::CountDrawn;
using vtkMapperTest::Shape;
using Picture = vtkSmartPointer<vtkImageData>;
using Grid = vtkSmartPointer<vtkUnstructuredGrid>;

// Names in use in the current context, of the kinds that VTK and we make.
struct Objects
{
  long Textures = 0, Buffers = 0, Framebuffers = 0, Programs = 0, VertexArrays = 0;

  static Objects Count(vtkRenderWindow* window)
  {
    window->MakeCurrent();
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
  bool operator==(const Objects& b) const
  {
    return this->Textures == b.Textures && this->Buffers == b.Buffers &&
      this->Framebuffers == b.Framebuffers && this->Programs == b.Programs &&
      this->VertexArrays == b.VertexArrays;
  }
};

void PrintTo(const Objects& o, std::ostream* os)
{
  *os << o.Textures << " textures, " << o.Buffers << " buffers, " << o.Framebuffers
      << " framebuffers, " << o.Programs << " programs, " << o.VertexArrays << " vertex arrays";
}

long ResidentPages()
{
  long size = 0, resident = 0;
  std::FILE* file = std::fopen("/proc/self/statm", "r");
  const int read = file ? std::fscanf(file, "%ld %ld", &size, &resident) : 0;
  if (file)
  {
    std::fclose(file);
  }
  return read == 2 ? resident : 0;
}

const Grid& Model(int i)
{
  static const Grid models[] = { Shape(vtkNURBSShapeSource::SPHERE),
    Shape(vtkNURBSShapeSource::TEAPOT), Shape(vtkNURBSShapeSource::PLATE),
    Shape(vtkNURBSShapeSource::CONE), Shape(vtkNURBSShapeSource::CAR_BODY) };
  return models[i % 5];
}

// One frame of a thousand: another input, level of zoom, colour, representation and size.
void Change(vtkMapperScene& scene, int i)
{
  if (i % 3 == 0)
  {
    scene.Mapper->SetInputData(Model(i / 3));
    scene.Renderer->ResetCamera();
  }
  scene.Renderer->GetActiveCamera()->Zoom(i % 3 == 1 ? 20.0 : i % 3 == 2 ? 0.1 : 1.0);
  scene.Actor->GetProperty()->SetOpacity(i % 4 == 3 ? 0.5 : 1.0);
  scene.Actor->GetProperty()->SetRepresentation(i % 7 == 2 ? VTK_WIREFRAME : VTK_SURFACE);
  scene.Window->SetSize(20 + i % 2, 20);
}

} // namespace

TEST(Resources, AThousandChangesLeaveNoObjects)
{
  vtkMapperScene scene(Model(0), 20);
  Objects before;
  long pages = 0;
  const int warm = 3 * 4 * 5 * 7;
  for (int i = 0; i < 1000; ++i)
  {
    Change(scene, i);
    scene.Window->Render();
    ASSERT_EQ(glGetError(), GLenum(GL_NO_ERROR)) << i;
    if (i == warm)
    {
      before = Objects::Count(scene.Window);
      pages = ResidentPages();
    }
  }
  for (int i = 1000; i <= 4 * warm; ++i)
  {
    Change(scene, i); // to where the first count was taken
  }
  scene.Picture();
  EXPECT_EQ(Objects::Count(scene.Window), before);
  std::printf("%ld textures, %ld buffers, %ld programs; %ld KiB more after a thousand frames\n",
    before.Textures, before.Buffers, before.Programs, 4 * (ResidentPages() - pages));
}

// What is left when the actor is not seen is VTK's.
TEST(Resources, AreReleasedAndMadeAgain)
{
  vtkMapperScene scene(Model(1));
  scene.Actor->VisibilityOff();
  scene.Picture();
  const Objects none = Objects::Count(scene.Window);
  scene.Actor->VisibilityOn();
  Picture first = scene.Picture();
  const Objects all = Objects::Count(scene.Window);
  EXPECT_GT(all.Textures, none.Textures);
  EXPECT_GT(all.Buffers, none.Buffers);
  EXPECT_GT(all.VertexArrays, none.VertexArrays);

  const auto expectReleased = [&](const char* how) {
    Objects left = Objects::Count(scene.Window);
    left.Programs = none.Programs; // the window's cache keeps them
    EXPECT_EQ(left, none) << how;
  };
  scene.Mapper->ReleaseGraphicsResources(scene.Window);
  expectReleased("by ReleaseGraphicsResources");
  EXPECT_EQ(vtkTestImage::MeanDifference(first, scene.Picture()), 0.0);
  EXPECT_EQ(Objects::Count(scene.Window), all);

  scene.Renderer->RemoveActor(scene.Actor);
  expectReleased("by removing the actor");
  scene.Renderer->AddActor(scene.Actor);
  EXPECT_EQ(vtkTestImage::MeanDifference(first, scene.Picture()), 0.0);

  {
    vtkNew<vtkNURBSMapper> another;
    another->SetInputData(Model(1));
    scene.Mapper->ReleaseGraphicsResources(scene.Window);
    scene.PictureWith(another);
    EXPECT_EQ(Objects::Count(scene.Window), all);
  }
  expectReleased("by deleting the mapper");

  scene.Picture();
  scene.Mapper->ReleaseGraphicsResources(nullptr);
  expectReleased("by ReleaseGraphicsResources of no window");
}

TEST(Resources, WindowsShareAMapperInTurn)
{
  vtkMapperScene a(Model(1)), b(Model(3), 100);
  const Objects emptyB = [&] {
    b.Actor->VisibilityOff();
    b.Picture();
    b.Actor->VisibilityOn();
    return Objects::Count(b.Window);
  }();
  Picture inA = a.Picture();
  Picture inB = b.Picture();
  const Objects fullB = Objects::Count(b.Window);
  b.Actor->SetMapper(a.Mapper);
  Picture sharedInB = b.Picture();
  EXPECT_GT(Compare(inB, sharedInB).Strange, 500);
  for (int turn = 0; turn < 3; ++turn)
  {
    EXPECT_EQ(vtkTestImage::MeanDifference(inA, a.Picture()), 0.0);
    EXPECT_EQ(vtkTestImage::MeanDifference(sharedInB, b.Picture()), 0.0);
  }
  b.Actor->SetMapper(b.Mapper);
  EXPECT_EQ(vtkTestImage::MeanDifference(inB, b.Picture()), 0.0);
  a.Picture(); // the shared mapper leaves the second window
  Objects left = Objects::Count(b.Window);
  left.Programs = fullB.Programs;
  EXPECT_EQ(left, fullB);
  b.Mapper->ReleaseGraphicsResources(b.Window);
  left = Objects::Count(b.Window);
  left.Programs = emptyB.Programs;
  EXPECT_EQ(left, emptyB);
}

TEST(Resources, AMapperOutlivesItsWindows)
{
  vtkNew<vtkNURBSMapper> mapper;
  mapper->SetInputData(Model(1));
  Picture first;
  for (int i = 0; i < 15; ++i)
  {
    vtkMapperScene scene(Model(1), 40);
    Picture picture = scene.PictureWith(mapper); // and out of the actor, before the window goes
    first = first ? first : picture;
    ASSERT_EQ(vtkTestImage::MeanDifference(first, picture), 0.0) << i;
  }
  // Another context is current, of which nothing may be deleted.
  vtkMapperScene scene(Model(0));
  scene.Picture();
  const Objects before = Objects::Count(scene.Window);
  mapper->ReleaseGraphicsResources(nullptr);
  EXPECT_EQ(Objects::Count(scene.Window), before);
}

// A new context in the same window has names of its own.
TEST(Resources, AMapperOutlivesTheContextOfItsWindow)
{
  vtkMapperScene scene(Model(1));
  vtkNew<vtkNURBSMapper> mapper;
  mapper->SetInputData(Model(1));
  Picture first = scene.PictureWith(mapper);
  scene.Window->Finalize();
  EXPECT_EQ(vtkTestImage::MeanDifference(first, vtkTestImage::Take(scene.Window)), 0.0);
  const Objects before = Objects::Count(scene.Window);
  mapper->ReleaseGraphicsResources(scene.Window);
  EXPECT_EQ(Objects::Count(scene.Window), before);
  EXPECT_EQ(vtkTestImage::MeanDifference(first, vtkTestImage::Take(scene.Window)), 0.0);
  scene.Actor->SetMapper(mapper);
  EXPECT_EQ(vtkTestImage::MeanDifference(first, vtkTestImage::Take(scene.Window)), 0.0);
  scene.Window->Finalize();
  EXPECT_EQ(vtkTestImage::MeanDifference(first, vtkTestImage::Take(scene.Window)), 0.0);
}

// Views of one window, near and far, that take turns with a mapper; and two actors with it.
TEST(Resources, RenderersAndActorsShareAMapper)
{
  vtkMapperScene scene(Model(1));
  Picture alone = scene.Picture();
  vtkNew<vtkRenderer> inset;
  inset->SetViewport(0.7, 0.7, 1.0, 1.0);
  inset->SetBackground(0.0, 0.0, 0.0);
  inset->AddActor(scene.Actor);
  inset->ResetCamera();
  inset->GetActiveCamera()->Zoom(8.0);
  scene.Window->AddRenderer(inset);
  Picture both = scene.Picture();
  const int edge = 112; // 0.7 of 160 pixels
  long different = 0, drawn = 0;
  for (int y = 0; y < 160; ++y)
  {
    for (int x = 0; x < 160; ++x)
    {
      const bool inInset = x >= edge && y >= edge;
      different += !inInset && vtkTestImage::Pixel(alone, x, y) != vtkTestImage::Pixel(both, x, y);
      drawn += inInset && vtkTestImage::Pixel(both, x, y) != vtkTestImage::Colour{ 0, 0, 0 };
    }
  }
  EXPECT_EQ(different, 0);
  EXPECT_GT(drawn, 500);
  scene.Window->RemoveRenderer(inset);
  EXPECT_EQ(vtkTestImage::MeanDifference(alone, scene.Picture()), 0.0);

  vtkNew<vtkActor> other;
  other->SetMapper(scene.Mapper);
  other->SetPosition(20.0, 60.0, -20.0);
  other->GetProperty()->SetColor(1.0, 0.0, 0.0);
  scene.Renderer->AddActor(other);
  scene.Renderer->ResetCamera();
  Picture two = scene.Picture();
  vtkNew<vtkNURBSMapper> own;
  own->SetInputData(Model(1));
  other->SetMapper(own);
  EXPECT_EQ(vtkTestImage::MeanDifference(two, scene.Picture()), 0.0);
}

// A pick asks for a pixel, in many frames: nothing is shaded elsewhere, and what is hit is the same.
TEST(Selection, DrawsNoMoreThanItReads)
{
  vtkMapperScene scene(Model(1), 100);
  const std::vector<int> cells = scene.SelectCells();
  const unsigned int place[2] = { 50, 40 };
  ASSERT_GE(cells[50 + 40 * 100], 0);
  vtkNew<vtkHardwareSelector> selector;
  selector->SetRenderer(scene.Renderer);
  selector->SetArea(place[0], place[1], place[0], place[1]);
  selector->SetFieldAssociation(vtkDataObject::FIELD_ASSOCIATION_CELLS);
  GLuint query = 0, samples = 0;
  glGenQueries(1, &query);
  glBeginQuery(GL_SAMPLES_PASSED, query);
  EXPECT_TRUE(selector->CaptureBuffers());
  glEndQuery(GL_SAMPLES_PASSED);
  glGetQueryObjectuiv(query, GL_QUERY_RESULT, &samples);
  glDeleteQueries(1, &query);
  EXPECT_EQ(selector->GetPixelInformation(place).AttributeID, cells[50 + 40 * 100]);
  EXPECT_GT(samples, 0u);
  EXPECT_LT(samples, 100u);
  // The next picture is whole again.
  EXPECT_GT(CountDrawn(scene.Picture()), 1000);
}
