// SPDX-License-Identifier: BSD-3-Clause
// The model as VTK data: it stays valid through ordinary VTK filters and files, arrays of other
// types are converted, and wrong ones are named.
#include "vtkNURBSControlNet.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"
#include "vtkNURBSShapeSource.h"
#include "vtkNURBSToBezierCells.h"

#include "vtkArrayCalculator.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkExtractSelection.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationStringKey.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSMPTools.h"
#include "vtkSelection.h"
#include "vtkSelectionNode.h"
#include "vtkStringArray.h"
#include "vtkThreshold.h"
#include "vtkTransform.h"
#include "vtkTransformFilter.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"
#include "vtkXMLUnstructuredGridReader.h"
#include "vtkXMLUnstructuredGridWriter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

namespace
{

using Grid = vtkSmartPointer<vtkUnstructuredGrid>;

Grid Make(int shape)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShape(shape);
  source->SetNumberOfPatches(60);
  source->Update();
  auto copy = Grid::New();
  copy->DeepCopy(source->GetOutput());
  return copy;
}

/// Compares a face with the one of the same FaceId in `reference`: points, loops, edges.
void ExpectSameFace(const nurbs::Model& model, const nurbs::Face& face,
  const nurbs::Model& reference, double scale = 1.0)
{
  const nurbs::Face& other = reference.Faces.at(face.FaceId);
  ASSERT_EQ(face.LoopCount, other.LoopCount);
  EXPECT_EQ(face.Reversed, other.Reversed);
  const nurbs::Interval u = other.Geometry.Domain(0), v = other.Geometry.Domain(1);
  for (const double part : { 0.0, 0.21, 0.5, 0.93, 1.0 })
  {
    const double s = u.Min + part * u.Length(), t = v.Max - part * v.Length();
    EXPECT_LE(
      (nurbs::Evaluate(face.Geometry, s, t) - scale * nurbs::Evaluate(other.Geometry, s, t)).norm(),
      1e-9);
  }
  for (std::int64_t l = 0; l < face.LoopCount; ++l)
  {
    const nurbs::TrimLoop& a = model.Loops[face.FirstLoop + l];
    const nurbs::TrimLoop& b = reference.Loops[other.FirstLoop + l];
    ASSERT_EQ(a.CurveCount, b.CurveCount);
    for (std::int64_t c = 0; c < a.CurveCount; ++c)
    {
      const nurbs::TrimCurve& x = model.TrimCurves[a.FirstCurve + c];
      const nurbs::TrimCurve& y = reference.TrimCurves[b.FirstCurve + c];
      EXPECT_EQ(x.Edge, y.Edge);
      EXPECT_EQ(x.Reversed, y.Reversed);
      EXPECT_EQ(x.Geometry.Count, y.Geometry.Count);
      EXPECT_EQ(x.Geometry.Point(0), y.Geometry.Point(0));
    }
  }
}

void ExpectPartOf(vtkUnstructuredGrid* part, vtkUnstructuredGrid* whole, vtkIdType cells)
{
  EXPECT_EQ(part->GetNumberOfCells(), cells);
  EXPECT_EQ(vtkNURBSModel::Validate(part), "");
  EXPECT_TRUE(vtkNURBSModel::IsModel(part));
  const auto view = vtkNURBSModel::View(part), reference = vtkNURBSModel::View(whole);
  for (const nurbs::Face& face : view->GetModel().Faces)
  {
    ExpectSameFace(view->GetModel(), face, reference->GetModel());
  }
}

TEST(ModelInPipelines, ThresholdKeepsIt)
{
  const Grid whole = Make(vtkNURBSShapeSource::CAR_BODY);
  vtkNew<vtkThreshold> threshold;
  threshold->SetInputData(whole);
  threshold->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, vtkNURBSModel::FaceIdName());
  threshold->SetThresholdFunction(vtkThreshold::THRESHOLD_BETWEEN);
  threshold->SetLowerThreshold(20);
  threshold->SetUpperThreshold(44);
  threshold->Update();
  ExpectPartOf(threshold->GetOutput(), whole, 25);
  EXPECT_EQ(vtkNURBSModel::GetFaceId(threshold->GetOutput(), 3), 23);
  EXPECT_EQ(vtkNURBSModel::GetLengthUnit(threshold->GetOutput()), "mm");
}

