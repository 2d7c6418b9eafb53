"""Writes a log: what the run was first, then a chunk of messages every few hundredths of a simulated second."""

import zlib
from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from types import TracebackType
from typing import Literal, Self

from mcap.records import Attachment, Channel, Chunk, Header, Metadata, Schema

from surefoot.native.library import library
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log.channel import ChannelWriter, Clock, MessageWriter, Waiting
from surefoot.scenarios.log.encoding import MAGIC, Summary, chunk_head, compress, encoded
from surefoot.scenarios.log.manifest import manifest
from surefoot.scenarios.log.rows import CompiledRows, RowLayout, RowWriter
from surefoot.scenarios.log.spec import PACKAGE, ChannelSpec
from surefoot.scenarios.output import reason
from surefoot.values import dataclass


class Output:
    """An unbuffered file that keeps only whole records.

    It never replaces another one, and a file that cannot be begun does not stay.

    Attributes:
        path: where the log is.
        position: bytes written.
        crc: CRC-32 of the bytes written.
    """

    __slots__ = ("_file", "crc", "path", "position")

    def __init__(self, path: Path, beginning: bytes) -> None:
        """Create the file with its beginning.

        Raises:
            LogError: it exists, cannot be created or the beginning does not fit.
        """
        self.path = path
        self.position = self.crc = 0
        try:
            self._file = path.open("xb", buffering=0)
        except FileExistsError:
            raise LogError(f"{path}: exists already; choose another file, or delete it") from None
        except OSError as error:
            raise LogError(f"{path}: cannot be created, {reason(error)}; choose another directory") from None
        try:
            self._write(beginning)
        except OSError as error:
            self._file.close()
            path.unlink(missing_ok=True)
            raise LogError(f"{path}: cannot be written, {reason(error)}; no log was created") from None

    def write(self, data: bytes) -> None:
        """Append whole records.

        Raises:
            LogError: they could not be written; the file then holds what came before, under the name ``*.incomplete``.
        """
        try:
            self._write(data)
        except OSError as error:
            kept = self._set_aside()
            message = f"{self.path}: cannot be written on, {reason(error)}; what was written is kept in {kept.name}"
            raise LogError(message) from None

    @property
    def closed(self) -> bool:
        """Whether nothing more can be written."""
        return self._file.closed

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def _write(self, data: bytes) -> None:
        rest = memoryview(data)
        while rest:
            rest = rest[self._file.write(rest) :]
        self.position += len(data)
        self.crc = zlib.crc32(data, self.crc)

    def _set_aside(self) -> Path:
        """Cut off the record that did not fit and take away the name of a log, if the other name is free."""
        kept = self.path.with_name(f"{self.path.name}.incomplete")
        self._file.truncate(self.position)
        self._file.close()
        if kept.exists():
            return self.path
        self.path.replace(kept)
        return kept


Compression = Literal["lz4", "zstd", ""]
CHUNK_PERIOD_NS = 90_000_000
"""Simulated time in one chunk: what a killed process loses at most, and the ticks in which it is written [ns]."""

_WRITING_NS = 8_000_000
"""Simulated time in which a chunk is written, a part at each tick, so that none takes long [ns]."""

_CAPACITY = 128
_PROFILE, _LIBRARY = "", "surefoot"


@dataclass(frozen=True, slots=True)
class AttachedFile:
    """A file inside the log."""

    name: str
    media_type: str
    data: bytes


@dataclass(frozen=True, slots=True)
class PublishedSchema:
    """A protobuf message type.

    Attributes:
        name: full name.
        descriptors: serialized ``FileDescriptorSet`` with everything that it refers to.
    """

    name: str
    descriptors: bytes


@lru_cache(maxsize=128)
def _defined(
    number: int, topic: str, schema: PublishedSchema, metadata: tuple[tuple[str, str], ...]
) -> tuple[bytes, bytes]:
    """Records of a schema and a channel, the same in run after run of a campaign."""
    return (
        encoded(Schema(number, schema.descriptors, "protobuf", schema.name)),
        encoded(Channel(number, topic, "protobuf", dict(metadata), number)),
    )


