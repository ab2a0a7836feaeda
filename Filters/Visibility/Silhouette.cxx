// SPDX-License-Identifier: BSD-3-Clause
#include "Silhouette.h"

#include "EdgeContour.h"
#include "LineChains.h"
#include "ModelExtent.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>

namespace nurbs
{

namespace
{

// Singular cells are smaller than this share of the model, or the precision.
constexpr double SmallestShare = 1e-6;
// Ends of lines of faces that fit exactly meet within this share of the model.
constexpr double JoinShare = 1e-7;
// Silhouettes that are shorter are none: where one passes a corner of patches within rounding.
constexpr double ShortShare = 1e-9;

// All steps of one call.
class SilhouetteMaker
{
public:
  SilhouetteMaker(const Model& model, const std::vector<std::string>& faceErrors,
    const SilhouetteOptions& options)
    : FaceErrors(faceErrors)
    , Options(options)
    , Size(Diagonal(FaceBoxes(model, faceErrors, options.Parallel)))
    , Whole(CompleteModel(model, faceErrors, JoinShare * this->Size))
    , Uses(UsesOfEdges(this->Whole.Data, faceErrors))
  {}

  Silhouettes Run();

private:
  void TraceFaces(Silhouettes& out);
  void TraceFace(std::int64_t face, FaceSilhouette& status, std::vector<SilhouetteLine>& lines);
  void CheckCosines(SilhouetteLine& line) const;
  void TraceEdge(std::int64_t edge, std::vector<SilhouetteLine>& lines);
  void TraceEdges(Silhouettes& out);
  void DropShort(std::vector<SilhouetteLine>& lines) const;
  void DropRepeated(std::vector<SilhouetteLine>& lines) const;
  void Chain(Silhouettes& out) const;
  bool Step();
  std::int64_t PartOf(std::int64_t face) const
  {
    return this->Options.Parts.empty() ? 0 : this->Options.Parts[face];
  }

