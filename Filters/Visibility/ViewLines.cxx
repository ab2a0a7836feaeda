// SPDX-License-Identifier: BSD-3-Clause
#include "ViewLines.h"

#include "EdgeContour.h"
#include "ModelExtent.h"
#include "UnionFind.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

// Share of the work that silhouettes are.
constexpr double SilhouettesDone = 0.7;
// As MakeSilhouettes completes models.
constexpr double JoinShare = 1e-7;

// Faces by connected shell; a shell is closed if each edge has two uses that run opposite ways seen
// from the outside.
std::vector<char> FindShells(const ViewLines& lines)
{
  const Model& model = lines.Whole.Data;
  UnionFind shells(model.Faces.size());
  std::vector<char> open(model.Faces.size(), 0);
  for (std::size_t e = 0; e < lines.Uses.size(); ++e)
  {
    const std::vector<EdgeUse>& uses = lines.Uses[e];
    if (uses.empty() || IsDegenerate(model.Edges[e]))
    {
      continue;
    }
    for (const EdgeUse& use : uses)
    {
      shells.Join(use.Face, uses.front().Face);
    }
    const auto isForward = [&](const EdgeUse& use) {
      return model.TrimCurves[use.Curve].Reversed == model.Faces[use.Face].Reversed;
    };
    if (uses.size() != 2 || isForward(uses[0]) == isForward(uses[1]))
    {
      open[uses.front().Face] = 1;
    }
  }
  std::vector<char> openShell(model.Faces.size(), 0);
  for (std::size_t f = 0; f < open.size(); ++f)
  {
    openShell[shells.Find(std::int64_t(f))] |= open[f] || model.Faces[f].LoopCount == 0;
  }
  std::vector<char> out(open.size());
  for (std::size_t f = 0; f < open.size(); ++f)
  {
    out[f] = !openShell[shells.Find(std::int64_t(f))];
  }
  return out;
}

ViewLine MakeEdgeLine(
  const ViewLines& lines, std::int64_t edge, LineKind kind, const SilhouetteOptions& options)
{
  const Model& model = lines.Whole.Data;
  const std::vector<EdgeUse>& uses = lines.Uses[edge];
  ViewLine line;
  line.Kind = kind;
  line.Face = uses.front().Face;
  line.Edge = edge;
  const Interval domain = model.TrimCurves[uses.front().Curve].Geometry.Domain();
  line.Points = LiftEdge(model, uses.front(), domain, options.Precision, &line.Shares);
  for (double& share : line.Shares)
  {
    share = (share - domain.Min) / domain.Length();
  }
  line.IsBehind = std::all_of(uses.begin(), uses.end(), [&](const EdgeUse& use) {
    return lines.IsShell[use.Face] && !MayFaceViewer(lines.Faces[use.Face]);
  });
  return line;
}

double ShareOf(const TrimCurve& curve, double parameter)
{
  const Interval domain = curve.Geometry.Domain();
  return std::clamp((parameter - domain.Min) / domain.Length(), 0.0, 1.0);
}

template <typename T>
T Interpolate(const std::vector<T>& values, LinePosition at)
{
  const auto k = std::min(std::size_t(std::max(at, 0.0)), values.size() - 1);
  const double share = at - double(k);
  return k + 1 < values.size() && share > 0.0 ? T(values[k] + share * (values[k + 1] - values[k]))
                                              : values[k];
}

} // namespace

