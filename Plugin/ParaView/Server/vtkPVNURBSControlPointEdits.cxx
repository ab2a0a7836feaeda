// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVNURBSControlPointEdits.h"

#include "vtkNURBSEditTables.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkPVNURBSControlPointEdits);

vtkPVNURBSControlPointEdits::vtkPVNURBSControlPointEdits()
  : Tables(new vtkNURBSEditTables)
{}

vtkPVNURBSControlPointEdits::~vtkPVNURBSControlPointEdits() = default;

void vtkPVNURBSControlPointEdits::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Moves: " << this->Tables->Moves.size() << "\n";
  os << indent << "Positions: " << this->Tables->Positions.size() << "\n";
  os << indent << "Weights: " << this->Tables->Weights.size() << "\n";
}

template <typename Row>
void vtkPVNURBSControlPointEdits::Add(std::vector<Row>& rows, const Row& row)
{
  rows.push_back(row);
  this->Changed = true;
  this->Modified();
}

template <typename Row>
void vtkPVNURBSControlPointEdits::Clear(std::vector<Row>& rows)
{
  if (!rows.empty())
  {
    rows.clear();
    this->Changed = true;
    this->Modified();
  }
}

void vtkPVNURBSControlPointEdits::AddMove(
  double block, double point, double dx, double dy, double dz)
{
  this->Add(this->Tables->Moves, { block, point, dx, dy, dz });
}

void vtkPVNURBSControlPointEdits::AddPosition(
  double block, double point, double x, double y, double z)
{
  this->Add(this->Tables->Positions, { block, point, x, y, z });
}

void vtkPVNURBSControlPointEdits::AddWeight(double block, double point, double weight)
{
  this->Add(this->Tables->Weights, { block, point, weight });
}

void vtkPVNURBSControlPointEdits::RemoveAllMoves()
{
  this->Clear(this->Tables->Moves);
}

void vtkPVNURBSControlPointEdits::RemoveAllPositions()
{
  this->Clear(this->Tables->Positions);
}

void vtkPVNURBSControlPointEdits::RemoveAllWeights()
{
  this->Clear(this->Tables->Weights);
}

void vtkPVNURBSControlPointEdits::BeforeEdits()
{
  if (this->Changed)
  {
    // All rows are one group that stays open: cancelling it takes them back without a history that
    // grows.
    if (this->InGroup)
    {
      this->CancelGroup();
    }
    this->BeginGroup();
    this->InGroup = true;
    this->Tables->Apply(this);
    this->Changed = false;
  }
}
