"""Footsteps that are booked, and as what: feet that touch down when planned, earlier, later or never."""

from dataclasses import replace

import numpy as np
import pytest

from surefoot.planner.parameters import LegInertia
from surefoot.planner.types import CentroidalState, FeetState
from surefoot.scenarios.judge.inspection import inspect
from surefoot.scenarios.log import read
from surefoot.scenarios.run.pendulum import PointMass
from surefoot.scenarios.run.planning import FaultSchedule, Planning
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.run.sensing import PlannerSensing
from surefoot.scenarios.setup.load import load as load_scenario
from surefoot.scenarios.setup.walk import resolve

pytestmark = pytest.mark.unit

SHORT = ("fidelity=pendulum", "gait.steps=2", "gait.single_support=0.8", "gait.initial_stand=0.2", "rates.control=100")
PATIENCE = 0.3
OFFSET = np.array([0.01, -0.004, 0.02])


class Booked:
    """Stands for the recorder; keeps what is booked with its time."""

    def __init__(self):
        self.rows = []

    def planner_state(self, now_ns, state):
        pass

    def plan(self, now_ns, plan):
        pass

    def touchdown(self, now_ns, planned, feet):
        self.rows.append((now_ns / 1e9, planned, feet.position[planned.foot].copy()))


def planned_touchdown(walk):
    """Time when the first foot is to land [s], and the planner's period [s]."""
    planner = walk.planner(walk.ground.stance, LegInertia())
    period = planner.parameters.sample_time
    return walk.gait.lift_off(1) + walk.gait.single_support, period


def booked(landing, until, offset=OFFSET):
    """Footsteps booked of a first swing whose foot touches at a time, at an offset from its reference, and stays."""
    walk = resolve(load_scenario("diagonal-walk", SHORT))
    planner, rows = walk.planner(walk.ground.stance, LegInertia()), Booked()
    planning = Planning(planner, PlannerSensing(walk), rows, FaultSchedule((), 100), walk.rates)
    feet, com, velocity = (
        walk.ground.stance,
        np.append(walk.ground.stance.position[:, :2].mean(axis=0), 1.0),
        np.zeros(3),
    )
    period, landed = planner.parameters.sample_time, None
    for k in range(round(until / period)):
        now = k * period
        tick = round(now * 100)
        planning.update(tick, round(now * 1e9), CentroidalState(now, com, velocity), feet.position[0, :2], feet)
        plan = planning.plan
        com, velocity = plan.com[1], plan.com_velocity[1]
        position, contact = walk.ground.stance.position.copy(), [True, True]
        after = now + period
        if plan.swing is not None and plan.phase.step == 1 and (landed is None or after < landing):
            landed = plan.swing.foot, plan.swing.evaluate(after)[0][:3]
        if landed is not None:
            foot, place = landed
            position[foot] = place + (offset if after >= landing else 0.0)
            contact[foot] = bool(after >= landing)
        feet = FeetState(position, feet.yaw, (contact[0], contact[1]))
    return rows.rows


@pytest.fixture(scope="module")
def clock():
    return planned_touchdown(resolve(load_scenario("diagonal-walk", SHORT)))


def test_a_foot_that_lands_when_planned_is_booked_then(clock):
    land, _ = clock
    ((time, planned, actual),) = booked(land - 1e-6, land + 0.1)
    assert time == pytest.approx(land)
    assert actual - planned.position == pytest.approx(OFFSET, abs=5e-4)


def test_an_early_touchdown_is_compared_with_what_was_planned_before_it(clock):
    """0.1 s early and above the ground: the planner moves the footstep there, the book does not."""
    land, _ = clock
    on_time = booked(land - 1e-6, land + 0.1)[0][1]
    ((time, planned, actual),) = booked(land - 0.1, land + 0.1)
    assert time == pytest.approx(land)
    assert planned.position == pytest.approx(on_time.position, abs=1e-5)
    assert planned.position[2] == 0.0
    assert np.linalg.norm(actual - planned.position) > 0.02


def test_a_late_touchdown_is_booked_when_it_comes(clock):
    land, period = clock
    ((time, _, _),) = booked(land + 0.1, land + 0.3)
    assert time == pytest.approx(land + 0.1, abs=1.01 * period)


def test_a_foot_still_in_the_air_when_patience_ends_is_no_touchdown(clock):
    """It becomes one when it touches, and none if it never does."""
    land, period = clock
    assert booked(land + 9.0, land + PATIENCE + 0.1) == []
    ((time, _, _),) = booked(land + PATIENCE + 0.06, land + PATIENCE + 0.14)
    assert time == pytest.approx(land + PATIENCE + 0.06, abs=1.01 * period)


def test_the_verdict_says_that_a_foot_never_touched(tmp_path, monkeypatch):
    original = PointMass.measured

    def in_the_air(self):
        state, zmp, feet = original(self)
        return state, zmp, replace(feet, contact=(False, feet.contact[1]))

    monkeypatch.setattr(PointMass, "measured", in_the_air)
    result = run_scenario(load_scenario("diagonal-walk", (*SHORT, "planner.step_adaptation=none")), tmp_path)
    verdict = result.verdict
    assert not verdict.passed
    assert "steps_taken is 0, must be 2" in verdict.reasons
    assert "steps whose foot never touched the ground, so that they do not count: 1" in verdict.notes
    assert verdict.metrics["touchdowns_missed"] == 1
    log = read(result.log)
    assert "/footstep" not in log or not len(log["/footstep"])
    checks = {finding["check"]: finding for finding in inspect(log).to_json()["health"]}
    assert "1 of 1 swings end without their foot ever touching the ground" in checks["touchdowns"]["cause"]
