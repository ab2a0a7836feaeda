// SPDX-License-Identifier: BSD-3-Clause
#include "RegionLoops.h"

#include "HalfEdges.h"
#include "UnionFind.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

// Largest distance of a shadow's chords from it, on the surface, in precisions: the line that casts it is
// not exact either.
constexpr double ShadowChord = 0.5;
constexpr int MaxShadowDepth = 14; // Halvings of a shadow's chord.
// Chords longer than so many pixels are halved at least so often: a wavy surface may meet the middle.
constexpr double SureLength = 64.0;
constexpr int SureHalvings = 3;
// Ends of curves at which nothing is between, as a share of the domain.
constexpr double SameParameters = 1e-6;
// Ends of pieces that are on different sides of a seam, as a share of the domain.
constexpr double FarParameters = 0.25;
// How far a shadow may be from a seam to end at it, in precisions.
constexpr double SeamReach = 4.0;
// Ends that are moved to each other; farther apart, they may be the same point of a pole.
constexpr double NearParameters = 0.02;

// Borders of regions in the image.
class BorderTracer
{
public:
  BorderTracer(const ViewLines& lines, const FrontMap& map, bool bothSides);

  /// Loops of half-edges by face.
  std::vector<std::vector<std::vector<HalfEdge>>> Trace() const;

  std::int64_t Face(HalfEdge half) const
  {
    const FrontHit& front = this->Map.Front(half / 2, half % 2);
    return front.FromBehind && !this->BothSides ? -1 : front.Face;
  }

private:
  bool IsCut(std::int32_t edge, std::int64_t face) const;
  bool IsBorder(HalfEdge half) const;
  std::vector<char> FindSpecks() const;

  const ViewLines& Lines;
  const FrontMap& Map;
  bool BothSides;
  std::vector<char> Border; // One a half-edge.
};

BorderTracer::BorderTracer(const ViewLines& lines, const FrontMap& map, bool bothSides)
  : Lines(lines)
  , Map(map)
  , BothSides(bothSides)
{
  this->Border.resize(2 * map.Snapped.Edges.size());
  for (HalfEdge h = 0; h < HalfEdge(this->Border.size()); ++h)
  {
    this->Border[h] = this->IsBorder(h);
  }
}

// True if the face is seen on both sides of an edge but does not go on across it.
bool BorderTracer::IsCut(std::int32_t edge, std::int64_t face) const
{
  for (const LineSource& source : this->Map.SourcesOf(edge))
  {
    const ViewLine& line = this->Lines.Lines[source.Line];
    // Where it is pierced, a face goes on beyond, behind the other one.
    if (source.Shows == 0 || line.IsIntersection() || !IsOfFace(this->Lines, line, face))
    {
      continue;
    }
    if (source.Shows != 3)
    {
      return true;
    }
    const std::vector<EdgeUse>& uses = this->Lines.Uses[line.Edge];
    if (std::count_if(
          uses.begin(), uses.end(), [&](const EdgeUse& use) { return use.Face == face; }) > 1)
    {
      return true;
    }
  }
  return false;
}

bool BorderTracer::IsBorder(HalfEdge half) const
{
  const std::int64_t face = this->Face(half);
  if (face < 0)
  {
    return false;
  }
  const std::int32_t edge = half / 2;
  return this->Map.Cell(edge, 0) != this->Map.Cell(edge, 1) ? this->Face(half ^ 1) != face ||
      this->Map.Front(edge, 0).FromBehind != this->Map.Front(edge, 1).FromBehind ||
      this->IsCut(edge, face)
                                                            : this->IsCut(edge, face);
}

// Cells in regions that consist of slivers only.
std::vector<char> BorderTracer::FindSpecks() const
{
  UnionFind joined(this->Map.Cells.size());
  for (HalfEdge h = 0; h < HalfEdge(this->Border.size()); h += 2)
  {
    if (!this->Border[h] && !this->Border[h + 1] && this->Face(h) == this->Face(h + 1))
    {
      joined.Join(this->Map.Cell(h / 2, 0), this->Map.Cell(h / 2, 1));
    }
  }
  const std::vector<std::int64_t> region = joined.Sets();
  std::vector<char> isWide(region.size(), 0);
  for (std::size_t c = 0; c < region.size(); ++c)
  {
    isWide[region[c]] |= !this->Map.IsSliver(std::int32_t(c));
  }
  std::vector<char> out(region.size());
  for (std::size_t c = 0; c < region.size(); ++c)
  {
    out[c] = !isWide[region[c]];
  }
  return out;
}

