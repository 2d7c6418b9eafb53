"""All that the stock ``mcap doctor`` says of a file, written anew after its source; with a strict order of messages."""

import struct
import zlib
from io import BytesIO
from pathlib import Path
from typing import Any

import lz4.frame
import zstandard
from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import Attachment, Channel, Chunk, ChunkIndex, DataEnd, Footer, Header, Message, Schema, Statistics

_MAGIC = b"\x89MCAP0\r\n"


class _Doctor:
    def __init__(self, data: bytes) -> None:
        self.data, self.said = data, []
        self.schemas: dict[int, Schema] = {}
        self.channels: dict[int, Channel] = {}
        self.in_chunks: dict[int, set[int]] = {}
        self.indexes: dict[int, ChunkIndex] = {}
        self.summary: tuple[set[int], set[int]] = set(), set()
        self.statistics: Statistics | None = None
        self.latest, self.times = -1, []
        self.ended = self.footer = False

    def run(self) -> list[str]:
        if not (self.data.startswith(_MAGIC) and self.data.endswith(_MAGIC)):
            return ["no magic at the beginning or the end"]
        position = len(_MAGIC)
        while position + 9 <= len(self.data) - len(_MAGIC):
            opcode, length = struct.unpack_from("<BQ", self.data, position)
            self._top(opcode, self.data[position + 9 : position + 9 + length], position)
            position += 9 + length
        if not (self.ended and self.footer):
            self.said.append("no record of the end of data, or no footer")
        self._indexes()
        self._statistics()
        return self.said

    def _top(self, opcode: int, body: bytes, position: int) -> None:
        def record(kind: Any) -> Any:
            return kind.read(_stream(body))

        if opcode == Opcode.HEADER:
            header = record(Header)
            if not header.library:
                self.said.append("no library in the header")
            if header.profile not in ("", "ros1", "ros2"):
                self.said.append("unknown profile")
        elif opcode == Opcode.FOOTER:
            footer, self.footer = record(Footer), True
            if footer.summary_crc:
                counted = self.data[footer.summary_start : position + 9 + 16]
                self._same("CRC of the summary", footer.summary_crc, zlib.crc32(counted))
        elif opcode == Opcode.DATA_END:
            self.ended = True
            end = record(DataEnd)
            if end.data_section_crc:
                self._same("CRC of the data", end.data_section_crc, zlib.crc32(self.data[:position]))
        elif opcode == Opcode.SCHEMA:
            self._schema(record(Schema))
        elif opcode == Opcode.CHANNEL:
            self._channel(record(Channel))
        elif opcode == Opcode.MESSAGE:
            self._message(record(Message))
        elif opcode == Opcode.CHUNK:
            self._chunk(record(Chunk), position)
        elif opcode == Opcode.CHUNK_INDEX:
            index = record(ChunkIndex)
            if index.chunk_start_offset in self.indexes:
                self.said.append("several indexes of one chunk")
            self.indexes[index.chunk_start_offset] = index
        elif opcode == Opcode.STATISTICS:
            if self.statistics is not None:
                self.said.append("several statistics")
            self.statistics = record(Statistics)
            for number in self.channels.keys() | self.statistics.channel_message_counts.keys():
                if number not in self.summary[1]:
                    self.said.append(f"channel {number} is not in the summary before the statistics")
        elif opcode == Opcode.ATTACHMENT:
            attachment = record(Attachment)
            crc = struct.unpack("<I", body[-4:])[0]
            self._same(f"CRC of {attachment.name}", crc, zlib.crc32(body[:-4]))
        elif opcode > Opcode.DATA_END:
            self.said.append(f"unknown record {opcode}")

    def _schema(self, schema: Schema) -> None:
        if schema.id == 0 or not schema.encoding:
            self.said.append(f"schema {schema.id} without a number or an encoding")
        before = self.schemas.get(schema.id)
        if before is not None and before != schema:
            self.said.append(f"two schemas {schema.id}")
        if self.ended:
            if before is None:
                self.said.append(f"schema {schema.id} in the summary alone")
            self.summary[0].add(schema.id)
        elif before is not None:
            self.said.append(f"schema {schema.id} twice")
        self.schemas.setdefault(schema.id, schema)

    def _channel(self, channel: Channel) -> None:
        before = self.channels.get(channel.id)
        if before is not None and before != channel:
            self.said.append(f"two channels {channel.id}")
        if self.ended:
            if before is None:
                self.said.append(f"channel {channel.id} in the summary alone")
            self.summary[1].add(channel.id)
        elif before is not None:
            self.said.append(f"channel {channel.id} twice")
        self.channels.setdefault(channel.id, channel)
        if channel.schema_id and channel.schema_id not in self.schemas:
            self.said.append(f"channel {channel.id} without its schema")

    def _message(self, message: Message) -> None:
        if message.channel_id not in self.channels:
            self.said.append(f"a message before channel {message.channel_id}")
        if message.log_time < self.latest:
            topic = self.channels[message.channel_id].topic
            self.said.append(f"a message of {topic} at {message.log_time} after one at {self.latest}")
        self.latest = max(self.latest, message.log_time)
        self.times.append(message.log_time)

    def _chunk(self, chunk: Chunk, position: int) -> None:
        data = _unpacked(chunk)
        self._same("size of a chunk", chunk.uncompressed_size, len(data))
        if chunk.uncompressed_crc:
            self._same("CRC of a chunk", chunk.uncompressed_crc, zlib.crc32(data))
        first, at, channels = len(self.times), 0, set()
        while at < len(data):
            opcode, length = struct.unpack_from("<BQ", data, at)
            body = data[at + 9 : at + 9 + length]
            if opcode == Opcode.MESSAGE:
                message = Message.read(_stream(body), length)
                channels.add(message.channel_id)
                self._message(message)
            elif opcode == Opcode.SCHEMA:
                self._schema(Schema.read(_stream(body)))
            elif opcode == Opcode.CHANNEL:
                self._channel(Channel.read(_stream(body)))
            else:
                self.said.append(f"record {opcode} in a chunk")
            at += 9 + length
        if own := self.times[first:]:
            self._same("first time of a chunk", chunk.message_start_time, min(own))
            self._same("last time of a chunk", chunk.message_end_time, max(own))
        self.in_chunks[position] = channels

    def _indexes(self) -> None:
        for position, index in self.indexes.items():
            for number in self.in_chunks.get(position, ()):
                if number not in self.summary[1] or self.channels[number].schema_id not in self.summary[0]:
                    self.said.append(f"channel {number} or its schema is not in the summary")
            if self.data[position] != Opcode.CHUNK:
                self.said.append(f"no chunk at {position}")
                continue
            (length,) = struct.unpack_from("<Q", self.data, position + 1)
            chunk = Chunk.read(_stream(self.data[position + 9 : position + 9 + length]))
            self._same("length of a chunk", index.chunk_length, 9 + length)
            pairs = (
                (chunk.message_start_time, index.message_start_time),
                (chunk.message_end_time, index.message_end_time),
                (chunk.compression, index.compression),
                (len(chunk.data), index.compressed_size),
                (chunk.uncompressed_size, index.uncompressed_size),
            )
            for stated, found in pairs:
                self._same(f"index of the chunk at {position}", stated, found)

    def _statistics(self) -> None:
        told = self.statistics
        if told is None:
            return
        if self.times:
            self._same("first time", told.message_start_time, min(self.times))
            self._same("last time", told.message_end_time, max(self.times))
        self._same("number of messages", told.message_count, len(self.times))

    def _same(self, what: str, stated: object, found: object) -> None:
        if stated != found:
            self.said.append(f"{what}: {stated} is stated, {found} is there")


def _stream(body: bytes) -> ReadDataStream:
    return ReadDataStream(BytesIO(body))


def _unpacked(chunk: Chunk) -> bytes:
    if chunk.compression == "lz4":
        return bytes(lz4.frame.decompress(chunk.data))
    return zstandard.decompress(chunk.data) if chunk.compression == "zstd" else chunk.data


def complaints(path: Path) -> list[str]:
    """Complaints of the doctor about a file, one sentence each."""
    return _Doctor(path.read_bytes()).run()
