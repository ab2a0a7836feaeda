// SPDX-License-Identifier: BSD-3-Clause
// Edited surfaces against the formula of rational B-splines, with basis functions by the recursion
// of Cox and de Boor written out here.
#include "../../testMessageKeeper.h"
#include "vtkNURBSControlPointEdits.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"
#include "vtkNURBSShapeSource.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataAssembly.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkTrivialProducer.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>

namespace
{

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();
constexpr double Infinity = std::numeric_limits<double>::infinity();

vtkSmartPointer<vtkUnstructuredGrid> Shape(int type, int sheet = 8)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShape(type);
  source->SetSheetPoints(sheet, sheet);
  source->Update();
  return source->GetOutput();
}

nurbs::Vec3 PointOf(vtkDataSet* grid, vtkIdType point)
{
  nurbs::Vec3 place;
  grid->GetPoint(point, place.data());
  return place;
}

double WeightOf(vtkUnstructuredGrid* grid, vtkIdType point)
{
  vtkDataArray* weights = grid->GetPointData()->GetArray("RationalWeights");
  return weights ? weights->GetComponent(point, 0) : 1.0;
}

/// A filter on a grid, with its errors kept.
struct Edited
{
  vtkSmartPointer<vtkUnstructuredGrid> Input;
  vtkNew<vtkNURBSControlPointEdits> Edits;
  vtkNew<MessageKeeper> Errors;

  explicit Edited(vtkSmartPointer<vtkUnstructuredGrid> input)
    : Input(input)
  {
    this->Edits->SetInputDataObject(input);
    this->Edits->AddObserver(vtkCommand::ErrorEvent, this->Errors);
  }
  vtkUnstructuredGrid* Update()
  {
    this->Edits->Update();
    return vtkUnstructuredGrid::SafeDownCast(this->Edits->GetOutputDataObject(0));
  }
  /// How many points of the output are elsewhere than those of `before`.
  vtkIdType CountMoved(vtkUnstructuredGrid* before)
  {
    vtkUnstructuredGrid* output = this->Update();
    vtkIdType moved = 0;
    for (vtkIdType k = 0; k < before->GetNumberOfPoints(); ++k)
    {
      moved += PointOf(output, k) != PointOf(before, k);
    }
    return moved;
  }
};

double CoxDeBoor(const nurbs::KnotView& knots, int i, int degree, double t)
{
  if (degree == 0)
  {
    return knots[i] <= t && t < knots[i + 1] ? 1.0 : 0.0;
  }
  double sum = 0.0;
  if (const double length = knots[i + degree] - knots[i]; length > 0.0)
  {
    sum += (t - knots[i]) / length * CoxDeBoor(knots, i, degree - 1, t);
  }
  if (const double length = knots[i + degree + 1] - knots[i + 1]; length > 0.0)
  {
    sum += (knots[i + degree + 1] - t) / length * CoxDeBoor(knots, i + 1, degree - 1, t);
  }
  return sum;
}

/// A sheet's surface by the formula, with some control points and weights replaced.
nurbs::Vec3 ByFormula(vtkUnstructuredGrid* grid, double u, double v,
  const std::map<vtkIdType, std::pair<nurbs::Vec3, double>>& replaced)
{
  const auto view = vtkNURBSModel::View(grid);
  const nurbs::SurfaceView& s = view->GetModel().Faces[0].Geometry;
  nurbs::Vec3 sum = nurbs::Vec3::Zero();
  double weights = 0.0;
  for (int j = 0; j < s.Count[1]; ++j)
  {
    for (int i = 0; i < s.Count[0]; ++i)
    {
      const vtkIdType k = i + j * s.Count[0];
      const auto found = replaced.find(k);
      const nurbs::Vec3 place = found == replaced.end() ? s.Point(k) : found->second.first;
      const double weight = (found == replaced.end() ? s.Weight(k) : found->second.second) *
        CoxDeBoor(s.Knots[0], i, s.Degree[0], u) * CoxDeBoor(s.Knots[1], j, s.Degree[1], v);
      sum += weight * place;
      weights += weight;
    }
  }
  return sum / weights;
}

