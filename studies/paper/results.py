"""The results of the experiments by their logs, run by run and over seeds, in numbers and in phrases."""

import math
import statistics
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.file.source import setting
from surefoot.scenarios.log import read
from surefoot.scenarios.many.engine import Worker
from surefoot.scenarios.many.journal import Journal
from surefoot.scenarios.many.points import Base, Point, Record, Single
from surefoot.scenarios.many.slots import CampaignBar, run_cells
from surefoot.scenarios.record.provenance import ABSENT, END_RECORD
from surefoot.scenarios.setup.load import written
from surefoot.scenarios.show.kit.html import MISSING, TableCell, number
from surefoot.studies.paper import studies
from surefoot.studies.paper.studies import Experiment, PaperWorld, Study

ENDED = ("completed", "fall")
"""Ends of a run that are a result; a fall is one."""


@dataclass(frozen=True, slots=True)
class ExperimentResult:
    """The result of an experiment.

    Attributes:
        experiment: that was run.
        log: its log, None when there is none.
        metrics: of the log; empty when the experiment failed.
        failure: why it gave no result, in a sentence; empty when it gave one.
        versions: that made the log.
        written: when it was, as UTC date and time in ISO form.
    """

    experiment: Experiment
    log: Path | None = None
    metrics: Mapping[str, Any] = field(default_factory=dict)
    failure: str = ""
    versions: Mapping[str, str] = field(default_factory=dict)
    written: str = ""

    @property
    def fell(self) -> bool:
        """True if the robot fell."""
        return bool(self.metrics.get("fell"))

    @property
    def end(self) -> str:
        """End of the run, in a phrase."""
        if self.failure:
            return "could not run"
        if self.fell:
            return f"fell at {number(self.metrics['fall_time'])} s"
        return f"{self.metrics.get('steps_taken', MISSING)} of {self.metrics.get('steps_planned', MISSING)} steps"


def run_experiments(
    experiments: Sequence[Experiment], folder: Path, workers: Sequence[Worker], bar: CampaignBar | None = None
) -> tuple[ExperimentResult, ...]:
    """Run what has not been run, telling a bar each; one that fails does not stop the others.

    Returns:
        an outcome for each experiment, in their order.

    Raises:
        LogError: the folder cannot be written.
        InterruptedRunsError: Ctrl-C; what was run is kept.
    """
    points = {one: _point(one) for one in experiments}
    callbacks = (bar.run, bar.cell) if bar is not None else ()
    with Journal(folder, keep_all=True) as journal:
        run_cells(map(Single, points.values()), journal, workers, *callbacks)
        records = {one: journal.said(point) for one, point in points.items()}
    return tuple(_outcome(one, record, folder) for one, record in records.items() if record is not None)


def _point(experiment: Experiment) -> Point:
    base = experiment.study.base
    return Point(Base(base, written(base)), dict(map(setting, experiment.overrides)), {}, experiment.folder)


def _outcome(experiment: Experiment, record: Record, folder: Path) -> ExperimentResult:
    """Outcome of an experiment, by the result of its run and by its log in a folder."""
    if not record.log:
        return ExperimentResult(experiment, failure="; ".join(record.reasons))
    path = folder / record.log
    try:
        log = read(path)
    except LogError as error:
        return ExperimentResult(experiment, failure=" ".join(str(error).split()))
    end, made = log.metadata.get(END_RECORD, {}), dict(log.metadata.get("versions", {}))
    at = datetime.fromtimestamp(path.stat().st_mtime, UTC).isoformat(timespec="seconds")
    failure, metrics = "", record.metrics
    if end.get("kind") not in ENDED:
        failure = f"the run ended at {end.get('time', '?')} s: {end.get('reason') or 'its log was cut off'}"
        metrics = {}
    return ExperimentResult(experiment, path, metrics, failure, made, at)


class Spread(NamedTuple):
    """A number over seeds: the median of its values, and the extremes."""

    median: float
    least: float
    greatest: float


@dataclass(frozen=True, slots=True)
class Sample:
    """Runs of a study, with a profile, in a world, that differ in their seed alone."""

    study: Study
    profile: str
    world: PaperWorld
    outcomes: tuple[ExperimentResult, ...]

    @property
    def runs(self) -> tuple[ExperimentResult, ...]:
        """The outcomes that have metrics."""
        return tuple(outcome for outcome in self.outcomes if not outcome.failure)

    @property
    def complete(self) -> bool:
        """True if there is a run, and none failed."""
        return bool(self.outcomes) and len(self.runs) == len(self.outcomes)

    @property
    def falls(self) -> int:
        """Number of runs that fell."""
        return sum(outcome.fell for outcome in self.runs)

    def values(self, metric: str, element: int | str | None = None) -> list[float]:
        """A metric, or one element or part of it, of every run that has it; shape (runs,)."""
        found = [value for outcome in self.runs if (value := outcome.metrics.get(metric)) is not None]
        return [float(value if element is None else value[element]) for value in found]

    def spread(self, metric: str, element: int | str | None = None) -> Spread | None:
        """Median and extremes of a metric; None when no run has it."""
        values = self.values(metric, element)
        return Spread(statistics.median(values), min(values), max(values)) if values else None

    def median(self, metric: str, element: int | str | None = None) -> float | None:
        """Median of a metric; None when no run has it."""
        spread = self.spread(metric, element)
        return spread and spread.median

    def greatest(self, metric: str, element: int | str | None = None) -> float | None:
        """Greatest value of a metric; None when no run has it."""
        return max(self.values(metric, element), default=None)

    @property
    def feasible(self) -> Spread | None:
        """Share of plans whose problem, hard limits and all, had a solution [-]."""
        infeasible = self.spread("planner_infeasible_fraction")
        if infeasible is None:
            return None
        return Spread(1.0 - infeasible.median, 1.0 - infeasible.greatest, 1.0 - infeasible.least)

    @property
    def error_norms(self) -> list[float]:
        """Norm of the ZMP error's RMS in x and y, of each run [m]."""
        errors = (self.values("zmp_error_rms", axis) for axis in (0, 1))
        return [math.hypot(*both) for both in zip(*errors, strict=True)]


