// SPDX-License-Identifier: BSD-3-Clause
#include "testCADWriting.h"

#include "ModelFaceCheck.h"

#include "vtkCellData.h"
#include "vtkInformation.h"
#include "vtkStringArray.h"

#include <BRepGProp.hxx>
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

namespace
{

template <class Reader>
TopoDS_Shape ReadExchange(const std::string& path)
{
  Reader reader;
  EXPECT_EQ(reader.ReadFile(path.c_str()), IFSelect_RetDone) << path;
  reader.TransferRoots();
  return reader.OneShape();
}

} // namespace

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
  source->SetNumberOfPatches(60);
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
  const std::size_t step = order.size() / 3 + 1;
  for (std::size_t i = 0; i < order.size(); i += step)
  {
    const verify::ModelFaceReport report =
      verify::CheckModelFace(faces[std::size_t(order[i])], view->GetModel(), i, model->GetLength());
    EXPECT_LT(report.Surface, tolerance) << "face " << i;
    EXPECT_LT(report.Loops, tolerance) << "face " << i;
    EXPECT_FALSE(report.Inverted) << "face " << i;
  }
}

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

vtkSmartPointer<vtkUnstructuredGrid> Store(nurbs::ModelBuilder& builder)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNURBSModel::Store(builder, grid);
  return grid;
}

nurbs::Surface Patch(double x, double z)
{
  nurbs::Surface patch;
  patch.Count[0] = patch.Count[1] = 2;
  patch.Knots[0] = patch.Knots[1] = { 0.0, 0.0, 1.0, 1.0 };
  patch.Points = { { x, 0, z }, { x + 1, 0, z }, { x, 1, z }, { x + 1, 1, z } };
  return patch;
}

namespace
{

/// Of a circle of radius 1, (x, y, weight).
std::vector<nurbs::Vec3> ArcPoints(nurbs::Interval angles, int spans)
{
  const double half = 0.5 * angles.Length() / spans;
  std::vector<nurbs::Vec3> points;
  for (int i = 0; i <= 2 * spans; ++i)
  {
    const double weight = i % 2 == 0 ? 1.0 : std::cos(half), angle = angles.Min + i * half;
    points.emplace_back(std::cos(angle) / weight, std::sin(angle) / weight, weight);
  }
  return points;
}

} // namespace

nurbs::Surface BallPatch(double radius, nurbs::Interval u, nurbs::Interval v, int spans)
{
  nurbs::Surface patch;
  for (int dir = 0; dir < 2; ++dir)
  {
    patch.Degree[dir] = 2;
    patch.Count[dir] = 2 * spans + 1;
    patch.Knots[dir] = { 0.0 };
    for (int k = 0; k <= spans; ++k)
    {
      patch.Knots[dir].insert(patch.Knots[dir].end(), 2, k);
    }
    patch.Knots[dir].push_back(spans);
  }
  for (const nurbs::Vec3& meridian : ArcPoints(v, spans))
  {
    for (const nurbs::Vec3& parallel : ArcPoints(u, spans))
    {
      patch.Points.push_back(
        radius * nurbs::Vec3(meridian[0] * parallel[0], meridian[0] * parallel[1], meridian[1]));
      patch.Weights.push_back(meridian[2] * parallel[2]);
    }
  }
  return patch;
}

void AddSide(
  nurbs::ModelBuilder& builder, const std::vector<nurbs::Vec2>& points, std::int64_t edge)
{
  nurbs::Curve<2> side;
  side.Degree = static_cast<int>(points.size()) - 1;
  side.Knots.assign(points.size(), 0.0);
  side.Knots.insert(side.Knots.end(), points.size(), 1.0);
  side.Points = points;
  side.Weights.assign(points.size(), 1.0);
  side.Pack();
  builder.AddTrimCurve(side.View(), edge, false);
}

void AddFace(nurbs::ModelBuilder& builder, const nurbs::Surface& surface,
  const std::vector<nurbs::Vec2>& corners)
{
  builder.BeginFace(surface.View(), nurbs::FaceAttributes());
  builder.BeginLoop();
  for (std::size_t k = 0; k < corners.size(); ++k)
  {
    AddSide(builder, { corners[k], corners[(k + 1) % corners.size()] });
  }
}

vtkSmartPointer<vtkPartitionedDataSetCollection> Blocks(const Grids& models)
{
  auto all = vtkSmartPointer<vtkPartitionedDataSetCollection>::New();
  all->SetNumberOfPartitionedDataSets(static_cast<unsigned int>(models.size()));
  for (unsigned int i = 0; i < models.size(); ++i)
  {
    all->SetPartition(i, 0, models[i]);
    all->GetMetaData(i)->Set(vtkCompositeDataSet::NAME(), "part");
  }
  return all;
}

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
