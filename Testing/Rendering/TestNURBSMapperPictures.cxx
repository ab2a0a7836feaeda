// SPDX-License-Identifier: BSD-3-Clause
// Pictures of vtkNURBSMapper against rays cast at the exact surfaces.
#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkHardwareSelector.h"
#include "vtkNURBSCADReader.h"
#include "vtkNURBSEGLRenderWindow.h"
#include "vtkNURBSMapper.h"
#include "vtkNURBSShapeSource.h"
#include "vtkNew.h"
#include "vtkProperty.h"
#include "vtkRayReference.h"
#include "vtkRenderer.h"
#include "vtkTestImage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

namespace
{

using Window = vtkSmartPointer<vtkNURBSEGLRenderWindow>;
using Grid = vtkSmartPointer<vtkUnstructuredGrid>;

constexpr int Size = 200;

struct Scene
{
  vtkNew<vtkNURBSMapper> Mapper;
  vtkNew<vtkActor> Actor;
  vtkNew<vtkRenderer> Renderer;
  Window RenderWindow;

  explicit Scene(vtkDataObject* model)
  {
    this->Mapper->SetInputData(model);
    this->Actor->SetMapper(this->Mapper);
    this->Renderer->AddActor(this->Actor);
    this->Renderer->SetBackground(0.1, 0.2, 0.4);
    this->RenderWindow = Window::Take(vtkNURBSEGLRenderWindow::Create(Size, Size));
    this->RenderWindow->SetMultiSamples(0);
    this->RenderWindow->AddRenderer(this->Renderer);
    this->Renderer->GetActiveCamera()->SetPosition(3.0, -4.0, 2.5);
    this->Renderer->GetActiveCamera()->SetViewUp(0.0, 0.0, 1.0);
    this->Renderer->ResetCamera();
  }

