"""The engine of many runs: processes on this machine, or the machines of a dask.distributed cluster."""

import asyncio
import shutil
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import Executor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple, Protocol

from surefoot.errors import PluginError
from surefoot.parts.guard import said
from surefoot.scenarios.errors import LogError, ScenarioError, SetupError, require
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.many.journal import LOGS, OF_A_MACHINE, SCRATCH, MadeOf
from surefoot.scenarios.many.points import Point, Record
from surefoot.scenarios.record.provenance import LOG_NAME, relevant_versions
from surefoot.scenarios.run.processes import interrupts_ignored, processes
from surefoot.scenarios.run.run import Result, made_folder, run_scenario
from surefoot.scenarios.setup.load import read_scenario

TRIES = 2
"""Number of times that a run whose process dies is begun."""


class Worker(Protocol):
    """Makes one run at a time."""

    def __call__(self, point: Point) -> Record:
        """Make a run, bring its log to where it is kept, and say what became of it."""
        ...

    def close(self) -> None:
        """Let it end; what it does not do any more is lost."""
        ...


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
        work: that it does, with the arguments of `perform`.
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
    """Processes on this machine, so many, for a campaign's folder; `keep_all` keeps the logs of all runs."""
    with interrupts_ignored():
        return [LocalWorker(folder, keep_all) for _ in range(jobs)]


PATIENCE = 10.0
"""Time that a cluster may take to answer [s]."""


class Away(NamedTuple):
    """The result of a run on another machine: what became of it, what made it, and the files of its folder."""

    record: Record
    made_by: str
    files: dict[str, bytes]


def perform_away(point: Point, keep_all: bool) -> Away:
    """Make a run on a machine that shares no disk with the one that asks; `keep_all` keeps the log of any run."""
    made_by = MadeOf().of(point, anywhere=True)
    with tempfile.TemporaryDirectory(prefix="surefoot-") as folder:
        record = perform(point, Path(folder) / "run", Path(folder) / LOGS, keep_all)
        kept = (Path(folder) / record.log).parent if record.log else None
        return Away(record, made_by, {path.name: path.read_bytes() for path in kept.iterdir()} if kept else {})


class ClusterWorker:
    """One thread of a worker of a cluster, for as long as a run takes.

    A run whose worker dies is begun again by the scheduler on another one.

    Args:
        client: of the cluster.
        folder: the campaign's directory on this machine.
        keep_all: whether the logs of all runs are kept.
    """

    def __init__(self, client: Any, folder: Path, keep_all: bool) -> None:
        self._client, self._folder, self._keep_all = client, folder, keep_all
        self._made_of = MadeOf()

    def __call__(self, point: Point) -> Record:
        """See `Worker`."""
        try:
            future = self._client.submit(perform_away, point, self._keep_all, key=f"run-{point.id}", pure=False)
            away: Away = future.result()
        except Exception as error:  # dask tells of lost workers and of a lost scheduler by many types
            what = " ".join(str(error).split()) or type(error).__name__
            return Record(point.id, "broken", (f"the cluster gave no result: {what[:300]}",))
        if away.files:
            own = made_folder(self._folder / LOGS / point.name)
            for name, content in away.files.items():
                (own / name).write_bytes(content)
        alike = away.made_by == self._made_of.of(point, anywhere=True)
        return replace(away.record, made_by=self._made_of.of(point) if alike else away.made_by)

    def close(self) -> None:
        """Leave the cluster."""
        self._client.close()


def cluster_workers(address: str, folder: Path, keep_all: bool, patience: float = PATIENCE) -> list[Worker]:
    """One worker for each thread of a cluster.

    Args:
        address: of its scheduler, such as ``tcp://127.0.0.1:8786``.
        folder: the campaign's directory on this machine.
        keep_all: whether the logs of all runs are kept.
        patience: how long it may take to answer [s].

    Raises:
        MissingExtraError: dask.distributed is not installed.
        ScenarioError: the cluster cannot be reached, has no worker, or other versions.
    """
    distributed = require("distributed", "cluster", "--cluster", "run on this machine with --jobs")
    try:
        asyncio.run(asyncio.wait_for(_knock(distributed, address, patience), patience))
    except Exception as error:  # whatever answers there may be no scheduler at all
        why = " ".join(str(error).split()) or type(error).__name__
        right = "give the address of a running dask scheduler, such as tcp://127.0.0.1:8786"
        raise ScenarioError([f"--cluster {address}: cannot be reached, {why[:200]}; {right}"]) from None
    client = distributed.Client(address, timeout=patience, set_as_default=False)
    try:
        threads = client.nthreads()
        if not threads:
            right = "start some with `dask worker ADDRESS --nthreads 1`"
            raise ScenarioError([f"--cluster {address}: has no workers; {right}"])
        _check_versions(address, client)
    except BaseException:
        client.close()
        raise
    return [ClusterWorker(client, folder, keep_all) for _ in range(sum(threads.values()))]


async def _knock(distributed: ModuleType, address: str, patience: float) -> None:
    """Shake hands with a scheduler and leave: a client that fails to connect would take its time to end."""
    connection = await distributed.comm.connect(address, timeout=0.5 * patience)
    await connection.close()


def _check_versions(address: str, client: Any) -> None:
    """Refuse, by a ScenarioError, workers whose runs would be others than those of this machine."""
    own = dict(relevant_versions())
    right = "install the same versions there, best from the same constraints.txt"
    try:
        found = client.run(lambda: dict(relevant_versions()), on_error="return")
    except Exception as error:
        raise ScenarioError([f"--cluster {address}: its workers do not answer, {error}; {right}"]) from None
    for worker, theirs in found.items():
        if not isinstance(theirs, dict):
            raise ScenarioError([f"--cluster {address}: worker {worker} cannot run Surefoot, {theirs}; {right}"])
        for name, version in own.items():
            if name not in OF_A_MACHINE and theirs.get(name) != version:
                what = f"worker {worker} has {name} {theirs.get(name)}, and this machine {version}"
                raise ScenarioError([f"--cluster {address}: {what}; {right}"])
