// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNURBSControlPointWidget
 * @brief Control points of NURBS models dragged in the picture.
 *
 * Drives a vtkNURBSControlPointEdits: whatever is connected to its output, a vtkNURBSMapper or a
 * tessellator, follows. vtkNURBSControlPointRepresentation draws, picks and has the options.
 *
 * @code
 * widget->SetInteractor(interactor);
 * widget->SetCurrentRenderer(renderer); // if the window has several
 * widget->SetEdits(edits);
 * widget->On();
 * @endcode
 *
 * | event | what it does |
 * |---|---|
 * | mouse moves | the handle under the cursor is highlighted |
 * | left button on a handle | selects it, and drags the selection |
 * | with Shift, Ctrl | adds to the selection; adds or removes |
 * | Ctrl and left button elsewhere | selects what is inside a rectangle, too |
 * | X, Y, Z, N while dragging | only along that axis or the surface's normal; V frees it |
 * | Escape | takes a drag back; without one, clears the selection |
 * | wheel over a selected handle; +, - | weights of the selection times or by WeightFactor |
 * | Ctrl+Z, Ctrl+Y | undo, redo |
 *
 * All else goes to the interactor's style. Events outside the widget's renderer are left alone. The
 * event translator maps them to the widget events of EventIds and to Select, EndSelect, Move, Up
 * and Down (wheel) and HoverLeave of vtkWidgetEvent.
 *
 * Invokes StartInteractionEvent, InteractionEvent and EndInteractionEvent around a drag and each
 * change by wheel or keys, undo and redo included; SelectionChangedEvent.
 *
 * @sa vtkNURBSControlPointEdits
 */
#ifndef vtkNURBSControlPointWidget_h
#define vtkNURBSControlPointWidget_h

#include "vtkAbstractWidget.h"
#include "vtkNURBSRenderingWidgetsModule.h" // For export macro

class vtkNURBSControlPointEdits;
class vtkNURBSControlPointRepresentation;

class VTKNURBSRENDERINGWIDGETS_EXPORT vtkNURBSControlPointWidget : public vtkAbstractWidget
{
public:
  static vtkNURBSControlPointWidget* New();
  vtkTypeMacro(vtkNURBSControlPointWidget, vtkAbstractWidget);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Events of this widget, besides those of vtkWidgetEvent.
  enum EventIds
  {
    CancelEvent = 1000,
    UndoEvent,
    RedoEvent,
    FreeEvent, ///< Of the constraint; the four that follow are constraints.
    XAxisEvent,
    YAxisEvent,
    ZAxisEvent,
    NormalEvent,
    WeightUpEvent,
    WeightDownEvent
  };

  ///@{
  /**
   * The edits that are shown and changed. Kept by the representation.
   */
  void SetEdits(vtkNURBSControlPointEdits* edits);
  vtkNURBSControlPointEdits* GetEdits();
  ///@}

  ///@{
  /**
   * How the widget looks and picks.
   */
  void SetRepresentation(vtkNURBSControlPointRepresentation* representation);
  vtkNURBSControlPointRepresentation* GetControlPointRepresentation();
  void CreateDefaultRepresentation() override;
  ///@}

  ///@{
  /**
   * What a step of the wheel multiplies weights by, 1.0001 to 100. Default 1.1.
   */
  vtkSetClampMacro(WeightFactor, double, 1.0001, 100.0);
  vtkGetMacro(WeightFactor, double);
  ///@}

  /**
   * Disabling the widget ends a drag where it is.
   */
  void SetEnabled(int enabling) override;

protected:
  vtkNURBSControlPointWidget();
  ~vtkNURBSControlPointWidget() override;

  void SetCursor(int state) override;

  double WeightFactor = 1.1;

private:
  vtkNURBSControlPointWidget(const vtkNURBSControlPointWidget&) = delete;
  void operator=(const vtkNURBSControlPointWidget&) = delete;

  static void SelectAction(vtkAbstractWidget* widget);
  static void EndSelectAction(vtkAbstractWidget* widget);
  static void MoveAction(vtkAbstractWidget* widget);
  static void LeaveAction(vtkAbstractWidget* widget);
  static void WheelAction(vtkAbstractWidget* widget, bool up);
  static void WeightAction(vtkAbstractWidget* widget, bool up);
  static void HistoryAction(vtkAbstractWidget* widget, bool back);
  static void CancelAction(vtkAbstractWidget* widget);
  static void ConstrainAction(vtkAbstractWidget* widget, int constraint);

  bool IsEventInside();
  void Grab();
  void Finish(bool keep);
  void Changed();

  enum StateType
  {
    Idle,
    Dragging,
    BoxSelecting
  };
  int State = Idle;
  bool WasSelected = false; ///< The picked handle, before the click.
  bool HasMoved = false;    ///< Since the button was pressed.
  int FreeConstraint = 0;   ///< The representation's, before keys changed it.
};

#endif
