"""A stretch of a log as figures see it: whatever cannot be shown is named, never a surprise."""

import json
import math
from collections.abc import Iterator
from copy import copy
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surefoot.planner.geometry.plane import points_seen_from
from surefoot.scenarios.columns import KeptChannel, Reads
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log import Log
from surefoot.scenarios.record.provenance import RECORD

Array = NDArray[np.float64]

DRAWN: Reads = {
    "/truth": (
        *("com", "com_velocity", "left_sole", "right_sole", "external_force"),
        *("torso_tilt", "nonfoot_contact"),
    ),
    "/measurement": ("joint_position", "joint_velocity", "wrench_left", "wrench_right", "external_force"),
    "/estimate": (),
    "/contact": ("zmp", "normal_force", "felt", "cop_left", "cop_right"),
    "/reference": (
        *("com", "zmp", "dcm", "zmp_reference", "omega", "swing_position"),
        *("phase", "stance", "support"),
    ),
    "/plan": ("capture_margin", "jerk", "status", "held"),
    "/footsteps": ("current_left", "current_right", "next", "next_foot"),
    "/footstep": ("planned", "actual", "foot", "index"),
    "/wbc": ("iterations", "solver", "fallback"),
    "/torque": ("command",),
    "/timing": ("tick", "planner", "physics", "wbc_build", "wbc_solve", "state", "log"),
}
"""Topics that the figures draw, and the fields of them that are read in one pass; others cost one each."""

STANCES: Reads = {"/reference": ("stance",), "/footsteps": ("current_left", "current_right")}
"""Fields by which `LogView.from_stance` knows where the feet stand."""

FOOT_NAMES = ("left", "right")
"""Names of the feet, by their numbers."""

LOADED = 0.05
"""Share of the weight from which a foot bears enough for its friction to tell something [-]."""

_GREATEST = 1e9
"""No sound value or time is greater; beyond it axes fail rather than show the rest."""


class MissingError(Exception):
    """A part that a figure needs is missing in the log; the message names it."""


class LogView:
    """Fields of a log within a window of time.

    Attributes:
        log: the log.
        channels: those of it that can be drawn, as far as they were read.
        start: of the window [s].
        end: of the window [s].
    """

    def __init__(self, log: Log, start: float | None = None, end: float | None = None, reads: Reads = DRAWN) -> None:
        """Choose a window, by default all of the log, and read some fields of it.

        Raises:
            LogError: there is nothing to see in the window.
        """
        self.log = log
        asked = [time for time in (start, end) if time is not None]
        self.channels = log.gather(reads, start, end) if all(map(math.isfinite, asked)) else {}
        self._whole = self
        sound = [time for channel in self.channels.values() for time in _ends(channel.time, start, end)]
        if not sound:
            raise LogError(_nothing(log, start, end))
        self.start, self.end = min(sound) if start is None else start, max(sound) if end is None else end

    def within(self, start: float, end: float) -> "LogView":
        """The same in a shorter window [s]; nothing is read for it."""
        part = copy(self)
        part.start, part.end = start, end
        return part

    def parts(self) -> Iterator["LogView"]:
        """The window in parts of at most `Memory.drawn`, one after the other: what is wide is held for a part alone."""
        count = max(math.ceil((self.end - self.start) / self.log.memory.drawn - 1e-9), 1)
        bounds = [self.start, *np.linspace(self.start, self.end, count + 1)[1:-1].tolist(), self.end]
        return (self.within(*between) for between in pairwise(bounds)) if count > 1 else iter((self,))

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
        """A constant that is a positive number; MissingError if the log does not carry it."""
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
        self._channel(topic)
        spec = next((field for field in self.log.fields(topic) if field.name == name), None)
        if spec is None or len(spec.shape) != len(shape):
            raise MissingError(f"{topic} {name}")
        if any(wanted not in (-1, extent) for wanted, extent in zip(shape, spec.shape, strict=True)):
            raise MissingError(f"{topic} {name} of shape {shape}")
        values = np.array(self._channel(topic).field(name)[self._rows(topic)], float)
        values[~(np.abs(values) < _GREATEST)] = np.nan
        return values

    def at(self, topic: str, name: str, times: Array) -> Array:
        """A scalar field interpolated to given times, shape (n,); MissingError if there is no such field."""
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
        clock, feet, planned, poses = self._whole._stances
        foot, rows = feet[rows_at(clock, times)], rows_at(planned, times)
        left, right = (pose[rows] for pose in poses)
        pose = np.select([foot[:, None] == 0, foot[:, None] == 1], [left, right], (left + right) / 2)
        seen = points_seen_from(pose, points)
        seen[1:][np.diff(foot) != 0] = np.nan
        return seen

    @cached_property
    def _stances(self) -> tuple[Array, Array, Array, tuple[Array, Array]]:
        """Times and the foot that bears at each, times of plans and where the feet stand by each, of all that was read.

        Raises:
            MissingError: the log does not tell.
        """
        left, right = (self.field("/footsteps", f"current_{name}", 4) for name in FOOT_NAMES)
        foot = _last_alone(self.field("/reference", "stance"))
        return self.time("/reference"), foot, self.time("/footsteps"), (left, right)

    def _channel(self, topic: str) -> KeptChannel:
        channel = self.channels.get(topic)
        if channel is None:
            raise MissingError(topic)
        return channel

    def _rows(self, topic: str) -> slice:
        """Rows of a topic's messages, which are in order of time, in the window."""
        time = self._channel(topic).time
        rows = slice(*np.searchsorted(time, (self.start, np.nextafter(self.end, math.inf))).tolist())
        if rows.start == rows.stop:
            raise MissingError(f"{topic} in this window")
        return rows


def _ends(time: Array, start: float | None, end: float | None) -> list[float]:
    """First and last of ascending times that are sound and in a window [s], shape (n,); empty without any."""
    least, most = max(start or 0.0, 0.0), _GREATEST if end is None else min(end, _GREATEST)
    inside = time[(time >= least) & (time <= most) & (time < _GREATEST)]
    return [float(inside[0]), float(inside[-1])] if len(inside) else []


def _nothing(log: Log, start: float | None, end: float | None) -> str:
    """Message that a log, or a window of it, holds nothing to draw."""
    drawn = [topic for topic in DRAWN if topic in log.numeric and log.count(topic)]
    if not drawn or (start is None and end is None):
        return f"{log.path}: {_why(log)}; give a log that `surefoot run` has written"
    first, last = log.time_range()
    return f"{log.path}: holds nothing {_window(start, end)}; choose --from and --to within {first:g} to {last:g} s"


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


def _why(log: Log) -> str:
    """Reason why nothing of a log can be drawn."""
    filled = [topic for topic in log.topics if log.count(topic)]
    if not filled:
        return "holds no messages to draw"
    names = ", ".join(filled[:_TOPICS_SAID]) + (", ..." if len(filled) > _TOPICS_SAID else "")
    return f"holds messages of {names}, and none of them is a channel of a run that can be drawn"


def _window(start: float | None, end: float | None) -> str:
    if start is None:
        return f"up to {end:g} s"
    return f"from {start:g} s on" if end is None else f"from {start:g} to {end:g} s"
