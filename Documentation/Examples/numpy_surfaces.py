"""Surfaces from numpy arrays: a wavy sheet with a round hole, and a tube through it.

    python3 numpy_surfaces.py     writes numpy_surfaces.png
"""

import numpy as np

import vtknurbs

# A circle as a rational curve of nine control points: the sheet's hole in (u, v), the tube's rows.
circle = np.array([(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)])
knots = np.repeat([0, 1, 2, 3, 4], [3, 2, 2, 2, 3])
weights = np.array([1, np.sqrt(0.5)] * 4 + [1])

x, y = np.meshgrid(np.linspace(-5, 5, 9), np.linspace(-4, 4, 7), indexing="ij")
sheet = vtknurbs.Surface(
    np.stack([x, y, np.cos(x)], -1), degrees=(3, 3), name="sheet", color=(160, 185, 225),
    trims=[[(0, 0), (1, 0), (1, 1), (0, 1)],
           vtknurbs.TrimCurve(0.5 + 0.2 * circle[::-1], knots, weights=weights)])  # fmt: skip
tube = vtknurbs.Surface(
    np.stack([np.column_stack([circle, np.full(9, z)]) for z in (-1.5, 3)], 1),
    (knots, (0, 0, 1, 1)), weights=np.outer(weights, (1, 1)), name="tube", color=(235, 160, 90))
model = vtknurbs.make_model([sheet, tube])  # validated; a ValueError would name surface and reason

evaluator = vtknurbs.Evaluator(model)
uv = np.random.default_rng(1).uniform(0, 1, (100000, 2))
print(f"hole: {1 - evaluator.inside(0, uv).mean():.3f} of the domain, exactly {0.04 * np.pi:.3f}")
radius = np.hypot(*evaluator.points(1, uv * (4, 1))[:, :2].T)
print(f"tube: radius 1 within {np.abs(radius - 1).max():.0e}")
back = vtknurbs.get_surface(model, 0)  # the way back
print(back.name, back.degrees, back.points.shape, len(back.trims), "loops")
vtknurbs.render(model, file="numpy_surfaces.png", size=(400, 280), view=(1, -2, 1.5), zoom=1.4)
