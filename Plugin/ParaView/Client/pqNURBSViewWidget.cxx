// SPDX-License-Identifier: BSD-3-Clause
#include "pqNURBSViewWidget.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqProxy.h"
#include "pqRenderView.h"
#include "pqServerManagerModel.h"
#include "vtkCamera.h"
#include "vtkSMDocumentation.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMRenderViewProxy.h"

#include <QHBoxLayout>
#include <QPushButton>

namespace
{

// Sets a property of the panel as if its widget had been edited, if the proxy has it.
template <typename T>
void edit(vtkSMProxy* proxy, const char* name, const T* values, unsigned int count)
{
  if (vtkSMProperty* property = proxy->GetProperty(name))
  {
    vtkSMPropertyHelper helper(property);
    helper.SetUseUnchecked(true);
    helper.Set(values, count);
  }
}

} // namespace

pqNURBSViewWidget::pqNURBSViewWidget(vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent)
  : pqPropertyWidget(proxy, parent)
{
  auto* button = new QPushButton(property->GetXMLLabel(), this);
  button->setObjectName("TakeView");
  button->setToolTip(property->GetDocumentation()->GetDescription());
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(button);
  this->setShowLabel(false);
  QObject::connect(button, SIGNAL(clicked()), this, SLOT(takeView()));
  if (auto* item =
        pqApplicationCore::instance()->getServerManagerModel()->findItem<pqProxy*>(proxy))
  {
    QObject::connect(item, SIGNAL(modifiedStateChanged(pqServerManagerModelItem*)), this,
      SLOT(takeFirstView(pqServerManagerModelItem*)));
  }
}

// Of a filter that waits for its first Apply: the panel is made before it is marked as such a one.
void pqNURBSViewWidget::takeFirstView(pqServerManagerModelItem* item)
{
  auto* source = qobject_cast<pqProxy*>(item);
  if (!this->HasTaken && source && source->modifiedState() == pqProxy::UNINITIALIZED)
  {
    this->takeView();
  }
}

// Of a camera as it was made; what the panel tells about it shows only where it is used.
void pqNURBSViewWidget::showEvent(QShowEvent* event)
{
  this->pqPropertyWidget::showEvent(event);
  vtkSMProperty* position = this->proxy()->GetProperty("CameraPosition");
  if (!this->HasTaken && position && position->IsValueDefault())
  {
    this->takeView();
  }
}

void pqNURBSViewWidget::takeView()
{
  auto* view = qobject_cast<pqRenderView*>(pqActiveObjects::instance().activeView());
  if (!view)
  {
    return;
  }
  this->HasTaken = true;
  vtkCamera* camera = view->getRenderViewProxy()->GetActiveCamera();
  double direction[3];
  camera->GetDirectionOfProjection(direction);
  for (double& coordinate : direction)
  {
    coordinate = -coordinate; // towards the viewer
  }
  const int parallel = camera->GetParallelProjection();
  const int perspective = parallel ? 0 : 1;
  const double angle = camera->GetViewAngle();
  const double scale = camera->GetParallelScale();
  int size[2];
  vtkSMPropertyHelper(view->getProxy(), "ViewSize").Get(size, 2);

  vtkSMProxy* proxy = this->proxy();
  edit(proxy, "Projection", &perspective, 1);
  edit(proxy, "Direction", direction, 3);
  edit(proxy, "EyePoint", camera->GetPosition(), 3);
  edit(proxy, "ViewUp", camera->GetViewUp(), 3);
  edit(proxy, "ViewportSize", size, 2);
  edit(proxy, "CameraPosition", camera->GetPosition(), 3);
  edit(proxy, "CameraFocalPoint", camera->GetFocalPoint(), 3);
  edit(proxy, "CameraViewUp", camera->GetViewUp(), 3);
  edit(proxy, "CameraViewAngle", &angle, 1);
  edit(proxy, "CameraParallelProjection", &parallel, 1);
  edit(proxy, "CameraParallelScale", &scale, 1);
  Q_EMIT this->changeAvailable();
  Q_EMIT this->changeFinished();
}
