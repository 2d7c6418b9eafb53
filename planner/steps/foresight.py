"""What may come of an execution: by an end of single support now, by another foot that steps."""

from copy import copy
from typing import TYPE_CHECKING

from surefoot.planner.steps.adaptation import with_foot_again
from surefoot.planner.types import FeetState, PhaseKind

if TYPE_CHECKING:
    from surefoot.planner.steps.execution import Execution


def ended(execution: "Execution", feet: FeetState) -> "Execution":
    """The execution in which the foot that swings has landed where it is, and single support is over."""
    other, end, swing = copy(execution), execution.phase.end, execution.phase.swing_foot
    assert swing is not None
    other.clock, other.swing = execution.clock.showing(end), None
    other.land(feet.position[swing], end)
    other.follow(other.schedule)
    return other


def going_again(execution: "Execution") -> "Execution":
    """The execution in which the foot that landed last makes the next step as well, and the weight goes back."""
    other, phase = copy(execution), execution.phase
    schedule = with_foot_again(execution.schedule, execution.landed)
    gone = 1.0 if phase.kind is PhaseKind.SINGLE else (execution.clock.now - phase.start) / phase.samples
    step = schedule.step(execution.landed)
    other.clock = execution.clock.showing(step.touchdown + (1.0 - gone) * step.double)
    other.follow(schedule)
    return other
