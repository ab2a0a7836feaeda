// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSParallel.h"

#include "vtkAlgorithm.h"
#include "vtkSMPTools.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <future>

namespace
{

/// Ranges a thread: enough for balance, few enough to cost nothing.
constexpr std::int64_t RangesAThread = 256;

constexpr std::chrono::milliseconds ProgressInterval(20);

} // namespace

vtkNURBSParallelScope::vtkNURBSParallelScope()
{
  const char* wanted = std::getenv("VTK_SMP_BACKEND_IN_USE");
  const char* backend = vtkSMPTools::GetBackend();
  if ((!wanted || !*wanted) && backend && !strcmp(backend, "Sequential"))
  {
    // Not LocalScope: it would forget the number of threads.
    this->Before = backend;
    vtkSMPTools::SetBackend("STDThread");
  }
}

vtkNURBSParallelScope::~vtkNURBSParallelScope()
{
  if (!this->Before.empty())
  {
    vtkSMPTools::SetBackend(this->Before.c_str());
  }
}

void vtkNURBSParallelFor(std::int64_t first, std::int64_t last,
  const std::function<void(std::int64_t, std::int64_t)>& body)
{
  const std::int64_t count = last - first;
  const std::int64_t threads =
    std::min<std::int64_t>(count, std::max(1, vtkSMPTools::GetEstimatedNumberOfThreads()));
  if (threads <= 1)
  {
    nurbs::SerialFor(first, last, body);
    return;
  }
  const std::int64_t range = std::max<std::int64_t>(1, count / (threads * RangesAThread));
  std::atomic<std::int64_t> next{ first };
  std::atomic_flag failed = ATOMIC_FLAG_INIT;
  std::exception_ptr failure;
  const auto work = [&](vtkIdType, vtkIdType) {
    try
    {
      for (std::int64_t at; (at = next.fetch_add(range)) < last;)
      {
        body(at, std::min(at + range, last));
      }
    }
    catch (...)
    {
      if (!failed.test_and_set())
      {
        failure = std::current_exception();
      }
      next = last;
    }
  };
  vtkSMPTools::For(0, threads, 1, work);
  if (failure)
  {
    std::rethrow_exception(failure);
  }
}

void vtkNURBSRunWithProgress(vtkAlgorithm* self, bool quick, double from, double to,
  const std::function<void(const std::function<bool(double)>& progress)>& work)
{
  std::atomic<double> progress{ 0.0 };
  std::atomic<bool> abort{ false };
  const auto report = [&]() {
    self->UpdateProgress(from + (to - from) * progress);
    abort = abort || self->GetAbortExecute() != 0;
  };
  report();
  auto result = std::async(quick ? std::launch::deferred : std::launch::async, [&]() {
    work([&](double done) {
      progress = done;
      return !abort;
    });
  });
  while (!quick && result.wait_for(ProgressInterval) != std::future_status::ready)
  {
    report();
  }
  result.get();
}
