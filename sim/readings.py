"""The sensors of the simulated robot: what they make of the truth, and when it arrives."""

import math
from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from surefoot.native.library import library
from surefoot.readings import Reading, Readings
from surefoot.sim.compiled import CompiledSensors
from surefoot.sim.imu_motion import ImuChain, ImuMotion, turn_between
from surefoot.sim.measurement import Array, Measurement
from surefoot.sim.sensor_errors import SOON, Delivery, SensorErrors
from surefoot.sim.world import World
from surefoot.similarity import GRAVITY
from surefoot.streams import Stream, generator
from surefoot.values import maker

BLOCK = 64
"""Ticks for which noise is drawn at once, which changes none of the numbers and costs a fifth."""

_NOISE, _BIAS, _WALK, _OFFSET, _VELOCITY, _TURN, _SHIFT, _JITTER, _DROPOUT = range(9)
"""Parts of a stream of random numbers, so that no term of a sensor moves the numbers of another."""

_a_reading, _some_readings = maker(Reading), maker(Readings)


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
        imu, encoders = Imu(world, errors, period, seed), Encoders(errors, len(world.description.joint_names), seed)
        feet = Feet(errors, period, seed) if errors.wrench_sensors else None
        kernels = library()
        self._sample: Callable[[Measurement], Sequence[Array]] = (
            partial(_sampled, imu, encoders, feet)
            if kernels is None
            else CompiledSensors(kernels, imu, encoders, feet, BLOCK)
        )
        self._say_velocity = encoders.say_velocity
        self._lines = _lines(errors, period, seed)

    def read(self, measurement: Measurement, tick: int) -> Readings:
        """What has arrived at a tick; its arrays are never written to again, so that they may be kept.

        Args:
            measurement: the truth of this tick, none of whose values are kept.
            tick: number of the control tick, one more than at the call before; 0 at the first.
        """
        sample, found = self._sample(measurement), []
        for line, part in self._lines:
            found += line.through(tick, sample[part])
        rate, mean_rate, force, position, torque, *more = found
        velocity = more.pop(0) if self._say_velocity else None
        wrench = more[0] if more else None
        return _some_readings(tick / self._rate, position, velocity, torque, rate, mean_rate, force, wrench)


def _sampled(imu: "Imu", encoders: "Encoders", feet: "Feet | None", truth: Measurement) -> list[Array]:
    """What sensors say of the truth of a tick, by plain Python."""
    wrench = () if feet is None else (feet.sample(truth),)
    return [*imu.sample(truth), *encoders.sample(truth), *wrench]


class Noise:
    """White noise of a standard deviation, or of one for each value; nothing is drawn where it is zero.

    Attributes:
        silent: whether it is zero.
        drawn: the next ones, written anew by `refill`, shape (BLOCK, *shape) unless it is silent.
    """

    def __init__(self, deviation: Array | float, shape: tuple[int, ...], rng: np.random.Generator) -> None:
        """Noise of values of a shape, by a generator of its own."""
        self._deviation, self._rng, self._next = deviation, rng, BLOCK
        self.silent = not np.any(deviation)
        self.drawn = np.zeros((1 if self.silent else BLOCK, *shape))

    def refill(self) -> None:
        """Draw the next ones."""
        self._rng.standard_normal(out=self.drawn)
        self.drawn *= self._deviation

    def draw(self) -> Array:
        """The next one, which is to be used before the one after; not to be asked of silent noise."""
        if self._next == BLOCK:
            self.refill()
            self._next = 0
        self._next += 1
        drawn: Array = self.drawn[self._next - 1]
        return drawn

    def added(self, values: Array) -> Array:
        """Values with it."""
        return values if self.silent else values + self.draw()


