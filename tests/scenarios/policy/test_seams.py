"""A policy goes through everything that judges: run, a log run again, check, sweep, drive, serve, replay, inspect."""

import numpy as np
import pytest
import yaml

import surefoot
from surefoot.scenarios.judge.inspection import inspect
from surefoot.scenarios.judge.metrics import OWN

pytestmark = pytest.mark.physics

PLANNED = {"/reference", "/plan", "/planner_state", "/footsteps", "/wbc", "/estimate"}


def test_a_policy_stands_and_its_log_runs_again_to_the_bit(scenario, stander, same_content, tmp_path):
    result = surefoot.run(scenario(stander), out=tmp_path / "runs")
    assert result.verdict.passed, result.verdict
    again = surefoot.run(str(result.log), out=tmp_path / "again")
    assert same_content(result.log, again.log) == []
    log = surefoot.read(result.log)
    assert not PLANNED & set(log.topics)
    assert log.metadata["controller"]["name"] == "policy"
    observation = log["/controller"].field("observation")
    assert observation.shape == (60, 9 + 3 * 29)
    gravity = observation[:, 3:6]
    np.testing.assert_allclose(np.linalg.norm(gravity, axis=1), 1.0, atol=1e-6)


@pytest.mark.parametrize("robot", ["g1", "humanoid100"])
def test_a_gait_of_one_speed_is_a_velocity_to_it_and_its_pelvis_is_told(
    policies, scenario, same_content, tmp_path, robot
):
    def run(name, **sway):
        gait = {"steps": 3, "speed": 0.4, "initial_stand": 0.2, **sway}
        walk = scenario(policy, f"{name}.yaml", name=name, robot=robot, duration=0.6, gait=gait)
        return surefoot.run(walk, out=tmp_path / "runs")

    policy = policies.stander(tmp_path / f"of-{robot}", robot)
    plain, swaying = run("plain"), run("swaying", pelvis_yaw=0.08, pelvis_list=0.05)
    again = surefoot.run(str(swaying.log), out=tmp_path / "again")
    assert same_content(swaying.log, again.log) == same_content(swaying.log, plain.log) == []
    np.testing.assert_allclose(surefoot.read(again.log)["/command"].field("velocity")[0], (0.4, 0.0))
    unfelt = [f"gait.{name} has no effect on a controller without a planner" for name in ("pelvis_yaw", "pelvis_list")]
    for result, said in ((plain, []), (swaying, unfelt), (again, unfelt)):
        assert [note for note in result.verdict.notes if "no effect" in note] == said


def test_what_only_a_planner_has_is_absent_by_name(scenario, stander, tmp_path):
    result = surefoot.run(scenario(stander), out=tmp_path / "runs")
    for name, metric in OWN.items():
        if metric.planned:
            assert result.verdict.metrics[name] is None, name
    for name in ("foot_slip_max", "contact_force_peak", "torque_ratio_max", "stance_tilt_max", "steps_taken"):
        assert result.verdict.metrics[name] is not None, name
    assert {"zmp_error_rms", "com_error_rms", "wbc_fallbacks"} <= {n for n, m in OWN.items() if m.planned}
    inspected = inspect(surefoot.read(result.log))
    assert inspected.verdict.passed


def test_a_push_and_a_fall_are_told(scenario, stander, tmp_path):
    push = [{"time": 0.3, "impulse": 1.5, "duration": 0.1}]
    result = surefoot.run(scenario(stander, pushes=push, duration=2.0), out=tmp_path / "runs")
    assert result.verdict["fell"]
    health = inspect(surefoot.read(result.log)).health
    assert [one.check for one in health if one.relation == "cause"] == ["push"]


@pytest.mark.parametrize("robot", ["humanoid100", "g1"])
def test_every_form_of_a_contract_and_a_second_robot_walk_alike(policies, scenario, tmp_path, robot):
    forms = {"stander": policies.stander(tmp_path / "plain", robot)}
    if robot == "g1":
        forms |= {
            "framed": policies.framed(tmp_path / "framed"),
            "unitree": policies.unitree(tmp_path / "unitree"),
            "leapp": policies.leapp(tmp_path / "leapp"),
        }
    height = HEIGHTS[robot]
    ends = {}
    for name, file in forms.items():
        gait = {"steps": 0, "com_height": height, "initial_stand": 0.2}
        walk = scenario(file, f"{name}.yaml", robot=robot, gait=gait)
        result = surefoot.run(walk, out=tmp_path / "runs")
        assert result.verdict.passed, (name, result.verdict)
        ends[name] = surefoot.read(result.log)["/truth"].field("com")[-1]
    for name, end in ends.items():
        np.testing.assert_allclose(end, ends["stander"], atol=1e-4, err_msg=name)


