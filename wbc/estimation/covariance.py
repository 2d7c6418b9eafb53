"""The uncertainty of the invariant filter: covariance of its error over time, and the gain that follows.

An error is after a time t (Hartley et al. 2020, eq. 28 and 37; see `surefoot.wbc.estimation.invariant_filter`)

    F ξ:   ξ -= t B R β_g,   ξ_v += t (hat(g) ξ_R - R β_a),   ξ_p += t ξ_v + t²/2 hat(g) ξ_R,

with the right sides as before, and B = (1, hat(v), hat(p), hat(d_0), hat(d_1)) what turns about world axes do to R and
the columns. P becomes F P Fᵀ + Q. Of a foot that stands H ξ is seen, with a noise N in a tick:

    H_d ξ = ξ_d - ξ_p + R J_y o,   H_Z ξ = ζ - ξ_R + R J_Y o.

The gain of a tick is K = P Hᵀ (H P Hᵀ + N)⁻¹, and the covariance after n ticks P - P Hᵀ (H P Hᵀ + N/n)⁻¹ H P.
"""

import numpy as np
from numpy.typing import NDArray

from surefoot.maths import algebra, linear
from surefoot.similarity import GRAVITY
from surefoot.wbc.estimation import stand
from surefoot.wbc.estimation.parameters import GroundNoise, SensorNoise
from surefoot.wbc.estimation.stand import AXES, Stand
from surefoot.wbc.types import Array

FREE = 3.0
"""Deviation of a second's turn of a sole about a line on which it stands [rad/√s]: nothing is known of it."""

UNSURE = 0.5
"""Deviation of what springs under a sole do, over what they are believed to do [-]."""

COLUMNS = 15
"""Numbers of the error of R and the columns."""

POSE, MOST = 6, 12
"""Numbers that a foot is seen by, and that both are."""