TEST(ModelInPipelines, ExtractSelectionKeepsIt)
{
  const Grid whole = Make(vtkNURBSShapeSource::CAR_BODY);
  vtkNew<vtkIdTypeArray> ids;
  for (const vtkIdType id : { 3, 17, 59 })
  {
    ids->InsertNextValue(id);
  }
  vtkNew<vtkSelectionNode> node;
  node->SetContentType(vtkSelectionNode::INDICES);
  node->SetFieldType(vtkSelectionNode::CELL);
  node->SetSelectionList(ids);
  vtkNew<vtkSelection> selection;
  selection->AddNode(node);
  vtkNew<vtkExtractSelection> extract;
  extract->SetInputData(0, whole);
  extract->SetInputData(1, selection);
  extract->Update();
  ExpectPartOf(vtkUnstructuredGrid::SafeDownCast(extract->GetOutput()), whole, 3);
}

TEST(ModelInPipelines, CalculatorKeepsItAndAddsAttributes)
{
  const Grid whole = Make(vtkNURBSShapeSource::TEAPOT);
  vtkNew<vtkArrayCalculator> calculator;
  calculator->SetInputData(whole);
  calculator->SetAttributeTypeToCellData();
  calculator->AddScalarArrayName(vtkNURBSModel::FaceIdName());
  calculator->SetFunction("2 * FaceId");
  calculator->SetResultArrayName("Doubled");
  calculator->Update();
  auto* result = vtkUnstructuredGrid::SafeDownCast(calculator->GetOutput());
  ExpectPartOf(result, whole, 32);

  vtkNew<vtkIdTypeArray> faces;
  faces->InsertNextValue(31);
  faces->InsertNextValue(2);
  vtkNew<vtkCellData> attributes;
  vtkNURBSModel::CopyFaceAttributes(result, faces, attributes);
  EXPECT_EQ(attributes->GetNumberOfArrays(), 4); // FaceId, Color, Name, Doubled.
  EXPECT_EQ(attributes->GetArray("Doubled")->GetTuple1(0), 62.0);
  EXPECT_EQ(vtkStringArray::SafeDownCast(attributes->GetAbstractArray(vtkNURBSModel::NameName()))
              ->GetValue(0),
    "spout");
  EXPECT_EQ(attributes->GetArray(vtkNURBSModel::FaceIdName())->GetTuple1(1), 2.0);
}

TEST(ModelInPipelines, TransformMovesItAndReleasesEdges)
{
  for (const int shape : { static_cast<int>(vtkNURBSShapeSource::CAR_BODY),
         static_cast<int>(vtkNURBSShapeSource::SPHERE) })
  {
    const Grid whole = Make(shape);
    vtkNew<vtkTransform> transform;
    transform->Scale(3.0, 3.0, 3.0);
    vtkNew<vtkTransformFilter> filter;
    filter->SetTransform(transform);
    filter->SetInputData(whole);
    filter->Update();
    auto* moved = vtkUnstructuredGrid::SafeDownCast(filter->GetOutput());
    const auto view = vtkNURBSModel::View(moved), reference = vtkNURBSModel::View(whole);
    ASSERT_EQ(view->GetProblems().size(), 1u);
    EXPECT_EQ(view->GetProblems()[0].Severity, nurbs::ModelProblem::Level::Warning);
    for (const nurbs::Face& face : view->GetModel().Faces)
    {
      ExpectSameFace(view->GetModel(), face, reference->GetModel(), 3.0);
    }
    for (std::size_t i = 0; i < view->GetModel().Vertices.size(); ++i)
    {
      EXPECT_LE(
        (view->GetModel().Vertices[i] - 3.0 * reference->GetModel().Vertices[i]).norm(), 1e-8);
    }
  }
}

Grid WrittenAndRead(vtkUnstructuredGrid* grid, int mode)
{
  const std::string path = std::string(NURBS_TEST_OUTPUT) + "/model.vtu";
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputData(grid);
  writer->SetFileName(path.c_str());
  writer->SetDataMode(mode);
  EXPECT_EQ(writer->Write(), 1);
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  return reader->GetOutput();
}

