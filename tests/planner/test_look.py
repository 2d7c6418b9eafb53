"""A look knows where the DCM is, however the robot stands in the world."""

import math

import numpy as np
import pytest

from surefoot.planner.look import look
from surefoot.planner.measured import Measured
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.steps.gait import GaitParameters
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
