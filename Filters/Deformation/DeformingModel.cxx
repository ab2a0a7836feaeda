// SPDX-License-Identifier: BSD-3-Clause
#include "DeformingModel.h"

#include "Stopwatch.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace nurbs
{

namespace
{

constexpr int MaximumRounds = 12;    // Of refinement of one frame.
constexpr int CrossingRounds = 5;    // Of these, of the first frame, for loops that cross.
constexpr double CoarsenStep = 1.25; // Of the tolerance in a round.
constexpr double RelaxShare = 0.85;  // Of the budget: below, the tolerance falls again.
constexpr double OnePlace = 1e-12;   // Of the size: control points in one place.

Vec3 ControlCenter(const SurfaceView& surface)
{
  return 0.5 * (surface.Point(0) + surface.Point(surface.Size() - 1));
}

} // namespace

double MeshViewer::Importance(const Vec3& place) const
{
  const Vec3 way = place - this->Eye;
  const double distance = way.norm();
  const double ahead = this->Direction.dot(way);
  const double beside = (way - ahead * this->Direction).norm();
  const double angle = this->Parallel ? 0.0 : std::atan2(beside, ahead);
  const double near = this->Parallel ? 1.0 : std::min(1.0, this->FullDetail / distance);
  const double sight = angle <= this->SightAngle ? 1.0 : this->SightAngle / angle;
  return std::max(this->LeastImportance, near * sight);
}

double DeformingModel::Scale(const MeshViewer* viewer, const Vec3& place) const
{
  return this->Coarsening / (viewer ? viewer->Importance(place) : 1.0);
}

void DeformingModel::Adapt(const MeshViewer* viewer, bool everything, double hysteresis)
{
  this->ForFaces([&](std::int64_t f) {
    if (everything || this->FaceTouched[f])
    {
      this->Faces[f]->Adapt(
        [&](const Vec3& place) { return this->Scale(viewer, place); }, everything, hysteresis);
    }
  });
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    if (this->Faces[f] && this->Faces[f]->HasNewCells())
    {
      this->FaceTouched[f] = 1;
    }
  }
}

// Pieces and vertices of the edges of faces that changed.
void DeformingModel::UpdateEdges(const MeshViewer* viewer, bool adapt)
{
  const Model& model = this->Data.Data;
  std::vector<char> concerned(this->Edges.size(), 0);
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    for (const std::int32_t e : this->EdgesOf[f])
    {
      concerned[e] = concerned[e] || (this->Faces[f] && this->FaceTouched[f]);
    }
  }
  std::vector<char> loops(this->Faces.size(), 0); // 1: along sides; 2: inside.
  for (std::size_t e = 0; e < this->Edges.size(); ++e)
  {
    DeformingEdge* edge = this->Edges[e].get();
    if (!edge || !(concerned[e] || this->EdgeChanged[e]))
    {
      continue;
    }
    if (adapt && edge->HasInner())
    {
      const SurfaceView& surface = model.Faces[edge->Uses()[0].Face].Geometry;
      const double scale = viewer ? this->Scale(viewer, ControlCenter(surface)) : this->Coarsening;
      edge->Adapt(model, this->Faces, scale * this->Options.Tolerance, this->Options.Hysteresis);
    }
    const bool asked = this->EdgeChanged[e] || edge->HasNewPieces() ||
      std::any_of(edge->Uses().begin(), edge->Uses().end(), [&](const DeformingUse& use) {
        return use.Side >= 0 && this->Faces[use.Face]->HasNewOnSide(use.Side);
      });
    if (asked && edge->Update(model, this->Faces))
    {
      for (const DeformingUse& use : edge->Uses())
      {
        loops[use.Face] |= edge->HasInner() ? 2 : 1;
      }
    }
    this->EdgeChanged[e] = 0;
  }
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    if (loops[f] != 0)
    {
      this->FaceTouched[f] = 1;
      this->MakeLoops(std::int32_t(f), (loops[f] & 2) != 0);
    }
  }
}

