"""A plant and a controller in two processes: the same to the bit as in one; either may die, and strangers may knock."""

import signal
import socket

import numpy as np
import pytest

import surefoot
from surefoot.apps.bridge.frames import Kind, packed
from surefoot.apps.bridge.messages import json_bytes
from surefoot.scenarios.judge.inspection import inspect

pytestmark = pytest.mark.physics

SOON = ("--set", "gait.initial_stand=0.3")
SHORT = ("walk-level", *SOON, "--set", "gait.steps=1", "--set", "duration=1.6")
PUSHES = (
    "{step: 1, phase: single, fraction: 0.5, duration: 0.05, force: [0, 20, 0]}",
    "{time: 0.3, duration: 0.1, force: [20, 0, 0]}",
)
PUSHED = ("--set", f"pushes=[{', '.join(PUSHES)}]")
HARD = "{step: 1, phase: single, fraction: 0.5, duration: 0.1, impulse: 0.4, direction: 0.3}"
ROBOTS = {
    "humanoid100": (),
    "g1 by its sensors": ("--robot", "g1", "--set", "sensing.source=ekf", "--set", "sensing.preset=good"),
    "g1 that catches itself": ("--robot", "g1", "--set", f"pushes=[{HARD}]", "--set", "gait.steps=3"),
    "position targets": ("--set", "control.output=position", "--set", "control.output_rate=50"),
}


@pytest.mark.parametrize(
    "robot",
    [
        "humanoid100",
        pytest.param("position targets", marks=pytest.mark.long),
        "g1 by its sensors",
        "g1 that catches itself",
    ],
)
def test_two_processes_walk_as_one_to_the_bit(bridge, robot, same_content, tmp_path):
    plant = bridge.serve(*SHORT, *PUSHED, *ROBOTS[robot], "--seed", "3")
    controller = bridge.walk()
    _, verdict, said = bridge.result(controller)
    assert verdict["steps_taken"] >= 1, said
    assert bridge.end(plant)[0] == 0
    log = surefoot.read(tmp_path / verdict["log"])
    assert log["/measurement"].field("external_force").any()
    assert log.metadata["end"]["kind"] == "completed"
    alone = surefoot.run(str(log.path), out=tmp_path / "alone")
    assert same_content(log.path, alone.log) == []


def test_a_line_that_is_far_too_late_is_the_cause_of_the_fall(bridge, tmp_path):
    keys = ("--set", "sensing.source=truth", "--set", "gait.steps=6", *SOON)
    plant = bridge.serve("walk-level", *keys, "--delay", "0.06")
    _, verdict, said = bridge.result(bridge.walk())
    assert verdict["fell"], said
    bridge.end(plant)
    health = inspect(surefoot.read(tmp_path / verdict["log"])).health
    causes = [one for one in health if one.relation == "cause"]
    assert [one.check for one in causes] == ["late_commands"]
    assert "/link.command_age" in causes[0].cause


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGINT])
def test_a_controller_that_is_lost_is_let_down_gently(bridge, number):
    plant = bridge.serve("walk-level")
    controller = bridge.walk()
    bridge.under_way(controller)
    controller.send_signal(number)
    assert bridge.end(controller)[0] == {signal.SIGKILL: -9, signal.SIGINT: 130}[number]
    code, _, said = bridge.end(plant, timeout=60)
    if number is signal.SIGKILL:
        assert (code, "damped at" in said, "has closed the connection" in said) == (1, True, True), said
    else:
        assert (code, "ended at" in said, "interrupted" in said) == (0, True, True), said
    assert "Traceback" not in said


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
def test_a_plant_that_is_lost_ends_the_walk_in_order(bridge, number, tmp_path):
    plant = bridge.serve("walk-level")
    controller = bridge.walk()
    bridge.under_way(controller)
    plant.send_signal(number)
    assert bridge.end(plant)[0] == {signal.SIGKILL: -9, signal.SIGTERM: 143}[number]
    code, verdict, said = bridge.result(controller)
    assert (code, verdict["verdict"], "Traceback" in said) == (1, "fail", False), said
    lost = "the plant is lost" if number is signal.SIGKILL else "the plant was damped"
    assert any(lost in reason for reason in verdict["reasons"]), verdict["reasons"]
    log = surefoot.read(tmp_path / verdict["log"])
    assert list(log.damage) == []
    assert log.metadata["end"]["kind"] == "fault"
    assert len(log["/truth"]) > 10


def test_strangers_are_refused_while_it_walks_and_disturb_nothing(bridge, same_content, tmp_path):
    plant = bridge.serve(*SHORT)
    controller = bridge.walk()
    bridge.under_way(controller, 0)
    host, port = bridge.address.split(":")
    hello = packed(Kind.HELLO, json_bytes({}))
    strangers = [socket.create_connection((host, int(port))) for _ in range(12)]
    for number, stranger in enumerate(strangers):
        stranger.sendall((b"GET / HTTP/1.1\r\n\r\n", hello, b"\0" * 5000, hello[:5])[number % 4])
    _, verdict, said = bridge.result(controller)
    plant_code, _, told = bridge.end(plant)
    assert (plant_code, "steps_taken" in verdict) == (0, True), said
    assert told.count("refused 127.0.0.1:") >= 9
    for stranger in strangers:
        stranger.close()
    _, alone, _ = bridge.result(bridge.start("run", *SHORT, "--out", "alone", "--json"))
    assert same_content(tmp_path / verdict["log"], tmp_path / alone["log"]) == []


