"""Laws of the sensor models: what each term adds, when readings come, and that no term moves the numbers of another."""

from dataclasses import replace
from types import SimpleNamespace

import mujoco
import numpy as np
import pytest

from surefoot.models.registry import describe
from surefoot.models.types import ImuPlace, RobotOptions
from surefoot.planner.ground.terrain import flat
from surefoot.sim.imu_motion import ImuChain, rotation_of, turned
from surefoot.sim.readings import BLOCK, SensorSuite
from surefoot.sim.sensor_errors import CHEAP, GOOD, PERFECT, PRESETS, Delivery, SensorErrors
from surefoot.sim.world import World
from surefoot.similarity import GRAVITY, Similarity

pytestmark = pytest.mark.unit

RATE = 500
SENSED = ("joint_position", "joint_velocity", "joint_torque", "angular_velocity", "mean_angular_velocity")
SENSED += ("specific_force", "wrench")
JOINTS = 25


@pytest.fixture(scope="module")
def world():
    return World(describe("humanoid100", RobotOptions()), flat(), 1000)


def at_rest(joints=JOINTS):
    """A robot that hangs still with level pelvis and weightless feet; every reading of it is error."""
    q = np.zeros(7 + joints)
    q[6] = 1.0
    return SimpleNamespace(
        joint_position=q[7:], joint_velocity=np.zeros(joints), joint_torque=np.zeros(joints),
        wrench=np.zeros((2, 6)), q=q, v=np.zeros(6 + joints),
    )  # fmt: skip


def readings(world, errors, ticks, seed=0, truth=None):
    suite = SensorSuite(world, errors, RATE, seed)
    return [suite.read(truth(tick) if truth else at_rest(), tick) for tick in range(ticks)]


def values(found, name):
    return np.array([getattr(one, name).values for one in found])


def test_perfect_sensors_say_the_truth_at_once(world, standing_configuration, make_holder):
    make_holder(world, standing_configuration(world)).hold(world, 20)
    suite = SensorSuite(world, PERFECT, RATE, 0)
    for tick in range(3):
        world.advance(np.full(JOINTS, 2.0), 2)
        truth = world.measure()
        found = suite.read(truth, tick)
        assert found.time == pytest.approx(tick / RATE)
        for name in ("joint_position", "joint_velocity", "joint_torque", "wrench"):
            reading = getattr(found, name)
            np.testing.assert_array_equal(reading.values, getattr(truth, name))
            assert (reading.age, reading.fresh) == (0.0, True)
        np.testing.assert_allclose(found.angular_velocity.values, truth.gyro, atol=1e-15)


def test_readings_are_not_the_buffers_of_the_world(world, standing_configuration, make_holder):
    make_holder(world, standing_configuration(world)).hold(world, 5)
    suite = SensorSuite(world, PERFECT, RATE, 0)
    found = suite.read(world.measure(), 0)
    before = {name: getattr(found, name).values.copy() for name in SENSED}
    world.advance(np.full(JOINTS, 5.0), 20)
    suite.read(world.measure(), 1)
    for name, kept in before.items():
        np.testing.assert_array_equal(getattr(found, name).values, kept)


@pytest.mark.parametrize(
    "how", [Delivery(), Delivery(latency=0.002), Delivery(latency=0.004, jitter=0.006, dropout=0.2)]
)
def test_what_was_read_is_never_written_to_again(world, how):
    """Estimators keep readings, and lines hold samples that are late: longer than noise is drawn for."""
    rng, truth, kept = np.random.default_rng(0), at_rest(), []
    suite = SensorSuite(world, replace(CHEAP, encoder_velocity=True, joints=how, imu=how, feet=how), RATE, 0)
    for tick in range(3 * BLOCK):
        for name in ("joint_position", "joint_velocity", "joint_torque", "wrench"):
            array = getattr(truth, name)
            array[:] = rng.normal(size=array.shape)
        found = suite.read(truth, tick)
        kept.append([(reading.values, reading.values.copy()) for reading in (getattr(found, name) for name in SENSED)])
    for one in kept:
        for now, then in one:
            np.testing.assert_array_equal(now, then)
    apart = [values for one in kept[::5] for values, _ in one]
    if how == Delivery():
        assert not any(np.shares_memory(a, b) for n, a in enumerate(apart) for b in apart[:n])


