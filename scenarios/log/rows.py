"""The hot end of the log: values are copied into preallocated message records, alone or as rows of several channels."""

import struct
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from mcap.opcode import Opcode
from numpy.typing import ArrayLike, NDArray

from surefoot.scenarios.log.spec import PREFIX_BYTES, ChannelSpec, blank_records

_INDEX_HEADER = struct.Struct("<BQHI")


class Clock:
    """When the chunk under way is due.

    Attributes:
        due: simulated time [ns] from which the next message completes the chunk.
        complete: completes it, at this time [ns].
    """

    def __init__(self, due: int, complete: Callable[[int], None]) -> None:
        self.due, self.complete = due, complete


class Waiting:
    """Messages of one channel that wait for their chunk.

    Attributes:
        channel_id: its number in the file.
        count: messages waiting.
        total: messages handed over to chunks so far.
        times: simulated time of the messages waiting [ns].
    """

    def __init__(self, channel_id: int, clock: Clock) -> None:
        self.channel_id, self._clock = channel_id, clock
        self.count = self.total = 0
        self.times: list[int] = []

    def take(self, offset: int) -> tuple[memoryview | bytes, bytes]:
        """Hand over what waits.

        Args:
            offset: where its block begins in the chunk [bytes].

        Returns:
            the message records, valid until the next `append`, and their MessageIndex record.
        """
        raise NotImplementedError

    def drop(self) -> None:
        """Forget what waits."""
        self.times.clear()
        self.count = 0


class ChannelWriter(Waiting):
    """Messages of a fixed layout, in memory that is taken once.

    Args:
        spec: the channel.
        channel_id: its number in the file.
        capacity: messages that may wait.
        clock: says when a chunk is due.

    Attributes:
        spec: the channel.
    """

    def __init__(self, spec: ChannelSpec, channel_id: int, capacity: int, clock: Clock) -> None:
        super().__init__(channel_id, clock)
        self.spec, self._capacity = spec, capacity
        self._names = tuple(field.name for field in spec.fields)
        self._records = blank_records(spec.fields, channel_id, capacity)
        self._views: tuple[NDArray[np.generic], ...] = tuple(self._records[name] for name in self._names)
        self._bytes = self._records.view(np.uint8).reshape(capacity, -1)
        self._offsets = np.arange(capacity, dtype=np.uint64) * np.uint64(self._records.dtype.itemsize)

    def append(self, time_ns: int, *values: ArrayLike) -> None:
        """Add a message; the values are copied.

        Args:
            time_ns: simulated time [ns].
            values: one per field, of the field's shape.

        Raises:
            ValueError: the number of values or a shape does not fit the channel.
            LogError: the chunk that this message completes cannot be written.
        """
        n = self.count
        self.times.append(time_ns)
        for view, value in zip(self._views, values, strict=True):
            view[n] = value
        self.count = n = n + 1
        if time_ns >= self._clock.due or n == self._capacity:
            self._clock.complete(time_ns)

    def put(self, time_ns: int, *sources: object, **given: ArrayLike) -> None:
        """Add a message by the names of its fields; the values are copied.

        Args:
            time_ns: simulated time [ns].
            sources: whose attributes are the values of the fields of their names; of several the first that has one.
            given: values by field, in place of those of the sources.

        Raises:
            ValueError: a field that nothing gives, or a value that is of no field; else as of `append`.
        """
        owners = {name: source for source in reversed(sources) for name in self._names if hasattr(source, name)}
        found = {name: getattr(source, name) for name, source in owners.items()} | given
        if wrong := found.keys() ^ set(self._names):
            raise ValueError(
                f"{self.spec.topic}: fields that nothing gives, or that it has not: {', '.join(sorted(wrong))}"
            )
        self.append(time_ns, *(found[name] for name in self._names))

    def view(self, name: str) -> NDArray[np.generic]:
        """Where the values of a field wait, shape (capacity, *field shape)."""
        return self._views[self._names.index(name)]

    def fill(self, times_ns: Sequence[int]) -> None:
        """Take over messages whose values were written into the views, while none waits."""
        self.times.extend(times_ns)
        self.count = len(times_ns)

    def take(self, offset: int) -> tuple[memoryview, bytes]:
        """See `Waiting`."""
        n, records = self.count, self._records
        stamps = np.array(self.times, np.uint64)
        for name in ("_stamp", "_log_time", "_publish_time"):
            records[name][:n] = stamps
        records["_sequence"][:n] = np.arange(self.total, self.total + n)
        self.total += n
        self.drop()
        index = message_index(self.channel_id, stamps, self._offsets[:n] + np.uint64(offset))
        return self._bytes[:n].data.cast("B"), index


