// SPDX-License-Identifier: BSD-3-Clause
// Lights, materials, transparency, clipping and representations of vtkNURBSMapper, against the same
// models tessellated finely and drawn by vtkPolyDataMapper.
#include "vtkCamera.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkIntArray.h"
#include "vtkLight.h"
#include "vtkLookupTable.h"
#include "vtkMapperScene.h"
#include "vtkMath.h"
#include "vtkPlane.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkTestImage.h"
#include "vtkUnsignedCharArray.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <initializer_list>
#include <map>
#include <utility>

namespace
{

using vtkMapperTest::Compare;
using vtkMapperTest::Difference;
using vtkMapperTest::Shape;
using Grid = vtkSmartPointer<vtkUnstructuredGrid>;
using Picture = vtkSmartPointer<vtkImageData>;

/// A look of a model that both mappers are to show. Pixels may be strange on outlines only, where
/// one may be a layer short.
struct Look
{
  const char* Name;
  int Shape;
  std::function<void(vtkMapperScene&)> Apply;
  std::function<void(vtkMapper*)> ApplyToMapper = [](vtkMapper*) {};
  double Mean = 0.2;      ///< Largest mean difference, 0 to 255.
  double Strange = 0.002; ///< Largest share of pixels that differ by more than 8.
};

void PrintTo(const Look& look, std::ostream* os)
{
  *os << look.Name;
}

// Attributes of faces to colour by, and every third face turned.
void AddArrays(vtkUnstructuredGrid* model)
{
  const vtkIdType faces = model->GetNumberOfCells();
  vtkNew<vtkDoubleArray> height;
  height->SetName("Height");
  vtkNew<vtkUnsignedCharArray> paint;
  paint->SetName("Paint");
  paint->SetNumberOfComponents(3);
  vtkNew<vtkUnsignedCharArray> glaze;
  glaze->SetName("Glaze");
  glaze->SetNumberOfComponents(4);
  vtkNew<vtkDoubleArray> wind;
  wind->SetName("Wind");
  wind->SetNumberOfComponents(3);
  vtkNew<vtkIntArray> orientation;
  orientation->SetName("Orientation");
  for (vtkIdType f = 0; f < faces; ++f)
  {
    height->InsertNextValue(f % 5 == 2 ? vtkMath::Nan() : static_cast<double>(f));
    paint->InsertNextTuple3(40 * (f % 7), 255 - 30 * (f % 8), 90 * (f % 3));
    glaze->InsertNextTuple4(255 - 30 * (f % 8), 40 * (f % 7), 90 * (f % 3), f % 2 ? 100 : 255);
    wind->InsertNextTuple3(f, -2.0 * static_cast<double>(f % 4), 3.0);
    orientation->InsertNextValue(f % 3 == 0 ? -1 : 1);
  }
  for (vtkDataArray* array :
    std::initializer_list<vtkDataArray*>{ height, paint, glaze, wind, orientation })
  {
    model->GetCellData()->AddArray(array);
  }
}

constexpr int PaintedTeapot = -1; ///< With AddArrays.

// A shape and its triangles, which are made once.
const std::pair<Grid, vtkSmartPointer<vtkDataObject>>& ShapeAndTriangles(int shape)
{
  static std::map<int, std::pair<Grid, vtkSmartPointer<vtkDataObject>>> made;
  auto& result = made[shape];
  if (!result.first)
  {
    result.first = Shape(shape == PaintedTeapot ? vtkNURBSShapeSource::TEAPOT : shape);
    if (shape == PaintedTeapot)
    {
      AddArrays(result.first);
    }
    result.second = vtkMapperTest::Tessellate(result.first);
  }
  return result;
}

void ExpectLikeTriangles(const Look& look)
{
  vtkMapperScene scene(ShapeAndTriangles(look.Shape).first);
  vtkNew<vtkPolyDataMapper> triangles;
  triangles->SetInputDataObject(ShapeAndTriangles(look.Shape).second);
  look.Apply(scene);
  look.ApplyToMapper(scene.Mapper);
  look.ApplyToMapper(triangles);
  Picture ours = scene.Picture();
  Picture theirs = scene.PictureWith(triangles);
  const Difference d = Compare(ours, theirs);
  std::printf(
    "%s: mean difference %.3f, %ld of %ld pixels strange\n", look.Name, d.Mean, d.Strange, d.Drawn);
  const std::string path = std::string(NURBS_TEST_OUTPUT) + "/Look" + look.Name;
  vtkTestImage::Write(ours, path + ".png");
  vtkTestImage::Write(theirs, path + "Triangles.png");
  EXPECT_GT(d.Drawn, 700);
  EXPECT_LE(d.Mean, look.Mean);
  EXPECT_LE(d.Strange, look.Strange * static_cast<double>(d.Drawn) + 1.0);
}

class Looks : public testing::TestWithParam<Look>
{};

TEST_P(Looks, AreThoseOfTriangles)
{
  ExpectLikeTriangles(this->GetParam());
}

void UsePBR(vtkMapperScene& scene, double metallic, double roughness)
{
  vtkProperty* property = scene.Actor->GetProperty();
  property->SetInterpolationToPBR();
  property->SetColor(0.9, 0.6, 0.3);
  property->SetMetallic(metallic);
  property->SetRoughness(roughness);
}

void LookInside(vtkMapperScene& scene)
{
  scene.Renderer->GetActiveCamera()->SetPosition(1.0, -2.0, -7.0);
  scene.Renderer->ResetCamera();
}

void UsePeeling(vtkMapperScene& scene)
{
  scene.Window->SetAlphaBitPlanes(1);
  scene.Renderer->UseDepthPeelingOn();
  scene.Renderer->SetMaximumNumberOfPeels(20);
  scene.Renderer->SetOcclusionRatio(0.0);
  scene.Actor->GetProperty()->SetOpacity(0.4);
  scene.Actor->GetProperty()->SetColor(0.9, 0.6, 0.3);
}

void AddLights(vtkMapperScene& scene)
{
  scene.Renderer->AutomaticLightCreationOff();
  vtkNew<vtkLight> sun, lamp, spot;
  sun->SetLightTypeToSceneLight();
  sun->SetPosition(-3.0, -5.0, 4.0);
  sun->SetColor(1.0, 0.4, 0.4);
  lamp->SetLightTypeToSceneLight();
  lamp->PositionalOn();
  lamp->SetConeAngle(180.0);
  lamp->SetPosition(2.0, -1.5, 2.0);
  lamp->SetColor(0.2, 0.9, 0.2);
  spot->SetLightTypeToSceneLight();
  spot->PositionalOn();
  spot->SetConeAngle(30.0);
  spot->SetPosition(1.0, -4.0, 1.0);
  spot->SetFocalPoint(0.0, 0.0, 0.2);
  spot->SetColor(0.3, 0.3, 1.0);
  for (vtkLight* light : { sun.Get(), lamp.Get(), spot.Get() })
  {
    scene.Renderer->AddLight(light);
  }
}

void ShowBackFaces(vtkMapperScene& scene)
{
  LookInside(scene);
  vtkNew<vtkProperty> back;
  back->SetColor(0.1, 0.8, 0.3);
  scene.Actor->SetBackfaceProperty(back);
}

INSTANTIATE_TEST_SUITE_P(Lights, Looks,
  testing::Values(Look{ "Gouraud", vtkNURBSShapeSource::TEAPOT, [](vtkMapperScene&) {} },
    Look{ "Specular", vtkNURBSShapeSource::TORUS,
      [](vtkMapperScene& scene) {
        scene.Actor->GetProperty()->SetSpecular(0.6);
        scene.Actor->GetProperty()->SetSpecularPower(30.0);
        scene.Actor->GetProperty()->SetAmbient(0.2);
      } },
    Look{ "ManyLights", vtkNURBSShapeSource::TEAPOT, AddLights },
    Look{ "ManyLightsSphere", vtkNURBSShapeSource::SPHERE, AddLights },
    Look{ "NoLighting", vtkNURBSShapeSource::TEAPOT,
      [](vtkMapperScene& scene) {
        scene.Actor->GetProperty()->LightingOff();
        scene.Actor->GetProperty()->SetColor(0.9, 0.6, 0.3);
      } },
    Look{ "RoughMetal", vtkNURBSShapeSource::TORUS,
      [](vtkMapperScene& scene) { UsePBR(scene, 0.7, 0.4); } },
    Look{ "ClearCoat", vtkNURBSShapeSource::TEAPOT,
      [](vtkMapperScene& scene) {
        UsePBR(scene, 0.1, 0.8);
        scene.Actor->GetProperty()->SetCoatStrength(1.0);
        scene.Actor->GetProperty()->SetCoatRoughness(0.2);
      } },
    Look{ "BackFaces", vtkNURBSShapeSource::SHEET, ShowBackFaces },
    Look{ "BackFacesCulled", vtkNURBSShapeSource::TEAPOT,
      [](vtkMapperScene& scene) { scene.Actor->GetProperty()->BackfaceCullingOn(); } },
    Look{ "FrontFacesCulled", vtkNURBSShapeSource::SPHERE,
      [](vtkMapperScene& scene) { scene.Actor->GetProperty()->FrontfaceCullingOn(); } },
    Look{ "BackFacesCulledCoarsely", vtkNURBSShapeSource::SPHERE,
      [](vtkMapperScene& scene) {
        scene.Actor->GetProperty()->BackfaceCullingOn();
        scene.Mapper->SetPixelError(3.0);
      } },
    Look{ "TurnedFaces", PaintedTeapot, ShowBackFaces },
    Look{ "TurnedFacesAlone", PaintedTeapot, [](vtkMapperScene&) {} },
    Look{ "TurnedFacesCulled", PaintedTeapot,
      [](vtkMapperScene& scene) { scene.Actor->GetProperty()->FrontfaceCullingOn(); } },
    Look{ "Parallel", vtkNURBSShapeSource::TEAPOT,
      [](vtkMapperScene& scene) { scene.Renderer->GetActiveCamera()->ParallelProjectionOn(); } },
    Look{ "Scaled", vtkNURBSShapeSource::TEAPOT, [](vtkMapperScene& scene) {
           scene.Actor->SetScale(1.0, 0.5, 2.0);
           scene.Actor->RotateX(30.0);
           scene.Renderer->ResetCamera();
         } }));

void AddPlanes(vtkMapper* mapper)
{
  vtkNew<vtkPlane> x, z;
  x->SetNormal(1.0, 0.3, 0.0);
  z->SetOrigin(0.0, 0.0, 0.6);
  z->SetNormal(0.0, 0.1, -1.0);
  mapper->AddClippingPlane(x);
  mapper->AddClippingPlane(z);
}

INSTANTIATE_TEST_SUITE_P(Cuts, Looks,
  testing::Values(Look{ "Clipped", vtkNURBSShapeSource::SPHERE, [](vtkMapperScene&) {}, AddPlanes },
    Look{ "ClippedMoved", vtkNURBSShapeSource::TEAPOT,
      [](vtkMapperScene& scene) {
        scene.Actor->SetPosition(-0.3, 0.2, 0.1);
        scene.Actor->RotateZ(70.0);
      },
      AddPlanes }));

void NoChange(vtkMapper*) {}

void Blend(vtkMapperScene& scene)
{
  UsePeeling(scene);
  scene.Renderer->UseDepthPeelingOff();
}

constexpr double Outlines = 0.012; ///< Of translucent models.

INSTANTIATE_TEST_SUITE_P(Translucent, Looks,
  testing::Values(
    Look{ "PeeledTeapot", vtkNURBSShapeSource::TEAPOT, UsePeeling, NoChange, 0.2, Outlines },
    Look{ "PeeledTorus", vtkNURBSShapeSource::TORUS, UsePeeling, NoChange, 0.2, Outlines },
    Look{ "PeeledSheet", vtkNURBSShapeSource::SHEET, UsePeeling },
    Look{ "PeeledCut", vtkNURBSShapeSource::TEAPOT, UsePeeling, AddPlanes, 0.2, Outlines },
    Look{ "PeeledCoarsely", vtkNURBSShapeSource::TORUS,
      [](vtkMapperScene& scene) {
        UsePeeling(scene);
        scene.Mapper->SetPixelError(3.0);
      },
      NoChange, 0.5, 2.5 * Outlines },
    Look{ "BlendedTeapot", vtkNURBSShapeSource::TEAPOT, Blend, NoChange, 0.2, Outlines },
    Look{ "BlendedSheet", vtkNURBSShapeSource::SHEET, Blend },
    Look{ "BlendedPlate", vtkNURBSShapeSource::PLATE, Blend }));

// The older method of VTK, which it falls back to, takes more pixels for a layer of their own.
TEST(LegacyPeeling, IsThatOfTriangles)
{
  setenv("VTK_USE_LEGACY_DEPTH_PEELING", "1", 1);
  ExpectLikeTriangles(
    { "LegacyPeeling", vtkNURBSShapeSource::TEAPOT, UsePeeling, NoChange, 0.3, 2.0 * Outlines });
  unsetenv("VTK_USE_LEGACY_DEPTH_PEELING");
}

// Every pixel of a flat sheet is blended exactly once with the background.
TEST(Blending, IsDoneOnceAPixel)
{
  vtkMapperScene scene(Shape(vtkNURBSShapeSource::CYLINDER));
  Blend(scene);
  scene.Actor->GetProperty()->LightingOff();
  scene.Actor->GetProperty()->BackfaceCullingOn();
  Picture picture = scene.Picture();
  const vtkTestImage::Colour once = { 107, 91, 92 }; // 0.4 (0.9, 0.6, 0.3) + 0.6 background
  const long drawn = vtkMapperTest::CountDrawn(picture);
  const long others = vtkTestImage::CountOthers(picture, once, 2);
  std::printf("%ld pixels drawn, %ld not blended once\n", drawn, others - (160 * 160 - drawn));
  EXPECT_GT(drawn, 3000);
  EXPECT_LE(others - (160 * 160 - drawn), drawn / 500);
}

void ColorBy(vtkMapper* mapper, const char* array)
{
  mapper->SetScalarModeToUseCellFieldData();
  mapper->SelectColorArray(array);
}

void ColorByHeight(vtkMapper* mapper)
{
  vtkNew<vtkLookupTable> table;
  table->SetRange(0.0, 31.0);
  table->SetNumberOfTableValues(7);
  table->SetHueRange(0.0, 0.7);
  table->SetNanColor(0.2, 1.0, 0.9, 1.0);
  table->Build();
  mapper->SetLookupTable(table);
  mapper->UseLookupTableScalarRangeOn();
  ColorBy(mapper, "Height");
}

void ColorTranslucently(vtkMapper* mapper)
{
  ColorByHeight(mapper);
  auto* table = vtkLookupTable::SafeDownCast(mapper->GetLookupTable());
  for (int i = 0; i < 7; i += 2)
  {
    double color[4];
    table->GetTableValue(i, color);
    table->SetTableValue(i, color[0], color[1], color[2], 0.4);
  }
}

void PeelOpaqueActor(vtkMapperScene& scene)
{
  UsePeeling(scene);
  scene.Actor->GetProperty()->SetOpacity(1.0);
}

INSTANTIATE_TEST_SUITE_P(Colors, Looks,
  testing::Values(Look{ "LookupTable", PaintedTeapot, [](vtkMapperScene&) {}, ColorByHeight },
    Look{ "Paint", PaintedTeapot, [](vtkMapperScene&) {},
      [](vtkMapper* mapper) { ColorBy(mapper, "Paint"); } },
    Look{ "MappedPaint", PaintedTeapot, [](vtkMapperScene&) {},
      [](vtkMapper* mapper) {
        ColorBy(mapper, "Paint");
        mapper->SetColorModeToMapScalars();
        mapper->SetScalarRange(0.0, 255.0);
      } },
    Look{ "Magnitude", PaintedTeapot, [](vtkMapperScene&) {},
      [](vtkMapper* mapper) {
        ColorBy(mapper, "Wind");
        mapper->SetScalarRange(0.0, 30.0);
        mapper->CreateDefaultLookupTable();
        mapper->GetLookupTable()->SetVectorModeToMagnitude();
      } },
    Look{ "InterpolatedBeforeMapping", PaintedTeapot, [](vtkMapperScene&) {},
      [](vtkMapper* mapper) {
        ColorByHeight(mapper);
        mapper->InterpolateScalarsBeforeMappingOn();
      } },
    Look{ "Invisible", PaintedTeapot, [](vtkMapperScene&) {},
      [](vtkMapper* mapper) {
        ColorByHeight(mapper);
        mapper->ScalarVisibilityOff();
      } },
    Look{ "NoSuchArray", PaintedTeapot, [](vtkMapperScene&) {},
      [](vtkMapper* mapper) { ColorBy(mapper, "Depth"); } },
    Look{ "ColorsOfBackFaces", PaintedTeapot, ShowBackFaces, ColorByHeight },
    Look{ "ColoredMetal", PaintedTeapot, [](vtkMapperScene& scene) { UsePBR(scene, 0.7, 0.4); },
      ColorByHeight },
    Look{ "TranslucentTable", PaintedTeapot, PeelOpaqueActor, ColorTranslucently, 0.2, Outlines },
    Look{ "TranslucentPaint", PaintedTeapot, PeelOpaqueActor,
      [](vtkMapper* mapper) { ColorBy(mapper, "Glaze"); }, 0.2, Outlines }));

/// Pixels with something drawn in them or in a neighbour.
std::vector<char> Around(vtkImageData* picture, const vtkTestImage::Colour& background, int reach)
{
  const int width = picture->GetDimensions()[0], height = picture->GetDimensions()[1];
  std::vector<char> result(std::size_t(width) * height, 0);
  for (int y = reach; y + reach < height; ++y)
  {
    for (int x = reach; x + reach < width; ++x)
    {
      for (int dy = -reach; dy <= reach; ++dy)
      {
        for (int dx = -reach; dx <= reach; ++dx)
        {
          result[x + y * width] |= vtkTestImage::Pixel(picture, x + dx, y + dy) != background;
        }
      }
    }
  }
  return result;
}

// Lines and points are on the surface, within its trims, and cover a part of it.
class Representations : public testing::TestWithParam<std::tuple<int, bool>>
{};

TEST_P(Representations, AreOnTheSurface)
{
  vtkMapperScene scene(Shape(vtkNURBSShapeSource::CAR_BODY));
  scene.Actor->GetProperty()->SetLighting(std::get<1>(this->GetParam()));
  const vtkTestImage::Colour background = vtkTestImage::Pixel(scene.Picture(), 0, 0);
  const std::vector<char> surface = Around(scene.Picture(), background, 2);
  scene.Actor->GetProperty()->SetRepresentation(std::get<0>(this->GetParam()));
  scene.Actor->GetProperty()->SetPointSize(1.0);
  const std::vector<char> drawn = Around(scene.Picture(), background, 0);
  long outside = 0, pixels = 0, covered = 0;
  for (std::size_t k = 0; k < drawn.size(); ++k)
  {
    outside += drawn[k] && !surface[k];
    pixels += drawn[k];
    covered += surface[k];
  }
  EXPECT_EQ(outside, 0);
  EXPECT_GT(pixels, 10);
  EXPECT_LT(pixels, covered / 2);
  // And back, as before.
  scene.Actor->GetProperty()->SetRepresentationToSurface();
  EXPECT_EQ(Around(scene.Picture(), background, 2), surface);
}

INSTANTIATE_TEST_SUITE_P(Wireframe, Representations,
  testing::Combine(testing::Values(VTK_WIREFRAME, VTK_POINTS), testing::Bool()));

} // namespace
