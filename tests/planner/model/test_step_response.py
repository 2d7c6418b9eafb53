import numpy as np
import pytest

from surefoot.planner.model.jerk import BLOCK_STARTS, block_moves, cached_response

pytestmark = pytest.mark.unit

T = 0.02
A = np.array([[1.0, T, T * T / 2], [0.0, 1.0, T], [0.0, 0.0, 1.0]])
B = np.array([T**3 / 6, T * T / 2, T])


def jerk_driven(stiffness):
    """A(k), B(k), C(k) of eq. (4) for λ at samples 1..N."""
    n = len(stiffness)
    C = np.stack([np.ones(n), np.zeros(n), -1.0 / stiffness], axis=1)
    return np.tile(A, (n, 1, 1)), np.tile(B, (n, 1)), C


def product(A, first, end):
    """A(end - 1) ... A(first), the identity when empty."""
    result = np.eye(A.shape[1])
    for k in range(first, end):
        result = A[k] @ result
    return result


def literal_response(A, B, C):
    """S_x, S_u1 and S_u by the sums and products of eq. (11), term by term, for A(0).., B(0).., C(1).. ."""
    count, order = B.shape
    S_x, S_u = np.zeros((count, order)), np.zeros((count, count))
    for i in range(1, count + 1):
        S_x[i - 1] = C[i - 1] @ product(A, 0, i)
        for j in range(i):
            S_u[i - 1, j] = C[i - 1] @ sum(product(A, k + 1, i) @ B[k] for k in range(j, i))
    return S_x, S_u[:, 0], S_u


def recursive_response(A, B, C):
    """The same by x(k+1) = A(k) x(k) + B(k) u(k) on the whole matrices."""
    count, order = B.shape
    to_state, to_changes = np.eye(order), np.zeros((order, count))
    S_x, S_u = np.empty((count, order)), np.empty((count, count))
    for k in range(count):
        to_state, to_changes = A[k] @ to_state, A[k] @ to_changes
        to_changes[:, : k + 1] += B[k][:, None]
        S_x[k], S_u[k] = C[k] @ to_state, C[k] @ to_changes
    return S_x, S_u[:, 0], S_u


def lti_response(A, B, C, horizon):
    """F and Φ of eq. (6), the prediction eq. (5) for the inputs u themselves.

    Erratum: eq. (5) writes Y = F x + Φ ΔU; here the columns belong to u(0)..u(N-1), because the printed Φ is the
    impulse response. Summing its columns from j on gives column j of S_u.
    """
    powers = [np.linalg.matrix_power(A, k) for k in range(horizon + 1)]
    markov, phi = [C @ power @ B for power in powers], np.zeros((horizon, horizon))
    for i in range(horizon):
        phi[i, : i + 1] = markov[i::-1]
    return np.array([C @ power for power in powers[1:]]), phi


def outputs(response, state, last, changes):
    """Y of eq. (10)."""
    S_x, S_u1, S_u = response
    return S_x @ state + S_u1 * last + S_u @ changes


def simulated(A, B, C, state, inputs):
    outputs = []
    for k, u in enumerate(inputs):
        state = A[k] @ state + B[k] * u
        outputs.append(C[k] @ state)
    return np.array(outputs)


@pytest.mark.parametrize("respond", [literal_response, recursive_response])
def test_general_matrices_equal_step_by_step_simulation(respond):
    rng = np.random.default_rng(0)
    A = np.eye(3) + 0.1 * rng.normal(size=(20, 3, 3))
    B, C = rng.normal(size=(20, 3)), rng.normal(size=(20, 3))
    state, last, changes = rng.normal(size=3), 0.7, rng.normal(size=20)
    response = respond(A, B, C)
    expected = simulated(A, B, C, state, last + np.cumsum(changes))
    np.testing.assert_allclose(outputs(response, state, last, changes), expected, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("starts", [(0, 1), BLOCK_STARTS, tuple(range(50))])
def test_cached_matrices_equal_simulation_for_random_stiffness(starts):
    rng = np.random.default_rng(1)
    stiffness, state, last = rng.uniform(5.0, 15.0, 50), rng.normal(size=3), -0.4
    changes = rng.normal(size=len(starts))
    jerk = last + block_moves(starts, 50) @ np.cumsum(changes)
    predicted = outputs(cached_response(T, starts, 50).at(stiffness), state, last, changes)
    np.testing.assert_allclose(predicted, simulated(*jerk_driven(stiffness), state, jerk), atol=1e-12)


def test_cached_equals_literal_and_recursion_for_varying_stiffness():
    stiffness = np.random.default_rng(2).uniform(5.0, 15.0, 30)
    cached = cached_response(T, tuple(range(30)), 30).at(stiffness)
    for other in (literal_response(*jerk_driven(stiffness)), recursive_response(*jerk_driven(stiffness))):
        for found, expected in zip(cached, other, strict=True):
            np.testing.assert_allclose(found, expected, atol=1e-13)


def test_at_constant_height_it_is_the_time_invariant_form():
    """S_x is F; column j of S_u sums the columns of Φ from j on, because Φ belongs to u and not to Δu."""
    S_x, _, S_u = cached_response(T, tuple(range(50)), 50).at(np.full(50, 9.81))
    F, phi = lti_response(A, B, np.array([1.0, 0.0, -1.0 / 9.81]), 50)
    np.testing.assert_allclose(S_x, F, atol=1e-13)
    np.testing.assert_allclose(S_u, np.cumsum(phi[:, ::-1], axis=1)[:, ::-1], atol=1e-13)


def test_the_printed_zero_row_of_s_u_would_be_wrong():
    """Negative control of the erratum: y(1) does depend on the first change of the jerk."""
    _, S_u1, S_u = cached_response(T, (0, 1), 50).at(np.full(50, 9.81))
    assert S_u[0, 0] == S_u1[0] == pytest.approx(T**3 / 6 - T / 9.81)
    assert S_u[0, 1] == 0.0
