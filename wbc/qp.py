"""The whole-body QP: its layout, its data and its residuals. Building, solving and interpreting are apart."""

from dataclasses import dataclass

import numpy as np

from wbc.types import Array

FOOT_ROWS = 6
EQUALITY_ROWS = 6 + 2 * FOOT_ROWS
UNBOUNDED = 1e9
"""Stands for an absent bound: far beyond any physical value, yet finite for every solver."""


@dataclass(frozen=True, slots=True)
class QpLayout:
    """Where everything is in the QP.

    Variables ``x = [q̈ (nv), w_left (6), w_right (6)]`` with sole wrenches in the sole frames; rows: floating-base dynamics (6),
    contact of the left and of the right foot (6 each), joint torques (nj), wrench cones (2 x cone_rows).

    Attributes:
        nv: size of the generalised acceleration.
        cone_rows: rows of one wrench cone.
    """

    nv: int
    cone_rows: int

    @property
    def joints(self) -> int:
        """Number of actuated joints."""
        return self.nv - 6

    @property
    def variables(self) -> int:
        """Number of variables."""
        return self.nv + 12

    @property
    def rows(self) -> int:
        """Number of constraint rows, equalities first."""
        return EQUALITY_ROWS + self.joints + 2 * self.cone_rows

    @property
    def torque_rows(self) -> slice:
        """Rows of the joint torques."""
        return slice(EQUALITY_ROWS, EQUALITY_ROWS + self.joints)

    def wrench(self, foot: int) -> slice:
        """Variables of one sole wrench."""
        return slice(self.nv + 6 * foot, self.nv + 6 * foot + 6)

    def contact_rows(self, foot: int) -> slice:
        """Equality rows of one foot."""
        return slice(6 + FOOT_ROWS * foot, 6 + FOOT_ROWS * (foot + 1))


@dataclass(frozen=True, slots=True)
class QpData:
    """minimise 1/2 xᵀ H x + gᵀ x  subject to  lower <= x <= upper  and  row_lower <= A x <= row_upper.

    The first ``EQUALITY_ROWS`` rows are equalities (both bounds equal). With n variables and m rows:

    Attributes:
        H: shape (n, n), positive definite.
        g: shape (n,).
        A: shape (m, n).
        bounds_lower, bounds_upper: shape (n + m,): the variables' bounds, then the rows'.
    """

    H: Array
    g: Array
    A: Array
    bounds_lower: Array
    bounds_upper: Array

    def copy(self) -> "QpData":
        """A snapshot that later assemblies do not overwrite."""
        return QpData(self.H.copy(), self.g.copy(), self.A.copy(), self.bounds_lower.copy(), self.bounds_upper.copy())

    def violation(self, x: Array) -> float:
        """Largest violation of any bound or row at x, shape (n,); 0 when feasible."""
        n = x.shape[0]
        rows = self.A @ x
        return float(
            max(
                (self.bounds_lower[:n] - x).max(),
                (x - self.bounds_upper[:n]).max(),
                (self.bounds_lower[n:] - rows).max(),
                (rows - self.bounds_upper[n:]).max(),
                0.0,
            )
        )


def allocate(layout: QpLayout) -> QpData:
    """A QP of that layout with no cost, zero rows and no bounds."""
    n, m = layout.variables, layout.rows
    lower = np.full(n + m, -UNBOUNDED)
    upper = np.full(n + m, UNBOUNDED)
    return QpData(np.zeros((n, n)), np.zeros(n), np.zeros((m, n)), lower, upper)
