// SPDX-License-Identifier: BSD-3-Clause
#include "VisibleRegions.h"

#include "RegionArea.h"
#include "RegionCells.h"
#include "VisibleParts.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace nurbs
{

namespace
{

// Chords of lines, and pixels, as shares of the precision: together they are within it.
constexpr double ChordShare = 0.25;
constexpr double PixelShare = 0.5;
// Shorter pieces of a line, in pixels, go with their neighbours.
constexpr double ShortestPiece = 2.0;
// The finest precision, as a share of the image: half an image is 2^29 pixels at most.
constexpr double FinestShare = 1.0 / 536870912.0;
// Coordinates are rounded to this share of their size; the precision must be ten times that.
constexpr double RoundingShare = 4e-16;
// Shares of the whole that progress counts for the steps.
constexpr double LinesDone = 0.2;
constexpr double PartsDone = 0.6;
constexpr double MapDone = 0.8;
constexpr double FacesDone = 0.95;

// A part of a line between two positions.
struct Piece
{
  LinePosition From, To;
  bool Visible;
  bool IsOutline; // Of a smooth edge: a surface ends there in the image, as at a silhouette.
};

bool IsAlike(const Piece& a, const Piece& b)
{
  return a.Visible == b.Visible && a.IsOutline == b.IsOutline;
}

// The larger side of the image of a box.
double ImageSize(const ImagePlane& image, const Box3& box)
{
  Box2 out;
  for (int k = 0; k < 8; ++k)
  {
    out.extend(image.Project(box.corner(Box3::CornerType(k))));
  }
  return out.diagonal().maxCoeff();
}

// All steps of one call.
class RegionMaker
{
public:
  RegionMaker(const Model& model, const std::vector<std::string>& faceErrors,
    const VisibleRegionOptions& options, VisibilityCache& cache)
    : Source(model)
    , FaceErrors(faceErrors)
    , Options(options)
    , Cache(cache)
    , Caster(CasterOf(model, options.Parallel, cache))
    , Image(options.View, options.Up, this->Bounds())
  {}

  VisibleRegions Run();

private:
  static const RayCaster& CasterOf(
    const Model& model, const ParallelFor& parallel, VisibilityCache& cache)
  {
    if (!cache.Caster)
    {
      cache.Caster =
        std::make_shared<const RayCaster>(model, RayCaster::Cutting::WhenMet, parallel);
    }
    return *cache.Caster;
  }
  Box3 Bounds() const
  {
    const Box3& box = this->Caster.Bounds();
    return box.isEmpty() ? Box3(Vec3::Zero(), Vec3::Zero()) : box;
  }
  void CheckPrecision() const;
  bool Report(double done) const { return !this->Options.Progress || this->Options.Progress(done); }
  bool MakeLines();
  std::vector<LinePart> PartsInView(double pixel);
  bool MakeMap();
  void FindShownFaces();
  void FillFace(const RegionCells& cells, std::int64_t index, TracedRegion traced);
  bool FillFaces();
  bool IsOutline(const ViewLine& line, const LineSource& source, std::int32_t edge) const;
  std::vector<Piece> PiecesOf(std::int64_t line) const;
  void DrawLine(std::int64_t line, std::vector<DrawnLine>& out) const;
  bool DrawLines();

  const Model& Source;
  const std::vector<std::string>& FaceErrors;
  const VisibleRegionOptions& Options;
  VisibilityCache& Cache;
  const RayCaster& Caster;
  ImagePlane Image;
  FrontMap Map;
  /// One a face: a line of its own is visible, so that it may be, though it may have no cell.
  std::vector<char> HasShownLine;
  /// For so long, in the image, a smooth edge that runs into a silhouette may be one with it.
  double Touching = 0.0;
  VisibleRegions Out;
};

// Lines of a finer precision would take very long before snapping them fails.
void RegionMaker::CheckPrecision() const
{
  const Box3 box = this->Bounds();
  const double size = ImageSize(this->Image, box);
  const double least = FinestShare * size;
  std::ostringstream problem;
  if (!(this->Options.Precision >= least))
  {
    problem << "The precision is finer than 2e-9 of the image's size: it must be " << least
            << " or more, but is " << this->Options.Precision;
    throw Error(problem.str());
  }
  const double farthest =
    std::max({ box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff(),
      this->Options.View.Perspective ? this->Options.View.Place.cwiseAbs().maxCoeff() : 0.0 });
  if (!(this->Options.Precision >= 10.0 * RoundingShare * farthest))
  {
    problem << "The eye or the model is too far from the origin: coordinates of " << farthest
            << " are not told to the precision of " << this->Options.Precision;
    throw Error(problem.str());
  }
}

bool RegionMaker::MakeLines()
{
  SilhouetteOptions options;
  options.View = this->Options.View;
  options.Precision = ChordShare * this->Options.Precision;
  options.FeatureAngle = this->Options.FeatureAngle;
  options.MaximumCells = this->Options.MaximumCells;
  options.Parts = this->Options.Parts;
  options.Parallel = this->Options.Parallel;
  options.Share = this->Options.Share;
  options.Progress = [&](double done) { return this->Report(LinesDone * done); };
  this->Out.Lines = MakeViewLines(this->Source, this->Caster.GetTrims(), this->FaceErrors, options,
    this->Image, this->Options.Regions || this->Options.SmoothLines,
    this->Cache.Precision == this->Options.Precision ? this->Cache.Intersections : nullptr);
  if (this->Out.Lines.Aborted)
  {
    return false;
  }
  this->Cache.Intersections = this->Out.Lines.Intersections;
  this->Cache.Precision = this->Options.Precision;
  return true;
}

std::vector<LinePart> RegionMaker::PartsInView(double pixel)
{
  const FaceClusters clusters = FindClusters(this->Out.Lines, this->Image.GetViewer());
  return FindVisibleParts(this->Out.Lines, clusters, this->Image, this->Caster, pixel,
    this->Options.Parallel,
    [&](double done) { return this->Report(LinesDone + (PartsDone - LinesDone) * done); });
}

bool RegionMaker::MakeMap()
{
  const double pixel = PixelShare * this->Options.Precision;
  const auto make = [&]() {
    const double start = this->Options.Clustering ? PartsDone : LinesDone;
    const std::vector<LinePart> parts =
      this->Options.Clustering ? this->PartsInView(pixel) : LinesInView(this->Out.Lines);
    this->Map =
      MakeFrontMap(this->Out.Lines, parts, this->Image, this->Caster, pixel, this->Options.Parallel,
        [&](double done) { return this->Report(start + (MapDone - start) * done); });
    return !this->Map.Cells.empty();
  };
  if (!make())
  {
    return false;
  }
  // A shell that is inside out, or is looked into through a gap: nothing of it is behind.
  bool isInsideOut = false;
  for (std::int32_t c = 0; c < this->Map.Plane.CellCount; ++c)
  {
    const FrontHit& front = this->Map.Cells[c];
    isInsideOut = isInsideOut ||
      (front.Face >= 0 && front.FromBehind && this->Out.Lines.IsShell[front.Face] &&
        !this->Map.IsSliver(c));
  }
  const bool hasBehind = std::any_of(this->Out.Lines.Lines.begin(), this->Out.Lines.Lines.end(),
    [](const ViewLine& line) { return line.IsBehind; });
  if (isInsideOut && hasBehind)
  {
    for (ViewLine& line : this->Out.Lines.Lines)
    {
      line.IsBehind = false;
    }
    if (!make())
    {
      return false;
    }
  }
  AbsorbSlivers(this->Out.Lines, this->Map);
  FindShownLines(this->Out.Lines, this->Image, this->Caster, this->Map, this->Options.Parallel);
  return true;
}

// True if the loops are all trim curves, whole, and nothing else.
bool IsWhole(const Model& model, std::int64_t index, const std::vector<RegionLoop>& loops)
{
  std::int64_t curves = 0;
  for (const RegionLoop& loop : loops)
  {
    for (const RegionPiece& piece : loop)
    {
      if (piece.Curve < 0 || std::abs(piece.To - piece.From) != 1.0)
      {
        return false;
      }
      ++curves;
    }
  }
  const Face& face = model.Faces[index];
  for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
  {
    curves -= model.Loops[l].CurveCount;
  }
  return curves == 0 && !loops.empty();
}

// A face that is narrower than a pixel has no cell, but its borders are visible, or there is no room
// beside them.
void RegionMaker::FindShownFaces()
{
  const ViewLines& lines = this->Out.Lines;
  this->HasShownLine.assign(lines.Whole.Data.Faces.size(), 0);
  const auto mark = [&](std::int64_t face) {
    this->HasShownLine[face] |= !lines.IsShell[face] || MayFaceViewer(lines.Faces[face]);
  };
  for (std::int32_t edge = 0; edge < std::int32_t(this->Map.Snapped.Edges.size()); ++edge)
  {
    const bool isNarrow =
      this->Map.IsSliver(this->Map.Cell(edge, 0)) || this->Map.IsSliver(this->Map.Cell(edge, 1));
    for (const LineSource& source : this->Map.SourcesOf(edge))
    {
      if (source.Shows == 0 && !source.IsBare && !isNarrow)
      {
        continue;
      }
      const ViewLine& line = lines.Lines[source.Line];
      mark(line.Face);
      if (line.IsIntersection())
      {
        mark(line.OtherFace);
      }
      for (std::size_t k = 0; line.IsEdge() && k < lines.Uses[line.Edge].size(); ++k)
      {
        mark(lines.Uses[line.Edge][k].Face);
      }
    }
  }
}

// The region of one face, of what was traced in the image.
void RegionMaker::FillFace(const RegionCells& cells, std::int64_t index, TracedRegion traced)
{
  const Model& model = this->Out.Lines.Whole.Data;
  FaceRegion& face = this->Out.Faces[index];
  SettledRegions settled;
  face.IsWhole = IsWhole(model, index, traced.Loops);
  if (face.IsWhole)
  {
    settled.Visible = std::move(traced.Loops);
  }
  else if (traced.Loops.empty() && !this->HasShownLine[index])
  {
    settled.Hidden = WholeRegion(model, index);
  }
  else
  {
    settled = cells.Settle(index, traced, this->Options.HiddenRegions);
    DropFlatLoops(model, index, settled.Visible);
    face.IsInexact = settled.Unsettled > 0;
    face.IsWhole = IsWhole(model, index, settled.Visible);
  }
  if (!settled.Visible.empty())
  {
    FaceArea area(model, index);
    face.Area = area.Of(WholeRegion(model, index));
    face.VisibleArea = face.IsWhole ? face.Area : area.Of(settled.Visible);
  }
  face.Loops = std::move(this->Options.HiddenRegions ? settled.Hidden : settled.Visible);
  DropFlatLoops(model, index, face.Loops);
}

void PutRegion(const FaceRegion& face, MessageWriter& message)
{
  const double numbers[] = { face.IsWhole ? 1.0 : 0.0, face.IsInexact ? 1.0 : 0.0, face.Area,
    face.VisibleArea };
  message.Put(numbers, 4);
  std::vector<std::int64_t> sizes;
  for (const RegionLoop& loop : face.Loops)
  {
    sizes.push_back(std::int64_t(loop.size()));
  }
  message.Put(sizes);
  for (const RegionLoop& loop : face.Loops)
  {
    for (const RegionPiece& piece : loop)
    {
      message.Put(&piece.Curve, 1);
      const double range[] = { piece.From, piece.To };
      message.Put(range, 2);
      message.Put(piece.Polyline);
    }
  }
}

void GetRegion(FaceRegion& face, MessageReader& message)
{
  std::vector<double> numbers;
  std::vector<std::int64_t> sizes, curve;
  message.Get(numbers);
  message.Get(sizes);
  face.IsWhole = numbers[0] != 0.0;
  face.IsInexact = numbers[1] != 0.0;
  face.Area = numbers[2];
  face.VisibleArea = numbers[3];
  for (const std::int64_t size : sizes)
  {
    face.Loops.emplace_back(std::size_t(size));
    for (RegionPiece& piece : face.Loops.back())
    {
      message.Get(curve);
      message.Get(numbers);
      message.Get(piece.Polyline);
      piece.Curve = curve[0];
      piece.From = numbers[0];
      piece.To = numbers[1];
    }
  }
}

bool RegionMaker::FillFaces()
{
  const ViewLines& lines = this->Out.Lines;
  std::vector<TracedRegion> traced =
    TraceRegions(lines, this->Image, this->Caster, this->Map, this->Options.Precision,
      this->Options.BothSides, ForOwn(this->Options.Share, this->Options.Parallel));
  this->Out.Faces.resize(traced.size());
  this->FindShownFaces();
  const RegionCells cells(
    lines, this->Image, this->Caster, this->Options.Precision, this->Options.BothSides);
  ForShared(
    this->Options.Share, this->Options.Parallel, std::int64_t(traced.size()),
    [&](std::int64_t f) { this->FillFace(cells, f, std::move(traced[f])); },
    [&](std::int64_t f, MessageWriter& message) { PutRegion(this->Out.Faces[f], message); },
    [&](std::int64_t f, MessageReader& message) { GetRegion(this->Out.Faces[f], message); });
  std::vector<std::vector<RegionLoop>> regions(this->Out.Faces.size());
  for (std::size_t f = 0; f < regions.size(); ++f)
  {
    regions[f] = std::move(this->Out.Faces[f].Loops);
  }
  CutAtSharedEnds(lines, regions);
  for (std::size_t f = 0; f < regions.size(); ++f)
  {
    this->Out.Faces[f].Loops = std::move(regions[f]);
  }
  return this->Report(FacesDone);
}

// True if a smooth edge is what a silhouette would be: its surfaces are seen on one side of it only. Faces
// may end just where they turn away, and have no silhouette of their own.
bool RegionMaker::IsOutline(const ViewLine& line, const LineSource& source, std::int32_t edge) const
{
  if (line.Kind != LineKind::Smooth || (source.Shows != 1 && source.Shows != 2))
  {
    return false;
  }
  const ArrayView<LineSource> sources = this->Map.SourcesOf(edge);
  return std::none_of(sources.begin(), sources.end(), [&](const LineSource& other) {
    return this->Out.Lines.Lines[other.Line].Kind != LineKind::Smooth &&
      (other.Shows != 0 || other.IsBare);
  });
}

// What of a line is visible, in order.
std::vector<Piece> RegionMaker::PiecesOf(std::int64_t index) const
{
  const ViewLine& line = this->Out.Lines.Lines[index];
  const SnappedSegments& snapped = this->Map.Snapped;
  std::vector<Piece> out;
  double reached = 0.0;
  const auto add = [&](LinePosition to, bool visible, bool isOutline) {
    const Piece piece{ reached, to, visible, isOutline };
    if (to > reached && !out.empty() && IsAlike(out.back(), piece))
    {
      out.back().To = to;
    }
    else if (to > reached)
    {
      out.push_back(piece);
    }
    reached = std::max(reached, to);
  };
  for (std::int64_t s = this->Map.FirstSegment[index]; s < this->Map.FirstSegment[index + 1]; ++s)
  {
    const LinePart& segment = this->Map.Segments[s];
    add(segment.From, false, false);
    for (std::int64_t p = snapped.PathStart[s]; p < snapped.PathStart[s + 1]; ++p)
    {
      const bool backward = snapped.Path[p] < 0;
      const std::int32_t edge = FrontMap::EdgeOf(snapped.Path[p]);
      const LineSource& source = this->Map.SourceOf(edge, s);
      add(p + 1 == snapped.PathStart[s + 1]
          ? segment.To
          : this->Map.At(this->Out.Lines.Lines, source, snapped.Edges[edge][backward ? 0 : 1]),
        source.Shows != 0 || source.IsBare, this->IsOutline(line, source, edge));
    }
  }
  // What is in no part, or too short in the image to have a path.
  add(double(line.Points.size() - 1), false, false);
  return out;
}

// In the image; more than `enough` is not told.
double Length(const ViewLine& line, const Piece& piece, double enough)
{
  double sum = 0.0;
  Vec2 before = ImageAt(line, piece.From);
  for (auto k = std::size_t(piece.From) + 1; double(k) < piece.To && sum < enough; ++k)
  {
    sum += (line.Image[k] - before).norm();
    before = line.Image[k];
  }
  return sum + (ImageAt(line, piece.To) - before).norm();
}

// Drops pieces that are too short to be told from nothing.
void DropShortPieces(const ViewLine& line, double shortest, std::vector<Piece>& pieces)
{
  std::vector<Piece> kept;
  for (Piece piece : pieces)
  {
    const bool isShort = pieces.size() > 1 && Length(line, piece, shortest) < shortest;
    if (!kept.empty() && (isShort || IsAlike(kept.back(), piece)))
    {
      kept.back().To = piece.To;
    }
    else if (!isShort || piece.To == pieces.back().To)
    {
      piece.From = kept.empty() ? 0.0 : piece.From;
      kept.push_back(piece);
    }
  }
  pieces = std::move(kept);
}

// Makes one of pieces that follow each other and are alike.
void MergeAlike(std::vector<Piece>& pieces)
{
  std::vector<Piece> merged;
  for (const Piece& piece : pieces)
  {
    if (!merged.empty() && IsAlike(merged.back(), piece))
    {
      merged.back().To = piece.To;
    }
    else
    {
      merged.push_back(piece);
    }
  }
  pieces = std::move(merged);
}

void RegionMaker::DrawLine(std::int64_t index, std::vector<DrawnLine>& out) const
{
  const ViewLine& line = this->Out.Lines.Lines[index];
  std::vector<Piece> pieces = line.IsBehind
    ? std::vector<Piece>{ { 0.0, double(line.Points.size() - 1), false, false } }
    : this->PiecesOf(index);
  DropShortPieces(line, ShortestPiece * this->Map.Pixel, pieces);
  for (Piece& piece : pieces)
  {
    piece.IsOutline = piece.IsOutline && Length(line, piece, this->Touching) > this->Touching;
  }
  MergeAlike(pieces);
  for (const Piece& piece : pieces)
  {
    DrawnLine drawn;
    drawn.Kind = piece.IsOutline ? LineKind::Silhouette : line.Kind;
    drawn.Visible = piece.Visible;
    drawn.Face = line.Face;
    drawn.Edge = line.Edge < this->Out.Lines.Whole.KnownEdges ? line.Edge : -1;
    const bool startsAtPoint = piece.From == std::floor(piece.From);
    drawn.Points.push_back(startsAtPoint ? line.Points[std::size_t(piece.From)]
                                         : ExactPointAt(this->Out.Lines, line, piece.From));
    for (auto k = std::size_t(piece.From) + 1; double(k) < piece.To; ++k)
    {
      drawn.Points.push_back(line.Points[k]);
    }
    const bool endsAtPoint = piece.To == std::floor(piece.To);
    drawn.Points.push_back(endsAtPoint ? line.Points[std::size_t(piece.To)]
                                       : ExactPointAt(this->Out.Lines, line, piece.To));
    out.push_back(std::move(drawn));
  }
}

bool RegionMaker::DrawLines()
{
  this->Touching = std::sqrt(8.0 * this->Map.Pixel * this->Out.Lines.Box().diagonal().norm());
  for (std::size_t l = 0; l < this->Out.Lines.Lines.size(); ++l)
  {
    this->DrawLine(std::int64_t(l), this->Out.Drawn);
  }
  return this->Report(1.0);
}

VisibleRegions RegionMaker::Run()
{
  this->CheckPrecision();
  if (!this->MakeLines() || !this->MakeMap() || !this->Report(MapDone) ||
    (this->Options.Regions && !this->FillFaces()) || !this->DrawLines())
  {
    this->Out = VisibleRegions();
    this->Out.Aborted = true;
    return std::move(this->Out);
  }
  this->Out.Image = this->Image;
  this->Out.Piercing = this->Map.Piercing;
  for (std::array<std::int64_t, 2> pair : this->Out.Lines.Unresolved)
  {
    std::sort(pair.begin(), pair.end());
    this->Out.Piercing.push_back(pair);
  }
  std::sort(this->Out.Piercing.begin(), this->Out.Piercing.end());
  this->Out.Piercing.erase(
    std::unique(this->Out.Piercing.begin(), this->Out.Piercing.end()), this->Out.Piercing.end());
  this->Out.Cells = this->Map.Plane.CellCount;
  return std::move(this->Out);
}

} // namespace

VisibleRegions MakeVisibleRegions(const Model& model, const std::vector<std::string>& faceErrors,
  const VisibleRegionOptions& options, VisibilityCache* cache)
{
  if (!(options.Precision > 0.0) || !std::isfinite(options.Precision))
  {
    throw Error("The precision must be positive, but is " + std::to_string(options.Precision));
  }
  VisibilityCache own;
  return RegionMaker(model, faceErrors, options, cache ? *cache : own).Run();
}

} // namespace nurbs
