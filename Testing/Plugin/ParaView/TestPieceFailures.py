# SPDX-License-Identifier: BSD-3-Clause
"""Nobody waits for a process that failed, and all say the same: pieceFailures.py on 2 and 4 processes.

Run as `python3 TestPieceFailures.py MPIRUN PVBATCH PLUGIN FOLDER`.
"""
import json
import os
import shutil
import subprocess
import sys

MPIRUN, PVBATCH, PLUGIN, FOLDER = sys.argv[1:5]
SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "pieceFailures.py")


def run(ranks):
    """What each of `ranks` processes has written."""
    folder = os.path.join(FOLDER, str(ranks))
    shutil.rmtree(folder, ignore_errors=True)
    command = ["timeout", "420", MPIRUN, "--allow-run-as-root", "--oversubscribe"]
    command += ["-np", str(ranks), PVBATCH, "--symmetric", SCRIPT, PLUGIN, folder]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0 or "Traceback" in done.stdout:
        print(done.stdout)
        raise SystemExit("%d processes ended with %d" % (ranks, done.returncode))
    found = []
    for rank in range(ranks):
        with open(os.path.join(folder, "rank-%d.json" % rank)) as file:
            found.append(json.load(file))
    return found


# Filters that look at no face but one at a time: they do what they can, in each process by itself.
ALONE = ("NURBSControlNet", "NURBSToBezierCells", "NURBSFreeFormDeformation")
NO_MODEL = "The input is not a NURBS model: it lacks the arrays that describe surfaces"


def expected(case, last):
    """What all processes say, and whether something comes out; None: what they like."""
    what, _, name = case.partition(", ")
    if case == "missing":
        return "Cannot read the file: process %d: no such file" % last, False
    if case == "other file":
        return "process %d: " % last, False
    if case == "mesh of missing":
        return "", False
    if name in ALONE or what == "nothing":
        return None
    if what == "no model":
        return "process %d: %s" % (last, NO_MODEL), name == "NURBSControlPointEdits"
    if what == "no input":
        return "process %d: the input could not be made" % last, None if "Edits" in name else False
    if what == "exception":
        return "process %d: AbsoluteTolerance must be positive, but is -1" % last, False
    if what == "aborted":
        return "", False
    if what == "sound":
        return "", True
    # A face that can't be used is named by all.
    return "" if name == "NURBSControlPointEdits" else "ace", True


problems = []
for processes in (2, 4):
    found = run(processes)
    for case in found[0]:
        wanted = expected(case, processes - 1)
        cells = sum(what[case]["cells"] for what in found)
        print("%d processes, %-40s %6d cells" % (processes, case, cells))
        for rank, what in enumerate(found if wanted else ()):
            said = what[case]["said"]
            if (wanted[0] not in said) or (not wanted[0] and said):
                problems.append("%s: process %d of %d says: %s" % (case, rank, processes, said))
        if wanted and wanted[1] not in (None, cells > 0):
            problems.append("%s: %d cells by %d" % (case, cells, processes))
for problem in problems:
    print(problem)
if problems:
    raise SystemExit(1)
print("passed")
