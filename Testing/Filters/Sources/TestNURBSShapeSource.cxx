// SPDX-License-Identifier: BSD-3-Clause
// The shapes against closed forms: points, areas, loops that close, edges that fit their faces.
#include "../../testMessageKeeper.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"
#include "vtkNURBSShapeSource.h"

#include "vtkExecutive.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace
{

constexpr double Pi = 3.14159265358979323846;

using Grid = vtkSmartPointer<vtkUnstructuredGrid>;

Grid Make(vtkNURBSShapeSource* source)
{
  source->Update();
  return source->GetOutput();
}

Grid Make(int shape)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShape(shape);
  return Make(source);
}

/// Calls body(point, normal) on a grid of parameters of the face, its boundary included.
template <typename Body>
void ForPoints(const nurbs::Face& face, const Body& body)
{
  const nurbs::Interval u = face.Geometry.Domain(0), v = face.Geometry.Domain(1);
  for (int j = 0; j <= 17; ++j)
  {
    for (int i = 0; i <= 23; ++i)
    {
      const double s = u.Min + u.Length() * i / 23, t = v.Min + v.Length() * j / 17;
      body(nurbs::Evaluate(face.Geometry, s, t), nurbs::Normal(face.Geometry, s, t));
    }
  }
}

nurbs::Vec2 TrimPoint(const nurbs::TrimCurve& curve, double part)
{
  const nurbs::Interval range = curve.Geometry.Domain();
  const double s = curve.Reversed ? 1.0 - part : part;
  return nurbs::Evaluate(curve.Geometry, range.Min + s * range.Length());
}

/// Largest gap between consecutive curves of all loops, in the parameter domain.
double LargestGap(const nurbs::Model& model)
{
  double largest = 0.0;
  for (const nurbs::TrimLoop& loop : model.Loops)
  {
    for (std::int64_t c = 0; c < loop.CurveCount; ++c)
    {
      const auto& curve = model.TrimCurves[loop.FirstCurve + c];
      const auto& next = model.TrimCurves[loop.FirstCurve + (c + 1) % loop.CurveCount];
      largest = std::max(largest, (TrimPoint(curve, 1) - TrimPoint(next, 0)).norm());
    }
  }
  return largest;
}

/// Every lifted trim curve lies within the tolerance of its edge at the same parameter.
void ExpectEdgesFit(const nurbs::Model& model)
{
  for (const nurbs::Face& face : model.Faces)
  {
    for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
    {
      const nurbs::TrimLoop& loop = model.Loops[l];
      for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
      {
        const nurbs::TrimCurve& curve = model.TrimCurves[c];
        ASSERT_GE(curve.Edge, 0);
        const nurbs::Edge& edge = model.Edges[curve.Edge];
        const nurbs::Interval a = curve.Geometry.Domain(), b = edge.Geometry.Domain();
        for (int i = 0; i <= 40; ++i)
        {
          const double part = i / 40.0;
          const nurbs::Vec2 uv = nurbs::Evaluate(curve.Geometry, a.Min + part * a.Length());
          const nurbs::Vec3 lifted = nurbs::Evaluate(face.Geometry, uv[0], uv[1]);
          const nurbs::Vec3 own = edge.Geometry.Degree == 0
            ? edge.Geometry.Point(0)
            : nurbs::Evaluate(edge.Geometry, b.Min + part * b.Length());
          ASSERT_LE((lifted - own).norm(), edge.Tolerance)
            << "edge " << curve.Edge << " at " << part << " of face " << face.FaceId;
        }
      }
    }
  }
}

/// How often each edge is used, poles left out.
std::map<std::int64_t, int> EdgeUses(const nurbs::Model& model)
{
  std::map<std::int64_t, int> uses;
  for (const nurbs::TrimCurve& curve : model.TrimCurves)
  {
    uses[curve.Edge] += model.Edges[curve.Edge].Geometry.Degree > 0 ? 1 : 0;
  }
  return uses;
}

int OpenEdges(const nurbs::Model& model)
{
  int open = 0;
  for (const auto& use : EdgeUses(model))
  {
    open += use.second == 1 ? 1 : 0;
  }
  return open;
}

