// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkNURBSScreen.h
 * @brief What a vtkRenderer shows where, for HandleSearch. Private to this module.
 */
#ifndef vtkNURBSScreen_h
#define vtkNURBSScreen_h

#include "HandleSearch.h"

class vtkRenderer;

namespace vtkNURBSScreen
{

/// The renderer's projection; false if there is no window or camera yet. Never makes a camera.
bool MakeView(vtkRenderer* renderer, nurbs::ScreenView& view);

/// Which of the hits the last picture hides: those farther behind something than `pixels` are wide
/// there. None before the first picture.
std::vector<bool> FindHidden(vtkRenderer* renderer, const nurbs::ScreenView& view,
  const std::vector<nurbs::HandleHit>& hits, double pixels);

} // namespace vtkNURBSScreen

#endif
