"""Outcomes by study, profile and world, gathered over seeds."""

import statistics
from collections.abc import Iterable
from dataclasses import dataclass

from scenarios.paper.experiment import WORLD_SETTINGS, Experiment, Study, World
from scenarios.paper.outcome import Outcome
from scenarios.paper.studies import PROFILES


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
