"""The reference of the whole-body controller at each control tick, out of the plan."""

import numpy as np
from numpy.typing import NDArray

from surefoot.maths import algebra
from surefoot.planner.geometry import orientation
from surefoot.planner.plan.plan import WalkPlan
from surefoot.planner.plan.sample import PlanSample, in_point
from surefoot.planner.plan.sampling import PlanSampler
from surefoot.planner.swing.rolling import FootRoll
from surefoot.planner.types import PhaseKind
from surefoot.wbc.reference import LEVEL, WbcReference

Array = NDArray[np.float64]

OMEGA, STIFFNESS, LOAD, ZMP, PENDULUM_ZMP, COM, VELOCITY, ACCELERATION, SWING, SWING_VELOCITY, SWING_ACCELERATION = (
    in_point(name).start
    for name in (
        "omega", "stiffness", "load_left", "zmp", "pendulum_zmp", "com", "com_velocity", "com_acceleration", "swing",
        "swing_velocity", "swing_acceleration",
    )
)  # fmt: skip
"""Places of quantities in the numbers of a sample."""


def planned(sampler: PlanSampler, time: float, middle: float) -> tuple[PlanSample, WbcReference]:
    """The references of a plan at an instant, and what is to be done from there on over a time of that middle [s]."""
    sample, until = sampler.tick(time, middle)
    return sample, whole_body_reference(sampler.plan, until)


def whole_body_reference(plan: WalkPlan, sample: PlanSample) -> WbcReference:
    """Reference of the whole-body controller at the sample's instant, or over a tick that it stands for.

    The heading of pelvis and torso is the mean of both feet's yaws, so that it turns smoothly with the swing foot.
    """
    phase, passed = plan.phase, sample.time - plan.time
    reference = WbcReference.__new__(WbcReference)
    _fill(reference, sample.point)
    reference.planned_contact, reference.time_to_switch = sample.contacts, max(0.0, phase.left - passed)
    reference.swing_foot, reference.swing_progress, reference.lifting_foot = -1, 0.0, -1
    if sample.swing_foot is not None:
        reference.swing_foot = int(sample.swing_foot)
        reference.swing_progress = min(1.0, (phase.elapsed + passed) / phase.duration)
    elif phase.kind is PhaseKind.DOUBLE and phase.leads_to > 0:
        reference.lifting_foot = int(plan.footsteps[0].foot)
    _ground(reference, plan, sample.point.item(SWING + 3))
    _roll(reference, plan.rolls, sample.time)
    reference.catching = plan.balance.catching
    reference.pelvis_yaw, reference.pelvis_list = LEVEL, LEVEL
    if plan.pelvis is not None:
        reference.pelvis_yaw = plan.pelvis.yaw.evaluate(sample.time)
        reference.pelvis_list = plan.pelvis.roll.evaluate(sample.time)
    return reference


def _roll(reference: WbcReference, rolls: tuple[FootRoll, ...], time: float) -> None:
    """The edges on which feet roll at a time [s]."""
    reference.edge, reference.roll = (0, 0), (LEVEL, LEVEL)
    for roll in rolls:
        if roll.rolling(time):
            edge, pitch = int(roll.edge), roll.evaluate(time)
            if roll.foot:
                reference.edge, reference.roll = (reference.edge[0], edge), (reference.roll[0], pitch)
            else:
                reference.edge, reference.roll = (edge, reference.edge[1]), (pitch, reference.roll[1])


def _ground(reference: WbcReference, plan: WalkPlan, yaw: float) -> None:
    """The ground under the feet and their mean yaw, of which the swing foot has that [rad]."""
    swings, footholds = reference.swing_foot, plan.footholds
    left = plan.footsteps[0] if swings == 0 else footholds[0]
    right = plan.footsteps[0] if swings == 1 else footholds[1]
    reference._n = _tuple(left.normal), _tuple(right.normal)
    yaw_left = yaw if swings == 0 else left.yaw
    yaw_right = yaw if swings == 1 else right.yaw
    reference.heading = 0.5 * (yaw_left + yaw_right)


def _tuple(vector: Array) -> algebra.Vector:
    """A vector out of the plan, of any kind of memory."""
    x, y, z = vector.tolist()
    return x, y, z


def _fill(reference: WbcReference, point: Array) -> None:
    """Fill in what follows from the numbers of a sample alone."""
    reference.omega, reference.stiffness = point[OMEGA], point[STIFFNESS]
    reference.load_share = point[LOAD], 1.0 - point[LOAD]
    reference._c, reference._c_dot = _part(point, COM), _part(point, VELOCITY)
    reference._c_ddot = _part(point, ACCELERATION)
    reference._p = point[PENDULUM_ZMP], point[PENDULUM_ZMP + 1]
    reference._o = point[ZMP] - point[PENDULUM_ZMP], point[ZMP + 1] - point[PENDULUM_ZMP + 1]
    reference._s, reference._s_dot = _part(point, SWING), _part(point, SWING_VELOCITY)
    reference._s_ddot = _part(point, SWING_ACCELERATION)
    angles, rates = _part(point, SWING + 3), _part(point, SWING_VELOCITY + 3)
    reference._R = orientation.rows(angles)
    reference._w = orientation.sole_spin(angles, rates)
    reference._w_dot = orientation.sole_spin_rate(angles, rates, _part(point, SWING_ACCELERATION + 3))
    reference.heading_rate = 0.5 * rates[0]


def _part(point: Array, first: int) -> algebra.Vector:
    """Three numbers from there on."""
    return point[first], point[first + 1], point[first + 2]
