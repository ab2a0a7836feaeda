// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSFrameModel.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>

namespace
{

std::vector<vtkAbstractArray*> StructureOf(vtkUnstructuredGrid* grid)
{
  std::vector<vtkAbstractArray*> arrays = vtkNURBSModel::GetStructureArrays(grid);
  arrays.push_back(grid->GetCells()->GetOffsetsArray());
  arrays.push_back(grid->GetCells()->GetConnectivityArray());
  return arrays;
}

vtkNURBSArrayContent::Stamps StampsOf(const std::vector<vtkAbstractArray*>& arrays)
{
  vtkNURBSArrayContent::Stamps stamps;
  for (vtkAbstractArray* array : arrays)
  {
    vtkNURBSArrayContent::Append(array, stamps);
  }
  return stamps;
}

vtkNURBSArrayContent::Stamps PointStampsOf(vtkUnstructuredGrid* grid)
{
  vtkNURBSArrayContent::Stamps stamps;
  vtkNURBSArrayContent::Append(grid->GetPoints(), stamps);
  vtkNURBSArrayContent::Append(grid->GetPoints()->GetData(), stamps);
  vtkNURBSArrayContent::Append(vtkNURBSModel::GetWeights(grid), stamps);
  return stamps;
}

vtkSmartPointer<vtkDataArray> AsDoubles(vtkDataArray* array)
{
  if (!array || (array->GetDataType() == VTK_DOUBLE && array->HasStandardMemoryLayout()))
  {
    return array;
  }
  const auto doubles = vtkSmartPointer<vtkDoubleArray>::New();
  doubles->DeepCopy(array);
  return doubles;
}

// Weights that went away: a model that was rational stays so.
vtkSmartPointer<vtkDataArray> Ones(vtkIdType count)
{
  const auto ones = vtkSmartPointer<vtkDoubleArray>::New();
  ones->SetNumberOfValues(count);
  ones->FillValue(1.0);
  return ones;
}

const double* Values(vtkDataArray* array)
{
  return array ? static_cast<const double*>(array->GetVoidPointer(0)) : nullptr;
}

template <typename T>
bool AreEqual(const nurbs::ArrayView<T>& a, const nurbs::ArrayView<T>& b)
{
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin());
}

bool HaveOneStructure(const nurbs::SurfaceView& a, const nurbs::SurfaceView& b)
{
  return a.Degree[0] == b.Degree[0] && a.Degree[1] == b.Degree[1] && a.Count[0] == b.Count[0] &&
    a.Count[1] == b.Count[1] && AreEqual(a.Knots[0], b.Knots[0]) &&
    AreEqual(a.Knots[1], b.Knots[1]) && !a.Ids == !b.Ids &&
    (!a.Ids || std::equal(a.Ids, a.Ids + a.Size(), b.Ids));
}

bool AreEqual(const nurbs::TrimCurve& a, const nurbs::TrimCurve& b)
{
  bool same = a.Edge == b.Edge && a.Reversed == b.Reversed &&
    a.Geometry.Degree == b.Geometry.Degree && a.Geometry.Count == b.Geometry.Count &&
    AreEqual(a.Geometry.Knots, b.Geometry.Knots);
  for (int k = 0; same && k < a.Geometry.Count; ++k)
  {
    same = a.Geometry.Homogeneous(k) == b.Geometry.Homogeneous(k);
  }
  return same;
}

bool HaveOneStructure(
  const nurbs::Model& a, const nurbs::Face& inA, const nurbs::Model& b, const nurbs::Face& inB)
{
  bool same = inA.Reversed == inB.Reversed && inA.LoopCount == inB.LoopCount &&
    HaveOneStructure(inA.Geometry, inB.Geometry);
  for (std::int64_t l = 0; same && l < inA.LoopCount; ++l)
  {
    const nurbs::TrimLoop& loop = a.Loops[inA.FirstLoop + l];
    const nurbs::TrimLoop& other = b.Loops[inB.FirstLoop + l];
    same = loop.CurveCount == other.CurveCount;
    for (std::int64_t c = 0; same && c < loop.CurveCount; ++c)
    {
      same = AreEqual(a.TrimCurves[loop.FirstCurve + c], b.TrimCurves[other.FirstCurve + c]);
    }
  }
  return same;
}

bool HasFitWeights(vtkUnstructuredGrid* grid)
{
  vtkDataArray* weights = vtkNURBSModel::GetWeights(grid);
  return !weights ||
    (weights->GetNumberOfComponents() == 1 &&
      weights->GetNumberOfTuples() == grid->GetNumberOfPoints());
}

} // namespace

vtkNURBSFrameModel::vtkNURBSFrameModel(vtkUnstructuredGrid* grid)
  : PointCount(grid->GetNumberOfPoints())
{
  std::vector<vtkAbstractArray*> arrays = StructureOf(grid);
  this->StructureStamps = StampsOf(arrays);
  this->Structure->SetPoints(grid->GetPoints());
  this->Structure->GetPointData()->ShallowCopy(grid->GetPointData());
  this->Structure->GetCellData()->ShallowCopy(grid->GetCellData());
  vtkNew<vtkCellArray> cells;
  cells->DeepCopy(grid->GetCells());
  this->Structure->SetCells(grid->GetCellTypesArray(), cells);
  arrays.resize(arrays.size() - 2); // Without those of the cells.
  for (vtkAbstractArray* array : arrays)
  {
    vtkSmartPointer<vtkAbstractArray> copy;
    copy.TakeReference(array->NewInstance());
    copy->DeepCopy(array);
    this->Arrays.push_back(copy);
    const bool ofCells = vtkNURBSModel::IsStructureArray(array->GetName());
    vtkFieldData* field = this->Structure->GetFieldData();
    (ofCells ? this->Structure->GetCellData() : field)->AddArray(copy);
  }
  this->Arrays.emplace_back(cells->GetOffsetsArray());
  this->Arrays.emplace_back(cells->GetConnectivityArray());
  this->View = vtkNURBSModel::View(this->Structure);
  this->Model = this->View->GetModel();
  for (std::size_t f = 0; f < this->Model.Faces.size(); ++f)
  {
    this->FaceErrors.push_back(this->View->GetFaceError(vtkIdType(f)));
  }
  this->FindProblem(grid);
  if (HasFitWeights(grid))
  {
    this->TakePoints(grid);
  }
}

