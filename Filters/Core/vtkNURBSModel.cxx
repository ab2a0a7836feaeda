// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSModel.h"

#include "ModelBuilder.h"
#include "vtkNURBSModelNames.h"
#include "vtkNURBSModelPool.h"
#include "vtkNURBSModelView.h"
#include "vtkNURBSParallel.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkSignedCharArray.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cstring>

namespace names = vtkNURBSModelNames;

vtkStandardNewMacro(vtkNURBSModel);

vtkNURBSModel::vtkNURBSModel() = default;
vtkNURBSModel::~vtkNURBSModel() = default;

void vtkNURBSModel::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

bool vtkNURBSModel::Validate(vtkUnstructuredGrid* grid, std::vector<nurbs::ModelProblem>& problems)
{
  problems = vtkNURBSModelView(grid).GetProblems();
  return std::none_of(problems.begin(), problems.end(), [](const nurbs::ModelProblem& problem) {
    return problem.Severity == nurbs::ModelProblem::Level::Error;
  });
}

namespace
{

/// Appends the problems of one grid (or the lack of one), each line after `prefix`.
void AppendProblems(vtkDataObject* data, const std::string& prefix, std::string& text)
{
  const auto append = [&](const std::string& line) {
    text += (text.empty() ? "" : "\n") + prefix + line;
  };
  auto* grid = vtkUnstructuredGrid::SafeDownCast(data);
  if (!grid)
  {
    append(data ? std::string("error: a ") + data->GetClassName() + " is no vtkUnstructuredGrid"
                : std::string("error: there is no grid"));
    return;
  }
  const vtkNURBSModelView view(grid);
  for (const nurbs::ModelProblem& problem : view.GetProblems())
  {
    append(view.Describe(problem));
  }
}

void AppendProblems(vtkPartitionedDataSetCollection* assembly, std::string& text)
{
  for (unsigned int i = 0; i < assembly->GetNumberOfPartitionedDataSets(); ++i)
  {
    vtkInformation* about = assembly->HasMetaData(i) ? assembly->GetMetaData(i) : nullptr;
    for (unsigned int part = 0; part < assembly->GetNumberOfPartitions(i); ++part)
    {
      if (vtkDataObject* leaf = assembly->GetPartitionAsDataObject(i, part))
      {
        AppendProblems(leaf, vtkNURBSModelPool::BlockName(i, about), text);
      }
    }
  }
}

void AppendProblems(vtkCompositeDataSet* composite, std::string& text)
{
  vtkSmartPointer<vtkCompositeDataIterator> block;
  block.TakeReference(composite->NewIterator());
  for (block->InitTraversal(); !block->IsDoneWithTraversal(); block->GoToNextItem())
  {
    vtkInformation* about = block->HasCurrentMetaData() ? block->GetCurrentMetaData() : nullptr;
    AppendProblems(block->GetCurrentDataObject(),
      vtkNURBSModelPool::BlockName(block->GetCurrentFlatIndex(), about), text);
  }
}

} // namespace

std::string vtkNURBSModel::Validate(vtkDataObject* data)
{
  std::string text;
  if (auto* assembly = vtkPartitionedDataSetCollection::SafeDownCast(data))
  {
    AppendProblems(assembly, text);
  }
  else if (auto* composite = vtkCompositeDataSet::SafeDownCast(data))
  {
    AppendProblems(composite, text);
  }
  else
  {
    AppendProblems(data, "", text);
  }
  return text;
}

std::shared_ptr<const vtkNURBSModelView> vtkNURBSModel::View(vtkUnstructuredGrid* grid)
{
  return std::make_shared<const vtkNURBSModelView>(grid);
}

bool vtkNURBSModel::IsModel(vtkUnstructuredGrid* grid)
{
  return grid && grid->GetCellData()->HasArray(names::Degree) &&
    grid->GetCellData()->HasArray(names::NetSize) &&
    grid->GetCellData()->HasArray(names::KnotStart) && grid->GetFieldData()->HasArray(names::Knots);
}

