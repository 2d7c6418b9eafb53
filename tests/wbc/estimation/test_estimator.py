"""The estimator as a whole, apart from any walk."""

import numpy as np
import pinocchio as pin
import pytest

from surefoot.readings import Reading, Readings
from surefoot.wbc.estimation.estimator import SensedState
from surefoot.wbc.estimation.footing import Footing, ImuMount
from surefoot.wbc.estimation.parameters import EstimatorParameters, GroundNoise
from surefoot.wbc.types import GRAVITY

pytestmark = pytest.mark.unit


PERIOD = 2e-3


class Standing:
    """A robot that stands still under its estimator."""

    def __init__(self, robot, parameters=None):
        feet, up = np.array([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]]), np.array([0.0, 0.0, 1.0])
        footing = Footing(feet, np.zeros(2), (0.1, 0.05), lambda x, y: 0.0, lambda x, y: up)
        names, parameters = robot.frames.soles, parameters or EstimatorParameters()
        self.inner = SensedState(robot.model, names, ImuMount(), footing, PERIOD, parameters)
        self.count, self.joints, self.tick = robot.nv - 6, robot.standing[7:].copy(), -1
        self.rate, self.force = np.zeros(3), GRAVITY * up

    def sense(self, share=0.5, fresh=True):
        """The estimate of the next tick, with a share of the weight on the left foot, encoders fresh or not."""
        load = np.zeros((2, 6))
        load[:, 2] = 980.0 * share, 980.0 * (1.0 - share)
        load[:, 3] = 5.0 * share, -7.0 * share
        self.tick += 1
        encoders = Reading(self.joints, 0.0, fresh)
        torque, rate, force, wrench = (
            Reading(values, 0.0, True) for values in (np.zeros(self.count), self.rate, self.force, load)
        )
        return self.inner.sense(Readings(PERIOD * self.tick, encoders, None, torque, rate, rate, force, wrench))


def test_standing_soles_sink_by_all_that_their_loads_change(robot):
    """Springs give by the change of the wrench over any time, in however many ticks it came."""
    standing, give = Standing(robot), GroundNoise().depth / (GRAVITY * sum(i.mass for i in robot.model.inertias))
    for _ in range(6):
        first = standing.sense().wrench
    state = standing.inner.filter.stand
    place, turn = state.d.copy(), state.Z.copy()
    for share in np.repeat(np.linspace(0.5, 0.7, 8), 5):
        # Without encoders nothing else moves the soles.
        last = standing.sense(share, fresh=False).wrench
    changed = last - first
    assert np.abs(changed[:, 2]).min() > 50.0
    np.testing.assert_allclose(state.d[:, 2] - place[:, 2], -give * changed[:, 2], rtol=1e-9)
    for k in (0, 1):
        rolled = pin.log3(state.Z[k] @ turn[k].T)
        assert rolled[0] == pytest.approx(-give * changed[k, 3] / 0.05**2, rel=1e-6)


@pytest.mark.parametrize("made", [list, np.float32])
def test_values_of_any_kind_of_number_are_taken(robot, made):
    """As those of other plants are."""
    plain, other = Standing(robot), Standing(robot)
    plain.joints = plain.joints.astype(np.float32).astype(float)
    other.joints = made(plain.joints)
    np.testing.assert_array_equal(other.sense().state.q, plain.sense().state.q)


@pytest.mark.parametrize("name", ["joint_position", "angular_velocity", "specific_force"])
def test_values_of_another_shape_are_refused_with_the_name_of_the_reading(robot, name):
    standing = Standing(robot)
    standing.sense()
    own = {"joint_position": "joints", "angular_velocity": "rate", "specific_force": "force"}[name]
    setattr(standing, own, getattr(standing, own)[:-1])
    with pytest.raises(ValueError, match=f"reading '{name}' has values of shape"):
        standing.sense()


@pytest.mark.parametrize("lost", ["joints", "rate"])
def test_first_readings_that_are_not_finite_make_a_state_that_is_not(robot, lost):
    """The controller says so then, in a sentence."""
    standing = Standing(robot)
    {"joints": standing.joints, "rate": standing.rate}[lost][0] = np.nan
    state = standing.sense().state
    assert not np.isfinite(state.q).all() or not np.isfinite(state.v).all()


@pytest.mark.parametrize("velocity", [True, False], ids=["with velocities", "without"])
def test_torques_that_come_every_other_tick_count_once(robot, velocity):
    """Wrenches by torques are new when torques are; held readings only make them older, by as much as they are."""
    standing, rng = Standing(robot), np.random.default_rng(4)
    data = robot.model.createData()
    gravity = pin.computeGeneralizedGravity(robot.model, data, robot.standing)[6:]
    found, ages, joints = [], [], standing.joints
    for tick in range(40):
        age = PERIOD * (tick % 2)
        if tick % 2 == 0:
            torque, joints = gravity + rng.normal(size=standing.count), joints + 1e-5 * rng.normal(size=standing.count)
        speed = Reading(np.zeros(standing.count), age, age == 0.0) if velocity else None
        late = (Reading(values, age, age == 0.0) for values in (joints, torque))
        rate, force = Reading(np.zeros(3), 0.0, True), Reading(np.array([0.0, 0.0, GRAVITY]), 0.0, True)
        encoders, motors = late
        estimate = standing.inner.sense(Readings(PERIOD * tick, encoders, speed, motors, rate, rate, force, None))
        found.append(estimate.wrench.copy())
        ages.append(estimate.wrench_age)
    found, ages = np.array(found), np.array(ages)
    np.testing.assert_allclose(found[1::2], found[::2], atol=1e-12)
    assert np.abs(np.diff(found[::2], axis=0)).max() > 1e-3
    np.testing.assert_allclose(ages[3::2] - ages[2::2], PERIOD)
