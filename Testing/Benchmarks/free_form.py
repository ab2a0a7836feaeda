#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Milliseconds an update of vtkNURBSFreeFormDeformation takes, with one thread and with two."""

import sys

import bench


def main():
    options = bench.arguments(__doc__)
    report = bench.Report("free_form", "A lattice bends a cylinder")
    for threads in ("1", "2"):
        output, problem = bench.run([bench.program("FreeFormBenchmark"), threads], options.limit)
        report.text(output.strip() if problem is None else f"- {threads} threads: {problem}")
    return report.save()


if __name__ == "__main__":
    sys.exit(main())
