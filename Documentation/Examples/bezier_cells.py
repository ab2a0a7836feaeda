"""Isogeometric analysis: surfaces as VTK's rational Bezier cells, a result on them, and back.

    python3 bezier_cells.py     writes bezier_cells.png
"""

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter

import vtknurbs

source = vtknurbs.vtkNURBSShapeSource()
source.SetShapeToTorus()  # rational: circles are exact
cells = vtknurbs.vtkNURBSToBezierCells()
cells.SetInputConnection(source.GetOutputPort())
cells.Update()
patches = cells.GetOutput()

# A result has one coefficient a control point, as the geometry has, interpolated the same way:
# coefficients of a linear field must give that field (the patch test).
x = vtk_to_numpy(patches.GetPoints().GetData())
patches.GetPointData().SetScalars(numpy_to_vtk(x @ [1, 2, 3], deep=True))
surface = vtkDataSetSurfaceFilter()
surface.SetInputData(patches)
surface.SetNonlinearSubdivisionLevel(4)
surface.Update()
shown = surface.GetOutput()
points = vtk_to_numpy(shown.GetPoints().GetData())
difference = vtk_to_numpy(shown.GetPointData().GetScalars()) - points @ [1, 2, 3]
print(patches.GetNumberOfCells(), "cells; the field is off by", f"{np.abs(difference).max():.1e}")

back = vtknurbs.vtkNURBSFromBezierCells()
back.SetInputConnection(cells.GetOutputPort())
back.Update()
print(back.GetOutput().GetNumberOfCells(), "surfaces again, joined at their sides")
actor = vtknurbs.make_actor(shown)
actor.GetMapper().ScalarVisibilityOn()
actor.GetMapper().SetScalarModeToUsePointData()
actor.GetMapper().SetScalarRange(-4, 4)
vtknurbs.render(actor, file="bezier_cells.png", size=(400, 280), view=(1, -2, 2), zoom=1.4)
