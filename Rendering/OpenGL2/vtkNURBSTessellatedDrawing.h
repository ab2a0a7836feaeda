// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkNURBSTessellatedDrawing
 * @brief   draws a model by vtkNURBSTessellator, where the device can't evaluate it
 *
 * Triangles are within the mapper's PixelError, and made again when the view has become twice as large
 * or the model has changed. Private to vtkNURBSMapper.
 */
#ifndef vtkNURBSTessellatedDrawing_h
#define vtkNURBSTessellatedDrawing_h

#include "vtkNew.h"
#include "vtkSmartPointer.h"

class vtkActor;
class vtkDataObject;
class vtkMapper;
class vtkNURBSMapper;
class vtkNURBSTessellator;
class vtkPolyDataMapper;
class vtkRenderer;
class vtkWindow;

class vtkNURBSTessellatedDrawing
{
public:
  vtkNURBSTessellatedDrawing();
  ~vtkNURBSTessellatedDrawing();
  vtkNURBSTessellatedDrawing(const vtkNURBSTessellatedDrawing&) = delete;
  vtkNURBSTessellatedDrawing& operator=(const vtkNURBSTessellatedDrawing&) = delete;

  /// Draws the input as `mapper` is told to: colours, clipping planes, blocks.
  void Render(
    vtkNURBSMapper* mapper, vtkDataObject* input, vtkRenderer* renderer, vtkActor* actor);
  void ReleaseGraphicsResources(vtkWindow* window);
  /// Of the last Render.
  vtkIdType GetNumberOfTriangles() const { return this->NumberOfTriangles; }

private:
  vtkNew<vtkNURBSTessellator> Tessellator;
  vtkSmartPointer<vtkPolyDataMapper> Triangles;
  double Scale = 0.0; ///< Pixels of a unit of length when the triangles were made.
  vtkIdType NumberOfTriangles = 0;
};

#endif
