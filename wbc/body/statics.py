"""Torques that hold a posture, on both feet or on one."""

import numpy as np
import pinocchio as pin

from surefoot.wbc.body.leaning import FREE, line_frame
from surefoot.wbc.body.model import BodyFrames
from surefoot.wbc.types import Array

LEVER = 0.1
"""Lever at which the reference robot's sole moments count as forces [m]."""


def standing_torque(
    model: pin.Model,
    frames: BodyFrames,
    q: Array,
    lever: float = LEVER,
    foot: int | None = None,
    data: pin.Data | None = None,
) -> Array:
    """Joint torques, shape (nj,) [N·m], of static equilibrium at configuration q, shape (nq,).

    A leaning sole (see `surefoot.wbc.body.leaning`) has no moment about its line.

    The base rows of g(q) = S τ + Σ J_kᵀ w_k leave the two sole wrenches w_k free in six directions; the smallest ones
    are taken.

    Args:
        model: the robot.
        frames: its soles.
        q: configuration.
        lever: at which moments count as forces [m].
        foot: the one that bears all, 0 the left one; None for both.
        data: memory to work in; None makes some.
    """
    data = data or model.createData()
    gravity = pin.computeGeneralizedGravity(model, data, q)
    pin.computeJointJacobians(model, data, q)
    pin.updateFramePlacements(model, data)
    jacobians = []
    for k in (0, 1) if foot is None else (foot,):
        frame = model.getFrameId(frames.soles[k])
        J = pin.getFrameJacobian(model, data, frame, pin.ReferenceFrame.LOCAL)
        if frames.leaning is not None:
            J = line_frame(k, data.oMf[frame].rotation, frames.leaning).toActionMatrixInverse() @ J
        jacobians.append(J)
    transposed = np.vstack(jacobians).T
    scale = np.tile([1.0, 1.0, 1.0, lever, lever, lever], len(jacobians))
    if frames.leaning is not None:
        scale[FREE::6] = 0.0
    wrenches = scale * np.linalg.lstsq(transposed[:6] * scale, gravity[:6], rcond=None)[0]
    torque: Array = gravity[6:] - transposed[6:] @ wrenches
    return torque


def bearing_torque(model: pin.Model, frames: BodyFrames, q: Array, foot: int) -> Array:
    """Joint torques, shape (nj,) [N·m], at a configuration q, shape (nq,), whose weight one foot bears alone.

    The CoM need not be over that foot. As on a linear inverted pendulum, all of the robot is accelerated alike,
    horizontally, so that the force f from the sole's centre goes through the CoM: τ = M a + g(q) - Jᵀ f.

    Args:
        model: the robot.
        frames: its soles.
        q: configuration.
        foot: that bears all, 0 the left one.
    """
    data, frame = model.createData(), model.getFrameId(frames.soles[foot])
    pin.computeJointJacobians(model, data, q)
    pin.updateFramePlacements(model, data)
    com, gravity = pin.centerOfMass(model, data, q), -float(model.gravity.linear[2])
    lever = com - data.oMf[frame].translation
    acceleration = np.zeros(model.nv)
    along = gravity / lever[2] * lever  # with gravity's own acceleration
    acceleration[:3] = data.oMi[1].rotation.T @ (along - (0.0, 0.0, gravity))
    J = pin.getFrameJacobian(model, data, frame, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED)[:3]
    force = pin.computeTotalMass(model) * along
    torque: Array = (pin.rnea(model, data, q, np.zeros(model.nv), acceleration) - J.T @ force)[6:]
    return torque
