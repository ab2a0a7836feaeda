// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSMeshOutput.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkIdTypeArray.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSNewArray.h"
#include "vtkNURBSParallel.h"
#include "vtkNURBSPieces.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTypeInt32Array.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace
{

using nurbs::FaceMesh;
using nurbs::Vec3;
using vtkNURBSMeshOutput::Range;

static_assert(sizeof(Vec3) == 3 * sizeof(double), "points are copied in one go");
static_assert(sizeof(nurbs::Vec2) == 2 * sizeof(double), "parameters are copied in one go");

// Where the points and triangles of each mesh start in the output.
struct Offsets
{
  std::vector<vtkIdType> Points;
  std::vector<vtkIdType> Triangles;

  explicit Offsets(const Range& range)
    : Points(1, 0)
    , Triangles(1, 0)
  {
    for (std::size_t f = range.FirstMesh; f < range.LastMesh; ++f)
    {
      const FaceMesh& mesh = range.Result->Meshes[f];
      this->Points.push_back(this->Points.back() + vtkIdType(mesh.Points.size()));
      this->Triangles.push_back(this->Triangles.back() + vtkIdType(mesh.Triangles.size() / 3));
    }
  }
};

struct MeshArrays
{
  double* Points;
  float* Normals;
  double* UV;
  vtkIdType* Faces;
};

template <typename T>
void CopyMesh(
  FaceMesh& mesh, vtkIdType face, const Offsets& offsets, const MeshArrays& arrays, T* connectivity)
{
  const vtkIdType first = offsets.Points[face];
  const vtkIdType count = offsets.Points[face + 1] - first;
  if (count > 0)
  {
    std::memcpy(arrays.Points + 3 * first, mesh.Points.data(), count * sizeof(Vec3));
    std::memcpy(arrays.UV + 2 * first, mesh.UV.data(), count * sizeof(nurbs::Vec2));
  }
  for (vtkIdType i = 0; i < count; ++i)
  {
    for (int c = 0; c < 3; ++c)
    {
      arrays.Normals[3 * (first + i) + c] = static_cast<float>(mesh.Normals[i][c]);
    }
  }
  T* corners = connectivity + 3 * offsets.Triangles[face];
  for (std::size_t i = 0; i < mesh.Triangles.size(); ++i)
  {
    corners[i] = static_cast<T>(first + mesh.Triangles[i]);
  }
  std::fill(
    arrays.Faces + offsets.Triangles[face], arrays.Faces + offsets.Triangles[face + 1], face);
  // The status is still needed, the geometry is not.
  mesh.Points = {};
  mesh.Normals = {};
  mesh.UV = {};
  mesh.Triangles = {};
}

template <typename ArrayT>
vtkSmartPointer<vtkCellArray> CopyMeshes(
  const Range& range, const Offsets& offsets, const MeshArrays& arrays)
{
  using T = typename ArrayT::ValueType;
  const vtkIdType triangles = offsets.Triangles.back();
  vtkNew<ArrayT> starts;
  vtkNew<ArrayT> connectivity;
  starts->SetNumberOfValues(triangles + 1);
  connectivity->SetNumberOfValues(3 * triangles);
  T* start = starts->GetPointer(0);
  for (vtkIdType i = 0; i <= triangles; ++i)
  {
    start[i] = static_cast<T>(3 * i);
  }
  T* corners = connectivity->GetPointer(0);
  const vtkIdType faces = vtkIdType(range.LastMesh - range.FirstMesh);
  vtkNURBSParallelFor(0, faces, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t f = begin; f < end; ++f)
    {
      CopyMesh(range.Result->Meshes[range.FirstMesh + f], f, offsets, arrays, corners);
    }
  });
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(starts, connectivity);
  return cells;
}

// First points with each position, by open addressing. -0 and 0 are the same.
class PositionSet
{
public:
  explicit PositionSet(const double* points, vtkIdType count)
    : Points(points)
  {
    std::size_t size = 16;
    while (size < 2 * static_cast<std::size_t>(count))
    {
      size *= 2;
    }
    this->Slots.assign(size, -1);
  }

  vtkIdType Insert(vtkIdType point)
  {
    const double* p = this->Points + 3 * point;
    const std::size_t mask = this->Slots.size() - 1;
    for (std::size_t slot = Hash(p) & mask;; slot = (slot + 1) & mask)
    {
      const vtkIdType other = this->Slots[slot];
      if (other < 0)
      {
        this->Slots[slot] = point;
        return point;
      }
      const double* q = this->Points + 3 * other;
      if (p[0] == q[0] && p[1] == q[1] && p[2] == q[2])
      {
        return other;
      }
    }
  }

private:
  static std::size_t Hash(const double* p)
  {
    std::uint64_t hash = 0;
    for (int c = 0; c < 3; ++c)
    {
      const double value = p[c] + 0.0;
      std::uint64_t bits = 0;
      std::memcpy(&bits, &value, sizeof bits);
      hash = (hash ^ bits) * 0x9E3779B97F4A7C15ULL;
      hash ^= hash >> 29;
    }
    return static_cast<std::size_t>(hash ^ (hash >> 32));
  }

