"""Channels of a log under way: values are copied into preallocated message records, which wait for their chunk."""

import struct
from collections.abc import Callable, Iterator, Mapping, Sequence, Set
from itertools import repeat
from operator import attrgetter

import numpy as np
from mcap.opcode import Opcode
from numpy.typing import ArrayLike, NDArray

from surefoot.scenarios.log.spec import PREFIX_BYTES, ChannelSpec, blank_records

_INDEX_HEADER = struct.Struct("<BQHI")


class Clock:
    """The time at which the chunk under way is due.

    Attributes:
        due: simulated time [ns] from which on the next message finds the chunk complete without it, or lets the last
            one be written on. So a chunk has whole control ticks, and no message of a later time.
        complete: does so, at this time [ns].
        full: completes it whatever its time, since a channel can hold no more.
    """

    def __init__(self, due: int, complete: Callable[[int], None], full: Callable[[int], None]) -> None:
        self.due, self.complete, self.full = due, complete, full

    def look(self, time_ns: int, full: bool) -> None:
        """Before a message at a time [ns], for which its channel may have no room."""
        if full:
            self.full(time_ns)
        elif time_ns >= self.due:
            self.complete(time_ns)


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

    def complete(self) -> int:
        """Put into the messages waiting what their number in the file and their times decide; gives their size [B]."""
        raise NotImplementedError

    def each(self) -> "Iterator[tuple[int, int, bytes | memoryview]]":
        """Time [ns], channel id and record of each, once they are complete; the record is valid until an `append`."""
        raise NotImplementedError

    def taken(self) -> None:
        """Let go of the messages: they are in a chunk, and wait no more."""
        self.total += self.count
        self.drop()

    def drop(self) -> None:
        """Forget what waits."""
        if self.times:
            self.times = []  # a new one: channels of the same rows share theirs
        self.count = 0


class Slab:
    """Memory of message records: of each channel one in a row, side by side.

    Args:
        capacity: rows.
        width: of a row [bytes].

    Attributes:
        width: of a row [bytes].
        memory: shape (capacity, width).
        rows: the rows as wholes, shape (capacity,).
    """

    def __init__(self, capacity: int, width: int) -> None:
        self.width, self.memory = width, np.zeros((capacity, width), np.uint8)
        self.rows: NDArray[np.void] = self.memory.view(f"V{width}")[:, 0]
        self._bytes = self.memory.reshape(-1).data

    def piece(self, row: int, column: int, size: int) -> memoryview:
        """A record of a size in a row, from a column on [bytes]."""
        start = row * self.width + column
        return self._bytes[start : start + size]


