// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSModelView.h"

#include "vtkNURBSModelNames.h"
#include "vtkNURBSParallel.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <sstream>

using nurbs::ArrayView;
using nurbs::ModelProblem;
namespace names = vtkNURBSModelNames;

struct vtkNURBSModelView::Internals
{
  using Integers = nurbs::ModelArrays::Integers;
  using Reals = nurbs::ModelArrays::Reals;

  std::vector<vtkSmartPointer<vtkDataArray>> Kept; ///< Arrays that are viewed in place.
  std::deque<std::vector<std::int64_t>> OwnIntegers;
  std::deque<std::vector<double>> OwnReals;
  std::vector<ModelProblem> ArrayProblems; ///< Wrong types and components.
  nurbs::ModelArrays Arrays;
  nurbs::AssembledModel Assembled;

  void Collect(vtkUnstructuredGrid* grid);
  void CollectCells(vtkUnstructuredGrid* grid);
  void CheckCells(vtkUnstructuredGrid* grid);
  Integers ViewIntegers(vtkDataArray* array);
  Reals ViewReals(vtkDataArray* array);
  vtkDataArray* Find(vtkFieldData* data, const char* name, int components, bool required);
  Integers FindIntegers(vtkFieldData* data, const char* name, int components, bool required);
  Reals FindReals(vtkFieldData* data, const char* name, int components, bool required);
  void Fail(const std::string& reason)
  {
    this->ArrayProblems.push_back({ ModelProblem::Level::Error, -1, reason });
  }
};

namespace
{

bool IsReal(vtkDataArray* array)
{
  return array->GetDataType() == VTK_DOUBLE || array->GetDataType() == VTK_FLOAT;
}

bool IsContiguous(vtkDataArray* array)
{
  return array->HasStandardMemoryLayout();
}

} // namespace

nurbs::ModelArrays::Integers vtkNURBSModelView::Internals::ViewIntegers(vtkDataArray* array)
{
  const vtkIdType count = array->GetNumberOfValues();
  if (count == 0)
  {
    return Integers();
  }
  if (IsContiguous(array) && array->GetDataTypeSize() == 8)
  {
    this->Kept.emplace_back(array);
    return Integers(static_cast<const std::int64_t*>(array->GetVoidPointer(0)), count);
  }
  this->OwnIntegers.emplace_back(count);
  std::vector<std::int64_t>& values = this->OwnIntegers.back();
  const int width = array->GetNumberOfComponents();
  for (vtkIdType i = 0; i < count; ++i)
  {
    values[i] = static_cast<std::int64_t>(array->GetComponent(i / width, i % width));
  }
  return values;
}

nurbs::ModelArrays::Reals vtkNURBSModelView::Internals::ViewReals(vtkDataArray* array)
{
  const vtkIdType count = array->GetNumberOfValues();
  if (count == 0)
  {
    return Reals();
  }
  if (IsContiguous(array) && array->GetDataType() == VTK_DOUBLE)
  {
    this->Kept.emplace_back(array);
    return Reals(static_cast<const double*>(array->GetVoidPointer(0)), count);
  }
  this->OwnReals.emplace_back(count);
  std::vector<double>& values = this->OwnReals.back();
  const int width = array->GetNumberOfComponents();
  for (vtkIdType i = 0; i < count; ++i)
  {
    values[i] = array->GetComponent(i / width, i % width);
  }
  return values;
}

vtkDataArray* vtkNURBSModelView::Internals::Find(
  vtkFieldData* data, const char* name, int components, bool required)
{
  vtkAbstractArray* any = data->GetAbstractArray(name);
  vtkDataArray* array = vtkDataArray::SafeDownCast(any);
  if (any && !array)
  {
    this->Fail(std::string("array ") + name + " is not numeric");
  }
  else if (!array && required)
  {
    this->Fail(std::string("array ") + name + " is missing");
  }
  else if (array && array->GetNumberOfComponents() != components)
  {
    this->Fail(std::string("array ") + name + " has " +
      std::to_string(array->GetNumberOfComponents()) + " components instead of " +
      std::to_string(components));
    return nullptr;
  }
  return array;
}

nurbs::ModelArrays::Integers vtkNURBSModelView::Internals::FindIntegers(
  vtkFieldData* data, const char* name, int components, bool required)
{
  vtkDataArray* array = this->Find(data, name, components, required);
  if (array && IsReal(array))
  {
    this->Fail(std::string("array ") + name + " holds reals instead of integers");
    array = nullptr;
  }
  return array ? this->ViewIntegers(array) : Integers();
}

