"""Curvature of the exact surfaces: as colours for each pixel, and as numbers where asked for.

    python3 curvature.py     writes curvature.png
"""

import numpy as np

import vtknurbs

source = vtknurbs.vtkNURBSShapeSource()
source.SetShapeToTeapot()
source.Update()
teapot = source.GetOutput()

evaluator = vtknurbs.Evaluator(teapot)
u, v = np.meshgrid(np.linspace(0.05, 0.95, 40), np.linspace(0.05, 0.95, 40))
least, largest = [], []
for face in range(teapot.GetNumberOfCells()):
    principal = evaluator.curvatures(face, np.stack([u, v], -1))  # (40, 40, 2)
    least.append(principal[..., 0].min())
    largest.append(principal[..., 1].max())
print(f"principal curvatures from {min(least):.2f} (face {np.argmin(least)})"
      f" to {max(largest):.2f} (face {np.argmax(largest)})")  # fmt: skip

mapper = vtknurbs.vtkNURBSMapper()
mapper.SetInputData(teapot)
mapper.SetLookToMeanCurvature()  # blue bends inwards, red outwards
mapper.SetNumberOfIsoLines(4, 4)
actor = vtknurbs.make_actor(mapper)
actor.GetProperty().SetEdgeColor(0, 0, 0)
actor.GetProperty().SetLineWidth(1.5)
vtknurbs.render(actor, file="curvature.png", size=(400, 280), view=(3, -8, 4), zoom=1.5)
