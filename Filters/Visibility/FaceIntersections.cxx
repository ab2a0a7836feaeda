// SPDX-License-Identifier: BSD-3-Clause
#include "FaceIntersections.h"

#include "CompletedModel.h"
#include "FeatureEdges.h"
#include "IntersectionSeeds.h"
#include "IntersectionTrim.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <mutex>

namespace nurbs
{

namespace
{

// What chords may differ from the curve by, as a share of it.
constexpr double ChordShare = 0.9;
// Smallest parts of patches, in precisions.
constexpr double SmallestPart = 4.0;
// Halvings of both faces' patches together, at most.
constexpr int SharedDepth = 12;
constexpr int MaxDepth = 60;
// Tests of parts of one pair of faces, and more for each pair of their patches.
constexpr std::int64_t PairTests = 20000;
constexpr std::int64_t PatchTests = 2000;

// What a face brings to all of its pairs.
struct FaceParts
{
  Box2 Domain; ///< That its loops reach.
  std::unique_ptr<SurfaceEvaluator> Evaluator;
  std::unique_ptr<CoverTest> Cover;
  std::vector<IntersectionCell> Cells;
  std::once_flag HasCurves;
  std::unique_ptr<TrimCurveTree> Curves;
};

// Two patches of different faces.
struct CellPair
{
  std::int64_t Face[2];
  std::size_t Cell[2]; ///< Of FaceParts::Cells.
};

// All steps of one call.
class PairFinder
{
public:
  PairFinder(const Model& model, const TrimIndex& trims, const std::vector<std::string>& faceErrors,
    const FaceIntersectionOptions& options)
    : Source(model)
    , Trims(trims)
    , FaceErrors(faceErrors)
    , Options(options)
    , Faces(model.Faces.size())
  {}

  FaceIntersections Run();

private:
  using FacePair = std::array<std::int64_t, 2>;

  void MakeFace(std::int64_t face);
  void FindShared();
  void FindCoinciding(const std::vector<std::vector<EdgeUse>>& uses);
  void FindPairs();
  double ToleranceOf(const FacePair& pair, bool& shares) const;
  void Intersect(
    std::size_t first, std::size_t last, std::vector<FaceIntersection>& out, bool& exhausted);
  const TrimCurveTree& CurvesOf(std::int64_t face);
  bool Report(double done);

