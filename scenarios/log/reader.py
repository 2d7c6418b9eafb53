"""Reads a log into numpy arrays by channel and field name; also a truncated or damaged one, as far as it goes."""

import json
import math
import mmap
import stat
import zlib
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from mcap.records import Attachment, Metadata

from surefoot.pointers import IS_A_POINTER, POINTER_BYTES, is_pointer
from surefoot.scenarios.errors import LogError, nearest, require
from surefoot.scenarios.log.completeness import Completeness
from surefoot.scenarios.log.encoding import GREATEST_CHUNK, MAGIC, decompress
from surefoot.scenarios.log.manifest import RECORD as MANIFEST
from surefoot.scenarios.log.manifest import not_as_written
from surefoot.scenarios.log.messages import MESSAGE_BYTES, ChannelData, block_of, content_at, gathered, sound_records
from surefoot.scenarios.log.one_run import twice_named, twin
from surefoot.scenarios.log.scan import INDEX_ENTRY, Buffer, ChunkPlace, index_chunk, release, scan
from surefoot.scenarios.log.spec import FieldSpec, layout_of, record_dtype

if TYPE_CHECKING:
    from pandas import DataFrame

RECOVERED = "recovered"
"""Metadata record of a log that was made of a truncated or damaged one: of which, and what was lost."""

GREATEST_RATIO = 100
"""How many times its size a log may hold; those of standing robots reach ten."""

WINDOW = 4.0
"""Simulated time that is read at once where a whole log is gone through [s]."""


