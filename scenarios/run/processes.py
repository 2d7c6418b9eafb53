"""Processes beside this one: they leave Ctrl-C to their parent and do not outlive it."""

import os
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing import get_context, parent_process
from typing import Any, TypeVar

T = TypeVar("T")


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
        os._exit(1)


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


def cores() -> int:
    """Number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
