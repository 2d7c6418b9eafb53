"""A simulation from outside: the same walk as `run` makes, pushes that act as scheduled ones do, parts of one's own."""

import numpy as np
import pytest

import surefoot
from surefoot.planner.laws.law import Motion
from surefoot.planner.laws.profiles import PROFILES, Profile
from surefoot.scenarios.log import NoLog
from surefoot.scenarios.run.run import closed_loop
from surefoot.scenarios.run.sensing import TrueState
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.walk import resolve
from surefoot.wbc.controller import WholeBodyController
from surefoot.wbc.types import RobotState

pytestmark = pytest.mark.unit

BRIEF = {"duration": 0.6, "gait.initial_stand": 0.1, "gait.single_support": 0.4, "gait.double_support": 0.1}
FORCE = (30.0, -20.0, 0.0)


@pytest.fixture(scope="module")
def scenario():
    return surefoot.load("walk-level", BRIEF)


def stepped(scenario, log, push_at=None, **parts):
    with surefoot.Simulation(scenario, log=log, **parts) as sim:
        while not sim.done:
            if push_at is not None and sim.time == push_at:
                sim.push(FORCE, duration=0.05)
            sim.step()
    return log


@pytest.mark.parametrize("fidelity", ["full", "pendulum"])
def test_a_stepped_walk_is_the_walk_that_run_makes(fidelity, tmp_path, same_content):
    scenario = surefoot.load("walk-level", {**BRIEF, "fidelity": fidelity})
    made = surefoot.run(scenario, out=tmp_path)
    assert same_content(stepped(scenario, tmp_path / "stepped.mcap"), made.log) == []
    assert surefoot.judge(surefoot.read(tmp_path / "stepped.mcap")).metrics["duration"] == pytest.approx(0.6)


@pytest.mark.parametrize(("fidelity", "topic"), [("full", "/measurement"), ("pendulum", "/truth")])
def test_the_logged_forces_add_up_to_the_impulse_of_pushes_shorter_than_a_tick(fidelity, topic, tmp_path):
    """3 N s in 1 ms that begins within a tick of 4 ms, and 5.5 ms given on the way."""
    push = {"time": 0.0511, "duration": 0.001, "force": (3000.0, 0.0, 0.0)}
    rates = {"rates.control": 250, "duration": 0.15}
    scenario = surefoot.load("walk-level", {**BRIEF, **rates, "fidelity": fidelity, "pushes": [push]})
    with surefoot.Simulation(scenario, log=tmp_path / "pushed.mcap") as sim:
        while not sim.done:
            if sim.time == 0.1:
                sim.push((0.0, 40.0, 0.0), duration=0.0055)
            sim.step()
    force = surefoot.read(tmp_path / "pushed.mcap")[topic].field("external_force")
    np.testing.assert_allclose(force.sum(axis=0) / 250, [3.0, 0.22, 0.0], rtol=1e-9)


@pytest.mark.parametrize("fidelity", ["full", "pendulum"])
def test_a_push_from_outside_acts_and_is_logged_as_a_scheduled_one(fidelity, tmp_path, same_content):
    scenario = surefoot.load("walk-level", {**BRIEF, "fidelity": fidelity})
    log = stepped(scenario, tmp_path / "pushed.mcap", push_at=0.3)
    scheduled = surefoot.load("walk-level", {
        **BRIEF, "fidelity": fidelity, "pushes": [{"time": 0.3, "duration": 0.05, "force": FORCE}],
    })  # fmt: skip
    assert same_content(log, surefoot.run(scheduled, out=tmp_path).log) == []
    assert same_content(log, stepped(scenario, tmp_path / "calm.mcap")) != []
    again = surefoot.load(log)
    assert [(push.time, push.duration, push.force) for push in again.pushes] == [(0.3, 0.05, FORCE)]
    assert same_content(log, surefoot.run(again, out=tmp_path / "again").log) == []


