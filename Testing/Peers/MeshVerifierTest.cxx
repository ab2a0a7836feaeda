// SPDX-License-Identifier: BSD-3-Clause
// The verifier on meshes whose errors are known in closed form, and on meshes with one defect each.
#include "FaceCheck.h"
#include "OcctMesh.h"
#include "OpenEdges.h"
#include "ReferenceShape.h"

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <TopoDS.hxx>
#include <gp_Circ.hxx>
#include <gp_Pln.hxx>
#include <gtest/gtest.h>

#include <cmath>

namespace
{

using namespace verify;

const double Pi = std::acos(-1.0);

CheckOptions Within(double tolerance)
{
  CheckOptions options;
  options.Tolerance = tolerance;
  return options;
}

/// The side of a cylinder of radius 2 and height 3 as @a n strips of two triangles, seen from outside.
FaceMesh CylinderMesh(int n)
{
  FaceMesh mesh;
  for (int i = 0; i <= n; ++i)
  {
    const double a = 2.0 * Pi * (i % n) / n;
    mesh.Points.emplace_back(2.0 * std::cos(a), 2.0 * std::sin(a), 0.0);
    mesh.Points.emplace_back(2.0 * std::cos(a), 2.0 * std::sin(a), 3.0);
    if (i > 0)
    {
      mesh.Triangles.push_back({ 2 * i - 2, 2 * i, 2 * i + 1 });
      mesh.Triangles.push_back({ 2 * i - 2, 2 * i + 1, 2 * i - 1 });
    }
  }
  return mesh;
}

TopoDS_Face CylinderSide(bool asSpline)
{
  TopoDS_Shape shape = BRepPrimAPI_MakeCylinder(2.0, 3.0).Shape();
  if (asSpline)
  {
    shape = BRepBuilderAPI_NurbsConvert(shape, Standard_True).Shape();
  }
  return Describe(shape).Faces.front();
}

TEST(Verifier, FindsTheSagOfACylinderMesh)
{
  for (bool asSpline : { false, true })
  {
    for (int n : { 7, 40 })
    {
      const double sag = 2.0 * (1.0 - std::cos(Pi / n));
      const FaceReport r = CheckFace(CylinderSide(asSpline), CylinderMesh(n), Within(0.5 * sag));
      EXPECT_NEAR(r.MeshToFace, sag, 1e-9) << n;
      EXPECT_LE(r.FaceToMesh, sag + 1e-12);
      EXPECT_GT(r.FaceToMesh, 0.99 * sag);
      EXPECT_NEAR(r.MeshArea, 3.0 * n * 4.0 * std::sin(Pi / n), 1e-9);
      EXPECT_NEAR(r.ExactArea, 12.0 * Pi, 1e-5 * r.ExactArea);
      EXPECT_EQ(r.Folded, 0);
      EXPECT_TRUE(CheckFace(CylinderSide(asSpline), CylinderMesh(n), Within(sag)).AreaAgrees(sag));
    }
  }
}

TEST(Verifier, SeesATriangleThatLeavesAHole)
{
  FaceMesh mesh = CylinderMesh(40);
  mesh.Triangles.erase(mesh.Triangles.begin() + 10);
  const FaceReport r = CheckFace(CylinderSide(false), mesh, Within(1e-2));
  const double width = 4.0 * std::sin(Pi / 40.0);
  EXPECT_GT(r.FaceToMesh, 0.4 * width);
  EXPECT_LT(r.MeshToFace, 1e-2);
}

TEST(Verifier, SeesAFoldedTriangleAndAMissingFace)
{
  FaceMesh mesh = CylinderMesh(40);
  std::swap(mesh.Triangles[3][0], mesh.Triangles[3][1]);
  EXPECT_EQ(CheckFace(CylinderSide(false), mesh, Within(1e-2)).Folded, 1);
  const FaceReport r = CheckFace(CylinderSide(false), FaceMesh(), Within(1e-2));
  EXPECT_TRUE(r.Missing);
  EXPECT_TRUE(std::isinf(r.Error()));
}

TEST(Verifier, SeesAMeshThatCoversAHole)
{
  const gp_Ax2 axes(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1));
  BRepBuilderAPI_MakeFace maker(gp_Pln(gp_Ax3(axes)), -2.0, 2.0, -2.0, 2.0);
  TopoDS_Wire hole =
    BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(gp_Circ(axes, 0.5)).Edge()).Wire();
  hole.Reverse();
  maker.Add(hole);
  FaceMesh mesh;
  mesh.Points = { { -2, -2, 0 }, { 2, -2, 0 }, { 2, 2, 0 }, { -2, 2, 0 } };
  mesh.Triangles = { { 0, 1, 2 }, { 0, 2, 3 } };
  const FaceReport r = CheckFace(maker.Face(), mesh, Within(1e-2));
  EXPECT_NEAR(r.MeshToFace, 0.5, 1e-9); // The hole's centre is on the common edge.
  EXPECT_NEAR(r.FaceToMesh, 0.0, 1e-12);
  EXPECT_NEAR(r.ExactArea, 16.0 - 0.25 * Pi, 1e-6);
  EXPECT_FALSE(r.AreaAgrees(1e-2));
}