/// Area inside a loop in the parameter plane, by Simpson's rule on many pieces; signed.
double LoopArea(const nurbs::Model& model, const nurbs::TrimLoop& loop)
{
  constexpr int Pieces = 4000;
  double area = 0.0;
  for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
  {
    nurbs::Vec2 from = TrimPoint(model.TrimCurves[c], 0);
    for (int i = 1; i <= Pieces; ++i)
    {
      const nurbs::Vec2 middle = TrimPoint(model.TrimCurves[c], (i - 0.5) / Pieces);
      const nurbs::Vec2 to = TrimPoint(model.TrimCurves[c], static_cast<double>(i) / Pieces);
      const auto cross = [](const nurbs::Vec2& a, const nurbs::Vec2& b) {
        return a[0] * b[1] - a[1] * b[0];
      };
      // Exact for a piece that is a parabola through the three points.
      area += (4.0 * cross(from, middle) + 4.0 * cross(middle, to) - cross(from, to)) / 6.0;
      from = to;
    }
  }
  return area;
}

/// Area of an untrimmed face by Gauss' rule with 5 points a direction on 16 x 16 pieces of each
/// knot span's patch.
double SurfaceArea(const nurbs::SurfaceView& surface)
{
  const double r = 2.0 * std::sqrt(10.0 / 7.0);
  const double places[5] = { -std::sqrt(5.0 + r) / 3.0, -std::sqrt(5.0 - r) / 3.0, 0.0,
    std::sqrt(5.0 - r) / 3.0, std::sqrt(5.0 + r) / 3.0 };
  const double s = 13.0 * std::sqrt(70.0);
  const double weights[5] = { (322.0 - s) / 900.0, (322.0 + s) / 900.0, 128.0 / 225.0,
    (322.0 + s) / 900.0, (322.0 - s) / 900.0 };
  const nurbs::Interval u = surface.Domain(0), v = surface.Domain(1);
  const int pieces = 16;
  double area = 0.0;
  for (int j = 0; j < 5 * pieces; ++j)
  {
    for (int i = 0; i < 5 * pieces; ++i)
    {
      const double x = (i / 5 + 0.5 + 0.5 * places[i % 5]) / pieces;
      const double y = (j / 5 + 0.5 + 0.5 * places[j % 5]) / pieces;
      const nurbs::SurfaceDerivatives d =
        nurbs::EvaluateDerivatives(surface, u.Min + x * u.Length(), v.Min + y * v.Length(), 1);
      area += weights[i % 5] * weights[j % 5] * d.Su.cross(d.Sv).norm();
    }
  }
  return area * u.Length() * v.Length() / (4.0 * pieces * pieces);
}

TEST(ShapeSource, EveryShapeIsValidClosedAndFitsItsEdges)
{
  for (int shape = vtkNURBSShapeSource::SPHERE; shape <= vtkNURBSShapeSource::SPRING; ++shape)
  {
    SCOPED_TRACE(shape);
    const Grid grid = Make(shape);
    EXPECT_GT(grid->GetNumberOfCells(), 0);
    EXPECT_EQ(vtkNURBSModel::Validate(grid), "");
    const auto view = vtkNURBSModel::View(grid);
    EXPECT_LT(LargestGap(view->GetModel()), 1e-14);
    ExpectEdgesFit(view->GetModel());
    EXPECT_EQ(vtkNURBSModel::GetLengthUnit(grid), "mm");
  }
}

TEST(ShapeSource, SphereIsExact)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShapeToSphere();
  source->SetRadius(2.5);
  const auto view = vtkNURBSModel::View(Make(source));
  const nurbs::Model& model = view->GetModel();
  ForPoints(model.Faces[0], [](const nurbs::Vec3& p, const nurbs::Vec3& n) {
    EXPECT_NEAR(p.norm(), 2.5, 1e-12);
    EXPECT_NEAR((n - p / 2.5).norm(), 0.0, 1e-9); // Outwards, at the poles too.
  });
  EXPECT_NEAR(SurfaceArea(model.Faces[0].Geometry), 4.0 * Pi * 2.5 * 2.5, 1e-8);
  EXPECT_EQ(OpenEdges(model), 0);
  EXPECT_EQ(model.Edges.size(), 3u); // Two poles and the seam.
  EXPECT_EQ(model.Vertices.size(), 2u);
}

