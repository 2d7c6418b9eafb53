"""The index at the end of a log, collected while the log is written."""

import zlib
from collections.abc import Callable, Mapping, Sequence

from mcap.opcode import Opcode
from mcap.records import (
    Attachment,
    AttachmentIndex,
    Channel,
    Chunk,
    ChunkIndex,
    DataEnd,
    Footer,
    McapRecord,
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
    SummaryOffset,
)

from scenarios.log.encode import MAGIC, encoded


class Summary:
    """Everything a reader wants to know before it reads the messages."""

    def __init__(self) -> None:
        self._schemas: list[Schema] = []
        self._channels: list[Channel] = []
        self._chunks: list[ChunkIndex] = []
        self._attachments: list[AttachmentIndex] = []
        self._metadata: list[MetadataIndex] = []

    def add_channel(self, schema: Schema | None, channel: Channel) -> None:
        """Note a channel and its schema, when it is new."""
        if schema is not None and all(known.id != schema.id for known in self._schemas):
            self._schemas.append(schema)
        self._channels.append(channel)

    def add_metadata(self, record: Metadata, position: int) -> bytes:
        """Note a metadata record at a file position and encode it."""
        data = encoded(record)
        self._metadata.append(MetadataIndex(position, len(data), record.name))
        return data

    def add_attachment(self, record: Attachment, position: int) -> bytes:
        """Note an attachment at a file position and encode it."""
        data = encoded(record)
        size = len(record.data)
        stamps = (record.log_time, record.create_time)
        self._attachments.append(AttachmentIndex(position, len(data), *stamps, size, record.name, record.media_type))
        return data

    def add_chunk(self, chunk: Chunk, position: int, length: int, indexes: Sequence[tuple[int, bytes]]) -> None:
        """Note a chunk of `length` bytes at a file position, followed by the MessageIndex records of its channels."""
        offsets, end = {}, position + length
        for channel_id, index in indexes:
            offsets[channel_id] = end
            end += len(index)
        entry = ChunkIndex(
            chunk_length=length,
            chunk_start_offset=position,
            compression=chunk.compression,
            compressed_size=len(chunk.data),
            message_end_time=chunk.message_end_time,
            message_index_length=end - position - length,
            message_index_offsets=offsets,
            message_start_time=chunk.message_start_time,
            uncompressed_size=chunk.uncompressed_size,
        )
        self._chunks.append(entry)

    def finish(self, position: int, counts: Mapping[int, int]) -> bytes:
        """Give the end of the file: end of data, summary, footer, magic.

        Args:
            position: where it will stand in the file.
            counts: messages by channel.
        """
        end = encoded(DataEnd(0))
        start = position + len(end)
        groups: list[tuple[Opcode, Sequence[McapRecord]]] = [
            (Opcode.SCHEMA, self._schemas),
            (Opcode.CHANNEL, self._channels),
            (Opcode.STATISTICS, [self._statistics(counts)]),
            (Opcode.CHUNK_INDEX, self._chunks),
            (Opcode.ATTACHMENT_INDEX, self._attachments),
            (Opcode.METADATA_INDEX, self._metadata),
        ]
        summary, offsets = bytearray(), bytearray()
        for opcode, records in groups:
            data = b"".join(encoded(record) for record in records)
            if data:
                offsets += encoded(SummaryOffset(opcode, start + len(summary), len(data)))
                summary += data
        offset_start = start + len(summary)
        summary += offsets
        footer = encoded(Footer(start, offset_start, 0))
        crc = zlib.crc32(footer[:-4], zlib.crc32(summary))
        return b"".join((end, summary, encoded(Footer(start, offset_start, crc)), MAGIC))

    def _statistics(self, counts: Mapping[int, int]) -> Statistics:
        def over_chunks(choose: Callable[..., int], name: str) -> int:
            return choose((getattr(chunk, name) for chunk in self._chunks), default=0)

        return Statistics(
            attachment_count=len(self._attachments),
            channel_count=len(self._channels),
            channel_message_counts=dict(counts),
            chunk_count=len(self._chunks),
            message_count=sum(counts.values()),
            message_end_time=over_chunks(max, "message_end_time"),
            message_start_time=over_chunks(min, "message_start_time"),
            metadata_count=len(self._metadata),
            schema_count=len(self._schemas),
        )
