"""Models from numpy arrays and back, and their evaluation, against a slow reference in Python."""

import math
import unittest
import warnings

import numpy as np
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkObject
from vtkmodules.vtkCommonDataModel import vtkPartitionedDataSetCollection, vtkUnstructuredGrid
from vtkmodules.vtkFiltersCore import vtkFeatureEdges

import vtknurbs
from vtknurbs import Evaluator, Surface, TrimCurve, get_surface, get_surfaces, make_model


def basis(knots, degree, t):
    """All basis functions at t, which may be complex, by Cox and de Boor's recursion."""
    last = max(i for i in range(len(knots) - 1) if knots[i] < knots[i + 1])
    values = [1.0 * ((knots[i] <= t.real < knots[i + 1]) or (i == last and t.real >= knots[i]))
              for i in range(len(knots) - 1)]  # fmt: skip
    for p in range(1, degree + 1):
        def part(i):
            left = knots[i + p] - knots[i]
            right = knots[i + p + 1] - knots[i + 1]
            return ((t - knots[i]) / left * values[i] if left else 0) + (
                (knots[i + p + 1] - t) / right * values[i + 1] if right else 0)  # fmt: skip
        values = [part(i) for i in range(len(values) - 1)]
    return np.array(values)


def reference(surface, u, v):
    """The point at (u, v), complex if they are."""
    nu = basis(surface.knots[0], surface.degrees[0], np.complex128(u))
    nv = basis(surface.knots[1], surface.degrees[1], np.complex128(v))
    weights = np.ones(surface.points.shape[:2]) if surface.weights is None else surface.weights
    factors = np.outer(nu, nv) * weights
    return np.einsum("ij,ijk->k", factors, surface.points) / factors.sum()


def reference_derivative(surface, u, v, du, dv):
    """The derivative in direction (du, dv), by a complex step: exact to rounding."""
    h = 1e-30
    return reference(surface, u + 1j * h * du, v + 1j * h * dv).imag / h


def rational(seed=3):
    """A surface of degrees 3 and 2, of uneven knots and weights, not over 0 to 1."""
    random = np.random.default_rng(seed)
    grid = np.stack(np.meshgrid(np.arange(6.0), np.arange(4.0), indexing="ij"), -1)
    points = np.concatenate([grid, np.zeros((6, 4, 1))], -1) + random.uniform(-0.3, 0.3, (6, 4, 3))
    return Surface(points, ([-1, -1, -1, -1, 0.2, 1, 3, 3, 3, 3], [2, 2, 2, 2.5, 4, 4, 4]), (3, 2),
                   random.uniform(0.5, 2, (6, 4)), name="rational", color=(10, 20, 30),
                   face_id=17, reversed=True)  # fmt: skip


def cylinder_patches():
    """A cylinder of radius 2 as four quarters that share their sides."""
    angles = np.arange(5) % 4 * (math.pi / 2)
    corners = np.round(2 * np.stack([np.cos(angles), np.sin(angles)], -1), 12)
    patches = []
    for k in range(4):
        a, b = corners[k], corners[k + 1]
        arc = np.stack([a, a + b, b])
        net = np.stack([np.column_stack([arc, np.full(3, z)]) for z in (0.0, 1.0)], 1)
        weights = np.outer([1, math.sqrt(0.5), 1], [1, 1])
        patches.append(Surface(net, degrees=(2, 1), weights=weights, name=f"quarter {k}"))
    return patches


def open_edges(model, tolerance=1e-4):
    """Triangles of the model's mesh, and the edges of it that have one triangle."""
    tessellator = vtknurbs.vtkNURBSTessellator()
    tessellator.SetInputData(model)
    tessellator.MergePointsOn()
    tessellator.SetTolerance(tolerance)
    tessellator.Update()
    edges = vtkFeatureEdges()
    edges.SetInputData(tessellator.GetOutputDataObject(0))
    edges.FeatureEdgesOff()
    edges.NonManifoldEdgesOff()
    edges.ManifoldEdgesOff()
    edges.Update()
    return tessellator, edges.GetOutput()


