"""Writes a log: what the run was first, then a chunk of messages every few hundredths of a simulated second."""

import zlib
from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Literal, Self

from mcap.records import Attachment, Channel, Chunk, Metadata, Schema

from surefoot.scenarios.log.channel import ChannelWriter, Clock, MessageWriter, Waiting
from surefoot.scenarios.log.chunk import BlockMaker
from surefoot.scenarios.log.encoding import compress, encoded
from surefoot.scenarios.log.file import Defined, Head, IndexedChunk, LogFile, Sink
from surefoot.scenarios.log.layout import RowLayout
from surefoot.scenarios.log.manifest import manifest
from surefoot.scenarios.log.recorder import FlightRecorder
from surefoot.scenarios.log.rows import RowWriter
from surefoot.scenarios.log.spec import PACKAGE, ChannelSpec
from surefoot.scenarios.log.thinning import THINNED, Sieve, ThinnedChannel, ThinnedMessages, ThinnedRows, Thinning

Compression = Literal["lz4", "zstd", ""]
CHUNK_PERIOD_NS = 90_000_000
"""Simulated time in one chunk: what a killed process loses at most, and the ticks in which it is written [ns]."""

_WRITING_NS = 8_000_000
"""Simulated time in which a chunk is written, a part at each tick, so that none takes long [ns]."""

WALKING_SHARE = 0.7
"""Share of the messages of a walking robot that compression leaves; of a standing one it leaves less [-]."""

_CAPACITY = 128


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


def _defined(number: int, topic: str, schema: PublishedSchema, metadata: Mapping[str, str]) -> Defined:
    """Records of a schema and a channel."""
    return Defined(
        number,
        encoded(Schema(number, schema.descriptors, "protobuf", schema.name)),
        encoded(Channel(number, topic, "protobuf", dict(metadata), number)),
    )


def _attachment(file: AttachedFile) -> Attachment:
    return Attachment(0, 0, file.name, file.media_type, file.data)


