// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSEditedModel.h"

#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkIdList.h"
#include "vtkNURBSModel.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStaticPointLocator.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace
{

constexpr vtkIdType MaxNamedCells = 4;

// A number as an array of that type gives it back.
double Stored(int type, double value)
{
  return type == VTK_FLOAT ? static_cast<double>(static_cast<float>(value)) : value;
}

vtkMTimeType TimeOf(vtkObject* object)
{
  return object ? object->GetMTime() : 0;
}

} // namespace

vtkNURBSEditedModel::vtkNURBSEditedModel() = default;
vtkNURBSEditedModel::~vtkNURBSEditedModel() = default;

void vtkNURBSEditedModel::SetInput(vtkUnstructuredGrid* grid)
{
  this->Input = grid;
}

vtkIdType vtkNURBSEditedModel::GetNumberOfPoints() const
{
  return this->Input->GetNumberOfPoints();
}

vtkDataArray* vtkNURBSEditedModel::InputWeights() const
{
  vtkDataArray* weights = this->Input->GetPointData()->GetArray(vtkNURBSModel::WeightsName());
  return weights && weights->GetNumberOfTuples() == this->GetNumberOfPoints() ? weights : nullptr;
}

nurbs::Vec3 vtkNURBSEditedModel::GetPlace(vtkIdType point) const
{
  nurbs::Vec3 place;
  this->Input->GetPoint(point, place.data());
  return place;
}

double vtkNURBSEditedModel::GetWeight(vtkIdType point) const
{
  vtkDataArray* weights = this->InputWeights();
  return weights ? weights->GetComponent(point, 0) : 1.0;
}

double vtkNURBSEditedModel::GetDiagonal() const
{
  double b[6];
  this->Input->GetPoints()->GetBounds(b);
  return nurbs::Vec3(b[1] - b[0], b[3] - b[2], b[5] - b[4]).norm();
}

void vtkNURBSEditedModel::FindCoincident(
  vtkIdType point, double tolerance, std::vector<vtkIdType>& points)
{
  vtkPoints* places = this->Input->GetPoints();
  if (this->LocatorTime != places->GetMTime())
  {
    vtkNew<vtkPolyData> cloud; // Not the grid, whose time changes with its attributes.
    cloud->SetPoints(places);
    this->Locator->SetDataSet(cloud);
    this->Locator->BuildLocator();
    this->LocatorTime = places->GetMTime();
  }
  const nurbs::Vec3 place = this->GetPlace(point);
  this->Locator->FindPointsWithinRadius(tolerance, place.data(), this->Found);
  points.assign(this->Found->begin(), this->Found->end());
  if (std::find(points.begin(), points.end(), point) == points.end())
  {
    points.push_back(point);
  }
  std::sort(points.begin(), points.end());
}

std::string vtkNURBSEditedModel::CheckPlace(const nurbs::Vec3& place) const
{
  const int type = this->Input->GetPoints()->GetDataType();
  for (int c = 0; c < 3; ++c)
  {
    if (!std::isfinite(Stored(type, place[c])))
    {
      return "its place would be (" + std::to_string(place[0]) + ", " + std::to_string(place[1]) +
        ", " + std::to_string(place[2]) + ")";
    }
  }
  return std::string();
}

std::string vtkNURBSEditedModel::CheckWeight(double weight) const
{
  vtkDataArray* weights = this->InputWeights();
  const double stored = Stored(weights ? weights->GetDataType() : VTK_DOUBLE, weight);
  if (stored > 0.0 && std::isfinite(stored))
  {
    return std::string();
  }
  return "its weight would be " + std::to_string(weight) + ", and must be positive and finite";
}

