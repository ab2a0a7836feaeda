// SPDX-License-Identifier: BSD-3-Clause
#include "pqNURBSFiguresWidget.h"

#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqProxy.h"
#include "pqServerManagerModel.h"
#include "vtkCommand.h"
#include "vtkSMDocumentation.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyGroup.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"

#include <QFormLayout>
#include <QLabel>
#include <QLocale>

#include <cmath>

namespace
{

QString textOf(double value)
{
  const bool whole = value == std::floor(value) && std::abs(value) < 1e15;
  return whole ? QLocale(QLocale::English).toString(static_cast<qlonglong>(value))
               : QString::number(value, 'g', 4);
}

// Whether a value other than 0 is something to look at.
bool isTrouble(const QString& name)
{
  return name.contains("Failed") || name.contains("Capped") || name.contains("Refused") ||
    name.contains("InexactFaces");
}

pqProxy* itemOf(vtkSMProxy* proxy)
{
  return pqApplicationCore::instance()->getServerManagerModel()->findItem<pqProxy*>(proxy);
}

} // namespace

pqNURBSFiguresWidget::pqNURBSFiguresWidget(
  vtkSMProxy* proxy, vtkSMPropertyGroup* group, QWidget* parent)
  : pqPropertyGroupWidget(proxy, group, parent)
{
  auto* form = new QFormLayout(this);
  form->setContentsMargins(0, 0, 0, 0);
  form->setVerticalSpacing(1);
  for (unsigned int i = 0; i < group->GetNumberOfProperties(); ++i)
  {
    vtkSMProperty* property = group->GetProperty(i);
    auto* value = new QLabel(this);
    value->setObjectName(property->GetXMLName());
    value->setAlignment(Qt::AlignLeft);
    value->setTextInteractionFlags(Qt::TextSelectableByMouse);
    value->setToolTip(property->GetDocumentation()->GetDescription());
    form->addRow(property->GetXMLLabel(), value);
    this->Values.append(value);
  }
  pqCoreUtilities::connect(proxy, vtkCommand::UpdateDataEvent, this, SLOT(refresh()));
  // The panel is made before the filter is marked as one that waits for its first Apply.
  if (pqProxy* item = itemOf(proxy))
  {
    QObject::connect(
      item, SIGNAL(modifiedStateChanged(pqServerManagerModelItem*)), this, SLOT(refresh()));
  }
  this->refresh();
}

void pqNURBSFiguresWidget::refresh()
{
  pqProxy* item = itemOf(this->proxy());
  if (item && item->modifiedState() == pqProxy::UNINITIALIZED)
  {
    // Zeros would be taken for what was found.
    for (QLabel* value : this->Values)
    {
      value->setText("-");
    }
    return;
  }
  this->proxy()->UpdatePropertyInformation();
  for (unsigned int i = 0; i < this->propertyGroup()->GetNumberOfProperties(); ++i)
  {
    vtkSMProperty* property = this->propertyGroup()->GetProperty(i);
    const double value = vtkSMPropertyHelper(property).GetAsDouble();
    this->Values[i]->setText(textOf(value));
    const bool stands = value != 0.0 && isTrouble(property->GetXMLName());
    this->Values[i]->setStyleSheet(stands ? "color: #c00000; font-weight: bold" : "");
  }
}
