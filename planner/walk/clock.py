"""The walk's clock, and its way through the phases in sight."""

import numpy as np

from surefoot.planner.ground.terrain import Terrain
from surefoot.planner.parameters import PlannerParameters, StepAdaptation
from surefoot.planner.types import Array, FeetState, Foot, Footstep, PhaseInfo, PhaseKind, PlannedFootstep
from surefoot.planner.walk.footsteps import FootstepPlan
from surefoot.planner.walk.gait import GaitParameters
from surefoot.planner.walk.phases import CLOCK_ROUNDING, Flow, Hurry, Pace, PhaseSamples
from surefoot.planner.walk.queue import Step, StepQueue
from surefoot.planner.walk.source import StepSource

_LEAST_LEFT = 3.0
"""A phase of which less is left, or would be, until its foot is to touch down keeps its pace [samples]."""

_SAME_GROUND = 1e-3
"""Footstep shift up to which the ground height is not looked up again [m]."""


class Stepper:
    """Advances the phases one sample per tick and books the touchdowns.

    A touchdown that is late holds the clock at the end of single support; an early one fixes its footstep where it was
    felt and never moves the clock (moving it was measured to cost 17 to 28 mm of DCM error).

    Args:
        queue: the steps in sight.
        terrain: the ground as the planner believes it to be.
        parameters: of the planner.
        window: how far a plan looks ahead [samples].

    Attributes:
        queue: the steps in sight.
        revision: how often the footholds have changed.
        landed: number of the step that landed last.
        sample_time: length of a sample [s].
        phase: the phase now.
        tick: the gait's clock [samples], -1 before the first tick.
        waited: ticks for which the clock has waited for the present touchdown.
        early: the swing foot has landed before its time.
        fixed: the next footstep may not be shifted any more.
    """

    def __init__(self, queue: StepQueue, terrain: Terrain, parameters: PlannerParameters, window: int) -> None:
        self.queue = queue
        self.revision = 0
        self.landed = 0
        self.tick = -1.0
        self.waited = 0
        self.early = False
        self.fixed = False
        self._terrain, self._window = terrain, window
        self._pace: Pace | None = None
        self._paced = 0.0
        self._began = 0.0
        self._adapts = parameters.step_adaptation is StepAdaptation.LOCATION and terrain.free_footholds
        self.sample_time = parameters.sample_time
        self._lead = parameters.touchdown_lead / parameters.sample_time
        self._patience = round(parameters.late_touchdown / parameters.sample_time)
        self._look_ahead(0.0)

    @property
    def footsteps(self) -> FootstepPlan:
        """Footholds in sight, landed ones as measured."""
        return self.queue.footsteps

    @property
    def row(self) -> int:
        """Row of the foot that landed last; it is the stance foot in single support."""
        return self.landed + 1 - self.footsteps.first

    @property
    def info(self) -> PhaseInfo:
        """The phase now, in seconds."""
        phase, t = self.phase, self.sample_time
        follows = phase if phase.stance is not None else self.queue.phase(phase.end)
        leads_to = follows.step if follows.stance is not None else 0
        return PhaseInfo(
            phase.kind, phase.stance, phase.step, (self.tick - phase.start) * t, phase.samples * t, leads_to
        )

    @property
    def swing_foot(self) -> Foot | None:
        """The swinging foot in single support."""
        stance = self.phase.stance
        return None if stance is None else stance.other

    @property
    def swinging(self) -> Step:
        """The step being swung; asked in single support only."""
        return self.queue.steps[self.phase.step]

    @property
    def free(self) -> tuple[bool, bool]:
        """Whether the next two footsteps exist and may be shifted."""
        remaining = len(self.footsteps.feet) - 1 - self.row
        return (self._adapts and remaining >= 1 and not self.fixed, self._adapts and remaining >= 2)

    @property
    def left(self) -> float:
        """Time until the present phase ends [samples]."""
        return self._until(self.phase.end)

    @property
    def time_left(self) -> float:
        """Time until the present phase ends [s]."""
        return self.left * self.sample_time

    @property
    def transfer_time(self) -> float:
        """Duration of the double support that follows a single support, zero in other phases [s]."""
        phase = self.phase
        if phase.kind is not PhaseKind.SINGLE:
            return 0.0
        return self.queue.phase(phase.end).samples * self.sample_time

    def time_to_touchdown(self, step: int) -> float:
        """Time until a step in sight lands [s]."""
        return self._until(self.queue.lift_off(step).end) * self.sample_time

    def _until(self, clock: float) -> float:
        """Time until an instant on the clock that no pace goes beyond [samples]."""
        if self._pace is None:
            return clock - self.tick
        return self._pace.length - self._paced + clock - self._began - self._pace.way

    @property
    def steady(self) -> bool:
        """Whether the clock goes by itself, and every sample is one on."""
        return self._pace is None

    def hurry(self, time: float) -> Hurry | None:
        """How the clock goes, which shows a time [s] now; None while it goes by itself."""
        if self._pace is None:
            return None
        t = self.sample_time
        return Hurry(self._pace, time - self._paced * t, time + (self._began - self.tick) * t, t)

    def samples(self, count: int) -> PhaseSamples:
        """The phases at `count` samples from now on, with one more before them and one after."""
        ahead = np.arange(-1.0, count + 1)
        if self._pace is None:
            return self.queue.samples(Flow(np.maximum(self.tick + ahead, 0.0)))
        way, rate, bend = self._pace.at(self._paced + ahead)
        return self.queue.samples(Flow(self._began + way, (rate, bend / self.sample_time)))

    def retime(self, gait: GaitParameters) -> float:
        """Take the durations of a gait from now on; what is left of the present phase changes in proportion.

        Args:
            gait: gives the durations of every step to come, and of this one.

        Returns:
            By how much the end of the present phase is put off [s].
        """
        left, phase, (_, rate, bend) = self.time_left, self.phase, self._following(0.0)
        length = self.queue.retime(gait, phase, self.tick)
        way = phase.end - self.tick
        lasting = length * way / phase.samples
        if phase.kind is not PhaseKind.STAND and min(way, lasting) >= _LEAST_LEFT + self._lead:
            self._pace = Pace.over(way, lasting, rate, bend)
            self._began, self._paced = self.tick, 0.0
        self.revision += 1
        self._look_ahead(self.tick)
        return self.time_left - left if phase.kind is not PhaseKind.STAND else 0.0

    def reorder(self, source: StepSource | None = None) -> None:
        """Take the steps to come from another source, or ask the present one anew; see `StepQueue.reorder`."""
        self.queue.reorder(self.phase, source)
        self.revision += 1
        self._look_ahead(self.tick)

    def advance(self, feet: FeetState) -> None:
        """Go on by one tick.

        Args:
            feet: the measured feet.
        """
        following, _, _ = self._following(1.0)
        phase, swing = self.phase, self.swing_foot
        if swing is not None and self.tick >= 0.0:
            contact = feet.contact[swing]
            if following >= phase.end - CLOCK_ROUNDING:
                if not contact and self.waited < self._patience:
                    self.waited += 1
                    return
                self._land(feet.position[swing])
            elif contact and not self.early and 2.0 * (following - phase.start) > phase.samples:
                self.early = True
                self.fix(feet.position[swing])
        self.tick = following
        self._paced += 1.0
        if self._pace is not None and self._paced >= self._pace.length - CLOCK_ROUNDING:
            self._pace = None
        if following >= phase.end - CLOCK_ROUNDING:
            self.queue.enter(following)
        if following >= phase.end - CLOCK_ROUNDING or phase.samples == np.inf:
            self._look_ahead(following)

    def _following(self, samples: float) -> tuple[float, float, float]:
        """The clock so many samples from now, its rate and the derivative of that by samples."""
        if self._pace is None:
            return self.tick + samples, 1.0, 0.0
        way, rate, bend = (float(value[0]) for value in self._pace.at(np.array([self._paced + samples])))
        return self._began + way, rate, bend

    def _look_ahead(self, clock: float) -> None:
        """See as far as any plan of the phase at an instant on the clock looks; a step ordered may end a stand."""
        more = self.queue.extend(clock + self._window, clock)
        self.phase = self.queue.phase(clock)
        if self.phase.samples < np.inf:
            more |= self.queue.extend(self.phase.end + self._window, clock)
        self.revision += more

    def upcoming(self, time: float, shifts: Array) -> tuple[PlannedFootstep, ...]:
        """The next footsteps, at most three.

        Args:
            time: now [s].
            shifts: shifts of the first two from their nominal increments, in the world frame, shape (2, 2) [m].
        """
        steps, planned = self.footsteps, []
        shift = np.zeros(2)
        for ahead, row in enumerate(range(self.row + 1, min(self.row + 4, len(steps.feet)))):
            position, normal = steps.position[row].copy(), steps.normal[row]
            if ahead < 2 and self.free[ahead]:
                shift = shift + shifts[ahead]
            position[:2] += shift
            if abs(shift[0]) + abs(shift[1]) > _SAME_GROUND:
                x, y = float(position[0]), float(position[1])
                position[2] = self._terrain.height(x, y)
                normal = self._terrain.normal(x, y) if self._terrain.has_edges else normal
            footstep = Footstep(steps.feet[row], position, float(steps.yaw[row]), normal)
            step = self.landed + 1 + ahead
            planned.append(PlannedFootstep(step, footstep, time + self.time_to_touchdown(step)))
        return tuple(planned)

    def fix(self, position: Array) -> None:
        """Decide the next footstep.

        Args:
            position: where it lands, shape (3,) [m].
        """
        self.queue.footsteps = self.footsteps.moved(self.row + 1, np.array(position), self._terrain)
        self.revision += 1
        self.fixed = True

    def _land(self, position: Array) -> None:
        self.fix(position)
        self.landed += 1
        self.waited, self.early, self.fixed = 0, False, False
