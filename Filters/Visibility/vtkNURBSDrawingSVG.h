// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkNURBSDrawingSVG.h
 * @brief SVG made of a drawing, by VTK's pugixml. Private to this module.
 */
#ifndef vtkNURBSDrawingSVG_h
#define vtkNURBSDrawingSVG_h

#include "Drawing.h"

namespace vtkNURBSDrawingSVG
{

/// An SVG file's bytes. Units are millimetres. The groups "hidden" and "visible" are layers of
/// Inkscape, and have a group a kind of line: id "hidden-sharp", classes "hidden sharp", styled by
/// attributes. A line is a path with the attributes data-face, data-edge and data-part.
std::string Make(const nurbs::Drawing& drawing);

} // namespace vtkNURBSDrawingSVG

#endif
