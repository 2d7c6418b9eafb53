"""The walk's clock and the footholds taken so far."""

import math
from dataclasses import replace

import numpy as np

from planner.footsteps import FootstepPlan
from planner.parameters import PlannerParameters, StepAdaptation
from planner.schedule import Phase, Schedule
from planner.terrain import Terrain
from planner.types import Array, FeetState, Foot, PhaseInfo, PhaseKind, PlannedFootstep

_SAME_GROUND = 1e-3
"""Footstep shift up to which the ground height is not looked up again [m]."""


class Stepper:
    """Advances the phases one sample per tick and books the touchdowns.

    A touchdown that is late holds the clock at the end of single support; an early one fixes its footstep where it was
    felt and never moves the clock (moving it was measured to cost 17 to 28 mm of DCM error).

    Attributes:
        schedule: phases of the walk.
        footsteps: all footholds, landed ones as measured.
        row: row of the foot that landed last; it is the stance foot in single support.
        tick: sample of the gait's clock, -1 before the first tick.
        waited: ticks for which the clock has waited for the present touchdown.
        early: the swing foot has landed before its time.
        fixed: the next footstep may not be shifted any more.
    """

    def __init__(
        self, schedule: Schedule, footsteps: FootstepPlan, terrain: Terrain, parameters: PlannerParameters
    ) -> None:
        self.schedule = schedule
        self.footsteps = footsteps
        self.row = 1
        self.tick = -1
        self.waited = 0
        self.early = False
        self.fixed = False
        self._terrain = terrain
        self._adapts = parameters.step_adaptation is StepAdaptation.LOCATION and not terrain.boxes
        self._patience = round(parameters.late_touchdown / parameters.sample_time)
        self._touchdown = [phase.end for phase in schedule.phases if phase.kind is PhaseKind.SINGLE]

    @property
    def sample(self) -> int:
        """Index into the schedule's arrays."""
        return min(self.tick, self.schedule.last)

    @property
    def phase(self) -> Phase:
        """The phase now."""
        return self.schedule.phase(max(self.tick, 0))

    @property
    def info(self) -> PhaseInfo:
        """The phase now, in seconds."""
        phase, t = self.phase, self.schedule.sample_time
        duration = phase.samples * t if phase.samples else math.inf
        return PhaseInfo(phase.kind, phase.stance, phase.step, (self.tick - phase.start) * t, duration)

    @property
    def swing_foot(self) -> Foot | None:
        """The swinging foot in single support."""
        stance = self.phase.stance
        return None if stance is None else stance.other

    @property
    def free(self) -> tuple[bool, bool]:
        """Whether the next two footsteps exist and may be shifted."""
        remaining = self.footsteps.steps + 1 - self.row
        return (self._adapts and remaining >= 1 and not self.fixed, self._adapts and remaining >= 2)

    def time_to_touchdown(self, step: int) -> float:
        """Time by the phase clock until a step lands [s]."""
        return (self._touchdown[step - 1] - self.tick) * self.schedule.sample_time

    @property
    def transfer_time(self) -> float:
        """Duration of the double support that follows a single support, zero in other phases [s]."""
        phase = self.phase
        if phase.kind is not PhaseKind.SINGLE:
            return 0.0
        return self.schedule.phase(phase.end).samples * self.schedule.sample_time

    def advance(self, feet: FeetState) -> None:
        """Go on by one tick.

        Args:
            feet: the measured feet.
        """
        following = self.tick + 1
        phase, swing = self.phase, self.swing_foot
        if swing is not None and self.tick >= 0:
            contact = feet.contact[swing]
            if following == phase.end:
                if not contact and self.waited < self._patience:
                    self.waited += 1
                    return
                self._land(feet.position[swing])
            elif contact and not self.early and 2 * (following - phase.start) > phase.samples:
                self.early = True
                self.fix(feet.position[swing])
        self.tick = following

    def upcoming(self, time: float, shifts: Array) -> tuple[PlannedFootstep, ...]:
        """The next footsteps, at most three.

        Args:
            time: now [s].
            shifts: shifts of the first two from their nominal increments, in the world frame, shape (2, 2) [m].
        """
        steps, planned = self.footsteps, []
        shift = np.zeros(2)
        for ahead, row in enumerate(range(self.row + 1, min(self.row + 4, steps.steps + 2))):
            position = steps.position[row].copy()
            if ahead < 2 and self.free[ahead]:
                shift = shift + shifts[ahead]
            position[:2] += shift
            if abs(shift[0]) + abs(shift[1]) > _SAME_GROUND:
                position[2] = self._terrain.height(float(position[0]), float(position[1]))
            footstep = replace(steps.footstep(row), position=position)
            planned.append(PlannedFootstep(row - 1, footstep, time + self.time_to_touchdown(row - 1)))
        return tuple(planned)

    def fix(self, position: Array) -> None:
        """Decide the next footstep.

        Args:
            position: where it lands, shape (3,) [m].
        """
        self.footsteps = self.footsteps.moved(self.row + 1, np.array(position), self._terrain)
        self.fixed = True

    def _land(self, position: Array) -> None:
        self.fix(position)
        self.row += 1
        self.waited, self.early, self.fixed = 0, False, False
