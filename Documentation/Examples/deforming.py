"""Two animations of meshes that follow, as PNG frames and GIFs: a sheet whose control point is
dragged, and a CAD file in a lattice through which a wave runs.

    PYTHONPATH=build/release/lib/python3/dist-packages \\
        /usr/bin/python3 Documentation/Examples/deforming.py FOLDER [FILE] [--frames 24]
"""

import argparse
import math
import os

from PIL import Image
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer, vtkWindowToImageFilter
from vtkmodules.vtkRenderingOpenGL2 import vtkCompositePolyDataMapper2

from vtknurbs import (vtkNURBSCADReader, vtkNURBSControlPointEdits, vtkNURBSDeformingTessellator,
                      vtkNURBSEGLRenderWindow, vtkNURBSFreeFormDeformation, vtkNURBSRefinement,
                      vtkNURBSShapeSource)

parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
parser.add_argument("folder")
parser.add_argument("file", nargs="?", default="/usr/share/opencascade/data/occ/Motor-c.brep")
parser.add_argument("--frames", type=int, default=24)
parser.add_argument("--tolerance", type=float, default=3e-3, help="of the file's diagonal")
options = parser.parse_args()


def animate(name, deformer, move, tolerance, position, zoom):
    """Draws all frames; move(t) is called with 0 <= t < 1."""
    mesher = vtkNURBSDeformingTessellator()
    mesher.SetInputConnection(deformer.GetOutputPort())
    mesher.SetTolerance(tolerance)
    actor = vtkActor()
    actor.SetMapper(vtkCompositePolyDataMapper2())
    actor.GetMapper().SetInputConnection(mesher.GetOutputPort())
    actor.GetMapper().ScalarVisibilityOff()
    actor.GetProperty().SetColor(0.85, 0.9, 0.98)
    actor.GetProperty().EdgeVisibilityOn()
    actor.GetProperty().SetEdgeColor(0.33, 0.38, 0.48)
    renderer = vtkRenderer()
    renderer.AddActor(actor)
    renderer.SetBackground(1, 1, 1)
    renderer.GetActiveCamera().SetPosition(*position)
    renderer.GetActiveCamera().SetViewUp(0, 0, 1)
    renderer.ResetCamera()
    renderer.GetActiveCamera().Zoom(zoom)
    window = vtkNURBSEGLRenderWindow.Create(400, 300)
    if window is None:
        raise SystemExit("no OpenGL; the message above tells why")
    window.SetMultiSamples(4)
    window.AddRenderer(renderer)
    files = []
    for frame in range(options.frames):
        move(frame / options.frames)
        window.Render()
        grab = vtkWindowToImageFilter()
        grab.SetInput(window)
        grab.ReadFrontBufferOff()
        writer = vtkPNGWriter()
        writer.SetInputConnection(grab.GetOutputPort())
        files.append(os.path.join(options.folder, f"{name}-{frame:03}.png"))
        writer.SetFileName(files[-1])
        writer.Write()
        print(f"{name} {frame}: {mesher.GetNumberOfTriangles()} triangles, "
              f"{mesher.GetInsertedVertices()} vertices inserted, "
              f"{mesher.GetDeletedVertices()} deleted, "
              f"error at most {mesher.GetErrorBound():.3g} of "
              f"{mesher.GetToleranceUsed():.3g}")  # fmt: skip
    palette = Image.open(files[len(files) // 4]).quantize(24)
    none = Image.Dither.NONE
    pictures = [Image.open(file).quantize(palette=palette, dither=none) for file in files]
    pictures[0].save(os.path.join(options.folder, name + ".gif"), save_all=True, loop=0,
                     append_images=pictures[1:], duration=60)  # fmt: skip


sheet = vtkNURBSShapeSource()
sheet.SetShapeToSheet()
sheet.SetSheetPoints(14, 14)
sheet.SetSheetWaves(0)
drag = vtkNURBSControlPointEdits()
drag.SetInputConnection(sheet.GetOutputPort())
animate("sheet", drag, lambda t: drag.SetControlPointPosition(
    6 + 14 * 7, 46, 54, 40 * math.sin(2 * math.pi * t)), 2e-3, (1, -2, 2), 1.3)  # fmt: skip

reader = vtkNURBSCADReader()
reader.SetFileName(options.file)
dense = vtkNURBSRefinement()  # so that planes can bend
dense.SetInputConnection(reader.GetOutputPort())
bend = vtkNURBSFreeFormDeformation()
bend.SetInputConnection(dense.GetOutputPort())
bend.SetDimensions(5, 5, 5)
bend.Update()
box = bend.GetOutputDataObject(1).GetBounds()
size = max(box[1] - box[0], box[3] - box[2], box[5] - box[4])


def wave(t):
    for index in range(125):
        layer = index % 5 + index // 25
        bend.SetLatticeDisplacement(index, 0, 0, 0.08 * size * math.sin(2 * math.pi * t + layer))


animate("lattice", bend, wave, options.tolerance, (1, -2, 1), 1.1)
