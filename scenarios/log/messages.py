"""Messages of one channel: out of a block of bytes, and as numpy arrays by field name."""

import struct
from collections.abc import Collection, Mapping
from typing import Any

import numpy as np
from mcap.opcode import Opcode
from numpy.typing import NDArray

from surefoot.scenarios.errors import LogError, nearest
from surefoot.scenarios.log.scan import PREFIX, Buffer, ChunkPlace
from surefoot.scenarios.log.spec import PREFIX_BYTES, FieldSpec

MESSAGE_BYTES = PREFIX_BYTES + 22
"""A message record without its content."""

_HEAD = struct.Struct("<BQH")
"""Opcode, length and channel, with which it begins."""


def content_at(data: Buffer, offset: int) -> bytes:
    """Content of the message record at an offset; cut where the data end."""
    _, length = PREFIX.unpack_from(data, offset)
    return bytes(data[offset + MESSAGE_BYTES : offset + PREFIX_BYTES + length])


def numbered_at(data: Buffer, offset: int) -> bytes:
    """The same from its sequence number on, by which two messages of one content are distinguished."""
    number = offset + _HEAD.size
    return bytes(data[number : number + 4]) + content_at(data, offset)


def block_of(data: memoryview, chunk: ChunkPlace, channel_id: int, size: int, file: Buffer) -> memoryview | bytes:
    """Bytes of a channel's messages of `size` bytes, one after the other; those beyond the chunk are left out.

    Where the first and the last one are as far apart as their number says, they stand in a row, as in logs of others
    and of earlier versions; `sound_records` shows whether they do.

    Args:
        data: the decompressed chunk.
        chunk: its place.
        channel_id: the channel, which has messages in it.
        size: of a message record.
        file: bytes of the file.
    """
    first, last = chunk.extent(channel_id, file)
    if last - first == (chunk.count(channel_id) - 1) * size and last + size <= len(data):
        return data[first : last + size]
    return gathered(data, chunk.entries(channel_id, file), size)


def gathered(data: memoryview, index: NDArray[np.void], size: int) -> memoryview | bytes:
    """Bytes of messages that stand anywhere, one after the other; those beyond the data are left out."""
    offsets = index["offset"]
    if len(offsets) and offsets.max() > len(data) - size:
        offsets = offsets[offsets + size <= len(data)] if len(data) >= size else offsets[:0]
    if not len(offsets):
        return b""
    # Each byte of the data as the beginning of a record: all are gathered at once.
    records: NDArray[np.void] = np.ndarray((len(data) - size + 1,), f"V{size}", data, strides=(1,))
    found: NDArray[np.uint8] = records[offsets].view(np.uint8)
    return found.data


def sound_records(block: NDArray[np.uint8], channel_id: int, dtype: np.dtype[Any]) -> NDArray[np.void]:
    """Message records of one channel out of whole records one after the other; others are left out."""
    records = block.view(dtype)
    head = np.frombuffer(_HEAD.pack(Opcode.MESSAGE, dtype.itemsize - PREFIX_BYTES, channel_id), np.uint8)
    sound = block.reshape(-1, dtype.itemsize)[:, : _HEAD.size] == head
    return records if sound.all() else records[sound.all(axis=1)]


