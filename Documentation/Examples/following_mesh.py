"""A mesh that follows a control point: only what has to change is changed.

    python3 following_mesh.py     writes following_mesh.gif
"""

from math import pi, sin

from PIL import Image

import vtknurbs

sheet = vtknurbs.vtkNURBSShapeSource()
sheet.SetShapeToSheet()
sheet.SetSheetPoints(14, 14)
sheet.SetSheetWaves(0)
drag = vtknurbs.vtkNURBSControlPointEdits()
drag.SetInputConnection(sheet.GetOutputPort())
mesher = vtknurbs.vtkNURBSDeformingTessellator()
mesher.SetInputConnection(drag.GetOutputPort())
mesher.SetTolerance(2e-3)  # of the first frame's diagonal
actor = vtknurbs.make_actor(mesher)
actor.GetProperty().EdgeVisibilityOn()
actor.GetProperty().SetEdgeColor(0.33, 0.38, 0.48)
window = vtknurbs.make_window(actor, size=(400, 300), view=(1, -2, 2), zoom=1.3)

frames = []
for angle in (2 * pi * frame / 24 for frame in range(24)):
    drag.SetControlPointPosition(6 + 14 * 7, 46, 54, 40 * sin(angle))
    frames.append(Image.fromarray(vtknurbs.grab(window)))
    print(mesher.GetNumberOfTriangles(), "triangles,", mesher.GetInsertedVertices(), "new points,",
          f"error {mesher.GetErrorBound():.4f} of {mesher.GetToleranceUsed():.4f}")  # fmt: skip
frames = [frame.quantize(palette=frames[6].quantize(24), dither=0) for frame in frames]
frames[0].save("following_mesh.gif", append_images=frames[1:], save_all=True, duration=60, loop=0)
