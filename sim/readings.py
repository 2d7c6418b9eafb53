"""The sensors of the simulated robot: what they make of the truth, and when it arrives."""

import math
from collections.abc import Sequence

import numpy as np

from surefoot.readings import Reading, Readings
from surefoot.sim.imu_motion import ImuChain, ImuMotion, turn_between
from surefoot.sim.measurement import Array, Measurement
from surefoot.sim.sensor_errors import Delivery, SensorErrors
from surefoot.sim.world import World
from surefoot.similarity import GRAVITY
from surefoot.streams import Stream, generator

_BLOCK = 64
"""Ticks for which noise is drawn at once, which changes none of the numbers and costs a fifth."""

_SOON = 1e-9
"""What arrives so shortly after a tick is there at the tick [s]."""

_NOISE, _BIAS, _WALK, _OFFSET, _VELOCITY, _TURN, _SHIFT, _JITTER, _DROPOUT = range(9)
"""Parts of a stream of random numbers, so that no term of a sensor moves the numbers of another."""


class SensorSuite:
    """All sensors of a robot, read once a control tick from tick 0 on.

    Args:
        world: that they are in.
        errors: what they add to the truth.
        rate: control ticks in a second [Hz].
        seed: of the run.
    """

    def __init__(self, world: World, errors: SensorErrors, rate: int, seed: int) -> None:
        self._rate, self._period = rate, 1.0 / rate
        joints = len(world.description.joint_names)
        self._encoders = _Encoders(errors, joints, seed)
        self._imu = _Imu(world, errors, self._period, seed)
        self._feet = _Feet(errors, self._period, seed) if errors.wrench_sensors else None
        self._by_joints = _Line(errors.joints, self._period, seed, Stream.ENCODER)
        self._by_imu = _Line(errors.imu, self._period, seed, Stream.IMU)
        self._by_feet = _Line(errors.feet, self._period, seed, Stream.WRENCH)

    def read(self, measurement: Measurement, tick: int) -> Readings:
        """What has arrived at a tick.

        Args:
            measurement: the truth of this tick, of which nothing is kept.
            tick: number of the control tick, one more than at the call before; 0 at the first.
        """
        position, velocity, torque = self._by_joints.through(tick, self._encoders.sample(measurement))
        rate, mean_rate, force = self._by_imu.through(tick, self._imu.sample(measurement))
        wrench = None if self._feet is None else self._by_feet.through(tick, self._feet.sample(measurement))[0]
        return Readings(
            time=tick / self._rate,
            joint_position=position,
            joint_velocity=velocity if self._encoders.say_velocity else None,
            joint_torque=torque,
            angular_velocity=rate,
            mean_angular_velocity=mean_rate,
            specific_force=force,
            wrench=wrench,
        )


class _Noise:
    """White noise of a standard deviation, or of one for each value; nothing is drawn where it is zero."""

    def __init__(self, deviation: Array | float, shape: tuple[int, ...], rng: np.random.Generator) -> None:
        self._deviation, self._shape, self._rng = deviation, shape, rng
        self.silent = not np.any(deviation)
        self._drawn, self._next = np.zeros((0, *shape)), 0

    def draw(self) -> Array:
        """The next one; not to be asked of silent noise."""
        if self._next == len(self._drawn):
            self._drawn = self._deviation * self._rng.standard_normal((_BLOCK, *self._shape))
            self._next = 0
        self._next += 1
        drawn: Array = self._drawn[self._next - 1]
        return drawn

    def added(self, values: Array) -> Array:
        """Values with it."""
        return values if self.silent else values + self.draw()


class _Drift:
    """A bias that is drawn at the start and walks from there; terms as of `_Noise`."""

    def __init__(
        self, start: Array | float, walk: Array | float, shape: tuple[int, ...], period: float, seed: int, of: Stream
    ) -> None:
        self.value = start * generator(seed, of, _BIAS).standard_normal(shape)
        self._steps = _Noise(walk * math.sqrt(period), shape, generator(seed, of, _WALK))
        self._at_start = True

    def added(self, values: Array) -> Array:
        """Values of the next tick with it."""
        if not (self._steps.silent or self._at_start):
            self.value = self.value + self._steps.draw()
        self._at_start = False
        return values + self.value


class _Encoders:
    """Joint angles, velocities and torques."""

    def __init__(self, errors: SensorErrors, joints: int, seed: int) -> None:
        of, shape = Stream.ENCODER, (joints,)
        self.say_velocity = errors.encoder_velocity
        self._offset = errors.encoder_offset * generator(seed, of, _OFFSET).standard_normal(joints)
        self._noise = _Noise(errors.encoder_noise, shape, generator(seed, of, _NOISE))
        self._velocity_noise = _Noise(errors.encoder_velocity_noise, shape, generator(seed, of, _VELOCITY))
        self._torque_noise = _Noise(errors.joint_torque_noise, shape, generator(seed, Stream.JOINT_TORQUE))
        self._step = math.tau / 2**errors.encoder_bits if errors.encoder_bits else 0.0

    def sample(self, truth: Measurement) -> tuple[Array, Array, Array]:
        position = self._noise.added(truth.joint_position + self._offset)
        if self._step:
            position = self._step * np.rint(position / self._step)
        velocity = self._velocity_noise.added(truth.joint_velocity.copy())
        return position, velocity, self._torque_noise.added(truth.joint_torque.copy())


