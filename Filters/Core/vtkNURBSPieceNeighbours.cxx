// SPDX-License-Identifier: BSD-3-Clause
// Which faces processes must know of each other, and messages between two.
#include "ModelChecks.h"
#include "PieceMessage.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"
#include "vtkNURBSPieceTree.h"
#include "vtkNURBSPieces.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <array>
#include <unordered_map>

namespace
{

using nurbs::MessageReader;
using nurbs::MessageWriter;

/// A block's edge or vertex as one number.
std::int64_t Key(unsigned int block, std::int64_t id, bool isVertex)
{
  return (std::int64_t(block) << 41) + 2 * id + (isVertex ? 1 : 0);
}

/// Calls f(edge) for the edges of a face, and f(vertex, true) for their ends.
template <typename F>
void ForEdges(const vtkNURBSModelView::Raw& raw, vtkIdType face, F f)
{
  const nurbs::ModelArrays& a = raw.Arrays;
  const auto at = [](const nurbs::ModelArrays::Integers& values, std::int64_t index) {
    return index >= 0 && index < std::int64_t(values.size()) ? values[index] : -1;
  };
  // Not yet validated: what lies outside of the arrays is left out.
  const auto range = [&](std::int64_t first, std::int64_t count, std::size_t size) {
    const auto all = std::int64_t(size);
    const std::int64_t begin = std::clamp<std::int64_t>(first, 0, all);
    return std::array<std::int64_t, 2>{ begin,
      begin + std::clamp<std::int64_t>(count, 0, all - begin) };
  };
  const auto loops = range(at(a.LoopStart, face), at(a.LoopCount, face), a.LoopCurveStart.size());
  for (std::int64_t l = loops[0]; l < loops[1]; ++l)
  {
    const auto curves =
      range(at(a.LoopCurveStart, l), at(a.LoopCurveCount, l), a.TrimCurveEdgeId.size());
    for (std::int64_t c = curves[0]; c < curves[1]; ++c)
    {
      const std::int64_t edge = at(a.TrimCurveEdgeId, c);
      f(at(raw.EdgeIds, edge), false);
      for (int end = 0; edge >= 0 && end < 2; ++end)
      {
        f(at(raw.VertexIds, at(a.EdgeVertices, 2 * edge + end)), true);
      }
    }
  }
}

} // namespace

// The keys of all edges and vertices of each grid, sorted.
std::vector<std::vector<std::int64_t>> vtkNURBSPieces::FindKeys(const Raws& raws) const
{
  std::vector<std::vector<std::int64_t>> keys(raws.size());
  for (std::size_t g = 0; g < raws.size(); ++g)
  {
    const unsigned int block = this->Grids[g].Block;
    for (vtkIdType face = 0; face < this->Grids[g].Data->GetNumberOfCells(); ++face)
    {
      ForEdges(raws[g], face, [&](std::int64_t id, bool isVertex) {
        if (id >= 0)
        {
          keys[g].push_back(Key(block, id, isVertex));
        }
      });
    }
    std::sort(keys[g].begin(), keys[g].end());
    keys[g].erase(std::unique(keys[g].begin(), keys[g].end()), keys[g].end());
  }
  return keys;
}

// Of every process, the own cells that it must know; all of them for this one. Boxes are exchanged, too.
std::vector<vtkNURBSPieces::Choice> vtkNURBSPieces::FindShared(const Raws& raws)
{
  std::vector<std::int64_t> own;
  for (const std::vector<std::int64_t>& some : this->FindKeys(raws))
  {
    own.insert(own.end(), some.begin(), some.end());
  }
  nurbs::AssembleOptions options;
  options.CheckEdges = false;
  std::map<unsigned int, double> sides[6];
  for (std::size_t g = 0; g < raws.size(); ++g)
  {
    const nurbs::Box3 box =
      nurbs::BoxOfNets(vtkNURBSModelView(this->Grids[g].Data, options).GetModel());
    for (int k = 0; k < 6 && !box.isEmpty(); ++k)
    {
      const double side = k < 3 ? -box.min()[k] : box.max()[k - 3];
      const auto known = sides[k].emplace(this->Grids[g].Block, side);
      known.first->second = std::max(known.first->second, side);
    }
  }
  for (std::map<unsigned int, double>& side : sides)
  {
    this->Largest(side);
  }
  for (const auto& entry : sides[0])
  {
    nurbs::Vec3 low, high;
    for (int k = 0; k < 3; ++k)
    {
      low[k] = -sides[k].at(entry.first);
      high[k] = sides[k + 3].at(entry.first);
    }
    this->Boxes[entry.first] = nurbs::Box3(low, high);
  }

  std::vector<char> message;
  MessageWriter(message).Put(own);
  const std::vector<std::vector<char>> all = this->Exchange(message);
  std::unordered_map<std::int64_t, std::vector<int>> known; // Which others have an own key.
  for (const std::int64_t key : own)
  {
    known.emplace(key, std::vector<int>());
  }
  for (int rank = 0; rank < int(all.size()); ++rank)
  {
    std::vector<std::int64_t> keys;
    MessageReader(all[rank]).Get(keys);
    for (std::size_t k = 0; rank != this->Rank && k < keys.size(); ++k)
    {
      const auto found = known.find(keys[k]);
      if (found != known.end() && (found->second.empty() || found->second.back() != rank))
      {
        found->second.push_back(rank);
      }
    }
  }
  std::vector<Choice> shared(all.size(), Choice(raws.size()));
  shared[this->Rank] = this->AllCells();
  for (std::size_t g = 0; g < raws.size(); ++g)
  {
    for (vtkIdType face = 0; face < this->Grids[g].Data->GetNumberOfCells(); ++face)
    {
      ForEdges(raws[g], face, [&](std::int64_t id, bool isVertex) {
        const auto found =
          id < 0 ? known.end() : known.find(Key(this->Grids[g].Block, id, isVertex));
        for (std::size_t k = 0; found != known.end() && k < found->second.size(); ++k)
        {
          std::vector<vtkIdType>& cells = shared[found->second[k]][g];
          if (cells.empty() || cells.back() != face)
          {
            cells.push_back(face);
          }
        }
      });
    }
  }
  return shared;
}

