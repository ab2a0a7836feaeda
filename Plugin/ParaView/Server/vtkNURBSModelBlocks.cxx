// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSModelBlocks.h"

#include "vtkDataObjectTreeIterator.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkIntArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"

vtkStandardNewMacro(vtkNURBSModelBlocks);

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
  const auto shared = [](vtkDataObject* grid) {
    vtkNew<vtkUnstructuredGrid> copy;
    copy->ShallowCopy(grid);
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
        output->SetDataSet(leaf, shared(leaf->GetCurrentDataObject()));
      }
    }
  }
  else if (vtkUnstructuredGrid::SafeDownCast(input))
  {
    output->SetBlock(0, shared(input));
    vtkNew<vtkIntArray> mark;
    mark->SetName(SingleBlock());
    output->GetFieldData()->AddArray(mark);
  }
  return 1;
}
