// SPDX-License-Identifier: BSD-3-Clause
// Planes stay planes and instances stay instances when models are written.
#include "testCADWriting.h"

#include "vtkCallbackCommand.h"
#include "vtkCellData.h"
#include "vtkDataAssembly.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkPoints.h"
#include "vtkUnsignedCharArray.h"

#include <BRepCheck_Analyzer.hxx>
#include <BRep_Tool.hxx>
#include <Geom_Circle.hxx>
#include <Geom_ElementarySurface.hxx>
#include <Geom_Line.hxx>
#include <Geom_Surface.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace
{

const char* const Screw = "/usr/share/opencascade/data/step/screw.step";

/// How many faces have each kind of surface, and edges each kind of curve that is a line or circle.
std::map<std::string, int> KindsOf(const TopoDS_Shape& shape)
{
  std::map<std::string, int> kinds;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next())
  {
    ++kinds[BRep_Tool::Surface(TopoDS::Face(it.Current()))->DynamicType()->Name()];
  }
  // In STEP OpenCASCADE writes tori that pass through their axis as surfaces of revolution.
  kinds["Geom_ToroidalSurface"] += kinds["Geom_SurfaceOfRevolution"];
  kinds.erase("Geom_SurfaceOfRevolution");
  return kinds;
}

std::map<std::string, int> CurvesOf(const TopoDS_Shape& shape)
{
  std::map<std::string, int> kinds;
  TopTools_IndexedMapOfShape edges;
  TopExp::MapShapes(shape, TopAbs_EDGE, edges);
  for (int i = 1; i <= edges.Extent(); ++i)
  {
    double first = 0.0, last = 0.0;
    const Handle(Geom_Curve) curve = BRep_Tool::Curve(TopoDS::Edge(edges(i)), first, last);
    ++kinds[curve.IsNull() ? "none" : curve->DynamicType()->Name()];
  }
  return kinds;
}

void Transform(vtkUnstructuredGrid* model, const std::function<nurbs::Vec3(nurbs::Vec3)>& map)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (vtkIdType i = 0; i < model->GetNumberOfPoints(); ++i)
  {
    nurbs::Vec3 p;
    model->GetPoint(i, p.data());
    p = map(p);
    points->InsertNextPoint(p.data());
  }
  model->SetPoints(points);
}

} // namespace
/// All of an object's messages, one a line.
class AllMessages : public vtkCommand
{
public:
  static AllMessages* New() { return new AllMessages; }
  void Execute(vtkObject*, unsigned long, void* text) override
  {
    this->Text += std::string(static_cast<const char*>(text)) + "\n";
  }
  std::string Text;
};

TEST(CADForms, SurfacesOfAFileStayWhatTheyWere)
{
  const auto model = ReadOne(Screw);
  const TopoDS_Shape original = ReadShape(Screw);
  for (const char* ending : Endings)
  {
    SCOPED_TRACE(ending);
    Listened listened;
    const TopoDS_Shape read =
      ReadShape(Write(listened.Writer, model, std::string("kinds.") + ending));
    EXPECT_EQ(listened.Warnings->Text, "");
    EXPECT_EQ(KindsOf(read), KindsOf(original));
    EXPECT_EQ(listened.Writer->GetNumberOfAnalyticFaces(), 10);
    EXPECT_GE(CurvesOf(read)["Geom_Circle"], CurvesOf(original)["Geom_Circle"]);
    EXPECT_GE(CurvesOf(read)["Geom_Line"], CurvesOf(original)["Geom_Line"]);
    EXPECT_TRUE(BRepCheck_Analyzer(read).IsValid());
    ExpectModelFaces(model, read, { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9 },
      1e-6 * model->GetLength() + 2.0 * listened.Writer->GetEdgeTolerance());
    EXPECT_NEAR(VolumeOf(read), VolumeOf(original), 1e-6 * VolumeOf(original));

    listened.Writer->AnalyticSurfacesOff();
    const TopoDS_Shape splines =
      ReadShape(Write(listened.Writer, model, std::string("splines.") + ending));
    EXPECT_EQ(KindsOf(splines)["Geom_BSplineSurface"], 10);
    EXPECT_EQ(listened.Writer->GetNumberOfAnalyticFaces(), 0);
  }
}

