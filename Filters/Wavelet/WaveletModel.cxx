// SPDX-License-Identifier: BSD-3-Clause
#include "WaveletModel.h"

#include "WaveletSelection.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace nurbs
{

namespace
{
constexpr double SameSide = 1e-7;  // Of the model: sides that coincide.
constexpr double ShortEdge = 0.01; // Of the finest tolerance: edges that are one point.
constexpr double EdgeShare = 0.5;  // Of a tolerance, for the edges' chords.
constexpr int MaximumRounds = 16;  // Of refinement where a mesh errs more than asked for.
constexpr int DiagonalSamples = 9; // A face and direction.
constexpr int BudgetTries = 10;
constexpr double NegligibleThreshold = 1e-12; // Of the largest coefficient.
constexpr double BudgetUsed = 0.97;           // A budget that is used so far will do.

double Diagonal(const Model& model, const std::vector<std::string>& faceErrors)
{
  Box3 box;
  for (std::size_t f = 0; f < model.Faces.size(); ++f)
  {
    for (std::int64_t k = 0; faceErrors[f].empty() && k < model.Faces[f].Geometry.Size(); ++k)
    {
      box.extend(model.Faces[f].Geometry.Point(k));
    }
  }
  return box.isEmpty() ? 0.0 : box.diagonal().norm();
}
} // namespace

double SampledDiagonal(
  const Model& model, const std::vector<std::string>& faceErrors, const ParallelFor& parallel)
{
  std::vector<Box3> boxes(model.Faces.size());
  parallel(0, std::int64_t(boxes.size()), [&](std::int64_t begin, std::int64_t end) {
    std::vector<Vec3> points(DiagonalSamples * DiagonalSamples);
    for (std::int64_t f = begin; f < end; ++f)
    {
      if (!faceErrors[f].empty())
      {
        continue;
      }
      const Face& face = model.Faces[f];
      ParameterBox box;
      try
      {
        box = LoopBox(model, face);
      }
      catch (const Error&)
      {
        continue; // It is told of where it is meshed.
      }
      std::vector<double> us, vs;
      for (int k = 0; k < DiagonalSamples; ++k)
      {
        us.push_back(box.U0 + k * box.A() / (DiagonalSamples - 1));
        vs.push_back(box.V0 + k * box.B() / (DiagonalSamples - 1));
      }
      SurfaceEvaluator(face.Geometry).Grid(us, vs, points[0].data(), nullptr);
      for (const Vec3& x : points)
      {
        boxes[f].extend(x);
      }
    }
  });
  Box3 all;
  for (const Box3& box : boxes)
  {
    if (!box.isEmpty())
    {
      all.extend(box);
    }
  }
  return all.isEmpty() ? 0.0 : all.diagonal().norm();
}

WaveletModel::WaveletModel(
  const Model& model, const std::vector<std::string>& faceErrors, const WaveletOptions& options)
  : Options(options)
  , Errors(faceErrors)
{
  if (!(options.Finest.Tolerance > 0.0) || !std::isfinite(options.Finest.Tolerance))
  {
    throw Error("the finest tolerance must be positive and finite");
  }
  this->Data = CompleteModel(model, faceErrors, SameSide * Diagonal(model, faceErrors));
  CollapseShortEdges(this->Data,
    std::vector<double>(this->Data.Data.Edges.size(), ShortEdge * options.Finest.Tolerance));
  const Model& data = this->Data.Data;
  this->Faces.resize(data.Faces.size());
  this->Edges.resize(data.Edges.size());
  std::atomic<std::int64_t> done{ 0 };
  std::atomic<bool> aborted{ false };
  const double all = double(std::max<std::size_t>(1, data.Faces.size() + data.Edges.size()));
  const auto report = [&]() {
    ++done;
    if (options.Progress && !aborted && !options.Progress(double(done) / all))
    {
      aborted = true;
    }
    return !aborted;
  };
  options.Parallel(0, std::int64_t(data.Faces.size()), [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t f = begin; f < end && report(); ++f)
    {
      if (!this->Errors[f].empty())
      {
        continue;
      }
      try
      {
        this->Faces[f] = std::make_unique<WaveletFace>(data, f, options.Kind, options.Finest);
      }
      catch (const Error& error)
      {
        this->Errors[f] = error.what();
      }
    }
  });
  std::vector<std::vector<EdgeUse>> uses(data.Edges.size());
  this->UseOfCurve.assign(data.TrimCurves.size(), -1);
  for (std::size_t f = 0; f < data.Faces.size(); ++f)
  {
    const Face& face = data.Faces[f];
    for (std::int64_t l = face.FirstLoop; this->Faces[f] && l < face.FirstLoop + face.LoopCount;
         ++l)
    {
      const TrimLoop& loop = data.Loops[l];
      for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
      {
        std::vector<EdgeUse>& of = uses[data.TrimCurves[c].Edge];
        this->UseOfCurve[c] = int(of.size());
        of.push_back({ std::int64_t(f), c });
      }
    }
  }
  options.Parallel(0, std::int64_t(data.Edges.size()), [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t e = begin; e < end && report(); ++e)
    {
      if (!uses[e].empty())
      {
        this->Edges[e] = std::make_unique<WaveletEdge>(
          data, e, uses[e], this->Faces, options.Kind, EdgeShare * options.Finest.Tolerance);
      }
    }
  });
  this->Aborted = aborted;
}

