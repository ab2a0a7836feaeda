// SPDX-License-Identifier: BSD-3-Clause
#include "EdgeExport.h"

#include "CurveCopy.h"
#include "CurveLift.h"
#include "TrimLoops.h"
#include "UnionFind.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace nurbs
{

namespace
{

constexpr double PoleShare = 1e-9;  // of the model's size: what is smaller is a point
constexpr double NoSlack = 1.05;    // The search for the largest distance may miss it by a little.
constexpr double StatedSlack = 1.5; // of an edge's tolerance: beyond it the curve is no good

class Preparer
{
public:
  Preparer(const CompletedModel& model, const std::vector<std::string>& faceErrors,
    const EdgeExportOptions& options, const ParallelFor& parallel, const std::atomic<bool>& abort)
    : Data(model.Data)
    , FaceErrors(faceErrors)
    , Options(options)
    , Parallel(parallel)
    , Abort(abort)
  {}

  ExportEdges Run()
  {
    this->MakeEvaluators();
    this->CollectUses();
    this->SolveAll(0);
    const std::size_t first = this->TearEdges();
    this->SolveAll(first);
    if (this->Abort) // Some edges have no curve then.
    {
      return ExportEdges();
    }
    this->AssignEdges();
    this->MakeVertices();
    return std::move(this->Result);
  }

private:
  void MakeEvaluators();
  void CollectUses();
  void AddGroups(std::int64_t edge, const std::vector<EdgeUse>& uses);
  void SolveAll(std::size_t first);
  void Solve(ExportEdge& edge) const;
  void SolveCurve(ExportEdge& edge) const;
  bool IsPole(ExportEdge& edge) const;
  double Deviation(const ExportEdge& edge) const;
  std::size_t TearEdges();
  void AssignEdges();
  void MakeVertices();
  std::vector<std::vector<Vec3>> CollectEnds() const;

  Curve<2> Trim(const EdgeUse& use, const Interval& range) const;
  double Allowed(const ExportEdge& edge) const
  {
    return std::max(this->Options.Gap, StatedSlack * this->Data.Edges[edge.Source].Tolerance);
  }
  Vec3 Lift(SurfaceEvaluator& evaluator, const CurveView<2>& trim, double t) const
  {
    const Vec2 uv = Evaluate(trim, t);
    return evaluator.Point(uv[0], uv[1]);
  }
  SurfaceEvaluator Evaluator(const EdgeUse& use) const { return *this->Evaluators[use.Face]; }
  template <typename Body>
  void ForEach(std::size_t first, std::size_t last, const Body& body) const
  {
    this->Parallel(static_cast<std::int64_t>(first), static_cast<std::int64_t>(last),
      [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end && !this->Abort; ++i)
        {
          body(static_cast<std::size_t>(i));
        }
      });
  }

  const Model& Data;
  const std::vector<std::string>& FaceErrors;
  const EdgeExportOptions& Options;
  const ParallelFor& Parallel;
  const std::atomic<bool>& Abort;
  std::vector<std::optional<SurfaceEvaluator>> Evaluators;
  double Size = 0.0;
  ExportEdges Result;
};

void Preparer::MakeEvaluators()
{
  this->Evaluators.resize(this->Data.Faces.size());
  Box3 box;
  for (std::size_t f = 0; f < this->Data.Faces.size(); ++f)
  {
    const SurfaceView& surface = this->Data.Faces[f].Geometry;
    for (std::int64_t k = 0; this->FaceErrors[f].empty() && k < surface.Size(); ++k)
    {
      box.extend(surface.Point(k));
    }
  }
  this->Size = box.isEmpty() ? 0.0 : box.diagonal().norm();
  this->ForEach(0, this->Data.Faces.size(), [this](std::size_t f) {
    if (this->FaceErrors[f].empty())
    {
      this->Evaluators[f].emplace(this->Data.Faces[f].Geometry);
    }
  });
}

void Preparer::CollectUses()
{
  std::vector<std::vector<EdgeUse>> uses(this->Data.Edges.size());
  for (std::size_t f = 0; f < this->Data.Faces.size(); ++f)
  {
    const Face& face = this->Data.Faces[f];
    for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
    {
      const TrimLoop& loop = this->Data.Loops[l];
      for (std::int64_t c = loop.FirstCurve;
           this->FaceErrors[f].empty() && c < loop.FirstCurve + loop.CurveCount; ++c)
      {
        uses[this->Data.TrimCurves[c].Edge].push_back({ static_cast<std::int64_t>(f), c });
      }
    }
  }
  for (std::size_t e = 0; e < uses.size(); ++e)
  {
    this->AddGroups(static_cast<std::int64_t>(e), uses[e]);
  }
}

/// An edge of a boundary representation has at most two trim curves on a face, one each way (a seam).
/// A pole belongs to one face.
void Preparer::AddGroups(std::int64_t edge, const std::vector<EdgeUse>& uses)
{
  const std::size_t first = this->Result.Edges.size();
  for (const EdgeUse& use : uses)
  {
    const bool reversed = this->Data.TrimCurves[use.Curve].Reversed;
    const auto taken = [&](const EdgeUse& other) {
      return other.Face == use.Face && this->Data.TrimCurves[other.Curve].Reversed == reversed;
    };
    std::size_t group = IsDegenerate(this->Data.Edges[edge]) ? this->Result.Edges.size() : first;
    while (group < this->Result.Edges.size() &&
      std::any_of(
        this->Result.Edges[group].Uses.begin(), this->Result.Edges[group].Uses.end(), taken))
    {
      ++group;
    }
    if (group == this->Result.Edges.size())
    {
      this->Result.Edges.emplace_back();
      this->Result.Edges.back().Source = edge;
    }
    this->Result.Edges[group].Uses.push_back(use);
  }
}

/// The trim curve, its parameter mapped affinely to the edge's.
Curve<2> Preparer::Trim(const EdgeUse& use, const Interval& range) const
{
  const CurveView<2>& view = this->Data.TrimCurves[use.Curve].Geometry;
  const Interval own = view.Domain();
  Curve<2> trim = Copy(view);
  if (own.Min != range.Min || own.Max != range.Max)
  {
    for (double& knot : trim.Knots)
    {
      const double share = (knot - own.Min) / own.Length();
      knot = share == 1.0 ? range.Max : range.Min + share * range.Length();
    }
  }
  return trim;
}

void Preparer::SolveAll(std::size_t first)
{
  this->ForEach(first, this->Result.Edges.size(),
    [this](std::size_t i) { this->Solve(this->Result.Edges[i]); });
}

/// True for a side of a surface that is one point, but for the edge's tolerance, which is set.
bool Preparer::IsPole(ExportEdge& edge) const
{
  constexpr int Samples = 16;
  const Edge& source = this->Data.Edges[edge.Source];
  if (source.Geometry.Count > 1)
  {
    return false;
  }
  Box3 box;
  for (const EdgeUse& use : edge.Uses)
  {
    SurfaceEvaluator evaluator = this->Evaluator(use);
    const CurveView<2>& trim = this->Data.TrimCurves[use.Curve].Geometry;
    const Interval domain = trim.Domain();
    for (int i = 0; i <= Samples; ++i)
    {
      box.extend(this->Lift(evaluator, trim, domain.Min + domain.Length() * i / Samples));
    }
  }
  // A pole's tolerance is the distance from its place, so the box may be larger.
  const double stated = source.Geometry.Count == 1 ? 4.0 * source.Tolerance : 0.0;
  edge.Tolerance = box.diagonal().norm();
  return edge.Tolerance <= std::max(PoleShare * this->Size, stated);
}

void Preparer::Solve(ExportEdge& edge) const
{
  edge.Range = EdgeDomain(this->Data, edge.Source, edge.Uses);
  edge.Pole = this->IsPole(edge);
  if (edge.Pole)
  {
    edge.Range = this->Data.TrimCurves[edge.Uses.front().Curve].Geometry.Domain();
    return;
  }
  this->SolveCurve(edge);
}

/// The model's curve, or one computed if there is none or it fits worse.
void Preparer::SolveCurve(ExportEdge& edge) const
{
  const Edge& source = this->Data.Edges[edge.Source];
  const bool known = source.Geometry.Count > 1;
  if (known)
  {
    edge.Geometry = Copy(source.Geometry);
    edge.Tolerance = this->Deviation(edge);
    if (edge.Tolerance <= StatedSlack * source.Tolerance + 10.0 * this->Options.CurveTolerance)
    {
      return;
    }
  }
  ExportEdge other = edge;
  SurfaceEvaluator evaluator = this->Evaluator(edge.Uses.front());
  other.Range = this->Data.TrimCurves[edge.Uses.front().Curve].Geometry.Domain();
  double error = 0.0;
  other.Geometry = LiftCurve(evaluator, this->Data.TrimCurves[edge.Uses.front().Curve].Geometry,
    this->Options.CurveTolerance, error);
  other.Tolerance = this->Deviation(other);
  other.Computed = true;
  if (!known || other.Tolerance < edge.Tolerance)
  {
    edge = std::move(other);
  }
}

/// The largest distance of the lifted trim curves from the edge's curve, at equal parameters.
double Preparer::Deviation(const ExportEdge& edge) const
{
  const CurveView<3> curve = edge.Geometry.View();
  double largest = 0.0;
  for (const EdgeUse& use : edge.Uses)
  {
    SurfaceEvaluator evaluator = this->Evaluator(use);
    const Curve<2> trim = this->Trim(use, edge.Range);
    const CurveView<2> view = trim.View();
    const auto distance = [&](double t) {
      return (this->Lift(evaluator, view, t) - Evaluate(curve, t)).norm();
    };
    largest = std::max(
      largest, LargestValue(distance, SampleParameters(view, curve), this->Options.Negligible));
  }
  return NoSlack * largest;
}

/// Edges whose faces are too far apart become one edge a face. Returns the first new one.
std::size_t Preparer::TearEdges()
{
  const std::size_t count = this->Result.Edges.size();
  for (std::size_t i = 0; i < count; ++i)
  {
    if (this->Result.Edges[i].Uses.size() < 2 || this->Result.Edges[i].Pole ||
      this->Result.Edges[i].Tolerance <= this->Allowed(this->Result.Edges[i]))
    {
      continue;
    }
    std::vector<EdgeUse> uses = std::move(this->Result.Edges[i].Uses);
    const std::int64_t source = this->Result.Edges[i].Source;
    this->Result.Edges[i].Uses.clear(); // Unused from now on.
    for (const EdgeUse& use : uses)
    {
      this->Result.Edges.emplace_back();
      this->Result.Edges.back().Source = source;
      this->Result.Edges.back().Uses.push_back(use);
      this->Result.Edges.back().Torn = true;
    }
  }
  return count;
}

void Preparer::AssignEdges()
{
  std::vector<ExportEdge>& edges = this->Result.Edges;
  edges.erase(std::remove_if(edges.begin(), edges.end(),
                [](const ExportEdge& edge) { return edge.Uses.empty(); }),
    edges.end());
  this->Result.EdgeOf.assign(this->Data.TrimCurves.size(), -1);
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    for (const EdgeUse& use : edges[i].Uses)
    {
      this->Result.EdgeOf[use.Curve] = static_cast<std::int64_t>(i);
    }
  }
}

