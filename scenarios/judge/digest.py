"""A log as metrics and health checks see it: gathered in one pass with bounded memory, on common control ticks."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from surefoot.scenarios.judge.body import headings, knees
from surefoot.scenarios.judge.columns import Columns
from surefoot.scenarios.record.provenance import RunConstants

if TYPE_CHECKING:
    from surefoot.scenarios.log import ChannelData, Log

Reads = Mapping[str, tuple[str, ...]]
"""Names of fields by topic."""

CONTROL_TOPICS = ("/measurement", "/truth", "/estimate", "/contact", "/reference", "/wbc", "/torque", "/timing")
"""Topics with a message in every control tick."""

HELD: Reads = {
    **dict.fromkeys((*CONTROL_TOPICS, "/planner_state", "/plan", "/footstep"), ()),
    "/truth": ("left_sole", "right_sole"),
    "/reference": ("phase",),
}
"""Topics whose times every digest holds, and the fields that `RunView` itself reads."""


TIME = "time_ns"
"""Key of the times of a topic's messages, among those of its fields."""


class Channel(Protocol):
    """Messages of a topic."""

    @property
    def time_ns(self) -> NDArray[np.int64]:
        """Simulated time of each, shape (n,) [ns]."""
        ...

    @property
    def time(self) -> NDArray[np.float64]:
        """Simulated time of each, shape (n,) [s]."""
        ...

    def __len__(self) -> int: ...

    def field(self, name: str) -> NDArray[Any]:
        """Values of a field, shape (n, *field shape)."""
        ...


class Source(Protocol):
    """A log, a part of one, or what was kept of one."""

    @property
    def path(self) -> Path:
        """Where the log is."""
        ...

    @property
    def size(self) -> int:
        """Of the log [bytes]."""
        ...

    @property
    def metadata(self) -> Mapping[str, Mapping[str, str]]:
        """Of the log."""
        ...

    def __contains__(self, topic: str) -> bool: ...

    def __getitem__(self, topic: str) -> Channel: ...


class Window:
    """A part of a log."""

    def __init__(self, log: "Log", channels: Mapping[str, Channel]) -> None:
        self.path, self.size, self.metadata = log.path, log.size, log.metadata
        self._channels = channels

    def __contains__(self, topic: str) -> bool:
        return topic in self._channels

    def __getitem__(self, topic: str) -> Channel:
        return self._channels[topic]


class KeptChannel:
    """Fields of a channel over the whole run; one that was not kept is read from the log when it is asked for."""

    def __init__(self, log: "Log", topic: str, columns: Columns) -> None:
        self._log, self._topic = log, topic
        self._columns = columns

    def __len__(self) -> int:
        return self._columns.rows((self._topic, TIME))

    @property
    def time_ns(self) -> NDArray[np.int64]:
        """Simulated time of each message, shape (n,) [ns]."""
        return self._columns[self._topic, TIME]

    @property
    def time(self) -> NDArray[np.float64]:
        """Simulated time of each message, shape (n,) [s]."""
        return np.asarray(self.time_ns / 1e9)

    def field(self, name: str) -> NDArray[Any]:
        """Values of one field, shape (n, *field shape)."""
        kept = (self._topic, name)
        return self._columns[kept] if kept in self._columns else self._log[self._topic].field(name)


Reduce = Callable[[Source], Mapping[Any, NDArray[Any]]]
"""Reduces a part of a log to narrow arrays by key, in order of time."""


class Digest:
    """What was kept of a log; stands for it where metrics are computed.

    Attributes:
        path: of the log.
        size: of the log [bytes].
        metadata: of the log.
        reduced: what `reduce` gave, over the whole run.
    """

    def __init__(self, log: "Log", reads: Iterable[Reads], reduce: Reduce) -> None:
        """Go through the log once; its damage is then known.

        Args:
            log: a log.
            reads: fields that are held for the whole run; wider ones are reduced tick by tick.
            reduce: is applied to every part.
        """
        self.path, self.size, self.metadata = log.path, log.size, log.metadata
        held = _united((HELD, *reads))
        topics = [topic for topic in held if topic in log.numeric]
        kept, self.reduced = Columns(), Columns()
        for channels in _in_step(log.windows(topics)):
            for topic, channel in channels.items():
                kept.add((topic, TIME), channel.time_ns)
                for name in held[topic]:
                    if any(field.name == name for field in channel.fields):
                        kept.add((topic, name), channel.field(name))
            for key, values in reduce(Window(log, channels)).items():
                self.reduced.add(key, values)
        self._channels = {topic: KeptChannel(log, topic, kept) for topic in topics}

    def __contains__(self, topic: str) -> bool:
        return topic in self._channels

    def __getitem__(self, topic: str) -> KeptChannel:
        return self._channels[topic]


LAG_NS = 100_000_000
"""What is put off at most [ns]."""


