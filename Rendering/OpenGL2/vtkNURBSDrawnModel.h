// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkNURBSDrawnModel
 * @brief   what a mapper keeps of its input: surfaces and trims, ready for the GPU
 *
 * The faces of a model, or of all models of a composite data set in the order of its iterator, are
 * one list of surfaces. Update compares with what was there before, and tells apart what changed:
 * control points alone (which of the surfaces moved), trims, or knots and nets. Private to this module.
 */
#ifndef vtkNURBSDrawnModel_h
#define vtkNURBSDrawnModel_h

#include "SurfaceTable.h"
#include "TrimIndex.h"
#include "vtkNURBSModelView.h"
#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

class vtkDataObject;

class vtkNURBSDrawnModel
{
public:
  /// What is other than at the last Update.
  struct Change
  {
    bool Points = false;   ///< Control points or weights of GetMoved().
    bool Trims = false;    ///< GetTrims() are new, and edges' tolerances.
    bool Surfaces = false; ///< All is new.
    bool Any() const { return this->Points || this->Trims || this->Surfaces; }
  };

  /// One model of the input.
  struct Leaf
  {
    vtkSmartPointer<vtkUnstructuredGrid> Grid;
    unsigned int FlatIndex = 0; ///< In the composite data set; 0: there is none.
    int Process = -1;           ///< The process that has the data; -1: the one that draws.
    int First = 0;              ///< Its first surface.
    std::shared_ptr<const vtkNURBSModelView> View;
    std::vector<std::pair<const void*, vtkMTimeType>> Surfaces;
    std::vector<std::pair<const void*, vtkMTimeType>> Trims;
    std::vector<std::pair<const void*, vtkMTimeType>> Points;
    const nurbs::Model& Model() const { return this->View->GetModel(); }
  };

  /// Tells in the field data where a model comes from; see vtkNURBSMapper::SetOrigin.
  static void SetOrigin(vtkUnstructuredGrid* grid, unsigned int flatIndex, int process);

  /// Takes the input as it is now. Faces with errors are not drawn; GetWarnings has a line for each
  /// that is new. Throws nurbs::Error if the surfaces are too many or too large for the tables, which
  /// are empty then until the input changes.
  Change Update(vtkDataObject* input);

  const nurbs::SurfaceTable& GetTable() const { return this->Table; }
  const nurbs::TrimTexels& GetTrims() const { return this->Trims; }
  const std::vector<Leaf>& GetLeaves() const { return this->Leaves; }
  const std::vector<int>& GetMoved() const { return this->Moved; }
  const std::string& GetWarnings() const { return this->Warnings; }
  /// True if the input has data, but none of it is a model.
  bool HasOtherData() const { return this->Leaves.empty() && this->OtherData; }
  /// Around the surfaces, or those that are not hidden.
  nurbs::Box3 GetBounds(const std::function<bool(int)>& isHidden = nullptr) const;
  /// The highest degree of a surface, in either direction.
  int GetMaxDegree() const { return this->MaxDegree; }

private:
  void Rebuild();
  void RebuildTrims();
  void AddTrims(const nurbs::TrimIndex& index);
  void Move();

  std::vector<Leaf> Leaves;
  nurbs::SurfaceTable Table;
  nurbs::TrimTexels Trims;
  std::vector<int> Moved;
  std::string Warnings;
  int MaxDegree = 1;
  bool OtherData = false;
};

#endif
