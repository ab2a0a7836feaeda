// SPDX-License-Identifier: BSD-3-Clause
#include "RectangleTriangulation.h"

namespace nurbs
{

namespace
{

// Bits of the sides that a vertex is on.
int SidesOf(const Vec2& p)
{
  return (p[1] == 0.0 ? 1 : 0) | (p[0] == 1.0 ? 2 : 0) | (p[1] == 1.0 ? 4 : 0) |
    (p[0] == 0.0 ? 8 : 0);
}

} // namespace

std::vector<std::array<int, 3>> TriangulateRectangle(
  const std::vector<Vec2>& corners, const std::vector<Vec3>& points)
{
  std::vector<std::array<int, 3>> out;
  if (corners.size() == 4)
  {
    const double first = (points[2] - points[0]).squaredNorm();
    const double second = (points[3] - points[1]).squaredNorm();
    if (first <= second)
    {
      return { { 0, 1, 2 }, { 0, 2, 3 } };
    }
    return { { 0, 1, 3 }, { 1, 2, 3 } };
  }
  std::vector<int> sides;
  for (const Vec2& p : corners)
  {
    sides.push_back(SidesOf(p));
  }
  std::vector<int> left;
  for (int i = 0; i < int(corners.size()); ++i)
  {
    left.push_back(i);
  }
  // Cuts off the vertex whose neighbours are nearest to each other, but none that lies between its
  // neighbours on a side, nor one that would leave the others on a side.
  while (left.size() > 3)
  {
    const std::size_t n = left.size();
    std::size_t best = n;
    double shortest = 0.0;
    for (std::size_t k = 0; k < n; ++k)
    {
      const int a = left[(k + n - 1) % n];
      const int b = left[(k + 1) % n];
      int others = 15;
      for (std::size_t m = 0; m < n && others != 0; ++m)
      {
        others &= m == k ? 15 : sides[left[m]];
      }
      if ((sides[a] & sides[left[k]] & sides[b]) != 0 || others != 0)
      {
        continue;
      }
      const double length = (points[a] - points[b]).squaredNorm();
      if (best == n || length < shortest)
      {
        best = k;
        shortest = length;
      }
    }
    if (best == n) // All that are left are on one side: no rectangle.
    {
      return out;
    }
    out.push_back({ left[(best + n - 1) % n], left[best], left[(best + 1) % n] });
    left.erase(left.begin() + std::ptrdiff_t(best));
  }
  out.push_back({ left[0], left[1], left[2] });
  return out;
}

} // namespace nurbs
