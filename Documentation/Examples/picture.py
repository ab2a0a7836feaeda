"""From CAD file to picture in Python: read, tessellate, draw without a display, write a PNG.

    PYTHONPATH=build/release/lib/python3/dist-packages \\
        /usr/bin/python3 Documentation/Examples/picture.py FILE.step PICTURE.png
"""

import argparse

from vtkmodules import vtkRenderingOpenGL2  # noqa: F401, makes vtkRenderer draw with OpenGL
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkCompositePolyDataMapper,
    vtkRenderer,
    vtkWindowToImageFilter,
)

from vtknurbs import vtkNURBSCADReader, vtkNURBSEGLRenderWindow, vtkNURBSTessellator

parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
parser.add_argument("file")
parser.add_argument("picture")
arguments = parser.parse_args()

reader = vtkNURBSCADReader()
reader.SetFileName(arguments.file)
tessellator = vtkNURBSTessellator()
tessellator.SetInputConnection(reader.GetOutputPort())
tessellator.SetTolerance(1e-4)  # of the model's diagonal

mapper = vtkCompositePolyDataMapper()
mapper.SetInputConnection(tessellator.GetOutputPort())
mapper.SetScalarModeToUseCellFieldData()
mapper.SelectColorArray("Color")  # as the file colours the faces, if it does
actor = vtkActor()
actor.SetMapper(mapper)
renderer = vtkRenderer()
renderer.AddActor(actor)
renderer.SetBackground(1, 1, 1)
renderer.GetActiveCamera().SetPosition(1, -1, 1)
renderer.GetActiveCamera().SetViewUp(0, 0, 1)
renderer.ResetCamera()

window = vtkNURBSEGLRenderWindow.Create(800, 600)
if window is None:
    raise SystemExit("no OpenGL; the message above tells why")
window.AddRenderer(renderer)
window.Render()
grab = vtkWindowToImageFilter()
grab.SetInput(window)
grab.ReadFrontBufferOff()
writer = vtkPNGWriter()
writer.SetInputConnection(grab.GetOutputPort())
writer.SetFileName(arguments.picture)
writer.Write()
print(f"{arguments.picture}: {tessellator.GetNumberOfTriangles()} triangles, drawn by "
      f"{window.GetRendererName()}")  # fmt: skip
