// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSCADTree.h"

#include "vtkNURBSModel.h"
#include "vtkNURBSModelPool.h"

#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataAssembly.h"
#include "vtkInformation.h"
#include "vtkInformationStringKey.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <deque>
#include <map>

namespace vtkNURBSCADTree
{

namespace
{

std::string NameOf(vtkInformation* about)
{
  const char* name = about && about->Has(vtkCompositeDataSet::NAME())
    ? about->Get(vtkCompositeDataSet::NAME())
    : nullptr;
  return name ? name : "";
}

struct Place
{
  std::string Name;
  int DataSet = -1;
};

/// Where each leaf of a composite is; several places, in the order of traversal, if it is there
/// several times. In a collection the names are those of the data sets.
using LeafPlaces = std::map<vtkDataObject*, std::deque<Place>>;

LeafPlaces Places(vtkDataObject* input)
{
  LeafPlaces places;
  if (auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(input))
  {
    for (unsigned int i = 0; i < collection->GetNumberOfPartitionedDataSets(); ++i)
    {
      const std::string name = collection->HasMetaData(i) ? NameOf(collection->GetMetaData(i)) : "";
      for (unsigned int part = 0; part < collection->GetNumberOfPartitions(i); ++part)
      {
        places[collection->GetPartitionAsDataObject(i, part)].push_back(
          { name, static_cast<int>(i) });
      }
    }
  }
  else if (auto* composite = vtkCompositeDataSet::SafeDownCast(input))
  {
    vtkSmartPointer<vtkCompositeDataIterator> at;
    at.TakeReference(composite->NewIterator());
    for (at->InitTraversal(); !at->IsDoneWithTraversal(); at->GoToNextItem())
    {
      places[at->GetCurrentDataObject()].push_back(
        { at->HasCurrentMetaData() ? NameOf(at->GetCurrentMetaData()) : "", -1 });
    }
  }
  return places;
}

/// Makes the nodes, parents before children.
class NodeMaker
{
public:
  NodeMaker(vtkDataObject* input, const std::vector<Block>& blocks,
    const std::vector<std::int64_t>& parts, const std::string& root, nurbs::CADContent& content)
    : Blocks(blocks)
    , Parts(parts)
    , Root(root)
    , Content(content)
  {
    if (auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(input))
    {
      this->Tree = collection->GetDataAssembly();
    }
  }

  void Run()
  {
    if (this->Tree)
    {
      this->AddTree();
    }
    std::vector<std::size_t> left;
    for (std::size_t i = 0; i < this->Blocks.size(); ++i)
    {
      if (this->Parts[i] >= 0 && this->Placed.count(i) == 0)
      {
        left.push_back(i);
      }
    }
    std::int64_t parent = -1;
    if (left.size() > 1 && this->Content.Nodes.empty())
    {
      parent = this->AddNode(-1, this->Root, "", -1);
    }
    for (const std::size_t block : left)
    {
      this->AddBlock(parent, block, left.size() == 1 ? this->Root : std::string());
    }
  }

private:
  std::int64_t AddNode(
    std::int64_t parent, const std::string& name, const std::string& instance, std::int64_t part)
  {
    this->Content.Nodes.push_back({ parent, name, instance, part, TopLoc_Location() });
    if (part >= 0)
    {
      this->Content.Parts[part].Name = name;
    }
    return static_cast<std::int64_t>(this->Content.Nodes.size()) - 1;
  }

  /// A block by its own name, that of its faces, or `other`.
  void AddBlock(std::int64_t parent, std::size_t block, const std::string& other)
  {
    std::string name = this->Blocks[block].Name;
    name = name.empty() ? this->Content.Parts[this->Parts[block]].Name : name;
    name = name.empty() ? other : name;
    name = name.empty() ? "block " + std::to_string(block) : name;
    this->AddNode(parent, name, "", this->Parts[block]);
    this->Placed[block] = true;
  }

  std::string Attribute(int node, const char* name) const
  {
    return this->Tree->GetAttributeOrDefault(node, name, "");
  }

  std::string Label(int node) const
  {
    const std::string label = this->Attribute(node, "label");
    return label.empty() ? this->Tree->GetNodeName(node) : label;
  }