int WaveletModel::Levels() const
{
  int levels = 1;
  for (const auto& face : this->Faces)
  {
    levels = std::max(levels, face ? face->Levels() : 1);
  }
  for (const auto& edge : this->Edges)
  {
    levels = std::max(levels, edge ? edge->Axis().Depth + 1 : 1);
  }
  return levels;
}

std::int64_t WaveletModel::SampleCount() const
{
  std::int64_t count = 0;
  for (const auto& face : this->Faces)
  {
    count += face ? std::int64_t(face->Pyramid().Coefficients().size()) : 0;
  }
  return count;
}

WaveletMeshes WaveletModel::Level(int level) const
{
  return this->MixedLevels(std::vector<int>(this->Faces.size(), level));
}

WaveletMeshes WaveletModel::MixedLevels(const std::vector<int>& levels) const
{
  WaveletSelection selection = this->SelectLevels(levels);
  return this->Mesh(selection, 1e300);
}

WaveletMeshes WaveletModel::MaximumError(double tolerance) const
{
  WaveletSelection selection = this->SelectError(tolerance);
  WaveletMeshes meshes = this->Mesh(selection, tolerance);
  for (WaveletMesh& mesh : meshes.Faces)
  {
    if (mesh.Status < WaveletStatus::Capped && mesh.Error > tolerance)
    {
      mesh.Status = WaveletStatus::Capped;
      mesh.Message += (mesh.Message.empty() ? "" : "; ") +
        std::string("the finest level errs by up to ") + std::to_string(mesh.Error);
    }
  }
  return meshes;
}

WaveletMeshes WaveletModel::TriangleBudget(std::int64_t triangles) const
{
  const auto count = [](const WaveletMeshes& meshes) {
    std::int64_t sum = 0;
    for (const WaveletMesh& mesh : meshes.Faces)
    {
      sum += std::int64_t(mesh.Triangles.size() / 3);
    }
    return sum;
  };
  // Thresholds under `low` make too many triangles, `high` does not, if the coarsest mesh does not.
  double low = 0.0;
  double high = this->LargestThreshold();
  const double negligible = NegligibleThreshold * high;
  WaveletSelection coarsest = this->SelectThreshold(high);
  WaveletMeshes best = this->Mesh(coarsest, 1e300);
  best.Threshold = high;
  best.WithinBudget = count(best) <= triangles;
  double share = 1.0; // Estimates per triangle made.
  for (int attempt = 0; attempt < BudgetTries && best.WithinBudget && !best.Aborted; ++attempt)
  {
    double threshold = this->ThresholdOfEstimate(share * double(triangles), low, high);
    if (attempt > 2 && low > 0.0)
    {
      threshold = std::sqrt(low * high);
    }
    threshold = threshold <= negligible ? 0.0 : threshold;
    if (threshold >= high || (low > 0.0 && threshold <= low))
    {
      break;
    }
    WaveletSelection selection = this->SelectThreshold(threshold);
    WaveletMeshes meshes = this->Mesh(selection, 1e300);
    meshes.Threshold = threshold;
    const std::int64_t made = count(meshes);
    share *= double(triangles) / double(std::max<std::int64_t>(1, made));
    if (meshes.Aborted || made <= triangles)
    {
      best = std::move(meshes);
      high = threshold;
      if (double(made) >= BudgetUsed * double(triangles) || threshold == 0.0)
      {
        break;
      }
    }
    else
    {
      low = std::max(threshold, negligible);
    }
  }
  return best;
}