std::vector<std::vector<std::vector<HalfEdge>>> BorderTracer::Trace() const
{
  const std::vector<char> isSpeck = this->FindSpecks();
  std::vector<std::vector<std::vector<HalfEdge>>> out(this->Lines.Whole.Data.Faces.size());
  for (std::vector<HalfEdge>& loop : HalfEdges(this->Map.Snapped).Loops(this->Border))
  {
    const HalfEdge first = loop.front();
    if (!isSpeck[this->Map.Cell(first / 2, first % 2)])
    {
      out[this->Face(first)].push_back(std::move(loop));
    }
  }
  return out;
}

// Takes the border of one face's region to its domain.
class RegionLifter
{
public:
  RegionLifter(const ViewLines& lines, const ImagePlane& image, const RayCaster& caster,
    const FrontMap& map, double precision, std::int64_t face)
    : Lines(lines)
    , Image(image)
    , Caster(caster)
    , Map(map)
    , Precision(precision)
    , FaceIndex(face)
    , Surface(lines.Whole.Data.Faces[face].Geometry)
  {}

  RegionLoop Lift(const std::vector<HalfEdge>& loop);
  /// As TracedRegion::Doubtful, so far.
  std::int64_t Doubtful() const { return this->DoubtfulPlaces; }

private:
  // A half-edge, and the line of the face that it is a part of, or the one that casts a shadow.
  struct Step
  {
    HalfEdge Half;
    const LineSource* Source = nullptr;
    std::int64_t Curve = -1; // Of an edge's use.
    bool IsShadow = false;
    LinePosition From = 0.0, To = 0.0;
  };

  // A line of the face that may be what a half-edge is a part of.
  struct Candidate
  {
    const LineSource* Source;
    std::int64_t Curve;
    Vec2 UV;
    double Handicap;
  };

  std::int64_t UseAt(const LineSource& source, HalfEdge half) const;
  void AddCandidates(HalfEdge half, std::vector<Candidate>& out) const;
  Step Classify(HalfEdge half) const;
  bool Continues(const Step& before, const Step& next) const;
  void AddOwn(const Step& first, const Step& last, RegionLoop& out) const;
  void AddShadow(
    const std::vector<Step>& steps, std::size_t begin, std::size_t end, RegionLoop& out);
  // A point of a shadow.
  struct ShadowPoint
  {
    Vec2 Image;
    Vec2 UV;
  };

  /// How far off it is in the image.
  double Miss(const ShadowPoint& point) const
  {
    return (this->Image.Project(this->Point(point.UV)) - point.Image).norm();
  }
  void RefineShadow(
    const ShadowPoint& a, const ShadowPoint& b, int sheet, int depth, std::vector<Vec2>& out);
  Vec2 Seed(HalfEdge half) const;
  RegionPiece Bridge(const Vec2& from, const Vec2& to) const;
  void DropExcursions(RegionLoop& loop) const;
  bool IsAtOnePlace(const Vec2& from, const Vec2& to) const;
  void Close(RegionLoop& loop);
  /// On different sides of a seam.
  bool IsFar(const Vec2& a, const Vec2& b) const
  {
    return std::abs(a[0] - b[0]) > FarParameters * this->Surface.Domain(0).Length() ||
      std::abs(a[1] - b[1]) > FarParameters * this->Surface.Domain(1).Length();
  }
  Vec3 Point(const Vec2& uv) const { return Evaluate(this->Surface, uv[0], uv[1]); }
  bool IsFlipped(HalfEdge half) const
  {
    // Su x Sv away from the viewer: left in the image is right in (u, v).
    return this->Map.Front(half / 2, half % 2).FromBehind !=
      this->Lines.Whole.Data.Faces[this->FaceIndex].Reversed;
  }

