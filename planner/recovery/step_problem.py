"""The step that lands next, as recovery looks at it, and what is to be made of it."""

import math
from dataclasses import dataclass

import numpy as np

from surefoot.planner.geometry import seen_from, wrap_angle
from surefoot.planner.steps.execution import Execution
from surefoot.planner.steps.step import room_left, shortest_swing
from surefoot.planner.types import Array, FeetState, Footstep, PhaseKind


@dataclass(frozen=True, slots=True)
class StepProblem:
    """What is known of the step that lands next, in the plan frame: its origin is the stance foot of that step.

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
        """Where it lands as the schedule has it, shape (2,) [m]."""
        return self.place.position[:2]

    @classmethod
    def of(cls, time: float, execution: Execution, feet: FeetState, frame: tuple[Array, Array]) -> "StepProblem | None":
        """That of a tick; None where no step is to come.

        Args:
            time: now [s].
            execution: the clock and the steps in sight.
            feet: the measured feet.
            frame: its stance foot's, the plan frame: rotation to the world, shape (2, 2), and origin, shape (2,) [m].
        """
        phase, (rotation, origin), v, w = execution.info, frame, 0.0, 0.0
        if not phase.leads_to:
            return None
        schedule, clock, landed = execution.schedule, execution.clock, execution.landed
        step = schedule.step(landed + 1)
        swings, foot = phase.kind is PhaseKind.SINGLE, step.place.foot
        yet = min(1.0, (step.touchdown - clock.now) / step.single)
        # In plain numbers: a product of small arrays takes longer than all of this.
        (a, b), (c, d) = rotation.tolist()
        (u, o), (x, y, _) = origin.tolist(), feet.position[foot].tolist()
        if execution.swing is not None:
            v, w, *_ = execution.swing.coefficients(time)[1].tolist()
        x, y = x - u, y - o
        hips = math.inf if execution.legs is None else execution.legs.acceleration[0]
        stance, ground = schedule.step(landed), schedule.ground
        seen, turn = seen_from(stance.place, step.place), wrap_angle(step.place.yaw - stance.place.yaw)
        face = seen.position[:2] + room_left(step, stance.place, ground.parameters.recovery.parallel)
        whole = 0.0 if hips == math.inf else shortest_swing(step, hips, ground.parameters.recovery.lifting)
        return StepProblem(
            place=Footstep(seen.foot, seen.position, turn, seen.normal, seen.step, seen.touchdown_time),
            swing=np.array(((x * a + y * c, x * b + y * d), (v * a + w * c, v * b + w * d))),
            double=0.0 if swings else phase.left,
            single=phase.left if swings else step.single * clock.sample_time,
            cycle=schedule.gait.period,
            shortest=yet * whole,
            face=face,
            crosses=ground.terrain.footholds.crossed(step.lift),
            last=execution.stops,
            adapted=execution.adapted,
        )


@dataclass(frozen=True, slots=True)
class StepBounds:
    """The solution for the next step: a time, and a set of places, of which the law of motion takes one.

    `Recovery.bounds` makes bounds of shifts of it, which the `StepContext` of a law carries.

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
