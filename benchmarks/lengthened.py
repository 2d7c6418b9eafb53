"""A long log made of a short one, without the hours of physics that it would take to run it."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from surefoot.scenarios.log import AttachedFile, ChannelSpec, Log, LogWriter, PublishedSchema, read
from surefoot.scenarios.log.channel import MessageWriter
from surefoot.scenarios.log.writer import CHUNK_PERIOD_NS
from surefoot.scenarios.record.provenance import END_RECORD

TICK_NS = 2_000_000


def lengthened(source: Path, target: Path, seconds: float) -> Path:
    """Write the messages of a log again and again, at later times, until the log is so long [s]; gives its place.

    The robot is back at its beginning each time. Whatever reads the log has as much to read as of a run of that length.
    """
    log = read(source)
    period = round(1e9 * log.time_range()[1]) + TICK_NS
    first = {name: values for name, values in log.metadata.items() if name != END_RECORD}
    files = [AttachedFile(name, "", data) for name, data in log.attachments.items()]
    with LogWriter(target, first, files) as writer:
        rewriter = _Rewriter(log, writer)
        for shift in range(0, round(1e9 * seconds), period):
            rewriter.write(shift, min(shift + period, round(1e9 * seconds)))
        writer.add_metadata(END_RECORD, {**log.metadata.get(END_RECORD, {}), "time": f"{seconds:.3f}"})
    return target


class _Rewriter:
    """Writes all messages of a log to another one, later."""

    def __init__(self, log: Log, writer: LogWriter) -> None:
        self._log, self._writer = log, writer
        self._tables = {}
        for topic in log.numeric:
            channel = log.window(topic, None, None)
            spec = ChannelSpec(topic, self._schema(topic).name.rpartition(".")[2], channel.fields)
            self._tables[topic] = (writer.channel(spec), channel.time_ns, channel.values(_names(spec)))
        self._others: dict[str, tuple[MessageWriter, list[tuple[int, bytes]]]] = {}
        for topic in log.topics:
            if topic not in self._tables:
                self._others[topic] = (writer.message_channel(topic, self._schema(topic), ""), [*log.messages(topic)])

    def _schema(self, topic: str) -> PublishedSchema:
        contents = self._log.contents
        channel = next(channel for channel in contents.channels.values() if channel.topic == topic)
        schema = contents.schemas[channel.schema_id]
        return PublishedSchema(schema.name, schema.data)

    def write(self, shift: int, end: int) -> None:
        """Write them all, later by a shift and up to an end [ns], a chunk after the other."""
        for begin in range(0, end - shift, CHUNK_PERIOD_NS):
            until = min(begin + CHUNK_PERIOD_NS, end - shift)
            for channel, times, values in self._tables.values():
                rows = slice(*np.searchsorted(times, (begin, until)).tolist())
                for name, found in values.items():
                    channel.view(name)[: rows.stop - rows.start] = found[rows]
                stamps = times[rows] + shift
                channel.fill(stamps.tolist(), stamps.astype(np.uint64))
            for writer, messages in self._others.values():
                for time, data in _between(messages, begin, until):
                    writer.append(time + shift, data)
            self._writer.flush()


def _names(spec: ChannelSpec) -> list[str]:
    return [field.name for field in spec.fields]


def _between(messages: list[tuple[int, bytes]], begin: int, end: int) -> Iterator[tuple[int, bytes]]:
    return (message for message in messages if begin <= message[0] < end)
