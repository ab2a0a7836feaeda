// SPDX-License-Identifier: BSD-3-Clause
// What vtkNURBSCADWriter puts into files beside geometry: units, trees, names, colours; and bad input.
#include "testCADWriting.h"

#include "vtkCallbackCommand.h"
#include "vtkCellData.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataAssembly.h"
#include "vtkErrorCode.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkPoints.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

TEST(CADWriterFiles, UnitsAreHonoured)
{
  nurbs::ModelBuilder builder;
  const nurbs::Surface patch = Patch(3.0);
  builder.BeginFace(patch.View(), nurbs::FaceAttributes());
  builder.LengthUnit = "in";
  const auto model = Store(builder);
  for (const char* ending : { "step", "iges" })
  {
    SCOPED_TRACE(ending);
    vtkNew<vtkNURBSCADReader> reader;
    reader->SetFileName(Write(model, std::string("inch.") + ending).c_str());
    reader->SetLengthUnitToFileUnit();
    const Grids own = Models(reader);
    ASSERT_EQ(own.size(), 1u);
    EXPECT_EQ(vtkNURBSModel::GetLengthUnit(own[0]), "in");
    EXPECT_NEAR(own[0]->GetBounds()[1], 4.0, 1e-12);
    reader->SetLengthUnitToMillimetres();
    EXPECT_NEAR(Models(reader)[0]->GetBounds()[1], 4.0 * 25.4, 1e-11);
  }
  EXPECT_NEAR(ReadOne(Write(model, "inch.brep"))->GetBounds()[1], 4.0 * 25.4, 1e-11);
}

/// car: wheel (once as "left"), body; both with colours.
vtkSmartPointer<vtkPartitionedDataSetCollection> Car()
{
  auto car = vtkSmartPointer<vtkPartitionedDataSetCollection>::New();
  car->SetNumberOfPartitionedDataSets(2);
  const unsigned char colors[][3] = { { 10, 20, 30 }, { 200, 100, 50 }, { 10, 20, 30 } };
  for (unsigned int i = 0; i < 2; ++i)
  {
    auto part = i == 0 ? TwoPatches(0.0) : Shape(vtkNURBSShapeSource::CYLINDER);
    vtkNew<vtkUnsignedCharArray> color;
    color->SetName(vtkNURBSModel::ColorName());
    color->SetNumberOfComponents(3);
    for (vtkIdType f = 0; f < part->GetNumberOfCells(); ++f)
    {
      color->InsertNextTypedTuple(colors[f]);
    }
    part->GetCellData()->AddArray(color);
    if (i == 0)
    {
      SetNames(part, std::string(Greek) + " ");
    }
    car->SetPartition(i, 0, part);
    car->GetMetaData(i)->Set(vtkCompositeDataSet::NAME(), i == 0 ? "wheel" : "body & soul");
  }
  return car;
}

void GrowTree(vtkPartitionedDataSetCollection* car)
{
  vtkNew<vtkDataAssembly> tree;
  tree->SetRootNodeName("file");
  const int root = vtkDataAssembly::GetRootNode();
  const int top = tree->AddNode("car", root);
  tree->SetAttribute(top, "label", Greek);
  const int wheel = tree->AddNode("wheel", top);
  tree->SetAttribute(wheel, "label", "wheel");
  tree->SetAttribute(wheel, "instance", "left");
  tree->AddDataSetIndex(wheel, 0);
  const int body = tree->AddNode("body", top);
  tree->SetAttribute(body, "label", "body & soul");
  tree->AddDataSetIndex(body, 1);
  tree->AddNode("nothing", top);
  car->SetDataAssembly(tree);
}

