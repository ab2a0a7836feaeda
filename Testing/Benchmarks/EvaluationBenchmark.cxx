// SPDX-License-Identifier: BSD-3-Clause
/// @file EvaluationBenchmark.cxx
/// @brief Points with normals a second: plain evaluation, batches, coherence and grids, next to what
/// the machine could do.
///
/// Prints the figures of Documentation/Papers/balazs-2004-evaluation.md. One thread; each figure is
/// the best of several repetitions. "naive" is nurbs::EvaluateDerivatives and a cross product: basis
/// functions and the double sum for every point.
#include "Multiversion.h"
#include "SurfaceEvaluator.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <random>

using namespace nurbs;

namespace
{

/// The shortest of several runs of `body`, in seconds of this process' own processor time: a machine
/// that is busy with something else does not count.
template <typename F>
double BestTime(const F& body)
{
  double best = 1e300;
  double total = 0.0;
  for (int i = 0; i < 5 || (i < 50 && total < 0.3); ++i)
  {
    const std::clock_t start = std::clock();
    body();
    const double seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
    best = std::min(best, seconds);
    total += seconds;
  }
  return best;
}

/// A smooth sheet with small random bumps, `spans` x `spans` knot spans.
Surface Sheet(int degree, int spans, bool rational)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> bump(-0.1, 0.1);
  Surface s;
  for (int dir = 0; dir < 2; ++dir)
  {
    s.Degree[dir] = degree;
    s.Count[dir] = degree + spans;
    s.Knots[dir] = UniformKnots(degree, s.Count[dir]);
  }
  for (int j = 0; j < s.Count[1]; ++j)
  {
    for (int i = 0; i < s.Count[0]; ++i)
    {
      s.Points.push_back(Vec3(i, j, std::sin(0.5 * i) * std::cos(0.3 * j) + bump(random)));
      if (rational)
      {
        s.Weights.push_back(1.0 + bump(random));
      }
    }
  }
  return s;
}

/// Multiplications and additions in independent chains that stay in registers.
template <typename Vector>
inline __attribute__((always_inline)) double Chains(std::int64_t rounds)
{
  Vector x[8];
  for (int k = 0; k < 8; ++k)
  {
    x[k] = Vector{} + 1.0 + k;
  }
  for (std::int64_t i = 0; i < rounds; ++i)
  {
    for (int k = 0; k < 8; ++k)
    {
      x[k] = x[k] * 0.999 + 0.001;
    }
  }
  const Vector sum = x[0] + x[1] + x[2] + x[3] + x[4] + x[5] + x[6] + x[7];
  return sum[0] + sum[1];
}

NURBS_MULTIVERSION
double WideChains(std::int64_t rounds)
{
  using Octet = double __attribute__((vector_size(64)));
  return Chains<Octet>(rounds);
}

double NarrowChains(std::int64_t rounds)
{
  using Pair = double __attribute__((vector_size(16)));
  return Chains<Pair>(rounds);
}

/// Operations a second of the vector units that SurfaceEvaluator can use on this machine, without
/// fused ones (see Multiversion.h).
double PeakFlops()
{
  constexpr std::int64_t rounds = 1000000;
  const bool wide = HasWideClones();
  volatile double sink = 0.0;
  const double seconds = BestTime([&] { sink = wide ? WideChains(rounds) : NarrowChains(rounds); });
  (void)sink;
  return 2.0 * 8.0 * (wide ? 8.0 : 2.0) * rounds / seconds;
}

/// Bytes a second that one thread writes to memory.
double WriteBandwidth()
{
  std::vector<double> buffer(std::size_t(8) << 20);
  double value = 1.0;
  const double seconds = BestTime([&] { std::fill(buffer.begin(), buffer.end(), value += 1.0); });
  return 8.0 * buffer.size() / seconds;
}

/// Multiplications, additions and divisions for one point with normal, nothing shared with another.
double FlopsPerPoint(int degree, bool rational)
{
  const double n = degree + 1;
  const double bases = 2.0 * (3.0 * degree * (degree - 1) + 8.0 * degree);
  const double inner = n * 2.0 * (8.0 * n - 4.0);
  const double outer = 3.0 * (8.0 * n - 4.0);
  return bases + inner + outer + (rational ? 4.0 + 18.0 : 0.0) + 30.0;
}