class LogWriter:
    """An MCAP file under way.

    Messages wait in their channels until a chunk is due, which is then written in one go; so the file on disk is
    always whole up to the last chunk. `close` adds the index. Usable as a context manager.

    Attributes:
        path: where the log is.
    """

    def __init__(
        self,
        path: Path,
        metadata: Mapping[str, Mapping[str, str]],
        attachments: Sequence[AttachedFile] = (),
        compression: Compression = "lz4",
    ) -> None:
        """Create the file; metadata and attachments are on disk when this returns.

        Args:
            path: file to create.
            metadata: named records of key and value.
            attachments: files to carry.
            compression: of the chunks.

        Raises:
            LogError: the file exists, or cannot be created or written; nothing of that name is then created.
        """
        self.path = path
        self._compression = compression
        self._summary = Summary()
        self._channels: list[Waiting] = []
        self._rows: list[RowWriter] = []
        self._begin_clock()
        beginning = bytearray(MAGIC + encoded(Header(_PROFILE, _LIBRARY)))
        head: list[Metadata | Attachment] = [Metadata(name, dict(values)) for name, values in metadata.items()]
        head += [Attachment(0, 0, file.name, file.media_type, file.data) for file in attachments]
        for record in (*head, *([manifest(head)] if head else ())):
            add = self._summary.add_metadata if isinstance(record, Metadata) else self._summary.add_attachment
            beginning += add(record, len(beginning))
        self._output = Output(path, bytes(beginning))

    def channel(self, spec: ChannelSpec) -> ChannelWriter:
        """Add a channel, before or between messages."""
        schema = PublishedSchema(f"{PACKAGE}.{spec.message}", spec.descriptors)
        number = self._define(spec.topic, schema, spec.metadata)
        writer = ChannelWriter(spec, number, _CAPACITY, self._clock)
        self._channels.append(writer)
        return writer

    def rows(self, layout: RowLayout) -> RowWriter:
        """Fill channels of one rate together; errors as of `RowWriter`."""
        kernels, derives = library(), layout.derive is not None and layout.compiled is None
        rows = (
            RowWriter(layout, _CAPACITY, self._clock)
            if kernels is None or derives
            else CompiledRows(layout, _CAPACITY, self._clock, kernels)
        )
        self._rows.append(rows)
        return rows

    def message_channel(self, topic: str, schema: PublishedSchema, doc: str) -> MessageWriter:
        """Add a channel of a published schema whose messages come encoded."""
        writer = MessageWriter(self._define(topic, schema, {"doc": doc}), self._clock)
        self._channels.append(writer)
        return writer

    def _define(self, topic: str, schema: PublishedSchema, metadata: Mapping[str, str]) -> int:
        """Write the schema and the channel; gives the channel's number."""
        number = len(self._channels) + 1
        records = _defined(number, topic, schema, tuple(metadata.items()))
        self._output.write(b"".join(records))
        self._summary.add_channel(number, *records)
        return number

    def attach(self, file: AttachedFile) -> None:
        """Write an attachment after everything appended so far."""
        self.flush()
        record = Attachment(0, 0, file.name, file.media_type, file.data)
        self._output.write(self._summary.add_attachment(record, self._output.position))

    def add_metadata(self, name: str, values: Mapping[str, str]) -> None:
        """Write a metadata record after everything appended so far."""
        self.flush()
        self._output.write(self._summary.add_metadata(Metadata(name, dict(values)), self._output.position))

    def flush(self) -> None:
        """Write what waits as one chunk, if anything waits."""
        for _ in self._writing:
            pass
        for _ in self._chunk():
            pass

    def _chunk(self) -> Iterator[None]:
        """Take what waits and write it as one chunk, in parts between which more may be appended."""
        for rows in self._rows:
            rows.spread()
        waiting = [channel for channel in self._channels if channel.count]
        if not waiting:
            return
        times = [channel.times for channel in waiting]
        start, end = min(map(min, times)), max(map(max, times))
        blocks, indexes, offset = [], [], 0
        for channel in waiting:
            block, index = channel.take(offset)
            blocks.append(block)
            indexes.append((channel.channel_id, index))
            offset += len(block)
        data = b"".join(blocks)
        crc = zlib.crc32(data)  # while the bytes are near
        yield
        packed = compress(data, self._compression)
        yield
        chunk = Chunk(self._compression, packed, end, start, crc, len(data))
        head = chunk_head(chunk)
        self._summary.add_chunk(chunk, self._output.position, len(head) + len(chunk.data), indexes)
        self._output.write(b"".join((head, chunk.data, *(index for _, index in indexes))))

    def close(self) -> None:
        """Write what waits and the index, and close the file; a second call does nothing."""
        if self._output.closed:
            return
        self.flush()
        counts = {channel.channel_id: channel.total for channel in self._channels}
        self._output.write(self._summary.finish(self._output.position, counts, self._output.crc))
        self._output.close()

    def discard(self) -> None:
        """Close and remove the file: there is no run to log."""
        self._output.close()
        self.path.unlink(missing_ok=True)

    def _begin_clock(self) -> None:
        self._writing: Iterator[None] = iter(())
        # The first is shorter: whole tenths of a second are when plans are made, too.
        self._next, self._late = CHUNK_PERIOD_NS - _WRITING_NS, 0
        self._clock = Clock(self._next, self._go_on, self._full)

    def _full(self, time_ns: int) -> None:
        self._next = self._clock.due = time_ns + CHUNK_PERIOD_NS
        self.flush()

    def _go_on(self, time_ns: int) -> None:
        """Begin a chunk, or write the next part of the one that is being written."""
        clock = self._clock
        if time_ns >= self._next:
            deque(self._writing, maxlen=0)  # of one that is under way still, after a gap in time
            self._next, self._late = time_ns + CHUNK_PERIOD_NS, time_ns + _WRITING_NS
            self._writing = self._chunk()
        elif time_ns >= self._late:
            deque(self._writing, maxlen=0)
        clock.due = time_ns + 1 if next(self._writing, self) is None else self._next

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


class NoLog(LogWriter):
    """Stands for a log where none is wanted: whatever records into it records into nothing."""

    def __init__(self) -> None:
        """Open nothing."""
        self._channels = []
        self._rows = []
        self._begin_clock()

    def _define(self, topic: str, schema: PublishedSchema, metadata: Mapping[str, str]) -> int:
        return len(self._channels) + 1

    def attach(self, file: AttachedFile) -> None:
        """Keep nothing."""

    def add_metadata(self, name: str, values: Mapping[str, str]) -> None:
        """Keep nothing."""

    def flush(self) -> None:
        """Forget what waits."""
        for rows in self._rows:
            rows.drop()
        for channel in self._channels:
            channel.drop()

    def _chunk(self) -> Iterator[None]:
        self.flush()
        return iter(())

    def close(self) -> None:
        """Forget what waits."""
        self.flush()

    def discard(self) -> None:
        """Forget what waits."""
        self.flush()
