"""Evidence that no message of a log is missing: each chunk holds what its index lists, and numbers have no gap."""

import zlib
from array import array
from collections import Counter
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby, pairwise

import numpy as np
from mcap.opcode import Opcode
from numpy.typing import NDArray

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log.recorder import Kept
from surefoot.scenarios.log.scan import (
    INDEX_ENTRY,
    PREFIX,
    Buffer,
    ChunkPlace,
    Contents,
    records_in,
    release,
    take_definition,
)
from surefoot.scenarios.log.spec import PACKAGE

_HEADER = np.dtype(
    [("opcode", "u1"), ("length", "<u8"), ("channel", "<u2"), ("sequence", "<u4"), ("time", "<u8"), ("publish", "<u8")]
)
"""A message record without its content."""


_STAMP = np.dtype([("tag", "u1"), ("time", "<u8")])
"""Head with which the content of a message of ours begins."""

_STAMP_TAG = 1 << 3 | 1
_STAMPED_BYTES = _HEADER.itemsize - PREFIX.size + _STAMP.itemsize


def _listed(chunk: ChunkPlace, data: Buffer) -> tuple[NDArray[np.uint16], NDArray[np.void]]:
    """Channels, and times and offsets, of all messages of a chunk by its index, each shape (n,)."""
    if chunk.made is None:
        places = chunk.places
        numbers = list(places[::3])
        parts = [data[start:stop] for start, stop in zip(places[1::3], places[2::3], strict=True)]
    else:
        numbers, parts = list(chunk.made), [found.tobytes() for found in chunk.made.values()]
    channels = np.repeat(np.array(numbers, np.uint16), [len(part) // INDEX_ENTRY.itemsize for part in parts])
    return channels, np.frombuffer(b"".join(parts), INDEX_ENTRY)


def _headers_at(data: Buffer, offsets: NDArray[np.uint64]) -> NDArray[np.void]:
    """Headers of the messages at some offsets, shape (n,); zeros where they would end beyond the data."""
    found = np.zeros(len(offsets), _HEADER)
    if len(data) >= _HEADER.itemsize:
        inside = offsets <= len(data) - _HEADER.itemsize
        places = np.add.outer(offsets[inside].astype(np.int64), np.arange(_HEADER.itemsize))
        found[inside] = np.frombuffer(data, np.uint8)[places].view(_HEADER).ravel()
    return found


@dataclass(frozen=True, slots=True)
class Count:
    """The count of a log's messages by their sequence numbers.

    Attributes:
        before: number of messages that are missing before the first one, by channel id.
        missing: number of messages that are missing between the first and the last one, by channel id.
        again: number of messages whose number another one of the channel has, by channel id.
    """

    before: dict[int, int]
    missing: dict[int, int]
    again: dict[int, int]


_KEY_BITS = 32


class Numbering:
    """Sequence numbers of messages by channel, in runs of consecutive ones.

    A log counts the messages of a channel from 0 on. Other tools keep these numbers, or write one number for all, or
    count over all channels; by the last two no message can be missed.
    """

    def __init__(self) -> None:
        self._firsts, self._lasts = array("Q"), array("Q")
        self._seen: dict[int, int] = {}

    def add(self, headers: NDArray[np.void]) -> None:
        """Note the numbers of some messages, shape (n,)."""
        if not len(headers):
            return
        counts = np.bincount(headers["channel"])
        for number in np.flatnonzero(counts).tolist():
            self._seen[number] = self._seen.get(number, 0) + int(counts[number])
        keys = np.sort(headers["channel"].astype(np.uint64) << np.uint64(_KEY_BITS) | headers["sequence"])
        breaks = np.flatnonzero(keys[1:] - keys[:-1] > 1)
        self._firsts.extend(keys[np.append(0, breaks + 1)].tolist())
        self._lasts.extend(keys[np.append(breaks, -1)].tolist())

    def count(self) -> Count | None:
        """The count; None where they count no channel by itself."""
        spans = {number: list(found) for number, found in self._spans()}
        before: dict[int, int] = {}
        missing: dict[int, int] = {}
        again: dict[int, int] = {}
        begin = int(all(found[0][0] == 1 for found in spans.values()))  # some count from 1 on
        for number, found in spans.items():
            distinct = sum(last - first + 1 for first, last in found)
            if distinct == 1 < self._seen[number]:
                return None
            first, last = found[0][0], found[-1][1]
            before |= {number: first - begin} if first > begin else {}
            missing |= {number: last + 1 - first - distinct} if last + 1 - first > distinct else {}
            again |= {number: self._seen[number] - distinct} if self._seen[number] > distinct else {}
        return None if missing and _of_all_together(spans) else Count(before, missing, again)

    def _spans(self) -> Iterator[tuple[int, list[tuple[int, int]]]]:
        """Runs of each channel in order, none of which touches another one."""
        runs = sorted(zip(self._firsts, self._lasts, strict=True))
        for number, own in groupby(runs, key=lambda run: run[0] >> _KEY_BITS):
            spans: list[tuple[int, int]] = []
            for run in own:
                first, last = (key & (1 << _KEY_BITS) - 1 for key in run)
                if spans and first <= spans[-1][1] + 1:
                    spans[-1] = spans[-1][0], max(last, spans[-1][1])
                else:
                    spans.append((first, last))
            yield number, spans


def _of_all_together(spans: dict[int, list[tuple[int, int]]]) -> bool:
    """Return true if no two of several channels have a number in common, as with one counter for all of them."""
    ordered = sorted(span for found in spans.values() for span in found)
    return len(spans) > 1 and all(later[0] > earlier[1] for earlier, later in pairwise(ordered))


_TOPICS_SAID = 3
_LOOSE_AT_ONCE = 1 << 15


class Completeness:
    """The evidence that a log is as its run has written it, gathered as its chunks are looked at.

    Args:
        contents: of the file.
        data: its bytes.
    """

    def __init__(self, contents: Contents, data: Buffer) -> None:
        self._contents, self._data = contents, data
        self._numbers, self._astray = Numbering(), Counter[int]()

    def look(self, chunk: ChunkPlace, whole: bytes) -> None:
        """Hold the index of a chunk against its decompressed bytes."""
        where = f"the chunk at byte {chunk.position}"
        channels, listed = _listed(chunk, self._data)
        headers = _headers_at(whole, listed["offset"])
        there = (headers["opcode"] == Opcode.MESSAGE) & (headers["channel"] == channels)
        there &= (headers["time"] == listed["time"]) & (headers["length"] <= len(whole))
        there &= np.minimum(listed["offset"], len(whole)) + headers["length"] + PREFIX.size <= len(whole)
        faults = self._contents.faults
        if absent := np.count_nonzero(~there):
            faults.append(f"{where} has not got {absent} of the messages that its index lists")
        headers, starts = headers[there], listed["offset"][there].astype(np.int64)
        self._note(headers, whole, starts)
        times = headers["time"]
        if len(times) and (times.min() != chunk.start_ns or times.max() != chunk.end_ns):
            faults.append(f"{where} states other times than those of its messages")
        order = np.argsort(starts)
        begins = np.append(starts[order], len(whole))
        ends = np.append(0, starts[order] + headers["length"][order].astype(np.int64) + PREFIX.size)
        if np.any(begins < ends):
            faults.append(f"{where} lists messages that lie one over the other")
        hidden = sum(self._hidden(whole[ends[at] : begins[at]]) for at in np.flatnonzero(begins > ends).tolist())
        if hidden:
            faults.append(f"{where} holds {hidden} messages that its index does not list")

    def _hidden(self, part: bytes) -> int:
        """Messages in a part of a chunk that no index lists; definitions in it have to agree with those known."""
        found = 0
        for opcode, _, body in records_in(part):
            found += opcode == Opcode.MESSAGE
            take_definition(opcode, part[body], self._contents)
        return found

    @cached_property
    def _counted(self) -> Count | None:
        """The count by the numbers of all messages, once all chunks were looked at."""
        for entries in self._contents.loose.values():
            for start in range(0, len(entries), _LOOSE_AT_ONCE):
                offsets = np.array(entries[start : start + _LOOSE_AT_ONCE], INDEX_ENTRY)["offset"]
                self._note(_headers_at(self._data, offsets), self._data, offsets.astype(np.int64))
        return self._numbers.count()

    def _note(self, headers: NDArray[np.void], data: Buffer, starts: NDArray[np.int64]) -> None:
        """Take the numbers of some messages, and hold the times that ours bear against those they are logged at."""
        self._numbers.add(headers)
        ours = self._stamped[headers["channel"]] & (headers["length"] >= _STAMPED_BYTES)
        places = np.add.outer(starts[ours] + _HEADER.itemsize, np.arange(_STAMP.itemsize))
        stamps = np.frombuffer(data, np.uint8)[places].view(_STAMP)[:, 0]
        wrong = (stamps["tag"] != _STAMP_TAG) | (stamps["time"] != headers["time"][ours])
        self._astray.update(headers["channel"][ours][wrong].tolist())

    @cached_property
    def _stamped(self) -> NDArray[np.bool_]:
        """Mark channels whose messages bear their time first, as those of our package do, by their ids."""
        channels, schemas = self._contents.channels, self._contents.schemas
        named = {number: schemas.get(channel.schema_id) for number, channel in channels.items()}
        ours = [number for number, schema in named.items() if schema and schema.name.startswith(f"{PACKAGE}.")]
        table = np.zeros(1 << 16, np.bool_)
        table[ours] = True
        return table

    def missing(self) -> str:
        """Report the number of missing messages; empty where none is."""
        if self._counted is None:
            return ""
        lost = Counter(self._counted.missing)
        if sum(self._counted.before.values()) > self._dropped:
            lost.update(self._counted.before)
        return f"{sum(lost.values())} messages of {self._named(lost)} are missing" if lost else ""

    @property
    def _dropped(self) -> int:
        """Number of messages that the log itself says were dropped, before all others."""
        records = {record.name: record.metadata for record in self._contents.metadata}
        try:
            kept = Kept.from_metadata(records, "")
        except LogError:
            return 0
        return 0 if kept is None else kept.dropped

    def contradictions(self) -> Iterator[str]:
        """Parts of the log that contradict the rest, once everything was looked at; some are empty."""
        yield self.data_fault
        yield from (*self._contents.conflicts, *self._contents.faults)
        again = {} if self._counted is None else self._counted.again
        if again:
            yield f"{sum(again.values())} messages of {self._named(again)} have the number of another one"
        if astray := self._astray:
            yield f"{astray.total()} messages of {self._named(astray)} are logged at other times than they bear"
        if not self.proven:
            yield self._index_fault
        if self._contents.behind:
            yield f"{self._contents.behind} bytes stand behind its end"

    def unproven(self) -> tuple[str, ...]:
        """The evidence that is missing, in words."""
        ends = self._contents.data_end is not None
        absent = {
            "it has no checksum of its data": ends and not self._contents.data_crc,
            "its messages are not numbered, by which a missing one would be seen": self._counted is None,
            "its index is missing": ends and self._contents.truncated,
            "its index does not agree with its data": self.proven and bool(self._index_fault),
        }
        return tuple(what for what, is_absent in absent.items() if is_absent)

    @property
    def proven(self) -> bool:
        """True if the data agree with a checksum of all of them."""
        return self._contents.data_end is not None and self._contents.data_crc != 0 and not self.data_fault

    @cached_property
    def data_fault(self) -> str:
        """Reason why the data as a whole are not those that were written; empty if they are, or if nothing shows it."""
        end, crc, step = self._contents.data_end, 0, 1 << 22
        if end is None or not self._contents.data_crc:
            return ""
        data = memoryview(self._data)  # of a memory map, whose slices would be copies
        for start in range(0, end, step):
            crc = zlib.crc32(data[start : min(start + step, end)], crc)
            release(self._data, start, start + step)
        return "" if crc == self._contents.data_crc else "its data do not agree with their checksum"

    @cached_property
    def _index_fault(self) -> str:
        """Fault of the counts in the index at the end of the file; empty where there is none."""
        said, here = self._contents.statistics, self._contents
        if not here.index_sound:
            return "its index does not agree with its checksum"
        if said is None:
            return ""
        counts = [
            ("chunks", said.chunk_count, len(here.chunks)),
            ("attachments", said.attachment_count, len(here.attachments)),
            ("metadata records", said.metadata_count, len(here.metadata)),
        ]
        for number, channel in here.channels.items():
            stated, count = said.channel_message_counts.get(number, 0), len(here.loose.get(number, ()))
            counts.append(
                (f"messages of {channel.topic}", stated, count + sum(one.count(number) for one in here.chunks))
            )
        wrong = (
            f"its index counts {stated} {what}, and {count} are there"
            for what, stated, count in counts
            if stated != count
        )
        return next(wrong, "")

    def _named(self, numbers: Collection[int]) -> str:
        """Topics of channels, of many the first ones."""
        known = self._contents.channels
        topics = [known[number].topic if number in known else f"channel {number}" for number in sorted(numbers)]
        more = len(topics) - _TOPICS_SAID
        return ", ".join(topics) if more <= 1 else f"{', '.join(topics[:_TOPICS_SAID])} and {more} other topics"
