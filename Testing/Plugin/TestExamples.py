"""Runs an example of Documentation/Examples: its figures, its pictures, its place in the index.

    TestExamples.py NAME FOLDER     NAME is that of FOLDER/NAME.py
"""

import ast
import base64
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree
from pathlib import Path

import numpy as np
from PIL import Image
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

import vtknurbs

NUMBER = r"(-?\d+(?:\.\d+)?(?:e[-+]\d+)?)"
LINKRODS = "/usr/share/opencascade/data/step/linkrods.step"


def figures(pattern, output):
    """The numbers in `output` where `pattern` has #, of every line that it describes."""
    pattern = re.escape(pattern).replace(r"\#", NUMBER)
    found = [[float(value) for value in match.groups()]
             for match in re.finditer(f"(?m)^{pattern}$", output)]  # fmt: skip
    assert found, f"no line '{pattern}' in:\n{output}"
    return found


def linkrods():
    reader = vtknurbs.vtkNURBSCADReader()
    reader.SetFileName(LINKRODS)
    reader.Update()
    return vtknurbs.models(reader.GetOutputDataObject(0))[0]


def mesh_of(model, tolerance=1e-4):
    mesher = vtknurbs.vtkNURBSTessellator()
    mesher.SetInputData(model)
    mesher.SetTolerance(tolerance)
    mesher.Update()
    return mesher.GetOutputDataObject(0)


def area(model, tolerance=1e-4):
    """Of all triangles of a model's mesh, face by face."""
    mesh = mesh_of(model, tolerance)
    areas = np.zeros(model.GetNumberOfCells())
    faces = mesh.GetCellData().GetArray("FaceId")
    for cell in range(mesh.GetNumberOfCells()):
        areas[int(faces.GetValue(cell))] += mesh.GetCell(cell).ComputeArea()
    return areas


def check_cad_to_mesh(output):
    ((triangles, faces, certified, asked),) = figures(
        "# triangles of # faces; certified to # mm, asked for # mm", output)  # fmt: skip
    assert faces == linkrods().GetNumberOfCells() == 37
    assert 0 < certified <= asked, (certified, asked)
    assert figures("# open edges", output) == [[0]]
    reader = vtkXMLPolyDataReader()
    reader.SetFileName("cad_to_mesh.vtp")
    reader.Update()
    assert reader.GetOutput().GetNumberOfPolys() == triangles > 1000
    # The coarse mesh has the area of a fine one but for what its bound allows.
    coarse = sum(reader.GetOutput().GetCell(i).ComputeArea() for i in range(int(triangles)))
    assert abs(coarse / area(linkrods()).sum() - 1) < 0.02


def check_gpu_view(output):
    triangles, error = re.search(f"^{NUMBER} triangles drawn by .+, at most {NUMBER} pixels", output).groups()
    assert int(triangles) > 1000 and 0 < float(error) <= 0.5, output
    # 32 faces of 16 control points; the mesh would be hundreds of kilobytes.
    assert 32 * 16 * 4 * 4 <= figures("# bytes were sent to the GPU", output)[0][0] < 40000
    zebra = np.asarray(Image.open("gpu_view_zebra.png").convert("L"))
    assert 0.1 < np.mean(zebra < 60) < 0.4, "no stripes"


def check_curvature(output):
    ((least, a, largest, b),) = figures("principal curvatures from # (face #) to # (face #)", output)
    source = vtknurbs.vtkNURBSShapeSource()
    source.SetShapeToTeapot()
    source.Update()
    evaluator = vtknurbs.Evaluator(source.GetOutput())
    line = np.linspace(0.05, 0.95, 40)
    uv = np.stack(np.meshgrid(line, line), -1)
    h = 1e-5
    for face, value, pick in ((int(a), least, np.min), (int(b), largest, np.max)):
        # Rodrigues: principal curvatures are the eigenvalues of what the normal does, by differences.
        tangents = evaluator.derivatives(face, uv)[..., 1:, :]
        turns = np.stack([evaluator.normals(face, uv + step) - evaluator.normals(face, uv - step)
                          for step in ((h, 0), (0, h))], -2) / (2 * h)  # fmt: skip
        metric = tangents @ tangents.swapaxes(-1, -2)
        shape = np.linalg.solve(metric, tangents @ turns.swapaxes(-1, -2))
        reference = pick(np.linalg.eigvals(shape).real)
        assert math.isclose(reference, value, rel_tol=1e-3), (reference, value)


