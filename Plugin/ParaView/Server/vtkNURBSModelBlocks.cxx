// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSModelBlocks.h"

#include "vtkDataObjectTreeIterator.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkIntArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkMultiPieceDataSet.h"
#include "vtkMultiProcessController.h"
#include "vtkNURBSMapper.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>

vtkStandardNewMacro(vtkNURBSModelBlocks);

namespace
{

// Gives each process a place of its own in every block. ParaView puts the pieces of a block together as
// grids where a client draws them, which models are more than.
void SeatPieces(vtkMultiBlockDataSet* blocks, unsigned int rank, unsigned int processes)
{
  for (unsigned int i = 0; i < blocks->GetNumberOfBlocks(); ++i)
  {
    vtkDataObject* block = blocks->GetBlock(i);
    if (auto* inner = vtkMultiBlockDataSet::SafeDownCast(block))
    {
      SeatPieces(inner, rank, processes);
      continue;
    }
    vtkNew<vtkMultiPieceDataSet> seats;
    auto* parts = vtkPartitionedDataSet::SafeDownCast(block);
    const unsigned int count = parts ? std::max(1u, parts->GetNumberOfPartitions()) : 1u;
    seats->SetNumberOfPartitions(processes * count);
    for (unsigned int k = 0; k < count; ++k)
    {
      vtkDataObject* piece = block;
      if (parts)
      {
        piece = k < parts->GetNumberOfPartitions() ? parts->GetPartitionAsDataObject(k) : nullptr;
      }
      seats->SetPartition(rank + k * processes, piece);
    }
    blocks->SetBlock(i, seats);
  }
}

} // namespace

vtkDataObject* vtkNURBSModelBlocks::GetDrawn(vtkDataObject* output)
{
  auto* blocks = vtkMultiBlockDataSet::SafeDownCast(output);
  if (blocks && blocks->GetNumberOfBlocks() == 1 && blocks->GetFieldData()->HasArray(SingleBlock()))
  {
    return blocks->GetBlock(0);
  }
  return output;
}

int vtkNURBSModelBlocks::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  return 1;
}

int vtkNURBSModelBlocks::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  auto* input = vtkDataObject::GetData(inputs[0]);
  auto* output = vtkMultiBlockDataSet::GetData(outputs);
  // Representations update us for what they have, without a word of pieces.
  vtkMultiProcessController* all = vtkMultiProcessController::GetGlobalController();
  const bool parted = all && all->GetNumberOfProcesses() > 1;
  const int rank = parted ? all->GetLocalProcessId() : -1;
  const auto shared = [rank](vtkDataObject* grid, unsigned int flatIndex) {
    vtkNew<vtkUnstructuredGrid> copy;
    copy->ShallowCopy(grid);
    vtkNURBSMapper::SetOrigin(copy, flatIndex, rank);
    return copy;
  };
  if (auto* tree = vtkDataObjectTree::SafeDownCast(input))
  {
    output->CopyStructure(tree);
    auto leaf = vtk::TakeSmartPointer(tree->NewTreeIterator());
    leaf->VisitOnlyLeavesOn();
    for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
    {
      if (vtkUnstructuredGrid::SafeDownCast(leaf->GetCurrentDataObject()))
      {
        output->SetDataSet(leaf, shared(leaf->GetCurrentDataObject(), leaf->GetCurrentFlatIndex()));
      }
    }
  }
  else if (vtkUnstructuredGrid::SafeDownCast(input))
  {
    output->SetBlock(0, shared(input, 0));
    vtkNew<vtkIntArray> mark;
    mark->SetName(SingleBlock());
    output->GetFieldData()->AddArray(mark);
  }
  if (parted)
  {
    SeatPieces(output, unsigned(rank), unsigned(all->GetNumberOfProcesses()));
  }
  return 1;
}
