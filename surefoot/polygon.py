"""Convex hulls in the plane, of the few points that soles have; a library would take a third of a second to import."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

FLAT, ROUNDING = 1e-12, 16.0 * float(np.finfo(np.float64).eps)
"""Which part of the extent a vertex stands out at least, and what rounding of the coordinates may feign [-]."""


def convex_hull(points: Array) -> Array:
    """Vertices of the convex hull, anticlockwise from the leftmost one, shape (v, 2).

    Andrew's monotone chain (Information Processing Letters 9, 1979). Points on an edge, but for rounding, are none.

    Args:
        points: shape (n, 2), at least three that are not on a line.
    """
    x, y = points.T.tolist()
    ordered = sorted(set(zip(x, y, strict=True)))
    hull = [*_chain(ordered)[:-1], *_chain(ordered[::-1])[:-1]]
    right, left, above, below = max(x), min(x), max(y), min(y)
    extent = max(right - left, above - below)
    flat = extent * (FLAT * extent + ROUNDING * max(abs(right), abs(left), abs(above), abs(below)))
    corner = 0
    while corner < len(hull):
        if _left_turn(hull[corner - 1], hull[corner], hull[(corner + 1) % len(hull)]) > flat:
            corner += 1
        else:
            del hull[corner]
            corner = max(corner - 1, 0)
    return np.array(hull)


_Point = tuple[float, float]


def _left_turn(a: _Point, b: _Point, c: _Point) -> float:
    """Twice the area of a triangle, positive where the way from a by b to c turns left."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _chain(points: list[_Point]) -> list[_Point]:
    """The points at which a way along them turns left, from the first to the last."""
    chain: list[_Point] = []
    for point in points:
        while len(chain) > 1 and _left_turn(chain[-2], chain[-1], point) <= 0.0:
            chain.pop()
        chain.append(point)
    return chain
