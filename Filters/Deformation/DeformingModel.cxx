// SPDX-License-Identifier: BSD-3-Clause
#include "DeformingModel.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace nurbs
{

namespace
{

constexpr int MaximumRounds = 12;     // Of refinement of one frame.
constexpr int CrossingRounds = 6;     // Of these, for loops that cross.
constexpr int BudgetRounds = 60;      // Of coarsening.
constexpr double CoarsenStep = 1.25;  // Of the tolerance in a round.
constexpr double RelaxShare = 0.85;   // Of the budget: below, the tolerance falls again.
constexpr double SnapDistance = 1e-9; // Of a face's box: corners on its sides.
constexpr double OnePlace = 1e-12;    // Of the size: control points in one place.

class Stopwatch
{
public:
  double Lap()
  {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - this->Last).count();
    this->Last = now;
    return seconds;
  }

private:
  std::chrono::steady_clock::time_point Last = std::chrono::steady_clock::now();
};

ParameterBox UsedBox(const Model& model, const Face& face)
{
  const Box2 box = LoopsBox(model, face);
  return { box.min()[0], box.max()[0], box.min()[1], box.max()[1] };
}

Vec3 ControlCenter(const SurfaceView& surface)
{
  return 0.5 * (surface.Point(0) + surface.Point(surface.Size() - 1));
}

} // namespace

double Viewer::Importance(const Vec3& place) const
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

DeformingModel::DeformingModel(const Model& model, const std::vector<std::string>& faceErrors,
  const DeformingOptions& options, MeshArrays& mesh)
  : Options(options)
  , Data(CompleteModel(model, faceErrors, options.SideTolerance))
  , Slots(mesh, [this](const TriangleOwner& owner) -> std::int32_t& {
    return this->Faces[owner.Face]->FirstTriangle(owner.Cell);
  })
{
  if (!(options.Tolerance > 0.0) || !std::isfinite(options.Tolerance))
  {
    throw Error("the tolerance must be positive, but is " + std::to_string(options.Tolerance));
  }
  if (!(options.Hysteresis > 0.0) || !(options.Hysteresis <= 1.0))
  {
    throw Error(
      "the hysteresis must be over 0 and at most 1, but is " + std::to_string(options.Hysteresis));
  }
  Stopwatch watch;
  this->MakeFaces(faceErrors);
  this->MakeCorners();
  this->MakeEdges();
  this->FaceTouched.assign(this->Faces.size(), 1);
  this->EdgeChanged.assign(this->Edges.size(), 1);
  this->GapAt.assign(this->CornersAt.size() + this->Edges.size(), 0.0);
  this->UpdateEdges(nullptr, false);
  for (const std::unique_ptr<DeformingFace>& face : this->Faces)
  {
    if (face)
    {
      face->ClassifyPatches();
    }
  }
  this->Adapt(nullptr, true, options.Hysteresis);
  this->Report.AdaptSeconds = watch.Lap();
  this->Rebuild(nullptr);
  this->KeepBudget(nullptr);
  this->Finish();
  this->Report.RebuildSeconds = watch.Lap();
}

DeformingModel::~DeformingModel() = default;

void DeformingModel::MakeFaces(const std::vector<std::string>& faceErrors)
{
  const Model& model = this->Data.Data;
  FaceOptions options;
  options.Tolerance = this->Options.Tolerance;
  options.Refine = this->Options.Refine && this->Options.FixedDepth < 0;
  options.FixedDepth = this->Options.FixedDepth;
  options.KeepCoefficients = this->Options.KeepCoefficients;
  Box3 box;
  std::int64_t controls = 0;
  for (std::size_t f = 0; f < model.Faces.size(); ++f)
  {
    controls += faceErrors[f].empty() ? model.Faces[f].Geometry.Size() : 0;
  }
  for (std::size_t f = 0; f < model.Faces.size(); ++f)
  {
    this->Faces.emplace_back();
    if (!faceErrors[f].empty())
    {
      continue;
    }
    const Face& face = model.Faces[f];
    for (std::int64_t k = 0; k < face.Geometry.Size(); ++k)
    {
      box.extend(face.Geometry.Point(k));
    }
    options.MaximumSums = std::int64_t(
      double(this->Options.MemoryLimit) * (double(face.Geometry.Size()) / double(controls)));
    const ParameterBox used = UsedBox(model, face);
    if (used.A() > 0.0 && used.B() > 0.0)
    {
      this->Faces.back() = std::make_unique<DeformingFace>(
        face.Geometry, face.Reversed, used, std::int32_t(f), this->Slots, options);
    }
  }
  this->Size = box.isEmpty() ? 1.0 : box.diagonal().norm();
}

