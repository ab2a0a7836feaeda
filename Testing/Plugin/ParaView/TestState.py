# SPDX-License-Identifier: BSD-3-Clause
"""A session saved as .pvsm and .py and loaded again, with its picture; a trace replayed."""
from paraview import simple, smstate, smtrace
from session import LINKRODS, load_plugin, path, size, updated

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader


def build():
    reader = simple.OpenDataFile(LINKRODS, registrationName="rods", LengthUnit="Metres")
    bent = simple.NURBSFreeFormDeformation(
        registrationName="bent", Input=reader, LatticeMoves=[3, 3, 3, 0.001, 0, 0.002]
    )
    mesh = simple.NURBSTessellator(registrationName="mesh", Input=bent, Tolerance=2e-4)
    # As the GUI's Apply tells the trace of changes.
    for proxy, changes in (
        (mesh, {"ToleranceMode": "A length", "AbsoluteTolerance": 2e-6}),
        (mesh.Camera, {"CameraPosition": [1.0, 2.0, 3.0]}),
    ):
        item = smtrace.PropertiesModified(proxy)
        for name, value in changes.items():
            setattr(proxy, name, value)
        item.finalize()
    simple.NURBSSilhouette(registrationName="lines", Input=bent, Direction=[1, 2, 3])
    follower = simple.NURBSDeformingTessellator(registrationName="follower", Input=bent)
    follower.Camera = "Nobody"
    view = simple.CreateView("RenderView")
    simple.Show(mesh, view)
    simple.Hide(mesh, view)
    display = simple.Show(reader, view)
    item = smtrace.PropertiesModified(display)
    display.Look, display.FaceEdges, display.PixelError = "Zebra", 1, 0.25
    item.finalize()


def figures():
    found = {name: simple.FindSource(name) for name in ("rods", "bent", "mesh", "lines", "follower")}
    for proxy in found.values():
        updated(proxy)
    mesh = found["mesh"]
    display = simple.GetDisplayProperties(found["rods"], simple.GetActiveView())
    return (
        [size(proxy) for proxy in found.values()],
        list(found["bent"].LatticeMoves),
        found["bent"].NumberOfMovedPoints,
        (mesh.CertifiedError, mesh.AbsoluteTolerance, list(mesh.Camera.CameraPosition)),
        list(found["lines"].Direction),
        (display.Representation, display.Look, display.FaceEdges, display.PixelError),
    )


def picture(name):
    """The view as it is, small."""
    simple.SaveScreenshot(path(name), simple.GetActiveView(), ImageResolution=[300, 200])
    reader = vtkPNGReader()
    reader.SetFileName(path(name))
    reader.Update()
    return vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).astype(int)


def fresh_session():
    simple.ResetSession()
    assert not simple.GetSources()
    load_plugin()


def checked(kind, expected):
    got = figures()
    assert got == expected, "%s: %s instead of %s" % (kind, got, expected)
    # The trace holds the camera only as the view was made, as no person moved it.
    if kind != "trace":
        away = (abs(picture(kind + ".png") - seen).max(axis=1) > 16).sum()
        assert away == 0, "%s: %d pixels are another" % (kind, away)
    print("%-6s %s" % (kind, got[0]))


load_plugin()
smtrace.start_trace()
build()
trace = smtrace.stop_trace()
expected = figures()
print("built ", expected)
assert expected[5] == ("NURBS Surface", "Zebra", 1, 0.25), expected
assert expected[2] > 0 and 0 < expected[3][0] <= 2e-6
view = simple.GetActiveView()
view.CameraPosition = [0.02, 0.03, 0.04]
view.ResetCamera(True)
seen = picture("seen.png")
assert 0.05 < (abs(seen - seen[0]).max(axis=1) > 16).mean() < 0.95
simple.SaveState(path("plugin.pvsm"))
with open(path("plugin.py"), "w") as file:
    file.write(smstate.get_state())

fresh_session()
simple.LoadState(path("plugin.pvsm"))
checked("pvsm", expected)

for kind, text in (("py", open(path("plugin.py")).read()), ("trace", trace)):
    assert "NURBSTessellator(" in text, kind
    fresh_session()
    exec(compile(text, kind, "exec"), {"__name__": "replayed"})
    checked(kind, expected)
print("passed")
