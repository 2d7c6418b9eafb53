"""A check of the pushes that a plant was asked for: their impulse as asked against that which the log shows."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surefoot.scenarios.columns import Reads
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.judge.digest import Array, Mask, RunView
from surefoot.scenarios.record.provenance import AskedPush, asked_pushes

READS: Reads = {"/measurement": ("external_force",), "/truth": ("external_force",)}
"""The force that acted; ``/truth`` has that of the pendulum."""

SHARE = 0.01
"""Share of its impulse by which a push may be off [-]: a plant with steps of 1 ms misses one of 0.1 s by that."""

ROUNDING = 1e-8
"""Time by which its begin and its end are rounded on the clock of the physics [s]."""

LATE = 0.1
"""Longest delay of a push over a line between two processes [s]: by then the joints are damped."""

_EVER = 2.0**62
"""A time after every run, and the one before all of them, if negative [ns]."""

_NOTHING = 1e-9
"""Share of a tick, and of the sum of the forces' sizes, below which there is nothing [-]."""


@dataclass(frozen=True, slots=True)
class _Acted:
    """The forces that acted in the ticks of a log, with a message each.

    Attributes:
        stamps: of the messages, shape (n,) [ns].
        force: mean of the external one over each tick, NaN where it was not measured, shape (n, 3) [N].
        period: of a tick [s].
        before: from the begin of a tick to its message [s].
        late: how much later than asked a push may act [s].
    """

    stamps: NDArray[np.int64]
    force: Array
    period: float
    before: float
    late: float

    @classmethod
    def of(cls, run: RunView) -> "_Acted | None":
        """The ticks of a run: in full physics they end at a message, of a pendulum they begin at one."""
        topic, period = "/measurement" if run.has("/measurement") else "/truth", 1.0 / run.constants.control_rate
        try:
            stamps, force = run.log[topic].time_ns, run.log[topic].field("external_force")
        except (KeyError, LogError):
            return None
        if force.shape != (len(stamps), 3) or not len(stamps):
            return None
        before = period if topic == "/measurement" else 0.0
        return cls(stamps, force, period, before, LATE if run.has("/link") else period)

    @property
    def end(self) -> float:
        """Until when the log tells what acted [s]."""
        return 1e-9 * int(self.stamps[-1]) - self.before + self.period

    def rows(self, begin: float, end: float) -> slice:
        """The ticks that have a part in a time [s]."""
        times = begin - (1.0 - _NOTHING) * self.period, end - _NOTHING * self.period
        # Of whole numbers, for which no other array is made of the stamps.
        ends = np.array([min(max(1e9 * (time + self.before), -_EVER), _EVER) for time in times], self.stamps.dtype)
        first, last = np.searchsorted(self.stamps, ends)
        return slice(int(first), int(last))

    def begin(self, rows: slice) -> Array:
        """Begin of ticks, shape (k,) [s]."""
        return np.asarray(1e-9 * self.stamps[rows] - self.before)

    def episodes(self, pushes: Sequence[AskedPush]) -> Iterator["_Episode"]:
        """The pushes, in order of time, by what can be distinguished: with a tick before and some time after."""
        while pushes:
            until, count = -np.inf, 0
            for push in pushes:
                if count and push.time - self.period > until:
                    break
                until, count = max(until, push.time + push.duration + self.late), count + 1
            yield _Episode(pushes[:count], self, self.rows(pushes[0].time - self.period, until))
            pushes = pushes[count:]


class _Episode:
    """Pushes that act at once, or one after the other without a pause.

    Args:
        pushes: that were asked for.
        acted: in the whole log.
        rows: its ticks at which they were to act, or might.
    """

    def __init__(self, pushes: Sequence[AskedPush], acted: _Acted, rows: slice) -> None:
        self._pushes, self._all, self._begin = pushes, acted, acted.begin(rows)
        self._acted, self._asked = acted.force[rows] * acted.period, np.zeros((len(self._begin), 3))
        most = np.zeros(len(self._begin))
        for push in pushes:
            lasts = self._covered(push)
            self._asked += lasts[:, None] * push.force
            most += lasts * float(np.linalg.norm(push.force))
        self._size = np.linalg.norm(self._asked, axis=1)
        # Pushes of opposite directions at once are nothing, but for rounding.
        self._on: Mask = self._size > _NOTHING * most

    def _covered(self, push: AskedPush) -> Array:
        """Time for which it was to act in each tick, shape (n,) [s]."""
        begin, period = self._begin, self._all.period
        lasts = np.minimum(begin + period, push.time + push.duration) - np.maximum(begin, push.time)
        return np.where(lasts > _NOTHING * period, lasts, 0.0)

    def unacted(self) -> Iterator[str]:
        """Report the part of it that did not act."""
        yield from self._unseen()
        if self._on.any():
            yield from self._off()

    def _unseen(self) -> Iterator[str]:
        """Promised pushes of which the log can show nothing."""
        acted = self._all
        for push in self._pushes:
            covered = self._covered(push) > 0.0
            if push.live or self._on[covered].any() or push.time >= acted.end + acted.period:
                continue  # of one that was to begin after the end the agenda tells
            if covered.any():
                yield f"{_named([push])} cannot be shown to have acted: the sum of forces was to be zero all the while"
            else:
                yield f"{_named([push])} cannot be shown to have acted: the log has no tick of that time"

    def _off(self) -> Iterator[str]:
        """Report it where the impulse is not what was asked for."""
        pushes, on = self._pushes, self._on
        asked, acted = self._asked, self._acted
        if np.isnan(acted).any():
            yield f"{_named(pushes)} cannot be shown to have acted: the plant does not measure the external force"
            return
        # Each tick counts along what was asked of it then, so that pushes that turn do not make up for one another.
        nearest = np.maximum.accumulate(np.where(on, np.arange(len(on)), int(np.argmax(on))))
        along = asked[nearest] / self._size[nearest, None]
        whole, part = float(self._size[on].sum()), float(np.einsum("ij,ij->", acted, along))
        aside = float(np.linalg.norm((acted - asked).sum(axis=0)))
        allowed = SHARE * whole + ROUNDING * max(float(np.linalg.norm(push.force)) for push in pushes)
        if abs(part - whole) <= allowed and aside <= allowed:
            return
        if len(self._begin) > 1 and np.diff(self._begin).max() > 1.5 * self._all.period:
            yield f"{_named(pushes)} cannot be shown to have acted: ticks of that time are not in the log"
            return
        beside = f", and {aside:.3g} N·s in another direction" if abs(part - whole) <= allowed else ""
        yield f"{part:.3g} of {whole:.3g} N·s acted of {_named(pushes)}{beside}"


def unacted_pushes(run: RunView) -> Iterator[str]:
    """Report pushes that did not act as the plant was asked for them.

    Only what the log shows is compared: the ticks that have a message. A promised push of which none of them shows
    anything is no test.

    Raises:
        LogError: what the log tells of its pushes cannot be read.
    """
    pushes = asked_pushes(run.log.metadata, str(run.log.path))
    if not pushes or not run.has("/truth"):
        return
    acted = _Acted.of(run)
    if acted is None:
        yield f"{_named(pushes)} cannot be shown to have acted: the log has no external force"
        return
    with np.errstate(invalid="ignore", over="ignore", divide="ignore"):
        for episode in acted.episodes(pushes):
            yield from episode.unacted()


def _named(pushes: Sequence[AskedPush]) -> str:
    """Pushes in words."""
    if len(pushes) == 1:
        return f"the push at {pushes[0].time:.6g} s"
    return f"the {len(pushes)} pushes from {pushes[0].time:.6g} s on"