def check_displacement_field(output):
    ((before, after),) = figures("lowest point: #, bent: #", output)
    x0, x1, _, _, z0, _ = mesh_of(linkrods()).GetBounds()
    assert abs(before - z0) < 1e-3
    assert math.isclose(after, z0 - 0.15 * (x1 - x0), rel_tol=0.03), (after, x1 - x0)


def check_silhouettes(output):
    assert figures("# edges", output)[0][0] > 0 and figures("# silhouettes", output)[0][0] > 0
    picture = np.asarray(Image.open("silhouettes.png").convert("RGB")).astype(int)
    red = np.sum((picture[..., 0] > 150) & (picture[..., 1:].max(-1) < 90))
    blue = np.sum((picture[..., 2] > 90) & (picture[..., :2].max(-1) < 80))
    assert red > 1000 and blue > 300, (red, blue)


def check_drawing(output):
    pattern = ("# of # lines are visible; # paths of # curves and # straight lines, with the hidden ones")
    ((visible, lines, paths, curves, straight),) = figures(pattern, output)
    assert 0 < visible < lines and curves > 0 and straight > 0
    layers = {layer.get("id"): layer for layer in xml.etree.ElementTree.parse("drawing.svg").iter()}
    assert len(list(layers["visible"].iter("{http://www.w3.org/2000/svg}path"))) == paths
    assert len(list(layers["hidden"].iter("{http://www.w3.org/2000/svg}path"))) > 0
    assert Path("drawing.pdf").read_bytes().startswith(b"%PDF-")


def check_visible_regions(output):
    ((whole, faces, part, seen),) = figures("# of # faces are visible, # in part, # mm2", output)
    assert faces == 37 and whole > 0 and part > 0 and whole + part < faces
    total = area(linkrods()).sum()
    assert 0.3 * total < seen < 0.5 * total, (seen, total)  # not the back, nor what is hidden
    assert figures("# triangles, certified to # mm", output)[0][0] > 500


def check_bezier_cells(output):
    assert figures("# cells; the field is off by #", output)[0][0] == 16
    assert figures("# cells; the field is off by #", output)[0][1] < 1e-6  # single precision
    assert figures("# surfaces again, joined at their sides", output) == [[16]]


def check_level_of_detail(output):
    levels = figures("# triangles of at most #, within #; evaluated: True", output)
    assert len(levels) == 1, "evaluated more than once"
    levels += figures("# triangles of at most #, within #; evaluated: False", output)
    assert len(levels) == 3
    for triangles, budget, _ in levels:
        assert 0.8 * budget < triangles <= budget, (triangles, budget)
    assert levels[0][2] < levels[1][2] < levels[2][2], "coarser, and closer?"


def check_threshold_faces(output):
    ((kept, faces),) = figures("# of # faces have at least 0.5 square mm; the model is sound", output)
    areas = area(linkrods(), 1e-3)
    assert (kept, faces) == (np.sum(areas >= 0.5), len(areas)), (kept, faces, areas)


def check_numpy_surfaces(output):
    ((measured, exact),) = figures("hole: # of the domain, exactly #", output)
    assert abs(measured - 0.04 * math.pi) < 0.004 and abs(exact - 0.04 * math.pi) < 0.001
    assert figures("tube: radius 1 within #", output)[0][0] < 1e-14
    assert "sheet (3, 3) (9, 7, 3) 2 loops" in output


def check_control_net(output):
    lines, points = figures("# lines of the net; # control points", output)[0]
    sizes = [(nu, points / nu) for nu in range(2, int(points)) if points % nu == 0]
    assert lines in [nu + nv for nu, nv in sizes], (lines, points)  # a line a row and a column


def check_control_points(output):
    ((point, *moved),) = figures("moved # by (#, #, #)", output)
    assert point == 69 and np.allclose(moved, (0.8205, -0.2269, -1.0691), atol=2e-3), moved
    assert figures("# edits are left, # can be made again", output) == [[0, 1]]