def message_index(channel_id: int, times_ns: ArrayLike, offsets: ArrayLike) -> bytes:
    """MessageIndex record of a channel's messages in a chunk: times [ns] and byte offsets, shape (n,) each."""
    times = np.asarray(times_ns, "<u8")
    index = np.empty((len(times), 2), "<u8")
    index[:, 0], index[:, 1] = times, offsets
    entries = index.tobytes()
    return _INDEX_HEADER.pack(Opcode.MESSAGE_INDEX, len(entries) + 6, channel_id, len(entries)) + entries


_HEADER = struct.Struct("<BQHIQQ")


class MessageWriter(Waiting):
    """Encoded messages of any size; for channels slower than the control rate."""

    def __init__(self, channel_id: int, clock: Clock) -> None:
        super().__init__(channel_id, clock)
        self._waiting: list[bytes] = []

    def append(self, time_ns: int, data: bytes) -> None:
        """Add an encoded message.

        Raises:
            LogError: the chunk that this message completes cannot be written.
        """
        self.times.append(time_ns)
        self._waiting.append(data)
        self.count += 1
        if time_ns >= self._clock.due:
            self._clock.complete(time_ns)

    def drop(self) -> None:
        """Forget what waits."""
        super().drop()
        self._waiting.clear()

    def take(self, offset: int) -> tuple[bytes, bytes]:
        """See `Waiting`."""
        blocks, offsets = [], []
        for time, data in zip(self.times, self._waiting, strict=True):
            offsets.append(offset)
            length = _HEADER.size - PREFIX_BYTES + len(data)
            blocks.append(_HEADER.pack(Opcode.MESSAGE, length, self.channel_id, self.total, time, time) + data)
            offset += len(blocks[-1])
            self.total += 1
        index = message_index(self.channel_id, self.times, offsets)
        self.drop()
        return b"".join(blocks), index


Array = NDArray[np.float64]
Columns = Sequence[tuple[ChannelWriter, Sequence[str]]]
"""Fields of channels, in order."""

Place = tuple[str, str] | str
"""Topic and name of a field, or the name of an input that is in no channel."""


class Rows:
    """Rows that are handed over, by the names of what they hold."""

    __slots__ = ("_at", "_tables")

    def __init__(self, tables: tuple[Array, ...], at: Sequence[Mapping[Place, slice]]) -> None:
        """Tables of shape (n, width), and where in each its fields and inputs are."""
        self._tables = tables
        self._at = at

    def __getitem__(self, place: Place) -> Array:
        """Values of a field or an input, shape (n, size)."""
        return self.span(place, place)

    def span(self, first: Place, last: Place) -> Array:
        """Values of neighbours from one to another, shape (n, sizes together).

        Raises:
            KeyError: these are not in the same table.
        """
        for table, at in zip(self._tables, self._at, strict=True):
            if first in at:
                return table[:, at[first].start : at[last].stop]
        raise KeyError(first)


Derive = Callable[[Rows], Mapping[tuple[str, str], Array]]


@dataclass(frozen=True, slots=True)
class RowLayout:
    """What rows are made of: fields of channels, in this order.

    Attributes:
        vectors: fields that come as vectors.
        numbers: fields that come as plain numbers.
        derived: fields that come out of `derive`.
        derive: from rows to the derived fields, by topic and name.
        more_vectors: name and size of vectors that only `derive` needs; they come after the others.
        more_numbers: names of numbers that only `derive` needs; they come after the others.
    """

    vectors: Columns
    numbers: Columns
    derived: Columns = ()
    derive: Derive | None = None
    more_vectors: Mapping[str, int] = field(default_factory=dict)
    more_numbers: Sequence[str] = ()


