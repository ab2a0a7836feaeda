// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSControlPointWidget.h"

#include "vtkNURBSControlPointEdits.h"
#include "vtkNURBSControlPointRepresentation.h"

#include "vtkCallbackCommand.h"
#include "vtkEvent.h"
#include "vtkObjectFactory.h"
#include "vtkRenderWindow.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkRenderer.h"
#include "vtkWidgetCallbackMapper.h"
#include "vtkWidgetEvent.h"
#include "vtkWidgetEventTranslator.h"

vtkStandardNewMacro(vtkNURBSControlPointWidget);

using Representation = vtkNURBSControlPointRepresentation;

vtkNURBSControlPointWidget::vtkNURBSControlPointWidget()
{
  using Action = vtkWidgetCallbackMapper::CallbackType;
  using Self = vtkNURBSControlPointWidget;
  const auto bind = [this](unsigned long event, unsigned long what, Action action) {
    this->CallbackMapper->SetCallbackMethod(event, what, this, action);
  };
  const auto bindKey = [this](const char* key, int modifier, unsigned long what, Action action) {
    this->CallbackMapper->SetCallbackMethod(
      vtkCommand::KeyPressEvent, modifier, 0, 0, key, what, this, action);
  };
  bind(vtkCommand::LeftButtonPressEvent, vtkWidgetEvent::Select, Self::SelectAction);
  bind(vtkCommand::LeftButtonReleaseEvent, vtkWidgetEvent::EndSelect, Self::EndSelectAction);
  bind(vtkCommand::MouseMoveEvent, vtkWidgetEvent::Move, Self::MoveAction);
  bind(vtkCommand::LeaveEvent, vtkWidgetEvent::HoverLeave, Self::LeaveAction);

  bind(vtkCommand::MouseWheelForwardEvent, vtkWidgetEvent::Up,
    [](vtkAbstractWidget* w) { Self::WheelAction(w, true); });
  bind(vtkCommand::MouseWheelBackwardEvent, vtkWidgetEvent::Down,
    [](vtkAbstractWidget* w) { Self::WheelAction(w, false); });
  for (const char* key : { "plus", "KP_Add" })
  {
    bindKey(key, vtkEvent::AnyModifier, WeightUpEvent,
      [](vtkAbstractWidget* w) { Self::WeightAction(w, true); });
  }
  for (const char* key : { "minus", "KP_Subtract" })
  {
    bindKey(key, vtkEvent::AnyModifier, WeightDownEvent,
      [](vtkAbstractWidget* w) { Self::WeightAction(w, false); });
  }

  bindKey("Escape", vtkEvent::AnyModifier, CancelEvent, Self::CancelAction);
  const Action undo = [](vtkAbstractWidget* w) { Self::HistoryAction(w, true); };
  const Action redo = [](vtkAbstractWidget* w) { Self::HistoryAction(w, false); };
  bindKey("z", vtkEvent::ControlModifier, UndoEvent, undo);
  bindKey("y", vtkEvent::ControlModifier, RedoEvent, redo);
  bindKey("Z", vtkEvent::ControlModifier | vtkEvent::ShiftModifier, RedoEvent, redo);

  const auto bindConstraint = [&](const char* key, unsigned long what, Action action) {
    const char shifted[2] = { char(key[0] - 'a' + 'A'), 0 };
    bindKey(key, vtkEvent::NoModifier, what, action);
    bindKey(shifted, vtkEvent::ShiftModifier, what, action);
  };
  bindConstraint("v", FreeEvent,
    [](vtkAbstractWidget* w) { Self::ConstrainAction(w, Representation::VIEW_PLANE); });
  bindConstraint("x", XAxisEvent,
    [](vtkAbstractWidget* w) { Self::ConstrainAction(w, Representation::X_AXIS); });
  bindConstraint("y", YAxisEvent,
    [](vtkAbstractWidget* w) { Self::ConstrainAction(w, Representation::Y_AXIS); });
  bindConstraint("z", ZAxisEvent,
    [](vtkAbstractWidget* w) { Self::ConstrainAction(w, Representation::Z_AXIS); });
  bindConstraint("n", NormalEvent,
    [](vtkAbstractWidget* w) { Self::ConstrainAction(w, Representation::SURFACE_NORMAL); });
}

