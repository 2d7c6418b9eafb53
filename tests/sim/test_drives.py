"""Motors that lose torque, come late, are noisy, or have less torque the faster they turn."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from surefoot.joints import JointCommand, Servo
from surefoot.models.belief import with_joint_losses
from surefoot.models.convert import Coordinates
from surefoot.models.registry import describe
from surefoot.models.types import RobotOptions
from surefoot.planner.ground.terrain import flat
from surefoot.sim.drives import IDEAL, DriveErrors, Drives
from surefoot.sim.world import World

pytestmark = pytest.mark.unit

ROBOT = describe("humanoid100", RobotOptions())
NJ = len(ROBOT.joint_names)


def in_the_air(robot=ROBOT, errors=None, seed=0, speed=0.0, physics=1000):
    """A world in which the robot falls freely, its joints at a speed [rad/s]."""
    drives = None if errors is None else Drives(robot, errors, physics, seed)
    world = World(robot, flat(), physics, drives=drives)
    q, v = np.zeros(7 + NJ), np.zeros(6 + NJ)
    q[2], q[6], q[7:] = 50.0, 1.0, robot.nominal_joint_positions
    v[6:] = speed * np.where(np.arange(NJ) % 2, 1.0, -1.0)
    world.reset(q, v)
    return world


def energy(world):
    mujoco.mj_forward(world.model, world.data)
    mujoco.mj_energyPos(world.model, world.data)
    mujoco.mj_energyVel(world.model, world.data)
    return float(world.data.energy.sum())


def loss(robot, damping=0.0, friction=0.0):
    """Energy that the robot has lost in falling for 50 ms, and what its joints have turned into heat [J]."""
    world = in_the_air(robot, speed=1.0, physics=20000)
    before, heat, rate = energy(world), 0.0, world.data.qvel[6:].copy()
    for _ in range(1000):
        world.advance(np.zeros(NJ), 1)
        now = world.data.qvel[6:].copy()
        heat += float((damping * (now * 0.5 * (now + rate)) + friction * np.abs(0.5 * (now + rate))).sum()) / 20000
        rate = now
    return before - energy(world), heat


@pytest.mark.parametrize("losses", [{"damping": 2.0}, {"friction": 1.0}, {"damping": 1.0, "friction": 0.5}])
def test_what_joints_lose_is_what_damping_and_friction_take(losses):
    robot = with_joint_losses(ROBOT, losses.get("damping", 0.0), losses.get("friction", 0.0))
    lost, heat = loss(robot, **losses)
    assert lost > 0.3
    assert lost == pytest.approx(heat, rel=0.03)
    assert abs(loss(ROBOT)[0]) < 0.02 * lost


def test_friction_holds_a_joint_against_less_torque_and_no_more():
    def moved(friction, torque):
        world = in_the_air(with_joint_losses(ROBOT, 0.0, friction))
        command, start = np.zeros(NJ), world.data.qpos[-1]
        command[-1] = torque
        world.advance(command, 20)
        return abs(world.data.qpos[-1] - start)

    free = moved(0.0, 1.5)
    assert moved(2.0, 1.5) < 0.1 * free
    assert moved(2.0, 3.5) > 0.5 * free


def test_strong_damping_is_stable():
    """It is implicit: explicitly the wrists, of 1e-3 kg m^2, would explode."""
    world = in_the_air(with_joint_losses(ROBOT, 200.0, 0.0), speed=2.0)
    world.advance(np.zeros(NJ), 200)
    assert np.abs(world.data.qvel[6:]).max() < 0.5


def test_worlds_without_losses_are_as_they_were():
    plain, drawn = World(ROBOT, flat(), 1000), World(ROBOT, flat(), 1000, drives=Drives(ROBOT, IDEAL, 1000, 0))
    assert plain.mjcf() == drawn.mjcf()
    assert 'eulerdamp="disable"' in plain.mjcf()
    assert "damping" not in plain.mjcf().replace("eulerdamp", "")


@pytest.mark.parametrize(("delay", "steps"), [(0.0, 0), (0.001, 1), (0.004, 4), (0.005, 5)])
def test_a_torque_acts_later_by_the_delay(delay, steps):
    """Steps of the physics, whatever the control rate; until then the motors give what they gave at the start."""
    world = in_the_air(errors=DriveErrors(delay=delay))
    before = np.full(NJ, -1.0)
    q = world.data.qpos.copy()
    q[3:7] = q[[4, 5, 6, 3]]
    world.reset(q, torque=before)
    told, given = [], []
    for tick in range(10):
        told += [np.full(NJ, tick + 1.0)] * 2
        for _ in range(2):
            world.advance(told[-1], 1)
            given.append(world.measure().joint_torque.copy())
    wanted = [before] * steps + told
    np.testing.assert_allclose(given, wanted[: len(given)], atol=1e-12)


def test_a_delay_counts_within_a_control_tick():
    world = in_the_air(errors=DriveErrors(delay=0.001))
    world.advance(np.full(NJ, 3.0), 2)
    np.testing.assert_allclose(world.measure().joint_torque, 3.0)
    world.advance(np.full(NJ, 5.0), 1)
    np.testing.assert_allclose(world.measure().joint_torque, 3.0)


def test_noise_is_drawn_with_each_command():
    world = in_the_air(errors=DriveErrors(noise=2.0))
    errors = []
    for _ in range(300):
        world.advance(np.zeros(NJ), 1)
        errors.append(world.measure().joint_torque.copy())
    errors = np.array(errors)
    assert errors.std() == pytest.approx(2.0, rel=0.05)
    assert abs((errors[1:] * errors[:-1]).mean()) < 0.2


def test_noise_is_that_of_the_seed_and_begins_again_with_a_reset():
    one, same, other = (in_the_air(errors=DriveErrors(noise=2.0), seed=seed) for seed in (1, 1, 2))
    found = []
    for world in (one, same, other):
        world.advance(np.zeros(NJ), 1)
        found.append(world.measure().joint_torque.copy())
    np.testing.assert_array_equal(found[0], found[1])
    assert not np.array_equal(found[0], found[2])
    q = one.data.qpos.copy()
    q[3:7] = q[[4, 5, 6, 3]]
    one.reset(q)
    one.advance(np.zeros(NJ), 1)
    np.testing.assert_array_equal(one.measure().joint_torque, found[0])


def test_a_fast_motor_gives_what_its_speed_leaves():
    knee = 0.5
    world = in_the_air(errors=DriveErrors(torque_speed=knee))
    share = np.linspace(-1.2, 1.2, NJ)
    world.data.qvel[6:] = share * ROBOT.velocity_limit
    world.advance(ROBOT.torque_limit, 1)
    left = np.where(share > 0.0, np.clip((1.0 - share) / (1.0 - knee), 0.0, 1.0), 1.0)
    np.testing.assert_allclose(world.measure().joint_torque, left * ROBOT.torque_limit, atol=1e-9)


def test_motors_without_errors_change_no_bit():
    plain, driven = in_the_air(speed=1.0), in_the_air(errors=replace(IDEAL), speed=1.0)
    rng = np.random.default_rng(0)
    for _ in range(20):
        torque = rng.normal(size=NJ)
        plain.advance(torque, 2)
        driven.advance(torque, 2)
    np.testing.assert_array_equal(plain.data.qpos, driven.data.qpos)


def test_a_drive_with_gains_pulls_as_an_implicit_step_of_its_joint_alone():
    """Its torque is that of spring and damper at the end of the step, in which it moves its joint's own inertia."""
    world, rng = in_the_air(with_joint_losses(ROBOT, 0.0, 0.0), speed=0.3), np.random.default_rng(3)
    q, v = world.measure().joint_position.copy(), world.measure().joint_velocity.copy()
    inertia = Coordinates(world.model).inertia(world.model)
    servo = Servo(q + rng.normal(size=NJ) * 1e-3, rng.normal(size=NJ) * 0.1, 20.0 * inertia, 30.0 * inertia)
    forward, h = 1e-3 * rng.normal(size=NJ), 1e-3
    world.act(JointCommand(forward, servo), h)
    torque = world.data.qfrc_actuator[6:] - forward
    after = v + h * torque / inertia
    expected = servo.stiffness * (servo.position - (q + h * after)) + servo.damping * (servo.velocity - after)
    np.testing.assert_allclose(torque, expected, rtol=1e-9, atol=1e-12)
    assert (np.abs(torque) > 1e-3).all()
