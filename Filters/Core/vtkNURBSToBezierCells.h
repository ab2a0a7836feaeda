// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNURBSToBezierCells
 * @brief Cuts the surfaces of a NURBS model into VTK's rational Bezier quadrilaterals.
 *
 * Every pair of non-empty knot spans of a surface becomes one VTK_BEZIER_QUADRILATERAL, exactly (by
 * knot insertion), for VTK's isogeometric tools. Output: a vtkUnstructuredGrid with
 *
 * - points: Cartesian control points, (p + 1)(q + 1) a cell, in VTK's order (corners, edges,
 *   interior); cells share no points;
 * - point data RationalWeights (also marked as that attribute): the weights; absent if all input
 *   surfaces are polynomial;
 * - cell data HigherOrderDegrees (also marked): p, q, 0;
 * - cell data PatchDomain (4 reals): u0, u1, v0, v1 of the patch in the surface's domain; VTK's
 *   parametric coordinates (r, s) of the cell are ((u - u0) / (u1 - u0), (v - v0) / (v1 - v0));
 * - cell data Trimmed: 1 if trimming removes a part of the face, else 0;
 * - cell data: all attributes of the face (FaceId, Color, Name, any other).
 *
 * **Trimming loops are dropped**: Bezier cells can't be trimmed. SkipTrimmedFaces leaves out the
 * faces that would be shown larger than they are.
 *
 * VTK interpolates up to degree 10. Faces of a higher degree, and faces with errors, are left out
 * and named in a warning. Mind that VTK's derivatives of Bezier cells ignore the weights.
 */
#ifndef vtkNURBSToBezierCells_h
#define vtkNURBSToBezierCells_h

#include "vtkNURBSFiltersCoreModule.h" // For export macro
#include "vtkUnstructuredGridAlgorithm.h"

class VTKNURBSFILTERSCORE_EXPORT vtkNURBSToBezierCells : public vtkUnstructuredGridAlgorithm
{
public:
  static vtkNURBSToBezierCells* New();
  vtkTypeMacro(vtkNURBSToBezierCells, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The highest degree of VTK's Bezier cells.
  static constexpr int MaxCellDegree = 10;

  ///@{
  /**
   * Leave out faces that trimming removes a part of. Default off: they become whole cells.
   */
  vtkSetMacro(SkipTrimmedFaces, bool);
  vtkGetMacro(SkipTrimmedFaces, bool);
  vtkBooleanMacro(SkipTrimmedFaces, bool);
  ///@}

protected:
  vtkNURBSToBezierCells();
  ~vtkNURBSToBezierCells() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

  bool SkipTrimmedFaces = false;

private:
  vtkNURBSToBezierCells(const vtkNURBSToBezierCells&) = delete;
  void operator=(const vtkNURBSToBezierCells&) = delete;
};

#endif