class ChannelWriter(Waiting):
    """Messages of a fixed layout, in memory that is taken once.

    Args:
        spec: the channel.
        channel_id: its number in the file.
        capacity: messages that may wait.
        clock: says when a chunk is due.

    Attributes:
        spec: the channel.
        size: of a message record [bytes].
        slab: where the messages wait.
        column: where in its rows they begin [bytes].
    """

    def __init__(self, spec: ChannelSpec, channel_id: int, capacity: int, clock: Clock) -> None:
        super().__init__(channel_id, clock)
        self.spec, self._capacity, self._stamped = spec, capacity, False
        self._names, self.size = tuple(field.name for field in spec.fields), spec.dtype.itemsize
        self.settle(Slab(capacity, self.size), 0)

    def settle(self, slab: Slab, column: int) -> None:
        """Wait from now on in a slab, from a column of its rows on [bytes]; nothing waits yet, and nobody has views."""
        self.slab, self.column = slab, column
        self._records: NDArray[np.void] = slab.memory[:, column : column + self.size].view(self.spec.dtype)[:, 0]
        self._records[:] = blank_records(self.spec, self.channel_id, self._capacity)
        self._views: tuple[NDArray[np.generic], ...] = tuple(self._records[name] for name in self._names)
        self._stamps = tuple(self._records[name] for name in ("_log_time", "_stamp", "_publish_time"))
        self._sequence = self._records["_sequence"]

    def append(self, time_ns: int, *values: ArrayLike) -> None:
        """Add a message; the values are copied.

        Args:
            time_ns: simulated time [ns].
            values: one per field, of the field's shape.

        Raises:
            ValueError: the number of values or a shape does not fit the channel.
            LogError: the chunk that is complete without this message cannot be written.
        """
        n = self.count
        if time_ns >= self._clock.due or n == self._capacity:
            self._clock.look(time_ns, n == self._capacity)
            n = self.count
        for view, value in zip(self._views, values, strict=True):
            view[n] = value
        self.times.append(time_ns)
        self.count = n + 1

    def put(self, time_ns: int, *sources: object, **given: ArrayLike) -> None:
        """Add a message by the names of its fields; the values are copied.

        Args:
            time_ns: simulated time [ns].
            sources: whose attributes are the values of the fields of their names; of several the first that has one.
            given: values by field, in place of those of the sources.

        Raises:
            ValueError: a field that nothing gives, or a value that is of no field or no shape of its field.
                LogError: the chunk that is complete without this message cannot be written.
        """
        owners = {name: source for source in reversed(sources) for name in self._names if hasattr(source, name)}
        found = {name: getattr(source, name) for name, source in owners.items()} | given
        self._refuse(found.keys() ^ set(self._names))
        self.append(time_ns, *(found[name] for name in self._names))

    def filler(self, attributes: Mapping[str, str], given: Sequence[str] = ()) -> Callable[..., None]:
        """A function that adds messages of one source, without a look at names each time as `put` takes it.

        Args:
            attributes: of the source, dotted, by field.
            given: fields whose values go after the source, in this order.

        Returns:
            To be called with the time [ns], the source and the values that are given.

        Raises:
            ValueError: a field that nothing gives, or a value that is of no field.
        """
        self._refuse(attributes.keys() ^ set(given) ^ set(self._names))
        views = [self.view(name) for name in (*attributes, *given)]
        values = attrgetter(*attributes.values()) if attributes else None

        def fill(time_ns: int, source: object, *more: ArrayLike) -> None:
            n = self.count
            if time_ns >= self._clock.due or n == self._capacity:
                self._clock.look(time_ns, n == self._capacity)
                n = self.count
            found = more if values is None else (*values(source), *more)
            for view, value in zip(views, found, strict=True):
                view[n] = value
            self.times.append(time_ns)
            self.count = n + 1

        return fill

    def _refuse(self, wrong: Set[str]) -> None:
        if wrong:
            raise ValueError(
                f"{self.spec.topic}: fields that nothing gives, or that it has not: {', '.join(sorted(wrong))}"
            )

    def view(self, name: str) -> NDArray[np.generic]:
        """View of the values of a field that wait, shape (capacity, *field shape)."""
        return self._views[self._names.index(name)]

    def fill(self, times_ns: list[int], stamps: NDArray[np.uint64]) -> None:
        """Take over messages whose values were written into the views, while none waits.

        Args:
            times_ns: their times, in a list that nobody changes any more [ns].
            stamps: the same, shape (n,).
        """
        self.times, self.count, self._stamped = times_ns, len(times_ns), True
        self._stamp(stamps)

    def complete(self) -> int:
        """See `Waiting`."""
        if not self._stamped:
            self._stamp(np.array(self.times, np.uint64))
        self._stamped = False
        return self.count * self.size

    def _stamp(self, stamps: NDArray[np.uint64]) -> None:
        """Write times [ns] and numbers of the messages that wait."""
        n = self.count
        for view in self._stamps:
            view[:n] = stamps
        self._sequence[:n] = np.arange(self.total, self.total + n)

    def each(self) -> Iterator[tuple[int, int, memoryview]]:
        """See `Waiting`."""
        for row, time in enumerate(self.times):
            yield time, self.channel_id, self.slab.piece(row, self.column, self.size)


ENTRY = 16
"""Bytes of a message's entry in the index of its channel: time and offset."""


def message_index(channel_id: int, entries: Sequence[int]) -> bytes:
    """MessageIndex record of a channel's messages in a chunk: time [ns] and offset [bytes] of each in turn."""
    packed = struct.pack(f"<{len(entries)}Q", *entries)
    return _INDEX_HEADER.pack(Opcode.MESSAGE_INDEX, len(packed) + 6, channel_id, len(packed)) + packed


_HEADER = struct.Struct("<BQHIQQ")


class MessageWriter(Waiting):
    """Encoded messages of any size; for channels slower than the control rate."""

    def __init__(self, channel_id: int, clock: Clock) -> None:
        super().__init__(channel_id, clock)
        self._waiting: list[bytes] = []

    def append(self, time_ns: int, data: bytes) -> None:
        """Add an encoded message.

        Raises:
            LogError: the chunk that is complete without this message cannot be written.
        """
        if time_ns >= self._clock.due:
            self._clock.complete(time_ns)
        length, number = _HEADER.size - PREFIX_BYTES + len(data), self.total + self.count
        self.times.append(time_ns)
        self._waiting.append(_HEADER.pack(Opcode.MESSAGE, length, self.channel_id, number, time_ns, time_ns) + data)
        self.count += 1

    def drop(self) -> None:
        """Forget what waits."""
        super().drop()
        self._waiting.clear()

    def complete(self) -> int:
        """See `Waiting`."""
        return sum(map(len, self._waiting))

    def each(self) -> Iterator[tuple[int, int, bytes]]:
        """See `Waiting`."""
        return zip(self.times, repeat(self.channel_id), self._waiting, strict=False)
