"""The gait's clock.

It counts planner samples, as a real number: a phase may last any time. It usually goes on by one from tick to tick,
faster or slower where the walk hurries or slows down within a phase.
"""

from dataclasses import dataclass

import numpy as np

from surefoot.planner.geometry import quintic
from surefoot.planner.types import Array

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

        Where the clock would stand still or go back it takes a length nearer to what it takes at its present rate.
        """
        for _ in range(_TRIES):
            start, end = np.array([[0.0], [rate], [bend]]), np.array([[way], [1.0], [0.0]])
            pace = cls(quintic(start, end, length), length, way)
            if pace.at(np.linspace(0.0, length, 33))[1].min() > _SLOWEST:
                break
            length = 0.5 * (length + way / max(rate, _SLOWEST))
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


_TRIES = 20
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
    """

    def __init__(self, sample_time: float) -> None:
        self.now = -1.0
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

    def advance(self) -> None:
        """Go on by one tick."""
        self.now, _, _ = self.after(1.0)
        self._paced += 1.0
        if self._pace is not None and self._paced >= self._pace.length - CLOCK_ROUNDING:
            self._pace = None
