#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Reading and meshing of every model by OpenCASCADE (native shapes, BRepMesh, angle criterion off)
and by us, one file after the other in one run, at the same absolute tolerances. Meshing on one thread
is told in processor time, which is the elapsed time of a machine that does nothing else; the rest in
elapsed time."""

import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "Benchmarks"))
import bench  # noqa: E402

MODES = ("guaranteed", "estimated")


def measure(file, relatives, options):
    """(theirs, ours): JSON of OcctMeshBenchmark and TessellationBenchmark; ours maps modes."""
    repeat = ["--repeat", str(options.repeat)]
    theirs = bench.run_json(
        [bench.program("OcctMeshBenchmark"), file, "--tolerance"]
        + [str(r) for r in relatives]
        + repeat,
        options.limit,
    )
    if "error" in theirs:
        return theirs, {}
    absolutes = [repr(r * theirs["diagonal"]) for r in relatives]
    ours = {}
    for mode in MODES:
        command = [bench.program("TessellationBenchmark"), file, "--absolute"] + absolutes
        command += ["--threads", "1", "2", "--error", mode] + repeat
        ours[mode] = bench.run_json(command, options.limit)
    return theirs, ours


def entry(result, index, threads):
    """The mesh at the index-th tolerance made by so many threads."""
    rows = [m for m in result.get("meshes", []) if m["threads"] == threads]
    if index >= len(rows):
        return {}
    row = rows[index]
    return {**row, "seconds": row["processor_seconds"]} if threads == 1 else row


def milliseconds(row):
    return 1e3 * row["seconds"] if "seconds" in row else None


def ratio(a, b):
    return a / b if a is not None and b else None


HEADER = [
    "model", "faces", "theirs ms", "2 threads", "triangles", "ours ms", "2 threads", "triangles",
    "certified/tol", "estimated ms", "2 threads", "triangles", "time ratio", "triangle ratio", "",
]  # fmt: skip


def tolerance_table(report, relative, index, measured):
    report.text(f"## Meshing at {relative:g} of the diagonal")
    rows, total, slower = [], {}, 0
    for file, theirs, ours in measured:
        their, their2 = entry(theirs, index, 1), entry(theirs, index, 2)
        sure, sure2 = (entry(ours.get("guaranteed", {}), index, n) for n in (1, 2))
        guess, guess2 = (entry(ours.get("estimated", {}), index, n) for n in (1, 2))
        times = ratio(milliseconds(sure), milliseconds(their))
        is_slower = times is not None and times > 1
        slower += is_slower
        certified = sure.get("certified")
        rows.append([
            os.path.basename(file), theirs.get("faces"), milliseconds(their), milliseconds(their2),
            their.get("triangles"), milliseconds(sure), milliseconds(sure2),
            sure.get("triangles"), ratio(certified, sure.get("absolute")),
            milliseconds(guess), milliseconds(guess2), guess.get("triangles"), times,
            ratio(sure.get("triangles"), their.get("triangles")), "slower" if is_slower else "",
        ])  # fmt: skip
        columns = {"their": their, "their2": their2, "sure": sure, "sure2": sure2}
        columns.update(guess=guess, guess2=guess2)
        if all("seconds" in c for c in columns.values()):
            for key, column in columns.items():
                seconds, triangles = total.get(key, (0, 0))
                total[key] = (seconds + column["seconds"], triangles + column["triangles"])
    report.table(HEADER, rows)
    if not total:
        return
    base = total["their"]
    for key, name in (("sure", "guaranteed"), ("guess", "estimated")):
        one, two = total[key], total[key + "2"]
        report.text(
            f"Total {name}: {one[0]:.3f} s against their {base[0]:.3f} s on one thread "
            f"({one[0] / base[0]:.2f} times), {two[0]:.3f} s against {total['their2'][0]:.3f} s on "
            f"two; {one[1]:,} triangles against {base[1]:,} ({one[1] / base[1]:.2f} times)"
        )
    report.text(f"Guaranteed is slower than BRepMesh on {slower} of {len(rows)} files.")


def reading_table(report, relatives, measured):
    report.text("## From file to mesh, guaranteed, one thread")
    rows, sums = [], [0.0] * (2 + 2 * len(relatives))
    for file, theirs, ours in measured:
        sure = ours.get("guaranteed", {})
        if "read" not in theirs or "read" not in sure:
            report.text(
                f"- {os.path.basename(file)}: theirs {theirs.get('error', 'ok')}, "
                f"ours {sure.get('error', 'ok')}"
            )
            continue
        row = [1e3 * theirs["read"], 1e3 * sure["read"]]
        for index in range(len(relatives)):
            row.append(row[0] + (milliseconds(entry(theirs, index, 1)) or 0))
            row.append(row[1] + (milliseconds(entry(sure, index, 1)) or 0))
        slower = any(row[i + 1] > row[i] for i in range(2, len(row), 2))
        sums = [s + value for s, value in zip(sums, row)]
        rows.append([os.path.basename(file)] + row + ["slower" if slower else ""])
    header = ["model", "their reader ms", "ours"]
    for relative in relatives:
        header += [f"theirs with mesh at {relative:g}", "ours"]
    rows.append(["total"] + sums + [""])
    report.table(header + [""], rows)


def memory_table(report, relatives, measured):
    report.text(
        "## Memory: peak of the process, bytes a triangle at the finest tolerance and bytes a "
        "control point"
    )
    rows = []
    finest = relatives.index(min(relatives))
    for file, theirs, ours in measured:
        sure = ours.get("guaranteed", {})
        triangles = entry(sure, finest, 1).get("triangles")
        if triangles and triangles >= 20000:
            rows.append([
                os.path.basename(file), theirs.get("memory", 0) / 2**20, sure["memory"] / 2**20,
                triangles, ratio(sure["memory"] - sure["memory_start"], triangles),
                sure["control_points"],
                ratio(sure["memory_read"] - sure["memory_start"], sure["control_points"]),
            ])  # fmt: skip
    report.table(
        ["model", "theirs MiB", "ours MiB", "triangles", "bytes each", "control points",
         "bytes each"],
        rows,
    )  # fmt: skip


def main():
    options = bench.arguments(
        __doc__,
        limit=120,
        tolerances=("1e-3,1e-4", "tolerances over the diagonal"),
        repeat=(3, "runs of which the median counts"),
    )
    relatives = [float(t) for t in options.tolerances.split(",")]
    report = bench.Report("peers", "Beside OpenCASCADE's BRepMesh")
    measured = []
    for file in bench.models(options.folders, options.only):
        measured.append((file, *measure(file, relatives, options)))
        print(".", end="", flush=True)
    print()
    for index, relative in enumerate(relatives):
        tolerance_table(report, relative, index, measured)
    reading_table(report, relatives, measured)
    memory_table(report, relatives, measured)
    return report.save()


if __name__ == "__main__":
    sys.exit(main())
