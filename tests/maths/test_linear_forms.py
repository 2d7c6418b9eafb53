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


def both(forms, name, *given, where=None):
    """Results that both forms write or return, of copies of what is given; with `where`, its last array there alone."""
    found = []
    for form in forms:
        copies = [value.copy() if isinstance(value, np.ndarray) else value for value in given]
        answer = getattr(form, name)(*copies)
        written = [value for value in copies if isinstance(value, np.ndarray)]
        found.append(([written[-1][where]] if where is not None else written) if answer is None else [answer])
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


@pytest.mark.parametrize("n", range(1, 10))
def test_products_are_those_of_numpy(forms, rng, n):
    """Their length may be any: loops take four terms at a time, and what is left."""
    A, B, C, x, y = *(rng.normal(size=(n, n)) for _ in range(3)), rng.normal(size=n), rng.normal(size=n)
    one, other = np.array([n - 1, 0]), np.array([0, n // 2])
    for name, given, expected in (
        ("dot", (x, y), x @ y),
        ("row_dot", (A, n - 1, x), A[n - 1] @ x),
        ("part_dot", (A, 0, x, n // 3, n), A[0, n // 3 :] @ x[n // 3 :]),
        ("rows_dot", (A, 0, B, n - 1), A[0] @ B[n - 1]),
        ("quadratic", (A, x), x @ A @ x),
        ("add_scaled", (x, -1.3, y), x - 1.3 * y),
        ("multiply", (A, x, y), A @ x),
        ("product", (A, B, C), A @ B),
        ("accumulate", (C, A, B), C + A @ B),
        ("add_multiple", (C, -1.3, A), C - 1.3 * A),
        ("add_multiples", (C, -1.3, A, 0.7, B), C - 1.3 * A + 0.7 * B),
        ("differences", (A, one, other, C[:, :1].repeat(2, axis=1)), A[:, one] - A[:, other]),
        ("row_products", (A, B, C), A @ B.T),
        ("add_product", (-1.3, A, x, y), y - 1.3 * A @ x),
        ("add_transposed_product", (-1.3, A, x, y), y - 1.3 * A.T @ x),
        ("row_sizes", (A, x), np.linalg.norm(A, axis=1)),
        ("evaluate_polynomials", (A, 0.7, x), 0.7 ** np.arange(n) @ A),
        ("downdate", (A, B), 0.5 * (A + A.T) - B.T @ B),
    ):
        first = name.startswith(("add_scaled", "accumulate", "add_multiple", "downdate"))
        found = both(forms, name, *given)
        np.testing.assert_allclose(
            found[0 if first or np.ndim(expected) == 0 else -1], expected, atol=1e-12, err_msg=name
        )


@pytest.mark.parametrize("n", range(1, 10))
def test_products_that_are_symmetric_are_made_on_and_right_of_the_diagonal(forms, rng, n):
    A, B, wide = rng.normal(size=(n + 2, n)), rng.normal(size=(n + 2, n)), rng.normal(size=(n + 2, n + 3))
    S, square = rng.normal(size=(n, n + 3)), rng.normal(size=(n, n))
    upper, part = np.triu(np.ones((n, n), dtype=bool)), np.triu(np.ones((n, n + 3), dtype=bool))
    gram = wide[:, :n].T @ wide
    for name, expected in (("subtract_products", S - gram), ("add_gram", S + gram), ("products", gram)):
        given = (wide, S) if name == "products" else (S, wide)
        found = both(forms, name, *given)[1 if name == "products" else 0]
        np.testing.assert_allclose(found[part], expected[part], atol=1e-12, err_msg=name)
    found = both(forms, "add_products", square, A, B)[0]
    np.testing.assert_allclose(found[upper], (square + A.T @ B)[upper], atol=1e-12)
    np.testing.assert_allclose(
        both(forms, "upper_product", A.T.copy(), B.T.copy(), square, where=upper)[0], (A.T @ B)[upper], atol=1e-12
    )
    np.testing.assert_array_equal(both(forms, "mirror", square)[0], np.triu(square) + np.triu(square, 1).T)


@pytest.mark.parametrize("n", range(1, 10))
def test_triangles_are_solved(forms, rng, n):
    """A factor gives its matrix again, and its solutions are those of the equations."""
    half = rng.normal(size=(n + 2, n))
    A, B, b = half.T @ half + np.eye(n), rng.normal(size=(n, 5)), rng.normal(size=n)
    factor = A.copy()
    for form in forms:
        made = A.copy()
        assert not form.factor(made)
        factor = np.triu(made)
        np.fill_diagonal(factor, 1.0 / np.diag(made))
        np.testing.assert_allclose(factor.T @ factor, A, atol=1e-12)
    U = np.triu(factor)
    np.testing.assert_allclose(U.T @ both(forms, "forward_solve", made, B)[1], B, atol=1e-10)
    np.testing.assert_allclose(U.T @ both(forms, "forward_solve_one", made, b)[1], b, atol=1e-10)
    np.testing.assert_allclose(U @ both(forms, "backward_solve", made, b)[1], b, atol=1e-10)
    columns = both(forms, "inverse_columns", made, np.zeros((n, n)))[1]
    np.testing.assert_allclose(U @ columns.T, np.eye(n), atol=1e-10)
    np.testing.assert_allclose(A @ both(forms, "inverse", made, np.full((n, n), 7.0))[1], np.eye(n), atol=1e-10)
    count = n - n // 3
    solved = both(forms, "upper_solve", U, count, b)[1]
    np.testing.assert_allclose(U[:count, :count] @ solved[:count], b[:count], atol=1e-10)
    np.testing.assert_array_equal(solved[count:], b[count:])
    for form in forms:
        assert form.factor(A - (1.0 + np.linalg.eigvalsh(A)[0]) * np.eye(n))


@pytest.mark.parametrize("n", range(2, 10))
def test_a_tridiagonal_system_is_solved(forms, rng, n):
    lower, upper, X = rng.normal(size=n), rng.normal(size=n), rng.normal(size=(n, 3))
    diagonal = 3.0 + abs(lower) + abs(upper)
    A = np.diag(diagonal) + np.diag(lower[1:], -1) + np.diag(upper[:-1], 1)
    for form in forms:
        found = X.copy()
        form.solve_tridiagonal(lower.copy(), diagonal.copy(), upper.copy(), found)
        np.testing.assert_allclose(A @ found, X, atol=1e-12)


def test_two_rows_are_rotated_until_one_number_is_zero(forms, rng):
    A = rng.normal(size=(4, 6))
    turned = both(forms, "rotate_rows", A, 1, A[1, 2], A[2, 2])[0]
    assert turned[1, 2] == pytest.approx(np.hypot(A[1, 2], A[2, 2])) and abs(turned[2, 2]) < 1e-15
    np.testing.assert_allclose(turned.T @ turned, A.T @ A, atol=1e-12)


def test_what_violates_its_bounds_most(forms):
    values, lower, upper = np.array([0.2, -0.4, 1.1]), np.array([-1.0, -0.1, 0.0]), np.array([0.0, 1.0, 1.05])
    assert both(forms, "excess", values, lower, upper)[0] == pytest.approx(0.3)
    assert both(forms, "excess", values, lower - 1.0, upper - 0.1)[0] == pytest.approx(0.3)
    assert both(forms, "excess", values, lower - 1.0, upper + 1.0)[0] == 0.0


@pytest.fixture
def rng():
    return np.random.default_rng(3)
