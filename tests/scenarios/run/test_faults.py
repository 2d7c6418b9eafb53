"""Negative controls in full physics: what must fall falls, what cannot go on ends, each with its time and reason."""

import numpy as np
import pytest

import surefoot
from surefoot.scenarios.log import read
from surefoot.scenarios.run.planning import RunFault
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.load import load as load_scenario

pytestmark = pytest.mark.physics


@pytest.fixture
def run(tmp_path):
    def run(name, *overrides):
        result = run_scenario(load_scenario(name, overrides), tmp_path)
        return result.verdict, read(result.log)

    return run


def assert_fell(verdict, log, since):
    """The verdict says so, the log goes on for a while, and the robot's CoM is or goes down in it."""
    assert not verdict.passed
    assert verdict.metrics["fell"] is True
    assert f"fell is true at {verdict.metrics['fall_time']:.3f} s, must be false" in verdict.reasons
    assert since < verdict.metrics["fall_time"] < since + 4.0
    assert log.metadata["end"]["kind"] == "fall"
    assert float(log.metadata["end"]["time"]) == pytest.approx(verdict.metrics["fall_time"], abs=1e-9)
    assert verdict.metrics["duration"] == pytest.approx(verdict.metrics["fall_time"] + 0.3, abs=0.01)
    height = log["/truth"].field("com")[:, 2]
    assert height[-1] < 0.9 * height[0]


def test_without_torque_it_falls(run):
    assert_fell(*run("diagonal-walk", "faults=[{kind: torque_loss}]"), since=0.0)


def test_losing_the_torque_in_mid_walk_it_falls(run):
    assert_fell(*run("diagonal-walk", "faults=[{kind: torque_loss, time: 5}]"), since=5.0)


@pytest.mark.parametrize("name", ["diagonal-walk", "walk-level"])
def test_on_ice_it_falls(run, name):
    assert_fell(*run(name, "terrain.friction=0.02"), since=1.0)


@pytest.mark.parametrize(("name", "time"), [("diagonal-walk", 2.2), ("walk-level", 2.2), ("walk-level", 3.0)])
def test_with_a_frozen_plan_it_falls(run, name, time):
    """A plan that ends with a foot in the air. (One whose horizon holds the touchdown is survived, standing.)"""
    assert_fell(*run(name, f"faults=[{{kind: planner_freeze, time: {time}}}]"), since=time)


def test_a_push_past_the_limit_fells_it(run):
    assert_fell(*run("diagonal-walk", "pushes=[{time: 5, duration: 0.1, force: [0, 2000, 0]}]"), since=5.0)


def test_not_a_number_ends_the_run_with_the_last_two_seconds_in_the_log(run):
    verdict, log = run("diagonal-walk", "faults=[{kind: state_nan, time: 4}]")
    assert verdict.reasons[0] == "the run ended at 4.000000 s: the measured state is not finite at 4.000 s"
    truth = log["/truth"]
    last = truth.time > truth.time[-1] - 2.0
    assert truth.time[-1] == pytest.approx(3.998)
    assert np.count_nonzero(last) == 1000
    assert np.isfinite(truth.field("q")[last]).all()
    assert np.isfinite(truth.field("v")[last]).all()


def test_a_diverging_simulation_ends_the_run_with_its_reason(tmp_path):
    """It diverges by a force that no scenario may ask for."""
    scenario, path = surefoot.load("diagonal-walk"), tmp_path / "log.mcap"
    with pytest.raises(RunFault, match="simulation diverged"), surefoot.Simulation(scenario, log=path) as sim:
        while not sim.done:
            if sim.time == 2.5:
                sim.push((1e15, 0.0, 0.0), duration=0.1)
            sim.step()
    log = read(path)
    verdict = surefoot.judge(log)
    assert "simulation diverged after t = 2.5000 s: the acceleration is not finite" in verdict.reasons[0]
    truth = log["/truth"]
    assert truth.time[-1] == pytest.approx(2.5)
    assert np.isfinite(truth.field("q")).all()


def test_a_short_failure_of_the_solver_is_survived_and_told(run):
    verdict, _ = run("diagonal-walk", "faults=[{kind: qp_failure, time: 3, duration: 0.05}]")
    assert not verdict.metrics["fell"]
    assert verdict.reasons == ("wbc_fallbacks is 25, bound is at most 0",)
    assert verdict.notes == ("the whole-body QP had no solution at 25 ticks, which used the fallback torque",)


def test_a_lasting_failure_of_the_solver_is_told(run):
    """The fallback obeys dynamics and contacts without the inequalities, which an undisturbed walk hardly needs."""
    verdict, _ = run("diagonal-walk", "faults=[{kind: qp_failure, time: 3}]", "gait.steps=2")
    metrics = verdict.metrics
    assert metrics["wbc_fallbacks"] == metrics["qp_failures"] == round((metrics["duration"] - 3.0) * 500)
    assert "which used the fallback torque" in verdict.notes[0]
