"""The schedule of steps: one immutable value, and pure functions from one schedule to the next.

A bout is a stop, a first double support of `WEIGHT_SHIFT` times the usual length that rests for all but the last of
them, then single and double supports in turn. The last double support brings the ZMP back between the feet, where the
robot stands until the next bout.
"""

import math
from bisect import bisect_right
from contextlib import suppress
from dataclasses import dataclass, field, replace
from operator import attrgetter

import numpy as np
from numpy.typing import NDArray

from surefoot.errors import ParameterError
from surefoot.planner.geometry.plane import wrap_angle
from surefoot.planner.model.time_scaling import CLOCK_ROUNDING
from surefoot.planner.steps.footsteps import start_footholds
from surefoot.planner.steps.gait import GaitParameters, in_samples
from surefoot.planner.steps.phases import Phase, PhaseSamples, PhaseTable, phases_since
from surefoot.planner.steps.source import GaitSource, StepSource
from surefoot.planner.steps.step import Step, Stop, durations, known_step, make_step, start_step
from surefoot.planner.swing.course import Ground
from surefoot.planner.types import Array, FeetState, Foot, PhaseKind, Twist

_MORE_STEPS = 3
"""Steps in sight beyond a window: its last support points depend on the ones after them, and a plan tells three [-]."""

_STOP_AHEAD = 4
"""Phases, with the present one, within which a stand is the end of the step that is being made [-]."""

_LAID_OUT = 120.0
"""Time of a walk on bare ground whose steps are laid before it begins; a minute of them takes some milliseconds [s]."""

_START = attrgetter("start")
"""The start of a phase."""


