// SPDX-License-Identifier: BSD-3-Clause
/// @file Measuring.h
/// @brief What the benchmark programs measure with: time, medians, memory.
#pragma once

#include <sys/resource.h>

#include <algorithm>
#include <ctime>
#include <vector>

namespace measuring
{

/// Elapsed seconds, and seconds of this process's own processor time (of all its threads).
struct Duration
{
  double Elapsed = 0.0;
  double Processor = 0.0;
};

/// The time since it was made.
class Stopwatch
{
public:
  Duration Read() const
  {
    return { Now(CLOCK_MONOTONIC) - this->Start.Elapsed,
      Now(CLOCK_PROCESS_CPUTIME_ID) - this->Start.Processor };
  }

private:
  static double Now(clockid_t clock)
  {
    timespec time;
    clock_gettime(clock, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
  }
  Duration Start{ Now(CLOCK_MONOTONIC), Now(CLOCK_PROCESS_CPUTIME_ID) };
};

inline double Median(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Medians of at most `repeat` runs; what takes longer than 5 s is run once.
template <class Work>
Duration MedianTime(int repeat, Work&& work)
{
  std::vector<double> elapsed, processor;
  for (int i = 0; i < repeat && (elapsed.empty() || elapsed[0] < 5.0); ++i)
  {
    const Stopwatch stopwatch;
    work();
    const Duration taken = stopwatch.Read();
    elapsed.push_back(taken.Elapsed);
    processor.push_back(taken.Processor);
  }
  return { Median(elapsed), Median(processor) };
}

/// The most memory that this process has had, in bytes.
inline double PeakMemory()
{
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * double(usage.ru_maxrss);
}

} // namespace measuring
