// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSFaceMarks.h"

#include "InnerPoint.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"

#include "vtkCellData.h"
#include "vtkDataObjectTree.h"
#include "vtkDataObjectTreeIterator.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPoints.h"
#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>

vtkStandardNewMacro(vtkNURBSFaceMarks);

namespace
{

vtkSmartPointer<vtkDataObject> Marks(vtkUnstructuredGrid* grid)
{
  const vtkNURBSModelView view(grid);
  const nurbs::Model& model = view.GetModel();
  auto marks = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  marks->Allocate(grid->GetNumberOfCells());
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    double place[3] = { 0.0, 0.0, 0.0 };
    vtkIdType count = 0;
    const vtkIdType* net = nullptr;
    grid->GetCellPoints(cell, count, net);
    if (const auto uv = nurbs::InnerPoint(model, cell))
    {
      const nurbs::Vec3 p = nurbs::Evaluate(model.Faces[cell].Geometry, (*uv)[0], (*uv)[1]);
      std::copy_n(p.data(), 3, place);
    }
    else if (count > 0)
    {
      grid->GetPoint(net[count / 2], place);
    }
    const vtkIdType mark = points->InsertNextPoint(place);
    marks->InsertNextCell(VTK_VERTEX, 1, &mark);
  }
  marks->SetPoints(points);
  marks->GetCellData()->ShallowCopy(grid->GetCellData());
  return marks;
}

} // namespace

int vtkNURBSFaceMarks::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  return 1;
}

int vtkNURBSFaceMarks::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkDataObject* input = vtkDataObject::GetData(inputs[0]);
  vtkDataObject* output = vtkDataObject::GetData(outputs);
  const auto marked = [this](vtkDataObject* data) -> vtkSmartPointer<vtkDataObject> {
    auto* grid = vtkUnstructuredGrid::SafeDownCast(data);
    if (grid && !this->KeepModels && vtkNURBSModel::IsModel(grid))
    {
      return Marks(grid);
    }
    return data;
  };
  if (auto* tree = vtkDataObjectTree::SafeDownCast(input))
  {
    auto* made = static_cast<vtkDataObjectTree*>(output);
    made->CopyStructure(tree);
    auto leaf = vtk::TakeSmartPointer(tree->NewTreeIterator());
    leaf->VisitOnlyLeavesOn();
    for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
    {
      made->SetDataSet(leaf, marked(leaf->GetCurrentDataObject()));
    }
  }
  else
  {
    output->ShallowCopy(marked(input));
  }
  return 1;
}