// The loops of a face, from its edges' vertices.
void DeformingModel::MakeLoops(std::int32_t f, bool inside)
{
  const Model& model = this->Data.Data;
  const Face& face = model.Faces[f];
  std::vector<std::vector<LoopSegment>> loops;
  for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
  {
    const TrimLoop& loop = model.Loops[l];
    loops.emplace_back();
    for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
    {
      const TrimCurve& curve = model.TrimCurves[c];
      const DeformingEdge& edge = *this->Edges[curve.Edge];
      const DeformingUse& use = edge.Uses()[this->UseOf[c]];
      const int count = int(use.Vertices.size()) - 1;
      for (int k = 0; k < count; ++k)
      {
        const int at = curve.Reversed ? count - 1 - k : k;
        LoopSegment segment;
        segment.A = use.Vertices[curve.Reversed ? at + 1 : at];
        segment.B = use.Vertices[curve.Reversed ? at : at + 1];
        segment.Edge = std::int32_t(curve.Edge);
        segment.Piece = edge.PieceAt(at);
        segment.Side = use.Side;
        loops.back().push_back(segment);
      }
    }
  }
  this->Faces[f]->SetLoops(std::move(loops), inside);
}

bool DeformingModel::Honour(const RefinementRequests& requests)
{
  bool any = false;
  for (const std::pair<std::int32_t, std::int32_t>& piece : requests.Pieces)
  {
    if (this->Edges[piece.first]->Force(this->Data.Data, this->Faces, piece.second))
    {
      this->EdgeChanged[piece.first] = 1;
      any = true;
    }
  }
  for (const std::pair<std::int32_t, std::int32_t>& piece : requests.Crossing)
  {
    if (this->Edges[piece.first]->Straighten(this->Data.Data, piece.second))
    {
      this->EdgeChanged[piece.first] = 1;
      any = true;
    }
  }
  return any;
}

// Edges, cells and triangles, until the zones are within the tolerance, too.
void DeformingModel::Rebuild(const MeshViewer* viewer)
{
  const bool refine = this->Refines() || this->Making;
  for (int round = 0; round < MaximumRounds; ++round)
  {
    this->UpdateEdges(viewer, refine && round == 0);
    for (const std::unique_ptr<DeformingFace>& face : this->Faces)
    {
      if (face)
      {
        face->EvaluateLoopVertices();
      }
    }
    this->Share(false);
    const bool last = round + 1 == MaximumRounds || this->Options.FixedDepth >= 0;
    RefinementRequests requests;
    bool again = false;
    for (std::size_t f = 0; f < this->Faces.size(); ++f)
    {
      DeformingFace* face = this->Faces[f].get();
      const bool wanted = face &&
        ((round == 0 && this->FaceTouched[f]) || face->HasNewCells() || face->HasNewLoops());
      if (!wanted)
      {
        continue;
      }
      RefinementRequests own;
      face->Rebuild(own);
      if (this->Making && round < CrossingRounds && face->HasCrossingLoops())
      {
        face->RequestLoops(own);
      }
      for (std::size_t k = 0; k < own.Cells.size() && !last; ++k)
      {
        face->Force(own.Cells[k]);
      }
      face->AdaptLate(last);
      again = again || face->HasNewCells();
      requests.Pieces.insert(requests.Pieces.end(), own.Pieces.begin(), own.Pieces.end());
      requests.Crossing.insert(requests.Crossing.end(), own.Crossing.begin(), own.Crossing.end());
    }
    if (last || !(this->Honour(requests) || again))
    {
      break;
    }
  }
}

bool DeformingModel::IsTouched(const DeformingEdge& edge) const
{
  return std::any_of(edge.Uses().begin(), edge.Uses().end(),
    [&](const DeformingUse& use) { return this->FaceTouched[use.Face] != 0; });
}

// What all faces at a vertex or an edge have in common is where the first of them has it.
void DeformingModel::Share(bool measure)
{
  const auto move = [&](std::int32_t face, std::int32_t vertex, const Vec3& to, double& gap) {
    const DeformingFace& owner = *this->Faces[face];
    const std::int32_t point = owner.GetLoopVertex(vertex).Point;
    if (this->Slots.Point(point) != to)
    {
      this->Slots.Point(point) = to;
      this->Shared.push_back(point);
    }
    if (measure)
    {
      gap = std::max(gap, (owner.PlaceOf(vertex) - to).norm());
    }
  };
  const auto place = [&](std::int32_t face, std::int32_t vertex) -> Vec3 {
    return this->Slots.Point(this->Faces[face]->GetLoopVertex(vertex).Point);
  };
  for (std::size_t v = 0; v < this->CornersAt.size(); ++v)
  {
    const std::vector<Corner>& corners = this->CornersAt[v];
    const bool touched = std::any_of(corners.begin(), corners.end(),
      [&](const Corner& corner) { return this->FaceTouched[corner.Face] != 0; });
    if (!touched)
    {
      continue;
    }
    this->GapAt[v] = 0.0;
    for (std::size_t k = 1; k < corners.size(); ++k)
    {
      move(corners[k].Face, corners[k].Vertex, place(corners[0].Face, corners[0].Vertex),
        this->GapAt[v]);
    }
  }
  for (std::size_t e = 0; e < this->Edges.size(); ++e)
  {
    const DeformingEdge* edge = this->Edges[e].get();
    if (!edge || !this->IsTouched(*edge))
    {
      continue;
    }
    double& gap = this->GapAt[this->CornersAt.size() + e];
    gap = 0.0;
    const std::vector<DeformingUse>& uses = edge->Uses();
    for (std::size_t u = edge->IsPole() ? 0 : 1; u < uses.size(); ++u)
    {
      for (std::size_t k = 1; k + 1 < edge->Vertices(); ++k)
      {
        const std::int32_t from = uses[0].Vertices[edge->IsPole() ? 0 : k];
        move(uses[u].Face, uses[u].Vertices[k], place(uses[0].Face, from), gap);
      }
    }
  }
}

