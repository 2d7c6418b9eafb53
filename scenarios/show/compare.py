"""``surefoot compare``: two logs side by side."""

import math
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import typer

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.judge.metrics import known, plain
from surefoot.scenarios.judge.verdict import shown_unit, value_text
from surefoot.scenarios.log import Log, read
from surefoot.scenarios.output import shown
from surefoot.scenarios.record.foxglove import DERIVED_TOPICS
from surefoot.scenarios.record.provenance import SCENARIO_FILE
from surefoot.scenarios.show.console import number, print_table, print_valueless
from surefoot.scenarios.show.differences import (
    VERSIONS_RECORD,
    ChannelDifference,
    Difference,
    FirstDifference,
    compare_channels,
    differences,
    metric_pairs,
    parted,
    settings,
    unreadable,
)
from surefoot.scenarios.show.logview import LogView
from surefoot.scenarios.show.moment import Moment

TOLERANCE = 1e-6


@dataclass(frozen=True, slots=True)
class Comparison:
    """The common parts and the differences of two logs, A and B.

    Attributes:
        a: path of the first log.
        b: path of the second log.
        tolerance: of the values that still agree.
        versions: that differ.
        settings: of the scenarios that differ.
        files: attached files that differ.
        records: metadata records that differ, other than the versions.
        metrics: of both logs, all of them.
        channels: common to both, in the order in which they part.
        only_a: topics of which the first log alone has messages.
        only_b: topics of which the second log alone has messages.
        notes: what could not be judged, in words.
        unread: what could not be read or compared, in words.
    """

    a: str
    b: str
    tolerance: float
    versions: tuple[Difference, ...]
    settings: tuple[Difference, ...]
    files: tuple[str, ...]
    records: tuple[str, ...]
    metrics: tuple[Difference, ...]
    channels: tuple[ChannelDifference, ...]
    only_a: tuple[str, ...]
    only_b: tuple[str, ...]
    notes: tuple[str, ...]
    unread: tuple[str, ...]

    @property
    def identical(self) -> bool:
        """True if both hold the same run to the last bit, apart from what the wall clock wrote."""
        return self.agree and all(channel.same for channel in self.channels)

    @property
    def agree(self) -> bool:
        """True if both hold the same run, with values within the tolerance; not when something could not be read."""
        return (
            not (self._described_apart or self.unread) and bool(self.channels) and all(c.agrees for c in self.channels)
        )

    @property
    def _described_apart(self) -> bool:
        return any((self.settings, self.files, self.records, self.only_a, self.only_b))

    @property
    def first(self) -> ChannelDifference | None:
        """The channel that parts first."""
        return next((channel for channel in self.channels if channel.time is not None), None)

    @property
    def moments(self) -> tuple[Moment, ...]:
        """The moment of both logs at which they part; none where they do not."""
        time = None if self.first is None else self.first.time
        return () if time is None else tuple(Moment(Path(path), time) for path in (self.a, self.b))

    @property
    def summary(self) -> str:
        """One sentence: identical, or where the runs part."""
        if self.identical:
            return "identical apart from wall-clock timing"
        if self.first is not None:
            return f"first divergence: {describe(self.first)}"
        if not self.channels:
            return "no channel in common, so nothing can be compared tick by tick"
        if self._described_apart and all(channel.same for channel in self.channels):
            return "every common channel is identical; what describes the runs is not"
        return "identical as far as both logs reach"

    def to_json(self) -> dict[str, Any]:
        """Write as one JSON object."""
        return {
            "a": self.a,
            "b": self.b,
            "identical": self.identical,
            "summary": self.summary,
            "look_at": [one.to_json() for one in self.moments],
            "tolerance": self.tolerance,
            "first_divergence": None if self.first is None else plain(asdict(self.first), str),
            "versions": [asdict(one) for one in self.versions],
            "settings": plain([asdict(one) for one in self.settings], str),
            "files": list(self.files),
            "records": list(self.records),
            "metrics": {one.name: {"a": one.a, "b": one.b, "difference": one.delta} for one in self.metrics},
            "channels": [{**plain(asdict(one), str), "same": one.same} for one in self.channels],
            "only_a": list(self.only_a),
            "only_b": list(self.only_b),
            "notes": [*self.notes, *self.unread],
        }


def compare(path_a: Path, path_b: Path, tolerance: float = TOLERANCE) -> tuple[Comparison, Log, Log]:
    """Compare two logs, also truncated ones and ones of different versions, by a tolerance (`compare_channels`) [-].

    Returns:
        the comparison, and both logs.

    Raises:
        LogError: one of them cannot be read, or the tolerance is no such number.
    """
    if not 0.0 <= tolerance < math.inf:
        raise LogError(f"--tolerance {tolerance}: not a tolerance; give a number from 0 on, such as {TOLERANCE}")
    a, b = read(path_a), read(path_b)
    metrics, notes = metric_pairs(a, b)
    topics_a, topics_b = _own(a), _own(b)
    common = tuple(topic for topic in topics_a if topic in b)
    found = Comparison(
        a=str(a.path),
        b=str(b.path),
        tolerance=tolerance,
        versions=differences(*(log.metadata.get(VERSIONS_RECORD, {}) for log in (a, b))),
        settings=differences(settings(a), settings(b)),
        files=parted(a.attachments, b.attachments, but=SCENARIO_FILE),
        records=parted(a.metadata, b.metadata, but=VERSIONS_RECORD),
        metrics=metrics,
        channels=compare_channels(a, b, tolerance),
        only_a=tuple(topic for topic in topics_a if topic not in b and a.count(topic)),
        only_b=tuple(topic for topic in topics_b if topic not in a and b.count(topic)),
        notes=notes,
        unread=(*_damage("A", a, common), *_damage("B", b, common)),
    )
    return found, a, b