class Drift:
    """A bias that is drawn at the start and walks from there; terms as of `Noise`.

    Attributes:
        value: of the last tick.
        steps: of its walk, the first at the second tick.
    """

    def __init__(
        self, start: Array | float, walk: Array | float, shape: tuple[int, ...], period: float, seed: int, of: Stream
    ) -> None:
        """A bias of values of a shape."""
        self.value = start * generator(seed, of, _BIAS).standard_normal(shape)
        self.steps = Noise(walk * math.sqrt(period), shape, generator(seed, of, _WALK))
        self._at_start = True

    def added(self, values: Array) -> Array:
        """Values of the next tick with it."""
        if not (self.steps.silent or self._at_start):
            self.value = self.value + self.steps.draw()
        self._at_start = False
        return values + self.value


class Encoders:
    """Joint angles, torques and perhaps velocities.

    Attributes:
        say_velocity: whether they say velocities.
        offset: of their zeros, shape (nj,) [rad].
        step: to which angles are rounded; 0 for angles that are not [rad].
        noise: of angles [rad].
        velocity_noise: of velocities [rad/s].
        torque_noise: of torques [N·m].
    """

    def __init__(self, errors: SensorErrors, joints: int, seed: int) -> None:
        """Encoders of so many joints."""
        of, shape = Stream.ENCODER, (joints,)
        self.say_velocity = errors.encoder_velocity
        self.offset = errors.encoder_offset * generator(seed, of, _OFFSET).standard_normal(joints)
        self.noise = Noise(errors.encoder_noise, shape, generator(seed, of, _NOISE))
        self.velocity_noise = Noise(errors.encoder_velocity_noise, shape, generator(seed, of, _VELOCITY))
        self.torque_noise = Noise(errors.joint_torque_noise, shape, generator(seed, Stream.JOINT_TORQUE))
        self.step = math.tau / 2**errors.encoder_bits if errors.encoder_bits else 0.0

    def sample(self, truth: Measurement) -> Sequence[Array]:
        """Angles, torques and perhaps velocities of the next tick, shape (nj,) each [rad, N·m, rad/s]."""
        position = self.noise.added(truth.joint_position + self.offset)
        if self.step:
            position = self.step * np.rint(position / self.step)
        torque = self.torque_noise.added(truth.joint_torque.copy())
        if not self.say_velocity:
            return position, torque
        return position, torque, self.velocity_noise.added(truth.joint_velocity.copy())


class Imu:
    """Gyroscope and accelerometer, which integrate over the control period that ended.

    Attributes:
        chain: of bodies from the floating base to it.
        period: control period [s].
        gravity: in the world, shape (3,) [m/s^2].
        gyro_noise: of an angular velocity [rad/s].
        gyro_bias: likewise.
        force_noise: of a specific force [m/s^2].
        force_bias: likewise.
        most_rate: largest angular velocity about each axis [rad/s].
        most_force: largest specific force along each axis [m/s^2].
    """

    def __init__(self, world: World, errors: SensorErrors, period: float, seed: int) -> None:
        """The IMU of a world's robot, at a control period [s]."""
        robot, model = world.description, world.model
        turn, shift = (generator(seed, Stream.IMU, part).standard_normal(3) for part in (_TURN, _SHIFT))
        base = model.body(robot.pelvis_body).id
        turn, shift = errors.imu_misalignment * turn, errors.imu_displacement * shift
        self.chain = ImuChain(model, base, robot.imu, turn, shift)
        self.period = period
        self.gravity = np.array([0.0, 0.0, -GRAVITY])
        self._before: ImuMotion | None = None
        root = 1.0 / math.sqrt(period)
        self.gyro_noise = _white(errors.gyro_noise, errors.gyro_density * root, seed, Stream.GYRO)
        self.force_noise = _white(
            errors.accelerometer_noise, errors.accelerometer_density * root, seed, Stream.ACCELEROMETER
        )
        self.gyro_bias = Drift(errors.gyro_bias, errors.gyro_walk, (3,), period, seed, Stream.GYRO)
        self.force_bias = Drift(
            errors.accelerometer_bias, errors.accelerometer_walk, (3,), period, seed, Stream.ACCELEROMETER
        )
        self.most_rate, self.most_force = errors.gyro_range, errors.accelerometer_range

    def sample(self, truth: Measurement) -> Sequence[Array]:
        """Angular velocity, its mean and the specific force of the next tick, shape (3,) each [rad/s, m/s^2]."""
        now = self.chain(truth.q, truth.v)
        before, self._before = self._before, now
        if before is None:  # the robot has stood until now
            mean_rate, force = now.angular_velocity, -self.gravity @ now.rotation
        else:
            mean_rate = turn_between(before.rotation, now.rotation) / self.period
            acceleration = (now.velocity - before.velocity) / self.period
            force = 0.5 * (acceleration - self.gravity) @ (before.rotation + now.rotation)
        error = self.gyro_noise.added(self.gyro_bias.added(np.zeros(3)))
        force = self.force_noise.added(self.force_bias.added(force))
        most = self.most_rate
        return (
            _within(most, now.angular_velocity + error),
            _within(most, mean_rate + error),
            _within(self.most_force, force),
        )