def _in_step(windows: Iterable[dict[str, "ChannelData"]]) -> Iterator[dict[str, "ChannelData"]]:
    """The same windows, each with whole control ticks.

    A chunk ends with a tick whose last messages are in the next one; such a tick is put off until it is whole.
    """
    rest: dict[str, ChannelData] = {}
    for channels in windows:
        joined = {topic: rest[topic].joined(channel) if rest else channel for topic, channel in channels.items()}
        clocks = [joined[topic].time_ns for topic in CONTROL_TOPICS if topic in joined and len(joined[topic])]
        ends = [int(times[-1]) for times in clocks]
        # No sound channel lags by more than a tick; one that does must not hold up all others.
        last = max(min(ends), max(ends) - LAG_NS) if ends else np.iinfo(np.int64).max - 1
        rest = {topic: channel.between(last + 1, np.iinfo(np.int64).max - 1) for topic, channel in joined.items()}
        yield {topic: channel.between(np.iinfo(np.int64).min, last) for topic, channel in joined.items()}
    yield rest


def _united(reads: Iterable[Reads]) -> dict[str, list[str]]:
    """All fields by topic, each once."""
    found: dict[str, list[str]] = {}
    for topics in reads:
        for topic, names in topics.items():
            fields = found.setdefault(topic, [])
            fields += [name for name in names if name not in fields]
    return found


SINGLE_SUPPORT = 2
"""Value of ``/reference.phase`` in single support."""

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Rows = NDArray[np.intp]


class RunView:
    """Fields of a log on the common control ticks, with the run's constants.

    A killed process may leave a tick half written, so control-rate channels are cut to the shortest one.

    Attributes:
        log: the log, a part of it or its digest.
        constants: of its run.
    """

    def __init__(self, log: Source, constants: RunConstants | None = None) -> None:
        self.log = log
        self.constants = constants or RunConstants.from_metadata(log.metadata, str(log.path))

    def has(self, *topics: str) -> bool:
        """Whether all of these topics have messages."""
        return all(topic in self.log and len(self.log[topic]) > 0 for topic in topics)

    def field(self, topic: str, name: str) -> Array:
        """A field of a control-rate channel on the common ticks, shape (n, *field shape)."""
        return self.log[topic].field(name)[: self.ticks]

    def reduced(self, reduce: "Callable[[RunView], Array]") -> Array:
        """What a function makes of each tick or message: out of the digest if it holds that."""
        if isinstance(self.log, Digest) and reduce in self.log.reduced:
            return self.log.reduced[reduce]
        return reduce(self)

    @cached_property
    def ticks(self) -> int:
        """Number of common control ticks."""
        return min((len(self.log[topic]) for topic in CONTROL_TOPICS if self.has(topic)), default=0)

    @cached_property
    def time(self) -> Array:
        """Time of the control ticks, shape (n,) [s]."""
        return self.log["/truth"].time[: self.ticks]

    @cached_property
    def single_support(self) -> Mask:
        """Ticks in planned single support, shape (n,)."""
        return np.asarray(self.field("/reference", "phase") == SINGLE_SUPPORT)

    @cached_property
    def walking(self) -> slice:
        """Ticks from the first lift-off to the last touchdown; empty when no foot was lifted."""
        swings = np.flatnonzero(self.single_support)
        return slice(int(swings[0]), int(swings[-1]) + 1) if len(swings) else slice(0, 0)

    @cached_property
    def soles(self) -> Array:
        """True poses of the soles, shape (n, 2, 7), x y z qx qy qz qw."""
        return np.stack([self.sole(0), self.sole(1)], axis=1)

    def sole(self, foot: int) -> Array:
        """True poses of the left or right sole (0, 1), shape (n, 7), x y z qx qy qz qw; takes half the memory."""
        return self.field("/truth", ("left_sole", "right_sole")[foot])

    @property
    def sole_yaw(self) -> Array:
        """True headings of the soles, shape (n, 2) [rad]."""
        return np.stack([headings(self.sole(foot)[:, 3:]) for foot in (0, 1)], axis=1)

    @cached_property
    def knees(self) -> list[int]:
        """Indices of the knees among the joints."""
        return knees(self.constants.joint_names, self.constants.roles)

    def rows_at(self, topic: str, times_ns: NDArray[np.int64]) -> tuple[NDArray[np.intp], Mask]:
        """Rows of a channel nearest to given times, and whether they are within half a control tick of them."""
        stamps = self.log[topic].time_ns
        after = np.clip(np.searchsorted(stamps, times_ns), 1, max(len(stamps) - 1, 1))
        before_is_nearer = times_ns - stamps[after - 1] <= np.abs(stamps[np.minimum(after, len(stamps) - 1)] - times_ns)
        rows = np.where(before_is_nearer, after - 1, np.minimum(after, len(stamps) - 1))
        return rows, np.abs(stamps[rows] - times_ns) <= 0.5e9 / self.constants.control_rate
