"""Bytes of MCAP records."""

from mcap.data_stream import RecordBuilder
from mcap.records import McapRecord

MAGIC = b"\x89MCAP0\r\n"


def encoded(record: McapRecord) -> bytes:
    """Encode a record with its opcode and length."""
    builder = RecordBuilder()
    record.write(builder)
    return bytes(builder.end())  # type: ignore[no-untyped-call]
