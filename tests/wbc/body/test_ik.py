from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from surefoot.wbc.body.ik import PostureIk, PostureTarget

pytestmark = pytest.mark.unit

STANCE = PostureTarget(np.array([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]]), np.zeros(2), np.array([0.0, 0.0, 1.0]), 0.0)


def assert_fulfilled(robot, q, target, tolerance):
    """Check a posture against its target with nothing but forward kinematics."""
    data = robot.model.createData()
    pin.framesForwardKinematics(robot.model, data, q)
    for k, name in enumerate(robot.frames.soles):
        placement = data.oMf[robot.model.getFrameId(name)]
        np.testing.assert_allclose(placement.translation, target.sole_position[k], atol=tolerance)
        np.testing.assert_allclose(placement.rotation, pin.utils.rotate("z", target.sole_yaw[k]), atol=tolerance)
    upright = pin.utils.rotate("z", target.heading)
    np.testing.assert_allclose(data.oMi[1].rotation, upright, atol=tolerance)
    torso = data.oMf[robot.model.getFrameId(robot.frames.torso)].rotation
    np.testing.assert_allclose(torso, upright, atol=tolerance)
    np.testing.assert_allclose(pin.centerOfMass(robot.model, data, q), target.com, atol=tolerance)
    assert (q[7:] >= robot.limits.lower - 1e-9).all()
    assert (q[7:] <= robot.limits.upper + 1e-9).all()


TARGETS = {
    "start": STANCE,
    "crouch": replace(STANCE, com=np.array([0.0, 0.0, 0.8])),
    "on a stair": PostureTarget(
        np.array([[0.3, 0.1, 0.2], [0.0, -0.1, 0.0]]), np.zeros(2), np.array([0.15, 0.0, 1.0]), 0.0
    ),
    "turning": PostureTarget(
        np.array([[0.1, 0.12, 0.0], [0.0, -0.1, 0.0]]), np.array([0.3, -0.1]), np.array([0.04, 0.0, 0.97]), 0.1
    ),
}


@pytest.mark.parametrize("target", TARGETS.values(), ids=TARGETS)
def test_the_posture_is_reached_within_the_limits(robot, target):
    result = robot.ik().solve(target, robot.standing)
    assert result.reached
    assert result.error <= 1e-7
    assert_fulfilled(robot, result.q, target, 2e-7)


def test_it_does_not_depend_on_the_place(robot):
    turn, shift = 1.2, np.array([100.0, -50.0, 3.0])
    frame = pin.SE3(pin.utils.rotate("z", turn), shift)
    moved = PostureTarget(
        np.array([frame.act(p) for p in STANCE.sole_position]), STANCE.sole_yaw + turn, frame.act(STANCE.com), turn
    )
    q = robot.standing.copy()
    q[:7] = pin.SE3ToXYZQUAT(frame * pin.XYZQUATToSE3(q[:7]))
    result = robot.ik().solve(moved, q)
    assert result.reached
    np.testing.assert_allclose(result.q[7:], robot.standing[7:], atol=1e-5)


def test_out_of_reach_is_said_and_nearly_stretched(robot):
    high = replace(STANCE, com=np.array([0.0, 0.0, 1.2]))
    result = robot.ik().solve(high, robot.standing)
    assert not result.reached
    assert 0.01 < result.error < 0.3
    assert (result.q[7:] >= robot.limits.lower - 1e-9).all()
    assert (result.q[7:] <= robot.limits.upper + 1e-9).all()


def test_its_jacobian_is_the_derivative_of_its_error(robot):
    """At a solution the error of every task falls as the Jacobian says."""
    ik, h = robot.ik(), 1e-6
    J, error = ik.linearise(STANCE, robot.standing)
    np.testing.assert_allclose(error, 0.0, atol=1e-7)
    for i in range(robot.nv):
        step = np.zeros(robot.nv)
        step[i] = h
        ahead = ik.linearise(STANCE, pin.integrate(robot.model, robot.standing, step))[1]
        behind = ik.linearise(STANCE, pin.integrate(robot.model, robot.standing, -step))[1]
        np.testing.assert_allclose((behind - ahead) / (2 * h), J[:, i], atol=1e-6)


def test_soles_lie_on_ground_that_is_tilted(robot):
    tilt = np.array([[-0.2, 0.0], [-0.15, 0.1]])
    result = robot.ik().solve(replace(STANCE, com=np.array([0.0, 0.0, 0.95]), sole_tilt=tilt), robot.standing)
    assert result.reached
    data = robot.model.createData()
    pin.framesForwardKinematics(robot.model, data, result.q)
    for name, (pitch, roll) in zip(robot.frames.soles, tilt, strict=True):
        normal = data.oMf[robot.model.getFrameId(name)].rotation[:, 2]
        np.testing.assert_allclose(
            normal, (pin.utils.rotate("y", pitch) @ pin.utils.rotate("x", roll))[:, 2], atol=1e-6
        )


def test_hips_of_small_range_stand_on_one_foot_with_a_pelvis_that_rolls(robot):
    lower = robot.limits.lower.copy()
    for side in ("left", "right"):
        lower[robot.model.getJointId(f"{side}_hip_roll") - 2] = -0.05
    ik = PostureIk(robot.model, robot.frames, replace(robot.limits, lower=lower), robot.nominal)
    target = replace(STANCE, com=np.array([0.0, 0.1, 0.97]))
    assert not ik.solve(target, robot.standing).reached
    rolled = ik.solve(replace(target, rolling=True), robot.standing)
    assert rolled.reached
    assert 2.0 * abs(rolled.q[3]) > 0.01  # the pelvis; the torso is upright
