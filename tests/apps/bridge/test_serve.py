"""A controller that says that it ends is heard, whatever it has left unread or said twice before it was gone."""

import threading
import time
from contextlib import closing

import numpy as np
import pytest

import surefoot
from surefoot.apps.bridge.frames import Kind, connected
from surefoot.apps.bridge.host import Care, Host
from surefoot.apps.bridge.messages import Start, command_bytes, end_bytes, json_bytes, start_bytes
from surefoot.apps.bridge.remote import Remote
from surefoot.apps.bridge.serve import MOST_LATE, Server
from surefoot.apps.bridge.walk import walk_on
from surefoot.joints import JointCommand
from surefoot.scenarios.judge.metric import metric
from surefoot.scenarios.judge.metrics import METRICS, register
from surefoot.scenarios.setup.walk import resolve

pytestmark = pytest.mark.unit

PATIENCE = 10.0
COMMANDS = 3
"""Number of commands of a controller that is ended while it sends; the plant answers each, and nobody reads."""


@pytest.fixture(name="walk", scope="module")
def walk_fixture():
    return resolve(surefoot.load("walk-level", {"gait.steps": 1}))


def served(walk, *last, plant=Host, real_time=False, after=0.0, stays=False):
    """The end of serving a controller that sends commands, after a while [s] these frames, and is gone or stays."""
    n = len(walk.robot.joint_names)
    server = Server(plant(walk, Care()), "127.0.0.1", 0, lambda said: None, real_time)
    ends = []
    serving = threading.Thread(target=lambda: ends.append(server.run(lambda: False)))
    serving.start()
    with closing(connected(server.address, PATIENCE)) as link:
        link.send(Kind.HELLO, json_bytes({}), PATIENCE)
        assert link.receive(PATIENCE).kind is Kind.WELCOME
        q = np.concatenate(([0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0], np.zeros(n)))
        link.send(Kind.RESET, start_bytes(Start(q, np.zeros(6 + n), np.zeros(n), senses=False)), PATIENCE)
        assert link.receive(PATIENCE).kind is Kind.STATE
        for _ in range(COMMANDS):
            link.send(Kind.COMMAND, command_bytes(0, JointCommand(np.zeros(n))), PATIENCE)
        time.sleep(after)
        for kind, payload in last:
            link.send(kind, payload, PATIENCE)
        if stays:
            serving.join(PATIENCE)
    serving.join(PATIENCE)
    return ends[0]


END = Kind.END, end_bytes("interrupted")


def test_an_end_is_heard_over_a_connection_that_is_closed_already(walk):
    end = served(walk, END)
    assert (end.in_order, end.said, end.late) == (True, "interrupted", 0.0)


def test_without_an_end_the_joints_are_damped(walk):
    end = served(walk)
    assert not end.in_order
    assert "has closed the connection" in end.said
    assert end.time >= 1.0  # the robot is simulated until it is down


def test_an_end_after_a_command_that_nobody_may_obey_is_no_end_in_order(walk):
    wrong = command_bytes(1, JointCommand(np.full(len(walk.robot.joint_names), np.nan)))
    end = served(walk, (Kind.COMMAND, wrong), END, stays=True)
    assert not end.in_order
    assert "a command whose numbers are not finite" in end.said


def test_a_plant_is_told_that_the_walk_is_over_before_the_log_is_judged(tmp_path):
    """Its joints would be damped meanwhile by the wall clock."""
    scenario = surefoot.load("stand", {"duration": 0.05, "criteria": {}})
    server = Server(Host(resolve(scenario), Care()), "127.0.0.1", 0, lambda said: None)
    ends = []
    serving = threading.Thread(target=lambda: ends.append(server.run(lambda: False)))
    serving.start()

    @metric()
    def still_served(run):
        """Truth of whether the plant is still served while the log is judged."""
        serving.join(PATIENCE)
        return serving.is_alive()

    register(still_served)
    try:
        verdict = walk_on(Remote(server.address, {}), scenario, tmp_path).verdict
    finally:
        METRICS.discard("still_served")
    assert verdict.passed and verdict["still_served"] is False
    (end,) = ends
    assert (end.in_order, end.said, end.time) == (True, "the walk is over", 0.05)


def test_a_plant_that_is_slower_than_the_wall_clock_says_by_how_much_and_does_not_catch_up(walk):
    slow = 2.0 * MOST_LATE

    class Slow(Host):
        def advance(self):
            time.sleep(slow)
            super().advance()

    end = served(walk, END, plant=Slow, real_time=True, after=0.5)
    ticks = round(end.time * walk.rates.control)
    assert end.in_order and 0 < ticks <= 0.5 / slow + 1.0
    assert end.late > (ticks - 1) * (slow - 1.0 / walk.rates.control) - MOST_LATE
