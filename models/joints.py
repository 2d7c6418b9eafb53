"""Axes of revolute joints, and the point that a group of them turns about.

A joint and what follows it are one joint here, which turns what is behind them all.
"""

from collections.abc import Sequence

import numpy as np
import pinocchio as pin

from surefoot.engines.mimic import axis_of_follower
from surefoot.models.types import Array

_AXES = {"JointModelRX": (1.0, 0.0, 0.0), "JointModelRY": (0.0, 1.0, 0.0), "JointModelRZ": (0.0, 0.0, 1.0)}
_FOLLOWS = "JointModelMimic"
_MEET = 1e-9


def is_revolute(model: pin.Model, joint: int) -> bool:
    """Return true if a joint turns about one axis, within limits."""
    return model.joints[joint].shortname() in (*_AXES, "JointModelRevoluteUnaligned")


def axis_of(model: pin.Model, joint: int) -> Array:
    """Axis of a revolute joint in its own frame, shape (3,)."""
    kind = model.joints[joint].shortname()
    if kind == _FOLLOWS:
        return axis_of_follower(model, joint)
    return np.array(_AXES[kind] if kind in _AXES else model.joints[joint].extract().axis)


def world_axis(model: pin.Model, data: pin.Data, joint: int) -> Array:
    """Axis of a revolute joint in the world, for which ``data`` has the joint placements, shape (3,)."""
    return np.asarray(data.oMi[joint].rotation @ axis_of(model, joint))


def members(model: pin.Model, joint: int) -> dict[int, float]:
    """A joint and those that follow it, with the angle of each for one of the joint, in the order of the tree."""
    pairs = zip(model.mimicking_joints, model.mimicked_joints, strict=True)
    following = sorted(int(follower) for follower, leader in pairs if leader == joint)
    return {joint: 1.0, **{one: float(model.joints[one].extract().scaling) for one in following}}


def turn_of(model: pin.Model, data: pin.Data, joint: int) -> float:
    """Turn of what is behind a joint and its followers about its axis, for an angle of the joint [-]."""
    axis = world_axis(model, data, joint)
    return sum(ratio * float(axis @ world_axis(model, data, one)) for one, ratio in members(model, joint).items())


def pivot(model: pin.Model, data: pin.Data, joint: int) -> Array:
    """A point about which a joint, with what follows it, turns what is behind them, in the world, shape (3,) [m].

    Of parallel axes at p_i that turn by k_i it is Σ k_i p_i / Σ k_i: the centre of a knee whose bones roll on each
    other is the point where they touch.
    """
    of = members(model, joint)
    if len(of) == 1:
        return np.array(data.oMi[joint].translation)
    axis, at = world_axis(model, data, joint), np.zeros(3)
    turn = turn_of(model, data, joint)
    for one, ratio in of.items():
        at += ratio * float(axis @ world_axis(model, data, one)) / turn * data.oMi[one].translation
    return at


def meeting_point(model: pin.Model, data: pin.Data, joints: Sequence[int]) -> Array:
    """The point nearest to the axes of joints, in the world, shape (3,) [m].

    Where the origin of the last joint lies on all axes, it is exactly that; where they are parallel, the point nearest
    to that origin.
    """
    last = pivot(model, data, joints[-1])
    A, b = np.zeros((3, 3)), np.zeros(3)
    for joint in joints:
        axis = world_axis(model, data, joint)
        across = np.eye(3) - np.outer(axis, axis)
        A += across
        b += across @ (pivot(model, data, joint) - last)
    if np.abs(b).max() <= _MEET:
        return np.asarray(last)
    return np.asarray(last + np.linalg.lstsq(A, b, rcond=1e-9)[0])