class Models(unittest.TestCase):
    def test_there_and_back(self):
        given = rational()
        plane = Surface(np.random.default_rng(0).uniform(size=(2, 3, 3)), degrees=(1, 2))
        model = make_model([plane, given], join=False, length_unit="m")
        self.assertEqual(model.GetNumberOfCells(), 2)
        self.assertEqual(vtknurbs.vtkNURBSModel.Validate(model), "")
        self.assertEqual(vtknurbs.vtkNURBSModel.GetLengthUnit(model), "m")
        back = get_surface(model, 1)
        np.testing.assert_array_equal(back.points, given.points)
        np.testing.assert_array_equal(back.weights, given.weights)
        for k in (0, 1):
            np.testing.assert_array_equal(back.knots[k], given.knots[k])
        self.assertEqual((back.degrees, back.name, back.color, back.face_id, back.reversed, back.trims),
                         ((3, 2), "rational", (10, 20, 30), 17, True, []))  # fmt: skip
        first = get_surface(model, 0)
        np.testing.assert_array_equal(first.points, plane.points)
        self.assertIsNone(first.weights)
        np.testing.assert_array_equal(first.knots[1], [0, 0, 0, 1, 1, 1])
        np.testing.assert_array_equal(vtknurbs.clamped_knots(5, 2), [0, 0, 0, 1 / 3, 2 / 3, 1, 1, 1])

    def test_trims_there_and_back(self):
        circle = TrimCurve([(0.5, 0.2), (0.2, 0.2), (0.2, 0.5), (0.2, 0.8), (0.5, 0.8), (0.8, 0.8),
                            (0.8, 0.5), (0.8, 0.2), (0.5, 0.2)], np.repeat(np.arange(5.0), [3, 2, 2, 2, 3]),
                           weights=[1, math.sqrt(0.5)] * 4 + [1])  # fmt: skip
        square = [(0, 0), (1, 0), (1, 1), (0, 1)]
        flat = np.stack(np.meshgrid([0.0, 2], [0.0, 3], [0.0], indexing="ij"), -1)[:, :, 0]
        model = make_model(Surface(flat, degrees=(1, 1), trims=[square, circle]))
        self.assertEqual(vtknurbs.vtkNURBSModel.Validate(model), "")
        back = get_surface(model, 0)
        self.assertEqual([len(loop) for loop in back.trims], [1, 1])
        np.testing.assert_array_equal(back.trims[0][0].points, square + square[:1])
        hole = back.trims[1][0]
        np.testing.assert_array_equal(hole.points, circle.points)
        np.testing.assert_array_equal(hole.weights, circle.weights)
        np.testing.assert_array_equal(hole.knots, circle.knots)
        self.assertEqual((hole.degree, hole.edge, hole.reversed), (2, -1, False))
        # The plate less its elliptic hole, which is known.
        tessellator, _ = open_edges(model)
        mesh = tessellator.GetOutputDataObject(0)
        area = sum(mesh.GetCell(i).ComputeArea() for i in range(mesh.GetNumberOfCells()))
        self.assertAlmostEqual(area, 6 - math.pi * 0.09 * 6, delta=2e-3)
        inside = Evaluator(model).inside(0, [[0.5, 0.5], [0.1, 0.9], [0.5, 0.79], [0.5, 0.81]])
        self.assertEqual(inside.tolist(), [False, True, False, True])

    def test_a_file_as_arrays_makes_the_same_mesh(self):
        reader = vtknurbs.vtkNURBSCADReader()
        reader.SetFileName("/usr/share/opencascade/data/step/linkrods.step")
        reader.Update()
        parts = vtknurbs.models(reader.GetOutputDataObject(0))
        self.assertGreater(len(parts), 0)
        for part in parts:
            copy = make_model(get_surfaces(part))
            problems = vtknurbs.vtkNURBSModel.Validate(copy)
            self.assertNotIn("error", problems)
            # Without the edges' own curves, faces are joined along the first face's: off by its gaps.
            given, given_open = open_edges(part, 1e-3)
            made, made_open = open_edges(copy, 1e-3)
            self.assertEqual(made.GetNumberOfFaces(), given.GetNumberOfFaces())
            self.assertLessEqual(made.GetCertifiedError(), made.GetToleranceUsed())
            self.assertEqual(given_open.GetNumberOfCells(), 0)
            self.assertEqual(made_open.GetNumberOfCells(), 0)

    def test_sides_are_joined(self):
        patches = cylinder_patches()
        joined, edges = open_edges(make_model(patches))
        # What is left open are the two circles; apart, every quarter has its straight sides, too.
        ends = [edges.GetCell(i).GetBounds()[4:] for i in range(edges.GetNumberOfCells())]
        self.assertTrue(all(low == high for low, high in ends))
        model = make_model(patches, join=False)
        self.assertEqual(get_surface(model, 0).trims, [])
        loop = get_surface(make_model(patches), 0).trims[0]
        self.assertEqual(len(loop), 4)
        self.assertGreaterEqual(min(curve.edge for curve in loop), 0)
        points = np.array([joined.GetOutputDataObject(0).GetPoint(i)
                           for i in range(joined.GetOutputDataObject(0).GetNumberOfPoints())])  # fmt: skip
        np.testing.assert_allclose(np.hypot(points[:, 0], points[:, 1]), 2, rtol=1e-12)

    def test_in_place(self):
        model = make_model([rational(), rational(5)])
        points = vtknurbs.control_points(model)
        ids = vtknurbs.control_point_ids(model, 1)
        self.assertEqual(ids.shape, (6, 4))
        np.testing.assert_array_equal(points[ids], rational(5).points)
        evaluator = Evaluator(model)
        before = evaluator.points(1, [-1, 2])
        points[ids[0, 0]] += (0, 0, 7)
        model.GetPoints().Modified()
        np.testing.assert_allclose(evaluator.points(1, [-1, 2]) - before, [0, 0, 7], atol=1e-14)

    def test_composites(self):
        model = make_model(rational())
        assembly = vtkPartitionedDataSetCollection()
        assembly.SetPartition(0, 0, model)
        assembly.SetPartition(1, 0, vtkUnstructuredGrid())
        self.assertEqual(vtknurbs.models(assembly), [model])
        self.assertEqual(len(vtknurbs.blocks(assembly)), 2)
        with self.assertRaisesRegex(TypeError, "vtknurbs.models"):
            get_surfaces(assembly)


