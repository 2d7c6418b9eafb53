"""A force that goes on acting on the body: the plan leans into it, and the ZMP stays where the feet are."""

from dataclasses import replace

import numpy as np
import pytest

from surefoot.forces import NO_LOAD, ExternalLoad
from surefoot.planner.geometry.plane import signed_distance
from surefoot.planner.parameters import PlannerParameters, StepAdaptation
from surefoot.planner.plan.sampling import PlanSampler
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.plants import IdealFeet, Pendulum
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.types import GRAVITY, CentroidalState

pytestmark = pytest.mark.unit

GAIT = GaitParameters(
    steps=6, step_length=0.2, step_width=0.2, single_support=0.5, double_support=0.12, initial_stand=0.4
)
FEET = (0.22, 0.11)
FORCE, MOMENT = np.array([0.25, 0.35]), np.array([-0.03, 0.02])
BEGIN, KNOWN = 1.0, 1.06
STILL = PlannerParameters(step_adaptation=StepAdaptation.NONE)


def walked(stand, told, turned=0.0):
    """Margins of the true ZMP in the planned polygon, CoM and ZMP of a pendulum that is pulled at from a time on."""
    turn = np.array([[np.cos(turned), -np.sin(turned)], [np.sin(turned), np.cos(turned)]])
    force, moment = turn @ FORCE, turn @ MOMENT
    feet = stand(yaw=turned)
    planner, ideal = WalkingPlanner(GAIT, feet, *FEET, parameters=STILL), IdealFeet(feet)
    pendulum, rows = Pendulum(100.0, np.zeros(2), np.zeros(2)), []
    for tick in range(round((GAIT.duration + 1.0) / 0.02)):
        time = 0.02 * tick
        com, velocity = np.append(pendulum.position, GAIT.com_height), np.append(pendulum.velocity, 0.0)
        known = ExternalLoad(np.append(force, 0.0), np.append(moment, 0.0)) if told and time >= KNOWN else None
        plan = planner.update(CentroidalState(time, com, velocity, known), ideal.state)
        sampler = PlanSampler(plan)
        for k in range(4):
            now = time + 0.005 * k
            sample = sampler.sample(now)
            error = pendulum.position + pendulum.velocity / sample.omega - sample.dcm
            acts = 1.0 if now >= BEGIN else 0.0
            # The moment moves the ZMP of a given motion; the pendulum's own is without.
            pressing = GRAVITY + sample.com_acceleration[2]
            turning = acts * np.array([moment[1], -moment[0]]) / pressing
            pendulum.advance(
                0.005, sample.zmp + 3.0 * error - turning, plan.support_polygon - turning, sample.stiffness,
                acts * 100.0 * force,
            )  # fmt: skip
            zmp = pendulum.zmp + turning
        ideal.follow(sampler, time + 0.02)
        rows.append((signed_distance(plan.inner_polygon, zmp), *pendulum.position, *zmp, *sample.zmp_reference))
    return np.array(rows)


def test_a_walk_that_knows_the_force_keeps_its_zmp_in_the_feet_and_leans_into_it(stand):
    rows = walked(stand, told=True)
    assert rows[100:, 0].min() > 0.0
    assert np.abs(rows[100:, 3:5] - rows[100:, 5:7]).max() < 0.02
    height = GAIT.com_height
    lean = (FORCE * height + [MOMENT[1], -MOMENT[0]]) / GRAVITY
    np.testing.assert_allclose(rows[-1, 1:3] - rows[-1, 5:7], -lean, atol=2e-3)


def test_a_walk_that_does_not_falls(stand):
    assert np.abs(walked(stand, told=False)[-1, 1:3]).max() > 2.0


def test_a_walk_knows_it_in_whatever_direction_it_goes(stand):
    ahead, aside = walked(stand, told=True), walked(stand, told=True, turned=2.0)
    np.testing.assert_allclose(aside[:, 0], ahead[:, 0], atol=1e-6)


def test_no_force_is_as_none(stand):
    plans = []
    for lasting in (None, NO_LOAD):
        planner = WalkingPlanner(GAIT, stand(), *FEET)
        state = CentroidalState(0.0, np.array([0.01, 0.0, 1.0]), np.zeros(3))
        plans.append(planner.update(replace(state, lasting=lasting), stand()))
    np.testing.assert_array_equal(plans[0].com, plans[1].com)
    np.testing.assert_array_equal(plans[0].zmp, plans[1].zmp)
