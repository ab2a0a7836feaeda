// SPDX-License-Identifier: BSD-3-Clause
// NURBS to VTK's rational Bezier cells and back; the reference is VTK's own evaluation of them.
#include "../../testMessageKeeper.h"
#include "vtkNURBSFromBezierCells.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"
#include "vtkNURBSShapeSource.h"
#include "vtkNURBSToBezierCells.h"

#include "vtkBezierQuadrilateral.h"
#include "vtkCellData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <random>

namespace
{

/// Source and both filters in a row.
struct Pipeline
{
  vtkNew<vtkNURBSShapeSource> Source;
  vtkNew<vtkNURBSToBezierCells> ToCells;
  vtkNew<vtkNURBSFromBezierCells> FromCells;
  Pipeline()
  {
    this->ToCells->SetInputConnection(this->Source->GetOutputPort());
    this->FromCells->SetInputConnection(this->ToCells->GetOutputPort());
  }
};

/// The point of a cell as VTK evaluates it.
nurbs::Vec3 EvaluateCell(vtkUnstructuredGrid* cells, vtkIdType cell, double r, double s)
{
  const double pcoords[3] = { r, s, 0.0 };
  int subId = 0;
  nurbs::Vec3 point;
  vtkCell* quad = cells->GetCell(cell);
  std::vector<double> weights(quad->GetNumberOfPoints());
  quad->EvaluateLocation(subId, pcoords, point.data(), weights.data());
  return point;
}

/// Compares cells, their surfaces and the surfaces made of them again at random parameters.
void ExpectSameGeometry(Pipeline& pipeline, double size)
{
  pipeline.FromCells->Update();
  vtkUnstructuredGrid* cells = pipeline.ToCells->GetOutput();
  const auto model = vtkNURBSModel::View(pipeline.Source->GetOutput());
  const auto again = vtkNURBSModel::View(pipeline.FromCells->GetOutput());
  EXPECT_TRUE(again->GetProblems().empty());
  ASSERT_EQ(again->GetModel().Faces.size(), static_cast<std::size_t>(cells->GetNumberOfCells()));
  vtkDataArray* domains = cells->GetCellData()->GetArray("PatchDomain");
  vtkDataArray* faces = cells->GetCellData()->GetArray("FaceId");
  std::mt19937 random(1);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  for (vtkIdType cell = 0; cell < cells->GetNumberOfCells(); ++cell)
  {
    const nurbs::SurfaceView& surface = model->GetModel().Faces[faces->GetTuple1(cell)].Geometry;
    const nurbs::SurfaceView& back = again->GetModel().Faces[cell].Geometry;
    const double* domain = domains->GetTuple4(cell);
    const double box[4] = { domain[0], domain[1], domain[2], domain[3] };
    for (int k = 0; k < 20; ++k)
    {
      const double r = part(random), s = part(random);
      const nurbs::Vec3 exact =
        nurbs::Evaluate(surface, box[0] + r * (box[1] - box[0]), box[2] + s * (box[3] - box[2]));
      EXPECT_LE((EvaluateCell(cells, cell, r, s) - exact).norm(), 1e-10 * size);
      EXPECT_LE((nurbs::Evaluate(back, r, s) - exact).norm(), 1e-10 * size);
    }
  }
}

TEST(BezierCells, VTKEvaluatesThemAsWeDo)
{
  const struct
  {
    int Shape;
    vtkIdType Cells;
    double Size;
  } cases[] = { { vtkNURBSShapeSource::SPHERE, 8, 1.0 }, { vtkNURBSShapeSource::TORUS, 16, 1.3 },
    { vtkNURBSShapeSource::CYLINDER, 6, 2.0 }, { vtkNURBSShapeSource::CONE, 5, 2.0 },
    { vtkNURBSShapeSource::TEAPOT, 32, 6.0 }, { vtkNURBSShapeSource::SHEET, 37 * 37, 100.0 } };
  for (const auto& item : cases)
  {
    SCOPED_TRACE(item.Shape);
    Pipeline pipeline;
    pipeline.Source->SetShape(item.Shape);
    ExpectSameGeometry(pipeline, item.Size);
    EXPECT_EQ(pipeline.ToCells->GetOutput()->GetNumberOfCells(), item.Cells);
  }
}

TEST(BezierCells, DegreesThatDiffer)
{
  for (int p = 1; p <= 10; ++p)
  {
    SCOPED_TRACE(p);
    Pipeline pipeline;
    pipeline.Source->SetShapeToSheet();
    pipeline.Source->SetSheetDegree(p, 11 - p);
    pipeline.Source->SetSheetPoints(p + 3, 13 - p);
    pipeline.Source->SheetRationalOn();
    ExpectSameGeometry(pipeline, 100.0);
    vtkDataArray* degrees = pipeline.ToCells->GetOutput()->GetCellData()->GetHigherOrderDegrees();
    ASSERT_NE(degrees, nullptr);
    EXPECT_EQ(degrees->GetComponent(0, 0), p);
    EXPECT_EQ(degrees->GetComponent(0, 1), 11 - p);
  }
}

TEST(BezierCells, PointsAreInVTKsOrder)
{
  Pipeline pipeline;
  pipeline.Source->SetShapeToSheet();
  pipeline.Source->SetSheetPoints(4, 4);
  pipeline.ToCells->Update();
  vtkUnstructuredGrid* cells = pipeline.ToCells->GetOutput();
  ASSERT_EQ(cells->GetCellType(0), VTK_BEZIER_QUADRILATERAL);
  // Corners counter-clockwise, then 2 points an edge (the last two along increasing coordinates).
  const double thirds[16][2] = { { 0, 0 }, { 3, 0 }, { 3, 3 }, { 0, 3 }, { 1, 0 }, { 2, 0 },
    { 3, 1 }, { 3, 2 }, { 1, 3 }, { 2, 3 }, { 0, 1 }, { 0, 2 }, { 1, 1 }, { 2, 1 }, { 1, 2 },
    { 2, 2 } };
  vtkCell* cell = cells->GetCell(0);
  ASSERT_EQ(cell->GetNumberOfPoints(), 16);
  for (int i = 0; i < 16; ++i)
  {
    const double* point = cell->GetPoints()->GetPoint(i);
    EXPECT_NEAR(point[0], 100.0 * thirds[i][0] / 3.0, 1e-12) << i;
    EXPECT_NEAR(point[1], 100.0 * thirds[i][1] / 3.0, 1e-12) << i;
  }
  EXPECT_EQ(cells->GetPointData()->GetRationalWeights(), nullptr); // Polynomial.
}

TEST(BezierCells, AttributesStayAndStructureGoes)
{
  Pipeline pipeline;
  pipeline.Source->SetShapeToTeapot();
  pipeline.FromCells->Update();
  vtkUnstructuredGrid* cells = pipeline.ToCells->GetOutput();
  EXPECT_FALSE(vtkNURBSModel::IsModel(cells));
  EXPECT_EQ(cells->GetFieldData()->GetAbstractArray("TrimPoints"), nullptr);
  EXPECT_NE(cells->GetCellData()->GetAbstractArray("Color"), nullptr);
  EXPECT_EQ(vtkNURBSModel::GetLengthUnit(cells), "mm");
  vtkUnstructuredGrid* again = pipeline.FromCells->GetOutput();
  EXPECT_TRUE(vtkNURBSModel::IsModel(again));
  EXPECT_EQ(vtkNURBSModel::GetFaceId(again, 31), 31);
  EXPECT_EQ(
    again->GetCellData()->GetAbstractArray("Name")->GetVariantValue(31).ToString(), "spout");
  EXPECT_EQ(again->GetCellData()->GetAbstractArray("HigherOrderDegrees"), nullptr);
  EXPECT_EQ(vtkNURBSModel::GetLengthUnit(again), "mm");
}

TEST(BezierCells, CellsOfOneSurfaceShareEdgesAgain)
{
  Pipeline pipeline;
  pipeline.Source->SetShapeToTorus();
  pipeline.FromCells->Update();
  const auto again = vtkNURBSModel::View(pipeline.FromCells->GetOutput());
  EXPECT_EQ(again->GetModel().Faces.size(), 16u);
  EXPECT_EQ(again->GetModel().Edges.size(), 32u); // Each shared by two of 16 cells.
  EXPECT_EQ(again->GetModel().Vertices.size(), 16u);
  EXPECT_EQ(again->GetModel().TrimCurves.size(), 64u);
}

TEST(BezierCells, TrimmedFacesAreMarkedOrLeftOut)
{
  Pipeline pipeline;
  pipeline.Source->SetShapeToCylinder();
  pipeline.ToCells->Update();
  vtkDataArray* trimmed = pipeline.ToCells->GetOutput()->GetCellData()->GetArray("Trimmed");
  vtkDataArray* faces = pipeline.ToCells->GetOutput()->GetCellData()->GetArray("FaceId");
  for (vtkIdType cell = 0; cell < trimmed->GetNumberOfTuples(); ++cell)
  {
    EXPECT_EQ(trimmed->GetTuple1(cell), faces->GetTuple1(cell) == 0 ? 0 : 1); // Caps are trimmed.
  }
  pipeline.ToCells->SkipTrimmedFacesOn();
  pipeline.ToCells->Update();
  EXPECT_EQ(pipeline.ToCells->GetOutput()->GetNumberOfCells(), 4);
}

TEST(BezierCells, WhatVTKCantEvaluateIsNamed)
{
  Pipeline pipeline;
  vtkNew<MessageKeeper> keeper;
  pipeline.ToCells->AddObserver(vtkCommand::WarningEvent, keeper);
  pipeline.Source->SetShapeToSheet();
  pipeline.Source->SetSheetDegree(3, 11);
  pipeline.ToCells->Update();
  EXPECT_EQ(pipeline.ToCells->GetOutput()->GetNumberOfCells(), 0);
  EXPECT_TRUE(keeper->Says("cell 0: degree 11 is over 10")) << keeper->Text;
}

TEST(BezierCells, OtherCellsAreNamed)
{
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPoints> points;
  const vtkIdType ids[4] = { points->InsertNextPoint(0, 0, 0), points->InsertNextPoint(1, 0, 0),
    points->InsertNextPoint(1, 1, 0), points->InsertNextPoint(0, 1, 0) };
  grid->SetPoints(points);
  grid->Allocate(3);
  grid->InsertNextCell(VTK_QUAD, 4, ids);
  grid->InsertNextCell(VTK_BEZIER_QUADRILATERAL, 4, ids);
  grid->InsertNextCell(VTK_BEZIER_QUADRILATERAL, 3, ids);
  vtkNew<MessageKeeper> keeper;
  vtkNew<vtkNURBSFromBezierCells> filter;
  filter->AddObserver(vtkCommand::WarningEvent, keeper);
  filter->SetInputData(grid);
  filter->Update();
  EXPECT_TRUE(keeper->Says("cell 0: its type is 9")) << keeper->Text;
  EXPECT_TRUE(keeper->Says("cell 2: 3 points")) << keeper->Text;
  ASSERT_EQ(filter->GetOutput()->GetNumberOfCells(), 1);
  const auto view = vtkNURBSModel::View(filter->GetOutput());
  EXPECT_TRUE(view->GetProblems().empty());
  EXPECT_EQ(
    nurbs::Evaluate(view->GetModel().Faces[0].Geometry, 0.25, 0.75), nurbs::Vec3(0.25, 0.75, 0));
  EXPECT_EQ(vtkNURBSModel::GetFaceId(filter->GetOutput(), 0), 1);
}

} // namespace
