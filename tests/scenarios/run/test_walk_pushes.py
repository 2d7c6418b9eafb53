"""A robot that walks is pushed hard at its torso, catches itself with a long step, and goes on."""

import math

import pytest

import surefoot
from surefoot.planner.swing import leg_reach
from surefoot.planner.swing.heel_off import FootRoll
from surefoot.wbc import solvers
from surefoot.wbc.types import SolveStatus

pytestmark = pytest.mark.physics


def pushed(impulse, direction):
    """Whether it falls of a push late in its third step, and at how many ticks its QP dropped all limits."""
    push = {"step": 3, "phase": "single", "fraction": 0.65, "duration": 0.1}
    push |= {"impulse": impulse, "direction": direction}
    keys = {"robot": "g1", "sensing.source": "truth", "criteria": {"fell": False}, "duration": 6.0, "pushes": [push]}
    dropped = 0
    with surefoot.Simulation(surefoot.load("walk", keys)) as simulation:
        while not simulation.done:
            tick = simulation.step()
            dropped += tick.report.status is SolveStatus.EQUALITIES_ONLY
            if tick.fell:
                return True, dropped
    return False, dropped


@pytest.mark.parametrize("direction", [0.25, -0.3])
def test_a_long_step_does_not_throw_it_as_it_lands(direction):
    """Of five neighbours four stand at least, and none of them meets a QP whose limits are all dropped."""
    runs = [pushed(impulse, direction) for impulse in (0.52, 0.55, 0.58, 0.61, 0.64)]
    assert sum(fell for fell, _ in runs) <= 1
    assert not any(dropped for fell, dropped in runs if not fell)


def test_with_a_heel_rolled_in_no_time_and_soles_held_at_any_price_it_is_thrown(monkeypatch):
    """Negative control."""
    monkeypatch.setattr(FootRoll, "hardest", lambda roll, begin, end: 0.0)
    held = property(lambda solver: False, lambda solver, value: None)
    monkeypatch.setattr(solvers.Daqp, "_lets_go", held, raising=False)
    assert sum(pushed(impulse, -0.3)[0] for impulse in (0.55, 0.58, 0.61)) >= 2


def caught_wide(folder, seed):
    """Whether the paper's gait goes on after a push whose catching steps leave its feet half a metre apart."""
    push = {
        "step": 3,
        "phase": "double",
        "fraction": 0.5,
        "duration": 0.1,
        "impulse": 0.133,
        "direction": -0.5 * math.pi,
    }
    keys = {"gait.initial_stand": 0.4, "start.position_noise": 0.0005, "seed": seed, "pushes": [push]}
    criteria = {"fell": False, "steps_taken": "steps_planned", "standing_time_final": {"min": 0.5}}
    return surefoot.run(surefoot.load("diagonal-walk", {**keys, "criteria": criteria}), out=folder).verdict.passed


@pytest.mark.parametrize("seed", [2, 4])
def test_a_foot_left_far_behind_does_not_hold_the_body_back(seed, tmp_path):
    assert caught_wide(tmp_path, seed)


@pytest.mark.parametrize("seed", [2, 4])
def test_one_that_takes_its_time_fells_it(seed, tmp_path, monkeypatch):
    """Negative control."""
    monkeypatch.setattr(leg_reach, "GLIDES", ())
    assert not caught_wide(tmp_path, seed)
