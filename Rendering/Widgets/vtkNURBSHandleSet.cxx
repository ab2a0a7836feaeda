// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSHandleSet.h"

#include "Surface.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"

#include "vtkCellArray.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkIdList.h"
#include "vtkPoints.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <numeric>

vtkNURBSHandleSet::vtkNURBSHandleSet()
{
  this->Gathered->SetDataTypeToDouble();
}

vtkNURBSHandleSet::~vtkNURBSHandleSet() = default;

void vtkNURBSHandleSet::Clear()
{
  this->Models.clear();
  this->Handles.clear();
  this->Points = nullptr;
}

std::vector<vtkNURBSHandleSet::Model> vtkNURBSHandleSet::FindModels(vtkDataObject* data) const
{
  std::vector<Model> models;
  const auto add = [&](vtkDataObject* leaf, unsigned int block) {
    auto* grid = vtkUnstructuredGrid::SafeDownCast(leaf);
    if (!grid || grid->GetNumberOfCells() == 0 || !vtkNURBSModel::IsModel(grid))
    {
      return;
    }
    Model model;
    model.Grid = grid;
    model.Cells = grid->GetCells();
    model.CellsTime = grid->GetCells()->GetMTime();
    model.Block = block;
    model.PointCount = grid->GetNumberOfPoints();
    if (!models.empty())
    {
      const Model& last = models.back();
      model.FirstPoint = last.FirstPoint + last.PointCount;
      model.FirstFace = last.FirstFace + std::size_t(last.Grid->GetNumberOfCells());
    }
    models.push_back(std::move(model));
  };
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(data))
  {
    vtkSmartPointer<vtkCompositeDataIterator> at;
    at.TakeReference(composite->NewIterator());
    for (at->InitTraversal(); !at->IsDoneWithTraversal(); at->GoToNextItem())
    {
      add(at->GetCurrentDataObject(), at->GetCurrentFlatIndex());
    }
  }
  else
  {
    add(data, 0);
  }
  return models;
}

bool vtkNURBSHandleSet::Update(vtkDataObject* data)
{
  std::vector<Model> models = this->FindModels(data);
  bool same = models.size() == this->Models.size();
  for (std::size_t k = 0; same && k < models.size(); ++k)
  {
    Model& now = models[k];
    Model& before = this->Models[k];
    same = now.Block == before.Block && now.Cells == before.Cells &&
      now.CellsTime == before.CellsTime && now.PointCount == before.PointCount;
    now.RowLengths.swap(before.RowLengths);
  }
  this->Models = std::move(models);
  if (!same)
  {
    for (Model& model : this->Models)
    {
      model.RowLengths.clear();
      const auto view = vtkNURBSModel::View(model.Grid);
      for (const nurbs::Face& face : view->GetModel().Faces)
      {
        model.RowLengths.push_back(face.Geometry.Size() > 0 ? face.Geometry.Count[0] : 0);
      }
    }
    this->FindHandles();
  }
  this->GatherPoints();
  return !same;
}

void vtkNURBSHandleSet::FindHandles()
{
  this->Handles.clear();
  vtkNew<vtkIdList> ids;
  for (const Model& model : this->Models)
  {
    std::vector<bool> used(std::size_t(model.PointCount), false);
    for (vtkIdType cell = 0; cell < model.Cells->GetNumberOfCells(); ++cell)
    {
      model.Cells->GetCellAtId(cell, ids);
      for (const vtkIdType id : *ids)
      {
        if (id >= 0 && id < model.PointCount)
        {
          used[std::size_t(id)] = true;
        }
      }
    }
    for (vtkIdType id = 0; id < model.PointCount; ++id)
    {
      if (used[std::size_t(id)])
      {
        this->Handles.push_back(model.FirstPoint + id);
      }
    }
  }
}

void vtkNURBSHandleSet::GatherPoints()
{
  if (this->Models.size() == 1)
  {
    this->Points = this->Models.front().Grid->GetPoints();
    return;
  }
  const Model* last = this->Models.empty() ? nullptr : &this->Models.back();
  this->Gathered->SetNumberOfPoints(last ? last->FirstPoint + last->PointCount : 0);
  for (const Model& model : this->Models)
  {
    this->Gathered->InsertPoints(model.FirstPoint, model.PointCount, 0, model.Grid->GetPoints());
  }
  this->Gathered->Modified();
  this->Points = this->Gathered;
}

