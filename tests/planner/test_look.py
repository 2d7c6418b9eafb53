"""A look knows where the DCM is, however the robot stands in the world."""

import math

import numpy as np
import pytest

from surefoot.planner.ground.slope import Slope
from surefoot.planner.ground.terrain import Site
from surefoot.planner.look import look
from surefoot.planner.measured import Measured
from surefoot.planner.plan.sampling import PlanSampler
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.plants import IdealFeet
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.swing.leg_reach import LegReach
from surefoot.planner.types import CentroidalState

pytestmark = pytest.mark.unit

LENGTH, WIDTH, APART = 0.22, 0.11, 0.2
STAND = GaitParameters(steps=0, com_height=0.95, step_width=APART)


@pytest.mark.parametrize("moving", [False, True])
@pytest.mark.parametrize("yaw", [0.0, 0.7, -2.0])
@pytest.mark.parametrize(
    ("ahead", "left"), [(0.05, 0.0), (0.15, 0.0), (-0.08, 0.02), (-0.13, 0.01), (0.0, 0.12), (0.02, -0.17)]
)
def test_a_robot_that_stands_is_as_far_from_a_fall_as_its_dcm_is_inside_its_soles(stand, yaw, ahead, left, moving):
    origin = np.array([1.3, -0.4])
    feet = stand(APART, tuple(origin.tolist()), yaw)
    planner = WalkingPlanner(STAND, feet, LENGTH, WIDTH)
    turned = np.array([[math.cos(yaw), -math.sin(yaw)], [math.sin(yaw), math.cos(yaw)]])
    way = turned @ (ahead, left)
    omega = look(planner.state, Measured(CentroidalState(0.0, np.append(origin, 0.95), np.zeros(3)), feet)).window.omega
    place, speed = (origin, way * float(omega[0])) if moving else (origin + way, np.zeros(2))
    body = CentroidalState(0.0, np.append(place, 0.95), np.append(speed, 0.0))
    balance = look(planner.state, Measured(body, feet)).balance
    inside = min(0.5 * LENGTH - abs(ahead), 0.5 * (APART + WIDTH) - abs(left))
    # What is to come of the way to the middle of the soles captures a little more to the sides.
    assert inside - 1e-9 <= balance.planned <= inside + 0.012
    assert (balance.planned > 0.0) == (inside > 0.0)
    assert balance.movable == balance.planned


GAIT = GaitParameters(
    steps=3, step_length=0.25, step_width=APART, single_support=0.5, double_support=0.1, initial_stand=0.1,
    com_height=0.95,
)  # fmt: skip
LEGS = LegReach(0.36, 0.2, 0.115, 0.12, 0.24, (60.0, 50.0))


def looked_at(stand, origin=(0.0, 0.0), yaw=0.0, deviation=(0.0, 0.0), terrain=None):
    """Looks at a walk at each of its ticks, whose CoM and feet do what is planned."""
    turned = np.array([[math.cos(yaw), -math.sin(yaw)], [math.sin(yaw), math.cos(yaw)]])
    feet = stand(APART, origin, yaw)
    planner, ideal = WalkingPlanner(GAIT, feet, LENGTH, WIDTH, terrain, legs=LEGS), IdealFeet(feet)
    com, velocity, found = np.array([*origin, 0.95]), np.zeros(3), []
    for tick in range(85):
        time = 0.02 * tick
        # A kick sideways, off which the walk has to come.
        velocity = velocity + np.append(turned @ (0.0, 0.06), 0.0) * (tick == 40)
        body = CentroidalState(time, com, velocity, deviation=deviation)
        plan = planner.update(body, ideal.state)
        found.append(look(planner.state, Measured(body, ideal.state)))
        com, velocity = plan.com[1], plan.com_velocity[1]
        ideal.follow(PlanSampler(plan), time + 0.02)
    return found


@pytest.mark.parametrize(("origin", "yaw"), [((1.3, -0.4), 0.0), ((0.0, 0.0), 0.7), ((-2.0, 3.0), -2.0)])
def test_a_look_sees_the_same_wherever_a_walk_goes_and_whichever_way(stand, origin, yaw):
    swung = 0.0
    for here, there in zip(looked_at(stand), looked_at(stand, origin, yaw), strict=True):
        assert here.state.info.landed == here.state.landed
        np.testing.assert_allclose(there.dcm, here.dcm, atol=1e-6)
        np.testing.assert_allclose(there.local, here.local, atol=1e-5)
        assert there.balance.planned == pytest.approx(here.balance.planned, abs=1e-6)
        assert there.balance.movable == pytest.approx(here.balance.movable, abs=1e-6)
        assert (there.step is None) is (here.step is None)
        if here.step is not None:
            np.testing.assert_allclose(there.step.swing, here.step.swing, atol=1e-5)
            np.testing.assert_allclose(there.step.nominal, here.step.nominal, atol=1e-6)
            assert there.step.place.yaw == pytest.approx(here.step.place.yaw, abs=1e-9)
            np.testing.assert_allclose(there.step.face, here.step.face, atol=1e-6)
            swung = max(swung, np.abs(here.step.swing[1]).max())
    assert swung > 0.5


def test_of_a_swing_that_is_half_over_half_of_the_shortest_is_left(stand):
    """And all of it before the foot has left the ground; on a slope, up which the body has to come."""
    shortest, slope = {}, Slope(0.05, 0.12, 4.0, 1.0).build(Site(np.zeros(2), 0.0, 0.7))
    for one in looked_at(stand, terrain=slope):
        if one.step is not None:
            share = one.step.single / GAIT.single_support if one.step.double == 0.0 else 1.0
            shortest.setdefault(one.state.landed, []).append(one.step.shortest / share)
    assert len(shortest) == 3
    for values in list(shortest.values())[1:]:
        assert min(values) > 0.02
        np.testing.assert_allclose(values, values[0], rtol=1e-6)


def test_a_robot_that_is_unsure_of_its_dcm_has_the_less_margin(stand):
    deviation = 0.004, 0.02
    unsure = False
    for sure, doubted in zip(looked_at(stand), looked_at(stand, deviation=deviation), strict=True):
        omega = float(sure.window.omega[0])
        less = 2.0 * math.hypot(deviation[0], deviation[1] / omega)
        assert doubted.uncertainty == pytest.approx(less)
        if np.allclose(sure.dcm, doubted.dcm, atol=1e-9):
            unsure = True
            assert sure.balance.planned - doubted.balance.planned == pytest.approx(less, abs=1e-6)
            assert sure.balance.movable - doubted.balance.movable == pytest.approx(less, abs=1e-6)
    assert unsure
