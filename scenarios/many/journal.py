"""The directory of many runs: every result as soon as it is there, and the logs that are kept."""

import contextlib
import fcntl
import hashlib
import json
import os
import shutil
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import fields, is_dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any, Self

from pydantic import TypeAdapter

from surefoot.models.names import is_file
from surefoot.models.registry import describe
from surefoot.models.types import RobotOptions
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.file.source import parse
from surefoot.scenarios.many.points import Base, Outcome, Point, Record, Searched
from surefoot.scenarios.output import reason
from surefoot.scenarios.record.packages import packages_of
from surefoot.scenarios.record.provenance import relevant_versions
from surefoot.scenarios.run.run import made_folder
from surefoot.scenarios.setup.load import Written

JOURNAL, LOGS, SCRATCH = "runs.jsonl", "logs", ".running"

CHANGED = (
    "its robot, or the code that made it, is not that with which the campaign began; "
    "let both be the same everywhere, and give the command again"
)

OF_A_MACHINE = ("machine", "python")
"""Versions in which the machines of a cluster may differ from each other."""


class MadeOf:
    """Digests of versions, code and robots, each robot looked at once: what changes meanwhile takes another object.

    Args:
        versions: gives those that a result depends on, by name.
    """

    def __init__(self, versions: Callable[[], Mapping[str, str]] = relevant_versions) -> None:
        self._versions = versions
        self._base, self._robot = lru_cache(maxsize=None)(_named), lru_cache(maxsize=None)(robot_digest)
        self._policy = lru_cache(maxsize=None)(_policy_digest)

    def of(self, point: Point, anywhere: bool = False) -> str:
        """Digest of all that a run's result depends on but its scenario; ``anywhere``: that is one on every machine."""
        own, named, seat = self._base(point.base.written)
        words = frozenset((*named, *_words(dict(point.settings))))
        versions = {name: one for name, one in self._versions().items() if not (anywhere and name in OF_A_MACHINE)}
        robot = self._robot(str(point.settings.get("robot", own)))
        made_of = [versions, dict(packages_of(words)), robot]
        if policy := _policy_of(point.settings) or seat:
            made_of.append(self._policy(policy))
        return _digest(made_of)


def overlooked(values: Any, bases: Iterable[Base]) -> Iterator[str]:
    """A sentence if packages bring parts of runs: what of them their results do not follow.

    Args:
        values: that are set in them, with their keys.
        bases: scenarios that they start from.
    """
    words = set(_words(values))
    for base in bases:
        words |= _named(base.written)[1]
    if names := ", ".join(packages_of(frozenset(words))):
        seen = f"results are made anew when the code of {names} changes, or a file beside it that it names"
        yield f"{seen}; not when it reads other files or the environment: choose another --out then"


def _policy_of(settings: Mapping[str, Any]) -> str:
    """The policy that settings of keys name; empty where they name none."""
    seat = settings.get("controller")
    named = settings.get("controller.policy", seat.get("policy") if isinstance(seat, dict) else None)
    return str(named or "")


def _policy_digest(path: str) -> str:
    """Digest of a policy as it is on the disk now."""
    from surefoot.scenarios.policy.files import digest_of

    return digest_of(path)


def robot_digest(name: str) -> str:
    """Digest of a robot as it is described now, of what is wrong with it if it cannot be."""
    try:
        return _digest(describe(name, RobotOptions()))
    except (Exception, SystemExit) as error:  # whatever the parts of others raise
        return _digest(f"{type(error).__name__}: {error}")


def _named(written: Written) -> tuple[str, frozenset[str], str]:
    """A scenario's robot, a robot file by its full path, every word of its keys and values, and its policy if any."""
    values = parse(written.text, written.place).value
    robot = str(values.get("robot", Scenario.model_fields["robot"].default)) if isinstance(values, dict) else ""
    if is_file(robot):
        robot = os.path.normpath(Path(written.place).parent.absolute() / robot)
    seat = values.get("controller") if isinstance(values, dict) else None
    policy = str(seat.get("policy") or "") if isinstance(seat, dict) else ""
    if policy:
        policy = os.path.normpath(Path(written.place).parent.absolute() / policy)
    return robot, frozenset(_words(values)), policy


def _words(value: Any) -> Iterator[str]:
    """Texts among values, and the parts of their keys."""
    if isinstance(value, Mapping):
        for key, inner in value.items():
            yield from str(key).split(".")
            yield from _words(inner)
    elif isinstance(value, list | tuple):
        for inner in value:
            yield from _words(inner)
    elif isinstance(value, str):
        yield value


