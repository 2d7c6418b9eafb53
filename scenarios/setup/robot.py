"""The robot of a scenario: its description with the chosen options, what bounds its walk, and what it is in truth."""

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Protocol

import numpy as np

from surefoot.models.facts import RobotFacts, facts_of
from surefoot.models.names import ROBOTS, is_file
from surefoot.scenarios.file.schema import BeliefErrors, RobotSettings
from surefoot.streams import Stream, generator

if TYPE_CHECKING:
    from surefoot.models.types import RobotDescription


class Robots(Protocol):
    """The robots that scenarios may name."""

    def names(self) -> tuple[str, ...]:
        """Names of all robots."""
        ...

    def facts(self, name: str, options: RobotSettings) -> RobotFacts:
        """Facts of a robot with its options.

        Raises:
            ValueError: the robot cannot have these options.
        """
        ...

    def one_foot_share(self, name: str, options: RobotSettings) -> float:
        """Share of some joint's torque that standing on one foot takes, of the joint that it takes most of [-].

        Infinite where the robot cannot stand so at its nominal CoM height.

        Raises:
            ValueError: the robot cannot have these options.
        """
        ...


class RegisteredRobots:
    """The robots of ``models``, each looked at once: a robot file that changes meanwhile takes another object."""

    @cached_property
    def _facts(self) -> Callable[[str, RobotSettings], RobotFacts]:
        return lru_cache(maxsize=None)(_registered)

    def names(self) -> tuple[str, ...]:
        """Names of all robots."""
        return tuple(ROBOTS)

    def facts(self, name: str, options: RobotSettings) -> RobotFacts:
        """Facts of a robot with its options; which body carries the payload does not matter to them."""
        return self._facts(name, options.model_copy(update={"payload_body": None}))

    def one_foot_share(self, name: str, options: RobotSettings) -> float:
        """See `Robots`."""
        from surefoot.scenarios.setup.stance import body_of, on_one_foot

        return on_one_foot(body_of(describe(name, options))).share


def _registered(name: str, options: RobotSettings) -> RobotFacts:
    return facts_of(describe(name, options), options.payload_mass)


def is_known(name: object, robots: Robots) -> bool:
    """Whether a scenario may name that robot: one of the robots, or a robot file, whatever is in it."""
    return isinstance(name, str) and (is_file(name) or name in robots.names())


def describe(name: str, options: RobotSettings) -> "RobotDescription":
    """Describe a robot with its options."""
    from surefoot.models.registry import describe as describe_robot
    from surefoot.models.types import RobotOptions

    return describe_robot(name, RobotOptions(**options.model_dump()))


def true_robot(errors: BeliefErrors, robot: "RobotDescription", seed: int) -> "RobotDescription":
    """The robot as it is; itself when nothing about its mass is believed wrongly.

    What it carries unbeknown comes last, so that it is as heavy as was said, at the true CoM of its body.
    """
    from surefoot.models.belief import (
        with_com_raised,
        with_load,
        with_mass_scaled,
        with_masses_scattered,
        with_torso_com_moved,
    )

    if errors.com_height != 0.0:
        robot = with_com_raised(robot, -errors.com_height)
    if errors.mass_scale != 1.0:
        # Of the mass itself the quotient, which logs have to the last digit.
        robot = replace(with_mass_scaled(robot, 1.0 / errors.mass_scale), mass=float(robot.mass) / errors.mass_scale)
    if any(errors.torso_com or ()):
        robot = with_torso_com_moved(robot, -np.array(errors.torso_com))
    if errors.link_mass_noise:
        robot = with_masses_scattered(robot, errors.link_mass_noise, generator(seed, Stream.MASSES))
    if errors.payload is not None and errors.payload.mass > 0.0:
        robot = with_load(robot, errors.payload.mass, errors.payload.body)
    return robot
