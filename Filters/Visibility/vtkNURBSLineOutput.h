// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkNURBSLineOutput.h
 * @brief Moves the lines of nurbs::MakeSilhouettes into vtkPolyData. Private to this module.
 */
#ifndef vtkNURBSLineOutput_h
#define vtkNURBSLineOutput_h

#include "Silhouette.h"

class vtkPolyData;
class vtkUnstructuredGrid;

namespace vtkNURBSLineOutput
{

/// The part of the lines that belongs to one model: faces [First, Last).
struct Range
{
  const nurbs::Silhouettes* Result = nullptr;
  std::size_t First = 0, Last = 0;
  std::int64_t FirstEdge = 0;
};

/// Fills an output of vtkNURBSSilhouette.
void FillLines(const Range& range, vtkUnstructuredGrid* grid, vtkPolyData* output);

} // namespace vtkNURBSLineOutput

#endif
