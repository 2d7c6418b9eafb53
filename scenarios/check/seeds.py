"""Checks over seeds: runs side by side until a scenario is decided, written down so that an interrupted one goes on."""

from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from surefoot.scenarios.check import check as checking
from surefoot.scenarios.check.baseline import Baseline, comparable, read_baseline
from surefoot.scenarios.check.blunt import blunt
from surefoot.scenarios.check.check import Case, Checked, CheckStatus, Keeping
from surefoot.scenarios.check.findings import Asked, findings
from surefoot.scenarios.check.sample import MARGIN, SeedSample
from surefoot.scenarios.check.sampled import FIRST, Sampled, size_of
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.search import Bisect
from surefoot.scenarios.file.source import setting
from surefoot.scenarios.many.journal import Journal, outcome_of
from surefoot.scenarios.many.points import (
    Base,
    Point,
    Record,
    RunStatus,
    Search,
    Searched,
    Single,
    Threshold,
    folder_name,
)
from surefoot.scenarios.many.search import search
from surefoot.scenarios.many.slots import CampaignBar, closed_at_end, run_round, workers_of
from surefoot.scenarios.setup.load import load, written

FOLDER = "seeds"
"""Folder of the journal and of the logs of runs that missed their criteria, below that of the check's logs."""

NO_SAMPLE = "the baseline says nothing of other seeds"


@dataclass(frozen=True, slots=True)
class Running:
    """Options of a check.

    Attributes:
        out: directory of the logs.
        jobs: runs at once on this machine.
        seeds: runs of each scenario at most; None for what its file or its baseline says.
        cluster: address of a dask scheduler, to run there; None for this machine.
        update: whether baselines are written anew.
        keeping: keeps what is found; None where nothing does.
    """

    out: Path
    jobs: int
    seeds: int | None = None
    cluster: str | None = None
    update: bool = False
    keeping: Keeping | None = None


@dataclass(frozen=True, slots=True)
class Held:
    """Holds the logs of runs for what keeps them; what came of them is not known before their seeds were run."""

    keeping: Keeping

    def hold(self, checked: Checked) -> None:
        """See `Keeping`."""
        self.keeping.hold(checked)

    def keep(self, checked: Checked) -> Checked:
        """Keep nothing yet."""
        return checked


def check(
    chosen: Sequence[Case], running: Running, on_done: Callable[[Checked], None] = lambda _: None
) -> tuple[Checked, ...]:
    """Hold cases against their baselines, each with as many seeds as it asks for.

    Args:
        chosen: to run.
        running: how.
        on_done: called with each as it is done, and again with what an update made of it.

    Returns:
        what became of each, in their order.

    Raises:
        InterruptedRunsError: Ctrl-C while seeds were run; what was done is kept.
        LogError: results cannot be written.
        ScenarioError: the cluster cannot be reached or used.
    """
    counts = {case.scenario.name: seeds_of(case, running.seeds) for case in chosen}
    single = [case for case in chosen if counts[case.scenario.name] == 1]
    several = [case for case in chosen if counts[case.scenario.name] > 1]
    keeping = running.keeping
    for case in several:
        SeedRuns.of(case, ())  # refuses a search that cannot be before any run
    if running.cluster is not None and not several:
        raise ScenarioError(["--cluster is for runs of several seeds; give it with --seeds 6 or more"])
    done = checking.check(single, running.out, running.jobs, on_done, running.update, keeping) if single else ()
    if several:
        own = checking.check(several, running.out, running.jobs, keeping=None if keeping is None else Held(keeping))
        done += _over_seeds([Seeded.of(one, counts[one.case.scenario.name]) for one in own], running, on_done)
    by_name = {one.case.scenario.name: one for one in done}
    return tuple(by_name[case.scenario.name] for case in chosen)


def seeds_of(case: Case, given: int | None = None) -> int:
    """Number of seeds of a case at most: what is given, what its file says, or as many as its baseline has."""
    asked = given or case.scenario.seeds
    if asked is not None:
        return asked
    before = _baseline(case)
    if before is not None and before.sample is not None:
        return len(before.sample.seeds)
    return FIRST if case.scenario.margins else 1


def _baseline(case: Case) -> Baseline | None:
    try:
        return read_baseline(case.baseline) if case.baseline.exists() else None
    except ScenarioError:
        return None


@dataclass(frozen=True, slots=True)
class MarginSearch:
    """The search of a threshold with one seed."""

    runs: "SeedRuns"
    name: str
    bisect: Bisect
    seed: int

    def search(self) -> Search:
        """See `Searched`."""
        return search(self._passes, self.bisect)

    def _passes(self, value: float) -> Generator[Point, Record, bool]:
        record = yield self.runs.point(self.seed, {self.bisect.key: value})
        return record.status == "pass"


