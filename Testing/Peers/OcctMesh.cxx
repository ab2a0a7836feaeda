// SPDX-License-Identifier: BSD-3-Clause
#include "OcctMesh.h"

#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Poly_Triangulation.hxx>

namespace verify
{

void MeshByOcct(const TopoDS_Shape& root, double deflection, bool parallel)
{
  BRepTools::Clean(root);
  IMeshTools_Parameters parameters;
  parameters.Deflection = deflection;
  parameters.Angle = 10.0; // Beyond any angle between normals: switched off.
  parameters.Relative = Standard_False;
  parameters.InParallel = parallel;
  BRepMesh_IncrementalMesh mesher;
  mesher.SetShape(root);
  mesher.ChangeParameters() = parameters;
  mesher.Perform();
}

std::vector<FaceMesh> TakeOcctMesh(const ReferenceShape& shape)
{
  std::vector<FaceMesh> meshes;
  for (const TopoDS_Face& face : shape.Faces)
  {
    FaceMesh mesh;
    TopLoc_Location place;
    const Handle(Poly_Triangulation) triangulation = BRep_Tool::Triangulation(face, place);
    const bool reversed = face.Orientation() == TopAbs_REVERSED;
    for (int i = 1; !triangulation.IsNull() && i <= triangulation->NbNodes(); ++i)
    {
      const gp_Pnt p = triangulation->Node(i).Transformed(place.Transformation());
      mesh.Points.emplace_back(p.X(), p.Y(), p.Z());
    }
    for (int i = 1; !triangulation.IsNull() && i <= triangulation->NbTriangles(); ++i)
    {
      int a = 0, b = 0, c = 0;
      triangulation->Triangle(i).Get(a, b, c);
      mesh.Triangles.push_back({ a - 1, (reversed ? c : b) - 1, (reversed ? b : c) - 1 });
    }
    meshes.push_back(std::move(mesh));
  }
  return meshes;
}

} // namespace verify
