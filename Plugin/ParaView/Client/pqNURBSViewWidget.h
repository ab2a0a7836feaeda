// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqNURBSViewWidget
 * @brief A button that gives a filter the camera of the active view.
 *
 * For a property without a value of its own, panel_widget="nurbs_view". Sets what the proxy has of
 * Projection, Direction, EyePoint, ViewUp, ViewportSize, and of its camera the properties
 * CameraPosition, CameraFocalPoint, CameraViewUp, CameraViewAngle, CameraParallelProjection and
 * CameraParallelScale; Apply makes it so, as for any change in a panel. By itself it does so once for a
 * filter that waits for its first Apply, and for a camera as it was made when its panel shows.
 */
#ifndef pqNURBSViewWidget_h
#define pqNURBSViewWidget_h

#include "pqPropertyWidget.h"

class pqServerManagerModelItem;

class pqNURBSViewWidget : public pqPropertyWidget
{
  Q_OBJECT

public:
  pqNURBSViewWidget(vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent = nullptr);
  ~pqNURBSViewWidget() override = default;

protected:
  void showEvent(QShowEvent* event) override;

private Q_SLOTS:
  void takeView();
  void takeFirstView(pqServerManagerModelItem* item);

private: // NOLINT(readability-redundant-access-specifiers)
  Q_DISABLE_COPY(pqNURBSViewWidget)

  bool HasTaken = false; ///< A view, by the button or by itself.
};

#endif
