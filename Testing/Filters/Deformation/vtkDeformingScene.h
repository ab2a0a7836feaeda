// SPDX-License-Identifier: BSD-3-Clause
// Models that are moved, and what the tests ask of the meshes of vtkNURBSDeformingTessellator.
#ifndef vtkDeformingScene_h
#define vtkDeformingScene_h

#include "Surface.h"
#include "vtkNURBSDeformingTessellator.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"
#include "vtkNURBSShapeSource.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

namespace scene
{

using nurbs::Vec3;

inline vtkPolyData* Mesh(vtkNURBSDeformingTessellator* filter)
{
  return vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
}

/// A shape of its own, to be edited.
inline vtkSmartPointer<vtkUnstructuredGrid> Shape(int type)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShape(type);
  source->SetNumberOfPatches(100);
  source->Update();
  const auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->DeepCopy(source->GetOutput());
  return grid;
}

inline double Size(vtkUnstructuredGrid* grid)
{
  return grid->GetLength();
}

/// Moves every point by a wave of the given height that is the same wherever the points are.
inline void Wave(vtkUnstructuredGrid* grid, vtkPoints* rest, double height)
{
  vtkNew<vtkPolyData> still;
  still->SetPoints(rest);
  const double size = still->GetLength();
  for (vtkIdType k = 0; k < rest->GetNumberOfPoints(); ++k)
  {
    Vec3 x(rest->GetPoint(k));
    const Vec3 p = 6.0 / size * x;
    x += height * size * Vec3(std::sin(p[1]), std::cos(1.3 * p[2]), std::sin(p[0] + 0.4));
    grid->GetPoints()->SetPoint(k, x.data());
  }
  grid->GetPoints()->Modified();
}

inline vtkSmartPointer<vtkPoints> Rest(vtkUnstructuredGrid* grid)
{
  const auto rest = vtkSmartPointer<vtkPoints>::New();
  rest->SetDataTypeToDouble();
  rest->DeepCopy(grid->GetPoints());
  return rest;
}

/// Edges that one triangle has, by the places of their ends; optionally their length.
inline std::size_t OpenEdges(vtkPolyData* mesh, double* length = nullptr)
{
  using Place = std::array<double, 3>;
  std::map<Place, int> ids;
  std::vector<int> id(mesh->GetNumberOfPoints());
  std::vector<Vec3> places;
  for (vtkIdType k = 0; k < mesh->GetNumberOfPoints(); ++k)
  {
    const double* p = mesh->GetPoint(k);
    id[k] = ids.emplace(Place{ p[0] + 0.0, p[1] + 0.0, p[2] + 0.0 }, int(ids.size())).first->second;
    places.resize(ids.size());
    places[id[k]] = Vec3(p);
  }
  std::map<std::pair<int, int>, int> edges;
  vtkNew<vtkIdList> corners;
  for (vtkIdType t = 0; t < mesh->GetNumberOfPolys(); ++t)
  {
    mesh->GetPolys()->GetCellAtId(t, corners);
    for (int k = 0; k < 3; ++k)
    {
      const int a = id[corners->GetId(k)];
      const int b = id[corners->GetId((k + 1) % 3)];
      edges[std::minmax(a, b)] += a != b ? 1 : 0;
    }
  }
  std::size_t open = 0;
  for (const auto& edge : edges)
  {
    if (edge.second == 1)
    {
      ++open;
      if (length)
      {
        *length += (places[edge.first.first] - places[edge.first.second]).norm();
      }
    }
  }
  return open;
}

/// Length of the edges that one face of the model has, once: its border, by dense samples.
inline double BorderLength(vtkUnstructuredGrid* grid)
{
  constexpr int Samples = 2000;
  const auto view = vtkNURBSModel::View(grid);
  const nurbs::Model& model = view->GetModel();
  std::vector<int> uses(model.Edges.size(), 0);
  std::vector<double> lengths(model.Edges.size(), 0.0);
  for (const nurbs::Face& face : model.Faces)
  {
    for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
    {
      const nurbs::TrimLoop& loop = model.Loops[l];
      for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
      {
        const nurbs::TrimCurve& curve = model.TrimCurves[c];
        const nurbs::Interval domain = curve.Geometry.Domain();
        Vec3 last;
        ++uses[curve.Edge];
        lengths[curve.Edge] = 0.0;
        for (int k = 0; k <= Samples; ++k)
        {
          const nurbs::Vec2 uv =
            nurbs::Evaluate(curve.Geometry, domain.Min + k * domain.Length() / Samples);
          const Vec3 x = nurbs::Evaluate(face.Geometry, uv[0], uv[1]);
          lengths[curve.Edge] += k > 0 ? (x - last).norm() : 0.0;
          last = x;
        }
      }
    }
  }
  double length = 0.0;
  for (std::size_t e = 0; e < uses.size(); ++e)
  {
    length += uses[e] == 1 ? lengths[e] : 0.0;
  }
  return length;
}

/// Largest distances of the mesh's points and normals from those that direct evaluation finds.
struct Differences
{
  double Point = 0.0, Normal = 0.0;
  vtkIdType Checked = 0;
};

inline Differences Compare(vtkPolyData* mesh, vtkUnstructuredGrid* grid)
{
  const auto view = vtkNURBSModel::View(grid);
  const nurbs::Model& model = view->GetModel();
  std::map<vtkIdType, vtkIdType> cellOf;
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    cellOf[vtkNURBSModel::GetFaceId(grid, c)] = c;
  }
  vtkDataArray* faces = mesh->GetCellData()->GetArray("FaceId");
  vtkDataArray* uv = mesh->GetPointData()->GetArray("UV");
  vtkDataArray* normals = mesh->GetPointData()->GetNormals();
  std::vector<char> done(mesh->GetNumberOfPoints(), 0);
  Differences out;
  vtkNew<vtkIdList> corners;
  for (vtkIdType t = 0; t < mesh->GetNumberOfPolys(); ++t)
  {
    const nurbs::Face& face = model.Faces[cellOf.at(vtkIdType(faces->GetTuple1(t)))];
    mesh->GetPolys()->GetCellAtId(t, corners);
    for (int k = 0; k < 3; ++k)
    {
      const vtkIdType p = corners->GetId(k);
      if (done[p])
      {
        continue;
      }
      done[p] = 1;
      ++out.Checked;
      const double u = uv->GetComponent(p, 0), v = uv->GetComponent(p, 1);
      const Vec3 x(mesh->GetPoint(p));
      out.Point = std::max(out.Point, (x - nurbs::Evaluate(face.Geometry, u, v)).norm());
      const Vec3 n = (face.Reversed ? -1.0 : 1.0) * nurbs::Normal(face.Geometry, u, v);
      out.Normal = std::max(out.Normal, (n - Vec3(normals->GetTuple(p))).norm());
    }
  }
  return out;
}

} // namespace scene

#endif