nurbs::ModelArrays::Reals vtkNURBSModelView::Internals::FindReals(
  vtkFieldData* data, const char* name, int components, bool required)
{
  vtkDataArray* array = this->Find(data, name, components, required);
  return array ? this->ViewReals(array) : Reals();
}

void vtkNURBSModelView::Internals::CollectCells(vtkUnstructuredGrid* grid)
{
  if (grid->GetPoints() && grid->GetPoints()->GetData())
  {
    this->Arrays.Points = this->ViewReals(grid->GetPoints()->GetData());
  }
  vtkCellArray* cells = grid->GetCells();
  if (cells && grid->GetNumberOfCells() > 0)
  {
    this->Arrays.Offsets = this->ViewIntegers(cells->GetOffsetsArray());
    this->Arrays.Connectivity = this->ViewIntegers(cells->GetConnectivityArray());
  }
}

void vtkNURBSModelView::Internals::Collect(vtkUnstructuredGrid* grid)
{
  nurbs::ModelArrays& a = this->Arrays;
  vtkFieldData* points = grid->GetPointData();
  vtkFieldData* cells = grid->GetCellData();
  vtkFieldData* field = grid->GetFieldData();
  const bool some = grid->GetNumberOfCells() > 0;
  this->CollectCells(grid);
  a.Weights = this->FindReals(points, names::RationalWeights, 1, false);
  a.Degree = this->FindIntegers(cells, names::Degree, 2, some);
  a.NetSize = this->FindIntegers(cells, names::NetSize, 2, some);
  a.KnotStart = this->FindIntegers(cells, names::KnotStart, 2, some);
  a.LoopCount = this->FindIntegers(cells, names::LoopCount, 1, false);
  a.LoopStart = this->FindIntegers(cells, names::LoopStart, 1, !a.LoopCount.empty());
  a.FaceId = this->FindIntegers(cells, names::FaceId, 1, false);
  a.Orientation = this->FindIntegers(cells, names::Orientation, 1, false);
  a.Knots = this->FindReals(field, names::Knots, 1, some);
  a.LoopCurveStart = this->FindIntegers(field, names::LoopCurveStart, 1, false);
  a.LoopCurveCount = this->FindIntegers(field, names::LoopCurveCount, 1, false);
  const bool trims = !a.LoopCurveStart.empty();
  a.TrimCurveDegree = this->FindIntegers(field, names::TrimCurveDegree, 1, trims);
  a.TrimCurveKnotStart = this->FindIntegers(field, names::TrimCurveKnotStart, 1, trims);
  a.TrimCurvePointStart = this->FindIntegers(field, names::TrimCurvePointStart, 1, trims);
  a.TrimCurvePointCount = this->FindIntegers(field, names::TrimCurvePointCount, 1, trims);
  a.TrimCurveEdgeId = this->FindIntegers(field, names::TrimCurveEdgeId, 1, false);
  a.TrimCurveReversed = this->FindIntegers(field, names::TrimCurveReversed, 1, false);
  a.TrimPoints = this->FindReals(field, names::TrimPoints, 3, trims);
  a.TrimKnots = this->FindReals(field, names::TrimKnots, 1, trims);
  a.EdgeDegree = this->FindIntegers(field, names::EdgeDegree, 1, false);
  a.EdgeKnotStart = this->FindIntegers(field, names::EdgeKnotStart, 1, false);
  a.EdgePointStart = this->FindIntegers(field, names::EdgePointStart, 1, false);
  a.EdgePointCount = this->FindIntegers(field, names::EdgePointCount, 1, false);
  a.EdgeVertices = this->FindIntegers(field, names::EdgeVertices, 2, false);
  a.EdgeTolerance = this->FindReals(field, names::EdgeTolerance, 1, false);
  a.EdgePoints = this->FindReals(field, names::EdgePoints, 4, false);
  a.EdgeKnots = this->FindReals(field, names::EdgeKnots, 1, false);
  a.VertexPoints = this->FindReals(field, names::VertexPoints, 3, false);
}

