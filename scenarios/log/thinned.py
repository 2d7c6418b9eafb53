"""A copy of a log with few messages in a second, small enough to be kept beside many others."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from surefoot.scenarios.log.messages import ChannelData
from surefoot.scenarios.log.reader import Log
from surefoot.scenarios.log.spec import ChannelSpec
from surefoot.scenarios.log.thinning import Sieve
from surefoot.scenarios.log.writer import AttachedFile, LogWriter
from surefoot.scenarios.output import write_whole

_ATTACHED = "application/octet-stream"


def write_thinned(log: Log, path: Path, rate: int, but: frozenset[str] = frozenset()) -> None:
    """Write the channels of a log whose layout is known with at most so many messages in a second.

    Of logs whose ticks are at the same times the same ones are kept, so that two copies can be compared.

    Args:
        log: to copy.
        path: of the copy.
        rate: messages that each channel has at most in a second [Hz].
        but: topics that are left out.

    Raises:
        LogError: the file exists, or cannot be written.
    """
    topics = [topic for topic in log.numeric if topic not in but]
    attachments = [AttachedFile(name, _ATTACHED, data) for name, data in log.attachments.items()]
    with write_whole(path) as temporary:
        temporary.unlink()
        with LogWriter(temporary, log.metadata, attachments, "zstd") as writer:
            channels = {topic: writer.channel(_spec(log, topic)) for topic in topics}
            for time_ns, topic, values in _messages(log, topics, rate):
                channels[topic].append(time_ns, *values)


def _spec(log: Log, topic: str) -> ChannelSpec:
    return ChannelSpec(topic, topic.strip("/").replace("_", " ").title().replace(" ", ""), log.fields(topic))


def _messages(log: Log, topics: list[str], rate: int) -> Iterator[tuple[int, str, tuple[NDArray[np.generic], ...]]]:
    """Time, topic and values of each message that is kept, in the order of time."""
    sieves = {topic: Sieve(rate) for topic in topics}
    for _, channels in log.stretches(topics):
        found = [(time, topic, row) for topic, part in channels.items() for time, row in _rows(part, sieves[topic])]
        values = {topic: [part.field(field.name) for field in part.fields] for topic, part in channels.items()}
        for time, topic, row in sorted(found, key=lambda one: one[0]):
            yield time, topic, tuple(column[row] for column in values[topic])


def _rows(part: ChannelData, sieve: Sieve) -> Iterator[tuple[int, int]]:
    """Times and rows of the messages that a sieve takes."""
    for row, time in enumerate(part.time_ns.tolist()):
        if sieve.takes(time):
            yield time, row
