// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshInput.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>

#include <stdexcept>
#include <unordered_map>

namespace verify
{

namespace
{

// The stated bounds stand in field data beside the ids of the faces they belong to.
void TakeCertifiedErrors(vtkPolyData* mesh, std::vector<FaceMesh>& faces)
{
  vtkDataArray* bounds = mesh->GetFieldData()->GetArray("FaceCertifiedError");
  vtkDataArray* ids = mesh->GetFieldData()->GetArray("FaceIds");
  for (vtkIdType i = 0; bounds && i < bounds->GetNumberOfTuples(); ++i)
  {
    const auto f = std::size_t(ids ? ids->GetTuple1(i) : double(i));
    if (f < faces.size())
    {
      faces[f].Certified = bounds->GetTuple1(i);
    }
  }
}

} // namespace

std::vector<FaceMesh> SplitIntoFaces(vtkPolyData* mesh, int faceCount)
{
  vtkDataArray* faceIds = mesh->GetCellData()->GetArray("FaceId");
  if (!faceIds || !mesh->GetPoints())
  {
    throw std::runtime_error("the mesh has no points or no cell data FaceId");
  }
  if (mesh->GetPoints()->GetDataType() != VTK_DOUBLE)
  {
    throw std::runtime_error("the mesh's points are not double");
  }
  std::vector<FaceMesh> faces(static_cast<std::size_t>(faceCount));
  std::vector<std::unordered_map<vtkIdType, int>> local(faces.size());
  const vtkIdType before = mesh->GetNumberOfVerts() + mesh->GetNumberOfLines();
  for (vtkIdType c = 0; c < mesh->GetNumberOfPolys(); ++c)
  {
    const double id = faceIds->GetTuple1(before + c);
    if (!(id >= 0 && id < faceCount))
    {
      throw std::runtime_error("FaceId " + std::to_string(id) + " is not one of the file's faces");
    }
    vtkIdType count = 0;
    const vtkIdType* points = nullptr;
    mesh->GetPolys()->GetCellAtId(c, count, points);
    if (count != 3)
    {
      throw std::runtime_error("the mesh has a cell that is no triangle");
    }
    FaceMesh& face = faces[static_cast<std::size_t>(id)];
    std::array<int, 3> triangle;
    for (std::size_t k = 0; k < 3; ++k)
    {
      const auto [entry, added] =
        local[static_cast<std::size_t>(id)].emplace(points[k], int(face.Points.size()));
      triangle[k] = entry->second;
      if (added)
      {
        double p[3];
        mesh->GetPoint(points[k], p);
        face.Points.emplace_back(p[0], p[1], p[2]);
      }
    }
    face.Triangles.push_back(triangle);
  }
  TakeCertifiedErrors(mesh, faces);
  return faces;
}

std::vector<FaceMesh> ReadMesh(const std::string& file, int faceCount)
{
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  return SplitIntoFaces(reader->GetOutput(), faceCount);
}

} // namespace verify
