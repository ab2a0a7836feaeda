"""Runs the vtknurbs tool: meshes and pictures of Debian's CAD files read back, and bad input."""

import argparse
import json
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from xml.etree import ElementTree

from vtkmodules.vtkCommonCore import vtkVersion
from vtkmodules.vtkFiltersCore import vtkCleanPolyData, vtkFeatureEdges, vtkMassProperties
from vtkmodules.vtkImagingCore import vtkImageDifference
from vtkmodules.vtkIOGeometry import vtkGLTFReader, vtkOBJReader, vtkSTLReader
from vtkmodules.vtkIOImage import vtkPNGReader
from vtkmodules.vtkIOPLY import vtkPLYReader
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

DATA = Path("/usr/share/opencascade/data")
SCREW = DATA / "step/screw.step"
LINKRODS = DATA / "step/linkrods.step"
BALL = DATA / "occ/Ball.brep"
SVG = "{http://www.w3.org/2000/svg}"
VTK_VERSION = (vtkVersion.GetVTKMajorVersion(), vtkVersion.GetVTKMinorVersion())
FIELDS = {
    "file": str,
    "faces": int,
    "edges": int,
    "triangles": int,
    "points": int,
    "tolerance": float,
    "certified_error": float,
    "open_edges": int,
    "failed_faces": int,
    "repaired_faces": int,
    "seconds": dict,
}


def tool(*arguments, code=0, **options):
    """Runs the tool, checks what it returns, gives (standard output, standard error)."""
    done = subprocess.run(
        [TOOL, *map(str, arguments)], capture_output=True, text=True, timeout=100, **options
    )
    assert done.returncode == code, (arguments, done.returncode, done.stdout, done.stderr)
    return done.stdout, done.stderr


def read(reader, path):
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def diagonal(mesh):
    bounds = mesh.GetBounds()
    return sum((bounds[2 * i + 1] - bounds[2 * i]) ** 2 for i in range(3)) ** 0.5


def open_edges(mesh):
    """Boundary edges once points of equal coordinates are one, as VTK counts them."""
    clean = vtkCleanPolyData()
    clean.SetInputData(mesh)
    clean.ToleranceIsAbsoluteOn()
    clean.SetAbsoluteTolerance(0.0)
    clean.ConvertPolysToLinesOff()
    edges = vtkFeatureEdges()
    edges.SetInputConnection(clean.GetOutputPort())
    edges.BoundaryEdgesOn()
    edges.FeatureEdgesOff()
    edges.NonManifoldEdgesOff()
    edges.ManifoldEdgesOff()
    edges.Update()
    return edges.GetOutput().GetNumberOfCells()


def parse_glb(path):
    """The JSON and the buffer of a .glb, its container checked (glTF 2.0, section 4.4)."""
    data = path.read_bytes()
    magic, version, length = struct.unpack_from("<4sII", data, 0)
    assert (magic, version, length) == (b"glTF", 2, len(data)), (magic, version, length)
    size, kind = struct.unpack_from("<I4s", data, 12)
    assert kind == b"JSON" and size % 4 == 0
    scene = json.loads(data[20 : 20 + size])
    binary_size, kind = struct.unpack_from("<I4s", data, 20 + size)
    assert kind == b"BIN\0" and binary_size % 4 == 0 and 28 + size + binary_size == length
    return scene, data[28 + size :]


class Folder(unittest.TestCase):
    """A test with a folder of its own."""

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def fails(self, *arguments, says, code=1):
        """The tool fails with one line that matches, and leaves no file."""
        before = set(self.folder.iterdir())
        out, err = tool(*arguments, code=code)
        self.assertEqual(out, "")
        self.assertRegex(err, says)
        lines = [line for line in err.splitlines() if not re.search("warning:|^libpng", line)]
        self.assertTrue(lines[0].startswith("vtknurbs: "), err)
        self.assertEqual(len(lines), 1 if code == 1 else 2, err)
        self.assertLessEqual(set(self.folder.iterdir()), before)


