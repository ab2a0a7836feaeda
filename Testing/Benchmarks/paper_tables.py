#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tables 2, 3 and 4 of Balazs, Guthe and Klein, "Efficient trimmed NURBS tessellation" (2004), on
public models, the paper's figures beside ours. Documentation/Papers/balazs-2004-tables.md explains
what is compared; --page FILE pastes the tables into it."""

import os
import sys

import bench

RELATIVE = 5e-5  # 0.2 mm, the paper's tolerance, on a car of 4 m
PUBLIC = (
    "bowden", "car_wheel", "d150", "gpucast", "impeller", "linkrods", "nist", "odrive", "trj7",
    "Bottom", "CrankArm.brep", "Motor-c", "Propeller", "terrain", "Top.brep",
)  # fmt: skip
CARS = ("car:8036", "car:31040")
FIGURES = {"processor_seconds": "s", "triangles": "triangles", "edges": "edges"}
METHODS = ("quadtree", "binary", "kd-tree")
ERRORS = ("guaranteed", "estimated")

OLD_CURVES = ("--curve-subdivision", "midpoint", "--curve-measure", "point", "--no-simplify",
              "--no-balance")  # fmt: skip
PAPER_CURVES = ("--curve-subdivision", "midpoint", "--curve-measure", "line", "--no-balance")


def surface(method, error, curves=PAPER_CURVES):
    return ("--method", method, "--error", error, *curves)


OLD = surface("quadtree", "guaranteed", OLD_CURVES)
NEW = surface("kd-tree", "estimated")
# Table 4's columns. The first to exceed the limit leaves its model out: slow ones come first.
PIPELINES = {
    "quadtree": OLD,
    "paper's": NEW,
    "ours, estimated": surface("kd-tree", "estimated", ()),
    "ours, guaranteed": surface("kd-tree", "guaranteed", ()),
}
TABLE_3 = {(m, e): surface(m, e) for m in METHODS for e in ERRORS}

# Method of TrimCurveMethods.h: the paper's conversion s, approximation s and edges (its Table 2).
PAPER_2 = {
    "2D": (1.2, 77.3, 824791),
    "midpoint point": (23.9, 4.4, 178475),
    "midpoint line": (23.9, 4.4, 170484),
    "midpoint line simplified": (23.9, 5.9, 151234),
    "arbitrary point": (23.9, 4.5, 181280),
    "arbitrary line": (23.9, 4.6, 172925),
    "arbitrary line simplified": (23.9, 6.2, 153680),
    "balanced": (None, None, None),
}
# Seconds (with its coherent evaluation) and triangles (its Table 3).
PAPER_3 = {
    ("quadtree", "guaranteed"): (175.2, 1511056),
    ("quadtree", "estimated"): (184.6, 1008457),
    ("kd-tree", "guaranteed"): (96.9, 796438),
    ("kd-tree", "estimated"): (97.3, 464354),
}
# The quadtree method and the paper's (its Table 4).
PAPER_4 = {
    "paper: Golf": {
        "processor_seconds": (348.3, 97.3),
        "triangles": (2058739, 464354),
        "edges": (824791, 151234),
    },
    "paper: ventilation console": {
        "processor_seconds": (64.9, 11.6),
        "triangles": (562949, 29113),
        "edges": (562434, 34054),
    },
    "paper: Beetle": {
        "processor_seconds": (547.3, 152.9),
        "triangles": (3153954, 593652),
        "edges": (2888198, 385767),
    },
}


def ratio(a, b):
    return a / b if a is not None and b else None


def tessellate(model, options, limit):
    what = ["--shape", model] if model in CARS else [model]
    command = [bench.program("TessellationBenchmark"), *what, "--relative", str(RELATIVE)]
    command += ["--threads", "1", "--repeat", "1", *options]
    return bench.run_json(command + (["--curves"] if options == NEW else []), limit)


def measure(model, limit):
    """Options to results, or a string: why the model is left out of all tables."""
    results = {}
    wanted = list(PIPELINES.values()) + ([] if model == CARS[1] else list(TABLE_3.values()))
    for options in dict.fromkeys(wanted):
        result = tessellate(model, options, limit)
        if "error" in result:
            return f"{result['error']}: {' '.join(options)}"
        results[options] = result
    return results


def mesh(results, options):
    return results[options]["meshes"][0]


def curves(report, measured):
    report.text("## Table 2: trim curves to polylines, totals of all models")
    tables = {model: results[NEW]["curves"] for model, results in measured.items()}
    totals = {}
    for method in PAPER_2:
        ours = [table["methods"][method] for table in tables.values()]
        figures = ("conversion", "approximation", "edges")
        totals[method] = [sum(m[figure] for m in ours) for figure in figures]
    base, paper_base = totals["midpoint point"][2], PAPER_2["midpoint point"][2]
    rows = [[method, *totals[method], ratio(totals[method][2], base), *paper,
             ratio(paper[2], paper_base)] for method, paper in PAPER_2.items()]  # fmt: skip
    report.table(
        ["method", "conversion s", "approx. s", "edges", "over midpoint point",
         "paper: conversion s", "approx. s", "edges", "over midpoint point"],
        rows,
    )  # fmt: skip
    report.text("Edges of each model:")
    report.table(
        ["model", "faces", "trim curves", *PAPER_2],
        [[model, measured[model][NEW]["faces"], table["curves"]]
         + [table["methods"][method]["edges"] for method in PAPER_2]
         for model, table in tables.items()],
    )  # fmt: skip
    for model, table in tables.items():
        if table["failed"]:
            report.text(f"- {model}: {table['failed']} trim curves cannot be lifted")


def surfaces(report, measured):
    report.text("## Table 3: surface methods, totals of all models")
    totals = {}
    for key, options in TABLE_3.items():
        meshes = [mesh(results, options) for results in measured.values()]
        figures = ("processor_seconds", "triangles", "capped")
        totals[key] = [sum(m[figure] for m in meshes) for figure in figures]
    rows = []
    for (method, error), (seconds, triangles, capped) in totals.items():
        best = totals["kd-tree", error]
        paper = PAPER_3.get((method, error), (None, None))
        paper_best = PAPER_3["kd-tree", error]
        rows.append([
            f"{method}, {error}", seconds, triangles, capped, ratio(seconds, best[0]),
            ratio(triangles, best[1]), *paper, ratio(paper[0], paper_best[0]),
            ratio(paper[1], paper_best[1]),
        ])  # fmt: skip
    report.table(
        ["method", "s", "triangles", "capped faces", "s over kd-tree", "triangles over kd-tree",
         "paper: s", "triangles", "s over kd-tree", "triangles over kd-tree"],
        rows,
    )  # fmt: skip
    report.text("Triangles of each model:")
    report.table(
        ["model", "faces", *(", ".join(key) for key in TABLE_3)],
        [[model, results[NEW]["faces"]]
         + [mesh(results, options)["triangles"] for options in TABLE_3.values()]
         for model, results in measured.items()],
    )  # fmt: skip


def whole(report, measured):
    report.text("## Table 4: the whole, beside the quadtree method")
    for figure in FIGURES:
        rows = []
        for model, results in measured.items():
            ours = [mesh(results, options)[figure] for options in PIPELINES.values()]
            rows.append([model, *ours])
        rows.append(["all", *(sum(column) for column in list(zip(*rows))[1:])])
        rows += [[name, *figures[figure], None, None] for name, figures in PAPER_4.items()]
        rows = [row + [ratio(row[1], other) for other in row[2:]] for row in rows]
        over = [f"quadtree over {name}" for name in list(PIPELINES)[1:]]
        report.table([FIGURES[figure], *PIPELINES, *over], rows)


def main():
    options = bench.arguments(
        __doc__, limit=30, page=("", "a page whose end is replaced by the tables")
    )
    files = bench.models(options.folders, options.only)
    models = [f for f in files if any(p in os.path.basename(f) for p in PUBLIC)] + list(CARS)
    report = bench.Report("paper-tables", "Tables 2, 3 and 4 of Balazs et al. on public models")
    report.text(
        f"Tolerance {RELATIVE:g} of the diagonal, one thread, one run; s is processor time."
    )
    measured = {}
    for model in models:
        print(f"... {os.path.basename(model)}", file=sys.stderr, flush=True)
        results = measure(model, options.limit)
        if isinstance(results, str):
            report.text(f"- {os.path.basename(model)} is left out: {results}")
        else:
            measured[os.path.basename(model)] = results
    small = {model: results for model, results in measured.items() if model != CARS[1]}
    if small:
        curves(report, small)
        surfaces(report, small)
        whole(report, measured)
    status = report.save()
    if options.page:
        report.paste(options.page)
    return status


if __name__ == "__main__":
    sys.exit(main())
