// SPDX-License-Identifier: BSD-3-Clause
#include "Tessellator.h"

#include "CompletedModel.h"
#include "EdgeDiscretizer.h"
#include "FaceTessellator.h"
#include "PieceExchange.h"
#include "SurfaceTree.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>

namespace nurbs
{

namespace
{
constexpr int MaximumPasses = 8;
constexpr double ShortEdge = 0.01; // In tolerances.

class ModelTessellator
{
public:
  ModelTessellator(const Model& model, const std::vector<std::string>& faceErrors,
    const TessellatorOptions& options)
    : Errors(faceErrors)
    , Options(options)
    , Completed(CompleteModel(model, faceErrors))
    , Data(Completed.Data)
  {}

  TessellationResult Run()
  {
    const std::size_t faces = this->Data.Faces.size();
    this->Result.Meshes.resize(faces);
    this->Bounds.resize(faces);
    this->Trees.resize(faces);
    this->Contexts.resize(faces);
    this->States.resize(faces);
    this->Snaps.assign(faces, Vec2(0.0, 0.0));
    this->FindUses();
    this->Exchange =
      std::make_unique<PieceExchange>(this->Options.Pieces, this->Completed, this->Uses);
    this->CollapseEdges();
    this->OrderFaces();

    // Step 1: bounds and a tree for every surface.
    this->ForFaces(this->AllFaces(), 0.0, 0.5,
      [&](std::int64_t f, const ParallelFor& parallel) { this->PrepareFace(f, parallel); });

    std::vector<std::int64_t> edges(this->Data.Edges.size());
    for (std::size_t e = 0; e < edges.size(); ++e)
    {
      edges[e] = std::int64_t(e);
    }
    std::vector<std::int64_t> todo;
    for (const std::int64_t f : this->AllFaces())
    {
      if (!this->Exchange->IsGhost(f))
      {
        todo.push_back(f);
      }
    }
    this->Polylines.resize(this->Data.Edges.size());
    this->Extra.resize(this->Data.Edges.size());
    bool unfinished = true;
    for (int pass = 0; pass < MaximumPasses && unfinished; ++pass)
    {
      // Step 2: one polyline an edge. Step 3: every face between them.
      this->DiscretizeEdges(edges);
      unfinished = this->TriangulateFaces(todo, pass, edges);
    }
    this->CollectPolylines();
    this->Result.Aborted = this->Aborted;
    return std::move(this->Result);
  }

private:
  double ToleranceOf(std::int64_t face) const
  {
    return this->Options.FaceTolerances.empty() ? this->Options.Tolerance
                                                : this->Options.FaceTolerances[face];
  }

  bool IsUsable(std::int64_t face) const { return this->Errors[face].empty(); }

  void FindUses()
  {
    this->Uses.resize(this->Data.Edges.size());
    for (std::size_t f = 0; f < this->Data.Faces.size(); ++f)
    {
      if (!this->IsUsable(std::int64_t(f)))
      {
        continue;
      }
      const Face& face = this->Data.Faces[f];
      for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
      {
        const TrimLoop& loop = this->Data.Loops[l];
        for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
        {
          this->Uses[this->Data.TrimCurves[c].Edge].push_back({ std::int64_t(f), c });
        }
      }
    }
  }

  // Edges shorter than a hundredth of the tolerance become points: beside them, where the curves of
  // models are no more exact, only slivers would come out, looking any way.
  void CollapseEdges()
  {
    std::vector<double> shortest(this->Data.Edges.size(), 0.0);
    for (std::size_t e = 0; e < shortest.size(); ++e)
    {
      for (const EdgeUse& use : this->Uses[e])
      {
        const double length = ShortEdge * this->ToleranceOf(use.Face);
        shortest[e] = shortest[e] > 0.0 ? std::min(shortest[e], length) : length;
      }
    }
    if (this->Exchange->IsParallel())
    {
      CollapseShortEdges(this->Completed, shortest, this->Exchange->GetLoops());
    }
    else
    {
      CollapseShortEdges(this->Completed, shortest);
    }
  }

  // Large surfaces are worked on by all threads at once, the others one a thread.
  void OrderFaces()
  {
    for (std::size_t f = 0; f < this->Data.Faces.size(); ++f)
    {
      if (this->IsUsable(std::int64_t(f)))
      {
        const bool large = this->Data.Faces[f].Geometry.Size() > 4096;
        (large || this->Data.Faces.size() == 1 ? this->Large : this->Small)
          .push_back(std::int64_t(f));
      }
    }
  }

