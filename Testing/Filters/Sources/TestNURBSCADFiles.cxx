// SPDX-License-Identifier: BSD-3-Clause
// Assemblies, names, colours, units, progress, and every bad file.
#include "../../testMessageKeeper.h"
#include "testCADModels.h"

#include "vtkCallbackCommand.h"
#include "vtkCellData.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataAssembly.h"
#include "vtkExecutive.h"
#include "vtkInformation.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPControl_Writer.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>

namespace
{

const char* const Greek = "\xCE\x93\xCF\x81\xCE\xB1\xCE\xBD\xCE\xAC\xCE\xB6\xCE\xB9"; // UTF-8

/// An assembly: frame (twice the sub-assembly "arm", which is one box and one pin) and a lid.
class AssemblyFile
{
public:
  AssemblyFile()
  {
    Message::DefaultMessenger()->ChangePrinters().Clear();
    XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", this->Document);
    this->Shapes = XCAFDoc_DocumentTool::ShapeTool(this->Document->Main());
    this->Colors = XCAFDoc_DocumentTool::ColorTool(this->Document->Main());
  }
  ~AssemblyFile() { XCAFApp_Application::GetApplication()->Close(this->Document); }
  AssemblyFile(const AssemblyFile&) = delete;
  AssemblyFile& operator=(const AssemblyFile&) = delete;

  TDF_Label Part(const TopoDS_Shape& shape, const char* name)
  {
    const TDF_Label label = this->Shapes->AddShape(shape, false);
    TDataStd_Name::Set(label, TCollection_ExtendedString(name, true));
    return label;
  }

  TDF_Label Assembly(const char* name)
  {
    const TDF_Label label = this->Shapes->NewShape();
    TDataStd_Name::Set(label, TCollection_ExtendedString(name, true));
    return label;
  }

  TDF_Label Place(const TDF_Label& assembly, const TDF_Label& part, double x, double angle = 0.0)
  {
    gp_Trsf turn, move;
    turn.SetRotation(gp_Ax1(gp_Pnt(), gp_Dir(0, 0, 1)), angle);
    move.SetTranslation(gp_Vec(x, 0, 0));
    return this->Shapes->AddComponent(assembly, part, TopLoc_Location(move * turn));
  }

  void Paint(const TDF_Label& label, int r, int g, int b)
  {
    this->Colors->SetColor(
      label, Quantity_Color(r / 255.0, g / 255.0, b / 255.0, Quantity_TOC_sRGB), XCAFDoc_ColorSurf);
  }

  void PaintFace(const TDF_Label& part, int face, int r, int g, int b)
  {
    TopExp_Explorer it(XCAFDoc_ShapeTool::GetShape(part), TopAbs_FACE);
    for (int i = 0; i < face; ++i)
    {
      it.Next();
    }
    this->Paint(this->Shapes->AddSubShape(part, it.Current()), r, g, b);
  }

