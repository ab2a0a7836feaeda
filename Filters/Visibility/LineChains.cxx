// SPDX-License-Identifier: BSD-3-Clause
#include "LineChains.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace nurbs
{

namespace
{

struct Pair
{
  double Distance;
  std::size_t A, B;
};

std::array<std::int64_t, 4> CellOf(const LineEnd& end, double size)
{
  return { { end.Group, std::int64_t(std::floor(end.Point[0] / size)),
    std::int64_t(std::floor(end.Point[1] / size)),
    std::int64_t(std::floor(end.Point[2] / size)) } };
}

bool MayJoin(const LineEnd& a, const LineEnd& b, bool anyEnd)
{
  return a.Group == b.Group && (anyEnd || a.End != b.End) && (a.Line != b.Line || a.End != b.End) &&
    (a.Point - b.Point).norm() <= std::max(a.Reach, b.Reach);
}

std::vector<Pair> FindPairs(const std::vector<LineEnd>& ends, bool anyEnd)
{
  double size = 0.0;
  for (const LineEnd& end : ends)
  {
    size = std::max(size, end.Reach);
  }
  std::map<std::array<std::int64_t, 4>, std::vector<std::size_t>> grid;
  std::vector<Pair> pairs;
  for (std::size_t k = 0; k < ends.size() && size > 0.0; ++k)
  {
    const std::array<std::int64_t, 4> cell = CellOf(ends[k], size);
    for (int n = 0; n < 27; ++n)
    {
      const auto found = grid.find(
        { { cell[0], cell[1] + n % 3 - 1, cell[2] + n / 3 % 3 - 1, cell[3] + n / 9 - 1 } });
      if (found == grid.end())
      {
        continue;
      }
      for (const std::size_t other : found->second)
      {
        if (MayJoin(ends[k], ends[other], anyEnd))
        {
          pairs.push_back({ (ends[k].Point - ends[other].Point).norm(), other, k });
        }
      }
    }
    grid[cell].push_back(k);
  }
  return pairs;
}

} // namespace

void JoinEnds(const std::vector<LineEnd>& ends, bool anyEnd, std::vector<SilhouetteLine>& lines)
{
  std::vector<Pair> pairs = FindPairs(ends, anyEnd);
  std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    return std::tie(a.Distance, a.A, a.B) < std::tie(b.Distance, b.A, b.B);
  });
  for (const Pair& pair : pairs)
  {
    const LineEnd& a = ends[pair.A];
    const LineEnd& b = ends[pair.B];
    if (lines[a.Line].Next[a.End] < 0 && lines[b.Line].Next[b.End] < 0)
    {
      lines[a.Line].Next[a.End] = b.Line;
      lines[a.Line].NextEnd[a.End] = b.End;
      lines[b.Line].Next[b.End] = a.Line;
      lines[b.Line].NextEnd[b.End] = a.End;
    }
  }
}

void NumberChains(std::vector<SilhouetteLine>& lines, std::int64_t (&counts)[LineKindCount])
{
  std::int64_t number = 0;
  std::vector<std::int64_t> waiting;
  for (std::size_t k = 0; k < lines.size(); ++k)
  {
    if (lines[k].Chain >= 0)
    {
      continue;
    }
    ++counts[static_cast<int>(lines[k].Kind)];
    waiting.assign(1, std::int64_t(k));
    lines[k].Chain = number;
    while (!waiting.empty())
    {
      const std::int64_t line = waiting.back();
      waiting.pop_back();
      for (const std::int64_t next : lines[line].Next)
      {
        if (next >= 0 && lines[next].Chain < 0)
        {
          lines[next].Chain = number;
          waiting.push_back(next);
        }
      }
    }
    ++number;
  }
}

} // namespace nurbs