namespace
{

// Shares of an edge that are nearer to each other mean one point.
constexpr double SameShare = 1e-9;
// A point of a curve, by the distance as a share of the domain; and the search for it.
constexpr double OnCurve = 1e-6;
constexpr int CurveSamples = 16;
constexpr int CurveSteps = 40;

// Where silhouettes end on edges, by edge.
struct EdgeEnd
{
  double Share;
  Vec3 Point;
};

// False if a curve is farther from a point than OnCurve, as its control points tell.
template <typename PointAt>
bool MayPass(int count, const PointAt& pointAt, const Vec2& uv, const Vec2& size)
{
  Box2 box;
  for (int k = 0; k < count; ++k)
  {
    box.extend(pointAt(k));
  }
  const Vec2 reach = OnCurve * size;
  return (uv - box.min() + reach).minCoeff() >= 0.0 && (box.max() - uv + reach).minCoeff() >= 0.0;
}

// Where a trim curve of the face passes (u, v): contours that end at the border of the domain do not
// tell. Curve -1: none does.
TrimCrossing FindCurve(const Model& model, const Face& face, const Vec2& uv)
{
  const Vec2 size(face.Geometry.Domain(0).Length(), face.Geometry.Domain(1).Length());
  TrimCrossing out;
  double least = OnCurve;
  for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
  {
    const TrimLoop& loop = model.Loops[l];
    for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
    {
      const CurveView<2>& curve = model.TrimCurves[c].Geometry;
      if (!MayPass(
            curve.Count, [&](int k) { return curve.Point(k); }, uv, size))
      {
        continue;
      }
      for (const BezierCurve<2>& piece : ToBezier(curve))
      {
        const auto pointOf = [&](int k) {
          return Vec2(piece.Points[k].head<2>() / piece.Points[k][2]);
        };
        if (!MayPass(piece.Degree() + 1, pointOf, uv, size))
        {
          continue;
        }
        const auto distance = [&](double t) {
          return (piece.Evaluate(t) - uv).cwiseQuotient(size).norm();
        };
        double best = 0.0;
        for (int k = 1; k <= CurveSamples; ++k)
        {
          const double t = double(k) / CurveSamples;
          best = distance(t) < distance(best) ? t : best;
        }
        // Narrow the two intervals beside the nearest sample down to a point.
        double low = std::max(0.0, best - 1.0 / CurveSamples);
        double high = std::min(1.0, best + 1.0 / CurveSamples);
        for (int k = 0; k < CurveSteps; ++k)
        {
          const double a = low + 0.382 * (high - low);
          const double b = low + 0.618 * (high - low);
          (distance(a) < distance(b) ? high : low) = distance(a) < distance(b) ? b : a;
        }
        const double ends[] = { 0.0, 0.5 * (low + high), 1.0 };
        for (const double t : ends)
        {
          if (distance(t) < least)
          {
            least = distance(t);
            out.Curve = c;
            out.Parameter = piece.T0 + t * (piece.T1 - piece.T0);
          }
        }
      }
    }
  }
  return out;
}

// Makes points of edges where silhouettes end on them, so that the two meet in the image, too.
void InsertEnds(const ViewLines& lines, std::vector<EdgeEnd> ends, ViewLine& line)
{
  std::sort(
    ends.begin(), ends.end(), [](const EdgeEnd& a, const EdgeEnd& b) { return a.Share < b.Share; });
  for (const EdgeEnd& end : ends)
  {
    const auto above = std::lower_bound(line.Shares.begin(), line.Shares.end(), end.Share);
    const auto k = above - line.Shares.begin();
    const auto isSame = [&](std::ptrdiff_t i) {
      return i >= 0 && i < std::ptrdiff_t(line.Shares.size()) &&
        std::abs(line.Shares[i] - end.Share) < SameShare;
    };
    if (isSame(k) || isSame(k - 1))
    {
      line.Points[isSame(k) ? k : k - 1].Point = end.Point;
      continue;
    }
    ContourPoint point = ExactPointAt(lines, line,
      double(k - 1) + (end.Share - line.Shares[k - 1]) / (line.Shares[k] - line.Shares[k - 1]));
    point.Point = end.Point;
    line.Shares.insert(above, end.Share);
    line.Points.insert(line.Points.begin() + k, point);
  }
  for (std::size_t k = 0; k < line.Shares.size(); ++k)
  {
    if (std::any_of(ends.begin(), ends.end(),
          [&](const EdgeEnd& end) { return std::abs(end.Share - line.Shares[k]) < SameShare; }))
    {
      line.Turns.push_back(double(k));
    }
  }
}

// Moves the image of a line that ends at a vertex to that of the vertex. Elsewhere on an edge, it is the
// point that InsertEnds has made.
void EndAtVertex(
  const Model& model, const TrimCrossing& crossing, const ImagePlane& image, Vec2& at)
{
  const Edge& edge = model.Edges[model.TrimCurves[crossing.Curve].Edge];
  const double share = ShareOf(model.TrimCurves[crossing.Curve], crossing.Parameter);
  const int vertex = share < SameShare ? 0 : (share > 1.0 - SameShare ? 1 : -1);
  const bool isVertex = vertex >= 0 || IsDegenerate(edge);
  const std::int64_t v = isVertex ? edge.Vertex[std::max(vertex, 0)] : -1;
  at = v >= 0 ? image.Project(model.Vertices[v]) : at;
}

// One image for what is one point: ends of edges at a vertex, of silhouettes that go on in each other
// or end at a pole, of intersections.
void ProjectLines(const Silhouettes& silhouettes, const FaceIntersections& intersections,
  const ImagePlane& image, ViewLines& lines)
{
  const Model& model = lines.Whole.Data;
  for (ViewLine& line : lines.Lines)
  {
    line.Image.resize(line.Points.size());
    std::transform(line.Points.begin(), line.Points.end(), line.Image.begin(),
      [&](const ContourPoint& point) { return image.Project(point.Point); });
    for (int end = 0; end < 2 && line.IsEdge(); ++end)
    {
      const std::int64_t vertex = model.Edges[line.Edge].Vertex[end];
      if (vertex >= 0)
      {
        (end == 0 ? line.Image.front() : line.Image.back()) = image.Project(model.Vertices[vertex]);
      }
    }
  }
  for (std::size_t k = 0; k < silhouettes.Lines.size(); ++k)
  {
    const SilhouetteLine& source = silhouettes.Lines[k];
    for (int end = 0; end < 2 && !source.Closed; ++end)
    {
      Vec2& at = end == 0 ? lines.Lines[k].Image.front() : lines.Lines[k].Image.back();
      const std::int64_t curve = source.Ends[end].Curve;
      const std::int64_t edge = curve < 0 ? -1 : model.TrimCurves[curve].Edge;
      if (edge >= 0)
      {
        EndAtVertex(model, source.Ends[end], image, at);
      }
      else if (source.Next[end] >= 0 && source.Next[end] < std::int64_t(k))
      {
        const ViewLine& next = lines.Lines[source.Next[end]];
        at = source.NextEnd[end] == 0 ? next.Image.front() : next.Image.back();
      }
    }
  }
  for (std::size_t k = 0; k < intersections.Curves.size(); ++k)
  {
    ViewLine& line = lines.Lines[silhouettes.Lines.size() + k];
    for (int end = 0; end < 2; ++end)
    {
      const TrimCrossing& crossing = intersections.Curves[k].Ends[end];
      if (crossing.Curve >= 0)
      {
        EndAtVertex(model, crossing, image, end == 0 ? line.Image.front() : line.Image.back());
      }
    }
  }
}

// Appends intersection curves, and to `ends` where they end on edges.
void AddIntersections(
  const FaceIntersections& intersections, std::vector<std::vector<EdgeEnd>>& ends, ViewLines& lines)
{
  for (const FaceIntersection& curve : intersections.Curves)
  {
    ViewLine line;
    line.Kind = LineKind::Intersection;
    line.Face = curve.Face[0];
    line.OtherFace = curve.Face[1];
    for (const IntersectionPoint& point : curve.Points)
    {
      line.Points.push_back({ point.UV[0], point.Point, 0.0 });
      line.OtherUV.push_back(point.UV[1]);
    }
    line.IsBehind = std::all_of(curve.Face, curve.Face + 2,
      [&](std::int64_t face) { return lines.IsShell[face] && !MayFaceViewer(lines.Faces[face]); });
    for (int end = 0; end < 2; ++end)
    {
      if (curve.Ends[end].Curve >= 0)
      {
        const TrimCurve& trim = lines.Whole.Data.TrimCurves[curve.Ends[end].Curve];
        ends[trim.Edge].push_back({ ShareOf(trim, curve.Ends[end].Parameter),
          end == 0 ? curve.Points.front().Point : curve.Points.back().Point });
      }
    }
    lines.Lines.push_back(std::move(line));
  }
}

} // namespace

