import numpy as np
import pinocchio as pin
import pytest

from surefoot.models.pinocchio import pinocchio_model
from surefoot.models.registry import describe
from surefoot.models.types import RobotOptions
from surefoot.wbc.model import BodyFrames
from surefoot.wbc.statics import standing_torque

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