TEST(CADWriterFiles, TreeNamesAndColoursComeBackFromSTEP)
{
  const auto car = Car();
  GrowTree(car);
  vtkNew<vtkNURBSCADReader> reader;
  reader->SetFileName(Write(car, "car.step").c_str());
  const Grids parts = Models(reader);
  ASSERT_EQ(parts.size(), 2u);
  vtkDataAssembly* tree = reader->GetOutput()->GetDataAssembly();
  const std::vector<int> top = tree->GetChildNodes(vtkDataAssembly::GetRootNode(), false);
  ASSERT_EQ(top.size(), 1u);
  EXPECT_STREQ(tree->GetAttributeOrDefault(top[0], "label", ""), Greek);
  const std::vector<int> below = tree->GetChildNodes(top[0], false);
  ASSERT_EQ(below.size(), 2u);
  EXPECT_STREQ(tree->GetAttributeOrDefault(below[0], "label", ""), "wheel");
  EXPECT_STREQ(tree->GetAttributeOrDefault(below[0], "instance", ""), "left");
  EXPECT_STREQ(tree->GetAttributeOrDefault(below[1], "label", ""), "body & soul");
  for (std::size_t i = 0; i < 2; ++i)
  {
    auto* before = vtkUnstructuredGrid::SafeDownCast(car->GetPartition(unsigned(i), 0));
    auto* colors = vtkUnsignedCharArray::SafeDownCast(parts[i]->GetCellData()->GetArray("Color"));
    auto* own = vtkUnsignedCharArray::SafeDownCast(before->GetCellData()->GetArray("Color"));
    ASSERT_NE(colors, nullptr);
    ASSERT_EQ(colors->GetNumberOfValues(), own->GetNumberOfValues());
    for (vtkIdType k = 0; k < own->GetNumberOfValues(); ++k)
    {
      EXPECT_EQ(colors->GetValue(k), own->GetValue(k)) << "part " << i;
    }
  }
  auto* names = vtkStringArray::SafeDownCast(parts[0]->GetCellData()->GetAbstractArray("Name"));
  EXPECT_EQ(names->GetValue(0), std::string(Greek) + " 0");
  EXPECT_EQ(names->GetValue(1), std::string(Greek) + " 1");
}

TEST(CADWriterFiles, BlocksWithoutATreeGetOne)
{
  vtkNew<vtkNURBSCADReader> reader;
  reader->SetFileName(Write(Car(), "blocks.step").c_str());
  reader->Update();
  vtkDataAssembly* tree = reader->GetOutput()->GetDataAssembly();
  const std::vector<int> top = tree->GetChildNodes(vtkDataAssembly::GetRootNode(), false);
  ASSERT_EQ(top.size(), 1u);
  EXPECT_STREQ(tree->GetAttributeOrDefault(top[0], "label", ""), "blocks");
  EXPECT_EQ(tree->GetChildNodes(top[0], false).size(), 2u);
}

TEST(CADWriterFiles, ColoursComeBackFromIGES)
{
  const auto grid = ReadOne(Write(Car(), "car.igs"));
  auto* colors = vtkUnsignedCharArray::SafeDownCast(grid->GetCellData()->GetArray("Color"));
  ASSERT_NE(colors, nullptr);
  ASSERT_EQ(grid->GetNumberOfCells(), 5);
  const int reds[] = { 10, 200, 10, 10, 200 }; // Solids come first.
  for (vtkIdType i = 0; i < 5; ++i)
  {
    EXPECT_EQ(colors->GetTypedComponent(i, 0), reds[i]) << i;
  }
}

TEST(CADWriterFiles, PiecesFitTogether)
{
  vtkNew<vtkPartitionedDataSetCollection> pieces;
  pieces->SetNumberOfPartitionedDataSets(1);
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShapeToCylinder();
  for (int piece = 0; piece < 2; ++piece)
  {
    source->UpdatePiece(piece, 2, 0);
    vtkNew<vtkUnstructuredGrid> copy;
    copy->DeepCopy(source->GetOutput());
    ASSERT_GT(copy->GetNumberOfCells(), 0);
    pieces->SetPartition(0, piece, copy);
  }
  const TopoDS_Shape whole = ReadShape(Write(Shape(vtkNURBSShapeSource::CYLINDER), "whole.step"));
  const TopoDS_Shape parted = ReadShape(Write(pieces, "pieces.step"));
  EXPECT_EQ(CountOf(whole, TopAbs_SOLID), 1);
  EXPECT_EQ(CountOf(parted, TopAbs_SOLID), 1);
  EXPECT_EQ(SharedEdges(parted), SharedEdges(whole));
}

