// SPDX-License-Identifier: BSD-3-Clause
#include "CellZone.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{
constexpr double KeepDistance = 0.35; // Corners of cut cells nearer to a trim line are dropped.

// Distance of p from the segment a-b in units of a cell.
double UnitDistance(const Vec2& p, const Vec2& a, const Vec2& b, double su, double sv)
{
  const Vec2 s(su, sv);
  const Vec2 d = (b - a).cwiseProduct(s);
  const Vec2 e = (p - a).cwiseProduct(s);
  const double length = d.squaredNorm();
  const double t = length > 0.0 ? std::min(1.0, std::max(0.0, d.dot(e) / length)) : 0.0;
  return (e - t * d).norm();
}
} // namespace

CellZone::CellZone(const SurfaceTree& tree, const TrimRegion& region, double margin)
  : Tree(tree)
{
  const std::vector<TreeLeaf>& leaves = tree.Leaves();
  const std::vector<std::pair<int, int>> cut = region.CutLeaves(tree, margin);
  std::vector<char> isCut(leaves.size(), 0);
  for (const auto& pair : cut)
  {
    isCut[pair.first] = 1;
  }
  for (std::size_t k = 0; k < leaves.size(); ++k)
  {
    const ParameterBox& box = leaves[k].Box;
    if (!isCut[k] && region.Inside(Vec2(0.5 * (box.U0 + box.U1), 0.5 * (box.V0 + box.V1))))
    {
      this->Whole.push_back(int(k));
    }
  }
  this->Index.reserve(2 * this->Whole.size() + 64);
  this->CornersOf.reserve(this->Whole.size());
  for (int k : this->Whole)
  {
    const TreeLeaf& leaf = leaves[k];
    this->CornersOf.push_back({ this->Vertex(leaf.U0, leaf.V0), this->Vertex(leaf.U1, leaf.V0),
      this->Vertex(leaf.U0, leaf.V1), this->Vertex(leaf.U1, leaf.V1) });
  }
  this->KeepCutCorners(region, cut);
}

int CellZone::Vertex(LineCode u, LineCode v)
{
  const auto found = this->Index.emplace(Key{ u, v }, int(this->Keys.size()));
  if (found.second)
  {
    this->Keys.push_back({ u, v });
    this->Vertices.emplace_back(this->Tree.Parameter(0, u), this->Tree.Parameter(1, v));
  }
  return found.first->second;
}

void CellZone::KeepCutCorners(const TrimRegion& region, const std::vector<std::pair<int, int>>& cut)
{
  const std::vector<TreeLeaf>& leaves = this->Tree.Leaves();
  std::unordered_map<Key, bool, Hash> keep;
  std::vector<Key> order;
  for (std::size_t begin = 0; begin < cut.size();)
  {
    std::size_t end = begin;
    while (end < cut.size() && cut[end].first == cut[begin].first)
    {
      ++end;
    }
    const TreeLeaf& leaf = leaves[cut[begin].first];
    const LineCode us[2] = { leaf.U0, leaf.U1 };
    const LineCode vs[2] = { leaf.V0, leaf.V1 };
    for (int c = 0; c < 4; ++c)
    {
      const Key key{ us[c & 1], vs[c >> 1] };
      if (this->Index.count(key))
      {
        continue;
      }
      const auto found = keep.emplace(key, true);
      if (found.second)
      {
        order.push_back(key);
      }
      const Vec2 p(this->Tree.Parameter(0, key.U), this->Tree.Parameter(1, key.V));
      for (std::size_t k = begin; k < end && found.first->second; ++k)
      {
        const auto& side = region.Segments()[cut[k].second];
        found.first->second =
          UnitDistance(p, region.Points()[side.first], region.Points()[side.second],
            1.0 / leaf.Box.A(), 1.0 / leaf.Box.B()) >= KeepDistance;
      }
    }
    begin = end;
  }
  for (const Key& key : order)
  {
    const Vec2 p(this->Tree.Parameter(0, key.U), this->Tree.Parameter(1, key.V));
    if (keep[key] && region.Inside(p))
    {
      this->Free.push_back(this->Vertex(key.U, key.V));
    }
  }
}

void CellZone::LinkVertices()
{
  struct Item
  {
    LineCode Line, Along;
    int Vertex;
    bool operator<(const Item& o) const
    {
      return this->Line != o.Line ? this->Line < o.Line : this->Along < o.Along;
    }
  };
  const std::size_t n = this->Keys.size();
  std::vector<Item> items(n);
  const auto link = [&](std::vector<int>& next, LineCode Key::*line, LineCode Key::*along) {
    for (std::size_t k = 0; k < n; ++k)
    {
      items[k] = { this->Keys[k].*line, this->Keys[k].*along, int(k) };
    }
    std::sort(items.begin(), items.end());
    next.assign(n, -1);
    for (std::size_t k = 1; k < n; ++k)
    {
      if (items[k - 1].Line == items[k].Line)
      {
        next[items[k - 1].Vertex] = items[k].Vertex;
      }
    }
  };
  link(this->NextU, &Key::V, &Key::U);
  link(this->NextV, &Key::U, &Key::V);
}

