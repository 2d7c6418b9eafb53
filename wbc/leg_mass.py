"""A leg reduced to a point mass at its sole: what a pendulum planner needs to know of the full model."""

from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from wbc.model import BodyFrames
from wbc.types import Array


@dataclass(frozen=True, slots=True)
class LegMass:
    """The reduced leg.

    Attributes:
        ratio: μ, point mass at each sole over the total mass [-].
        lever: how much further ahead the point mass seems when the sole moves up or down, because the knee then moves
            forward or back [m].
    """

    ratio: float
    lever: float


def leg_mass(model: pin.Model, frames: BodyFrames, q: Array, leg_joints: NDArray[np.bool_]) -> LegMass:
    """Reduce the legs by the angular momentum about the CoM that a stepping sole brings with it.

    One sole moves at 1 m/s forward, then upward, without turning, while the pelvis rests. Point masses μ m at both
    soles r_k have the pitching momentum L = Σ μ m [(r_k - c)_z (r_k' - c')_x - (r_k - c)_x (r_k' - c')_z]: solved for μ
    in the forward motion, and for the lever ahead of the sole in the upward one. Mean of both legs. In the upward
    motion c' is left out, so that the lever makes up for four fifths of the knee's momentum only.

    Args:
        model: the robot.
        frames: its soles.
        q: standing configuration, shape (nq,), soles level and side by side.
        leg_joints: which joints are leg joints, bool, shape (nj,).
    """
    joints = 6 + np.flatnonzero(leg_joints)
    legs = []
    for name in frames.soles:
        forward_pitch, forward, height, _ = _step_momentum(model, name, q, joints, upward=False)
        ratio = -forward_pitch / (height * (1.0 - 2.0 * forward))
        upward_pitch, _, _, ahead = _step_momentum(model, name, q, joints, upward=True)
        legs.append((ratio, -upward_pitch / ratio - ahead))
    mean = np.mean(legs, axis=0)
    return LegMass(float(mean[0]), float(mean[1]))


def _step_momentum(
    model: pin.Model, sole: str, q: Array, joints: NDArray[np.intp], *, upward: bool
) -> tuple[float, float, float, float]:
    """Pitching momentum over mass [m^2/s] and CoM speed for one sole at 1 m/s; CoM over sole, sole ahead of CoM [m]."""
    data = model.createData()
    pin.computeJointJacobians(model, data, q)
    pin.updateFramePlacements(model, data)
    heading = data.oMi[1].rotation[:, 0]
    frame = model.getFrameId(sole)
    J = pin.getFrameJacobian(model, data, frame, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED)[:, joints]
    direction = np.array([0.0, 0.0, 1.0]) if upward else heading
    v = np.zeros(model.nv)
    v[joints] = np.linalg.lstsq(J, np.concatenate([direction, np.zeros(3)]), rcond=None)[0]
    momentum = pin.computeCentroidalMomentum(model, data, q, v)
    mass = pin.computeTotalMass(model)
    offset = data.oMf[frame].translation - data.com[0]
    pitch = momentum.angular @ np.cross([0.0, 0.0, 1.0], heading) / mass
    return float(pitch), float(momentum.linear @ heading / mass), float(-offset[2]), float(offset @ heading)
