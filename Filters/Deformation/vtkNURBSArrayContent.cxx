// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSArrayContent.h"

#include "vtkDataArray.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <cstring>

void vtkNURBSArrayContent::Append(vtkObject* object, Stamps& stamps)
{
  stamps.emplace_back(object, object ? object->GetMTime() : 0);
}

bool vtkNURBSArrayContent::IsSame(vtkAbstractArray* a, vtkAbstractArray* b)
{
  const char* const names[2] = { a->GetName(), b->GetName() };
  const bool named = names[0] && names[1] ? !std::strcmp(names[0], names[1]) : names[0] == names[1];
  if (!named || a->GetDataType() != b->GetDataType() ||
    a->GetNumberOfComponents() != b->GetNumberOfComponents() ||
    a->GetNumberOfTuples() != b->GetNumberOfTuples())
  {
    return false;
  }
  auto* strings = vtkStringArray::SafeDownCast(a);
  auto* others = vtkStringArray::SafeDownCast(b);
  const vtkIdType values = a->GetNumberOfValues();
  if (strings && others)
  {
    return values == 0 ||
      std::equal(strings->GetPointer(0), strings->GetPointer(0) + values, others->GetPointer(0));
  }
  auto* numbers = vtkDataArray::SafeDownCast(a);
  if (!numbers || !vtkDataArray::SafeDownCast(b) || a->GetDataType() == VTK_BIT ||
    !a->HasStandardMemoryLayout() || !b->HasStandardMemoryLayout())
  {
    return false;
  }
  return values == 0 ||
    !std::memcmp(a->GetVoidPointer(0), b->GetVoidPointer(0),
      static_cast<std::size_t>(values) * numbers->GetDataTypeSize());
}
