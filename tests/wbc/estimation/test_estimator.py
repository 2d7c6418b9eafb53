"""The estimator as a whole, apart from any walk."""

import numpy as np
import pinocchio as pin
import pytest

from surefoot.readings import Reading, Readings
from surefoot.wbc.estimation.estimate import Planned
from surefoot.wbc.estimation.estimator import SensedState
from surefoot.wbc.estimation.footing import Footing, ImuMount
from surefoot.wbc.estimation.parameters import EstimatorParameters, GroundNoise
from surefoot.wbc.types import GRAVITY

pytestmark = pytest.mark.unit


PERIOD = 2e-3


class Standing:
    """A robot that stands still under its estimator."""

    def __init__(self, robot, parameters=None, place=(0.0, 0.0, 0.0), begin=0.0):
        feet, up = np.array([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]]) + place, np.array([0.0, 0.0, 1.0])
        footing = Footing(feet, np.zeros(2), (0.1, 0.05), lambda x, y: place[2], lambda x, y: up)
        names, parameters = robot.frames.soles, parameters or EstimatorParameters()
        self.inner = SensedState(robot.model, names, ImuMount(), footing, PERIOD, parameters)
        self.count, self.joints, self.tick = robot.nv - 6, robot.standing[7:].copy(), -1
        self.rate, self.force, self.begin = np.zeros(3), GRAVITY * up, begin

    def sense(self, share=0.5, fresh=True, late=0):
        """The estimate of the next tick.

        A share of the weight is on the left foot; encoders are fresh or not, and the IMU is late by some ticks.
        """
        load = np.zeros((2, 6))
        load[:, 2] = 980.0 * share, 980.0 * (1.0 - share)
        load[:, 3] = 5.0 * share, -7.0 * share
        self.tick += 1
        encoders = Reading(self.joints, 0.0, fresh)
        torque, wrench = (Reading(values, 0.0, True) for values in (np.zeros(self.count), load))
        rate, force = (Reading(values, PERIOD * late, True) for values in (self.rate, self.force))
        time = self.begin + PERIOD * self.tick
        return self.inner.sense(Readings(time, encoders, None, torque, rate, rate, force, wrench))

    def told(self, base, edge=(0, 0)):
        """Tell it how the base is to be accelerated until the next tick, shape (6,) [m/s^2, rad/s^2], and edges."""
        planned = np.concatenate((base, np.zeros(self.count)))
        self.inner.told(Planned(planned, np.zeros(self.count), (True, True), edge))


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


@pytest.mark.parametrize(
    ("place", "begin"), [((3.0, -2.0, 0.4), 0.0), ((0.0, 0.0, -0.5), 0.0), ((0.0, 0.0, 0.0), 64.0)]
)
def test_a_robot_is_estimated_the_same_wherever_it_stands_and_whenever(robot, place, begin):
    """While its feet lift and land, too; and at first its soles are where it is said to stand."""
    here, there = Standing(robot), Standing(robot, place=place, begin=begin)
    data, soles = robot.model.createData(), [robot.model.getFrameId(name) for name in robot.frames.soles]
    pin.framesForwardKinematics(robot.model, data, there.sense().state.q)
    middle = np.mean([data.oMf[sole].translation for sole in soles], axis=0)
    here.sense()
    np.testing.assert_allclose(middle, place, atol=1e-6)
    for share in np.repeat([0.5, 1.0, 0.5, 0.0, 0.5], 30):
        one, other = here.sense(share), there.sense(share)
        np.testing.assert_allclose(other.state.q, one.state.q + np.append(place, np.zeros(4 + here.count)), atol=1e-9)
        np.testing.assert_allclose(other.state.v, one.state.v, atol=1e-9)
        assert other.contact == one.contact
        for tells in (here, there):
            tells.told(np.zeros(6))


@pytest.mark.parametrize("edge", [1, -1])
def test_a_foot_that_rolls_is_seen_from_its_edge_and_then_from_its_centre_again(robot, edge):
    standing = Standing(robot)
    seen = []
    for rolls in (0, edge, edge, 0, 0):
        standing.told(np.zeros(6), (0, rolls))
        standing.sense(fresh=False)
        seen.append(standing.inner.filter.stand.d.copy())
    flat, rolled = seen[0], seen[2]
    np.testing.assert_allclose(rolled[0], flat[0], atol=1e-6)
    np.testing.assert_allclose(rolled[1], flat[1] + (0.1 * edge, 0.0, 0.0), atol=1e-3)
    np.testing.assert_allclose(seen[-1], flat, atol=1e-6)


