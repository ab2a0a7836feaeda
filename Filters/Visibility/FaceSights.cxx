// SPDX-License-Identifier: BSD-3-Clause
// Looks at the cells of a face's domain.
#include "FaceCells.h"

#include "CellBorders.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace nurbs
{

namespace
{

// A cell is looked at where there is most room in each of so many parts of its width and height, if
// there is room for a circle of this share of the largest one.
constexpr int LooksAcross = 3;
constexpr double LeastShare = 0.125;
// Cells without a circle of so many pixels go with a neighbour.
constexpr double LeastRadius = 1.0;
// How far from a shadow its sides are looked at, in precisions, and how much room there must be.
constexpr double ShadowReach = 1.0;
constexpr double ShadowRoom = 0.75;
// Likewise for sides of triangles, where a line is searched for; and where along them, if they are longer
// than so many precisions in the image, else in the middle only.
constexpr double SideReachShare = 0.5;
constexpr double LongSide = 16.0;
constexpr double SidePlaces[] = { 0.5, 0.25, 0.75 };
// A line's points are found to this share of the precision in the image, by so many halvings at most.
constexpr double BorderShare = 0.02;
constexpr int MaxHalvings = 48;
// The search ends after so many rounds, or with so many points. Where two faces coincide and now one and
// now the other is seen, there is no line to find.
constexpr int MaxRounds = 16;
constexpr std::size_t MaxPoints = 4096;
// The direction of a side in the image is taken over this share of it.
constexpr double TangentShare = 0.02;

double Cross(const Vec2& a, const Vec2& b)
{
  return a[0] * b[1] - a[1] * b[0];
}

Vec2 ToVec(const GridPoint& p)
{
  return Vec2(double(p.X), double(p.Y));
}

// True if a point lies within a triangle whose corners turn left, and not on its sides.
bool IsWithin(const GridPoint& p, const std::array<GridPoint, 3>& corners)
{
  for (int k = 0; k < 3; ++k)
  {
    const GridPoint& a = corners[k];
    const GridPoint& b = corners[(k + 1) % 3];
    if ((b.X - a.X) * (p.Y - a.Y) - (b.Y - a.Y) * (p.X - a.X) <= 0)
    {
      return false;
    }
  }
  return true;
}

} // namespace

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
std::vector<char> FaceCells::LookAtCells(const FaceView& view)
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
        (view.IsSeen(this->ToDomain(look.Point)) ? 1.0 : -1.0) * look.Radius * look.Radius;
      mixed[c] |= vote * sum < 0.0;
      sum += vote;
      this->Sights[c] = sum > 0.0 ? Sight::Visible : Sight::Hidden;
    }
  }
  return mixed;
}

// True if all that runs along an edge is shadows.
bool FaceCells::IsShadow(std::int32_t edge) const
{
  bool is = this->SourceStart[edge] < this->SourceStart[edge + 1];
  for (std::int64_t k = this->SourceStart[edge]; k < this->SourceStart[edge + 1]; ++k)
  {
    is = is && this->Origins[this->Sources[k].Segment].IsShadow;
  }
  return is;
}

// The point between `at`, on a line that runs `along`, and `inside` that is about `reach` away from the
// line in the image. None if `inside` is nearer to it than `least`.
std::optional<Vec2> FaceCells::Aside(const FaceView& view, const Vec2& at, const Vec2& along,
  const Vec2& inside, double reach, double least) const
{
  const auto imageOf = [&](const Vec2& grid) { return view.ImageOf(this->ToDomain(grid)); };
  const Vec2 foot = imageOf(at);
  const Vec2 tangent = imageOf(at + TangentShare * along) - imageOf(at - TangentShare * along);
  // A side that is seen end-on is a point.
  const bool isPoint = tangent.norm() <= 1e-6 * reach;
  const auto distance = [&](const Vec2& grid) {
    const Vec2 way = imageOf(grid) - foot;
    return isPoint ? way.norm() : std::abs(Cross(tangent, way)) / tangent.norm();
  };
  const double room = distance(inside);
  if (!(room >= least))
  {
    return std::nullopt;
  }
  // Beside a silhouette the distance in the image grows with the square of that in the domain.
  double share = std::min(1.0, reach / room);
  while (share < 1.0 && distance(at + share * (inside - at)) < least)
  {
    share = std::min(1.0, 2.0 * share);
  }
  return at + share * (inside - at);
}

