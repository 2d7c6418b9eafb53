import numpy as np
import pytest

from surefoot.planner.model.jerk import zmp_response
from surefoot.planner.model.nominal import NominalMotion, nominal_motion

pytestmark = pytest.mark.unit

T = 0.02


@pytest.fixture
def footsteps():
    """A ZMP that jumps half a metre in a tenth of a second, and a stiffness that varies."""
    rng = np.random.default_rng(0)
    time = T * np.arange(150)
    zmp = np.column_stack(
        [0.5 * np.interp(time % 0.5, [0.0, 0.4, 0.5], [0.0, 0.0, 1.0]) + 0.5 * (time // 0.5), 0.1 * time]
    )
    return zmp, rng.uniform(9.0, 12.0, 150)


def test_motion_has_the_zmp_it_was_asked_for(footsteps):
    zmp, stiffness = footsteps
    motion = nominal_motion(np.array([0.1, -0.05]), zmp, stiffness, T)
    inner = slice(1, -1)
    np.testing.assert_allclose(zmp_response(motion.com, stiffness)[inner], zmp[inner], atol=1e-12)


def test_constant_jerk_leads_from_sample_to_sample(footsteps):
    zmp, stiffness = footsteps
    motion = nominal_motion(np.array([0.1, -0.05]), zmp, stiffness, T)
    A = np.array([[1.0, T, T * T / 2], [0.0, 1.0, T], [0.0, 0.0, 1.0]])
    B = np.array([T**3 / 6, T * T / 2, T])
    following = np.einsum("ij,jkx->ikx", A, motion.com[:, :-1]) + B[:, None, None] * motion.jerk
    np.testing.assert_allclose(following, motion.com[:, 1:], atol=1e-12)


def test_it_starts_where_it_is_told_and_does_not_diverge(footsteps):
    zmp, stiffness = footsteps
    motion = nominal_motion(np.array([0.3, -0.2]), zmp, stiffness, T)
    np.testing.assert_array_equal(motion.com[0, 0], [0.3, -0.2])
    np.testing.assert_array_equal(motion.com[0, -1], zmp[-1])
    assert np.abs(motion.com[0] - zmp).max() < 0.6


def test_over_a_constant_zmp_it_is_the_decaying_exponential():
    motion = nominal_motion(np.array([0.1, 0.0]), np.zeros((200, 2)), np.full(200, 9.81), T)
    time, omega = T * np.arange(100), np.sqrt(9.81)
    np.testing.assert_allclose(motion.com[0, :100, 0], 0.1 * np.exp(-omega * time), atol=2e-5)
    assert motion.com[1, 0, 0] == pytest.approx(-omega * 0.1, rel=1e-3)


def test_a_motion_that_follows_nothing_rests_at_the_origin():
    motion = NominalMotion(T, 5)
    assert not (motion.com.any() or motion.jerk.any())


def test_a_motion_that_is_told_something_else_forgets_what_it_followed(footsteps):
    zmp, stiffness = footsteps
    motion = nominal_motion(np.array([0.3, -0.2]), zmp[::-1], stiffness[::-1], T)
    motion.follow(np.array([0.1, -0.05]), zmp, stiffness)
    fresh = nominal_motion(np.array([0.1, -0.05]), zmp, stiffness, T)
    np.testing.assert_array_equal(motion.com, fresh.com)
    np.testing.assert_array_equal(motion.jerk, fresh.jerk)
