// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkPVNURBSFreeFormDeformation
 * @brief vtkNURBSFreeFormDeformation, its lattice set by a table, as panels and state files need it.
 *
 * Rows of the table (i, j, k, dx, dy, dz) outlive a change of Dimensions; those that the lattice has no
 * point for are named in one warning in the next update. Indices are doubles, because a property's
 * elements are all of one type.
 */
#ifndef vtkPVNURBSFreeFormDeformation_h
#define vtkPVNURBSFreeFormDeformation_h

#include "vtkNURBSFreeFormDeformation.h"
#include "vtkNURBSParaViewServerModule.h" // For export macro

#include <array>  // For a row
#include <vector> // For the rows

class VTKNURBSPARAVIEWSERVER_EXPORT vtkPVNURBSFreeFormDeformation
  : public vtkNURBSFreeFormDeformation
{
public:
  static vtkPVNURBSFreeFormDeformation* New();
  vtkTypeMacro(vtkPVNURBSFreeFormDeformation, vtkNURBSFreeFormDeformation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Displace lattice point (i, j, k) by (dx, dy, dz), in the unit of the points; or none. The last row
   * of a point counts.
   */
  void AddLatticeMove(double i, double j, double k, double dx, double dy, double dz);
  void RemoveAllLatticeMoves();
  ///@}

protected:
  vtkPVNURBSFreeFormDeformation() = default;
  ~vtkPVNURBSFreeFormDeformation() override = default;

  int RequestData(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkPVNURBSFreeFormDeformation(const vtkPVNURBSFreeFormDeformation&) = delete;
  void operator=(const vtkPVNURBSFreeFormDeformation&) = delete;

  std::vector<std::array<double, 6>> Moves;
};

#endif
