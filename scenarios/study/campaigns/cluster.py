"""The runs of a campaign on the machines of a dask.distributed cluster."""

import asyncio
import tempfile
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

from surefoot.scenarios.errors import ScenarioError, require
from surefoot.scenarios.record.provenance import relevant_versions
from surefoot.scenarios.run.run import made_folder
from surefoot.scenarios.study.campaigns.engine import Worker, perform
from surefoot.scenarios.study.campaigns.journal import LOGS, OF_A_MACHINE, MadeOf
from surefoot.scenarios.study.campaigns.points import Point, Record

PATIENCE = 10.0
"""How long a cluster may take to answer [s]."""


class Away(NamedTuple):
    """What comes back from another machine: what became of a run, what made it, and the files of its folder."""

    record: Record
    made_by: str
    files: dict[str, bytes]


def perform_away(point: Point, keep_all: bool) -> Away:
    """Make a run on a machine that shares no disk with the one that asks; arguments as of `perform`."""
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
    """Refuse workers whose runs would be others than those of this machine.

    Raises:
        ScenarioError: one lacks Surefoot, or has other versions of what a run depends on.
    """
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
