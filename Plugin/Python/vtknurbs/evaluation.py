# SPDX-License-Identifier: BSD-3-Clause
"""Points, derivatives, normals and curvatures of a model's faces as numpy arrays."""

from typing import Any, Tuple

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkUnsignedCharArray
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid

from .surfaces import _evaluator

__all__ = ["Evaluator"]


class Evaluator:
    """Evaluates the faces (cells) of a model at many parameters at once.

    Parameters are arrays (..., 2) of u and v in the face's own domain, results have the same leading
    shape. Work is done in C++, on all threads (vtkNURBSFaceEvaluator). After control points were
    written to, call model.GetPoints().Modified().

    Raises ValueError, which names the cell and the reason, for a face that can't be used and for
    parameters outside its domain.
    """

    def __init__(self, model: vtkUnstructuredGrid):
        self._faces = _evaluator(model)

    def domain(self, cell: int) -> Tuple[Tuple[float, float], Tuple[float, float]]:
        """((u min, u max), (v min, v max)) of a cell."""
        box = [0.0] * 4
        self._check(self._faces.GetDomain(cell, box))
        return (box[0], box[1]), (box[2], box[3])

    def points(self, cell: int, uv: Any) -> np.ndarray:
        """Points on the surface, (..., 3)."""
        return self._evaluate(cell, uv, 0)[..., 0, :]

    def derivatives(self, cell: int, uv: Any, order: int = 1) -> np.ndarray:
        """Points and partial derivatives, (..., 3, 3): S, Su, Sv; of order 2, (..., 6, 3): S, Su, Sv,
        Suu, Suv, Svv. At a knot those after it, at the domain's end before it."""
        if order not in (1, 2):
            raise ValueError(f"order {order} is neither 1 nor 2")
        return self._evaluate(cell, uv, order)

    def normals(self, cell: int, uv: Any) -> np.ndarray:
        """Unit normals, (..., 3), outwards; at poles the limit."""
        shape, parameters = self._parameters(cell, uv)
        result = vtkDoubleArray()
        self._check(self._faces.EvaluateNormals(cell, parameters, result))
        return vtk_to_numpy(result).reshape(shape + (3,))

    def curvatures(self, cell: int, uv: Any) -> np.ndarray:
        """Principal curvatures, (..., 2): the smaller and the larger, in 1 / length; positive where the
        surface bends away from its outside, as a ball does. NaN at poles."""
        s = self._evaluate(cell, uv, 2)
        normal = self.normals(cell, uv)
        with np.errstate(invalid="ignore", divide="ignore"):
            e, f, g = (np.sum(s[..., i, :] * s[..., k, :], -1) for i, k in ((1, 1), (1, 2), (2, 2)))
            l, m, n = (-np.sum(s[..., i, :] * normal, -1) for i in (3, 4, 5))
            area = e * g - f * f
            mean = (e * n - 2 * f * m + g * l) / (2 * area)
            spread = np.sqrt(np.maximum(mean * mean - (l * n - m * m) / area, 0))
        return np.stack([mean - spread, mean + spread], -1)

    def inside(self, cell: int, uv: Any) -> np.ndarray:
        """True where the parameters are inside the face's trims, (...,)."""
        shape, parameters = self._parameters(cell, uv)
        result = vtkUnsignedCharArray()
        self._check(self._faces.EvaluateInside(cell, parameters, result))
        return vtk_to_numpy(result).reshape(shape).astype(bool)

    def _check(self, done: bool) -> None:
        if not done:
            raise ValueError(self._faces.GetErrorMessage())

    def _parameters(self, cell: int, uv: Any) -> Tuple[Tuple[int, ...], Any]:
        """The shape of the results, and the parameters as the two columns that VTK wants."""
        array = np.asarray(uv, dtype=np.float64)
        if array.ndim == 0 or array.shape[-1] != 2:
            raise ValueError(f"cell {cell}: parameters have the shape {array.shape} instead of (..., 2)")
        flat = np.ascontiguousarray(array.reshape(-1, 2))
        for k, (low, high) in enumerate(self.domain(cell)):
            outside = ~((flat[:, k] >= low) & (flat[:, k] <= high))
            if outside.any():
                worst = flat[np.argmax(outside), k]
                raise ValueError(f"cell {cell}: {'uv'[k]} = {worst:g} is outside the domain, {low:g} to "
                                 f"{high:g}")  # fmt: skip
        return array.shape[:-1], numpy_to_vtk(flat)

    def _evaluate(self, cell: int, uv: Any, order: int) -> np.ndarray:
        shape, parameters = self._parameters(cell, uv)
        result = vtkDoubleArray()
        self._check(self._faces.Evaluate(cell, parameters, order, result))
        return vtk_to_numpy(result).reshape(shape + (-1, 3) if result.GetNumberOfTuples()
                                            else shape + ((1, 3, 6)[order], 3))  # fmt: skip
