// SPDX-License-Identifier: BSD-3-Clause
// What a filter keeps of an output that was made of all processes' faces.
#include "PieceBuilder.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelPool.h"
#include "vtkNURBSModelView.h"
#include "vtkNURBSPieceTree.h"
#include "vtkNURBSPieces.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <numeric>

namespace
{

/// The cells of one grid's faces among the cells of an output; false: all cells are.
bool FindCells(
  vtkDataSetAttributes* cells, int rank, vtkIdType first, vtkIdType last, vtkIdTypeArray* found)
{
  vtkDataArray* owners = cells->GetArray(vtkNURBSPieceTree::OwnerName());
  vtkDataArray* numbers = cells->GetArray(vtkNURBSPieceTree::CellName());
  const vtkIdType count = owners && numbers ? owners->GetNumberOfTuples() : 0;
  for (vtkIdType k = 0; k < count; ++k)
  {
    const auto number = vtkIdType(numbers->GetTuple1(k));
    if (int(owners->GetTuple1(k)) == rank && number >= first && number < last)
    {
      found->InsertNextValue(k);
    }
  }
  return found->GetNumberOfValues() < count;
}

/// Copies the tuples of all arrays.
void CopyTuples(vtkDataSetAttributes* from, vtkIdTypeArray* tuples, vtkDataSetAttributes* to)
{
  vtkNew<vtkIdList> ids;
  ids->SetNumberOfIds(tuples->GetNumberOfValues());
  std::copy_n(tuples->GetPointer(0), tuples->GetNumberOfValues(), ids->GetPointer(0));
  to->CopyAllOn();
  to->CopyAllocate(from, ids->GetNumberOfIds());
  vtkNew<vtkIdList> places;
  places->SetNumberOfIds(ids->GetNumberOfIds());
  std::iota(places->begin(), places->end(), 0);
  to->CopyData(from, ids, places);
}

/// Of a kind of cells of a mesh, those among `wanted`, which are numbers of cells of all kinds;
/// `before`: cells of the kinds before. Points that are used get a number.
vtkSmartPointer<vtkCellArray> TakeCells(vtkCellArray* cells, vtkIdType before,
  vtkIdTypeArray* wanted, vtkIdType& next, std::vector<vtkIdType>& numbers, vtkIdTypeArray* points)
{
  auto taken = vtkSmartPointer<vtkCellArray>::New();
  vtkNew<vtkIdList> corners;
  const vtkIdType past = before + cells->GetNumberOfCells();
  for (; next < wanted->GetNumberOfValues() && wanted->GetValue(next) < past; ++next)
  {
    cells->GetCellAtId(wanted->GetValue(next) - before, corners);
    for (vtkIdType k = 0; k < corners->GetNumberOfIds(); ++k)
    {
      vtkIdType& number = numbers[corners->GetId(k)];
      if (number < 0)
      {
        number = points->InsertNextValue(corners->GetId(k));
      }
      corners->SetId(k, number);
    }
    taken->InsertNextCell(corners);
  }
  return taken;
}

} // namespace

void vtkNURBSPieces::CopyOwners(
  vtkUnstructuredGrid* grid, vtkIdTypeArray* faces, vtkDataSetAttributes* target)
{
  for (const char* name : { vtkNURBSPieceTree::OwnerName(), vtkNURBSPieceTree::CellName() })
  {
    if (vtkDataArray* from = grid->GetCellData()->GetArray(name))
    {
      vtkSmartPointer<vtkDataArray> to;
      to.TakeReference(from->NewInstance());
      to->SetName(name);
      to->SetNumberOfTuples(faces->GetNumberOfValues());
      for (vtkIdType k = 0; k < faces->GetNumberOfValues(); ++k)
      {
        to->SetTuple(k, faces->GetValue(k), from);
      }
      target->AddArray(to);
    }
  }
}

vtkSmartPointer<vtkDataObject> vtkNURBSPieces::KeepMesh(const Grid& grid, vtkPolyData* mesh) const
{
  auto kept = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkIdTypeArray> wanted;
  if (!FindCells(mesh->GetCellData(), this->Rank, grid.FirstCell,
        grid.FirstCell + grid.Data->GetNumberOfCells(), wanted))
  {
    kept->ShallowCopy(mesh);
    return kept;
  }
  std::vector<vtkIdType> numbers(mesh->GetNumberOfPoints(), -1);
  vtkNew<vtkIdTypeArray> used;
  vtkIdType next = 0;
  vtkIdType before = 0;
  const auto take = [&](vtkCellArray* cells) {
    auto taken = TakeCells(cells, before, wanted, next, numbers, used);
    before += cells->GetNumberOfCells();
    return taken;
  };
  kept->SetVerts(take(mesh->GetVerts()));
  kept->SetLines(take(mesh->GetLines()));
  kept->SetPolys(take(mesh->GetPolys()));
  kept->SetStrips(take(mesh->GetStrips()));
  vtkNew<vtkPoints> points;
  points->SetDataType(mesh->GetPoints() ? mesh->GetPoints()->GetDataType() : VTK_DOUBLE);
  points->SetNumberOfPoints(used->GetNumberOfValues());
  for (vtkIdType k = 0; k < used->GetNumberOfValues(); ++k)
  {
    points->SetPoint(k, mesh->GetPoint(used->GetValue(k)));
  }
  kept->SetPoints(points);
  CopyTuples(mesh->GetPointData(), used, kept->GetPointData());
  CopyTuples(mesh->GetCellData(), wanted, kept->GetCellData());
  kept->GetFieldData()->ShallowCopy(mesh->GetFieldData());
  return kept;
}

