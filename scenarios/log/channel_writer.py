"""The hot end of the log: copies values into preallocated message records."""

import struct
from collections.abc import Callable, Sequence

import numpy as np
from mcap.opcode import Opcode
from numpy.typing import ArrayLike, NDArray

from scenarios.log.layout import blank_records
from scenarios.log.spec import ChannelSpec

_INDEX_HEADER = struct.Struct("<BQHI")


class Clock:
    """When the chunk under way is due.

    Attributes:
        due: simulated time [ns] from which the next message completes the chunk.
    """

    __slots__ = ("due",)

    def __init__(self, due: int) -> None:
        self.due = due


class ChannelWriter:
    """Messages of one channel that wait for their chunk.

    Attributes:
        spec: the channel.
        channel_id: its number in the file.
        count: messages waiting.
        total: messages handed over to chunks so far.
        times: simulated time of the messages waiting [ns].
    """

    __slots__ = (
        "_bytes",
        "_capacity",
        "_clock",
        "_flush",
        "_log_time",
        "_offsets",
        "_publish_time",
        "_records",
        "_sequence",
        "_stamp",
        "_views",
        "channel_id",
        "count",
        "spec",
        "times",
        "total",
    )

    def __init__(
        self, spec: ChannelSpec, channel_id: int, capacity: int, clock: Clock, flush: Callable[[int], None]
    ) -> None:
        self.spec = spec
        self.channel_id = channel_id
        self.count = 0
        self.total = 0
        self._records = blank_records(spec.fields, channel_id, capacity)
        self._views: tuple[NDArray[np.generic], ...] = tuple(self._records[field.name] for field in spec.fields)
        self._bytes = self._records.view(np.uint8).reshape(capacity, -1)
        self.times: list[int] = []
        self._stamp, self._sequence = self._records["_stamp"], self._records["_sequence"]
        self._log_time, self._publish_time = self._records["_log_time"], self._records["_publish_time"]
        self._offsets = np.arange(capacity, dtype=np.uint64) * np.uint64(self._records.dtype.itemsize)
        self._capacity = capacity
        self._clock = clock
        self._flush = flush

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
            self._flush(time_ns)

    def view(self, name: str) -> NDArray[np.generic]:
        """Where the values of a field wait, shape (capacity, *field shape)."""
        return self._views[[field.name for field in self.spec.fields].index(name)]

    def fill(self, times_ns: Sequence[int]) -> None:
        """Take over messages whose values were written into the views, while none waits."""
        self.times.extend(times_ns)
        self.count = len(times_ns)

    def take(self, offset: int) -> tuple[memoryview, bytes]:
        """Hand over what waits.

        Args:
            offset: where its block begins in the chunk [bytes].

        Returns:
            the message records, valid until the next `append`, and their MessageIndex record.
        """
        n = self.count
        stamps = np.array(self.times, np.uint64)
        self._stamp[:n] = self._log_time[:n] = self._publish_time[:n] = stamps
        self._sequence[:n] = np.arange(self.total, self.total + n)
        self.times.clear()
        self.count = 0
        self.total += n
        index = message_index(self.channel_id, stamps, self._offsets[:n] + np.uint64(offset))
        return self._bytes[:n].data.cast("B"), index


def message_index(channel_id: int, times_ns: ArrayLike, offsets: ArrayLike) -> bytes:
    """MessageIndex record of a channel's messages in a chunk: times [ns] and byte offsets, shape (n,) each."""
    times = np.asarray(times_ns, "<u8")
    index = np.empty((len(times), 2), "<u8")
    index[:, 0], index[:, 1] = times, offsets
    entries = index.tobytes()
    return _INDEX_HEADER.pack(Opcode.MESSAGE_INDEX, len(entries) + 6, channel_id, len(entries)) + entries
