"""Height transition: the CoM height from where it is to its law, where a step that is adapted leaves that."""

import math
from collections.abc import Callable

import numpy as np

from surefoot.planner.geometry import quintic
from surefoot.planner.model.time_scaling import CLOCK_ROUNDING
from surefoot.planner.types import Array
from surefoot.values import dataclass

_ROUNDING = 1e-9
"""Accelerations are compared with this tolerance, since they are sums of rounded products [m/s^2]."""

LOOKED_AT = np.linspace(0.0, 1.0, 21)
"""Shares of a height transition at which its acceleration is looked at [-]."""


@dataclass(frozen=True, slots=True)
class HeightTransition:
    """The height from where it was at a tick to its law some time later.

    A law of phases has a rise in each of them, however short a push makes it: hurried through in 0.2 s it asks for
    more than free fall, and the swing leg's momentum over what is left of the weight for any ZMP. When a step that is
    adapted changes how the clock goes the body leaves its law, therefore, and comes to it smoothly at the end of the
    phase, or as much later as it takes not to be accelerated by more than a bound, or more than it is already.

    Attributes:
        start: tick at which it begins.
        samples: after which the law goes on.
        coefficients: of the height by time, shape (6, 1) [m, m/s, ...].
        sample_time: length of a sample [s].
    """

    start: int
    samples: int
    coefficients: Array
    sample_time: float

    @classmethod
    def onto(
        cls,
        height: Array,
        state: Array,
        start: int,
        left: float,
        sample_time: float,
        lifting: float,
        soonest_calm: Callable[..., int] | None = None,
    ) -> "HeightTransition":
        """That from a state onto a law.

        Args:
            height: z, z', z'' of the law at the samples from now on, shape (3, n) [m, m/s, m/s^2].
            state: z, z', z'' now, shape (3,).
            start: tick.
            left: until the phase ends [samples].
            sample_time: length of a sample [s].
            lifting: bound of its vertical acceleration, up or down [m/s^2].
            soonest_calm: kernel of this search in the height; None for plain Python.
        """
        bound, least = max(lifting, abs(float(state[2]))), math.inf
        soonest, last = max(math.ceil(left - CLOCK_ROUNDING), 1), height.shape[1] - 1
        if soonest_calm is not None:
            samples = soonest_calm(soonest, bound + _ROUNDING, *state.tolist())
            end = height[:, samples : samples + 1]
            return cls(start, samples, quintic(state[:, None], end, samples * sample_time), sample_time)
        for samples in range(min(soonest, last), last + 1):
            end = height[:, samples : samples + 1]
            way = cls(start, samples, quintic(state[:, None], end, samples * sample_time), sample_time)
            hardest = float(np.abs(way._at(samples * LOOKED_AT)[2]).max())
            if hardest < least:
                least, best = hardest, way
            if hardest <= bound + _ROUNDING:
                break
        return best

    def _at(self, samples: Array) -> Array:
        """z, z', z'' so many samples after the start, shape (3, n)."""
        powers, order = (samples * self.sample_time)[:, None] ** np.arange(6), np.arange(1.0, 6.0)
        first = self.coefficients[1:, 0] * order
        ways = (self.coefficients[:, 0], first, first[1:] * order[:-1])
        return np.stack([powers[:, : len(way)] @ way for way in ways])

    def over(self, height: Array, tick: int) -> Array:
        """The law at the samples from a tick on with what is left of the transition over it, shape (3, n)."""
        ahead = np.arange(tick - self.start, self.samples)[: height.shape[1]]
        return np.concatenate((self._at(ahead.astype(np.float64)), height[:, len(ahead) :]), axis=1)
