"""What the whole-body controller is asked to do at each control tick, out of the plan."""

import numpy as np
from numpy.typing import NDArray

from surefoot import algebra
from surefoot.planner import orientation
from surefoot.planner.plan import PlanSample, WalkPlan, in_point
from surefoot.planner.sampling import PlanSampler
from surefoot.planner.types import PhaseKind
from surefoot.wbc.types import WbcReference, in_numbers

Array = NDArray[np.float64]

_SAME = {
    **{name: name for name in ("com", "com_velocity", "com_acceleration", "omega", "stiffness")},
    "zmp": "pendulum_zmp",
    "swing_position": "swing",
    "swing_velocity": "swing_velocity",
    "swing_acceleration": "swing_acceleration",
}
"""Fields of a reference that are quantities of a sample, or their first numbers."""


def _places() -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Where these numbers are in a reference, and in a sample."""
    into: list[int] = []
    out_of: list[int] = []
    for field, quantity in _SAME.items():
        here, there = in_numbers(field), in_point(quantity)
        into += range(here.start, here.stop)
        out_of += range(there.start, there.start + here.stop - here.start)
    return np.array(into), np.array(out_of)


INTO, OUT_OF = _places()
ZMP, PENDULUM_ZMP, LOAD = (in_point(name).start for name in ("zmp", "pendulum_zmp", "load_left"))
SWING, RATE, BEND = (in_point(name).start + 3 for name in ("swing", "swing_velocity", "swing_acceleration"))
OFFSET, SPIN, SPIN_RATE, ROTATION, NORMAL, HEADING, SHARE, ROLL = (
    in_numbers(name).start
    for name in (
        "zmp_offset", "swing_angular_velocity", "swing_angular_acceleration", "swing_rotation", "ground_normal",
        "heading", "load_share", "roll",
    )
)  # fmt: skip
SIZE = ROLL + 6
"""Numbers of a reference; the last three tell which foot swings, which one rolls, and whether it is to catch itself."""


def planned(sampler: PlanSampler, time: float, middle: float) -> tuple[PlanSample, WbcReference]:
    """The references of a plan at an instant, and what is to be done from there on over a time of that middle [s]."""
    sample, until = sampler.tick(time, middle)
    return sample, whole_body_reference(sampler.plan, until)


def whole_body_reference(plan: WalkPlan, sample: PlanSample) -> WbcReference:
    """What the whole-body controller shall do at the sample's instant of the plan, or over a tick that it stands for.

    The heading of pelvis and torso is the mean of both feet's yaws, so that it turns smoothly with the swing foot.
    """
    phase, footholds, passed, numbers = plan.phase, plan.footholds, sample.time - plan.time, np.zeros(SIZE)
    told = numbers
    _fill(told, numbers[ROTATION : ROTATION + 9].reshape(3, 3), sample.point)
    left, right = footholds[0].yaw, footholds[1].yaw
    swings, progress, lifting, rolling = -1, 0.0, -1, -1
    _stand(told, 0, footholds[0].normal)
    _stand(told, 1, footholds[1].normal)
    if sample.swing_foot is not None:
        swings, progress = int(sample.swing_foot), min(1.0, (phase.elapsed + passed) / phase.duration)
        _stand(told, swings, plan.footsteps[0].normal)
        yaw = sample.point.item(SWING)
        left, right = (yaw, right) if swings == 0 else (left, yaw)
    elif phase.kind is PhaseKind.DOUBLE and phase.leads_to > 0:
        lifting = int(plan.footsteps[0].foot)
    if plan.roll is not None and plan.roll.rolling(sample.time):
        rolling = int(plan.roll.foot)
        told[ROLL], told[ROLL + 1], told[ROLL + 2] = plan.roll.evaluate(sample.time)
    catching = plan.balance.catching
    told[HEADING] = 0.5 * (left + right)
    told[ROLL + 3], told[ROLL + 4], told[ROLL + 5] = swings, rolling, catching
    switch = max(0.0, phase.left - passed)
    return WbcReference.of_numbers(numbers, sample.contacts, switch, lifting, swings, progress, rolling, catching)


def _stand(numbers: Array, foot: int, normal: Array) -> None:
    """The ground under a foot."""
    for axis in range(3):
        numbers[NORMAL + 3 * foot + axis] = normal[axis]


def _fill(numbers: Array, R: Array, point: Array) -> None:
    """What follows from the numbers of a sample alone; R is the swing sole's rotation among those of the reference."""
    for k in range(INTO.shape[0]):
        numbers[INTO[k]] = point[OUT_OF[k]]
    for axis in range(2):
        numbers[OFFSET + axis] = point[ZMP + axis] - point[PENDULUM_ZMP + axis]
    angles, rates = algebra.vector(point[SWING : SWING + 3]), algebra.vector(point[RATE : RATE + 3])
    bends = algebra.vector(point[BEND : BEND + 3])
    algebra.put(numbers[SPIN : SPIN + 3], orientation.sole_spin(angles, rates))
    algebra.put(numbers[SPIN_RATE : SPIN_RATE + 3], orientation.sole_spin_rate(angles, rates, bends))
    orientation.turn_sole(angles, R)
    numbers[HEADING + 1] = 0.5 * rates[0]
    numbers[SHARE], numbers[SHARE + 1] = point[LOAD], 1.0 - point[LOAD]
