"""Arrays that are gathered part by part from a log, in memory while they are few and then in temporary files."""

import tempfile
from collections.abc import Callable, Collection, Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import IO, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.output import reason

Reads = Mapping[str, tuple[str, ...]]
"""Names of fields by topic."""

TIME = "time_ns"
"""Key of the times of a topic's messages, among those of its fields."""


@dataclass(frozen=True, slots=True)
class Memory:
    """Bounds on what is held of a log at once.

    Attributes:
        held: most bytes of one topic, and of all columns together: by default a minute of a walk [bytes].
        window: simulated time that is read at once where a whole log is gone through [s].
        drawn: simulated time of which the widest channels are drawn at once [s].
    """

    held: int = 16 << 20
    window: float = 4.0
    drawn: float = 60.0


USUAL = Memory()
"""The memory of a log of which nothing else is said."""


class Columns:
    """Arrays by key, each joined of its parts.

    From a file an array is mapped anew whenever it is asked for, so that its memory is free again as soon as it is
    dropped, however long the log.
    """

    def __init__(self, memory: Memory = USUAL) -> None:
        """Gather in memory up to its `Memory.held`, then in temporary files."""
        self._most = memory.held
        self._parts: dict[Hashable, list[NDArray[Any]]] = {}
        self._files: dict[Hashable, IO[bytes]] = {}
        self._kinds: dict[Hashable, tuple[tuple[int, ...], np.dtype[Any]]] = {}
        self._rows: dict[Hashable, int] = {}
        self._unlike: set[Hashable] = set()
        self._held, self._spilled = 0, False

    def __contains__(self, key: Hashable) -> bool:
        return key in self._kinds

    def __iter__(self) -> Iterator[Hashable]:
        return iter(self._kinds)

    def add(self, key: Hashable, values: NDArray[Any]) -> None:
        """Append a part, which nobody may change from then on; a key whose parts cannot be joined is forgotten.

        Raises:
            LogError: there is no room for the files.
        """
        kind, sound = (values.shape[1:], values.dtype), values.ndim > 0 and not values.dtype.hasobject
        if key in self._unlike or not sound or self._kinds.setdefault(key, kind) != kind:
            self.forget(key)
            return
        self._rows[key] = self._rows.get(key, 0) + len(values)
        if self._spilled:
            self._write(key, values)
            return
        self._parts.setdefault(key, []).append(values)
        self._held += values.nbytes
        if self._held > self._most:
            self._spill()

    def forget(self, key: Hashable) -> None:
        """Drop what there is of a key, and what comes."""
        self._unlike.add(key)
        for table in (self._parts, self._files, self._kinds):
            table.pop(key, None)

    def replace(self, key: Hashable, values: NDArray[Any]) -> None:
        """Put other values in the place of those of a key."""
        for table in (self._parts, self._files, self._kinds, self._rows):
            table.pop(key, None)
        self.add(key, values)

    def __len__(self) -> int:
        return len(self._kinds)

    def rows(self, key: Hashable) -> int:
        """Length of an array."""
        return self._rows.get(key, 0)

    def __getitem__(self, key: Hashable) -> NDArray[Any]:
        """The array of a key; it cannot be written to."""
        shape, dtype = self._kinds[key]
        if not self._spilled:
            if len(self._parts[key]) > 1:
                self._parts[key] = [np.concatenate(self._parts[key])]
            (values,) = self._parts[key]
            values.flags.writeable = False
            return values
        if not self._rows[key] or 0 in shape:
            return np.empty((self._rows[key], *shape), dtype)
        self._files[key].flush()
        return np.asarray(np.memmap(self._files[key], dtype, "r", shape=(self._rows[key], *shape)))

    def _spill(self) -> None:
        self._spilled = True
        for key, parts in self._parts.items():
            for part in parts:
                self._write(key, part)
        self._parts.clear()

    def _write(self, key: Hashable, values: NDArray[Any]) -> None:
        try:
            if key not in self._files:
                self._files[key] = tempfile.TemporaryFile(prefix="surefoot-")  # noqa: SIM115  open as long as it is used
            self._files[key].write(values.tobytes())
        except OSError as error:
            what = f"{tempfile.gettempdir()}: no place to digest a long log, {reason(error)}"
            raise LogError(f"{what}; set TMPDIR to a directory with more room") from None


class Named(Protocol):
    """Something that has a name."""

    @property
    def name(self) -> str:
        """Name of the column."""


class Channel(Protocol):
    """Messages of a channel, as `surefoot.scenarios.log.ChannelData` has them."""

    @property
    def fields(self) -> Sequence[Named]:
        """The fields that it has."""

    @property
    def time_ns(self) -> NDArray[np.int64]:
        """Simulated time of each message, shape (n,) [ns]."""

    def field(self, name: str) -> NDArray[Any]:
        """Values of one field, shape (n, *field shape)."""


class KeptChannel:
    """Fields of a channel over a stretch of a log; one that was not kept is read from the log when it is asked for."""

    def __init__(self, topic: str, columns: Columns, rest: Callable[[], Channel]) -> None:
        """Stand for a topic by its columns, whose keys are the topic with the name of a field or with `TIME`.

        Args:
            topic: of the channel.
            columns: what was kept.
            rest: gives the channel with all its fields.
        """
        self._topic, self._columns, self._rest = topic, columns, rest

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
        return self._columns[kept] if kept in self._columns else self._rest().field(name)


def keep(columns: Columns, channels: Mapping[str, Channel], reads: Mapping[str, Collection[str]]) -> None:
    """Append to columns the times of channels, and those fields of `reads` that the channels have."""
    for topic, channel in channels.items():
        columns.add((topic, TIME), channel.time_ns)
        there = {field.name for field in channel.fields}
        for name in reads[topic]:
            if name in there:
                columns.add((topic, name), channel.field(name))


def in_order(columns: Columns, topic: str) -> None:
    """Put the columns of a topic in order of time where its messages were not."""
    times = columns[topic, TIME]
    if np.any(times[1:] < times[:-1]):
        order = np.argsort(times, kind="stable")
        for key in [key for key in columns if isinstance(key, tuple) and key[0] == topic]:
            columns.replace(key, columns[key][order])