def check_following_mesh(output):
    frames = figures("# triangles, # new points, error # of #", output)
    assert len(frames) == Image.open("following_mesh.gif").n_frames == 24
    assert all(error <= tolerance for *_, error, tolerance in frames), frames
    # Flat at rest; where it is pulled farthest it takes more than twice the triangles.
    assert frames[6][0] > 2 * frames[0][0] and any(inserted for _, inserted, *_ in frames[1:])


def check_free_form(output):
    frames = figures("# control points moved, # triangles, # models meshed anew", output)
    assert len(frames) == Image.open("free_form.gif").n_frames == 24
    assert all(moved > 1000 and triangles > 1000 for moved, triangles, _ in frames)
    assert sum(anew for *_, anew in frames) == 0, "the mesh was not followed"


def check_overview(output):
    triangles, visible = figures("# triangles, # faces visible", output)[0]
    assert triangles > 1000 and 0 < visible < 37
    for column in np.split(np.asarray(Image.open("overview.png").convert("L")), 4, 1):
        assert 0.01 < np.mean(column < 250) < 0.6


def check_parallel(output):
    runs = figures("# thread(s): # triangles in # s", output)
    assert [threads for threads, *_ in runs] == [1, 2] and runs[0][1] == runs[1][1] > 2 * 2000
    assert "the same, bit for bit: True" in output


def check_gltf(output):
    ((parts, triangles),) = figures("# part(s), # triangles", output)
    document = json.loads(Path("gltf.gltf").read_text(encoding="utf-8"))
    assert document["asset"]["version"] == "2.0"
    for buffer in document["buffers"]:
        assert len(base64.b64decode(buffer["uri"].split(",")[1])) == buffer["byteLength"]
    accessors, primitives = document["accessors"], [p for m in document["meshes"] for p in m["primitives"]]
    assert sum(accessors[p["indices"]]["count"] for p in primitives) == 3 * triangles
    placed = [node for node in document["nodes"] if "mesh" in node]
    assert len(placed) == parts == 1
    accessor = accessors[primitives[0]["attributes"]["POSITION"]]
    bounds = np.reshape(mesh_of(linkrods()).GetBounds(), (3, 2))
    np.testing.assert_allclose([accessor["min"], accessor["max"]], bounds.T, atol=0.01)
    matrix = np.reshape(placed[0]["matrix"], (4, 4)).T  # glTF's are column by column
    np.testing.assert_allclose(matrix @ [0, 0, 1000, 1], [0, 1, 0, 1], atol=1e-9)


def check_text(name, folder):
    """The rules that all examples keep, and the index."""
    text = (folder / (name + ".py")).read_text(encoding="utf-8")
    lines = text.splitlines()
    assert len(lines) <= 40 and max(map(len, lines)) <= 100, (len(lines), max(map(len, lines)))
    sentence = ast.get_docstring(ast.parse(text)).splitlines()[0]
    index = (folder / "README.md").read_text(encoding="utf-8")
    assert f"## [{name}.py]({name}.py)\n\n{sentence}\n\n![{name}](images/{name}" in index, "index"


def check_pictures(name, folder):
    """What was drawn is what the index shows, but for what drivers do differently."""
    made = sorted(Path().glob("*.png")) + sorted(Path().glob("*.gif"))
    kept = sorted(file.name for file in (folder / "images").iterdir() if re.match(name + r"[._]", file.name))
    assert sorted(file.name for file in made) == kept != [], (made, kept)
    for file in made:
        with Image.open(file) as new, Image.open(folder / "images" / file.name) as old:
            assert new.size == old.size, (file, new.size, old.size)
            pictures = [np.asarray(image.convert("RGB")).astype(int) for image in (new, old)]
        differ = np.mean(np.abs(pictures[0] - pictures[1]).max(-1) > 48)
        assert differ < 0.02, f"{differ:.1%} of {file}'s pixels differ from the picture in the index"


def main():
    name, folder = sys.argv[1], Path(sys.argv[2]).resolve()
    check_text(name, folder)
    with tempfile.TemporaryDirectory() as scratch:
        os.chdir(scratch)
        run = subprocess.run([sys.executable, folder / (name + ".py")], text=True, check=False,
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT)  # fmt: skip
        print(run.stdout)
        assert run.returncode == 0, run.returncode
        assert "ERR|" not in run.stdout and "WARN|" not in run.stdout
        globals()["check_" + name](run.stdout)
        check_pictures(name, folder)
        os.chdir(folder)


if __name__ == "__main__":
    main()