  const std::vector<std::string>& FaceErrors;
  const SilhouetteOptions& Options;
  double Size;
  CompletedModel Whole;
  std::vector<std::vector<EdgeUse>> Uses;
  Viewer View;
  std::int64_t Steps = 1;
  std::atomic<std::int64_t> Done{ 0 };
  std::atomic<bool> Aborted{ false };
};

bool SilhouetteMaker::Step()
{
  const std::int64_t done = ++this->Done;
  if (this->Options.Progress && !this->Options.Progress(double(done) / double(this->Steps)))
  {
    this->Aborted = true;
  }
  return !this->Aborted;
}

std::string StatusMessage(
  const SurfaceContours& contours, const ContourPoint& first, const Viewer& viewer, double smallest)
{
  if (viewer.Perspective && (first.Point - viewer.Place).norm() <= 10.0 * smallest)
  {
    return "the eye lies on the surface";
  }
  const std::string place =
    "(" + std::to_string(first.UV[0]) + ", " + std::to_string(first.UV[1]) + ")";
  return contours.UnresolvedCells > 0
    ? std::to_string(contours.UnresolvedCells) + " cells are not resolved, one at " + place
    : "normal . view is singular at " + place;
}

// Looks again at points where normal . view is not 0: at poles that are some rounding wide the product
// of the derivatives says nothing, but the limit of the normals does.
void SilhouetteMaker::CheckCosines(SilhouetteLine& line) const
{
  const SurfaceView& surface = this->Whole.Data.Faces[line.Face].Geometry;
  for (ContourPoint& point : line.Points)
  {
    const Vec3 view = this->View.Toward(point.Point);
    if (std::abs(point.Cosine) > ContourCosine && !view.isZero(0.0))
    {
      point.Cosine = Normal(surface, point.UV[0], point.UV[1]).dot(view.normalized());
    }
  }
}

void SilhouetteMaker::TraceFace(
  std::int64_t face, FaceSilhouette& status, std::vector<SilhouetteLine>& lines)
{
  const Face& source = this->Whole.Data.Faces[face];
  ContourLimits limits;
  limits.Precision = this->Options.Precision;
  limits.Smallest = std::min(0.25 * this->Options.Precision, SmallestShare * this->Size);
  limits.MaximumCells = int(this->Options.MaximumCells);
  const SurfaceContours contours = TraceSurface(
    source.Geometry, source.Reversed, LoopsBox(this->Whole.Data, source), this->View, limits);
  std::copy(contours.Patches, contours.Patches + PatchVisibilityCount, status.Patches);
  const bool singular = contours.SingularCells + contours.UnresolvedCells > 0;
  if (!singular && (contours.Contours.empty() || !this->Options.Kinds[0]))
  {
    return;
  }
  const ContourTrimmer trimmer(this->Whole.Data, face, this->View, this->Options.Precision);
  const auto inside = std::find_if(contours.Singular.begin(), contours.Singular.end(),
    [&](const ContourPoint& point) { return trimmer.IsInside(point.UV); });
  if (singular && inside != contours.Singular.end())
  {
    status.Status =
      contours.UnresolvedCells > 0 ? SilhouetteStatus::Capped : SilhouetteStatus::Singular;
    status.Message = StatusMessage(contours, *inside, this->View, limits.Smallest);
  }
  if (!this->Options.Kinds[0])
  {
    return;
  }
  std::vector<TrimmedContour> pieces;
  for (const SurfaceContour& contour : contours.Contours)
  {
    trimmer.Cut(contour, pieces);
  }
  for (TrimmedContour& piece : pieces)
  {
    SilhouetteLine line;
    line.Face = face;
    line.Edge = piece.Along < 0 ? -1 : this->Whole.Data.TrimCurves[piece.Along].Edge;
    line.Crease = piece.Contour.Kind == ContourArcKind::Crease;
    line.Closed = piece.Contour.Closed;
    line.Points = std::move(piece.Contour.Points);
    this->CheckCosines(line);
    line.Ends[0] = piece.Ends[0];
    line.Ends[1] = piece.Ends[1];
    lines.push_back(std::move(line));
  }
}

template <typename T>
void GetOne(T& value, MessageReader& message)
{
  std::vector<T> values;
  message.Get(values);
  value = values.at(0);
}

// Lines as they are traced: what they are chained to is not yet known.
void PutLines(const std::vector<SilhouetteLine>& lines, MessageWriter& message)
{
  const std::int64_t count = std::int64_t(lines.size());
  message.Put(&count, 1);
  for (const SilhouetteLine& line : lines)
  {
    const std::int64_t head[] = { std::int64_t(line.Kind), line.Face, line.Edge, line.Crease,
      line.Closed };
    message.Put(head, 5);
    message.Put(line.Ends, 2);
    message.Put(line.Points);
  }
}

void GetLines(std::vector<SilhouetteLine>& lines, MessageReader& message)
{
  std::int64_t count = 0;
  GetOne(count, message);
  lines.resize(std::size_t(count));
  for (SilhouetteLine& line : lines)
  {
    std::vector<std::int64_t> head;
    std::vector<TrimCrossing> ends;
    message.Get(head);
    message.Get(ends);
    message.Get(line.Points);
    line.Kind = LineKind(head[0]);
    line.Face = head[1];
    line.Edge = head[2];
    line.Crease = head[3] != 0;
    line.Closed = head[4] != 0;
    std::copy(ends.begin(), ends.end(), line.Ends);
  }
}

void SilhouetteMaker::TraceFaces(Silhouettes& out)
{
  const std::int64_t count = std::int64_t(this->Whole.Data.Faces.size());
  std::vector<std::vector<SilhouetteLine>> lines(count);
  const auto trace = [&](std::int64_t f) {
    if (this->Aborted)
    {
      return;
    }
    FaceSilhouette& status = out.Faces[f];
    status.Message = this->FaceErrors[f];
    try
    {
      if (status.Message.empty())
      {
        this->TraceFace(f, status, lines[f]);
      }
    }
    catch (const Error& problem)
    {
      status.Message = problem.what();
      lines[f].clear();
    }
    if (!status.Message.empty() && status.Status == SilhouetteStatus::Ok)
    {
      status.Status = SilhouetteStatus::Failed;
    }
    this->Step();
  };
  ForShared(
    this->Options.Share, this->Options.Parallel, count, trace,
    [&](std::int64_t f, MessageWriter& message) {
      const FaceSilhouette& status = out.Faces[f];
      message.Put(&status.Status, 1);
      message.Put(status.Message);
      message.Put(status.Patches, PatchVisibilityCount);
      PutLines(lines[f], message);
    },
    [&](std::int64_t f, MessageReader& message) {
      FaceSilhouette& status = out.Faces[f];
      GetOne(status.Status, message);
      message.Get(status.Message);
      std::vector<std::int64_t> patches;
      message.Get(patches);
      std::copy(patches.begin(), patches.end(), status.Patches);
      GetLines(lines[f], message);
    });
  for (std::vector<SilhouetteLine>& part : lines)
  {
    std::move(part.begin(), part.end(), std::back_inserter(out.Lines));
  }
}

// True if one of the two faces may face the viewer where the other one does not.
bool MayTurn(const Silhouettes& result, const std::vector<EdgeUse>& uses)
{
  bool front = false;
  bool back = false;
  for (const EdgeUse& use : uses)
  {
    const std::int64_t* const patches = result.Faces[use.Face].Patches;
    front =
      front || patches[int(PatchVisibility::Visible)] + patches[int(PatchVisibility::Partial)] > 0;
    back =
      back || patches[int(PatchVisibility::Invisible)] + patches[int(PatchVisibility::Partial)] > 0;
  }
  return front && back;
}

// What of a smooth edge is a contour itself.
void SilhouetteMaker::TraceEdge(std::int64_t edge, std::vector<SilhouetteLine>& lines)
{
  for (EdgeContour& contour :
    ContoursOfEdge(this->Whole.Data, edge, this->Uses[edge], this->View, this->Options.Precision))
  {
    SilhouetteLine line;
    line.Face = contour.Use.Face;
    line.Edge = edge;
    line.Crease = true;
    line.Points = std::move(contour.Points);
    for (int end = 0; end < 2; ++end)
    {
      line.Ends[end] = { contour.Use.Curve, contour.Ends[end] };
    }
    lines.push_back(std::move(line));
  }
  this->DropShort(lines);
}

void SilhouetteMaker::TraceEdges(Silhouettes& out)
{
  const Model& model = this->Whole.Data;
  const std::int64_t count = std::int64_t(model.Edges.size());
  out.EdgeKinds.assign(count, LineKind::Smooth);
  std::vector<std::vector<SilhouetteLine>> lines(count); // One an edge, or none.
  std::vector<std::vector<SilhouetteLine>> contours(count);
  const auto trace = [&](std::int64_t e) {
    if (this->Aborted)
    {
      return;
    }
    this->Step();
    const std::vector<EdgeUse>& uses = this->Uses[e];
    if (uses.empty() || IsDegenerate(model.Edges[e]))
    {
      return;
    }
    const LineKind kind = KindOfEdge(model, e, uses, this->Options.FeatureAngle);
    out.EdgeKinds[e] = kind;
    if (kind == LineKind::Smooth && this->Options.Kinds[0] && MayTurn(out, uses))
    {
      this->TraceEdge(e, contours[e]);
    }
    if (this->Options.Kinds[static_cast<int>(kind)])
    {
      SilhouetteLine line;
      line.Kind = kind;
      line.Face = uses.front().Face;
      line.Edge = e;
      line.Points = LiftEdge(model, uses.front(),
        model.TrimCurves[uses.front().Curve].Geometry.Domain(), this->Options.Precision);
      if (line.Points.size() > 1)
      {
        lines[e].push_back(std::move(line));
      }
    }
  };
  ForShared(
    this->Options.Share, this->Options.Parallel, count, trace,
    [&](std::int64_t e, MessageWriter& message) {
      message.Put(&out.EdgeKinds[e], 1);
      PutLines(contours[e], message);
      PutLines(lines[e], message);
    },
    [&](std::int64_t e, MessageReader& message) {
      GetOne(out.EdgeKinds[e], message);
      GetLines(contours[e], message);
      GetLines(lines[e], message);
    });
  for (std::vector<std::vector<SilhouetteLine>>* all : { &contours, &lines })
  {
    for (std::vector<SilhouetteLine>& part : *all)
    {
      std::move(part.begin(), part.end(), std::back_inserter(out.Lines));
    }
  }
}

// Where a line comes near to a pole, the apex of a cone for example, normal . view loses its digits.
void DropInexactEnds(std::vector<ContourPoint>& points, double reach)
{
  const auto isInexact = [&](const ContourPoint& end, const ContourPoint& next) {
    return std::abs(end.Cosine) > ContourCosine && (end.Point - next.Point).norm() <= reach;
  };
  while (points.size() > 2 && isInexact(points.back(), points[points.size() - 2]))
  {
    points.pop_back();
  }
  while (points.size() > 2 && isInexact(points[0], points[1]))
  {
    points.erase(points.begin());
  }
}

// Points that follow each other at the same place become one, lines of no length vanish; what they
// joined is as near to each other.
void SilhouetteMaker::DropShort(std::vector<SilhouetteLine>& lines) const
{
  const double same = 1e-12 * this->Size;
  for (SilhouetteLine& line : lines)
  {
    std::vector<ContourPoint> points;
    double length = 0.0;
    for (const ContourPoint& point : line.Points)
    {
      const double step = points.empty() ? 0.0 : (point.Point - points.back().Point).norm();
      length += step;
      if (points.empty() || step > same)
      {
        points.push_back(point);
      }
      else if (&point == &line.Points.back())
      {
        points.back() = point;
      }
    }
    DropInexactEnds(points, JoinShare * this->Size);
    line.Points = std::move(points);
    if (line.Points.size() < 2 || length <= ShortShare * this->Size)
    {
      line.Points.clear();
    }
  }
  lines.erase(std::remove_if(lines.begin(), lines.end(),
                [](const SilhouetteLine& line) { return line.Points.empty(); }),
    lines.end());
}

// 1, -1: the lines have the same ends, and run the same way or not; 0: other ends.
int Compare(const SilhouetteLine& a, const SilhouetteLine& b, double reach)
{
  const auto near = [&](const ContourPoint& p, const ContourPoint& q) {
    return (p.Point - q.Point).norm() <= reach;
  };
  const ContourPoint& a0 = a.Points.front();
  const ContourPoint& a1 = a.Points.back();
  const ContourPoint& b0 = b.Points.front();
  const ContourPoint& b1 = b.Points.back();
  const Vec3 start = a.Points[1].Point - a0.Point;
  if (near(a0, b0) && near(a1, b1) && start.dot(b.Points[1].Point - b0.Point) > 0.0)
  {
    return 1;
  }
  return near(a0, b1) && near(a1, b0) &&
      start.dot(b.Points[b.Points.size() - 2].Point - b1.Point) > 0.0
    ? -1
    : 0;
}

// A silhouette that runs along an edge is found on both sides of it. If both say that the front is on
// their own side, it is none.
void SilhouetteMaker::DropRepeated(std::vector<SilhouetteLine>& lines) const
{
  std::map<std::int64_t, std::vector<std::size_t>> byEdge;
  std::vector<char> drop(lines.size(), 0);
  for (std::size_t k = 0; k < lines.size(); ++k)
  {
    if (lines[k].Edge < 0)
    {
      continue;
    }
    const double reach = 2.0 * this->Whole.Data.Edges[lines[k].Edge].Tolerance +
      std::max(JoinShare * this->Size, 2.0 * this->Options.Precision);
    for (const std::size_t other : byEdge[lines[k].Edge])
    {
      const int same = drop[other] ? 0 : Compare(lines[k], lines[other], reach);
      drop[k] = drop[k] || same != 0;
      drop[other] = drop[other] || same < 0;
    }
    byEdge[lines[k].Edge].push_back(k);
  }
  std::size_t kept = 0;
  for (std::size_t k = 0; k < lines.size(); ++k)
  {
    if (!drop[k])
    {
      if (kept != k)
      {
        lines[kept] = std::move(lines[k]);
      }
      ++kept;
    }
  }
  lines.resize(kept);
}

void SilhouetteMaker::Chain(Silhouettes& out) const
{
  const Model& model = this->Whole.Data;
  std::vector<LineEnd> ends[LineKindCount];
  for (std::size_t k = 0; k < out.Lines.size(); ++k)
  {
    const SilhouetteLine& line = out.Lines[k];
    for (int end = 0; end < 2 && !line.Closed; ++end)
    {
      LineEnd entry;
      entry.Line = std::int64_t(k);
      entry.End = end;
      entry.Point = (end == 0 ? line.Points.front() : line.Points.back()).Point;
      entry.Group = this->PartOf(line.Face);
      double tolerance = 0.0;
      if (line.Kind != LineKind::Silhouette)
      {
        tolerance = model.Edges[line.Edge].Tolerance;
      }
      else if (line.Ends[end].Curve >= 0)
      {
        tolerance = model.Edges[model.TrimCurves[line.Ends[end].Curve].Edge].Tolerance;
      }
      entry.Reach = JoinShare * this->Size + 2.0 * tolerance +
        std::min(this->Options.Precision, 1e-4 * this->Size);
      ends[static_cast<int>(line.Kind)].push_back(entry);
    }
  }
  for (int kind = 0; kind < LineKindCount; ++kind)
  {
    JoinEnds(ends[kind], kind != 0, out.Lines);
  }
  NumberChains(out.Lines, out.Chains);
}

Silhouettes SilhouetteMaker::Run()
{
  Silhouettes out;
  this->View = this->Options.View;
  if (!this->View.Perspective)
  {
    this->View.Place /= this->View.Place.cwiseAbs().maxCoeff();
    this->View.Place.normalize();
  }
  out.Faces.resize(this->Whole.Data.Faces.size());
  this->Steps =
    std::max<std::int64_t>(1, std::int64_t(out.Faces.size() + this->Whole.Data.Edges.size()));
  this->TraceFaces(out);
  this->DropShort(out.Lines);
  this->DropRepeated(out.Lines);
  this->TraceEdges(out);
  if (this->Aborted)
  {
    out.Lines.clear();
    out.Aborted = true;
    return out;
  }
  this->Chain(out);
  for (SilhouetteLine& line : out.Lines)
  {
    for (const ContourPoint& point : line.Points)
    {
      out.InexactPoints += line.Kind == LineKind::Silhouette && !line.Crease &&
        !(std::abs(point.Cosine) <= ContourCosine);
    }
    line.Edge = line.Edge < this->Whole.KnownEdges ? line.Edge : -1;
  }
  return out;
}

} // namespace

Silhouettes MakeSilhouettes(
  const Model& model, const std::vector<std::string>& faceErrors, const SilhouetteOptions& options)
{
  const Vec3& place = options.View.Place;
  const char* const name = options.View.Perspective ? "eye" : "direction to the viewer";
  if (!place.allFinite())
  {
    throw Error(std::string("The ") + name + " is not finite");
  }
  if (!options.View.Perspective && place.isZero(0.0))
  {
    throw Error(std::string("The ") + name + " has length zero");
  }
  if (!(options.Precision > 0.0) || !std::isfinite(options.Precision))
  {
    throw Error("The precision must be positive, but is " + std::to_string(options.Precision));
  }
  if (!(options.FeatureAngle > 0.0) || !std::isfinite(options.FeatureAngle))
  {
    throw Error(
      "The feature angle must be positive, but is " + std::to_string(options.FeatureAngle));
  }
  std::vector<std::string> errors = faceErrors;
  for (std::size_t f = 0; f < errors.size(); ++f)
  {
    if (errors[f].empty() && model.Faces[f].Geometry.Size() == 0)
    {
      errors[f] = "it has no control points";
    }
  }
  return SilhouetteMaker(model, errors, options).Run();
}

} // namespace nurbs
