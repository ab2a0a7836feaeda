# SPDX-License-Identifier: BSD-3-Clause
"""Time and memory of a car of N patches that MPI processes share: dealt, tessellated, seen.

    for np in 1 2 4; do
      mpirun --allow-run-as-root --oversubscribe -np $np pvbatch --symmetric \
        Testing/Benchmarks/pieces.py PLUGIN 31040 [regions]
    done

PLUGIN is NURBS.so. Prints one line a process count: processor seconds of all processes, the longest
process's seconds, the largest process's memory, the faces that processes had to know of each other.
Threads: one a process (VTK_SMP_MAX_THREADS is set here), so that seconds are processor time.
"""
import os
import resource
import sys
import time

os.environ["VTK_SMP_MAX_THREADS"] = "1"

from paraview import simple  # noqa: E402
from vtkmodules.vtkParallelCore import vtkCommunicator, vtkMultiProcessController  # noqa: E402

PLUGIN, PATCHES = sys.argv[1], int(sys.argv[2])
controller = vtkMultiProcessController.GetGlobalController()
ranks = controller.GetNumberOfProcesses()


def reduce(value, operation):
    from vtkmodules.vtkCommonCore import vtkDoubleArray

    own, result = vtkDoubleArray(), vtkDoubleArray()
    own.InsertNextValue(value)
    result.InsertNextValue(value)
    if ranks > 1:
        controller.AllReduce(own, result, operation)
    return result.GetValue(0)


def processor():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def measured(proxy):
    """Processor seconds of all processes and of the one that took most, MiB of the largest."""
    controller.Barrier()
    start = processor()
    proxy.UpdatePipeline()
    # Waiting for others is no work: MPI waits actively, so that the wall clock tells less.
    took = processor() - start
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    return (
        reduce(took, vtkCommunicator.SUM_OP),
        reduce(took, vtkCommunicator.MAX_OP),
        reduce(memory, vtkCommunicator.MAX_OP),
    )


simple.LoadPlugin(PLUGIN, remote=False, ns=vars(simple))
base = reduce(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0, vtkCommunicator.MAX_OP)
source = simple.NURBSShapeSource(Shape="Car Body", NumberOfPatches=PATCHES)
steps = [("deal", source)]
mesh = simple.NURBSTessellator(Input=source, Tolerance=1e-4)
steps.append(("tessellate", mesh))
steps.append(("silhouettes", simple.NURBSSilhouette(Input=source, Direction=[1, 1, 1])))
if sys.argv[3:] == ["regions"]:
    steps.append(("regions", simple.NURBSVisibleRegions(Input=source, Direction=[1, 1, 1])))
for name, proxy in steps:
    start = time.time()
    total, longest, memory = measured(proxy)
    proxy.UpdatePropertyInformation()
    wall = reduce(time.time() - start, vtkCommunicator.MAX_OP)
    if controller.GetLocalProcessId() == 0:
        more = ""
        if name == "tessellate":
            more = "  %d triangles, %d ghosts" % (mesh.NumberOfTriangles, mesh.NumberOfGhostFaces)
        print(
            "%7d patches %2d processes %-10s %8.2f s of all, %8.2f s of one, wall %8.2f s, "
            "%7.0f MiB (%.0f before)%s"
            % (PATCHES, ranks, name, total, longest, wall, memory, base, more)
        )
