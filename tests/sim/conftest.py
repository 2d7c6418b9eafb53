"""Fixtures: a robot in its nominal posture, held by joint PD with the torques that carry its weight."""

from collections.abc import Callable

import mujoco
import numpy as np
import pytest

from surefoot.sim.world import World


def _standing_configuration(world: World) -> np.ndarray:
    """Nominal posture with the left sole at z = 0 and the CoM above the sole centres, in Pinocchio's convention."""
    q = np.concatenate(([0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0], world.description.nominal_joint_positions))
    world.reset(q)
    sole = world.data.site(world.description.sole_sites[0]).xpos
    q[0] -= world.data.subtree_com[1][0] - sole[0]
    q[2] -= sole[2]
    return q


class Holder:
    """Joint PD about a posture plus gravity compensation with half the weight on each sole."""

    def __init__(self, world: World, q: np.ndarray) -> None:
        world.reset(q)
        self.posture = q[7:].copy()
        M = np.zeros((world.model.nv, world.model.nv))
        mujoco.mj_fullM(world.model, world.data, M)
        self.damping = 0.25 / world.model.opt.timestep / np.diag(np.linalg.inv(M))[6:]
        self.stiffness = np.minimum(2500.0, 20.0 * self.damping)
        self.feedforward = world.data.qfrc_bias[6:].copy()
        J = np.zeros((3, world.model.nv))
        for site in world.description.sole_sites:
            mujoco.mj_jacSite(world.model, world.data, J, None, world.model.site(site).id)
            self.feedforward -= J[2, 6:] * 9.81 * world.description.mass / 2

    def hold(self, world: World, steps: int) -> None:
        for _ in range(steps):
            now = world.measure()
            error = self.posture - now.joint_position
            world.advance(self.feedforward + self.stiffness * error - self.damping * now.joint_velocity, 1)


@pytest.fixture
def standing_configuration() -> Callable[[World], np.ndarray]:
    """Function from a world to a configuration in Pinocchio's convention."""
    return _standing_configuration


@pytest.fixture
def make_holder() -> type[Holder]:
    """Constructor of a controller that holds a posture; it resets the world."""
    return Holder
