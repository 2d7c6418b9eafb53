"""What the whole-body controller is asked to do at each control tick, out of the plan."""

import math
from collections.abc import Callable

import numpy as np

from surefoot.native.library import Library, library
from surefoot.planner.geometry import sole_rates, sole_rotation
from surefoot.planner.plan import PlanSample, WalkPlan
from surefoot.planner.plan_kernel import POINT
from surefoot.planner.types import PhaseKind
from surefoot.wbc.types import WbcReference

NO_ROLL = (0.0, 0.0, 0.0)


def whole_body_reference(plan: WalkPlan, sample: PlanSample) -> WbcReference:
    """What the whole-body controller shall do at the sample's instant of the plan, or over a tick that it stands for.

    The heading of pelvis and torso is the mean of both feet's yaws, so that it turns smoothly with the swing foot.
    """
    phase = plan.phase
    lifts = phase.kind is PhaseKind.DOUBLE and phase.leads_to > 0
    passed = phase.elapsed + sample.time - plan.time
    swing, rate, bend = sample.swing, sample.swing_velocity, sample.swing_acceleration
    roll = plan.roll
    foot = -1 if sample.swing_foot is None else int(sample.swing_foot)
    yaw = [plan.footholds[0].yaw, plan.footholds[1].yaw]
    normal = np.array([plan.footholds[0].normal, plan.footholds[1].normal])
    if foot >= 0:
        yaw[foot] = float(swing[3])
        normal[foot] = plan.footsteps[0].normal
    turning, bending = sole_rates(swing[3:], rate[3:], bend[3:])
    return WbcReference(
        com=sample.com,
        com_velocity=sample.com_velocity,
        com_acceleration=sample.com_acceleration,
        zmp=sample.pendulum_zmp,
        zmp_offset=sample.zmp - sample.pendulum_zmp,
        omega=sample.omega,
        stiffness=sample.stiffness,
        heading=0.5 * (yaw[0] + yaw[1]),
        heading_rate=0.5 * float(rate[3]),
        planned_contact=sample.contacts,
        load_share=(sample.load_left, 1.0 - sample.load_left),
        time_to_switch=max(0.0, phase.left - (sample.time - plan.time)),
        lifting_foot=int(plan.footsteps[0].foot) if lifts else -1,
        swing_foot=foot,
        swing_progress=min(1.0, passed / phase.duration) if foot >= 0 and math.isfinite(phase.duration) else 0.0,
        swing_position=swing[:3],
        swing_velocity=rate[:3],
        swing_acceleration=bend[:3],
        swing_rotation=sole_rotation(*swing[3:].tolist()),
        swing_angular_velocity=turning,
        swing_angular_acceleration=bending,
        ground_normal=normal,
        rolling_foot=-1 if roll is None or not roll.rolling(sample.time) else int(roll.foot),
        roll=NO_ROLL if roll is None else roll.evaluate(sample.time),
        catching=plan.balance.catching,
    )


class ReferenceMaker:
    """Does what `whole_body_reference` does, tick by tick, by a kernel where there is one."""

    def __init__(self) -> None:
        kernels = library()
        self._fill = None if kernels is None else self._compile(kernels)
        self._plan: WalkPlan | None = None

    def _compile(self, kernels: Library) -> Callable[[int, int], None]:
        self._point, self._yaw, self._roll = np.zeros(POINT), np.zeros(2), np.zeros(3)
        self._normal, self._landing = np.zeros((2, 3)), np.zeros(3)
        reference, self._numbers = kernels.buffer("Reference")
        return kernels.bind(
            "plan_reference_fill",
            point=self._point,
            yaw=self._yaw,
            normal=self._normal,
            landing_normal=self._landing,
            roll=self._roll,
            reference=reference,
        )

    def reference(self, plan: WalkPlan, sample: PlanSample) -> WbcReference:
        """See `whole_body_reference`."""
        if self._fill is None or sample.point is None:
            return whole_body_reference(plan, sample)
        if plan is not self._plan:
            self._take(plan)
        time, phase, roll = sample.time, plan.phase, plan.roll
        foot, rolling, passed = -1, -1, time - plan.time
        if sample.swing_foot is not None:
            foot = int(sample.swing_foot)
        if roll is not None:
            self._roll[:] = roll.evaluate(time)
            rolling = int(roll.foot) if roll.rolling(time) else -1
        self._point[:] = sample.point
        self._fill(foot, rolling)
        progress = min(1.0, (phase.elapsed + passed) / phase.duration) if foot >= 0 and self._lasts else 0.0
        left = max(0.0, phase.left - passed)
        return WbcReference.of_numbers(
            self._numbers.copy(), sample.contacts, left, self._lifting, foot, progress, rolling, plan.balance.catching
        )

    def _take(self, plan: WalkPlan) -> None:
        """What stays the same until the next plan."""
        self._plan, phase = plan, plan.phase
        lifts = phase.kind is PhaseKind.DOUBLE and phase.leads_to > 0
        self._lifting = int(plan.footsteps[0].foot) if lifts else -1
        self._lasts = math.isfinite(phase.duration)
        for k, foothold in enumerate(plan.footholds):
            self._yaw[k], self._normal[k] = foothold.yaw, foothold.normal
        if plan.footsteps:
            self._landing[:] = plan.footsteps[0].normal
        if plan.roll is None:
            self._roll[:] = NO_ROLL
