"""The paper's experiments: which runs, in which worlds, with which profiles."""

import shlex
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import chain, product, starmap
from typing import Literal

PaperWorld = Literal["cart-table", "pendulum", "full"]
"""The paper's own plant, which executes the planned jerk and cannot fall; the true pendulum; the robot in physics."""

WORLD_SETTINGS: dict[PaperWorld, tuple[str, ...]] = {
    "cart-table": ("fidelity=pendulum", "pendulum.plant=cart_table"),
    "pendulum": ("fidelity=pendulum",),
    "full": ("fidelity=full", "sensing.source=truth"),
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
    """One run: of a study, with a profile, in a world, with a seed of everything random."""

    study: Study
    profile: str
    world: PaperWorld
    seed: int = 0

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


def with_sign(value: float) -> str:
    """A signed number for people."""
    return f"{value:+g}".replace("-", "\N{MINUS SIGN}")


def _signed(name: str, value: float, title: str, base: str, setting: str) -> Study:
    """A study named by a signed number, in the letters that a scenario's name may have."""
    return Study(f"{name}-{'minus' if value < 0 else 'plus'}-{abs(value):g}", title, base, (setting,))


HEIGHT_ERRORS = (-0.2, -0.1, 0.1, 0.2)
HEIGHTS = tuple(
    _signed("height", off, f"CoM height error {with_sign(off)} m", "paper-height-error", f"errors.com_height={off}")
    for off in HEIGHT_ERRORS
)

PUSH_FORCES = (-75, -50, 75, 50)
_PUSH = "pushes=[{{time: 2.2, duration: 0.01, force: [{0}, {0}, 0]}}]"
PUSHES = tuple(
    _signed("push", force, f"Push {with_sign(force)} N", "paper-push", _PUSH.format(force)) for force in PUSH_FORCES
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
    starmap(shove, ((i, way, kind) for kind in ADAPTATIONS for way in SHOVE_DIRECTIONS for i in SHOVE_IMPULSES))
)

GAITS = {"slow": 0.5, "fast": 0.8}
"""Speeds of the gaits whose feet roll from heel to toe [m/s]."""

KNEES = {"stretched": "straight", "bent": "bent"}
"""Names of `planner.knee`."""


def knee_study(gait: str, knee: str) -> Study:
    """A gait of one speed with stretched or with bent knees: steps, their times and the feet's edges are the same."""
    title = f"{gait.capitalize()} gait, {knee} knees"
    settings = (f"gait={{speed: {GAITS[gait]}, steps: 24}}", f"planner.knee={KNEES[knee]}")
    return Study(f"knee-{gait}-{knee}", title, "walk-level", settings)


BLOCKS: tuple[tuple[Iterable[Study], tuple[str, ...], tuple[PaperWorld, ...], int], ...] = (
    ((WALK, BRISK_WALK, *STAIRS, BRISK_STAIRS), PROFILES, ("pendulum",), 3),
    ((WIDE_WALK, STEP_LAW), CLAIMANTS, ("pendulum",), 1),
    ((WALK, *STAIRS), CLAIMANTS, ("cart-table",), 1),
    ((WALK,), ("paper", "repaired", "default", "lti"), ("full",), 1),
    ((WIDE_WALK, BRISK_WALK), ("default",), ("full",), 1),
    (STAIRS[:2], ("default", "lti"), ("full",), 1),
    ((NOISE_WALK, NOISE_STAIRS), CLAIMANTS, ("pendulum",), 5),
    ((NOISE_WALK, NOISE_STAIRS), ("paper", "repaired"), ("cart-table",), 1),
    ((NOISE_ALONE, ZMP_ONLY), ("repaired", "default"), ("pendulum",), 5),
    ((ZMP_ONLY,), ("repaired",), ("cart-table",), 3),
    ((NOISE_WALK,), ("default",), ("full",), 3),
    ((NOISE_STAIRS,), ("default",), ("full",), 1),
    (HEIGHTS, CLAIMANTS, ("pendulum",), 1),
    (HEIGHTS, ("paper", "repaired"), ("cart-table",), 1),
    (HEIGHTS, ("default",), ("full",), 1),
    (PUSHES, CLAIMANTS, ("pendulum",), 3),
    (PUSHES, ("paper",), ("cart-table",), 1),
    (PUSHES, ("default",), ("full",), 2),
    (SHOVES, ("default",), ("pendulum",), 1),
    (tuple(starmap(knee_study, product(GAITS, KNEES))), ("default",), ("full",), 1),
)
"""Studies that are run with every one of some profiles in every one of some worlds, and with how many seeds."""


def experiments() -> tuple[Experiment, ...]:
    """Every run of the page, none twice."""
    every = (starmap(Experiment, product(*chosen, range(seeds))) for *chosen, seeds in BLOCKS)
    return tuple(dict.fromkeys(chain.from_iterable(every)))
