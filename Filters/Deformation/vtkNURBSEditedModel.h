// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkNURBSEditedModel.h
 * @brief One model of vtkNURBSControlPointEdits: the input, and a copy of what edits change.
 *
 * Private to this module. Points and weights are copied when the first edit concerns them; the
 * copies' array objects are kept, and rewritten where edits or the input change.
 */
#ifndef vtkNURBSEditedModel_h
#define vtkNURBSEditedModel_h

#include "EditHistory.h"

#include "vtkNew.h"
#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <string>
#include <vector>

class vtkDataArray;
class vtkIdList;
class vtkPoints;
class vtkStaticPointLocator;
class vtkUnstructuredGrid;

class vtkNURBSEditedModel
{
public:
  vtkNURBSEditedModel();
  ~vtkNURBSEditedModel();
  vtkNURBSEditedModel(const vtkNURBSEditedModel&) = delete;
  void operator=(const vtkNURBSEditedModel&) = delete;

  /// The model to read from; call it before any of the others, whenever the input may have changed.
  void SetInput(vtkUnstructuredGrid* grid);
  vtkUnstructuredGrid* GetInput() const { return this->Input; }
  vtkIdType GetNumberOfPoints() const;

  /// Of the input: a point's place and weight.
  nurbs::Vec3 GetPlace(vtkIdType point) const;
  double GetWeight(vtkIdType point) const;

  /// The points at the place of a point in the input, itself included, within `tolerance` (in units
  /// of the model); in ascending order. Costs a search structure at the first call for an input.
  void FindCoincident(vtkIdType point, double tolerance, std::vector<vtkIdType>& points);
  /// Length of the diagonal of the input's points.
  double GetDiagonal() const;

  /// Why the point can't be put there, or can't have this weight, as the arrays store it; "" if it
  /// can.
  std::string CheckPlace(const nurbs::Vec3& place) const;
  std::string CheckWeight(double weight) const;
  /// "control point 7 (of cell 2, FaceId 17, and 3 more)".
  std::string Describe(vtkIdType point) const;

  /// Makes `output` the input with the edits that `history` has for `block`; `touched` are the
  /// points whose edits changed since the last call. Returns the edited points that the input does
  /// not have.
  std::vector<vtkIdType> Fill(vtkUnstructuredGrid* output, const nurbs::EditHistory& history,
    std::int64_t block, const std::vector<vtkIdType>& touched);

  /// Kept for composites: the output of this model, and what it was made from.
  vtkSmartPointer<vtkUnstructuredGrid> Output;
  vtkMTimeType FilledTime = 0;

private:
  void CopyPoints();
  void CopyWeights();
  bool IsCopyOutdated() const;
  vtkDataArray* InputWeights() const;
  void Write(vtkIdType point, const nurbs::ControlPointEdit& edit);

  vtkSmartPointer<vtkUnstructuredGrid> Input;
  vtkSmartPointer<vtkPoints> Points;
  vtkSmartPointer<vtkDataArray> Weights;
  vtkMTimeType PointsTime = 0, WeightsTime = 0; ///< Of the input, when they were copied.
  vtkNew<vtkStaticPointLocator> Locator;
  vtkNew<vtkIdList> Found;
  vtkMTimeType LocatorTime = 0;
};

#endif
