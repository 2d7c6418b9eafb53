"""Meshes of links, small enough to stand inside a text: decimated ones to look at, convex hulls to touch with.

A CAD system's meshes have some hundred thousand triangles, of which a viewer needs a twentieth. First, vertices in one
cell of a grid much finer than the final triangles become one. That closes seams between parts, drops what is too small
to be seen, and takes a fraction of the time. Quadric edge collapse (Garland and Heckbert, 1997) does the rest: first up
to one error for all meshes, so that each keeps the triangles that it needs, then down to the number that there may be.
"""

from collections.abc import Sequence

import fast_simplification
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from surefoot.models.types import Array, RobotError

Faces = NDArray[np.int64]
Triangles = tuple[Array, Faces]
"""Vertices, shape (n, 3) [m], and their indices in each triangle, counter-clockwise from outside, shape (m, 3)."""

MOST_FACES = 25_000
"""Triangles of a whole robot: what looks right at half a megabyte of text."""

GRID = 0.1
"""Side of the cells in which vertices become one, over the edge of the triangles to be [-]."""

MOST_COLLAPSED = 600_000
"""Triangles of a whole robot whose edges are collapsed up to an error, some us each; of more, the grid makes less."""

MOST_WILLING = 100_000
"""Triangles of a whole robot that are collapsed to a number: where a surface is rough, that takes up to 90 us each."""

_NEARLY = 1.2
"""Triangles of a robot over those that there may be from which a coarser grid makes less [-]."""

PRECISION = 0.08
"""Unit of length for the thresholds of the collapse, over the root of the robot's area: smaller is finer [-]."""

MOST_EXACT = 30_000
"""Points of a link whose convex hull is exact, 8 us each where all are corners of it."""

DEPTH = 2e-4
"""Depth outside a hull at which points of more join it, over their extent [-]."""

_CAREFUL, _WILLING = 3.0, 5.0
"""Steps of the collapse's thresholds, so that it ends at what can be seen, or at the number that is asked for."""

_PACKED = 21
"""Bits of each of the three coordinates of a cell in one integer."""


def decimated(parts: Sequence[Triangles], most_faces: int = MOST_FACES) -> tuple[Triangles, ...]:
    """The meshes of a robot with so few triangles that all together have about `most_faces` at most.

    Args:
        parts: meshes, each in any frame; vertices may be there once for each of their triangles.
        most_faces: triangles of the whole robot.

    Returns:
        each in its frame, in the order of the parts; one that is too small to be seen has no triangle.
    """
    areas = np.array([_area(part) for part in parts])
    if not areas.sum() > 0.0:
        return tuple(parts)
    size = float(np.sqrt(areas.sum()))
    cell = GRID * size * np.sqrt(2.0 / most_faces)
    coarse = [merged(part, cell) for part in parts]
    coarse, cell = _coarser(coarse, cell, MOST_COLLAPSED)
    plain = [_collapsed(part, 0, size * PRECISION, _CAREFUL) for part in coarse]
    while True:
        plain, cell = _coarser(plain, cell, max(MOST_WILLING, most_faces))
        share = most_faces / max(_count(plain), most_faces)
        few = [_collapsed(part, round(share * len(part[1])), size, _WILLING) for part in plain]
        if _count(few) <= _NEARLY * most_faces:
            return tuple(few)
        plain, cell = _coarser(few, cell, _count(few) - 1)


def thinned(part: Triangles, most: int) -> Triangles:
    """A mesh on a grid so coarse that it has at most `most` triangles, each corner of which is a vertex of before.

    Of the vertices in a cell a corner of the convex hull stays, so that the hull hardly changes.
    """
    vertices, faces = part
    first = _corners(vertices)
    order = np.concatenate((first, np.setdiff1d(np.arange(len(vertices)), first)))
    renamed = np.empty_like(order)
    renamed[order] = np.arange(len(order))
    size = float(np.sqrt(_area(part)))
    thin, _ = _coarser([(vertices[order], renamed[faces])], size / np.sqrt(most), most)
    return thin[0]


def _coarser(parts: list[Triangles], cell: float, most: int) -> tuple[list[Triangles], float]:
    """Meshes that have so few triangles on a grid as coarse as that takes, and the side of its cells [m]."""
    while _count(parts) > most:
        cell *= 1.5
        parts = [_distinct(merged(part, cell)) for part in parts]
    return parts, cell


def _count(parts: Sequence[Triangles]) -> int:
    return sum(len(faces) for _, faces in parts)


