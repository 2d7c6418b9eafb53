"""What a quintic between two states asks for: its acceleration, its way, and a way round."""

import math

import numpy as np

from surefoot.planner.geometry import quintic
from surefoot.planner.types import Array

PEAK = 5.77
"""Greatest acceleration of a quintic from rest to rest, over way / T²: 10 / √3 [-]."""

BRAKING, GAINING = 1.9, 3.9
"""What a speed takes off that at the end of a quintic to rest, and at its begin, over speed / T: its extremes [-]."""


def farthest(acceleration: Array | float, speed: Array | float, time: Array | float) -> Array:
    """How far a quintic gets that comes to rest after a time, without more than an acceleration [m].

    Args:
        acceleration: of any shape, as all of them [m/s^2].
        speed: at its begin, negative against its way [m/s].
        time: that it has [s].
    """
    changed = np.where(np.asarray(speed) > 0.0, BRAKING, GAINING) * speed
    return np.asarray((acceleration * np.square(time) + changed * time) / PEAK)


def detour(time: float, duration: float) -> tuple[Array, Array]:
    """Coefficients of 1, t, ..., t^5 of the least jerk from rest at zero to one at a time and back, shape (6,) each."""
    a, b = time, duration - time
    # Jerk and its rate do not jump where both quintics meet, with velocity v and acceleration w.
    matrix = [[36.0 * (b**-2 - a**-2), 9.0 * (1.0 / a + 1.0 / b)], [-192.0 * (a**-3 + b**-3), 36.0 * (a**-2 - b**-2)]]
    meeting = np.linalg.solve(np.array(matrix), [-60.0 * (a**-3 + b**-3), -360.0 * (a**-4 - b**-4)])
    rest, top = np.zeros((3, 1)), np.append(1.0, meeting)[:, None]
    return quintic(rest, top, a)[:, 0], quintic(top, rest, b)[:, 0]


def straight_time(state: Array, target: Array) -> float:
    """Longest time in which a quintic from a state to rest at a target does not go beyond that [s].

    At a distance d, with speed v and acceleration a towards it, its end is at 10 d - 4 v T - a T² / 2 times the cube of
    what is left of its time.

    Args:
        state: position, velocity and acceleration, shape (3, 2) [m, m/s, m/s^2].
        target: shape (2,) [m].
    """
    way = target - state[0]
    distance = math.hypot(*way)
    if distance == 0.0:
        return 0.0
    speed, bend = (float(rate @ way) / distance for rate in state[1:])
    inner = 16.0 * speed**2 + 20.0 * bend * distance
    if inner < 0.0 or 4.0 * speed + math.sqrt(inner) <= 0.0:
        return math.inf
    return 20.0 * distance / (4.0 * speed + math.sqrt(inner))


def to_rest(state: Array, target: Array, duration: float) -> Array:
    """Coefficients of the quintic from a state, shape (3, n), to rest at a target, shape (n,), after a time [s]."""
    end = np.zeros((3, state.shape[1]))
    end[0] = target
    return quintic(state, end, duration)
