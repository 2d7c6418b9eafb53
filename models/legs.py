"""Lengths and masses of a robot's legs: a trunk on two legs of thigh, shank and foot, from the whole body."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from surefoot.models.joints import meeting_point, pivot, world_axis

Array = NDArray[np.float64]
Vector = tuple[float, float, float]

_ON_THE_LINE = 1e-9
"""A link's CoM that is nearer to the line between its joints, in lengths of the link, lies on it [-]."""

_FORWARD = 0.7
"""Share of its axis that points forward of a joint that rolls [-]."""

_IN_PLANE = 1e-6
"""An axis of roll that is nearer to the plane of the leg and to its hip goes through it [m]."""


class LinkMasses(NamedTuple):
    """A link between two joints of a leg; its numbers are those of `surefoot.planner.model.leg_chain.Link`."""

    length: float
    mass: float
    centre: float
    inertia: float
    ahead: float
    outward: float


class LegMasses(NamedTuple):
    """Both legs, alike; the numbers are those of `surefoot.planner.model.leg_chain.LegChain`."""

    hip_half_width: float
    trunk: Vector
    thigh: LinkMasses
    shank: LinkMasses
    foot_mass: float
    foot_centre: Vector
    ankle: Vector
    foot_outward: float
    rolls_first: bool
    hip_lever: tuple[float, float]


def leg_masses(model: pin.Model, soles: tuple[str, str], q: Array, leg_joints: NDArray[np.bool_]) -> LegMasses:
    """The legs' lengths and masses, from a standing configuration.

    The knee is the leg joint that is farthest from its neighbours in the chain. The part above it in the leg belongs to
    the thigh, the part below the next joint to the foot. Hip and ankle are where the axes there come nearest to each
    other. The joints count as in one plane, CoMs may lie beside it. Where the hip rolls before it pitches, about an
    axis that is not in that plane, the links above its pitch joint belong to the trunk.

    Args:
        model: the robot.
        soles: frames of its left and right sole.
        q: standing configuration, shape (nq,), soles level and side by side.
        leg_joints: which joints are leg joints, bool, shape (nj,).
    """
    data = model.createData()
    pin.computeJointJacobians(model, data, q)
    pin.updateFramePlacements(model, data)
    com = pin.centerOfMass(model, data, q)
    heading = data.oMi[1].rotation[:, 0]
    R = np.column_stack((heading, np.cross([0.0, 0.0, 1.0], heading), (0.0, 0.0, 1.0)))
    total = pin.computeTotalMass(model)
    left, right = (_leg(model, data, name, leg_joints, R) for name in soles)
    legs = left.thigh.mass + left.shank.mass + left.foot.mass
    below = sum(part.mass * part.lever for leg in (left, right) for part in (leg.thigh, leg.shank, leg.foot))
    trunk = (total * com - below) / (total - 2.0 * legs)
    plane, middle = left.plane, 0.5 * (left.plane.rolling + right.plane.rolling)
    lever = plane.axes.T @ (plane.hip - plane.rolling)
    return LegMasses(
        hip_half_width=0.5 * float(np.linalg.norm(plane.rolling - right.plane.rolling)),
        trunk=_mirrored((trunk - middle) @ R),
        thigh=_link(left.thigh, plane.hip, plane.knee, plane.axes, total),
        shank=_link(left.shank, plane.knee, left.ankle, plane.axes, total),
        foot_mass=left.foot.mass / total,
        foot_centre=_mirrored((left.foot.lever - left.ankle) @ R),
        ankle=_mirrored((left.ankle - left.sole) @ R),
        foot_outward=_measured((left.foot.lever - left.ankle) @ R[:, 1]),
        rolls_first=left.rolls_first,
        hip_lever=(float(lever[1]), float(lever[2])),
    )


def point_mass(model: pin.Model, soles: tuple[str, str], q: Array, leg_joints: NDArray[np.bool_]) -> float:
    """Mass over the total mass of one leg reduced to a point mass at its sole [-].

    Args:
        model: the robot.
        soles: frames of its left and right sole.
        q: standing configuration, shape (nq,), soles level and side by side.
        leg_joints: which joints are leg joints, bool, shape (nj,).
    """
    joints = 6 + np.flatnonzero(leg_joints)
    return float(np.mean([_point_mass(model, name, q, joints) for name in soles]))


@dataclass(frozen=True, slots=True)
class _Plane:
    """The plane in which hip, knee and ankle of a leg count, in the world frame.

    Attributes:
        axes: forward, left and up, its columns, shape (3, 3).
        hip, knee: in it.
        rolling: the point of the axis about which it rolls that is nearest to the hip, but for what is ahead.
        first: number of the hip's first joint below which the leg begins.
    """

    axes: Array
    hip: Array
    knee: Array
    rolling: Array
    first: int


