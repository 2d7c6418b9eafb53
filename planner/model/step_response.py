"""Prediction in the Δu form: Y = S_x x(0) + S_u1 u(-1) + S_u ΔU (eq. (10) and eq. (11) of the paper).

Three ways to the same matrices: the printed double sums, a recursion for any A(k), B(k), C(k), and the cached form for
the jerk-driven CoM, whose A and B do not vary. Errata of eq. (11), corrected in all three:

- Erratum: the first row of S_u is printed as zeros and the second as "S_u1 C(2)B(1)"; here row i, column j <= i is
  C(i) Σ_k [Π A] B(k) with k from j, because a line break was lost: y(1) depends on Δu(0) as it does on u(-1).
- Erratum: the products Π A(i) are printed without an order; here later matrices stand on the left, because
  x(k+1) = A(k) x(k) + B(k) u(k).
- Erratum: S_u is printed with N_p columns although N_c < N_p moves are announced; here only the columns of samples at
  which the input may change are kept, "the last controller output is kept".
"""

from dataclasses import dataclass

import numpy as np

from surefoot.planner.model.jerk import predict
from surefoot.planner.types import Array


@dataclass(frozen=True, slots=True)
class StepResponse:
    """Matrices of eq. (11); row i - 1 is the output at sample i = 1..N.

    Attributes:
        S_x: response to the state x(0), shape (N, n).
        S_u1: response to holding the last input u(-1), shape (N,).
        S_u: response to the input changes ΔU, shape (N, m).
    """

    S_x: Array
    S_u1: Array
    S_u: Array

    def outputs(self, state: Array, last_input: float, changes: Array) -> Array:
        """Y of eq. (10), shape (N,)."""
        return np.asarray(self.S_x @ state + self.S_u1 * last_input + self.S_u @ changes)


def literal_response(A: Array, B: Array, C: Array) -> StepResponse:
    """The sums and products of eq. (11), term by term.

    Args:
        A: A(0)..A(N-1), shape (N, n, n).
        B: B(0)..B(N-1), shape (N, n).
        C: C(1)..C(N), shape (N, n).
    """
    count, order = B.shape
    S_x, S_u = np.zeros((count, order)), np.zeros((count, count))
    for i in range(1, count + 1):
        S_x[i - 1] = C[i - 1] @ _product(A, 0, i)
        for j in range(i):
            S_u[i - 1, j] = C[i - 1] @ sum(_product(A, k + 1, i) @ B[k] for k in range(j, i))
    return StepResponse(S_x, S_u[:, 0].copy(), S_u)


def recursive_response(A: Array, B: Array, C: Array) -> StepResponse:
    """The same by x(k+1) = A(k) x(k) + B(k) u(k) on the whole matrices; arguments as of `literal_response`."""
    count, order = B.shape
    to_state, to_changes = np.eye(order), np.zeros((order, count))
    S_x, S_u = np.empty((count, order)), np.empty((count, count))
    for k in range(count):
        to_state = A[k] @ to_state
        to_changes = A[k] @ to_changes
        to_changes[:, : k + 1] += B[k][:, None]
        S_x[k], S_u[k] = C[k] @ to_state, C[k] @ to_changes
    return StepResponse(S_x, S_u[:, 0].copy(), S_u)


@dataclass(frozen=True, slots=True)
class CachedResponse:
    """The ZMP of the jerk-driven CoM: only C(k) = [1, 0, -1/λ(k)] varies, so S = P_x - diag(1/λ) P_a, row by row.

    Erratum: C is printed [1 0 -ω²] in eq. (4); here [1 0 -1/ω²], because x'' = ω² (x - p).

    Attributes:
        position: P_x, response of the position to x(0), u(-1) and ΔU side by side, shape (N, 4 + m).
        acceleration: P_a, likewise, shape (N, 4 + m).
        last: responses (x, x', x'') at sample N, likewise, shape (3, 4 + m).
    """

    position: Array
    acceleration: Array
    last: Array

    def at(self, stiffness: Array) -> StepResponse:
        """The matrices for λ at samples 1..N, shape (N,)."""
        S = self.position - self.acceleration / stiffness[:, None]
        return StepResponse(S[:, :3], S[:, 3], S[:, 4:])


def cached_response(sample_time: float, starts: tuple[int, ...], horizon: int) -> CachedResponse:
    """Precompute the parts that do not depend on λ.

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


def lti_response(A: Array, B: Array, C: Array, horizon: int) -> tuple[Array, Array]:
    """F and Φ of eq. (6), the prediction eq. (5) for the inputs u themselves.

    Erratum: eq. (5) writes Y = F x + Φ ΔU; here the columns belong to u(0)..u(N-1), because the printed Φ is the
    impulse response. Summing its columns from j on gives column j of S_u.

    Args:
        A: shape (n, n).
        B: shape (n,).
        C: shape (n,).
        horizon: N.

    Returns:
        F, shape (N, n), and Φ, shape (N, N).
    """
    power, F, markov = np.eye(len(B)), [], []
    for _ in range(horizon):
        markov.append(C @ power @ B)
        power = A @ power
        F.append(C @ power)
    phi = np.zeros((horizon, horizon))
    for i in range(horizon):
        phi[i, : i + 1] = markov[i::-1]
    return np.array(F), phi


def _product(A: Array, first: int, end: int) -> Array:
    """A(end - 1) ... A(first), the identity when empty."""
    result = np.eye(A.shape[1])
    for k in range(first, end):
        result = A[k] @ result
    return result
