// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNURBSControlNet
 * @brief The control nets of a NURBS model as points, lines and quadrilaterals.
 *
 * Input: a model (see vtkNURBSModel). Output: vtkPolyData on the same points, with the model's
 * point data (weights among them). For every face
 *
 * - GeneratePoints: one VTK_POLY_VERTEX of its control points;
 * - GenerateLines: one VTK_POLY_LINE for every row in u and every column in v;
 * - GenerateQuads: the quadrilaterals between them, oriented as Su x Sv.
 *
 * Cell data: all attributes of the face (FaceId, Color, Name, any other).
 *
 * Faces with errors are left out and named in a warning. Trimming is not regarded: the net is that
 * of the whole surface.
 */
#ifndef vtkNURBSControlNet_h
#define vtkNURBSControlNet_h

#include "vtkNURBSFiltersCoreModule.h" // For export macro
#include "vtkPolyDataAlgorithm.h"

class VTKNURBSFILTERSCORE_EXPORT vtkNURBSControlNet : public vtkPolyDataAlgorithm
{
public:
  static vtkNURBSControlNet* New();
  vtkTypeMacro(vtkNURBSControlNet, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Make one poly-vertex cell a face. Default on.
   */
  vtkSetMacro(GeneratePoints, bool);
  vtkGetMacro(GeneratePoints, bool);
  vtkBooleanMacro(GeneratePoints, bool);
  ///@}

  ///@{
  /**
   * Make one polyline a row and column of the net. Default on.
   */
  vtkSetMacro(GenerateLines, bool);
  vtkGetMacro(GenerateLines, bool);
  vtkBooleanMacro(GenerateLines, bool);
  ///@}

  ///@{
  /**
   * Make the net's quadrilaterals. Default off.
   */
  vtkSetMacro(GenerateQuads, bool);
  vtkGetMacro(GenerateQuads, bool);
  vtkBooleanMacro(GenerateQuads, bool);
  ///@}

protected:
  vtkNURBSControlNet();
  ~vtkNURBSControlNet() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

  bool GeneratePoints = true;
  bool GenerateLines = true;
  bool GenerateQuads = false;

private:
  vtkNURBSControlNet(const vtkNURBSControlNet&) = delete;
  void operator=(const vtkNURBSControlNet&) = delete;
};

#endif
