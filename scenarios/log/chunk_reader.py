"""The chunks of a log's file: indexed, unpacked, and compared with their checksums."""

import zlib
from collections.abc import Iterable, Iterator

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log.completeness import Completeness
from surefoot.scenarios.log.encoding import decompress
from surefoot.scenarios.log.scan import Buffer, ChunkPlace, Contents, index_chunk, release

_LET_GO = 1 << 22
"""Memory behind the chunk that is read of a file that is gone through [bytes]."""


class ChunkReader:
    """Reads the chunks of a file; those without a sound index are indexed at once.

    Args:
        contents: of the file; its chunks, channels and damage grow as more is read.
        data: its bytes.

    Attributes:
        completeness: what shows that the log is as its run has written it.
    """

    def __init__(self, contents: Contents, data: Buffer) -> None:
        self._contents, self._data = contents, data
        self._verified: set[int] = set()
        self.completeness = Completeness(contents, data)
        self._index_rest()

    def verify(self) -> None:
        """Compare every chunk that has not been compared yet; see `Log.verify`."""
        left = (chunk for chunk in self._contents.chunks if chunk.position not in self._verified)
        for _ in self.unpacked(left, verify=True):
            pass

    def unpacked(self, chunks: Iterable[ChunkPlace], verify: bool = False) -> Iterator[tuple[ChunkPlace, bytes]]:
        """Unpack the chunks that can be unpacked, with their bytes; the memory of the file is let go behind them."""
        begin = end = 0
        for chunk in chunks:
            data = self._sound(chunk) if verify else self.decompressed(chunk)
            if data is not None:
                yield chunk, data
            if not begin <= chunk.position <= begin + _LET_GO:
                release(self._data, begin, end)
                begin = chunk.position
            end = chunk.position + chunk.length
        release(self._data, begin, end)

    def _sound(self, chunk: ChunkPlace) -> bytes | None:
        """Decompressed bytes of a chunk if they agree with its checksum, as all do of data that agree with theirs."""
        data, known = self.decompressed(chunk), chunk.position in self._verified
        self._verified.add(chunk.position)
        if data is None:
            return None
        if self.completeness.proven or not chunk.crc or zlib.crc32(data) == chunk.crc:
            if not known:
                self.completeness.look(chunk, data)
            return data
        if not known:
            self._contents.damage.append(f"the chunk at byte {chunk.position} does not agree with its checksum")
        return None

    def decompressed(self, chunk: ChunkPlace) -> bytes | None:
        """Bytes of a chunk; None where they cannot be had, which is noted."""
        try:
            return decompress(memoryview(self._data)[chunk.data], chunk.compression, chunk.size)
        except LogError as error:
            self.note(f"at byte {chunk.position} {error}")
            return None

    def note(self, loss: str) -> None:
        """Note what could not be read, once."""
        if loss not in self._contents.damage:
            self._contents.damage.append(loss)

    def _index_rest(self) -> None:
        """Index chunks that stand without an index, or whose channels are defined only inside them."""
        for chunk in self._contents.chunks:
            foreign = chunk.channels - self._contents.channels.keys()
            doubled = len(chunk.channels) < len(chunk.places) // 3
            if not chunk.places or chunk.index_damaged or foreign or doubled:
                data = self.decompressed(chunk)
                if data is not None:
                    chunk.made = index_chunk(data, self._contents)
        used = set().union(*(chunk.used for chunk in self._contents.chunks))
        for chunk in self._contents.chunks:  # one may define what only later ones use
            if not used - self._contents.channels.keys():
                break
            index_chunk(self.decompressed(chunk) or b"", self._contents)
