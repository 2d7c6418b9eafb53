"""Errors of sensors are added: at the first tick each is its deviation times the first numbers of its own stream."""

from types import SimpleNamespace

import numpy as np
import pytest

from surefoot.models.registry import describe
from surefoot.models.types import RobotOptions
from surefoot.planner.ground.terrain import flat
from surefoot.sim.readings import SensorSuite
from surefoot.sim.sensor_errors import SensorErrors
from surefoot.sim.world import World
from surefoot.similarity import GRAVITY
from surefoot.streams import Stream, generator

pytestmark = pytest.mark.unit

RATE, SEED = 500, 4
NOISE, BIAS, WALK, OFFSET, VELOCITY = range(5)
"""Parts of a stream, in the order in which sensors count them."""

SIX = np.repeat([20.0, 3.0], 3)


@pytest.fixture(scope="module")
def world():
    return World(describe("humanoid100", RobotOptions()), flat(), 1000)


def said(world, ticks=1, **errors):
    """Readings of a robot that hangs still, whose joints are where they are."""
    joints = len(world.description.joint_names)
    angles, still, upright = np.linspace(-0.5, 0.5, joints), np.zeros(joints), np.eye(7)[6]
    truth = SimpleNamespace(
        joint_position=angles, joint_velocity=still + 0.2, joint_torque=still + 7.0, wrench=np.full((2, 6), 30.0),
        q=np.concatenate((upright, angles)), v=np.zeros(6 + joints),
    )  # fmt: skip
    suite = SensorSuite(world, SensorErrors(**errors), RATE, SEED)
    return [suite.read(truth, tick) for tick in range(ticks)], truth


@pytest.mark.parametrize(
    ("errors", "name", "deviation", "stream", "part"),
    [
        ({"encoder_noise": 0.01}, "joint_position", 0.01, Stream.ENCODER, NOISE),
        ({"encoder_offset": 0.02}, "joint_position", 0.02, Stream.ENCODER, OFFSET),
        ({"encoder_velocity_noise": 0.3}, "joint_velocity", 0.3, Stream.ENCODER, VELOCITY),
        ({"joint_torque_noise": 2.0}, "joint_torque", 2.0, Stream.JOINT_TORQUE, None),
        ({"gyro_noise": 0.1}, "angular_velocity", 0.1, Stream.GYRO, NOISE),
        ({"gyro_noise": 0.1}, "mean_angular_velocity", 0.1, Stream.GYRO, NOISE),
        ({"gyro_bias": 0.2}, "angular_velocity", 0.2, Stream.GYRO, BIAS),
        ({"accelerometer_noise": 0.4}, "specific_force", 0.4, Stream.ACCELEROMETER, NOISE),
        ({"accelerometer_bias": 0.5}, "specific_force", 0.5, Stream.ACCELEROMETER, BIAS),
        ({"wrench_noise": 20.0, "moment_noise": 3.0}, "wrench", SIX, Stream.WRENCH, NOISE),
        ({"wrench_bias": 20.0, "moment_bias": 3.0}, "wrench", SIX, Stream.WRENCH, BIAS),
    ],
)
def test_a_sensor_says_the_truth_and_its_error(world, errors, name, deviation, stream, part):
    (found,), truth = said(world, **errors)
    true = {"specific_force": np.array([0.0, 0.0, GRAVITY])}.get(name, getattr(truth, name, np.zeros(3)))
    error = deviation * generator(SEED, stream, part).standard_normal(true.shape)
    np.testing.assert_allclose(getattr(found, name).values, true + error, atol=1e-12)


@pytest.mark.parametrize(
    ("errors", "name", "walk", "stream"),
    [
        ({"gyro_walk": 0.1}, "angular_velocity", 0.1, Stream.GYRO),
        ({"accelerometer_walk": 0.1}, "specific_force", 0.1, Stream.ACCELEROMETER),
        ({"wrench_drift": 20.0, "moment_drift": 3.0}, "wrench", SIX, Stream.WRENCH),
    ],
)
def test_a_bias_walks_by_the_sum_of_its_steps(world, errors, name, walk, stream):
    found, _ = said(world, 5, **errors)
    values = np.array([getattr(one, name).values for one in found])
    steps = walk / np.sqrt(RATE) * generator(SEED, stream, WALK).standard_normal((4, *values.shape[1:]))
    np.testing.assert_allclose(values - values[0], np.cumsum([np.zeros_like(values[0]), *steps], axis=0), atol=1e-12)
