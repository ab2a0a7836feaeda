// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkNURBSModelPool.h
 * @brief All models of an input in one, for filters that turn models into polygonal data.
 *
 * An input is a vtkUnstructuredGrid or a composite data set of them; the output is a vtkPolyData,
 * or a composite of the input's type and structure with one vtkPolyData a model.
 */
#ifndef vtkNURBSModelPool_h
#define vtkNURBSModelPool_h

#include "Model.h"
#include "vtkNURBSFiltersCoreModule.h" // For export macro
#include "vtkType.h"                   // For vtkMTimeType

#include <memory> // For std::shared_ptr

class vtkDataObject;
class vtkInformation;
class vtkInformationVector;
class vtkNURBSModelView;
class vtkPolyData;
class vtkUnstructuredGrid;

/// The models of one input; indices of the faces, loops, curves and edges go on from model to
/// model.
class VTKNURBSFILTERSCORE_EXPORT vtkNURBSModelPool
{
public:
  /// One model of the input.
  struct Leaf
  {
    vtkUnstructuredGrid* Grid = nullptr;
    vtkMTimeType Time = 0; ///< The grid's, when it was collected.
    std::shared_ptr<const vtkNURBSModelView> View;
    std::size_t FirstFace = 0, LastFace = 0;
    std::int64_t FirstEdge = 0;
  };

  std::vector<Leaf> Leaves; ///< Without grids that have no cell.
  nurbs::Model Model;
  std::vector<std::string> FaceErrors; ///< One a face: why it can't be used, or "".

  /// Collects the models. Returns what is wrong with the input, "" if nothing is.
  std::string Collect(vtkDataObject* input);
  /// True if the input still has the grids that were collected, and none was modified since.
  bool IsUpToDate(vtkDataObject* input) const;

  /// A grid of an input.
  struct Block
  {
    vtkUnstructuredGrid* Grid = nullptr;
    std::string Name; ///< "block 2 (wheel): ", as vtkNURBSModel::Validate; "" in no composite.
  };
  /// Finds the models of an input, without grids that have no cell. Returns what is wrong with it, ""
  /// if nothing is; does not look at what the arrays hold.
  static std::string Find(vtkDataObject* input, std::vector<Block>& blocks);

  /// "block 2 (wheel): ", of a block's index and what is told of it (may be null).
  static std::string BlockName(unsigned int index, vtkInformation* about);

  /// Makes sure that the outputs of all `ports` are of the right type; for RequestDataObject. The first
  /// `modelPorts` of them are models themselves. False: there is no input.
  static bool MakeOutputs(
    vtkDataObject* input, vtkInformationVector* outputs, int ports, int modelPorts = 0);
  /// Empties an output and gives it the input's structure and assembly.
  static void CopyTree(vtkDataObject* input, vtkDataObject* output);
  /// Gives a composite output one data set for every model, in order.
  static void SetLeaves(
    vtkDataObject* input, vtkDataObject* output, const std::vector<vtkPolyData*>& leaves);
  /// The output's data of every leaf, in order; made new in a composite. LeafT: vtkPolyData, or
  /// vtkUnstructuredGrid for a port of models.
  template <typename LeafT = vtkPolyData>
  std::vector<LeafT*> MakeLeaves(vtkDataObject* input, vtkDataObject* output) const;
};

#endif
