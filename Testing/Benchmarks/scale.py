#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How cost grows: with the number of faces (car-like sets of trimmed patches), with the tolerance,
and what a second thread brings, on many faces and on a single one."""

import os
import sys

import bench

CAR_SIZES = (1000, 8036, 31040)
TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5)
WANTED = ("terrain.brep", "MAT.brep", "Bottom.brep", "odrive", "bowden")


def shape(name):
    return ["--shape", name]


def name_of(what):
    return os.path.basename(what[-1])


def measured(report, inputs, limit, *options):
    """(input, result) of every input that has one; the others are reported."""
    for what in inputs:
        command = [bench.program("TessellationBenchmark"), *what, "--relative", *options]
        result = bench.run_json(command, limit)
        if "error" in result:
            report.text(f"- {name_of(what)}: {result['error']}")
        else:
            yield what, result


def faces(report, limit):
    report.text("## Faces: car-like sets at 1e-4 of the diagonal, guaranteed")
    inputs = [shape(f"car:{size}") for size in CAR_SIZES]
    rows = []
    for _, done in measured(report, inputs, limit, "1e-4", "--threads", "1", "2"):
        one, two = done["meshes"]
        count = done["faces"]
        rows.append([
            f"{count:,}", done["control_points"], done["read"], one["triangles"], one["seconds"],
            1e6 * one["seconds"] / count, 1e6 * one["seconds"] / one["triangles"], two["seconds"],
            one["seconds"] / two["seconds"], done["memory"] / 2**20,
            (done["memory"] - done["memory_start"]) / count / 2**10,
        ])  # fmt: skip
    report.table(
        ["faces", "control points", "made, s", "triangles", "one thread, s", "us a face",
         "us a triangle", "two threads, s", "speed-up", "peak MiB", "KiB a face"],
        rows,
    )  # fmt: skip


def tolerances(report, files, limit):
    report.text("## Tolerance: guaranteed, one thread")
    report.text(
        "A tenth of the tolerance asks for ten times the triangles of a surface that bends both "
        "ways, and for sqrt(10) times those of a cylinder or along an edge."
    )
    rows = []
    inputs = [shape("car:1000"), shape("sheet:40"), *files]
    options = [*(str(t) for t in TOLERANCES), "--threads", "1", "--repeat", "1"]
    for what, done in measured(report, inputs, limit, *options):
        meshes = done["meshes"]
        triangles = [m["triangles"] for m in meshes]
        rows.append([
            name_of(what), *triangles, triangles[-1] / triangles[-2],
            *[1e3 * m["seconds"] for m in meshes], " ".join(str(m["capped"]) for m in meshes),
        ])  # fmt: skip
    finest = f"{TOLERANCES[-1]:g} over {TOLERANCES[-2]:g}"
    report.table(
        ["model", *(f"triangles at {t:g}" for t in TOLERANCES), finest,
         *(f"ms at {t:g}" for t in TOLERANCES), "capped faces"],
        rows,
    )  # fmt: skip


def threads(report, files, limit):
    report.text("## Threads at 1e-4 of the diagonal, guaranteed")
    report.text(
        "Processor time of two threads over that of one: 1 where no work is lost. It tells more "
        "than the speed-up on a machine that others use, too."
    )
    rows = []
    inputs = [shape("sheet:100"), shape("car:8036"), *files]
    for what, done in measured(report, inputs, limit, "1e-4", "--threads", "1", "2"):
        one, two = done["meshes"]
        rows.append([
            name_of(what), done["faces"], one["triangles"], 1e3 * one["seconds"],
            1e3 * two["seconds"], one["seconds"] / two["seconds"],
            two["processor_seconds"] / one["processor_seconds"], one["digest"] == two["digest"],
        ])  # fmt: skip
    report.table(
        ["model", "faces", "triangles", "one, ms", "two, ms", "speed-up", "processor time",
         "same mesh"],
        rows,
    )  # fmt: skip


def main():
    options = bench.arguments(__doc__, limit=60)
    report = bench.Report("scale", "How cost grows")
    models = bench.models(options.folders, options.only)
    files = [[f] for f in models if any(w in os.path.basename(f) for w in WANTED)]
    faces(report, options.limit)
    tolerances(report, files, options.limit)
    threads(report, files, options.limit)
    return report.save()


if __name__ == "__main__":
    sys.exit(main())
