#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The visible regions of every model from three directions, and of the paper's three models, against
rays (VisibilityTruth): hits that agree, that disagree within the precision, and wrong ones; visible
areas of closed shapes against areas by rays. Exit status 3 if anything is wrong.

The whole takes hours on two cores: with --kept FILE, what was measured before with as many rays is not
measured again, and with --minutes N nothing is begun after N minutes; the page tells what is left."""

import json
import os
import sys
import time

import bench

START = time.monotonic()

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


class Kept:
    """Results by label, those with the most rays, in a file of JSON lines if there is one."""

    def __init__(self, path):
        self.path, self.found = path, {}
        if path and os.path.exists(path):
            with open(path, encoding="ascii") as lines:
                for line in lines:
                    self.add(json.loads(line))

    def add(self, entry):
        label = (entry["label"], entry["precision"])
        if label not in self.found or entry["rays"] >= self.found[label]["rays"]:
            self.found[label] = entry

    def measure(self, label, what, options, more):
        """The entry of a label; None if nothing is known of it and the time is up."""
        known = self.found.get((label, options.precision))
        late = options.minutes > 0 and time.monotonic() - START > 60 * options.minutes
        if late or (known and known["rays"] >= float(options.rays)):
            return known
        found, problem = measure(what, options, *more)
        if problem and known:
            return known
        entry = {"label": label, "precision": options.precision, "rays": float(options.rays),
                 "found": found, "problem": problem}  # fmt: skip
        self.add(entry)
        if self.path:
            with open(self.path, "a", encoding="ascii") as out:
                out.write(json.dumps(entry) + "\n")
        return entry


COUNTS = ("faces", "regions", "inexact", "seconds", "rays", "hits", "agree", "within", "narrow",
          "coincident", "near", "wrong", "worst", "piercing")  # fmt: skip


def rays(report, inputs, options):
    report.text(f"## Rays, at {options.precision} of the diagonal")
    rows, results, failed, left = [], [], 0, []
    kept = Kept(options.kept)
    for what in inputs:
        name = os.path.basename(what[-1])
        for hidden in (False, True) if what[0] == "--shape" else (False,):
            more = ["--precision", options.precision] + (["--hidden"] if hidden else [])
            label = name + (" (hidden)" if hidden else "")
            entry = kept.measure(label, what, options, more)
            if entry is None:
                left.append(label)
                continue
            if entry["problem"]:
                report.text(f"- {label}: {entry['problem']}")
                failed += 1
            for result in entry["found"]:
                results.append(result)
                bad = len(result.get("bad_regions", []))
                rows.append([label, result["view"], *(result[k] for k in COUNTS),
                             f"{bad} bad" if bad else ""])  # fmt: skip
        print(".", end="", file=sys.stderr, flush=True)
    report.table(["model", "view", "faces", "with regions", "inexact", "s", "rays", "hits", "agree",
                  "within the precision", "narrower than it", "coincident", "within ten times it",
                  "wrong", "worst, of it", "piercing pairs", ""], rows)  # fmt: skip
    hits, wrong = (sum(r[k] for r in results) for k in ("hits", "wrong"))
    near = sum(r["near"] for r in results)
    report.text(
        f"{sum(is_right(r) for r in results)} of {len(results)} views are right everywhere; of "
        f"{hits:,} hits {wrong + near:,} are wrong, {near:,} of them within ten times the precision, "
        f"and {sum(r['coincident'] for r in results):,} are on faces that coincide. "
        f"{failed} models gave no result."
    )
    if left:
        report.text(f"Not measured, as the time was up: {', '.join(left)}.")
    return failed == 0 and not left and all(is_right(r) for r in results)


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
        kept=("", "a file of results, which is added to"),
        minutes=(0.0, "to begin nothing after; 0: no limit"),
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
