// SPDX-License-Identifier: BSD-3-Clause
// Models written as STEP, IGES and BREP files, read back by OpenCASCADE and by vtkNURBSCADReader.
#include "../../testMessageKeeper.h"
#include "testCADModels.h"

#include "ModelBuilder.h"
#include "ModelFaceCheck.h"
#include "vtkNURBSCADWriter.h"
#include "vtkNURBSShapeSource.h"
#include "vtkNURBSVisibleRegions.h"

#include "vtkCallbackCommand.h"
#include "vtkCellData.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataAssembly.h"
#include "vtkErrorCode.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <GProp_GProps.hxx>
#include <IGESControl_Reader.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Reader.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopoDS.hxx>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace
{

const char* const Greek = "\xCE\x93\xCF\x81\xCE\xB1\xCE\xBD\xCE\xAC\xCE\xB6\xCE\xB9"; // UTF-8
const char* const Endings[] = { "step", "iges", "brep" };

template <class Reader>
TopoDS_Shape ReadExchange(const std::string& path)
{
  Reader reader;
  EXPECT_EQ(reader.ReadFile(path.c_str()), IFSelect_RetDone) << path;
  reader.TransferRoots();
  return reader.OneShape();
}

/// By OpenCASCADE alone.
TopoDS_Shape ReadShape(const std::string& path)
{
  Message::DefaultMessenger()->ChangePrinters().Clear();
  const std::string ending = path.substr(path.rfind('.') + 1);
  if (ending == "step")
  {
    return ReadExchange<STEPControl_Reader>(path);
  }
  if (ending == "iges")
  {
    return ReadExchange<IGESControl_Reader>(path);
  }
  TopoDS_Shape shape;
  BRep_Builder builder;
  EXPECT_TRUE(BRepTools::Read(shape, path.c_str(), builder)) << path;
  return shape;
}

int CountOf(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind)
{
  TopTools_IndexedMapOfShape map;
  TopExp::MapShapes(shape, kind, map);
  return map.Extent();
}

int SharedEdges(const TopoDS_Shape& shape)
{
  TopTools_IndexedDataMapOfShapeListOfShape uses;
  TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, uses);
  int shared = 0;
  for (int i = 1; i <= uses.Extent(); ++i)
  {
    shared += uses(i).Extent() == 2 ? 1 : 0;
  }
  return shared;
}

double AreaOf(const TopoDS_Shape& shape)
{
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(shape, properties, 1e-9);
  return properties.Mass();
}

double VolumeOf(const TopoDS_Shape& shape)
{
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties, 1e-9);
  return properties.Mass();
}

std::string Write(vtkNURBSCADWriter* writer, vtkDataObject* model, const std::string& name)
{
  const std::string path = OutputPath(name);
  std::filesystem::remove(path);
  writer->SetInputDataObject(model);
  writer->SetFileName(path.c_str());
  EXPECT_TRUE(writer->Write()) << path;
  return path;
}

std::string Write(vtkDataObject* model, const std::string& name)
{
  vtkNew<vtkNURBSCADWriter> writer;
  return Write(writer, model, name);
}

vtkSmartPointer<vtkUnstructuredGrid> Shape(int shape)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShape(shape);
  source->Update();
  return source->GetOutput();
}

void SetNames(vtkUnstructuredGrid* model, const std::string& start)
{
  vtkNew<vtkStringArray> names;
  names->SetName(vtkNURBSModel::NameName());
  for (vtkIdType i = 0; i < model->GetNumberOfCells(); ++i)
  {
    names->InsertNextValue(start + std::to_string(i));
  }
  model->GetCellData()->AddArray(names);
}

