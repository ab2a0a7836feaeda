"""A trimmed surface and its control net: what a cell of a model is made of.

    python3 control_net.py     writes control_net.png
"""

import numpy as np

import vtknurbs

plate = vtknurbs.vtkNURBSShapeSource()
plate.SetShapeToPlate()
dense = vtknurbs.vtkNURBSRefinement()
dense.SetInputConnection(plate.GetOutputPort())
dense.SetMaximumSpacing(0.15)
bow = vtknurbs.vtkNURBSFreeFormDeformation()
bow.SetInputConnection(dense.GetOutputPort())
for j, k in np.ndindex(4, 4):
    bow.SetLatticeDisplacement(1, j, k, 0, 0, 0.5)
    bow.SetLatticeDisplacement(2, j, k, 0, 0, 0.5)
net = vtknurbs.vtkNURBSControlNet()
net.SetInputConnection(bow.GetOutputPort())

surface = vtknurbs.make_actor(bow)
surface.GetProperty().EdgeVisibilityOn()
surface.GetProperty().SetLineWidth(2)
lines = vtknurbs.make_actor(net, color=(0.8, 0.3, 0.1))
lines.GetMapper().ScalarVisibilityOff()
lines.GetProperty().LightingOff()
lines.GetProperty().SetPointSize(5)
vtknurbs.render(surface, lines, file="control_net.png", size=(480, 300), view=(1, -3, 2), zoom=1.4)
rows = np.prod(vtknurbs.get_surface(bow.GetOutputDataObject(0), 0).points.shape[:2])
print(net.GetOutput().GetNumberOfLines(), "lines of the net;", rows, "control points")
