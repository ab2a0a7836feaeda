// SPDX-License-Identifier: BSD-3-Clause
#include "ChainStitch.h"

#include <algorithm>
#include <map>

namespace nurbs
{

namespace
{
constexpr std::size_t LongestChain = 2000; // Filling takes quadratic time.

// Directed sides with their number of uses; a side and its reverse cancel.
using Sides = std::map<std::pair<int, int>, int>;

void Add(Sides& sides, const Chains& chains, bool reversed)
{
  for (const std::vector<int>& chain : chains)
  {
    for (std::size_t k = 0; k < chain.size(); ++k)
    {
      std::pair<int, int> side(chain[k], chain[(k + 1) % chain.size()]);
      if (reversed)
      {
        std::swap(side.first, side.second);
      }
      const auto back = sides.find({ side.second, side.first });
      if (side.first == side.second)
      {
        continue;
      }
      if (back == sides.end())
      {
        ++sides[side];
      }
      else if (--back->second == 0)
      {
        sides.erase(back);
      }
    }
  }
}

// Takes the sides apart into chains that visit no vertex twice. As many sides end in a vertex as
// start there.
Chains TakeSimpleChains(Sides& sides)
{
  Chains chains;
  std::vector<int> path;
  while (!sides.empty() || path.size() > 1)
  {
    if (path.empty())
    {
      path.push_back(sides.begin()->first.first);
    }
    const auto next = sides.lower_bound({ path.back(), -1 });
    if (next == sides.end() || next->first.first != path.back())
    {
      path.clear();
      continue;
    }
    const int to = next->first.second;
    if (--next->second == 0)
    {
      sides.erase(next);
    }
    const auto before = std::find(path.begin(), path.end(), to);
    if (before != path.end())
    {
      chains.emplace_back(before, path.end());
      path.erase(before + 1, path.end());
    }
    else
    {
      path.push_back(to);
    }
    if (path.size() == 1)
    {
      path.clear();
    }
  }
  return chains;
}

// Height of a triangle over its longest side.
double Altitude(const Vec3& a, const Vec3& b, const Vec3& c)
{
  const double area = (b - a).cross(c - a).norm();
  const double longest = std::max({ (b - a).norm(), (c - b).norm(), (a - c).norm() });
  return longest > 0.0 ? area / longest : 0.0;
}

// Cuts off the flattest corner until nothing is left. Every triangle is within its height of a side
// or of a cut, which is a side of triangles cut off later.
double Fill(std::vector<int> chain, const std::vector<Vec3>& points,
  std::vector<std::array<int, 3>>& triangles)
{
  double error = 0.0;
  while (chain.size() >= 3)
  {
    const std::size_t n = chain.size();
    std::size_t best = 0;
    double least = 1e300;
    for (std::size_t k = 0; k < n; ++k)
    {
      const double altitude =
        Altitude(points[chain[(k + n - 1) % n]], points[chain[k]], points[chain[(k + 1) % n]]);
      if (altitude < least)
      {
        least = altitude;
        best = k;
      }
    }
    triangles.push_back({ chain[(best + n - 1) % n], chain[best], chain[(best + 1) % n] });
    chain.erase(chain.begin() + std::ptrdiff_t(best));
    error += least;
  }
  return error;
}
} // namespace

Stitches StitchChains(
  const Chains& given, const Chains& made, const std::vector<Vec3>& points, double limit)
{
  Sides sides;
  Add(sides, given, false);
  Add(sides, made, true);
  Stitches out;
  for (const std::vector<int>& chain : TakeSimpleChains(sides))
  {
    std::vector<std::array<int, 3>> triangles;
    if (chain.size() > LongestChain)
    {
      ++out.Open;
      continue;
    }
    const double error = Fill(chain, points, triangles);
    if (error > limit)
    {
      ++out.Open;
      continue;
    }
    out.Triangles.insert(out.Triangles.end(), triangles.begin(), triangles.end());
    out.Error = std::max(out.Error, error);
  }
  return out;
}

} // namespace nurbs
