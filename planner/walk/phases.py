"""The gait's clock, support phases on it, and what follows from them at the samples of a window.

The clock counts planner samples, as a real number: a phase may last any time. It usually goes on by one from tick to
tick, faster or slower where the walk hurries or slows down within a phase.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surefoot.planner.geometry import quintic
from surefoot.planner.types import Array, Foot, PhaseKind

CLOCK_ROUNDING = 1e-9
"""Instants on the clock are sums of durations and are compared with this tolerance [samples]."""


@dataclass(frozen=True, slots=True)
class Flow:
    """How the clock goes over a window; it goes by itself where it is not told otherwise.

    Attributes:
        clock: at each sample, shape (n,) [samples].
        rate: of the clock over that of time, shape (n,) [-], and its rate, shape (n,) [1/s]; None for one and zero.
    """

    clock: Array
    rate: tuple[Array, Array] | None = None


@dataclass(frozen=True, slots=True)
class Pace:
    """The clock while it hurries or slows down: a quintic from how it goes to its own rate at the end of a phase.

    Attributes:
        coefficients: of its way, shape (6, 1) [samples].
        length: time that it takes [samples].
        way: how far the clock goes meanwhile [samples].
    """

    coefficients: Array
    length: float
    way: float

    @classmethod
    def over(cls, way: float, length: float, rate: float, bend: float) -> "Pace":
        """A way of the clock in a length of time, from a rate [-] and its derivative [1/sample] on.

        Where the clock would stand still or go back it takes the nearest length in which it does not. A clock that is
        slow and slows down may have none: it stops to slow down at once.
        """
        for slowing, factor in product((bend, max(bend, 0.0)), _LENGTHS):
            start, end = np.array([[0.0], [rate], [slowing]]), np.array([[way], [1.0], [0.0]])
            pace = cls(quintic(start, end, factor * length), factor * length, way)
            if pace.at(np.linspace(0.0, pace.length, 33))[1].min() > _SLOWEST:
                break
        return pace

    def at(self, time: Array) -> tuple[Array, Array, Array]:
        """Way, rate and its derivative at times since it began, shape (n,) each; after it the clock goes by itself."""
        inside = np.clip(time, 0.0, self.length)
        powers = inside[:, None] ** np.arange(6)
        way, rate, bend = (powers[:, : 6 - k] @ c for k, c in enumerate(_derivatives(self.coefficients[:, 0])))
        over = time > self.length
        return way + (time - inside), np.where(over, 1.0, rate), np.where(over, 0.0, bend)


@dataclass(frozen=True, slots=True)
class Hurry:
    """A pace on the axis of time.

    Attributes:
        pace: how the clock goes.
        begin: when it began [s].
        clock: what the clock showed then [s].
        sample_time: length of a sample [s].
    """

    pace: Pace
    begin: float
    clock: float
    sample_time: float

    def at(self, time: float) -> tuple[float, float, float]:
        """What the clock shows [s], its rate [-] and the derivative of that [1/s]."""
        t = self.sample_time
        way, rate, bend = (float(value[0]) for value in self.pace.at(np.array([(time - self.begin) / t])))
        return self.clock + way * t, rate, bend / t


_LENGTHS = tuple(float(1.1 ** (sign * k)) for k in range(16) for sign in (1, -1))[1:]
"""Shares of a length that are tried in its place [-]."""

_SLOWEST = 0.05
"""Rate of the clock below which no pace goes [-]."""


def _derivatives(coefficients: Array) -> tuple[Array, Array, Array]:
    order = np.arange(1.0, 6.0)
    first = coefficients[1:] * order
    return coefficients, first, first[1:] * order[:-1]


class Clock:
    """What the clock shows, and how it goes on.

    Args:
        sample_time: length of a sample [s].

    Attributes:
        now: what it shows [samples], -1 before the first tick.
        ticks: how often it has gone on.
        taken: how often it has been told to go at another pace.
    """

    def __init__(self, sample_time: float) -> None:
        self.now = -1.0
        self.ticks = self.taken = 0
        self._sample_time = sample_time
        self._pace: Pace | None = None
        self._began = 0.0
        self._paced = 0.0

    @property
    def steady(self) -> bool:
        """Whether it goes by itself, and every sample is one on."""
        return self._pace is None

    def after(self, samples: float) -> tuple[float, float, float]:
        """What it shows so many samples from now, its rate and the derivative of that by samples."""
        if self._pace is None:
            return self.now + samples, 1.0, 0.0
        way, rate, bend = (float(value[0]) for value in self._pace.at(np.array([self._paced + samples])))
        return self._began + way, rate, bend

    def until(self, instant: float) -> float:
        """Time until it shows an instant that no pace goes beyond [samples]."""
        if self._pace is None:
            return instant - self.now
        return self._pace.length - self._paced + instant - self._began - self._pace.way

    def flow(self, ahead: Array) -> Flow:
        """How it goes at samples from now on, shape (n,)."""
        if self._pace is None:
            return Flow(np.maximum(self.now + ahead, 0.0))
        way, rate, bend = self._pace.at(self._paced + ahead)
        return Flow(self._began + way, (rate, bend / self._sample_time))

    def hurry(self, time: float) -> Hurry | None:
        """How it goes, which shows a time [s] now; None while it goes by itself."""
        if self._pace is None:
            return None
        t = self._sample_time
        return Hurry(self._pace, time - self._paced * t, time + (self._began - self.now) * t, t)

    def take(self, way: float, length: float) -> None:
        """Go a way in a length of time from now on, as far as `Pace.over` lets it [samples]."""
        _, rate, bend = self.after(0.0)
        self._pace, self._began, self._paced = Pace.over(way, length, rate, bend), self.now, 0.0
        self.taken += 1

    def advance(self) -> None:
        """Go on by one tick."""
        self.now, _, _ = self.after(1.0)
        self.ticks += 1
        self._paced += 1.0
        if self._pace is not None and self._paced >= self._pace.length - CLOCK_ROUNDING:
            self._pace = None


class RollSpan(NamedTuple):
    """When a foot rolls about its toe edge, and how far (see `planner.swing.heel_off`).

    Attributes:
        start: when it begins to [samples].
        end: when it is level again [samples].
        angle: its greatest pitch [rad].
    """

    start: float
    end: float
    angle: float


@dataclass(frozen=True, slots=True)
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
        roll: of the foot that leaves the ground in it or after it; None for one that stays level.
    """

    kind: PhaseKind
    start: float
    samples: float
    step: int
    stance: Foot | None
    support: int
    rest: float = 0.0
    roll: RollSpan | None = None

    @property
    def end(self) -> float:
        """When it is over."""
        return self.start + self.samples

    @property
    def row(self) -> int:
        """Row of a footstep plan whose foot stands; the other foot goes from the row before to the row after."""
        return self.step + (self.kind is not PhaseKind.SINGLE)


