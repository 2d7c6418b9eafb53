"""Elements of a model that bind joints to each other: joints that follow others, closed loops, shared motors.

A description is a tree of joints that move on their own, one motor each, and of those that follow them in a leg (see
`surefoot.models.robot_file.couplings`). A binding among joints that are locked says nothing more; another one of joints
that move would be lost, so it is refused by name.
"""

import itertools
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pinocchio as pin

from surefoot.models.joints import world_axis
from surefoot.models.types import Array, RobotError

_SERIAL = "give a serial model: without it, and with the limits that the linkage leaves its joints"
_SHOWN = 3
"""Names of joints in a line."""

_NONE_TO_SPARE, _ALIKE = 6, 1e-3
"""Joints of a leg that has none to spare, and how near to each other alike limits and axes are [m, rad, -]."""


@dataclass(frozen=True, slots=True)
class Follower:
    """A joint that another one, or its element, moves.

    Attributes:
        kind: of the element.
        name: of the element, if it has one.
        leader: the other joint; None where it is held in place.
        angle: at which it is held without a leader, or where that is at zero [rad].
        ratio: its angle for that of the leader; None where that is no constant, or 0 [-].
    """

    kind: str
    name: str = ""
    leader: str | None = None
    angle: float = 0.0
    ratio: float | None = None

    @property
    def cause(self) -> str:
        """Its element and what that does."""
        element = element_name(self.kind, self.name)
        return f"{element} holds it" if self.leader is None else f"by {element} it follows '{self.leader}'"


@dataclass(frozen=True, slots=True)
class Binding:
    """An element that binds joints.

    Attributes:
        element: kind and name, for messages.
        joints: names of all that it binds.
        motor: whether it is a motor that drives them together: limits of the robot file answer it.
    """

    element: str
    joints: frozenset[str]
    motor: bool = False


def check_bindings(
    bindings: Iterable[Binding], free: Collection[str], limited: Collection[str], path: Path
) -> Iterator[str]:
    """Refuse what binds joints that move, and yield a line for what does not.

    Args:
        bindings: of the model.
        free: names of joints that are not locked.
        limited: those whose torque the robot file gives.
        path: of the model, for messages.

    Raises:
        RobotError: names the element and its joints.
    """
    for one in bindings:
        held = sorted(one.joints & set(free))
        names = ", ".join(f"'{name}'" for name in held)
        if one.motor and held and not set(held) <= set(limited):
            what = f"{path}: {one.element} drives joints {names}, so that the torque of none is its own"
            raise RobotError(("torque_limit",), what, f"give torque_limit with what it leaves each of {names}")
        if held and not one.motor:
            moving = "joints {}, which move on their own" if len(held) > 1 else "joint {}, which moves on its own"
            what = f"{path}: {one.element} binds {moving.format(names)} here"
            hold = f"hold them by lock: [{', '.join(held)}], or {_SERIAL}"
            raise RobotError(("model",), what, hold)
        why = "the robot file gives its joints their torque" if held else "its joints are locked"
        yield f"left out: {one.element}: {why}"


def element_name(kind: str, name: str) -> str:
    """An element in a message."""
    return f"{kind} '{name}'" if name else kind


def locked_note(names: Sequence[str], why: str, followers: Mapping[str, Follower]) -> str:
    """A line on joints that are locked for a reason, and on the elements by which they would follow others."""
    first = ", ".join(names[:_SHOWN])
    more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
    kinds = ", ".join(dict.fromkeys(followers[name].kind for name in names if name in followers))
    return f"left out: motion of {first}{more}{f', and {kinds}' if kinds else ''}: locked, {why}"


def rolling(model: pin.Model, joints: Sequence[int]) -> tuple[str, str] | None:
    """Two successive joints inside a leg that look as if they were one that rolls, whose coupling no element tells.

    Their axes are parallel and apart, and their ranges and torques are the same. A leg of six joints has no such pair
    to spare, so that only one of more joints is looked at.

    Args:
        model: whose limits are known.
        joints: of the leg, from hip to ankle.
    """
    if len(joints) <= _NONE_TO_SPARE:
        return None
    data = model.createData()
    pin.forwardKinematics(model, data, pin.neutral(model))
    for one, other in itertools.pairwise(joints[1:-1]):
        axes = [world_axis(model, data, joint) for joint in (one, other)]
        apart = data.oMi[other].translation - data.oMi[one].translation
        parallel = abs(float(axes[0] @ axes[1])) > 1.0 - _ALIKE
        aside = float(np.linalg.norm(apart - axes[0] * (axes[0] @ apart)))
        here, there = (_limits(model, joint) for joint in (one, other))
        if parallel and aside > _ALIKE and np.allclose(here, there, rtol=_ALIKE, atol=_ALIKE):
            return str(model.names[one]), str(model.names[other])
    return None


def rolling_note(pair: tuple[str, str]) -> str:
    """A line on such a pair."""
    what = f"left out: a coupling of {pair[0]} and {pair[1]}, if they roll on each other as one"
    return (
        f"{what}: their axes, ranges and torques are alike, and each has a motor of its own here; say it by mimic in a "
        "URDF, by an equality in an MJCF"
    )


def _limits(model: pin.Model, joint: int) -> Array:
    one = model.joints[joint]
    position = model.lowerPositionLimit[one.idx_q], model.upperPositionLimit[one.idx_q]
    return np.array((*position, model.upperEffortLimit[one.idx_v]))