TEST(Verifier, SplinesAndClosedFormsAgree)
{
  for (const TopoDS_Shape& shape :
    { BRepPrimAPI_MakeSphere(2.0).Shape(), BRepPrimAPI_MakeTorus(3.0, 1.0).Shape() })
  {
    const ReferenceShape exact = Describe(shape);
    MeshByOcct(shape, 0.02, false);
    const std::vector<FaceMesh> meshes = TakeOcctMesh(exact);
    const ReferenceShape splines =
      Describe(BRepBuilderAPI_NurbsConvert(shape, Standard_True).Shape());
    ASSERT_EQ(splines.Faces.size(), 1u);
    const FaceReport a = CheckFace(exact.Faces[0], meshes[0], Within(0.02));
    const FaceReport b = CheckFace(splines.Faces[0], meshes[0], Within(0.02));
    EXPECT_GT(a.MeshToFace, 1e-3);
    EXPECT_NEAR(a.MeshToFace, b.MeshToFace, 1e-9);
    EXPECT_NEAR(a.FaceToMesh, b.FaceToMesh, 0.1 * a.FaceToMesh);
    EXPECT_EQ(b.Folded, 0);
  }
}

TEST(Verifier, ComparesCoordinatesBitForBit)
{
  const ReferenceShape box = Describe(BRepPrimAPI_MakeBox(1.0, 2.0, 3.0).Shape());
  MeshByOcct(box.Root, 1e-2, false);
  std::vector<FaceMesh> meshes = TakeOcctMesh(box);
  ASSERT_EQ(box.Bodies.size(), 1u);
  EXPECT_TRUE(box.Bodies[0].Closed);
  EXPECT_EQ(FindOpenEdges(box, meshes, 1e-2).OpenEdges, 0);
  double& x = meshes[2].Points[0][1];
  x = std::nextafter(x, 10.0);
  // Two edges of the moved corner on its own face, and the two neighbours' sides of them.
  EXPECT_EQ(FindOpenEdges(box, meshes, 1e-2).OpenEdges, 4);
  meshes = TakeOcctMesh(box);
  std::swap(meshes[0].Triangles[0][0], meshes[0].Triangles[0][1]);
  EXPECT_EQ(FindOpenEdges(box, meshes, 1e-2).OpenEdges, 0);
  EXPECT_EQ(FindOpenEdges(box, meshes, 1e-2).Misdirected, 3);
}

TEST(Verifier, TellsFreeEdgesFromCracks)
{
  ReferenceShape box = Describe(BRepPrimAPI_MakeBox(1.0, 2.0, 3.0).Shape());
  MeshByOcct(box.Root, 1e-2, false);
  std::vector<FaceMesh> meshes = TakeOcctMesh(box);
  box.Bodies[0].Faces.pop_back();
  box.Bodies[0].Closed = false;
  EXPECT_EQ(FindOpenEdges(box, meshes, 1e-6).Cracks, 0);
  meshes[0].Triangles.pop_back();
  EXPECT_GT(FindOpenEdges(box, meshes, 1e-6).Cracks, 0);
}

TEST(Verifier, MeasuresNoGapInExactPrimitives)
{
  const ReferenceShape shape = Describe(BRepPrimAPI_MakeCylinder(2.0, 3.0).Shape());
  for (const FaceGap& gap : MeasureGaps(shape))
  {
    EXPECT_LT(gap.Neighbours, 1e-12);
  }
  EXPECT_NEAR(shape.Diagonal, std::sqrt(16.0 + 16.0 + 9.0), 1e-6);
}

} // namespace
