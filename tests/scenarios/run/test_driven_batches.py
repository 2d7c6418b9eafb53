"""Arms and loads that are somebody else's, in numbers: many seeds, arms raised overhead, five kilograms in a hand."""

import numpy as np
import pytest

import surefoot
from surefoot.joints import JointCommand, Servo
from surefoot.models import RobotOptions, describe
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.stances.start import pressed
from surefoot.sim.world import World
from surefoot.wbc.body.statics import LEVER, standing_torque

ARMS = {".*(shoulder|elbow|wrist).*": [14.0, 0.9]}
ROBOTS = {
    "humanoid100": ({}, {".*(shoulder|elbow).*": [14.0, 0.9]}, "left_forearm"),
    "g1": ({"robot": "g1", "sized_for": "humanoid100"}, ARMS, "left_wrist_yaw_link"),
}

SEEDS = 20
MOST_LOST = {True: 0, False: 2}
"""Most walks of so many seeds that may fall, with what drives the arms told and untold."""


def end_of(name, keys, seed=0):
    with surefoot.Simulation(load(name, {"sensing.source": "truth", **keys, "seed": seed})) as simulation:
        while not simulation.done:
            simulation.advance()
        return simulation.end.kind


@pytest.mark.long
@pytest.mark.parametrize("robot", ROBOTS)
@pytest.mark.parametrize("told", [True, False])
def test_arms_that_are_moved_at_random_are_survived(robot, told):
    overrides, arms, _ = ROBOTS[robot]
    control = {"driven_joints": arms, "driven_motion": 0.06, "driven_told": told}
    ends = [end_of("walk-level", {**overrides, "control": control}, seed) for seed in range(SEEDS)]
    assert sum(end != "completed" for end in ends) <= MOST_LOST[told], ends


@pytest.mark.physics
@pytest.mark.parametrize("robot", [pytest.param("humanoid100", marks=pytest.mark.long), "g1"])
def test_arms_go_overhead_in_a_second_and_it_walks_on(robot):
    overrides, arms, _ = ROBOTS[robot]
    scenario = load("walk-level", {"sensing.source": "truth", **overrides, "control": {"driven_joints": arms}})
    controller = surefoot.Controller(scenario.robot, scenario)
    walk, body = controller.walk, controller.body
    world = World(walk.robot, walk.ground.terrain, walk.rates.physics, (), walk.size)
    q = pressed(controller.posture, walk.size.length)
    world.reset(q, torque=standing_torque(body.model, body.frames, q, LEVER * walk.size.length))
    controller.reset(q)
    names = walk.robot.joint_names
    arm = np.array([any(part in name for part in ("shoulder", "elbow", "wrist")) for name in names])
    lift = np.array([walk.robot.roles.arm_swing is not None and name in walk.robot.roles.arm_swing for name in names])
    # Forward and up, so far that the hands are over the shoulders.
    up = np.zeros(len(names))
    up[lift] = -2.6 * np.array(walk.robot.roles.arm_back)
    gains = np.where(arm, 14.0, 0.0) * walk.size.mass / 0.33, np.where(arm, 0.9, 0.0) * walk.size.mass / 0.33
    begin, still = 2.0, np.zeros(len(names))
    while world.time < walk.duration:
        share = float(np.clip(world.time - begin, 0.0, 1.0))
        theirs = JointCommand(still, Servo(q[7:] + share * up, still, *gains))
        command = controller.step(world.measure(), driven_joints=theirs)
        world.act(command.with_joints(arm, theirs), 1.0 / walk.rates.control)
    raised = world.measure().q[7:][lift] - q[7:][lift]
    assert np.abs(raised).min() > 1.8
    assert controller.terms.torso_rotation[2, 2] > 0.99
    assert controller.planning.plan.phase.step == walk.gait.steps


TURN = {"gait.velocity": [{"time": 0.0, "yaw_rate": 0.4759989}, {"time": 5.0}]}
WALKS = [pytest.param("walk-level", {}, marks=pytest.mark.long), ("walk-turn", TURN)]


@pytest.mark.physics
@pytest.mark.parametrize(("name", "keys"), WALKS)
@pytest.mark.parametrize("robot", [pytest.param("humanoid100", marks=pytest.mark.long), "g1"])
def test_five_kilograms_in_a_hand_that_are_told(robot, name, keys):
    overrides, _, hand = ROBOTS[robot]
    keys = {**overrides, **keys, "robot_options.payload_mass": 5.0, "robot_options.payload_body": hand}
    assert end_of(name, keys) == "completed"


@pytest.mark.physics
@pytest.mark.parametrize(("name", "keys"), WALKS)
@pytest.mark.parametrize("robot", ["humanoid100", pytest.param("g1", marks=pytest.mark.long)])
def test_five_kilograms_in_a_hand_that_nobody_told_of(robot, name, keys):
    overrides, _, hand = ROBOTS[robot]
    assert end_of(name, {**overrides, **keys, "errors.payload": {"mass": 5.0, "body": hand}}) == "completed"


@pytest.mark.unit
def test_the_hands_are_bodies_of_their_robots():
    for robot, (_, _, hand) in ROBOTS.items():
        assert hand in describe(robot, RobotOptions()).bodies
