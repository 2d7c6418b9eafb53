"""Runs to be made and what became of each: single ones, and searches that choose the next run by the last."""

import hashlib
import json
import shlex
from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal, NamedTuple, Protocol

from surefoot.scenarios.judge.metrics import known
from surefoot.scenarios.setup.load import Written


class Base(NamedTuple):
    """A scenario that runs start from: what `surefoot run` finds it by, and how it is written."""

    reference: str
    written: Written


RunStatus = Literal["pass", "fail", "refused", "broken"]
"""Criteria met; missed; a scenario that cannot be run; a run without a result, which is tried again."""


@dataclass(frozen=True)
class Point:
    """One run.

    Attributes:
        base: the scenario that it starts from.
        settings: what is set over it, by dotted key, the seed last.
        labels: what tells it apart from the others of its campaign, by name.
        name: of the folder of its log, unique in its campaign.
    """

    base: Base
    settings: Mapping[str, Any]
    labels: Mapping[str, Any]
    name: str

    @cached_property
    def id(self) -> str:
        """Digest of what is run."""
        text = json.dumps([self.base.written.text, self.base.written.stem, list(self.settings.items())], default=str)
        return hashlib.sha256(text.encode()).hexdigest()[:20]

    @property
    def command(self) -> str:
        """The command that makes this run alone."""
        values = (f"{key}={_yaml(value)}" for key, value in self.settings.items())
        settings = " ".join(f"--set {shlex.quote(text)}" for text in values)
        return f"surefoot run {shlex.quote(self.base.reference)} {settings}"


@dataclass(frozen=True, slots=True)
class Record:
    """The result of a run.

    Attributes:
        id: of its point.
        status: see `RunStatus`.
        reasons: why not, one sentence each.
        metrics: of its verdict, by name.
        log: below the campaign's directory, empty where none is kept.
        wall_time: that it took [s].
        made_by: digest of the versions that made it.
    """

    id: str
    status: RunStatus
    reasons: tuple[str, ...] = ()
    metrics: Mapping[str, Any] = field(default_factory=dict)
    log: str = ""
    wall_time: float = 0.0
    made_by: str = ""


Side = Literal["inside", "below", "above"]


@dataclass(frozen=True, slots=True)
class Threshold:
    """The end of a search.

    Attributes:
        value: largest value up to which everything passed (ladder), or the end of the last range that passed (halving);
            None where the whole range lies on one side.
        side: whether the threshold is inside the range, below it or above it.
    """

    value: float | None
    side: Side


Search = Generator[Point, Record, Threshold | None]
"""Gives runs one after another, is sent what became of each, and ends with what was found, if it searched."""


class Searched(Protocol):
    """Runs that are made one after another: a cell of a campaign, or a single run."""

    def search(self) -> Search:
        """Its runs."""
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
    """The outcome of a cell.

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


def _yaml(value: Any) -> str:
    """A value as it may stand behind --set."""
    return value if isinstance(value, str) else json.dumps(value)


def folder_name(labels: Mapping[str, Any]) -> str:
    """A name of a folder that every file system takes; where it does not tell all of the labels, their digest does."""
    parts = [(name.rpartition(".")[2], str(value)) for name, value in labels.items()]
    safe = [(_safe(name), _safe(value)) for name, value in parts]
    text = ",".join(f"{name}={value}" for name, value in safe)
    if safe == parts and len(text) <= 120:
        return text
    return f"{text[:100]}-{hashlib.sha256(str(parts).encode()).hexdigest()[:12]}"


def _safe(text: str) -> str:
    return "".join(sign if sign.isascii() and (sign.isalnum() or sign in "._-+") else "_" for sign in text)


Runs = Sequence[tuple[Point, Record]]
"""Runs with what became of each."""


def facts(runs: Runs) -> Runs:
    """Runs without those that were judged and repeat one before them: alike but for the seed, and in every metric.

    Times on the wall's clock, which no two runs share, do not count.
    """
    found: dict[Any, tuple[Point, Record]] = {}
    for point, record in runs:
        alone = point.id if record.status in ("refused", "broken") else ""
        settings = [(key, value) for key, value in point.settings.items() if key != "seed"]
        measured = {name: value for name, value in record.metrics.items() if _is_repeatable(name)}
        same = json.dumps([settings, record.status, measured], sort_keys=True, default=str)
        found.setdefault((point.base.written, alone, same), (point, record))
    return list(found.values())


def _is_repeatable(name: str) -> bool:
    metric = known(name)
    return metric is None or metric.repeatable
