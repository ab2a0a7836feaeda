// SPDX-License-Identifier: BSD-3-Clause
/// @file Stopwatch.h
/// @brief Seconds between laps.
#pragma once

#include <chrono>

namespace nurbs
{

class Stopwatch
{
public:
  double Lap()
  {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - this->Last).count();
    this->Last = now;
    return seconds;
  }

private:
  std::chrono::steady_clock::time_point Last = std::chrono::steady_clock::now();
};

} // namespace nurbs
