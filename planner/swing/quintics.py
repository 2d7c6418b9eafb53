"""The demands of a quintic between two states: its acceleration, its way, and a way round."""

import math

import numpy as np

from surefoot.maths.algebra import Vector
from surefoot.planner.geometry.plane import quintic
from surefoot.planner.geometry.quintic import between
from surefoot.planner.types import Array

PEAK = 5.77
"""Greatest acceleration of a quintic from rest to rest, over way / T²: 10 / √3 [-]."""

BRAKING, GAINING = 1.9, 3.9
"""Effect of a speed at an end of a quintic on the acceleration there, over speed / T: its extremes [-]."""


def farthest(acceleration: float, speed: float, time: float) -> float:
    """Farthest way of a quintic that comes to rest after a time, without more than an acceleration [m].

    Args:
        acceleration: of the hips, say [m/s^2].
        speed: at its begin, negative against its way [m/s].
        time: that it has [s].
    """
    return (acceleration * (time * time) + (BRAKING if speed > 0.0 else GAINING) * speed * time) / PEAK


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


def up_and_down(
    state: Vector,
    apex: float,
    end: tuple[float, float],
    times: tuple[float, float, float],
    lifting: float,
    soon: float,
) -> tuple[Array | None, Array]:
    """Height of a foot from a state up to an apex, unless that is over, and down to the ground.

    The apex is no higher than `lifting` lifts the foot until then and lowers it from there. A foot that is too high for
    that goes down at once. 4 h / t² at the apex keeps both monotone.

    Args:
        state: height, its rate and the rate of that now [m, m/s, m/s^2].
        apex: height of the apex [m].
        end: height and speed down at the touchdown [m, m/s].
        times: now, at the apex, and at the touchdown [s].
        lifting: vertical acceleration that is not to be exceeded [m/s^2].
        soon: time before an apex up to which it counts as over [s].

    Returns:
        Coefficients of the rise, none where the foot goes down at once, and of the fall, shape (6, 1) each.
    """
    (now, highest, touchdown), (low, sinking), (height, speed, _) = times, end, state
    up, down, rest = highest - now, touchdown - highest, (low, -sinking, 0.0)
    room = lifting * down**2 / PEAK
    if up <= soon or height - low > room:
        return None, np.array(between(state, rest, touchdown - now))[:, None]
    apex = min(apex, low + room, height + farthest(lifting, speed, up))
    top = apex, 0.0, -4.0 * min((apex - height) / up**2, (apex - low) / down**2)
    return np.array(between(state, top, up))[:, None], np.array(between(top, rest, down))[:, None]
