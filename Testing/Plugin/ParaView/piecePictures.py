# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of a model that processes share, for TestPiecePictures.py.

Run as `mpirun -np N pvbatch --symmetric piecePictures.py PLUGIN FOLDER SOURCE`.
"""
import sys

from paraview import simple
from session import FOLDER, load_plugin, path, updated

load_plugin()
source = sys.argv[3]
if source == "car":
    model = simple.NURBSShapeSource(Shape="Car Body", NumberOfPatches=200)
elif source.isdigit():
    model = simple.NURBSShapeSource(Shape=int(source))
else:
    model = simple.OpenDataFile(source)
updated(model)
view = simple.CreateView("RenderView")
view.ViewSize = [200, 150]
view.OrientationAxesVisibility = 0
view.UseFXAA = 0
view.UseColorPaletteForBackground = 0
view.Background = [1.0, 1.0, 1.0]
display = simple.Show(model, view)
assert display.Representation == "NURBS Surface", display.Representation
view.CameraPosition = [1.0, -2.0, 1.5]
view.CameraFocalPoint = [0.0, 0.0, 0.0]
view.CameraViewUp = [0.0, 0.0, 1.0]
view.ResetCamera()


def picture(name):
    simple.Render(view)
    simple.SaveScreenshot(path(name + ".png"), view)


picture("surface")
display.FaceEdges = 1
picture("edges")
display.FaceEdges = 0
simple.ColorBy(display, ("CELLS", "FaceId"))
simple.GetColorTransferFunction("FaceId").RescaleTransferFunction(0.0, 40.0)
picture("ids")
simple.ColorBy(display, None)
display.Look = "Mean Curvature"
picture("curvature")
display.Look = "Plain"
display.Opacity = 0.4
picture("translucent")
display.Opacity = 1.0
simple.Hide(model, view)
mesh = simple.NURBSTessellator(Input=model)
shown = simple.Show(mesh, view)
shown.Representation = "Surface"
picture("mesh")
lines = simple.NURBSVisibleRegions(Input=model, Direction=[1.0, -2.0, 1.5])
simple.Hide(mesh, view)
drawn = simple.Show(simple.OutputPort(lines, 1), view)
drawn.AmbientColor = drawn.DiffuseColor = [0.0, 0.0, 0.0]
picture("lines")
