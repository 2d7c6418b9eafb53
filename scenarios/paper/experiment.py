"""What is run: a study of the paper, with one planner profile, in one world, for one seed."""

import shlex
from dataclasses import dataclass
from typing import Literal

World = Literal["cart-table", "pendulum", "full"]
"""The paper's own plant, which executes the planned jerk and cannot fall; the true pendulum; the robot in physics."""

WORLD_SETTINGS: dict[World, tuple[str, ...]] = {
    "cart-table": ("fidelity=pendulum", "pendulum.plant=cart_table"),
    "pendulum": ("fidelity=pendulum",),
    "full": ("fidelity=full",),
}


PROFILE_SETTINGS: dict[str, tuple[str, ...]] = {"paper": ("planner.step_adaptation=none",)}
"""Printed as it is, the paper's step law steps on the DCM and the walk stops; a study of the law sets it again."""


@dataclass(frozen=True, slots=True)
class Study:
    """A scenario of the paper, or one that answers what the paper leaves open.

    Attributes:
        name: in letters, digits and hyphens.
        title: for people.
        base: catalogue scenario.
        settings: ``key=value`` over it.
        shows: what it is run for, in a sentence.
    """

    name: str
    title: str
    base: str
    settings: tuple[str, ...]
    shows: str


@dataclass(frozen=True, slots=True)
class Experiment:
    """One run.

    Attributes:
        study: what is run.
        profile: of the planner.
        world: in which.
        seed: of everything random.
    """

    study: Study
    profile: str
    world: World
    seed: int = 0

    @property
    def base(self) -> str:
        """Catalogue scenario that it starts from."""
        return self.study.base

    @property
    def name(self) -> str:
        """Name of the scenario as run; with the seed it is the name of the run's folder."""
        return f"{self.study.name}.{self.profile}.{self.world}"

    @property
    def folder(self) -> str:
        """Name of the run's folder."""
        return f"{self.name}-{self.seed}"

    @property
    def overrides(self) -> tuple[str, ...]:
        """Everything that is set over the base scenario."""
        return (
            f"name={self.name}",
            *WORLD_SETTINGS[self.world],
            f"planner.profile={self.profile}",
            *PROFILE_SETTINGS.get(self.profile, ()),
            *self.study.settings,
            f"seed={self.seed}",
        )

    @property
    def command(self) -> str:
        """The command that makes this run alone."""
        settings = " ".join(f"--set {shlex.quote(setting)}" for setting in self.overrides)
        return f"surefoot run {self.study.base} {settings}"


@dataclass(frozen=True, slots=True)
class Block:
    """Studies that are run in every combination.

    Attributes:
        studies: what.
        profiles: with which planners.
        worlds: in which worlds.
        seeds: how often; seeds 0, 1, ...
    """

    studies: tuple[Study, ...]
    profiles: tuple[str, ...]
    worlds: tuple[World, ...]
    seeds: int = 1

    def experiments(self) -> tuple[Experiment, ...]:
        """Every combination."""
        return tuple(
            Experiment(study, profile, world, seed)
            for study in self.studies
            for profile in self.profiles
            for world in self.worlds
            for seed in range(self.seeds)
        )