vtkNURBSPieces::Identity vtkNURBSPieces::GetIdentity() const
{
  Identity out;
  vtkNURBSPieceTree::Visit(this->Whole, [&](unsigned int block, unsigned int, vtkDataObject* leaf) {
    vtkFieldData* cells = leaf->GetAttributes(vtkDataObject::CELL);
    vtkDataArray* owners = cells->GetArray(vtkNURBSPieceTree::OwnerName());
    vtkDataArray* numbers = cells->GetArray(vtkNURBSPieceTree::CellName());
    for (vtkIdType k = 0; owners && k < owners->GetNumberOfTuples(); ++k)
    {
      const auto owner = int(owners->GetTuple1(k));
      out.IsGhost.push_back(owner != this->Rank);
      out.Faces.push_back(
        { (std::int64_t(owner) << 32) + block, std::int64_t(numbers->GetTuple1(k)) });
    }
    const auto edges = this->EdgeIds.find(block);
    const auto vertices = this->VertexIds.find(block);
    if (edges == this->EdgeIds.end() || vertices == this->VertexIds.end())
    {
      return; // No face of this block is one of this process, or beside one.
    }
    for (const std::int64_t id : edges->second)
    {
      out.Edges.push_back(Key(block, id, false));
    }
    for (const std::int64_t id : vertices->second)
    {
      out.Vertices.push_back(Key(block, id, true));
    }
  });
  return out;
}

std::vector<unsigned int> vtkNURBSPieces::GetBlocks() const
{
  std::vector<unsigned int> blocks;
  vtkNURBSPieceTree::Visit(this->Whole ? this->Whole.Get() : this->Input,
    [&](unsigned int block, unsigned int, vtkDataObject* leaf) {
      auto* grid = vtkUnstructuredGrid::SafeDownCast(leaf);
      if (grid && grid->GetNumberOfCells() > 0)
      {
        blocks.push_back(block);
      }
    });
  return blocks;
}

namespace
{

/// Numbers by block of all processes, put together by `join`.
template <typename T, typename F>
void JoinByBlock(const vtkNURBSPieces& pieces, std::map<unsigned int, T>& values, F join)
{
  std::vector<std::int64_t> blocks;
  std::vector<T> numbers;
  for (const auto& [block, value] : values)
  {
    blocks.push_back(block);
    numbers.push_back(value);
  }
  std::vector<char> message;
  MessageWriter out(message);
  out.Put(blocks);
  out.Put(numbers);
  values.clear();
  for (const std::vector<char>& one : pieces.Exchange(message))
  {
    MessageReader in(one);
    in.Get(blocks);
    in.Get(numbers);
    for (std::size_t k = 0; k < blocks.size(); ++k)
    {
      const auto added = values.emplace(unsigned(blocks[k]), numbers[k]);
      if (!added.second)
      {
        added.first->second = join(added.first->second, numbers[k]);
      }
    }
  }
}

} // namespace

void vtkNURBSPieces::Largest(std::map<unsigned int, double>& values) const
{
  JoinByBlock(*this, values, [](double a, double b) { return std::max(a, b); });
}

void vtkNURBSPieces::Sum(std::map<unsigned int, vtkIdType>& values) const
{
  JoinByBlock(*this, values, [](vtkIdType a, vtkIdType b) { return a + b; });
}
