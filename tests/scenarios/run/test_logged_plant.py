"""A run that goes on from the state of a log: what the log holds until then, and the same motion from there."""

import subprocess
import sys

import numpy as np
import pytest
from typer.testing import CliRunner

import surefoot
from surefoot.scenarios.cli.program import app
from surefoot.scenarios.errors import LogError, ScenarioError, SetupError

pytestmark = pytest.mark.physics

PUSH = {"pushes": [{"time": 1.45, "impulse": 0.3, "duration": 0.1}, {"time": 0.5, "impulse": 0.05}]}

RUNS = {
    "humanoid100": {"sensing.source": "truth", **PUSH},
    "g1 by its sensors, late motors": {
        "robot": "g1",
        "sensing.source": "ekf",
        "sensing.preset": "good",
        "motors": {"delay": 0.004, "noise": 0.02},
        "pushes": [{"step": 1, "phase": "single", "fraction": 0.5, "impulse": 0.2}],
    },
}
UNTIL = 1.5


@pytest.fixture(scope="module")
def logs(tmp_path_factory):
    """A run of each, and one that goes on from its state."""
    folder, found = tmp_path_factory.mktemp("logs"), {}
    for name, values in RUNS.items():
        log = surefoot.run(surefoot.load("walk-level", {"gait.steps": 2, "duration": 2.6, **values}), out=folder).log
        plant = {"plant": {"name": "log", "options": {"log": str(log), "until": UNTIL}}}
        again = surefoot.run(surefoot.load(str(log), plant), out=folder).log
        found[name] = surefoot.read(log), surefoot.read(again)
    return found


@pytest.mark.parametrize("name", RUNS)
def test_the_log_is_heard_to_the_bit_and_its_motion_goes_on(logs, name):
    log, again = logs[name]
    time = log["/truth"].time
    before, after = time <= UNTIL + 1e-9, (time > UNTIL) & (time < UNTIL + 0.2)
    for topic, field in (("/truth", "q"), ("/truth", "v"), ("/measurement", "external_force"), ("/torque", "command")):
        one, two = log[topic].field(field), again[topic].field(field)
        assert np.array_equal(one[before], two[before]), (topic, field)
    one, two = log["/truth"].field("com"), again["/truth"].field("com")
    assert len(one) == len(two)
    assert 0.0 < np.abs(one[after] - two[after]).max() < 1e-9
    speed = np.linalg.norm(np.diff(one[before], axis=0), axis=1).max()
    assert speed > 1e-4, "it moves when it begins"


@pytest.mark.parametrize("name", RUNS)
def test_motors_and_sensors_go_on_with_what_they_had(logs, name):
    log, again = logs[name]
    time = log["/truth"].time
    soon = (time > UNTIL) & (time < UNTIL + 0.03)
    torque, other = (one["/measurement"].field("joint_torque")[soon] for one in (log, again))
    assert np.abs(torque - other).max() < 1e-6
    if "/readings" in log.numeric:
        for field in ("joint_position", "angular_velocity", "wrench_left", "joint_age"):
            one, two = (of["/readings"].field(field)[soon] for of in (log, again))
            assert np.allclose(one, two, atol=1e-6, equal_nan=True), field


def test_a_push_that_goes_on_acts_for_the_rest_of_its_time_and_one_that_is_over_does_not_act_again(logs):
    log, again = logs["humanoid100"]
    rate = 500
    for one in (log, again):
        impulse = one["/measurement"].field("external_force").sum(axis=0) / rate
        mass = 100.0
        assert impulse[0] / mass == pytest.approx(0.35, abs=0.01)
    assert not [reason for reason in surefoot.judge(again).reasons if "push" in reason]


def test_a_change_acts_from_the_instant_on_and_not_before(logs, tmp_path):
    log, _ = logs["humanoid100"]
    plant = {"plant": {"name": "log", "options": {"log": str(log.path), "until": UNTIL}}}
    changed = {"terrain.friction": 0.3, "errors.payload.mass": 30.0, "pushes": []}
    other = surefoot.read(surefoot.run(surefoot.load(str(log.path), {**plant, **changed}), out=tmp_path).log)
    time = log["/truth"].time
    one, two = log["/truth"].field("q"), other["/truth"].field("q")
    before, later = time <= UNTIL + 1e-9, time > UNTIL + 0.3
    assert np.array_equal(one[before], two[before])
    assert np.abs(one[later] - two[later]).max() > 1e-3


def test_its_log_runs_again_to_the_bit(logs, tmp_path, same_content):
    _, again = logs["g1 by its sensors, late motors"]
    assert same_content(again.path, surefoot.run(str(again.path), out=tmp_path).log) == []


def test_it_goes_through_check_sweep_and_pytest_wherever_they_are_started(logs, tmp_path, monkeypatch):
    log, _ = logs["humanoid100"]
    folder = tmp_path / "tests"
    folder.mkdir()
    (folder / "held.mcap").write_bytes(log.path.read_bytes())
    text = "plant: {name: log, options: {log: held.mcap, until: 0.1}}\ngait: {steps: 0}\nduration: 0.2\n"
    file = folder / "held.scenario.yaml"
    file.write_text(text + "robot_options: {foot_length: 0.22, foot_width: 0.11}\ncriteria: {fell: false}\n")
    assert surefoot.load(str(file)).plant.options["log"] == str(folder / "held.mcap")
    (tmp_path / "two.yaml").write_text(f"scenario: {file}\ngrid: {{terrain.friction: [0.8, 0.7]}}\n")

    def given(*words):
        done = CliRunner().invoke(app, words)
        return done.exit_code, done.output

    monkeypatch.chdir(tmp_path)
    assert given("check", "tests/held.scenario.yaml", "--update")[0] == 0
    assert given("check", "tests/held.scenario.yaml") == (0, "held.scenario: same\n1 scenario: 1 same\n")
    code, said = given("sweep", "two.yaml", "--jobs", "1", "--out", "swept")
    assert code == 0, said
    assert "2" in said
    asked = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "tests"]
    done = subprocess.run(asked, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "1 passed" in done.stdout


@pytest.mark.parametrize(
    ("options", "error", "match"),
    [
        ({"until": 99.0}, SetupError, "until 99 s, where the log has 0 to 2.598 s"),
        ({"until": -1.0}, SetupError, "until -1 s"),
        ({"until": "soon"}, SetupError, "give log, its path, and until"),
        ({"more": 1}, SetupError, "give log, its path, and until"),
        ({"log": "nowhere.mcap"}, LogError, "nowhere.mcap"),
    ],
)
def test_what_is_no_instant_of_a_log_is_refused(logs, tmp_path, options, error, match):
    log, _ = logs["humanoid100"]
    given = {"log": str(log.path), "until": UNTIL, **options}
    scenario = surefoot.load(str(log.path), {"plant": {"name": "log", "options": given}})
    with pytest.raises(error, match=match):
        surefoot.run(scenario, out=tmp_path)


def test_another_robot_and_driven_joints_are_refused(logs, tmp_path):
    log, _ = logs["humanoid100"]
    plant = {"plant": {"name": "log", "options": {"log": str(log.path), "until": UNTIL}}}
    other = surefoot.load("walk-level", {"robot": "g1", "sensing.source": "truth", **plant})
    with pytest.raises(LogError, match="another robot than g1"):
        surefoot.run(other, out=tmp_path)
    driven = {"control": {"driven_joints": {"left_shoulder_pitch": [100.0, 10.0]}}}
    with pytest.raises((SetupError, ScenarioError), match="driven_joints"):
        surefoot.run(surefoot.load(str(log.path), {**plant, **driven}), out=tmp_path)
