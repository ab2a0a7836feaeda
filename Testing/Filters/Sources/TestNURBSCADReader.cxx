// SPDX-License-Identifier: BSD-3-Clause
// Shapes of every kind of surface and edge through the reader, compared with OpenCASCADE's.
#include "testCADModels.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <GeomAPI_PointsToBSplineSurface.hxx>
#include <GeomConvert.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_OffsetSurface.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <gp_Elips.hxx>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

namespace
{

constexpr double Pi = 3.14159265358979323846;

gp_Ax2 Tilted()
{
  return gp_Ax2(gp_Pnt(3.0, -2.0, 5.0), gp_Dir(0.3, 0.5, 0.8), gp_Dir(0.9, -0.1, 0.2));
}

/// A bumpy patch over [0, 10] x [0, 10].
Handle(Geom_BSplineSurface) Bumps()
{
  TColgp_Array2OfPnt points(1, 9, 1, 9);
  for (int i = 1; i <= 9; ++i)
  {
    for (int j = 1; j <= 9; ++j)
    {
      points(i, j) = gp_Pnt(1.25 * (i - 1), 1.25 * (j - 1), std::sin(0.8 * i) * std::cos(0.6 * j));
    }
  }
  return GeomAPI_PointsToBSplineSurface(points).Surface();
}

double LargestConversionError(vtkUnstructuredGrid* grid)
{
  auto* errors = vtkDoubleArray::SafeDownCast(grid->GetCellData()->GetArray("ConversionError"));
  return errors ? errors->GetRange()[1] : -1.0;
}

void ExpectExactSolid(const TopoDS_Shape& shape, const std::string& name, double edges = 1e-10)
{
  SCOPED_TRACE(name);
  const auto grid = Convert(shape, name);
  ExpectSameFaces(grid, shape, 1e-10, edges);
  ExpectClosed(grid);
  EXPECT_LT(LargestConversionError(grid), 1e-12);
}

} // namespace

TEST(CADReader, PrimitivesAreExact)
{
  ExpectExactSolid(BRepPrimAPI_MakeBox(Tilted(), 1.0, 2.0, 3.0).Shape(), "box", 1e-13);
  ExpectExactSolid(BRepPrimAPI_MakeCylinder(Tilted(), 2.0, 5.0).Shape(), "cylinder", 1e-13);
  ExpectExactSolid(BRepPrimAPI_MakeCylinder(Tilted(), 2.0, 5.0, 2.2).Shape(), "sector", 1e-13);
  ExpectExactSolid(BRepPrimAPI_MakeCone(Tilted(), 3.0, 1.0, 4.0).Shape(), "frustum", 1e-13);
  ExpectExactSolid(BRepPrimAPI_MakeCone(Tilted(), 3.0, 0.0, 4.0).Shape(), "cone", 1e-13);
  ExpectExactSolid(BRepPrimAPI_MakeSphere(Tilted(), 2.5).Shape(), "sphere", 1e-13);
  ExpectExactSolid(
    BRepPrimAPI_MakeSphere(Tilted(), 2.5, -0.7, 1.1, 4.0).Shape(), "sphere-part", 1e-13);
  ExpectExactSolid(BRepPrimAPI_MakeTorus(Tilted(), 5.0, 1.5).Shape(), "torus", 1e-13);
  ExpectExactSolid(BRepPrimAPI_MakeTorus(Tilted(), 5.0, 1.5, 2.9).Shape(), "torus-part");
}

TEST(CADReader, SphereIsOneOverItsWholeDomain)
{
  const auto grid = Convert(BRepPrimAPI_MakeSphere(2.5).Shape(), "unit-sphere");
  const auto view = vtkNURBSModel::View(grid);
  const nurbs::Face& face = view->GetModel().Faces[0];
  for (int k = 0; k < 400; ++k)
  {
    const nurbs::Interval u = face.Geometry.Domain(0), v = face.Geometry.Domain(1);
    const nurbs::Vec3 p = nurbs::Evaluate(
      face.Geometry, u.Min + u.Length() * (k % 20) / 19, v.Min + v.Length() * (k / 20) / 19);
    EXPECT_NEAR(p.norm(), 2.5, 1e-14);
  }
  EXPECT_GT(Outside(face, 0.3, 0.6)
              .dot(nurbs::Evaluate(face.Geometry,
                face.Geometry.Domain(0).Min + 0.3 * face.Geometry.Domain(0).Length(),
                face.Geometry.Domain(1).Min + 0.6 * face.Geometry.Domain(1).Length())),
    2.49);
}

