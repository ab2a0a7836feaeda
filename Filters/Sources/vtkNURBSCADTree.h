// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkNURBSCADTree.h
 * @brief Models, their names, colours and assembly tree out of VTK data, for a CAD file.
 */
#ifndef vtkNURBSCADTree_h
#define vtkNURBSCADTree_h

#include "CADExport.h"

#include <string>
#include <vector>

class vtkDataObject;
class vtkUnstructuredGrid;

namespace vtkNURBSCADTree
{

/// A model of the input.
struct Block
{
  vtkUnstructuredGrid* Grid = nullptr;
  std::string Prefix; ///< "block 2 (wheel): ", as vtkNURBSModel::Validate; "" in no composite.
  std::string Name;   ///< "wheel"; "" if it has none.
  int DataSet = -1;   ///< Index in a vtkPartitionedDataSetCollection; -1: in none.
};

/// Finds the models of an input, without grids that have no cell. Returns what is wrong with it, ""
/// if nothing is; does not look at what the arrays hold.
std::string Find(vtkDataObject* input, std::vector<Block>& blocks);

/// Fills in names and colours of the part's faces as far as the grid has them, and the name that all
/// cells share, if they do, as the part's. `cells`: the cell of each face.
void DescribeFaces(
  vtkUnstructuredGrid* grid, const std::vector<std::int64_t>& cells, nurbs::CADPart& part);

/// Fills in the nodes of the tree and the names of the parts. `parts` has the index of each block's
/// part, or -1. Below the root of the input's vtkDataAssembly, each node is one; without an assembly
/// several parts get one node above them, with the name `root`. The name of the only part of an
/// input without names is `root`, too.
void MakeNodes(vtkDataObject* input, const std::vector<Block>& blocks,
  const std::vector<std::int64_t>& parts, const std::string& root, nurbs::CADContent& content);

} // namespace vtkNURBSCADTree

#endif
