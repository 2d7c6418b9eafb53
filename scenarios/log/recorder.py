"""A flight recorder: of a run however long, a log that has its beginning and what came last."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from mcap.records import Metadata

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log.file import Head, IndexedChunk, LogFile

KEPT_RECORD = "kept"
"""Metadata record of a log that lacks the beginning of its run."""


@dataclass(frozen=True, slots=True)
class Kept:
    """The part of a run that is in its log.

    Attributes:
        keep: time that was to be kept at least [s].
        begin: time from which on the log has all messages [s].
        dropped: number of messages before.
    """

    keep: float
    begin: float
    dropped: int

    def to_metadata(self) -> dict[str, str]:
        """Write as metadata."""
        return {"keep": repr(self.keep), "from": repr(self.begin), "messages_dropped": str(self.dropped)}

    @classmethod
    def from_metadata(cls, records: Mapping[str, Mapping[str, str]], log_name: str) -> "Kept | None":
        """Read back; None where the log has its run from the beginning.

        Raises:
            LogError: the record cannot be read.
        """
        if KEPT_RECORD not in records:
            return None
        record = records[KEPT_RECORD]
        try:
            kept = cls(float(record["keep"]), float(record["from"]), int(record["messages_dropped"]))
            if not (0.0 < kept.keep < math.inf and 0.0 < kept.begin < math.inf and kept.dropped >= 0):
                raise ValueError("no such time or number")
        except (KeyError, ValueError):
            what = "does not say in words that can be read what of its run it keeps"
            raise LogError(f"{log_name}: {what}; give a log that `surefoot run` has written") from None
        return kept


class FlightRecorder:
    """A log of the last of a run; see `surefoot.scenarios.log.file.Sink`.

    Two files are written at once. The log holds at least what is to be kept. Once the other, begun when the log was
    full, holds as much, it takes the name of the log, and a new one is begun. So a process that is killed at any moment
    leaves a log that has lost no more of its end than one that keeps everything. It holds at most twice the time that
    is to be kept, and both together three times.

    Args:
        path: of the log.
        head: its first records.
        keep_ns: time that is to be kept [ns].

    Attributes:
        path: of the log.

    Raises:
        LogError: the file exists, or cannot be created.
    """

    def __init__(self, path: Path, head: Iterable[Head], keep_ns: int) -> None:
        self.path, self._head, self._keep_ns = path, list(head), keep_ns
        self._log = LogFile(path, self._head)
        self._successor: LogFile | None = None
        self._begun_ns: int | None = None  # of the file that was begun last
        self._messages = 0

    @property
    def closed(self) -> bool:
        """See `Sink`."""
        return self._log.closed

    def add(self, record: Head) -> None:
        """See `Sink`; every log to come has the record."""
        self._head.append(record)
        try:
            self._log.add(record)
        except LogError:
            self._drop_successor()
            raise
        if self._successor is not None:
            self._successor.add(record)

    def add_chunk(self, indexed: IndexedChunk) -> None:
        """See `Sink`."""
        start, end = indexed.chunk.message_start_time, indexed.chunk.message_end_time
        if self._begun_ns is None:
            self._begun_ns = start
        # By the clock alone, so that the same run has the same log, however often somebody wrote records beside it.
        if self._successor is None and indexed.opens and start - self._begun_ns >= self._keep_ns:
            self._begin_successor(start)
        try:
            self._log.add_chunk(indexed)
        except LogError:
            self._drop_successor()
            raise
        self._messages += sum(indexed.counts.values())
        if self._successor is not None:
            self._successor.add_chunk(indexed)
            if end - self._begun_ns >= self._keep_ns:
                self._hand_over(self._successor)

    def finish(self) -> None:
        """See `Sink`."""
        try:
            self._settle()
            self._log.finish()
        finally:
            self._drop_successor()

    def discard(self) -> None:
        """See `Sink`."""
        self._drop_successor()
        self._log.discard()

    def _begin_successor(self, start_ns: int) -> None:
        kept = Kept(self._keep_ns / 1e9, start_ns / 1e9, self._messages)
        path = self.path.with_name(f"{self.path.name}.next")
        path.unlink(missing_ok=True)  # of a recorder that was killed, whose log was taken away
        self._successor = LogFile(path, [*self._head, Metadata(KEPT_RECORD, kept.to_metadata())], self._given_up)
        self._begun_ns = start_ns

    def _hand_over(self, successor: LogFile) -> None:
        before = self._log
        # At once, so that an interruption leaves one of them the log.
        self._log, self._successor = successor, None
        self._settle()
        before.output.close()

    def _settle(self) -> None:
        """Give the log its name."""
        if self._log.path != self.path:
            try:
                self._log.output.move(self.path)
            except OSError as error:
                raise self._log.output.given_up(error) from None

    def _given_up(self, error: OSError) -> LogError:
        """There is no room for the successor, nor for the log soon."""
        self._drop_successor()
        return self._log.output.given_up(error)

    def _drop_successor(self) -> None:
        if self._successor is not None:
            self._successor.discard()
            self._successor = None