TEST(ModelInPipelines, XmlFilesKeepIt)
{
  const Grid whole = Make(vtkNURBSShapeSource::CAR_BODY);
  std::vector<int> modes = { vtkXMLWriter::Ascii, vtkXMLWriter::Binary };
  // VTK 9.2 reads no appended data, of whatever grid, where expat has been updated.
  const Grid plain = Grid::New();
  plain->CopyStructure(whole);
  vtkObject::GlobalWarningDisplayOff();
  if (WrittenAndRead(plain, vtkXMLWriter::Appended)->GetNumberOfPoints() > 0)
  {
    modes.push_back(vtkXMLWriter::Appended);
  }
  vtkObject::GlobalWarningDisplayOn();
  for (const int mode : modes)
  {
    const Grid read = WrittenAndRead(whole, mode);
    ExpectPartOf(read, whole, 60);
    EXPECT_EQ(vtkNURBSModel::GetLengthUnit(read), "mm");
  }
}

TEST(ModelArrays, DoublesAndInt64AreNotCopied)
{
  const Grid grid = Make(vtkNURBSShapeSource::SPHERE);
  const auto view = vtkNURBSModel::View(grid);
  const nurbs::SurfaceView& sphere = view->GetModel().Faces[0].Geometry;
  EXPECT_EQ(sphere.Points, grid->GetPoints()->GetVoidPointer(0));
  EXPECT_EQ(sphere.Weights, grid->GetPointData()->GetArray(0)->GetVoidPointer(0));
  EXPECT_EQ(static_cast<const void*>(sphere.Ids),
    grid->GetCells()->GetConnectivityArray()->GetVoidPointer(0));
}

TEST(ModelArrays, ViewOutlivesTheGrid)
{
  Grid grid = Make(vtkNURBSShapeSource::SPHERE);
  const auto view = vtkNURBSModel::View(grid);
  grid = nullptr;
  EXPECT_NEAR(nurbs::Evaluate(view->GetModel().Faces[0].Geometry, 1.3, 0.7).norm(), 1.0, 1e-12);
}

TEST(ModelArrays, OtherTypesAreConverted)
{
  const Grid whole = Make(vtkNURBSShapeSource::TEAPOT);
  const Grid grid = Grid::New();
  grid->DeepCopy(whole);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  points->DeepCopy(whole->GetPoints());
  ASSERT_EQ(points->GetDataType(), VTK_FLOAT);
  grid->SetPoints(points);
  grid->GetCells()->ConvertTo32BitStorage();
  for (const char* name : { "Degree", "KnotStart", "LoopStart", "FaceId" })
  {
    vtkDataArray* from = grid->GetCellData()->GetArray(name);
    vtkNew<vtkUnsignedCharArray> narrow;
    vtkNew<vtkIntArray> wide;
    vtkDataArray* to = !strcmp(name, "Degree") ? static_cast<vtkDataArray*>(narrow)
                                               : static_cast<vtkDataArray*>(wide);
    to->DeepCopy(from);
    to->SetName(name);
    grid->GetCellData()->AddArray(to);
  }
  const auto view = vtkNURBSModel::View(grid), reference = vtkNURBSModel::View(whole);
  // Rounding to floats moved the control points by less than the negligible part.
  EXPECT_EQ(vtkNURBSModel::Validate(grid), "");
  ASSERT_EQ(view->GetModel().Faces.size(), 32u);
  const nurbs::Vec3 a = nurbs::Evaluate(view->GetModel().Faces[9].Geometry, 0.3, 0.4);
  const nurbs::Vec3 b = nurbs::Evaluate(reference->GetModel().Faces[9].Geometry, 0.3, 0.4);
  EXPECT_LE((a - b).norm(), 1e-6);
  EXPECT_GT((a - b).norm(), 0.0);
}

void ExpectError(vtkUnstructuredGrid* grid, const std::string& part)
{
  const std::string text = vtkNURBSModel::Validate(grid);
  EXPECT_NE(text.find("error: "), std::string::npos) << text;
  EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' in\n" << text;
  std::vector<nurbs::ModelProblem> problems;
  EXPECT_FALSE(vtkNURBSModel::Validate(grid, problems));
}