@dataclass(frozen=True, slots=True)
class _Leg:
    """A leg in the world frame, its joints and links, and whether its ankle rolls first."""

    plane: _Plane
    ankle: Array
    sole: Array
    thigh: pin.Inertia
    shank: pin.Inertia
    foot: pin.Inertia
    rolls_first: bool


def _leg(model: pin.Model, data: pin.Data, sole: str, leg_joints: NDArray[np.bool_], R: Array) -> _Leg:
    """A leg of a body whose axes are the columns of R."""
    frame = model.getFrameId(sole)
    whole = [j for j in model.supports[model.frames[frame].parentJoint] if j > 1 and leg_joints[model.idx_vs[j] - 6]]
    chain = [j for j in whole if model.nvs[j]]
    at = [pivot(model, data, j) for j in chain]
    apart = np.linalg.norm(np.diff(at, axis=0), axis=1)
    knee = 1 + int(np.argmax(apart[1:] * apart[:-1]))
    groups = chain[:knee], chain[knee : knee + 1], chain[knee + 1 :]
    hip, ankle = (_pivot(model, data, group) for group in (groups[0], groups[2]))
    plane = _beside_roll(model, data, groups[0], at[knee], ankle, R) or _Plane(R, hip, at[knee], hip, 0)
    first, knees, ankles = (whole.index(chain[place]) for place in (plane.first, knee, knee + 1))
    bodies = whole[first:knees], whole[knees:ankles], whole[ankles:]
    thigh, shank, foot = (_lumped(model, data, group) for group in bodies)
    below, rolls_first = data.oMf[frame].translation.copy(), _pitching(model, data, groups[2]) != groups[2][0]
    return _Leg(plane, ankle, below, thigh, shank, foot, rolls_first)


def _beside_roll(
    model: pin.Model, data: pin.Data, hips: list[int], knee: Array, ankle: Array, R: Array
) -> _Plane | None:
    """The plane through the ankle of a leg that rolls before it pitches; None where the axis of roll is in it."""
    pitching = _pitching(model, data, hips)
    left = world_axis(model, data, pitching)
    left = left * np.sign(left @ R[:, 1])
    forward = R[:, 0] - left * float(left @ R[:, 0])
    forward /= np.linalg.norm(forward)
    axes = np.column_stack((forward, left, np.cross(forward, left)))
    # An axis of pitch goes through it at a point as far aside as the ankle.
    hip, knee = (point + left * float(left @ (ankle - point)) for point in (pivot(model, data, pitching), knee))
    first = hips.index(pitching)
    for joint in hips[:first]:
        lever = axes.T @ (hip - data.oMi[joint].translation) * (0.0, 1.0, 1.0)
        rolls = abs(float(world_axis(model, data, joint) @ R[:, 0])) > _FORWARD
        if rolls and np.linalg.norm(lever) > _IN_PLANE:
            return _Plane(axes, hip, knee, hip - axes @ lever, first)
    return None


def _pitching(model: pin.Model, data: pin.Data, joints: list[int]) -> int:
    """The joint of a hip or an ankle whose axis is nearest to the lateral one."""
    lateral = data.oMi[1].rotation[:, 1]
    return max(joints, key=lambda joint: abs(float(world_axis(model, data, joint) @ lateral)))


def _pivot(model: pin.Model, data: pin.Data, joints: list[int]) -> Array:
    """The point of a hip or an ankle on its pitch axis, nearest to all its axes: what a link swings about."""
    meeting = meeting_point(model, data, joints)
    pitch = _pitching(model, data, joints)
    axis, origin = world_axis(model, data, pitch), pivot(model, data, pitch)
    return np.asarray(origin + axis * float(axis @ (meeting - origin)))


def _lumped(model: pin.Model, data: pin.Data, joints: list[int]) -> pin.Inertia:
    total = pin.Inertia.Zero()
    for joint in joints:
        total += data.oMi[joint].act(model.inertias[joint])
    return total


def _link(part: pin.Inertia, upper: Array, lower: Array, R: Array, total: float) -> LinkMasses:
    """A link between two joints, seen from the side of a body whose axes are the columns of R."""
    line, pitch = lower - upper, R[:, 1]
    along = line - (line @ pitch) * pitch
    length = float(np.linalg.norm(along))
    lever = part.lever - upper
    centre, ahead = float(lever @ along) / length**2, float(lever @ np.cross(along, pitch)) / length**2
    inertia = float(pitch @ part.inertia @ pitch) / total
    outward = _measured((lever - centre * line) @ pitch)
    return LinkMasses(length, part.mass / total, centre, inertia, ahead if abs(ahead) > _ON_THE_LINE else 0.0, outward)


def _measured(distance: float) -> float:
    """A distance without the rounding of where it was measured [m]."""
    return round(float(distance), 9)


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
