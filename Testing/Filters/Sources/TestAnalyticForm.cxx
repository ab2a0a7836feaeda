// SPDX-License-Identifier: BSD-3-Clause
// Surfaces of OpenCASCADE made NURBS, and recognised again; parts that are the same.
#include "AnalyticForm.h"
#include "CurveConverter.h"
#include "SamePart.h"
#include "SurfaceConverter.h"

#include <BRepBuilderAPI_MakeFace.hxx>
#include <Eigen/Geometry>
#include <Geom_Circle.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Line.hxx>
#include <Geom_Plane.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <TopoDS.hxx>
#include <gp_Pln.hxx>

#include <gtest/gtest.h>

#include <cmath>

using namespace nurbs;

namespace
{

constexpr double Pi = 3.14159265358979323846;

struct Sample
{
  const char* Name;
  Handle(Geom_Surface) Surface;
  Interval U, V;
};

std::vector<Sample> Samples()
{
  const gp_Ax3 frame(gp_Pnt(3.0, -40.0, 7.0), gp_Dir(0.3, -0.5, 0.8), gp_Dir(0.9, 0.1, 0.2));
  const Interval turn{ 0.0, 2.0 * Pi };
  return { { "plane", new Geom_Plane(frame), { -1.0, 5.0 }, { 2.0, 2.5 } },
    { "tube", new Geom_CylindricalSurface(frame, 2.5), turn, { -3.0, 8.0 } },
    { "fillet", new Geom_CylindricalSurface(frame, 0.01), { 1.0, 2.2 }, { 0.0, 30.0 } },
    { "funnel", new Geom_ConicalSurface(frame, 0.4, 1.0), { 0.5, 6.0 }, { 0.5, 4.0 } },
    { "narrowing", new Geom_ConicalSurface(frame, -0.4, 9.0), turn, { 0.5, 4.0 } },
    { "to the apex", new Geom_ConicalSurface(frame, Pi / 4.0, 1.0), turn,
      { -std::sqrt(2.0), 3.0 } },
    { "ball", new Geom_SphericalSurface(frame, 12.0), turn, { -0.5 * Pi, 0.5 * Pi } },
    { "cap", new Geom_SphericalSurface(frame, 12.0), { 3.0, 7.0 }, { 0.2, 1.2 } },
    { "ring", new Geom_ToroidalSurface(frame, 7.0, 2.0), turn, turn },
    { "elbow", new Geom_ToroidalSurface(frame, 7.0, 2.0), { 1.0, 1.5 }, { 2.0, 7.0 } },
    { "apple", new Geom_ToroidalSurface(frame, 3.0, 8.0), { 1.0, 3.5 }, { -1.0, 1.5 } },
    { "lemon", new Geom_ToroidalSurface(frame, 3.0, 8.0), { 1.0, 3.5 }, { 2.2, 3.9 } } };
}

/// u and v exchanged.
Surface Transposed(const Surface& surface)
{
  Surface out = surface;
  for (int dir = 0; dir < 2; ++dir)
  {
    out.Degree[dir] = surface.Degree[1 - dir];
    out.Count[dir] = surface.Count[1 - dir];
    out.Knots[dir] = surface.Knots[1 - dir];
  }
  for (int k = 0; k < surface.Count[0] * surface.Count[1]; ++k)
  {
    const int from = k / out.Count[0] + (k % out.Count[0]) * surface.Count[0];
    out.Points[k] = surface.Points[from];
    if (!surface.Weights.empty())
    {
      out.Weights[k] = surface.Weights[from];
    }
  }
  return out;
}

/// u runs the other way.
Surface Backwards(const Surface& surface)
{
  Surface out = surface;
  const Interval u = surface.View().Domain(0);
  for (double& knot : out.Knots[0])
  {
    knot = u.Min + u.Max - knot;
  }
  std::reverse(out.Knots[0].begin(), out.Knots[0].end());
  for (int j = 0; j < out.Count[1]; ++j)
  {
    const int row = j * out.Count[0];
    std::reverse(out.Points.begin() + row, out.Points.begin() + row + out.Count[0]);
    if (!out.Weights.empty())
    {
      std::reverse(out.Weights.begin() + row, out.Weights.begin() + row + out.Count[0]);
    }
  }
  return out;
}

void ExpectRecognised(const Surface& surface, const Handle(Geom_Surface) & original, double scale)
{
  const SurfaceView view = surface.View();
  const auto form = AnalyticSurface::Recognise(view, scale);
  ASSERT_TRUE(form);
  EXPECT_EQ(form->GetGeometry()->DynamicType(), original->DynamicType());
  for (int k = 0; k < 36; ++k)
  {
    const Interval u = view.Domain(0), v = view.Domain(1);
    const Vec2 at(
      u.Min + u.Length() * (k % 6 + 0.1) / 5.3, v.Min + v.Length() * (k / 6 + 0.1) / 5.3);
    const Vec3 expected = scale * Evaluate(view, at[0], at[1]);
    double x = 0.0, y = 0.0;
    if (form->IsPlane())
    {
      const gp_Ax3& frame = form->GetGeometry()->Position();
      const gp_Vec from(frame.Location(), gp_Pnt(expected[0], expected[1], expected[2]));
      x = from.Dot(frame.XDirection());
      y = from.Dot(frame.YDirection());
    }
    else
    {
      const Vec2 parameters = form->Parameters(at);
      x = parameters[0];
      y = parameters[1];
      EXPECT_GT(x, -1e-9);
      EXPECT_LT(x, 2.0 * Pi + 1e-9);
    }
    gp_Pnt p;
    gp_Vec du, dv;
    form->GetGeometry()->D1(x, y, p, du, dv);
    const Vec3 off = Vec3(p.X(), p.Y(), p.Z()) - expected;
    EXPECT_LT(off.norm(), 1e-12 * scale * 100.0);
    const gp_Vec normal = du.Crossed(dv);
    const Vec3 own = Normal(view, at[0], at[1]);
    const double side = own.dot(Vec3(normal.X(), normal.Y(), normal.Z()));
    EXPECT_EQ(side < 0.0, form->IsMirrored());
  }
}

} // namespace

