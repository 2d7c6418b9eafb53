"""The robot reduced to what the planner needs of it: legs of three links under a trunk that does not turn."""

from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from surefoot.planner.model.leg_chain import LegChain, Link, Vector
from surefoot.planner.parameters import LegInertia
from surefoot.wbc.model import BodyFrames

Array = NDArray[np.float64]


def leg_inertia(model: pin.Model, frames: BodyFrames, q: Array, leg_joints: NDArray[np.bool_]) -> LegInertia:
    """The legs' inertia, from a standing configuration; both legs alike.

    The knee is the leg joint that is farthest from its neighbours in the chain; what is above it in the leg belongs to
    the thigh, what is below the next joint to the foot. Lateral offsets within a leg are left out.

    Args:
        model: the robot.
        frames: its soles, left and right.
        q: standing configuration, shape (nq,), soles level and side by side.
        leg_joints: which joints are leg joints, bool, shape (nj,).
    """
    data = model.createData()
    pin.computeJointJacobians(model, data, q)
    pin.updateFramePlacements(model, data)
    com = pin.centerOfMass(model, data, q)
    heading = data.oMi[1].rotation[:, 0]
    R = np.column_stack((heading, np.cross([0.0, 0.0, 1.0], heading), (0.0, 0.0, 1.0)))
    total, joints = pin.computeTotalMass(model), 6 + np.flatnonzero(leg_joints)
    left, right = (_leg(model, data, name, leg_joints) for name in frames.soles)
    legs = left.thigh.mass + left.shank.mass + left.foot.mass
    below = sum(part.mass * part.lever for leg in (left, right) for part in (leg.thigh, leg.shank, leg.foot))
    trunk = (total * com - below) / (total - 2.0 * legs)
    middle = 0.5 * (left.hip + right.hip)
    chain = LegChain(
        hip_half_width=0.5 * float(np.linalg.norm(left.hip - right.hip)),
        trunk=_mirrored((trunk - middle) @ R),
        thigh=_link(left.thigh, left.hip, left.knee, R[:, 1], total),
        shank=_link(left.shank, left.knee, left.ankle, R[:, 1], total),
        foot_mass=left.foot.mass / total,
        foot_centre=_mirrored((left.foot.lever - left.ankle) @ R),
        ankle=_mirrored((left.ankle - left.sole) @ R),
    )
    return LegInertia(float(np.mean([_point_mass(model, name, q, joints) for name in frames.soles])), chain)


@dataclass(frozen=True, slots=True)
class _Leg:
    """Joints and link inertias of a leg in the world frame."""

    hip: Array
    knee: Array
    ankle: Array
    sole: Array
    thigh: pin.Inertia
    shank: pin.Inertia
    foot: pin.Inertia


def _leg(model: pin.Model, data: pin.Data, sole: str, leg_joints: NDArray[np.bool_]) -> _Leg:
    frame = model.getFrameId(sole)
    chain = [j for j in model.supports[model.frames[frame].parentJoint] if j > 1 and leg_joints[j - 2]]
    at = [data.oMi[j].translation.copy() for j in chain]
    apart = np.linalg.norm(np.diff(at, axis=0), axis=1)
    knee = 1 + int(np.argmax(apart[1:] * apart[:-1]))
    parts = [_lumped(model, data, joints) for joints in (chain[:knee], chain[knee : knee + 1], chain[knee + 1 :])]
    return _Leg(at[knee - 1], at[knee], at[knee + 1], data.oMf[frame].translation.copy(), *parts)


def _lumped(model: pin.Model, data: pin.Data, joints: list[int]) -> pin.Inertia:
    total = pin.Inertia.Zero()
    for joint in joints:
        total += data.oMi[joint].act(model.inertias[joint])
    return total


def _link(part: pin.Inertia, upper: Array, lower: Array, pitch: Array, total: float) -> Link:
    along, length = lower - upper, float(np.linalg.norm(lower - upper))
    centre = float((part.lever - upper) @ along) / length**2
    return Link(length, part.mass / total, centre, float(pitch @ part.inertia @ pitch) / total)


def _mirrored(vector: Array) -> Vector:
    """A vector of both legs' mean: nothing to the left."""
    return float(vector[0]), 0.0, float(vector[2])


def _point_mass(model: pin.Model, sole: str, q: Array, joints: NDArray[np.intp]) -> float:
    """μ whose momentum L = Σ μ m (r_k - c)_z (r_k' - c')_x is that of one sole at 1 m/s forward [-]."""
    data = model.createData()
    pin.computeJointJacobians(model, data, q)
    pin.updateFramePlacements(model, data)
    heading, frame = data.oMi[1].rotation[:, 0], model.getFrameId(sole)
    J = pin.getFrameJacobian(model, data, frame, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED)[:, joints]
    v = np.zeros(model.nv)
    v[joints] = np.linalg.lstsq(J, np.concatenate([heading, np.zeros(3)]), rcond=None)[0]
    momentum = pin.computeCentroidalMomentum(model, data, q, v)
    mass = pin.computeTotalMass(model)
    pitch = momentum.angular @ np.cross([0.0, 0.0, 1.0], heading) / mass
    height = float(data.com[0][2] - data.oMf[frame].translation[2])
    return float(-pitch / (height * (1.0 - 2.0 * (momentum.linear @ heading) / mass)))
