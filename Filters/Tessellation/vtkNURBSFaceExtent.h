// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkNURBSFaceExtent.h
 * @brief How large faces are, in space and in a view. Private to this module.
 */
#ifndef vtkNURBSFaceExtent_h
#define vtkNURBSFaceExtent_h

#include "Model.h"

class vtkCamera;

namespace vtkNURBSFaceExtent
{

/// A box around points of each face: 5 x 5 samples (2 in a linear direction) of its surface over the
/// box of its loops. Empty for faces with an error.
std::vector<nurbs::Box3> FaceBoxes(const nurbs::Model& model,
  const std::vector<std::string>& faceErrors, const nurbs::ParallelFor& parallel);

/// The diagonal of the box around all boxes; 0 if there is none.
double Diagonal(const std::vector<nurbs::Box3>& boxes);

/// The length, in space, that looks `pixels` long in the view at the depth of each box's nearest
/// corner, wherever in the view it is and however it is turned; of a box behind the near plane, at
/// its distance from the eye. At least `least`.
std::vector<double> PixelTolerances(const std::vector<nurbs::Box3>& boxes, vtkCamera* camera,
  const int viewport[2], double pixels, double least);

} // namespace vtkNURBSFaceExtent

#endif
