"""The files that a run leaves on disk, however it ends."""

import json
import signal
import time
from concurrent.futures import ThreadPoolExecutor

import pytest
import yaml

from surefoot.scenarios.errors import LogError, ScenarioError
from surefoot.scenarios.log import read
from surefoot.scenarios.run import interrupts
from surefoot.scenarios.run.run import run_scenario

pytestmark = pytest.mark.unit


def test_log_and_verdict_lie_side_by_side(tmp_path, robot, motion, two_steps):
    told = []
    result = run_scenario(two_steps, tmp_path / "new", told.append, motion(), robot)
    assert result.log == tmp_path / "new" / "two-steps-0" / "log.mcap"
    written = json.loads(result.log.with_name("verdict.json").read_text())
    assert written == result.verdict.to_json()
    assert written["verdict"] == "pass"
    assert len(told) == 200


def test_the_log_says_all_about_the_run(tmp_path, robot, motion, two_steps):
    log = read(run_scenario(two_steps, tmp_path, None, motion(), robot).log)
    assert yaml.safe_load(log.attachments["scenario.yaml"])["gait"]["steps"] == 2
    assert log.attachments["robot.xml"] == b"<mujoco/>"
    assert log.metadata["run"]["seed"] == "0"
    assert {"mujoco", "pin", "numpy", "python", "git_revision"} <= log.metadata["versions"].keys()
    assert log.metadata["end"]["kind"] == "completed"


def test_the_same_run_gives_the_same_log(tmp_path, robot, motion, two_steps):
    logs = [run_scenario(two_steps, tmp_path / name, None, motion(), robot).log for name in "ab"]
    assert logs[0].read_bytes() == logs[1].read_bytes()
    first, second = (read(log) for log in logs)
    assert all(first[topic].content() == second[topic].content() for topic in first.topics)


@pytest.mark.usefixtures("heeding")
def test_a_signal_waits_until_nothing_is_half_done(tmp_path, robot, motion, two_steps):
    done = []

    def simulate(walk, writer, on_progress):
        signal.raise_signal(signal.SIGINT)
        done.append("a message")
        motion()(walk, writer, on_progress)
        done.append("the walk")

    result = run_scenario(two_steps, tmp_path, None, simulate, robot)
    assert (result.interrupted, done) == (True, ["a message"])
    assert read(result.log).metadata["end"]["kind"] == "interrupted"


@pytest.mark.usefixtures("heeding")
@pytest.mark.parametrize("told", [None, TypeError("incompatible function arguments")])
def test_a_part_that_hangs_does_not_hold_a_signal_back(tmp_path, robot, motion, two_steps, monkeypatch, told):
    """A compiled part tells a signal that comes while it converts an argument as a wrong argument."""
    monkeypatch.setattr(interrupts, "_HANGING", 0.1)

    def simulate(walk, writer, on_progress):
        motion(duration=0.5)(walk, writer, on_progress)
        signal.raise_signal(signal.SIGINT)
        try:
            time.sleep(60.0)
        except KeyboardInterrupt as signalled:
            raise told or signalled from None

    result = run_scenario(two_steps, tmp_path, None, simulate, robot)
    assert result.interrupted
    assert read(result.log).metadata["end"]["kind"] == "interrupted"


def test_a_defect_of_a_part_is_no_signal(tmp_path, robot, two_steps):
    def broken(*_):
        raise TypeError("incompatible function arguments")

    with pytest.raises(TypeError):
        run_scenario(two_steps, tmp_path, None, broken, robot)


def test_interrupted_by_the_user_the_log_is_whole(tmp_path, robot, motion, two_steps):
    result = run_scenario(two_steps, tmp_path, None, motion(stop_at=1.2, raises=KeyboardInterrupt()), robot)
    assert result.interrupted
    assert not read(result.log).truncated
    assert result.verdict.reasons[0].endswith("interrupted by the user")


def test_a_defect_is_raised_after_the_log_was_closed(tmp_path, robot, motion, two_steps):
    with pytest.raises(ZeroDivisionError):
        run_scenario(two_steps, tmp_path, None, motion(raises=ZeroDivisionError("x")), robot)
    log = read(tmp_path / "two-steps-0" / "log.mcap")
    assert not log.truncated
    assert log.metadata["end"]["reason"] == "internal error, ZeroDivisionError: x"


def test_a_scenario_that_the_loop_refuses_leaves_no_log(tmp_path, robot, motion, two_steps):
    with pytest.raises(ScenarioError):
        run_scenario(two_steps, tmp_path, None, motion(raises=ScenarioError(["planner.horizon is too short"])), robot)
    assert list(tmp_path.iterdir()) == []


def test_no_run_touches_another_one(tmp_path, robot, motion, two_steps):
    """The second begins while the first goes on, as in another process, and the first still judges its own log."""

    def first(walk, writer, on_progress):
        end = motion()(walk, writer, on_progress)
        others.append(run_scenario(two_steps, tmp_path, None, motion(fall_at=1.0), robot))
        return end

    others = []
    result = run_scenario(two_steps, tmp_path, None, first, robot)
    assert result.log == tmp_path / "two-steps-0" / "log.mcap"
    assert others[0].log == tmp_path / "two-steps-0-2" / "log.mcap"
    assert result.verdict.passed
    assert not others[0].verdict.passed
    assert json.loads(result.log.with_name("verdict.json").read_text())["verdict"] == "pass"
    with pytest.raises(ZeroDivisionError):
        run_scenario(two_steps, tmp_path, None, motion(raises=ZeroDivisionError()), robot)
    assert not (tmp_path / "two-steps-0-3" / "verdict.json").exists()


def test_of_many_at_once_each_has_a_folder_of_its_own(tmp_path, robot, motion, two_steps):
    def some(_):
        return [run_scenario(two_steps, tmp_path, None, motion(duration=0.02), robot).log for _ in range(5)]

    with ThreadPoolExecutor(4) as pool:
        logs = [log for found in pool.map(some, range(4)) for log in found]
    assert len(set(logs)) == len(logs) == 20


def test_a_place_that_is_no_directory(tmp_path, robot, motion, two_steps):
    (tmp_path / "file").write_text("")
    with pytest.raises(LogError, match="choose another directory with --out"):
        run_scenario(two_steps, tmp_path / "file", None, motion(), robot)