/// Which face of the file each cell is: names of faces tell.
std::vector<int> OrderOf(vtkUnstructuredGrid* written, vtkUnstructuredGrid* read)
{
  std::vector<int> order;
  auto* ours = vtkStringArray::SafeDownCast(written->GetCellData()->GetAbstractArray("Name"));
  auto* theirs = vtkStringArray::SafeDownCast(read->GetCellData()->GetAbstractArray("Name"));
  for (vtkIdType i = 0; i < written->GetNumberOfCells(); ++i)
  {
    order.push_back(static_cast<int>(theirs->LookupValue(ours->GetValue(i))));
    EXPECT_GE(order.back(), 0) << ours->GetValue(i);
  }
  return order;
}

/// Expects points of the model's faces, and of their loops, on OpenCASCADE's faces: of some eight of
/// the faces.
void ExpectModelFaces(vtkUnstructuredGrid* model, const TopoDS_Shape& shape,
  const std::vector<int>& order, double tolerance)
{
  std::vector<TopoDS_Face> faces;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next())
  {
    faces.push_back(TopoDS::Face(it.Current()));
  }
  ASSERT_EQ(faces.size(), order.size());
  const auto view = vtkNURBSModel::View(model);
  const std::size_t step = order.size() / 8 + 1;
  for (std::size_t i = 0; i < order.size(); i += step)
  {
    const verify::ModelFaceReport report =
      verify::CheckModelFace(faces[std::size_t(order[i])], view->GetModel(), i, model->GetLength());
    EXPECT_LT(report.Surface, tolerance) << "face " << i;
    EXPECT_LT(report.Loops, tolerance) << "face " << i;
    EXPECT_FALSE(report.Inverted) << "face " << i;
  }
}

/// The largest distance between surfaces of two models at equal parameters, faces in order.
double SurfaceDistance(vtkUnstructuredGrid* a, vtkUnstructuredGrid* b)
{
  const auto first = vtkNURBSModel::View(a), second = vtkNURBSModel::View(b);
  double distance = 0.0;
  for (std::size_t f = 0; f < first->GetModel().Faces.size(); ++f)
  {
    const nurbs::SurfaceView& s = first->GetModel().Faces[f].Geometry;
    const nurbs::SurfaceView& t = second->GetModel().Faces.at(f).Geometry;
    for (int k = 0; k < 121; ++k)
    {
      const nurbs::Interval u = s.Domain(0), v = s.Domain(1);
      const double x = u.Min + u.Length() * (k % 11) / 10.0;
      const double y = v.Min + v.Length() * (k / 11) / 10.0;
      distance = std::max(distance, (nurbs::Evaluate(s, x, y) - nurbs::Evaluate(t, x, y)).norm());
    }
  }
  return distance;
}

/// A writer whose messages are kept.
class Listened
{
public:
  Listened()
  {
    this->Writer->AddObserver(vtkCommand::ErrorEvent, this->Errors);
    this->Writer->AddObserver(vtkCommand::WarningEvent, this->Warnings);
  }
  vtkNew<vtkNURBSCADWriter> Writer;
  vtkNew<MessageKeeper> Errors, Warnings;
};

vtkSmartPointer<vtkUnstructuredGrid> Store(nurbs::ModelBuilder& builder)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNURBSModel::Store(builder, grid);
  return grid;
}

/// A flat patch from (x, 0) to (x + 1, 1) of degree 1.
nurbs::Surface Patch(double x, double z = 0.0)
{
  nurbs::Surface patch;
  patch.Count[0] = patch.Count[1] = 2;
  patch.Knots[0] = patch.Knots[1] = { 0.0, 0.0, 1.0, 1.0 };
  patch.Points = { { x, 0, z }, { x + 1, 0, z }, { x, 1, z }, { x + 1, 1, z } };
  return patch;
}

} // namespace

