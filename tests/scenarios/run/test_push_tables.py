"""The tables of docs/recovery-results.md, run by run: `pytest -m long tests/scenarios/run/test_push_tables.py`.

Each is one replica. Near a threshold the last bits decide, so that a cell may fall on one machine and not on another;
what falls as far as it is known is marked so, and none of it is asked for.
"""

import math
from collections.abc import Iterator
from itertools import product
from pathlib import Path

import numpy as np
import pytest

import surefoot
from surefoot.scenarios import catalogue

pytestmark = pytest.mark.long

SURVIVED = {
    "criteria": {
        "fell": False,
        "steps_taken": "steps_planned",
        "standing_time_final": {"min": 0.5},
        "contact_force_peak": {"max": 5.0},
        "torque_ratio_max": {"max": 1.0},
        "self_contact_time": {"max": 0.0},
    },
    "gait.initial_stand": 0.4,
    "start.position_noise": 0.0005,
    "sensing.source": "truth",
}
SENSED = {"good": 0.95, "cheap": 0.85}
"""Share that is survived from sensors of a preset, of what is survived with the true state."""

FEET = {"robot_options": {"foot_length": 0.22, "foot_width": 0.11}}
GAIT = {"gait.single_support": 0.5, "gait.double_support": 0.12, "gait.com_height": 0.95}
NATURAL = ("walk-level", {**GAIT, "gait.steps": 7, "gait.step_length": 0.36, "duration": 11.0})
PAPER = ("diagonal-walk", {"duration": 18.0})
"""Both with time for the steps that a push at their end adds: each brings feet together of a robot that is at rest."""

WALKS = {
    "stairs-up": ("stairs-up", {"duration": 17.0}),
    "stairs-down": ("stairs-down", {"duration": 17.0}),
    "blocks": ("blocks", {"gait.steps": 6, "duration": 14.0}),
    "slope-up": ("slope", {}),
    "slope-down": ("slope", {"terrain.angle": -0.1745}),
    "turn": ("walk-turn", {}),
    "natural": NATURAL,
    "heel-off": (NATURAL[0], {**NATURAL[1], "gait.heel_off": 0.35}),
}
WIDE = {"gait.step_width": 0.26, "gait.step_length": 0.32, "terrain.tread": 0.32}
"""Lengths with which feet that are off their places do not touch, and have their corners on their treads."""

STAIRS = {"terrain.riser": 0.15, "terrain.start": 0.16}
"""Stairs of so long treads that ankles reach, with the footsteps in their middle."""

DIRECTIONS = {"forward": 0.0, "left": 0.5 * math.pi, "backward": math.pi, "right": -0.5 * math.pi}
PHASES = {
    "DS 0.5": ("double", 0.5),
    "SS 0.2": ("single", 0.2),
    "SS 0.5": ("single", 0.5),
    "SS 0.8": ("single", 0.8),
}
NATURAL_GOALS = {
    "DS 0.5": (0.55, 0.40, 0.65, 0.40),
    "SS 0.2": (0.55, 0.40, 0.65, 0.40),
    "SS 0.5": (0.98, 0.45, 0.85, 0.40),
    "SS 0.8": (0.55, 0.40, 0.65, 0.40),
}
TWICE = 0.25
"""Impulse of each of two pushes [N·s/kg]."""

PAPER_IMPULSES = {
    "forward": (0.12, 0.17, 0.20),
    "left": (0.12, 0.17, 0.20),
    "backward": (0.17, 0.24, 0.28),
    "right": (0.084, 0.12, 0.14),
}


def push(step: int, phase: str, impulse: float, direction: str) -> dict[str, object]:
    """A push of 0.1 s at the torso [N·s/kg]."""
    kind, fraction = PHASES[phase]
    place = {"step": step, "phase": kind, "fraction": fraction}
    return {**place, "duration": 0.1, "impulse": impulse, "direction": DIRECTIONS[direction]}


def assert_survives(walk: tuple[str, dict[str, object]], folder: Path, *pushes: dict[str, object]) -> None:
    name, keys = walk
    result = surefoot.run(surefoot.load(name, {**SURVIVED, **keys, "pushes": list(pushes)}), out=folder)
    result.log.unlink()
    assert result.verdict.passed, result.verdict.reasons


def natural_cells() -> Iterator[tuple[str, str, float]]:
    for phase, goals in NATURAL_GOALS.items():
        for direction, goal in zip(DIRECTIONS, goals, strict=True):
            yield from ((phase, direction, round(share * goal, 3)) for share in (0.7, 0.85, 1.0))


@pytest.mark.parametrize(("phase", "direction", "impulse"), list(natural_cells()))
def test_natural_gait(phase: str, direction: str, impulse: float, tmp_path: Path) -> None:
    assert_survives(NATURAL, tmp_path, push(3, phase, impulse, direction))


