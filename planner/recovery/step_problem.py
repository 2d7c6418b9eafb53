"""The step that lands next, as recovery looks at it, and what is to be made of it."""

import math
from dataclasses import dataclass

from surefoot.planner.geometry.plane import seen_from, wrap_angle
from surefoot.planner.steps.step import Step, room_left, shortest_swing
from surefoot.planner.swing.course import Ground
from surefoot.planner.types import Array, Footstep


@dataclass(frozen=True, slots=True)
class StepProblem:
    """The step that lands next, in the plan frame: its origin is the stance foot of that step.

    Attributes:
        place: where it lands as the schedule has it, seen from its stance foot.
        swing: position and velocity of its foot, shape (2, 2) [m, m/s].
        double: time until that leaves the ground, zero when it has [s].
        single: time that it swings, or swings on [s].
        cycle: duration of the step after it [s].
        shortest: time left of its swing in which the body can be lifted or lowered with it [s].
        face: lower and upper corner of where it stays on its face, shape (2, 2) [m].
        crosses: whether it may land beyond its stance foot, as far as legs may at all.
        last: whether the robot stands after it.
        adapted: whether it is being adapted already.
    """

    place: Footstep
    swing: Array
    double: float
    single: float
    cycle: float
    shortest: float
    face: Array
    crosses: bool
    last: bool
    adapted: bool

    @property
    def nominal(self) -> Array:
        """Landing place by the schedule, shape (2,) [m]."""
        return self.place.position[:2]


def landing_place(step: Step, stance: Step, ground: Ground, hips: float) -> tuple[Footstep, Array, float, bool]:
    """The part of a `StepProblem` that stays from plan to plan: place, face, its whole shortest swing, crossing.

    The hips swing a foot with an acceleration, infinite for legs that nobody knows [m/s^2].
    """
    numbers = ground.parameters.recovery
    seen, turn = seen_from(stance.place, step.place), wrap_angle(step.place.yaw - stance.place.yaw)
    place = Footstep(seen.foot, seen.position, turn, seen.normal, seen.step, seen.touchdown_time)
    face = place.position[:2] + room_left(step, stance.place, numbers.parallel)
    shortest = 0.0 if hips == math.inf else shortest_swing(step, hips, numbers.lifting)
    return place, face, shortest, ground.terrain.footholds.crossed(step.lift)


@dataclass(frozen=True, slots=True)
class StepBounds:
    """The solution for the next step: a time, and a set of places, of which the law of motion takes one.

    `planner.problem` makes bounds of shifts of it, which the `StepContext` of a law carries.

    Attributes:
        left: time until the present phase is to end [s].
        box: lower and upper corner of where it may land from its stance foot, shape (2, 2) [m].
        more: whether the step after it has something to catch, too.
        cost: of it [-].
    """

    left: float
    box: Array
    more: bool
    cost: float
