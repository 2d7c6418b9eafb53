"""Runs the experiments in parallel, keeps what is finished, and tells whether it still holds."""

import queue
import signal
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Executor, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing import get_context
from pathlib import Path
from types import TracebackType
from typing import Self

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from surefoot.scenarios.paper.results import Outcome, Results, execute
from surefoot.scenarios.paper.studies import Experiment
from surefoot.scenarios.record.provenance import ABSENT
from surefoot.scenarios.show.html import MISSING, escape, number, tag


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


def provenance(results: Results) -> str:
    """Versions that made the logs, and when."""
    rows = [(name, ", ".join(values)) for name, values in _versions(results.outcomes).items()]
    written = sorted(outcome.written for outcome in results.outcomes if outcome.written)
    if written:
        rows.append(("logs written (UTC)", f"{_date(written[0])} to {_date(written[-1])}"))
    body = "".join(tag("tr", tag("td", escape(name)) + tag("td", escape(value))) for name, value in rows)
    head = tag("tr", tag("th", "made by") + tag("th", "version"))
    return tag("table", f"<thead>{head}</thead><tbody>{body}</tbody>", id="versions", style="max-width: 46rem")


def runs_table(results: Results) -> str:
    """Every run: how it ended and how to make it again."""
    head = tag("tr", "".join(tag("th", text) for text in ("run", "end", "command")))
    rows = "\n".join(_run_row(outcome) for outcome in results.outcomes)
    table = tag("table", f"<thead>{head}</thead>\n<tbody>\n{rows}\n</tbody>", kind="runs", id="runs-table")
    count = f"All {len(results.outcomes)} runs with their commands"
    opened = tag("details", tag("summary", count) + tag("div", table, kind="wide"), id="all-runs")
    return _failures(results) + opened


def _failures(results: Results) -> str:
    if not results.failures:
        return ""
    head = tag("tr", tag("th", "could not run") + tag("th", "why"))
    reasons: dict[str, list[str]] = {}
    for outcome in results.failures:
        reasons.setdefault(outcome.failure, []).append(outcome.experiment.folder)
    rows = (tag("tr", tag("td", escape(", ".join(runs)), kind="bad") + tag("td", escape(reason)))
            for reason, runs in reasons.items())  # fmt: skip
    table = tag("table", f"<thead>{head}</thead><tbody>{''.join(rows)}</tbody>", id="failures")
    return tag("div", table, kind="wide")


def _run_row(outcome: Outcome) -> str:
    cells = (
        tag("td", escape(outcome.experiment.folder)),
        tag("td", escape(_end(outcome)), kind="bad" if outcome.failure or outcome.metrics.get("fell") else ""),
        tag("td", tag("code", escape(outcome.experiment.command))),
    )
    return tag("tr", "".join(cells))


def _end(outcome: Outcome) -> str:
    if outcome.failure:
        return "could not run"
    if outcome.metrics.get("fell"):
        return f"fell at {number(outcome.metrics['fall_time'])} s"
    return f"{outcome.metrics.get('steps_taken', MISSING)} of {outcome.metrics.get('steps_planned', MISSING)} steps"


def _versions(outcomes: Iterable[Outcome]) -> dict[str, list[str]]:
    """Every version that occurs, by name."""
    found: dict[str, dict[str, None]] = {}
    for outcome in outcomes:
        for name, value in outcome.versions.items():
            if value not in ("", ABSENT):
                found.setdefault(name.replace("_", " "), {})[value] = None
    return {name: list(values) for name, values in found.items()}


def _date(iso: str) -> str:
    return iso.replace("T", " ").removesuffix("+00:00")


Execute = Callable[[Experiment, Path], Outcome]


class InterruptedRunsError(Exception):
    """The user stopped the experiments; the logs of those that were done are whole."""


def run_all(
    experiments: Sequence[Experiment],
    folder: Path,
    jobs: int,
    on_done: Callable[[Outcome], None],
    run: Execute = execute,
    worker: Callable[[], Executor] | None = None,
) -> tuple[Outcome, ...]:
    """Run experiments; a failing one does not stop the others.

    Args:
        experiments: to run.
        folder: of all runs.
        jobs: how many at once.
        on_done: is told each outcome as it comes.
        run: what running an experiment is; must be importable from another process.
        worker: makes an executor with one worker; a process of its own by default.

    Returns:
        an outcome for each experiment, in their order.

    Raises:
        InterruptedRunsError: Ctrl-C; runs under way were brought to their end first.
    """
    waiting: queue.SimpleQueue[Experiment] = queue.SimpleQueue()
    for experiment in experiments:
        waiting.put(experiment)
    done: queue.SimpleQueue[Outcome] = queue.SimpleQueue()
    stop, make = threading.Event(), worker or process
    with _interrupts_ignored():
        slots = [_Slot(make, run, folder, waiting, done, stop) for _ in range(min(jobs, len(experiments)))]
    outcomes: dict[Experiment, Outcome] = {}
    try:
        for slot in slots:
            slot.start()
        while len(outcomes) < len(experiments):
            outcome = done.get()
            outcomes[outcome.experiment] = outcome
            on_done(outcome)
    except KeyboardInterrupt:
        raise InterruptedRunsError from None
    finally:
        with _interrupts_ignored():
            stop.set()
            for slot in slots:
                if slot.ident is not None:
                    slot.join()
    return tuple(outcomes[experiment] for experiment in experiments)


def process() -> Executor:
    """An executor of one process, which leaves Ctrl-C to its parent."""
    return ProcessPoolExecutor(1, get_context("spawn"), initializer=ignore_interrupts)


def ignore_interrupts() -> None:
    """Leave Ctrl-C to the parent process, which lets the run under way end."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


class _Slot(threading.Thread):
    """Takes one experiment after the other and has them run by a worker that is replaced when it dies."""

    def __init__(
        self,
        make: Callable[[], Executor],
        run: Execute,
        folder: Path,
        waiting: "queue.SimpleQueue[Experiment]",
        done: "queue.SimpleQueue[Outcome]",
        stop: threading.Event,
    ) -> None:
        super().__init__(daemon=True)
        self._make, self._run, self._folder = make, run, folder
        self._waiting, self._done, self._stop_asked = waiting, done, stop
        self._worker = make()
        self._worker.submit(int)  # begins its process now, while interrupts are ignored, which it inherits

    def run(self) -> None:
        """Go on until nothing waits or a stop is asked for."""
        while not self._stop_asked.is_set():
            try:
                experiment = self._waiting.get_nowait()
            except queue.Empty:
                break
            self._done.put(self._outcome(experiment))
        self._worker.shutdown()

    def _outcome(self, experiment: Experiment) -> Outcome:
        try:
            return self._worker.submit(self._run, experiment, self._folder).result()
        except BrokenProcessPool:
            self._worker.shutdown()
            self._worker = self._make()
            return Outcome(experiment, failure="its process ended unexpectedly, as when memory runs out")
        except Exception as error:
            return Outcome(experiment, failure=f"internal error, {type(error).__name__}: {error}")


@contextmanager
def _interrupts_ignored() -> Iterator[None]:
    """Ignore Ctrl-C for a moment; only the main thread can."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
