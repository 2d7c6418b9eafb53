"""The sensors of the simulated robot: what they make of the truth, and when it arrives."""

import math

import numpy as np

from surefoot.maths import algebra, linear
from surefoot.maths.algebra import Vector
from surefoot.readings import Reading, Readings
from surefoot.sim.imu_motion import ImuChain, ImuMotion
from surefoot.sim.measurement import Array, Measurement
from surefoot.sim.sensor_errors import SOON, Delivery, SensorErrors
from surefoot.sim.world import World
from surefoot.similarity import GRAVITY
from surefoot.streams import Stream, generator

BLOCK = 64
"""Ticks for which noise is drawn at once, which changes none of the numbers and costs a fifth."""

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
        self._rate, period = rate, 1.0 / rate
        self._imu = Imu(world, errors, period, seed)
        self._encoders = Encoders(errors, len(world.description.joint_names), seed)
        self._feet = Feet(errors, period, seed) if errors.wrench_sensors else None
        self._lines = _lines(errors, period, seed)

    def read(self, measurement: Measurement, tick: int) -> Readings:
        """Read what has arrived at a tick; its arrays are never written to again, so that they may be kept.

        Args:
            measurement: the truth of this tick, none of whose values are kept.
            tick: number of the control tick, one more than at the call before; 0 at the first.

        Raises:
            ValueError: an array of the measurement has not the size that the robot's has.
        """
        imu, joints = self._imu.sample(measurement), self._encoders.sample(measurement)
        feet = [] if self._feet is None else self._feet.sample(measurement)
        samples = [imu + joints + feet] if len(self._lines) == 1 else [imu, joints, feet]
        found: list[Reading] = []
        for line, sample in zip(self._lines, samples, strict=True):
            found += line.through(tick, sample)
        rate, mean_rate, force, position, torque, *more = found
        velocity = more.pop(0) if self._encoders.say_velocity else None
        wrench = more[0] if more else None
        return Readings(tick / self._rate, position, velocity, torque, rate, mean_rate, force, wrench)


class Buffer:
    """Memory in which a sensor makes what it says, of which each sample is a copy: it may be kept.

    Args:
        shape: of what it says.

    Attributes:
        values: all numbers in a row.
    """

    def __init__(self, *shape: int) -> None:
        self._array = np.zeros(shape)
        self.values = self._array.reshape(-1)

    def take(self, truth: Array, name: str) -> None:
        """Take over an array of the truth, wherever and of whatever type of numbers it is.

        Raises:
            ValueError: it has another shape.
        """
        if len(truth) != len(self._array):
            what = f"{name} of a measurement has the shape {np.shape(truth)}"
            raise ValueError(f"{what}, where it is {self._array.shape}")
        self._array[...] = truth

    def copied(self) -> Array:
        """Copy of its content now, in memory of its own."""
        copied: Array = self._array.copy()
        return copied


class Noise:
    """White noise of a standard deviation, or of one for each value; nothing is drawn where it is zero.

    Args:
        deviation: standard deviation, of all values or of each.
        shape: of the values.
        rng: a generator of its own.
    """

    def __init__(self, deviation: Array | float, shape: tuple[int, ...], rng: np.random.Generator) -> None:
        self._deviation, self._rng, self._next = deviation, rng, BLOCK
        self._silent = not np.any(deviation)
        self._block = np.zeros((0 if self._silent else BLOCK, *shape))
        self._drawn = self._block.reshape(len(self._block), math.prod(shape))

    def add(self, values: Array) -> None:
        """Add the next ones to values, shape (n,)."""
        if self._silent:
            return
        if self._next == len(self._drawn):
            self._rng.standard_normal(out=self._block)
            self._block *= self._deviation
            self._next = 0
        for i in range(len(values)):
            values[i] += self._drawn[self._next, i]
        self._next += 1


class Drift:
    """A bias that is drawn at the start and walks from there.

    Args:
        start: standard deviation of the bias at the start, of all values or of each.
        walk: standard deviation of what it gains in a second.
        shape: of the values.
        period: control period [s].
        seed: of the run.
        of: stream of its random numbers.
    """

    def __init__(
        self, start: Array | float, walk: Array | float, shape: tuple[int, ...], period: float, seed: int, of: Stream
    ) -> None:
        self._value = (start * generator(seed, of, _BIAS).standard_normal(shape)).reshape(-1)
        self._steps = Noise(walk * math.sqrt(period), shape, generator(seed, of, _WALK))
        self._at_start = True

    def add(self, values: Array) -> None:
        """Add that of the next tick to values, shape (n,)."""
        if not self._at_start:
            self._steps.add(self._value)
        self._at_start = False
        for i in range(len(values)):
            values[i] += self._value[i]


