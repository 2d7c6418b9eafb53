"""The registries of the parts that a scenario names; nothing is imported before a part is asked for."""

from typing import Any

from surefoot.models.names import ROBOTS
from surefoot.parts.plugins import Declared, Registry
from surefoot.planner.laws.names import PROFILES
from surefoot.scenarios.errors import Key
from surefoot.wbc.tasks.registry import TASKS

TERRAIN_KINDS: Declared[Any] = Declared(
    "surefoot.terrains",
    {
        "flat": "The bare ground plane",
        "stairs": "A staircase, from the middle of the start feet along the start heading",
        "blocks": "A field of blocks; left and right ones stand side by side with a gap between them",
        "slope": "A slope along the start heading; by default its edge is half a step ahead of the start",
    },
)
"""Names of ``terrain.kind``; `surefoot.scenarios.setup.terrain` brings the builders of the ground."""

SOURCES: Declared[Any] = Declared(
    "surefoot.estimators",
    {
        "truth": "No estimation: the true state. The default",
        "ekf": "An invariant Kalman filter of IMU, encoders and feet",
    },
)
"""Names of ``sensing.source``; `surefoot.scenarios.run.sensing` brings the estimators of the state."""

PLANT_NAMES: Declared[Any] = Declared(
    "surefoot.plants",
    {
        "mujoco": "The simulated world of MuJoCo, with the true robot on the true ground",
        "log": "What a log holds up to a time, then the simulated world from the state of the log on",
    },
)
"""Names of ``plant.name``; `surefoot.scenarios.run.plant` brings the plants, which move the robot."""

CONTROLLERS: Declared[Any] = Declared(
    "surefoot.controllers",
    {"policy": "A network that a contract tells what it observes and what its outputs mean"},
    "surefoot.scenarios.policy.controller",
)
"""Names of ``controller.name``, which takes the seat of planner and whole-body controller."""

DEFAULTS = {
    "terrain": "flat",
    "planner": "default",
    "sensing": "truth",
    "plant": "mujoco",
    "robot": "humanoid100",
    "controller": "policy",
}
"""Names that are always there, by the group of the key."""

REGISTRIES: dict[Key, Registry[Any]] = {
    ("robot",): ROBOTS,
    ("terrain", "kind"): TERRAIN_KINDS,
    ("planner", "profile"): PROFILES,
    ("sensing", "source"): SOURCES,
    ("wbc", "tasks"): TASKS,
    ("plant", "name"): PLANT_NAMES,
    ("controller", "name"): CONTROLLERS,
}
"""Registries by the key that names a part, or several."""
