# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces as numpy arrays: models made of them, and the way back."""

import re
import warnings
from dataclasses import dataclass, field
from typing import Any, Iterable, List, Optional, Sequence, Tuple, Union

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDoubleArray
from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet, vtkDataSet, vtkUnstructuredGrid

from .vtkNURBSFiltersCore import vtkNURBSFaceEvaluator, vtkNURBSModel, vtkNURBSModelBuilder

__all__ = ["Surface", "TrimCurve", "blocks", "clamped_knots", "control_point_ids", "control_points",
           "get_surface", "get_surfaces", "make_model", "models"]  # fmt: skip


@dataclass(eq=False)
class TrimCurve:
    """A curve of a trimming loop, in the (u, v) plane of its surface.

    points    (n, 2): control points
    knots     n + degree + 1 values; None: clamped and even over 0 to 1
    degree    None: as the knots tell, 1 without knots
    weights   n values > 0; None: all 1
    edge      a number >= 0 that the curves of two faces have in common where the faces share that
              edge; -1: none. Such curves must be images of one curve in space, parameter by
              parameter.
    reversed  the loop runs from the curve's end to its start
    """

    points: Any
    knots: Any = None
    degree: Optional[int] = None
    weights: Any = None
    edge: int = -1
    reversed: bool = False


@dataclass(eq=False)
class Surface:
    """A trimmed surface; one cell of a model.

    points    (nu, nv, 3): Cartesian control points, points[i, j] is column i in u, row j in v
    knots     (knots_u, knots_v), whole knot vectors: nu + degree_u + 1 and nv + degree_v + 1
              values; None: clamped and even over 0 to 1, for the degrees
    degrees   (degree_u, degree_v), 1 to 25; None: as the knots tell
    weights   (nu, nv), > 0; None: all 1
    trims     loops; the material lies on their left in the (u, v) plane (outer loops run
              counter-clockwise, holes clockwise). A loop is a sequence of TrimCurve or, for a closed
              polygon, an array (n, 2). None: the natural boundary.
    name      of the face
    color     sRGB, three values from 0 to 255; None: light grey
    face_id   identity, kept by filters; None: the cell's index
    reversed  the outside is against Su x Sv
    """

    points: Any
    knots: Any = None
    degrees: Optional[Tuple[int, int]] = None
    weights: Any = None
    trims: Sequence[Any] = field(default_factory=list)
    name: str = ""
    color: Optional[Tuple[int, int, int]] = None
    face_id: Optional[int] = None
    reversed: bool = False


def clamped_knots(count: int, degree: int) -> np.ndarray:
    """The clamped, even knot vector over 0 to 1 for `count` control points of this degree."""
    if not 1 <= degree < count:
        raise ValueError(f"{count} control points are too few for degree {degree}, or it is under 1")
    inner = np.linspace(0, 1, count - degree + 1)
    return np.concatenate([np.zeros(degree), inner, np.ones(degree)])


def make_model(surfaces: Union[Surface, Iterable[Surface]], *, length_unit: str = "mm",
               join: bool = True) -> vtkUnstructuredGrid:  # fmt: skip
    """A model (see vtkNURBSModel), checked: cell i is surfaces[i]. Arrays are copied.

    join: sides of untrimmed surfaces that are the same in space, bit for bit, become one edge that
    both share, so that meshes have no gap there. Such surfaces come back from get_surface with a
    loop of their four sides.

    Raises ValueError, which names the surface and the reason, for data that is no surface; what is
    only odd (a loop without area) is a warning.
    """
    surfaces = [surfaces] if isinstance(surfaces, Surface) else list(surfaces)
    builder = vtkNURBSModelBuilder()
    builder.AddObserver("ErrorEvent", lambda *_: None)  # GetErrorMessage tells it
    builder.SetJoinSides(join)
    builder.SetLengthUnit(length_unit)
    for index, surface in enumerate(surfaces):
        try:
            _add(builder, surface)
        except (TypeError, ValueError) as error:
            raise ValueError(f"{_label(surfaces, index)}: {error}") from error
    model = vtkUnstructuredGrid()
    builder.Build(model)
    _report(vtkNURBSModel.Validate(model), surfaces)
    return model


def get_surface(model: vtkUnstructuredGrid, cell: int) -> Surface:
    """Cell `cell` of a model as arrays, which are copies. The curves of edges in space are not part of
    a surface; the faces' own trims name the edges. ValueError for a face that can't be used."""
    return _get(_evaluator(model), cell)


def get_surfaces(model: vtkUnstructuredGrid) -> List[Surface]:
    """All cells of a model; see get_surface."""
    evaluator = _evaluator(model)
    return [_get(evaluator, cell) for cell in range(model.GetNumberOfCells())]


def control_points(model: vtkUnstructuredGrid) -> np.ndarray:
    """All control points of a model, (n, 3), in place: what is written to them moves the surfaces.
    Call model.GetPoints().Modified() after that, so that filters and mappers see it."""
    return vtk_to_numpy(model.GetPoints().GetData())


