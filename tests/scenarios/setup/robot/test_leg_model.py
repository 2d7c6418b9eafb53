"""The planner's legs against the robot's: posture and angular momentum of the same CoM and soles."""

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

import surefoot
from surefoot.models.registry import describe
from surefoot.models.types import RobotOptions
from surefoot.scenarios.setup.groups.formulation import ANKLE_SHARE, LEAST_ROOM
from surefoot.scenarios.setup.robot.body import body_of, feet_at, leg_inertia
from surefoot.scenarios.setup.stances.start import start_posture
from surefoot.scenarios.setup.walk import resolve
from surefoot.wbc.body.ik import PostureTarget

pytestmark = pytest.mark.unit

STEP = 0.01


def parameters_of(body, share=1.0):
    """A walk of a robot with this share of its torques, its ankle, and the parameters that its planner is given."""
    walk = resolve(surefoot.load("walk-level"))
    walk = replace(walk, described=replace(walk.robot, torque_limit=share * walk.robot.torque_limit))
    posture = start_posture(walk, body)
    leg = leg_inertia(body.model, body.frames, posture, body.leg_joints)
    return walk, leg.chain.ankle, walk.planner(feet_at(body, posture), leg).parameters


@pytest.mark.parametrize("share", [1.0, 0.5])
def test_at_the_edge_of_its_room_the_cop_takes_its_share_of_the_ankles_torques(body, share):
    walk, ankle, parameters = parameters_of(body, share)
    room = parameters.cop_room
    for name, side, off in zip(("left_ankle_pitch", "left_ankle_roll"), room, ankle, strict=False):
        limit = walk.robot.torque_limit[walk.robot.joint_names.index(name)]
        assert walk.robot.mass * 9.81 * (side + abs(off)) == pytest.approx(ANKLE_SHARE * limit, rel=1e-3)


def test_an_ankle_without_torque_leaves_a_little_room(body):
    walk, _, parameters = parameters_of(body, 0.01)
    np.testing.assert_allclose(parameters.cop_room, LEAST_ROOM * np.array(walk.sole))


@pytest.mark.parametrize(("share", "bear"), [(1.0, True), (0.6, False)])
def test_toes_bear_the_robot_where_the_ankles_have_the_torque_for_its_edge(body, share, bear):
    walk, _, parameters = parameters_of(body, share)
    assert parameters.toes_bear is bear is (parameters.cop_room[0] >= 0.5 * walk.sole[0])


@pytest.fixture(scope="module")
def body():
    return body_of(describe("humanoid100", RobotOptions(foot_length=0.22, foot_width=0.11)))


def stride(time):
    """CoM (3,) and soles (2, 3) in a step of half a metre in 0.4 s."""
    share = time / 0.4
    swung = 10.0 * share**3 - 15.0 * share**4 + 6.0 * share**5
    swing = np.array([-0.5 + swung, -0.1, 0.2 * share * (1.0 - share)])
    return np.array([-0.2 + time, 0.05, 0.94 + 0.01 * np.sin(8.0 * time)]), np.stack([[0.0, 0.1, 0.0], swing])


def momentum(body, time):
    """Angular momentum over mass of the whole robot whose trunk stays upright."""
    ik, q = body.ik(body.robot.nominal_joint_positions), pin.neutral(body.model)
    q[2], q[7:] = 0.9, body.robot.nominal_joint_positions
    found = []
    for t in (time - 2e-3, time + 2e-3):
        com, soles = stride(t)
        result = ik.solve(PostureTarget(soles, np.zeros(2), com, 0.0), q)
        assert result.reached
        q = result.q
        found.append(q)
    v = pin.difference(body.model, *found) / 4e-3
    data = body.model.createData()
    pin.computeCentroidalMomentum(body.model, data, found[0], v)
    return data.hg.angular / pin.computeTotalMass(body.model)


@pytest.mark.parametrize("time", [0.08, 0.2, 0.3])
def test_momentum_rate_of_a_fast_step_is_that_of_the_robot(body, time):
    q = (
        body.ik(body.robot.nominal_joint_positions)
        .solve(
            PostureTarget(np.array([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]]), np.zeros(2), np.array([0.0, 0.0, 0.95]), 0.0),
            pin.neutral(body.model),
        )
        .q
    )
    chain = leg_inertia(body.model, body.frames, q, body.leg_joints).chain
    com, soles = zip(*(stride(t) for t in time + STEP * np.arange(-1, 2)), strict=True)
    rate = chain.momentum_rate(np.array(com), np.array(soles).transpose(1, 0, 2), np.zeros((2, 3)), STEP)[0]
    truth = (momentum(body, time + STEP) - momentum(body, time - STEP)) / (2.0 * STEP)
    assert np.abs(truth).max() > 0.1
    np.testing.assert_allclose(rate, truth, atol=0.1)
    assert abs(rate[1] - truth[1]) < 0.05 * abs(truth[1]) + 0.05