def test_the_truth_is_read_wherever_it_is(world):
    """In other arrays than at the tick before, in pieces of others, or in whole numbers."""
    rng, suite = np.random.default_rng(2), SensorSuite(world, PERFECT, RATE, 0)
    for tick in range(8):
        truth = at_rest()
        truth.joint_position = rng.normal(size=(JOINTS, 2))[:, tick % 2]
        truth.joint_torque = rng.normal(size=(JOINTS, 2)).T[1]
        truth.joint_velocity = rng.integers(-9, 9, JOINTS)
        truth.wrench = rng.integers(-9, 9, (6, 2)).T if tick % 2 else np.asfortranarray(rng.normal(size=(2, 6)))
        truth.v = np.tile(np.arange(6 + JOINTS), (2, 1)).T[:, 0]
        found = suite.read(truth, tick)
        for name in ("joint_position", "joint_velocity", "joint_torque", "wrench"):
            np.testing.assert_array_equal(getattr(found, name).values, getattr(truth, name))
        np.testing.assert_allclose(found.angular_velocity.values, (3.0, 4.0, 5.0), rtol=1e-15)


@pytest.mark.parametrize("name", ["joint_position", "joint_velocity", "joint_torque", "q", "v", "wrench"])
@pytest.mark.parametrize("shape", [(5,), (1,)])
def test_a_truth_of_another_size_is_refused(world, name, shape):
    truth = at_rest()
    setattr(truth, name, np.zeros(shape))
    with pytest.raises(ValueError, match=f"{name} of a measurement has the shape"):
        SensorSuite(world, PERFECT, RATE, 0).read(truth, 0)


PLACES = {
    "humanoid100": ImuPlace(),
    "humanoid100 on its torso": ImuPlace("torso", (0.05, -0.02, 0.1), (0.5, 0.5, -0.5, 0.5)),
    "humanoid100 on a foot": ImuPlace("left_foot", (0.05, 0.0, 0.02), (0.6, 0.0, 0.8, 0.0)),
    "humanoid100 with an axis beside its waist": ImuPlace("torso", (0.05, -0.02, 0.1), (0.5, 0.5, -0.5, 0.5)),
    "talos": None,
    "g1": None,
}


def placed(name):
    robot = describe(name.split()[0], RobotOptions())
    if "beside" in name:
        joint = f'<joint name="{robot.roles.waist[0]}"'
        assert joint in robot.mjcf
        robot = replace(robot, mjcf=robot.mjcf.replace(joint, f'{joint} pos="0.05 0.03 -0.02"'))
    return robot if PLACES[name] is None else replace(robot, imu=PLACES[name])


def chain_of(world):
    """The bodies from the base to the IMU of a world's robot, which is mounted as it should be."""
    base = world.model.body(world.description.pelvis_body).id
    return ImuChain(world.model, base, world.description.imu, np.zeros(3), np.zeros(3))


