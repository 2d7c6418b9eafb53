"""Stretches of a log: which chunks are read together, and the messages between two times."""

from collections.abc import Iterable, Iterator
from operator import attrgetter

from surefoot.scenarios.log.encoding import GREATEST_CHUNK
from surefoot.scenarios.log.messages import ChannelData
from surefoot.scenarios.log.scan import ChunkPlace

FARTHEST = 9e9
"""No time of a log is greater: 63 bits of nanoseconds end there [s]."""


FIRST, LAST = -(2**63), 2**63 - 2
"""Bounds of all times [ns]."""

START = attrgetter("start_ns")
"""Start of a chunk: the least time of its messages [ns]."""


def grouped(chunks: Iterable[ChunkPlace], duration: float) -> Iterator[list[ChunkPlace]]:
    """Chunks that are read together: of a duration [s], less where they are large."""
    group: list[ChunkPlace] = []
    size = 0
    for chunk in chunks:
        group.append(chunk)
        size += chunk.size
        if chunk.end_ns - group[0].start_ns >= duration * 1e9 or size > GREATEST_CHUNK:
            yield group
            group, size = [], 0
    if group:
        yield group


def between(found: dict[str, ChannelData], span: tuple[int, int] | None) -> dict[str, ChannelData]:
    """Messages of a stretch of time [ns]."""
    return found if span is None else {topic: channel.between(*span) for topic, channel in found.items()}
