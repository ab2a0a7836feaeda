// SPDX-License-Identifier: BSD-3-Clause
#include "pqNURBSControlPointsWidget.h"

#include "pqCoreUtilities.h"
#include "pqPropertiesPanel.h"
#include "vtkAlgorithm.h"
#include "vtkCommand.h"
#include "vtkDataObject.h"
#include "vtkPVDataInformation.h"
#include "vtkPVNURBSLatticeRepresentation.h"
#include "vtkPVSession.h"
#include "vtkPointSet.h"
#include "vtkSMDocumentation.h"
#include "vtkSMNewWidgetRepresentationProxy.h"
#include "vtkSMOutputPort.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyGroup.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSession.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSmartPointer.h"
#include "vtkStructuredGrid.h"
#include "vtkWeakPointer.h"

#include <QCheckBox>
#include <QLabel>
#include <QTimer>
#include <QVBoxLayout>

namespace
{

// The properties that handles edit or depend on, by the names that widgets.xml has for them too.
vtkSmartPointer<vtkSMPropertyGroup> linkedProperties(vtkSMProxy* proxy)
{
  auto group = vtkSmartPointer<vtkSMPropertyGroup>::New();
  for (const char* name :
    { "Moves", "Positions", "Weights", "MoveCoincident", "CoincidenceTolerance", "LatticeMoves" })
  {
    if (vtkSMProperty* property = proxy->GetProperty(name))
    {
      group->AddProperty(name, property);
    }
  }
  return group;
}

// The data of an output that was updated before, null if it was not; copied from the server if that
// is another process.
vtkSmartPointer<vtkDataObject> dataOf(vtkSMSourceProxy* source, unsigned int port)
{
  vtkDataObject* data = nullptr;
  vtkSmartPointer<vtkSMProxy> made;
  vtkPVDataInformation* about = source->GetDataInformation(port);
  if (about->GetNumberOfPoints() == 0)
  {
    return nullptr;
  }
  if (auto* here = vtkAlgorithm::SafeDownCast(source->GetClientSideObject()))
  {
    data = here->GetOutputDataObject(static_cast<int>(port));
  }
  else
  {
    made.TakeReference(
      source->GetSessionProxyManager()->NewProxy("filters", "ClientServerMoveData"));
    auto* mover = vtkSMSourceProxy::SafeDownCast(made);
    const int composite = about->GetCompositeDataSetType();
    vtkSMPropertyHelper(mover, "Input").Set(source, port);
    vtkSMPropertyHelper(mover, "OutputDataType")
      .Set(composite >= 0 ? composite : about->GetDataSetType());
    vtkSMPropertyHelper(mover, "WholeExtent").Set(about->GetExtent(), 6);
    mover->UpdateVTKObjects();
    mover->UpdatePipeline();
    data = vtkAlgorithm::SafeDownCast(mover->GetClientSideObject())->GetOutputDataObject(0);
  }
  // A copy, as what follows may change the object in place.
  vtkSmartPointer<vtkDataObject> copy;
  if (data)
  {
    copy.TakeReference(data->NewInstance());
    copy->ShallowCopy(data);
  }
  return copy;
}

} // namespace

pqNURBSControlPointsWidget::pqNURBSControlPointsWidget(
  vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent)
  : pqInteractivePropertyWidget("representations",
      proxy->GetProperty("LatticeMoves") ? "NURBSLatticeWidgetRepresentation"
                                         : "NURBSControlPointWidgetRepresentation",
      proxy, linkedProperties(proxy), parent)
{
  this->setShowLabel(false);
  this->setToolTip(property->GetDocumentation()->GetDescription());
  this->Show = new QCheckBox(property->GetXMLLabel(), this);
  this->Show->setObjectName("ShowHandles");
  this->Show->setChecked(true);
  this->Apply = new QCheckBox("Apply After Each Drag", this);
  this->Apply->setObjectName("ApplyDrags");
  this->Apply->setToolTip("The surfaces follow when the mouse button is let go.");
  this->Apply->setChecked(true);
  this->State = new QLabel(this);
  this->State->setObjectName("State");
  this->State->setWordWrap(true);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(this->Show);
  layout->addWidget(this->Apply);
  layout->addWidget(this->State);

  QObject::connect(this->Show, SIGNAL(toggled(bool)), this, SLOT(setWidgetVisible(bool)));
  QObject::connect(this, SIGNAL(widgetVisibilityToggled(bool)), this->Show, SLOT(setChecked(bool)));
  QObject::connect(this, SIGNAL(endInteraction()), this, SLOT(applyDrag()));
  const char* inputs = this->isLattice() ? "Lattice" : "Input";
  pqCoreUtilities::connect(
    proxy->GetProperty(inputs), vtkCommand::ModifiedEvent, this, SLOT(dataChanged()));
  this->setWidgetVisible(true);
}

