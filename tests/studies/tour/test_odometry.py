"""The place of a robot by the feet that it stands on: exact where they stand still, whatever else moves."""

import numpy as np
import pinocchio as pin
import pytest

from surefoot.models.pinocchio import pinocchio_model
from surefoot.sim.measurement import Measurement
from surefoot.studies.tour.odometry import ContractOdometry
from surefoot.studies.tour.ride import Ride
from surefoot.studies.tour.rows import ROWS

pytestmark = pytest.mark.unit


@pytest.fixture(scope="module")
def walk():
    return ROWS["contract"].controller().walk


def standing(walk, rng, foot):
    """A state in which a sole stands still, flat, and the other one is higher."""
    model = pinocchio_model(walk.robot)
    data = model.createData()
    q = np.concatenate((np.zeros(6), [1.0], walk.robot.nominal_joint_positions))
    v = np.concatenate((np.zeros(6), rng.uniform(-0.5, 0.5, model.nv - 6)))
    legs = [walk.robot.joint_names.index(name) for name in ("left_knee_joint", "right_knee_joint")]
    q[7 + legs[1 - foot]] += 0.9
    frame = model.getFrameId(walk.robot.sole_sites[foot])
    pin.framesForwardKinematics(model, data, q)
    base = data.oMf[frame].inverse()
    q[:7] = pin.SE3ToXYZQUAT(pin.SE3(pin.utils.rotate("z", 0.7), np.array([3.0, 1.0, 0.0])) * base)
    pin.framesForwardKinematics(model, data, q)
    J = pin.computeFrameJacobian(model, data, q, frame, pin.ReferenceFrame.LOCAL)
    v[:6] = -np.linalg.solve(J[:, :6], J[:, 6:] @ v[6:])
    return q, v


@pytest.mark.parametrize("foot", [0, 1])
def test_the_speed_of_the_base_is_that_against_the_sole_that_stands(walk, foot):
    rng = np.random.default_rng(foot)
    for _ in range(10):
        q, v = standing(walk, rng, foot)
        state = ContractOdometry(walk).estimate(Measurement.of_state(0.0, q, v)).state
        assert state.v[:3] == pytest.approx(v[:3], abs=1e-6)
        assert state.q[2] == pytest.approx(q[2], abs=1e-6)
        assert np.array_equal(state.q[3:], q[3:]) and np.array_equal(state.v[3:], v[3:])


def test_the_place_goes_on_with_the_base_and_knows_not_where_it_began(walk):
    q, v = standing(walk, np.random.default_rng(5), 0)
    odometry, model = ContractOdometry(walk), pinocchio_model(walk.robot)
    first = odometry.estimate(Measurement.of_state(0.0, q, v)).state.q[:3].copy()
    told = q.copy()
    for _ in range(50):
        told = pin.integrate(model, told, 0.001 * v)
        blind = told.copy()
        blind[:3] = np.nan
        last = odometry.estimate(Measurement.of_state(0.0, blind, v)).state.q[:3]
    assert last - first == pytest.approx(told[:3] - q[:3], abs=0.003)
    assert np.linalg.norm(last - first) > 0.005


def test_it_follows_a_robot_that_marches():
    ride, errors = Ride(ROWS["arms"], 2), []
    odometry = ContractOdometry(ride.walker.controller.walk)
    while ride.world.time < 2.0:
        ride.step()
        errors.append(odometry.estimate(ride.world.contracted()).state.v[:3] - ride.world.measure().v[:3])
    assert np.sqrt(np.mean(np.square(errors))) < 0.03
