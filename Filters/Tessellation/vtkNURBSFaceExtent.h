// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkNURBSFaceExtent.h
 * @brief How large faces are in a view. Private to this module.
 */
#ifndef vtkNURBSFaceExtent_h
#define vtkNURBSFaceExtent_h

#include "ModelExtent.h"

class vtkCamera;

namespace vtkNURBSFaceExtent
{

/// The length, in space, that looks `pixels` long in the view at the depth of each box's nearest
/// corner, wherever in the view it is and however it is turned; of a box behind the near plane, at
/// its distance from the eye. At least `least`.
std::vector<double> PixelTolerances(const std::vector<nurbs::Box3>& boxes, vtkCamera* camera,
  const int viewport[2], double pixels, double least);

} // namespace vtkNURBSFaceExtent

#endif
