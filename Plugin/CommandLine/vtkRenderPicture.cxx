// SPDX-License-Identifier: BSD-3-Clause
#include "vtkRenderPicture.h"

#include "Failure.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkLight.h"
#include "vtkMath.h"
#include "vtkNURBSEGLRenderWindow.h"
#include "vtkNURBSModel.h"
#include "vtkNew.h"
#include "vtkPNGWriter.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkUnsignedCharArray.h"
#include "vtkWindowToImageFilter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace nurbs
{
namespace
{

using Vector = std::array<double, 3>;

constexpr double ViewAngle = 24.0; // degrees, of the picture's height
constexpr double Margin = 1.06;    // of the model's extent in the picture

struct Frame
{
  Vector Right, Up, Back;
};

Frame FrameOf(Vector back)
{
  vtkMath::Normalize(back.data());
  Frame frame;
  frame.Back = back;
  const bool vertical = std::hypot(back[0], back[1]) < 1e-6;
  const Vector up = vertical ? Vector{ 0, 1, 0 } : Vector{ 0, 0, 1 };
  vtkMath::Cross(up.data(), frame.Back.data(), frame.Right.data());
  vtkMath::Normalize(frame.Right.data());
  vtkMath::Cross(frame.Back.data(), frame.Right.data(), frame.Up.data());
  return frame;
}

void AddLights(vtkRenderer* renderer)
{
  // Key from the upper left, fill from the right, a little from below; positions in camera space.
  const struct
  {
    Vector Position;
    double Intensity;
  } lights[] = { { { -0.5, 0.6, 1.0 }, 0.74 }, { { 1.0, 0.1, 0.7 }, 0.46 },
    { { -0.3, -1.0, 0.6 }, 0.16 } };
  renderer->SetAutomaticLightCreation(false);
  for (const auto& each : lights)
  {
    vtkNew<vtkLight> light;
    light->SetLightTypeToCameraLight();
    light->SetPosition(each.Position[0], each.Position[1], each.Position[2]);
    light->SetFocalPoint(0, 0, 0);
    light->SetIntensity(each.Intensity);
    renderer->AddLight(light);
  }
}

// The colour of each point as its faces have it, or null if some point belongs to faces of different
// colours. Drawn a third faster than colours of cells.
vtkSmartPointer<vtkUnsignedCharArray> PointColours(vtkPolyData* mesh, vtkUnsignedCharArray* cells)
{
  auto colours = vtkSmartPointer<vtkUnsignedCharArray>::New();
  colours->SetNumberOfComponents(3);
  colours->SetNumberOfTuples(mesh->GetNumberOfPoints());
  std::vector<bool> known(static_cast<size_t>(mesh->GetNumberOfPoints()), false);
  vtkCellArray* polys = mesh->GetPolys();
  vtkIdType size = 0;
  const vtkIdType* ids = nullptr;
  const unsigned char* from = cells->GetPointer(0);
  for (polys->InitTraversal(); polys->GetNextCell(size, ids); from += 3)
  {
    for (vtkIdType i = 0; i < size; ++i)
    {
      unsigned char* to = colours->GetPointer(3 * ids[i]);
      auto seen = known[static_cast<size_t>(ids[i])];
      if (seen && !std::equal(from, from + 3, to))
      {
        return nullptr;
      }
      std::copy(from, from + 3, to);
      seen = true;
    }
  }
  return colours;
}

void ColourFaces(vtkPolyData* mesh, vtkPolyDataMapper* mapper)
{
  auto* cells = vtkUnsignedCharArray::SafeDownCast(
    mesh->GetCellData()->GetAbstractArray(vtkNURBSModel::ColorName()));
  mapper->SetScalarVisibility(cells && cells->GetNumberOfComponents() == 3);
  if (!mapper->GetScalarVisibility())
  {
    return;
  }
  mapper->SetColorModeToDirectScalars();
  mapper->SetScalarModeToUseCellFieldData();
  mapper->SelectColorArray(vtkNURBSModel::ColorName());
  if (const auto points = PointColours(mesh, cells))
  {
    points->SetName(vtkNURBSModel::ColorName());
    mesh->GetPointData()->AddArray(points);
    mapper->SetScalarModeToUsePointFieldData();
  }
}

vtkSmartPointer<vtkActor> FacesActor(vtkPolyData* mesh)
{
  vtkNew<vtkPolyData> copy;
  copy->ShallowCopy(mesh);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(copy);
  ColourFaces(copy, mapper);
  // Edges lie in the faces: push the faces back a little.
  mapper->SetResolveCoincidentTopologyToPolygonOffset();
  mapper->SetRelativeCoincidentTopologyPolygonOffsetParameters(1.0, 1.0);
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  vtkProperty* property = actor->GetProperty();
  property->SetColor(0.79, 0.81, 0.84);
  property->SetInterpolationToPhong();
  property->SetAmbient(0.12);
  property->SetDiffuse(0.95);
  property->SetSpecular(0.18);
  property->SetSpecularPower(40);
  return actor;
}

vtkSmartPointer<vtkActor> EdgesActor(vtkPolyData* edges, const std::array<int, 2>& size)
{
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(edges);
  mapper->SetScalarVisibility(false);
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(0.09, 0.11, 0.14);
  actor->GetProperty()->LightingOff();
  actor->GetProperty()->SetLineWidth(
    static_cast<float>(std::clamp(std::min(size[0], size[1]) / 700.0, 1.0, 6.0)));
  return actor;
}

} // namespace

//--------------------------------------------------------------------------------------------------
vtkSmartPointer<vtkCamera> FitCamera(
  vtkPoints* points, const std::array<double, 3>& view, const std::array<int, 2>& size)
{
  const Frame frame = FrameOf(view);
  const double tangentY = std::tan(vtkMath::RadiansFromDegrees(0.5 * ViewAngle)) / Margin;
  const double tangentX = tangentY * size[0] / size[1];
  // In the frame's coordinates a camera at (x, y, z) sees a point p if |p.x - x| <= tx (z - p.z)
  // and likewise in y. The largest of +-p.x + tx p.z over the points give the nearest such camera.
  constexpr double lowest = std::numeric_limits<double>::lowest();
  double right = lowest, left = lowest, top = lowest, bottom = lowest, front = lowest;
  double back = std::numeric_limits<double>::max();
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    double p[3];
    points->GetPoint(i, p);
    const double x = vtkMath::Dot(p, frame.Right.data());
    const double y = vtkMath::Dot(p, frame.Up.data());
    const double z = vtkMath::Dot(p, frame.Back.data());
    right = std::max(right, x + tangentX * z);
    left = std::max(left, tangentX * z - x);
    top = std::max(top, y + tangentY * z);
    bottom = std::max(bottom, tangentY * z - y);
    front = std::max(front, z);
    back = std::min(back, z);
  }
  auto camera = vtkSmartPointer<vtkCamera>::New();
  camera->SetViewAngle(ViewAngle);
  if (points->GetNumberOfPoints() == 0)
  {
    return camera;
  }
  const double x = 0.5 * (right - left);
  const double y = 0.5 * (top - bottom);
  const double depth = std::max(front - back, 1e-6 * (std::abs(front) + std::abs(back)));
  const double z = std::max(
    { 0.5 * (right + left) / tangentX, 0.5 * (top + bottom) / tangentY, front + 0.01 * depth });
  double position[3], focus[3];
  for (size_t c = 0; c < 3; ++c)
  {
    const double base = x * frame.Right[c] + y * frame.Up[c];
    position[c] = base + z * frame.Back[c];
    focus[c] = base + 0.5 * (front + back) * frame.Back[c];
  }
  camera->SetPosition(position);
  camera->SetFocalPoint(focus);
  camera->SetViewUp(frame.Up.data());
  camera->SetClippingRange(
    std::max(z - front - 0.01 * depth, 1e-3 * (z - back)), z - back + 0.01 * depth);
  return camera;
}

