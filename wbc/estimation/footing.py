"""The place of a robot's IMU, and its stance on its soles at first."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pinocchio as pin

from surefoot.wbc.types import Array

if TYPE_CHECKING:
    from surefoot.wbc.estimation.kinematics import SensedBody

ROUNDS = 4
"""Rounds in which the attitude over soles that lean is found."""


@dataclass(frozen=True, slots=True)
class ImuMount:
    """The place of the IMU; the default is the frame of the floating base.

    Attributes:
        body: frame of the model that carries it; None for the floating base.
        position: of its origin in that frame, shape (3,) [m].
        rotation: of its axes to that frame, shape (3, 3).
    """

    body: str | None = None
    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rotation: tuple[tuple[float, ...], ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


@dataclass(frozen=True, slots=True)
class Footing:
    """Soles on the ground.

    Attributes:
        position: sole centres in the world, left first, shape (2, 3) [m].
        yaw: headings of the soles, shape (2,) [rad].
        half_size: half of a sole's length and width [m].
        height: of the ground at x and y [m].
        normal: of the ground at x and y [m], a unit vector, shape (3,).
        leaning: half width of soles that lean with their shanks, of which position has the lines on which they stand;
            None for others [m].
    """

    position: Array
    yaw: Array
    half_size: tuple[float, float]
    height: Callable[[float, float], float]
    normal: Callable[[float, float], Array]
    leaning: float | None = None

    def normals(self) -> Array:
        """Normals of the ground under the soles, shape (2, 3)."""
        return np.stack([self.normal(*place[:2].tolist()) for place in self.position])

    def attitude(self, body: "SensedBody", joints: Array) -> Array:
        """Orientation of the IMU in the world over level soles, shape (3, 3); the body is left at these joints.

        Args:
            body: kinematics of the robot.
            joints: their angles, shape (nj,) [rad].
        """
        body.update(joints, np.eye(3))
        level = [_level(float(yaw), normal) for yaw, normal in zip(self.yaw, self.normals(), strict=True)]
        turned = [level[k] @ body.rotation[k].T for k in (0, 1)]
        R: Array = turned[0] @ pin.exp3(0.5 * pin.log3(turned[0].T @ turned[1]))
        return R if self.leaning is None else self._leaning(body, joints, R, level)

    def _leaning(self, body: "SensedBody", joints: Array, R: Array, level: list[Array]) -> Array:
        """Over soles that lean: their lines are level, and so is the way from one to the other; R is a first guess."""
        left, right = self.position
        apart = (left - right) / np.linalg.norm(left - right)
        for _ in range(ROUNDS):
            # Which edges are the lines follows from how the soles lean.
            body.update(joints, R)
            across = body.position[0] - body.position[1]
            seen = np.stack((body.rotation[0, :, 0], body.rotation[1, :, 0], across / np.linalg.norm(across)))
            U, _, V = np.linalg.svd(np.stack((level[0][:, 0], level[1][:, 0], apart)).T @ seen)
            R = U @ np.diag([1.0, 1.0, float(np.linalg.det(U @ V))]) @ V
        return R


def _level(yaw: float, up: Array) -> Array:
    """Orientation of a sole with a heading, flat on ground with a normal, shape (3, 3)."""
    ahead = np.array([math.cos(yaw), math.sin(yaw), 0.0])
    side = np.cross(up, ahead)
    side /= np.linalg.norm(side)
    return np.column_stack((np.cross(side, up), side, up))
