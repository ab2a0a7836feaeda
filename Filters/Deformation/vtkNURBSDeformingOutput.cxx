// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSDeformingOutput.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkIdTypeArray.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSNewArray.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <chrono>
#include <cstring>

namespace
{

void AddRange(vtkFieldData* field, const char* name, const vtkIdType (&ends)[2])
{
  vtkNew<vtkIdTypeArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(2);
  array->InsertNextTypedTuple(ends);
  field->AddArray(array);
}

double Now()
{
  using namespace std::chrono;
  return duration<double>(steady_clock::now().time_since_epoch()).count();
}

} // namespace

vtkNURBSDeformingOutput::vtkNURBSDeformingOutput()
{
  this->Changed->SetName("Changed");
  this->Mesh->SetPoints(this->Store.GetPoints());
  this->Mesh->SetPolys(this->Store.GetCells());
  this->Mesh->GetPointData()->SetNormals(this->Store.GetNormals());
  this->Mesh->GetPointData()->AddArray(this->Store.GetUV());
}

vtkNURBSDeformingOutput::~vtkNURBSDeformingOutput() = default;

void vtkNURBSDeformingOutput::SetMask(const std::vector<unsigned char>* changed, bool mask)
{
  const vtkIdType count = this->Store.PointCount;
  vtkIdType first = -1, last = -1;
  if (changed)
  {
    const auto at = std::find(changed->begin(), changed->end(), 1);
    if (at != changed->end())
    {
      first = at - changed->begin();
      last = changed->rend() - std::find(changed->rbegin(), changed->rend(), 1) - 1;
    }
  }
  const bool wasEmpty = this->ChangedRange[0] < 0;
  this->ChangedRange[0] = first;
  this->ChangedRange[1] = last;
  vtkPointData* data = this->Mesh->GetPointData();
  const bool had = data->HasArray("Changed") != 0;
  if (!mask)
  {
    data->RemoveArray("Changed");
    return;
  }
  if (had && wasEmpty && first < 0 && this->Changed->GetNumberOfTuples() == count)
  {
    return;
  }
  vtkNURBSMeshStore::SetTupleCount(this->Changed, count);
  if (changed && count > 0)
  {
    std::memcpy(this->Changed->GetPointer(0), changed->data(), static_cast<std::size_t>(count));
  }
  else if (count > 0)
  {
    std::memset(this->Changed->GetPointer(0), 0, static_cast<std::size_t>(count));
  }
  this->Changed->Modified();
  if (!had)
  {
    data->AddArray(this->Changed);
  }
}

void vtkNURBSDeformingOutput::Update(
  const nurbs::FrameReport& report, const std::vector<unsigned char>& changed, bool mask)
{
  this->Store.MarkModified(report);
  this->SetMask(&changed, mask);
  if (report.TopologyChanged)
  {
    this->Mesh->DeleteCells(); // And the links.
  }
  this->Mesh->Modified();
}

void vtkNURBSDeformingOutput::Rest(nurbs::FrameReport& report, bool mask)
{
  report.MovedControlPoints = report.UpdatedVertices = 0;
  report.InsertedVertices = report.DeletedVertices = 0;
  report.CompareSeconds = report.MoveSeconds = report.AdaptSeconds = report.RebuildSeconds = 0.0;
  report.TopologyChanged = false;
  report.FirstTriangle = report.LastTriangle = -1;
  this->SetMask(nullptr, mask);
}

void vtkNURBSDeformingOutput::TakeAttributes(
  vtkUnstructuredGrid* grid, const nurbs::FrameReport& report)
{
  this->Attributes.Update(grid, this->Store.GetFaces(), report.FirstTriangle, report.LastTriangle);
  this->Mesh->GetCellData()->ShallowCopy(this->Attributes.GetData());
}

double vtkNURBSDeformingOutput::Tell(
  vtkUnstructuredGrid* grid, const nurbs::FrameReport& report, double start)
{
  const double seconds = Now() - start;
  vtkFieldData* field = this->Mesh->GetFieldData();
  field->Initialize();
  vtkNURBSModel::PassWithoutStructure(grid->GetFieldData(), field);
  const auto count = [field](const char* name, std::int64_t value) {
    vtkNURBSAddValue<vtkIdTypeArray>(field, name, static_cast<vtkIdType>(value));
  };
  count("MovedControlPoints", report.MovedControlPoints);
  count("UpdatedVertices", report.UpdatedVertices);
  count("InsertedVertices", report.InsertedVertices);
  count("DeletedVertices", report.DeletedVertices);
  count("CappedCells", report.CappedCells);
  count("CrossingFaces", report.CrossingFaces);
  count("NumberOfTriangles", this->Store.TriangleCount);
  const vtkIdType triangles[2] = { report.FirstTriangle, report.LastTriangle };
  AddRange(field, "ChangedPointRange", this->ChangedRange);
  AddRange(field, "ChangedTriangleRange", triangles);
  vtkNURBSAddValue<vtkDoubleArray>(field, "ErrorBound", report.ErrorBound);
  vtkNURBSAddValue<vtkDoubleArray>(field, "ModelGap", report.ModelGap);
  vtkNURBSAddValue<vtkDoubleArray>(field, "ToleranceUsed", report.ToleranceUsed);
  vtkNURBSAddValue<vtkDoubleArray>(field, "CompareSeconds", report.CompareSeconds);
  vtkNURBSAddValue<vtkDoubleArray>(field, "MoveSeconds", report.MoveSeconds);
  vtkNURBSAddValue<vtkDoubleArray>(field, "AdaptSeconds", report.AdaptSeconds);
  vtkNURBSAddValue<vtkDoubleArray>(field, "RebuildSeconds", report.RebuildSeconds);
  vtkNURBSAddValue<vtkDoubleArray>(field, "OutputSeconds", seconds);
  return seconds;
}
