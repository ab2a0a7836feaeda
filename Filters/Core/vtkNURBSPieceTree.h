// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkNURBSPieceTree.h
 * @brief Data sets of a composite by block and partition, for vtkNURBSPieces. Private to this module.
 *
 * A block is a partitioned data set of a collection, by its index; a leaf of another composite, by its
 * flat index; or 0 where there is no tree. Its number is the same on all processes.
 */
#ifndef vtkNURBSPieceTree_h
#define vtkNURBSPieceTree_h

#include "vtkSmartPointer.h"

#include <functional>

class vtkDataObject;

namespace vtkNURBSPieceTree
{

/// Calls visit(block, partition, data set) for all data sets; null ones are left out.
void Visit(vtkDataObject* tree,
  const std::function<void(unsigned int, unsigned int, vtkDataObject*)>& visit);

/// A tree of the same structure and assembly, with no data sets; an empty grid if it is one.
vtkSmartPointer<vtkDataObject> NewTree(vtkDataObject* like);

/// Puts a data set to its place; a tree that is a data set itself takes its content. Throws nurbs::Error
/// if there is no such place.
void Set(vtkDataObject* tree, unsigned int block, unsigned int partition, vtkDataObject* leaf);

/// Names of cell arrays of a gathered model: the process that a face belongs to, and the number of
/// the cell there.
const char* OwnerName();
const char* CellName();

} // namespace vtkNURBSPieceTree

#endif
