// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkPVNURBSControlPointEdits
 * @brief vtkNURBSControlPointEdits, its edits given by tables, as panels and state files need them.
 *
 * The output is the input with all rows applied: positions first, then moves, then weights, each in the
 * order of its rows. A row that is refused (see vtkNURBSControlPointEdits) is an error in the next
 * update that names the control point; the others are applied. Blocks are flat indices of a composite
 * input; 0 is the input itself, or the first model of a composite one. Indices are doubles, because a
 * property's elements are all of one type.
 */
#ifndef vtkPVNURBSControlPointEdits_h
#define vtkPVNURBSControlPointEdits_h

#include "vtkNURBSControlPointEdits.h"
#include "vtkNURBSParaViewServerModule.h" // For export macro

#include <memory> // For std::unique_ptr
#include <vector> // For rows

struct vtkNURBSEditTables;

class VTKNURBSPARAVIEWSERVER_EXPORT vtkPVNURBSControlPointEdits : public vtkNURBSControlPointEdits
{
public:
  static vtkPVNURBSControlPointEdits* New();
  vtkTypeMacro(vtkPVNURBSControlPointEdits, vtkNURBSControlPointEdits);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Move a control point by (dx, dy, dz), in the unit of the points; or none.
   */
  void AddMove(double block, double point, double dx, double dy, double dz);
  void RemoveAllMoves();
  ///@}

  ///@{
  /**
   * Put a control point at (x, y, z); or none.
   */
  void AddPosition(double block, double point, double x, double y, double z);
  void RemoveAllPositions();
  ///@}

  ///@{
  /**
   * Give a control point a weight, > 0; or none.
   */
  void AddWeight(double block, double point, double weight);
  void RemoveAllWeights();
  ///@}

protected:
  vtkPVNURBSControlPointEdits();
  ~vtkPVNURBSControlPointEdits() override;

  void BeforeEdits() override;

private:
  vtkPVNURBSControlPointEdits(const vtkPVNURBSControlPointEdits&) = delete;
  void operator=(const vtkPVNURBSControlPointEdits&) = delete;

  template <typename Row>
  void Add(std::vector<Row>& rows, const Row& row);
  template <typename Row>
  void Clear(std::vector<Row>& rows);

  std::unique_ptr<vtkNURBSEditTables> Tables;
  bool Changed = false; ///< Rows that are not applied yet.
  bool InGroup = false; ///< The applied rows are the open group of the edits' history.
};

#endif