TEST(CADWriterFiles, OneGridInTwoPlaces)
{
  const auto part = Shape(vtkNURBSShapeSource::CYLINDER);
  vtkNew<vtkPartitionedDataSetCollection> both;
  both->SetNumberOfPartitionedDataSets(2);
  const char* names[] = { "left", "right" };
  for (unsigned int i = 0; i < 2; ++i)
  {
    both->SetPartition(i, 0, part);
    both->GetMetaData(i)->Set(vtkCompositeDataSet::NAME(), names[i]);
  }
  vtkNew<vtkNURBSCADReader> reader;
  reader->SetFileName(Write(both, "both.step").c_str());
  reader->Update();
  auto* read = vtkPartitionedDataSetCollection::SafeDownCast(reader->GetOutputDataObject(0));
  ASSERT_EQ(read->GetNumberOfPartitionedDataSets(), 2u);
  for (unsigned int i = 0; i < 2; ++i)
  {
    EXPECT_STREQ(read->GetMetaData(i)->Get(vtkCompositeDataSet::NAME()), names[i]);
  }
}

TEST(CADWriterFiles, ProgressGrows)
{
  vtkNew<vtkNURBSCADWriter> writer;
  std::vector<double> seen;
  vtkNew<vtkCallbackCommand> watch;
  watch->SetClientData(&seen);
  watch->SetCallback([](vtkObject*, unsigned long, void* client, void* amount) {
    static_cast<std::vector<double>*>(client)->push_back(*static_cast<const double*>(amount));
  });
  writer->AddObserver(vtkCommand::ProgressEvent, watch);
  const auto model = ReadOne("/usr/share/opencascade/data/step/screw.step");
  Write(writer, model, "progress.step");
  EXPECT_GT(seen.size(), 5u);
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
  EXPECT_EQ(seen.back(), 1.0);
}

TEST(CADWriterFiles, AbortLeavesWhatWasThere)
{
  const auto model = ReadOne("/usr/share/opencascade/data/step/screw.step");
  const std::string folder = OutputPath("aborted");
  const std::string path = folder + "/model.step";
  for (const double part : { 0.0, 0.7 }) // While shapes are built, and while the file is written.
  {
    for (const bool exists : { false, true })
    {
      std::filesystem::remove_all(folder);
      std::filesystem::create_directory(folder);
      if (exists)
      {
        std::ofstream(path) << "precious";
      }
      vtkNew<vtkNURBSCADWriter> writer;
      double until = part;
      vtkNew<vtkCallbackCommand> stop;
      stop->SetClientData(&until);
      stop->SetCallback([](vtkObject* caller, unsigned long, void* client, void* amount) {
        if (*static_cast<const double*>(amount) >= *static_cast<const double*>(client))
        {
          static_cast<vtkNURBSCADWriter*>(caller)->SetAbortExecute(1);
        }
      });
      writer->AddObserver(vtkCommand::ProgressEvent, stop);
      vtkNew<MessageKeeper> keeper;
      writer->AddObserver(vtkCommand::ErrorEvent, keeper);
      writer->SetInputDataObject(model);
      writer->SetFileName(path.c_str());
      EXPECT_FALSE(writer->Write());
      EXPECT_EQ(keeper->Text, "");
      EXPECT_EQ(writer->GetNumberOfFaces(), 0);
      std::string content;
      std::getline(std::ifstream(path), content);
      EXPECT_EQ(content, exists ? "precious" : "");
      const auto files = std::filesystem::directory_iterator(folder);
      EXPECT_EQ(std::distance(begin(files), end(files)), exists ? 1 : 0);
    }
  }
}

