"""The motion of a jerk sequence, seen in the world, and where it begins, seen in the plan frame."""

import numpy as np

from surefoot.maths import algebra
from surefoot.planner.types import Array

Ahead = tuple[Array, Array, Array, Array, Array]
"""Parameters and motion at samples 0..N, in the plan frame.

λ, shape (N + 1,) [1/s^2]; CoM height and its derivatives, shape (3, N + 1) [m, m/s, m/s^2]; what legs and lasting
forces add to the ZMP, and the ZMP reference with nominal footsteps, shape (N + 1, 2) each [m]; its sensitivity to the
shifts of the next two, shape (N + 1, 2) [-].
"""

Frame = tuple[Array, Array]
"""A plan frame: its rotation to the world, shape (2, 2), and origin, shape (2,) [m]."""


def advanced(state: algebra.Vector, jerk: float, t: float) -> algebra.Vector:
    """Position, velocity and acceleration of one axis after a time under a constant jerk.

    It is the chain of eq. (2), integrated: x(k+1) = A x(k) + B u(k) of eq. (3) for a sample time t [s].
    """
    x, v, a = state
    return x + t * (v + t * (0.5 * a + t * jerk / 6.0)), v + t * (a + 0.5 * t * jerk), a + t * jerk


class WorldMotion:
    """Says in the world frame what a jerk sequence does, and in the plan frame what it begins from.

    Args:
        sample_time: T [s].
        horizon: N.
    """

    def __init__(self, sample_time: float, horizon: int) -> None:
        self._sample_time, self._count = sample_time, horizon + 1
        self._com, self._points = np.empty((3, self._count, 2)), np.empty((self._count, 2))

    def local(self, com: Array, velocity: Array, acceleration: Array, frame: Frame) -> Array:
        """Horizontal position, velocity and acceleration per axis of the plan frame, shape (2, 3).

        Args:
            com: CoM position in the world frame, shape (2 or more,) [m].
            velocity: of the CoM, same frame and shape [m/s].
            acceleration: of the CoM, same frame and shape [m/s^2].
            frame: the plan frame.
        """
        (R, origin), state = frame, np.empty((2, 3))
        self._see(com, velocity, acceleration, R, origin, state)
        return state

    def _see(self, com: Array, velocity: Array, acceleration: Array, R: Array, origin: Array, state: Array) -> None:
        for axis in range(2):
            state[axis, 0] = (com[0] - origin[0]) * R[0, axis] + (com[1] - origin[1]) * R[1, axis]
            state[axis, 1] = velocity[0] * R[0, axis] + velocity[1] * R[1, axis]
            state[axis, 2] = acceleration[0] * R[0, axis] + acceleration[1] * R[1, axis]

    def of(self, state: Array, jerk: Array, shifts: Array, ahead: Ahead, frame: Frame) -> tuple[Array, ...]:
        """CoM position, velocity and acceleration, jerk, ZMP, its offset and its reference, which a `WalkPlan` has.

        Args:
            state: CoM position, velocity, acceleration per axis, shape (2, 3).
            jerk: shape (N, 2) [m/s^3].
            shifts: of the next two footsteps, shape (step, axis) = (2, 2) [m].
            ahead: of the samples.
            frame: the plan frame.
        """
        (stiffness, height, offset, point, gain), (R, origin) = ahead, frame
        com, world_jerk = np.empty((3, self._count, 3)), np.empty((self._count - 1, 2))
        zmp, world_offset, reference = np.empty((3, self._count, 2))
        jerk, shifts = np.asarray(jerk, dtype=np.float64), np.asarray(shifts, dtype=np.float64)  # those of any law
        self._integrate(state, jerk)
        self._lift(height, R, origin, com)
        turn_rows(R, jerk, world_jerk)
        turn_rows(R, offset, world_offset)
        self._drive(stiffness, offset)
        place_rows(R, origin, self._points, zmp)
        self._shift(point, gain, shifts)
        place_rows(R, origin, self._points, reference)
        return com, world_jerk, zmp, world_offset, reference

    def _integrate(self, state: Array, jerk: Array) -> None:
        """The CoM in the plan frame at all samples."""
        for axis in range(2):
            now = algebra.vector(state[axis])
            for k in range(self._count):
                self._com[0, k, axis], self._com[1, k, axis], self._com[2, k, axis] = now
                if k < self._count - 1:
                    now = advanced(now, jerk[k, axis], self._sample_time)

    def _lift(self, height: Array, R: Array, origin: Array, com: Array) -> None:
        """The CoM in the world, with its height."""
        for order in range(3):
            turn_rows(R, self._com[order], com[order])
            for k in range(self._count):
                com[order, k, 2] = height[order, k]
        for k in range(self._count):
            com[0, k, 0] += origin[0]
            com[0, k, 1] += origin[1]

    def _drive(self, stiffness: Array, offset: Array) -> None:
        """The ZMP in the plan frame, p = c - c'' / λ + o."""
        for k in range(self._count):
            softness = 1.0 / stiffness[k]
            for axis in range(2):
                self._points[k, axis] = self._com[0, k, axis] - softness * self._com[2, k, axis] + offset[k, axis]

    def _shift(self, point: Array, gain: Array, shifts: Array) -> None:
        """The ZMP reference in the plan frame, with the footsteps shifted."""
        for k in range(self._count):
            for axis in range(2):
                self._points[k, axis] = point[k, axis] + gain[k, 0] * shifts[0, axis] + gain[k, 1] * shifts[1, axis]


def turn_rows(R: Array, rows: Array, out: Array) -> None:
    """Turn vectors of the plane, shape (n, 2), by R, shape (2, 2); of `out` the columns from the third on stay."""
    for k in range(rows.shape[0]):
        x, y = rows[k, 0], rows[k, 1]
        out[k, 0] = R[0, 0] * x + R[0, 1] * y
        out[k, 1] = R[1, 0] * x + R[1, 1] * y


def place_rows(R: Array, origin: Array, rows: Array, out: Array) -> None:
    """Points of a frame of the plane, shape (n, 2), as seen from outside."""
    turn_rows(R, rows, out)
    for k in range(rows.shape[0]):
        out[k, 0] += origin[0]
        out[k, 1] += origin[1]