@pytest.mark.parametrize("preset", ["perfect", "good"])
def test_it_walks_by_sensors_too(scenario, stander, same_content, tmp_path, preset):
    walk = scenario(stander, sensing={"preset": preset})
    result = surefoot.run(walk, out=tmp_path / "runs")
    assert result.verdict.passed, result.verdict
    log = surefoot.read(result.log)
    assert log.count("/readings") == log.count("/truth")
    tilt = log["/truth"].field("torso_tilt")[::10]
    seen = np.arccos(np.clip(-log["/controller"].field("observation")[:, 5], -1.0, 1.0))
    np.testing.assert_allclose(seen[: len(tilt)], tilt[: len(seen)], atol=0.1)


HEIGHTS = {"g1": 0.67, "humanoid100": 1.0}
"""Heights of the CoM of two robots [m]."""


@pytest.fixture
def walks(policies, scenario, tmp_path):
    """A scenario for each of two robots, each with a policy of its own."""
    found = []
    for robot, height in HEIGHTS.items():
        stander = policies.stander(tmp_path / f"of-{robot}", robot)
        keys = {"name": f"held-{robot}", "robot": robot, "duration": 0.5, "gait": {"steps": 0, "com_height": height}}
        found.append(scenario(stander, f"held-{robot}.yaml", **keys))
    return found


def test_check_in_two_processes_makes_equal_bits(walks, same_content, command, tmp_path):
    names = [str(walk) for walk in walks]
    for jobs in ("1", "2"):
        code, out = command("check", *names, "--update", "--jobs", jobs, "--out", jobs)
        assert code == 0, out
        for baseline in tmp_path.rglob("*.baseline.yaml"):
            baseline.unlink()  # the logs of runs that are the same as a baseline are not kept
    logs = [sorted((tmp_path / jobs).rglob("log.mcap")) for jobs in "12"]
    assert len(logs[0]) == len(logs[1]) == len(walks)
    for one, other in zip(*logs, strict=True):
        assert same_content(one, other) == []


def test_check_takes_a_policy_by_its_option(scenario, stander, command):
    walk = scenario(None, duration=0.5)
    asked = ("check", str(walk), "--policy", str(stander), "--jobs", "1")
    code, out = command(*asked, "--update", "--out", "one")
    assert code == 0, out
    code, out = command(*asked, "--out", "two")
    assert (code, "same" in out) == (0, True), out


def test_sweep_in_two_processes_makes_equal_bits(walks, same_content, command, tmp_path):
    robots = {}
    for walk in walks:
        keys = yaml.safe_load(walk.read_text())
        height, policy = keys["gait"]["com_height"], keys["controller"]["policy"]
        robots[walk.stem] = {"robot": keys["robot"], "gait.com_height": height, "controller.policy": policy}
    grid = {"held": robots}
    spec = {"name": "held", "scenario": str(walks[0]), "keep": "all", "grid": grid}
    (tmp_path / "held-twice.yaml").write_text(yaml.safe_dump(spec))
    for jobs in ("1", "2"):
        code, out = command("sweep", "held-twice.yaml", "--jobs", jobs, "--out", jobs)
        assert code == 0, out
    logs = [sorted((tmp_path / jobs).rglob("log.mcap")) for jobs in "12"]
    assert len(logs[0]) == len(logs[1]) == len(walks)
    assert len({surefoot.read(log)["/truth"].field("q").shape[1] for log in logs[0]}) == len(walks)
    for one, other in zip(*logs, strict=True):
        assert same_content(one, other) == []