ViewLines MakeViewLines(const Model& model, const TrimIndex& trims,
  const std::vector<std::string>& faceErrors, const SilhouetteOptions& options,
  const ImagePlane& image, bool allSmooth, std::shared_ptr<const FaceIntersections> known)
{
  ViewLines out;
  SilhouetteOptions contours = options;
  const bool kinds[LineKindCount] = { true, false, false, false };
  std::copy(kinds, kinds + LineKindCount, contours.Kinds);
  const auto report = [&](double done) { return !options.Progress || options.Progress(done); };
  contours.Progress = [&](double done) { return report(SilhouettesDone * done); };
  Silhouettes silhouettes = MakeSilhouettes(model, faceErrors, contours);
  out.Aborted = silhouettes.Aborted;
  if (out.Aborted)
  {
    return out;
  }
  const double size = Diagonal(FaceBoxes(model, faceErrors, options.Parallel));
  // The same as the silhouettes were made of, so that they name its curves.
  out.Whole = CompleteModel(model, faceErrors, JoinShare * size);
  out.Uses = UsesOfEdges(out.Whole.Data, faceErrors);
  out.Faces = silhouettes.Faces;
  out.IsShell = FindShells(out);
  FaceIntersectionOptions piercing;
  piercing.Precision = options.Precision;
  piercing.Parallel = options.Parallel;
  piercing.Progress = [&](double done) {
    return report(SilhouettesDone + (1.0 - SilhouettesDone) * done);
  };
  out.Intersections = known ? std::move(known)
                            : std::make_shared<const FaceIntersections>(
                                FindIntersections(out.Whole.Data, trims, faceErrors, piercing));
  const FaceIntersections& intersections = *out.Intersections;
  out.Aborted = intersections.Aborted;
  if (out.Aborted)
  {
    return out;
  }
  out.Unresolved = intersections.Unresolved;
  const auto edges = std::int64_t(out.Whole.Data.Edges.size());
  std::vector<std::vector<EdgeEnd>> ends(edges);
  std::vector<char> meets(edges, 0);
  for (SilhouetteLine& source : silhouettes.Lines)
  {
    ViewLine line;
    line.Face = source.Face;
    line.Edge = source.Edge;
    if (line.Edge >= 0)
    {
      meets[line.Edge] = 1;
    }
    line.Points = source.Points;
    if (source.Closed)
    {
      line.Points.push_back(line.Points.front());
    }
    for (int end = 0; end < 2 && !source.Closed; ++end)
    {
      const ContourPoint& point = end == 0 ? line.Points.front() : line.Points.back();
      TrimCrossing& crossing = source.Ends[end];
      if (crossing.Curve < 0)
      {
        crossing = FindCurve(out.Whole.Data, out.Whole.Data.Faces[line.Face], point.UV);
      }
      if (crossing.Curve >= 0)
      {
        const TrimCurve& curve = out.Whole.Data.TrimCurves[crossing.Curve];
        const double share = ShareOf(curve, crossing.Parameter);
        ends[curve.Edge].push_back({ share, point.Point });
        meets[curve.Edge] |= share > SameShare && share < 1.0 - SameShare;
      }
    }
    out.Lines.push_back(std::move(line));
  }
  AddIntersections(intersections, ends, out);
  const auto first = std::int64_t(out.Lines.size());
  out.Lines.resize(first + edges);
  std::vector<char> isInner(edges, 0);
  options.Parallel(0, edges, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t e = begin; e < end; ++e)
    {
      isInner[e] = !allSmooth && silhouettes.EdgeKinds[e] == LineKind::Smooth && !meets[e] &&
        !IsDegenerate(out.Whole.Data.Edges[e]) &&
        FaceTheSameWay(out.Whole.Data, e, out.Uses[e], options.View);
      if (!out.Uses[e].empty() && !IsDegenerate(out.Whole.Data.Edges[e]) && !isInner[e])
      {
        out.Lines[first + e] = MakeEdgeLine(out, e, silhouettes.EdgeKinds[e], options);
        InsertEnds(out, ends[e], out.Lines[first + e]);
        out.Lines[first + e].MeetsSilhouette = meets[e] != 0;
      }
    }
  });
  out.Lines.erase(std::remove_if(out.Lines.begin() + first, out.Lines.end(),
                    [](const ViewLine& line) { return line.Points.size() < 2; }),
    out.Lines.end());
  UnionFind clusters(out.Whole.Data.Faces.size());
  for (std::int64_t e = 0; e < edges; ++e)
  {
    if (isInner[e])
    {
      clusters.Join(out.Uses[e][0].Face, out.Uses[e][1].Face);
    }
  }
  out.Cluster = clusters.Sets();
  ProjectLines(silhouettes, intersections, image, out);
  return out;
}