@pytest.mark.parametrize("name", PLACES)
def test_the_imus_motion_is_that_of_the_engine(name):
    robot = placed(name)
    world, rng, nj = World(robot, flat(), 1000), np.random.default_rng(3), len(robot.joint_names)
    for _ in range(5):
        q, v = np.zeros(7 + nj), rng.normal(size=6 + nj)
        q[3:7], q[7:] = rng.normal(size=4), rng.uniform(-0.5, 0.5, nj)
        q[3:7] /= np.linalg.norm(q[3:7])
        world.reset(q, v)
        body = world.model.body(robot.imu.body or robot.pelvis_body).id
        found = chain_of(world).motion(q, v)
        R = world.data.xmat[body].reshape(3, 3)
        mount, lever = rotation_of(np.array(robot.imu.quaternion)), R @ np.array(robot.imu.position)
        speed = np.zeros(6)
        mujoco.mj_objectVelocity(world.model, world.data, mujoco.mjtObj.mjOBJ_XBODY, body, speed, 0)
        np.testing.assert_allclose(found.rotation, R @ mount, atol=1e-12)
        np.testing.assert_allclose(np.asarray(found.rotation) @ found.angular_velocity, speed[:3], atol=1e-11)
        np.testing.assert_allclose(found.velocity, speed[3:] + np.cross(speed[:3], lever), atol=1e-11)


@pytest.mark.parametrize("name", PLACES)
def test_a_perfect_imu_integrates_to_the_true_motion(name):
    """Delta angles and delta velocities, which no reading of one instant would sum up to."""
    robot = placed(name)
    world, rng, nj = World(robot, flat(), 1000), np.random.default_rng(1), len(robot.joint_names)
    q = np.zeros(7 + nj)
    q[2], q[6], q[7:] = 5.0, 1.0, robot.nominal_joint_positions
    world.reset(q, 0.5 * rng.normal(size=6 + nj))
    suite, period = SensorSuite(world, PERFECT, RATE, 0), 1.0 / RATE
    chain, instant = chain_of(world), np.zeros(3)
    for tick in range(100):
        truth = world.measure()
        found, now = suite.read(truth, tick), chain.motion(truth.q, truth.v)
        if tick == 0:
            R, start = np.array(now.rotation), np.array(now.velocity)
            velocity = start.copy()
        else:
            turn = found.mean_angular_velocity.values * period
            velocity = velocity + R @ turned(0.5 * turn) @ found.specific_force.values * period
            velocity[2] -= GRAVITY * period
            instant = instant + R @ truth.accelerometer * period
            R = R @ turned(turn)
        world.advance(0.05 * robot.torque_limit * rng.normal(size=nj), 2)
    np.testing.assert_allclose(R, now.rotation, atol=1e-11)
    np.testing.assert_allclose(velocity, now.velocity, atol=1e-5)
    assert np.abs(start - np.array(now.velocity)).max() > 0.1


@pytest.mark.parametrize(
    ("term", "name", "deviation"),
    [
        ("encoder_noise", "joint_position", 2e-3),
        ("encoder_velocity_noise", "joint_velocity", 0.05),
        ("joint_torque_noise", "joint_torque", 3.0),
        ("gyro_noise", "angular_velocity", 0.01),
        ("gyro_noise", "mean_angular_velocity", 0.01),
        ("accelerometer_noise", "specific_force", 0.1),
    ],
)
def test_noise_has_its_deviation_and_no_memory(world, term, name, deviation):
    found = values(readings(world, SensorErrors(**{term: deviation}), 2000), name)
    error = found - values(readings(world, PERFECT, 1), name)
    assert error.std() == pytest.approx(deviation, rel=0.05)
    assert abs(error.mean()) < 5 * deviation / np.sqrt(error.size)
    assert abs((error[1:] * error[:-1]).mean()) < 0.05 * deviation**2


@pytest.mark.parametrize(
    ("term", "name"), [("gyro_density", "mean_angular_velocity"), ("accelerometer_density", "specific_force")]
)
def test_a_density_is_the_deviation_of_a_mean_times_the_root_of_its_time(world, term, name):
    found = values(readings(world, SensorErrors(**{term: 1e-3}), 4000), name) - values(
        readings(world, PERFECT, 1), name
    )
    for ticks in (1, 10, 50):
        means = found.reshape(-1, ticks, 3).mean(axis=1)
        assert means.std() * np.sqrt(ticks / RATE) == pytest.approx(1e-3, rel=0.15)


