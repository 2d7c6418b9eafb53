"""A stretch of a log as figures see it: whatever cannot be shown is named, never a surprise."""

import json
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surefoot.planner.geometry import points_seen_from
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log import ChannelData, Log
from surefoot.scenarios.record.provenance import RECORD

Array = NDArray[np.float64]

DRAWN = (
    *("/truth", "/measurement", "/estimate", "/contact", "/reference", "/plan"),
    *("/footsteps", "/footstep", "/wbc", "/torque", "/timing"),
)
"""Topics that the figures draw."""

FOOT_NAMES = ("left", "right")
"""Of the feet, by their numbers."""

LOADED = 0.05
"""Share of the weight from which a foot bears enough for its friction to tell something [-]."""

_GREATEST = 1e9
"""No sound value or time is greater; beyond it axes fail rather than show the rest."""


class MissingError(Exception):
    """What a figure needs and the log has not got; the message names it."""


class LogView:
    """Fields of a log within a window of time.

    Attributes:
        log: the log.
        start: of the window [s].
        end: of the window [s].
    """

    def __init__(self, log: Log, start: float | None = None, end: float | None = None) -> None:
        """Choose a window, by default all of the log.

        Raises:
            LogError: there is nothing to see in the window.
        """
        self.log = log
        self._channels = _loaded(log)
        times = np.concatenate([np.zeros(0), *(channel.time for channel in self._channels.values())])
        times = times[(times >= 0.0) & (times < _GREATEST)]
        if not len(times):
            raise LogError(f"{log.path}: {_nothing(log)}; give a log that `surefoot run` has written")
        first, last = float(times.min()), float(times.max())
        self.start, self.end = first if start is None else start, last if end is None else end
        if not np.any((times >= self.start) & (times <= self.end)):
            window = _window(start, end)
            raise LogError(f"{log.path}: holds nothing {window}; choose --from and --to within {first:g} to {last:g} s")

    def constant(self, name: str) -> Any:
        """A constant of the run by its name in `RunConstants`; read one by one, for logs of other versions.

        Raises:
            MissingError: the log does not carry it.
        """
        try:
            return json.loads(self.log.metadata[RECORD][name])
        except (KeyError, ValueError, RecursionError):
            raise MissingError(f"{name} of the {RECORD}") from None

    def number(self, name: str) -> float:
        """A constant that is a positive number; errors as of `constant`."""
        value = self.constant(name)
        if not isinstance(value, int | float) or not 0.0 < value < _GREATEST:
            raise MissingError(f"{name} of the {RECORD}")
        return float(value)

    def time(self, topic: str) -> Array:
        """Times of a topic's messages in the window, shape (n,) [s].

        Raises:
            MissingError: it has none.
        """
        return np.asarray(self._channel(topic).time[self._rows(topic)])

    def field(self, topic: str, name: str, *shape: int) -> Array:
        """Values of a field in the window, shape (n, *shape), -1 for any extent; what is no number or absurd is NaN.

        Raises:
            MissingError: there is no such field of that shape, or no message of it.
        """
        spec = next((field for field in self._channel(topic).fields if field.name == name), None)
        if spec is None or len(spec.shape) != len(shape):
            raise MissingError(f"{topic} {name}")
        if any(wanted not in (-1, extent) for wanted, extent in zip(shape, spec.shape, strict=True)):
            raise MissingError(f"{topic} {name} of shape {shape}")
        values = self._channel(topic).field(name)[self._rows(topic)].astype(float)
        return np.asarray(np.where(np.abs(values) < _GREATEST, values, np.nan))

    def at(self, topic: str, name: str, times: Array) -> Array:
        """A scalar field interpolated to given times, shape (n,); errors as of `field`."""
        return np.asarray(np.interp(times, self.time(topic), self.field(topic, name)))

    def from_stance(self, times: Array, points: Array) -> Array:
        """Points of the ground plane seen from the stance foot, so that a walk of any length can be read.

        In double support it is still the foot that bore alone before; in a stand it is the middle of both.

        Args:
            times: of the points, shape (n,) [s].
            points: in the world, shape (n, 2) [m].

        Returns:
            forward and to the left of the planned sole's centre, NaN where the stance foot has just changed, so that
            curves break there, shape (n, 2) [m].

        Raises:
            MissingError: the log does not tell where the feet stand.
        """
        clock, planned = self.time("/reference"), self.time("/footsteps")
        foot = _last_alone(self.field("/reference", "stance"))[rows_at(clock, times)]
        rows = rows_at(planned, times)
        left, right = (self.field("/footsteps", f"current_{name}", 4)[rows] for name in FOOT_NAMES)
        pose = np.select([foot[:, None] == 0, foot[:, None] == 1], [left, right], (left + right) / 2)
        seen = points_seen_from(pose, points)
        seen[1:][np.diff(foot) != 0] = np.nan
        return seen

    def _channel(self, topic: str) -> ChannelData:
        channel = self._channels.get(topic)
        if channel is None:
            raise MissingError(topic)
        return channel

    def _rows(self, topic: str) -> NDArray[Any]:
        time = self._channel(topic).time
        rows = np.flatnonzero((time >= self.start) & (time <= self.end))
        if not len(rows):
            raise MissingError(f"{topic} in this window")
        return rows


def rows_at(clock: Array, times: Array) -> NDArray[np.intp]:
    """Row of a clock that holds at each time, the first one before it begins, shape (n,)."""
    return np.asarray(np.maximum(np.searchsorted(clock, times + 1e-9, side="right") - 1, 0))


def _last_alone(stance: Array) -> Array:
    """The stance foot, in double support the one before, at first the one to come; -1 without any, shape (n,)."""
    rows = np.where(stance >= 0, np.arange(len(stance)), -1)
    if not (stance >= 0).any():
        return np.full(len(stance), -1.0)
    rows = np.maximum.accumulate(rows)
    return np.asarray(stance[np.where(rows >= 0, rows, int(np.argmax(stance >= 0)))])


_TOPICS_SAID = 5


def _nothing(log: Log) -> str:
    """Why nothing of a log can be drawn."""
    filled = [topic for topic in log.topics if log.count(topic)]
    if not filled:
        return "holds no messages to draw"
    names = ", ".join(filled[:_TOPICS_SAID]) + (", ..." if len(filled) > _TOPICS_SAID else "")
    return f"holds messages of {names}, and none of them is a channel of a run that can be drawn"


def _window(start: float | None, end: float | None) -> str:
    if start is None:
        return f"up to {end:g} s"
    return f"from {start:g} s on" if end is None else f"from {start:g} to {end:g} s"


def _loaded(log: Log) -> dict[str, ChannelData]:
    """The drawn channels that the log has in a layout of ours; in one pass if it can be."""
    present = [topic for topic in DRAWN if topic in log]
    try:
        log.load(*present)
    except LogError:
        present = [topic for topic in present if _readable(log, topic)]
    return {topic: log[topic] for topic in present}


def _readable(log: Log, topic: str) -> bool:
    try:
        log.load(topic)
    except LogError:
        return False
    return True
