# SPDX-License-Identifier: BSD-3-Clause
"""The representation NURBS Surface, pixel by pixel beside the tessellator's triangles."""
import numpy as np
import vtknurbs
from paraview import simple
from session import SCREW, load_plugin, path, size, updated
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkSelectionNode
from vtkmodules.vtkIOImage import vtkPNGReader

SIZE = (240, 180)
BACKGROUND = (0, 0, 0)


def picture(name):
    """The view as an array of rows from the bottom, columns, RGB."""
    simple.SaveScreenshot(path(name), view, ImageResolution=SIZE)
    reader = vtkPNGReader()
    reader.SetFileName(path(name))
    reader.Update()
    image = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())[:, :3]
    return image.reshape(SIZE[1], SIZE[0], 3).astype(int)


def covered(image):
    return (image != BACKGROUND).any(axis=2)


def flat(display):
    """Without light: pixels have the colours themselves."""
    display.Ambient, display.Diffuse, display.Specular = 1.0, 0.0, 0.0
    return display


def by_face(display):
    simple.ColorBy(display, ("CELLS", "FaceId"))
    table = simple.GetColorTransferFunction("FaceId")
    table.RescaleTransferFunction(0.0, FACES - 1.0)
    return flat(display)


def away(image, reference):
    """Share of the covered pixels that differ by more than rounding."""
    differ = (abs(image - reference) > 2).any(axis=2)
    return differ.sum() / covered(reference).sum()


def faces_in(rectangle):
    """Cells that ParaView's surface selection finds, as (block, cell)."""
    simple.ClearSelection(reader)
    simple.SelectSurfaceCells(Rectangle=rectangle, View=view)
    selection = reader.GetSelectionInput(reader.Port)
    if not selection:
        return set()
    selection.UpdatePipeline()
    nodes = selection.GetClientSideObject().GetOutputDataObject(0)
    found = set()
    for n in range(nodes.GetNumberOfNodes()):
        properties = nodes.GetNode(n).GetProperties()
        block = properties.Get(vtkSelectionNode.COMPOSITE_INDEX())
        assert properties.Get(vtkSelectionNode.FIELD_TYPE()) == vtkSelectionNode.CELL
        ids = vtk_to_numpy(nodes.GetNode(n).GetSelectionList())
        found |= {(block, int(i)) for i in ids.reshape(len(ids), -1)[:, -1]}
    return found


load_plugin()
view = simple.CreateView("RenderView")
view.ViewSize = SIZE
view.OrientationAxesVisibility = 0
view.UseColorPaletteForBackground = 0
view.Background = [0.0, 0.0, 0.0]
view.UseFXAA = 0

reader = updated(simple.OpenDataFile(SCREW))
FACES = size(reader)[0]
box = reader.GetDataInformation().GetBounds()
diagonal = np.linalg.norm([box[2 * k + 1] - box[2 * k] for k in range(3)])
display = simple.Show(reader, view)
assert display.Representation == "NURBS Surface", display.Representation
mesh = simple.NURBSTessellator(Input=reader, Tolerance=1e-4)
triangles = simple.Show(mesh, view)
assert triangles.Representation == "Surface", triangles.Representation
simple.Hide(mesh, view)
view.ResetCamera(True)
camera = view.GetActiveCamera()
camera.Azimuth(30)
camera.Elevation(25)
view.CameraParallelProjection = 1

# Models are surfaces, second outputs are not.
for name, second in (("NURBSVisibleRegions", "Surface"), ("NURBSFreeFormDeformation", "Wireframe")):
    made = getattr(simple, name)(Input=reader)
    for port, wanted in enumerate(["NURBS Surface", second]):
        shown = simple.Show(simple.OutputPort(made, port), view).Representation
        assert shown == wanted, (name, port, shown)
        simple.Hide(simple.OutputPort(made, port), view)

# Lit, and without an array: where it is, and how bright.
lit = picture("surface.png")
simple.Hide(reader, view)
simple.Show(mesh, view)
lit_triangles = picture("triangles.png")
pixels = covered(lit).sum()
differ = (covered(lit) != covered(lit_triangles)).sum()
print("covered %d pixels, %d differ from the triangles'" % (pixels, differ))
assert pixels > 5000 and differ <= 0.01 * pixels, (pixels, differ)
both = covered(lit) & covered(lit_triangles)
assert abs(lit[both] - lit_triangles[both]).mean() < 2.0

# Faces by an array, the selection of faces.
by_face(simple.GetDisplayProperties(mesh, view))
face_triangles = picture("face-triangles.png")
simple.Hide(mesh, view)
simple.Show(reader, view)
by_face(display)
faces = picture("faces.png")
print("colours of faces: %.4f of the pixels differ" % away(faces, face_triangles))
assert away(faces, face_triangles) < 0.02
colours = {tuple(c) for c in faces[covered(faces)]}
assert len(colours) >= 6, colours