  // Looks at a point of the model from as far as before, `times` as large.
  void Zoom(const nurbs::Vec3& target, double times)
  {
    vtkCamera* camera = this->Renderer->GetActiveCamera();
    double direction[3];
    camera->GetDirectionOfProjection(direction);
    const nurbs::Vec3 d(direction);
    const nurbs::Vec3 eye = target - d * camera->GetDistance();
    camera->SetFocalPoint(target.data());
    camera->SetPosition(eye.data());
    camera->SetViewAngle(
      2.0 * std::atan(std::tan(camera->GetViewAngle() * M_PI / 360.0) / times) * 180.0 / M_PI);
    this->Renderer->ResetCameraClippingRange();
  }
};

// What the picture has other than the rays.
struct Difference
{
  long Border = 0;  ///< Pixels at which what is seen changes: silhouettes, trims, edges.
  long Covered = 0; ///< Pixels that are surface in one and background in the other.
  long Faces = 0;   ///< Pixels of different faces.
  double Depth = 0.0; ///< Largest distance from the surface, in pixels, of pixels of the same face.
};

std::vector<int> FacesOfPicture(Scene& scene)
{
  vtkNew<vtkHardwareSelector> selector;
  selector->SetRenderer(scene.Renderer);
  selector->SetArea(0, 0, Size - 1, Size - 1);
  selector->SetFieldAssociation(vtkDataObject::FIELD_ASSOCIATION_CELLS);
  std::vector<int> faces(std::size_t(Size) * Size, -1);
  EXPECT_TRUE(selector->CaptureBuffers());
  for (unsigned int k = 0; k < faces.size(); ++k)
  {
    const unsigned int place[2] = { k % Size, k / Size };
    const vtkHardwareSelector::PixelInformation info = selector->GetPixelInformation(place);
    faces[k] = info.Valid ? static_cast<int>(info.AttributeID) : -1;
  }
  return faces;
}

Difference Compare(Scene& scene, const vtkRayReference& reference)
{
  scene.RenderWindow->Render();
  std::vector<float> depth(std::size_t(Size) * Size);
  scene.RenderWindow->GetZbufferData(0, 0, Size - 1, Size - 1, depth.data());
  const std::vector<int> faces = FacesOfPicture(scene);
  const std::vector<vtkRayReference::Pixel> rays = reference.Cast(scene.Renderer);
  vtkCamera* camera = scene.Renderer->GetActiveCamera();
  const double near = camera->GetClippingRange()[0], far = camera->GetClippingRange()[1];
  const double perPixel =
    2.0 * std::tan(camera->GetViewAngle() * M_PI / 360.0) / Size; // at distance 1
  Difference result;
  for (int y = 1; y + 1 < Size; ++y)
  {
    for (int x = 1; x + 1 < Size; ++x)
    {
      const int k = x + y * Size;
      for (const int n : { k - 1, k + 1, k - Size, k + Size })
      {
        if (rays[n].Face != rays[k].Face)
        {
          ++result.Border;
          break;
        }
      }
      const bool same = faces[k] == rays[k].Face;
      result.Covered += (faces[k] < 0) != (rays[k].Face < 0);
      result.Faces += faces[k] >= 0 && rays[k].Face >= 0 && !same;
      if (same && faces[k] >= 0)
      {
        const auto distance = [&](double z) { return near * far / (far - z * (far - near)); };
        const double d = distance(rays[k].Depth);
        const nurbs::Vec3 along =
          reference.PixelRay(scene.Renderer, x + 0.5, y + 0.5).Direction;
          result.Depth = std::max(result.Depth,
          std::abs((distance(depth[k]) - d) * along.dot(rays[k].Normal)) / (perPixel * d));
      }
    }
  }
  return result;
}

// A point of the model at which its silhouette, or a trim, is seen.
nurbs::Vec3 SomeBorder(Scene& scene, const vtkRayReference& reference)
{
  const auto rays = reference.Cast(scene.Renderer);
  int k = Size * Size / 3;
  while (rays[k].Face < 0 || rays[k].Face == rays[k + 1].Face || k % Size + 1 == Size)
  {
    ++k;
  }
  double in = 0.5, out = 1.5;
  nurbs::RayHit hit, last;
  for (int step = 0; step < 40; ++step)
  {
    const double middle = 0.5 * (in + out);
    const nurbs::Ray ray = reference.PixelRay(scene.Renderer, k % Size + middle, k / Size + 0.5);
    const bool same = reference.GetCaster().Nearest(ray, hit) && hit.Face == rays[k].Face;
    (same ? in : out) = middle;
    last = same ? hit : last;
  }
  return last.Point;
}

Grid Shape(int shape)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShape(shape);
  source->SetNumberOfPatches(150);
  source->Update();
  return source->GetOutput();
}

class Pictures : public testing::TestWithParam<int>
{};

TEST_P(Pictures, AreThoseOfTheExactSurface)
{
  Grid model = Shape(this->GetParam());
  const vtkRayReference reference(model);
  Scene scene(model);
  for (const double zoom : { 1.0, 1000.0 })
  {
    if (zoom > 1.0)
    {
      scene.Zoom(SomeBorder(scene, reference), zoom);
    }
    const Difference d = Compare(scene, reference);
    std::printf("shape %d at %gx: %ld border pixels, %ld covered otherwise, %ld of other faces, depth "
                "off by %.3g pixels, %lld triangles within %.3g pixels\n",
      this->GetParam(), zoom, d.Border, d.Covered, d.Faces, d.Depth,
      static_cast<long long>(scene.Mapper->GetNumberOfTriangles()), scene.Mapper->GetAchievedPixelError());
    vtkTestImage::Write(vtkTestImage::Take(scene.RenderWindow),
      std::string(NURBS_TEST_OUTPUT) + "/MapperShape" + std::to_string(this->GetParam()) +
        (zoom > 1.0 ? "Zoom.png" : ".png"));
    EXPECT_LE(d.Covered, 0.001 * d.Border);
  }
}

INSTANTIATE_TEST_SUITE_P(
  Shapes, Pictures, testing::Range<int>(vtkNURBSShapeSource::SPHERE, vtkNURBSShapeSource::CAR_BODY + 1));

} // namespace