class Refusals(unittest.TestCase):
    """Every refusal names the surface and the reason."""

    def refused(self, surface, reason):
        with self.assertRaisesRegex(ValueError, r"^surface 1[ :].*" + reason):
            make_model([rational(), surface])

    def test_surfaces(self):
        cube = np.random.default_rng(1).uniform(size=(3, 3, 3))
        self.refused(Surface(cube), "neither knots nor degrees")
        self.refused(Surface(cube[..., :2], degrees=(1, 1)), r"shape \(3, 3, 2\) instead of \(nu, nv, 3\)")
        self.refused(Surface([[1, 2], [3]], degrees=(1, 1)), "no array of numbers")
        self.refused(Surface(cube, degrees=(3, 1)), "3 control points are too few for degree 3")
        self.refused(Surface(cube, degrees=(2, 2, 2)), "3 degrees instead of 2")
        clamped = [0, 0, 0, 1, 1, 1]
        self.refused(Surface(cube, (clamped, clamped[1:]), (2, 2)), "5 knots in v do not suit 3 control")
        self.refused(Surface(cube, (clamped, [0, 0, 1, 0, 1, 1])), "knots in v: .*smaller")
        self.refused(Surface(cube, ([0, 1, 2], clamped)), "degree -1 in u is not 1 to 25")
        broken = cube.copy()
        broken[1, 2, 0] = np.inf
        self.refused(Surface(broken, degrees=(2, 2)), "control point 1, 2 is not finite")
        weights = np.ones((3, 3))
        self.refused(Surface(cube, degrees=(2, 2), weights=weights[:2]), "weights for")
        self.refused(Surface(cube, degrees=(2, 2), weights=0 * weights, name="wing"), "not positive")
        self.refused(Surface(cube, degrees=(2, 2), color=(1, 2, 300)), "0 to 255")
        self.refused(Surface(cube, degrees=(2, 2), face_id=-4), "identity -4 is negative")
        self.refused("wing", "a str is no vtknurbs.Surface")
        with self.assertRaisesRegex(ValueError, r"surface 0 \(wing\): "):
            make_model(Surface(cube, name="wing"))

    def test_trims(self):
        cube = np.random.default_rng(1).uniform(size=(3, 3, 3))
        good = [(0.2, 0.2), (0.8, 0.2), (0.5, 0.5)]

        def refused(loop, reason):
            self.refused(Surface(cube, degrees=(2, 2), trims=[good, loop]), "loop 1.*" + reason)

        refused([TrimCurve([(0, 0), (1, 1)])], "it is open")
        refused([(0, 0), (1, 1, 1)], "no array of numbers")
        refused([TrimCurve(good, degree=3)], "too few for degree 3")
        refused([TrimCurve(good, weights=[1, 2])], "2 weights for a trim curve of 3")
        refused([TrimCurve(good, [0, 0, 1, 1, 1])], "knots|multiplicity|degree")
        refused([TrimCurve([(0, 0), (math.nan, 1)])], "not finite")
        refused([TrimCurve(good, edge=-3)], "edge -3 is negative")

    def test_what_is_odd_is_a_warning(self):
        cube = np.random.default_rng(1).uniform(size=(3, 3, 3))
        flat = [(0.2, 0.2), (0.8, 0.2), (0.5, 0.2)]
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            make_model(Surface(cube, degrees=(2, 2), trims=[flat], name="flat"))
        self.assertEqual(len(caught), 1)
        self.assertRegex(str(caught[0].message), r"^surface 0 \(flat\): .*area")
        self.assertTrue(caught[0].filename.endswith("TestPythonArrays.py"))

    def test_evaluation(self):
        evaluator = Evaluator(make_model(rational()))
        with self.assertRaisesRegex(ValueError, "there is no cell 1; the model has 1"):
            evaluator.points(1, [0, 3])
        with self.assertRaisesRegex(ValueError, "v = 1.5 is outside the domain, 2 to 4"):
            evaluator.normals(0, [0, 1.5])
        with self.assertRaisesRegex(ValueError, "u = nan is outside"):
            evaluator.points(0, [math.nan, 3])
        with self.assertRaisesRegex(ValueError, r"shape \(3,\)"):
            evaluator.points(0, [0, 3, 3])
        with self.assertRaisesRegex(ValueError, "order 3"):
            evaluator.derivatives(0, [0, 3], 3)
        with self.assertRaisesRegex(ValueError, "no NURBS model"):
            grid = vtkUnstructuredGrid()
            grid.InsertNextCell(1, 1, [0])
            Evaluator(grid).points(0, [0, 0])
        broken = make_model(rational())
        vtknurbs.control_points(broken)[5] = math.nan
        broken.GetPoints().Modified()
        with self.assertRaisesRegex(ValueError, "cell 0: control point 5 is not finite"):
            get_surface(broken, 0)

    def test_missing_arrays(self):
        model = vtknurbs.vtkNURBSShapeSource()
        model.Update()
        evaluator = vtknurbs.vtkNURBSFaceEvaluator()
        evaluator.SetModel(model.GetOutput())
        uv = vtkDoubleArray()
        uv.SetNumberOfComponents(2)
        uv.InsertNextTuple2(0.5, 0.5)
        for call in (
            lambda: evaluator.Evaluate(0, uv, 0, None),
            lambda: evaluator.EvaluateNormals(0, uv, None),
            lambda: evaluator.EvaluateInside(0, uv, None),
            lambda: evaluator.EvaluateNormals(0, None, vtkDoubleArray()),
            lambda: evaluator.GetKnots(0, 0, None),
            lambda: evaluator.GetControlPoints(0, None),
            lambda: evaluator.GetWeights(0, None),
            lambda: evaluator.GetTrimCurve(0, 0, 0, None, None),
        ):
            vtkObject.GlobalWarningDisplayOff()
            self.assertFalse(call())
            vtkObject.GlobalWarningDisplayOn()
            self.assertTrue(evaluator.GetErrorMessage())


