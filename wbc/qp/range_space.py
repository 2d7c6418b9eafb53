"""The whole-body QP in the range space of its constraints: under the equalities alone, and with few inequalities.

With H = UᵀU, the equalities Ex = e, Y = U⁻ᵀEᵀ and w = U⁻ᵀg the multipliers λ of the minimiser solve

    YᵀY λ = e + Yᵀw,    x = U⁻¹ (Yλ - w)

(Boyd and Vandenberghe, Convex Optimization, 2004, section 10.4.2). A robot that walks within its limits rarely touches
an inequality. Where it does, the dual method (see `surefoot.maths.dual_method`) goes on from there with the same
factors.
"""

import math

import numpy as np

from surefoot.maths import algebra, linear
from surefoot.maths.dual_method import DualMethod
from surefoot.wbc.qp.data import EQUALITY_ROWS, FOOT_ROWS, QpData
from surefoot.wbc.types import Array

MOST_ACTIVE = 16
"""Active inequalities that it takes; with more of them DAQP is as fast [-]."""

DEPENDENT = 1e-18
"""Share of a normal that may be left beside those of what is active, squared, without being taken for none [-]."""

MOST_ROUNDS = 60
"""Steps after which it gives up [-]."""


class Block:
    """Variables whose products in H are among themselves: their parts of `EqualityQp.U`, `EqualityQp.Yw` and x."""

    def __init__(self, U: Array, Yw: Array, x: Array) -> None:
        self.U, self.Yw, self.x = U, Yw, x


class EqualityQp:
    """A QP under its equalities alone.

    Args:
        qp: which is solved as it is at each call; its n variables are the accelerations, then the wrenches.

    Attributes:
        qp: the problem that is solved.
        x: the minimiser found last, shape (n,).
        values: that and then A x, shape (n + rows,).
        A, lower, upper: of the QP.
        U: the factor of H, shape (n, n).
        Y: see above, shape (n, m).
        R: factor of YᵀY, so that Y R⁻¹ is orthonormal, shape (m, m).
    """

    def __init__(self, qp: QpData) -> None:
        self.qp, n, m = qp, len(qp.g), EQUALITY_ROWS
        self._H = qp.H
        self._g = qp.g
        self.A = qp.A
        self.lower = qp.bounds_lower
        self.upper = qp.bounds_upper
        self.U, self.x, self.values = np.zeros((n, n)), np.zeros(n), np.zeros(len(qp.bounds_lower))
        self._x, self._row_values = self.x, self.values[n:]
        # Y, then w, and a column of zeros: loops over rows of a multiple of four numbers are faster.
        self.Yw, self._YY = np.zeros((n, m + 2)), np.zeros((m, m + 2))
        self.Y = self.Yw[:, :m]
        self._w = self.Yw[:, m]
        self.R = self._YY[:, :m]
        self._Yw = self._YY[:, m]
        self._multipliers = np.zeros(m)
        # Without tasks on both, accelerations and wrenches do not meet in H.
        self._motion = n - 2 * FOOT_ROWS
        self._whole, self._apart = [self._block(0, n)], [self._block(0, self._motion), self._block(self._motion, n)]

    def _block(self, first: int, end: int) -> Block:
        return Block(self.U[first:end, first:end], self.Yw[first:end], self._x[first:end])

    def solve(self) -> float:
        """Minimise; returns the largest violation of bounds and rows at x.

        It is infinite where H is not positive definite or the equalities contradict each other.
        """
        n, m = len(self._x), len(self._multipliers)
        self.U[:] = self._H
        linear.copy(self.A[:m].T, self.Y)
        self._w[:] = self._g
        is_apart = linear.is_zero(self.U[: self._motion, self._motion :])
        blocks = self._apart if is_apart else self._whole
        for block in blocks:
            if linear.factor(block.U):
                return algebra.INFINITY
            linear.forward_solve(block.U, block.Yw)
        linear.products(self.Yw, self._YY)
        for e in range(m):
            self._multipliers[e] = self.lower[n + e] + self._Yw[e]
        if linear.factor(self.R):
            return algebra.INFINITY
        linear.forward_solve_one(self.R, self._multipliers)
        linear.backward_solve(self.R, self._multipliers)
        linear.multiply(self.Y, self._multipliers, self._x)
        for i in range(n):
            self._x[i] -= self._w[i]
        for block in blocks:
            linear.backward_solve(block.U, block.x)
        return self.violation()

    def violation(self) -> float:
        """Largest violation of bounds and rows at x; NaN where that is none."""
        self.evaluate()
        return linear.excess(self.values, self.lower, self.upper)

    def evaluate(self) -> None:
        """Note x and A x as they are now."""
        self.values[: len(self._x)] = self._x
        linear.multiply(self.A, self._x, self._row_values)