TEST(CADWriter, AllShapesComeBack)
{
  for (int shape = vtkNURBSShapeSource::SPHERE; shape <= vtkNURBSShapeSource::SPRING; ++shape)
  {
    const auto model = Shape(shape);
    SetNames(model, "face ");
    std::vector<int> order;
    double area = 0.0;
    for (const char* ending : Endings)
    {
      SCOPED_TRACE(std::string("shape ") + std::to_string(shape) + " as " + ending);
      Listened listened;
      const std::string path =
        Write(listened.Writer, model, "shape-" + std::to_string(shape) + "." + ending);
      EXPECT_EQ(listened.Warnings->Text, "");
      const auto again = ReadOne(path);
      EXPECT_EQ(vtkNURBSModel::Validate(again), "");
      if (shape == vtkNURBSShapeSource::PLATE)
      {
        continue; // Its islands become faces; see the test of it.
      }
      ASSERT_EQ(again->GetNumberOfCells(), model->GetNumberOfCells());
      order = order.empty() ? OrderOf(model, again) : order; // STEP comes first and keeps names.
      const TopoDS_Shape read = ReadShape(path);
      EXPECT_TRUE(BRepCheck_Analyzer(read).IsValid());
      const double edges = 2.0 * listened.Writer->GetEdgeTolerance();
      ExpectModelFaces(model, read, order, edges + 2e-6 * model->GetLength());
      area = area > 0.0 ? area : AreaOf(read);
      EXPECT_NEAR(AreaOf(read), area, (1e-7 + 20.0 * edges / model->GetLength()) * area);
    }
  }
}

/// By the polygons of the loops, in a plane whose parameters are lengths.
double AreaInLoops(const nurbs::Model& model)
{
  constexpr int Steps = 4096;
  double twice = 0.0;
  for (const nurbs::TrimCurve& trim : model.TrimCurves)
  {
    const nurbs::Interval range = trim.Geometry.Domain();
    nurbs::Vec2 before = nurbs::Evaluate(trim.Geometry, range.Min);
    for (int k = 1; k <= Steps; ++k)
    {
      const nurbs::Vec2 p =
        nurbs::Evaluate(trim.Geometry, range.Clamp(range.Min + range.Length() * k / Steps));
      twice += (trim.Reversed ? -1.0 : 1.0) * (before[0] * p[1] - before[1] * p[0]);
      before = p;
    }
  }
  return 0.5 * twice;
}

TEST(CADWriter, IslandsBecomeFaces)
{
  const auto model = Shape(vtkNURBSShapeSource::PLATE);
  ASSERT_EQ(model->GetNumberOfCells(), 1);
  const double area = AreaInLoops(vtkNURBSModel::View(model)->GetModel());
  for (const char* ending : Endings)
  {
    SCOPED_TRACE(ending);
    vtkNew<vtkNURBSCADWriter> writer;
    const TopoDS_Shape read = ReadShape(Write(writer, model, std::string("plate.") + ending));
    EXPECT_EQ(CountOf(read, TopAbs_FACE), 5) << "the plate, and rings and discs in its holes";
    EXPECT_EQ(writer->GetNumberOfFaces(), 5);
    EXPECT_EQ(writer->GetNumberOfSplitFaces(), 1);
    EXPECT_NEAR(AreaOf(read), area, 1e-6 * area);
  }
}

TEST(CADWriter, ClosedShapesAreSolids)
{
  const double pi = std::acos(-1.0);
  struct Case
  {
    int Shape;
    double Area, Volume;
  };
  for (const Case& c : { Case{ vtkNURBSShapeSource::SPHERE, 4.0 * pi, 4.0 / 3.0 * pi },
         Case{ vtkNURBSShapeSource::TORUS, 4.0 * pi * pi * 0.3, 2.0 * pi * pi * 0.09 },
         Case{ vtkNURBSShapeSource::CYLINDER, 6.0 * pi, 2.0 * pi },
         Case{ vtkNURBSShapeSource::CONE, (1.0 + std::sqrt(5.0)) * pi, 2.0 / 3.0 * pi } })
  {
    for (const char* ending : Endings)
    {
      SCOPED_TRACE(std::string("shape ") + std::to_string(c.Shape) + " as " + ending);
      vtkNew<vtkNURBSCADWriter> writer;
      const TopoDS_Shape read =
        ReadShape(Write(writer, Shape(c.Shape), std::string("closed.") + ending));
      EXPECT_EQ(CountOf(read, TopAbs_SOLID), 1);
      EXPECT_EQ(writer->GetNumberOfSolids(), 1);
      EXPECT_EQ(writer->GetNumberOfShells(), 0);
      EXPECT_NEAR(AreaOf(read), c.Area, 1e-6 * c.Area);
      EXPECT_NEAR(VolumeOf(read), c.Volume, 1e-6 * c.Volume);
    }
  }
}

