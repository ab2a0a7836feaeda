// SPDX-License-Identifier: BSD-3-Clause
// How a deforming model is made; DeformingModel.cxx has its frames.
#include "DeformingModel.h"

#include "Stopwatch.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

constexpr double SnapDistance = 1e-9; // Of a face's box: corners on its sides.
constexpr int DeepestFixed = 12;      // As often as cells can be halved.
constexpr int MostSpans = (1 << (32 - ColumnBits)) - 1;

ParameterBox UsedBox(const Model& model, const Face& face)
{
  const Box2 box = LoopsBox(model, face);
  return { box.min()[0], box.max()[0], box.min()[1], box.max()[1] };
}

void CheckOptions(const DeformingOptions& options)
{
  const auto check = [](bool good, const std::string& what, double value) {
    if (!good)
    {
      throw Error(what + ", but is " + std::to_string(value));
    }
  };
  check(options.Tolerance > 0.0 && std::isfinite(options.Tolerance),
    "the tolerance must be positive", options.Tolerance);
  check(options.Hysteresis > 0.0 && options.Hysteresis <= 1.0,
    "the hysteresis must be over 0 and at most 1", options.Hysteresis);
  check(options.FixedDepth <= DeepestFixed,
    "the fixed depth must be at most " + std::to_string(DeepestFixed), options.FixedDepth);
  check(
    options.MemoryLimit >= 0, "the memory limit must not be negative", double(options.MemoryLimit));
  check(options.TriangleBudget >= 0, "the triangle budget must not be negative",
    double(options.TriangleBudget));
  check(options.LargestMove > 0.0, "the largest move must be positive", options.LargestMove);
}

} // namespace

DeformingModel::DeformingModel(const Model& model, const std::vector<std::string>& faceErrors,
  const DeformingOptions& options, MeshArrays& mesh)
  : Options(options)
  , Data(CompleteModel(model, faceErrors, options.SideTolerance))
  , Slots(mesh, [this](const TriangleOwner& owner) -> std::int32_t& {
    return this->Faces[owner.Face]->FirstTriangle(owner.Cell);
  })
{
  CheckOptions(options);
  Stopwatch watch;
  const Model& all = this->Data.Data;
  this->Measure(faceErrors);
  this->Faces.resize(all.Faces.size());
  this->FaceError.assign(all.Faces.size(), 0.0);
  this->FaceCapped.assign(all.Faces.size(), 0);
  this->Problems.resize(all.Faces.size());
  this->Edges.resize(all.Edges.size());
  this->EdgesOf.resize(all.Faces.size());
  this->CornerOf.assign(all.TrimCurves.size(), -1);
  this->CornersAt.resize(all.Vertices.size());
  this->UseOf.assign(all.TrimCurves.size(), -1);
  this->FaceTouched.assign(all.Faces.size(), 1);
  this->EdgeChanged.assign(all.Edges.size(), 1);
  this->GapAt.assign(all.Vertices.size() + all.Edges.size(), 0.0);
  this->MakeFaces(std::vector<char>(all.Faces.size(), 1), faceErrors);
  this->Adapt(nullptr, true, options.Hysteresis);
  this->Report.AdaptSeconds = watch.Lap();
  this->Rebuild(nullptr);
  this->KeepBudget(nullptr);
  this->Finish();
  this->Report.RebuildSeconds = watch.Lap();
}

DeformingModel::~DeformingModel() = default;

// The size of the model, and what a control point's share of the memory is.
void DeformingModel::Measure(const std::vector<std::string>& faceErrors)
{
  const Model& model = this->Data.Data;
  Box3 box;
  std::int64_t controls = 0;
  for (std::size_t f = 0; f < model.Faces.size(); ++f)
  {
    const SurfaceView& surface = model.Faces[f].Geometry;
    for (std::int64_t k = 0; k < surface.Size() && faceErrors[f].empty(); ++k, ++controls)
    {
      box.extend(surface.Point(k));
    }
  }
  const double diagonal = box.isEmpty() ? 0.0 : box.diagonal().norm();
  this->Size = diagonal > 0.0 ? diagonal : 1.0;
  this->BytesOfControl = double(this->Options.MemoryLimit) / std::max<double>(1.0, controls);
}

// Makes the faces that are marked, their corners, and all edges that there are not.
void DeformingModel::MakeFaces(
  const std::vector<char>& marked, const std::vector<std::string>& faceErrors)
{
  const Model& model = this->Data.Data;
  for (std::size_t f = 0; f < model.Faces.size(); ++f)
  {
    if (marked[f] && faceErrors[f].empty())
    {
      this->MakeFace(std::int32_t(f));
    }
  }
  this->MakeEdges();
  this->UpdateEdges(nullptr, true); // Lest patches in a loop's belly count as outside.
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    if (marked[f] && this->Faces[f])
    {
      this->Faces[f]->ClassifyPatches();
    }
  }
}

void DeformingModel::MakeFace(std::int32_t f)
{
  const Model& model = this->Data.Data;
  const Face& face = model.Faces[f];
  FaceOptions options;
  options.Tolerance = this->Options.Tolerance;
  options.Refine = this->Refines();
  options.FixedDepth = this->Options.FixedDepth;
  options.KeepCoefficients = this->Options.KeepCoefficients;
  options.MaximumSums = std::int64_t(this->BytesOfControl * double(face.Geometry.Size()));
  const ParameterBox used = UsedBox(model, face);
  std::string& problem = this->Problems[f];
  problem = used.A() > 0.0 && used.B() > 0.0 ? "" : "its loops enclose no area";
  for (int d = 0; d < 2; ++d)
  {
    const int spans = face.Geometry.Count[d] - face.Geometry.Degree[d];
    if (spans > MostSpans)
    {
      problem = std::to_string(spans) + (d == 0 ? " spans in u" : " spans in v") + ", more than " +
        std::to_string(MostSpans);
    }
  }
  if (!problem.empty())
  {
    return;
  }
  this->Faces[f] =
    std::make_unique<DeformingFace>(face.Geometry, face.Reversed, used, f, this->Slots, options);
  for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
  {
    const TrimLoop& loop = model.Loops[l];
    for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
    {
      this->MakeCorner(f, c);
    }
  }
}

