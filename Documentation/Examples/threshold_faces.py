"""Faces chosen by an attribute: the large ones of a CAD model, by an area measured first.

    python3 threshold_faces.py [FILE]     writes threshold_faces.png
"""

import sys

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkThreshold
from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter

import vtknurbs

reader = vtknurbs.vtkNURBSCADReader()
reader.SetFileName((sys.argv[1:] or ["/usr/share/opencascade/data/step/linkrods.step"])[0])
reader.SingleModelOn()
reader.Update()
(model,) = vtknurbs.models(reader.GetOutputDataObject(0))
mesh = vtknurbs.vtkNURBSTessellator()
mesh.SetInputData(model)
sizes = vtkCellSizeFilter()  # of the triangles; their FaceId tells the face
sizes.SetInputConnection(mesh.GetOutputPort())
sizes.Update()
triangles = sizes.GetOutput().GetCellData()
faces, of_face = np.unique(vtk_to_numpy(triangles.GetArray("FaceId")), return_inverse=True)
area = numpy_to_vtk(np.bincount(of_face, vtk_to_numpy(triangles.GetArray("Area"))), deep=True)
area.SetName("Area")
model.GetCellData().AddArray(area)

large = vtkThreshold()  # a model again: exact surfaces with their trims
large.SetInputData(model)
large.SetInputArrayToProcess(0, 0, 0, 1, "Area")
large.SetThresholdFunction(vtkThreshold.THRESHOLD_UPPER)
large.SetUpperThreshold(0.5)
large.Update()
print(large.GetOutput().GetNumberOfCells(), "of", len(faces), "faces have at least 0.5 square mm;",
      vtknurbs.vtkNURBSModel.Validate(large.GetOutput()) or "the model is sound")  # fmt: skip
actor = vtknurbs.make_actor(large, color=(0.9, 0.6, 0.3))
vtknurbs.render(actor, file="threshold_faces.png", size=(480, 300), zoom=1.4)
