"""The region of footsteps whatever the legs: that of commanded steps, and the paper's reachable area."""

import math
from dataclasses import dataclass

import numpy as np

from surefoot.errors import ParameterError, at_least, at_most
from surefoot.planner.parameters import PlannerParameters, RecoveryParameters
from surefoot.planner.types import Array, Foot, Footstep, Twist

LANDING_ROUNDING = 1e-9
"""Places in the region are compared with this tolerance, since they are sums of rounded ways [m, rad]."""


def soles_apart(sole: tuple[float, float], turn: float) -> float:
    """Distance beside at which a sole just clears the other one, wherever ahead it lands [m].

    Args:
        sole: length and width of both [m].
        turn: heading of one against the other [rad].
    """
    length, width = sole
    return 0.5 * (width + (length * abs(math.sin(turn)) + width * abs(math.cos(turn))))


@dataclass(frozen=True, slots=True)
class StepRegion:
    """Bounds of a landing, seen from its stance foot.

    Two soles that are `nearest` apart sideways keep the gap whatever the distance ahead, so that a foot neither lands
    on the other one, nor passes through it, nor crosses over.

    Attributes:
        length: largest distance ahead or behind [m].
        width: least and largest distance beside [m].
        sole: length and width of the soles [m].
        gap: least distance between two soles side by side [m].
        turn: largest change of heading; beyond about 0.7 rad the thighs touch [rad].
        leg_span: largest distance from the point `hip_width` beside the stance foot, where both legs stand upright [m].
        hip_width: distance between the hips [m].
    """

    length: float
    width: tuple[float, float]
    sole: tuple[float, float]
    gap: float = RecoveryParameters().sole_gap
    turn: float = 0.5
    leg_span: float = math.inf
    hip_width: float = 0.0

    def nearest(self, turn: float) -> float:
        """Least distance beside for a foot that lands turned [m]."""
        return max(self.width[0], soles_apart(self.sole, turn) + self.gap)

    def admits(self, stride: Twist) -> bool:
        """Return true if both feet may make a stride."""
        return all(self.why_not(stride.landing(foot)) is None for foot in Foot)

    def fitted(self, stride: Twist) -> Twist:
        """A stride with the width nearest to its own at which both feet land within bounds, if there is one.

        Sideways the feet alternate between a wide and a closing step, whose distances differ by twice the lateral
        advance; in a turn the outer foot goes the farther the wider the feet stand.
        """
        forward, left = stride.advance
        middle, ahead = 0.5 * (1.0 + math.cos(stride.yaw)), 0.5 * abs(math.sin(stride.yaw))
        least = (self.nearest(stride.yaw) + abs(left)) / middle
        most = (self.width[1] - abs(left)) / middle
        if ahead > 0.0:
            most = min(most, (self.length + 0.5 * LANDING_ROUNDING - abs(forward)) / ahead)
        return stride._replace(width=max(min(stride.width, most), least))

    def why_not(self, place: Footstep) -> tuple[str, str] | None:
        """The fault of a landing, in a clause that follows "the foot", and what would be right; None if it is right."""
        near, far, ahead = self.nearest(place.yaw), self.width[1], float(place.position[0])
        if abs(place.yaw) > self.turn + LANDING_ROUNDING:
            return (f"turns by {place.yaw:.3g} rad against its stance foot", f"{self.turn:g} rad is the most")
        if place.beside < near - LANDING_ROUNDING:
            what = "crosses" if place.beside < 0.0 else "would touch"
            return (f"{what} its stance foot, {place.beside:.3f} m beside it", f"{at_least(near)} m is the least")
        if place.beside > far + LANDING_ROUNDING:
            return (f"lands {place.beside:.3f} m beside its stance foot", f"{far:g} m is the most")
        if abs(ahead) > self.length + LANDING_ROUNDING:
            return (f"lands {ahead:.3f} m ahead of its stance foot", f"{self.length:g} m is the most")
        stretch = math.hypot(ahead, place.beside - self.hip_width)
        if stretch > self.leg_span + LANDING_ROUNDING:
            what = f"lands {stretch:.3f} m from where the legs stand upright"
            return (what, f"{at_most(self.leg_span)} m is the most")
        return None