def outer(points: Array) -> Array:
    """Points whose convex hull is that of all, or where they are very many nearly that.

    Quickhull (Barber, Dobkin and Huhdanpaa, 1996) then passes over a point that is less deep than `DEPTH` outside the
    hull so far. That bounds no error of the whole: smooth, flat and rough shapes came out within a thousandth of their
    extent.

    Args:
        points: shape (n, 3) [m].
    """
    return points if len(points) <= MOST_EXACT else np.asarray(points[_corners(points)])


def _corners(points: Array) -> Faces:
    """Indices of points whose convex hull is nearly that of all; of all where they lie in a plane."""
    try:
        depth = DEPTH * float(np.ptp(points, axis=0).max())
        return np.asarray(ConvexHull(points, qhull_options=f"Qt W{depth:.17g}").vertices, dtype=np.int64)
    except (QhullError, ValueError):
        return np.arange(len(points))


def hull(vertices: Array, most: int) -> Triangles:
    """Convex hull of points; if it has too many corners, of those that make most of it.

    Args:
        vertices: shape (n, 3) [m].
        most: corners of the hull.

    Raises:
        RobotError: the points lie in a plane.
    """
    try:
        vertices = outer(vertices)
        corners = vertices[ConvexHull(vertices).vertices]
        if len(corners) > most:
            corners = _outermost(corners, most)
        found = ConvexHull(corners)
    except (QhullError, ValueError):
        what = f"a mesh of {len(vertices)} vertices has no volume"
        raise RobotError(("model",), what, "give collision shapes with a thickness") from None
    a, b, c = corners[found.simplices].transpose(1, 0, 2)
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), found.equations[:, :3]) < 0.0
    faces = found.simplices.astype(np.int64)
    faces[inward] = faces[inward][:, ::-1]
    return corners, faces


def merged(part: Triangles, cell: float) -> Triangles:
    """A mesh whose vertices in one cell of a grid are one, without what became of triangles inside a cell.

    Args:
        part: vertices and faces.
        cell: side of the cells [m].
    """
    vertices, faces = part
    if not len(faces):
        return part
    low, extent = vertices.min(axis=0), float(np.ptp(vertices, axis=0).max())
    cell = max(cell, extent / (2**_PACKED - 2))
    x, y, z = np.rint((vertices - low) / cell).astype(np.int64).T
    _, first, place = np.unique(x | y << _PACKED | z << 2 * _PACKED, return_index=True, return_inverse=True)
    a, b, c = renamed = place[faces].T
    return _used(vertices[first], renamed.T[(a != b) & (b != c) & (c != a)])


def _distinct(part: Triangles) -> Triangles:
    """A mesh with each triangle once, whichever way it is turned: collapsing takes long where many lie in one place."""
    vertices, faces = part
    _, first = np.unique(np.sort(faces, axis=1), axis=0, return_index=True)
    return vertices, faces[np.sort(first)]


def _outermost(corners: Array, most: int) -> Array:
    """So many of the points that their hull is nearly that of all: time and again those farthest outside join it."""
    chosen = np.unique(np.concatenate((corners.argmin(axis=0), corners.argmax(axis=0))))
    chosen = np.union1d(chosen, [np.linalg.norm(corners - corners[chosen].mean(axis=0), axis=1).argmax()])
    while len(chosen) < most:
        found = ConvexHull(corners[chosen], qhull_options="QJ")
        outside = corners @ found.equations[:, :3].T + found.equations[:, 3]
        farthest = outside.argmax(axis=0)
        order = np.argsort(-outside.max(axis=0), kind="stable")
        new = [point for point in dict.fromkeys(farthest[order].tolist()) if point not in chosen]
        if not new:
            break
        chosen = np.union1d(chosen, new[: (most - len(chosen) + 1) // 2])
    farthest_out: Array = corners[chosen]
    return farthest_out


def _collapsed(part: Triangles, least: int, size: float, aggressiveness: float) -> Triangles:
    """A mesh whose edges are collapsed until it has `least` triangles, or until that would be seen at this size [m]."""
    vertices, faces = part
    if len(faces) <= max(least, 4):
        return part
    scaled, corners = vertices / size, faces.astype(np.int32)
    scaled, corners = fast_simplification.simplify(scaled, corners, target_count=max(least, 4), agg=aggressiveness)
    return _used(np.asarray(size * scaled, dtype=np.float64), np.asarray(corners, dtype=np.int64))


def _used(vertices: Array, faces: Faces) -> Triangles:
    """Without vertices of no triangle."""
    kept, renamed = np.unique(faces, return_inverse=True)
    return vertices[kept], renamed.reshape(faces.shape).astype(np.int64)


def _area(part: Triangles) -> float:
    a, b, c = part[0][part[1]].transpose(1, 0, 2)
    return float(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())
