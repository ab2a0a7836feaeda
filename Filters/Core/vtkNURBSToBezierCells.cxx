// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSToBezierCells.h"

#include "ModelChecks.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelNames.h"
#include "vtkNURBSModelView.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkHigherOrderQuadrilateral.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>

namespace names = vtkNURBSModelNames;

vtkStandardNewMacro(vtkNURBSToBezierCells);

vtkNURBSToBezierCells::vtkNURBSToBezierCells() = default;
vtkNURBSToBezierCells::~vtkNURBSToBezierCells() = default;

int vtkNURBSToBezierCells::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  return 1;
}

namespace
{

/// Grows the output patch by patch.
struct BezierGrid
{
  vtkNew<vtkPoints> Points;
  vtkNew<vtkDoubleArray> Weights;
  vtkNew<vtkDoubleArray> Degrees;
  vtkNew<vtkDoubleArray> Domains;
  vtkNew<vtkUnsignedCharArray> Trimmed;
  vtkNew<vtkIdTypeArray> Origin; ///< The face of each cell.
  vtkUnstructuredGrid* Output;

  explicit BezierGrid(vtkUnstructuredGrid* output)
    : Output(output)
  {
    this->Points->SetDataTypeToDouble();
    this->Weights->SetName(names::RationalWeights);
    this->Degrees->SetName("HigherOrderDegrees");
    this->Degrees->SetNumberOfComponents(3);
    this->Domains->SetName(names::PatchDomain);
    this->Domains->SetNumberOfComponents(4);
    this->Trimmed->SetName(names::Trimmed);
    output->Allocate();
  }

  void Add(vtkIdType face, const nurbs::BezierPatch& patch, bool trimmed)
  {
    const vtkIdType first = this->Points->GetNumberOfPoints();
    const int p = patch.Degree[0], q = patch.Degree[1];
    const int order[3] = { p, q, (p + 1) * (q + 1) };
    std::vector<vtkIdType> ids(order[2]);
    for (int j = 0; j <= q; ++j)
    {
      for (int i = 0; i <= p; ++i)
      {
        const int place = vtkHigherOrderQuadrilateral::PointIndexFromIJK(i, j, order);
        const nurbs::Vec4& h = patch.Points[i + j * (p + 1)];
        const vtkIdType id = first + i + j * (p + 1);
        ids[place] = id;
        this->Points->InsertPoint(id, h[0] / h[3], h[1] / h[3], h[2] / h[3]);
        this->Weights->InsertValue(id, h[3]);
      }
    }
    this->Output->InsertNextCell(VTK_BEZIER_QUADRILATERAL, order[2], ids.data());
    this->Degrees->InsertNextTuple3(p, q, 0);
    this->Domains->InsertNextTuple4(patch.U.Min, patch.U.Max, patch.V.Min, patch.V.Max);
    this->Trimmed->InsertNextValue(trimmed ? 1 : 0);
    this->Origin->InsertNextValue(face);
  }

  void Finish(vtkUnstructuredGrid* input, bool rational)
  {
    this->Output->SetPoints(this->Points);
    vtkCellData* cells = this->Output->GetCellData();
    vtkNURBSModel::CopyFaceAttributes(input, this->Origin, cells);
    cells->SetHigherOrderDegrees(this->Degrees);
    cells->AddArray(this->Domains);
    cells->AddArray(this->Trimmed);
    if (rational)
    {
      this->Output->GetPointData()->SetRationalWeights(this->Weights);
    }
    vtkNURBSModel::RemoveStructure(this->Output->GetFieldData());
  }
};

} // namespace

int vtkNURBSToBezierCells::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkUnstructuredGrid* input = vtkUnstructuredGrid::GetData(inputVector[0]);
  const auto view = vtkNURBSModel::View(input);
  std::string skipped = view->DescribeFaceErrors();
  const nurbs::Model& model = view->GetModel();
  BezierGrid grid(vtkUnstructuredGrid::GetData(outputVector));
  bool rational = false;
  for (std::size_t i = 0; i < model.Faces.size() && !this->GetAbortExecute(); ++i)
  {
    const nurbs::Face& face = model.Faces[i];
    const bool trimmed = !nurbs::IsNaturallyBounded(model, face);
    const int degree = std::max(face.Geometry.Degree[0], face.Geometry.Degree[1]);
    if (face.Geometry.Size() > 0 && degree > MaxCellDegree)
    {
      skipped += (skipped.empty() ? "cell " : "\ncell ") + std::to_string(i) + ": degree " +
        std::to_string(degree) + " is over 10, VTK's limit for Bezier cells";
    }
    else if (face.Geometry.Size() > 0 && !(trimmed && this->SkipTrimmedFaces))
    {
      rational |= face.Geometry.IsRational();
      for (const nurbs::BezierPatch& patch : nurbs::ToBezier(face.Geometry))
      {
        grid.Add(static_cast<vtkIdType>(i), patch, trimmed);
      }
    }
  }
  if (!skipped.empty())
  {
    vtkWarningMacro(<< "Left out:\n" << skipped);
  }
  grid.Finish(input, rational);
  return 1;
}

void vtkNURBSToBezierCells::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "SkipTrimmedFaces: " << (this->SkipTrimmedFaces ? "On\n" : "Off\n");
}