vtkNURBSFrameModel::~vtkNURBSFrameModel() = default;

bool vtkNURBSFrameModel::HasStructureOf(vtkUnstructuredGrid* grid)
{
  if (grid->GetNumberOfPoints() != this->PointCount || !HasFitWeights(grid))
  {
    return false;
  }
  const std::vector<vtkAbstractArray*> arrays = StructureOf(grid);
  const vtkNURBSArrayContent::Stamps stamps = StampsOf(arrays);
  if (stamps == this->StructureStamps)
  {
    return true;
  }
  if (arrays.size() != this->Arrays.size())
  {
    return false;
  }
  for (std::size_t k = 0; k < arrays.size(); ++k)
  {
    if (!vtkNURBSArrayContent::IsSame(arrays[k], this->Arrays[k]))
    {
      return false;
    }
  }
  this->StructureStamps = stamps;
  return true;
}

std::vector<char> vtkNURBSFrameModel::FindChangedFaces(const vtkNURBSFrameModel& other) const
{
  const nurbs::Model& a = this->Model;
  const nurbs::Model& b = other.Model;
  std::vector<char> changed;
  if (a.Faces.size() != b.Faces.size() || a.Loops.size() != b.Loops.size() ||
    a.TrimCurves.size() != b.TrimCurves.size() || a.Edges.size() != b.Edges.size())
  {
    return changed;
  }
  for (std::size_t e = 0; e < a.Edges.size(); ++e)
  {
    if (a.Edges[e].Vertex[0] != b.Edges[e].Vertex[0] ||
      a.Edges[e].Vertex[1] != b.Edges[e].Vertex[1] ||
      (a.Edges[e].Geometry.Count == 1) != (b.Edges[e].Geometry.Count == 1))
    {
      return changed;
    }
  }
  for (std::size_t f = 0; f < a.Faces.size(); ++f)
  {
    const bool same = this->FaceErrors[f].empty() == other.FaceErrors[f].empty() &&
      HaveOneStructure(a, a.Faces[f], b, b.Faces[f]);
    changed.push_back(!same);
  }
  return changed;
}

void vtkNURBSFrameModel::TakeStructure(const vtkNURBSFrameModel& other)
{
  this->Arrays = other.Arrays;
  this->StructureStamps = other.StructureStamps;
  this->PointCount = other.PointCount;
}

bool vtkNURBSFrameModel::HasPointsOf(vtkUnstructuredGrid* grid) const
{
  return PointStampsOf(grid) == this->PointStamps;
}

void vtkNURBSFrameModel::TakePoints(vtkUnstructuredGrid* grid)
{
  this->PointStamps = PointStampsOf(grid);
  this->Points = AsDoubles(grid->GetPoints()->GetData());
  vtkDataArray* weights = vtkNURBSModel::GetWeights(grid);
  const bool gone = !weights && this->Weights;
  this->Weights = gone ? Ones(this->PointCount) : AsDoubles(weights);
  for (nurbs::Face& face : this->Model.Faces)
  {
    if (face.Geometry.Points)
    {
      face.Geometry.Points = Values(this->Points);
      face.Geometry.Weights = Values(this->Weights);
    }
  }
}

// Faces that have only bad control points against them would come back with the next frame: such a
// frame is as bad as a later one. So is one where all control points are in one place.
void vtkNURBSFrameModel::FindProblem(vtkUnstructuredGrid* grid)
{
  vtkDataArray* weights = HasFitWeights(grid) ? vtkNURBSModel::GetWeights(grid) : nullptr;
  vtkNew<vtkIdList> ids;
  for (std::size_t f = 0; f < this->FaceErrors.size(); ++f)
  {
    if (this->FaceErrors[f].empty())
    {
      continue;
    }
    grid->GetCellPoints(vtkIdType(f), ids);
    for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k)
    {
      const vtkIdType id = ids->GetId(k);
      if (id < 0 || id >= this->PointCount)
      {
        break;
      }
      const nurbs::Vec3 x(grid->GetPoint(id));
      const double weight = weights ? weights->GetComponent(id, 0) : 1.0;
      if (!(x.norm() < 1e50) || !(weight > 0.0) || !std::isfinite(weight))
      {
        this->Problem = "face " + std::to_string(vtkNURBSModel::GetFaceId(grid, vtkIdType(f))) +
          ": " + this->FaceErrors[f] + " (point " + std::to_string(id) + ")";
        return;
      }
    }
  }
  nurbs::Box3 box;
  std::int64_t usable = 0;
  for (const nurbs::Face& face : this->Model.Faces)
  {
    for (std::int64_t k = 0; k < face.Geometry.Size(); ++k, ++usable)
    {
      box.extend(face.Geometry.Point(k));
    }
  }
  if (usable > 0 && box.diagonal().norm() == 0.0)
  {
    this->Problem = "all control points are in one place";
  }
}
