import numpy as np
import pytest

from surefoot.planner.plants import CartTable

pytestmark = pytest.mark.unit


def test_executes_the_jerk_and_says_the_zmp_of_the_pendulum():
    cart, jerk = CartTable(80.0, np.array([0.1, -0.2])), np.array([6.0, -3.0])
    for _ in range(50):
        cart.advance(0.002, jerk, 9.81, np.zeros(2))
    np.testing.assert_allclose(cart.position, [0.1 + 6e-3 / 6, -0.2 - 3e-3 / 6], atol=1e-14)
    np.testing.assert_allclose(cart.acceleration, [0.6, -0.3], atol=1e-14)
    np.testing.assert_allclose(9.81 * (cart.position - cart.zmp), cart.acceleration, atol=1e-13)


def test_a_push_is_a_change_of_velocity():
    pushed = CartTable(80.0, np.zeros(2))
    for _ in range(5):
        pushed.advance(0.002, np.zeros(2), 9.81, np.array([40.0, 0.0]))
    np.testing.assert_allclose(pushed.velocity, [40.0 * 0.01 / 80.0, 0.0], atol=1e-15)
    np.testing.assert_allclose(pushed.position, [0.5 * 0.5 * 0.01**2, 0.0], atol=1e-15)
    np.testing.assert_array_equal(pushed.acceleration, 0.0)