class RowWriter:
    """Rows that wait for their chunk: vectors, numbers, and what is derived from both when the chunk is due."""

    def __init__(self, layout: RowLayout, capacity: int, clock: Clock) -> None:
        """Rows of a layout, of which so many may wait until the clock says that a chunk is due.

        Raises:
            ValueError: a field is missing or there twice.
        """
        groups = (layout.vectors, layout.numbers, layout.derived)
        writers = {writer.channel_id: writer for group in groups for writer, _ in group}
        sizes = [size for group in groups for _, size in _sizes(group)]
        if sum(sizes) != sum(field.size for writer in writers.values() for field in writer.spec.fields):
            raise ValueError("a row must hold every field of its channels exactly once")
        self._at = (
            _places((*_sizes(layout.vectors), *layout.more_vectors.items())),
            _places((*_sizes(layout.numbers), *((name, 1) for name in layout.more_numbers))),
        )
        self._views, self._derived = (_views(layout.vectors), _views(layout.numbers)), _views(layout.derived)
        self._writers, self._derive = list(writers.values()), layout.derive
        self._vectors = np.zeros((capacity, _width(self._at[0])))
        self._numbers: list[tuple[float, ...]] = []
        self._times: list[int] = []
        self._capacity, self._clock = capacity, clock

    def append(self, time_ns: int, numbers: tuple[float, ...], *vectors: Array) -> None:
        """Add a message to each channel; the values are copied.

        Args:
            time_ns: simulated time [ns].
            numbers: the row's numbers.
            vectors: float64 vectors that make up the rest of the row.

        Raises:
            ValueError: the vectors do not fill the row, or the numbers of a row of this chunk did not.
            LogError: the chunk that this row completes cannot be written.
        """
        if vectors:
            np.concatenate(vectors, out=self._vectors[len(self._times)])
        self._numbers.append(numbers)
        self._times.append(time_ns)
        if time_ns >= self._clock.due or len(self._times) == self._capacity:
            self._clock.complete(time_ns)

    def drop(self) -> None:
        """Forget the rows that wait."""
        self._times.clear()
        self._numbers.clear()

    def spread(self) -> None:
        """Hand the rows that wait over to the channels.

        Raises:
            ValueError: the numbers of a row are not as many as were announced.
        """
        n = len(self._times)
        if not n:
            return
        tables = (self._vectors[:n], np.array(self._numbers, np.float64))
        if tables[1].shape[1] != _width(self._at[1]):
            raise ValueError(f"a row of {tables[1].shape[1]} numbers, where there are places for {_width(self._at[1])}")
        for table, views, at in zip(tables, self._views, self._at, strict=True):
            for place, view in views:
                view[:n] = table[:, at[place]].reshape(n, *view.shape[1:])
        if self._derive is not None:
            values = self._derive(Rows(tables, self._at))
            for place, view in self._derived:
                view[:n] = values[place].reshape(n, *view.shape[1:])
        for writer in self._writers:
            writer.fill(self._times)
        self.drop()


def _sizes(group: Columns) -> list[tuple[tuple[str, str], int]]:
    """The fields of a group, in order, with their sizes."""
    found = ((writer.spec, name) for writer, names in group for name in names)
    return [((spec.topic, name), one.size) for spec, name in found for one in spec.fields if one.name == name]


def _places(sizes: Iterable[tuple[Place, int]]) -> dict[Place, slice]:
    """Columns of what stands beside each other."""
    found, start = {}, 0
    for place, size in sizes:
        found[place] = slice(start, start + size)
        start += size
    return found


def _width(at: Mapping[Place, slice]) -> int:
    return max((place.stop for place in at.values()), default=0)


def _views(group: Columns) -> list[tuple[tuple[str, str], NDArray[np.generic]]]:
    """Where the fields of a group wait."""
    return [((writer.spec.topic, name), writer.view(name)) for writer, names in group for name in names]
