"""The mass of a leg, reduced to its sole: what one number of the full model a pendulum planner needs."""

import numpy as np
import pinocchio as pin

from wbc.model import BodyFrames
from wbc.types import Array


def leg_mass_ratio(model: pin.Model, frames: BodyFrames, q: Array, leg_joints: Array) -> float:
    """Point mass at each sole, over the total mass, that gives a stepping leg's angular momentum about the CoM.

    One sole moves forward at 1 m/s without turning while the pelvis rests. A point mass μ m at either sole gives the
    pitching momentum L = -μ m h (1 - 2 c'_x) with h the CoM's height over the soles; solved for μ, mean of both legs.

    Args:
        model: the robot.
        frames: its soles.
        q: standing configuration, shape (nq,).
        leg_joints: which joints are leg joints, bool, shape (nj,).
    """
    data = model.createData()
    pin.computeJointJacobians(model, data, q)
    pin.updateFramePlacements(model, data)
    joints = 6 + np.flatnonzero(leg_joints)
    heading = data.oMi[1].rotation[:, 0]
    ratios = []
    for name in frames.soles:
        frame = model.getFrameId(name)
        J = pin.getFrameJacobian(model, data, frame, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED)[:, joints]
        v = np.zeros(model.nv)
        v[joints] = np.linalg.lstsq(J, np.concatenate([heading, np.zeros(3)]), rcond=None)[0]
        momentum = pin.computeCentroidalMomentum(model, data, q, v)
        mass = pin.computeTotalMass(model)
        height = data.com[0][2] - data.oMf[frame].translation[2]
        pitching = momentum.angular @ np.cross([0.0, 0.0, 1.0], heading)
        forward = momentum.linear @ heading / mass
        ratios.append(-pitching / (mass * height * (1.0 - 2.0 * forward)))
    return float(np.mean(ratios))
