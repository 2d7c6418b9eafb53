"""What the logs of the experiments say, run by run and over seeds."""

import statistics
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.file.source import setting
from surefoot.scenarios.log import read
from surefoot.scenarios.record.provenance import END_RECORD
from surefoot.scenarios.setup.load import written
from surefoot.scenarios.study.campaigns.campaign import Base
from surefoot.scenarios.study.campaigns.engine import Single, Worker, run_cells
from surefoot.scenarios.study.campaigns.journal import Journal
from surefoot.scenarios.study.campaigns.points import Point, Record
from surefoot.scenarios.study.campaigns.sweep import CampaignBar
from surefoot.scenarios.study.paper.studies import PROFILES, WORLD_SETTINGS, Experiment, PaperWorld, Study

ENDED = ("completed", "fall")
"""How a run ends that is a result; a fall is one."""


@dataclass(frozen=True, slots=True)
class ExperimentResult:
    """What became of an experiment.

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


def run_experiments(
    experiments: Sequence[Experiment], folder: Path, workers: Sequence[Worker], bar: CampaignBar | None = None
) -> tuple[ExperimentResult, ...]:
    """Run what has not been run; one that fails does not stop the others.

    Args:
        experiments: to run.
        folder: of all runs.
        workers: that make the runs.
        bar: is told each.

    Returns:
        an outcome for each experiment, in their order.

    Raises:
        LogError: the folder cannot be written.
        InterruptedRunsError: Ctrl-C; what was run is kept.
    """
    points = {experiment: point_of(experiment) for experiment in experiments}
    told = (bar.run, bar.cell) if bar is not None else ()
    with Journal(folder, keep_all=True) as journal:
        run_cells(map(Single, points.values()), journal, workers, *told)
        records = {experiment: journal.said(point) for experiment, point in points.items()}
    return tuple(outcome_of(one, record, folder) for one, record in records.items() if record is not None)


def point_of(experiment: Experiment) -> Point:
    """The run of an experiment."""
    base = Base(experiment.base, written(experiment.base))
    return Point(base, dict(map(setting, experiment.overrides)), {}, experiment.folder)


def outcome_of(experiment: Experiment, record: Record, folder: Path) -> ExperimentResult:
    """What became of an experiment, by the result of its run.

    Args:
        experiment: that was run.
        record: of its run.
        folder: of all runs.
    """
    if not record.log:
        return ExperimentResult(experiment, failure="; ".join(record.reasons))
    path = folder / record.log
    try:
        log = read(path)
    except LogError as error:
        return ExperimentResult(experiment, failure=" ".join(str(error).split()))
    end, made = log.metadata.get(END_RECORD, {}), dict(log.metadata.get("versions", {}))
    at = datetime.fromtimestamp(path.stat().st_mtime, UTC).isoformat(timespec="seconds")
    if end.get("kind") not in ENDED:
        failure = f"the run ended at {end.get('time', '?')} s: {end.get('reason') or 'its log was cut off'}"
        return ExperimentResult(experiment, path, {}, failure, made, at)
    return ExperimentResult(experiment, path, record.metrics, "", made, at)


@dataclass(frozen=True, slots=True)
class Spread:
    """A number over seeds.

    Attributes:
        median: of the values.
        least: of the values.
        greatest: of the values.
    """

    median: float
    least: float
    greatest: float


@dataclass(frozen=True, slots=True)
class Sample:
    """Runs that differ in their seed alone.

    Attributes:
        study: that was run.
        profile: of the planner.
        world: in which.
        outcomes: by seed.
    """

    study: Study
    profile: str
    world: PaperWorld
    outcomes: tuple[ExperimentResult, ...]

    @property
    def runs(self) -> tuple[ExperimentResult, ...]:
        """The outcomes that have metrics."""
        return tuple(outcome for outcome in self.outcomes if not outcome.failure)

    @property
    def failures(self) -> tuple[ExperimentResult, ...]:
        """The outcomes that have none."""
        return tuple(outcome for outcome in self.outcomes if outcome.failure)

    @property
    def falls(self) -> int:
        """How many runs fell."""
        return sum(bool(outcome.metrics.get("fell")) for outcome in self.runs)

    @property
    def complete(self) -> bool:
        """Whether there is a run, and none failed."""
        return bool(self.runs) and not self.failures

    def values(self, metric: str, element: int | str | None = None) -> list[float]:
        """A metric, or one element or part of it, of every run that has it; shape (runs,)."""
        found = [outcome.metrics.get(metric) for outcome in self.runs]
        if element is not None:
            found = [None if value is None else value[element] for value in found]
        return [float(value) for value in found if value is not None]

    def spread(self, metric: str, element: int | str | None = None) -> Spread | None:
        """Median and extremes of a metric; None when no run has it."""
        values = self.values(metric, element)
        return Spread(statistics.median(values), min(values), max(values)) if values else None

    def median(self, metric: str, element: int | str | None = None) -> float | None:
        """Median of a metric; None when no run has it."""
        spread = self.spread(metric, element)
        return None if spread is None else spread.median

    def greatest(self, metric: str, element: int | str | None = None) -> float | None:
        """Greatest value of a metric; None when no run has it."""
        spread = self.spread(metric, element)
        return None if spread is None else spread.greatest


@dataclass(frozen=True, slots=True)
class Results:
    """All outcomes.

    Attributes:
        outcomes: in the order of the experiments.
    """

    outcomes: tuple[ExperimentResult, ...]

    def sample(self, study: Study, profile: str, world: PaperWorld) -> Sample:
        """Runs of a study with a profile in a world; without outcomes when it was not run."""
        found = (o for o in self.outcomes if _kind(o.experiment) == (study, profile, world))
        return Sample(study, profile, world, tuple(found))

    def samples(self, studies: Iterable[Study]) -> list[Sample]:
        """Every sample of some studies that was run: study by study, world by world, in the order of the profiles."""
        kinds = dict.fromkeys(_kind(outcome.experiment) for outcome in self.outcomes)
        return [
            self.sample(*kind)
            for study in studies
            for world in WORLD_SETTINGS
            for kind in sorted(kinds, key=lambda kind: PROFILES.index(kind[1]))
            if (kind[0], kind[2]) == (study, world)
        ]

    @property
    def failures(self) -> tuple[ExperimentResult, ...]:
        """The experiments that gave no result."""
        return tuple(outcome for outcome in self.outcomes if outcome.failure)


def _kind(experiment: Experiment) -> tuple[Study, str, PaperWorld]:
    return experiment.study, experiment.profile, experiment.world