@dataclass(frozen=True)
class Schedule:
    """The steps in sight, those that have landed as measured; all times are on the clock of the gait, in samples.

    Two schedules are equal where they have the same steps, not merely steps that are alike.

    Attributes:
        gait: what all steps to come have in common.
        ground: to lay steps on.
        source: of the steps to come.
        steps: in order; the first ones are start feet (steps -1 and 0), or have landed long ago.
        stands: whether the robot stands after the last one, as far as is known for ever.
        shift: where steps that come into sight lie from their nominal places, shape (2,) [m].
        begin: phases that were over by then are forgotten [samples].
        nominal_steps: steps of the walk as they are nominally laid, of which those that come into sight are taken.
        phases: the phases in sight in order, without gaps; they follow from steps, `stands` and `begin`.
    """

    gait: GaitParameters
    ground: Ground = field(compare=False)
    source: StepSource
    steps: tuple[Step, ...]
    stands: bool
    shift: Array = field(compare=False)
    begin: float
    nominal_steps: tuple[Step, ...] = field(compare=False)
    phases: tuple[Phase, ...] = field(compare=False)

    @classmethod
    def start(
        cls, gait: GaitParameters, feet: FeetState, ground: Ground, source: StepSource | None = None
    ) -> "Schedule":
        """The schedule of a robot that stands, with no step in sight yet.

        Args:
            gait: gives the durations and what else all steps have in common.
            feet: where the feet stand.
            ground: to lay steps on.
            source: of the steps; those of the gait by default.
        """
        path, places = start_footholds(gait, feet, ground.terrain)
        steps = tuple(
            start_step(number, place, path, gait, ground) for number, place in zip((-1, 0), places, strict=True)
        )
        phases = phases_since(0.0, steps, True)
        return cls(gait, ground, source or GaitSource(gait), steps, True, np.zeros(2), 0.0, (), phases)

    # What follows from a schedule.

    @property
    def first_support(self) -> int:
        """Number in the walk of the first support point in sight."""
        return max(self.phases[0].support - 2, 0)

    @property
    def supports(self) -> NDArray[np.intp]:
        """Support points of the ZMP in sight, as indices of the two steps that each lies between, shape (m, 2).

        It lies between both feet where the robot stands, and on one, given twice, while the robot stands on that.
        """
        points: list[tuple[int, tuple[int, int]]] = []
        for at, step in enumerate(self.steps):
            if step.stop is not None:
                points.append((step.support - 1, (at - 2, at - 1)))
            points.append((step.support, (at - 1, at - 1)))
        if self.stands:
            points.append((self.last.support + 1, (len(self.steps) - 2, len(self.steps) - 1)))
        return np.array([between for number, between in points if number >= self.first_support])

    @property
    def positions(self) -> Array:
        """Places where the steps land, sole centres in the world frame, shape (n, 3) [m]."""
        return np.array([step.place.position for step in self.steps])

    @property
    def yaws(self) -> Array:
        """Headings of the steps, unwrapped, shape (n,) [rad]."""
        return np.array([step.place.yaw for step in self.steps])

    def at_supports(self, values: Array) -> Array:
        """Turn values of the steps, shape (n, ...), into those at the support points: means of two, shape (m, ...)."""
        one, other = self.supports.T
        return np.asarray(0.5 * (values[one] + values[other]))

    @property
    def on_left(self) -> Array:
        """Share of the weight on the left foot at the support points, shape (m,) [-]."""
        left = [1.0 if step.place.foot is Foot.LEFT else 0.0 for step in self.steps]
        return np.array([0.5 * (left[one] + left[other]) for one, other in self.supports.tolist()])

    @property
    def support_points(self) -> Array:
        """The support points, shape (m, 3) [m]."""
        return self.at_supports(self.positions)

    @property
    def last(self) -> Step:
        """The last step in sight."""
        return self.steps[len(self.steps) - 1]

    @property
    def last_phase(self) -> Phase:
        """The last phase in sight."""
        return self.phases[len(self.phases) - 1]

    def index(self, number: int) -> int:
        """Index of a step in `steps`."""
        return number - self.steps[0].number

    def step(self, number: int) -> Step:
        """A step in sight."""
        return self.steps[number - self.steps[0].number]

    def after(self, number: int) -> tuple[Step, ...]:
        """The steps in sight after one."""
        return self.steps[number + 1 - self.steps[0].number :]

    def turn(self, number: int) -> float:
        """Heading of a step against the one before it; zero where there is none [rad]."""
        if number > self.last.number:
            return 0.0
        return wrap_angle(self.step(number).place.yaw - self.step(number - 1).place.yaw)

    def phase(self, clock: float) -> Phase:
        """The phase at an instant, the first in sight if it lies before."""
        return self.following(clock)[0]

    def following(self, clock: float) -> tuple[Phase, ...]:
        """The phase at an instant and those after it."""
        return self.phases[max(bisect_right(self.phases, clock + CLOCK_ROUNDING, key=_START) - 1, 0) :]

    def stops(self, clock: float) -> bool:
        """Return true if the robot stands at an instant, or will with the next step that lands."""
        return any(phase.kind is PhaseKind.STAND for phase in self.following(clock)[:_STOP_AHEAD])

    def samples(self, clock: Array, rate: tuple[Array, Array] | None = None) -> PhaseSamples:
        """The phases where the clock shows some instants [samples], at a rate of the clock; see `PhaseSamples`."""
        table, sample_time = PhaseTable.of(self.phases), self.ground.parameters.sample_time
        return PhaseSamples(table, clock, sample_time, self.first_support, rate)

    def usual_samples(self, phase: Phase) -> float:
        """Usual duration of a phase that had not begun [samples]."""
        single, double = self.durations
        if phase.kind is PhaseKind.SINGLE:
            return single
        if phase.kind is PhaseKind.STAND:
            return phase.samples
        return Stop.usual(0.0, double).shift if phase.rest else double

    def climbs_next(self, clock: float) -> bool:
        """Return true if a foot swings, on faces that footsteps were chosen for, and the step after it climbs."""
        present = self.phase(clock)
        following = self.after(present.step)[: present.stance is not None]
        return any(self.ground.terrain.footholds.edged(step.climb) for step in following)

    def apart(self, number: int) -> tuple[Array, Array]:
        """Way to where a step landed from where the one before it did, and nominally, shape (2,) each [m]."""
        step, other = self.step(number), self.step(number - 1)
        ways = step.place.position - other.place.position, step.nominal.position - other.nominal.position
        return ways[0][:2], ways[1][:2]

    @property
    def durations(self) -> tuple[float, float]:
        """Single and double support of the steps to come [samples]."""
        return durations(self.gait, self.ground.parameters.sample_time)

    @property
    def _end(self) -> Twist:
        """End of the path along which the footsteps in sight go."""
        path = self.last.path
        x, y = path.middle + self.shift
        return Twist(float(x), float(y), path.yaw)

    # From a schedule to the next.

    def with_nominal_steps(self) -> "Schedule":
        """The schedule that knows the steps of its source beforehand: to lay one over edges takes milliseconds."""
        longer, bare, t = self, not self.ground.terrain.has_edges, self.ground.parameters.sample_time
        with suppress(ParameterError):  # a step that cannot be laid is refused once it comes into sight
            while longer.last.lift_off < (_LAID_OUT / t if bare else math.inf) and (more := longer._asked(0.0)):
                longer = more
        return replace(self, nominal_steps=longer.steps)

    def extended(self, until: float, now: float = 0.0) -> "Schedule":
        """Steps are asked for until all is known up to an instant, and three steps more.

        Args:
            until: the instant [samples].
            now: the robot has stood until then, if it stands [samples].

        Raises:
            ParameterError: a footstep is out of reach, or no swing clears the edges before it.
        """
        schedule = self
        while schedule._lift_offs_after(until) < _MORE_STEPS and (more := schedule._asked(now)) is not None:
            schedule = more
        return schedule

    def _lift_offs_after(self, clock: float) -> int:
        return sum(p.kind is PhaseKind.SINGLE and p.start >= clock for p in self.phases[-2 * _MORE_STEPS :])

    def _asked(self, now: float) -> "Schedule | None":
        """The schedule with what comes next; None where nothing does."""
        last, t = self.last, self.ground.parameters.sample_time
        before = None if self.stands else last.stride
        order = self.source.order(last.ordinal + 1, before, self._end, self.gait.period)
        if order is None:
            return None if self.stands else self.with_steps(self.steps, stands=True)
        (stride, stand), stop = order, None
        if self.stands:
            stop = Stop.usual(max(in_samples(stand, t), now - last.end), self.durations[1])
        return self.followed(stride, stop)

    def followed(self, stride: Twist, stop: Stop | None, inserted: bool = False) -> "Schedule":
        """The schedule with one more step."""
        one, other = self.steps[-2:]
        step = None if inserted else known_step(self.nominal_steps, (one, other), stride, stop, self.durations)
        step = step or make_step(stride, (one, other), self.gait, self.ground, stop, inserted)
        place = step.beside(self.shift, self.ground.terrain)
        return self.with_steps((*self.steps, step.landing(place.position, place.normal)), stands=False)

    def with_steps(self, steps: tuple[Step, ...], stands: bool | None = None, begin: float | None = None) -> "Schedule":
        """The schedule of other steps; its end in a stand, and what is forgotten, stay unless they are given."""
        stands, begin = self.stands if stands is None else stands, self.begin if begin is None else begin
        phases = phases_since(begin, steps, stands)
        return Schedule(
            self.gait, self.ground, self.source, steps, stands, self.shift, begin, self.nominal_steps, phases
        )

    def until(self, number: int, stands: bool) -> "Schedule":
        """The schedule without the steps after one, with which the robot then stands or not."""
        return self.with_steps(self.steps[: self.index(number) + 1], stands)

    def forgotten(self, clock: float) -> "Schedule":
        """Forget what lies behind an instant, but for the phase of the sample before it."""
        begin = clock - 1.0
        first = next(phase for phase in self.phases if phase.end > begin + CLOCK_ROUNDING)
        if first is self.phases[0]:
            return self
        return self.with_steps(self.steps[max(self.index(first.step - 3), 0) :], begin=begin)

    def reordered(self, now: float, source: StepSource | None = None) -> "Schedule":
        """All steps but the one being swung and the one to which the weight is being shifted are asked for anew.

        A stop is made once its last foot swings: the DCM is on its way to rest between the feet by then, and small feet
        cannot bring it to where the next step would need it. Steps that were inserted stay unless the source is new.

        Args:
            now: [samples].
            source: of the steps from now on; that of those before by default.
        """
        present, *later = self.following(now)
        shifts = present.kind is PhaseKind.DOUBLE and later[0].kind is PhaseKind.SINGLE
        kept = self.until(present.leaves if shifts else present.step, stands=not shifts)
        if present.kind is PhaseKind.SINGLE:
            kept = kept.with_steps(kept.steps, later[1].kind is PhaseKind.STAND)
        if source is not None:
            last = replace(kept.last, ordinal=kept.last.number)
            return replace(kept.with_steps((*kept.steps[:-1], last)), source=source)
        for step in self.after(kept.last.number):
            kept = kept.followed(step.stride, step.stop, inserted=True) if step.inserted else kept
        return kept

    def retimed(self, gait: GaitParameters, now: float) -> "Schedule":
        """All phases to come have the durations of a gait; those that have begun by now keep theirs on the clock."""
        begun, before = self.phase(now).start, self.steps[0]
        steps = [before]
        single, double = durations(gait, self.ground.parameters.sample_time)
        for step in self.steps[1:]:
            if step.lift_off > begun:
                step = step.retimed(before, (single, double), begun, now, self.ground.parameters)
            elif step.touchdown > begun:
                step = step.standing(double, now)
            steps.append(step)
            before = step
        return replace(self.with_steps(tuple(steps)), gait=gait)

    def moved(self, number: int, position: Array) -> "Schedule":
        """A step lands somewhere else, and those after it are shifted by as much.

        Where footholds are not free they stay on the treads that were chosen for them.

        Args:
            number: of the step.
            position: where it lands, in the world frame, shape (3,) [m].
        """
        at, terrain = self.index(number), self.ground.terrain
        step, position = self.steps[at], np.array(position)
        if not terrain.footholds.follow:
            moved = step.landing(position, step.place.normal)
            return self.placed((*self.steps[:at], moved, *self.steps[at + 1 :]), self.shift)
        way, places = position[:2] - step.place.position[:2], self.positions[at:]
        places[0] = position
        places[1:, :2] += way
        places[1:, 2] = terrain.heights(places[1:, :2])
        landings = zip(self.steps[at:], places, terrain.normals(places[:, :2]), strict=True)
        later = (step.landing(place, normal) for step, place, normal in landings)
        return self.placed((*self.steps[:at], *later), self.shift + way)

    def placed(self, steps: tuple[Step, ...], shift: Array) -> "Schedule":
        """The schedule of steps that differ in their places alone, and of a shift; its phases stay."""
        return replace(self, steps=steps, shift=shift)
