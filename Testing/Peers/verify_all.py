#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measures the meshes of every model against its original shape (MeshVerifier), ours or, with
--occt, OpenCASCADE's own. Exit status 3 if any fails, 1 if a program crashes."""

import json
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "Benchmarks"))
import bench  # noqa: E402


def our_mesh(file, relative, options, path):
    """Tessellates at relative times the diagonal that OpenCASCADE measures; its absolute value."""
    size = bench.run_json([bench.program("MeshVerifier"), file, "--diagonal"], options.limit)
    if "error" in size:
        return None, size["error"]
    absolute = relative * size["diagonal"]
    command = [bench.program("TessellationBenchmark"), file, "--absolute", repr(absolute)]
    command += ["--error", options.error, "--repeat", "1", "--output", path]
    made = bench.run_json(command, options.limit)
    return absolute, made.get("error")


def verify(file, relative, options):
    mesh, report = bench.scratch(".vtp"), bench.scratch(".json")
    try:
        command = [bench.program("MeshVerifier"), file, "--json", report, "--list", "0"]
        command += ["--density", str(options.density)]
        if options.occt:
            command += ["--tolerance", str(relative)]
        else:
            absolute, problem = our_mesh(file, relative, options, mesh)
            if problem:
                return {"error": problem}
            command += [mesh, "--absolute", repr(absolute)]
            command += ["--estimates"] if options.error == "estimated" else []
        done = bench.run_json(command, options.limit)
        if os.path.getsize(report) == 0:
            return done
        with open(report, encoding="utf-8") as text:
            return json.load(text)
    finally:
        os.remove(mesh)
        os.remove(report)


def worst(face):
    return max(face.get("mesh_to_face") or 0, face.get("face_to_mesh") or 0)


def reasons(face, estimates):
    """Why a face fails, in words."""
    found = []
    if face["missing"]:
        return ["missing"]
    if face["mesh_to_face"] is None or worst(face) > (1 + face["gap"]) * (1 + 1e-6):
        found.append(f"error {worst(face):.3g} tol at gap {face['gap']:.2g}")
    if not face["area_agrees"]:
        found.append(f"area {face['mesh_area']:.6g} of {face['area']:.6g}")
    if face["folded"]:
        found.append(f"{face['folded']} folded")
    if not estimates and face["certified"] >= 0 and worst(face) > face["certified"] * (1 + 1e-9) + 1e-6:
        found.append(f"certified {face['certified']:.3g} below measured {worst(face):.3g} tol")
    return found


def list_failures(report, name, result, options):
    estimates = options.error == "estimated"
    failing = [(f, reasons(f, estimates)) for f in result["face"]]
    failing = [(f, why) for f, why in failing if why]
    failing.sort(key=lambda entry: -worst(entry[0]))
    for face, why in failing[:options.most]:
        report.text(f"- {name} face {face['face']} ({face['kind']}): {'; '.join(why)}")
    if len(failing) > options.most:
        report.text(f"- {name}: {len(failing)} failing faces in all")


HEADER = [
    "model", "ok", "faces", "triangles", "error/tol", "less gaps", "faces over", "despite gaps",
    "missing", "area bad", "folded", "open edges", "cracks", "certified/measured", "undercut",
    "largest gap/tol", "s",
]  # fmt: skip
KEYS = [
    "ok", "faces", "triangles", "error", "error_less_gap", "faces_over", "faces_over_gap",
    "missing", "area_bad", "folded", "open_edges", "cracks", "certified_ratio", "undercut", "gap",
    "seconds",
]  # fmt: skip


def main():
    options = bench.arguments(
        __doc__,
        limit=120,
        tolerances=("1e-3,1e-4", "tolerances over the diagonal"),
        error=("guaranteed", "error mode of our tessellator: guaranteed or estimated"),
        occt=(False, "measure OpenCASCADE's meshes instead of ours"),
        density=(1.0, "factor on the number of samples"),
        most=(8, "failing faces listed a file"),
    )
    whose = "occt" if options.occt else options.error
    files = bench.models(options.folders, options.only)
    report = bench.Report("verify-" + whose, f"Meshes against the original shapes: {whose}")
    bad = 0
    for relative in [float(t) for t in options.tolerances.split(",")]:
        report.text(f"## Tolerance {relative:g} of the diagonal")
        rows, results = [], []
        for file in files:
            name = os.path.basename(file)
            result = verify(file, relative, options)
            if "face" in result:
                list_failures(report, name, result, options)
                rows.append([name] + [result[k] for k in KEYS])
                results.append(result)
            else:
                report.text(f"- {name}: {result.get('error', 'no result')}")
                rows.append([name, False] + [None] * (len(KEYS) - 1))
        report.table(HEADER, rows)
        good = sum(r["ok"] for r in results)
        within = sum(r["faces_over"] == 0 and r["missing"] == 0 for r in results)
        ratios = [r["certified_ratio"] for r in results if r["certified_ratio"] > 0]
        report.text(
            f"{good} of {len(files)} files pass every check; {within} are within the tolerance on "
            f"every face without allowance for gaps; {sum(r['triangles'] for r in results):,} "
            f"triangles; median certified/measured {bench.show(bench.median(ratios))}"
        )
        bad += len(files) - good
    return report.save() or (3 if bad else 0)


if __name__ == "__main__":
    sys.exit(main())