class Encoders:
    """Joint angles, torques and perhaps velocities.

    Args:
        errors: what they add.
        joints: how many there are.
        seed: of the run.

    Attributes:
        say_velocity: whether they say velocities.
    """

    def __init__(self, errors: SensorErrors, joints: int, seed: int) -> None:
        of, shape = Stream.ENCODER, (joints,)
        self.say_velocity = errors.encoder_velocity
        self._position, self._torque, self._velocity = Buffer(joints), Buffer(joints), Buffer(joints)
        # Of their zeros [rad].
        self._offset = errors.encoder_offset * generator(seed, of, _OFFSET).standard_normal(joints)
        self._noise = Noise(errors.encoder_noise, shape, generator(seed, of, _NOISE))
        self._velocity_noise = Noise(errors.encoder_velocity_noise, shape, generator(seed, of, _VELOCITY))
        self._torque_noise = Noise(errors.joint_torque_noise, shape, generator(seed, Stream.JOINT_TORQUE))
        # To which angles are rounded; 0 for angles that are not [rad].
        self._step = math.tau / 2**errors.encoder_bits if errors.encoder_bits else 0.0

    def sample(self, truth: Measurement) -> list[Array]:
        """Angles, torques and perhaps velocities of the next tick, shape (nj,) each [rad, N·m, rad/s]."""
        self._position.take(truth.joint_position, "joint_position")
        self._encode(self._position.values)
        self._torque.take(truth.joint_torque, "joint_torque")
        self._torque_noise.add(self._torque.values)
        said = [self._position.copied(), self._torque.copied()]
        if self.say_velocity:
            self._velocity.take(truth.joint_velocity, "joint_velocity")
            self._velocity_noise.add(self._velocity.values)
            said.append(self._velocity.copied())
        return said

    def _encode(self, position: Array) -> None:
        """Put the errors on true angles, shape (nj,) [rad]."""
        for i in range(len(position)):
            position[i] += self._offset[i]
        self._noise.add(position)
        if self._step > 0.0:
            for i in range(len(position)):
                position[i] = self._step * linear.nearest(position[i] / self._step)


class Imu:
    """Gyroscope and accelerometer, which integrate over the control period that ended.

    Args:
        world: whose robot has it.
        errors: what it adds.
        period: control period [s].
        seed: of the run.
    """

    def __init__(self, world: World, errors: SensorErrors, period: float, seed: int) -> None:
        robot, model = world.description, world.model
        turn, shift = (generator(seed, Stream.IMU, part).standard_normal(3) for part in (_TURN, _SHIFT))
        base, nj = model.body(robot.pelvis_body).id, len(robot.joint_names)
        turn, shift = errors.imu_misalignment * turn, errors.imu_displacement * shift
        self._chain = ImuChain(model, base, robot.imu, turn, shift)
        self._q, self._v = Buffer(7 + nj), Buffer(6 + nj)
        self._period, self._gravity = period, (0.0, 0.0, -GRAVITY)
        self._before: ImuMotion | None = None
        root = 1.0 / math.sqrt(period)
        self._gyro_noise = _white(errors.gyro_noise, errors.gyro_density * root, seed, Stream.GYRO)
        self._force_noise = _white(
            errors.accelerometer_noise, errors.accelerometer_density * root, seed, Stream.ACCELEROMETER
        )
        self._gyro_bias = Drift(errors.gyro_bias, errors.gyro_walk, (3,), period, seed, Stream.GYRO)
        self._force_bias = Drift(
            errors.accelerometer_bias, errors.accelerometer_walk, (3,), period, seed, Stream.ACCELEROMETER
        )
        self._most_rate, self._most_force = errors.gyro_range, errors.accelerometer_range
        self._rate, self._mean_rate, self._force = Buffer(3), Buffer(3), Buffer(3)
        self._error, self._sum = np.zeros(3), np.zeros((3, 3))

    def sample(self, truth: Measurement) -> list[Array]:
        """Angular velocity, its mean and the specific force of the next tick, shape (3,) each [rad/s, m/s^2]."""
        self._q.take(truth.q, "q")
        self._v.take(truth.v, "v")
        self._sense(self._chain.motion(self._q.values, self._v.values))
        return [self._rate.copied(), self._mean_rate.copied(), self._force.copied()]

    def _sense(self, now: ImuMotion) -> None:
        """Sense a motion, at the end of a period that began with that of the last call."""
        mean_rate, force = self._over_period(now)
        self._before = now
        self._error[:] = 0.0
        self._gyro_bias.add(self._error)
        self._gyro_noise.add(self._error)
        error = algebra.vector(self._error)
        algebra.put(self._rate.values, _within(self._most_rate, algebra.add(now.angular_velocity, error)))
        algebra.put(self._mean_rate.values, _within(self._most_rate, algebra.add(mean_rate, error)))
        said = self._force.values
        algebra.put(said, force)
        self._force_bias.add(said)
        self._force_noise.add(said)
        algebra.put(said, _within(self._most_force, algebra.vector(said)))

    def _over_period(self, now: ImuMotion) -> tuple[Vector, Vector]:
        """Means over the period that ended of angular velocity and specific force [rad/s, m/s^2].

        The force (v⁺ - v) / T - g is seen from the mean of the axes at both ends, (R + R⁺)' / 2.
        """
        before, gravity, T = self._before, self._gravity, self._period
        if before is None:  # the robot has stood until now
            return now.angular_velocity, algebra.rotate_back(now.rotation, algebra.scale(-1.0, gravity))
        x, y, z = algebra.turn_between(before.rotation, now.rotation)
        moved = algebra.subtract(now.velocity, before.velocity)
        force = algebra.subtract((moved[0] / T, moved[1] / T, moved[2] / T), gravity)
        for i in range(3):
            for j in range(3):
                self._sum[i, j] = before.rotation[i, j] + now.rotation[i, j]
        return (x / T, y / T, z / T), algebra.rotate_back(self._sum, algebra.scale(0.5, force))


