"""The state of a robot from its sensors: joint observer, contacts, invariant filter, and how sure all of that is."""

from dataclasses import replace
from typing import Any

import numpy as np
import pinocchio as pin

from surefoot.maths import algebra
from surefoot.maths.algebra import Vector
from surefoot.readings import Reading, Readings
from surefoot.wbc.estimation.base import FloatingBase
from surefoot.wbc.estimation.contact import SoleContact, sprung
from surefoot.wbc.estimation.doubt import Doubt
from surefoot.wbc.estimation.estimate import Estimate, Planned
from surefoot.wbc.estimation.footing import Footing, ImuMount
from surefoot.wbc.estimation.invariant_filter import InvariantFilter
from surefoot.wbc.estimation.joints import KEPT, JointObserver
from surefoot.wbc.estimation.kinematics import SensedBody
from surefoot.wbc.estimation.parameters import EstimatorParameters
from surefoot.wbc.estimation.rates import RateFilter
from surefoot.wbc.estimation.stand import AXES, Stand
from surefoot.wbc.estimation.torques import TorqueWrench
from surefoot.wbc.types import GRAVITY, Array, RobotState

ATTITUDE = 0.1
"""Error of the attitude up to which the soles are not taken for level [rad]."""


class SensedState:
    """State, wrenches and contacts of a robot from its readings, once per control tick; knows neither plan nor world.

    Args:
        model: of the robot, with a free-flyer base.
        soles: names of the sole frames, left first.
        mount: of the IMU.
        footing: how it stands, on level soles, at the first tick.
        period: control period [s].
        parameters: noise and thresholds.

    Attributes:
        parameters: as given.
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
        self.parameters, self._footing, self._period = parameters, footing, period
        self._model, self._sole_names, self._count = model, soles, model.nv - 6
        sensors = parameters.sensors
        self._body = SensedBody(model, soles, mount, footing.leaning)
        self._weight = GRAVITY * self._body.mass
        self._joints = JointObserver(self._count, period, parameters.joint_bandwidth, sensors.encoder)
        self._every = max(1, round(1.0 / (parameters.covariance_rate * period)))
        self._torques: TorqueWrench | None = None
        self._torques_at, self._encoders = 0, np.zeros(0)
        self._begun, self._lost, self._still = False, False, [True, True]
        self._edge = (0, 0)
        self._tick, self._imu_at, self._from = -1, 0, 0.0
        self._accelerations, self._accelerated = np.zeros((KEPT, 6)), 0
        self._gained, self._turned, self._unmoved = np.zeros(6), np.zeros(3), np.zeros(self._count)
        self._above = np.zeros(2)
        self._load = np.zeros((2, 6))
        joints, axes = (self._count,), (3,)
        shapes: dict[str, tuple[int, ...]] = {"joint_position": joints, "joint_torque": joints}
        shapes |= {"angular_velocity": axes, "mean_angular_velocity": axes, "specific_force": axes}
        self._shapes = tuple({**shapes, "joint_velocity": joints, "wrench": (2, 6)}.items())

    @property
    def filter(self) -> InvariantFilter:
        """The filter; there is none before the first tick."""
        assert self._begun
        return self._filter

    def told(self, planned: Planned) -> None:
        """Hear what the controller does until the next tick."""
        self._remember(planned.acceleration)
        self._still, self._edge = list(planned.contact), planned.edge

    def _remember(self, acceleration: Array) -> None:
        """Generalised accelerations until the next tick, shape (6 + nj,)."""
        if self._lost:
            # What is planned for a state that is lost is no motion of the robot.
            self._joints.drive(self._unmoved)
        else:
            self._joints.drive(acceleration[6:])
        slot = self._accelerated % len(self._accelerations)
        for i in range(6):
            self._accelerations[slot, i] = acceleration[i]
        self._accelerated += 1

    def sense(self, readings: Readings) -> Estimate:
        """The estimate of a tick, by the time of its readings, which may come at any.

        Raises:
            ValueError: values of a reading have another shape, or are no numbers.
        """
        readings = self._fitting(readings)
        if self._tick < 0:
            self._from = readings.time
        self._tick = round((readings.time - self._from) / self._period)
        q, v = self._joints.update(readings)
        if not self._begun:
            self._begin(readings)
            # First readings that are not finite make a state that is not, which the controller tells.
            nowhere = RobotState(np.full(7 + len(q), np.nan), np.full(6 + len(q), np.nan))
            self._state = self._now() or nowhere
        elif not self._lost:
            with np.errstate(all="ignore"):
                self._step(readings)
                now = self._now()
            if now is None or not (self._tick % self._every or self._filter.finite):
                self._lost = True
            else:
                self._state = now
        if self._lost:
            # The walk is lost with it; what is left falls as a body does.
            self._state = RobotState(np.concatenate((self._state.q[:7], q)), np.concatenate((np.zeros(6), v)))
        contact = self._contact
        felt = contact.felt[0], contact.felt[1]
        return Estimate(self._state, contact.wrench, felt, self._deviation, self._channels(), contact.age)

    def _fitting(self, readings: Readings) -> Readings:
        """Readings of arrays of doubles in their shapes, which are the same where they are that already."""
        for name, shape in self._shapes:
            reading = getattr(readings, name)
            if reading is not None and not _fits(reading, shape):
                fitted: Any = {name: _fitted(reading, shape, name)}
                readings = replace(readings, **fitted)
        return readings

    def _begin(self, readings: Readings) -> None:
        """Make of the first readings what cannot be made before."""
        parameters, body = self.parameters, self._body
        self._filter = filter_ = self._start(readings.joint_position.values)
        self._stand = state = filter_.stand
        self._doubt = Doubt(body, parameters.sensors, self._joints.rate_noise, state, filter_.P)
        gyro, density = readings.angular_velocity.values, parameters.sensors.gyro_density
        self._rate = RateFilter(gyro, self._period, density, parameters.ground.turning_plan)
        self._base = FloatingBase(state, body, self._rate.rate)
        self._contact = self._feeling(readings)
        self._begun = True
        self._contact.update(self._wrench(readings), self._still, self._above, self._edge)
        self._load = self._contact.wrench
        body.offset_jacobians()
        self._deviation = self._doubt.deviation(self._contact, self._rate.deviation)

    def _start(self, joints: Array) -> InvariantFilter:
        body, footing = self._body, self._footing
        R, normals = footing.attitude(body, joints), footing.normals()
        p = (footing.position - body.position @ R.T).mean(axis=0)
        m = len(body.chain) + AXES
        columns = np.vstack((np.zeros(3), p, footing.position))
        state = Stand(R, columns, np.zeros((2, 3, 3)), np.zeros(3), np.zeros(3), np.zeros(m))
        parameters, leaning = self.parameters, footing.leaning is not None
        filter_ = InvariantFilter(state, parameters.sensors, parameters.ground, leaning)
        J = body.offset_jacobians()
        filter_.begin(body.position, body.rotation, J, normals, ATTITUDE)
        body.update(joints, state.R, state.offsets)
        filter_.weigh(J)
        return filter_

    def _feeling(self, readings: Readings) -> SoleContact:
        """Contact by sensors in the feet, or by the torques of the joints."""
        parameters, deviation = self.parameters, None
        if readings.wrench is None:
            at_ends = readings.joint_velocity is not None
            self._torques = TorqueWrench(self._model, self._sole_names, self._period, parameters.sensors, at_ends)
            self._torques.update(self._measured(readings), readings.joint_torque.values)
            deviation = self._torques.deviation
        return SoleContact(
            parameters.contact, parameters.sensors, self._weight, self._footing.half_size, self._period, deviation
        )

    def _wrench(self, readings: Readings) -> Reading:
        """Wrenches of the feet, by their sensors or by the torques of the joints."""
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
        reading, velocity = readings.joint_position, readings.joint_velocity
        at = self._tick - round(reading.age / self._period)
        v, speed = algebra.row(self._stand._columns, 0), np.zeros(self._count)
        if velocity is not None:
            speed = velocity.values
        elif at > self._torques_at:
            time = (at - self._torques_at) * self._period
            speed = (reading.values - self._encoders) / time
            v = algebra.subtract(v, algebra.scale(0.5 * time, algebra.vector(self._filter._acceleration)))
        self._encoders = reading.values
        return self._base.seen(reading.values, speed, v, algebra.vector(readings.angular_velocity.values))

    def _step(self, readings: Readings) -> None:
        """Take the readings of a tick: the IMU, then the feet, then the encoders."""
        filter_ = self._filter
        contact = self._contact
        body = self._body
        encoders = readings.joint_position
        self._turn(readings)
        contact.update(self._wrench(readings), self._still, self._above, self._edge)
        rolled = self._roll()
        body.update(encoders.values, self._stand.R, self._stand._offsets)
        changed = contact.firm != filter_.standing
        due = changed or rolled or self._tick % self._every == 0
        if due:
            self._renew(changed)
        if encoders.fresh:
            slipped = filter_.correct(body._position, body._rotation)
            if slipped:
                self._land_anew(slipped)
        if due:
            self._deviation = self._doubt.deviation(contact, self._rate.deviation)
            self._look_down()

    def _roll(self) -> bool:
        """See feet that begin to roll by their edge, and those that have rolled by their centre; whether any does."""
        ahead, half_length, rolled = self._body._ahead, self._footing.half_size[0], False
        for k in range(2):
            place = (self._edge[1] if k else self._edge[0]) * half_length
            if place != ahead[k]:
                if self._filter.standing[k]:
                    self._filter.shift(k, place - ahead[k])
                ahead[k], rolled = place, True
        return rolled

    def _turn(self, readings: Readings) -> None:
        """Go on with what the IMU says, if that is new."""
        rate, force = readings.mean_angular_velocity, readings.specific_force
        at = self._tick - round(rate.age / self._period)
        if at > self._imu_at:
            self._filter.propagate(rate.values, force.values, (at - self._imu_at) * self._period)
            gained = None
            if self._hears(at):
                gained = self._turned
            self._rate.update(readings.angular_velocity.values, gained, at - self._imu_at)
            self._imu_at = at

    def _hears(self, at: int) -> bool:
        """Find by what the IMU was planned to turn faster from its last reading to that of a tick, if somebody said."""
        back = self._tick - self._imu_at
        if back > min(self._accelerated, len(self._accelerations)) or self._body.behind:
            return False
        self._add_accelerations(back, self._tick - at + 1)
        algebra.put(self._turned, self._body.turned_to_imu(algebra.vector(self._gained[3:])))
        return True

    def _add_accelerations(self, first: int, last: int) -> None:
        """Set what the base was planned to gain from a tick to another one, so many ticks ago."""
        step = -1 if first > last else 1
        for i in range(6):
            gained = 0.0
            for k in range(1 + step * (last - first)):
                back = first + step * k
                gained += self._accelerations[(self._accelerated - back) % len(self._accelerations), i]
            self._gained[i] = self._period * gained

    def _renew(self, changed: bool) -> None:
        """Compute covariance and gain anew, after feet have landed and lifted."""
        filter_, body = self._filter, self._body
        J = body.offset_jacobians()
        filter_.spread((self._share(0), self._share(1)), self._sprung(), (self._edge[0] != 0, self._edge[1] != 0))
        if changed:
            self._change(J)
        filter_.weigh(J)

    def _share(self, k: int) -> float:
        """Share of the weight on a sole [-]."""
        share: float = max(self._contact._wrench[k, 2] / self._weight, 0.0)
        return share

    def _sprung(self) -> Array | None:
        """Motion of each sole on the springs of the ground since this was asked last; see `sprung`.

        None of soles that lean: which springs bear them changes with how they do.
        """
        if self._footing.leaning is not None:
            return None
        changed = self._contact.wrench - self._load
        self._load = self._contact.wrench
        return sprung(changed, self._footing.half_size, self.parameters.ground.depth / self._weight, self._edge)

    def _change(self, J: Array) -> None:
        """Let feet lift and land as their contact says."""
        filter_, firm = self._filter, self._contact.firm
        for k in (0, 1):
            if filter_.standing[k] and not firm[k]:
                filter_.lift(k)
        for k in (0, 1):
            if firm[k] and not filter_.standing[k]:
                self._land(k, J, self._height(k))

    def _height(self, k: int) -> tuple[float, float] | None:
        """Height of the ground under a sole, and its deviation; None where nothing is known of it [m]."""
        deviation = self.parameters.ground.height
        if deviation <= 0.0:
            return None
        x, y, _ = self._sole(k)
        return self._footing.height(x, y), deviation

    def _land(self, k: int, J: Array, height: tuple[float, float] | None) -> None:
        """A foot stands anew, on ground of that height; one that slipped is on ground that has given its own before."""
        body, noise = self._body, self.parameters.ground
        self._filter.land(k, body.position[k], body.rotation[k], J[k], height, noise.landing, noise.landing_turn)

    def _land_anew(self, slipped: tuple[int, ...]) -> None:
        """Let feet land that have slipped, and take the tick after it."""
        filter_, body = self._filter, self._body
        J = body.offset_jacobians()
        filter_.spread((0.5, 0.5))
        for k in slipped:
            self._land(k, J, None)
        filter_.weigh(J)
        filter_.correct(body._position, body._rotation)

    def _sole(self, k: int) -> Vector:
        """Place of a sole in the world, by the kinematics [m]."""
        state = self._stand
        reach = algebra.rotate(state._R, algebra.row(self._body._position, k))
        return algebra.add(algebra.row(state._columns, 1), reach)

    def _look_down(self) -> None:
        """Find how far the soles are over the ground."""
        for k in range(2):
            x, y, z = self._sole(k)
            self._above[k] = z - self._footing.height(x, y)

    def _now(self) -> RobotState | None:
        """The state now, which is older by the age of the IMU's readings; None of one that has diverged."""
        late = self._tick - self._imu_at
        gained = None
        if late and self._accelerated:
            # What the controller has planned since; its velocity is that of the base in its own axes.
            self._add_accelerations(1, max(1, min(late, self._accelerated, len(self._accelerations))))
            gained = self._gained
        return self._base.state(self._joints._q_now, self._joints._v_now, gained, late * self._period)

    def _channels(self) -> dict[str, Array]:
        s = self._stand
        biases = {"gyro_bias": s.gyro_bias.copy(), "force_bias": s.force_bias.copy()}
        return {**biases, "offsets": s.offsets[:-AXES].copy(), "mounting": s.mounting.copy()}


def _fits(reading: Reading, shape: tuple[int, ...]) -> bool:
    """Return true if the values of a reading are an array of doubles of a shape."""
    values = reading.values
    return isinstance(values, np.ndarray) and values.dtype == np.float64 and values.shape == shape


def _fitted(reading: Reading, shape: tuple[int, ...], name: str) -> Reading:
    """A reading with its values as an array of doubles."""
    values = np.asarray(reading.values, dtype=np.float64)
    if values.shape != shape:
        raise ValueError(f"the reading '{name}' has values of shape {values.shape}, which should be {shape}")
    return replace(reading, values=values)
