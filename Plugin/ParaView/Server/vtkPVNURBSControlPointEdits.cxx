// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVNURBSControlPointEdits.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkPVNURBSControlPointEdits);

void vtkPVNURBSControlPointEdits::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Moves: " << this->Moves.size() << "\n";
  os << indent << "Positions: " << this->Positions.size() << "\n";
  os << indent << "Weights: " << this->Weights.size() << "\n";
}

void vtkPVNURBSControlPointEdits::AddMove(
  double block, double point, double dx, double dy, double dz)
{
  this->Moves.push_back({ block, point, dx, dy, dz });
  this->Changed = true;
  this->Modified();
}

void vtkPVNURBSControlPointEdits::AddPosition(
  double block, double point, double x, double y, double z)
{
  this->Positions.push_back({ block, point, x, y, z });
  this->Changed = true;
  this->Modified();
}

void vtkPVNURBSControlPointEdits::AddWeight(double block, double point, double weight)
{
  this->Weights.push_back({ block, point, weight, 0.0, 0.0 });
  this->Changed = true;
  this->Modified();
}

void vtkPVNURBSControlPointEdits::RemoveAllMoves()
{
  this->Clear(this->Moves);
}

void vtkPVNURBSControlPointEdits::RemoveAllPositions()
{
  this->Clear(this->Positions);
}

void vtkPVNURBSControlPointEdits::RemoveAllWeights()
{
  this->Clear(this->Weights);
}

void vtkPVNURBSControlPointEdits::Clear(std::vector<Row>& rows)
{
  if (!rows.empty())
  {
    rows.clear();
    this->Changed = true;
    this->Modified();
  }
}

// All rows are one group that stays open: cancelling it takes them back without a history that grows.
void vtkPVNURBSControlPointEdits::Apply()
{
  if (this->InGroup)
  {
    this->CancelGroup();
  }
  this->BeginGroup();
  this->InGroup = true;
  const auto id = [](double value) { return static_cast<vtkIdType>(value); };
  const auto flat = [](double value) { return static_cast<unsigned int>(value); };
  for (const auto& [block, point, x, y, z] : this->Positions)
  {
    block > 0.0 ? this->SetBlockControlPointPosition(flat(block), id(point), x, y, z)
                : this->SetControlPointPosition(id(point), x, y, z);
  }
  for (const auto& [block, point, x, y, z] : this->Moves)
  {
    block > 0.0 ? this->MoveBlockControlPoint(flat(block), id(point), x, y, z)
                : this->MoveControlPoint(id(point), x, y, z);
  }
  for (const auto& row : this->Weights)
  {
    row[0] > 0.0 ? this->SetBlockControlPointWeight(flat(row[0]), id(row[1]), row[2])
                 : this->SetControlPointWeight(id(row[1]), row[2]);
  }
  this->Changed = false;
}

int vtkPVNURBSControlPointEdits::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  if (this->Changed)
  {
    this->Apply();
  }
  return this->Superclass::RequestData(request, inputs, outputs);
}
