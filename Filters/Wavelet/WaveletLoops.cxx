// SPDX-License-Identifier: BSD-3-Clause
// The part of WaveletModel that makes the faces' loops and grids from a selection.
#include "WaveletModel.h"

#include "LoopCrossings.h"
#include "WaveletSelection.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

constexpr double ShortPole = 1e-4;  // Of the domain: too short for a side.
constexpr double SameCorner = 1e-5; // Of the domain: one corner.
constexpr double NearCorner = 1e-2; // Likewise, where both ends are one vertex of the model.
constexpr double SameLine = 1e-9;   // Of the box.
constexpr int MaximumRounds = 14;   // Of refinement where loops cross.

bool AreNear(const WaveletFace& face, const Vec2& a, const Vec2& b, double share)
{
  return std::abs(a[0] - b[0]) <= share * face.Box().A() &&
    std::abs(a[1] - b[1]) <= share * face.Box().B();
}

// Puts a parameter within rounding of a line onto it.
double SnapToLine(const std::vector<double>& lines, double t)
{
  const auto next = std::lower_bound(lines.begin(), lines.end(), t);
  const double near = SameLine * (lines.back() - lines.front());
  if (next != lines.end() && *next - t <= near)
  {
    return *next;
  }
  return next != lines.begin() && t - *(next - 1) <= near ? *(next - 1) : t;
}

// Parameters of a face's leaf corners along a side of its box, ascending.
std::vector<double> SideLines(const WaveletFace& face, const WaveletSelection& selection,
  std::int64_t index, int side, Wavelet kind)
{
  const int d = side % 2;
  const std::vector<WaveletCell>& cells = selection.Cells[index];
  if (cells.empty())
  {
    return face.Axis(d).Samples(kind, selection.Level[index]);
  }
  std::vector<int> lines;
  const int last[2] = { face.Axis(0).Intervals(), face.Axis(1).Intervals() };
  for (const WaveletCell& cell : cells)
  {
    int at[4];
    face.Extent(cell, at);
    const bool on = side == 0 ? at[2] == 0
      : side == 1             ? at[1] == last[0]
      : side == 2             ? at[3] == last[1]
                              : at[0] == 0;
    if (on)
    {
      lines.push_back(at[2 * d]);
      lines.push_back(at[2 * d + 1]);
    }
  }
  std::sort(lines.begin(), lines.end());
  lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
  std::vector<double> out;
  for (const int line : lines)
  {
    out.push_back(face.Axis(d).Line(line));
  }
  return out;
}

// Box of a trim curve's samples from one line to another, and a little more, within the face's box.
Box2 RangeOf(const WaveletFace& face, const std::vector<Vec2>& uv, int first, int last)
{
  Box2 box;
  for (int i = first; i <= last; ++i)
  {
    box.extend(uv[i]);
  }
  const Vec2 more = 0.1 * box.diagonal();
  const ParameterBox& all = face.Box();
  return Box2(Vec2((box.min() - more).cwiseMax(Vec2(all.U0, all.V0))),
    Vec2((box.max() + more).cwiseMin(Vec2(all.U1, all.V1))));
}

} // namespace

// Edges along sides of a box get vertices where the face has corners of cells.
void WaveletModel::ShareLines(WaveletSelection& selection) const
{
  if (this->Options.Kind == Wavelet::Haar)
  {
    return;
  }
  for (std::size_t e = 0; e < this->Edges.size(); ++e)
  {
    const WaveletEdge* edge = this->Edges[e].get();
    for (std::size_t u = 0; edge && u < edge->Uses().size(); ++u)
    {
      const WaveletEdgeUse& use = edge->Uses()[u];
      if (use.Side < 0)
      {
        continue;
      }
      const WaveletFace& face = *this->Faces[use.Where.Face];
      const DyadicAxis& axis = face.Axis(use.Side % 2);
      const std::vector<double> lines =
        SideLines(face, selection, use.Where.Face, use.Side, this->Options.Kind);
      int i = 0;
      for (const double line : lines)
      {
        while (axis.Line(i) < line)
        {
          ++i;
        }
        if (use.AtLine[i] >= 0)
        {
          selection.AddLine(e, use.AtLine[i]);
        }
      }
    }
  }
}

