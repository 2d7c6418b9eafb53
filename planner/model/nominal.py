"""The CoM motion with nothing to correct: what of a plan's motion is known before anything is optimised.

A few blocks of jerk cannot follow the ZMP at the far end of the horizon, where it jumps half a metre in 0.1 s. Nor do
they follow a leg that swings in a third of a second. Planned with them alone, fast steps are shortened for no physical
reason. So the optimiser plans only what differs from this motion.
"""

import numpy as np

from surefoot.maths import linear
from surefoot.planner.types import Array


class NominalMotion:
    """A CoM motion with constant jerk between samples, at rest over the origin until it is given what to follow.

    Args:
        sample_time: length of an interval, T [s].
        count: samples.

    Attributes:
        sample_time: length of an interval, T [s].
        count: samples.
        com: position, velocity, acceleration at the samples, shape (3, count, 2) [m, m/s, m/s^2].
        jerk: of each interval, shape (count - 1, 2) [m/s^3].
    """

    def __init__(self, sample_time: float, count: int) -> None:
        self.sample_time, self.count = sample_time, count
        self.com, self.jerk = np.zeros((3, count, 2)), np.zeros((count - 1, 2))
        self.c, self.v, self.a = self.com
        self.u = self.jerk
        self._lower, self._diagonal, self._upper = np.zeros(count), np.zeros(count), np.zeros(count)

    def follow(self, position: Array, zmp: Array, stiffness: Array) -> None:
        """Become the motion c'' = λ (c - p) from a position that does not diverge, exact at the samples.

        With constant jerk between samples the motion is a cubic spline, whose values and second derivatives a obey
        (c_{k+1} - 2 c_k + c_{k-1}) / T² = (a_{k+1} + 4 a_k + a_{k-1}) / 6; with a = λ (c - p) that is one tridiagonal
        system. It starts at `position` and ends over the last ZMP: this fixes its velocity, which is that of a DCM with
        nothing to correct.

        Args:
            position: CoM now, shape (2,) [m].
            zmp: p, shape (count, 2) [m].
            stiffness: λ, shape (count,) [1/s^2].
        """
        self._begin_system(position, zmp)
        share, last = self.sample_time * self.sample_time / 6.0, self.count - 1
        for k in range(1, last):
            before, here, after = share * stiffness[k - 1], share * stiffness[k], share * stiffness[k + 1]
            self._lower[k], self._diagonal[k], self._upper[k] = 1.0 - before, -2.0 - 4.0 * here, 1.0 - after
            for axis in range(2):
                self.c[k, axis] = -after * zmp[k + 1, axis] - 4.0 * here * zmp[k, axis] - before * zmp[k - 1, axis]
        linear.solve_tridiagonal(self._lower, self._diagonal, self._upper, self.c)
        self._differentiate(zmp, stiffness)

    def _begin_system(self, position: Array, zmp: Array) -> None:
        """First and last row of the system: the position and the last ZMP."""
        last = self.count - 1
        self._diagonal[0], self._upper[0] = 1.0, 0.0
        self._lower[last], self._diagonal[last] = 0.0, 1.0
        for axis in range(2):
            self.c[0, axis], self.c[last, axis] = position[axis], zmp[last, axis]

    def _differentiate(self, zmp: Array, stiffness: Array) -> None:
        """Acceleration, velocity and jerk of the spline."""
        T, last = self.sample_time, self.count - 1
        c, v, a = self.c, self.v, self.a
        for k in range(self.count):
            for axis in range(2):
                a[k, axis] = stiffness[k] * (c[k, axis] - zmp[k, axis])
        for k in range(last):
            for axis in range(2):
                bend, next_bend = a[k, axis], a[k + 1, axis]
                v[k, axis] = (c[k + 1, axis] - c[k, axis]) / T - T / 6.0 * (2.0 * bend + next_bend)
                self.u[k, axis] = (next_bend - bend) / T
        for axis in range(2):
            v[last, axis] = v[last - 1, axis] + 0.5 * T * a[last - 1, axis]  # it ends on its ZMP, without acceleration


def nominal_motion(position: Array, zmp: Array, stiffness: Array, sample_time: float) -> NominalMotion:
    """See `NominalMotion.follow`."""
    motion = NominalMotion(sample_time, len(zmp))
    motion.follow(position, zmp, stiffness)
    return motion