TEST(ShapeSource, TorusIsExact)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShapeToTorus();
  source->SetRadius(3.0);
  source->SetTubeRadius(1.0);
  const auto view = vtkNURBSModel::View(Make(source));
  const nurbs::Model& model = view->GetModel();
  ForPoints(model.Faces[0], [](const nurbs::Vec3& p, const nurbs::Vec3& n) {
    const nurbs::Vec3 ring = 3.0 * nurbs::Vec3(p[0], p[1], 0.0).normalized();
    EXPECT_NEAR((p - ring).norm(), 1.0, 1e-12);
    EXPECT_NEAR((n - (p - ring)).norm(), 0.0, 1e-12);
  });
  EXPECT_NEAR(SurfaceArea(model.Faces[0].Geometry), 4.0 * Pi * Pi * 3.0, 1e-8);
  EXPECT_EQ(OpenEdges(model), 0);
  EXPECT_EQ(model.Edges.size(), 2u);
  EXPECT_EQ(model.Vertices.size(), 1u);
}

TEST(ShapeSource, CylinderIsAnExactSolid)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShapeToCylinder();
  source->SetRadius(1.5);
  source->SetHeight(4.0);
  const auto view = vtkNURBSModel::View(Make(source));
  const nurbs::Model& model = view->GetModel();
  ASSERT_EQ(model.Faces.size(), 3u);
  ForPoints(model.Faces[0], [](const nurbs::Vec3& p, const nurbs::Vec3& n) {
    EXPECT_NEAR(std::hypot(p[0], p[1]), 1.5, 1e-12);
    EXPECT_NEAR((n - nurbs::Vec3(p[0], p[1], 0.0) / 1.5).norm(), 0.0, 1e-12);
  });
  EXPECT_NEAR(SurfaceArea(model.Faces[0].Geometry), 2.0 * Pi * 1.5 * 4.0, 1e-10);
  EXPECT_EQ(OpenEdges(model), 0);
  for (int cap = 1; cap < 3; ++cap)
  {
    EXPECT_NEAR(LoopArea(model, model.Loops[cap]), Pi * 1.5 * 1.5, 1e-10);
  }
  EXPECT_TRUE(model.Faces[1].Reversed); // The bottom looks down, against its own normal.
  EXPECT_FALSE(model.Faces[2].Reversed);
  source->CappingOff();
  EXPECT_EQ(OpenEdges(vtkNURBSModel::View(Make(source))->GetModel()), 2);
}

TEST(ShapeSource, ConeIsAnExactSolid)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShapeToCone();
  source->SetRadius(1.0);
  source->SetHeight(3.0);
  const auto view = vtkNURBSModel::View(Make(source));
  const nurbs::Model& model = view->GetModel();
  ASSERT_EQ(model.Faces.size(), 2u);
  ForPoints(model.Faces[0], [](const nurbs::Vec3& p, const nurbs::Vec3& n) {
    EXPECT_NEAR(std::hypot(p[0], p[1]), 1.0 - p[2] / 3.0, 1e-12);
    EXPECT_NEAR(n[2], 1.0 / std::sqrt(10.0), 1e-7);
  });
  EXPECT_NEAR(SurfaceArea(model.Faces[0].Geometry), Pi * std::sqrt(10.0), 1e-10);
  EXPECT_EQ(OpenEdges(model), 0);
  EXPECT_EQ(model.Edges[2].Geometry.Degree, 0); // The apex.
}

TEST(ShapeSource, DiscAndPlateHaveTheirAreas)
{
  const auto disc = vtkNURBSModel::View(Make(vtkNURBSShapeSource::DISC));
  EXPECT_NEAR(LoopArea(disc->GetModel(), disc->GetModel().Loops[0]), Pi, 1e-12);

  vtkNew<vtkNURBSShapeSource> source;
  source->SetShapeToPlate();
  source->SetPlateHoles(5, 2);
  const auto plate = vtkNURBSModel::View(Make(source));
  double area = 0.0;
  for (const nurbs::TrimLoop& loop : plate->GetModel().Loops)
  {
    area += LoopArea(plate->GetModel(), loop);
  }
  // 10 holes, 4 islands in holes 0, 3, 6, 9, 2 holes in islands 0 and 6.
  EXPECT_EQ(plate->GetModel().Loops.size(), 17u);
  EXPECT_NEAR(area, source->GetPlateArea(), 1e-10);
  EXPECT_LT(area, 12.0);
}

