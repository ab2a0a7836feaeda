"""A lattice around a CAD model bends all in it, as a wave that runs through; the mesh follows.

    python3 free_form.py [FILE]     writes free_form.gif
"""

import sys
from math import pi, sin

from PIL import Image

import vtknurbs

reader = vtknurbs.vtkNURBSCADReader()
reader.SetFileName((sys.argv[1:] or ["/usr/share/opencascade/data/occ/Motor-c.brep"])[0])
dense = vtknurbs.vtkNURBSRefinement()  # more control points for the same surfaces: planes can bend
dense.SetInputConnection(reader.GetOutputPort())
bend = vtknurbs.vtkNURBSFreeFormDeformation()
bend.SetInputConnection(dense.GetOutputPort())
bend.SetDimensions(5, 5, 5)
mesher = vtknurbs.vtkNURBSDeformingTessellator()
mesher.SetInputConnection(bend.GetOutputPort())
mesher.SetTolerance(3e-3)
actor = vtknurbs.make_actor(mesher, color=(0.85, 0.9, 0.98))
actor.GetMapper().ScalarVisibilityOff()
window = vtknurbs.make_window(actor, size=(400, 300), view=(1, -2, 1), zoom=1.1)
x0, x1, y0, y1, z0, z1 = bend.GetOutputDataObject(1).GetBounds()
height = 0.08 * max(x1 - x0, y1 - y0, z1 - z0)

frames = []
for angle in (2 * pi * frame / 24 for frame in range(24)):
    for point in range(bend.GetNumberOfLatticePoints()):
        bend.SetLatticeDisplacement(point, 0, 0, height * sin(angle + point % 5 + point // 25))
    frames.append(Image.fromarray(vtknurbs.grab(window)))
    print(f"{bend.GetNumberOfMovedPoints()} control points moved, {mesher.GetNumberOfTriangles()}",
          f"triangles, {mesher.GetRebuiltModels()} models meshed anew")  # fmt: skip
frames = [frame.quantize(palette=frames[6].quantize(32), dither=0) for frame in frames]
frames[0].save("free_form.gif", save_all=True, loop=0, append_images=frames[1:], duration=60)
