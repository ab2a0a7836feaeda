// SPDX-License-Identifier: BSD-3-Clause
#include "MemoryBandwidth.h"

#include "Measuring.h"
#include "Multiversion.h"

#include <cstring>

namespace measuring
{

namespace
{

NURBS_MULTIVERSION
void Modify(double* x, std::size_t count, double a, double b)
{
  for (std::size_t i = 0; i < count; ++i)
  {
    x[i] = a * x[i] + b;
  }
}

/// Bytes a second of `body`, which reads and writes `bytes` each.
template <typename Body>
double BestRate(std::size_t bytes, const Body& body)
{
  const std::size_t rounds = 1 + (std::size_t(16) << 20) / bytes;
  double best = 1e300;
  double total = 0.0;
  for (int i = 0; i < 5 || (i < 200 && total < 0.2); ++i)
  {
    const Stopwatch stopwatch;
    for (std::size_t round = 0; round < rounds; ++round)
    {
      body(round);
    }
    const double seconds = stopwatch.Read().Processor;
    best = std::min(best, seconds);
    total += seconds;
  }
  return 2.0 * double(bytes) * double(rounds) / best;
}

} // namespace

Bandwidth MeasureBandwidth(std::size_t bytes)
{
  const std::size_t count = std::max<std::size_t>(1, bytes / sizeof(double));
  bytes = count * sizeof(double);
  std::vector<double> from(count, 1.0), to(count, 2.0);
  volatile double sink = 0.0;
  Bandwidth result;
  result.Copy = BestRate(bytes, [&](std::size_t round) {
    from[round % count] += 1.0; // or the compiler could leave all copies but one out
    std::memcpy(to.data(), from.data(), bytes);
    sink = to[count / 2];
  });
  result.Modify = BestRate(bytes, [&](std::size_t) {
    Modify(to.data(), count, 0.999, 0.001);
    sink = to[count / 2];
  });
  (void)sink;
  return result;
}

} // namespace measuring