// Polylines of coarse levels may cross although their curves do not: those that do become finer.
void WaveletModel::Uncross(WaveletSelection& selection) const
{
  const std::size_t n = this->Faces.size();
  std::vector<char> check(n, 1);
  for (int round = 0; round < MaximumRounds; ++round)
  {
    std::vector<FaceMeshRequests> requests(n);
    this->Options.Parallel(0, std::int64_t(n), [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t f = begin; f < end; ++f)
      {
        if (this->Faces[f] && check[f])
        {
          for (const LevelLoopVertex& v : CrossingSegments(this->Loops(f, selection)))
          {
            requests[f].Segments.push_back({ v.Edge, { v.First, v.Last } });
          }
        }
      }
    });
    std::vector<char> before = selection.ChangedEdges;
    std::fill(selection.ChangedEdges.begin(), selection.ChangedEdges.end(), 0);
    std::vector<char> none(n, 0);
    const bool any = selection.Apply(requests, this->Faces, none);
    std::fill(check.begin(), check.end(), 0);
    for (std::size_t e = 0; e < this->Edges.size(); ++e)
    {
      if (selection.ChangedEdges[e])
      {
        for (const WaveletEdgeUse& use : this->Edges[e]->Uses())
        {
          check[use.Where.Face] = 1;
        }
      }
      selection.ChangedEdges[e] = selection.ChangedEdges[e] || before[e];
    }
    if (!any)
    {
      return;
    }
  }
}

std::vector<std::vector<LevelLoopVertex>> WaveletModel::Loops(
  std::int64_t f, const WaveletSelection& selection) const
{
  const Model& data = this->Data.Data;
  const WaveletFace& face = *this->Faces[f];
  const Face& source = data.Faces[f];
  std::vector<std::vector<LevelLoopVertex>> out;
  for (std::int64_t l = source.FirstLoop; l < source.FirstLoop + source.LoopCount; ++l)
  {
    std::vector<LevelLoopVertex> loop;
    const TrimLoop& curves = data.Loops[l];
    for (std::int64_t c = curves.FirstCurve; c < curves.FirstCurve + curves.CurveCount; ++c)
    {
      this->AppendCurve(c, f, selection, loop);
    }
    const auto same = [&](const LevelLoopVertex& a, const LevelLoopVertex& b) {
      return AreNear(face, a.UV, b.UV, a.X == b.X ? NearCorner : SameCorner);
    };
    if (loop.size() > 1 && same(loop.back(), loop.front()) && loop.back().Edge < 0)
    {
      loop.pop_back();
    }
    std::vector<LevelLoopVertex> distinct;
    for (const LevelLoopVertex& v : loop)
    {
      if (!distinct.empty() && distinct.back().UV == v.UV)
      {
        distinct.back() = v;
      }
      else
      {
        distinct.push_back(v);
      }
    }
    while (distinct.size() > 1 && distinct.back().UV == distinct.front().UV)
    {
      distinct.pop_back();
    }
    if (distinct.size() > 1)
    {
      out.push_back(std::move(distinct));
    }
  }
  return out;
}

// Appends a trim curve's vertices in the loop's direction; its first one replaces the last there
// is.
void WaveletModel::AppendCurve(std::int64_t index, std::int64_t f,
  const WaveletSelection& selection, std::vector<LevelLoopVertex>& loop) const
{
  const TrimCurve& curve = this->Data.Data.TrimCurves[index];
  const WaveletEdge& edge = *this->Edges[curve.Edge];
  const WaveletFace& face = *this->Faces[f];
  std::vector<LevelLoopVertex> part;
  if (edge.IsPole())
  {
    this->AppendPole(index, f, selection, part);
  }
  else
  {
    const WaveletEdgeUse& use = edge.Uses()[this->UseOfCurve[index]];
    const bool haar = this->Options.Kind == Wavelet::Haar;
    const int level = selection.EdgeLevel[curve.Edge];
    const std::vector<int>& lines = selection.Lines[curve.Edge];
    std::vector<Vec3> points;
    std::vector<Vec2> uv;
    if (haar)
    {
      points = edge.HaarLevel(level);
      uv = edge.HaarUV(this->Data.Data, this->UseOfCurve[index], level, face);
      if (use.Side >= 0)
      {
        const int d = use.Side % 2;
        const std::vector<double> grid =
          face.Axis(d).Samples(this->Options.Kind, selection.Level[f]);
        for (Vec2& p : uv)
        {
          p[d] = SnapToLine(grid, p[d]);
        }
      }
    }
    const int n = haar ? int(points.size()) : int(lines.size());
    // Lines around the piece between Haar samples i and next: means are of intervals around them.
    const auto haarRange = [&](int i, int next) {
      const int last = int(use.UV.size()) - 1;
      const int low = (std::min(i, next) - 1) * (1 << level);
      return RangeOf(
        face, use.UV, std::clamp(low, 0, last), std::clamp(low + (2 << level), 0, last));
    };
    for (int k = 0; k < n; ++k)
    {
      const int i = curve.Reversed ? n - 1 - k : k;
      const int next = curve.Reversed ? i - 1 : i + 1;
      LevelLoopVertex v;
      v.UV = haar ? uv[i] : use.UV[lines[i]];
      v.X = haar ? points[i] : edge.Points()[lines[i]];
      v.OnSide = use.Side >= 0;
      if (k + 1 < n)
      {
        v.Edge = curve.Edge;
        v.First = haar ? 0 : std::min(lines[i], lines[next]);
        v.Last = haar ? (level > 0 ? 2 : 1) : std::max(lines[i], lines[next]);
        v.SegmentError = haar ? edge.HaarError(level) : edge.SegmentError(v.First, v.Last);
        if (!v.OnSide)
        {
          v.Range = haar ? haarRange(i, next) : RangeOf(face, use.UV, v.First, v.Last);
        }
      }
      part.push_back(v);
    }
  }
  if (part.empty())
  {
    return;
  }
  if (!loop.empty() &&
    AreNear(face, loop.back().UV, part.front().UV,
      loop.back().X == part.front().X ? NearCorner : SameCorner))
  {
    loop.pop_back();
  }
  loop.insert(loop.end(), part.begin(), part.end());
}