@pytest.mark.parametrize("rung", range(3))
@pytest.mark.parametrize(("phase", "direction"), list(product(PHASES, DIRECTIONS)))
def test_the_papers_gait(phase: str, direction: str, rung: int, tmp_path: Path) -> None:
    assert_survives(PAPER, tmp_path, push(3, phase, PAPER_IMPULSES[direction][rung], direction))


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("preset", SENSED)
@pytest.mark.parametrize("name", ["natural", "paper"])
@pytest.mark.parametrize(("phase", "direction"), list(product(PHASES, DIRECTIONS)))
def test_from_sensors(name: str, phase: str, direction: str, preset: str, seed: int, tmp_path: Path) -> None:
    walk, keys = NATURAL if name == "natural" else PAPER
    most = dict(zip(DIRECTIONS, NATURAL_GOALS[phase], strict=True)) if name == "natural" else _most_of_paper()
    sensing = {"sensing.source": "ekf", "sensing.preset": preset, "seed": seed}
    impulse = round(SENSED[preset] * most[direction], 4)
    assert_survives((walk, {**keys, **sensing}), tmp_path, push(3, phase, impulse, direction))


def _most_of_paper() -> dict[str, float]:
    return {direction: rungs[-1] for direction, rungs in PAPER_IMPULSES.items()}


@pytest.mark.parametrize("eighth", range(8))
@pytest.mark.parametrize(
    ("keys", "impulse", "duration"),
    [({**FEET, **GAIT}, 0.6, 8.0), ({}, 0.2, 20.0)],
    ids=["human-size feet", "7.5 cm feet"],
)
def test_standing(keys: dict[str, object], impulse: float, duration: float, eighth: int, tmp_path: Path) -> None:
    direction = math.remainder(0.25 * math.pi * eighth, 2.0 * math.pi)
    pushed = {"time": 0.5, "duration": 0.1, "impulse": impulse, "direction": direction}
    assert_survives(("stand", {**keys, "duration": duration}), tmp_path, pushed)


@pytest.mark.parametrize("phase", PHASES)
@pytest.mark.parametrize(
    ("first", "second"),
    [*((one, one) for one in DIRECTIONS), *zip(DIRECTIONS, [*DIRECTIONS][1:] + [*DIRECTIONS][:1], strict=True)],
)
def test_two_pushes_a_step_apart(phase: str, first: str, second: str, tmp_path: Path) -> None:
    """The second one comes in the step after, or in the one after that where the former ends before its moment."""
    pushes = [(push(3, phase, TWICE, first), push(step, phase, TWICE, second)) for step in (4, 5)]
    name, keys = NATURAL
    early = surefoot.run(surefoot.load(name, {**SURVIVED, **keys, "pushes": list(pushes[0])}), out=tmp_path)
    early.log.unlink()
    if any("a push never acted" in reason for reason in early.verdict.reasons):
        assert_survives(NATURAL, tmp_path, *pushes[1])
    else:
        assert early.verdict.passed, early.verdict.reasons


@pytest.mark.parametrize(
    ("walk", "step", "impulse"),
    [
        ("stairs-up", 3, 0.2), ("stairs-down", 3, 0.2), ("stairs-down", 7, 0.2), ("blocks", 3, 0.1),
        ("slope-up", 3, 0.1), ("slope-up", 3, 0.2), ("slope-down", 3, 0.2), ("turn", 3, 0.2), ("natural", 1, 0.2),
        ("natural", 7, 0.2), ("heel-off", 3, 0.2),
    ],
)  # fmt: skip
@pytest.mark.parametrize(("phase", "direction"), list(product(PHASES, DIRECTIONS)))
def test_elsewhere(walk: str, step: int, impulse: float, phase: str, direction: str, tmp_path: Path) -> None:
    assert_survives(WALKS[walk], tmp_path, push(step, phase, impulse, direction))


def ground(name: str) -> dict[str, object]:
    return {**WALKS[name][1], **WIDE, **(STAIRS if name != "blocks" else {})}


def displaced(name: str, seed: int) -> list[dict[str, object]]:
    """Footsteps of a walk, each up to 2.5 cm and 10 degrees off its place, but for the last two, on which it stands."""
    from surefoot.planner.steps.footsteps import plan_footsteps
    from surefoot.scenarios.setup.walk import resolve

    walk = resolve(surefoot.load(name, ground(name)))
    steps, rng = plan_footsteps(walk.gait, walk.ground.stance, walk.ground.terrain), np.random.default_rng(seed)
    places = []
    for row, step in enumerate(steps[2:], 2):
        off = rng.uniform(-1.0, 1.0, 3) * (0.025, 0.025, math.radians(10.0)) * (row < len(steps) - 2)
        x, y, yaw = (float(value) for value in (*(step.position[:2] + off[:2]), step.yaw + off[2]))
        places.append({"foot": step.foot.name.lower(), "x": x, "y": y, "yaw": yaw})
    return places


@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize("name", catalogue.OWN)
def test_nothing_is_adapted_without_need(name: str, seed: int, tmp_path: Path) -> None:
    """More than a millimetre of place or a millisecond of time, in walks that start up to half a millimetre apart."""
    criteria = {
        "fell": False,
        "steps_taken": "steps_planned",
        "step_shift": {"max": 1e-3},
        "step_timing": {"max": 1e-3},
    }
    keys = {"criteria": criteria, "start.position_noise": SURVIVED["start.position_noise"], "seed": seed}
    result = surefoot.run(surefoot.load(name, keys), out=tmp_path)
    result.log.unlink()
    assert result.verdict.passed, result.verdict.reasons


@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize("name", ["stairs-up", "stairs-down", "blocks"])
def test_disturbed_footsteps(name: str, seed: int, tmp_path: Path) -> None:
    keys = {**ground(name), "gait.footsteps": displaced(name, seed), "seed": seed}
    assert_survives((name, keys), tmp_path)