Box2 ViewLines::Box() const
{
  Box2 box;
  for (const ViewLine& line : this->Lines)
  {
    for (const Vec2& point : line.Image)
    {
      box.extend(point);
    }
  }
  return box;
}

namespace
{

template <typename IsIt>
bool AnyFace(const ViewLines& lines, const ViewLine& line, const IsIt& isIt)
{
  if (!line.IsEdge())
  {
    return isIt(line.Face) || (line.IsIntersection() && isIt(line.OtherFace));
  }
  const std::vector<EdgeUse>& uses = lines.Uses[line.Edge];
  return std::any_of(uses.begin(), uses.end(), [&](const EdgeUse& use) { return isIt(use.Face); });
}

} // namespace

bool IsOfFace(const ViewLines& lines, const ViewLine& line, std::int64_t face)
{
  return AnyFace(
    lines, line, [&](std::int64_t own) { return lines.Cluster[own] == lines.Cluster[face]; });
}

bool UsesLine(const ViewLines& lines, const ViewLine& line, std::int64_t face)
{
  return AnyFace(lines, line, [&](std::int64_t own) { return own == face; });
}

bool MayFaceViewer(const FaceSilhouette& face)
{
  return face.Patches[int(PatchVisibility::Visible)] + face.Patches[int(PatchVisibility::Partial)] >
    0;
}

