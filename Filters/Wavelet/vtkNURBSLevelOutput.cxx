// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSLevelOutput.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSNewArray.h"
#include "vtkNURBSParallel.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cstring>

namespace
{

using nurbs::WaveletMesh;
using vtkNURBSLevelOutput::Range;

void FillFieldData(const Range& range, vtkUnstructuredGrid* grid, vtkPolyData* mesh)
{
  vtkFieldData* field = mesh->GetFieldData();
  const vtkIdType faces = vtkIdType(range.Last - range.First);
  const int count = range.Model->Levels();
  auto ids = vtkNURBSNewArray<vtkIdTypeArray>("FaceIds", 1, faces);
  auto errors = vtkNURBSNewArray<vtkDoubleArray>("FaceErrorBound", 1, faces);
  auto levels = vtkNURBSNewArray<vtkIntArray>("FaceLevel", 1, faces);
  auto counts = vtkNURBSNewArray<vtkIntArray>("FaceNumberOfLevels", 1, faces);
  auto bounds = vtkNURBSNewArray<vtkDoubleArray>("FaceLevelErrorBounds", count, faces);
  auto status = vtkNURBSNewArray<vtkUnsignedCharArray>("FaceStatus", 1, faces);
  auto messages = vtkNURBSNewArray<vtkStringArray>("FaceStatusMessage", 1, faces);
  double largest = 0.0;
  for (vtkIdType f = 0; f < faces; ++f)
  {
    const WaveletMesh& face = range.Meshes->Faces[range.First + f];
    const nurbs::WaveletFace* source = range.Model->GetFace(std::int64_t(range.First + f));
    ids->SetValue(f, vtkNURBSModel::GetFaceId(grid, f));
    errors->SetValue(f, face.Error);
    levels->SetValue(f, face.Level);
    counts->SetValue(f, source ? source->Levels() : 0);
    for (int k = 0; k < count; ++k)
    {
      bounds->SetTypedComponent(f, k, source ? source->LevelError(k) : 0.0);
    }
    status->SetValue(f, static_cast<unsigned char>(face.Status));
    messages->SetValue(f, face.Message);
    largest = std::max(largest, face.Error);
  }
  field->AddArray(ids);
  field->AddArray(errors);
  field->AddArray(levels);
  field->AddArray(counts);
  field->AddArray(bounds);
  field->AddArray(status);
  field->AddArray(messages);
  vtkNURBSAddValue<vtkDoubleArray>(field, "ErrorBound", largest);
  vtkNURBSAddValue<vtkDoubleArray>(field, "Threshold", range.Meshes->Threshold);
  vtkNURBSAddValue<vtkIdTypeArray>(field, "NumberOfTriangles", mesh->GetNumberOfPolys());
  vtkNURBSAddValue<vtkIntArray>(field, "NumberOfLevels", count);
}

} // namespace

void vtkNURBSLevelOutput::FillMesh(const Range& range, vtkUnstructuredGrid* grid, vtkPolyData* mesh)
{
  mesh->Initialize();
  vtkNURBSModel::PassWithoutStructure(grid->GetFieldData(), mesh->GetFieldData());
  const std::size_t faces = range.Last - range.First;
  std::vector<vtkIdType> firstPoint(1, 0), firstTriangle(1, 0);
  for (std::size_t f = 0; f < faces; ++f)
  {
    const WaveletMesh& face = range.Meshes->Faces[range.First + f];
    firstPoint.push_back(firstPoint.back() + vtkIdType(face.Points.size()));
    firstTriangle.push_back(firstTriangle.back() + vtkIdType(face.Triangles.size() / 3));
  }
  auto xyz = vtkNURBSNewArray<vtkDoubleArray>("Points", 3, firstPoint.back());
  auto normals = vtkNURBSNewArray<vtkFloatArray>("Normals", 3, firstPoint.back());
  auto uv = vtkNURBSNewArray<vtkDoubleArray>("UV", 2, firstPoint.back());
  auto owners = vtkNURBSNewArray<vtkIdTypeArray>("Faces", 1, firstTriangle.back());
  vtkNew<vtkIdTypeArray> connectivity, starts;
  connectivity->SetNumberOfValues(3 * firstTriangle.back());
  starts->SetNumberOfValues(firstTriangle.back() + 1);
  double* const toPoints = xyz->GetPointer(0);
  float* const toNormals = normals->GetPointer(0);
  double* const toUV = uv->GetPointer(0);
  vtkIdType* const toOwners = owners->GetPointer(0);
  vtkIdType* const toCorners = connectivity->GetPointer(0);
  vtkNURBSParallelFor(0, std::int64_t(faces), [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t f = begin; f < end; ++f)
    {
      WaveletMesh& face = range.Meshes->Faces[range.First + f];
      const vtkIdType first = firstPoint[f];
      if (!face.Points.empty())
      {
        std::memcpy(
          toPoints + 3 * first, face.Points.data(), face.Points.size() * sizeof(nurbs::Vec3));
        std::memcpy(toNormals + 3 * first, face.Normals.data(),
          face.Normals.size() * sizeof(Eigen::Vector3f));
        std::memcpy(toUV + 2 * first, face.UV.data(), face.UV.size() * sizeof(nurbs::Vec2));
      }
      vtkIdType* corner = toCorners + 3 * firstTriangle[f];
      for (const int k : face.Triangles)
      {
        *corner++ = first + k;
      }
      std::fill(toOwners + firstTriangle[f], toOwners + firstTriangle[f + 1], vtkIdType(f));
      face.Points = {};
      face.Normals = {};
      face.UV = {};
      face.Triangles = {};
    }
  });
  for (vtkIdType t = 0; t <= firstTriangle.back(); ++t)
  {
    starts->SetValue(t, 3 * t);
  }
  vtkNew<vtkCellArray> cells;
  cells->SetData(starts, connectivity);
  vtkNew<vtkPoints> points;
  points->SetData(xyz);
  mesh->SetPoints(points);
  mesh->SetPolys(cells);
  mesh->GetPointData()->SetNormals(normals);
  mesh->GetPointData()->AddArray(uv);
  vtkNURBSModel::CopyFaceAttributes(grid, owners, mesh->GetCellData());
  FillFieldData(range, grid, mesh);
}
