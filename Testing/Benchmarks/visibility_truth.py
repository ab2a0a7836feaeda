#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The visible regions of every model from three directions, and of the paper's three models, against
rays (VisibilityTruth): hits that agree, that disagree within the precision, and wrong ones; visible
areas of closed shapes against areas by rays. Exit status 3 if anything is wrong."""

import json
import os
import sys

import bench

SHAPES = ("sphere", "torus", "cylinder", "cone", "teapot", "vase", "missile", "spring")
SOLIDS = ("sphere", "torus", "vase", "missile", "spring")


def measure(what, options, *more):
    """One result a view, and what went wrong (a wrong hit is no failure of the program)."""
    command = [bench.program("VisibilityTruth"), *what, "--json", "--rays", options.rays, *more]
    output, problem = bench.run(command, options.limit)
    found = [json.loads(line) for line in output.splitlines() if line.startswith("{")]
    return found, problem if not found else None


def is_right(result):
    return result["near"] + result["wrong"] + len(result.get("bad_regions", [])) == 0


def rays(report, inputs, options):
    report.text(f"## Rays, at {options.precision} of the diagonal")
    rows, results, failed = [], [], 0
    for what in inputs:
        name = os.path.basename(what[-1])
        for hidden in (False, True) if what[0] == "--shape" else (False,):
            more = ["--precision", options.precision] + (["--hidden"] if hidden else [])
            found, problem = measure(what, options, *more)
            label = name + (" (hidden)" if hidden else "")
            if problem:
                report.text(f"- {label}: {problem}")
                failed += 1
            for result in found:
                results.append(result)
                bad = len(result.get("bad_regions", []))
                rows.append([
                    label, result["view"], *(result[k] for k in ("faces", "regions", "seconds",
                    "hits", "agree", "within", "narrow", "near", "wrong", "worst", "piercing")),
                    f"{bad} bad" if bad else "",
                ])  # fmt: skip
        print(".", end="", file=sys.stderr, flush=True)
    report.table(["model", "view", "faces", "with regions", "s", "hits", "agree",
                  "within the precision", "narrower than it", "within ten times it", "wrong",
                  "worst, of it", "piercing pairs", ""], rows)  # fmt: skip
    hits, wrong = (sum(r[k] for r in results) for k in ("hits", "wrong"))
    near = sum(r["near"] for r in results)
    report.text(
        f"{sum(is_right(r) for r in results)} of {len(results)} views are right everywhere; of "
        f"{hits:,} hits {wrong + near:,} are wrong, {near:,} of them within ten times the precision. "
        f"{failed} models gave no result."
    )
    return failed == 0 and all(is_right(r) for r in results)


def areas(report, options):
    report.text("## Visible areas of closed shapes at a precision of 1e-7, and by rays")
    rows = []
    more = ["--precision", "1e-7", "--area", "1e-7", "--scan", "600"]
    for name in SOLIDS:
        found, problem = measure(["--shape", name], options, *more)
        if problem:
            report.text(f"- {name}: {problem}")
        for result in found:
            rows.append([
                name, result["view"], f"{result['area']:.9g}", f"{result['area_by_rays']:.9g}",
                result["area_coarse"], result["area_off"],
            ])  # fmt: skip
    report.table(["shape", "view", "visible area", "by rays", "rays: change from ten times coarser",
                  "ours off by"], rows)  # fmt: skip


def main():
    options = bench.arguments(
        __doc__,
        limit=300,
        rays=("1e6", "rays a view"),
        precision=("1e-4", "over the diagonal"),
        no_areas=(False, "rays only"),
        page=("", "a page whose end is replaced by the tables"),
    )
    report = bench.Report("visibility-truth", "Visible regions against rays")
    files = [[f] for f in bench.models(options.folders, options.only)]
    right = rays(report, [["--shape", name] for name in SHAPES] + files, options)
    if not options.no_areas:
        areas(report, options)
    status = report.save()
    if options.page:
        report.paste(options.page)
    return status or (0 if right else 3)


if __name__ == "__main__":
    sys.exit(main())
