"""Messages of one channel as numpy arrays by field name."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from scenarios.errors import LogError, nearest
from scenarios.log.spec import FieldSpec


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
        return np.asarray(self.time_ns / 1e9)

    def between(self, start_ns: int, end_ns: int) -> "ChannelData":
        """The messages from a time on and up to another one [ns]."""
        first, last = np.searchsorted(self.time_ns, (start_ns, end_ns + 1))
        return ChannelData(self.topic, self.fields, self._records[first:last])

    def content(self) -> bytes:
        """Bytes of all messages in order, for exact comparison of two runs."""
        return self._records.tobytes()

    def field(self, name: str) -> NDArray[Any]:
        """Values of one field, shape (n, *field shape).

        Raises:
            LogError: the channel has no such field.
        """
        self._require(name)
        return np.array(self._records[name])

    def only(self, name: str) -> "ChannelData":
        """The same messages with one field; errors as of `field`."""
        self._require(name)
        return ChannelData(self.topic, tuple(field for field in self.fields if field.name == name), self._records)

    def _require(self, name: str) -> None:
        if all(field.name != name for field in self.fields):
            right = nearest(name, [field.name for field in self.fields])
            raise LogError(f"channel {self.topic} has no field '{name}'; {right}")
