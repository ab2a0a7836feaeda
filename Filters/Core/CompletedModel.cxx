// SPDX-License-Identifier: BSD-3-Clause
#include "CompletedModel.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace nurbs
{

namespace
{
Vec2 CurveEnd(const Model& model, std::int64_t curve, int end)
{
  const CurveView<2>& c = model.TrimCurves[curve].Geometry;
  const Interval domain = c.Domain();
  return Evaluate(c, end == 0 ? domain.Min : domain.Max);
}

// A straight trim curve from a to b over the parameter interval `domain`.
TrimCurve StraightCurve(CompletedModel& out, const Vec2& a, const Vec2& b, const Interval& domain)
{
  Curve<2> line;
  line.Degree = 1;
  line.Knots = { domain.Min, domain.Min, domain.Max, domain.Max };
  line.Points = { a, b };
  line.Weights = { 1.0, 1.0 };
  out.OwnCurves.push_back(std::move(line));
  out.OwnCurves.back().Pack();
  TrimCurve curve;
  curve.Geometry = out.OwnCurves.back().View();
  return curve;
}

void MakeDegenerate(Edge& edge)
{
  static const double pole[4] = { 0.0, 0.0, 0.0, 1.0 };
  static const double knots[2] = { 0.0, 1.0 };
  edge.Geometry.Degree = 0;
  edge.Geometry.Count = 1;
  edge.Geometry.Points = pole;
  edge.Geometry.Knots = KnotView(knots, 2);
}

std::int64_t AddEdge(CompletedModel& out, bool degenerate)
{
  Edge edge;
  if (degenerate)
  {
    MakeDegenerate(edge);
  }
  out.Data.Edges.push_back(edge);
  return std::int64_t(out.Data.Edges.size()) - 1;
}

// The natural boundary, counter-clockwise: v = min, u = max, v = max, u = min.
void AddNaturalBoundary(CompletedModel& out, Face& face)
{
  const SurfaceView& s = face.Geometry;
  const Interval u = s.Domain(0);
  const Interval v = s.Domain(1);
  Box3 box;
  for (std::int64_t k = 0; k < s.Size(); ++k)
  {
    box.extend(s.Point(k));
  }
  const double tolerance = 1e-9 * box.diagonal().norm();
  const Vec2 c00(u.Min, v.Min);
  const Vec2 c10(u.Max, v.Min);
  const Vec2 c01(u.Min, v.Max);
  const Vec2 c11(u.Max, v.Max);
  TrimCurve sides[4] = { StraightCurve(out, c00, c10, u), StraightCurve(out, c10, c11, v),
    StraightCurve(out, c01, c11, u), StraightCurve(out, c00, c01, v) };
  sides[2].Reversed = sides[3].Reversed = true;
  const int direction[4] = { 1, 0, 1, 0 };
  const int end[4] = { 0, 1, 1, 0 };
  for (int k = 0; k < 4; ++k)
  {
    const bool pole = IsDegenerateSide(s, direction[k], end[k], tolerance);
    const bool closed = k >= 2 && !pole && IsClosed(s, direction[k], tolerance);
    sides[k].Edge = closed ? sides[k == 2 ? 0 : 1].Edge : AddEdge(out, pole);
  }
  face.FirstLoop = std::int64_t(out.Data.Loops.size());
  face.LoopCount = 1;
  out.Data.Loops.push_back({ std::int64_t(out.Data.TrimCurves.size()), 4 });
  out.Data.TrimCurves.insert(out.Data.TrimCurves.end(), sides, sides + 4);
}

// A side of a natural boundary, sampled evenly.
constexpr int SideSamples = 9;
struct Side
{
  std::int64_t Curve;
  double Order; // The middle's coordinate in some direction.
  Vec3 Points[SideSamples];
};

double Apart(const Side& a, const Side& b, bool backwards)
{
  double apart = 0.0;
  for (int k = 0; k < SideSamples; ++k)
  {
    const Vec3& other = b.Points[backwards ? SideSamples - 1 - k : k];
    apart = std::max(apart, (a.Points[k] - other).norm());
  }
  return apart;
}

// Gives sides of different faces that coincide one edge: of the loops from `firstLoop` on, which
// are natural boundaries.
void MatchSides(CompletedModel& out, std::size_t firstLoop, double tolerance)
{
  Model& model = out.Data;
  std::vector<std::int64_t> uses(model.Edges.size(), 0);
  for (const TrimCurve& curve : model.TrimCurves)
  {
    if (curve.Edge >= 0)
    {
      ++uses[curve.Edge];
    }
  }
  std::vector<Side> sides;
  for (const Face& face : model.Faces)
  {
    if (face.LoopCount == 0 || std::size_t(face.FirstLoop) < firstLoop)
    {
      continue;
    }
    const TrimLoop& loop = model.Loops[face.FirstLoop];
    for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
    {
      const TrimCurve& curve = model.TrimCurves[c];
      if (IsDegenerate(model.Edges[curve.Edge]) || uses[curve.Edge] != 1)
      {
        continue;
      }
      Side side;
      side.Curve = c;
      const Interval domain = curve.Geometry.Domain();
      for (int k = 0; k < SideSamples; ++k)
      {
        const Vec2 uv =
          Evaluate(curve.Geometry, domain.Min + k * domain.Length() / (SideSamples - 1));
        side.Points[k] = Evaluate(face.Geometry, uv[0], uv[1]);
      }
      side.Order = side.Points[SideSamples / 2].dot(Vec3(0.564, 0.311, 0.765));
      sides.push_back(side);
    }
  }
  std::stable_sort(
    sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.Order < b.Order; });
  std::vector<char> taken(sides.size(), 0);
  for (std::size_t i = 0; i < sides.size(); ++i)
  {
    for (std::size_t j = i + 1;
         j < sides.size() && !taken[i] && sides[j].Order - sides[i].Order <= tolerance; ++j)
    {
      const bool forward = Apart(sides[i], sides[j], false) <= tolerance;
      const bool backward = !forward && Apart(sides[i], sides[j], true) <= tolerance;
      if (taken[j] || (!forward && !backward))
      {
        continue;
      }
      TrimCurve& curve = model.TrimCurves[sides[j].Curve];
      if (backward)
      {
        const Vec2 start = curve.Geometry.Point(1);
        const Vec2 end = curve.Geometry.Point(0);
        const bool reversed = !curve.Reversed;
        curve = StraightCurve(out, start, end, curve.Geometry.Domain());
        curve.Reversed = reversed;
      }
      curve.Edge = model.TrimCurves[sides[i].Curve].Edge;
      taken[i] = taken[j] = 1;
    }
  }
}

struct UnionFind
{
  std::vector<std::int64_t> Parent;
  explicit UnionFind(std::size_t n)
    : Parent(n)
  {
    std::iota(this->Parent.begin(), this->Parent.end(), 0);
  }
  std::int64_t Find(std::int64_t x)
  {
    while (this->Parent[x] != x)
    {
      x = this->Parent[x] = this->Parent[this->Parent[x]];
    }
    return x;
  }
  void Join(std::int64_t a, std::int64_t b)
  {
    a = this->Find(a);
    b = this->Find(b);
    this->Parent[std::max(a, b)] = std::min(a, b);
  }
};

// Gives every edge end a vertex: ends that meet in a loop share it.
void CompleteVertices(CompletedModel& out, const std::vector<std::string>& faceErrors)
{
  Model& model = out.Data;
  const std::int64_t known = std::int64_t(model.Vertices.size());
  const auto node = [&](std::int64_t edge, int end) {
    const std::int64_t id = model.Edges[edge].Vertex[end];
    return id >= 0 ? id : known + 2 * edge + end;
  };
  UnionFind sets(known + 2 * model.Edges.size());
  std::vector<std::int64_t> first(known + 2 * model.Edges.size(), -1);
  std::vector<Vec3> position(first.size());
  for (std::size_t e = 0; e < model.Edges.size(); ++e)
  {
    if (IsDegenerate(model.Edges[e]))
    {
      sets.Join(node(e, 0), node(e, 1));
    }
  }
  for (std::size_t f = 0; f < model.Faces.size(); ++f)
  {
    if (!faceErrors[f].empty())
    {
      continue;
    }
    const Face& face = model.Faces[f];
    for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
    {
      const TrimLoop& loop = model.Loops[l];
      for (std::int64_t k = 0; k < loop.CurveCount; ++k)
      {
        const std::int64_t a = loop.FirstCurve + k;
        const std::int64_t b = loop.FirstCurve + (k + 1) % loop.CurveCount;
        const TrimCurve& ca = model.TrimCurves[a];
        const TrimCurve& cb = model.TrimCurves[b];
        const std::int64_t na = node(ca.Edge, ca.Reversed ? 0 : 1);
        const std::int64_t nb = node(cb.Edge, cb.Reversed ? 1 : 0);
        sets.Join(na, nb);
        if (nb >= known && first[nb] < 0)
        {
          const Vec2 uv = CurveEnd(model, b, cb.Reversed ? 1 : 0);
          first[nb] = 0;
          position[nb] = Evaluate(face.Geometry, uv[0], uv[1]);
        }
        if (na >= known && first[na] < 0)
        {
          const Vec2 uv = CurveEnd(model, a, ca.Reversed ? 0 : 1);
          first[na] = 0;
          position[na] = Evaluate(face.Geometry, uv[0], uv[1]);
        }
      }
    }
  }
  std::vector<std::int64_t> vertexOf(first.size(), -1);
  for (std::size_t e = 0; e < model.Edges.size(); ++e)
  {
    for (int end = 0; end < 2; ++end)
    {
      const std::int64_t root = sets.Find(node(e, end));
      if (root < known)
      {
        model.Edges[e].Vertex[end] = root;
        continue;
      }
      if (vertexOf[root] < 0)
      {
        vertexOf[root] = std::int64_t(model.Vertices.size());
        model.Vertices.push_back(first[root] < 0 ? Vec3(Vec3::Zero()) : position[root]);
      }
      model.Edges[e].Vertex[end] = vertexOf[root];
    }
  }
}
} // namespace

