"""The pictures of the guide's page on silhouettes: all lines of a teapot and, if there is one, of a CAD
file, over the surface.

    PYTHONPATH=build/release/lib/python3/dist-packages \\
        /usr/bin/python3 Documentation/Examples/lines.py FOLDER [FILE]
"""

import argparse
import os

from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer, vtkWindowToImageFilter
from vtkmodules.vtkRenderingOpenGL2 import vtkCompositePolyDataMapper2

from vtknurbs import (
    vtkNURBSCADReader,
    vtkNURBSEGLRenderWindow,
    vtkNURBSMapper,
    vtkNURBSShapeSource,
    vtkNURBSSilhouette,
)

parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
parser.add_argument("folder")
parser.add_argument("file", nargs="?")
options = parser.parse_args()


def draw(source, position, name):
    surface = vtkActor()
    surface.SetMapper(vtkNURBSMapper())
    surface.GetMapper().SetInputConnection(source.GetOutputPort())
    surface.GetMapper().ScalarVisibilityOff()
    surface.GetProperty().SetColor(0.88, 0.9, 0.94)
    renderer = vtkRenderer()
    renderer.AddActor(surface)
    renderer.SetBackground(1, 1, 1)
    camera = renderer.GetActiveCamera()
    camera.SetPosition(*position)
    camera.SetViewUp(0, 0, 1)
    camera.ParallelProjectionOn()
    renderer.ResetCamera()
    camera.Zoom(1.6)
    overlay = vtkRenderer()
    overlay.SetActiveCamera(camera)
    overlay.SetLayer(1)
    for colour, silhouettes in (((0.1, 0.2, 0.5), False), ((0.8, 0.1, 0.1), True)):
        lines = vtkNURBSSilhouette()
        lines.SetInputConnection(source.GetOutputPort())
        lines.SetCamera(camera)
        lines.SetSilhouettes(silhouettes)
        lines.SetBoundaryEdges(not silhouettes)
        lines.SetSharpEdges(not silhouettes)
        actor = vtkActor()
        actor.SetMapper(vtkCompositePolyDataMapper2())
        actor.GetMapper().SetInputConnection(lines.GetOutputPort())
        actor.GetMapper().ScalarVisibilityOff()
        actor.GetProperty().SetColor(*colour)
        actor.GetProperty().SetLineWidth(1.8)
        actor.GetProperty().LightingOff()
        overlay.AddActor(actor)
    window = vtkNURBSEGLRenderWindow.Create(400, 280)
    if window is None:
        raise SystemExit("no OpenGL; the message above tells why")
    window.SetMultiSamples(4)
    window.SetNumberOfLayers(2)
    window.AddRenderer(renderer)
    window.AddRenderer(overlay)
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    writer = vtkPNGWriter()
    writer.SetInputConnection(grab.GetOutputPort())
    writer.SetFileName(os.path.join(options.folder, name))
    writer.Write()
    print(name)


teapot = vtkNURBSShapeSource()
teapot.SetShapeToTeapot()
draw(teapot, (3, -8, 4), "teapot-lines.png")
if options.file:
    reader = vtkNURBSCADReader()
    reader.SetFileName(options.file)
    draw(reader, (1, -2, 1), os.path.splitext(os.path.basename(options.file))[0] + "-lines.png")