def _plain(value: Any) -> Any:
    """An array as a list; a dataclass as its fields by name, of which none is copied as `asdict` does."""
    if is_dataclass(value):
        return {entry.name: getattr(value, entry.name) for entry in fields(value)}
    return value.tolist()


def _digest(values: Any) -> str:
    text = json.dumps(values, sort_keys=True, default=_plain)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


_RECORD = TypeAdapter(Record)


class Journal:
    """The results of a campaign, one line each, of which a killed process loses none that was reported.

    Results of other versions, other code or another robot than those that run now are passed over, and made anew. So is
    one whose log is gone or cut.

    Args:
        folder: the campaign's directory, made where it is missing; held until `close`, so that of two processes only
            one works in it.
        keep_all: whether the log of every run is to be there.
        made_of: says what a result depends on.

    Attributes:
        folder: the directory.
        stale: how many results were passed over.

    Raises:
        LogError: it cannot be written, holds something else, or another process works in it.
    """

    def __init__(self, folder: Path, keep_all: bool = False, made_of: MadeOf | None = None) -> None:
        self.folder = made_folder(folder)
        self.stale = 0
        self._made_of = made_of or MadeOf()
        self._records: dict[str, Record] = {}
        self._broken: dict[str, Record] = {}
        self._writing, self._looking = threading.Lock(), threading.Lock()
        path = folder / JOURNAL
        if not path.exists() and any(folder.iterdir()):
            raise LogError(f"{folder}: holds something else than a campaign; choose an empty directory with --out")
        try:
            self._file = path.open("ab+")
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise LogError(f"{folder}: another process works on this campaign; choose another with --out") from None
        except OSError as error:
            raise LogError(f"{path}: cannot be written, {reason(error)}; choose another with --out") from None
        self._read(keep_all)
        shutil.rmtree(self.folder / SCRATCH, ignore_errors=True)  # of runs that were killed

    def get(self, point: Point) -> Record | None:
        """The result of a run; None when there is none that is of today, or it was broken."""
        record = self._records.get(point.id)
        if record is None or record.made_by == self.made_by(point):
            return record
        del self._records[point.id]
        self.stale += 1
        return None

    def said(self, point: Point) -> Record | None:
        """The result of a run, also a broken one of this time."""
        return self.get(point) or self._broken.get(point.id)

    def made_by(self, point: Point) -> str:
        """Digest of what a run is made of; a robot is described once, and by one thread."""
        with self._looking:
            return self._made_of.of(point)

    def add(self, point: Point, record: Record) -> None:
        """Write a result down; a broken one is only remembered, so that it is tried again at the next start.

        Raises:
            LogError: it cannot be written.
        """
        if record.status != "broken" and record.made_by != self.made_by(point):
            record = replace(record, status="broken", reasons=(CHANGED,))
        if record.status == "broken":
            self._broken[record.id] = record
            return
        line = json.dumps(record, default=_plain, allow_nan=False).encode() + b"\n"
        with self._writing:
            try:
                self._file.write(line)
                self._file.flush()
            except OSError as error:
                raise LogError(f"{self._file.name}: cannot be written on, {reason(error)}; make room") from None
            self._records[record.id] = record

    def close(self) -> None:
        """Leave the directory to others."""
        shutil.rmtree(self.folder / SCRATCH, ignore_errors=True)
        self._file.close()

    def _read(self, keep_all: bool) -> None:
        """Take over what is there, and cut off a line that was not finished."""
        self._file.seek(0)
        whole = 0
        for line in self._file:
            if not line.endswith(b"\n"):
                break
            whole += len(line)
            with contextlib.suppress(ValueError):
                record = _RECORD.validate_json(line)
                if self._has_log(record, keep_all):
                    self._records[record.id] = record
                else:
                    self._records.pop(record.id, None)
                    self.stale += 1
        self._file.seek(whole)
        self._file.truncate()
        os.fsync(self._file.fileno())

    def _has_log(self, record: Record, keep_all: bool) -> bool:
        if not record.log:
            return not keep_all or record.status == "refused"
        path = self.folder / record.log
        return path.is_file() and path.stat().st_size == record.metrics.get("log_bytes")

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def outcome_of(cell: Searched, journal: Journal, made: Callable[[Point], bool] = lambda _: True) -> Outcome:
    """Outcome of a cell by the results of a journal; ``made`` says of each run before whether to go on."""
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
