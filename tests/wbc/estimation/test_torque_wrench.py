"""Sole wrenches from joint torques, where nothing else tells them."""

import numpy as np
import pinocchio as pin
import pytest

from surefoot.wbc.estimation.torques import TorqueWrench
from surefoot.wbc.types import RobotState

pytestmark = pytest.mark.unit

PERIOD = 0.002


def balanced(robot, q, share):
    """Sole wrenches that hold a robot still, the left one with a share of the weight, and the torques with them."""
    model, data = robot.model, robot.model.createData()
    gravity = pin.computeGeneralizedGravity(model, data, q).copy()
    pin.computeJointJacobians(model, data, q)
    pin.updateFramePlacements(model, data)
    frames = [model.getFrameId(name) for name in robot.frames.soles]
    J = np.vstack([pin.getFrameJacobian(model, data, frame, pin.ReferenceFrame.LOCAL) for frame in frames])
    scale = np.repeat([share, 1.0 - share], 6) * np.tile([1.0, 1.0, 1.0, 0.1, 0.1, 0.1], 2)
    wrench = scale * np.linalg.lstsq(J.T[:6] * scale, gravity[:6], rcond=None)[0]
    return wrench.reshape(2, 6), gravity[6:] - (J.T @ wrench)[6:]


@pytest.mark.parametrize("share", [0.5, 0.8, 1.0])
def test_of_a_robot_at_rest_they_are_the_true_ones(robot, share):
    q = robot.standing
    wrench, torque = balanced(robot, q, share)
    found = TorqueWrench(robot.model, robot.frames.soles, PERIOD)
    state = RobotState(q, np.zeros(robot.nv))
    for _ in range(5):
        seen = found.update(state, torque)
    np.testing.assert_allclose(seen[:, :3], wrench[:, :3], atol=2.0)
    np.testing.assert_allclose(seen[:, 3:], wrench[:, 3:], atol=1.0)
    # Torques of another stance are told as such.
    other, _ = balanced(robot, q, 1.0 - 0.5 * share)
    assert np.abs(seen - other).max() > 50.0


def test_in_free_fall_there_are_none_whatever_the_joints_do(robot):
    """Momentum changes by gravity and torques alone, which the observer knows."""
    model, data, rng = robot.model, robot.model.createData(), np.random.default_rng(2)
    q, v = robot.standing.copy(), np.zeros(robot.nv)
    found, step = TorqueWrench(model, robot.frames.soles, PERIOD), PERIOD / 20
    torque = np.zeros(robot.nv - 6)
    found.update(RobotState(q, v), -np.ones(robot.nv - 6) * 0.0)
    largest = []
    for _ in range(100):
        torque = 0.9 * torque + rng.normal(scale=3.0, size=robot.nv - 6)
        for _ in range(20):
            v = v + step * pin.aba(model, data, q, v, np.concatenate((np.zeros(6), torque)))
            q = pin.integrate(model, q, step * v)
        largest.append(np.abs(found.update(RobotState(q, v), torque)[:, 2]).max())
    assert max(largest[60:]) < 0.03 * 981.0


def test_a_force_that_sets_in_is_followed_within_its_bandwidth(robot):
    q = robot.standing
    (_, torque), (other, changed) = balanced(robot, q, 0.5), balanced(robot, q, 0.8)
    found, state = TorqueWrench(robot.model, robot.frames.soles, PERIOD), RobotState(q, np.zeros(robot.nv))
    found.update(state, torque)
    for _ in range(20):
        seen = found.update(state, changed)
    np.testing.assert_allclose(seen[:, 2], other[:, 2], atol=5.0)
