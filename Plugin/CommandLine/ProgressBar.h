// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A bar on the terminal for work that takes a while.
#ifndef nurbsProgressBar_h
#define nurbsProgressBar_h

#include <chrono>
#include <memory>

namespace nurbs
{

/// Shows up on standard error after half a second, if that is a terminal, and leaves no trace.
class ProgressBar
{
public:
  explicit ProgressBar(bool wanted);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// What follows fills the bar from `begin` to `end`, of 1.
  void Phase(double begin, double end);

  /// The state of the phase, 0 to 1; going back is ignored.
  void Set(double fraction);

  /// Take the bar away, before something else is printed.
  void Clear();

private:
  struct Display;
  std::unique_ptr<Display> Bar;
  std::chrono::steady_clock::time_point Started;
  bool Wanted;
  double Begin = 0.0;
  double End = 1.0;
};

} // namespace nurbs

#endif
