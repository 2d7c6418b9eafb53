"""Many runs side by side: each worker takes one search after the other, and every result goes into the journal."""

import queue
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from surefoot.scenarios.many.engine import Worker, cluster_workers, local_workers
from surefoot.scenarios.many.journal import Journal, outcome_of
from surefoot.scenarios.many.points import Point, Record, Searched
from surefoot.scenarios.run.processes import interrupts_ignored
from surefoot.scenarios.show.console import TerminalLine

if TYPE_CHECKING:
    from rich.progress import ProgressColumn


class CampaignBar(TerminalLine):
    """The progress of a campaign: how many are done, how many failed, how long the rest takes.

    Args:
        total: number of cells.
        what: they are called.
    """

    def __init__(self, total: int, what: str = "runs") -> None:
        super().__init__(partial(_columns, what), total, "")
        self._counts = dict.fromkeys(("fail", "refused", "broken"), 0)
        self._runs = 0

    def run(self, record: Record) -> None:
        """Count a run."""
        self._runs += 1
        if record.status in self._counts:
            self._counts[record.status] += 1
        counts = ", ".join(f"{count} {status}" for status, count in self._counts.items() if count)
        self.update(state=f"{self._runs} runs" + (f", {counts}" if counts else ""))

    def cell(self) -> None:
        """Count a cell."""
        self.update(advance=1)


def _columns(what: str) -> "Iterable[ProgressColumn]":
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    done = (TextColumn(what), BarColumn(), MofNCompleteColumn(), TextColumn("{task.fields[state]}"))
    return *done, TimeElapsedColumn(), TextColumn("left"), TimeRemainingColumn()


class InterruptedRunsError(Exception):
    """The user stopped the campaign; what was done is kept."""


@contextmanager
def closed_at_end(workers: Sequence[Worker]) -> Iterator[None]:
    """Let workers end when the context does, however it ends."""
    try:
        yield
    finally:
        with interrupts_ignored():
            for worker in workers:
                worker.close()


def run_cells(
    cells: Iterable[Searched],
    journal: Journal,
    workers: Sequence[Worker],
    on_run: Callable[[Record], None] = lambda _: None,
    on_cell: Callable[[], None] = lambda: None,
) -> None:
    """Run what has no result yet; one that fails does not stop the others.

    Args:
        cells: to run.
        journal: gets every result.
        workers: that make the runs.
        on_run: called with each new result.
        on_cell: called when a cell is done.

    Raises:
        InterruptedRunsError: Ctrl-C; runs under way were brought to their end first, unless it came twice.
        LogError: a result could not be written down.
    """
    with closed_at_end(workers):
        run_round(cells, journal, workers, on_run, on_cell)


def run_round(
    cells: Iterable[Searched],
    journal: Journal,
    workers: Sequence[Worker],
    on_run: Callable[[Record], None] = lambda _: None,
    on_cell: Callable[[], None] = lambda: None,
) -> None:
    """Do the same as `run_cells`, and leave the workers for the next round."""
    news_queue: queue.SimpleQueue[_News] = queue.SimpleQueue()
    left: queue.SimpleQueue[Searched] = queue.SimpleQueue()
    for cell in cells:
        left.put(cell)
    stop = threading.Event()
    slots = [
        threading.Thread(target=_slot, args=(worker, left, journal, news_queue, stop), daemon=True)
        for worker in workers
    ]
    running = len(slots)
    try:
        for slot in slots:
            slot.start()
        while running:
            news = news_queue.get()
            if isinstance(news, Exception):
                raise news
            if isinstance(news, Record):
                on_run(news)
            elif news == "cell":
                on_cell()
            else:
                running -= 1
    except KeyboardInterrupt:
        stop.set()
        with suppress(KeyboardInterrupt):
            for slot in slots:
                slot.join()
        raise InterruptedRunsError from None
    finally:
        stop.set()


_News = Record | Exception | Literal["cell", "end"]
"""News of a slot: a result, what went wrong, that a cell is done, that it has nothing more to do."""


def _slot(
    worker: Worker,
    left: "queue.SimpleQueue[Searched]",
    journal: Journal,
    news_queue: "queue.SimpleQueue[_News]",
    stop: threading.Event,
) -> None:
    """Take one cell after the other that is left, and have what has no result run."""

    def made(point: Point) -> bool:
        if journal.get(point) is None:
            if stop.is_set():
                return False
            record = worker(point)
            journal.add(point, record)
            news_queue.put(record)
        found = journal.said(point)
        return found is not None and found.status != "broken"

    try:
        while not stop.is_set():
            outcome_of(left.get_nowait(), journal, made)
            news_queue.put("cell")
    except queue.Empty:
        pass
    except Exception as error:
        news_queue.put(error)
    finally:
        news_queue.put("end")


def workers_of(out: Path, jobs: int, cluster: str | None, keep_all: bool) -> Sequence[Worker]:
    """Processes of this machine, so many, or the threads of a cluster; `keep_all` keeps the logs of all runs."""
    if cluster is None:
        return local_workers(out, jobs, keep_all)
    return cluster_workers(cluster, out, keep_all)
