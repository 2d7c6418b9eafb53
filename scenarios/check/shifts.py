"""Shifts in the level of a noisy series, such as times on the wall's clock.

Least squares with a penalty for each shift, solved exactly by dynamic programming (Jackson et al., "An algorithm for
optimal partitioning of data on an interval", 2005), on logarithms. The noise is estimated from the differences of
neighbours by their median, which shifts do not widen. Values far from the median about them are drawn in before
(Hampel's identifier), so that a single slow run is no shift.
"""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

LEAST = 4
"""Least length of a stretch of one level [checks]."""

PENALTY = 24.0
"""Sum of squares, over the noise's variance, that a shift must save [-].

Of series of 60 or 200 values without a shift fewer than 0.5 % are given one, and fewer than 2 % where the noise
is Student's t of 3 degrees of freedom. Of noise that lasts, with a correlation of 0.5 from check to check, a third are.
"""

LEAST_NOISE = 0.03
"""Noise below which no series is believed to be, in logarithms: 3 % [-]."""

_ABOUT, _FAR = 3, 3.0
"""Neighbours on each side of which the median is taken; noises from it beyond which a value is drawn in."""

_MAD = 1.4826
"""From the median of the distances from the median to a standard deviation, of normal noise [-]."""


def shifts(values: Sequence[float]) -> list[int]:
    """Places in a series of positive numbers at which another level begins; none in one that is too short."""
    if len(values) < 2 * LEAST or min(values) <= 0.0:
        return []
    logs = np.log(np.array(values, dtype=float))
    steps = np.diff(logs)
    noise = max(_MAD * float(np.median(np.abs(steps - np.median(steps)))) / math.sqrt(2.0), LEAST_NOISE)
    return _partition(_drawn_in(logs, _FAR * noise) / noise)


def _drawn_in(logs: NDArray[np.float64], most: float) -> NDArray[np.float64]:
    """Values no farther from the median of those about them than a distance."""
    about = [np.median(logs[max(at - _ABOUT, 0) : at + _ABOUT + 1]) for at in range(len(logs))]
    return np.clip(logs, np.array(about) - most, np.array(about) + most)


def _partition(values: NDArray[np.float64]) -> list[int]:
    """Begins of all stretches but the first in the partition of least cost, values of a unit noise."""
    count = len(values)
    sums, squares = (np.concatenate([[0.0], np.cumsum(values**power)]) for power in (1, 2))
    best, before = np.full(count + 1, math.inf), np.zeros(count + 1, np.intp)
    best[0] = -PENALTY
    for end in range(LEAST, count + 1):
        begins = np.arange(end - LEAST + 1)
        spread = squares[end] - squares[begins] - (sums[end] - sums[begins]) ** 2 / (end - begins)
        costs = best[begins] + spread + PENALTY
        before[end] = np.argmin(costs)
        best[end] = costs[before[end]]
    found, end = [], int(before[count])
    while end > 0:
        found.append(end)
        end = int(before[end])
    return found[::-1]
