// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkNURBSFaceAttributes.h
 * @brief The attributes of a model's faces as cell data of its triangles. Private to this module.
 */
#ifndef vtkNURBSFaceAttributes_h
#define vtkNURBSFaceAttributes_h

#include "vtkNURBSArrayContent.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"

class vtkCellData;
class vtkIdTypeArray;
class vtkUnstructuredGrid;

/// What vtkNURBSModel::CopyFaceAttributes copies, kept from frame to frame: triangles that come to
/// another face get its attributes, and arrays of which no value changes are not touched.
class vtkNURBSFaceAttributes
{
public:
  vtkNURBSFaceAttributes();
  ~vtkNURBSFaceAttributes();

  /// @param faces the face (cell of `grid`) of each triangle.
  /// @param first, last triangles that may have come to another face; last < 0: none. Those that are
  /// more than last time are always looked at.
  void Update(vtkUnstructuredGrid* grid, vtkIdTypeArray* faces, vtkIdType first, vtkIdType last);
  vtkCellData* GetData() { return this->Data; }

private:
  bool HasSources(vtkUnstructuredGrid* grid);
  void Make(vtkUnstructuredGrid* grid, vtkIdTypeArray* faces);

  vtkNew<vtkCellData> Data;
  std::vector<vtkSmartPointer<vtkAbstractArray>> Sources; ///< One an array of Data; null: indices.
  vtkNURBSArrayContent::Stamps OwnStamps; ///< Of Sources, when they were copied from.
  vtkNURBSArrayContent::Stamps SeenStamps;
  std::vector<vtkIdType> Owners; ///< Faces whose attributes the triangles have.
  bool Made = false;
};

#endif
