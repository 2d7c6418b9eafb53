"""Support phases of the steps in sight, and what follows from them at the samples of a window."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from surefoot.maths import algebra
from surefoot.planner.model.time_scaling import CLOCK_ROUNDING
from surefoot.planner.steps.step import Step
from surefoot.planner.swing.rolling import RollSpan
from surefoot.planner.types import Array, Foot, PhaseKind

_DOUBLE = int(PhaseKind.DOUBLE)
_LEFT, _RIGHT = Foot.LEFT, Foot.RIGHT


@dataclass(frozen=True)
class Phase:
    """One support phase; it covers the clock from `start` to `end`.

    Attributes:
        kind: stand, double or single support.
        start: when it begins [samples].
        samples: how long it lasts, infinite for standing of which no end is known [samples].
        step: number of the step that this phase swings (single support) or has just landed (otherwise); 0 before.
        stance: the only supporting foot of a single support, otherwise None.
        support: support point on which the ZMP reference stands, or which it leaves.
        rest: part of a double support before it leaves [samples].
        rolls: of the foot that leaves the ground in it or after it, and of that which lands in it or before it; of a
            foot that leaves the ground after its end, if it rolls before that.
        starts: whether it is a double support that begins with the robot at rest.
    """

    kind: PhaseKind
    start: float
    samples: float
    step: int
    stance: Foot | None
    support: int
    rest: float = 0.0
    rolls: tuple[RollSpan, ...] = ()
    starts: bool = False

    @property
    def end(self) -> float:
        """End of the phase."""
        return self.start + self.samples

    @property
    def swing_foot(self) -> Foot | None:
        """The swinging foot of a single support, otherwise None."""
        return None if self.stance is None else self.stance.other

    @property
    def leaves(self) -> int:
        """Number of the step whose foot swings, or leaves the ground next; the other foot stands where it landed."""
        return self.step + (self.kind is not PhaseKind.SINGLE)

    def edges(self, clock: float) -> tuple[int, int]:
        """Edges on which the left and the right foot stand at an instant [samples], as `Edge` has them."""
        found = [0, 0]
        for roll in self.rolls:
            if roll.foot is not self.swing_foot and roll.start < clock < roll.end:
                found[roll.foot] = int(roll.edge)
        return found[0], found[1]


def phases_of(steps: Sequence[Step], stands: bool) -> tuple[Phase, ...]:
    """The phases of steps in turn: a single and a double support each, and before some of them a stop.

    Args:
        steps: in order; a stop before the first of them is left out.
        stands: whether the robot stands after the last one.
    """
    phases: list[Phase] = []
    for step, following in pairwise((*steps, None)):
        if step is None:
            continue
        stop = None if following is None else following.stop
        leaving = None if following is None else following.toe_off
        if step.number >= 1:
            stance = step.place.foot.other
            single, double = step.single_support, step.double_support
            number, point = step.number, step.support
            # A heel that leaves as the other one lands does so between two ticks; it may leave before that, too.
            early = leaving is not None and (step.heel_strike is not None or leaving.start < step.touchdown)
            swung = _rolls(step.toe_off, step.heel_strike, leaving if stop is None and early else None)
            swing = Phase(PhaseKind.SINGLE, step.lift_off, single, number, stance, point, rolls=swung)
            stood = _rolls(step.heel_strike, leaving if stop is None else None)
            after = Phase(PhaseKind.DOUBLE, step.touchdown, double, number, None, point, rolls=stood)
            phases += [swing, after]
        between = step.support + 1
        if stop is not None:
            if stop.stand:
                phases.append(Phase(PhaseKind.STAND, step.end, stop.stand, step.number, None, between))
            start = step.end + stop.stand
            shift, rolls = stop.shift, _rolls(leaving)
            phases.append(Phase(PhaseKind.DOUBLE, start, shift, step.number, None, between, stop.rest, rolls, True))
        elif following is None and stands:
            phases.append(Phase(PhaseKind.STAND, step.end, np.inf, step.number, None, between))
    return tuple(phases)


def _rolls(*spans: RollSpan | None) -> tuple[RollSpan, ...]:
    """Rolls of a phase, of steps each of which may have none."""
    return tuple([span for span in spans if span is not None])


def phases_since(begin: float, steps: Sequence[Step], stands: bool) -> tuple[Phase, ...]:
    """The phases that are not over at an instant of the clock [samples]."""
    return tuple([phase for phase in phases_of(steps, stands) if phase.end > begin + CLOCK_ROUNDING])


@dataclass(frozen=True)
class PhaseTable:
    """Phases in order, without gaps, as columns of n rows.

    Attributes:
        phases: themselves.
        kind: shape (n,).
        start: shape (n,) [samples].
        length: shape (n,) [samples].
        rest: part of each before its ZMP reference moves, shape (n,) [samples].
        support: support point on which that rests, or which it leaves, shape (n,).
        contacts: planned contacts (left, right), shape (n, 2).
    """

    phases: tuple[Phase, ...]
    kind: NDArray[np.intp]
    start: Array
    length: Array
    rest: Array
    support: NDArray[np.intp]
    contacts: NDArray[np.bool_]

    @classmethod
    def of(cls, phases: tuple[Phase, ...]) -> "PhaseTable":
        """The table of some phases."""
        n = len(phases)
        (kind, support), (start, length, rest) = np.empty((2, n), dtype=np.intp), np.empty((3, n))
        contacts = np.empty((n, 2), dtype=np.uint8)
        _tabulate(phases, kind, support, start, length, rest, contacts)
        return cls(phases, kind, start, length, rest, support, contacts.view(np.bool_))


def _tabulate(
    phases: tuple[Phase, ...],
    kind: NDArray[np.intp],
    support: NDArray[np.intp],
    start: Array,
    length: Array,
    rest: Array,
    contacts: NDArray[np.uint8],
) -> None:
    """Write the columns of a `PhaseTable`."""
    for k in range(len(phases)):
        phase = phases[k]
        kind[k], support[k] = phase.kind, phase.support
        start[k], length[k], rest[k] = phase.start, phase.samples, phase.rest
        contacts[k, 0], contacts[k, 1] = phase.stance is not _RIGHT, phase.stance is not _LEFT


class PhaseSamples:
    """The phases at the n samples of a window.

    The ZMP reference moves along the polyline of the support points (`Schedule.supports`): a point between the feet
    before each bout and at the end, and the stance foot of each step. At sample k it is `fraction[k]` of the
    way from point `index[k]` to the next. It rests while the robot stands, and on the stance foot in single
    support; in every double support it goes on to exactly the next point.

    Args:
        table: the phases in sight.
        clock, sample_time, first, rate: see the attributes.

    Attributes:
        phases: those in sight, in order, without gaps.
        which: index into `phases`, shape (n,).
        kind: support phase, shape (n,).
        clock: shape (n,) [samples].
        rate: of the clock over that of time, shape (n,) [-], and its rate, shape (n,) [1/s]; None for one and zero.
        elapsed: clock since the phase began, shape (n,) [samples].
        length: of the phase, shape (n,) [samples].
        index: support point that the ZMP reference leaves, counted from `first`, shape (n,).
        fraction: share of the way to the next support point, shape (n,), in [0, 1).
        fraction_rate: rate of that share on the clock, within the phase's ramp, shape (n,) [1/s].
        contacts: planned contacts (left, right), shape (n, 2).
        sample_time: length of a sample [s].
        first: support point of the walk from which `index` counts.
    """

    def __init__(
        self,
        table: PhaseTable,
        clock: Array,
        sample_time: float,
        first: int = 0,
        rate: tuple[Array, Array] | None = None,
    ) -> None:
        n = len(clock)
        self.phases = table.phases
        self.clock = clock
        self.sample_time = sample_time
        self.first = first
        self.rate = rate
        self.which, self.kind, self.index = np.empty(n, np.intp), np.empty(n, np.intp), np.empty(n, np.intp)
        self.elapsed, self.length = np.empty(n), np.empty(n)
        self.fraction, self.fraction_rate = np.empty(n), np.empty(n)
        self._look_up(table.start, clock, self.which)
        self._measure(self.which, clock, table.start, table.length, table.rest, table.kind, table.support)
        self.contacts = table.contacts.take(self.which, axis=0)

    def _look_up(self, start: Array, clock: Array, which: NDArray[np.intp]) -> None:
        """The phase at each sample, the first one before it."""
        here, last = 0, start.shape[0] - 1
        for k in range(clock.shape[0]):
            while here > 0 and start[here] > clock[k] + CLOCK_ROUNDING:
                here -= 1
            while here < last and start[here + 1] <= clock[k] + CLOCK_ROUNDING:
                here += 1
            which[k] = here

    def _measure(
        self,
        which: NDArray[np.intp],
        clock: Array,
        start: Array,
        length: Array,
        rest: Array,
        kind: NDArray[np.intp],
        support: NDArray[np.intp],
    ) -> None:
        """Measure the place of each sample in its phase, and on the way of the ZMP reference."""
        elapsed, fraction, fraction_rate = self.elapsed, self.fraction, self.fraction_rate
        lengths, kinds, index = self.length, self.kind, self.index
        for k in range(clock.shape[0]):
            phase = which[k]
            ramp = length[phase] - rest[phase] if kind[phase] == _DOUBLE else algebra.INFINITY
            elapsed[k] = max(0.0, clock[k] - start[phase])
            gone = elapsed[k] - rest[phase]
            fraction[k] = max(0.0, gone / ramp)
            fraction_rate[k] = 1.0 / (ramp * self.sample_time) if gone >= 0.0 else 0.0
            lengths[k], kinds[k], index[k] = length[phase], kind[phase], support[phase] - self.first

    def per_phase(self, values: Sequence[float]) -> Array:
        """Values of the kinds of phases at each sample, shape (n,)."""
        return np.array(values, dtype=np.float64)[self.kind]
