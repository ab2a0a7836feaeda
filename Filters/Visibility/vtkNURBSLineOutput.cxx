// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSLineOutput.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSNewArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

namespace
{

using nurbs::SilhouetteLine;
using vtkNURBSLineOutput::Range;

// Numbers the points of lines: an end that another line goes on from has one number.
class PointNumbers
{
public:
  explicit PointNumbers(const std::vector<SilhouetteLine>& lines)
    : Lines(lines)
    , Ends(2 * lines.size(), -1)
  {}

  // The number of an end, -1 if it has none so far.
  vtkIdType Find(std::size_t line, int end) const { return this->Ends[2 * line + end]; }
  void Set(std::size_t line, int end, vtkIdType number)
  {
    this->Ends[2 * line + end] = number;
    const std::int64_t next = this->Lines[line].Next[end];
    if (next >= 0)
    {
      this->Ends[2 * next + this->Lines[line].NextEnd[end]] = number;
    }
  }

private:
  const std::vector<SilhouetteLine>& Lines;
  std::vector<vtkIdType> Ends;
};

void FillFieldData(const Range& range, vtkUnstructuredGrid* grid, vtkPolyData* output)
{
  vtkFieldData* field = output->GetFieldData();
  const auto faces = vtkIdType(range.Last - range.First);
  auto ids = vtkNURBSNewArray<vtkIdTypeArray>("FaceIds", 1, faces);
  auto patches =
    vtkNURBSNewArray<vtkIdTypeArray>("FacePatches", nurbs::PatchVisibilityCount, faces);
  auto status = vtkNURBSNewArray<vtkUnsignedCharArray>("FaceStatus", 1, faces);
  auto messages = vtkNURBSNewArray<vtkStringArray>("FaceStatusMessage", 1, faces);
  for (vtkIdType f = 0; f < faces; ++f)
  {
    const nurbs::FaceSilhouette& face = range.Result->Faces[range.First + f];
    ids->SetValue(f, vtkNURBSModel::GetFaceId(grid, f));
    for (int k = 0; k < nurbs::PatchVisibilityCount; ++k)
    {
      patches->SetTypedComponent(f, k, vtkIdType(face.Patches[k]));
    }
    status->SetValue(f, static_cast<unsigned char>(face.Status));
    messages->SetValue(f, face.Message);
  }
  field->AddArray(ids);
  field->AddArray(patches);
  field->AddArray(status);
  field->AddArray(messages);
}

} // namespace

void vtkNURBSLineOutput::FillLines(
  const Range& range, vtkUnstructuredGrid* grid, vtkPolyData* output)
{
  output->Initialize();
  vtkNURBSModel::PassWithoutStructure(grid->GetFieldData(), output->GetFieldData());
  const std::vector<SilhouetteLine>& lines = range.Result->Lines;
  auto xyz = vtkNURBSNewArray<vtkDoubleArray>("Points", 3);
  auto uv = vtkNURBSNewArray<vtkDoubleArray>("UV", 2);
  auto cosine = vtkNURBSNewArray<vtkDoubleArray>("NormalDotView", 1);
  auto owners = vtkNURBSNewArray<vtkIdTypeArray>("Faces", 1);
  auto edges = vtkNURBSNewArray<vtkIdTypeArray>(vtkNURBSModel::EdgeIdName(), 1);
  auto kinds = vtkNURBSNewArray<vtkUnsignedCharArray>("Kind", 1);
  auto creases = vtkNURBSNewArray<vtkUnsignedCharArray>("OnCrease", 1);
  auto chains = vtkNURBSNewArray<vtkIdTypeArray>("Chain", 1);
  PointNumbers numbers(lines);
  vtkNew<vtkCellArray> cells;
  std::vector<vtkIdType> ids;
  for (std::size_t k = 0; k < lines.size(); ++k)
  {
    const SilhouetteLine& line = lines[k];
    if (std::size_t(line.Face) < range.First || std::size_t(line.Face) >= range.Last)
    {
      continue;
    }
    ids.clear();
    const std::size_t last = line.Points.size() - 1;
    for (std::size_t p = 0; p <= last; ++p)
    {
      const int end = p == 0 ? 0 : (p == last ? 1 : -1);
      vtkIdType id = end < 0 || line.Closed ? -1 : numbers.Find(k, end);
      if (id < 0)
      {
        id = xyz->InsertNextTuple(line.Points[p].Point.data());
        uv->InsertNextTuple(line.Points[p].UV.data());
        cosine->InsertNextValue(
          line.Kind == nurbs::LineKind::Silhouette ? line.Points[p].Cosine : 0.0);
        if (end >= 0)
        {
          numbers.Set(k, end, id);
        }
      }
      ids.push_back(id);
    }
    if (line.Closed)
    {
      ids.push_back(ids.front());
    }
    cells->InsertNextCell(vtkIdType(ids.size()), ids.data());
    owners->InsertNextValue(vtkIdType(line.Face - std::int64_t(range.First)));
    edges->InsertNextValue(line.Edge < 0 ? -1 : vtkIdType(line.Edge - range.FirstEdge));
    kinds->InsertNextValue(static_cast<unsigned char>(line.Kind));
    creases->InsertNextValue(line.Crease ? 1 : 0);
    chains->InsertNextValue(vtkIdType(line.Chain));
  }
  vtkNew<vtkPoints> points;
  points->SetData(xyz);
  output->SetPoints(points);
  output->SetLines(cells);
  output->GetPointData()->AddArray(uv);
  output->GetPointData()->AddArray(cosine);
  vtkNURBSModel::CopyFaceAttributes(grid, owners, output->GetCellData());
  output->GetCellData()->AddArray(edges);
  output->GetCellData()->AddArray(kinds);
  output->GetCellData()->AddArray(creases);
  output->GetCellData()->AddArray(chains);
  FillFieldData(range, grid, output);
}
