"""Walk in MuJoCo and in DART, with the same controller and robot files, and write down how the walks differ.

    python examples/other_simulator/compare.py docs/other-simulator.csv [--workers 2]

Needs the extra `dart`. A push acts for 0.1 s in the middle of the eighth single support.
"""

import argparse
import csv
import math
import tempfile
from concurrent.futures import ProcessPoolExecutor
from itertools import product
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from dart_plant import DartPlant

import surefoot

ROBOTS, ENGINES = ("humanoid100", "g1"), ("MuJoCo", "DART")
DIRECTIONS = {"forward": 0.0, "backward": math.pi, "left": math.pi / 2, "right": -math.pi / 2}
WALKS: dict[str, tuple[str, dict[str, Any]]] = {"walk": ("walk-level", {}), "walk-turn": ("walk-turn", {})}
for _name, _direction in DIRECTIONS.items():
    _push = {"step": 8, "phase": "single", "fraction": 0.5, "impulse": 0.2, "direction": _direction}
    WALKS[f"walk, pushed {_name}"] = ("walk-level", {"pushes": [_push]})
BOUNDS = {
    "fell": False,
    "steps_taken": "steps_planned",
    "standing_time_final": {"min": 1.0},
    "wbc_fallbacks": {"max": 0},
    "torque_ratio_max": {"max": 1.0},
}
"""Bounds of a pushed walk, in either engine."""
RIGID = {
    "criteria.zmp_inside_fraction": {"min": 0.99},
    "criteria.zmp_error_rms": {"max": 0.01},
    "criteria.unplanned_flight_time": {"max": 0.02},
}
"""Bounds of undisturbed walks in DART that are not those of the catalogue: its contact gives single blows."""
SHOWN = (
    *("zmp_error_rms", "zmp_inside_fraction", "com_error_rms"),
    *("footstep_error_max", "unplanned_flight_time", "self_contact_time"),
)


def scenario(walk: str, robot: str, engine: str) -> surefoot.Scenario:
    """A walk of the table with its bounds.

    Args:
        walk: one of `WALKS`.
        robot: name of the robot.
        engine: one of `ENGINES`.
    """
    name, keys = WALKS[walk]
    bounds: dict[str, Any] = {"criteria": BOUNDS} if "pushes" in keys else RIGID if engine == "DART" else {}
    return surefoot.load(name, {"robot": robot, "sensing.source": "truth", **keys, **bounds})


def row(case: tuple[str, str, str]) -> list[Any]:
    """Walk once; the row of the table."""
    walk, robot, engine = case
    parts = surefoot.Parts(plant=DartPlant) if engine == "DART" else None
    with tempfile.TemporaryDirectory() as folder:
        verdict = surefoot.run(scenario(*case), out=folder, parts=parts).verdict
    values = [verdict.metrics[name] for name in SHOWN]
    worst = [max(value) if isinstance(value, list | tuple) else value for value in values]
    return [walk, robot, engine, "pass" if verdict.passed else "fail", *(f"{value:.5g}" for value in worst)]


def main() -> None:
    """Write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("table", type=Path)
    parser.add_argument("--workers", type=int, default=2)
    given = parser.parse_args()
    with ProcessPoolExecutor(given.workers, get_context("spawn")) as pool:
        rows = list(pool.map(row, product(WALKS, ROBOTS, ENGINES)))
    with given.table.open("w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([["walk", "robot", "engine", "verdict", *SHOWN], *rows])


if __name__ == "__main__":
    main()
