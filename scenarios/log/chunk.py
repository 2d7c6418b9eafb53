"""Puts the messages that wait in their channels into one block, in the order of their time, and indexes them."""

from bisect import bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from operator import itemgetter

import numpy as np
from mcap.opcode import Opcode
from numpy.typing import NDArray

from surefoot.scenarios.log.channel import ENTRY, ChannelWriter, Slab, Waiting, message_index

Record = bytes | memoryview


def _index_dtype(count: int) -> np.dtype[np.void]:
    """A MessageIndex record of so many messages; what stands there without a sign fits with one."""
    head = [("opcode", "u1"), ("length", "<u8"), ("channel", "<u2"), ("size", "<u4")]
    return np.dtype([*head, ("entries", "<i8", (count, 2))])


@dataclass(frozen=True, slots=True)
class Block:
    """Messages of a chunk, uncompressed.

    Attributes:
        data: message records, in order of time; valid until the next block.
        start_ns: least time of its messages [ns].
        end_ns: greatest time of its messages [ns].
        indexes: MessageIndex record by channel id.
        counts: messages by channel id.
    """

    data: memoryview
    start_ns: int
    end_ns: int
    indexes: dict[int, bytes]
    counts: dict[int, int]


class BlockMaker:
    """Makes blocks in memory that is taken once, and grows to the greatest block."""

    def __init__(self) -> None:
        self._memory = bytearray()

    def block(self, waiting: Sequence[Waiting]) -> Block:
        """Take what waits in channels, of which each has messages.

        Most of it are messages of the control ticks, which make up the rows of a table; all others go between them.
        """
        size = sum([channel.complete() for channel in waiting])
        if len(self._memory) < size:
            self._memory = bytearray(size)
        data = memoryview(self._memory)[:size]
        table = _Table(_alike(waiting))
        others = [channel for channel in waiting if channel not in table.channels]
        entries: dict[int, list[int]] = {channel.channel_id: [] for channel in others}
        between = [(time, number, record) for channel in others for time, number, record in channel.each()]
        between.sort(key=itemgetter(0))
        rows = table.put(data, between, entries)
        indexes = table.indexes(rows)
        for number, flat in entries.items():
            indexes[number] = message_index(number, flat)
        start, end = min([channel.times[0] for channel in waiting]), max([channel.times[-1] for channel in waiting])
        counts = {channel.channel_id: channel.count for channel in waiting}
        for channel in waiting:
            channel.taken()
        return Block(data, start, end, indexes, counts)


def _alike(waiting: Sequence[Waiting]) -> list[ChannelWriter]:
    """Channels of fixed layouts whose messages have the same times: the group with most bytes."""
    by_list: dict[int, list[ChannelWriter]] = {}
    for channel in waiting:
        if isinstance(channel, ChannelWriter):
            by_list.setdefault(id(channel.times), []).append(channel)
    sheets: list[list[ChannelWriter]] = []
    for channels in by_list.values():
        for sheet in sheets:
            if sheet[0].times == channels[0].times:
                sheet += channels
                break
        else:
            sheets.append(channels)
    return max(sheets, key=_size, default=[])


def _size(channels: Sequence[ChannelWriter]) -> int:
    return sum(channel.count * channel.size for channel in channels)


class _Table:
    """Channels whose messages have the same times: a row for each time, and in it the message of each channel.

    Args:
        channels: of fixed layouts; perhaps none.

    Attributes:
        channels: they themselves.
    """

    def __init__(self, channels: list[ChannelWriter]) -> None:
        self.channels = channels
        self._times = channels[0].times if channels else []
        self._slabs: dict[Slab, int] = {}
        self._width = 0
        for slab in dict.fromkeys(channel.slab for channel in channels):
            self._slabs[slab] = self._width
            self._width += slab.width

    def put(
        self, data: memoryview, others: Sequence[tuple[int, int, Record]], entries: Mapping[int, list[int]]
    ) -> NDArray[np.int64]:
        """Fill data with the rows and other messages, each of which goes behind the row of its time.

        Args:
            data: of the size of all.
            others: time [ns], channel id and record of each, in order of time.
            entries: get time [ns] and place [bytes] of each of them, by channel id.

        Returns:
            where the rows begin, shape (n,) [bytes].
        """
        times, width = self._times, self._width
        rows, done, between = width * np.arange(len(times)), 0, 0
        for time, number, record in others:
            cut = bisect_right(times, time, lo=done)
            if cut > done:
                rows[done:cut] += between
                done = cut
            place = cut * width + between
            between += len(record)
            data[place : cut * width + between] = record
            entries[number] += (time, place)
        rows[done:] += between
        for slab, start in self._slabs.items():
            # Each byte of the data as the beginning of a piece of a row, so that all pieces go to their places at once.
            begins = np.ndarray((len(data) - slab.width + 1,), slab.rows.dtype, data, strides=(1,))
            begins[rows + start] = slab.rows[: len(rows)]
        return rows

    def indexes(self, rows: NDArray[np.int64]) -> dict[int, bytes]:
        """MessageIndex record of each channel by its id, for rows that begin at these places, shape (n,) [bytes]."""
        count = len(rows)
        records = np.empty(len(self.channels), _index_dtype(count))
        size = ENTRY * count
        records["opcode"], records["length"], records["size"] = Opcode.MESSAGE_INDEX, size + 6, size
        records["channel"] = numbers = [channel.channel_id for channel in self.channels]
        starts = np.array([self._slabs[channel.slab] + channel.column for channel in self.channels], np.int64)
        records["entries"][:, :, 0] = self._times
        records["entries"][:, :, 1] = np.add.outer(starts, rows)
        whole, size = records.tobytes(), records.dtype.itemsize
        return {number: whole[k * size : (k + 1) * size] for k, number in enumerate(numbers)}