  std::string Write(const char* name)
  {
    this->Shapes->UpdateAssemblies();
    const std::string path = OutputPath(name);
    STEPCAFControl_Writer writer;
    writer.SetColorMode(true);
    writer.SetNameMode(true);
    EXPECT_TRUE(writer.Transfer(this->Document, STEPControl_AsIs));
    EXPECT_EQ(writer.Write(path.c_str()), IFSelect_RetDone);
    return path;
  }

private:
  Handle(TDocStd_Document) Document;
  Handle(XCAFDoc_ShapeTool) Shapes;
  Handle(XCAFDoc_ColorTool) Colors;
};

std::string NameOf(vtkUnstructuredGrid* grid, vtkIdType cell)
{
  auto* names =
    vtkStringArray::SafeDownCast(grid->GetCellData()->GetAbstractArray(vtkNURBSModel::NameName()));
  return names ? std::string(names->GetValue(cell)) : std::string("(no names)");
}

std::vector<int> ColorOf(vtkUnstructuredGrid* grid, vtkIdType cell)
{
  auto* colors =
    vtkUnsignedCharArray::SafeDownCast(grid->GetCellData()->GetArray(vtkNURBSModel::ColorName()));
  return colors ? std::vector<int>{ colors->GetValue(3 * cell), colors->GetValue(3 * cell + 1),
    colors->GetValue(3 * cell + 2) }
                : std::vector<int>();
}

using Rgb = std::vector<int>;

double Middle(vtkUnstructuredGrid* grid, int axis)
{
  const double* bounds = grid->GetBounds();
  return 0.5 * (bounds[2 * axis] + bounds[2 * axis + 1]);
}

std::string WriteStep(const TopoDS_Shape& shape, const char* name, const char* unit)
{
  Message::DefaultMessenger()->ChangePrinters().Clear();
  STEPControl_Writer(); // Defines the parameter.
  Interface_Static::SetCVal("write.step.unit", unit);
  STEPControl_Writer writer;
  EXPECT_EQ(writer.Transfer(shape, STEPControl_AsIs), IFSelect_RetDone);
  const std::string path = OutputPath(name);
  EXPECT_EQ(writer.Write(path.c_str()), IFSelect_RetDone);
  Interface_Static::SetCVal("write.step.unit", "MM");
  return path;
}

std::string WriteText(const std::string& name, const std::string& text)
{
  const std::string path = OutputPath(name);
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

std::string Content(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  return { std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>() };
}

/// Expects exactly one error that contains all of the words, and an empty output.
void ExpectError(const std::string& path, const std::vector<std::string>& words)
{
  SCOPED_TRACE(path);
  vtkNew<vtkNURBSCADReader> reader;
  reader->SetFileName(path.c_str());
  int errors = 0;
  std::string text;
  vtkNew<vtkCallbackCommand> count;
  auto record = [&](const char* message) {
    ++errors;
    text = message;
  };
  std::function<void(const char*)> body = record;
  count->SetClientData(&body);
  count->SetCallback([](vtkObject*, unsigned long, void* client, void* data) {
    (*static_cast<std::function<void(const char*)>*>(client))(static_cast<const char*>(data));
  });
  reader->AddObserver(vtkCommand::ErrorEvent, count);
  reader->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, count);
  reader->Update();
  EXPECT_EQ(errors, 1) << text;
  EXPECT_NE(reader->GetErrorCode(), 0u);
  EXPECT_EQ(reader->GetOutput()->GetNumberOfPartitionedDataSets(), 0u);
  for (const std::string& word : words)
  {
    EXPECT_NE(text.find(word), std::string::npos) << "no \"" << word << "\" in: " << text;
  }
}

} // namespace

TEST(CADFiles, AssembliesNamesAndColours)
{
  AssemblyFile file;
  const TDF_Label box = file.Part(BRepPrimAPI_MakeBox(1.0, 2.0, 3.0).Shape(), Greek);
  const TDF_Label pin = file.Part(BRepPrimAPI_MakeCylinder(0.5, 4.0).Shape(), "pin");
  const TDF_Label lid = file.Part(BRepPrimAPI_MakeBox(5.0, 5.0, 0.5).Shape(), "lid & seal");
  const TDF_Label arm = file.Assembly("arm");
  file.Place(arm, box, 0.0);
  file.Place(arm, pin, 10.0);
  const TDF_Label frame = file.Assembly("frame");
  file.Place(frame, arm, 0.0);
  file.Place(frame, arm, 100.0, 1.57079632679489661923);
  file.Place(frame, lid, 1000.0);
  file.Paint(box, 200, 100, 50);
  file.PaintFace(box, 2, 10, 20, 30);
  file.Paint(lid, 0, 128, 255);
  const std::string path = file.Write("assembly.step");

  vtkNew<vtkNURBSCADReader> reader;
  reader->SetFileName(path.c_str());
  const Grids grids = Models(reader);
  ASSERT_EQ(grids.size(), 5u);
  const std::vector<std::string> names = { Greek, "pin", Greek, "pin", "lid & seal" };
  vtkIdType next = 0;
  for (std::size_t i = 0; i < grids.size(); ++i)
  {
    EXPECT_EQ(vtkNURBSModel::Validate(grids[i]), "");
    ExpectClosed(grids[i]);
    EXPECT_EQ(NameOf(grids[i], 0), names[i]);
    EXPECT_EQ(reader->GetOutput()->GetMetaData(i)->Get(vtkCompositeDataSet::NAME()), names[i]);
    for (vtkIdType c = 0; c < grids[i]->GetNumberOfCells(); ++c)
    {
      EXPECT_EQ(vtkNURBSModel::GetFaceId(grids[i], c), next++);
    }
  }
  EXPECT_EQ(next, 6 + 3 + 6 + 3 + 6);
  // Placed: the second arm is turned by a quarter and moved.
  EXPECT_NEAR(Middle(grids[0], 0), 0.5, 1e-9);
  EXPECT_NEAR(Middle(grids[1], 0), 10.0, 1e-9);
  EXPECT_NEAR(Middle(grids[2], 0), 99.0, 1e-9);
  EXPECT_NEAR(Middle(grids[3], 0), 100.0, 1e-9);
  EXPECT_NEAR(Middle(grids[3], 1), 10.0, 1e-9);
  EXPECT_NEAR(Middle(grids[4], 0), 1002.5, 1e-9);
  // Face before part; the pin has no colour of its own.
  for (const std::size_t i : { 0, 2 })
  {
    EXPECT_EQ(ColorOf(grids[i], 0), (Rgb{ 200, 100, 50 }));
    EXPECT_EQ(ColorOf(grids[i], 2), (Rgb{ 10, 20, 30 }));
  }
  EXPECT_EQ(ColorOf(grids[1], 0), (Rgb{ 204, 204, 204 }));
  EXPECT_EQ(ColorOf(grids[4], 5), (Rgb{ 0, 128, 255 }));

  vtkDataAssembly* tree = reader->GetOutput()->GetDataAssembly();
  ASSERT_NE(tree, nullptr);
  const std::vector<int> top = tree->GetChildNodes(vtkDataAssembly::GetRootNode(), false);
  ASSERT_EQ(top.size(), 1u);
  EXPECT_STREQ(tree->GetAttributeOrDefault(top[0], "label", ""), "frame");
  const std::vector<int> inside = tree->GetChildNodes(top[0], false);
  ASSERT_EQ(inside.size(), 3u);
  EXPECT_STREQ(tree->GetAttributeOrDefault(inside[2], "label", ""), "lid & seal");
  const std::vector<int> second = tree->GetChildNodes(inside[1], false);
  ASSERT_EQ(second.size(), 2u);
  EXPECT_STREQ(tree->GetAttributeOrDefault(second[0], "label", ""), Greek);
  EXPECT_EQ(tree->GetDataSetIndices(inside[1]), (std::vector<unsigned int>{ 2, 3 }));
}

