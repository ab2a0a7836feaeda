#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How cost grows: with the number of faces (car-like sets of trimmed patches), with the tolerance,
and what a second thread brings, on many faces and on a single one."""

import bench

CAR_SIZES = (1000, 8036, 31040)
TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5)
SHEET = "sheet:300"


def run(what, *options, limit=600):
    return bench.run_json([bench.program("TessellationBenchmark"), *what, *options], limit)


def faces(report, limit):
    report.text("## Faces: car-like sets at 1e-4 of the diagonal, guaranteed")
    rows = []
    for size in CAR_SIZES:
        done = run(
            ["--shape", f"car:{size}"], "--relative", "1e-4", "--threads", "1", "2",
            "--repeat", "1", limit=limit,
        )  # fmt: skip
        if "error" in done:
            report.text(f"- {size} faces: {done['error']}")
            continue
        one, two = done["meshes"]
        rows.append([
            str(done["faces"]), done["control_points"], done["read"], one["seconds"],
            1e6 * one["seconds"] / done["faces"], two["seconds"], one["seconds"] / two["seconds"],
            one["triangles"], done["memory"] / 2**20,
            (done["memory"] - done["memory_start"]) / one["triangles"],
        ])  # fmt: skip
    report.table(
        ["faces", "control points", "made s", "one thread s", "us a face", "two threads s",
         "speed-up", "triangles", "peak MiB", "bytes a triangle"],
        rows,
    )  # fmt: skip


def tolerances(report, files, limit):
    report.text("## Tolerance: triangles times tolerance, guaranteed, one thread")
    rows = []
    for what in [["--shape", "car:1000"], ["--shape", SHEET]] + [[f] for f in files]:
        done = run(
            what, "--relative", *[str(t) for t in TOLERANCES], "--threads", "1", "--repeat", "1",
            limit=limit,
        )  # fmt: skip
        if "error" in done:
            report.text(f"- {what[-1]}: {done['error']}")
            continue
        row = [what[-1].rsplit("/", 1)[-1]]
        for mesh in done["meshes"]:
            row += [mesh["triangles"], mesh["triangles"] * mesh["relative"]]
        rows.append(row + [1e3 * m["seconds"] for m in done["meshes"]])
    header = ["model"]
    for t in TOLERANCES:
        header += [f"triangles at {t:g}", "times tol"]
    report.table(header + [f"ms at {t:g}" for t in TOLERANCES], rows)


def threads(report, files, limit):
    report.text("## Threads at 1e-4 of the diagonal, guaranteed")
    rows = []
    for what in [["--shape", SHEET], ["--shape", "car:8036"]] + [[f] for f in files]:
        done = run(
            what, "--relative", "1e-4", "--threads", "1", "2", "--repeat", "3", limit=limit
        )
        if "error" in done:
            report.text(f"- {what[-1]}: {done['error']}")
            continue
        one, two = done["meshes"]
        same = one["digest"] == two["digest"]
        rows.append([
            what[-1].rsplit("/", 1)[-1], done["faces"], one["triangles"], 1e3 * one["seconds"],
            1e3 * two["seconds"], one["seconds"] / two["seconds"], same,
        ])  # fmt: skip
    report.table(
        ["model", "faces", "triangles", "one ms", "two ms", "speed-up", "same mesh"], rows
    )


def main():
    options = bench.arguments(__doc__)
    report = bench.Report("scale", "How cost grows")
    wanted = ("terrain.brep", "MAT.brep", "Bottom.brep", "odrive", "bowden")
    files = [f for f in bench.models(options.folders, options.only) if any(w in f for w in wanted)]
    faces(report, options.limit)
    tolerances(report, files, options.limit)
    threads(report, files, options.limit)
    report.save()


if __name__ == "__main__":
    main()
