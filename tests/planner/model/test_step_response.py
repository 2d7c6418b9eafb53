import numpy as np
import pytest

from surefoot.planner.model.jerk import BLOCK_STARTS, block_moves
from surefoot.planner.model.step_response import cached_response, literal_response, lti_response, recursive_response

pytestmark = pytest.mark.unit

T = 0.02
A = np.array([[1.0, T, T * T / 2], [0.0, 1.0, T], [0.0, 0.0, 1.0]])
B = np.array([T**3 / 6, T * T / 2, T])


def jerk_driven(stiffness):
    """A(k), B(k), C(k) of eq. (4) for λ at samples 1..N."""
    n = len(stiffness)
    C = np.stack([np.ones(n), np.zeros(n), -1.0 / stiffness], axis=1)
    return np.tile(A, (n, 1, 1)), np.tile(B, (n, 1)), C


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
    np.testing.assert_allclose(response.outputs(state, last, changes), expected, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("starts", [(0, 1), BLOCK_STARTS, tuple(range(50))])
def test_cached_matrices_equal_simulation_for_random_stiffness(starts):
    rng = np.random.default_rng(1)
    stiffness, state, last = rng.uniform(5.0, 15.0, 50), rng.normal(size=3), -0.4
    changes = rng.normal(size=len(starts))
    jerk = last + block_moves(starts, 50) @ np.cumsum(changes)
    predicted = cached_response(T, starts, 50).at(stiffness).outputs(state, last, changes)
    np.testing.assert_allclose(predicted, simulated(*jerk_driven(stiffness), state, jerk), atol=1e-12)


def test_cached_equals_literal_and_recursion_for_varying_stiffness():
    stiffness = np.random.default_rng(2).uniform(5.0, 15.0, 30)
    cached = cached_response(T, tuple(range(30)), 30).at(stiffness)
    for other in (literal_response(*jerk_driven(stiffness)), recursive_response(*jerk_driven(stiffness))):
        np.testing.assert_allclose(cached.S_x, other.S_x, atol=1e-13)
        np.testing.assert_allclose(cached.S_u1, other.S_u1, atol=1e-13)
        np.testing.assert_allclose(cached.S_u, other.S_u, atol=1e-13)


def test_at_constant_height_it_is_the_time_invariant_form():
    """S_x is F; column j of S_u sums the columns of Φ from j on, because Φ belongs to u and not to Δu."""
    response = cached_response(T, tuple(range(50)), 50).at(np.full(50, 9.81))
    F, phi = lti_response(A, B, np.array([1.0, 0.0, -1.0 / 9.81]), 50)
    np.testing.assert_allclose(response.S_x, F, atol=1e-13)
    np.testing.assert_allclose(response.S_u, np.cumsum(phi[:, ::-1], axis=1)[:, ::-1], atol=1e-13)


def test_the_printed_zero_row_of_s_u_would_be_wrong():
    """Negative control of the erratum: y(1) does depend on the first change of the jerk."""
    response = cached_response(T, (0, 1), 50).at(np.full(50, 9.81))
    assert response.S_u[0, 0] == response.S_u1[0] == pytest.approx(T**3 / 6 - T / 9.81)
    assert response.S_u[0, 1] == 0.0
