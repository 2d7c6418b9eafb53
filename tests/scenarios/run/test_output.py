"""Targets in place of torques: what the drives make of them is what was planned, and the robot walks on them."""

import numpy as np
import pytest

import surefoot
from surefoot.scenarios.file.control import ControlSettings
from surefoot.scenarios.log import NoLog
from surefoot.scenarios.run.output import Output
from surefoot.scenarios.run.run import closed_loop
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.walk import resolve
from surefoot.similarity import Similarity

pytestmark = pytest.mark.unit

G1 = {"robot": "g1", "sized_for": "humanoid100"}
POSITION = {"output": "position", "output_rate": 50}


@pytest.fixture(scope="module")
def robot():
    return resolve(load("walk-level")).robot


def moved(robot, rng):
    joints = len(robot.joint_names)
    return [scale * rng.standard_normal(joints) for scale in (40.0, 0.3, 1.0, 8.0)]


@pytest.mark.parametrize("feed_forward", [True, False])
def test_a_joint_that_moves_as_planned_gets_the_planned_torque_in_the_mean(robot, feed_forward):
    output = Output(ControlSettings(**POSITION, feed_forward=feed_forward), robot, Similarity(), 500)
    torque, q, v, a = moved(robot, np.random.default_rng(4))
    command = output.command(torque, q, v, a)
    times = (np.arange(2000) + 0.5) / 2000 * output.period
    given = [command.torque_at(q + t * v + 0.5 * t * t * a, v + t * a) for t in times]
    assert np.mean(given, axis=0) == pytest.approx(torque, abs=1e-6)
    # A target of the begin of the period would give another one.
    late = surefoot.JointCommand(command.torque, surefoot.Servo(q, v, command.servo.stiffness, command.servo.damping))
    missed = np.mean([late.torque_at(q + t * v + 0.5 * t * t * a, v + t * a) for t in times], axis=0)
    assert np.abs(missed - torque).max() > 1.0


def test_what_is_folded_into_the_position_is_the_same_command(robot):
    torque, q, v, a = moved(robot, np.random.default_rng(5))
    apart, folded = (
        Output(ControlSettings(**POSITION, feed_forward=feed), robot, Similarity(), 500).command(torque, q, v, a)
        for feed in (True, False)
    )
    assert folded.torque_at(q, v) == pytest.approx(apart.torque_at(q, v))
    assert not folded.torque.any() and not folded.servo.velocity.any()


def test_gains_are_those_of_the_last_pattern_that_matches(robot):
    keys = ControlSettings(output="position", gains={".*": (50.0, 1.0), ".*knee.*": (300.0, 4.0)})
    servo = Output(keys, robot, Similarity(), 500).command(*moved(robot, np.random.default_rng(6))).servo
    for name, stiffness, damping in zip(robot.joint_names, servo.stiffness, servo.damping, strict=True):
        assert (stiffness, damping) == ((300.0, 4.0) if "knee" in name else (50.0, 1.0))


@pytest.mark.parametrize(
    ("keys", "told"),
    [
        ({"stiffness": 2.0}, "control.stiffness of an output that is torque"),
        ({"output_rate": 600}, "control.output_rate 600 Hz is more than rates.control 500 Hz"),
        ({"output": "position", "gains": {"no_such": [1.0, 1.0]}}, "no joint is called 'no_such'"),
        ({"output": "position", "gains": {"(": [1.0, 1.0]}}, "is no regular expression"),
        ({"output": "position", "stiffness": 0.0, "feed_forward": False}, "joints without stiffness"),
    ],
)
def test_what_does_not_fit_is_refused(keys, told):
    with pytest.raises(surefoot.SetupError, match=told.replace("(", r"\(")):
        closed_loop(resolve(load("walk-level", {"control": keys})), NoLog())
    with pytest.raises(surefoot.ParameterError, match=told.replace("(", r"\(")):
        surefoot.Controller("humanoid100", "walk-level", control=keys)


def test_a_controller_takes_the_keys_of_a_scenario():
    with pytest.raises(surefoot.ParameterError, match=r"control\.output 'force'"):
        surefoot.Controller("humanoid100", "walk-level", control={"output": "force"})
    made = surefoot.Controller("g1", "walk-level", control=POSITION)
    assert made.walk.control == ControlSettings(**POSITION)


@pytest.mark.parametrize("robot", [{}, G1], ids=["humanoid100", "g1"])
def test_targets_at_fifty_hertz_walk_and_are_held_in_between(robot):
    with surefoot.Simulation(load("walk-level", {**robot, "gait.steps": 2, "control": POSITION})) as simulation:
        reports = set()
        while not simulation.done:
            reports.add(simulation.step().report.torque.tobytes())
        assert simulation.end.kind == "completed"
        assert len(reports) <= 50 * simulation.time + 2


def test_torques_may_be_held_as_well():
    keys = {"gait.steps": 1, "control": {"output_rate": 250}}
    with surefoot.Simulation(load("walk-level", keys)) as simulation:
        while not simulation.done:
            simulation.advance()
        assert simulation.end.kind == "completed"
