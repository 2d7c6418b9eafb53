"""Planar frames, soles that lie flat on ground, one or many, convex polygons on the ground, and quintic curves.

Angles of soles are those of `planner.geometry.orientation`.
"""

import math

import numpy as np

from surefoot.maths import algebra
from surefoot.planner.geometry.orientation import sole_rotation as sole_rotation
from surefoot.planner.geometry.quintic import between
from surefoot.planner.types import Array, Footstep


def frame_rotation(yaw: float) -> Array:
    """Rotation from a frame of that heading to the world, shape (2, 2)."""
    R = np.empty((2, 2))
    turn_plane(yaw, R)
    return R


def turn_plane(yaw: float, R: Array) -> None:
    """Write what `frame_rotation` gives into an array, shape (2, 2)."""
    c, s = math.cos(yaw), math.sin(yaw)
    R[0, 0], R[0, 1] = c, -s
    R[1, 0], R[1, 1] = s, c


def wrap_angle(angle: float) -> float:
    """The same angle in [-pi, pi) [rad]."""
    return (angle + math.pi) % (2.0 * math.pi) - math.pi


def seen_from(stance: Footstep, place: Footstep) -> Footstep:
    """A foothold in the frame of another one, that of its stance foot; its turn is not wrapped."""
    # In plain numbers: for products of small arrays numpy takes longer than for all of this.
    c, s = math.cos(stance.yaw), math.sin(stance.yaw)
    (x, y, z), (u, v, w), (a, b, upright) = place.position.tolist(), stance.position.tolist(), place.normal.tolist()
    x, y = x - u, y - v
    position, normal = np.array(((x * c + y * s, y * c - x * s, z - w), (a * c + b * s, b * c - a * s, upright)))
    return Footstep(place.foot, position, place.yaw - stance.yaw, normal, place.step, place.touchdown_time)


def sole_angles(normal: Array, yaw: float) -> tuple[float, float]:
    """Pitch and roll of a sole of a heading that lies flat on ground [rad].

    Args:
        normal: unit normal of the ground, upwards, shape (3,) [-].
        yaw: heading [rad].
    """
    x, y, z = normal.tolist()
    c, s = math.cos(yaw), math.sin(yaw)
    return math.atan2(c * x + s * y, z), math.asin(s * x - c * y)


def sole_pose(position: Array, yaw: float, normal: Array) -> Array:
    """Position, yaw, pitch and roll of a sole flat on ground of a normal, shape (6,) [m, rad]."""
    return np.array([*position.tolist(), yaw, *sole_angles(normal, yaw)])


CORNERS = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])
"""Corners of a rectangle in half sizes, anticlockwise from the one ahead on the left, shape (4, 2) [-]."""
CORNERS.flags.writeable = False


def sole_corners(footstep: Footstep, half_size: Array) -> Array:
    """Corners of a sole seen from above, anticlockwise, shape (4, 2) [m].

    Args:
        footstep: where the sole stands.
        half_size: half of its length and width, shape (2,) [m].
    """
    return points_of_sole(footstep, CORNERS * half_size)


def points_of_sole(footstep: Footstep, points: Array) -> Array:
    """Points of a sole seen from above, given in its own frame, shape (n, 2) [m]."""
    R, placed = sole_rotation(footstep.yaw, *sole_angles(footstep.normal, footstep.yaw)), np.empty((len(points), 2))
    place_points(footstep.position, R, points, placed)
    return placed


def place_points(origin: Array, R: Array, points: Array, placed: Array) -> None:
    """Write where points, shape (n, 2), of a frame at an origin, shape (2 or more,), with a rotation R are, (n, 2)."""
    for k in range(points.shape[0]):
        x, y = points[k, 0], points[k, 1]
        placed[k, 0] = origin[0] + x * R[0, 0] + y * R[0, 1]
        placed[k, 1] = origin[1] + x * R[1, 0] + y * R[1, 1]


def rotations(quaternions: Array) -> Array:
    """Rotation matrices of quaternions x y z w, shape (n, 3, 3)."""
    R = np.empty((len(quaternions), 3, 3))
    turn_each(np.asarray(quaternions, dtype=np.float64), R)
    return R


def turn_each(quaternions: Array, R: Array) -> None:
    """Write what `rotations` gives into an array, shape (n, 3, 3)."""
    for k in range(quaternions.shape[0]):
        first, second, third = algebra.quaternion_rows(
            quaternions[k, 0], quaternions[k, 1], quaternions[k, 2], quaternions[k, 3]
        )
        algebra.put_row(R[k], 0, first)
        algebra.put_row(R[k], 1, second)
        algebra.put_row(R[k], 2, third)


def forward(quaternions: Array) -> Array:
    """Forward axes x y seen from above, of quaternions x y z w of shape (..., 4), shape (..., 2)."""
    x, y, z, w = np.moveaxis(quaternions, -1, 0)
    return np.stack((1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z)), axis=-1)


