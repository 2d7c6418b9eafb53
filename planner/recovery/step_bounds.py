"""Where the next two footsteps may land: bounds of their shifts, which a law of motion keeps."""

from dataclasses import dataclass

import numpy as np

from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.swing.leg_reach import reach_box
from surefoot.planner.types import Array

_UNUSED = 1.0
"""Bound of a shift that is not free: it moves nothing and costs something, so that it stays zero by itself [m]."""


@dataclass(frozen=True, slots=True)
class StepBounds:
    """Bounds of the shifts of the next two footsteps from their nominal increments, in the plan frame.

    Attributes:
        lower: lower bounds, shape (step, axis) = (2, 2) [m].
        upper: upper bounds, shape (step, axis) = (2, 2) [m].
    """

    lower: Array
    upper: Array

    @classmethod
    def within(cls, boxes: Array, increment: Array, free: tuple[bool, bool]) -> "StepBounds":
        """Those of footsteps that land in boxes.

        Args:
            boxes: lower and upper corners, from the foothold before each, shape (step, corner, axis) = (2, 2, 2) [m].
            increment: nominal displacements from the foothold before, shape (2, 2) [m].
            free: whether each of them may be shifted.
        """
        lower, upper = np.full((2, 2), -_UNUSED), np.full((2, 2), _UNUSED)
        for j in np.flatnonzero(np.array(free)):
            lower[j], upper[j] = boxes[j] - increment[j]
        if free[1]:
            lower[1], upper[1] = np.minimum(lower[1], 0.0), np.maximum(upper[1], 0.0)
        return cls(lower, upper)

    @classmethod
    def reachable(
        cls,
        parameters: PlannerParameters,
        increment: Array,
        side: float,
        free: tuple[bool, bool],
        swing: Array | None,
        time_left: float,
    ) -> "StepBounds":
        """Those of the paper's reachable area, the first step also within what its foot can be swung to in time.

        Args:
            parameters: give area and swing speed.
            increment: nominal displacements from the foothold before, shape (2, 2) [m].
            side: +1 where the next step is a left one, -1 where it is a right one.
            free: whether each of them may be shifted.
            swing: position of the swing foot from the stance foot, shape (2,) [m], or None when no foot swings.
            time_left: time until the first of them lands [s].
        """
        found = cls.within(np.array([reach_box(parameters, s) for s in (side, -side)]), increment, free)
        if swing is None or not free[0]:
            return found
        lower, upper = found.lower, found.upper
        travel = parameters.swing_speed * time_left / np.sqrt(2.0)
        here = swing - increment[0]
        # The nominal footstep is never out of reach: a fast gait's swing is faster than that speed by itself.
        low = np.maximum(lower[0], np.minimum(np.minimum(here - travel, 0.0), upper[0]))
        upper[0] = np.minimum(upper[0], np.maximum(np.maximum(here + travel, 0.0), lower[0]))
        lower[0] = low
        return found