@dataclass(frozen=True, slots=True)
class Results:
    """All outcomes, in the order of the experiments."""

    outcomes: tuple[ExperimentResult, ...]

    def sample(self, study: Study, profile: str, world: PaperWorld = "pendulum") -> Sample:
        """Runs of a study with a profile in a world; without outcomes when it was not run."""
        found = (o for o in self.outcomes if _kind(o.experiment) == (study, profile, world))
        return Sample(study, profile, world, tuple(found))

    def of(self, study: Study, *profiles: str, world: PaperWorld = "pendulum") -> list[Sample]:
        """Runs of a study with some profiles."""
        return [self.sample(study, profile, world) for profile in profiles]

    def samples(self, some: Iterable[Study]) -> list[Sample]:
        """Every sample of some studies that was run: study by study, world by world, in the order of the profiles."""
        kinds = {_kind(outcome.experiment) for outcome in self.outcomes}
        every = product(some, studies.WORLD_SETTINGS, studies.PROFILES)
        return [self.sample(*kind) for study, world, profile in every if (kind := (study, profile, world)) in kinds]

    def survived(self, adaptation: str, direction: str) -> list[int] | None:
        """Impulses of a direction that did not make the robot fall [N s]; None when one of the runs is missing."""
        samples = {i: self.sample(studies.shove(i, direction, adaptation), "default") for i in studies.SHOVE_IMPULSES}
        if not all(sample.complete for sample in samples.values()):
            return None
        return [impulse for impulse, sample in samples.items() if not sample.falls]

    @property
    def failures(self) -> tuple[ExperimentResult, ...]:
        """The experiments that gave no result."""
        return tuple(outcome for outcome in self.outcomes if outcome.failure)

    @property
    def falls(self) -> int:
        """Number of runs that fell."""
        return sum(outcome.fell for outcome in self.outcomes)

    @property
    def versions(self) -> dict[str, list[str]]:
        """Every version that made a log, by name."""
        found: dict[str, dict[str, None]] = {}
        for outcome in self.outcomes:
            for name, value in outcome.versions.items():
                if value not in ("", ABSENT):
                    found.setdefault(name.replace("_", " "), {})[value] = None
        return {name: list(values) for name, values in found.items()}


def _kind(experiment: Experiment) -> tuple[Study, str, PaperWorld]:
    return experiment.study, experiment.profile, experiment.world


MM, PERCENT = 1e3, 1e2
WORLD_NAMES: dict[PaperWorld, str] = {"cart-table": "cart-table", "pendulum": "pendulum", "full": "full physics"}


def spread_text(spread: Spread | None, scale: float = 1.0, digits: int = 3) -> str:
    """A median, with its range where that is another text."""
    if spread is None:
        return MISSING
    between = _range(spread, scale, digits)
    return number(spread.median, scale, digits) + (f" ({between})" if between else "")


def _range(spread: Spread, scale: float, digits: int = 3) -> str:
    """Least and greatest value; empty when both read the same."""
    least, greatest = number(spread.least, scale, digits), number(spread.greatest, scale, digits)
    return "" if least == greatest else f"{least} … {greatest}"


def first_fall(sample: Sample) -> str:
    """Time of the first fall among some runs, in a phrase; empty when none fell."""
    return f"from {number(min(sample.values('fall_time')))} s on" if sample.falls else ""


def fell_text(sample: Sample) -> str:
    """Number of falls among the runs, and the time of the first one."""
    return ", ".join(filter(None, (f"{sample.falls} of {len(sample.runs)}", first_fall(sample))))


def balance_text(samples: Sequence[Sample]) -> str:
    """Falls and excursions of some samples of one profile and world, in a phrase."""
    name = f"{samples[0].profile}, {WORLD_NAMES[samples[0].world]}"
    runs = [outcome for sample in samples for outcome in sample.runs]
    missing = any(len(sample.runs) < len(sample.outcomes) for sample in samples)
    if missing or not runs:
        return f"{name}: could not run" if missing else f"{name}: not run"
    falls = sum(sample.falls for sample in samples)
    fell = fell_text(samples[0]) if len(samples) == 1 else f"{falls} of {len(runs)}"
    found = [value for sample in samples for value in sample.values("zmp_excursion_max")]
    return f"{name}: fell in {fell}; {_excursion_text(max(found, default=None))}"


def _excursion_text(excursion: float | None) -> str:
    """Excursion of the ZMP out of the 90 % box, in a phrase."""
    if excursion is None:
        return "no ZMP"
    if excursion <= 0.0:
        return f"ZMP at least {number(-excursion, MM)} mm inside the 90 % box"
    return f"ZMP up to {number(excursion, MM)} mm beyond the 90 % box"


def spread_cell(spread: Spread | None, scale: float = 1.0, kind: str = "number") -> TableCell:
    """The same as a cell, the range below the median."""
    if spread is None:
        return TableCell(MISSING, kind)
    return TableCell(number(spread.median, scale), kind, spread.median, _range(spread, scale))
