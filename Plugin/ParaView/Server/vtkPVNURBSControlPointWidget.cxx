// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVNURBSControlPointWidget.h"

#include "vtkCommand.h"
#include "vtkEvent.h"
#include "vtkObjectFactory.h"
#include "vtkWidgetEventTranslator.h"

vtkStandardNewMacro(vtkPVNURBSControlPointWidget);

vtkPVNURBSControlPointWidget::vtkPVNURBSControlPointWidget()
{
  const auto drop = [this](int modifier, const char* key) {
    this->EventTranslator->RemoveTranslation(vtkCommand::KeyPressEvent, modifier, 0, 0, key);
  };
  drop(vtkEvent::ControlModifier, "z");
  drop(vtkEvent::ControlModifier, "y");
  drop(vtkEvent::ControlModifier | vtkEvent::ShiftModifier, "Z");
}

void vtkPVNURBSControlPointWidget::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
