"""Filters use all processors by themselves, and their number changes nothing in the result.

    python3 parallel.py     writes parallel.png
"""

import time

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkSMPTools

import vtknurbs

source = vtknurbs.vtkNURBSShapeSource()
source.SetShapeToCarBody()  # a load for tests: as many trimmed patches as one asks for
source.SetNumberOfPatches(2000)
source.Update()

meshes = []
for threads in (1, 2):
    vtkSMPTools.Initialize(threads)  # or VTK_SMP_MAX_THREADS; without: all there are
    tessellator = vtknurbs.vtkNURBSTessellator()
    tessellator.SetInputData(source.GetOutput())
    started = time.perf_counter()
    tessellator.Update()
    print(f"{threads} thread(s): {tessellator.GetNumberOfTriangles()} triangles in"
          f" {time.perf_counter() - started:.2f} s")  # fmt: skip
    meshes.append(tessellator.GetOutputDataObject(0))

points = [vtk_to_numpy(mesh.GetPoints().GetData()) for mesh in meshes]
corners = [vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()) for mesh in meshes]
print("the same, bit for bit:", np.array_equal(*points) and np.array_equal(*corners))

vtknurbs.render(meshes[1], file="parallel.png", size=(480, 300), view=(1, -2, 1.5), zoom=1.5)
