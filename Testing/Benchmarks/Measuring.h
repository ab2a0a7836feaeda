// SPDX-License-Identifier: BSD-3-Clause
/// @file Measuring.h
/// @brief What the benchmark programs measure with: elapsed time, medians, memory.
#pragma once

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <vector>

namespace measuring
{

/// Seconds since it was made.
class Stopwatch
{
public:
  double Seconds() const
  {
    return std::chrono::duration<double>(Clock::now() - this->Start).count();
  }

private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point Start = Clock::now();
};

/// Median seconds of at most `repeat` runs; what takes longer than 5 s is run once.
template <class Work>
double MedianTime(int repeat, Work&& work)
{
  std::vector<double> seconds;
  for (int i = 0; i < repeat && (seconds.empty() || seconds[0] < 5.0); ++i)
  {
    const Stopwatch stopwatch;
    work();
    seconds.push_back(stopwatch.Seconds());
  }
  std::sort(seconds.begin(), seconds.end());
  return seconds[seconds.size() / 2];
}

/// The most memory that this process has had, in bytes.
inline double PeakMemory()
{
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * double(usage.ru_maxrss);
}

} // namespace measuring
