"""The kernel that evaluates plans between their samples; its plain counterpart is `planner.plan.PlanSampler`."""

from collections.abc import Sequence

import numpy as np

from surefoot.native.library import Library
from surefoot.planner.types import Array

_SIZES = (3, 3, 3, 2, 2, 1, 1, 1)
"""Numbers of each part that is given at both ends of an interval; see `PlanKernel.enter` [-]."""

COLUMNS, POINT = 34, 40
"""Of the table of an interval, and numbers of a point: these columns, pendulum ZMP, ZMP and DCM [-]."""


class PlanKernel:
    """An interval between two samples of a plan in the kernel's memory; one serves plan after plan.

    Args:
        kernels: the library.
    """

    def __init__(self, kernels: Library) -> None:
        self._ends, self._swing, self._points = np.zeros(COLUMNS), np.zeros((6, 6)), np.zeros((2, POINT))
        *parts, self._jerk = np.split(self._ends, np.cumsum([2 * size for size in _SIZES]))
        self._places = [part.reshape((2, size) if size > 1 else (2,)) for part, size in zip(parts, _SIZES, strict=True)]
        interval = kernels.fill(
            "PlanInterval",
            ends=self._ends,
            swing=self._swing,
            table=np.zeros((6, COLUMNS)),
            points=self._points,
        )
        self._enter = kernels.bind("plan_interval_enter", interval)
        self._sample = kernels.bind("plan_interval_sample", interval)

    def enter(self, i: int, quantities: Sequence[Array], jerk: Array, swing: Array | None, length: float) -> None:
        """Prepare an interval.

        Args:
            i: sample at which it begins.
            quantities: CoM, its velocity and acceleration, ZMP reference, ZMP offset, ω, λ and load of the left foot at
                all samples.
            jerk: of the CoM within it, shape (2,) [m/s^3].
            swing: polynomials of the swing foot in the local time, shape (6, 6); None for none.
            length: of the interval [s].
        """
        for place, quantity in zip(self._places, quantities, strict=True):
            place[...] = quantity[i : i + 2]
        self._jerk[...] = jerk
        self._swing[:] = 0.0 if swing is None else swing
        self._enter(length)

    def sample(self, now: float, middle: float) -> Array:
        """Two points of the interval, shape (2, POINT): of its local time `now`, and what is done until the next tick.

        The second has positions and velocities of now, and all else of `middle` [s].
        """
        self._sample(now, middle)
        return self._points.copy()