bool vtkNURBSModel::IsTrimArray(const char* name)
{
  for (const char* trim : { names::LoopStart, names::LoopCount, names::LoopCurveStart,
         names::LoopCurveCount, names::TrimCurveDegree, names::TrimCurveKnotStart,
         names::TrimCurvePointStart, names::TrimCurvePointCount, names::TrimCurveEdgeId,
         names::TrimCurveReversed, names::TrimPoints, names::TrimKnots, names::EdgeDegree,
         names::EdgeKnotStart, names::EdgePointStart, names::EdgePointCount, names::EdgeVertices,
         names::EdgeTolerance, names::EdgePoints, names::EdgeKnots, names::VertexPoints,
         names::EdgeGlobalId, names::VertexGlobalId })
  {
    if (name && !strcmp(name, trim))
    {
      return true;
    }
  }
  return false;
}

bool vtkNURBSModel::IsStructureArray(const char* name)
{
  for (const char* structure : { names::Degree, names::NetSize, names::KnotStart, names::LoopStart,
         names::LoopCount, names::Orientation })
  {
    if (name && !strcmp(name, structure))
    {
      return true;
    }
  }
  return false;
}

namespace
{

/// Moves `values` into a new array of `data`, converted to the array's type.
template <typename ArrayType, typename ValueType>
void MoveArray(vtkFieldData* data, const char* name, int components, std::vector<ValueType>& values)
{
  vtkNew<ArrayType> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()) / components);
  std::transform(values.begin(), values.end(), array->GetPointer(0),
    [](ValueType value) { return static_cast<typename ArrayType::ValueType>(value); });
  data->AddArray(array);
  std::vector<ValueType>().swap(values);
}

void AddStrings(vtkFieldData* data, const char* name, const std::vector<std::string>& values)
{
  vtkNew<vtkStringArray> array;
  array->SetName(name);
  array->SetNumberOfValues(static_cast<vtkIdType>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    array->SetValue(static_cast<vtkIdType>(i), values[i]);
  }
  data->AddArray(array);
}

void StoreGeometry(nurbs::ModelBuilder::Storage& d, vtkUnstructuredGrid* grid)
{
  vtkNew<vtkDoubleArray> coordinates;
  coordinates->SetNumberOfComponents(3);
  coordinates->SetNumberOfTuples(static_cast<vtkIdType>(d.Points.size() / 3));
  std::copy(d.Points.begin(), d.Points.end(), coordinates->GetPointer(0));
  std::vector<double>().swap(d.Points);
  vtkNew<vtkPoints> points;
  points->SetData(coordinates);
  grid->SetPoints(points);

  vtkNew<vtkTypeInt64Array> offsets, connectivity;
  offsets->SetNumberOfValues(static_cast<vtkIdType>(d.Offsets.size()));
  std::copy(d.Offsets.begin(), d.Offsets.end(), offsets->GetPointer(0));
  connectivity->SetNumberOfValues(static_cast<vtkIdType>(d.Connectivity.size()));
  std::copy(d.Connectivity.begin(), d.Connectivity.end(), connectivity->GetPointer(0));
  vtkNew<vtkCellArray> cells;
  cells->SetData(offsets, connectivity);
  grid->SetCells(VTK_POLY_VERTEX, cells);
  std::vector<std::int64_t>().swap(d.Connectivity);
  d.Offsets.assign(1, 0);
  if (!d.Weights.empty())
  {
    MoveArray<vtkDoubleArray>(grid->GetPointData(), names::RationalWeights, 1, d.Weights);
  }
}

void StoreFaces(nurbs::ModelBuilder::Storage& d, vtkFieldData* cells)
{
  MoveArray<vtkIntArray>(cells, names::Degree, 2, d.Degree);
  MoveArray<vtkIntArray>(cells, names::NetSize, 2, d.NetSize);
  MoveArray<vtkTypeInt64Array>(cells, names::KnotStart, 2, d.KnotStart);
  MoveArray<vtkTypeInt64Array>(cells, names::LoopStart, 1, d.LoopStart);
  MoveArray<vtkTypeInt64Array>(cells, names::LoopCount, 1, d.LoopCount);
  MoveArray<vtkTypeInt64Array>(cells, names::FaceId, 1, d.FaceId);
  MoveArray<vtkSignedCharArray>(cells, names::Orientation, 1, d.Orientation);
  MoveArray<vtkUnsignedCharArray>(cells, names::Color, 3, d.Color);
  AddStrings(cells, names::Name, d.Name);
  d.Name.clear();
}

