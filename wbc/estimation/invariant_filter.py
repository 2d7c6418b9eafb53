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

from surefoot.native.library import Bound, library
from surefoot.similarity import GRAVITY
from surefoot.wbc.estimation.compiled import FilterKernels
from surefoot.wbc.estimation.parameters import GroundNoise, SensorNoise
from surefoot.wbc.estimation.stand import AXES, FOOT, FORCE, GYRO, OFFSETS, POSITION, SOLE, TURN, VELOCITY, Stand
from surefoot.wbc.types import Array

FIXED = 27
"""Numbers of the error beside the offsets."""

_SIX = (np.r_[FOOT[0], SOLE[0]], np.r_[FOOT[1], SOLE[1]])
_BODY = np.r_[POSITION, TURN]
_FALL = np.array([0.0, 0.0, -GRAVITY])
_FALLING = pin.skew(_FALL)
_UNIT = np.eye(3)

LEANING = 3.0
"""By how much a sole that leans turns about its line in a second, as a deviation: it tells of nothing else [rad/√s]."""

LIKELY = 9.0
"""Square of the normalised height of a landing over the ground that is believed, from which on it is another ground: by
chance in one of 370 landings, which then tells no height [-]."""

UNSURE = 0.5
"""Deviation of what springs under a sole do, over what they are believed to do [-]."""

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
        period: control period [s].
        leaning: the soles stand on lines along them, about which they turn at will.

    Attributes:
        stand: the state.
        P: covariance of its error, shape (30 + m, 30 + m), in an array that stays where it is.
        acceleration: of the IMU in the world, last, shape (3,) [m/s^2].
        standing: feet that stand, left first.
    """

    def __init__(
        self, stand: Stand, sensors: SensorNoise, ground: GroundNoise, period: float, leaning: bool = False
    ) -> None:
        self._leaning = leaning
        self.stand, self._sensors, self._ground, self._period = stand, sensors, ground, period
        n = FIXED + len(stand.offsets)
        self.P, self._F = np.zeros((n, n)), np.eye(n)
        self.acceleration = np.zeros(3)
        self.standing = [True, True]
        # The soles stand where the kinematics of the start say.
        self._since, self._taken = 0.0, 1
        self._gain: Array | None = None
        self._feet: list[int] = []
        kernels = library()
        # Springs under one edge give twice as much.
        self._sinking, self._turns = ((2.0 if leaning else 1.0) * ground.sinking, LEANING if leaning else 0.0)
        ways = self._sinking, self._turns, UNSURE
        self._kernels = FilterKernels(kernels, stand, self.P, sensors, ground, *ways) if kernels else None
        spread = np.zeros(n)
        spread[VELOCITY], spread[GYRO], spread[FORCE] = 1e-3, sensors.gyro_bias, sensors.accelerometer_bias
        spread[OFFSETS], spread[-AXES:] = sensors.encoder_offset, sensors.mounting
        self.P[np.diag_indices(n)] = spread**2

    def begin(self, y: Array, Y: Array, J: Array, normals: Array, tilt: float) -> None:
        """Attitude and height from soles that are level on the ground.

        They give the world's heading and place, too. An offset found later turns the IMU, not the way of the soles.

        Args:
            y: sole centres in the frame of the IMU, shape (2, 3) [m].
            Y: their orientations, shape (2, 3, 3).
            J: Jacobians of both as of `SensedBody.offset_jacobians`, shape (2, 6, m + 3).
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
        self._since += time
        if self._kernels is not None:
            self.acceleration = self._kernels.propagate(rate, force, time)
            return
        s = self.stand
        # The mean force is of the frame half way through the turn.
        half = pin.exp3((rate - s.gyro_bias) * (0.5 * time))
        middle = s.R @ half
        self.acceleration = a = middle @ (force - s.force_bias) + _FALL
        v, p = s.columns[:2]
        s.columns[1] = p + time * v + (0.5 * time * time) * a
        s.columns[0] = v + time * a
        s.R[:] = middle @ half

    def transition(self, time: float) -> tuple[Array, Array]:
        """What becomes of an error over a time [s], shape (n, n), and what turns about world axes do, shape (15, 3)."""
        s, F, B = self.stand, self._F, np.empty((15, 3))
        B[:3] = _UNIT
        for i, column in enumerate(s.columns):
            B[3 + 3 * i : 6 + 3 * i] = pin.skew(column)
        F[VELOCITY, TURN] = time * _FALLING
        F[POSITION, VELOCITY] = time * _UNIT
        F[POSITION, TURN] = (0.5 * time * time) * _FALLING
        F[:15, GYRO] = -time * (B @ s.R)
        F[VELOCITY, FORCE] = -time * s.R
        return F, B

    def spread(self, loads: tuple[float, float], sprung: Array | None = None) -> None:
        """Covariance of the way since it was computed last.

        Args:
            loads: shares of the weight on the soles [-].
            sprung: by how much each sole has rolled, pitched and risen on springs in that time, in its own axes, shape
                (2, 3), with half of that as its deviation; None where nobody knows [rad, rad, m].
        """
        dt, self._since = self._since, 0.0
        if dt <= 0.0:
            return
        if self._kernels is not None:
            self._kernels.spread(dt, loads, sprung, self.standing)
            return
        sensors, ground = self._sensors, self._ground
        F, B = self.transition(dt)
        P = self.P
        P[:] = F @ P @ F.T
        P[:15, :15] += (sensors.gyro_density**2 * dt) * (B @ B.T)
        D = np.einsum("ii->i", P)
        D[VELOCITY] += (sensors.accelerometer_density**2 + ground.model**2) * dt
        D[GYRO] += sensors.gyro_walk**2 * dt
        D[FORCE] += sensors.accelerometer_walk**2 * dt
        for k in (0, 1):
            more = 1.0 + (ground.light - 1.0) * (1.0 - min(2.0 * loads[k], 1.0))
            if self.standing[k]:
                D[FOOT[k]] += np.square(more * np.array([ground.creep, ground.creep, self._sinking])) * dt
                D[SOLE[k]] += (more * ground.rocking) ** 2 * dt
                if sprung is not None:
                    turned, risen = self.stand.Z[k, :, :2] @ sprung[k, :2], float(sprung[k, 2])
                    D[FOOT[k].stop - 1] += (UNSURE * risen) ** 2
                    D[SOLE[k]] += (UNSURE * turned) ** 2
                    self.stand.columns[2 + k, 2] += risen
                    self.stand.Z[k] = pin.exp3(turned) @ self.stand.Z[k]
                line = self.stand.Z[k, :, 0]
                P[SOLE[k], SOLE[k]] += (self._turns**2 * dt) * np.outer(line, line)

    def land(
        self, k: int, y: Array, Y: Array, J: Array, height: tuple[float, float] | None, place: float, turn: float
    ) -> None:
        """A foot stands from now on: it is where the kinematics say.

        Args:
            k: foot.
            y: its sole's centre in the frame of the IMU, shape (3,) [m].
            Y: its orientation, shape (3, 3).
            J: Jacobian of both as of `SensedBody.offset_jacobians`, shape (6, m + 3).
            height: of the ground there, as it is believed, and its deviation; None where that is not known. A foot
                that cannot have landed on that by all that is known has found a step of the ground [m].
            place: deviation of where it comes to rest [m].
            turn: likewise of how it is turned [rad].
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

    def lift(self, k: int) -> None:
        """A foot stands no longer."""
        self.standing[k] = False

    def weigh(self, J: Array) -> None:
        """Gain and covariance after the ticks since the last time; J as in `begin`."""
        self._feet = feet = [k for k in (0, 1) if self.standing[k]]
        ticks, self._taken = float(self._taken or NONE), 0
        if not feet:
            self._gain = None
            return
        kernels = self._kernels
        if kernels is not None and kernels.weigh(feet, J, ticks):
            self._gain, self._weights = kernels.gain, kernels.weights
            return
        rows = np.concatenate([_SIX[k] for k in feet])
        columns = np.tile(_BODY, len(feet))
        R = self.stand.R
        turned = np.concatenate([(R @ J[k].reshape(2, 3, -1)).reshape(6, -1) for k in feet])
        PH = self.P[:, rows] - self.P[:, columns] + self.P[:, OFFSETS] @ turned.T
        S = PH[rows] - PH[columns] + turned @ PH[OFFSETS]
        ground, encoder = self._ground, self._sensors.encoder
        levers = (J[feet, :, :-AXES].reshape(6 * len(feet), -1) ** 2).sum(axis=1) * encoder**2
        noise = levers + np.tile([ground.kinematics**2] * 3 + [ground.turning**2] * 3, len(feet))
        many = S.copy()
        many[np.diag_indices_from(S)] += noise / ticks
        S[np.diag_indices_from(S)] += noise
        self.P -= PH @ np.linalg.solve(many, PH.T)
        self.P[:] = 0.5 * (self.P + self.P.T)
        inverse = np.linalg.inv(S)
        self._gain, self._weights = PH @ inverse, inverse
        if kernels is not None:
            kernels.gain[:], kernels.weights[:] = self._gain, inverse

    def residual(self, y: Array, Y: Array) -> Array:
        """How far the standing feet are from where the kinematics say, shape (6 feet,) [m, rad]."""
        s, found = self.stand, np.empty(6 * len(self._feet))
        for i, k in enumerate(self._feet):
            found[6 * i : 6 * i + 3] = s.R @ y[k] - s.columns[2 + k] + s.columns[1]
            found[6 * i + 3 : 6 * i + 6] = pin.log3(s.R @ Y[k] @ s.Z[k].T)
        return found

    def correct(self, y: Array, Y: Array, gates: tuple[float, float] = GATES) -> tuple[int, ...]:
        """Take the kinematics of a tick.

        Args:
            y: as of `begin`.
            Y: likewise.
            gates: as of `GATES`; infinite where standing feet are known to stand still.

        Returns:
            the feet that have slipped. Nothing of the tick is taken then, also of the other foot: they are to land
            anew, and the tick is to be taken after it. Empty where none has slipped, and all is taken.
        """
        if self._gain is None:
            return ()
        if self._kernels is not None:
            slipped = self._kernels.correct(y, Y, gates[len(self._feet) - 1])
            if slipped is not None:
                return self._slipped(slipped)
        else:
            r = self.residual(y, Y)
            if float(r @ self._weights @ r) > gates[len(self._feet) - 1]:
                return self._slipped(r)
            self.stand.move(self._gain @ r)
        self._taken += 1
        return ()

    def _slipped(self, r: Array) -> tuple[int, ...]:
        """The feet whose own residuals are not likely, and the one whose is the least in any case."""
        blocks = [self._weights[6 * i : 6 * i + 6, 6 * i : 6 * i + 6] for i in range(len(self._feet))]
        likely = [float(r[6 * i : 6 * i + 6] @ block @ r[6 * i : 6 * i + 6]) for i, block in enumerate(blocks)]
        return tuple(k for k, square in zip(self._feet, likely, strict=True) if square >= min(GATES[0], max(likely)))

    @property
    def compiled(self) -> Bound | None:
        """It as kernels take it; None for plain Python."""
        return None if self._kernels is None else self._kernels.covariance

    @property
    def finite(self) -> bool:
        """Whether state and covariance are numbers."""
        return bool(np.isfinite(self.stand.columns.sum() + np.trace(self.P)))