double WorstDifference(vtkUnstructuredGrid* input, vtkUnstructuredGrid* output,
  const std::map<vtkIdType, std::pair<nurbs::Vec3, double>>& replaced)
{
  const auto view = vtkNURBSModel::View(output);
  const nurbs::SurfaceView& s = view->GetModel().Faces[0].Geometry;
  const nurbs::Interval u = s.Domain(0), v = s.Domain(1);
  double worst = 0.0;
  for (int i = 0; i < 17; ++i)
  {
    for (int j = 0; j < 17; ++j)
    {
      const double a = u.Min + u.Length() * i / 17.0, b = v.Min + v.Length() * j / 17.0;
      worst = std::max(worst, (nurbs::Evaluate(s, a, b) - ByFormula(input, a, b, replaced)).norm());
    }
  }
  return worst;
}

TEST(ControlPointEdits, MovesThePointAndNothingElse)
{
  Edited edited(Shape(vtkNURBSShapeSource::SHEET));
  vtkNew<vtkUnstructuredGrid> before;
  before->DeepCopy(edited.Input);
  const vtkMTimeType time = edited.Input->GetMTime();
  EXPECT_EQ(edited.Update()->GetPoints(), edited.Input->GetPoints()) << "nothing to copy yet";

  ASSERT_TRUE(edited.Edits->MoveControlPoint(27, 1.0, 2.0, 30.0));
  ASSERT_TRUE(edited.Edits->MoveControlPoint(27, 0.0, 0.0, -10.0));
  ASSERT_TRUE(edited.Edits->SetControlPointPosition(0, -5.0, -6.0, 7.0));
  EXPECT_EQ(edited.CountMoved(before), 2);
  vtkUnstructuredGrid* output = edited.Update();
  const nurbs::Vec3 moved = PointOf(before, 27) + nurbs::Vec3(1.0, 2.0, 20.0);
  EXPECT_EQ(PointOf(output, 27), moved);
  EXPECT_EQ(PointOf(output, 0), nurbs::Vec3(-5.0, -6.0, 7.0));
  EXPECT_EQ(edited.Edits->GetNumberOfEdits(), 2);
  EXPECT_LT(WorstDifference(edited.Input, output,
              { { 27, { moved, 1.0 } }, { 0, { nurbs::Vec3(-5.0, -6.0, 7.0), 1.0 } } }),
    1e-12 * 100.0);

  EXPECT_EQ(edited.Input->GetMTime(), time);
  for (vtkIdType k = 0; k < before->GetNumberOfPoints(); ++k)
  {
    ASSERT_EQ(PointOf(edited.Input, k), PointOf(before, k));
  }
  EXPECT_EQ(output->GetCells(), edited.Input->GetCells());
  for (const char* name : { "Degree", "NetSize", "KnotStart", "FaceId" })
  {
    EXPECT_EQ(output->GetCellData()->GetArray(name), edited.Input->GetCellData()->GetArray(name));
  }
  EXPECT_EQ(
    output->GetFieldData()->GetArray("Knots"), edited.Input->GetFieldData()->GetArray("Knots"));
  EXPECT_EQ(output->GetPointData()->GetArray("RationalWeights"), nullptr);
  EXPECT_EQ(vtkNURBSModel::Validate(output), "");
  EXPECT_EQ(edited.Errors->Text, "");
}

