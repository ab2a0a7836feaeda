# SPDX-License-Identifier: BSD-3-Clause
"""What ParaView's own filters pass on of a model shows as surfaces by itself, other data as ever."""
from paraview import simple
from session import LINKRODS, load_plugin, updated

load_plugin()
view = simple.CreateView("RenderView")
rods = updated(simple.OpenDataFile(LINKRODS))
teapot = simple.NURBSShapeSource()


def shown(proxy):
    """The representation by default; str, as what simple returns compares by its own rules."""
    display = simple.Show(proxy, view)
    simple.Hide(proxy, view)
    return str(display.SMProxy.GetProperty("Representation").GetElement(0))


def calculated(source):
    return simple.Calculator(Input=source, AttributeType="Cell Data", Function="FaceId*2")


def few(source):
    return simple.Threshold(
        Input=source, Scalars=["CELLS", "FaceId"], LowerThreshold=0, UpperThreshold=5
    )


def selected(source):
    simple.QuerySelect("id < 3", "CELL", source)
    return simple.ExtractSelection(Input=source)


MODELS = [few, calculated, selected]
MODELS += [lambda source, name=name: getattr(simple, name)(Input=source) for name in (
    "Transform", "CleantoGrid", "MergeBlocks", "NURBSRefinement",
)]
OTHERS = [lambda source, name=name: getattr(simple, name)(Input=source) for name in (
    "Clip", "Tetrahedralize", "ExtractSurface", "NURBSTessellator", "NURBSToBezierCells",
    "NURBSControlNet",
)]
for source in (rods, teapot):
    for make in MODELS + OTHERS:
        made = updated(make(source))
        name, got = made.GetXMLName(), shown(made)
        assert made.GetDataInformation().GetNumberOfCells() > 0, name
        assert got == ("NURBS Surface" if make in MODELS else "Surface"), (name, got)
        print("%-22s %s" % (name, got))
group = simple.GroupDatasets(Input=[teapot, few(teapot)], BlockNames=["whole", "part"])
assert shown(group) == "NURBS Surface"
block = updated(simple.ExtractBlock(Input=group, Selectors=["/Root/part"]))
assert block.GetDataInformation().GetNumberOfCells() == 6
assert shown(block) == "NURBS Surface"
assert shown(simple.GroupDatasets(Input=[teapot, simple.Sphere()])) == "Surface"
# A threshold that leaves nothing, and data that never were a model.
nothing = few(teapot)
nothing.LowerThreshold, nothing.UpperThreshold = 1000, 2000
assert shown(nothing) == "Surface"
wavelet = simple.Wavelet()
assert shown(wavelet) == "Outline"
assert shown(simple.Tetrahedralize(Input=wavelet)) == "Surface"
assert shown(simple.Sphere()) == "Surface"

# Lines on surfaces show black, surfaces in their own colour.
regions = simple.NURBSVisibleRegions(Input=teapot)
for proxy, width in (
    (simple.NURBSSilhouette(Input=teapot), 2.0),
    (simple.OutputPort(regions, 1), 2.0),
    (simple.OutputPort(regions, 0), None),
):
    updated(proxy)
    display = simple.Show(proxy, view)
    black = list(display.DiffuseColor) == list(display.AmbientColor) == [0.0, 0.0, 0.0]
    assert black == (width is not None), (proxy, list(display.DiffuseColor))
    assert width is None or display.LineWidth == width
print("passed")
