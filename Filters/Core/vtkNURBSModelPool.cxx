// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSModelPool.h"

#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataAssembly.h"
#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationStringKey.h"
#include "vtkInformationVector.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"
#include "vtkNew.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"

#include <map>

namespace
{

// Appends a model to one that has others already.
void AppendModel(const nurbs::Model& part, nurbs::Model& all)
{
  const auto loops = std::int64_t(all.Loops.size());
  const auto curves = std::int64_t(all.TrimCurves.size());
  const auto edges = std::int64_t(all.Edges.size());
  const auto vertices = std::int64_t(all.Vertices.size());
  for (nurbs::Face face : part.Faces)
  {
    face.FirstLoop += loops;
    all.Faces.push_back(face);
  }
  for (nurbs::TrimLoop loop : part.Loops)
  {
    loop.FirstCurve += curves;
    all.Loops.push_back(loop);
  }
  for (nurbs::TrimCurve curve : part.TrimCurves)
  {
    curve.Edge = curve.Edge < 0 ? -1 : curve.Edge + edges;
    all.TrimCurves.push_back(curve);
  }
  for (nurbs::Edge edge : part.Edges)
  {
    for (std::int64_t& vertex : edge.Vertex)
    {
      vertex = vertex < 0 ? -1 : vertex + vertices;
    }
    all.Edges.push_back(edge);
  }
  all.Vertices.insert(all.Vertices.end(), part.Vertices.begin(), part.Vertices.end());
}

// Calls visit(leaf, flat index, what is told of it) until it returns false.
template <typename F>
void VisitLeaves(vtkDataObject* input, F visit)
{
  auto* composite = vtkCompositeDataSet::SafeDownCast(input);
  if (!composite)
  {
    visit(input, 0u, static_cast<vtkInformation*>(nullptr));
    return;
  }
  vtkSmartPointer<vtkCompositeDataIterator> at;
  at.TakeReference(composite->NewIterator());
  for (at->InitTraversal(); !at->IsDoneWithTraversal(); at->GoToNextItem())
  {
    if (!visit(at->GetCurrentDataObject(), at->GetCurrentFlatIndex(),
          at->HasCurrentMetaData() ? at->GetCurrentMetaData() : nullptr))
    {
      return;
    }
  }
}

// In an assembly, the name is that of the partitioned data set, and so is the index.
std::map<vtkDataObject*, std::string> AssemblyNames(vtkDataObject* input)
{
  std::map<vtkDataObject*, std::string> names;
  auto* assembly = vtkPartitionedDataSetCollection::SafeDownCast(input);
  for (unsigned int i = 0; assembly && i < assembly->GetNumberOfPartitionedDataSets(); ++i)
  {
    const std::string name = vtkNURBSModelPool::BlockName(
      i, assembly->HasMetaData(i) ? assembly->GetMetaData(i) : nullptr);
    for (unsigned int part = 0; part < assembly->GetNumberOfPartitions(i); ++part)
    {
      names[assembly->GetPartitionAsDataObject(i, part)] = name;
    }
  }
  return names;
}

bool IsEmptyGrid(vtkDataObject* leaf)
{
  auto* grid = vtkUnstructuredGrid::SafeDownCast(leaf);
  return grid && grid->GetNumberOfCells() == 0;
}

} // namespace

std::string vtkNURBSModelPool::Collect(vtkDataObject* input)
{
  std::vector<Block> blocks;
  const std::string problem = Find(input, blocks);
  for (const Block& block : blocks)
  {
    Leaf entry;
    entry.Grid = block.Grid;
    entry.Time = block.Grid->GetMTime();
    entry.View = vtkNURBSModel::View(block.Grid);
    entry.FirstFace = this->Model.Faces.size();
    entry.FirstEdge = std::int64_t(this->Model.Edges.size());
    const nurbs::Model& model = entry.View->GetModel();
    AppendModel(model, this->Model);
    entry.LastFace = this->Model.Faces.size();
    for (std::size_t f = 0; f < model.Faces.size(); ++f)
    {
      this->FaceErrors.push_back(entry.View->GetFaceError(vtkIdType(f)));
    }
    this->Leaves.push_back(std::move(entry));
  }
  return problem;
}

std::string vtkNURBSModelPool::BlockName(unsigned int index, vtkInformation* about)
{
  std::string name = "block " + std::to_string(index);
  if (about && about->Has(vtkCompositeDataSet::NAME()))
  {
    name += std::string(" (") + about->Get(vtkCompositeDataSet::NAME()) + ")";
  }
  return name + ": ";
}

std::string vtkNURBSModelPool::Find(vtkDataObject* input, std::vector<Block>& blocks)
{
  std::string problem;
  const std::map<vtkDataObject*, std::string> names = AssemblyNames(input);
  VisitLeaves(input, [&](vtkDataObject* leaf, unsigned int index, vtkInformation* about) {
    if (IsEmptyGrid(leaf))
    {
      return true;
    }
    auto* grid = vtkUnstructuredGrid::SafeDownCast(leaf);
    if (!grid || !vtkNURBSModel::IsModel(grid))
    {
      problem = "The input" +
        (input == leaf ? std::string() : "'s data set " + std::to_string(index)) +
        " is not a NURBS model: " +
        (grid ? "it lacks the arrays that describe surfaces" : "it is no vtkUnstructuredGrid");
      return false;
    }
    const auto named = names.find(leaf);
    blocks.push_back({ grid,
      named != names.end() ? named->second
        : input == leaf    ? ""
                           : BlockName(index, about) });
    return true;
  });
  return problem;
}

