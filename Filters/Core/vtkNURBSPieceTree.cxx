// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSPieceTree.h"

#include "Types.h"
#include "vtkNURBSModelPool.h"

#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataObjectTreeIterator.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkUnstructuredGrid.h"

void vtkNURBSPieceTree::Visit(
  vtkDataObject* tree, const std::function<void(unsigned int, unsigned int, vtkDataObject*)>& visit)
{
  const auto partitions = [&](vtkPartitionedDataSet* set, unsigned int block) {
    for (unsigned int k = 0; set && k < set->GetNumberOfPartitions(); ++k)
    {
      if (vtkDataObject* leaf = set->GetPartitionAsDataObject(k))
      {
        visit(block, k, leaf);
      }
    }
  };
  if (auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(tree))
  {
    for (unsigned int i = 0; i < collection->GetNumberOfPartitionedDataSets(); ++i)
    {
      partitions(collection->GetPartitionedDataSet(i), i);
    }
  }
  else if (auto* set = vtkPartitionedDataSet::SafeDownCast(tree))
  {
    partitions(set, 0);
  }
  else if (auto* composite = vtkCompositeDataSet::SafeDownCast(tree))
  {
    vtkSmartPointer<vtkCompositeDataIterator> at;
    at.TakeReference(composite->NewIterator());
    for (at->InitTraversal(); !at->IsDoneWithTraversal(); at->GoToNextItem())
    {
      visit(at->GetCurrentFlatIndex(), 0, at->GetCurrentDataObject());
    }
  }
  else if (tree)
  {
    visit(0, 0, tree);
  }
}

vtkSmartPointer<vtkDataObject> vtkNURBSPieceTree::NewTree(vtkDataObject* like)
{
  vtkSmartPointer<vtkDataObject> tree;
  if (!like->IsA("vtkCompositeDataSet"))
  {
    return vtkSmartPointer<vtkUnstructuredGrid>::New();
  }
  tree.TakeReference(like->NewInstance());
  vtkNURBSModelPool::CopyTree(like, tree);
  return tree;
}

void vtkNURBSPieceTree::Set(
  vtkDataObject* tree, unsigned int block, unsigned int partition, vtkDataObject* leaf)
{
  if (auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(tree))
  {
    if (collection->GetNumberOfPartitionedDataSets() <= block)
    {
      collection->SetNumberOfPartitionedDataSets(block + 1);
    }
    collection->SetPartition(block, partition, leaf);
  }
  else if (auto* set = vtkPartitionedDataSet::SafeDownCast(tree))
  {
    set->SetPartition(partition, leaf);
  }
  else if (auto* composite = vtkCompositeDataSet::SafeDownCast(tree))
  {
    vtkSmartPointer<vtkCompositeDataIterator> at;
    at.TakeReference(composite->NewIterator());
    at->SetSkipEmptyNodes(0);
    for (at->InitTraversal(); !at->IsDoneWithTraversal(); at->GoToNextItem())
    {
      if (at->GetCurrentFlatIndex() == block)
      {
        composite->SetDataSet(at, leaf);
        return;
      }
    }
    throw nurbs::Error("the input has no block " + std::to_string(block) + ", as others have");
  }
  else if (block == 0)
  {
    tree->ShallowCopy(leaf);
  }
  else
  {
    throw nurbs::Error("the input is no composite, as those of others are");
  }
}

const char* vtkNURBSPieceTree::OwnerName()
{
  return "PieceOwner";
}

const char* vtkNURBSPieceTree::CellName()
{
  return "PieceCell";
}
