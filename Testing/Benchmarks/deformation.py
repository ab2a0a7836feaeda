#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Figure 2 of Li, Lau and Green, "Interactive rendering of deforming NURBS surfaces" (1997): a frame
in which one control point moves, by their rivals and today's.
Documentation/Papers/li-1997-tables.md explains what is compared; --page FILE pastes the tables into
it."""

import sys

import bench

# Keys of DeformationBenchmark's JSON, in the order of the tables.
METHODS = {
    "oslo": "(a) Oslo, knots of full multiplicity",
    "oslo_simple": "(a) Oslo, simple knots",
    "bezier": "(b) Bezier, Horner",
    "bezier_rows": "(b) Bezier, Horner, rows shared",
    "refined_far": "(c) ours, refined, a long way",
    "refined": "(c) ours, refined",
    "increments": "(d) ours",
    "occt": "(e) OpenCASCADE",
    "full": "(e) full evaluation",
    "local": "(f) local evaluation",
}
SPANS = 39
CELLS = (2, 4, 8, 32)
MAIN = 8  # 313 x 313 vertices
OCCT_CELLS = 8  # OpenCASCADE takes minutes and over 10 GB for a mesh of more.
KINDS = {"rational": (), "polynomial": ("--polynomial",)}
VERTEX = 2 * 6 * 8  # bytes: point and normal, read and written


def measure(options, cells):
    """The benchmark's results by kind and cells a span."""
    done = {}
    for kind, flags in KINDS.items():
        for n in cells:
            print(f"... {kind}, {n} cells a span", file=sys.stderr, flush=True)
            command = [bench.program("DeformationBenchmark"), "--spans", str(SPANS)]
            command += ["--cells", str(n), *flags]
            command += ["--without-occt"] if n > OCCT_CELLS else []
            done[kind, n] = bench.run_json(command, options.limit)
    return done


def sizes(report, kind, results):
    """Milliseconds a frame, and nanoseconds a vertex, of every size."""
    header = [f"{r['vertices']:,} vertices" for r in results]
    frames, vertices = [], []
    for key, name in METHODS.items():
        rows = [r["rivals"].get(key) for r in results]
        frames.append([name] + [row and 1e3 * row["frame"] for row in rows])
        vertices.append([name] + [row and 1e9 * row["frame"] / row["vertices"] for row in rows])
    report.text(f"## {kind.capitalize()}: milliseconds a frame")
    report.table(["method", *header], frames)
    report.text(f"## {kind.capitalize()}: nanoseconds a vertex of the whole mesh")
    report.table(["method", *header], vertices)


def main_case(report, kind, result):
    """One size in full."""
    report.text(
        f"## {kind.capitalize()}, {result['vertices']:,} vertices: {result['touched']:,} of them"
        f" ({100 * result['touched'] / result['vertices']:.2g} %) touched"
    )
    rivals = result["rivals"]
    rows = []
    for key, name in METHODS.items():
        row = rivals.get(key)
        if row:
            rows.append(
                [name, 1e3 * row["frame"], 1e9 * row["frame"] / result["touched"],
                 row["frame"] / rivals["full"]["frame"], row["frame"] / rivals["local"]["frame"],
                 rivals["bezier"]["frame"] / row["frame"], 100 * row.get("changed", 0),
                 row["vertices"], row["triangles"], row["point_error"], row["normal_error"]]
            )  # fmt: skip
    report.table(
        ["method", "ms a frame", "ns a touched vertex", "over full evaluation",
         "over local evaluation", "(b) over it", "polygons changed, %", "vertices", "triangles", "largest distance", "largest angle"],
        rows,
    )  # fmt: skip


def memory(report, results):
    """What one thread moves."""
    report.text("## Memory: one thread, bytes read and written")
    rows = [("memory", results[0]["memory"])]
    rows += [(f"{r['touched']:,} touched vertices", r["cache"]) for r in results]
    report.table(
        ["arrays of", "bytes", "copy, GB/s", "modify, GB/s", "ns to modify point and normal"],
        [[name, m["bytes"], m["copy"] / 1e9, m["modify"] / 1e9, 1e9 * VERTEX / m["modify"]]
         for name, m in rows],
    )  # fmt: skip


def main():
    options = bench.arguments(
        __doc__, limit=300, quick=(False, "fewer sizes"),
        page=("", "a page whose end is replaced by the tables"),
    )  # fmt: skip
    report = bench.Report("deformation", "A control point moves: the mesh brought up to date")
    done = measure(options, CELLS[:2] if options.quick else CELLS)
    for key, result in done.items():
        if "error" in result:
            report.text(f"- {key[0]}, {key[1]} cells a span: {result['error']}")
    for kind in KINDS:
        results = [r for key, r in done.items() if key[0] == kind and "error" not in r]
        if results:
            sizes(report, kind, results)
        if "error" not in done.get((kind, MAIN), {"error": "left out"}):
            main_case(report, kind, done[kind, MAIN])
    measured = [r for key, r in done.items() if key[0] == "rational" and "error" not in r]
    if measured:
        memory(report, measured)
    status = report.save()
    if options.page:
        report.paste(options.page)
    return status


if __name__ == "__main__":
    sys.exit(main())
