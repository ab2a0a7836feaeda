// SPDX-License-Identifier: BSD-3-Clause
#include "PieceBuilder.h"

#include <algorithm>
#include <numeric>

namespace nurbs
{
namespace
{

using Integers = PieceBuilder::Integers;

/// What every face costs beside its control points.
constexpr double CostOfAFace = 32.0;

std::int64_t Size(std::size_t values, int components = 1)
{
  return static_cast<std::int64_t>(values) / components;
}

/// A value, or `other` beyond the end of an array that is too short or missing.
std::int64_t At(const Integers& values, std::int64_t index, std::int64_t other)
{
  return index >= 0 && index < Size(values.size()) ? values[index] : other;
}

bool InRange(std::int64_t start, std::int64_t count, std::int64_t size)
{
  return start >= 0 && count >= 0 && start <= size && count <= size - start;
}

/// Copies a range of tuples to the end of `to`. Returns where it starts there; what does not exist
/// starts at -1, so that it can't be taken for something else there.
std::int64_t CopyRange(ArrayView<double> from, std::int64_t start, std::int64_t count,
  int components, std::vector<double>& to)
{
  if (!InRange(start, count, Size(from.size(), components)))
  {
    return -1;
  }
  const std::int64_t first = Size(to.size(), components);
  const double* values = from.data() + components * start;
  to.insert(to.end(), values, values + components * count);
  return first;
}

} // namespace

std::vector<std::int64_t> DealFaces(const std::vector<double>& costs, int pieces)
{
  const double all = std::accumulate(costs.begin(), costs.end(), 0.0);
  std::vector<std::int64_t> first(std::size_t(pieces) + 1, Size(costs.size()));
  double before = 0.0;
  int piece = 0;
  first[0] = 0;
  for (std::size_t f = 0; f < costs.size(); ++f)
  {
    const double middle = before + 0.5 * costs[f];
    const int of = std::min(pieces - 1, int(middle / all * pieces));
    while (piece < of)
    {
      first[++piece] = std::int64_t(f);
    }
    before += costs[f];
  }
  return first;
}

double FaceCost(const ModelArrays& a, std::int64_t face)
{
  double cost = CostOfAFace + double(a.Offsets[face + 1] - a.Offsets[face]);
  const std::int64_t firstLoop = At(a.LoopStart, face, 0);
  const std::int64_t loops = At(a.LoopCount, face, 0);
  for (std::int64_t l = firstLoop; l < firstLoop + loops; ++l)
  {
    const std::int64_t first = At(a.LoopCurveStart, l, 0);
    const std::int64_t count = At(a.LoopCurveCount, l, 0);
    for (std::int64_t c = first; c < first + count; ++c)
    {
      cost += double(At(a.TrimCurvePointCount, c, 0));
    }
  }
  return cost;
}

void PieceBuilder::Begin(const ModelArrays& arrays, Integers edgeIds, Integers vertexIds)
{
  Source source;
  source.Arrays = arrays;
  source.EdgeIds = edgeIds;
  source.VertexIds = vertexIds;
  const auto take = [](std::int64_t& next, const Integers& ids, std::int64_t count) {
    const std::int64_t first = next;
    next =
      std::max(next, ids.empty() ? first + count : *std::max_element(ids.begin(), ids.end()) + 1);
    return first;
  };
  source.FirstEdgeId = take(this->NextEdgeId, edgeIds, Size(arrays.EdgeDegree.size()));
  source.FirstVertexId = take(this->NextVertexId, vertexIds, Size(arrays.VertexPoints.size(), 3));
  this->Sources.push_back(source);
}

void PieceBuilder::AddFace(std::int64_t face)
{
  const ModelArrays& a = this->Sources.back().Arrays;
  ModelBuilder::Storage& d = this->Model.Data;
  const FaceAttributes looks;
  for (int k = 0; k < 2; ++k)
  {
    d.Degree.push_back(At(a.Degree, 2 * face + k, 0));
    d.NetSize.push_back(At(a.NetSize, 2 * face + k, 0));
  }
  d.FaceId.push_back(At(a.FaceId, face, face));
  d.Orientation.push_back(At(a.Orientation, face, 1));
  d.Color.insert(d.Color.end(), looks.Color.begin(), looks.Color.end());
  d.Name.emplace_back();
  this->AddKnots(face);
  this->AddNet(face);
  this->AddLoops(face);
}

void PieceBuilder::AddKnots(std::int64_t face)
{
  const ModelArrays& a = this->Sources.back().Arrays;
  ModelBuilder::Storage& d = this->Model.Data;
  for (int k = 0; k < 2; ++k)
  {
    const std::int64_t size = At(a.NetSize, 2 * face + k, 0);
    const std::int64_t degree = At(a.Degree, 2 * face + k, 0);
    const bool sane = size >= 0 && degree >= 0 && size <= Size(a.Knots.size());
    d.KnotStart.push_back(sane
        ? CopyRange(a.Knots, At(a.KnotStart, 2 * face + k, -1), size + degree + 1, 1, d.Knots)
        : -1);
  }
}

void PieceBuilder::AddNet(std::int64_t face)
{
  const ModelArrays& a = this->Sources.back().Arrays;
  ModelBuilder::Storage& d = this->Model.Data;
  const std::int64_t points = Size(a.Points.size(), 3);
  const bool weighted = Size(a.Weights.size()) == points && points > 0;
  if (weighted && d.Weights.empty())
  {
    d.Weights.assign(d.Points.size() / 3, 1.0);
  }
  this->PointWith.clear();
  for (std::int64_t k = At(a.Offsets, face, 0); k < At(a.Offsets, face + 1, 0); ++k)
  {
    const std::int64_t id = At(a.Connectivity, k, -1);
    if (id < 0 || id >= points)
    {
      d.Connectivity.push_back(-1);
      continue;
    }
    const auto added = this->PointWith.emplace(id, Size(d.Points.size(), 3));
    d.Connectivity.push_back(added.first->second);
    if (added.second)
    {
      CopyRange(a.Points, id, 1, 3, d.Points);
      if (weighted || !d.Weights.empty())
      {
        d.Weights.push_back(weighted ? a.Weights[id] : 1.0);
      }
    }
  }
  d.Offsets.push_back(Size(d.Connectivity.size()));
}

void PieceBuilder::AddLoops(std::int64_t face)
{
  const ModelArrays& a = this->Sources.back().Arrays;
  ModelBuilder::Storage& d = this->Model.Data;
  const std::int64_t first = At(a.LoopStart, face, 0);
  const std::int64_t count = At(a.LoopCount, face, 0);
  d.LoopCount.push_back(count);
  if (!InRange(first, count, Size(a.LoopCurveStart.size())))
  {
    d.LoopStart.push_back(-1);
    return;
  }
  d.LoopStart.push_back(Size(d.LoopCurveStart.size()));
  const std::int64_t curves = Size(a.TrimCurveDegree.size());
  for (std::int64_t l = first; l < first + count; ++l)
  {
    const std::int64_t start = a.LoopCurveStart[l];
    const std::int64_t size = At(a.LoopCurveCount, l, -1);
    const bool exists = InRange(start, size, curves);
    d.LoopCurveStart.push_back(exists ? Size(d.TrimCurveDegree.size()) : -1);
    d.LoopCurveCount.push_back(size);
    for (std::int64_t c = start; exists && c < start + size; ++c)
    {
      this->AddTrimCurve(c);
    }
  }
}

void PieceBuilder::AddTrimCurve(std::int64_t curve)
{
  const ModelArrays& a = this->Sources.back().Arrays;
  ModelBuilder::Storage& d = this->Model.Data;
  const std::int64_t degree = a.TrimCurveDegree[curve];
  const std::int64_t count = At(a.TrimCurvePointCount, curve, 0);
  const bool sane = degree >= 0 && count >= 0 && count <= Size(a.TrimKnots.size());
  d.TrimCurveDegree.push_back(degree);
  d.TrimCurvePointCount.push_back(count);
  d.TrimCurveKnotStart.push_back(sane ? CopyRange(a.TrimKnots, At(a.TrimCurveKnotStart, curve, -1),
                                          count + degree + 1, 1, d.TrimKnots)
                                      : -1);
  d.TrimCurvePointStart.push_back(
    CopyRange(a.TrimPoints, At(a.TrimCurvePointStart, curve, -1), count, 3, d.TrimPoints));
  d.TrimCurveEdgeId.push_back(this->EdgeOf(At(a.TrimCurveEdgeId, curve, -1)));
  d.TrimCurveReversed.push_back(At(a.TrimCurveReversed, curve, 0));
}

// An edge's place in the order of first use. What does not exist stays out of range.
std::int64_t PieceBuilder::EdgeOf(std::int64_t index)
{
  const Source& source = this->Sources.back();
  if (index < 0 || index >= Size(source.Arrays.EdgeDegree.size()))
  {
    return index < 0 ? index : -2;
  }
  const std::int64_t id =
    source.EdgeIds.empty() ? source.FirstEdgeId + index : At(source.EdgeIds, index, -1);
  const auto added = this->EdgeWith.emplace(id, Size(this->Edges.size()));
  if (added.second)
  {
    this->Edges.push_back({ id, int(this->Sources.size()) - 1, index });
  }
  return added.first->second;
}

std::int64_t PieceBuilder::VertexOf(int from, std::int64_t index)
{
  const Source& source = this->Sources[from];
  if (index < 0 || index >= Size(source.Arrays.VertexPoints.size(), 3))
  {
    return index < 0 ? index : -2;
  }
  const std::int64_t id =
    source.VertexIds.empty() ? source.FirstVertexId + index : At(source.VertexIds, index, -1);
  const auto added = this->VertexWith.emplace(id, Size(this->Vertices.size()));
  if (added.second)
  {
    this->Vertices.push_back({ id, from, index });
  }
  return added.first->second;
}

void PieceBuilder::AddEdge(const Item& edge)
{
  const ModelArrays& a = this->Sources[edge.Source].Arrays;
  ModelBuilder::Storage& d = this->Model.Data;
  const std::int64_t degree = a.EdgeDegree[edge.Index];
  const std::int64_t count = At(a.EdgePointCount, edge.Index, 0);
  const bool sane = degree >= 0 && count > 0 && count <= Size(a.EdgeKnots.size());
  d.EdgeDegree.push_back(degree);
  d.EdgePointCount.push_back(count);
  d.EdgeKnotStart.push_back(sane ? CopyRange(a.EdgeKnots, At(a.EdgeKnotStart, edge.Index, -1),
                                     count + degree + 1, 1, d.EdgeKnots)
                                 : 0);
  d.EdgePointStart.push_back(count > 0
      ? CopyRange(a.EdgePoints, At(a.EdgePointStart, edge.Index, -1), count, 4, d.EdgePoints)
      : 0);
  d.EdgeTolerance.push_back(
    edge.Index < Size(a.EdgeTolerance.size()) ? a.EdgeTolerance[edge.Index] : 0.0);
  for (int end = 0; end < 2; ++end)
  {
    d.EdgeVertices.push_back(
      this->VertexOf(edge.Source, At(a.EdgeVertices, 2 * edge.Index + end, -1)));
  }
}

void PieceBuilder::Finish()
{
  ModelBuilder::Storage& d = this->Model.Data;
  // The place of each item when they are sorted.
  const auto sort = [](std::vector<Item>& items, std::vector<std::int64_t>& ids) {
    std::vector<std::int64_t> order(items.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(),
      [&](std::int64_t a, std::int64_t b) { return items[a].Id < items[b].Id; });
    std::vector<std::int64_t> place(items.size());
    std::vector<Item> sorted;
    for (std::size_t k = 0; k < order.size(); ++k)
    {
      place[order[k]] = std::int64_t(k);
      sorted.push_back(items[order[k]]);
      ids.push_back(sorted.back().Id);
    }
    items = std::move(sorted);
    return place;
  };
  const std::vector<std::int64_t> edgeAt = sort(this->Edges, this->EdgeIds);
  for (std::int64_t& edge : d.TrimCurveEdgeId)
  {
    edge = edge < 0 ? edge : edgeAt[edge];
  }
  for (const Item& edge : this->Edges)
  {
    this->AddEdge(edge);
  }
  const std::vector<std::int64_t> vertexAt = sort(this->Vertices, this->VertexIds);
  for (std::int64_t& vertex : d.EdgeVertices)
  {
    vertex = vertex < 0 ? vertex : vertexAt[vertex];
  }
  for (const Item& vertex : this->Vertices)
  {
    CopyRange(this->Sources[vertex.Source].Arrays.VertexPoints, vertex.Index, 1, 3, d.VertexPoints);
  }
}

std::vector<std::pair<std::int64_t, std::int64_t>> DealModels(
  const std::vector<const ModelBuilder*>& models, int piece, int pieces)
{
  std::vector<double> costs;
  for (const ModelBuilder* model : models)
  {
    const ModelArrays arrays = model->Arrays();
    for (std::int64_t f = 0; f < model->FaceCount(); ++f)
    {
      costs.push_back(FaceCost(arrays, f));
    }
  }
  const std::vector<std::int64_t> starts = DealFaces(costs, pieces);
  std::vector<std::pair<std::int64_t, std::int64_t>> ranges;
  std::int64_t before = 0;
  for (const ModelBuilder* model : models)
  {
    const std::int64_t count = model->FaceCount();
    const auto within = [&](std::int64_t face) {
      return std::min(count, std::max(std::int64_t(0), face - before));
    };
    ranges.emplace_back(within(starts[piece]), within(starts[piece + 1]));
    before += count;
  }
  return ranges;
}

PieceBuilder TakeFaces(const ModelBuilder& model, std::int64_t first, std::int64_t last)
{
  PieceBuilder piece;
  piece.Begin(model.Arrays(), {}, {});
  for (std::int64_t f = first; f < last; ++f)
  {
    piece.AddFace(f);
  }
  piece.Finish();
  const auto& color = model.Data.Color;
  const auto& name = model.Data.Name;
  piece.Model.Data.Color.assign(color.begin() + 3 * first, color.begin() + 3 * last);
  piece.Model.Data.Name.assign(name.begin() + first, name.begin() + last);
  piece.Model.LengthUnit = model.LengthUnit;
  return piece;
}

} // namespace nurbs
