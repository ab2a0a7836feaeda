// SPDX-License-Identifier: BSD-3-Clause
#include "LoopCrossings.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

struct Side
{
  const LevelLoopVertex* A;
  const LevelLoopVertex* B;
  double Low, High; // In u.
};

double Turn(const Vec2& a, const Vec2& b, const Vec2& c)
{
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

bool Cross(const Side& s, const Side& t)
{
  const Vec2& a = s.A->UV;
  const Vec2& b = s.B->UV;
  const Vec2& c = t.A->UV;
  const Vec2& d = t.B->UV;
  if (a == c || a == d || b == c || b == d)
  {
    return false;
  }
  return Turn(a, b, c) * Turn(a, b, d) <= 0.0 && Turn(c, d, a) * Turn(c, d, b) <= 0.0 &&
    std::min(a[1], b[1]) <= std::max(c[1], d[1]) && std::min(c[1], d[1]) <= std::max(a[1], b[1]);
}

// A polygon of fewer than three places, or without area.
bool IsCollapsed(const std::vector<LevelLoopVertex>& loop)
{
  double area = 0.0;
  Box2 box;
  std::vector<Vec3> places;
  for (std::size_t k = 0; k < loop.size(); ++k)
  {
    const Vec2 a = loop[k].UV - loop[0].UV;
    const Vec2 b = loop[(k + 1) % loop.size()].UV - loop[0].UV;
    area += a[0] * b[1] - a[1] * b[0];
    box.extend(loop[k].UV);
    if (places.size() < 3 && std::find(places.begin(), places.end(), loop[k].X) == places.end())
    {
      places.push_back(loop[k].X);
    }
  }
  const Vec2 size = box.diagonal();
  return places.size() < 3 || std::abs(area) <= 1e-9 * size[0] * size[1];
}

bool CanSplit(const LevelLoopVertex& v)
{
  return v.Edge >= 0 && v.Last > v.First + 1;
}

} // namespace

std::vector<LevelLoopVertex> CrossingSegments(
  const std::vector<std::vector<LevelLoopVertex>>& loops)
{
  std::vector<LevelLoopVertex> out;
  std::vector<Side> sides;
  bool inside = false; // Some segment leaves the sides of the box.
  for (const std::vector<LevelLoopVertex>& loop : loops)
  {
    const bool collapsed = IsCollapsed(loop);
    for (std::size_t k = 0; k < loop.size(); ++k)
    {
      const LevelLoopVertex& a = loop[k];
      const LevelLoopVertex& b = loop[(k + 1) % loop.size()];
      sides.push_back({ &a, &b, std::min(a.UV[0], b.UV[0]), std::max(a.UV[0], b.UV[0]) });
      inside = inside || !a.OnSide;
      if (collapsed && CanSplit(a))
      {
        out.push_back(a);
      }
    }
  }
  if (!inside)
  {
    return out;
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.Low < b.Low; });
  for (std::size_t i = 0; i < sides.size(); ++i)
  {
    for (std::size_t j = i + 1; j < sides.size() && sides[j].Low <= sides[i].High; ++j)
    {
      if ((CanSplit(*sides[i].A) || CanSplit(*sides[j].A)) && Cross(sides[i], sides[j]))
      {
        for (const LevelLoopVertex* v : { sides[i].A, sides[j].A })
        {
          if (CanSplit(*v))
          {
            out.push_back(*v);
          }
        }
      }
    }
  }
  return out;
}

} // namespace nurbs
