"""The state of a robot from its sensors: joint observer, contacts, invariant filter, and how sure all of that is."""

from collections import deque

import numpy as np
import pinocchio as pin

from surefoot.readings import Reading, Readings
from surefoot.wbc.estimation.base import FARTHEST, FASTEST, FloatingBase
from surefoot.wbc.estimation.contact import SoleContact, sprung
from surefoot.wbc.estimation.doubt import Doubt
from surefoot.wbc.estimation.estimate import Deviation, Estimate, Planned
from surefoot.wbc.estimation.invariant_filter import InvariantFilter
from surefoot.wbc.estimation.joints import KEPT, JointObserver
from surefoot.wbc.estimation.kinematics import Footing, ImuMount, SensedBody
from surefoot.wbc.estimation.parameters import EstimatorParameters
from surefoot.wbc.estimation.rates import RateFilter
from surefoot.wbc.estimation.stand import AXES, Stand
from surefoot.wbc.estimation.torques import TorqueWrench
from surefoot.wbc.types import GRAVITY, Array, RobotState

ATTITUDE = 0.1
"""How far off the attitude may be before the soles are taken for level [rad]."""


class SensedState:
    """State, wrenches and contacts of a robot from its readings, once per control tick; knows neither plan nor world.

    Args:
        model: of the robot, with a free-flyer base.
        soles: names of the sole frames, left first.
        mount: of the IMU.
        footing: how it stands, on level soles, at the first tick.
        period: control period [s].
        parameters: noise and thresholds.
    """

    def __init__(
        self,
        model: pin.Model,
        soles: tuple[str, str],
        mount: ImuMount,
        footing: Footing,
        period: float,
        parameters: EstimatorParameters,
    ) -> None:
        self._parameters, self._footing, self._period = parameters, footing, period
        self._model, self._sole_names = model, soles
        sensors = parameters.sensors
        self._body = SensedBody(model, soles, mount, footing.leaning)
        self._weight = GRAVITY * self._body.mass
        self._joints = JointObserver(model.nv - 6, period, parameters.joint_bandwidth, sensors.encoder)
        self._contact: SoleContact
        self._every = max(1, round(1.0 / (parameters.covariance_rate * period)))
        self._torques: TorqueWrench | None = None
        self._torques_at, self._encoders = 0, np.zeros(0)
        self._filter: InvariantFilter | None = None
        self._base: FloatingBase | None = None
        self._tick, self._imu_at, self._from = -1, 0, 0.0
        self._base_told: deque[Array] = deque(maxlen=KEPT)
        self._still, self._lost = [True, True], False
        self._state: RobotState | None = None
        self._deviation: Deviation | None = None
        self._doubt = Doubt(self._body, sensors, self._joints.rate_noise)
        self._rate: RateFilter
        self._above = np.zeros(2)
        self._load = np.zeros((2, 6))

    @property
    def filter(self) -> InvariantFilter:
        """The filter; there is none before the first tick."""
        assert self._filter is not None
        return self._filter

    def told(self, planned: Planned) -> None:
        """Hear what the controller does until the next tick."""
        # What is planned for a state that is lost is no motion of the robot.
        bend = planned.acceleration[6:]
        self._joints.told(np.zeros_like(bend) if self._lost else bend)
        self._base_told.append(planned.acceleration[:6])
        self._still = [planned.contact[k] and k != planned.rolling_foot for k in (0, 1)]

    def sense(self, readings: Readings) -> Estimate:
        """The estimate of a tick, by the time of its readings, which may come at any."""
        parameters = self._parameters
        if self._tick < 0:
            self._from = readings.time
        self._tick = round((readings.time - self._from) / self._period)
        q, qd = self._joints.update(readings)
        if self._filter is None:
            self._filter = self._start(readings.joint_position.values)
            gyro = readings.angular_velocity.values
            self._rate = RateFilter(gyro, self._period, parameters.sensors.gyro_density, parameters.ground.turning_plan)
            self._contact = self._feeling(readings)
            self._contact.update(self._wrench(readings), self._still, self._above)
            self._load = self._contact.wrench
            self._base = self._fixed(len(q))
            # First readings that are not finite make a state that is not, which the controller tells.
            nowhere = RobotState(np.full(7 + len(q), np.nan), np.full(6 + len(q), np.nan))
            self._state = self._now(q, qd) or nowhere
            self._deviation = self._unsure(self._body.offset_jacobians())
        elif not self._lost:
            with np.errstate(all="ignore"):
                self._step(readings)
                now = self._now(q, qd)
            if now is None or not (self._tick % self._every or self.filter.finite):
                self._lost = True
            else:
                self._state = now
        state = self._state
        assert state is not None
        if self._lost:
            # The walk is lost with it; what is left falls as a body does.
            state = RobotState(np.concatenate((state.q[:7], q)), np.concatenate((np.zeros(6), qd)))
        self._state = state
        contact, felt = self._contact, self._contact.felt
        return Estimate(state, contact.wrench, (felt[0], felt[1]), self._deviation, self._channels(), contact.age)

    def _fixed(self, joints: int) -> FloatingBase | None:
        """The base of an IMU that no joint moves against it."""
        body = self._body
        if body.mount is None:
            return None
        return FloatingBase(self.filter.stand, body.mount, body.chain, self._rate.rate, joints)

    def _channels(self) -> dict[str, Array]:
        s = self.filter.stand
        biases = {"gyro_bias": s.gyro_bias.copy(), "force_bias": s.force_bias.copy()}
        return {**biases, "offsets": s.offsets[:-AXES].copy(), "mounting": s.mounting.copy()}

    def _feeling(self, readings: Readings) -> SoleContact:
        """Contact by sensors in the feet, or by the torques of the joints."""
        parameters, deviation = self._parameters, None
        if readings.wrench is None:
            at_ends = readings.joint_velocity is not None
            self._torques = TorqueWrench(self._model, self._sole_names, self._period, parameters.sensors, at_ends)
            self._torques.update(self._measured(readings), readings.joint_torque.values)
            deviation = self._torques.deviation
        return SoleContact(
            parameters.contact, parameters.sensors, self._weight, self._footing.half_size, self._period, deviation
        )

    def _wrench(self, readings: Readings) -> Reading:
        """Of the feet, by their sensors or by the torques of the joints."""
        if readings.wrench is not None:
            return readings.wrench
        torques, torque = self._torques, readings.joint_torque
        assert torques is not None
        at = self._tick - round(torque.age / self._period)
        if at > self._torques_at:
            torques.update(self._measured(readings), torque.values, (at - self._torques_at) * self._period)
            self._torques_at = at
        return Reading(torques.wrench, torque.age + torques.late, True)

    def _measured(self, readings: Readings) -> RobotState:
        """The state of the encoders' last way: its mean velocity, which is that of its middle.

        What observes the joints follows an impact later than the IMU does, which would be a force that is none.
        """
        s, reading = self.filter.stand, readings.joint_position
        joints, at = self._body.known(reading.values, s.offsets), self._tick - round(reading.age / self._period)
        rate, v = readings.angular_velocity.values - s.gyro_bias, s.v
        if readings.joint_velocity is not None:
            speed = readings.joint_velocity.values
        elif at > self._torques_at:
            time = (at - self._torques_at) * self._period
            speed = (reading.values - self._encoders) / time
            v = v - (0.5 * time) * self.filter.acceleration
        else:
            speed = np.zeros(len(joints))
        self._encoders = reading.values
        base, p, velocity = self._body.base(s.R, s.p, v, rate, joints, speed, s.mounting)
        return RobotState(np.concatenate((p, pin.Quaternion(base).coeffs(), joints)), np.concatenate((velocity, speed)))

    def _start(self, joints: Array) -> InvariantFilter:
        body, footing = self._body, self._footing
        R, normals = footing.attitude(body, joints), footing.normals()
        p = (footing.position - body.position @ R.T).mean(axis=0)
        m = len(body.chain) + AXES
        columns = np.vstack((np.zeros(3), p, footing.position))
        stand = Stand(R, columns, np.zeros((2, 3, 3)), np.zeros(3), np.zeros(3), np.zeros(m))
        parameters, leaning = self._parameters, footing.leaning is not None
        filter_ = InvariantFilter(stand, parameters.sensors, parameters.ground, leaning)
        J = body.offset_jacobians()
        filter_.begin(body.position, body.rotation, J, normals, ATTITUDE)
        body.update(joints, filter_.stand.R, filter_.stand.offsets)
        filter_.weigh(J)
        return filter_

    def _step(self, readings: Readings) -> None:
        filter_, contact, body = self.filter, self._contact, self._body
        rate, force = readings.mean_angular_velocity, readings.specific_force
        at = self._tick - round(rate.age / self._period)
        if at > self._imu_at:
            filter_.propagate(rate.values, force.values, (at - self._imu_at) * self._period)
            self._rate.update(readings.angular_velocity.values, self._gained(at), at - self._imu_at)
            self._imu_at = at
        contact.update(self._wrench(readings), self._still, self._above)
        body.update(readings.joint_position.values, filter_.stand.R, filter_.stand.offsets)
        changed = contact.firm != filter_.standing
        due = changed or self._tick % self._every == 0
        if due:
            J = body.offset_jacobians()
            force_z = contact.wrench[:, 2] / self._weight
            filter_.spread((max(float(force_z[0]), 0.0), max(float(force_z[1]), 0.0)), self._sprung())
            if changed:
                self._change(J)
            filter_.weigh(J)
        if readings.joint_position.fresh:
            slipped = filter_.correct(body.position, body.rotation)
            if slipped:
                J = body.offset_jacobians()
                filter_.spread((0.5, 0.5))
                for k in slipped:
                    self._land(k, J, None)
                filter_.weigh(J)
                filter_.correct(body.position, body.rotation)
        if due:
            self._deviation = self._unsure(J)
            self._above = self._over_ground()

    def _sprung(self) -> Array | None:
        """How each sole moved on the springs of the ground since this was asked last, as of `sprung`.

        None of soles that lean: which springs bear them changes with how they do.
        """
        if self._footing.leaning is not None:
            return None
        changed = self._contact.wrench - self._load
        self._load = self._contact.wrench
        return sprung(changed, self._footing.half_size, self._parameters.ground.depth / self._weight)

    def _gained(self, at: int) -> Array | None:
        """Angular velocity that the IMU was planned to gain from its last reading to that of a tick, shape (3,)."""
        told, first = self._base_told, self._imu_at - self._tick
        if len(told) < -first:
            return None
        gained = told[first][3:]
        for back in range(first + 1, at - self._tick):
            gained = gained + told[back][3:]
        return self._body.turned_to_imu(self._period * gained)

    def _unsure(self, J: Array) -> Deviation:
        return self._doubt.deviation(self.filter, self._contact, self._rate.deviation, J)

    def _change(self, J: Array) -> None:
        filter_, firm = self.filter, self._contact.firm
        for k in (0, 1):
            if filter_.standing[k] and not firm[k]:
                filter_.lift(k)
        for k in (0, 1):
            if firm[k] and not filter_.standing[k]:
                self._land(k, J, self._height(k))

    def _height(self, k: int) -> tuple[float, float] | None:
        """Of the ground under a sole, and its deviation; None where nothing is known of it [m]."""
        s, deviation = self.filter.stand, self._parameters.ground.height
        foot = s.p + s.R @ self._body.position[k]
        return (self._footing.height(float(foot[0]), float(foot[1])), deviation) if deviation > 0.0 else None

    def _land(self, k: int, J: Array, height: tuple[float, float] | None) -> None:
        """A foot stands anew, on ground of that height; one that slipped is on ground that has told its own before."""
        body, noise = self._body, self._parameters.ground
        self.filter.land(k, body.position[k], body.rotation[k], J[k], height, noise.landing, noise.landing_turn)

    def _over_ground(self) -> Array:
        """How far the soles are over the ground, shape (2,) [m]."""
        s, height = self.filter.stand, self._footing.height
        soles = (s.p + self._body.position @ s.R.T).tolist()
        return np.array([z - height(x, y) for x, y, z in soles])

    def _now(self, q: Array, qd: Array) -> RobotState | None:
        """The state now, which is older by the age of the IMU's readings; None of one that has diverged."""
        s, told, late = self.filter.stand, self._base_told, self._tick - self._imu_at
        gained, time = None, late * self._period
        if late and told:
            # What the controller has planned since; its velocity is that of the base in its own axes.
            gained = told[-1]
            for back in range(2, min(late, len(told)) + 1):
                gained = gained + told[-back]
            gained = self._period * gained
        if self._base is not None:
            return self._base.state(q, qd, gained, time)
        q = self._body.known(q, s.offsets)
        base, p, velocity = self._body.base(s.R, s.p, s.v, self._rate.rate - s.gyro_bias, q, qd, s.mounting)
        if gained is not None:
            way = time * (velocity + 0.5 * gained)
            turn = pin.exp3(0.5 * way[3:])
            half = base @ turn
            p, base, velocity = p + half @ way[:3], half @ turn, velocity + gained
        place = np.concatenate((p, pin.Quaternion(base).coeffs()))
        state = RobotState(np.concatenate((place, q)), np.concatenate((velocity, qd)))
        # Nothing that is not finite is less than a number.
        return state if place @ place < FARTHEST**2 and state.v @ state.v < FASTEST**2 else None