def test_another_robot_is_refused_by_either_side(bridge):
    plant = bridge.serve("--robot", "g1")
    code, _, said = bridge.end(bridge.walk("walk-level"))
    assert (code, "a controller of humanoid100, where the robot served is g1" in said) == (2, True), said
    assert len(said.splitlines()) == 1
    plant.send_signal(signal.SIGINT)
    assert bridge.end(plant)[0] == 130


def test_a_stranger_in_the_place_of_a_plant_is_refused(bridge):
    with socket.create_server(("127.0.0.1", 0)) as listener:
        bridge.address = f"127.0.0.1:{listener.getsockname()[1]}"
        controller = bridge.walk()
        connection, _ = listener.accept()
        connection.sendall(b"SSH-2.0-OpenSSH_9.6\r\n")
        code, _, said = bridge.end(controller)
        connection.close()
    assert (code, "is no message of surefoot" in said, len(said.splitlines())) == (2, True, 1), said


def test_what_cannot_be_served_is_said(bridge):
    for keys, said in (
        ("fidelity=pendulum", "a pendulum has no joints to be commanded"),
        ("control.driven_joints={'.*shoulder.*': [14, 0.9]}", "control.driven_joints"),
    ):
        code, out, told = bridge.end(bridge.start("serve", "walk-level", "--set", keys, "--port", "0"))
        assert (code, out, said in told, "Traceback" in told) == (2, "", True, False), told


SOFT = [word for key in ("output=position", "stiffness=0.3", "damping=0.02") for word in ("--set", f"control.{key}")]
LINES = {
    "torques, late, uneven and lost": ((), ("--delay", "0.01", "--jitter", "0.005", "--drop", "0.05")),
    "targets, and pauses": (
        ("--set", "control.output=position", "--set", "control.output_rate=50"),
        ("--delay", "0.01", "--jitter", "0.005", "--drop", "0.05", "--pause", "0.04"),
    ),
    "g1": (("--robot", "g1"), ("--delay", "0.01", "--jitter", "0.005", "--drop", "0.05")),
    "g1 by soft targets, and pauses": (
        ("--robot", "g1", *SOFT),
        ("--delay", "0.01", "--jitter", "0.005", "--drop", "0.05", "--pause", "0.04"),
    ),
}


@pytest.mark.parametrize(
    "name",
    [name if name in ("g1", "targets, and pauses") else pytest.param(name, marks=pytest.mark.long) for name in LINES],
)
def test_it_walks_over_a_line_that_is_late_and_loses_some(bridge, name, tmp_path):
    """With the true state: what readings of the IMU that get lost have said is told by no later one."""
    keys, how = LINES[name]
    plant = bridge.serve("walk-level", *SOON, "--set", "gait.steps=3", "--set", "sensing.source=truth", *keys, *how)
    _, verdict, said = bridge.result(bridge.walk())
    assert bridge.end(plant)[0] == 0
    assert (verdict["fell"], verdict["steps_taken"]) == (False, 3), said
    assert 0.008 < verdict["command_age"]["median"] < 0.02
    assert verdict["states_missed"] > 50
    log = surefoot.read(tmp_path / verdict["log"])
    gaps = np.diff(log["/truth"].time_ns) * 1e-9
    assert gaps.min() < gaps.max() < 0.2
    assert not log["/link"].field("damped").any()


def test_a_line_that_is_broken_for_longer_damps_the_joints_and_both_say_so(bridge):
    plant = bridge.serve("walk-level", "--delay", "0.15")
    code, verdict, _ = bridge.result(bridge.walk())
    assert (code, verdict["verdict"]) == (1, "fail")
    assert any("the plant was damped at 0.1" in reason for reason in verdict["reasons"]), verdict["reasons"]
    code, _, said = bridge.end(plant)
    assert (code, "no command answers a state of the last 0.150 s" in said) == (1, True), said


def test_a_plant_in_real_time_waits_for_nobody(bridge, tmp_path):
    keys = ("--set", "gait.steps=0", "--set", "duration=2", "--set", "sensing.source=truth")
    plant = bridge.serve("walk-level", *keys, "--real-time", "--watchdog", "30")
    _, verdict, said = bridge.result(bridge.walk())
    code, _, told = bridge.end(plant)
    assert (code, verdict["fell"]) == (0, False), told + said
    assert verdict["commands_missed"] is not None
    log = surefoot.read(tmp_path / verdict["log"])
    assert log.metadata["end"]["kind"] == "completed"
    assert log["/truth"].time_ns[-1] > 1.9e9