class Covariance:
    """Covariance of the error of a state, and the gain of a tick.

    Args:
        state: the state, which moves on by its own.
        sensors: noise of the sensors.
        ground: what feet and ground add.
        leaning: the soles stand on lines along them, about which they turn at will.

    Attributes:
        P: covariance, shape (n, n) with n = 30 + m, in an array that stays where it is.
        gain: K, of which as many columns count as numbers are seen, shape (n, 12).
        weights: S⁻¹, of which as many rows and columns count, shape (12, 12).
    """

    def __init__(self, state: Stand, sensors: SensorNoise, ground: GroundNoise, leaning: bool) -> None:
        m = len(state.offsets)
        n = stand.OFFSETS_AT + m
        self._state, self._encoders = state, m - AXES
        self.P, self.gain, self.weights = np.zeros((n, n)), np.zeros((n, MOST)), np.zeros((MOST, MOST))
        self._P, self._gain, self._weights = self.P, self.gain, self.weights
        self._keep(sensors, ground, leaning)
        self._fall = np.zeros((3, 3))
        algebra.put_cross(self._fall, (0.0, 0.0, -GRAVITY))
        self._B, self._BR, self._BB = np.eye(COLUMNS, 3), np.zeros((COLUMNS, 3)), np.zeros((COLUMNS, COLUMNS))
        self._before, self._turned = np.zeros((POSE, n)), np.zeros((COLUMNS, n))
        self._fallen, self._pushed = np.zeros((3, n)), np.zeros((3, n))
        self._at, self._from = np.zeros(MOST, dtype=np.intp), np.zeros(MOST, dtype=np.intp)
        self._noise, self._RJ = np.zeros(MOST), np.zeros((MOST, m))
        self._PH, self._HP, self._apart = np.zeros((n, MOST)), np.zeros((MOST, n)), np.zeros((n, MOST))
        self._S, self._U = np.zeros((MOST, MOST)), np.zeros((MOST, MOST))

    def _keep(self, sensors: SensorNoise, ground: GroundNoise, leaning: bool) -> None:
        """Variances in a second, or of a reading."""
        self._gyro = algebra.square(sensors.gyro_density)
        self._speed = algebra.square(sensors.accelerometer_density) + algebra.square(ground.model)
        self._gyro_walk = algebra.square(sensors.gyro_walk)
        self._force_walk = algebra.square(sensors.accelerometer_walk)
        self._encoder = algebra.square(sensors.encoder)
        self._place, self._turning = algebra.square(ground.kinematics), algebra.square(ground.turning)
        # Springs under one edge give twice as much.
        self._creep, self._sinking = ground.creep, (2.0 if leaning else 1.0) * ground.sinking
        self._rocking, self._light = ground.rocking, ground.light
        self._unsure = UNSURE
        self._free, self._leaning = algebra.square(FREE), leaning

    def advance(self, t: float, x: Array) -> None:
        """Errors after a time, in place: F x.

        Args:
            t: the time [s].
            x: errors side by side, shape (n, k), of as many at most as they have numbers.
        """
        n = x.shape[1]
        before, turned = self._before[:, :n], self._turned[:, :n]
        fallen, pushed = self._fallen[:, :n], self._pushed[:, :n]
        self._see_turns()
        linear.copy(x[: stand.POSITION_AT], before)
        linear.product(self._BR, x[stand.GYRO_AT : stand.FORCE_AT], turned)
        linear.product(self._fall, before[:3], fallen)
        linear.product(self._state._R, x[stand.FORCE_AT : stand.OFFSETS_AT], pushed)
        # What the accelerometer's bias and the tilt take from the velocity in a second.
        linear.add_multiple(pushed, -1.0, fallen)
        linear.add_multiple(x[:COLUMNS], -t, turned)
        linear.add_multiple(x[stand.VELOCITY_AT : stand.POSITION_AT], -t, pushed)
        linear.add_multiples(x[stand.POSITION_AT : stand.FOOT_AT], t, before[3:], 0.5 * t * t, fallen)

    def _see_turns(self) -> None:
        """B and B R of the state now."""
        for i in range(4):
            algebra.put_cross(self._B[3 + 3 * i : 6 + 3 * i], algebra.row(self._state._columns, i))
        linear.product(self._B, self._state._R, self._BR)

    def spread(self, t: float) -> None:
        """Covariance after a time [s] but for what standing feet add."""
        P = self._P
        self.advance(t, P)
        self.advance(t, P.T)
        linear.product(self._B, self._B.T, self._BB)
        linear.add_multiple(P[:COLUMNS, :COLUMNS], self._gyro * t, self._BB)
        for i in range(3):
            P[stand.VELOCITY_AT + i, stand.VELOCITY_AT + i] += self._speed * t
            P[stand.GYRO_AT + i, stand.GYRO_AT + i] += self._gyro_walk * t
            P[stand.FORCE_AT + i, stand.FORCE_AT + i] += self._force_walk * t

    def add_standing(self, k: int, t: float, load: float) -> None:
        """Add what a foot does that stands for a time [s] under a share of the weight [-]: by the root of the time."""
        P, foot, sole = self._P, stand.FOOT_AT + 3 * k, stand.SOLE_AT + 3 * k
        loaded = 2.0 * load
        more = 1.0 + (self._light - 1.0) * (1.0 - (loaded if loaded < 1.0 else 1.0))
        for i in range(3):
            way = self._creep if i < 2 else self._sinking
            P[foot + i, foot + i] += algebra.square(more * way) * t
            P[sole + i, sole + i] += algebra.square(more * self._rocking) * t

    def add_springs(self, k: int, turned: algebra.Vector, risen: float) -> None:
        """Add a share of what springs under a sole have done: its turn about world axes [rad], and its way up [m]."""
        P, foot, sole = self._P, stand.FOOT_AT + 3 * k + 2, stand.SOLE_AT + 3 * k
        P[foot, foot] += algebra.square(self._unsure * risen)
        P[sole, sole] += algebra.square(self._unsure * turned[0])
        P[sole + 1, sole + 1] += algebra.square(self._unsure * turned[1])
        P[sole + 2, sole + 2] += algebra.square(self._unsure * turned[2])

    def add_turning(self, k: int, t: float, rolls: bool) -> None:
        """Add what a sole turns freely in a time [s]: one that leans about its line, one that rolls about its edge."""
        if self._leaning:
            self._add_turn(k, t, 0)
        if rolls:
            self._add_turn(k, t, 1)

    def _add_turn(self, k: int, t: float, axis: int) -> None:
        """Add a sole's free turn about one of its own axes."""
        P, Z, sole = self._P, self._state._Z[k], stand.SOLE_AT + 3 * k
        for i in range(3):
            for j in range(3):
                P[sole + i, sole + j] += self._free * t * Z[i, axis] * Z[j, axis]

    def weigh(self, feet: NDArray[np.intp], J: Array, ticks: float) -> bool:
        """Gain of a tick, and covariance after some.

        Args:
            feet: that stand, shape (1,) or (2,).
            J: Jacobians of both soles, by `SensedBody.offset_jacobians`, shape (2, 6, m + 3).
            ticks: of which the kinematics were taken.

        Returns:
            Whether the covariance of what is seen is positive. Where it is not, nothing is done.
        """
        rows = POSE * len(feet)
        PH = self._PH[:, :rows]
        HP = self._HP[:rows]
        weights = self._weights[:rows, :rows]
        U = self._U[:rows, :rows]
        for i in range(len(feet)):
            self._look(POSE * i, feet[i], J[feet[i]])
        self._project(rows)
        if self._factor(rows, ticks):
            return False
        linear.copy(PH.T, HP)
        linear.forward_solve(U, HP)
        if self._factor(rows, 1.0):
            return False
        linear.inverse(U, weights)
        linear.downdate(self._P, HP)
        linear.row_products(PH, weights, self._gain[:, :rows])
        return True

    def _look(self, first: int, k: int, J: Array) -> None:
        """Rows of H from the first on, by a foot: each is of two numbers of the error, and of the offsets by R J."""
        RJ, R = self._RJ[first : first + POSE], self._state._R
        linear.product(R, J[:3], RJ[:3])
        linear.product(R, J[3:], RJ[3:])
        encoders = J[:, : self._encoders]
        for i in range(3):
            place, turn = first + i, first + 3 + i
            self._at[place], self._from[place] = stand.FOOT_AT + 3 * k + i, stand.POSITION_AT + i
            self._at[turn], self._from[turn] = stand.SOLE_AT + 3 * k + i, stand.TURN_AT + i
            self._noise[place] = self._place + self._encoder * linear.rows_dot(encoders, i, encoders, i)
            self._noise[turn] = self._turning + self._encoder * linear.rows_dot(encoders, 3 + i, encoders, 3 + i)

    def _project(self, rows: int) -> None:
        """P Hᵀ and H P Hᵀ, shapes (n, rows) and (rows, rows)."""
        P = self._P
        PH = self._PH[:, :rows]
        S = self._S[:rows, :rows]
        RJ = self._RJ[:rows]
        apart, at, from_ = self._apart[:, :rows], self._at[:rows], self._from[:rows]
        linear.row_products(P[:, stand.OFFSETS_AT :], RJ, PH)
        linear.differences(P, at, from_, apart)
        linear.add_multiple(PH, 1.0, apart)
        linear.differences(PH.T, at, from_, S.T)
        linear.accumulate(S, RJ, PH[stand.OFFSETS_AT :])

    def _factor(self, rows: int, ticks: float) -> bool:
        """Factor H P Hᵀ + N / ticks in `_U`; returns whether it is not positive."""
        U = self._U[:rows, :rows]
        linear.copy(self._S[:rows, :rows], U)
        for r in range(rows):
            U[r, r] += self._noise[r] / ticks
        return linear.factor(U)
