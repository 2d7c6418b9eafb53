"""Walks the records of a log file, whole or not: what is there, where, and what could not be read."""

import mmap
import struct
import zlib
from array import array
from bisect import bisect_right
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from io import BytesIO
from typing import Any, TypeVar

import numpy as np
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Attachment, Channel, ChunkIndex, Footer, Metadata, Schema, Statistics
from numpy.typing import NDArray

from surefoot.scenarios.log.encoding import MAGIC

Buffer = Any
"""A read-only bytes-like object: bytes or a memory map."""

INDEX_ENTRY = np.dtype([("time", "<u8"), ("offset", "<u8")])
PREFIX = struct.Struct("<BQ")
_INDEX_HEAD = struct.Struct("<HI")
_OFFSET = struct.Struct("<Q")
_INDEX_RECORD = struct.Struct("<BQHI")
_RELEASE_BYTES = 1 << 25
_CHUNK = struct.Struct("<QQQII")
_CRC = _LENGTH = struct.Struct("<I")
_length = _LENGTH.unpack_from
_MESSAGE = struct.Struct("<HIQQ")
_PRIVATE = 0x80
_DATA_ALONE = {
    *(Opcode.HEADER, Opcode.MESSAGE, Opcode.CHUNK, Opcode.MESSAGE_INDEX, Opcode.ATTACHMENT, Opcode.METADATA),
    Opcode.DATA_END,
}
"""Records that stand before the end of the data alone."""

_T = TypeVar("_T")
_D = TypeVar("_D", Schema, Channel)


@dataclass(slots=True)
class ChunkPlace:
    """A chunk in the file.

    Attributes:
        position: of its record [bytes].
        length: of its record [bytes].
        start_ns: least time of its messages [ns].
        end_ns: greatest time of its messages [ns].
        size: uncompressed [bytes].
        crc: of the uncompressed bytes, 0 for none.
        compression: method.
        data: where its compressed bytes begin and end.
        places: of its index in the file, in threes: channel id, begin and end of the times and offsets of its messages.
            A dictionary would make this the greater part of what is held of a long log.
        made: the index itself by channel id, where the file has none that is sound.
        index_damaged: whether a part of the index could not be read, so that it must be made anew.
    """

    position: int
    length: int
    start_ns: int
    end_ns: int
    size: int
    crc: int
    compression: str
    data: slice
    places: "array[int]" = field(default_factory=lambda: array("Q"))
    made: dict[int, NDArray[np.void]] | None = None
    index_damaged: bool = False

    @property
    def channels(self) -> set[int]:
        """Ids of the channels that the chunk has messages of, by the index."""
        return set(self.places[::3] if self.made is None else self.made)

    @property
    def used(self) -> set[int]:
        """Channels of which it has a message."""
        if self.made is not None:
            return set(self.made)
        places = self.places
        return {places[at] for at in range(0, len(places), 3) if places[at + 2] > places[at + 1]}

    def count(self, channel_id: int) -> int:
        """Messages of a channel."""
        if self.made is not None:
            return len(self.made.get(channel_id, ()))
        start, stop = self.place(channel_id)
        return (stop - start) // INDEX_ENTRY.itemsize

    def entries(self, channel_id: int, data: Buffer) -> NDArray[np.void]:
        """Times and offsets of the messages of a channel that it has, out of the file's bytes."""
        if self.made is not None:
            return self.made[channel_id]
        return np.frombuffer(data[slice(*self.place(channel_id))], INDEX_ENTRY)

    def extent(self, channel_id: int, data: Buffer) -> tuple[int, int]:
        """Offsets of the first and the last message of a channel that has some, out of the file's bytes."""
        if self.made is not None:
            offsets = self.made[channel_id]["offset"]
            return int(offsets[0]), int(offsets[-1])
        start, stop = self.place(channel_id)
        return _OFFSET.unpack_from(data, start + 8)[0], _OFFSET.unpack_from(data, stop - 8)[0]

    def place(self, channel_id: int) -> tuple[int, int]:
        """Begin and end of a channel's index in the file."""
        places = self.places
        for at in range(0, len(places), 3):
            if places[at] == channel_id:
                return places[at + 1], places[at + 2]
        return 0, 0


