// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNURBSFromBezierCells
 * @brief Makes a NURBS model of VTK's rational Bezier quadrilaterals.
 *
 * Input: a vtkUnstructuredGrid with VTK_BEZIER_QUADRILATERAL cells. Every such cell becomes one
 * untrimmed surface over [0, 1] x [0, 1] whose (u, v) are the cell's parametric coordinates. The
 * degrees are taken from the attribute HigherOrderDegrees, or from the number of points if there
 * is none (a square number: equal degrees). Weights are taken from the attribute RationalWeights
 * or from the point array of that name; without, the surfaces are polynomial.
 *
 * Output: a model (see vtkNURBSModel). Sides of cells whose control points and weights agree
 * exactly are one edge that both faces share, so that a tessellation has no crack there; this
 * holds for cells that share points and for the cells that vtkNURBSToBezierCells cut from one
 * surface. All cell attributes are kept; FaceId is the cell's index if the input has none.
 *
 * Cells of other types and cells whose number of points does not fit their degrees are left out and
 * named in a warning. Degrees are 1 to 10, VTK's limit for such cells.
 */
#ifndef vtkNURBSFromBezierCells_h
#define vtkNURBSFromBezierCells_h

#include "vtkNURBSFiltersCoreModule.h" // For export macro
#include "vtkUnstructuredGridAlgorithm.h"

class VTKNURBSFILTERSCORE_EXPORT vtkNURBSFromBezierCells : public vtkUnstructuredGridAlgorithm
{
public:
  static vtkNURBSFromBezierCells* New();
  vtkTypeMacro(vtkNURBSFromBezierCells, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

protected:
  vtkNURBSFromBezierCells();
  ~vtkNURBSFromBezierCells() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  vtkNURBSFromBezierCells(const vtkNURBSFromBezierCells&) = delete;
  void operator=(const vtkNURBSFromBezierCells&) = delete;
};

#endif
