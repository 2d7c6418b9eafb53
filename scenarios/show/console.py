"""Output for a person: a progress line on standard error, tables on standard output, numbers in engineers' units."""

import sys
import time
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import zip_longest
from pathlib import Path
from shlex import quote
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

import typer

from surefoot.scenarios.judge.verdict import FIRST_METRICS, Verdict, bound_text, shown_unit, value_text
from surefoot.scenarios.run.skeleton import Progress
from surefoot.scenarios.show.moment import Moment

if TYPE_CHECKING:
    from rich.progress import ProgressColumn

    from surefoot.scenarios.judge.inspection import Inspection
    from surefoot.scenarios.judge.questions import Stretch
    from surefoot.scenarios.show.touching import Touch

_REFRESH = 0.1


class TerminalLine:
    """One line on standard error for as long as its context, only on a terminal.

    Args:
        columns: makes its columns, and imports them: rich takes longer than all else that a short command prints.
        total: of its bar; None where that is not known yet.
        state: what it says at first.
    """

    def __init__(self, columns: "Callable[[], Iterable[ProgressColumn]]", total: float | None, state: str) -> None:
        self._bar = None
        if sys.stderr.isatty():
            from rich.console import Console
            from rich.progress import Progress as RichProgress

            console = Console(stderr=True)
            self._bar = RichProgress(*columns(), console=console, transient=True, redirect_stdout=False)
            self._task = self._bar.add_task("", total=total, state=state)

    def __enter__(self) -> Self:
        if self._bar is not None:
            self._bar.start()
        return self

    def update(self, **changes: Any) -> None:
        """Change what it shows, as `rich.progress.Progress.update` does."""
        if self._bar is not None:
            self._bar.update(self._task, **changes)

    @contextmanager
    def hidden(self) -> Iterator[None]:
        """Make way for what is printed meanwhile."""
        if self._bar is not None:
            self._bar.stop()
        try:
            yield
        finally:
            if self._bar is not None:
                self._bar.start()

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._bar.stop()


class ProgressLine(TerminalLine):
    """The progress of a run: simulated time, phase, real-time factor."""

    def __init__(self, title: str) -> None:
        def columns() -> "Iterable[ProgressColumn]":
            from rich.progress import BarColumn, TextColumn

            return TextColumn(title, markup=False), BarColumn(), TextColumn("{task.fields[state]}")

        super().__init__(columns, 1.0, "starting")
        self._due = 0.0

    def __call__(self, progress: Progress) -> None:
        """Show where the run is, at most ten times a second."""
        now = time.monotonic()
        if now < self._due:
            return
        self._due = now + _REFRESH
        speed = f"{progress.real_time_factor:.1f} x real time"
        state = f"{progress.time:6.2f} of {progress.duration:.2f} s  {progress.phase}  {speed}"
        self.update(completed=progress.time / max(progress.duration, 1e-9), state=state)


def print_result(name: str, verdict: Verdict, log: Path) -> None:
    """Print verdict, reasons, the metrics, the path of the log, and of a failure what says why.

    Metrics are those asked for first, and those that the scenario bounds.
    """
    _print_verdict(name, verdict)
    bounded = (key.partition(".")[0] for key in verdict.criteria)
    _print_metrics(verdict, tuple(dict.fromkeys((*FIRST_METRICS, *bounded))))
    typer.echo(f"log: {log}")
    if not verdict.passed:
        typer.echo(f"why: surefoot inspect {quote(str(log))}")


def print_inspection(found: "Inspection", touches: "Sequence[Touch]") -> None:
    """Print everything that an inspection found."""
    typer.echo(f"{found.log}: {found.start:.3f} s to {found.end:.3f} s")
    for line in _health_lines(found):
        typer.echo(line)
    for touch in touches:
        typer.echo(f"touching: {touch.one} and {touch.other}, from {touch.time:.3f} s on")
    _print_verdict(found.scenario, found.verdict)
    metrics = found.verdict.metrics
    judged = {key.partition(".")[0] for key in found.verdict.criteria}
    empty = {name for name, value in metrics.items() if value is None and name not in judged}
    _print_metrics(found.verdict, tuple(name for name in metrics if name not in empty))
    print_valueless(empty)
    topics = ((one.topic, str(one.messages), f"{one.rate:.1f}") for one in found.topics)
    print_table(("topic", "messages", "rate [Hz]"), topics)


