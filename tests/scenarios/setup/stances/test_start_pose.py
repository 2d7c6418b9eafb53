from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from surefoot.models.facts import STOPS_OFF
from surefoot.models.registry import describe
from surefoot.models.types import RobotOptions
from surefoot.planner.geometry.plane import wrap_angle
from surefoot.scenarios.file.gait import Gait
from surefoot.scenarios.file.schema import Scenario, Start
from surefoot.scenarios.setup.robot.body import body_of, feet_at
from surefoot.scenarios.setup.stances.start import SOLE_SINKAGE, at_believed_start, disturbed, pressed, start_posture
from surefoot.scenarios.setup.walk import resolve

pytestmark = pytest.mark.unit


@pytest.fixture(scope="module")
def body():
    return body_of(describe("humanoid100", RobotOptions()))


def soles(body, q):
    data = body.model.createData()
    pin.framesForwardKinematics(body.model, data, q)
    return [data.oMf[body.model.getFrameId(name)] for name in body.frames.soles]


def test_it_stands_where_the_scenario_says(body):
    walk = resolve(Scenario(start=Start(x=3.0, y=-2.0, yaw=1.0), gait=Gait(com_height=0.97, step_width=0.22)))
    q = start_posture(walk, body)
    com = pin.centerOfMass(body.model, body.model.createData(), q)
    np.testing.assert_allclose(com, [3.0, -2.0, 0.97], atol=1e-6)
    feet = feet_at(body, q)
    assert np.linalg.norm(feet.position[0] - feet.position[1]) == pytest.approx(0.22, abs=1e-6)
    np.testing.assert_allclose(feet.yaw, 1.0, atol=1e-6)


@pytest.mark.parametrize("seed", range(3))
def test_noise_moves_the_body_and_leaves_the_soles_flat_on_the_ground(body, seed):
    walk = resolve(Scenario(seed=seed, start=Start(position_noise=0.001, angle_noise=0.0175)))
    calm = start_posture(walk, body)
    q = disturbed(calm, walk, body)
    assert np.abs(q[7:] - calm[7:]).max() > 0.005
    for sole in soles(body, q):
        np.testing.assert_allclose(sole.rotation[2], [0.0, 0.0, 1.0], atol=1e-6)
        assert sole.translation[2] == pytest.approx(0.0, abs=1e-6)
    np.testing.assert_array_equal(disturbed(calm, walk, body), q)


def test_without_noise_nothing_moves(body):
    walk = resolve(Scenario())
    calm = start_posture(walk, body)
    np.testing.assert_array_equal(disturbed(calm, walk, body), calm)


def test_pressed_soles_are_just_below_the_ground(body):
    q = pressed(start_posture(resolve(Scenario()), body))
    np.testing.assert_allclose([sole.translation[2] for sole in soles(body, q)], -SOLE_SINKAGE, atol=1e-6)


def test_a_stance_out_of_reach_is_refused(body):
    with pytest.raises(ValueError, match="cannot stand with gait"):
        start_posture(resolve(Scenario(gait=Gait(com_height=1.2))), body)


@pytest.mark.parametrize("bend", [1.0, -1.0])
def test_knees_bend_no_farther_back_than_straight(body, bend):
    robot = body.robot
    knees = [robot.joint_names.index(name) for name in robot.roles.knees]
    backward = robot.position_lower.copy()
    backward[knees] -= 0.1
    lower, upper = (backward, robot.position_upper) if bend > 0.0 else (-robot.position_upper, -backward)
    roles = replace(robot.roles, knee_bend=(bend, bend))
    limits = body_of(replace(robot, roles=roles, position_lower=lower, position_upper=upper)).limits
    straight = limits.lower if bend > 0.0 else limits.upper
    np.testing.assert_allclose(straight[knees], robot.straight_joint_positions[knees] + bend * STOPS_OFF)
    others = np.setdiff1d(np.arange(len(lower)), knees)
    np.testing.assert_allclose(limits.lower[others], lower[others] + STOPS_OFF)
    np.testing.assert_allclose(limits.upper[others], upper[others] - STOPS_OFF)


@pytest.mark.parametrize("yaw", [0.0, 1.2, 3.1])
def test_who_only_senses_takes_the_feet_to_be_around_where_it_wat_believed_start(body, yaw):
    noisy = Start(x=2.0, y=1.0, yaw=yaw, position_noise=0.001, angle_noise=0.0175)
    walk = resolve(Scenario(seed=1, start=noisy))
    q, told = disturbed(start_posture(walk, body), walk, body), walk.ground.stance
    true, found = feet_at(body, q), feet_at(body, at_believed_start(q, walk, body))
    np.testing.assert_allclose(found.position.mean(axis=0), told.position.mean(axis=0), atol=1e-9)
    assert sum(map(wrap_angle, found.yaw - told.yaw)) == pytest.approx(0.0, abs=1e-9)
    # They stand as they do, wherever that is.
    apart = [np.linalg.norm(np.subtract(*feet.position)) for feet in (true, found)]
    assert apart[0] == pytest.approx(apart[1], abs=1e-12)
    assert wrap_angle(true.yaw[0] - true.yaw[1]) == pytest.approx(wrap_angle(found.yaw[0] - found.yaw[1]), abs=1e-9)
    np.testing.assert_array_equal(at_believed_start(q, walk, body)[7:], q[7:])
