"""What a person sees: the progress line on standard error, tables on standard output."""

import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from rich.console import Console
from rich.progress import BarColumn, TextColumn
from rich.progress import Progress as RichProgress
from rich.table import Table

from scenarios.health import Finding
from scenarios.inspection import Inspection
from scenarios.progress import Progress
from scenarios.verdict import Verdict

FIRST_METRICS = (
    "steps_taken",
    "zmp_inside_fraction",
    "cop_ratio_p99",
    "zmp_error_rms",
    "com_error_rms",
    "footstep_error_max",
    "foot_slip_max",
    "torque_ratio_max",
    "speed_mean",
    "real_time_factor",
)
"""The ten metrics that a walking engineer asks for first."""

_UNITS = {
    **dict.fromkeys(("zmp_error_rms", "com_error_rms", "dcm_error_rms", "footstep_error_max", "foot_slip_max"), "m"),
    **dict.fromkeys(("com_height_range", "stair_edge_margin_min", "estimation_error_rms"), "m"),
    **dict.fromkeys(("fall_time", "duration", "standing_time_final", "planner_time", "wbc_time"), "s"),
    **dict.fromkeys(("joint_limit_margin_min", "knee_angle_mean"), "rad"),
    "speed_mean": "m/s",
    "log_bytes": "B",
}
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
        state = f"{progress.time:6.2f} of {progress.duration:.2f} s  {progress.phase}  x{progress.real_time_factor:.1f}"
        self._bar.update(self._task, completed=progress.time / max(progress.duration, 1e-9), state=state)

    def __enter__(self) -> Self:
        self._bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._bar.stop()


def print_result(verdict: Verdict, log: Path) -> None:
    """Print verdict, reasons, the first metrics and the path of the log."""
    console = _console()
    _print_verdict(console, verdict)
    console.print(_metric_table(verdict.metrics, FIRST_METRICS))
    console.print(str(log))


def print_inspection(found: Inspection) -> None:
    """Print everything that an inspection found."""
    console = _console()
    console.print(f"{found.log}: {found.start:.3f} s to {found.end:.3f} s")
    for line in _health_lines(found.health):
        console.print(f"health: {line}")
    _print_verdict(console, found.verdict)
    console.print(_metric_table(found.verdict.metrics, tuple(found.verdict.metrics)))
    topics = _table("topic", "messages", "rate [Hz]")
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
    table = _table(topic, "shape", "messages", "not finite", "min", "mean", "max")
    for name, row in fields.items():
        shape = "x".join(str(n) for n in row["shape"]) or "scalar"
        spread = [_number(row[key]) for key in ("min", "mean", "max")]
        table.add_row(name, shape, str(row["messages"]), str(row["not_finite"]), *spread)
    _console().print(table)


def _print_verdict(console: Console, verdict: Verdict) -> None:
    console.print("verdict: pass" if verdict.passed else "verdict: fail")
    for reason in verdict.reasons:
        console.print(f"  {reason}")


def _metric_table(metrics: Mapping[str, Any], names: tuple[str, ...]) -> Table:
    table = _table("metric", "value", "unit")
    for name in names:
        value = _number(metrics.get(name))
        if name == "steps_taken":
            value = f"{value} of {_number(metrics.get('steps_planned'))}"
        table.add_row(name, value, _UNITS.get(name, ""))
    return table


def _number(value: Any) -> str:
    if isinstance(value, list):
        return "  ".join(_number(element) for element in value)
    if isinstance(value, dict):
        return "  ".join(f"{key} {_number(element)}" for key, element in value.items())
    if value is None:
        return "-"
    return f"{value:.4g}" if isinstance(value, float) else str(value).lower()


def _table(*columns: str) -> Table:
    table = Table(box=None, pad_edge=False)
    for column in columns:
        table.add_column(column, no_wrap=True)
    return table


def _console() -> Console:
    """Standard output; lines are never wrapped, so that paths and names can be copied."""
    return Console(soft_wrap=True, markup=False, highlight=False)