TEST(CADReader, IntersectionsKeepTheModelsTolerance)
{
  const TopoDS_Shape block = BRepPrimAPI_MakeBox(gp_Pnt(-4, -4, -4), 8.0, 8.0, 8.0).Shape();
  const TopoDS_Shape drill = BRepPrimAPI_MakeCylinder(Tilted(), 1.3, 20.0).Shape();
  const TopoDS_Shape cut = BRepAlgoAPI_Cut(block, drill).Shape();
  const auto grid = Convert(cut, "drilled");
  ExpectSameFaces(grid, cut, 1e-10, 2e-6);
  ExpectClosed(grid);

  const TopoDS_Shape ball = BRepPrimAPI_MakeSphere(gp_Pnt(2, 3, 1), 4.0).Shape();
  const TopoDS_Shape fused = BRepAlgoAPI_Fuse(cut, ball).Shape();
  const auto both = Convert(fused, "fused");
  ExpectSameFaces(both, fused, 1e-10, 2e-6);
  ExpectClosed(both);
}

// A plane that cuts a cone along its axis: hyperbolas; one along a side: a parabola.
TEST(CADReader, HyperbolasAndParabolas)
{
  const TopoDS_Shape cone = BRepPrimAPI_MakeCone(4.0, 0.0, 4.0).Shape();
  const TopoDS_Shape along = BRepPrimAPI_MakeBox(gp_Pnt(1, -9, -9), 20.0, 20.0, 20.0).Shape();
  const TopoDS_Shape hyperbola = BRepAlgoAPI_Cut(cone, along).Shape();
  const auto grid = Convert(hyperbola, "hyperbola");
  ExpectSameFaces(grid, hyperbola, 1e-10, 1e-6);
  ExpectClosed(grid);

  const gp_Ax2 slope(gp_Pnt(6, -9, -5), gp_Dir(1, 0, 1), gp_Dir(0, 1, 0));
  const TopoDS_Shape side = BRepPrimAPI_MakeBox(slope, 20.0, 20.0, 20.0).Shape();
  const TopoDS_Shape parabola = BRepAlgoAPI_Cut(cone, side).Shape();
  const auto other = Convert(parabola, "parabola");
  ExpectSameFaces(other, parabola, 1e-10, 1e-6);
  ExpectClosed(other);
}

TEST(CADReader, ExtrusionsAndRevolutionsOfConicsAndSplines)
{
  const Handle(Geom_Curve) ellipse = new Geom_Ellipse(gp_Elips(Tilted(), 3.0, 1.0));
  const TopoDS_Shape profile = BRepBuilderAPI_MakeFace(
    BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(ellipse).Edge()).Wire(), true)
                                 .Shape();
  ExpectExactSolid(BRepPrimAPI_MakePrism(profile, gp_Vec(1, 2, 7)).Shape(), "prism");
  const gp_Ax1 axis(gp_Pnt(3, -2, 15), gp_Dir(0.9, -0.1, 0.2));
  ExpectExactSolid(BRepPrimAPI_MakeRevol(profile, axis, 2.0).Shape(), "revolved");
  ExpectExactSolid(BRepPrimAPI_MakeRevol(profile, axis).Shape(), "revolved-whole");
}

TEST(CADReader, PeriodicSplinesAreUnrolled)
{
  const Handle(Geom_Surface) torus = new Geom_ToroidalSurface(gp_Ax3(Tilted()), 5.0, 1.5);
  const Handle(Geom_BSplineSurface) spline = GeomConvert::SurfaceToBSplineSurface(torus);
  ASSERT_TRUE(spline->IsUPeriodic() && spline->IsVPeriodic());
  // Across the origin of both directions.
  const TopoDS_Shape face = BRepBuilderAPI_MakeFace(spline, -1.0, 2.0, 5.0, 8.0, 1e-7).Shape();
  const auto grid = Convert(face, "periodic");
  ExpectSameFaces(grid, face, 1e-10, 1e-10);
  const auto view = vtkNURBSModel::View(grid);
  for (int dir = 0; dir < 2; ++dir)
  {
    const nurbs::Interval domain = view->GetModel().Faces[0].Geometry.Domain(dir);
    EXPECT_LT(domain.Min, 2.0 * Pi - 0.9);
    EXPECT_GT(domain.Max, 2.0 * Pi + 0.9);
  }
  EXPECT_LT(LargestConversionError(grid), 1e-12);
}

