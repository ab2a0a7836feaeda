// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkPVNURBSModelInformation
 * @brief Tells a client whether an output of a server's algorithm is made of NURBS models
 *
 * It is if every leaf is a vtkUnstructuredGrid whose cells have the control points that their model's
 * arrays say, and there is a cell. ParaView's own information knows of arrays only, which a filter that
 * cuts cells passes on all the same.
 */
#ifndef vtkPVNURBSModelInformation_h
#define vtkPVNURBSModelInformation_h

#include "vtkNURBSParaViewServerModule.h" // For export macro
#include "vtkPVInformation.h"

class VTKNURBSPARAVIEWSERVER_EXPORT vtkPVNURBSModelInformation : public vtkPVInformation
{
public:
  static vtkPVNURBSModelInformation* New();
  vtkTypeMacro(vtkPVNURBSModelInformation, vtkPVInformation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The output that is asked about. Default 0.
   */
  vtkSetMacro(PortNumber, int);
  vtkGetMacro(PortNumber, int);
  ///@}

  /**
   * Whether it is made of models.
   */
  bool GetIsModel() const { return this->Models > 0 && this->Others == 0; }

  ///@{
  /**
   * As vtkPVInformation asks for it.
   */
  void CopyFromObject(vtkObject* algorithm) override;
  void AddInformation(vtkPVInformation* other) override;
  void CopyToStream(vtkClientServerStream* stream) override;
  void CopyFromStream(const vtkClientServerStream* stream) override;
  void CopyParametersToStream(vtkMultiProcessStream& stream) override;
  void CopyParametersFromStream(vtkMultiProcessStream& stream) override;
  ///@}

protected:
  vtkPVNURBSModelInformation() = default;
  ~vtkPVNURBSModelInformation() override = default;

private:
  vtkPVNURBSModelInformation(const vtkPVNURBSModelInformation&) = delete;
  void operator=(const vtkPVNURBSModelInformation&) = delete;

  int PortNumber = 0;
  int Models = 0; ///< Leaves with cells that are models.
  int Others = 0; ///< Leaves with cells that are not.
};

#endif
