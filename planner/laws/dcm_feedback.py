"""Profile `dcm`: instantaneous DCM feedback (Takenaka et al., 2009; Englsberger et al., 2015), without a QP."""

import numpy as np

from surefoot.planner.laws.law import Motion, MotionProblem
from surefoot.planner.model.dcm import nominal_dcm
from surefoot.planner.model.world_motion import advanced
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.types import Array


def limited(jerk: float, last: float, parameters: PlannerParameters) -> float:
    """The jerk nearest to a wanted one within the limits of jerk and rate.

    Args:
        jerk: wanted [m/s^3].
        last: jerk of the sample before [m/s^3].
        parameters: give the limits.
    """
    rate, limit = parameters.jerk_rate_limit, parameters.jerk_limit
    return min(max(jerk, last - rate, -limit), last + rate, limit)


_GAIN = 4.0
"""Rate k at which a DCM error decays while the ZMP stays inside its box, of the reference robot [1/s]."""


class DcmFeedback:
    """p = p_ref + (1 + k/ω)(ξ - ξ_ref), clipped to the box, at every sample of the horizon.

    ξ_ref is the DCM that the known future reference keeps bounded (backward recursion); the error then obeys e' = -k e.
    The jerk of a sample is the one after which the ZMP obeys the law. Footsteps are not shifted.

    Args:
        parameters: planner parameters.
        com_height: CoM height over the ground, which it does not need [m].
    """

    def __init__(self, parameters: PlannerParameters, com_height: float) -> None:
        self._parameters = parameters

    def plan(self, problem: MotionProblem) -> Motion:
        """See `MotionPlanner`."""
        p, omega = self._parameters, problem.omega[:, None]
        nominal = nominal_dcm(problem.stiffness, problem.omega, problem.reference.point, p.sample_time)
        gain = 1.0 + p.size.times(_GAIN, "1/s") / omega
        offset = problem.reference.point - gain * nominal
        jerk = np.column_stack([self._axis(problem, axis, gain[:, 0], offset[:, axis]) for axis in range(2)])
        return Motion(jerk, np.zeros((2, 2)), np.zeros(2), np.zeros(2))

    def _axis(self, problem: MotionProblem, axis: int, gain: Array, offset: Array) -> list[float]:
        """Jerks after which y = offset + gain ξ, or y is at the edge of its box; in plain numbers, which are fast."""
        p, n = self._parameters, self._parameters.horizon
        t = p.sample_time
        reference = problem.reference.part(slice(1, n + 1))
        center, half = reference.point[:, axis] + reference.middle[:, axis], reference.half_size[:, axis]
        inverse = 1.0 / problem.stiffness[1 : n + 1]
        period = 1.0 / problem.omega[1 : n + 1]
        zmp_rate = t**3 / 6.0 - inverse * t
        dcm_rate = t**3 / 6.0 + period * t**2 / 2.0
        columns = (
            gain[1 : n + 1],
            offset[1 : n + 1],
            inverse,
            period,
            zmp_rate,
            dcm_rate,
            center - half,
            center + half,
        )
        x, v, a = problem.state[axis].tolist()
        last, jerk = float(problem.last_jerk[axis]), []
        for g, d, i, w, zr, dr, low, high in np.column_stack(columns).tolist():
            coasted, speed, _ = advanced((x, v, a), 0.0, t)
            free = coasted - i * a
            wanted = free + zr * (d + g * (coasted + w * speed) - free) / (zr - g * dr)
            last = limited((min(max(wanted, low), high) - free) / zr, last, p)
            jerk.append(last)
            x, v, a = advanced((x, v, a), last, t)
        return jerk
