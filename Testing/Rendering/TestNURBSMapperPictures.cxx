// SPDX-License-Identifier: BSD-3-Clause
// Pictures of vtkNURBSMapper against rays cast at the exact surfaces.
#include "vtkCamera.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkMapperScene.h"
#include "vtkNURBSCADReader.h"
#include "vtkNURBSMapper.h"
#include "vtkNURBSShapeSource.h"
#include "vtkNew.h"
#include "vtkRayReference.h"
#include "vtkRenderer.h"
#include "vtkTestImage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <ostream>
#include <string>

namespace
{

using Grid = vtkSmartPointer<vtkUnstructuredGrid>;

constexpr int Size = 200;

void Look(vtkRenderer* renderer)
{
  renderer->GetActiveCamera()->SetPosition(3.0, -4.0, 2.5);
  renderer->GetActiveCamera()->SetFocalPoint(0.0, 0.0, 0.0);
  renderer->GetActiveCamera()->SetViewUp(0.0, 0.0, 1.0);
  renderer->ResetCamera();
}

// Looks at a point of the model from where the camera is, `times` as large.
void Zoom(vtkRenderer* renderer, const nurbs::Vec3& target, double times)
{
  vtkCamera* camera = renderer->GetActiveCamera();
  camera->SetFocalPoint(target.data());
  camera->SetViewAngle(
    2.0 * std::atan(std::tan(camera->GetViewAngle() * M_PI / 360.0) / times) * 180.0 / M_PI);
  renderer->ResetCameraClippingRange();
}

// What the picture has other than the rays.
struct Difference
{
  long Border = 0;   ///< Pixels at which what is seen changes: silhouettes, trims, edges.
  long Covered = 0;  ///< Pixels that are surface in one and background in the other.
  long Faces = 0;    ///< Pixels of different faces,
  long FarFaces = 0; ///< and those of them that are not beside a border.
  /// Distance of what is drawn from the surface, in pixels, that one pixel of 1000 exceeds.
  double Off = 0.0;
};

Difference Compare(vtkMapperScene& scene, const vtkRayReference& reference)
{
  scene.Picture();
  const std::vector<float> depth = scene.Depths();
  const std::vector<int> faces = scene.SelectCells();
  const std::vector<vtkRayReference::Pixel> rays = reference.Cast(scene.Renderer);
  vtkCamera* camera = scene.Renderer->GetActiveCamera();
  const double near = camera->GetClippingRange()[0], far = camera->GetClippingRange()[1];
  const double perPixel =
    2.0 * std::tan(camera->GetViewAngle() * M_PI / 360.0) / Size; // at distance 1
  Difference result;
  std::vector<double> off;
  for (int y = 1; y + 1 < Size; ++y)
  {
    for (int x = 1; x + 1 < Size; ++x)
    {
      const int k = x + y * Size;
      bool border = false;
      for (const int n : { k - 1, k + 1, k - Size, k + Size, k - Size - 1, k - Size + 1,
             k + Size - 1, k + Size + 1 })
      {
        border = border || rays[n].Face != rays[k].Face;
      }
      const bool same = faces[k] == rays[k].Face;
      const bool isOther = faces[k] >= 0 && rays[k].Face >= 0 && !same;
      result.Border += border;
      result.Covered += (faces[k] < 0) != (rays[k].Face < 0);
      result.Faces += isOther;
      result.FarFaces += isOther && !border;
      if (same && faces[k] >= 0)
      {
        const auto distance = [&](double z) { return near * far / (far - z * (far - near)); };
        const double d = distance(rays[k].Depth);
        const nurbs::Vec3 along = reference.PixelRay(scene.Renderer, x + 0.5, y + 0.5).Direction;
        off.push_back(
          std::abs((distance(depth[k]) - d) * along.dot(rays[k].Normal)) / (perPixel * d));
      }
    }
  }
  if (!off.empty())
  {
    std::sort(off.begin(), off.end());
    result.Off = off[off.size() - 1 - off.size() / 1000];
  }
  return result;
}

// A point of the model at which its silhouette, or a trim, is seen.
nurbs::Vec3 SomeBorder(vtkMapperScene& scene, const vtkRayReference& reference)
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

// The file's largest model, if it is an assembly.
Grid LargestModel(vtkDataObject* data)
{
  Grid largest = vtkUnstructuredGrid::SafeDownCast(data);
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(data))
  {
    auto it = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
    for (it->InitTraversal(); !it->IsDoneWithTraversal(); it->GoToNextItem())
    {
      auto* grid = vtkUnstructuredGrid::SafeDownCast(it->GetCurrentDataObject());
      if (grid && (!largest || grid->GetNumberOfCells() > largest->GetNumberOfCells()))
      {
        largest = grid;
      }
    }
  }
  return largest;
}

