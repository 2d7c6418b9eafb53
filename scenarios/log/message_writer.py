"""Channels of other people's schemas: messages from a template, and messages that come encoded."""

import struct
from collections.abc import Callable

import numpy as np
from mcap.opcode import Opcode
from numpy.typing import ArrayLike

from scenarios.log.channel_writer import Clock, message_index
from scenarios.log.layout import PREFIX_BYTES
from scenarios.log.template import Template

_HEADER = struct.Struct("<BQHIQQ")
_SEQUENCE, _LOG_TIME, _PUBLISH_TIME = slice(11, 15), slice(15, 23), slice(23, 31)


class TemplateWriter:
    """Messages of one template that wait for their chunk.

    Attributes:
        channel_id: its number in the file.
        count: messages waiting.
        total: messages handed over to chunks so far.
    """

    def __init__(
        self, template: Template, channel_id: int, capacity: int, clock: Clock, flush: Callable[[int], None]
    ) -> None:
        self.channel_id = channel_id
        self.count = self.total = 0
        length = _HEADER.size - PREFIX_BYTES + len(template.data)
        blank = _HEADER.pack(Opcode.MESSAGE, length, channel_id, 0, 0, 0) + template.data
        self._bytes = np.tile(np.frombuffer(blank, np.uint8), (capacity, 1))
        self._values = np.zeros((capacity, template.size))
        self._stamps = np.zeros(capacity, np.uint64)
        self._template, self._capacity, self._clock, self._flush = template, capacity, clock, flush

    def append(self, time_ns: int, values: ArrayLike) -> None:
        """Add a message; the values are copied.

        Args:
            time_ns: simulated time [ns].
            values: of the template's slots, shape (size,).

        Raises:
            LogError: the chunk that this message completes cannot be written.
        """
        n = self.count
        self._values[n] = values
        self._stamps[n] = time_ns
        self.count = n = n + 1
        if time_ns >= self._clock.due or n == self._capacity:
            self._flush(time_ns)

    def time_range(self) -> tuple[int, int]:
        """Least and greatest stamp waiting [ns]."""
        stamps = self._stamps[: self.count]
        return int(stamps.min()), int(stamps.max())

    def take(self, offset: int) -> tuple[memoryview, bytes]:
        """Hand over what waits, as `ChannelWriter.take` does."""
        n = self.count
        records, stamps = self._bytes[:n], self._stamps[:n]
        self._template.write(records[:, _HEADER.size :], self._values[:n], stamps)
        sequence = np.arange(self.total, self.total + n, dtype="<u4")
        records[:, _SEQUENCE] = sequence.view(np.uint8).reshape(n, 4)
        records[:, _LOG_TIME] = records[:, _PUBLISH_TIME] = stamps.astype("<u8").view(np.uint8).reshape(n, 8)
        offsets = offset + np.arange(n, dtype=np.uint64) * np.uint64(records.shape[1])
        self.count = 0
        self.total += n
        return records.data.cast("B"), message_index(self.channel_id, stamps, offsets)


class MessageWriter:
    """Encoded messages of any size that wait for their chunk; for what is rare.

    Attributes:
        channel_id: its number in the file.
        count: messages waiting.
        total: messages handed over to chunks so far.
    """

    def __init__(self, channel_id: int, clock: Clock, flush: Callable[[int], None]) -> None:
        self.channel_id = channel_id
        self.count = self.total = 0
        self._waiting: list[tuple[int, bytes]] = []
        self._clock, self._flush = clock, flush

    def append(self, time_ns: int, data: bytes) -> None:
        """Add an encoded message.

        Raises:
            LogError: the chunk that this message completes cannot be written.
        """
        self._waiting.append((time_ns, data))
        self.count += 1
        if time_ns >= self._clock.due:
            self._flush(time_ns)

    def time_range(self) -> tuple[int, int]:
        """Least and greatest stamp waiting [ns]."""
        times = [time for time, _ in self._waiting]
        return min(times), max(times)

    def take(self, offset: int) -> tuple[memoryview, bytes]:
        """Hand over what waits, as `ChannelWriter.take` does."""
        block, offsets = bytearray(), []
        for time, data in self._waiting:
            offsets.append(offset + len(block))
            length = _HEADER.size - PREFIX_BYTES + len(data)
            block += _HEADER.pack(Opcode.MESSAGE, length, self.channel_id, self.total, time, time) + data
            self.total += 1
        index = message_index(self.channel_id, [time for time, _ in self._waiting], offsets)
        self._waiting.clear()
        self.count = 0
        return memoryview(block), index
