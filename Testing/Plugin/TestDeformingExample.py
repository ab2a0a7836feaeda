"""Runs Documentation/Examples/deforming.py with few frames and looks at what it drew."""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image, ImageChops

FRAMES = 5
script = sys.argv[1:]  # and the CAD file

with tempfile.TemporaryDirectory() as folder:
    command = [sys.executable, *script[:1], folder, *script[1:], "--frames", str(FRAMES)]
    output = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    for name, least, most in (("sheet", 0.3, 0.7), ("lattice", 0.1, 0.6)):
        files = sorted(Path(folder).glob(f"{name}-*.png"))
        pictures = [Image.open(file).convert("RGB") for file in files]
        assert len(pictures) == FRAMES, pictures
        white = Image.new("RGB", pictures[0].size, "white")
        for k, picture in enumerate(pictures):
            apart = ImageChops.difference(picture, white).convert("L").histogram()
            covered = 1 - apart[0] / sum(apart)
            assert least < covered < most, (name, k, covered)
            other = pictures[(k + 1) % FRAMES]
            changed = ImageChops.difference(picture, other).convert("L").histogram()
            assert sum(changed[16:]) > 200, (name, k, sum(changed[16:]))
        with Image.open(Path(folder) / f"{name}.gif") as animation:
            assert animation.n_frames == FRAMES, animation.n_frames
        figures = re.findall(rf"^{name} \d+: (\d+) triangles, (\d+) .* at most (\S+) of (\S+)$",
                             output, re.M)  # fmt: skip
        assert len(figures) == FRAMES, output
        assert len({triangles for triangles, *_ in figures}) > 1, figures
        assert any(int(inserted) > 0 for _, inserted, *_ in figures[1:]), figures
        if name == "sheet":  # one face: nothing but the tolerance bounds the error
            assert all(float(bound) <= float(asked) for *_, bound, asked in figures), figures
            # Flat at rest; where it is pulled farthest it takes more than twice the triangles.
            assert int(figures[1][0]) > 2 * int(figures[0][0]), figures
print("deforming: pictures, animations and figures agree")
