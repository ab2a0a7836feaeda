// SPDX-License-Identifier: BSD-3-Clause
#include "OcctDeformationRival.h"

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Poly_Triangulation.hxx>
#include <Precision.hxx>
#include <Standard_Failure.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopoDS_Face.hxx>

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

Handle(Geom_BSplineSurface) MakeSurface(const Surface& surface)
{
  TColgp_Array2OfPnt poles(1, surface.Count[0], 1, surface.Count[1]);
  TColStd_Array2OfReal weights(1, surface.Count[0], 1, surface.Count[1]);
  for (int j = 0; j < surface.Count[1]; ++j)
  {
    for (int i = 0; i < surface.Count[0]; ++i)
    {
      const std::size_t k = i + std::size_t(j) * surface.Count[0];
      const Vec3& p = surface.Points[k];
      poles.SetValue(i + 1, j + 1, gp_Pnt(p[0], p[1], p[2]));
      weights.SetValue(i + 1, j + 1, surface.Weights.empty() ? 1.0 : surface.Weights[k]);
    }
  }
  std::vector<double> values[2];
  std::vector<int> multiplicities[2];
  for (int dir = 0; dir < 2; ++dir)
  {
    for (const Knot& knot : DistinctKnots(surface.Knots[dir], surface.Degree[dir]))
    {
      values[dir].push_back(knot.Value);
      multiplicities[dir].push_back(knot.Multiplicity);
    }
  }
  const TColStd_Array1OfReal u(values[0][0], 1, int(values[0].size()));
  const TColStd_Array1OfReal v(values[1][0], 1, int(values[1].size()));
  const TColStd_Array1OfInteger timesU(multiplicities[0][0], 1, int(values[0].size()));
  const TColStd_Array1OfInteger timesV(multiplicities[1][0], 1, int(values[1].size()));
  if (surface.Weights.empty())
  {
    return new Geom_BSplineSurface(
      poles, u, v, timesU, timesV, surface.Degree[0], surface.Degree[1]);
  }
  return new Geom_BSplineSurface(
    poles, weights, u, v, timesU, timesV, surface.Degree[0], surface.Degree[1]);
}

/// Points, normals, triangles and parameters of the face's triangulation.
void Take(const Poly_Triangulation& triangulation, const Handle(Geom_BSplineSurface) & surface,
  DeformationMesh& mesh)
{
  const GeomAdaptor_Surface adaptor(surface);
  const std::size_t count = std::size_t(triangulation.NbNodes());
  mesh.Points.resize(3 * count);
  mesh.Normals.resize(3 * count);
  mesh.Parameters.resize(2 * count);
  for (std::size_t k = 0; k < count; ++k)
  {
    const gp_Pnt node = triangulation.Node(int(k) + 1);
    const gp_Pnt2d uv = triangulation.UVNode(int(k) + 1);
    gp_Pnt at;
    gp_Vec su, sv;
    adaptor.D1(uv.X(), uv.Y(), at, su, sv);
    const gp_Vec normal = su.Crossed(sv).Normalized();
    for (int d = 0; d < 3; ++d)
    {
      mesh.Points[3 * k + d] = node.Coord(d + 1);
      mesh.Normals[3 * k + d] = normal.Coord(d + 1);
    }
    mesh.Parameters[2 * k] = uv.X();
    mesh.Parameters[2 * k + 1] = uv.Y();
  }
  mesh.Triangles.resize(3 * std::size_t(triangulation.NbTriangles()));
  for (int k = 0; k < triangulation.NbTriangles(); ++k)
  {
    int corners[3];
    triangulation.Triangle(k + 1).Get(corners[0], corners[1], corners[2]);
    std::transform(
      corners, corners + 3, mesh.Triangles.begin() + 3 * k, [](int c) { return c - 1; });
  }
}

double Diagonal(const Surface& surface)
{
  Box3 box;
  for (const Vec3& p : surface.Points)
  {
    box.extend(p);
  }
  return box.diagonal().norm();
}

} // namespace

void OcctDeformationRival::MakeMesh()
{
  try
  {
    const Handle(Geom_BSplineSurface) surface = MakeSurface(this->Deformed);
    const TopoDS_Face face = BRepBuilderAPI_MakeFace(surface, Precision::Confusion());
    IMeshTools_Parameters parameters;
    parameters.Deflection = this->Deflection;
    parameters.Angle = 10.0; // Beyond any angle between normals: switched off.
    parameters.InParallel = false;
    BRepMesh_IncrementalMesh mesher;
    mesher.SetShape(face);
    mesher.ChangeParameters() = parameters;
    mesher.Perform();
    TopLoc_Location place;
    const Handle(Poly_Triangulation) triangulation = BRep_Tool::Triangulation(face, place);
    if (triangulation.IsNull())
    {
      throw Error("OpenCASCADE makes no mesh of the face");
    }
    Take(*triangulation, surface, this->Mesh);
  }
  catch (const Standard_Failure& failure)
  {
    throw Error(std::string("OpenCASCADE: ") + failure.GetMessageString());
  }
}

void OcctDeformationRival::Polygonise()
{
  if (this->Deflection > 0.0)
  {
    this->MakeMesh();
    return;
  }
  // The number of vertices is about inversely proportional to the deflection, but jumps.
  const double wanted = double(this->Grid->Count());
  double best = 0.0, bestMiss = 1e300;
  this->Deflection = 2.0 * Diagonal(this->Deformed) / wanted;
  for (int step = 0; step < 10; ++step)
  {
    this->MakeMesh();
    const double got = double(this->Mesh.Points.size() / 3);
    const double miss = std::abs(std::log(got / wanted));
    if (miss < std::log(1.1))
    {
      return;
    }
    if (miss < bestMiss)
    {
      bestMiss = miss;
      best = this->Deflection;
    }
    this->Deflection *= std::clamp(got / wanted, 0.05, 20.0);
  }
  this->Deflection = best;
  this->MakeMesh();
}

} // namespace nurbs