def _within(most: float, values: Array) -> Array:
    """Values that are at most so large; arrays that are, as nearly all, are not copied."""
    if max(values.tolist()) <= most and min(values.tolist()) >= -most:
        return values
    return values.clip(-most, most)


def _white(noise: float, of_period: float, seed: int, of: Stream) -> Noise:
    """Noise of a reading beside that which its density comes to over a control period."""
    return Noise(math.hypot(noise, of_period), (3,), generator(seed, of, _NOISE))


class Feet:
    """Wrenches on both soles.

    Attributes:
        noise: of them, shape (2, 6) [N, N·m].
        bias: likewise.
    """

    def __init__(self, errors: SensorErrors, period: float, seed: int) -> None:
        """Sensors in both feet, at a control period [s]."""
        noise, bias, drift = (
            np.repeat([force, moment], 3)
            for force, moment in (
                (errors.wrench_noise, errors.moment_noise),
                (errors.wrench_bias, errors.moment_bias),
                (errors.wrench_drift, errors.moment_drift),
            )
        )
        self.noise = Noise(noise, (2, 6), generator(seed, Stream.WRENCH, _NOISE))
        self.bias = Drift(bias, drift, (2, 6), period, seed, Stream.WRENCH)

    def sample(self, truth: Measurement) -> Array:
        """Wrenches of the next tick, shape (2, 6) [N, N·m]."""
        return self.noise.added(self.bias.added(truth.wrench))


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

    def through(self, tick: int, sample: Sequence[Array]) -> list[Reading]:
        """Put in the sample of a tick, and take out what has arrived."""
        if self._direct or tick == 0:
            self._values = sample
            return [_a_reading(values, 0.0, True) for values in sample]
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
        return [_a_reading(values, age, fresh) for values in self._values]

    def _send(self, tick: int, sample: Sequence[Array]) -> None:
        how = self._delivery
        delay = how.latency + (how.jitter * float(self._late.random()) if how.jitter else 0.0)
        if not (how.dropout and self._lost.random() < how.dropout):
            self._under_way.append((tick * self._period + delay, tick, sample))


def _lines(errors: SensorErrors, period: float, seed: int) -> list[tuple[_Line, slice]]:
    """Ways of the groups, and which of all that sensors say goes each: IMU, joints, feet.

    Groups whose samples arrive together, and none of which is lost, go the same way.
    """
    joints = 6 if errors.encoder_velocity else 5
    groups = (
        (errors.imu, Stream.IMU, slice(3)),
        (errors.joints, Stream.ENCODER, slice(3, joints)),
        (errors.feet, Stream.WRENCH, slice(joints, None)),
    )
    how = errors.imu
    if how == errors.joints == errors.feet and not (how.jitter or how.dropout):
        return [(_Line(how, period, seed, Stream.IMU), slice(None))]
    return [(_Line(delivery, period, seed, of), part) for delivery, of, part in groups]
