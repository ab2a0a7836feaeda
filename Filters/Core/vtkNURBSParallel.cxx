// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSParallel.h"

#include "vtkSMPTools.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <exception>

namespace
{

/// Ranges a thread: enough for balance, few enough to cost nothing.
constexpr std::int64_t RangesAThread = 256;

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
