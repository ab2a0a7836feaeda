// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkPVNURBSLatticeRepresentation
 * @brief Handles on the points of a vtkPVNURBSFreeFormDeformation's lattice.
 *
 * As vtkPVNURBSControlPointRepresentation, of a lattice and its table of displacements: one row
 * (i, j, k, dx, dy, dz) a point, of several the last. Rows that the lattice has no point for are kept
 * at the end of the table. A lattice point has no weight.
 */
#ifndef vtkPVNURBSLatticeRepresentation_h
#define vtkPVNURBSLatticeRepresentation_h

#include "vtkPVNURBSControlPointRepresentation.h"

#include <array>  // For a row
#include <vector> // For the rows

class vtkPointSet;
class vtkStructuredGrid;

class VTKNURBSPARAVIEWSERVER_EXPORT vtkPVNURBSLatticeRepresentation
  : public vtkPVNURBSControlPointRepresentation
{
public:
  static vtkPVNURBSLatticeRepresentation* New();
  vtkTypeMacro(vtkPVNURBSLatticeRepresentation, vtkPVNURBSControlPointRepresentation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * The lattice, as the filter's second output, and the filter's second input if there is one: where
   * its points are without the table. No lattice, or an input of another size: no handles.
   */
  void SetLattice(vtkStructuredGrid* lattice, vtkPointSet* places);

  ///@{
  /**
   * The table, see vtkPVNURBSFreeFormDeformation; it counts from ApplyTables on.
   */
  void AddLatticeMove(double i, double j, double k, double dx, double dy, double dz);
  void RemoveAllLatticeMoves();
  void ApplyTables();
  vtkDoubleArray* GetLatticeMoves();
  ///@}

  bool ScaleSelectedWeights(double) override { return false; }

protected:
  vtkPVNURBSLatticeRepresentation();
  ~vtkPVNURBSLatticeRepresentation() override;

private:
  vtkPVNURBSLatticeRepresentation(const vtkPVNURBSLatticeRepresentation&) = delete;
  void operator=(const vtkPVNURBSLatticeRepresentation&) = delete;

  using Row = std::array<double, 6>;
  bool HasPoint(const Row& row) const;

  std::vector<Row> LatticeRows; ///< As they come.
  int Count[3] = { 0, 0, 0 };   ///< Points along x, y and z; 0: no lattice.
  vtkNew<vtkDoubleArray> LatticeArray;
};

#endif