std::string DeformingModel::Check(const Model& model) const
{
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    if (this->Faces[f])
    {
      const std::string problem = this->Faces[f]->Check(
        model.Faces[f].Geometry, this->Options.LargestMove * this->Size, OnePlace * this->Size);
      if (!problem.empty())
      {
        return "face " + std::to_string(model.Faces[f].FaceId) + ": " + problem;
      }
    }
  }
  return "";
}

// True if a side that was a point when the edge was made is none any more.
bool DeformingModel::HasOpenPole(const Model& model) const
{
  return std::any_of(
    this->Edges.begin(), this->Edges.end(), [&](const std::unique_ptr<DeformingEdge>& edge) {
      return edge && edge->IsPole() && edge->HasOpened(model);
    });
}

void DeformingModel::ForFaces(const std::function<void(std::int64_t)>& f)
{
  this->Options.Parallel(
    0, std::int64_t(this->Faces.size()), [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t k = begin; k < end; ++k)
      {
        if (this->Faces[k])
        {
          f(k);
        }
      }
    });
}

FrameReport DeformingModel::Update(const Model& model, const MeshViewer* viewer)
{
  Stopwatch watch;
  std::vector<std::int64_t> moved(this->Faces.size(), 0);
  this->ForFaces(
    [&](std::int64_t f) { moved[f] = this->Faces[f]->Compare(model.Faces[f].Geometry); });
  const std::string problem = this->Check(model);
  const bool open = problem.empty() && this->HasOpenPole(model);
  if (open || !problem.empty())
  {
    FrameReport refused;
    refused.Accepted = false;
    refused.ErrorBound = this->Report.ErrorBound;
    refused.ModelGap = this->Report.ModelGap;
    refused.ToleranceUsed = this->Report.ToleranceUsed;
    refused.CappedCells = this->Report.CappedCells;
    refused.CrossingFaces = this->Report.CrossingFaces;
    refused.Problem = problem;
    refused.NeedsReplacement = open;
    return refused;
  }
  this->Report = FrameReport();
  this->Report.CompareSeconds = watch.Lap();
  this->Slots.ClearChanges();
  this->Shared.clear();
  std::vector<std::int64_t> updated(this->Faces.size(), 0);
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    this->FaceTouched[f] = moved[f] > 0;
    this->Data.Data.Faces[f].Geometry = model.Faces[f].Geometry;
    this->Report.MovedControlPoints += moved[f];
  }
  this->ForFaces(
    [&](std::int64_t f) { updated[f] = this->Faces[f]->Move(model.Faces[f].Geometry); });
  this->Report.UpdatedVertices = std::accumulate(updated.begin(), updated.end(), std::int64_t(0));
  this->Share(false);
  this->Report.MoveSeconds = watch.Lap();
  if (this->Refines())
  {
    const bool everything = viewer != nullptr || this->HadViewer || this->Coarsening > 1.0;
    this->HadViewer = viewer != nullptr;
    if (everything)
    {
      std::fill(this->FaceTouched.begin(), this->FaceTouched.end(), 1);
    }
    this->Adapt(viewer, everything, this->Options.Hysteresis);
    this->Report.AdaptSeconds = watch.Lap();
    this->Rebuild(viewer);
    this->KeepBudget(viewer);
  }
  this->Finish();
  this->Report.RebuildSeconds = watch.Lap();
  return this->Report;
}