CompletedModel CompleteModel(
  const Model& model, const std::vector<std::string>& faceErrors, double sideTolerance)
{
  CompletedModel out;
  out.Data = model;
  out.KnownEdges = std::int64_t(model.Edges.size());
  const std::size_t knownLoops = model.Loops.size();
  for (std::size_t f = 0; f < model.Faces.size(); ++f)
  {
    if (faceErrors[f].empty() && model.Faces[f].LoopCount == 0)
    {
      AddNaturalBoundary(out, out.Data.Faces[f]);
    }
  }
  if (sideTolerance >= 0.0)
  {
    MatchSides(out, knownLoops, sideTolerance);
  }
  for (TrimCurve& curve : out.Data.TrimCurves)
  {
    if (curve.Edge < 0)
    {
      curve.Edge = AddEdge(out, false);
    }
  }
  CompleteVertices(out, faceErrors);
  return out;
}

double TrimParameter(const TrimCurve& curve, const Interval& edge, double t)
{
  const Interval own = curve.Geometry.Domain();
  if (own.Min == edge.Min && own.Max == edge.Max)
  {
    return t;
  }
  return own.Clamp(own.Min + (t - edge.Min) * (own.Length() / edge.Length()));
}

Interval EdgeDomain(const Model& model, std::int64_t edge, const std::vector<EdgeUse>& uses)
{
  const CurveView<3>& c = model.Edges[edge].Geometry;
  if (c.Count > 1 || uses.empty())
  {
    return c.Domain();
  }
  return model.TrimCurves[uses.front().Curve].Geometry.Domain();
}

// Bound of the length of an edge between its vertices.
static double LengthBound(const Model& model, const Edge& edge)
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
static ShortLoops FindShortLoops(
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

static CollapsedEdges Decide(const ShortLoops& loops)
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

void CollapseShortEdges(
  CompletedModel& out, const std::vector<double>& shortest, const PieceLoops* piece)
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

} // namespace nurbs
