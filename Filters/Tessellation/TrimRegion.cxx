// SPDX-License-Identifier: BSD-3-Clause
#include "TrimRegion.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

TrimRegion::TrimRegion(const std::vector<std::vector<BoundaryVertex>>& loops, const Vec2& near)
  : Near(near)
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

bool TrimRegion::IsOnLine(int dir, const Vec2& p) const
{
  for (const auto& side : this->Sides)
  {
    const Vec2& a = this->Corners[side.first];
    const Vec2& b = this->Corners[side.second];
    if (a[dir] == p[dir] && b[dir] == p[dir] &&
      (a[1 - dir] <= p[1 - dir]) != (b[1 - dir] < p[1 - dir]))
    {
      return true;
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
    bool small = false;
    tree.QuerySegment(a, b, margin, [&](int leaf) {
      const ParameterBox& box = tree.Leaves()[leaf].Box;
      small = small || margin * box.A() < this->Near[0] || margin * box.B() < this->Near[1];
      cut.emplace_back(leaf, int(s));
    });
    for (int k = 0; k < 4 && small; ++k)
    {
      Vec2 shift = Vec2::Zero();
      shift[k / 2] = k % 2 == 0 ? this->Near[k / 2] : -this->Near[k / 2];
      tree.QuerySegment(
        a + shift, b + shift, 0.0, [&](int leaf) { cut.emplace_back(leaf, int(s)); });
    }
  }
  std::sort(cut.begin(), cut.end());
  cut.erase(std::unique(cut.begin(), cut.end()), cut.end());
  return cut;
}

// Between two knots that nearly coincide there are cells a thousand times narrower than their
// neighbours. They must not spoil the mean: every cell counts by the share of the trim lines (in units
// of the domain) that runs through it, and those so narrow that triangles in them may have any shape,
// not at all. The mean of square roots leans to the small cells, where a wrong shape costs most.
Vec2 TrimRegion::CellScale(const SurfaceTree& tree) const
{
  const Vec2 extent(
    tree.Lines(0).back() - tree.Lines(0).front(), tree.Lines(1).back() - tree.Lines(1).front());
  Vec2 sum = Vec2::Zero();
  for (const auto& side : this->Sides)
  {
    const Vec2& a = this->Corners[side.first];
    const Vec2 d = this->Corners[side.second] - a;
    const double length = d.cwiseQuotient(extent).norm();
    const int parts = 1 + int(std::min(32.0, 32.0 * length));
    for (int k = 0; k < parts; ++k)
    {
      const Vec2 p = a + (k + 0.5) / parts * d;
      tree.Query({ p[0], p[0], p[1], p[1] }, [&](int leaf) {
        const ParameterBox& box = tree.Leaves()[leaf].Box;
        if (box.A() > this->Near[0] && box.B() > this->Near[1])
        {
          sum += length / parts * Vec2(1.0 / std::sqrt(box.A()), 1.0 / std::sqrt(box.B()));
        }
      });
    }
  }
  const double ratio = sum[0] > 0.0 ? std::exp2(std::round(2.0 * std::log2(sum[1] / sum[0]))) : 1.0;
  return ratio < 1.0 ? Vec2(1.0, ratio) : Vec2(1.0 / ratio, 1.0);
}

} // namespace nurbs
