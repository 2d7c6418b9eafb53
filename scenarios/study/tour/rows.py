"""The rows of the benchmark: what a controller is given of the robot, and what it gives."""

from collections.abc import Callable
from functools import lru_cache
from importlib import resources
from typing import Any

import numpy as np

from surefoot.planner.steps.commands import Command
from surefoot.planner.types import Twist
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.run.assembly import Parts
from surefoot.scenarios.run.controller import Controller
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.study.tour.robot import robot_file
from surefoot.values import dataclass

GAIN = 1.0
"""Of the velocity towards a place over the distance from it, and of the yaw rate over the angle [1/s]."""

FASTEST = (0.4, 0.2, 0.8)
"""Forward, sideways [m/s], and yaw rate [rad/s]."""

COMMAND_RATE = 10
"""At which the walk is told its velocity [Hz]."""


@dataclass(frozen=True, slots=True)
class Row:
    """A way to take part in the tour.

    Attributes:
        name: of it.
        meaning: what the controller is given and gives, in a few words.
        rate: of its readings and commands [Hz].
        drives_arms: whether the harness drives the arms.
        keys: of the scenario, over those of ``tour.yaml``.
        parts: in place of surefoot's own, made anew for each tour.
    """

    name: str
    meaning: str
    rate: int
    drives_arms: bool = False
    keys: tuple[tuple[str, Any], ...] = ()
    parts: Callable[[], Parts] = Parts

    def controller(self) -> Controller:
        """A controller for this row.

        Raises:
            ScenarioError: the walk cannot be walked by the robot of the tour.
        """
        scenario = _scenario(self)
        return Controller(scenario.robot, scenario, parts=self.parts())


ROWS: dict[str, Row] = {
    row.name: row for row in (Row("torque", "the true state, torques of all joints at 250 Hz", 250),)
}
"""All of them, by name."""


@lru_cache(maxsize=4)
def _scenario(row: Row) -> Scenario:
    with resources.as_file(resources.files(__package__).joinpath("tour.yaml")) as path:
        return load(str(path), {"robot": str(robot_file()), **dict(row.keys)})


def command_to(way: tuple[float, float], turn: float) -> Command:
    """The velocity to a place.

    Args:
        way: to it in the frame of the pelvis, forward and to the left [m].
        turn: to its heading [rad].
    """
    velocity = np.clip(GAIN * np.array([*way, turn]), np.negative(FASTEST), FASTEST)
    return Command(twist=Twist(*map(float, velocity)), march=True)