  const ViewLines& Lines;
  const ImagePlane& Image;
  const RayCaster& Caster;
  const FrontMap& Map;
  double Precision;
  std::int64_t FaceIndex;
  const SurfaceView& Surface;
  std::int64_t DoubtfulPlaces = 0;
};

// The use of an edge that has the face on the half-edge's left: of the two of a seam, the one whose loop
// runs that way.
std::int64_t RegionLifter::UseAt(const LineSource& source, HalfEdge half) const
{
  const bool forward = (half % 2 == 0) != source.Backward;
  std::int64_t out = -1;
  for (const EdgeUse& use : this->Lines.Uses[this->Lines.Lines[source.Line].Edge])
  {
    if (use.Face == this->FaceIndex)
    {
      const bool runs = forward != this->IsFlipped(half);
      const bool fits = runs != this->Lines.Whole.Data.TrimCurves[use.Curve].Reversed;
      out = fits || out < 0 ? use.Curve : out;
    }
  }
  return out;
}

// Adds the parts of the face's border that run along a half-edge and end what is seen on its left.
void RegionLifter::AddCandidates(HalfEdge half, std::vector<Candidate>& out) const
{
  const Model& model = this->Lines.Whole.Data;
  const auto& ends = this->Map.Snapped.Edges[half / 2];
  for (const LineSource& source : this->Map.SourcesOf(half / 2))
  {
    const ViewLine& line = this->Lines.Lines[source.Line];
    if (!(source.Shows >> (half % 2) & 1) || !IsOfFace(this->Lines, line, this->FaceIndex))
    {
      continue;
    }
    const LinePosition middle = 0.5 *
      (this->Map.At(this->Lines.Lines, source, ends[0]) +
        this->Map.At(this->Lines.Lines, source, ends[1]));
    if (!line.IsEdge())
    {
      out.push_back(
        { &source, -1, ParametersAt(line, middle, this->FaceIndex), line.Edge < 0 ? 1.0 : 4.0 });
      continue;
    }
    RegionPiece piece;
    piece.Curve = this->UseAt(source, half);
    piece.To = ShareAt(line, middle);
    out.push_back({ &source, piece.Curve, EndOfPiece(model, piece, true), 2.0 });
  }
}

RegionLifter::Step RegionLifter::Classify(HalfEdge half) const
{
  Step out;
  out.Half = half;
  std::vector<Candidate> candidates;
  this->AddCandidates(half, candidates);
  if (candidates.size() > 1)
  {
    // The nearest in (u, v) to what is seen beside, where a line runs into a silhouette, which it touches
    // in the image. About as near: a silhouette before an edge.
    const Vec2 beside = this->Seed(half);
    const Vec2 size(this->Surface.Domain(0).Length(), this->Surface.Domain(1).Length());
    const auto rank = [&](const Candidate& one) {
      return one.Handicap * (SameParameters + (one.UV - beside).cwiseQuotient(size).norm());
    };
    std::swap(candidates.front(),
      *std::min_element(candidates.begin(), candidates.end(),
        [&](const Candidate& a, const Candidate& b) { return rank(a) < rank(b); }));
  }
  if (!candidates.empty())
  {
    out.Source = candidates.front().Source;
    out.Curve = candidates.front().Curve;
  }
  out.IsShadow = candidates.empty();
  for (const LineSource& source : this->Map.SourcesOf(half / 2))
  {
    // A shadow is cast by what is seen on the other side.
    if (out.IsShadow && (!out.Source || (source.Shows != 0 && out.Source->Shows == 0)))
    {
      out.Source = &source;
    }
  }
  const auto& ends = this->Map.Snapped.Edges[half / 2];
  out.From = this->Map.At(this->Lines.Lines, *out.Source, ends[half % 2]);
  out.To = this->Map.At(this->Lines.Lines, *out.Source, ends[1 - half % 2]);
  return out;
}

