"""Channels of a log of which only some messages are written: at most so many in a second."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from numpy.typing import ArrayLike

from surefoot.scenarios.log.channel import ChannelWriter, Clock, MessageWriter
from surefoot.scenarios.log.layout import Array
from surefoot.scenarios.log.rows import RowWriter
from surefoot.scenarios.log.spec import ChannelSpec

THINNED = "thinned"
"""Key in the metadata of a channel that is thinned: messages that it has at most in a second."""


class Sieve:
    """Says which messages of a channel are written: the first from each multiple of a period on.

    Args:
        rate: messages that it has at most in a second [Hz].

    Attributes:
        rate: messages that it has at most in a second [Hz].
    """

    def __init__(self, rate: int) -> None:
        self.rate, self._due = rate, 0

    def takes(self, time_ns: int) -> bool:
        """Return true if a message at a time, no earlier than that of the one before, is written [ns]."""
        if time_ns < self._due:
            return False
        self._due = -(-(time_ns * self.rate // 10**9 + 1) * 10**9 // self.rate)
        return True


@dataclass(frozen=True, slots=True)
class Thinning:
    """The thinning of channels.

    Attributes:
        rate: messages that a thinned channel has at most in a second [Hz].
        whole: topics that are not thinned.
    """

    rate: int
    whole: frozenset[str]

    def sieve(self, topic: str) -> Sieve | None:
        """The sieve of a topic; None where it is not thinned."""
        return None if topic in self.whole else Sieve(self.rate)


class ThinnedChannel(ChannelWriter):
    """A channel of a fixed layout that is thinned."""

    def __init__(self, spec: ChannelSpec, channel_id: int, capacity: int, clock: Clock, sieve: Sieve) -> None:
        super().__init__(spec, channel_id, capacity, clock)
        self._sieve = sieve

    def append(self, time_ns: int, *values: ArrayLike) -> None:
        """See `ChannelWriter`."""
        if self._sieve.takes(time_ns):
            super().append(time_ns, *values)

    def filler(self, attributes: Mapping[str, str], given: Sequence[str] = ()) -> Callable[..., None]:
        """See `ChannelWriter`."""
        fill = super().filler(attributes, given)

        def thinned(time_ns: int, source: object, *more: ArrayLike) -> None:
            if self._sieve.takes(time_ns):
                fill(time_ns, source, *more)

        return thinned


class ThinnedMessages(MessageWriter):
    """A channel of encoded messages that is thinned."""

    def __init__(self, channel_id: int, clock: Clock, sieve: Sieve) -> None:
        super().__init__(channel_id, clock)
        self._sieve = sieve

    def append(self, time_ns: int, data: bytes) -> None:
        """See `MessageWriter`."""
        if self._sieve.takes(time_ns):
            super().append(time_ns, data)


class ThinnedRows:
    """Rows of channels that are thinned together; see `RowWriter`."""

    def __init__(self, rows: RowWriter, sieve: Sieve) -> None:
        self._rows, self._sieve = rows, sieve

    def append(self, time_ns: int, numbers: tuple[float, ...], *vectors: Array) -> None:
        """See `RowWriter`."""
        if self._sieve.takes(time_ns):
            self._rows.append(time_ns, numbers, *vectors)
