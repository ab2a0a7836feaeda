# SPDX-License-Identifier: BSD-3-Clause
"""What each process has of every filter's outputs, for TestPieces.py.

Run as `mpirun -np N pvbatch --symmetric pieces.py PLUGIN FOLDER SOURCE [FILTER...]`. SOURCE is a CAD
or XML file, a shape (a number of vtkNURBSShapeSource, or "car"), "group" (two shapes as blocks), or
"saved" (what all processes write and read again). Writes FOLDER/rank-R.json: of each output
the digests of its cells, each of the coordinates and all arrays of the cell and its points; of
triangle meshes the digests of their sides; and the figures that the filters tell.
"""
import hashlib
import json
import os
import sys

from paraview import simple
import vtknurbs  # for the methods of our classes
from session import FILTERS, SCREW, leaves, load_plugin, path, updated
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDataArray, vtkIdList, vtkStringArray
from vtkmodules.vtkParallelCore import vtkMultiProcessController

SOURCE = sys.argv[3]
FIGURES = ("CertifiedError", "ToleranceUsed", "VisibleArea", "ErrorBound", "NumberOfMovedPoints")


def columns(attributes):
    """Bytes of every tuple of every named array, by name."""
    out = []
    arrays = [attributes.GetAbstractArray(k) for k in range(attributes.GetNumberOfArrays())]
    for array in sorted(arrays, key=lambda a: a.GetName()):
        if isinstance(array, vtkDataArray):
            values = vtk_to_numpy(array)
            out.append([values[k].tobytes() for k in range(array.GetNumberOfTuples())])
        elif isinstance(array, vtkStringArray):
            out.append([array.GetValue(k).encode() for k in range(array.GetNumberOfValues())])
    return out


def name_columns(attributes):
    return sorted(attributes.GetArrayName(k) for k in range(attributes.GetNumberOfArrays()))


# Where a model's surfaces and edges are in the arrays of a piece, not what they are.
STARTS = ("KnotStart", "LoopStart")


def cell_digests(data):
    """One digest a cell."""
    for name in STARTS:
        data.GetCellData().RemoveArray(name)
    cells = columns(data.GetCellData())
    points = columns(data.GetPointData())
    if data.GetNumberOfPoints() > 0:
        places = vtk_to_numpy(data.GetPoints().GetData())
        points.insert(0, [places[k].tobytes() for k in range(len(places))])
    out = []
    ids = vtkIdList()
    for cell in range(data.GetNumberOfCells()):
        data.GetCellPoints(cell, ids)
        digest = hashlib.sha1()
        for column in cells:
            digest.update(column[cell])
        for k in range(ids.GetNumberOfIds()):
            for column in points:
                digest.update(column[ids.GetId(k)])
        out.append(digest.hexdigest()[:16])
    return out


def sides(mesh):
    """Directed sides of the triangles, by the coordinates of their ends."""
    out = []
    ids = vtkIdList()
    if mesh.GetNumberOfPolys() == 0:
        return out
    places = vtk_to_numpy(mesh.GetPoints().GetData()) + 0.0
    named = [hashlib.sha1(p.tobytes()).hexdigest()[:12] for p in places]
    for cell in range(mesh.GetNumberOfCells()):
        mesh.GetCellPoints(cell, ids)
        corner = [named[ids.GetId(k)] for k in range(3)]
        out += [corner[k] + corner[(k + 1) % 3] for k in range(3)]
    return out


def source():
    if SOURCE.isdigit():
        return simple.NURBSShapeSource(Shape=int(SOURCE), TubeRadius=0.3)
    if SOURCE == "car":
        return simple.NURBSShapeSource(Shape="Car Body", NumberOfPatches=400)
    if SOURCE == "group":
        shapes = [simple.NURBSShapeSource(Shape=shape) for shape in ("Teapot", "Vase")]
        return simple.GroupDatasets(Input=shapes)
    if SOURCE == "saved":
        name = path("saved.vtpc")
        simple.SaveData(name, proxy=simple.OpenDataFile(SCREW), DataMode="Binary")
        return simple.OpenDataFile(name)
    return simple.OpenDataFile(SOURCE)


def options(name):
    if name == "NURBSFreeFormDeformation":
        return {"LatticeMoves": [1, 1, 1, 0.3, 0.0, 0.3]}
    if name == "NURBSVisibleRegions":
        return {"Direction": [1, 2, 3]}
    if name == "NURBSControlPointEdits":
        return {"Moves": [0, 5, 0.1, 0.0, 0.0]}
    return {}


load_plugin()
controller = vtkMultiProcessController.GetGlobalController()
found = {"cells": {}, "sides": {}, "figures": {}, "arrays": {}}


def note(name, proxy):
    updated(proxy)
    for port in range(proxy.SMProxy.GetNumberOfOutputPorts()):
        label = "%s %d" % (name, port)
        digests = found["cells"].setdefault(label, [])
        for leaf in leaves(proxy, port):
            mesh = leaf.NewInstance()
            mesh.ShallowCopy(leaf)
            digests += cell_digests(mesh)
            if mesh.GetNumberOfCells() > 0:
                found["arrays"][label] = name_columns(mesh.GetCellData())
            if mesh.IsA("vtkPolyData") and port == 0 and mesh.GetNumberOfPolys() > 0:
                found["sides"].setdefault(label, []).extend(sides(mesh))
    for figure in FIGURES:
        if figure in proxy.ListProperties():
            found["figures"][name + " " + figure] = proxy.GetPropertyValue(figure)
    for figure in proxy.ListProperties():
        if figure.startswith("NumberOf") and figure != "NumberOfGhostFaces":
            found["figures"][name + " " + figure] = proxy.GetPropertyValue(figure)


model = source()
note("source", model)
wanted = sys.argv[4:] or FILTERS
for filter_name in wanted:
    note(filter_name, getattr(simple, filter_name)(Input=model, **options(filter_name)))
if not sys.argv[4:]:
    # Chains of filters: what one makes of a piece the next one can use.
    moved = simple.NURBSFreeFormDeformation(Input=model, LatticeMoves=[1, 1, 1, 0.3, 0.0, 0.3])
    note("moved mesh", simple.NURBSTessellator(Input=moved))
    # The lattice that one process has is for all, and edits that come before data wait for all.
    lattice = simple.OutputPort(moved, 1)
    note("moved again", simple.NURBSFreeFormDeformation(Input=model, Lattice=lattice))
    edits = simple.NURBSControlPointEdits(Input=model)
    assert edits.GetClientSideObject().MoveControlPoint(5, 0.1, 0.0, 0.0)
    note("early edits", edits)
    seen = simple.NURBSVisibleRegions(Input=model, Direction=[1, 2, 3])
    note("seen mesh", simple.NURBSTessellator(Input=seen))
with open(path("rank-%d.json" % controller.GetLocalProcessId()), "w") as file:
    json.dump(found, file)