TEST(CADFiles, ColoursOfInstancesAndAssembliesAreInherited)
{
  AssemblyFile file;
  const TDF_Label bare = file.Part(BRepPrimAPI_MakeBox(1.0, 2.0, 3.0).Shape(), "bare");
  const TDF_Label painted = file.Part(BRepPrimAPI_MakeCylinder(0.5, 4.0).Shape(), "painted");
  file.Paint(painted, 0, 0, 255);
  file.PaintFace(painted, 0, 9, 9, 9);
  const TDF_Label inner = file.Assembly("inner");
  file.Place(inner, bare, 0.0);
  file.Place(inner, painted, 5.0);
  const TDF_Label root = file.Assembly("root");
  const TDF_Label use = file.Place(root, inner, 0.0);
  file.Paint(use, 0, 255, 0);
  const TDF_Label red = file.Place(root, bare, 50.0);
  file.Paint(red, 255, 0, 0);
  const TDF_Label over = file.Place(root, painted, 60.0);
  file.Paint(over, 255, 255, 0);
  vtkNew<vtkNURBSCADReader> reader;
  reader->SetFileName(file.Write("inherit.step").c_str());
  const Grids grids = Models(reader);
  ASSERT_EQ(grids.size(), 4u);
  EXPECT_EQ(ColorOf(grids[0], 0), (Rgb{ 0, 255, 0 })) << "the assembly's instance";
  EXPECT_EQ(ColorOf(grids[1], 1), (Rgb{ 0, 0, 255 })) << "the product before its assembly";
  EXPECT_EQ(ColorOf(grids[2], 0), (Rgb{ 255, 0, 0 })) << "the instance";
  EXPECT_EQ(ColorOf(grids[3], 1), (Rgb{ 255, 255, 0 })) << "the instance before the product";
  EXPECT_EQ(ColorOf(grids[3], 0), (Rgb{ 9, 9, 9 })) << "the face before all";
}

