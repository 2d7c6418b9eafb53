"""Reads a log into numpy arrays by channel and field name; also a truncated or damaged one, as far as it goes."""

import mmap
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from scenarios.errors import LogError, nearest
from scenarios.log.compression import decompress
from scenarios.log.encode import MAGIC
from scenarios.log.extract import records_of
from scenarios.log.layout import record_dtype
from scenarios.log.scan import INDEX_ENTRY, Buffer, ChunkPlace, index_chunk, scan
from scenarios.log.spec import FieldSpec, layout_of


class ChannelData:
    """The messages of one channel in order of time.

    Attributes:
        topic: the channel's topic.
        fields: its fields.
        time_ns: simulated time of each message, shape (n,) [ns].
    """

    def __init__(self, topic: str, fields: tuple[FieldSpec, ...], records: NDArray[np.void]) -> None:
        times = records["_log_time"].astype(np.int64)
        if np.any(times[1:] < times[:-1]):
            order = np.argsort(times, kind="stable")
            times, records = times[order], records[order]
        self.topic = topic
        self.fields = fields
        self.time_ns: NDArray[np.int64] = times
        self._records = records

    def __len__(self) -> int:
        return len(self._records)

    @property
    def time(self) -> NDArray[np.float64]:
        """Simulated time of each message, shape (n,) [s]."""
        return np.asarray(self.time_ns * 1e-9)

    def content(self) -> bytes:
        """Bytes of all messages in order, for exact comparison of two runs."""
        return self._records.tobytes()

    def field(self, name: str) -> NDArray[Any]:
        """Values of one field, shape (n, *field shape).

        Raises:
            LogError: the channel has no such field.
        """
        if all(field.name != name for field in self.fields):
            right = nearest(name, [field.name for field in self.fields])
            raise LogError(f"channel {self.topic} has no field '{name}'; {right}")
        return np.array(self._records[name])


class Log:
    """A log file.

    Attributes:
        path: where it is.
        size: of the file [bytes].
        metadata: named records of key and value; of equal names the last.
        attachments: contents by name.
        topics: every topic, in order of channel id.
        truncated: whether the end of the file is missing, as after a killed run.
        damage: what could not be read, in words; grows as channels are loaded.
        contents: records of the file and their places.
        data: bytes of the file.
    """

    def __init__(self, path: Path, data: Buffer) -> None:
        self.path = path
        self.size = len(data)
        self.data = data
        self.contents = contents = scan(data)
        self.truncated = contents.truncated
        self.damage = contents.damage
        self._index_rest()
        self.metadata = {record.name: record.metadata for record in contents.metadata}
        self.attachments = {record.name: record.data for record in contents.attachments}
        self._ids = {channel.topic: number for number, channel in sorted(contents.channels.items(), reverse=True)}
        self.topics = tuple(reversed(self._ids))
        self._loaded: dict[str, ChannelData] = {}

    def __contains__(self, topic: str) -> bool:
        return topic in self._ids

    def __getitem__(self, topic: str) -> ChannelData:
        """Messages of a topic; errors as of `load`."""
        self.load(topic)
        return self._loaded[topic]

    def load(self, *topics: str) -> None:
        """Load topics in one pass through the file.

        Raises:
            LogError: there is no such topic, or its messages are not of a fixed layout.
        """
        wanted = {topic: self._layout(topic) for topic in topics if topic not in self._loaded}
        if not wanted:
            return
        blocks: dict[str, list[NDArray[np.uint8]]] = {topic: [] for topic in wanted}
        for data, index in self._indexed_blocks({self._ids[topic] for topic in wanted}):
            for topic, fields in wanted.items():
                number = self._ids[topic]
                if number in index:
                    block, bad = records_of(data, index[number], number, record_dtype(fields))
                    blocks[topic].append(block)
                    if bad:
                        self.damage.append(f"{bad} messages of {topic} are damaged or not of its layout")
        for topic, fields in wanted.items():
            whole = np.concatenate(blocks[topic]) if blocks[topic] else np.zeros(0, np.uint8)
            self._loaded[topic] = ChannelData(topic, fields, whole.view(record_dtype(fields)))

    def count(self, topic: str) -> int:
        """Number of messages of a topic, by the index."""
        number = self._ids[topic]
        chunked = sum(len(chunk.index.get(number, ())) for chunk in self.contents.chunks)
        return chunked + len(self.contents.loose.get(number, ()))

    def time_range(self) -> tuple[float, float]:
        """First and last time of all messages [s]; zeros when there is none."""
        starts = [chunk.start_ns for chunk in self.contents.chunks]
        ends = [chunk.end_ns for chunk in self.contents.chunks]
        loose = [time for entries in self.contents.loose.values() for time, _ in entries]
        return min([*starts, *loose], default=0) * 1e-9, max([*ends, *loose], default=0) * 1e-9

    def verify(self) -> None:
        """Compare every chunk with its checksum; what does not agree is added to `damage`."""
        for _ in self.sound_chunks():
            pass

    def sound_chunks(self) -> Iterator[tuple[ChunkPlace, bytes]]:
        """Every chunk that agrees with its checksum, and its decompressed bytes; the others add to `damage`."""
        for chunk in self.contents.chunks:
            data = self._decompressed(chunk)
            if data is not None and chunk.crc and zlib.crc32(data) != chunk.crc:
                self.damage.append(f"the chunk at byte {chunk.position} does not agree with its checksum")
            elif data is not None:
                yield chunk, data

    def _layout(self, topic: str) -> tuple[FieldSpec, ...]:
        if topic not in self._ids:
            raise LogError(f"{self.path}: no topic '{topic}'; {nearest(topic, self.topics or ('none',))}")
        try:
            return layout_of(self.contents.channels[self._ids[topic]].metadata)
        except ValueError:
            right = "read it by its schema with the mcap package"
            raise LogError(f"{self.path}: topic {topic} states no layout of fixed size; {right}") from None

    def _indexed_blocks(self, numbers: set[int]) -> Iterator[tuple[Buffer, dict[int, NDArray[np.void]]]]:
        """Bytes and index of everything that holds messages of these channels."""
        if numbers & self.contents.loose.keys():
            yield self.data, {n: np.array(e, INDEX_ENTRY) for n, e in self.contents.loose.items()}
        for chunk in self.contents.chunks:
            if numbers & chunk.index.keys():
                data = self._decompressed(chunk)
                if data is not None:
                    yield data, chunk.index

    def _decompressed(self, chunk: ChunkPlace) -> bytes | None:
        try:
            return decompress(self.data[chunk.data], chunk.compression, chunk.size)
        except LogError as error:
            note = f"at byte {chunk.position} {error}"
            if note not in self.damage:
                self.damage.append(note)
            return None

    def _index_rest(self) -> None:
        """Index chunks that stand without an index, or whose channels are defined only inside them."""
        for chunk in self.contents.chunks:
            if not chunk.index or chunk.index.keys() - self.contents.channels.keys():
                data = self._decompressed(chunk)
                if data is not None:
                    chunk.index = index_chunk(data, self.contents)


def read(path: str | Path) -> Log:
    """Open a log.

    Raises:
        LogError: there is no such file, or it is no MCAP file.
    """
    path = Path(path)
    try:
        with path.open("rb") as file:
            magic = file.read(len(MAGIC))
            if magic != MAGIC:
                raise LogError(f"{path}: not an MCAP file; give a log that `surefoot run` has written")
            return Log(path, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ))
    except IsADirectoryError:
        raise LogError(f"{path}: a directory; give a log file") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise LogError(f"{path}: cannot be read, {str(reason).lower()}; give a log file") from None
