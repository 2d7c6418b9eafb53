"""Reads a log into numpy arrays by channel and field name; also a truncated or damaged one, as far as it goes."""

import json
import math
import mmap
import stat
from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from functools import cached_property, partial
from itertools import zip_longest
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from mcap.records import Attachment, Metadata

from surefoot.pointers import IS_A_POINTER, POINTER_BYTES, is_pointer
from surefoot.scenarios.columns import USUAL, Columns, KeptChannel, Memory, Reads, in_order, keep
from surefoot.scenarios.errors import LogError, nearest, require
from surefoot.scenarios.log.chunk_reader import ChunkReader
from surefoot.scenarios.log.encoding import GREATEST_CHUNK, MAGIC
from surefoot.scenarios.log.long_channel import LongChannel
from surefoot.scenarios.log.manifest import RECORD as MANIFEST
from surefoot.scenarios.log.manifest import not_as_written
from surefoot.scenarios.log.messages import MESSAGE_BYTES, ChannelData, block_of, content_at, gathered, sound_records
from surefoot.scenarios.log.one_run import twice_named, twin
from surefoot.scenarios.log.scan import INDEX_ENTRY, Buffer, ChunkPlace, scan
from surefoot.scenarios.log.spec import FieldSpec, layout_of, record_dtype
from surefoot.scenarios.log.stretches import FARTHEST, FIRST, LAST, START, between, grouped

if TYPE_CHECKING:
    from pandas import DataFrame

RECOVERED = "recovered"
"""Metadata record of a log that was made of a truncated or damaged one: of which, and what was lost."""

