"""The CoM under a piecewise constant jerk: the one triple integrator, its moves and its prediction matrices.

The Δu form Y = S_x x(0) + S_u1 u(-1) + S_u ΔU is eq. (10) and eq. (11) of the paper. Errata of eq. (11):

- Erratum: the first row of S_u is printed as zeros and the second as "S_u1 C(2)B(1)"; here row i, column j <= i is C(i)
  Σ_k [Π A] B(k) with k from j. A line break was lost in print: y(1) depends on Δu(0) as it does on u(-1).
- Erratum: the products Π A(i) are printed without an order; here later matrices stand on the left, because
  x(k+1) = A(k) x(k) + B(k) u(k).
- Erratum: S_u is printed with N_p columns although N_c < N_p moves are announced; here only the columns of samples at
  which the input may change are kept, "the last controller output is kept".
"""

from dataclasses import dataclass

import numpy as np

from surefoot.errors import ParameterError
from surefoot.planner.types import Array

BLOCK_STARTS = (0, 1, 2, 4, 7, 11, 16, 22, 29, 37)
"""Ten blocks over fifty samples, short at first: the repaired parametrisation (the paper's is (0, 1), N_c = 2) [-]."""


def jerk_model(sample_time: float) -> tuple[Array, Array]:
    """A, shape (3, 3), and B, shape (3,), of the CoM under a jerk that is constant over a sample.

    They are those of eq. (4): x(k+1) = A x(k) + B u(k), eq. (3), integrates the chain of eq. (2) exactly.
    With one λ over the horizon they give F and Φ of eq. (6).

    Erratum: eq. (5) writes Y = F x + Φ ΔU, but its printed Φ is the impulse response, which belongs to u(0)..u(N-1);
    summing the columns of Φ from j on gives column j of S_u.

    Args:
        sample_time: T [s].
    """
    t = sample_time
    return (
        np.array([[1.0, t, 0.5 * t * t], [0.0, 1.0, t], [0.0, 0.0, 1.0]]),
        np.array([t**3 / 6.0, 0.5 * t * t, t]),
    )


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

    Only C(k) = [1, 0, -1/λ(k)] varies with time. The predicted ZMP of eq. (10) is therefore a row scaling,
    Y = P_x - diag(1/λ) P_a, for the response to the state as for the response to the input (see `zmp_response`).

    Erratum: C is printed [1 0 -ω²] in eq. (4); here [1 0 -1/ω²], because x'' = ω² (x - p).

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
    n = len(basis)
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


def zmp_response(response: Array, stiffness: Array) -> Array:
    """Response of the ZMP y = x - x''/λ.

    Args:
        response: (x, x', x'') of the samples, shape (3, n, ...).
        stiffness: λ, shape (n,) [1/s^2].
    """
    inverse = 1.0 / stiffness
    return np.asarray(response[0] - inverse.reshape(-1, *([1] * (response.ndim - 2))) * response[2])


@dataclass(frozen=True, slots=True)
class CachedResponse:
    """The part of the Δu form of the jerk-driven CoM that does not depend on λ.

    Attributes:
        position: P_x, response of the position to x(0), u(-1) and ΔU side by side, shape (N, 4 + m).
        acceleration: P_a, response of the acceleration to the same, shape (N, 4 + m).
        last: responses (x, x', x'') to the same at sample N, shape (3, 4 + m).
    """

    position: Array
    acceleration: Array
    last: Array

    def at(self, stiffness: Array) -> tuple[Array, Array, Array]:
        """S_x, shape (N, 3), S_u1, shape (N,), and S_u, shape (N, m), for λ at samples 1..N, shape (N,) [1/s^2]."""
        S = self.position - self.acceleration / stiffness[:, None]
        return S[:, :3], S[:, 3], S[:, 4:]


def cached_response(sample_time: float, starts: tuple[int, ...], horizon: int) -> CachedResponse:
    """Precompute the parts of eq. (10) and eq. (11) that do not depend on λ.

    Args:
        sample_time: T [s].
        starts: samples at which the input may change; the paper's are 0..N_c - 1.
        horizon: N.
    """
    free = predict(sample_time, np.eye(horizon))
    held = np.flip(np.cumsum(np.flip(free.samples, axis=2), axis=2), axis=2)
    response = np.concatenate((free.state, held[:, :, :1], held[:, :, list(starts)]), axis=2)
    position, _, acceleration = np.ascontiguousarray(response[:, 1:])
    return CachedResponse(position, acceleration, response[:, -1].copy())
