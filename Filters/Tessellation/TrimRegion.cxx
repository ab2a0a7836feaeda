// SPDX-License-Identifier: BSD-3-Clause
#include "TrimRegion.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

TrimRegion::TrimRegion(const std::vector<std::vector<BoundaryVertex>>& loops)
{
  for (const auto& loop : loops)
  {
    const int first = int(this->Corners.size());
    const int n = int(loop.size());
    for (int k = 0; k < n; ++k)
    {
      this->Corners.push_back(loop[k].UV);
      this->Sides.emplace_back(first + k, first + (k + 1) % n);
    }
  }
  double low = 1e300;
  double high = -1e300;
  for (const Vec2& p : this->Corners)
  {
    low = std::min(low, p[1]);
    high = std::max(high, p[1]);
  }
  const int rows = std::max(1, int(this->Sides.size()) / 2);
  this->Low = low;
  this->Step = high > low ? (high - low) / rows : 1.0;
  const auto row = [&](double v) {
    return std::min(rows - 1, std::max(0, int(std::floor((v - this->Low) / this->Step))));
  };
  std::vector<int> count(rows + 1, 0);
  for (int pass = 0; pass < 2; ++pass)
  {
    for (std::size_t s = 0; s < this->Sides.size(); ++s)
    {
      const double a = this->Corners[this->Sides[s].first][1];
      const double b = this->Corners[this->Sides[s].second][1];
      for (int r = row(std::min(a, b)); r <= row(std::max(a, b)); ++r)
      {
        if (pass == 0)
        {
          ++count[r + 1];
        }
        else
        {
          this->BucketItems[count[r]++] = int(s);
        }
      }
    }
    if (pass == 0)
    {
      for (int r = 0; r < rows; ++r)
      {
        count[r + 1] += count[r];
      }
      this->BucketStart = count;
      this->BucketItems.resize(count[rows]);
    }
  }
}

bool TrimRegion::Inside(const Vec2& p) const
{
  const int rows = int(this->BucketStart.size()) - 1;
  const double at = std::floor((p[1] - this->Low) / this->Step);
  if (!(at >= -1.0 && at <= rows))
  {
    return false;
  }
  const int r = std::min(rows - 1, std::max(0, int(at)));
  bool inside = false;
  for (int k = this->BucketStart[r]; k < this->BucketStart[r + 1]; ++k)
  {
    const Vec2& a = this->Corners[this->Sides[this->BucketItems[k]].first];
    const Vec2& b = this->Corners[this->Sides[this->BucketItems[k]].second];
    if ((a[1] <= p[1]) != (b[1] <= p[1]))
    {
      const double u = a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
      inside = inside != (u > p[0]);
    }
  }
  return inside;
}

bool TrimRegion::Crosses(int dir, double value, double from, double to) const
{
  for (const auto& side : this->Sides)
  {
    const Vec2& a = this->Corners[side.first];
    const Vec2& b = this->Corners[side.second];
    if ((a[dir] < value && b[dir] > value) || (a[dir] > value && b[dir] < value))
    {
      const double t = (value - a[dir]) / (b[dir] - a[dir]);
      const double at = a[1 - dir] + t * (b[1 - dir] - a[1 - dir]);
      if (at > from && at < to)
      {
        return true;
      }
    }
  }
  return false;
}

std::vector<std::pair<int, int>> TrimRegion::CutLeaves(const SurfaceTree& tree, double margin) const
{
  std::vector<std::pair<int, int>> cut;
  for (std::size_t s = 0; s < this->Sides.size(); ++s)
  {
    const Vec2& a = this->Corners[this->Sides[s].first];
    const Vec2& b = this->Corners[this->Sides[s].second];
    tree.QuerySegment(a, b, margin, [&](int leaf) { cut.emplace_back(leaf, int(s)); });
  }
  std::sort(cut.begin(), cut.end());
  return cut;
}

} // namespace nurbs