// In the middle of a drag, the interactor must not wait for this widget for ever.
vtkNURBSControlPointWidget::~vtkNURBSControlPointWidget()
{
  if (this->State != Idle)
  {
    this->GetControlPointRepresentation()->CancelInteraction();
    this->ReleaseFocus();
  }
}

void vtkNURBSControlPointWidget::CreateDefaultRepresentation()
{
  if (!this->WidgetRep)
  {
    this->WidgetRep = vtkNURBSControlPointRepresentation::New();
  }
}

void vtkNURBSControlPointWidget::SetRepresentation(
  vtkNURBSControlPointRepresentation* representation)
{
  this->SetWidgetRepresentation(representation);
}

vtkNURBSControlPointRepresentation* vtkNURBSControlPointWidget::GetControlPointRepresentation()
{
  return static_cast<vtkNURBSControlPointRepresentation*>(this->GetRepresentation());
}

void vtkNURBSControlPointWidget::SetEdits(vtkNURBSControlPointEdits* edits)
{
  if (this->State != Idle)
  {
    this->Finish(false);
  }
  this->GetControlPointRepresentation()->SetEdits(edits);
  this->Modified();
}

vtkNURBSControlPointEdits* vtkNURBSControlPointWidget::GetEdits()
{
  return this->GetControlPointRepresentation()->GetEdits();
}

void vtkNURBSControlPointWidget::SetEnabled(int enabling)
{
  if (!enabling && this->Enabled)
  {
    if (this->State != Idle)
    {
      this->Finish(true);
    }
    this->GetControlPointRepresentation()->Highlight(0);
    this->SetCursor(Representation::Outside);
  }
  this->Superclass::SetEnabled(enabling);
}

void vtkNURBSControlPointWidget::SetCursor(int state)
{
  if (this->ManagesCursor)
  {
    const bool onHandle = state == Representation::OnHandle || state == Representation::Dragging;
    this->RequestCursorShape(onHandle ? VTK_CURSOR_HAND : VTK_CURSOR_DEFAULT);
  }
}

bool vtkNURBSControlPointWidget::IsEventInside()
{
  const int* at = this->Interactor->GetEventPosition();
  return this->CurrentRenderer && this->CurrentRenderer->IsInViewport(at[0], at[1]);
}

void vtkNURBSControlPointWidget::Grab()
{
  if (!this->Parent)
  {
    this->GrabFocus(this->EventCallbackCommand);
  }
  this->EventCallbackCommand->SetAbortFlag(1);
}

// A change that is over at once.
void vtkNURBSControlPointWidget::Changed()
{
  this->EventCallbackCommand->SetAbortFlag(1);
  this->InvokeEvent(vtkCommand::StartInteractionEvent, nullptr);
  this->InvokeEvent(vtkCommand::InteractionEvent, nullptr);
  this->InvokeEvent(vtkCommand::EndInteractionEvent, nullptr);
  this->Render();
}