@pytest.mark.parametrize("late", [0, 1, 4, 9])
def test_of_late_readings_the_state_has_gained_what_was_planned_since(robot, late):
    """As its readings tell, and from then on as planned: the sum of all that, and the way that comes of it."""
    still, driven, rng = Standing(robot), Standing(robot), np.random.default_rng(late)
    plan = np.zeros((40, 6))
    plan[:, :3] = rng.normal(size=(40, 3))
    for tick in range(30):
        before, now = (one.sense(late=late).state for one in (still, driven))
        ago = min(late, tick)
        since = plan[tick - ago : tick]
        np.testing.assert_allclose(now.v - before.v, np.append(PERIOD * since.sum(axis=0), np.zeros(still.count)))
        way = 0.5 * ago * PERIOD * (now.v[:3] - before.v[:3])
        np.testing.assert_allclose(now.q[:3] - before.q[:3], pin.Quaternion(now.q[3:7]) * way, atol=1e-12)
        still.told(np.zeros(6))
        driven.told(plan[tick])


@pytest.mark.parametrize("late", [0, 1, 4])
def test_of_a_noisy_gyroscope_less_is_believed_than_of_the_turning_that_was_planned(robot, late):
    told, alone, rng = Standing(robot), Standing(robot), np.random.default_rng(7)
    noise = EstimatorParameters().sensors.gyro_density / np.sqrt(PERIOD)
    plan = np.zeros((400, 6))
    plan[:, 3:] = rng.normal(size=(400, 3))
    turning = np.vstack((np.zeros(3), PERIOD * np.cumsum(plan[:, 3:], axis=0)))
    errors = []
    for tick in range(400):
        read = turning[max(tick - late, 0)] + noise * rng.normal(size=3)
        told.rate, alone.rate = read, read
        found = [one.sense(fresh=False, late=late).state.v[3:6] for one in (told, alone)]
        errors.append((found[0] - turning[tick], found[1] - turning[max(tick - late, 0)]))
        told.told(plan[tick])
    spread = np.std(errors[100:], axis=0)
    np.testing.assert_allclose(spread[1], noise, rtol=0.15)
    assert (spread[0] < 0.75 * noise).all()


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


def on_one_leg(robot, time):
    """Joints, torques and the left sole's wrench of a robot that stands on one leg, and swings the other from rest."""
    q, v, a, rate = robot.standing.copy(), np.zeros(robot.nv), np.zeros(robot.nv), 3.0 * np.pi
    for name, far in (("right_hip_pitch", 0.15), ("right_knee", 0.2)):
        joint = robot.model.joints[robot.model.getJointId(name)]
        q[joint.idx_q] += far * (1.0 - np.cos(rate * time))
        v[joint.idx_v], a[joint.idx_v] = far * rate * np.sin(rate * time), far * rate**2 * np.cos(rate * time)
    data = robot.model.createData()
    needed = pin.rnea(robot.model, data, q, v, a).copy()
    pin.computeJointJacobians(robot.model, data, q)
    pin.updateFramePlacements(robot.model, data)
    J = pin.getFrameJacobian(robot.model, data, robot.model.getFrameId(robot.frames.soles[0]), pin.LOCAL)
    wrench = np.linalg.solve(J[:, :6].T, needed[:6])
    return q[7:], needed[6:] - J[:, 6:].T @ wrench, wrench


@pytest.mark.parametrize("every", [1, 2])
@pytest.mark.parametrize("age", [0, 1])
def test_of_feet_without_sensors_the_wrenches_are_those_of_the_motion_that_encoders_tell(robot, every, age):
    """However often encoders and torques come, and however late; the foot in the air bears nothing."""
    standing, still, up = Standing(robot), Reading(np.zeros(3), 0.0, True), np.array([0.0, 0.0, GRAVITY])
    found, true = [], []
    for tick in range(300):
        seen = tick // every * every - age
        joints, torque, wrench = on_one_leg(robot, PERIOD * max(seen, 0))
        encoders, motors = (Reading(one, PERIOD * (tick - seen), tick % every == 0) for one in (joints, torque))
        gravity = Reading(up, 0.0, True)
        now = standing.inner.sense(Readings(PERIOD * tick, encoders, None, motors, still, still, gravity, None))
        found.append(now.wrench.copy())
        true.append(wrench)
        assert PERIOD * (tick - seen) < now.wrench_age < PERIOD * (tick - seen) + 0.01
    found, true = np.array(found)[100:], np.array(true)[100:]
    assert np.ptp(true[:, 2]) > 50.0
    np.testing.assert_allclose(found[:, 0, 2], true[:, 2], atol=4.0)
    np.testing.assert_allclose(found[:, 1, :3], 0.0, atol=4.0)
