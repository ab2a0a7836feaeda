#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Line drawings without hidden lines, of every file from three directions: OpenCASCADE's exact remover
(HLRBRep_Algo), its polygonal one (HLRBRep_PolyAlgo, meshing at the deflection counted), and ours
(vtkNURBSVisibleRegions, the drawing only), each on one thread and in processor time. All lines are
judged alike, by rays against the exact surfaces (LineTruth.h): lengths in the image, over the model's
diagonal."""

import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "Benchmarks"))
import bench  # noqa: E402

VIEWS = ("1,1,1", "0,0,1", "0.3,-0.9,0.2")
EXACT_CHORD = "1e-5"  # Between their exact curves and the polylines that are judged.
WHO = ("exact", "polygonal", "ours")


def _without_folder(problem, file):
    return problem and problem.replace(file, os.path.basename(file))


def check(file, view, options, *lines):
    """Judges lines of a .vtp, or ours."""
    command = [bench.program("HiddenLinesCheck"), file, *lines, "--view=" + view]
    command += ["--tolerance", options.tolerance]
    if not lines:
        command += ["--precision", options.precision]
    return bench.run_json(command, options.limit)


def ours(file, view, options):
    """Our lines, and how they were judged."""
    if not options.unjudged:
        return check(file, view, options)
    command = [bench.program("VisibilityBenchmark"), file, "--drawing-only", "--view", view]
    made = bench.run_json(command + ["--precision", options.precision], options.limit)
    if "error" in made:
        return made
    return {"faces": made["runs"][0]["faces"], "seconds": made["runs"][0]["processor_seconds"]}


def theirs(file, view, algorithm, options):
    path = bench.scratch(".vtp")
    try:
        command = [bench.program("HiddenLinesPeer"), file, "--view=" + view, "--out", path]
        deflection = options.precision if algorithm == "polygonal" else EXACT_CHORD
        command += ["--algorithm", algorithm, "--deflection", deflection]
        made = bench.run_json(command, options.limit)
        if "error" in made or options.unjudged:
            return made
        judged = check(file, view, options, path)
        return judged if "error" in judged else {**judged, **made}
    finally:
        os.remove(path)


def lengths(result, key):
    return result["judged"][0][key] if "judged" in result else None


def ratio(a, b):
    return a / b if a and b else None


def table(report, rows, judged):
    """Seconds and wrong lengths, one row a file and direction."""
    cells = []
    for file, view, done in rows:
        row = [os.path.basename(file), view, done["ours"].get("faces")]
        row += [done[who].get("seconds", _without_folder(done[who].get("error"), file)) for who in WHO]
        row += [ratio(done[who].get("seconds"), done["ours"].get("seconds")) for who in WHO[:2]]
        for key in ("wrong_visible", "wrong_hidden", "undecided") if judged else ():
            row += [lengths(done[who], key) for who in WHO]
        cells.append(row)
    header = ["model", "view", "faces", "exact s", "polygonal s", "ours s", "exact/ours",
              "polygonal/ours"]  # fmt: skip
    texts = ("hidden shown as visible", "visible shown as hidden", "not judged")
    for text in texts if judged else ():
        header += [f"{text}: exact", "polygonal", "ours"]
    report.table(header, cells)


def summary(report, rows, judged):
    for who in WHO[:2]:
        both = [d for _, _, d in rows if "seconds" in d[who] and "seconds" in d["ours"]]
        failed = sum("seconds" not in d[who] for _, _, d in rows)
        ratios = [ratio(d[who]["seconds"], d["ours"]["seconds"]) for d in both]
        total = [sum(d[w]["seconds"] for d in both) for w in (who, "ours")]
        report.text(
            f"Theirs {who}: {failed} of {len(rows)} drawings failed or took too long; of the others, "
            f"{total[0]:.1f} s against our {total[1]:.1f} s, median ratio "
            f"{bench.show(bench.median(ratios))}, we are slower in {sum(r < 1 for r in ratios)}."
        )
    for who in WHO if judged else ():
        good = [d[who]["judged"][0] for _, _, d in rows if "judged" in d[who]]
        report.text(
            f"{who}: {sum(j['wrong_visible'] > 0 for j in good)} of {len(good)} drawings show "
            f"hidden lines as visible, {sum(j['wrong_visible'] for j in good):.3g} diagonals in all "
            f"of {sum(j['visible'] for j in good):.4g} drawn visible; "
            f"{sum(j['wrong_hidden'] for j in good):.3g} of "
            f"{sum(j['hidden'] for j in good):.4g} drawn hidden are visible."
        )


def main():
    options = bench.arguments(
        __doc__,
        limit=120,
        precision=("1e-4", "of our lines, and deflection of their mesh, over the diagonal"),
        tolerance=("1e-4", "how far lines may be off before they are wrong, over the diagonal"),
        views=(" ".join(VIEWS), "directions to the viewer"),
        unjudged=(False, "times only"),
        page=("", "a page whose end is replaced by the tables"),
    )
    report = bench.Report("hidden-lines", "Beside OpenCASCADE's hidden lines")
    rows = []
    for file in bench.models(options.folders, options.only):
        for view in options.views.split():
            done = {who: theirs(file, view, who, options) for who in WHO[:2]}
            done["ours"] = ours(file, view, options)
            rows.append((file, view, done))
            print(".", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    report.text(
        f"Ours at {options.precision} of the diagonal, their mesh at the same deflection; at most "
        f"{options.limit:g} s each."
    )
    table(report, rows, not options.unjudged)
    summary(report, rows, not options.unjudged)
    status = report.save()
    if options.page:
        report.paste(options.page)
    return status


if __name__ == "__main__":
    sys.exit(main())
