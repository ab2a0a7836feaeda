// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSEditTables.h"

#include "vtkIdTypeArray.h"
#include "vtkNURBSControlPointEdits.h"

#include <algorithm>

bool vtkNURBSEditTables::operator==(const vtkNURBSEditTables& other) const
{
  return this->Moves == other.Moves && this->Positions == other.Positions &&
    this->Weights == other.Weights;
}

void vtkNURBSEditTables::Apply(vtkNURBSControlPointEdits* edits) const
{
  const auto id = [](double value) { return static_cast<vtkIdType>(value); };
  const auto flat = [](double value) { return static_cast<unsigned int>(value); };
  for (const auto& [block, point, x, y, z] : this->Positions)
  {
    block > 0.0 ? edits->SetBlockControlPointPosition(flat(block), id(point), x, y, z)
                : edits->SetControlPointPosition(id(point), x, y, z);
  }
  for (const auto& [block, point, x, y, z] : this->Moves)
  {
    block > 0.0 ? edits->MoveBlockControlPoint(flat(block), id(point), x, y, z)
                : edits->MoveControlPoint(id(point), x, y, z);
  }
  for (const auto& [block, point, weight] : this->Weights)
  {
    block > 0.0 ? edits->SetBlockControlPointWeight(flat(block), id(point), weight)
                : edits->SetControlPointWeight(id(point), weight);
  }
}

void vtkNURBSEditTables::Move(
  unsigned int block, vtkIdTypeArray* together, vtkIdType point, const double by[3])
{
  const auto isMeant = [&](const PlaceRow& row) {
    return row[0] == block && together->LookupValue(static_cast<vtkIdType>(row[1])) >= 0;
  };
  auto row = std::find_if(this->Moves.rbegin(), this->Moves.rend(), isMeant);
  if (row == this->Moves.rend())
  {
    this->Moves.push_back({ double(block), double(point), 0.0, 0.0, 0.0 });
    row = this->Moves.rbegin();
  }
  for (int k = 0; k < 3; ++k)
  {
    (*row)[2 + k] += by[k];
  }
}

void vtkNURBSEditTables::SetWeight(unsigned int block, vtkIdType point, double weight)
{
  const auto isMeant = [&](const WeightRow& row) {
    return row[0] == block && row[1] == double(point);
  };
  const auto row = std::find_if(this->Weights.rbegin(), this->Weights.rend(), isMeant);
  if (row == this->Weights.rend())
  {
    this->Weights.push_back({ double(block), double(point), weight });
  }
  else
  {
    (*row)[2] = weight;
  }
}