@dataclass(slots=True)
class Contents:
    """The results of a scan.

    Attributes:
        schemas: by id, as the first record has it.
        channels: by id, as the first record has it.
        conflicts: schemas and channels that a later record defines otherwise, in words.
        chunks: in file order.
        loose: index of the messages outside chunks, by channel id.
        metadata: records in file order.
        attachments: in file order.
        data_end: where the record that ends the data begins; None when it is missing.
        data_crc: CRC-32 of everything before it by that record, 0 for none.
        truncated: whether the end of the file is missing.
        statistics: how much there is by the summary; None where it does not say.
        defined_last: schemas and channels in the summary, as kind and encoded record.
        index_sound: whether the summary agrees with its checksum, if it has one.
        behind: what follows the end of the file [bytes].
        another: whether that begins as a log does.
        known: positions of the chunks by the summary, once it was asked.
        damage: what could not be read, in words.
        faults: what contradicts the rest, in words.
    """

    schemas: dict[int, Schema] = field(default_factory=dict)
    channels: dict[int, Channel] = field(default_factory=dict)
    conflicts: list[str] = field(default_factory=list)
    chunks: list[ChunkPlace] = field(default_factory=list)
    loose: dict[int, list[tuple[int, int]]] = field(default_factory=dict)
    metadata: list[Metadata] = field(default_factory=list)
    attachments: list[Attachment] = field(default_factory=list)
    data_end: int | None = None
    data_crc: int = 0
    truncated: bool = True
    statistics: Statistics | None = None
    defined_last: list[tuple[int, bytes]] = field(default_factory=list)
    index_sound: bool = True
    behind: int = 0
    another: bool = False
    known: list[int] | None = None
    damage: list[str] = field(default_factory=list)
    faults: list[str] = field(default_factory=list)


def scan(data: Buffer) -> Contents:
    """Walk a file that begins with the MCAP magic."""
    contents = Contents()
    size, position, released = len(data), len(MAGIC), 0
    while position < size and contents.truncated:
        if position - released > _RELEASE_BYTES:
            release(data, released, position)
            released = position
        opcode, length = PREFIX.unpack_from(data, position) if position + PREFIX.size <= size else (0, size)
        body, end = position + PREFIX.size, position + PREFIX.size + length
        if end > size or not (0 < opcode <= Opcode.DATA_END or opcode >= _PRIVATE):
            position = _resume(data, position, contents)
            continue
        try:
            _take(opcode, data, position, slice(body, end), contents)
        except _UNREADABLE:
            contents.damage.append(f"the {_name(opcode)} record at byte {position} is damaged")
            if opcode == Opcode.MESSAGE_INDEX:
                contents.chunks[-1].index_damaged = True
        position = _take_indexes(data, end, contents) if opcode == Opcode.CHUNK else end
    release(data, released, size)
    if not contents.truncated:
        begin = position + len(MAGIC)
        contents.behind, contents.another = size - begin, data[begin : begin + len(MAGIC)] == MAGIC
    return contents


def release(data: Buffer, start: int, stop: int) -> None:
    """Let go of the memory of a range of a memory map, which stays readable: a long log need not be held whole."""
    if isinstance(data, mmap.mmap):
        page = mmap.ALLOCATIONGRANULARITY
        first = start - start % page
        data.madvise(mmap.MADV_DONTNEED, first, min(stop, len(data)) - first)


def records_in(data: Buffer) -> Iterator[tuple[int, int, slice]]:
    """Walk the records inside a decompressed chunk: opcode, offset of the record, place of its body."""
    position, size = 0, len(data)
    while position + PREFIX.size <= size:
        opcode, length = PREFIX.unpack_from(data, position)
        body = position + PREFIX.size
        if body + length > size:
            return
        yield opcode, position, slice(body, body + length)
        position = body + length


def take_definition(opcode: int, body: bytes, contents: Contents) -> None:
    """Note a schema or channel record inside a chunk; one that stands there again has to be the same."""
    try:
        _define(opcode, body, contents)
    except _UNREADABLE:
        contents.damage.append(f"a {_name(opcode)} record in a chunk is damaged")


