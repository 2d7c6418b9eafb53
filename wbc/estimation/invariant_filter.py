"""Right-invariant extended Kalman filter of IMU and foot poses.

Hartley, Ghaffari, Eustice and Grizzle, "Contact-aided invariant extended Kalman filtering for robot state estimation",
International Journal of Robotics Research 2020, with the orientations of the feet as Bloesch et al. have them ("State
estimation for legged robots: consistent fusion of leg kinematics and IMU", RSS 2012; Rotella et al. 2014), and with the
zeros of the encoders and the turn of the IMU on its mount as states.

The state is X = (R, v, p, d_0, d_1) of SE_4(3), the orientations Z_0, Z_1 of the soles, the biases b_g and b_a and the
offsets o of encoders and mount. Its error ξ is that of the right, X = exp(ξ) X̂, Z = exp(ζ) Ẑ, so that R' = R hat(ω)
and v' = R a + g give (eq. 28 and 37 there)

    ξ_R' = -R̂ β_g,   ξ_v' = hat(g) ξ_R - hat(v̂) R̂ β_g - R̂ β_a,   ξ_p' = ξ_v - hat(p̂) R̂ β_g,   ξ_d' = -hat(d̂) R̂ β_g,

which but for the biases β knows no state: group-affine. A sole at y with orientation Y in the frame of the IMU, by the
encoders and the mount less their offsets, gives for a foot that stands (eq. 33, with J the Jacobian of y and Y to both)

    R̂ y + p̂ - d̂ = ξ_d - ξ_p + R̂ J_y o,   log(R̂ Y Ẑᵀ) = ζ - ξ_R + R̂ J_Y o.
"""

import numpy as np
import pinocchio as pin

from surefoot.maths import algebra, linear
from surefoot.similarity import GRAVITY
from surefoot.wbc.estimation.covariance import Covariance
from surefoot.wbc.estimation.parameters import GroundNoise, SensorNoise
from surefoot.wbc.estimation.stand import AXES, FOOT, FORCE, GYRO, OFFSETS, POSITION, SOLE, TURN, VELOCITY, Stand
from surefoot.wbc.types import Array

POSE = 6
"""Numbers that a foot is seen by."""

_UNIT = np.eye(3)

LIKELY = 9.0
"""Square of the normalised height of a landing over the ground that is believed, from which on it is another ground: by
chance in one of 370 landings, which then tells no height [-]."""

NONE = 1e-9
"""Stands for zero ticks, as in an outage of the encoders. The noise is then as good as infinite [-]."""

GATES = (38.0, 50.0)
"""Square of the normalised residual of one foot, and of two, from which on one has slipped: by chance in one of 10^6
ticks [-]."""


