// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkNURBSLevelOutput.h
 * @brief Moves the meshes of nurbs::WaveletModel into vtkPolyData. Private to this module.
 */
#ifndef vtkNURBSLevelOutput_h
#define vtkNURBSLevelOutput_h

#include "WaveletModel.h"

class vtkPolyData;
class vtkUnstructuredGrid;

namespace vtkNURBSLevelOutput
{

/// The part of the meshes that belongs to one model: faces [First, Last).
struct Range
{
  const nurbs::WaveletModel* Model = nullptr;
  nurbs::WaveletMeshes* Meshes = nullptr;
  std::size_t First = 0, Last = 0;
};

/// Fills the output of vtkNURBSWaveletLOD; the meshes of the range are emptied on the way.
void FillMesh(const Range& range, vtkUnstructuredGrid* grid, vtkPolyData* mesh);

} // namespace vtkNURBSLevelOutput

#endif