  const Model& Source;
  const TrimIndex& Trims;
  const std::vector<std::string>& FaceErrors;
  const FaceIntersectionOptions& Options;
  std::vector<FaceParts> Faces;
  /// Pairs of faces that share an edge, or have one at the same place: its tolerance.
  std::map<FacePair, double> Shared;
  std::vector<CellPair> Pairs; ///< By pair of faces.
  double Size = 0.0;           ///< Of coordinates.
  std::atomic<bool> Aborted{ false };
};

bool PairFinder::Report(double done)
{
  if (this->Options.Progress && !this->Options.Progress(done))
  {
    this->Aborted = true;
  }
  return !this->Aborted;
}

void PairFinder::MakeFace(std::int64_t index)
{
  const Face& face = this->Source.Faces[index];
  FaceParts& parts = this->Faces[index];
  if (!this->FaceErrors[index].empty())
  {
    return; // Its surface may lack knots.
  }
  parts.Domain = LoopsBox(this->Source, face);
  if (parts.Domain.isEmpty() || !(parts.Domain.sizes().minCoeff() > 0.0))
  {
    return;
  }
  const FaceTrim& trim = this->Trims.Face(index);
  parts.Evaluator = std::make_unique<SurfaceEvaluator>(face.Geometry);
  parts.Cover = std::make_unique<CoverTest>(this->Source, face, trim);
  const Interval u{ parts.Domain.min()[0], parts.Domain.max()[0] };
  const Interval v{ parts.Domain.min()[1], parts.Domain.max()[1] };
  for (BezierPatch& patch : ToBezier(Restrict(face.Geometry, u, v).View()))
  {
    parts.Cells.emplace_back(std::move(patch));
    IntersectionCell& cell = parts.Cells.back();
    cell.IsOuter[0][0] = cell.Patch.U.Min == u.Min;
    cell.IsOuter[0][1] = cell.Patch.U.Max == u.Max;
    cell.IsOuter[1][0] = cell.Patch.V.Min == v.Min;
    cell.IsOuter[1][1] = cell.Patch.V.Max == v.Max;
  }
}

void PairFinder::FindShared()
{
  const std::vector<std::vector<EdgeUse>> uses = UsesOfEdges(this->Source, this->FaceErrors);
  for (std::size_t e = 0; e < uses.size(); ++e)
  {
    for (std::size_t i = 0; i < uses[e].size(); ++i)
    {
      for (std::size_t j = 0; j < i; ++j)
      {
        const std::int64_t a = uses[e][i].Face;
        const std::int64_t b = uses[e][j].Face;
        double& tolerance = this->Shared[{ std::min(a, b), std::max(a, b) }];
        tolerance = std::max(tolerance, this->Source.Edges[e].Tolerance);
      }
    }
  }
  this->FindCoinciding(uses);
}

// Adds pairs of faces with edges of their own that have the same ends and middle, within the
// precision.
void PairFinder::FindCoinciding(const std::vector<std::vector<EdgeUse>>& uses)
{
  std::vector<std::array<Vec3, 3>> places;
  std::vector<std::int64_t> owners;
  std::vector<Box3> boxes;
  for (std::size_t e = 0; e < uses.size(); ++e)
  {
    if (uses[e].size() != 1 || IsDegenerate(this->Source.Edges[e]))
    {
      continue;
    }
    const CurveView<2>& curve = this->Source.TrimCurves[uses[e].front().Curve].Geometry;
    const SurfaceView& surface = this->Source.Faces[uses[e].front().Face].Geometry;
    const Interval domain = curve.Domain();
    std::array<Vec3, 3> place;
    for (int k = 0; k < 3; ++k)
    {
      const Vec2 uv = Evaluate(curve, domain.Min + 0.5 * k * domain.Length());
      place[k] = Evaluate(surface, surface.Domain(0).Clamp(uv[0]), surface.Domain(1).Clamp(uv[1]));
    }
    places.push_back(place);
    owners.push_back(uses[e].front().Face);
    boxes.emplace_back(place[1], place[1]);
  }
  const double reach = 4.0 * this->Options.Precision;
  BoxTree tree;
  tree.Build(boxes, reach);
  for (std::size_t k = 0; k < places.size(); ++k)
  {
    const std::array<Vec3, 3>& a = places[k];
    tree.Search([&](const Box3& box) { return box.contains(a[1]); },
      [&](std::int32_t other, const Box3&) {
        const std::array<Vec3, 3>& b = places[other];
        const double apart = std::min(std::max((a[0] - b[0]).norm(), (a[2] - b[2]).norm()),
          std::max((a[0] - b[2]).norm(), (a[2] - b[0]).norm()));
        if (owners[other] < owners[k] && apart <= reach && (a[1] - b[1]).norm() <= reach)
        {
          this->Shared.try_emplace({ owners[other], owners[k] }, 0.0);
        }
      });
  }
}

// By how much two faces may pass each other.
double PairFinder::ToleranceOf(const FacePair& pair, bool& shares) const
{
  const auto found = this->Shared.find(pair);
  shares = found != this->Shared.end();
  return std::max(this->Options.Precision, shares ? 2.0 * found->second : 0.0);
}

// Pairs of patches that are not told apart at once.
void PairFinder::FindPairs()
{
  std::vector<Box3> boxes;
  std::vector<std::pair<std::int64_t, std::size_t>> owners;
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    for (std::size_t c = 0; c < this->Faces[f].Cells.size(); ++c)
    {
      const Box3& box = this->Faces[f].Cells[c].Box;
      boxes.push_back(box);
      owners.emplace_back(std::int64_t(f), c);
      this->Size =
        std::max({ this->Size, box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff() });
    }
  }
  BoxTree tree;
  tree.Build(boxes, 0.0);
  std::vector<std::vector<CellPair>> found(this->Faces.size());
  this->Options.Parallel(
    0, std::int64_t(this->Faces.size()), [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t f = begin; f < end && !this->Aborted; ++f)
      {
        for (std::size_t c = 0; c < this->Faces[f].Cells.size(); ++c)
        {
          const IntersectionCell& cell = this->Faces[f].Cells[c];
          tree.Search([&](const Box3& box) { return box.intersects(cell.Box); },
            [&](std::int32_t other, const Box3&) {
              const auto& [g, d] = owners[other];
              bool shares = false;
              if (g > f &&
                Meet(cell, this->Faces[g].Cells[d], this->ToleranceOf({ f, g }, shares)) !=
                  CellMeeting::Apart)
              {
                found[f].push_back({ { f, g }, { c, d } });
              }
            });
        }
        std::sort(found[f].begin(), found[f].end(), [](const CellPair& a, const CellPair& b) {
          return std::make_tuple(a.Face[1], a.Cell[0], a.Cell[1]) <
            std::make_tuple(b.Face[1], b.Cell[0], b.Cell[1]);
        });
      }
    });
  for (const std::vector<CellPair>& list : found)
  {
    this->Pairs.insert(this->Pairs.end(), list.begin(), list.end());
  }
}

const TrimCurveTree& PairFinder::CurvesOf(std::int64_t face)
{
  FaceParts& parts = this->Faces[face];
  std::call_once(parts.HasCurves, [&]() {
    parts.Curves = std::make_unique<TrimCurveTree>(this->Source, this->Source.Faces[face]);
  });
  return *parts.Curves;
}

// A patch to split, without what belongs to the one that all threads see.
IntersectionCell CopyOf(const IntersectionCell& cell)
{
  IntersectionCell out(cell.Patch);
  std::copy(&cell.IsOuter[0][0], &cell.IsOuter[0][0] + 4, &out.IsOuter[0][0]);
  return out;
}

