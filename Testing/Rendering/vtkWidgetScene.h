// SPDX-License-Identifier: BSD-3-Clause
/// \file What the tests of vtkNURBSControlPointWidget share: a window with a model, its handles,
/// and a mouse and keys for them.
#ifndef vtkWidgetScene_h
#define vtkWidgetScene_h

#include "../testMessageKeeper.h"
#include "Types.h"
#include "vtkNURBSControlPointEdits.h"
#include "vtkNURBSControlPointRepresentation.h"
#include "vtkNURBSControlPointWidget.h"
#include "vtkNURBSEGLRenderWindow.h"
#include "vtkNURBSMapper.h"
#include "vtkNURBSShapeSource.h"
#include "vtkTestImage.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkGenericRenderWindowInteractor.h"
#include "vtkNew.h"
#include "vtkRenderer.h"
#include "vtkUnstructuredGrid.h"

#include <map>

struct vtkWidgetScene
{
  static constexpr int Width = 300, Height = 200;

  std::map<unsigned long, int> Events; ///< How often the widget invoked which.
  vtkNew<vtkNURBSControlPointEdits> Edits;
  vtkNew<vtkNURBSMapper> Mapper;
  vtkNew<vtkActor> Actor; ///< Draws the edited model; in the renderer.
  vtkNew<vtkRenderer> Renderer;
  vtkSmartPointer<vtkNURBSEGLRenderWindow> Window;
  vtkNew<vtkGenericRenderWindowInteractor> Interactor; ///< With a trackball style.
  vtkNew<vtkNURBSControlPointWidget> Widget;           ///< Enabled.
  vtkNew<MessageKeeper> Errors;                        ///< Of Edits.

  /// Seen in parallel or perspective projection from an oblique direction.
  explicit vtkWidgetScene(vtkDataObject* model, bool parallel = true);
  vtkWidgetScene(const vtkWidgetScene&) = delete;
  void operator=(const vtkWidgetScene&) = delete;

  vtkNURBSControlPointRepresentation* Handles();

  /// Sends an event with the cursor at a place and modifier keys.
  void Send(unsigned long event, const nurbs::Vec2& at, bool shift = false, bool control = false);
  void Press(const nurbs::Vec2& at, bool shift = false, bool control = false);
  void Move(const nurbs::Vec2& at);
  void Release(const nurbs::Vec2& at);
  void Click(const nurbs::Vec2& at, bool shift = false, bool control = false);
  void Key(const char* symbol, bool shift = false, bool control = false);

  /// Where a point is in the window, by vtkRenderer, rounded to whole pixels as a mouse is.
  nurbs::Vec2 PixelOf(const nurbs::Vec3& point);
  nurbs::Vec3 DisplayOf(const nurbs::Vec3& point);
  /// Control points of the first block of the input and of the output.
  nurbs::Vec3 Before(vtkIdType point);
  nurbs::Vec3 Now(vtkIdType point);
  double Weight(vtkIdType point);

  /// Unit vectors of the camera.
  nurbs::Vec3 Right(), Up(), Ahead();
  /// World length of a pixel at a point, from the camera's parameters.
  double PixelSize(const nurbs::Vec3& point);

  vtkTestImage::Colour PixelColour(const nurbs::Vec2& at);
};

vtkSmartPointer<vtkUnstructuredGrid> vtkWidgetShape(int type, int sheet = 6, double height = 5.0);

#endif
