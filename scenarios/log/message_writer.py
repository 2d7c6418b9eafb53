"""Channels of other people's schemas, whose messages come encoded."""

import struct
from collections.abc import Callable

from mcap.opcode import Opcode

from scenarios.log.channel_writer import Clock, message_index
from scenarios.log.layout import PREFIX_BYTES

_HEADER = struct.Struct("<BQHIQQ")


class MessageWriter:
    """Encoded messages of any size that wait for their chunk; for channels slower than the control rate.

    Attributes:
        channel_id: its number in the file.
        count: messages waiting.
        total: messages handed over to chunks so far.
        times: simulated time of the messages waiting [ns].
    """

    def __init__(self, channel_id: int, clock: Clock, flush: Callable[[int], None]) -> None:
        self.channel_id = channel_id
        self.count = self.total = 0
        self.times: list[int] = []
        self._waiting: list[bytes] = []
        self._clock, self._flush = clock, flush

    def append(self, time_ns: int, data: bytes) -> None:
        """Add an encoded message.

        Raises:
            LogError: the chunk that this message completes cannot be written.
        """
        self.times.append(time_ns)
        self._waiting.append(data)
        self.count += 1
        if time_ns >= self._clock.due:
            self._flush(time_ns)

    def take(self, offset: int) -> tuple[bytes, bytes]:
        """Hand over what waits, as `ChannelWriter.take` does."""
        blocks, offsets = [], []
        for time, data in zip(self.times, self._waiting, strict=True):
            offsets.append(offset)
            length = _HEADER.size - PREFIX_BYTES + len(data)
            blocks.append(_HEADER.pack(Opcode.MESSAGE, length, self.channel_id, self.total, time, time) + data)
            offset += len(blocks[-1])
            self.total += 1
        index = message_index(self.channel_id, self.times, offsets)
        self.times.clear()
        self._waiting.clear()
        self.count = 0
        return b"".join(blocks), index
