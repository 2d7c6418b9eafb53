"""The deviations of an estimate, against the covariance that finite differences carry over."""

import numpy as np
import pinocchio as pin
import pytest

from surefoot.readings import Reading
from surefoot.wbc.estimation.contact import SoleContact
from surefoot.wbc.estimation.doubt import Doubt
from surefoot.wbc.estimation.footing import ImuMount
from surefoot.wbc.estimation.kinematics import SensedBody, supporting
from surefoot.wbc.estimation.parameters import ContactDetection, SensorNoise
from surefoot.wbc.estimation.stand import AXES, OFFSETS, POSITION, TURN, VELOCITY, Stand

pytestmark = pytest.mark.unit

TURNED = tuple(map(tuple, pin.exp3(np.array([0.3, -0.2, 0.9])).tolist()))
MOUNTS = [ImuMount(), ImuMount(None, (0.05, 0.01, -0.08), TURNED), ImuMount("torso", (0.02, 0.03, 0.2), TURNED)]
SURE = SensorNoise(encoder_offset=0.0, wrench_bias=0.0)


class Case:
    """A robot with its joints anywhere, a state of the filter, and any covariance of its error."""

    def __init__(self, robot, mount, sensors, rate_noise, spread=1e-3):
        self.robot, self.mount, rng = robot, mount, np.random.default_rng(4)
        self.q = pin.integrate(robot.model, robot.standing, 0.3 * rng.normal(size=robot.nv))[7:]
        self.body = SensedBody(robot.model, robot.frames.soles, mount)
        self.m = len(self.body.chain)
        self.offsets = np.concatenate((0.01 * rng.normal(size=self.m), 0.1 * rng.normal(size=AXES)))
        self.R, columns = pin.exp3(rng.normal(size=3)), rng.normal(size=(4, 3))
        self.p, still = columns[1], np.zeros(3)
        root = spread * rng.normal(size=(27 + self.m + AXES,) * 2)
        # Of joints between the base and the IMU the law leaves out that they turn the base.
        between = np.zeros(robot.nv - 6, dtype=bool)
        if mount.body:
            carrier = robot.model.frames[robot.model.getFrameId(mount.body)].parentJoint
            between = supporting(robot.model, (carrier,))[0] > 0.0
        root[27 : 27 + self.m][between[self.body.chain]] = 0.0
        self.P = root @ root.T
        stand = Stand(self.R, columns, np.stack((np.eye(3),) * 2), still, still.copy(), self.offsets)
        self.doubt = Doubt(self.body, sensors, rate_noise, stand, self.P)
        self.body.update(self.q, self.R, self.offsets)
        self.body.offset_jacobians()

    def deviation(self, stance, gyro=0.0):
        contact, load = SoleContact(ContactDetection(), SURE, 981.0, (0.1, 0.05), 2e-3), np.zeros((2, 6))
        load[stance, 2] = 900.0
        contact.update(Reading(load, 0.0, True), (True, True), np.zeros(2))
        return self.doubt.deviation(contact, gyro)

    def placed(self, joints):
        """Places by Pinocchio in the base: the CoM, the soles' centres, and the pose of the IMU, of joints without
        offsets."""
        model, data = self.robot.model, self.robot.model.createData()
        com = pin.centerOfMass(model, data, np.concatenate((pin.neutral(model)[:7], joints)))
        pin.updateFramePlacements(model, data)
        soles = [data.oMf[model.getFrameId(name)].translation for name in self.robot.frames.soles]
        carrier = data.oMf[model.getFrameId(self.mount.body)] if self.mount.body else pin.SE3.Identity()
        return com, soles, carrier * pin.SE3(np.array(self.mount.rotation), np.array(self.mount.position))

    def seen(self, stance, error, more=0.0):
        """CoM over the stance sole, heights of the soles, one over the other, and the base's orientation, in the world.

        Of the state that is off by an error of the filter; `more` are offsets that it does not know of.
        """
        zeros, turn = error[OFFSETS], pin.exp3(error[TURN])
        joints = self.q - more
        joints[self.body.chain] -= (self.offsets + zeros)[: self.m]
        com, soles, imu = self.placed(joints)
        imu.rotation = imu.rotation @ pin.exp3(self.offsets[-AXES:]) @ pin.exp3(zeros[-AXES:])
        to_world, p = turn @ self.R @ imu.rotation.T, turn @ self.p + error[POSITION]
        heights = [(p + to_world @ (sole - imu.translation))[2] for sole in soles]
        return to_world @ (com - soles[stance]), np.array([*heights, heights[0] - heights[1]]), to_world