TEST(ControlPointEdits, WeightsOfAModelWithAndWithoutThem)
{
  for (const bool rational : { false, true })
  {
    vtkNew<vtkNURBSShapeSource> source;
    source->SetShapeToSheet();
    source->SetSheetPoints(7, 9);
    source->SetSheetRational(rational);
    source->Update();
    Edited edited(source->GetOutput());
    ASSERT_TRUE(edited.Edits->SetControlPointWeight(25, 3.5));
    vtkUnstructuredGrid* output = edited.Update();
    EXPECT_EQ(output->GetPoints(), edited.Input->GetPoints()) << "no point was moved";
    vtkDataArray* weights = output->GetPointData()->GetArray("RationalWeights");
    ASSERT_TRUE(weights);
    for (vtkIdType k = 0; k < 63; ++k)
    {
      EXPECT_EQ(weights->GetComponent(k, 0), k == 25 ? 3.5 : WeightOf(edited.Input, k));
    }
    EXPECT_EQ(edited.Input->GetPointData()->GetArray("RationalWeights") != nullptr, rational);
    const nurbs::Vec3 place = PointOf(edited.Input, 25);
    EXPECT_LT(WorstDifference(edited.Input, output, { { 25, { place, 3.5 } } }), 1e-10);
    EXPECT_GT(WorstDifference(edited.Input, output, {}), 1.0) << "the weight does show";

    ASSERT_TRUE(edited.Edits->Undo());
    EXPECT_EQ(edited.Update()->GetPointData()->GetArray("RationalWeights"), weights);
    EXPECT_EQ(weights->GetComponent(25, 0), WeightOf(edited.Input, 25));
    EXPECT_EQ(vtkNURBSModel::Validate(output), "");
  }
}

TEST(ControlPointEdits, ArraysAreKeptAndTold)
{
  Edited edited(Shape(vtkNURBSShapeSource::SHEET));
  edited.Edits->MoveControlPoint(3, 1.0, 0.0, 0.0);
  edited.Edits->SetControlPointWeight(4, 2.0);
  vtkUnstructuredGrid* output = edited.Update();
  vtkPoints* points = output->GetPoints();
  vtkDataArray* values = points->GetData();
  vtkDataArray* weights = output->GetPointData()->GetArray("RationalWeights");
  const vtkMTimeType time = points->GetMTime();
  edited.Edits->MoveControlPoint(9, 1.0, 0.0, 0.0);
  output = edited.Update();
  EXPECT_EQ(output->GetPoints(), points);
  EXPECT_EQ(output->GetPoints()->GetData(), values);
  EXPECT_EQ(output->GetPointData()->GetArray("RationalWeights"), weights);
  EXPECT_GT(points->GetMTime(), time) << "downstream must see that points moved";
  EXPECT_EQ(PointOf(output, 9), PointOf(edited.Input, 9) + nurbs::Vec3(1.0, 0.0, 0.0));
  EXPECT_EQ(PointOf(output, 3), PointOf(edited.Input, 3) + nurbs::Vec3(1.0, 0.0, 0.0));
}

/// Points of the input at the same place as `point`, one by one.
std::vector<vtkIdType> AtSamePlace(vtkUnstructuredGrid* grid, vtkIdType point, double tolerance)
{
  std::vector<vtkIdType> found;
  for (vtkIdType k = 0; k < grid->GetNumberOfPoints(); ++k)
  {
    if ((PointOf(grid, k) - PointOf(grid, point)).norm() <= tolerance)
    {
      found.push_back(k);
    }
  }
  return found;
}

TEST(ControlPointEdits, CoincidentPointsMoveTogether)
{
  for (const int shape : { vtkNURBSShapeSource::SPHERE, vtkNURBSShapeSource::TORUS,
         vtkNURBSShapeSource::CYLINDER, vtkNURBSShapeSource::CONE, vtkNURBSShapeSource::TEAPOT })
  {
    auto input = Shape(shape);
    const double tolerance = 1e-7 * input->GetLength();
    vtkIdType together = 0;
    for (vtkIdType point = 0; point < input->GetNumberOfPoints(); point += 1 + point / 40)
    {
      Edited edited(input);
      ASSERT_TRUE(edited.Edits->MoveControlPoint(point, 0.25, -0.5, 0.125));
      const std::vector<vtkIdType> same = AtSamePlace(input, point, tolerance);
      together = std::max(together, vtkIdType(same.size()));
      vtkUnstructuredGrid* output = edited.Update();
      for (vtkIdType k = 0; k < input->GetNumberOfPoints(); ++k)
      {
        const bool moves = std::find(same.begin(), same.end(), k) != same.end();
        ASSERT_EQ(PointOf(output, k),
          PointOf(input, k) + (moves ? nurbs::Vec3(0.25, -0.5, 0.125) : nurbs::Vec3::Zero()))
          << "shape " << shape << ": moved " << point << ", see " << k;
      }
      vtkNew<vtkIdTypeArray> told;
      edited.Edits->GetCoincidentControlPoints(0, point, told);
      ASSERT_EQ(told->GetNumberOfValues(), vtkIdType(same.size()));
      ASSERT_TRUE(std::equal(same.begin(), same.end(), told->GetPointer(0)));
    }
    EXPECT_GT(together, 1) << "shape " << shape;
  }
}

