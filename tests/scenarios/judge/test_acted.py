"""Promises that came to nothing fail a run: commands, places, ground that no foot met, pushes cut off."""

import pytest

import surefoot
from surefoot.scenarios.judge.verdict import judge
from surefoot.scenarios.run.simulation import Simulation

POINT = {"fidelity": "pendulum", "criteria": {"fell": False}, "gait.initial_stand": 0.1}


def reasons(tmp_path, **keys):
    return surefoot.run(surefoot.load("walk-level", {**POINT, **keys}), out=tmp_path).verdict.reasons


@pytest.mark.unit
@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"gait.steps": 0, "commands": [{"time": 0.5, "swing_height": 0.08}]}, "commands.0.swing_height never acted"),
        (
            {"gait.steps": 0, "commands": [{"time": 0.5, "place": {"x": 0.0, "y": 0.0}}]},
            "commands.0.place never acted: the robot stood for as long as it held",
        ),
        (
            {
                "gait.steps": 0,
                "faults": [{"kind": "planner_freeze", "time": 0.4}],
                "commands": [{"time": 0.5, "v_x": 0.1}],
            },
            "commands.0 came at 0.5 s and never acted: no plan was made after it",
        ),
        (
            {"gait.waypoints": [{"x": 1.0, "y": 0.0}, {"x": 0.0, "y": 0.0}], "duration": 0.1},
            "never came to 1 of its waypoints",
        ),
    ],
)
def test_it_is_no_pass(tmp_path, keys, words):
    (reason,) = reasons(tmp_path, **{"duration": 1.0, **keys})
    assert words in reason


@pytest.mark.unit
def test_a_place_with_another_heading_is_not_reached(tmp_path):
    place = {"time": 0.5, "place": {"x": 0.2, "y": 0.0, "yaw": 0.0}}
    keys = {"gait.steps": 0, "duration": 8.0}
    assert reasons(tmp_path, commands=[place], **keys) == ()
    turned = {"time": 0.5, "place": {"x": 0.2, "y": 0.0, "yaw": 3.0}}
    found = reasons(tmp_path, commands=[turned], **{**keys, "duration": 2.5})
    assert any("rad from where it was commanded to go last; it must be within 0.02 rad" in reason for reason in found)


@pytest.mark.unit
def test_a_push_at_a_step_that_comes_late_is_cut_off(tmp_path):
    """The first step of this walk comes when it is told to walk, which the scenario cannot know before."""
    push = {"step": 1, "phase": "single", "fraction": 0.0, "duration": 0.5, "force": [5.0, 0.0, 0.0]}
    keys = {"gait.steps": 0, "commands": [{"time": 0.5, "v_x": 0.1}], "pushes": [push]}
    assert reasons(tmp_path, duration=2.0, **keys) == ()
    (reason,) = reasons(tmp_path, duration=1.0, **keys)
    assert "would have lasted 0.5 s and was cut off" in reason


@pytest.mark.unit
def test_what_is_given_by_hand_is_no_promise_and_its_log_runs_again(tmp_path, same_content):
    keys = {**POINT, "gait.steps": 0, "duration": 1.0}
    path = tmp_path / "driven.mcap"
    with Simulation(surefoot.load("walk-level", keys), log=path) as sim:
        while not sim.done:
            if sim.time == 0.5:
                sim.command(swing_height=0.08)
            if sim.time == 0.95:
                sim.push((5.0, 0.0, 0.0))
            if sim.time == 0.99:
                sim.command(0.1)
            sim.step()
    assert surefoot.judge(surefoot.read(path)).passed
    again = surefoot.run(path, out=tmp_path / "again")
    assert again.verdict.passed, again.verdict.reasons
    assert same_content(path, again.log) == []


@pytest.mark.physics
def test_ground_that_no_foot_meets_is_no_test(tmp_path):
    near, far = ({"x": x, "length": 0.3, "height": 0.004} for x in (0.35, 9.0))
    keys = {"fidelity": "full", "gait.steps": 2, "duration": 3.0}
    (reason,) = reasons(tmp_path, **keys, **{"errors.ground": [near, far]})
    assert reason == "errors.ground.1 never acted: no foot came upon ground that is not as believed"
    assert reasons(tmp_path, **keys, **{"errors.ground_noise": 0.003}) == ()
    standing = {"fidelity": "full", "gait.steps": 0, "duration": 0.5}
    (reason,) = reasons(tmp_path, **standing, **{"errors.ground_noise": 0.003})
    assert reason.startswith("errors.ground_noise never acted")


@pytest.mark.unit
@pytest.mark.parametrize(("v_x", "bent"), [(9.9, True), (0.2, False)])
def test_a_velocity_that_is_bent_to_what_is_possible_is_told(tmp_path, v_x, bent):
    keys = {"gait.steps": 0, "duration": 3.0, "commands": [{"time": 0.5, "v_x": v_x}, {"time": 2.0, "v_x": 0.0}]}
    verdict = surefoot.run(surefoot.load("walk-level", {**POINT, **keys}), out=tmp_path).verdict
    assert verdict.passed
    told = [note for note in verdict.notes if "out of reach" in note]
    assert bool(told) == bent
    assert all(
        "1 of 2, the first at 0.5 s from v_x 9.9 m/s, v_y 0 m/s, yaw_rate 0 rad/s to v_x 0." in one for one in told
    )


@pytest.mark.unit
def test_a_velocity_that_is_told_by_hand_and_bent_is_told_too(tmp_path):
    scenario = surefoot.load("walk-level", {**POINT, "gait.steps": 0, "duration": 1.0})
    with surefoot.Simulation(scenario, log=tmp_path / "told.mcap") as sim:
        sim.command(v_x=3.0, yaw_rate=1.0)
        while not sim.done:
            sim.advance()
    (note,) = [note for note in judge(surefoot.read(tmp_path / "told.mcap")).notes if "out of reach" in note]
    assert "1 of 1, the first at 0 s from v_x 3 m/s, v_y 0 m/s, yaw_rate 1 rad/s to v_x" in note
