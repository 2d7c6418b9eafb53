"""The robot of a scenario: its description with the chosen options, what bounds its walk, and what it is in truth."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Protocol

import numpy as np

from surefoot.scenarios.file.schema import BeliefErrors, RobotSettings
from surefoot.similarity import REFERENCE_SIZE, Similarity

if TYPE_CHECKING:
    from surefoot.models.types import RobotDescription


@dataclass(frozen=True, slots=True)
class RobotFacts:
    """Numbers of a robot that bound a scenario.

    Attributes:
        bodies: names of its bodies.
        leg_length: hip centre to sole with the knee straight [m].
        hip_width: distance between the hip centres [m].
        com_above_hip: CoM height over the hip centres, standing straight [m].
        foot_length: of the soles [m].
        foot_width: of the soles [m].
        shank_spacing: lateral distance of the soles at which upright shanks keep apart [m].
        swing_acceleration: of the sole of a straight leg, forward and sideways, with two thirds of the torque
            of its hip [m/s^2].
        ankle_torque: of the joints that pitch and roll the left foot [N m].
        size: against the reference robot, without what it carries.
    """

    bodies: tuple[str, ...]
    leg_length: float
    hip_width: float
    com_above_hip: float
    foot_length: float
    foot_width: float
    shank_spacing: float
    swing_acceleration: tuple[float, float]
    ankle_torque: tuple[float, float] = (math.inf, math.inf)
    size: Similarity = REFERENCE_SIZE


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
        from surefoot.models.registry import robot_names

        return robot_names()

    def facts(self, name: str, options: RobotSettings) -> RobotFacts:
        """Facts of a robot with its options; which body carries the payload does not matter to them."""
        return self._facts(name, options.model_copy(update={"payload_body": None}))

    def one_foot_share(self, name: str, options: RobotSettings) -> float:
        """See `Robots`."""
        from surefoot.scenarios.setup.stance import body_of
        from surefoot.scenarios.setup.standing import on_one_foot

        return on_one_foot(body_of(describe(name, options))).share


def _registered(name: str, options: RobotSettings) -> RobotFacts:
    described = describe(name, options)
    return replace(facts_of(described), size=size_of(described, options))


def is_known(name: object, robots: Robots) -> bool:
    """Whether a scenario may name that robot: one of the robots, or a robot file, whatever is in it."""
    from surefoot.models.registry import is_file

    return isinstance(name, str) and (is_file(name) or name in robots.names())


def size_of(description: "RobotDescription", options: RobotSettings) -> Similarity:
    """Size of a robot against the reference robot, without the payload that its options say."""
    return Similarity.of(description.leg_length, float(description.mass) - options.payload_mass)


HIPS, SHANKS = 0.2, 0.11
"""Distance between the hips of the reference robot, and of its soles at which its shanks keep apart [m]."""


def stance_widening(robot: "RobotDescription | RobotFacts", size: Similarity) -> float:
    """By what a robot of a size has to stand wider than the reference robot, scaled, for its hips or shanks [m]."""
    if size == REFERENCE_SIZE:
        return 0.0
    return max(0.0, robot.hip_width - size.length * HIPS, robot.shank_spacing - size.length * SHANKS)


def facts_of(description: "RobotDescription") -> RobotFacts:
    """What of a robot bounds a scenario, but for its size, which goes without its payload."""
    from surefoot.scenarios.setup.straight import ankle_torque, com_height, swing_acceleration

    return RobotFacts(
        bodies=description.bodies,
        leg_length=description.leg_length,
        hip_width=description.hip_width,
        com_above_hip=com_height(description) - description.leg_length,
        foot_length=description.sole_length,
        foot_width=description.sole_width,
        shank_spacing=description.shank_spacing,
        swing_acceleration=swing_acceleration(description),
        ankle_torque=ankle_torque(description),
    )


def describe(name: str, options: RobotSettings) -> "RobotDescription":
    """Describe a robot with its options."""
    from surefoot.models.registry import describe as describe_robot
    from surefoot.models.types import RobotOptions

    return describe_robot(name, RobotOptions(**options.model_dump()))


_STREAM = 3
"""Random numbers of the masses, apart from those of other things with the same seed."""


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
        rng = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(_STREAM,)))
        robot = with_masses_scattered(robot, errors.link_mass_noise, rng)
    if errors.payload is not None and errors.payload.mass > 0.0:
        robot = with_load(robot, errors.payload.mass, errors.payload.body)
    return robot