TEST(ShapeSource, TeapotHasItsPatchesBoundsAndSharedEdges)
{
  const Grid grid = Make(vtkNURBSShapeSource::TEAPOT);
  const auto view = vtkNURBSModel::View(grid);
  const nurbs::Model& model = view->GetModel();
  ASSERT_EQ(model.Faces.size(), 32u);
  const double* bounds = grid->GetBounds(); // Of the control points.
  const double expected[6] = { -3.0, 3.525, -2.0, 2.0, 0.0, 3.15 };
  for (int i = 0; i < 6; ++i)
  {
    EXPECT_DOUBLE_EQ(bounds[i], expected[i]);
  }
  // Open: four quarters each of the inner rim and of the lid, and the two ends of handle and spout
  // in two halves each.
  EXPECT_EQ(OpenEdges(model), 4 + 4 + 4 + 4);
  EXPECT_EQ(EdgeUses(model).size(), model.Edges.size());
  // Outsides agree: they look away from the axis, or from the middle of handle and spout.
  for (const nurbs::Face& face : model.Faces)
  {
    const nurbs::Vec3 p = nurbs::Evaluate(face.Geometry, 0.5, 0.5);
    const nurbs::Vec3 n = nurbs::Normal(face.Geometry, 0.5, 0.5) * (face.Reversed ? -1.0 : 1.0);
    const nurbs::Vec3 inside(face.FaceId < 24 ? 0.0 : p[0], 0.0, p[2]);
    if (face.FaceId >= 4) // The rim turns over.
    {
      EXPECT_GT(n.dot(p - inside), 0.0) << "face " << face.FaceId;
    }
  }
}

TEST(ShapeSource, SheetOfEveryDegree)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShapeToSheet();
  for (int degree = 1; degree <= 25; ++degree)
  {
    source->SetSheetDegree(degree, 26 - degree);
    source->SetSheetPoints(degree + 5, 40);
    source->SetSheetRational(degree % 2 == 0);
    const Grid grid = Make(source);
    EXPECT_EQ(vtkNURBSModel::Validate(grid), "") << "degree " << degree;
    const auto view = vtkNURBSModel::View(grid);
    const nurbs::SurfaceView& sheet = view->GetModel().Faces[0].Geometry;
    EXPECT_EQ(sheet.Degree[0], degree);
    EXPECT_EQ(sheet.Degree[1], 26 - degree);
    if (degree % 2 == 1) // Greville's abscissae make x and y linear.
    {
      const nurbs::Vec3 p = nurbs::Evaluate(sheet, 0.3, 0.6);
      EXPECT_NEAR(p[0], 30.0, 1e-11);
      EXPECT_NEAR(p[1], 60.0, 1e-11);
    }
  }
}

TEST(ShapeSource, CarBodyHasAnyNumberOfFacesThatShareEdges)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShapeToCarBody();
  for (const int count : { 1, 2, 3, 10, 777, 8036 })
  {
    source->SetNumberOfPatches(count);
    const Grid grid = Make(source);
    ASSERT_EQ(grid->GetNumberOfCells(), count);
    EXPECT_EQ(vtkNURBSModel::Validate(grid), "");
    if (count >= 777)
    {
      const auto view = vtkNURBSModel::View(grid);
      int shared = 0, single = 0;
      for (const auto& use : EdgeUses(view->GetModel()))
      {
        EXPECT_LE(use.second, 2);
        ++(use.second == 2 ? shared : single);
      }
      // Inner boundaries and plugs are shared; holes and the outer rim are not.
      EXPECT_GT(shared, 1.6 * count);
      EXPECT_GT(single, 0);
      const std::size_t loops = view->GetModel().Loops.size();
      EXPECT_GT(loops, 2.2 * count);
      EXPECT_LT(loops, 3.2 * count);
    }
  }
}

TEST(ShapeSource, ImpossibleShapesAreErrors)
{
  vtkNew<MessageKeeper> keeper, pipeline;
  vtkNew<vtkNURBSShapeSource> source;
  source->AddObserver(vtkCommand::ErrorEvent, keeper);
  source->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, pipeline);
  source->SetShapeToTorus();
  source->SetRadius(1.0);
  source->SetTubeRadius(1.0);
  source->Update();
  EXPECT_TRUE(keeper->Says("tube radius")) << keeper->Text;
  EXPECT_EQ(source->GetOutput()->GetNumberOfCells(), 0);

  for (const int degree : { 0, 26 })
  {
    keeper->Text.clear();
    source->SetShapeToSheet();
    source->SetSheetDegree(degree, 3);
    source->Update();
    EXPECT_TRUE(keeper->Says("degree")) << keeper->Text;
  }
}

} // namespace
