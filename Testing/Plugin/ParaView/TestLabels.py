# SPDX-License-Identifier: BSD-3-Clause
"""Labels of selected faces stand on the faces; curvatures and draft angles have a legend."""
import numpy
from paraview import simple
from session import SCREW, leaves, load_plugin, path, updated

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import mutable
from vtkmodules.vtkCommonDataModel import vtkGenericCell, vtkStaticCellLocator
from vtkmodules.vtkFiltersCore import vtkThreshold
from vtkmodules.vtkIOImage import vtkPNGReader

SELECTED = [0, 2, 5, 7]

load_plugin()
view = simple.CreateView("RenderView")
view.ViewSize = [400, 300]
view.OrientationAxesVisibility = 0
screw = updated(simple.OpenDataFile(SCREW))
display = simple.Show(screw, view)
view.ResetCamera(True)


def labels():
    """What ParaView's representations of labels were given: blocks of cells."""
    inner = view.GetClientSideObject()
    found = []
    for n in range(inner.GetNumberOfRepresentations()):
        shown = inner.GetRepresentation(n)
        if shown.IsA("vtkDataLabelRepresentation") and shown.GetVisibility():
            found.append(shown.GetInputDataObject(0, 0))
    return found


def grids(data):
    if not data.IsA("vtkCompositeDataSet"):
        return [data]
    iterator = data.NewIterator()
    iterator.InitTraversal()
    made = []
    while not iterator.IsDoneWithTraversal():
        made.append(iterator.GetCurrentDataObject())
        iterator.GoToNextItem()
    return made


def distance(mesh, face, place):
    """From the triangles of a face."""
    part = vtkThreshold()
    part.SetInputData(mesh)
    part.SetInputArrayToProcess(0, 0, 0, 1, "FaceId")
    part.SetLowerThreshold(face)
    part.SetUpperThreshold(face)
    part.Update()
    locator = vtkStaticCellLocator()
    locator.SetDataSet(part.GetOutput())
    locator.BuildLocator()
    nearest, square = [0.0, 0.0, 0.0], mutable(0.0)
    locator.FindClosestPoint(place, nearest, vtkGenericCell(), mutable(0), mutable(0), square)
    return square**0.5


simple.QuerySelect("in1d(id, %s)" % SELECTED, "CELL", screw)
display.SelectionCellLabelVisibility = 1
display.SelectionCellFieldDataArrayName = "FaceId"
simple.Render(view)
(marks,) = (grid for data in labels() for grid in grids(data) if grid.GetNumberOfCells() > 0)
assert marks.GetNumberOfPoints() == marks.GetNumberOfCells() == len(SELECTED)
(mesh,) = leaves(updated(simple.NURBSTessellator(Input=screw, Tolerance=1e-4)))
size = mesh.GetLength()
faces = vtk_to_numpy(marks.GetCellData().GetArray("FaceId"))
print("labels at", [marks.GetPoint(cell) for cell in range(len(SELECTED))])
others = set(vtk_to_numpy(mesh.GetCellData().GetArray("FaceId"))) - set(faces)
assert len(set(faces)) == len(SELECTED)
for cell, face in enumerate(faces):
    place = marks.GetPoint(cell)
    assert distance(mesh, face, place) < 2e-4 * size, (face, place)
    assert min(distance(mesh, other, place) for other in others) > 1e-3 * size, (face, place)

# Labels of control points need the control points.
display.SelectionPointLabelVisibility = 1
simple.Render(view)
(nets,) = (grid for data in labels() for grid in grids(data) if grid.GetNumberOfCells() > 0)
assert nets.GetNumberOfPoints() > 4 * nets.GetNumberOfCells() == 4 * len(SELECTED)
display.SelectionPointLabelVisibility = 0
simple.Render(view)
assert [g.GetNumberOfPoints() for d in labels() for g in grids(d)] == [len(SELECTED)]
simple.ClearSelection(screw)


def picture(name):
    simple.SaveScreenshot(path(name), view)
    reader = vtkPNGReader()
    reader.SetFileName(path(name))
    reader.Update()
    image = reader.GetOutput()
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(300, 400, -1)[:, :, :3]


def legend_pixels(look):
    """How many pixels a legend changes, and in which columns."""
    display.Look = look
    display.ShowLegend = 0
    without = picture("without.png").astype(int)
    display.ShowLegend = 1
    changed = numpy.abs(picture("with.png") - without).max(axis=2) > 16
    return changed.sum(), numpy.flatnonzero(changed.any(axis=0))


for look in ("Mean Curvature", "Gaussian Curvature", "Draft Angle"):
    count, columns = legend_pixels(look)
    assert count > 1000 and columns[-1] < 150, (look, count, columns)
for look in ("Plain", "Zebra", "Isophotes"):
    assert legend_pixels(look)[0] == 0, look
display.Look = "Mean Curvature"
simple.Hide(screw, view)
empty = picture("hidden.png")
assert (empty == empty[0, 0]).all(), "a legend of what does not show"
print("passed")
