// SPDX-License-Identifier: BSD-3-Clause
#include "FaceCells.h"

#include "CellBorders.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace nurbs
{

namespace
{

// The domain is so many pixels wide.
constexpr double DomainPixels = 268435456.0;
// Chords of trim curves, as a share of the precision, and how often they are halved at most.
constexpr double ChordShare = 0.125;
constexpr int MaxChordDepth = 12;

} // namespace

GridPoint FaceCells::ToGrid(const Vec2& uv) const
{
  GridPoint out;
  const Vec2 share = (uv - this->Corner).cwiseQuotient(this->Size) - Vec2(0.5, 0.5);
  out.X = std::llround(DomainPixels * std::clamp(share[0], -1.0, 1.0));
  out.Y = std::llround(DomainPixels * std::clamp(share[1], -1.0, 1.0));
  return out;
}

Vec2 FaceCells::ToDomain(const Vec2& grid) const
{
  return this->Corner + (grid / DomainPixels + Vec2(0.5, 0.5)).cwiseProduct(this->Size);
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

void FaceCells::AddPolyline(const std::vector<Vec2>& points, bool isShadow)
{
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    this->AddPoint(points[k]);
    if (k > 0)
    {
      DomainSegment segment;
      segment.IsShadow = isShadow;
      this->AddSegment(segment);
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
  const CellBorders borders(this->Plane);
  this->Sights.assign(this->Plane.CellCount, Sight::Outside);
  std::vector<char> known(this->Plane.CellCount, 0);
  std::vector<std::int32_t> waiting{ 0 };
  known[0] = 1;
  while (!waiting.empty())
  {
    const std::int32_t cell = waiting.back();
    waiting.pop_back();
    for (const HalfEdge half : borders.Of(cell))
    {
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

void FaceCells::MakeMap(double sideReach)
{
  this->Plane =
    MakePlanarMap(this->Snapped, std::numeric_limits<int>::max(), nullptr, true, sideReach);
  this->CollectSources();
  this->PlaceVertices();
  this->FindInside();
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

} // namespace nurbs
