"""A channel whose messages are too many to be held: what is asked for of it is read from the file, part by part."""

from collections.abc import Collection
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from surefoot.scenarios.log.messages import ChannelData
from surefoot.scenarios.log.spec import FieldSpec, record_dtype

if TYPE_CHECKING:
    from surefoot.scenarios.log.reader import Log


class LongChannel(ChannelData):
    """Messages of a channel in order of time, of which each field costs a pass through the file and its own memory."""

    def __init__(self, log: "Log", topic: str, fields: tuple[FieldSpec, ...]) -> None:
        """Stand for a topic of a log, with some of its fields."""
        self._log, self.joints = log, log.joints
        self.topic, self.fields = topic, fields

    def __len__(self) -> int:
        return len(self.time_ns)

    @property
    def time_ns(self) -> NDArray[np.int64]:
        """Simulated time of each message, which is held once it was asked for, shape (n,) [ns]."""
        return self._read_times

    @cached_property
    def _read_times(self) -> NDArray[np.int64]:
        return np.concatenate([np.zeros(0, np.int64), *(part.time_ns for part in self._log.parts(self.topic))])

    def between(self, start_ns: int, end_ns: int) -> ChannelData:
        """See `ChannelData`."""
        return self._log.window(self.topic, 1e-9 * start_ns, 1e-9 * end_ns)

    def content(self) -> bytes:
        """See `ChannelData`."""
        return b"".join(part.content() for part in self._log.parts(self.topic))

    def only(self, name: str) -> ChannelData:
        """See `ChannelData`."""
        return LongChannel(self._log, self.topic, self._chosen(name))

    def values(self, names: Collection[str]) -> dict[str, NDArray[Any]]:
        """See `ChannelData`."""
        most, dtype = self._log.count(self.topic), record_dtype(self._log.fields(self.topic))
        found, end = {name: np.empty((most, *dtype[name].shape), dtype[name].base) for name in names}, 0
        for part in self._log.parts(self.topic):
            begin, end = end, end + len(part)
            for name, values in part.values(names).items():
                found[name][begin:end] = values
        return {name: values[:end] for name, values in found.items()}