// Marks cells on whose borders something else is seen than within them.
void FaceCells::LookBesideShadows(const FaceView& view, std::vector<char>& mixed) const
{
  for (std::int32_t e = 0; e < std::int32_t(this->Plane.Sides.size()); ++e)
  {
    if (!this->IsShadow(e))
    {
      continue;
    }
    const Vec2 a = ToVec(this->Snapped.Vertices[this->Snapped.Edges[e][0]]);
    const Vec2 b = ToVec(this->Snapped.Vertices[this->Snapped.Edges[e][1]]);
    const Vec2 middle = view.ImageOf(this->ToDomain(0.5 * (a + b)));
    const double length = (view.ImageOf(this->ToDomain(a)) - middle).norm() +
      (view.ImageOf(this->ToDomain(b)) - middle).norm(); // The ends may be one point in the image.
    for (int side = 0; side < 2 && length >= ShadowRoom * this->Precision; ++side)
    {
      const std::int32_t cell = this->Plane.Sides[e][side];
      if (mixed[cell] ||
        (this->Sights[cell] != Sight::Visible && this->Sights[cell] != Sight::Hidden))
      {
        continue;
      }
      const std::optional<Vec2> look =
        this->Aside(view, 0.5 * (a + b), b - a, this->Plane.SideSamples[e][side].Point,
          ShadowReach * this->Precision, ShadowRoom * this->Precision);
      mixed[cell] =
        look && view.IsSeen(this->ToDomain(*look)) != (this->Sights[cell] == Sight::Visible);
    }
  }
}

// Makes edges of the sides of all triangles of some cells; returns what became of the edges there were.
std::vector<std::int32_t> FaceCells::Divide(const std::vector<char>& cells)
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
  std::vector<std::int32_t> now;
  for (const auto& old : this->Snapped.Edges)
  {
    now.push_back(std::int32_t(std::lower_bound(edges.begin(), edges.end(), old) - edges.begin()));
  }
  for (std::int32_t& entry : this->Snapped.Path)
  {
    entry = entry < 0 ? ~now[~entry] : now[entry];
  }
  this->Snapped.Edges = std::move(edges);
  return now;
}

// Adds vertices that lie on no edge. Edges and cells keep their numbers.
void FaceCells::AddVertices(std::vector<GridPoint> added)
{
  std::vector<GridPoint> all;
  std::sort(added.begin(), added.end());
  std::set_union(this->Snapped.Vertices.begin(), this->Snapped.Vertices.end(), added.begin(),
    added.end(), std::back_inserter(all));
  std::vector<std::int32_t> now;
  for (const GridPoint& old : this->Snapped.Vertices)
  {
    now.push_back(std::int32_t(std::lower_bound(all.begin(), all.end(), old) - all.begin()));
  }
  for (auto& edge : this->Snapped.Edges)
  {
    edge = { now[edge[0]], now[edge[1]] };
  }
  this->Snapped.Vertices = std::move(all);
}

// A point of the line between two points of which one is seen; none if the grid has no room for it.
std::optional<GridPoint> FaceCells::BorderBetween(
  const FaceView& view, const Vec2& from, const Vec2& to, const Triangle& within) const
{
  Vec2 a = from;
  Vec2 b = to;
  const bool isSeen = view.IsSeen(this->ToDomain(a));
  for (int k = 0; k < MaxHalvings && (b - a).norm() > 1.0 &&
       (view.ImageOf(this->ToDomain(b)) - view.ImageOf(this->ToDomain(a))).norm() >
         BorderShare * this->Precision;
       ++k)
  {
    const Vec2 middle = 0.5 * (a + b);
    (view.IsSeen(this->ToDomain(middle)) == isSeen ? a : b) = middle;
  }
  const GridPoint out{ std::llround(0.5 * (a[0] + b[0])), std::llround(0.5 * (a[1] + b[1])) };
  return IsWithin(out, within) ? std::optional<GridPoint>(out) : std::nullopt;
}

