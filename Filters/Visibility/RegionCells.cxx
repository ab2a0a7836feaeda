// SPDX-License-Identifier: BSD-3-Clause
#include "RegionCells.h"

#include "HalfEdges.h"
#include "RegionArea.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace nurbs
{

namespace
{

// The domain is so many pixels wide.
constexpr double DomainPixels = 268435456.0;
// A cell is looked at where there is most room in each of so many parts of its width and height, if
// there is room for a circle of this share of the largest one.
constexpr int LooksAcross = 3;
constexpr double LeastShare = 0.125;
// Cells without a circle of so many pixels go with a neighbour.
constexpr double LeastRadius = 1.0;
// How far what is seen may be from the point that is looked for, as a share of the model's size: rays
// that graze a surface meet it to the square root of rounding.
constexpr double SamePoint = 1e-6;
// Chords of trim curves, as a share of the precision, and how often they are halved at most.
constexpr double ChordShare = 0.125;
constexpr int MaxChordDepth = 12;

// A segment of the map.
struct DomainSegment
{
  std::int64_t Curve = -1;     // Trim curve; -1: a line within the face.
  double From = 0.0, To = 1.0; // Shares of the curve's domain at its ends.
  bool IsTrim = false;         // The face ends there; also gaps between trim curves.
};

// A segment that runs along an edge of the map.
struct DomainSource
{
  std::int32_t Segment = 0;
  bool Backward = false;
};

enum class Sight : char
{
  Outside,
  Unknown,
  Hidden,
  Visible
};

// The map of one face's domain.
class FaceCells
{
public:
  FaceCells(const Model& model, std::int64_t face, double precision)
    : Data(model)
    , Index(face)
    , Surface(model.Faces[face].Geometry)
    , Precision(precision)
    , Corner(this->Surface.Domain(0).Min, this->Surface.Domain(1).Min)
    , Size(this->Surface.Domain(0).Length(), this->Surface.Domain(1).Length())
  {}

  void AddTrims(const std::vector<RegionLoop>& traced);
  void AddPolyline(const std::vector<Vec2>& points);
  /// Divides the domain and looks at the cells within the face; returns how many of them are seen in one
  /// place and not in another.
  std::int64_t Look(const std::function<bool(const Vec2&)>& isSeen);
  bool All(Sight sight) const;
  std::vector<RegionLoop> Loops(Sight sight) const;

private:
  GridPoint ToGrid(const Vec2& uv) const;
  Vec2 ToDomain(const Vec2& grid) const
  {
    return this->Corner + (grid / DomainPixels + Vec2(0.5, 0.5)).cwiseProduct(this->Size);
  }
  void AddPoint(const Vec2& uv);
  void AddSegment(const DomainSegment& segment);
  std::vector<double> SharesOf(std::int64_t curve, std::vector<double> cuts) const;
  void AddChords(const BezierCurve<2>& piece, double s, double t, int depth,
    const std::function<void(double)>& add) const;
  Vec2 OnCurve(std::int64_t curve, double share) const;
  void MakeMap();
  void Divide(const std::vector<char>& cells);
  std::vector<PlanarSample> LooksOf(std::int32_t cell) const;
  std::vector<char> LookAtCells(const std::function<bool(const Vec2&)>& isSeen);
  void CollectSources();
  void PlaceVertices();
  void FindInside();
  void JoinUnknown();
  double ShareAt(const DomainSource& source, std::int32_t vertex) const;
  std::int32_t SourceOf(HalfEdge half) const;
  RegionLoop LoopOf(std::vector<HalfEdge> halves) const;

  const Model& Data;
  std::int64_t Index;
  const SurfaceView& Surface;
  double Precision;
  Vec2 Corner, Size; // Of the domain.
  std::vector<GridPoint> Points;
  std::vector<Vec2> Exact; // One a point.
  std::vector<GridSegment> Segments;
  std::vector<DomainSegment> Origins; // One a segment.
  SnappedSegments Snapped;
  PlanarMap Plane;
  std::vector<std::int64_t> SourceStart; // One an edge, into Sources; and the end.
  std::vector<DomainSource> Sources;
  std::vector<Vec2> Places;  // One a vertex.
  std::vector<Sight> Sights; // One a cell.
};

GridPoint FaceCells::ToGrid(const Vec2& uv) const
{
  GridPoint out;
  const Vec2 share = (uv - this->Corner).cwiseQuotient(this->Size) - Vec2(0.5, 0.5);
  out.X = std::llround(DomainPixels * std::clamp(share[0], -1.0, 1.0));
  out.Y = std::llround(DomainPixels * std::clamp(share[1], -1.0, 1.0));
  return out;
}

void FaceCells::AddPoint(const Vec2& uv)
{
  this->Points.push_back(this->ToGrid(uv));
  this->Exact.push_back(uv);
}

// Between the last two points.
void FaceCells::AddSegment(const DomainSegment& segment)
{
  const auto last = std::int32_t(this->Points.size() - 1);
  this->Segments.push_back({ last - 1, last });
  this->Origins.push_back(segment);
}

void FaceCells::AddPolyline(const std::vector<Vec2>& points)
{
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    this->AddPoint(points[k]);
    if (k > 0)
    {
      this->AddSegment(DomainSegment());
    }
  }
}

Vec2 FaceCells::OnCurve(std::int64_t curve, double share) const
{
  RegionPiece piece;
  piece.Curve = curve;
  piece.To = share;
  return EndOfPiece(this->Data, piece, true);
}

// Calls `add` for places within (s, t) of a piece, till its chords are near to it on the surface.
void FaceCells::AddChords(const BezierCurve<2>& piece, double s, double t, int depth,
  const std::function<void(double)>& add) const
{
  const double middle = 0.5 * (s + t);
  const Vec2 straight = 0.5 * (piece.Evaluate(s) + piece.Evaluate(t));
  const Vec2 exact = piece.Evaluate(middle);
  const auto lift = [&](const Vec2& uv) { return Evaluate(this->Surface, uv[0], uv[1]); };
  if (depth == 0 || (lift(exact) - lift(straight)).norm() <= ChordShare * this->Precision)
  {
    return;
  }
  this->AddChords(piece, s, middle, depth - 1, add);
  add(middle);
  this->AddChords(piece, middle, t, depth - 1, add);
}

// The shares of a trim curve between which its chords are near to it, with the cuts among them.
std::vector<double> FaceCells::SharesOf(std::int64_t curve, std::vector<double> cuts) const
{
  const CurveView<2>& geometry = this->Data.TrimCurves[curve].Geometry;
  const Interval domain = geometry.Domain();
  std::vector<double> out = std::move(cuts);
  out.insert(out.end(), { 0.0, 1.0 });
  for (const BezierCurve<2>& piece : ToBezier(geometry))
  {
    const auto add = [&](double s) {
      const double t = piece.T0 + s * (piece.T1 - piece.T0);
      out.push_back(std::clamp((t - domain.Min) / domain.Length(), 0.0, 1.0));
    };
    add(0.0);
    // An S-bend may pass through the middle of its chord.
    const int parts = piece.Degree() > 1 ? piece.Degree() : 1;
    for (int k = 0; k < parts; ++k)
    {
      const double s = double(k) / parts;
      const double t = double(k + 1) / parts;
      if (k > 0)
      {
        add(s);
      }
      if (parts > 1)
      {
        this->AddChords(piece, s, t, MaxChordDepth, add);
      }
    }
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

void FaceCells::AddTrims(const std::vector<RegionLoop>& traced)
{
  std::map<std::int64_t, std::vector<double>> cuts;
  for (const RegionLoop& loop : traced)
  {
    for (const RegionPiece& piece : loop)
    {
      if (piece.Curve >= 0)
      {
        cuts[piece.Curve].push_back(piece.From);
        cuts[piece.Curve].push_back(piece.To);
      }
    }
  }
  const Face& face = this->Data.Faces[this->Index];
  for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
  {
    const TrimLoop& loop = this->Data.Loops[l];
    const std::size_t first = this->Points.size();
    for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
    {
      std::vector<double> shares = this->SharesOf(c, cuts[c]);
      if (this->Data.TrimCurves[c].Reversed)
      {
        std::reverse(shares.begin(), shares.end());
      }
      for (std::size_t k = 0; k < shares.size(); ++k)
      {
        this->AddPoint(this->OnCurve(c, shares[k]));
        if (k > 0)
        {
          this->AddSegment({ c, shares[k - 1], shares[k], true });
        }
        else if (c > loop.FirstCurve)
        {
          this->AddSegment({ -1, 0.0, 1.0, true }); // The gap to the curve before.
        }
      }
    }
    if (this->Points.size() > first)
    {
      const Vec2 start = this->Exact[first];
      this->AddPoint(start);
      this->AddSegment({ -1, 0.0, 1.0, true });
    }
  }
}

void FaceCells::CollectSources()
{
  const SnappedSegments& snapped = this->Snapped;
  this->SourceStart.assign(snapped.Edges.size() + 1, 0);
  const auto edgeOf = [](std::int32_t entry) { return entry < 0 ? ~entry : entry; };
  for (const std::int32_t entry : snapped.Path)
  {
    ++this->SourceStart[edgeOf(entry) + 1];
  }
  std::partial_sum(this->SourceStart.begin(), this->SourceStart.end(), this->SourceStart.begin());
  this->Sources.resize(snapped.Path.size());
  std::vector<std::int64_t> next(this->SourceStart.begin(), this->SourceStart.end() - 1);
  for (std::size_t s = 0; s < this->Segments.size(); ++s)
  {
    for (std::int64_t p = snapped.PathStart[s]; p < snapped.PathStart[s + 1]; ++p)
    {
      this->Sources[next[edgeOf(snapped.Path[p])]++] = { std::int32_t(s), snapped.Path[p] < 0 };
    }
  }
}

// Vertices that are points of the input are where those are, before rounding: trim curves first.
void FaceCells::PlaceVertices()
{
  const std::vector<GridPoint>& vertices = this->Snapped.Vertices;
  this->Places.resize(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v)
  {
    this->Places[v] = this->ToDomain(Vec2(double(vertices[v].X), double(vertices[v].Y)));
  }
  for (const bool trims : { false, true })
  {
    for (std::size_t s = 0; s < this->Segments.size(); ++s)
    {
      for (const std::int32_t point : { this->Segments[s].Start, this->Segments[s].End })
      {
        const auto at = std::lower_bound(vertices.begin(), vertices.end(), this->Points[point]);
        if (this->Origins[s].IsTrim == trims && at != vertices.end() && *at == this->Points[point])
        {
          this->Places[at - vertices.begin()] = this->Exact[point];
        }
      }
    }
  }
}

// Cells are within the face if an odd number of its borders lies between them and the outside.
void FaceCells::FindInside()
{
  std::vector<std::int64_t> first(this->Plane.CellCount + 1, 0);
  const auto count = HalfEdge(2 * this->Plane.Sides.size());
  for (HalfEdge h = 0; h < count; ++h)
  {
    ++first[this->Plane.Sides[h / 2][h % 2] + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<HalfEdge> halves(count);
  std::vector<std::int64_t> next(first.begin(), first.end() - 1);
  for (HalfEdge h = 0; h < count; ++h)
  {
    halves[next[this->Plane.Sides[h / 2][h % 2]]++] = h;
  }
  this->Sights.assign(this->Plane.CellCount, Sight::Outside);
  std::vector<char> known(this->Plane.CellCount, 0);
  std::vector<std::int32_t> waiting{ 0 };
  known[0] = 1;
  while (!waiting.empty())
  {
    const std::int32_t cell = waiting.back();
    waiting.pop_back();
    for (std::int64_t n = first[cell]; n < first[cell + 1]; ++n)
    {
      const HalfEdge half = halves[n];
      const std::int32_t other = this->Plane.Sides[half / 2][1 - half % 2];
      if (known[other])
      {
        continue;
      }
      bool isInside = this->Sights[cell] != Sight::Outside;
      for (std::int64_t k = this->SourceStart[half / 2]; k < this->SourceStart[half / 2 + 1]; ++k)
      {
        isInside = isInside != this->Origins[this->Sources[k].Segment].IsTrim;
      }
      this->Sights[other] = isInside ? Sight::Unknown : Sight::Outside;
      known[other] = 1;
      waiting.push_back(other);
    }
  }
}

void FaceCells::MakeMap()
{
  this->Plane = MakePlanarMap(this->Snapped, std::numeric_limits<int>::max(), nullptr, true);
  this->CollectSources();
  this->PlaceVertices();
  this->FindInside();
}

// Makes edges of the sides of all triangles of some cells.
void FaceCells::Divide(const std::vector<char>& cells)
{
  std::vector<std::array<std::int32_t, 2>> edges = this->Snapped.Edges;
  for (const PlanarDiagonal& diagonal : this->Plane.Diagonals)
  {
    if (cells[diagonal.Cell])
    {
      edges.push_back({ diagonal.Start, diagonal.End });
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::int32_t& entry : this->Snapped.Path)
  {
    const auto& old = this->Snapped.Edges[entry < 0 ? ~entry : entry];
    const auto now =
      std::int32_t(std::lower_bound(edges.begin(), edges.end(), old) - edges.begin());
    entry = entry < 0 ? ~now : now;
  }
  this->Snapped.Edges = std::move(edges);
}

// Where to look at a cell, most room first.
std::vector<PlanarSample> FaceCells::LooksOf(std::int32_t cell) const
{
  const std::vector<PlanarSample>& samples = this->Plane.Samples;
  const std::int64_t first = this->Plane.SampleStart[cell];
  const std::int64_t last = this->Plane.SampleStart[cell + 1];
  const double least = std::max(LeastRadius, LeastShare * samples[first].Radius);
  Box2 box;
  for (std::int64_t k = first; k < last && samples[k].Radius >= least; ++k)
  {
    box.extend(samples[k].Point);
  }
  std::vector<PlanarSample> out;
  std::array<char, std::size_t(LooksAcross * LooksAcross)> taken{};
  for (std::int64_t k = first; k < last && samples[k].Radius >= least; ++k)
  {
    const Vec2 share = (samples[k].Point - box.min()).cwiseQuotient(box.sizes().cwiseMax(1.0));
    const int column = std::min(int(share[0] * LooksAcross), LooksAcross - 1);
    const int row = std::min(int(share[1] * LooksAcross), LooksAcross - 1);
    char& isTaken = taken[std::size_t(row * LooksAcross + column)];
    if (!isTaken)
    {
      out.push_back(samples[k]);
      isTaken = 1;
    }
  }
  return out;
}

// Looks at each cell; true for those that are seen in one place and not in another.
std::vector<char> FaceCells::LookAtCells(const std::function<bool(const Vec2&)>& isSeen)
{
  std::vector<char> mixed(this->Plane.CellCount, 0);
  for (std::int32_t c = 1; c < this->Plane.CellCount; ++c)
  {
    if (this->Sights[c] == Sight::Outside)
    {
      continue;
    }
    double sum = 0.0;
    for (const PlanarSample& look : this->LooksOf(c))
    {
      const double vote =
        (isSeen(this->ToDomain(look.Point)) ? 1.0 : -1.0) * look.Radius * look.Radius;
      mixed[c] |= vote * sum < 0.0;
      sum += vote;
      this->Sights[c] = sum > 0.0 ? Sight::Visible : Sight::Hidden;
    }
  }
  return mixed;
}

std::int64_t FaceCells::Look(const std::function<bool(const Vec2&)>& isSeen)
{
  this->Snapped = SnapRound(this->Points, this->Segments);
  this->MakeMap();
  const std::vector<char> mixed = this->LookAtCells(isSeen);
  const auto count = std::count(mixed.begin(), mixed.end(), 1);
  if (count > 0)
  {
    // A line is missing, or has a gap: it runs along sides of triangles, then.
    this->Divide(mixed);
    this->MakeMap();
    this->LookAtCells(isSeen);
  }
  this->JoinUnknown();
  return count;
}

// Gives cells without room for a look to the neighbour with which they share most border.
void FaceCells::JoinUnknown()
{
  const auto length = [&](std::size_t edge) {
    const GridPoint& a = this->Snapped.Vertices[this->Snapped.Edges[edge][0]];
    const GridPoint& b = this->Snapped.Vertices[this->Snapped.Edges[edge][1]];
    return std::hypot(double(b.X - a.X), double(b.Y - a.Y));
  };
  const auto isUnknown = [&](HalfEdge half) {
    return this->Sights[this->Plane.Sides[half / 2][half % 2]] == Sight::Unknown;
  };
  std::vector<HalfEdge> halves;
  for (HalfEdge h = 0; h < HalfEdge(2 * this->Plane.Sides.size()); ++h)
  {
    if (isUnknown(h) && this->Sights[this->Plane.Sides[h / 2][1 - h % 2]] != Sight::Outside)
    {
      halves.push_back(h);
    }
  }
  for (std::size_t before = halves.size() + 1; halves.size() < before;)
  {
    std::map<std::int32_t, std::pair<double, Sight>> longest;
    for (const HalfEdge half : halves)
    {
      const Sight other = this->Sights[this->Plane.Sides[half / 2][1 - half % 2]];
      std::pair<double, Sight>& best = longest[this->Plane.Sides[half / 2][half % 2]];
      if (other != Sight::Unknown && length(half / 2) > best.first)
      {
        best = { length(half / 2), other };
      }
    }
    for (const auto& [cell, best] : longest)
    {
      this->Sights[cell] = best.first > 0.0 ? best.second : Sight::Unknown;
    }
    before = halves.size();
    halves.erase(
      std::remove_if(halves.begin(), halves.end(), [&](HalfEdge half) { return !isUnknown(half); }),
      halves.end());
  }
  std::replace(this->Sights.begin(), this->Sights.end(), Sight::Unknown, Sight::Hidden);
}

bool FaceCells::All(Sight sight) const
{
  bool some = false; // A face too thin for the grid has no cell inside.
  for (const Sight one : this->Sights)
  {
    if (one != Sight::Outside && one != sight)
    {
      return false;
    }
    some = some || one == sight;
  }
  return some;
}

// The share of a source's trim curve at a vertex of its path.
double FaceCells::ShareAt(const DomainSource& source, std::int32_t vertex) const
{
  const DomainSegment& origin = this->Origins[source.Segment];
  const GridPoint& a = this->Points[this->Segments[source.Segment].Start];
  const GridPoint& b = this->Points[this->Segments[source.Segment].End];
  const GridPoint& p = this->Snapped.Vertices[vertex];
  if (p == a || p == b)
  {
    return p == a ? origin.From : origin.To;
  }
  const Vec2 along(double(b.X - a.X), double(b.Y - a.Y));
  const double share = along.dot(Vec2(double(p.X - a.X), double(p.Y - a.Y))) / along.squaredNorm();
  return origin.From + std::clamp(share, 0.0, 1.0) * (origin.To - origin.From);
}

// The trim curve that a half-edge is a part of, as a source; -1: none. One that runs its way has the
// face on the same side.
std::int32_t FaceCells::SourceOf(HalfEdge half) const
{
  std::int32_t out = -1;
  for (std::int64_t k = this->SourceStart[half / 2]; k < this->SourceStart[half / 2 + 1]; ++k)
  {
    const bool fits = (half % 2 == 0) != this->Sources[k].Backward;
    if (this->Origins[this->Sources[k].Segment].Curve >= 0 && (fits || out < 0))
    {
      out = std::int32_t(k);
    }
  }
  return out;
}

RegionLoop FaceCells::LoopOf(std::vector<HalfEdge> halves) const
{
  struct Step
  {
    HalfEdge Half;
    std::int64_t Curve;
    double From, To;
  };
  std::vector<Step> steps;
  for (const HalfEdge half : halves)
  {
    Step step{ half, -1, 0.0, 0.0 };
    const std::int32_t k = this->SourceOf(half);
    if (k >= 0)
    {
      const DomainSource& source = this->Sources[k];
      step.Curve = this->Origins[source.Segment].Curve;
      step.From = this->ShareAt(source, this->Snapped.Edges[half / 2][half % 2]);
      step.To = this->ShareAt(source, this->Snapped.Edges[half / 2][1 - half % 2]);
    }
    steps.push_back(step);
  }
  const auto continues = [&](const Step& a, const Step& b) {
    return a.Curve == b.Curve &&
      (a.Curve < 0 || (a.To == b.From && (a.To - a.From) * (b.To - b.From) >= 0.0));
  };
  std::size_t start = 0;
  for (std::size_t k = 1; k < steps.size() && continues(steps.back(), steps.front()) && start == 0;
       ++k)
  {
    start = continues(steps[k - 1], steps[k]) ? 0 : k;
  }
  std::rotate(steps.begin(), steps.begin() + std::ptrdiff_t(start), steps.end());
  RegionLoop out;
  for (std::size_t k = 0; k < steps.size(); ++k)
  {
    if (k == 0 || !continues(steps[k - 1], steps[k]))
    {
      out.emplace_back();
      out.back().Curve = steps[k].Curve;
      out.back().From = steps[k].From;
      if (steps[k].Curve < 0)
      {
        out.back().Polyline.push_back(
          this->Places[this->Snapped.Edges[steps[k].Half / 2][steps[k].Half % 2]]);
      }
    }
    out.back().To = steps[k].To;
    if (steps[k].Curve < 0)
    {
      out.back().Polyline.push_back(
        this->Places[this->Snapped.Edges[steps[k].Half / 2][1 - steps[k].Half % 2]]);
    }
  }
  JoinPolylines(this->Data, out);
  return out;
}

std::vector<RegionLoop> FaceCells::Loops(Sight sight) const
{
  std::vector<char> border(2 * this->Plane.Sides.size());
  for (HalfEdge h = 0; h < HalfEdge(border.size()); ++h)
  {
    const auto& sides = this->Plane.Sides[h / 2];
    border[h] = this->Sights[sides[h % 2]] == sight && this->Sights[sides[1 - h % 2]] != sight;
  }
  std::vector<RegionLoop> out;
  for (std::vector<HalfEdge>& loop : HalfEdges(this->Snapped).Loops(border))
  {
    out.push_back(this->LoopOf(std::move(loop)));
  }
  return out;
}

} // namespace

RegionCells::RegionCells(const ViewLines& lines, const ImagePlane& image, const RayCaster& caster,
  double precision, bool bothSides)
  : Lines(lines)
  , Image(image)
  , Caster(caster)
  , Precision(precision)
  , BothSides(bothSides)
  , OwnLines(lines.Whole.Data.Faces.size())
{
  for (std::size_t l = 0; l < lines.Lines.size(); ++l)
  {
    const ViewLine& line = lines.Lines[l];
    if (line.Edge < 0)
    {
      this->OwnLines[line.Face].push_back(std::int32_t(l));
      if (line.IsIntersection())
      {
        this->OwnLines[line.OtherFace].push_back(std::int32_t(l));
      }
    }
  }
}

bool RegionCells::IsSeen(std::int64_t index, const Vec2& uv) const
{
  const Face& face = this->Lines.Whole.Data.Faces[index];
  const SurfaceDerivatives d = EvaluateDerivatives(face.Geometry, uv[0], uv[1], 1);
  const Viewer& viewer = this->Image.GetViewer();
  const Vec3 toViewer = viewer.Perspective ? Vec3(viewer.Place - d.S) : viewer.Place;
  // Of unit length: models may be as small as numbers are.
  const Vec3 normal = d.Su.stableNormalized().cross(d.Sv.stableNormalized());
  const bool fromBehind = (normal.dot(toViewer.stableNormalized()) < 0.0) != face.Reversed;
  if (fromBehind && !this->BothSides)
  {
    return false;
  }
  const FrontHit hit = LookAt(this->Caster, this->Image, this->Image.Project(d.S));
  return hit.Face == index && hit.FromBehind == fromBehind &&
    (hit.Point - d.S).norm() <= SamePoint * this->Caster.Bounds().diagonal().norm();
}

SettledRegions RegionCells::Settle(
  std::int64_t index, const std::vector<RegionLoop>& traced, bool hidden) const
{
  const Model& model = this->Lines.Whole.Data;
  FaceCells cells(model, index, this->Precision);
  cells.AddTrims(traced);
  for (const RegionLoop& loop : traced)
  {
    for (const RegionPiece& piece : loop)
    {
      cells.AddPolyline(piece.Polyline);
    }
  }
  for (const std::int32_t l : this->OwnLines[index])
  {
    const ViewLine& line = this->Lines.Lines[l];
    std::vector<Vec2> points;
    for (std::size_t k = 0; k < line.Points.size(); ++k)
    {
      points.push_back(ParametersAt(line, double(k), index));
    }
    cells.AddPolyline(points);
  }
  SettledRegions out;
  out.Unsettled = cells.Look([&](const Vec2& uv) { return this->IsSeen(index, uv); });
  const bool isWhole = cells.All(Sight::Visible);
  const bool isHidden = cells.All(Sight::Hidden);
  out.Visible = isWhole ? WholeRegion(model, index) : cells.Loops(Sight::Visible);
  if (hidden)
  {
    out.Hidden = isHidden ? WholeRegion(model, index) : cells.Loops(Sight::Hidden);
  }
  return out;
}

} // namespace nurbs
