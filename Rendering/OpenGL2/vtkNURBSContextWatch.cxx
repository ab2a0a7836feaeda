// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSContextWatch.h"

#include "vtkObjectFactory.h"
#include "vtkOpenGLRenderWindow.h"

vtkStandardNewMacro(vtkNURBSContextWatch);

void vtkNURBSContextWatch::ReleaseGraphicsResources(vtkWindow* window)
{
  this->OnRelease(static_cast<vtkOpenGLRenderWindow*>(window));
  this->Superclass::ReleaseGraphicsResources(window);
}
