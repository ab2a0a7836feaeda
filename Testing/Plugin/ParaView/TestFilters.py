# SPDX-License-Identifier: BSD-3-Clause
"""Plugin loaded twice, reader through the factory, every filter on its default values."""
from paraview import simple
from session import FILTERS, LINKRODS, leaves, load_plugin, path, size, updated

import vtknurbs
from vtkmodules.vtkCommonCore import vtkSMPTools


def direct(filter_class, source):
    """The class itself, without ParaView, on its own default values."""
    made = filter_class()
    made.SetInputConnection(source.GetOutputPort())
    made.Update()
    return made


def count(data):
    """Cells and points of a data object."""
    if data.IsA("vtkCompositeDataSet"):
        return data.GetNumberOfCells(), data.GetNumberOfPoints()
    return data.GetNumberOfCells(), data.GetNumberOfPoints()


load_plugin()
load_plugin()
reader = updated(simple.OpenDataFile(LINKRODS))
assert reader.GetXMLName() == "NURBSCADReader", reader.GetXMLName()
assert reader.GetDataInformation().GetCompositeDataClassName() == (
    "vtkPartitionedDataSetCollection"
)
assert size(reader)[0] == 37
assert reader.GetPropertyValue("ParseSeconds") > 0.0
print("threads by", vtkSMPTools.GetBackend())

plain = vtknurbs.vtkNURBSCADReader()
plain.SetFileName(LINKRODS)
plain.Update()
# Of the plugin's own classes, those behind the proxies of another name.
classes = {name: getattr(vtknurbs, "vtk" + name) for name in FILTERS}
for name in FILTERS:
    made = updated(getattr(simple, name)(Input=reader))
    reference = direct(classes[name], plain)
    assert size(made) == count(reference.GetOutputDataObject(0)), name
    assert size(made)[0] >= (10 if name == "NURBSVisibleRegions" else 37), name
    print("%-26s %6d cells %6d points" % ((name,) + size(made)))
    for ports in range(1, made.SMProxy.GetNumberOfOutputPorts()):
        assert size(made, ports) == count(reference.GetOutputDataObject(ports)), (name, ports)
    for prop in ("NumberOfTriangles", "CertifiedError", "ErrorBound", "NumberOfLines", "VisibleArea"):
        if hasattr(reference, "Get" + prop):
            value = made.GetPropertyValue(prop)
            assert value == getattr(reference, "Get" + prop)() and value > 0, (name, prop, value)

tessellator = simple.FindSource("NURBSTessellator1")
assert 0 < tessellator.CertifiedError <= tessellator.ToleranceUsed
assert (tessellator.NumberOfFaces, tessellator.NumberOfFailedFaces) == (37, 0)
assert [mesh.GetClassName() for mesh in leaves(tessellator)] == ["vtkPolyData"]
coarse = tessellator.NumberOfTriangles
tessellator.Tolerance = 1e-4
updated(tessellator)
assert tessellator.NumberOfTriangles > coarse
assert tessellator.CertifiedError <= tessellator.ToleranceUsed

# Pixels of a camera: twice as far, fewer triangles.
tessellator.ToleranceMode = "Pixels of a view"
far = []
for distance in (50.0, 100.0, 200.0):
    tessellator.Camera.CameraPosition = [0.0, 0.0, distance]
    far.append(updated(tessellator).NumberOfTriangles)
assert far[0] > far[1] > far[2] > 0, far

# Meshes follow what is moved upstream, by tables of the panel.
teapot = simple.NURBSShapeSource()
assert size(updated(teapot))[0] == 32
lattice = simple.NURBSFreeFormDeformation(Input=teapot, LatticeMoves=[3, 3, 3, 0.5, 0.0, 0.5])
edits = simple.NURBSControlPointEdits(Input=lattice, Moves=[0, 69, 0.8, -0.2, -1.0])
follower = updated(simple.NURBSDeformingTessellator(Input=edits))
assert updated(lattice).NumberOfMovedPoints > 0
assert updated(edits).NumberOfEdits > 0
assert follower.RebuiltModels == 1 and follower.MovedControlPoints == 0
lattice.LatticeMoves = [3, 3, 3, 0.5, 0.0, 0.6]
updated(follower)
assert follower.RebuiltModels == 0 and follower.MovedControlPoints > 0
updated(follower)
moved = leaves(edits)[0].GetPoint(69)
at_rest = leaves(lattice)[0].GetPoint(69)
assert all(abs(moved[i] - at_rest[i] - (0.8, -0.2, -1.0)[i]) < 1e-12 for i in range(3)), moved
# Rows that are taken away are undone, and a change of the lattice keeps its rows.
edits.Moves = []
assert updated(edits).NumberOfEdits == 0
assert leaves(edits)[0].GetPoint(69) == at_rest
lattice.Dimensions = [5, 5, 5]
assert updated(lattice).NumberOfMovedPoints > 0

# A moved lattice by a second input.
warp = simple.WarpByVector(Input=simple.OutputPort(lattice, 1), Vectors=["POINTS", "Displacement"])
bent = simple.NURBSFreeFormDeformation(Input=teapot, Dimensions=[5, 5, 5], Lattice=warp)
assert updated(bent).NumberOfMovedPoints > 0

# A drawing of what is seen, as files.
seen = simple.NURBSVisibleRegions(Input=reader, Direction=[1, 1, 1], ProjectLines=1)
for name, start in (("drawing.svg", b"<?xml"), ("drawing.pdf", b"%PDF")):
    simple.SaveData(path(name), proxy=simple.OutputPort(seen, 1), PageSize="A4", Title="rods")
    with open(path(name), "rb") as file:
        text = file.read()
    assert text.startswith(start) and len(text) > 2000, (name, len(text))
    assert name != "drawing.svg" or (b'width="297mm"' in text or b'width="210mm"' in text)

# To Bezier cells and back: exact, so the same silhouettes' number of faces as patches.
bezier = simple.NURBSToBezierCells(Input=teapot)
back = updated(simple.NURBSFromBezierCells(Input=bezier))
assert size(back)[0] == size(updated(bezier))[0] == 32
print("passed")
