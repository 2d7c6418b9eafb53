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


def test_vectors_are_those_of_numpy(rng):
    a, b = rng.normal(size=3), rng.normal(size=3)
    s, t = tuple(a), tuple(b)
    np.testing.assert_allclose(algebra.add(s, t), a + b)
    np.testing.assert_allclose(algebra.subtract(s, t), a - b)
    np.testing.assert_allclose(algebra.scale(-1.7, s), -1.7 * a)
    np.testing.assert_allclose(algebra.squares(s), a * a)
    np.testing.assert_allclose(algebra.cross(s, t), np.cross(a, b))
    assert algebra.inner(s, t) == pytest.approx(a @ b)
    assert algebra.square(-1.5) == 2.25


def test_hat_of_a_vector_is_its_cross_product(rng):
    a, b, hat = rng.normal(size=3), rng.normal(size=3), np.full((3, 3), 7.0)
    algebra.put_cross(hat, tuple(a))
    np.testing.assert_allclose(hat @ b, np.cross(a, b))
    np.testing.assert_array_equal(hat, -hat.T)


def test_rows_and_columns_are_written_where_they_are_read(rng):
    A, a = rng.normal(size=(4, 5)), tuple(rng.normal(size=3))
    put_row, put_column = A.copy(), A.copy()
    algebra.put_row(put_row, 2, a, 1)
    algebra.put_column(put_column, 3, a, 1)
    assert algebra.row(put_row, 2, 1) == algebra.column(put_column, 3, 1) == a
    put_row[2, 1:4], put_column[1:4, 3] = A[2, 1:4], A[1:4, 3]
    np.testing.assert_array_equal(put_row, A)
    np.testing.assert_array_equal(put_column, A)


def test_rotations_turn_vectors_and_follow_each_other(rng):
    A, B = pin.exp3(rng.normal(size=3)), pin.exp3(rng.normal(size=3))
    a, out = rng.normal(size=3), np.empty((3, 3))
    np.testing.assert_allclose(algebra.rotate(A, tuple(a)), A @ a)
    np.testing.assert_allclose(algebra.rotate_back(A, tuple(a)), A.T @ a)
    algebra.compose(A, B, out)
    np.testing.assert_allclose(out, A @ B)
    algebra.compose_back(A, B, out)
    np.testing.assert_allclose(out, A.T @ B)
    assert algebra.columns_inner(A, 1, B, 2) == pytest.approx(A[:, 1] @ B[:, 2])


@pytest.mark.parametrize("size", [0.0, 1e-9, 5e-5, 2e-4, 0.3, 2.9])
def test_rotation_vectors_are_those_of_pinocchio(rng, size):
    a, R = rng.normal(size=3), np.empty((3, 3))
    a *= size / np.linalg.norm(a)
    algebra.rotation_of(tuple(a), R)
    np.testing.assert_allclose(R, pin.exp3(a), atol=1e-14)
    np.testing.assert_allclose(algebra.rotation_vector(R), a, rtol=1e-7, atol=1e-13)


@pytest.mark.parametrize("axis", [None, (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)])
def test_quaternions_are_those_of_pinocchio(rng, axis):
    """Half a turn about each axis and nearly so takes each way to the largest of the four numbers."""
    a = rng.normal(size=3) if axis is None else 3.1 * np.array(axis) + 0.02 * rng.normal(size=3)
    R, out = pin.exp3(a), np.empty(4)
    algebra.quaternion(R, out)
    found = pin.SE3ToXYZQUAT(pin.SE3(R, np.zeros(3)))[3:]
    np.testing.assert_allclose(out, found, atol=1e-12)
    np.testing.assert_allclose(algebra.quaternion_rows(*out), R, atol=1e-12)


def test_the_nearest_value_in_an_interval():
    for law in (algebra.between, algebra.clamp):
        assert [law(x, -1.0, 2.0) for x in (-3.0, 0.5, 4.0)] == [-1.0, 0.5, 2.0]
    assert algebra.between(0.0, 3.0, 1.0) == 1.0
    assert algebra.clamp(0.0, 3.0, 1.0) == 3.0
