"""Vectors, rotations, motions and wrenches against Pinocchio."""

import numpy as np
import pinocchio as pin
import pytest

from surefoot.maths import algebra

pytestmark = pytest.mark.unit


@pytest.fixture(params=range(5))
def rng(request):
    return np.random.default_rng(request.param)


def test_a_turn_between_two_rotations_is_its_logarithm(rng):
    A, B = pin.exp3(rng.normal(size=3)), pin.exp3(0.5 * rng.normal(size=3))
    np.testing.assert_allclose(algebra.turn_between(A, A @ B), pin.log3(B), atol=1e-12)
    np.testing.assert_allclose(algebra.turn_between(A, A), 0.0, atol=1e-15)


def test_motions_and_wrenches_go_between_frames(rng):
    frame = pin.SE3(pin.exp3(rng.normal(size=3)), rng.normal(size=3))
    motion, R, p = rng.normal(size=6), frame.rotation, tuple(frame.translation)
    seen = algebra.see_motion(R, p, tuple(motion[:3]), tuple(motion[3:]))
    np.testing.assert_allclose(np.concatenate(seen), frame.actInv(pin.Motion(motion)).vector, atol=1e-12)
    wrench = np.full((6, 6), 7.0)
    algebra.see_wrench(R, p, wrench)
    np.testing.assert_allclose(wrench, frame.toDualActionMatrix(), atol=1e-12)