std::int64_t DeformingModel::EstimateTriangles() const
{
  std::int64_t count = 0;
  for (const std::unique_ptr<DeformingFace>& face : this->Faces)
  {
    count += face ? face->EstimateTriangles() : 0;
  }
  return count;
}

// Coarsens all patches alike, as far as their importance lets them, until the budget is kept; lets the
// tolerance fall again while there is room.
void DeformingModel::KeepBudget(const MeshViewer* viewer)
{
  if (this->Options.TriangleBudget <= 0)
  {
    return;
  }
  const std::int64_t budget = this->Options.TriangleBudget;
  if (this->Coarsening > 1.0 && double(this->Slots.Triangles()) < RelaxShare * double(budget))
  {
    this->Coarsening = std::max(1.0, this->Coarsening / CoarsenStep);
    this->Adapt(viewer, true, this->Options.Hysteresis);
    this->Rebuild(viewer);
  }
  // Beyond, all cells are merged that can be: the budget is too small.
  const double coarsest = this->Size / this->Options.Tolerance;
  while (this->Slots.Triangles() > budget && this->Coarsening < coarsest)
  {
    do
    {
      this->Coarsening *= CoarsenStep;
      this->Adapt(viewer, true, 1.0);
    } while (this->EstimateTriangles() > budget && this->Coarsening < coarsest);
    std::fill(this->FaceTouched.begin(), this->FaceTouched.end(), 1);
    this->Rebuild(viewer);
  }
}

// The largest errors of all faces, those that nothing happened to as they were.
void DeformingModel::SumErrors()
{
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    if (this->Faces[f] && this->FaceTouched[f] && (this->Refines() || this->Making))
    {
      this->FaceError[f] = this->Faces[f]->ErrorBound();
      this->FaceCapped[f] = this->Faces[f]->CappedCells();
    }
    this->Report.ErrorBound = std::max(this->Report.ErrorBound, this->FaceError[f]);
    this->Report.CappedCells += this->FaceCapped[f];
    this->Report.CrossingFaces += this->Faces[f] && this->Faces[f]->HasCrossingLoops();
  }
  for (const std::unique_ptr<DeformingEdge>& edge : this->Edges)
  {
    this->Report.ErrorBound = std::max(this->Report.ErrorBound, edge ? edge->Error() : 0.0);
  }
}

void DeformingModel::Finish()
{
  this->Slots.FillGaps();
  if (this->Slots.IsSparse())
  {
    const std::vector<std::int32_t> places = this->Slots.Compact();
    for (const std::unique_ptr<DeformingFace>& face : this->Faces)
    {
      if (face)
      {
        face->Renumber(places);
      }
    }
  }
  this->Share(true);
  this->Slots.HideGaps();
  const MeshSlots::Changes& changes = this->Slots.GetChanges();
  this->Report.TopologyChanged = changes.Topology;
  this->Report.FirstTriangle = changes.FirstTriangle;
  this->Report.LastTriangle = changes.LastTriangle;
  this->Report.InsertedVertices = changes.Inserted;
  this->Report.DeletedVertices = changes.Deleted;
  this->Report.ModelGap =
    this->GapAt.empty() ? 0.0 : *std::max_element(this->GapAt.begin(), this->GapAt.end());
  this->Report.ToleranceUsed = this->Coarsening * this->Options.Tolerance;
  this->SumErrors();
  this->Making = false;
  this->Report.ErrorBound += this->Report.ModelGap;
}

std::vector<unsigned char> DeformingModel::ChangedPoints() const
{
  const MeshSlots::Changes& changes = this->Slots.GetChanges();
  const std::size_t count = std::size_t(this->Slots.Arrays().PointCount);
  std::vector<unsigned char> changed(count, changes.Renumbered ? 1 : 0);
  for (const std::vector<std::int32_t>* points : { &changes.Added, &this->Shared })
  {
    for (const std::int32_t point : *points)
    {
      if (std::size_t(point) < count)
      {
        changed[point] = 1;
      }
    }
  }
  for (const std::unique_ptr<DeformingFace>& face : this->Faces)
  {
    if (face && face->HasMoved())
    {
      face->ForMoved([&](std::int32_t point) { changed[point] = 1; });
    }
  }
  return changed;
}

std::int64_t DeformingModel::BytesOfSums() const
{
  std::int64_t bytes = 0;
  for (const std::unique_ptr<DeformingFace>& face : this->Faces)
  {
    bytes += face ? face->BytesOfSums() : 0;
  }
  return bytes;
}

} // namespace nurbs
