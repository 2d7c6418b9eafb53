"""The soles: the rectangle inside the lowest face of a foot's shapes, where it touches the ground."""

from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from scipy.spatial import ConvexHull, QhullError

from surefoot.models.robot_file.meshes import outer
from surefoot.models.types import Array, RobotError

_DOWN = 0.8
"""Least share of a face's normal that points down for it to be a sole [-]."""

_ALIKE = 0.9995
"""Cosine of the angle up to which faces are one [-]."""

_THICK = 0.01
"""Height above the lowest point within which a foot touches, over the foot's length [-]."""

_LEVEL = 0.02
_GRID = 33


@dataclass(frozen=True, slots=True)
class SolePlate:
    """The contact rectangle of a foot.

    Attributes:
        placement: in the frame of the foot's joint: origin at the rectangle's centre, x forward, z up.
        length: along x [m].
        width: along y [m].
    """

    placement: pin.SE3
    length: float
    width: float


def sole_of(points: Array, upright: Array, link: str, robot: str) -> SolePlate:
    """Find the sole of a foot.

    Args:
        points: vertices of its shapes in the frame of its joint, shape (n, 3) [m].
        upright: axes forward, left and up as columns in that frame, as far as they are known, shape (3, 3).
        link: for messages.
        robot: name of the robot, for messages.

    Raises:
        RobotError: no face of the foot is a sole.
    """
    if len(points) < 4:
        raise _no_sole(robot, link, "has no shapes")
    normal, corners = _bearing(outer(points), upright[:, 2], link, robot)
    R = _frame(upright, normal)
    local = corners @ R
    thick = _THICK * float(np.ptp(local[:, 0]))
    touching = local[local[:, 2] < local[:, 2].min() + thick, :2]
    try:
        polygon = touching[ConvexHull(touching).vertices]
    except QhullError:
        raise _no_sole(robot, link, "touches the ground in a line or a point") from None
    (x0, x1), (y0, y1) = largest_rectangle(polygon)
    centre = R @ np.array([(x0 + x1) / 2, (y0 + y1) / 2, local[:, 2].min()])
    return SolePlate(pin.SE3(R, centre), x1 - x0, y1 - y0)


def _bearing(points: Array, up: Array, link: str, robot: str) -> tuple[Array, Array]:
    """Upward normal of the face that bears, and the corners of the foot; level points are a face."""
    try:
        hull = ConvexHull(points)
    except QhullError:
        if np.ptp(points @ up) < _THICK * float(np.ptp(points, axis=0).max()):
            return np.array(up), points
        raise _no_sole(robot, link, "is flat") from None
    normal = _lowest_face(points, hull, up)
    if normal is None:
        raise _no_sole(robot, link, "has no face that points down")
    return normal, points[hull.vertices]


def _no_sole(robot: str, link: str, why: str) -> RobotError:
    what = f"foot '{link}' of {robot} {why}"
    return RobotError(("sole",), what, "give sole: {length: m, width: m, centre: [x, y, z]} in the frame of that link")


def _lowest_face(points: Array, hull: ConvexHull, up: Array) -> Array | None:
    """Inward normal of the face that bears: of those that point down, the one with the largest area."""
    normals = -hull.equations[:, :3]
    a, b, c = (points[hull.simplices[:, corner]] for corner in range(3))
    areas = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    below = normals @ up > _DOWN
    if not below.any():
        return None
    normals, areas = normals[below], areas[below]
    together = (normals @ normals.T > _ALIKE).astype(float)
    best = int(np.argmax(together @ areas))
    normal = (together[best] * areas) @ normals
    normal /= np.linalg.norm(normal)
    return np.array(up) if normal @ up > 1.0 - 0.5 * _LEVEL**2 else normal


def _frame(upright: Array, normal: Array) -> Array:
    """Axes of the sole as columns: z along the normal, x as far forward as that allows."""
    left = np.cross(normal, upright[:, 0])
    left /= np.linalg.norm(left)
    return np.column_stack((np.cross(left, normal), left, normal))


def largest_rectangle(polygon: Array) -> tuple[tuple[float, float], tuple[float, float]]:
    """Ranges in x and y of the largest rectangle along the axes inside a convex polygon, shape (n, 2) in order.

    Over two values of x the widest common range of y is exact; the values are searched on a grid that closes in.
    """
    low = high = None
    span, centre = float(np.ptp(polygon[:, 0])), float(polygon[:, 0].min() + np.ptp(polygon[:, 0]) / 2)
    left = right = np.linspace(centre - span / 2, centre + span / 2, _GRID)
    for _ in range(6):
        (low0, high0), (low1, high1) = (_range_at(polygon, xs) for xs in (left, right))
        low, high = np.maximum(low0[:, None], low1), np.minimum(high0[:, None], high1)
        area = (right[None] - left[:, None]).clip(0.0) * (high - low).clip(0.0)
        i, j = np.unravel_index(int(np.argmax(area)), area.shape)
        found = (float(left[i]), float(right[j])), (float(low[i, j]), float(high[i, j]))
        step = left[1] - left[0]
        left, right = (np.linspace(value - step, value + step, _GRID) for value in found[0])
    return found


def _range_at(polygon: Array, xs: Array) -> tuple[Array, Array]:
    """Lower and upper bound of a convex polygon at abscissas, crossed where it does not reach."""
    start, end = polygon, np.roll(polygon, -1, axis=0)
    run = end[:, 0] - start[:, 0]
    slanted = np.abs(run) > 1e-12
    start, end, run = start[slanted], end[slanted], run[slanted]
    t = (xs[:, None] - start[:, 0]) / run
    y = start[:, 1] + t * (end[:, 1] - start[:, 1])
    inside = (t >= -1e-12) & (t <= 1.0 + 1e-12)
    return np.where(inside, y, np.inf).min(axis=1), np.where(inside, y, -np.inf).max(axis=1)
