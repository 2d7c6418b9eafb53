"""Sensors by kernels beside plain ones: the same draws and arrivals, and an IMU that differs by rounding at most."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from surefoot.models.registry import describe
from surefoot.models.types import ImuPlace, RobotOptions
from surefoot.native.library import VARIABLE
from surefoot.planner.ground.terrain import flat
from surefoot.sim.compiled import CompiledSensors
from surefoot.sim.readings import BLOCK, SensorSuite
from surefoot.sim.sensor_errors import CHEAP, GOOD, PERFECT, Delivery
from surefoot.sim.world import World

pytestmark = pytest.mark.unit

RATE, TICKS = 500, 2 * BLOCK + 20
NEAR = 1e-12
"""Largest difference of what an IMU says, of numbers above 1 as a share."""

JOINTS_AND_FEET = ("joint_position", "joint_velocity", "joint_torque", "wrench")
IMU = ("angular_velocity", "mean_angular_velocity", "specific_force")
EVERY_TERM = replace(
    CHEAP, encoder_velocity=True, encoder_velocity_noise=0.02, gyro_noise=1e-3, gyro_range=0.5, accelerometer_noise=0.1,
    accelerometer_range=20.0, imu=Delivery(0.003, 0.005, 0.2), joints=Delivery(jitter=0.004), feet=Delivery(0.007),
)  # fmt: skip
ERRORS = {
    "every term": EVERY_TERM,
    "perfect": PERFECT,
    "good": GOOD,
    "cheap": CHEAP,
    "angles not rounded": replace(GOOD, encoder_bits=0),
    "no feet": replace(GOOD, wrench_sensors=False),
}
TORSO = ImuPlace("torso", (0.05, -0.02, 0.1), (0.5, 0.5, -0.5, 0.5))
PLACES = {
    "humanoid100": None,
    "humanoid100 on its torso": TORSO,
    "humanoid100 on a foot": ImuPlace("left_foot", (0.05, 0.0, 0.02), (0.6, 0.0, 0.8, 0.0)),
    "humanoid100 with an axis beside its waist": TORSO,
    "talos": None,
    "g1": None,
}


def world_of(name):
    robot = describe(name.split()[0], RobotOptions())
    if "beside" in name:
        joint = f'<joint name="{robot.roles.waist[0]}"'
        robot = replace(robot, mjcf=robot.mjcf.replace(joint, f'{joint} pos="0.05 0.03 -0.02"'))
    return World(robot if PLACES[name] is None else replace(robot, imu=PLACES[name]), flat(), 1000)


class Truth(SimpleNamespace):
    """A measurement that is overwritten at each tick, of a robot that tumbles and is pushed at."""

    def __init__(self, joints, seed=0):
        q, v = np.zeros(7 + joints), np.zeros(6 + joints)
        q[6] = 1.0
        super().__init__(
            q=q, v=v, joint_position=q[7:], joint_velocity=v[6:], joint_torque=np.zeros(joints), wrench=np.zeros((2, 6))
        )
        self.rng = np.random.default_rng(seed)

    def move(self):
        rng, q, v = self.rng, self.q, self.v
        v += 0.05 * rng.normal(size=len(v))
        q[:3] += v[:3] / RATE
        q[3:7] += 0.01 * rng.normal(size=4)
        q[3:7] /= np.linalg.norm(q[3:7])
        q[7:] += v[6:] / RATE
        self.joint_torque[:], self.wrench[:] = rng.normal(size=len(self.joint_torque)), 50.0 * rng.normal(size=(2, 6))


SEEN = ("q", "v", "joint_position", "joint_velocity", "joint_torque", "wrench")


@pytest.fixture
def suites(kernels, monkeypatch):
    """Compiled and plain sensors of a world."""

    def make(world, errors, seed=3):
        compiled = SensorSuite(world, errors, RATE, seed)
        monkeypatch.setenv(VARIABLE, "0")
        plain = SensorSuite(world, errors, RATE, seed)
        monkeypatch.delenv(VARIABLE)
        assert isinstance(compiled._sample, CompiledSensors)
        assert not isinstance(plain._sample, CompiledSensors)
        return compiled, plain

    return make


def alike(compiled, plain):
    assert compiled.time == plain.time
    for name in (*JOINTS_AND_FEET, *IMU):
        one, other = getattr(compiled, name), getattr(plain, name)
        assert (one is None) == (other is None), name
        if one is None:
            continue
        assert (one.age, one.fresh, one.values.shape) == (other.age, other.fresh, other.values.shape), name
        if name in IMU:
            assert (np.abs(one.values - other.values) <= NEAR * np.maximum(1.0, np.abs(other.values))).all(), name
        else:
            np.testing.assert_array_equal(one.values, other.values, err_msg=name)


@pytest.mark.parametrize(
    ("name", "errors"), [(name, "every term") for name in PLACES] + [("humanoid100", each) for each in list(ERRORS)[1:]]
)
def test_kernels_say_what_plain_python_does(suites, name, errors):
    world = world_of(name)
    pair, truth, said = suites(world, ERRORS[errors]), Truth(len(world.description.joint_names)), []
    for tick in range(TICKS):
        truth.move()
        found = [suite.read(truth, tick) for suite in pair]
        alike(*found)
        said.append(found[0])
    assert len({one.specific_force.values.tobytes() for one in said}) > TICKS // 3
    if errors == "every term":
        sizes = [np.abs([getattr(one, name).values for one in said]).max() for name in IMU]
        assert sizes == [0.5, 0.5, 20.0]  # each range was met
        assert not all(one.specific_force.fresh for one in said)


def test_kernels_read_the_truth_wherever_it_is(suites):
    """In other arrays than at the tick before, in pieces of others, or in whole numbers."""
    pair, truth = suites(world_of("humanoid100"), replace(GOOD, encoder_velocity=True)), Truth(25)
    for tick in range(30):
        truth.move()
        name = SEEN[tick % len(SEEN)]
        setattr(truth, name, getattr(truth, name) + 0.1)
        if tick == 12:
            truth.joint_torque = np.zeros((25, 2))[:, 0]
        if tick == 20:
            truth.wrench = truth.wrench.astype(int)
        alike(*(suite.read(truth, tick) for suite in pair))


@pytest.mark.parametrize("name", ["joint_position", "q", "wrench"])
def test_a_truth_of_another_size_is_refused(suites, name):
    suite, truth = suites(world_of("humanoid100"), GOOD)[0], Truth(25)
    suite.read(truth, 0)
    setattr(truth, name, np.zeros(5))
    with pytest.raises(ValueError, match=f"{name} of a measurement has 5 numbers"):
        suite.read(truth, 1)
