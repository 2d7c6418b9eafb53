"""A comparison as a person sees it."""

from rich.table import Table

from scenarios.console import number, plain_console, plain_table
from scenarios.report.compare import Comparison, timed
from scenarios.report.divergence import ChannelDifference, Point
from scenarios.report.settings import Difference

_WIDTH = 110
"""Columns that the widest line needs; a narrower terminal wraps it rather than losing what it says."""


def print_comparison(found: Comparison) -> None:
    """Print what is the same and what is not, the answer first."""
    console = plain_console()
    console.width = max(console.width, _WIDTH)
    console.print(found.summary)
    console.print(f"A: {found.a}\nB: {found.b}")
    for note in found.notes:
        console.print(f"note: {note}")
    for title, differences in (("version", found.versions), ("setting", found.settings)):
        console.print(_settings(title, differences) if differences else f"{title}s: the same")
    if found.files:
        console.print(f"attached files that differ: {', '.join(found.files)}")
    console.print(_metrics(found.metrics))
    console.print(_channels(found.channels, found.tolerance))
    for name, topics in (("A", found.only_a), ("B", found.only_b)):
        if topics:
            console.print(f"only in {name}: {', '.join(topics)}")


def _settings(title: str, differences: tuple[Difference, ...]) -> Table:
    rows = plain_table(title, "A", "B")
    for one in differences:
        rows.add_row(one.name, number(one.a), number(one.b))
    return rows


def _metrics(metrics: tuple[Difference, ...]) -> Table:
    rows = plain_table("metric", "A", "B", "B - A")
    for one in metrics:
        delta = "" if one.delta in (None, 0.0) else f"{one.delta:+.3g}"
        rows.add_row(one.name, number(one.a), number(one.b), f"{delta} (wall clock)" if timed(one.name) else delta)
    return rows


def _channels(channels: tuple[ChannelDifference, ...], tolerance: float) -> Table:
    """Times at which each channel parts, with the value that differs beyond the tolerance, or else by a bit."""
    rows = plain_table("channel", "messages", "from [s]", f"beyond {tolerance:g}", "field", "A", "B")
    for one in channels:
        shown = one.tolerated or one.exact
        values = (shown.field, f"{shown.a:.5g}", f"{shown.b:.5g}") if shown else ()
        counts = " / ".join(str(count) for count in dict.fromkeys(one.messages))
        times = ("identical", "-") if one.same else (_time(one.exact), _time(one.tolerated))
        rows.add_row(one.topic, counts, *times, *values)
        for remark in _remarks(one):
            rows.add_row("", "", "", "", remark)
    return rows


def _remarks(channel: ChannelDifference) -> list[str]:
    alone = [] if channel.only_one is None else [f"in one log only at {channel.only_one:.3f} s"]
    return [*alone, *channel.layout]


def _time(point: Point | None) -> str:
    return "-" if point is None else f"{point.time:.3f}"
