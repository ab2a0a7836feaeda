// SPDX-License-Identifier: BSD-3-Clause
// What vtkNURBSMapper shows of the exact surface, pixel by pixel, against the CPU's derivatives; samples
// of a pixel; levels while the camera moves.
#include "vtkCamera.h"
#include "vtkColorTransferFunction.h"
#include "vtkMapperScene.h"
#include "vtkNURBSMapper.h"
#include "vtkNURBSShapeSource.h"
#include "vtkNew.h"
#include "vtkProperty.h"
#include "vtkRayReference.h"
#include "vtkRenderer.h"
#include "vtkTestImage.h"
#include "vtk_glew.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>

namespace
{

using Grid = vtkSmartPointer<vtkUnstructuredGrid>;

constexpr int Size = 120;

Grid Shape(int shape)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShape(shape);
  source->SetSheetPoints(12, 12);
  source->Update();
  return source->GetOutput();
}

// White and unlit on blue, so that a pixel's red is what the look makes of it.
struct Scene : vtkMapperScene
{
  explicit Scene(vtkDataObject* model, int samples = 0)
    : vtkMapperScene(model, Size)
  {
    this->Actor->GetProperty()->LightingOff();
    this->Actor->GetProperty()->SetColor(1.0, 1.0, 1.0);
    this->Renderer->SetBackground(0.0, 0.0, 0.5);
    this->Window->SetMultiSamples(samples);
    this->Renderer->GetActiveCamera()->SetPosition(2.0, -3.0, 3.5);
    this->Renderer->GetActiveCamera()->SetFocalPoint(0.0, 0.0, 0.0);
    this->Renderer->GetActiveCamera()->SetViewUp(0.0, 0.0, 1.0);
    this->Renderer->ResetCamera();
  }
};

// Grey levels over a range.
vtkSmartPointer<vtkColorTransferFunction> Greys(double low, double high)
{
  auto table = vtkSmartPointer<vtkColorTransferFunction>::New();
  table->AddRGBPoint(low, 0.0, 0.0, 0.0);
  table->AddRGBPoint(high, 1.0, 1.0, 1.0);
  return table;
}

struct Curvatures
{
  double Mean, Gauss;
};

// By the first and second fundamental forms; the mean is positive on a ball seen from outside.
Curvatures CurvaturesAt(const nurbs::SurfaceView& surface, double u, double v, bool reversed)
{
  const nurbs::SurfaceDerivatives d = nurbs::EvaluateDerivatives(surface, u, v, 2);
  const nurbs::Vec3 n = d.Su.cross(d.Sv).normalized() * (reversed ? -1.0 : 1.0);
  const double e = d.Su.dot(d.Su), f = d.Su.dot(d.Sv), g = d.Sv.dot(d.Sv);
  const double l = d.Suu.dot(n), m = d.Suv.dot(n), k = d.Svv.dot(n);
  const double area = e * g - f * f;
  return { -(e * k - 2.0 * f * m + g * l) / (2.0 * area), (l * k - m * m) / area };
}

// Compares each pixel's grey with a value between 0 and 1 that the ray's hit has. Returns how many
// were compared.
long CompareGreys(Scene& scene, vtkUnstructuredGrid* grid, double tolerance,
  const std::function<double(const nurbs::RayHit&, const nurbs::Ray&)>& value)
{
  const vtkRayReference reference(grid);
  auto image = scene.Picture();
  long compared = 0, wrong = 0;
  std::ostringstream first;
  for (int y = 1; y + 1 < Size; ++y)
  {
    for (int x = 1; x + 1 < Size; ++x)
    {
      const nurbs::Ray ray = reference.PixelRay(scene.Renderer, x + 0.5, y + 0.5);
      nurbs::RayHit hit;
      if (reference.GetCaster().Nearest(ray, hit) && std::abs(hit.Normal.dot(ray.Direction)) > 0.2)
      {
        const double expected = value(hit, ray);
        if (expected >= 0.0)
        {
          ++compared;
          const double grey = vtkTestImage::Pixel(image, x, y)[0] / 255.0;
          if (std::abs(grey - expected) > tolerance && wrong++ == 0)
          {
            first << "pixel " << x << ", " << y << " is " << grey << ", not " << expected;
          }
        }
      }
    }
  }
  EXPECT_EQ(wrong, 0) << "of " << compared << ": " << first.str();
  return compared;
}

