"""The picture of the README: one CAD file as triangles, drawn exactly, bent, and as a line drawing.

    PYTHONPATH=build/release/lib/python3/dist-packages \\
        /usr/bin/python3 Documentation/Examples/overview.py FILE PICTURE.png
"""

import argparse

from vtkmodules import vtkRenderingOpenGL2  # noqa: F401, makes vtkRenderer draw with OpenGL
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkCompositePolyDataMapper,
    vtkRenderer,
    vtkWindowToImageFilter,
)

from vtknurbs import (
    vtkNURBSCADReader,
    vtkNURBSEGLRenderWindow,
    vtkNURBSFreeFormDeformation,
    vtkNURBSMapper,
    vtkNURBSRefinement,
    vtkNURBSTessellator,
    vtkNURBSVisibleRegions,
)

parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
parser.add_argument("file")
parser.add_argument("picture")
arguments = parser.parse_args()
VIEW = (1, -1, 1)  # from the model to the viewer

window = vtkNURBSEGLRenderWindow.Create(1000, 250)
if window is None:
    raise SystemExit("no OpenGL; the message above tells why")
window.SetMultiSamples(4)


def show(column, mapper, source, port=0):
    mapper.SetInputConnection(source.GetOutputPort(port))
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(0.75, 0.8, 0.88)
    renderer = vtkRenderer()
    renderer.SetViewport(column / 4, 0, (column + 1) / 4, 1)
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(actor)
    renderer.GetActiveCamera().SetPosition(VIEW)
    renderer.GetActiveCamera().SetViewUp(0, 0, 1)
    renderer.GetActiveCamera().ParallelProjectionOn()
    renderer.ResetCamera()
    renderer.GetActiveCamera().Zoom(1.35)
    window.AddRenderer(renderer)
    return actor.GetProperty()


reader = vtkNURBSCADReader()
reader.SetFileName(arguments.file)

triangles = vtkNURBSTessellator()
triangles.SetInputConnection(reader.GetOutputPort())
triangles.SetTolerance(3e-3)
mapper = vtkCompositePolyDataMapper()
mapper.ScalarVisibilityOff()
look = show(0, mapper, triangles)
look.EdgeVisibilityOn()
look.SetEdgeColor(0.15, 0.25, 0.4)
look.SetInterpolationToFlat()

mapper = vtkNURBSMapper()
mapper.SetLookToMeanCurvature()
show(1, mapper, reader)

dense = vtkNURBSRefinement()
dense.SetInputConnection(reader.GetOutputPort())
bent = vtkNURBSFreeFormDeformation()
bent.SetInputConnection(dense.GetOutputPort())
for j in range(4):
    for k in range(4):
        bent.SetLatticeDisplacement(1, j, k, 0, 0, 1.2)
        bent.SetLatticeDisplacement(2, j, k, 0, 0, -1.2)
mapper = vtkNURBSMapper()
mapper.ScalarVisibilityOff()
mapper.SetNumberOfIsoLines(5, 5)
show(2, mapper, bent).SetLineWidth(0.7)

regions = vtkNURBSVisibleRegions()
regions.SetInputConnection(reader.GetOutputPort())
regions.SetDirection(VIEW)
mapper = vtkCompositePolyDataMapper()
mapper.SetScalarModeToUseCellFieldData()
mapper.SetColorModeToMapScalars()
mapper.SelectColorArray("Visibility")
table = vtkLookupTable()
table.SetNumberOfTableValues(2)
table.SetTableValue(0, 0.75, 0.75, 0.75, 1)  # hidden
table.SetTableValue(1, 0, 0, 0, 1)
mapper.SetLookupTable(table)
mapper.SetScalarRange(0, 1)
look = show(3, mapper, regions, 1)
look.LightingOff()
look.RenderLinesAsTubesOn()  # without gaps where segments meet
look.SetLineWidth(1.8)

window.Render()
grab = vtkWindowToImageFilter()
grab.SetInput(window)
grab.ReadFrontBufferOff()
writer = vtkPNGWriter()
writer.SetInputConnection(grab.GetOutputPort())
writer.SetFileName(arguments.picture)
writer.Write()
print(triangles.GetNumberOfTriangles(), "triangles,", regions.GetNumberOfVisibleFaces(), "faces visible")