GREATEST_RATIO = 100
"""Greatest ratio of a log's content to its size; those of standing robots reach ten."""


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
        memory: how much of it is held at once.
    """

    def __init__(self, path: Path, data: Buffer, memory: Memory = USUAL) -> None:
        self.path, self.memory = path, memory
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
        self._file = ChunkReader(contents, data)
        self.metadata = {record.name: record.metadata for record in contents.metadata if record.name != MANIFEST}
        self.attachments = {record.name: record.data for record in contents.attachments}
        self._ids = {channel.topic: number for number, channel in sorted(contents.channels.items())}
        self.topics = tuple(self._ids)
        self.joints = _joints(self.metadata)
        self._loaded: dict[str, ChannelData] = {}
        # Definitions that differ are of two logs, unless the file is damaged.
        apart = "" if not contents.conflicts or self._file.completeness.data_fault else contents.conflicts[0]
        if twice := apart or twice_named(contents) or twin(contents, data, self._is_of_ticks, self._file.decompressed):
            raise LogError(f"{path}: not the log of one run, {twice}; give the log of each run by itself")

    def __reduce__(self) -> tuple[Callable[[Path, Memory], "Log"], tuple[Path, Memory]]:
        """Go to another process by its place, where it is read again."""
        return read, (self.path.absolute(), self.memory)

    def __contains__(self, topic: str) -> bool:
        return topic in self._ids

    def __repr__(self) -> str:
        """Path, seconds, and how many messages of which topics."""
        start, end = self.time_range()
        state = ", truncated" if self.truncated else ""
        topics = ", ".join(f"{topic} {self.count(topic)}" for topic in self.topics)
        return f"Log({str(self.path)!r}, {start:.3f} to {end:.3f} s{state}: {topics or 'empty'})"

    def __getitem__(self, topic: str) -> ChannelData:
        """Messages of a topic: held if they are few, else each field is read when it is asked for.

        Few are those that take up to `Memory.held`, by default 16 MB, such as half a minute of the control rate.

        Raises:
            LogError: there is no such topic, or its messages are not of a fixed layout.
        """
        self.load(topic)
        return self._loaded.get(topic) or LongChannel(self, topic, self.fields(topic))

    def frame(self, topic: str) -> "DataFrame":
        """Messages of a topic as a pandas data frame: the index is time [s], the elements of a field are columns.

        Unit, frame and meaning of the columns are in its ``attrs``, see `ChannelData.notes`.

        Raises:
            LogError: there is no such topic, its messages are not of a fixed layout, or pandas is missing.
        """
        pandas = require("pandas", "frame", "a data frame", f"use log['{topic}'].field(name)")
        return self[topic].frame(pandas)

    def load(self, *topics: str) -> None:
        """Load topics in one pass through the file, those of them that are short enough to be held.

        Raises:
            LogError: there is no such topic, or its messages are not of a fixed layout.
        """
        sizes = {topic: record_dtype(self.fields(topic)).itemsize for topic in topics if topic not in self._loaded}
        wanted = [topic for topic, size in sizes.items() if size * self.count(topic) <= self.memory.held]
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

    def window(self, topic: str, start: float | None, end: float | None) -> ChannelData:
        """Messages of a topic from a time on and up to another one [s], None for all that there are.

        Only their part of the file is read.

        Raises:
            LogError: there is no such topic, its messages are not of a fixed layout, or the times are not finite.
        """
        span = self._span(start, end)
        return between(self._read([topic], self._chunks(span)), span)[topic]

    def windows(
        self,
        topics: Collection[str],
        duration: float | None = None,
        start: float | None = None,
        end: float | None = None,
        verify: bool = True,
    ) -> Iterator[dict[str, ChannelData]]:
        """Go through the file once in bounded memory, topics together, for a duration at a time, to the next chunk [s].

        Args:
            topics: that are read.
            duration: of a part, `Memory.window` if None [s].
            start: time of the first messages, those of the log if None [s].
            end: time of the last messages, those of the log if None [s].
            verify: leave out chunks that do not agree with their checksum, and note them in `damage`.

        Raises:
            LogError: there is no such topic, its messages are not of a fixed layout, or the times are not finite.
        """
        span = self._span(start, end)
        for group in grouped(self._chunks(span), self.memory.window if duration is None else duration):
            yield between(self._read(topics, group, verify, loose=False), span)
        yield between(self._read(topics, (), verify), span)

    def parts(self, topic: str, start: float | None = None, end: float | None = None) -> Iterator[ChannelData]:
        """Messages of a topic in order of time, a few seconds of them at once.

        Args:
            topic: theirs.
            start: time of the first messages, those of the log if None [s].
            end: time of the last messages, those of the log if None [s].
        """
        for _, found in self.stretches([topic], start, end):
            if len(found[topic]):
                yield found[topic]

    def stretches(
        self, topics: Collection[str], start: float | None = None, end: float | None = None
    ) -> Iterator[tuple[int, dict[str, ChannelData]]]:
        """Go through topics together in order of time.

        Messages outside of all chunks are held together, and so are those of chunks that overlap in time.

        Args:
            topics: that are read.
            start: time of the first messages, those of the log if None [s].
            end: time of the last messages, those of the log if None [s].

        Yields:
            a time [ns], and all messages before it that did not come yet.
        """
        span, numbers = self._span(start, end), {self._number(topic) for topic in topics}
        chunks = sorted((c for c in self._chunks(span) if not c.channels.isdisjoint(numbers)), key=START)
        rest, groups = self._read(topics, ()), list(grouped(chunks, self.memory.window))
        for group, following in zip_longest(groups, groups[1:]):
            found = self._read(topics, group, loose=False)
            until = min(following[0].start_ns, LAST) if following else LAST
            joined = {topic: rest[topic].joined(found[topic]) for topic in topics}
            rest = between(joined, (until, LAST))
            yield until, between(between(joined, (FIRST, until - 1)), span)
        yield LAST + 1, between(rest, span)

    def gather(self, reads: Reads, start: float | None = None, end: float | None = None) -> dict[str, KeptChannel]:
        """Read some fields of topics in one pass and keep them, many of them in temporary files.

        Args:
            reads: names of fields by topic; those that there are not are left out.
            start: time of the first messages, those of the log if None [s].
            end: time of the last messages, those of the log if None [s].

        Returns:
            the channels, in order of time.

        Raises:
            LogError: messages are not of a fixed layout, times are not finite, or there is no room for the files.
        """
        kept, topics = Columns(self.memory), [topic for topic in reads if topic in self.numeric]
        for channels in self.windows(topics, start=start, end=end, verify=False):
            keep(kept, channels, reads)
        for topic in topics:
            in_order(kept, topic)
        return {topic: KeptChannel(topic, kept, partial(self.window, topic, start, end)) for topic in topics}

    def _span(self, start: float | None, end: float | None) -> tuple[int, int] | None:
        """First and last time of a stretch [ns], None for all of the log; or a LogError."""
        if start is None and end is None:
            return None
        first, last = -FARTHEST if start is None else start, FARTHEST if end is None else end
        if not (math.isfinite(first) and math.isfinite(last)):
            raise LogError(f"{self.path}: no time from {start} s to {end} s; give finite times")
        return round(first * 1e9), round(last * 1e9)

    def _chunks(self, span: tuple[int, int] | None) -> list[ChunkPlace]:
        """Chunks with messages of a stretch of time [ns]."""
        every = self.contents.chunks
        return every if span is None else [one for one in every if one.start_ns <= span[1] and one.end_ns >= span[0]]

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
        for chunk, data in self._file.unpacked(chunk for chunk in self.contents.chunks if chunk.count(number)):
            for time, offset in chunk.entries(number, self.data).tolist():
                if offset + MESSAGE_BYTES <= len(data):
                    yield time, content_at(data, offset)

    def count(self, topic: str) -> int:
        """Number of messages of a topic, by the index."""
        return self._counts[self._ids[topic]]

    @cached_property
    def _counts(self) -> Counter[int]:
        """Number of messages by channel id."""
        found = Counter({number: len(entries) for number, entries in self.contents.loose.items()})
        for chunk in self.contents.chunks:
            found.update({number: chunk.count(number) for number in chunk.channels})
        return found

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
        self._file.verify()

    def lacks(self) -> tuple[str, ...]:
        """Parts of the log that are missing or cannot be read, in words, when everything was looked at.

        A log without its index may be whole: the record that ends its data has the checksum of everything before it.
        """
        self.verify()
        before = self.metadata.get(RECOVERED, {}).get("lost", "")
        end = f"its end is missing, it can be read up to {self.time_range()[1]:.3f} s"
        cut = end if self.contents.data_end is None else ""
        lost, _ = not_as_written(self._records)
        return tuple(dict.fromkeys(filter(None, (before, cut, *lost, *self.damage, self._file.completeness.missing()))))

    def faults(self) -> tuple[str, ...]:
        """Parts of the log that contradict the rest, in words, when everything was looked at."""
        self.verify()
        _, changed = not_as_written(self._records)
        return tuple(dict.fromkeys(filter(None, (*changed, *self._file.completeness.contradictions()))))

    @property
    def _records(self) -> list[Metadata | Attachment]:
        return [*self.contents.metadata, *self.contents.attachments]

    def losses(self) -> tuple[str, ...]:
        """Whatever of the log is missing or damaged, in words: all of `lacks` and of `faults`."""
        return (*self.lacks(), *self.faults())

    def unproven(self) -> tuple[str, ...]:
        """Evidence that is missing that the log is as its run has written it, in words.

        Other tools that write a log again may leave out what is needed for it, and change nothing else.
        """
        self.verify()
        before = self.metadata.get(RECOVERED, {}).get("unproven", "")
        return tuple(dict.fromkeys(filter(None, (before, *self._file.completeness.unproven()))))

    def sound_chunks(self) -> Iterator[tuple[ChunkPlace, bytes]]:
        """Every chunk that agrees with its checksum, and its decompressed bytes; the others add to `damage`."""
        return self._file.unpacked(self.contents.chunks, verify=True)

    def _number(self, topic: str) -> int:
        if topic not in self._ids:
            raise LogError(f"{self.path}: no topic '{topic}'; {nearest(topic, self.topics or ('none',))}")
        return self._ids[topic]

    def _is_of_ticks(self, topic: str) -> bool:
        """Return true if a channel has a message each control tick; after states got lost, one may have two plans."""
        return self._is_numeric(topic) and self.count(topic) == max(self._counts.values())

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
        blocks: dict[int, bytearray] = {number: bytearray() for number in sizes}
        expected, channels = dict.fromkeys(sizes, 0), self.contents.channels
        for chunk, data in self._file.unpacked(
            (chunk for chunk in chunks if verify or not chunk.channels.isdisjoint(sizes)), verify
        ):
            view = memoryview(data)
            for number in sizes.keys() & chunk.channels:
                count = chunk.count(number)
                expected[number] += count
                if count * sizes[number] > len(view):
                    what = f"lists more of {channels[number].topic} than the chunk can hold"
                    self._file.note(f"the index at byte {chunk.position} {what}")
                elif count:
                    blocks[number] += block_of(view, chunk, number, sizes[number], self.data)
        for number in sizes.keys() & self.contents.loose.keys() if loose else ():
            entries = np.array(self.contents.loose[number], INDEX_ENTRY)
            expected[number] += len(entries)
            blocks[number] += gathered(memoryview(self.data), entries, sizes[number])
        return {
            topic: self._channel(topic, fields[topic], dtype, blocks[self._ids[topic]], expected[self._ids[topic]])
            for topic, dtype in types.items()
        }

    def _channel(
        self,
        topic: str,
        fields: tuple[FieldSpec, ...],
        dtype: np.dtype[Any],
        block: bytearray,
        expected: int,
    ) -> ChannelData:
        """The messages in a block of bytes, of which so many are expected."""
        records = sound_records(np.frombuffer(block, np.uint8), self._ids[topic], dtype)
        if len(records) < expected:
            self._file.note(f"{expected - len(records)} messages of {topic} are damaged or not of its layout")
        return ChannelData(topic, fields, records, self.joints)


def _joints(metadata: Mapping[str, Mapping[str, str]]) -> tuple[str, ...]:
    """Names of the joints as the constants of the run have them (`record.provenance.RunConstants`)."""
    try:
        names = json.loads(metadata["run"]["joint_names"])
    except (KeyError, ValueError, RecursionError):
        return ()
    sound = isinstance(names, list) and all(isinstance(name, str) for name in names) and len(set(names)) == len(names)
    return tuple(names) if sound else ()


def read(path: str | Path, memory: Memory = USUAL) -> Log:
    """Open a log, of which so much is held at once.

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
            return Log(path, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ), memory)
    except IsADirectoryError:
        inside = next(iter(sorted(path.glob("*.mcap"))), None)
        raise LogError(f"{path}: a directory; give {'a log file' if inside is None else inside}") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise LogError(f"{path}: cannot be read, {str(reason).lower()}; give a log file") from None
