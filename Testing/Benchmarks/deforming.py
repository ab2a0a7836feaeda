#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Animations frame by frame: a sheet of 1,000,000 vertices whose control points are dragged, and
CAD models in a moving lattice: the model of most faces in Debian's occt-misc, and all STEP files of
at least 500 faces. occt-misc has no such file: name folders that have one, or the report says that
none was there.
"""

import os
import sys

import bench

FACES = 500
PHASES = ("deform", "compare", "move", "adapt", "rebuild", "output", "update", "upload points",
          "upload triangles", "draw", "downstream", "frame", "fresh")  # fmt: skip
NAMES = {
    "update": "update (compare to output)",
    "upload points": "upload: points, normals",
    "upload triangles": "upload: triangles",
    "downstream": "downstream (upload and draw)",
    "frame": "frame, all of the above",
    "fresh": "vtkNURBSTessellator instead of update",
}
COUNTS = {
    "moved": "control points moved",
    "updated": "vertices updated",
    "inserted": "vertices inserted",
    "deleted": "vertices deleted",
    "triangles": "triangles",
    "fresh triangles": "triangles of vtkNURBSTessellator",
    "bound": "error bound",
    "gap": "model gap",
}


def faces(file, limit):
    """How many faces the file has, 0 if it cannot be told."""
    output, _ = bench.run([bench.program("vtknurbs"), "info", file], limit)
    for line in output.splitlines():
        if line.startswith("Faces"):
            return int(line.split()[1].rstrip(",").replace(",", ""))
    return 0


def choose(options):
    """(faces, file) of all STEP files of enough faces, and of Debian's model of most faces."""
    files = bench.models(options.folders, options.only)
    counted = [(faces(file, options.limit), file) for file in files]
    wanted = [c for c in counted if c[0] >= FACES and c[1].lower().endswith((".step", ".stp"))]
    debian = [c for c in counted if c[1].startswith(bench.OCCT_DATA)]
    return wanted, max(debian, default=None)


def milliseconds(done):
    rows = []
    for phase in PHASES:
        figures = done["phases"].get(phase)
        if figures:
            values = [1e3 * figures[k] for k in ("mean", "median", "p95", "worst")]
            share = 100 * figures["mean"] / done["phases"]["frame"]["mean"]
            rows.append([NAMES.get(phase, phase), *values, share if phase != "fresh" else None])
    return rows


def story(done, drawn):
    """What the tables do not say."""
    first, phases = done["first"], done["phases"]
    update, fresh = phases["update"], phases.get("fresh")
    lines = [
        f"- {done['frames']:,} frames; faces: {done['faces']:,}; {done['control_points']:,} "
        f"control points; {done['device']}, drawn {drawn}; at most {done['memory'] / 2**20:.0f} MiB.",
        f"- First frame: {first['mesh']:.3g} s for {first['points']:,} points and "
        f"{first['triangles']:,} triangles, {first['picture']:.3g} s for the picture.",
        f"- Tolerance {done['tolerance']:.3g}, error bound of the first frame "
        f"{first['bound']:.3g}, model gap {first['gap']:.3g}.",
        f"- vtkNURBSTessellator at rest: {first['fresh']:.3g} s, {first['fresh_triangles']:,} "
        "triangles.",
        f"- Open edges: {first['open_edges']} at rest ({first['fresh_open_edges']} of "
        f"vtkNURBSTessellator's mesh); on {len(done.get('open_edges', []))} of the "
        f"frames, at most {max(done.get('open_edges', [0]))}.",
        f"- Frames refused: {done['counts']['refused']['mean'] * done['frames']:.0f}; models made "
        f"anew: {done['counts']['remade']['mean'] * done['frames']:.0f}.",
    ]
    if fresh:
        lines.append(
            f"- vtkNURBSTessellator at a tolerance of {done['fresh_tolerance']:.3g} takes "
            f"{fresh['median'] / update['median']:.3g} times as long as the update (medians; "
            f"{fresh['mean'] / update['mean']:.3g} by means)."
        )
    return "\n".join(lines)


def animation(report, title, command, options):
    report.text(f"## {title}")
    print("...", *command, file=sys.stderr, flush=True)
    frames, seconds = (60, 60) if options.quick else (options.frames, options.limit)
    # A million vertices take a software renderer most of the time: every tenth picture will do.
    every = 1 if command[0] == "lattice" else 10
    checks = ["--check-every", "20", "--fresh-every", "30"] if options.quick else []
    done = bench.run_json(
        [bench.program("DeformingAnimation"), *command, "--frames", str(frames), "--seconds",
         str(options.limit), "--draw-every", str(every), *checks],
        2 * options.limit,
    )  # fmt: skip
    if "error" in done:
        report.text(f"- {done['error']}")
        return
    report.text(story(done, "every frame" if every == 1 else f"every {every}th frame"))
    report.table(["ms a frame", "mean", "median", "95 %", "worst", "% of the frame"],
                 milliseconds(done))  # fmt: skip
    rows = [
        [name, *(done["counts"][key][k] for k in ("mean", "median", "p95", "worst"))]
        for key, name in COUNTS.items()
        if key in done["counts"]
    ]
    report.table(["a frame", "mean", "median", "95 %", "largest"], rows)


def sheets(report, options):
    command = ["sheet", "--points", "253", "--depth"]
    animation(report, "A sheet of 1,002,001 vertices, its cells as they are", [*command, "2"],
              options)  # fmt: skip
    animation(report, "A sheet refined by tolerance", [*command, "-1", "--tolerance", "4.4e-6"],
              options)  # fmt: skip


def lattices(report, options):
    wanted, debian = choose(options)
    if not wanted:
        report.text(f"No STEP file of {FACES} faces or more in occt-misc and the folders given.")
    for count, file in [debian, *wanted] if debian else wanted:
        animation(report, f"{os.path.basename(file)}, {count:,} faces, in a lattice of 5 x 5 x 5",
                  ["lattice", file], options)  # fmt: skip


def main():
    options = bench.arguments(
        __doc__, limit=600, quick=(False, "60 frames each"), frames=(1000, "after the first"),
        scenes=("sheet,lattice", "what is animated"),
        page=("", "a page whose end is replaced by the tables"),
    )  # fmt: skip
    report = bench.Report("deforming", "Animations, frame by frame")
    if "sheet" in options.scenes:
        sheets(report, options)
    if "lattice" in options.scenes:
        lattices(report, options)
    status = report.save()
    if options.page:
        report.paste(options.page)
    return status


if __name__ == "__main__":
    sys.exit(main())