  std::vector<std::int64_t> AllFaces() const
  {
    std::vector<std::int64_t> all = this->Large;
    all.insert(all.end(), this->Small.begin(), this->Small.end());
    return all;
  }

  bool Report(double progress)
  {
    if (this->Options.Progress && !this->Options.Progress(progress))
    {
      this->Aborted = true;
    }
    return !this->Aborted;
  }

  template <typename F>
  void ForFaces(const std::vector<std::int64_t>& faces, double from, double to, F&& body)
  {
    std::vector<std::int64_t> small;
    std::atomic<std::int64_t> done{ 0 };
    const auto step = [&]() {
      const std::int64_t n = ++done;
      if (n % 64 == 0 || n == std::int64_t(faces.size()))
      {
        this->Report(from + (to - from) * double(n) / double(faces.size()));
      }
    };
    for (std::int64_t f : faces)
    {
      if (!std::binary_search(this->Large.begin(), this->Large.end(), f))
      {
        small.push_back(f);
      }
      else if (!this->Aborted)
      {
        body(f, this->Options.Parallel);
        step();
      }
    }
    this->Options.Parallel(
      0, std::int64_t(small.size()), [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t k = begin; k < end && !this->Aborted; ++k)
        {
          body(small[k], SerialFor);
          step();
        }
      });
  }

  // The part of the surface's domain that the loops use.
  ParameterBox UsedDomain(std::int64_t f) const
  {
    const Face& face = this->Data.Faces[f];
    const Interval u = face.Geometry.Domain(0);
    const Interval v = face.Geometry.Domain(1);
    Box2 box;
    for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
    {
      const TrimLoop& loop = this->Data.Loops[l];
      for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
      {
        const CurveView<2>& curve = this->Data.TrimCurves[c].Geometry;
        for (int i = 0; i < curve.Count; ++i)
        {
          box.extend(curve.Point(i));
        }
      }
    }
    ParameterBox used{ u.Clamp(box.min()[0]), u.Clamp(box.max()[0]), v.Clamp(box.min()[1]),
      v.Clamp(box.max()[1]) };
    const auto widen = [](double& low, double& high, const Interval& domain) {
      if (low - domain.Min < 1e-6 * domain.Length())
      {
        low = domain.Min;
      }
      if (domain.Max - high < 1e-6 * domain.Length())
      {
        high = domain.Max;
      }
      if (high - low < 1e-9 * domain.Length())
      {
        low = std::max(domain.Min, low - 1e-6 * domain.Length());
        high = std::min(domain.Max, high + 1e-6 * domain.Length());
      }
    };
    widen(used.U0, used.U1, u);
    widen(used.V0, used.V1, v);
    return used;
  }

  TreeGoal GoalOf(std::int64_t f) const
  {
    TreeGoal goal;
    goal.Tolerance = this->ToleranceOf(f);
    goal.Method = this->Options.Method;
    goal.Error = this->Options.Error;
    goal.MaximumEdgeLength = this->Options.MaximumEdgeLength;
    goal.MaximumAngle = this->Options.MaximumAngle;
    goal.MaximumLeaves = std::max<std::int64_t>(1, this->Options.MaximumFaceTriangles / 2);
    return goal;
  }

  // Parameter distances that are a fiftieth of the tolerance on the surface: trim lines beside a
  // crease or a knot line leave strips that narrow, which no triangle should have to fit.
  static Vec2 SnapDistance(const SurfaceBound& bound, double tolerance)
  {
    const Interval u = bound.View().Domain(0);
    const Interval v = bound.View().Domain(1);
    SurfaceEvaluator evaluator(bound.Evaluator());
    double su = 0.0;
    double sv = 0.0;
    for (int k = 0; k < 9; ++k)
    {
      const SurfaceDerivatives d = evaluator.Derivatives(
        u.Min + u.Length() * (0.1 + 0.4 * (k % 3)), v.Min + v.Length() * (0.1 + 0.4 * (k / 3)), 1);
      su = std::max(su, d.Su.norm());
      sv = std::max(sv, d.Sv.norm());
    }
    const auto distance = [&](double speed, const Interval& domain) {
      return std::min(speed > 0.0 ? 0.02 * tolerance / speed : 0.0, 1e-3 * domain.Length());
    };
    return Vec2(distance(su, u), distance(sv, v));
  }

