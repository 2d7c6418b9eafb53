"""The true variable-height inverted pendulum: its ZMP is clipped to the real support, and it falls when it should."""

import math
from dataclasses import dataclass

import numpy as np

from planner.dcm import dcm
from planner.polygon import nearest_point, signed_distance
from planner.types import Array


@dataclass(frozen=True, slots=True)
class PointPush:
    """A force on the point mass.

    Attributes:
        time: when it begins [s].
        duration: how long it lasts [s].
        force: horizontal force, shape (2,) [N].
    """

    time: float
    duration: float
    force: Array


def pushing_force(pushes: tuple[PointPush, ...], time: float) -> Array:
    """Sum of the pushes at an instant, shape (2,) [N]."""
    force = np.zeros(2)
    for push in pushes:
        if push.time - 1e-9 <= time < push.time + push.duration - 1e-9:
            force = force + push.force
    return force


class Pendulum:
    """Point mass over a ZMP: x'' = λ (x - p) + F / m, horizontally; its height follows a given profile.

    Attributes:
        position: horizontal position, shape (2,) [m].
        velocity: shape (2,) [m/s].
        zmp: ZMP of the last step, shape (2,) [m].

    Args:
        mass: [kg].
        position: start position, shape (2,) [m].
        velocity: start velocity, shape (2,) [m/s].
    """

    def __init__(self, mass: float, position: Array, velocity: Array) -> None:
        self._mass = mass
        self.position = np.array(position)
        self.velocity = np.array(velocity)
        self.zmp = np.array(position)

    def advance(self, duration: float, zmp_command: Array, support: Array, stiffness: float, force: Array) -> None:
        """Exact motion under constant ZMP, stiffness and force.

        Args:
            duration: [s].
            zmp_command: wanted ZMP, shape (2,) [m].
            support: real support polygon, anticlockwise, shape (v, 2) [m]; the ZMP is its point
                nearest to the wanted one.
            stiffness: λ [1/s^2].
            force: horizontal force, shape (2,) [N].
        """
        self.zmp = nearest_point(support, zmp_command)
        center = self.zmp - force / (self._mass * stiffness)
        w = math.sqrt(stiffness)
        c, s = math.cosh(w * duration), math.sinh(w * duration)
        offset, velocity = self.position - center, self.velocity
        self.position = center + c * offset + s / w * velocity
        self.velocity = w * s * offset + c * velocity

    def fallen(self, support: Array, omega: float, distance: float = 1.0) -> bool:
        """Whether the DCM is farther from the support than any foot could reach.

        Args:
            support: support polygon, shape (v, 2) [m].
            omega: ω [1/s].
            distance: what counts as a fall [m].
        """
        here = dcm(self.position, self.velocity, omega)
        if not np.isfinite(here).all():
            return True
        gap = float(np.hypot(*(nearest_point(support, here) - here)))
        return signed_distance(support, here) < 0.0 and gap > distance