class Log:
    """A log file.

    Attributes:
        path: where it is.
        size: of the file [bytes].
        metadata: named records of key and value.
        attachments: contents by name.
        topics: every topic, in order of channel id.
        joints: names of the robot's joints in order; () when the log does not say.
        truncated: whether the end of the file is missing, as after a killed run.
        damage: what could not be read, in words; grows as channels are loaded; `losses` knows all.
        contents: records of the file and their places.
        data: bytes of the file.
    """

    def __init__(self, path: Path, data: Buffer) -> None:
        self.path = path
        self.size = len(data)
        self.data = data
        self.contents = contents = scan(data)
        # A chunk that states more than one may hold is damaged by itself, and is not unpacked.
        stated = sum(chunk.size for chunk in contents.chunks if chunk.size <= GREATEST_CHUNK)
        if stated > GREATEST_CHUNK + GREATEST_RATIO * self.size:
            what = f"{path}: its chunks state {stated >> 20} MB, more than {GREATEST_RATIO} times the file"
            raise LogError(f"{what}; give a log that `surefoot run` has written")
        self.truncated = contents.truncated
        self.damage = contents.damage
        self._verified: set[int] = set()
        self._completeness = Completeness(contents, data)
        self._index_rest()
        self.metadata = {record.name: record.metadata for record in contents.metadata if record.name != MANIFEST}
        self.attachments = {record.name: record.data for record in contents.attachments}
        self._ids = {channel.topic: number for number, channel in sorted(contents.channels.items())}
        self.topics = tuple(self._ids)
        self.joints = _joints(self.metadata)
        self._loaded: dict[str, ChannelData] = {}
        # Definitions that differ are of two logs, unless the file is damaged.
        apart = "" if not contents.conflicts or self._completeness.data_fault else contents.conflicts[0]
        if twice := apart or twice_named(contents) or twin(contents, data, self._is_numeric, self._decompressed):
            raise LogError(f"{path}: not the log of one run, {twice}; give the log of each run by itself")

    def __reduce__(self) -> tuple[Callable[[Path], "Log"], tuple[Path]]:
        """Go to another process by its place, where it is read again."""
        return read, (self.path.absolute(),)

    def __contains__(self, topic: str) -> bool:
        return topic in self._ids

    def __repr__(self) -> str:
        """Path, seconds, and how many messages of which topics."""
        start, end = self.time_range()
        state = ", truncated" if self.truncated else ""
        topics = ", ".join(f"{topic} {self.count(topic)}" for topic in self.topics)
        return f"Log({str(self.path)!r}, {start:.3f} to {end:.3f} s{state}: {topics or 'empty'})"

    def __getitem__(self, topic: str) -> ChannelData:
        """Messages of a topic; errors as of `load`."""
        self.load(topic)
        return self._loaded[topic]

    def frame(self, topic: str) -> "DataFrame":
        """Messages of a topic as a pandas data frame: the index is time [s], the elements of a field are columns.

        Unit, frame and meaning of the columns are in its ``attrs``, as of `ChannelData.notes`.

        Raises:
            LogError: there is no such topic, its messages are not of a fixed layout, or pandas is missing.
        """
        pandas = require("pandas", "frame", "a data frame", f"use log['{topic}'].field(name)")
        channel = self[topic]
        frame: DataFrame = pandas.DataFrame(channel.columns()).set_index("time")
        frame.attrs.update(channel.notes())
        return frame

    def load(self, *topics: str) -> None:
        """Load topics in one pass through the file.

        Raises:
            LogError: there is no such topic, or its messages are not of a fixed layout.
        """
        wanted = [topic for topic in topics if topic not in self._loaded]
        if wanted:
            self._loaded.update(self._read(wanted, self.contents.chunks))

    def require(self, use: str, *topics: str) -> None:
        """Refuse, for a use such as "a replay", a log that lacks one of some topics, or has messages of others alone.

        Raises:
            LogError: names the topic.
        """
        filled = any(topic in self and self.count(topic) for topic in topics)
        for topic in topics:
            if topic not in self or (filled and not self.count(topic)):
                raise LogError(f"{self.path}: has no messages of {topic}, which {use} needs; give a log that has them")

    def window(self, topic: str, start: float, end: float) -> ChannelData:
        """Messages of a topic from a time on and up to another one [s]; only their part of the file is read.

        Raises:
            LogError: there is no such topic, its messages are not of a fixed layout, or the times are not finite.
        """
        if not (math.isfinite(start) and math.isfinite(end)):
            raise LogError(f"{self.path}: no time from {start} s to {end} s; give finite times")
        first, last = round(start * 1e9), round(end * 1e9)
        chunks = [chunk for chunk in self.contents.chunks if chunk.start_ns <= last and chunk.end_ns >= first]
        return self._read([topic], chunks)[topic].between(first, last)

    def windows(self, topics: Collection[str], duration: float = WINDOW) -> Iterator[dict[str, ChannelData]]:
        """Go through the file once in bounded memory, topics together, for a duration at a time, to the next chunk [s].

        Chunks that do not agree with their checksum are left out and noted in `damage`.

        Raises:
            LogError: there is no such topic, or its messages are not of a fixed layout.
        """
        group: list[ChunkPlace] = []
        size = 0
        for chunk in self.contents.chunks:
            group.append(chunk)
            size += chunk.size
            if chunk.end_ns - group[0].start_ns >= duration * 1e9 or size > GREATEST_CHUNK:
                yield self._read(topics, group, verify=True, loose=False)
                group, size = [], 0
        yield self._read(topics, group, verify=True)

    def fields(self, topic: str) -> tuple[FieldSpec, ...]:
        """Fields of a topic.

        Raises:
            LogError: there is no such topic, or its messages are not of a fixed layout.
        """
        number = self._number(topic)
        try:
            return layout_of(self.contents.channels[number].metadata)
        except ValueError:
            right = "read it by its schema with the mcap package"
            raise LogError(f"{self.path}: topic {topic} states no layout of fixed size; {right}") from None

    @cached_property
    def numeric(self) -> tuple[str, ...]:
        """Topics whose messages can be read into arrays; the others are of other people's schemas."""
        return tuple(topic for topic in self.topics if self._is_numeric(topic))

    def messages(self, topic: str) -> Iterator[tuple[int, bytes]]:
        """Time [ns] and encoded content of every message of a topic, of any schema, in the file's order.

        Raises:
            LogError: there is no such topic.
        """
        number = self._number(topic)
        for time, offset in self.contents.loose.get(number, ()):
            yield time, content_at(self.data, offset)
        for chunk in self.contents.chunks:
            data = self._decompressed(chunk) if chunk.count(number) else None
            if data is not None:
                for time, offset in chunk.entries(number, self.data).tolist():
                    if offset + MESSAGE_BYTES <= len(data):
                        yield time, content_at(data, offset)

    def count(self, topic: str) -> int:
        """Number of messages of a topic, by the index."""
        number = self._ids[topic]
        chunked = sum(chunk.count(number) for chunk in self.contents.chunks)
        return chunked + len(self.contents.loose.get(number, ()))

    def time_range(self) -> tuple[float, float]:
        """First and last time of all messages [s]; zeros when there is none."""
        starts = [chunk.start_ns for chunk in self.contents.chunks]
        ends = [chunk.end_ns for chunk in self.contents.chunks]
        loose = [time for entries in self.contents.loose.values() for time, _ in entries]
        return min([*starts, *loose], default=0) * 1e-9, max([*ends, *loose], default=0) * 1e-9

    def verify(self) -> None:
        """Compare every chunk that has not been compared yet with its checksum and with its index.

        `damage` tells what does not agree. Of data that agree with their checksum as a whole, chunks are not compared
        with theirs.
        """
        for chunk in self.contents.chunks:
            if chunk.position not in self._verified:
                self._sound(chunk)

    def lacks(self) -> tuple[str, ...]:
        """What of the log is missing or cannot be read, in words, when everything was looked at.

        A log without its index may be whole: the record that ends its data has the checksum of everything before it.
        """
        self.verify()
        before = self.metadata.get(RECOVERED, {}).get("lost", "")
        end = f"its end is missing, it can be read up to {self.time_range()[1]:.3f} s"
        cut = end if self.contents.data_end is None else ""
        lost, _ = not_as_written(self._records)
        return tuple(dict.fromkeys(filter(None, (before, cut, *lost, *self.damage, self._completeness.missing()))))

    def faults(self) -> tuple[str, ...]:
        """What of the log contradicts the rest, in words, when everything was looked at."""
        self.verify()
        _, changed = not_as_written(self._records)
        return tuple(dict.fromkeys(filter(None, (*changed, *self._completeness.contradictions()))))

    @property
    def _records(self) -> list[Metadata | Attachment]:
        return [*self.contents.metadata, *self.contents.attachments]

    def losses(self) -> tuple[str, ...]:
        """Whatever of the log is missing or damaged, in words: all of `lacks` and of `faults`."""
        return (*self.lacks(), *self.faults())

    def unproven(self) -> tuple[str, ...]:
        """Which evidence there is not that the log is as its run has written it, in words.

        Other tools that write a log again may leave out what is needed for it, and change nothing else.
        """
        self.verify()
        before = self.metadata.get(RECOVERED, {}).get("unproven", "")
        return tuple(dict.fromkeys(filter(None, (before, *self._completeness.unproven()))))

    def sound_chunks(self) -> Iterator[tuple[ChunkPlace, bytes]]:
        """Every chunk that agrees with its checksum, and its decompressed bytes; the others add to `damage`."""
        for chunk in self.contents.chunks:
            data = self._sound(chunk)
            if data is not None:
                yield chunk, data

    def _number(self, topic: str) -> int:
        if topic not in self._ids:
            raise LogError(f"{self.path}: no topic '{topic}'; {nearest(topic, self.topics or ('none',))}")
        return self._ids[topic]

    def _is_numeric(self, topic: str) -> bool:
        try:
            self.fields(topic)
        except LogError:
            return False
        return True

    def _read(
        self, topics: Collection[str], chunks: Sequence[ChunkPlace], verify: bool = False, loose: bool = True
    ) -> dict[str, ChannelData]:
        """Messages of topics in some chunks and, if they are wanted, outside all chunks."""
        fields = {topic: self.fields(topic) for topic in topics}
        types = {topic: record_dtype(fields[topic]) for topic in topics}
        sizes = {self._ids[topic]: dtype.itemsize for topic, dtype in types.items()}
        blocks: dict[int, list[memoryview | bytes]] = {number: [] for number in sizes}
        expected, channels = dict.fromkeys(sizes, 0), self.contents.channels
        for chunk in chunks:
            numbers = sizes.keys() & chunk.channels
            data = (self._sound(chunk) if verify else self._decompressed(chunk)) if numbers or verify else None
            if data is not None:
                view = memoryview(data)
                for number in numbers:
                    count = chunk.count(number)
                    expected[number] += count
                    if count * sizes[number] > len(view):
                        what = f"lists more of {channels[number].topic} than the chunk can hold"
                        self.damage.append(f"the index at byte {chunk.position} {what}")
                    elif count:
                        blocks[number].append(block_of(view, chunk, number, sizes[number], self.data))
        for number in sizes.keys() & self.contents.loose.keys() if loose else ():
            entries = np.array(self.contents.loose[number], INDEX_ENTRY)
            expected[number] += len(entries)
            blocks[number].append(gathered(memoryview(self.data), entries, sizes[number]))
        if chunks:
            release(self.data, chunks[0].position, chunks[-1].position + chunks[-1].length)
        return {
            topic: self._channel(topic, fields[topic], dtype, blocks[self._ids[topic]], expected[self._ids[topic]])
            for topic, dtype in types.items()
        }

    def _channel(
        self,
        topic: str,
        fields: tuple[FieldSpec, ...],
        dtype: np.dtype[Any],
        blocks: list[memoryview | bytes],
        expected: int,
    ) -> ChannelData:
        """The messages in some blocks of bytes, of which so many are expected."""
        number = self._ids[topic]
        whole = np.frombuffer(b"".join(blocks), np.uint8)
        records = sound_records(whole, number, dtype)
        if len(records) < expected:
            self.damage.append(f"{expected - len(records)} messages of {topic} are damaged or not of its layout")
        return ChannelData(topic, fields, records, self.joints)

    def _sound(self, chunk: ChunkPlace) -> bytes | None:
        """Decompressed bytes of a chunk if they agree with its checksum, as all do of data that agree with theirs."""
        data, known = self._decompressed(chunk), chunk.position in self._verified
        self._verified.add(chunk.position)
        if data is None:
            return None
        if self._completeness.proven or not chunk.crc or zlib.crc32(data) == chunk.crc:
            if not known:
                self._completeness.look(chunk, data)
            return data
        if not known:
            self.damage.append(f"the chunk at byte {chunk.position} does not agree with its checksum")
        return None

    def _decompressed(self, chunk: ChunkPlace) -> bytes | None:
        try:
            return decompress(memoryview(self.data)[chunk.data], chunk.compression, chunk.size)
        except LogError as error:
            note = f"at byte {chunk.position} {error}"
            if note not in self.damage:
                self.damage.append(note)
            return None

    def _index_rest(self) -> None:
        """Index chunks that stand without an index, or whose channels are defined only inside them."""
        for chunk in self.contents.chunks:
            foreign = chunk.channels - self.contents.channels.keys()
            doubled = len(chunk.channels) < len(chunk.places) // 3
            if not chunk.places or chunk.index_damaged or foreign or doubled:
                data = self._decompressed(chunk)
                if data is not None:
                    chunk.made = index_chunk(data, self.contents)
        used = set().union(*(chunk.used for chunk in self.contents.chunks))
        for chunk in self.contents.chunks:  # one may define what only later ones use
            if not used - self.contents.channels.keys():
                break
            index_chunk(self._decompressed(chunk) or b"", self.contents)