bool RegionLifter::Continues(const Step& before, const Step& next) const
{
  if (before.IsShadow || next.IsShadow)
  {
    return before.IsShadow && next.IsShadow;
  }
  const bool forward = (before.Half % 2 == 0) != before.Source->Backward;
  const bool nextForward = (next.Half % 2 == 0) != next.Source->Backward;
  return before.Source->Line == next.Source->Line && before.Curve == next.Curve &&
    forward == nextForward && std::abs(before.To - next.From) < 1.0;
}

void RegionLifter::AddOwn(const Step& first, const Step& last, RegionLoop& out) const
{
  const ViewLine& line = this->Lines.Lines[first.Source->Line];
  RegionPiece piece;
  piece.Curve = first.Curve;
  if (piece.Curve >= 0)
  {
    piece.From = ShareAt(line, first.From);
    piece.To = ShareAt(line, last.To);
    if (piece.From != piece.To)
    {
      out.push_back(piece);
    }
    return;
  }
  piece.Polyline.push_back(ParametersAt(line, first.From, this->FaceIndex));
  if (first.From < last.To)
  {
    for (auto k = std::size_t(first.From) + 1; double(k) < last.To; ++k)
    {
      piece.Polyline.push_back(ParametersAt(line, double(k), this->FaceIndex));
    }
  }
  else
  {
    for (auto k = std::int64_t(std::ceil(first.From)) - 1; double(k) > last.To; --k)
    {
      piece.Polyline.push_back(ParametersAt(line, double(k), this->FaceIndex));
    }
  }
  piece.Polyline.push_back(ParametersAt(line, last.To, this->FaceIndex));
  out.push_back(std::move(piece));
}

// A place on the face's sheet beside a half-edge.
Vec2 RegionLifter::Seed(HalfEdge half) const
{
  const FrontHit hit = LookAt(this->Caster, this->Image, this->Map.Beside(half / 2, half % 2));
  return hit.Face == this->FaceIndex ? hit.UV : this->Map.Front(half / 2, half % 2).UV;
}

// Adds points between two of a shadow till the lifted middle is on the chord.
void RegionLifter::RefineShadow(
  const ShadowPoint& a, const ShadowPoint& b, int sheet, int depth, std::vector<Vec2>& out)
{
  const Vec2 straight = 0.5 * (a.UV + b.UV);
  ShadowPoint middle{ 0.5 * (a.Image + b.Image), straight };
  if (!this->Image.Lift(this->Surface, middle.Image, this->Precision, sheet, middle.UV))
  {
    middle.UV = a.UV;
    if (!this->Image.Lift(this->Surface, middle.Image, this->Precision, sheet, middle.UV))
    {
      this->DoubtfulPlaces += this->Miss({ middle.Image, straight }) > this->Precision;
      return;
    }
  }
  if ((this->Point(middle.UV) - this->Point(straight)).norm() <= ShadowChord * this->Precision &&
    (depth <= MaxShadowDepth - SureHalvings ||
      (b.Image - a.Image).norm() <= SureLength * this->Map.Pixel))
  {
    return;
  }
  if (depth == 0)
  {
    ++this->DoubtfulPlaces; // It jumps to another sheet.
    return;
  }
  this->RefineShadow(a, middle, sheet, depth - 1, out);
  out.push_back(middle.UV);
  this->RefineShadow(middle, b, sheet, depth - 1, out);
}

