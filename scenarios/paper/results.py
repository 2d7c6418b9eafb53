"""What the logs of the experiments say, run by run and over seeds."""

import statistics
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from surefoot.scenarios.errors import LogError, ScenarioError, SetupError
from surefoot.scenarios.judge.verdict import judge
from surefoot.scenarios.log import Log, read
from surefoot.scenarios.loop.run import run_scenario
from surefoot.scenarios.paper.studies import PROFILES, WORLD_SETTINGS, Experiment, Study, World
from surefoot.scenarios.record.provenance import END_RECORD, LOG_NAME, SCENARIO_FILE, taken_folders, versions
from surefoot.scenarios.setup.load import load as load_scenario
from surefoot.scenarios.setup.walk import scenario_yaml

ENDED = ("completed", "fall")
"""How a run ends that is a result; a fall is one."""


@dataclass(frozen=True, slots=True)
class Outcome:
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


def execute(experiment: Experiment, folder: Path) -> Outcome:
    """Run an experiment, unless its log is there already, and read off its log what became of it.

    Args:
        experiment: to run.
        folder: of all runs.
    """
    try:
        scenario = load_scenario(experiment.base, experiment.overrides)
        logs = (own / LOG_NAME for own in taken_folders(folder, scenario.name, scenario.seed))
        done = next((log for log in logs if is_done(log, scenario_yaml(scenario))), None)
        return outcome_of(experiment, done or run_scenario(scenario, folder).log)
    except (ScenarioError, SetupError, LogError) as refusal:
        return Outcome(experiment, failure=" ".join(str(refusal).split()))
    except Exception as error:
        return Outcome(experiment, failure=f"internal error, {type(error).__name__}: {error}")


def is_done(path: Path, scenario: str) -> bool:
    """Whether a log is whole, and of this scenario, this code and these versions."""
    try:
        log = read(path)
        same_scenario = log.attachments.get(SCENARIO_FILE) == scenario.encode()
    except LogError:
        return False
    ended = log.metadata.get(END_RECORD, {}).get("kind") in ENDED
    return ended and not log.truncated and same_scenario and not log.losses() and _made_by(log) == _relevant(versions())


def outcome_of(experiment: Experiment, path: Path) -> Outcome:
    """Read off a log what became of an experiment.

    Raises:
        LogError: the log cannot be read.
    """
    log = read(path)
    end = log.metadata.get(END_RECORD, {})
    written = datetime.fromtimestamp(path.stat().st_mtime, UTC).isoformat(timespec="seconds")
    made = dict(log.metadata.get("versions", {}))
    if end.get("kind") not in ENDED:
        failure = f"the run ended at {end.get('time', '?')} s: {end.get('reason') or 'its log was cut off'}"
        return Outcome(experiment, path, {}, failure, made, written)
    return Outcome(experiment, path, judge(log).metrics, "", made, written)


def _made_by(log: Log) -> dict[str, str]:
    return _relevant(log.metadata.get("versions", {}))


def _relevant(made: Mapping[str, str]) -> dict[str, str]:
    """Versions that a run depends on: not the revision, whose digest says more and does not change with a text."""
    return {name: version for name, version in made.items() if name != "git_revision"}


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
    world: World
    outcomes: tuple[Outcome, ...]

    @property
    def runs(self) -> tuple[Outcome, ...]:
        """The outcomes that have metrics."""
        return tuple(outcome for outcome in self.outcomes if not outcome.failure)

    @property
    def failures(self) -> tuple[Outcome, ...]:
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

    outcomes: tuple[Outcome, ...]

    def sample(self, study: Study, profile: str, world: World) -> Sample:
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
    def failures(self) -> tuple[Outcome, ...]:
        """The experiments that gave no result."""
        return tuple(outcome for outcome in self.outcomes if outcome.failure)


def _kind(experiment: Experiment) -> tuple[Study, str, World]:
    return experiment.study, experiment.profile, experiment.world
