"""Bytes of MCAP records: compression of chunks, encoding, and the summary at the end of a file."""

import struct
import zlib
from collections.abc import Mapping, Sequence
from itertools import chain

import lz4.frame
import zstandard
from mcap import records
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode

from surefoot.scenarios.errors import LogError

_LENGTH = struct.Struct("<I")

_LZ4_LEVEL = -4
"""In blocks for themselves it takes half the time of the default, for 5 % more bytes of a log."""

GREATEST_CHUNK = 1 << 26
"""No sound chunk holds more; a size that is damaged, or made to hurt, must not exhaust the memory [bytes]."""


def compress(data: bytes | memoryview, method: str) -> bytes:
    """Compress a chunk by lz4, zstd or, for an empty method, not at all."""
    if method == "lz4":
        return bytes(lz4.frame.compress(data, store_size=True, compression_level=_LZ4_LEVEL, block_linked=False))
    return zstandard.compress(data) if method == "zstd" else bytes(data)


def decompress(data: bytes | memoryview, method: str, size: int) -> bytes:
    """Decompress a chunk, of which so many bytes must come out, by a method of `compress`.

    Raises:
        LogError: the bytes are damaged or the method is unknown.
    """
    if size > GREATEST_CHUNK:
        raise LogError(f"a chunk states {size} bytes, more than the {GREATEST_CHUNK} that one may hold; it is damaged")
    try:
        if method == "lz4":
            whole = lz4.frame.LZ4FrameDecompressor().decompress(data, max_length=size + 1)
        elif method == "zstd":
            whole = _unzstd(data, size)
        elif method == "":
            whole = bytes(data)
        else:
            raise LogError(f"chunk compression '{method}' is unknown; use lz4, zstd or none")
    except (RuntimeError, zstandard.ZstdError, MemoryError, ValueError, OverflowError, EOFError):
        raise LogError("a chunk does not decompress; its bytes are damaged") from None
    if len(whole) != size:
        raise LogError(f"a chunk holds {len(whole)} bytes where it states {size}; its bytes are damaged")
    return bytes(whole)


def _unzstd(data: bytes | memoryview, size: int) -> bytes:
    """At most one byte more than there should be, whatever the frame says of its size."""
    with zstandard.ZstdDecompressor().stream_reader(data) as reader:
        return reader.read(size + 1)


MAGIC = b"\x89MCAP0\r\n"


def encoded(record: records.McapRecord) -> bytes:
    """Encode a record with its opcode and length."""
    builder = RecordBuilder()
    record.write(builder)
    return bytes(builder.end())  # type: ignore[no-untyped-call]


def _metadata(record: records.Metadata) -> bytes:
    """`encoded` of metadata, in a fifth of its time."""
    texts = [text.encode() for text in (record.name, *chain.from_iterable(record.metadata.items()))]
    name, *pairs = (_LENGTH.pack(len(text)) + text for text in texts)
    length = sum(map(len, pairs))
    return struct.pack("<BQ", Opcode.METADATA, len(name) + 4 + length) + name + _LENGTH.pack(length) + b"".join(pairs)


def _attachment(record: records.Attachment) -> bytes:
    """`encoded` of an attachment, whose bytes are copied once."""
    names = (_LENGTH.pack(len(name)) + name for name in (record.name.encode(), record.media_type.encode()))
    times, size = struct.pack("<QQ", record.log_time, record.create_time), struct.pack("<Q", len(record.data))
    body = b"".join((times, *names, size, record.data))
    return b"".join((struct.pack("<BQ", Opcode.ATTACHMENT, len(body) + 4), body, _LENGTH.pack(zlib.crc32(body))))


def chunk_head(chunk: records.Chunk) -> bytes:
    """Encode a chunk's record up to its data, which follow as they are: they are not copied once more."""
    method, size = chunk.compression.encode(), len(chunk.data)
    times = (chunk.message_start_time, chunk.message_end_time, chunk.uncompressed_size, chunk.uncompressed_crc)
    body = struct.pack(f"<QQQII{len(method)}sQ", *times, len(method), method, size)
    return struct.pack("<BQ", Opcode.CHUNK, len(body) + size) + body


def _chunk_index(
    chunk: records.Chunk, position: int, length: int, offsets: Mapping[int, int], index_length: int
) -> bytes:
    """Encode a `records.ChunkIndex`, of which there is one for each chunk, in a fifth of the time of `encoded`."""
    method, places = chunk.compression.encode(), tuple(chain.from_iterable(offsets.items()))
    body = struct.pack(
        f"<QQQQI{'HQ' * len(offsets)}QI{len(method)}sQQ",
        chunk.message_start_time, chunk.message_end_time, position, length, 10 * len(offsets), *places,
        index_length, len(method), method, len(chunk.data), chunk.uncompressed_size,
    )  # fmt: skip
    return struct.pack("<BQ", Opcode.CHUNK_INDEX, len(body)) + body