TEST(CADForms, MovedRigidlyTheyStayShearedOnlyPlanesDo)
{
  const TopoDS_Shape original = ReadShape(Screw);
  for (const bool sheared : { false, true })
  {
    const auto model = ReadOne(Screw);
    const Eigen::AngleAxisd turn(0.7, nurbs::Vec3(1.0, -2.0, 0.5).normalized());
    Transform(model, [&](const nurbs::Vec3& p) -> nurbs::Vec3 {
      return sheared ? nurbs::Vec3(p[0] + 0.2 * p[2], p[1], p[2])
                     : nurbs::Vec3(2.0 * (turn * p) + nurbs::Vec3(5.0, 6.0, 7.0));
    });
    vtkNew<vtkNURBSCADWriter> writer;
    const TopoDS_Shape read = ReadShape(Write(writer, model, "moved.step"));
    EXPECT_EQ(CountOf(read, TopAbs_SOLID), 1);
    EXPECT_EQ(KindsOf(read)["Geom_Plane"], 4);
    EXPECT_EQ(writer->GetNumberOfAnalyticFaces(), sheared ? 4 : 10);
    const double factor = sheared ? 1.0 : 8.0;
    EXPECT_NEAR(VolumeOf(read), factor * VolumeOf(original), 1e-4 * factor * VolumeOf(original));
  }
}

namespace
{

/// Three screws, the second one turned, the third one a mirror image; and one of another colour.
vtkSmartPointer<vtkPartitionedDataSetCollection> Screws(bool named)
{
  auto all = vtkSmartPointer<vtkPartitionedDataSetCollection>::New();
  all->SetNumberOfPartitionedDataSets(4);
  const Eigen::AngleAxisd turn(2.1, nurbs::Vec3(1.0, 2.0, -0.5).normalized());
  for (unsigned int i = 0; i < 4; ++i)
  {
    const auto model = ReadOne(Screw);
    Transform(model, [&](const nurbs::Vec3& p) -> nurbs::Vec3 {
      const nurbs::Vec3 shift(0.0, 200.0 * i, 0.0);
      return shift +
        (i == 1 ? turn * p : (i == 2 ? nurbs::Vec3(-p[0], p[1], p[2]) : nurbs::Vec3(p)));
    });
    vtkNew<vtkUnsignedCharArray> color;
    color->SetName(vtkNURBSModel::ColorName());
    color->SetNumberOfComponents(3);
    color->SetNumberOfTuples(model->GetNumberOfCells());
    color->Fill(i == 3 ? 90 : 200);
    model->GetCellData()->AddArray(color);
    all->SetPartition(i, 0, model);
    all->GetMetaData(i)->Set(
      vtkCompositeDataSet::NAME(), named ? "screw" : ("screw " + std::to_string(i)).c_str());
  }
  return all;
}

} // namespace

