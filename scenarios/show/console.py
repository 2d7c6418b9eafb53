"""What a person sees: a progress line on standard error, tables on standard output, numbers in engineers' units."""

import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from rich.console import Console
from rich.progress import BarColumn, TextColumn
from rich.progress import Progress as RichProgress
from rich.table import Table
from rich.text import Text

from surefoot.scenarios.judge.health import Finding
from surefoot.scenarios.judge.inspection import Inspection
from surefoot.scenarios.judge.text import FIRST_METRICS, bound_text, shown_unit, value_text
from surefoot.scenarios.judge.verdict import Verdict
from surefoot.scenarios.loop.skeleton import Progress

_REFRESH = 0.1


class ProgressLine:
    """One line on standard error, only on a terminal: simulated time, phase, real-time factor."""

    def __init__(self, title: str) -> None:
        console = Console(stderr=True)
        columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.fields[state]}"))
        self._bar = RichProgress(*columns, console=console, transient=True, disable=not console.is_terminal)
        self._task = self._bar.add_task(title, total=1.0, state="starting")
        self._due = 0.0

    def __call__(self, progress: Progress) -> None:
        """Show where the run is, at most ten times a second."""
        now = time.monotonic()
        if self._bar.disable or now < self._due:
            return
        self._due = now + _REFRESH
        speed = f"{progress.real_time_factor:.1f} x real time"
        state = f"{progress.time:6.2f} of {progress.duration:.2f} s  {progress.phase}  {speed}"
        self._bar.update(self._task, completed=progress.time / max(progress.duration, 1e-9), state=state)

    def __enter__(self) -> Self:
        self._bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._bar.stop()


def print_result(name: str, verdict: Verdict, log: Path) -> None:
    """Print verdict, reasons, the first metrics and the path of the log."""
    console = plain_console()
    _print_verdict(console, name, verdict)
    console.print(_metric_table(verdict, FIRST_METRICS))
    console.print(f"log: {log}")


def print_inspection(found: Inspection) -> None:
    """Print everything that an inspection found."""
    console = plain_console()
    console.print(f"{found.log}: {found.start:.3f} s to {found.end:.3f} s")
    for line in _health_lines(found.health):
        console.print(f"health: {line}")
    _print_verdict(console, found.scenario, found.verdict)
    console.print(_metric_table(found.verdict, tuple(found.verdict.metrics)))
    topics = plain_table("topic", "messages", "rate [Hz]")
    for topic in found.topics:
        topics.add_row(topic.topic, str(topic.messages), f"{topic.rate:.1f}")
    console.print(topics)


def _health_lines(health: Sequence[Finding]) -> list[str]:
    """Every warning with its evidence, and how many checks found nothing."""
    lines = []
    for finding in health:
        if finding.status != "ok":
            when = "" if finding.time is None else f" at {finding.time:.3f} s"
            value = "" if finding.value is None else f", value {finding.value:.4g}"
            lines.append(f"{finding.check}{when}{value}: {finding.cause}")
    return [*lines, f"{len(health) - len(lines)} of {len(health)} checks found nothing"]


def print_topic(topic: str, fields: Mapping[str, Mapping[str, Any]]) -> None:
    """Print the summary of a topic's fields."""
    table = plain_table(topic, "shape", "messages", "not finite", "min", "mean", "max")
    for name, row in fields.items():
        shape = "x".join(str(n) for n in row["shape"]) or "scalar"
        spread = [number(row[key]) for key in ("min", "mean", "max")]
        table.add_row(name, shape, str(row["messages"]), str(row["not_finite"]), *spread)
    plain_console().print(table)


def _print_verdict(console: Console, name: str, verdict: Verdict) -> None:
    console.print(Text(f"{name}: "), end="")
    console.print(
        f"verdict {'pass' if verdict.passed else 'fail'}", style="bold green" if verdict.passed else "bold red"
    )
    for reason in verdict.reasons:
        console.print(f"  - {reason}")
    for note in verdict.notes:
        console.print(f"  note: {note}", style="yellow")


def _metric_table(verdict: Verdict, names: tuple[str, ...]) -> Table:
    table = plain_table("metric", "value", "unit", "criterion")
    missed = {reason.partition(" ")[0].partition("[")[0] for reason in verdict.reasons}
    for name in names:
        value, unit = value_text(name, verdict.metrics.get(name)), shown_unit(name)
        if name == "steps_taken":
            value = f"{value} of {value_text(name, verdict.metrics.get('steps_planned'))}"
        bounds = [bound_text(name, bound) for key, bound in verdict.criteria.items() if key.partition(".")[0] == name]
        table.add_row(name, value, unit, ", ".join(bounds), style="red" if name in missed else None)
    return table


def number(value: Any) -> str:
    """A value of a metric or a setting, short."""
    if isinstance(value, list):
        return "  ".join(number(element) for element in value)
    if isinstance(value, dict):
        return "  ".join(f"{key} {number(element)}" for key, element in value.items())
    if value is None:
        return "-"
    return f"{value:.4g}" if isinstance(value, float) else str(value).lower()


def plain_table(*columns: str) -> Table:
    """A table without lines, whose cells are not wrapped."""
    table = Table(box=None, pad_edge=False)
    for column in columns:
        table.add_column(column, no_wrap=True)
    return table


def plain_console() -> Console:
    """Standard output; lines are never wrapped, so that paths and names can be copied."""
    return Console(soft_wrap=True, markup=False, highlight=False)
