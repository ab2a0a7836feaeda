// SPDX-License-Identifier: BSD-3-Clause
#include "WaveletPyramid.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

double DyadicAxis::Line(int i) const
{
  const int base = i >> this->Depth;
  const int rest = i - (base << this->Depth);
  if (rest == 0)
  {
    return this->Breaks[base];
  }
  const double a = this->Breaks[base];
  return a + (this->Breaks[base + 1] - a) * std::ldexp(double(rest), -this->Depth);
}

std::vector<double> DyadicAxis::Samples(Wavelet kind, int level) const
{
  const int step = 1 << this->Halvings(level);
  const int n = this->Intervals(level);
  std::vector<double> out;
  out.reserve(n + 2);
  for (int i = 0; i <= n; ++i)
  {
    if (kind == Wavelet::Haar && i > 0)
    {
      out.push_back(0.5 * (this->Line((i - 1) * step) + this->Line(i * step)));
    }
    if (kind != Wavelet::Haar || i == 0 || i == n)
    {
      out.push_back(this->Line(i * step));
    }
  }
  return out;
}

namespace
{

// Where a parameter lies between lines: after line First, by Share of the interval.
struct Place
{
  int First;
  double Share;
};

std::vector<Place> PlacesOf(const std::vector<double>& lines, const std::vector<double>& at)
{
  std::vector<Place> out;
  const int last = int(lines.size()) - 1;
  int k = 0;
  for (double t : at)
  {
    while (k + 1 < last && lines[k + 1] <= t)
    {
      ++k;
    }
    out.push_back(
      last == 0 ? Place{ 0, 0.0 } : Place{ k, (t - lines[k]) / (lines[k + 1] - lines[k]) });
  }
  return out;
}

Vec3 Between(const Vec3& a, const Vec3& b, double share)
{
  return a + share * (b - a);
}

// A row of a grid's bilinear interpolation.
void InterpolateRow(const std::vector<Vec3>& grid, int width, const Place& row,
  const std::vector<Place>& columns, std::vector<Vec3>& out)
{
  const Vec3* below = grid.data() + std::size_t(row.First) * width;
  const Vec3* above = row.Share > 0.0 ? below + width : below;
  for (std::size_t i = 0; i < columns.size(); ++i)
  {
    const Place& at = columns[i];
    const int next = at.Share > 0.0 ? at.First + 1 : at.First;
    out[i] = Between(Between(below[at.First], below[next], at.Share),
      Between(above[at.First], above[next], at.Share), row.Share);
  }
}

} // namespace

double BilinearDistance(const std::vector<double>& u, const std::vector<double>& v,
  const std::vector<Vec3>& grid, const std::vector<double>& otherU,
  const std::vector<double>& otherV, const std::vector<Vec3>& other)
{
  // Both are bilinear between all their lines together, where the distance is largest at a corner.
  std::vector<double> allU, allV;
  std::set_union(u.begin(), u.end(), otherU.begin(), otherU.end(), std::back_inserter(allU));
  std::set_union(v.begin(), v.end(), otherV.begin(), otherV.end(), std::back_inserter(allV));
  const std::vector<Place> columns[2] = { PlacesOf(u, allU), PlacesOf(otherU, allU) };
  const std::vector<Place> rows[2] = { PlacesOf(v, allV), PlacesOf(otherV, allV) };
  std::vector<Vec3> line[2] = { std::vector<Vec3>(allU.size()), std::vector<Vec3>(allU.size()) };
  double largest = 0.0;
  for (std::size_t j = 0; j < allV.size(); ++j)
  {
    InterpolateRow(grid, int(u.size()), rows[0][j], columns[0], line[0]);
    InterpolateRow(other, int(otherU.size()), rows[1][j], columns[1], line[1]);
    for (std::size_t i = 0; i < allU.size(); ++i)
    {
      largest = std::max(largest, (line[0][i] - line[1][i]).squaredNorm());
    }
  }
  return std::sqrt(largest);
}

WaveletPyramid::WaveletPyramid(
  Wavelet kind, const DyadicAxis& u, const DyadicAxis& v, std::vector<Vec3> samples)
  : Kind(kind)
  , Fine{ u.Intervals(), v.Intervals() }
  , Depth{ u.Depth, v.Depth }
  , Count(1 + std::max(u.Depth, v.Depth))
  , Packed(std::move(samples))
{
  const std::int64_t pitch = this->Step(0).FineSamples(0);
  for (int level = 0; level + 1 < this->Count; ++level)
  {
    AnalyseGrid<double, 3>(this->Step(level), this->Packed[0].data(), pitch);
  }
}

GridStep WaveletPyramid::Step(int level) const
{
  GridStep step;
  step.Kind = this->Kind;
  for (int d = 0; d < 2; ++d)
  {
    step.Intervals[d] = this->Fine[d] >> std::min(level, this->Depth[d]);
    step.Halved[d] = level < this->Depth[d];
  }
  return step;
}

std::vector<Vec3> WaveletPyramid::Level(int level) const
{
  const GridStep last = this->Step(this->Count - 1);
  const std::size_t pitch = this->Step(0).FineSamples(0);
  std::vector<Vec3> grid;
  for (int j = 0; j < last.FineSamples(1); ++j)
  {
    const auto row = this->Packed.begin() + j * pitch;
    grid.insert(grid.end(), row, row + last.FineSamples(0));
  }
  for (int k = this->Count - 2; k >= level; --k)
  {
    grid = this->Refine(k, grid);
  }
  return grid;
}

std::vector<Vec3> WaveletPyramid::Refine(int level, const std::vector<Vec3>& coarse) const
{
  const GridStep step = this->Step(level);
  std::vector<Vec3> fine(std::size_t(step.FineSamples(0)) * step.FineSamples(1));
  SynthesiseGrid<double, 3>(
    step, coarse[0].data(), this->Packed[0].data(), this->Step(0).FineSamples(0), fine[0].data());
  return fine;
}

double WaveletPyramid::LargestDetail(int level) const
{
  const GridStep step = this->Step(level);
  const std::size_t pitch = this->Step(0).FineSamples(0);
  double largest = 0.0;
  for (int j = 0; j < step.FineSamples(1); ++j)
  {
    const int first = j < step.CoarseSamples(1) ? step.CoarseSamples(0) : 0;
    for (int i = first; i < step.FineSamples(0); ++i)
    {
      largest = std::max(largest, this->Packed[i + j * pitch].squaredNorm());
    }
  }
  return std::sqrt(largest);
}

} // namespace nurbs
