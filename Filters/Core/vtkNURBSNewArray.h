// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkNURBSNewArray.h
 * @brief Named arrays of outputs, for the vtk* files of the suite. Not installed.
 */
#ifndef vtkNURBSNewArray_h
#define vtkNURBSNewArray_h

#include "vtkFieldData.h"
#include "vtkSmartPointer.h"

/// An array whose values are to be set.
template <typename ArrayT>
vtkSmartPointer<ArrayT> vtkNURBSNewArray(const char* name, int components, vtkIdType tuples = 0)
{
  auto array = vtkSmartPointer<ArrayT>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(tuples);
  return array;
}

/// Adds an array of one value.
template <typename ArrayT, typename T>
void vtkNURBSAddValue(vtkFieldData* field, const char* name, T value)
{
  auto array = vtkNURBSNewArray<ArrayT>(name, 1, 1);
  array->SetValue(0, value);
  field->AddArray(array);
}

#endif
