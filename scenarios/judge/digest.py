"""A log as metrics and health checks see it: gathered in one pass with bounded memory, on common control ticks."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from surefoot.planner.geometry.plane import headings
from surefoot.scenarios.columns import Columns, KeptChannel, Reads, keep
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.judge.body import knees
from surefoot.scenarios.log.recorder import Kept
from surefoot.scenarios.record.provenance import RunConstants

if TYPE_CHECKING:
    from surefoot.scenarios.log import ChannelData, Log

T = TypeVar("T")

CONTROL_TOPICS = ("/measurement", "/truth", "/estimate", "/contact", "/reference", "/wbc", "/torque", "/timing")
"""Topics with a message in every control tick."""

SENSED = "/estimation"
"""Topic with a message in every control tick of runs whose estimator senses."""

GAIT = "/gait"
"""Topic with a message in every control tick of runs of a seat: the gait as feet feel it.

Of other runs the fields ``phase`` and ``stance`` of ``/reference``, the gait as planned, are found under this name.
"""

PLANNED = ("/reference", "/plan", "/planner_state", "/footsteps", "/wbc", "/estimate")
"""Topics of planner and whole-body controller, which a run has not with another controller in their seat."""

HELD: Reads = {
    **dict.fromkeys((*CONTROL_TOPICS, SENSED, "/planner_state", "/plan", "/footstep"), ()),
    "/truth": ("left_sole", "right_sole"),
    GAIT: ("phase",),
}
"""Topics whose times every digest holds, and the fields that `RunView` itself reads."""


_LACKING = {"full": (GAIT,), "pendulum": ("/measurement", "/estimate", "/wbc", "/torque", GAIT), "seat": PLANNED}
"""Topics that runs of a kind of walker never have."""


def always(walker: str) -> tuple[str, ...]:
    """Topics that every run of a kind of walker writes; see `RunConstants.walker`."""
    topics = (*CONTROL_TOPICS, GAIT, "/planner_state", "/plan", "/footstep")
    return tuple(topic for topic in topics if topic not in _LACKING[walker])


Channel: TypeAlias = "ChannelData | KeptChannel"


class AbsentError(LogError):
    """A log lacks a topic that is needed.

    Attributes:
        topic: the one.
    """

    def __init__(self, path: Path, topic: str) -> None:
        self._path, self.topic = path, topic
        super().__init__(f"{path}: has no topic {topic}, which its metrics need; give the whole log")

    def __reduce__(self) -> tuple[type["AbsentError"], tuple[Path, str]]:
        """Survive the way between processes."""
        return type(self), (self._path, self.topic)


class Window:
    """Some channels of a log: of a part of it, or what was kept of the whole.

    Attributes:
        path: of the log.
        size: of the log [bytes].
        metadata: of the log.
        attachments: of the log.
    """

    def __init__(self, log: "Log", channels: Mapping[str, Channel]) -> None:
        self.path, self.size = log.path, log.size
        self.metadata, self.attachments = log.metadata, log.attachments
        self._channels = channels

    def __contains__(self, topic: str) -> bool:
        return topic in self._channels

    def __getitem__(self, topic: str) -> Channel:
        """Messages of a topic; AbsentError where the log has none of it."""
        if topic not in self._channels:
            raise AbsentError(self.path, topic)
        return self._channels[topic]


Source: TypeAlias = "Log | Window"

Reduce = Callable[[Source], Mapping[Any, NDArray[Any]]]
"""Reduces a part of a log to narrow arrays by key, in order of time."""


class Digest(Window):
    """The kept part of a log; stands for it where metrics are computed.

    Attributes:
        constants: of the run.
        reduced: what `reduce` gave, over the whole run.
    """

    def __init__(self, log: "Log", constants: RunConstants, reads: Iterable[Reads], reduce: Reduce) -> None:
        """Go through the log once, reducing every part and holding narrow fields; its damage is then known."""
        held, self.constants = _found_under_gait(_united((HELD, *reads)), log), constants
        topics = [topic for topic in held if topic in log.numeric]
        kept, self.reduced = Columns(log.memory), Columns(log.memory)
        for number, channels in enumerate(in_step(log.windows(topics))):
            if number and not any(map(len, channels.values())):
                continue  # nothing was put off: of nothing, the first part has shown all kinds of fields
            keep(kept, channels, held)
            for key, values in reduce(Window(log, channels)).items():
                self.reduced.add(key, np.array(values))  # of which a view would keep all that it is of
        super().__init__(log, {topic: KeptChannel(topic, kept, partial(log.__getitem__, topic)) for topic in topics})


LAG_NS = 100_000_000
"""Longest delay of data [ns]."""


def in_step(windows: Iterable[dict[str, "ChannelData"]]) -> Iterator[dict[str, "ChannelData"]]:
    """The same windows, each with whole control ticks: one whose last messages are in the next chunk is put off."""
    rest: dict[str, ChannelData] = {}
    for channels in windows:
        joined = {topic: rest[topic].joined(channel) if rest else channel for topic, channel in channels.items()}
        control = (topic for topic in (*CONTROL_TOPICS, SENSED, GAIT) if topic in joined)
        clocks = [joined[topic].time_ns for topic in control if len(joined[topic])]
        ends = [int(times[-1]) for times in clocks]
        # No sound channel lags by more than a tick; one that does must not hold up all others.
        last = max(min(ends), max(ends) - LAG_NS) if ends else np.iinfo(np.int64).max - 1
        rest = {topic: channel.between(last + 1, np.iinfo(np.int64).max - 1) for topic, channel in joined.items()}
        yield {topic: channel.between(np.iinfo(np.int64).min, last) for topic, channel in joined.items()}
    yield rest


def _found_under_gait(held: dict[str, list[str]], log: "Log") -> dict[str, list[str]]:
    """The same fields by topic, those of the gait where this log has them."""
    if GAIT in log.numeric:
        return held
    clock = held.pop(GAIT)
    return {**held, "/reference": list(dict.fromkeys((*held["/reference"], *clock)))}


def _united(reads: Iterable[Reads]) -> dict[str, list[str]]:
    """All fields by topic, each once."""
    found: dict[str, list[str]] = {}
    for topics in reads:
        for topic, names in topics.items():
            fields = found.setdefault(topic, [])
            fields += [name for name in names if name not in fields]
    return found


SINGLE_SUPPORT = 2
"""Value of the gait's ``phase`` in single support."""

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Rows = NDArray[np.intp]


