"""What may come of an execution: at the next tick, by an end of single support now, by another foot that steps."""

from copy import copy
from typing import TYPE_CHECKING

from surefoot.errors import ParameterError
from surefoot.planner.model.time_scaling import CLOCK_ROUNDING
from surefoot.planner.steps.adaptation import with_foot_again
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.types import FeetState, PhaseKind

if TYPE_CHECKING:
    from surefoot.planner.steps.execution import Execution


class Foresight:
    """Spreads over two ticks what a tick in which a phase begins would do alone, which has the most to do of all.

    It changes no plan: what was foreseen is taken where the very same would be made, else it is made.
    """

    def __init__(self) -> None:
        self._from: tuple[Schedule, float] | None = None
        self._foreseen: Schedule

    def forgotten(self, schedule: Schedule, now: float) -> Schedule:
        """The schedule without what lies behind an instant of the clock [samples]."""
        return self._foreseen if self._knows(schedule, now) else schedule.forgotten(now)

    def _knows(self, schedule: Schedule, now: float) -> bool:
        return self._from is not None and self._from[0] is schedule and self._from[1] == now

    def next_of(self, execution: "Execution") -> "Execution | None":
        """The execution as it will be at the next tick, if a phase begins then that no touchdown begins.

        Else it is None. Of a schedule before a touchdown only the phases are known: its place will be felt.
        """
        if execution.left > 1.0 + CLOCK_ROUNDING:
            return None
        schedule, clock, later = execution.schedule, execution.clock.advanced(), None
        if self._knows(schedule, clock.now):
            return None
        ahead = schedule.forgotten(clock.now)
        if execution.phase.swing_foot is None:
            later = copy(execution)
            later.clock = clock
            try:
                later.follow(ahead)
            except ParameterError:  # which is said when the step is to come into sight
                return None
            ahead = later.schedule
        ahead.phase_table, ahead.first_support, ahead.supports, ahead.on_left  # noqa: B018  known from now on
        ahead.positions, ahead.yaws  # noqa: B018  likewise
        self._from, self._foreseen = (schedule, clock.now), ahead
        return later


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
