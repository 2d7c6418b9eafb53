"""The robot of a scenario: what bounds its walk, what it is in truth, and which keys follow from more than its size."""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cached_property, lru_cache, partial
from typing import TYPE_CHECKING, Any

import numpy as np

from surefoot.models.facts import RobotFacts, facts_of, similar_com_height, similar_step_width, similar_tread
from surefoot.models.names import ROBOTS, is_file
from surefoot.scenarios.errors import Key
from surefoot.scenarios.file.schema import BeliefErrors, RobotSettings
from surefoot.scenarios.file.sensing import MotorSettings
from surefoot.streams import Stream, generator

if TYPE_CHECKING:
    from surefoot.models.types import RobotDescription

    Describe = Callable[[str, RobotSettings], RobotDescription]


class Robots:
    """Robots that scenarios may name, each looked at once: a robot file that changes meanwhile takes another object."""

    @cached_property
    def description(self) -> "Describe":
        """Gives a robot with its options, see `describe`."""
        return lru_cache(maxsize=None)(describe)

    @cached_property
    def _facts(self) -> Callable[[str, RobotSettings], RobotFacts]:
        return lru_cache(maxsize=None)(partial(_registered, self.description))

    def names(self) -> tuple[str, ...]:
        """Names of all robots."""
        return tuple(ROBOTS)

    def facts(self, name: str, options: RobotSettings) -> RobotFacts:
        """Facts of a robot, whichever body carries its payload; ValueError where it cannot have these options."""
        return self._facts(name, options.model_copy(update={"payload_body": None}))

    def one_foot_share(self, name: str, options: RobotSettings) -> float:
        """Greatest share of a joint's torque that standing on one foot takes, infinite where it cannot stand so [-]."""
        return self._shares(name, options)

    @cached_property
    def _shares(self) -> Callable[[str, RobotSettings], float]:
        return lru_cache(maxsize=None)(partial(_one_foot_share, self.description))

    @cached_property
    def heights(self) -> dict[tuple[str, str], float]:
        """CoM heights [m] that have been found already, by the two walks whose knees they bend alike."""
        return {}


def _registered(description: "Describe", name: str, options: RobotSettings) -> RobotFacts:
    return facts_of(description(name, options), options.payload_mass)


def _one_foot_share(description: "Describe", name: str, options: RobotSettings) -> float:
    from surefoot.scenarios.setup.robot.body import body_of, on_one_foot

    return on_one_foot(body_of(description(name, options))).share


def is_known(name: object, robots: Robots) -> bool:
    """Return true if a scenario may name that robot: one of the robots, or a robot file, whatever is in it."""
    return isinstance(name, str) and (is_file(name) or name in robots.names())


def describe(name: str, options: RobotSettings) -> "RobotDescription":
    """Describe a robot with its options."""
    from surefoot.models.registry import describe as describe_robot
    from surefoot.models.types import RobotOptions

    return describe_robot(name, RobotOptions(**options.model_dump()))


def true_robot(
    errors: BeliefErrors, motors: MotorSettings | None, robot: "RobotDescription", seed: int
) -> "RobotDescription":
    """The robot as it is; itself when nothing about its mass is believed wrongly, and its joints lose no torque.

    What it carries unbeknown comes last, so that it is as heavy as was said, at the true CoM of its body.
    """
    from surefoot.models import belief

    if errors.com_height != 0.0:
        robot = belief.with_com_raised(robot, -errors.com_height)
    if errors.mass_scale != 1.0:
        # Of the mass itself the quotient, which logs have to the last digit.
        robot = replace(
            belief.with_mass_scaled(robot, 1.0 / errors.mass_scale), mass=float(robot.mass) / errors.mass_scale
        )
    if errors.torso_mass not in (None, 1.0):
        robot = belief.with_torso_mass_scaled(robot, 1.0 / errors.torso_mass)
    if any(errors.torso_com or ()):
        robot = belief.with_torso_com_moved(robot, -np.array(errors.torso_com))
    if errors.link_mass_noise:
        robot = belief.with_masses_scattered(robot, errors.link_mass_noise, generator(seed, Stream.MASSES))
    if errors.payload is not None and errors.payload.mass > 0.0:
        robot = belief.with_load(robot, errors.payload.mass, errors.payload.body)
    if motors is not None and (motors.damping or motors.friction_loss):
        robot = belief.with_joint_losses(robot, motors.damping or 0.0, motors.friction_loss or 0.0)
    return robot


def nearer_landings(gait: Mapping[str, Any], takes_commands: bool) -> float:
    """Distance by which feet land nearer than their step width; infinite where they may land anywhere [m].

    Args:
        gait: keys of the group ``gait`` that are given.
        takes_commands: whether the walk hears while it goes on where to go.
    """
    velocity = gait.get("velocity")
    commands = velocity if isinstance(velocity, list | tuple) else ()
    sideways = any(isinstance(one, Mapping) and (one.get("v_y") or one.get("yaw_rate")) for one in commands)
    if takes_commands or sideways or any(gait.get(name) for name in ("turn", "footsteps", "waypoints")):
        return math.inf
    aside = gait.get("lateral_step", 0.0)
    return abs(aside) if isinstance(aside, int | float) else math.inf


Rule = Callable[[float, RobotFacts, RobotFacts], float]
"""Gives the value of a key for another robot, from the value for one, facts of that one, and facts of the other."""


def rules(nearer: float) -> dict[Key, Rule]:
    """Keys that follow from more than a robot's size, where feet land that much nearer (see `nearer_landings`) [m]."""
    return {
        ("gait", "com_height"): similar_com_height,
        ("gait", "step_width"): partial(similar_step_width, nearer=nearer),
        ("terrain", "tread"): similar_tread,
    }


POSTURE = ("com_height", "step_width")
"""Keys that every walk has."""
