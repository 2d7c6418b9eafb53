"""Whole runs: compiled kernels and plain Python walk the same way, and a log says which of them made it."""

import numpy as np
import pytest

import surefoot
from surefoot.models.registry import describe
from surefoot.models.types import RobotOptions
from surefoot.native.library import VARIABLE
from surefoot.planner.ground.terrain import flat
from surefoot.sim.pushes import Push
from surefoot.sim.sensors import SensorReader
from surefoot.sim.world import World


def positions(seconds, **keys):
    """Positions and velocities of a walk from its sensors, tick by tick."""
    found = []
    with surefoot.Simulation(surefoot.load("walk", keys)) as simulation:
        while simulation.time < seconds:
            simulation.advance()
            state = simulation.look().state
            found.append(np.concatenate((state.q, state.v)))
    return np.array(found)


@pytest.mark.physics
def test_states_of_both_agree_for_five_seconds(kernels, monkeypatch):
    compiled = positions(5.0)
    monkeypatch.setenv(VARIABLE, "0")
    np.testing.assert_allclose(compiled, positions(5.0), rtol=0.0, atol=1e-9)


@pytest.mark.physics
def test_a_reading_that_is_rounded_shows_no_difference_below_a_bit_and_so_lets_it_grow(kernels, monkeypatch):
    """Why a preset's noise has the rounding of its encoders in it: a walk is then the same on every machine."""
    keys = {"sensing.encoder_bits": 19, "sensing.encoder_noise": 1e-5}
    compiled = positions(2.0, **keys)
    monkeypatch.setenv(VARIABLE, "0")
    apart = np.abs(compiled - positions(2.0, **keys)).max(axis=1)
    assert apart[100:200].max() < 1e-8 and apart[-200:].max() > 1e-6


@pytest.mark.unit
def test_sensors_are_read_alike_with_and_without_a_push(kernels, monkeypatch):
    robot = describe("humanoid100", RobotOptions())
    push = Push(time=0.03, duration=0.02, force=np.array([80.0, 20.0, 0.0]), body=robot.bodies[0])
    world = World(robot, flat(), 1000, [push])
    compiled = SensorReader(world.model, world.data, robot, world._pushes)
    monkeypatch.setenv(VARIABLE, "0")
    plain = SensorReader(world.model, world.data, robot, world._pushes)
    q = np.zeros(world.model.nq)
    q[2], q[6], q[7:] = robot.leg_length, 1.0, robot.nominal_joint_positions
    world.reset(q)
    rng = np.random.default_rng(4)
    for _ in range(40):
        world.advance(rng.uniform(-20.0, 20.0, world.model.nu), 2)
        one, other = (reader.read(world.time) for reader in (compiled, plain))
        for name in ("joint_torque", "accelerometer", "wrench", "q", "v", "external_force"):
            np.testing.assert_allclose(getattr(one, name), getattr(other, name), rtol=1e-11, atol=1e-11, err_msg=name)
        assert (one.nonfoot_contact, one.self_contact) == (other.nonfoot_contact, other.self_contact)
