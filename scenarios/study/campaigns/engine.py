"""Runs the cells of a campaign, several at once, writes every result down, and goes on where it was stopped."""

import queue
import shutil
import signal
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Executor, Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from multiprocessing import get_context, parent_process
from os import _exit
from pathlib import Path
from typing import Any, Literal, Protocol, TypeVar

from surefoot.errors import PluginError
from surefoot.guard import said
from surefoot.scenarios.errors import LogError, ScenarioError, SetupError
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.record.provenance import LOG_NAME
from surefoot.scenarios.run.run import Result, made_folder, run_scenario
from surefoot.scenarios.setup.load import read_scenario
from surefoot.scenarios.study.campaigns.journal import LOGS, SCRATCH, Journal, MadeOf
from surefoot.scenarios.study.campaigns.points import Point, Record, Search, Threshold

T = TypeVar("T")

TRIES = 2
"""How often a run is begun whose process dies."""


class InterruptedRunsError(Exception):
    """The user stopped the campaign; what was done is kept."""


class Searched(Protocol):
    """Runs that are made one after another: a cell of a campaign, or a single run."""

    def search(self) -> Search:
        """Its runs."""
        ...


class Worker(Protocol):
    """Makes one run at a time."""

    def __call__(self, point: Point) -> Record:
        """Make a run, bring its log to where it is kept, and say what became of it."""
        ...

    def close(self) -> None:
        """Let it end; what it does not do any more is lost."""
        ...


@dataclass(frozen=True, slots=True)
class Single:
    """A run that stands for itself."""

    point: Point

    def search(self) -> Search:
        """See `Searched`."""
        yield self.point
        return None


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of a cell.

    Attributes:
        cell: that was run.
        runs: its runs in order, with what became of each.
        threshold: what its search found, if it was one.
        complete: whether every run that belongs to it has a result.
    """

    cell: Searched
    runs: tuple[tuple[Point, Record], ...]
    threshold: Threshold | None = None
    complete: bool = True


def perform(
    point: Point, scratch: Path, kept: Path, keep_all: bool, run: Callable[[Scenario, Path], Result] = run_scenario
) -> Record:
    """Make a run.

    Args:
        point: what to run.
        scratch: directory of runs under way.
        kept: directory of the logs that are kept.
        keep_all: whether that of a run that passes is one of them.
        run: runs a scenario in a directory.

    Returns:
        what became of it; its log is relative to the directory of `kept`.
    """
    begin, own = time.perf_counter(), scratch / point.id
    record = Record(point.id, "broken", made_by=MadeOf().of(point))
    try:
        shutil.rmtree(own, ignore_errors=True)
        result = run(read_scenario(*point.base.written, point.settings), made_folder(own))
        verdict = result.verdict
        record = replace(
            record, status="pass" if verdict.passed else "fail", reasons=verdict.reasons, metrics=verdict.metrics
        )
        if result.interrupted:
            record = replace(record, status="broken", reasons=("the run was interrupted",))
        elif keep_all or not verdict.passed:
            shutil.rmtree(kept / point.name, ignore_errors=True)
            result.log.parent.rename(made_folder(kept) / point.name)
            record = replace(record, log=f"{kept.name}/{point.name}/{LOG_NAME}")
    except (ScenarioError, SetupError, PluginError) as refusal:
        record = replace(record, status="refused", reasons=(" ".join(str(refusal).split()),))
    except LogError as error:
        record = replace(record, status="broken", reasons=(" ".join(str(error).split()),))
    except Exception as error:
        record = replace(record, status="broken", reasons=(f"internal error, {said(error)}",))
    finally:
        shutil.rmtree(own, ignore_errors=True)
    return replace(record, wall_time=time.perf_counter() - begin)


class LocalWorker:
    """A process of its own, which stays for run after run and is replaced when it dies.

    Args:
        folder: the campaign's directory.
        keep_all: whether the logs of all runs are kept.
        make: makes an executor with one worker.
        work: that it does, as `perform`.
    """

    def __init__(
        self,
        folder: Path,
        keep_all: bool,
        make: Callable[[], Executor] | None = None,
        work: Callable[[Point, Path, Path, bool], Record] = perform,
    ) -> None:
        self._folder, self._keep_all = folder, keep_all
        self._make, self._work = make or processes, work
        self._executor = self._make()
        self._executor.submit(int)  # begins its process now, while interrupts are ignored, which it inherits

    def __call__(self, point: Point) -> Record:
        """See `Worker`."""
        for _ in range(TRIES):
            try:
                places = self._folder / SCRATCH, self._folder / LOGS
                return self._executor.submit(self._work, point, *places, self._keep_all).result()
            except BrokenProcessPool:
                self._executor.shutdown()
                self._executor = self._make()
        return Record(point.id, "broken", ("its process ended unexpectedly, as when memory runs out",))

    def close(self) -> None:
        """See `Worker`."""
        for one in list((getattr(self._executor, "_processes", None) or {}).values()):
            one.terminate()
        self._executor.shutdown(wait=False, cancel_futures=True)


def local_workers(folder: Path, jobs: int, keep_all: bool) -> list[Worker]:
    """Processes on this machine; arguments as of `LocalWorker`."""
    with interrupts_ignored():
        return [LocalWorker(folder, keep_all) for _ in range(jobs)]


def processes(count: int = 1) -> Executor:
    """An executor of processes that leave Ctrl-C to their parent and do not outlive it."""
    return ProcessPoolExecutor(count, get_context("spawn"), initializer=_set_up)


def side_by_side(
    work: Callable[..., T], arguments: Sequence[tuple[Any, ...]], jobs: int, lost: Callable[..., T]
) -> Iterator[T]:
    """Results of a function, as they come, from processes of their own.

    Args:
        work: what is to be done.
        arguments: of each time.
        jobs: processes.
        lost: makes the result of one whose process ended unexpectedly, from the same arguments and the reason.
    """
    with processes(min(jobs, len(arguments))) as pool:
        futures: dict[Future[T], tuple[Any, ...]] = {pool.submit(work, *given): given for given in arguments}
        try:
            for future in as_completed(futures):
                try:
                    yield future.result()
                except BrokenProcessPool:
                    yield lost(*futures[future], "its process ended unexpectedly, as when memory runs out")
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def _set_up() -> None:
    """Leave Ctrl-C and SIGHUP to the parent, and end with it: one that is killed cannot say so."""
    for number in (signal.SIGINT, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = parent_process()
    if parent is not None:
        parent.join()
        _exit(1)


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
        on_run: is told each new result.
        on_cell: is told that a cell is done.

    Raises:
        InterruptedRunsError: Ctrl-C; runs under way were brought to their end first, unless it came twice.
        LogError: a result could not be written down.
    """
    told: queue.SimpleQueue[_News] = queue.SimpleQueue()
    left: queue.SimpleQueue[Searched] = queue.SimpleQueue()
    for cell in cells:
        left.put(cell)
    stop = threading.Event()
    slots = [
        threading.Thread(target=_slot, args=(worker, left, journal, told, stop), daemon=True) for worker in workers
    ]
    running = len(slots)
    try:
        for slot in slots:
            slot.start()
        while running:
            news = told.get()
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
        with interrupts_ignored():
            for worker in workers:
                worker.close()


