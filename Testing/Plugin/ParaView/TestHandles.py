# SPDX-License-Identifier: BSD-3-Clause
"""Control points and lattice points dragged in the GUI's view: tables, trace, state, undo.

    pvpython TestHandles.py PLUGIN FOLDER PARAVIEW [PVSERVER]: with a server of its own, if given.
"""
import os
import re
import shutil
import socket
import subprocess
import sys

from paraview import simple
from session import FOLDER, PLUGIN, load_plugin, updated

HERE = os.path.dirname(os.path.abspath(__file__))
OUT = os.path.join(FOLDER, "handles-server" if len(sys.argv) > 4 else "handles")
PIXEL = 2.0 / 400  # Of the view, in its own units, if it is at least 400 pixels high.


def near(rows, expected):
    """Indices equal, displacements within a few pixels."""
    print("  ", rows)
    return len(rows) == len(expected) and all(
        abs(a - b) <= (4 * PIXEL if n >= len(rows) - 3 else 0.0)
        for n, (a, b) in enumerate(zip(rows, expected))
    )


def play(arguments):
    environment = dict(
        os.environ,
        HOME=OUT,
        XDG_CONFIG_HOME=OUT,
        XDG_RUNTIME_DIR=OUT,
        NURBS_HANDLES=OUT,
    )
    command = [sys.argv[3], "--dr", "--plugins=NURBS", "--test-directory=" + OUT]
    command += ["--plugin-search-paths=" + os.path.dirname(PLUGIN)] + arguments
    command += ["--script=" + os.path.join(HERE, "handles_start.py")]
    command += ["--test-script=" + os.path.join(HERE, "handles.xml"), "--exit"]
    done = subprocess.run(
        command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=280
    )
    text = done.stdout.decode(errors="replace")
    print(text)
    assert "Success =  true" in text and "caught a signal" not in text


def serve_and_play():
    with socket.socket() as free:
        free.bind(("localhost", 0))
        port = free.getsockname()[1]
    command = ["timeout", "280", sys.argv[4], "--server-port=%d" % port, "--plugins=NURBS"]
    command += ["--plugin-search-paths=" + os.path.dirname(PLUGIN)]
    server = subprocess.Popen(command, stdout=subprocess.PIPE, universal_newlines=True)
    try:
        for line in server.stdout:
            if "Accepting connection" in line:
                break
        play(["--server-url=cs://localhost:%d" % port])
    finally:
        server.kill()


shutil.rmtree(OUT, ignore_errors=True)
os.makedirs(OUT, mode=0o700)
if len(sys.argv) > 4:
    serve_and_play()
else:
    play([])

with open(os.path.join(OUT, "trace.py")) as file:
    trace = file.read()
moves = [eval(rows) for rows in re.findall(r"edits\.Moves = (.*)", trace)]
# handles.xml: up and undone, right, then up from there.
for rows, (dx, dy) in zip(moves, [(0.0, 0.5), (None, 0.0), (None, 0.2)]):
    assert near(rows, [0, 294, rows[2] if dx is None else dx, dy, 0.0]), rows
assert len(moves) == 3 and moves[1][2] > 0.1 and abs(moves[1][2] - moves[2][2]) < 1e-12, moves
lattice = [eval(rows) for rows in re.findall(r"bent\.LatticeMoves = (.*)", trace)]
assert len(lattice) == 1 and near(lattice[0], [1, 1, 2, 0.0, 0.3, 0.0]), lattice

load_plugin()
simple.LoadState(os.path.join(OUT, "handles.pvsm"))
edits, bent = (updated(simple.FindSource(name)) for name in ("edits", "bent"))
assert list(edits.Moves) == moves[2] and list(bent.LatticeMoves) == lattice[0]
assert edits.NumberOfEdits == 1 and bent.NumberOfMovedPoints > 100
print("passed")