  const double* Points;
  std::vector<vtkIdType> Slots;
};

// One index for all points with the same coordinates. Works in place; triangles that lose a corner
// go, and so do the entries of `faces`.
vtkSmartPointer<vtkCellArray> MergeCoincidentPoints(
  vtkDoubleArray* points, vtkCellArray* cells, vtkIdTypeArray* faces)
{
  const vtkIdType count = points->GetNumberOfTuples();
  double* xyz = points->GetPointer(0);
  std::vector<vtkIdType> target(count);
  PositionSet positions(xyz, count);
  std::vector<vtkIdType> firsts(count);
  for (vtkIdType i = 0; i < count; ++i)
  {
    firsts[i] = positions.Insert(i);
  }
  vtkIdType kept = 0;
  for (vtkIdType i = 0; i < count; ++i)
  {
    if (firsts[i] == i)
    {
      std::copy_n(xyz + 3 * i, 3, xyz + 3 * kept);
      target[i] = kept++;
    }
    else
    {
      target[i] = target[firsts[i]];
    }
  }
  points->Resize(kept);
  points->SetNumberOfTuples(kept);
  vtkNew<vtkIdTypeArray> connectivity;
  vtkNew<vtkIdTypeArray> starts;
  const vtkIdType all = cells->GetNumberOfCells();
  connectivity->SetNumberOfValues(3 * all);
  vtkIdType* out = connectivity->GetPointer(0);
  vtkIdType* face = faces->GetPointer(0);
  vtkIdType triangles = 0;
  for (vtkIdType c = 0; c < all; ++c)
  {
    vtkIdType size = 0;
    const vtkIdType* corners = nullptr;
    cells->GetCellAtId(c, size, corners);
    const vtkIdType p[3] = { target[corners[0]], target[corners[1]], target[corners[2]] };
    if (p[0] != p[1] && p[1] != p[2] && p[2] != p[0])
    {
      std::copy_n(p, 3, out + 3 * triangles);
      face[triangles++] = face[c];
    }
  }
  connectivity->SetNumberOfValues(3 * triangles);
  faces->SetNumberOfValues(triangles);
  starts->SetNumberOfValues(triangles + 1);
  for (vtkIdType i = 0; i <= triangles; ++i)
  {
    starts->SetValue(i, 3 * i);
  }
  auto merged = vtkSmartPointer<vtkCellArray>::New();
  merged->SetData(starts, connectivity);
  return merged;
}

void FillFieldData(const Range& range, vtkUnstructuredGrid* grid, vtkPolyData* mesh)
{
  vtkFieldData* field = mesh->GetFieldData();
  std::vector<vtkIdType> told;
  for (vtkIdType f = 0; f < vtkIdType(range.LastMesh - range.FirstMesh); ++f)
  {
    if (!range.IsGhost || !range.IsGhost[f])
    {
      told.push_back(f);
    }
  }
  const auto faces = vtkIdType(told.size());
  auto ids = vtkNURBSNewArray<vtkIdTypeArray>("FaceIds", 1, faces);
  auto errors = vtkNURBSNewArray<vtkDoubleArray>("FaceCertifiedError", 1, faces);
  auto status = vtkNURBSNewArray<vtkUnsignedCharArray>("FaceStatus", 1, faces);
  auto messages = vtkNURBSNewArray<vtkStringArray>("FaceStatusMessage", 1, faces);
  auto tolerances = vtkNURBSNewArray<vtkDoubleArray>("FaceTolerance", 1, faces);
  double largest = 0.0;
  for (vtkIdType k = 0; k < faces; ++k)
  {
    const vtkIdType f = told[k];
    const FaceMesh& face = range.Result->Meshes[range.FirstMesh + f];
    ids->SetValue(k, vtkNURBSModel::GetFaceId(grid, f));
    errors->SetValue(k, face.CertifiedError);
    status->SetValue(k, static_cast<unsigned char>(face.Status));
    messages->SetValue(k, face.Message);
    tolerances->SetValue(k, range.FaceTolerances ? range.FaceTolerances[f] : range.Tolerance);
    largest = std::max(largest, face.CertifiedError);
  }
  field->AddArray(ids);
  field->AddArray(errors);
  field->AddArray(status);
  field->AddArray(messages);
  if (range.FaceTolerances)
  {
    field->AddArray(tolerances);
  }
  vtkNURBSAddValue<vtkDoubleArray>(field, "Tolerance", range.Tolerance);
  vtkNURBSAddValue<vtkDoubleArray>(field, "CertifiedError", largest);
  vtkNURBSAddValue<vtkIdTypeArray>(field, "NumberOfTriangles", mesh->GetNumberOfPolys());
}

} // namespace

