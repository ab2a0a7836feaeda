#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""From file to picture: the command line's `render` without options (half a pixel), start of the
process included."""

import os
import sys
import time

import bench

WANTED = ("linkrods", "screw.step", "terrain", "Bottom", "odrive", "bowden", "car_wheel")
RUNS = 3


def draw(file, picture, limit):
    """(shortest seconds of up to RUNS, None) or (None, why there is no picture)."""
    best = float("inf")
    for _ in range(RUNS):
        start = time.monotonic()
        _, problem = bench.run([bench.program("vtknurbs"), "render", file, "-o", picture], limit)
        if problem:
            return None, problem
        taken = time.monotonic() - start
        best = min(best, taken)
        if taken > 10:
            break
    return best, None


def main():
    options = bench.arguments(__doc__, limit=60)
    report = bench.Report("pictures", "From file to picture")
    rows = []
    for file in bench.models(options.folders, options.only):
        if any(w in os.path.basename(file) for w in WANTED):
            picture = bench.scratch(".png")
            seconds, problem = draw(file, picture, options.limit)
            size = os.path.getsize(picture) / 1000
            rows.append([os.path.basename(file), os.path.getsize(file) / 1e6, seconds,
                         problem or f"{size:.0f} kB"])  # fmt: skip
            os.remove(picture)
    report.table(["model", "file MB", f"s, best of {RUNS}", "picture"], rows)
    return report.save()


if __name__ == "__main__":
    sys.exit(main())