@pytest.mark.parametrize(("term", "columns"), [("wrench_noise", slice(0, 3)), ("moment_noise", slice(3, 6))])
def test_forces_and_moments_have_noises_of_their_own(world, term, columns):
    found = values(readings(world, SensorErrors(**{term: 4.0}), 1000), "wrench")
    assert found[:, :, columns].std() == pytest.approx(4.0, rel=0.05)
    assert np.count_nonzero(found) == found[:, :, columns].size


@pytest.mark.parametrize(
    ("term", "name"),
    [
        ("encoder_offset", "joint_position"),
        ("gyro_bias", "angular_velocity"),
        ("accelerometer_bias", "specific_force"),
        ("wrench_bias", "wrench"),
        ("moment_bias", "wrench"),
    ],
)
def test_a_bias_is_constant_in_a_run_and_drawn_anew_by_the_seed(world, term, name):
    drawn = []
    nothing = values(readings(world, PERFECT, 1), name)[0]
    for seed in range(60):
        found = values(readings(world, SensorErrors(**{term: 0.5}), 4, seed), name) - nothing
        np.testing.assert_allclose(found, found[[0] * 4], atol=1e-14)
        drawn.append(found[0])
    drawn = np.array(drawn)
    drawn = drawn[:, np.any(drawn, axis=0)]
    assert drawn.std() == pytest.approx(0.5, rel=0.15)
    assert len(np.unique(drawn)) == drawn.size


@pytest.mark.parametrize(
    ("term", "name"),
    [
        ("gyro_walk", "mean_angular_velocity"),
        ("accelerometer_walk", "specific_force"),
        ("wrench_drift", "wrench"),
        ("moment_drift", "wrench"),
    ],
)
def test_a_bias_walks_with_the_root_of_time(world, term, name):
    ends = []
    for seed in range(60):
        found = values(readings(world, SensorErrors(**{term: 0.3}), 201, seed), name)
        ends.append([found[ticks] - found[0] for ticks in (50, 200)])
    ends = np.array(ends)
    ends = ends[..., np.any(ends, axis=(0, 1))] if ends.ndim == 3 else ends[:, :, np.any(ends, axis=(0, 1))]
    for column, ticks in enumerate((50, 200)):
        assert ends[:, column].std() == pytest.approx(0.3 * np.sqrt(ticks / RATE), rel=0.15)


def ramp(tick):
    truth = at_rest()
    truth.joint_position = np.full(JOINTS, 0.001 * tick)
    truth.wrench = np.full((2, 6), float(tick))
    truth.v[3:6] = 0.01 * tick
    return truth


def test_encoders_round_to_their_bits(world):
    step = 2 * np.pi / 2**12
    found = values(readings(world, SensorErrors(encoder_bits=12), 300, truth=ramp), "joint_position")
    exact = values(readings(world, PERFECT, 300, truth=ramp), "joint_position")
    np.testing.assert_allclose(found / step, np.rint(found / step), atol=1e-9)
    assert 0.4 * step < np.abs(found - exact).max() <= 0.5 * step + 1e-15
    assert not np.allclose(exact / step, np.rint(exact / step), atol=1e-3)


@pytest.mark.parametrize(("latency", "ticks"), [(0.002, 1), (0.003, 2), (0.02, 10)])
def test_latency_is_the_age_of_what_is_said(world, latency, ticks):
    """And only of the group that is late."""
    found = readings(world, SensorErrors(feet=Delivery(latency=latency)), 60, truth=ramp)
    for tick, one in enumerate(found[ticks:], start=ticks):
        assert one.wrench.age == pytest.approx(ticks / RATE)
        np.testing.assert_array_equal(one.wrench.values, tick - ticks)
        assert one.wrench.fresh or tick == ticks
        assert (one.joint_position.age, one.specific_force.age) == (0.0, 0.0)