TEST(CADWriter, SurfacesEdgesAndSolidsOfAFileStay)
{
  const char* const file = "/usr/share/opencascade/data/step/screw.step";
  const auto model = ReadOne(file);
  const TopoDS_Shape original = ReadShape(file);
  for (const char* ending : Endings)
  {
    SCOPED_TRACE(ending);
    vtkNew<vtkNURBSCADWriter> writer;
    const std::string path = Write(writer, model, std::string("screw.") + ending);
    const auto again = ReadOne(path);
    ASSERT_EQ(again->GetNumberOfCells(), model->GetNumberOfCells());
    EXPECT_LT(SurfaceDistance(model, again), 1e-9 * model->GetLength()) << "IGES has 11 digits";
    ExpectClosed(again);
    const TopoDS_Shape read = ReadShape(path);
    EXPECT_EQ(CountOf(read, TopAbs_SOLID), 1);
    EXPECT_EQ(SharedEdges(read), SharedEdges(original));
    EXPECT_EQ(writer->GetNumberOfSharedEdges(), 22);
    EXPECT_EQ(writer->GetNumberOfComputedEdges(), 0);
    EXPECT_NEAR(AreaOf(read), AreaOf(original), 1e-6 * AreaOf(original));
    EXPECT_NEAR(VolumeOf(read), VolumeOf(original), 1e-6 * VolumeOf(original));
  }
}

TEST(CADWriter, CavitiesStayInTheirSolid)
{
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(4.0, 4.0, 4.0).Shape();
  const TopoDS_Shape ball = BRepPrimAPI_MakeSphere(gp_Pnt(2, 2, 2), 1.0).Shape();
  const auto model = Convert(BRepAlgoAPI_Cut(box, ball).Shape(), "cavity-original");
  const double volume = 64.0 - 4.0 / 3.0 * std::acos(-1.0);
  for (const char* ending : Endings)
  {
    SCOPED_TRACE(ending);
    vtkNew<vtkNURBSCADWriter> writer;
    const TopoDS_Shape read = ReadShape(Write(writer, model, std::string("cavity.") + ending));
    EXPECT_EQ(CountOf(read, TopAbs_SOLID), 1);
    EXPECT_EQ(CountOf(read, TopAbs_SHELL), 2);
    EXPECT_EQ(writer->GetNumberOfSolids(), 1);
    EXPECT_EQ(writer->GetNumberOfShells(), 0);
    EXPECT_NEAR(VolumeOf(read), volume, 1e-6 * volume);
  }
}

TEST(CADWriter, VisibleRegionsHaveTheirArea)
{
  const auto model = ReadOne("/usr/share/opencascade/data/occ/Ball.brep");
  vtkNew<vtkNURBSVisibleRegions> regions;
  regions->SetInputData(0, model);
  regions->SetDirection(1.0, -0.7, 0.4);
  regions->Update();
  auto* visible = vtkUnstructuredGrid::SafeDownCast(regions->GetOutputDataObject(0));
  ASSERT_GT(visible->GetNumberOfCells(), 3);
  ASSERT_GT(regions->GetNumberOfPartialFaces(), 1);
  for (const char* ending : { "brep", "step", "iges" })
  {
    SCOPED_TRACE(ending);
    Listened listened;
    const std::string path = Write(listened.Writer, visible, std::string("visible.") + ending);
    EXPECT_GE(listened.Writer->GetNumberOfFaces(), visible->GetNumberOfCells());
    EXPECT_GT(listened.Writer->GetNumberOfComputedEdges(), 0);
    const TopoDS_Shape read = ReadShape(path);
    EXPECT_EQ(CountOf(read, TopAbs_FACE), listened.Writer->GetNumberOfFaces());
    EXPECT_NEAR(AreaOf(read), regions->GetVisibleArea(), 1e-4 * regions->GetVisibleArea());
  }
}

