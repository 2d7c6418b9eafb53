"""The whole-body QP: its layout, its data and its residuals. Building, solving and interpreting are apart."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surefoot.wbc.types import Array

FOOT_ROWS = 6
EQUALITY_ROWS = 2 * FOOT_ROWS + 6
WRENCH_UNIT = 100.0
"""Unit of the wrench variables of the reference robot; that of others goes with their mass [N, N·m].

With forces in units near their size over that of the accelerations, H has a condition number of about 1e5; in newtons
it had 1e8."""
UNBOUNDED = 1e9
"""Stands for an absent bound: far beyond any physical value, yet finite for every solver."""


@dataclass(frozen=True, slots=True)
class QpLayout:
    """The places of everything in the QP.

    Variables ``x = [q̈ (nv), w_left (6), w_right (6)]`` with sole wrenches in the sole frames, in units of
    ``RobotTerms.wrench_unit``; rows: contact of the left
    and of the right foot (6 each), equations of motion (6 of the floating base, then nj joint torques), wrench cones
    (2 x cone_rows), distances between limbs (separation_rows).

    Attributes:
        nv: size of the generalised acceleration.
        cone_rows: rows of one wrench cone.
        separation_rows: rows of distances between limbs.
    """

    nv: int
    cone_rows: int
    separation_rows: int = 0

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
        return EQUALITY_ROWS + self.joints + 2 * self.cone_rows + self.separation_rows

    @property
    def motion_rows(self) -> slice:
        """Rows of the equations of motion: equalities of the floating base, then the joint torques."""
        return slice(2 * FOOT_ROWS, 2 * FOOT_ROWS + self.nv)

    @property
    def torque_rows(self) -> slice:
        """Rows of the joint torques."""
        return slice(EQUALITY_ROWS, EQUALITY_ROWS + self.joints)

    @property
    def separation(self) -> slice:
        """Rows of distances between limbs."""
        first = self.torque_rows.stop + 2 * self.cone_rows
        return slice(first, first + self.separation_rows)

    @property
    def soft(self) -> NDArray[np.intp]:
        """Numbers of the bounds and rows that stops of joints and contacts of limbs hold as well, shape (k,) [-].

        Those of the joints' accelerations come first, those of the distances between limbs last.
        """
        gaps = self.variables + np.arange(self.separation.start, self.separation.stop)
        return np.concatenate((np.arange(6, self.nv), gaps))

    def wrench(self, foot: int) -> slice:
        """Variables of one sole wrench."""
        return slice(self.nv + 6 * foot, self.nv + 6 * foot + 6)

    def contact_rows(self, foot: int) -> slice:
        """Equality rows of one foot."""
        return slice(FOOT_ROWS * foot, FOOT_ROWS * (foot + 1))


@dataclass(frozen=True, slots=True)
class QpData:
    """minimise 1/2 xᵀ H x + gᵀ x  subject to  lower <= x <= upper  and  row_lower <= A x <= row_upper.

    The first ``EQUALITY_ROWS`` rows are equalities (both bounds equal). With n variables and m rows:

    Attributes:
        H: shape (n, n), positive definite [cost / x^2].
        g: shape (n,) [cost / x].
        A: shape (m, n) [of a row / x].
        bounds_lower, bounds_upper: shape (n + m,): the variables' bounds, then the rows' [m/s^2, rad/s^2, N, N m].
    """

    H: Array
    g: Array
    A: Array
    bounds_lower: Array
    bounds_upper: Array

    def copy(self) -> "QpData":
        """A snapshot that later assemblies do not overwrite."""
        return QpData(self.H.copy(), self.g.copy(), self.A.copy(), self.bounds_lower.copy(), self.bounds_upper.copy())

    def is_finite(self) -> bool:
        """Return true if every entry is a number; some solvers loop on what is not."""
        parts = (self.H, self.g, self.A, self.bounds_lower, self.bounds_upper)
        return math.isfinite(sum(float(part.sum()) for part in parts))

    def violation(self, x: Array, soft: NDArray[np.intp] | None = None) -> float:
        """Largest violation [of its row] of any bound or row at x; 0 when feasible, NaN of no number.

        Args:
            x: a solution, shape (n,) [as of the QP].
            soft: numbers of bounds and rows that do not count, shape (k,) [-]; None for none.
        """
        values = np.concatenate((x, self.A.dot(x)))
        above = values - self.bounds_upper
        np.subtract(self.bounds_lower, values, out=values)
        beyond = np.maximum(values, above, out=above)
        if soft is not None:
            beyond[soft] = 0.0
        excess = float(np.maximum.reduce(beyond))
        return excess if not excess < 0.0 else 0.0


def allocate(layout: QpLayout) -> QpData:
    """A QP of that layout with no cost, zero rows and no bounds."""
    n, m = layout.variables, layout.rows
    lower = np.full(n + m, -UNBOUNDED)
    upper = np.full(n + m, UNBOUNDED)
    return QpData(np.zeros((n, n)), np.zeros(n), np.zeros((m, n)), lower, upper)
