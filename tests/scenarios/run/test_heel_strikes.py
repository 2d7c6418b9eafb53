"""Feet that land on their heels, on three robots and along every way to a run."""

import numpy as np
import pytest
import yaml
from typer.testing import CliRunner

import surefoot
from surefoot.scenarios.cli.program import app

pytestmark = pytest.mark.physics

GAIT = {
    "steps": 7, "step_length": 0.36, "single_support": 0.45, "double_support": 0.14, "heel_off": 0.35,
    "heel_strike": 0.15, "initial_stand": 0.3,
}  # fmt: skip
SOUND = {
    "fell": False, "steps_taken": "steps_planned", "wbc_fallbacks": {"max": 0}, "foot_slip_max": {"max": 0.005},
    "self_contact_time": {"max": 0},
}  # fmt: skip
ROBOTS = ("humanoid100", "g1", "talos")


def on_heels(robot, **more):
    """A walk of a robot that lands on its heels, steps and times for its size."""
    return {"name": f"heels-{robot}", "robot": robot, "sized_for": "humanoid100", "gait": {**GAIT, **more},
            "sensing": {"preset": "good"}, "criteria": SOUND}  # fmt: skip


@pytest.mark.parametrize("robot", ROBOTS)
def test_robots_land_on_their_heels_and_know_where_their_soles_are(robot, tmp_path, from_sensors):
    result = surefoot.run(surefoot.load("walk-level", on_heels(robot)), out=tmp_path)
    metrics, log = result.verdict.metrics, surefoot.read(result.log)
    assert result.verdict.reasons == ()
    assert 0.13 < metrics["heel_strike_pitch"] < 0.16
    held = log["/contact"].field("edge")
    assert {-1, 0, 1} == set(held[:, 0]) == set(held[:, 1])
    # An edge that is held is one that is planned, of a foot that is held.
    planned = np.sign(log["/reference"].field("roll"))
    assert ((held == 0) | (held == planned)).mean() > 0.99
    assert not held[log["/contact"].field("active") == 0].any()
    if from_sensors:
        assert metrics["estimation_nees"]["sole_height"] < 5.0


BRISK = {
    "gait.steps": 9, "gait.step_length": 0.46, "gait.single_support": 0.42, "gait.double_support": 0.12,
    "gait.heel_off": 0.5, "gait.initial_stand": 0.4, "gait.com_height": 1.0, "gait.heel_strike": 0.2,
    "criteria": {"fell": False, "steps_taken": "steps_planned"},
}  # fmt: skip
FORWARD, BACKWARD = 0.0, 3.1416


@pytest.mark.parametrize(
    ("phase", "fraction", "direction", "impulse"),
    [
        ("double", 0.5, FORWARD, 0.7), ("single", 0.2, FORWARD, 0.85), ("single", 0.5, FORWARD, 0.98),
        ("double", 0.5, BACKWARD, 1.2),
    ],
)  # fmt: skip
def test_steps_that_catch_the_body_catch_as_much_as_those_of_feet_that_land_flat(
    phase, fraction, direction, impulse, tmp_path
):
    """At 0.8 m/s. All but the third felled the robot when such steps landed on their heels, too."""
    push = {"step": 5, "phase": phase, "fraction": fraction, "duration": 0.1}
    pushes = [{**push, "impulse": impulse, "direction": direction}]
    assert surefoot.run(surefoot.load("walk-level", {**BRISK, "pushes": pushes}), out=tmp_path).verdict.reasons == ()


def command(*words):
    """Give a command in this process; returns what it says."""
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 0, done.output
    return done.output