class ChannelData:
    """The messages of one channel in order of time.

    Attributes:
        topic: the channel's topic.
        fields: its fields, each with its unit, frame and meaning.
        joints: names of the robot's joints, by which columns are called; () when the log does not say.
    """

    def __init__(
        self, topic: str, fields: tuple[FieldSpec, ...], records: NDArray[np.void], joints: tuple[str, ...] = ()
    ) -> None:
        times = records["_log_time"].astype(np.int64)
        if np.any(times[1:] < times[:-1]):
            order = np.argsort(times, kind="stable")
            times, records = times[order], records[order]
        self.topic = topic
        self.fields = fields
        self.joints = joints
        self._times: NDArray[np.int64] = times
        self._records = records

    def __len__(self) -> int:
        return len(self._records)

    @property
    def time_ns(self) -> NDArray[np.int64]:
        """Simulated time of each message, shape (n,) [ns]."""
        return self._times

    @property
    def time(self) -> NDArray[np.float64]:
        """Simulated time of each message, shape (n,) [s]."""
        return np.asarray(self.time_ns / 1e9)

    @classmethod
    def of(
        cls,
        topic: str,
        fields: tuple[FieldSpec, ...],
        time_ns: NDArray[np.int64],
        columns: Mapping[str, NDArray[Any]],
        joints: tuple[str, ...] = (),
    ) -> "ChannelData":
        """Messages of given times, shape (n,) [ns], and values of each field, shape (n, *field shape)."""
        kinds = [(field.name, columns[field.name].dtype, field.shape) for field in fields]
        records = np.empty(len(time_ns), np.dtype([("_log_time", np.int64), *kinds]))
        records["_log_time"] = time_ns
        for name, values in columns.items():
            records[name] = values
        return cls(topic, fields, records, joints)

    def from_row(self, row: int) -> "ChannelData":
        """The messages from a row on."""
        return ChannelData(self.topic, self.fields, self._records[row:], self.joints)

    def between(self, start_ns: int, end_ns: int) -> "ChannelData":
        """The messages from a time on and up to another one [ns]."""
        first, last = np.searchsorted(self.time_ns, (start_ns, end_ns + 1)).tolist()
        if first == 0 and last == len(self):
            return self
        return ChannelData(self.topic, self.fields, self._records[first:last], self.joints)

    def joined(self, following: "ChannelData") -> "ChannelData":
        """Join these messages and those that follow."""
        if not len(self) or not len(following):
            return following if not len(self) else self
        records = np.concatenate((self._records, following._records))
        return ChannelData(self.topic, self.fields, records, self.joints)

    def content(self) -> bytes:
        """Bytes of all messages in order, for exact comparison of two runs."""
        return self._records.tobytes()

    def field(self, name: str) -> NDArray[Any]:
        """Values of one field, shape (n, *field shape).

        Raises:
            LogError: the channel has no such field.
        """
        self._chosen(name)
        return self.values((name,))[name]

    def values(self, names: Collection[str]) -> dict[str, NDArray[Any]]:
        """Values of several fields that the channel has, by name, each of shape (n, *field shape)."""
        return {name: np.array(self._records[name]) for name in names}

    def columns(self) -> dict[str, NDArray[Any]]:
        """Time [s] and every element of every field as ``name_i_j`` or ``name.joint``, each of shape (n,)."""
        found = self.values([field.name for field in self.fields])
        table: dict[str, NDArray[Any]] = {"time": self.time}
        for field in self.fields:
            values = np.moveaxis(found[field.name], 0, -1)
            table |= {column.name: values[column.place] for column in field.columns(self.joints)}
        return table

    def frame(self, pandas: Any) -> Any:
        """The messages as a data frame; see `Log.frame`, which imports the package."""
        found = self.values([field.name for field in self.fields])
        index = pandas.Index(self.time, name="time")
        parts = [pandas.DataFrame(index=index)]
        for field in self.fields:
            names = [column.name for column in field.columns(self.joints)]
            # A field at a time, by its own memory: a table of all columns would hold them twice.
            parts.append(pandas.DataFrame(found.pop(field.name).reshape(len(index), -1), index, names, copy=False))
        frame = pandas.concat(parts, axis=1)
        frame.attrs.update(self.notes())
        return frame

    def notes(self) -> dict[str, dict[str, str]]:
        """Unit, frame and meaning (``doc``) of each of the `columns`."""
        table = {"time": {"unit": "s", "frame": "", "doc": "simulated time"}}
        for field in self.fields:
            for column in field.columns(self.joints):
                table[column.name] = {"unit": column.unit, "frame": field.frame, "doc": field.doc}
        return table

    def only(self, name: str) -> "ChannelData":
        """The same messages with one field; LogError if the channel has no such field."""
        return ChannelData(self.topic, self._chosen(name), self._records, self.joints)

    def _chosen(self, name: str) -> tuple[FieldSpec, ...]:
        """The field of a name, alone; or a LogError."""
        chosen = tuple(field for field in self.fields if field.name == name)
        if not chosen:
            right = nearest(name, [field.name for field in self.fields])
            raise LogError(f"channel {self.topic} has no field '{name}'; {right}")
        return chosen
