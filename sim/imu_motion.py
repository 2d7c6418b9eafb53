"""How the IMU moves: its frame in the world from the true state, through the joints between it and the base."""

import math

import numpy as np

from surefoot.engine import mujoco
from surefoot.models.convert import Coordinates
from surefoot.models.types import ImuPlace
from surefoot.sim.measurement import Array
from surefoot.values import dataclass


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
class Link:
    """A body of the chain: its axes and origin in its parent at zero angle, and the joint that turns it.

    Attributes:
        rotation: of its axes, shape (3, 3).
        lever: cross product matrix of its origin, shape (3, 3) [m].
        joint: number of the joint.
        axis: of the joint in the body, shape (3,).
        twist: cross product matrix of the axis, and its square, each shape (3, 3).
        point: of the joint in the body where that is not its origin, shape (3,) [m].
    """

    rotation: Array
    lever: Array
    joint: int
    axis: Array
    twist: tuple[Array, Array]
    point: Array | None

    def axes(self, angle: float) -> Array:
        """Its axes in its parent at an angle of the joint [rad], shape (3, 3)."""
        K, square = self.twist
        found: Array = self.rotation @ (_UNIT + math.sin(angle) * K + (1.0 - math.cos(angle)) * square)
        return found


class ImuChain:
    """The bodies from the floating base to the IMU.

    Args:
        model: of the world.
        base: number of the floating base's body.
        place: of the IMU.
        turn: rotation vector by which it is mounted wrongly, in its own axes, shape (3,) [rad].
        shift: by which it is away from its place, in the axes of its body, shape (3,) [m].

    Attributes:
        links: the bodies, from that above the base on.
        mount: orientation of the IMU in the last body, shape (3, 3).
        lever: cross product matrix of its place there, shape (3, 3) [m].
    """

    def __init__(self, model: mujoco.MjModel, base: int, place: ImuPlace, turn: Array, shift: Array) -> None:
        body = base if place.body is None else model.body(place.body).id
        links, coordinates = list[Link](), Coordinates(model)
        while body != base:
            links.append(_link(model, body, coordinates))
            body = int(model.body_parentid[body])
        self.links = tuple(reversed(links))
        self.mount = rotation_of(np.array(place.quaternion)) @ turned(turn)
        self.lever = skew(np.array(place.position) + shift)

    def __call__(self, q: Array, v: Array) -> ImuMotion:
        """Its motion in a state of Pinocchio's convention, shapes (7 + nj,) and (6 + nj,)."""
        x, y, z, w = q[3:7].tolist()
        R, velocity, rate = _matrix(w, x, y, z), v[:3], v[3:6]
        for link in self.links:
            E, spin = link.axes(float(q[7 + link.joint])), link.axis * float(v[6 + link.joint])
            lever = link.lever
            if link.point is not None:
                lever = lever + skew(link.rotation @ link.point - E @ link.point)
            velocity, rate, R = (velocity - lever @ rate) @ E, rate @ E + spin, R @ E
            if link.point is not None:
                velocity = velocity + skew(link.point) @ spin
        velocity = R @ (velocity - self.lever @ rate)
        return ImuMotion(R @ self.mount, velocity, rate @ self.mount)


_UNIT = np.eye(3)


def _link(model: mujoco.MjModel, body: int, coordinates: Coordinates) -> Link:
    joint = int(model.body_jntadr[body])
    twist, point = skew(np.array(model.jnt_axis[joint])), np.array(model.jnt_pos[joint])
    return Link(
        rotation=rotation_of(model.body_quat[body]),
        lever=skew(np.array(model.body_pos[body])),
        joint=coordinates.number_of(joint),
        axis=np.array(model.jnt_axis[joint]),
        twist=(twist, twist @ twist),
        point=point if point.any() else None,
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
    if sine < SMALL:
        return vector
    cosine = 0.5 * (float(R[0, 0] + R[1, 1] + R[2, 2]) - 1.0)
    return vector * (math.atan2(sine, cosine) / sine)


SMALL = 1e-9
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