TEST(ControlPointEdits, SeamsStayClosedUnlessToldOtherwise)
{
  for (const bool together : { true, false })
  {
    Edited edited(Shape(vtkNURBSShapeSource::TORUS));
    edited.Edits->SetMoveCoincident(together);
    ASSERT_TRUE(edited.Edits->MoveControlPoint(2, 0.1, 0.2, 0.3));
    ASSERT_TRUE(edited.Edits->SetControlPointPosition(18, 0.4, 1.2, 0.7));
    ASSERT_TRUE(edited.Edits->SetControlPointWeight(9, 2.5));
    const auto view = vtkNURBSModel::View(edited.Update());
    const nurbs::SurfaceView& s = view->GetModel().Faces[0].Geometry;
    EXPECT_EQ(nurbs::IsClosed(s, 0, 1e-12), together);
    EXPECT_EQ(nurbs::IsClosed(s, 1, 1e-12), together);
  }
}

// Two faces whose common edge has weights that differ by a factor: the edge stays common.
TEST(ControlPointEdits, WeightsOfCoincidentPointsKeepTheirRatio)
{
  Edited edited(Shape(vtkNURBSShapeSource::TORUS));
  const std::vector<vtkIdType> seam = AtSamePlace(edited.Input, 9, 1e-12);
  ASSERT_EQ(seam, (std::vector<vtkIdType>{ 9, 17 }));
  vtkDataArray* weights = edited.Input->GetPointData()->GetArray("RationalWeights");
  const double weight = weights->GetComponent(9, 0);
  weights->SetComponent(17, 0, 3.0 * weight);
  weights->Modified();
  ASSERT_TRUE(edited.Edits->SetControlPointWeight(9, 0.4));
  EXPECT_DOUBLE_EQ(WeightOf(edited.Update(), 9), 0.4);
  EXPECT_DOUBLE_EQ(WeightOf(edited.Update(), 17), 1.2);
  vtkNew<vtkIdTypeArray> both;
  both->InsertNextValue(17);
  both->InsertNextValue(9);
  ASSERT_TRUE(edited.Edits->ScaleBlockControlPointWeights(0, both, 2.0));
  EXPECT_DOUBLE_EQ(WeightOf(edited.Update(), 9), 0.8) << "once, though it was named twice";
  EXPECT_DOUBLE_EQ(WeightOf(edited.Update(), 17), 2.4);
}