Vec3 PointAt(const ViewLine& line, LinePosition at)
{
  const auto k = std::min(std::size_t(std::max(at, 0.0)), line.Points.size() - 1);
  const double share = at - double(k);
  const Vec3& a = line.Points[k].Point;
  return k + 1 < line.Points.size() && share > 0.0
    ? Vec3(a + share * (line.Points[k + 1].Point - a))
    : a;
}

Vec2 ParametersAt(const ViewLine& line, LinePosition at)
{
  const auto k = std::min(std::size_t(std::max(at, 0.0)), line.Points.size() - 1);
  const double share = at - double(k);
  const Vec2& a = line.Points[k].UV;
  return k + 1 < line.Points.size() && share > 0.0 ? Vec2(a + share * (line.Points[k + 1].UV - a))
                                                   : a;
}

Vec2 ParametersAt(const ViewLine& line, LinePosition at, std::int64_t face)
{
  return line.IsIntersection() && face == line.OtherFace ? Interpolate(line.OtherUV, at)
                                                         : ParametersAt(line, at);
}

Vec2 ImageAt(const ViewLine& line, LinePosition at)
{
  return Interpolate(line.Image, at);
}

ContourPoint ExactPointAt(const ViewLines& lines, const ViewLine& line, LinePosition at)
{
  ContourPoint out;
  out.UV = ParametersAt(line, at);
  const SurfaceView& surface = lines.Whole.Data.Faces[line.Face].Geometry;
  if (line.IsEdge())
  {
    const TrimCurve& curve = lines.Whole.Data.TrimCurves[lines.Uses[line.Edge].front().Curve];
    const Interval domain = curve.Geometry.Domain();
    out.UV = Evaluate(curve.Geometry, domain.Min + ShareAt(line, at) * domain.Length());
    out.UV = Vec2(surface.Domain(0).Clamp(out.UV[0]), surface.Domain(1).Clamp(out.UV[1]));
  }
  out.Point = Evaluate(surface, out.UV[0], out.UV[1]);
  const auto k = std::size_t(std::max(at, 0.0));
  if (line.IsIntersection() && at > double(k) && k + 1 < line.Points.size())
  {
    const Face& other = lines.Whole.Data.Faces[line.OtherFace];
    IntersectionPoint point{ out.Point, { out.UV, ParametersAt(line, at, line.OtherFace) } };
    const Vec3 chord = line.Points[k + 1].Point - line.Points[k].Point;
    if (FindCommonPoint(surface, other.Geometry, PointAt(line, at), chord.normalized(), point) &&
      (point.Point - out.Point).norm() <= chord.norm())
    {
      out.UV = point.UV[0];
      out.Point = point.Point;
    }
  }
  return out;
}

double ShareAt(const ViewLine& line, LinePosition at)
{
  return Interpolate(line.Shares, at);
}

} // namespace nurbs
