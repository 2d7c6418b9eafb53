"""Axes of revolute joints, and the point that a group of them turns about."""

from collections.abc import Sequence

import numpy as np
import pinocchio as pin

from surefoot.models.types import Array

_AXES = {"JointModelRX": (1.0, 0.0, 0.0), "JointModelRY": (0.0, 1.0, 0.0), "JointModelRZ": (0.0, 0.0, 1.0)}
_MEET = 1e-9


def is_revolute(model: pin.Model, joint: int) -> bool:
    """Whether a joint turns about one axis, within limits."""
    return model.joints[joint].shortname() in (*_AXES, "JointModelRevoluteUnaligned")


def axis_of(model: pin.Model, joint: int) -> Array:
    """Axis of a revolute joint in its own frame, shape (3,)."""
    kind = model.joints[joint].shortname()
    return np.array(_AXES[kind] if kind in _AXES else model.joints[joint].extract().axis)


def world_axis(model: pin.Model, data: pin.Data, joint: int) -> Array:
    """Axis of a revolute joint in the world, for which ``data`` has the joint placements, shape (3,)."""
    return np.asarray(data.oMi[joint].rotation @ axis_of(model, joint))


def meeting_point(model: pin.Model, data: pin.Data, joints: Sequence[int]) -> Array:
    """The point nearest to the axes of joints, in the world, shape (3,) [m].

    Where the origin of the last joint lies on all axes, it is exactly that; where they are parallel, the point nearest
    to that origin.
    """
    last = data.oMi[joints[-1]].translation.copy()
    A, b = np.zeros((3, 3)), np.zeros(3)
    for joint in joints:
        axis = world_axis(model, data, joint)
        across = np.eye(3) - np.outer(axis, axis)
        A += across
        b += across @ (data.oMi[joint].translation - last)
    if np.abs(b).max() <= _MEET:
        return np.asarray(last)
    return np.asarray(last + np.linalg.lstsq(A, b, rcond=1e-9)[0])