TEST(BadCADWriting, EachGivesOneClearError)
{
  const auto model = Shape(vtkNURBSShapeSource::CYLINDER);
  const auto expect = [](vtkDataObject* input, const std::string& path, const char* says,
                        const std::function<void(vtkNURBSCADWriter*)>& change = nullptr) {
    Listened listened;
    listened.Writer->SetInputDataObject(input);
    listened.Writer->SetFileName(path.c_str());
    if (change)
    {
      change(listened.Writer);
    }
    EXPECT_FALSE(listened.Writer->Write());
    EXPECT_TRUE(listened.Errors->Says(says)) << listened.Errors->Text;
    EXPECT_NE(listened.Writer->GetErrorCode(), vtkErrorCode::NoError);
    EXPECT_EQ(listened.Writer->GetNumberOfFaces(), 0);
    EXPECT_FALSE(std::filesystem::is_regular_file(path)) << path;
  };
  expect(model, "", "FileName is not set");
  expect(model, OutputPath("model.stl"), "CAD files are .step");
  expect(model, OutputPath("no/such/folder/model.step"), "cannot write");
  std::filesystem::create_directory(OutputPath("folder.step"));
  expect(model, OutputPath("folder.step"), "it is a directory");
  expect(model, OutputPath("x.step"), "Gap must not be negative",
    [](vtkNURBSCADWriter* writer) { writer->SetGap(-1.0); });
  expect(model, OutputPath("x.step"), "CurveTolerance must be positive",
    [](vtkNURBSCADWriter* writer) { writer->SetCurveTolerance(0.0); });
  expect(vtkNew<vtkUnstructuredGrid>(), OutputPath("x.step"), "there is no face");
  vtkNew<vtkUnstructuredGrid> other;
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(0, 0, 0);
  other->SetPoints(points);
  const vtkIdType id = 0;
  other->InsertNextCell(VTK_VERTEX, 1, &id);
  expect(other, OutputPath("x.step"), "not a NURBS model");
  vtkNew<vtkStringArray> unit;
  unit->SetName("LengthUnit");
  unit->InsertNextValue("cubit");
  vtkNew<vtkUnstructuredGrid> odd;
  odd->DeepCopy(model);
  odd->GetFieldData()->AddArray(unit);
  expect(odd, OutputPath("x.step"), "\"cubit\" is not known");
}

TEST(BadCADWriting, AFullDiskIsTold)
{
  if (!std::filesystem::exists("/dev/full"))
  {
    GTEST_SKIP() << "no /dev/full";
  }
  for (const int format :
    { vtkNURBSCADWriter::STEP, vtkNURBSCADWriter::IGES, vtkNURBSCADWriter::BREP })
  {
    Listened listened;
    listened.Writer->SetInputData(Shape(vtkNURBSShapeSource::CYLINDER));
    listened.Writer->SetFileName("/dev/full");
    listened.Writer->SetFormat(format);
    EXPECT_FALSE(listened.Writer->Write());
    EXPECT_TRUE(listened.Errors->Says("cannot write \"/dev/full\"")) << listened.Errors->Text;
    EXPECT_TRUE(std::filesystem::exists("/dev/full"));
  }
}

TEST(BadCADWriting, FacesThatFailAreNamedAndTheOthersWritten)
{
  nurbs::ModelBuilder builder;
  for (int i = 0; i < 3; ++i)
  {
    nurbs::Surface patch = Patch(2.0 * i);
    if (i == 1) // Broken in the middle: two pieces with a gap.
    {
      patch.Count[0] = 4;
      patch.Knots[0] = { 0.0, 0.0, 0.5, 0.5, 1.0, 1.0 };
      patch.Points = { { 2, 0, 0 }, { 2.4, 0, 0 }, { 2.6, 0, 0 }, { 3, 0, 0 }, { 2, 1, 0 },
        { 2.4, 1, 0 }, { 2.6, 1, 0 }, { 3, 1, 0 } };
    }
    nurbs::FaceAttributes attributes;
    attributes.FaceId = 40 + i;
    builder.BeginFace(patch.View(), attributes);
  }
  const auto model = Store(builder);
  model->GetPoints()->SetPoint(model->GetNumberOfPoints() - 1, std::nan(""), 0, 0);
  Listened listened;
  const TopoDS_Shape read = ReadShape(Write(listened.Writer, model, "failing.step"));
  EXPECT_EQ(CountOf(read, TopAbs_FACE), 1);
  EXPECT_EQ(listened.Writer->GetNumberOfFaces(), 1);
  EXPECT_EQ(listened.Writer->GetNumberOfFailedFaces(), 2);
  EXPECT_TRUE(listened.Warnings->Says("cell 1 (FaceId 41): its surface can't be written"))
    << listened.Warnings->Text;
  EXPECT_TRUE(listened.Warnings->Says("broken at the knot 0.5"));
  EXPECT_TRUE(listened.Warnings->Says("cell 2 (FaceId 42)"));
}
