#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Evaluation by shaders, de Boor's algorithm beside basis functions, and drawing of car bodies by
vtkNURBSMapper beside tessellation at the same pixel error. EGL's first device is taken, and named; of
a GPU, the time of its own work is told beside that of the clock.
"""

import sys

import bench

METHODS = {
    "exact": "mapper, exact",
    "triangles": "mapper, triangles",
    "guaranteed": "tessellator, guaranteed",
    "estimated": "tessellator, estimated",
}
RIVALS = {"basis": "whole net", "basis_local": "local"}


def rates(row, copy, time):
    """The table's line for one surface; time is "seconds", or "device" for the GPU's own work."""
    ours = row["de_boor"]
    rate = ours["vertices"] / ours[time]
    cells = [str(row["degree"]), f"{row['net']}^2", f"{row['output']}^2", ours[time],
             ours["vertices"] / 1e6, rate / 1e6,
             100 * ours["bytes"] / ours[time] / copy]  # fmt: skip
    for key in RIVALS:
        if key in row:
            other = row[key]["vertices"] / row[key][time]
            cells += [row[key][time], other / 1e6, rate / other]
        else:
            cells += [None] * 3
    return cells


def evaluation(report, quick, limit):
    report.text("## Evaluation: rational surfaces, positions and normals")
    if quick:
        runs = [["--nets", "16", "64", "--outputs", "128", "512", "--limit", "1"]]
    else:
        runs = [[], ["--degree", "9", "--nets", "64", "--outputs", "256", "1024"]]
    rows = []
    copy = 0.0
    for options in runs:
        done = bench.run_json([bench.program("ShaderEvaluationBenchmark"), *options], limit)
        if "error" in done:
            report.text(f"- {done['error']}")
            continue
        if not rows:
            copy = done["copy"]
            report.text(
                f"{done['renderer']}. Copying textures writes {done['copy'] / 1e9:.3g} GB/s, "
                f"copying memory by one thread {done['memory_copy'] / 1e9:.3g} GB/s."
            )
        rows += done["rows"]
    rivals = [
        f"{name}: {figure}"
        for name in RIVALS.values()
        for figure in ("s", "M vertices/s", "de Boor over it")
    ]
    header = ["degree", "control points", "output", "de Boor: s", "M vertices", "M vertices/s",
              "% of copying", *rivals]  # fmt: skip
    report.table(header, [rates(row, copy, "seconds") for row in rows])
    if rows and rows[0]["de_boor"]["device"] > 0.0:
        report.text("The same by the time of the GPU's own work (timer queries):")
        report.table(header, [rates(row, copy, "device") for row in rows])


def drawing(report, sizes, limit):
    report.text("## Drawing: car bodies, 800 x 600 pixels, half a pixel")
    rows = []
    renderer = None
    for size in sizes:
        for method, name in METHODS.items():
            print(f"... {size} faces, {name}", file=sys.stderr, flush=True)
            command = [bench.program("DrawingBenchmark"), "--patches", str(size)]
            done = bench.run_json([*command, "--method", method], limit)
            if "error" in done:
                report.text(f"- {size} faces, {name}: {done['error']}")
                continue
            renderer = done["renderer"]
            row = [f"{done['faces']:,}", name, done["first"]["triangles"], done["first"]["seconds"],
                   done["first"]["bytes"] / 1e6, 1.0 / done["still"]["seconds"]]  # fmt: skip
            for kind in ("zooming", "moving"):
                row += [1.0 / done[kind]["seconds"], done[kind]["bytes"] / 1e6]
            row.append((done["memory"] - done["memory_start"]) / 2**20)
            if done["still"]["device"] > 0.0:
                row += [1e3 * done[kind]["device"] for kind in ("still", "zooming", "moving")]
            rows.append(row)
    report.text(f"{renderer}.")
    header = ["faces", "drawn by", "triangles", "first picture, s", "MB sent", "still, frames/s",
              "zooming, frames/s", "MB a frame", "moving, frames/s", "MB a frame",
              "peak MiB more"]  # fmt: skip
    if rows and len(rows[0]) > len(header):
        header += ["GPU, ms: still", "zooming", "moving"]
    report.table(header, rows)


def main():
    options = bench.arguments(
        __doc__, limit=300, quick=(False, "fewer sizes"),
        page=("", "a page whose end is replaced by the tables"),
    )  # fmt: skip
    report = bench.Report("drawing", "Evaluation and drawing by shaders")
    evaluation(report, options.quick, options.limit)
    sizes = (1000, 8036) if options.quick else (1000, 8036, 31040, 100000)
    drawing(report, sizes, options.limit)
    status = report.save()
    if options.page:
        report.paste(options.page)
    return status


if __name__ == "__main__":
    sys.exit(main())