TEST(AnalyticForm, ElementarySurfacesAreRecognised)
{
  for (const Sample& sample : Samples())
  {
    SCOPED_TRACE(sample.Name);
    double error = 0.0;
    const Surface surface =
      SurfaceConverter(sample.Surface, 1e-7).Convert(sample.U, sample.V, error);
    for (const double scale : { 1.0, 25.4 })
    {
      ExpectRecognised(surface, sample.Surface, scale);
      ExpectRecognised(Transposed(surface), sample.Surface, scale);
      ExpectRecognised(Backwards(surface), sample.Surface, scale);
      ExpectRecognised(Transposed(Backwards(surface)), sample.Surface, scale);
      ExpectRecognised(Backwards(Transposed(surface)), sample.Surface, scale);
    }
    // The same surface with more control points.
    const Interval u = surface.View().Domain(0), v = surface.View().Domain(1);
    const Surface finer =
      RefineKnots(ElevateDegree(surface.View(), 1, 1).View(), 0, { u.Min + 0.3 * u.Length() });
    ExpectRecognised(finer, sample.Surface, 1.0);
    // A part of it.
    ExpectRecognised(Restrict(surface.View(), { u.Min + 0.1 * u.Length(), u.Max },
                       { v.Min, v.Min + 0.6 * v.Length() }),
      sample.Surface, 1.0);
  }
}

TEST(AnalyticForm, NearlyIsNot)
{
  for (const Sample& sample : Samples())
  {
    SCOPED_TRACE(sample.Name);
    double error = 0.0;
    const Surface surface =
      SurfaceConverter(sample.Surface, 1e-7).Convert(sample.U, sample.V, error);
    ASSERT_TRUE(AnalyticSurface::Recognise(surface.View(), 1.0));
    for (const std::size_t k : { std::size_t(0), surface.Points.size() / 2 })
    {
      Surface bent = surface;
      bent.Points[k] += Vec3(1e-8, 2e-8, -1.5e-8);
      EXPECT_FALSE(AnalyticSurface::Recognise(bent.View(), 1.0)) << k;
      if (!bent.Weights.empty())
      {
        bent.Points[k] = surface.Points[k];
        bent.Weights[k] *= 1.0 + 1e-6;
        EXPECT_FALSE(AnalyticSurface::Recognise(bent.View(), 1.0)) << k;
      }
    }
    // Sheared, only planes stay what they are.
    Surface sheared = surface;
    for (Vec3& p : sheared.Points)
    {
      p[0] += 0.1 * p[1];
    }
    EXPECT_EQ(AnalyticSurface::Recognise(sheared.View(), 1.0).has_value(),
      sample.Surface->IsKind(STANDARD_TYPE(Geom_Plane)));
  }
}