def control_point_ids(model: vtkUnstructuredGrid, cell: int) -> np.ndarray:
    """Rows of control_points, (nu, nv), that are the control net of a cell."""
    nu, nv = _net_size(_evaluator(model), cell)
    cells = model.GetCells()
    start = vtk_to_numpy(cells.GetOffsetsArray())[cell]
    ids = vtk_to_numpy(cells.GetConnectivityArray())[start : start + nu * nv]
    return ids.reshape(nv, nu).T


def blocks(data: Any) -> List[Any]:
    """The data sets in what a reader or filter gives: data itself, or the blocks of a composite."""
    if not isinstance(data, vtkCompositeDataSet):
        return [data] if isinstance(data, vtkDataSet) else []
    found = []
    iterator = data.NewIterator()
    iterator.InitTraversal()
    while not iterator.IsDoneWithTraversal():
        found.append(iterator.GetCurrentDataObject())
        iterator.GoToNextItem()
    return [block for block in found if isinstance(block, vtkDataSet)]


def models(data: Any) -> List[vtkUnstructuredGrid]:
    """The models among blocks(data)."""
    return [block for block in blocks(data)
            if vtkNURBSModel.IsModel(vtkUnstructuredGrid.SafeDownCast(block))]  # fmt: skip


def _label(surfaces: Sequence[Surface], index: int) -> str:
    name = getattr(surfaces[index], "name", "")
    return f"surface {index} ({name})" if name else f"surface {index}"


def _report(problems: str, surfaces: Sequence[Surface]) -> None:
    """Raises or warns of the lines of vtkNURBSModel.Validate."""
    lines = [re.sub(r"cell (\d+)( \(FaceId -?\d+\))?:", lambda m: _label(surfaces, int(m[1])) + ":", line)
             for line in problems.splitlines()]  # fmt: skip
    errors = [line[len("error: ") :] for line in lines if line.startswith("error: ")]
    if errors:
        raise ValueError("\n".join(errors))
    for line in lines:
        warnings.warn(line[len("warning: ") :], stacklevel=3)


def _numbers(values: Any, what: str, dimensions: int, last: Optional[int] = None) -> np.ndarray:
    """`values` as an array of reals of so many dimensions, the last of this size."""
    try:
        array = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{what} are no array of numbers ({error})") from error
    if array.ndim != dimensions or (last is not None and array.shape[-1] != last):
        wanted = {1: "(n,)", 2: "(n, 2)" if last == 2 else "(nu, nv)", 3: "(nu, nv, 3)"}[dimensions]
        raise ValueError(f"{what} have the shape {array.shape} instead of {wanted}")
    return array


def _vtk(array: np.ndarray) -> Any:
    return numpy_to_vtk(np.ascontiguousarray(array), deep=True)


def _u_fastest(net: np.ndarray) -> np.ndarray:
    """(nu, nv) or (nu, nv, 3) as the rows of a cell."""
    return np.swapaxes(net, 0, 1).reshape((-1,) + net.shape[2:])


def _check(builder: vtkNURBSModelBuilder, accepted: bool) -> None:
    if not accepted:
        raise ValueError(re.sub(r"^face \d+[:,] ", "", builder.GetErrorMessage()))


def _degrees_and_knots(surface: Surface, shape: Tuple[int, ...]) -> List[Tuple[int, np.ndarray]]:
    if surface.knots is None and surface.degrees is None:
        raise ValueError("it has neither knots nor degrees")
    if surface.degrees is not None and len(surface.degrees) != 2:
        raise ValueError(f"there are {len(surface.degrees)} degrees instead of 2")
    if surface.knots is not None and len(surface.knots) != 2:
        raise ValueError(f"there are {len(surface.knots)} knot vectors instead of 2, in u and v")
    both = []
    for k, direction in enumerate("uv"):
        degree = None if surface.degrees is None else int(surface.degrees[k])
        if surface.knots is None:
            assert degree is not None
            both.append((degree, clamped_knots(shape[k], degree)))
            continue
        knots = _numbers(surface.knots[k], f"knots in {direction}", 1)
        told = len(knots) - shape[k] - 1
        if degree is not None and degree != told:
            raise ValueError(f"{len(knots)} knots in {direction} do not suit {shape[k]} control points of "
                             f"degree {degree}, which need {shape[k] + degree + 1}")  # fmt: skip
        both.append((told, knots))
    return both


def _add(builder: vtkNURBSModelBuilder, surface: Surface) -> None:
    if not isinstance(surface, Surface):
        raise TypeError(f"a {type(surface).__name__} is no vtknurbs.Surface")
    points = _numbers(surface.points, "control points", 3, 3)
    (degree_u, knots_u), (degree_v, knots_v) = _degrees_and_knots(surface, points.shape)
    weights = None
    if surface.weights is not None:
        weights = _numbers(surface.weights, "weights", 2)
        if weights.shape != points.shape[:2]:
            raise ValueError(f"{weights.shape} weights for {points.shape[:2]} control points")
        weights = _vtk(_u_fastest(weights))
    _check(builder, builder.AddFace(degree_u, degree_v, _vtk(knots_u), _vtk(knots_v),
                                    _vtk(_u_fastest(points)), weights) >= 0)  # fmt: skip
    if surface.name:
        builder.SetFaceName(surface.name)
    if surface.color is not None:
        _check(builder, builder.SetFaceColor(*(int(value) for value in surface.color)))
    if surface.face_id is not None:
        _check(builder, builder.SetFaceId(int(surface.face_id)))
    builder.SetFaceReversed(bool(surface.reversed))
    for index, loop in enumerate(surface.trims or ()):
        builder.BeginLoop()
        try:
            _add_loop(builder, loop)
        except ValueError as error:
            text = str(error)
            raise ValueError(text if text.startswith("loop ") else f"loop {index}: {text}") from error


