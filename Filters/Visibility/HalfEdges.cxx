// SPDX-License-Identifier: BSD-3-Clause
#include "HalfEdges.h"

#include <algorithm>
#include <numeric>

namespace nurbs
{

HalfEdges::HalfEdges(const SnappedSegments& segments)
  : Map(segments)
{
  const auto halves = HalfEdge(2 * segments.Edges.size());
  const std::vector<GridPoint>& at = segments.Vertices;
  this->First.assign(at.size() + 1, 0);
  for (HalfEdge h = 0; h < halves; ++h)
  {
    ++this->First[this->Start(h) + 1];
  }
  std::partial_sum(this->First.begin(), this->First.end(), this->First.begin());
  this->Around.resize(halves);
  std::vector<std::int64_t> next(this->First.begin(), this->First.end() - 1);
  for (HalfEdge h = 0; h < halves; ++h)
  {
    this->Around[next[this->Start(h)]++] = h;
  }
  const auto way = [&](HalfEdge h) {
    const GridPoint& a = at[this->Start(h)];
    const GridPoint& b = at[this->Start(h ^ 1)];
    return GridPoint{ b.X - a.X, b.Y - a.Y };
  };
  // Coordinates have 30 bits, products 61.
  const auto isUpper = [](const GridPoint& d) { return d.Y > 0 || (d.Y == 0 && d.X > 0); };
  const auto before = [&](HalfEdge a, HalfEdge b) {
    const GridPoint da = way(a);
    const GridPoint db = way(b);
    return isUpper(da) != isUpper(db) ? isUpper(da) : da.X * db.Y - da.Y * db.X > 0;
  };
  for (std::size_t v = 0; v < at.size(); ++v)
  {
    std::sort(
      this->Around.begin() + this->First[v], this->Around.begin() + this->First[v + 1], before);
  }
  this->PlaceOf.resize(halves);
  for (HalfEdge k = 0; k < halves; ++k)
  {
    this->PlaceOf[this->Around[k]] = k;
  }
}

// The region lies clockwise of the way back.
HalfEdge HalfEdges::Next(HalfEdge half, const std::vector<char>& border) const
{
  const HalfEdge back = half ^ 1;
  const std::int32_t vertex = this->Start(back);
  const auto first = HalfEdge(this->First[vertex]);
  const auto count = HalfEdge(this->First[vertex + 1]) - first;
  HalfEdge place = this->PlaceOf[back] - first;
  for (;;)
  {
    place = (place + count - 1) % count;
    const HalfEdge next = this->Around[first + place];
    if (border[next] || next == back)
    {
      return next;
    }
  }
}

std::vector<std::vector<HalfEdge>> HalfEdges::Loops(const std::vector<char>& border) const
{
  std::vector<std::vector<HalfEdge>> out;
  std::vector<char> done(border.size(), 0);
  for (HalfEdge first = 0; first < HalfEdge(border.size()); ++first)
  {
    if (!border[first] || done[first])
    {
      continue;
    }
    out.emplace_back();
    for (HalfEdge h = first; !done[h]; h = this->Next(h, border))
    {
      done[h] = 1;
      out.back().push_back(h);
    }
  }
  return out;
}

} // namespace nurbs
