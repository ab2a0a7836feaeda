"""Imports vtknurbs, builds every class of it, and prints what it found."""

import unittest

import vtknurbs


class PythonPackage(unittest.TestCase):
    def test_every_class_can_be_built(self):
        self.assertTrue(vtknurbs.__all__, "the package has no class")
        for name in vtknurbs.__all__:
            with self.subTest(name):
                try:
                    built = getattr(vtknurbs, name)()
                except TypeError as problem:
                    # What only has in common what other classes do.
                    self.assertIn("abstract", str(problem))
                    continue
                self.assertEqual(built.GetClassName(), name)
                self.assertTrue(str(built))

    def test_another_vtk_is_refused_in_words(self):
        built_with = vtknurbs._VTK_BUILT_WITH
        vtknurbs._VTK_BUILT_WITH = "8.0.0"
        try:
            with self.assertRaisesRegex(ImportError, "built with VTK 8.0.0.*loaded VTK"):
                vtknurbs._check_vtk()
        finally:
            vtknurbs._VTK_BUILT_WITH = built_with


if __name__ == "__main__":
    print("vtknurbs", vtknurbs.__version__, "on VTK", vtknurbs._VTK_BUILT_WITH)
    print(" ".join(vtknurbs.__all__))
    unittest.main()