TEST(ControlPointEdits, RefusedEditsLeaveEverythingAsItWas)
{
  auto sphere = Shape(vtkNURBSShapeSource::CYLINDER);
  Edited edited(sphere);
  edited.Edits->MoveControlPoint(3, 1.0, 0.0, 0.0);
  vtkNew<vtkUnstructuredGrid> before;
  before->DeepCopy(edited.Update());
  vtkNURBSControlPointEdits* edits = edited.Edits;
  const vtkIdType count = sphere->GetNumberOfPoints();
  const vtkMTimeType time = edits->GetMTime();
  vtkNew<vtkIdTypeArray> someBad;
  someBad->InsertNextValue(2);
  someBad->InsertNextValue(count);

  const auto refused = [&](bool accepted, const std::vector<std::string>& words) {
    EXPECT_FALSE(accepted);
    for (const std::string& word : words)
    {
      EXPECT_TRUE(edited.Errors->Says(word)) << word << " in: " << edited.Errors->Text;
    }
    edited.Errors->Text.clear();
  };
  refused(edits->MoveControlPoint(count, 1, 1, 1),
    { "control point " + std::to_string(count), "of no cell",
      "0 to " + std::to_string(count - 1) });
  refused(edits->MoveControlPoint(-1, 1, 1, 1), { "control point -1" });
  refused(
    edits->MoveControlPoint(5, NaN, 1, 1), { "control point 5", "of cell 0, FaceId ", "finite" });
  refused(edits->MoveControlPoint(5, 0, 0, -Infinity), { "control point 5", "displacement" });
  refused(edits->SetControlPointPosition(5, 0, NaN, 0), { "control point 5", "place" });
  refused(edits->SetControlPointWeight(5, 0.0), { "control point 5", "cell 0", "positive" });
  refused(edits->SetControlPointWeight(5, -2.0), { "weight is -2" });
  refused(edits->SetControlPointWeight(5, NaN), { "weight", "finite" });
  refused(edits->SetControlPointWeight(5, Infinity), { "weight", "finite" });
  refused(edits->ScaleBlockControlPointWeights(0, someBad, 2.0), { "control point" });
  refused(edits->MoveBlockControlPoints(0, someBad, 1, 1, 1), { std::to_string(count) });
  refused(edits->MoveBlockControlPoint(7, 0, 1, 1, 1), { "block 7 is no NURBS model" });
  refused(edits->ResetControlPoint(count), { "control point" });

  EXPECT_EQ(edits->GetMTime(), time);
  EXPECT_EQ(edits->GetNumberOfUndos(), 1);
  EXPECT_EQ(edited.CountMoved(before), 0);
  // And the next good one works.
  EXPECT_TRUE(edits->MoveControlPoint(5, 0.5, 0.0, 0.0));
  EXPECT_GT(edited.CountMoved(before), 0);
  EXPECT_EQ(edited.Errors->Text, "");
}

TEST(ControlPointEdits, OverflowAndUnderflowOfSingles)
{
  auto grid = Shape(vtkNURBSShapeSource::SHEET);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  points->DeepCopy(grid->GetPoints());
  vtkNew<vtkPoints> singles;
  singles->SetDataTypeToFloat();
  vtkNew<vtkFloatArray> weights;
  weights->SetName("RationalWeights");
  for (vtkIdType k = 0; k < points->GetNumberOfPoints(); ++k)
  {
    singles->InsertNextPoint(points->GetPoint(k));
    weights->InsertNextValue(1.0f);
  }
  grid->SetPoints(singles);
  grid->GetPointData()->AddArray(weights);
  Edited edited(grid);
  EXPECT_FALSE(edited.Edits->MoveControlPoint(1, 1e300, 0.0, 0.0));
  EXPECT_TRUE(edited.Errors->Says("control point 1 "));
  EXPECT_FALSE(edited.Edits->SetControlPointWeight(1, 1e-60));
  EXPECT_TRUE(edited.Errors->Says("positive and finite"));
  EXPECT_FALSE(edited.Edits->SetControlPointWeight(1, 1e60));
  EXPECT_TRUE(edited.Edits->MoveControlPoint(1, 1e30, 0.0, 0.0));
  EXPECT_TRUE(edited.Edits->SetControlPointWeight(1, 0.5));
  EXPECT_EQ(edited.Update()->GetPoints()->GetDataType(), VTK_FLOAT);
  EXPECT_EQ(WeightOf(edited.Update(), 1), 0.5);

  Edited doubles(Shape(vtkNURBSShapeSource::SHEET));
  EXPECT_TRUE(doubles.Edits->MoveControlPoint(1, 1.7e308, 0.0, 0.0));
  EXPECT_FALSE(doubles.Edits->MoveControlPoint(1, 1.7e308, 0.0, 0.0)) << "the sum is infinite";
}

