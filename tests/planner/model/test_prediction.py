import numpy as np
import pytest

from surefoot.planner.model.jerk import BLOCK_STARTS, block_moves, predict, zmp_response

pytestmark = pytest.mark.unit

T = 0.02


def test_prediction_equals_step_by_step_simulation_for_random_stiffness():
    rng = np.random.default_rng(0)
    prediction = predict(T, block_moves(BLOCK_STARTS, 50))
    stiffness, moves, start = rng.uniform(5.0, 15.0, 51), rng.normal(size=10), rng.normal(size=3)
    A = np.array([[1.0, T, T * T / 2], [0.0, 1.0, T], [0.0, 0.0, 1.0]])
    B = np.array([T**3 / 6, T * T / 2, T])
    states = [start]
    for u in prediction.basis @ moves:
        states.append(A @ states[-1] + B * u)
    simulated = np.array([x[0] - x[2] / w for x, w in zip(states, stiffness, strict=True)])
    predicted = zmp_response(prediction.state, stiffness) @ start + zmp_response(prediction.moves, stiffness) @ moves
    np.testing.assert_allclose(predicted, simulated, atol=1e-12)
    com = prediction.state @ start + prediction.samples @ (prediction.basis @ moves)
    np.testing.assert_allclose(com.T, states, atol=1e-12)


def test_constant_stiffness_gives_the_time_invariant_matrices():
    prediction = predict(T, np.eye(6))
    A = np.array([[1.0, T, T * T / 2], [0.0, 1.0, T], [0.0, 0.0, 1.0]])
    B = np.array([T**3 / 6, T * T / 2, T])
    C = np.array([1.0, 0.0, -1.0 / 9.81])
    Y = zmp_response(prediction.moves, np.full(7, 9.81))
    for i in range(1, 7):
        for j in range(i):
            assert Y[i, j] == pytest.approx(C @ np.linalg.matrix_power(A, i - j - 1) @ B, abs=1e-14)


def test_last_block_is_kept_until_the_horizon():
    np.testing.assert_array_equal(block_moves((0, 1), 4) @ [1.0, 2.0], [1.0, 2.0, 2.0, 2.0])


@pytest.mark.parametrize("starts", [(), (1, 2), (0, 2, 2), (0, 50)])
def test_bad_blocks_are_refused(starts):
    with pytest.raises(ValueError, match="must increase from 0"):
        block_moves(starts, 50)