class Help(unittest.TestCase):
    def test_help_shows_commands_and_examples(self):
        out, err = tool("--help")
        self.assertEqual(err, "")
        commands = ("info", "tessellate", "render", "drawing", "visible", "convert")
        for word in (*commands, "Examples:", "Usage: vtknurbs COMMAND"):
            self.assertIn(word, out)
        for command in commands:
            text, _ = tool(command, "--help")
            self.assertIn(f"Usage: vtknurbs {command} MODEL", text)
            self.assertLess(max(map(len, text.splitlines())), 101)

    def test_version(self):
        self.assertRegex(tool("--version")[0], r"^vtknurbs \d+\.\d+\.\d+\n$")


class Info(Folder):
    def test_counts(self):
        report = self.folder / "r.json"
        out, _ = tool("info", LINKRODS, "--report", report)
        figures = json.loads(report.read_text())
        self.assertEqual(figures["faces"], 37)
        self.assertRegex(out, r"Faces +37\b")
        self.assertIn(f"{figures['edges']:,}", out)
        self.assertRegex(out, r"Unit +mm")
        self.assertIn("linkrods", out)
        self.assertNotIn("triangles", figures)
        self.assertIn("read", figures["seconds"])

    def test_units(self):
        sizes = []
        for unit in ("mm", "m"):
            out, _ = tool("info", SCREW, "--unit", unit)
            size = re.search(r"Size +(\S+) x (\S+) x (\S+) (\S+)", out)
            self.assertEqual(size[4], unit)
            sizes.append(float(size[1]))
        self.assertAlmostEqual(sizes[0] / sizes[1], 1000, delta=0.1)

    def test_quiet(self):
        self.assertEqual(tool("info", SCREW, "--quiet"), ("", ""))