std::string vtkNURBSEditedModel::Describe(vtkIdType point) const
{
  std::string text = "control point " + std::to_string(point) + " (of ";
  vtkIdType users = 0;
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < this->Input->GetNumberOfCells(); ++cell)
  {
    this->Input->GetCellPoints(cell, ids);
    if (ids->IsId(point) < 0 || ++users > MaxNamedCells)
    {
      continue;
    }
    text += (users > 1 ? ", cell " : "cell ") + std::to_string(cell) + ", FaceId " +
      std::to_string(vtkNURBSModel::GetFaceId(this->Input, cell));
  }
  text += users == 0 ? "no cell" : "";
  text += users > MaxNamedCells ? " and " + std::to_string(users - MaxNamedCells) + " more" : "";
  return text + ")";
}

bool vtkNURBSEditedModel::IsCopyOutdated() const
{
  return (this->Points && this->PointsTime != TimeOf(this->Input->GetPoints())) ||
    (this->Weights && this->WeightsTime != TimeOf(this->InputWeights()));
}

void vtkNURBSEditedModel::CopyPoints()
{
  vtkPoints* places = this->Input->GetPoints();
  if (!this->Points || this->Points->GetDataType() != places->GetDataType())
  {
    this->Points = vtkSmartPointer<vtkPoints>::New();
    this->Points->SetDataType(places->GetDataType());
  }
  this->Points->DeepCopy(places);
  this->PointsTime = places->GetMTime();
}

void vtkNURBSEditedModel::CopyWeights()
{
  vtkDataArray* weights = this->InputWeights();
  const int type = weights ? weights->GetDataType() : VTK_DOUBLE;
  if (!this->Weights || this->Weights->GetDataType() != type)
  {
    this->Weights.TakeReference(vtkDataArray::CreateDataArray(type));
  }
  if (weights)
  {
    this->Weights->DeepCopy(weights);
  }
  else
  {
    this->Weights->SetNumberOfComponents(1);
    this->Weights->SetNumberOfTuples(this->GetNumberOfPoints());
    this->Weights->Fill(1.0);
  }
  this->Weights->SetName(vtkNURBSModel::WeightsName());
  this->WeightsTime = TimeOf(weights);
}

void vtkNURBSEditedModel::Write(vtkIdType point, const nurbs::ControlPointEdit& edit)
{
  const bool isPlace = edit.Kind != nurbs::ControlPointEdit::Place::Unchanged;
  if (isPlace && !this->Points)
  {
    this->CopyPoints();
  }
  if (edit.Weight > 0.0 && !this->Weights)
  {
    this->CopyWeights();
  }
  if (this->Points)
  {
    const nurbs::Vec3 place = edit.Apply(this->GetPlace(point));
    this->Points->SetPoint(point, place.data());
  }
  if (this->Weights)
  {
    this->Weights->SetComponent(point, 0, edit.Weight > 0.0 ? edit.Weight : this->GetWeight(point));
  }
}

std::vector<vtkIdType> vtkNURBSEditedModel::Fill(vtkUnstructuredGrid* output,
  const nurbs::EditHistory& history, std::int64_t block, const std::vector<vtkIdType>& touched)
{
  std::vector<vtkIdType> changed = touched;
  if (this->IsCopyOutdated())
  {
    changed.clear();
    if (this->Points)
    {
      this->CopyPoints();
    }
    if (this->Weights)
    {
      this->CopyWeights();
    }
    for (const nurbs::EditHistory::Change& edit : history.All())
    {
      if (edit.first.Block == block)
      {
        changed.push_back(edit.first.Point);
      }
    }
  }
  std::vector<vtkIdType> missing;
  for (const vtkIdType point : changed)
  {
    if (point < this->GetNumberOfPoints())
    {
      this->Write(point, history.Find({ block, point }));
    }
    else if (!history.Find({ block, point }).IsNone())
    {
      missing.push_back(point);
    }
  }
  output->ShallowCopy(this->Input);
  if (this->Points)
  {
    if (!changed.empty())
    {
      this->Points->GetData()->Modified();
      this->Points->Modified();
    }
    output->SetPoints(this->Points);
  }
  if (this->Weights)
  {
    if (!changed.empty())
    {
      this->Weights->Modified();
    }
    output->GetPointData()->AddArray(this->Weights);
  }
  return missing;
}
