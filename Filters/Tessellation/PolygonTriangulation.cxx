// SPDX-License-Identifier: BSD-3-Clause
#include "PolygonTriangulation.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace nurbs
{

namespace
{

using Predicates = CGAL::Exact_predicates_inexact_constructions_kernel;
using Polygon = std::vector<Vec2>;

// The sign of the area of a, b, c: 1 if they turn left.
int Orientation(const Vec2& a, const Vec2& b, const Vec2& c)
{
  using Point = Predicates::Point_2;
  return static_cast<int>(
    CGAL::orientation(Point(a[0], a[1]), Point(b[0], b[1]), Point(c[0], c[1])));
}

// The order of the sweep: from high to low v, from low to high u.
bool Above(const Vec2& a, const Vec2& b)
{
  return a[1] > b[1] || (a[1] == b[1] && a[0] < b[0]);
}

void AddTriangle(std::vector<int>& triangles, int a, int b, int c)
{
  triangles.insert(triangles.end(), { a, b, c });
}

// Loops that do not cross, cut into pieces monotone in the order of the sweep.
class MonotonePieces
{
public:
  explicit MonotonePieces(const std::vector<Polygon>& loops)
  {
    for (const Polygon& loop : loops)
    {
      const int first = static_cast<int>(this->Points.size());
      const int n = static_cast<int>(loop.size());
      if (n > 0 && n < 3)
      {
        throw Error("TriangulatePolygon: a loop of fewer than three vertices");
      }
      for (int i = 0; i < n; ++i)
      {
        this->Points.push_back(loop[i]);
        this->Next.push_back(first + (i + 1) % n);
        this->Previous.push_back(first + (i + n - 1) % n);
      }
    }
    this->Out.resize(this->Points.size());
    for (int v = 0; v < this->Size(); ++v)
    {
      this->Out[v].push_back(this->Next[v]);
    }
    this->Sweep();
  }

  int Size() const { return static_cast<int>(this->Points.size()); }
  const Vec2& Point(int v) const { return this->Points[v]; }

  // Section 6: along each directed half-edge, at each vertex the leftmost way on, until the start.
  template <typename F>
  void ForEachPiece(F&& body)
  {
    for (int v = 0; v < this->Size(); ++v)
    {
      if (this->Out[v].size() > 1)
      {
        this->SortAround(v);
      }
    }
    std::vector<std::vector<char>> done(this->Out.size());
    for (int v = 0; v < this->Size(); ++v)
    {
      done[v].assign(this->Out[v].size(), 0);
    }
    std::vector<int> piece;
    for (int v = 0; v < this->Size(); ++v)
    {
      for (std::size_t k = 0; k < this->Out[v].size(); ++k)
      {
        if (done[v][k])
        {
          continue;
        }
        piece.clear();
        int at = v;
        std::size_t way = k;
        while (!done[at][way])
        {
          done[at][way] = 1;
          piece.push_back(at);
          const int to = this->Out[at][way];
          way = this->Leftmost(at, to);
          at = to;
        }
        body(piece);
      }
    }
  }

private:
  // A side is named by the vertex that it starts at; sides in the status run downwards.
  struct LeftToRight
  {
    using is_transparent = void;
    const MonotonePieces* Of;

    bool operator()(int e, int f) const
    {
      if (e == f)
      {
        return false;
      }
      const Vec2& eTop = this->Of->Points[e];
      const Vec2& eEnd = this->Of->Points[this->Of->Next[e]];
      const Vec2& fTop = this->Of->Points[f];
      const Vec2& fEnd = this->Of->Points[this->Of->Next[f]];
      if (!Above(fTop, eTop))
      {
        const int side = Orientation(eEnd, eTop, fTop);
        return (side != 0 ? side : Orientation(eEnd, eTop, fEnd)) < 0;
      }
      const int side = Orientation(fEnd, fTop, eTop);
      return (side != 0 ? side : Orientation(fEnd, fTop, eEnd)) > 0;
    }
    bool operator()(int e, const Vec2& p) const
    {
      return Orientation(this->Of->Points[this->Of->Next[e]], this->Of->Points[e], p) < 0;
    }
    bool operator()(const Vec2& p, int e) const
    {
      return Orientation(this->Of->Points[this->Of->Next[e]], this->Of->Points[e], p) > 0;
    }
  };
  using Status = std::set<int, LeftToRight>;

  void AddDiagonal(int a, int b)
  {
    this->Out[a].push_back(b);
    this->Out[b].push_back(a);
  }

  bool IsMerge(int v) const { return this->Merge[v] != 0; }

  // Joins v to the helper of a side if that one is a merge vertex.
  void JoinToMerge(int v, int side)
  {
    if (this->IsMerge(this->Helper[side]))
    {
      this->AddDiagonal(v, this->Helper[side]);
    }
  }

  int SideLeftOf(const Status& status, int v) const
  {
    auto at = status.lower_bound(this->Points[v]);
    if (at == status.begin())
    {
      throw Error(
        "TriangulatePolygon: loops cross or run the wrong way at vertex " + std::to_string(v));
    }
    return *--at;
  }

  // The sweep of Garey et al. with the vertex kinds and helpers of Lee and Preparata.
  void Sweep()
  {
    const int n = this->Size();
    std::vector<int> order(n);
    for (int v = 0; v < n; ++v)
    {
      order[v] = v;
    }
    std::sort(order.begin(), order.end(), [this](int a, int b) {
      return Above(this->Points[a], this->Points[b]) ||
        (this->Points[a] == this->Points[b] && a < b);
    });
    this->Helper.assign(n, -1);
    this->Merge.assign(n, 0);
    Status status(LeftToRight{ this });
    for (const int v : order)
    {
      this->Visit(v, status);
    }
  }

  void Visit(int v, Status& status)
  {
    const int before = this->Previous[v]; // also the name of the side that ends here
    const Vec2& p = this->Points[v];
    const bool beforeAbove = Above(this->Points[before], p);
    const bool nextAbove = Above(this->Points[this->Next[v]], p);
    const bool convex = Orientation(this->Points[before], p, this->Points[this->Next[v]]) > 0;
    if (beforeAbove) // the left side of the region ends here
    {
      this->JoinToMerge(v, before);
      status.erase(before);
    }
    const bool merge = beforeAbove && nextAbove && !convex;
    const bool split = !beforeAbove && !nextAbove && !convex;
    const bool rightSide = !beforeAbove && nextAbove;
    if (merge || split || rightSide)
    {
      const int left = this->SideLeftOf(status, v);
      if (split)
      {
        this->AddDiagonal(v, this->Helper[left]);
      }
      else
      {
        this->JoinToMerge(v, left);
      }
      this->Helper[left] = v;
    }
    this->Merge[v] = merge;
    if (!nextAbove) // a left side of the region starts here
    {
      status.insert(v);
      this->Helper[v] = v;
    }
  }

  // Is direction v -> a before v -> b, counter-clockwise from the positive u axis?
  bool IsBefore(int v, int a, int b) const
  {
    const Vec2& p = this->Points[v];
    const auto lower = [&](const Vec2& q) { return q[1] < p[1] || (q[1] == p[1] && q[0] < p[0]); };
    const bool la = lower(this->Points[a]);
    const bool lb = lower(this->Points[b]);
    return la != lb ? lb : Orientation(p, this->Points[a], this->Points[b]) > 0;
  }

  void SortAround(int v)
  {
    std::sort(this->Out[v].begin(), this->Out[v].end(),
      [this, v](int a, int b) { return this->IsBefore(v, a, b); });
  }

  // The way out of `to` that comes first clockwise from the way back to `from`.
  std::size_t Leftmost(int from, int to) const
  {
    const std::vector<int>& ways = this->Out[to];
    const auto at = std::lower_bound(ways.begin(), ways.end(), from,
      [this, to](int a, int b) { return this->IsBefore(to, a, b); });
    const std::size_t k = at - ways.begin();
    return k > 0 ? k - 1 : ways.size() - 1;
  }

  Polygon Points;
  std::vector<int> Next;
  std::vector<int> Previous;
  std::vector<std::vector<int>> Out; ///< Where half-edges from a vertex lead to.
  std::vector<int> Helper;           ///< Of a side in the status: the vertex it can be joined to.
  std::vector<char> Merge;
};

// A piece monotone in the order of the sweep, counter-clockwise, in linear time.
void TriangulateMonotone(
  const MonotonePieces& pieces, const std::vector<int>& piece, std::vector<int>& triangles)
{
  const int n = static_cast<int>(piece.size());
  const auto point = [&](int v) -> const Vec2& { return pieces.Point(v); };
  int top = 0;
  for (int i = 1; i < n; ++i)
  {
    top = Above(point(piece[i]), point(piece[top])) ? i : top;
  }
  // Both chains downwards from the top: the left one as the piece runs, the right one against it.
  std::vector<std::pair<int, bool>> order; // vertex, is it on the left?
  order.emplace_back(piece[top], true);
  int l = (top + 1) % n;
  int r = (top + n - 1) % n;
  for (int k = 1; k < n; ++k)
  {
    const bool left = l == r || Above(point(piece[l]), point(piece[r]));
    order.emplace_back(piece[left ? l : r], left);
    (left ? l : r) = left ? (l + 1) % n : (r + n - 1) % n;
  }
  std::vector<std::pair<int, bool>> stack(order.begin(), order.begin() + 2);
  const auto add = [&](int a, int b, int c, bool left) {
    left ? AddTriangle(triangles, a, b, c) : AddTriangle(triangles, a, c, b);
  };
  for (int k = 2; k < n; ++k)
  {
    const auto [v, left] = order[k];
    if (k + 1 == n || left != stack.back().second)
    {
      // All of the reflex chain is seen from the other side (and from the lowest vertex).
      for (std::size_t i = 0; i + 1 < stack.size(); ++i)
      {
        add(stack[i].first, stack[i + 1].first, v, stack.back().second);
      }
      const auto last = stack.back();
      stack.assign({ last, order[k] });
      continue;
    }
    while (stack.size() > 1)
    {
      const int b = stack.back().first;
      const int a = stack[stack.size() - 2].first;
      if (Orientation(point(a), point(b), point(v)) != (left ? 1 : -1))
      {
        break;
      }
      add(a, b, v, left);
      stack.pop_back();
    }
    stack.push_back(order[k]);
  }
}

double Area2(const Vec2& a, const Vec2& b, const Vec2& c)
{
  const Vec2 ab = b - a;
  const Vec2 ac = c - a;
  return ab[0] * ac[1] - ab[1] * ac[0];
}

// Are the triangles as many and as large as the region asks for, and none of them turned over?
void Check(const std::vector<Polygon>& loops, const MonotonePieces& pieces,
  const std::vector<int>& triangles)
{
  double wanted = 0.0;
  double scale = 0.0;
  for (const Polygon& loop : loops)
  {
    for (std::size_t i = 2; i < loop.size(); ++i)
    {
      wanted += Area2(loop[0], loop[i - 1], loop[i]);
      scale += std::abs(Area2(loop[0], loop[i - 1], loop[i]));
    }
  }
  double area = 0.0;
  bool turned = false;
  for (std::size_t t = 0; t < triangles.size(); t += 3)
  {
    const Vec2& a = pieces.Point(triangles[t]);
    const Vec2& b = pieces.Point(triangles[t + 1]);
    const Vec2& c = pieces.Point(triangles[t + 2]);
    area += Area2(a, b, c);
    turned = turned || Orientation(a, b, c) < 0;
  }
  if (turned || std::abs(area - wanted) > 1e-9 * scale)
  {
    throw Error("TriangulatePolygon: the loops cross, touch or run the wrong way");
  }
}

} // namespace

std::vector<int> TriangulateConvex(const std::vector<Vec2>& polygon)
{
  const int n = static_cast<int>(polygon.size());
  std::vector<int> triangles;
  if (n < 3)
  {
    return triangles;
  }
  triangles.reserve(3 * (n - 2));
  std::vector<int> next(n);
  std::vector<int> previous(n);
  std::vector<char> corner(n); // the others lie on straight sides
  std::vector<int> queue;
  for (int i = 0; i < n; ++i)
  {
    next[i] = i + 1 < n ? i + 1 : 0;
    previous[i] = i > 0 ? i - 1 : n - 1;
    corner[i] = Orientation(polygon[previous[i]], polygon[i], polygon[next[i]]) > 0;
    if (corner[i])
    {
      queue.push_back(i);
    }
  }
  std::vector<char> waits(n, 0);
  int corners = static_cast<int>(queue.size());
  int left = n;
  int start = 0;
  for (std::size_t k = 0; k < queue.size() && left > 3; ++k)
  {
    const int v = queue[k];
    const int a = previous[v];
    const int b = next[v];
    // Every second corner goes first, which makes stout triangles instead of a fan.
    if (waits[v])
    {
      waits[v] = 0;
      queue.push_back(v);
      continue;
    }
    // With three corners left, one between two others must stay: what remained would be a line.
    if (corners == 3 && corner[a] && corner[b])
    {
      queue.push_back(v);
      continue;
    }
    AddTriangle(triangles, a, v, b);
    next[a] = b;
    previous[b] = a;
    --left;
    --corners;
    for (const int w : { a, b })
    {
      waits[w] = 1;
      if (!corner[w])
      {
        corner[w] = 1;
        ++corners;
        queue.push_back(w);
      }
    }
    start = a;
  }
  // The last triangle (or all, of a polygon without area).
  for (int v = next[start]; next[v] != start; v = next[v])
  {
    AddTriangle(triangles, start, v, next[v]);
  }
  return triangles;
}

bool IsConvex(const std::vector<Vec2>& polygon)
{
  const std::size_t n = polygon.size();
  int turns = 0; // from downwards to upwards
  for (std::size_t i = 0; i < n; ++i)
  {
    const Vec2& a = polygon[i];
    const Vec2& b = polygon[(i + 1) % n];
    const Vec2& c = polygon[(i + 2) % n];
    if (Orientation(a, b, c) < 0)
    {
      return false;
    }
    turns += Above(a, b) && Above(c, b);
  }
  return turns == 1;
}

std::vector<int> TriangulatePolygon(const std::vector<std::vector<Vec2>>& loops)
{
  MonotonePieces pieces(loops);
  std::vector<int> triangles;
  pieces.ForEachPiece([&](const std::vector<int>& piece) {
    if (piece.size() < 3)
    {
      throw Error("TriangulatePolygon: the loops cross, touch or repeat a vertex");
    }
    TriangulateMonotone(pieces, piece, triangles);
  });
  Check(loops, pieces, triangles);
  return triangles;
}

} // namespace nurbs
