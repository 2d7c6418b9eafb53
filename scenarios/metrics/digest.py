"""What metrics and health checks need of a log, gathered in one pass with bounded memory."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from scenarios.log import Log

KEPT: Mapping[str, tuple[str, ...]] = {
    "/measurement": ("external_force",),
    "/truth": (
        *("com", "com_velocity", "left_sole", "right_sole", "torso_tilt", "nonfoot_contact", "self_contact"),
        "external_force",  # of the pendulum
    ),
    "/estimate": ("com",),
    "/planner_state": ("com", "com_velocity"),
    "/contact": ("zmp", "normal_force", "planned", "felt", "cop_left", "cop_right"),
    "/reference": ("com_acceleration", "zmp_reference", "omega", "phase", "phase_duration", "stance", "step"),
    "/wbc": ("status", "solver", "fallback"),
    "/torque": (),
    "/timing": ("state", "wbc_build", "wbc_solve", "planner", "physics", "log", "tick"),
    "/plan": ("held", "status"),
    "/footstep": ("index", "foot", "planned", "actual"),
}
"""Fields that are held for the whole run; wider ones are reduced tick by tick while the log is read."""


class Channel(Protocol):
    """Messages of a topic."""

    @property
    def time_ns(self) -> NDArray[np.int64]:
        """Simulated time of each, shape (n,) [ns]."""
        ...

    @property
    def time(self) -> NDArray[np.float64]:
        """Simulated time of each, shape (n,) [s]."""
        ...

    def __len__(self) -> int: ...

    def field(self, name: str) -> NDArray[Any]:
        """Values of a field, shape (n, *field shape)."""
        ...


class Source(Protocol):
    """A log, a part of one, or what was kept of one."""

    @property
    def path(self) -> Path:
        """Where the log is."""
        ...

    @property
    def size(self) -> int:
        """Of the log [bytes]."""
        ...

    @property
    def metadata(self) -> Mapping[str, Mapping[str, str]]:
        """Of the log."""
        ...

    def __contains__(self, topic: str) -> bool: ...

    def __getitem__(self, topic: str) -> Channel: ...


class Window:
    """A part of a log."""

    def __init__(self, log: Log, channels: Mapping[str, Channel]) -> None:
        self.path, self.size, self.metadata = log.path, log.size, log.metadata
        self._channels = channels

    def __contains__(self, topic: str) -> bool:
        return topic in self._channels

    def __getitem__(self, topic: str) -> Channel:
        return self._channels[topic]


class KeptChannel:
    """Fields of a channel over the whole run; one that was not kept is read from the log when it is asked for."""

    def __init__(self, log: Log, topic: str, times: Sequence[NDArray[np.int64]], fields: Mapping[str, Any]) -> None:
        self._log, self._topic = log, topic
        self._fields = fields
        self.time_ns: NDArray[np.int64] = np.concatenate(times)

    def __len__(self) -> int:
        return len(self.time_ns)

    @property
    def time(self) -> NDArray[np.float64]:
        """Simulated time of each message, shape (n,) [s]."""
        return np.asarray(self.time_ns / 1e9)

    def field(self, name: str) -> NDArray[Any]:
        """Values of one field, shape (n, *field shape)."""
        kept = self._fields.get(name)
        return self._log[self._topic].field(name) if kept is None else kept


Reduce = Callable[[Source], Mapping[Any, NDArray[Any]]]
"""Reduces a part of a log to narrow arrays by key, in order of time."""


class Digest:
    """What was kept of a log; stands for it where metrics are computed.

    Attributes:
        path: of the log.
        size: of the log [bytes].
        metadata: of the log.
        reduced: what `reduce` gave, over the whole run.
    """

    def __init__(self, log: Log, reduce: Reduce) -> None:
        """Go through the log once; its damage is then known.

        Args:
            log: a log.
            reduce: is applied to every part.
        """
        self.path, self.size, self.metadata = log.path, log.size, log.metadata
        topics = [topic for topic in KEPT if topic in log.numeric]
        times: dict[str, list[NDArray[np.int64]]] = {topic: [] for topic in topics}
        fields: dict[tuple[str, str], list[NDArray[Any]]] = {}
        reduced: dict[Any, list[NDArray[Any]]] = {}
        for channels in log.windows(topics):
            for topic, channel in channels.items():
                times[topic].append(channel.time_ns)
                for name in KEPT[topic]:
                    if any(field.name == name for field in channel.fields):
                        fields.setdefault((topic, name), []).append(channel.field(name))
            for key, values in reduce(Window(log, channels)).items():
                reduced.setdefault(key, []).append(values)
        self.reduced = {key: np.concatenate(parts) for key, parts in reduced.items()}
        kept = {key: np.concatenate(parts) for key, parts in fields.items()}
        self._channels = {
            topic: KeptChannel(log, topic, times[topic], {name: a for (of, name), a in kept.items() if of == topic})
            for topic in topics
        }

    def __contains__(self, topic: str) -> bool:
        return topic in self._channels

    def __getitem__(self, topic: str) -> KeptChannel:
        return self._channels[topic]
