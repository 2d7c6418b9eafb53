"""A bar of the experiments that are done, on a terminal only."""

from types import TracebackType
from typing import Self

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from scenarios.paper.outcome import Outcome


class ExperimentBar:
    """One line on standard error: how many experiments are done, how many fell or failed, how long the rest takes."""

    def __init__(self, total: int) -> None:
        console = Console(stderr=True)
        columns = (
            *(TextColumn("experiments"), BarColumn(), MofNCompleteColumn(), TextColumn("{task.fields[state]}")),
            *(TimeElapsedColumn(), TextColumn("left"), TimeRemainingColumn()),
        )
        self._bar = Progress(*columns, console=console, transient=True, disable=not console.is_terminal)
        self._task = self._bar.add_task("", total=total, state="")
        self._falls = self._failures = 0

    def __call__(self, outcome: Outcome) -> None:
        """Count an outcome."""
        self._falls += bool(outcome.metrics.get("fell"))
        self._failures += bool(outcome.failure)
        self._bar.update(self._task, advance=1, state=f"{self._falls} fell, {self._failures} failed")

    def __enter__(self) -> Self:
        self._bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._bar.stop()
