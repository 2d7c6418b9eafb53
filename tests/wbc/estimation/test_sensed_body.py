"""Kinematics from an IMU that may sit anywhere."""

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from surefoot.wbc.estimation.footing import ImuMount
from surefoot.wbc.estimation.kinematics import SensedBody
from surefoot.wbc.estimation.stand import AXES

pytestmark = pytest.mark.unit

TURNED = tuple(map(tuple, pin.exp3(np.array([0.3, -0.2, 0.9])).tolist()))
MOUNTS = [ImuMount(), ImuMount(None, (0.05, 0.01, -0.08), TURNED), ImuMount("torso", (0.02, 0.03, 0.2), TURNED)]


def moving(robot, seed=1):
    rng = np.random.default_rng(seed)
    q = pin.integrate(robot.model, robot.standing, 0.3 * rng.normal(size=robot.nv))
    return q, rng.normal(size=robot.nv)


def imu(robot, mount, q, v):
    """Pose and velocity of an IMU in the world, by Pinocchio."""
    model, data = robot.model, robot.model.createData()
    pin.forwardKinematics(model, data, q, v)
    joint, placement = 1, pin.SE3(np.array(mount.rotation), np.array(mount.position))
    if mount.body:
        frame = model.frames[model.getFrameId(mount.body)]
        joint, placement = frame.parentJoint, frame.placement * placement
    return data.oMi[joint] * placement, placement.actInv(data.v[joint])


def turned(mount, by):
    """An IMU that is mounted wrongly, turned by that about its own axes."""
    return replace(mount, rotation=tuple(map(tuple, (np.array(mount.rotation) @ pin.exp3(by)).tolist())))


@pytest.mark.parametrize("mount", MOUNTS)
def test_soles_and_their_jacobians_are_those_of_finite_differences(robot, mount):
    q, _ = moving(robot)
    body, step = SensedBody(robot.model, robot.frames.soles, mount), 1e-6
    body.update(q[7:], np.eye(3))
    J, position, rotation = body.offset_jacobians(), body.position.copy(), body.rotation.copy()
    legs = 12
    assert len(body.chain) == legs + (mount.body is not None) * (len(body.chain) - legs)
    for column, joint in enumerate(body.chain):
        moved = q[7:].copy()
        moved[joint] += step
        body.update(moved, np.eye(3))
        for k in (0, 1):
            np.testing.assert_allclose((body.position[k] - position[k]) / step, J[k, :3, column], atol=2e-6)
            turn = pin.log3(body.rotation[k] @ rotation[k].T) / step
            np.testing.assert_allclose(turn, J[k, 3:, column], atol=2e-6)
    # What is known of an offset is taken off.
    for column in range(len(body.chain) + AXES):
        offsets = np.zeros(len(body.chain) + AXES)
        offsets[column] = step
        body.update(q[7:], np.eye(3), offsets)
        for k in (0, 1):
            np.testing.assert_allclose((position[k] - body.position[k]) / step, J[k, :3, column], atol=2e-6)
            turn = pin.log3(rotation[k] @ body.rotation[k].T) / step
            np.testing.assert_allclose(turn, J[k, 3:, column], atol=2e-6)
    # Joints that are not in the chain move no sole against the IMU.
    others = np.setdiff1d(np.arange(robot.nv - 6), body.chain)
    moved = q[7:].copy()
    moved[others] += 0.1
    body.update(moved, np.eye(3))
    np.testing.assert_allclose(body.position, position, atol=1e-12)


@pytest.mark.parametrize("mount", MOUNTS)
def test_soles_are_seen_from_where_the_imu_is_known_to_look(robot, mount):
    """An IMU that is mounted wrongly sees them as one whose mount is right and says so."""
    (q, _), by = moving(robot), np.array([0.1, -0.2, 0.15])
    known, right = (SensedBody(robot.model, robot.frames.soles, each) for each in (mount, turned(mount, by)))
    known.update(q[7:], np.eye(3), np.concatenate((np.zeros(len(known.chain)), by)))
    right.update(q[7:], np.eye(3))
    np.testing.assert_allclose(known.position, right.position, atol=1e-12)
    np.testing.assert_allclose(known.rotation, right.rotation, atol=1e-12)
    np.testing.assert_allclose(known.offset_jacobians(), right.offset_jacobians(), atol=1e-12)


@pytest.mark.parametrize("k", [0, 1])
@pytest.mark.parametrize("mount", MOUNTS)
def test_the_com_is_seen_from_a_sole_where_it_is(robot, mount, k):
    q, _ = moving(robot)
    body = SensedBody(robot.model, robot.frames.soles, mount)
    body.update(q[7:], np.eye(3))
    body.offset_jacobians()
    body.place_com()
    model, data = robot.model, robot.model.createData()
    pose, _ = imu(robot, mount, q, np.zeros(robot.nv))
    com = pin.centerOfMass(model, data, q)
    sole = pin.updateFramePlacement(model, data, model.getFrameId(robot.frames.soles[k])).translation
    np.testing.assert_allclose(pose.rotation @ body.com_from(body.in_base(k)), com - sole, atol=1e-9)