void StoreTrims(nurbs::ModelBuilder::Storage& d, vtkFieldData* field)
{
  MoveArray<vtkTypeInt64Array>(field, names::LoopCurveStart, 1, d.LoopCurveStart);
  MoveArray<vtkTypeInt64Array>(field, names::LoopCurveCount, 1, d.LoopCurveCount);
  MoveArray<vtkIntArray>(field, names::TrimCurveDegree, 1, d.TrimCurveDegree);
  MoveArray<vtkTypeInt64Array>(field, names::TrimCurveKnotStart, 1, d.TrimCurveKnotStart);
  MoveArray<vtkTypeInt64Array>(field, names::TrimCurvePointStart, 1, d.TrimCurvePointStart);
  MoveArray<vtkTypeInt64Array>(field, names::TrimCurvePointCount, 1, d.TrimCurvePointCount);
  MoveArray<vtkTypeInt64Array>(field, names::TrimCurveEdgeId, 1, d.TrimCurveEdgeId);
  MoveArray<vtkSignedCharArray>(field, names::TrimCurveReversed, 1, d.TrimCurveReversed);
  MoveArray<vtkDoubleArray>(field, names::TrimPoints, 3, d.TrimPoints);
  MoveArray<vtkDoubleArray>(field, names::TrimKnots, 1, d.TrimKnots);
}

void StoreEdges(nurbs::ModelBuilder::Storage& d, vtkFieldData* field)
{
  MoveArray<vtkIntArray>(field, names::EdgeDegree, 1, d.EdgeDegree);
  MoveArray<vtkTypeInt64Array>(field, names::EdgeKnotStart, 1, d.EdgeKnotStart);
  MoveArray<vtkTypeInt64Array>(field, names::EdgePointStart, 1, d.EdgePointStart);
  MoveArray<vtkTypeInt64Array>(field, names::EdgePointCount, 1, d.EdgePointCount);
  MoveArray<vtkTypeInt64Array>(field, names::EdgeVertices, 2, d.EdgeVertices);
  MoveArray<vtkDoubleArray>(field, names::EdgeTolerance, 1, d.EdgeTolerance);
  MoveArray<vtkDoubleArray>(field, names::EdgePoints, 4, d.EdgePoints);
  MoveArray<vtkDoubleArray>(field, names::EdgeKnots, 1, d.EdgeKnots);
  MoveArray<vtkDoubleArray>(field, names::VertexPoints, 3, d.VertexPoints);
}

} // namespace

void vtkNURBSModel::Store(nurbs::ModelBuilder& builder, vtkUnstructuredGrid* grid)
{
  grid->Initialize();
  nurbs::ModelBuilder::Storage& d = builder.Data;
  StoreGeometry(d, grid);
  StoreFaces(d, grid->GetCellData());
  MoveArray<vtkDoubleArray>(grid->GetFieldData(), names::Knots, 1, d.Knots);
  StoreTrims(d, grid->GetFieldData());
  StoreEdges(d, grid->GetFieldData());
  AddStrings(grid->GetFieldData(), names::LengthUnit, { builder.LengthUnit });
}

