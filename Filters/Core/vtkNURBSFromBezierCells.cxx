// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSFromBezierCells.h"

#include "PatchStitcher.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelNames.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkHigherOrderQuadrilateral.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>

namespace names = vtkNURBSModelNames;

vtkStandardNewMacro(vtkNURBSFromBezierCells);

vtkNURBSFromBezierCells::vtkNURBSFromBezierCells() = default;
vtkNURBSFromBezierCells::~vtkNURBSFromBezierCells() = default;

int vtkNURBSFromBezierCells::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  return 1;
}

namespace
{

/// Reads Bezier quadrilaterals of a grid.
class CellReader
{
public:
  explicit CellReader(vtkUnstructuredGrid* grid)
    : Grid(grid)
    , Degrees(grid->GetCellData()->GetHigherOrderDegrees())
    , Weights(grid->GetPointData()->GetRationalWeights())
  {
    this->Weights =
      this->Weights ? this->Weights : grid->GetPointData()->GetArray(names::RationalWeights);
  }

  /// The cell as a surface. Returns the reason why it can't be one, or "".
  std::string Read(vtkIdType cell, nurbs::Surface& surface)
  {
    if (this->Grid->GetCellType(cell) != VTK_BEZIER_QUADRILATERAL)
    {
      return "its type is " + std::to_string(this->Grid->GetCellType(cell)) +
        " instead of VTK_BEZIER_QUADRILATERAL";
    }
    vtkIdType count;
    const vtkIdType* ids;
    this->Grid->GetCellPoints(cell, count, ids);
    this->ReadDegrees(cell, count, surface.Degree);
    const int p = surface.Degree[0], q = surface.Degree[1];
    if (p < 1 || q < 1 || p > 10 || q > 10 || (p + 1) * (q + 1) != count)
    {
      return std::to_string(count) + " points do not suit the degrees " + std::to_string(p) +
        " and " + std::to_string(q);
    }
    this->ReadNet(ids, surface);
    return std::string();
  }

private:
  void ReadDegrees(vtkIdType cell, vtkIdType count, int* degree)
  {
    degree[0] = degree[1] =
      static_cast<int>(std::lround(std::sqrt(static_cast<double>(count)))) - 1;
    if (this->Degrees && this->Degrees->GetNumberOfComponents() >= 2)
    {
      degree[0] = static_cast<int>(this->Degrees->GetComponent(cell, 0));
      degree[1] = static_cast<int>(this->Degrees->GetComponent(cell, 1));
    }
  }

  void ReadNet(const vtkIdType* ids, nurbs::Surface& surface)
  {
    const int* degree = surface.Degree;
    const int order[3] = { degree[0], degree[1], (degree[0] + 1) * (degree[1] + 1) };
    for (int dir = 0; dir < 2; ++dir)
    {
      surface.Count[dir] = degree[dir] + 1;
      surface.Knots[dir].assign(degree[dir] + 1, 0.0);
      surface.Knots[dir].insert(surface.Knots[dir].end(), degree[dir] + 1, 1.0);
    }
    for (int j = 0; j <= degree[1]; ++j)
    {
      for (int i = 0; i <= degree[0]; ++i)
      {
        const vtkIdType id = ids[vtkHigherOrderQuadrilateral::PointIndexFromIJK(i, j, order)];
        const double* point = this->Grid->GetPoint(id);
        surface.Points.emplace_back(point[0], point[1], point[2]);
        if (this->Weights)
        {
          surface.Weights.push_back(this->Weights->GetComponent(id, 0));
        }
      }
    }
  }

  vtkUnstructuredGrid* Grid;
  vtkDataArray* Degrees;
  vtkDataArray* Weights;
};

/// Puts the input's cell arrays to the model, but those that say how cells were stored.
void CopyAttributes(vtkUnstructuredGrid* input, vtkIdTypeArray* cells, vtkCellData* target)
{
  vtkNURBSModel::CopyFaceAttributes(input, cells, target);
  for (const char* name : { "HigherOrderDegrees", names::PatchDomain, names::Trimmed })
  {
    target->RemoveArray(name);
  }
}

} // namespace

int vtkNURBSFromBezierCells::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkUnstructuredGrid* input = vtkUnstructuredGrid::GetData(inputVector[0]);
  vtkUnstructuredGrid* output = vtkUnstructuredGrid::GetData(outputVector);
  CellReader reader(input);
  nurbs::ModelBuilder builder;
  nurbs::PatchStitcher stitcher(builder, 1e-12 * input->GetLength());
  vtkNew<vtkIdTypeArray> origin;
  constexpr vtkIdType MostTold = 5;
  std::string told;
  vtkIdType skipped = 0;
  for (vtkIdType cell = 0; cell < input->GetNumberOfCells() && !this->GetAbortExecute(); ++cell)
  {
    nurbs::Surface surface;
    const std::string reason = reader.Read(cell, surface);
    if (reason.empty())
    {
      stitcher.AddFace(surface, nurbs::FaceAttributes());
      origin->InsertNextValue(cell);
    }
    else if (++skipped <= MostTold)
    {
      told += "\n  cell " + std::to_string(cell) + ": " + reason;
    }
  }
  if (skipped > 0)
  {
    const vtkIdType more = std::max<vtkIdType>(0, skipped - MostTold);
    vtkWarningMacro(<< skipped << " of " << input->GetNumberOfCells() << " cells are left out:"
                    << told << (more > 0 ? "\n  and " + std::to_string(more) + " more" : ""));
  }
  const std::string unit = vtkNURBSModel::GetLengthUnit(input);
  builder.LengthUnit = unit.empty() ? builder.LengthUnit : unit;
  vtkNURBSModel::Store(builder, output);
  CopyAttributes(input, origin, output->GetCellData());
  return 1;
}

void vtkNURBSFromBezierCells::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