/// What each vertex, by number, has to reach: ends of edges and of lifted trim curves.
std::vector<std::vector<Vec3>> Preparer::CollectEnds() const
{
  std::vector<std::vector<Vec3>> ends(this->Result.Vertices.size());
  for (const ExportEdge& edge : this->Result.Edges)
  {
    for (int end = 0; end < 2; ++end)
    {
      std::vector<Vec3>& seen = ends[edge.Vertex[end]];
      if (!edge.Pole)
      {
        seen.push_back(Evaluate(edge.Geometry.View(), end == 0 ? edge.Range.Min : edge.Range.Max));
      }
      for (const EdgeUse& use : edge.Uses)
      {
        SurfaceEvaluator evaluator = this->Evaluator(use);
        const CurveView<2>& trim = this->Data.TrimCurves[use.Curve].Geometry;
        const Interval domain = trim.Domain();
        seen.push_back(this->Lift(evaluator, trim, end == 0 ? domain.Min : domain.Max));
      }
    }
  }
  return ends;
}

/// Ends of edges that follow each other in a loop meet in a vertex.
void Preparer::MakeVertices()
{
  std::vector<ExportEdge>& edges = this->Result.Edges;
  UnionFind sets(2 * edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    if (edges[i].Pole)
    {
      sets.Join(2 * i, 2 * i + 1);
    }
  }
  for (const TrimLoop& loop : this->Data.Loops)
  {
    for (std::int64_t k = 0; k < loop.CurveCount; ++k)
    {
      const std::int64_t a = loop.FirstCurve + k;
      const std::int64_t b = loop.FirstCurve + (k + 1) % loop.CurveCount;
      if (this->Result.EdgeOf[a] >= 0 && this->Result.EdgeOf[b] >= 0)
      {
        sets.Join(2 * this->Result.EdgeOf[a] + (this->Data.TrimCurves[a].Reversed ? 0 : 1),
          2 * this->Result.EdgeOf[b] + (this->Data.TrimCurves[b].Reversed ? 1 : 0));
      }
    }
  }
  std::map<std::int64_t, std::int64_t> numbers;
  for (std::size_t node = 0; node < 2 * edges.size(); ++node)
  {
    const auto found = numbers.emplace(sets.Find(node), numbers.size()).first;
    edges[node / 2].Vertex[node % 2] = found->second;
  }
  this->Result.Vertices.resize(numbers.size());
  const std::vector<std::vector<Vec3>> ends = this->CollectEnds();
  for (std::size_t i = 0; i < ends.size(); ++i)
  {
    Box3 box;
    for (const Vec3& p : ends[i])
    {
      box.extend(p);
    }
    ExportVertex& vertex = this->Result.Vertices[i];
    vertex.Place = box.center();
    for (const Vec3& p : ends[i])
    {
      vertex.Tolerance = std::max(vertex.Tolerance, NoSlack * (p - vertex.Place).norm());
    }
  }
  for (const ExportEdge& edge : edges)
  {
    for (const std::int64_t vertex : edge.Vertex)
    {
      double& tolerance = this->Result.Vertices[vertex].Tolerance;
      tolerance = std::max(tolerance, edge.Tolerance);
    }
  }
}

} // namespace

ExportEdges PrepareEdges(const CompletedModel& model, const std::vector<std::string>& faceErrors,
  const EdgeExportOptions& options, const ParallelFor& parallel, const std::atomic<bool>& abort)
{
  return Preparer(model, faceErrors, options, parallel, abort).Run();
}

} // namespace nurbs
