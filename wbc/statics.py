"""Torques that hold a standing posture."""

import numpy as np
import pinocchio as pin

from surefoot.wbc.model import BodyFrames
from surefoot.wbc.types import Array

LEVER = 0.1
"""At which the reference robot's sole moments count as forces [m]."""


def standing_torque(
    model: pin.Model, frames: BodyFrames, q: Array, lever: float = LEVER, foot: int | None = None
) -> Array:
    """Joint torques, shape (nj,) [N·m], of static equilibrium at configuration q, shape (nq,).

    The base rows of g(q) = S τ + Σ J_kᵀ w_k leave the two sole wrenches w_k free in six directions; the smallest ones
    are taken.

    Args:
        model: the robot.
        frames: its soles.
        q: configuration.
        lever: at which moments count as forces [m].
        foot: the one that bears all, 0 the left one; None for both.
    """
    data = model.createData()
    gravity = pin.computeGeneralizedGravity(model, data, q)
    pin.computeJointJacobians(model, data, q)
    pin.updateFramePlacements(model, data)
    jacobians = [
        pin.getFrameJacobian(model, data, model.getFrameId(name), pin.ReferenceFrame.LOCAL)
        for name in (frames.soles if foot is None else (frames.soles[foot],))
    ]
    transposed = np.vstack(jacobians).T
    scale = np.tile([1.0, 1.0, 1.0, lever, lever, lever], len(jacobians))
    wrenches = scale * np.linalg.lstsq(transposed[:6] * scale, gravity[:6], rcond=None)[0]
    torque: Array = gravity[6:] - transposed[6:] @ wrenches
    return torque
