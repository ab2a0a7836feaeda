// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkNURBSMeshStore.h
 * @brief A deforming mesh in VTK arrays, edited in place. Private to this module.
 */
#ifndef vtkNURBSMeshStore_h
#define vtkNURBSMeshStore_h

#include "DeformingModel.h"
#include "vtkNew.h"
#include "vtkType.h" // For vtkIdType

class vtkAbstractArray;
class vtkCellArray;
class vtkDoubleArray;
class vtkFloatArray;
class vtkIdTypeArray;
class vtkPoints;
class vtkTypeInt64Array;

/// The arrays stay the same objects as long as this lives, and live on without it.
class vtkNURBSMeshStore : public nurbs::MeshArrays
{
public:
  vtkNURBSMeshStore();
  ~vtkNURBSMeshStore() override;
  vtkNURBSMeshStore(const vtkNURBSMeshStore&) = delete;
  vtkNURBSMeshStore& operator=(const vtkNURBSMeshStore&) = delete;

  void Resize(std::int64_t points, std::int64_t triangles) override;

  /// Calls Modified() of the arrays that a frame changed, and of no other.
  void MarkModified(const nurbs::FrameReport& report);

  vtkPoints* GetPoints() { return this->Positions; }
  vtkFloatArray* GetNormals() { return this->Directions; }
  vtkDoubleArray* GetUV() { return this->Parameters; }
  vtkCellArray* GetCells() { return this->Cells; }
  /// The face of each triangle, counted from 0.
  vtkIdTypeArray* GetFaces() { return this->Owners; }

  /// Changes the number of tuples. What fits is kept; memory grows geometrically and never shrinks,
  /// but for 0 tuples.
  static void SetTupleCount(vtkAbstractArray* array, vtkIdType tuples);

private:
  vtkNew<vtkPoints> Positions;
  vtkNew<vtkDoubleArray> Coordinates;
  vtkNew<vtkFloatArray> Directions;
  vtkNew<vtkDoubleArray> Parameters;
  vtkNew<vtkCellArray> Cells;
  vtkNew<vtkTypeInt64Array> Indices, Offsets;
  vtkNew<vtkIdTypeArray> Owners;
  std::int64_t FilledOffsets = 0; ///< Offsets that were ever set; they never change.
  std::int64_t MarkedPoints = -1, MarkedTriangles = -1; ///< Numbers at the last MarkModified.
};

#endif
