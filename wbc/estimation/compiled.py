"""The compiled ticks of the invariant filter, and the base that follows, on the arrays of its state."""

import numpy as np

from surefoot.native.library import Library
from surefoot.similarity import GRAVITY
from surefoot.wbc.estimation.stand import Stand
from surefoot.wbc.types import Array

POSE, FEET = 6, 2


class FilterKernels:
    """What a filter does with the readings of a tick, while its gain holds.

    Args:
        kernels: the library.
        stand: state of the filter, whose arrays stay where they are.
        size: numbers of its error.
    """

    def __init__(self, kernels: Library, stand: Stand, size: int) -> None:
        rows = POSE * FEET
        self._rate, self._force, self._acceleration = np.zeros(3), np.zeros(3), np.zeros(3)
        self._position, self._rotation = np.zeros((FEET, 3)), np.zeros((FEET, 3, 3))
        self._gain, self._weights = np.zeros(size * rows), np.zeros(rows * rows)
        self._feet, self._residual, self._size = np.zeros(FEET, dtype=np.int64), np.zeros(rows), size
        self._filter = kernels.fill(
            "Filter",
            size=size,
            feet_count=0,
            feet=self._feet,
            gravity=GRAVITY,
            R=stand.R,
            columns=stand.columns,
            Z=stand.Z,
            gyro_bias=stand.gyro_bias,
            force_bias=stand.force_bias,
            offsets=stand.offsets,
            rate=self._rate,
            force=self._force,
            acceleration=self._acceleration,
            position=self._position,
            rotation=self._rotation,
            gain=self._gain,
            weights=self._weights,
            residual=self._residual,
            moved=np.zeros(size),
        )
        self._propagate, self._correct = (
            kernels.bind(name, self._filter) for name in ("filter_propagate", "filter_correct")
        )

    def propagate(self, rate: Array, force: Array, time: float) -> Array:
        """See `InvariantFilter.propagate`; returns the acceleration of the IMU, shape (3,) [m/s^2]."""
        self._rate[:], self._force[:] = rate, force
        self._propagate(time)
        return self._acceleration

    def take(self, feet: list[int], gain: Array, weights: Array) -> None:
        """Work with another gain, shape (size, 6 feet), and the inverse of the residual's covariance."""
        rows = POSE * len(feet)
        self._feet[: len(feet)] = feet
        self._filter.struct.feet_count = len(feet)
        self._gain[: self._size * rows].reshape(-1, rows)[:] = gain
        self._weights[: rows * rows].reshape(rows, rows)[:] = weights

    def correct(self, y: Array, Y: Array, gate: float) -> Array | None:
        """See `InvariantFilter.correct`; returns the residual where a foot has slipped, of which nothing is taken."""
        self._position[:], self._rotation[:] = y, Y
        return self._residual if self._correct(gate) else None


class BaseKernel:
    """The base now, by the state of a filter and an IMU that no joint moves against it.

    Args:
        kernels: the library.
        stand: state of the filter, whose arrays stay where they are.
        mount: orientation of the IMU in the base, shape (3, 3).
        lever: its place there, shape (3,) [m].
    """

    def __init__(self, kernels: Library, stand: Stand, mount: Array, lever: Array) -> None:
        self._rate, self._gained, self._pose, self._velocity = (np.zeros(size) for size in (3, POSE, 7, POSE))
        base = kernels.fill(
            "SensedBase",
            R=stand.R,
            columns=stand.columns,
            gyro_bias=stand.gyro_bias,
            mount=np.ascontiguousarray(mount),
            lever=np.array(lever),
            rate=self._rate,
            gained=self._gained,
            pose=self._pose,
            velocity=self._velocity,
        )
        self._now = kernels.bind("sensed_base_now", base)

    def __call__(self, rate: Array, gained: Array | None, late: float) -> tuple[Array, Array]:
        """Place and quaternion of the base, shape (7,) [m, -], and its velocity in its axes, shape (6,) [m/s, rad/s].

        Args:
            rate: angular velocity of the IMU with its bias, shape (3,) [rad/s].
            gained: what the base was planned to gain since the readings, shape (6,) [m/s, rad/s]; None of new ones.
            late: how old they are [s].
        """
        self._rate[:] = rate
        if gained is not None:
            self._gained[:] = gained
        self._now(0.0 if gained is None else late)
        return self._pose, self._velocity