@dataclass(frozen=True, slots=True)
class PhaseSamples:
    """The phases at the n samples of a window.

    The ZMP reference moves along the polyline of the support points (`FootstepPlan.supports`): a point between the feet
    before each bout and at the end, and the stance foot of each step. At sample k it is `fraction[k]` of the
    way from point `index[k]` to the next. It rests while the robot stands, and on the stance foot in single
    support; in every double support it goes on to exactly the next point.

    Attributes:
        phases: those in sight, in order, without gaps.
        which: index into `phases`, shape (n,).
        kind: support phase, shape (n,).
        elapsed: clock since the phase began, shape (n,) [samples].
        length: of the phase, shape (n,) [samples].
        index: support point that the ZMP reference leaves, counted from `first`, shape (n,).
        fraction: share of the way to the next support point, shape (n,), in [0, 1).
        fraction_rate: rate of that share on the clock, within the phase's ramp, shape (n,) [1/s].
        contacts: planned contacts (left, right), shape (n, 2).
        sample_time: length of a sample [s].
        first: support point of the walk from which `index` counts.
        flow: how the clock goes.
    """

    phases: tuple[Phase, ...]
    which: NDArray[np.intp]
    kind: NDArray[np.intp]
    elapsed: Array
    length: Array
    index: NDArray[np.intp]
    fraction: Array
    fraction_rate: Array
    contacts: NDArray[np.bool_]
    sample_time: float
    first: int
    flow: Flow

    @classmethod
    def of(cls, phases: Sequence[Phase], flow: Flow, sample_time: float, first: int) -> "PhaseSamples":
        """The phases in sight where the clock goes over a window, counting support points from `first`."""
        which = np.searchsorted([p.start for p in phases], flow.clock + CLOCK_ROUNDING, side="right") - 1
        which = np.maximum(which, 0)
        contacts = np.array([(p.stance is not Foot.RIGHT, p.stance is not Foot.LEFT) for p in phases])
        columns = ([getattr(p, name) for p in phases] for name in ("kind", "start", "samples", "rest", "support"))
        kind, start, length, rest, support = (np.array(column)[which] for column in columns)
        elapsed = np.maximum(flow.clock - start, 0.0)
        ramp = np.where(kind == PhaseKind.DOUBLE, length - rest, np.inf)
        gone = elapsed - rest
        return cls(
            phases=tuple(phases),
            which=which,
            kind=kind,
            elapsed=elapsed,
            length=length,
            index=support - first,
            fraction=np.maximum(gone / ramp, 0.0),
            fraction_rate=np.where(gone >= 0.0, 1.0 / (ramp * sample_time), 0.0),
            contacts=contacts[which],
            sample_time=sample_time,
            first=first,
            flow=flow,
        )

    @property
    def last_stand(self) -> NDArray[np.bool_]:
        """Where the robot stands and no end of it is known, shape (n,)."""
        return np.isinf(self.length)

    def per_phase(self, values: Sequence[float]) -> Array:
        """Values of the kinds of phases at each sample, shape (n,)."""
        return np.array(values, dtype=np.float64)[self.kind]

    def in_time(self, values: Array) -> Array:
        """Values with their first and second derivatives by the clock, shape (3, n), turned into those by time."""
        if self.flow.rate is None:
            return values
        rate, bend = self.flow.rate
        return np.stack((values[0], values[1] * rate, values[2] * rate**2 + values[1] * bend))
