import numpy as np
import pinocchio as pin
import pytest

from surefoot.wbc.body.model import RobotTerms
from surefoot.wbc.parameters import WbcParameters
from surefoot.wbc.tasks.arm_swing import ArmSwing
from surefoot.wbc.types import FootSensing, RobotState

pytestmark = pytest.mark.unit


@pytest.fixture
def terms(robot):
    return RobotTerms(robot.model, robot.frames)


@pytest.fixture
def swing(robot):
    return ArmSwing(robot.shoulders, 0.6)


def stride(robot, left=-0.3, right=0.2):
    """The left leg swung forward, the right one back (negative hip pitch is forward)."""
    q = robot.standing.copy()
    for name, angle in (("left_hip_pitch", left), ("right_hip_pitch", right)):
        q[robot.model.joints[robot.model.getJointId(name)].idx_q] += angle
    return q


def test_feet_side_by_side_leave_the_posture(robot, terms, swing):
    terms.update(robot.standing, np.zeros(robot.nv))
    assert np.abs(swing.offset(terms)).max() < 1e-6


def test_the_arm_goes_back_while_its_foot_is_ahead(robot, terms, swing):
    terms.update(stride(robot), np.zeros(robot.nv))
    angle, _ = swing.offset(terms)
    ahead = terms.sole_position[0, 0] - terms.sole_position[1, 0]
    assert ahead > 0.2
    assert angle == pytest.approx(0.6 * ahead, rel=1e-9)


@pytest.mark.parametrize("turned", [0.0, 2.0])
def test_rate_is_the_derivative_of_the_angle(robot, terms, swing, rng, turned):
    q = stride(robot)
    q[3:7] = (0.0, 0.0, np.sin(0.5 * turned), np.cos(0.5 * turned))
    v = np.zeros(robot.nv)
    v[:3], v[6:] = rng.uniform(-0.5, 0.5, 3), rng.uniform(-0.5, 0.5, robot.nv - 6)
    terms.update(q, v)
    _, rate = swing.offset(terms)
    angles = []
    for step in (-1e-5, 1e-5):
        terms.update(pin.integrate(robot.model, q, step * v), v)
        angles.append(swing.offset(terms)[0])
    assert rate == pytest.approx((angles[1] - angles[0]) / 2e-5, abs=1e-6)


def test_the_controller_swings_the_arms_against_each_other(robot, references):
    standing, _ = references
    bent = {}
    for gain in (0.0, 0.6):
        controller = robot.controller(WbcParameters(arm_swing=gain))
        controller.observe(RobotState(stride(robot), np.zeros(robot.nv)))
        report = controller.update(standing(), FootSensing((490.0, 490.0)))
        left, right = robot.shoulders
        bent[gain] = report.acceleration[6 + left] - report.acceleration[6 + right]
    assert bent[0.6] > bent[0.0] + 1.0


def test_arms_that_go_back_by_negative_angles_swing_the_same_way(robot, references):
    """With both signs turned round, the accelerations of the shoulders are too, against those without a swing."""
    standing, _ = references
    found = {}
    for gain, back in ((0.0, 1.0), (0.6, 1.0), (0.6, -1.0)):
        controller = robot.controller(WbcParameters(arm_swing=gain), arm_back=(back, back))
        controller.observe(RobotState(stride(robot), np.zeros(robot.nv)))
        report = controller.update(standing(), FootSensing((490.0, 490.0)))
        left, right = robot.shoulders
        found[gain, back] = report.acceleration[6 + left] - report.acceleration[6 + right]
    assert found[0.6, 1.0] > found[0.0, 1.0] + 1.0 > found[0.6, -1.0] + 2.0