void vtkNURBSControlPointWidget::SelectAction(vtkAbstractWidget* widget)
{
  auto* self = static_cast<vtkNURBSControlPointWidget*>(widget);
  Representation* handles = self->GetControlPointRepresentation();
  if (self->State != Idle || !self->IsEventInside())
  {
    return;
  }
  const int* at = self->Interactor->GetEventPosition();
  double position[2] = { double(at[0]), double(at[1]) };
  const bool shift = self->Interactor->GetShiftKey(), control = self->Interactor->GetControlKey();
  if (handles->ComputeInteractionState(at[0], at[1]) == Representation::Outside)
  {
    if (control && handles->GetNumberOfHandles() > 0)
    {
      handles->StartBoxSelection(position);
      self->State = BoxSelecting;
      self->Grab();
    }
    return;
  }

  const unsigned int block = handles->GetHoveredBlock();
  const vtkIdType point = handles->GetHoveredControlPoint();
  self->WasSelected = handles->IsSelected(block, point);
  if (control && self->WasSelected)
  {
    handles->DeselectControlPoint(block, point);
    self->EventCallbackCommand->SetAbortFlag(1);
    self->InvokeEvent(vtkCommand::SelectionChangedEvent, nullptr);
    self->Render();
    return;
  }
  if (!self->WasSelected)
  {
    if (!shift && !control)
    {
      handles->ClearSelection();
    }
    handles->SelectControlPoint(block, point);
    self->InvokeEvent(vtkCommand::SelectionChangedEvent, nullptr);
  }
  handles->StartWidgetInteraction(position);
  self->State = Dragging;
  self->HasMoved = shift || control; // Then the end of a mere click leaves the selection.
  self->FreeConstraint = handles->GetConstraint();
  self->SetCursor(Representation::Dragging);
  self->Grab();
  self->StartInteraction();
  self->InvokeEvent(vtkCommand::StartInteractionEvent, nullptr);
  self->Render();
}

void vtkNURBSControlPointWidget::MoveAction(vtkAbstractWidget* widget)
{
  auto* self = static_cast<vtkNURBSControlPointWidget*>(widget);
  Representation* handles = self->GetControlPointRepresentation();
  const int* at = self->Interactor->GetEventPosition();
  if (self->State != Idle)
  {
    double position[2] = { double(at[0]), double(at[1]) };
    handles->WidgetInteraction(position);
    const double* moved = handles->GetDisplacement();
    self->HasMoved = self->HasMoved || moved[0] != 0.0 || moved[1] != 0.0 || moved[2] != 0.0;
    self->EventCallbackCommand->SetAbortFlag(1);
    if (self->State == Dragging)
    {
      self->CurrentRenderer->ResetCameraClippingRange();
      self->InvokeEvent(vtkCommand::InteractionEvent, nullptr);
    }
    self->Render();
    return;
  }
  const vtkIdType point = handles->GetHoveredControlPoint();
  const unsigned int block = handles->GetHoveredBlock();
  if (self->IsEventInside())
  {
    handles->ComputeInteractionState(at[0], at[1]);
  }
  else
  {
    handles->Highlight(0);
  }
  if (handles->GetHoveredControlPoint() != point || handles->GetHoveredBlock() != block)
  {
    self->SetCursor(
      handles->GetHoveredControlPoint() < 0 ? Representation::Outside : Representation::OnHandle);
    self->Render();
  }
}

void vtkNURBSControlPointWidget::LeaveAction(vtkAbstractWidget* widget)
{
  auto* self = static_cast<vtkNURBSControlPointWidget*>(widget);
  Representation* handles = self->GetControlPointRepresentation();
  if (self->State == Idle && handles->GetHoveredControlPoint() >= 0)
  {
    handles->Highlight(0);
    self->SetCursor(Representation::Outside);
    self->Render();
  }
}

void vtkNURBSControlPointWidget::EndSelectAction(vtkAbstractWidget* widget)
{
  auto* self = static_cast<vtkNURBSControlPointWidget*>(widget);
  if (self->State != Idle)
  {
    self->Finish(true);
  }
}

