# SPDX-License-Identifier: BSD-3-Clause
"""Two and four processes make together what one makes alone: cells, points, attributes, figures.

Run as `python3 TestPieces.py MPIRUN PVBATCH PLUGIN FOLDER SOURCE [FILTER...]`; see pieces.py.
"""
import collections
import json
import os
import shutil
import subprocess
import sys

MPIRUN, PVBATCH, PLUGIN, FOLDER = sys.argv[1:5]
SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "pieces.py")


def run(ranks):
    """What each of `ranks` processes has."""
    folder = os.path.join(FOLDER, str(ranks))
    shutil.rmtree(folder, ignore_errors=True)
    command = [MPIRUN, "--allow-run-as-root", "--oversubscribe", "-np", str(ranks)]
    command += [PVBATCH, "--symmetric", SCRIPT, PLUGIN, folder] + sys.argv[5:]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0 or "Traceback" in done.stdout or "ERR|" in done.stdout:
        print(done.stdout)
        raise SystemExit("%d processes failed" % ranks)
    found = []
    for rank in range(ranks):
        with open(os.path.join(folder, "rank-%d.json" % rank)) as file:
            found.append(json.load(file))
    return found


def union(ranks, what, name):
    return collections.Counter(x for rank in ranks for x in rank[what].get(name, []))


def open_sides(counts):
    """Sides that no triangle of the union has the other way."""
    half = 12
    return sum(max(0, n - counts[s[half:] + s[:half]]) for s, n in counts.items())


(alone,) = run(1)
problems = []
for processes in (2, 4):
    together = run(processes)
    for name, cells in alone["cells"].items():
        counts = union(together, "cells", name)
        share = [len(rank["cells"][name]) for rank in together]
        same = counts == collections.Counter(cells)
        print("%d processes, %-30s %7d cells of %s" % (processes, name, sum(share), share))
        if not same:
            missing = sum((collections.Counter(cells) - counts).values())
            arrays = [rank["arrays"].get(name) for rank in together]
            problems.append(
                "%s by %d: %d of %d cells are missing, %d are there; arrays %s, of one process %s"
                % (name, processes, missing, len(cells), sum(share), arrays, alone["arrays"].get(name))
            )
    for name, own in alone["sides"].items():
        before = open_sides(collections.Counter(own))
        after = open_sides(union(together, "sides", name))
        print("%d processes, %-30s %d open sides, by one %d" % (processes, name, after, before))
        if after != before:
            problems.append("%s by %d: %d open sides" % (name, processes, after))
    for name, value in alone["figures"].items():
        for rank in together:
            if rank["figures"][name] != value:
                problems.append(
                    "%s by %d: %s, not %s" % (name, processes, rank["figures"][name], value)
                )
    # All processes have something to do where there are enough faces.
    busy = sum(1 for rank in together if rank["cells"]["source 0"])
    if busy != min(processes, len(alone["cells"]["source 0"])):
        problems.append("only %d of %d processes have faces" % (busy, processes))
for problem in problems:
    print(problem)
if problems:
    raise SystemExit(1)
print("passed")
