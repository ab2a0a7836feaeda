"""The main job on real CAD files: read, tessellate with a certified error, render, show.

Drives the vtknurbs tool on each file and leaves, in the output folder, a mesh (.vtp), a report
(.json) and a picture (.png) a file, and an index.html that shows them with the reports' figures.
`./run demo` calls it; by hand:

    /usr/bin/python3 Documentation/Examples/demo.py --tool build/release/bin/vtknurbs \\
        --output build/demo [FILE...]
"""

import argparse
import html
import json
import subprocess
import sys
import time
from pathlib import Path

# Debian's occt-misc.
DATA = Path("/usr/share/opencascade/data")
FILES = (
    DATA / "step/linkrods.step",
    DATA / "step/screw.step",
    DATA / "iges/hammer.iges",
    DATA / "occ/Ball.brep",
)

PAGE = """<!DOCTYPE html>
<html lang="en">
<meta charset="utf-8">
<title>vtkNURBS: demo</title>
<style>
  body {{ font: 16px/1.5 sans-serif; margin: 2rem auto; max-width: 75rem; padding: 0 1rem;
         color: #1d2733; }}
  section {{ display: flex; flex-wrap: wrap; gap: 1.5rem; margin: 2rem 0; }}
  img {{ flex: 2 1 30rem; max-width: 100%; border: 1px solid #d5dbe1; object-fit: contain; }}
  table {{ flex: 1 1 18rem; border-collapse: collapse; align-self: start; }}
  caption {{ text-align: left; font-size: 1.25rem; font-weight: bold; }}
  th {{ text-align: left; font-weight: normal; }}
  td {{ text-align: right; font-variant-numeric: tabular-nums; }}
  th, td {{ padding: .15rem .3rem; border-bottom: 1px solid #e6eaee; }}
  code {{ background: #f2f4f6; padding: .1rem .3rem; }}
</style>
<h1>vtkNURBS: from CAD file to mesh and picture</h1>
<p>Each CAD file was read as exact trimmed NURBS, tessellated so that no point of the mesh is farther
from the surface than the tolerance, and rendered offscreen through EGL.</p>
{sections}
</html>
"""


def figures(report):
    """What the page shows of a report: pairs of label and text."""
    seconds = report["seconds"]
    return [
        ("Faces", f"{report['faces']:,}"),
        ("Edges", f"{report['edges']:,}"),
        ("Triangles", f"{report['triangles']:,}"),
        ("Points", f"{report['points']:,}"),
        ("Tolerance", f"{report['tolerance']:.3g}"),
        ("Certified error", f"{report['certified_error']:.3g}"),
        ("Open edges", f"{report['open_edges']:,}"),
        ("Repaired faces", f"{report['repaired_faces']:,}"),
        ("Failed faces", f"{report['failed_faces']:,}"),
        ("Read", f"{seconds['read']:.3f} s"),
        ("Tessellate", f"{seconds['tessellate']:.3f} s"),
        ("Write", f"{seconds['write']:.3f} s"),
    ]


def section(file, name, report, picture_seconds):
    rows = figures(report) + [("File to picture", f"{picture_seconds:.2f} s")]
    cells = "".join(
        f"<tr><th>{html.escape(label)}</th><td>{html.escape(text)}</td></tr>\n"
        for label, text in rows
    )
    return (
        f'<section>\n<img src="{html.escape(name)}.png" alt="{html.escape(file.name)}">\n'
        f"<table>\n<caption>{html.escape(file.name)}</caption>\n{cells}"
        f'<tr><th>Mesh</th><td><a href="{html.escape(name)}.vtp">{html.escape(name)}.vtp</a></td>'
        "</tr>\n</table>\n</section>\n"
    )


def run(command):
    print(" ".join(map(str, command)), flush=True)
    started = time.perf_counter()
    subprocess.run(command, check=True)
    return time.perf_counter() - started


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--tool", required=True, type=Path, help="the vtknurbs executable")
    parser.add_argument("--output", required=True, type=Path, help="folder for what is made")
    parser.add_argument("files", nargs="*", type=Path, default=FILES, help="CAD files")
    arguments = parser.parse_args()
    arguments.output.mkdir(parents=True, exist_ok=True)

    sections = []
    for file in arguments.files:
        name = file.name.replace(".", "_")
        base = arguments.output / name
        report_file = base.with_suffix(".json")
        mesh, picture = base.with_suffix(".vtp"), base.with_suffix(".png")
        run([arguments.tool, "tessellate", file, "-o", mesh, "--report", report_file])
        picture_seconds = run(
            [arguments.tool, "render", file, "-o", picture]
            + ["--size", "1200x900", "--view", "iso", "--edges"]
        )
        report = json.loads(report_file.read_text(encoding="utf-8"))
        sections.append(section(file, name, report, picture_seconds))
    index = arguments.output / "index.html"
    index.write_text(PAGE.format(sections="".join(sections)), encoding="utf-8")
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"demo: {error}")
