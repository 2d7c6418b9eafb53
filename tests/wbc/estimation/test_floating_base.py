"""The state of a robot now by an IMU that is fixed to its base."""

import numpy as np
import pinocchio as pin
import pytest

from surefoot.wbc.estimation.base import FARTHEST, FASTEST, FloatingBase
from surefoot.wbc.estimation.kinematics import ImuMount, SensedBody
from surefoot.wbc.estimation.stand import AXES, Stand

pytestmark = pytest.mark.unit

TURNED = tuple(map(tuple, pin.exp3(np.array([0.3, -0.2, 0.9])).tolist()))
LATE = 0.006


def seen(robot, mount, q, v, rng):
    """A state of the filter and the reading of a gyroscope, by Pinocchio, with all that a filter finds; and the joints.

    The IMU is turned on its mount, its gyroscope has a bias, and the zeros of the encoders are off.
    """
    data = robot.model.createData()
    pin.forwardKinematics(robot.model, data, q, v)
    by, bias = 0.1 * rng.normal(size=AXES), 0.1 * rng.normal(size=3)
    placement = pin.SE3(np.array(mount.rotation) @ pin.exp3(by), np.array(mount.position))
    pose, motion = data.oMi[1] * placement, placement.actInv(data.v[1])
    body = SensedBody(robot.model, robot.frames.soles, mount)
    zeros, joints = 1e-3 * rng.normal(size=len(body.chain)), q[7:].copy()
    joints[body.chain] += zeros
    columns = np.vstack((pose.rotation @ motion.linear, pose.translation, np.zeros((2, 3))))
    offsets = np.concatenate((zeros, by))
    stand = Stand(pose.rotation.copy(), columns, np.zeros((2, 3, 3)), bias, np.zeros(3), offsets)
    return FloatingBase(stand, body.mount, body.chain, motion.angular + bias, len(joints)), stand, joints


@pytest.mark.parametrize("turned", [0.1, 2.5, 3.1])
@pytest.mark.parametrize("axis", [(0.6, 0.0, 0.8), (1.0, 0.0, 0.0), (0.0, 1.0, 0.1)])
@pytest.mark.parametrize("mount", [ImuMount(), ImuMount(None, (0.05, 0.01, -0.08), TURNED)])
def test_the_base_is_where_it_has_come_to(robot, mount, axis, turned):
    """As by Pinocchio; with late readings gone on evenly by what it is planned to gain."""
    rng = np.random.default_rng(3)
    q = pin.integrate(robot.model, robot.standing, 0.3 * rng.normal(size=robot.nv))
    q[3:7] = pin.Quaternion(pin.exp3(turned * np.array(axis) / np.linalg.norm(axis))).coeffs()
    v, gained = rng.normal(size=robot.nv), rng.normal(size=6)
    base, _, joints = seen(robot, mount, q, v, rng)
    for given, way in ((None, np.zeros(6)), (gained, LATE * (v[:6] + 0.5 * gained))):
        state = base.state(joints, v[6:], given, LATE)
        before, found = pin.XYZQUATToSE3(q[:7]), pin.XYZQUATToSE3(state.q[:7])
        half = before.rotation @ pin.exp3(0.5 * way[3:])
        np.testing.assert_allclose(found.translation, before.translation + half @ way[:3], atol=1e-12)
        np.testing.assert_allclose(found.rotation, before.rotation @ pin.exp3(way[3:]), atol=1e-12)
        np.testing.assert_allclose(state.v[:6], v[:6] + (0.0 if given is None else gained), atol=1e-12)
        np.testing.assert_allclose(state.q[7:], q[7:], atol=1e-15)
        np.testing.assert_array_equal(state.v[6:], v[6:])


def test_a_state_is_its_own_and_none_of_one_that_has_diverged(robot):
    rng = np.random.default_rng(4)
    q, v = robot.standing.copy(), np.zeros(robot.nv)
    base, stand, joints = seen(robot, ImuMount(), q, v, rng)
    first = base.state(joints, v[6:], None, 0.0)
    kept = first.q.copy()
    stand.columns[1] += 1.0
    second = base.state(joints, v[6:], None, 0.0)
    np.testing.assert_array_equal(first.q, kept)
    np.testing.assert_allclose(second.q[:3], kept[:3] + 1.0, atol=1e-12)
    fast, limit = v[6:].copy(), np.sqrt(FASTEST**2 - second.v[:6] @ second.v[:6])
    fast[0] = 0.999 * limit
    assert base.state(joints, fast, None, 0.0) is not None
    fast[0] = 1.001 * limit
    assert base.state(joints, fast, None, 0.0) is None
    for lost in (1.001 * FARTHEST, np.nan):
        stand.columns[1, 0] = lost
        assert base.state(joints, v[6:], None, 0.0) is None