class InvariantFilter:
    """The filter. Propagation and correction of the state at every tick, covariance and gain when they are asked for.

    Between two computations the gain holds; it is that of a tick. The covariance counts the ticks of its span whose
    kinematics were taken, and no others: a filter that counts what it refused is sure of what it never heard.

    Args:
        stand: where everything is at the start; the soles are level on the ground.
        sensors: noise of the sensors.
        ground: what feet and ground add.
        leaning: the soles stand on lines along them, about which they turn at will.

    Attributes:
        stand: the state.
        covariance: of its error, with the gain.
        P: its array, shape (30 + m, 30 + m).
        acceleration: of the IMU in the world, last, in an array that stays where it is, shape (3,) [m/s^2].
        standing: feet that stand, left first.
        residual: how far those that are weighed were last from where the kinematics say, six numbers each, shape (12,)
            [m, rad].
    """

    def __init__(self, stand: Stand, sensors: SensorNoise, ground: GroundNoise, leaning: bool = False) -> None:
        self.stand = stand
        self._ground = ground
        self._leaning = leaning
        self._gravity = GRAVITY
        self.covariance = Covariance(stand, sensors, ground, leaning)
        self.P = self.covariance.P
        self.acceleration = np.zeros(3)
        self._acceleration = self.acceleration
        self.standing = [True, True]
        # The soles stand where the kinematics of the start say.
        self._since, self._taken = 0.0, 1
        self._feet, self._count = np.zeros(2, dtype=np.intp), 0
        self._half, self._middle, self._apart = np.zeros((3, 3)), np.zeros((3, 3)), np.zeros((3, 3))
        self.residual, self._moved = np.zeros(2 * POSE), np.zeros(len(self.P))
        self._residual = self.residual
        spread = np.zeros(len(self.P))
        spread[VELOCITY], spread[GYRO], spread[FORCE] = 1e-3, sensors.gyro_bias, sensors.accelerometer_bias
        spread[OFFSETS], spread[-AXES:] = sensors.encoder_offset, sensors.mounting
        self.P[np.diag_indices(len(spread))] = spread**2

    def begin(self, y: Array, Y: Array, J: Array, normals: Array, tilt: float) -> None:
        """Attitude and height from soles that are level on the ground.

        They give the world's heading and place, too. An offset found later turns the IMU, not the way of the soles.

        Args:
            y: sole centres in the frame of the IMU, shape (2, 3) [m].
            Y: their orientations, shape (2, 3, 3).
            J: Jacobians of both, by `SensedBody.offset_jacobians`, shape (2, 6, m + 3).
            normals: of the ground under them, shape (2, 3).
            tilt: how far the attitude may be off before [rad].
        """
        s, n, P = self.stand, len(self.P), self.P
        D = np.einsum("ii->i", P)
        D[TURN] = D[POSITION] = tilt**2
        lever = np.eye(n)
        lever[POSITION, TURN] = pin.skew(s.p)
        P[:] = lever @ P @ lever.T
        rows, wanted = np.zeros((9, n)), np.zeros(9)
        for k in (0, 1):
            # Sole normals R̂ Y e_z turn by ξ_R - R̂ J_Y o, sole heights move by ξ_p + hat-terms of ξ_R - R̂ J_y o.
            up, turned = normals[k], s.R @ J[k, 3:]
            if self._leaning:
                # Only the line is level, which is that a sole is about the axis across it.
                line = s.R @ Y[k, :, 0]
                across = np.cross(line, up)
                rows[3 * k, TURN], rows[3 * k, OFFSETS], wanted[3 * k] = across, -across @ turned, -up @ line
            else:
                side = np.cross(up, [0.0, 1.0, 0.0])
                side /= np.linalg.norm(side)
                for i, axis in enumerate((side, np.cross(up, side))):
                    row = rows[3 * k + i]
                    row[TURN], row[OFFSETS] = axis, -axis @ turned
                    wanted[3 * k + i] = axis @ np.cross(s.R @ Y[k, :, 2], up)
            foot = s.R @ y[k] + s.p
            moved = np.zeros((3, n))
            moved[:, TURN], moved[:, POSITION], moved[:, OFFSETS] = -pin.skew(foot), _UNIT, -s.R @ J[k, :3]
            rows[3 * k + 2] = moved[2]
            wanted[3 * k + 2] = s.d[k, 2] - foot[2]
            # Between the soles is their middle, and their headings have a mean.
            rows[6:8] += 0.5 * moved[:2]
            rows[8, OFFSETS] -= 0.5 * turned[2]
        rows[8, TURN] = _UNIT[2]
        ground = self._ground
        noise = np.r_[np.tile([ground.level] * 2 + [ground.landing], 2), [ground.kinematics] * 2, ground.turning]
        self._correct(rows, wanted, noise**2)
        for k in (0, 1):
            # By the zeros that are known from now on they are elsewhere.
            place, turn = y[k] - J[k, :3] @ s.offsets, pin.exp3(-J[k, 3:] @ s.offsets) @ Y[k]
            self.land(k, place, turn, J[k], None, self._ground.kinematics, self._ground.turning)

    def _correct(self, rows: Array, wanted: Array, noise: Array) -> None:
        """Plain Kalman update by linear measurements of the error."""
        PH = self.P @ rows.T
        S = rows @ PH + np.diag(noise)
        K = np.linalg.solve(S, PH.T).T
        self.P -= K @ PH.T
        self.P[:] = 0.5 * (self.P + self.P.T)
        self.stand.move(K @ wanted)

    def propagate(self, rate: Array, force: Array, time: float) -> None:
        """Go on with what the IMU says.

        Args:
            rate: mean angular velocity, shape (3,) [rad/s].
            force: mean specific force, shape (3,) [m/s^2].
            time: that both are of [s].
        """
        s, half, middle = self.stand, self._half, self._middle
        rate_now = algebra.subtract(algebra.vector(rate), algebra.vector(s._gyro_bias))
        force_now = algebra.subtract(algebra.vector(force), algebra.vector(s._force_bias))
        # The mean force is of the frame half way through the turn.
        algebra.rotation_of(algebra.scale(0.5 * time, rate_now), half)
        algebra.compose(s._R, half, middle)
        algebra.compose(middle, half, s._R)
        x, y, z = algebra.rotate(middle, force_now)
        algebra.put(self._acceleration, (x, y, z - self._gravity))
        v, p, a = s._columns[0], s._columns[1], self._acceleration
        for i in range(3):
            p[i] += time * v[i] + 0.5 * time * time * a[i]
            v[i] += time * a[i]
        self._since += time

    def spread(
        self, loads: tuple[float, float], sprung: Array | None = None, rolling: tuple[bool, bool] = (False, False)
    ) -> None:
        """Covariance of the way since it was computed last.

        Args:
            loads: shares of the weight on the soles [-].
            sprung: by how much each sole has rolled, pitched and risen on springs in that time, in its own axes, shape
                (2, 3), with half of that as its deviation; None where nobody knows [rad, rad, m].
            rolling: soles that turn about an edge across them, left first.
        """
        time, self._since = self._since, 0.0
        if time <= 0.0:
            return
        covariance = self.covariance
        covariance.spread(time)
        for k in range(2):
            if self.standing[k]:
                covariance.add_standing(k, time, loads[k])
                if sprung is not None:
                    covariance.add_springs(k, self.stand.give(k, sprung[k]), sprung[k, 2])
                covariance.add_turning(k, time, rolling[k])

    def land(
        self, k: int, y: Array, Y: Array, J: Array, height: tuple[float, float] | None, place: float, turn: float
    ) -> None:
        """A foot stands from now on: it is where the kinematics say.

        Args:
            k: foot.
            y: its sole's centre in the frame of the IMU, shape (3,) [m].
            Y: its orientation, shape (3, 3).
            J: Jacobian of both, by `SensedBody.offset_jacobians`, shape (6, m + 3).
            height: of the ground there, as it is believed, and its deviation; None where that is not known. A foot
                that cannot have landed on that by all that is known has found a step of the ground [m].
            place: deviation of where it comes to rest [m].
            turn: deviation of how it is turned [rad].
        """
        s, n = self.stand, len(self.P)
        s.columns[2 + k], s.Z[k] = s.p + s.R @ y, s.R @ Y
        T = np.eye(n)
        i, j = FOOT[k], SOLE[k]
        T[i], T[j] = 0.0, 0.0
        T[i, POSITION], T[j, TURN] = _UNIT, _UNIT
        T[i, OFFSETS], T[j, OFFSETS] = -s.R @ J[:3], -s.R @ J[3:]
        P = self.P
        P[:] = T @ P @ T.T
        D = np.einsum("ii->i", P)
        D[i] += place**2
        D[j] += turn**2
        self.standing[k] = True
        if height is not None:
            row, lacking = np.zeros((1, n)), height[0] - float(s.d[k, 2])
            row[0, i] = _UNIT[2]
            row[0, TURN] = -pin.skew(s.d[k])[2]
            if lacking**2 < LIKELY * (float(row[0] @ P @ row[0]) + height[1] ** 2):
                self._correct(row, np.array([lacking]), np.array([height[1] ** 2]))

    def shift(self, k: int, ahead: float) -> None:
        """A foot that stands is seen by another point of its sole, so far ahead along it [m].

        That is d + Z r for the way r in the sole's axes. Its error is ξ_d - hat(Z r) (ζ - ξ_R).
        """
        s, P, i = self.stand, self.P, FOOT[k]
        way = ahead * s.Z[k][:, 0]
        lever = pin.skew(way)
        s.columns[2 + k] += way
        P[i] -= lever @ (P[SOLE[k]] - P[TURN])
        P[:, i] -= (P[:, SOLE[k]] - P[:, TURN]) @ lever.T

    def lift(self, k: int) -> None:
        """A foot stands no longer."""
        self.standing[k] = False

    def weigh(self, J: Array) -> None:
        """Gain and covariance after the ticks since the last time; J as in `begin`.

        A covariance that is not positive is none, nor is the state that follows from it: it becomes NaN.
        """
        ticks, self._taken, self._count = float(self._taken or NONE), 0, 0
        for k in range(2):
            if self.standing[k]:
                self._feet[self._count] = k
                self._count += 1
        if self._count and not self.covariance.weigh(self._feet[: self._count], J, ticks):
            self.P[:] = self.covariance.gain[:] = np.nan

    def _see(self, y: Array, Y: Array) -> None:
        """Residual of the standing feet: R y + p - d, log(R Y Zᵀ)."""
        R, columns, Z = self.stand._R, self.stand._columns, self.stand._Z
        seen, apart = self._half, self._apart
        for i in range(self._count):
            k = self._feet[i]
            way = algebra.subtract(algebra.row(columns, 1), algebra.row(columns, 2 + k))
            algebra.compose(R, Y[k], seen)
            linear.row_products(seen, Z[k], apart)
            algebra.put(self._residual[POSE * i :], algebra.add(algebra.rotate(R, algebra.row(y, k)), way))
            algebra.put(self._residual[POSE * i + 3 :], algebra.rotation_vector(apart))

    def _square(self, first: int, end: int) -> float:
        """Square of some numbers of the residual, normalised by their covariance [-]."""
        return linear.quadratic(self.covariance._weights[first:end, first:end], self._residual[first:end])

    def correct(self, y: Array, Y: Array, gates: tuple[float, float] = GATES) -> tuple[int, ...]:
        """Take the kinematics of a tick.

        Args:
            y: sole centres in the frame of the IMU, shape (2, 3) [m].
            Y: their orientations, shape (2, 3, 3).
            gates: square of the residual of one foot and of two from which on one has slipped; infinite
                where standing feet are known to stand still [-].

        Returns:
            the feet that have slipped. Nothing of the tick is taken then, also of the other foot: they are to land
            anew, and the tick is to be taken after it. Empty where none has slipped, and all is taken.
        """
        if not self._count:
            return ()
        seen = POSE * self._count
        self._see(y, Y)
        if self._square(0, seen) > gates[self._count - 1]:
            return self._slipped()
        linear.multiply(self.covariance._gain[:, :seen], self._residual[:seen], self._moved)
        self.stand.move(self._moved)
        self._taken += 1
        return ()

    def _slipped(self) -> tuple[int, ...]:
        """The feet whose own residuals are not likely, and the one whose is the least in any case."""
        likely = [self._square(POSE * i, POSE * (i + 1)) for i in range(self._count)]
        least = min(GATES[0], max(likely))
        return tuple([self._feet[i] for i in range(self._count) if likely[i] >= least])

    @property
    def finite(self) -> bool:
        """Return true if state and covariance are numbers."""
        return bool(np.isfinite(self.stand.columns.sum()) and np.isfinite(np.trace(self.P)))
