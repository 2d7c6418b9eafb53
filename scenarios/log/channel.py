"""Channels of a log under way: values are copied into preallocated message records, which wait for their chunk."""

import struct
from collections.abc import Callable, Iterable, Mapping, Sequence, Set
from itertools import chain
from operator import attrgetter

import numpy as np
from mcap.opcode import Opcode
from numpy.typing import ArrayLike, NDArray

from surefoot.scenarios.log.spec import PREFIX_BYTES, ChannelSpec, blank_records

_INDEX_HEADER = struct.Struct("<BQHI")


class Clock:
    """When the chunk under way is due.

    Attributes:
        due: simulated time [ns] from which the next message completes the chunk, or goes on to write the last one.
        complete: does so, at this time [ns].
        full: completes it whatever its time, since a channel can hold no more.
    """

    def __init__(self, due: int, complete: Callable[[int], None], full: Callable[[int], None]) -> None:
        self.due, self.complete, self.full = due, complete, full

    def look(self, time_ns: int, full: bool) -> None:
        """After a message at a time [ns], with which its channel may be full."""
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
        self.spec, self._capacity, self._stamped = spec, capacity, False
        self._names = tuple(field.name for field in spec.fields)
        self._records = blank_records(spec, channel_id, capacity)
        self._views: tuple[NDArray[np.generic], ...] = tuple(self._records[name] for name in self._names)
        self._stamps = tuple(self._records[name] for name in ("_log_time", "_stamp", "_publish_time"))
        self._sequence, self._index = self._records["_sequence"], np.zeros((capacity, 2), "<u8")
        self._bytes, self._entries = (each.view(np.uint8).ravel().data for each in (self._records, self._index))
        self._size = self._records.dtype.itemsize
        self._offsets = np.arange(capacity, dtype=np.uint64) * np.uint64(self._size)

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
            self._clock.look(time_ns, n == self._capacity)

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
        self._refuse(found.keys() ^ set(self._names))
        self.append(time_ns, *(found[name] for name in self._names))

    def filler(self, attributes: Mapping[str, str], given: Sequence[str] = ()) -> Callable[..., None]:
        """What adds messages of one source, without a look at names each time as `put` takes it.

        Such a message completes no chunk by its time: those that come at each tick do, and they are added at its end.

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
            self.times.append(time_ns)
            found = more if values is None else (*values(source), *more)
            for view, value in zip(views, found, strict=True):
                view[n] = value
            self.count = n = n + 1
            if n == self._capacity:
                self._clock.full(time_ns)

        return fill

    def _refuse(self, wrong: Set[str]) -> None:
        if wrong:
            raise ValueError(
                f"{self.spec.topic}: fields that nothing gives, or that it has not: {', '.join(sorted(wrong))}"
            )

    def view(self, name: str) -> NDArray[np.generic]:
        """Where the values of a field wait, shape (capacity, *field shape)."""
        return self._views[self._names.index(name)]

    @property
    def records(self) -> NDArray[np.void]:
        """Message records, of which those that wait are the first."""
        return self._records

    def fill(self, times_ns: Sequence[int], stamped: bool = False) -> None:
        """Take over messages whose values were written into the views, while none waits.

        Args:
            times_ns: their times [ns].
            stamped: whether times and numbers are written as well.
        """
        self.times.extend(times_ns)
        self.count, self._stamped = len(times_ns), stamped

    def take(self, offset: int) -> tuple[memoryview, bytes]:
        """See `Waiting`."""
        n, stamps = self.count, self._stamps[0][: self.count]
        if not self._stamped:
            times = np.array(self.times, np.uint64)
            for view in self._stamps:
                view[:n] = times
            self._sequence[:n] = np.arange(self.total, self.total + n)
        self._stamped = False
        self.total += n
        self.drop()
        index = self._index
        index[:n, 0] = stamps
        np.add(self._offsets[:n], np.uint64(offset), out=index[:n, 1])
        return self._bytes[: n * self._size], index_record(self.channel_id, self._entries[: n * _ENTRY])


_ENTRY = 16
"""Bytes of a message's entry in the index of its channel: time and offset."""


def message_index(channel_id: int, times_ns: Iterable[int], offsets: Iterable[int]) -> bytes:
    """MessageIndex record of a channel's messages in a chunk: times [ns] and byte offsets, as many of each."""
    entries = tuple(chain.from_iterable(zip(times_ns, offsets, strict=True)))
    return index_record(channel_id, struct.pack(f"<{len(entries)}Q", *entries))


def index_record(channel_id: int, entries: bytes | memoryview) -> bytes:
    """The same of times and offsets as they stand in it."""
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
        blocks: list[bytes] = []
        offsets = []
        for number, (time, data) in enumerate(zip(self.times, self._waiting, strict=True), start=self.total):
            offsets.append(offset)
            length = _HEADER.size - PREFIX_BYTES + len(data)
            blocks += (_HEADER.pack(Opcode.MESSAGE, length, self.channel_id, number, time, time), data)
            offset += _HEADER.size + len(data)
        self.total += self.count
        index = message_index(self.channel_id, self.times, offsets)
        self.drop()
        return b"".join(blocks), index