@dataclass(frozen=True, slots=True)
class SeedRuns:
    """The runs of a case that differ in their seed.

    Attributes:
        case: that is run.
        base: what its runs start from.
        seeds: at most, in this order.
    """

    case: Case
    base: Base
    seeds: tuple[int, ...]

    @classmethod
    def of(cls, case: Case, seeds: Iterable[int]) -> "SeedRuns":
        """The runs of a case with some seeds.

        Raises:
            ScenarioError: the scenario cannot be read, or a search of it is of no key or value that can be.
        """
        for name, bisect in (case.scenario.margins or {}).items():
            if bisect.key == "seed":
                raise ScenarioError([f"{case.reference}: margins.{name} searches the seed; give another key"])
            for value in (bisect.low, bisect.high):
                load(case.reference, (*case.overrides, f"{bisect.key}={value!r}"))
        return cls(case, Base(case.reference, written(case.reference)), tuple(seeds))

    @property
    def margins(self) -> Mapping[str, Bisect]:
        """Searches of thresholds by name."""
        return self.case.scenario.margins or {}

    def point(self, seed: int, searched: Mapping[str, Any] | None = None) -> Point:
        """A run with a seed, and with a value of a key that is searched."""
        settings = {**dict(map(setting, self.case.overrides)), **(searched or {}), "seed": seed}
        labels = {"scenario": self.case.scenario.name, **(searched or {}), "seed": seed}
        return Point(self.base, settings, labels, folder_name(labels))

    def cells(self, count: int) -> Iterator[Searched]:
        """Runs and searches of the first seeds."""
        for seed in self.seeds[:count]:
            yield Single(self.point(seed))
            yield from self.searches(seed)

    def searches(self, seed: int) -> Iterator[MarginSearch]:
        """Searches of the scenario's thresholds with a seed."""
        yield from (MarginSearch(self, name, bisect, seed) for name, bisect in self.margins.items())

    def sampled(self, journal: Journal, count: int) -> Sampled | str:
        """Runs of the first seeds by their journal, or why one of them gave no result."""
        runs: list[tuple[int, bool, Mapping[str, Any]]] = []
        reasons: dict[int, str] = {}
        beyond: dict[tuple[int, str], str] = {}
        took = 0.0
        for seed in self.seeds[:count]:
            record = journal.said(self.point(seed))
            if record is None or record.status in ("refused", "broken"):
                return f"seed {seed}: {'; '.join(record.reasons) if record else 'was not run'}"
            metrics = comparable(record.metrics, self.case.scenario.criteria)
            took += record.wall_time
            for one in self.searches(seed):
                outcome = outcome_of(one, journal)
                if outcome.threshold is None:
                    return f"seed {seed}: the search of {one.name} has no result"
                metrics[f"{MARGIN}{one.name}"] = _value(one.bisect, outcome.threshold)
                if outcome.threshold.side != "inside":
                    beyond[seed, one.name] = outcome.threshold.side
                took += sum(made.wall_time for _, made in outcome.runs)
            runs.append((seed, record.status == "pass", metrics))
            if record.status == "fail":
                reasons[seed] = record.reasons[0]
        return Sampled(SeedSample.of(runs), len(self.seeds), reasons=reasons, beyond=beyond, took=took)


@dataclass(frozen=True, slots=True)
class Seeded:
    """A case that is held against its baseline by the runs of its seeds.

    Attributes:
        own: the run of its own seed, held against the baseline.
        before: its baseline, if there is one.
        runs: of its seeds.
    """

    own: Checked
    before: Baseline | None
    runs: SeedRuns

    @classmethod
    def of(cls, own: Checked, count: int) -> "Seeded":
        """A case that was run with its own seed, and is to be run with so many at most.

        Where its seed is one of the baseline's, so are the others: only pairs tell more.
        """
        first, before = own.case.scenario.seed, _baseline(own.case)
        seeds = tuple(range(first, first + count))
        if before is not None and before.sample is not None and first in before.sample.seeds:
            seeds = tuple(seed for seed in seeds if seed in before.sample.seeds)
        return cls(own, before, SeedRuns.of(own.case, seeds))

    @property
    def most(self) -> int:
        """Number of its seeds."""
        return len(self.runs.seeds)

    def held(self, sampled: Sampled, scenarios: int, look: int) -> Sampled:
        """Runs of seeds held against the sample of the baseline, if it has one."""
        before = None if self.before is None else self.before.sample
        if before is None:
            return sampled
        asked = Asked(self.own.case.scenario.criteria, self.runs.margins, scenarios, look)
        return replace(sampled, before=before, findings=findings(before, sampled.sample, asked))


def _value(bisect: Bisect, found: Threshold) -> float:
    """A threshold; the end of the range beyond which it lies."""
    if found.value is not None:
        return float(found.value)
    return float(bisect.low if found.side == "below" else bisect.most or bisect.high)