struct CellZone::Part
{
  std::vector<Triangle> Triangles; // A corner -1 - k is the middle of the leaf Fans[k].
  std::vector<std::pair<int, int>> Directed;
  std::vector<int> Fans;
};

std::uint64_t CellZone::Outline(const std::vector<int>& polygon) const
{
  std::uint64_t hash = 1469598103934665603ull;
  for (int vertex : polygon)
  {
    hash = (hash ^ std::uint64_t(this->Keys[vertex].U)) * 1099511628211ull;
    hash = (hash ^ std::uint64_t(this->Keys[vertex].V)) * 1099511628211ull;
  }
  return hash | 1;
}

void CellZone::TriangulatePart(std::size_t begin, std::size_t end, const ErrorOf& errorOf,
  FacetBound bound, std::vector<LeafState>& states, Part& out) const
{
  std::vector<int> polygon;
  std::vector<int> lower;
  std::vector<int> upper;
  for (std::size_t at = begin; at < end; ++at)
  {
    const int k = this->Whole[at];
    const TreeLeaf& leaf = this->Tree.Leaves()[k];
    this->Polygon(this->CornersOf[at], polygon, lower, upper);
    const int m = int(polygon.size());
    for (int i = 0; i < m; ++i)
    {
      out.Directed.emplace_back(polygon[i], polygon[(i + 1) % m]);
    }
    if (m == 4)
    {
      const int* c = polygon.data();
      const int d = leaf.Diagonal;
      out.Triangles.push_back({ { c[0], c[1], c[2 + d] }, k, true });
      out.Triangles.push_back({ { c[d], c[2], c[3] }, k, true });
      continue;
    }
    LeafState& state = states[k];
    const std::uint64_t outline = this->Outline(polygon);
    const bool known = state.Outline == outline;
    const std::size_t first = out.Triangles.size();
    if (!known || !state.Fan)
    {
      this->Monotone(k, lower, upper, out.Triangles);
    }
    if (!known)
    {
      state = LeafState();
      state.Outline = outline;
      for (std::size_t t = first; t < out.Triangles.size() && state.Error < NotGood; ++t)
      {
        state.Error = std::max(state.Error, errorOf(bound, out.Triangles[t]));
      }
      state.Fan = state.Error == NotGood;
      state.Error = state.Fan ? -1.0 : state.Error;
    }
    if (state.Fan)
    {
      out.Triangles.resize(first);
      out.Fans.push_back(k);
      for (int i = 0; i < m; ++i)
      {
        out.Triangles.push_back(
          { { polygon[i], polygon[(i + 1) % m], -int(out.Fans.size()) }, k, false });
      }
    }
  }
}

void CellZone::TriangulateWhole(const ErrorOf& errorOf, const FacetBound& bound,
  std::vector<LeafState>& states, const ParallelFor& parallel)
{
  this->LinkVertices();
  states.resize(this->Tree.Leaves().size());
  constexpr std::size_t Grain = 2048;
  std::vector<Part> parts((this->Whole.size() + Grain - 1) / Grain);
  parallel(0, std::int64_t(parts.size()), [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t p = begin; p < end; ++p)
    {
      const std::size_t from = std::size_t(p) * Grain;
      this->TriangulatePart(
        from, std::min(from + Grain, this->Whole.size()), errorOf, bound, states, parts[p]);
    }
  });
  std::vector<std::pair<int, int>> directed;
  for (const Part& part : parts)
  {
    const int middles = int(this->Vertices.size());
    for (int k : part.Fans)
    {
      const ParameterBox& box = this->Tree.Leaves()[k].Box;
      this->Vertices.emplace_back(0.5 * (box.U0 + box.U1), 0.5 * (box.V0 + box.V1));
    }
    for (Triangle t : part.Triangles)
    {
      for (int& corner : t.Corner)
      {
        corner = corner < 0 ? middles - corner - 1 : corner;
      }
      this->Result.push_back(t);
    }
    directed.insert(directed.end(), part.Directed.begin(), part.Directed.end());
  }
  this->FindOpenSides(directed);
}

