"""Quintic polynomials in local time, as columns of coefficients."""

import math

import numpy as np

from planner.types import Array

_BINOMIAL = np.array([[math.comb(i, k) for i in range(6)] for k in range(6)], dtype=float)
_POWER = np.maximum(np.arange(6)[None, :] - np.arange(6)[:, None], 0)
_EXPONENT = tuple(range(6))


def quintic(start: Array, end: Array, duration: float) -> Array:
    """Quintic between two states.

    Args:
        start: position, velocity, acceleration at time 0, shape (3, k).
        end: the same at time `duration`, shape (3, k).
        duration: [s].

    Returns:
        Coefficients of 1, t, ..., t^5, shape (6, k).
    """
    t = duration
    gap = end[0] - start[0] - t * start[1] - 0.5 * t * t * start[2]
    speed = t * (end[1] - start[1] - t * start[2])
    bend = t * t * (end[2] - start[2])
    coefficients = np.empty((6, start.shape[1]))
    coefficients[0], coefficients[1], coefficients[2] = start[0], start[1], 0.5 * start[2]
    coefficients[3] = (10.0 * gap - 4.0 * speed + 0.5 * bend) / t**3
    coefficients[4] = (-15.0 * gap + 7.0 * speed - bend) / t**4
    coefficients[5] = (6.0 * gap - 3.0 * speed + 0.5 * bend) / t**5
    return coefficients


def shifted(coefficients: Array, time: float) -> Array:
    """The same polynomials with their local time starting at `time`."""
    powers = np.array([time**i for i in _EXPONENT])
    return np.asarray((_BINOMIAL * powers[_POWER]) @ coefficients)
