"""A displacement field, as a simulation gives it on a grid, bends exact surfaces.

    python3 displacement_field.py [FILE]     writes displacement_field.png
"""

import sys

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkFiltersCore import vtkProbeFilter
from vtkmodules.vtkFiltersGeneral import vtkWarpVector

import vtknurbs

reader = vtknurbs.vtkNURBSCADReader()
reader.SetFileName((sys.argv[1:] or ["/usr/share/opencascade/data/step/linkrods.step"])[0])
dense = vtknurbs.vtkNURBSRefinement()  # more control points for the same surfaces: planes can bend
dense.SetInputConnection(reader.GetOutputPort())
dense.Update()
model = vtknurbs.models(dense.GetOutputDataObject(0))[0]
x0, x1, y0, y1, z0, z1 = model.GetBounds()
sag = np.zeros((2, 2, 40, 3))  # stands for a simulation's result: a cantilever's, at 160 points
sag[..., 2] = -0.15 * (x1 - x0) * np.linspace(0, 1, 40) ** 2
field = numpy_to_vtk(sag.reshape(-1, 3), deep=True)
field.SetName("Displacement")
grid = vtkImageData()
grid.SetDimensions(40, 2, 2)
grid.SetOrigin(x0, y0, z0)
grid.SetSpacing((x1 - x0) / 39, y1 - y0, z1 - z0)
grid.GetPointData().SetVectors(field)
probe = vtkProbeFilter()  # the field at the control points
probe.SetInputData(model)
probe.SetSourceData(grid)
probe.Update()
model.GetPointData().SetVectors(probe.GetOutput().GetPointData().GetArray("Displacement"))
bent = vtkWarpVector()
bent.SetInputData(model)
vtknurbs.render(bent, file="displacement_field.png", size=(480, 300), view=(1, -3, 1), zoom=1.4)
print(f"lowest point: {z0:.4f}, bent: {bent.GetOutput().GetBounds()[4]:.4f}")
