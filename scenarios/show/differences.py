"""Differences of two runs, channel by channel, bit by bit and by a tolerance; and of what their logs were made of."""

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from operator import itemgetter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surefoot.scenarios.errors import LogError, ScenarioError
from surefoot.scenarios.file.source import parse
from surefoot.scenarios.file.units import is_number
from surefoot.scenarios.judge.metrics import measure
from surefoot.scenarios.log import ChannelData, FieldSpec, Log
from surefoot.scenarios.log.stretches import FIRST, LAST, between
from surefoot.scenarios.record.provenance import RECORD, SCENARIO_FILE

WALL_CLOCK = ("/process", "/timing")
"""Topics that differ between any two runs."""

_CHAIN = (
    *("/truth", "/measurement", "/readings", "/contact", "/estimate", "/planner_state"),
    *("/plan", "/footsteps", "/reference", "/wbc", "/torque"),
)
"""The way through a tick: of channels that part at the same time, the first is nearest to the cause."""


@dataclass(frozen=True, slots=True)
class FirstDifference:
    """The first difference of a channel.

    Attributes:
        time: of the message [s].
        field: that differs, with the joint or the index of the element, such as ``q.left_knee`` or ``com[2]``.
        a: its value in the first log.
        b: its value in the second log.
    """

    time: float
    field: str
    a: float
    b: float


@dataclass(frozen=True, slots=True)
class ChannelDifference:
    """The difference of one channel between two logs.

    Attributes:
        topic: of the channel.
        messages: in the first and in the second log.
        exact: first difference of any bit at a time that both have; None without one.
        tolerated: first difference beyond the tolerance; None without one.
        only_one: first time, as far as both logs reach, at which only one has a message [s]; None without one.
        layout: fields that are not in both, or of another shape or kind.
    """

    topic: str
    messages: tuple[int, int]
    exact: FirstDifference | None
    tolerated: FirstDifference | None
    only_one: float | None
    layout: tuple[str, ...]

    @property
    def same(self) -> bool:
        """True if the channels are the same to the last bit."""
        return self.agrees and self.exact is None

    @property
    def agrees(self) -> bool:
        """True if they have the same messages, whose values are within the tolerance."""
        parted = (self.tolerated, self.only_one)
        return parted == (None, None) and not self.layout and self.messages[0] == self.messages[1]

    @property
    def time(self) -> float | None:
        """First time at which the channels part, by value or because one has no message there [s]."""
        return self._first_of(self.exact)

    @property
    def beyond(self) -> float | None:
        """First time at which they part by more than the tolerance, or because one has no message there [s]."""
        return self._first_of(self.tolerated)

    def _first_of(self, value: FirstDifference | None) -> float | None:
        times = [time for time in (value.time if value else None, self.only_one) if time is not None]
        return min(times, default=None)


def compare_channels(a: Log, b: Log, tolerance: float) -> tuple[ChannelDifference, ...]:
    """Compare every channel that both logs have in a layout of ours, in the order in which they part.

    Args:
        a: first log.
        b: second log.
        tolerance: two values agree when they differ by no more than this times the greater magnitude, or than this
            itself when both are below 1.
    """
    common = [one for one in a.topics if one in b and one not in WALL_CLOCK and one in a.numeric and one in b.numeric]
    folds = {topic: _Fold(a.fields(topic), b.fields(topic), tolerance) for topic in common}
    for parts in _together(a, b, common):
        for topic, fold in folds.items():
            fold.add(*(part[topic] for part in parts))
    reach = min(max((fold.last[side] for fold in folds.values()), default=0) for side in (0, 1))
    whole = not (a.truncated or b.truncated)
    # A truncated log has channels that end up to a chunk earlier than others.
    found = (fold.difference(topic, reach if whole else min(reach, *fold.last)) for topic, fold in folds.items())
    return tuple(sorted(found, key=_order))


def unreadable(log: Log, topics: tuple[str, ...]) -> tuple[str, ...]:
    """Topics whose messages are not of a fixed layout, so that they cannot be compared by field."""
    return tuple(topic for topic in topics if topic not in log.numeric)


def _together(a: Log, b: Log, topics: Collection[str]) -> Iterator[tuple[dict[str, ChannelData], ...]]:
    """Messages of both logs before one time after the other, a few seconds of them at once."""
    steps = [log.stretches(topics) for log in (a, b)]
    until, waiting = [FIRST, FIRST], [dict[str, ChannelData](), dict[str, ChannelData]()]
    now = FIRST
    while now <= LAST:
        for side in (0, 1):
            if until[side] == now:
                until[side], more = next(steps[side])
                kept = waiting[side]
                waiting[side] = {topic: kept[topic].joined(more[topic]) if kept else more[topic] for topic in topics}
        now = min(until)
        yield tuple(between(one, (FIRST, now - 1)) for one in waiting)
        waiting = [between(one, (now, LAST)) for one in waiting]