struct Model
{
  const char* Name;
  int Shape = -1; ///< Of vtkNURBSShapeSource; -1: a file of Debian's occt-misc.
};

std::ostream& operator<<(std::ostream& os, const Model& model)
{
  return os << model.Name;
}

// Null if the file is not there.
Grid Load(const Model& model)
{
  if (model.Shape >= 0)
  {
    vtkNew<vtkNURBSShapeSource> source;
    source->SetShape(model.Shape);
    source->SetNumberOfPatches(150);
    source->Update();
    return source->GetOutput();
  }
  const std::string path = std::string("/usr/share/opencascade/data/") + model.Name;
  if (!std::filesystem::exists(path))
  {
    return nullptr;
  }
  vtkNew<vtkNURBSCADReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  return LargestModel(reader->GetOutputDataObject(0));
}

// "step/screw.step" is "Mapper-step_screw_step".
std::string PictureName(const Model& model)
{
  std::string name = model.Name;
  for (char& c : name)
  {
    c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  }
  return "Mapper-" + name;
}

class Pictures : public testing::TestWithParam<Model>
{};

TEST_P(Pictures, AreThoseOfTheExactSurface)
{
  Grid model = Load(this->GetParam());
  if (!model)
  {
    FAIL() << "Debian's occt-misc, which ./run installs, lacks the file";
  }
  const vtkRayReference reference(model);
  vtkMapperScene scene(model, Size);
  Look(scene.Renderer);
  for (const double zoom : { 1.0, 1000.0 })
  {
    if (zoom > 1.0)
    {
      Zoom(scene.Renderer, SomeBorder(scene, reference), zoom);
    }
    const Difference d = Compare(scene, reference);
    std::printf(
      "%s at %gx: %ld border pixels, %ld covered otherwise, %ld of other faces (%ld not at a "
      "border), surface off by %.3g pixels in all but one of 1000, %lld triangles\n",
      this->GetParam().Name, zoom, d.Border, d.Covered, d.Faces, d.FarFaces, d.Off,
      static_cast<long long>(scene.Mapper->GetNumberOfTriangles()));
    if (zoom == 1.0)
    {
      EXPECT_TRUE(vtkTestImage::Matches(scene.Picture(), PictureName(this->GetParam()), 25.0));
    }
    // One pixel of 1000 at borders, and one more. Enlarged 1000 times, single precision knows a border
    // to some hundredths of a pixel.
    EXPECT_LE(d.Covered, zoom > 1.0 ? 0.015 * d.Border : 0.001 * d.Border + 1);
    // Faces that overlap within their edges' tolerance may be told apart otherwise when enlarged.
    EXPECT_LE(d.FarFaces, zoom > 1.0 ? 10 : 0);
    EXPECT_LE(d.Off, zoom > 1.0 ? 0.1 : 0.01);
  }
}

INSTANTIATE_TEST_SUITE_P(Models, Pictures,
  testing::Values(Model{ "sphere", vtkNURBSShapeSource::SPHERE },
    Model{ "torus", vtkNURBSShapeSource::TORUS },
    Model{ "cylinder", vtkNURBSShapeSource::CYLINDER }, Model{ "cone", vtkNURBSShapeSource::CONE },
    Model{ "disc", vtkNURBSShapeSource::DISC }, Model{ "plate", vtkNURBSShapeSource::PLATE },
    Model{ "teapot", vtkNURBSShapeSource::TEAPOT }, Model{ "sheet", vtkNURBSShapeSource::SHEET },
    Model{ "car", vtkNURBSShapeSource::CAR_BODY }, Model{ "step/linkrods.step" },
    Model{ "step/screw.step" }, Model{ "occ/bottle.brep" }, Model{ "occ/Pump_Nut.brep" },
    Model{ "occ/wing.brep" }));

} // namespace