TEST(CADWriter, DeformedModelsGetNewEdges)
{
  const auto model = ReadOne("/usr/share/opencascade/data/step/screw.step");
  const double size = model->GetLength();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (vtkIdType i = 0; i < model->GetNumberOfPoints(); ++i)
  {
    double p[3];
    model->GetPoint(i, p);
    points->InsertNextPoint(p[0] + 0.2 * p[2], 1.3 * p[1], p[2] - 0.4 * p[0]);
  }
  model->SetPoints(points);
  for (const char* ending : Endings)
  {
    SCOPED_TRACE(ending);
    vtkNew<vtkNURBSCADWriter> writer;
    const std::string path = Write(writer, model, std::string("deformed.") + ending);
    EXPECT_GT(writer->GetNumberOfComputedEdges(), 15);
    EXPECT_EQ(writer->GetNumberOfTornEdges(), 0);
    EXPECT_EQ(writer->GetNumberOfSolids(), 1);
    EXPECT_LT(writer->GetEdgeTolerance(), 1e-4 * size);
    const auto again = ReadOne(path);
    ASSERT_EQ(again->GetNumberOfCells(), model->GetNumberOfCells());
    EXPECT_LT(SurfaceDistance(model, again), 1e-9 * size);
    const TopoDS_Shape read = ReadShape(path);
    EXPECT_EQ(CountOf(read, TopAbs_SOLID), 1);
    ExpectModelFaces(model, read, { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9 }, 2e-4 * size);
    // The map is linear.
    const double factor = 1.3 * (1.0 + 0.2 * 0.4);
    const TopoDS_Shape original = ReadShape("/usr/share/opencascade/data/step/screw.step");
    EXPECT_NEAR(VolumeOf(read), factor * VolumeOf(original), 1e-4 * VolumeOf(read));
  }
}

/// Two patches side by side that share the edge x = 1, the second one lifted by `gap`.
vtkSmartPointer<vtkUnstructuredGrid> TwoPatches(double gap)
{
  nurbs::ModelBuilder builder;
  nurbs::Curve<3> line;
  line.Knots = { 0.0, 0.0, 1.0, 1.0 };
  line.Points = { { 1, 0, 0 }, { 1, 1, 0 } };
  line.Weights = { 1.0, 1.0 };
  line.Pack();
  const auto a = builder.AddVertex(line.Points[0]), b = builder.AddVertex(line.Points[1]);
  const auto shared = builder.AddEdge(line.View(), 0.0, a, b);
  for (int i = 0; i < 2; ++i)
  {
    const nurbs::Surface patch = Patch(i, i == 0 ? 0.0 : gap);
    builder.BeginFace(patch.View(), nurbs::FaceAttributes());
    builder.BeginLoop();
    const nurbs::Vec2 corners[] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
    for (int k = 0; k < 4; ++k)
    {
      const bool common = k == (i == 0 ? 1 : 3); // On the second patch it runs backwards.
      nurbs::Curve<2> side;
      side.Knots = line.Knots;
      side.Weights = line.Weights;
      side.Points = { corners[k], corners[(k + 1) % 4] };
      if (common && i == 1)
      {
        std::swap(side.Points[0], side.Points[1]);
      }
      side.Pack();
      builder.AddTrimCurve(side.View(), common ? shared : -1, common && i == 1);
    }
  }
  return Store(builder);
}

