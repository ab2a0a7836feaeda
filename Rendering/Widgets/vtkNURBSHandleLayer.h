// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkNURBSHandleLayer.h
 * @brief Points or lines of one colour, where the model hides them and where it does not.
 *
 * Private to this module. To be drawn over the finished picture. Both passes are drawn as
 * translucent geometry, which writes no depths: the depth buffer remains the model's and tells what
 * is behind it, and a later layer covers an earlier one. The pass for what is hidden presses the
 * depths into the nearest hundredth of their range, in the fragment shader.
 */
#ifndef vtkNURBSHandleLayer_h
#define vtkNURBSHandleLayer_h

#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

class vtkActor;
class vtkCellArray;
class vtkPoints;
class vtkPolyDataMapper;
class vtkViewport;
class vtkWindow;

class vtkNURBSHandleLayer
{
public:
  enum KindType
  {
    DISCS,
    LINES
  };
  explicit vtkNURBSHandleLayer(KindType kind);
  ~vtkNURBSHandleLayer();
  vtkNURBSHandleLayer(const vtkNURBSHandleLayer&) = delete;
  void operator=(const vtkNURBSHandleLayer&) = delete;

  /// What is drawn: vertices or lines on points. Null cells: nothing.
  void SetCells(vtkPoints* points, vtkCellArray* cells);
  /// sRGB, diameter or width in pixels, opacity where the model does not hide it, and where it
  /// does. Opacity 0 leaves the pass out.
  void SetStyle(const double color[3], double size, double opacity, double hiddenOpacity);

  bool IsEmpty() const;
  /// All of it with the opacity for what is hidden; then what is visible. Each returns whether it
  /// drew.
  int RenderHidden(vtkViewport* viewport);
  int RenderVisible(vtkViewport* viewport);
  void ReleaseGraphicsResources(vtkWindow* window);

private:
  struct Pass
  {
    vtkSmartPointer<vtkPolyDataMapper> Mapper;
    vtkSmartPointer<vtkActor> Actor;
  };
  void MakePass(Pass& pass, bool hidden);
  int Render(Pass& pass, double opacity, vtkViewport* viewport);

  KindType Kind;
  vtkNew<vtkPolyData> Data;
  Pass Visible, Hidden;
  double Opacity = 1.0, HiddenOpacity = 0.0;
};

#endif
