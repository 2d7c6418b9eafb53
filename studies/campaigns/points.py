"""The runs of a campaign: what each is, which come after which, and what a search among them finds."""

import hashlib
import json
import shlex
import zlib
from collections.abc import Generator, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal, Protocol

import numpy as np

from surefoot.scenarios.judge.metrics import known
from surefoot.studies.campaigns.campaign import SCENARIO, SEARCH, Base, Campaign
from surefoot.studies.campaigns.spec import Bisect, Draw

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


@dataclass(frozen=True, slots=True)
class Cell:
    """Runs that are made one after another, a single one or a search: of some labels, keys and seeds of a campaign."""

    campaign: Campaign
    labels: Mapping[str, Any]
    keys: Mapping[str, Any]
    seeds: Sequence[int]

    def search(self) -> Search:
        """Its runs."""
        bisect = self.campaign.bisect(self.keys)
        if bisect is not None:
            return _climb(self, bisect) if bisect.ratio is not None else _halve(self, bisect)
        return self._first_accepted()

    def _first_accepted(self) -> Search:
        """The one run; where a key has several values to try, the first that is not refused."""
        tried = [(key, value) for key, values in self.campaign.spec.first.items() for value in values]
        for key, value in tried or [("", None)]:
            record = yield self.point(self.seeds[0], {key: value} if key else {})
            if record.status != "refused":
                break
        return None

    def point(self, seed: int, searched: Mapping[str, Any]) -> Point:
        """A run of this cell with a seed, also of what is drawn, and with values of the keys that are searched."""
        spec = self.campaign.spec
        drawn = {key: draw_value(draw, spec.seed, key, seed) for key, draw in spec.sample.items()}
        own = {key: value for key, value in self.keys.items() if not key.startswith(SEARCH)}
        settings = {**own, **drawn, **searched}
        base = self.campaign.bases[str(settings.pop(SCENARIO, spec.scenario))]
        parts = {**self.labels, **searched, "seed": seed}
        labels = {**self.labels, **drawn, **searched, "seed": seed}
        return Point(base, {**settings, "seed": seed}, labels, _folder(parts))


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


def cells(campaign: Campaign) -> Iterator[Cell]:
    """Every cell, in the order of the grid."""
    every = range(campaign.spec.seeds)
    for labels, keys in campaign.combinations():
        if campaign.spec.bisect is not None:
            yield Cell(campaign, labels, keys, every)
        else:
            yield from (Cell(campaign, labels, keys, (seed,)) for seed in every)


def draw_value(draw: Draw, campaign_seed: int, key: str, seed: int) -> Any:
    """A value drawn for a key and a seed, whatever else is drawn."""
    rng = np.random.default_rng([campaign_seed, seed, zlib.crc32(key.encode())])
    if draw.uniform is not None:
        return float(rng.uniform(draw.uniform[0], draw.uniform[1]))
    if draw.normal is not None:
        return float(rng.normal(draw.normal[0], draw.normal[1]))
    assert draw.choice is not None
    return draw.choice[int(rng.integers(len(draw.choice)))]


def _passes(cell: Cell, bisect: Bisect, value: float) -> Generator[Point, Record, bool]:
    """Return true if every seed passes; the first that does not decides."""
    for seed in cell.seeds:
        record = yield cell.point(seed, {bisect.key: value})
        if record.status != "pass":
            return False
    return True


def _climb(cell: Cell, bisect: Bisect) -> Search:
    """The highest rung up to which all pass."""
    reached = None
    for rung in bisect.rungs:
        if not (yield from _passes(cell, bisect, rung)):
            return Threshold(reached, "below" if reached is None else "inside")
        reached = rung
    return Threshold(reached, "above")


def _halve(cell: Cell, bisect: Bisect) -> Search:
    """Search where passing turns into failing, or failing into passing."""
    assert bisect.tolerance is not None
    low, high = bisect.low, bisect.high
    at_low = yield from _passes(cell, bisect, low)
    at_high = yield from _passes(cell, bisect, high)
    while at_low and at_high and bisect.most is not None and high < bisect.most:
        low, high = high, min(2.0 * high, bisect.most)
        at_high = yield from _passes(cell, bisect, high)
    if at_low == at_high:
        return Threshold(None, "above" if at_low else "below")
    while high - low > bisect.tolerance:
        middle = 0.5 * (low + high)
        if not low < middle < high:
            break
        if (yield from _passes(cell, bisect, middle)) == at_low:
            low = middle
        else:
            high = middle
    return Threshold(low if at_low else high, "inside")


def _yaml(value: Any) -> str:
    """A value as it may stand behind --set."""
    return value if isinstance(value, str) else json.dumps(value)


def _folder(labels: Mapping[str, Any]) -> str:
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
