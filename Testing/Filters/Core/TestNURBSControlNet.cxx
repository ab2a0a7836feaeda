// SPDX-License-Identifier: BSD-3-Clause
#include "../../testMessageKeeper.h"
#include "vtkNURBSControlNet.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSShapeSource.h"

#include "vtkCellData.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

struct Net
{
  vtkNew<vtkNURBSShapeSource> Source;
  vtkNew<vtkNURBSControlNet> Filter;
  explicit Net(int shape)
  {
    this->Source->SetShape(shape);
    this->Filter->SetInputConnection(this->Source->GetOutputPort());
  }
  vtkPolyData* Update()
  {
    this->Filter->Update();
    return this->Filter->GetOutput();
  }
};

TEST(ControlNet, CountsOfATorus)
{
  Net net(vtkNURBSShapeSource::TORUS); // 9 x 9 control points.
  net.Filter->GenerateQuadsOn();
  vtkPolyData* output = net.Update();
  EXPECT_EQ(output->GetNumberOfPoints(), 81);
  EXPECT_EQ(output->GetNumberOfVerts(), 1);
  EXPECT_EQ(output->GetNumberOfLines(), 18);
  EXPECT_EQ(output->GetNumberOfPolys(), 64);
  EXPECT_EQ(output->GetCell(0)->GetNumberOfPoints(), 81);
  EXPECT_EQ(output->GetCell(1)->GetNumberOfPoints(), 9);
  EXPECT_EQ(output->GetPointData()->GetArray("RationalWeights")->GetNumberOfTuples(), 81);
  EXPECT_EQ(output->GetFieldData()->GetAbstractArray("Knots"), nullptr);
}

TEST(ControlNet, OptionsChooseTheCells)
{
  Net net(vtkNURBSShapeSource::SHEET);
  net.Source->SetSheetPoints(5, 7);
  EXPECT_EQ(net.Update()->GetNumberOfCells(), 1 + 12);
  net.Filter->GeneratePointsOff();
  EXPECT_EQ(net.Update()->GetNumberOfCells(), 12);
  net.Filter->GenerateLinesOff();
  EXPECT_EQ(net.Update()->GetNumberOfCells(), 0);
  net.Filter->GenerateQuadsOn();
  EXPECT_EQ(net.Update()->GetNumberOfCells(), 24);
}

TEST(ControlNet, QuadsOfTheSheetLookUpAndTileIt)
{
  Net net(vtkNURBSShapeSource::SHEET);
  net.Source->SetSheetPoints(5, 7);
  net.Source->SetSheetAmplitude(0.0);
  net.Filter->GeneratePointsOff();
  net.Filter->GenerateLinesOff();
  net.Filter->GenerateQuadsOn();
  vtkPolyData* output = net.Update();
  double area = 0.0;
  for (vtkIdType cell = 0; cell < output->GetNumberOfCells(); ++cell)
  {
    double a[3], c[3];
    vtkPoints* points = output->GetCell(cell)->GetPoints();
    points->GetPoint(0, a);
    points->GetPoint(2, c);
    EXPECT_GT(c[0], a[0]);
    EXPECT_GT(c[1], a[1]);
    area += (c[0] - a[0]) * (c[1] - a[1]);
  }
  EXPECT_NEAR(area, 100.0 * 100.0, 1e-9);
}

TEST(ControlNet, CellsCarryTheirFacesAttributes)
{
  Net net(vtkNURBSShapeSource::TEAPOT);
  vtkPolyData* output = net.Update();
  ASSERT_EQ(output->GetNumberOfCells(), 32 + 32 * 8);
  vtkDataArray* ids = output->GetCellData()->GetArray("FaceId");
  ASSERT_EQ(ids->GetNumberOfTuples(), output->GetNumberOfCells());
  EXPECT_EQ(ids->GetTuple1(31), 31);
  EXPECT_EQ(ids->GetTuple1(32 + 8 * 30), 30);
  EXPECT_EQ(output->GetCellData()->GetAbstractArray("Degree"), nullptr);
  EXPECT_NE(output->GetCellData()->GetAbstractArray("Name"), nullptr);
}

TEST(ControlNet, BadFacesAreNamedAndTheOthersStay)
{
  Net net(vtkNURBSShapeSource::TEAPOT);
  net.Source->Update();
  vtkNew<vtkUnstructuredGrid> grid;
  grid->DeepCopy(net.Source->GetOutput());
  grid->GetPoints()->SetPoint(16 * 5, std::nan(""), 0, 0);
  vtkNew<MessageKeeper> keeper;
  net.Filter->AddObserver(vtkCommand::WarningEvent, keeper);
  net.Filter->SetInputData(grid);
  EXPECT_EQ(net.Update()->GetNumberOfVerts(), 31);
  EXPECT_TRUE(keeper->Says("cell 5 (FaceId 5): control point 0")) << keeper->Text;
}

} // namespace