void vtkNURBSMeshOutput::FillMesh(const Range& range, vtkUnstructuredGrid* grid, vtkPolyData* mesh)
{
  vtkNURBSModel::PassWithoutStructure(grid->GetFieldData(), mesh->GetFieldData());
  const Offsets offsets(range);
  const vtkIdType points = offsets.Points.back();
  auto xyz = vtkNURBSNewArray<vtkDoubleArray>("Points", 3, points);
  auto normals = vtkNURBSNewArray<vtkFloatArray>("Normals", 3, points);
  auto uv = vtkNURBSNewArray<vtkDoubleArray>("UV", 2, points);
  auto faces = vtkNURBSNewArray<vtkIdTypeArray>("Faces", 1, offsets.Triangles.back());
  const MeshArrays arrays{ xyz->GetPointer(0), normals->GetPointer(0), uv->GetPointer(0),
    faces->GetPointer(0) };
  const vtkIdType limit = std::numeric_limits<vtkTypeInt32>::max();
  vtkSmartPointer<vtkCellArray> cells = std::max(points, 3 * offsets.Triangles.back()) < limit
    ? CopyMeshes<vtkTypeInt32Array>(range, offsets, arrays)
    : CopyMeshes<vtkTypeInt64Array>(range, offsets, arrays);
  if (range.MergePoints)
  {
    cells = MergeCoincidentPoints(xyz, cells, faces);
  }
  else
  {
    mesh->GetPointData()->SetNormals(normals);
    mesh->GetPointData()->AddArray(uv);
  }
  vtkNew<vtkPoints> positions;
  positions->SetData(xyz);
  mesh->SetPoints(positions);
  mesh->SetPolys(cells);
  vtkNURBSModel::CopyFaceAttributes(grid, faces, mesh->GetCellData());
  FillFieldData(range, grid, mesh);
}

void vtkNURBSMeshOutput::FillLines(
  const Range& range, vtkUnstructuredGrid* grid, std::int64_t firstEdge, vtkPolyData* lines)
{
  vtkNURBSModel::PassWithoutStructure(grid->GetFieldData(), lines->GetFieldData());
  const vtkIdType count = vtkIdType(range.LastLine - range.FirstLine);
  auto edges = vtkNURBSNewArray<vtkTypeInt64Array>(vtkNURBSModel::EdgeIdName(), 1, count);
  auto faces = vtkNURBSNewArray<vtkTypeInt64Array>(vtkNURBSModel::FaceIdName(), 1, count);
  auto owners = vtkNURBSNewArray<vtkIdTypeArray>("Owners", 1, count);
  vtkNew<vtkIdTypeArray> starts;
  starts->SetNumberOfValues(count + 1);
  vtkIdType total = 0;
  for (vtkIdType i = 0; i < count; ++i)
  {
    const nurbs::TrimPolyline& line = range.Result->Polylines[range.FirstLine + i];
    starts->SetValue(i, total);
    total += vtkIdType(line.Points.size());
    edges->SetValue(i, line.Edge < 0 ? -1 : line.Edge - firstEdge);
    owners->SetValue(i, vtkIdType(line.Face) - vtkIdType(range.FirstMesh));
    faces->SetValue(i, vtkNURBSModel::GetFaceId(grid, owners->GetValue(i)));
  }
  starts->SetValue(count, total);
  auto xyz = vtkNURBSNewArray<vtkDoubleArray>("Points", 3, total);
  vtkNew<vtkIdTypeArray> connectivity;
  connectivity->SetNumberOfValues(total);
  for (vtkIdType i = 0; i < total; ++i)
  {
    connectivity->SetValue(i, i);
  }
  double* to = xyz->GetPointer(0);
  for (vtkIdType i = 0; i < count; ++i)
  {
    const std::vector<Vec3>& points = range.Result->Polylines[range.FirstLine + i].Points;
    if (!points.empty())
    {
      std::memcpy(to + 3 * starts->GetValue(i), points.data(), points.size() * sizeof(Vec3));
    }
  }
  vtkNew<vtkPoints> positions;
  positions->SetData(xyz);
  vtkNew<vtkCellArray> cells;
  cells->SetData(starts, connectivity);
  lines->SetPoints(positions);
  lines->SetLines(cells);
  lines->GetCellData()->AddArray(edges);
  lines->GetCellData()->AddArray(faces);
  vtkNURBSPieces::CopyOwners(grid, owners, lines->GetCellData());
}

double vtkNURBSMeshOutput::GetCertifiedError(vtkPolyData* mesh)
{
  return mesh->GetFieldData()->GetArray("CertifiedError")->GetTuple1(0);
}

void vtkNURBSMeshOutput::SetFigures(vtkPolyData* mesh, double certifiedError, vtkIdType triangles)
{
  vtkNURBSAddValue<vtkDoubleArray>(mesh->GetFieldData(), "CertifiedError", certifiedError);
  vtkNURBSAddValue<vtkIdTypeArray>(mesh->GetFieldData(), "NumberOfTriangles", triangles);
}