def test_runs_checks_and_sweeps_of_two_robots_are_the_same_to_the_bit(tmp_path, monkeypatch, same_content):
    """Short of the end: the left foot lands on its heel after 1 s, and from then on stands on it."""
    monkeypatch.chdir(tmp_path)
    logs = {}
    for robot in ROBOTS[:2]:
        walk = {**on_heels(robot), "gait": {**GAIT, "steps": 2}, "duration": 1.4, "criteria": {"fell": False}}
        (tmp_path / f"heels-{robot}.yaml").write_text(yaml.safe_dump(walk))
        logs[robot] = surefoot.run(str(tmp_path / f"heels-{robot}.yaml"), out=tmp_path / "runs").log
        assert (surefoot.read(logs[robot])["/contact"].field("edge") != 0).any(axis=0).all()
        again = surefoot.run(str(logs[robot]), out=tmp_path / "again")
        assert same_content(logs[robot], again.log) == []
        command("replay", str(logs[robot]), "--html", f"{robot}.html")
        assert (tmp_path / f"{robot}.html").stat().st_size > 1e5
    names = [f"heels-{robot}.yaml" for robot in logs]
    spec = {"name": "heels", "scenario": names[0], "keep": "all", "grid": {"robot": [*logs]}}
    (tmp_path / "spec.yaml").write_text(yaml.safe_dump(spec))
    command("sweep", "spec.yaml", "--jobs", "2", "--out", "swept")  # each in a process of its own
    swept = sorted((tmp_path / "swept").rglob("log.mcap"))
    assert len(swept) == 2
    for log in logs.values():
        assert sum(same_content(log, one) == [] for one in swept) == 1
    command("check", *names, "--jobs", "1", "--update", "--out", "one")
    assert "2 same" in command("check", *names, "--jobs", "1", "--out", "two")


def test_no_edge_is_held_of_feet_that_do_not_roll(tmp_path):
    """Negative control."""
    flat = on_heels("humanoid100", heel_off=0.0, heel_strike=0.0, steps=4)
    log = surefoot.read(surefoot.run(surefoot.load("walk-level", flat), out=tmp_path).log)
    assert not log["/contact"].field("edge").any() and not log["/reference"].field("roll").any()


TRUTH = {"sensing.source": "truth"}
TURN = [{"time": 0.0, "yaw_rate": 0.4759989}, {"time": 3.5}]
CURVE = [{"time": 0.0, "v_x": 0.2974993, "yaw_rate": 0.2974993}, {"time": 6.0}]
SIDEWAYS = [{"time": 0.0, "v_y": 0.22}, {"time": 4.0}]
TOLD = [
    {"time": 0.5, "v_x": 0.5}, {"time": 2.4, "single_support": 0.437, "double_support": 0.137},
    {"time": 3.6, "v_x": -0.4}, {"time": 5.2, "v_y": 0.2, "swing_height": 0.07}, {"time": 6.6, "v_x": 0.0},
]  # fmt: skip
STOPS = [{"time": 0.0, "v_x": 0.3}, {"time": 2.5}, {"time": 5.0, "v_x": 0.5}, {"time": 7.5, "v_x": 0.2}, {"time": 9.0}]


@pytest.mark.parametrize(
    ("name", "shorter"),
    [
        ("walk-curve", {"gait.velocity": CURVE}), ("stop-and-go", {"gait.velocity": STOPS}),
        ("slope", {"gait.steps": 6, **TRUTH}), ("stairs-up-down", {"terrain.count": 2, "gait.steps": 7}),
        ("walk-turn", {"gait.velocity": TURN, **TRUTH}), ("walk-sideways", {"gait.velocity": SIDEWAYS, **TRUTH}),
        ("commanded", {"commands": TOLD, "duration": 8.5}),
    ],
)  # fmt: skip
def test_walks_of_every_kind_go_on_with_heel_strike(name, shorter, tmp_path):
    """Turning, stopping, on slopes and stairs; what is bounded is what no landing may cost."""
    settings = {"gait.heel_strike": 0.2, "criteria": SOUND, **shorter}
    assert surefoot.run(surefoot.load(name, settings), out=tmp_path).verdict.reasons == ()
