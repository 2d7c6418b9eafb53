"""Linear algebra of the laws, by numpy and LAPACK; `linear.pyx` is what a compiled module calls in its place.

These are the only functions that stand twice: a loop over matrices would take a hundred times as long interpreted.
Arguments are arrays whose last axis is contiguous. Sizes are those of the arrays.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lapack, solve_triangular

Array = NDArray[np.float64]


def dot(a: Array, b: Array) -> float:
    """Inner product a' b, shape (n,) each."""
    return float(a @ b)


def row_dot(A: Array, i: int, x: Array) -> float:
    """A row of a matrix, of shape (m, n), times a vector, shape (n,)."""
    return float(A[i] @ x)


def rows_dot(A: Array, i: int, B: Array, j: int) -> float:
    """A row of one matrix times a row of another one, of n numbers each."""
    return float(A[i] @ B[j])


def factor(A: Array) -> bool:
    """U with A = U' U, in the upper triangle of A, shape (n, n); its diagonal holds the reciprocals.

    Returns:
        Whether A is not positive definite; it is of no use then.
    """
    U, info = lapack.dpotrf(A, lower=0, clean=1)
    if info:
        return True
    upper = np.triu_indices(len(A))
    A[upper] = U[upper]
    np.fill_diagonal(A, 1.0 / np.diag(U))
    return False


def forward_solve(U: Array, B: Array) -> None:
    """Solve U' Y = B in place, of a factor of `factor`, for right sides that are the columns of B, shape (n, k)."""
    B[:] = solve_triangular(_whole(U), B, trans="T", check_finite=False)


def forward_solve_one(U: Array, b: Array) -> None:
    """The same for one right side, shape (n,)."""
    b[:] = solve_triangular(_whole(U), b, trans="T", check_finite=False)


def backward_solve(U: Array, x: Array) -> None:
    """Solve U x = b in place, shape (n,)."""
    x[:] = solve_triangular(_whole(U), x, check_finite=False)


def subtract_products(S: Array, Y: Array) -> None:
    """S -= Y' Y in the upper triangle of S and right of it, shape (m, k), for Y of shape (n, k), k at least m."""
    S -= np.triu(Y[:, : len(S)].T @ Y)


def copy_rows(out: Array, i: int, A: Array, k: int, count: int) -> None:
    """Put so many rows of A from row k on, shape (m, n), into the first columns of another matrix from row i on."""
    out[i : i + count, : A.shape[1]] = A[k : k + count]


def scale_rows(out: Array, first: int, factor: float, scale: Array, A: Array, k: int) -> None:
    """Put rows of A from row k on, shape (m, n), each times its scale and a factor, into a matrix from a column on."""
    rows = A[k : k + len(scale)]
    np.multiply(rows, (scale * factor)[:, None], out=out[: len(scale), first : first + A.shape[1]])


def add_row(out: Array, i: int, factor: float, A: Array, k: int) -> None:
    """Add a multiple of row k of A, shape (m, n), to the first columns of row i of another matrix."""
    out[i, : A.shape[1]] += factor * A[k]


def put_transposed(out: Array, i: int, j: int, factor: float, A: Array) -> None:
    """Put a multiple of A', for A of shape (m, n), into another matrix, from row i and column j on."""
    m, n = A.shape
    np.multiply(A.T, factor, out=out[i : i + n, j : j + m])


def see_columns(R: Array, p: Array, motions: Array, columns: NDArray[np.int64], out: Array) -> None:
    """Write some columns of a Jacobian, shape (6, n): those of another one, as `algebra.see_motion` sees each.

    That is R' (v - p x ω) and R' ω, with rotation R and origin p, shape (3,), of the frame from which they are seen.
    """
    x, y, z = p
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    linear, angular = motions[:3, columns], motions[3:, columns]
    out[:3, columns], out[3:, columns] = R.T @ (linear - cross @ angular), R.T @ angular


def distance_squared(A: Array, B: Array, C: Array) -> float:
    """Sum of the squares of A' B - C, of matrices of shape (3, 3)."""
    difference = (A.T @ B - C).ravel()
    return float(difference @ difference)


def gram(T: Array, H: Array) -> None:
    """H = T' T, for T of shape (m, n)."""
    np.matmul(T.T, T, out=H)


def transposed_product(T: Array, t: Array, g: Array) -> None:
    """Write T' t into g, for T of shape (m, n)."""
    np.matmul(t, T, out=g)


def fused_sum(a: float, x: float, b: float, y: float, c: float, z: float) -> float:
    """Sum a x + b y + c z, rounded once a term, as numpy's library sums on processors that fuse."""
    return float(np.array([a, b, c]) @ np.array([x, y, z]))


def _whole(U: Array) -> Array:
    """The factor with its diagonal itself."""
    whole = np.triu(U)
    np.fill_diagonal(whole, 1.0 / np.diag(U))
    return whole
