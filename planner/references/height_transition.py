"""Height transition: the CoM height from where it is to its law, where a step that is adapted leaves that."""

from dataclasses import dataclass
from math import ceil

import numpy as np

from surefoot.maths import algebra
from surefoot.maths.algebra import Vector
from surefoot.planner.geometry import quintic
from surefoot.planner.model.time_scaling import CLOCK_ROUNDING
from surefoot.planner.types import Array

_ROUNDING = 1e-9
"""Accelerations are compared with this tolerance, since they are sums of rounded products [m/s^2]."""

_LOOKED_AT = 21
"""Instants of a height transition at which its acceleration is looked at [-]."""


@dataclass(frozen=True, slots=True)
class HeightTransition:
    """The height from where it was at a tick to its law some time later.

    The law has a rise in each phase, however short a push makes the phase. In 0.2 s such a rise asks for more than free
    fall. So the body leaves its law when a step that is adapted changes the rate of the clock. It comes back to the law
    smoothly at the end of the phase. It comes back later if it would otherwise be accelerated by more than a bound, or
    by more than it is already.

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
        cls, height: Array, state: Array, start: int, left: float, sample_time: float, lifting: float
    ) -> "HeightTransition":
        """Make the transition from a state onto a law.

        Args:
            height: z, z', z'' of the law at the samples from now on, shape (3, n) [m, m/s, m/s^2].
            state: z, z', z'' now, shape (3,).
            start: tick.
            left: until the phase ends [samples].
            sample_time: length of a sample [s].
            lifting: bound of its vertical acceleration, up or down [m/s^2].
        """
        now, bound = tuple(state.tolist()), max(lifting, abs(float(state[2])))
        soonest = max(ceil(left - CLOCK_ROUNDING), 1)
        samples = soonest_calm(height, now, soonest, bound, sample_time)
        way = quintic.between(now, tuple(height[:, samples].tolist()), samples * sample_time)
        return cls(start, samples, np.array(way)[:, None], sample_time)

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


def soonest_calm(height: Array, now: Vector, soonest: int, bound: float, sample_time: float) -> int:
    """After how many samples a transition onto a law ends that is not accelerated beyond a bound.

    Args:
        height: the law, see `HeightTransition.onto`.
        now: z, z', z'' now.
        soonest: no sooner than after so many samples, or than the law's last one.
        bound: of its acceleration, to rounding [m/s^2].
        sample_time: length of a sample [s].

    Returns:
        The soonest of those that keep the bound, or else the calmest.
    """
    last = height.shape[1] - 1
    best: int = last
    least = algebra.INFINITY
    for samples in range(min(soonest, last), last + 1):
        end = (height[0, samples], height[1, samples], height[2, samples])
        lasting, hardest = samples * sample_time, 0.0
        way = quintic.between(now, end, lasting)
        for i in range(_LOOKED_AT):
            hardest = max(hardest, abs(quintic.bend(way, lasting * i / (_LOOKED_AT - 1))))
        if hardest < least:
            least, best = hardest, samples
        if hardest - bound <= _ROUNDING:
            break
    return best