/// Warns of cells of other types and of attributes that do not fit the cells.
void vtkNURBSModelView::Internals::CheckCells(vtkUnstructuredGrid* grid)
{
  std::vector<ModelProblem>& problems = this->Assembled.Problems;
  vtkUnsignedCharArray* types = grid->GetCellTypesArray();
  for (vtkIdType i = 0; types && i < types->GetNumberOfTuples(); ++i)
  {
    if (types->GetValue(i) != VTK_POLY_VERTEX && this->Assembled.FaceErrors[i].empty())
    {
      problems.push_back({ ModelProblem::Level::Warning, i,
        "the cell's type is " + std::to_string(types->GetValue(i)) +
          " instead of VTK_POLY_VERTEX" });
    }
  }
  for (int i = 0; i < grid->GetCellData()->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = grid->GetCellData()->GetAbstractArray(i);
    if (array->GetNumberOfTuples() != grid->GetNumberOfCells())
    {
      problems.push_back({ ModelProblem::Level::Warning, -1,
        std::string("cell array ") + (array->GetName() ? array->GetName() : "without a name") +
          " has " + std::to_string(array->GetNumberOfTuples()) + " tuples for " +
          std::to_string(grid->GetNumberOfCells()) + " cells" });
    }
  }
}

vtkNURBSModelView::vtkNURBSModelView(
  vtkUnstructuredGrid* grid, const nurbs::AssembleOptions& options)
  : Content(new Internals)
{
  if (!grid)
  {
    return;
  }
  Internals& content = *this->Content;
  content.Collect(grid);
  nurbs::AssembleOptions of = options;
  const Internals::Reals bounds =
    content.FindReals(grid->GetFieldData(), names::WholeBounds, 6, false);
  if (bounds.size() == 6)
  {
    of.Around = nurbs::Box3(
      nurbs::Vec3(bounds[0], bounds[2], bounds[4]), nurbs::Vec3(bounds[1], bounds[3], bounds[5]));
  }
  content.Assembled = nurbs::AssembleModel(content.Arrays, of, vtkNURBSParallelFor);
  std::vector<ModelProblem>& problems = content.Assembled.Problems;
  problems.insert(problems.begin(), content.ArrayProblems.begin(), content.ArrayProblems.end());
  content.CheckCells(grid);
}

vtkNURBSModelView::vtkNURBSModelView()
  : Content(new Internals)
{}

vtkNURBSModelView::Raw vtkNURBSModelView::GetRaw(vtkUnstructuredGrid* grid)
{
  Raw raw;
  raw.Owner.reset(new vtkNURBSModelView);
  Internals& content = *raw.Owner->Content;
  content.Collect(grid);
  raw.Arrays = content.Arrays;
  vtkFieldData* field = grid->GetFieldData();
  raw.EdgeIds = content.FindIntegers(field, names::EdgeGlobalId, 1, false);
  raw.VertexIds = content.FindIntegers(field, names::VertexGlobalId, 1, false);
  if (raw.EdgeIds.size() != raw.Arrays.EdgeDegree.size() ||
    3 * raw.VertexIds.size() != raw.Arrays.VertexPoints.size())
  {
    raw.EdgeIds = raw.VertexIds = {}; // They number other edges.
  }
  return raw;
}

vtkNURBSModelView::~vtkNURBSModelView() = default;

const nurbs::Model& vtkNURBSModelView::GetModel() const
{
  return this->Content->Assembled.Model;
}

const std::string& vtkNURBSModelView::GetFaceError(vtkIdType cell) const
{
  return this->Content->Assembled.FaceErrors.at(cell);
}

const std::vector<ModelProblem>& vtkNURBSModelView::GetProblems() const
{
  return this->Content->Assembled.Problems;
}

std::string vtkNURBSModelView::Describe(const ModelProblem& problem) const
{
  std::ostringstream text;
  text << (problem.Severity == ModelProblem::Level::Error ? "error: " : "warning: ");
  if (problem.Face >= 0)
  {
    text << "cell " << problem.Face;
    if (problem.Face < static_cast<std::int64_t>(this->Content->Arrays.FaceId.size()))
    {
      text << " (FaceId " << this->Content->Arrays.FaceId[problem.Face] << ")";
    }
    text << ": ";
  }
  text << problem.Reason;
  return text.str();
}

std::string vtkNURBSModelView::DescribeFaceErrors() const
{
  std::string text;
  for (const ModelProblem& problem : this->GetProblems())
  {
    if (problem.Severity == ModelProblem::Level::Error)
    {
      text += (text.empty() ? "" : "\n") + this->Describe(problem);
    }
  }
  return text;
}
