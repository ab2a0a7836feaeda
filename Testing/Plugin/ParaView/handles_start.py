# SPDX-License-Identifier: BSD-3-Clause
"""Run by ParaView's GUI before handles.xml plays: what is dragged, in the middle of the view."""
import os

from paraview import simple, smtrace

OUT = os.environ["NURBS_HANDLES"]
POINT = 294  # Of the teapot's lid, seen from above.

teapot = simple.NURBSShapeSource(registrationName="teapot")
simple._DisableFirstRenderCameraReset()
view = simple.GetActiveViewOrCreate("RenderView")
edits = simple.NURBSControlPointEdits(registrationName="edits", Input=teapot)
place = simple.servermanager.Fetch(teapot).GetPoint(POINT)
x, y, z = place
# The middle of the lattice's top lies half a unit below the control point in the picture.
bent = simple.NURBSFreeFormDeformation(
    registrationName="bent",
    Input=edits,
    Dimensions=[3, 3, 3],
    UseInputBounds=0,
    Bounds=[x - 3.0, x + 3.0, y - 3.5, y + 2.5, z - 4.0, z + 0.5],
)
display = simple.Show(bent, view)
display.ExactFragments = 0
view.CameraParallelProjection = 1
view.CameraFocalPoint = place
view.CameraPosition = [place[0], place[1], place[2] + 10.0]
view.CameraViewUp = [0.0, 1.0, 0.0]
view.CameraParallelScale = 1.0  # Half the height of the view.
view.CenterOfRotation = place
simple.Render(view)
simple.SetActiveSource(edits)

smtrace.start_trace()


def note(*_):
    """The trace so far, as Tools > Stop Trace would show it."""
    with open(os.path.join(OUT, "trace.py"), "w") as file:
        file.write(smtrace.get_current_trace_output())


for proxy in (edits, bent):
    proxy.SMProxy.AddObserver("UpdateDataEvent", note)