// The smallest threshold between two whose estimate keeps within a number of triangles.
double WaveletModel::ThresholdOfEstimate(double triangles, double low, double high) const
{
  if (low == 0.0)
  {
    if (double(this->EstimateTriangles(0.0)) <= triangles)
    {
      return 0.0;
    }
    low = NegligibleThreshold * high;
  }
  for (int step = 0; step < 24 && low < high; ++step)
  {
    const double middle = std::sqrt(low * high);
    (double(this->EstimateTriangles(middle)) <= triangles ? high : low) = middle;
  }
  return high;
}

WaveletSelection WaveletModel::SelectLevels(const std::vector<int>& levels) const
{
  WaveletSelection out(this->Options.Kind, this->Faces.size(), this->Edges.size());
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    if (this->Faces[f])
    {
      out.SetLevel(f, *this->Faces[f], levels[f]);
    }
  }
  for (std::size_t e = 0; e < this->Edges.size(); ++e)
  {
    const WaveletEdge* edge = this->Edges[e].get();
    if (!edge || edge->IsPole())
    {
      continue;
    }
    int level = edge->Axis().Depth;
    for (const WaveletEdgeUse& use : edge->Uses())
    {
      level = use.Side < 0 ? std::min(level, levels[use.Where.Face]) : level;
    }
    out.SetEdgeLevel(e, *edge, edge->LevelOfSides(levels, level));
  }
  return out;
}

// Levels of edges whose faces have theirs: too coarse are
// those levels of Haar's wavelets, and segments of the others, for which the functions say so.
void WaveletModel::SelectEdges(WaveletSelection& out,
  const std::function<bool(const WaveletEdge&, int)>& coarseLevel,
  const std::function<bool(const WaveletEdge&, int, int)>& coarseSegment) const
{
  for (std::size_t e = 0; e < this->Edges.size(); ++e)
  {
    const WaveletEdge* edge = this->Edges[e].get();
    if (!edge || edge->IsPole())
    {
      continue;
    }
    int level = edge->Axis().Depth;
    if (this->Options.Kind == Wavelet::Haar)
    {
      // Where an edge has the level of its faces, their cells reach it.
      level = edge->LevelOfSides(out.Level, level);
      while (level > 0 && coarseLevel(*edge, level))
      {
        --level;
      }
    }
    out.SetEdgeLevel(e, *edge, level);
    if (this->Options.Kind != Wavelet::Haar)
    {
      out.RefineEdge(e, [&](int first, int last) { return coarseSegment(*edge, first, last); });
    }
  }
}

WaveletSelection WaveletModel::SelectError(double tolerance) const
{
  WaveletSelection out(this->Options.Kind, this->Faces.size(), this->Edges.size());
  const bool adaptive = this->Options.Kind == Wavelet::Interpolating;
  this->Options.Parallel(
    0, std::int64_t(this->Faces.size()), [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t f = begin; f < end; ++f)
      {
        const WaveletFace* face = this->Faces[f].get();
        if (face && adaptive)
        {
          out.RefineCells(f, *face, CellErrorOver(*face, tolerance));
        }
        else if (face)
        {
          int level = face->Levels() - 1;
          while (level > 0 && face->LevelError(level) > tolerance)
          {
            --level;
          }
          out.SetLevel(f, *face, level);
        }
      }
    });
  this->SelectEdges(
    out, [&](const WaveletEdge& edge, int level) { return edge.HaarError(level) > tolerance; },
    [&](const WaveletEdge& edge, int first, int last) {
      return edge.SegmentError(first, last) > EdgeShare * tolerance;
    });
  return out;
}