def test_a_frame_that_is_not_there_is_refused(robot):
    with pytest.raises(ValueError, match="no frame 'elbow'"):
        SensedBody(robot.model, robot.frames.soles, ImuMount("elbow"))


@pytest.mark.parametrize("mount", MOUNTS[:2])
def test_a_turn_of_the_base_is_that_of_an_imu_that_no_joint_parts_from_it(robot, mount):
    body, turn = SensedBody(robot.model, robot.frames.soles, mount), np.array([0.1, -0.2, 0.3])
    assert np.allclose(body.turned_to_imu(tuple(turn)), np.array(mount.rotation).T @ turn)
    assert not body.behind and SensedBody(robot.model, robot.frames.soles, MOUNTS[2]).behind


def test_turning_inertia_is_what_spinning_makes_of_moment_of_momentum(robot):
    body, data = SensedBody(robot.model, robot.frames.soles, ImuMount()), robot.model.createData()
    body.update(robot.standing[7:], np.eye(3))
    whole, joints = body.turning_inertia()
    q = np.concatenate((pin.neutral(robot.model)[:7], robot.standing[7:]))
    spun = np.eye(robot.nv)[3:5] + 0.0
    found = [np.linalg.norm(pin.computeCentroidalMomentum(robot.model, data, q, v).angular[:2]) for v in spun]
    assert whole == pytest.approx(max(found), rel=0.05)
    # A random motion of the joints alone has that as its standard deviation, about the axis that has more.
    rng, spins = np.random.default_rng(2), []
    for _ in range(4000):
        v = np.concatenate((np.zeros(6), rng.normal(size=robot.nv - 6)))
        spins.append(pin.computeCentroidalMomentum(robot.model, data, q, v).angular[:2].copy())
    assert joints == pytest.approx(np.std(spins, axis=0).max(), rel=0.05)


@pytest.mark.parametrize("mount", MOUNTS)
@pytest.mark.parametrize("lean", [0.0, -0.3])
def test_soles_that_lean_are_seen_at_their_lines_which_move_with_them(robot, mount, lean):
    """Lines are where they are while a sole turns about them; elsewhere a sole's Jacobian is that of its centre."""
    q, _ = moving(robot)
    half, step = 0.04, 1e-6
    body, centre = (SensedBody(robot.model, robot.frames.soles, mount, leaning) for leaning in (half, None))
    pose, _ = imu(robot, mount, q, np.zeros(robot.nv))
    attitude = pin.exp3(np.array([lean, 0.0, 0.0])) @ pose.rotation
    body.update(q[7:], attitude)
    centre.update(q[7:], attitude)
    beside = np.einsum("kji,kj->ki", centre.rotation, body.position - centre.position)
    np.testing.assert_allclose(beside[:, [0, 2]], 0.0, atol=1e-12)
    assert (np.abs(beside[:, 1]) <= half + 1e-12).all() and np.abs(beside[:, 1]).max() > 0.9 * half
    if lean:  # on the side that is lower
        assert ((body.position - centre.position) @ attitude[2] < -0.5 * half * np.sin(abs(lean))).all()
    J, place = body.offset_jacobians(), body.position.copy()
    levers = []
    for each in (body, centre):
        each.offset_jacobians()
        each.place_com()
        levers.append(np.array(each.com_from(each.in_base(0))))
    np.testing.assert_allclose(levers[0] - levers[1], centre.position[0] - place[0], atol=1e-12)
    for column, joint in enumerate(body.chain):
        moved = q[7:].copy()
        moved[joint] += step
        centre.update(moved, attitude)
        for k in (0, 1):
            found = (centre.position[k] + centre.rotation[k] @ beside[k] - place[k]) / step
            np.testing.assert_allclose(J[k, :3, column], found, atol=2e-6)


@pytest.mark.parametrize("mount", MOUNTS)
def test_soles_that_roll_are_seen_at_their_edges_which_stay_while_they_turn_about_them(robot, mount):
    q, _ = moving(robot)
    step, ahead = 1e-6, np.array([0.11, -0.09])
    body, centre = (SensedBody(robot.model, robot.frames.soles, mount) for _ in range(2))
    body.ahead[:] = ahead
    body.update(q[7:], np.eye(3))
    centre.update(q[7:], np.eye(3))
    np.testing.assert_allclose(body.position - centre.position, ahead[:, None] * centre.rotation[:, :, 0], atol=1e-15)
    J, place = body.offset_jacobians().copy(), body.position.copy()
    K = centre.offset_jacobians()
    assert np.abs(J - K).max() > 0.05
    for column, joint in enumerate(body.chain):
        moved = q[7:].copy()
        moved[joint] += step
        body.update(moved, np.eye(3))
        for k in (0, 1):
            np.testing.assert_allclose((body.position[k] - place[k]) / step, J[k, :3, column], atol=2e-6)
    np.testing.assert_array_equal(J[:, 3:], K[:, 3:])
