// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkPVNURBSControlPointRepresentation
 * @brief Handles on the control points of a model whose edits are the tables of a panel.
 *
 * The process where the user is has the model (SetModel) and edits of its own, which are the tables
 * and the present drag. A drag ends as rows of the tables: the selection's displacement is added to
 * Moves, new weights go to Weights, for one control point of those that coincide. Positions stay as
 * they are given. GetMoves and GetWeights have the present drag in them from its first step. Other
 * processes have no model, hence no handles.
 *
 * Rows make sense or not as those of vtkPVNURBSControlPointEdits; what is refused is left out without
 * a message, which that filter gives.
 *
 * @sa vtkPVNURBSControlPointWidget
 */
#ifndef vtkPVNURBSControlPointRepresentation_h
#define vtkPVNURBSControlPointRepresentation_h

#include "vtkNURBSControlPointRepresentation.h"
#include "vtkNURBSParaViewServerModule.h" // For export macro
#include "vtkNew.h"                       // For the edits

#include <memory> // For std::unique_ptr

class vtkDataObject;
class vtkDoubleArray;
struct vtkNURBSEditTables;

class VTKNURBSPARAVIEWSERVER_EXPORT vtkPVNURBSControlPointRepresentation
  : public vtkNURBSControlPointRepresentation
{
public:
  static vtkPVNURBSControlPointRepresentation* New();
  vtkTypeMacro(vtkPVNURBSControlPointRepresentation, vtkNURBSControlPointRepresentation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * The model, or composite data set of models, before the edits; null: no handles.
   */
  void SetModel(vtkDataObject* model);

  ///@{
  /**
   * The tables, see vtkPVNURBSControlPointEdits; they count from ApplyTables on. During a drag, and
   * where they are what GetMoves and GetWeights said, nothing changes.
   */
  void AddMove(double block, double point, double dx, double dy, double dz);
  void RemoveAllMoves();
  void AddPosition(double block, double point, double x, double y, double z);
  void RemoveAllPositions();
  void AddWeight(double block, double point, double weight);
  void RemoveAllWeights();
  void ApplyTables();
  ///@}

  ///@{
  /**
   * The tables with what was dragged, row by row.
   */
  vtkDoubleArray* GetMoves();
  vtkDoubleArray* GetWeights();
  ///@}

  ///@{
  /**
   * See vtkNURBSControlPointEdits.
   */
  void SetMoveCoincident(bool together);
  void SetCoincidenceTolerance(double tolerance);
  ///@}

  bool ScaleSelectedWeights(double factor) override;
  void EndWidgetInteraction(double position[2]) override;

protected:
  vtkPVNURBSControlPointRepresentation();
  ~vtkPVNURBSControlPointRepresentation() override;

private:
  vtkPVNURBSControlPointRepresentation(const vtkPVNURBSControlPointRepresentation&) = delete;
  void operator=(const vtkPVNURBSControlPointRepresentation&) = delete;

  void MoveRows(vtkNURBSEditTables& tables);
  void ApplyRows();

  vtkNew<vtkNURBSControlPointEdits> TableEdits;
  std::unique_ptr<vtkNURBSEditTables> Given; ///< As they come, row by row.
  std::unique_ptr<vtkNURBSEditTables> Rows;  ///< Those that TableEdits are made of.
  vtkNew<vtkDoubleArray> MoveArray, WeightArray;
};

#endif
