"""The paper's experiments: which runs, in which worlds, with which profiles."""

import shlex
from dataclasses import dataclass
from typing import Literal

PaperWorld = Literal["cart-table", "pendulum", "full"]
"""The paper's own plant, which executes the planned jerk and cannot fall; the true pendulum; the robot in physics."""

WORLD_SETTINGS: dict[PaperWorld, tuple[str, ...]] = {
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
    """

    name: str
    title: str
    base: str
    settings: tuple[str, ...] = ()


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
    world: PaperWorld
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
    worlds: tuple[PaperWorld, ...]
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


PROFILES = ("paper", "repaired", "default", "lti", "preview", "dcm")
CLAIMANTS = ("paper", "repaired", "default")
"""Profiles that the paper's own experiments are run with: as printed, repaired, robust."""

START = "start.position_noise=0.001"
"""A start up to 1 mm beside the middle, so that runs without noise have a spread over seeds too."""

NOISE = ("sensing.zmp_noise=0.01", "sensing.com_noise=0.002")
"""Gaussian, cut at two standard deviations: the paper's ±0.02 m of the ZMP; of the CoM as the findings had it."""

BRISK = ("gait.single_support=0.7", "gait.double_support=0.3")

ALONE = ("pendulum.feedback=0",)
"""No low level that holds the true DCM to the plan: the planner alone closes the loop, as in the paper."""

WALK = Study("walk", "Diagonal walk", "paper-walk", (START,))
WIDE_WALK = Study("walk-wide", "Diagonal walk, feet 0.22 m apart", "diagonal-walk", (START,))
BRISK_WALK = Study("walk-brisk", "Diagonal walk, 0.7 + 0.3 s", "paper-brisk", (START,))
STEP_LAW = Study(
    "walk-step-law", "Diagonal walk, footsteps by the DCM", "paper-walk", (START, "planner.step_adaptation=location")
)

STAIRS = tuple(
    Study(f"stairs-{100 * riser:.0f}", f"Stairs of {riser:.2f} m", "stair-climbing", (f"terrain.riser={riser}", START))
    for riser in (0.10, 0.15, 0.18)
)
BRISK_STAIRS = Study(
    "stairs-brisk", "Stairs of 0.10 m, 0.7 + 0.3 s", "stair-climbing", ("terrain.riser=0.1", START, *BRISK)
)

NOISE_WALK = Study("noise-walk", "Diagonal walk, noise", "paper-noise")
NOISE_STAIRS = Study("noise-stairs", "Stairs of 0.10 m, noise", "stair-climbing", NOISE)
NOISE_ALONE = Study("noise-alone", "Diagonal walk, noise, planner alone", "paper-noise", ALONE)
ZMP_ONLY = Study(
    "noise-zmp-only",
    "Diagonal walk, noise, planner alone, ZMP-only filter",
    "paper-noise",
    (*ALONE, "planner.filter=zmp_only"),
)


def signed(value: float) -> str:
    """A signed number in the letters that a scenario's name may have."""
    return f"{'minus' if value < 0 else 'plus'}-{abs(value):g}"


def with_sign(value: float) -> str:
    """A signed number for people."""
    return f"{value:+g}".replace("-", "\N{MINUS SIGN}")


HEIGHT_ERRORS = (-0.2, -0.1, 0.1, 0.2)
HEIGHTS = tuple(
    Study(
        f"height-{signed(off)}",
        f"CoM height error {with_sign(off)} m",
        "paper-height-error",
        (f"errors.com_height={off}",),
    )
    for off in HEIGHT_ERRORS
)

PUSH_FORCES = (-75, -50, 75, 50)
PUSHES = tuple(
    Study(
        f"push-{signed(force)}",
        f"Push {with_sign(force)} N",
        "paper-push",
        (f"pushes=[{{time: 2.2, duration: 0.01, force: [{force}, {force}, 0]}}]",),
    )
    for force in PUSH_FORCES
)

SHOVE_IMPULSES = (11, 12, 13, 14)
SHOVE_DIRECTIONS = {"forward": (1, 0), "backward": (-1, 0), "left": (0, 1), "right": (0, -1)}
ADAPTATIONS = ("none", "location")


def shove(impulse: int, direction: str, adaptation: str) -> Study:
    """A push of 0.1 s soon after the second lift-off, with or without adaptation of the footsteps."""
    x, y = (10 * impulse * axis for axis in SHOVE_DIRECTIONS[direction])
    push = f"pushes=[{{step: 2, phase: single, fraction: 0.13, duration: 0.1, force: [{x}, {y}, 0]}}]"
    title = f"Shove of {impulse} N s {direction}, adaptation {adaptation}"
    settings = (push, f"planner.step_adaptation={adaptation}")
    return Study(f"shove-{adaptation}-{direction}-{impulse}", title, "paper-walk", settings)


SHOVES = tuple(
    shove(impulse, direction, adaptation)
    for adaptation in ADAPTATIONS
    for direction in SHOVE_DIRECTIONS
    for impulse in SHOVE_IMPULSES
)

GAITS = {"slow": "paper-walk", "fast": "walk"}
KNEES = ("stretched", "bent")


def knee_study(gait: str, knee: str) -> Study:
    """A gait with stretched or with bent knees."""
    title = f"{gait.capitalize()} gait, {knee} knees"
    return Study(f"knee-{gait}-{knee}", title, GAITS[gait], (f"planner.knee={knee}",))


KNEE_STUDIES = tuple(knee_study(gait, knee) for gait in GAITS for knee in KNEES)

BLOCKS = (
    Block((WALK, BRISK_WALK, *STAIRS, BRISK_STAIRS), PROFILES, ("pendulum",), 3),
    Block((WIDE_WALK, STEP_LAW), CLAIMANTS, ("pendulum",)),
    Block((WALK, *STAIRS), CLAIMANTS, ("cart-table",)),
    Block((WALK,), ("paper", "repaired", "default", "lti"), ("full",)),
    Block((WIDE_WALK, BRISK_WALK), ("default",), ("full",)),
    Block(STAIRS[:2], ("default", "lti"), ("full",)),
    Block((NOISE_WALK, NOISE_STAIRS), CLAIMANTS, ("pendulum",), 5),
    Block((NOISE_WALK, NOISE_STAIRS), ("paper", "repaired"), ("cart-table",)),
    Block((NOISE_ALONE, ZMP_ONLY), ("repaired", "default"), ("pendulum",), 5),
    Block((ZMP_ONLY,), ("repaired",), ("cart-table",), 3),
    Block((NOISE_WALK,), ("default",), ("full",), 3),
    Block((NOISE_STAIRS,), ("default",), ("full",)),
    Block(HEIGHTS, CLAIMANTS, ("pendulum",)),
    Block(HEIGHTS, ("paper", "repaired"), ("cart-table",)),
    Block(HEIGHTS, ("default",), ("full",)),
    Block(PUSHES, CLAIMANTS, ("pendulum",), 3),
    Block(PUSHES, ("paper",), ("cart-table",)),
    Block(PUSHES, ("default",), ("full",), 2),
    Block(SHOVES, ("default",), ("pendulum",)),
    Block(KNEE_STUDIES, ("default",), ("full",)),
)


def experiments() -> tuple[Experiment, ...]:
    """Every run of the page, none twice."""
    return tuple(dict.fromkeys(experiment for block in BLOCKS for experiment in block.experiments()))
