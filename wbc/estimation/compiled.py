"""The invariant filter's kernels, and the base that follows, on the arrays of its state."""

import numpy as np

from surefoot.native.library import Block, Bound, Library
from surefoot.similarity import GRAVITY
from surefoot.wbc.estimation.parameters import GroundNoise, SensorNoise
from surefoot.wbc.estimation.stand import Stand
from surefoot.wbc.types import Array, RobotState

POSE, FEET = 6, 2


class FilterKernels:
    """What a filter does with the readings of a tick while its gain holds, and how it comes to the next gain.

    Args:
        kernels: the library.
        stand: state of the filter, whose arrays stay where they are.
        P: covariance of its error, which stays likewise, shape (n, n).
        sensors: noise of the sensors.
        ground: what feet and ground add.
        sinking: how far a standing sole sinks in a second, with the root of the time [m].
        leaning: how far it turns about its line likewise [rad].
        unsure: deviation of its ways on springs over these [-].

    Attributes:
        covariance: as other kernels take it.
        gain: of the standing feet, shape (n, 6 feet).
        weights: inverse of their residual's covariance, shape (6 feet, 6 feet).
    """

    def __init__(
        self,
        kernels: Library,
        stand: Stand,
        P: Array,
        sensors: SensorNoise,
        ground: GroundNoise,
        sinking: float,
        leaning: float,
        unsure: float,
    ) -> None:
        n, rows = len(P), POSE * FEET
        self._rate, self._force, self._acceleration = np.zeros(3), np.zeros(3), np.zeros(3)
        self._position, self._rotation = np.zeros((FEET, 3)), np.zeros((FEET, 3, 3))
        self._all_gain, self._all_weights = np.zeros(n * rows), np.zeros(rows * rows)
        self._feet, self._residual, self._size = np.zeros(FEET, dtype=np.int64), np.zeros(rows), n
        self._filter = kernels.fill(
            "Filter",
            size=n,
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
            gain=self._all_gain,
            weights=self._all_weights,
            residual=self._residual,
            moved=np.zeros(n),
        )
        self._loads, self._sprung, self._standing = np.zeros(FEET), np.zeros((FEET, 3)), np.zeros(FEET, dtype=np.int64)
        self._jacobian = np.zeros((FEET, POSE, len(stand.offsets)))
        self.covariance: Bound = kernels.fill(
            "Covariance",
            filter=self._filter,
            gyro_density=sensors.gyro_density,
            speed_density=sensors.accelerometer_density**2 + ground.model**2,
            gyro_walk=sensors.gyro_walk,
            force_walk=sensors.accelerometer_walk,
            creep=ground.creep,
            sinking=sinking,
            rocking=ground.rocking,
            light=ground.light,
            leaning=leaning,
            unsure=unsure,
            kinematics=ground.kinematics,
            turning=ground.turning,
            encoder=sensors.encoder,
            on_springs=0,
            loads=self._loads,
            sprung=self._sprung,
            standing=self._standing,
            jacobian=self._jacobian,
            P=P,
            gain=self._all_gain,
            weights=self._all_weights,
            turned=np.zeros((rows, len(stand.offsets))),
            PH=np.zeros((n, rows)),
            HP=np.zeros((rows, n)),
        )
        self._propagate, self._correct = (
            kernels.bind(name, self._filter) for name in ("filter_propagate", "filter_correct")
        )
        self._spread, self._weigh = (
            kernels.bind(name, self.covariance) for name in ("covariance_spread", "covariance_weigh")
        )
        self.gain: Array = self._all_gain.reshape(n, rows)
        self.weights: Array = self._all_weights.reshape(rows, rows)

    def propagate(self, rate: Array, force: Array, time: float) -> Array:
        """See `InvariantFilter.propagate`; returns the acceleration of the IMU, shape (3,) [m/s^2]."""
        self._rate[:], self._force[:] = rate, force
        self._propagate(time)
        return self._acceleration

    def spread(self, time: float, loads: tuple[float, float], sprung: Array | None, standing: list[bool]) -> None:
        """See `InvariantFilter.spread`, over a time [s], with these feet standing."""
        self._loads[:], self._standing[:] = loads, standing
        self.covariance.struct.on_springs = sprung is not None
        if sprung is not None:
            self._sprung[:] = sprung
        self._spread(time)

    def weigh(self, feet: list[int], J: Array, ticks: float) -> bool:
        """See `InvariantFilter.weigh`, of these feet; returns whether it was done, which needs positive covariances."""
        rows = POSE * len(feet)
        self._feet[: len(feet)], self._jacobian[:] = feet, J
        self._filter.struct.feet_count = len(feet)
        self.gain = self._all_gain[: self._size * rows].reshape(-1, rows)
        self.weights = self._all_weights[: rows * rows].reshape(rows, rows)
        return not self._weigh(ticks)

    def correct(self, y: Array, Y: Array, gate: float) -> Array | None:
        """See `InvariantFilter.correct`; returns the residual where a foot has slipped, of which nothing is taken."""
        self._position[:], self._rotation[:] = y, Y
        return self._residual if self._correct(gate) else None


class StateKernel:
    """The state of the robot now, by that of a filter and an IMU that no joint moves against the base.

    Args:
        kernels: the library.
        stand: state of the filter, whose arrays stay where they are.
        mount: orientation of the IMU in the base, shape (3, 3), and its place there, shape (3,) [m].
        chain: joints of which the filter finds the zeros, shape (m,); the offsets after these are of the mount.
        joints: how many there are.
        rate: angular velocity of the IMU with its bias, in an array that stays likewise, shape (3,) [rad/s].
        diverged: place and speed, of base and joints together, from which on an estimate is none [m; m/s, rad/s].
    """

    def __init__(
        self,
        kernels: Library,
        stand: Stand,
        mount: tuple[Array, Array],
        chain: Array,
        joints: int,
        rate: Array,
        diverged: tuple[float, float],
    ) -> None:
        self._position, self._velocity, self._gained = np.zeros(joints), np.zeros(joints), np.zeros(POSE)
        self._state = Block((7 + joints,), (POSE + joints,))
        q, v = self._state.arrays
        self._now = kernels.bind(
            "sensed_base_now",
            joints=joints,
            chain_count=len(chain),
            chain=chain,
            farthest=diverged[0],
            fastest=diverged[1],
            R=stand.R,
            columns=stand.columns,
            gyro_bias=stand.gyro_bias,
            offsets=stand.offsets,
            mount=np.ascontiguousarray(mount[0]),
            lever=np.array(mount[1]),
            rate=rate,
            gained=self._gained,
            position=self._position,
            velocity=self._velocity,
            q=q,
            v=v,
        )

    def __call__(self, position: Array, velocity: Array, gained: Array | None, late: float) -> RobotState | None:
        """The state; None of one that has diverged.

        Args:
            position: of the joints by their encoders, shape (nj,) [rad].
            velocity: of the joints, shape (nj,) [rad/s].
            gained: what the base was planned to gain since the readings, shape (6,) [m/s, rad/s]; None of new ones.
            late: how old they are [s].
        """
        self._position[:], self._velocity[:] = position, velocity
        if gained is not None:
            self._gained[:] = gained
        return RobotState(*self._state.copied()) if self._now(0.0 if gained is None else late) else None