found = faces_in([0, 0, SIZE[0] - 1, SIZE[1] - 1])
print("%d faces selected of %d colours" % (len(found), len(colours)))
assert len(found) == len(colours), (found, len(colours))
# One pixel, one face: that of its colour.
table = simple.GetColorTransferFunction("FaceId").GetClientSideObject()
rows, columns = np.nonzero(covered(faces))
for k in range(0, len(rows), len(rows) // 5):
    y, x = int(rows[k]), int(columns[k])
    for _, face in faces_in([x, y, x, y]):
        expected = [0.0, 0.0, 0.0]
        table.GetColor(face, expected)
        expected = [255.0 * c for c in expected]
        assert max(abs(expected - faces[y, x])) <= 3, (face, expected, faces[y, x])
# It is shown in the selection's colour.
face = tuple(faces[len(faces) // 2, SIZE[0] // 2])
inside = (faces == face).all(axis=2)
y, x = (int(i) for i in np.argwhere(inside)[inside.sum() // 2])
assert len(faces_in([x, y, x, y])) == 1 and inside.sum() > 300
selected = (picture("selected.png") == (255, 0, 255)).all(axis=2)
print("selected face: %d of %d pixels" % ((selected & inside).sum(), inside.sum()))
assert (selected & inside).sum() > 0.95 * inside.sum()
assert (selected & ~inside & covered(faces)).sum() < 300  # marks of control points
simple.ClearSelection(reader)
assert away(picture("unselected.png"), faces) == 0.0
simple.ColorBy(display, None)

# Opacity, edges, looks.
plain = flat(display) and picture("plain.png")
display.Opacity = 0.5
half = picture("half.png")
once = covered(half)
assert (covered(plain) == once).all()
assert 0.3 < half[once].mean() / plain[once].mean() < 0.97, half[once].mean()
display.Opacity = 1.0
display.FaceEdges = 1
display.EdgeColor = [1.0, 0.0, 0.0]
edges = picture("edges.png")
red = (edges[:, :, 0] - edges[:, :, 1] > 60).sum()
print("edges: %d pixels" % red)
assert 100 < red < 0.3 * pixels, red
display.FaceEdges = 0
display.Look = "Zebra"
display.LookDirection = [1.0, 0.3, 0.2]
zebra = picture("zebra.png")
dark = (zebra[covered(plain)].max(axis=1) < 30).mean()
print("zebra: %.2f of the pixels are dark" % dark)
assert 0.2 < dark < 0.8, dark
display.Look = "Isophotes"
assert away(picture("isophotes.png"), zebra) > 0.1
display.Look = "Mean Curvature"
display.UseLookRange = 1
display.LookRange = [-3.0 / diagonal, 3.0 / diagonal]
curved = picture("curvature.png")[covered(plain)]
assert (curved[:, 0] > curved[:, 2] + 60).mean() > 0.2  # What bends outwards is red,
assert (abs(curved[:, 0] - curved[:, 2]) <= 2).mean() > 0.02  # planes are grey.
display.UseLookRange = 0
display.Look = "Plain"

# How far the picture is from the one that the mapper's triangles make.
display.PixelError = 50.0
display.ExactFragments = 0
coarse = covered(picture("coarse.png"))
assert (coarse != covered(plain)).sum() > 20
display.PixelError = 0.5
display.ExactFragments = 1
display.UseTessellation = 1
assert (covered(picture("tessellation.png")) != covered(plain)).sum() < 0.02 * pixels
display.UseTessellation = 0
simple.Hide(reader, view)

# Blocks: hidden, coloured, and of an opacity of their own.
near = simple.NURBSShapeSource(Shape="Torus")
far = simple.NURBSShapeSource(Shape="Sphere", Radius=0.5)
group = simple.GroupDatasets(registrationName="group", Input=[near, far], BlockNames=["ring", "ball"])
blocks = flat(simple.Show(group, view))
blocks.SetRepresentationType("NURBS Surface")
view.ResetCamera(True)
all_blocks = covered(picture("blocks.png"))
blocks.BlockSelectors = ["/Root/ball"]
ball = covered(picture("ball.png"))
blocks.BlockSelectors = ["/Root/ring"]
ring = covered(picture("ring.png"))
print("blocks: %d pixels, ball %d, ring %d" % (all_blocks.sum(), ball.sum(), ring.sum()))
assert ball.sum() > 500 and ring.sum() > 2000
assert ((ball | ring) == all_blocks).all()
blocks.BlockSelectors = ["/"]
blocks.BlockColors = ["/Root/ball", "0", "1", "0"]
image = picture("coloured.png")
green = (image == (0, 255, 0)).all(axis=2)
assert green.sum() > 500 and not (green & ~ball).any(), green.sum()

# The colours of the CAD file, here made up.
source = vtknurbs.vtkNURBSShapeSource()
source.SetShapeToCylinder()
source.Update()
model = source.GetOutput()
colours = numpy_to_vtk(np.array([[255, 0, 0], [0, 255, 0], [0, 0, 255]], np.uint8), deep=True)
colours.SetName("Color")
model.GetCellData().AddArray(colours)
painted = simple.TrivialProducer()
painted.GetClientSideObject().SetOutput(model)
paint = flat(simple.Show(painted, view))
paint.SetRepresentationType("NURBS Surface")
simple.Hide(group, view)
view.ResetCamera(True)
image = picture("painted.png")
seen = {tuple(c) for c in image[covered(image)]}
assert len(seen) >= 2 and seen < {(255, 0, 0), (0, 255, 0), (0, 0, 255)}, seen
paint.UseModelColors = 0
image = picture("unpainted.png")
assert len({tuple(c) for c in image[covered(image)]}) == 1
simple.Hide(painted, view)

# A model that was cut by a filter of ParaView is a model still.
some = simple.Threshold(Input=reader, Scalars=["CELLS", "FaceId"], LowerThreshold=0, UpperThreshold=5)
part = simple.Show(some, view)
simple.Hide(group, view)
assert part.Representation == "NURBS Surface", part.Representation
view.ResetCamera(True)
assert covered(picture("threshold.png")).sum() > 1000
print("passed")
