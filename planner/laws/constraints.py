"""Online constraints generator: ZMP box, terminal DCM bound and footstep bounds of one tick."""

from dataclasses import dataclass

import numpy as np

from surefoot.planner.model.dcm import viability_weights
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.references.zmp_reference import ZmpReference
from surefoot.planner.types import Array
from surefoot.planner.walk.reach import reach_box


@dataclass(frozen=True, slots=True)
class StepContext:
    """The next two footsteps, in the plan frame.

    Attributes:
        increment: their nominal displacements from the foothold before, shape (2, 2) [m].
        side: +1 where the step is a left one, -1 where it is a right one, shape (2,).
        free: whether each of them may be shifted.
        swing: position of the swing foot from the stance foot, shape (2,) [m], or None when no foot swings.
        time_left: time until the first of them lands [s].
        transfer_time: duration of the double support that follows, zero when no foot swings (T_ds) [s].
        reach: lower and upper corners of the boxes in which they may land, from the foothold before, shape
            (step, axis) = (2, 2) each [m]; None for the paper's reachable area, as far as the foot can swing.
    """

    increment: Array
    side: tuple[float, float]
    free: tuple[bool, bool]
    swing: Array | None
    time_left: float
    transfer_time: float
    reach: tuple[Array, Array] | None = None


@dataclass(frozen=True, slots=True)
class Constraints:
    """Bounds of one tick, per axis of the plan frame.

    Attributes:
        half_size: ZMP box around the reference at samples 1..N, shape (N, 2) [m].
        terminal_omega: ω at the end of the horizon [1/s].
        terminal_center: DCM there that the known future footholds keep bounded, shape (2,) [m].
        terminal_gain: its sensitivity to the two footstep shifts, shape (2,) [-].
        terminal_half_size: tolerance around it, shape (2,) [m].
        step_lower: lower bounds of the footstep shifts, shape (step, axis) = (2, 2) [m].
        step_upper: upper bounds, shape (2, 2) [m].
    """

    half_size: Array
    terminal_omega: float
    terminal_center: Array
    terminal_gain: Array
    terminal_half_size: Array
    step_lower: Array
    step_upper: Array


def generate_constraints(
    parameters: PlannerParameters, reference: ZmpReference, stiffness: Array, omega: Array, steps: StepContext
) -> Constraints:
    """Constraints of one tick.

    The paper's box (eq. (9)) is printed as an equality that is not centred on the foot; here it is
    ± foot_margin / 2 of the foot around the moving reference, at samples 1..N (sample 0 has no feed-through).

    Args:
        parameters: planner parameters.
        reference: ZMP reference over horizon and preview, N + M + 1 samples.
        stiffness: λ over the same window, shape (N + M + 1,) [1/s^2].
        omega: ω over the same window [1/s].
        steps: the next two footsteps.
    """
    n = parameters.horizon
    weights = viability_weights(stiffness[n:], omega[n:], parameters.sample_time)
    lower, upper = step_bounds(parameters, steps)
    return Constraints(
        half_size=reference.half_size[1 : n + 1],
        terminal_omega=float(omega[n]),
        terminal_center=weights @ reference.point[n:],
        terminal_gain=weights @ reference.gain[n:],
        terminal_half_size=parameters.terminal_margin * reference.half_size[n],
        step_lower=lower,
        step_upper=upper,
    )


def step_bounds(parameters: PlannerParameters, steps: StepContext) -> tuple[Array, Array]:
    """Lower and upper bounds of the footstep shifts, each of shape (step, axis) = (2, 2) [m].

    They are the reach boxes, the paper's first one also within what the swing foot can still reach in time. A shift
    that is not free has no effect on the motion and costs something, so its wide bounds leave it at zero.
    """
    lower, upper = np.full((2, 2), -1.0), np.full((2, 2), 1.0)
    for j in range(2):
        if steps.free[j]:
            low, high = _reach(parameters, steps, j)
            lower[j], upper[j] = low - steps.increment[j], high - steps.increment[j]
    if steps.free[1]:
        lower[1], upper[1] = np.minimum(lower[1], 0.0), np.maximum(upper[1], 0.0)
    if steps.free[0] and steps.swing is not None and steps.reach is None:
        travel = parameters.swing_speed * steps.time_left / np.sqrt(2.0)
        here = steps.swing - steps.increment[0]
        # The nominal footstep is never out of reach: a fast gait's swing is faster than that speed by itself.
        low = np.maximum(lower[0], np.minimum(np.minimum(here - travel, 0.0), upper[0]))
        upper[0] = np.minimum(upper[0], np.maximum(np.maximum(here + travel, 0.0), lower[0]))
        lower[0] = low
    return lower, upper


def _reach(parameters: PlannerParameters, steps: StepContext, step: int) -> tuple[Array, Array]:
    if steps.reach is None:
        return reach_box(parameters, steps.side[step])
    low, high = steps.reach
    return low[step], high[step]
