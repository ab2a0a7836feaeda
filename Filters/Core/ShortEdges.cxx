// SPDX-License-Identifier: BSD-3-Clause
#include "ShortEdges.h"

#include "DegenerateEdge.h"
#include "UnionFind.h"

#include <algorithm>
#include <map>

namespace nurbs
{

namespace
{

// Bound of the length of an edge between its vertices.
double LengthBound(const Model& model, const Edge& edge)
{
  const CurveView<3>& c = edge.Geometry;
  double length = (c.Point(0) - model.Vertices[edge.Vertex[0]]).norm() +
    (c.Point(c.Count - 1) - model.Vertices[edge.Vertex[1]]).norm();
  for (int i = 1; i < c.Count; ++i)
  {
    length += (c.Point(i) - c.Point(i - 1)).norm();
  }
  return length;
}

// The loops that have short edges.
ShortLoops FindShortLoops(
  const CompletedModel& out, const std::vector<double>& shortest, const PieceLoops* piece)
{
  const Model& model = out.Data;
  const auto describe = [&](std::int64_t e) {
    const Edge& edge = model.Edges[e];
    LoopEdge described;
    described.Edge = piece ? piece->EdgeNumber(e) : e;
    described.Shortest = shortest[e];
    described.IsPoint = IsDegenerate(edge);
    for (int end = 0; end < 2; ++end)
    {
      described.Vertex[end] = piece ? piece->VertexNumber(edge.Vertex[end]) : edge.Vertex[end];
      described.Places[end] = model.Vertices[edge.Vertex[end]];
    }
    // Vertices without a number in the whole model can't be told from others'.
    const bool named = described.Vertex[0] >= 0 && described.Vertex[1] >= 0;
    if (edge.Geometry.Count > 1 && shortest[e] > 0.0 && named)
    {
      const double bound = LengthBound(model, edge);
      described.Length = bound <= shortest[e] ? bound : -1.0;
    }
    return described;
  };
  ShortLoops loops;
  for (std::size_t f = 0; f < model.Faces.size(); ++f)
  {
    const Face& face = model.Faces[f];
    for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
    {
      if (piece && !piece->IsOwn(std::int64_t(f)))
      {
        continue;
      }
      const TrimLoop& loop = model.Loops[l];
      std::vector<LoopEdge> edges;
      bool any = false;
      for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
      {
        edges.push_back(describe(model.TrimCurves[c].Edge));
        any = any || edges.back().Length >= 0.0;
      }
      if (any)
      {
        loops.push_back(std::move(edges));
      }
    }
  }
  return loops;
}

// Which edges become points: of each the bound of its length; and of every vertex the one it becomes.
struct CollapsedEdges
{
  std::map<std::int64_t, LoopEdge> Edges;
  std::map<std::int64_t, std::int64_t> Vertices;
  std::map<std::int64_t, Vec3> Places;
};

CollapsedEdges Decide(const ShortLoops& loops)
{
  CollapsedEdges out;
  std::map<std::int64_t, LoopEdge> candidates;
  for (const std::vector<LoopEdge>& loop : loops)
  {
    for (const LoopEdge& edge : loop)
    {
      if (edge.Length >= 0.0)
      {
        candidates.emplace(edge.Edge, edge);
      }
    }
  }
  for (const std::vector<LoopEdge>& loop : loops)
  {
    const auto longer = std::count_if(loop.begin(), loop.end(),
      [&](const LoopEdge& edge) { return !edge.IsPoint && candidates.count(edge.Edge) == 0; });
    for (std::size_t k = 0; k < loop.size() && longer < 2; ++k)
    {
      candidates.erase(loop[k].Edge);
    }
  }
  std::map<std::int64_t, std::int64_t> place; // Of a vertex among those of candidates.
  std::vector<std::int64_t> vertices;
  for (const auto& entry : candidates)
  {
    for (int end = 0; end < 2; ++end)
    {
      place.emplace(entry.second.Vertex[end], 0);
      out.Places.emplace(entry.second.Vertex[end], entry.second.Places[end]);
    }
  }
  for (auto& entry : place)
  {
    entry.second = std::int64_t(vertices.size());
    vertices.push_back(entry.first);
  }
  UnionFind sets(vertices.size());
  std::vector<double> extent(vertices.size(), 0.0); // Of each set.
  for (const auto& entry : candidates)
  {
    const LoopEdge& edge = entry.second;
    const std::int64_t a = sets.Find(place[edge.Vertex[0]]);
    const std::int64_t b = sets.Find(place[edge.Vertex[1]]);
    const double together = edge.Length + extent[a] + (a == b ? 0.0 : extent[b]);
    if (together <= edge.Shortest)
    {
      sets.Join(a, b);
      extent[sets.Find(a)] = together;
      out.Edges.insert(entry);
    }
  }
  for (const auto& entry : place)
  {
    out.Vertices[entry.first] = vertices[sets.Find(entry.second)];
  }
  return out;
}

void Collapse(CompletedModel& out, const std::vector<double>& shortest, const PieceLoops* piece)
{
  Model& model = out.Data;
  ShortLoops loops = FindShortLoops(out, shortest, piece);
  if (piece)
  {
    piece->Share(loops);
  }
  if (loops.empty())
  {
    return;
  }
  const CollapsedEdges collapsed = Decide(loops);
  std::map<std::int64_t, std::int64_t> known; // Vertices that others become, by their number.
  for (std::size_t v = 0; v < model.Vertices.size(); ++v)
  {
    known.emplace(piece ? piece->VertexNumber(std::int64_t(v)) : std::int64_t(v), std::int64_t(v));
  }
  for (std::size_t e = 0; e < model.Edges.size(); ++e)
  {
    Edge& edge = model.Edges[e];
    if (collapsed.Edges.count(piece ? piece->EdgeNumber(std::int64_t(e)) : std::int64_t(e)) > 0)
    {
      MakeDegenerate(edge);
    }
    for (std::int64_t& vertex : edge.Vertex)
    {
      const std::int64_t number = vertex < 0 || !piece ? vertex : piece->VertexNumber(vertex);
      const auto becomes = collapsed.Vertices.find(number);
      if (vertex < 0 || becomes == collapsed.Vertices.end() || becomes->second == number)
      {
        continue;
      }
      const auto added = known.emplace(becomes->second, std::int64_t(model.Vertices.size()));
      if (added.second)
      {
        model.Vertices.push_back(collapsed.Places.at(becomes->second));
      }
      vertex = added.first->second;
    }
  }
}

} // namespace

void CollapseShortEdges(CompletedModel& model, const std::vector<double>& shortest)
{
  Collapse(model, shortest, nullptr);
}

void CollapseShortEdges(
  CompletedModel& model, const std::vector<double>& shortest, const PieceLoops& piece)
{
  Collapse(model, shortest, &piece);
}

} // namespace nurbs