  void PrepareFace(std::int64_t f, const ParallelFor& parallel)
  {
    const Face& face = this->Data.Faces[f];
    const double tolerance = this->ToleranceOf(f);
    const ParameterBox used = this->UsedDomain(f);
    this->Bounds[f].reset(new SurfaceBound(face.Geometry, used));
    this->Snaps[f] = this->SnapDistance(*this->Bounds[f], tolerance);
    FaceContext& context = this->Contexts[f];
    context.Bound = this->Bounds[f].get();
    context.Tolerance = tolerance;
    if (!(this->Options.MaximumEdgeLength > 0.0) && context.Bound->Flatness() <= 1e-3 * tolerance)
    {
      return;
    }
    this->Trees[f].reset(new SurfaceTree);
    this->Trees[f]->Build(*this->Bounds[f], used, this->GoalOf(f), parallel);
    context.Tree = this->Trees[f].get();
  }

  void DiscretizeEdges(const std::vector<std::int64_t>& edges)
  {
    this->Options.Parallel(
      0, std::int64_t(edges.size()), [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t k = begin; k < end && !this->Aborted; ++k)
        {
          const std::int64_t e = edges[k];
          const std::vector<EdgeUse>& uses = this->Uses[e];
          if (!this->Exchange->IsOwnEdge(uses))
          {
            continue;
          }
          double tolerance = 1e300;
          for (const EdgeUse& use : uses)
          {
            tolerance = std::min(tolerance, this->ToleranceOf(use.Face));
          }
          this->Polylines[e] = DiscretizeEdge(
            this->Data, e, uses, this->Contexts, tolerance, this->Options, this->Extra[e]);
        }
      });
  }

  // One face that can't be done must not take the others with it.
  static FaceMesh TryFace(
    const FaceJob& job, std::vector<SplitRequest>& requests, std::vector<int>& weak)
  {
    try
    {
      return TessellateFace(job, requests, weak);
    }
    catch (const std::exception& problem)
    {
      requests.clear();
      weak.clear();
      FaceMesh failed;
      failed.Status = FaceStatus::Failed;
      failed.Message = problem.what();
      return failed;
    }
  }

  // Triangulates the faces of `todo`; on return `todo` has those that must be done again, and
  // `edges` the edges that must get more points first. False: all are done, or it was aborted.
  bool TriangulateFaces(std::vector<std::int64_t>& todo, int pass, std::vector<std::int64_t>& edges)
  {
    const bool last = pass + 1 == MaximumPasses;
    PassNews news;
    news.Requests.resize(this->Data.Faces.size());
    news.Weak.resize(this->Data.Faces.size());
    std::vector<std::vector<SplitRequest>>& requests = news.Requests;
    std::vector<std::vector<int>>& weak = news.Weak;
    this->ForFaces(todo, 0.5 + 0.4 * pass / MaximumPasses, 0.9,
      [&](std::int64_t f, const ParallelFor& parallel) {
        FaceJob job;
        job.Data = &this->Data;
        job.Face = f;
        job.Bound = this->Bounds[f].get();
        job.Tree = this->Contexts[f].Tree;
        job.Edges = &this->Polylines;
        job.Options = &this->Options;
        job.Tolerance = this->ToleranceOf(f);
        job.Snap = this->Snaps[f];
        job.States = &this->States[f];
        job.LastPass = last;
        job.Parallel = parallel;
        this->Result.Meshes[f] = this->TryFace(job, requests[f], weak[f]);
      });
    news.IsAborted = this->Aborted;
    this->Exchange->Share(news, todo);
    if (news.IsAborted)
    {
      this->Aborted = true;
      return false;
    }
    std::vector<char> again(this->Data.Faces.size(), 0);
    std::vector<char> refine(this->Data.Edges.size(), 0);
    for (std::int64_t f : todo)
    {
      for (const SplitRequest& request : requests[f])
      {
        this->Extra[request.Edge].push_back(request.T);
        refine[request.Edge] = 1;
        for (const EdgeUse& use : this->Uses[request.Edge])
        {
          again[use.Face] = 1;
        }
      }
      if (!this->Exchange->IsGhost(f))
      {
        again[f] = this->Judge(f, last, requests[f].empty(), weak[f]) || again[f];
      }
      else if (!weak[f].empty() && !last && !this->Trees[f]->IsCapped())
      {
        this->Trees[f]->Refine(*this->Bounds[f], this->GoalOf(f), std::move(weak[f]));
      }
    }
    edges.clear();
    for (std::size_t e = 0; e < refine.size(); ++e)
    {
      if (refine[e])
      {
        std::sort(this->Extra[e].begin(), this->Extra[e].end());
        edges.push_back(std::int64_t(e));
      }
    }
    todo.clear();
    for (std::int64_t f : this->AllFaces())
    {
      if (again[f] && !this->Exchange->IsGhost(f))
      {
        todo.push_back(f);
      }
    }
    return this->Exchange->IsParallel() ? news.IsUnfinished : !todo.empty();
  }

