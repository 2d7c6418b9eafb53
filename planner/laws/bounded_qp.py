"""The QP of one axis by the dual method: min ½ zᵀPz + qᵀz subject to Gz <= h and lower <= z <= upper.

As in the paper of Goldfarb and Idnani: with P = UᵀU, J = U⁻¹Q has JᵀN = [R; 0] for the normals N of what is active. The
first columns of J, as many as these, leave the active inequalities where they are changed, the others do not: with
d = Jᵀn⁺ and its parts d₁ and d₂, z = J₂d₂ and r = R⁻¹d₁. Givens rotations keep R a triangle.
"""

import math

import numpy as np

from surefoot.maths import linear
from surefoot.maths.dual_method import DualMethod
from surefoot.planner.types import Array

TOLERANCE = 1e-12
"""Violation that counts as none, over the size of a variable and 1, or of a row, since rounding is as large [-]."""

DEPENDENT = 1e-20
"""Share of a normal that may be left beside those of what is active, squared, without being taken for none [-]."""

MOST_ROUNDS = 200
"""Steps after which it gives up: plans take a dozen [-]."""


class BoundedQp(DualMethod):
    """QPs of a size, of which those of both axes share P and G.

    Inequalities are numbered as lower bounds, upper bounds, rows.

    Args:
        rows: of G, m.
        variables: n.

    Attributes:
        is_definite: whether the P taken last is positive definite.
    """

    def __init__(self, rows: int, variables: int) -> None:
        # No more than n normals are independent of each other.
        super().__init__(2 * variables + rows, variables + 1, MOST_ROUNDS, DEPENDENT)
        self._n = variables
        self._rows = rows
        self._tolerance = TOLERANCE
        self.is_definite = False
        self._U, self._R = np.zeros((variables, variables)), np.zeros((variables, variables))
        # Transposed, since both are used by columns.
        self._U_inverse, self._J = np.zeros((variables, variables)), np.zeros((variables, variables))
        self._share, self._values = np.zeros(rows), np.zeros(rows)
        self._x, self._normal, self._d, self._z = np.zeros((4, variables))
        # What pickle reads of it before the first problem is there, too.
        self._G, self._h = np.zeros((rows, variables)), np.zeros(rows)
        self._lower, self._upper = np.zeros((2, variables))

    def factorise(self, P: Array, G: Array) -> None:
        """Take P, shape (n, n), and G, shape (m, n), for the QPs that come; `is_definite` says whether P allows it."""
        self._G = G
        self._U[:] = P
        self.is_definite = not linear.factor(self._U)
        if not self.is_definite:
            return
        linear.inverse_columns(self._U, self._U_inverse)
        linear.row_sizes(G, self._share)
        for i in range(self._rows):
            self._share[i] = 1.0 / self._share[i] if self._share[i] > 0.0 else 0.0

    def minimised(self, q: Array, h: Array, lower: Array, upper: Array) -> Array | None:
        """The solution for q, shape (n,), h, shape (m,), and bounds, shape (n,), in fresh memory; None without one."""
        if not self.is_definite:
            return None
        self._h, self._lower, self._upper = h, lower, upper
        self._J[:] = self._U_inverse
        self._x[:] = 0.0
        linear.multiply(self._J, q, self._d)
        linear.add_transposed_product(-1.0, self._J, self._d, self._x)
        if self.iterate() < 0 or not math.isfinite(linear.dot(self._x, self._x)):
            return None
        return np.array(self._x)

    def _violated(self) -> int:
        """Bounds come before rows."""
        number = self._violated_bound()
        if number < 0:
            number = self._violated_row()
        return number

    def _violated_bound(self) -> int:
        number, worst = -1, -self._tolerance
        for i in range(self._n):
            x = self._x[i]
            below, above = (x - self._lower[i]) / (1.0 + abs(x)), (self._upper[i] - x) / (1.0 + abs(x))
            if not (below >= worst or self.is_active[i]):
                number, worst = i, below
            if not (above >= worst or self.is_active[self._n + i]):
                number, worst = self._n + i, above
        if number >= 0:
            is_lower = number < self._n
            i = number if is_lower else number - self._n
            self._normal[:] = 0.0
            self._normal[i] = 1.0 if is_lower else -1.0
            self.slack = self._x[i] - self._lower[i] if is_lower else self._upper[i] - self._x[i]
        return number

    def _violated_row(self) -> int:
        row, worst = -1, -self._tolerance
        self._values[:] = self._h
        linear.add_product(-1.0, self._G, self._x, self._values)
        for i in range(self._rows):
            slack = self._values[i] * self._share[i]
            if not (slack >= worst or self.is_active[2 * self._n + i]):
                row, worst = i, slack
        if row < 0:
            return -1
        self.slack = worst
        self._normal[:] = 0.0
        linear.add_scaled(self._normal, -self._share[row], self._G[row])
        return 2 * self._n + row

    def _project(self) -> None:
        active, d = self.count, self._d
        self._z[:] = 0.0
        linear.multiply(self._J, self._normal, d)
        linear.add_transposed_product(1.0, self._J[active:], d[active:], self._z)
        whole, curvature = 0.0, 0.0
        for k in range(self._n):
            whole += d[k] * d[k]
            if k >= active:
                curvature += d[k] * d[k]
        self.whole, self.curvature = whole, curvature
        for k in range(active):
            self.r[k] = d[k]
        linear.upper_solve(self._R, active, self.r)

    def _move(self, step: float) -> None:
        linear.add_scaled(self._x, step, self._z)

    def _take(self) -> None:
        """Rotate columns of J until d ends with the number that is the corner of R."""
        last, d = self.count, self._d
        for k in range(self._n - 1, last, -1):
            if d[k] != 0.0:
                linear.rotate_rows(self._J, k - 1, d[k - 1], d[k])
                d[k - 1] = math.sqrt(d[k - 1] * d[k - 1] + d[k] * d[k])
        for i in range(last + 1):
            self._R[i, last] = d[i]

    def _leave(self, place: int) -> None:
        """Close the gap, and rotate rows of R until it is a triangle again."""
        R, active = self._R, self.count
        for k in range(place, active):
            for i in range(k + 2):
                R[i, k] = R[i, k + 1]
        for k in range(place, active):
            a, b = R[k, k], R[k + 1, k]
            if b != 0.0:
                linear.rotate_rows(R, k, a, b)
                linear.rotate_rows(self._J, k, a, b)
