"""Sole wrenches from joint torques, where nothing else tells them."""

import math

import numpy as np
import pinocchio as pin
import pytest

from surefoot.wbc.estimation.parameters import SensorNoise
from surefoot.wbc.estimation.torques import LARGEST, TorqueWrench
from surefoot.wbc.types import RobotState

pytestmark = pytest.mark.unit

PERIOD = 0.002


def balanced(robot, q, share):
    """Sole wrenches that hold a robot still, the left one with a share of the weight, and the torques with them."""
    model, data = robot.model, robot.model.createData()
    gravity = pin.computeGeneralizedGravity(model, data, q).copy()
    pin.computeJointJacobians(model, data, q)
    pin.updateFramePlacements(model, data)
    frames = [model.getFrameId(name) for name in robot.frames.soles]
    J = np.vstack([pin.getFrameJacobian(model, data, frame, pin.ReferenceFrame.LOCAL) for frame in frames])
    scale = np.repeat([share, 1.0 - share], 6) * np.tile([1.0, 1.0, 1.0, 0.1, 0.1, 0.1], 2)
    wrench = scale * np.linalg.lstsq(J.T[:6] * scale, gravity[:6], rcond=None)[0]
    return wrench.reshape(2, 6), gravity[6:] - (J.T @ wrench)[6:]


@pytest.mark.parametrize("share", [0.5, 0.8, 1.0])
def test_of_a_robot_at_rest_they_are_the_true_ones(robot, share):
    q = robot.standing
    wrench, torque = balanced(robot, q, share)
    found = TorqueWrench(robot.model, robot.frames.soles, PERIOD, SensorNoise())
    state = RobotState(q, np.zeros(robot.nv))
    for _ in range(5):
        seen = found.update(state, torque)
    np.testing.assert_allclose(seen[:, :3], wrench[:, :3], atol=2.0)
    np.testing.assert_allclose(seen[:, 3:], wrench[:, 3:], atol=1.0)
    # Torques of another stance are told as such.
    other, _ = balanced(robot, q, 1.0 - 0.5 * share)
    assert np.abs(seen - other).max() > 50.0


def falling(robot, held, middle):
    """Normal forces found in free fall under torques that jump at every tick, given in an array that is used again."""
    model, data, rng = robot.model, robot.model.createData(), np.random.default_rng(2)
    q, v = robot.standing.copy(), np.zeros(robot.nv)
    found, step = TorqueWrench(model, robot.frames.soles, PERIOD, SensorNoise(), held), PERIOD / 20
    torque, forces = np.zeros(robot.nv - 6), []
    found.update(RobotState(q, v), torque)
    for _ in range(100):
        torque[:] = 0.9 * torque + rng.normal(scale=3.0, size=robot.nv - 6)
        before = q
        for _ in range(20):
            v = v + step * pin.aba(model, data, q, v, np.concatenate((np.zeros(6), torque)))
            q = pin.integrate(model, q, step * v)
        seen = pin.difference(model, before, q) / PERIOD if middle else v
        forces.append(found.update(RobotState(q, seen), torque)[:, 2])
    return np.abs(forces[60:]).max()


def test_in_free_fall_there_are_none_whatever_the_joints_do(robot):
    """Momentum changes by gravity and torques alone, which the observer knows."""
    assert falling(robot, held=True, middle=False) < 0.001 * 981.0 < falling(robot, held=False, middle=False)


def test_of_velocities_between_two_ticks_the_mean_of_their_torques_counts(robot):
    assert falling(robot, held=False, middle=True) < 0.5 * falling(robot, held=True, middle=True)


def test_a_force_that_sets_in_is_followed_within_its_bandwidth(robot):
    q = robot.standing
    (_, torque), (other, changed) = balanced(robot, q, 0.5), balanced(robot, q, 0.8)
    found, state = (
        TorqueWrench(robot.model, robot.frames.soles, PERIOD, SensorNoise()),
        RobotState(q, np.zeros(robot.nv)),
    )
    found.update(state, torque)
    for _ in range(20):
        seen = found.update(state, changed)
    np.testing.assert_allclose(seen[:, 2], other[:, 2], atol=5.0)