// One vertex a face and corner of its loops, where the next trim curve begins.
void DeformingModel::MakeCorners()
{
  const Model& model = this->Data.Data;
  this->CornerOf.assign(model.TrimCurves.size(), -1);
  this->CornersAt.resize(model.Vertices.size());
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    const Face& face = model.Faces[f];
    for (std::int64_t l = face.FirstLoop; this->Faces[f] && l < face.FirstLoop + face.LoopCount;
         ++l)
    {
      const TrimLoop& loop = model.Loops[l];
      for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
      {
        const TrimCurve& curve = model.TrimCurves[c];
        const Interval domain = curve.Geometry.Domain();
        Vec2 uv = Evaluate(curve.Geometry, curve.Reversed ? domain.Max : domain.Min);
        const ParameterBox& box = this->Faces[f]->Used();
        const double low[2] = { box.U0, box.V0 };
        const double high[2] = { box.U1, box.V1 };
        for (int d = 0; d < 2; ++d)
        {
          const double near = SnapDistance * (high[d] - low[d]);
          uv[d] = uv[d] <= low[d] + near ? low[d] : uv[d] >= high[d] - near ? high[d] : uv[d];
        }
        const std::int64_t vertex = model.Edges[curve.Edge].Vertex[curve.Reversed ? 1 : 0];
        this->CornerOf[c] = this->Faces[f]->AddLoopVertex(uv, vertex);
        this->CornersAt[vertex].push_back({ std::int32_t(f), this->CornerOf[c] });
      }
    }
  }
}

void DeformingModel::MakeEdges()
{
  const Model& model = this->Data.Data;
  std::vector<std::vector<DeformingUse>> uses(model.Edges.size());
  this->UseOf.assign(model.TrimCurves.size(), -1);
  this->EdgesOf.resize(this->Faces.size());
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    const Face& face = model.Faces[f];
    for (std::int64_t l = face.FirstLoop; this->Faces[f] && l < face.FirstLoop + face.LoopCount;
         ++l)
    {
      const TrimLoop& loop = model.Loops[l];
      for (std::int64_t k = 0; k < loop.CurveCount; ++k)
      {
        const std::int64_t c = loop.FirstCurve + k;
        const std::int64_t next = loop.FirstCurve + (k + 1) % loop.CurveCount;
        const TrimCurve& curve = model.TrimCurves[c];
        DeformingUse use;
        use.Face = std::int32_t(f);
        use.Curve = c;
        use.Ends[curve.Reversed ? 1 : 0] = this->CornerOf[c];
        use.Ends[curve.Reversed ? 0 : 1] = this->CornerOf[next];
        this->UseOf[c] = int(uses[curve.Edge].size());
        uses[curve.Edge].push_back(use);
        std::vector<std::int32_t>& edges = this->EdgesOf[f];
        if (std::find(edges.begin(), edges.end(), curve.Edge) == edges.end())
        {
          edges.push_back(std::int32_t(curve.Edge));
        }
      }
    }
  }
  this->Edges.resize(model.Edges.size());
  for (std::size_t e = 0; e < uses.size(); ++e)
  {
    if (!uses[e].empty())
    {
      this->Edges[e] =
        std::make_unique<DeformingEdge>(model, std::int64_t(e), std::move(uses[e]), this->Faces);
    }
  }
}

double DeformingModel::Scale(const Viewer* viewer, const Vec3& place) const
{
  return this->Coarsening / (viewer ? viewer->Importance(place) : 1.0);
}

void DeformingModel::Adapt(const Viewer* viewer, bool everything, double hysteresis)
{
  this->Options.Parallel(
    0, std::int64_t(this->Faces.size()), [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t f = begin; f < end; ++f)
      {
        if (this->Faces[f] && (everything || this->FaceTouched[f]))
        {
          this->Faces[f]->Adapt(
            [&](const Vec3& place) { return this->Scale(viewer, place); }, everything, hysteresis);
        }
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

// Pieces and vertices of the edges of faces that changed. Returns whether a face has new loops.
bool DeformingModel::UpdateEdges(const Viewer* viewer, bool adapt)
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
  bool any = false;
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    if (loops[f] != 0)
    {
      this->FaceTouched[f] = 1;
      this->MakeLoops(std::int32_t(f), (loops[f] & 2) != 0);
      any = true;
    }
  }
  return any;
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
    if (this->Edges[piece.first]->Force(this->Data.Data, piece.second))
    {
      this->EdgeChanged[piece.first] = 1;
      any = true;
    }
  }
  return any;
}

