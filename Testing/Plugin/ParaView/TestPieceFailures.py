# SPDX-License-Identifier: BSD-3-Clause
"""Nobody waits for a process that failed, and all say the same: pieceFailures.py on 2 and 4 processes.

Run as `python3 TestPieceFailures.py MPIRUN PVBATCH PLUGIN FOLDER SOURCE`; SOURCE is not looked at.
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
    command = ["timeout", "200", MPIRUN, "--allow-run-as-root", "--oversubscribe"]
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


for processes in (2, 4):
    found = run(processes)
    name = "process %d: " % (processes - 1)
    for case in found[0]:
        print(processes, case)
        for rank, what in enumerate(found):
            print("  ", rank, what[case]["cells"], what[case]["said"].replace("\n", "\n      "))