def _define(opcode: int, body: bytes, contents: Contents) -> None:
    if opcode == Opcode.SCHEMA:
        schema = _decode(Schema.read, body)
        _agree(contents.schemas.setdefault(schema.id, schema), schema, "schema", contents)
    elif opcode == Opcode.CHANNEL:
        channel = _decode(Channel.read, body)
        if channel.id not in contents.channels:
            _keys_once(body, 4, 2, f"the metadata of {channel.topic}", contents)
        _agree(contents.channels.setdefault(channel.id, channel), channel, "channel", contents)


def _agree(first: _D, second: _D, what: str, contents: Contents) -> None:
    if first != second:
        names = [one.name if isinstance(one, Schema) else one.topic for one in (first, second)]
        apart = f"as {names[0]} and as {names[1]}" if names[0] != names[1] else f"as {names[0]}, in two ways"
        contents.conflicts.append(f"its {what} {first.id} is defined {apart}")


def _keys_once(body: bytes, at: int, texts: int, what: str, contents: Contents) -> None:
    """Look for a key that stands twice in the pairs of a record's body, behind so many texts from an offset on."""
    (length,), seen = _length(body, at), set()
    for _ in range(texts):
        at += _LENGTH.size + length
        (length,) = _length(body, at)
    at, end = at + _LENGTH.size, at + _LENGTH.size + length
    while at < end:
        (length,) = _length(body, at)
        key = body[at + _LENGTH.size : at + _LENGTH.size + length]
        if key in seen:
            contents.conflicts.append(f"{what} holds key '{key.decode(errors='replace')}' twice")
        seen.add(key)
        at += _LENGTH.size + length
        at += _LENGTH.size + _length(body, at)[0]


def index_chunk(data: bytes, contents: Contents) -> dict[int, NDArray[np.void]]:
    """Index the messages of a decompressed chunk by channel id, and note the schemas and channels it defines."""
    entries: dict[int, list[tuple[int, int]]] = {}
    for opcode, offset, body in records_in(data):
        if opcode == Opcode.MESSAGE and body.stop - body.start >= _MESSAGE.size:
            number, time = _message_header(data, body.start)
            entries.setdefault(number, []).append((time, offset))
        else:
            take_definition(opcode, data[body], contents)
    return {number: np.array(found, INDEX_ENTRY) for number, found in entries.items()}


def _take_indexes(data: Buffer, position: int, contents: Contents) -> int:
    """Take the sound indexes after a chunk, most of a file's records, in a tight loop; gives where they end."""
    unpack, size = _INDEX_RECORD.unpack_from, len(data) - _INDEX_RECORD.size
    places = contents.chunks[-1].places if contents.chunks else array("Q")
    while position <= size:
        opcode, length, channel_id, entries = unpack(data, position)
        start = position + _INDEX_RECORD.size
        end = start + entries
        if opcode != Opcode.MESSAGE_INDEX or length != entries + 6 or entries % INDEX_ENTRY.itemsize or end > len(data):
            break
        places.extend((channel_id, start, end))
        position = end
    return position


def _message_header(data: Buffer, body: int) -> tuple[int, int]:
    """Channel id and log time [ns] of a message record's body."""
    channel_id, _, log_time, _ = _MESSAGE.unpack_from(data, body)
    return channel_id, log_time


_UNREADABLE = (McapError, ValueError, struct.error, OverflowError, MemoryError)


def _take(opcode: int, data: Buffer, position: int, body: slice, contents: Contents) -> None:
    if contents.data_end is not None:
        _take_summary(opcode, data, position, body, contents)
    elif opcode == Opcode.DATA_END:
        (contents.data_crc,) = _CRC.unpack(data[body])
        contents.data_end = position
    elif opcode == Opcode.CHUNK:
        contents.chunks.append(_chunk(data, position, body))
    elif opcode == Opcode.MESSAGE_INDEX and contents.chunks:
        channel_id, length = _INDEX_HEAD.unpack_from(data, body.start)
        if length % INDEX_ENTRY.itemsize or body.start + _INDEX_HEAD.size + length > body.stop:
            raise ValueError("message index of no whole number of entries")
        start = body.start + _INDEX_HEAD.size
        contents.chunks[-1].places.extend((channel_id, start, start + length))
    elif opcode == Opcode.MESSAGE:
        channel_id, time = _message_header(data, body.start)
        contents.loose.setdefault(channel_id, []).append((time, position))
    elif opcode in (Opcode.SCHEMA, Opcode.CHANNEL):
        _define(opcode, data[body], contents)
    elif opcode == Opcode.METADATA:
        contents.metadata.append(_decode(Metadata.read, data[body]))
        _keys_once(data[body], 0, 1, f"metadata '{contents.metadata[-1].name}'", contents)
    elif opcode == Opcode.ATTACHMENT:
        contents.attachments.append(_decode(Attachment.read, data[body]))
        (crc,) = _CRC.unpack(data[body][-_CRC.size :])
        if crc and crc != zlib.crc32(data[body][: -_CRC.size]):
            contents.faults.append(f"attachment '{contents.attachments[-1].name}' does not agree with its checksum")
    elif opcode == Opcode.HEADER and position != len(MAGIC):
        contents.faults.append(f"a second header stands at byte {position}")


