"""The motion of the IMU: its frame in the world from the true state, through the joints between it and the base."""

import math

import numpy as np

from surefoot.engines.windowless import mujoco
from surefoot.maths import algebra
from surefoot.maths.algebra import Vector
from surefoot.models.convert import Coordinates
from surefoot.models.types import ImuPlace
from surefoot.sim.measurement import Array


class ImuMotion:
    """Motion of the IMU's frame at one instant.

    Attributes:
        rotation: of its axes in the world, shape (3, 3).
        velocity: of its origin, world axes [m/s].
        angular_velocity: in its own axes [rad/s].
    """

    def __init__(self) -> None:
        self.rotation = np.zeros((3, 3))
        self.velocity: Vector = (0.0, 0.0, 0.0)
        self.angular_velocity: Vector = (0.0, 0.0, 0.0)


class Link:
    """A body of the chain and the joint that turns it in its parent.

    Args:
        model: of the world.
        body: its number.
        coordinates: of the robot's joints.

    Attributes:
        joint: number of the independent joint with which it turns.
        ratio: angle of the joint for one of that [-].
        offset: angle of the joint where that has none [rad].
        rotation: of its axes in its parent at zero angle, shape (3, 3).
        lever: cross product matrix of its origin in its parent, shape (3, 3) [m].
        axis: of the joint in the body.
        twist: cross product matrix of the axis, shape (3, 3).
        square: of that, shape (3, 3).
        beside: whether the joint is not at the body's origin.
        point: of the joint in the body [m].
    """

    def __init__(self, model: mujoco.MjModel, body: int, coordinates: Coordinates) -> None:
        joint = int(model.body_jntadr[body])
        axis, point = np.array(model.jnt_axis[joint]), np.array(model.jnt_pos[joint])
        twist = skew(axis)
        self.joint, self.ratio, self.offset = coordinates.law_of(joint)
        self.rotation = rotation_of(model.body_quat[body])
        self.lever = skew(np.array(model.body_pos[body]))
        self.axis, self.twist, self.square = algebra.vector(axis), twist, twist @ twist
        self.beside, self.point = bool(point.any()), algebra.vector(point)

    def turn(self, angle: float, out: Array) -> None:
        """Write the rotation of the joint by an angle [rad]: Rodrigues' formula 1 + sin a K + (1 - cos a) K²."""
        sine = math.sin(angle)
        rest = 1.0 - math.cos(angle)
        for i in range(3):
            for j in range(3):
                unit = 1.0 if i == j else 0.0
                out[i, j] = unit + sine * self.twist[i, j] + rest * self.square[i, j]


class ImuChain:
    """The bodies from the floating base to the IMU.

    Products are rounded as numpy's library does on processors that fuse.

    Args:
        model: of the world.
        base: number of the floating base's body.
        place: of the IMU.
        turn: rotation vector by which it is mounted wrongly, in its own axes, shape (3,) [rad].
        shift: by which it is away from its place, in the axes of its body, shape (3,) [m].
    """

    def __init__(self, model: mujoco.MjModel, base: int, place: ImuPlace, turn: Array, shift: Array) -> None:
        body = base if place.body is None else model.body(place.body).id
        links, coordinates = list[Link](), Coordinates(model)
        while body != base:
            links.append(Link(model, body, coordinates))
            body = int(model.body_parentid[body])
        self._links = links[::-1]
        # Orientation of the IMU in the last body, and cross product matrix of its place there [m].
        self._mount = rotation_of(np.array(place.quaternion)) @ turned(turn)
        self._lever = skew(np.array(place.position) + shift)
        self._R, self._E, self._turn, self._product = (np.zeros((3, 3)) for _ in range(4))

    def motion(self, q: Array, v: Array) -> ImuMotion:
        """Its motion in a state of Pinocchio's convention, shapes (7 + nj,) and (6 + nj,)."""
        at = ImuMotion()
        x, y, z = algebra.quaternion_rows(q[3], q[4], q[5], q[6])
        algebra.put_row(self._R, 0, x)
        algebra.put_row(self._R, 1, y)
        algebra.put_row(self._R, 2, z)
        at.velocity, at.angular_velocity = (v[0], v[1], v[2]), (v[3], v[4], v[5])
        for link in self._links:
            angle = link.ratio * q[7 + link.joint] + link.offset
            self._pass(link, angle, link.ratio * v[6 + link.joint], at)
        arm = algebra.subtract(at.velocity, algebra.rotate(self._lever, at.angular_velocity))
        at.velocity = algebra.rotate(self._R, arm)
        algebra.compose(self._R, self._mount, at.rotation)
        at.angular_velocity = algebra.rotate_back(self._mount, at.angular_velocity)
        return at

    def _pass(self, link: Link, angle: float, speed: float, at: ImuMotion) -> None:
        """Go on to a body of the chain, whose joint has an angle [rad] and a speed [rad/s].

        `_R` is then the rotation of its axes, and the motion that of its origin, both in its own axes.
        """
        spin = algebra.scale(speed, link.axis)
        link.turn(angle, self._turn)
        algebra.compose(link.rotation, self._turn, self._E)
        if link.beside:
            moved = self._moved_beside(link, at.angular_velocity)
        else:
            moved = algebra.rotate(link.lever, at.angular_velocity)
        at.velocity = algebra.rotate_back(self._E, algebra.subtract(at.velocity, moved))
        at.angular_velocity = algebra.add(algebra.rotate_back(self._E, at.angular_velocity), spin)
        algebra.compose(self._R, self._E, self._product)
        self._R[:] = self._product
        if link.beside:
            algebra.put_cross(self._product, link.point)
            at.velocity = algebra.add(at.velocity, algebra.rotate(self._product, spin))

    def _moved_beside(self, link: Link, rate: Vector) -> Vector:
        """Lever times the parent's angular velocity, where the turn of the joint moves the body's origin."""
        at_zero = algebra.rotate(link.rotation, link.point)
        algebra.put_cross(self._product, algebra.subtract(at_zero, algebra.rotate(self._E, link.point)))
        for i in range(3):
            for j in range(3):
                self._product[i, j] = link.lever[i, j] + self._product[i, j]
        return algebra.rotate(self._product, rate)


def skew(vector: Array) -> Array:
    """Matrix of the cross product with a vector, shape (3, 3)."""
    made = np.zeros((3, 3))
    algebra.put_cross(made, algebra.vector(vector))
    return made


def turned(vector: Array) -> Array:
    """Rotation of a rotation vector, shape (3, 3)."""
    R = np.empty((3, 3))
    algebra.rotation_of(algebra.vector(vector), R)
    return R


def rotation_of(quaternion: Array) -> Array:
    """Rotation of a quaternion w x y z of any length, shape (3, 3)."""
    w, x, y, z = (np.asarray(quaternion) / np.linalg.norm(quaternion)).tolist()
    return np.array(algebra.quaternion_rows(x, y, z, w))
