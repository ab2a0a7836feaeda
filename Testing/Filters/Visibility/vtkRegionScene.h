// SPDX-License-Identifier: BSD-3-Clause
/// @file vtkRegionScene.h
/// @brief Models for tests of vtkNURBSVisibleRegions, and measures of its outputs.
#ifndef vtkRegionScene_h
#define vtkRegionScene_h

#include "../../testMessageKeeper.h"
#include "PatchStitcher.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"
#include "vtkNURBSShapeSource.h"
#include "vtkNURBSTessellator.h"
#include "vtkNURBSVisibleRegions.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkErrorCode.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTriangle.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace regions
{

using nurbs::Vec3;

inline vtkSmartPointer<vtkUnstructuredGrid> Grid(nurbs::ModelBuilder& builder)
{
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNURBSModel::Store(builder, grid);
  return grid;
}

/// A shape of the source with its defaults; the car body of 120 faces.
inline vtkSmartPointer<vtkUnstructuredGrid> Shape(int type)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShape(type);
  source->SetNumberOfPatches(120);
  source->Update();
  return source->GetOutput();
}

/// A bilinear patch; corners in the order of the control points, u first.
inline nurbs::Surface Quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  nurbs::Surface s;
  s.Degree[0] = s.Degree[1] = 1;
  s.Count[0] = s.Count[1] = 2;
  s.Knots[0] = s.Knots[1] = { 0, 0, 1, 1 };
  s.Points = { a, b, c, d };
  return s;
}

inline void AddQuad(
  nurbs::ModelBuilder& builder, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  nurbs::PatchStitcher stitcher(builder, 1e-12);
  stitcher.AddFace(Quad(a, b, c, d), nurbs::FaceAttributes());
}

/// A solid box; its faces are x low, x high, y low, y high, z low, z high.
inline void AddBox(nurbs::ModelBuilder& builder, const Vec3& low, const Vec3& high)
{
  nurbs::PatchStitcher stitcher(builder, 1e-12);
  for (int f = 0; f < 6; ++f)
  {
    const int axis = f / 2;
    const int u = (axis + (f % 2 ? 1 : 2)) % 3; // u x v points outwards.
    const int v = (axis + (f % 2 ? 2 : 1)) % 3;
    Vec3 corner[4];
    for (int k = 0; k < 4; ++k)
    {
      corner[k][axis] = f % 2 ? high[axis] : low[axis];
      corner[k][u] = k % 2 ? high[u] : low[u];
      corner[k][v] = k / 2 ? high[v] : low[v];
    }
    stitcher.AddFace(Quad(corner[0], corner[1], corner[2], corner[3]), nurbs::FaceAttributes());
  }
}

inline vtkUnstructuredGrid* Models(vtkNURBSVisibleRegions* filter)
{
  return vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
}

inline double CellValue(vtkDataSet* data, const char* name, vtkIdType cell)
{
  vtkDataArray* array = data->GetCellData()->GetArray(name);
  return array && cell < array->GetNumberOfTuples() ? array->GetComponent(cell, 0) : std::nan("");
}

inline double Sum(vtkDataSet* data, const char* name)
{
  double sum = 0.0;
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
  {
    sum += CellValue(data, name, c);
  }
  return sum;
}

/// The visible area of a face; 0 if it is not in output 0.
inline double VisibleAreaOf(vtkNURBSVisibleRegions* filter, int faceId)
{
  double sum = 0.0;
  for (vtkIdType c = 0; c < Models(filter)->GetNumberOfCells(); ++c)
  {
    sum += CellValue(Models(filter), "FaceId", c) == faceId
      ? CellValue(Models(filter), "VisibleArea", c)
      : 0.0;
  }
  return sum;
}

inline double TessellatedArea(vtkUnstructuredGrid* grid)
{
  vtkNew<vtkNURBSTessellator> mesh;
  mesh->SetInputData(grid);
  mesh->SetTolerance(1e-4);
  // Of errors that are a little over the tolerance, and of borders that meet.
  vtkNew<MessageKeeper> warnings;
  mesh->AddObserver(vtkCommand::WarningEvent, warnings);
  mesh->Update();
  EXPECT_EQ(mesh->GetNumberOfFailedFaces(), 0);
  auto* triangles = vtkPolyData::SafeDownCast(mesh->GetOutputDataObject(0));
  double sum = 0.0;
  vtkNew<vtkIdList> ids;
  for (vtkIdType c = 0; c < triangles->GetNumberOfCells(); ++c)
  {
    triangles->GetCellPoints(c, ids);
    double p[3][3];
    for (int k = 0; k < 3 && ids->GetNumberOfIds() == 3; ++k)
    {
      triangles->GetPoint(ids->GetId(k), p[k]);
    }
    sum += ids->GetNumberOfIds() == 3 ? vtkTriangle::TriangleArea(p[0], p[1], p[2]) : 0.0;
  }
  return sum;
}

/// The area of a model that must be valid.
inline double CheckedArea(vtkUnstructuredGrid* grid)
{
  EXPECT_EQ(vtkNURBSModel::Validate(grid), "");
  return TessellatedArea(grid);
}

inline void ExpectSame(vtkFieldData* a, vtkFieldData* b)
{
  ASSERT_EQ(a->GetNumberOfArrays(), b->GetNumberOfArrays());
  for (int k = 0; k < a->GetNumberOfArrays(); ++k)
  {
    vtkAbstractArray* one = a->GetAbstractArray(k);
    vtkAbstractArray* other = b->GetAbstractArray(one->GetName());
    ASSERT_NE(other, nullptr) << one->GetName();
    ASSERT_EQ(one->GetNumberOfValues(), other->GetNumberOfValues()) << one->GetName();
    vtkIdType different = 0;
    for (vtkIdType i = 0; i < one->GetNumberOfValues(); ++i)
    {
      different += one->GetVariantValue(i) != other->GetVariantValue(i);
    }
    EXPECT_EQ(different, 0) << one->GetName();
  }
}

/// Both outputs are the same in all arrays, bit by bit.
inline void ExpectSame(vtkNURBSVisibleRegions* a, vtkNURBSVisibleRegions* b)
{
  for (int port = 0; port < 2; ++port)
  {
    auto* one = vtkPointSet::SafeDownCast(a->GetOutputDataObject(port));
    auto* other = vtkPointSet::SafeDownCast(b->GetOutputDataObject(port));
    ASSERT_EQ(one->GetNumberOfPoints(), other->GetNumberOfPoints());
    ASSERT_EQ(one->GetNumberOfCells(), other->GetNumberOfCells());
    vtkIdType different = 0;
    for (vtkIdType i = 0; i < one->GetNumberOfPoints(); ++i)
    {
      double p[3], q[3];
      one->GetPoint(i, p);
      other->GetPoint(i, q);
      different += !std::equal(p, p + 3, q);
    }
    EXPECT_EQ(different, 0);
    vtkNew<vtkIdList> ids;
    vtkNew<vtkIdList> others;
    for (vtkIdType c = 0; c < one->GetNumberOfCells(); ++c)
    {
      one->GetCellPoints(c, ids);
      other->GetCellPoints(c, others);
      ASSERT_TRUE(std::equal(ids->begin(), ids->end(), others->begin(), others->end()));
    }
    ExpectSame(one->GetPointData(), other->GetPointData());
    ExpectSame(one->GetCellData(), other->GetCellData());
    ExpectSame(one->GetFieldData(), other->GetFieldData());
  }
}

} // namespace regions

#endif