FaceCells::TriangleLook FaceCells::LookAtTriangle(
  const FaceView& view, const Triangle& corners, const PlanarSample& middle) const
{
  TriangleLook out;
  if (middle.Radius < LeastRadius)
  {
    return out;
  }
  const bool isSeen = view.IsSeen(this->ToDomain(middle.Point));
  out.Middle = isSeen ? Sight::Visible : Sight::Hidden;
  const double reach = SideReachShare * this->Precision;
  for (int k = 0; k < 3; ++k)
  {
    const Vec2 a = ToVec(corners[k]);
    const Vec2 along = ToVec(corners[(k + 1) % 3]) - a;
    const double length =
      (view.ImageOf(this->ToDomain(a + along)) - view.ImageOf(this->ToDomain(a))).norm();
    const int places = length > LongSide * this->Precision ? int(std::size(SidePlaces)) : 1;
    for (int place = 0; place < places; ++place)
    {
      const std::optional<Vec2> look =
        this->Aside(view, a + SidePlaces[place] * along, along, middle.Point, reach, reach);
      if (look && view.IsSeen(this->ToDomain(*look)) != isSeen)
      {
        const std::optional<GridPoint> border =
          this->BorderBetween(view, middle.Point, *look, corners);
        if (border)
        {
          out.Border.push_back(*border);
        }
        break;
      }
    }
  }
  return out;
}

// Looks at triangles that were not looked at before; cells of which it is known what they show keep it.
// Returns points of lines that run through triangles.
std::vector<GridPoint> FaceCells::LookAtTriangles(const FaceView& view,
  const std::vector<Sight>& known, std::int64_t& unsettled, TriangleLooks& looks)
{
  const CellBorders borders(this->Plane);
  std::vector<GridPoint> out;
  unsettled = 0;
  for (std::int32_t c = 1; c < this->Plane.CellCount; ++c)
  {
    const ArrayView<HalfEdge> halves = borders.Of(c);
    if (known[c] != Sight::Unknown || halves.size() != 3 || this->Sights[c] == Sight::Outside)
    {
      this->Sights[c] = this->Sights[c] == Sight::Outside ? Sight::Outside : known[c];
      continue;
    }
    const auto start = [&](HalfEdge half) { return this->Snapped.Edges[half / 2][half % 2]; };
    // Counter-clockwise: the second half-edge starts where the first ends, or the third does.
    const bool inOrder = start(halves[1]) == this->Snapped.Edges[halves[0] / 2][1 - halves[0] % 2];
    const Triangle corners{ this->Snapped.Vertices[start(halves[0])],
      this->Snapped.Vertices[start(halves[inOrder ? 1 : 2])],
      this->Snapped.Vertices[start(halves[inOrder ? 2 : 1])] };
    const auto at = looks.find(corners);
    const TriangleLook& look = at != looks.end()
      ? at->second
      : looks
          .emplace(corners,
            this->LookAtTriangle(view, corners, this->Plane.Samples[this->Plane.SampleStart[c]]))
          .first->second;
    this->Sights[c] = look.Middle;
    unsettled += !look.Border.empty();
    out.insert(out.end(), look.Border.begin(), look.Border.end());
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

// Finds the lines that are missing in mixed cells; returns the number of triangles that a line still
// runs through.
std::int64_t FaceCells::Refine(const FaceView& view, const std::vector<char>& mixed)
{
  SnappedSegments whole = this->Snapped;
  const std::vector<Sight> before = this->Sights;
  TriangleLooks looks;
  std::int64_t unsettled = 0;
  std::size_t points = 0;
  for (int round = 0; round < MaxRounds; ++round)
  {
    const std::vector<std::array<std::int32_t, 2>> sides = this->Plane.Sides;
    const std::vector<std::int32_t> now = this->Divide(mixed);
    this->MakeMap();
    std::vector<Sight> known(this->Plane.CellCount, Sight::Unknown);
    for (std::size_t e = 0; e < now.size(); ++e)
    {
      for (int side = 0; side < 2; ++side)
      {
        if (!mixed[sides[e][side]])
        {
          known[this->Plane.Sides[now[e]][side]] = before[sides[e][side]];
        }
      }
    }
    const std::vector<GridPoint> added = this->LookAtTriangles(view, known, unsettled, looks);
    points += added.size();
    if (added.empty() || points > MaxPoints || round + 1 == MaxRounds)
    {
      break;
    }
    this->Snapped = std::move(whole);
    this->AddVertices(added);
    whole = this->Snapped;
    this->MakeMap();
  }
  return unsettled;
}

std::int64_t FaceCells::Look(const FaceView& view, bool besideShadows)
{
  this->Snapped = SnapRound(this->Points, this->Segments);
  this->MakeMap(besideShadows ? double(GridLimit) : SideReach);
  std::vector<char> mixed = this->LookAtCells(view);
  if (besideShadows)
  {
    this->LookBesideShadows(view, mixed);
  }
  const bool some = std::find(mixed.begin(), mixed.end(), 1) != mixed.end();
  const std::int64_t unsettled = some ? this->Refine(view, mixed) : 0;
  this->JoinUnknown();
  return unsettled;
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

} // namespace nurbs