TEST(CADInstances, OnePartInTwoPlacesIsWrittenOnce)
{
  const auto screws = Screws(true);
  for (const char* ending : Endings)
  {
    SCOPED_TRACE(ending);
    vtkNew<vtkNURBSCADWriter> writer;
    const std::string path = Write(writer, screws, std::string("screws.") + ending);
    EXPECT_EQ(writer->GetNumberOfInstances(), 1);
    EXPECT_EQ(writer->GetNumberOfFaces(), 40);
    vtkNew<vtkNURBSCADReader> reader;
    reader->SetFileName(path.c_str());
    const TopoDS_Shape read = ReadShape(path);
    TopTools_IndexedMapOfShape shells;
    for (TopExp_Explorer it(read, TopAbs_SHELL); it.More(); it.Next())
    {
      shells.Add(it.Current().Located(TopLoc_Location()).Oriented(TopAbs_FORWARD));
    }
    EXPECT_EQ(shells.Extent(), std::string(ending) == "iges" ? 4 : 3);
    if (std::string(ending) != "step")
    {
      continue;
    }
    const Grids models = Models(reader);
    ASSERT_EQ(models.size(), 4u);
    for (unsigned int i = 0; i < 4; ++i)
    {
      auto* own = vtkUnstructuredGrid::SafeDownCast(screws->GetPartition(i, 0));
      const double* b = own->GetBounds();
      const auto view = vtkNURBSModel::View(models[i]);
      const std::string red =
        std::to_string(models[i]->GetCellData()->GetArray("Color")->GetComponent(0, 0));
      EXPECT_EQ(red, std::to_string(i == 3 ? 90.0 : 200.0));
      ExpectModelFaces(own, ReadShape(Write(models[i], "one.brep")),
        { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9 }, 2e-4 * own->GetLength());
      EXPECT_GT(b[3], 200.0 * i - 100.0);
    }
  }
}

TEST(CADInstances, PartsOfDifferentNamesAreSeveral)
{
  vtkNew<vtkNURBSCADWriter> writer;
  const std::string path = Write(writer, Screws(false), "named.step");
  EXPECT_EQ(writer->GetNumberOfInstances(), 0);
  vtkNew<vtkNURBSCADReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  auto* read = vtkPartitionedDataSetCollection::SafeDownCast(reader->GetOutputDataObject(0));
  ASSERT_EQ(read->GetNumberOfPartitionedDataSets(), 4u);
  for (unsigned int i = 0; i < 4; ++i)
  {
    EXPECT_EQ(read->GetMetaData(i)->Get(vtkCompositeDataSet::NAME()), "screw " + std::to_string(i));
  }
}

TEST(CADInstances, NodesOfDifferentNamesAreSeveral)
{
  // The blocks have one name, the nodes of the tree do not.
  const auto screws = Screws(true);
  vtkNew<vtkDataAssembly> tree;
  const int top = tree->AddNode("top", vtkDataAssembly::GetRootNode());
  const char* const names[] = { "first", "second", "third", "fourth" };
  for (unsigned int i = 0; i < 4; ++i)
  {
    tree->AddDataSetIndex(tree->AddNode(names[i], top), i);
  }
  screws->SetDataAssembly(tree);
  vtkNew<vtkNURBSCADWriter> writer;
  const std::string path = Write(writer, screws, "nodes.step");
  EXPECT_EQ(writer->GetNumberOfInstances(), 0);
  vtkNew<vtkNURBSCADReader> reader;
  reader->SetFileName(path.c_str());
  const Grids models = Models(reader);
  ASSERT_EQ(models.size(), 4u);
  for (unsigned int i = 0; i < 4; ++i)
  {
    auto* own = vtkUnstructuredGrid::SafeDownCast(screws->GetPartition(i, 0));
    ExpectModelFaces(own, ReadShape(Write(models[i], "one.brep")), { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9 },
      2e-4 * own->GetLength());
  }
}

TEST(CADInstances, EdgesOfOtherTolerancesMakeOtherParts)
{
  const Grids models = { TwoPatches(0.0), TwoPatches(0.0), TwoPatches(0.0) };
  auto* tolerances = models[2]->GetFieldData()->GetArray("EdgeTolerance");
  ASSERT_NE(tolerances, nullptr);
  tolerances->SetComponent(0, 0, 0.01);
  vtkNew<vtkNURBSCADWriter> writer;
  Write(writer, Blocks(models), "tolerances.step");
  EXPECT_EQ(writer->GetNumberOfInstances(), 1);
}

