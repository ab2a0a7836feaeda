// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkPVNURBSControlPointWidget
 * @brief vtkNURBSControlPointWidget whose history is its host's: no keys for undo and redo.
 *
 * @sa vtkPVNURBSControlPointRepresentation
 */
#ifndef vtkPVNURBSControlPointWidget_h
#define vtkPVNURBSControlPointWidget_h

#include "vtkNURBSControlPointWidget.h"
#include "vtkNURBSParaViewServerModule.h" // For export macro

class VTKNURBSPARAVIEWSERVER_EXPORT vtkPVNURBSControlPointWidget : public vtkNURBSControlPointWidget
{
public:
  static vtkPVNURBSControlPointWidget* New();
  vtkTypeMacro(vtkPVNURBSControlPointWidget, vtkNURBSControlPointWidget);
  void PrintSelf(ostream& os, vtkIndent indent) override;

protected:
  vtkPVNURBSControlPointWidget();
  ~vtkPVNURBSControlPointWidget() override = default;

private:
  vtkPVNURBSControlPointWidget(const vtkPVNURBSControlPointWidget&) = delete;
  void operator=(const vtkPVNURBSControlPointWidget&) = delete;
};

#endif