def test_a_robot_under_a_policy_is_driven_and_commanded(scenario, stander, tmp_path):
    from surefoot.apps.drive.picture import Pictures

    with surefoot.Simulation(str(scenario(stander)), log=tmp_path / "log.mcap") as simulation:
        pictures = Pictures(simulation.walk)
        pictures.begin()
        simulation.command(v_x=2.0)
        simulation.push([5.0, 0.0, 0.0])
        for _ in range(200):
            tick = simulation.step()
        picture = pictures.picture(tick)
        ahead, _, margins, forces = pictures.values(tick)
        assert np.isfinite(ahead[:2]).all() and np.isnan(ahead[2:]).all() and np.isnan(margins).all()
        assert sum(forces) > 100.0
        assert picture.body_position.shape[0] == 1
        assert (simulation.orders.twist.x, simulation.orders.followed.x) == (2.0, 1.0)
        with pytest.raises(surefoot.ParameterError, match="velocities alone"):
            simulation.command(single_support=0.5)
        with pytest.raises(AttributeError, match="seat"):
            _ = tick.plan
        with pytest.raises(AttributeError, match="seat"):
            _ = simulation.planner
        for _ in range(100):
            simulation.advance()
    log = surefoot.read(tmp_path / "log.mcap")
    np.testing.assert_allclose(log["/command"].field("followed_velocity")[-1], (1.0, 0.0))
    again = surefoot.run(str(tmp_path / "log.mcap"), out=tmp_path / "again")
    told = surefoot.read(again.log)
    assert told["/truth"].field("q").tobytes() == log["/truth"].field("q").tobytes()


def test_its_log_is_replayed(scenario, stander, tmp_path):
    from surefoot.scenarios.show.replay.extract import extract

    result = surefoot.run(scenario(stander), out=tmp_path / "runs")
    replay = extract(surefoot.read(result.log))
    assert len(replay.time) > 20
    shown = {track.layer for track in replay.tracks if track.shown(10)}
    assert {"CoM", "ZMP", "Contact forces"} <= shown and "DCM" not in shown


def test_logs_of_both_robots_run_again_and_are_replayed(walks, same_content, command, tmp_path):
    for walk in walks:
        result = surefoot.run(str(walk), out=tmp_path / "runs")
        again = surefoot.run(str(result.log), out=tmp_path / "again")
        assert same_content(result.log, again.log) == []
        code, out = command("replay", str(result.log), "--html", f"{walk.stem}.html")
        assert code == 0 and (tmp_path / f"{walk.stem}.html").stat().st_size > 1e5, out


def test_a_log_does_not_run_again_with_another_network(scenario, stander, policies, spawned, tmp_path):
    result = surefoot.run(scenario(stander, duration=0.2), out=tmp_path / "runs")
    weights = np.zeros((9 + 3 * 29, 29))
    policies.network(stander.with_name("policy.onnx"), weights, [("obs", len(weights))])
    code, said = spawned("run", str(result.log))
    assert code == 2 and "is not the policy that made the log" in said and "Traceback" not in said
    assert said.count("\n") == 1


def test_without_the_extra_a_run_is_refused_in_one_sentence(scenario, stander, spawned, tmp_path):
    (tmp_path / "onnxruntime.py").write_text("raise ImportError('not here')")
    code, said = spawned("run", str(scenario(stander)), "--out", "nothing")
    assert code == 2 and "needs the package onnxruntime" in said and said.count("\n") == 1
    assert not list((tmp_path / "nothing").iterdir())


def test_a_command_that_was_never_heard_is_said(scenario, stander, tmp_path):
    push, commands = [{"time": 0.1, "impulse": 2.0}], [{"time": time, "v_x": 0.0} for time in (0.05, 1.9)]
    result = surefoot.run(scenario(stander, commands=commands, pushes=push, duration=2.0), out=tmp_path / "runs")
    assert result.verdict["fell"]
    assert [reason for reason in result.verdict.reasons if "did not hear it" in reason] == [
        "commands.1 came at 1.9 s and never acted: the controller did not hear it"
    ]


def test_a_campaign_goes_on_with_another_policy_anew(scenario, policies, command, tmp_path):
    walk, folder = scenario(None, duration=0.6), tmp_path / "policy"
    spec = {"name": "yaws", "scenario": str(walk), "grid": {"start.yaw": [0.0, 0.1]}}
    (tmp_path / "yaws.yaml").write_text(yaml.safe_dump(spec))
    asked = ("sweep", "yaws.yaml", "--policy", str(folder), "--jobs", "1", "--out", "swept", "--json")
    policies.stander(folder)
    code, first = command(*asked)
    assert code == 0, first
    code, again = command(*asked)
    assert (code, again) == (0, first)
    policies.stander(folder, stiffness=1.0)
    code, limp = command(*asked)
    assert limp != first and '"fail"' in limp, limp
