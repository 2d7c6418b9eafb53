"""The rows of the benchmark: what a controller is given of the robot, and what it gives."""

from dataclasses import dataclass
from importlib import resources
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surefoot.joints import JointCommand
from surefoot.planner.steps.commands import Command
from surefoot.planner.types import PhaseInfo, Twist
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.run.assembly import Parts
from surefoot.scenarios.run.controller import Controller
from surefoot.scenarios.setup.load import load
from surefoot.studies.tour.odometry import ContractOdometry
from surefoot.studies.tour.robot import robot_file
from surefoot.studies.tour.walker import Goal
from surefoot.studies.tour.world import TourWorld

Array = NDArray[np.float64]

GAIN = 1.0
"""Gains of the velocity towards a place over the distance from it, and of the yaw rate over the angle [1/s]."""

FASTEST = (0.4, 0.3, 0.8)
"""Forward, sideways [m/s], and yaw rate [rad/s]. By 0.2 m/s sideways far places take longer than 5 s."""

COMMAND_RATE = 10
"""Rate at which the walk is given its velocity [Hz]."""


@dataclass(frozen=True, slots=True)
class Row:
    """A way to take part in the tour.

    Attributes:
        name: of it.
        meaning: what the controller is given and gives, in a few words.
        rate: of its readings and commands [Hz].
        drives_arms: whether the harness drives the arms.
        keys: of the scenario, over those of ``tour.yaml``.
        contract: whether it reads no more than the benchmark hands over.
    """

    name: str
    meaning: str
    rate: int
    drives_arms: bool = False
    keys: tuple[tuple[str, Any], ...] = ()
    contract: bool = False

    def controller(self) -> Controller:
        """A controller for this row.

        Raises:
            ScenarioError: the walk cannot be walked by the robot of the tour.
        """
        scenario = scenario_of(self.keys)
        parts = Parts(estimator=ContractOdometry) if self.contract else None
        return Controller(scenario.robot, scenario, parts=parts)

    def digest(self) -> str:
        """See `Entrant`; all of it is part of this code."""
        return ""

    def walker(self) -> "Planned":
        """See `Entrant`."""
        return Planned(self)


class Planned:
    """Planner and whole-body controller that go through a ride; see `TourWalker`.

    Args:
        row: that takes part.

    Attributes:
        controller: that walks.
        robot: of it.
        posture: configuration in which it begins on its feet, shape (nq,).
    """

    def __init__(self, row: Row) -> None:
        self.row, self.controller = row, row.controller()
        self.robot, self.posture = self.controller.walk.robot, self.controller.posture
        self._ticks = 0

    @property
    def gait(self) -> PhaseInfo:
        """See `TourWalker`; that which is planned."""
        return self.controller.planning.plan.phase

    @property
    def unsolved(self) -> bool:
        """See `TourWalker`."""
        return int(self.controller.report.status) > 1

    @property
    def falling(self) -> bool:
        """See `TourWalker`."""
        return bool(self.controller.planning.plan.status.falling)

    def reset(self, q: Array) -> None:
        """See `TourWalker`."""
        self._ticks = 0
        self.controller.reset(q)

    def step(self, world: TourWorld, goal: Goal, arms: JointCommand | None) -> JointCommand:
        """See `TourWalker`."""
        return self._step(world, command_to(goal.way, goal.turn), arms)

    def follow(self, world: TourWorld, twist: Twist, arms: JointCommand | None) -> JointCommand:
        """See `TourWalker`."""
        return self._step(world, Command(twist=twist, march=True), arms)

    def _step(self, world: TourWorld, command: Command, arms: JointCommand | None) -> JointCommand:
        due = self._ticks % (self.row.rate // COMMAND_RATE) == 0
        self._ticks += 1
        seen = world.contracted() if self.row.contract else world.measure()
        return self.controller.step(seen, command if due else None, arms)


DRIVES = {".*_(shoulder_.*|elbow|wrist_roll)_joint": (14.2506, 0.9072), ".*_wrist_(pitch|yaw)_joint": (16.7784, 1.0681)}
"""Stiffness and damping of the arms' drives, by regular expressions of the joints' names [N·m/rad, N·m·s/rad]."""

GAINS = {".*": (100.0, 6.0), ".*_knee_joint": (150.0, 6.0), ".*_ankle_.*": (40.0, 6.0)}
"""Stiffness and damping of legs and waist, where the controller gives positions [N·m/rad, N·m·s/rad]."""

ARMS = (("control.driven_joints", DRIVES),)
TARGETS = (
    *ARMS,
    ("control.output", "position"),
    ("control.output_rate", 50),
    ("control.feed_forward", False),
    ("control.gains", GAINS),
    ("sensing.force_estimate", False),  # wrenches 20 ms apart are no means, and nothing pushes for long in a tour
)


ROWS: dict[str, Row] = {
    row.name: row
    for row in (
        Row("torque", "true state in, torques of all joints out at 250 Hz", 250),
        Row("arms", "true state and targets of the arms in, torques of legs and waist out at 250 Hz", 250, True, ARMS),
        Row(
            "targets",
            "true state and targets of the arms in, positions of legs and waist out at 50 Hz",
            50,
            True,
            TARGETS,
        ),
        Row(
            "contract",
            "joints, turning and attitude of the pelvis, targets of the arms and the place in its frame in, positions "
            "of legs and waist out at 50 Hz",
            50,
            True,
            TARGETS,
            contract=True,
        ),
    )
}
"""All of them, by name."""


def scenario_of(keys: tuple[tuple[str, Any], ...]) -> Scenario:
    """The walk of a tour with keys over those of ``tour.yaml``."""
    with resources.as_file(resources.files(__package__).joinpath("tour.yaml")) as path:
        return load(str(path), {"robot": str(robot_file()), **dict(keys)})


def command_to(way: tuple[float, float], turn: float) -> Command:
    """The velocity to a place.

    Args:
        way: to it in the frame of the pelvis, forward and to the left [m].
        turn: to its heading [rad].
    """
    velocity = np.clip(GAIN * np.array([*way, turn]), np.negative(FASTEST), FASTEST)
    return Command(twist=Twist(*map(float, velocity)), march=True)
