// SPDX-License-Identifier: BSD-3-Clause
// The zone of a face: what lies between its whole cells and its loops.
#include "DeformingFace.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

constexpr double Clearance = 0.3; // Of a cell: grid vertices in the zone keep it from loops.
constexpr double LargeCell = 0.5; // Of a triangle's extent: cells that are worth halving.

} // namespace

// True if no segment of a loop is near; distances in cells.
bool DeformingFace::IsClear(const Vec2& uv, const Vec2& scale) const
{
  for (const std::vector<LoopSegment>& loop : this->Loops)
  {
    for (const LoopSegment& s : loop)
    {
      const Vec2 a = scale.cwiseProduct(this->LoopVertices[s.A].UV - uv);
      const Vec2 d = scale.cwiseProduct(this->LoopVertices[s.B].UV - uv) - a;
      const double length = d.squaredNorm();
      const double t = length > 0.0 ? std::clamp(-a.dot(d) / length, 0.0, 1.0) : 0.0;
      if ((a + t * d).squaredNorm() < Clearance * Clearance)
      {
        return false;
      }
    }
  }
  return true;
}

// Takes the corners of cut cells that are inside and clear of the loops, where the zone changes. Returns
// those that the zone had before.
std::vector<DeformingFace::GridVertex> DeformingFace::AcquireZone()
{
  std::vector<GridVertex> before;
  if (!this->ZoneChanged)
  {
    return before;
  }
  before.swap(this->ZoneVertices);
  for (int patch = 0; patch < this->Lines.Patches(); ++patch)
  {
    this->Forest.ForLeaves(patch, [&](std::int32_t leaf) {
      const Cell& cell = this->Forest[leaf];
      for (int k = 0; k < 4 && cell.State == CellState::Cut; ++k)
      {
        GridVertex vertex;
        this->Corner(cell, k, vertex.first, vertex.second);
        const bool border = vertex.first == 0 || vertex.second == 0 ||
          vertex.first == this->Lines.Axis[0].Last() || vertex.second == this->Lines.Axis[1].Last();
        if (!border)
        {
          this->ZoneVertices.push_back(vertex);
        }
      }
    });
  }
  std::vector<GridVertex>& all = this->ZoneVertices;
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  all.erase(std::remove_if(all.begin(), all.end(),
              [&](const GridVertex& vertex) {
                const Vec2 uv = this->Lines.UV(vertex.first, vertex.second);
                return !this->IsInside(uv) || !this->IsClear(uv, this->CellScale(vertex));
              }),
    all.end());
  for (const GridVertex& vertex : all)
  {
    this->Acquire(this->Forest.LeafAt(vertex.first, vertex.second), vertex.first, vertex.second);
  }
  return before;
}

// One over the extents of the smallest cell around a vertex.
Vec2 DeformingFace::CellScale(const GridVertex& vertex) const
{
  Vec2 scale = Vec2::Zero();
  for (int k = 0; k < 4; ++k)
  {
    const std::int32_t leaf = this->Forest.LeafAt(
      std::int64_t(vertex.first) - (k & 1), std::int64_t(vertex.second) - (k >> 1));
    const ParameterBox box = this->Forest.Box(leaf);
    scale = scale.cwiseMax(Vec2(1.0 / box.A(), 1.0 / box.B()));
  }
  return scale;
}

// The pieces of a whole cell's sides that have no whole cell beyond.
void DeformingFace::AddWallsOf(std::int32_t leaf, std::vector<Wall>& walls)
{
  const Cell& cell = this->Forest[leaf];
  std::vector<BoundaryVertex> boundary;
  this->Boundary(cell, boundary);
  for (std::size_t k = 0; k < boundary.size(); ++k)
  {
    const BoundaryVertex& a = boundary[k];
    const BoundaryVertex& b = boundary[(k + 1) % boundary.size()];
    const bool vertical = a.I == b.I;
    if (vertical == (a.J == b.J))
    {
      continue; // Of a chain along the grid's side, where places are not known; no wall there.
    }
    std::int64_t i = (std::int64_t(a.I) + b.I) / 2;
    std::int64_t j = (std::int64_t(a.J) + b.J) / 2;
    i -= vertical && a.I == cell.I;
    j -= !vertical && a.J == cell.J;
    const std::int32_t beyond = this->Forest.LeafAt(i, j);
    if (beyond >= 0 && this->Forest[beyond].State != CellState::Inside)
    {
      walls.push_back({ a.Point, b.Point });
    }
  }
}

