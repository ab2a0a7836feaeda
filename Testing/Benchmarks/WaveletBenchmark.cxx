// SPDX-License-Identifier: BSD-3-Clause
/// @file WaveletBenchmark.cxx
/// @brief Changing the level of detail by wavelets, against evaluating again.
///
/// Prints the figures of Documentation/Papers/tan-2012-wavelets.md (Tan, Zhao, Lu 2012, figure 15:
/// grids of 128 to 1024 squared of a bicubic surface of 21 x 23 control points). One thread; each
/// figure is the median of several runs, in seconds of processor time. A change to a finer level is
/// one synthesis step to the grid given, to a coarser one its coarse samples (their details are
/// known); what is evaluated again is the grid that results, by SurfaceEvaluator::Grid, the fastest
/// way there is in the suite.
#include "Measuring.h"
#include "SurfaceEvaluator.h"
#include "WaveletPyramid.h"

#include <cmath>
#include <cstdio>
#include <cstring>

using namespace nurbs;

namespace
{

constexpr int Repeat = 25;

Surface Sheet(bool rational)
{
  Surface s;
  const int count[2] = { 21, 23 };
  for (int d = 0; d < 2; ++d)
  {
    s.Degree[d] = 3;
    s.Count[d] = count[d];
    s.Knots[d] = UniformKnots(3, count[d]);
  }
  for (int j = 0; j < count[1]; ++j)
  {
    for (int i = 0; i < count[0]; ++i)
    {
      s.Points.emplace_back(i, j, std::sin(0.7 * i) * std::cos(0.5 * j));
      if (rational)
      {
        s.Weights.push_back(1.0 + 0.3 * std::sin(1.0 * i + 2.0 * j));
      }
    }
  }
  return s;
}

double Evaluation(const Surface& surface, int intervals, bool withNormals)
{
  std::vector<double> lines;
  for (int i = 0; i <= intervals; ++i)
  {
    lines.push_back(double(i) / intervals);
  }
  std::vector<double> points(3 * lines.size() * lines.size());
  std::vector<double> normals(withNormals ? points.size() : 0);
  SurfaceEvaluator evaluator(surface.View());
  return measuring::MedianTime(Repeat, [&]() {
    evaluator.Grid(lines, lines, points.data(), withNormals ? normals.data() : nullptr);
  }).Processor;
}

// Seconds of a step from the grid's half to it, and back. Whether the grid came back to rounding is
// checked, too.
template <typename Real>
void Steps(Wavelet kind, int intervals, double& up, double& down)
{
  GridStep step;
  step.Kind = kind;
  step.Intervals[0] = step.Intervals[1] = intervals;
  step.Halved[0] = step.Halved[1] = true;
  const std::size_t width = step.FineSamples(0);
  const std::size_t coarseWidth = step.CoarseSamples(0);
  std::vector<Real> grid(3 * width * width);
  for (std::size_t k = 0; k < grid.size(); ++k)
  {
    grid[k] = Real(std::sin(0.001 * double(k)));
  }
  const std::vector<Real> before = grid;
  std::vector<Real> work(3 * coarseWidth * coarseWidth);
  down = measuring::MedianTime(Repeat, [&]() {
    CoarsenGrid<Real, 3>(step, grid.data(), work.data());
  }).Processor;
  AnalyseGrid<Real, 3>(step, grid.data(), std::int64_t(width));
  std::vector<Real> coarse;
  for (std::size_t j = 0; j < coarseWidth; ++j)
  {
    const auto row = grid.begin() + std::ptrdiff_t(3 * j * width);
    coarse.insert(coarse.end(), row, row + std::ptrdiff_t(3 * coarseWidth));
  }
  std::vector<Real> fine(grid.size());
  up = measuring::MedianTime(Repeat, [&]() {
    SynthesiseGrid<Real, 3>(step, coarse.data(), grid.data(), std::int64_t(width), fine.data());
  }).Processor;
  for (std::size_t k = 0; k < fine.size(); ++k)
  {
    if (std::abs(fine[k] - before[k]) > Real(sizeof(Real) == 8 ? 1e-14 : 1e-5))
    {
      std::printf("the synthesis of wavelet %d is wrong\n", int(kind));
      std::exit(1);
    }
  }
}

} // namespace

int main()
{
  const char* const names[] = { "Haar", "interpolating", "lifted" };
  for (const bool rational : { false, true })
  {
    const Surface surface = Sheet(rational);
    std::printf("%s bicubic, 21 x 23 control points; ms, and how many times faster than points and "
                "normals / points alone\n",
      rational ? "rational" : "polynomial");
    std::printf("%9s %11s %9s  %-13s %-6s %8s %7s %6s %9s %7s %6s\n", "grid", "evaluated", "points",
      "wavelet", "values", "finer", "", "", "coarser", "", "");
    for (const int n : { 128, 256, 512, 1024 })
    {
      const double all[2] = { Evaluation(surface, n, true), Evaluation(surface, n / 2, true) };
      const double points[2] = { Evaluation(surface, n, false), Evaluation(surface, n / 2, false) };
      for (const Wavelet kind : { Wavelet::Haar, Wavelet::Interpolating, Wavelet::Lifted })
      {
        for (const bool floats : { false, true })
        {
          double up = 0.0, down = 0.0;
          floats ? Steps<float>(kind, n, up, down) : Steps<double>(kind, n, up, down);
          std::printf("%4d^2 %13.3f %9.3f  %-13s %-6s %8.3f %6.1fx %5.1fx %9.3f %6.1fx %5.1fx\n", n,
            1e3 * all[0], 1e3 * points[0], names[int(kind)], floats ? "float" : "double", 1e3 * up,
            all[0] / up, points[0] / up, 1e3 * down, all[1] / down, points[1] / down);
        }
      }
    }
  }
  return 0;
}