  // Looks at a finished face: true if it must be done again with a finer tree.
  bool Judge(std::int64_t f, bool last, bool settled, std::vector<int>& weak)
  {
    FaceMesh& mesh = this->Result.Meshes[f];
    const double tolerance = this->ToleranceOf(f);
    if (this->Contexts[f].Tree && this->Contexts[f].Tree->IsCapped())
    {
      mesh.Status = std::max(mesh.Status, FaceStatus::Capped);
      this->Say(mesh, "the triangle limit was reached");
      return false;
    }
    if (!weak.empty() && !last)
    {
      this->Trees[f]->Refine(*this->Bounds[f], this->GoalOf(f), std::move(weak));
      return true;
    }
    if (mesh.CertifiedError <= tolerance || this->Options.Error == ErrorMode::Estimated)
    {
      return false;
    }
    if (!settled)
    {
      return true;
    }
    mesh.Status = std::max(mesh.Status, FaceStatus::Capped);
    this->Say(mesh,
      "its error is certified to " + std::to_string(mesh.CertifiedError / tolerance) +
        " tolerances only; its edges are up to " + std::to_string(mesh.ModelGap / tolerance) +
        " tolerances away from it in the model itself");
    return false;
  }

  static void Say(FaceMesh& mesh, const std::string& text)
  {
    mesh.Message += (mesh.Message.empty() ? "" : "; ") + text;
  }

  void CollectPolylines()
  {
    for (std::size_t f = 0; f < this->Data.Faces.size(); ++f)
    {
      if (this->Exchange->IsGhost(std::int64_t(f)))
      {
        continue;
      }
      if (!this->IsUsable(std::int64_t(f)))
      {
        this->Result.Meshes[f].Status = FaceStatus::Failed;
        this->Result.Meshes[f].Message = this->Errors[f];
        continue;
      }
      const Face& face = this->Data.Faces[f];
      for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
      {
        const TrimLoop& loop = this->Data.Loops[l];
        for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
        {
          const TrimCurve& curve = this->Data.TrimCurves[c];
          const EdgePolyline& edge = this->Polylines[curve.Edge];
          if (edge.Degenerate || edge.Points.empty())
          {
            continue;
          }
          TrimPolyline line;
          line.Edge = curve.Edge < this->KnownEdges() ? curve.Edge : -1;
          line.Face = std::int64_t(f);
          line.Points = edge.Points;
          if (curve.Reversed)
          {
            std::reverse(line.Points.begin(), line.Points.end());
          }
          this->Result.Polylines.push_back(std::move(line));
        }
      }
    }
  }

  std::int64_t KnownEdges() const { return this->Completed.KnownEdges; }

  const std::vector<std::string>& Errors;
  const TessellatorOptions& Options;
  CompletedModel Completed;
  const Model& Data;
  std::vector<std::vector<EdgeUse>> Uses;
  std::unique_ptr<PieceExchange> Exchange;
  std::vector<std::int64_t> Large;
  std::vector<std::int64_t> Small;
  std::vector<std::unique_ptr<SurfaceBound>> Bounds;
  std::vector<std::unique_ptr<SurfaceTree>> Trees;
  std::vector<FaceContext> Contexts;
  std::vector<std::vector<LeafState>> States;
  std::vector<Vec2> Snaps;
  std::vector<EdgePolyline> Polylines;
  std::vector<std::vector<double>> Extra;
  TessellationResult Result;
  std::atomic<bool> Aborted{ false };
};
} // namespace

TessellationResult Tessellate(
  const Model& model, const std::vector<std::string>& faceErrors, const TessellatorOptions& options)
{
  const auto valid = [](double t) { return t > 0.0 && std::isfinite(t); };
  for (double t : options.FaceTolerances)
  {
    if (!valid(t))
    {
      throw Error("the tolerance of every face must be positive and finite");
    }
  }
  if (options.FaceTolerances.empty() && !valid(options.Tolerance))
  {
    throw Error("the tolerance must be positive and finite");
  }
  if (faceErrors.size() != model.Faces.size() ||
    (!options.FaceTolerances.empty() && options.FaceTolerances.size() != model.Faces.size()))
  {
    throw Error("errors and tolerances must have one entry a face");
  }
  return ModelTessellator(model, faceErrors, options).Run();
}

} // namespace nurbs
