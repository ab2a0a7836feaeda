# SPDX-License-Identifier: BSD-3-Clause
"""Two and four processes draw together what one draws alone.

Run as `python3 TestPiecePictures.py MPIRUN PVBATCH PLUGIN FOLDER SOURCE`; see piecePictures.py.
"""
import os
import shutil
import subprocess
import sys

from PIL import Image, ImageChops

MPIRUN, PVBATCH, PLUGIN, FOLDER, SOURCE = sys.argv[1:6]
SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "piecePictures.py")
NAMES = ("surface", "edges", "ids", "curvature", "translucent", "mesh", "lines")
# Pixels that may differ by more than LIMIT of 255: compositing rounds depths, and lines of the same
# depth come in another order.
LIMIT = 3
PIXELS = {"edges": 20, "lines": 20}
# Translucent faces are blended process by process: where those of two lie behind each other alternately
# they come in another order. Of the pixels drawn that are some, by some shade.
TRANSLUCENT = 0.02, 64


def run(ranks):
    folder = os.path.join(FOLDER, str(ranks))
    shutil.rmtree(folder, ignore_errors=True)
    command = [MPIRUN, "--allow-run-as-root", "--oversubscribe", "-np", str(ranks)]
    command += [PVBATCH, "--symmetric", SCRIPT, PLUGIN, folder, SOURCE]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0 or "Traceback" in done.stdout or "ERR|" in done.stdout:
        print(done.stdout)
        raise SystemExit("%d processes failed" % ranks)
    return {n: Image.open(os.path.join(folder, n + ".png")).convert("RGB") for n in NAMES}


alone = run(1)
failed = False
DRAWN = {}
for name, image in alone.items():
    drawn = sum(1 for p in image.getdata() if p != (255, 255, 255))
    print("%-12s %6d pixels drawn by one process" % (name, drawn))
    DRAWN[name] = drawn
    failed = failed or drawn < 200
for processes in (2, 4):
    for name, image in run(processes).items():
        difference = ImageChops.difference(alone[name], image)
        off = sum(1 for pixel in difference.getdata() if max(pixel) > LIMIT)
        most = max(max(pixel) for pixel in difference.getdata())
        print("%d processes, %-12s %5d pixels differ, by %d" % (processes, name, off, most))
        if name == "translucent":
            share, shade = TRANSLUCENT
            failed = failed or off > share * DRAWN[name] or most > shade
        else:
            failed = failed or off > PIXELS.get(name, 10)
if failed:
    raise SystemExit(1)
print("passed")
