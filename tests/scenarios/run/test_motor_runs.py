"""Runs whose motors and ground are not as believed: run again from their logs, by their seed, with other robots."""

import numpy as np
import pytest
import yaml

import surefoot
from surefoot.scenarios.judge.scenario import scenario_of
from surefoot.scenarios.log import read
from surefoot.scenarios.record.provenance import SCENARIO_FILE, WORLD_FILE
from surefoot.scenarios.run.processes import processes
from surefoot.scenarios.setup.load import _UNSAID

pytestmark = pytest.mark.unit

MOTORS = {"damping": 0.5, "friction_loss": 0.3, "delay": 0.002, "noise": 0.2, "torque_speed": 0.5}
SHORT = {"duration": 0.1, "criteria": {"fell": False}}


def motion(log):
    return log["/truth"].field("q")


def run(out, keys, name="walk-level"):
    return read(surefoot.run(surefoot.load(name, {**SHORT, **keys}), out=out).log)


def moved(arguments):
    return motion(run(*arguments))


@pytest.mark.parametrize("robot", ["humanoid100", "g1"])
def test_a_log_run_again_moves_alike(tmp_path, robot):
    keys = {"robot": robot, "sized_for": "humanoid100", "motors": MOTORS, "errors.torso_mass": 1.1, "seed": 3}
    log = run(tmp_path, keys)
    assert yaml.safe_load(log.attachments[SCENARIO_FILE])["motors"].keys() == MOTORS.keys()
    again = read(surefoot.run(surefoot.load(log.path), out=tmp_path).log)
    np.testing.assert_array_equal(motion(again), motion(log))
    assert scenario_of(again) == scenario_of(log)
    assert "frictionloss" in log.attachments[WORLD_FILE].decode()


def test_a_process_of_its_own_moves_alike(tmp_path):
    arguments = tmp_path, {"motors": MOTORS, "errors.ground_pitch": 0.02}
    with processes() as pool:
        (there,) = pool.map(moved, [arguments])
    np.testing.assert_array_equal(there, moved(arguments))


def test_each_motor_key_moves_the_robot(tmp_path):
    plain = motion(run(tmp_path, {}))
    for name in MOTORS.keys() - {"torque_speed"}:  # a bound, within which the torques of a robot that stands stay
        found = motion(run(tmp_path, {f"motors.{name}": MOTORS[name]}))
        assert not np.array_equal(found, plain), name


def test_noise_of_motors_is_that_of_the_seed(tmp_path):
    one, same, other = (motion(run(tmp_path, {"motors.noise": 0.5, "seed": seed})) for seed in (1, 1, 2))
    np.testing.assert_array_equal(one, same)
    assert not np.array_equal(one, other)


def test_scenarios_of_earlier_logs_say_nothing_of_sensors():
    """Zeros that were written down as defaults would else replace what a preset has."""
    old = "sensing:\n  source: truth\n  encoder_noise: 0.0\n  latency: 0.0\n"
    assert _UNSAID.sub("", old) == "sensing:\n  source: truth\n"
    assert _UNSAID.sub("", old.replace("0.0", "0.5")) == old.replace("0.0", "0.5")
