// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqNURBSControlPointsWidget
 * @brief Handles in the view that edit the tables of a panel.
 *
 * For a property without a value of its own, panel_widget="nurbs_control_points", of a proxy that has
 * Moves, Positions and Weights (handles on the control points of its input), or LatticeMoves (handles
 * on the lattice, which is its second output). The tables stay ordinary properties with widgets of
 * their own; handles and tables follow each other before and after Apply.
 *
 * The client needs the control points: they are copied from the server when the handles show, and
 * whenever they change. Only of a server of one process, as others have a part of the model each.
 */
#ifndef pqNURBSControlPointsWidget_h
#define pqNURBSControlPointsWidget_h

#include "pqInteractivePropertyWidget.h"

#include "vtkWeakPointer.h"

class QCheckBox;
class QLabel;
class vtkSMProperty;
class vtkSMSourceProxy;

class pqNURBSControlPointsWidget : public pqInteractivePropertyWidget
{
  Q_OBJECT

public:
  pqNURBSControlPointsWidget(vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent = nullptr);
  ~pqNURBSControlPointsWidget() override;

  void hideEvent(QHideEvent* event) override;

protected Q_SLOTS:
  void placeWidget() override;
  void updateWidgetVisibility() override;

private Q_SLOTS:
  void dataChanged();
  void refresh();
  void applyDrag();

private: // NOLINT(readability-redundant-access-specifiers)
  Q_DISABLE_COPY(pqNURBSControlPointsWidget)

  bool isLattice() const;
  bool isShown();
  void watch(vtkSMProxy* source);
  QString setHandles(vtkSMSourceProxy* source, unsigned int port);

  QCheckBox* Show = nullptr;
  QCheckBox* Apply = nullptr;
  QLabel* State = nullptr;
  vtkWeakPointer<vtkSMProxy> Watched; ///< Whose updates are waited for.
  unsigned long WatchTag = 0;
  bool IsStale = true;       ///< The handles' data may not be those of the source.
  bool IsRefreshing = false; ///< Updates of the source are our own.
};

#endif
