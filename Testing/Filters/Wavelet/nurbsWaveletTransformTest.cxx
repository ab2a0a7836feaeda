// SPDX-License-Identifier: BSD-3-Clause
// The wavelet transforms against the formulas of Tan, Zhao, Lu 2012, section 4.3, and of the 5/3
// wavelet written out for one line; perfect reconstruction; borders that do not depend on what lies
// inside.
#include "WaveletPyramid.h"

#include <gtest/gtest.h>

#include <random>

namespace
{

using nurbs::DyadicAxis;
using nurbs::GridStep;
using nurbs::Vec3;
using nurbs::Wavelet;
using nurbs::WaveletPyramid;
using Line = std::vector<Vec3>;

constexpr Wavelet All[] = { Wavelet::Haar, Wavelet::Interpolating, Wavelet::Lifted };

std::vector<Vec3> RandomGrid(std::size_t count, unsigned int seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(-1.0, 1.0);
  std::vector<Vec3> out(count);
  for (Vec3& x : out)
  {
    x = Vec3(value(random), value(random), value(random));
  }
  return out;
}

DyadicAxis Axis(int base, int depth)
{
  DyadicAxis axis;
  axis.Breaks.clear();
  for (int i = 0; i <= base; ++i)
  {
    axis.Breaks.push_back(i);
  }
  axis.Depth = depth;
  return axis;
}

// One line, as the formulas are written: coarse samples, then details.
Line Reference(Wavelet kind, bool update, const Line& x)
{
  Line coarse, details;
  if (kind == Wavelet::Haar)
  {
    coarse.push_back(x.front());
    for (std::size_t k = 1; k + 2 < x.size(); k += 2)
    {
      coarse.push_back(0.5 * (x[k] + x[k + 1]));
      details.push_back(0.5 * (x[k] - x[k + 1]));
    }
    coarse.push_back(x.back());
  }
  else
  {
    for (std::size_t k = 1; k < x.size(); k += 2)
    {
      details.push_back(x[k] - 0.5 * (x[k - 1] + x[k + 1]));
    }
    for (std::size_t k = 0; k < x.size(); k += 2)
    {
      const bool inside = update && k > 0 && k + 1 < x.size();
      const Vec3 change =
        inside ? Vec3(0.25 * (details[k / 2 - 1] + details[k / 2])) : Vec3(Vec3::Zero());
      coarse.push_back(x[k] + change);
    }
  }
  coarse.insert(coarse.end(), details.begin(), details.end());
  return coarse;
}

// Rows, then columns, one line at a time; lines on the border are not updated.
std::vector<Vec3> ReferenceGrid(Wavelet kind, const std::vector<Vec3>& grid, int width, int height)
{
  std::vector<Vec3> out(grid);
  for (int j = 0; j < height; ++j)
  {
    const Line row(out.begin() + j * width, out.begin() + (j + 1) * width);
    const bool update = kind == Wavelet::Lifted && j > 0 && j + 1 < height;
    const Line done = Reference(kind, update, row);
    std::copy(done.begin(), done.end(), out.begin() + j * width);
  }
  // In the packed row the last coarse sample is the one of the other border.
  const int last = kind == Wavelet::Haar ? width / 2 : (width - 1) / 2;
  for (int i = 0; i < width; ++i)
  {
    Line column;
    for (int j = 0; j < height; ++j)
    {
      column.push_back(out[i + j * width]);
    }
    const bool update = kind == Wavelet::Lifted && i != 0 && i != last;
    const Line done = Reference(kind, update, column);
    for (int j = 0; j < height; ++j)
    {
      out[i + j * width] = done[j];
    }
  }
  return out;
}

TEST(nurbsWaveletTransform, GridIsTransformedAsTheFormulasSay)
{
  for (const Wavelet kind : All)
  {
    GridStep step;
    step.Kind = kind;
    step.Intervals[0] = 12;
    step.Intervals[1] = 8;
    step.Halved[0] = step.Halved[1] = true;
    const int width = step.FineSamples(0);
    const int height = step.FineSamples(1);
    std::vector<Vec3> grid = RandomGrid(std::size_t(width) * height, 3);
    const std::vector<Vec3> expected = ReferenceGrid(kind, grid, width, height);
    nurbs::AnalyseGrid<double, 3>(step, grid[0].data(), width);
    for (std::size_t k = 0; k < grid.size(); ++k)
    {
      ASSERT_LT((grid[k] - expected[k]).norm(), 1e-15) << "wavelet " << int(kind) << " at " << k;
    }
  }
}

TEST(nurbsWaveletTransform, CoarseSamplesAloneAreTheAnalysis)
{
  for (const Wavelet kind : All)
  {
    for (int halved = 1; halved < 4; ++halved)
    {
      GridStep step;
      step.Kind = kind;
      step.Intervals[0] = 12;
      step.Intervals[1] = 10;
      step.Halved[0] = (halved & 1) != 0;
      step.Halved[1] = (halved & 2) != 0;
      const int width = step.FineSamples(0);
      std::vector<Vec3> grid = RandomGrid(std::size_t(width) * step.FineSamples(1), 23);
      const int n = step.CoarseSamples(0);
      std::vector<Vec3> coarse(std::size_t(n) * step.CoarseSamples(1));
      nurbs::CoarsenGrid<double, 3>(step, grid[0].data(), coarse[0].data());
      nurbs::AnalyseGrid<double, 3>(step, grid[0].data(), width);
      for (int k = 0; k < int(coarse.size()); ++k)
      {
        ASSERT_LT((coarse[k] - grid[k % n + k / n * width]).norm(), 1e-15) << int(kind);
      }
    }
  }
}

// Equation (12) and (13): inside, a coarse sample is the mean of four, and the details are the
// three differences of rows, columns and diagonals.
TEST(nurbsWaveletTransform, HaarIsThePapers)
{
  GridStep step;
  step.Kind = Wavelet::Haar;
  step.Intervals[0] = step.Intervals[1] = 4;
  step.Halved[0] = step.Halved[1] = true;
  const std::vector<Vec3> x = RandomGrid(36, 5);
  std::vector<Vec3> grid = x;
  nurbs::AnalyseGrid<double, 3>(step, grid[0].data(), 6);
  for (int k = 0; k < 2; ++k)
  {
    for (int i = 0; i < 2; ++i)
    {
      const Vec3& a = x[1 + 2 * i + 6 * (1 + 2 * k)];
      const Vec3& b = x[2 + 2 * i + 6 * (1 + 2 * k)];
      const Vec3& c = x[1 + 2 * i + 6 * (2 + 2 * k)];
      const Vec3& d = x[2 + 2 * i + 6 * (2 + 2 * k)];
      EXPECT_LT((grid[1 + i + 6 * (1 + k)] - 0.25 * (a + b + c + d)).norm(), 1e-15);
      EXPECT_LT((grid[4 + i + 6 * (1 + k)] - 0.25 * (a - b + c - d)).norm(), 1e-15);
      EXPECT_LT((grid[1 + i + 6 * (4 + k)] - 0.25 * (a + b - c - d)).norm(), 1e-15);
      EXPECT_LT((grid[4 + i + 6 * (4 + k)] - 0.25 * (a - b - c + d)).norm(), 1e-15);
    }
  }
  EXPECT_EQ(grid[0], x[0]);
  EXPECT_EQ(grid[3 + 6 * 3], x[35]);
}

TEST(nurbsWaveletTransform, ReconstructionIsPerfectToRounding)
{
  for (const Wavelet kind : All)
  {
    const DyadicAxis u = Axis(3, 5);
    const DyadicAxis v = Axis(1, 2);
    const std::size_t count =
      std::size_t(LineSamples(kind, u.Intervals())) * LineSamples(kind, v.Intervals());
    const std::vector<Vec3> samples = RandomGrid(count, 7);
    const WaveletPyramid pyramid(kind, u, v, samples);
    EXPECT_EQ(pyramid.Levels(), 6);
    const std::vector<Vec3> back = pyramid.Level(0);
    ASSERT_EQ(back.size(), count);
    double error = 0.0;
    for (std::size_t k = 0; k < count; ++k)
    {
      error = std::max(error, (back[k] - samples[k]).norm());
    }
    EXPECT_LT(error, 4e-15) << "wavelet " << int(kind);
  }
}

TEST(nurbsWaveletTransform, FloatsAndFourValuesToo)
{
  for (const Wavelet kind : All)
  {
    GridStep step;
    step.Kind = kind;
    step.Intervals[0] = 16;
    step.Intervals[1] = 6;
    step.Halved[0] = step.Halved[1] = true;
    const int width = step.FineSamples(0);
    const std::vector<Vec3> x = RandomGrid(std::size_t(width) * step.FineSamples(1), 9);
    std::vector<float> values;
    for (const Vec3& p : x)
    {
      values.insert(values.end(), { float(p[0]), float(p[1]), float(p[2]), float(p[0] * p[1]) });
    }
    const std::vector<float> before = values;
    nurbs::AnalyseGrid<float, 4>(step, values.data(), width);
    std::vector<float> coarse;
    for (int j = 0; j < step.CoarseSamples(1); ++j)
    {
      const auto row = values.begin() + std::ptrdiff_t(4) * j * width;
      coarse.insert(coarse.end(), row, row + std::ptrdiff_t(4) * step.CoarseSamples(0));
    }
    std::vector<float> after(values.size());
    nurbs::SynthesiseGrid<float, 4>(step, coarse.data(), values.data(), width, after.data());
    float error = 0.0f;
    for (std::size_t k = 0; k < after.size(); ++k)
    {
      error = std::max(error, std::abs(after[k] - before[k]));
    }
    EXPECT_LT(error, 1e-6f);
  }
}

// Grids with a side in common have it in common on every level, whatever else they are.
TEST(nurbsWaveletTransform, BordersAreCurvesOfTheirOwn)
{
  for (const Wavelet kind : All)
  {
    const DyadicAxis u = Axis(2, 4);
    const DyadicAxis v = Axis(1, 4);
    const int width = LineSamples(kind, u.Intervals());
    const int height = LineSamples(kind, v.Intervals());
    std::vector<Vec3> a = RandomGrid(std::size_t(width) * height, 11);
    std::vector<Vec3> b = RandomGrid(std::size_t(width) * height, 13);
    std::copy_n(a.end() - width, width, b.begin()); // a's last row is b's first.
    DyadicAxis none;
    none.Breaks = { 0.0 };
    const WaveletPyramid curve(kind, u, none, Line(b.begin(), b.begin() + width));
    const WaveletPyramid left(kind, u, v, a);
    const WaveletPyramid right(kind, u, v, b);
    for (int level = 0; level < left.Levels(); ++level)
    {
      const std::vector<Vec3> coarseA = left.Level(level);
      const std::vector<Vec3> coarseB = right.Level(level);
      const std::vector<Vec3> line = curve.Level(level);
      const int n = LineSamples(kind, u.Intervals(level));
      ASSERT_EQ(line.size(), std::size_t(n));
      for (int i = 0; i < n; ++i)
      {
        EXPECT_EQ(coarseA[coarseA.size() - n + i], coarseB[i]) << int(kind) << " " << level;
        EXPECT_EQ(line[i], coarseB[i]);
      }
      EXPECT_LT((line.front() - b[0]).norm() + (line.back() - b[width - 1]).norm(), 1e-15);
    }
  }
}

// What the update is for: the mean of the samples inside stays the same, but for the border's
// share.
TEST(nurbsWaveletTransform, UpdateKeepsTheMean)
{
  const DyadicAxis u = Axis(1, 6);
  std::vector<Vec3> x(65 * 65, Vec3::Zero());
  x[20 + 65 * 31] = Vec3(1.0, 2.0, 3.0); // Far from the border for two levels.
  const WaveletPyramid lifted(Wavelet::Lifted, u, u, x);
  const WaveletPyramid interpolating(Wavelet::Interpolating, u, u, x);
  for (int level = 1; level <= 2; ++level)
  {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& p : lifted.Level(level))
    {
      sum += p * std::pow(4.0, level);
    }
    EXPECT_LT((sum - Vec3(1.0, 2.0, 3.0)).norm(), 1e-13);
    for (const Vec3& p : interpolating.Level(level))
    {
      EXPECT_EQ(p, Vec3(Vec3::Zero())); // It passes by the sample between its own.
    }
  }
}