class Evaluation(unittest.TestCase):
    def setUp(self):
        self.surface = rational()
        self.evaluator = Evaluator(make_model([rational(9), self.surface]))
        random = np.random.default_rng(7)
        self.uv = np.column_stack([random.uniform(-1, 3, 60), random.uniform(2, 4, 60)])
        self.uv[:4] = [(-1, 2), (3, 4), (0.2, 2.5), (3, 2)]

    def test_points(self):
        points = self.evaluator.points(1, self.uv)
        expected = [reference(self.surface, u, v).real for u, v in self.uv]
        np.testing.assert_allclose(points, expected, rtol=0, atol=2e-14)
        self.assertEqual(self.evaluator.domain(1), ((-1, 3), (2, 4)))

    def test_derivatives(self):
        first = self.evaluator.derivatives(1, self.uv)
        second = self.evaluator.derivatives(1, self.uv, 2)
        self.assertEqual((first.shape, second.shape), ((60, 3, 3), (60, 6, 3)))
        np.testing.assert_allclose(second[:, :3], first, atol=1e-13)
        h = 1e-6
        for k, (u, v) in enumerate(self.uv[4:], 4):
            su = reference_derivative(self.surface, u, v, 1, 0)
            sv = reference_derivative(self.surface, u, v, 0, 1)
            np.testing.assert_allclose(first[k], [first[k, 0], su, sv], rtol=0, atol=1e-12)
            if min(abs(u - knot) for knot in (-1, 0.2, 1, 3)) < 2 * h or abs(v - 2.5) < 2 * h:
                continue  # a difference would look across a knot
            suu, suv, svv = (
                (reference_derivative(self.surface, u + h * a, v + h * b, c, d)
                 - reference_derivative(self.surface, u - h * a, v - h * b, c, d)) / (2 * h)
                for a, b, c, d in ((1, 0, 1, 0), (0, 1, 1, 0), (0, 1, 0, 1)))  # fmt: skip
            np.testing.assert_allclose(second[k, 3:], [suu, suv, svv], rtol=1e-7, atol=1e-7)

    def test_normals_point_outwards(self):
        normals = self.evaluator.normals(1, self.uv)
        s = self.evaluator.derivatives(1, self.uv)
        cross = -np.cross(s[:, 1], s[:, 2])  # the surface is reversed
        np.testing.assert_allclose(normals, cross / np.linalg.norm(cross, axis=1)[:, None], atol=1e-12)

    def test_shapes(self):
        grid = self.uv.reshape(3, 20, 2)
        np.testing.assert_array_equal(self.evaluator.points(1, grid).reshape(60, 3),
                                      self.evaluator.points(1, self.uv))  # fmt: skip
        self.assertEqual(self.evaluator.points(1, self.uv[0]).shape, (3,))
        self.assertEqual(self.evaluator.derivatives(1, np.zeros((0, 2)), 2).shape, (0, 6, 3))
        self.assertEqual(self.evaluator.inside(1, grid).shape, (3, 20))

    def test_curvatures(self):
        source = vtknurbs.vtkNURBSShapeSource()
        source.SetShapeToTorus()  # of radii 1 and 0.3
        source.Update()
        evaluator = Evaluator(source.GetOutput())
        (u0, u1), (v0, v1) = evaluator.domain(0)
        uv = np.random.default_rng(2).uniform((u0, v0), (u1, v1), (500, 2))
        ring = np.hypot(*evaluator.points(0, uv)[:, :2].T)
        # A torus bends by 1 / r along its tube, and by cos / ring along its ring.
        expected = np.sort([np.full(500, 1 / 0.3), (ring - 1) / 0.3 / ring], 0).T
        np.testing.assert_allclose(evaluator.curvatures(0, uv), expected, rtol=1e-9, atol=1e-9)
        source.SetShapeToSphere()
        source.Update()
        self.assertTrue(np.isnan(Evaluator(source.GetOutput()).curvatures(0, [0, 0])).all())


if __name__ == "__main__":
    unittest.main()
