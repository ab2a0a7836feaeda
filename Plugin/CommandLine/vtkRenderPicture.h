// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A picture of a tessellated model, drawn offscreen.
#ifndef vtkRenderPicture_h
#define vtkRenderPicture_h

#include "vtkSmartPointer.h"

#include <array>
#include <string>

class vtkCamera;
class vtkPoints;
class vtkPolyData;

namespace nurbs
{

/// What the picture shows and how large it is.
struct Picture
{
  std::array<int, 2> Size;
  std::array<double, 3> View; ///< from the object to the viewer, any length but 0
  bool Transparent = false;
  int Device = -1; ///< EGL device, -1: the first that works
};

/// A perspective camera looking against `view`, z up (y where the view is along z), so near that
/// the points just fill a picture of `size` with a margin; clipping planes as close as they may be.
vtkSmartPointer<vtkCamera> FitCamera(
  vtkPoints* points, const std::array<double, 3>& view, const std::array<int, 2>& size);

/// Throws Failure if there is no OpenGL to draw with, or the picture cannot be written. `edges` may
/// be null; cell data Color colours the faces.
void RenderPicture(
  vtkPolyData* mesh, vtkPolyData* edges, const Picture& picture, const std::string& path);

} // namespace nurbs

#endif