TEST(AnalyticForm, PatchesThatFoldInAPlaneStayPatches)
{
  Surface patch;
  patch.Count[0] = patch.Count[1] = 2;
  patch.Knots[0] = patch.Knots[1] = { 0.0, 0.0, 1.0, 1.0 };
  patch.Points = { { 0, 0, 1 }, { 1, 0, 1 }, { 0, 1, 1 }, { 2, 3, 1 } };
  ASSERT_TRUE(AnalyticSurface::Recognise(patch.View(), 1.0));
  patch.Points[3] = { 0.2, -2.0, 1.0 };
  EXPECT_FALSE(AnalyticSurface::Recognise(patch.View(), 1.0));
  // Over so small a part of the domain that samples miss it: the Jacobian is negative at one corner.
  patch.Points = { { 3.9, 3.9, 0 }, { 7, 0, 0 }, { 0, 7, 0 }, { 7, 7, 0 } };
  EXPECT_FALSE(AnalyticSurface::Recognise(patch.View(), 1.0));
  patch.Points[0] = { 3.1, 3.1, 0 };
  EXPECT_TRUE(AnalyticSurface::Recognise(patch.View(), 1.0));
  // The Jacobian is 0 at one of 4 by 4 places in the middle of cells.
  patch.Points[0] = { 4, 4, 0 };
  EXPECT_FALSE(AnalyticSurface::Recognise(patch.View(), 1.0));
}

TEST(AnalyticForm, CornersAndRowsWithoutANormalMakeNoFold)
{
  // A triangle, as a patch with a side that is a point, and a disc, whose corners are flat.
  Surface patch;
  patch.Count[0] = patch.Count[1] = 2;
  patch.Knots[0] = patch.Knots[1] = { 0.0, 0.0, 1.0, 1.0 };
  patch.Points = { { 0, 0, 1 }, { 1, 0, 1 }, { 0.3, 0.7, 1 }, { 0.3, 0.7, 1 } };
  EXPECT_TRUE(AnalyticSurface::Recognise(patch.View(), 1.0));
  const double w = std::sqrt(0.5);
  patch.Degree[0] = patch.Degree[1] = 2;
  patch.Count[0] = patch.Count[1] = 3;
  patch.Knots[0] = patch.Knots[1] = { 0.0, 0.0, 0.0, 1.0, 1.0, 1.0 };
  patch.Points = { { -w, -w, 0 }, { 0, -2 * w, 0 }, { w, -w, 0 }, { -2 * w, 0, 0 }, { 0, 0, 0 },
    { 2 * w, 0, 0 }, { -w, w, 0 }, { 0, 2 * w, 0 }, { w, w, 0 } };
  patch.Weights = { 1, w, 1, w, 1, w, 1, w, 1 };
  ExpectRecognised(patch, new Geom_Plane(gp_Ax3()), 1.0);
  ExpectRecognised(Backwards(patch), new Geom_Plane(gp_Ax3()), 1.0);
}

TEST(AnalyticForm, MeridiansThatPassAPoleStayPatches)
{
  // Half a circle from the equator over the pole, and less than that, turned by half a turn: no
  // latitude is beyond a pole.
  for (const auto& [from, to] : { std::pair(0.0, Pi), std::pair(1.0, 2.0), std::pair(0.2, 1.8) })
  {
    SCOPED_TRACE(from);
    const Handle(Geom_Circle) meridian =
      new Geom_Circle(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, -1, 0), gp_Dir(1, 0, 0)), 5.0);
    const Handle(Geom_TrimmedCurve) half = new Geom_TrimmedCurve(meridian, from, to);
    double error = 0.0;
    const Surface surface = SurfaceConverter(new Geom_SurfaceOfRevolution(half, gp_Ax1()), 1e-7)
                              .Convert({ 0.0, Pi }, { from, to }, error);
    ASSERT_LT(error, 1e-7);
    EXPECT_FALSE(AnalyticSurface::Recognise(surface.View(), 1.0));
    EXPECT_FALSE(AnalyticSurface::Recognise(Transposed(surface).View(), 1.0));
  }
}

