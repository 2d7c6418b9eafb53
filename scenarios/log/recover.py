"""Makes a whole, indexed log of what a truncated or damaged one still holds."""

import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np
from mcap.records import Chunk, Header, MessageIndex, Metadata
from numpy.typing import NDArray

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log.encoding import MAGIC, Summary, encoded
from surefoot.scenarios.log.reader import RECOVERED, Log, read
from surefoot.scenarios.log.scan import PREFIX, index_chunk
from surefoot.scenarios.output import shown, write_whole

Index = dict[int, NDArray[np.void]]


@dataclass(frozen=True, slots=True)
class Recovery:
    """The data that were saved.

    Attributes:
        messages: number of messages.
        start: time of the first one [s].
        end: time of the last one [s].
        lost: what could not be read, in words.
    """

    messages: int
    start: float
    end: float
    lost: tuple[str, ...]


def recover(source: str | Path, target: str | Path, replace: bool = False) -> Recovery:
    """Write everything sound of a log to a new file, which appears under its name only when it is whole.

    Raises:
        LogError: the source is no MCAP file, or one of which nothing can be read; the target is the source, exists or
            cannot be written.
    """
    log, target = read(source), Path(target)
    if not (log.metadata or log.attachments or any(map(log.count, log.topics))):
        raise LogError(f"{log.path}: there is nothing of a log to recover; give a file that holds some of one")
    if target.exists() and target.samefile(log.path):
        raise LogError(f"{target}: the log that is to be recovered; give another file to write to")
    with write_whole(target, replace) as temporary, temporary.open("wb") as file:
        messages = _Rewriter(log, file).run()
    start, end = log.time_range()
    return Recovery(messages, start, end, log.losses())


class _Rewriter:
    def __init__(self, log: Log, file: BinaryIO) -> None:
        self._log = log
        self._file = file
        self._position = self._crc = 0
        self._summary = Summary()
        self._counts: dict[int, int] = {}
        self._schemas: dict[int, bytes] = {}
        self._channels: set[int] = set()

    def run(self) -> int:
        contents = self._log.contents
        self._write(MAGIC + encoded(Header("", "surefoot recover")))
        for record in contents.metadata:
            if record.name != RECOVERED:
                self._write(self._summary.add_metadata(record, self._position))
        found = {"lost": self._log.losses(), "unproven": self._log.unproven()}
        said = {name: "; ".join(words) for name, words in found.items()}
        origin = Metadata(RECOVERED, {"from": shown(self._log.path.name), **said})
        self._write(self._summary.add_metadata(origin, self._position))
        for attachment in contents.attachments:
            self._write(self._summary.add_attachment(attachment, self._position))
        for place, data in self._log.sound_chunks():
            index = index_chunk(data, contents)
            self._define()
            chunk = Chunk(
                compression=place.compression,
                data=bytes(self._log.data[place.data]),
                message_end_time=place.end_ns,
                message_start_time=place.start_ns,
                uncompressed_crc=place.crc,
                uncompressed_size=place.size,
            )
            self._chunk(chunk, index)
        self._define()
        self._loose()
        self._write(self._summary.finish(self._position, self._counts, self._crc))
        return sum(self._counts.values())

    def _define(self) -> None:
        """Write the schemas and channels that are known by now, and were not before."""
        contents = self._log.contents
        for number, schema in contents.schemas.items():
            if number not in self._schemas:
                self._schemas[number] = encoded(schema)
                self._write(self._schemas[number])
        for number, channel in contents.channels.items():
            if number not in self._channels:
                self._channels.add(number)
                record = encoded(channel)
                self._summary.add_channel(channel.schema_id, self._schemas.get(channel.schema_id), record)
                self._write(record)

    def _chunk(self, chunk: Chunk, index: Index) -> None:
        record = encoded(chunk)
        indexes = [(number, encoded(MessageIndex(number, entries.tolist()))) for number, entries in index.items()]
        self._summary.add_chunk(chunk, self._position, len(record), indexes)
        self._write(b"".join((record, *(entry for _, entry in indexes))))
        for number, entries in index.items():
            self._counts[number] = self._counts.get(number, 0) + len(entries)

    def _loose(self) -> None:
        """Gather the messages that stand outside chunks into one."""
        data = self._log.data
        entries = sorted(entry for channel in self._log.contents.loose.values() for entry in channel)
        records = [data[at : at + PREFIX.size + PREFIX.unpack_from(data, at)[1]] for _, at in entries]
        if records:
            block = b"".join(records)
            chunk = Chunk("", block, entries[-1][0], entries[0][0], zlib.crc32(block), len(block))
            self._chunk(chunk, index_chunk(block, self._log.contents))

    def _write(self, data: bytes) -> None:
        self._file.write(data)
        self._position += len(data)
        self._crc = zlib.crc32(data, self._crc)
