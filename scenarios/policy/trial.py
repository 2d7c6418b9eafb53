"""A short run of a policy with its contract as given: it stands, is commanded to walk, and is measured."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import yaml
from numpy.typing import NDArray

from surefoot.planner.geometry.plane import headings
from surefoot.scenarios.errors import SetupError
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.log import NoLog
from surefoot.scenarios.policy.contract import Contract
from surefoot.scenarios.run.planning import RunFault
from surefoot.scenarios.run.run import closed_loop
from surefoot.scenarios.setup.robot.robots import describe
from surefoot.scenarios.setup.walk import resolve

Array = NDArray[np.float64]

STANDS, WALKS = 1.5, 3.5
"""Times for which the robot stands and then walks in a trial, of the reference robot [s]."""

SETTLED = 1.5
"""Time within which it comes to the velocity, of the reference robot [s]."""

SPEED = 0.4
"""Speed at which it is to walk ahead, at most, and the share of the fastest that the contract knows [m/s, -]."""

ASTRAY, LEANS, JUMPS = 0.5, 0.35, 0.5
"""Bounds of a walk of a sound contract.

They are on the error of the velocity over that commanded [-], on the tilt of the base [rad], and on the change of
targets from one decision to the next, RMS over joints and time [rad].
"""


@dataclass(frozen=True, slots=True)
class Trial:
    """The result of a policy in a trial.

    Attributes:
        stood: how long it was up [s].
        lasted: how long the trial was to take [s].
        astray: error of the base's mean velocity over the commanded one, once settled; infinite after a fall [-].
        leaned: mean tilt of the base [rad].
        jumped: change of targets from one decision to the next, RMS [rad].
        fault: what ended it before its time, empty where nothing did.
    """

    stood: float
    lasted: float
    astray: float
    leaned: float
    jumped: float
    fault: str = ""

    @property
    def up(self) -> bool:
        """True if it was up to the end."""
        return self.stood >= self.lasted and not self.fault

    @property
    def sound(self) -> bool:
        """True if it stood and walked as one of a sound contract does."""
        return self.up and self.astray < ASTRAY and self.leaned < LEANS and self.jumped < JUMPS

    @property
    def cost(self) -> float:
        """Cost of the trial: less is better; who falls sooner is worse whatever else there is [-]."""
        if not self.up:
            return 10.0 * (2.0 - self.stood / self.lasted)
        return min(self.astray, 3.0) / ASTRAY + min(self.leaned, 1.5) / LEANS + min(self.jumped, 3.0) / JUMPS


def trial_of(contract: Contract, network: Path, robot: str) -> Trial:
    """Try a contract.

    Args:
        contract: that is tried.
        network: path of its network.
        robot: name of the robot.

    Raises:
        SetupError: contract, network and robot do not fit together.
    """
    speed = min(SPEED, 0.6 * _fastest(contract))
    with TemporaryDirectory() as folder:
        file = Path(folder, "contract.yaml")
        values = {**contract.model_dump(mode="json", exclude_none=True), "network": str(network.absolute())}
        file.write_text(yaml.safe_dump(values), encoding="utf-8")
        return _tried(scenario_of(robot, str(file), speed), speed)


def _fastest(contract: Contract) -> float:
    ahead = contract.command.v_x
    return math.inf if ahead is None else max(ahead[1], 0.0)


def scenario_of(robot: str, policy: str, speed: float) -> Scenario:
    """The scenario in which a policy is tried: level ground, true state, a velocity ahead [m/s] after a while."""
    height = float(describe(robot, Scenario().robot_options).com_height)
    time = math.sqrt(height)
    values: Mapping[str, Any] = {
        "name": "trial",
        "robot": robot,
        "duration": (STANDS + WALKS) * time,
        "gait": {"steps": 0, "com_height": height},
        "controller": {"policy": policy},
        "commands": [{"time": STANDS * time, "v_x": speed}] if speed else [],
        "criteria": {"fell": {"equals": False}},
    }
    return Scenario.model_validate(values)


def _tried(scenario: Scenario, speed: float) -> Trial:
    walk = resolve(scenario)
    loop = closed_loop(walk, NoLog())
    walker: Any = loop.walker
    settled = loop.duration - (WALKS - SETTLED) * math.sqrt(float(scenario.gait.com_height))
    tilts: list[float] = []
    actions: list[Array] = []
    begun: tuple[float, Array] | None = None
    reported = None
    while not loop.done and not loop.fell and loop.step():
        if walker.mind.told is not reported:
            reported = walker.mind.told
            actions.append(walker.mind.target)
        x, y = walker.measurement.q[3:5].tolist()
        tilts.append(math.acos(min(max(1.0 - 2.0 * (x * x + y * y), -1.0), 1.0)))
        if begun is None and loop.time >= settled:
            begun = loop.time, walker.measurement.q[:7].copy()
    fault = loop.end.reason if loop.end.kind == "fault" else ""
    stood = loop.duration if not (loop.fell or fault) else loop.time
    jumped = float(np.sqrt(np.mean(np.diff(actions, axis=0) ** 2))) if len(actions) > 1 else math.inf
    astray = math.inf
    if begun is not None and not loop.fell and not fault:
        astray = _astray(begun, loop.time, walker.measurement.q, speed)
    return Trial(stood, loop.duration, astray, float(np.mean(tilts or [math.inf])), jumped, fault)


def _astray(begun: tuple[float, Array], now: float, q: Array, speed: float) -> float:
    """Error of the mean velocity from then to now over the commanded one [-]."""
    time, before = begun
    yaw = float(headings(before[3:7]))
    moved = (q[:2] - before[:2]) / max(now - time, 1e-9)
    ahead = moved @ np.array([math.cos(yaw), math.sin(yaw)])
    aside = moved @ np.array([-math.sin(yaw), math.cos(yaw)])
    return float(math.hypot(ahead - speed, aside) / max(speed, 0.1))


def trial_or_refusal(contract: Contract, network: Path, robot: str) -> Trial:
    """The trial of a contract; of one that does not fit the worst there is, with the reason as its fault."""
    try:
        return trial_of(contract, network, robot)
    except (SetupError, RunFault) as refusal:
        return Trial(0.0, 1.0, math.inf, math.inf, math.inf, " ".join(str(refusal).split()))
