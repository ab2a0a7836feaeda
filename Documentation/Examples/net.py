"""The picture of the guide's page on models: a trimmed surface, its loops and its control net.

    PYTHONPATH=build/release/lib/python3/dist-packages \\
        /usr/bin/python3 Documentation/Examples/net.py PICTURE.png
"""

import argparse

from vtkmodules import vtkRenderingOpenGL2  # noqa: F401, makes vtkRenderer draw with OpenGL
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer, vtkWindowToImageFilter

from vtknurbs import (
    vtkNURBSControlNet,
    vtkNURBSEGLRenderWindow,
    vtkNURBSFreeFormDeformation,
    vtkNURBSMapper,
    vtkNURBSRefinement,
    vtkNURBSShapeSource,
)

parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
parser.add_argument("picture")
picture = parser.parse_args().picture

plate = vtkNURBSShapeSource()
plate.SetShapeToPlate()
dense = vtkNURBSRefinement()
dense.SetInputConnection(plate.GetOutputPort())
dense.SetMaximumSpacing(0.15)
bow = vtkNURBSFreeFormDeformation()
bow.SetInputConnection(dense.GetOutputPort())
for j in range(4):
    for k in range(4):
        bow.SetLatticeDisplacement(1, j, k, 0, 0, 0.5)
        bow.SetLatticeDisplacement(2, j, k, 0, 0, 0.5)
net = vtkNURBSControlNet()
net.SetInputConnection(bow.GetOutputPort())

renderer = vtkRenderer()
renderer.SetBackground(1, 1, 1)
mapper = vtkNURBSMapper()
mapper.SetInputConnection(bow.GetOutputPort())
mapper.ScalarVisibilityOff()
surface = vtkActor()
surface.SetMapper(mapper)
surface.GetProperty().SetColor(0.75, 0.8, 0.88)
surface.GetProperty().EdgeVisibilityOn()
surface.GetProperty().SetLineWidth(2)
renderer.AddActor(surface)
mapper = vtkPolyDataMapper()
mapper.SetInputConnection(net.GetOutputPort())
mapper.ScalarVisibilityOff()
lines = vtkActor()
lines.SetMapper(mapper)
lines.GetProperty().SetColor(0.8, 0.3, 0.1)
lines.GetProperty().LightingOff()
lines.GetProperty().SetPointSize(5)
renderer.AddActor(lines)
renderer.GetActiveCamera().SetPosition(1, -3, 2)
renderer.GetActiveCamera().SetViewUp(0, 0, 1)
renderer.ResetCamera()
renderer.GetActiveCamera().Zoom(1.4)

window = vtkNURBSEGLRenderWindow.Create(600, 360)
if window is None:
    raise SystemExit("no OpenGL; the message above tells why")
window.SetMultiSamples(4)
window.AddRenderer(renderer)
window.Render()
grab = vtkWindowToImageFilter()
grab.SetInput(window)
grab.ReadFrontBufferOff()
writer = vtkPNGWriter()
writer.SetInputConnection(grab.GetOutputPort())
writer.SetFileName(picture)
writer.Write()
print(net.GetOutput().GetNumberOfLines(), "lines of the net")