def _add_loop(builder: vtkNURBSModelBuilder, loop: Any) -> None:
    if isinstance(loop, TrimCurve):
        loop = [loop]
    elif not all(isinstance(curve, TrimCurve) for curve in loop):
        corners = _numbers(loop, "a polygon's corners", 2, 2)
        if np.any(corners[0] != corners[-1]):
            corners = np.concatenate([corners, corners[:1]])
        loop = [TrimCurve(corners)]
    for curve in loop:
        points = _numbers(curve.points, "a trim curve's points", 2, 2)
        knots = None if curve.knots is None else _numbers(curve.knots, "a trim curve's knots", 1)
        degree = curve.degree
        if degree is None:
            degree = 1 if knots is None else len(knots) - len(points) - 1
        if knots is None:
            knots = clamped_knots(len(points), degree)
        if curve.weights is not None:
            weights = _numbers(curve.weights, "a trim curve's weights", 1)
            if len(weights) != len(points):
                raise ValueError(f"{len(weights)} weights for a trim curve of {len(points)} points")
            points = np.column_stack([points, weights])
        _check(builder, builder.AddTrimCurve(degree, _vtk(knots), _vtk(points), int(curve.edge),
                                             bool(curve.reversed)))  # fmt: skip


def _evaluator(model: vtkUnstructuredGrid) -> vtkNURBSFaceEvaluator:
    if not isinstance(model, vtkUnstructuredGrid):
        raise TypeError(f"a {type(model).__name__} is no model, which is a vtkUnstructuredGrid; "
                        "vtknurbs.models(data) gives those of a composite data set")  # fmt: skip
    evaluator = vtkNURBSFaceEvaluator()
    evaluator.AddObserver("ErrorEvent", lambda *_: None)  # GetErrorMessage tells it
    evaluator.SetModel(model)
    return evaluator


def _net_size(evaluator: vtkNURBSFaceEvaluator, cell: int) -> List[int]:
    size = [0, 0]
    if not evaluator.GetNetSize(cell, size):
        raise ValueError(evaluator.GetErrorMessage())
    return size


def _get(evaluator: vtkNURBSFaceEvaluator, cell: int) -> Surface:
    nu, nv = _net_size(evaluator, cell)
    degree = [0, 0]
    evaluator.GetDegree(cell, degree)
    array = vtkDoubleArray()
    knots = []
    for direction in (0, 1):
        evaluator.GetKnots(cell, direction, array)
        knots.append(vtk_to_numpy(array).copy())
    evaluator.GetControlPoints(cell, array)
    points = np.ascontiguousarray(vtk_to_numpy(array).reshape(nv, nu, 3).swapaxes(0, 1))
    weights = None
    if evaluator.IsRational(cell):
        evaluator.GetWeights(cell, array)
        weights = np.ascontiguousarray(vtk_to_numpy(array).reshape(nv, nu).T)
    loops = [[_get_curve(evaluator, cell, loop, curve)
              for curve in range(evaluator.GetNumberOfTrimCurves(cell, loop))]
             for loop in range(evaluator.GetNumberOfLoops(cell))]  # fmt: skip
    model = evaluator.GetModel()
    names = model.GetCellData().GetAbstractArray(vtkNURBSModel.NameName())
    colors = model.GetCellData().GetArray(vtkNURBSModel.ColorName())
    red, green, blue = colors.GetTuple(cell) if colors else (0, 0, 0)
    return Surface(points, (knots[0], knots[1]), (degree[0], degree[1]), weights, loops,
                   name=names.GetValue(cell) if names else "",
                   color=(int(red), int(green), int(blue)) if colors else None,
                   face_id=vtkNURBSModel.GetFaceId(model, cell),
                   reversed=evaluator.IsReversed(cell))  # fmt: skip


def _get_curve(evaluator: vtkNURBSFaceEvaluator, cell: int, loop: int, curve: int) -> TrimCurve:
    points, knots = vtkDoubleArray(), vtkDoubleArray()
    evaluator.GetTrimCurve(cell, loop, curve, points, knots)
    uvw = vtk_to_numpy(points).copy()
    return TrimCurve(uvw[:, :2], vtk_to_numpy(knots).copy(), knots.GetNumberOfTuples() - len(uvw) - 1,
                     uvw[:, 2] if np.any(uvw[:, 2] != uvw[0, 2]) else None,
                     evaluator.GetTrimCurveEdge(cell, loop, curve),
                     evaluator.IsTrimCurveReversed(cell, loop, curve))  # fmt: skip
