// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSMeshStore.h"

#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkIdTypeArray.h"
#include "vtkPoints.h"
#include "vtkStringArray.h"
#include "vtkTypeInt64Array.h"

vtkNURBSMeshStore::vtkNURBSMeshStore()
{
  this->Coordinates->SetNumberOfComponents(3);
  this->Positions->SetData(this->Coordinates);
  this->Directions->SetNumberOfComponents(3);
  this->Directions->SetName("Normals");
  this->Parameters->SetNumberOfComponents(2);
  this->Parameters->SetName("UV");
  this->Owners->SetName("Faces");
  this->Offsets->InsertNextValue(0);
  this->Cells->SetData(this->Offsets, this->Indices);
  this->Resize(0, 0);
}

vtkNURBSMeshStore::~vtkNURBSMeshStore() = default;

void vtkNURBSMeshStore::SetTupleCount(vtkAbstractArray* array, vtkIdType tuples)
{
  const vtkIdType values = tuples * array->GetNumberOfComponents();
  if (auto* strings = vtkStringArray::SafeDownCast(array))
  {
    // SetNumberOfValues would copy all of them each time. This sets the number only.
    const vtkStdString last =
      values > 0 && values <= strings->GetSize() ? *strings->GetPointer(values - 1) : "";
    strings->Allocate(0);
    if (values > 0)
    {
      strings->InsertValue(values - 1, last);
    }
    return;
  }
  if (values > array->GetSize())
  {
    array->Resize(tuples); // Adds the new size to the old one.
  }
  array->SetNumberOfTuples(tuples);
}

void vtkNURBSMeshStore::Resize(std::int64_t points, std::int64_t triangles)
{
  if (points != this->PointCount)
  {
    SetTupleCount(this->Coordinates, points);
    SetTupleCount(this->Directions, points);
    SetTupleCount(this->Parameters, points);
  }
  if (triangles != this->TriangleCount)
  {
    SetTupleCount(this->Indices, 3 * triangles);
    SetTupleCount(this->Owners, triangles);
    SetTupleCount(this->Offsets, triangles + 1);
    vtkTypeInt64* offsets = this->Offsets->GetPointer(0);
    for (; this->FilledOffsets <= triangles; ++this->FilledOffsets)
    {
      offsets[this->FilledOffsets] = 3 * this->FilledOffsets;
    }
  }
  this->PointCount = points;
  this->TriangleCount = triangles;
  this->Points = this->Coordinates->GetPointer(0);
  this->Normals = this->Directions->GetPointer(0);
  this->UV = this->Parameters->GetPointer(0);
  // Both are 64 bits wide, be they long or long long.
  this->Corners = static_cast<std::int64_t*>(this->Indices->GetVoidPointer(0));
  this->Faces = static_cast<std::int64_t*>(this->Owners->GetVoidPointer(0));
}

void vtkNURBSMeshStore::MarkModified(const nurbs::FrameReport& report)
{
  const bool numbers = report.InsertedVertices > 0 || report.DeletedVertices > 0 ||
    this->PointCount != this->MarkedPoints;
  const bool count = this->TriangleCount != this->MarkedTriangles;
  const bool triangles = count || report.FirstTriangle >= 0;
  if (report.MovedControlPoints > 0 || report.TopologyChanged || numbers)
  {
    this->Coordinates->Modified();
    this->Positions->Modified();
    this->Directions->Modified();
  }
  if (numbers)
  {
    this->Parameters->Modified();
  }
  if (triangles)
  {
    this->Indices->Modified();
    this->Owners->Modified();
    this->Cells->Modified();
  }
  if (count)
  {
    this->Offsets->Modified();
  }
  this->MarkedPoints = this->PointCount;
  this->MarkedTriangles = this->TriangleCount;
}