class _Imu:
    """Gyroscope and accelerometer, which integrate over the control period that ended."""

    def __init__(self, world: World, errors: SensorErrors, period: float, seed: int) -> None:
        robot, model = world.description, world.model
        turn, shift = (generator(seed, Stream.IMU, part).standard_normal(3) for part in (_TURN, _SHIFT))
        base = model.body(robot.pelvis_body).id
        turn, shift = errors.imu_misalignment * turn, errors.imu_displacement * shift
        self._chain = ImuChain(model, base, robot.imu, turn, shift)
        self._period = period
        self._gravity = np.array([0.0, 0.0, -GRAVITY])
        self._before: ImuMotion | None = None
        root = 1.0 / math.sqrt(period)
        self._gyro_noise = _white(errors.gyro_noise, errors.gyro_density * root, seed, Stream.GYRO)
        self._force_noise = _white(
            errors.accelerometer_noise, errors.accelerometer_density * root, seed, Stream.ACCELEROMETER
        )
        self._gyro_bias = _Drift(errors.gyro_bias, errors.gyro_walk, (3,), period, seed, Stream.GYRO)
        self._force_bias = _Drift(
            errors.accelerometer_bias, errors.accelerometer_walk, (3,), period, seed, Stream.ACCELEROMETER
        )
        self._most_rate, self._most_force = errors.gyro_range, errors.accelerometer_range

    def sample(self, truth: Measurement) -> tuple[Array, Array, Array]:
        now = self._chain(truth.q, truth.v)
        before, self._before = self._before, now
        if before is None:  # the robot has stood until now
            mean_rate, force = now.angular_velocity, -self._gravity @ now.rotation
        else:
            mean_rate = turn_between(before.rotation, now.rotation) / self._period
            acceleration = (now.velocity - before.velocity) / self._period
            force = 0.5 * (acceleration - self._gravity) @ (before.rotation + now.rotation)
        error = self._gyro_noise.added(self._gyro_bias.added(np.zeros(3)))
        force = self._force_noise.added(self._force_bias.added(force))
        most = self._most_rate
        return (
            _within(most, now.angular_velocity + error),
            _within(most, mean_rate + error),
            _within(self._most_force, force),
        )


def _within(most: float, values: Array) -> Array:
    """Values that are at most so large; arrays that are, as nearly all, are not copied."""
    if max(values.tolist()) <= most and min(values.tolist()) >= -most:
        return values
    return values.clip(-most, most)


def _white(noise: float, of_period: float, seed: int, of: Stream) -> _Noise:
    """Noise of a reading beside that which its density comes to over a control period."""
    return _Noise(math.hypot(noise, of_period), (3,), generator(seed, of, _NOISE))


class _Feet:
    """Wrenches on both soles."""

    def __init__(self, errors: SensorErrors, period: float, seed: int) -> None:
        noise, bias, drift = (
            np.repeat([force, moment], 3)
            for force, moment in (
                (errors.wrench_noise, errors.moment_noise),
                (errors.wrench_bias, errors.moment_bias),
                (errors.wrench_drift, errors.moment_drift),
            )
        )
        self._noise = _Noise(noise, (2, 6), generator(seed, Stream.WRENCH, _NOISE))
        self._bias = _Drift(bias, drift, (2, 6), period, seed, Stream.WRENCH)

    def sample(self, truth: Measurement) -> tuple[Array]:
        return (self._noise.added(self._bias.added(truth.wrench)),)


class _Line:
    """The way of a group's samples to the controller: late, unevenly late, or lost.

    At each tick the newest sample counts that has arrived; one that comes after a newer one counts no more. The first
    sample is there at once, since the robot has stood before.
    """

    def __init__(self, delivery: Delivery, period: float, seed: int, of: Stream) -> None:
        self._delivery, self._period = delivery, period
        self._late, self._lost = generator(seed, of, _JITTER), generator(seed, of, _DROPOUT)
        self._direct = delivery == Delivery()
        self._under_way: list[tuple[float, int, Sequence[Array]]] = []
        self._taken = 0
        self._values: Sequence[Array] = ()

    def through(self, tick: int, sample: Sequence[Array]) -> tuple[Reading, ...]:
        """Put in the sample of a tick, and take out what has arrived."""
        if self._direct:
            return tuple(Reading(values, 0.0, True) for values in sample)
        if tick == 0:
            self._values = sample
            return tuple(Reading(values, 0.0, True) for values in sample)
        self._send(tick, sample)
        now, before = tick * self._period + _SOON, self._taken
        newest = now - self._delivery.latency
        for arrival, sent, values in self._under_way:
            if sent * self._period > newest:  # none of the rest can have arrived
                break
            if arrival <= now and sent > self._taken:
                self._taken, self._values = sent, values
        if self._taken != before:
            self._under_way = [entry for entry in self._under_way if entry[1] > self._taken]
        age = (tick - self._taken) * self._period
        return tuple(Reading(values, age, self._taken != before) for values in self._values)

    def _send(self, tick: int, sample: Sequence[Array]) -> None:
        how = self._delivery
        delay = how.latency + (how.jitter * float(self._late.random()) if how.jitter else 0.0)
        if not (how.dropout and self._lost.random() < how.dropout):
            self._under_way.append((tick * self._period + delay, tick, sample))