  /// The blocks of a node itself that have a part.
  std::vector<std::size_t> BlocksOf(int node) const
  {
    const std::vector<unsigned int> sets = this->Tree->GetDataSetIndices(node, false);
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < this->Blocks.size(); ++i)
    {
      const bool here = std::find(sets.begin(), sets.end(),
                          static_cast<unsigned int>(this->Blocks[i].DataSet)) != sets.end();
      if (this->Blocks[i].DataSet >= 0 && here && this->Parts[i] >= 0 && this->Placed.count(i) == 0)
      {
        found.push_back(i);
      }
    }
    return found;
  }

  void AddTree()
  {
    const int root = vtkDataAssembly::GetRootNode();
    const std::vector<std::size_t> own = this->BlocksOf(root);
    const std::vector<int> children = this->Tree->GetChildNodes(root, false);
    if (own.size() == 1 && children.empty())
    {
      this->AddNode(-1, this->Label(root), "", this->Parts[own[0]]);
      this->Placed[own[0]] = true;
      return;
    }
    for (const std::size_t block : own)
    {
      this->AddBlock(-1, block, "");
    }
    for (const int child : children)
    {
      this->AddBranch(-1, child);
    }
  }

  /// False if there is no part below the node; then nothing was added.
  bool AddBranch(std::int64_t parent, int node)
  {
    const std::vector<std::size_t> own = this->BlocksOf(node);
    const std::vector<int> children = this->Tree->GetChildNodes(node, false);
    const std::string label = this->Label(node);
    const std::string instance = this->Attribute(node, "instance");
    if (own.size() == 1 && children.empty())
    {
      this->AddNode(parent, label, instance, this->Parts[own[0]]);
      this->Placed[own[0]] = true;
      return true;
    }
    const std::int64_t self = this->AddNode(parent, label, instance, -1);
    for (const std::size_t block : own)
    {
      this->AddBlock(self, block, "");
    }
    bool some = !own.empty();
    for (const int child : children)
    {
      some = this->AddBranch(self, child) || some;
    }
    if (!some)
    {
      this->Content.Nodes.pop_back();
    }
    return some;
  }

  const std::vector<Block>& Blocks;
  const std::vector<std::int64_t>& Parts;
  const std::string& Root;
  nurbs::CADContent& Content;
  vtkDataAssembly* Tree = nullptr;
  std::map<std::size_t, bool> Placed;
};

} // namespace

std::string Find(vtkDataObject* input, std::vector<Block>& blocks)
{
  std::vector<vtkNURBSModelPool::Block> found;
  const std::string problem = vtkNURBSModelPool::Find(input, found);
  LeafPlaces places = Places(input);
  for (const vtkNURBSModelPool::Block& block : found)
  {
    Place place;
    std::deque<Place>& left = places[block.Grid];
    if (!left.empty())
    {
      place = left.front();
      left.pop_front();
    }
    blocks.push_back({ block.Grid, block.Name, place.Name, place.DataSet });
  }
  return problem;
}

void DescribeFaces(
  vtkUnstructuredGrid* grid, const std::vector<std::int64_t>& cells, nurbs::CADPart& part)
{
  vtkCellData* data = grid->GetCellData();
  const vtkIdType count = grid->GetNumberOfCells();
  auto* names = vtkStringArray::SafeDownCast(data->GetAbstractArray(vtkNURBSModel::NameName()));
  auto* colors =
    vtkUnsignedCharArray::SafeDownCast(data->GetAbstractArray(vtkNURBSModel::ColorName()));
  if (names && names->GetNumberOfValues() == count)
  {
    for (const std::int64_t cell : cells)
    {
      part.FaceNames.push_back(names->GetValue(cell));
    }
    const bool same = std::all_of(part.FaceNames.begin(), part.FaceNames.end(),
      [&part](const std::string& name) { return name == part.FaceNames.front(); });
    part.Name = same ? part.FaceNames.front() : "";
  }
  if (colors && colors->GetNumberOfComponents() >= 3 && colors->GetNumberOfTuples() == count)
  {
    for (const std::int64_t cell : cells)
    {
      const unsigned char* rgb = colors->GetPointer(cell * colors->GetNumberOfComponents());
      part.Colors.push_back({ { rgb[0], rgb[1], rgb[2] } });
    }
  }
}

void MakeNodes(vtkDataObject* input, const std::vector<Block>& blocks,
  const std::vector<std::int64_t>& parts, const std::string& root, nurbs::CADContent& content)
{
  NodeMaker(input, blocks, parts, root, content).Run();
}

} // namespace vtkNURBSCADTree