TEST(CADInstances, FaultsAreToldOfEach)
{
  nurbs::Surface broken = Patch(0.0); // In the middle: two pieces with a gap.
  broken.Count[0] = 4;
  broken.Knots[0] = { 0.0, 0.0, 0.5, 0.5, 1.0, 1.0 };
  broken.Points = { { 0, 0, 0 }, { 0.4, 0, 0 }, { 0.6, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 },
    { 0.4, 1, 0 }, { 0.6, 1, 0 }, { 1, 1, 0 } };
  Grids models;
  for (int i = 0; i < 3; ++i)
  {
    nurbs::ModelBuilder builder;
    builder.BeginFace(broken.View(), nurbs::FaceAttributes());
    AddFace(builder, Patch(2.0), { { 0, 0 }, { 1, 1 }, { 1, 0 }, { 0, 1 } }); // It crosses itself.
    models.push_back(Store(builder));
    Transform(models.back(),
      [i](const nurbs::Vec3& p) -> nurbs::Vec3 { return p + nurbs::Vec3(0.0, 3.0 * i, i); });
  }
  vtkNew<vtkNURBSCADWriter> writer;
  vtkNew<AllMessages> warnings;
  writer->AddObserver(vtkCommand::WarningEvent, warnings);
  Write(writer, Blocks(models), "faults.step");
  EXPECT_EQ(writer->GetNumberOfInstances(), 2);
  EXPECT_EQ(writer->GetNumberOfFaces(), 3);
  EXPECT_EQ(writer->GetNumberOfFailedFaces(), 3);
  EXPECT_EQ(writer->GetNumberOfInvalidFaces(), 3);
  for (int i = 0; i < 3; ++i)
  {
    const std::string block = "block " + std::to_string(i) + " (part): cell ";
    EXPECT_NE(warnings->Text.find(block + "0"), std::string::npos) << warnings->Text;
    EXPECT_NE(warnings->Text.find(block + "1"), std::string::npos) << warnings->Text;
  }
}

TEST(CADInstances, TheSearchForCopiesTellsHowFarItIsAndStops)
{
  Grids models;
  for (int i = 0; i < 60; ++i)
  {
    nurbs::ModelBuilder builder;
    builder.BeginFace(Patch(0.0).View(), nurbs::FaceAttributes());
    models.push_back(Store(builder));
    Transform(models.back(),
      [i](const nurbs::Vec3& p) -> nurbs::Vec3 { return (1.0 + 0.01 * (i / 2)) * p; });
  }
  const auto blocks = Blocks(models);
  struct Watcher
  {
    double StopAt;
    std::vector<double> Seen;
  };
  for (const double stopAt : { 0.01, 2.0 })
  {
    Listened listened;
    Watcher watcher{ stopAt, {} };
    vtkNew<vtkCallbackCommand> watch;
    watch->SetClientData(&watcher);
    watch->SetCallback([](vtkObject* caller, unsigned long, void* client, void* amount) {
      auto* own = static_cast<Watcher*>(client);
      own->Seen.push_back(*static_cast<const double*>(amount));
      if (own->Seen.back() >= own->StopAt)
      {
        static_cast<vtkNURBSCADWriter*>(caller)->SetAbortExecute(1);
      }
    });
    listened.Writer->AddObserver(vtkCommand::ProgressEvent, watch);
    listened.Writer->SetInputDataObject(blocks);
    listened.Writer->SetFileName(OutputPath("plates.step").c_str());
    EXPECT_EQ(listened.Writer->Write(), stopAt < 1.0 ? 0 : 1);
    EXPECT_EQ(listened.Errors->Text, "");
    EXPECT_TRUE(std::is_sorted(watcher.Seen.begin(), watcher.Seen.end()));
    const auto before = std::count_if(
      watcher.Seen.begin(), watcher.Seen.end(), [](double part) { return part <= 0.05; });
    if (stopAt < 1.0)
    {
      EXPECT_LT(before, 20) << "It went on.";
      EXPECT_LE(watcher.Seen.size(), static_cast<std::size_t>(before) + 1)
        << "1 is told at the end.";
    }
    else
    {
      EXPECT_GE(before, 60) << "One a block.";
      EXPECT_EQ(listened.Writer->GetNumberOfInstances(), 30);
    }
  }
}