// Edges, cells and triangles, until the zones are within the tolerance, too.
void DeformingModel::Rebuild(const Viewer* viewer)
{
  const bool refine = this->Options.Refine && this->Options.FixedDepth < 0;
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
      if (round < CrossingRounds && face->HasCrossingLoops())
      {
        face->RequestLoops(own);
      }
      for (std::size_t k = 0; k < own.Cells.size() && !last; ++k)
      {
        face->Force(own.Cells[k]);
      }
      again = again || face->HasNewCells();
      requests.Pieces.insert(requests.Pieces.end(), own.Pieces.begin(), own.Pieces.end());
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
    this->Slots.Point(owner.GetLoopVertex(vertex).Point) = to;
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
    if (!this->Faces[f])
    {
      continue;
    }
    const std::string problem = this->Faces[f]->Check(
      model.Faces[f].Geometry, this->Options.LargestMove * this->Size, OnePlace * this->Size);
    if (!problem.empty())
    {
      return "face " + std::to_string(model.Faces[f].FaceId) + ": " + problem;
    }
  }
  return "";
}

FrameReport DeformingModel::Update(const Model& model, const Viewer* viewer)
{
  const FrameReport last = this->Report;
  this->Report = FrameReport();
  Stopwatch watch;
  std::vector<std::int64_t> moved(this->Faces.size(), 0);
  this->Report.Problem = this->Check(model);
  if (!this->Report.Problem.empty())
  {
    const std::string problem = this->Report.Problem;
    this->Report = last;
    this->Report.Accepted = false;
    this->Report.Problem = problem;
    return this->Report;
  }
  const auto forFaces = [&](const std::function<void(std::int64_t)>& f) {
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
  };
  forFaces([&](std::int64_t f) { moved[f] = this->Faces[f]->Compare(model.Faces[f].Geometry); });
  this->Report.CompareSeconds = watch.Lap();
  this->Slots.ClearChanges();
  std::vector<std::int64_t> updated(this->Faces.size(), 0);
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    this->FaceTouched[f] = moved[f] > 0;
    this->Data.Data.Faces[f].Geometry = model.Faces[f].Geometry;
    this->Report.MovedControlPoints += moved[f];
  }
  forFaces([&](std::int64_t f) { updated[f] = this->Faces[f]->Move(model.Faces[f].Geometry); });
  for (const std::int64_t count : updated)
  {
    this->Report.UpdatedVertices += count;
  }
  this->Share(false);
  this->Report.MoveSeconds = watch.Lap();
  if (this->Options.Refine && this->Options.FixedDepth < 0)
  {
    const bool everything = viewer != nullptr || this->HadViewer || this->Coarsening > 1.0;
    this->HadViewer = viewer != nullptr;
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
void DeformingModel::KeepBudget(const Viewer* viewer)
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
  for (int round = 0; round<BudgetRounds&& this->Slots.Triangles()> budget; ++round)
  {
    do
    {
      this->Coarsening *= CoarsenStep;
      this->Adapt(viewer, true, 1.0);
    } while (this->EstimateTriangles() > budget && ++round < BudgetRounds);
    std::fill(this->FaceTouched.begin(), this->FaceTouched.end(), 1);
    this->Rebuild(viewer);
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
  for (const std::unique_ptr<DeformingFace>& face : this->Faces)
  {
    if (face)
    {
      this->Report.ErrorBound = std::max(this->Report.ErrorBound, face->ErrorBound());
      this->Report.CappedCells += face->CappedCells();
    }
  }
  for (const std::unique_ptr<DeformingEdge>& edge : this->Edges)
  {
    this->Report.ErrorBound = std::max(this->Report.ErrorBound, edge ? edge->Error() : 0.0);
  }
  this->Report.ErrorBound += this->Report.ModelGap;
  this->MarkChanges();
}

void DeformingModel::MarkChanges()
{
  const MeshSlots::Changes& changes = this->Slots.GetChanges();
  const std::size_t count = std::size_t(this->Slots.Arrays().PointCount);
  this->Changed.assign(count, changes.Renumbered ? 1 : 0);
  for (const std::int32_t point : changes.Added)
  {
    if (std::size_t(point) < count)
    {
      this->Changed[point] = 1;
    }
  }
  for (const std::unique_ptr<DeformingFace>& face : this->Faces)
  {
    if (face && face->HasMoved())
    {
      face->ForMoved([&](std::int32_t point) { this->Changed[point] = 1; });
    }
  }
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