TEST(ControlPointEdits, UndoRedoAndReset)
{
  Edited edited(Shape(vtkNURBSShapeSource::SHEET));
  vtkNURBSControlPointEdits* edits = edited.Edits;
  EXPECT_FALSE(edits->Undo());
  edits->MoveControlPoint(1, 1, 0, 0);
  edits->MoveControlPoint(2, 1, 0, 0);
  edits->SetControlPointWeight(3, 2.0);
  EXPECT_EQ(edits->GetNumberOfEdits(), 3);
  edits->ResetControlPoint(1);
  EXPECT_EQ(edited.CountMoved(edited.Input), 1);
  edits->ResetControlPoints();
  EXPECT_EQ(edits->GetNumberOfEdits(), 0);
  EXPECT_EQ(edited.CountMoved(edited.Input), 0);
  EXPECT_TRUE(edits->Undo());
  EXPECT_TRUE(edits->Undo());
  EXPECT_EQ(edited.CountMoved(edited.Input), 2);
  EXPECT_EQ(WeightOf(edited.Update(), 3), 2.0);
  EXPECT_TRUE(edits->Undo());
  EXPECT_EQ(WeightOf(edited.Update(), 3), 1.0);
  EXPECT_TRUE(edits->Redo());
  EXPECT_EQ(WeightOf(edited.Update(), 3), 2.0);

  vtkNew<vtkUnstructuredGrid> before;
  before->DeepCopy(edited.Update());
  edits->BeginGroup();
  for (int k = 0; k < 10; ++k)
  {
    edits->MoveControlPoint(5, 0, 0, 1);
    edited.Update();
  }
  edits->EndGroup();
  EXPECT_EQ(PointOf(edited.Update(), 5), PointOf(before, 5) + nurbs::Vec3(0, 0, 10));
  EXPECT_TRUE(edits->Undo());
  EXPECT_EQ(edited.CountMoved(before), 0) << "ten moves, one step";
  edits->BeginGroup();
  edits->MoveControlPoint(6, 0, 0, 1);
  EXPECT_EQ(edited.CountMoved(before), 1);
  edits->CancelGroup();
  EXPECT_EQ(edited.CountMoved(before), 0);
  EXPECT_TRUE(edits->Redo()) << "of the ten moves";
  EXPECT_EQ(edited.CountMoved(before), 1);
}

TEST(ControlPointEdits, EditsBeforeTheInputHasData)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShapeToTorus();
  vtkNew<vtkNURBSControlPointEdits> edits;
  vtkNew<MessageKeeper> errors;
  edits->AddObserver(vtkCommand::ErrorEvent, errors);
  EXPECT_FALSE(edits->MoveControlPoint(0, NaN, 0, 0));
  EXPECT_TRUE(errors->Says("control point 0"));
  EXPECT_FALSE(edits->SetControlPointWeight(0, 0.0));
  EXPECT_FALSE(edits->MoveControlPoint(-3, 0, 0, 1));
  errors->Text.clear();
  EXPECT_TRUE(edits->MoveControlPoint(9, 0, 0, 1));
  edits->SetInputConnection(source->GetOutputPort());
  EXPECT_TRUE(edits->MoveControlPoint(1000, 0, 0, 1)) << "nobody knows yet";
  EXPECT_TRUE(edits->SetControlPointWeight(0, 2.0));
  EXPECT_TRUE(edits->SetControlPointWeight(1, 7.0));
  EXPECT_TRUE(edits->Undo());
  EXPECT_EQ(edits->GetNumberOfEdits(), 3);
  edits->Update();
  EXPECT_TRUE(errors->Says("control point 1000"));
  auto* output = vtkUnstructuredGrid::SafeDownCast(edits->GetOutputDataObject(0));
  auto* input = source->GetOutput();
  EXPECT_EQ(PointOf(output, 9), PointOf(input, 9) + nurbs::Vec3(0, 0, 1));
  EXPECT_EQ(PointOf(output, 17), PointOf(input, 17) + nurbs::Vec3(0, 0, 1)) << "the seam";
  EXPECT_EQ(WeightOf(output, 0), 2.0);
  EXPECT_EQ(WeightOf(output, 1), WeightOf(input, 1));
}

