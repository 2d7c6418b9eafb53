"""What the whole-body controller is asked to do at each control tick, out of the plan."""

import math
from collections.abc import Callable

import numpy as np

from surefoot.planner.geometry import sole_rates, sole_rotation
from surefoot.planner.plan import PlanSample, PlanSampler, WalkPlan
from surefoot.planner.plan_kernel import PlanKernel
from surefoot.planner.types import Footstep, PhaseKind
from surefoot.values import maker
from surefoot.wbc.types import WbcReference

NO_ROLL = (0.0, 0.0, 0.0)

_a_whole_reference = maker(WbcReference)


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
    normal = np.empty((2, 3))
    normal[0], normal[1] = plan.footholds[0].normal, plan.footholds[1].normal
    if foot >= 0:
        yaw[foot] = float(swing[3])
        normal[foot] = plan.footsteps[0].normal
    turning, bending = sole_rates(swing[3:], rate[3:], bend[3:])
    return _a_whole_reference(
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


_OTHER_INTERVAL = -2
"""What the kernel gives where an instant is not within the interval that it holds [-]."""

_ROLL, _ROLLING = slice(49, 52), 53
"""Where the numbers of a reference have the roll of a foot, and which foot rolls [-]."""


_a_sample, _a_reference = PlanSample.of_point, WbcReference.of_numbers


class ReferenceMaker:
    """Samples plans, and does what `whole_body_reference` does, tick by tick, by one kernel where there is one.

    Args:
        kernel: of the samplers that it is given; None for plain Python.
    """

    def __init__(self, kernel: PlanKernel | None) -> None:
        self._fill = None if kernel is None else self._compile(kernel)
        self._plan: WalkPlan | None = None
        self._footholds: tuple[Footstep, Footstep] | None = None

    def _compile(self, kernel: PlanKernel) -> Callable[[float, float], int]:
        self._yaw, self._normal, self._landing = np.zeros(2), np.zeros((2, 3)), np.zeros(3)
        reference, self._numbers = kernel.kernels.buffer("Reference")
        self._now = kernel.now
        self._bound = kernel.kernels.fill(
            "PlanReference",
            interval=kernel.bound,
            yaw=self._yaw,
            normal=self._normal,
            landing_normal=self._landing,
            rolling_foot=-1,
            roll_start=0.0,
            roll_end=0.0,
            roll_angle=0.0,
            catching=0,
            reference=reference,
        )
        return kernel.kernels.bind("plan_reference_fill", self._bound)

    def tick(self, sampler: PlanSampler, time: float, middle: float) -> tuple[PlanSample, WbcReference]:
        """The references of a plan at an instant, and what is to be done from there on over a time of that middle [s].

        See `PlanSampler.tick` and `whole_body_reference`.
        """
        plan = sampler.plan
        if self._fill is None:
            return self._plain(sampler, time, middle)
        if plan is not self._plan:
            self._take(plan)
        rolling = self._fill(time, middle)
        if rolling == _OTHER_INTERVAL:
            if not sampler.goes_to(time, middle):
                return self._plain(sampler, time, middle)
            rolling = self._fill(time, middle)
        contacts = late = sampler.contacts
        if middle >= sampler.lands:
            contacts, late = sampler.contacts_at(time), sampler.contacts_at(middle)
        swings, passed, numbers = sampler.swing_foot, middle - plan.time, self._numbers.copy()
        foot, progress, left = -1, 0.0, self._left - passed
        if swings is not None:
            foot, progress = int(swings), (self._elapsed + passed) / self._duration  # zero of a phase without an end
            if progress > 1.0:
                progress = 1.0
        if self._scaled is not None:
            numbers[_ROLL] = self._scaled.evaluate(middle)
            rolling = int(self._scaled.foot) if self._scaled.rolling(middle) else -1
            numbers[_ROLLING] = rolling
        return _a_sample(time, self._now.copy(), contacts, swings), _a_reference(
            numbers, late, left if left > 0.0 else 0.0, self._lifting, foot, progress, rolling, self._catching
        )

    def _plain(self, sampler: PlanSampler, time: float, middle: float) -> tuple[PlanSample, WbcReference]:
        sample, until = sampler.tick(time, middle)
        return sample, whole_body_reference(sampler.plan, until)

    def _take(self, plan: WalkPlan) -> None:
        """What stays the same until the next plan."""
        self._plan, phase, roll, bound = plan, plan.phase, plan.roll, self._bound.struct
        lifts = phase.kind is PhaseKind.DOUBLE and phase.leads_to > 0
        self._lifting, self._catching = int(plan.footsteps[0].foot) if lifts else -1, plan.balance.catching
        self._elapsed, self._left, self._duration = phase.elapsed, phase.left, phase.duration
        if plan.footholds is not self._footholds:
            self._footholds = plan.footholds
            for k, foothold in enumerate(plan.footholds):
                self._yaw[k], self._normal[k] = foothold.yaw, foothold.normal
        if plan.footsteps:
            self._landing[:] = plan.footsteps[0].normal
        # The kernel knows no clock but the time.
        self._scaled = None if roll is None or roll.scaling is None or roll.scaling.steady else roll
        bound.rolling_foot, bound.catching = -1, int(self._catching)
        if roll is not None and self._scaled is None:
            bound.rolling_foot, bound.roll_start, bound.roll_end = int(roll.foot), roll.start, roll.end
            bound.roll_angle = roll.angle