// Each point is found from what is seen beside the border: from the one before, the way may lead to
// another sheet, where two of them part at a cusp of the silhouette that casts the shadow.
void RegionLifter::AddShadow(
  const std::vector<Step>& steps, std::size_t begin, std::size_t end, RegionLoop& out)
{
  const auto image = [&](const Step& step, LinePosition at) {
    return ImageAt(this->Lines.Lines[step.Source->Line], at);
  };
  const auto lift = [&](const Vec2& seed, const Vec2& before, int sheet, ShadowPoint& point) {
    point.UV = seed;
    if (!this->Image.Lift(this->Surface, point.Image, this->Precision, sheet, point.UV))
    {
      ShadowPoint other{ point.Image, before };
      this->Image.Lift(this->Surface, other.Image, this->Precision, sheet, other.UV);
      point = this->Miss(other) < this->Miss(point) ? other : point;
    }
  };
  RegionPiece piece;
  ShadowPoint before{ image(steps[begin], steps[begin].From), Vec2::Zero() };
  for (std::size_t k = begin; k < end; ++k)
  {
    const int sheet = this->IsFlipped(steps[k].Half) ? -1 : 1;
    const Vec2 seed = this->Seed(steps[k].Half);
    if (k == begin)
    {
      // What is seen beside may be far off where there is no room; the border comes from near.
      const bool isFirst = out.empty();
      lift(
        seed, isFirst ? seed : EndOfPiece(this->Lines.Whole.Data, out.back(), true), sheet, before);
      piece.Polyline.push_back(before.UV);
      this->DoubtfulPlaces += this->Miss(before) > this->Precision;
    }
    ShadowPoint next{ image(steps[k], steps[k].To), Vec2::Zero() };
    lift(seed, before.UV, sheet, next);
    if (this->IsFar(before.UV, next.UV))
    {
      // Beyond a seam; its border is as near to the image point, within a few pixels.
      ShadowPoint other{ next.Image, before.UV };
      this->Image.Lift(this->Surface, other.Image, this->Precision, sheet, other.UV);
      next = this->Miss(other) <= SeamReach * this->Precision ? other : next;
    }
    this->DoubtfulPlaces += this->Miss(next) > this->Precision;
    this->RefineShadow(before, next, sheet, MaxShadowDepth, piece.Polyline);
    piece.Polyline.push_back(next.UV);
    before = next;
  }
  out.push_back(std::move(piece));
}

// From one end of a pole or an edge that is seen end-on to the other: a trim curve if one runs there,
// else straight.
RegionPiece RegionLifter::Bridge(const Vec2& from, const Vec2& to) const
{
  const Model& model = this->Lines.Whole.Data;
  const Face& face = model.Faces[this->FaceIndex];
  const Vec2 size(this->Surface.Domain(0).Length(), this->Surface.Domain(1).Length());
  const auto isSame = [&](const Vec2& a, const Vec2& b) {
    return (a - b).cwiseQuotient(size).norm() < SameParameters;
  };
  RegionPiece out;
  for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
  {
    const TrimLoop& loop = model.Loops[l];
    for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
    {
      out.Curve = c;
      const Vec2 first = EndOfPiece(model, out, false);
      const Vec2 last = EndOfPiece(model, out, true);
      if (isSame(first, from) && isSame(last, to) && !isSame(first, last))
      {
        return out;
      }
      if (isSame(first, to) && isSame(last, from) && !isSame(first, last))
      {
        std::swap(out.From, out.To);
        return out;
      }
    }
  }
  out.Curve = -1;
  out.Polyline = { from, to };
  return out;
}

// A piece on the far side of a seam between two that are not: where a line crosses the seam along a
// silhouette, the two run together in the image for a while.
void RegionLifter::DropExcursions(RegionLoop& loop) const
{
  const Model& model = this->Lines.Whole.Data;
  for (std::size_t k = 0; k < loop.size() && loop.size() > 2;)
  {
    const std::size_t before = (k + loop.size() - 1) % loop.size();
    const std::size_t after = (k + 1) % loop.size();
    const Vec2 start = EndOfPiece(model, loop[k], false);
    const Vec2 end = EndOfPiece(model, loop[k], true);
    const Vec2 from = EndOfPiece(model, loop[before], true);
    const Vec2 to = EndOfPiece(model, loop[after], false);
    if (loop[k].Curve < 0 && this->IsFar(from, start) && this->IsFar(end, to) &&
      !this->IsFar(from, to) && !this->IsFar(start, end))
    {
      loop.erase(loop.begin() + std::ptrdiff_t(k));
      k = 0;
    }
    else
    {
      ++k;
    }
  }
}

// True if the straight way from one point to another is a point in the image, as poles and edges that are
// seen end-on are.
bool RegionLifter::IsAtOnePlace(const Vec2& from, const Vec2& to) const
{
  const Vec2 image = this->Image.Project(this->Point(from));
  return this->Miss({ image, 0.5 * (from + to) }) <= this->Precision &&
    this->Miss({ image, to }) <= this->Precision;
}