TEST(ControlPointEdits, AnInputThatChanges)
{
  Edited edited(Shape(vtkNURBSShapeSource::SHEET));
  edited.Edits->MoveControlPoint(5, 0, 0, 2);
  edited.Edits->SetControlPointPosition(6, 1, 2, 3);
  edited.Edits->MoveControlPoint(40, 0, 0, 2);
  edited.Edits->SetControlPointWeight(7, 4.0);
  vtkPoints* points = edited.Update()->GetPoints();

  // The same points moved in place, as a simulation may do.
  for (vtkIdType k = 0; k < edited.Input->GetNumberOfPoints(); ++k)
  {
    nurbs::Vec3 place = PointOf(edited.Input, k) + nurbs::Vec3(0, 100, 0);
    edited.Input->GetPoints()->SetPoint(k, place.data());
  }
  edited.Input->GetPoints()->Modified();
  edited.Input->Modified();
  vtkUnstructuredGrid* output = edited.Update();
  EXPECT_EQ(output->GetPoints(), points);
  EXPECT_EQ(PointOf(output, 5), PointOf(edited.Input, 5) + nurbs::Vec3(0, 0, 2));
  EXPECT_EQ(PointOf(output, 6), nurbs::Vec3(1, 2, 3));
  EXPECT_EQ(PointOf(output, 4), PointOf(edited.Input, 4));

  // Another, smaller model.
  auto smaller = Shape(vtkNURBSShapeSource::SHEET, 5);
  edited.Edits->SetInputDataObject(smaller);
  output = edited.Update();
  EXPECT_TRUE(edited.Errors->Says("no control point 40"));
  EXPECT_EQ(output->GetPoints(), points);
  ASSERT_EQ(output->GetNumberOfPoints(), 25);
  EXPECT_EQ(PointOf(output, 5), PointOf(smaller, 5) + nurbs::Vec3(0, 0, 2));
  EXPECT_EQ(WeightOf(output, 7), 4.0);
  EXPECT_EQ(vtkNURBSModel::Validate(output), "");

  // And back.
  edited.Errors->Text.clear();
  edited.Edits->SetInputDataObject(edited.Input);
  output = edited.Update();
  EXPECT_EQ(PointOf(output, 40), PointOf(edited.Input, 40) + nurbs::Vec3(0, 0, 2));
  EXPECT_EQ(edited.Errors->Text, "");
}