def _take_summary(opcode: int, data: Buffer, position: int, body: slice, contents: Contents) -> None:
    """Behind the data stand the end, how much there should be, and definitions again, or of chunks alone."""
    if opcode == Opcode.FOOTER:
        contents.truncated = data[body.stop : body.stop + len(MAGIC)] != MAGIC
        footer = _decode(Footer.read, data[body])
        crc = zlib.crc32(data[footer.summary_start : body.stop - _CRC.size]) if footer.summary_start else 0
        contents.index_sound = not footer.summary_crc or footer.summary_crc == crc
        for kind, record in contents.defined_last if contents.index_sound else ():
            _define(kind, record, contents)
    elif opcode == Opcode.STATISTICS:
        contents.statistics = _decode(Statistics.read, data[body])
    elif opcode in (Opcode.SCHEMA, Opcode.CHANNEL):
        contents.defined_last.append((opcode, data[body]))
    elif opcode in _DATA_ALONE:
        contents.faults.append(f"a {_name(opcode)} record stands at byte {position}, behind the end of the data")


def _chunk(data: Buffer, position: int, body: slice) -> ChunkPlace:
    start, end, size, crc, name_length = _CHUNK.unpack_from(data, body.start)
    name = body.start + _CHUNK.size
    (data_length,) = struct.unpack_from("<Q", data, name + name_length)
    begin = name + name_length + 8
    if begin + data_length > body.stop:
        raise ValueError("chunk longer than its record")
    compression = str(data[name : name + name_length], "utf-8")
    place = slice(begin, begin + data_length)
    return ChunkPlace(position, body.stop - position, start, end, size, crc, compression, place)


def _resume(data: Buffer, position: int, contents: Contents) -> int:
    """Position to read on from after a record that makes no sense: the next chunk that the file's own index knows."""
    if contents.known is None:
        contents.known = _indexed_chunks(data)
    following = next(iter(contents.known[bisect_right(contents.known, position) :]), None)
    if following is None:
        if data[-len(MAGIC) :] == MAGIC:
            contents.damage.append(f"nothing can be read from byte {position} on")
        return len(data)
    contents.damage.append(f"bytes {position} to {following} cannot be read")
    return following


def _indexed_chunks(data: Buffer) -> list[int]:
    """Positions of the chunks by the summary at the end of the file, if it is whole."""
    try:
        footer_at = len(data) - len(MAGIC) - PREFIX.size - 20
        if data[-len(MAGIC) :] != MAGIC or data[footer_at] != Opcode.FOOTER:
            return []
        summary = data[_decode(Footer.read, data[footer_at + PREFIX.size :]).summary_start : footer_at]
        indexes = [summary[body] for opcode, _, body in records_in(summary) if opcode == Opcode.CHUNK_INDEX]
        found = sorted({_decode(ChunkIndex.read, index).chunk_start_offset for index in indexes})
        return [start for start in found if start < len(data) and data[start] == Opcode.CHUNK]
    except (*_UNREADABLE, IndexError):
        return []


def _decode(read: Callable[[ReadDataStream], _T], body: bytes) -> _T:
    return read(ReadDataStream(BytesIO(body)))


def _name(opcode: int) -> str:
    return Opcode(opcode).name.lower().replace("_", " ") if opcode < _PRIVATE else "private"