TEST(ModelArrays, MissingAndWrongArraysAreNamed)
{
  for (const char* name : { "Degree", "NetSize", "KnotStart", "LoopStart" })
  {
    const Grid grid = Make(vtkNURBSShapeSource::SPHERE);
    grid->GetCellData()->RemoveArray(name);
    ExpectError(grid, std::string("array ") + name + " is missing");
  }
  for (const char* name : { "Knots", "TrimCurveDegree", "TrimPoints", "TrimKnots" })
  {
    const Grid grid = Make(vtkNURBSShapeSource::SPHERE);
    grid->GetFieldData()->RemoveArray(name);
    ExpectError(grid, std::string("array ") + name + " is missing");
  }
  const Grid grid = Make(vtkNURBSShapeSource::SPHERE);
  vtkNew<vtkDoubleArray> real;
  real->SetName("Degree");
  real->SetNumberOfComponents(2);
  real->InsertNextTuple2(2, 2);
  grid->GetCellData()->AddArray(real);
  ExpectError(grid, "array Degree holds reals instead of integers");
  real->SetNumberOfComponents(3);
  real->SetNumberOfTuples(1);
  ExpectError(grid, "array Degree has 3 components instead of 2");
  vtkNew<vtkStringArray> text;
  text->SetName("Degree");
  text->InsertNextValue("two");
  grid->GetCellData()->AddArray(text);
  ExpectError(grid, "array Degree is not numeric");
}

TEST(ModelArrays, ProblemsNameCellAndFace)
{
  const Grid grid = Make(vtkNURBSShapeSource::TEAPOT);
  vtkNew<vtkTypeInt64Array> ids;
  ids->SetName(vtkNURBSModel::FaceIdName());
  for (int i = 0; i < 32; ++i)
  {
    ids->InsertNextValue(100 + i);
  }
  grid->GetCellData()->AddArray(ids);
  grid->GetPoints()->SetPoint(16 * 7 + 3, std::nan(""), 0, 0);
  EXPECT_EQ(
    vtkNURBSModel::Validate(grid), "error: cell 7 (FaceId 107): control point 3 is not finite");
  const auto view = vtkNURBSModel::View(grid);
  EXPECT_EQ(view->GetFaceError(7), "control point 3 is not finite");
  EXPECT_EQ(view->GetFaceError(8), "");
  EXPECT_EQ(vtkNURBSModel::GetFaceId(grid, 7), 107);
}

TEST(ModelArrays, CompositesNameTheirBlocks)
{
  const Grid good = Make(vtkNURBSShapeSource::SPHERE), bad = Make(vtkNURBSShapeSource::SPHERE);
  bad->GetPoints()->SetPoint(0, std::nan(""), 0, 0);
  vtkNew<vtkPartitionedDataSetCollection> assembly;
  assembly->SetPartition(0, 0, good);
  EXPECT_EQ(vtkNURBSModel::Validate(assembly), "");
  assembly->SetPartition(1, 0, bad);
  vtkNew<vtkPolyData> foreign;
  assembly->SetPartition(2, 0, foreign);
  assembly->GetMetaData(1u)->Set(vtkCompositeDataSet::NAME(), "wheel");
  EXPECT_EQ(vtkNURBSModel::Validate(assembly),
    "block 1 (wheel): error: cell 0 (FaceId 0): control point 0 is not finite\n"
    "block 2: error: a vtkPolyData is no vtkUnstructuredGrid");
}

TEST(ModelInPipelines, AssembliesPassThroughTheFilters)
{
  vtkNew<vtkPartitionedDataSetCollection> assembly;
  assembly->SetPartition(0, 0, Make(vtkNURBSShapeSource::SPHERE));
  assembly->SetPartition(1, 0, Make(vtkNURBSShapeSource::TEAPOT));
  vtkNew<vtkNURBSControlNet> net;
  net->SetInputDataObject(assembly);
  net->Update();
  auto* nets = vtkPartitionedDataSetCollection::SafeDownCast(net->GetOutputDataObject(0));
  ASSERT_NE(nets, nullptr);
  EXPECT_EQ(
    vtkPolyData::SafeDownCast(nets->GetPartitionAsDataObject(1, 0))->GetNumberOfVerts(), 32);
}

TEST(ModelArrays, ProblemsDoNotDependOnThreads)
{
  const Grid grid = Make(vtkNURBSShapeSource::CAR_BODY);
  for (vtkIdType point = 5; point < grid->GetNumberOfPoints(); point += 250)
  {
    grid->GetPoints()->SetPoint(point, std::nan(""), 0, 0);
  }
  const std::string serial = vtkNURBSModel::Validate(grid);
  EXPECT_EQ(std::count(serial.begin(), serial.end(), '\n'), 8); // Every 250th of 60 x 36 points.
  std::string threaded;
  vtkSMPTools::LocalScope(vtkSMPTools::Config{ 4, "STDThread", true },
    [&threaded, &grid]() { threaded = vtkNURBSModel::Validate(grid); });
  EXPECT_EQ(serial, threaded);
}