def test_a_tick_keeps_what_it_saw(scenario):
    with surefoot.Simulation(scenario) as sim:
        first = sim.step()
        q, torque = first.state.q.copy(), first.report.torque.copy()
        for _ in range(100):
            last = sim.step()
        np.testing.assert_array_equal(first.state.q, q)
        np.testing.assert_array_equal(first.report.torque, torque)
        assert last.time == pytest.approx(0.2)
        assert not np.array_equal(last.state.q, q)
        assert "single support" in repr(last) or "double support" in repr(last) or "standing" in repr(last)
        assert last.report.wrench[:, 2].sum() == pytest.approx(981.0, rel=0.2)


def test_it_begins_anew_and_ends_once(scenario):
    sim = surefoot.Simulation(scenario)
    first = sim.step()
    for _ in range(50):
        sim.step()
    sim.reset()
    np.testing.assert_array_equal(sim.step().state.q, first.state.q)
    while not sim.done:
        sim.step()
    assert sim.end.kind == "completed"
    with pytest.raises(surefoot.RunFault, match=r"over at 0\.600 s, completed"):
        sim.step()
    sim.close()
    sim.close()


def test_a_log_holds_one_run_and_replaces_none(scenario, tmp_path):
    path = tmp_path / "one.mcap"
    with surefoot.Simulation(scenario, log=path) as sim:
        sim.step()
        with pytest.raises(surefoot.LogError, match="holds one run"):
            sim.reset()
    log = surefoot.read(path)
    assert log.metadata["end"]["kind"] == "interrupted"
    with pytest.raises(surefoot.LogError, match="exists already"):
        surefoot.Simulation(scenario, log=path)
    assert not surefoot.judge(log).passed


@pytest.mark.parametrize(
    ("push", "message"),
    [
        (((1.0, 2.0),), "three finite numbers"),
        (((1.0, 2.0, np.nan),), "three finite numbers"),
        ((FORCE, 0.0), "more than 0 s"),
        ((FORCE, 0.1, "tors"), "did you mean 'torso'"),
    ],
)
def test_an_impossible_push_is_refused(scenario, push, message):
    with surefoot.Simulation(scenario) as sim, pytest.raises(surefoot.ParameterError, match=message):
        sim.push(*push)


def test_a_vertical_push_means_nothing_to_a_pendulum():
    pendulum = surefoot.Simulation(surefoot.load("walk-level", {**BRIEF, "fidelity": "pendulum"}))
    with pendulum as sim, pytest.raises(surefoot.ParameterError, match="vertical push"):
        sim.push((0.0, 0.0, 1.0))


class Leaning(TrueState):
    """Believes that the base is 5 mm farther ahead than it is."""

    is_truth = False

    def estimate(self, measurement):
        q = measurement.q.copy()
        q[0] += 0.005
        return RobotState(q, measurement.v)


def test_an_estimator_of_ones_own_gives_the_state_and_the_truth_stays_in_the_log(scenario, tmp_path):
    log = surefoot.read(stepped(scenario, tmp_path / "leaning.mcap", estimator=Leaning))
    base = log["/estimate"].field("base_position")[:, 0] - log["/truth"].field("q")[:, 0]
    np.testing.assert_allclose(base, 0.005, atol=1e-12)
    com = log["/estimate"].field("com")[:, 0] - log["/truth"].field("com")[:, 0]
    np.testing.assert_allclose(com, 0.005, atol=1e-9)


def test_a_controller_of_ones_own_is_asked(scenario):
    class Slack:
        """Gives no torque."""

        def __init__(self, *given, **named):
            self.inner = WholeBodyController(*given, **named)

        def __getattr__(self, name):
            return getattr(self.inner, name)

        def update(self, *arguments):
            report = self.inner.update(*arguments)
            report.torque[:] = 0.0
            return report

    with surefoot.Simulation(scenario, controller=Slack) as sim:
        while not sim.done:
            sim.step()
    assert sim.fell


