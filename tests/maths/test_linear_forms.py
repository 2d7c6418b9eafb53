"""The two forms of linear algebra, compiled and by numpy, do the same."""

from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from surefoot.maths import linear

pytestmark = pytest.mark.unit


@pytest.fixture(scope="module")
def by_numpy():
    spec = spec_from_file_location("linear_by_numpy", Path(linear.__file__).with_name("linear.py"))
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def forms(by_numpy):
    return linear, by_numpy


def both(forms, name, *given):
    """Results that both forms write or return, of copies of what is given."""
    found = []
    for form in forms:
        copies = [value.copy() if isinstance(value, np.ndarray) else value for value in given]
        answer = getattr(form, name)(*copies)
        found.append([value for value in copies if isinstance(value, np.ndarray)] if answer is None else [answer])
    for one, other in zip(*found, strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-13, atol=1e-13)
    return found[0]


def test_rows_are_copied_and_scaled_into_a_part_of_a_matrix(forms, rng):
    A, out, scale = rng.normal(size=(5, 7)), rng.normal(size=(6, 12)), rng.normal(size=3)
    copied = both(forms, "copy_rows", out, 2, A, 1, 3)[0]
    np.testing.assert_array_equal(copied[2:5, :7], A[1:4])
    scaled = both(forms, "scale_rows", out, 4, 2.0, scale, A, 1)[0]
    np.testing.assert_allclose(scaled[:3, 4:11], 2.0 * scale[:, None] * A[1:4])
    added = both(forms, "add_row", out, 1, -3.0, A, 2)[0]
    np.testing.assert_allclose(added[1, :7], out[1, :7] - 3.0 * A[2])
    turned = both(forms, "put_transposed", rng.normal(size=(9, 12)), 2, 3, -0.5, A)[0]
    np.testing.assert_array_equal(turned[2:9, 3:8], -0.5 * A.T)
    for changed, rows, columns in ((copied, slice(2, 5), slice(7)), (scaled, slice(3), slice(4, 11))):
        changed[rows, columns] = out[rows, columns]
        np.testing.assert_array_equal(changed, out)


def test_products_of_rows_that_are_mostly_zero(forms, rng):
    T, t = rng.normal(size=(6, 9)), rng.normal(size=6)
    T[:2, 3:], T[2:4, :5], T[4] = 0.0, 0.0, 0.0
    H = both(forms, "gram", T, np.full((9, 9), 7.0))[1]
    np.testing.assert_array_equal(H, H.T)
    np.testing.assert_allclose(H, T.T @ T, atol=1e-12)
    np.testing.assert_allclose(both(forms, "transposed_product", T, t, np.full(9, 7.0))[2], T.T @ t, atol=1e-12)


def test_columns_of_a_jacobian_are_seen_as_pinocchio_sees_motions(forms, rng):
    R, p, motions = pin.exp3(rng.normal(size=3)), rng.normal(size=3), rng.normal(size=(6, 8))
    columns, before = np.array([1, 4, 5]), np.full((6, 8), 7.0)
    out = both(forms, "see_columns", R, p, motions, columns, before)[-1]
    frame = pin.SE3(R, p)
    for j in range(8):
        seen = frame.actInv(pin.Motion(motions[:, j])).vector if j in columns else before[:, j]
        np.testing.assert_allclose(out[:, j], seen, atol=1e-12)


def test_how_far_one_rotation_is_from_another(forms, rng):
    A, B, C = (pin.exp3(rng.normal(size=3)) for _ in range(3))
    assert both(forms, "distance_squared", A, B, C)[0] == pytest.approx(((A.T @ B - C) ** 2).sum())


@pytest.fixture
def rng():
    return np.random.default_rng(3)
