// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkNURBSMeshOutput.h
 * @brief Moves the kernels' meshes and polylines into vtkPolyData. Private to this module.
 */
#ifndef vtkNURBSMeshOutput_h
#define vtkNURBSMeshOutput_h

#include "Tessellator.h"
#include "vtkType.h"

class vtkPolyData;
class vtkUnstructuredGrid;

namespace vtkNURBSMeshOutput
{

/// The part of a tessellation that belongs to one model: meshes and polylines [First, Last).
struct Range
{
  nurbs::TessellationResult* Result = nullptr;
  std::size_t FirstMesh = 0, LastMesh = 0;
  std::size_t FirstLine = 0, LastLine = 0;
  double Tolerance = 0.0;                 ///< Told in the output's field data.
  const double* FaceTolerances = nullptr; ///< Likewise, from FirstMesh on; null: all the same.
  const char* IsGhost = nullptr; ///< Meshes that are not told of, from FirstMesh on; null: none.
  bool MergePoints = false;
};

/// Fills `mesh` (port 0 of vtkNURBSTessellator), which is empty; the meshes of the range are emptied
/// on the way.
void FillMesh(const Range& range, vtkUnstructuredGrid* grid, vtkPolyData* mesh);

/// Fills `lines` (port 1), which are empty. Edges are counted from `firstEdge`, which becomes EdgeId
/// 0.
void FillLines(
  const Range& range, vtkUnstructuredGrid* grid, std::int64_t firstEdge, vtkPolyData* lines);

/// What the field data of a mesh tell of the whole model.
double GetCertifiedError(vtkPolyData* mesh);
void SetFigures(vtkPolyData* mesh, double certifiedError, vtkIdType triangles);

} // namespace vtkNURBSMeshOutput

#endif
