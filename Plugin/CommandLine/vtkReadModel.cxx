// SPDX-License-Identifier: BSD-3-Clause
#include "vtkReadModel.h"

#include "Arguments.h"
#include "Failure.h"
#include "SurfaceEvaluator.h"
#include "vtkMessages.h"
#include "vtkWriteMesh.h"

#include "vtkAppendPolyData.h"
#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkFieldData.h"
#include "vtkNURBSCADReader.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"
#include "vtkNew.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"
#include "vtkXMLPartitionedDataSetCollectionReader.h"
#include "vtkXMLUnstructuredGridReader.h"

#include <filesystem>

namespace nurbs
{
namespace
{

template <typename Reader>
vtkSmartPointer<vtkDataObject> Read(
  Reader* reader, const std::string& path, const ProgressFunction& progress)
{
  reader->SetFileName(path.c_str());
  Run(reader, progress);
  return reader->GetOutputDataObject(0);
}

vtkSmartPointer<vtkDataObject> ReadCAD(
  const Arguments& arguments, bool single, const ProgressFunction& progress)
{
  vtkNew<vtkNURBSCADReader> reader;
  reader->SetSingleModel(single);
  switch (arguments.Unit)
  {
    case LengthUnit::Millimetres:
      reader->SetLengthUnitToMillimetres();
      break;
    case LengthUnit::Metres:
      reader->SetLengthUnitToMetres();
      break;
    case LengthUnit::File:
      reader->SetLengthUnitToFileUnit();
      break;
  }
  return Read(reader.Get(), arguments.Model, progress);
}

template <typename Data>
std::vector<Data*> LeavesOf(vtkDataObject* data)
{
  std::vector<Data*> leaves;
  if (auto* single = Data::SafeDownCast(data))
  {
    leaves.push_back(single);
  }
  else if (auto* composite = vtkCompositeDataSet::SafeDownCast(data))
  {
    vtkSmartPointer<vtkCompositeDataIterator> each;
    each.TakeReference(composite->NewIterator());
    for (each->InitTraversal(); !each->IsDoneWithTraversal(); each->GoToNextItem())
    {
      if (auto* leaf = Data::SafeDownCast(each->GetCurrentDataObject()))
      {
        leaves.push_back(leaf);
      }
    }
  }
  return leaves;
}

// The field arrays of the first leaf, followed by those of the same name of the others.
vtkSmartPointer<vtkFieldData> JoinedFields(const std::vector<vtkPolyData*>& leaves)
{
  auto joined = vtkSmartPointer<vtkFieldData>::New();
  joined->DeepCopy(leaves[0]->GetFieldData());
  for (int i = 0; i < joined->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = joined->GetAbstractArray(i);
    for (size_t leaf = 1; leaf < leaves.size(); ++leaf)
    {
      vtkAbstractArray* more = leaves[leaf]->GetFieldData()->GetAbstractArray(array->GetName());
      if (more && more->GetDataType() == array->GetDataType() &&
        more->GetNumberOfComponents() == array->GetNumberOfComponents())
      {
        array->InsertTuples(array->GetNumberOfTuples(), more->GetNumberOfTuples(), 0, more);
      }
    }
  }
  return joined;
}

// The box of the loops' control points within the domain, or the domain.
Box2 TrimBox(const Model& model, const Face& face)
{
  const Interval u = face.Geometry.Domain(0), v = face.Geometry.Domain(1);
  const Box2 domain(Vec2(u.Min, v.Min), Vec2(u.Max, v.Max));
  Box2 box;
  for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
  {
    const TrimLoop& loop = model.Loops[static_cast<size_t>(l)];
    for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
    {
      const CurveView<2>& curve = model.TrimCurves[static_cast<size_t>(c)].Geometry;
      for (int i = 0; i < curve.Count; ++i)
      {
        box.extend(curve.Point(i));
      }
    }
  }
  const Box2 common = box.intersection(domain);
  return common.isEmpty() ? domain : common;
}

void SampleFace(const Model& model, const Face& face, vtkPoints* samples)
{
  constexpr int Steps = 6;
  if (face.Geometry.Size() == 0)
  {
    return;
  }
  const Box2 box = TrimBox(model, face);
  std::vector<double> values[2];
  for (int i = 0; i <= Steps; ++i)
  {
    const Vec2 at = box.min() + box.sizes() * (static_cast<double>(i) / Steps);
    values[0].push_back(at[0]);
    values[1].push_back(at[1]);
  }
  std::vector<double> points(3 * values[0].size() * values[1].size());
  SurfaceEvaluator(face.Geometry).Grid(values[0], values[1], points.data(), nullptr);
  for (size_t i = 0; i < points.size(); i += 3)
  {
    samples->InsertNextPoint(points.data() + i);
  }
}

} // namespace

//--------------------------------------------------------------------------------------------------
void Run(vtkAlgorithm* algorithm, const ProgressFunction& progress)
{
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(const_cast<ProgressFunction*>(&progress));
  command->SetCallback([](vtkObject*, unsigned long, void* client, void* amount) {
    (*static_cast<const ProgressFunction*>(client))(*static_cast<const double*>(amount));
  });
  const unsigned long tag = algorithm->AddObserver(vtkCommand::ProgressEvent, command);
  algorithm->Update();
  algorithm->RemoveObserver(tag);
  auto* messages = vtkMessages::SafeDownCast(vtkOutputWindow::GetInstance());
  const std::string error = messages ? messages->GetFirstError() : std::string();
  if (!error.empty())
  {
    throw Failure(error);
  }
}

//--------------------------------------------------------------------------------------------------
vtkSmartPointer<vtkDataObject> ReadModel(
  const Arguments& arguments, bool single, const ProgressFunction& progress)
{
  const std::string& path = arguments.Model;
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
  {
    throw Failure("cannot read " + path + ": there is no such file");
  }
  if (std::filesystem::is_directory(path, ignored))
  {
    throw Failure("cannot read " + path + ": it is a folder");
  }
  const std::string ending = Ending(path);
  vtkSmartPointer<vtkDataObject> model;
  if (ending == ".vtu")
  {
    model = Read(vtkNew<vtkXMLUnstructuredGridReader>().Get(), path, progress);
  }
  else if (ending == ".vtpc")
  {
    model = Read(vtkNew<vtkXMLPartitionedDataSetCollectionReader>().Get(), path, progress);
  }
  else
  {
    model = ReadCAD(arguments, single, progress);
  }
  vtkIdType faces = 0;
  for (vtkUnstructuredGrid* part : PartsOf(model))
  {
    if (part->GetNumberOfCells() > 0 && !vtkNURBSModel::IsModel(part))
    {
      throw Failure("cannot use " + path + ": it is VTK data, but not a model of NURBS surfaces");
    }
    faces += part->GetNumberOfCells();
  }
  if (faces == 0)
  {
    throw Failure("cannot use " + path + ": there is no face in it");
  }
  return model;
}

//--------------------------------------------------------------------------------------------------
std::vector<vtkUnstructuredGrid*> PartsOf(vtkDataObject* model)
{
  return LeavesOf<vtkUnstructuredGrid>(model);
}

//--------------------------------------------------------------------------------------------------
vtkSmartPointer<vtkPoints> SamplesOf(vtkDataObject* model)
{
  auto samples = vtkSmartPointer<vtkPoints>::New();
  samples->SetDataTypeToDouble();
  for (vtkUnstructuredGrid* part : PartsOf(model))
  {
    const auto view = vtkNURBSModel::View(part);
    for (const Face& face : view->GetModel().Faces)
    {
      SampleFace(view->GetModel(), face, samples);
    }
  }
  return samples;
}

//--------------------------------------------------------------------------------------------------
vtkSmartPointer<vtkPolyData> Joined(vtkDataObject* output)
{
  const std::vector<vtkPolyData*> leaves = LeavesOf<vtkPolyData>(output);
  if (leaves.size() == 1)
  {
    return leaves[0];
  }
  vtkNew<vtkAppendPolyData> append;
  for (vtkPolyData* leaf : leaves)
  {
    append->AddInputData(leaf);
  }
  if (leaves.empty())
  {
    return vtkSmartPointer<vtkPolyData>::New();
  }
  append->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  append->Update();
  vtkSmartPointer<vtkPolyData> mesh = append->GetOutput();
  mesh->SetFieldData(JoinedFields(leaves));
  return mesh;
}

} // namespace nurbs
