"""One CAD file as triangles, drawn exactly with its curvature, bent, and as a line drawing.

    python3 overview.py [FILE]     writes overview.png
"""

import sys

import numpy as np
from PIL import Image
import vtknurbs

reader = vtknurbs.vtkNURBSCADReader()
reader.SetFileName((sys.argv[1:] or ["/usr/share/opencascade/data/step/linkrods.step"])[0])
mesh = vtknurbs.vtkNURBSTessellator()
mesh.SetInputConnection(reader.GetOutputPort())
mesh.SetTolerance(3e-3)
exact = vtknurbs.vtkNURBSMapper()
exact.SetInputConnection(reader.GetOutputPort())
exact.SetLookToMeanCurvature()
dense = vtknurbs.vtkNURBSRefinement()
dense.SetInputConnection(reader.GetOutputPort())
bent = vtknurbs.vtkNURBSFreeFormDeformation()
bent.SetInputConnection(dense.GetOutputPort())
for j, k in np.ndindex(4, 4):
    bent.SetLatticeDisplacement(1, j, k, 0, 0, 1.2)
    bent.SetLatticeDisplacement(2, j, k, 0, 0, -1.2)
regions = vtknurbs.vtkNURBSVisibleRegions()
regions.SetInputConnection(reader.GetOutputPort())
regions.SetDirection(1, -1, 1)

actors = [vtknurbs.make_actor(what) for what in (mesh, exact, bent, regions.GetOutputPort(1))]
actors[0].GetProperty().EdgeVisibilityOn()
actors[0].GetProperty().SetEdgeColor(0.15, 0.25, 0.4)
actors[2].GetMapper().SetNumberOfIsoLines(5, 5)
pictures = [vtknurbs.render(actor, size=(250, 250), view=(1, -1, 1), parallel=True, zoom=1.35)
            for actor in actors]  # fmt: skip
Image.fromarray(np.concatenate(pictures, 1)).save("overview.png")
print(mesh.GetNumberOfTriangles(), "triangles,", regions.GetNumberOfVisibleFaces(), "faces visible")
