"""A plant that says what no robot can ends the run as a fault, with an end in the log and no warning of numpy."""

import threading

import numpy as np
import pytest

import surefoot
from surefoot.apps.bridge import serve
from surefoot.apps.bridge.frames import Kind, connected
from surefoot.apps.bridge.host import Care, Host
from surefoot.apps.bridge.line import Disturbance
from surefoot.apps.bridge.messages import (
    Start,
    command_bytes,
    json_bytes,
    low_state,
    start_bytes,
    state_bytes,
)
from surefoot.apps.bridge.remote import Remote
from surefoot.apps.bridge.walk import walk_on
from surefoot.joints import JointCommand, Servo
from surefoot.scenarios.run.planning import RunFault
from surefoot.scenarios.run.plant import measured_tick
from surefoot.scenarios.setup.walk import resolve

pytestmark = [pytest.mark.unit, pytest.mark.filterwarnings("error::RuntimeWarning")]

KEYS = {"gait.steps": 0, "duration": 0.04, "sensing.source": "truth", "criteria": {"fell": False}}
AT = 7
"""Tick of the state that is wrong."""


@pytest.fixture(name="walked")
def walked_fixture(tmp_path, monkeypatch):
    """A walk on a plant, one of whose states has other fields."""

    def walk(care=None, **wrong):
        walk = resolve(surefoot.load("walk-level", KEYS))
        layout = low_state(len(walk.robot.joint_names))

        def changed(state):
            message = np.frombuffer(state_bytes(state), layout).copy()
            for name, value in wrong.items() if state.tick == AT else ():
                message[name] = value
            return message.tobytes()

        monkeypatch.setattr(serve, "state_bytes", changed)
        server = serve.Server(Host(walk, care or Care()), "127.0.0.1", 0, lambda said: None)
        serving = threading.Thread(target=server.run, args=(lambda: False,))
        serving.start()
        result = walk_on(Remote(server.address, {}), walk.keys, tmp_path)
        serving.join(10.0)
        return result

    return walk


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"tick": -1, "cmd_tick": -1}, "has measured at control tick -1, where 7 is due"),
        ({"tick": AT - 1}, "has measured at control tick 6, where 7 is due"),
        ({"tick": 2**62}, "where 7 is due"),
        ({"cmd_tick": 2**62}, "a state of tick 7 with a command in force that answers tick 4611686018427387904"),
        ({"time": np.nan}, "a state whose numbers are not finite"),
        ({"true_q": np.nan}, "a state whose numbers are not finite"),
        ({"velocity": 1e308}, "a state with a number of the size 1e+308; none may be over 1e+09"),
        ({"true_wrench": np.inf}, "a state with a number of the size inf"),
        ({"configuration": 0.0}, "a state whose base has no attitude"),
    ],
)
@pytest.mark.parametrize("care", [None, Care(Disturbance(delay=0.002))], ids=["lockstep", "late"])
def test_a_state_that_cannot_be_ends_the_run_in_order(walked, wrong, said, care):
    result = walked(care, **wrong)
    (reason,) = result.verdict.reasons
    assert reason.startswith("the run ended at 0.014000 s: the plant") and said in reason
    assert surefoot.read(result.log).metadata["end"]["kind"] == "fault"
    assert not any("Error" in note for note in result.verdict.notes)


def test_what_a_plant_need_not_know_is_taken(walked):
    unknown = dict.fromkeys(("true_tau", "true_wrench", "true_accelerometer", "true_external_force"), np.nan)
    assert walked(**unknown).verdict.passed


def test_ticks_may_be_missed_within_reach_and_never_come_again():
    assert [measured_tick(tick, 50, 500) for tick in (50, 51, 5050)] == [50, 51, 5050]
    for tick in (-1, 49, 5051):
        with pytest.raises(RunFault, match=f"control tick {tick}, where 50 is due"):
            measured_tick(tick, 50, 500)


@pytest.mark.parametrize(
    ("changed", "tick", "said"),
    [
        ({"torque": 1e308}, 0, "a command with a number of the size 1e+308"),
        ({"position": -1e308}, 0, "a command with a number of the size 1e+308"),
        ({"stiffness": 1e308}, 0, "a command with a number of the size 1e+308"),
        ({"damping": np.inf}, 0, "a command whose numbers are not finite"),
        ({}, 2**40, "a command that answers the state of tick 1099511627776, where 0 is the last"),
    ],
)
def test_a_command_that_cannot_be_is_refused_without_a_warning(changed, tick, said):
    walk = resolve(surefoot.load("walk-level", KEYS))
    n, ends = len(walk.robot.joint_names), []
    server = serve.Server(Host(walk, Care()), "127.0.0.1", 0, lambda said: None)
    serving = threading.Thread(target=lambda: ends.append(server.run(lambda: False)))
    serving.start()
    numbers = {name: np.full(n, changed.get(name, 1.0)) for name in ("torque", "position", "stiffness", "damping")}
    servo = Servo(numbers["position"], np.zeros(n), numbers["stiffness"], numbers["damping"])
    link = connected(server.address, 10.0)
    q = np.concatenate(([0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0], np.zeros(n)))
    for kind, payload in (
        (Kind.HELLO, json_bytes({})),
        (Kind.RESET, start_bytes(Start(q, np.zeros(6 + n), np.zeros(n), senses=False))),
        (Kind.COMMAND, command_bytes(tick, JointCommand(numbers["torque"], servo))),
    ):
        link.send(kind, payload, 10.0)
        assert link.receive(10.0) is not None
    serving.join(10.0)
    link.close()
    assert said in ends[0].said