const double* vtkNURBSHandleSet::GetCoordinates()
{
  if (!this->Points)
  {
    return nullptr;
  }
  if (auto* doubles = vtkDoubleArray::SafeDownCast(this->Points->GetData()))
  {
    return doubles->GetPointer(0);
  }
  if (this->ConvertedTime != this->Points->GetMTime())
  {
    this->ConvertedTime = this->Points->GetMTime();
    this->Converted.resize(3 * std::size_t(this->Points->GetNumberOfPoints()));
    for (vtkIdType k = 0; k < this->Points->GetNumberOfPoints(); ++k)
    {
      this->Points->GetPoint(k, this->Converted.data() + 3 * k);
    }
  }
  return this->Converted.data();
}

const vtkNURBSHandleSet::Model& vtkNURBSHandleSet::ModelOf(std::int64_t handle) const
{
  std::size_t k = this->Models.size() - 1;
  while (k > 0 && handle < this->Models[k].FirstPoint)
  {
    --k;
  }
  return this->Models[k];
}

unsigned int vtkNURBSHandleSet::GetBlock(std::int64_t handle) const
{
  return this->ModelOf(handle).Block;
}

vtkIdType vtkNURBSHandleSet::GetPointId(std::int64_t handle) const
{
  return handle - this->ModelOf(handle).FirstPoint;
}

std::int64_t vtkNURBSHandleSet::GetHandle(unsigned int block, vtkIdType point) const
{
  for (const Model& model : this->Models)
  {
    if (model.Block == block)
    {
      return point >= 0 && point < model.PointCount ? model.FirstPoint + point : -1;
    }
  }
  return -1;
}

std::vector<bool> vtkNURBSHandleSet::FindFaces(const std::vector<std::int64_t>& handles) const
{
  std::vector<bool> marked(
    this->Points ? std::size_t(this->Points->GetNumberOfPoints()) : 0, false);
  for (const std::int64_t handle : handles)
  {
    marked[std::size_t(handle)] = true;
  }
  std::vector<bool> faces;
  vtkNew<vtkIdList> ids;
  for (const Model& model : this->Models)
  {
    for (vtkIdType cell = 0; cell < model.Cells->GetNumberOfCells(); ++cell)
    {
      model.Cells->GetCellAtId(cell, ids);
      faces.push_back(std::any_of(ids->begin(), ids->end(), [&](vtkIdType id) {
        return id >= 0 && id < model.PointCount && marked[std::size_t(model.FirstPoint + id)];
      }));
    }
  }
  return faces;
}

vtkSmartPointer<vtkCellArray> vtkNURBSHandleSet::MakeNet(const std::vector<bool>& wanted) const
{
  auto lines = vtkSmartPointer<vtkCellArray>::New();
  vtkNew<vtkIdList> ids;
  std::size_t face = 0;
  for (const Model& model : this->Models)
  {
    for (std::size_t cell = 0; cell < model.RowLengths.size(); ++cell, ++face)
    {
      const vtkIdType row = model.RowLengths[cell];
      if (row == 0 || (!wanted.empty() && !wanted[face]))
      {
        continue;
      }
      model.Cells->GetCellAtId(vtkIdType(cell), ids);
      const vtkIdType rows = ids->GetNumberOfIds() / row;
      for (vtkIdType j = 0; j < rows; ++j)
      {
        lines->InsertNextCell(int(row));
        for (vtkIdType i = 0; i < row; ++i)
        {
          lines->InsertCellPoint(model.FirstPoint + ids->GetId(i + j * row));
        }
      }
      for (vtkIdType i = 0; i < row; ++i)
      {
        lines->InsertNextCell(int(rows));
        for (vtkIdType j = 0; j < rows; ++j)
        {
          lines->InsertCellPoint(model.FirstPoint + ids->GetId(i + j * row));
        }
      }
    }
  }
  return lines;
}

nurbs::Vec3 vtkNURBSHandleSet::GetNormal(std::int64_t handle) const
{
  const Model& model = this->ModelOf(handle);
  const vtkIdType point = handle - model.FirstPoint;
  const auto view = vtkNURBSModel::View(model.Grid);
  for (const nurbs::Face& face : view->GetModel().Faces)
  {
    const nurbs::SurfaceView& surface = face.Geometry;
    for (std::int64_t k = 0; k < surface.Size(); ++k)
    {
      if (surface.Id(k) != point)
      {
        continue;
      }
      const int index[2] = { int(k % surface.Count[0]), int(k / surface.Count[0]) };
      double greville[2];
      for (int d = 0; d < 2; ++d)
      {
        const double* first = surface.Knots[d].begin() + index[d] + 1;
        greville[d] = surface.Domain(d).Clamp(
          std::accumulate(first, first + surface.Degree[d], 0.0) / surface.Degree[d]);
      }
      const nurbs::Vec3 normal = nurbs::Normal(surface, greville[0], greville[1]);
      return face.Reversed ? nurbs::Vec3(-normal) : normal;
    }
  }
  return nurbs::Vec3::Zero();
}
