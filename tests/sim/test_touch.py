"""Contacts by MuJoCo: of the ground, and of the robot with itself."""

import mujoco
import numpy as np
import pytest

from surefoot.models.convert import pinocchio_to_mujoco
from surefoot.models.registry import describe
from surefoot.models.types import RobotDescription, RobotOptions
from surefoot.planner.ground.terrain import flat
from surefoot.sim.world import World

pytestmark = pytest.mark.unit

FLOATING = 3.0


@pytest.fixture(scope="module")
def robot() -> RobotDescription:
    return describe("humanoid100", RobotOptions(0.22, 0.11))


@pytest.fixture(scope="module")
def world(robot: RobotDescription) -> World:
    return World(robot, flat(), 1000)


def _posed(world: World, robot: RobotDescription, **angles: float) -> bool:
    """Return true if the floating robot touches itself with these joint angles [rad] on top of its mild crouch."""
    q = np.concatenate(([0.0, 0.0, FLOATING, 0.0, 0.0, 0.0, 1.0], robot.nominal_joint_positions))
    for name, angle in angles.items():
        q[7 + robot.joint_names.index(name)] += angle
    world.reset(q)
    now = world.measure()
    assert not now.nonfoot_contact
    return now.self_contact


def test_a_relaxed_robot_does_not_touch_itself(world: World, robot: RobotDescription) -> None:
    assert not _posed(world, robot)


@pytest.mark.parametrize(
    "angles",
    [
        {"left_hip_roll": -0.3},  # shank against shank
        {"left_hip_yaw": -0.8, "right_hip_yaw": 0.8},  # toe against toe
        {"left_shoulder_roll": -0.25},  # hand into the thigh
        {"right_shoulder_pitch": -1.0, "right_elbow": -1.9, "right_shoulder_yaw": 1.2},  # forearm across the chest
    ],
)
def test_crossed_limbs_touch(world: World, robot: RobotDescription, angles: dict[str, float]) -> None:
    assert _posed(world, robot, **angles)


def test_no_joint_alone_makes_its_neighbours_touch(world: World, robot: RobotDescription) -> None:
    """Every joint goes to its limits: what then touches is a limb, never the two links of the joint itself."""
    parent = {world.model.body(b).name: int(world.model.body_parentid[b]) for b in range(1, world.model.nbody)}
    for joint, name in enumerate(robot.joint_names):
        body = int(world.model.joint(name).bodyid[0])
        for angle in (robot.position_lower[joint], robot.position_upper[joint]):
            _posed(world, robot, **{name: angle - robot.nominal_joint_positions[joint]})
            for one, other in world.model.geom_bodyid[world.data.contact.geom]:
                assert {one, other} != {body, parent[world.model.body(body).name]}, name


def test_legs_pressed_together_push_each_other_away(robot: RobotDescription) -> None:
    """Self-collision acts in physics, equal and opposite: legs of 16 kg meet, the robot's momentum stays gravity's."""
    world = World(robot, flat(), 1000)
    q = np.concatenate(([0.0, 0.0, FLOATING, 0.0, 0.0, 0.0, 1.0], robot.nominal_joint_positions))
    torque = np.zeros(len(robot.joint_names))
    torque[robot.joint_names.index("left_hip_roll")] = -40.0
    torque[robot.joint_names.index("right_hip_roll")] = 40.0
    world.reset(q)
    touched = False
    for _ in range(100):
        world.advance(torque, 2)
        touched |= world.measure().self_contact
    mujoco.mj_forward(world.model, world.data)
    mujoco.mj_subtreeVel(world.model, world.data)
    assert touched
    np.testing.assert_allclose(world.data.subtree_linvel[1], [0.0, 0.0, -9.81 * world.time], atol=1e-3)
    roll = world.data.qpos[7 + robot.joint_names.index("left_hip_roll")]
    assert roll > robot.position_lower[robot.joint_names.index("left_hip_roll")] + 0.1


def test_a_knee_on_the_ground_is_no_foot(robot: RobotDescription) -> None:
    world = World(robot, flat(), 1000)
    q = np.concatenate(([0.0, 0.0, 0.2, 0.0, 0.0, 0.0, 1.0], robot.nominal_joint_positions))
    q[7 + robot.joint_names.index("left_knee")] = q[7 + robot.joint_names.index("right_knee")] = 1.57
    q[7 + robot.joint_names.index("left_hip_pitch")] = q[7 + robot.joint_names.index("right_hip_pitch")] = -1.3
    q[2] = 0.2
    world.reset(q)
    assert world.measure().nonfoot_contact
    qpos, qvel = np.zeros(world.model.nq), np.zeros(world.model.nv)
    pinocchio_to_mujoco(q, np.zeros(world.model.nv), qpos, qvel)
    np.testing.assert_array_equal(world.data.qpos, qpos)