@pytest.mark.parametrize("how", [Delivery(), Delivery(latency=0.0035)])
def test_groups_that_come_alike_come_as_each_alone(world, how):
    """They go one way then."""
    one = readings(world, replace(GOOD, joints=how, imu=how, feet=how), 40, truth=ramp)
    for group, name in (("joints", "joint_position"), ("imu", "angular_velocity"), ("feet", "wrench")):
        others = {other: Delivery(latency=0.01) for other in ("joints", "imu", "feet")}
        alone = readings(world, replace(GOOD, **{**others, group: how}), 40, truth=ramp)
        np.testing.assert_array_equal(values(one, name), values(alone, name))
        for a, b in zip(one, alone, strict=True):
            assert (getattr(a, name).age, getattr(a, name).fresh) == (getattr(b, name).age, getattr(b, name).fresh)


def test_with_jitter_ages_vary_and_time_never_goes_back(world):
    found = readings(world, SensorErrors(joints=Delivery(latency=0.003, jitter=0.01)), 2000, truth=ramp)[20:]
    ages = np.array([one.joint_position.age for one in found])
    taken = values(found, "joint_position")[:, 0] / 0.001
    np.testing.assert_allclose(taken, np.arange(20, 2000) - ages * RATE, atol=1e-6)
    assert (np.diff(taken) >= -1e-6).all()
    assert ages.min() == pytest.approx(0.004)
    assert 0.008 < ages.max() <= 0.014 + 1e-9
    assert all(one.joint_position.fresh == (step > 0.5) for one, step in zip(found[1:], np.diff(taken), strict=True))


def test_the_share_of_lost_samples_is_that_of_ticks_without_fresh_ones(world):
    found = readings(world, SensorErrors(imu=Delivery(dropout=0.2)), 4000, truth=ramp)
    fresh = np.array([one.specific_force.fresh for one in found])
    assert 1.0 - fresh.mean() == pytest.approx(0.2, abs=0.02)
    assert all(one.joint_position.fresh and one.wrench.fresh for one in found)
    ages, held = np.array([one.angular_velocity.age for one in found]), values(found, "angular_velocity")[:, 0]
    np.testing.assert_allclose(held, 0.01 * (np.arange(4000) - ages * RATE), atol=1e-9)
    assert (ages[~fresh] > 0.0).all()
    assert not ages[fresh].any()


def test_readings_stay_within_the_range_of_the_imu(world):
    errors = SensorErrors(gyro_range=0.5, accelerometer_range=5.0)
    found = readings(world, errors, 100, truth=ramp)
    assert values(found, "angular_velocity").max() == 0.5
    assert values(found, "mean_angular_velocity").max() <= 0.5
    assert np.abs(values(found, "specific_force")).max() == 5.0
    assert values(readings(world, PERFECT, 100, truth=ramp), "angular_velocity").max() > 0.9


def test_an_imu_that_is_turned_feels_gravity_elsewhere(world):
    found = [
        readings(world, SensorErrors(imu_misalignment=0.02), 1, seed)[0].specific_force.values for seed in range(100)
    ]
    np.testing.assert_allclose(np.linalg.norm(found, axis=1), GRAVITY, rtol=1e-12)
    assert (np.array(found)[:, :2] / GRAVITY).std() == pytest.approx(0.02, rel=0.2)


def test_an_imu_that_is_displaced_feels_the_spin():
    world = World(describe("humanoid100", RobotOptions()), flat(), 1000)
    spun = at_rest()
    spun.v[3:6] = 0.0, 0.0, 5.0

    def spin(tick):
        angle = 0.5 * 5.0 * tick / RATE
        spun.q[3:7] = 0.0, 0.0, np.sin(angle), np.cos(angle)
        return spun

    errors = SensorErrors(imu_displacement=0.01)
    out = [readings(world, errors, 5, seed, spin)[4].specific_force.values[:2] for seed in range(60)]
    assert np.array(out).std() == pytest.approx(25.0 * 0.01, rel=0.2)
    assert not np.allclose(out[0], out[1])