def print_valueless(names: Collection[str]) -> None:
    """Name the metrics that nothing in a run has a value for, which would be rows without one."""
    if names:
        typer.echo(f"without a value: {', '.join(sorted(names))}")


def _health_lines(found: "Inspection") -> list[str]:
    """Every warning with its evidence, its relation to a fall and where to see it, and how many found nothing."""
    lines, warnings = [], [one for one in found.health if one.status != "ok"]
    # A command is as long as a finding, and the replay that the first one makes is linked to by all.
    first = next((one for one in warnings if one.time is not None), None)
    for finding in warnings:
        when = "" if finding.time is None else f" from {finding.time:.3f} s on"
        value = "" if finding.value is None else f", value {finding.value:.4g}"
        relation = "" if finding.relation is None else f"{finding.relation}: "
        lines.append(f"health: {relation}{finding.check}{when}{value}: {finding.cause}")
        if finding.time is not None:
            moment = Moment(Path(found.log), finding.time)
            if moment.link or finding is first:
                lines.append(f"  look at: {moment.text}")
    count = len(found.health)
    return [*lines, f"health: {count - len(warnings)} of {count} checks found nothing"]


def print_topic(topic: str, fields: Mapping[str, Mapping[str, Any]]) -> None:
    """Print the summary of a topic's fields."""
    rows = []
    for name, row in fields.items():
        shape = "x".join(str(n) for n in row["shape"]) or "scalar"
        spread = [number(row[key]) for key in ("min", "mean", "max")]
        rows.append((name, shape, row["unit"], str(row["messages"]), str(row["not_finite"]), *spread))
    print_table((topic, "shape", "unit", "messages", "not finite", "min", "mean", "max"), rows)


def print_stretches(question: str, found: "Sequence[Stretch]", unit: str) -> None:
    """Print when a question holds, with the value farthest beyond the bound where it has one [unit]."""
    total = sum(one.end - one.start for one in found)
    typer.echo(f"{question}: {len(found)} stretches, {total:.3f} s in all")
    single = any(one.worst is not None for one in found)
    rows = []
    for one in found:
        worst = (f"{one.worst:.4g}", f"{one.at:.3f}") if single else ()
        rows.append((f"{one.start:.3f}", f"{one.end:.3f}", f"{one.end - one.start:.3f}", *worst))
    if rows:
        print_table(("from [s]", "to [s]", "length [s]", *((f"worst [{unit}]", "at [s]") if single else ())), rows)


def _print_verdict(name: str, verdict: Verdict) -> None:
    word, color = ("pass", "green") if verdict.passed else ("fail", "red")
    typer.echo(f"{name}: {typer.style(f'verdict {word}', fg=color, bold=True)}")
    for reason in verdict.reasons:
        typer.echo(f"  - {reason}")
    for note in verdict.notes:
        typer.secho(f"  note: {note}", fg="yellow")


def _print_metrics(verdict: Verdict, names: tuple[str, ...]) -> None:
    rows, missed = [], {reason.partition(" ")[0].partition("[")[0] for reason in verdict.reasons}
    for name in names:
        value, unit = value_text(name, verdict.metrics.get(name)), shown_unit(name)
        if name == "steps_taken":
            planned = verdict.metrics.get("steps_planned")
            value = value if planned is None else f"{value} of {value_text(name, planned)}"
        bounds = [bound_text(name, bound) for key, bound in verdict.criteria.items() if key.partition(".")[0] == name]
        rows.append((name, value, unit, ", ".join(bounds)))
    print_table(("metric", "value", "unit", "criterion"), rows, missed)


def number(value: Any) -> str:
    """A value of a metric or a setting, short."""
    if isinstance(value, list):
        return "  ".join(number(element) for element in value)
    if isinstance(value, dict):
        return "  ".join(f"{key} {number(element)}" for key, element in value.items())
    if value is None:
        return "-"
    return f"{value:.4g}" if isinstance(value, float) else str(value).lower()


def print_table(head: Sequence[str], rows: Iterable[Sequence[str]], red: Collection[str] = ()) -> None:
    """Print a table without lines, as wide as its cells need: a narrow terminal wraps it, and loses none of it.

    Args:
        head: of its columns.
        rows: cells; a row may end early.
        red: first cells of the rows that a terminal shows in red.
    """
    every = [head, *rows]
    widths = [max(map(len, column)) for column in zip_longest(*every, fillvalue="")]
    for at, row in enumerate(every):
        line = "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=False)).rstrip()
        typer.secho(line, bold=True if at == 0 else None, fg="red" if row[0] in red else None)
