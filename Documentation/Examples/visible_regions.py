"""What is seen of a CAD model from one side, as a model of its own, looked at from elsewhere.

    python3 visible_regions.py [FILE]     writes visible_regions.png
"""

import sys

import vtknurbs

reader = vtknurbs.vtkNURBSCADReader()
reader.SetFileName((sys.argv[1:] or ["/usr/share/opencascade/data/step/linkrods.step"])[0])
regions = vtknurbs.vtkNURBSVisibleRegions()
regions.SetInputConnection(reader.GetOutputPort())
regions.SetDirection(1, -2, 1)  # towards the viewer who sees them
regions.Update()
print(regions.GetNumberOfVisibleFaces(), "of", regions.GetNumberOfFaces(), "faces are visible,",
      regions.GetNumberOfPartialFaces(), "in part,", round(regions.GetVisibleArea(), 2), "mm2")

# The regions are trimmed surfaces, exact as the model was: every other filter takes them.
mesh = vtknurbs.vtkNURBSTessellator()
mesh.SetInputConnection(regions.GetOutputPort())
mesh.Update()
print(mesh.GetNumberOfTriangles(), f"triangles, certified to {mesh.GetCertifiedError():.6f} mm")

seen = vtknurbs.make_actor(mesh, color=(0.62, 0.72, 0.9))
seen.GetMapper().ScalarVisibilityOff()
vtknurbs.render(seen, file="visible_regions.png", size=(480, 340), view=(-4, -4, 3), zoom=1.1)