def headings(quaternions: Array) -> Array:
    """Headings of quaternions x y z w of shape (..., 4), shape (...) [rad]."""
    axis = forward(quaternions)
    return np.asarray(np.arctan2(axis[..., 1], axis[..., 0]))


def corners(poses: Array, length: float, width: float) -> Array:
    """Corners of soles of any orientation, in order, shape (n, 4, 3) [m].

    Args:
        poses: x y z qx qy qz qw, shape (n, 7).
        length: of a sole [m].
        width: of a sole [m].
    """
    local = np.column_stack((0.5 * CORNERS * (length, width), np.zeros(4)))
    return np.asarray(poses[:, None, :3] + np.einsum("nij,kj->nki", rotations(poses[:, 3:]), local))


def level_corners(places: Array, length: float, width: float) -> Array:
    """Corners of level soles seen from above, in order, shape (n, 4, 2) [m].

    Args:
        places: x y and a heading last, what is between does not matter, shape (n, 3 or more) [m, rad].
        length: of a sole [m].
        width: of a sole [m].
    """
    local = 0.5 * CORNERS * (length, width)
    heading = places[:, places.shape[1] - 1, None]
    cosine, sine = np.cos(heading), np.sin(heading)
    x = places[:, 0, None] + cosine * local[:, 0] - sine * local[:, 1]
    y = places[:, 1, None] + sine * local[:, 0] + cosine * local[:, 1]
    return np.stack((x, y), axis=2)


def points_seen_from(poses: Array, points: Array) -> Array:
    """Points of the ground plane ahead and to the left of poses, shape (n, 2) [m].

    Args:
        poses: x y z yaw, shape (n, 4) or (4,) [m, rad].
        points: in the world, shape (n, 2) [m].
    """
    sine, cosine = np.sin(poses[..., 3]), np.cos(poses[..., 3])
    x, y = (points - poses[..., :2]).T
    return np.column_stack([cosine * x + sine * y, cosine * y - sine * x])


def signed_distance(polygon: Array, point: Array) -> float:
    """Distance to the nearest edge's line, positive inside [m]; outside it is a lower bound of the true distance."""
    edge, offset = _edges(polygon), point - polygon
    distances = (edge[:, 0] * offset[:, 1] - edge[:, 1] * offset[:, 0]) / np.hypot(edge[:, 0], edge[:, 1])
    return float(np.minimum.reduce(distances))


def _edges(polygon: Array) -> Array:
    """From each corner to the next, shape (n, 2) [m]; `numpy.roll` takes five times as long."""
    return np.concatenate((polygon[1:], polygon[:1])) - polygon


def nearest_point(polygon: Array, point: Array) -> Array:
    """The point of a convex anticlockwise polygon nearest to another one, shape (2,) [m]."""
    if signed_distance(polygon, point) >= 0.0:
        return point
    edge = _edges(polygon)
    along = np.einsum("ij,ij->i", point - polygon, edge) / np.einsum("ij,ij->i", edge, edge)
    candidates = polygon + np.clip(along, 0.0, 1.0)[:, None] * edge
    return np.asarray(candidates[np.argmin(np.sum((candidates - point) ** 2, axis=1))])


_BINOMIAL = np.array([[math.comb(i, k) for i in range(6)] for k in range(6)], dtype=float)


def quintic(start: Array, end: Array, duration: float) -> Array:
    """Quintic between two states.

    Args:
        start: position, velocity, acceleration at time 0, shape (3, k).
        end: the same at time `duration`, shape (3, k).
        duration: [s].

    Returns:
        Coefficients of 1, t, ..., t^5, shape (6, k).
    """
    ends = zip(start.T.tolist(), end.T.tolist(), strict=True)
    ways = (between(tuple(one), tuple(other), duration) for one, other in ends)
    return np.array([*zip(*ways, strict=True)])


greatest = np.maximum.reduce
"""The largest of an array along its first axis; the method ``max`` goes through Python first."""


def shifted(coefficients: Array, time: float) -> Array:
    """The same polynomials with their local time starting at `time`."""
    return np.asarray(shift(time) @ coefficients)


def shift(time: float) -> Array:
    """The matrix that makes the coefficients of polynomials of fifth degree those of a later begin, shape (6, 6)."""
    A = np.zeros((6, 6))
    expand(time, _BINOMIAL, A)
    return A


def expand(time: float, binomial: Array, A: Array) -> None:
    """Write what `shift` gives into an array of zeros: A_ki = (i over k) t^(i - k)."""
    for i in range(6):
        power = math.pow(time, i)
        for k in range(6 - i):
            A[k, k + i] = binomial[k, k + i] * power


def yaw_rotations(yaw: Array) -> Array:
    """Rotations about the vertical, shape (n, 3, 3).

    Args:
        yaw: shape (n,) [rad].
    """
    c = np.cos(yaw)
    s = np.sin(yaw)
    zero = np.zeros_like(yaw)
    one = np.ones_like(yaw)
    return np.moveaxis(np.array(((c, -s, zero), (s, c, zero), (zero, zero, one))), -1, 0)
