// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSBufferTexture.h"

#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkTextureUnitManager.h"
#include "vtk_glew.h"

namespace
{

GLenum InternalFormat(vtkNURBSBufferTexture::Format format)
{
  switch (format)
  {
    case vtkNURBSBufferTexture::FLOAT:
      return GL_R32F;
    case vtkNURBSBufferTexture::FLOAT4:
      return GL_RGBA32F;
    case vtkNURBSBufferTexture::INTEGER4:
      return GL_RGBA32I;
    default:
      return GL_RGBA8;
  }
}

std::size_t TexelSize(vtkNURBSBufferTexture::Format format)
{
  return format == vtkNURBSBufferTexture::FLOAT || format == vtkNURBSBufferTexture::COLOR ? 4 : 16;
}

} // namespace

bool vtkNURBSBufferTexture::Upload(const void* data, std::size_t bytes)
{
  GLint texels = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &texels);
  if (bytes / TexelSize(this->TexelFormat) > std::size_t(texels))
  {
    return false;
  }
  if (!this->Buffer)
  {
    glGenBuffers(1, &this->Buffer);
    glGenTextures(1, &this->Texture);
    this->Capacity = 0;
  }
  glBindBuffer(GL_TEXTURE_BUFFER, this->Buffer);
  if (bytes > this->Capacity || bytes < this->Capacity / 4 || !this->Capacity)
  {
    // An empty buffer is no store; a texel of zeros is.
    this->Capacity = bytes ? bytes : TexelSize(this->TexelFormat);
    glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(this->Capacity), bytes ? data : nullptr,
      GL_DYNAMIC_DRAW);
    // Any unit will do; the one in use may hold the texture of somebody else.
    GLint bound = 0;
    glGetIntegerv(GL_TEXTURE_BINDING_BUFFER, &bound);
    glBindTexture(GL_TEXTURE_BUFFER, this->Texture);
    glTexBuffer(GL_TEXTURE_BUFFER, InternalFormat(this->TexelFormat), this->Buffer);
    glBindTexture(GL_TEXTURE_BUFFER, static_cast<GLuint>(bound));
  }
  else if (bytes)
  {
    glBufferSubData(GL_TEXTURE_BUFFER, 0, static_cast<GLsizeiptr>(bytes), data);
  }
  glBindBuffer(GL_TEXTURE_BUFFER, 0);
  this->BytesSent += bytes;
  return true;
}

void vtkNURBSBufferTexture::Replace(std::size_t offset, const void* data, std::size_t bytes)
{
  glBindBuffer(GL_TEXTURE_BUFFER, this->Buffer);
  glBufferSubData(GL_TEXTURE_BUFFER, static_cast<GLintptr>(offset),
    static_cast<GLsizeiptr>(bytes), data);
  glBindBuffer(GL_TEXTURE_BUFFER, 0);
  this->BytesSent += bytes;
}

int vtkNURBSBufferTexture::Activate(vtkOpenGLRenderWindow* window)
{
  if (this->Unit < 0)
  {
    this->Unit = window->GetTextureUnitManager()->Allocate();
  }
  if (this->Unit >= 0)
  {
    window->GetState()->vtkglActiveTexture(GL_TEXTURE0 + this->Unit);
    glBindTexture(GL_TEXTURE_BUFFER, this->Texture);
  }
  return this->Unit;
}

void vtkNURBSBufferTexture::Deactivate(vtkOpenGLRenderWindow* window)
{
  if (this->Unit >= 0)
  {
    window->GetState()->vtkglActiveTexture(GL_TEXTURE0 + this->Unit);
    glBindTexture(GL_TEXTURE_BUFFER, 0);
    window->GetTextureUnitManager()->Free(this->Unit);
    this->Unit = -1;
  }
}

void vtkNURBSBufferTexture::Release(bool hasContext)
{
  if (this->Buffer && hasContext)
  {
    glDeleteTextures(1, &this->Texture);
    glDeleteBuffers(1, &this->Buffer);
  }
  this->Texture = this->Buffer = 0;
  this->Capacity = 0;
}