// Pieces that do not quite meet: a polyline is moved to the other piece's end; if there is none, or
// the gap is wide (along a pole, or an edge that is seen end-on), a straight piece closes it.
void RegionLifter::Close(RegionLoop& loop)
{
  RegionLoop out;
  for (std::size_t k = 0; k < loop.size(); ++k)
  {
    RegionPiece& piece = loop[k];
    RegionPiece& next = loop[(k + 1) % loop.size()];
    const Vec2 end = EndOfPiece(this->Lines.Whole.Data, piece, true);
    const Vec2 start = EndOfPiece(this->Lines.Whole.Data, next, false);
    const bool isNear = (this->Point(end) - this->Point(start)).norm() <= 8.0 * this->Precision &&
      std::abs(end[0] - start[0]) < NearParameters * this->Surface.Domain(0).Length() &&
      std::abs(end[1] - start[1]) < NearParameters * this->Surface.Domain(1).Length();
    // Gaps that the model's own loops may have.
    bool joined =
      std::abs(end[0] - start[0]) <= SameParameters * this->Surface.Domain(0).Length() &&
      std::abs(end[1] - start[1]) <= SameParameters * this->Surface.Domain(1).Length();
    joined = end == start || (joined && piece.Curve >= 0 && next.Curve >= 0);
    if (!joined && isNear && next.Curve < 0 && next.Polyline.size() > 1)
    {
      next.Polyline.front() = end;
      joined = true;
    }
    else if (!joined && isNear && piece.Curve < 0)
    {
      piece.Polyline.back() = start;
      joined = true;
    }
    out.push_back(piece);
    if (!joined)
    {
      out.push_back(this->Bridge(end, start));
      this->DoubtfulPlaces += !this->IsAtOnePlace(end, start);
    }
  }
  // What the first piece became when the last one was joined to it.
  if (!loop.empty())
  {
    out.front() = loop.front();
  }
  loop = std::move(out);
}

RegionLoop RegionLifter::Lift(const std::vector<HalfEdge>& loop)
{
  std::vector<Step> steps;
  for (const HalfEdge half : loop)
  {
    steps.push_back(this->Classify(half));
  }
  // Start where a piece starts, an own one if there is any: shadows start where the one before ends.
  std::size_t start = 0;
  for (std::size_t k = 1; k < steps.size() && (start == 0 || steps[start].IsShadow); ++k)
  {
    start = this->Continues(steps[k - 1], steps[k]) ? start : k;
  }
  std::rotate(steps.begin(), steps.begin() + std::ptrdiff_t(start), steps.end());
  RegionLoop out;
  for (std::size_t first = 0, last = 0; first < steps.size(); first = last)
  {
    for (last = first + 1; last < steps.size() && this->Continues(steps[last - 1], steps[last]);)
    {
      ++last;
    }
    if (steps[first].IsShadow)
    {
      this->AddShadow(steps, first, last, out);
    }
    else
    {
      this->AddOwn(steps[first], steps[last - 1], out);
    }
  }
  this->DropExcursions(out);
  this->Close(out);
  if (!loop.empty() && this->IsFlipped(loop.front()))
  {
    std::reverse(out.begin(), out.end());
    for (RegionPiece& piece : out)
    {
      std::swap(piece.From, piece.To);
      std::reverse(piece.Polyline.begin(), piece.Polyline.end());
    }
  }
  return out;
}

} // namespace

std::vector<TracedRegion> TraceRegions(const ViewLines& lines, const ImagePlane& image,
  const RayCaster& caster, const FrontMap& map, double precision, bool bothSides,
  const ParallelFor& parallel)
{
  const std::vector<std::vector<std::vector<HalfEdge>>> loops =
    BorderTracer(lines, map, bothSides).Trace();
  std::vector<TracedRegion> out(loops.size());
  parallel(0, std::int64_t(loops.size()), [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t f = begin; f < end; ++f)
    {
      RegionLifter lifter(lines, image, caster, map, precision, f);
      for (const std::vector<HalfEdge>& loop : loops[f])
      {
        out[f].Loops.push_back(lifter.Lift(loop));
      }
      out[f].Doubtful = lifter.Doubtful();
    }
  });
  return out;
}

} // namespace nurbs
