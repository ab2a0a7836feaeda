# SPDX-License-Identifier: BSD-3-Clause
"""A model in ParaView's render view: surfaces by the mapper beside triangles of the tessellator.

    xvfb-run -a pvpython Testing/Benchmarks/paraview_view.py PLUGIN [FILE]

PLUGIN is NURBS.so, FILE a CAD file (default: a car body of 8,036 trimmed patches). Seconds of the
processor, all threads, at 800 x 600 pixels; frames turn the camera by one degree.
"""
import resource
import sys
import time

from paraview import simple


def seconds(action):
    start = time.process_time()
    action()
    return time.process_time() - start


def turned(view, render, frames=10):
    def turn():
        for _ in range(frames):
            view.GetActiveCamera().Azimuth(1)
            render()

    turn()  # what is made once
    return seconds(turn) / frames


def measure(name, source, settings=()):
    view = simple.CreateView("RenderView")
    view.ViewSize = [800, 600]
    display = simple.Show(source, view)
    for key, value in settings:
        setattr(display, key, value)
    view.ResetCamera(True)
    first = seconds(lambda: simple.Render(view))
    still = turned(view, view.SMProxy.StillRender, 3)
    moving = turned(view, view.SMProxy.InteractiveRender)
    print("%-34s %8.2f %8.3f %8.3f" % (name, first, still, moving))
    simple.Delete(view)


simple.LoadPlugin(sys.argv[1], ns=vars(simple))
if len(sys.argv) > 2:
    model = simple.OpenDataFile(sys.argv[2])
else:
    model = simple.NURBSShapeSource(Shape="Car Body", NumberOfPatches=8036)
print("model: %.2f s" % seconds(model.UpdatePipeline))
mesh = simple.NURBSTessellator(Input=model, Tolerance=1e-4)
print("triangles: %.2f s" % seconds(mesh.UpdatePipeline))
for proxy, what in ((model, "faces"), (mesh, "triangles")):
    about = proxy.GetDataInformation()
    print("%d %s, %.1f MiB" % (about.GetNumberOfCells(), what, about.GetMemorySize() / 1024))
print("%-34s %8s %8s %8s" % ("", "first", "still", "moving"))
measure("NURBS Surface", model)
measure("NURBS Surface, triangles' points", model, [("ExactFragments", 0)])
measure("Surface of triangles", mesh)
print("%.0f MiB at most" % (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024))