// What encloses the zone: whole cells' sides towards it, and the loops where they are no cell's side.
void DeformingFace::AddWalls(std::vector<Wall>& walls)
{
  for (std::vector<SideSegment>& side : this->Sides)
  {
    for (SideSegment& segment : side)
    {
      segment.Taken = false;
    }
  }
  std::vector<std::int32_t> chain;
  for (int side = 0; side < 4; ++side)
  {
    this->Forest.ForSide(side, [&](std::int32_t leaf) {
      const bool whole = this->Forest[leaf].State == CellState::Inside;
      if (whole && this->FindChain(this->Forest[leaf], side, chain))
      {
        for (const std::int32_t s : chain)
        {
          this->Sides[side][s].Taken = true;
        }
      }
    });
    for (const SideSegment& segment : this->Sides[side])
    {
      if (!segment.Taken)
      {
        walls.push_back({ segment.A, segment.B });
      }
    }
  }
  for (const std::vector<LoopSegment>& loop : this->Loops)
  {
    for (const LoopSegment& s : loop)
    {
      if (s.Side < 0)
      {
        walls.push_back({ this->LoopVertices[s.A].Point, this->LoopVertices[s.B].Point });
      }
    }
  }
  for (int patch = 0; patch < this->Lines.Patches(); ++patch)
  {
    this->Forest.ForLeaves(patch, [&](std::int32_t leaf) {
      if (this->Forest[leaf].State == CellState::Inside && this->IsBesideZone(leaf))
      {
        this->AddWallsOf(leaf, walls);
      }
    });
  }
}

// Quick: false for cells whose corners all lie between whole cells. A cell beyond a side may be smaller,
// so that a side's ends do not tell of it; but then one of its own sides is looked at in full.
bool DeformingFace::IsBesideZone(std::int32_t leaf) const
{
  const Cell& cell = this->Forest[leaf];
  bool beside = false;
  const auto look = [&](std::int64_t i, std::int64_t j) {
    const std::int32_t other = this->Forest.LeafAt(i, j);
    beside = beside || (other >= 0 && this->Forest[other].State != CellState::Inside);
    return other;
  };
  const std::int64_t i0 = cell.I, i1 = i0 + cell.Width;
  const std::int64_t j0 = cell.J, j1 = j0 + cell.Height;
  for (const std::int64_t j : { j0 - 1, j1 })
  {
    for (std::int64_t i = i0; i < i1 && !beside;)
    {
      const std::int32_t other = look(i, j);
      i = other < 0 ? i1 : std::int64_t(this->Forest[other].I) + this->Forest[other].Width;
    }
  }
  for (const std::int64_t i : { i0 - 1, i1 })
  {
    for (std::int64_t j = j0; j < j1 && !beside;)
    {
      const std::int32_t other = look(i, j);
      j = other < 0 ? j1 : std::int64_t(this->Forest[other].J) + this->Forest[other].Height;
    }
  }
  return beside;
}

// Makes cells squares; a face of one cell is triangulated as it lies in space, which suits planes.
Vec2 DeformingFace::ZoneScale()
{
  Vec2 sum = Vec2::Zero();
  int count = 0;
  for (int patch = 0; patch < this->Lines.Patches(); ++patch)
  {
    this->Forest.ForLeaves(patch, [&](std::int32_t leaf) {
      if (this->Forest[leaf].State == CellState::Cut)
      {
        const ParameterBox box = this->Forest.Box(leaf);
        sum += Vec2(box.A(), box.B());
        ++count;
      }
    });
  }
  if (count > 1)
  {
    return Vec2(double(count), double(count)).cwiseQuotient(sum);
  }
  const Vec2 first = this->First(this->Box);
  const Vec2 extent(this->Box.A(), this->Box.B());
  return first.minCoeff() > 0.0 ? first : Vec2(extent.cwiseInverse());
}

// Lines of the zone along creases of the surface, between neighbouring vertices on them.
void DeformingFace::AddCreases(const std::vector<std::int32_t>& points, Zone& zone) const
{
  for (int d = 0; d < 2; ++d)
  {
    for (const double crease : this->CreaseLines[d])
    {
      std::vector<std::pair<double, int>> on;
      for (std::size_t k = 0; k < points.size(); ++k)
      {
        const Vec2 uv = this->Slots.UV(points[k]);
        if (uv[d] == crease)
        {
          on.emplace_back(uv[1 - d], int(k));
        }
      }
      std::sort(on.begin(), on.end());
      for (std::size_t k = 1; k < on.size(); ++k)
      {
        Vec2 middle;
        middle[d] = crease;
        middle[1 - d] = 0.5 * (on[k - 1].first + on[k].first);
        if (this->IsInside(middle) && this->IsInZone(middle, d))
        {
          zone.Lines.push_back({ on[k - 1].second, on[k].second });
        }
      }
    }
  }
}