pqNURBSControlPointsWidget::~pqNURBSControlPointsWidget()
{
  this->watch(nullptr);
}

bool pqNURBSControlPointsWidget::isLattice() const
{
  return this->proxy()->GetProperty("LatticeMoves") != nullptr;
}

bool pqNURBSControlPointsWidget::isShown()
{
  return this->isSelected() && this->isWidgetVisible() && this->view();
}

// The superclass would take handles that never showed, as the panel was not selected yet, for
// unwanted ones when the panel comes back.
void pqNURBSControlPointsWidget::hideEvent(QHideEvent* event)
{
  const bool wanted = this->isWidgetVisible();
  this->pqInteractivePropertyWidget::hideEvent(event);
  this->VisibleState = wanted;
}

void pqNURBSControlPointsWidget::placeWidget()
{
  this->refresh();
}

void pqNURBSControlPointsWidget::updateWidgetVisibility()
{
  this->refresh();
  this->pqInteractivePropertyWidget::updateWidgetVisibility();
}

void pqNURBSControlPointsWidget::watch(vtkSMProxy* source)
{
  if (source != this->Watched)
  {
    if (this->Watched)
    {
      this->Watched->RemoveObserver(this->WatchTag);
    }
    this->Watched = source;
    if (source)
    {
      this->WatchTag =
        pqCoreUtilities::connect(source, vtkCommand::UpdateDataEvent, this, SLOT(dataChanged()));
    }
  }
}

// Not at once: the pipeline is in the middle of an update.
void pqNURBSControlPointsWidget::dataChanged()
{
  if (!this->IsRefreshing)
  {
    this->IsStale = true;
    QTimer::singleShot(0, this, SLOT(refresh()));
  }
}

void pqNURBSControlPointsWidget::refresh()
{
  if (!this->IsStale || this->IsRefreshing || !this->isShown())
  {
    return;
  }
  this->IsRefreshing = true;
  this->IsStale = false;
  vtkSMPropertyHelper input(this->proxy(), "Input");
  auto* source =
    vtkSMSourceProxy::SafeDownCast(this->isLattice() ? this->proxy() : input.GetAsProxy());
  this->watch(source);
  const QString trouble =
    source ? this->setHandles(source, this->isLattice() ? 1 : input.GetOutputPort()) : QString();
  this->State->setText(trouble);
  this->State->setVisible(!trouble.isEmpty());
  this->IsRefreshing = false;
  this->render();
}

// Gives the handles their data. Returns what the user should know.
QString pqNURBSControlPointsWidget::setHandles(vtkSMSourceProxy* source, unsigned int port)
{
  auto* handles = vtkPVNURBSControlPointRepresentation::SafeDownCast(
    this->widgetProxy()->GetRepresentationProxy()->GetClientSideObject());
  if (source->GetSession()->GetNumberOfProcesses(vtkPVSession::DATA_SERVER_ROOT) > 1)
  {
    handles->SetModel(nullptr);
    return "No handles: each process of this server has a part of the model only. The table works.";
  }
  const vtkSmartPointer<vtkDataObject> data = dataOf(source, port);
  if (!data)
  {
    handles->SetModel(nullptr);
    return "The handles appear after Apply.";
  }
  if (!this->isLattice())
  {
    handles->SetModel(data);
    return QString();
  }
  vtkSmartPointer<vtkDataObject> places;
  vtkSMPropertyHelper second(this->proxy(), "Lattice");
  if (auto* lattice = vtkSMSourceProxy::SafeDownCast(second.GetAsProxy()))
  {
    places = dataOf(lattice, second.GetOutputPort());
  }
  static_cast<vtkPVNURBSLatticeRepresentation*>(handles)->SetLattice(
    vtkStructuredGrid::SafeDownCast(data), vtkPointSet::SafeDownCast(places));
  return QString();
}

void pqNURBSControlPointsWidget::applyDrag()
{
  QWidget* above = this->parentWidget();
  while (above && !qobject_cast<pqPropertiesPanel*>(above))
  {
    above = above->parentWidget();
  }
  auto* panel = qobject_cast<pqPropertiesPanel*>(above);
  if (panel && this->Apply->isChecked() && panel->canApply())
  {
    // Not at once: the view is in the middle of the mouse's event.
    QTimer::singleShot(0, panel, SLOT(apply()));
  }
}