namespace
{

/// to[k] = from[tuples[k]] for arrays of one type and number of components.
void CopyTuples(vtkAbstractArray* from, vtkIdTypeArray* tuples, vtkAbstractArray* to)
{
  const vtkIdType count = tuples->GetNumberOfTuples();
  const vtkIdType* ids = tuples->GetPointer(0);
  const int width = from->GetNumberOfComponents();
  auto* strings = vtkStringArray::SafeDownCast(from);
  auto* newStrings = vtkStringArray::SafeDownCast(to);
  if (strings && newStrings)
  {
    vtkNURBSParallelFor(0, width * count, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t k = begin; k < end; ++k)
      {
        *newStrings->GetPointer(k) = *strings->GetPointer(width * ids[k / width] + k % width);
      }
    });
    return;
  }
  auto* numbers = vtkDataArray::SafeDownCast(from);
  if (!numbers || !numbers->HasStandardMemoryLayout() || !to->HasStandardMemoryLayout() ||
    from->GetDataType() == VTK_BIT)
  {
    for (vtkIdType k = 0; k < count; ++k)
    {
      to->SetTuple(k, ids[k], from);
    }
    return;
  }
  const std::size_t bytes = static_cast<std::size_t>(from->GetDataTypeSize()) * width;
  const char* source = static_cast<const char*>(from->GetVoidPointer(0));
  char* target = static_cast<char*>(to->GetVoidPointer(0));
  vtkNURBSParallelFor(0, count, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t k = begin; k < end; ++k)
    {
      std::memcpy(target + k * bytes, source + ids[k] * bytes, bytes);
    }
  });
}

} // namespace

void vtkNURBSModel::CopyFaceAttributes(
  vtkUnstructuredGrid* grid, vtkIdTypeArray* faces, vtkDataSetAttributes* target)
{
  vtkCellData* source = grid->GetCellData();
  const vtkIdType count = faces->GetNumberOfTuples();
  for (int i = 0; i < source->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* from = source->GetAbstractArray(i);
    if (IsStructureArray(from->GetName()) || !from->GetName() ||
      from->GetNumberOfTuples() != grid->GetNumberOfCells())
    {
      continue;
    }
    vtkSmartPointer<vtkAbstractArray> to;
    to.TakeReference(from->NewInstance());
    to->SetName(from->GetName());
    to->SetNumberOfComponents(from->GetNumberOfComponents());
    to->CopyComponentNames(from);
    to->SetNumberOfTuples(count);
    CopyTuples(from, faces, to);
    target->AddArray(to);
  }
  vtkAbstractArray* identity = source->GetAbstractArray(names::FaceId);
  if (!identity || identity->GetNumberOfTuples() != grid->GetNumberOfCells())
  {
    vtkNew<vtkTypeInt64Array> ids;
    ids->SetName(names::FaceId);
    ids->SetNumberOfValues(count);
    std::copy_n(faces->GetPointer(0), count, ids->GetPointer(0));
    target->AddArray(ids);
  }
}

namespace
{
constexpr const char* StructureNames[] = { names::Knots, names::LoopCurveStart,
  names::LoopCurveCount, names::TrimCurveDegree, names::TrimCurveKnotStart,
  names::TrimCurvePointStart, names::TrimCurvePointCount, names::TrimCurveEdgeId,
  names::TrimCurveReversed, names::TrimPoints, names::TrimKnots, names::EdgeDegree,
  names::EdgeKnotStart, names::EdgePointStart, names::EdgePointCount, names::EdgeVertices,
  names::EdgeTolerance, names::EdgePoints, names::EdgeKnots, names::VertexPoints,
  names::EdgeGlobalId, names::VertexGlobalId, names::WholeBounds };
} // namespace

std::vector<vtkAbstractArray*> vtkNURBSModel::GetStructureArrays(vtkUnstructuredGrid* grid)
{
  std::vector<vtkAbstractArray*> arrays;
  const auto append = [&arrays](vtkAbstractArray* array) {
    if (array)
    {
      arrays.push_back(array);
    }
  };
  for (const char* name : { names::Degree, names::NetSize, names::KnotStart, names::LoopStart,
         names::LoopCount, names::Orientation })
  {
    append(grid->GetCellData()->GetAbstractArray(name));
  }
  for (const char* name : StructureNames)
  {
    append(grid->GetFieldData()->GetAbstractArray(name));
  }
  return arrays;
}

vtkDataArray* vtkNURBSModel::GetWeights(vtkUnstructuredGrid* grid)
{
  return grid->GetPointData()->GetArray(names::RationalWeights);
}

