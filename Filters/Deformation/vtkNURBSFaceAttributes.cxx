// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSFaceAttributes.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkIdTypeArray.h"
#include "vtkNURBSMeshStore.h"
#include "vtkNURBSModel.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cstring>

namespace
{

// to[k] = from[faces[k]] for the triangles of a list.
void CopyTuples(vtkAbstractArray* from, const std::vector<vtkIdType>& triangles,
  const vtkIdType* faces, vtkAbstractArray* to)
{
  if (!from)
  {
    auto* ids = vtkDataArray::SafeDownCast(to);
    for (const vtkIdType t : triangles)
    {
      ids->SetTuple1(t, static_cast<double>(faces[t]));
    }
    return;
  }
  if (!vtkDataArray::SafeDownCast(from) || from->GetDataType() == VTK_BIT ||
    !from->HasStandardMemoryLayout() || !to->HasStandardMemoryLayout())
  {
    for (const vtkIdType t : triangles)
    {
      to->SetTuple(t, faces[t], from);
    }
    return;
  }
  const std::size_t bytes =
    static_cast<std::size_t>(from->GetDataTypeSize()) * from->GetNumberOfComponents();
  const char* source = static_cast<const char*>(from->GetVoidPointer(0));
  char* target = static_cast<char*>(to->GetVoidPointer(0));
  for (const vtkIdType t : triangles)
  {
    std::memcpy(target + t * bytes, source + faces[t] * bytes, bytes);
  }
}

} // namespace

vtkNURBSFaceAttributes::vtkNURBSFaceAttributes() = default;
vtkNURBSFaceAttributes::~vtkNURBSFaceAttributes() = default;

// Arrays that a filter upstream made anew with the same values are the same.
bool vtkNURBSFaceAttributes::HasSources(vtkUnstructuredGrid* grid)
{
  vtkCellData* data = grid->GetCellData();
  vtkNURBSArrayContent::Stamps stamps;
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
  {
    vtkNURBSArrayContent::Append(data->GetAbstractArray(i), stamps);
  }
  if (stamps == this->SeenStamps)
  {
    return true;
  }
  int copied = 0;
  for (std::size_t k = 0; k < this->Sources.size(); ++k)
  {
    vtkAbstractArray* source = this->Sources[k];
    vtkAbstractArray* now = data->GetAbstractArray(this->Data->GetAbstractArray(int(k))->GetName());
    copied += source != nullptr;
    if ((source != nullptr) != (now && now->GetNumberOfTuples() == grid->GetNumberOfCells()))
    {
      return false;
    }
    if (source &&
      (source->GetMTime() != this->OwnStamps[k].second ||
        !vtkNURBSArrayContent::IsSame(source, now)))
    {
      return false;
    }
  }
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = data->GetAbstractArray(i);
    copied -= array->GetName() && !vtkNURBSModel::IsStructureArray(array->GetName()) &&
      array->GetNumberOfTuples() == grid->GetNumberOfCells();
  }
  if (copied != 0)
  {
    return false;
  }
  this->SeenStamps = stamps;
  return true;
}

void vtkNURBSFaceAttributes::Make(vtkUnstructuredGrid* grid, vtkIdTypeArray* faces)
{
  this->Data->Initialize();
  this->Sources.clear();
  this->OwnStamps.clear();
  this->SeenStamps.clear();
  vtkNURBSModel::CopyFaceAttributes(grid, faces, this->Data);
  vtkCellData* data = grid->GetCellData();
  for (int i = 0; i < this->Data->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* from = data->GetAbstractArray(this->Data->GetAbstractArray(i)->GetName());
    this->Sources.emplace_back(
      from && from->GetNumberOfTuples() == grid->GetNumberOfCells() ? from : nullptr);
    vtkNURBSArrayContent::Append(from, this->OwnStamps);
  }
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
  {
    vtkNURBSArrayContent::Append(data->GetAbstractArray(i), this->SeenStamps);
  }
  const vtkIdType* owners = faces->GetPointer(0);
  this->Owners.assign(owners, owners + faces->GetNumberOfTuples());
  this->Made = true;
}

void vtkNURBSFaceAttributes::Update(
  vtkUnstructuredGrid* grid, vtkIdTypeArray* faces, vtkIdType first, vtkIdType last)
{
  if (!this->Made || !this->HasSources(grid))
  {
    this->Make(grid, faces);
    return;
  }
  const vtkIdType count = faces->GetNumberOfTuples();
  const auto before = static_cast<vtkIdType>(this->Owners.size());
  const vtkIdType* owners = faces->GetPointer(0);
  std::vector<vtkIdType> changed;
  for (vtkIdType t = std::max<vtkIdType>(0, first); t <= last && t < std::min(before, count); ++t)
  {
    if (this->Owners[t] != owners[t])
    {
      changed.push_back(t);
    }
  }
  for (vtkIdType t = before; t < count; ++t)
  {
    changed.push_back(t);
  }
  if (changed.empty() && count == before)
  {
    return;
  }
  this->Owners.resize(count);
  for (const vtkIdType t : changed)
  {
    this->Owners[t] = owners[t];
  }
  for (std::size_t k = 0; k < this->Sources.size(); ++k)
  {
    vtkAbstractArray* to = this->Data->GetAbstractArray(int(k));
    vtkNURBSMeshStore::SetTupleCount(to, count);
    CopyTuples(this->Sources[k], changed, owners, to);
    to->Modified();
  }
}
