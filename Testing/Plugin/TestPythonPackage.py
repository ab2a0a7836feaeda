"""What a Python program finds of vtknurbs: its classes, help, type hints, and words where it can't work.

    TestPythonPackage.py    with the package to test in PYTHONPATH
"""

import importlib.util
import inspect
import os
import pydoc
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid

import vtknurbs

PACKAGE = Path(vtknurbs.__file__).parent
HELPERS = [name for names in vtknurbs._HELPERS.values() for name in names]
CLASSES = [name for name in vtknurbs.__all__ if name not in HELPERS]


def python(code, *paths, **environment):
    """The code in a Python of its own that has these paths before all others: output and status."""
    environment = dict(os.environ, PYTHONPATH=os.pathsep.join(map(str, paths)), **environment)
    result = subprocess.run([sys.executable, "-c", code], env=environment, text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)  # fmt: skip
    return result.returncode, result.stdout


class Classes(unittest.TestCase):
    def test_every_class_can_be_built(self):
        self.assertTrue(CLASSES, "the package has no class")
        for name in CLASSES:
            with self.subTest(name):
                try:
                    built = getattr(vtknurbs, name)()
                except TypeError as problem:
                    # What only has in common what other classes do.
                    self.assertIn("abstract", str(problem))
                    continue
                self.assertEqual(built.GetClassName(), name)
                self.assertTrue(str(built))

    def test_names(self):
        self.assertLessEqual(set(vtknurbs.__all__), set(dir(vtknurbs)))
        for name in HELPERS:
            self.assertEqual(getattr(vtknurbs, name).__name__, name)
        with self.assertRaisesRegex(AttributeError, "no attribute 'vtkNURBSNothing'"):
            vtknurbs.vtkNURBSNothing

    def test_help_has_the_headers_words(self):
        text = pydoc.render_doc(vtknurbs.vtkNURBSTessellator, renderer=pydoc.plaintext)
        self.assertRegex(text, r"within\s+a\s*\|?\s*certified distance of the surfaces")
        self.assertIn("SetTolerance(self, _arg:float)", text)
        for name in CLASSES:
            self.assertRegex(getattr(vtknurbs, name).__doc__, f"^{name} - \\S+", name)
        for name in HELPERS:
            self.assertTrue(inspect.getdoc(getattr(vtknurbs, name)), name)
        self.assertIn("make_model", pydoc.render_doc(vtknurbs, renderer=pydoc.plaintext))

    def test_numpy_is_not_needed_for_pipelines(self):
        code = "import sys, vtknurbs; assert 'numpy' not in sys.modules; vtknurbs.make_model"
        self.assertEqual(python(code, PACKAGE.parent), (0, ""))
        code = "import sys; sys.modules['numpy'] = None; import vtknurbs; vtknurbs.make_model"
        status, output = python(code, PACKAGE.parent)
        self.assertNotEqual(status, 0)
        self.assertRegex(output, "ImportError: vtknurbs.make_model needs numpy .*python3-numpy")


@unittest.skipUnless(importlib.util.find_spec("vtkmodules.generate_pyi"), "VTK before 9.2 makes no hints")
class Hints(unittest.TestCase):
    def test_every_method_is_in_the_hints(self):
        self.assertTrue((PACKAGE / "py.typed").exists())
        package = (PACKAGE / "__init__.pyi").read_text(encoding="utf-8")
        for name in vtknurbs.__all__:
            self.assertRegex(package, rf"(?m)^from \.\w+ import {name} as {name}$")
        for name in CLASSES:
            kind = getattr(vtknurbs, name)
            hints = (PACKAGE / (kind.__module__.split(".")[-1] + ".pyi")).read_text(encoding="utf-8")
            hints = re.search(rf"(?ms)^class {name}\(.*?(?=^class |\Z)", hints)[0]
            for method, value in vars(kind).items():
                if inspect.isroutine(value) and not method.startswith("__"):
                    self.assertRegex(hints, rf"\bdef {method}\(", f"{name}.{method}")

    def test_a_type_checker_takes_them(self):
        program = (
            "import vtknurbs\n"
            "tessellator = vtknurbs.vtkNURBSTessellator()\n"
            "reveal_type(tessellator.GetCertifiedError())\n"
            "reveal_type(vtknurbs.make_model)\n"
            "tessellator.SetTolerance('much')\n"
        )
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "program.py").write_text(program, encoding="utf-8")
            code = "import sys; from mypy.main import main; sys.argv[0] = 'mypy'; main(args=sys.argv[1:])"
            environment = dict(os.environ, MYPYPATH=str(PACKAGE.parent))
            command = [sys.executable, "-c", code, "--ignore-missing-imports", "--cache-dir", folder]
            run, package = (
                subprocess.run(command + what, env=environment, text=True, cwd=folder,
                               capture_output=True, check=False)
                for what in (["program.py"], ["-p", "vtknurbs"]))  # fmt: skip
        self.assertIn('Revealed type is "builtins.float"', run.stdout, run.stderr)
        self.assertRegex(run.stdout, r"Revealed type is \"def \(surfaces: .*vtknurbs.surfaces.Surface")
        self.assertIn('incompatible type "str"; expected "float"', run.stdout)
        self.assertIn("Found 1 error in 1 file", run.stdout)
        self.assertIn("Success: no issues found", package.stdout, package.stdout)


