"""The pictures of the guide's page on drawing: a teapot with its edges, zebra stripes, curvature.

    PYTHONPATH=build/release/lib/python3/dist-packages \\
        /usr/bin/python3 Documentation/Examples/looks.py FOLDER
"""

import argparse
import os

from vtkmodules import vtkRenderingOpenGL2  # noqa: F401, makes vtkRenderer draw with OpenGL
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer, vtkWindowToImageFilter

from vtknurbs import vtkNURBSEGLRenderWindow, vtkNURBSMapper, vtkNURBSShapeSource

parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
parser.add_argument("folder")
folder = parser.parse_args().folder

source = vtkNURBSShapeSource()
source.SetShapeToTeapot()
mapper = vtkNURBSMapper()  # no tessellation: the GPU evaluates and trims
mapper.SetInputConnection(source.GetOutputPort())
actor = vtkActor()
actor.SetMapper(mapper)
actor.GetProperty().SetColor(0.85, 0.87, 0.9)
actor.GetProperty().SetEdgeColor(0, 0, 0)
actor.GetProperty().SetLineWidth(1.5)
renderer = vtkRenderer()
renderer.AddActor(actor)
renderer.SetBackground(1, 1, 1)
renderer.GetActiveCamera().SetPosition(3, -8, 4)
renderer.GetActiveCamera().SetViewUp(0, 0, 1)
renderer.ResetCamera()
renderer.GetActiveCamera().Zoom(1.5)
window = vtkNURBSEGLRenderWindow.Create(400, 280)
if window is None:
    raise SystemExit("no OpenGL; the message above tells why")
window.SetMultiSamples(4)
window.AddRenderer(renderer)


def write(name):
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    writer = vtkPNGWriter()
    writer.SetInputConnection(grab.GetOutputPort())
    writer.SetFileName(os.path.join(folder, name))
    writer.Write()
    print(name)


actor.GetProperty().EdgeVisibilityOn()
write("teapot-edges.png")

actor.GetProperty().EdgeVisibilityOff()
mapper.SetLookToZebra()
mapper.SetNumberOfStripes(24)
write("teapot-zebra.png")

mapper.SetLookToMeanCurvature()
mapper.SetNumberOfIsoLines(4, 4)
write("teapot-curvature.png")
