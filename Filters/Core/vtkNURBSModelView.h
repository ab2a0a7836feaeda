// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNURBSModelView
 * @brief A vtkUnstructuredGrid as a nurbs::Model, for filters that call the kernels.
 *
 * Made by vtkNURBSModel::View. Holds the grid's arrays by reference, and converted copies of those
 * that are not double or 64-bit integers, so it may outlive the grid. Immutable and safe to read
 * from many threads. Not wrapped for Python.
 */
#ifndef vtkNURBSModelView_h
#define vtkNURBSModelView_h

#include "ModelArrays.h"
#include "vtkNURBSFiltersCoreModule.h" // For export macro
#include "vtkType.h"                   // For vtkIdType

#include <memory> // For std::unique_ptr

class vtkUnstructuredGrid;

class VTKNURBSFILTERSCORE_EXPORT vtkNURBSModelView
{
public:
  /// Checks and assembles the grid, in parallel over its faces (vtkSMPTools). Never throws on bad
  /// data: see GetProblems. A null grid gives an empty model.
  explicit vtkNURBSModelView(
    vtkUnstructuredGrid* grid, const nurbs::AssembleOptions& options = nurbs::AssembleOptions());
  /// The grid's arrays as they are, without a look at what they hold: GetArrays only. The ids are its
  /// EdgeGlobalId and VertexGlobalId, empty if it has none.
  struct Raw
  {
    std::unique_ptr<vtkNURBSModelView> Owner; ///< Keeps them alive.
    nurbs::ModelArrays Arrays;
    nurbs::ModelArrays::Integers EdgeIds, VertexIds;
  };
  /// The grid's arrays as they are, unchecked.
  static Raw GetRaw(vtkUnstructuredGrid* grid);
  ~vtkNURBSModelView();
  vtkNURBSModelView(const vtkNURBSModelView&) = delete;
  vtkNURBSModelView& operator=(const vtkNURBSModelView&) = delete;

  /// The model: face i is cell i; loops, trim curves, edges and vertices have the indices of the
  /// field data. A face with an error has an empty net (Geometry.Size() 0) and no loop. Edges that
  /// were left behind when points were moved have no curve (see nurbs::AssembleOptions).
  const nurbs::Model& GetModel() const;

  /// Why the face of this cell can't be used; "" if it can. Does not name the cell. Throws
  /// std::out_of_range if there is no such cell.
  const std::string& GetFaceError(vtkIdType cell) const;

  /// All errors and warnings: of arrays, edges, faces and their loops.
  /// Empty for a sound model.
  const std::vector<nurbs::ModelProblem>& GetProblems() const;

  /// A problem as one line: "error: cell 3 (FaceId 17): knots in u decrease ...".
  std::string Describe(const nurbs::ModelProblem& problem) const;

  /// One line for every face with an error, "" if there is none: what a filter warns of.
  std::string DescribeFaceErrors() const;

private:
  vtkNURBSModelView();
  struct Internals;
  std::unique_ptr<Internals> Content;
};

#endif
