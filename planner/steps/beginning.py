"""The beginning of a walk: its schedule, in sight from the start."""

import math

from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.swing.course import Ground
from surefoot.planner.types import FeetState


def begun(gait: GaitParameters, feet: FeetState, ground: Ground, window: float = 0.0) -> Schedule:
    """The laid-out schedule of a robot that stands.

    Args:
        gait: gives the durations and what else all steps have in common.
        feet: where the feet stand.
        ground: to lay steps on.
        window: how far the plans of its first phase look ahead, all of which is in sight [samples].

    Raises:
        ParameterError: see `Schedule.extended`.
    """
    schedule = Schedule.start(gait, feet, ground).with_nominal_steps()
    return in_sight(schedule, 0.0, window) if window else schedule


def in_sight(schedule: Schedule, now: float, window: float) -> Schedule:
    """The schedule with all that a plan of the phase at an instant may look at over a window.

    Args:
        schedule: the steps in sight so far.
        now: the instant [samples].
        window: how far a plan looks ahead [samples].
    """
    schedule = schedule.extended(now + window, now)
    end = schedule.phase(now).end
    return schedule.extended(end + window, now) if end < math.inf else schedule