// Ends a drag or box; `keep`: what it did.
void vtkNURBSControlPointWidget::Finish(bool keep)
{
  Representation* handles = this->GetControlPointRepresentation();
  const int* at = this->Interactor->GetEventPosition();
  double position[2] = { double(at[0]), double(at[1]) };
  const bool wasDragging = this->State == Dragging;
  const bool isClick = wasDragging && keep && !this->HasMoved && this->WasSelected;
  const vtkIdType selected = handles->GetNumberOfSelectedControlPoints();
  if (isClick)
  {
    const unsigned int block = handles->GetHoveredBlock();
    const vtkIdType point = handles->GetHoveredControlPoint();
    handles->ClearSelection();
    handles->SelectControlPoint(block, point);
  }
  if (keep)
  {
    handles->EndWidgetInteraction(position);
  }
  else
  {
    handles->CancelInteraction();
  }
  this->State = Idle;
  if (!this->Parent)
  {
    this->ReleaseFocus();
  }
  this->EventCallbackCommand->SetAbortFlag(1);
  if (handles->GetNumberOfSelectedControlPoints() != selected)
  {
    this->InvokeEvent(vtkCommand::SelectionChangedEvent, nullptr);
  }
  if (wasDragging)
  {
    handles->SetConstraint(this->FreeConstraint);
    this->EndInteraction();
    this->InvokeEvent(vtkCommand::EndInteractionEvent, nullptr);
  }
  this->Render();
}

void vtkNURBSControlPointWidget::CancelAction(vtkAbstractWidget* widget)
{
  auto* self = static_cast<vtkNURBSControlPointWidget*>(widget);
  Representation* handles = self->GetControlPointRepresentation();
  if (self->State != Idle)
  {
    self->Finish(false);
  }
  else if (handles->GetNumberOfSelectedControlPoints() > 0 && self->IsEventInside())
  {
    handles->ClearSelection();
    self->EventCallbackCommand->SetAbortFlag(1);
    self->InvokeEvent(vtkCommand::SelectionChangedEvent, nullptr);
    self->Render();
  }
}

// Only over a selected handle; elsewhere the wheel is the style's.
void vtkNURBSControlPointWidget::WheelAction(vtkAbstractWidget* widget, bool up)
{
  auto* self = static_cast<vtkNURBSControlPointWidget*>(widget);
  Representation* handles = self->GetControlPointRepresentation();
  if (self->State != Idle)
  {
    self->EventCallbackCommand->SetAbortFlag(1); // No zoom in the middle of a drag.
    return;
  }
  const int* at = self->Interactor->GetEventPosition();
  if (self->IsEventInside() &&
    handles->ComputeInteractionState(at[0], at[1]) == Representation::OnHandle &&
    handles->IsSelected(handles->GetHoveredBlock(), handles->GetHoveredControlPoint()))
  {
    vtkNURBSControlPointWidget::WeightAction(widget, up);
  }
}

void vtkNURBSControlPointWidget::WeightAction(vtkAbstractWidget* widget, bool up)
{
  auto* self = static_cast<vtkNURBSControlPointWidget*>(widget);
  Representation* handles = self->GetControlPointRepresentation();
  if (self->State == Idle && self->IsEventInside() &&
    handles->GetNumberOfSelectedControlPoints() > 0)
  {
    handles->ScaleSelectedWeights(up ? self->WeightFactor : 1.0 / self->WeightFactor);
    self->Changed();
  }
}

void vtkNURBSControlPointWidget::HistoryAction(vtkAbstractWidget* widget, bool back)
{
  auto* self = static_cast<vtkNURBSControlPointWidget*>(widget);
  vtkNURBSControlPointEdits* edits = self->GetEdits();
  if (self->State != Idle)
  {
    self->Finish(false);
    return;
  }
  if (edits && self->IsEventInside() && (back ? edits->Undo() : edits->Redo()))
  {
    self->Changed();
  }
}

void vtkNURBSControlPointWidget::ConstrainAction(vtkAbstractWidget* widget, int constraint)
{
  auto* self = static_cast<vtkNURBSControlPointWidget*>(widget);
  if (self->State != Dragging)
  {
    return;
  }
  self->GetControlPointRepresentation()->SetConstraint(constraint);
  self->CurrentRenderer->ResetCameraClippingRange();
  self->EventCallbackCommand->SetAbortFlag(1);
  self->InvokeEvent(vtkCommand::InteractionEvent, nullptr);
  self->Render();
}

void vtkNURBSControlPointWidget::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "WeightFactor: " << this->WeightFactor << "\n";
}
