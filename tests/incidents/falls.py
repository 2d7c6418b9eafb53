"""Ten falls of ten kinds, each with something beside its cause that need not act; two robots, and a policy."""

from pathlib import Path
from typing import Any

import surefoot
from surefoot.scenarios.file.schema import Scenario

Fall = tuple[str, dict[str, Any]]
"""A catalogue scenario, and what is set over it."""

SLIGHT = {"time": 0.4, "duration": 0.1, "impulse": 0.05}
"""A push that fells nobody."""

FALLS: dict[str, Fall] = {
    "push": (
        "walk-level",
        {
            "gait.steps": 5,
            "errors.mass_scale": 1.02,
            "pushes": [
                {"step": 2, "phase": "single", "fraction": 0.5, "impulse": 0.2},
                {"step": 3, "phase": "single", "fraction": 0.5, "impulse": 1.6, "direction": -1.2},
            ],
        },
    ),
    "stairs": ("stairs-up", {"terrain.height_noise": 0.06, "motors.noise": 0.2, "pushes": [SLIGHT]}),
    "hidden ground": (
        "walk-level",
        {
            "gait.steps": 6,
            "errors.ground": [{"x": 0.9, "length": 0.5, "height": 0.06}],
            "sensing.com_noise": 0.001,
            "start.position_noise": 0.002,
        },
    ),
    "sensor noise": ("walk-level", {"gait.steps": 6, "sensing.encoder_noise": 0.05, "pushes": [SLIGHT]}),
    "wrong mass": ("walk-level", {"gait.steps": 5, "errors.payload.mass": 130.0, "terrain.friction": 0.6}),
    "sabotaged gain": (
        "walk-level",
        {
            "gait.steps": 5,
            "wbc.balance.height_stiffness": 20000.0,
            "wbc.balance.height_damping": 0.01,
            "wbc.gains.posture": [25.0, 10.0],
            "pushes": [SLIGHT],
        },
    ),
    "friction": (
        "walk-level",
        {"gait.steps": 5, "terrain.friction": 0.05, "wbc.friction": 0.8, "errors.mass_scale": 0.95, "pushes": [SLIGHT]},
    ),
    "late motors": ("walk-level", {"gait.steps": 5, "motors.delay": 0.04, "motors.noise": 0.2}),
    "G1, a rule left out": (
        "walk-level",
        {
            "robot": "g1",
            "gait.steps": 5,
            "planner.step_adaptation": "none",
            "motors.friction_loss": 0.05,
            "pushes": [{"step": 3, "phase": "single", "fraction": 0.5, "impulse": 0.5, "direction": 0.6}],
        },
    ),
    "G1, a policy": (
        "stand",
        {
            "robot": "g1",
            "duration": 3.0,
            "gait.com_height": 0.67,
            "gait.initial_stand": 0.2,
            "sensing.gyro_noise": 0.02,
            "pushes": [{"time": 0.6, "impulse": 0.35}, {"time": 0.2, "impulse": 0.05}],
        },
    ),
}
"""Falls by their kind; the last one has a policy in the seat of planner and controller."""


def scenario_of(kind: str, folder: Path) -> Scenario:
    """The scenario of a fall; the policy of the last one is written into a folder."""
    name, values = FALLS[kind]
    if kind.endswith("a policy"):
        import policies

        values = {**values, "controller.policy": str(policies.stander(folder / "policy"))}
    return surefoot.load(name, values)


def logged(kind: str, folder: Path) -> Path:
    """Run a fall, and give its log."""
    return surefoot.run(scenario_of(kind, folder), out=folder / "runs").log
