"""A simulation goes on from its saved state as it went on before, to the bit."""

import pickle
import socket

import numpy as np
import pytest
from needs import POLICY

import surefoot
from surefoot.scenarios.run.processes import processes
from surefoot.scenarios.run.saved import State
from surefoot.wbc.types import RobotState

pytestmark = pytest.mark.physics

TRUTH, GOOD = {"sensing": {"source": "truth"}}, {"sensing": {"source": "ekf", "preset": "good"}}
PUSHED = {"pushes": [{"time": 1.55, "duration": 0.1, "impulse": 0.35}]}

WALKS = {
    "truth": ("walk-level", {**TRUTH, "robot": "humanoid100"}, 1.7),
    "sensors, in a push": ("walk-level", {**GOOD, **PUSHED, "robot": "humanoid100"}, 1.6),
    "g1, sensors, in a push": ("walk-level", {**GOOD, **PUSHED, "robot": "g1"}, 1.6),
    "g1, truth, before a push in a swing": ("walk-level", {**TRUTH, **PUSHED, "robot": "g1"}, 1.4),
    "motors, position commands": (
        "walk-level",
        {**GOOD, "robot": "humanoid100", "motors": {"delay": 0.004}, "control": {"output": "position"}},
        1.6,
    ),
    "before the first tick": ("walk-level", {**GOOD, "robot": "g1"}, 0.0),
    "pendulum": ("walk-level", {"fidelity": "pendulum", "sensing": {"zmp_noise": 0.01}}, 1.6),
}
GOES_ON = 0.6
"""Time for which it goes on [s]."""


def at(scenario, time, **parts):
    """A simulation that has come to a time [s]."""
    sim = surefoot.Simulation(scenario, **parts)
    while sim.time < time:
        sim.advance()
    return sim


def goes_on(sim, ticks=None):
    """Bits of the ticks that come: the state, what the sensors said, what was commanded and planned."""
    found = []
    for _ in range(ticks or round(GOES_ON * sim.walk.rates.control)):
        if sim.done:
            break
        tick = sim.step()
        values = [tick.com, tick.com_velocity, tick.zmp]
        if tick.measurement is not None:
            m = tick.measurement
            values += [m.q, m.v, m.wrench, m.joint_torque, m.external_force]
        if tick.state is not None:
            values += [tick.state.q, tick.state.v]
        if tick.report is not None:
            values += [tick.report.torque, tick.report.wrench]
        if tick.planned is not None:
            values += [tick.plan.com, tick.plan.zmp]
        found.append((tick.time, *(np.asarray(value).tobytes() for value in values)))
    return found


def loaded(name):
    scenario, keys, time = WALKS[name]
    return surefoot.load(scenario, keys), time


@pytest.mark.parametrize("name", WALKS)
def test_it_goes_on_to_the_bit_here_and_elsewhere(name):
    scenario, time = loaded(name)
    with at(scenario, time) as sim:
        state = sim.save()
        told = pickle.dumps(state)
        went = goes_on(sim)
        assert len(set(went)) == len(went) > 100
        sim.restore(state)
        assert sim.time == pytest.approx(time, abs=2e-3)
        sim.command(v_x=0.1) if name == "pendulum" else sim.push((5.0, 0.0, 0.0))
        other = goes_on(sim)
        assert other != went  # it is looked at what differs
        sim.restore(state)
        assert goes_on(sim) == went
        if not sim.done:
            sim.reset()
        sim.restore(state)
        assert goes_on(sim) == went
        sim.restore(pickle.loads(told))
        assert goes_on(sim) == went
    with at(scenario, 0.0 if "truth" in name else 0.4) as fresh:
        fresh.restore(pickle.loads(told))
        assert goes_on(fresh) == went
        fresh.restore(state)
        assert goes_on(fresh) == went


def go_on_from(scenario, told):
    with surefoot.Simulation(scenario) as sim:
        sim.restore(pickle.loads(told))
        return goes_on(sim)