class InequalityQp(DualMethod):
    """Goes on from the minimiser under the equalities, to that under the inequalities as well.

    With the normals N of what is active U⁻ᵀ [Eᵀ N] = Q R; the equalities' part of it stays. Of a normal n⁺, with
    y = U⁻ᵀn⁺ and c = Qᵀy, which solves Rᵀc = [Y U⁻ᵀN]ᵀy, it follows that Rr = c, U z = y - [Y U⁻ᵀN] r and
    zᵀn⁺ = yᵀy - cᵀc. Inequality 2 i is the lower bound of `EqualityQp.values` i, 2 i + 1 its upper one.

    Args:
        equalities: solves the QP first.
        tolerance: largest violation that counts as none.
    """

    def __init__(self, equalities: EqualityQp, tolerance: float) -> None:
        self._qp, self._tolerance, self._m = equalities, tolerance, EQUALITY_ROWS
        super().__init__(2 * len(self._qp.values), MOST_ACTIVE, MOST_ROUNDS, DEPENDENT)
        n, m = len(self._qp.x), self._m
        # Rows are the turned normals U⁻ᵀN, and columns of R, in which the one that is looked at comes last.
        self._normals, self._R = np.zeros((MOST_ACTIVE, n)), np.zeros((MOST_ACTIVE + 1, m + MOST_ACTIVE))
        self._y, self._z, self._shares = np.zeros(n), np.zeros(n), np.zeros(m + MOST_ACTIVE)
        self._equality_r, self.r = self._shares[:m], self._shares[m:]

    def solve(self) -> int:
        """Move x of the equalities' QP to the minimiser; returns the steps that this took, -1 where it gives up."""
        rounds = self.iterate()
        if rounds >= 0:
            self._mend()
        return rounds

    def _violated(self) -> int:
        qp, n = self._qp, len(self._y)
        qp.evaluate()
        number, self.slack = -1, -self._tolerance
        for i in range(len(qp.values)):
            if n <= i < n + self._m:
                continue
            below, above = qp.values[i] - qp.lower[i], qp.upper[i] - qp.values[i]
            is_upper = above < below
            slack = above if is_upper else below
            if not (slack >= self.slack or self.is_active[2 * i + is_upper]):
                number, self.slack = 2 * i + is_upper, slack
        if number >= 0:
            self._turn(number)
        return number

    def _turn(self, number: int) -> None:
        """Note the turned normal y of an inequality."""
        i, n, sign = number // 2, len(self._y), -1.0 if number % 2 else 1.0
        self._y[:] = 0.0
        if i < n:
            self._y[i] = sign
        else:
            linear.add_scaled(self._y, sign, self._qp.A[i - n])
        linear.forward_solve_one(self._qp.U, self._y)

    def _project(self) -> None:
        self.curvature = self._column(self._y, self.count)
        self.whole = linear.dot(self._y, self._y)
        self._solve(self._R[self.count])

    def _move(self, step: float) -> None:
        self._z[:] = self._y
        linear.add_product(-1.0, self._qp.Y, self._equality_r, self._z)
        linear.add_transposed_product(-1.0, self._normals[: self.count], self.r[: self.count], self._z)
        linear.backward_solve(self._qp.U, self._z)
        linear.add_scaled(self._qp._x, step, self._z)

    def _take(self) -> None:
        self._normals[self.count] = self._y
        self._R[self.count, self._m + self.count] = math.sqrt(self.curvature)

    def _leave(self, place: int) -> None:
        """Make the columns of R after that place anew."""
        for k in range(place, self.count):
            self._normals[k] = self._normals[k + 1]
            self._R[k, self._m + k] = math.sqrt(self._column(self._normals[k], k))

    def _column(self, y: Array, count: int) -> float:
        """Write c, for the first so many active ones, as the next column of R; returns yᵀy - cᵀc."""
        m, c = self._m, self._R[count]
        c[:m] = 0.0
        linear.add_transposed_product(1.0, self._qp.Y, y, c[:m])
        for k in range(count):
            c[m + k] = linear.dot(self._normals[k], y)
        self._solve_transposed(c, count)
        return linear.dot(y, y) - linear.dot(c[: m + count], c[: m + count])

    def _solve_transposed(self, c: Array, count: int) -> None:
        """Solve Rᵀc = c in place, for the first so many active ones."""
        m = self._m
        linear.forward_solve_one(self._qp.R, c[:m])
        for k in range(count):
            c[m + k] = (c[m + k] - linear.part_dot(self._R, k, c, 0, m + k)) / self._R[k, m + k]

    def _solve(self, c: Array) -> None:
        """Solve Rr = c, of the equalities and of what is active."""
        m, r = self._m, self._shares
        r[: m + self.count] = c[: m + self.count]
        for k in range(self.count - 1, -1, -1):
            r[m + k] /= self._R[k, m + k]
            linear.add_scaled(r[: m + k], -r[m + k], self._R[k, : m + k])
        linear.backward_solve(self._qp.R, self._equality_r)

    def _mend(self) -> None:
        """Take back what rounding on the way has left of equalities and active inequalities."""
        qp, n, m = self._qp, len(self._y), self._m
        c = self._R[self.count]
        for e in range(m):
            c[e] = qp.lower[n + e] - qp.values[n + e]
        for k in range(self.count):
            i, is_upper = self.active[k] // 2, self.active[k] % 2
            c[m + k] = qp.values[i] - qp.upper[i] if is_upper else qp.lower[i] - qp.values[i]
        self._solve_transposed(c, self.count)
        self._solve(c)
        self._y[:] = 0.0
        self._move(-1.0)
