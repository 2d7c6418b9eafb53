"""Runs of an estimator that reads sensors: what they have said is in the log, by the seed, whichever way it is run."""

import numpy as np
import pytest

import surefoot
from surefoot.scenarios.errors import SetupError
from surefoot.scenarios.file.registries import SOURCES
from surefoot.scenarios.judge.scenario import scenario_of
from surefoot.scenarios.log import read
from surefoot.scenarios.run.processes import processes
from surefoot.scenarios.run.sensing import TrueState
from surefoot.sim.sensor_errors import CHEAP, GOOD

pytestmark = pytest.mark.unit

RATE = 500
SHORT = {"duration": 0.6, "criteria": {"fell": False}, "sensing.source": "ekf"}


def run(out, keys, name="walk-level"):
    return read(surefoot.run(surefoot.load(name, {**SHORT, **keys}), out=out).log)


def content(log):
    return log["/readings"].content(), log["/truth"].content()


def made(arguments):
    return content(run(*arguments))


@pytest.fixture(scope="module")
def cheap(tmp_path_factory):
    return run(tmp_path_factory.mktemp("cheap"), {"sensing.preset": "cheap"})


def errors_of(log, topic, group, field="joint_position"):
    """Errors that sensors have added to the truth of the time that they measure."""
    said, truth = log["/readings"], log["/measurement"]
    ticks = np.arange(len(said)) - np.rint(said.field(f"{group}_age") * log_rate(log)).astype(int)
    return said.field(topic) - truth.field(field)[ticks]


def log_rate(log):
    return round(1e9 / float(np.diff(log["/readings"].time_ns)[0]))


def test_readings_are_in_the_log_with_their_ages(cheap):
    found = cheap["/readings"]
    np.testing.assert_array_equal(found.time_ns, cheap["/measurement"].time_ns)
    lost = []
    for group in ("joint", "imu", "wrench"):
        ages = found.field(f"{group}_age")
        assert ages[0] == 0.0
        assert ages[5:].min() == pytest.approx(0.006)
        lost.append((1 - found.field(f"{group}_fresh")[5:]).mean())
    assert np.mean(lost) == pytest.approx(CHEAP.imu.dropout, abs=0.015)
    assert np.isnan(found.field("joint_velocity")).all()


def test_they_are_the_truth_and_what_the_preset_adds(cheap):
    angles = errors_of(cheap, "joint_position", "joint")
    assert angles.mean(axis=0).std() == pytest.approx(CHEAP.encoder_offset, rel=0.5)
    rounding = 2 * np.pi / 2**14 / np.sqrt(12)
    assert (angles - angles.mean(axis=0)).std() == pytest.approx(np.hypot(CHEAP.encoder_noise, rounding), rel=0.1)
    gyro = errors_of(cheap, "angular_velocity", "imu", "gyro")[4:]
    np.testing.assert_allclose(gyro.std(axis=0), CHEAP.gyro_density * np.sqrt(RATE), rtol=0.2)
    wrench = errors_of(cheap, "wrench_left", "wrench", "wrench_left")
    assert wrench[:, :3].std(axis=0).mean() == pytest.approx(CHEAP.wrench_noise, rel=0.15)
    assert wrench[:, 3:].std(axis=0).mean() == pytest.approx(CHEAP.moment_noise, rel=0.15)


def test_measurements_stay_the_truth(cheap):
    np.testing.assert_array_equal(cheap["/measurement"].field("joint_position"), cheap["/truth"].field("q")[:, 7:])


def test_the_truth_has_no_readings(tmp_path):
    log = run(tmp_path, {"sensing.source": "truth", "duration": 0.05})
    assert "/readings" not in log.topics


@pytest.mark.parametrize("robot", [pytest.param("humanoid100", marks=pytest.mark.long), "g1"])
def test_the_same_is_said_in_another_process_and_in_a_run_from_the_log(tmp_path, robot):
    keys = {"robot": robot, "sized_for": "humanoid100", "duration": 0.2, "sensing.preset": "cheap", "seed": 5}
    log = run(tmp_path, keys)
    again = read(surefoot.run(surefoot.load(log.path), out=tmp_path).log)
    assert content(again) == content(log)
    assert scenario_of(again) == scenario_of(log)
    with processes() as pool:
        assert list(pool.map(made, [(tmp_path, keys)])) == [content(log)]
    assert content(run(tmp_path, {**keys, "seed": 6})) != content(log)


def test_forces_of_a_small_robot_are_less_noisy(tmp_path):
    keys = {"robot": "g1", "sized_for": "humanoid100", "sensing.preset": "good"}
    log = run(tmp_path, keys)
    wrench = errors_of(log, "wrench_left", "wrench", "wrench_left")[:, :3]
    assert wrench.std(axis=0).mean() == pytest.approx(0.33 * GOOD.wrench_noise, rel=0.2)


def test_a_key_over_the_preset_acts_alone(tmp_path):
    keys = {"sensing.preset": "cheap", "sensing.latency": 0.0, "sensing.dropout": 0.0, "sensing.encoder_offset": 0.0}
    found = run(tmp_path, {**keys, "duration": 0.2})
    assert not found["/readings"].field("joint_age").any()
    assert found["/readings"].field("imu_fresh").all()
    assert np.abs(errors_of(found, "joint_position", "joint").mean(axis=0)).max() < 1e-4


def test_sensors_of_an_estimator_that_reads_none_are_refused(tmp_path):
    SOURCES.add("blind", TrueState)
    try:
        scenario = surefoot.load("walk-level", {**SHORT, "sensing.source": "blind", "sensing.gyro_bias": 0.1})
        with pytest.raises(SetupError, match=r"gyro_bias 0\.1 beside an estimator that reads no sensor"):
            surefoot.run(scenario, out=tmp_path)
    finally:
        SOURCES.discard("blind")