def test_it_goes_on_in_a_spawned_process():
    scenario, time = loaded("g1, sensors, in a push")
    with at(scenario, time) as sim:
        told, went = pickle.dumps(sim.save()), goes_on(sim)
    with processes() as pool:
        assert pool.submit(go_on_from, scenario, told).result(timeout=300) == went


@pytest.mark.parametrize("form", ["stander", "framed", "leapp"])
def test_a_policy_goes_on_too(form, tmp_path):
    """With its history, and the state that its network hands to itself."""
    POLICY.or_skip()
    import policies

    robot = "humanoid100" if form == "stander" else "g1"
    made = policies.stander(tmp_path / form, robot) if form == "stander" else getattr(policies, form)(tmp_path / form)
    keys = {
        "robot": robot, "duration": 2.0, "gait.steps": 0, "controller": {"policy": str(made)},
        "criteria": {"fell": False}, "sensing": {"preset": "good"}, **PUSHED,
    }  # fmt: skip
    scenario = surefoot.load("stand", keys)
    with at(scenario, 1.6) as sim, surefoot.Simulation(scenario) as other:
        state = sim.save()
        went = goes_on(sim, 150)
        sim.restore(state)
        assert goes_on(sim, 150) == went
        other.restore(pickle.loads(pickle.dumps(state)))
        assert goes_on(other, 150) == went


class Counting:
    """Joints by their encoders, and a height that it forgets every tenth tick; of others."""

    is_truth = False

    def __init__(self, walk):
        self.ticks, self.kept = 0, []

    def estimate(self, measurement):
        self.ticks += 1
        self.kept.append(measurement.time)
        q = measurement.q.copy()
        q[2] -= 1e-4 * (self.ticks % 10)
        return RobotState(q, measurement.v.copy())


class Connected(Counting):
    """The same, over a line."""

    def __init__(self, walk):
        super().__init__(walk)
        self.line = socket.socket()


def test_a_part_of_others_goes_on_and_one_that_nobody_knows_is_refused():
    scenario, _ = loaded("truth")
    with at(scenario, 0.55, estimator=Counting) as sim:
        state, went = sim.save(), goes_on(sim, 64)
        sim.restore(state)
        assert goes_on(sim, 64) == went
        with at(scenario, 0.1, estimator=Counting) as other:
            other.restore(pickle.loads(pickle.dumps(state)))
            assert goes_on(other, 64) == went
        with surefoot.Simulation(scenario) as plain, pytest.raises(surefoot.ParameterError, match="set of parts"):
            plain.restore(state)
    with at(scenario, 0.01, estimator=Connected) as sim, pytest.raises(surefoot.ParameterError) as refused:
        sim.save()
    assert "the state of a socket.socket, which nobody knows" in str(refused.value)
    assert str(refused.value).count("\n") == 0


def test_a_state_of_something_else_is_refused_and_nothing_changes(tmp_path):
    scenario, time = loaded("truth")
    with at(scenario, time) as sim:
        state = sim.save()
        assert isinstance(state, State) and repr(state) == f"<State after the tick at {state.time:.3f} s>"
        for keys in ({"seed": 7}, {"robot": "g1"}, {"gait.steps": 3}):
            with surefoot.Simulation(surefoot.load("walk-level", {**WALKS["truth"][1], **keys})) as other:
                before = goes_on(other, 5)
                with pytest.raises(surefoot.ParameterError, match="a state of another scenario"):
                    other.restore(state)
                other.reset()
                assert goes_on(other, 5) == before
        with surefoot.Simulation(scenario, log=tmp_path / "log.mcap") as logged:
            logged.advance()
            kept = logged.save()
            with pytest.raises(surefoot.LogError, match="one run in order"):
                logged.restore(state)
            went = goes_on(logged, 20)
        sim.restore(pickle.loads(pickle.dumps(kept)))
        assert goes_on(sim, 20) == went