class RunView:
    """Fields of a log on the common control ticks, with the run's constants.

    A killed process may leave a tick half written, so control-rate channels are cut to the shortest one.

    Attributes:
        log: the log, a part of it or its digest.
        constants: of its run.
    """

    def __init__(self, log: Source, constants: RunConstants | None = None) -> None:
        self.log = log
        self._made: dict[Callable[[RunView], Any], Any] = {}
        self._there: dict[str, bool] = {}
        known = constants or (log.constants if isinstance(log, Digest) else None)
        self.constants = known or RunConstants.from_metadata(log.metadata, str(log.path))

    def has(self, *topics: str) -> bool:
        """Return true if all of these topics have messages."""
        return all(map(self._has, topics))

    def _has(self, topic: str) -> bool:
        if topic not in self._there:
            found = self._found(topic)
            self._there[topic] = found in self.log and len(self.log[found]) > 0
        return self._there[topic]

    def _found(self, topic: str) -> str:
        """The topic of a log under which it has another; that of the gait is a part of the reference of a plan."""
        return "/reference" if topic == GAIT and GAIT not in self.log else topic

    def field(self, topic: str, name: str) -> Array:
        """A field of a control-rate channel on the common ticks, shape (n, *field shape)."""
        return self.log[self._found(topic)].field(name)[: self.ticks]

    def reduced(self, reduce: "Callable[[RunView], Array]") -> Array:
        """Values that a function makes of each tick or message: out of the digest if it holds them."""
        if isinstance(self.log, Digest) and reduce in self.log.reduced:
            return self.log.reduced[reduce]
        return reduce(self)

    def once(self, function: "Callable[[RunView], T]") -> T:
        """Value that a function makes of the run, for whoever asks: of small things that many metrics need."""
        if function not in self._made:
            self._made[function] = function(self)
        return cast("T", self._made[function])

    @cached_property
    def kept(self) -> Kept | None:
        """The part of the run that a flight recorder has kept; None where the log has all of it."""
        return Kept.from_metadata(self.log.metadata, str(self.log.path))

    @cached_property
    def ticks(self) -> int:
        """Number of common control ticks."""
        control = (*CONTROL_TOPICS, SENSED, GAIT)
        return min((len(self.log[self._found(topic)]) for topic in control if self.has(topic)), default=0)

    @cached_property
    def time(self) -> Array:
        """Time of the control ticks, shape (n,) [s]."""
        return self.log["/truth"].time[: self.ticks]

    @cached_property
    def single_support(self) -> Mask:
        """Ticks in single support, as planned, or as felt where nothing is planned, shape (n,)."""
        return np.asarray(self.field(GAIT, "phase") == SINGLE_SUPPORT)

    @cached_property
    def walking(self) -> slice:
        """Ticks from the first lift-off to the last touchdown; empty when no foot was lifted."""
        swings = np.flatnonzero(self.single_support)
        return slice(int(swings[0]), int(swings[-1]) + 1) if len(swings) else slice(0, 0)

    @cached_property
    def soles(self) -> Array:
        """True poses of the soles, shape (n, 2, 7), x y z qx qy qz qw."""
        return np.stack([self.sole(0), self.sole(1)], axis=1)

    def sole(self, foot: int) -> Array:
        """True poses of the left or right sole (0, 1), shape (n, 7), x y z qx qy qz qw; takes half the memory."""
        return self.field("/truth", ("left_sole", "right_sole")[foot])

    @property
    def sole_yaw(self) -> Array:
        """True headings of the soles, shape (n, 2) [rad]."""
        return np.stack([headings(self.sole(foot)[:, 3:]) for foot in (0, 1)], axis=1)

    @cached_property
    def knees(self) -> list[int]:
        """Indices of the knees among the joints."""
        return knees(self.constants.joint_names, self.constants.roles)

    def rows_at(self, topic: str, times_ns: NDArray[np.int64]) -> tuple[NDArray[np.intp], Mask]:
        """Rows of a channel nearest to given times, and whether they are within half a control tick of them."""
        stamps = self.log[topic].time_ns
        after = np.clip(np.searchsorted(stamps, times_ns), 1, max(len(stamps) - 1, 1))
        before_is_nearer = times_ns - stamps[after - 1] <= np.abs(stamps[np.minimum(after, len(stamps) - 1)] - times_ns)
        rows = np.where(before_is_nearer, after - 1, np.minimum(after, len(stamps) - 1))
        return rows, np.abs(stamps[rows] - times_ns) <= 0.5e9 / self.constants.control_rate
