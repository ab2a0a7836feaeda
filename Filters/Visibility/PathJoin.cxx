// SPDX-License-Identifier: BSD-3-Clause
#include "PathJoin.h"

#include "PathFit.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace nurbs
{
namespace
{

struct LineEnd
{
  std::size_t Line;
  int End; // 0: first point, 1: last.
  Vec2 Point;
  Vec2 Out;   // The chord that leaves the line here.
  double Key; // Ends that are near each other have near keys; others seldom do.
};

// Across no direction that drawings are full of.
const Vec2 KeyDirection(0.7981, 0.6025);

struct Pair
{
  double Turn;
  std::size_t A, B; // Ends.
};

bool IsClosed(const std::vector<Vec2>& points)
{
  return points.front() == points.back();
}

bool HasLength(const std::vector<Vec2>& points)
{
  return std::any_of(
    points.begin(), points.end(), [&](const Vec2& p) { return p != points.front(); });
}

std::vector<LineEnd> EndsOf(const std::vector<PlaneLine>& lines, double tolerance)
{
  std::vector<LineEnd> ends;
  for (std::size_t k = 0; k < lines.size(); ++k)
  {
    const std::vector<Vec2>& points = lines[k].Points;
    if (HasLength(points) && !IsClosed(points))
    {
      ends.push_back({ k, 0, points.front(), -ChordAtEnd(points, 0, tolerance),
        points.front().dot(KeyDirection) });
      ends.push_back(
        { k, 1, points.back(), ChordAtEnd(points, 1, tolerance), points.back().dot(KeyDirection) });
    }
  }
  return ends;
}

// All pairs of ends that may be joined, those that turn least first. Ends are sorted by group and
// key.
std::vector<Pair> FindPairs(const std::vector<PlaneLine>& lines, const std::vector<LineEnd>& ends,
  double reach, double tolerance)
{
  std::vector<Pair> pairs;
  for (std::size_t a = 0; a < ends.size(); ++a)
  {
    const PlaneLine& line = lines[ends[a].Line];
    for (std::size_t b = a + 1; b < ends.size(); ++b)
    {
      const PlaneLine& other = lines[ends[b].Line];
      if (other.Group != line.Group || ends[b].Key > ends[a].Key + reach)
      {
        break;
      }
      const Vec2 &out = ends[a].Out, in = -ends[b].Out;
      const bool same = line.Source == other.Source;
      if ((ends[b].Point - ends[a].Point).norm() <= reach &&
        (same || !IsCorner(out, in, tolerance)))
      {
        const double turn = std::atan2(out.x() * in.y() - out.y() * in.x(), out.dot(in));
        pairs.push_back({ std::abs(turn), a, b });
      }
    }
  }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& p, const Pair& q) {
    return std::tie(p.Turn, p.A, p.B) < std::tie(q.Turn, q.A, q.B);
  });
  return pairs;
}

// The end that each end of a line goes on in: 2 line + end, or -1.
using Links = std::vector<std::int64_t>;

Links LinkEnds(const std::vector<PlaneLine>& lines, double reach, double tolerance)
{
  std::vector<LineEnd> ends = EndsOf(lines, tolerance);
  std::sort(ends.begin(), ends.end(), [&](const LineEnd& p, const LineEnd& q) {
    return std::make_tuple(lines[p.Line].Group, p.Key, p.Line, p.End) <
      std::make_tuple(lines[q.Line].Group, q.Key, q.Line, q.End);
  });
  Links links(2 * lines.size(), -1);
  for (const Pair& pair : FindPairs(lines, ends, reach, tolerance))
  {
    const std::size_t a = 2 * ends[pair.A].Line + std::size_t(ends[pair.A].End);
    const std::size_t b = 2 * ends[pair.B].Line + std::size_t(ends[pair.B].End);
    if (links[a] < 0 && links[b] < 0)
    {
      links[a] = std::int64_t(b);
      links[b] = std::int64_t(a);
    }
  }
  return links;
}

// The end of a chain that a line belongs to, against the line's direction; of a loop the line's
// own.
std::size_t StartOfChain(const Links& links, std::size_t line)
{
  std::size_t end = 2 * line;
  while (links[end] >= 0)
  {
    end = std::size_t(links[end]) ^ 1u;
    if (end == 2 * line)
    {
      break;
    }
  }
  return end;
}

} // namespace

//--------------------------------------------------------------------------------------------------
std::vector<JoinedLine> JoinLines(
  const std::vector<PlaneLine>& lines, double reach, double tolerance)
{
  const Links links = LinkEnds(lines, reach, tolerance);
  std::vector<bool> used(lines.size(), false);
  std::vector<JoinedLine> all;
  for (std::size_t k = 0; k < lines.size(); ++k)
  {
    if (used[k] || !HasLength(lines[k].Points))
    {
      continue;
    }
    JoinedLine joined;
    const std::size_t start = StartOfChain(links, k);
    std::size_t end = start;
    for (;;)
    {
      const std::size_t line = end / 2;
      std::vector<Vec2> points = lines[line].Points;
      if (end % 2 == 1)
      {
        std::reverse(points.begin(), points.end());
      }
      joined.Points.insert(
        joined.Points.end(), points.begin() + (joined.Points.empty() ? 0 : 1), points.end());
      joined.Members.push_back(line);
      used[line] = true;
      const std::int64_t next = links[end ^ 1u];
      if (next < 0)
      {
        break;
      }
      end = std::size_t(next);
      if (end == start)
      {
        joined.Points.back() = joined.Points.front();
        break;
      }
    }
    all.push_back(std::move(joined));
  }
  return all;
}

} // namespace nurbs
