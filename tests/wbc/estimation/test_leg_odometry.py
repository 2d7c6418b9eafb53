"""The state by attitude, turning, joints and torques alone: feet that stand tell it, feet that slide are doubted."""

import numpy as np
import pinocchio as pin
import pytest

from surefoot.models.options import RobotOptions
from surefoot.models.pinocchio import pinocchio_model
from surefoot.models.registry import describe
from surefoot.wbc.estimation.leg_odometry import LegOdometry
from surefoot.wbc.estimation.velocity import CentroidalVelocity

pytestmark = pytest.mark.unit

PERIOD = 0.02


@pytest.fixture(scope="module")
def robot():
    return describe("g1", RobotOptions())


@pytest.fixture
def odometry(robot):
    half_size = 0.5 * robot.sole_length, 0.5 * robot.sole_width
    return LegOdometry(pinocchio_model(robot), robot.sole_sites, half_size, PERIOD)


def on_a_foot(robot, rng, foot, slip=(0.0, 0.0, 0.0)):
    """A state in which a sole lies flat and moves by a velocity, and the other one is higher."""
    model = pinocchio_model(robot)
    data = model.createData()
    q = np.concatenate((np.zeros(6), [1.0], robot.nominal_joint_positions))
    v = np.concatenate((np.zeros(6), rng.uniform(-0.5, 0.5, model.nv - 6)))
    q[7 + robot.joint_names.index(("right", "left")[foot] + "_knee_joint")] += 0.9
    frame = model.getFrameId(robot.sole_sites[foot])
    pin.framesForwardKinematics(model, data, q)
    q[:7] = pin.SE3ToXYZQUAT(pin.SE3(pin.utils.rotate("z", 0.7), np.array([3.0, 1.0, 0.0])) * data.oMf[frame].inverse())
    pin.framesForwardKinematics(model, data, q)
    J = pin.computeFrameJacobian(model, data, q, frame, pin.ReferenceFrame.LOCAL)
    R = data.oMf[frame].rotation
    v[:6] = np.linalg.solve(J[:, :6], np.concatenate((R.T @ slip, np.zeros(3))) - J[:, 6:] @ v[6:])
    return q, v


@pytest.mark.parametrize("foot", [0, 1])
def test_the_first_velocity_is_that_against_the_sole_that_stands(robot, foot):
    rng = np.random.default_rng(foot)
    for _ in range(5):
        half_size = 0.5 * robot.sole_length, 0.5 * robot.sole_width
        odometry = LegOdometry(pinocchio_model(robot), robot.sole_sites, half_size, PERIOD)
        q, v = on_a_foot(robot, rng, foot)
        state = odometry.sense(0.0, q, v, np.zeros(len(q) - 7)).state
        assert state.v[:3] == pytest.approx(v[:3], abs=1e-6)
        assert np.array_equal(state.q[3:], q[3:]) and np.array_equal(state.v[3:], v[3:])


def test_place_and_velocity_of_the_base_are_not_looked_at(robot, odometry):
    q, v = on_a_foot(robot, np.random.default_rng(2), 0)
    q[:3] = v[:3] = np.nan
    for tick in range(3):
        estimate = odometry.sense(PERIOD * tick, q, v, np.zeros(len(q) - 7))
        assert np.isfinite(estimate.state.q).all() and np.isfinite(estimate.state.v).all()
        assert np.isfinite(estimate.deviation.com_velocity).all()


def ticks(velocity, count, by_feet, deviations=(0.015, 0.015), bearing=(1.0, 0.0), acceleration=(0.0, 0.0, 0.0)):
    along_axes = np.repeat(np.array(deviations)[:, None], 3, axis=1)
    for _ in range(count):
        velocity.predict(np.array(acceleration), PERIOD)
        velocity.correct(np.array(by_feet, dtype=float), along_axes, np.array(bearing), PERIOD)
    return velocity


def test_a_foot_that_stands_is_believed():
    velocity = ticks(CentroidalVelocity(np.zeros(3), 0.1), 10, [[0.3, 0.1, 0.0]] * 2)
    assert velocity.mean == pytest.approx((0.3, 0.1, 0.0), abs=0.01)
    assert velocity.standing[0] > 0.99 and np.sqrt(velocity.covariance[0, 0]) < 0.03


def test_a_foot_that_slides_as_it_lands_is_not():
    still = ticks(CentroidalVelocity(np.zeros(3), 0.1), 10, np.zeros((2, 3)))
    # The left foot stands on; the right one lands, turns and slides.
    ticks(still, 2, [[0.0, 0.0, 0.0], [0.8, 0.0, 0.0]], (0.015, 0.15), (1.0, 1.0))
    assert np.linalg.norm(still.mean) < 0.02 and still.standing[1] < 0.05


def test_one_foot_that_is_thrown_about_is_outweighed_by_the_forces():
    velocity = ticks(CentroidalVelocity(np.zeros(3), 0.1), 10, np.zeros((2, 3)))
    ticks(velocity, 1, [[0.8, 0.0, 0.0]] * 2, (0.2, 0.2))
    assert np.linalg.norm(velocity.mean) < 0.2
    assert np.sqrt(velocity.covariance[0, 0]) > 0.03


def test_a_push_is_followed_where_the_foot_stands():
    velocity = ticks(CentroidalVelocity(np.zeros(3), 0.1), 10, np.zeros((2, 3)))
    for tick in range(1, 5):
        ticks(velocity, 1, [[0.15 * tick, 0.0, 0.0]] * 2)
    assert velocity.mean[0] == pytest.approx(0.6, abs=0.03) and velocity.pushed > 0.5


def test_two_feet_that_agree_outweigh_the_forces():
    velocity = ticks(CentroidalVelocity(np.array([1.5, 0.0, 0.0]), 0.05), 1, np.zeros((2, 3)), bearing=(1.0, 1.0))
    assert velocity.mean[0] == pytest.approx(0.0, abs=0.05)


def test_in_flight_forces_alone_are_followed():
    velocity = ticks(CentroidalVelocity(np.zeros(3), 0.1), 10, np.zeros((2, 3)))
    ticks(velocity, 5, [[3.0, -2.0, 1.0], [-4.0, 2.0, 0.0]], (0.5, 0.5), (0.0, 0.0), (0.0, 0.0, -9.81))
    assert velocity.mean == pytest.approx((0.0, 0.0, -0.981), abs=0.3)


def test_the_covariance_is_that_of_the_errors():
    """Normalised squared errors of two axes have the mean 2, of draws from the model of the filter itself."""
    rng, found = np.random.default_rng(4), []
    for _ in range(60):
        true = rng.normal(0.0, 0.1, 3)
        velocity = CentroidalVelocity(np.zeros(3), 0.1)
        for _ in range(25):
            gained = rng.normal(0.0, 1.0, 3)
            true += PERIOD * (gained + rng.normal(0.0, (1.0, 1.0, 3.0)))
            velocity.predict(gained, PERIOD)
            seen = true + rng.normal(0.0, 0.1, (2, 3))
            if rng.random() < 0.06:
                seen[1] += rng.normal(0.0, 0.7, 3)
            velocity.correct(seen, np.full((2, 3), 0.1), np.array([1.0, 1.0]), PERIOD)
            off = (velocity.mean - true)[:2]
            found.append(off @ np.linalg.solve(velocity.covariance[:2, :2], off))
    assert 1.4 < np.mean(found) < 2.6