def test_forces_that_change_evenly_acted_before_by_what_the_low_pass_makes_them_late(robot):
    q = robot.standing
    (wrench, torque), (other, changed) = balanced(robot, q, 0.4), balanced(robot, q, 0.6)
    found = TorqueWrench(robot.model, robot.frames.soles, PERIOD, SensorNoise())
    for tick in range(101):
        seen = found.update(RobotState(q, np.zeros(robot.nv)), torque + 0.01 * tick * (changed - torque))
    then = wrench + 0.01 * (100 - found.late / PERIOD) * (other - wrench)
    assert found.late > 0.001
    np.testing.assert_allclose(seen[:, 2], then[:, 2], atol=0.01 * np.abs(other - wrench)[:, 2].max())


@pytest.mark.parametrize("sensors", [SensorNoise(), SensorNoise(encoder=1.5e-4, joint_torque=2.0)])
def test_noise_of_encoders_and_torques_is_as_large_as_it_says(robot, sensors):
    q, rng = robot.standing, np.random.default_rng(4)
    wrench, torque = balanced(robot, q, 0.5)
    found = TorqueWrench(robot.model, robot.frames.soles, PERIOD, sensors)
    before, seen = np.zeros(len(torque)), []
    for _ in range(400):
        encoder = sensors.encoder * rng.normal(size=len(torque))
        v = np.concatenate((np.zeros(6), (encoder - before) / PERIOD))
        before = encoder
        found.update(RobotState(q, v), torque + sensors.joint_torque * rng.normal(size=len(torque)))
        seen.append(found.wrench)
    error = np.array(seen)[50:] - wrench
    for numbers, said in zip((error[..., :3], error[..., 3:]), found.deviation, strict=True):
        largest = np.sqrt((numbers**2).mean(axis=0)).max()
        assert 0.2 * said < largest < 1.3 * said


def test_a_velocity_of_the_body_that_jumps_is_no_force_on_a_foot(robot):
    """The legs tell a foot's wrench: a noise of the heavy body's velocity passes little of its momentum on to it."""
    q, rng = robot.standing, np.random.default_rng(5)
    wrench, torque = balanced(robot, q, 0.5)
    found, mass = TorqueWrench(robot.model, robot.frames.soles, PERIOD, SensorNoise()), 100.0
    seen = []
    for _ in range(200):
        v = np.zeros(robot.nv)
        v[2] = 1e-3 * rng.normal()
        found.update(RobotState(q, v), torque)
        seen.append(found.wrench[:, 2])
    shaken = 1e-3 * math.sqrt(2.0) * mass / PERIOD
    assert np.std(np.array(seen)[50:] - wrench[:, 2]) < 0.2 * shaken


@pytest.mark.parametrize("lost", ["q", "v"])
def test_of_a_state_that_is_not_finite_nothing_is_known(robot, lost):
    """An estimate that has diverged ends in a fall, and so raises nothing here."""
    found = TorqueWrench(robot.model, robot.frames.soles, PERIOD, SensorNoise())
    _, torque = balanced(robot, robot.standing, 0.5)
    state = {"q": robot.standing.copy(), "v": np.zeros(robot.nv)}
    assert np.isfinite(found.update(RobotState(**state), torque)).all()
    state[lost][8] = np.nan
    assert np.isnan(found.update(RobotState(**state), torque)).all()


def test_by_torques_that_are_worth_nothing_a_force_may_be_as_large_as_any_is(robot):
    _, torque = balanced(robot, robot.standing, 0.5)
    found = TorqueWrench(robot.model, robot.frames.soles, PERIOD, SensorNoise(joint_torque=1e8))
    seen = found.update(RobotState(robot.standing, np.zeros(robot.nv)), torque)
    assert np.isfinite(seen).all()
    assert 0.5 * LARGEST < found.deviation[0] <= LARGEST
