"""The phases of a gait on the integer clock of planner samples, and the walk's way through them."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surefoot.planner.ground.terrain import Terrain
from surefoot.planner.parameters import PlannerParameters, StepAdaptation
from surefoot.planner.types import Array, FeetState, Foot, Footstep, PhaseInfo, PhaseKind, PlannedFootstep
from surefoot.planner.walk.footsteps import FootstepPlan
from surefoot.planner.walk.gait import WEIGHT_SHIFT, GaitParameters, samples, support_rows


@dataclass(frozen=True, slots=True)
class Phase:
    """One support phase; it covers the samples `start` <= k < `start + samples`.

    Attributes:
        kind: stand, double or single support.
        start: first sample.
        samples: length in samples; the last phase of a schedule has 0, which means for ever.
        step: number of the step that this phase swings (single support) or has just landed (otherwise); 0 before.
        stance: the only supporting foot of a single support, otherwise None.
        support: support point (see `Schedule`) on which the ZMP reference stands, or which it leaves.
        rest: samples of a double support before it leaves.
    """

    kind: PhaseKind
    start: int
    samples: int
    step: int
    stance: Foot | None
    support: int
    rest: int = 0

    @property
    def end(self) -> int:
        """First sample after the phase (meaningless for the last one)."""
        return self.start + self.samples


@dataclass(frozen=True, slots=True)
class Schedule:
    """Phases and what follows from them at every sample; the arrays hold `preview` samples beyond the last change.

    The ZMP reference moves along the polyline of the support points (`planner.walk.gait.support_rows`): a point between
    the feet before each bout and at the end, and the stance foot of each step. At sample k it is `fraction[k]` of the
    way from point `index[k]` to the next. It rests while the robot stands, and on the stance foot in single
    support; in every double support it goes on to exactly the next point.

    Attributes:
        phases: in order, without gaps; the last one never ends.
        phase_index: index into `phases`, shape (K,).
        index: support point that the ZMP reference leaves, shape (K,).
        fraction: share of the way to the next support point, shape (K,), in [0, 1).
        fraction_rate: rate of that share within the phase's ramp, shape (K,) [1/s].
        load_left: share of the weight on the left foot, shape (K,).
        contacts: planned contacts (left, right), shape (K, 2).
        sample_time: length of a sample [s].
        last: first sample of the final standing; the clock need not go beyond it.
    """

    phases: tuple[Phase, ...]
    phase_index: NDArray[np.intp]
    index: NDArray[np.intp]
    fraction: Array
    fraction_rate: Array
    load_left: Array
    contacts: NDArray[np.bool_]
    sample_time: float
    last: int

    def phase(self, sample: int) -> Phase:
        """The phase at a sample, which may lie beyond the end of the walk."""
        return self.phases[int(self.phase_index[min(sample, self.last)])]


def schedule(gait: GaitParameters, sample_time: float, preview: int) -> Schedule:
    """Lay the gait's phases on the clock.

    Each bout: stand, a first double support of `WEIGHT_SHIFT` times the usual length that rests for all but the last of
    them, then single and double supports in turn. The last double support brings the ZMP back between the feet, where
    the robot stands until the next bout, in the end for ever.

    Args:
        gait: the gait.
        sample_time: planner sample time [s].
        preview: samples that a window may reach beyond the current one.

    Raises:
        ParameterError: a duration is no multiple of the sample time.
    """
    phases = _phases(gait, sample_time)
    last = phases[-1].start
    count = last + preview + 2
    phase_index = np.empty(count, dtype=np.intp)
    index = np.empty(count, dtype=np.intp)
    fraction = np.zeros(count)
    rate = np.zeros(count)
    contacts = np.ones((count, 2), dtype=np.bool_)
    for i, phase in enumerate(phases):
        span = slice(phase.start, phase.end if phase.samples else count)
        phase_index[span] = i
        index[span] = phase.support
        if phase.kind is PhaseKind.DOUBLE:
            ramp = phase.samples - phase.rest
            ramp_span = slice(phase.end - ramp, phase.end)
            fraction[ramp_span] = np.arange(ramp) / ramp
            rate[ramp_span] = 1.0 / (ramp * sample_time)
        if phase.stance is not None:
            contacts[span, phase.stance.other] = False
    on_left = np.array([float(gait.step_foot(row - 1) is Foot.LEFT) for row in range(gait.steps + 2)])
    share = on_left[support_rows(gait.walk)].mean(axis=1)
    load_left = (1.0 - fraction) * share[index] + fraction * share[np.minimum(index + 1, len(share) - 1)]
    for array in (phase_index, index, fraction, rate, load_left, contacts):
        array.flags.writeable = False
    return Schedule(phases, phase_index, index, fraction, rate, load_left, contacts, sample_time, last)


def _phases(gait: GaitParameters, sample_time: float) -> tuple[Phase, ...]:
    names = ("initial_stand", "single_support", "double_support")
    _, single, double = (samples(("gait", name), getattr(gait, name), sample_time) for name in names)
    phases: list[Phase] = []
    start = step = support = 0
    for bout in gait.walk:
        stand = samples(("bout", "stand"), bout.stand, sample_time)
        if stand:
            phases.append(Phase(PhaseKind.STAND, start, stand, step, None, support))
        shift, rest = WEIGHT_SHIFT * double, (WEIGHT_SHIFT - 1) * double
        phases.append(Phase(PhaseKind.DOUBLE, start + stand, shift, step, None, support, rest))
        for _ in bout.strides:
            step, support = step + 1, support + 1
            stance = gait.step_foot(step).other
            phases.append(Phase(PhaseKind.SINGLE, phases[-1].end, single, step, stance, support))
            phases.append(Phase(PhaseKind.DOUBLE, phases[-1].end, double, step, None, support))
        start, support = phases[-1].end, support + 1
    phases.append(Phase(PhaseKind.STAND, start, 0, step, None, support))
    return tuple(phases)


_SAME_GROUND = 1e-3
"""Footstep shift up to which the ground height is not looked up again [m]."""


class Stepper:
    """Advances the phases one sample per tick and books the touchdowns.

    A touchdown that is late holds the clock at the end of single support; an early one fixes its footstep where it was
    felt and never moves the clock (moving it was measured to cost 17 to 28 mm of DCM error).

    Attributes:
        schedule: phases of the walk.
        footsteps: all footholds, landed ones as measured.
        revision: how often they have changed.
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
        self.revision = 0
        self.row = 1
        self.tick = -1
        self.waited = 0
        self.early = False
        self.fixed = False
        self._terrain = terrain
        self._adapts = parameters.step_adaptation is StepAdaptation.LOCATION and terrain.free_footholds
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
            position, normal = steps.position[row].copy(), steps.normal[row]
            if ahead < 2 and self.free[ahead]:
                shift = shift + shifts[ahead]
            position[:2] += shift
            if abs(shift[0]) + abs(shift[1]) > _SAME_GROUND:
                x, y = float(position[0]), float(position[1])
                position[2] = self._terrain.height(x, y)
                normal = self._terrain.normal(x, y) if self._terrain.has_edges else normal
            footstep = Footstep(steps.feet[row], position, float(steps.yaw[row]), normal)
            planned.append(PlannedFootstep(row - 1, footstep, time + self.time_to_touchdown(row - 1)))
        return tuple(planned)

    def fix(self, position: Array) -> None:
        """Decide the next footstep.

        Args:
            position: where it lands, shape (3,) [m].
        """
        self.footsteps = self.footsteps.moved(self.row + 1, np.array(position), self._terrain)
        self.revision += 1
        self.fixed = True

    def _land(self, position: Array) -> None:
        self.fix(position)
        self.row += 1
        self.waited, self.early, self.fixed = 0, False, False