// One vertex a face and corner of its loops, where the next trim curve begins.
void DeformingModel::MakeCorner(std::int32_t f, std::int64_t c)
{
  const Model& model = this->Data.Data;
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
  this->CornersAt[vertex].push_back({ f, this->CornerOf[c] });
}

// All edges that faces use and that there are not.
void DeformingModel::MakeEdges()
{
  const Model& model = this->Data.Data;
  std::vector<std::vector<DeformingUse>> uses(model.Edges.size());
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    this->EdgesOf[f].clear();
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
  for (std::size_t e = 0; e < uses.size(); ++e)
  {
    if (!this->Edges[e] && !uses[e].empty())
    {
      this->Edges[e] =
        std::make_unique<DeformingEdge>(model, std::int64_t(e), std::move(uses[e]), this->Faces);
      this->EdgeChanged[e] = 1;
    }
  }
}

// True if both have the same faces, loops and curves between the same edges and vertices.
static bool HaveOneTopology(const Model& a, const Model& b)
{
  bool same = a.Faces.size() == b.Faces.size() && a.Loops.size() == b.Loops.size() &&
    a.TrimCurves.size() == b.TrimCurves.size() && a.Edges.size() == b.Edges.size() &&
    a.Vertices.size() == b.Vertices.size();
  for (std::size_t f = 0; same && f < a.Faces.size(); ++f)
  {
    same =
      a.Faces[f].FirstLoop == b.Faces[f].FirstLoop && a.Faces[f].LoopCount == b.Faces[f].LoopCount;
  }
  for (std::size_t l = 0; same && l < a.Loops.size(); ++l)
  {
    same = a.Loops[l].FirstCurve == b.Loops[l].FirstCurve &&
      a.Loops[l].CurveCount == b.Loops[l].CurveCount;
  }
  for (std::size_t c = 0; same && c < a.TrimCurves.size(); ++c)
  {
    same = a.TrimCurves[c].Edge == b.TrimCurves[c].Edge &&
      a.TrimCurves[c].Reversed == b.TrimCurves[c].Reversed;
  }
  for (std::size_t e = 0; same && e < a.Edges.size(); ++e)
  {
    same = a.Edges[e].Vertex[0] == b.Edges[e].Vertex[0] &&
      a.Edges[e].Vertex[1] == b.Edges[e].Vertex[1] &&
      IsDegenerate(a.Edges[e]) == IsDegenerate(b.Edges[e]);
  }
  return same;
}

// Removes the faces that are marked, and all edges that they have or will have.
void DeformingModel::RemoveFaces(const std::vector<char>& marked)
{
  const Model& model = this->Data.Data;
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    const Face& face = model.Faces[f];
    for (std::int64_t l = face.FirstLoop; marked[f] && l < face.FirstLoop + face.LoopCount; ++l)
    {
      const TrimLoop& loop = model.Loops[l];
      for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
      {
        std::unique_ptr<DeformingEdge>& edge = this->Edges[model.TrimCurves[c].Edge];
        if (edge)
        {
          edge->RemoveVertices(this->Faces);
          edge.reset();
        }
      }
    }
  }
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    if (marked[f] && this->Faces[f])
    {
      this->Faces[f]->Clear();
      this->Faces[f].reset();
    }
  }
  for (std::vector<Corner>& corners : this->CornersAt)
  {
    corners.erase(std::remove_if(corners.begin(), corners.end(),
                    [&](const Corner& corner) { return marked[corner.Face] != 0; }),
      corners.end());
  }
}

bool DeformingModel::Replace(
  const Model& model, const std::vector<std::string>& faceErrors, const std::vector<char>& changed)
{
  CompletedModel next = CompleteModel(model, faceErrors, this->Options.SideTolerance);
  bool fits = HaveOneTopology(this->Data.Data, next.Data);
  for (std::size_t f = 0; fits && f < this->Faces.size(); ++f)
  {
    const bool given = this->Faces[f] != nullptr || !this->Problems[f].empty();
    fits = changed[f] || faceErrors[f].empty() == given;
  }
  if (!fits)
  {
    return false;
  }
  Stopwatch watch;
  this->Report = FrameReport();
  this->Slots.ClearChanges();
  this->Shared.clear();
  this->RemoveFaces(changed);
  this->Data = std::move(next);
  this->Making = true;
  // What is known of all faces together is found anew.
  std::fill(this->FaceTouched.begin(), this->FaceTouched.end(), 1);
  std::fill(this->GapAt.begin(), this->GapAt.end(), 0.0);
  std::fill(this->FaceError.begin(), this->FaceError.end(), 0.0);
  std::fill(this->FaceCapped.begin(), this->FaceCapped.end(), 0);
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    if (this->Faces[f]) // What it refers to may go with the former model.
    {
      this->Faces[f]->SetSurface(this->Data.Data.Faces[f].Geometry);
    }
  }
  this->MakeFaces(changed, faceErrors);
  this->Adapt(nullptr, true, this->Options.Hysteresis);
  this->Rebuild(nullptr);
  this->KeepBudget(nullptr);
  this->Finish();
  this->Report.RebuildSeconds = watch.Lap();
  return true;
}

} // namespace nurbs
