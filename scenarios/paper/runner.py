"""Runs experiments beside each other, each in a process that may die without taking the others with it."""

import queue
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing import get_context
from pathlib import Path

from scenarios.paper.experiment import Experiment
from scenarios.paper.outcome import Outcome, execute

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
