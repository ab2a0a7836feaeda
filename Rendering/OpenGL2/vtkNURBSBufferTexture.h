// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkNURBSBufferTexture
 * @brief   a buffer of the GPU that shaders read by texelFetch
 *
 * What vtkTextureObject::CreateTextureBuffer and vtkOpenGLBufferObject do together, with the two
 * things that they lack: texels of integers that stay integers, and replacing a part. Private to
 * this module. The context of the window must be current in every call but the constructor.
 */
#ifndef vtkNURBSBufferTexture_h
#define vtkNURBSBufferTexture_h

#include <cstddef>

class vtkOpenGLRenderWindow;

class vtkNURBSBufferTexture
{
public:
  enum Format
  {
    FLOAT,      ///< samplerBuffer, one float a texel
    FLOAT4,     ///< samplerBuffer, four floats
    INTEGER4,   ///< isamplerBuffer, four integers
    COLOR       ///< samplerBuffer, four bytes as 0 to 1
  };

  explicit vtkNURBSBufferTexture(Format format)
    : TexelFormat(format)
  {}
  vtkNURBSBufferTexture(const vtkNURBSBufferTexture&) = delete;
  vtkNURBSBufferTexture& operator=(const vtkNURBSBufferTexture&) = delete;

  /// Replaces the content. False if the device can't hold so many texels.
  bool Upload(const void* data, std::size_t bytes);
  /// Replaces a part of the content.
  void Replace(std::size_t offset, const void* data, std::size_t bytes);

  /// Binds it to a free texture unit, which is returned; -1 if there is none.
  int Activate(vtkOpenGLRenderWindow* window);
  void Deactivate(vtkOpenGLRenderWindow* window);

  /// Deletes it; without a context (its window is gone) it is only forgotten.
  void Release(bool hasContext);

  /// Bytes that were sent to the device by all uploads.
  std::size_t GetBytesSent() const { return this->BytesSent; }

private:
  Format TexelFormat;
  unsigned int Buffer = 0;
  unsigned int Texture = 0;
  int Unit = -1;
  std::size_t Capacity = 0;
  std::size_t BytesSent = 0;
};

#endif