TEST(ControlPointEdits, BlocksOfAnAssembly)
{
  vtkNew<vtkPartitionedDataSetCollection> assembly;
  assembly->SetNumberOfPartitions(0, 1);
  assembly->SetNumberOfPartitions(1, 1);
  assembly->SetPartition(0, 0, Shape(vtkNURBSShapeSource::TORUS));
  assembly->SetPartition(1, 0, Shape(vtkNURBSShapeSource::SPHERE));
  vtkNew<vtkDataAssembly> tree;
  tree->AddNode("wheel");
  assembly->SetDataAssembly(tree);
  const unsigned int first = assembly->GetCompositeIndex(0, 0);
  const unsigned int second = assembly->GetCompositeIndex(1, 0);
  vtkNew<vtkNURBSControlPointEdits> edits;
  edits->SetInputDataObject(assembly);
  const auto leaf = [&](unsigned int part) {
    edits->Update();
    return vtkUnstructuredGrid::SafeDownCast(
      vtkPartitionedDataSetCollection::SafeDownCast(edits->GetOutputDataObject(0))
        ->GetPartition(part, 0));
  };
  vtkSmartPointer<vtkUnstructuredGrid> torus = leaf(0), sphere = leaf(1);
  EXPECT_EQ(
    torus->GetPoints(), vtkPointSet::SafeDownCast(assembly->GetPartition(0, 0))->GetPoints());
  EXPECT_NE(torus, assembly->GetPartition(0, 0));
  const vtkMTimeType time = torus->GetMTime();
  ASSERT_TRUE(edits->MoveBlockControlPoint(second, 40, 0, 0, 1));
  EXPECT_EQ(leaf(1), sphere);
  EXPECT_EQ(leaf(0), torus);
  EXPECT_EQ(torus->GetMTime(), time) << "nothing happened to the other block";
  EXPECT_EQ(PointOf(sphere, 40), PointOf(assembly->GetPartition(1, 0), 40) + nurbs::Vec3(0, 0, 1));
  ASSERT_TRUE(edits->MoveControlPoint(40, 0, 0, 2)) << "of the first model";
  EXPECT_EQ(PointOf(leaf(0), 40), PointOf(assembly->GetPartition(0, 0), 40) + nurbs::Vec3(0, 0, 2));
  double place[3];
  EXPECT_TRUE(edits->GetBlockControlPoint(first, 40, place));
  EXPECT_EQ(place[2], PointOf(torus, 40)[2]);
  EXPECT_FALSE(edits->GetBlockControlPoint(first, 4000, place));
  EXPECT_EQ(edits->GetBlockControlPointWeight(first, 4000), 0.0);
  auto* output = vtkPartitionedDataSetCollection::SafeDownCast(edits->GetOutputDataObject(0));
  ASSERT_TRUE(output->GetDataAssembly());
  EXPECT_EQ(std::string(output->GetDataAssembly()->GetNodeName(1)), "wheel");

  // A block that goes and comes back is up to date although it was edited meanwhile.
  vtkNew<vtkPartitionedDataSetCollection> without;
  without->SetNumberOfPartitions(0, 1);
  without->SetPartition(0, 0, assembly->GetPartition(0, 0));
  edits->SetInputDataObject(without);
  edits->Update();
  ASSERT_TRUE(edits->Undo());
  ASSERT_TRUE(edits->Undo());
  edits->Update();
  edits->SetInputDataObject(assembly);
  EXPECT_EQ(PointOf(leaf(1), 40), PointOf(assembly->GetPartition(1, 0), 40));
}

TEST(ControlPointEdits, AnInputThatIsNoModel)
{
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(0, 0, 0);
  grid->SetPoints(points);
  const vtkIdType id = 0;
  grid->InsertNextCell(VTK_VERTEX, 1, &id);
  Edited edited(vtkSmartPointer<vtkUnstructuredGrid>(grid.Get()));
  EXPECT_EQ(edited.Update()->GetNumberOfPoints(), 1);
  EXPECT_TRUE(edited.Errors->Says("no NURBS model"));
  Edited empty(vtkSmartPointer<vtkUnstructuredGrid>::New());
  EXPECT_EQ(empty.Update()->GetNumberOfPoints(), 0);
  EXPECT_EQ(empty.Errors->Text, "");
}

// One control point of a million: the first edit copies the points, later ones cost next to nothing.
TEST(ControlPointEdits, OneOfAMillion)
{
  using namespace std::chrono;
  const auto micros = [](auto from) {
    return duration<double, std::micro>(steady_clock::now() - from).count();
  };
  Edited edited(Shape(vtkNURBSShapeSource::SHEET, 1000));
  edited.Update();
  auto start = steady_clock::now();
  ASSERT_TRUE(edited.Edits->MoveControlPoint(500500, 0, 0, 1));
  edited.Update();
  const double first = micros(start);
  std::vector<double> times;
  for (int k = 0; k < 1000; ++k)
  {
    start = steady_clock::now();
    edited.Edits->MoveControlPoint(997 * k, 0, 0, 1);
    edited.Edits->Update();
    times.push_back(micros(start));
  }
  std::nth_element(times.begin(), times.begin() + 500, times.end());
  std::printf("an edit of 1 of 1,000,000 control points: %.0f us the first, %.1f us the others "
              "(median)\n",
    first, times[500]);
  EXPECT_LT(times[500], first / 20.0);
  EXPECT_EQ(edited.CountMoved(edited.Input), 1001);
}

} // namespace
