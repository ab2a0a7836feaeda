// SPDX-License-Identifier: BSD-3-Clause
#include "CompletedModel.h"

#include "DegenerateEdge.h"
#include "UnionFind.h"

#include <algorithm>
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

} // namespace nurbs
