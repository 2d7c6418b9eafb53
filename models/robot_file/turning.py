"""Frames of a model turned where they are: x ahead and z up at zero angles, whatever axes the model gives them."""

import numpy as np
import pinocchio as pin

from surefoot.models.joints import axis_of, is_revolute
from surefoot.models.types import Array

_MOSTLY = 0.7
"""Share of a direction along an axis for it to point there [-]."""


def turn(model: pin.Model, joint: int, axes: Array) -> None:
    """Give the frame of a joint other axes; the robot stays as it is.

    Args:
        model: altered in place.
        joint: 1 is the floating base.
        axes: the new ones as columns in the old frame, shape (3, 3).
    """
    back = pin.SE3(axes.T, np.zeros(3))
    if joint > 1:
        model.jointPlacements[joint] = model.jointPlacements[joint] * back.inverse()
    if is_revolute(model, joint):
        turned, old = pin.JointModelRevoluteUnaligned(axes.T @ axis_of(model, joint)), model.joints[joint]
        turned.setIndexes(joint, old.idx_q, old.idx_v)
        model.joints[joint] = pin.JointModel(turned)
    model.inertias[joint] = back.act(model.inertias[joint])
    for child in model.children[joint]:
        model.jointPlacements[child] = back * model.jointPlacements[child]
    for frame in model.frames:
        if frame.parentJoint == joint and frame.type != pin.FrameType.JOINT:
            frame.placement = back * frame.placement


def upward(model: pin.Model, feet: tuple[int, ...]) -> Array:
    """Axes of the base with z up, as columns in its frame, shape (3, 3): the unit matrix where it is up already.

    Up is from the feet to the hips where the trunk is farther up. Otherwise, as in a model that sits, it is z.

    Args:
        model: at zero angles.
        feet: frames of both feet.
    """
    data = model.createData()
    pin.framesForwardKinematics(model, data, pin.neutral(model))
    pin.centerOfMass(model, data, pin.neutral(model))
    legs = [[j for j in model.supports[model.frames[foot].parentJoint] if j > 1] for foot in feet]
    if not all(legs):
        return np.eye(3)
    hips = sum(data.oMi[leg[0]].translation for leg in legs) / len(legs)
    soles = sum(data.oMf[foot].translation for foot in feet) / len(feet)
    masses = [data.mass[leg[0]] for leg in legs]
    below = sum(mass * data.oMi[leg[0]].act(data.com[leg[0]]) for mass, leg in zip(masses, legs, strict=True))
    trunk = (data.mass[0] * data.com[0] - below) / (data.mass[0] - sum(masses)) - hips
    along = int(np.argmax(np.abs(hips - soles)))
    up = np.eye(3)[along] * np.sign((hips - soles)[along])
    if up[2] == 1.0 or trunk @ up < _MOSTLY * float(np.linalg.norm(trunk)):
        return np.eye(3)
    ahead = np.eye(3)[0 if along else 1]
    return np.column_stack((ahead, np.cross(up, ahead), up))
