#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""From file to picture: the command line's `render`, start of the process included."""

import os
import subprocess
import time

import bench

WANTED = ("linkrods", "screw.step", "terrain", "Bottom", "odrive", "bowden", "car_wheel")


def seconds(file, limit):
    picture = bench.scratch(".png")
    try:
        best = None
        for _ in range(3):
            start = time.monotonic()
            done = subprocess.run(
                [bench.program("vtknurbs"), "render", file, "-o", picture],
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
                timeout=limit,
                text=True,
            )
            if done.returncode != 0:
                return None, (done.stderr.strip().splitlines() or ["failed"])[-1]
            taken = time.monotonic() - start
            best = taken if best is None else min(best, taken)
            if taken > 10:
                break
        return best, f"{os.path.getsize(picture)} bytes"
    except subprocess.TimeoutExpired:
        return None, f"no picture in {limit:g} s"
    finally:
        os.remove(picture)


def main():
    options = bench.arguments(__doc__)
    report = bench.Report("pictures", "From file to picture")
    rows = []
    for file in bench.models(options.folders, options.only):
        if any(w in os.path.basename(file) for w in WANTED):
            rows.append([os.path.basename(file), *seconds(file, options.limit)])
    report.table(["model", "s (best of 3)", "picture"], rows)
    report.save()


if __name__ == "__main__":
    main()
