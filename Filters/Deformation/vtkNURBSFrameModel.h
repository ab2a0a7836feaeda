// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkNURBSFrameModel.h
 * @brief A model whose control points are those of one grid after the other. Private to this module.
 */
#ifndef vtkNURBSFrameModel_h
#define vtkNURBSFrameModel_h

#include "Model.h"
#include "vtkNURBSArrayContent.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"

#include <memory> // For std::shared_ptr

class vtkDataArray;
class vtkNURBSModelView;
class vtkUnstructuredGrid;

/// The structure of the first grid is checked and copied, so that nobody can change it; from then on
/// a frame costs a look at its arrays. The control points' arrays are not copied but for those that
/// are not doubles, nor are their values checked.
class vtkNURBSFrameModel
{
public:
  explicit vtkNURBSFrameModel(vtkUnstructuredGrid* grid);
  ~vtkNURBSFrameModel();

  /// True if the grid's surfaces differ from the first one's in control points and weights only.
  bool HasStructureOf(vtkUnstructuredGrid* grid);
  /// True if the grid's points and weights are the arrays taken last and were not modified since.
  bool HasPointsOf(vtkUnstructuredGrid* grid) const;
  /// Makes the model's control points those of a grid of the same structure.
  void TakePoints(vtkUnstructuredGrid* grid);
  /// Makes HasPointsOf false until the next TakePoints.
  void ForgetPoints() { this->PointStamps.clear(); }

  /// One a face: whether its structure is not the one it has in `other`. Empty if the numbers of faces,
  /// loops, trim curves or edges differ, or the edges' vertices.
  std::vector<char> FindChangedFaces(const vtkNURBSFrameModel& other) const;

  /// Compares with the grid of `other`, in which no face changed, from now on.
  void TakeStructure(const vtkNURBSFrameModel& other);

  const nurbs::Model& GetModel() const { return this->Model; }
  const std::vector<std::string>& GetFaceErrors() const { return this->FaceErrors; }
  const vtkNURBSModelView& GetView() const { return *this->View; }
  /// Why the first frame can't be used: the face whose control points are bad. "" if it can.
  const std::string& GetProblem() const { return this->Problem; }

private:
  void FindProblem(vtkUnstructuredGrid* grid);

  vtkNew<vtkUnstructuredGrid> Structure;                 ///< With copies of its arrays.
  std::vector<vtkSmartPointer<vtkAbstractArray>> Arrays; ///< These copies.
  vtkNURBSArrayContent::Stamps StructureStamps, PointStamps;
  std::shared_ptr<const vtkNURBSModelView> View; ///< Of Structure.
  vtkIdType PointCount = 0;
  nurbs::Model Model;
  std::vector<std::string> FaceErrors;
  std::string Problem;
  vtkSmartPointer<vtkDataArray> Points, Weights; ///< What the model points into.
};

#endif
