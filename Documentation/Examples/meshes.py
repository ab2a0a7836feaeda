"""The pictures of the guide's pages on tessellation and on levels of detail.

    PYTHONPATH=build/release/lib/python3/dist-packages \\
        /usr/bin/python3 Documentation/Examples/meshes.py FILE FOLDER
"""

import argparse
import os

from vtkmodules import vtkRenderingOpenGL2  # noqa: F401, makes vtkRenderer draw with OpenGL
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
    vtkNURBSShapeSource,
    vtkNURBSTessellator,
    vtkNURBSWaveletLOD,
)

parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
parser.add_argument("file")
parser.add_argument("folder")
arguments = parser.parse_args()


def write(name, meshes, direction, zoom):
    """A picture of meshes beside each other, each with the edges of its triangles."""
    window = vtkNURBSEGLRenderWindow.Create(400 * len(meshes), 300)
    if window is None:
        raise SystemExit("no OpenGL; the message above tells why")
    window.SetMultiSamples(8)
    for column, mesh in enumerate(meshes):
        mapper = vtkCompositePolyDataMapper()
        mapper.SetInputDataObject(mesh)
        mapper.ScalarVisibilityOff()
        actor = vtkActor()
        actor.SetMapper(mapper)
        actor.GetProperty().SetColor(0.85, 0.87, 0.9)
        actor.GetProperty().SetInterpolationToFlat()
        actor.GetProperty().EdgeVisibilityOn()
        actor.GetProperty().SetEdgeColor(0.15, 0.25, 0.4)
        renderer = vtkRenderer()
        renderer.SetViewport(column / len(meshes), 0, (column + 1) / len(meshes), 1)
        renderer.SetBackground(1, 1, 1)
        renderer.AddActor(actor)
        renderer.GetActiveCamera().SetPosition(direction)
        renderer.GetActiveCamera().SetViewUp(0, 0, 1)
        renderer.ResetCamera()
        renderer.GetActiveCamera().Zoom(zoom)
        window.AddRenderer(renderer)
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    writer = vtkPNGWriter()
    writer.SetInputConnection(grab.GetOutputPort())
    writer.SetFileName(os.path.join(arguments.folder, name))
    writer.Write()


def result(filter):
    filter.Update()
    mesh = filter.GetOutputDataObject(0).NewInstance()
    mesh.ShallowCopy(filter.GetOutputDataObject(0))
    return mesh


reader = vtkNURBSCADReader()
reader.SetFileName(arguments.file)
tessellator = vtkNURBSTessellator()
tessellator.SetInputConnection(reader.GetOutputPort())
meshes = []
for tolerance in (1e-2, 1e-3):
    tessellator.SetTolerance(tolerance)
    meshes.append(result(tessellator))
    print(f"{tolerance:g}: {tessellator.GetNumberOfTriangles()} triangles")
write("tessellation.png", meshes, (1, -1, 1), 1.2)

teapot = vtkNURBSShapeSource()
teapot.SetShapeToTeapot()
levels = vtkNURBSWaveletLOD()
levels.SetInputConnection(teapot.GetOutputPort())
levels.SetFinestTolerance(1e-3)  # of the diagonal
meshes = []
for level in (1, 2, 3):
    levels.SetLevel(level)
    meshes.append(result(levels))
    print(f"level {level}: {levels.GetNumberOfTriangles()} triangles")
write("levels.png", meshes, (3, -8, 4), 1.5)