def _within(most: float, values: Vector) -> Vector:
    """Values that are at most so large."""
    return (
        algebra.clamp(values[0], -most, most),
        algebra.clamp(values[1], -most, most),
        algebra.clamp(values[2], -most, most),
    )


def _white(noise: float, of_period: float, seed: int, of: Stream) -> Noise:
    """Noise of a reading beside that which its density comes to over a control period."""
    return Noise(math.hypot(noise, of_period), (3,), generator(seed, of, _NOISE))


class Feet:
    """Wrenches on both soles.

    Args:
        errors: what their sensors add.
        period: control period [s].
        seed: of the run.
    """

    def __init__(self, errors: SensorErrors, period: float, seed: int) -> None:
        noise, bias, drift = (
            np.repeat([force, moment], 3)
            for force, moment in (
                (errors.wrench_noise, errors.moment_noise),
                (errors.wrench_bias, errors.moment_bias),
                (errors.wrench_drift, errors.moment_drift),
            )
        )
        self._wrench = Buffer(2, 6)
        self._noise = Noise(noise, (2, 6), generator(seed, Stream.WRENCH, _NOISE))
        self._bias = Drift(bias, drift, (2, 6), period, seed, Stream.WRENCH)

    def sample(self, truth: Measurement) -> list[Array]:
        """Wrenches of the next tick, shape (2, 6) [N, N·m]."""
        self._wrench.take(truth.wrench, "wrench")
        self._bias.add(self._wrench.values)
        self._noise.add(self._wrench.values)
        return [self._wrench.copied()]


class Line:
    """The way of a group's samples to the controller: late, unevenly late, or lost.

    At each tick the newest sample counts that has arrived; one that comes after a newer one counts no more. The first
    sample is there at once, since the robot has stood before.
    """

    def __init__(self, delivery: Delivery, period: float, seed: int, of: Stream) -> None:
        self._delivery, self._period = delivery, period
        self._late, self._lost = generator(seed, of, _JITTER), generator(seed, of, _DROPOUT)
        self._direct = delivery == Delivery()
        self._under_way: list[tuple[float, int, list[Array]]] = []
        self._taken = 0
        self._values: list[Array] = []

    def through(self, tick: int, sample: list[Array]) -> list[Reading]:
        """Put in the sample of a tick, and take out what has arrived."""
        if self._direct or tick == 0:
            self._values = sample
            return [Reading(values, 0.0, True) for values in sample]
        self._send(tick, sample)
        period, taken = self._period, self._taken
        now, before = tick * period + SOON, taken
        newest = now - self._delivery.latency
        for arrival, sent, values in self._under_way:
            if sent * period > newest:  # none of the rest can have arrived
                break
            if arrival <= now and sent > taken:
                taken, self._values = sent, values
        if taken != before:
            self._taken = taken
            self._under_way = [entry for entry in self._under_way if entry[1] > taken]
        age, fresh = (tick - taken) * period, taken != before
        return [Reading(values, age, fresh) for values in self._values]

    def _send(self, tick: int, sample: list[Array]) -> None:
        how = self._delivery
        delay = how.latency + (how.jitter * float(self._late.random()) if how.jitter else 0.0)
        if not (how.dropout and self._lost.random() < how.dropout):
            self._under_way.append((tick * self._period + delay, tick, sample))


def _lines(errors: SensorErrors, period: float, seed: int) -> list[Line]:
    """Ways of IMU, joints and feet; one of all, if their samples arrive together and none of them is lost."""
    how = errors.imu
    if how == errors.joints == errors.feet and not (how.jitter or how.dropout):
        return [Line(how, period, seed, Stream.IMU)]
    groups = (errors.imu, Stream.IMU), (errors.joints, Stream.ENCODER), (errors.feet, Stream.WRENCH)
    return [Line(delivery, period, seed, of) for delivery, of in groups]