TEST(AnalyticForm, LinesAndCirclesAreRecognised)
{
  const gp_Ax2 frame(gp_Pnt(3.0, -40.0, 7.0), gp_Dir(0.3, -0.5, 0.8));
  const Handle(Geom_Curve) curves[] = { new Geom_Line(frame.Axis()), new Geom_Circle(frame, 2.5) };
  for (const Handle(Geom_Curve) & original : curves)
  {
    for (const auto& [t0, t1] : { std::pair(0.0, 2.0 * Pi), std::pair(0.3, 0.7) })
    {
      SCOPED_TRACE(t0);
      const Curve<3> curve = ConvertCurve(original, t0, t1, 0.0, 1e-7).Geometry;
      const auto form = RecogniseCurve(curve.View(), 1.0);
      ASSERT_TRUE(form);
      EXPECT_EQ(form->Geometry->DynamicType(), original->DynamicType());
      EXPECT_NEAR(form->Range.Length(), t1 - t0, 1e-12);
      for (const double share : { 0.0, 0.4, 1.0 })
      {
        const gp_Pnt p = form->Geometry->Value(form->Range.Min + share * form->Range.Length());
        EXPECT_LT(p.Distance(original->Value(t0 + share * (t1 - t0))), 1e-12);
      }
      Curve<3> bent = curve;
      bent.Points[bent.Points.size() / 2] += Vec3(1e-8, 1e-8, 0.0);
      bent.Points.front() -= Vec3(0.0, 1e-8, 0.0);
      bent.Pack();
      EXPECT_EQ(RecogniseCurve(bent.View(), 1.0).has_value(), curve.Points.size() == 2);
    }
  }
}

TEST(SamePart, AFaceOfNoPartIsAnErrorNotACrash)
{
  const auto face = [](double x) {
    return TopoDS::Face(
      BRepBuilderAPI_MakeFace(gp_Pln(gp_Ax3(gp_Pnt(x, 0, 0), gp_Dir(0, 0, 1))), 0, 1, 0, 1).Face());
  };
  CADPart part;
  part.Shape = face(0.0);
  part.Faces = { TopoDS::Face(part.Shape) };
  Placement motion;
  motion.Shift = { 0.0, 5.0, 0.0 };
  MovePart(motion, part);
  EXPECT_TRUE(part.Faces[0].IsSame(part.Shape));
  part.Faces.push_back(face(3.0));
  EXPECT_THROW(MovePart(motion, part), Error);
}

TEST(SamePart, MotionsDoNotChangeTheMeanRadius)
{
  Surface patch;
  patch.Count[0] = patch.Count[1] = 2;
  patch.Knots[0] = patch.Knots[1] = { 0.0, 0.0, 1.0, 1.0 };
  patch.Points = { { 0, 0, 1 }, { 4, 0, 1 }, { 0, 2, 1 }, { 4, 2, 1 } };
  Surface moved = patch;
  const Eigen::AngleAxisd turn(0.7, Vec3(1.0, -2.0, 0.5).normalized());
  for (Vec3& p : moved.Points)
  {
    p = turn * p + Vec3(1e3, -20.0, 3.0);
  }
  Model a, b;
  a.Faces.push_back({ patch.View() });
  b.Faces.push_back({ moved.View() });
  EXPECT_DOUBLE_EQ(MeanRadius(a), std::sqrt(5.0)) << "all corners are as far from the centre";
  EXPECT_NEAR(MeanRadius(b), std::sqrt(5.0), 1e-12);
  EXPECT_EQ(MeanRadius(Model()), 0.0);
  ASSERT_TRUE(MotionBetween(a, b));
  EXPECT_NEAR(MotionBetween(a, b)->Shift[0], 1e3, 1e-10);
}
