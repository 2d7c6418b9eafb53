"""Online constraints generator: ZMP box, terminal DCM bound and footstep bounds of one tick."""

from dataclasses import dataclass

from surefoot.planner.model.dcm import viability_weights
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.recovery.step_bounds import StepBounds
from surefoot.planner.references.zmp_reference import ZmpReference
from surefoot.planner.types import Array


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
        bounds: lower and upper bounds of their shifts.
    """

    increment: Array
    side: tuple[float, float]
    free: tuple[bool, bool]
    swing: Array | None
    time_left: float
    transfer_time: float
    bounds: StepBounds


@dataclass(frozen=True, slots=True)
class Constraints:
    """Bounds of one tick, per axis of the plan frame.

    Attributes:
        half_size: ZMP box around the reference at samples 1..N, shape (N, 2) [m].
        terminal_omega: ω at the end of the horizon [1/s].
        terminal_center: DCM there that the known future footholds keep bounded, shape (2,) [m].
        terminal_gain: its sensitivity to the two footstep shifts, shape (2,) [-].
        terminal_half_size: tolerance around it, shape (2,) [m].
        steps: bounds of the footstep shifts.
    """

    half_size: Array
    terminal_omega: float
    terminal_center: Array
    terminal_gain: Array
    terminal_half_size: Array
    steps: StepBounds


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
    return Constraints(
        half_size=reference.half_size[1 : n + 1],
        terminal_omega=float(omega[n]),
        terminal_center=weights @ reference.point[n:],
        terminal_gain=weights @ reference.gain[n:],
        terminal_half_size=parameters.terminal_margin * reference.half_size[n],
        steps=steps.bounds,
    )
