"""The CoM under a piecewise constant jerk: the one triple integrator, its moves and its prediction matrices."""

from dataclasses import dataclass

import numpy as np

from surefoot.errors import ParameterError
from surefoot.planner.types import Array

BLOCK_STARTS = (0, 1, 2, 4, 7, 11, 16, 22, 29, 37)
"""Ten blocks over fifty samples, short at first: the repaired parametrisation (the paper's is (0, 1), N_c = 2) [-]."""


def jerk_model(sample_time: float) -> tuple[Array, Array]:
    """A, shape (3, 3), and B, shape (3,), of the CoM under a jerk that is constant over a sample.

    They are those of eq. (4): x(k+1) = A x(k) + B u(k), eq. (3), integrates the chain of eq. (2) exactly.

    Args:
        sample_time: T [s].
    """
    t = sample_time
    return (
        np.array([[1.0, t, 0.5 * t * t], [0.0, 1.0, t], [0.0, 0.0, 1.0]]),
        np.array([t**3 / 6.0, 0.5 * t * t, t]),
    )


def advanced(x: float, v: float, a: float, jerk: float, t: float) -> tuple[float, float, float]:
    """The same of one axis in plain numbers, which are fast: position, velocity and acceleration a time t later."""
    return x + t * v + 0.5 * t * t * a + jerk * t**3 / 6.0, v + t * a + jerk * t**2 / 2.0, a + jerk * t


def block_moves(starts: tuple[int, ...], horizon: int) -> Array:
    """Basis of piecewise constant jerk.

    Args:
        starts: first sample of each block, increasing from 0; a block lasts until the next begins, the last one until
            the end of the horizon (the paper's "last controller output is kept").
        horizon: number of samples N.

    Returns:
        Matrix M, shape (N, len(starts)), with jerk = M moves.

    Raises:
        ParameterError: the starts do not increase from 0 inside the horizon.
    """
    if not starts or starts[0] != 0 or list(starts) != sorted(set(starts)) or starts[-1] >= horizon:
        what = f"the blocks of moves start at samples {starts}"
        raise ParameterError(("parameters", "moves"), what, f"they must increase from 0 and stay below {horizon}")
    block = np.searchsorted(np.array(starts), np.arange(horizon), side="right") - 1
    return np.eye(len(starts))[block]


@dataclass(frozen=True, slots=True)
class Prediction:
    """Position, velocity and acceleration over a horizon as linear functions of state and moves.

    The triple integrator of eq. (4) has constant A and B; only C(k) = [1, 0, -1/λ(k)] varies with time (the
    paper prints -ω² for -1/ω²). The predicted ZMP of eq. (10) is therefore a row scaling,
    Y = P_x - diag(1/λ) P_a, for the response to the state (S_x) as for the response to the input (S_u).

    Attributes:
        state: response (x, x', x'') to the state, shape (3, N + 1, 3).
        moves: response to the moves, shape (3, N + 1, m).
        samples: response to the jerk of each sample, shape (3, N + 1, N).
        basis: jerk = basis @ moves, shape (N, m).
    """

    state: Array
    moves: Array
    samples: Array
    basis: Array


def predict(sample_time: float, basis: Array) -> Prediction:
    """Prediction matrices for samples 0..N.

    Args:
        sample_time: T [s].
        basis: move parametrisation, shape (N, m).
    """
    n = basis.shape[0]
    time = sample_time * np.arange(n + 1)
    one, zero = np.ones_like(time), np.zeros_like(time)
    state = np.stack(
        [
            np.stack([one, time, 0.5 * time**2], axis=1),
            np.stack([zero, one, time], axis=1),
            np.stack([zero, zero, one], axis=1),
        ]
    )
    age = np.arange(n + 1)[:, None] - np.arange(n)[None, :] - 1
    past = age >= 0
    t = sample_time
    samples = np.stack(
        [
            np.where(past, (1 + 3 * age + 3 * age**2) * t**3 / 6.0, 0.0),
            np.where(past, (1 + 2 * age) * t**2 / 2.0, 0.0),
            np.where(past, t, 0.0),
        ]
    )
    return Prediction(state, np.ascontiguousarray(samples @ basis), samples, basis)


@dataclass(frozen=True, slots=True)
class Trajectory:
    """A predicted motion in the plan frame.

    Attributes:
        com: position, velocity, acceleration at samples 0..N, shape (3, N + 1, 2).
        zmp: shape (N + 1, 2) [m].
        jerk: shape (N, 2) [m/s^3].
    """

    com: Array
    zmp: Array
    jerk: Array


def trajectory(prediction: Prediction, state: Array, stiffness: Array, jerk: Array) -> Trajectory:
    """Motion under a jerk sequence.

    Args:
        prediction: prediction matrices.
        state: CoM position, velocity, acceleration per axis, shape (2, 3).
        stiffness: λ at samples 0..N, shape (N + 1,) [1/s^2].
        jerk: shape (N, 2) [m/s^3].
    """
    com = prediction.state @ state.T + prediction.samples @ jerk
    return Trajectory(com, zmp_response(com, stiffness), jerk)


def zmp_response(response: Array, stiffness: Array) -> Array:
    """Response of the ZMP y = x - x''/λ.

    Args:
        response: (x, x', x'') of the samples, shape (3, n, ...).
        stiffness: λ, shape (n,) [1/s^2].
    """
    inverse = 1.0 / stiffness
    return np.asarray(response[0] - inverse.reshape(-1, *([1] * (response.ndim - 2))) * response[2])