def draw(found: Comparison, a: Log, b: Log, out: Path, replace: bool = False) -> None:
    """Draw two runs that were compared over each other, as PNG, SVG or PDF by the file's ending.

    Raises:
        LogError: there is nothing to draw, or the file exists or cannot be written.
    """
    from surefoot.scenarios.show.figures.page import overlay
    from surefoot.scenarios.show.kit.figures import save

    when = None if found.first is None else found.first.time
    header = f"A: {shown(found.a)}\nB: {shown(found.b)}\n{found.summary}".replace("$", r"\$")
    save(overlay(LogView(a), LogView(b), header, when), out, replace)


def describe(channel: ChannelDifference) -> str:
    """Describe the place where a channel parts."""
    at = channel.exact
    if at is None or (channel.only_one is not None and channel.only_one < at.time):
        if channel.only_one is None:
            return f"{channel.topic} does not part"
        return f"{channel.topic} at {channel.only_one:.3f} s: only one log has a message there"
    return f"{channel.topic} {at.field} at {at.time:.3f} s: {' and '.join(distinct_texts(at.a, at.b))}"


def distinct_texts(a: float, b: float) -> tuple[str, str]:
    """Two numbers that differ, with five digits; where these are the same, by how much the second is more or less."""
    one, other = f"{a:.5g}", f"{b:.5g}"
    if one != other:
        return one, other
    if not math.isfinite(b - a):
        return one, "with other bits"
    return one, f"{abs(b - a):.2g} {'more' if b > a else 'less'}"


def _own(log: Log) -> tuple[str, ...]:
    """Topics of a log, less those for viewers, which derive from the others."""
    return tuple(topic for topic in log.topics if topic not in DERIVED_TOPICS)


def _damage(name: str, log: Log, common: tuple[str, ...]) -> list[str]:
    notes = [f"{name} is truncated: it can be read up to {log.time_range()[1]:.3f} s"] if log.truncated else []
    notes += [f"{name}: {loss}" for loss in log.losses()]
    return notes + [f"{topic} of {name} has no layout of fixed size: not compared" for topic in unreadable(log, common)]


def print_comparison(found: Comparison) -> None:
    """Print what is the same and what is not, the answer first."""
    typer.echo(found.summary)
    typer.echo(f"A: {found.a}\nB: {found.b}")
    for moment in found.moments:
        typer.echo(f"look at: {moment.text}")
    for note in (*found.notes, *found.unread):
        typer.echo(f"note: {note}")
    for title, pairs in (("version", found.versions), ("setting", found.settings)):
        rows = ((one.name, number(one.a), number(one.b)) for one in pairs)
        if pairs:
            print_table((title, "A", "B"), rows)
        else:
            typer.echo(f"{title}s: the same")
    if found.files:
        typer.echo(f"attached files that differ: {', '.join(found.files)}")
    if found.records:
        typer.echo(f"metadata records that differ: {', '.join(found.records)}")
    empty = {one.name for one in found.metrics if one.a is None and one.b is None}
    shown = [_metric(one) for one in found.metrics if one.name not in empty]
    print_table(("metric", "A", "B", "B - A", "unit"), shown)
    print_valueless(empty)
    head = ("channel", "messages", "from [s]", f"beyond {found.tolerance:g}", "field", "A", "B")
    print_table(head, _channels(found.channels))
    for name, topics in (("A", found.only_a), ("B", found.only_b)):
        if topics:
            typer.echo(f"only in {name}: {', '.join(topics)}")


def _metric(one: Difference) -> tuple[str, ...]:
    metric = known(one.name)
    clock = " (wall clock)" if metric is not None and not metric.repeatable else ""
    scale = metric.scale if metric is not None else 1.0
    delta = "" if one.delta in (None, 0.0) else f"{scale * one.delta:+.3g}"
    return one.name, value_text(one.name, one.a), value_text(one.name, one.b), f"{delta}{clock}", shown_unit(one.name)


def _channels(channels: tuple[ChannelDifference, ...]) -> Iterator[tuple[str, ...]]:
    """Times at which each channel parts, with the value that differs beyond the tolerance, or else by a bit."""
    for one in channels:
        shown = one.tolerated or one.exact
        values = (shown.field, *distinct_texts(shown.a, shown.b)) if shown else ()
        counts = " / ".join(str(count) for count in dict.fromkeys(one.messages))
        times = ("identical", "-") if one.same else (_time(one.exact), _time(one.tolerated))
        yield one.topic, counts, *times, *values
        alone = [] if one.only_one is None else [f"in one log only at {one.only_one:.3f} s"]
        for remark in (*alone, *one.layout):
            yield "", "", "", "", remark


def _time(point: FirstDifference | None) -> str:
    return "-" if point is None else f"{point.time:.3f}"
