// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNURBSControlPointEdits
 * @brief Moves control points of a NURBS model and changes their weights, with undo.
 *
 * Input: a model (see vtkNURBSModel) or a composite data set of models. Output: the same, with the
 * edits applied. Everything but the points, and the weights if some were edited, is the input's own
 * (shallow copies); so are the points until one is moved. The input is never modified. The array
 * objects of the output's points and weights stay the same from one update to the next, and only
 * entries whose edits changed are written: the first edit copies the array, later ones cost as much
 * as the points that they concern. `RationalWeights` is made, all 1, when a weight of a model
 * without it is edited first.
 *
 * An edit belongs to a control point (the index of a point) of a model, which is named by its flat
 * index in a composite input. Methods that take no block mean the input, or the first model of a
 * composite one. Displacements (MoveControlPoint) add up and are relative to the input, also when
 * that changes; positions and weights are absolute. Coordinates are in the model's unit.
 *
 * MoveCoincident (default on): control points that are at the same place in the input, as on seams,
 * poles and common edges of faces, are edited together, so that no gap opens. They get the same
 * displacement; their weights are multiplied by the same factor, which keeps two faces together
 * whose weights along their common edge differ by a factor.
 *
 * Errors: an edit of a point that does not exist, to a place that is not finite, or to a weight
 * that is not positive and finite is refused as a whole: vtkErrorMacro names the control point, the
 * cells that use it and the reason, the method returns false, and all stays as it was. That needs
 * the input's data. Edits made before it has any are kept and checked in the next update, as are those
 * made before the first update that several processes make of a model's pieces. Edits of
 * points that another input does not have are reported when it comes, and left out.
 *
 * @sa vtkNURBSControlPointWidget
 */
#ifndef vtkNURBSControlPointEdits_h
#define vtkNURBSControlPointEdits_h

#include "vtkNURBSFiltersDeformationModule.h" // For export macro
#include "vtkPassInputTypeAlgorithm.h"

#include <memory> // For std::unique_ptr
#include <string> // For std::string

class vtkIdTypeArray;
class vtkNURBSEditedModel;
class vtkNURBSPieces;
class vtkUnstructuredGrid;

class VTKNURBSFILTERSDEFORMATION_EXPORT vtkNURBSControlPointEdits : public vtkPassInputTypeAlgorithm
{
public:
  static vtkNURBSControlPointEdits* New();
  vtkTypeMacro(vtkNURBSControlPointEdits, vtkPassInputTypeAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Move a control point by (dx, dy, dz) from where it is. True if the edit was accepted.
   */
  bool MoveControlPoint(vtkIdType point, double dx, double dy, double dz);
  bool MoveBlockControlPoint(unsigned int block, vtkIdType point, double dx, double dy, double dz);
  ///@}

  ///@{
  /**
   * Put a control point at (x, y, z). True if the edit was accepted.
   */
  bool SetControlPointPosition(vtkIdType point, double x, double y, double z);
  bool SetBlockControlPointPosition(
    unsigned int block, vtkIdType point, double x, double y, double z);
  ///@}

  ///@{
  /**
   * Give a control point a weight, > 0. True if the edit was accepted.
   */
  bool SetControlPointWeight(vtkIdType point, double weight);
  bool SetBlockControlPointWeight(unsigned int block, vtkIdType point, double weight);
  ///@}

  ///@{
  /**
   * Move control points by the same displacement, or multiply their weights by a factor > 0, as one
   * edit. Each is edited once, also where several of them coincide. True if it was accepted.
   */
  bool MoveBlockControlPoints(
    unsigned int block, vtkIdTypeArray* points, double dx, double dy, double dz);
  bool ScaleBlockControlPointWeights(unsigned int block, vtkIdTypeArray* points, double factor);
  ///@}

  ///@{
  /**
   * Take back all edits of a control point (and of those that coincide with it), or of all points.
   * These are edits too, that Undo takes back. True if it was accepted.
   */
  bool ResetControlPoint(vtkIdType point);
  bool ResetBlockControlPoint(unsigned int block, vtkIdType point);
  void ResetControlPoints();
  ///@}

  /**
   * How many control points are edited: moved or of another weight, coincident ones included. Edits
   * that wait for the input's data count one each.
   */
  vtkIdType GetNumberOfEdits();

  ///@{
  /**
   * Place and weight of a control point after the edits, without an update. False, and nothing
   * written, if the input has no such point; the weight is 0 then.
   */
  bool GetBlockControlPoint(unsigned int block, vtkIdType point, double position[3]);
  double GetBlockControlPointWeight(unsigned int block, vtkIdType point);
  ///@}

  /**
   * The control points that are edited together with this one, itself included, in ascending order.
   * Only itself if MoveCoincident is off, none if the input has no such point.
   */
  void GetCoincidentControlPoints(unsigned int block, vtkIdType point, vtkIdTypeArray* points);

  ///@{
  /**
   * Take the last edit back, or make it again. False if there is none. A new edit forgets those
   * that could be made again; one that waits for the input's data can't be made again.
   */
  bool Undo();
  bool Redo();
  ///@}

  ///@{
  /**
   * How many edits can be taken back or made again.
   */
  int GetNumberOfUndos();
  int GetNumberOfRedos();
  ///@}

  ///@{
  /**
   * Edits between BeginGroup and EndGroup are one for Undo; CancelGroup takes them all back. Groups
   * do not nest. For edits that come in small steps, such as a drag.
   */
  void BeginGroup();
  void EndGroup();
  void CancelGroup();
  ///@}

  ///@{
  /**
   * Edit all control points of the same model that are at the same place in the input. Concerns
   * edits to come. Default on.
   */
  vtkSetMacro(MoveCoincident, bool);
  vtkGetMacro(MoveCoincident, bool);
  vtkBooleanMacro(MoveCoincident, bool);
  ///@}

  ///@{
  /**
   * How far apart such points may be, relative to the diagonal of the model's control points.
   * Default 1e-7, 0 to 1.
   */
  vtkSetClampMacro(CoincidenceTolerance, double, 0.0, 1.0);
  vtkGetMacro(CoincidenceTolerance, double);
  ///@}

protected:
  vtkNURBSControlPointEdits();
  ~vtkNURBSControlPointEdits() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  /// Called while the filter executes, as soon as edits can be checked against the input: its points
  /// are numbered over the models of all processes then. Does nothing.
  virtual void BeforeEdits() {}
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

  bool MoveCoincident = true;
  double CoincidenceTolerance = 1e-7;

private:
  vtkNURBSControlPointEdits(const vtkNURBSControlPointEdits&) = delete;
  void operator=(const vtkNURBSControlPointEdits&) = delete;

  struct vtkEdit;
  struct vtkInternals;

  bool Accept(const vtkEdit& edit);
  vtkDataObject* EditedInput();
  void Gather(vtkDataObject* input, std::unique_ptr<vtkNURBSPieces> pieces);
  void Edit(vtkDataObject* input, vtkDataObject* output);
  bool Resolve(const vtkEdit& edit);
  void ResolveWaiting();
  void Fill(vtkNURBSEditedModel& model, unsigned int block, vtkUnstructuredGrid* output);
  std::unique_ptr<vtkInternals> Internals;
};

#endif
