# SPDX-License-Identifier: BSD-3-Clause
"""Files that are missing, garbage or cut, inputs that are no models: an error, and life goes on."""
from paraview import simple
from session import LINKRODS, Messages, leaves, load_plugin, path, size, updated

load_plugin()
garbage = path("garbage.step")
with open(garbage, "wb") as file:
    file.write(bytes(range(256)) * 16)
cut = path("cut.step")
with open(LINKRODS, "rb") as whole, open(cut, "wb") as file:
    file.write(whole.read(20000))

for name in (path("missing.step"), garbage, cut, ""):
    reader = simple.NURBSCADReader(FileName=name)
    tessellator = simple.NURBSTessellator(Input=reader)
    with Messages() as messages:
        reader.UpdatePipeline()
        tessellator.UpdatePipeline()
    assert "ERR" in messages.text and "vtkNURBSCADReader" in messages.text, (name, messages.text)
    assert size(reader)[0] == 0 and size(tessellator)[0] == 0, name
    print(messages.text.strip().splitlines()[-1][:160])
    # The same proxies recover.
    reader.FileName = LINKRODS
    assert size(updated(tessellator))[0] == 3096, name
    simple.Delete(tessellator)
    simple.Delete(reader)

try:
    missing = simple.OpenDataFile(path("missing.step"))
except RuntimeError as error:
    missing = None
    print("OpenDataFile:", error)
assert missing is None

# An unstructured grid that is no model.
grid = simple.AppendDatasets(Input=simple.Sphere())
for name in ("NURBSTessellator", "NURBSWaveletLOD", "NURBSSilhouette", "NURBSDeformingTessellator"):
    made = getattr(simple, name)(Input=grid)
    with Messages() as messages:
        made.UpdatePipeline()
    assert "ERR" in messages.text, (name, messages.text)
    assert sum(leaf.GetNumberOfCells() for leaf in leaves(made)) == 0, name

# Rows of tables that make no sense are named.
teapot = simple.NURBSShapeSource()
edits = simple.NURBSControlPointEdits(Input=teapot, Moves=[0, 100000, 1, 0, 0, 0, 69, 1, 0, 0])
with Messages() as messages:
    updated(edits)
assert "100000" in messages.text, messages.text
assert edits.NumberOfEdits > 0
lattice = simple.NURBSFreeFormDeformation(Input=teapot, LatticeMoves=[4, 0, 0, 1, 0, 0])
with Messages() as messages:
    updated(lattice)
assert "(4, 0, 0)" in messages.text, messages.text
assert lattice.NumberOfMovedPoints == 0
print("passed")
