// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSDrawnModel.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkFieldData.h"
#include "vtkIntArray.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSParallel.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"

#include <algorithm>
#include <cstring>

namespace
{

using Stamps = std::vector<std::pair<const void*, vtkMTimeType>>;

void Append(Stamps& stamps, vtkObject* object)
{
  stamps.emplace_back(object, object ? object->GetMTime() : 0);
}

constexpr const char* OriginName = "DrawnOrigin";

// Identity and age of the arrays that describe surfaces, or those of loops and edges.
Stamps StructureOf(vtkUnstructuredGrid* grid, bool trims)
{
  Stamps stamps;
  Append(stamps, trims ? nullptr : grid->GetCells());
  for (int i = 0; i < grid->GetCellData()->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = grid->GetCellData()->GetAbstractArray(i);
    if (vtkNURBSModel::IsStructureArray(array->GetName()) &&
      vtkNURBSModel::IsTrimArray(array->GetName()) == trims)
    {
      Append(stamps, array);
    }
  }
  for (int i = 0; i < grid->GetFieldData()->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = grid->GetFieldData()->GetAbstractArray(i);
    const char* name = array->GetName();
    if (vtkNURBSModel::IsTrimArray(name) == trims && !(name && !strcmp(name, OriginName)))
    {
      Append(stamps, array);
    }
  }
  return stamps;
}

Stamps PointsOf(vtkUnstructuredGrid* grid)
{
  Stamps stamps;
  Append(stamps, grid->GetPoints() ? grid->GetPoints()->GetData() : nullptr);
  Append(stamps, grid->GetPointData()->GetRationalWeights());
  return stamps;
}

// The models of the input; otherData: whether it has data sets that are none.
std::vector<vtkNURBSDrawnModel::Leaf> LeavesOf(vtkDataObject* input, bool& otherData)
{
  otherData = false;
  std::vector<vtkNURBSDrawnModel::Leaf> leaves;
  const auto add = [&](vtkDataObject* object, unsigned int index) {
    auto* grid = vtkUnstructuredGrid::SafeDownCast(object);
    if (grid && vtkNURBSModel::IsModel(grid))
    {
      vtkNURBSDrawnModel::Leaf leaf;
      leaf.Grid = grid;
      leaf.FlatIndex = index;
      if (vtkDataArray* origin = grid->GetFieldData()->GetArray(OriginName))
      {
        leaf.FlatIndex = static_cast<unsigned int>(origin->GetComponent(0, 0));
        leaf.Process = static_cast<int>(origin->GetComponent(0, 1));
      }
      leaf.Surfaces = StructureOf(grid, false);
      leaf.Trims = StructureOf(grid, true);
      leaf.Points = PointsOf(grid);
      leaves.push_back(std::move(leaf));
    }
    else
    {
      otherData = otherData || (object && object->GetNumberOfElements(vtkDataObject::POINT) > 0);
    }
  };
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(input))
  {
    auto it = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
    for (it->InitTraversal(); !it->IsDoneWithTraversal(); it->GoToNextItem())
    {
      add(it->GetCurrentDataObject(), it->GetCurrentFlatIndex());
    }
  }
  else
  {
    add(input, 0);
  }
  return leaves;
}

// The part of the domain that a face's loops reach, as shares.
nurbs::Box2 UsedPart(const nurbs::Model& model, const nurbs::Face& face)
{
  const nurbs::Box2 box = nurbs::LoopsBox(model, face);
  const nurbs::Interval u = face.Geometry.Domain(0), v = face.Geometry.Domain(1);
  const auto share = [&](const nurbs::Vec2& p) {
    return nurbs::Vec2((p[0] - u.Min) / u.Length(), (p[1] - v.Min) / v.Length());
  };
  return box.isEmpty() ? box : nurbs::Box2(share(box.min()), share(box.max()));
}