struct Workload
{
  Surface Sheet;
  std::vector<double> Side;   ///< The grid's parameters, the same for u and v.
  std::vector<Vec2> Rows;     ///< The grid row by row.
  std::vector<Vec2> Shuffled; ///< The same in random order.
  std::vector<double> Points, Normals;
};

Workload MakeWorkload(int degree, int spans, bool rational, int side)
{
  Workload w;
  w.Sheet = Sheet(degree, spans, rational);
  for (int i = 0; i < side; ++i)
  {
    w.Side.push_back((i + 0.37) / side);
  }
  for (double v : w.Side)
  {
    for (double u : w.Side)
    {
      w.Rows.push_back(Vec2(u, v));
    }
  }
  w.Shuffled = w.Rows;
  std::shuffle(w.Shuffled.begin(), w.Shuffled.end(), std::mt19937(3));
  w.Points.resize(3 * w.Rows.size());
  w.Normals.resize(3 * w.Rows.size());
  return w;
}

/// Nanoseconds a point of the naive way.
double TimeNaive(Workload& w)
{
  const SurfaceView view = w.Sheet.View();
  const std::size_t count = std::min<std::size_t>(w.Shuffled.size(), 50000);
  const double seconds = BestTime([&] {
    for (std::size_t i = 0; i < count; ++i)
    {
      const SurfaceDerivatives d = EvaluateDerivatives(view, w.Shuffled[i][0], w.Shuffled[i][1], 1);
      Eigen::Map<Vec3>(w.Points.data() + 3 * i) = d.S;
      Eigen::Map<Vec3>(w.Normals.data() + 3 * i) = d.Su.cross(d.Sv).normalized();
    }
  });
  return 1e9 * seconds / count;
}

/// Nanoseconds a point of SurfaceEvaluator::Batch.
double TimeBatch(Workload& w, const std::vector<Vec2>& uv)
{
  SurfaceEvaluator evaluator(w.Sheet.View());
  const std::int64_t count = static_cast<std::int64_t>(uv.size());
  const double seconds =
    BestTime([&] { evaluator.Batch(uv.data(), count, w.Points.data(), w.Normals.data()); });
  return 1e9 * seconds / count;
}

double TimeGrid(Workload& w)
{
  SurfaceEvaluator evaluator(w.Sheet.View());
  const double seconds =
    BestTime([&] { evaluator.Grid(w.Side, w.Side, w.Points.data(), w.Normals.data()); });
  return 1e9 * seconds / w.Rows.size();
}

void PrintRow(int degree, int spans, bool rational, double peak, double bandwidth)
{
  Workload w = MakeWorkload(degree, spans, rational, 400);
  const double naive = TimeNaive(w);
  const double shuffled = TimeBatch(w, w.Shuffled);
  const double rows = TimeBatch(w, w.Rows);
  const double grid = TimeGrid(w);
  const double flopLimit = 1e9 * FlopsPerPoint(degree, rational) / peak;
  const double writeLimit = 1e9 * 48.0 / bandwidth; // 6 doubles a point
  std::printf("%4d %5d %-5s | %7.1f %7.1f %7.1f %7.1f | %6.1fx %6.1fx %6.1fx | %6.0f%% %6.0f%%\n",
    degree, spans, rational ? "yes" : "no", naive, shuffled, rows, grid, naive / shuffled,
    naive / rows, naive / grid, 100.0 * flopLimit / shuffled, 100.0 * writeLimit / grid);
}

} // namespace

int main()
{
  const double peak = PeakFlops();
  const double bandwidth = WriteBandwidth();
  std::printf("One thread: %.1f Gflop/s without fused operations, %.1f GB/s written\n\n",
    1e-9 * peak, 1e-9 * bandwidth);
  std::printf(
    "Nanoseconds for a point with normal; how many times faster than naive; batch in random "
    "order\nagainst the flop limit, grid against the time to write the result.\n\n");
  std::printf("%4s %5s %-5s | %7s %7s %7s %7s | %7s %7s %7s | %7s %7s\n", "deg", "spans", "ratnl",
    "naive", "random", "rows", "grid", "random", "rows", "grid", "flops", "writes");
  for (int degree : { 1, 2, 3, 4, 5, 9 })
  {
    PrintRow(degree, 16, false, peak, bandwidth);
    PrintRow(degree, 16, true, peak, bandwidth);
  }
  PrintRow(3, 1, true, peak, bandwidth);
  PrintRow(3, 300, true, peak, bandwidth);
  return 0;
}