//--------------------------------------------------------------------------------------------------
void RenderPicture(
  vtkPolyData* mesh, vtkPolyData* edges, const Picture& picture, const std::string& path)
{
  vtkNew<vtkNURBSEGLRenderWindow> window;
  if (picture.Device >= 0)
  {
    window->SetDeviceIndex(picture.Device);
  }
  window->SetSize(picture.Size[0], picture.Size[1]);
  window->Initialize();
  if (!window->GetErrorMessage().empty())
  {
    throw Failure("cannot draw: " + window->GetErrorMessage());
  }
  if (std::max(picture.Size[0], picture.Size[1]) > window->GetMaximumSize())
  {
    throw Failure("cannot draw: the picture is too large; this device's limit is " +
      std::to_string(window->GetMaximumSize()) + " pixels a side");
  }
  window->SetMultiSamples(8);
  window->SetAlphaBitPlanes(picture.Transparent ? 1 : 0);
  vtkNew<vtkRenderer> renderer;
  renderer->SetGradientBackground(!picture.Transparent);
  renderer->SetBackground(0.79, 0.83, 0.88);
  renderer->SetBackground2(0.97, 0.98, 0.99);
  renderer->SetBackgroundAlpha(picture.Transparent ? 0.0 : 1.0);
  renderer->AddActor(FacesActor(mesh));
  if (edges && edges->GetNumberOfCells() > 0)
  {
    renderer->AddActor(EdgesActor(edges, picture.Size));
  }
  AddLights(renderer);
  renderer->SetActiveCamera(FitCamera(mesh->GetPoints(), picture.View, picture.Size));
  window->AddRenderer(renderer);
  window->Render();

  vtkNew<vtkWindowToImageFilter> grab;
  grab->SetInput(window);
  grab->ReadFrontBufferOff();
  grab->ShouldRerenderOff();
  if (picture.Transparent)
  {
    grab->SetInputBufferTypeToRGBA();
  }
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputConnection(grab->GetOutputPort());
  writer->SetCompressionLevel(1);
  writer->SetFileName(path.c_str());
  writer->Write();
  if (writer->GetErrorCode() != 0)
  {
    throw Failure("cannot write " + path);
  }
}

} // namespace nurbs
