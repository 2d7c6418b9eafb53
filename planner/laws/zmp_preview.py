"""Profile `preview`: ZMP preview control of the cart-table (Kajita et al., ICRA 2003; Katayama et al., 1985)."""

from dataclasses import dataclass

import numpy as np

from surefoot.planner.laws.dcm_feedback import limited
from surefoot.planner.laws.law import Motion, MotionProblem
from surefoot.planner.model.jerk import jerk_model
from surefoot.planner.model.world_motion import advanced
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.references.leg_offset import softening
from surefoot.planner.types import GRAVITY, Array

_PREVIEW = 80
"""Samples of the reference that the law looks ahead, N_l: 1.6 s [-]."""

_JERK_WEIGHT = 1e-6
"""Cost R of a squared jerk against Q_e = 1 for a squared ZMP error, of the reference robot [s^6]."""


@dataclass(frozen=True, slots=True)
class PreviewGains:
    """u(k) = -G_i Σ e - G_x x(k) - Σ_j G_p(j) p_ref(k + j).

    Attributes:
        integral: G_i.
        state: G_x, shape (3,).
        preview: G_p(1)..G_p(N_l), shape (N_l,). The last one carries the tail as if the reference rested beyond, so
            that the law does not depend on where the origin is.
        system: closed loop of the summed error and the CoM state under a resting reference, shape (4, 4).
    """

    integral: float
    state: Array
    preview: Array
    system: Array


def preview_gains(
    sample_time: float, stiffness: float, samples: int = _PREVIEW, jerk_weight: float = _JERK_WEIGHT
) -> PreviewGains:
    """Gains that minimise Σ Q_e e² + R Δu² with integral action.

    Args:
        sample_time: T [s].
        stiffness: λ = g / z_c, constant [1/s^2].
        samples: N_l.
        jerk_weight: R [s^6].
    """
    from scipy.linalg import solve_discrete_are

    A, b = jerk_model(sample_time)
    B = b[:, None]
    C = np.array([[1.0, 0.0, -1.0 / stiffness]])
    A1 = np.block([[np.eye(1), C @ A], [np.zeros((3, 1)), A]])
    B1 = np.vstack((C @ B, B))
    Q = np.diag([1.0, 0.0, 0.0, 0.0])
    P = solve_discrete_are(A1, B1, Q, np.array([[jerk_weight]]))
    weight = 1.0 / (jerk_weight + float((B1.T @ P @ B1)[0, 0]))
    K = weight * (B1.T @ P @ A1)
    closed = A1 - B1 @ K
    preview, carried = np.empty(samples), -closed.T @ P[:, :1]
    preview[0] = -K[0, 0]
    for j in range(1, samples):
        preview[j] = weight * float((B1.T @ carried)[0, 0])
        carried = closed.T @ carried
    preview[-1] -= K[0, 1] + preview.sum()
    return PreviewGains(float(K[0, 0]), K[0, 1:].copy(), preview, closed)


class ZmpPreview:
    """The law in closed loop with its own model, over the horizon; its memory is the summed error of both axes.

    It knows a pendulum of constant height, no bounds and no footstep shifts.

    Args:
        parameters: planner parameters.
        com_height: CoM height over the ground at rest, z_c [m].
    """

    def __init__(self, parameters: PlannerParameters, com_height: float) -> None:
        self._parameters = parameters
        self._stiffness = softening(parameters.leg) * GRAVITY / com_height
        weight = parameters.size.times(_JERK_WEIGHT, "s^6")
        self._gains = preview_gains(parameters.sample_time, self._stiffness, min(_PREVIEW, parameters.preview), weight)

    def plan(self, problem: MotionProblem) -> Motion:
        """See `MotionPlanner`."""
        p, gains, point = self._parameters, self._gains, problem.reference.point
        ahead = np.lib.stride_tricks.sliding_window_view(point[1:], len(gains.preview), axis=0)
        feedforward = ahead[: p.horizon] @ gains.preview
        summed = np.zeros(2) if problem.memory is None else problem.memory
        jerk = np.column_stack([self._axis(problem, axis, feedforward[:, axis], summed[axis]) for axis in range(2)])
        error = problem.state[:, 0] - problem.state[:, 2] / self._stiffness - point[0]
        return Motion(jerk, np.zeros((2, 2)), np.zeros(2), np.zeros(2), memory=summed + error)

    def _axis(self, problem: MotionProblem, axis: int, feedforward: Array, summed: float) -> list[float]:
        """Jerks of one axis; in plain numbers, which are fast."""
        p, t, i = self._parameters, self._parameters.sample_time, 1.0 / self._stiffness
        gain, (gx, gv, ga) = self._gains.integral, self._gains.state.tolist()
        x, v, a = problem.state[axis].tolist()
        last, jerk = float(problem.last_jerk[axis]), []
        reference = problem.reference.point[: p.horizon, axis]
        for r, f in zip(reference.tolist(), feedforward.tolist(), strict=True):
            summed += x - i * a - r
            last = limited(-gain * summed - gx * x - gv * v - ga * a - f, last, p)
            jerk.append(last)
            x, v, a = advanced((x, v, a), last, t)
        return jerk