WaveletSelection WaveletModel::SelectThreshold(double threshold) const
{
  WaveletSelection out(this->Options.Kind, this->Faces.size(), this->Edges.size());
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    const WaveletFace* face = this->Faces[f].get();
    if (face && this->Options.Kind == Wavelet::Interpolating)
    {
      out.RefineCells(f, *face,
        [&](const WaveletCell& cell) { return face->LargestCoefficient(cell) > threshold; });
    }
    else if (face)
    {
      out.SetLevel(f, *face, LevelWithin(*face, threshold));
    }
  }
  this->SelectEdges(
    out, [&](const WaveletEdge& edge, int level) { return edge.HaarDropped(level) > threshold; },
    [&](const WaveletEdge& edge, int first, int last) {
      return edge.LargestCoefficient(first, last) > threshold;
    });
  return out;
}

std::int64_t WaveletModel::EstimateTriangles(double threshold) const
{
  std::int64_t cells = 0;
  for (const auto& face : this->Faces)
  {
    if (face && this->Options.Kind == Wavelet::Interpolating)
    {
      cells += CountCells(*face, threshold);
    }
    else if (face)
    {
      const GridStep step = face->Pyramid().Step(LevelWithin(*face, threshold));
      cells += std::int64_t(step.FineSamples(0) - 1) * (step.FineSamples(1) - 1);
    }
  }
  std::int64_t segments = 0;
  for (const auto& edge : this->Edges)
  {
    if (edge && !edge->IsPole())
    {
      segments += edge->CountSegments(threshold) * std::int64_t(edge->Uses().size());
    }
  }
  return 2 * cells + segments;
}

// Over which there is no coefficient.
double WaveletModel::LargestThreshold() const
{
  double largest = 0.0;
  for (const auto& face : this->Faces)
  {
    if (!face)
    {
      continue;
    }
    const int level = face->Levels() - 1;
    largest = std::max(largest, face->LargestDropped(level));
    const int cells = this->Options.Kind == Wavelet::Interpolating
      ? face->Axis(0).BaseIntervals() * face->Axis(1).BaseIntervals()
      : 0;
    for (int k = 0; k < cells; ++k)
    {
      const int n = face->Axis(0).BaseIntervals();
      largest = std::max(largest, face->LargestCoefficient({ level, k % n, k / n }));
    }
  }
  for (const auto& edge : this->Edges)
  {
    if (!edge || edge->IsPole())
    {
      continue;
    }
    const int depth = edge->Axis().Depth;
    largest = std::max(largest, edge->HaarDropped(depth));
    for (int i = 0; i < edge->Axis().BaseIntervals() && this->Options.Kind != Wavelet::Haar; ++i)
    {
      largest = std::max(largest, edge->LargestCoefficient(i << depth, (i + 1) << depth));
    }
  }
  return 1.001 * largest;
}

// Meshes all faces; where errors exceed the limit, cells and segments are refined and what they
// touch is meshed again.
WaveletMeshes WaveletModel::Mesh(WaveletSelection& selection, double limit) const
{
  WaveletMeshes out;
  const std::size_t n = this->Faces.size();
  out.Faces.resize(n);
  std::vector<char> dirty(n, 1);
  std::atomic<std::int64_t> done{ 0 };
  std::atomic<bool> aborted{ false };
  for (int round = 0; round < MaximumRounds && !aborted; ++round)
  {
    this->ShareLines(selection);
    this->Uncross(selection);
    selection.MarkChangedEdges(this->Edges, dirty);
    std::vector<FaceMeshRequests> requests(n);
    this->Options.Parallel(0, std::int64_t(n), [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t f = begin; f < end && !aborted; ++f)
      {
        const double share = double(++done) / double(n); // Later rounds have few faces to do.
        if (this->Options.Progress && !this->Options.Progress(std::min(1.0, share)))
        {
          aborted = true;
        }
        if (!this->Faces[f])
        {
          out.Faces[f].Status = WaveletStatus::Failed;
          out.Faces[f].Message = this->Errors[f];
        }
        else if (dirty[f])
        {
          const FaceMeshJob job = this->Job(f, selection, limit);
          out.Faces[f] = MeshFace(job, requests[f]);
        }
      }
    });
    std::fill(dirty.begin(), dirty.end(), 0);
    if (!selection.Apply(requests, this->Faces, dirty))
    {
      break;
    }
  }
  out.Aborted = aborted;
  return out;
}

} // namespace nurbs