class Lazy:
    """A law that never moves the CoM."""

    def __init__(self, parameters, com_height):
        self.horizon = parameters.horizon

    def plan(self, problem):
        return Motion(np.zeros((self.horizon, 2)), np.zeros((2, 2)), np.zeros(2), np.zeros(2))


def test_a_law_of_ones_own_plans_and_its_log_cannot_be_run_again(scenario, tmp_path):
    lazy = Profile("lazy", "never moves the CoM", PROFILES["dcm"].parameters, Lazy, moves=False)
    path = tmp_path / "lazy.mcap"
    with surefoot.Simulation(scenario, log=path, planner=lazy) as sim:
        jerk = [np.abs(sim.step().plan.jerk).max() for _ in range(20)]
    assert max(jerk) == 0.0
    with pytest.raises(surefoot.ScenarioError, match="parts of its own"):
        surefoot.load(path)


def test_a_log_that_was_closed_is_walked_again_as_long_as_it_was(scenario, tmp_path, same_content):
    log = tmp_path / "closed.mcap"
    with surefoot.Simulation(scenario, log=log) as sim:
        for _ in range(100):
            sim.advance()
        assert sim.look().time == pytest.approx(99 / 500)
    again = surefoot.run(surefoot.load(str(log)), out=tmp_path)
    assert same_content(log, again.log) == []


@pytest.mark.parametrize("fidelity", ["full", "pendulum"])
def test_a_run_that_is_over_leaves_a_whole_log_though_nobody_closes_it(fidelity, tmp_path):
    short = surefoot.load("walk-level", {**BRIEF, "duration": 0.1, "fidelity": fidelity, "criteria": {"fell": False}})
    sim = surefoot.Simulation(short, log=tmp_path / "over.mcap")
    while not sim.done:
        sim.step()
    verdict = surefoot.judge(surefoot.read(tmp_path / "over.mcap"))
    assert (verdict.passed, verdict.reasons) == (True, ())
    for late in (lambda: sim.push((1.0, 0.0, 0.0)), lambda: sim.command(v_x=0.1), sim.step):
        with pytest.raises(surefoot.RunFault, match=r"the run is over at 0\.100 s, completed"):
            late()
    sim.close()
    sim.close()
    assert surefoot.judge(surefoot.read(tmp_path / "over.mcap")) == verdict


def test_a_part_that_leaves_ends_the_run_in_the_log_and_for_the_program(tmp_path):
    class Leaving(Lazy):
        def plan(self, problem):
            raise SystemExit

    profile = Profile("leaving", "leaves", PROFILES["default"].parameters, Leaving, moves=False)
    scenario = surefoot.load("walk-level", {**BRIEF, "fidelity": "pendulum"})
    sim = surefoot.Simulation(scenario, log=tmp_path / "left.mcap", planner=profile)
    with pytest.raises(surefoot.RunFault, match=r"profile 'leaving' of this program: SystemExit, .*\.py:\d+") as caught:
        sim.step()
    assert isinstance(caught.value.__cause__.__cause__, SystemExit)
    log = surefoot.read(tmp_path / "left.mcap")
    assert "SystemExit" in log.metadata["end"]["traceback"]
    assert not surefoot.judge(log).passed


def test_a_walk_whose_last_states_got_lost_ends_when_its_data_do(monkeypatch):
    loop = closed_loop(resolve(load("walk-level", {"fidelity": "pendulum", "duration": 0.1})), NoLog())
    sense, last = loop.walker.sense, round(loop.duration * loop.rate) - 1
    monkeypatch.setattr(loop.walker, "sense", lambda tick, now: sense(tick, now) + 2 * (tick == last))
    while not loop.done:
        loop.step()
    assert (loop.end.kind, loop.end.time) == ("completed", loop.time)
    assert loop.time == pytest.approx(0.1 + 2 / loop.rate)