class _Fold:
    """Compares the messages of a channel in two logs, part by part.

    Attributes:
        last: time of the last message in the first and in the second log, 0 without one [ns].
    """

    def __init__(self, a: Sequence[FieldSpec], b: Sequence[FieldSpec], tolerance: float) -> None:
        there = {field.name: field for field in b}
        self._shared = [field for field in a if _same_layout(field, there.get(field.name))]
        self._layout, self._tolerance = tuple(_layout_differences(a, b)), tolerance
        self._messages, self.last = [0, 0], [0, 0]
        self._exact: FirstDifference | None = None
        self._tolerated: FirstDifference | None = None
        self._alone: int | None = None

    def add(self, a: ChannelData, b: ChannelData) -> None:
        """Messages of both between the same two times."""
        for side, part in enumerate((a, b)):
            self._messages[side] += len(part)
            if len(part):
                self.last[side] = max(self.last[side], int(part.time_ns[-1]))
        if self._alone is None:
            alone = np.setxor1d(a.time_ns, b.time_ns)
            self._alone = int(alone[0]) if len(alone) else None
        if self._exact is None or self._tolerated is None:
            self._compare(a, b)

    def _compare(self, a: ChannelData, b: ChannelData) -> None:
        rows_a, rows_b = _paired(a.time_ns, b.time_ns)
        times, exact, tolerated = a.time_ns[rows_a], [], []
        for field in self._shared:
            values = a.field(field.name)[rows_a], b.field(field.name)[rows_b]
            named = partial(field.element, joints=a.joints or b.joints)
            exact += _first(named, times, _bits_differ(*values), *values)
            tolerated += _first(named, times, _values_differ(*values, self._tolerance), *values)
        self._exact, self._tolerated = self._exact or _earliest(exact), self._tolerated or _earliest(tolerated)

    def difference(self, topic: str, reach_ns: int) -> ChannelDifference:
        """The difference of logs that both reach up to a time [ns]."""
        alone = None if self._alone is None or self._alone >= reach_ns else self._alone * 1e-9
        counts = (self._messages[0], self._messages[1])
        return ChannelDifference(topic, counts, self._exact, self._tolerated, alone, self._layout)


def disagreeing(channels: Iterable[ChannelDifference]) -> tuple[ChannelDifference, ...]:
    """Channels that do not agree within the tolerance, in the order in which they part by more."""
    found = (channel for channel in channels if not channel.agrees)
    return tuple(sorted(found, key=lambda one: _place(one.beyond, one.topic)))


def _order(found: ChannelDifference) -> tuple[float, int]:
    return _place(found.time, found.topic)


def _place(time: float | None, topic: str) -> tuple[float, int]:
    place = _CHAIN.index(topic) if topic in _CHAIN else len(_CHAIN)
    return (np.inf if time is None else time, place)


