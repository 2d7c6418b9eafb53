"""Adaptive ZMP planner: where the next footstep goes, from the DCM alone (eq. (14), and what it should be)."""

import math

import numpy as np

from surefoot.planner.laws.constraints import step_bounds
from surefoot.planner.laws.law import MotionProblem
from surefoot.planner.model.dcm import dcm, decays, nominal_dcm, viability_weights
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.types import Array
from surefoot.planner.walk.reach import reach_box


def paper_shift(problem: MotionProblem, parameters: PlannerParameters) -> Array:
    """As printed in eq. (14): S_L(t) = (ζ_t - f_i) e^{ω (T_ss + T_ds - t)}, in both axes.

    Changes within the compliance margin are not made; the footstep is saturated in the reach box. The law is kept with
    what is wrong in it, for comparison: the foot lands T_ds earlier than it counts with, it steps *onto* the DCM, where
    a walk would stop, and it amplifies a DCM error by up to e^{2 ω} = 523. It changes nominal steps, and a walk with it
    falls without any push.

    Args:
        problem: the tick; the stance foot f_i is the origin of the plan frame.
        parameters: give margin and reach.

    Returns:
        Shift of the next footstep from its nominal increment, shape (2,) [m].
    """
    steps, nominal = problem.steps, problem.steps.increment[0]
    if steps.swing is None or not steps.free[0]:
        return np.zeros(2)
    omega = math.sqrt(problem.stiffness[0])
    here = dcm(problem.state[:, 0], problem.state[:, 1], omega)
    change = here * math.exp(omega * (steps.time_left + steps.transfer_time)) - nominal
    change[np.abs(change) <= parameters.compliance_margin] = 0.0
    low, high = reach_box(parameters, steps.side[0])
    return np.asarray(np.clip(nominal + change, low, high) - nominal)


def corrected_shift(problem: MotionProblem, parameters: PlannerParameters) -> Array:
    """The law that a walk needs: f = ξ_T - b, with the DCM ξ_T at touchdown that the CoP can no longer prevent.

    Erratum: eq. (14) counts until T_ss + T_ds and steps onto the DCM; here the horizon ends at touchdown, b is
    the offset of the DCM from the foot in the nominal gait, and only what the CoP cannot correct until then is left to
    the foot, because a gain of e^{ω (T_ss + T_ds)} turns 0.1 mm of DCM error into a step of 5 cm.

    Without DCM error the step is the nominal one. A shift d of the foot moves the DCM that its future ZMP keeps bounded
    by g d at touchdown, with g < 1 as the ZMP reaches the new foot only during double support. The shift stays within
    reach and swing speed, and is not renewed shortly before touchdown.

    Args:
        problem: the tick.
        parameters: give sample time, reach, swing speed and freeze time.

    Returns:
        Shift of the next footstep from its nominal increment, shape (2,) [m].
    """
    steps, t = problem.steps, parameters.sample_time
    k = round(steps.time_left / t)
    blind = k >= len(problem.stiffness) - 1 or steps.time_left <= parameters.freeze_time
    if steps.swing is None or not steps.free[0] or blind:
        return np.zeros(2)
    nominal = nominal_dcm(problem.stiffness, problem.omega, problem.reference.point, t)[0]
    error = dcm(problem.state[:, 0], problem.state[:, 1], float(problem.omega[0])) - nominal
    growth = 1.0 / decays(problem.stiffness[: k + 1], problem.omega[: k + 1], t)[-1]
    authority = problem.reference.half_size[0] * (growth - 1.0)
    residual = np.sign(error) * np.maximum(np.abs(error) * growth - authority, 0.0)
    gain = viability_weights(problem.stiffness[k:], problem.omega[k:], t) @ problem.reference.gain[k:, 0]
    lower, upper = step_bounds(parameters, steps)
    return np.asarray(np.clip(residual / gain, lower[0], upper[0]))
