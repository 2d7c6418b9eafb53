"""The registries of the parts that a scenario names; nothing is imported before a part is asked for."""

from typing import Any

from surefoot.models.names import ROBOTS
from surefoot.parts.plugins import At, Declared, Registry
from surefoot.planner.laws.names import PROFILES
from surefoot.scenarios.errors import Key
from surefoot.wbc.tasks.registry import TASKS

_TERRAIN = "surefoot.scenarios.setup.terrain"

TERRAIN_KINDS: Declared[Any] = Declared(
    "surefoot.terrains",
    f"{_TERRAIN}.ground:TerrainKind",
    {
        "flat": At("The bare ground plane", f"{_TERRAIN}.level:FLAT"),
        "stairs": At(
            "A staircase, from the middle of the start feet along the start heading", f"{_TERRAIN}.stairs:STAIRS"
        ),
        "blocks": At(
            "A field of blocks; left and right ones stand side by side with a gap between them",
            f"{_TERRAIN}.faces:BLOCKS",
        ),
        "slope": At(
            "A slope along the start heading; by default its edge is half a step ahead of the start",
            f"{_TERRAIN}.faces:SLOPE",
        ),
    },
)
"""Kinds of ground by the value of ``terrain.kind``: builders of the ground."""

SOURCES: Declared[Any] = Declared(
    "surefoot.estimators",
    None,
    {
        "truth": At("No estimation: the true state. The default", "surefoot.scenarios.run.sensing:TrueState"),
        "ekf": At("An invariant Kalman filter of IMU, encoders and feet", "surefoot.scenarios.run.sensing:ekf"),
    },
)
"""Makers of an estimator of the state by the value of ``sensing.source``."""

PLANT_NAMES: Declared[Any] = Declared(
    "surefoot.plants",
    None,
    {
        "mujoco": At(
            "The simulated world of MuJoCo, with the true robot on the true ground",
            "surefoot.scenarios.run.full:simulated",
        ),
        "log": At(
            "What a log holds up to a time, then the simulated world from the state of the log on",
            "surefoot.scenarios.run.full:going_on",
        ),
    },
)
"""Makers of a plant, which moves the robot, by the value of ``plant.name``."""

CONTROLLERS: Declared[Any] = Declared(
    "surefoot.controllers",
    None,
    {
        "policy": At(
            "A network that a contract tells what it observes and what its outputs mean",
            "surefoot.scenarios.policy.controller:Policy",
        )
    },
)
"""Makers of what takes the seat of planner and whole-body controller, by the value of ``controller.name``."""

INSTRUMENTS: Declared[Any] = Declared(
    "surefoot.instruments",
    "surefoot.scenarios.run.instruments:Instrument",
    {"altimeter": At("The height of the base over the world's zero", "surefoot.scenarios.run.altimeter:ALTIMETER")},
)
"""Instruments, which read the true state into the log, by the value of ``instruments.name``."""

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
    ("instruments", "name"): INSTRUMENTS,
}
"""Registries by the key that names a part, or several; it may be one of each element of a list."""
