// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkSMNURBSDisplayInitializationHelper
 * @brief Lets a new representation of NURBS models show surfaces
 *
 * Whatever made them: ParaView's own filters pass models on (Threshold, Transform, Extract Block, ...)
 * and say nothing of how to show them. Where all cells have the arrays that no model can do without,
 * the server is asked (vtkPVNURBSModelInformation). Other data, cells that were cut, and a
 * representation that was set before, such as by a user's settings, are left alone.
 *
 * Lines that lie on surfaces (silhouettes, drawings, trim curves) show black, and those of drawings two
 * pixels wide: in the colour of surfaces they could not be told from them.
 *
 * A hint of UnstructuredGridRepresentation and GeometryRepresentation (representation.xml).
 */
#ifndef vtkSMNURBSDisplayInitializationHelper_h
#define vtkSMNURBSDisplayInitializationHelper_h

#include "vtkNURBSParaViewServerModule.h" // For export macro
#include "vtkSMProxyInitializationHelper.h"

class VTKNURBSPARAVIEWSERVER_EXPORT vtkSMNURBSDisplayInitializationHelper
  : public vtkSMProxyInitializationHelper
{
public:
  static vtkSMNURBSDisplayInitializationHelper* New();
  vtkTypeMacro(vtkSMNURBSDisplayInitializationHelper, vtkSMProxyInitializationHelper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  void PostInitializeProxy(vtkSMProxy* proxy, vtkPVXMLElement* xml, vtkMTimeType started) override;

protected:
  vtkSMNURBSDisplayInitializationHelper() = default;
  ~vtkSMNURBSDisplayInitializationHelper() override = default;

private:
  vtkSMNURBSDisplayInitializationHelper(const vtkSMNURBSDisplayInitializationHelper&) = delete;
  void operator=(const vtkSMNURBSDisplayInitializationHelper&) = delete;
};

#endif