TEST(CADFiles, SingleModelHoldsAllInstances)
{
  AssemblyFile file;
  const TDF_Label box = file.Part(BRepPrimAPI_MakeBox(1.0, 2.0, 3.0).Shape(), "box");
  const TDF_Label root = file.Assembly("root");
  file.Place(root, box, 0.0);
  file.Place(root, box, 7.0);
  vtkNew<vtkNURBSCADReader> reader;
  reader->SetFileName(file.Write("single.step").c_str());
  reader->SingleModelOn();
  const Grids grids = Models(reader);
  ASSERT_EQ(grids.size(), 1u);
  EXPECT_EQ(grids[0]->GetNumberOfCells(), 12);
  EXPECT_EQ(vtkNURBSModel::Validate(grids[0]), "");
  ExpectClosed(grids[0]);
  EXPECT_EQ(vtkNURBSModel::View(grids[0])->GetModel().Edges.size(), 24u);
  EXPECT_NEAR(grids[0]->GetBounds()[1], 8.0, 1e-9);
  EXPECT_EQ(ColorOf(grids[0], 0), Rgb()) << "no colour in the file, no array";
}

TEST(CADFiles, Units)
{
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(254.0, 20.0, 30.0).Shape();
  const std::string path = WriteStep(box, "inches.step", "INCH");
  vtkNew<vtkNURBSCADReader> reader;
  reader->SetFileName(path.c_str());
  struct Case
  {
    int Unit;
    const char* Name;
    double Length;
  };
  for (const Case& c : { Case{ vtkNURBSCADReader::MILLIMETRES, "mm", 254.0 },
         Case{ vtkNURBSCADReader::METRES, "m", 0.254 },
         Case{ vtkNURBSCADReader::FILE_UNIT, "in", 10.0 } })
  {
    reader->SetLengthUnit(c.Unit);
    const Grids grids = Models(reader);
    ASSERT_EQ(grids.size(), 1u);
    EXPECT_EQ(vtkNURBSModel::GetLengthUnit(grids[0]), c.Name);
    const double* bounds = grids[0]->GetBounds();
    EXPECT_NEAR(bounds[1] - bounds[0], c.Length, 1e-9 * c.Length);
    EXPECT_LT(MeasureEdges(vtkNURBSModel::View(grids[0])->GetModel()).Excess, 1e-14);
  }
}

TEST(CADFiles, IgesIsOneModel)
{
  Message::DefaultMessenger()->ChangePrinters().Clear();
  IGESControl_Writer writer("MM", 1);
  ASSERT_TRUE(writer.AddShape(BRepPrimAPI_MakeCylinder(2.0, 5.0).Shape()));
  const std::string path = OutputPath("cylinder.igs");
  ASSERT_TRUE(writer.Write(path.c_str()));
  const auto grid = ReadOne(path);
  EXPECT_EQ(grid->GetNumberOfCells(), 3);
  EXPECT_EQ(vtkNURBSModel::Validate(grid), "");
}

TEST(CADFiles, TheContentTellsTheFormat)
{
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(1.0, 2.0, 3.0).Shape();
  const std::string path = WriteStep(box, "named.brep", "MM");
  EXPECT_EQ(vtkNURBSCADReader::CanReadFile(path.c_str()), 1);
  EXPECT_EQ(ReadOne(path)->GetNumberOfCells(), 6);
  EXPECT_EQ(vtkNURBSCADReader::CanReadFile(__FILE__), 0);
  EXPECT_EQ(vtkNURBSCADReader::CanReadFile(nullptr), 0);
}

TEST(CADFiles, ProgressGrowsAndAbortStops)
{
  const std::string path = WriteStep(BRepPrimAPI_MakeBox(1.0, 2.0, 3.0).Shape(), "p.step", "MM");
  vtkNew<vtkNURBSCADReader> reader;
  reader->SetFileName(path.c_str());
  std::vector<double> seen;
  vtkNew<vtkCallbackCommand> watch;
  watch->SetClientData(&seen);
  watch->SetCallback([](vtkObject*, unsigned long, void* client, void* amount) {
    static_cast<std::vector<double>*>(client)->push_back(*static_cast<const double*>(amount));
  });
  reader->AddObserver(vtkCommand::ProgressEvent, watch);
  reader->Update();
  EXPECT_GT(seen.size(), 3u);
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
  EXPECT_EQ(seen.back(), 1.0);

  vtkNew<vtkCallbackCommand> stop;
  stop->SetCallback([](vtkObject* caller, unsigned long, void*, void*) {
    static_cast<vtkNURBSCADReader*>(caller)->SetAbortExecute(1);
  });
  reader->AddObserver(vtkCommand::ProgressEvent, stop);
  vtkNew<MessageKeeper> keeper;
  reader->AddObserver(vtkCommand::ErrorEvent, keeper);
  reader->Modified();
  reader->Update();
  EXPECT_EQ(reader->GetOutput()->GetNumberOfPartitionedDataSets(), 0u);
  EXPECT_EQ(keeper->Text, "");
}