TERMS = {
    "encoder_noise": 1e-3, "encoder_offset": 1e-3, "encoder_velocity_noise": 1e-2, "joint_torque_noise": 1.0,
    "gyro_noise": 1e-2, "gyro_bias": 1e-2, "gyro_walk": 1e-2, "accelerometer_noise": 0.1, "accelerometer_bias": 0.1,
    "accelerometer_walk": 0.1, "wrench_noise": 1.0, "wrench_bias": 1.0, "wrench_drift": 1.0,
}  # fmt: skip


@pytest.mark.parametrize("term", TERMS)
def test_no_term_moves_the_numbers_of_another(world, term):
    """Errors of all terms together are the sum of those of each alone."""
    found = readings(world, SensorErrors(**TERMS), 150)
    without = readings(world, SensorErrors(**{name: size for name, size in TERMS.items() if name != term}), 150)
    alone = readings(world, SensorErrors(**{term: TERMS[term]}), 150)
    nothing = readings(world, PERFECT, 150)
    for name in SENSED:
        parts = values(without, name) + values(alone, name) - values(nothing, name)
        np.testing.assert_allclose(values(found, name), parts, atol=1e-12)
    assert any(not np.array_equal(values(alone, name), values(nothing, name)) for name in SENSED)


def test_lost_and_late_samples_move_no_noise(world):
    noise = SensorErrors(**TERMS)
    late = replace(noise, imu=Delivery(latency=0.004, jitter=0.004, dropout=0.3))
    one, other = readings(world, noise, 200), readings(world, late, 200)
    for tick, found in enumerate(other):
        taken = tick - round(found.specific_force.age * RATE)
        np.testing.assert_array_equal(found.specific_force.values, one[taken].specific_force.values)
        np.testing.assert_array_equal(found.wrench.values, one[tick].wrench.values)


@pytest.mark.parametrize("errors", [GOOD, CHEAP], ids=["good", "cheap"])
def test_a_seed_gives_the_same_readings_and_another_gives_others(world, errors):
    one, same, other = (readings(world, errors, 50, seed, ramp) for seed in (4, 4, 5))
    for name in set(SENSED) - {"joint_velocity"}:
        np.testing.assert_array_equal(values(one, name), values(same, name))
        assert not np.array_equal(values(one, name), values(other, name))


def test_feet_without_sensors_and_encoders_without_velocity_say_none(world):
    found = readings(world, SensorErrors(wrench_sensors=False, encoder_velocity=False), 2)[1]
    assert found.wrench is None
    assert found.joint_velocity is None
    assert all(PRESETS[name].encoder_velocity == (name == "perfect") for name in PRESETS)


def test_forces_of_a_preset_go_with_the_robot_and_its_imu_does_not():
    small = Similarity(length=0.7, mass=0.33).scaled(GOOD)
    assert small.wrench_noise == pytest.approx(0.33 * GOOD.wrench_noise, rel=0.05)
    assert small.moment_noise == pytest.approx(0.33 * 0.7 * GOOD.moment_noise, rel=0.05)
    for name in ("gyro_density", "gyro_range", "accelerometer_bias", "encoder_offset", "imu_displacement", "imu"):
        assert getattr(small, name) == getattr(GOOD, name)


def test_each_term_of_cheap_sensors_is_at_least_that_of_good_ones():
    numbers = [name for name in GOOD.__slots__ if isinstance(getattr(GOOD, name), float)]
    worse = {name for name in numbers if getattr(CHEAP, name) > getattr(GOOD, name) > getattr(PERFECT, name)}
    assert set(numbers) - worse == {
        "encoder_velocity_noise", "gyro_noise", "accelerometer_noise", "gyro_range", "accelerometer_range"
    }  # fmt: skip
