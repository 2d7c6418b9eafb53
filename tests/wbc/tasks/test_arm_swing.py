from dataclasses import replace

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


@pytest.fixture
def standing(references):
    """The reference of a robot that stands."""
    return references[0]()


def test_feet_side_by_side_leave_the_posture(robot, terms, swing, standing):
    terms.update(robot.standing, np.zeros(robot.nv))
    assert np.abs(swing.offset(terms, standing)).max() < 1e-6


def test_the_arm_goes_back_while_its_foot_is_ahead(robot, terms, swing, standing):
    terms.update(stride(robot), np.zeros(robot.nv))
    angle, _, _ = swing.offset(terms, standing)
    ahead = terms.sole_position[0, 0] - terms.sole_position[1, 0]
    assert ahead > 0.2
    assert angle == pytest.approx(0.6 * ahead, rel=1e-9)


@pytest.mark.parametrize("turned", [0.0, 2.0])
def test_rate_is_the_derivative_of_the_angle(robot, terms, swing, standing, rng, turned):
    q = stride(robot)
    q[3:7] = (0.0, 0.0, np.sin(0.5 * turned), np.cos(0.5 * turned))
    v = np.zeros(robot.nv)
    v[:3], v[6:] = rng.uniform(-0.5, 0.5, 3), rng.uniform(-0.5, 0.5, robot.nv - 6)
    terms.update(q, v)
    _, rate, _ = swing.offset(terms, standing)
    angles = []
    for step in (-1e-5, 1e-5):
        terms.update(pin.integrate(robot.model, q, step * v), v)
        angles.append(swing.offset(terms, standing)[0])
    assert rate == pytest.approx((angles[1] - angles[0]) / 2e-5, abs=1e-6)


@pytest.mark.parametrize("foot", [0, 1])
@pytest.mark.parametrize("turned", [0.0, 2.0])
def test_the_acceleration_is_the_derivative_of_the_rate_of_a_foot_that_follows_its_swing(
    robot, terms, swing, standing, rng, foot, turned
):
    """The base of the robot flies on at its speed, one foot stands still, the other is accelerated as planned."""
    q = stride(robot)
    q[3:7] = (0.0, 0.0, np.sin(0.5 * turned), np.cos(0.5 * turned))
    terms.update(q, np.zeros(robot.nv))
    planned, soles = rng.uniform(-9.0, 9.0, 3), [robot.model.getFrameId(name) for name in robot.frames.soles]
    aligned = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
    J = np.vstack([pin.computeFrameJacobian(robot.model, terms.data, q, sole, aligned)[:3, 6:] for sole in soles])
    acceleration = np.linalg.pinv(J) @ np.concatenate([planned if k == foot else np.zeros(3) for k in (0, 1)])
    rates = []
    for step in (-1e-5, 1e-5):
        v = np.concatenate((np.zeros(6), step * acceleration))
        terms.update(q, v)
        rates.append(swing.offset(terms, standing)[1])
    flying = replace(standing, swing_foot=foot, swing_acceleration=planned)
    assert swing.offset(terms, flying)[2] == pytest.approx((rates[1] - rates[0]) / 2e-5, rel=1e-6)
    assert abs(swing.offset(terms, flying)[2]) > 0.1
    assert swing.offset(terms, replace(flying, swing_foot=-1))[2] == 0.0
    assert swing.offset(terms, replace(flying, catching=True))[2] == 0.0


def test_a_shoulder_is_asked_for_the_acceleration_of_its_swing(robot, standing):
    """An arm whose angles go the other way is asked for as much as its neighbour, which swings against it."""
    left, right = robot.shoulders
    asked = []
    for ahead in (0.0, 5.0):
        controller = robot.controller(WbcParameters(), arm_back=(1.0, -1.0))
        terms = controller.observe(RobotState(robot.standing, np.zeros(robot.nv)))
        reference = replace(standing, swing_foot=0, swing_acceleration=(ahead, 0.0, 0.0))
        controller.tasks.write(terms, reference)
        asked.append(controller.tasks.linear.copy())
    fed = asked[1] - asked[0]
    share = WbcParameters().weights.upper_posture * WbcParameters().arm_swing * 5.0
    assert fed[6 + left] == pytest.approx(share, rel=1e-9)
    assert fed[6 + right] == pytest.approx(share, rel=1e-9)
    assert np.abs(np.delete(fed, [6 + left, 6 + right])).max() < 1e-9


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
