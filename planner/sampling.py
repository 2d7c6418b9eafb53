"""References for the fast controller, at any instant of a plan."""

from dataclasses import dataclass

import numpy as np

from planner.plan import WalkPlan
from planner.polynomial import basis, quintic
from planner.types import GRAVITY, Array, Foot


@dataclass(frozen=True, slots=True)
class PlanSample:
    """References at one instant; world frame, arrays are fresh at every call.

    Attributes:
        time: instant [s].
        com: CoM position, shape (3,) [m].
        com_velocity: shape (3,) [m/s].
        com_acceleration: shape (3,) [m/s^2].
        zmp: ZMP of this motion, shape (2,) [m].
        zmp_reference: ZMP that the footsteps define, shape (2,) [m].
        dcm: ξ = c + c'/ω, shape (2,) [m].
        omega: ω [1/s].
        stiffness: λ [1/s^2].
        contacts: planned contacts (left, right).
        load_left: planned share of the weight on the left foot [-].
        load_left_rate: its rate [1/s].
        swing_foot: the swinging foot, or None; the swing arrays are zero without one.
        swing: swing sole x, y, z [m] and yaw [rad], shape (4,).
        swing_velocity: shape (4,) [m/s, rad/s].
        swing_acceleration: shape (4,) [m/s^2, rad/s^2].
    """

    time: float
    com: Array
    com_velocity: Array
    com_acceleration: Array
    zmp: Array
    zmp_reference: Array
    dcm: Array
    omega: float
    stiffness: float
    contacts: tuple[bool, bool]
    load_left: float
    load_left_rate: float
    swing_foot: Foot | None
    swing: Array
    swing_velocity: Array
    swing_acceleration: Array


class PlanSampler:
    """Evaluates a plan between its samples.

    The horizontal CoM is the exact cubic of the sample's jerk, its height the quintic through both samples' z, z', z'';
    ω, ZMP reference and load are linear. Each interval's polynomials are prepared when it is entered. After the end of
    the horizon the last sample is held.

    Attributes:
        plan: the plan.
    """

    def __init__(self, plan: WalkPlan) -> None:
        self.plan = plan
        self._last = len(plan.jerk) - 1
        self._interval = -1
        self._polynomials = np.zeros((6, 7))
        self._linear = np.zeros((2, 5))
        self._contacts = (True, True)
        self._swing_foot: Foot | None = None

    def sample(self, time: float) -> PlanSample:
        """References at an instant.

        Args:
            time: instant, not before the plan [s].
        """
        plan = self.plan
        since = max(0.0, time - plan.time)
        interval = min(int(since / plan.sample_time + 1e-6), self._last)
        if interval != self._interval:
            self._enter(interval)
        since = min(since - interval * plan.sample_time, plan.sample_time)
        motion = basis(since) @ self._polynomials
        linear = self._linear[0] + since * self._linear[1]
        omega, ground, load = linear[2:].tolist()
        com, velocity, acceleration = motion[0, :3], motion[1, :3], motion[2, :3]
        stiffness = (GRAVITY + float(acceleration[2])) / (float(com[2]) - ground)
        return PlanSample(
            time,
            com,
            velocity,
            acceleration,
            com[:2] - acceleration[:2] / stiffness,
            linear[:2],
            com[:2] + velocity[:2] / omega,
            omega,
            stiffness,
            self._contacts,
            load,
            float(self._linear[1, 4]),
            self._swing_foot,
            motion[0, 3:],
            motion[1, 3:],
            motion[2, 3:],
        )

    def _enter(self, i: int) -> None:
        plan, t = self.plan, self.plan.sample_time
        self._interval = i
        polynomials = np.zeros((6, 7))
        polynomials[0, :2], polynomials[1, :2] = plan.com[i, :2], plan.com_velocity[i, :2]
        polynomials[2, :2], polynomials[3, :2] = 0.5 * plan.com_acceleration[i, :2], plan.jerk[i] / 6.0
        vertical = np.array([(plan.com[j, 2], plan.com_velocity[j, 2], plan.com_acceleration[j, 2]) for j in (i, i + 1)])
        polynomials[:, 2] = quintic(vertical[0][:, None], vertical[1][:, None], t)[:, 0]
        left, right = plan.contacts[i].tolist()
        self._contacts, self._swing_foot = (left, right), None
        if plan.swing is not None and not plan.contacts[i, plan.swing.foot]:
            self._swing_foot = plan.swing.foot
            polynomials[:, 3:] = plan.swing.coefficients(plan.time + i * t)
        self._polynomials = polynomials
        ends = np.array(
            [
                (*plan.zmp_reference[j], plan.omega[j], plan.zmp_height[j], plan.load_left[j])
                for j in (i, i + 1)
            ]
        )
        self._linear[0], self._linear[1] = ends[0], (ends[1] - ends[0]) / t