// Checks what drawing needs: edges' curves are not drawn, and loops that were sound before points
// moved are sound.
std::shared_ptr<const vtkNURBSModelView> ViewOf(
  vtkUnstructuredGrid* grid, const vtkNURBSModelView* before)
{
  nurbs::AssembleOptions options;
  options.CheckEdges = false;
  options.CheckLoops = !before || !before->DescribeFaceErrors().empty();
  return std::make_shared<const vtkNURBSModelView>(grid, options);
}

} // namespace

void vtkNURBSDrawnModel::SetOrigin(vtkUnstructuredGrid* grid, unsigned int flatIndex, int process)
{
  vtkNew<vtkIntArray> origin;
  origin->SetName(OriginName);
  origin->SetNumberOfComponents(2);
  origin->InsertNextTuple2(flatIndex, process);
  grid->GetFieldData()->AddArray(origin);
}

vtkNURBSDrawnModel::Change vtkNURBSDrawnModel::Update(vtkDataObject* input)
{
  std::vector<Leaf> leaves = LeavesOf(input, this->OtherData);
  this->Moved.clear();
  this->Warnings.clear();
  bool sameSurfaces = leaves.size() == this->Leaves.size(), samePoints = true, sameTrims = true;
  for (std::size_t i = 0; i < leaves.size() && sameSurfaces; ++i)
  {
    sameSurfaces = leaves[i].Surfaces == this->Leaves[i].Surfaces &&
      leaves[i].FlatIndex == this->Leaves[i].FlatIndex &&
      leaves[i].Process == this->Leaves[i].Process;
    samePoints = samePoints && leaves[i].Points == this->Leaves[i].Points;
    sameTrims = sameTrims && leaves[i].Trims == this->Leaves[i].Trims;
  }
  Change change;
  if (sameSurfaces && samePoints && sameTrims)
  {
    for (std::size_t i = 0; i < leaves.size(); ++i)
    {
      this->Leaves[i].Grid = leaves[i].Grid; // its attributes may be new
    }
    return change;
  }
  const vtkNURBSParallelScope parallel;
  for (std::size_t i = 0; i < leaves.size(); ++i)
  {
    Leaf& leaf = leaves[i];
    const Leaf* before = sameSurfaces ? &this->Leaves[i] : nullptr;
    leaf.View = before && leaf.Points == before->Points && leaf.Trims == before->Trims
      ? before->View
      : ViewOf(leaf.Grid, before && leaf.Trims == before->Trims ? before->View.get() : nullptr);
    leaf.First =
      i == 0 ? 0 : leaves[i - 1].First + static_cast<int>(leaves[i - 1].Model().Faces.size());
  }
  int faces = 0;
  for (const Leaf& leaf : leaves)
  {
    faces += static_cast<int>(leaf.Model().Faces.size());
  }
  sameSurfaces = sameSurfaces && faces == this->Table.Size();
  // A face that has lost its surface, or has one now, changes more than points.
  for (std::size_t i = 0; i < leaves.size() && sameSurfaces; ++i)
  {
    for (std::size_t f = 0; f < leaves[i].Model().Faces.size() && sameSurfaces; ++f)
    {
      sameSurfaces = (leaves[i].Model().Faces[f].Geometry.Count[0] > 0) ==
        this->Table[leaves[i].First + static_cast<int>(f)].IsDrawable();
    }
  }
  this->Leaves = std::move(leaves);
  change.Surfaces = !sameSurfaces;
  change.Points = sameSurfaces && !samePoints;
  change.Trims = sameSurfaces && !sameTrims;
  try
  {
    if (change.Surfaces)
    {
      this->Rebuild();
    }
    if (change.Points)
    {
      this->Move();
    }
    if (change.Trims)
    {
      this->RebuildTrims();
    }
  }
  catch (const nurbs::Error&)
  {
    this->Table = nurbs::SurfaceTable();
    throw;
  }
  return change;
}