TEST(CADWriter, EdgesAreTornWhereFacesAreApart)
{
  for (const char* ending : Endings)
  {
    SCOPED_TRACE(ending);
    Listened listened;
    const TopoDS_Shape whole =
      ReadShape(Write(listened.Writer, TwoPatches(0.0), std::string("whole.") + ending));
    EXPECT_EQ(SharedEdges(whole), 1);
    EXPECT_EQ(CountOf(whole, TopAbs_EDGE), 7);
    EXPECT_EQ(CountOf(whole, TopAbs_VERTEX), 6);
    EXPECT_EQ(listened.Writer->GetNumberOfShells(), 1);
    EXPECT_EQ(listened.Warnings->Text, "");

    const TopoDS_Shape torn =
      ReadShape(Write(listened.Writer, TwoPatches(0.1), std::string("torn.") + ending));
    EXPECT_EQ(SharedEdges(torn), 0);
    EXPECT_EQ(CountOf(torn, TopAbs_VERTEX), 8);
    EXPECT_EQ(listened.Writer->GetNumberOfTornEdges(), 1);
    EXPECT_EQ(listened.Writer->GetNumberOfShells(), 2);
    EXPECT_TRUE(listened.Warnings->Says("1 edge torn"));
    EXPECT_LT(listened.Writer->GetEdgeTolerance(), 1e-6);

    listened.Writer->SetGap(0.1);
    const TopoDS_Shape bridged =
      ReadShape(Write(listened.Writer, TwoPatches(0.1), std::string("bridged.") + ending));
    EXPECT_EQ(SharedEdges(bridged), 1);
    EXPECT_NEAR(listened.Writer->GetEdgeTolerance(), 0.1, 0.01);
  }
}

TEST(CADWriter, PeriodicSurfacesAreClamped)
{
  nurbs::Surface tube; // Closed in u, with knots that are not clamped.
  tube.Degree[0] = 2;
  tube.Count[0] = 8;
  tube.Count[1] = 2;
  for (int i = 0; i < 11; ++i)
  {
    tube.Knots[0].push_back(i);
  }
  tube.Knots[1] = { 0.0, 0.0, 1.0, 1.0 };
  for (int j = 0; j < 2; ++j)
  {
    for (int i = 0; i < 8; ++i)
    {
      const double angle = std::acos(-1.0) / 3.0 * i;
      tube.Points.emplace_back(std::cos(angle), std::sin(angle), 2.0 * j);
      tube.Weights.push_back(1.0 + (i % 2));
    }
  }
  nurbs::ModelBuilder builder;
  builder.BeginFace(tube.View(), nurbs::FaceAttributes());
  const auto model = Store(builder);
  SetNames(model, "tube");
  for (const char* ending : Endings)
  {
    SCOPED_TRACE(ending);
    vtkNew<vtkNURBSCADWriter> writer;
    const TopoDS_Shape read = ReadShape(Write(writer, model, std::string("tube.") + ending));
    EXPECT_EQ(writer->GetNumberOfEdges(), 3) << "two rims and a seam";
    EXPECT_TRUE(BRepCheck_Analyzer(read).IsValid());
    ExpectModelFaces(model, read, { 0 }, 1e-6);
  }
}

TEST(CADWriter, UnitsAreHonoured)
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

TEST(CADWriter, TreeNamesAndColoursComeBackFromSTEP)
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

TEST(CADWriter, BlocksWithoutATreeGetOne)
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

TEST(CADWriter, ColoursComeBackFromIGES)
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

TEST(CADWriter, ProgressGrowsAndAbortLeavesNoFile)
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

  vtkNew<vtkCallbackCommand> stop;
  stop->SetCallback([](vtkObject* caller, unsigned long, void*, void*) {
    static_cast<vtkNURBSCADWriter*>(caller)->SetAbortExecute(1);
  });
  writer->AddObserver(vtkCommand::ProgressEvent, stop);
  vtkNew<MessageKeeper> keeper;
  writer->AddObserver(vtkCommand::ErrorEvent, keeper);
  const std::string path = OutputPath("aborted.step");
  std::filesystem::remove(path);
  writer->SetFileName(path.c_str());
  writer->Write();
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_EQ(keeper->Text, "");
  EXPECT_EQ(writer->GetNumberOfFaces(), 0);
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