class LogWriter:
    """An MCAP file under way.

    Messages wait in their channels until a chunk is due, which is then written in one go, in the order of their time.
    So the file on disk is always whole up to the last chunk. `close` adds the index. Usable as a context manager.

    Attributes:
        keep: time before its end that the log holds at least; None for all [s].
        growth: by how much what the log holds grows in simulated time while the robot walks, by the last chunk; None
            before there were two [B/s].
    """

    _opens: bool

    def __init__(
        self,
        path: Path,
        metadata: Mapping[str, Mapping[str, str]],
        attachments: Sequence[AttachedFile] = (),
        compression: Compression = "lz4",
        keep: float | None = None,
        thinning: Thinning | None = None,
    ) -> None:
        """Create the file; metadata and attachments are on disk when this returns.

        Args:
            path: file to create.
            metadata: named records of key and value.
            attachments: files to carry.
            compression: of the chunks.
            keep: time before its end that the log holds at least, and at most twice; None for all [s].
            thinning: which channels are thinned, and to what; None for none.

        Raises:
            LogError: the file exists, or cannot be created or written; nothing of that name is then created.
        """
        self._compression, self._thinning, self.keep = compression, thinning, keep
        self._channels: list[Waiting] = []
        self._rows: list[RowWriter] = []
        self._blocks = BlockMaker()
        self.growth: float | None = None
        self._until: int | None = None
        self._begin_clock()
        first: list[Metadata | Attachment] = [Metadata(name, dict(values)) for name, values in metadata.items()]
        first += map(_attachment, attachments)
        head: list[Head] = [*first, *([manifest(first)] if first else ())]
        self._sink: Sink = LogFile(path, head) if keep is None else FlightRecorder(path, head, round(1e9 * keep))

    @property
    def path(self) -> Path:
        """Path of the log."""
        return self._sink.path

    def channel(self, spec: ChannelSpec) -> ChannelWriter:
        """Add a channel, before or between messages."""
        schema = PublishedSchema(f"{PACKAGE}.{spec.message}", spec.descriptors)
        sieve = self._sieve(spec.topic)
        number = self._define(spec.topic, schema, spec.metadata, sieve)
        writer = (
            ChannelWriter(spec, number, _CAPACITY, self._clock)
            if sieve is None
            else ThinnedChannel(spec, number, _CAPACITY, self._clock, sieve)
        )
        self._channels.append(writer)
        return writer

    def rows(self, layout: RowLayout) -> RowWriter | ThinnedRows:
        """Fill channels of one rate together, which are thinned together; ValueError for a field missing or twice."""
        rows = RowWriter(layout, _CAPACITY, self._clock)
        self._rows.append(rows)
        sieves = {topic: self._sieve(topic) for topic in rows.topics}
        whole = [topic for topic, sieve in sieves.items() if sieve is None]
        sieve = next(iter(sieves.values()))
        if sieve is None or whole:
            if len(whole) < len(sieves):
                raise ValueError(f"rows of {', '.join(sieves)}, of which {', '.join(whole)} are not thinned")
            return rows
        return ThinnedRows(rows, sieve)

    def message_channel(self, topic: str, schema: PublishedSchema, doc: str, sampled: bool = False) -> MessageWriter:
        """Add a channel of a published schema whose messages come encoded; ``sampled`` ones may be thinned."""
        sieve = self._sieve(topic) if sampled else None
        number = self._define(topic, schema, {"doc": doc}, sieve)
        writer = MessageWriter(number, self._clock) if sieve is None else ThinnedMessages(number, self._clock, sieve)
        self._channels.append(writer)
        return writer

    def _sieve(self, topic: str) -> Sieve | None:
        return None if self._thinning is None else self._thinning.sieve(topic)

    def _define(self, topic: str, schema: PublishedSchema, metadata: Mapping[str, str], sieve: Sieve | None) -> int:
        """Write the schema and the channel; gives the channel's number."""
        number = len(self._channels) + 1
        noted = metadata if sieve is None else {**metadata, THINNED: str(sieve.rate)}
        self._sink.add(_defined(number, topic, schema, noted))
        return number

    def attach(self, file: AttachedFile) -> None:
        """Write an attachment after everything appended so far."""
        self.flush()
        self._sink.add(_attachment(file))

    def add_metadata(self, name: str, values: Mapping[str, str]) -> None:
        """Write a metadata record after everything appended so far."""
        self.flush()
        self._sink.add(Metadata(name, dict(values)))

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
        opens = self._opens
        self._opens = False
        made = self._blocks.block(waiting)
        crc = zlib.crc32(made.data)  # while the bytes are near
        # The first has what is written once.
        if self._until is not None and self._until < made.end_ns:
            self.growth = WALKING_SHARE * len(made.data) * 1e9 / (made.end_ns - self._until)
        self._until = made.end_ns
        yield
        packed = compress(made.data, self._compression)
        yield
        chunk = Chunk(self._compression, packed, made.end_ns, made.start_ns, crc, len(made.data))
        self._sink.add_chunk(IndexedChunk(chunk, made.indexes, made.counts, opens))

    def close(self) -> None:
        """Write what waits and the index, and close the file; a second call does nothing."""
        if self._sink.closed:
            return
        self.flush()
        self._sink.finish()

    def discard(self) -> None:
        """Close and remove the file: there is no run to log."""
        self._sink.discard()

    def _begin_clock(self) -> None:
        self._writing: Iterator[None] = iter(())
        self._opens = True
        # The first is shorter: whole tenths of a second are when plans are made, too.
        self._next, self._late = CHUNK_PERIOD_NS - _WRITING_NS, 0
        self._clock = Clock(self._next, self._go_on, self._full)

    def _full(self, _time_ns: int) -> None:
        """Write a chunk before it is due; when the next one is due stays as it was."""
        self.flush()
        self._clock.due = self._next

    def _go_on(self, time_ns: int) -> None:
        """Begin a chunk, or write the next part of the one that is being written."""
        clock, due = self._clock, time_ns >= self._next
        if due:
            deque(self._writing, maxlen=0)  # of one that is under way still, after a gap in time
            self._next, self._late = time_ns + CHUNK_PERIOD_NS, time_ns + _WRITING_NS
            self._writing = self._chunk()
        elif time_ns >= self._late:
            deque(self._writing, maxlen=0)
        clock.due = time_ns + 1 if next(self._writing, self) is None else self._next
        self._opens |= due

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
        self._thinning = self.keep = self.growth = None
        self._begin_clock()

    def _define(self, topic: str, schema: PublishedSchema, metadata: Mapping[str, str], sieve: Sieve | None) -> int:
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