void vtkNURBSDrawnModel::Rebuild()
{
  this->Table = nurbs::SurfaceTable();
  this->Trims = nurbs::TrimTexels();
  this->MaxDegree = 1;
  for (const Leaf& leaf : this->Leaves)
  {
    const nurbs::Model& model = leaf.Model();
    for (const nurbs::Face& face : model.Faces)
    {
      if (face.Geometry.Count[0] > 0)
      {
        this->Table.Add(face.Geometry, UsedPart(model, face));
        this->MaxDegree =
          std::max({ this->MaxDegree, face.Geometry.Degree[0], face.Geometry.Degree[1] });
      }
      else
      {
        this->Table.AddNothing();
      }
    }
    const std::string errors = leaf.View->DescribeFaceErrors();
    this->Warnings += errors.empty() || this->Warnings.empty() ? errors : "\n" + errors;
    this->AddTrims(nurbs::TrimIndex(model, vtkNURBSParallelFor));
  }
  vtkNURBSParallelFor(0, this->Table.Size(), [this](std::int64_t first, std::int64_t last) {
    this->Table.Fill(static_cast<int>(first), static_cast<int>(last));
  });
}

void vtkNURBSDrawnModel::RebuildTrims()
{
  this->Trims = nurbs::TrimTexels();
  for (const Leaf& leaf : this->Leaves)
  {
    const nurbs::Model& model = leaf.Model();
    vtkNURBSParallelFor(
      0, static_cast<std::int64_t>(model.Faces.size()), [&](std::int64_t first, std::int64_t last) {
        for (std::int64_t f = first; f < last; ++f)
        {
          if (model.Faces[f].Geometry.Count[0] > 0)
          {
            this->Table.Use(leaf.First + static_cast<int>(f), UsedPart(model, model.Faces[f]));
          }
        }
      });
    this->AddTrims(nurbs::TrimIndex(model, vtkNURBSParallelFor));
  }
}

void vtkNURBSDrawnModel::AddTrims(const nurbs::TrimIndex& index)
{
  nurbs::TrimTexels& trims = this->Trims;
  for (std::int64_t f = 0; f < index.FaceCount(); ++f)
  {
    const nurbs::FaceTrim& face = index.Face(f);
    const bool whole = face.IsWhole();
    const std::size_t point = trims.Points.size(), record = trims.Records.size();
    trims.FaceStart.push_back(whole ? -1 : static_cast<std::int32_t>(record / 4));
    trims.PointStart.push_back(whole ? -1 : static_cast<std::int32_t>(point / 4));
    trims.Points.resize(point + 4 * face.PointTexelCount());
    trims.Records.resize(record + 4 * face.RecordTexelCount());
    face.WriteTexels(static_cast<std::int32_t>(point / 4), trims.Points.data() + point,
      trims.Records.data() + record);
  }
}

void vtkNURBSDrawnModel::Move()
{
  std::vector<char> moved(this->Table.Size(), 0);
  for (const Leaf& leaf : this->Leaves)
  {
    const nurbs::Model& model = leaf.Model();
    vtkNURBSParallelFor(
      0, static_cast<std::int64_t>(model.Faces.size()), [&](std::int64_t first, std::int64_t last) {
        for (std::int64_t f = first; f < last; ++f)
        {
          const int index = leaf.First + static_cast<int>(f);
          if (this->Table[index].IsDrawable())
          {
            moved[index] = this->Table.Move(index, model.Faces[f].Geometry);
          }
        }
      });
  }
  for (int i = 0; i < this->Table.Size(); ++i)
  {
    if (moved[i])
    {
      this->Moved.push_back(i);
    }
  }
}

nurbs::Box3 vtkNURBSDrawnModel::GetBounds(const std::function<bool(int)>& isHidden) const
{
  nurbs::Box3 box;
  for (int i = 0; i < this->Table.Size(); ++i)
  {
    if (!isHidden || !isHidden(i))
    {
      box.extend(this->Table[i].Bounds);
    }
  }
  return box;
}