@pytest.mark.parametrize("stance", [0, 1])
@pytest.mark.parametrize("mount", MOUNTS)
def test_deviations_are_those_that_finite_differences_carry_over(robot, mount, stance):
    case, step, rows = Case(robot, mount, SURE, 0.0), 1e-6, []
    com, heights, base = case.seen(stance, np.zeros(len(case.P)))
    for i in range(len(case.P)):
        moved = case.seen(stance, step * np.eye(len(case.P))[i])
        rows.append(np.concatenate((moved[0] - com, moved[1] - heights, pin.log3(moved[2] @ base.T)[:2])) / step)
    J, sure = np.array(rows).T, case.deviation(stance)
    expected = np.sqrt(np.einsum("ij,jk,ik->i", J, case.P, J))
    np.testing.assert_allclose(sure.com, expected[:3], rtol=1e-4)
    np.testing.assert_allclose((*sure.sole_height, sure.step_height), expected[3:6], rtol=1e-4)
    np.testing.assert_allclose(sure.com_velocity, np.sqrt(np.diag(case.P)[VELOCITY]))
    np.testing.assert_allclose(sure.tilt, expected[6:], rtol=1e-4)
    # The other sole has another lever.
    assert np.abs(case.deviation(1 - stance).com - expected[:3]).max() > 0.01 * expected[:3].max()


@pytest.mark.parametrize("mount", MOUNTS)
def test_joints_that_the_filter_does_not_know_of_add_their_own_offsets_and_rates(robot, mount):
    """Encoders outside the chain are off by their data sheet; all joints' velocities move the CoM against the base."""
    off, noise, step = 2e-3, 0.03, 1e-6
    case = Case(robot, mount, SensorNoise(encoder_offset=off), noise, spread=0.0)
    com, _, to_world = case.seen(0, np.zeros(len(case.P)))
    place, speed = np.zeros(3), np.zeros(3)
    joints = case.q.copy()
    joints[case.body.chain] -= case.offsets[: case.m]
    for j in range(robot.nv - 6):
        one = step * np.eye(robot.nv - 6)[j]
        if j not in case.body.chain:
            place += (off * (case.seen(0, np.zeros(len(case.P)), one)[0] - com) / step) ** 2
        speed += (noise * to_world @ (case.placed(joints + one)[0] - case.placed(joints)[0]) / step) ** 2
    sure = case.deviation(0)
    np.testing.assert_allclose(sure.com, np.sqrt(place), rtol=1e-4)
    np.testing.assert_allclose(sure.com_velocity, np.sqrt(speed), rtol=1e-4)
    assert sure.com.max() > 0.0


def test_a_rate_that_is_not_known_moves_the_com_as_far_as_it_is_beside_its_axis(robot):
    case, gyro = Case(robot, ImuMount(), SURE, 0.0, spread=0.0), 0.02
    com, soles, _ = case.placed(case.q - np.bincount(case.body.chain, case.offsets[: case.m], len(case.q)))
    arm = case.R @ pin.exp3(-case.offsets[-AXES:]) @ com
    expected = [gyro * np.linalg.norm(np.cross(axis, arm)) for axis in np.eye(3)]
    np.testing.assert_allclose(case.deviation(0, gyro).com_velocity, expected, rtol=1e-9)
    assert len(soles) == 2