// A pole has one point, but as many parameters as the cells along it have corners.
void WaveletModel::AppendPole(std::int64_t index, std::int64_t f, const WaveletSelection& selection,
  std::vector<LevelLoopVertex>& part) const
{
  const Model& data = this->Data.Data;
  const WaveletFace& face = *this->Faces[f];
  const TrimCurve& curve = data.TrimCurves[index];
  const Interval domain = curve.Geometry.Domain();
  const Vec2 a = face.Snap(Evaluate(curve.Geometry, curve.Reversed ? domain.Max : domain.Min));
  const Vec2 b = face.Snap(Evaluate(curve.Geometry, curve.Reversed ? domain.Min : domain.Max));
  if (AreNear(face, a, b, ShortPole))
  {
    return;
  }
  LevelLoopVertex v;
  v.X = data.Vertices[data.Edges[curve.Edge].Vertex[0]];
  v.OnSide = true;
  v.UV = a;
  part.push_back(v);
  const ParameterBox& box = face.Box();
  const double sides[4] = { box.V0, box.U1, box.V1, box.U0 };
  for (int side = 0; side < 4; ++side)
  {
    const int d = side % 2;
    if (a[1 - d] != sides[side] || b[1 - d] != sides[side])
    {
      continue;
    }
    std::vector<double> lines = SideLines(face, selection, f, side, this->Options.Kind);
    if (a[d] > b[d])
    {
      std::reverse(lines.begin(), lines.end());
    }
    for (const double line : lines)
    {
      if ((line - a[d]) * (line - b[d]) < 0.0)
      {
        v.UV[d] = line;
        part.push_back(v);
      }
    }
  }
  v.UV = b;
  part.push_back(v);
}

FaceMeshJob WaveletModel::Job(std::int64_t f, const WaveletSelection& selection, double limit) const
{
  const WaveletFace& face = *this->Faces[f];
  const int level = selection.Level[f];
  FaceMeshJob job;
  job.Source = &face;
  job.Reversed = this->Data.Data.Faces[f].Reversed;
  job.OnSurface = this->Options.Kind == Wavelet::Interpolating;
  job.Offset = job.OnSurface || level == 0 ? 0.0 : face.BilinearError(level);
  for (int d = 0; d < 2; ++d)
  {
    job.Lines[d] = face.Axis(d).Samples(this->Options.Kind, level);
  }
  job.Samples = face.Pyramid().Level(level);
  job.Normals = face.Normals(level);
  job.Loops = this->Loops(f, selection);
  job.Limit = limit;
  // Vertices on a cell's sides are off its bilinear interpolation by no more than the surface is.
  const auto withVertices = [&](const WaveletCell& cell) {
    return 2.0 * face.FineError() + std::min(face.Spread(cell), 2.0 * face.Deviation(cell));
  };
  for (const WaveletCell& cell : selection.Cells[f])
  {
    int at[4];
    face.Extent(cell, at);
    const int u = face.Axis(0).Halvings(level);
    const int v = face.Axis(1).Halvings(level);
    job.Leaves.push_back({ at[0] >> u, at[1] >> u, at[2] >> v, at[3] >> v, cell,
      face.FineError() + face.Deviation(cell), withVertices(cell) });
  }
  if (!job.Leaves.empty())
  {
    return job;
  }
  const double error = face.BilinearError(level);
  for (int j = 0; j + 1 < int(job.Lines[1].size()); ++j)
  {
    for (int i = 0; i + 1 < int(job.Lines[0].size()); ++i)
    {
      const WaveletCell cell{ level, i, j };
      job.Leaves.push_back(
        { i, i + 1, j, j + 1, cell, job.OnSurface ? face.FineError() + face.Deviation(cell) : error,
          job.OnSurface ? withVertices(cell) : 2.0 * error });
    }
  }
  return job;
}

} // namespace nurbs
