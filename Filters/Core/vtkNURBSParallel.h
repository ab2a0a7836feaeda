// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkNURBSParallel.h
 * @brief vtkSMPTools as the parallel loop of the kernels, for the vtk* files of the suite.
 *
 * Some builds of VTK (ParaView's of Debian 12 among them) use the backend "Sequential" unless told
 * otherwise, though they have a parallel one. vtkNURBSParallelScope chooses "STDThread" then, for
 * its lifetime. It leaves every other backend, the number of threads that vtkSMPTools::Initialize
 * or VTK_SMP_MAX_THREADS set, and a backend asked for by VTK_SMP_BACKEND_IN_USE as they are.
 */
#ifndef vtkNURBSParallel_h
#define vtkNURBSParallel_h

#include "Types.h"
#include "vtkNURBSFiltersCoreModule.h" // For export macro

#include <string> // For std::string

class vtkAlgorithm;

/// Makes vtkSMPTools parallel while it lives. Not to be made in several threads at once.
class VTKNURBSFILTERSCORE_EXPORT vtkNURBSParallelScope
{
public:
  vtkNURBSParallelScope();
  ~vtkNURBSParallelScope();
  vtkNURBSParallelScope(const vtkNURBSParallelScope&) = delete;
  vtkNURBSParallelScope& operator=(const vtkNURBSParallelScope&) = delete;

private:
  std::string Before; ///< The backend to go back to; empty: it was not changed.
};

/// A nurbs::ParallelFor on vtkSMPTools: threads fetch small ranges of [first, last) until none is
/// left, so that items of very different cost share the threads evenly. The first exception that
/// `body` throws ends the loop early and is thrown again in the calling thread.
VTKNURBSFILTERSCORE_EXPORT void vtkNURBSParallelFor(std::int64_t first, std::int64_t last,
  const std::function<void(std::int64_t begin, std::int64_t end)>& body);

/// Runs `work` in another thread, whichever threads it is spread over there, so that observers of the
/// progress of `self` run in this one, are called while it lasts, and can abort it. `work` calls its
/// argument, from any thread, with the share done, and stops when that returns false. Progress goes from
/// `from` to `to`. What takes less time than a thread needs to start (`quick`) is done in this thread.
/// Exceptions of `work` are thrown again here.
VTKNURBSFILTERSCORE_EXPORT void vtkNURBSRunWithProgress(vtkAlgorithm* self, bool quick, double from,
  double to, const std::function<void(const std::function<bool(double)>& progress)>& work);

#endif
