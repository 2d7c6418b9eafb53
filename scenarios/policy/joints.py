"""The joints of a contract in those of a robot: where they are, and with what gains they are driven."""

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from surefoot.errors import ParameterError
from surefoot.models.types import RobotDescription
from surefoot.scenarios.errors import nearest
from surefoot.scenarios.policy.contract import KEY, Contract, Others, PerJoint
from surefoot.scenarios.run.output import matching

Array = NDArray[np.float64]

HELD_DAMPING = 0.02
"""Damping over stiffness of joints that the contract does not name [s]."""


def spread(value: PerJoint, names: Sequence[str], what: str) -> Array:
    """A number for each of some joints, shape (k,).

    Raises:
        ParameterError: there are not as many, or a pattern names none, or a joint has none.
    """
    if isinstance(value, Mapping):
        found = np.full(len(names), np.nan)
        for pattern, number in value.items():
            chosen = matching(pattern, names, KEY, f"{what}: ")
            found[chosen] = number
        missing = [name for name, number in zip(names, found, strict=True) if math.isnan(number)]
        if missing:
            raise ParameterError(KEY, f"{what} says nothing of {missing[0]}", "name it, or all by '.*'")
        return found
    if isinstance(value, tuple):
        if len(value) != len(names):
            raise ParameterError(KEY, f"{what} has {len(value)} numbers for {len(names)} joints", "give one for each")
        return np.array(value, dtype=np.float64)
    return np.full(len(names), float(value))


def indices(names: Sequence[str], among: Sequence[str], what: str) -> NDArray[np.intp]:
    """Places of joints among others, shape (k,).

    Raises:
        ParameterError: one is not among them.
    """
    for name in names:
        if name not in among:
            raise ParameterError(KEY, f"{what} names '{name}', which is no joint of it", nearest(name, among))
    return np.array([among.index(name) for name in names], dtype=np.intp)


def within(values: Array, lower: Array | float, upper: Array | float) -> Array:
    """Values, each within its bounds."""
    return np.asarray(np.minimum(np.maximum(values, lower), upper))


class Joints:
    """The joints of a contract in those of a robot.

    Args:
        contract: that names them.
        robot: that has them.

    Attributes:
        named: places of the contract's joints in the robot, shape (k,).
        default: their default posture, shape (k,) [rad].
        posture: of all joints at the start, shape (nj,) [rad].
        stiffness: of all drives, shape (nj,) [N·m/rad].
        damping: of all drives, shape (nj,) [N·m·s/rad].

    Raises:
        ParameterError: they are not that robot's.
    """

    def __init__(self, contract: Contract, robot: RobotDescription) -> None:
        names, who = robot.joint_names, f"the contract, for robot {robot.name},"
        self.named = indices(contract.joints, names, who)
        self.default = spread(contract.default, contract.joints, "default")
        self.posture, self.stiffness, self.damping = _held(contract.others, robot, set(contract.joints))
        self.posture[self.named] = self.default
        self.stiffness[self.named] = spread(contract.stiffness, contract.joints, "stiffness")
        self.damping[self.named] = spread(contract.damping, contract.joints, "damping")
        for name, value in (("stiffness", self.stiffness), ("damping", self.damping)):
            if (value < 0.0).any():
                raise ParameterError(KEY, f"{name} of the contract is negative", "give numbers from 0 on")


def _held(others: Others, robot: RobotDescription, named: set[str]) -> tuple[Array, Array, Array]:
    """Angles at which joints that a contract does not name are held, their stiffness and damping, shape (nj,) each."""
    names = robot.joint_names
    posture = np.array(robot.nominal_joint_positions, dtype=np.float64)
    for pattern, angle in others.position.items():
        posture[matching(pattern, names, KEY, "others.position: ")] = angle
    limit = np.asarray(robot.torque_limit, dtype=np.float64)
    stiffness = limit.copy() if others.stiffness is None else _given(others.stiffness, names, named, "stiffness")
    damping = HELD_DAMPING * stiffness
    if others.damping is not None:
        damping = _given(others.damping, names, named, "damping")
    return posture, stiffness, damping


def _given(value: PerJoint, names: Sequence[str], named: set[str], what: str) -> Array:
    """Numbers of the joints that are not named, in the place of all."""
    rest = [name for name in names if name not in named]
    found = np.zeros(len(names))
    if rest:
        found[indices(rest, names, "others")] = spread(value, rest, f"others.{what}")
    return found
