"""Runs Documentation/Examples/demo.py on one CAD file and reads what it left."""

import argparse
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

parser = argparse.ArgumentParser()
parser.add_argument("demo")
parser.add_argument("tool")
parser.add_argument("file", type=Path)
arguments = parser.parse_args()

with tempfile.TemporaryDirectory() as folder:
    subprocess.run(
        [sys.executable, arguments.demo, "--tool", arguments.tool, "--output", folder]
        + [str(arguments.file)],
        check=True,
    )
    output = Path(folder)
    page = (output / "index.html").read_text(encoding="utf-8")
    linked = re.findall(r'(?:src|href)="([^"]+)"', page)
    assert len(linked) == 2, linked
    for name in linked:
        assert (output / name).stat().st_size > 1000, name
    (report_file,) = output.glob("*.json")
    report = json.loads(report_file.read_text(encoding="utf-8"))
    assert report["triangles"] > 0 and f"<td>{report['triangles']:,}</td>" in page
    assert 0 < report["certified_error"] <= report["tolerance"], report
    assert report["failed_faces"] == 0 and report["open_edges"] == 0, report
print("demo: page, mesh, picture and report agree")
