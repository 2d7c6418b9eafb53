"""How the IMU moves: its frame in the world from the true state, through the joints between it and the base."""

import math
from dataclasses import dataclass

import mujoco
import numpy as np

from surefoot.models.types import ImuPlace
from surefoot.sim.measurement import Array


@dataclass(frozen=True, slots=True)
class ImuMotion:
    """Motion of the IMU's frame at one instant.

    Attributes:
        rotation: of its axes in the world, shape (3, 3).
        velocity: of its origin, world axes, shape (3,) [m/s].
        angular_velocity: in its own axes, shape (3,) [rad/s].
    """

    rotation: Array
    velocity: Array
    angular_velocity: Array


@dataclass(frozen=True, slots=True)
class _Link:
    """A body of the chain at zero angle in its parent, and the joint that turns it about a point of its own."""

    rotation: Array
    position: Array
    joint: int
    axis: Array
    twist: Array
    point: Array


class ImuChain:
    """The bodies from the floating base to the IMU.

    Args:
        model: of the world.
        base: number of the floating base's body.
        place: of the IMU.
        turn: rotation vector by which it is mounted wrongly, in its own axes, shape (3,) [rad].
        shift: by which it is away from its place, in the axes of its body, shape (3,) [m].
    """

    def __init__(self, model: mujoco.MjModel, base: int, place: ImuPlace, turn: Array, shift: Array) -> None:
        body = base if place.body is None else model.body(place.body).id
        links: list[_Link] = []
        while body != base:
            links.append(_link(model, body))
            body = int(model.body_parentid[body])
        self._links = tuple(reversed(links))
        self._mount = rotation_of(np.array(place.quaternion)) @ turned(turn)
        self._lever = skew(np.array(place.position) + shift)

    def __call__(self, q: Array, v: Array) -> ImuMotion:
        """Its motion in a state of Pinocchio's convention, shapes (7 + nj,) and (6 + nj,)."""
        x, y, z, w = q[3:7].tolist()
        R, velocity, rate = _matrix(w, x, y, z), v[:3], v[3:6]
        for link in self._links:
            E, p, rate_joint = self._moved(link, float(q[7 + link.joint])), link.position, float(v[6 + link.joint])
            if link.point.any():
                p = p + link.rotation @ link.point - E @ link.point
            velocity = (velocity - skew(p) @ rate) @ E
            spin = link.axis * rate_joint
            velocity = velocity + skew(link.point) @ spin if link.point.any() else velocity
            rate = rate @ E + spin
            R = R @ E
        velocity = R @ (velocity - self._lever @ rate)
        return ImuMotion(R @ self._mount, velocity, rate @ self._mount)

    def _moved(self, link: _Link, angle: float) -> Array:
        """Axes of a body in its parent at an angle of its joint."""
        K = link.twist
        found: Array = link.rotation @ (_UNIT + math.sin(angle) * K + (1.0 - math.cos(angle)) * (K @ K))
        return found


_UNIT = np.eye(3)


def _link(model: mujoco.MjModel, body: int) -> _Link:
    joint = int(model.body_jntadr[body])
    axis = np.array(model.jnt_axis[joint])
    # Joint 0 is the floating base.
    return _Link(
        rotation=rotation_of(model.body_quat[body]),
        position=np.array(model.body_pos[body]),
        joint=joint - 1,
        axis=axis,
        twist=skew(axis),
        point=np.array(model.jnt_pos[joint]),
    )


def skew(vector: Array) -> Array:
    """The matrix whose product with another vector is the cross product, shape (3, 3)."""
    x, y, z = vector.tolist()
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def turned(vector: Array) -> Array:
    """Rotation of a rotation vector, shape (3, 3)."""
    angle = float(np.linalg.norm(vector))
    if angle == 0.0:
        return np.eye(3)
    K = skew(vector / angle)
    found: Array = _UNIT + math.sin(angle) * K + (1.0 - math.cos(angle)) * (K @ K)
    return found


def turn_between(before: Array, after: Array) -> Array:
    """Rotation vector from one orientation to the next, in the axes of either, less than half a turn, shape (3,) [rad].

    Args:
        before: rotation to the world, shape (3, 3).
        after: likewise.
    """
    R = before.T @ after
    vector = 0.5 * np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
    sine = math.sqrt(float(vector @ vector))
    if sine < _SMALL:
        return vector
    cosine = 0.5 * (float(R[0, 0] + R[1, 1] + R[2, 2]) - 1.0)
    return vector * (math.atan2(sine, cosine) / sine)


_SMALL = 1e-9
"""Sine of an angle below which it is the angle itself."""


def rotation_of(quaternion: Array) -> Array:
    """Rotation of a quaternion w x y z, shape (3, 3)."""
    w, x, y, z = (np.asarray(quaternion) / np.linalg.norm(quaternion)).tolist()
    return _matrix(w, x, y, z)


def _matrix(w: float, x: float, y: float, z: float) -> Array:
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
