import numpy as np
import pinocchio as pin
import pytest

from surefoot.models.pinocchio import pinocchio_model
from surefoot.models.registry import describe
from surefoot.models.types import RobotOptions
from surefoot.wbc.body.ik import PostureIk, PostureTarget
from surefoot.wbc.body.limits import JointLimits
from surefoot.wbc.body.model import BodyFrames
from surefoot.wbc.body.statics import bearing_torque, standing_torque

pytestmark = pytest.mark.unit


def test_torque_and_some_sole_wrenches_balance_gravity():
    robot = describe("humanoid100", RobotOptions())
    model, frames = pinocchio_model(robot), BodyFrames(robot.sole_sites, robot.torso_body)
    q = pin.neutral(model)
    q[7:] = robot.nominal_joint_positions
    torque = standing_torque(model, frames, q)
    data = model.createData()
    rest = pin.computeGeneralizedGravity(model, data, q) - np.concatenate([np.zeros(6), torque])
    pin.computeJointJacobians(model, data, q)
    pin.updateFramePlacements(model, data)
    ids = [model.getFrameId(name) for name in frames.soles]
    J = np.vstack([pin.getFrameJacobian(model, data, i, pin.ReferenceFrame.LOCAL) for i in ids])
    wrenches, *_ = np.linalg.lstsq(J.T, rest, rcond=None)
    np.testing.assert_allclose(J.T @ wrenches, rest, atol=1e-8)
    np.testing.assert_allclose(wrenches[[2, 8]], 0.5 * robot.mass * 9.81, rtol=0.01)
    assert np.abs(torque).max() > 10.0


def bearing(com_aside):
    """Torques on the left foot alone and those of the robot standing still on it, with the CoM beside its centre."""
    robot = describe("humanoid100", RobotOptions())
    model, frames = pinocchio_model(robot), BodyFrames(robot.sole_sites, robot.torso_body)
    limits = JointLimits(robot.torque_limit, robot.velocity_limit, robot.position_lower, robot.position_upper)
    q = pin.neutral(model)
    q[2], q[7:] = robot.leg_length, robot.nominal_joint_positions
    feet = np.array([[0.0, 0.1, 0.0], [-0.2, -0.1, 0.0]])
    target = PostureTarget(feet, np.zeros(2), np.array([*com_aside, 0.98]) + feet[0], 0.0)
    found = PostureIk(model, frames, limits, robot.nominal_joint_positions).solve(target, q)
    assert found.reached
    return robot, found.q, bearing_torque(model, frames, found.q, 0), standing_torque(model, frames, found.q, foot=0)


def test_a_foot_below_the_com_bears_what_it_bears_at_rest():
    *_, moving, resting = bearing((0.0, 0.0))
    np.testing.assert_allclose(moving, resting, atol=1e-4)


def test_a_foot_beside_the_com_bears_without_a_moment_at_its_sole():
    """The ankle of a foot whose force goes through the CoM turns about its own lever alone: far less than at rest."""
    robot, _, moving, resting = bearing((0.1, 0.0))
    (ankle,) = robot.joint_indices(("left_ankle_pitch",))
    assert abs(resting[ankle]) == pytest.approx(0.1 * robot.mass * 9.81, rel=0.3)
    assert abs(moving[ankle]) < 0.15 * abs(resting[ankle])


def test_it_is_at_rest_in_the_gravity_of_who_is_accelerated_along():
    """There the weight goes from the CoM through the sole's centre, and torques and that force hold it."""
    robot, q, moving, _ = bearing((0.1, -0.05))
    model, frame = pinocchio_model(robot), robot.sole_sites[0]
    data = model.createData()
    pin.computeJointJacobians(model, data, q)
    pin.updateFramePlacements(model, data)
    lever = data.oMf[model.getFrameId(frame)].translation - pin.centerOfMass(model, data, q)
    model.gravity.linear = 9.81 / -lever[2] * lever
    J = pin.getFrameJacobian(model, data, model.getFrameId(frame), pin.ReferenceFrame.LOCAL_WORLD_ALIGNED)[:3]
    left = pin.computeGeneralizedGravity(model, data, q) + J.T @ (robot.mass * np.array(model.gravity.linear))
    np.testing.assert_allclose(left[:6], 0.0, atol=1e-9)
    np.testing.assert_allclose(moving, left[6:], atol=1e-9)
