"""Linear algebra of the laws, by numpy and LAPACK; `linear.pyx` is what a compiled module calls in its place.

These are the only functions that stand twice: a loop over matrices would take a hundred times as long interpreted.
Arguments are arrays whose last axis is contiguous. Sizes are those of the arrays.
"""

import math

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import blas, lapack

Array = NDArray[np.float64]


def dot(a: Array, b: Array) -> float:
    """Inner product a' b, shape (n,) each."""
    return float(a @ b)


def row_dot(A: Array, i: int, x: Array) -> float:
    """A row of a matrix, of shape (m, n), times a vector, shape (n,)."""
    return float(A[i] @ x)


def add_scaled(y: Array, a: float, x: Array) -> None:
    """Add a x to y, shape (n,) each."""
    y += a * x


def multiply(A: Array, x: Array, out: Array) -> None:
    """A x into `out`, shape (m,), for A of shape (m, n)."""
    np.matmul(A, x, out=out)


def quadratic(A: Array, x: Array) -> float:
    """Quadratic form x' A x, for A of shape (n, n) and x of shape (n,), much of which may be zeros."""
    return float(x @ A @ x)


def part_dot(A: Array, i: int, x: Array, first: int, end: int) -> float:
    """The same of the numbers from one place to before another one."""
    return float(A[i, first:end] @ x[first:end])


def rows_dot(A: Array, i: int, B: Array, j: int) -> float:
    """A row of one matrix times a row of another one, of n numbers each."""
    return float(A[i] @ B[j])


def factor(A: Array) -> bool:
    """U with A = U' U, in the upper triangle of A, shape (n, n); its diagonal holds the reciprocals.

    Returns:
        Whether A is not positive definite; it is of no use then.
    """
    U, info = lapack.dpotrf(A, lower=0, clean=1)
    # LAPACK takes what is no number.
    if info or not (np.diag(U) > 0.0).all():
        return True
    A[:] = np.tril(A, -1) + U
    np.fill_diagonal(A, 1.0 / np.diag(U))
    return False


def forward_solve(U: Array, B: Array) -> None:
    """Solve U' Y = B in place, of a factor of `factor`, for right sides that are the columns of B, shape (n, k)."""
    B[:] = blas.dtrsm(1.0, _whole(U), B, trans_a=1)


def forward_solve_one(U: Array, b: Array) -> None:
    """The same for one right side, shape (n,)."""
    b[:] = blas.dtrsv(_whole(U), b, trans=1)


def backward_solve(U: Array, x: Array) -> None:
    """Solve U x = b in place, shape (n,)."""
    x[:] = blas.dtrsv(_whole(U), x)


def solve_tridiagonal(lower: Array, diagonal: Array, upper: Array, X: Array) -> None:
    """Solve a tridiagonal system in place, for right sides that are the columns of X, shape (n, k).

    Row i is lower_i x_{i-1} + diagonal_i x_i + upper_i x_{i+1}, and its diagonal the largest of the row: there are no
    pivots. The three bands, shape (n,) each, are of no use afterwards.
    """
    X[:] = lapack.dgtsv(lower[1:], diagonal, upper[:-1], X)[3]


def add_gram(S: Array, Y: Array) -> None:
    """S += Y' Y in the upper triangle of S and right of it, shape (m, k), row by row of Y, shape (n, k)."""
    S += np.triu(Y[:, : len(S)].T @ Y)


def upper_product(A: Array, B: Array, out: Array) -> None:
    """A B' into `out`, shape (m, m), on and right of its diagonal, for A and B of shape (m, n)."""
    np.matmul(A, B.T, out=out)


def mirror(A: Array) -> None:
    """Make A symmetric, shape (n, n), by what is on and right of its diagonal."""
    lower = np.tril_indices(len(A), -1)
    A[lower] = A.T[lower]


def inverse_columns(U: Array, out: Array) -> None:
    """Write the columns of U⁻¹, of a factor of `factor`, as rows, shape (n, n)."""
    out[:] = blas.dtrsm(1.0, _whole(U), np.eye(len(U))).T


def row_sizes(A: Array, out: Array) -> None:
    """Write the norm of each row, shape (m,)."""
    out[:] = np.sqrt(np.einsum("ij,ij->i", A, A))


