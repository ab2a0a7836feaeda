// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkNURBSContextWatch
 * @brief   calls a function before the OpenGL context of a window goes
 *
 * What is made in a context must be deleted in it. The function is called with the context current
 * when the window is deleted or finalized, when another window is watched, and by Release.
 *
 * VTK's classes have a vtkOpenGLResourceFreeCallback for that, whose header is not installed; a
 * texture object, here without a texture, is what hands it down. Private to this module.
 */
#ifndef vtkNURBSContextWatch_h
#define vtkNURBSContextWatch_h

#include "vtkTextureObject.h"

#include <functional>

class vtkNURBSContextWatch : public vtkTextureObject
{
public:
  static vtkNURBSContextWatch* New();
  vtkTypeMacro(vtkNURBSContextWatch, vtkTextureObject);

  std::function<void(vtkOpenGLRenderWindow*)> OnRelease;

  /// Watches this window, and makes its context current.
  void Watch(vtkOpenGLRenderWindow* window) { this->SetContext(window); }

  /// Has the function called if a window is watched, and watches none then.
  void Release() { this->SetContext(nullptr); }

  /// For the callback of VTK.
  void ReleaseGraphicsResources(vtkWindow* window) override;

protected:
  vtkNURBSContextWatch() = default;
  ~vtkNURBSContextWatch() override = default;

private:
  vtkNURBSContextWatch(const vtkNURBSContextWatch&) = delete;
  void operator=(const vtkNURBSContextWatch&) = delete;
};

#endif
