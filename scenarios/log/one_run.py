"""Checks that a file is the log of one run: nothing stands in it twice or is defined in two ways.

Which of two records of a name is the run's own, or which of two messages of a tick, nobody can say afterwards.
"""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from surefoot.scenarios.log.messages import MESSAGE_BYTES, numbered_at
from surefoot.scenarios.log.scan import INDEX_ENTRY, Buffer, ChunkPlace, Contents, release

_GROUP = 64
"""Chunks whose index is looked at together: some five seconds of a run."""

Decompress = Callable[[ChunkPlace], bytes | None]
"""Gives the bytes of a chunk; None where they cannot be had."""


def twice_named(contents: Contents) -> str:
    """Report a name that stands for two records or channels, or that there are two logs; empty where none does."""
    return next(_twice(contents), "")


def _twice(contents: Contents) -> Iterator[str]:
    metadata = [record.name for record in contents.metadata]
    attachments = [record.name for record in contents.attachments]
    for kind, names in (("metadata", metadata), ("attachment", attachments)):
        for name, count in Counter(names).items():
            if count > 1:
                yield f"its {kind} '{name}' stands there {_times(count)}"
    for topic, count in Counter(channel.topic for channel in contents.channels.values()).items():
        if count > 1:
            yield f"its topic {topic} has {count} channels"
    if contents.another:
        yield f"another log follows behind its end, of {contents.behind} bytes"


def _times(count: int) -> str:
    return "twice" if count == 2 else f"{count} times"


def twin(contents: Contents, data: Buffer, single: Callable[[str], bool], decompress: Decompress) -> str:
    """Report a topic that has a message twice; empty where none has.

    Args:
        contents: of the file.
        data: its bytes.
        single: tells the topics that have one message at a time; others have two of one number and content in no run.
        decompress: unpacks a chunk.
    """
    for number, times in _repeated(contents, data).items():
        channel = contents.channels.get(number)
        if channel is None:
            continue
        if single(channel.topic):
            return f"its topic {channel.topic} has more than one message at {times[0] * 1e-9:.3f} s"
        seen: set[tuple[int, bytes]] = set()
        for message in _messages_at(contents, data, number, times, decompress):
            if message in seen:
                return f"its topic {channel.topic} has a message twice at {message[0] * 1e-9:.3f} s"
            seen.add(message)
    return ""


def _messages_at(
    contents: Contents, data: Buffer, number: int, times: NDArray[np.uint64], decompress: Decompress
) -> Iterator[tuple[int, bytes]]:
    """Times [ns] of the messages of a channel at some times, and their bytes from the sequence number on."""
    wanted, loose = set(times.tolist()), contents.loose.get(number, ())
    yield from ((time, numbered_at(data, at)) for time, at in loose if time in wanted)
    for chunk in contents.chunks:
        entries = chunk.entries(number, data) if chunk.count(number) else np.empty(0, INDEX_ENTRY)
        found = entries[np.isin(entries["time"], times)].tolist()
        whole = decompress(chunk) if found else None
        if whole is not None:
            yield from ((time, numbered_at(whole, at)) for time, at in found if at + MESSAGE_BYTES <= len(whole))


def _repeated(contents: Contents, data: Buffer) -> dict[int, NDArray[np.uint64]]:
    """Times [ns] at which a channel has more than one message by the index, by channel id, each shape (n,)."""
    unordered = {number for number, times in contents.loose.items() if not _ascends(_loose_times(times))}
    last: dict[int, int] = {}
    for number in contents.loose.keys() - unordered:
        last[number] = contents.loose[number][-1][0]
    chunks = contents.chunks
    for start in range(0, len(chunks), _GROUP):
        group = chunks[start : start + _GROUP]
        for number, times in _times_of(group, data).items():
            if not _ascends(times) or times[0] <= last.get(number, -1):
                unordered.add(number)
            last[number] = int(times[-1])
        release(data, group[0].position, group[-1].position + group[-1].length)
    found = {number: _more_than_once(_all_times(contents, data, number)) for number in unordered}
    return {number: times for number, times in found.items() if len(times)}


def _times_of(chunks: Sequence[ChunkPlace], data: Buffer, only: int | None = None) -> dict[int, NDArray[np.uint64]]:
    """Times of the messages in some chunks in the order of their index, by channel id, each of one message or more."""
    parts: dict[int, list[bytes]] = {}
    for chunk in chunks:
        if chunk.made is not None:
            for number, entries in chunk.made.items():
                parts.setdefault(number, []).append(entries.tobytes())
            continue
        places = chunk.places
        for at in range(0, len(places), 3):
            if only is None or places[at] == only:
                parts.setdefault(places[at], []).append(data[places[at + 1] : places[at + 2]])
    joined = {number: np.frombuffer(b"".join(found), INDEX_ENTRY)["time"] for number, found in parts.items()}
    return {number: times for number, times in joined.items() if len(times)}


def _all_times(contents: Contents, data: Buffer, number: int) -> NDArray[np.uint64]:
    chunked = _times_of(contents.chunks, data, number).get(number, np.zeros(0, np.uint64))
    return np.concatenate((chunked, _loose_times(contents.loose.get(number, ()))))


def _loose_times(entries: Sequence[tuple[int, int]]) -> NDArray[np.uint64]:
    return np.array([time for time, _ in entries], np.uint64)


def _ascends(times: NDArray[np.uint64]) -> bool:
    return bool(np.all(times[1:] > times[:-1]))


def _more_than_once(times: NDArray[np.uint64]) -> NDArray[np.uint64]:
    ordered = np.sort(times)
    return np.unique(ordered[1:][ordered[1:] == ordered[:-1]])