class Refusals(unittest.TestCase):
    """Whatever is wrong, the import fails with words that name both sides and the cure."""

    def fake_vtk(self, version):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        modules = Path(folder.name) / "vtkmodules"
        modules.mkdir()
        (modules / "__init__.py").touch()
        (modules / "vtkCommonCore.py").write_text(
            f"class vtkVersion:\n    GetVTKVersion = staticmethod(lambda: {version!r})\n", encoding="utf-8")
        return Path(folder.name)  # fmt: skip

    def copied_package(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        return Path(shutil.copytree(PACKAGE, Path(folder.name) / "vtknurbs"))

    def refused(self, words, *paths, code="import vtknurbs"):
        status, output = python(code, *paths)
        self.assertNotEqual(status, 0)
        self.assertRegex(output.splitlines()[-1], "ImportError: .*" + words)

    def test_another_vtk(self):
        fake = self.fake_vtk("8.0.0")
        self.refused(f"built with VTK {re.escape(vtknurbs._VTK_BUILT_WITH)}, but this Python has loaded VTK "
                     f"8.0.0 from {fake}.*Two VTKs cannot share a process", fake, PACKAGE.parent)  # fmt: skip

    def test_no_vtk(self):
        self.refused("needs the Python modules of VTK .*found none for .*python3-paraview", PACKAGE.parent,
                     code="import sys; sys.modules['vtkmodules'] = None; import vtknurbs")  # fmt: skip

    def test_another_python(self):
        copy = self.copied_package()
        text = (copy / "__init__.py").read_text(encoding="utf-8")
        text, count = re.subn(r"_PYTHON_BUILT_FOR = \(.*\)", "_PYTHON_BUILT_FOR = (3, 6)", text)
        self.assertEqual(count, 1)
        (copy / "__init__.py").write_text(text, encoding="utf-8")
        version = "%d.%d" % sys.version_info[:2]
        self.refused(f"built for Python 3.6, .* this is Python {version} ", copy.parent)

    def test_built_in_part(self):
        copy = self.copied_package()
        for name in vtknurbs._EXTENSIONS[1:3]:
            (copy / (name + ".so")).unlink()
        self.refused(f"{re.escape(str(copy))} is built in part only: {', '.join(vtknurbs._EXTENSIONS[1:3])} of "
                     "its .* modules are missing. Build the whole", copy.parent)  # fmt: skip

    def test_a_module_that_does_not_load(self):
        copy = self.copied_package()
        (copy / (vtknurbs._EXTENSIONS[0] + ".so")).write_bytes(b"no library")
        self.refused(f"cannot load its module {vtknurbs._EXTENSIONS[0]}: .*build and install all again",
                     copy.parent)  # fmt: skip

    def test_two_files_of_one_version(self):
        with tempfile.NamedTemporaryFile("w", suffix=".maps") as maps:
            for name in ("/a/libvtkCommonCore-9.2.so.1", "/a/libvtkCommonCore-9.2.so.1", "/b/libm.so"):
                maps.write(f"7f00-7f01 r-xp 0000 08:01 99   {name}\n")
            maps.flush()
            self.assertEqual(vtknurbs._vtk_libraries(maps.name), ["/a/libvtkCommonCore-9.2.so.1"])
            maps.write("7f00-7f01 r-xp 0000 08:01 99   /b c/libvtkCommonCore.so\n")
            maps.flush()
            self.assertEqual(vtknurbs._vtk_libraries(maps.name)[1], "/b c/libvtkCommonCore.so")
        self.assertEqual(len(vtknurbs._vtk_libraries()), 1)
        self.assertEqual(vtknurbs._vtk_libraries("/nowhere"), [])
        real, vtknurbs._vtk_libraries = vtknurbs._vtk_libraries, lambda: ["/a/x.so", "/b/x.so"]
        try:
            with self.assertRaisesRegex(ImportError, "/a/x.so and /b/x.so are loaded"):
                vtknurbs._gather()
        finally:
            vtknurbs._vtk_libraries = real


class Pictures(unittest.TestCase):
    def setUp(self):
        self.source = vtknurbs.vtkNURBSShapeSource()
        self.source.SetShapeToSphere()

    def covered(self, *things, **options):
        picture = vtknurbs.render(*things, size=(100, 80), view=(0, -1, 0), parallel=True, **options)
        self.assertEqual((picture.shape, picture.dtype), ((80, 100, 3), np.uint8))
        return np.any(picture != 255, axis=-1)

    def test_all_kinds_of_things(self):
        self.source.Update()
        mesh = vtknurbs.vtkNURBSTessellator()
        mesh.SetInputConnection(self.source.GetOutputPort())
        mapper = vtknurbs.vtkNURBSMapper()
        mapper.SetInputConnection(self.source.GetOutputPort())
        expected = self.covered(self.source)
        rows, columns = expected.any(1).sum(), expected.any(0).sum()
        self.assertLessEqual(abs(rows - columns), 1)  # a ball is round
        self.assertAlmostEqual(expected.sum(), np.pi / 4 * rows * columns, delta=0.03 * rows * columns)
        for thing in (self.source.GetOutputPort(), self.source.GetOutput(), mesh, mapper,
                      mesh.GetOutputPort(), mesh.GetOutputDataObject(0),
                      vtknurbs.make_actor(self.source, color=(1, 0, 0))):  # fmt: skip
            self.assertLess(np.sum(self.covered(thing) != expected), 0.02 * expected.size, thing)
        with self.assertRaisesRegex(TypeError, "a int is no filter, output port, data object or mapper"):
            vtknurbs.render(7)
        with self.assertRaisesRegex(TypeError, "no NURBS model and no vtkPolyData"):
            vtknurbs.render(vtkUnstructuredGrid())

    def test_the_top_row_is_first_and_files_are_the_same(self):
        from PIL import Image

        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "ball.png"
            window = vtknurbs.make_window(self.source, size=(90, 70))
            camera = window.GetRenderers().GetFirstRenderer().GetActiveCamera()
            camera.SetWindowCenter(0, -0.6)  # the ball moves up
            picture = vtknurbs.grab(window, file)
            covered = np.any(picture != 255, axis=-1)
            self.assertGreater(covered[:35].sum(), 2 * covered[35:].sum())
            with Image.open(file) as image:
                np.testing.assert_array_equal(np.asarray(image.convert("RGB")), picture)
            with self.assertRaisesRegex(OSError, "nowhere"):
                vtknurbs.grab(window, Path(folder) / "nowhere" / "ball.png")

    def test_no_opengl_is_told(self):
        code = ("import vtknurbs; s = vtknurbs.vtkNURBSShapeSource()\n"
                "try:\n    vtknurbs.render(s)\nexcept RuntimeError as error:\n    print(error)")  # fmt: skip
        status, output = python(code, PACKAGE.parent, VTK_EGL_DEVICE_INDEX="99")
        self.assertEqual(status, 0, output)
        self.assertRegex(output, "^no picture: .*99")


class PyVista(unittest.TestCase):
    @unittest.skipUnless(importlib.util.find_spec("pyvista"), "pyvista is not installed; Debian 12 has none")
    def test_models_and_meshes_wrap(self):
        import pyvista

        x, y = np.meshgrid(np.arange(4.0), np.arange(4.0), indexing="ij")
        surface = vtknurbs.Surface(np.stack([x, y, x * y], -1), degrees=(3, 3))
        model = pyvista.wrap(vtknurbs.make_model(surface))
        self.assertEqual(model.n_cells, 1)
        tessellator = vtknurbs.vtkNURBSTessellator()
        tessellator.SetInputData(model)
        tessellator.Update()
        mesh = pyvista.wrap(tessellator.GetOutputDataObject(0))
        self.assertEqual(mesh.n_cells, tessellator.GetNumberOfTriangles())
        self.assertEqual(vtknurbs.get_surface(model, 0).degrees, (3, 3))


if __name__ == "__main__":
    print("vtknurbs", vtknurbs.__version__, "on VTK", vtknurbs._VTK_BUILT_WITH)
    print(" ".join(vtknurbs.__all__))
    unittest.main()
