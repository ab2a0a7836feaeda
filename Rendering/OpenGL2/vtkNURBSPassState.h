// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkNURBSPassState
 * @brief   the state of OpenGL in which shaders compute into textures, while it lives
 *
 * No depth, blending, scissors or culling, all components written; and what was before, viewport
 * included, when it ends. Private to this module.
 */
#ifndef vtkNURBSPassState_h
#define vtkNURBSPassState_h

#include "vtkOpenGLState.h"
#include "vtk_glew.h"

class vtkNURBSPassState
{
public:
  explicit vtkNURBSPassState(vtkOpenGLState* state)
    : Viewport(state)
    , Mask(state)
    , Depth(state, GL_DEPTH_TEST)
    , Blend(state, GL_BLEND)
    , Scissor(state, GL_SCISSOR_TEST)
    , Cull(state, GL_CULL_FACE)
  {
    for (const GLenum name : { GL_DEPTH_TEST, GL_BLEND, GL_SCISSOR_TEST, GL_CULL_FACE })
    {
      state->vtkglDisable(name);
    }
    state->vtkglColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  }

private:
  vtkOpenGLState::ScopedglViewport Viewport;
  vtkOpenGLState::ScopedglColorMask Mask;
  vtkOpenGLState::ScopedglEnableDisable Depth, Blend, Scissor, Cull;
};

#endif
