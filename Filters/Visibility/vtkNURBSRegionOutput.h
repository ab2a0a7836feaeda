// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkNURBSRegionOutput.h
 * @brief Visible regions and the lines of a drawing as VTK data.
 */
#ifndef vtkNURBSRegionOutput_h
#define vtkNURBSRegionOutput_h

#include "VisibleRegions.h"
#include "vtkNURBSModelPool.h"

namespace vtkNURBSRegionOutput
{

/// Which lines a drawing has, and where.
struct LineChoice
{
  bool Kinds[nurbs::LineKindCount + 1] = { true, true, true, false, true };
  bool Hidden = true;
  bool Project = false; ///< To x and y in the image plane.
};

/// Fills the output of regions of one model with their faces.
void FillModel(const nurbs::VisibleRegions& result, const vtkNURBSModelPool::Leaf& leaf,
  vtkUnstructuredGrid* output);

/// Fills the output of lines with those of one model.
void FillLines(const nurbs::VisibleRegions& result, const vtkNURBSModelPool::Leaf& leaf,
  const LineChoice& choice, vtkPolyData* output);

} // namespace vtkNURBSRegionOutput

#endif
