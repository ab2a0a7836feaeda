#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Levels of detail of CAD files by vtkNURBSWaveletLOD: where meshes are open at each level, with
each wavelet, at mixed levels (budgets and maximum errors), and what changing the level takes.

Solids are the files whose mesh by vtkNURBSTessellator has no open edge. Run it with the Python that
VTK was built for, and PYTHONPATH at the build's lib/python3/dist-packages."""

import os
import statistics

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkObject

import bench
import vtknurbs

WAVELETS = ("interpolating", "lifted", "haar")


def leaves(data):
    if data.IsA("vtkPolyData"):
        return [data]
    found = []
    iterator = data.NewIterator()
    iterator.InitTraversal()
    while not iterator.IsDoneWithTraversal():
        found.append(iterator.GetCurrentDataObject())
        iterator.GoToNextItem()
    return found


def open_edges(data):
    """Edges of one triangle, by the positions of their ends, of all models together."""
    count = 0
    for mesh in leaves(data):
        if mesh.GetNumberOfPolys() == 0:
            continue
        points = vtk_to_numpy(mesh.GetPoints().GetData()) + 0.0
        _, place = numpy.unique(points, axis=0, return_inverse=True)
        corners = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        corners = place.reshape(-1)[corners]
        sides = [corners[:, [k, (k + 1) % 3]] for k in range(3)]
        edges = numpy.sort(numpy.concatenate(sides), axis=1)
        _, times = numpy.unique(edges, axis=0, return_counts=True)
        count += int((times == 1).sum())
    return count


def measure(file):
    reader = vtknurbs.vtkNURBSCADReader()
    reader.SetFileName(file)
    tessellator = vtknurbs.vtkNURBSTessellator()
    tessellator.SetInputConnection(reader.GetOutputPort())
    tessellator.Update()
    if tessellator.GetNumberOfTriangles() == 0:
        return None
    tessellated = tessellator.GetNumberOfTriangles()
    out = {"solid": open_edges(tessellator.GetOutputDataObject(0)) == 0, "wavelets": {}}
    levels = vtknurbs.vtkNURBSWaveletLOD()
    levels.SetInputConnection(reader.GetOutputPort())
    for wavelet, name in enumerate(WAVELETS):
        levels.SetWavelet(wavelet)
        levels.SetModeToLevel()
        levels.SetLevel(0)
        levels.Update()
        result = {
            "analyse": levels.GetAnalyseSeconds(),
            "triangles": levels.GetNumberOfTriangles(),
            "levels": levels.GetNumberOfLevels(),
            "open": 0,
            "mixed": 0,
            "failed": 0,
            "repaired": 0,
            "seconds": [],
        }

        def look(key):
            levels.Update()
            result[key] += open_edges(levels.GetOutputDataObject(0))
            result["failed"] = max(result["failed"], levels.GetNumberOfFailedFaces())
            result["repaired"] = max(result["repaired"], levels.GetNumberOfRepairedFaces())
            result["seconds"].append(levels.GetMeshSeconds())

        for level in range(levels.GetNumberOfLevels()):
            levels.SetLevel(level)
            look("open")
        levels.SetModeToMaximumError()
        for error in (1e-3, 1e-2):
            levels.SetMaximumError(error)
            look("mixed")
            if error == 1e-3:
                result["share"] = levels.GetNumberOfTriangles() / tessellated
                result["capped"] = levels.GetNumberOfCappedFaces()
        levels.SetModeToTriangleBudget()
        levels.SetTriangleBudget(max(1, result["triangles"] // 5))
        look("mixed")
        out["wavelets"][name] = result
    return out


def main():
    options = bench.arguments(__doc__)
    vtkObject.GlobalWarningDisplayOff()
    totals = {name: {"open": 0, "mixed": 0, "failed": 0, "repaired": 0} for name in WAVELETS}
    solids = files = levels = 0
    coarsest = []
    capped = dict.fromkeys(WAVELETS, 0)
    shares = {name: [] for name in WAVELETS}
    print("| file | solid | levels | triangles | analysis, s | open edges at levels, mixed ones |")
    print("|---|---|--:|--:|--:|---|")
    for file in bench.models(options.folders, options.only):
        done = measure(file)
        if not done:
            continue
        files += 1
        solids += done["solid"]
        first = done["wavelets"]["interpolating"]
        levels += first["levels"]
        for name, result in done["wavelets"].items():
            for key in totals[name]:
                if done["solid"] or key in ("failed", "repaired"):
                    totals[name][key] += result[key]
        coarsest.append(first["seconds"][first["levels"] - 1])
        for name, result in done["wavelets"].items():
            shares[name].append(result["share"])
            capped[name] += result["capped"]
        edges = ", ".join(f"{r['open']} {r['mixed']}" for r in done["wavelets"].values())
        print(
            f"| {os.path.basename(file)} | {'yes' if done['solid'] else 'no'} | {first['levels']}"
            f" | {first['triangles']} | {first['analyse']:.3f} | {edges} |",
            flush=True,
        )
    if not files:
        return
    print(f"\n{files} files, {solids} solids, {levels} levels in all")
    for name in WAVELETS:
        t = totals[name]
        print(
            f"{name}: open edges of solids {t['open']} on all levels, {t['mixed']} at mixed ones;"
            f" faces failed {t['failed']}, with loops that cross {t['repaired']}"
        )
        print(
            f"  maximum error 1e-3: {statistics.median(shares[name]):.1f} times the tessellator's"
            f" triangles (median; {min(shares[name]):.1f} to {max(shares[name]):.1f}),"
            f" {capped[name]} faces capped"
        )
    print(f"median seconds of a change to the coarsest level: {statistics.median(coarsest):.4f}")


if __name__ == "__main__":
    main()