class Tessellate(Folder):
    def run_to(self, ending, *options, model=SCREW):
        mesh, report = self.folder / f"mesh{ending}", self.folder / "report.json"
        tool("tessellate", model, "-o", mesh, "--report", report, "--quiet", *options)
        return mesh, json.loads(report.read_text())

    def test_report_is_true(self):
        for model in (SCREW, LINKRODS, BALL, DATA / "iges/hammer.iges"):
            with self.subTest(model.name):
                path, report = self.run_to(".vtp", model=model)
                mesh = read(vtkXMLPolyDataReader(), path)
                for name, kind in FIELDS.items():
                    self.assertIsInstance(report[name], kind, name)
                self.assertEqual(report["file"], str(model))
                self.assertEqual(report["triangles"], mesh.GetNumberOfPolys())
                self.assertEqual(mesh.GetNumberOfCells(), mesh.GetNumberOfPolys())
                self.assertEqual(report["points"], mesh.GetNumberOfPoints())
                self.assertEqual(report["open_edges"], open_edges(mesh))
                if report["capped_faces"] == 0:
                    self.assertLessEqual(report["certified_error"], report["tolerance"])
                self.assertGreater(report["certified_error"], 0)
                self.assertAlmostEqual(report["tolerance"] / diagonal(mesh), 1e-3, delta=5e-4)
                self.assertEqual(set(report["seconds"]), {"read", "tessellate", "write"})
                faces = mesh.GetCellData().GetArray("FaceId")
                ids = {faces.GetTuple1(i) for i in range(faces.GetNumberOfTuples())}
                self.assertEqual(len(ids), report["faces"] - report["failed_faces"])

    def test_formats_hold_the_same_triangles(self):
        path, report = self.run_to(".vtp")
        reference = read(vtkXMLPolyDataReader(), path)
        readers = {
            ".vtu": vtkXMLUnstructuredGridReader,
            ".stl": vtkSTLReader,
            ".ply": vtkPLYReader,
            ".obj": vtkOBJReader,
        }
        for ending, reader in readers.items():
            with self.subTest(ending):
                path, other = self.run_to(ending)
                mesh = read(reader(), path)
                self.assertEqual(mesh.GetNumberOfCells(), report["triangles"])
                self.assertEqual(other["triangles"], report["triangles"])
                for a, b in zip(mesh.GetBounds(), reference.GetBounds()):
                    self.assertAlmostEqual(a, b, delta=1e-5 * diagonal(reference))
                if ending != ".stl":
                    self.assertEqual(mesh.GetNumberOfPoints(), report["points"])
                if ending not in (".stl", ".ply") or VTK_VERSION >= (9, 2):
                    self.assertEqual(
                        mesh.GetPointData().GetNormals() is None, ending == ".stl", ending
                    )

    def test_glb_is_valid(self):
        path, report = self.run_to(".glb", model=BALL)
        scene, binary = parse_glb(path)
        self.assertEqual(scene["asset"]["version"], "2.0")
        self.assertEqual(scene["buffers"], [{"byteLength": len(binary)}])
        for view in scene["bufferViews"]:
            self.assertLessEqual(view.get("byteOffset", 0) + view["byteLength"], len(binary))
        triangles = 0
        for mesh in scene["meshes"]:
            self.assertTrue(mesh["name"])
            for primitive in mesh["primitives"]:
                self.assertLess(primitive["material"], len(scene["materials"]))
                triangles += self.check_primitive(scene, binary, primitive)
        self.assertEqual(triangles, report["triangles"])
        reader = vtkGLTFReader()
        reader.SetFileName(str(path))
        reader.Update()
        geometry = reader.GetOutput()
        self.assertGreater(geometry.GetNumberOfPoints(), 0)
        self.assertEqual(geometry.GetNumberOfCells(), report["triangles"])

    def check_primitive(self, scene, binary, primitive):
        def values(index):
            accessor = scene["accessors"][index]
            view = scene["bufferViews"][accessor["bufferView"]]
            count = accessor["count"] * {"SCALAR": 1, "VEC3": 3}[accessor["type"]]
            code = {5125: "I", 5126: "f"}[accessor["componentType"]]
            self.assertEqual(view["byteLength"], 4 * count)
            return accessor, struct.unpack_from(f"<{count}{code}", binary, view.get("byteOffset", 0))

        accessor, points = values(primitive["attributes"]["POSITION"])
        for axis in range(3):
            self.assertEqual(accessor["min"][axis], min(points[axis::3]))
            self.assertEqual(accessor["max"][axis], max(points[axis::3]))
        _, normals = values(primitive["attributes"]["NORMAL"])
        self.assertEqual(len(normals), len(points))
        for i in range(0, len(normals), 3):
            self.assertAlmostEqual(sum(c * c for c in normals[i : i + 3]), 1.0, places=5)
        _, indices = values(primitive["indices"])
        self.assertEqual(sorted(set(indices)), list(range(len(points) // 3)))
        return len(indices) // 3

    def test_glb_is_in_metres_with_y_up(self):
        self.run_to(".glb")
        scene, _ = parse_glb(self.folder / "mesh.glb")
        root = scene["nodes"][scene["scenes"][0]["nodes"][0]]
        self.assertEqual(root["scale"], [0.001] * 3)
        x, y, z, w = root["rotation"]
        up = (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y))  # of (0, 0, 1)
        for got, wanted in zip(up, (0, 1, 0)):
            self.assertAlmostEqual(got, wanted, places=12)

    def test_tolerance_options(self):
        _, coarse = self.run_to(".stl", "--tolerance", "1e-2")
        _, fine = self.run_to(".stl", "--tolerance", "1e-4")
        self.assertAlmostEqual(coarse["tolerance"] / fine["tolerance"], 100)
        self.assertGreater(fine["triangles"], coarse["triangles"])
        _, absolute = self.run_to(".stl", "--absolute", "0.25")
        self.assertEqual(absolute["tolerance"], 0.25)

    def test_methods_and_errors(self):
        counts = {}
        for method in ("kd-tree", "quadtree", "binary"):
            for error in ("guaranteed", "estimated"):
                _, report = self.run_to(".stl", "--method", method, "--error", error, model=BALL)
                counts[method, error] = report["triangles"]
                self.assertEqual(report["guaranteed"], error == "guaranteed")
        self.assertGreater(len(set(counts.values())), 2, counts)
        self.assertLess(counts["kd-tree", "estimated"], counts["kd-tree", "guaranteed"])

    def test_threads_change_nothing(self):
        meshes = []
        for threads in (1, 2):
            path, _ = self.run_to(".stl", "--threads", threads, model=BALL)
            meshes.append(path.read_bytes())
        self.assertEqual(*meshes)

    def test_merge_shares_points(self):
        _, apart = self.run_to(".ply", model=BALL)
        _, merged = self.run_to(".ply", "--merge", model=BALL)
        self.assertLess(merged["points"], apart["points"])
        self.assertLessEqual(merged["triangles"], apart["triangles"])
        self.assertEqual(merged["open_edges"], apart["open_edges"])

    def test_rounding_to_floats_is_told(self):
        _, err = tool("tessellate", SCREW, "-o", self.folder / "m.stl", "--absolute", "1e-5")
        self.assertRegex(err, r"vtknurbs: warning: \.stl keeps 32-bit coordinates")
        _, err = tool("tessellate", SCREW, "-o", self.folder / "m.stl")
        self.assertEqual(err, "")

    def test_saved_model(self):
        from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

        import vtknurbs

        source = vtknurbs.vtkNURBSShapeSource()
        source.SetShapeToTorus()
        writer = vtkXMLUnstructuredGridWriter()
        writer.SetDataModeToBinary()
        writer.SetInputConnection(source.GetOutputPort())
        model = self.folder / "torus.vtu"
        writer.SetFileName(str(model))
        self.assertTrue(writer.Write())
        _, report = self.run_to(".vtp", model=model)
        self.assertEqual((report["faces"], report["open_edges"]), (1, 0))


class Render(Folder):
    def picture(self, *options, model=SCREW):
        path = self.folder / "p.png"
        tool("render", model, "-o", path, "--quiet", *options)
        return read(vtkPNGReader(), path)

    @staticmethod
    def pixels(image):
        width, height, _ = image.GetDimensions()
        scalars = image.GetPointData().GetScalars()
        return width, height, [scalars.GetTuple(i) for i in range(width * height)]

    def test_size_and_content(self):
        image = self.picture("--size", "320x240", "--transparent")
        width, height, pixels = self.pixels(image)
        self.assertEqual((width, height), (320, 240))
        solid = [i for i, pixel in enumerate(pixels) if pixel[3] == 255]
        # The view is fitted: the model comes close to two opposite sides of the picture.
        rows, columns = {i // width for i in solid}, {i % width for i in solid}
        spread = max(len(rows) / height, len(columns) / width)
        self.assertGreater(spread, 0.9)
        self.assertLess(spread, 0.97)
        self.assertEqual(pixels[0][3], 0)

    def test_looks_as_it_did(self):
        image = self.picture("--size", "320x240", "--tolerance", "1e-4")
        baseline = read(vtkPNGReader(), BASELINES / "CommandLineScrew.png")
        difference = vtkImageDifference()
        difference.SetInputData(image)
        difference.SetImageData(baseline)
        difference.SetThreshold(16)
        difference.Update()
        self.assertLess(difference.GetThresholdedError(), 50)

    def test_views_differ(self):
        seen = set()
        for view in ("iso", "front", "top", "right", "0.3,-1,0.2"):
            _, _, pixels = self.pixels(self.picture("--size", "64x48", "--view", view))
            seen.add(tuple(pixels))
        self.assertGreaterEqual(len(seen), 4)  # front and right of a screw may be alike

    def test_edges_are_dark_lines(self):
        def dark(*options):
            _, _, pixels = self.pixels(self.picture("--size", "320x240", *options, model=BALL))
            return sum(max(pixel[:3]) < 60 for pixel in pixels)

        self.assertGreater(dark("--edges"), dark() + 100)

    def test_finer_pixels_need_more_triangles(self):
        counts = []
        for pixels in ("4", "0.05"):
            report = self.folder / "r.json"
            self.picture("--pixels", pixels, "--report", report)
            counts.append(json.loads(report.read_text())["triangles"])
        self.assertGreater(counts[1], 2 * counts[0])

    def test_no_driver_is_told(self):
        environment = dict(os.environ, __EGL_VENDOR_LIBRARY_DIRS="/nonexistent")
        path = self.folder / "p.png"
        _, err = tool("render", SCREW, "-o", path, code=1, env=environment)
        self.assertRegex(err, r"^vtknurbs: cannot draw: no OpenGL .*Install an EGL driver.*\n$")
        self.assertFalse(path.exists())


class Drawing(Folder):
    def run_to(self, name, *options, model=SCREW, command="drawing"):
        path, report = self.folder / name, self.folder / "report.json"
        tool(command, model, "-o", path, "--report", report, "--quiet", *options)
        return path, json.loads(report.read_text())

    def svg(self, *options, model=SCREW):
        path, report = self.run_to("d.svg", *options, model=model)
        root = ElementTree.parse(path).getroot()
        groups = {g.get("id"): g.findall(f"{SVG}path") for g in root.iter(f"{SVG}g")}
        return root, groups, report

    def shape(self, name):
        from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

        import vtknurbs

        source = vtknurbs.vtkNURBSShapeSource()
        getattr(source, f"SetShapeTo{name}")()
        writer = vtkXMLUnstructuredGridWriter()
        writer.SetDataModeToBinary()
        writer.SetInputConnection(source.GetOutputPort())
        model = self.folder / f"{name}.vtu"
        writer.SetFileName(str(model))
        self.assertTrue(writer.Write())
        return model

    @staticmethod
    def points(path):
        """Of a path of M, L, C and Z; of curves, twenty a piece."""
        points = []
        for command, numbers in re.findall(r"([MLCZ])([^MLCZ]*)", path.get("d")):
            values = [float(number) for number in numbers.split()]
            corners = list(zip(values[::2], values[1::2]))
            if command == "C":
                a, (b, c, d) = points[-1], corners
                for t in (i / 20 for i in range(1, 20)):
                    weights = ((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t**3)
                    points.append(
                        tuple(sum(w * p[k] for w, p in zip(weights, (a, b, c, d))) for k in (0, 1))
                    )
            points += corners[-1:]
        return points

    def box(self, groups):
        """Width and height of the curves."""
        points = [p for group in groups.values() for path in group for p in self.points(path)]
        xs, ys = zip(*points)
        return max(xs) - min(xs), max(ys) - min(ys)

    def test_report_is_true(self):
        root, groups, report = self.svg()
        self.assertEqual(set(report["seconds"]), {"read", "visibility", "write"})
        self.assertEqual(report["faces"], 10)
        self.assertEqual(report["failed_faces"], 0)
        self.assertNotIn("visible_area", report)  # of `visible` only
        paths = [path for group in groups.values() for path in group]
        self.assertEqual(len(paths), report["paths"])
        data = "".join(path.get("d") for path in paths)
        self.assertEqual(data.count("C"), report["curves"])
        self.assertEqual(data.count("L") + data.count("Z"), report["straight_lines"])
        self.assertGreater(report["lines"], report["visible_lines"])
        self.assertGreaterEqual(report["lines"], report["paths"])
        known = json.loads((self.folder / "report.json").read_text())["edges"]
        for path in paths:
            self.assertTrue(path.get("data-face"))
            for edge in (path.get("data-edge") or "").split():
                self.assertLess(int(edge), known)
        self.assertIn("screw.step", root.find(f"{SVG}desc").text)

    def test_circle_is_a_few_curves_true_to_scale(self):
        sphere = self.shape("Sphere")
        for precision in ("1e-3", "1e-4", "1e-6"):
            with self.subTest(precision):
                root, groups, report = self.svg(
                    "--view", "0.3,-1,0.5", "--scale", "20", "--precision", precision, model=sphere
                )
                outlines = groups["visible-silhouette"]
                self.assertEqual(len(outlines), 1)
                self.assertLessEqual(outlines[0].get("d").count("C"), 16)
                x = float(root.get("width")[:-2]) / 2
                y = float(root.get("height")[:-2]) / 2
                radius = x - 10  # The margin
                self.assertGreater(radius, 1)
                for point in self.points(outlines[0]):
                    distance = ((point[0] - x) ** 2 + (point[1] - y) ** 2) ** 0.5
                    self.assertAlmostEqual(distance, radius, delta=1e-4 + 20 * report["precision"])

    def test_hidden_and_smooth_lines(self):
        _, groups, _ = self.svg()
        self.assertIn("hidden-sharp", groups)
        self.assertNotIn("visible-smooth", groups)
        _, groups, _ = self.svg("--smooth", model=LINKRODS)
        self.assertIn("visible-smooth", groups)
        _, groups, report = self.svg("--no-hidden")
        self.assertFalse([name for name in groups if name.startswith("hidden")])
        self.assertEqual(report["lines"], report["visible_lines"])

    def test_views(self):
        torus = self.shape("Torus")

        def box(*options):
            _, groups, report = self.svg("--scale", "1:1", *options, model=torus)
            width, height = self.box(groups)
            return width / report["scale"], height / report["scale"], 3 * report["precision"]

        def same(a, b):
            self.assertAlmostEqual(a[0], b[0], delta=a[2])
            self.assertAlmostEqual(a[1], b[1], delta=a[2])

        width, height, within = front = box("--view", "front")
        self.assertGreater(width, 1.5 * height)
        same(box("--view", "left"), front)
        same(box("--view=0,-2,0"), front)
        same(box("--view", "top"), (width, width))
        same(box("--view", "front", "--up", "1,0,0"), (height, width))
        near = box("--eye", f"0,{-2 * width},0")
        self.assertGreater(abs(near[1] / near[0] - height / width), within)

    def test_pages(self):
        root, _, report = self.svg("--page", "a3-landscape", "--scale", "1:2")
        self.assertEqual((root.get("width"), root.get("height")), ("420mm", "297mm"))
        self.assertEqual(report["scale"], 0.5)
        drawing = root.find(f"{SVG}metadata")[0]
        self.assertEqual(drawing.get("scale"), "1:2")
        root, _, report = self.svg("--page", "a3-landscape", "--scale", "1:2", "--unit", "m")
        self.assertEqual(report["scale"], 500)
        self.assertEqual(root.find(f"{SVG}metadata")[0].get("scale"), "1:2")
        path, _ = self.run_to("d.pdf", "--page", "a4")
        data = path.read_bytes()
        self.assertTrue(data.startswith(b"%PDF-"))
        self.assertTrue(data.rstrip().endswith(b"%%EOF"))
        box = re.search(rb"/MediaBox \[ 0 0 ([\d.]+) ([\d.]+) \]", data)
        self.assertAlmostEqual(float(box[1]), 210 / 25.4 * 72, delta=1e-3)
        self.assertAlmostEqual(float(box[2]), 297 / 25.4 * 72, delta=1e-3)
        self.fails(
            "drawing", SCREW, "-o", self.folder / "large.svg", "--page", "a4", "--scale", "50:1",
            says="the drawing is .* x .* mm at scale 50:1, and the page has room for 190 x 277 mm",
        )  # fmt: skip

    def test_polylines(self):
        path, report = self.run_to("d.vtp")
        lines = read(vtkXMLPolyDataReader(), path)
        self.assertEqual(lines.GetNumberOfLines(), report["lines"])
        self.assertEqual(lines.GetBounds()[4:], (0, 0))
        arrays = lines.GetCellData()
        seen = [arrays.GetArray("Visibility").GetTuple1(i) for i in range(report["lines"])]
        self.assertEqual(sum(seen), report["visible_lines"])
        for name in ("Kind", "EdgeId", "FaceId"):
            self.assertEqual(arrays.GetArray(name).GetNumberOfTuples(), report["lines"])

    def test_threads_change_nothing(self):
        for name in ("d.svg", "d.pdf"):
            one, two = (
                self.run_to(name, "--threads", n, model=LINKRODS)[0].read_bytes() for n in (1, 2)
            )
            self.assertEqual(one, two)

    def test_visible_regions_are_a_model(self):
        # Of a sphere half is seen, and the other half is not.
        sphere = self.shape("Sphere")
        areas = []
        for options in ((), ("--hidden-regions", "--one-sided")):
            path, report = self.run_to(
                "seen.vtu", "--view", "1,2,3", *options, model=sphere, command="visible"
            )
            self.assertNotIn("paths", report)
            seen = read(vtkXMLUnstructuredGridReader(), path)
            area = seen.GetCellData().GetArray("VisibleArea")
            fraction = seen.GetCellData().GetArray("VisibleFraction")
            total = sum(area.GetTuple1(i) for i in range(area.GetNumberOfTuples()))
            self.assertAlmostEqual(total, report["visible_area"], delta=1e-9 * total)
            self.assertAlmostEqual(fraction.GetTuple1(0), 0.5, delta=1e-3)
            mesh = self.folder / "seen.vtp"
            tool("tessellate", path, "-o", mesh, "--quiet")
            properties = vtkMassProperties()
            properties.SetInputData(read(vtkXMLPolyDataReader(), mesh))
            properties.Update()
            areas.append(properties.GetSurfaceArea())
            self.assertAlmostEqual(areas[-1], total, delta=5e-3 * total)

    def test_nothing_to_see(self):
        self.fails(
            "visible", self.shape("Sphere"), "-o", self.folder / "none.vtu", "--eye", "nan,0,0",
            says="'nan,0,0' is not x,y,z", code=2,
        )  # fmt: skip


class Guide(Folder):
    def test_commands_of_the_guide_work(self):
        shutil.copy(SCREW, self.folder)
        commands = re.findall(r"^    vtknurbs (.*)$", GUIDE.read_text("utf-8"), re.MULTILINE)
        self.assertGreaterEqual(len(commands), 12)
        for command in commands:
            with self.subTest(command):
                tool(*command.split(), cwd=self.folder)


class BadInput(Folder):
    def test_usage(self):
        mesh = self.folder / "m.stl"
        for arguments, says in (
            ((), "subcommand"),
            (("draw", SCREW), "draw|subcommand"),
            (("tessellate", SCREW), "--output is required"),
            (("tessellate", SCREW, "-o", mesh, "--tolerance", "0"), "'0' is not a number greater"),
            (("tessellate", SCREW, "-o", mesh, "--tolerance", "nan"), "'nan' is not a number"),
            (("tessellate", SCREW, "-o", mesh, "--method", "octree"), "octree"),
            (("tessellate", SCREW, "-o", mesh, "--threads", "-1"), "--threads"),
            (("render", SCREW, "-o", "p.png", "--size", "0x5"), "WIDTHxHEIGHT"),
            (("render", SCREW, "-o", "p.png", "--view", "0,0,0"), "--view"),
            (("render", SCREW, "-o", "p.png", "--pixels", "1", "--absolute", "1"), "excludes"),
            (("drawing", SCREW), "--output is required"),
            (("drawing", SCREW, "-o", "d.svg", "--view", "fore"), "neither a view's name"),
            (("drawing", SCREW, "-o", "d.svg", "--view", "0,0,0"), "has length zero"),
            (("drawing", SCREW, "-o", "d.svg", "--view", "top", "--eye", "1,2,3"), "excludes"),
            (("drawing", SCREW, "-o", "d.svg", "--up", "0,0,0"), "--up"),
            (("drawing", SCREW, "-o", "d.svg", "--scale", "1:0"), "--scale"),
            (("drawing", SCREW, "-o", "d.svg", "--page", "b5"), "--page"),
            (("drawing", SCREW, "-o", "d.svg", "--page", "a4-"), "--page"),
            (("visible", SCREW, "-o", "v.vtu", "--precision", "-1"), "'-1' is not a number"),
        ):
            with self.subTest(says):
                self.fails(*arguments, says=says, code=2)

    def test_files(self):
        mesh = self.folder / "m.stl"
        text = self.folder / "text.step"
        text.write_text("This is no STEP file.\n")
        empty = self.folder / "empty.step"
        empty.touch()
        short = self.folder / "short.step"
        short.write_bytes(SCREW.read_bytes()[:20000])
        for model, says in (
            (self.folder / "missing.step", "there is no such file"),
            (self.folder, "it is a folder"),
            (text, "text.step"),
            (empty, "empty.step"),
            (short, "short.step"),
        ):
            with self.subTest(model.name):
                self.fails("tessellate", model, "-o", mesh, says=says)
                self.fails("info", model, says=says)

    def test_vtk_files_that_are_no_models(self):
        path = self.folder / "mesh.vtu"
        tool("tessellate", SCREW, "-o", path, "--quiet")
        self.fails("info", path, says="not a model of NURBS surfaces")
        broken = self.folder / "broken.vtu"
        broken.write_bytes(path.read_bytes()[:300])
        self.fails("info", broken, says="broken.vtu|parsing")

    def test_outputs(self):
        for output, says in (
            (self.folder / "m.xyz", "'.xyz' is no mesh format"),
            (self.folder / "mesh", "it has no ending"),
            (self.folder / "no/such/m.stl", "there is no folder"),
        ):
            with self.subTest(says):
                self.fails("tessellate", SCREW, "-o", output, says=says)
        self.fails("render", SCREW, "-o", self.folder / "p.jpg", says="pictures are .png")
        self.fails("drawing", SCREW, "-o", self.folder / "d.dxf", says="drawings are .svg, .pdf")
        self.fails("visible", SCREW, "-o", self.folder / "v.vtp", says="models are .vtu")
        self.fails(
            "tessellate", SCREW, "-o", self.folder / "m.stl", "--report", "/no/r.json",
            says="there is no folder",
        )  # fmt: skip

    @unittest.skipUnless(Path("/dev/full").exists(), "no /dev/full here")
    def test_full_disk(self):
        for ending in (".vtp", ".vtu", ".stl", ".ply", ".obj", ".glb", ".png", ".svg", ".pdf"):
            with self.subTest(ending):
                output = self.folder / f"full{ending}"
                output.symlink_to("/dev/full")
                others = {".png": "render", ".svg": "drawing", ".pdf": "drawing"}
                command = others.get(ending, "tessellate")
                self.fails(command, SCREW, "-o", output, says=f"cannot write .*full{ending}|pace")
                output.unlink(missing_ok=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("tool", type=Path)
    parser.add_argument("source", type=Path)
    known, rest = parser.parse_known_args()
    TOOL = str(known.tool.resolve())
    GUIDE = known.source / "Documentation/Guide/CommandLine.md"
    BASELINES = known.source / "Data/Baselines"
    unittest.main(argv=sys.argv[:1] + rest)
