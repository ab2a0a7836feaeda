#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Visible regions: with and without clustering on the paper's three models and on the files given
(table 2 of Ruan, Zhang and Yong), cost against the number of faces, and from precision 1e-2 to 1e-8.
One thread; processor time, of which three directions are added up."""

import os
import sys

import bench

PAPER = {"vase": 3.2, "missile": 2.2, "spring": 1.0}  # Gains by clustering in table 2.
REAL = ("CrankArm.brep", "Motor-c.brep", "hammer.iges", "bearing.iges", "linkrods.step")
PRECISIONS = ("1e-2", "1e-3", "1e-4", "1e-5", "1e-6", "1e-7", "1e-8")
CARS = (1000, 2000, 4000, 8036)


def measure(what, options, *more):
    """The runs, or a list of one with what went wrong."""
    command = [bench.program("VisibilityBenchmark"), *what, *more]
    done = bench.run_json(command, options.limit)
    return done.get("runs", []), done.get("error")


def total(runs, key, **wanted):
    """Sum over directions of the runs that have these values."""
    found = [r[key] for r in runs if all(r[k] == v for k, v in wanted.items())]
    return sum(found) if found else None


def name_of(what):
    return os.path.basename(what[-1])


def clustering(report, inputs, options):
    report.text("## With and without clustering, at 1e-4 of the diagonal")
    rows = []
    for what in inputs:
        more = ["--clustering", "on", "off", "--repeat", "3"]
        runs, problem = measure(what, options, *more)
        on, off = (total(runs, "processor_seconds", clustering=c) for c in ("on", "off"))
        areas = [total(runs, "visible_area", clustering=c) for c in ("on", "off")]
        same = abs(areas[0] / areas[1] - 1.0) if runs and areas[1] else None
        rows.append([
            name_of(what), runs[0]["faces"] if runs else None, off or problem, on,
            off / on if on else None, PAPER.get(name_of(what)), same,
        ])  # fmt: skip
    report.table(["model", "faces", "without, s", "with, s", "gain", "paper's gain",
                  "areas differ by"], rows)  # fmt: skip


def faces(report, files, options):
    report.text("## Cost against the number of faces, at 1e-4 of the diagonal")
    rows = []
    for what in files + [["--shape", "car", "--patches", str(n)] for n in CARS]:
        runs, problem = measure(what, options)
        name = "car body" if what[0] == "--shape" else name_of(what)
        if not runs or problem:
            rows.append([name] + [None] * 6 + [problem])
            continue
        seconds = total(runs, "processor_seconds")
        count = runs[0]["faces"]
        rows.append([
            name, count, *(r["processor_seconds"] for r in runs),
            1e3 * seconds / len(runs) / count, max(r["cells"] for r in runs),
            f"{runs[0]['failed']} faces failed" if runs[0]["failed"] else "",
        ])  # fmt: skip
    rows.sort(key=lambda row: (row[1] or 0, row[0]))
    report.table(["model", "faces", "1,1,1: s", "0,0,1: s", "0.3,-0.9,0.2: s", "ms a face",
                  "cells of the map at most", ""], rows)  # fmt: skip


def precisions(report, inputs, options):
    report.text("## Precision from 1e-2 to 1e-8 of the diagonal, direction 1,1,1")
    rows = []
    for what in inputs:
        for precision in PRECISIONS:
            more = ["--view", "1,1,1", "--precision", precision]
            runs, problem = measure(what, options, *more)
            if runs:
                run = runs[0]
                rows.append([
                    name_of(what), precision, run["processor_seconds"], run["points"],
                    run["cells"], f"{run['visible_area']:.9g}", "",
                ])  # fmt: skip
            else:
                rows.append([name_of(what), precision] + [None] * 4 + [problem])
    report.table(["model", "precision", "s", "points of the drawing", "cells of the map",
                  "visible area", ""], rows)  # fmt: skip


def main():
    options = bench.arguments(
        __doc__,
        limit=120,
        parts=("clustering,faces,precision", "what is measured"),
        page=("", "a page whose end is replaced by the tables"),
    )
    report = bench.Report("visibility", "Visible regions")
    files = [[f] for f in bench.models(options.folders, options.only)]
    shapes = [["--shape", name] for name in PAPER]
    real = [f for f in files if name_of(f) in REAL]
    if "clustering" in options.parts:
        clustering(report, shapes + real, options)
    if "faces" in options.parts:
        faces(report, files, options)
    if "precision" in options.parts:
        precisions(report, shapes + real[:2], options)
    status = report.save()
    if options.page:
        report.paste(options.page)
    return status


if __name__ == "__main__":
    sys.exit(main())
