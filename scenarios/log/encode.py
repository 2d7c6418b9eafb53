"""Bytes of MCAP records."""

import struct

from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import Chunk, McapRecord

MAGIC = b"\x89MCAP0\r\n"


def encoded(record: McapRecord) -> bytes:
    """Encode a record with its opcode and length."""
    builder = RecordBuilder()
    record.write(builder)
    return bytes(builder.end())  # type: ignore[no-untyped-call]


def chunk_head(chunk: Chunk) -> bytes:
    """Encode a chunk's record up to its data, which follow as they are: they are not copied once more."""
    method, size = chunk.compression.encode(), len(chunk.data)
    times = (chunk.message_start_time, chunk.message_end_time, chunk.uncompressed_size, chunk.uncompressed_crc)
    body = struct.pack(f"<QQQII{len(method)}sQ", *times, len(method), method, size)
    return struct.pack("<BQ", Opcode.CHUNK, len(body) + size) + body
