import numpy as np
import pytest
from pendulum_walk import pushing_force

from surefoot.forces import Push
from surefoot.planner.plants import Pendulum

pytestmark = pytest.mark.unit

SQUARE = 0.0375 * np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])


def test_one_step_is_many_small_ones():
    one, many = (Pendulum(100.0, np.array([0.01, 0.0]), np.array([0.0, 0.1])) for _ in range(2))
    zmp, force = np.array([0.02, 0.01]), np.array([30.0, -10.0])
    one.advance(0.1, zmp, SQUARE, 9.0, force)
    for _ in range(100):
        many.advance(0.001, zmp, SQUARE, 9.0, force)
    np.testing.assert_allclose(one.position, many.position, atol=1e-14)
    np.testing.assert_allclose(one.velocity, many.velocity, atol=1e-13)


def test_zmp_never_leaves_the_real_support():
    pendulum = Pendulum(100.0, np.zeros(2), np.zeros(2))
    pendulum.advance(0.01, np.array([1.0, 0.01]), SQUARE, 9.81, np.zeros(2))
    np.testing.assert_allclose(pendulum.zmp, [0.0375, 0.01])


def test_without_control_it_falls():
    pendulum = Pendulum(100.0, np.array([0.001, 0.0]), np.zeros(2))
    for _ in range(400):
        pendulum.advance(0.01, np.zeros(2), SQUARE, 9.81, np.zeros(2))
    assert pendulum.fallen(SQUARE, 3.13)


def test_push_gives_its_impulse():
    push = Push(0.1, 0.05, np.array([200.0, 0.0, 0.0]))
    forces = [pushing_force((push,), 0.01 * k)[0] for k in range(30)]
    assert sum(forces) * 0.01 == pytest.approx(10.0)
