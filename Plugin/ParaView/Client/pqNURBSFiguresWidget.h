// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqNURBSFiguresWidget
 * @brief What a filter tells of its last update, line by line, as it comes.
 *
 * For property groups of information-only numbers, panel_widget="nurbs_figures". Numbers of faces that
 * failed or were capped stand out if they are not 0.
 */
#ifndef pqNURBSFiguresWidget_h
#define pqNURBSFiguresWidget_h

#include "pqPropertyGroupWidget.h"

class QLabel;

class pqNURBSFiguresWidget : public pqPropertyGroupWidget
{
  Q_OBJECT

public:
  pqNURBSFiguresWidget(vtkSMProxy* proxy, vtkSMPropertyGroup* group, QWidget* parent = nullptr);
  ~pqNURBSFiguresWidget() override = default;

private Q_SLOTS:
  void refresh();

private: // NOLINT(readability-redundant-access-specifiers)
  Q_DISABLE_COPY(pqNURBSFiguresWidget)

  QList<QLabel*> Values; ///< One a property of the group.
};

#endif