_News = Record | Exception | Literal["cell", "end"]
"""What a slot tells: a result, what went wrong, that a cell is done, that it has nothing more to do."""


def _slot(
    worker: Worker,
    left: "queue.SimpleQueue[Searched]",
    journal: Journal,
    told: "queue.SimpleQueue[_News]",
    stop: threading.Event,
) -> None:
    """Take one cell after the other that is left, and have what has no result run."""

    def made(point: Point) -> bool:
        if journal.get(point) is None:
            if stop.is_set():
                return False
            record = worker(point)
            journal.add(point, record)
            told.put(record)
        found = journal.said(point)
        return found is not None and found.status != "broken"

    try:
        while not stop.is_set():
            outcome_of(left.get_nowait(), journal, made)
            told.put("cell")
    except queue.Empty:
        pass
    except Exception as error:
        told.put(error)
    finally:
        told.put("end")


def outcome_of(cell: Searched, journal: Journal, made: Callable[[Point], bool] = lambda _: True) -> Outcome:
    """What became of a cell, by the results that are there.

    Args:
        cell: that was asked for.
        journal: has the results.
        made: is asked of each run before its result is looked up, and says whether to go on.
    """
    runs: list[tuple[Point, Record]] = []
    search = cell.search()
    try:
        point = next(search)
        while made(point) and (record := journal.said(point)) is not None:
            runs.append((point, record))
            point = search.send(record)
    except StopIteration as end:
        whole = all(record.status != "broken" for _, record in runs)
        return Outcome(cell, tuple(runs), end.value if whole else None, whole)
    return Outcome(cell, tuple(runs), complete=False)


@contextmanager
def interrupts_ignored() -> Iterator[None]:
    """Ignore Ctrl-C for a moment; only the main thread can."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
