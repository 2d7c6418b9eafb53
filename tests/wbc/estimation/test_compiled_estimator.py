"""The estimator's kernels against plain Python, apart from any walk."""

import numpy as np
import pinocchio as pin
import pytest
from needs import KERNELS

from surefoot.native.library import VARIABLE
from surefoot.readings import Reading, Readings
from surefoot.wbc.estimation.contact import SoleContact
from surefoot.wbc.estimation.doubt import Doubt
from surefoot.wbc.estimation.estimator import SensedState
from surefoot.wbc.estimation.invariant_filter import InvariantFilter
from surefoot.wbc.estimation.kinematics import Footing, ImuMount, SensedBody
from surefoot.wbc.estimation.parameters import ContactDetection, EstimatorParameters, GroundNoise, SensorNoise
from surefoot.wbc.estimation.stand import Stand

pytestmark = pytest.mark.unit

TURNED = tuple(map(tuple, pin.exp3(np.array([0.3, -0.2, 0.9])).tolist()))
MOUNTS = [ImuMount(), ImuMount(None, (0.05, 0.01, -0.08), TURNED), ImuMount("torso", (0.02, 0.03, 0.2), TURNED)]


@pytest.mark.parametrize("stance", [0, 1])
@pytest.mark.parametrize("mount", MOUNTS)
def test_kernels_see_soles_and_doubt_as_plain_python_does(robot, monkeypatch, mount, stance):
    """Of an IMU wherever it is, with all joints away from where they stand, and any covariance."""
    KERNELS.or_skip()
    rng, found = np.random.default_rng(stance), []
    q = pin.integrate(robot.model, robot.standing, 0.3 * rng.normal(size=robot.nv))
    spread = rng.normal(size=(27 + robot.nv, 27 + robot.nv))
    turn = 0.1 * rng.normal(size=3)
    rotations = [pin.exp3(rng.normal(size=3)) for _ in range(3)]
    columns, contact = rng.normal(size=(4, 3)), SoleContact(ContactDetection(), SensorNoise(), 981.0, (0.1, 0.05), 2e-3)
    load = np.zeros((2, 6))
    load[stance, 2] = 900.0
    contact.update(Reading(load, 0.0, True), (True, True), np.zeros(2))
    for variable in ("", "0"):
        monkeypatch.setenv(VARIABLE, variable)
        body = SensedBody(robot.model, robot.frames.soles, mount)
        still, offsets = np.zeros(3), np.concatenate((0.1 * np.ones(len(body.chain)), turn))
        stand = Stand(rotations[0].copy(), columns.copy(), np.stack(rotations[1:]), still, still, offsets)
        filter_ = InvariantFilter(stand, SensorNoise(), GroundNoise())
        some = 1e-3 * spread[: len(filter_.P)]
        filter_.P[:] = some @ some.T
        body.update(q[7:], np.eye(3), offsets)
        J = body.offset_jacobians()
        doubt = Doubt(body, SensorNoise(), 0.01).deviation(filter_, contact, 0.02, J)
        assert (body.compiled is None) == (variable == "0")
        numbers = doubt.com, doubt.com_velocity, doubt.tilt, doubt.sole_height, (doubt.step_height, doubt.force)
        found.append((body.position, body.rotation, J, np.concatenate((*numbers, (doubt.moment,)))))
    for compiled, plain in zip(*found, strict=True):
        np.testing.assert_allclose(compiled, plain, rtol=1e-10, atol=1e-13)


@pytest.mark.parametrize("lost", ["joints", "rate"])
@pytest.mark.parametrize("variable", ["", "0"])
def test_first_readings_that_are_not_finite_make_a_state_that_is_not(robot, monkeypatch, variable, lost):
    """The controller says so then, in a sentence."""
    monkeypatch.setenv(VARIABLE, variable)
    said = {"joints": robot.standing[7:].copy(), "rate": np.zeros(3), "force": np.array([0.0, 0.0, 9.81])}
    said[lost][0] = np.nan
    load = np.zeros((2, 6))
    load[:, 2] = 490.0
    joints, rate, force, torque, wrench = (
        Reading(values, 0.0, True) for values in (*said.values(), np.zeros(robot.nv - 6), load)
    )
    feet = np.array([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]])
    footing = Footing(feet, np.zeros(2), (0.1, 0.05), lambda x, y: 0.0, lambda x, y: np.array([0.0, 0.0, 1.0]))
    estimator = SensedState(robot.model, robot.frames.soles, ImuMount(), footing, 2e-3, EstimatorParameters())
    state = estimator.sense(Readings(0.0, joints, None, torque, rate, rate, force, wrench)).state
    assert not np.isfinite(state.q).all() or not np.isfinite(state.v).all()