// True if the cells on both sides of a line in a direction are cut: else it is a wall, or none of ours.
bool DeformingFace::IsInZone(const Vec2& place, int d) const
{
  const std::int64_t line[2] = { this->Lines.Axis[0].LineBelow(place[0]),
    this->Lines.Axis[1].LineBelow(place[1]) };
  for (int side = 0; side < 2; ++side)
  {
    const std::int32_t leaf =
      this->Forest.LeafAt(line[0] - (d == 0 ? side : 0), line[1] - (d == 1 ? side : 0));
    if (leaf < 0 || this->Forest[leaf].State != CellState::Cut)
    {
      return false;
    }
  }
  return true;
}

void DeformingFace::BuildZone(RefinementRequests& requests)
{
  this->Slots.RemoveTriangles({ this->Index, -1 });
  this->Zones.clear();
  this->Crossing = false;
  std::vector<Wall> walls;
  this->AddWalls(walls);
  std::vector<std::int32_t> points;
  for (const Wall& wall : walls)
  {
    points.insert(points.end(), wall.begin(), wall.end());
  }
  for (const GridVertex& vertex : this->ZoneVertices)
  {
    points.push_back(this->PointAt(vertex.first, vertex.second));
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  const auto number = [&](std::int32_t point) {
    return int(std::lower_bound(points.begin(), points.end(), point) - points.begin());
  };
  Zone zone;
  const Vec2 scale = this->ZoneScale();
  for (const std::int32_t point : points)
  {
    zone.Points.push_back(this->Slots.UV(point).cwiseProduct(scale));
  }
  for (const Wall& wall : walls)
  {
    zone.Walls.push_back({ number(wall[0]), number(wall[1]) });
  }
  this->AddCreases(points, zone);
  const ZoneTriangles made = TriangulateZone(zone);
  this->Crossing = !made.Added.empty();
  const auto vertex = [&](int k) {
    const int known = int(points.size());
    return k < known ? points[k] : this->NearestPoint(points, made.Added[k - known], scale);
  };
  for (const std::array<int, 3>& t : made.Triangles)
  {
    const std::array<std::int32_t, 3> corners = { vertex(t[0]), vertex(t[1]), vertex(t[2]) };
    const bool collapsed =
      corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
    if (collapsed || this->IsFlat(corners[0], corners[1], corners[2]))
    {
      continue;
    }
    this->AddTriangle(-1, corners[0], corners[1], corners[2]);
    ParameterBox box{ 1e300, -1e300, 1e300, -1e300 };
    for (const std::int32_t corner : corners)
    {
      const Vec2 uv = this->Slots.UV(corner);
      box = { std::min(box.U0, uv[0]), std::max(box.U1, uv[0]), std::min(box.V0, uv[1]),
        std::max(box.V1, uv[1]) };
    }
    const GridAxis& u = this->Lines.Axis[0];
    const GridAxis& v = this->Lines.Axis[1];
    const Vec2 middle(0.5 * (box.U0 + box.U1), 0.5 * (box.V0 + box.V1));
    const int patch = this->Lines.Patch(u.ColumnAt(middle[0]), v.ColumnAt(middle[1]));
    const ParameterBox all = this->Lines.Box(patch);
    const bool within =
      box.U0 >= all.U0 && box.U1 <= all.U1 && box.V0 >= all.V0 && box.V1 <= all.V1;
    this->Zones.push_back({ corners, box, within ? patch : -1, 0, 0.0 });
  }
  this->CheckZone(requests, true);
}

// Where polylines cross there is no vertex of theirs: the next one stands in for it until the pieces
// have been halved, which Crossing asks for.
std::int32_t DeformingFace::NearestPoint(
  const std::vector<std::int32_t>& points, const Vec2& place, const Vec2& scale) const
{
  const auto distance = [&](std::int32_t point) {
    return (this->Slots.UV(point).cwiseProduct(scale) - place).squaredNorm();
  };
  return *std::min_element(points.begin(), points.end(),
    [&](std::int32_t a, std::int32_t b) { return distance(a) < distance(b); });
}

// Errors of the zone's triangles, as of cells: measured where what is known does not suffice.
void DeformingFace::CheckZone(RefinementRequests& requests, bool everything)
{
  this->ZoneError = 0.0;
  this->CappedTriangles = 0;
  for (std::size_t k = 0; k < this->Zones.size(); ++k)
  {
    ZoneTriangle& triangle = this->Zones[k];
    const double a = triangle.Box.A();
    const double b = triangle.Box.B();
    const SecondBound& moves =
      triangle.Patch >= 0 ? this->Patches[triangle.Patch].Moved : this->SumSecond;
    const double moved = moves.Bow(a, b);
    const double tolerance = this->ToleranceAt(triangle.Box);
    if (everything || triangle.Resets != this->ResetCount || triangle.Up + moved > tolerance)
    {
      const double error = this->Second(triangle.Box).Bow(a, b);
      triangle.Up = error - moved;
      triangle.Resets = this->ResetCount;
      if (error > tolerance && this->Options.FixedDepth < 0)
      {
        ++this->CappedTriangles;
        this->RequestFor(k, requests);
      }
    }
    this->ZoneError = std::max(this->ZoneError, triangle.Up + moved);
  }
}

double DeformingFace::ToleranceAt(const ParameterBox& box) const
{
  const int column = this->Lines.Axis[0].ColumnAt(0.5 * (box.U0 + box.U1));
  const int row = this->Lines.Axis[1].ColumnAt(0.5 * (box.V0 + box.V1));
  return this->Patches[this->Lines.Patch(column, row)].Tolerance;
}

// A triangle is too long, in the direction that it deviates more in, because the cells in it are or the
// loops' pieces along it.
void DeformingFace::RequestFor(std::size_t index, RefinementRequests& requests)
{
  const ZoneTriangle& triangle = this->Zones[index];
  const ParameterBox& box = triangle.Box;
  const SecondBound second = this->Second(box);
  const double deviation[2] = { box.A() * box.A() * second.Uu, box.B() * box.B() * second.Vv };
  const bool twisted = 2.0 * box.A() * box.B() * second.Uv > deviation[0] + deviation[1];
  const Vec2 middle = (this->Slots.UV(triangle.Points[0]) + this->Slots.UV(triangle.Points[1]) +
                        this->Slots.UV(triangle.Points[2])) /
    3.0;
  const std::int64_t line[2] = { this->Lines.Axis[0].LineBelow(middle[0]),
    this->Lines.Axis[1].LineBelow(middle[1]) };
  const std::int32_t leaf = this->Forest.LeafAt(line[0], line[1]);
  const ParameterBox cell = this->Forest.Box(leaf);
  bool any = false;
  const auto halve = [&](int d) {
    const double extent = LargeCell * (d == 0 ? box.A() : box.B());
    if ((d == 0 ? cell.A() : cell.B()) > extent && this->CanSplit(leaf, d))
    {
      requests.Cells.push_back({ line[0], line[1], d, extent });
      any = true;
    }
  };
  for (int d = 0; d < 2; ++d)
  {
    if (!twisted && deviation[d] < deviation[1 - d])
    {
      continue;
    }
    halve(d);
    const double extent = LargeCell * (d == 0 ? box.A() : box.B());
    for (int k = 0; k < 3; ++k)
    {
      const std::int32_t a = triangle.Points[k];
      const std::int32_t b = triangle.Points[(k + 1) % 3];
      const Vec2 side = (this->Slots.UV(b) - this->Slots.UV(a)).cwiseAbs();
      if (side[d] > extent && this->Slots.Use(a).Patch < 0 && this->Slots.Use(b).Patch < 0)
      {
        any = this->RequestPiece(a, b, requests) || any;
      }
    }
  }
  // Cells may be short enough, and have no corner in the triangle as they are too long.
  for (int d = 0; d < 2 && !any; ++d)
  {
    halve(d);
  }
}

void DeformingFace::RequestLoops(RefinementRequests& requests) const
{
  for (const std::vector<LoopSegment>& loop : this->Loops)
  {
    for (const LoopSegment& s : loop)
    {
      if (s.Piece >= 0)
      {
        requests.Crossing.emplace_back(s.Edge, s.Piece);
      }
    }
  }
}

// The loop's piece between two of its vertices, if they are neighbours.
bool DeformingFace::RequestPiece(std::int32_t a, std::int32_t b, RefinementRequests& requests) const
{
  const std::int32_t vertex[2] = { this->Slots.Use(a).Index, this->Slots.Use(b).Index };
  for (int k = 0; k < 2; ++k)
  {
    const LoopSegment* s = this->SegmentFrom[vertex[k]];
    if (s && s->B == vertex[1 - k] && s->Piece >= 0)
    {
      requests.Pieces.emplace_back(s->Edge, s->Piece);
      return true;
    }
  }
  return false;
}

} // namespace nurbs
