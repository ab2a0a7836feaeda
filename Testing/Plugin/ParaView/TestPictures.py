# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of pvbatch: what models, triangles, lattices and drawings look like in the view.

Figures first, then the baselines of Data/Baselines, from which no picture may differ in more than 60
of its 43,200 pixels (see session.baseline_difference).
"""
import numpy as np
from paraview import simple
from session import LINKRODS, baseline_difference, load_plugin, path, updated
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

SIZE = (240, 180)


def look(position, up, zoom=1.0):
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = position, [0, 0, 0], up
    view.ResetCamera(True)
    view.GetActiveCamera().Zoom(zoom)


def picture(name, compared=True):
    """The view as an array of rows from the bottom, columns, RGB; compared later."""
    file = path("pictures-%s.png" % name)
    simple.SaveScreenshot(file, view, ImageResolution=SIZE)
    if compared:
        made.append((name, file))
    reader = vtkPNGReader()
    reader.SetFileName(file)
    reader.Update()
    image = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())[:, :3]
    return image.reshape(SIZE[1], SIZE[0], 3).astype(int)


def covered(image):
    return (image != 255).any(axis=2)


made = []
load_plugin()
view = simple.CreateView("RenderView")
view.ViewSize = SIZE
view.OrientationAxesVisibility = 0
view.UseColorPaletteForBackground = 0
view.Background = [1.0, 1.0, 1.0]
view.UseFXAA = 0
rods = updated(simple.OpenDataFile(LINKRODS))

# Surfaces and their edges; the same surfaces as triangles.
display = simple.Show(rods, view)
display.FaceEdges = 1
display.EdgeColor = [0.0, 0.0, 0.0]
look([1.0, -1.5, 1.2], [0.0, 0.0, 1.0])
surfaces = picture("surfaces")
simple.Hide(rods, view)
mesh = updated(simple.NURBSTessellator(Input=rods, Tolerance=1e-4))
display = simple.Show(mesh, view)
simple.ColorBy(display, ("CELLS", "FaceId"))
simple.GetColorTransferFunction("FaceId").RescaleTransferFunction(0.0, 36.0)
display.SetScalarBarVisibility(view, False)
triangles = picture("triangles")
both = covered(surfaces) & covered(triangles)
print("%d pixels, %d as triangles" % (covered(surfaces).sum(), covered(triangles).sum()))
assert both.sum() > 8000
for seen in (surfaces, triangles):
    assert covered(seen).sum() - both.sum() < 0.01 * both.sum()
simple.Hide(mesh, view)

# Lines as seen from where the camera is: none outside of the surfaces, visible and hidden ones.
regions = updated(simple.NURBSVisibleRegions(Input=rods, Direction=[1.0, -1.5, 1.2]))
drawing = simple.Show(simple.OutputPort(regions, 1), view)
drawing.LineWidth = 1.0
simple.ColorBy(drawing, ("CELLS", "Visibility"))
drawing.SetScalarBarVisibility(view, False)
look([1.0, -1.5, 1.2], [0.0, 0.0, 1.0])
lines = picture("drawing")
print("%d pixels of lines" % covered(lines).sum())
assert 600 < covered(lines).sum() < 0.3 * covered(surfaces).sum()
simple.Hide(simple.OutputPort(regions, 1), view)

# A bent teapot in its lattice, which the table's displacement pulls to the right.
teapot = simple.NURBSShapeSource()
bent = simple.NURBSFreeFormDeformation(
    Input=teapot, Dimensions=[3, 3, 3], LatticeMoves=[2, 1, 2, 1.0, 0.0, 0.0]
)
simple.Show(bent, view)
look([0.3, -2.0, 0.5], [0.0, 0.0, 1.0])
alone = covered(picture("bent", False))
simple.Show(simple.OutputPort(bent, 1), view).AmbientColor = [0.0, 0.0, 0.0]
lattice = covered(picture("lattice"))
assert (lattice >= alone).all() and 500 < lattice.sum() - alone.sum() < 4000
simple.Hide(simple.OutputPort(bent, 1), view)
bent.LatticeMoves = []
rest = covered(picture("rest", False))
right = [np.nonzero(seen.any(axis=0))[0].max() for seen in (rest, alone)]
print("the spout ends at column %d, pulled at %d" % tuple(right))
assert right[1] >= right[0] + 5
display = simple.GetDisplayProperties(bent, view)
display.Look = "Zebra"
display.LookDirection = [0.0, 0.0, 1.0]
zebra = picture("zebra")
assert 0.2 < (zebra[rest].max(axis=1) < 60).mean() < 0.8

bad = 0
for name, file in made:
    differ = baseline_difference(file, name)
    print("%-10s differs from its baseline by %.1f pixels" % (name, differ))
    bad += differ > 60
# The comparison can fail: another picture is no match.
assert baseline_difference(made[0][1], "zebra") > 1000
assert bad == 0, "%d pictures differ" % bad
print("passed")