// All patches of one pair of faces: Pairs[first] to Pairs[last - 1].
void PairFinder::Intersect(
  std::size_t first, std::size_t last, std::vector<FaceIntersection>& out, bool& exhausted)
{
  const CellPair& head = this->Pairs[first];
  const FaceParts& a = this->Faces[head.Face[0]];
  const FaceParts& b = this->Faces[head.Face[1]];
  bool shares = false;
  const double precision = this->Options.Precision;
  const double tolerance = this->ToleranceOf({ head.Face[0], head.Face[1] }, shares);
  SurfacePair pair(*a.Evaluator, a.Domain, *b.Evaluator, b.Domain, this->Size);
  SeedSearch search(pair, *a.Cover, *b.Cover,
    { tolerance, SmallestPart * precision, PairTests + PatchTests * std::int64_t(last - first),
      shares ? SharedDepth : MaxDepth });
  std::map<std::size_t, IntersectionCell> cells[2];
  for (std::size_t k = first; k < last; ++k)
  {
    for (int side = 0; side < 2; ++side)
    {
      const std::size_t c = this->Pairs[k].Cell[side];
      cells[side].try_emplace(c, CopyOf((side == 0 ? a : b).Cells[c]));
    }
    search.Search(cells[0][this->Pairs[k].Cell[0]], cells[1][this->Pairs[k].Cell[1]]);
  }
  exhausted = search.Exhausted;
  if (search.Seeds.empty())
  {
    return;
  }
  IntersectionTracer tracer(pair);
  const auto borders = [&](std::int64_t face) {
    return FaceBorders{ &this->Trims.Face(face), this->Faces[face].Cover.get(),
      &this->CurvesOf(face) };
  };
  IntersectionCutter cutter(pair, tracer, borders(head.Face[0]), borders(head.Face[1]), tolerance);
  std::vector<TracedIntersection> curves;
  for (const IntersectionPoint& seed : search.Seeds)
  {
    if (std::any_of(curves.begin(), curves.end(),
          [&](const TracedIntersection& curve) { return tracer.Passes(curve, seed); }))
    {
      continue;
    }
    TracedIntersection curve = tracer.Trace(seed);
    if (curve.Points.size() < 2)
    {
      continue;
    }
    // Along edges, most likely all the way.
    if (!cutter.RunsAlongBorders(curve, shares ? 1 : 3))
    {
      TracedIntersection refined = curve;
      tracer.Refine(refined, ChordShare * precision);
      cutter.Cut(refined, out);
    }
    curves.push_back(std::move(curve));
  }
  for (FaceIntersection& curve : out)
  {
    std::copy(head.Face, head.Face + 2, curve.Face);
  }
}

FaceIntersections PairFinder::Run()
{
  FaceIntersections out;
  const auto faces = std::int64_t(this->Faces.size());
  this->Options.Parallel(0, faces, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t f = begin; f < end && !this->Aborted; ++f)
    {
      this->MakeFace(f);
    }
  });
  this->FindShared();
  if (this->Report(0.2))
  {
    this->FindPairs();
  }
  std::vector<std::size_t> starts;
  for (std::size_t k = 0; k < this->Pairs.size(); ++k)
  {
    if (k == 0 ||
      !std::equal(this->Pairs[k].Face, this->Pairs[k].Face + 2, this->Pairs[k - 1].Face))
    {
      starts.push_back(k);
    }
  }
  out.Pairs = std::int64_t(starts.size());
  starts.push_back(this->Pairs.size());
  std::vector<std::vector<FaceIntersection>> curves(out.Pairs);
  std::vector<char> exhausted(out.Pairs, 0);
  std::atomic<std::int64_t> done{ 0 };
  this->Options.Parallel(0, out.Pairs, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t k = begin; k < end; ++k)
    {
      if (!this->Report(0.3 + 0.7 * double(done++) / double(out.Pairs)))
      {
        return;
      }
      bool isExhausted = false;
      this->Intersect(starts[k], starts[k + 1], curves[k], isExhausted);
      exhausted[k] = isExhausted;
    }
  });
  out.Aborted = this->Aborted;
  for (std::int64_t k = 0; k < out.Pairs && !out.Aborted; ++k)
  {
    std::move(curves[k].begin(), curves[k].end(), std::back_inserter(out.Curves));
    if (exhausted[k])
    {
      const CellPair& pair = this->Pairs[starts[k]];
      out.Unresolved.push_back({ pair.Face[0], pair.Face[1] });
    }
  }
  return out;
}

} // namespace

FaceIntersections FindIntersections(const Model& model, const TrimIndex& trims,
  const std::vector<std::string>& faceErrors, const FaceIntersectionOptions& options)
{
  if (!(options.Precision > 0.0) || !std::isfinite(options.Precision))
  {
    throw Error("The precision must be positive, but is " + std::to_string(options.Precision));
  }
  return PairFinder(model, trims, faceErrors, options).Run();
}

} // namespace nurbs
