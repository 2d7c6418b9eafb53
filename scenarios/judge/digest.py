"""A log as metrics and health checks see it: gathered in one pass with bounded memory, on common control ticks."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from surefoot.scenarios.judge.body import headings, knees
from surefoot.scenarios.log import ChannelData, Log
from surefoot.scenarios.record.provenance import RunConstants

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

    def __init__(self, log: Log, channels: Mapping[str, Channel]) -> None:
        self.path, self.size, self.metadata = log.path, log.size, log.metadata
        self._channels = channels

    def __contains__(self, topic: str) -> bool:
        return topic in self._channels

    def __getitem__(self, topic: str) -> Channel:
        return self._channels[topic]


class KeptChannel:
    """Fields of a channel over the whole run; one that was not kept is read from the log when it is asked for."""

    def __init__(self, log: Log, topic: str, times: Sequence[NDArray[np.int64]], fields: Mapping[str, Any]) -> None:
        self._log, self._topic = log, topic
        self._fields = fields
        self.time_ns: NDArray[np.int64] = np.concatenate(times)

    def __len__(self) -> int:
        return len(self.time_ns)

    @property
    def time(self) -> NDArray[np.float64]:
        """Simulated time of each message, shape (n,) [s]."""
        return np.asarray(self.time_ns / 1e9)

    def field(self, name: str) -> NDArray[Any]:
        """Values of one field, shape (n, *field shape)."""
        kept = self._fields.get(name)
        return self._log[self._topic].field(name) if kept is None else kept


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

    def __init__(self, log: Log, reads: Iterable[Reads], reduce: Reduce) -> None:
        """Go through the log once; its damage is then known.

        Args:
            log: a log.
            reads: fields that are held for the whole run; wider ones are reduced tick by tick.
            reduce: is applied to every part.
        """
        self.path, self.size, self.metadata = log.path, log.size, log.metadata
        held = _united((HELD, *reads))
        topics = [topic for topic in held if topic in log.numeric]
        times: dict[str, list[NDArray[np.int64]]] = {topic: [] for topic in topics}
        fields: dict[tuple[str, str], list[NDArray[Any]]] = {}
        reduced: dict[Any, list[NDArray[Any]]] = {}
        for channels, whole in _whole_ticks(log.windows(topics)):
            for topic, channel in channels.items():
                times[topic].append(channel.time_ns)
                for name in held[topic]:
                    if any(field.name == name for field in channel.fields):
                        fields.setdefault((topic, name), []).append(channel.field(name))
            for key, values in reduce(Window(log, channels)).items() if whole else ():
                reduced.setdefault(key, []).append(values)
        self.reduced = {key: np.concatenate(parts) for key, parts in reduced.items() if _alike(parts)}
        kept = {key: np.concatenate(parts) for key, parts in fields.items()}
        for values in (*self.reduced.values(), *kept.values()):
            values.flags.writeable = False
        self._channels = {
            topic: KeptChannel(log, topic, times[topic], {name: a for (of, name), a in kept.items() if of == topic})
            for topic in topics
        }

    def __contains__(self, topic: str) -> bool:
        return topic in self._channels

    def __getitem__(self, topic: str) -> KeptChannel:
        return self._channels[topic]


_EVER = 2**62
"""A time after every message [ns]."""


class _Part:
    """Messages of a channel in neighbouring windows of a log.

    Attributes:
        pieces: of each window.
        fields: of the channel.
        time_ns: simulated time of each message, shape (n,) [ns].
    """

    def __init__(self, pieces: Sequence[ChannelData]) -> None:
        self.pieces, self.fields = pieces, pieces[-1].fields
        self.time_ns: NDArray[np.int64] = np.concatenate([piece.time_ns for piece in pieces])

    def __len__(self) -> int:
        return len(self.time_ns)

    @property
    def time(self) -> NDArray[np.float64]:
        return np.asarray(self.time_ns / 1e9)

    def field(self, name: str) -> NDArray[Any]:
        return np.concatenate([piece.field(name) for piece in self.pieces])

    def between(self, start_ns: int, end_ns: int) -> "_Part":
        return _Part([piece.between(start_ns, end_ns) for piece in self.pieces])


def _whole_ticks(windows: Iterable[Mapping[str, ChannelData]]) -> Iterator[tuple[dict[str, _Part], bool]]:
    """Windows that all control topics end with the same tick, and True; what is left in the end, and False.

    A chunk of the log may end within a tick, with some of its messages in the next one. Cut there, a window would lose
    that tick, and the next one would see the topics a tick apart.
    """
    rest: dict[str, _Part] = {}
    for window in windows:
        parts = {topic: _Part([*_pieces(rest.get(topic)), piece]) for topic, piece in window.items()}
        control = {topic: parts[topic] for topic in CONTROL_TOPICS if topic in parts and len(parts[topic])}
        end = min((int(part.time_ns[-1]) for part in control.values()), default=0)
        yield {**parts, **{topic: part.between(0, end) for topic, part in control.items()}}, True
        rest = {topic: part.between(end + 1, _EVER) for topic, part in control.items()}
    yield rest, False


def _pieces(part: _Part | None) -> list[ChannelData]:
    return [] if part is None else [piece for piece in part.pieces if len(piece)]


def _united(reads: Iterable[Reads]) -> dict[str, list[str]]:
    """All fields by topic, each once."""
    found: dict[str, list[str]] = {}
    for topics in reads:
        for topic, names in topics.items():
            fields = found.setdefault(topic, [])
            fields += [name for name in names if name not in fields]
    return found


def _alike(parts: Sequence[NDArray[Any]]) -> bool:
    """Whether arrays can be joined; what cannot is computed from the whole log when it is asked for."""
    return all(np.ndim(part) > 0 and np.shape(part)[1:] == np.shape(parts[0])[1:] for part in parts)


SINGLE_SUPPORT = 2
"""Value of ``/reference.phase`` in single support."""

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


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
        kept = self.log.reduced.get(reduce) if isinstance(self.log, Digest) else None
        return reduce(self) if kept is None else kept

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
        return np.stack([self.field("/truth", "left_sole"), self.field("/truth", "right_sole")], axis=1)

    @cached_property
    def sole_yaw(self) -> Array:
        """True headings of the soles, shape (n, 2) [rad]."""
        return headings(self.soles[..., 3:])

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
