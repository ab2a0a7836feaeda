// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSRegionOutput.h"

#include "ModelBuilder.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkNURBSModel.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

void vtkNURBSRegionOutput::FillModel(const nurbs::VisibleRegions& result,
  const vtkNURBSModelPool::Leaf& leaf, vtkUnstructuredGrid* output)
{
  nurbs::ModelBuilder builder;
  builder.LengthUnit = vtkNURBSModel::GetLengthUnit(leaf.Grid);
  const std::vector<std::int64_t> faces =
    nurbs::BuildRegions(result, std::int64_t(leaf.FirstFace), std::int64_t(leaf.LastFace), builder);
  vtkNURBSModel::Store(builder, output);
  // Faces look as those of the input, or not at all.
  output->GetCellData()->RemoveArray(vtkNURBSModel::ColorName());
  output->GetCellData()->RemoveArray(vtkNURBSModel::NameName());
  vtkNew<vtkIdTypeArray> cells;
  vtkNew<vtkDoubleArray> areas;
  areas->SetName("VisibleArea");
  vtkNew<vtkDoubleArray> fractions;
  fractions->SetName("VisibleFraction");
  for (const std::int64_t f : faces)
  {
    const nurbs::FaceRegion& face = result.Faces[f];
    cells->InsertNextValue(vtkIdType(f - std::int64_t(leaf.FirstFace)));
    areas->InsertNextValue(face.VisibleArea);
    fractions->InsertNextValue(face.Area > 0.0 ? face.VisibleArea / face.Area : 0.0);
  }
  vtkNURBSModel::CopyFaceAttributes(leaf.Grid, cells, output->GetCellData());
  output->GetCellData()->AddArray(areas);
  output->GetCellData()->AddArray(fractions);
  vtkNURBSModel::PassWithoutStructure(leaf.Grid->GetFieldData(), output->GetFieldData());
}

void vtkNURBSRegionOutput::FillLines(const nurbs::VisibleRegions& result,
  const vtkNURBSModelPool::Leaf& leaf, const LineChoice& choice, vtkPolyData* output)
{
  output->Initialize();
  vtkNURBSModel::PassWithoutStructure(leaf.Grid->GetFieldData(), output->GetFieldData());
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkDoubleArray> uv;
  uv->SetName("UV");
  uv->SetNumberOfComponents(2);
  vtkNew<vtkIdTypeArray> owners;
  vtkNew<vtkIdTypeArray> edges;
  edges->SetName(vtkNURBSModel::EdgeIdName());
  vtkNew<vtkUnsignedCharArray> kinds;
  kinds->SetName("Kind");
  vtkNew<vtkUnsignedCharArray> visibility;
  visibility->SetName("Visibility");
  vtkNew<vtkCellArray> cells;
  for (const nurbs::DrawnLine& line : result.Drawn)
  {
    if (std::size_t(line.Face) < leaf.FirstFace || std::size_t(line.Face) >= leaf.LastFace ||
      !choice.Kinds[int(line.Kind)] || (!line.Visible && !choice.Hidden))
    {
      continue;
    }
    cells->InsertNextCell(int(line.Points.size()));
    for (const nurbs::ContourPoint& point : line.Points)
    {
      nurbs::Vec3 at = point.Point;
      if (choice.Project)
      {
        at << result.Image->Project(point.Point), 0.0;
      }
      cells->InsertCellPoint(points->InsertNextPoint(at.data()));
      uv->InsertNextTuple(point.UV.data());
    }
    owners->InsertNextValue(vtkIdType(line.Face - std::int64_t(leaf.FirstFace)));
    edges->InsertNextValue(line.Edge < 0 ? -1 : vtkIdType(line.Edge - leaf.FirstEdge));
    kinds->InsertNextValue(static_cast<unsigned char>(line.Kind));
    visibility->InsertNextValue(line.Visible ? 1 : 0);
  }
  output->SetPoints(points);
  output->SetLines(cells);
  output->GetPointData()->AddArray(uv);
  vtkNURBSModel::CopyFaceAttributes(leaf.Grid, owners, output->GetCellData());
  output->GetCellData()->AddArray(edges);
  output->GetCellData()->AddArray(kinds);
  output->GetCellData()->AddArray(visibility);
}
