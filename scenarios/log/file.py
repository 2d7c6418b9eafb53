"""Files of a log under way: whole records one after another, and the index at the end of what they are."""

import zlib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol, TypeAlias

from mcap.records import Attachment, Chunk, Header, Metadata

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log.encoding import MAGIC, Summary, chunk_head, encoded
from surefoot.scenarios.output import reason

_PROFILE, _LIBRARY = "", "surefoot"


@dataclass(frozen=True, slots=True)
class Defined:
    """A channel's number, and the records of its schema and of itself."""

    number: int
    schema: bytes
    channel: bytes


Head: TypeAlias = Metadata | Attachment | Defined
"""Contents of a log beside chunks."""


@dataclass(frozen=True, slots=True)
class IndexedChunk:
    """A chunk, with the MessageIndex record and the number of messages of each of its channels.

    It opens a period where it begins when a chunk was due by the clock, whatever else asks for chunks in between.
    """

    chunk: Chunk
    indexes: Mapping[int, bytes]
    counts: Mapping[int, int]
    opens: bool


class Sink(Protocol):
    """The file that a log is written to."""

    @property
    def path(self) -> Path:
        """Path of the log."""
        ...

    @property
    def closed(self) -> bool:
        """True if nothing more can be written."""
        ...

    def add(self, record: Head) -> None:
        """Write a record that is no chunk; LogError if it cannot be written."""
        ...

    def add_chunk(self, indexed: IndexedChunk) -> None:
        """Write a chunk and the index of its messages; LogError if they cannot be written."""
        ...

    def finish(self) -> None:
        """Write the index of the file, and close it; LogError if it cannot be written."""
        ...

    def discard(self) -> None:
        """Close and remove all that was written."""
        ...


Failed: TypeAlias = Callable[[OSError], LogError]
"""Says why nothing more can be written, and where what was written is kept."""


class Output:
    """An unbuffered file that keeps only whole records.

    It never replaces another one, and a file that cannot be begun does not stay.

    Attributes:
        path: where the log is.
        position: bytes written.
        crc: CRC-32 of the bytes written.
    """

    __slots__ = ("_failed", "_file", "crc", "path", "position")

    def __init__(self, path: Path, beginning: bytes, failed: Failed | None = None) -> None:
        """Create the file with its beginning; ``failed``, if given, says in its place why nothing can be written.

        Raises:
            LogError: it exists, cannot be created or the beginning does not fit.
        """
        self.path, self._failed = path, failed
        self.position = self.crc = 0
        try:
            self._file = path.open("xb", buffering=0)
        except FileExistsError:
            raise LogError(f"{path}: exists already; choose another file, or delete it") from None
        except OSError as error:
            if failed is not None:
                raise failed(error) from None
            raise LogError(f"{path}: cannot be created, {reason(error)}; choose another directory") from None
        try:
            self._write(beginning)
        except OSError as error:
            self._file.close()
            path.unlink(missing_ok=True)
            if failed is not None:
                raise failed(error) from None
            raise LogError(f"{path}: cannot be written, {reason(error)}; no log was created") from None

    def write(self, data: bytes) -> None:
        """Append whole records.

        Raises:
            LogError: they could not be written; the file then holds what came before, under the name ``*.incomplete``.
        """
        try:
            self._write(data)
        except OSError as error:
            raise (self._failed or self.given_up)(error) from None

    def given_up(self, error: OSError) -> LogError:
        """Make the error that says why nothing more can be written, and rename what was written to ``*.incomplete``."""
        kept = self._set_aside()
        return LogError(f"{self.path}: cannot be written on, {reason(error)}; what was written is kept in {kept.name}")

    def move(self, path: Path) -> None:
        """Give the file another name, in place of the file that has it."""
        self.path.replace(path)
        self.path = path

    @property
    def closed(self) -> bool:
        """True if nothing more can be written."""
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


class LogFile:
    """One MCAP file; see `Sink`.

    Attributes:
        output: its bytes on the disk.
    """

    def __init__(self, path: Path, head: Iterable[Head], failed: Failed | None = None) -> None:
        """Create the file, whose first records are on the disk when this returns; LogError if it cannot be done."""
        self._summary = Summary()
        self._counts: dict[int, int] = {}
        beginning = bytearray(MAGIC + encoded(Header(_PROFILE, _LIBRARY)))
        for record in head:
            beginning += self._noted(record, len(beginning))
        self.output = Output(path, bytes(beginning), failed)

    @property
    def path(self) -> Path:
        """Path of the log."""
        return self.output.path

    @property
    def closed(self) -> bool:
        """See `Sink`."""
        return self.output.closed

    def add(self, record: Head) -> None:
        """See `Sink`."""
        self.output.write(self._noted(record, self.output.position))

    def add_chunk(self, indexed: IndexedChunk) -> None:
        """See `Sink`."""
        chunk, indexes = indexed.chunk, indexed.indexes
        head = chunk_head(chunk)
        self._summary.add_chunk(chunk, self.output.position, len(head) + len(chunk.data), tuple(indexes.items()))
        for number, count in indexed.counts.items():
            self._counts[number] += count
        self.output.write(b"".join((head, chunk.data, *indexes.values())))

    def finish(self) -> None:
        """See `Sink`."""
        self.output.write(self._summary.finish(self.output.position, self._counts, self.output.crc))
        self.output.close()

    def discard(self) -> None:
        """See `Sink`."""
        self.output.close()
        self.path.unlink(missing_ok=True)

    def _noted(self, record: Head, position: int) -> bytes:
        """A record's bytes, noted for the index as standing at a position."""
        if isinstance(record, Metadata):
            return self._summary.add_metadata(record, position)
        if isinstance(record, Attachment):
            return self._summary.add_attachment(record, position)
        self._summary.add_channel(record.number, record.schema, record.channel)
        self._counts[record.number] = 0
        return record.schema + record.channel
