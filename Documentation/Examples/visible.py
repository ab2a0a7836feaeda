"""The picture of the guide's page on visible regions: what is seen of a CAD file from the front
right, on the left as a model that is looked at from elsewhere, on the right as a drawing with
hidden lines in grey.

    PYTHONPATH=build/release/lib/python3/dist-packages \\
        /usr/bin/python3 Documentation/Examples/visible.py FILE PICTURE.png
"""

import argparse

from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer, vtkWindowToImageFilter
from vtkmodules.vtkRenderingOpenGL2 import vtkCompositePolyDataMapper2

from vtknurbs import (
    vtkNURBSCADReader,
    vtkNURBSEGLRenderWindow,
    vtkNURBSTessellator,
    vtkNURBSVisibleRegions,
)

parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
parser.add_argument("file")
parser.add_argument("picture")
options = parser.parse_args()

TOWARD_VIEWER = (1, -2, 1)
FROM_ELSEWHERE = (-1.6, -1.6, 1.2)

reader = vtkNURBSCADReader()
reader.SetFileName(options.file)
regions = vtkNURBSVisibleRegions()
regions.SetInputConnection(reader.GetOutputPort())
regions.SetDirection(*TOWARD_VIEWER)
seen = vtkNURBSTessellator()
seen.SetInputConnection(regions.GetOutputPort(0))


def draw(port, left, right, toward_viewer):
    actor = vtkActor()
    actor.SetMapper(vtkCompositePolyDataMapper2())
    actor.GetMapper().SetInputConnection(port)
    renderer = vtkRenderer()
    renderer.SetViewport(left, 0, right, 1)
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(actor)
    camera = renderer.GetActiveCamera()
    camera.SetPosition(*toward_viewer)
    camera.SetViewUp(0, 0, 1)
    camera.ParallelProjectionOn()
    renderer.ResetCamera()
    camera.Zoom(1.58)
    window.AddRenderer(renderer)
    return actor


window = vtkNURBSEGLRenderWindow.Create(960, 340)
if window is None:
    raise SystemExit("no OpenGL; the message above tells why")
window.SetMultiSamples(8)
surface = draw(seen.GetOutputPort(), 0, 0.5, FROM_ELSEWHERE)
surface.GetMapper().ScalarVisibilityOff()
surface.GetProperty().SetColor(0.62, 0.72, 0.9)
colours = vtkLookupTable()  # of Visibility: 0 hidden, 1 visible
colours.SetNumberOfTableValues(2)
colours.SetTableValue(0, 0.75, 0.75, 0.75)
colours.SetTableValue(1, 0, 0, 0)
lines = draw(regions.GetOutputPort(1), 0.5, 1, TOWARD_VIEWER)
lines.GetMapper().SetColorModeToMapScalars()
lines.GetMapper().SetScalarModeToUseCellFieldData()
lines.GetMapper().SelectColorArray("Visibility")
lines.GetMapper().SetScalarRange(0, 1)
lines.GetMapper().SetLookupTable(colours)
lines.GetProperty().SetLineWidth(1.5)
lines.GetProperty().LightingOff()
window.Render()

grab = vtkWindowToImageFilter()
grab.SetInput(window)
grab.ReadFrontBufferOff()
writer = vtkPNGWriter()
writer.SetInputConnection(grab.GetOutputPort())
writer.SetFileName(options.picture)
writer.Write()
print(
    f"{regions.GetNumberOfVisibleFaces()} of {regions.GetNumberOfFaces()} faces are visible as a"
    f" whole, {regions.GetNumberOfPartialFaces()} in part,"
    f" and {regions.GetNumberOfVisibleLines()} of {regions.GetNumberOfLines()} lines"
)
