# SPDX-License-Identifier: BSD-3-Clause
"""What fails in one process only, and what all of them say; for TestPieceFailures.py.

Run as `mpirun -np N pvbatch --symmetric pieceFailures.py PLUGIN FOLDER`. The last process is the one
that fails. Writes FOLDER/rank-R.json: what was said in each case, and the cells that came out.
"""
import json

from paraview import simple
from session import FILTERS, LINKRODS, SCREW, Messages, leaves, load_plugin, path
from vtkmodules.vtkParallelCore import vtkMultiProcessController

load_plugin()
controller = vtkMultiProcessController.GetGlobalController()
rank = controller.GetLocalProcessId()
fails = rank == controller.GetNumberOfProcesses() - 1
found = {}


def note(name, proxy):
    with Messages() as messages:
        proxy.UpdatePipeline()
    said = [line for line in messages.text.splitlines() if line and not line.startswith("ERROR: In")]
    cells = 0  # sum is numpy's, once a script of a Programmable Filter ran
    for leaf in leaves(proxy):
        cells += leaf.GetNumberOfCells() if leaf else 0
    found[name] = {"said": "\n".join(said), "cells": cells}
    print("process %d: %s" % (rank, name), flush=True)
    return proxy


def changed(source, script):
    """A model that only the last process has changed, by a script of a Programmable Filter."""
    text = "output = self.GetOutputDataObject(0)\noutput.ShallowCopy(self.GetInputDataObject(0, 0))\n"
    text += "import vtk\nimport numpy\nfrom vtk.util.numpy_support import vtk_to_numpy\n"
    return simple.ProgrammableFilter(
        Input=source, OutputDataSetType="Same as Input", Script=text + (script if fails else "")
    )


def first_array(name, field, change):
    """Changes a copy of an array; `array` is its values as numpy sees them."""
    return (
        "data = output.Get%sData()\ncopy = data.GetArray('%s').NewInstance()\n"
        "copy.DeepCopy(data.GetArray('%s'))\narray = vtk_to_numpy(copy)\n%s\ndata.AddArray(copy)\n"
    ) % (field, name, name, change)


# A file that one process does not have, or has another version of.
missing = simple.NURBSCADReader(FileName=path("missing.step") if fails else SCREW)
note("missing", missing)
note("mesh of missing", simple.NURBSTessellator(Input=missing))
note("other file", simple.NURBSCADReader(FileName=LINKRODS if fails else SCREW))

# Arrays that are broken in one piece: of some face, or of all.
car = simple.NURBSShapeSource(Shape="Car Body", NumberOfPatches=24)
broken = {
    "bad face": first_array("Degree", "Cell", "array[0] = 99"),
    "bad knots": first_array("Knots", "Field", "array[:] = array[::-1].copy()"),
    "bad starts": first_array("KnotStart", "Cell", "array[:] = 2**40"),
    "bad loops": first_array("LoopStart", "Cell", "array[:] = -5"),
    "no points": "output.SetPoints(vtk.vtkPoints())\n",
    "no model": "output.GetCellData().RemoveArray('Degree')\n",
}
for what, script in broken.items():
    model = changed(car, script)
    for name in FILTERS if what in ("bad face", "no model") else ("NURBSTessellator", "NURBSSilhouette"):
        note("%s, %s" % (what, name), getattr(simple, name)(Input=model))

# A source that fails in one process, which so does not call the filter behind it.
def lacking():
    return simple.NURBSShapeSource(Shape="Plate", PlateHoles=[-1 if fails else 4, 3])


for name in FILTERS:
    note("no input, " + name, getattr(simple, name)(Input=lacking()))
chain = simple.NURBSRefinement(Input=simple.Transform(Input=lacking()))
chain = simple.NURBSTessellator(Input=chain)
note("no input, far", chain)
note("nothing, again", chain)
chain.Tolerance = 1e-4
note("nothing, once more", chain)

# A failure between two exchanges, and an end between them.
wrong = dict(ToleranceMode="A length", AbsoluteTolerance=-1.0 if fails else 0.01)
note("exception", simple.NURBSTessellator(Input=car, **wrong))
note("exception, deforming", simple.NURBSDeformingTessellator(Input=car, **wrong))
for name in ("NURBSTessellator", "NURBSWaveletLOD", "NURBSVisibleRegions", "NURBSRefinement"):
    aborted = getattr(simple, name)(Input=car)
    filter_object = aborted.GetClientSideObject()
    if fails:
        filter_object.AddObserver("ProgressEvent", lambda who, _: who.SetAbortExecute(1))
    note("aborted, " + name, aborted)

# All goes on as ever.
for name in FILTERS:
    note("sound, " + name, getattr(simple, name)(Input=car))
with open(path("rank-%d.json" % rank), "w") as file:
    json.dump(found, file)
