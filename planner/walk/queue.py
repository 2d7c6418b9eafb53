"""The steps in sight: a short queue that a source fills and the walk's clock empties."""

from dataclasses import replace

import numpy as np

from surefoot.planner.geometry import frame_rotation
from surefoot.planner.swing.heel_off import LEVEL_AGAIN, roll_span, roll_times, stretched
from surefoot.planner.swing.trajectory import SwingCourse
from surefoot.planner.types import Array, FeetState, Foot, PhaseKind
from surefoot.planner.walk.commands import Pose
from surefoot.planner.walk.footsteps import start_footholds
from surefoot.planner.walk.gait import WEIGHT_SHIFT, GaitParameters, Stride, in_samples
from surefoot.planner.walk.phases import CLOCK_ROUNDING, Flow, Phase, PhaseSamples
from surefoot.planner.walk.reach import Landing, check_reach
from surefoot.planner.walk.source import GaitSource, Interlude, Request, StepOrder, StepSource
from surefoot.planner.walk.step import Ground, Step, lay, unit_swing

_MORE_STEPS = 3
"""Steps in sight beyond a window: its last support points depend on the ones after them, and a plan tells three."""


class StepQueue:
    """The steps in sight, with the phases of which they are made and their footholds.

    Each bout: stand, a first double support of `WEIGHT_SHIFT` times the usual length that rests for all but the last of
    them, then single and double supports in turn. The last double support brings the ZMP back between the feet, where
    the robot stands until the next bout.

    Args:
        gait: gives the durations and what else all steps have in common.
        feet: where the feet stand at the start.
        ground: to lay steps on.
        source: of the steps; those of the gait by default.

    Attributes:
        gait: what all steps to come have in common.
        ground: to lay steps on.
        phases: those in sight in order, without gaps, the one before the present first.
        steps: those in sight by their numbers.
        footsteps: footholds in sight, landed ones as measured.

    Raises:
        ParameterError: a footstep is out of reach, or no swing clears the edges before it.
    """

    def __init__(self, gait: GaitParameters, feet: FeetState, ground: Ground, source: StepSource | None = None) -> None:
        self.gait, self.ground, self._source = gait, ground, source or GaitSource(gait)
        path, self.footsteps = start_footholds(gait, feet, ground.terrain)
        start = [self.footsteps.footstep(row) for row in (0, 1)]
        zero, course = Stride(0.0, 0.0, 0.0, gait.step_width), SwingCourse(0.5, 0.0, 1.0, 0.0)
        swing = unit_swing(self._durations[0], 0.0, course, ground.parameters)
        # The start feet count as footsteps -1 and 0, so that the first steps are laid as all others.
        self.steps = {
            number: Step(number, zero, path, start[number + 1], 0.0, 0.0, np.zeros((2, 2)), course, swing)
            for number in (-1, 0)
        }
        self.phases: list[Phase] = [Phase(PhaseKind.STAND, 0.0, np.inf, 0, None, 0)]

    @property
    def _last(self) -> Step:
        """The last step in sight."""
        return self.steps[max(self.steps)]

    @property
    def _standing(self) -> bool:
        """Whether the last phase in sight is to stand until a step is ordered."""
        return self.phases[-1].kind is PhaseKind.STAND

    @property
    def support_heights(self) -> Array:
        """Heights of the support points in sight, shape (m,) [m]."""
        return self.footsteps.support_points()[:, 2]

    def extend(self, clock: float, now: float = 0.0) -> bool:
        """Ask for steps until all is known up to an instant on the clock, and three steps more.

        Args:
            clock: the instant [samples].
            now: the robot has stood until then, if it stands [samples].

        Returns:
            Whether there are more than before.
        """
        before = len(self.phases), self.phases[-1]
        while self._lift_offs_after(clock) < _MORE_STEPS and self._ask(now):
            pass
        return before != (len(self.phases), self.phases[-1])

    def _lift_offs_after(self, clock: float) -> int:
        return sum(phase.kind is PhaseKind.SINGLE and phase.start >= clock for phase in self.phases[-2 * _MORE_STEPS :])

    def _ask(self, now: float) -> bool:
        """Lay what comes next; says whether there is anything."""
        last, phases, t = self._last, self.phases, self.ground.parameters.sample_time
        time, before = (phases[-1].start, None) if self._standing else (phases[-1].end, last.stride)
        order = self._source.order(Request(last.number + 1, time * t, before, self._pose, self.gait.period))
        if order is None:
            if self._standing:
                return False
            self._end_bout()
            return True
        if self._standing:
            stand = max(in_samples(order.stand, t), now - phases[-1].start)
            self._begin_bout(phases[-1], stand, order)
        self._lay(order.stride)
        return True

    @property
    def _pose(self) -> Pose:
        """Where the path is that the footsteps in sight go along."""
        path = self._last.path
        x, y = path.middle + self.footsteps.shift
        return Pose(float(x), float(y), path.yaw)

    def _begin_bout(self, stand: Phase, samples: float, order: StepOrder) -> None:
        double, ramp = self._durations[1], order.farther * self._durations[1]
        self.phases[-1:] = [replace(stand, samples=samples)] if samples else []
        shift, rest = (
            (double, 0.0) if order.hurried else (ramp + (WEIGHT_SHIFT - 1) * double, (WEIGHT_SHIFT - 1) * double)
        )
        self.phases.append(Phase(PhaseKind.DOUBLE, stand.start + samples, shift, stand.step, None, stand.support, rest))

    def _end_bout(self) -> None:
        last = self.phases[-1]
        self.footsteps = self.footsteps.supported(last.step, last.step + 1)
        self.phases.append(Phase(PhaseKind.STAND, last.end, np.inf, last.step, None, last.support + 1))

    def _lay(self, stride: Stride) -> None:
        """Lay a step: its foothold, its single support and the double support that follows."""
        gait, (single, double) = self.gait, self._durations
        step = lay(stride, (self.steps[self._last.number - 1], self._last), gait, single, self.ground)
        check_reach(step.number, Landing.between(self._last.place, step.place), self.ground.parameters)
        footsteps = self.footsteps.followed(step.beside(self.footsteps.shift, self.ground.terrain))
        self.footsteps = footsteps.supported(step.number, step.number)
        self.steps[step.number] = step
        before = self.phases[-1]
        support, number = before.support + 1, step.number
        ends = (self.steps[number - 2].place, self.steps[number - 1].place)
        roll = roll_span(before, single, *ends, gait.heel_off, float(self.ground.half_size[0]))
        self.phases[-1] = replace(before, roll=roll)
        stance = gait.step_foot(number).other
        swing = Phase(PhaseKind.SINGLE, before.end, single, number, stance, support, roll=roll)
        self.phases += [swing, Phase(PhaseKind.DOUBLE, swing.end, double, number, None, support)]

    def reorder(self, present: Phase, source: StepSource | None = None) -> None:
        """Ask anew for all steps but the one being swung and the one to which the weight is being shifted.

        A stop is made once its last foot swings: the DCM is on its way to rest between the feet by then, and small feet
        cannot bring it to where the next step would need it.

        Args:
            present: the phase now.
            source: of the steps from now on; that of those before by default.
        """
        self._source = source or self._source
        # Kept is up to the double support after the last step that is, or to the stand that has begun or will.
        kept = self.phases.index(present) + (1 if present.kind is PhaseKind.SINGLE else 0)
        if present.kind is PhaseKind.DOUBLE:
            kept += 2 if self.phases[kept + 1].kind is PhaseKind.SINGLE else 1
        elif present.kind is PhaseKind.SINGLE and self.phases[kept + 1].kind is PhaseKind.STAND:
            kept += 1
        self._forget(kept)

    def stops(self, present: Phase) -> bool:
        """Whether the robot stands, or will with the next step that lands."""
        return any(phase.kind is PhaseKind.STAND for phase in self.phases[self.phases.index(present) :][:4])

    def go_on(self, present: Phase, foot: Foot | None = None, at_once: bool = True) -> None:
        """Make a step on the spot where the robot stands or would stand next, before anything else.

        The weight goes from between the feet onto one of them. In the time that it usually takes it gets there only
        from feet as near to each other as usual: who is to step at leisure takes the longer the wider it stands, once
        its weight has begun to shift. A longer rest before that would take the CoM farther than the rear leg reaches.

        Args:
            present: the phase now.
            foot: that makes it, of a robot that stands; else it is the one that landed first.
            at_once: with a weight shift no longer than any, wherever the feet are.
        """
        at = self.phases.index(present)
        stand = next(n for n, phase in enumerate(self.phases[at:], at) if phase.kind is PhaseKind.STAND)
        self._forget(max(at, stand - 1))
        last = self._last.number
        if foot is not None and self.gait.step_foot(last + 1) is not foot:
            self._swap_feet(last)
        farther = 1.0 if at_once else max(1.0, self._apart(last))
        spot = StepOrder(Stride(0.0, 0.0, 0.0, self.gait.step_width), hurried=at_once, farther=farther)
        self._source = Interlude(self._source, last + 1, spot)

    def step_again(self, present: Phase) -> None:
        """Before anything else let both feet land once more where they are with the step that is being swung.

        Args:
            present: the single support now.
        """
        stride = self.steps[present.step].stride
        back = replace(stride, length=-stride.length, lateral=-stride.lateral, turn=-stride.turn)
        self.reorder(present, Interlude(self._source, present.step + 1, StepOrder(back), StepOrder(stride)))

    def _apart(self, last: int) -> float:
        """How many times as far apart as nominally the feet stand with which a step and the one before it landed."""
        row, places = last + 1 - self.footsteps.first, (self.steps[last].place, self.steps[last - 1].place)
        ways = self.footsteps.position[row] - self.footsteps.position[row - 1], places[0].position - places[1].position
        here, usual = (float(np.hypot(*way[:2])) for way in ways)
        return here / usual

    def _swap_feet(self, last: int) -> None:
        """Let the other foot be the one that landed last, so that this one makes the next step."""
        self.gait = replace(self.gait, first_foot=Foot(self.gait.first_foot).other)
        self.footsteps = self.footsteps.swapped()
        one, other = self.steps[last - 1], self.steps[last]
        self.steps |= {last - 1: replace(one, place=other.place), last: replace(other, place=one.place)}

    def _forget(self, kept: int) -> None:
        """Let go of all that comes after a phase; a robot that stands then does so until steps are ordered."""
        last = replace(self.phases[kept], roll=None)
        if last.kind is PhaseKind.STAND:
            last = replace(last, samples=np.inf)
        del self.phases[kept:]
        self.phases.append(last)
        self.steps = {number: step for number, step in self.steps.items() if number <= last.step}
        self.footsteps = self.footsteps.until(last.step + 1, last.support)

    def enter(self, clock: float) -> None:
        """Let go of what lies behind an instant on the clock, but for the phase of the sample before it.

        Args:
            clock: the instant [samples].
        """
        phases, gone = self.phases, 0
        while phases[gone].end <= clock - 1.0 + CLOCK_ROUNDING:
            gone += 1
        if not gone:
            return
        del phases[:gone]
        first = phases[0]
        self.steps = {number: step for number, step in self.steps.items() if number >= first.step - 2}
        self.footsteps = self.footsteps.since(first.step - 2, first.support - 2)

    def retime(self, gait: GaitParameters, present: Phase, clock: float) -> float:
        """Give all steps to come the durations of a gait; phases that have begun keep theirs on the clock.

        Args:
            gait: what all steps to come have in common.
            present: the phase now.
            clock: now [samples].

        Returns:
            How long the present phase would last with these durations [samples].
        """
        self.gait = gait
        single, double = self._durations
        at = self.phases.index(present)
        for number in range(at + 1, len(self.phases)):
            phase, before = self.phases[number], self.phases[number - 1]
            samples, rest = _lasting(phase, single, double)
            phase = replace(phase, start=before.end, samples=samples, rest=rest)
            if phase.kind is PhaseKind.SINGLE:
                phase = self._retimed_roll(number, phase, clock)
                step = self.steps[phase.step]
                swing = unit_swing(phase.samples, step.climb, step.course, self.ground.parameters)
                self.steps[phase.step] = replace(step, swing=swing)
            self.phases[number] = phase
        return _lasting(present, single, double)[0]

    def _retimed_roll(self, number: int, phase: Phase, clock: float) -> Phase:
        """A single support with its roll and that of the double support before it.

        A roll that has begun stays, and the swing lasts at least until its foot is level.
        """
        if phase.roll is None:
            return phase
        if clock >= phase.roll.start:
            return replace(phase, samples=max(phase.samples, (phase.roll.end - phase.start) / LEVEL_AGAIN))
        roll = roll_times(self.phases[number - 1], phase.samples, phase.roll.angle)
        self.phases[number - 1] = replace(self.phases[number - 1], roll=roll)
        return replace(phase, roll=roll)

    @property
    def _durations(self) -> tuple[float, float]:
        """Single and double support of the steps to come [samples]."""
        t = self.ground.parameters.sample_time
        return in_samples(self.gait.single_support, t), in_samples(self.gait.double_support, t)

    def go_beside(self, step: int) -> None:
        """Let all steps after one that has landed aside of its place on its face go as far aside, as far as theirs go.

        Args:
            step: that has just landed.
        """
        plan, terrain = self.footsteps, self.ground.terrain
        row, place = step + 1 - plan.first, self.steps[step].place
        aside = frame_rotation(place.yaw)[:, 1]
        shift = aside * float(aside @ (plan.position[row] - place.position)[:2])
        later = [self.steps[number].beside(shift, terrain) for number in range(step + 1, max(self.steps) + 1)]
        position, normal = (
            np.array([*values[: row + 1], *(getattr(one, name) for one in later)])
            for name, values in (("position", plan.position), ("normal", plan.normal))
        )
        self.footsteps = replace(plan, position=position, normal=normal, shift=shift)

    def lift_heel(self, step: int, radius: float) -> None:
        """Let the foot that a step has left too far behind for its leg roll as it leaves the ground.

        Args:
            step: that has just landed.
            radius: how far from under its hip a sole reaches flat [m].
        """
        at = self.phases.index(self.lift_off(step)) + 1
        row = step + 1 - self.footsteps.first
        stance, leaving = self.footsteps.footstep(row), self.footsteps.footstep(row - 1)
        ahead = float(((stance.position - leaving.position)[:2] @ frame_rotation(stance.yaw))[0])
        angle = stretched(ahead, radius, self.ground.parameters.size.length)
        if at + 1 == len(self.phases) or self.phases[at + 1].kind is not PhaseKind.SINGLE:
            return
        before, swing = self.phases[at : at + 2]
        if angle > (swing.roll.angle if swing.roll else 0.0):
            roll = roll_times(before, swing.samples, angle)
            self.phases[at : at + 2] = [replace(before, roll=roll), replace(swing, roll=roll)]

    def phase(self, clock: float) -> Phase:
        """The phase at an instant on the clock, the first in sight if it lies before."""
        return next((p for p in reversed(self.phases) if p.start <= clock + CLOCK_ROUNDING), self.phases[0])

    def samples(self, flow: Flow) -> PhaseSamples:
        """The phases at the samples of a window."""
        return PhaseSamples.of(self.phases, flow, self.ground.parameters.sample_time, self.footsteps.first_support)

    def lift_off(self, step: int) -> Phase:
        """The single support of a step in sight."""
        return next(p for p in self.phases if p.kind is PhaseKind.SINGLE and p.step == step)


def _lasting(phase: Phase, single: float, double: float) -> tuple[float, float]:
    """How long a phase lasts and, of a double support, rests with these durations [samples]."""
    if phase.kind is PhaseKind.SINGLE:
        return single, 0.0
    if phase.kind is PhaseKind.STAND:
        return phase.samples, 0.0
    return (WEIGHT_SHIFT * double, (WEIGHT_SHIFT - 1) * double) if phase.rest else (double, 0.0)
