// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSPieces.h"

#include "ModelChecks.h"
#include "PieceBuilder.h"
#include "PieceMessage.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelPool.h"
#include "vtkNURBSModelView.h"
#include "vtkNURBSPieceTree.h"

#include "vtkCellData.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <numeric>
#include <set>

namespace
{

using nurbs::MessageReader;
using nurbs::MessageWriter;

/// Calls f(array) for all arrays of a model but Color and Name.
template <typename StorageT, typename F>
void ForArrays(StorageT& d, F f)
{
  const auto all = [&](auto&... arrays) { (f(arrays), ...); };
  all(d.Points, d.Weights, d.Connectivity, d.Offsets, d.Degree, d.NetSize, d.KnotStart, d.LoopStart,
    d.LoopCount, d.FaceId, d.Orientation, d.Knots, d.LoopCurveStart, d.LoopCurveCount,
    d.TrimCurveDegree, d.TrimCurveKnotStart, d.TrimCurvePointStart, d.TrimCurvePointCount,
    d.TrimCurveEdgeId, d.TrimCurveReversed, d.TrimPoints, d.TrimKnots, d.EdgeDegree,
    d.EdgeKnotStart, d.EdgePointStart, d.EdgePointCount, d.EdgeVertices, d.EdgeTolerance,
    d.EdgePoints, d.EdgeKnots, d.VertexPoints);
}

/// A grid of some process as it comes in a message.
struct Packet
{
  std::int64_t Block = 0;
  int Rank = 0;
  std::vector<std::int64_t> Cells; ///< Numbers of its faces there.
  std::string Unit;
  nurbs::PieceBuilder Piece;
  bool HasIds = false;
};

} // namespace

vtkInformationKeyMacro(vtkNURBSPieces, NO_INPUT, Integer);

vtkNURBSPieces::vtkNURBSPieces() = default;

vtkNURBSPieces::vtkNURBSPieces(vtkInformation* request, vtkInformationVector* outputs)
{
  const int from = request->Has(vtkDemandDrivenPipeline::FROM_OUTPUT_PORT())
    ? request->Get(vtkDemandDrivenPipeline::FROM_OUTPUT_PORT())
    : 0;
  vtkInformation* info = outputs->GetInformationObject(std::max(0, from));
  vtkMultiProcessController* all = vtkMultiProcessController::GetGlobalController();
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  if (all && all->GetNumberOfProcesses() > 1 && info->Has(Pipeline::UPDATE_NUMBER_OF_PIECES()) &&
    info->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()) == all->GetNumberOfProcesses() &&
    info->Get(Pipeline::UPDATE_PIECE_NUMBER()) == all->GetLocalProcessId())
  {
    this->Controller = all;
    this->Rank = all->GetLocalProcessId();
    this->HasInput = !request->Has(NO_INPUT());
  }
}

vtkNURBSPieces::~vtkNURBSPieces() = default;

bool vtkNURBSPieces::IsPieceAsked(vtkInformation* output, int& piece, int& pieces)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  pieces = output->Has(Pipeline::UPDATE_NUMBER_OF_PIECES())
    ? output->Get(Pipeline::UPDATE_NUMBER_OF_PIECES())
    : 1;
  piece = pieces > 1 ? output->Get(Pipeline::UPDATE_PIECE_NUMBER()) : 0;
  return pieces > 1;
}

bool vtkNURBSPieces::HasOtherProcesses()
{
  vtkMultiProcessController* all = vtkMultiProcessController::GetGlobalController();
  return all && all->GetNumberOfProcesses() > 1;
}

bool vtkNURBSPieces::IsPiece(vtkDataObject* data)
{
  return data && HasOtherProcesses() &&
    data->GetInformation()->Get(vtkDataObject::DATA_NUMBER_OF_PIECES()) ==
    vtkMultiProcessController::GetGlobalController()->GetNumberOfProcesses();
}

void vtkNURBSPieces::FindGrids(vtkDataObject* input, std::vector<Grid>& grids) const
{
  std::map<unsigned int, vtkIdType> cells;
  vtkNURBSPieceTree::Visit(input, [&](unsigned int block, unsigned int part, vtkDataObject* leaf) {
    auto* grid = vtkUnstructuredGrid::SafeDownCast(leaf);
    if (grid && grid->GetNumberOfCells() > 0)
    {
      grids.push_back({ block, part, grid, grid->GetMTime(), cells[block] });
      cells[block] += grid->GetNumberOfCells();
    }
  });
}

vtkNURBSPieces::Choice vtkNURBSPieces::AllCells() const
{
  Choice cells;
  for (const Grid& grid : this->Grids)
  {
    cells.emplace_back(grid.Data->GetNumberOfCells());
    std::iota(cells.back().begin(), cells.back().end(), 0);
  }
  return cells;
}

std::vector<char> vtkNURBSPieces::Pack(const Raws& raws, const Choice& cells) const
{
  std::vector<char> message;
  MessageWriter out(message);
  for (std::size_t g = 0; g < raws.size(); ++g)
  {
    if (cells[g].empty())
    {
      continue;
    }
    const Grid& grid = this->Grids[g];
    nurbs::PieceBuilder piece;
    piece.Begin(raws[g].Arrays, raws[g].EdgeIds, raws[g].VertexIds);
    std::vector<std::int64_t> numbers;
    for (const vtkIdType cell : cells[g])
    {
      piece.AddFace(cell);
      numbers.push_back(grid.FirstCell + cell);
    }
    piece.Finish();
    const std::int64_t head[] = { grid.Block, vtkNURBSModel::HasGlobalIds(grid.Data) };
    out.Put(head, 2);
    out.Put(vtkNURBSModel::GetLengthUnit(grid.Data));
    out.Put(numbers);
    out.Put(piece.EdgeIds);
    out.Put(piece.VertexIds);
    ForArrays(piece.Model.Data, [&](const auto& array) { out.Put(array); });
  }
  return message;
}

