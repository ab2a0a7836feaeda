// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkNURBSArrayContent.h
 * @brief Whether arrays are what they were. Private to this module.
 */
#ifndef vtkNURBSArrayContent_h
#define vtkNURBSArrayContent_h

#include "vtkType.h" // For vtkMTimeType

#include <utility> // For std::pair
#include <vector>  // For std::vector

class vtkAbstractArray;
class vtkObject;

namespace vtkNURBSArrayContent
{

/// What tells cheaply that objects are the same and have not been modified.
using Stamps = std::vector<std::pair<vtkObject*, vtkMTimeType>>;

/// Appends the stamp of an object, which may be null.
void Append(vtkObject* object, Stamps& stamps);

/// True if both have the same name, type, components and, bit for bit, values. Arrays that are not
/// contiguous, or of bits or variants, are different from all others.
bool IsSame(vtkAbstractArray* a, vtkAbstractArray* b);

} // namespace vtkNURBSArrayContent

#endif