vtkSmartPointer<vtkDataObject> vtkNURBSPieces::KeepModel(
  const Grid& grid, vtkUnstructuredGrid* model) const
{
  auto kept = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkIdTypeArray> wanted;
  FindCells(model->GetCellData(), this->Rank, grid.FirstCell,
    grid.FirstCell + grid.Data->GetNumberOfCells(), wanted);
  const vtkNURBSModelView::Raw raw = vtkNURBSModelView::GetRaw(model);
  nurbs::PieceBuilder piece;
  piece.Begin(raw.Arrays, {}, {});
  for (vtkIdType k = 0; k < wanted->GetNumberOfValues(); ++k)
  {
    piece.AddFace(wanted->GetValue(k));
  }
  piece.Finish();
  piece.Model.LengthUnit = vtkNURBSModel::GetLengthUnit(model);
  vtkNURBSModel::Store(piece.Model, kept);
  vtkNURBSModel::SetGlobalIds(kept, piece.EdgeIds, piece.VertexIds);
  vtkNURBSModel::CopyFaceAttributes(model, wanted, kept->GetCellData());
  vtkNURBSModel::PassWithoutStructure(model->GetFieldData(), kept->GetFieldData());
  return kept;
}

// Attributes of the faces, which did not travel, and the numbers that edges have in the whole model.
void vtkNURBSPieces::FinishLeaf(const Grid& grid, vtkDataObject* kept) const
{
  vtkDataSetAttributes* cells = kept->GetAttributes(vtkDataObject::CELL);
  vtkDataArray* numbers = cells->GetArray(vtkNURBSPieceTree::CellName());
  if (numbers && cells->HasArray(vtkNURBSModel::ColorName()))
  {
    vtkNew<vtkIdTypeArray> faces;
    faces->SetNumberOfValues(numbers->GetNumberOfTuples());
    for (vtkIdType k = 0; k < numbers->GetNumberOfTuples(); ++k)
    {
      faces->SetValue(k, vtkIdType(numbers->GetTuple1(k)) - grid.FirstCell);
    }
    cells->RemoveArray(vtkNURBSModel::ColorName());
    cells->RemoveArray(vtkNURBSModel::NameName());
    vtkNURBSModel::CopyFaceAttributes(grid.Data, faces, cells);
  }
  cells->RemoveArray(vtkNURBSPieceTree::OwnerName());
  cells->RemoveArray(vtkNURBSPieceTree::CellName());
  const auto ids = this->EdgeIds.find(grid.Block);
  if (vtkDataArray* edges = cells->GetArray(vtkNURBSModel::EdgeIdName()))
  {
    vtkSmartPointer<vtkDataArray> global;
    global.TakeReference(edges->NewInstance());
    global->DeepCopy(edges);
    for (vtkIdType k = 0; k < edges->GetNumberOfTuples(); ++k)
    {
      const auto edge = vtkIdType(edges->GetTuple1(k));
      global->SetTuple1(k, edge < 0 ? -1.0 : double(ids->second.at(edge)));
    }
    cells->AddArray(global);
  }
  vtkNURBSModel::PassWithoutStructure(grid.Data->GetFieldData(), kept->GetFieldData());
}

vtkSmartPointer<vtkDataObject> vtkNURBSPieces::KeepLeaf(const Grid& grid, vtkDataObject* leaf) const
{
  vtkSmartPointer<vtkDataObject> kept;
  if (auto* mesh = vtkPolyData::SafeDownCast(leaf))
  {
    kept = this->KeepMesh(grid, mesh);
  }
  else if (auto* model = vtkUnstructuredGrid::SafeDownCast(leaf))
  {
    kept = this->KeepModel(grid, model);
  }
  if (kept)
  {
    this->FinishLeaf(grid, kept);
  }
  return kept;
}

void vtkNURBSPieces::Keep(vtkDataObject* output) const
{
  if (!this->Whole)
  {
    return;
  }
  std::map<unsigned int, vtkSmartPointer<vtkDataObject>> leaves;
  vtkNURBSPieceTree::Visit(output, [&](unsigned int block, unsigned int, vtkDataObject* leaf) {
    vtkSmartPointer<vtkDataObject> made;
    made.TakeReference(leaf->NewInstance());
    made->ShallowCopy(leaf);
    leaves[block] = made;
  });
  vtkNURBSModelPool::CopyTree(this->Input, output);
  for (const Grid& grid : this->Grids)
  {
    const auto found = leaves.find(grid.Block);
    vtkSmartPointer<vtkDataObject> kept =
      found == leaves.end() ? nullptr : this->KeepLeaf(grid, found->second);
    if (kept)
    {
      vtkNURBSPieceTree::Set(output, grid.Block, grid.Partition, kept);
    }
  }
}