TEST(nurbsWaveletTransform, LinesOfCoarseLevelsAreLinesOfFineOnes)
{
  DyadicAxis axis;
  axis.Breaks = { 0.1, 0.3, 1.7 };
  axis.Depth = 5;
  for (int level = 0; level <= 5; ++level)
  {
    const std::vector<double> lines = axis.Samples(Wavelet::Interpolating, level);
    ASSERT_EQ(int(lines.size()), axis.Intervals(level) + 1);
    for (std::size_t i = 0; i < lines.size(); ++i)
    {
      EXPECT_EQ(lines[i], axis.Line(int(i) << level));
    }
    EXPECT_TRUE(std::is_sorted(lines.begin(), lines.end()));
    const std::vector<double> middles = axis.Samples(Wavelet::Haar, level);
    ASSERT_EQ(int(middles.size()), axis.Intervals(level) + 2);
    EXPECT_EQ(middles[1], 0.5 * (lines[0] + lines[1]));
    EXPECT_EQ(middles.back(), 1.7);
  }
}

// Against samples of both interpolations in many places.
TEST(nurbsWaveletTransform, DistanceOfInterpolationsIsTheLargest)
{
  const std::vector<double> u = { 0.0, 0.3, 1.0 }, v = { 0.0, 0.6, 1.0 };
  const std::vector<double> otherU = { 0.0, 0.5, 0.8, 1.0 }, otherV = { 0.0, 1.0 };
  const std::vector<Vec3> a = RandomGrid(9, 17);
  const std::vector<Vec3> b = RandomGrid(8, 19);
  const auto at = [](const std::vector<double>& us, const std::vector<double>& vs,
                    const std::vector<Vec3>& x, double s, double t) {
    std::size_t i = 0, j = 0;
    while (i + 2 < us.size() && us[i + 1] < s)
    {
      ++i;
    }
    while (j + 2 < vs.size() && vs[j + 1] < t)
    {
      ++j;
    }
    const double p = (s - us[i]) / (us[i + 1] - us[i]);
    const double q = (t - vs[j]) / (vs[j + 1] - vs[j]);
    const std::size_t w = us.size();
    return Vec3((1 - q) * ((1 - p) * x[i + j * w] + p * x[i + 1 + j * w]) +
      q * ((1 - p) * x[i + (j + 1) * w] + p * x[i + 1 + (j + 1) * w]));
  };
  double largest = 0.0;
  for (int j = 0; j <= 100; ++j)
  {
    for (int i = 0; i <= 100; ++i)
    {
      const double s = 0.01 * i;
      const double t = 0.01 * j;
      largest = std::max(largest, (at(u, v, a, s, t) - at(otherU, otherV, b, s, t)).norm());
    }
  }
  EXPECT_NEAR(nurbs::BilinearDistance(u, v, a, otherU, otherV, b), largest, 1e-12);
}

} // namespace
