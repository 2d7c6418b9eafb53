"""Convex hulls in the plane, of the few points that soles have; a library would take a third of a second to import."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

FLAT, ROUNDING = 1e-12, 16.0 * float(np.finfo(np.float64).eps)
"""Least share of the extent by which a vertex stands out, and the share that rounding may feign [-]."""


def convex_hull(points: Array) -> Array:
    """Vertices of the convex hull, anticlockwise from the leftmost one, shape (v, 2).

    Andrew's monotone chain (Information Processing Letters 9, 1979). Points on an edge, but for rounding, are none.

    Args:
        points: shape (n, 2), at least three that are not on a line.
    """
    ordered, vertices = np.array(points, dtype=np.float64), np.zeros((2 * len(points) + 2, 2))
    count = hull(ordered, len(ordered), vertices)
    corner, flat = 0, flatness(ordered, len(ordered))
    while corner < count:
        before, after = (corner + count - 1) % count, (corner + 1) % count
        if _left_turn(vertices, before, corner, vertices, after) > flat:
            corner += 1
        else:
            vertices[corner : count - 1] = vertices[corner + 1 : count].copy()
            count, corner = count - 1, max(corner - 1, 0)
    return vertices[:count].copy()


def flatness(points: Array, count: int) -> float:
    """Twice the area up to which a vertex of so many points does not stand out, of their extent and coordinates."""
    left, right, below, above = points[0, 0], points[0, 0], points[0, 1], points[0, 1]
    for k in range(1, count):
        x, y = points[k, 0], points[k, 1]
        left = min(left, x)
        right = max(right, x)
        below = min(below, y)
        above = max(above, y)
    extent: float = max(right - left, above - below)
    most: float = max(max(abs(right), abs(left)), max(abs(above), abs(below)))
    return extent * (FLAT * extent + ROUNDING * most)


def hull(points: Array, count: int, vertices: Array) -> int:
    """Write the vertices of the anticlockwise hull of a few points, but for those on its edges.

    Andrew's monotone chain, in memory that is given.

    Args:
        points: shape (n, 2), which are sorted.
        count: of points that count.
        vertices: shape (at least 2 count + 2, 2).

    Returns:
        How many vertices there are.
    """
    for k in range(1, count):
        i = k
        while i > 0 and not (
            points[i - 1, 0] < points[i, 0] or (points[i - 1, 0] == points[i, 0] and points[i - 1, 1] <= points[i, 1])
        ):
            x, y = points[i, 0], points[i, 1]
            points[i, 0], points[i, 1] = points[i - 1, 0], points[i - 1, 1]
            points[i - 1, 0], points[i - 1, 1] = x, y
            i -= 1
    found = 0
    for upper in range(2):
        first = found
        for k in range(count):
            i = count - 1 - k if upper else k
            while found >= first + 2 and _left_turn(vertices, found - 2, found - 1, points, i) <= 0.0:
                found -= 1
            vertices[found, 0], vertices[found, 1] = points[i, 0], points[i, 1]
            found += 1
        found -= 1  # the last one begins the other half
    return found


def _left_turn(vertices: Array, a: int, b: int, points: Array, c: int) -> float:
    """Twice the area of two vertices and a point, positive where the way from a by b to c turns left."""
    ax, ay, bx, by = vertices[a, 0], vertices[a, 1], vertices[b, 0], vertices[b, 1]
    twice: float = (bx - ax) * (points[c, 1] - ay) - (by - ay) * (points[c, 0] - ax)
    return twice