TEST(BadCADFiles, EachGivesOneClearError)
{
  ExpectError(OutputPath("nowhere.step"), { "no such file", "nowhere.step" });
  ExpectError(NURBS_TEST_OUTPUT, { "is a directory" });
  ExpectError(WriteText("empty.step", ""), { "is empty" });
  ExpectError(WriteText("text.step", "Dear reader, this is a letter.\n"), { "neither", "STEP" });
  ExpectError(WriteText("binary.brep", std::string(5000, '\0')), { "neither" });
  ExpectError(WriteText("junk.step", "ISO-10303-21;\nHEADER;\n;;;(((\nEND-ISO-10303-21;\n"),
    { "STEP file", "junk.step" });
  ExpectError(WriteText("void.step",
                "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\n"
                "FILE_NAME('','',(''),(''),'','','');\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\n"
                "ENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n"),
    { "STEP file" });
}

TEST(BadCADFiles, TruncatedStepAndIges)
{
  const TopoDS_Shape shape = BRepPrimAPI_MakeCylinder(1.0, 3.0).Shape();
  const std::string step = Content(WriteStep(shape, "whole.step", "MM"));
  IGESControl_Writer writer("MM", 1);
  writer.AddShape(shape);
  const std::string igesPath = OutputPath("whole.igs");
  ASSERT_TRUE(writer.Write(igesPath.c_str()));
  const std::string iges = Content(igesPath);
  for (const double part : { 0.02, 0.3, 0.77, 0.99 })
  {
    ExpectError(
      WriteText("cut.step", step.substr(0, std::size_t(part * step.size()))), { "truncated STEP" });
    ExpectError(WriteText("cut.igs", iges.substr(0, std::size_t(part * iges.size()))),
      { "IGES", "truncated" });
  }
}

TEST(BadCADFiles, TruncatedBrepAtEveryFiftiethPart)
{
  const std::string whole = Content(WriteBrep(BRepPrimAPI_MakeCylinder(1.0, 3.0).Shape(), "whole"));
  ASSERT_GT(whole.size(), 1000u);
  for (int part = 2; part < 50; ++part)
  {
    ExpectError(
      WriteText("cut.brep", whole.substr(0, whole.size() * part / 50)), { "broken BREP file" });
  }
}

// OpenCASCADE follows the null reference; the next file must be read as ever.
TEST(BadCADFiles, StepWithEntitiesMissing)
{
  const std::string good =
    WriteStep(BRepPrimAPI_MakeCylinder(1.0, 3.0).Shape(), "entities.step", "MM");
  const std::string text = Content(good);
  for (const char* entity : { "CYLINDRICAL_SURFACE(", "VERTEX_POINT(", "EDGE_LOOP(", "CIRCLE(" })
  {
    std::string broken = text;
    const std::size_t at = broken.find(entity);
    ASSERT_NE(at, std::string::npos) << entity;
    const std::size_t line = broken.rfind('\n', at);
    broken.erase(line, broken.find(';', at) + 1 - line);
    vtkNew<vtkNURBSCADReader> reader;
    vtkNew<MessageKeeper> errors, warnings;
    reader->AddObserver(vtkCommand::ErrorEvent, errors);
    reader->AddObserver(vtkCommand::WarningEvent, warnings);
    reader->SetFileName(WriteText("entity.step", broken).c_str());
    vtkIdType faces = 0;
    for (const auto& grid : Models(reader))
    {
      faces += grid->GetNumberOfCells();
    }
    EXPECT_TRUE(faces == 3 || !errors->Text.empty() || !warnings->Text.empty())
      << entity << ": " << faces << " faces and not a word";
    EXPECT_EQ(ReadOne(good)->GetNumberOfCells(), 3);
  }
}

TEST(BadCADFiles, NoFace)
{
  TopoDS_Compound compound;
  BRep_Builder().MakeCompound(compound);
  ExpectError(WriteBrep(compound, "faceless"), { "holds no face" });
}

TEST(BadCADFiles, NoNameGiven)
{
  vtkNew<vtkNURBSCADReader> reader;
  vtkNew<MessageKeeper> keeper;
  reader->AddObserver(vtkCommand::ErrorEvent, keeper);
  reader->Update();
  EXPECT_TRUE(keeper->Says("FileName is not set"));
}
