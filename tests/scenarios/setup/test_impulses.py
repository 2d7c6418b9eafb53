"""Pushes given by their impulse per kilogram."""

import math

import numpy as np
import pytest

from surefoot.scenarios.log import read
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.walk import resolve

pytestmark = pytest.mark.unit

PUSH = "pushes=[{time: 1.5, duration: 0.2, impulse: 0.1}]"


def force(*settings):
    (push,) = resolve(load("walk-level", [PUSH, *settings])).pushes
    return push.force


def test_force_is_true_mass_times_impulse_over_duration():
    np.testing.assert_allclose(force(), [50.0, 0.0, 0.0])  # 100 kg, 0.1 m/s, 0.2 s
    np.testing.assert_allclose(force("robot_options.payload_mass=20"), [60.0, 0.0, 0.0])
    np.testing.assert_allclose(force("errors.mass_scale=1.25"), [40.0, 0.0, 0.0])
    np.testing.assert_allclose(force("pushes.0.impulse=0.3", "pushes.0.duration=0.1"), [300.0, 0.0, 0.0])


@pytest.mark.parametrize("angle", [-0.5 * math.pi, 0.3, math.pi])
def test_direction_is_anticlockwise_from_the_worlds_x_axis(angle):
    turned = force(f"pushes.0.direction={angle!r}", "start.yaw=1")  # the robot's heading does not matter
    np.testing.assert_allclose(turned, 50.0 * np.array([math.cos(angle), math.sin(angle), 0.0]), atol=1e-12)


@pytest.mark.parametrize("elevation", [-0.5 * math.pi, -0.4, 0.7])
def test_elevation_lifts_the_impulse_from_the_ground_and_keeps_its_size(elevation):
    lifted = force("pushes.0.direction=2.5", f"pushes.0.elevation={elevation!r}")
    level = math.cos(elevation)
    expected = np.array([level * math.cos(2.5), level * math.sin(2.5), math.sin(elevation)])
    np.testing.assert_allclose(lifted, 50.0 * expected, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(lifted), 50.0)


def test_a_push_by_its_force_may_be_given_an_impulse_in_its_place():
    settings = ("pushes.0.force=null", "pushes.0.impulse=0.1", "pushes.0.duration=0.1")
    (push,) = resolve(load("paper-push", settings)).pushes
    np.testing.assert_allclose(push.force, [100.0, 0.0, 0.0])


@pytest.mark.parametrize("payload", [0.0, 30.0])
def test_the_pendulum_changes_its_speed_by_the_impulse_whatever_it_weighs(tmp_path, payload):
    """A push of one tick is over before the pendulum has begun to tip."""
    settings = ("fidelity=pendulum", "duration=1.6", f"robot_options.payload_mass={payload}", "pendulum.feedback=0")
    short = ("pushes=[{time: 1.5, duration: 0.002, impulse: 0.1, direction: 0.3}]", "criteria={fell: false}")
    log = read(run_scenario(load("stand", [*settings, *short]), tmp_path).log)
    time, velocity = log["/truth"].time, log["/truth"].field("com_velocity")
    after = int(np.searchsorted(time, 1.503))
    np.testing.assert_allclose(velocity[after, :2], 0.1 * np.array([math.cos(0.3), math.sin(0.3)]), rtol=0.02)


@pytest.mark.parametrize(("fidelity", "elevation"), [("pendulum", 0.0), ("full", -0.6)])
def test_a_log_of_it_is_run_again_as_it_was(tmp_path, fidelity, elevation):
    short = (f"fidelity={fidelity}", "duration=1.8", "criteria={fell: false}", f"pushes.0.elevation={elevation}")
    run = run_scenario(load("walk-level", [PUSH, *short]), tmp_path)
    (push,) = load(run.log).pushes
    assert (push.impulse, push.elevation, push.force) == (0.1, elevation, None)
