// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkNURBSWaveletTextures
 * @brief   wavelet transforms of grids in float textures, on the GPU
 *
 * Takes the grids that lie in one RGBA32F texture one level down (analysis) or up (synthesis), in
 * place: after an analysis a grid's rectangle has the samples of the coarse grid in its first rows
 * and columns, and the details in the rest, as nurbs::AnalyseGrid leaves them. The next step takes
 * the coarse grid's part of the rectangle, the synthesis goes back. What surfaces were evaluated to
 * is so changed from level to level without evaluating again (Tan, Zhao, Lu 2012, section 4.3).
 *
 * A step is two passes, along rows and along columns, through a texture of the same size. Each
 * draws one rectangle a grid by instancing: the number of OpenGL calls does not depend on that of
 * the grids. All four values of a texel are transformed.
 *
 * The context of the window must be current in every call but the constructor.
 */
#ifndef vtkNURBSWaveletTextures_h
#define vtkNURBSWaveletTextures_h

#include "WaveletTransform.h"
#include "vtkNURBSRenderingOpenGL2Module.h" // For export macro

#include <memory> // For std::unique_ptr

class vtkOpenGLRenderWindow;
class vtkTextureObject;

class VTKNURBSRENDERINGOPENGL2_EXPORT vtkNURBSWaveletTextures
{
public:
  /// A grid: the texel of its first sample, and the step from (or to) the fine grid. The wavelet of
  /// the step is that of the call.
  struct Rectangle
  {
    int X = 0, Y = 0;
    nurbs::GridStep Step;
  };

  vtkNURBSWaveletTextures();
  ~vtkNURBSWaveletTextures();
  vtkNURBSWaveletTextures(const vtkNURBSWaveletTextures&) = delete;
  vtkNURBSWaveletTextures& operator=(const vtkNURBSWaveletTextures&) = delete;

  ///@{
  /// One step of all rectangles, which must not overlap, and have at least one interval in both
  /// directions. False, and GetError tells why, if it can't be done: a rectangle leaves the
  /// texture, a direction to be halved has an odd number of intervals, or the device lacks
  /// something.
  bool Analyse(vtkOpenGLRenderWindow* window, vtkTextureObject* grids, nurbs::Wavelet kind,
    const std::vector<Rectangle>& rectangles);
  bool Synthesise(vtkOpenGLRenderWindow* window, vtkTextureObject* grids, nurbs::Wavelet kind,
    const std::vector<Rectangle>& rectangles);
  ///@}

  /// Deletes all; null if the window is gone, and its context with it.
  void Release(vtkOpenGLRenderWindow* window);

  /// Why the last step was not done; "" if it was.
  const std::string& GetError() const;

private:
  struct Internals;
  std::unique_ptr<Internals> Data;
};

#endif