def _paired(a: NDArray[np.int64], b: NDArray[np.int64]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Rows of equal time; of messages at the same time the first with the first, the second with the second."""
    common = min(len(a), len(b))
    if np.array_equal(a[:common], b[:common]):
        return np.arange(common), np.arange(common)
    keys = (_numbered(a), _numbered(b))
    _, rows_a, rows_b = np.intersect1d(*keys, assume_unique=True, return_indices=True)
    return rows_a, rows_b


def _numbered(times: NDArray[np.int64]) -> NDArray[np.void]:
    """Ascending times with a count of equal ones, each pair once."""
    first = np.searchsorted(times, times)
    pairs = np.zeros(len(times), [("time", "<i8"), ("count", "<i8")])
    pairs["time"], pairs["count"] = times, np.arange(len(times)) - first
    return pairs


def _earliest(found: list[tuple[int, FirstDifference]]) -> FirstDifference | None:
    """The difference of the earliest row among several fields; of those in one message the first one."""
    return min(found, key=itemgetter(0))[1] if found else None


def _first(
    named: Callable[[tuple[int, ...]], str],
    times_ns: NDArray[np.int64],
    differs: NDArray[np.bool_],
    a: NDArray[Any],
    b: NDArray[Any],
) -> list[tuple[int, FirstDifference]]:
    """The first row at which a field differs, and its first element there; empty if it does not."""
    rows = np.flatnonzero(differs.reshape(len(differs), -1).any(axis=1)) if len(differs) else np.zeros(0, np.intp)
    if not len(rows):
        return []
    row, element = int(rows[0]), tuple(int(i) for i in np.argwhere(differs[rows[0]])[0])
    values = float(a[row][element]), float(b[row][element])
    return [(row, FirstDifference(float(times_ns[row]) * 1e-9, named(element), *values))]


def _bits_differ(a: NDArray[Any], b: NDArray[Any]) -> NDArray[np.bool_]:
    integer = np.dtype(f"<u{a.dtype.itemsize}")
    return np.asarray(np.ascontiguousarray(a).view(integer) != np.ascontiguousarray(b).view(integer))


def _values_differ(a: NDArray[Any], b: NDArray[Any], tolerance: float) -> NDArray[np.bool_]:
    """Mark values that are farther apart than the tolerance; what is no number agrees with itself alone."""
    with np.errstate(invalid="ignore", over="ignore"):
        scale = np.maximum(1.0, np.maximum(np.abs(a), np.abs(b)))
        apart = ~(np.abs(a.astype(float) - b) <= tolerance * scale)
    return np.asarray(apart & (a != b) & ~(np.isnan(a) & np.isnan(b)))


def _same_layout(a: FieldSpec, b: FieldSpec | None) -> bool:
    return b is not None and (a.shape, a.kind) == (b.shape, b.kind)


def _layout_differences(a: Sequence[FieldSpec], b: Sequence[FieldSpec]) -> Iterator[str]:
    here, there = ({field.name: field for field in fields} for fields in (a, b))
    for name, field in here.items():
        other = there.get(name)
        if other is None:
            yield f"{name} only in A"
        elif not _same_layout(field, other):
            yield f"{name} is {field.kind} {field.shape} in A, {other.kind} {other.shape} in B"
    yield from (f"{name} only in B" for name in there if name not in here)


VERSIONS_RECORD = "versions"
"""Metadata record of what made a log, by which two runs may differ and still be the same."""


@dataclass(frozen=True, slots=True)
class Difference:
    """A named value of two logs, None in the one in which it is not there."""

    name: str
    a: Any
    b: Any

    @property
    def delta(self) -> float | None:
        """Second minus first, when both are numbers."""
        return float(self.b - self.a) if is_number(self.a) and is_number(self.b) else None


def differences(a: Mapping[str, Any], b: Mapping[str, Any]) -> tuple[Difference, ...]:
    """Values by name that are not the same in both."""
    return tuple(pair for pair in _pairs(a, b) if pair.a != pair.b)


def parted(a: Mapping[str, Any], b: Mapping[str, Any], but: str) -> tuple[str, ...]:
    """Names of files or records that are not the same in both, but for one."""
    return tuple(name for name in sorted((a.keys() | b.keys()) - {but}) if a.get(name) != b.get(name))


def settings(log: Log) -> Mapping[str, Any]:
    """Settings of the attached scenario by dotted key; the run's constants where there is none."""
    try:
        return _flat(parse(log.attachments[SCENARIO_FILE].decode(), SCENARIO_FILE).value)
    except (KeyError, UnicodeDecodeError, ScenarioError):
        return log.metadata.get(RECORD, {})


def metric_pairs(a: Log, b: Log) -> tuple[tuple[Difference, ...], tuple[str, ...]]:
    """Every metric of both logs, element by element, and a note for each log that has none."""
    values: list[dict[str, Any]] = []
    notes: list[str] = []
    for name, log in (("A", a), ("B", b)):
        try:
            measured = measure(log)
        except LogError as error:
            values.append({})
            notes.append(f"{name} has no metrics: {error}")
        else:
            values.append(_flat(measured.values, names=("x", "y", "z")))
            notes += [f"{name}: {note}" for note in measured.notes]
    return _pairs(*values), tuple(notes)


def _pairs(a: Mapping[str, Any], b: Mapping[str, Any]) -> tuple[Difference, ...]:
    return tuple(Difference(name, a.get(name), b.get(name)) for name in {**a, **b})


def _flat(value: Any, prefix: str = "", names: tuple[str, ...] = ()) -> dict[str, Any]:
    """Values by dotted name; elements of a list by number, or by the names given to them."""
    if isinstance(value, dict):
        parts = [(str(key), part) for key, part in value.items()]
    elif isinstance(value, list):
        parts = [(names[i] if i < len(names) else str(i), part) for i, part in enumerate(value)]
    else:
        return {prefix: value}
    flat: dict[str, Any] = {}
    for key, part in parts:
        flat |= _flat(part, f"{prefix}.{key}" if prefix else key, names)
    return flat