def _over_seeds(left: Sequence[Seeded], running: Running, on_done: Callable[[Checked], None]) -> tuple[Checked, ...]:
    """Run seeds in rounds, each with twice as many as the one before, until each case is decided."""
    done: list[Checked] = []

    def tell(checked: Checked) -> None:
        checked = checked if running.keeping is None else running.keeping.keep(checked)
        on_done(checked)
        done.append(checked)
        if running.update and _is_to_be_written(checked):
            done[-1] = checking.rewritten(checked)
            on_done(done[-1])

    for one in left:
        if one.own.verdict is None:
            tell(one.own)
    pending = [one for one in left if one.own.verdict is not None]
    scenarios, look = len(left), 0
    with (
        Journal(running.out / FOLDER) as journal,
        closed_at_end(workers := workers_of(journal.folder, running.jobs, running.cluster, False)),
        CampaignBar(sum(one.most for one in pending)) as bar,
    ):
        for one in pending:
            _write_own(one, journal)
        while pending:
            look += 1
            sizes = [one.most if running.update else size_of(look, one.most) for one in pending]
            cells = [cell for one, size in zip(pending, sizes, strict=True) for cell in one.runs.cells(size)]
            run_round(cells, journal, workers, bar.run)
            rest = []
            for one, size in zip(pending, sizes, strict=True):
                sampled = one.runs.sampled(journal, size)
                if isinstance(sampled, str):
                    tell(replace(one.own, status="could not run", reasons=(sampled,), now=None))
                    continue
                sampled = one.held(sampled, scenarios, look)
                if size == one.most or sampled.decided or _is_settled(sampled):
                    tell(judged(one, sampled))
                else:
                    rest.append(one)
            pending = rest
    return tuple(done)


def _is_settled(sampled: Sampled) -> bool:
    """True if more seeds would say nothing new, since they do nothing."""
    return not sampled.random and not sampled.beyond and not any(MARGIN in name for name in sampled.sample.values)


def _write_own(one: Seeded, journal: Journal) -> None:
    """Write the run of a case's own seed into the journal, which was made already."""
    point, verdict = one.runs.point(one.runs.seeds[0]), one.own.verdict
    if verdict is None or journal.get(point) is not None:
        return
    status: RunStatus = "pass" if verdict.passed else "fail"
    made_by = journal.made_by(point)
    journal.add(point, Record(point.id, status, verdict.reasons, verdict.metrics, "", one.own.took, made_by))


def judged(one: Seeded, sampled: Sampled) -> Checked:
    """The result of a case by the runs of its seeds."""
    own, before = one.own, one.before
    verdict, now = own.verdict, own.now
    assert verdict is not None
    assert now is not None
    if sampled.random or one.runs.margins:
        now = replace(now, sample=sampled.sample)
    own = replace(own, sampled=sampled, took=sampled.took, now=now)
    if insensitive := blunt(verdict):
        return replace(own, status="failed", reasons=tuple(insensitive))
    if own.status == "unreadable baseline":
        return own
    if before is None or before.sample is None:
        return _without_sample(own, sampled)
    settings = [text for text in before.others(now.scenario, now.settings) if not text.startswith("seed is ")]
    world = before.other_world(now)
    gaps = before.gaps(now, one.own.case.scenario.criteria)
    status = _status(sampled, bool(settings), bool(world), bool(gaps))
    partings = own.partings if sampled.alarms and before.sample.seeds[0] == one.own.case.scenario.seed else ()
    return replace(own, status=status, reasons=(*settings, *world, *gaps), moves=(), partings=partings)


def _without_sample(own: Checked, sampled: Sampled) -> Checked:
    """The result where there is nothing to hold other seeds against: each must meet its criteria."""
    if sampled.reasons:
        return replace(own, status="failed")
    if own.status in ("same", "better") and sampled.random:
        return replace(own, status="incomplete baseline", reasons=(*own.reasons, NO_SAMPLE))
    return own


def _status(sampled: Sampled, other: bool, world: bool, gaps: bool) -> CheckStatus:
    verdicts = {one.verdict for one in sampled.findings}
    order: Iterable[tuple[CheckStatus, bool]] = (
        ("other scenario", other),
        ("worse", "worse" in verdicts),
        ("moved", world or "moved" in verdicts),
        ("incomplete baseline", gaps),
        ("not decided", not sampled.decided),
        ("better", "better" in verdicts),
    )
    return next((status for status, holds in order if holds), "same")


def _is_to_be_written(checked: Checked) -> bool:
    """Return true if the own seed met its criteria, and its baseline says something else, or has another sample."""
    if checked.now is None or checked.verdict is None or not checked.verdict.passed or blunt(checked.verdict):
        return False
    before = _baseline(checked.case)
    if checked.status != "same" or before is None or (before.sample is None) != (checked.now.sample is None):
        return True
    return before.sample is not None and checked.now.sample is not None and not before.sample.is_as(checked.now.sample)