TEST(CADReader, OffsetSurfacesAreFittedAndSaySo)
{
  const Handle(Geom_Surface) offset = new Geom_OffsetSurface(Bumps(), 0.2);
  const TopoDS_Shape face = BRepBuilderAPI_MakeFace(offset, 1e-7).Shape();
  const auto grid = Convert(face, "offset");
  const double error = LargestConversionError(grid);
  EXPECT_GT(error, 1e-16);
  EXPECT_LT(error, 1e-7);
  ExpectSameFaces(grid, face, 2.0 * error + 1e-9, 1e-6);

  // An offset of an elementary surface has an exact form.
  const Handle(Geom_Surface) sphere =
    new Geom_OffsetSurface(new Geom_SphericalSurface(gp_Ax3(Tilted()), 2.0), 0.5);
  const TopoDS_Shape whole = BRepBuilderAPI_MakeFace(sphere, 0.2, 1.9, -0.4, 0.6, 1e-7).Shape();
  EXPECT_LT(LargestConversionError(Convert(whole, "offset-sphere")), 1e-12);
}

TEST(CADReader, CurvesThatAreMissingOnTheSurfaceAreComputed)
{
  // The same edge on a second face that knows nothing of it.
  const Handle(Geom_BSplineSurface) bumps = Bumps();
  const TopoDS_Shape known = BRepBuilderAPI_MakeFace(bumps, 1e-7).Shape();
  const Handle(Geom_BSplineSurface) copy = Handle(Geom_BSplineSurface)::DownCast(bumps->Copy());
  BRep_Builder builder;
  TopoDS_Face face;
  builder.MakeFace(face, copy, 1e-7);
  builder.Add(face, BRepTools::OuterWire(TopoDS::Face(known)));
  const auto grid = Convert(face, "missing");
  ExpectSameFaces(grid, face, 1e-10, 1e-5);
}

TEST(CADReader, MirroredAndMovedCopies)
{
  const TopoDS_Shape part = BRepPrimAPI_MakeCone(Tilted(), 3.0, 1.0, 4.0).Shape();
  gp_Trsf move;
  move.SetTranslation(gp_Vec(10, 0, 0));
  TopoDS_Compound pair;
  BRep_Builder builder;
  builder.MakeCompound(pair);
  builder.Add(pair, part);
  builder.Add(pair, part.Moved(TopLoc_Location(move)));
  const auto grid = Convert(pair, "pair");
  ExpectSameFaces(grid, pair, 1e-10, 1e-12);
  ExpectClosed(grid);
  EXPECT_EQ(grid->GetNumberOfCells(), 6);
}

TEST(CADReader, FaceWithoutWireHasItsNaturalBoundary)
{
  BRep_Builder builder;
  TopoDS_Face face;
  builder.MakeFace(face, new Geom_SphericalSurface(gp_Ax3(), 2.0), 1e-7);
  const auto grid = Convert(face, "bare");
  const auto view = vtkNURBSModel::View(grid);
  ASSERT_EQ(view->GetModel().Faces.size(), 1u);
  EXPECT_EQ(view->GetModel().Faces[0].LoopCount, 0);
  EXPECT_NEAR(view->GetModel().Faces[0].Geometry.Domain(0).Length(), 2.0 * Pi, 1e-14);
}

TEST(CADReader, UnconvertedFacesAreNamed)
{
  TopoDS_Compound compound;
  BRep_Builder builder;
  builder.MakeCompound(compound);
  TopoDS_Face endless;
  builder.MakeFace(endless, new Geom_CylindricalSurface(gp_Ax3(), 2.0), 1e-7);
  builder.Add(compound, endless);
  builder.Add(compound, BRepPrimAPI_MakeBox(1.0, 2.0, 3.0).Shape());
  const auto grid = Convert(compound, "endless");
  EXPECT_EQ(grid->GetNumberOfCells(), 6);
  const std::vector<std::string> reasons = vtkNURBSModel::GetUnconvertedFaces(grid);
  ASSERT_EQ(reasons.size(), 1u);
  EXPECT_EQ(reasons[0].substr(0, 3), "0: ");
  EXPECT_NE(reasons[0].find("infinite"), std::string::npos);
  EXPECT_EQ(vtkNURBSModel::GetFaceId(grid, 0), 1);
}

// Real files where OpenCASCADE's sample data is installed.
TEST(CADReader, SampleFiles)
{
  const std::string folder = "/usr/share/opencascade/data/occ/";
  for (const char* name : { "CrankArm.brep", "Piston.rle", "Pump_Nut.brep", "MODERN_Chair_1.brep" })
  {
    if (!std::filesystem::exists(folder + name))
    {
      GTEST_SKIP() << folder << " is not installed";
    }
    SCOPED_TRACE(name);
    TopoDS_Shape shape;
    BRep_Builder builder;
    ASSERT_TRUE(BRepTools::Read(shape, (folder + name).c_str(), builder));
    const auto grid = ReadOne(folder + name);
    const auto view = vtkNURBSModel::View(grid);
    EXPECT_LT(MeasureEdges(view->GetModel()).Excess, 1e-9);
    ExpectClosed(grid);
    EXPECT_LT(LargestConversionError(grid), 1e-10);
  }
}