def reach_box(parameters: PlannerParameters, side: float) -> tuple[Array, Array]:
    """Box in which a footstep may land from its stance foot: its corners in the plan frame, shape (2,) each [m].

    It is the paper's reachable area, in which its step law saturates a step.

    Args:
        parameters: planner parameters.
        side: +1 for a left step, -1 for a right one.
    """
    x = parameters.reach_length
    near, far = sorted(side * width for width in parameters.reach_width)
    return np.array([-x, near]), np.array([x, far])


def check_reach(number: int, place: Footstep, parameters: PlannerParameters) -> None:
    """Refuse a nominal footstep of a number that lands outside the reach box, seen from its stance foot.

    Raises:
        ParameterError: it is out of reach; its key is ("footsteps", number - 1, "ahead" or "beside").
    """
    low, high = reach_box(parameters, 1.0)
    # The stride to it was admitted with one such tolerance, and a place in the world is rounded beyond that.
    rounding = 2.0 * LANDING_ROUNDING
    for axis, (name, way) in enumerate((("ahead", float(place.position[0])), ("beside", place.beside))):
        if not low[axis] - rounding <= way <= high[axis] + rounding:
            ahead = "ahead of" if name == "ahead" else name
            what = f"footstep {number} would land {way:.3f} m {ahead} its stance foot"
            key = ("footsteps", number - 1, name)
            raise ParameterError(key, what, f"it must be {low[axis]:g} to {high[axis]:g} m")


_UNUSED = 1.0
"""Bound of a shift that is not free: it moves nothing and costs something, so that it stays zero by itself [m]."""

Shifts = tuple[Array, Array]
"""Lower and upper bounds of shifts of the next two footsteps, shape (step, axis) = (2, 2) each, in the plan frame [m].

They are counted from the nominal increments: displacements from the foothold before, shape (2, 2) [m].
"""


def shifts_within(boxes: Array, increment: Array, free: tuple[bool, bool]) -> Shifts:
    """Shifts of footsteps that land in boxes.

    Args:
        boxes: lower and upper corners, from the foothold before each, shape (step, corner, axis) = (2, 2, 2) [m].
        increment: nominal increments.
        free: whether each of them may be shifted.
    """
    moves = np.array(free)[:, None]
    lower = np.where(moves, boxes[:, 0] - increment, -_UNUSED)
    upper = np.where(moves, boxes[:, 1] - increment, _UNUSED)
    if free[1]:
        lower[1], upper[1] = np.minimum(lower[1], 0.0), np.maximum(upper[1], 0.0)
    return lower, upper


def unshifted(free: tuple[bool, bool]) -> Shifts:
    """Shifts of footsteps that stay where they are."""
    bounds = np.array([[0.0, 0.0] if moves else [_UNUSED, _UNUSED] for moves in free])
    return -bounds, bounds


def reachable_shifts(
    parameters: PlannerParameters,
    increment: Array,
    side: float,
    free: tuple[bool, bool],
    swing: Array | None,
    time_left: float,
) -> Shifts:
    """Shifts within the paper's reachable area, of the first step also within its foot's way in the time left.

    Args:
        parameters: of the planner.
        increment: nominal displacements of the next two steps, shape (2, 2) [m].
        side: +1 where the next step is a left one, else -1 [-].
        free: true for each of the two that may be shifted.
        swing: position of the swing foot from the stance foot, shape (2,) [m]; None when no foot swings.
        time_left: time until the first of them lands [s].
    """
    lower, upper = shifts_within(np.array([reach_box(parameters, s) for s in (side, -side)]), increment, free)
    if swing is None or not free[0]:
        return lower, upper
    travel = parameters.swing_speed * time_left / np.sqrt(2.0)
    here = swing - increment[0]
    # The nominal footstep is never out of reach: a fast gait's swing is faster than that speed by itself.
    low = np.maximum(lower[0], np.minimum(np.minimum(here - travel, 0.0), upper[0]))
    upper[0] = np.minimum(upper[0], np.maximum(np.maximum(here + travel, 0.0), lower[0]))
    lower[0] = low
    return lower, upper
