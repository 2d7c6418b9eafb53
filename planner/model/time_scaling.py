"""Time scaling: how the clock of the gait goes, one sample a tick or, for some time, faster or slower.

The clock counts planner samples, as a real number: a phase may last any time. Where a phase is to end at another time,
the clock follows a quintic to that instant. Then it goes at its own rate again.
"""

from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from surefoot.planner.geometry import plane, quintic
from surefoot.planner.geometry.quintic import Quintic
from surefoot.planner.types import Array

CLOCK_ROUNDING = 1e-9
"""Instants on the clock are sums of durations and are compared with this tolerance [samples]."""

_LENGTHS = tuple(float(1.1 ** (sign * k)) for k in range(16) for sign in (1, -1))[1:]
"""Shares of a length that are tried in its place, up to 4.2 times as long or short [-]."""

_SLOWEST = 0.05
"""Rate of the clock below which no quintic goes: a clock that stands still ends no phase [-]."""

_LOOKED_AT = 33
"""Instants of a quintic at which its rate is looked at: some four for each of its turning points [-]."""

Course = tuple[float, tuple[float, ...]]
"""Time of the clock when it began to follow a quintic [samples], and the coefficients of the quintic."""


@dataclass(frozen=True)
class TimeScaling:
    """The clock, and the quintic that it follows or has followed last.

    Attributes:
        sample_time: length of a sample [s].
        now: what the clock shows [samples], -1 before the first tick.
        ticks: how often it has gone on.
        begun: what it showed when the quintic began [samples].
        elapsed: time since then [samples].
        way: how far it goes on the quintic [samples].
        length: time that this takes [samples].
        coefficients: of the way by time, of 1, t, ..., t^5 [samples, -, 1/samples, ...]; none before the first quintic.
    """

    sample_time: float
    now: float = -1.0
    ticks: int = 0
    begun: float = 0.0
    elapsed: float = 0.0
    way: float = 0.0
    length: float = 0.0
    coefficients: tuple[float, ...] = ()

    @property
    def steady(self) -> bool:
        """True if the clock goes by one sample a tick."""
        return not self.coefficients or self.elapsed >= self.length - CLOCK_ROUNDING

    @property
    def course(self) -> Course:
        """The last quintic, by which two scalings are distinguished; without coefficients of a clock that was set."""
        return self.begun, self.coefficients

    def at(self, ahead: Array) -> tuple[Array, Array, Array]:
        """The clock, its rate and the derivative of that by samples, so many samples from now, shape (n,) each."""
        if self.steady:
            return self.now + ahead, np.ones_like(ahead), np.zeros_like(ahead)
        (a, b, c, d, e, f), found = self.coefficients, np.empty((3, len(ahead)))
        follow((a, b, c, d, e, f), self.length, self.begun, self.elapsed + ahead, found)
        return found[0], found[1], found[2]

    def after(self, samples: float) -> float:
        """Time of the clock so many samples from now [samples]."""
        if self.steady:
            return self.now + samples
        return self.begun + self._at(self.elapsed + samples)[0]

    def until(self, instant: float) -> float:
        """Time until the clock shows an instant that is not within the quintic [samples]."""
        if self.steady:
            return instant - self.now
        return self.length - self.elapsed + instant - self.begun - self.way

    def seconds(self, shown: float, time: float) -> tuple[float, float, float]:
        """The clock in seconds, its rate [-] and the derivative of that [1/s] at a time.

        Args:
            shown: what clock and time show now [s].
            time: the instant [s].
        """
        if self.steady:
            return time, 1.0, 0.0
        t = self.sample_time
        begin = shown - self.elapsed * t
        way, rate, bend = self._at((time - begin) / t)
        return shown + (self.begun - self.now) * t + way * t, rate, bend / t

    def scaled(self, way: float, length: float) -> "TimeScaling":
        """The clock that goes a way in a length of time from now on [samples].

        Where it would stand still or go back it takes the nearest length in which it does not. A clock that is slow and
        slows down may have none: it stops to slow down at once.
        """
        rate, bend = 1.0, 0.0
        if not self.steady:
            _, rate, bend = self._at(self.elapsed)
        for slowing, factor in product((bend, max(bend, 0.0)), _LENGTHS):
            start, end = np.array([[0.0], [rate], [slowing]]), np.array([[way], [1.0], [0.0]])
            lasting = factor * length
            course = tuple(plane.quintic(start, end, lasting)[:, 0].tolist())
            scaling = replace(self, begun=self.now, elapsed=0.0, way=way, length=lasting, coefficients=course)
            if min(scaling._at(time)[1] for time in np.linspace(0.0, lasting, _LOOKED_AT).tolist()) > _SLOWEST:
                break
        return scaling

    def advanced(self) -> "TimeScaling":
        """The clock one tick later."""
        course = self.way, self.length, self.coefficients
        return TimeScaling(self.sample_time, self.after(1.0), self.ticks + 1, self.begun, self.elapsed + 1.0, *course)

    def showing(self, instant: float) -> "TimeScaling":
        """The clock that shows an instant and goes on from there at its own rate [samples]; its course is another."""
        return TimeScaling(self.sample_time, instant, self.ticks, begun=instant)

    def _at(self, time: float) -> tuple[float, float, float]:
        """Way, rate and its derivative at a time since the quintic began [samples]."""
        a, b, c, d, e, f = self.coefficients
        return followed((a, b, c, d, e, f), self.length, time)


def follow(course: Quintic, length: float, begun: float, time: Array, out: Array) -> None:
    """The clock that follows a quintic, and after it goes at its own rate.

    Args:
        course: coefficients of its way.
        length: time that this takes [samples].
        begun: what the clock showed when it began [samples].
        time: since then, shape (n,) [samples].
        out: where the clock, its rate and the derivative of that by samples are written, shape (3, n).
    """
    for k in range(time.shape[0]):
        way, rate, bend = followed(course, length, time[k])
        out[0, k] = begun + way
        out[1, k] = rate
        out[2, k] = bend


def followed(course: Quintic, length: float, time: float) -> tuple[float, float, float]:
    """Way, rate and its derivative at a time since a quintic of a length began; then the clock goes at its own rate."""
    if time > length:
        return quintic.value(course, length) + (time - length), 1.0, 0.0
    t = max(time, 0.0)
    return quintic.value(course, t) + (time - t), quintic.slope(course, t), quintic.bend(course, t)