// Sides without a partner face the border zone.
void CellZone::FindOpenSides(const std::vector<std::pair<int, int>>& directed)
{
  // By the lower vertex, each side's other vertex; a side that comes twice is inside.
  const auto low = [](const std::pair<int, int>& s) { return std::min(s.first, s.second); };
  const auto high = [](const std::pair<int, int>& s) { return std::max(s.first, s.second); };
  std::vector<int> start(this->Vertices.size() + 2, 0);
  for (const auto& side : directed)
  {
    ++start[low(side) + 2];
  }
  for (std::size_t k = 2; k < start.size(); ++k)
  {
    start[k] += start[k - 1];
  }
  std::vector<int> item(directed.size());
  for (std::size_t k = 0; k < directed.size(); ++k)
  {
    item[start[low(directed[k]) + 1]++] = int(k);
  }
  for (std::size_t v = 0; v + 1 < start.size(); ++v)
  {
    for (int a = start[v]; a < start[v + 1]; ++a)
    {
      bool alone = true;
      for (int b = start[v]; b < start[v + 1] && alone; ++b)
      {
        alone = a == b || high(directed[item[a]]) != high(directed[item[b]]);
      }
      if (alone)
      {
        this->Sides.emplace_back(directed[item[a]].second, directed[item[a]].first);
      }
    }
  }
}

// The cell's outline, counter-clockwise from (U0, V0), and its chains by ascending (u, v): `lower`
// from (U0, V0) to (U1, V1) along the bottom and right sides, `upper` along the left and top ones.
void CellZone::Polygon(const Corners& corners, std::vector<int>& polygon, std::vector<int>& lower,
  std::vector<int>& upper) const
{
  const auto chain = [&](const std::vector<int>& firstNext, int middle,
                       const std::vector<int>& lastNext, std::vector<int>& out) {
    out.clear();
    for (int vertex = corners[0]; vertex != middle; vertex = firstNext[vertex])
    {
      out.push_back(vertex);
    }
    for (int vertex = middle; vertex != corners[3]; vertex = lastNext[vertex])
    {
      out.push_back(vertex);
    }
    out.push_back(corners[3]);
  };
  chain(this->NextU, corners[1], this->NextV, lower);
  chain(this->NextV, corners[2], this->NextU, upper);
  polygon.assign(lower.begin(), lower.end());
  polygon.insert(polygon.end(), upper.rbegin() + 1, upper.rend() - 1);
}

// Linear-time triangulation of a convex cell with vertices on its sides: the sweep for monotone
// polygons, in (u, v) order. Collinear triples never make a triangle.
void CellZone::Monotone(int leaf, const std::vector<int>& lower, const std::vector<int>& upper,
  std::vector<Triangle>& out) const
{
  const std::vector<Key>& keys = this->Keys;
  const auto before = [&](int a, int b) {
    return keys[a].U != keys[b].U ? keys[a].U < keys[b].U : keys[a].V < keys[b].V;
  };
  const auto turn = [&](int a, int b, int c) {
    const Vec2 ab = this->Vertices[b] - this->Vertices[a];
    const Vec2 ac = this->Vertices[c] - this->Vertices[a];
    if ((keys[a].U == keys[b].U && keys[b].U == keys[c].U) ||
      (keys[a].V == keys[b].V && keys[b].V == keys[c].V))
    {
      return 0.0;
    }
    return ab[0] * ac[1] - ab[1] * ac[0];
  };
  const auto emit = [&](int a, int b, int c) {
    const double t = turn(a, b, c);
    if (t > 0.0)
    {
      out.push_back({ { a, b, c }, leaf, false });
    }
    else if (t < 0.0)
    {
      out.push_back({ { a, c, b }, leaf, false });
    }
  };
  struct Item
  {
    int Vertex;
    bool Upper;
  };
  std::vector<Item> order;
  std::size_t i = 0;
  std::size_t j = 1; // upper[0] == lower[0], upper.back() == lower.back()
  while (i < lower.size())
  {
    if (j + 1 < upper.size() && before(upper[j], lower[i]))
    {
      order.push_back({ upper[j++], true });
    }
    else
    {
      order.push_back({ lower[i++], false });
    }
  }
  std::vector<Item> stack{ order[0], order[1] };
  for (std::size_t k = 2; k < order.size(); ++k)
  {
    const Item v = order[k];
    const bool last = k + 1 == order.size();
    if (v.Upper != stack.back().Upper || last)
    {
      for (std::size_t s = 0; s + 1 < stack.size(); ++s)
      {
        emit(stack[s].Vertex, stack[s + 1].Vertex, v.Vertex);
      }
      stack.assign({ stack.back(), v });
      continue;
    }
    while (stack.size() >= 2)
    {
      const int a = stack[stack.size() - 2].Vertex;
      const int b = stack.back().Vertex;
      const double t = turn(a, b, v.Vertex);
      if (v.Upper ? t >= 0.0 : t <= 0.0)
      {
        break;
      }
      emit(a, b, v.Vertex);
      stack.pop_back();
    }
    stack.push_back(v);
  }
}

} // namespace nurbs