TEST(ModelArrays, EmptyAndForeignGrids)
{
  EXPECT_EQ(vtkNURBSModel::Validate(nullptr), "error: there is no grid");
  EXPECT_TRUE(vtkNURBSModel::View(nullptr)->GetModel().Faces.empty());
  const Grid empty = Grid::New();
  EXPECT_EQ(vtkNURBSModel::Validate(empty), "");
  EXPECT_FALSE(vtkNURBSModel::IsModel(empty));
  EXPECT_EQ(vtkNURBSModel::GetLengthUnit(empty), "");
  const Grid triangle = Grid::New();
  vtkNew<vtkPoints> points;
  const vtkIdType ids[3] = { points->InsertNextPoint(0, 0, 0), points->InsertNextPoint(1, 0, 0),
    points->InsertNextPoint(0, 1, 0) };
  triangle->SetPoints(points);
  triangle->Allocate(1);
  triangle->InsertNextCell(VTK_TRIANGLE, 3, ids);
  ExpectError(triangle, "array Degree is missing");
}

/// Removes, retypes, resizes or overwrites one array of `data`.
void Damage(vtkFieldData* data, std::mt19937& random)
{
  const auto pick = [&random](int count) { return static_cast<int>(random() % count); };
  vtkAbstractArray* array = data->GetAbstractArray(pick(data->GetNumberOfArrays()));
  vtkDataArray* numbers = vtkDataArray::SafeDownCast(array);
  const int types[] = { VTK_CHAR, VTK_UNSIGNED_INT, VTK_FLOAT, VTK_DOUBLE, VTK_ID_TYPE, VTK_BIT };
  const double values[] = { -1, 0, 1, 2, 26, 1e9, 9e18, -9e18, 1e300, std::nan("") };
  switch (numbers && array->GetNumberOfTuples() > 0 ? pick(5) : 0)
  {
    case 0:
      data->RemoveArray(array->GetName());
      break;
    case 1:
      array->Resize(pick(static_cast<int>(array->GetNumberOfTuples()) + 1));
      break;
    case 2:
    {
      vtkSmartPointer<vtkDataArray> other;
      other.TakeReference(vtkDataArray::CreateDataArray(types[pick(6)]));
      other->SetName(array->GetName());
      other->SetNumberOfComponents(pick(4) ? array->GetNumberOfComponents() : 1 + pick(4));
      other->SetNumberOfTuples(array->GetNumberOfTuples());
      other->Fill(1.0);
      data->AddArray(other);
      break;
    }
    default:
      numbers->SetComponent(pick(static_cast<int>(array->GetNumberOfTuples())),
        pick(array->GetNumberOfComponents()), values[pick(10)]);
  }
}

TEST(ModelArrays, NoDamageCrashesTheFilters)
{
  vtkObject::GlobalWarningDisplayOff();
  const Grid sound = Make(vtkNURBSShapeSource::CYLINDER);
  std::mt19937 random(7);
  int good = 0, bad = 0;
  for (int k = 0; k < 500; ++k)
  {
    const Grid grid = Grid::New();
    grid->DeepCopy(sound);
    for (std::mt19937::result_type damage = random() % 3; damage-- > 0;)
    {
      vtkFieldData* kinds[] = { grid->GetPointData(), grid->GetCellData(), grid->GetFieldData() };
      vtkFieldData* data = kinds[random() % 3];
      if (data->GetNumberOfArrays() > 0)
      {
        Damage(data, random);
      }
    }
    ++(vtkNURBSModel::Validate(grid).empty() ? good : bad);
    vtkNew<vtkNURBSControlNet> net;
    net->SetInputData(grid);
    net->GenerateQuadsOn();
    net->Update();
    vtkNew<vtkNURBSToBezierCells> cells;
    cells->SetInputData(grid);
    cells->Update();
  }
  vtkObject::GlobalWarningDisplayOn();
  EXPECT_GT(good, 100);
  EXPECT_GT(bad, 100);
}

TEST(ModelArrays, UnconvertedFacesAreKept)
{
  const Grid grid = Make(vtkNURBSShapeSource::SPHERE);
  EXPECT_TRUE(vtkNURBSModel::GetUnconvertedFaces(grid).empty());
  vtkNURBSModel::SetUnconvertedFaces(grid, { "7: no surface", "9: no pcurve" });
  EXPECT_EQ(vtkNURBSModel::GetUnconvertedFaces(grid).at(1), "9: no pcurve");
}

} // namespace