def _joints(metadata: Mapping[str, Mapping[str, str]]) -> tuple[str, ...]:
    """Names of the joints as the constants of the run have them (`record.provenance.RunConstants`)."""
    try:
        names = json.loads(metadata["run"]["joint_names"])
    except (KeyError, ValueError, RecursionError):
        return ()
    sound = isinstance(names, list) and all(isinstance(name, str) for name in names) and len(set(names)) == len(names)
    return tuple(names) if sound else ()


def read(path: str | Path) -> Log:
    """Open a log.

    Raises:
        LogError: there is no such file, or it is no MCAP file.
    """
    path = Path(path)
    try:
        if not stat.S_ISREG(path.stat().st_mode) and not path.is_dir():
            raise LogError(f"{path}: not an MCAP file but a device or a pipe; give a log file")
        with path.open("rb") as file:
            magic = file.read(len(MAGIC))
            if is_pointer(magic + file.read(POINTER_BYTES)):
                raise LogError(f"{path}: {IS_A_POINTER}")
            if magic != MAGIC:
                raise LogError(f"{path}: not an MCAP file; give a log that `surefoot run` has written")
            return Log(path, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ))
    except IsADirectoryError:
        inside = next(iter(sorted(path.glob("*.mcap"))), None)
        raise LogError(f"{path}: a directory; give {'a log file' if inside is None else inside}") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise LogError(f"{path}: cannot be read, {str(reason).lower()}; give a log file") from None
