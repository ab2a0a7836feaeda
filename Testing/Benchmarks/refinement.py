#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How far faces of bent models part at common edges, by vtkNURBSRefinement's MaximumSpacing.

Models: linkrods.step and screw.step of occt-misc, and STEP files of at least 500 faces in the folders.
"""

import json
import math
import os
import sys

import bench

SMALL = ("linkrods.step", "screw.step")
MANY = 500  # faces
HEADER = ["spacing", "control points", "s", "gap", "of it: file", "nets", "order"]


def measure(file, limit):
    """One dictionary a spacing, or why there is none."""
    output, problem = bench.run([bench.program("RefinementBenchmark"), file], limit)
    if problem is not None:
        return [], problem
    return [json.loads(line) for line in output.splitlines() if line.startswith("{")], None


def order(before, after, bend):
    """The exponent of the spacing in what nets add to the gap."""
    if before is None or not before["spacing"]:
        return None
    ratio = before["bends"][bend]["net"] / after["bends"][bend]["net"]
    return math.log(ratio) / math.log(before["spacing"] / after["spacing"])


def tabulate(report, lines):
    for k, bend in enumerate(lines[0]["bends"]):
        report.text(f"Bent by {bend['amount']:g} of the length:")
        rows, before = [], None
        for line in lines:
            at = line["bends"][k]
            name = f"{line['spacing']:g}" if line["spacing"] else "as it is"
            seconds = line["seconds"] if line["spacing"] else None
            gaps = [f"{at[kind]:.1e}" for kind in ("gap", "own", "net")]
            steepness = order(before, line, k)
            shown = None if steepness is None else f"{steepness:.2f}"
            rows.append([name, line["points"], seconds, *gaps, shown])
            before = line
        report.table(HEADER, rows)


def main():
    options = bench.arguments(__doc__)
    report = bench.Report("refinement", "Gaps at common edges of bent models")
    report.text(
        "Lengths are parts of the diagonal, and distances at the same 65 parameters of an edge. File: the "
        "gaps of the file itself where the bend is applied to points of the surfaces, which no net "
        "removes. Nets: the most that control nets add. Order: the exponent of the spacing from "
        "the line above to this one. One thread, seconds of processor time."
    )
    for file in bench.models(options.folders, options.only):
        name = os.path.basename(file)
        if not name.endswith((".step", ".stp")):
            continue
        lines, problem = measure(file, options.limit)
        if problem is not None:
            report.text(f"- {name}: {problem}")
        elif name in SMALL or lines[0]["faces"] >= MANY:
            report.text(f"## {name}, {lines[0]['faces']:,} faces, {lines[0]['edges']:,} common edges")
            tabulate(report, lines)
    return report.save()


if __name__ == "__main__":
    sys.exit(main())
