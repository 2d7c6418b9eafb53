"""Stances that a walk goes through: where the CoM is in them, and joints that do not reach them."""

import math
from dataclasses import replace

import numpy as np
import pytest

import surefoot
from surefoot.errors import ParameterError
from surefoot.models import RobotDescription
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.types import GRAVITY
from surefoot.scenarios.setup.robot.body import body_of
from surefoot.scenarios.setup.stances.stances import _shares, _stances, check_stances
from surefoot.scenarios.setup.stances.start import start_posture
from surefoot.scenarios.setup.walk import Walk, resolve

pytestmark = pytest.mark.unit


def walked_by(walk: Walk, robot: RobotDescription) -> None:
    body = body_of(robot)
    check_stances(walk, body, start_posture(walk, body))


def limited(robot: RobotDescription, joint: str, lower: float, upper: float) -> RobotDescription:
    low, high = np.array(robot.position_lower), np.array(robot.position_upper)
    for side in ("left", "right"):
        index = robot.joint_names.index(f"{side}_{joint}")
        low[index], high[index] = lower, upper
    return replace(robot, position_lower=low, position_upper=high)


@pytest.mark.parametrize(("single", "double"), [(0.4, 0.1), (0.8, 0.3), (1.5, 0.5)])
def test_the_com_at_the_ends_of_double_support_is_that_of_the_periodic_pendulum(single: float, double: float) -> None:
    """Place and velocity one step later are the same beside the next foot, forward; and mirrored, sideways."""
    gait = GaitParameters(steps=4, single_support=single, double_support=double, com_height=1.0)
    omega = math.sqrt(GRAVITY)
    for share, mirrored in zip(_shares(gait), (False, True), strict=True):
        # Feet at -1/2 and 1/2, double support from touchdown at time 0: x'' = ω² (x - p).
        ramp = 1.0 / double

        def after(x: float, v: float, at: float, slope: float, time: float) -> tuple[float, float]:
            deviation, rate = x - at, v - slope
            c, s = math.cosh(omega * time), math.sinh(omega * time)
            return at + slope * time + deviation * c + rate * s / omega, slope + deviation * omega * s + rate * c

        x, end = -(0.5 + share), 0.5 + share
        c, s = math.cosh(omega * double), math.sinh(omega * double)
        v = ramp + omega * ((end - 0.5) - (x + 0.5) * c) / s  # that reaches the other end of the double support
        landed = after(x, v, -0.5, ramp, double)
        assert landed[0] == pytest.approx(end, abs=1e-9)
        next_x, next_v = after(*landed, 0.5, 0.0, single)
        if mirrored:  # the next foot is back at -1/2: a mirror image
            assert (next_x, next_v) == pytest.approx((-x, -v), rel=1e-6)
        else:  # one step further
            assert (next_x - 1.0, next_v) == pytest.approx((x, v), rel=1e-6)


def test_the_reference_robot_reaches_its_catalogue() -> None:
    for name in ("walk-level", "stairs-tall", "stairs-down", "walk-sideways", "diagonal-walk"):
        walk = resolve(surefoot.load(name))
        assert len(list(_stances(walk))) > 2
        walked_by(walk, walk.robot)


def test_an_ankle_without_the_range_for_stairs_is_named_with_the_footstep() -> None:
    walk = resolve(surefoot.load("stairs-down"))
    stiff = limited(walk.robot, "ankle_pitch", -0.6, 0.6)
    with pytest.raises(ParameterError, match=r"footstep \d+ .*ankle_pitch.*lower stairs") as refusal:
        walked_by(walk, stiff)
    assert refusal.value.key == ("terrain", "riser")
    level = resolve(surefoot.load("walk-level"))
    walked_by(level, stiff)


def test_legs_that_cannot_spread_are_refused_a_wide_step() -> None:
    walk = resolve(surefoot.load("diagonal-walk"))
    with pytest.raises(ParameterError, match="ankle_roll"):
        walked_by(walk, limited(walk.robot, "ankle_roll", -0.1, 0.1))


def test_alike_stances_are_looked_at_once() -> None:
    few, many = (len(list(_stances(resolve(surefoot.load("walk-level", {"gait.steps": n}))))) for n in (20, 500))
    assert few == many


def weakened(robot: RobotDescription, joint: str, torque: float) -> RobotDescription:
    limit = np.array(robot.torque_limit)
    for side in ("left", "right"):
        limit[robot.joint_names.index(f"{side}_{joint}")] = torque
    return replace(robot, torque_limit=limit)


def test_a_knee_too_weak_for_stairs_is_named_with_its_torque_and_the_footstep() -> None:
    walk = resolve(surefoot.load("stairs-up"))
    weak = weakened(walk.robot, "knee", 200.0)
    with pytest.raises(
        ParameterError, match=r"_knee' .* need 2\d\d N m when footstep \d+ .* limit is 200 N m"
    ) as refusal:
        walked_by(walk, weak)
    assert refusal.value.key == ("terrain", "riser")
    walked_by(resolve(surefoot.load("walk-level")), weak)


def test_the_foot_that_stands_bears_at_a_touchdown_and_the_other_at_the_lift_off() -> None:
    for stance in _stances(resolve(surefoot.load("walk-level"))):
        ahead = int(np.argmax(stance.soles[:, 0]))
        if np.ptp(stance.soles[:, 0]) > 0.01:
            assert stance.bearing == (1 - ahead if stance.landing else ahead)


def test_soles_lie_on_the_slope_that_they_stand_on() -> None:
    """Uphill an ankle bends by the slope more than on level ground; its heights alone do not say so."""
    scenario = surefoot.load("slope")
    walk = resolve(scenario)
    tilted = [stance for stance in _stances(walk) if stance.soles[:, 4].any()]
    assert tilted and min(stance.soles[:, 4].min() for stance in tilted) == pytest.approx(-scenario.terrain.angle)
    with pytest.raises(ParameterError, match=r"ankle_pitch.*less steep ground") as refusal:
        walked_by(walk, limited(walk.robot, "ankle_pitch", -0.6, 0.6))
    assert refusal.value.key == ("terrain", "angle")
