// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkNURBSHandleSet.h
 * @brief The control points and nets of all models of a data object, numbered through.
 *
 * Private to this module. Handle i is a control point of one of the models; those of a model follow
 * each other in the order of its points.
 */
#ifndef vtkNURBSHandleSet_h
#define vtkNURBSHandleSet_h

#include "Types.h"

#include "vtkNew.h"
#include "vtkSmartPointer.h"
#include "vtkType.h"

class vtkCellArray;
class vtkDataObject;
class vtkPoints;
class vtkUnstructuredGrid;

class vtkNURBSHandleSet
{
public:
  vtkNURBSHandleSet();
  ~vtkNURBSHandleSet();
  vtkNURBSHandleSet(const vtkNURBSHandleSet&) = delete;
  void operator=(const vtkNURBSHandleSet&) = delete;

  /// Reads the models. True if handles or nets are others than before, rather than elsewhere.
  bool Update(vtkDataObject* data);
  /// Forgets everything.
  void Clear();

  /// All control points, also those that no cell uses; the model's own object if there is one
  /// model.
  vtkPoints* GetPoints() const { return this->Points; }
  /// Their coordinates as triples of doubles.
  const double* GetCoordinates();
  /// Handles: the control points that some cell uses, in ascending order.
  const std::vector<std::int64_t>& GetHandles() const { return this->Handles; }

  /// Model and point of a handle; and back, -1 if there is none.
  unsigned int GetBlock(std::int64_t handle) const;
  vtkIdType GetPointId(std::int64_t handle) const;
  std::int64_t GetHandle(unsigned int block, vtkIdType point) const;

  /// Marks the faces that use one of the handles; faces are numbered through like handles.
  std::vector<bool> FindFaces(const std::vector<std::int64_t>& handles) const;
  /// The nets of faces as polylines; of all faces if `wanted` is empty.
  vtkSmartPointer<vtkCellArray> MakeNet(const std::vector<bool>& wanted) const;
  /// The unit normal of the surface at the Greville abscissae of the control point, in the first
  /// face that uses it; zero if there is no such face or normal.
  nurbs::Vec3 GetNormal(std::int64_t handle) const;

private:
  struct Model
  {
    vtkSmartPointer<vtkUnstructuredGrid> Grid;
    vtkSmartPointer<vtkCellArray> Cells; ///< Kept, so that another can't have the same address.
    unsigned int Block = 0;
    vtkIdType FirstPoint = 0, PointCount = 0;
    std::size_t FirstFace = 0;
    vtkMTimeType CellsTime = 0;
    std::vector<int> RowLengths; ///< Control points in u of each face; 0: unusable.
  };
  std::vector<Model> FindModels(vtkDataObject* data) const;
  void FindHandles();
  void GatherPoints();
  const Model& ModelOf(std::int64_t handle) const;

  std::vector<Model> Models;
  std::vector<std::int64_t> Handles;
  vtkSmartPointer<vtkPoints> Points;
  vtkNew<vtkPoints> Gathered;
  std::vector<double> Converted; ///< Of points that are not doubles.
  vtkMTimeType ConvertedTime = 0;
};

#endif