void vtkNURBSModel::RemoveStructure(vtkFieldData* field)
{
  for (const char* name : StructureNames)
  {
    field->RemoveArray(name);
  }
}

void vtkNURBSModel::PassWithoutStructure(vtkFieldData* model, vtkFieldData* output)
{
  output->AllocateArrays(output->GetNumberOfArrays() + model->GetNumberOfArrays());
  for (int k = 0; k < model->GetNumberOfArrays(); ++k)
  {
    vtkAbstractArray* array = model->GetAbstractArray(k);
    const char* name = array->GetName();
    if (!name ||
      std::none_of(std::begin(StructureNames), std::end(StructureNames),
        [&](const char* structure) { return std::strcmp(structure, name) == 0; }))
    {
      output->AddArray(array);
    }
  }
}

vtkIdType vtkNURBSModel::GetFaceId(vtkUnstructuredGrid* grid, vtkIdType cell)
{
  vtkDataArray* ids = grid->GetCellData()->GetArray(names::FaceId);
  return ids && cell < ids->GetNumberOfTuples() ? static_cast<vtkIdType>(ids->GetTuple1(cell))
                                                : cell;
}

void vtkNURBSModel::SetGlobalIds(
  vtkUnstructuredGrid* grid, std::vector<std::int64_t>& edges, std::vector<std::int64_t>& vertices)
{
  MoveArray<vtkTypeInt64Array>(grid->GetFieldData(), names::EdgeGlobalId, 1, edges);
  MoveArray<vtkTypeInt64Array>(grid->GetFieldData(), names::VertexGlobalId, 1, vertices);
}

void vtkNURBSModel::SetWholeBounds(vtkUnstructuredGrid* grid, const nurbs::Box3& box)
{
  vtkNew<vtkDoubleArray> bounds;
  bounds->SetName(names::WholeBounds);
  bounds->SetNumberOfComponents(6);
  bounds->SetNumberOfTuples(1);
  for (int k = 0; k < 3; ++k)
  {
    bounds->SetTypedComponent(0, 2 * k, box.min()[k]);
    bounds->SetTypedComponent(0, 2 * k + 1, box.max()[k]);
  }
  grid->GetFieldData()->AddArray(bounds);
}

bool vtkNURBSModel::HasGlobalIds(vtkUnstructuredGrid* grid)
{
  vtkFieldData* field = grid->GetFieldData();
  return field->HasArray(names::EdgeGlobalId) && field->HasArray(names::VertexGlobalId);
}

const char* vtkNURBSModel::FaceIdName()
{
  return names::FaceId;
}

const char* vtkNURBSModel::WeightsName()
{
  return names::RationalWeights;
}

const char* vtkNURBSModel::EdgeIdName()
{
  return names::EdgeId;
}

const char* vtkNURBSModel::ColorName()
{
  return names::Color;
}

const char* vtkNURBSModel::NameName()
{
  return names::Name;
}

std::string vtkNURBSModel::GetLengthUnit(vtkUnstructuredGrid* grid)
{
  auto* unit =
    vtkStringArray::SafeDownCast(grid->GetFieldData()->GetAbstractArray(names::LengthUnit));
  return unit && unit->GetNumberOfValues() > 0 ? unit->GetValue(0) : std::string();
}

void vtkNURBSModel::SetUnconvertedFaces(
  vtkUnstructuredGrid* grid, const std::vector<std::string>& reasons)
{
  AddStrings(grid->GetFieldData(), names::UnconvertedFaces, reasons);
}

std::vector<std::string> vtkNURBSModel::GetUnconvertedFaces(vtkUnstructuredGrid* grid)
{
  auto* stored =
    vtkStringArray::SafeDownCast(grid->GetFieldData()->GetAbstractArray(names::UnconvertedFaces));
  std::vector<std::string> reasons;
  for (vtkIdType i = 0; stored && i < stored->GetNumberOfValues(); ++i)
  {
    reasons.push_back(stored->GetValue(i));
  }
  return reasons;
}