class CurvatureLooks : public testing::TestWithParam<int>
{};

TEST_P(CurvatureLooks, AreThoseOfTheFundamentalForms)
{
  for (const int shape : { int(vtkNURBSShapeSource::TORUS), int(vtkNURBSShapeSource::SHEET) })
  {
    Grid model = Shape(shape);
    const vtkRayReference reference(model);
    Scene scene(model);
    const bool isGauss = this->GetParam() == vtkNURBSMapper::GAUSSIAN_CURVATURE;
    const double limit =
      shape == vtkNURBSShapeSource::TORUS ? (isGauss ? 12.0 : 4.0) : (isGauss ? 0.05 : 0.25);
    scene.Mapper->SetLook(this->GetParam());
    scene.Mapper->SetLookTable(Greys(-limit, limit));
    const long compared =
      CompareGreys(scene, model, 2.0 / 255.0, [&](const nurbs::RayHit& hit, const nurbs::Ray&) {
        const nurbs::Face& face = reference.GetFace(hit.Face);
        const Curvatures c = CurvaturesAt(face.Geometry, hit.U, hit.V, face.Reversed);
        const double root = std::sqrt(std::max(c.Mean * c.Mean - c.Gauss, 0.0));
        const double values[] = { 0.0, c.Mean, c.Gauss, c.Mean - root, c.Mean + root };
        return std::clamp((values[this->GetParam()] + limit) / (2.0 * limit), 0.0, 1.0);
      });
    EXPECT_GT(compared, 1500);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, CurvatureLooks,
  testing::Range<int>(vtkNURBSMapper::MEAN_CURVATURE, vtkNURBSMapper::ZEBRA));

TEST(Looks, MeanCurvatureOfABallIsItsInverseRadius)
{
  Grid model = Shape(vtkNURBSShapeSource::SPHERE);
  Scene scene(model);
  scene.Mapper->SetLook(vtkNURBSMapper::MEAN_CURVATURE);
  scene.Mapper->SetLookTable(Greys(0.0, 2.0));
  EXPECT_GT(CompareGreys(scene, model, 1.1 / 255.0,
              [](const nurbs::RayHit&, const nurbs::Ray&) { return 0.5; }),
    3000);
}

TEST(Looks, DraftAngleIsThatOfSurfaceAndDirection)
{
  Grid model = Shape(vtkNURBSShapeSource::TORUS);
  Scene scene(model);
  scene.Mapper->SetLook(vtkNURBSMapper::DRAFT_ANGLE);
  scene.Mapper->SetLookTable(Greys(-90.0, 90.0));
  scene.Mapper->SetLookDirection(0.0, 2.0, 2.0);
  EXPECT_GT(CompareGreys(scene, model, 1.5 / 255.0,
              [](const nurbs::RayHit& hit, const nurbs::Ray&) {
                const double sine = hit.Normal.dot(nurbs::Vec3(0.0, 1.0, 1.0).normalized());
                return 0.5 + std::asin(std::clamp(sine, -1.0, 1.0)) / M_PI;
              }),
    2000);
}

// Stripes are black or white but near their borders, where they are grey.
double Stripe(double cosine, int stripes)
{
  const double phase = 0.5 * std::acos(std::clamp(cosine, -1.0, 1.0)) / M_PI * stripes;
  const double place = phase - std::floor(phase);
  const double border = std::min({ std::abs(place - 0.25), std::abs(place - 0.75) });
  return border < 0.12 ? -1.0 : place < 0.25 || place > 0.75 ? 1.0 : 0.0;
}

// Where stripes are finer than a few pixels.
bool IsSteep(const nurbs::RayHit& hit, const nurbs::Ray& ray)
{
  return std::abs(hit.Normal.dot(ray.Direction)) < 0.5;
}

TEST(Looks, IsophotesAndZebraStripes)
{
  Grid model = Shape(vtkNURBSShapeSource::SPHERE);
  Scene scene(model);
  scene.Mapper->SetNumberOfStripes(8);
  scene.Mapper->SetLook(vtkNURBSMapper::ISOPHOTES);
  EXPECT_GT(CompareGreys(scene, model, 0.02,
              [](const nurbs::RayHit& hit, const nurbs::Ray& ray) {
                return IsSteep(hit, ray) ? -1.0 : Stripe(hit.Normal.z(), 8);
              }),
    1000);
  scene.Mapper->SetLook(vtkNURBSMapper::ZEBRA);
  EXPECT_GT(CompareGreys(scene, model, 0.02,
              [](const nurbs::RayHit& hit, const nurbs::Ray& ray) {
                const nurbs::Vec3 mirrored =
                  ray.Direction - 2.0 * ray.Direction.dot(hit.Normal) * hit.Normal;
                return IsSteep(hit, ray) ? -1.0 : Stripe(mirrored.z(), 8);
              }),
    1000);
}

TEST(Looks, IsoLinesAndEdgesAreAsWideAsAsked)
{
  // A plate of 4 x 3 seen from above, 40 pixels a unit of length.
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShape(vtkNURBSShapeSource::PLATE);
  source->SetPlateHoles(0, 0);
  source->Update();
  Scene scene(source->GetOutput());
  vtkCamera* camera = scene.Renderer->GetActiveCamera();
  camera->ParallelProjectionOn();
  camera->SetPosition(2.0, 1.5, 5.0);
  camera->SetFocalPoint(2.0, 1.5, 0.0);
  camera->SetViewUp(0.0, 1.0, 0.0);
  camera->SetParallelScale(2.0);
  scene.Renderer->ResetCameraClippingRange();
  const auto blackness = [&] {
    auto image = scene.Picture();
    double sum = 0.0;
    for (int k = 0; k < Size * Size; ++k)
    {
      const vtkTestImage::Colour c = vtkTestImage::Pixel(image, k % Size, k / Size);
      sum += c[0] == 0 && c[2] > 100 ? 0.0 : 1.0 - c[0] / 255.0;
    }
    return sum;
  };
  scene.Actor->GetProperty()->SetEdgeColor(0.0, 0.0, 0.0);
  const double scale = Size / 4.0; // pixels a unit
  EXPECT_EQ(blackness(), 0.0);
  // Three lines across and two along inside, and half of each border's line.
  scene.Mapper->SetNumberOfIsoLines(4, 3);
  scene.Actor->GetProperty()->SetLineWidth(2.0);
  const double length = scale * (3 * 3.0 + 2 * 4.0 + 0.5 * 14.0);
  EXPECT_NEAR(blackness(), 2.0 * length, 0.06 * 2.0 * length);
  // Edges alone: the outline's inner half.
  scene.Mapper->SetNumberOfIsoLines(0, 0);
  scene.Actor->GetProperty()->EdgeVisibilityOn();
  scene.Actor->GetProperty()->SetLineWidth(4.0);
  EXPECT_NEAR(blackness(), 2.0 * scale * 14.0, 0.08 * 2.0 * scale * 14.0);
}

// How much of a pixel the model covers, by rays through a grid of places.
double Coverage(const vtkRayReference& reference, vtkRenderer* renderer, int x, int y)
{
  constexpr int Grid = 8;
  int covered = 0;
  for (int k = 0; k < Grid * Grid; ++k)
  {
    const nurbs::Ray ray =
      reference.PixelRay(renderer, x + (k % Grid + 0.5) / Grid, y + (k / Grid + 0.5) / Grid);
    covered += reference.GetCaster().IsBlocked(ray);
  }
  return double(covered) / (Grid * Grid);
}

TEST(Samples, CoverPixelsAsTheSurfaceDoes)
{
  // Trims of the plate, and outlines of the torus: neither steps nor gaps.
  for (const int shape : { int(vtkNURBSShapeSource::PLATE), int(vtkNURBSShapeSource::TORUS) })
  {
    Grid model = Shape(shape);
    const vtkRayReference reference(model);
    Scene scene(model, 4);
    scene.Window->Initialize();
    if (!GLEW_ARB_sample_shading)
    {
      GTEST_SKIP() << "this device's fragments can't choose samples";
    }
    auto image = scene.Picture();
    double sum = 0.0, worst = 0.0;
    long partly = 0;
    for (int y = 1; y + 1 < Size; ++y)
    {
      for (int x = 1; x + 1 < Size; ++x)
      {
        const double coverage = Coverage(reference, scene.Renderer, x, y);
        if (coverage > 0.0 && coverage < 1.0)
        {
          const double error = vtkTestImage::Pixel(image, x, y)[0] / 255.0 - coverage;
          ++partly;
          sum += std::abs(error);
          worst = std::max(worst, std::abs(error));
        }
      }
    }
    std::printf("shape %d: %ld pixels are covered in part, mean error %.3f, largest %.3f\n", shape,
      partly, sum / partly, worst);
    EXPECT_GT(partly, 200);
    // Four samples know quarters: on the average they are off by an eighth at most.
    EXPECT_LT(sum / partly, 0.125);
    EXPECT_LT(worst, 0.55);
  }
}

TEST(FrameRate, LevelsFallWhileTheCameraMovesAndRiseWhenItStops)
{
  Grid model = Shape(vtkNURBSShapeSource::TEAPOT);
  Scene scene(model);
  auto still = scene.Picture();
  const vtkIdType evaluated = scene.Mapper->GetNumberOfEvaluatedVertices();
  scene.Mapper->SetInteractiveFrameRate(1e9); // out of any GPU's reach
  scene.Window->SetDesiredUpdateRate(15.0);
  double last = 0.0;
  auto before = scene.Picture();
  double jump = 0.0;
  for (int frame = 0; frame < 12; ++frame)
  {
    auto now = scene.Picture();
    EXPECT_LE(scene.Mapper->GetCoarserLevels() - last, 0.2501);
    last = scene.Mapper->GetCoarserLevels();
    jump = std::max(jump, vtkTestImage::MeanDifference(before, now));
    before = now;
  }
  EXPECT_GT(last, 0.2);
  // Nothing was evaluated again, and no step between frames changed much (0 to 255 a pixel).
  EXPECT_EQ(scene.Mapper->GetNumberOfEvaluatedVertices(), evaluated);
  EXPECT_LT(jump, 2.0);
  scene.Window->SetDesiredUpdateRate(0.0001);
  EXPECT_EQ(vtkTestImage::MeanDifference(still, scene.Picture()), 0.0);
  EXPECT_EQ(scene.Mapper->GetCoarserLevels(), 0.0);
}

TEST(Tessellation, DrawsTheSamePicture)
{
  Grid model = Shape(vtkNURBSShapeSource::TEAPOT);
  Scene scene(model);
  scene.Actor->GetProperty()->LightingOn();
  auto exact = scene.Picture();
  EXPECT_FALSE(scene.Mapper->GetDrawsTessellation());
  scene.Mapper->UseTessellationOn();
  auto triangles = scene.Picture();
  EXPECT_TRUE(scene.Mapper->GetDrawsTessellation());
  EXPECT_GT(scene.Mapper->GetNumberOfTriangles(), 100);
  EXPECT_LT(vtkTestImage::MeanDifference(exact, triangles), 1.5);
}

} // namespace
