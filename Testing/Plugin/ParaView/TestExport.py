# SPDX-License-Identifier: BSD-3-Clause
"""File > Save Data writes models as STEP, IGES and BREP files, and what is no model gives an error."""
import os

from paraview import servermanager, simple
from session import SCREW, Messages, load_plugin, path, size, updated

load_plugin()
reader = updated(simple.NURBSCADReader(FileName=SCREW))
regions = simple.NURBSVisibleRegions(Input=reader)
updated(regions)

factory = servermanager.vtkSMProxyManager.GetProxyManager().GetWriterFactory()
offered = factory.GetSupportedFileTypes(reader.SMProxy, 0)
for kind, endings in (("STEP", "*.step *.stp"), ("IGES", "*.iges *.igs"), ("BREP", "*.brep *.brp")):
    assert "%s files (exact surfaces)(%s )" % (kind, endings) in offered.split(";;"), offered

for source in (reader, regions):
    for name in ("model.step", "model.stp", "model.iges", "model.igs", "model.brep", "model.brp"):
        file = path(name)
        if os.path.exists(file):
            os.remove(file)
        simple.SaveData(file, proxy=source)
        again = updated(simple.NURBSCADReader(FileName=file))
        assert size(again)[0] >= size(source)[0] > 0, (name, size(again), size(source))
        simple.Delete(again)
    print("faces:", size(source)[0])

tree = updated(simple.NURBSCADReader(FileName=path("model.step"))).GetClientSideObject().GetOutput()
assert tree.GetDataAssembly() is not None

grid = simple.AppendDatasets(Input=simple.Sphere())
with Messages() as messages:
    simple.SaveData(path("none.step"), proxy=grid)
assert "not a NURBS model" in messages.text, messages.text
assert not os.path.exists(path("none.step"))
print("passed")
