// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSControlNet.h"

#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

vtkStandardNewMacro(vtkNURBSControlNet);

vtkNURBSControlNet::vtkNURBSControlNet() = default;
vtkNURBSControlNet::~vtkNURBSControlNet() = default;

int vtkNURBSControlNet::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  return 1;
}

namespace
{

/// Cells of one kind and the face that each belongs to.
struct NetCells
{
  vtkNew<vtkCellArray> Cells;
  std::vector<vtkIdType> Faces;

  void Add(vtkIdType face, const std::vector<vtkIdType>& ids)
  {
    this->Cells->InsertNextCell(static_cast<vtkIdType>(ids.size()), ids.data());
    this->Faces.push_back(face);
  }
};

void AddPoints(const nurbs::SurfaceView& s, vtkIdType face, NetCells& cells)
{
  cells.Add(face, std::vector<vtkIdType>(s.Ids, s.Ids + s.Size()));
}

void AddLines(const nurbs::SurfaceView& s, vtkIdType face, NetCells& cells)
{
  const std::int64_t nu = s.Count[0], nv = s.Count[1];
  for (std::int64_t j = 0; j < nv; ++j)
  {
    cells.Add(face, std::vector<vtkIdType>(s.Ids + j * nu, s.Ids + (j + 1) * nu));
  }
  std::vector<vtkIdType> column(nv);
  for (std::int64_t i = 0; i < nu; ++i)
  {
    for (std::int64_t j = 0; j < nv; ++j)
    {
      column[j] = s.Ids[i + j * nu];
    }
    cells.Add(face, column);
  }
}

void AddQuads(const nurbs::SurfaceView& s, vtkIdType face, NetCells& cells)
{
  const std::int64_t nu = s.Count[0], nv = s.Count[1];
  for (std::int64_t j = 0; j + 1 < nv; ++j)
  {
    for (std::int64_t i = 0; i + 1 < nu; ++i)
    {
      const std::int64_t* id = s.Ids + i + j * nu;
      cells.Add(face, { id[0], id[1], id[1 + nu], id[nu] });
    }
  }
}

} // namespace

int vtkNURBSControlNet::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkUnstructuredGrid* input = vtkUnstructuredGrid::GetData(inputVector[0]);
  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  const auto view = vtkNURBSModel::View(input);
  const std::string skipped = view->DescribeFaceErrors();
  if (!skipped.empty())
  {
    vtkWarningMacro(<< skipped);
  }

  NetCells points, lines, quads;
  const std::vector<nurbs::Face>& faces = view->GetModel().Faces;
  for (vtkIdType i = 0; i < static_cast<vtkIdType>(faces.size()); ++i)
  {
    const nurbs::SurfaceView& surface = faces[i].Geometry;
    if (surface.Size() == 0)
    {
      continue;
    }
    if (this->GeneratePoints)
    {
      AddPoints(surface, i, points);
    }
    if (this->GenerateLines)
    {
      AddLines(surface, i, lines);
    }
    if (this->GenerateQuads)
    {
      AddQuads(surface, i, quads);
    }
  }

  output->SetPoints(input->GetPoints());
  output->GetPointData()->ShallowCopy(input->GetPointData());
  output->SetVerts(points.Cells);
  output->SetLines(lines.Cells);
  output->SetPolys(quads.Cells);
  vtkNew<vtkIdTypeArray> origin; // Of all cells, in the order of vtkPolyData.
  for (const NetCells* kind : { &points, &lines, &quads })
  {
    for (const vtkIdType face : kind->Faces)
    {
      origin->InsertNextValue(face);
    }
  }
  vtkNURBSModel::CopyFaceAttributes(input, origin, output->GetCellData());
  vtkNURBSModel::RemoveStructure(output->GetFieldData());
  return 1;
}

void vtkNURBSControlNet::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "GeneratePoints: " << (this->GeneratePoints ? "On\n" : "Off\n");
  os << indent << "GenerateLines: " << (this->GenerateLines ? "On\n" : "Off\n");
  os << indent << "GenerateQuads: " << (this->GenerateQuads ? "On\n" : "Off\n");
}
