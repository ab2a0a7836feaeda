// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVNURBSLatticeRepresentation.h"

#include "ModelBuilder.h"
#include "vtkNURBSModel.h"

#include "vtkCellArray.h"
#include "vtkCellType.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkStructuredGrid.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <iterator>
#include <map>

vtkStandardNewMacro(vtkPVNURBSLatticeRepresentation);

namespace
{

// Where the lattice's points are without the table; null if that can't be said.
vtkSmartPointer<vtkPoints> RestOf(vtkStructuredGrid* lattice, vtkPointSet* places)
{
  vtkDataArray* displacement = lattice->GetPointData()->GetVectors();
  const vtkIdType size = lattice->GetNumberOfPoints();
  if (places ? places->GetNumberOfPoints() != size : !displacement)
  {
    return nullptr;
  }
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(size);
  for (vtkIdType p = 0; p < size; ++p)
  {
    double place[3], moved[3] = { 0.0, 0.0, 0.0 };
    (places ? places : lattice)->GetPoint(p, place);
    if (!places)
    {
      displacement->GetTuple(p, moved);
    }
    points->SetPoint(p, place[0] - moved[0], place[1] - moved[1], place[2] - moved[2]);
  }
  return points;
}

// A lattice as a model: a bilinear net through every layer along z, and through every one along y,
// so that the nets' lines are the lattice's. Nets share its points.
vtkSmartPointer<vtkUnstructuredGrid> MakeModel(vtkPoints* points, const int count[3])
{
  std::vector<std::vector<std::int64_t>> nets;
  nurbs::ModelBuilder builder;
  const auto layers = [&](int v, int across) {
    const std::int64_t step[3] = { 1, count[0], std::int64_t(count[0]) * count[1] };
    std::vector<double> knots[2];
    for (int dir = 0; dir < 2; ++dir)
    {
      const int n = count[dir == 0 ? 0 : v];
      knots[dir] = { 0.0 };
      for (int k = 0; k < n; ++k)
      {
        knots[dir].push_back(k);
      }
      knots[dir].push_back(n - 1.0);
    }
    for (int layer = 0; layer < count[across]; ++layer)
    {
      std::vector<std::int64_t> ids;
      for (int j = 0; j < count[v]; ++j)
      {
        for (int i = 0; i < count[0]; ++i)
        {
          ids.push_back(i + j * step[v] + layer * step[across]);
        }
      }
      nurbs::SurfaceView net;
      net.Count[0] = count[0];
      net.Count[1] = count[v];
      net.Knots[0] = knots[0];
      net.Knots[1] = knots[1];
      net.Points = vtkDoubleArray::SafeDownCast(points->GetData())->GetPointer(0);
      net.Ids = ids.data();
      builder.BeginFace(net, nurbs::FaceAttributes());
      nets.push_back(std::move(ids));
    }
  };
  layers(1, 2);
  layers(2, 1);
  auto model = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNURBSModel::Store(builder, model);
  vtkNew<vtkCellArray> cells;
  for (const std::vector<std::int64_t>& net : nets)
  {
    cells->InsertNextCell(static_cast<int>(net.size()));
    for (const std::int64_t id : net)
    {
      cells->InsertCellPoint(id);
    }
  }
  model->GetPointData()->Initialize();
  model->SetPoints(points);
  model->SetCells(VTK_POLY_VERTEX, cells);
  return model;
}

} // namespace

vtkPVNURBSLatticeRepresentation::vtkPVNURBSLatticeRepresentation()
{
  this->SetMoveCoincident(false);
}

vtkPVNURBSLatticeRepresentation::~vtkPVNURBSLatticeRepresentation() = default;

void vtkPVNURBSLatticeRepresentation::SetLattice(vtkStructuredGrid* lattice, vtkPointSet* places)
{
  const auto points =
    lattice && lattice->GetNumberOfPoints() > 0 ? RestOf(lattice, places) : nullptr;
  std::fill_n(this->Count, 3, 0);
  if (points)
  {
    lattice->GetDimensions(this->Count);
  }
  this->SetModel(points ? MakeModel(points, this->Count).Get() : nullptr);
  this->ApplyTables();
}

void vtkPVNURBSLatticeRepresentation::AddLatticeMove(
  double i, double j, double k, double dx, double dy, double dz)
{
  this->LatticeRows.push_back({ i, j, k, dx, dy, dz });
}

void vtkPVNURBSLatticeRepresentation::RemoveAllLatticeMoves()
{
  this->LatticeRows.clear();
}

bool vtkPVNURBSLatticeRepresentation::HasPoint(const Row& row) const
{
  bool has = true;
  for (int a = 0; a < 3; ++a)
  {
    has = has && row[a] >= 0.0 && row[a] < this->Count[a];
  }
  return has;
}

void vtkPVNURBSLatticeRepresentation::ApplyTables()
{
  std::map<vtkIdType, const Row*> last;
  std::vector<vtkIdType> order;
  for (const Row& row : this->LatticeRows)
  {
    if (this->HasPoint(row))
    {
      const int at[3] = { int(row[0]), int(row[1]), int(row[2]) };
      const vtkIdType id = at[0] + vtkIdType(this->Count[0]) * (at[1] + this->Count[1] * at[2]);
      if (last.count(id) == 0)
      {
        order.push_back(id);
      }
      last[id] = &row;
    }
  }
  this->RemoveAllMoves();
  for (const vtkIdType id : order)
  {
    const Row& row = *last[id];
    this->AddMove(0.0, double(id), row[3], row[4], row[5]);
  }
  this->Superclass::ApplyTables();
}

vtkDoubleArray* vtkPVNURBSLatticeRepresentation::GetLatticeMoves()
{
  std::vector<Row> rows;
  vtkDoubleArray* moves = this->GetMoves();
  for (vtkIdType n = 0; n < moves->GetNumberOfTuples(); ++n)
  {
    double move[5];
    moves->GetTypedTuple(n, move);
    const int id = static_cast<int>(move[1]);
    const int j = id / this->Count[0];
    rows.push_back({ double(id % this->Count[0]), double(j % this->Count[1]),
      double(j / this->Count[1]), move[2], move[3], move[4] });
  }
  std::copy_if(this->LatticeRows.begin(), this->LatticeRows.end(), std::back_inserter(rows),
    [this](const Row& row) { return !this->HasPoint(row); });
  this->LatticeArray->SetNumberOfComponents(6);
  this->LatticeArray->SetNumberOfTuples(static_cast<vtkIdType>(rows.size()));
  for (std::size_t n = 0; n < rows.size(); ++n)
  {
    this->LatticeArray->SetTypedTuple(static_cast<vtkIdType>(n), rows[n].data());
  }
  return this->LatticeArray;
}

void vtkPVNURBSLatticeRepresentation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Count: " << this->Count[0] << " " << this->Count[1] << " " << this->Count[2]
     << "\n";
  os << indent << "LatticeMoves: " << this->LatticeRows.size() << "\n";
}
