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
    """A plan in the kernel's memory, and of that an interval between two samples; one serves plan after plan.

    Args:
        kernels: the library.

    Attributes:
        kernels: the library.
        bound: the plan as other kernels take it.
        now: the first of the points that were sampled last, shape (POINT,) [SI].
    """

    def __init__(self, kernels: Library) -> None:
        self.kernels = kernels
        self._ends, self._swing, self._points = np.zeros(COLUMNS), np.zeros((6, 6)), np.zeros((2, POINT))
        self.now = self._points[0]
        *parts, self._jerk = np.split(self._ends, np.cumsum([2 * size for size in _SIZES]))
        self._places = [part.reshape((2, size) if size > 1 else (2,)) for part, size in zip(parts, _SIZES, strict=True)]
        self.bound = kernels.fill(
            "PlanInterval",
            begin=0.0,
            length=1.0,
            last=0,
            touchdown=np.inf,
            entered=-1,
            landed=0,
            start=0.0,
            swing_foot=-1,
            ends=self._ends,
            swing=self._swing,
            table=np.zeros((6, COLUMNS)),
            points=self._points,
        )
        self._enter = kernels.bind("plan_interval_enter", self.bound)
        self._sample = kernels.bind("plan_interval_sample", self.bound)

    def take(self, begin: float, length: float, last: int, touchdown: float) -> None:
        """Begin another plan.

        Args:
            begin: instant of its first sample [s].
            length: of an interval [s].
            last: number of the last interval [-].
            touchdown: from when on the swing foot has landed [s].
        """
        plan = self.bound.struct
        plan.begin, plan.length, plan.last, plan.touchdown, plan.entered = begin, length, last, touchdown, -1

    def enter(
        self, i: int, landed: bool, start: float, quantities: Sequence[Array], jerk: Array, foot: int,
        swing: Array | None,
    ) -> None:  # fmt: skip
        """Prepare an interval.

        Args:
            i: sample at which it begins.
            landed: whether it is for the time after the touchdown.
            start: its begin [s].
            quantities: CoM, its velocity and acceleration, ZMP reference, ZMP offset, ω, λ and load of the left foot at
                all samples.
            jerk: of the CoM within it, shape (2,) [m/s^3].
            foot: that swings, -1 for none.
            swing: polynomials of the swing foot in the local time, shape (6, 6); None for none.
        """
        plan = self.bound.struct
        plan.entered, plan.landed, plan.start, plan.swing_foot = i, landed, start, foot
        for place, quantity in zip(self._places, quantities, strict=True):
            place[...] = quantity[i : i + 2]
        self._jerk[...] = jerk
        self._swing[:] = 0.0 if swing is None else swing
        self._enter()

    def sample(self, now: float, middle: float) -> Array | None:
        """Two points, shape (2, POINT): at an instant, and what is done until the next tick.

        The second has positions and velocities of now, and all else of `middle` [s]. None where one of the instants is
        not within the interval, or its swing foot has landed meanwhile.
        """
        return self._points.copy() if self._sample(now, middle) else None
