// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkNURBSLookLegend.h
 * @brief The bar beside surfaces that show a curvature or a draft angle: which colour is which number.
 *
 * Private to this module.
 */
#ifndef vtkNURBSLookLegend_h
#define vtkNURBSLookLegend_h

#include "vtkSmartPointer.h"

class vtkNURBSMapper;
class vtkScalarBarActor;

namespace vtkNURBSLookLegend
{

/// A bar at the left border of a view, not visible yet.
vtkSmartPointer<vtkScalarBarActor> Make();

/// Gives the bar the mapper's colours, and a title with the unit of its first model. It is visible if
/// it is wanted and the mapper shows what a bar can tell.
void Update(vtkScalarBarActor* bar, vtkNURBSMapper* mapper, bool wanted);

} // namespace vtkNURBSLookLegend

#endif