void vtkNURBSPieces::Merge(const std::vector<std::vector<char>>& messages)
{
  std::map<unsigned int, std::vector<Packet>> blocks;
  for (std::size_t rank = 0; rank < messages.size(); ++rank)
  {
    for (MessageReader in(messages[rank]); !in.IsDone();)
    {
      Packet packet;
      std::vector<std::int64_t> head;
      in.Get(head);
      packet.Block = head[0];
      packet.HasIds = head[1] != 0;
      packet.Rank = int(rank);
      in.Get(packet.Unit);
      in.Get(packet.Cells);
      in.Get(packet.Piece.EdgeIds);
      in.Get(packet.Piece.VertexIds);
      ForArrays(packet.Piece.Model.Data, [&](auto& array) { in.Get(array); });
      blocks[unsigned(packet.Block)].push_back(std::move(packet));
    }
  }
  for (auto& [block, packets] : blocks)
  {
    nurbs::PieceBuilder whole;
    vtkNew<vtkIntArray> owners;
    owners->SetName(vtkNURBSPieceTree::OwnerName());
    vtkNew<vtkIdTypeArray> cells;
    cells->SetName(vtkNURBSPieceTree::CellName());
    for (const Packet& packet : packets)
    {
      const nurbs::ModelArrays arrays = packet.Piece.Model.Arrays();
      // Without global ids, the piece's edges are those of no other.
      using Ids = nurbs::PieceBuilder::Integers;
      whole.Begin(arrays, packet.HasIds ? Ids(packet.Piece.EdgeIds) : Ids(),
        packet.HasIds ? Ids(packet.Piece.VertexIds) : Ids());
      for (std::int64_t face = 0; face < arrays.FaceCount(); ++face)
      {
        whole.AddFace(face);
        owners->InsertNextValue(packet.Rank);
        cells->InsertNextValue(vtkIdType(packet.Cells[face]));
      }
    }
    whole.Finish();
    whole.Model.LengthUnit = packets.front().Unit;
    vtkNew<vtkUnstructuredGrid> grid;
    vtkNURBSModel::Store(whole.Model, grid);
    grid->GetCellData()->AddArray(owners);
    grid->GetCellData()->AddArray(cells);
    const auto box = this->Boxes.find(block);
    if (box != this->Boxes.end())
    {
      vtkNURBSModel::SetWholeBounds(grid, box->second);
    }
    this->EdgeIds[block] = std::move(whole.EdgeIds);
    this->VertexIds[block] = std::move(whole.VertexIds);
    packets.clear();
    vtkNURBSPieceTree::Set(this->Whole, block, 0, grid);
  }
}

vtkDataObject* vtkNURBSPieces::Gather(vtkDataObject* input, Scope scope)
{
  this->Input = input;
  this->FindGrids(input, this->Grids);
  std::vector<vtkNURBSModelPool::Block> blocks;
  const std::string problem = vtkNURBSModelPool::Find(input, blocks);
  if (!problem.empty())
  {
    throw nurbs::Error(problem);
  }
  std::set<unsigned int> seen;
  bool parted = false;
  for (const Grid& grid : this->Grids)
  {
    parted = parted || (vtkNURBSModel::HasGlobalIds(grid.Data) && seen.count(grid.Block) > 0);
    seen.insert(grid.Block);
  }
  if (!this->IsParallel() && !parted)
  {
    return input;
  }
  this->Whole = vtkNURBSPieceTree::NewTree(input);
  Raws raws;
  for (const Grid& grid : this->Grids)
  {
    raws.push_back(vtkNURBSModelView::GetRaw(grid.Data));
  }
  if (scope == ALL || !this->IsParallel())
  {
    this->Merge(this->Exchange(this->Pack(raws, this->AllCells())));
    return this->Whole;
  }
  std::vector<std::vector<char>> messages;
  for (const Choice& cells : this->FindShared(raws))
  {
    messages.push_back(this->Pack(raws, cells));
  }
  this->Merge(this->ExchangeWithEach(messages));
  return this->Whole;
}

bool vtkNURBSPieces::IsUpToDate(vtkDataObject* input) const
{
  std::vector<Grid> now;
  this->FindGrids(input, now);
  const bool same = input == this->Input && now.size() == this->Grids.size() &&
    std::equal(now.begin(), now.end(), this->Grids.begin(), [](const Grid& a, const Grid& b) {
      return a.Data == b.Data && a.Time == b.Time && a.Block == b.Block &&
        a.Partition == b.Partition;
    });
  double changed = same ? 0.0 : 1.0;
  this->Largest(&changed, 1);
  return changed == 0.0;
}

nurbs::Box3 vtkNURBSPieces::Around(const nurbs::Box3& own) const
{
  Eigen::Matrix<double, 6, 1> extremes;
  extremes << -own.min(), own.max();
  this->Largest(extremes.data(), 6);
  return nurbs::Box3(-extremes.head<3>(), extremes.tail<3>());
}