bool vtkNURBSModelPool::IsUpToDate(vtkDataObject* input) const
{
  std::size_t next = 0;
  bool same = true;
  VisitLeaves(input, [&](vtkDataObject* leaf, unsigned int, vtkInformation*) {
    if (!IsEmptyGrid(leaf))
    {
      same = next < this->Leaves.size() && this->Leaves[next].Grid == leaf &&
        this->Leaves[next].Time == leaf->GetMTime();
      ++next;
    }
    return same;
  });
  return same && next == this->Leaves.size();
}

namespace
{

vtkDataObject* NewLeaf(bool isModel)
{
  return isModel ? static_cast<vtkDataObject*>(vtkUnstructuredGrid::New()) : vtkPolyData::New();
}

} // namespace

bool vtkNURBSModelPool::MakeOutputs(
  vtkDataObject* input, vtkInformationVector* outputs, int ports, int modelPorts)
{
  if (!input)
  {
    return false;
  }
  const bool composite = input->IsA("vtkCompositeDataSet");
  for (int port = 0; port < ports; ++port)
  {
    const char* leaf = port < modelPorts ? "vtkUnstructuredGrid" : "vtkPolyData";
    const char* type = composite ? input->GetClassName() : leaf;
    vtkInformation* info = outputs->GetInformationObject(port);
    vtkDataObject* output = info->Get(vtkDataObject::DATA_OBJECT());
    if (output && std::string(output->GetClassName()) == type)
    {
      continue;
    }
    vtkSmartPointer<vtkDataObject> made;
    made.TakeReference(composite ? input->NewInstance() : NewLeaf(port < modelPorts));
    info->Set(vtkDataObject::DATA_OBJECT(), made);
  }
  return true;
}

void vtkNURBSModelPool::CopyTree(vtkDataObject* input, vtkDataObject* output)
{
  auto* from = vtkCompositeDataSet::SafeDownCast(input);
  auto* to = vtkCompositeDataSet::SafeDownCast(output);
  if (!from || !to)
  {
    output->Initialize();
    return;
  }
  to->CopyStructure(from);
  auto* models = vtkPartitionedDataSetCollection::SafeDownCast(from);
  auto* meshes = vtkPartitionedDataSetCollection::SafeDownCast(to);
  if (models && meshes && models->GetDataAssembly())
  {
    vtkNew<vtkDataAssembly> assembly;
    assembly->DeepCopy(models->GetDataAssembly());
    meshes->SetDataAssembly(assembly);
  }
}

template <typename LeafT>
std::vector<LeafT*> vtkNURBSModelPool::MakeLeaves(vtkDataObject* input, vtkDataObject* output) const
{
  std::vector<LeafT*> out;
  auto* from = vtkCompositeDataSet::SafeDownCast(input);
  auto* to = vtkCompositeDataSet::SafeDownCast(output);
  if (!from || !to)
  {
    out.assign(this->Leaves.size(), LeafT::SafeDownCast(output));
    return out;
  }
  vtkSmartPointer<vtkCompositeDataIterator> at;
  at.TakeReference(from->NewIterator());
  for (at->InitTraversal(); !at->IsDoneWithTraversal(); at->GoToNextItem())
  {
    if (!IsEmptyGrid(at->GetCurrentDataObject()))
    {
      vtkNew<LeafT> leaf;
      to->SetDataSet(at, leaf);
      out.push_back(leaf);
    }
  }
  return out;
}

template VTKNURBSFILTERSCORE_EXPORT std::vector<vtkPolyData*>
vtkNURBSModelPool::MakeLeaves<vtkPolyData>(vtkDataObject*, vtkDataObject*) const;
template VTKNURBSFILTERSCORE_EXPORT std::vector<vtkUnstructuredGrid*>
vtkNURBSModelPool::MakeLeaves<vtkUnstructuredGrid>(vtkDataObject*, vtkDataObject*) const;

void vtkNURBSModelPool::SetLeaves(
  vtkDataObject* input, vtkDataObject* output, const std::vector<vtkPolyData*>& leaves)
{
  auto* from = vtkCompositeDataSet::SafeDownCast(input);
  auto* to = vtkCompositeDataSet::SafeDownCast(output);
  if (!from || !to)
  {
    return;
  }
  std::size_t next = 0;
  vtkSmartPointer<vtkCompositeDataIterator> at;
  at.TakeReference(from->NewIterator());
  for (at->InitTraversal(); !at->IsDoneWithTraversal(); at->GoToNextItem())
  {
    if (!IsEmptyGrid(at->GetCurrentDataObject()) && next < leaves.size())
    {
      to->SetDataSet(at, leaves[next++]);
    }
  }
}