def upper_solve(R: Array, count: int, x: Array) -> None:
    """Solve R x = b in place of the first so many numbers, for an upper triangle that holds its diagonal itself."""
    if count:
        x[:count] = blas.dtrsv(R[:count, :count], x[:count])


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
    """Write some columns of a Jacobian, shape (6, n): those of another one, as `maths.algebra.see_motion` sees each.

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


def nearest(value: float) -> float:
    """The nearest whole number, of two the even one."""
    return float(np.rint(value))


def copy(A: Array, out: Array) -> None:
    """A into `out`, of any shape."""
    out[:] = A


def product(A: Array, B: Array, out: Array) -> None:
    """A B into `out`, shape (m, k), for A of shape (m, n) and B of shape (n, k); axes may lie in any order."""
    out[:] = A @ B


def accumulate(S: Array, A: Array, B: Array) -> None:
    """S += A B, term by term, for A of shape (m, n) and B of shape (n, k); axes may lie in any order."""
    S += A @ B


def add_multiple(S: Array, a: float, A: Array) -> None:
    """S += a A, of any shape; axes may lie in any order."""
    S += a * A


def add_multiples(S: Array, a: float, A: Array, b: float, B: Array) -> None:
    """S += a A + b B, of any shape; axes may lie in any order."""
    S += a * A + b * B


def differences(A: Array, one: NDArray[np.intp], other: NDArray[np.intp], out: Array) -> None:
    """Some columns of A, shape (m, n), less others, into `out`, shape (m, k); axes may lie in any order."""
    np.subtract(A[:, one], A[:, other], out=out)


def row_products(A: Array, B: Array, out: Array) -> None:
    """A B' into `out`, for A of shape (m, n) and B of shape (k, n)."""
    np.matmul(A, B.T, out=out)


def downdate(P: Array, Y: Array) -> None:
    """P made symmetric, and P -= Y' Y, shape (n, n), for Y of shape (k, n)."""
    P[:] = 0.5 * (P + P.T) - Y.T @ Y


def inverse(U: Array, out: Array) -> None:
    """A⁻¹ into `out`, shape (n, n), of a factor of `factor`."""
    half = blas.dtrsm(1.0, _whole(U), np.eye(len(U)), trans_a=1)
    np.matmul(half.T, half, out=out)


def add_products(P: Array, A: Array, B: Array) -> None:
    """Add A' B to the upper triangle of the first n rows and columns of P, for A and B of shape (m, n) each."""
    n = A.shape[1]
    P[:n, :n] += np.triu(A.T @ B)


def products(Y: Array, S: Array) -> None:
    """S = Y' Y in the upper triangle of S and right of it, shape (m, k), for Y of shape (n, k), k at least m."""
    S[:] = np.triu(Y[:, : len(S)].T @ Y)


def add_product(scale: float, A: Array, x: Array, out: Array) -> None:
    """Add scale A x to `out`, for A of shape (m, n)."""
    out += scale * (A @ x)


def add_transposed_product(scale: float, A: Array, y: Array, out: Array) -> None:
    """Add scale A' y to `out`, row by row, for A of shape (m, n)."""
    out += scale * (y @ A)


def evaluate_polynomials(C: Array, t: float, out: Array) -> None:
    """Write values of polynomials at t into the first n numbers of `out`.

    Coefficients of 1, t, ... are the rows of C, shape (m, n), a polynomial a column.
    """
    values = out[: C.shape[1]]
    values[:] = C[-1]
    for row in C[-2::-1]:
        values *= t
        values += row


def rotate_rows(A: Array, i: int, a: float, b: float) -> None:
    """Rotate rows i and i + 1 (Givens) as takes a pair of their numbers, (a, b), to (√(a² + b²), 0)."""
    size = math.sqrt(a * a + b * b)
    c, s = a / size, b / size
    A[i], A[i + 1] = c * A[i] + s * A[i + 1], c * A[i + 1] - s * A[i]


def is_zero(A: Array) -> bool:
    """Return true if a matrix is zero."""
    return not A.any()


def excess(values: Array, lower: Array, upper: Array) -> float:
    """Largest violation of lower <= values <= upper, shape (n,) each; 0 for none, NaN where a value is no number."""
    worst = float(np.maximum(lower - values, values - upper).max())
    return worst if not worst < 0.0 else 0.0


def fill(out: Array, start: int, values: Array) -> None:
    """Copy numbers, shape (n,), into an array from a place on."""
    out[start : start + len(values)] = values


def _whole(U: Array) -> Array:
    """The factor with its diagonal itself, in the upper triangle."""
    whole = U.copy()
    np.fill_diagonal(whole, 1.0 / np.diag(U))
    return whole
