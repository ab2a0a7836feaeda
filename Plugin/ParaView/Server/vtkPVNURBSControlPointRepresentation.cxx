// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVNURBSControlPointRepresentation.h"

#include "vtkNURBSControlPointEdits.h"
#include "vtkNURBSEditTables.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkDataObject.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkObjectFactory.h"

#include <set>
#include <utility>

vtkStandardNewMacro(vtkPVNURBSControlPointRepresentation);

namespace
{

template <std::size_t N>
void CopyRows(const std::vector<std::array<double, N>>& rows, vtkDoubleArray* array)
{
  array->SetNumberOfComponents(static_cast<int>(N));
  array->SetNumberOfTuples(static_cast<vtkIdType>(rows.size()));
  for (std::size_t n = 0; n < rows.size(); ++n)
  {
    array->SetTypedTuple(static_cast<vtkIdType>(n), rows[n].data());
  }
}

// What the edits refuse is said by the filter.
void KeepSilent(vtkObject*, unsigned long, void*, void*) {}

} // namespace

vtkPVNURBSControlPointRepresentation::vtkPVNURBSControlPointRepresentation()
  : Given(new vtkNURBSEditTables)
  , Rows(new vtkNURBSEditTables)
{
  vtkNew<vtkCallbackCommand> silence;
  silence->SetCallback(KeepSilent);
  this->TableEdits->AddObserver(vtkCommand::ErrorEvent, silence);
  this->SetEdits(this->TableEdits);
}

vtkPVNURBSControlPointRepresentation::~vtkPVNURBSControlPointRepresentation() = default;

void vtkPVNURBSControlPointRepresentation::SetModel(vtkDataObject* model)
{
  this->CancelInteraction();
  this->TableEdits->RemoveAllInputs();
  if (model)
  {
    this->TableEdits->SetInputDataObject(model);
  }
  this->ApplyRows();
}

void vtkPVNURBSControlPointRepresentation::AddMove(
  double block, double point, double dx, double dy, double dz)
{
  this->Given->Moves.push_back({ block, point, dx, dy, dz });
}

void vtkPVNURBSControlPointRepresentation::AddPosition(
  double block, double point, double x, double y, double z)
{
  this->Given->Positions.push_back({ block, point, x, y, z });
}

void vtkPVNURBSControlPointRepresentation::AddWeight(double block, double point, double weight)
{
  this->Given->Weights.push_back({ block, point, weight });
}

void vtkPVNURBSControlPointRepresentation::RemoveAllMoves()
{
  this->Given->Moves.clear();
}

void vtkPVNURBSControlPointRepresentation::RemoveAllPositions()
{
  this->Given->Positions.clear();
}

void vtkPVNURBSControlPointRepresentation::RemoveAllWeights()
{
  this->Given->Weights.clear();
}

void vtkPVNURBSControlPointRepresentation::ApplyTables()
{
  if (this->InteractionState != Dragging && !(*this->Given == *this->Rows))
  {
    *this->Rows = *this->Given;
    this->ApplyRows();
  }
}

void vtkPVNURBSControlPointRepresentation::SetMoveCoincident(bool together)
{
  if (this->TableEdits->GetMoveCoincident() != together)
  {
    this->TableEdits->SetMoveCoincident(together);
    this->ApplyRows();
  }
}

void vtkPVNURBSControlPointRepresentation::SetCoincidenceTolerance(double tolerance)
{
  if (this->TableEdits->GetCoincidenceTolerance() != tolerance)
  {
    this->TableEdits->SetCoincidenceTolerance(tolerance);
    this->ApplyRows();
  }
}

void vtkPVNURBSControlPointRepresentation::ApplyRows()
{
  while (this->TableEdits->Undo())
  {}
  if (this->TableEdits->GetNumberOfInputConnections(0) > 0)
  {
    this->TableEdits->BeginGroup();
    this->Rows->Apply(this->TableEdits);
    this->TableEdits->EndGroup();
  }
  this->Modified();
}

// Of the selected control points that coincide one is moved, the others follow it.
void vtkPVNURBSControlPointRepresentation::MoveRows(vtkNURBSEditTables& tables)
{
  std::set<std::pair<unsigned int, vtkIdType>> moved;
  vtkNew<vtkIdTypeArray> together;
  for (vtkIdType n = 0; n < this->GetNumberOfSelectedControlPoints(); ++n)
  {
    const unsigned int block = this->GetSelectedBlock(n);
    const vtkIdType point = this->GetSelectedControlPoint(n);
    if (moved.count({ block, point }) > 0)
    {
      continue;
    }
    this->TableEdits->GetCoincidentControlPoints(block, point, together);
    tables.Move(block, together, point, this->Displacement);
    for (vtkIdType other = 0; other < together->GetNumberOfValues(); ++other)
    {
      moved.insert({ block, together->GetValue(other) });
    }
  }
}

vtkDoubleArray* vtkPVNURBSControlPointRepresentation::GetMoves()
{
  vtkNURBSEditTables tables = *this->Rows;
  const double* d = this->Displacement;
  if (this->InteractionState == Dragging && (d[0] != 0.0 || d[1] != 0.0 || d[2] != 0.0))
  {
    this->MoveRows(tables);
  }
  CopyRows(tables.Moves, this->MoveArray);
  return this->MoveArray;
}

vtkDoubleArray* vtkPVNURBSControlPointRepresentation::GetWeights()
{
  CopyRows(this->Rows->Weights, this->WeightArray);
  return this->WeightArray;
}

bool vtkPVNURBSControlPointRepresentation::ScaleSelectedWeights(double factor)
{
  if (!this->Superclass::ScaleSelectedWeights(factor))
  {
    return false;
  }
  std::set<std::pair<unsigned int, vtkIdType>> weighed;
  vtkNew<vtkIdTypeArray> together;
  for (vtkIdType n = 0; n < this->GetNumberOfSelectedControlPoints(); ++n)
  {
    const unsigned int block = this->GetSelectedBlock(n);
    const vtkIdType point = this->GetSelectedControlPoint(n);
    if (weighed.count({ block, point }) == 0)
    {
      this->Rows->SetWeight(
        block, point, this->TableEdits->GetBlockControlPointWeight(block, point));
      this->TableEdits->GetCoincidentControlPoints(block, point, together);
      for (vtkIdType other = 0; other < together->GetNumberOfValues(); ++other)
      {
        weighed.insert({ block, together->GetValue(other) });
      }
    }
  }
  this->ApplyRows();
  return true;
}

void vtkPVNURBSControlPointRepresentation::EndWidgetInteraction(double position[2])
{
  const bool wasDragging = this->InteractionState == Dragging;
  this->Superclass::EndWidgetInteraction(position);
  const double* d = this->Displacement;
  if (wasDragging && (d[0] != 0.0 || d[1] != 0.0 || d[2] != 0.0))
  {
    this->MoveRows(*this->Rows);
    this->ApplyRows();
  }
}

void vtkPVNURBSControlPointRepresentation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Moves: " << this->Rows->Moves.size() << "\n";
  os << indent << "Positions: " << this->Rows->Positions.size() << "\n";
  os << indent << "Weights: " << this->Rows->Weights.size() << "\n";
}
