// SPDX-License-Identifier: BSD-3-Clause
#include "ViewLines.h"

#include "ModelExtent.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace nurbs
{

namespace
{

// As MakeSilhouettes completes models.
constexpr double JoinShare = 1e-7;

// Faces by connected shell; a shell is closed if each edge has two uses that run opposite ways seen
// from the outside.
std::vector<char> FindShells(const ViewLines& lines)
{
  const Model& model = lines.Whole.Data;
  std::vector<std::int64_t> parent(model.Faces.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto find = [&](std::int64_t f) {
    while (parent[f] != f)
    {
      f = parent[f] = parent[parent[f]];
    }
    return f;
  };
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
      parent[find(use.Face)] = find(uses.front().Face);
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
    openShell[find(std::int64_t(f))] |= open[f] || model.Faces[f].LoopCount == 0;
  }
  std::vector<char> out(open.size());
  for (std::size_t f = 0; f < open.size(); ++f)
  {
    out[f] = !openShell[find(std::int64_t(f))];
  }
  return out;
}

bool MayFaceViewer(const FaceSilhouette& face)
{
  return face.Patches[int(PatchVisibility::Visible)] + face.Patches[int(PatchVisibility::Partial)] >
    0;
}

ViewLine MakeEdgeLine(const ViewLines& lines, std::int64_t edge, const SilhouetteOptions& options)
{
  const Model& model = lines.Whole.Data;
  const std::vector<EdgeUse>& uses = lines.Uses[edge];
  ViewLine line;
  line.Kind = KindOfEdge(model, edge, uses, options.FeatureAngle);
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

template <typename T>
T Interpolate(const std::vector<T>& values, LinePosition at)
{
  const auto k = std::min(std::size_t(std::max(at, 0.0)), values.size() - 1);
  const double share = at - double(k);
  return k + 1 < values.size() && share > 0.0 ? T(values[k] + share * (values[k + 1] - values[k]))
                                              : values[k];
}

} // namespace

ViewLines MakeViewLines(const Model& model, const std::vector<std::string>& faceErrors,
  const SilhouetteOptions& options, const ImagePlane& image)
{
  ViewLines out;
  SilhouetteOptions contours = options;
  const bool kinds[LineKindCount] = { true, false, false, false };
  std::copy(kinds, kinds + LineKindCount, contours.Kinds);
  Silhouettes silhouettes = MakeSilhouettes(model, faceErrors, contours);
  out.Aborted = silhouettes.Aborted;
  if (out.Aborted)
  {
    return out;
  }
  const double size = Diagonal(FaceBoxes(model, faceErrors, options.Parallel));
  std::vector<std::string> errors = faceErrors;
  for (std::size_t f = 0; f < errors.size(); ++f)
  {
    if (silhouettes.Faces[f].Status == SilhouetteStatus::Failed)
    {
      errors[f] = silhouettes.Faces[f].Message;
    }
  }
  out.Whole = CompleteModel(model, errors, JoinShare * size);
  out.Uses = UsesOfEdges(out.Whole.Data, errors);
  out.Faces = std::move(silhouettes.Faces);
  out.IsShell = FindShells(out);
  for (SilhouetteLine& source : silhouettes.Lines)
  {
    ViewLine line;
    line.Crease = source.Crease;
    line.Face = source.Face;
    line.Edge = source.Edge;
    line.Points = std::move(source.Points);
    if (source.Closed)
    {
      line.Points.push_back(line.Points.front());
    }
    out.Lines.push_back(std::move(line));
  }
  const auto first = std::int64_t(out.Lines.size());
  const auto edges = std::int64_t(out.Whole.Data.Edges.size());
  out.Lines.resize(first + edges);
  options.Parallel(0, edges, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t e = begin; e < end; ++e)
    {
      if (!out.Uses[e].empty() && !IsDegenerate(out.Whole.Data.Edges[e]))
      {
        out.Lines[first + e] = MakeEdgeLine(out, e, options);
      }
    }
  });
  out.Lines.erase(std::remove_if(out.Lines.begin() + first, out.Lines.end(),
                    [](const ViewLine& line) { return line.Points.size() < 2; }),
    out.Lines.end());
  for (ViewLine& line : out.Lines)
  {
    line.Image.resize(line.Points.size());
    std::transform(line.Points.begin(), line.Points.end(), line.Image.begin(),
      [&](const ContourPoint& point) { return image.Project(point.Point); });
  }
  return out;
}

bool IsOfFace(const ViewLines& lines, const ViewLine& line, std::int64_t face)
{
  if (!line.IsEdge())
  {
    return line.Face == face;
  }
  const std::vector<EdgeUse>& uses = lines.Uses[line.Edge];
  return std::any_of(
    uses.begin(), uses.end(), [&](const EdgeUse& use) { return use.Face == face; });
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
  return out;
}

double ShareAt(const ViewLine& line, LinePosition at)
{
  return Interpolate(line.Shares, at);
}

} // namespace nurbs
