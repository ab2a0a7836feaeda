// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNURBSFaceMarks
 * @brief Where labels of faces stand: each face of a model as a point on it
 *
 * ParaView labels a cell at the middle one of its points, which of a model are control points. The
 * output has the input's type and structure. In the place of a model is a vtkUnstructuredGrid of as
 * many vertices, on the faces and well inside their trims (nurbs::InnerPoint), with the model's cell
 * data; a face that can't be used stays at a control point. Whatever is no model is passed on. Private
 * to this module.
 */
#ifndef vtkNURBSFaceMarks_h
#define vtkNURBSFaceMarks_h

#include "vtkPassInputTypeAlgorithm.h"

class vtkNURBSFaceMarks : public vtkPassInputTypeAlgorithm
{
public:
  static vtkNURBSFaceMarks* New();
  vtkTypeMacro(vtkNURBSFaceMarks, vtkPassInputTypeAlgorithm);

  ///@{
  /**
   * Pass models on, too: where their control points have labels of their own. Default off.
   */
  vtkSetMacro(KeepModels, bool);
  vtkGetMacro(KeepModels, bool);
  ///@}

protected:
  vtkNURBSFaceMarks() = default;
  ~vtkNURBSFaceMarks() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkNURBSFaceMarks(const vtkNURBSFaceMarks&) = delete;
  void operator=(const vtkNURBSFaceMarks&) = delete;

  bool KeepModels = false;
};

#endif