class Packed:
    """Records that wait for the end of a file, compressed: those of an hour's walk are many megabytes.

    Attributes:
        count: how many there are.
    """

    _BLOCK = 1 << 18

    def __init__(self) -> None:
        self.count = 0
        self._blocks: list[bytes] = []
        self._last = bytearray()

    def append(self, record: bytes) -> None:
        """Add a record."""
        self.count += 1
        self._last += record
        if len(self._last) >= self._BLOCK:
            self._blocks.append(zstandard.compress(bytes(self._last)))
            self._last = bytearray()

    def __bytes__(self) -> bytes:
        """All of them in order."""
        return b"".join((*map(zstandard.decompress, self._blocks), self._last))


class Summary:
    """Everything a reader wants to know before it reads the messages."""

    def __init__(self) -> None:
        self._schemas: dict[int, bytes] = {}
        self._channels: list[bytes] = []
        self._chunks = Packed()
        self._times: tuple[int, int] | None = None
        self._attachments: list[records.AttachmentIndex] = []
        self._metadata: list[records.MetadataIndex] = []

    def add_channel(self, schema_id: int, schema: bytes | None, channel: bytes) -> None:
        """Note the record of a channel and that of its schema, when it is new."""
        if schema is not None:
            self._schemas.setdefault(schema_id, schema)
        self._channels.append(channel)

    def add_metadata(self, record: records.Metadata, position: int) -> bytes:
        """Note a metadata record at a file position and encode it."""
        data = _metadata(record)
        self._metadata.append(records.MetadataIndex(position, len(data), record.name))
        return data

    def add_attachment(self, record: records.Attachment, position: int) -> bytes:
        """Note an attachment at a file position and encode it."""
        data = _attachment(record)
        size = len(record.data)
        stamps = (record.log_time, record.create_time)
        self._attachments.append(
            records.AttachmentIndex(position, len(data), *stamps, size, record.name, record.media_type)
        )
        return data

    def add_chunk(self, chunk: records.Chunk, position: int, length: int, indexes: Sequence[tuple[int, bytes]]) -> None:
        """Note a chunk of `length` bytes at a file position, followed by the MessageIndex records of its channels."""
        offsets, end = {}, position + length
        for channel_id, index in indexes:
            offsets[channel_id] = end
            end += len(index)
        self._chunks.append(_chunk_index(chunk, position, length, offsets, end - position - length))
        first, last = self._times or (chunk.message_start_time, chunk.message_end_time)
        self._times = min(first, chunk.message_start_time), max(last, chunk.message_end_time)

    def finish(self, position: int, counts: Mapping[int, int], crc: int) -> bytes:
        """Give the end of the file at a position: end of data with the CRC-32 of all before, summary, footer, magic."""
        end = encoded(records.DataEnd(crc))
        start = position + len(end)
        groups: list[tuple[Opcode, list[bytes]]] = [
            (Opcode.SCHEMA, [*self._schemas.values()]),
            (Opcode.CHANNEL, self._channels),
            (Opcode.STATISTICS, [encoded(self._statistics(counts))]),
            (Opcode.CHUNK_INDEX, [bytes(self._chunks)]),
            (Opcode.ATTACHMENT_INDEX, [*map(encoded, self._attachments)]),
            (Opcode.METADATA_INDEX, [*map(encoded, self._metadata)]),
        ]
        summary, offsets = bytearray(), bytearray()
        for opcode, group in groups:
            data = b"".join(group)
            if data:
                offsets += encoded(records.SummaryOffset(opcode, start + len(summary), len(data)))
                summary += data
        offset_start = start + len(summary)
        summary += offsets
        footer = encoded(records.Footer(start, offset_start, 0))
        summary_crc = zlib.crc32(footer[:-4], zlib.crc32(summary))
        return b"".join((end, summary, encoded(records.Footer(start, offset_start, summary_crc)), MAGIC))

    def _statistics(self, counts: Mapping[int, int]) -> records.Statistics:
        start, end = self._times or (0, 0)
        return records.Statistics(
            attachment_count=len(self._attachments),
            channel_count=len(self._channels),
            channel_message_counts=dict(counts),
            chunk_count=self._chunks.count,
            message_count=sum(counts.values()),
            message_end_time=end,
            message_start_time=start,
            metadata_count=len(self._metadata),
            schema_count=len(self._schemas),
        )
