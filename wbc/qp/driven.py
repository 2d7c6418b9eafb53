"""Joints of the robot that somebody else drives: the QP counts with what they do, and asks nothing of them."""

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from surefoot.wbc.qp.data import UNBOUNDED, QpData, QpLayout
from surefoot.wbc.types import Array

SMOOTHING = 0.01
"""Time constant with which the acceleration of a joint is found from its speed [s]."""


class DrivenRows:
    """Equalities in the place of the limits of driven joints.

    Where their torque is known, τ = M_j q̈ + h_j - Σ J_jᵀ w is that torque, so that their motion, its momentum and the
    forces that it takes are part of the solution. A drive with gains gives way to motion: its torque is that of the end
    of the period, which adds k_d T + k_p T² / 2 to the inertia, however stiff it is. Where no torque is known, q̈_j is
    the acceleration with which they are seen to move. Neither limits of torque nor of motion are asked of them.

    Args:
        layout: of the QP.
        joints: which are driven, bool, shape (nj,).
        period: time between two QPs [s].
    """

    def __init__(self, layout: QpLayout, joints: NDArray[np.bool_], period: float) -> None:
        self._joints = np.flatnonzero(joints)
        self._columns = 6 + self._joints
        self._rows = layout.variables + layout.torque_rows.start + self._joints
        self._share, self._period = 1.0 - float(np.exp(-period / SMOOTHING)), period
        self._size, self._inertia = len(joints), np.zeros(len(self._joints))
        self._speed: Array | None = None
        self._torque: Array | None = None
        self._acceleration = np.zeros(len(self._joints))

    def tell(self, torque: Array | None, stiffness: Array | float = 0.0, damping: Array | float = 0.0) -> None:
        """Set what drives the joints until the next QP.

        Args:
            torque: of all joints at the end of that time, if they go on at their speed, shape (nj,) [N·m]; None where
                it is not known.
            stiffness: of their drives, shape (nj,) [N·m/rad].
            damping: of their drives, shape (nj,) [N·m·s/rad].
        """
        T = self._period
        inertia = np.asarray(damping * T + 0.5 * stiffness * T * T) * np.ones(self._size)
        self._torque, self._inertia = None if torque is None else torque[self._joints], inertia[self._joints]

    @property
    def fixed(self) -> NDArray[np.intp]:
        """Numbers of all bounds that may be equalities."""
        return np.concatenate((self._columns, self._rows))

    def write(self, qp: QpData, bias: Array, v: Array) -> None:
        """Write over the limits that were written for the state of a tick.

        Args:
            qp: to write into.
            bias: h, shape (nv,) [N, N·m].
            v: velocity, shape (nv,) [m/s, rad/s].
        """
        lower, upper, speed = qp.bounds_lower, qp.bounds_upper, v[self._columns]
        if self._speed is not None:
            self._acceleration += self._share * ((speed - self._speed) / self._period - self._acceleration)
        self._speed = speed
        if self._torque is None:
            given, free, value = self._columns, self._rows, self._acceleration
        else:
            given, free, value = self._rows, self._columns, self._torque - bias[self._columns]
            qp.A[self._rows - len(qp.g), self._columns] += self._inertia
        lower[free], upper[free] = -UNBOUNDED, UNBOUNDED
        lower[given] = upper[given] = value


def without_driven(model: pin.Model, limbs: pin.GeometryModel, joints: NDArray[np.bool_]) -> pin.GeometryModel:
    """Shapes without the collision pairs of bodies that a driven joint moves, which nobody here can keep apart."""
    driven = {j for j in range(2, model.njoints) if joints[model.idx_vs[j] - 6]}
    moved = {j for j in range(model.njoints) if driven & set(model.supports[j])}
    left = pin.GeometryModel(limbs)
    for pair in list(limbs.collisionPairs):
        shapes = (limbs.geometryObjects[k].parentJoint for k in (pair.first, pair.second))
        if moved & set(shapes):
            left.removeCollisionPair(pair)
    return left
